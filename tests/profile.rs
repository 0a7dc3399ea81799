//! Profiles of real models, against what another program measured on them, and of people made of tubes.

#[path = "common/models.rs"]
mod models;

#[path = "common/people.rs"]
mod people;

use glam::{DMat3, DVec3};
use models::{Run, furthest, loaded, model, positions, rest_positions, style_of};
use people::Person;
use std::collections::BTreeMap;
use std::sync::Arc;
use superdeform::internals::geometry::{SEAM, weld};
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::part::Part;
use superdeform::internals::shape::product::profile::{BodyFrame, CHAINS, Profile, Row, measure_profile};
use superdeform::{
    BodyShape, Character, Deformer, GroupSettings, Options, Rig, RigOptions, Role, Stage, Style,
};
use superdeform_host::file::GltfFile;
use superdeform_host::samples;

/// The profile of a model of `shared/models` and its head length; `None` where it is not there. `head`: how long the head is
/// from the crown down, where another program says so.
fn profile_of(name: &str, head: Option<f64>) -> Option<(Profile, f64)> {
    let measured = Measured::of(&model(name)?.character, &Options::default()).unwrap();
    let figure = &measured.figure;
    let welded = weld(&figure.positions, SEAM * figure.height());
    let mut frame = BodyFrame::of(figure, &measured.anatomy);
    if let Some(head) = head {
        frame.heights.chin = frame.heights.crown - head;
    }
    let (profile, _) = measure_profile(figure, &figure.positions, &measured.chains, &welded, &frame, 1);
    Some((profile, frame.head_length()))
}

/// What a prototype in another language found, with a reader, cuts and landmarks of its own: in head lengths of its own,
/// which are given too. Numbers are those of the slices 1, 4, 7, 10 and 13 where there are five.
struct Known {
    name: &'static str,
    head_length: f64,
    numbers: &'static [(&'static str, &'static [f64])],
}

const KNOWN: [Known; 4] = [
    Known {
        name: "kaykit_rogue.glb",
        head_length: 0.9320,
        numbers: &[
            ("torso breadth", &[0.400, 0.407, 0.409, 0.392, 0.355]),
            ("torso depth", &[0.337, 0.341, 0.339, 0.328, 0.316]),
            ("leg breadth", &[0.115, 0.116, 0.110, 0.107, 0.120]),
            ("leg outward", &[0.181, 0.181, 0.181, 0.181, 0.181]),
            ("arm breadth", &[0.148, 0.119, 0.111, 0.117, 0.127]),
            ("hand", &[0.198, 0.125, 0.119]),
            ("foot", &[0.303, 0.121, 0.128, 0.181]),
        ],
    },
    Known {
        name: "godette.vrm",
        head_length: 0.4061,
        numbers: &[
            ("torso breadth", &[0.518, 0.462, 0.386, 0.328, 0.290]),
            ("torso depth", &[0.319, 0.312, 0.276, 0.246, 0.218]),
            ("leg breadth", &[0.205, 0.143, 0.124, 0.120, 0.113]),
            ("leg outward", &[0.315, 0.332, 0.355, 0.377, 0.397]),
            ("arm breadth", &[0.112, 0.094, 0.078, 0.068, 0.061]),
            ("hand", &[0.397, 0.128, 0.084]),
            ("foot", &[0.398, 0.111, 0.114, 0.397]),
            ("neck", &[0.130]),
        ],
    },
    Known {
        name: "makehuman_baby_reference.glb",
        head_length: 0.1342,
        numbers: &[
            ("torso breadth", &[0.519, 0.478, 0.458, 0.451, 0.446]),
            ("torso depth", &[0.330, 0.385, 0.397, 0.380, 0.375]),
            ("leg breadth", &[0.273, 0.221, 0.186, 0.153, 0.103]),
            ("leg depth", &[0.273, 0.213, 0.179, 0.150, 0.124]),
            ("leg outward", &[0.302, 0.333, 0.408, 0.467, 0.480]),
            ("arm breadth", &[0.162, 0.153, 0.143, 0.121, 0.084]),
            ("hand", &[0.500, 0.171, 0.109]),
            ("foot", &[0.489, 0.152, 0.135, 0.490]),
        ],
    },
    Known {
        name: "valid_hispanic_f_2_casual.glb",
        head_length: 0.2304,
        numbers: &[
            ("torso breadth", &[0.752, 0.672, 0.577, 0.567, 0.639]),
            ("torso depth", &[0.590, 0.520, 0.447, 0.439, 0.470]),
            ("leg breadth", &[0.264, 0.237, 0.210, 0.172, 0.136]),
        ],
    },
];

