//! A skeleton by ray casting (Lopez and Poirel, reference 12).
//!
//! Rays from the front give the silhouette and its depth. The gap between the legs is followed upwards to the crotch, the
//! middle line upwards from the shoulders. Arms are branches of the solid, followed from the fingertips inwards to the
//! armpits, as cells show them and, where the front shows them, as rays at right angles to them do; of all that may be arms,
//! the pair that is most like arms is taken. Each joint is centred by the depths of the rays around it. What is not seen is
//! placed by ratio, and said so.

use super::arm_branch::{arms_of, raised};
use super::arm_choice::{Body, Candidate, FINER, IMAGE};
use super::arm_curve::Arm;
use super::arms::seen_by_rays;
use super::candidates::{Candidates, likelihood};
use super::front_view::{FrontView, image};
use super::hand::pair::add_fingers;
use super::head_line::{HeadLine, head_line, middle, neck};
use super::legs::{Leg, LegGap, LegLobes, Legs, find_legs, leg};
use super::solid::branches::branches;
use super::solid::{Solid, Voxels};
use super::{FoundJoint, UnitFigure};
use crate::character::humanoid::{LEFT_ARM, LEFT_LEG};
use crate::character::{MeshKind, Role};
use crate::error::{Result, Warning};
use crate::geometry::ROUNDING;
use crate::progress::Progress;
use crate::room::{self, Of};
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Hands end above this share of the crotch's height: those that hang reach .79 of it (Winter, table 4.1: .818 - .44 of .48
/// H), and lower on stylised figures. What ends further down is a leg.
const HANDS_ABOVE: f64 = 0.55;
/// A trunk that takes more than this share of an arm's reach is wider than its shoulders are. Seen: at -30 %, 18 more
/// good joints doubted; at +30 %, 15 more bad joints trusted.
const STOUT: f64 = 0.33;
/// The shoulder joints of a stout trunk are this far out, as a share of the reach (Winter, table 4.1: .129 of .129 + .44
/// H). Seen: without it, the shoulders of six models lie .06 to .08 H too far out.
const SHOULDER_OF_REACH: f64 = 0.227;
/// What takes more than this share of an arm's reach is no stout trunk, but hair or a cloak. Seen: stout models .35 to
/// .37, hair around the arms of a random person .47.
const NO_TRUNK: f64 = 0.42;
/// A neck lies above this share of the way from crotch to crown; the waist is below.
const NECK_ABOVE: f64 = 0.3;
/// The trunk's core, from which branches start, begins at this share of the way from crotch to neck.
const CORE_FROM: f64 = 0.1;
/// The trunk's core ends at the neck or, where none is seen, at this share of the way from crotch to crown.
const CORE_BY_RATIO: f64 = 0.45;
/// Spine and chest lie behind the trunk's middle by this share of half its depth. Seen: ±30 % moves joints by under
/// 0.0005 H.
const SPINE_BACK: f64 = 0.12;
/// The hips lie above the hip joints by this share of the way to the neck. Seen: at +30 %, four more joints off by over 0.06 H.
const HIPS_UP: f64 = 0.06;
/// The chest lies at the first of these shares of the way from hips to neck, the spine at the second of the way from
/// hips to chest. Seen: at +30 %, joints lie 0.002 H further off, eight more by over 0.06 H; of the second, at +30 %,
/// eight more joints off by over 0.06 H.
const CHEST_SHARE: f64 = 0.48;
const SPINE_OF_CHEST: f64 = 0.46;
/// The legs are looked for below this share of the height. Seen: at -30 %, three more joints off by over 0.06 H.
const LEGS_BELOW: f64 = 0.8;
/// A gap between legs that ends below this share of the shoulders' height ends at the hem of something, and one above the
/// second is no crotch either. The crotch of people is at .58 of it (Winter, table 4.1: .818 and .48 H), that of an SD figure
/// of two heads at .45.
const LEGS: RangeInclusive<f64> = 0.38..=0.78;
/// Beyond these shares hips and knees are doubted: between the two there, with room for stylised figures.
const USUAL_LEGS: RangeInclusive<f64> = 0.42..=0.72;
/// Joints of the middle line are at least so far apart. Seen: ±30 % changes no joint.
const APART: f64 = 2e-3;
/// The neck joint lies at this share of the way from shoulder line to narrowest row. Seen: at +30 %, joints lie
/// 0.0009 H further off.
const NECK_SHARE: f64 = 0.8;
/// The head joint lies over the chin by this share of the head's height. Seen: ±30 % moves joints by under 0.0005 H.
const HEAD_OVER_CHIN: f64 = 0.06;
/// The clavicle begins at this share of the way from the middle to the shoulder joint. Seen: ±30 % moves clavicles by
/// up to 0.016 H.
const CLAVICLE_SHARE: f64 = 0.3;
/// The clavicle lies over the shoulder joint by this share of the way from shoulder line to neck. Seen: ±30 % moves
/// clavicles by up to 0.007 H.
const CLAVICLE_OVER: f64 = 0.3;
/// Where no arm is seen, the shoulder line lies over the crotch by this share of what is above that.
const SHOULDER_BY_RATIO: f64 = 0.62;
/// Where no arm is seen, one is held out, with shoulder, elbow, wrist and tip at these distances from the axis, in
/// heights. Seen: ±30 % moves joints by under 0.0005 H.
const ARM_BY_RATIO: [f64; 4] = [0.10, 0.25, 0.39, 0.48];
/// The top of the head is as far forward as its middle this far below the crown, in heights. Seen: ±30 % moves no
/// joint, and vertices by up to 0.001 H.
const BELOW_CROWN: f64 = 0.02;
/// Joints whose sides agree to within this, after mirroring, are made each other's image. Seen: ±30 % moves joints by
/// under 0.0005 H.
const AGREE: f64 = 0.012;
/// Upper arms, and forearms, whose lengths differ by less are alike, whatever way each is held.
const ALIKE: f64 = 0.025;
/// Sides that differ by more than this are doubtful. Seen: ±30 % moves joints by under 0.0005 H.
const DIFFER: f64 = 0.04;

