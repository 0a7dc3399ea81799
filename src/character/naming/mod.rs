//! Humanoid roles from joint names: the conventions of the common tools, read as one vocabulary.
//!
//! A name is cut into words (at punctuation, digits and capitals); side words, numbers and words that only name
//! the rig are set aside, and what remains must be exactly the name of a part of the body. So `hand` is a hand,
//! while `handIK`, `hand_twist`, `handslot` and `robo_hand` are none.

mod words;

use super::humanoid::{LEFT_ARM, LEFT_FINGERS, LEFT_LEG};
use super::{Humanoid, Role, Skeleton};
pub(crate) use words::is_helper;
use words::{FINGERS, Part, Reading, Side, read_all, words};

/// How a list of role names speaks of the thumb's three joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThumbNames {
    /// Metacarpal, Proximal, Distal.
    Vrm1,
    /// Proximal, Intermediate, Distal for the same three joints.
    Vrm0OrUnity,
}

impl Role {
    /// The role called `name` by VRM 1.0, VRM 0.x or Unity; spaces, underscores, hyphens and case are ignored.
    ///
    /// Thumbs are read as VRM 1.0 names them; see [`Role::parse_as`] and [`parse_role_map`] for the others.
    pub fn parse(name: &str) -> Option<Role> {
        Self::parse_as(name, ThumbNames::Vrm1)
    }

    /// The role called `name`, where thumbs are named as `thumbs` says.
    pub fn parse_as(name: &str, thumbs: ThumbNames) -> Option<Role> {
        let mut wanted = plain(name);
        if let Some((side, joint)) = wanted.split_once("thumb") {
            let joint = match (thumbs, joint) {
                (_, "metacarpal") | (ThumbNames::Vrm0OrUnity, "proximal") => "metacarpal",
                (ThumbNames::Vrm1, "proximal") | (_, "intermediate") => "proximal",
                (_, "distal") => "distal",
                _ => return None,
            };
            wanted = format!("{side}thumb{joint}");
        }
        Role::all().find(|role| role.name().eq_ignore_ascii_case(&wanted))
    }
}

/// The roles of a whole map, whose thumbs decide together how they are meant: a map that has a Metacarpal is read
/// as VRM 1.0, any other as VRM 0.x or Unity.
///
/// Returns the convention and one entry a name, in order; `None` for names that are no role.
pub fn parse_role_map<'a>(names: impl Iterator<Item = &'a str>) -> (ThumbNames, Vec<Option<Role>>) {
    let names: Vec<&str> = names.collect();
    let thumbs = if names.iter().any(|name| plain(name).ends_with("thumbmetacarpal")) {
        ThumbNames::Vrm1
    } else {
        ThumbNames::Vrm0OrUnity
    };
    let roles = names.iter().map(|name| Role::parse_as(name, thumbs)).collect();
    (thumbs, roles)
}

fn plain(name: &str) -> String {
    let kept = name.chars().filter(|c| !matches!(c, ' ' | '_' | '-'));
    kept.flat_map(char::to_lowercase).collect()
}

struct NamedSkeleton<'a> {
    skeleton: &'a Skeleton,
    readings: Vec<Reading>,
    depths: Vec<usize>,
}

