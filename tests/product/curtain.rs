//! `curtain.rs`: hair before the eyes parts, on hair that hangs as a cylinder about the head's axis.

use glam::DVec3;
use superdeform::internals::face::head::HeadFrame;
use superdeform::internals::shape::product::curtain::{Curtain, Openings, sides};
use superdeform::internals::shape::product::long_hair::Axis;

/// A head .2 high whose chin is at a height of 1.5, about an axis that is not the figure's middle.
const FRAME: HeadFrame = HeadFrame { origin: DVec3::new(0.1, 1.5, 0.0), length: 0.2 };
const AXIS: Axis = Axis { frame: FRAME, middle: [0.1, -0.03] };
/// In head lengths.
const RADIUS: f64 = 0.6;
const EYES: Openings = Openings { height: 0.4, half_distance: 0.2, half_width: 0.08, half_height: 0.05 };
/// What the eyes need: .2 + 1.15 * .08 + .02 aside.
const ASIDE: f64 = 0.312;

/// The point of the cylinder at an angle from the front and a height in head lengths.
fn at(turn: f64, height: f64) -> DVec3 {
    let (sin, cos) = turn.sin_cos();
    let radius = RADIUS * FRAME.length;
    DVec3::new(AXIS.middle[0] + radius * sin, 1.5 + height * FRAME.length, AXIS.middle[1] + radius * cos)
}

fn curtain() -> Curtain {
    let points: Vec<DVec3> = (-40..=40)
        .flat_map(|row| {
            (0..96).map(move |column| at(f64::from(column) * 0.0654498, 0.01 * f64::from(row) + 0.4))
        })
        .collect();
    Curtain::new(&points, AXIS, EYES)
}

#[test]
fn what_hung_in_the_middle_ends_beside_the_eyes() {
    let to = curtain().place(at(0.0, EYES.height), 1.0, 1.0);
    assert!((to.x - AXIS.middle[0] - ASIDE * FRAME.length).abs() < 1e-6, "{to}");
    // Still on the cylinder, at its height.
    let round = (RADIUS * RADIUS - ASIDE * ASIDE).sqrt() * FRAME.length;
    assert!((to.z - AXIS.middle[1] - round).abs() < 1e-6, "{to}");
    assert_eq!(to.y, at(0.0, EYES.height).y);
}

#[test]
fn it_opens_by_the_amount_and_closes_below_the_chin() {
    let opens = (ASIDE / RADIUS).asin();
    // A chin's depth below the chin it opens by .65 of that.
    for (height, amount, share) in
        [(0.4, 1.0, 1.0), (0.4, 0.5, 0.5), (0.4, 0.0, 0.0), (0.0, 1.0, 1.0), (-0.35, 1.0, 0.65)]
    {
        let to = curtain().place(at(0.0, height), 1.0, amount);
        let expected = at(share * opens, height);
        assert!(to.distance(expected) < 1e-6, "height {height}, amount {amount}: {to} instead of {expected}");
    }
}

#[test]
fn the_parting_and_the_back_of_the_head_stay() {
    for (turn, height) in [(0.0, 0.9), (0.3, 1.1), (2.1, 0.4), (3.1, 0.0)] {
        let p = at(turn, height);
        assert!(curtain().place(p, 1.0, 1.0).distance(p) < 1e-9, "{turn}, {height}");
    }
    // Just before where it stays it hardly moves, and no strand overtakes another.
    let turns: Vec<f64> = (0..200).map(|step| 0.01 * f64::from(step)).collect();
    let angle = |turn: f64| {
        let to = curtain().place(at(turn, 0.4), 1.0, 1.0);
        (to.x - AXIS.middle[0]).atan2(to.z - AXIS.middle[1])
    };
    let after: Vec<f64> = turns.iter().map(|&turn| angle(turn)).collect();
    assert!(after.windows(2).all(|pair| pair[0] < pair[1]), "{after:?}");
    assert!((after[199] - turns[199]).abs() < 0.02);
}

#[test]
fn left_and_right_part_alike() {
    let curtain = curtain();
    for (turn, height) in [(0.0, 0.4), (0.4, 0.2), (-0.2, 0.7), (1.5, -0.2)] {
        let left = curtain.place(at(turn, height), 1.0, 0.8);
        let right = curtain.place(at(-turn, height), -1.0, 0.8);
        let mirrored = left.with_x(2.0 * AXIS.middle[0] - left.x);
        assert!(mirrored.distance(right) < 1e-6, "{turn}, {height}: {mirrored}, {right}");
    }
}

#[test]
fn a_strand_goes_to_the_side_that_most_of_it_is_on() {
    let strand = |xs: &[f64]| -> Vec<DVec3> { xs.iter().map(|&x| DVec3::new(x, -0.1, 0.3)).collect() };
    let (left, right) = (strand(&[0.1, 0.2, 0.3]), strand(&[-0.1, -0.2, -0.3, -0.2, 0.1]));
    assert_eq!(sides(&[left.clone(), right.clone()], 0.31), Some(vec![1.0, -1.0]));
    // Eyes that are seen, hair that ends above the chin, and a wig in one piece need or bear no parting.
    assert_eq!(sides(&[left.clone(), right.clone()], 0.3), None);
    let short: Vec<DVec3> = left.iter().map(|p| p.with_y(0.1)).collect();
    assert_eq!(sides(&[short], 0.9), None);
    let wig = strand(&[-0.2, -0.1, 0.1, 0.2]);
    assert_eq!(sides(&[left.clone(), wig.clone()], 0.9), None);
    // Behind the face one piece may hang on both sides.
    let tail: Vec<DVec3> = wig.iter().map(|p| p.with_z(-0.3)).collect();
    assert_eq!(sides(&[left, tail], 0.9).map(|sides| sides[0]), Some(1.0));
}
