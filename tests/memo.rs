//! A deformer whose options or style are changed gives what a new one gives, to the bit, and does no more than it must.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;

use glam::DVec3;
use people::Person;
use std::collections::BTreeSet;
use std::sync::Arc;
use superdeform::options::{Scope, TABLE};
use superdeform::{
    Character, Deformer, FaceCurve, GroupSettings, Height, Mode, Options, Progress, Repair, Role, Stage,
    Style,
};

type Change = fn(&mut Options);

macro_rules! numbers {
    ($($_block:ident { $(
        $(#[doc = $_text:literal])+
        $name:ident: $low:literal..=$high:literal = $_default:expr, $_modes:ident, $_heading:ident;
    )+ })+) => {
        /// For each option that is one number a value that is not its default.
        const NUMBERS: &[(&str, Change)] =
            &[$($((stringify!($name), |options| options.$name = $low + 0.2 * ($high - $low)),)+)+];
    };
}
superdeform::number_options!(numbers);

/// The same for all others.
const OTHERS: &[(&str, Change)] = &[
    ("mode", |options| options.mode = Mode::Paper),
    ("stage", |options| options.stage = Stage::Thickness),
    ("rays", |options| options.rays = Some(9)),
    ("limits", |options| options.limits = false),
    ("height", |options| options.height = Height::Keep),
    ("face_squash", |options| options.face_squash = Some(0.4)),
    ("face_curve", |options| options.face_curve = FaceCurve::F2),
    ("repair", |options| options.repair = Repair::Off),
    ("thread_count", |options| options.thread_count = 1),
    ("groups", |options| set(options, |group| group.length_scale = Some(0.7))),
    ("bone_groups", |options| {
        options.bone_groups =
            [Role::LeftLowerLeg, Role::RightLowerLeg].map(|role| (role, "thighs".to_string())).into();
    }),
    ("length_scale", |options| set(options, |group| group.length_scale = Some(0.5))),
    ("thickness_scale", |options| set(options, |group| group.thickness_scale = Some(1.3))),
    ("length_transfer", |options| set(options, |group| group.length_transfer = Some(0.5))),
    ("thickness_transfer", |options| set(options, |group| group.thickness_transfer = Some(0.5))),
    ("repair", |options| options.repair = Repair::Kept),
];

fn changes() -> impl Iterator<Item = (&'static str, Change)> {
    NUMBERS.iter().chain(OTHERS).copied()
}

fn set(options: &mut Options, change: fn(&mut GroupSettings)) {
    change(options.groups.entry("upper_leg".to_string()).or_default());
}

/// All that comes out, and where points go that hang from joints.
fn outcome(deformer: &Deformer) -> impl PartialEq + use<> {
    let deformed = deformer.apply();
    let meshes: Vec<_> = deformed
        .meshes
        .into_iter()
        .map(|mesh| (mesh.positions, mesh.normals, mesh.tangents, mesh.morph_targets))
        .collect();
    let joints = &deformer.character().skeleton.joints;
    let points: Vec<DVec3> = (0..joints.len())
        .map(|joint| deformer.map(joint, joints[joint].position() + DVec3::new(0.01, 0.02, 0.03)).position)
        .collect();
    let codes: Vec<_> =
        deformer.warnings().iter().map(|warning| (warning.code, warning.message.clone())).collect();
    (meshes, deformed.joints, points, codes, deformer.coefficients().clone())
}

/// Characters with hair, face, clothes and morph targets between them: two from files, two of tubes.
fn characters() -> Vec<(&'static str, Arc<Character>)> {
    let mut characters = vec![
        ("tubes in a skirt", Person { skirt: true, columns: 12, ..Person::adult() }.build()),
        ("chibi tubes", Person { columns: 12, ..Person::chibi() }.build()),
        ("dress", models::models()["quaternius_female_dress.glb"].character.clone()),
    ];
    if let Some(loaded) = models::model("makehuman_female_rigged.glb") {
        let mut character = loaded.character.clone();
        character.meshes.iter_mut().for_each(|mesh| mesh.morph_targets.truncate(2));
        characters.push(("MakeHuman", character));
    }
    characters.into_iter().map(|(name, character)| (name, Arc::new(character))).collect()
}

fn new(character: &Arc<Character>, style: &Style, options: &Options) -> Deformer {
    Deformer::new(Arc::clone(character), style, options).unwrap()
}

#[test]
fn every_option_of_the_table_changed_in_turn_gives_what_a_new_deformer_gives() {
    let listed: BTreeSet<&str> = changes().map(|(name, _)| name).collect();
    let settable = TABLE.iter().filter(|info| matches!(info.scope, Scope::Plain | Scope::Group));
    assert_eq!(listed, settable.map(|info| info.name).collect());

    let style = models::style_of("kaykit_rogue.glb", &Options::default());
    let mut without_effect = listed.clone();
    for (of, character) in characters() {
        let plain = Options::default();
        let mut live = new(&character, &style, &plain);
        let before = outcome(&live);
        for (name, change) in changes() {
            let mut options = plain.clone();
            change(&mut options);
            // It gives what was pushed last: of the same body.
            if options.repair == Repair::Kept {
                live.set_options(&plain, &mut Progress::none()).unwrap();
            }
            live.set_options(&options, &mut Progress::none()).unwrap();
            let (changed, made) = (outcome(&live), outcome(&new(&character, &style, &options)));
            assert!(changed == made, "{of}, {name}: a new deformer gives something else");
            if changed != before {
                without_effect.remove(name);
            }
            if options.mode == Mode::Paper {
                let options = Options { rays: Some(9), ..options };
                live.set_options(&options, &mut Progress::none()).unwrap();
                let rays = outcome(&live);
                assert!(rays == outcome(&new(&character, &style, &options)), "{of}, rays in paper mode");
                if rays != changed {
                    without_effect.remove("rays");
                }
            }
        }
        live.set_options(&plain, &mut Progress::none()).unwrap();
        assert!(outcome(&live) == before, "{of}: it does not come back");
    }
    // Threads must change nothing; what only some characters show needs those.
    let mut expected = BTreeSet::from(["thread_count"]);
    if models::model("makehuman_female_rigged.glb").is_none() {
        expected.extend(["hair_lay", "youth_ear", "repair", "hair_length"]);
        without_effect.extend(&expected);
    }
    assert_eq!(without_effect, expected, "options that no stage reads");
}

/// What no change of a part moves is taken from before: skirts, hands with fingers, and things that are carried among it.
#[test]
fn every_group_changed_after_another_gives_what_a_new_deformer_gives() {
    let style = models::style_of("kaykit_rogue.glb", &Options::default());
    let carrying = ("rogue", Arc::new(models::models()["kaykit_rogue.glb"].character.clone()));
    for (of, character) in characters().into_iter().chain([carrying]) {
        let mut live = new(&character, &style, &Options::default());
        let groups: Vec<String> = live.coefficients().keys().cloned().collect();
        let places = |deformer: &Deformer| {
            let deformed = deformer.apply();
            (deformed.meshes.into_iter().map(|mesh| mesh.positions).collect::<Vec<_>>(), deformed.joints)
        };
        let (mut before, mut moved) = (places(&live), 0);
        for group in groups {
            let mut options = Options::default();
            options.groups.entry(group.clone()).or_default().length_scale = Some(0.4);
            live.set_options(&options, &mut Progress::none()).unwrap();
            let changed = places(&live);
            assert!(changed == places(&new(&character, &style, &options)), "{of}, {group}");
            moved += usize::from(changed != before);
            before = changed;
        }
        assert!(moved > 4, "{of}: only {moved} groups move anything");
    }
}

#[test]
fn a_style_set_on_a_deformer_gives_what_a_new_one_gives() {
    let rogue = models::style_of("kaykit_rogue.glb", &Options::default());
    let styles = [Style::Heads(2.5), Style::Heads(4.0), rogue.clone()];
    for (of, character) in characters() {
        let mut live = new(&character, &rogue, &Options::default());
        for style in &styles {
            let before = live.clone();
            live.set_style(style, &mut Progress::none()).unwrap();
            let made = outcome(&new(&character, style, &Options::default()));
            assert!(outcome(&live) == made, "{of} like {style:?}");
            let again = live.made_again_since(&before);
            for measured in ["figure", "measured", "parts", "worn", "strands", "rest_triangles"] {
                assert!(!again.contains(&measured), "{of}: {measured} knows no style");
            }
        }
        // One that is refused changes nothing, and one that is the same does nothing.
        let before = live.clone();
        live.set_style(&Style::Heads(9.0), &mut Progress::none()).unwrap_err();
        live.set_style(&rogue, &mut Progress::none()).unwrap();
        assert_eq!(live.made_again_since(&before), [""; 0]);
        assert_eq!(*live.style(), rogue);
    }
}

#[test]
fn a_change_that_is_cancelled_changes_nothing() {
    let (_, character) = characters().swap_remove(0);
    let mut live = new(&character, &Style::Heads(3.0), &Options::default());
    let before = outcome(&live);
    let slim = Options { head_scale: 1.2, youth: 0.5, ..Options::default() };
    for allowed in 1..8 {
        let mut calls = 0;
        let mut stop = |_| {
            calls += 1;
            calls <= allowed
        };
        live.set_options(&slim, &mut Progress::new(&mut stop)).unwrap_err();
        assert!(*live.options() == Options::default() && outcome(&live) == before, "after {allowed} reports");
    }
    live.set_options(&slim, &mut Progress::none()).unwrap();
    assert!(outcome(&live) == outcome(&new(&character, &Style::Heads(3.0), &slim)));
}

/// What sliders wait for.
#[test]
fn a_change_does_again_what_depends_on_it_alone() {
    let (_, character) = characters().swap_remove(2);
    let all = |change: Change| {
        let mut options = Options::default();
        let mut live = new(&character, &Style::Heads(2.5), &options);
        let before = live.clone();
        change(&mut options);
        live.set_options(&options, &mut Progress::none()).unwrap();
        live.made_again_since(&before)
    };
    let last = ["finish", "warnings"];
    assert_eq!(all(|options| options.amount = 0.5), last);
    assert_eq!(all(|options| options.height = Height::Keep), last[..1]);
    assert_eq!(all(|options| options.thread_count = 2), [""; 0]);
    assert_eq!(all(|options| options.repair = Repair::Kept), ["pushed"]);
    let again = all(|options| options.youth = 0.5);
    for kept in [
        "measured", "parts", "body", "pushed", "offsets", "whole", "outline", "young", "seat", "strands",
        "hanging",
    ] {
        assert!(!again.contains(&kept), "youth does {kept} again");
    }
    let again = all(|options| options.head_scale = 1.3);
    for kept in ["figure", "measured", "parts", "worn", "head_sources", "strands", "outline_sources"] {
        assert!(!again.contains(&kept), "the size of the head does {kept} again");
    }
}