impl NamedSkeleton<'_> {
    /// Joints whose names say `part` and `side`, best first: by word, then by number, then from the root.
    fn all(&self, part: Part, side: Option<Side>) -> Vec<usize> {
        self.all_where(part, |own| own == side)
    }

    /// The same of any side that `choose` takes.
    fn all_where(&self, part: Part, choose: impl Fn(Option<Side>) -> bool) -> Vec<usize> {
        let mut found: Vec<usize> = (0..self.readings.len())
            .filter(|&joint| {
                let reading = &self.readings[joint];
                choose(reading.side) && reading.part.is_some_and(|(named, _)| named == part)
            })
            .collect();
        let rank = |joint: usize| self.readings[joint].part.map(|(_, rank)| rank);
        found.sort_by_key(|&joint| (rank(joint), self.readings[joint].number(), self.depths[joint], joint));
        found
    }

    fn below(&self, joint: usize, above: usize) -> bool {
        self.skeleton.is_below(joint, above)
    }

    /// The best of `joints` below `above`.
    fn first_below(&self, joints: &[usize], above: Option<usize>) -> Option<usize> {
        let above = above?;
        joints.iter().copied().find(|&joint| self.below(joint, above))
    }

    /// `joints` from the root on, where each lies below the one before; empty where they branch.
    fn chain(&self, joints: &[usize]) -> Vec<usize> {
        let mut chain = joints.to_vec();
        chain.sort_by_key(|&joint| self.depths[joint]);
        let nested = chain.windows(2).all(|pair| self.below(pair[1], pair[0]));
        if nested { chain } else { Vec::new() }
    }

    fn leg(&self, humanoid: &mut Humanoid, side: Side) {
        let all = |part| self.all(part, Some(side));
        // On one side, a "hip" is where the thigh begins. A pelvis of one side is not.
        let is_hip = |joint: &usize| {
            words(&self.skeleton.joints[*joint].name).iter().any(|word| word.starts_with("hip"))
        };
        let (legs, lowers, feet) = (all(Part::Leg), all(Part::LowerLeg), all(Part::Foot));
        let chain = self.chain(&legs);
        let mut upper = all(Part::UpperLeg).first().copied();
        if upper.is_none() {
            upper = all(Part::Hips).into_iter().find(is_hip);
            let leg = self.first_below(&legs, upper);
            if self.first_below(&lowers, leg).is_some() {
                upper = leg;
            }
        }
        let mut foot_by_chain = None;
        let mut toes_by_chain = None;
        let lower = if upper.is_some() {
            let strong = self
                .first_below(&lowers, upper)
                .filter(|&joint| self.readings[joint].part.is_some_and(|(_, rank)| rank == 0));
            // A knee beside a "leg" is a helper.
            strong.or_else(|| self.first_below(&legs, upper)).or_else(|| self.first_below(&lowers, upper))
        } else {
            upper = chain.first().or(legs.first()).copied();
            let named = self.first_below(&lowers, upper);
            if named.is_none() && feet.is_empty() && chain.len() <= 4 {
                foot_by_chain = chain.get(2).copied();
                toes_by_chain = chain.get(3).copied();
            }
            named.or_else(|| (chain.len() <= 4).then(|| chain.get(1).copied()).flatten())
        };
        // In rigs with IK the feet may hang from the root.
        let foot =
            self.first_below(&feet, lower.or(upper)).or_else(|| feet.first().copied()).or(foot_by_chain);
        let toes = all(Part::Toes);
        let toes = self.first_below(&toes, foot).or_else(|| self.first_below(&toes, lower)).or(toes_by_chain);
        humanoid.set_on_side(side == Side::Left, LEFT_LEG, [upper, lower, foot, toes]);
    }

    fn arm(&self, humanoid: &mut Humanoid, side: Side) {
        let all = |part| self.all(part, Some(side));
        let (shoulders, arms) = (all(Part::Shoulder), all(Part::Arm));
        let (lowers, hands) = (all(Part::LowerArm), all(Part::Hand));
        let chain = self.chain(&arms);
        let mut upper = all(Part::UpperArm).first().copied();
        let mut hand_by_chain = None;
        let lower;
        if upper.is_some() {
            lower = self.first_below(&lowers, upper).or_else(|| self.first_below(&arms, upper));
        } else if let Some(&arm) = chain.first().or(arms.first()) {
            upper = Some(arm);
            let named = self.first_below(&lowers, upper);
            // Longer chains of one word may begin with a collarbone or hold twist joints: left to the geometry.
            if named.is_none() && chain.len() > 3 {
                upper = None;
            } else if named.is_none() && hands.is_empty() {
                hand_by_chain = chain.get(2).copied();
            }
            lower = named.or_else(|| chain.get(1).copied().filter(|_| upper.is_some()));
        } else {
            // Without any arm, the last shoulder above an elbow or a hand is the upper arm.
            upper = shoulders
                .iter()
                .copied()
                .filter(|&shoulder| lowers.iter().chain(&hands).any(|&joint| self.below(joint, shoulder)))
                .max_by_key(|&shoulder| self.depths[shoulder]);
            lower = self.first_below(&lowers, upper);
        }
        let hand =
            self.first_below(&hands, lower.or(upper)).or_else(|| hands.first().copied()).or(hand_by_chain);
        let shoulder =
            upper.and_then(|upper| shoulders.iter().copied().find(|&shoulder| self.below(upper, shoulder)));
        humanoid.set_on_side(side == Side::Left, LEFT_ARM, [shoulder, upper, lower, hand]);
        let Some(hand) = hand else { return };
        // A finger is of the arm that it hangs from, though it hangs beside the hand, and whatever side its own name says.
        let from = lower.filter(|&lower| self.below(hand, lower)).unwrap_or(hand);
        for (place, finger) in FINGERS.into_iter().enumerate() {
            let named = self.all_where(finger, |side| side.is_some());
            let mut joints: Vec<usize> = named.into_iter().filter(|&joint| self.below(joint, from)).collect();
            joints.extend(self.numbered_finger(place, hand));
            joints.sort_by_key(|&joint| self.depths[joint]);
            // Of joints that do not follow each other only the first line counts.
            let mut line: Vec<usize> = Vec::new();
            for joint in joints {
                if line.last().is_none_or(|&last| self.below(joint, last)) {
                    line.push(joint);
                }
            }
            let mut roles = LEFT_FINGERS[place].to_vec();
            if finger == Part::Thumb && line.len() == 2 {
                roles.remove(1);
            }
            humanoid.set_on_side(side == Side::Left, roles, line);
        }
    }

    /// Joints of the finger in this place below `hand` where it is told by its number: `finger2-1` is the index finger's
    /// first joint (MakeHuman, from 1), `Finger12` its third (Biped, from 0).
    fn numbered_finger(&self, place: usize, hand: usize) -> Vec<usize> {
        let below: Vec<usize> = (0..self.readings.len())
            .filter(|&joint| {
                let numbered =
                    self.readings[joint].part.is_some_and(|(part, _)| part == Part::NumberedFinger);
                numbered && self.below(joint, hand)
            })
            .collect();
        let biped = below.iter().any(|&joint| self.readings[joint].numbers == ["0"]);
        let told = |&joint: &usize| match self.readings[joint].numbers.as_slice() {
            [number, _] => number.parse() == Ok(place + 1),
            [number] => {
                biped
                    && number.len() <= 2
                    && number.chars().next().and_then(|digit| digit.to_digit(10)) == Some(place as u32)
            }
            _ => false,
        };
        below.into_iter().filter(told).collect()
    }

    /// Neck and head.
    fn top(&self, humanoid: &mut Humanoid) {
        let necks = self.all(Part::Neck, None);
        let heads = self.all(Part::Head, None);
        let below_a_neck = |joint: &&usize| necks.iter().any(|&neck| self.below(**joint, neck));
        let head = heads.iter().find(below_a_neck).or(heads.first()).copied();
        let Some(head) = head else {
            self.numbered_spine(humanoid, necks.first().copied());
            return;
        };
        humanoid.set(Role::Head, head);
        let neck = necks.iter().copied().find(|&neck| self.below(head, neck));
        humanoid.set(Role::Neck, neck);
    }

    /// Rigify's column: `spine`, `spine.001` and so on up to `spine.006`, which is the head.
    fn numbered_spine(&self, humanoid: &mut Humanoid, neck: Option<usize>) {
        humanoid.set(Role::Neck, neck);
        let spines: Vec<usize> = self.all(Part::Torso, None);
        let best = spines.first().and_then(|&joint| self.readings[joint].part);
        let spines: Vec<usize> =
            spines.into_iter().filter(|&joint| self.readings[joint].part == best).collect();
        let chain = self.chain(&spines);
        if chain.len() < 5 || neck.is_some() {
            return;
        }
        let arms = humanoid.joint(Role::LeftUpperArm).zip(humanoid.joint(Role::RightUpperArm));
        let shoulders_at = arms.and_then(|(left, right)| self.skeleton.lowest_common_ancestor(left, right));
        let mut above = chain.into_iter().skip_while(|&joint| Some(joint) != shoulders_at).skip(1);
        let first = above.next();
        if let Some(head) = above.last().or(first) {
            humanoid.set(Role::Head, head);
            humanoid.set(Role::Neck, first.filter(|&neck| neck != head));
        }
    }
}

