//! The paper's own mode on real models: what §V promises of a result, as numbers.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;

use glam::DVec3;
use models::{
    REFERENCES, Run, check_all, furthest, models as all_models, pairs, positions, present, rest_positions,
    scaled, style, style_of,
};
use people::Person;
use std::sync::{Arc, OnceLock};
use superdeform::internals::character::bones::Group;
use superdeform::internals::geometry::foot;
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::figure::Figure;
use superdeform::{Character, Deformed, Deformer, Mode, Options, Role, Stage, Style};

fn paper() -> Options {
    Options { mode: Mode::Paper, ..Options::default() }
}

fn runs() -> &'static [Run] {
    static RUNS: OnceLock<Vec<Run>> = OnceLock::new();
    RUNS.get_or_init(|| pairs(&paper()))
}

fn deform(character: &Character, style: &Style, options: &Options) -> (Deformer, Deformed) {
    let deformer = Deformer::new(Arc::new(character.clone()), style, options).unwrap();
    let deformed = deformer.apply();
    (deformer, deformed)
}

#[test]
fn the_body_takes_the_proportions_of_the_reference() {
    check_all(runs(), |run| {
        let report = run.deformer.report(&run.deformed).unwrap();
        let reference = report.reference.as_ref().unwrap();
        // Measured anew, the crown lies a little elsewhere where the nape grows less than the skull: the rays that
        // look for it keep to the middle of what the head moves.
        let head = 1.5 * report.target.head_length;
        let mut failures = Vec::new();
        if (report.result.head_length / head - 1.0).abs() > 0.02 {
            let measured = report.result.head_length;
            failures.push(format!("{}: the head is {measured} long instead of {head}", run.name));
        }
        for group in ["torso", "neck", "upper_arm", "lower_arm", "upper_leg", "lower_leg"] {
            let (Some(result), Some(wanted)) = (report.result.shape.get(group), reference.shape.get(group))
            else {
                continue;
            };
            let (result, wanted) = (result.length / head, wanted.length / reference.head_length);
            let off = (result / wanted - 1.0).abs();
            if off.is_nan() || off > 1e-5 {
                let name = &run.name;
                failures
                    .push(format!("{name}: {group} {result:.6} heads instead of {wanted:.6} ({off:.1e})"));
            }
        }
        failures
    });
}

/// How far two results are apart, in heights of the first's input.
fn difference(one: &(Deformer, Deformed), other: &(Deformer, Deformed), scale: f64) -> f64 {
    let rescale = |points: Vec<DVec3>| points.into_iter().map(|p| p * scale).collect::<Vec<_>>();
    let mut furthest_apart = furthest(&positions(&one.1), &rescale(positions(&other.1)))
        .max(furthest(&one.1.joints, &rescale(other.1.joints.clone())));
    for (mesh, other) in one.1.meshes.iter().zip(&other.1.meshes) {
        for (target, other) in mesh.morph_targets.iter().zip(&other.morph_targets) {
            let deltas = |deltas: &[glam::Vec3]| deltas.iter().map(|d| d.as_dvec3()).collect::<Vec<_>>();
            let other = rescale(deltas(&other.positions));
            furthest_apart = furthest_apart.max(furthest(&deltas(&target.positions), &other));
        }
    }
    furthest_apart / one.0.target().figure.height()
}

#[test]
fn the_unit_of_the_reference_does_not_matter() {
    let references = present(&REFERENCES);
    for mode in [Mode::Paper, Mode::Product] {
        let options = Options { mode, ..Options::default() };
        let work: Vec<(&str, &str)> = all_models()
            .keys()
            .flat_map(|target| references.iter().map(move |&name| (target.as_str(), name)))
            .filter(|(target, _)| target.starts_with("quaternius") || target.starts_with("godette"))
            .collect();
        check_all(&work, |&(target, reference)| {
            let target_character = &all_models()[target].character;
            let large = scaled(&all_models()[reference].character, 100.0);
            let plain = deform(target_character, &style_of(reference, &options), &options);
            let scaled = deform(target_character, &style(&large, &options), &options);
            let off = difference(&plain, &scaled, 1.0);
            (off > 1e-5)
                .then(|| format!("{target} like {reference} x 100, {mode:?}: {off:.1e} H"))
                .into_iter()
                .collect()
        });
    }
}