/// The same numbers of a profile, in model units.
fn numbers(profile: &Profile, head_length: f64, what: &str) -> Vec<f64> {
    let torso = profile.torso.as_ref().unwrap();
    let leg = profile.leg.as_ref().unwrap();
    let arm = profile.arm.as_ref().unwrap();
    let five = |row: &Row| (0..5).map(|index| row[3 * index]).collect::<Vec<f64>>();
    let found = match what {
        "torso breadth" => five(&torso.breadth),
        "torso depth" => five(&torso.depth),
        "leg breadth" => five(&leg.breadth),
        "leg depth" => five(&leg.depth),
        "leg outward" => five(&leg.outward),
        "arm breadth" => five(&arm.breadth),
        "hand" => profile.hand.unwrap().to_vec(),
        "foot" => profile.foot.unwrap()[..4].to_vec(),
        "neck" => vec![profile.neck.unwrap()],
        _ => unreachable!(),
    };
    found.into_iter().map(|number| number * head_length).collect()
}

#[test]
fn profiles_are_what_another_program_measured() {
    for known in &KNOWN {
        let Some((profile, head_length)) = profile_of(known.name, Some(known.head_length)) else { continue };
        for (what, wanted) in known.numbers {
            let found = numbers(&profile, head_length, what);
            for (index, (found, wanted)) in found.iter().zip(*wanted).enumerate() {
                let wanted_here = wanted * known.head_length;
                let off = (found - wanted_here).abs();
                // A neck of a seventh of a head is read between jaw and shoulders, where its radius changes most.
                let most = if *what == "neck" { 0.025 } else { 0.01 };
                assert!(
                    off <= (most * known.head_length).max(0.03 * wanted_here.abs()),
                    "{}: {what} {index} is {:.4} of its head instead of {wanted}",
                    known.name,
                    found / known.head_length
                );
            }
        }
    }
}

#[test]
fn a_skirt_is_no_leg_and_ends_where_it_ends() {
    let name = "valid_hispanic_f_2_casual.glb";
    let Some((profile, head_length)) = profile_of(name, None) else { return };
    let skirt = profile.skirt.unwrap();
    // 0.77, 0.79, 0.80 of a head of 0.2304 at the three slices that it reaches.
    let known: Vec<f64> = skirt.breadth.iter().flatten().copied().collect();
    assert_eq!(known.len(), 3);
    for (found, wanted) in known.iter().zip([0.77, 0.79, 0.80]) {
        assert!((found * head_length - wanted * 0.2304).abs() <= 0.03 * wanted * 0.2304, "{found}");
    }
}

/// A woman in a dress, and what a reference of 2.3 heads, one of 4.6 and a number make of her.
const TARGET: &str = "quaternius_female_dress.glb";
const REFERENCE: &str = "kaykit_rogue.glb";
const TODDLER: &str = "makehuman_baby_reference.glb";

fn shape_of(name: &str) -> BodyShape {
    match style_of(name, &Options::default()) {
        Style::Shape(shape) => *shape,
        Style::Heads(_) => unreachable!(),
    }
}

fn of_shape(shape: BodyShape) -> Style {
    Style::Shape(Box::new(shape))
}

fn run(style: &Style, options: &Options) -> Run {
    Run::new(TARGET, "style", style, options)
}

