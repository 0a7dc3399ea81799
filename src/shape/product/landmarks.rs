//! Crown, chin, shoulder line, crotch and soles, read from the geometry by rays.
//!
//! Every artist puts the neck and the head joint elsewhere, so lengths taken from joints carry each rig's
//! conventions into the result. These five heights are read by one rule from target and reference alike.

use crate::character::Role;
use crate::error::Warning;
use crate::geometry::surface::Surface;
use crate::geometry::{
    CHIN_BAND, CHIN_BY_RATIO, CHIN_STEP, SEAM, StepSearch, bounds, components, deepest_step, distinct, mean,
    range, slots, upper_median, weld,
};
use crate::shape::figure::{Figure, extent};
use crate::shape::heights::Heights;
use crate::shape::measure::head_top;
use glam::DVec3;

/// A vertex with this much weight to the head moves with it alone. D25. Seen: one head of 14 changes its crown by .002
/// H where others count.
const SURE_WEIGHT: f64 = 0.999;
/// Triangles this far beside a box of rays are looked at too, as a share of H: rays may run along edges.
const SLIVER: f64 = 1e-3;
/// Heights that must differ do by this share of H: a head of no length would divide by 0. The same for rays that begin
/// outside of what they look at.
pub const HAIRBREADTH: f64 = 0.01;
/// So many of the seven rays over a head must meet it. D6, D25: with fewer the skull is in another mesh.
const MOST_RAYS: usize = 5;
/// Rows of rays that look for the chin. D25; a row is .6 % of the way from shoulder line to crown.
const CHIN_ROWS: usize = 120;
/// Where those rows start and end, as shares of (crown - shoulder line), from the shoulder line. D25. Seen: ±30 % finds
/// no chin elsewhere.
const CHIN_RANGE: (f64, f64) = (-0.05, 0.70);
/// How often the way between two rows is halved. D25; a chin has no row of its own, so that rounding moves it by no more than itself.
const HALVINGS: usize = 16;
/// Columns of rays, as shares of the face's width, from its middle. D25; on a symmetric face the median is that of a
/// column at .04, and the outer ones outvote a necklace or a beard.
const CHIN_COLUMNS: [f64; 5] = [0.0, -0.04, 0.04, -0.08, 0.08];
/// Steps that differ by less than this share of themselves and of (crown - shoulder line) are equally deep: rounding
/// must not decide.
const TIE: f64 = 1e-4;
/// Less than this share of the breadth above and below is a neck: of people and chibis it is a half, and a box is even.
const NECK: f64 = 0.9;
/// A crotch is believed from this far below the hip joints to this far above them, as shares of H. D25. Seen: three of
/// 14 have something between the legs .065 to .085 below.
const CROTCH_RANGE: (f64, f64) = (-0.065, 0.03);
/// Where the crotch is taken to be where it is not seen, below the hip joints, as a share of H. D25. Seen: skirts and a
/// tunic need it.
const CROTCH_BY_RATIO: f64 = 0.03;
/// How far from the middle the rays pass, as a share of H. D25: bodies often have an edge in the middle.
const BESIDE_MIDDLE: f64 = 7e-4;
/// Those rows end this far above the hip joints, as a share of H: above where a crotch is believed. D25.
const CROTCH_TOP: f64 = 0.05;
/// Rows of rays that look for the crotch. D25; about .1 % of H each.
const CROTCH_ROWS: usize = 200;

/// The landmarks of a figure, in its units, and how they were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Landmarks {
    /// Where they are.
    pub heights: Heights,
    /// False where no chin was seen and a ratio stands in for it.
    pub chin_seen: bool,
    /// Where no chin is seen, and nothing is narrower than what is above and below it, head and trunk are one: for each vertex
    /// whether it is of a piece that is theirs alone.
    pub trunk: Option<Vec<bool>>,
    /// False where a skirt or a robe hides the crotch and a ratio stands in for it.
    pub crotch_seen: bool,
    /// What the crown is the top of.
    pub crown_source: CrownSource,
    /// The top of the head, hair and hats included: where the head bone ends.
    pub head_top: f64,
}

/// What a crown is the top of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrownSource {
    /// A skull.
    Skull,
    /// Hair, as the head has no skull below it.
    Hair,
    /// All of the figure, as nothing above the head joint moves with it.
    Figure,
}

