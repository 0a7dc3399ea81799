//! How far a run is, told to whoever waits for it, and its wish to stop.

use crate::error::{Error, ErrorKind, Result};

/// What is called with the part that is done, 0 to 1; false asks to stop.
pub type Tell<'a> = &'a mut dyn FnMut(f32) -> bool;

/// Tells how far a run is, always on the thread that started it.
pub struct Progress<'a> {
    tell: Option<Tell<'a>>,
    from: f32,
    to: f32,
}

impl<'a> Progress<'a> {
    /// Tells nobody.
    pub fn none() -> Self {
        Self { tell: None, from: 0.0, to: 1.0 }
    }

    /// Tells `tell`.
    pub fn new(tell: Tell<'a>) -> Self {
        Self { tell: Some(tell), from: 0.0, to: 1.0 }
    }

    /// Tells that `fraction` of the work is done.
    ///
    /// # Errors
    /// `ErrorKind::Cancelled` where the answer is to stop.
    pub fn at(&mut self, fraction: f32) -> Result<()> {
        let fraction = self.from + fraction * (self.to - self.from);
        match &mut self.tell {
            Some(tell) => match tell(fraction) {
                true => Ok(()),
                false => Err(Error::new(
                    ErrorKind::Cancelled,
                    "the progress callback asked to stop: everything is as it was",
                )),
            },
            None => Ok(()),
        }
    }

    /// The progress of a part of the work, which takes this one from `from` to `to`.
    pub fn part(&mut self, from: f32, to: f32) -> Progress<'_> {
        let span = self.to - self.from;
        let (from, to) = (self.from + from * span, self.from + to * span);
        match &mut self.tell {
            Some(tell) => Progress { tell: Some(&mut **tell), from, to },
            None => Progress { tell: None, from, to },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_tells_its_share_of_the_whole() {
        let mut told = Vec::new();
        let mut tell = |fraction| {
            told.push(fraction);
            true
        };
        let mut progress = Progress::new(&mut tell);
        progress.at(0.0).unwrap();
        progress.part(0.5, 1.0).part(0.0, 0.5).at(0.5).unwrap();
        progress.at(1.0).unwrap();
        assert_eq!(told, [0.0, 0.625, 1.0]);
    }

    #[test]
    fn a_wish_to_stop_is_an_error() {
        let mut tell = |_| false;
        assert_eq!(Progress::new(&mut tell).at(0.5).unwrap_err().kind, ErrorKind::Cancelled);
        assert!(Progress::none().at(0.5).is_ok());
    }
}
