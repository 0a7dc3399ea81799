//! Clothes that were outside of the body stay outside of it, on real models; `product/repair.rs` has the stage alone.

#[path = "common/clothes.rs"]
mod clothes;
#[path = "common/models.rs"]
mod common;

use clothes::{Pose, REST, SIT, WALK, newly_inside, worn};
use common::{Run, check_all, in_parallel, model, style_of};
use glam::DVec3;
use std::sync::OnceLock;
use superdeform::{BodyShape, Character, Height, MeshKind, Options, Progress, Repair, Style};

/// A dressed model like a style, as it comes out with and without the repair.
struct Pair {
    name: String,
    /// Off, on.
    runs: [Run; 2],
}

const DRESSED: [&str; 3] = ["makehuman_female_rigged.glb", "quaternius_female_dress.glb", "seedsan_vrm1.vrm"];

fn styles() -> Vec<(&'static str, Style)> {
    let options = Options::default();
    let mut styles = vec![
        ("2.5 heads", Style::heads(2.5).unwrap()),
        ("sd2", Style::Shape(Box::new(BodyShape::built_in("sd2").unwrap()))),
    ];
    let models = ["kaykit_rogue.glb", "godette.vrm"];
    styles.extend(
        models.into_iter().filter(|name| model(name).is_some()).map(|name| (name, style_of(name, &options))),
    );
    styles
}

fn pairs() -> &'static [Pair] {
    static PAIRS: OnceLock<Vec<Pair>> = OnceLock::new();
    let there: Vec<_> = DRESSED.into_iter().filter(|name| model(name).is_some()).collect();
    PAIRS.get_or_init(|| {
        let styles = styles();
        let work: Vec<_> =
            there.iter().flat_map(|target| styles.iter().map(move |style| (target, style))).collect();
        in_parallel(&work, |&(&target, (style_name, style))| {
            let runs = [Repair::Off, Repair::On].map(|repair| {
                Run::new(
                    target,
                    style_name,
                    style,
                    &Options { repair, thread_count: 1, ..Options::default() },
                )
            });
            Pair { name: runs[0].name.clone(), runs }
        })
    })
}

/// Shares of what is worn that are inside the body in a pose and were not before: without the repair, with it.
fn shares(pair: &Pair, pose: Pose) -> [f64; 2] {
    let character: &Character = pair.runs[0].deformer.character();
    let worn = worn(character);
    pair.runs.each_ref().map(|run| newly_inside(character, &worn, &run.deformed, pose))
}

#[test]
fn at_rest_hardly_any_cloth_is_newly_inside() {
    check_all(pairs(), |pair| {
        let [without, with] = shares(pair, REST);
        println!("{}: {:.2} -> {:.2} %", pair.name, 100.0 * without, 100.0 * with);
        if with <= 0.005 && with <= without {
            return Vec::new();
        }
        vec![format!(
            "{}: {:.2} % without the repair, {:.2} % with it",
            pair.name,
            100.0 * without,
            100.0 * with
        )]
    });
}

#[test]
fn walking_and_sitting_no_more_is_inside_than_without_the_repair() {
    // Two styles of each model are enough: poses take their time.
    let pairs: Vec<&Pair> = pairs().iter().step_by(2).collect();
    check_all(&pairs, |pair| {
        let mut wrong = Vec::new();
        for (name, pose) in [("walk", WALK), ("sit", SIT)] {
            let [without, with] = shares(pair, pose).map(|share| 100.0 * share);
            println!("{}, {name}: {without:.2} -> {with:.2} %", pair.name);
            if with > without {
                wrong.push(format!(
                    "{}, {name}: {without:.2} % without the repair, {with:.2} % with it",
                    pair.name
                ));
            }
        }
        wrong
    });
}

#[test]
fn nothing_but_clothes_moves_and_no_triangle_turns_over() {
    check_all(pairs(), |pair| {
        let [off, on] = &pair.runs;
        let mut wrong = Vec::new();
        for (mesh, content) in off.loaded.character.meshes.iter().enumerate() {
            let points = |run: &Run| -> Vec<DVec3> {
                run.deformed.meshes[mesh].positions.iter().map(|p| p.as_dvec3()).collect()
            };
            let (before, after) = (points(off), points(on));
            let may_move = matches!(content.kind, None | Some(MeshKind::Garment | MeshKind::Hair));
            if !may_move && before != after {
                wrong.push(format!("{}: {} moves", pair.name, content.name));
            }
            if content.kind == Some(MeshKind::Hair) {
                continue;
            }
            for corners in &content.triangles {
                let normal = |points: &[DVec3]| {
                    let [a, b, c] = corners.map(|vertex| points[vertex as usize]);
                    (b - a).cross(c - a)
                };
                // Rounding to floats may turn needles over.
                let (one, other) = (normal(&before), normal(&after));
                if one.dot(other) < -1e-16 * on.height().powi(4) {
                    wrong.push(format!("{}: {corners:?} of {} turned over", pair.name, content.name));
                }
            }
        }
        wrong
    });
}