impl Landmarks {
    /// What a person should know about how these were found; `whose` is `target` or `reference`.
    pub fn warnings(&self, whose: &str) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if !self.chin_seen {
            warnings.push(Warning::new(
                "face_not_found",
                format!("the {whose} shows no chin from the front: placed at {CHIN_BY_RATIO} of the way from the shoulder line to the crown"),
            ));
        }
        match self.crown_source {
            CrownSource::Skull => {}
            CrownSource::Hair => warnings.push(Warning::new(
                "crown_with_hair",
                format!("the {whose} has no skull under its hair: its crown is the top of the hair"),
            )),
            CrownSource::Figure => {
                let message = format!(
                    "nothing above the {whose}'s head joint moves with it: the highest point of all is taken to be the crown, so check which joint has the role head"
                );
                warnings.push(Warning::new("crown_not_found", message).about("humanoid"));
            }
        }
        warnings
    }
}

/// Reads the landmarks of `figure`.
pub fn landmarks(figure: &Figure) -> Landmarks {
    let height = figure.height();
    let sources = HeadSources::of(figure);
    let positions = sources.vertices.iter().map(|&vertex| figure.positions[vertex as usize]).collect();
    let placed = HeadPlacement::of(figure, positions, |joint| figure.joints[joint]);
    let ((crown, crown_source), (chin, chin_seen)) = crown_and_chin(&sources, &placed);
    let sole = sources.sole(&placed);
    let shoulder_line = placed.shoulder_line;
    let hip_line =
        mean_height(figure, [Role::LeftUpperLeg, Role::RightUpperLeg], |joint| figure.joints[joint]);
    // What is needed only where no chin is seen is looked for only there.
    let upper = if chin_seen { Vec::new() } else { upper_triangles(figure) };
    let trunk = (!chin_seen && !has_waist(figure, &upper, &placed, hip_line, crown)).then(|| trunk(figure));
    let (crotch, crotch_seen) = match &trunk {
        None => crotch(figure, hip_line),
        // Where the trunk ends: no part of it is a leg's.
        Some(of_trunk) => {
            let upper = upper.iter().flatten().map(|&vertex| figure.positions[vertex as usize].y);
            let own = figure.positions.iter().zip(of_trunk).filter(|(_, of_trunk)| **of_trunk);
            (own.map(|(p, _)| p.y).chain(upper).fold(hip_line, f64::min), true)
        }
    };
    let least = HAIRBREADTH * height;
    let crotch = crotch.clamp(sole + least, (shoulder_line - least).max(sole + least));
    let heights = Heights { crown, chin, shoulder_line, crotch, sole };
    let head_top = top_with_hair(&sources, &placed).unwrap_or(crown);
    Landmarks { heights, chin_seen, trunk, crotch_seen, crown_source, head_top }
}

/// What crown, chin and soles of a figure are read from: its weights and kinds say so, not where it is, so it is found once
/// for all results of a deformer.
#[derive(Clone, Debug)]
pub struct HeadSources {
    /// The figure's vertices that all else is numbered by.
    pub vertices: Vec<u32>,
    /// The number of each vertex of the figure among these, or `NONE`.
    pub slots: Vec<u32>,
    /// The head's own triangles: without hair, hats and the like, and with them.
    bare: HeadTriangles,
    with_hair: HeadTriangles,
    /// Head, neck and the upper torso, without hair, hats and the like.
    upper: Vec<[u32; 3]>,
    /// Vertices whose lowest is the sole.
    soles: Vec<u32>,
}

/// True for what moves head, neck and torso.
fn is_upper(role: Role) -> bool {
    role.is_head()
        || matches!(role, Role::Neck | Role::UpperChest | Role::Chest | Role::Spine | Role::Hips)
        || matches!(role, Role::LeftShoulder | Role::RightShoulder)
}

#[derive(Clone, Debug)]
struct HeadTriangles {
    all: Vec<[u32; 3]>,
    /// Their vertices.
    vertices: Vec<u32>,
    /// Those of triangles that move with the head alone.
    sure: Vec<u32>,
}