/// Confidence of what a rule saw, below 0.5 a joint is warned of: the share of such limb joints within 0.03 H. Of random
/// people (160 of even seeds) it is .96, of stripped models .91, and of the 160 of odd seeds .97.
pub const SEEN: f64 = 0.93;
/// Confidence of what follows from what a rule saw by the way bodies are made. Seen: at -30 %, 51 more good joints doubted.
pub const DERIVED: f64 = 0.7;
/// Confidence of hip joints that a rule saw, which artists put at heights of their own choice: the share within 0.03 H
/// is 1.0 of random people, .65 of stripped models, .71 of their solids.
const SEEN_HIP: f64 = 0.83;
/// Confidence of legs that show inside of a skirt alone: the share of their joints within 0.03 H is 1.0 of random people
/// of even seeds, .91 of stripped models, .98 of people of odd seeds.
const SEEN_INSIDE: f64 = 0.92;
/// Confidence of an ankle on a leg without a slim place: the share within 0.03 H is 1.0 of random people of even seeds,
/// 1.0 of the two that stripped models have, 1.0 of people of odd seeds.
const ANKLE_BY_LEG: f64 = 0.91;
/// Confidence of what rests on a doubtful reading: the share of such joints within 0.03 H is .55 of random people of
/// even seeds, .20 of stripped models, .61 of people of odd seeds.
pub const DOUBTFUL: f64 = 0.4;
/// Confidence of what a ratio gave: the share of such joints within 0.03 H is .33 of random people of even seeds, .17 of
/// those of odd seeds; of stripped models there are none.
const RATIO: f64 = 0.2;

/// A pair of arms that costs more than this is doubted. Of 60 random people the 56 whose arms lie within 0.06 H cost 4.2 and
/// less, the others 7 and more; of figures with hands on their hips, whose arms are all wrong, 16 and more.
const ODD_ARMS: f64 = 6.0;
/// Who stands has the feet under the shoulders, to within half a foot's length (Winter, table 4.1: .152 H); who sits has them
/// 0.13 H ahead and more, those that stand 0.05 H at most.
const BALANCE: f64 = 0.08;

/// Joints of a leg that may be given.
const LEG: [Role; 3] = [Role::LeftUpperLeg, Role::LeftLowerLeg, Role::LeftFoot];
/// Joints of an arm.
const ARM: [Role; 3] = [Role::LeftUpperArm, Role::LeftLowerArm, Role::LeftHand];

