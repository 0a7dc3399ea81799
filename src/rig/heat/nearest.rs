//! The bones that are nearest to each vertex, and whether it sees them.

use super::{Frame, Held};
use crate::error::Result;
use crate::geometry::{ROUNDING, Rows, Surface, Weld, by_number, foot};
use crate::parallel;
use crate::progress::Progress;
use crate::rig::WeightBone;
use crate::rig::solid::Solid;
use crate::rig::solid::sides::outward;
use glam::DVec3;

/// A bone shares a vertex fully up to this ratio of its distance to the least one (Baran and Popović, §4: the nearest
/// bones share a vertex). Seen: at 1.3, vertices move up to 0.58 H.
const EQUAL: f64 = 1.0 + 1e-4;
/// A bone does not share a vertex at all from this ratio of its distance to the least one on. Between `EQUAL` and this
/// the share falls off, so that a vertex in the plane of symmetry keeps both legs alike however it is rounded. Seen: at
/// 1.3, vertices move up to 0.044 H.
const UNEQUAL: f64 = 1.0 + 1e-3;

/// A way straight out of the surface counts as so much longer than one straight into it: no bone is so much farther than
/// another.
const MOST_STRETCH: f64 = 2000.0;

/// So many cells of the body off a surface it is known what is there, since a cell that a surface touches reaches beyond it by less
/// than one: a way to a bone leaves the body where it leads through more air, and the body lies behind a vertex where it is found so
/// far behind it. Seen: at ±30 %, posed vertices lie as far from the artists', to 1 %.
const CLEAR: f64 = 2.0;

/// What is held counts as this far from what holds it, in units of the figure: its weights go over into those of the skin
/// around it within about as much, some cells of a coarse grid. Found by looking.
const HELD_DISTANCE: f64 = 0.02;

/// A ray to a bone leaves out this share of the way at either end: it starts on the surface, and a bone may end there.
/// Seen: ±30 % moves vertices by under 0.0005 H.
const RAY_MARGIN: f64 = 1e-3;

/// Vertices that a thread looks at, at least. Time alone.
const CHUNK: usize = 512;

/// All segments of all bones, by coordinates, so that the distances to them are found side by side.
#[derive(Debug, Default)]
pub(super) struct Segments {
    bones: Vec<u32>,
    starts: [Vec<f64>; 3],
    ways: [Vec<f64>; 3],
    /// 1 / length², 0 for a point.
    inverse: Vec<f64>,
}

impl Segments {
    pub(super) fn of(bones: &[WeightBone], frame: &Frame) -> Self {
        let mut all = Self::default();
        for (index, bone) in (0u32..).zip(bones) {
            for ends in bone.segments.iter().filter(|[a, b]| a.is_finite() && b.is_finite()) {
                let [a, b] = ends.map(|p| frame.place(p));
                let inverse = (b - a).length_squared().recip();
                all.bones.push(index);
                all.inverse.push(if inverse.is_finite() { inverse } else { 0.0 });
                for axis in 0..3 {
                    all.starts[axis].push(a[axis]);
                    all.ways[axis].push(b[axis] - a[axis]);
                }
            }
        }
        all
    }

    /// Fills `squared` with the squared distances of all segments to `p`.
    fn distances(&self, p: DVec3, squared: &mut [f64]) {
        let count = squared.len();
        let [x, y, z] = &self.starts;
        let [u, v, w] = &self.ways;
        let (x, y, z) = (&x[..count], &y[..count], &z[..count]);
        let (u, v, w, inverse) = (&u[..count], &v[..count], &w[..count], &self.inverse[..count]);
        for i in 0..count {
            let (dx, dy, dz) = (p.x - x[i], p.y - y[i], p.z - z[i]);
            let t = ((dx * u[i] + dy * v[i] + dz * w[i]) * inverse[i]).clamp(0.0, 1.0);
            let (dx, dy, dz) = (dx - t * u[i], dy - t * v[i], dz - t * w[i]);
            squared[i] = dx * dx + dy * dy + dz * dz;
        }
    }

    /// The point of a segment that is closest to `p`.
    fn foot(&self, segment: usize, p: DVec3) -> DVec3 {
        let at = |of: &[Vec<f64>; 3]| DVec3::new(of[0][segment], of[1][segment], of[2][segment]);
        let start = at(&self.starts);
        foot(p, start, start + at(&self.ways)).0
    }
}

/// The body that vertices are part of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body<'a> {
    /// In the space of the positions that were given.
    pub(super) solid: &'a Solid,
    /// From that space to the vertices'.
    pub(super) frame: Frame,
}

impl Body<'_> {
    /// True where the body lies behind a vertex and the way in front of it leads through air: a head's side does not see
    /// an arm below it. Cloth without a body right behind it does see one.
    fn hides(&self, p: DVec3, way: DVec3) -> bool {
        let (from, to) = (self.frame.original(p), self.frame.original(p + way));
        let behind = from - CLEAR * self.solid.cell * (to - from).normalize_or_zero();
        self.solid.is_in(behind) && self.solid.air(from, to) > CLEAR * self.solid.cell
    }
}

/// The bones that are nearest to a vertex.
#[derive(Debug)]
pub(super) struct Nearest {
    /// Bones and their shares, of sum 1. Only those that are seen, where any is.
    pub(super) shares: Vec<(u32, f64)>,
    /// k / d² of those.
    pub(super) heat: f64,
    /// Whether any is seen.
    pub(super) is_seen: bool,
}