#[test]
fn a_push_grows_with_the_amount_and_is_kept_while_a_slider_moves() {
    let Some(loaded) = model("seedsan_vrm1.vrm") else {
        return;
    };
    let style = Style::heads(2.5).unwrap();
    let options = Options { thread_count: 2, ..Options::default() };
    let character = std::sync::Arc::new(loaded.character.clone());
    let of = |options: &Options| superdeform::Deformer::new(character.clone(), &style, options).unwrap();
    let positions = |deformer: &superdeform::Deformer| common::positions(&deformer.apply());
    let offsets = |on: &superdeform::Deformer, off: &superdeform::Deformer| -> Vec<DVec3> {
        positions(on).iter().zip(positions(off)).map(|(p, q)| *p - q).collect()
    };
    let off = Options { repair: Repair::Off, ..options.clone() };
    let (mut with, mut without) = (of(&options), of(&off));
    let whole = offsets(&with, &without);
    let longest = whole.iter().map(|offset| offset.length()).fold(0.0, f64::max);
    assert!(longest > 0.0, "nothing is pushed");
    let none = &mut Progress::none();
    with.set_options(&Options { amount: 0.25, ..options.clone() }, none).unwrap();
    without.set_options(&Options { amount: 0.25, ..off.clone() }, none).unwrap();
    for (part, whole) in offsets(&with, &without).iter().zip(&whole) {
        assert!(part.distance(0.25 * *whole) < 2e-6, "{part} of {whole}");
    }
    // Another body, with the push as it was; and anew once the slider is let go.
    let moved = Options { profile: 0.5, ..options.clone() };
    with.set_options(&Options { repair: Repair::Kept, ..moved.clone() }, none).unwrap();
    let plain = of(&Options { repair: Repair::Off, ..moved.clone() });
    // But for corners of slivers, which are put right on one body and not on the other.
    let mut others = 0;
    for (part, whole) in offsets(&with, &plain).iter().zip(&whole) {
        let off = part.distance(*whole);
        assert!(off < 1e-4, "{part} instead of {whole}");
        others += usize::from(off >= 2e-6);
    }
    assert!(1000 * others < whole.len(), "{others} of {} vertices", whole.len());
    with.set_options(&moved, none).unwrap();
    assert_eq!(positions(&with), positions(&of(&moved)));
    // Kept where nothing was pushed yet.
    assert_eq!(positions(&of(&Options { repair: Repair::Kept, ..moved.clone() })), positions(&with));
}

#[test]
fn the_report_tells_what_winding_numbers_tell() {
    check_all(pairs(), |pair| {
        let on = &pair.runs[1];
        let report = on.deformer.report(&on.deformed).unwrap();
        let Some(repair) = report.repair else { return vec![format!("{}: no repair", pair.name)] };
        let moved = (common::positions(&on.deformed).iter().zip(common::positions(&pair.runs[0].deformed)))
            .filter(|(p, q)| p.distance(*q) > 1e-6 * on.height())
            .count();
        let mut wrong = Vec::new();
        // Hair that lies on clothes moves too, and a push may be less than is counted here. Out of the body a push goes .04 at most,
        // to which what is pushed beside it adds a little sideways.
        if (moved > 0) != (repair.pushed > 0) || repair.furthest > 0.042 {
            wrong.push(format!("{}: {moved} vertices move, {repair:?}", pair.name));
        }
        let [_, rest] = shares(pair, REST);
        // Far triangles are put together otherwise.
        if (repair.newly_inside.rest - rest).abs() > 0.001 {
            wrong.push(format!("{}: {rest} by winding numbers, {repair:?}", pair.name));
        }
        let is_told = report.warnings.iter().any(|warning| warning.code == "clothes_pierced");
        if is_told != (repair.newly_inside.sit.max(repair.newly_inside.walk) > 0.02) {
            wrong.push(format!("{}: told {is_told}, {repair:?}", pair.name));
        }
        println!("{}: {repair:?}", pair.name);
        wrong
    });
}

/// What a slider may set, at a place of 0 to 1.
const SLIDERS: [fn(&mut Options, f64); 9] = [
    |options, share| set_length(options, "upper_arm", 0.6 + 0.5 * share),
    |options, share| set_length(options, "lower_leg", 0.4 + 0.5 * share),
    |options, share| options.head_scale = 1.2 + 0.9 * share,
    |options, share| options.youth = share,
    |options, share| options.amount = 0.4 + 0.6 * share,
    |options, share| options.face_squash = Some(0.5 * share),
    |options, share| options.profile = share,
    |options, share| options.hair_lay = share,
    |options, share| options.height = Height::Units(1.0 + share),
];

fn set_length(options: &mut Options, group: &str, scale: f64) {
    options.groups.entry(group.to_string()).or_default().length_scale = Some(scale);
}

#[test]
fn options_changed_at_random_give_what_a_new_deformer_gives() {
    let Some(loaded) = model("seedsan_vrm1.vrm") else {
        return;
    };
    let style = Style::heads(2.5).unwrap();
    let character = std::sync::Arc::new(loaded.character.clone());
    let of = |options: &Options| superdeform::Deformer::new(character.clone(), &style, options).unwrap();
    // The order of sliders and their places follow from a number, the same on every run.
    let mut state = 7_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    };
    let mut options = Options::default();
    let mut changed = of(&options);
    for step in 0..24 {
        let slider = (next() * SLIDERS.len() as f64) as usize;
        SLIDERS[slider](&mut options, next());
        changed.set_options(&options, &mut Progress::none()).unwrap();
        // What is kept of morph targets is asked for in between, too.
        let applied = changed.apply();
        if step % 6 == 5 {
            let new = of(&options).apply();
            assert_eq!(applied.joints, new.joints, "step {step}: {options:?}");
            for (mesh, (one, other)) in applied.meshes.iter().zip(&new.meshes).enumerate() {
                assert!(
                    one.positions == other.positions,
                    "step {step}, positions of mesh {mesh}: {options:?}"
                );
                assert!(one.normals == other.normals, "step {step}, normals of mesh {mesh}: {options:?}");
                assert!(
                    one.morph_targets == other.morph_targets,
                    "step {step}, morph targets of mesh {mesh}: {options:?}"
                );
            }
        }
    }
}