/// What the rays found.
#[derive(Clone, Debug, Default)]
pub struct FoundJoints {
    /// By role: hips, spine, chest, neck, head, and of each side shoulder, arm, hand, leg, foot, toes, and fingers where
    /// they are seen.
    pub joints: BTreeMap<Role, FoundJoint>,
    /// Where chains end: the crown under `Head`, the tip of the foot under `LeftToes`, fingertips under their distal
    /// joints (or the tip of a hand without fingers under `LeftHand`).
    pub tips: BTreeMap<Role, DVec3>,
    /// The chin, on the front of the face.
    pub chin: DVec3,
    /// The figure as cells, of which some joints were found.
    pub solid: Arc<Solid>,
    /// Where else arms and legs may be.
    pub candidates: Candidates,
    /// What a person should know.
    pub warnings: Vec<Warning>,
}

/// Finds the joints of `figure`; what is not seen is placed by ratio.
///
/// `kinds` are those of the unit figure's meshes. `given` joints (its space) stay where they are,
/// with confidence 1, and the rest is found around them. `cells`: of the solid, over the height.
///
/// # Errors
/// `Cancelled`, `OutOfMemory`.
pub fn find_joints(
    figure: &UnitFigure,
    kinds: &[MeshKind],
    given: &BTreeMap<Role, DVec3>,
    fingers: bool,
    cells: f64,
    thread_count: usize,
    progress: &mut Progress,
) -> Result<FoundJoints> {
    let given: BTreeMap<Role, DVec3> =
        given.iter().filter(|(_, at)| at.is_finite()).map(|(&role, &at)| (role, at)).collect();
    let view = FrontView::of(figure, kinds, thread_count, &mut progress.part(0.0, 0.5))?;
    let search = Search { view: &view, given: &given, found: FoundJoints::default() };
    let mut found = search.run(figure, cells, &mut progress.part(0.5, 0.7))?;
    progress.at(0.7)?;
    if fingers {
        add_fingers(figure, &view, &mut found);
    }
    progress.at(1.0)?;
    Ok(found)
}

struct Search<'a> {
    view: &'a FrontView<'a>,
    given: &'a BTreeMap<Role, DVec3>,
    found: FoundJoints,
}

