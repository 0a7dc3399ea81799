//! Long hair (§VII): what the paper shortens by hand in a modelling program (D15, D28).
//!
//! Hair goes with the head, so hair that ended at the hips would end below the soles. So strands are made shorter along
//! themselves until they end where they ended on the body: each cross-section is shifted as one, so that locks keep their
//! thickness, ties and ribbons their shape, and tails flare as they did. What lay on a body that has become narrower hangs down
//! instead of standing out.

use super::parts_field::PartField;
use super::repair::Layer;
use super::scales::HeadScale;
use super::strands::{Link, Strands};
use crate::geometry::smoothstep;
use glam::DVec3;

/// A strand becomes shorter than this, beside the head, only where it cannot begin to do so higher up. D28.
const LEAST: f64 = 0.6;
/// It begins at most this high above the chin, in head lengths. D28.
const HIGHEST: f64 = 0.3;
/// Nothing begins at once, neither that nor that hair below the chin goes on as it did there: it does within this; and what is this
/// near above a strand's end is its tip. Head lengths. D28.
const SOFT: f64 = 0.1;
/// Of its length it has this much from the body, as an exponent; the rest from the head. D28.
const OF_BODY: f64 = 0.8;
/// What hangs less than the first of these below the chin keeps its length, what hangs more than the second does not. D28.
const SHORT: (f64, f64) = (0.15, 0.4);
/// Sideways a strand becomes shorter by this power less: 0 keeps its angles, 1 its width. D28.
const FLARE: f64 = 0.3;
/// Hair ends at least this high above the ground, in head lengths. D28.
const OVER_GROUND: f64 = 0.12;
/// Hair keeps this share of its old distance from the body, up to the second number in head lengths; a push dies away to a third
/// within the third, and is no longer than the fourth. D15.
const KEPT: (f64, f64, f64, f64) = (0.7, 0.05, 0.25, 0.25);
/// Hair is inside where the nearest point of the body faces it by this cosine. D15.
const FACING: f64 = 0.7;

/// How hair hangs below a head, for one body; displacements of places beyond where the head takes them.
#[derive(Debug)]
pub struct Hanging {
    /// What makes strands shorter.
    pub short: Vec<DVec3>,
    /// What lays them down.
    pub down: Vec<DVec3>,
    shortening: Shortening,
}

/// How much shorter strands become, and where.
#[derive(Debug)]
struct Shortening {
    /// How large the head becomes.
    head: DVec3,
    /// Where it begins, in head lengths above the chin.
    begins: f64,
    /// How much is left of each place's strand.
    left: Vec<f64>,
}

impl Hanging {
    /// Hair on the body of `field`: `length` 1 ends it where it ended there, 0 at the chin.
    pub fn of(strands: &Strands, field: &PartField, length: f64) -> Self {
        let shortening = Shortening::of(strands, field, length);
        let none = vec![DVec3::ZERO; strands.points.len()];
        let solve = |lay: f64| strands.solve(|link| shortening.shorter(strands, link, lay), &none);
        let short = solve(0.0);
        let down = solve(1.0).iter().zip(&short).map(|(down, short)| *down - *short).collect();
        Self { short, down, shortening }
    }

    /// Where hair goes that has been laid down by `lay`, where the head's own stages take it by `moved` from where the head
    /// does: below the chin as much as there.
    pub fn all(&self, strands: &Strands, lay: f64, moved: &[DVec3]) -> Vec<DVec3> {
        let follows = |link: &Link| {
            let [one, other] = link.ends.map(|place| place as usize);
            let middle = strands.points[one].y.midpoint(strands.points[other].y);
            (moved[one] - moved[other]) * smoothstep(middle / SOFT)
        };
        let mut all = strands.solve(follows, moved);
        for (all, (short, down)) in all.iter_mut().zip(self.short.iter().zip(&self.down)) {
            *all += *short + lay * *down;
        }
        all
    }

