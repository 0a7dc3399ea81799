//! The lengths and widths of a figure's parts, between its landmarks.
//!
//! What product mode compares between target and reference, where paper mode compares bones: the neck from shoulder
//! line to chin, the torso from crotch to shoulder line, the leg from crotch to sole, whole arms; so that it does
//! not matter where an artist put the joints in between.

use super::landmarks::{Landmarks, landmarks, middle};
use super::part::{Part, PartWeights, TINY, fold_to_parts};
use crate::character::{MeshKind, Role};
use crate::error::Warning;
use crate::geometry::{bounds, cut_at, mean, range};
use crate::shape::figure::Figure;
use crate::shape::heights::Heights;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Nothing is shorter than this, as a share of L or, of limbs and torso, of H: a neck where the chin lies at the shoulder line is as
/// long, and what is less is no hand, no foot, no half of a head. Seen: 30 % either way moves no vertex of 14 models.
const LEAST: f64 = 0.02;
/// The head's half width is taken this far above the chin, as a share of L (D27). Seen: 0.25 meets jaws and moves
/// vertices by up to 0.05 H, 0.46 meets the widest skulls and limits more heads.
const HEAD_WIDTH_AT: f64 = 0.35;
/// Half its depth is taken this far above the chin, as a share of L: above nose and brows, where a skull is deepest.
const HEAD_DEPTH_AT: f64 = 0.55;
/// Deeper than this is what hangs behind a head: a toddler's half depth is .49, a figurine's .50.
const MOST_HEAD_DEPTH: f64 = 0.55;
/// A line around a head is looked for in this many directions: a skin that ends under the hair is missing in some.
const SECTORS: usize = 8;
/// Its half width where none is measured, as a share of L. Seen: 30 % either way moves no vertex of 14 models.
const HEAD_WIDTH_BY_RATIO: f64 = 0.4;
/// Outlines count between these quantiles, so that a strap or a pouch is no width (D27). Seen: at 0.68 above, vertices
/// move by up to 0.03 H; a third more or less below, by 0.003 H.
const QUANTILES: (f64, f64) = (0.03, 0.97);
/// An edge of an outline counts as so many points. Seen: with 3 or 5, vertices move by up to 0.009 H.
const EDGE_POINTS: u32 = 4;
/// Joints nearer to each other than this share of H lie on one another, and finger tips are as far as each other. Seen: 30 %
/// either way moves no vertex of 14 models.
const APART: f64 = 1e-3;
/// The elbow where no joint tells, as a share of the way from shoulder to finger tips. Seen: 30 % either way moves no
/// vertex of 14 models.
const ELBOW_BY_RATIO: f64 = 0.45;
/// The wrist where no joint tells, as a share of the way from elbow to finger tips (D26). Seen: 30 % either way moves
/// no vertex of 14 models.
const WRIST_BY_RATIO: f64 = 0.62;
/// The knee where no joint tells, as a share of the leg below the crotch. Seen: 30 % either way moves no vertex of 14
/// models.
const KNEE_BY_RATIO: f64 = 0.48;
/// The ankle where no joint tells, as a share of the leg above the sole (D26). Seen: a third more or less moves one model
/// of 14, by 0.006 H.
const ANKLE_BY_RATIO: f64 = 0.1;
/// Knees lie at least this share of the leg below the crotch, and ankles below knees. Seen: 30 % either way moves no
/// vertex of 14 models.
const LEAST_SEGMENT: f64 = 0.1;
/// A foot joint nearer to the sole than this share of the leg is not an ankle. Seen: Quaternius' feet lie on the sole; at
/// 0.014 one of them counts, at 0.026 one ankle more is a ratio.
const LEAST_ANKLE: f64 = 0.02;
/// A foot joint further aside from the knee than this share of the leg is the root of an IK chain. Seen: 30 % either
/// way moves no vertex of 14 models.
const FOOT_ASIDE: f64 = 0.35;