fn at_hand() -> bool {
    [TARGET, REFERENCE, TODDLER].iter().all(|name| model(name).is_some())
}

/// How far a result is from another, in heights of the target.
fn apart(one: &Run, other: &Run) -> f64 {
    furthest(&positions(&one.deformed), &positions(&other.deformed)) / one.height()
}

#[test]
fn a_body_that_has_the_profile_already_stays() {
    for name in [TARGET, REFERENCE] {
        if model(name).is_none() {
            continue;
        }
        let options = Options { head_scale: 1.0, face_squash: Some(0.0), ..Options::default() };
        let run = Run::new(name, name, &style_of(name, &options), &options);
        let moved = furthest(&positions(&run.deformed), &rest_positions(&model(name).unwrap().character));
        assert!(moved <= 1e-5 * run.height(), "{name}: {moved}");
    }
}

#[test]
fn a_result_has_the_body_of_its_reference() {
    if !at_hand() {
        return;
    }
    for name in [REFERENCE, TODDLER] {
        let run = run(&style_of(name, &Options::default()), &Options::default());
        let report = run.deformer.report(&run.deformed).unwrap();
        // Relief and soft limits leave a tenth; fingers of one bone and a toddler's hands are met to a fifth.
        for (chain, ratio) in &report.profile.ratios {
            let least = if *chain == "hand" { 0.8 } else { 0.9 };
            assert!((least..=1.1).contains(ratio), "{name}: {chain} {ratio}");
        }
        assert_eq!(report.profile.ratios.len(), 6);
        assert_eq!(report.profile.reference, shape_of(name).profile);
    }
}

#[test]
fn an_arm_is_no_slimmer_where_it_leaves_the_trunk() {
    // Arms taper from shoulder to wrist, the sample's as the style's. Where its trunk became shorter and its arms thicker, shoulders
    // were as low as the former made them: two thirds of what the arm was a little further out.
    let [target, reference] = ["quaternius_female_dress.glb", "kaykit_rogue.glb"]
        .map(|name| loaded(GltfFile::read(&samples::data().join(name)).unwrap()).character);
    let style = models::style(&reference, &Options::default());
    let deformer = Deformer::new(Arc::new(target.clone()), &style, &Options::default()).unwrap();
    for character in [target.with(&deformer.apply()), target] {
        let figure = Figure::of(&character).unwrap();
        let of = |role: Role| figure.role_position(role).unwrap();
        let (shoulder, elbow) = (of(Role::LeftUpperArm), of(Role::LeftLowerArm));
        // How high a cut across the arm is.
        let height = |share: f64| {
            let x = shoulder.x + share * (elbow.x - shoulder.x);
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for corners in &figure.triangles {
                let places = corners.map(|vertex| figure.positions[vertex as usize]);
                for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (places[a], places[b])) {
                    let y = a.lerp(b, (x - a.x) / (b.x - a.x)).y;
                    if (a.x - x) * (b.x - x) < 0.0 && (y - shoulder.y).abs() < shoulder.distance(elbow) {
                        (low, high) = (low.min(y), high.max(y));
                    }
                }
            }
            high - low
        };
        let inwards: Vec<f64> = (0..=20).map(|at| height(1.0 - f64::from(at) / 20.0)).collect();
        for pair in inwards.windows(2) {
            assert!(pair[1] > 0.95 * pair[0], "{inwards:?}");
        }
    }
}

