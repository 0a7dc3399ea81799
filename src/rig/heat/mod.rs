//! Body weights by heat equilibrium (§IV-B, reference 11).
//!
//! Baran and Popović. Automatic rigging and animation of 3D characters. SIGGRAPH 2007, §4.
//!
//! (L + A H) W = A H P: L is the cotangent Laplacian, A the vertices' areas (a third of their triangles'), P the share
//! of each bone among those nearest to a vertex, and H = k c / d² where these are seen from the vertex, else 0; k is how
//! many they are, d how far away. On a tube of radius r whose axis is two bones, the weight of the one is
//! 1 - exp(-√c s / r) / 2 at a distance s from their joint, on its own side.

mod nearest;

use super::solid::Solid;
use super::transfer::{normalised, of_welded};
use super::{WeightBone, WeightSet};
use crate::error::Result;
use crate::geometry::laplacian::{COLUMNS, Cholesky, Symbolic, cotangent_laplacian, has_area};
use crate::geometry::{
    ROUNDING, Rows, SEAM, Weld, bounds, by_key, by_number, components, marked, slots, triangles_where, weld,
};
use crate::parallel;
use crate::progress::Progress;
use glam::DVec3;
use nearest::{Body, Nearest, Segments, hold, nearest_bones, shares};
use std::collections::BTreeMap;

/// What lies further than this from the mesh's middle, in units of the figure, counts as this far, so that squares of
/// distances stay finite. Seen: ±30 % moves no vertex.
const FARTHEST: f64 = 1e6;

/// A component whose bones warm it this much less than it conducts has one temperature up to that share; the rounding
/// of the solve would be as large. Seen: ±30 % moves no vertex.
const LEAST_EXCHANGE: f64 = 1e-9;

/// c is taken into this range, outside of which nothing but rounding changes. Seen: ±30 % moves no vertex.
const HEAT_RANGE: [f64; 2] = [1e-4, 1e6];

/// What the diagonal is raised by, relative to itself, where the system is not positive definite for rounding. Tried
/// one after the other, 0 first, so that what needs none is exact.
const SHIFTS: [f64; 4] = [0.0, 1e-10, 1e-7, 1e-4];

/// What heat can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatOptions {
    /// c, above 0.
    pub heat: f64,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

/// Weights of all `positions` to the joints of `bones`.
///
/// Positions and bones are in one space of any unit. For several c on one mesh see [`HeatSystem`], whose rules these
/// are.
pub fn heat_weights(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    bones: &[WeightBone],
    options: &HeatOptions,
) -> WeightSet {
    let mut quiet = Progress::none();
    HeatSystem::new(positions, triangles, bones, options.thread_count, &mut quiet)
        .and_then(|system| system.weights(options.heat, &mut quiet))
        .expect("nobody asks to stop")
}

/// The heat equation of a mesh and its bones, for any c.
///
/// Vertices at one position are one. What hides a bone from a vertex is the vertex's own connected component, so teeth see
/// through lips, and air between the two, where the body is known. A bone counts as the farther away the more the way to it
/// leaves the surface's inside, which `solid::sides` finds: which way triangles face does not matter. Every vertex gets weights, by other rules where the
/// equation has no answer; the report counts these vertices:
///
/// - `component_without_visible_bone`: no vertex of the component sees its nearest bone: all are taken to see it.
/// - `component_too_small`: a component so small that it has one temperature: the mean of its vertices' nearest bones.
/// - `vertex_without_triangle`: in no triangle with an area: the nearest bones, in equal shares.
/// - `vertex_without_heat`: the solution has nothing there for rounding: the nearest bones.
/// - `system_raised`: rounding made the system indefinite; its diagonal was raised by up to 1e-4 of itself.
/// - `no_bone`: no bone has a segment with finite ends: all vertices hang from the first bone's joint, or from joint 0.
#[derive(Debug)]
pub struct HeatSystem {
    thread_count: usize,
    weld: Weld,
    /// The joint of each bone.
    joints: Vec<u32>,
    /// The bones that are nearest to each welded vertex, with their shares.
    nearest: Rows<(u32, f64)>,
    /// The component of each welded vertex.
    components: Vec<u32>,
    /// How each component gets its weights.
    rules: Vec<Rule>,
    /// The diagonal of L.
    diagonal: Vec<f64>,
    /// The diagonal of A H / c.
    exchange: Vec<f64>,
    symbolic: Option<Symbolic>,
}

