//! Lids close and eyes stay behind them as they did before the face was made younger.

#[path = "common/lids.rs"]
mod lids;
#[path = "common/models.rs"]
mod models;

use lids::{View, closed, eyes, turned, with_blink};
use models::{check_all, models as all_models, present};
use std::sync::Arc;
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::figure::Figure;
use superdeform::{Character, Deformed, Deformer, Options, Style};
use superdeform_host::shades::painted;

/// Heads whose eyes are pieces behind lids. They come without a blink: one is made for them.
const ADULTS: [&str; 4] = [
    "valid_aian_m_1_milit.glb",
    "valid_asian_f_1_busi.glb",
    "valid_black_m_2_busi.glb",
    "valid_hispanic_f_2_casual.glb",
];

/// What is seen of an eye that is half closed may differ by this part of what is seen of it open.
const HALF_SHUT: f64 = 0.03;
/// Of one that looks aside by a twentieth: lids that open more than the ball grows stand a little more obliquely.
const ASIDE: f64 = 0.05;
/// Own blinks travel as far as the eye is high, within this part of it.
const TRAVEL: f64 = 0.05;
/// Of an eye that is shut nothing is seen.
const SHUT: f64 = 0.005;
/// What is seen in front of a lid may be more than before by this part of what is seen of the open eye: it is a square of
/// the view wide at most.
const IN_FRONT: f64 = 0.02;

fn deformed(character: &Character, style: &Style) -> Deformed {
    Deformer::new(Arc::new(character.clone()), style, &Options::default()).unwrap().apply()
}

fn styles() -> Vec<(&'static str, Style)> {
    let mut styles = vec![("2.5 heads", Style::Heads(2.5))];
    if models::model("kaykit_rogue.glb").is_some() {
        styles.push(("KayKit", models::style_of("kaykit_rogue.glb", &Options::default())));
    }
    styles
}

#[test]
fn made_blinks_close_as_far_as_before() {
    let names = present(&ADULTS);
    if names.is_empty() {
        println!("skipped: none of {ADULTS:?} is there");
        return;
    }
    let styles = styles();
    check_all(&names, |&name| {
        let plain = painted(&all_models()[name]);
        let measured = Measured::of(&plain, &Options::default()).unwrap();
        let character = with_blink(&plain, &measured);
        let (before, of_eyes) = (&measured.figure, eyes(&measured));
        let mut wrong = Vec::new();
        if of_eyes.len() != 2 {
            wrong.push(format!("{name}: {} eyes", of_eyes.len()));
        }
        for (style_name, style) in &styles {
            let result = character.with(&deformed(&character, style));
            let after = Figure::of(&result).unwrap();
            for (index, eye) in of_eyes.iter().enumerate() {
                let own = &eye.ball.as_ref().unwrap().vertices;
                let views = [before, &after].map(|figure| View::new(figure, &figure.positions, own));
                let rest = [views[0].seen(&before.positions), views[1].seen(&after.positions)];
                for weight in [0.5, 0.8, 1.0] {
                    let seen = [
                        views[0].seen(&closed(before, &character, weight)),
                        views[1].seen(&closed(&after, &result, weight)),
                    ];
                    let share = [0, 1].map(|of| seen[of].count() as f64 / rest[of].count() as f64);
                    let outside = [0, 1].map(|of| seen[of].outside(&rest[of]));
                    let allowed = if weight == 1.0 { SHUT } else { HALF_SHUT };
                    let in_front = outside[0] as f64 + IN_FRONT * rest[1].count() as f64;
                    if (share[1] - share[0]).abs() > allowed || outside[1] as f64 > in_front {
                        wrong.push(format!(
                            "{name} like {style_name}, eye {index} at {weight}: {share:.3?} of it seen, {outside:?} squares outside"
                        ));
                    }
                }
            }
        }
        wrong
    });
}

#[test]
fn eyes_that_look_aside_stay_in_their_sockets() {
    let names = present(&ADULTS);
    if names.is_empty() {
        println!("skipped: none of {ADULTS:?} is there");
        return;
    }
    let styles = styles();
    check_all(&names, |&name| {
        let character = &painted(&all_models()[name]);
        let measured = Measured::of(character, &Options::default()).unwrap();
        let (before, of_eyes) = (&*measured.figure, eyes(&measured));
        let mut wrong = Vec::new();
        for (style_name, style) in &styles {
            let after = Figure::of(&character.with(&deformed(character, style))).unwrap();
            for (index, eye) in of_eyes.iter().enumerate() {
                let own = &eye.ball.as_ref().unwrap().vertices;
                let views = [before, &after].map(|figure| View::new(figure, &figure.positions, own));
                let rest = [views[0].seen(&before.positions), views[1].seen(&after.positions)];
                for (yaw, pitch) in [(20.0, 0.0), (-20.0, 0.0), (0.0, 15.0), (0.0, -15.0)] {
                    let seen = [(0, before), (1, &after)].map(|(of, figure)| {
                        let (yaw, pitch) = (f64::to_radians(yaw), f64::to_radians(pitch));
                        views[of].seen(&turned(figure, &figure.positions, &of_eyes, yaw, pitch))
                    });
                    let share = [0, 1].map(|of| seen[of].count() as f64 / rest[of].count() as f64);
                    let outside = [0, 1].map(|of| seen[of].outside(&rest[of]));
                    println!(
                        "{name} like {style_name}, eye {index} at {yaw} {pitch}: {share:.3?} {outside:?}"
                    );
                    let in_front = outside[0] as f64 + IN_FRONT * rest[1].count() as f64;
                    if (share[1] - share[0]).abs() > ASIDE || outside[1] as f64 > in_front {
                        wrong.push(format!(
                            "{name} like {style_name}, eye {index} turned by {yaw} and {pitch}: {share:.3?} of it seen, {outside:?} squares outside"
                        ));
                    }
                }
            }
        }
        wrong
    });
}

/// Blinks that models bring along, of faces that are young already.
const BLINKING: [&str; 3] = ["catbot.vrm", "cool_loops.vrm", "godette.vrm"];

#[test]
fn own_blinks_travel_as_far_as_the_eye_is_high() {
    let names = present(&BLINKING);
    if names.is_empty() {
        println!("skipped: none of {BLINKING:?} is there");
        return;
    }
    let styles = styles();
    check_all(&names, |&name| {
        let character = &all_models()[name].character;
        let before = Figure::of(character).unwrap();
        let travel = |figure: &Figure, character: &Character| {
            let shut = closed(figure, character, 1.0);
            let moved = (0..shut.len()).filter(|&vertex| shut[vertex] != figure.positions[vertex]);
            let moved: Vec<usize> = moved.collect();
            let extent = |points: &[glam::DVec3]| {
                let heights = moved.iter().map(|&vertex| points[vertex].y);
                let (low, high) =
                    heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
                high - low
            };
            (moved.len(), extent(&shut) / extent(&figure.positions))
        };
        let (count, was) = travel(&before, character);
        let mut wrong = Vec::new();
        if count == 0 {
            wrong.push(format!("{name}: no blink moves anything"));
        }
        for (style_name, style) in &styles {
            let result = character.with(&deformed(character, style));
            let (_, is) = travel(&Figure::of(&result).unwrap(), &result);
            if (is - was).abs() > TRAVEL {
                wrong.push(format!(
                    "{name} like {style_name}: shut to {was:.3} of its height, then to {is:.3}"
                ));
            }
        }
        wrong
    });
}
