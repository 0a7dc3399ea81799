//! Boxes along the axes: the least around points, which of many touch, and what hangs together by touching.

use super::Groups;
use glam::DVec3;

/// A box along the axes: its lowest and its highest corner.
pub type Bounds = (DVec3, DVec3);

/// The box of no points.
const NOWHERE: Bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);

/// The least box around `points`; from infinity to minus infinity where there are none.
pub fn bounds(points: impl IntoIterator<Item = DVec3>) -> Bounds {
    points.into_iter().fold(NOWHERE, around)
}

/// For each of `count` groups the least box around those of `points` that name it.
pub fn bounds_by_group(count: usize, points: impl IntoIterator<Item = (usize, DVec3)>) -> Vec<Bounds> {
    let mut boxes = vec![NOWHERE; count];
    for (group, p) in points {
        boxes[group] = around(boxes[group], p);
    }
    boxes
}

fn around((low, high): Bounds, p: DVec3) -> Bounds {
    (low.min(p), high.max(p))
}

/// The least and the greatest of `values`; (infinity, -infinity) for none.
pub fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    values.into_iter().fold(none, |(least, most), value| (least.min(value), most.max(value)))
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

/// What hangs together by touching, boxes that share a point and that `joins` accepts: for each box the least of those.
pub fn clusters(boxes: &[Bounds], joins: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut groups = Groups::new(boxes.len());
    for (one, other) in touching(boxes) {
        if joins(one, other) {
            groups.join(one, other);
        }
    }
    (0..boxes.len()).map(|one| groups.least(one)).collect()
}

/// The same, where boxes that touch become one box around both, until no two touch.
pub fn grown_clusters(boxes: &[Bounds]) -> Vec<usize> {
    let mut least: Vec<usize> = (0..boxes.len()).collect();
    loop {
        let groups: Vec<usize> = (0..boxes.len()).filter(|&one| least[one] == one).collect();
        let slot = |one: usize| groups.partition_point(|&group| group < least[one]);
        let corners =
            boxes.iter().enumerate().flat_map(|(one, &(low, high))| [(slot(one), low), (slot(one), high)]);
        let joined = clusters(&bounds_by_group(groups.len(), corners), |_, _| true);
        if joined.iter().enumerate().all(|(one, &least)| one == least) {
            return least;
        }
        least = (0..boxes.len()).map(|one| groups[joined[slot(one)]]).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(low: [f64; 3]) -> Bounds {
        (DVec3::from_array(low), DVec3::from_array(low) + 1.0)
    }

    #[test]
    fn boxes_touch_at_a_corner_and_not_across_a_gap() {
        let boxes =
            [cube([1.0, 1.0, 1.0]), cube([0.0, 0.0, 0.0]), cube([0.0, 1.5, 0.0]), cube([-1.1, 0.0, 0.0])];
        let mut pairs = touching(&boxes);
        pairs.iter_mut().for_each(|pair| *pair = (pair.0.min(pair.1), pair.0.max(pair.1)));
        pairs.sort_unstable();
        assert_eq!(pairs, [(0, 1), (0, 2)]);
    }

    #[test]
    fn a_box_that_only_the_box_around_two_others_touches_hangs_together_with_them() {
        // The first two meet at a corner; the third lies in the box around both, and in neither.
        let boxes =
            [cube([0.0, 0.0, 0.0]), cube([1.0, 1.0, 0.0]), cube([1.5, -0.5, 0.0]), cube([9.0, 0.0, 0.0])];
        assert_eq!(clusters(&boxes, |_, _| true), [0, 0, 2, 3]);
        assert_eq!(grown_clusters(&boxes), [0, 0, 0, 3]);
        // Only what may become one does.
        assert_eq!(clusters(&boxes, |one, other| one + other != 1), [0, 1, 2, 3]);
    }

    #[test]
    fn the_box_of_nothing_is_empty() {
        let (low, high) = bounds([]);
        assert!(low.cmpgt(high).all());
        assert_eq!(range([]), (f64::INFINITY, f64::NEG_INFINITY));
        assert_eq!(range([2.0, -1.0, 0.5]), (-1.0, 2.0));
        let (one, two) = (DVec3::new(1.0, -2.0, 0.0), DVec3::new(-1.0, 3.0, 0.0));
        let boxes = bounds_by_group(2, [(1, one), (1, two)]);
        assert_eq!(boxes[1], bounds([one, two]));
        assert_eq!(boxes[1], (DVec3::new(-1.0, -2.0, 0.0), DVec3::new(1.0, 3.0, 0.0)));
        assert_eq!(boxes[0], bounds([]));
    }
}