/// The bones that hold a vertex in place of the nearest ones, with shares of 1; none where the nearest do.
pub type Held = Vec<(u32, f64)>;

/// (vertex, bone, weight) of some bones, by vertices.
type Solution = Vec<(u32, u32, f64)>;

/// How a component gets its weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    /// By the equation.
    Heat,
    /// By the equation, where every vertex is taken to see its nearest bones.
    Unseen,
    /// As one.
    Small,
    /// A vertex in no triangle: by its nearest bones.
    Loose,
}

impl HeatSystem {
    /// Makes the equation ready: welds, looks for the bones, analyses the system.
    ///
    /// - `positions`, `bones`: in one space of any unit; a vertex that is not finite counts as the middle of the
    ///   mesh, a segment that is not finite as none.
    /// - `triangles`: those with a vertex that is not there are left out.
    /// - `thread_count`: 0 means all cores. Results are the same for any number.
    ///
    /// # Errors
    /// `Cancelled`.
    ///
    /// One ray a vertex, one look at every segment.
    pub fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        bones: &[WeightBone],
        thread_count: usize,
        progress: &mut Progress,
    ) -> Result<Self> {
        Self::in_body(positions, triangles, bones, (None, &Vec::new), thread_count, progress)
    }

    /// As [`HeatSystem::new`], of vertices that are part of the body `solid`, in whose space they are: bones are hidden by
    /// the air around it as well. `held` makes, beside all else: by vertex, as indices into `bones`; may be empty.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn in_body(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        bones: &[WeightBone],
        (solid, held): (Option<&Solid>, &(dyn Fn() -> Vec<Held> + Sync)),
        thread_count: usize,
        progress: &mut Progress,
    ) -> Result<Self> {
        let triangles = triangles_where(triangles, |vertex| vertex < positions.len());
        let frame = Frame::of(positions, &triangles, bones);
        let mut points: Vec<DVec3> = positions.iter().map(|&p| frame.place(p)).collect();
        let mut weld = weld(&points, SEAM);
        points = weld.first_vertices().iter().map(|&vertex| points[vertex as usize]).collect();
        arrange(&mut weld, &mut points);
        let (components, triangles) =
            pieces(&points, triangles.into_iter().map(|corners| weld.triangle(corners)));
        let segments = Segments::of(bones, &frame);
        let body = solid.map(|solid| Body { solid, frame });
        progress.at(0.2)?;
        let ((laplacian, symbolic, held), nearest) = parallel::both(
            thread_count,
            || {
                let mut laplacian = cotangent_laplacian(&points, &triangles.things);
                let symbolic = Symbolic::new(points.len(), &laplacian.off_diagonal);
                laplacian.off_diagonal = Vec::new();
                (laplacian, symbolic, held())
            },
            || {
                let progress = &mut progress.part(0.2, 0.9);
                nearest_bones(&points, (&components, &triangles), &segments, body, thread_count, progress)
            },
        );
        let mut nearest = nearest?;
        hold(&mut nearest, &held, &weld);
        let mut system = Self {
            thread_count,
            weld,
            joints: bones.iter().map(|bone| bone.joint).collect(),
            exchange: laplacian.areas.iter().zip(&nearest).map(|(area, near)| area * near.heat).collect(),
            nearest: shares(&nearest),
            rules: Vec::new(),
            components,
            diagonal: laplacian.diagonal,
            symbolic,
        };
        system.choose_rules(&triangles, &nearest);
        progress.at(1.0)?;
        Ok(system)
    }

    /// Tells how each component gets its weights, and takes the rest out of the system.
    fn choose_rules(&mut self, triangles: &Rows<[u32; 3]>, nearest: &[Nearest]) {
        let count = triangles.count();
        let seeing = nearest.iter().zip(&self.components).filter(|(near, _)| near.is_seen);
        let sees = marked(count, seeing.map(|(_, &component)| component as usize));
        let (mut exchanged, mut conducted) = (vec![0.0; count], vec![0.0_f64; count]);
        for (vertex, &component) in self.components.iter().enumerate() {
            let component = component as usize;
            if sees[component] && !nearest[vertex].is_seen {
                self.exchange[vertex] = 0.0;
            }
            exchanged[component] += self.exchange[vertex];
            conducted[component] = conducted[component].max(self.diagonal[vertex]);
        }
        let rule = |component: usize| {
            if triangles.of(component).is_empty() {
                Rule::Loose
            } else if exchanged[component] < LEAST_EXCHANGE * conducted[component] {
                Rule::Small
            } else if sees[component] {
                Rule::Heat
            } else {
                Rule::Unseen
            }
        };
        self.rules = (0..count).map(rule).collect();
        for vertex in 0..self.diagonal.len() {
            if !self.is_solved(vertex) {
                // Its row is not asked for; this makes it definite for sure.
                self.diagonal[vertex] = 2.0 * self.diagonal[vertex] + 1.0;
            }
        }
    }

    /// The weights for one c (1 spreads weights over about a limb's radius; larger is sharper), taken into 1e-4..1e6.
    ///
    /// A row has every joint whose weight is at least 1e-6, in ascending order.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn weights(&self, heat: f64, progress: &mut Progress) -> Result<WeightSet> {
        let count = self.weld.count;
        if self.nearest.things.is_empty() {
            let row = vec![(self.joints.first().copied().unwrap_or(0), 1.0)];
            return Ok(of_welded(&self.weld, &vec![row; count], &vec![Some("no_bone"); count]));
        }
        // Also where it is not a number.
        let heat = if heat > HEAT_RANGE[0] { heat.min(HEAT_RANGE[1]) } else { HEAT_RANGE[0] };
        let (blocks, is_raised) = self.solve(heat, &mut progress.part(0.0, 0.8))?;
        let entries = blocks.iter().flatten().map(|&(vertex, bone, weight)| (vertex, (bone, weight)));
        let solved = by_number(count, entries);
        drop(blocks);
        let means = self.means();
        let weigh = |vertex: usize| {
            let solved = solved.of(vertex);
            let nearest = self.nearest.of(vertex);
            let component = self.components[vertex] as usize;
            let (row, rule) = match self.rules[component] {
                Rule::Loose => (nearest, Some("vertex_without_triangle")),
                Rule::Small => (&*means[component], Some("component_too_small")),
                Rule::Unseen | Rule::Heat if solved.is_empty() => (nearest, Some("vertex_without_heat")),
                Rule::Unseen => (solved, Some("component_without_visible_bone")),
                Rule::Heat => (solved, is_raised.then_some("system_raised")),
            };
            let of_joints = row.iter().map(|&(bone, weight)| (self.joints[bone as usize], weight));
            (normalised(of_joints.collect()), rule)
        };
        let (rows, rules): (Vec<_>, Vec<_>) = (0..count).map(weigh).unzip();
        let weights = of_welded(&self.weld, &rows, &rules);
        progress.at(1.0)?;
        Ok(weights)
    }

    /// The solution by blocks of bones, and whether the diagonal was raised.
    fn solve(&self, heat: f64, progress: &mut Progress) -> Result<(Vec<Solution>, bool)> {
        let factored = SHIFTS.iter().find_map(|&shift| {
            let diagonal: Vec<f64> = (self.diagonal.iter().zip(&self.exchange))
                .map(|(&conducted, &exchanged)| (conducted + heat * exchanged) * (1.0 + shift))
                .collect();
            Some((Cholesky::with(self.symbolic.as_ref()?, &diagonal)?, shift))
        });
        let Some((cholesky, shift)) = factored else {
            return Ok((Vec::new(), false));
        };
        progress.at(0.4)?;
        // (vertex, share) by bones: A H P / c without its zeros.
        let size = self.weld.count;
        let warmed = (0..size).filter(|&vertex| self.exchange[vertex] > 0.0 && self.is_solved(vertex));
        let shares = warmed.flat_map(|vertex| {
            self.nearest.of(vertex).iter().map(move |&(bone, share)| (bone, (vertex, share)))
        });
        let sources: Vec<(u32, Vec<(usize, f64)>)> = by_key(shares).into_iter().collect();
        let blocks: Vec<_> = sources.chunks(COLUMNS).collect();
        let solved = |&mut (): &mut (), block: usize| {
            let sources = blocks[block];
            let mut columns = vec![0.0; sources.len() * size];
            for (column, (_, source)) in columns.chunks_mut(size).zip(sources) {
                for &(vertex, share) in source {
                    column[vertex] = heat * self.exchange[vertex] * share;
                }
            }
            cholesky.solve(&mut columns, sources.len());
            let mut solution = Vec::new();
            for vertex in 0..size {
                for (&(bone, _), column) in sources.iter().zip(columns.chunks(size)) {
                    if column[vertex] >= ROUNDING {
                        solution.push((vertex as u32, bone, column[vertex]));
                    }
                }
            }
            solution
        };
        let mut progress = progress.part(0.4, 1.0);
        let solutions = progress.collect_with(self.thread_count, blocks.len(), 1, || (), solved)?;
        Ok((solutions, shift > 0.0))
    }

    /// The bones of components that have one temperature.
    fn means(&self) -> Vec<Vec<(u32, f64)>> {
        let mut means: Vec<BTreeMap<u32, f64>> = vec![BTreeMap::new(); self.rules.len()];
        for (vertex, &component) in self.components.iter().enumerate() {
            if self.rules[component as usize] == Rule::Small {
                for &(bone, share) in self.nearest.of(vertex) {
                    *means[component as usize].entry(bone).or_insert(0.0) += share;
                }
            }
        }
        means.into_iter().map(|mean| mean.into_iter().collect()).collect()
    }

    /// True where a vertex gets its weights by the equation.
    fn is_solved(&self, vertex: usize) -> bool {
        matches!(self.rules[self.components[vertex] as usize], Rule::Heat | Rule::Unseen)
    }
}