/// A slim adult whose trunk's vertices, so far up from crotch (0) to shoulder line (1), are where `moved` puts them.
fn with_trunk(moved: impl Fn(DVec3, f64) -> DVec3) -> (Character, Vec<f64>) {
    let mut person = Person { blended: true, columns: 96, ..Person::adult() };
    person.proportions.torso_radius *= 0.7;
    let mut character = person.build();
    let figure = Figure::of(&character).unwrap();
    let of_trunk = |vertex: usize| figure.weight_of(vertex, |role| Part::of(role) == Part::Torso) > 0.99;
    let height = |p: DVec3| (p.y - person.crotch()) / (person.shoulder_line() - person.crotch());
    let heights = figure.positions.iter().enumerate();
    let heights: Vec<f64> =
        heights.map(|(vertex, &p)| if of_trunk(vertex) { height(p) } else { f64::NAN }).collect();
    for (p, &t) in character.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions).zip(&heights) {
        if (0.0..1.0).contains(&t) {
            *p = moved(p.as_dvec3(), t).as_vec3();
        }
    }
    (character, heights)
}

/// Height, back and front of the trunk's rings from a fifth to four fifths of it, upwards.
fn rings(positions: &[DVec3], heights: &[f64]) -> Vec<[f64; 3]> {
    let mut rings: BTreeMap<i64, [f64; 3]> = BTreeMap::new();
    for (p, t) in positions.iter().zip(heights).filter(|(_, t)| (0.2..0.8).contains(*t)) {
        let ring = rings.entry((1e4 * t).round() as i64).or_insert([p.y, p.z, p.z]);
        *ring = [p.y, ring[1].min(p.z), ring[2].max(p.z)];
    }
    rings.into_values().collect()
}

/// The rings of [`with_trunk`], and of what it becomes at two heads.
fn rings_and_barrel(moved: impl Fn(DVec3, f64) -> DVec3) -> [Vec<[f64; 3]>; 2] {
    let (character, heights) = with_trunk(moved);
    let before = rings(&rest_positions(&character), &heights);
    let deformer = Deformer::new(Arc::new(character), &Style::Heads(2.0), &Options::default()).unwrap();
    [before, rings(&positions(&deformer.apply()), &heights)]
}

#[test]
fn a_trunk_that_curves_becomes_a_straight_barrel() {
    // A wave and a half from crotch to shoulder line, as a back has: of a trunk of two heads smoothing leaves nothing of that, and
    // neither may what the parts do.
    let wave = |p: DVec3, t: f64| p + DVec3::Z * 0.02 * (3.0 * std::f64::consts::PI * t).sin();
    let [before, after] = rings_and_barrel(wave);
    let off_line = |rings: &[[f64; 3]]| {
        let middles: Vec<(f64, f64)> =
            rings.iter().map(|[y, back, front]| (*y, (back + front) / 2.0)).collect();
        let ((low, first), (high, last)) = (middles[0], middles[middles.len() - 1]);
        let off = |&(y, z): &(f64, f64)| (z - first - (last - first) * (y - low) / (high - low)).abs();
        middles.iter().map(off).fold(0.0, f64::max)
    };
    let (before, after) = (off_line(&before), off_line(&after));
    assert!(before > 0.03, "the trunk is straight: {before}");
    assert!(after < 0.05 * before, "{before} before, {after} after");
}

#[test]
fn folds_of_a_trunk_go_with_its_length() {
    // Ten folds of a fortieth of the trunk's depth, which across would grow as the trunk does while they lie five times as close.
    let fold = |p: DVec3, t: f64| {
        p * (DVec3::ONE + DVec3::new(1.0, 0.0, 1.0) * 0.025 * (20.0 * std::f64::consts::PI * t).sin())
    };
    let ([_, plain], [before, after]) = (rings_and_barrel(|p, _| p), rings_and_barrel(fold));
    let depth = |[_, back, front]: &[f64; 3]| front - back;
    let fold = 0.025 * depth(&before[before.len() / 2]);
    let left = plain
        .iter()
        .zip(&after)
        .map(|(plain, after)| (depth(plain) - depth(after)).abs())
        .fold(0.0, f64::max);
    assert!(left < 0.3 * fold, "{fold} before, {left} after");
}

