//! What the name of a joint says: which part of the body, which side, which numbers.

use crate::character::Skeleton;
use std::collections::BTreeMap;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Side {
    Left,
    Right,
}

/// A part of the body as names know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Part {
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
    Thumb,
    Index,
    Middle,
    Ring,
    Little,
    /// A finger told by its number alone.
    NumberedFinger,
}

pub(super) const FINGERS: [Part; 5] = [Part::Thumb, Part::Index, Part::Middle, Part::Ring, Part::Little];

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
        "thigh" | "upperleg" | "upleg" | "legupper" | "legup" | "femur" | "足d" => (Part::UpperLeg, 0),
        // MikuMikuDance poses 足 and lets 足D follow it, which has the vertices.
        "足" => (Part::UpperLeg, 1),
        "leg" => (Part::Leg, 0),
        "calf" | "shin" | "lowerleg" | "lowleg" | "leglower" | "leglow" | "crus" | "foreleg" => {
            (Part::LowerLeg, 0)
        }
        "knee" | "ひざ" | "膝" | "ひざd" => (Part::LowerLeg, 1),
        "foot" | "feet" => (Part::Foot, 0),
        "ankle" | "足首" | "足首d" => (Part::Foot, 1),
        "toe" | "toes" | "つま先" | "爪先" | "足先ex" => (Part::Toes, 0),
        "ball" | "football" | "foottoe" | "foottoes" => (Part::Toes, 1),
        "finger" => (Part::NumberedFinger, 0),
        "fingers" => (Part::Middle, 1),
        _ => {
            let core = core.strip_prefix("hand").unwrap_or(core);
            // Metacarpals of the four fingers lie in the palm; only the thumb's has a role.
            let core = ["proximal", "intermediate", "distal"]
                .iter()
                .find_map(|joint| core.strip_suffix(joint))
                .unwrap_or(core);
            let finger = match core {
                "thumb" | "thumbmetacarpal" | "thumbfinger" | "親指" => Part::Thumb,
                "index" | "indexfinger" | "fingerindex" | "pointer" | "人指" | "人差指" | "人差し指" => {
                    Part::Index
                }
                "middle" | "mid" | "middlefinger" | "fingermiddle" | "中指" => Part::Middle,
                "ring" | "ringfinger" | "fingerring" | "薬指" => Part::Ring,
                "little" | "pinky" | "pinkie" | "littlefinger" | "pinkyfinger" | "fingerpinky"
                | "fingerlittle" | "小指" => Part::Little,
                _ => return None,
            };
            (finger, 0)
        }
    })
}

/// Words that name the rig or the kind of node, not a part of the body.
const RIG_WORDS: &str = "adj anim armature b base bend bind bip biped bn bone bones c cc character def deform f human \
    humanoid j jnt joint joints jt mixamo mixamorig org player rig sk skel skeleton skin stretch valve \
    valvebiped x";

/// Words of joints that help a rig along or end a chain, and of things worn: none of them plays a role.
const HELPER_WORDS: &str = "aim attach breast bust cape cloth collider control corrective ctl ctrl dummy ear eff effector \
    end fk hair handslot hat helper hlp holder ik item jiggle leaf locator mch nub null offset pole \
    prop ribbon roll sec share skirt slot socket tail target tweak twist twst weapon wing";

fn has_word(list: &str, word: &str) -> bool {
    list.split_whitespace().any(|listed| listed == word)
}

/// What one name says.
#[derive(Clone, Debug, Default)]
pub(super) struct Reading {
    pub(super) part: Option<(Part, u8)>,
    pub(super) side: Option<Side>,
    /// Runs of digits, as written.
    pub(super) numbers: Vec<String>,
}

impl Reading {
    pub(super) fn number(&self) -> u32 {
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
pub(super) fn words(name: &str) -> Vec<String> {
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
pub(super) fn read_all(skeleton: &Skeleton) -> Vec<Reading> {
    let mut names: Vec<Vec<String>> = skeleton.joints.iter().map(|joint| words(&joint.name)).collect();
    // Rigify keeps the joints that deform (DEF-) beside their originals (ORG-) and controls (no prefix), Auto-Rig Pro what
    // stretches beside what does not.
    let marks: [fn(&[String]) -> bool; 2] = [
        |words| words.first().is_some_and(|word| word == "def"),
        |words| words.iter().any(|word| word == "stretch"),
    ];
    // Two arms and two legs have eight joints: so many make a rule of it.
    let is_rule = marks.map(|mark| names.iter().filter(|words| mark(words)).count() >= 8);
    let lacks = |words: &Vec<String>| [0, 1].map(|index| is_rule[index] && !marks[index](words));
    let lacking: Vec<[bool; 2]> = names.iter().map(lacks).collect();
    loop {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for first in names.iter().filter_map(|words| words.first()) {
            *counts.entry(first).or_default() += 1;
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
            .find(|(word, count)| **count >= 8 && **count * 5 >= names.len() * 2 && !means_something(word))
            .map(|(word, _)| word.to_string());
        let numbered = |word: &str| ["bip", "character", "mixamorig", "armature", "rig"].contains(&word);
        let mut cut_any = false;
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
        .zip(lacking)
        .map(|(words, [def, stretch])| {
            let mut reading = read(words);
            reading.part = reading.part.filter(|(part, _)| match part {
                // No DEF- joint is an eye's or a jaw's for certain; what does not stretch may be a hand's.
                Part::Eye | Part::Jaw => true,
                Part::UpperArm | Part::Arm | Part::LowerArm | Part::UpperLeg | Part::Leg => !def && !stretch,
                _ => !def,
            });
            reading
        })
        .collect()
}
