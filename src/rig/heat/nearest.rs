//! The bones that are nearest to each vertex, and whether it sees them.

use super::{Components, Frame, Held};
use crate::error::Result;
use crate::geometry::{ROUNDING, Surface, Weld, foot};
use crate::parallel;
use crate::progress::Progress;
use crate::rig::WeightBone;
use crate::rig::solid::Solid;
use crate::rig::solid::sides::outward;
use glam::DVec3;

/// A bone shares a vertex fully up to this ratio of its distance to the least one (baran and Popović, §4: the nearest
/// bones share a vertex; seen: at 1.3 vertices move up to 0.58 H), ...
const EQUAL: f64 = 1.0 + 1e-4;
/// ... and not at all from this one on. Between them the share falls off, so that a vertex in the plane of symmetry
/// keeps both legs alike however it is rounded. Seen: at 1.3, vertices move up to 0.044 H.
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

/// Vertices that are looked at together. Time alone.
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
        for (bone, &[a, b]) in
            (0u32..).zip(bones).flat_map(|(index, bone)| bone.segments.iter().map(move |ends| (index, ends)))
        {
            if !(a.is_finite() && b.is_finite()) {
                continue;
            }
            let (a, b) = (frame.place(a), frame.place(b));
            let inverse = (b - a).length_squared().recip();
            all.bones.push(bone);
            all.inverse.push(if inverse.is_finite() { inverse } else { 0.0 });
            for axis in 0..3 {
                all.starts[axis].push(a[axis]);
                all.ways[axis].push(b[axis] - a[axis]);
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

/// The bones that are nearest to each vertex.
#[derive(Debug, Default)]
pub(super) struct NearestBones {
    /// Where each vertex's bones start in `shares`; one more than there are vertices.
    pub(super) starts: Vec<u32>,
    /// Bones and their shares; those of a vertex sum to 1. Only those that are seen, where any is.
    pub(super) shares: Vec<(u32, f64)>,
    /// k / d² of those.
    pub(super) heat: Vec<f64>,
    /// Whether any is seen.
    pub(super) seen: Vec<bool>,
}

impl NearestBones {
    /// One ray a vertex and bone that is as near as the nearest.
    pub(super) fn of(
        points: &[DVec3],
        pieces: &Components,
        segments: &Segments,
        body: Option<Body>,
        thread_count: usize,
        progress: &mut Progress,
    ) -> Result<Self> {
        progress.at(0.0)?;
        let component_count = pieces.starts.len() - 1;
        let normals = outward(points, &pieces.triangles);
        let surfaces = parallel::collect(thread_count, component_count, 1, |component| {
            Surface::for_many(points, pieces.triangles_of(component))
        });
        progress.at(0.3)?;
        let chunks: Vec<&[DVec3]> = points.chunks(CHUNK).collect();
        let found = progress.part(0.3, 1.0).collect_with(
            thread_count,
            chunks.len(),
            1,
            || (vec![0.0; segments.bones.len()], Vec::new()),
            |(squared, near), chunk| {
                let mut found = Self::default();
                let vertices = chunks[chunk].iter().zip(&normals[chunk * CHUNK..]);
                for ((&p, &normal), &component) in vertices.zip(&pieces.components[chunk * CHUNK..]) {
                    segments.near(p, normal, squared, near);
                    found.push(p, surfaces.get(component as usize), segments, body, near);
                }
                found
            },
        )?;
        let mut all = Self { starts: vec![0], ..Self::default() };
        for chunk in found {
            let start = all.shares.len() as u32;
            all.starts.extend(chunk.starts.iter().map(|end| start + end));
            all.shares.extend(chunk.shares);
            all.heat.extend(chunk.heat);
            all.seen.extend(chunk.seen);
        }
        Ok(all)
    }

    /// Adds a vertex; `near` are the bones near to it. Here `starts` are ends.
    fn push(
        &mut self,
        p: DVec3,
        surface: Option<&Surface>,
        segments: &Segments,
        body: Option<Body>,
        near: &mut Vec<NearBone>,
    ) {
        let least = near.iter().fold(f64::INFINITY, |least, bone| least.min(bone.distance));
        let mut last = None;
        let is_seen = |bone: &NearBone| {
            let way = segments.foot(bone.segment as usize, p) - p;
            // Bones that share a joint share the ray to it.
            match last {
                Some((known, is_seen)) if known == way => is_seen,
                _ => {
                    let is_hidden = body.is_some_and(|body| body.hides(p, way))
                        || surface.is_some_and(|surface| {
                            surface.is_hit(p + RAY_MARGIN * way, way, 1.0 - 2.0 * RAY_MARGIN)
                        });
                    last = Some((way, !is_hidden));
                    !is_hidden
                }
            }
        };
        let seen: Vec<bool> = near.iter().map(is_seen).collect();
        let any_seen = seen.contains(&true);
        if any_seen {
            let mut seen = seen.into_iter();
            near.retain(|_| seen.next() == Some(true));
        }
        let k: f64 = near.iter().map(|bone| bone.share).sum();
        self.shares.extend(near.iter().map(|bone| (bone.bone, bone.share / k)));
        self.starts.push(self.shares.len() as u32);
        self.heat.push(if near.is_empty() { 0.0 } else { k / (least * least) });
        self.seen.push(any_seen);
    }

    /// The same with `held` bones for the vertices that have any: as if these were near and seen.
    pub(super) fn held(self, held: &[Held], weld: &Weld) -> Self {
        if held.iter().all(Vec::is_empty) {
            return self;
        }
        let mut of_welded: Vec<&[(u32, f64)]> = vec![&[]; self.heat.len()];
        for (held, &welded) in held.iter().zip(&weld.representative) {
            of_welded[welded as usize] = held;
        }
        let mut all = Self { starts: vec![0], ..Self::default() };
        for (vertex, &held) in of_welded.iter().enumerate() {
            all.shares.extend_from_slice(if held.is_empty() { self.shares_of(vertex) } else { held });
            all.starts.push(all.shares.len() as u32);
            all.heat.push(if held.is_empty() { self.heat[vertex] } else { HELD_DISTANCE.powi(-2) });
            all.seen.push(!held.is_empty() || self.seen[vertex]);
        }
        all
    }

    pub(super) fn shares_of(&self, vertex: usize) -> &[(u32, f64)] {
        &self.shares[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
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