/// Roles as far as the names of the joints tell them.
///
/// Knows the names of Mixamo, Unreal, Unity-chan, Rigify, VRoid, KayKit, Quaternius, Biped, Character Creator,
/// ValveBiped, Daz, MakeHuman, Auto-Rig Pro and MikuMikuDance, and most that are made like them. Where one joint's name fits but
/// it does not hang where it should (a lower arm beside its upper arm), it gets no role. Names that tell nothing
/// give an empty map. What names leave open between those roles, [`complete`](super::roles::complete) fills in.
pub fn roles_from_names(skeleton: &Skeleton) -> Humanoid {
    let mut depths = vec![0; skeleton.joints.len()];
    for joint in skeleton.parents_first() {
        depths[joint] = skeleton.joints[joint].parent.map_or(0, |parent| depths[parent] + 1);
    }
    let named = NamedSkeleton { skeleton, readings: read_all(skeleton), depths };
    let mut humanoid = Humanoid::default();
    for side in [Side::Left, Side::Right] {
        named.leg(&mut humanoid, side);
        named.arm(&mut humanoid, side);
    }
    named.top(&mut humanoid);
    if let Some(head) = humanoid.joint(Role::Head) {
        for side in [Side::Left, Side::Right] {
            let eye = named.first_below(&named.all(Part::Eye, Some(side)), Some(head));
            humanoid.set(Role::LeftEye.on_side(side == Side::Left), eye);
        }
        humanoid.set(Role::Jaw, named.first_below(&named.all(Part::Jaw, None), Some(head)));
    }
    // The hips by name: the deepest one that carries legs and head, else the best word.
    let carried = [Role::LeftUpperLeg, Role::RightUpperLeg, Role::Head];
    let carries = |hips: usize| {
        let mut joints = carried.iter().filter_map(|&role| humanoid.joint(role));
        joints.all(|joint| named.below(joint, hips))
    };
    let all = named.all(Part::Hips, None);
    let hips = all
        .iter()
        .copied()
        .filter(|&hips| carries(hips))
        .max_by_key(|&hips| named.depths[hips])
        .or(all.first().copied());
    humanoid.set(Role::Hips, hips);
    humanoid
}