/// Where what [`HeadSources`] lists is.
#[derive(Debug, PartialEq)]
pub struct HeadPlacement {
    /// By [`HeadSources::vertices`].
    pub positions: Vec<DVec3>,
    /// Lowest and highest of these along up.
    extent: (f64, f64),
    head_joint: DVec3,
    shoulder_line: f64,
}

impl HeadSources {
    /// What there is in `figure`.
    pub fn of(figure: &Figure) -> Self {
        let of_head = |bare: bool| {
            let all = figure.triangles_where(|vertex| {
                figure.weight_of(vertex, Role::is_head) > 0.5 && !(bare && figure.is_carried(vertex))
            });
            let is_sure = |&v: &u32| figure.weight_of(v as usize, Role::is_head) > SURE_WEIGHT;
            let sure = all.iter().filter(|corners| corners.iter().all(is_sure)).flatten().copied();
            HeadTriangles { vertices: distinct(all.iter().flatten().copied()), sure: distinct(sure), all }
        };
        // No row of rays that looks for the chin is as far below the shoulders, nor will be when the torso has become shorter.
        let shoulder_line = shoulder_line(figure, |joint| figure.joints[joint]);
        let lowest = shoulder_line - 0.5 * (figure.extent.1 - shoulder_line);
        let (mut bare, mut with_hair, mut soles) = (of_head(true), of_head(false), soles(figure));
        // Nor is any as far aside as half the head's width, which is six times as far as they are at rest.
        let (middle, aside) = middle(&figure.positions, &bare.vertices)
            .map_or((0.0, f64::INFINITY), |(middle, half)| (middle.x, half.x));
        let mut upper = upper_triangles(figure);
        upper.retain(|corners| {
            let (low, high) = bounds(corners.iter().map(|&vertex| figure.positions[vertex as usize]));
            high.y > lowest && low.x < middle + aside && high.x > middle - aside
        });
        // Without a head the highest point of all is the crown, without legs the lowest one the sole.
        let vertices: Vec<u32> = if with_hair.all.is_empty() || soles.is_empty() {
            (0..figure.positions.len() as u32).collect()
        } else {
            distinct(upper.iter().flatten().chain(&with_hair.vertices).chain(&soles).copied())
        };
        let slots = slots(figure.positions.len(), &vertices);
        let number = |vertex: &mut u32| *vertex = slots[*vertex as usize];
        for triangles in [&mut bare.all, &mut with_hair.all, &mut upper] {
            triangles.iter_mut().flatten().for_each(number);
        }
        for head in [&mut bare, &mut with_hair] {
            head.vertices.iter_mut().chain(&mut head.sure).for_each(number);
        }
        soles.iter_mut().for_each(number);
        Self { vertices, slots, bare, with_hair, upper, soles }
    }

    fn sole(&self, placed: &HeadPlacement) -> f64 {
        let heights = self.soles.iter().map(|&vertex| placed.positions[vertex as usize].y);
        heights.min_by(f64::total_cmp).unwrap_or(placed.extent.0)
    }

    /// How many heads tall that is: [`Heights::heads`], without what that does not need.
    pub fn heads(&self, placed: &HeadPlacement) -> f64 {
        let ((crown, _), (chin, _)) = crown_and_chin(self, placed);
        (crown - self.sole(placed)) / (crown - chin)
    }
}

impl HeadPlacement {
    /// `figure` with the vertices of its [`HeadSources`] at `positions`, and joints where `place_joint` says.
    pub fn of(figure: &Figure, positions: Vec<DVec3>, place_joint: impl Fn(usize) -> DVec3) -> Self {
        Self {
            extent: extent(&positions),
            positions,
            head_joint: figure.humanoid.joint(Role::Head).map_or(DVec3::ZERO, &place_joint),
            shoulder_line: shoulder_line(figure, place_joint),
        }
    }

    fn height(&self) -> f64 {
        self.extent.1 - self.extent.0
    }
}

/// The heights that are read above the waist: the crown, and what it is the top of; the chin, and whether it was seen.
fn crown_and_chin(sources: &HeadSources, placed: &HeadPlacement) -> ((f64, CrownSource), (f64, bool)) {
    let (crown, crown_source) = crown(sources, placed);
    // A head whose crown lies below the shoulders is no head; keep a sliver so that nothing divides by 0.
    let crown = crown.max(placed.shoulder_line + HAIRBREADTH * placed.height());
    ((crown, crown_source), chin(sources, placed, crown))
}

