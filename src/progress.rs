//! How far a run is, reported to whoever waits for it, and its wish to stop.

use crate::error::{Error, ErrorKind, Result};
use crate::parallel;

/// What is called with the share that is done, 0 to 1; false asks to stop.
pub type Callback<'a> = &'a mut dyn FnMut(f32) -> bool;

/// How many parts a long piece of work is done in, to report between them.
const PARTS: usize = 8;

/// Reports how far a run is, always on the thread that started it.
pub struct Progress<'a> {
    callback: Option<Callback<'a>>,
    from: f32,
    to: f32,
}

impl<'a> Progress<'a> {
    /// Reports to nobody.
    pub fn none() -> Self {
        Self { callback: None, from: 0.0, to: 1.0 }
    }

    /// Reports to `callback`.
    pub fn new(callback: Callback<'a>) -> Self {
        Self { callback: Some(callback), from: 0.0, to: 1.0 }
    }

    /// Reports that `fraction` of the work is done.
    ///
    /// # Errors
    /// `ErrorKind::Cancelled` where the answer is to stop.
    pub fn at(&mut self, fraction: f32) -> Result<()> {
        let fraction = self.share(fraction);
        if self.callback.as_mut().is_none_or(|callback| callback(fraction)) {
            return Ok(());
        }
        Err(Error::new(ErrorKind::Cancelled, "the progress callback asked to stop: everything is as it was"))
    }

    /// As [`parallel::collect_with`], in up to [`PARTS`] parts with a report after each.
    ///
    /// # Errors
    /// As [`Progress::at`].
    pub(crate) fn collect_with<S, T: Send>(
        &mut self,
        threads: usize,
        count: usize,
        least: usize,
        start: impl Fn() -> S + Sync,
        make: impl Fn(&mut S, usize) -> T + Sync,
    ) -> Result<Vec<T>> {
        // A part has work for every thread.
        let part = count.div_ceil(PARTS).max(least.saturating_mul(parallel::thread_count(threads)));
        let mut all = Vec::with_capacity(count);
        while all.len() < count {
            let (first, size) = (all.len(), part.min(count - all.len()));
            let made = parallel::collect_with(threads, size, least, &start, |state, index| {
                make(state, first + index)
            });
            all.extend(made);
            self.at(all.len() as f32 / count as f32)?;
        }
        Ok(all)
    }

    /// What `fraction` of this work is of the whole.
    fn share(&self, fraction: f32) -> f32 {
        // A last digit beyond the end would make the next stage begin before it.
        (self.from + fraction * (self.to - self.from)).min(self.to)
    }

    /// The progress of a stage of the work, which takes this one from `from` to `to`.
    pub fn part(&mut self, from: f32, to: f32) -> Progress<'_> {
        let (from, to) = (self.share(from), self.share(to));
        match &mut self.callback {
            Some(callback) => Progress { callback: Some(&mut **callback), from, to },
            None => Progress { callback: None, from, to },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_reports_its_share_of_the_whole() {
        let mut reported = Vec::new();
        let mut callback = |fraction| {
            reported.push(fraction);
            true
        };
        let mut progress = Progress::new(&mut callback);
        progress.at(0.0).unwrap();
        progress.part(0.5, 1.0).part(0.0, 0.5).at(0.5).unwrap();
        progress.at(1.0).unwrap();
        assert_eq!(reported, [0.0, 0.625, 1.0]);
    }

    #[test]
    fn a_wish_to_stop_is_an_error() {
        let mut callback = |_| false;
        assert_eq!(Progress::new(&mut callback).at(0.5).unwrap_err().kind, ErrorKind::Cancelled);
        assert!(Progress::none().at(0.5).is_ok());
    }
}
