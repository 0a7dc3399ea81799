//! A figure that is its own mirror image stays one (product mode).
//!
//! Rigs are not: elbows lie beside the middle of their arm, weights are painted on one side, squares are all split the same way.
//! What is made of such numbers is a little askew, and a pair of hands shows it. So in the end the halves are made each other's
//! image: a vertex goes the mean of its own way and the mirrored way of its twin.

use super::pieces::once;
use crate::character::MeshKind;
use crate::geometry::point_tree::Near;
use crate::geometry::{PointTree, Weld, by_key, smoothstep, upper_median, weld};
use crate::parallel;
use crate::shape::figure::Figure;
use glam::DVec3;

/// A vertex has a twin where its mirror image is no further from one than this share of H; at half of that it is one whole. D34:
/// a hundred times what a float rounds, a twentieth of a fine mesh's edges.
const TWIN: f64 = 1e-4;
/// A figure counts as symmetric where more than the first of these shares of its places, hair aside, has a twin; wholly at the
/// second. D34. Seen: people with a watch or a bag have .89 to 1; Seed-san .80, of whose clothes 3 % end inside of her where she counts.
const SYMMETRIC: (f64, f64) = (0.82, 0.88);
/// A vertex without a twin goes as so many around it do that have one, the furthest not at all. D34: the fewest around a point.
const AROUND: usize = 5;
/// As many vertices at one place are told apart by what they belong to: more than seams repeat one.
const AT_ONE_PLACE: usize = 16;

/// A plane.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: DVec3,
    /// Of its points, along the normal.
    at: f64,
}

impl Plane {
    fn image(self, p: DVec3) -> DVec3 {
        p - 2.0 * (p.dot(self.normal) - self.at) * self.normal
    }

    fn image_of_way(self, way: DVec3) -> DVec3 {
        way - 2.0 * way.dot(self.normal) * self.normal
    }
}

/// Which points are each other's mirror image.
#[derive(Debug)]
pub struct Mirror {
    plane: Plane,
    /// Of each vertex, and of each joint after them, its twin, and how much of one that is.
    twins: Vec<(u32, f64)>,
    /// Those that have none, or none whole, and what they go by instead: vertices and their shares.
    others: Vec<(u32, [(u32, f64); AROUND])>,
    /// What goes as one, of vertices or of joints: one at each of its places, and all.
    as_one: Vec<[Vec<u32>; 2]>,
    /// How symmetric the figure is.
    share: f64,
}

impl Mirror {
    /// The twins of `figure`'s vertices and joints; `None` where it is not symmetric.
    ///
    /// - `weld`: its vertices by position: how often seams repeat one must not matter.
    /// - `goes_with`: what goes as one that a vertex is of, or, after the vertices, a joint: what keeps its shape, where it is not
    ///   wholly of twins, and the joints of an arm, so that it keeps its angles.
    /// - `threads`: at most this many, 0 for all cores; the result does not depend on it.
    ///
    /// O(vertices · log vertices).
    pub fn of<Thing: Ord>(
        figure: &Figure,
        weld: &Weld,
        goes_with: impl Fn(usize) -> Option<Thing>,
        threads: usize,
    ) -> Option<Self> {
        let Figure { positions, joints, .. } = figure;
        let firsts = weld.first_vertices();
        let tolerance = TWIN * figure.height();
        let mesh = |vertex: usize| figure.mesh_starts.partition_point(|&start| start <= vertex);
        let belongs: Vec<(usize, usize)> =
            (0..positions.len()).map(|vertex| (mesh(vertex), figure.kind(vertex) as usize)).collect();
        let tree = PointTree::new(positions);
        let mut counts: Vec<usize> = firsts.iter().map(|&vertex| vertex as usize).collect();
        counts.retain(|&vertex| figure.kind(vertex) != MeshKind::Hair);
        let halved = |normal: DVec3| {
            let plane = plane(positions, normal, tolerance)?;
            let twins = twins(positions, &tree, plane, tolerance, &belongs, threads);
            let sum: f64 = counts.iter().map(|&vertex| twins[vertex].1).sum();
            Some((sum / counts.len() as f64, plane, twins))
        };
        let found = left_of(figure).into_iter().filter_map(halved);
        let (symmetric, plane, mut twins) = found.max_by(|one, other| one.0.total_cmp(&other.0))?;
        let share = smoothstep((symmetric - SYMMETRIC.0) / (SYMMETRIC.1 - SYMMETRIC.0));
        let whole: Vec<u32> =
            firsts.iter().copied().filter(|&vertex| twins[vertex as usize].1 == 1.0).collect();
        if share == 0.0 || whole.len() <= AROUND {
            return None;
        }
        let nothing = vec![(); joints.len()];
        let of_joints = self::twins(joints, &PointTree::new(joints), plane, tolerance, &nothing, 1);
        twins.extend(of_joints.into_iter().map(|(twin, share)| (twin + positions.len() as u32, share)));
        let tree = PointTree::new(&whole.iter().map(|&v| positions[v as usize]).collect::<Vec<_>>());
        let lonely: Vec<u32> =
            (0..twins.len() as u32).filter(|&point| twins[point as usize].1 < 1.0).collect();
        let around = parallel::collect(threads, lonely.len(), parallel::FEW_RAYS, |index| {
            let point = lonely[index] as usize;
            let p = if point < positions.len() { positions[point] } else { joints[point - positions.len()] };
            shares(&tree, p).map(|(index, share)| (whole[index as usize], share))
        });
        let points = 0..twins.len();
        let mut things = by_key(points.filter_map(|point| Some((goes_with(point)?, point as u32))));
        let is_joint = |point: u32| point as usize >= positions.len();
        things.retain(|_, thing| thing.iter().any(|&point| is_joint(point) || twins[point as usize].1 < 1.0));
        let at_places = |thing: Vec<u32>| {
            let places = if is_joint(thing[0]) { thing.clone() } else { once(weld, &thing) };
            [places, thing]
        };
        let as_one = things.into_values().map(at_places).collect();
        let others = lonely.into_iter().zip(around).collect();
        Some(Self { plane, twins, others, as_one, share })
    }

