//! Long hair (§VII): what the paper shortens by hand in a modelling program.
//!
//! Hair grows with the head, so hair that ended at the hips would end below the soles. Below the chin its height
//! follows the body instead: hair that ended at the hips still does. It narrows from the head's scale towards the
//! body's, and nowhere becomes broader than it is on the head: hair that spreads over the shoulders of an adult would
//! stand out like a skirt from a child's.

use super::outside::{Outside, rims, volume};
use super::scales::HeadScale;
use crate::geometry::{Mapped, Neighbours, Tree, Weld, neighbours, smoothstep};
use crate::parallel;
use glam::{DMat3, DVec3};

/// The slope of the height's map at the chin, against the mean slope: 1 would be straight, 2 would come to rest at the
/// tips. D28. Seen: 1 turns 27 more triangles over, 2 makes tips discs.
const FIRST_SLOPE: f64 = 1.5;
/// Tips are at least this wide, as a scale of the original. D28. Seen: below, tails become flat.
const NARROWEST_TIP: f64 = 0.6;
/// Heights at which outline and widths are kept, from the chin to the tips. D28. Seen: ±30 % moves hair by up to .012
/// H.
const KNOTS: usize = 17;
/// The share of the hair's vertices at a height that its outline holds. D28. Seen: less lets it jump from lock to lock
/// (352 triangles turn over); all of it would follow stray locks.
const OUTLINE_QUANTILE: f64 = 0.95;

/// How far hair reaches from the head's axis, below the chin.
#[derive(Clone, Debug, PartialEq)]
pub struct HairOutline {
    /// Chin to the lowest hair.
    pub depth: f64,
    /// Reach in x and z from the crown to the chin.
    head_reach: [f64; 2],
    /// Reach in x and z at `KNOTS` heights from the chin down.
    reach: Vec<[f64; 2]>,
}

impl HairOutline {
    /// The outline of `points` about the vertical axis through `axis`, below the height of `axis`, which is the chin;
    /// `None` where no point lies below.
    pub fn of(points: impl Iterator<Item = DVec3>, axis: DVec3) -> Option<Self> {
        let from_axis: Vec<DVec3> = points.map(|p| p - axis).collect();
        let depth = from_axis.iter().map(|p| -p.y).fold(0.0, f64::max);
        if depth <= 0.0 {
            return None;
        }
        let step = depth / (KNOTS - 1) as f64;
        let quantile = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values.get((OUTLINE_QUANTILE * values.len() as f64) as usize).copied()
        };
        let on_head = from_axis.iter().filter(|p| p.y >= 0.0);
        let head_reach = [
            quantile(on_head.clone().map(|p| p.x.abs()).collect()).unwrap_or(f64::INFINITY),
            quantile(on_head.map(|p| p.z.abs()).collect()).unwrap_or(f64::INFINITY),
        ];
        let mut reach: Vec<[f64; 2]> = Vec::with_capacity(KNOTS);
        for knot in 0..KNOTS {
            let near = from_axis.iter().filter(|p| (-p.y / step - knot as f64).abs() <= 1.0);
            let x = quantile(near.clone().map(|p| p.x.abs()).collect());
            let z = quantile(near.map(|p| p.z.abs()).collect());
            // A height without vertices reaches as far as the one above.
            let above = reach.last().copied().unwrap_or([0.0; 2]);
            reach.push([x.unwrap_or(above[0]), z.unwrap_or(above[1])]);
        }
        Some(Self { depth, head_reach, reach })
    }
}

/// Where hair below the chin goes.
#[derive(Clone, Debug, PartialEq)]
pub struct HairMap {
    /// The head's axis at the chin, before and after.
    axis: [DVec3; 2],
    /// Chin to the lowest hair, before.
    depth: f64,
    /// Slope of the height at the chin, and the mean slope down to the tips.
    slopes: [f64; 2],
    /// Scale of x and z at `KNOTS` heights from the chin down.
    widths: Vec<[f64; 2]>,
}

