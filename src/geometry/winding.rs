//! How often a surface goes round a point: which side of it the point is on, however open the surface is.
//!
//! Jacobson, Kavan and Sorkine-Hornung. Robust inside-outside segmentation using generalized winding numbers. SIGGRAPH 2013.
//! Barill, Dickson, Schmidt, Levin and Jacobson. Fast winding numbers for soups and clouds. SIGGRAPH 2018.
//! van Oosterom and Strackee. The solid angle of a plane triangle. IEEE Trans. Biomed. Eng. 30(2), 1983.

use super::bounds;
use glam::DVec3;
use std::f64::consts::PI;

/// Triangles further away than this many times their reach are one dipole: 2 in the paper.
const FAR: f64 = 2.5;
/// So few triangles are not parted. Time alone.
const FEW: usize = 4;

/// Triangles, and what groups of them are from far away.
#[derive(Clone, Debug, Default)]
pub struct Winding {
    /// Each before the groups that it is parted into.
    groups: Vec<Group>,
    /// The triangles, group by group, and where their corners are.
    triangles: Vec<[u32; 3]>,
    corners: Vec<[DVec3; 3]>,
}

#[derive(Clone, Debug, Default)]
struct Group {
    /// Its triangles.
    first: u32,
    last: u32,
    /// The number of the first group that is no part of it; of one that is not parted that of the next.
    end: u32,
    centre: DVec3,
    /// How far its triangles reach from there.
    reach: f64,
    /// The sum of their normals, each as long as its triangle is large.
    dipole: DVec3,
}

impl Winding {
    /// Of `triangles` between `points`.
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let middle =
            |corners: &[u32; 3]| corners.map(|vertex| points[vertex as usize]).iter().sum::<DVec3>() / 3.0;
        let mut items: Vec<(DVec3, [u32; 3])> =
            triangles.iter().map(|corners| (middle(corners), *corners)).collect();
        let mut groups = Vec::new();
        part(&mut items, 0, &mut groups);
        let triangles = items.into_iter().map(|(_, corners)| corners).collect();
        Self { groups, triangles, corners: Vec::new() }.moved(points)
    }

    /// Of the same triangles between other points, in the same groups: sooner, the same but for what groups far away are taken for.
    pub fn moved(&self, points: &[DVec3]) -> Self {
        let Self { groups, triangles, .. } = self;
        let corners: Vec<[DVec3; 3]> =
            triangles.iter().map(|corners| corners.map(|vertex| points[vertex as usize])).collect();
        let items: Vec<(f64, DVec3, DVec3)> = corners
            .iter()
            .map(|&[a, b, c]| {
                let normal = 0.5 * (b - a).cross(c - a);
                (normal.length(), (a + b + c) / 3.0, normal)
            })
            .collect();
        let group = |group: &Group| {
            let of = group.first as usize..group.last as usize;
            let area: f64 = items[of.clone()].iter().map(|item| item.0).sum();
            let middle: DVec3 = items[of.clone()].iter().map(|&(area, middle, _)| area * middle).sum();
            let centre = if area > 0.0 { middle / area } else { corners[of.start][0] };
            let squares = corners[of.clone()].iter().flatten().map(|p| p.distance_squared(centre));
            let reach = squares.fold(0.0, f64::max).sqrt();
            Group { centre, reach, dipole: items[of].iter().map(|item| item.2).sum(), ..*group }
        };
        Self { groups: groups.iter().map(group).collect(), triangles: triangles.clone(), corners }
    }

    /// How often the surface goes round `p`: 1 inside of a closed one that is wound counter-clockwise, 0 outside.
    pub fn at(&self, p: DVec3) -> f64 {
        let (mut angle, mut next) = (0.0, 0);
        while let Some(group) = self.groups.get(next) {
            let way = group.centre - p;
            let square = way.length_squared();
            if square > (FAR * group.reach) * (FAR * group.reach) {
                angle += group.dipole.dot(way) / (square * square.sqrt());
                next = group.end as usize;
            } else {
                next += 1;
                if next == group.end as usize {
                    let near = &self.corners[group.first as usize..group.last as usize];
                    angle += near.iter().map(|corners| solid_angle(corners.map(|q| q - p))).sum::<f64>();
                }
            }
        }
        angle / (4.0 * PI)
    }
}

/// Sorts triangles, of which `first` come before, into groups by their middles.
fn part(items: &mut [(DVec3, [u32; 3])], first: u32, groups: &mut Vec<Group>) {
    if items.is_empty() {
        return;
    }
    let group = groups.len();
    groups.push(Group { first, last: first + items.len() as u32, ..Group::default() });
    if items.len() > FEW {
        let (low, high) = bounds(items.iter().map(|item| item.0));
        let axis = (high - low).max_position();
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]));
        let (left, right) = items.split_at_mut(half);
        part(left, first, groups);
        part(right, first + half as u32, groups);
    }
    groups[group].end = groups.len() as u32;
}

fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
}