/// An arm from shoulder to wrist, or a leg from the height of the crotch to the ankle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limb {
    /// Upper part, lower part, hand or foot, as indices of [`Part`].
    pub parts: [usize; 3],
    /// Shoulder joint, or the hip joint moved to the height of the crotch.
    pub root: DVec3,
    /// Elbow or knee.
    pub middle: DVec3,
    /// Wrist or ankle.
    pub end: DVec3,
    /// False where the figure has no joint for the hand (the foot) that can be trusted, and `end` is a ratio.
    pub end_is_joint: bool,
}

impl Limb {
    /// Root to end along the two segments.
    pub fn length(&self) -> f64 {
        self.root.distance(self.middle) + self.middle.distance(self.end)
    }
}

/// The measured numbers, in the figure's units; what cannot be measured is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Proportions {
    /// L: chin to crown.
    pub head_length: f64,
    /// Half the head's width, 35 % of L above the chin.
    pub head_half_width: f64,
    /// Half the head's depth, 55 % of L above the chin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head_half_depth: Option<f64>,
    /// Shoulder line to chin.
    pub neck: f64,
    /// Crotch to shoulder line.
    pub torso: f64,
    /// Shoulder to wrist, mean of both sides.
    pub arm: f64,
    /// Sole to crotch.
    pub leg: f64,
    /// Sole to ankle, mean of both sides.
    pub ankle_height: f64,
    /// Wrist to finger tips, mean of both sides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand: Option<f64>,
    /// Heel to toe, mean of both sides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub foot: Option<f64>,
    /// Half the torso's breadth, the median of its slices.
    #[serde(alias = "trunk_half_width", skip_serializing_if = "Option::is_none")]
    pub torso_half_width: Option<f64>,
    /// Its radius, the median of its slices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper_arm_radius: Option<f64>,
    /// Its radius, the median of its slices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lower_arm_radius: Option<f64>,
    /// Its radius, the median of its slices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper_leg_radius: Option<f64>,
    /// Its radius, the median of its slices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lower_leg_radius: Option<f64>,
}

/// Everything that is read from a figure's geometry: landmarks, limbs, centre line, proportions.
#[derive(Clone, Debug, PartialEq)]
pub struct Anatomy {
    /// Heights.
    pub landmarks: Landmarks,
    /// Left arm, right arm, left leg, right leg.
    pub limbs: [Limb; 4],
    /// The plane that halves the body: x of the middle between the limbs' roots.
    pub middle_x: f64,
    /// The torso's centre line: (height, z), rising, smoothed; the hips alone until its slices are measured.
    pub centre_line: Vec<(f64, f64)>,
    /// Middle of the bare head's bounding box.
    pub head_centre: DVec3,
    /// Where the head joint is.
    pub head_joint: DVec3,
    /// The measured numbers, without the widths of torso and limbs, which the profile gives.
    pub proportions: Proportions,
}