fn shoulder_line(figure: &Figure, place_joint: impl Fn(usize) -> DVec3) -> f64 {
    mean_height(figure, [Role::LeftUpperArm, Role::RightUpperArm], place_joint)
}

fn mean_height(figure: &Figure, roles: [Role; 2], place_joint: impl Fn(usize) -> DVec3) -> f64 {
    let joints = roles.into_iter().filter_map(|role| figure.humanoid.joint(role));
    mean(joints.map(|joint| place_joint(joint).y)).unwrap_or(f64::NAN)
}

/// Head, neck and torso, without hair, hats and the like.
fn upper_triangles(figure: &Figure) -> Vec<[u32; 3]> {
    figure.triangles_where(|vertex| !figure.is_carried(vertex) && figure.weight_of(vertex, is_upper) > 0.5)
}

/// The lower half of feet and shins, as boots are often weighted to the shin alone; without these, of the legs.
fn soles(figure: &Figure) -> Vec<u32> {
    use Role::*;
    let moved_by = |roles: &[Role]| -> Vec<u32> {
        (0..figure.positions.len() as u32)
            .filter(|&vertex| figure.weight_of(vertex as usize, |role| roles.contains(&role)) > 0.5)
            .collect()
    };
    let legs =
        [LeftFoot, RightFoot, LeftToes, RightToes, LeftLowerLeg, RightLowerLeg, LeftUpperLeg, RightUpperLeg];
    let from_the_knees = moved_by(&legs[..6]);
    let mut soles = if from_the_knees.is_empty() { moved_by(&legs) } else { from_the_knees };
    let (low, high) = range(soles.iter().map(|&vertex| figure.positions[vertex as usize].y));
    soles.retain(|&vertex| figure.positions[vertex as usize].y <= low.midpoint(high));
    soles
}

/// Middle and half extent of `vertices`.
pub(super) fn middle(positions: &[DVec3], vertices: &[u32]) -> Option<(DVec3, DVec3)> {
    let (low, high) = bounds(vertices.iter().map(|&vertex| positions[vertex as usize]));
    (low.x <= high.x).then(|| ((low + high) / 2.0, (high - low) / 2.0))
}

/// The crown: the head's top without hair where at least five of the seven rays meet a skull, else with it.
///
/// The rays stand over the joint, about which paper mode scales the head: so the crown of the result is that of the
/// target, scaled. A joint that lies outside of its head gets a ring around the head's middle.
fn crown(sources: &HeadSources, placed: &HeadPlacement) -> (f64, CrownSource) {
    let (bare, with_hair) = (&sources.bare, &sources.with_hair);
    let skull = top(bare, bare, placed, MOST_RAYS).map(|y| (y, CrownSource::Skull));
    let hair = || top(with_hair, with_hair, placed, 1).map(|y| (y, CrownSource::Hair));
    // No head geometry over the head joint: the highest point of the whole figure.
    skull.or_else(hair).unwrap_or((placed.extent.1, CrownSource::Figure))
}

/// The top of all that the head moves, hair and hats included, straight above its joint: where the head bone ends, about
/// which the paper says nothing. A joint that lies outside of its head gets a ring around the head's middle.
fn top_with_hair(sources: &HeadSources, placed: &HeadPlacement) -> Option<f64> {
    let all = &sources.with_hair;
    // Hair may be wide, and a ring as wide would lie beside the head.
    let width = if sources.bare.all.is_empty() { all } else { &sources.bare };
    top(all, width, placed, 1)
}

