//! The points nearest to a point.
//!
//! Friedman, Bentley and Finkel. An algorithm for finding best matches in logarithmic expected time. ACM TOMS 3(3),
//! 1977. Buckets follow the density of the points, so that a dense face costs no more than a coarse skirt.

use super::bounds;
use glam::DVec3;

/// Points of a bucket, at most. Time alone: what is found is the same.
const BUCKET: usize = 16;

/// Points ready to be searched.
#[derive(Clone, Debug, Default)]
pub struct PointTree {
    /// In the order of the buckets, so that near points lie near each other in memory.
    points: Vec<DVec3>,
    /// The point's index as given, in the same order.
    indices: Vec<u32>,
    /// Parents before their children, the lower child right behind its parent.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// The slots below this node.
    slots: (u32, u32),
    /// The upper child; 0 for a bucket.
    upper: u32,
}

/// A point found: how far away it is, its index as given, and its slot; ordered as these are.
///
/// One number, since comparing is most of a search: bits of floats that are 0 or more are ordered as the floats are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Near(u128);

impl Near {
    fn new(distance: f64, index: u32, slot: u32) -> Self {
        Self(u128::from(distance.to_bits()) << 64 | u128::from(index) << 32 | u128::from(slot))
    }

    /// Distance to the point searched from.
    pub fn distance(self) -> f64 {
        f64::from_bits((self.0 >> 64) as u64)
    }

    /// Index of the point as given.
    pub fn index(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// Its place in the order of the tree.
    pub fn slot(self) -> u32 {
        self.0 as u32
    }
}

impl PointTree {
    /// A tree of `points`, whose coordinates are finite.
    ///
    /// O(points · log points).
    pub fn new(points: &[DVec3]) -> Self {
        let mut indices: Vec<u32> = (0..points.len() as u32).collect();
        let mut nodes = Vec::with_capacity(4 * points.len() / BUCKET + 1);
        if !points.is_empty() {
            divide(points, &mut indices, 0, &mut nodes);
        }
        let ordered = indices.iter().map(|&index| points[index as usize]).collect();
        Self { points: ordered, indices, nodes }
    }

    /// The points' indices as given, in the order of the tree.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// The point in `slot`.
    pub fn point(&self, slot: usize) -> DVec3 {
        self.points[slot]
    }

    /// Fills `found` with up to `count` points nearest to `p` within `reach`, nearest first; of equally near points
    /// those given first.
    pub fn nearest(&self, p: DVec3, count: usize, reach: f64, found: &mut Vec<Near>) {
        found.clear();
        if self.nodes.is_empty() || count == 0 {
            return;
        }
        // As far as the furthest of the points found, once there are enough. Squares are compared first; their
        // rounding must not shut out what is just as far.
        let slack = |limit: f64| limit * limit * (1.0 + 1e-12);
        let mut limit = slack(reach);
        // Halving leaves fewer levels than an index has bits.
        let mut stack = [(0u32, 0.0f64); 40];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (index, squared) = stack[depth];
            if squared > limit {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.upper != 0 {
                let far = |child: u32| {
                    let Node { low, high, .. } = self.nodes[child as usize];
                    (child, p.distance_squared(p.clamp(low, high)))
                };
                let (lower, upper) = (far(index + 1), far(node.upper));
                let nearer_last = if lower.1 <= upper.1 { [upper, lower] } else { [lower, upper] };
                stack[depth..depth + 2].copy_from_slice(&nearer_last);
                depth += 2;
                continue;
            }
            for slot in node.slots.0..node.slots.1 {
                let squared = p.distance_squared(self.points[slot as usize]);
                let distance = squared.sqrt();
                if squared <= limit && distance <= reach {
                    found.push(Near::new(distance, self.indices[slot as usize], slot));
                }
            }
            // Sorted out now and then only: a bucket more or less is cheaper than an order that is kept.
            if found.len() >= 2 * count {
                let (_, last, _) = found.select_nth_unstable(count - 1);
                limit = slack(last.distance());
                found.truncate(count);
            }
        }
        if found.len() > count {
            found.select_nth_unstable(count - 1);
            found.truncate(count);
        }
        found.sort_unstable();
    }
}

/// Adds the node of `indices`, which begin at slot `start`, and what is below it; the longest side is halved.
fn divide(points: &[DVec3], indices: &mut [u32], start: u32, nodes: &mut Vec<Node>) {
    let (low, high) = bounds(indices.iter().map(|&index| points[index as usize]));
    let node = nodes.len();
    nodes.push(Node { low, high, slots: (start, start + indices.len() as u32), upper: 0 });
    if indices.len() <= BUCKET {
        return;
    }
    let axis = (high - low).max_position();
    let middle = indices.len() / 2;
    indices.select_nth_unstable_by(middle, |&a, &b| {
        points[a as usize][axis].total_cmp(&points[b as usize][axis]).then(a.cmp(&b))
    });
    let (lower, upper) = indices.split_at_mut(middle);
    divide(points, lower, start, nodes);
    nodes[node].upper = nodes.len() as u32;
    divide(points, upper, start + middle as u32, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid with ties everywhere, and a dense clump.
    fn points() -> Vec<DVec3> {
        let grid =
            (0..600).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)));
        let clump = (0..400).map(|i| {
            let (sin, cos) = (f64::from(i) * 1.7).sin_cos();
            DVec3::new(3.0 + 0.1 * sin, 4.0 + 0.05 * cos, 2.0 + 1e-4 * f64::from(i))
        });
        grid.chain(clump).collect()
    }

    #[test]
    fn the_nearest_points_are_those_that_a_sort_finds() {
        let points = points();
        let tree = PointTree::new(&points);
        let mut found = Vec::new();
        for (count, reach) in [(1, 10.0), (24, 1.5), (24, 0.01), (7, 0.0), (2000, 3.0)] {
            for &p in &points {
                tree.nearest(p, count, reach, &mut found);
                let mut sorted: Vec<(f64, u32)> = (0u32..)
                    .zip(&points)
                    .map(|(index, q)| (p.distance(*q), index))
                    .filter(|&(distance, _)| distance <= reach)
                    .collect();
                sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                sorted.truncate(count);
                let pairs: Vec<(f64, u32)> =
                    found.iter().map(|near| (near.distance(), near.index())).collect();
                assert_eq!(pairs, sorted);
                for near in &found {
                    assert_eq!(tree.point(near.slot() as usize), points[near.index() as usize]);
                    assert_eq!(tree.indices()[near.slot() as usize], near.index());
                }
            }
        }
    }

    #[test]
    fn a_tree_of_nothing_finds_nothing() {
        let mut found = vec![Near::new(0.0, 0, 0)];
        PointTree::new(&[]).nearest(DVec3::ZERO, 3, f64::INFINITY, &mut found);
        assert!(found.is_empty());
    }
}