impl Anatomy {
    /// Reads the anatomy of `figure`.
    pub fn of(figure: &Figure) -> Self {
        let landmarks = landmarks(figure);
        let heights = landmarks.heights;
        let parts: Vec<PartWeights> = figure.role_weights.iter().map(|row| fold_to_parts(row)).collect();
        let limbs = [
            arm(figure, &parts, true),
            arm(figure, &parts, false),
            leg(figure, heights, true),
            leg(figure, heights, false),
        ];
        let middle_x = limbs.iter().map(|limb| limb.root.x).sum::<f64>() / 4.0;
        let head_joint = figure.role_position(Role::Head).unwrap_or_default();
        // Hats are no width of a head, unless there is nothing else.
        let of_head = |bare: bool| {
            figure.triangles_where(|vertex| {
                figure.weight_of(vertex, Role::is_head) > 0.5 && !(bare && figure.is_carried(vertex))
            })
        };
        let bare_head = of_head(true);
        let head = if bare_head.is_empty() { of_head(false) } else { bare_head };
        let head_centre = middle(&figure.positions, head.as_flattened())
            .map_or(DVec3::new(middle_x, heights.crown, head_joint.z), |(centre, _)| centre);

        let length = heights.head_length();
        let head_half_width = half_width(figure, &head, heights.chin + HEAD_WIDTH_AT * length)
            .filter(|&half| half > LEAST * length)
            .unwrap_or(HEAD_WIDTH_BY_RATIO * length);
        let head_half_depth = head_half_depth(figure, &head, heights.chin + HEAD_DEPTH_AT * length)
            .filter(|half| (LEAST..MOST_HEAD_DEPTH).contains(&(half / length)));
        let (bottom, top) = (heights.crotch, heights.shoulder_line);
        let extremity = |limbs: &[Limb], reach: &dyn Fn(&Limb, &[DVec3]) -> f64| {
            mean(limbs.iter().filter_map(|limb| {
                let points: Vec<DVec3> = (0..figure.positions.len())
                    .filter(|&vertex| parts[vertex][limb.parts[2]] > 0.5 && !figure.is_carried(vertex))
                    .map(|vertex| figure.positions[vertex])
                    .collect();
                (points.len() > 2).then(|| reach(limb, &points)).filter(|&reach| reach > LEAST * length)
            }))
        };
        let (arms, legs) = limbs.split_at(2);
        // Joints that lie on one another leave a sliver, so that nothing is divided by 0.
        let least = LEAST * figure.height();
        let proportions = Proportions {
            head_length: length,
            head_half_width,
            head_half_depth,
            neck: (heights.chin - heights.shoulder_line).max(LEAST * length),
            torso: (top - bottom).max(least),
            arm: (arms.iter().map(Limb::length).sum::<f64>() / 2.0).max(least),
            leg: (bottom - heights.sole).max(least),
            ankle_height: legs.iter().map(|leg| leg.end.y - heights.sole).sum::<f64>() / 2.0,
            hand: extremity(arms, &|limb, points| {
                let along = (limb.end - limb.middle).normalize_or_zero();
                points.iter().map(|p| (*p - limb.end).dot(along)).fold(0.0, f64::max)
            }),
            foot: extremity(legs, &|_, points| {
                let (low, high) = range(points.iter().map(|p| p.z));
                high - low
            }),
            ..Proportions::default()
        };
        let hips = figure.role_position(Role::Hips).unwrap_or_default();
        let centre_line = vec![(hips.y, hips.z)];
        Self { landmarks, limbs, middle_x, centre_line, head_centre, head_joint, proportions }
    }

    /// Joints that a ratio stands in for.
    pub fn warnings(&self) -> Vec<Warning> {
        let by_ratio = |limbs: &[Limb], what: &str| {
            limbs.iter().any(|limb| !limb.end_is_joint).then(|| {
                let message = format!("the {what} have no joint where {what} begin: placed by ratio");
                Warning::new("joint_by_ratio", message)
            })
        };
        let (arms, legs) = self.limbs.split_at(2);
        by_ratio(arms, "hands").into_iter().chain(by_ratio(legs, "feet")).collect()
    }

    /// z of the torso's centre line at height `y`, constant beyond its ends, and its slope there.
    pub fn centre_z(&self, y: f64) -> (f64, f64) {
        let [(y0, z0), (y1, z1)] = beside(&self.centre_line, y);
        if y0 == y1 {
            return (z0, 0.0);
        }
        let slope = (z1 - z0) / (y1 - y0);
        (z0 + slope * (y - y0), slope)
    }
}

/// The points of a line, told by how far along they are, before and after `at`; beyond its ends the last one twice.
fn beside(line: &[(f64, f64)], at: f64) -> [(f64, f64); 2] {
    let next = line.iter().position(|&(along, _)| at <= along).unwrap_or(line.len());
    [next.saturating_sub(1), next.min(line.len() - 1)].map(|point| line[point])
}

