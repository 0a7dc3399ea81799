//! Humanoid roles from joint names: the conventions of the common tools, read as one vocabulary.
//!
//! A name is cut into words (at punctuation, digits and capitals); side words, numbers and words that only name
//! the rig are set aside, and what remains must be exactly the name of a part of the body. So `hand` is a hand,
//! while `handIK`, `hand_twist`, `handslot` and `robo_hand` are none.

use super::humanoid::LEFT_FINGERS;
use super::{Humanoid, Role, Skeleton};
use std::collections::BTreeMap;

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
        let plain = plain(name);
        let (side, finger) = match (plain.strip_prefix("leftthumb"), plain.strip_prefix("rightthumb")) {
            (Some(joint), _) => ("left", joint),
            (_, Some(joint)) => ("right", joint),
            _ => return Role::all().find(|role| role.name().eq_ignore_ascii_case(&plain)),
        };
        let joint = match (thumbs, finger) {
            (_, "metacarpal") | (ThumbNames::Vrm0OrUnity, "proximal") => "metacarpal",
            (ThumbNames::Vrm1, "proximal") | (_, "intermediate") => "proximal",
            (_, "distal") => "distal",
            _ => return None,
        };
        let wanted = format!("{side}thumb{joint}");
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

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Side {
    Left,
    Right,
}