/// How long the left hand is without its thumb, from the wrist along the line of its arm, and how high above that line it lies in
/// its first, second and last third: halfway between its highest and its lowest vertex there, wherever most of them are.
fn hand_middles(figure: &Figure) -> (f64, [f64; 3]) {
    let [shoulder, wrist] =
        [Role::LeftUpperArm, Role::LeftHand].map(|role| figure.role_position(role).unwrap());
    let axis = (wrist - shoulder).normalize();
    let is_of = |vertex: usize| {
        let thumb = |role: Role| format!("{role:?}").starts_with("LeftThumb");
        figure.weight_of(vertex, |role| Part::of(role) == Part::LeftHand) > 0.5
            && figure.weight_of(vertex, thumb) < 0.1
    };
    let places: Vec<(f64, f64)> = (0..figure.positions.len())
        .filter(|&vertex| is_of(vertex))
        .map(|vertex| figure.positions[vertex] - wrist)
        .map(|arm| (arm.dot(axis), arm.reject_from(axis).y))
        .collect();
    let length = places.iter().map(|place| place.0).fold(0.0, f64::max);
    let middle = |from: f64, to: f64| {
        let heights =
            places.iter().filter(|place| (from..=to).contains(&(place.0 / length))).map(|place| place.1);
        (heights.clone().fold(f64::MAX, f64::min) + heights.fold(f64::MIN, f64::max)) / 2.0
    };
    (length, [middle(0.0, 0.3), middle(0.35, 0.65), middle(0.7, 1.0)])
}

#[test]
fn a_hand_that_becomes_short_and_thick_droops_no_more_than_it_did() {
    if !at_hand() {
        return;
    }
    let run = run(&style_of(REFERENCE, &Options::default()), &Options::default());
    let droop = |figure: &Figure| {
        let (length, [near, _, far]) = hand_middles(figure);
        (near - far) / length
    };
    let (before, after) = (droop(run.before()), droop(&run.after()));
    assert!(before > 0.05, "the hand is straight: {before}");
    assert!(after.abs() <= before, "{before} before, {after} after");
}

#[test]
fn fingers_of_a_hand_that_becomes_a_mitt_curl_no_more_and_its_thumb_is_as_short() {
    if !at_hand() {
        return;
    }
    let run = run(&style_of(REFERENCE, &Options::default()), &Options::default());
    let after = run.after();
    let bent = |figure: &Figure| {
        let (length, [near, middle, far]) = hand_middles(figure);
        (length, (near - 2.0 * middle + far) / length)
    };
    let ((old, before), (new, bend)) = (bent(run.before()), bent(&after));
    assert!(before < -0.05, "the fingers are straight: {before}");
    assert!(new < 0.5 * old, "the hand stays long: {old} before, {new} after");
    // They go on as the palm leads, though the hand is several times as thick for its length.
    assert!(bend.abs() < before.abs() / 2.0, "{before} before, {bend} after");
    let thumb = |figure: &Figure| {
        let [root, end] = [Role::LeftThumbMetacarpal, Role::LeftThumbDistal]
            .map(|role| figure.role_position(role).unwrap());
        root.distance(end)
    };
    let (of_thumb, of_hand) = (thumb(&after) / thumb(run.before()), new / old);
    assert!((of_thumb / of_hand).ln().abs() < 0.15, "thumb {of_thumb}, hand {of_hand}");
}