impl HairMap {
    /// Hair of `outline` ends at height `new_bottom`.
    ///
    /// - `axis`: the head's axis at the chin, before and after.
    /// - `head`: the head's scales. `body_thickness`: the body's.
    /// - `tapering`: hair that ends less than this below the chin narrows less: a tail that just reaches below it keeps its
    ///   place behind the head.
    /// - `taming`: 1 keeps the hair within the reach it has on the head, 0 lets it spread as it did.
    pub fn new(
        outline: &HairOutline,
        axis: [DVec3; 2],
        new_bottom: f64,
        head: HeadScale,
        body_thickness: f64,
        tapering: f64,
        taming: f64,
    ) -> Self {
        let depth = outline.depth;
        let mean = (axis[1].y - new_bottom) / depth;
        let first = head.height.min(FIRST_SLOPE * mean);
        let tip = body_thickness.max(NARROWEST_TIP).min(head.width);
        let across = [head.width, head.depth];
        let mut map = Self { axis, depth, slopes: [first, mean], widths: Vec::new() };
        let scales: Vec<[f64; 2]> = (0..KNOTS)
            .map(|knot| {
                // At the chin hair is as wide as the head: nothing above it is tamed.
                if knot == 0 {
                    return across;
                }
                let d = depth * knot as f64 / (KNOTS - 1) as f64;
                // Of the mapped depth: of the unmapped one, short hair flares.
                let fraction = smoothstep(map.drop(d) / (mean * depth).max(tapering));
                [0, 1].map(|side| {
                    let scale = across[side] + (tip.min(across[side]) - across[side]) * fraction;
                    let on_head = across[side] * outline.head_reach[side];
                    let reach = outline.reach[knot][side];
                    if reach * scale > on_head { scale + taming * (on_head / reach - scale) } else { scale }
                })
            })
            .collect();
        // Smoothed, with both ends kept.
        map.widths = (0..KNOTS)
            .map(|knot| {
                if knot == 0 || knot == KNOTS - 1 {
                    return scales[knot];
                }
                [0, 1].map(|side| {
                    (scales[knot - 1][side] + 2.0 * scales[knot][side] + scales[knot + 1][side]) / 4.0
                })
            })
            .collect();
        map
    }

    /// How far below the new chin a point ends that was `d` below the chin.
    fn drop(&self, d: f64) -> f64 {
        let [first, mean] = self.slopes;
        first * d + (mean - first) * d * d / self.depth
    }

    /// Where the point `p` below the chin goes, and the Jacobian there.
    // Not inlined: see `FaceShape::map`.
    #[inline(never)]
    pub fn map(&self, p: DVec3) -> Mapped {
        let from = p - self.axis[0];
        let d = -from.y;
        let [first, mean] = self.slopes;
        let slope = first + 2.0 * (mean - first) * d / self.depth;
        let at = (d / self.depth).clamp(0.0, 1.0) * (KNOTS - 1) as f64;
        let knot = (at as usize).min(KNOTS - 2);
        let [upper, lower] = [self.widths[knot], self.widths[knot + 1]];
        let width = [0, 1].map(|side| upper[side] + (lower[side] - upper[side]) * (at - knot as f64));
        // Per unit of y, which grows against d.
        let knots_per_length = (KNOTS - 1) as f64 / self.depth;
        let by_y = [0, 1]
            .map(|side| if d < self.depth { (upper[side] - lower[side]) * knots_per_length } else { 0.0 });
        let position = self.axis[1] + DVec3::new(width[0] * from.x, -self.drop(d), width[1] * from.z);
        let jacobian = DMat3::from_cols(
            DVec3::new(width[0], 0.0, 0.0),
            DVec3::new(by_y[0] * from.x, slope, by_y[1] * from.z),
            DVec3::new(0.0, 0.0, width[1]),
        );
        Mapped { position, jacobian }
    }
}

/// Fewer vertices of hair than this are not worth a thread.
const LEAST_HAIR: usize = 200;
/// Steps that spread a push over the neighbouring hair. D15. Seen: ±30 % moves nothing by a thousandth of H.
const SPREAD_PASSES: usize = 8;
/// Hair keeps at least this share of its old distance from the body, up to `CLEARANCE` of the height. D15. Seen:
/// without, locks lie up to .007 H inside of three bodies.
const KEPT_DISTANCE: f64 = 0.5;
/// See [`KEPT_DISTANCE`]; a share of H. D15.
const CLEARANCE: f64 = 0.008;

/// Hair below the chin and the body that it lies on, before anything moves.
#[derive(Clone, Debug)]
pub struct HairOnBody {
    /// Triangles that hair must not enter.
    body: Vec<[u32; 3]>,
    /// The hair's vertices.
    hair: Vec<usize>,
    around: Neighbours,
    /// See [`rims`].
    rims: Vec<u32>,
    /// 1, or -1 for a body that is wound to look inwards, as mirrored ones are.
    outwards: f64,
    /// How far outside of the body each vertex of hair is, below 0 inside.
    distances: Vec<f64>,
    /// The triangle that each is nearest to, and is near to when all has moved.
    nearest: Vec<u32>,
    /// The body's.
    tree: Tree,
}