impl Side {
    /// The role on this side, from its left twin.
    fn of(self, left: Role) -> Role {
        left.on_side(self == Side::Left)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Finger {
    Thumb,
    Index,
    Middle,
    Ring,
    Little,
}

const FINGERS: [Finger; 5] = [Finger::Thumb, Finger::Index, Finger::Middle, Finger::Ring, Finger::Little];

/// A part of the body as names know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Part {
    Hips,
    Torso,
    Neck,
    Head,
    Jaw,
    Eye,
    Shoulder,
    UpperArm,
    /// "Arm": the upper one, or the lower one where an upper arm has a name of its own.
    Arm,
    LowerArm,
    Hand,
    UpperLeg,
    /// "Leg": the lower one below a thigh, else the upper one.
    Leg,
    LowerLeg,
    Foot,
    Toes,
    Finger(Finger),
    /// A finger told by its number alone.
    NumberedFinger,
}

/// The part that a name without side, number and rig words stands for, and how good the word is (0 best).
fn part_of(core: &str) -> Option<(Part, u8)> {
    Some(match core {
        "hips" | "腰" => (Part::Hips, 0),
        "hip" | "pelvis" | "下半身" => (Part::Hips, 1),
        "lowerbody" | "cog" | "センター" | "center" | "centre" => (Part::Hips, 2),
        "spine" | "chest" | "upperchest" | "torso" | "abdomen" | "abdomenlower" | "abdomenupper"
        | "chestlower" | "chestupper" | "waist" | "upperbody" | "belly" | "stomach" | "tummy" | "ribcage"
        | "ribs" | "thorax" | "back" | "spinelower" | "spinemid" | "spinemiddle" | "spineupper"
        | "lowerspine" | "upperspine" | "上半身" => (Part::Torso, 0),
        "neck" | "necklower" | "lowerneck" | "首" => (Part::Neck, 0),
        // Character Creator's neck is made of twist joints alone.
        "necktwist" | "neckupper" | "upperneck" => (Part::Neck, 1),
        "head" | "頭" => (Part::Head, 0),
        "skull" | "cranium" => (Part::Head, 1),
        "jaw" | "lowerjaw" | "jawroot" | "あご" => (Part::Jaw, 0),
        "eye" | "eyeball" | "faceeye" | "目" => (Part::Eye, 0),
        "clavicle" | "clav" | "collar" | "collarbone" | "shoulder" | "肩" => (Part::Shoulder, 0),
        "upperarm" | "uparm" | "armupper" | "armup" | "shldr" | "bicep" | "humerus" | "腕" | "上腕" => {
            (Part::UpperArm, 0)
        }
        "arm" => (Part::Arm, 0),
        "forearm" | "lowerarm" | "lowarm" | "armlower" | "armlow" | "前腕" => (Part::LowerArm, 0),
        "elbow" | "ひじ" | "肘" => (Part::LowerArm, 1),
        "hand" => (Part::Hand, 0),
        "wrist" | "手首" => (Part::Hand, 1),
        "palm" => (Part::Hand, 2),
        "thigh" | "upperleg" | "upleg" | "legupper" | "legup" | "femur" | "足" => (Part::UpperLeg, 0),
        "leg" => (Part::Leg, 0),
        "calf" | "shin" | "lowerleg" | "lowleg" | "leglower" | "leglow" | "crus" | "foreleg" => {
            (Part::LowerLeg, 0)
        }
        "knee" | "ひざ" | "膝" => (Part::LowerLeg, 1),
        "foot" | "feet" => (Part::Foot, 0),
        "ankle" | "足首" => (Part::Foot, 1),
        "toe" | "toes" | "つま先" | "爪先" => (Part::Toes, 0),
        "ball" | "football" | "foottoe" | "foottoes" => (Part::Toes, 1),
        "finger" => (Part::NumberedFinger, 0),
        "fingers" => (Part::Finger(Finger::Middle), 1),
        _ => {
            let core = core.strip_prefix("hand").unwrap_or(core);
            // Metacarpals of the four fingers lie in the palm; only the thumb's has a role.
            let core = ["proximal", "intermediate", "distal"]
                .iter()
                .find_map(|joint| core.strip_suffix(joint))
                .unwrap_or(core);
            let finger = match core {
                "thumb" | "thumbmetacarpal" | "thumbfinger" | "親指" => Finger::Thumb,
                "index" | "indexfinger" | "fingerindex" | "pointer" | "人指" | "人差指" | "人差し指" => {
                    Finger::Index
                }
                "middle" | "mid" | "middlefinger" | "fingermiddle" | "中指" => Finger::Middle,
                "ring" | "ringfinger" | "fingerring" | "薬指" => Finger::Ring,
                "little" | "pinky" | "pinkie" | "littlefinger" | "pinkyfinger" | "fingerpinky"
                | "fingerlittle" | "小指" => Finger::Little,
                _ => return None,
            };
            (Part::Finger(finger), 0)
        }
    })
}

/// Words that name the rig or the kind of node, not a part of the body.
const RIG_WORDS: &str = "adj anim armature b base bend bind bip biped bn bone bones c cc character def deform f human \
    humanoid j jnt joint joints jt mixamo mixamorig org player rig sk skel skeleton skin valve \
    valvebiped";

/// Words of joints that help a rig along or end a chain, and of things worn: none of them plays a role.
const HELPER_WORDS: &str = "aim attach breast bust cape cloth collider control corrective ctl ctrl dummy ear eff effector \
    end fk hair handslot hat helper hlp holder ik item jiggle leaf locator mch nub null offset pole \
    prop ribbon roll sec share skirt slot socket tail target tweak twist twst weapon wing";

fn has_word(list: &str, word: &str) -> bool {
    list.split_whitespace().any(|listed| listed == word)
}

/// What one name says.
#[derive(Clone, Debug, Default)]
struct Reading {
    part: Option<(Part, u8)>,
    side: Option<Side>,
    /// Runs of digits, as written.
    numbers: Vec<String>,
}

impl Reading {
    fn number(&self) -> u32 {
        let last = self.numbers.last();
        last.and_then(|digits| digits.parse().ok()).unwrap_or(0)
    }
}

/// True where the name of a joint says that it plays no role: twist, IK, end and the like.
pub(crate) fn is_helper(name: &str) -> bool {
    let words = words(name);
    let neck = words.iter().any(|word| word == "neck");
    let helps = |word: &String| has_word(HELPER_WORDS, word) && !(neck && word == "twist");
    words.iter().any(helps) || ["捩", "ＩＫ", "IK"].iter().any(|mark| name.contains(mark))
}

/// The words of a name in lower case: cut at punctuation, between letters and digits, and before capitals.
fn words(name: &str) -> Vec<String> {
    // What stands before a colon or a bar is a namespace.
    let name = name.rsplit([':', '|']).next().unwrap_or(name);
    let letters: Vec<char> = name.chars().map(narrow).collect();
    let mut words = Vec::new();
    let mut word = String::new();
    for (place, &letter) in letters.iter().enumerate() {
        if !letter.is_alphanumeric() {
            words.extend((!word.is_empty()).then(|| std::mem::take(&mut word)));
            continue;
        }
        let before = place.checked_sub(1).map(|place| letters[place]);
        let after = letters.get(place + 1).copied();
        let cut = before.is_some_and(|before| {
            before.is_numeric() != letter.is_numeric()
                || before.is_ascii() != letter.is_ascii()
                || before.is_lowercase() && letter.is_uppercase()
                || before.is_uppercase() && letter.is_uppercase() && after.is_some_and(char::is_lowercase)
        });
        if cut && !word.is_empty() {
            words.push(std::mem::take(&mut word));
        }
        word.extend(letter.to_lowercase());
    }
    words.extend((!word.is_empty()).then_some(word));
    // Japanese names put the side first, without a gap.
    words
        .into_iter()
        .flat_map(|word| match word.chars().next() {
            Some('左') => vec!["left".to_string(), word['左'.len_utf8()..].to_string()],
            Some('右') => vec!["right".to_string(), word['右'.len_utf8()..].to_string()],
            _ => vec![word],
        })
        .filter(|word| !word.is_empty())
        .collect()
}

/// Full-width digits and letters as their ASCII twins.
fn narrow(letter: char) -> char {
    match letter {
        '０'..='９' | 'Ａ'..='Ｚ' | 'ａ'..='ｚ' => {
            char::from_u32(letter as u32 - 0xFEE0).unwrap_or(letter)
        }
        _ => letter,
    }
}

fn side_of(word: &str) -> Option<Side> {
    match word {
        "l" | "left" | "lft" | "lt" => Some(Side::Left),
        "r" | "right" | "rgt" | "rt" => Some(Side::Right),
        _ => None,
    }
}

fn is_number(word: &str) -> bool {
    word.chars().all(char::is_numeric)
}

fn read(words: &[String]) -> Reading {
    let mut reading = Reading::default();
    let mut core = String::new();
    for word in words {
        if is_number(word) {
            reading.numbers.push(word.clone());
        } else if let Some(side) = side_of(word)
            && reading.side.is_none_or(|known| known == side)
        {
            reading.side = Some(side);
        } else if !has_word(RIG_WORDS, word) {
            core.push_str(word);
        }
    }
    reading.part = part_of(&core);
    if reading.part.is_none() && reading.side.is_none() {
        // Names in small letters only, such as "leftarm" and "rthigh".
        for (word, side) in
            [("left", Side::Left), ("right", Side::Right), ("l", Side::Left), ("r", Side::Right)]
        {
            let rest = core.strip_prefix(word);
            let rest = rest.or(core.strip_suffix(word).filter(|_| word.len() > 1));
            if let Some(part) = rest.and_then(part_of) {
                reading.side = Some(side);
                reading.part = Some(part);
                break;
            }
        }
    }
    reading
}

/// Reads all names; first words that most of them share are taken for the rig's name.
fn read_all(skeleton: &Skeleton) -> Vec<Reading> {
    let mut names: Vec<Vec<String>> = skeleton.joints.iter().map(|joint| words(&joint.name)).collect();
    // Rigify keeps the joints that deform (DEF-) beside their originals (ORG-) and controls (no prefix).
    let deforming = |words: &[String]| words.first().is_some_and(|word| word == "def");
    let any_deforming = names.iter().filter(|words| deforming(words)).count() >= 8;
    let demoted: Vec<bool> = names.iter().map(|words| any_deforming && !deforming(words)).collect();
    loop {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for first in names.iter().filter_map(|words| words.first()) {
            *counts.entry(first.clone()).or_default() += 1;
        }
        let means_something = |word: &str| {
            side_of(word).is_some()
                || is_number(word)
                || part_of(word).is_some()
                || has_word(HELPER_WORDS, word)
                || ["upper", "lower", "up", "low", "fore"].contains(&word)
        };
        let shared = counts
            .iter()
            .find(|(word, count)| **count >= 8 && **count * 5 >= names.len() * 2 && !means_something(word));
        let numbered = |word: &str| ["bip", "character", "mixamorig", "armature", "rig"].contains(&word);
        let mut cut_any = false;
        let shared = shared.map(|(word, _)| word.clone());
        for words in &mut names {
            let cut = words.first().is_some_and(|word| Some(word) == shared.as_ref() || numbered(word));
            if cut {
                words.remove(0);
                cut_any = true;
                // "Bip01", "Character1": the number belongs to the rig's name.
                if words.len() > 1 && is_number(&words[0]) {
                    words.remove(0);
                }
            }
        }
        if !cut_any {
            break;
        }
    }
    names
        .iter()
        .zip(demoted)
        .map(|(words, demoted)| {
            let mut reading = read(words);
            if let Some((_, rank)) = &mut reading.part
                && demoted
            {
                *rank += 4;
            }
            reading
        })
        .collect()
}

struct NamedSkeleton<'a> {
    skeleton: &'a Skeleton,
    readings: Vec<Reading>,
    depths: Vec<usize>,
}