#[test]
fn fingers_of_a_hand_that_becomes_a_mitt_lie_beside_each_other_and_the_thumb_in_their_plane() {
    let target = "makehuman_female_rigged.glb";
    if !at_hand() || model(target).is_none() {
        return;
    }
    let run = Run::new(target, "style", &style_of(REFERENCE, &Options::default()), &Options::default());
    let spread = |figure: &Figure| {
        let way =
            |[root, end]: [Role; 2]| figure.role_position(end).unwrap() - figure.role_position(root).unwrap();
        let index = way([Role::LeftIndexProximal, Role::LeftIndexDistal]);
        index.angle_between(way([Role::LeftLittleProximal, Role::LeftLittleDistal]))
    };
    let (before, after) = (spread(run.before()), spread(&run.after()));
    assert!(before > 0.2, "the fingers lie together: {before}");
    assert!(after < 0.6 * before, "{before} before, {after} after");
    // The sine of the angle between thumb and palm. Slices that become several times as thick for their length would make twice as
    // much of it, were the thumb not turned.
    let off_plane = |figure: &Figure| {
        let place = |role: Role| figure.role_position(role).unwrap();
        let [first, last] = [Role::LeftIndexProximal, Role::LeftLittleProximal].map(place);
        let normal = (last - first).cross(first.midpoint(last) - place(Role::LeftHand)).normalize();
        let thumb = place(Role::LeftThumbDistal) - place(Role::LeftThumbMetacarpal);
        thumb.normalize().dot(normal).abs()
    };
    let (before, after) = (off_plane(run.before()), off_plane(&run.after()));
    assert!(before > 0.2, "the thumb lies in the plane: {before}");
    assert!(after < 0.75 * before, "{before} before, {after} after");
}

#[test]
fn a_thumb_that_begins_before_its_hands_joint_is_a_bump_on_the_mitt() {
    let target = "quaternius_knight.glb";
    if !at_hand() || model(target).is_none() {
        return;
    }
    let run = Run::new(target, "style", &style_of(REFERENCE, &Options::default()), &Options::default());
    let thumb = |role: Role| format!("{role:?}").starts_with("LeftThumb");
    // How far below the hand's middle the thumb reaches, in half thicknesses of the hand.
    let hangs = |figure: &Figure| {
        let heights = |of_thumb: bool| {
            let counts = |vertex: &usize| {
                figure.weight_of(*vertex, |role| Part::of(role) == Part::LeftHand) > 0.5
                    && (figure.weight_of(*vertex, thumb) > 0.5) == of_thumb
            };
            let of = (0..figure.positions.len()).filter(counts).map(|vertex| figure.positions[vertex].y);
            of.fold([f64::MAX, f64::MIN], |[low, high], y| [low.min(y), high.max(y)])
        };
        let ([low, high], [lowest, _]) = (heights(false), heights(true));
        (0.5 * (low + high) - lowest) / (0.5 * (high - low))
    };
    let (before, after) = (hangs(run.before()), hangs(&run.after()));
    assert!(before > 2.0, "the thumb does not hang: {before}");
    // Half extents n become n sqrt(2 / (1 + n^2)): less than the root of 2 of them, wherever a thumb begins; of their box, of which
    // the hand's own vertices leave a fifth.
    assert!(after < 2.0f64.sqrt() / 0.8, "{before} before, {after} after");
}

#[test]
fn a_share_of_the_profile_is_between_none_and_all() {
    if !at_hand() {
        return;
    }
    let style = style_of(REFERENCE, &Options::default());
    let ratios = |profile: f64| {
        let run = run(&style, &Options { profile, ..Options::default() });
        run.deformer.report(&run.deformed).unwrap().profile.ratios
    };
    let [none, half, all] = [0.0, 0.5, 1.0].map(ratios);
    // A thin adult's torso and arms for so large a head: the parts' own thickness leaves more than an eighth.
    for chain in ["torso", "arms", "legs"] {
        assert!(none[chain] < 0.88 && none[chain] < half[chain] && half[chain] < all[chain], "{chain}");
    }
    let lengths =
        |profile: f64| run(&style, &Options { profile, stage: Stage::Length, ..Options::default() });
    assert_eq!(apart(&lengths(0.0), &lengths(1.0)), 0.0);
}

