//! What of a figure tells its front from its back: feet, face, chin.

use super::facing::SURE_VOTE;
use crate::geometry::{bounds, range};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// How much eyes, brows and teeth count beside the feet, where meshes of them are. Seen: ±30 % changes no direction.
const FACE_VOTE: f64 = 0.5;
/// How much the chin counts beside the feet: hair and hoods hide it, and hang over the neck behind. Seen: ±30 % changes
/// no direction.
const CHIN_VOTE: f64 = 0.2;
/// Feet stand within this distance of the middle, in heights; hands and swords may be further out. Seen: ±30 % changes
/// no direction.
const FEET_REACH: f64 = 0.3;
/// Heel and tip of a foot are looked for up to this height (seen: at -30 %, five fewer of 115 poses warned of; at
/// +30 %, 20 more of 115 poses warned of), ...
const SOLE_UP_TO: f64 = 0.04;
/// ... and back and front of the shin between these. Seen: at -30 %, three fewer of 115 poses wrong by over 5 degrees;
/// at +30 %, two more of 115 poses wrong by over 5 degrees.
const SHIN_RANGE: (f64, f64) = (0.06, 0.12);
/// What lies further apart than this, in heights, is not one foot or shin, ...
const PLAN_CELL: f64 = 0.02;
/// ... or than so many times as far as points of the surface are.
const PLAN_POINTS: f64 = 1.5;
/// Rows of the profile in which the chin is looked for (a row is 0.017 H, less than the least chin), ...
const PROFILE_ROWS: usize = 60;
/// ... between these, which hold head and neck, be the head large or small (chins of 2.2 to 20 heads lie within), ...
const HEAD_ROWS: (usize, usize) = (PROFILE_ROWS * 11 / 20, PROFILE_ROWS * 19 / 20);
/// ... as means over so many (seen: at -30 %, five fewer of 115 poses warned of), ...
const STEP_ROWS: usize = 3;
/// ... within this distance of the middle, in heights. Seen: ±30 % changes no direction.
const PROFILE_REACH: f64 = 0.03;
/// A step of the profile below this, in heights, is no chin. Seen: ±30 % changes no direction.
const LEAST_CHIN: f64 = 0.02;

/// Which way a figure looks.
pub struct Vote {
    /// Above 0 along z, below 0 against it.
    pub vote: f64,
    /// True where what is beside a foot says another way than its shin does.
    pub is_divided: bool,
}

/// Feet, then eyes and the like, then the chin.
///
/// `points` of its surface, about `spacing` apart, and vertices of face parts: sideways from its plane of symmetry, up from
/// its soles, ahead of its middle, in heights.
pub fn front_vote(points: &[DVec3], spacing: f64, face_parts: &[DVec3]) -> Vote {
    let (all, feet) = feet_votes(points, PLAN_CELL.max(PLAN_POINTS * spacing));
    let is_divided = all * feet < 0.0 && feet.abs() >= SURE_VOTE;
    let vote = if is_divided { feet } else { all };
    let vote = vote + FACE_VOTE * face_vote(points, face_parts) + CHIN_VOTE * chin_vote(points);
    Vote { vote, is_divided }
}

/// Feet reach further forward from the shins than back, -1..1; each side by itself, since one may be ahead of the other. By
/// all that is beside a foot, and by the shin alone that stands on it.
fn feet_votes(points: &[DVec3], cell: f64) -> (f64, f64) {
    let (mut all, mut feet) = (0.0, 0.0);
    for sign in [-1.0, 1.0] {
        let slab = |from: f64, to: f64| {
            let near = points
                .iter()
                .filter(|p| (from..=to).contains(&p.y) && p.x * sign >= 0.0 && p.x.abs() < FEET_REACH);
            Plan::of(near.copied(), cell)
        };
        let (soles, shins) = (slab(0.0, SOLE_UP_TO), slab(SHIN_RANGE.0, SHIN_RANGE.1));
        let depth = |plan: &Plan| range(plan.0.values().flat_map(|&(back, front)| [back, front]));
        all += 0.5 * further_ahead(depth(&soles), depth(&shins));
        feet += 0.5 * foot_vote(&soles, &shins);
    }
    (all, feet)
}

/// How much further a foot from heel to tip reaches ahead of a shin from back to front than behind it, -1..1.
fn further_ahead((heel, tip): (f64, f64), (back, front): (f64, f64)) -> f64 {
    let more = (tip + heel - back - front) / (tip - heel);
    if more.is_finite() { more.clamp(-1.0, 1.0) } else { 0.0 }
}