impl NamedSkeleton<'_> {
    /// Joints whose names say `part` and `side`, best first: by word, then by number, then from the root.
    fn all(&self, part: Part, side: Option<Side>) -> Vec<usize> {
        let rank = |joint: usize| self.readings[joint].part.map_or(u8::MAX, |(_, rank)| rank);
        let mut found: Vec<usize> = (0..self.readings.len())
            .filter(|&joint| {
                let reading = &self.readings[joint];
                reading.side == side && reading.part.is_some_and(|(named, _)| named == part)
            })
            .collect();
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
        let side_hips: Vec<usize> = all(Part::Hips)
            .into_iter()
            .filter(|&joint| {
                words(&self.skeleton.joints[joint].name).iter().any(|word| word.starts_with("hip"))
            })
            .collect();
        let (legs, lowers, feet) = (all(Part::Leg), all(Part::LowerLeg), all(Part::Foot));
        let chain = self.chain(&legs);
        let mut upper = all(Part::UpperLeg).first().copied();
        if upper.is_none() {
            upper = side_hips.first().copied();
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
                .filter(|&joint| self.readings[joint].part.is_some_and(|(_, rank)| rank % 4 == 0));
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
        humanoid.set(side.of(Role::LeftUpperLeg), upper);
        humanoid.set(side.of(Role::LeftLowerLeg), lower);
        humanoid.set(side.of(Role::LeftFoot), foot);
        humanoid.set(side.of(Role::LeftToes), toes);
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
        let shoulder = upper.and_then(|upper| {
            let above = |&shoulder: &usize| shoulder != upper && self.below(upper, shoulder);
            shoulders.iter().copied().find(above)
        });
        humanoid.set(side.of(Role::LeftShoulder), shoulder);
        humanoid.set(side.of(Role::LeftUpperArm), upper);
        humanoid.set(side.of(Role::LeftLowerArm), lower);
        humanoid.set(side.of(Role::LeftHand), hand);
        let Some(hand) = hand else { return };
        for finger in FINGERS {
            let named = all(Part::Finger(finger));
            let mut joints: Vec<usize> = named.into_iter().filter(|&joint| self.below(joint, hand)).collect();
            joints.extend(self.numbered_finger(finger, hand));
            joints.sort_by_key(|&joint| self.depths[joint]);
            // Of joints that do not follow each other only the first line counts.
            let mut line: Vec<usize> = Vec::new();
            for joint in joints {
                if line.last().is_none_or(|&last| self.below(joint, last)) {
                    line.push(joint);
                }
            }
            let [first, second, third] = LEFT_FINGERS[finger as usize];
            let roles: &[Role] = match (finger, line.len()) {
                (Finger::Thumb, 2) => &[first, third],
                _ => &[first, second, third],
            };
            for (&role, &joint) in roles.iter().zip(&line) {
                humanoid.set(side.of(role), joint);
            }
        }
    }

    /// Joints of `finger` below `hand` where the finger is told by its number: `finger2-1` is the index finger's
    /// first joint (MakeHuman, from 1), `Finger12` its third (Biped, from 0).
    fn numbered_finger(&self, finger: Finger, hand: usize) -> Vec<usize> {
        let below: Vec<usize> = (0..self.readings.len())
            .filter(|&joint| {
                let numbered =
                    self.readings[joint].part.is_some_and(|(part, _)| part == Part::NumberedFinger);
                numbered && self.below(joint, hand)
            })
            .collect();
        let biped = below.iter().any(|&joint| self.readings[joint].numbers == ["0"]);
        let place = finger as usize;
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
        let neck = necks.iter().copied().find(|&neck| neck != head && self.below(head, neck));
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
        let arms = [Role::LeftUpperArm, Role::RightUpperArm].map(|role| humanoid.joint(role));
        let [Some(left), Some(right)] = arms else { return };
        let Some(shoulders_at) = self.skeleton.lowest_common_ancestor(left, right) else {
            return;
        };
        let Some(place) = chain.iter().position(|&joint| joint == shoulders_at) else {
            return;
        };
        if chain.len() < 5 || neck.is_some() {
            return;
        }
        let above = &chain[place + 1..];
        if let Some(&head) = above.last() {
            humanoid.set(Role::Head, head);
            humanoid.set(Role::Neck, above.first().copied().filter(|&neck| neck != head));
        }
    }
}

/// Roles as far as the names of the joints tell them.
///
/// Knows the names of Mixamo, Unreal, Unity-chan, Rigify, VRoid, KayKit, Quaternius, Biped, Character Creator,
/// ValveBiped, Daz, MakeHuman and MikuMikuDance, and most that are made like them. Where one joint's name fits but
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
            humanoid.set(side.of(Role::LeftEye), eye);
        }
        humanoid.set(Role::Jaw, named.first_below(&named.all(Part::Jaw, None), Some(head)));
    }
    // The hips by name: the deepest one that carries legs and head, else the best word.
    let carried = [Role::LeftUpperLeg, Role::RightUpperLeg, Role::Head];
    let carries = |hips: usize| {
        let mut joints = carried.iter().filter_map(|&role| humanoid.joint(role));
        joints.all(|joint| joint != hips && named.below(joint, hips))
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