    /// What is added to the way of each vertex, and of each joint after them, so that the halves are each other's image.
    pub fn corrections(&self, way: impl Fn(usize) -> DVec3) -> Vec<DVec3> {
        let correction = |(point, &(twin, share)): (usize, &(u32, f64))| {
            if share == 0.0 {
                return DVec3::ZERO;
            }
            0.5 * self.share * share * (self.plane.image_of_way(way(twin as usize)) - way(point))
        };
        let mut corrections: Vec<DVec3> = self.twins.iter().enumerate().map(correction).collect();
        for &(point, around) in &self.others {
            let others: DVec3 =
                around.iter().map(|&(vertex, share)| share * corrections[vertex as usize]).sum();
            corrections[point as usize] += (1.0 - self.twins[point as usize].1) * others;
        }
        for [places, all] in &self.as_one {
            let sum: DVec3 = places.iter().map(|&point| corrections[point as usize]).sum();
            let mean = sum / places.len() as f64;
            all.iter().for_each(|&point| corrections[point as usize] = mean);
        }
        corrections
    }
}

/// The ways that may be a figure's left: its own, and the axis of model space next to that, as its joints may be askew.
fn left_of(figure: &Figure) -> Vec<DVec3> {
    let frame = &figure.frame;
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| frame.to_canonical(axis));
    let next = axes.into_iter().max_by(|one, other| one.x.abs().total_cmp(&other.x.abs()));
    let is_another = |axis: &DVec3| axis.x.abs() < 1.0 - f64::EPSILON;
    std::iter::once(DVec3::X).chain(next.filter(is_another)).collect()
}

/// The plane across `normal` that halves `points`: through the median of the middles of what lies at one place beside it; `None`
/// where nothing does.
fn plane(points: &[DVec3], normal: DVec3, tolerance: f64) -> Option<Plane> {
    let beside: Vec<DVec3> = points.iter().map(|p| p.reject_from_normalized(normal)).collect();
    let weld = weld(&beside, tolerance);
    let mut ends = vec![(f64::INFINITY, f64::NEG_INFINITY); weld.count];
    for (p, &group) in points.iter().zip(&weld.representative) {
        let (low, high) = &mut ends[group as usize];
        let along = p.dot(normal);
        (*low, *high) = (low.min(along), high.max(along));
    }
    let beside = ends.into_iter().filter(|(low, high)| high - low > 2.0 * tolerance);
    upper_median(beside.map(|(low, high)| (low + high) / 2.0)).map(|at| Plane { normal, at })
}

/// The twin of each point of `tree`, and how much of one it is; of several at one place that which belongs to the same, as
/// `belongs` tells.
fn twins<B: Eq + Sync>(
    points: &[DVec3],
    tree: &PointTree,
    plane: Plane,
    tolerance: f64,
    belongs: &[B],
    threads: usize,
) -> Vec<(u32, f64)> {
    parallel::collect(threads, points.len(), parallel::FEW_RAYS, |point| {
        let mut near = Vec::new();
        tree.nearest(plane.image(points[point]), AT_ONE_PLACE, tolerance, &mut near);
        let is_of_another = |near: &&Near| belongs[near.index() as usize] != belongs[point];
        near.iter().min_by_key(is_of_another).map_or((point as u32, 0.0), |twin| {
            (twin.index(), 1.0 - smoothstep(2.0 * twin.distance() / tolerance - 1.0))
        })
    })
}

/// The points of `tree` around `p`, and how much each counts: the more the nearer, without a jump where another is nearer.
fn shares(tree: &PointTree, p: DVec3) -> [(u32, f64); AROUND] {
    let mut near = Vec::new();
    tree.nearest(p, AROUND, f64::INFINITY, &mut near);
    let furthest = near.last().map_or(0.0, |near| near.distance()).max(f64::MIN_POSITIVE);
    let mut shares = [(0, 0.0); AROUND];
    for (share, near) in shares.iter_mut().zip(&near) {
        let away = near.distance() / furthest;
        *share = (near.index(), ((1.0 - away) / away.max(1e-6)).powi(2));
    }
    let sum: f64 = shares.iter().map(|(_, share)| share).sum();
    if sum == 0.0 {
        // All are as far.
        return shares.map(|(index, _)| (index, 1.0 / AROUND as f64));
    }
    shares.map(|(index, share)| (index, share / sum))
}