/// Targets in units so many times as long, whose results differ by more than 1e-5 H.
fn that_depend_on_their_unit(mode: Mode, scale: f64, most: f64) -> Vec<String> {
    let names: Vec<&String> = all_models().keys().collect();
    let reference = present(&REFERENCES)[0];
    let options = Options { mode, ..Options::default() };
    let style = style_of(reference, &options);
    let failures = models::in_parallel(&names, |&name| {
        let character = &all_models()[name].character;
        let plain = deform(character, &style, &options);
        let small = deform(&scaled(character, scale), &style, &options);
        let off = difference(&plain, &small, 1.0 / scale);
        (off > most).then(|| format!("{name} x {scale} like {reference}, {mode:?}: {off:.1e} H"))
    });
    failures.into_iter().flatten().collect()
}

#[test]
fn the_unit_of_the_target_does_not_matter() {
    let mut failures = that_depend_on_their_unit(Mode::Paper, 0.01, 1e-5);
    // A power of 2 changes no digit.
    failures.extend(that_depend_on_their_unit(Mode::Product, 1.0 / 128.0, 1e-5));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_last_digits_of_the_target_do_not_matter() {
    // A profile's ray that runs along an edge meets it or not.
    let failures = that_depend_on_their_unit(Mode::Product, 0.01, 5e-5);
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_head_is_scaled_about_its_joint() {
    check_all(runs(), |run| {
        let (before, after) = (run.before(), run.after());
        let joint = before.humanoid.joint(Role::Head).unwrap();
        let of_head: Vec<usize> = (0..before.positions.len())
            .filter(|&vertex| before.weight_of(vertex, |role| role == Role::Head) == 1.0)
            .collect();
        let expected: Vec<DVec3> = of_head
            .iter()
            .map(|&vertex| after.joints[joint] + 1.5 * (before.positions[vertex] - before.joints[joint]))
            .collect();
        let found: Vec<DVec3> = of_head.iter().map(|&vertex| after.positions[vertex]).collect();
        let off = furthest(&expected, &found) / run.height();
        (off > 1e-6)
            .then(|| format!("{}: {off:.1e} H over {} vertices", run.name, found.len()))
            .into_iter()
            .collect()
    });
}

/// Bones that alone move all vertices of their joint: no other bone begins there.
const SINGLE_BONES: [(Role, Role, &str); 9] = [
    (Role::Spine, Role::Chest, "torso"),
    (Role::Neck, Role::Head, "neck"),
    (Role::LeftUpperArm, Role::LeftLowerArm, "upper_arm"),
    (Role::LeftLowerArm, Role::LeftHand, "lower_arm"),
    (Role::LeftUpperLeg, Role::LeftLowerLeg, "upper_leg"),
    (Role::LeftLowerLeg, Role::LeftFoot, "lower_leg"),
    (Role::RightUpperArm, Role::RightLowerArm, "upper_arm"),
    (Role::RightUpperLeg, Role::RightLowerLeg, "upper_leg"),
    (Role::RightLowerLeg, Role::RightFoot, "lower_leg"),
];

/// Checks that an adult's tubes have become `length` times as long and `girth` times as thick as their bones were.
fn check_tubes(stage: Stage, girth: impl Fn(f64) -> f64) {
    let character = Person::adult().build();
    let style = style(&Person::chibi().build(), &paper());
    let options = Options { stage, face_squash: Some(1.0), ..paper() };
    let (deformer, deformed) = deform(&character, &style, &options);
    let coefficients = deformer.report(&deformed).unwrap().coefficients;
    let before = &deformer.target().figure;
    let after = Figure::of(&character.with(&deformed)).unwrap();
    for (start, end, group) in SINGLE_BONES {
        let bone = |figure: &Figure| [start, end].map(|role| figure.role_position(role).unwrap());
        let ([a, b], [new_a, new_b]) = (bone(before), bone(&after));
        let coefficient = coefficients[group];
        let length_scale = new_a.distance(new_b) / a.distance(b);
        assert!((length_scale - coefficient.length_scale).abs() < 1e-9, "{start}: {length_scale}");
        let mut count = 0;
        for vertex in 0..before.positions.len() {
            if before.weight_of(vertex, |role| role == start) < 1.0 {
                continue;
            }
            let (on_bone, t) = foot(before.positions[vertex], a, b);
            let (now_on_bone, now_t) = foot(after.positions[vertex], new_a, new_b);
            let was = before.positions[vertex].distance(on_bone);
            let is = after.positions[vertex].distance(now_on_bone);
            let expected = girth(coefficient.thickness_scale) * was;
            assert!((is - expected).abs() < 1e-6, "{start}: {is} from the bone instead of {expected}");
            assert!((now_t - t).abs() < 1e-5, "{start}: at {now_t} of the bone instead of {t}");
            count += 1;
        }
        assert!(count > 100, "{start}: {count} vertices");
    }
}

#[test]
fn the_first_stage_changes_lengths_alone() {
    check_tubes(Stage::Length, |_| 1.0);
}

#[test]
fn the_second_stage_scales_the_girth_about_the_bones() {
    check_tubes(Stage::Thickness, |thickness_scale| thickness_scale);
}

#[test]
fn the_first_stage_stretches_the_head_along_its_bone() {
    let character = Person::adult().build();
    let style = style(&Person::chibi().build(), &paper());
    let (deformer, deformed) = deform(&character, &style, &Options { stage: Stage::Length, ..paper() });
    let before = &deformer.target().figure;
    let after = Figure::of(&character.with(&deformed)).unwrap();
    let [joint, new_joint] = [before, &after].map(|figure| figure.role_position(Role::Head).unwrap());
    let top = deformer.target().head_top;
    for vertex in 0..before.positions.len() {
        let p = before.positions[vertex];
        if before.weight_of(vertex, |role| role == Role::Head) == 1.0 && p.y > joint.y && p.y < top.y {
            let expected = new_joint + (p - joint) * DVec3::new(1.0, 1.5, 1.0);
            assert!(after.positions[vertex].distance(expected) < 1e-6, "{p}");
        }
    }
}

#[test]
fn without_a_face_the_second_stage_is_the_last() {
    let character = Person::adult().build();
    let style = style(&Person::chibi().build(), &paper());
    let at = |stage, squash| {
        deform(&character, &style, &Options { stage, face_squash: Some(squash), ..paper() }).1
    };
    let (second, last) = (at(Stage::Thickness, 1.0), at(Stage::Face, 0.0));
    assert_eq!(positions(&second), positions(&last));
    assert_eq!(second.joints, last.joints);
    // The skeleton is the first stage's, but for the ground that all stand on; eyes and jaw lie beside their bone.
    let first = at(Stage::Length, 0.0);
    let beside = [Role::LeftEye, Role::RightEye, Role::Jaw];
    let on_bones = |joints: &[DVec3]| {
        let roles = character.humanoid.iter().filter(|(role, _)| !beside.contains(role));
        roles.map(|(_, joint)| joints[joint]).collect::<Vec<_>>()
    };
    let lift = last.joints[0] - first.joints[0];
    let lifted: Vec<DVec3> = on_bones(&first.joints).into_iter().map(|p| p + lift).collect();
    assert!(lift.with_y(0.0).length() < 1e-12);
    assert!(furthest(&lifted, &on_bones(&last.joints)) < 1e-9);
    assert!(furthest(&positions(&at(Stage::Face, 1.0)), &positions(&last)) > 0.01);
}

#[test]
fn girths_are_those_of_the_reference_in_heads() {
    let (adult, chibi) = (Person::adult(), Person::chibi());
    let (deformer, deformed) = deform(&adult.build(), &style(&chibi.build(), &paper()), &paper());
    let report = deformer.report(&deformed).unwrap();
    // l_head: head joint to head top, both known.
    let head = |person: &Person| person.head_top() - person.joints()[&Role::Head].y;
    for group in [Group::UpperArm, Group::LowerArm, Group::UpperLeg, Group::LowerLeg] {
        let wanted = chibi.radius(group).unwrap() / head(&chibi);
        let own = adult.radius(group).unwrap() / head(&adult);
        let thickness_scale = report.coefficients[group.name()].thickness_scale;
        // The ring that looks for the head top keeps to the middle of what the head moves, nose included.
        assert!((thickness_scale / (1.5 * wanted / own) - 1.0).abs() < 0.005, "{group}: {thickness_scale}");
    }
}

#[test]
fn nothing_of_the_way_is_the_character_itself() {
    let names: Vec<&String> = all_models().keys().collect();
    let work: Vec<_> = [Mode::Paper, Mode::Product]
        .into_iter()
        .flat_map(|mode| names.iter().map(move |name| (mode, *name)))
        .collect();
    check_all(&work, |&(mode, name)| {
        let options = Options { mode, amount: 0.0, ..Options::default() };
        let style = style_of(present(&REFERENCES)[0], &options);
        let character = &all_models()[name].character;
        let (_, deformed) = deform(character, &style, &options);
        let mut failures = Vec::new();
        if positions(&deformed) != rest_positions(character) {
            let off = furthest(&positions(&deformed), &rest_positions(character));
            failures.push(format!("{name}, {mode:?}: vertices moved by up to {off:.1e}"));
        }
        let joints: Vec<DVec3> = character.skeleton.joints.iter().map(|joint| joint.position()).collect();
        // In 64 bits, turning to the character's frame and back costs the last digit.
        let off = furthest(&joints, &deformed.joints);
        if off > 1e-14 * (1.0 + joints.iter().map(|p| p.length()).fold(0.0, f64::max)) {
            failures.push(format!("{name}, {mode:?}: joints moved by up to {off:.1e}"));
        }
        failures
    });
}

#[test]
fn half_of_the_way_lies_in_the_middle() {
    let names: Vec<&String> = all_models().keys().collect();
    let mut failures = Vec::new();
    for mode in [Mode::Paper, Mode::Product] {
        let whole = Options { mode, ..Options::default() };
        let half = Options { amount: 0.5, ..whole.clone() };
        let style = style_of(present(&REFERENCES)[0], &whole);
        failures.extend(models::in_parallel(&names, |&name| {
            let character = &all_models()[name].character;
            let (deformer, deformed) = deform(character, &style, &whole);
            let middle: Vec<DVec3> = positions(&deformed)
                .iter()
                .zip(rest_positions(character))
                .map(|(&p, q)| (p + q) / 2.0)
                .collect();
            let (_, found) = deform(character, &style, &half);
            let found = positions(&found);
            // Both stand on the ground, perhaps on other vertices.
            let lift = found[0] - middle[0];
            let lifted: Vec<DVec3> = middle.iter().map(|&p| p + lift).collect();
            let off = furthest(&found, &lifted) / deformer.target().figure.height();
            (off > 1e-6).then(|| format!("{name}, {mode:?}: {off:.1e} H from the middle"))
        }));
    }
    let failures: Vec<String> = failures.into_iter().flatten().collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn measuring_twice_gives_the_same_numbers() {
    for loaded in all_models().values().take(4) {
        let [one, other] = [0, 1].map(|_| Measured::of(&loaded.character, &paper()).unwrap().shape);
        assert_eq!(one, other);
    }
}