#[test]
fn a_saved_style_has_the_profile_and_an_older_one_that_of_so_many_heads() {
    if !at_hand() {
        return;
    }
    let shape = shape_of(REFERENCE);
    let read = BodyShape::from_json(&shape.to_json()).unwrap();
    assert_eq!((read.version, &read.profile), (2, &shape.profile));
    let plain = Options::default();
    let moved = apart(&run(&of_shape(shape.clone()), &plain), &run(&of_shape(read), &plain));
    assert!(moved <= 1e-6, "{moved}");
    let mut older: BTreeMap<String, serde_json::Value> = serde_json::from_str(&shape.to_json()).unwrap();
    older.remove("profile").unwrap();
    older.insert("superdeform_style".to_string(), 1.into());
    let older = BodyShape::from_json(&serde_json::to_string(&older).unwrap()).unwrap();
    assert_eq!(older.profile, None);
    let with = run(&of_shape(older.clone()), &plain);
    let without = run(&of_shape(older), &Options { profile: 0.0, ..plain });
    assert!(apart(&with, &without) > 0.01);
}

#[test]
fn half_of_two_styles_is_between_them_in_every_chain() {
    if !at_hand() {
        return;
    }
    let (small, tall) = (shape_of(REFERENCE), shape_of(TODDLER));
    let results = [0.0, 0.5, 1.0].map(|amount| {
        let run = run(&of_shape(small.blended(&tall, amount)), &Options::default());
        run.deformer.report(&run.deformed).unwrap().profile.result.unwrap()
    });
    let sizes = |profile: &Profile| {
        let (torso, leg, arm) =
            (profile.torso.as_ref().unwrap(), profile.leg.as_ref().unwrap(), profile.arm.as_ref().unwrap());
        let mean = |row: &Row| row.iter().sum::<f64>() / row.len() as f64;
        [mean(&torso.breadth), mean(&leg.breadth), mean(&arm.breadth), profile.hand.unwrap()[0]]
    };
    let [low, half, high] = results.each_ref().map(sizes);
    for chain in 0..4 {
        assert!(low[chain] < half[chain] && half[chain] < high[chain], "{chain}: {low:?} {half:?} {high:?}");
    }
}

#[test]
fn a_thickness_that_is_set_stands() {
    if !at_hand() {
        return;
    }
    let style = style_of(REFERENCE, &Options::default());
    let with = |group: &str, settings: GroupSettings, profile: f64| {
        let groups = BTreeMap::from([(group.to_string(), settings)]);
        run(&style, &Options { groups, profile, ..Options::default() })
    };
    let arms =
        |run: &Run| run.deformer.report(&run.deformed).unwrap().profile.result.unwrap().arm.unwrap().breadth;
    let set = GroupSettings { thickness_scale: Some(1.0), ..GroupSettings::default() };
    let kept = GroupSettings { thickness_transfer: Some(0.0), ..GroupSettings::default() };
    for settings in [set, kept] {
        let (sliced, parts) =
            (arms(&with("lower_arm", settings, 1.0)), arms(&with("lower_arm", settings, 0.0)));
        // The slices between elbow and wrist; those at the ends are the neighbours' too.
        for station in 8..11 {
            assert!((sliced[station] / parts[station] - 1.0).abs() < 0.05, "{station} {sliced:?} {parts:?}");
        }
        assert!(sliced[2] / parts[2] > 1.2, "{sliced:?} {parts:?}");
    }
}

/// The mean thickness, in the result's heads, of what the bone groups of torso and limbs are measured by.
fn thickness(run: &Run, group: &str) -> f64 {
    let profile = run.deformer.report(&run.deformed).unwrap().profile.result.unwrap();
    let mean = |breadth: Row, depth: Row, stations: std::ops::Range<usize>| {
        stations.clone().map(|at| (breadth[at] * depth[at]).sqrt().ln()).sum::<f64>() / stations.len() as f64
    };
    let (torso, leg, arm) = (profile.torso.unwrap(), profile.leg.unwrap(), profile.arm.unwrap());
    match group {
        "torso" => mean(torso.breadth, torso.depth, 2..13),
        "upper_leg" => mean(leg.breadth, leg.depth, 2..6),
        "lower_leg" => mean(leg.breadth, leg.depth, 9..13),
        "upper_arm" => mean(arm.breadth, arm.depth, 2..6),
        "lower_arm" => mean(arm.breadth, arm.depth, 8..11),
        _ => unreachable!(),
    }
    .exp()
}