/// The bones that are nearest to each of `points`, whose `components` have `triangles`: one ray a vertex and bone that is as near
/// as the nearest.
pub(super) fn nearest_bones(
    points: &[DVec3],
    (components, triangles): (&[u32], &Rows<[u32; 3]>),
    segments: &Segments,
    body: Option<Body>,
    thread_count: usize,
    progress: &mut Progress,
) -> Result<Vec<Nearest>> {
    progress.at(0.0)?;
    let normals = outward(points, &triangles.things);
    let surfaces = parallel::collect(thread_count, triangles.count(), 1, |component| {
        Surface::for_many(points, triangles.of(component))
    });
    progress.at(0.3)?;
    progress.part(0.3, 1.0).collect_with(
        thread_count,
        points.len(),
        CHUNK,
        || (vec![0.0; segments.bones.len()], Vec::new()),
        |(squared, near), vertex| {
            let p = points[vertex];
            segments.near(p, normals[vertex], squared, near);
            Nearest::of(p, &surfaces[components[vertex] as usize], segments, body, near)
        },
    )
}

/// The shares of those that are `nearest` to each vertex, in one list.
pub(super) fn shares(nearest: &[Nearest]) -> Rows<(u32, f64)> {
    by_number(
        nearest.len(),
        (0..).zip(nearest).flat_map(|(vertex, near)| near.shares.iter().map(move |&share| (vertex, share))),
    )
}

/// Lets `held` bones of vertices stand in for the nearest ones, as if they were near and seen.
pub(super) fn hold(nearest: &mut [Nearest], held: &[Held], weld: &Weld) {
    let mut of_welded: Vec<&[(u32, f64)]> = vec![&[]; nearest.len()];
    for (held, &welded) in held.iter().zip(&weld.representative) {
        of_welded[welded as usize] = held;
    }
    for (nearest, held) in nearest.iter_mut().zip(of_welded).filter(|(_, held)| !held.is_empty()) {
        *nearest = Nearest { shares: held.to_vec(), heat: HELD_DISTANCE.powi(-2), is_seen: true };
    }
}

impl Nearest {
    /// Those of `near` that a vertex at `p` sees past `surface` and `body`, or all of them.
    fn of(p: DVec3, surface: &Surface, segments: &Segments, body: Option<Body>, near: &[NearBone]) -> Self {
        let least = near.iter().fold(f64::INFINITY, |least, bone| least.min(bone.distance));
        let mut last = (DVec3::NAN, false);
        let sees = |bone: &&NearBone| {
            let way = segments.foot(bone.segment as usize, p) - p;
            // Bones that share a joint share the ray to it.
            if last.0 != way {
                let is_hidden = body.is_some_and(|body| body.hides(p, way))
                    || surface.is_hit(p + RAY_MARGIN * way, way, 1.0 - 2.0 * RAY_MARGIN);
                last = (way, !is_hidden);
            }
            last.1
        };
        let seen: Vec<NearBone> = near.iter().filter(sees).copied().collect();
        let is_seen = !seen.is_empty();
        let bones = if is_seen { &*seen } else { near };
        let k: f64 = bones.iter().map(|bone| bone.share).sum();
        let shares = bones.iter().map(|bone| (bone.bone, bone.share / k)).collect();
        Self { shares, heat: if bones.is_empty() { 0.0 } else { k / (least * least) }, is_seen }
    }
}

/// A bone about as near to a vertex as the nearest one.
#[derive(Clone, Copy, Debug)]
struct NearBone {
    bone: u32,
    /// Its nearest segment.
    segment: u32,
    distance: f64,
    /// 1 as near as the nearest, towards 0 further away.
    share: f64,
}

impl Segments {
    /// Makes the squared distances to `p`, whose outward normal is `normal`, longer: by 2 / (1 + cos) where the way to a
    /// segment leaves the direction straight into the surface. Only of segments that may be the nearest then: the others
    /// stay farther than that.
    fn stretch(&self, p: DVec3, normal: DVec3, squared: &mut [f64]) {
        let sure = normal.length();
        let nearest = (0..squared.len()).min_by(|&a, &b| squared[a].total_cmp(&squared[b]));
        let mut least = f64::INFINITY;
        let others = (0..squared.len()).filter(|&segment| Some(segment) != nearest);
        for segment in nearest.into_iter().chain(others) {
            if squared[segment] > least * UNEQUAL * UNEQUAL {
                continue;
            }
            let way = self.foot(segment, p) - p;
            let inward = -way.dot(normal) / (way.length() * sure).max(f64::MIN_POSITIVE);
            let stretch = (2.0 / (1.0 + inward).max(0.0)).min(MOST_STRETCH);
            squared[segment] *= (1.0 + sure * (stretch - 1.0)).powi(2);
            least = least.min(squared[segment]);
        }
    }

    /// Fills `near` with the bones about as near to `p` as the nearest one.
    fn near(&self, p: DVec3, normal: DVec3, squared: &mut [f64], near: &mut Vec<NearBone>) {
        near.clear();
        self.distances(p, squared);
        if normal != DVec3::ZERO {
            self.stretch(p, normal, squared);
        }
        let least = squared.iter().fold(f64::INFINITY, |least, &distance| least.min(distance));
        let least = least.sqrt().max(ROUNDING);
        let reach = (UNEQUAL * least).powi(2);
        for (segment, &squared) in (0u32..).zip(&*squared) {
            if squared > reach {
                continue;
            }
            let distance = squared.sqrt().max(ROUNDING);
            let share = ((UNEQUAL - distance / least) / (UNEQUAL - EQUAL)).clamp(0.0, 1.0);
            let one = NearBone { bone: self.bones[segment as usize], segment, distance, share };
            match near.last_mut() {
                // Segments of a bone follow each other.
                Some(last) if last.bone == one.bone && distance >= last.distance => {}
                Some(last) if last.bone == one.bone => *last = one,
                Some(_) | None => near.push(one),
            }
        }
        near.retain(|bone| bone.share > 0.0);
    }
}
