//! Things that belong together because each belongs to the next: a union-find, and which boxes touch.

use glam::DVec3;

/// Things in groups that grow together, each known by its least member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Groups {
    /// Another member of the same group, none greater; itself for the least.
    above: Vec<u32>,
}

impl Groups {
    /// `count` things, each in a group of its own.
    pub fn new(count: usize) -> Self {
        Self { above: (0..count as u32).collect() }
    }

    /// The least member of the group of `one`.
    pub fn least(&mut self, mut one: usize) -> usize {
        while self.above[one] as usize != one {
            self.above[one] = self.above[self.above[one] as usize];
            one = self.above[one] as usize;
        }
        one
    }

    /// Makes one group of those of `one` and `other`.
    pub fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.least(one), self.least(other));
        self.above[one.max(other)] = one.min(other) as u32;
    }
}

/// A box along the axes: its lowest and its highest corner.
pub type Bounds = (DVec3, DVec3);

/// The least box around `points`; from infinity to minus infinity where there are none.
pub fn bounds(points: impl Iterator<Item = DVec3>) -> Bounds {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

/// Every two of `boxes` that share a point.
///
/// O(boxes · boxes that begin along x before one ends).
pub fn touching(boxes: &[Bounds]) -> Vec<(usize, usize)> {
    // In order of where they begin, boxes meet only those that begin before they end.
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a].0.x.total_cmp(&boxes[b].0.x).then(a.cmp(&b)));
    let mut pairs = Vec::new();
    for (at, &one) in order.iter().enumerate() {
        for &other in order[at + 1..].iter().take_while(|&&other| boxes[other].0.x <= boxes[one].1.x) {
            if boxes[one].0.cmple(boxes[other].1).all() && boxes[other].0.cmple(boxes[one].1).all() {
                pairs.push((one, other));
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_has_one_least_member() {
        let mut groups = Groups::new(6);
        for (one, other) in [(4, 2), (5, 4), (1, 3), (2, 5)] {
            groups.join(one, other);
        }
        let least: Vec<usize> = (0..6).map(|one| groups.least(one)).collect();
        assert_eq!(least, [0, 1, 2, 1, 2, 2]);
    }

    #[test]
    fn boxes_touch_at_a_corner_and_not_across_a_gap() {
        let cube = |low: [f64; 3]| (DVec3::from_array(low), DVec3::from_array(low) + 1.0);
        let boxes =
            [cube([1.0, 1.0, 1.0]), cube([0.0, 0.0, 0.0]), cube([0.0, 1.5, 0.0]), cube([-1.1, 0.0, 0.0])];
        let mut pairs = touching(&boxes);
        pairs.iter_mut().for_each(|pair| *pair = (pair.0.min(pair.1), pair.0.max(pair.1)));
        pairs.sort_unstable();
        assert_eq!(pairs, [(0, 1), (0, 2)]);
    }
}