/// Shoulder, elbow and wrist of one side.
fn arm(figure: &Figure, parts: &[PartWeights], left: bool) -> Limb {
    use Role::*;
    let side = |role: Role| role.on_side(left);
    let indices = [LeftUpperArm, LeftLowerArm, LeftHand].map(|role| Part::of(side(role)) as usize);
    let root = figure.role_position(side(LeftUpperArm)).unwrap_or_default();
    let elbow = figure.role_position(side(LeftLowerArm));
    let wrist = figure.role_position(side(LeftHand));
    // The finger tips: the arm's own vertices that lie furthest from the shoulder. Of a blunt end several lie as far, and the
    // last digits must not choose one.
    let reach = APART * figure.height();
    let own = |vertex: &usize| indices.iter().map(|&part| parts[*vertex][part]).sum::<f32>() > 0.5;
    let places: Vec<DVec3> =
        (0..figure.positions.len()).filter(own).map(|vertex| figure.positions[vertex]).collect();
    let furthest = places.iter().map(|p| p.distance(root)).fold(0.0, f64::max);
    let (sum, total) = places.iter().fold((DVec3::ZERO, 0.0), |(sum, total), &p| {
        let weight = (reach - (furthest - p.distance(root))).max(0.0);
        (sum + p * weight, total + weight)
    });
    let tip = if total > 0.0 { sum / total } else { root };
    let apart = |a: DVec3, b: DVec3| a.distance(b) > APART * figure.height();
    let middle = elbow.filter(|&elbow| apart(elbow, root)).unwrap_or_else(|| match wrist {
        Some(wrist) => root.lerp(wrist, 0.5),
        None => root.lerp(tip, ELBOW_BY_RATIO),
    });
    let end = wrist.filter(|&wrist| apart(wrist, middle));
    let end_or_ratio = end.unwrap_or_else(|| middle.lerp(tip, WRIST_BY_RATIO));
    Limb { parts: indices, root, middle, end: end_or_ratio, end_is_joint: end.is_some() }
}

/// Hip (at the height of the crotch), knee and ankle of one side.
fn leg(figure: &Figure, heights: Heights, left: bool) -> Limb {
    use Role::*;
    let side = |role: Role| role.on_side(left);
    let hip = figure.role_position(side(LeftUpperLeg)).unwrap_or_default();
    let root = DVec3::new(hip.x, heights.crotch, hip.z);
    let length = heights.crotch - heights.sole;
    let between =
        |y: f64| y > heights.sole + LEAST_ANKLE * length && y < heights.crotch - LEAST_SEGMENT * length;
    let foot_joint = figure.role_position(side(LeftFoot));
    let knee = figure.role_position(side(LeftLowerLeg)).filter(|knee| between(knee.y)).unwrap_or_else(|| {
        match foot_joint.filter(|foot| between(foot.y)) {
            Some(foot) => root.lerp(foot, 0.5),
            None => root - DVec3::Y * (KNEE_BY_RATIO * length),
        }
    });
    // A foot joint may be missing, lie on the sole, or be the far root of an IK chain.
    let near = |foot: &DVec3| (*foot - knee).with_y(0.0).length() < FOOT_ASIDE * length;
    let end = foot_joint.filter(|foot| {
        near(foot) && foot.y < knee.y - LEAST_SEGMENT * length && foot.y > heights.sole + LEAST_ANKLE * length
    });
    let ankle = end.unwrap_or_else(|| {
        let y = heights.sole + ANKLE_BY_RATIO * length;
        let x = match foot_joint.filter(near) {
            Some(foot) if foot.y < y => knee.x + (foot.x - knee.x) * (knee.y - y) / (knee.y - foot.y),
            _ => knee.x,
        };
        DVec3::new(x, y, knee.z)
    });
    let parts = [LeftUpperLeg, LeftLowerLeg, LeftFoot].map(|role| Part::of(side(role)) as usize);
    Limb { parts, root, middle: knee, end: ankle, end_is_joint: end.is_some() }
}