/// The top of `triangles` over the head joint, where most of the rays meet it, or else over their middle, where `least` do; by a
/// ring after the width of `width`.
fn top(
    triangles: &HeadTriangles,
    width: &HeadTriangles,
    placed: &HeadPlacement,
    least: usize,
) -> Option<f64> {
    let (positions, joint) = (&placed.positions, placed.head_joint);
    let (centre, _) = middle(positions, &triangles.vertices)?;
    // Where some of the head is the head's alone, its width: vertices that the neck moves too change it.
    let (_, half) = middle(positions, &width.sure).or_else(|| middle(positions, &width.vertices))?;
    let (reach, sliver) = (DVec3::splat(half.x / 4.0), SLIVER * placed.height());
    let above = placed.extent.1 + HAIRBREADTH * placed.height();
    [(joint, MOST_RAYS), (centre, least)].into_iter().find_map(|(over, least)| {
        // Seen from above, no ray meets anything else, and a tree of few triangles is made soon.
        let (low, high) = (over - reach, over + reach);
        let is_near = |corners: &&[u32; 3]| {
            let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
            let (from, to) = (a.min(b).min(c), a.max(b).max(c));
            [0, 2].iter().all(|&axis| from[axis] <= high[axis] + sliver && to[axis] >= low[axis] - sliver)
        };
        let near: Vec<[u32; 3]> = triangles.all.iter().filter(is_near).copied().collect();
        let top = head_top(&Surface::new(positions, &near), over.with_y(joint.y), half.x, above);
        top.point.filter(|_| top.hit_count >= least).map(|point| point.y)
    })
}

/// The chin: the deepest step back below the face, seen from the front.
fn chin(sources: &HeadSources, placed: &HeadPlacement, crown: f64) -> (f64, bool) {
    let (positions, triangles, shoulder_line) = (&placed.positions, &sources.upper, placed.shoulder_line);
    let span = crown - shoulder_line;
    let by_ratio = (shoulder_line + CHIN_BY_RATIO * span, false);
    let head = middle(positions, &sources.bare.vertices);
    let Some((face, half)) = head.or_else(|| middle(positions, triangles.as_flattened())) else {
        return by_ratio;
    };
    let (_, front) = range(triangles.iter().flatten().map(|&vertex| positions[vertex as usize].z));
    let front = front + HAIRBREADTH * span;
    let row_height = (CHIN_RANGE.1 - CHIN_RANGE.0) * span / CHIN_ROWS as f64;
    let row_y = |row: usize| shoulder_line + CHIN_RANGE.0 * span + (row as f64 + 0.5) * row_height;
    let columns = CHIN_COLUMNS.map(|column| face.x + column * 2.0 * half.x);
    // No ray meets anything else, and a tree of few triangles is made soon.
    let sliver = SLIVER * placed.height();
    let near = triangles.iter().filter(|corners| {
        let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
        let (least, most) = (a.min(b).min(c) - sliver, a.max(b).max(c) + sliver);
        least.y <= row_y(CHIN_ROWS)
            && most.y >= row_y(0)
            && columns.iter().any(|&column| least.x <= column && most.x >= column)
    });
    let surface = Surface::new(positions, &near.copied().collect::<Vec<_>>());
    let depth = |y: f64| {
        upper_median(columns.iter().filter_map(|&column| {
            let origin = DVec3::new(column, y, front);
            surface.first_hit(origin, DVec3::NEG_Z, f64::INFINITY).map(|hit| front - hit.t)
        }))
    };
    let depths: Vec<Option<f64>> = (0..CHIN_ROWS).map(|row| depth(row_y(row))).collect();
    let band = ((CHIN_BAND * span / row_height).round() as usize).max(1);
    let search = StepSearch { band, least: CHIN_STEP * span, tie: TIE, span };
    let place = |row: usize| {
        let halfway = mean(depths[..=row].iter().rev().flatten().copied().take(2)).unwrap_or_default();
        let (mut below, mut above) = (row_y(row - 1), row_y(row));
        for _ in 0..HALVINGS {
            let y = below.midpoint(above);
            if depth(y).is_some_and(|depth| depth > halfway) { above = y } else { below = y }
        }
        // Not at corners that are as high as the step, or rounding would say which of them are of the head.
        below - SLIVER * row_height
    };
    deepest_step(&depths, &search, place).map_or(by_ratio, |chin| (chin, true))
}

/// The vertices of pieces that are head and trunk for the greater part and reach no elbow and no knee, whatever moves their corners.
fn trunk(figure: &Figure) -> Vec<bool> {
    use Role::*;
    let is_far = |role: Role| {
        let mut chain = role.chain();
        chain.any(|role| matches!(role, LeftLowerArm | RightLowerArm | LeftLowerLeg | RightLowerLeg))
    };
    let weld = weld(&figure.positions, SEAM * figure.height());
    let component = components(&figure.triangles, &weld);
    let of = |vertex: usize| component[weld.representative[vertex] as usize] as usize;
    // How much more of it is of head and trunk than of limbs.
    let mut own = vec![0.0; weld.count];
    for vertex in 0..figure.positions.len() {
        let of_trunk = figure.weight_of(vertex, is_upper);
        let is_far = figure.weight_of(vertex, is_far) > 0.5;
        own[of(vertex)] += if is_far { f64::NEG_INFINITY } else { of_trunk - 0.5 };
    }
    (0..figure.positions.len()).map(|vertex| own[of(vertex)] > 0.0).collect()
}