/// Numbers the welded vertices along a curve through space, so that neighbours are near each other in memory, whatever
/// the order of a file: rays, assembly and solves all go through them in order.
///
/// Morton. A computer oriented geodetic data base and a new technique in file sequencing. IBM, 1966.
fn arrange(weld: &mut Weld, points: &mut Vec<DVec3>) {
    let spread = |x: f64| {
        let mut bits = ((x + 0.5) * 1023.0) as u64 & 1023;
        for (shift, mask) in [(16, 0x0300_00ff), (8, 0x0300_f00f), (4, 0x030c_30c3), (2, 0x0924_9249)] {
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by_cached_key(|&vertex| {
        let p = points[vertex as usize];
        spread(p.x) | spread(p.y) << 1 | spread(p.z) << 2
    });
    let numbers = slots(points.len(), &order);
    *points = order.iter().map(|&vertex| points[vertex as usize]).collect();
    for welded in &mut weld.representative {
        *welded = numbers[*welded as usize];
    }
}

/// The space in which the mesh's longest side is 1, around its middle.
#[derive(Clone, Copy, Debug)]
struct Frame {
    centre: DVec3,
    scale: f64,
}

impl Frame {
    /// Of the triangles; where these have no extent of all vertices, or else of the bones.
    fn of(positions: &[DVec3], triangles: &[[u32; 3]], bones: &[WeightBone]) -> Self {
        let corners = triangles.iter().flatten().map(|&vertex| positions[vertex as usize]);
        let ends = bones.iter().flat_map(|bone| bone.segments.iter().flatten().copied());
        Self::around(corners)
            .or_else(|| Self::around(positions.iter().copied()))
            .or_else(|| Self::around(ends))
            .unwrap_or(Self { centre: DVec3::ZERO, scale: 1.0 })
    }

    fn around(points: impl Iterator<Item = DVec3>) -> Option<Self> {
        let (low, high) = bounds(points.filter(|p| p.is_finite()));
        let (centre, scale) = (0.5 * low + 0.5 * high, (high - low).max_element().recip());
        (centre.is_finite() && scale.is_finite() && scale > 0.0).then_some(Self { centre, scale })
    }

    /// The point that was placed at `p`.
    fn original(&self, p: DVec3) -> DVec3 {
        p / self.scale + self.centre
    }

    fn place(&self, p: DVec3) -> DVec3 {
        let placed = (p - self.centre) * self.scale;
        let farthest = DVec3::splat(FARTHEST);
        if placed.is_nan() { DVec3::ZERO } else { placed.clamp(-farthest, farthest) }
    }
}

/// The component of each vertex, and by component the triangles with an area, which join them: a vertex in none of these is a
/// component of its own.
fn pieces(points: &[DVec3], triangles: impl Iterator<Item = [u32; 3]>) -> (Vec<u32>, Rows<[u32; 3]>) {
    let triangles: Vec<[u32; 3]> =
        triangles.filter(|corners| has_area(corners.map(|vertex| points[vertex as usize]))).collect();
    let components = components(&triangles, &Weld::alone(points.len()));
    let count = components.iter().max().map_or(0, |&last| last as usize + 1);
    let triangles =
        by_number(count, triangles.iter().map(|&corners| (components[corners[0] as usize], corners)));
    (components, triangles)
}
