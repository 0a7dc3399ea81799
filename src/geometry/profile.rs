//! A profile read from rays, row by row upwards.

use std::ops::Range;

/// A chin's bands above and below a row that are compared, as a share of the way from shoulder line to crown (D25).
pub const CHIN_BAND: f64 = 0.05;
/// A smaller step back than this share of the same is no chin (D25). Seen: faces step back by more than .052, a mannequin's
/// egg by less than .028.
pub const CHIN_STEP: f64 = 0.04;
/// The chin where none is seen, as a share of the same (D25).
pub const CHIN_BY_RATIO: f64 = 0.22;

/// Values that differ by less than this share are the same. Seen: ±30 % moves joints by under 0.0005 H.
const PLATEAU: f64 = 0.01;

/// How a step of a profile is looked for.
#[derive(Clone, Copy, Debug)]
pub struct StepSearch {
    /// Rows above and below an edge whose means are compared, at least 1.
    pub band: usize,
    /// A step back that is not deeper is none.
    pub least: f64,
    /// Steps that differ by less than this share of themselves and of `span` are equally deep, and the lowest counts: or
    /// the last digits of a model would decide.
    pub tie: f64,
    /// What `tie` is a share of: the size of what is searched.
    pub span: f64,
}

/// Where `depths` (of rows, upwards; `None` where there is nothing) step back most, downwards. The chin is where a face does.
///
/// The band of rows above an edge is compared with the band below it; around the edge with the deepest step the place
/// counts where it is steepest, of a slope that is even the middle. A row where there is nothing is as deep
/// as the next one below that has something: through a gap between head and body a ray sees no face. `None` where no
/// step is deep enough.
///
/// - `place`: where the step is between a row, at least 1, and the one below it.
pub fn deepest_step(
    depths: &[Option<f64>],
    search: &StepSearch,
    place: impl Fn(usize) -> f64,
) -> Option<f64> {
    let StepSearch { band, least, tie, span } = *search;
    let as_below = |below: &mut Option<f64>, &depth: &Option<f64>| {
        *below = depth.or(*below);
        Some(*below)
    };
    let depths: Vec<Option<f64>> = depths.iter().scan(None, as_below).collect();
    let mean = |rows: Range<usize>| super::mean(depths[rows].iter().flatten().copied());
    let mut deepest: Option<(f64, usize)> = None;
    for edge in band..depths.len().saturating_sub(band) {
        if let (Some(above), Some(below)) = (mean(edge..edge + band), mean(edge - band..edge))
            && deepest.is_none_or(|(step, _)| above - below > step * (1.0 + tie) + tie * span)
        {
            deepest = Some((above - below, edge));
        }
    }
    let (_, edge) = deepest.filter(|&(step, _)| step >= least)?;
    let near = edge.saturating_sub(band).max(1)..(edge + band).min(depths.len());
    let back: Vec<(f64, f64)> =
        near.filter_map(|row| Some((place(row), depths[row - 1]? - depths[row]?))).collect();
    lowest(&back)
}

/// Where `values` (place, value) are least. Along a stretch that is as low, to a hundredth, the middle of it: rounding
/// must not decide which of its places is taken. `None` for no values.
pub fn lowest(values: &[(f64, f64)]) -> Option<f64> {
    let least = (0..values.len()).min_by(|&a, &b| values[a].1.total_cmp(&values[b].1))?;
    let reach = PLATEAU * values[least].1.abs() + f64::MIN_POSITIVE;
    // 1 at the least value, falling to 0 where a value is a hundredth above it.
    let share = |&(_, value): &(f64, f64)| 1.0 - (value - values[least].1) / reach;
    let beyond = values[least..].iter().take_while(|entry| share(entry) > 0.0);
    let before = values[..least].iter().rev().take_while(|entry| share(entry) > 0.0);
    let (mut sum, mut weight) = (0.0, 0.0);
    for entry in before.chain(beyond) {
        sum += share(entry) * entry.0;
        weight += share(entry);
    }
    Some(sum / weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEARCH: StepSearch = StepSearch { band: 3, least: 0.5, tie: 1e-6, span: 2.0 };

    fn row(index: usize) -> f64 {
        index as f64
    }

    fn rows(depths: &[f64]) -> Vec<Option<f64>> {
        depths.iter().map(|&depth| depth.is_finite().then_some(depth)).collect()
    }

    #[test]
    fn the_chin_is_where_the_face_steps_back() {
        // Neck at 0, a slope of one row, face at 1; a nose above.
        let profile = rows(&[0.0, 0.0, 0.0, 0.0, 0.1, 1.0, 1.0, 1.0, 1.0, 1.3, 1.2, 1.1, 1.0]);
        assert_eq!(deepest_step(&profile, &SEARCH, row), Some(5.0));
    }

    #[test]
    fn gaps_are_as_deep_as_what_is_below_them_and_a_flat_front_has_no_step() {
        let gaps = rows(&[0.0, f64::NAN, 0.0, 0.0, 1.0, 1.0, f64::NAN, 1.0, f64::NAN]);
        assert_eq!(deepest_step(&gaps, &SEARCH, row), Some(4.0));
        // A head that floats above its body ends at its own underside, not at the body's top.
        let gap = f64::NAN;
        let floating = rows(&[0.0, 0.0, 0.0, 0.0, gap, gap, gap, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(deepest_step(&floating, &SEARCH, row), Some(7.0));
        assert_eq!(deepest_step(&rows(&[0.0; 12]), &SEARCH, row), None);
        assert_eq!(deepest_step(&rows(&[0.0, 1.0]), &SEARCH, row), None);
        assert_eq!(deepest_step(&[None; 12], &SEARCH, row), None);
    }

    #[test]
    fn of_equal_steps_the_lowest_counts_and_of_an_even_slope_the_middle() {
        let twice = rows(&[0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0 + 1e-9, 2.0, 2.0, 2.0]);
        assert_eq!(deepest_step(&twice, &SEARCH, row), Some(4.0));
        // Under a flat chin all rows step back alike, but for the last digits: steps differ by twice as much as depths.
        for tremble in [-4e-7, 0.0, 4e-7] {
            let slope = rows(&[0.0, 0.0, 0.0, 0.0, 0.25, 0.5 + tremble, 0.75, 1.0, 1.0, 1.0, 1.0, 1.0]);
            let middle = deepest_step(&slope, &SEARCH, row).unwrap();
            assert!((middle - 5.5).abs() < 1e-3, "{tremble}: {middle}");
        }
    }
}