/// Whether `upper`, which is head, neck and torso, is between these heights, where chins are looked for, somewhere narrower than
/// above it and below it.
fn has_waist(figure: &Figure, upper: &[[u32; 3]], placed: &HeadPlacement, low: f64, high: f64) -> bool {
    let surface = Surface::new(&figure.positions, upper);
    let Some((centre, half)) = middle(&figure.positions, upper.as_flattened()) else { return true };
    let row_height = (high - low) / CHIN_ROWS as f64;
    let breadths: [f64; CHIN_ROWS] = std::array::from_fn(|row| {
        let at = DVec3::new(centre.x, low + (row as f64 + 0.5) * row_height, placed.head_joint.z);
        let far = 2.0 * half.x;
        let reach =
            |way: DVec3| surface.first_hit(at + far * way, -way, f64::INFINITY).map(|hit| far - hit.t);
        reach(DVec3::X).zip(reach(DVec3::NEG_X)).map_or(0.0, |(left, right)| left + right)
    });
    let broadest = |rows: &[f64]| rows.iter().copied().fold(0.0, f64::max);
    let row = |share: f64| {
        let y = placed.shoulder_line + share * (high - placed.shoulder_line);
        (((y - low) / row_height) as usize).min(CHIN_ROWS)
    };
    (row(CHIN_RANGE.0)..row(CHIN_RANGE.1))
        .any(|row| breadths[row] < NECK * broadest(&breadths[..row]).min(broadest(&breadths[row..])))
}

/// The crotch: the lowest thing between the legs in the middle column, from the knees up.
fn crotch(figure: &Figure, hip_line: f64) -> (f64, bool) {
    use Role::*;
    let height = figure.height();
    let by_ratio = (hip_line - CROTCH_BY_RATIO * height, false);
    let [left, right] =
        [LeftUpperLeg, RightUpperLeg].map(|role| figure.role_position(role).unwrap_or_default());
    let knees = match (figure.role_position(LeftLowerLeg), figure.role_position(RightLowerLeg)) {
        (Some(l), Some(r)) => (l.y + r.y) / 2.0,
        _ => (figure.extent.0 + hip_line) / 2.0,
    };
    let trunk = [Hips, Spine, Chest, UpperChest];
    let legs = [LeftUpperLeg, RightUpperLeg, LeftLowerLeg, RightLowerLeg];
    let is_near = |role: Role| trunk.contains(&role) || legs.contains(&role);
    let triangles = figure.triangles_where(|vertex| figure.weight_of(vertex, is_near) > 0.5);
    let surface = Surface::new(&figure.positions, &triangles);
    let Some((_, half)) = middle(&figure.positions, triangles.as_flattened()) else {
        return by_ratio;
    };
    let middle_x = (left.x + right.x) / 2.0;
    let front = left.z.max(right.z) + 4.0 * half.z.max(half.x) + HAIRBREADTH * height;
    let top = hip_line + CROTCH_TOP * height;
    let row_height = (top - knees) / CROTCH_ROWS as f64;
    if row_height <= 0.0 {
        return by_ratio;
    }
    let first = (0..CROTCH_ROWS).map(|row| knees + (row as f64 + 0.5) * row_height).find(|&y| {
        // A hair's breadth beside the middle, on both sides: bodies often have an edge or a rim just there.
        [-1.0, 1.0].iter().any(|side| {
            let origin = DVec3::new(middle_x + side * BESIDE_MIDDLE * height, y, front);
            surface.first_hit(origin, DVec3::NEG_Z, f64::INFINITY).is_some()
        })
    });
    match first {
        Some(y) if (CROTCH_RANGE.0..=CROTCH_RANGE.1).contains(&((y - hip_line) / height)) => (y, true),
        _ => by_ratio,
    }
}