/// Half the depth of the head at height `y`: of its skin (`bare`), and where that ends under the hair, of both.
fn head_half_depth(figure: &Figure, bare: &[[u32; 3]], y: f64) -> Option<f64> {
    let is_head = |vertex: usize| {
        figure.weight_of(vertex, Role::is_head) > 0.5 && figure.kind(vertex) != MeshKind::Accessory
    };
    let whole = outline(figure, &figure.triangles_where(is_head), y)?;
    let middle = whole.middle();
    let mut outline = outline(figure, bare, y).filter(|bare| bare.surrounds(middle)).unwrap_or(whole);
    let (back, front) = outline.between(|p| p.z);
    outline.surrounds(middle).then_some((front - back) / 2.0)
}

/// Half the width of `triangles` at height `y`.
fn half_width(figure: &Figure, triangles: &[[u32; 3]], y: f64) -> Option<f64> {
    let (left, right) = outline(figure, triangles, y)?.between(|p| p.x);
    Some((right - left) / 2.0)
}

/// The line in which a plane cuts a surface: points, and how much of its length each stands for.
struct Outline {
    points: Vec<(DVec3, f64)>,
    /// Of all of it.
    length: f64,
}

impl Outline {
    /// Middle of its extents.
    fn middle(&self) -> DVec3 {
        let (low, high) = bounds(self.points.iter().map(|&(p, _)| p));
        0.5 * (low + high)
    }

    /// Whether it is seen in each of [`SECTORS`] around `middle`, as a closed line around it is.
    fn surrounds(&self, middle: DVec3) -> bool {
        let mut is_seen = [false; SECTORS];
        for (p, _) in &self.points {
            let turn = (p.x - middle.x).atan2(p.z - middle.z) / std::f64::consts::TAU + 0.5;
            is_seen[((turn * SECTORS as f64) as usize).min(SECTORS - 1)] = true;
        }
        is_seen.iter().all(|&is_seen| is_seen)
    }

    /// Where it begins and ends along an axis, but for what [`QUANTILES`] leave out of its length.
    ///
    /// Interpolated between the points: else the order of the triangles, which changes the last digits of the sums, could
    /// move a quantile to the next point.
    fn between(&mut self, axis: fn(&DVec3) -> f64) -> (f64, f64) {
        self.points.sort_by(|a, b| axis(&a.0).total_cmp(&axis(&b.0)));
        let mut sum = 0.0;
        let passed = |(p, length): &(DVec3, f64)| {
            let middle = sum + length / 2.0;
            sum += length;
            (middle, axis(p))
        };
        let line: Vec<(f64, f64)> = self.points.iter().map(passed).collect();
        let at = |share: f64| {
            let wanted = share * self.length;
            let [(before, from), (after, to)] = beside(&line, wanted);
            from + (to - from) * (wanted - before) / (after - before).max(TINY)
        };
        (at(QUANTILES.0), at(QUANTILES.1))
    }
}

/// Where `triangles` pass the height `y`; `None` where they do not.
fn outline(figure: &Figure, triangles: &[[u32; 3]], y: f64) -> Option<Outline> {
    let mut points: Vec<(DVec3, f64)> = Vec::new();
    for corners in triangles {
        let p = corners.map(|vertex| figure.positions[vertex as usize]);
        if let Some([from, to]) = cut_at(p, y) {
            // A long edge counts along its whole length, not at its middle alone.
            let count = f64::from(EDGE_POINTS);
            let length = from.distance(to) / count;
            let point = |step: u32| from.lerp(to, (f64::from(step) + 0.5) / count);
            points.extend((0..EDGE_POINTS).map(|step| (point(step), length)));
        }
    }
    let length: f64 = points.iter().map(|&(_, length)| length).sum();
    (length > 0.0).then_some(Outline { points, length })
}