#[test]
fn a_slider_that_is_moved_to_the_thickness_that_is_shown_leaves_it() {
    if !at_hand() {
        return;
    }
    for style in [Style::Heads(2.5), style_of(REFERENCE, &Options::default())] {
        let shown = run(&style, &Options::default());
        for group in ["torso", "upper_leg", "lower_leg", "upper_arm", "lower_arm"] {
            let thickness_scale = Some(shown.deformer.coefficients()[group].thickness_scale);
            let settings = GroupSettings { thickness_scale, ..GroupSettings::default() };
            let groups = BTreeMap::from([(group.to_string(), settings)]);
            let set = run(&style, &Options { groups, ..Options::default() });
            let ratio = thickness(&set, group) / thickness(&shown, group);
            assert!((0.85..=1.1).contains(&ratio), "{group}: {ratio} at {thickness_scale:?}");
        }
    }
}

/// What the warnings of a run with code `coefficient_limited` say, that of slices left out.
fn bounds_named(run: &Run) -> String {
    let warnings = run.deformer.warnings().iter();
    let named = warnings.filter(|warning| warning.code == "coefficient_limited" && warning.option.is_none());
    named.map(|warning| warning.message.clone()).collect::<Vec<_>>().join("; ")
}

#[test]
fn bounds_on_lengths_alone_are_warned_of() {
    if !at_hand() {
        return;
    }
    for profile in [0.0, 1.0] {
        let named = bounds_named(&run(&Style::Heads(1.8), &Options { profile, ..Options::default() }));
        assert!(named.contains("leg length") && !named.contains("thickness"), "{named}");
    }
}

#[test]
fn a_reference_without_a_rig_has_the_body_that_it_has_with_one() {
    let name = "quaternius_female_dress_unrigged.glb";
    let (Some(path), Some(twin)) = (samples::path(name), model(TARGET)) else { return };
    let bare = loaded(GltfFile::read(&path).unwrap());
    let rig = Rig::of(&bare.character, &RigOptions::default()).unwrap();
    let rigged = rig.applied_to(&bare.character);
    let profile =
        |character: &_| Measured::of(character, &Options::default()).unwrap().shape.profile.unwrap();
    let ratios = profile(&rigged).ratios(&profile(&twin.character));
    // As near as results are to be to their references.
    for (chain, ratio) in CHAINS.iter().zip(ratios) {
        assert!((0.9..=1.1).contains(&ratio), "{chain}: {ratio}");
    }
}

#[test]
fn the_jacobian_is_that_of_the_slices_too() {
    // With fingers: a thumb has a map of its own before the slices.
    let person = Person { blended: true, fingers: true, arm_angle: 30.0, ..Person::adult() };
    let character = Arc::new(person.build());
    let style = Style::Heads(2.5);
    let deformer = Deformer::new(character.clone(), &style, &Options::default()).unwrap();
    let step = 1e-6;
    let mut compared = 0;
    for joint in 0..character.skeleton.joints.len() {
        let at = character.skeleton.joints[joint].position();
        for offset in
            [DVec3::new(0.01, 0.02, 0.03), DVec3::new(-0.04, -0.01, 0.05), DVec3::new(0.03, 0.0, -0.09)]
        {
            let p = at + offset;
            let place = |p: DVec3| deformer.map(joint, p).position;
            let slope = |axis: DVec3| (place(p + step * axis) - place(p - step * axis)) / (2.0 * step);
            let differences = DMat3::from_cols(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            let jacobian = deformer.map(joint, p).jacobian;
            // A point may lie on an edge of a piecewise map, where both sides' slopes are right: few do.
            compared += usize::from(jacobian.abs_diff_eq(differences, 1e-4));
        }
    }
    let all = 3 * character.skeleton.joints.len();
    assert!(compared * 100 >= 95 * all, "{compared} of {all}");
}