/// The same of one foot: the shin that stands over it; a sword, a cape or a tail is beside it.
fn foot_vote(soles: &Plan, shins: &Plan) -> f64 {
    let all = shins.pieces();
    let pairs = soles
        .pieces()
        .into_iter()
        .flat_map(|sole| all.iter().map(move |shin| (sole.intersection(shin).count(), sole.clone(), shin)));
    let best = pairs.filter(|pair| pair.0 > 0).reduce(|one, other| if other.0 > one.0 { other } else { one });
    let Some((_, sole, shin)) = best else { return 0.0 };
    let (foot, shin) = (soles.depth(&sole), shins.depth(shin));
    // What is deeper than the foot is no shin but what the figure wears, or all of it.
    if shin.1 - shin.0 > foot.1 - foot.0 { 0.0 } else { further_ahead(foot, shin) }
}

/// A cell of a plan.
type Square = (i32, i32);

/// A slab seen from above: back and front of what is in each of its cells.
struct Plan(BTreeMap<Square, (f64, f64)>);

impl Plan {
    fn of(points: impl Iterator<Item = DVec3>, cell: f64) -> Self {
        let mut squares: BTreeMap<Square, (f64, f64)> = BTreeMap::new();
        for p in points {
            let square = ((p.x / cell).floor() as i32, (p.z / cell).floor() as i32);
            let depth = squares.entry(square).or_insert((p.z, p.z));
            *depth = (depth.0.min(p.z), depth.1.max(p.z));
        }
        Self(squares)
    }

    /// Its cells that hang together, edge to edge or corner to corner.
    fn pieces(&self) -> Vec<BTreeSet<Square>> {
        let mut left: BTreeSet<Square> = self.0.keys().copied().collect();
        let mut pieces = Vec::new();
        while let Some(first) = left.pop_first() {
            let mut piece = BTreeSet::from([first]);
            let mut rim = vec![first];
            while let Some((x, z)) = rim.pop() {
                for beside in (-1..=1).flat_map(|dx| (-1..=1).map(move |dz| (x + dx, z + dz))) {
                    if left.remove(&beside) {
                        piece.insert(beside);
                        rim.push(beside);
                    }
                }
            }
            pieces.push(piece);
        }
        pieces
    }

    fn depth(&self, piece: &BTreeSet<Square>) -> (f64, f64) {
        range(piece.iter().flat_map(|square| {
            let (back, front) = self.0[square];
            [back, front]
        }))
    }
}

/// Eyes, brows and teeth lie on the front of the head, -1..1.
fn face_vote(points: &[DVec3], face_parts: &[DVec3]) -> f64 {
    let (low, high) = bounds(face_parts.iter().copied());
    let sum: f64 = face_parts.iter().map(|p| p.z).sum();
    let beside = |p: &&DVec3| (low.y..=high.y).contains(&p.y) && (low.x..=high.x).contains(&p.x);
    let (back, front) = range(points.iter().filter(beside).map(|p| p.z));
    let vote = (2.0 * sum / face_parts.len() as f64 - back - front) / (front - back);
    if vote.is_finite() { vote.clamp(-1.0, 1.0) } else { 0.0 }
}

/// The face hangs further over the neck in front than the skull does behind, -1..1.
fn chin_vote(points: &[DVec3]) -> f64 {
    let overhang = |sign: f64| {
        let mut profile = [f64::NAN; PROFILE_ROWS];
        for p in points.iter().filter(|p| p.x.abs() < PROFILE_REACH) {
            let row = ((p.y.max(0.0) * PROFILE_ROWS as f64) as usize).min(PROFILE_ROWS - 1);
            profile[row] = profile[row].max(sign * p.z);
        }
        let mean = |rows: &[f64]| {
            let seen = rows.iter().filter(|z| z.is_finite());
            seen.clone().sum::<f64>() / seen.count() as f64
        };
        (HEAD_ROWS.0..HEAD_ROWS.1)
            .map(|row| mean(&profile[row..row + STEP_ROWS]) - mean(&profile[row - STEP_ROWS..row]))
            .fold(0.0, f64::max)
    };
    let (front, back) = (overhang(1.0), overhang(-1.0));
    (front - back) / (front + back).max(LEAST_CHIN)
}