    /// What hair keeps of its distance from the body, on a figure whose soles are at height `ground`.
    pub fn layer(&self, strands: &Strands, ground: f64) -> Layer {
        let grows = self.shortening.head.element_sum() / 3.0;
        let length = grows * strands.frame.length;
        let (kept, clearance, spread, furthest) = KEPT;
        Layer {
            kept: kept * grows,
            clearance: clearance * length,
            spread: spread * length,
            furthest: furthest * length,
            facing: Some(FACING),
            floor: ground + 0.5 * OVER_GROUND * length,
        }
    }
}

impl Shortening {
    fn of(strands: &Strands, field: &PartField, length: f64) -> Self {
        let HeadScale { height, width, depth } = field.coefficients().head;
        let wanted: Vec<f64> =
            strands.tips.iter().map(|&tip| wanted(field, strands.frame.length, tip, length)).collect();
        let (mut sum, mut total) = (0.0, f64::MIN_POSITIVE);
        for (&tip, &wanted) in strands.tips.iter().zip(&wanted) {
            let depth = (-tip).max(0.0);
            let begins = ((LEAST * depth - wanted) / (1.0 - LEAST)).clamp(0.0, HIGHEST);
            sum += depth * begins.powi(3);
            total += depth * begins.powi(2);
        }
        let begins = sum / total;
        let left = |(&tip, &wanted): (&f64, &f64)| {
            let depth = (-tip).max(0.0);
            if depth > 0.0 { (begins + wanted) / (begins + depth) } else { 1.0 }
        };
        let left = strands.tips.iter().zip(&wanted).map(left).collect();
        Self { head: DVec3::new(width, height, depth), begins, left }
    }

    /// How much less a strand differs along a link than the head makes it, laid down by `lay`.
    fn shorter(&self, strands: &Strands, link: &Link, lay: f64) -> DVec3 {
        let [one, other] = link.ends.map(|place| place as usize);
        let mean = |of: &[f64]| 0.5 * (of[one] + of[other]);
        let middle = 0.5 * (strands.points[one] + strands.points[other]);
        let lies = lay * mean(&strands.lies);
        let drawn_in = lies * (strands.drawn_in[one] - strands.drawn_in[other]);
        let begun = smoothstep((self.begins - middle.y) / SOFT + 0.5);
        let shorter = if begun > 0.0 {
            let (along, tip) = (strands.along(link), mean(&strands.tips));
            let part = ((self.begins - middle.y) / (self.begins - tip).max(SOFT)).clamp(0.0, 1.0);
            // What lies on the body does not become shorter at once, and the most at its tip.
            let left = mean(&self.left).powf(1.0 - lies * (1.0 - 2.0 * part));
            let left = 1.0 - begun * (1.0 - left);
            let across = left.powf(1.0 - FLARE * (1.0 - lies));
            (DVec3::new(across, left, across) - DVec3::ONE) * along * along.dot(strands.step(link))
        } else {
            DVec3::ZERO
        };
        (1.0 - link.stiff) * strands.frame.length * self.head * (shorter + drawn_in)
    }
}

/// How far below the chin a strand should end that ends at `tip`, in head lengths before the head grows.
fn wanted(field: &PartField, head: f64, tip: f64, length: f64) -> f64 {
    let depth = (-tip).max(0.0);
    let (before, after) = (field.before(), field.after());
    let unit = head * field.coefficients().head.height;
    let on_body = ((after.chin - field.body_height(before.chin - depth * head)) / unit).clamp(0.0, depth);
    let both = on_body.powf(OF_BODY) * depth.powf(1.0 - OF_BODY);
    let is_long = smoothstep((depth - SHORT.0) / (SHORT.1 - SHORT.0));
    let most = ((after.chin - after.sole) / unit - OVER_GROUND).max(0.0);
    (length * (depth + is_long * (both - depth))).min(most.min(depth))
}
