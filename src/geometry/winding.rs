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

/// Triangles, and what groups of them are from far away.
#[derive(Clone, Debug, Default)]
pub struct Winding {
    /// Each before the groups that it is parted into.
    groups: Vec<Group>,
}

#[derive(Clone, Debug)]
struct Group {
    centre: DVec3,
    /// How far its triangles reach from there.
    reach: f64,
    /// The sum of their normals, each as long as its triangle is large.
    dipole: DVec3,
    /// The number of the first group that is no part of it.
    end: usize,
    /// The only triangle of one that is not parted.
    triangle: Option<[DVec3; 3]>,
}

impl Winding {
    /// Of `triangles` between `points`.
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut all: Vec<[DVec3; 3]> =
            triangles.iter().map(|corners| corners.map(|vertex| points[vertex as usize])).collect();
        let mut winding = Self::default();
        if !all.is_empty() {
            winding.part(&mut all);
        }
        winding
    }

    fn part(&mut self, triangles: &mut [[DVec3; 3]]) {
        let normal = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a);
        let middle = |[a, b, c]: [DVec3; 3]| (a + b + c) / 3.0;
        let (mut area, mut centre, mut dipole) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for &corners in &*triangles {
            let normal = normal(corners);
            area += normal.length();
            centre += normal.length() * middle(corners);
            dipole += normal;
        }
        let centre = if area > 0.0 { centre / area } else { triangles[0][0] };
        let reach = triangles.iter().flatten().map(|p| p.distance(centre)).fold(0.0, f64::max);
        let group = self.groups.len();
        let triangle = if let [only] = triangles { Some(*only) } else { None };
        self.groups.push(Group { centre, reach, dipole, end: 0, triangle });
        if triangle.is_none() {
            let (low, high) = bounds(triangles.iter().map(|&corners| middle(corners)));
            let axis = (high - low).max_position();
            let half = triangles.len() / 2;
            triangles.select_nth_unstable_by(half, |&a, &b| middle(a)[axis].total_cmp(&middle(b)[axis]));
            let (left, right) = triangles.split_at_mut(half);
            self.part(left);
            self.part(right);
        }
        self.groups[group].end = self.groups.len();
    }

    /// How often the surface goes round `p`: 1 inside of a closed one that is wound counter-clockwise, 0 outside.
    pub fn at(&self, p: DVec3) -> f64 {
        let (mut angle, mut next) = (0.0, 0);
        while let Some(group) = self.groups.get(next) {
            let way = group.centre - p;
            let away = way.length();
            if away > FAR * group.reach {
                angle += group.dipole.dot(way) / (away * away * away);
                next = group.end;
            } else {
                angle += group.triangle.map_or(0.0, |corners| solid_angle(corners.map(|q| q - p)));
                next += 1;
            }
        }
        angle / (4.0 * PI)
    }
}

fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
}