impl Search<'_> {
    fn run(mut self, figure: &UnitFigure, cells: f64, progress: &mut Progress) -> Result<FoundJoints> {
        let view = self.view;
        let counts = |triangle: usize| view.meshes[figure.mesh_of(triangle)];
        let solid = Solid::new(&figure.positions, &figure.triangles, counts, view.axis, cells)?;
        let solid = Voxels::of(solid);
        room::ask(Of::Wave, solid.cells.len())?;
        progress.at(0.5)?;
        let lobes = LegLobes::of(&solid.solid, view.low, LEGS_BELOW * view.high);
        let (mut legs, inside) = find_legs(view, &lobes, LEGS_BELOW * view.high);
        let mut arms = self.arms(&legs, &solid);
        let mut tried = Vec::new();
        let shoulders = |arms: &[Option<Arm>; 2]| {
            let [Some(one), Some(other)] = arms else { return None };
            Some(0.5 * (one.shoulder.y + other.shoulder.y))
        };
        let share = |legs: &Legs, line: f64| (legs.crotch - view.low) / (line - view.low).max(1e-6);
        let seen_share = |legs: &Legs, arms: &[Option<Arm>; 2]| Some(share(legs, shoulders(arms)?));
        let is_low = |share: f64| share < *LEGS.start();
        let is_usual = |share: f64| USUAL_LEGS.contains(&share);
        if let Some(inside) = inside
            && (seen_share(&legs, &arms).is_some_and(is_low)
                || legs.seen == LegGap::Hem && seen_share(&inside, &arms).is_some_and(is_usual))
        {
            tried.push(std::mem::replace(&mut legs, inside));
            arms = self.arms(&legs, &solid);
        }
        if let Some(line) = shoulders(&arms)
            && (matches!(legs.seen, LegGap::Unseen | LegGap::Hem) || !LEGS.contains(&share(&legs, line)))
        {
            let below = legs.below_shoulders(view, line);
            tried.push(std::mem::replace(&mut legs, below));
        }
        // Legs that are oddly short or long under their shoulders end at the hem of something, or above the crotch.
        let odd = shoulders(&arms).is_some_and(|line| !is_usual(share(&legs, line)));
        let pair = self.both_legs(&legs);
        if let Some(line) = shoulders(&arms) {
            tried.push(legs.below_shoulders(view, line));
            let own = likelihood(legs.seen, share(&legs, line)).max(f64::MIN_POSITIVE);
            for other in &tried {
                let score = likelihood(other.seen, share(other, line)) / own;
                for (left, leg) in [true, false].into_iter().zip(self.both_legs(other)) {
                    self.found.candidates.add_leg(left, &leg, score);
                }
            }
        }
        self.put_legs(&legs, pair, odd);

        let has_arms = arms.iter().all(Option::is_some);
        self.put_arms(&legs, arms, &solid.solid);
        self.settle_sides();
        let shoulder_line = 0.5 * (self.at(Role::LeftUpperArm).y + self.at(Role::RightUpperArm).y);
        let line = head_line(view, shoulder_line);
        self.put_middle(&legs, &line, shoulder_line);
        self.settle_sides();
        // Two of legs, arms and a neck make a figure, and one that does not fall stands on its feet.
        let seen = [legs.seen != LegGap::Unseen, has_arms, line.neck_seen];
        if seen.into_iter().filter(|&seen| seen).count() < 2 || self.off_balance() > BALANCE {
            for joint in self.found.joints.values_mut() {
                joint.confidence = joint.confidence.min(DOUBTFUL);
            }
        }
        for (&role, &position) in self.given {
            if self.found.joints.contains_key(&role) {
                self.found.joints.insert(role, FoundJoint { position, confidence: 1.0 });
            }
        }
        self.found.solid = Arc::new(solid.solid);
        Ok(self.found)
    }

    /// Where some left joints' like on one side are given.
    fn given_of<const N: usize>(&self, roles: [Role; N], left: bool) -> [Option<DVec3>; N] {
        roles.map(|role| self.given.get(&role.on_side(left)).copied())
    }

    fn both_legs(&self, legs: &Legs) -> [Leg; 2] {
        [true, false].map(|left| leg(self.view, legs, left, self.given_of(LEG, left)))
    }

    /// What arms over `legs` are judged by.
    fn body<'s>(&self, legs: &Legs, solid: &'s Solid) -> Body<'s> {
        let given = [true, false].map(|left| self.given_of(ARM, left));
        let from = legs.crotch + NECK_ABOVE * (self.view.high - legs.crotch);
        let neck = neck(self.view, from..self.view.high);
        Body { solid, axis: self.view.axis, low: self.view.low, crotch: legs.crotch, neck, given }
    }

    /// The arms over `legs`: of the branches of the solid the pair that is most like arms.
    fn arms(&mut self, legs: &Legs, voxels: &Voxels) -> [Option<Arm>; 2] {
        let (view, solid) = (self.view, &voxels.solid);
        let body = &self.body(legs, solid);
        let neck = body.neck;
        let mut sides: [Vec<Candidate>; 2] = Default::default();
        let top = neck.unwrap_or(legs.crotch + CORE_BY_RATIO * (view.high - legs.crotch));
        let core = legs.crotch + CORE_FROM * (top - legs.crotch)..top;
        for branch in branches(voxels, view.axis, core) {
            let arms = arms_of(&branch, view.axis).into_iter();
            for (left, arm) in arms.filter(|(_, arm)| arm.tip.y > HANDS_ABOVE * legs.crotch) {
                let seen = seen_by_rays(view, &arm, left);
                let higher = seen.as_ref().and_then(|arm| raised(arm, solid));
                let of_rays = seen.into_iter().chain(higher).map(|arm| body.candidate(arm, left, 0.0));
                let side = &mut sides[usize::from(!left)];
                side.extend(of_rays.chain([body.candidate(arm, left, FINER)]));
            }
        }
        // Each with the other side's shoulder as well.
        let [lefts, rights] = &sides;
        let options = |left: bool, side: &[Candidate], others: &[Candidate]| -> Vec<Option<Candidate>> {
            let pairs = side.iter().flat_map(|one| others.iter().map(move |other| (one, other)));
            let images = pairs.map(|(one, other)| body.with_shoulder_of(&one.arm, &other.arm));
            let images = images.map(|arm| body.candidate(arm, left, IMAGE));
            std::iter::once(None).chain(side.iter().cloned().chain(images).map(Some)).collect()
        };
        let (lefts, rights) = (options(true, lefts, rights), options(false, rights, lefts));
        let mut best = (f64::INFINITY, [None, None]);
        // What the best pair costs that has each of them.
        let mut least = [vec![f64::INFINITY; lefts.len()], vec![f64::INFINITY; rights.len()]];
        for (at, left) in lefts.iter().enumerate() {
            for (opposite, right) in rights.iter().enumerate() {
                let cost = body.cost([left.as_ref(), right.as_ref()]);
                least[0][at] = least[0][at].min(cost);
                least[1][opposite] = least[1][opposite].min(cost);
                if cost < best.0 - ROUNDING {
                    best = (cost, [left, right].map(|one| one.as_ref().map(|one| one.arm.clone())));
                }
            }
        }
        for ((left, side), least) in [(true, &lefts), (false, &rights)].into_iter().zip(&least) {
            let arms = side.iter().zip(least).filter_map(|(one, &cost)| Some((&one.as_ref()?.arm, cost)));
            self.found.candidates.set_arms(left, arms);
        }
        best.1
    }

    fn at(&self, role: Role) -> DVec3 {
        self.given.get(&role).copied().unwrap_or_else(|| self.found.joints[&role].position)
    }

    fn put(&mut self, role: Role, position: DVec3, confidence: f64) {
        let position = if position.is_finite() { position } else { DVec3::ZERO };
        self.found.joints.insert(role, FoundJoint { position, confidence });
    }

    fn warn(&mut self, sentence: &str) {
        self.found.warnings.push(Warning::new("joint_by_ratio", sentence));
    }

    fn put_legs(&mut self, legs: &Legs, pair: [Leg; 2], odd: bool) {
        let (confidence, sentence) = match legs.seen {
            LegGap::Open => (SEEN, None),
            LegGap::Inside => (SEEN_INSIDE, None),
            LegGap::Hem => {
                (SEEN, Some("the legs were seen up to a hem: hip joints and knees placed by ratio"))
            }
            LegGap::Unseen => {
                (RATIO, Some("the legs were not seen apart: hip joints and knees placed by ratio"))
            }
        };
        sentence.into_iter().for_each(|sentence| self.warn(sentence));
        if pair.iter().any(|leg| !leg.ankle_seen) {
            self.warn("no slim place was seen above the feet: ankles placed by ratio");
        }
        for (left, leg) in [true, false].into_iter().zip(pair) {
            let ankle = if leg.ankle_seen { confidence } else { confidence.min(ANKLE_BY_LEG) };
            let upper = if odd || legs.seen == LegGap::Hem { confidence.min(DOUBTFUL) } else { confidence };
            self.put(Role::LeftUpperLeg.on_side(left), leg.hip, upper.min(SEEN_HIP));
            self.put(Role::LeftLowerLeg.on_side(left), leg.knee, upper);
            self.put(Role::LeftFoot.on_side(left), leg.ankle, ankle);
            self.put(Role::LeftToes.on_side(left), leg.toes, ankle);
            self.found.tips.insert(Role::LeftToes.on_side(left), leg.tip);
        }
    }

    fn put_arms(&mut self, legs: &Legs, arms: [Option<Arm>; 2], solid: &Solid) {
        let view = self.view;
        if arms.iter().any(Option::is_none) {
            self.warn("an arm was not seen: its joints are placed by ratio");
        } else if arms.iter().flatten().any(|arm| !arm.wrist_seen) {
            self.warn("no slim place was seen before a hand: wrists placed by ratio");
        }
        let arms = arms.map(|arm| arm.map(|arm| self.slim(arm)));
        let body = self.body(legs, solid);
        let [left, right] = [true, false].map(|left| {
            let (arm, _) = arms[usize::from(!left)].clone()?;
            Some(body.candidate(arm, left, 0.0))
        });
        let is_odd = body.cost([left.as_ref(), right.as_ref()]) > ODD_ARMS;
        let most = if is_odd { DOUBTFUL } else { 1.0 };
        for (left, arm) in [true, false].into_iter().zip(arms) {
            let (joints, confidences) = match arm {
                Some((arm, sure)) => {
                    let wrist = if arm.wrist_seen { SEEN } else { DOUBTFUL };
                    let sure = [SEEN.min(sure), wrist.min(sure), wrist].map(|sure| sure.min(most));
                    ([arm.shoulder, arm.elbow, arm.wrist, arm.tip], sure)
                }
                None => {
                    let y = legs.crotch + SHOULDER_BY_RATIO * (view.high - legs.crotch);
                    let joint = |distance: f64| view.point(left, distance, y, middle(view, y).0);
                    (ARM_BY_RATIO.map(joint), [RATIO; 3])
                }
            };
            let joints = self.around_given(left, joints);
            for (index, role) in ARM.into_iter().enumerate() {
                self.put(role.on_side(left), joints[index], confidences[index]);
            }
            self.found.tips.insert(Role::LeftHand.on_side(left), joints[3]);
        }
    }

    /// An arm that begins no further out than trunks are wide, and how sure its shoulder is at most.
    fn slim(&self, arm: Arm) -> (Arm, f64) {
        let length = arm.shoulder.distance(arm.elbow) + arm.elbow.distance(arm.tip);
        let stout = arm.pit.x / (arm.pit.x + length);
        if stout > NO_TRUNK || stout <= STOUT {
            return (arm, if stout > NO_TRUNK { DOUBTFUL } else { 1.0 });
        }
        let side = arm.shoulder.x - self.view.axis;
        let out = side.abs().min(SHOULDER_OF_REACH * (side.abs() + length));
        let shoulder = self.view.point(side > 0.0, out, arm.shoulder.y, arm.shoulder.z);
        (arm.from_shoulder(shoulder), DERIVED)
    }

    /// How far the feet are ahead of the shoulders or behind them, both sides' mean.
    fn off_balance(&self) -> f64 {
        let both = |role: Role| self.at(role).z + self.at(role.on_side(false)).z;
        (0.5 * (both(Role::LeftFoot) - both(Role::LeftUpperArm))).abs()
    }

    /// Shoulder, elbow, wrist and tip of an arm some of whose joints are given.
    fn around_given(&self, left: bool, found: [DVec3; 4]) -> [DVec3; 4] {
        let [shoulder, elbow, wrist] = self.given_of(ARM, left);
        let mut arm = found;
        arm[0] = shoulder.unwrap_or(found[0]);
        arm[2] = wrist.unwrap_or(found[2]);
        if (shoulder.is_some() || wrist.is_some()) && elbow.is_none() {
            // As far along and beside the line from shoulder to wrist as it was.
            let (before, after) = (found[2] - found[0], arm[2] - arm[0]);
            let share = (found[1] - found[0]).dot(before) / before.length_squared().max(1e-12);
            let beside = found[1] - found[0] - share * before;
            arm[1] = arm[0] + share * after + beside;
        }
        arm[1] = elbow.unwrap_or(arm[1]);
        arm[3] += arm[2] - found[2];
        arm
    }

    fn put_middle(&mut self, legs: &Legs, line: &HeadLine, shoulder_line: f64) {
        let view = self.view;
        let given = |role: Role| self.given.get(&role).map(|at| at.y);
        let hip_line = 0.5 * (self.at(Role::LeftUpperLeg).y + self.at(Role::RightUpperLeg).y);
        // Each above the one before, whatever was read.
        let crown = line.crown.max(shoulder_line + 4.0 * APART);
        let chin = line.chin.clamp(shoulder_line + 2.0 * APART, crown - 2.0 * APART);
        let neck = shoulder_line + NECK_SHARE * (line.neck - shoulder_line);
        let neck = given(Role::Neck).unwrap_or(neck.clamp(shoulder_line + APART, chin));
        let chin = chin.max(neck);
        let head = (chin + HEAD_OVER_CHIN * (crown - chin)).max(neck + APART);
        let head = given(Role::Head).unwrap_or(head);
        let hips = (hip_line + HIPS_UP * (neck - hip_line)).max(legs.crotch + APART);
        let hips = given(Role::Hips).unwrap_or(hips);
        let chest = hips + CHEST_SHARE * (neck - hips);
        let chest = given(Role::Chest).unwrap_or(chest.min(shoulder_line - APART).max(hips + 2.0 * APART));
        let spine = given(Role::Spine).unwrap_or(hips + SPINE_OF_CHEST * (chest - hips));
        let confidence = if line.neck_seen { DERIVED } else { DOUBTFUL };
        let is_apart = matches!(legs.seen, LegGap::Open | LegGap::Inside);
        let trunk = if is_apart { DERIVED } else { DOUBTFUL };
        if !line.neck_seen {
            self.warn("no neck was seen between shoulders and head: neck and head placed by ratio");
        }
        let on_axis = |y: f64, back: f64| {
            let (z, half_depth) = middle(view, y);
            DVec3::new(view.axis, y, z - back * half_depth)
        };
        for (role, y, back, confidence) in [
            (Role::Hips, hips, 0.0, trunk),
            (Role::Spine, spine, SPINE_BACK, trunk),
            (Role::Chest, chest, SPINE_BACK, trunk),
            (Role::Neck, neck, 0.0, confidence),
            (Role::Head, head, 0.0, confidence),
        ] {
            self.put(role, on_axis(y, back), confidence);
        }
        for left in [true, false] {
            let arm = self.at(Role::LeftUpperArm.on_side(left));
            let y = arm.y + CLAVICLE_OVER * (neck - shoulder_line).max(0.0);
            let at = on_axis(shoulder_line, SPINE_BACK).lerp(arm, CLAVICLE_SHARE).with_y(y);
            let confidence = self.found.joints[&Role::LeftUpperArm.on_side(left)].confidence;
            self.put(Role::LeftShoulder.on_side(left), at, confidence);
        }
        self.found.chin = DVec3::new(view.axis, chin, line.chin_z);
        let top = DVec3::new(view.axis, crown, middle(view, crown - BELOW_CROWN).0);
        self.found.tips.insert(Role::Head, top);
    }

    /// True of an arm that is held another way than the other one, but begins at the same shoulder and is as long.
    fn poses_apart(&self, role: Role) -> bool {
        let [left, right] = [true, false].map(|left| ARM.map(|role| self.at(role.on_side(left))));
        let differ = |index: usize| {
            (left[index].distance(left[index - 1]) - right[index].distance(right[index - 1])).abs()
        };
        let begins_alike = left[0].distance(image(right[0], self.view.axis)) <= DIFFER;
        ARM.contains(&role) && begins_alike && differ(1).max(differ(2)) <= ALIKE
    }

    /// Sides that agree become each other's image; sides that do not are doubtful.
    fn settle_sides(&mut self) {
        let image = |p: DVec3| image(p, self.view.axis);
        let given = self.given;
        let is_given = |role: &Role| given.contains_key(role) || given.contains_key(&role.mirrored());
        for role in [LEFT_LEG, LEFT_ARM].into_iter().filter(|limb| !limb.iter().any(is_given)).flatten() {
            let other = role.mirrored();
            // Clavicles come later.
            let joint = |role: Role| self.found.joints.get(&role).copied();
            let (Some(one), Some(two)) = (joint(role), joint(other)) else { continue };
            let apart = one.position.distance(image(two.position));
            if apart <= AGREE {
                let middle = 0.5 * (one.position + image(two.position));
                let confidence = one.confidence.min(two.confidence);
                self.put(role, middle, confidence);
                self.put(other, image(middle), confidence);
            } else if apart > DIFFER && !self.poses_apart(role) {
                self.put(role, one.position, one.confidence.min(DOUBTFUL));
                self.put(other, two.position, two.confidence.min(DOUBTFUL));
            }
        }
        for role in [Role::LeftToes, Role::LeftHand] {
            let (one, two) = (self.found.tips[&role], self.found.tips[&role.mirrored()]);
            if one.distance(image(two)) <= AGREE {
                let middle = 0.5 * (one + image(two));
                self.found.tips.insert(role, middle);
                self.found.tips.insert(role.mirrored(), image(middle));
            }
        }
    }
}