impl HairOnBody {
    /// What there is before.
    ///
    /// - `positions`: all vertices; `triangles`: all of the figure's, `body`: those that hair must not enter.
    /// - `hair`: vertices to look at.
    pub fn of(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        body: Vec<[u32; 3]>,
        hair: Vec<usize>,
        weld: &Weld,
        threads: usize,
    ) -> Self {
        let is_needed = !(body.is_empty() || hair.is_empty());
        let outwards = if volume(positions, &body) < 0.0 { -1.0 } else { 1.0 };
        let around = if is_needed { neighbours(triangles, weld) } else { Neighbours::default() };
        let rims = if is_needed { rims(&body, weld) } else { Vec::new() };
        let (mut distances, mut nearest, mut tree) = (Vec::new(), Vec::new(), Tree::default());
        if is_needed {
            let outside = Outside::new(positions, &body, &rims, weld, outwards);
            let found = parallel::collect(threads, hair.len(), LEAST_HAIR, |index| {
                let found = outside.at(positions[hair[index]], None);
                found.map_or((f64::INFINITY, u32::MAX), |(closest, distance, _)| {
                    (distance, closest.triangle as u32)
                })
            });
            (distances, nearest) = found.into_iter().unzip();
            tree = outside.tree();
        }
        Self { body, hair, around, rims, outwards, distances, nearest, tree }
    }

    /// True where there is no hair to look at, or no body.
    pub fn is_empty(&self) -> bool {
        self.distances.is_empty()
    }

    /// How far outside of the body each vertex is, and which way out is there.
    fn to_body(&self, points: &[DVec3], weld: &Weld, threads: usize) -> Vec<(f64, DVec3)> {
        let outside = Outside::moved(points, &self.body, &self.rims, weld, self.outwards, &self.tree);
        parallel::collect(threads, self.hair.len(), LEAST_HAIR, |index| {
            let found = outside.at(points[self.hair[index]], self.nearest.get(index).copied());
            found.map_or((f64::INFINITY, DVec3::ZERO), |(_, distance, way)| (distance, way))
        })
    }

    /// The vertices of hair, and what must be added to each so that locks which lay on the body still do.
    ///
    /// The body's heights and thicknesses change, the head's place too, so a lock that lay on the chest may end inside it.
    /// Every vertex that was outside the body and no longer is moves out along the body's normal; its neighbours are
    /// drawn along.
    ///
    /// - `after`: where all vertices are now; `height`: of the figure then.
    /// - Returns hair's vertices with their displacements; none where nothing is to do.
    pub fn kept_outside(
        &self,
        after: &[DVec3],
        weld: &Weld,
        height: f64,
        threads: usize,
    ) -> Vec<(usize, DVec3)> {
        let needs: Vec<DVec3> = self
            .distances
            .iter()
            .zip(self.to_body(after, weld, threads))
            .map(|(&old, (new, normal))| {
                let least = (KEPT_DISTANCE * old).min(CLEARANCE * height);
                if old > 0.0 && new < least { normal * (least - new) } else { DVec3::ZERO }
            })
            .collect();
        if needs.iter().all(|&need| need == DVec3::ZERO) {
            return Vec::new();
        }
        // On the welded mesh, so that seams stay closed: the largest need of the vertices at one place counts for all.
        let mut need_at = vec![DVec3::ZERO; weld.count];
        let mut is_hair = vec![false; weld.count];
        for (&vertex, &need) in self.hair.iter().zip(&needs) {
            let welded = weld.representative[vertex] as usize;
            is_hair[welded] = true;
            if need.length_squared() > need_at[welded].length_squared() {
                need_at[welded] = need;
            }
        }
        let mut push = need_at.clone();
        for _ in 0..SPREAD_PASSES {
            let last = push.clone();
            for welded in (0..weld.count).filter(|&welded| is_hair[welded]) {
                let near = self.around.of(welded);
                if near.is_empty() {
                    continue;
                }
                // Neighbours that are no hair (the scalp) do not move, and hold.
                let mean = near.iter().map(|&other| last[other as usize]).sum::<DVec3>() / near.len() as f64;
                let spread = 0.5 * (last[welded] + mean);
                let need = need_at[welded];
                let length = need.length();
                push[welded] = if length > 0.0 {
                    let missing = length - spread.dot(need) / length;
                    spread + need / length * missing.max(0.0)
                } else {
                    spread
                };
            }
        }
        self.hair.iter().map(|&vertex| (vertex, push[weld.representative[vertex] as usize])).collect()
    }
}
