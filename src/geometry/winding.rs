//! How often a surface goes round a point: which side of it the point is on, however open the surface is.
//!
//! Jacobson, Kavan and Sorkine-Hornung. Robust inside-outside segmentation using generalized winding numbers. SIGGRAPH 2013.
//! Barill, Dickson, Schmidt, Levin and Jacobson. Fast winding numbers for soups and clouds. SIGGRAPH 2018.
//! van Oosterom and Strackee. The solid angle of a plane triangle. IEEE Trans. Biomed. Eng. 30(2), 1983.

use super::bounds;
use glam::DVec3;
use std::f64::consts::PI;
use std::ops::Range;

/// Triangles further away than this many times their reach are one dipole: 2 in the paper.
const FAR: f64 = 2.5;
/// So few triangles are not parted. Time alone.
const FEW: usize = 4;

/// Triangles in groups of those that are near each other: made once for triangles that stay while their corners move.
#[derive(Clone, Debug, Default)]
pub struct WindingGroups {
    /// Each before the groups that it is parted into: its triangles, and the number of the first group that is no part of it, of
    /// one that is not parted that of the next.
    groups: Vec<(Range<usize>, usize)>,
    /// The triangles, group by group.
    triangles: Vec<[u32; 3]>,
}

/// Triangles between points, and what groups of them are from far away.
#[derive(Clone, Debug, Default)]
pub struct Winding {
    groups: Vec<Group>,
    corners: Vec<[DVec3; 3]>,
}

#[derive(Clone, Debug)]
struct Group {
    triangles: Range<usize>,
    end: usize,
    centre: DVec3,
    /// How far its triangles reach from there.
    reach: f64,
    /// The sum of their normals, each as long as its triangle is large.
    dipole: DVec3,
}

impl WindingGroups {
    /// Of `triangles`, which are near each other between `points`.
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let placed = placed(points, triangles);
        let mut items: Vec<(DVec3, [u32; 3])> =
            placed.iter().zip(triangles).map(|([a, b, c], &corners)| ((a + b + c) / 3.0, corners)).collect();
        let mut groups = Vec::new();
        part(&mut items, 0, &mut groups);
        Self { groups, triangles: items.into_iter().map(|(_, corners)| corners).collect() }
    }

    /// The same triangles between `points`.
    pub fn between(&self, points: &[DVec3]) -> Winding {
        let corners = placed(points, &self.triangles);
        // The area, the middle as often, and the normal.
        let item = |&[a, b, c]: &[DVec3; 3]| {
            let normal = 0.5 * (b - a).cross(c - a);
            (normal.length(), normal.length() * ((a + b + c) / 3.0), normal)
        };
        let items: Vec<(f64, DVec3, DVec3)> = corners.iter().map(item).collect();
        let group = |(triangles, end): &(Range<usize>, usize)| {
            let (items, corners) = (&items[triangles.clone()], &corners[triangles.clone()]);
            let area: f64 = items.iter().map(|item| item.0).sum();
            let sum: DVec3 = items.iter().map(|item| item.1).sum();
            let centre = if area > 0.0 { sum / area } else { corners.first().map_or(sum, |[a, ..]| *a) };
            let squares = corners.iter().flatten().map(|p| p.distance_squared(centre));
            let reach = squares.fold(0.0, f64::max).sqrt();
            let dipole = items.iter().map(|item| item.2).sum();
            Group { triangles: triangles.clone(), end: *end, centre, reach, dipole }
        };
        Winding { groups: self.groups.iter().map(group).collect(), corners }
    }
}

impl Winding {
    /// How often the surface goes round `p`: 1 inside of a closed one that is wound counter-clockwise, 0 outside.
    pub fn at(&self, p: DVec3) -> f64 {
        let (mut angle, mut next) = (0.0, 0);
        while let Some(group) = self.groups.get(next) {
            let way = group.centre - p;
            let square = way.length_squared();
            if square > (FAR * group.reach) * (FAR * group.reach) {
                angle += group.dipole.dot(way) / (square * square.sqrt());
                next = group.end;
            } else {
                next += 1;
                if next == group.end {
                    let near = self.corners[group.triangles.clone()].iter();
                    angle += near.map(|corners| solid_angle(corners.map(|q| q - p))).sum::<f64>();
                }
            }
        }
        angle / (4.0 * PI)
    }
}

fn placed(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[DVec3; 3]> {
    triangles.iter().map(|corners| corners.map(|vertex| points[vertex as usize])).collect()
}

/// Sorts triangles, of which `first` come before, into groups by their middles.
fn part(items: &mut [(DVec3, [u32; 3])], first: usize, groups: &mut Vec<(Range<usize>, usize)>) {
    let group = groups.len();
    groups.push((first..first + items.len(), 0));
    if items.len() > FEW {
        let (low, high) = bounds(items.iter().map(|item| item.0));
        let axis = (high - low).max_position();
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]));
        let (left, right) = items.split_at_mut(half);
        part(left, first, groups);
        part(right, first + half, groups);
    }
    groups[group].1 = groups.len();
}

fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
}
