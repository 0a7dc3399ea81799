//! What of a figure tells its front from its back: feet, face, chin.

use crate::geometry::{bounds, mean, range};
use glam::DVec3;

/// How much eyes, brows and teeth count beside the feet, where meshes of them are. Seen: ±30 % changes no direction.
const FACE_VOTE: f64 = 0.5;
/// How much the chin counts beside the feet: hair and hoods hide it, and hang over the neck behind. Seen: ±30 % changes
/// no direction.
const CHIN_VOTE: f64 = 0.2;
/// Feet stand within this distance of the middle, in heights; hands and swords may be further out. Seen: ±30 % changes
/// no direction.
const FEET_REACH: f64 = 0.3;
/// Heel and tip of a foot are looked for up to this height. Seen: at -30 %, five fewer of 115 poses warned of; at +30 %,
/// 20 more of 115 poses warned of.
const SOLE_UP_TO: f64 = 0.04;
/// Back and front of the shin are looked for between these heights. Seen: at -30 %, three fewer of 115 poses wrong by
/// over 5 degrees; at +30 %, two more of 115 poses wrong by over 5 degrees.
const SHIN_RANGE: (f64, f64) = (0.06, 0.12);
/// The profile in which the chin is looked for has so many rows: a row is 0.017 H, less than the least chin.
const PROFILE_ROWS: usize = 60;
/// The chin is looked for between these rows of the profile, which hold head and neck, be the head large or small: chins
/// of 2.2 to 20 heads lie within.
const HEAD_ROWS: (usize, usize) = (PROFILE_ROWS * 11 / 20, PROFILE_ROWS * 19 / 20);
/// Steps of the profile are read between means over so many rows. Seen: at -30 %, five fewer of 115 poses warned of.
const STEP_ROWS: usize = 3;
/// The profile is read within this distance of the middle, in heights. Seen: ±30 % changes no direction.
const PROFILE_REACH: f64 = 0.03;
/// A step of the profile below this, in heights, is no chin. Seen: ±30 % changes no direction.
const LEAST_CHIN: f64 = 0.02;

/// Which way a figure looks, by its feet, then eyes and the like, then the chin: above 0 along z, below 0 against it.
///
/// `points` of its surface and vertices of face parts: sideways from its plane of symmetry, up from its soles, ahead of its
/// middle, in heights.
pub fn front_vote(points: &[DVec3], face_parts: &[DVec3]) -> f64 {
    feet_vote(points) + FACE_VOTE * face_vote(points, face_parts) + CHIN_VOTE * chin_vote(points)
}

/// Feet reach further forward from the shins than back, -1..1; each side by itself, since one may be ahead of the other.
fn feet_vote(points: &[DVec3]) -> f64 {
    let of_side = |sign: f64| {
        let depth = |from: f64, to: f64| {
            let near = points
                .iter()
                .filter(|p| (from..=to).contains(&p.y) && p.x * sign >= 0.0 && p.x.abs() < FEET_REACH);
            range(near.map(|p| p.z))
        };
        let ((heel, tip), (back, front)) = (depth(0.0, SOLE_UP_TO), depth(SHIN_RANGE.0, SHIN_RANGE.1));
        let more = (tip + heel - back - front) / (tip - heel);
        if more.is_finite() { 0.5 * more.clamp(-1.0, 1.0) } else { 0.0 }
    };
    of_side(-1.0) + of_side(1.0)
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
        let mean = |rows: &[f64]| mean(rows.iter().copied().filter(|z| z.is_finite())).unwrap_or(f64::NAN);
        (HEAD_ROWS.0..HEAD_ROWS.1)
            .map(|row| mean(&profile[row..row + STEP_ROWS]) - mean(&profile[row - STEP_ROWS..row]))
            .fold(0.0, f64::max)
    };
    let (front, back) = (overhang(1.0), overhang(-1.0));
    (front - back) / (front + back).max(LEAST_CHIN)
}
