//! Hands: fingers that close, and one map of all that a hand moves, by which a short thick one becomes a mitt.

use super::chains::Chain;
use super::curve::monotone_cubic;
use super::cuts::{BEYOND, Body, mean_numbers, quantile};
use super::slice_scales::lies_flat;
use crate::character::Role;
use crate::geometry::slice::Planes;
use crate::geometry::{Moved, outer, smoothstep_slope};
use crate::shape::product::part::digits;
use glam::{DMat3, DQuat, DVec2, DVec3};

/// A mitt's fingers become this much thicker, less 1, so that they touch; not the thumb, which is a spike on a low-poly hand then.
/// Seen: of 154 results 538 triangles turn at .5, where light falls between the fingers, 700 at it, 932 at .9.
const THICKER: f64 = 0.7;
/// A hand takes over from the arm within this part of its length, before the wrist. Seen: beyond it a thumb that begins at the wrist
/// keeps a spike; by weights alone an arm takes the hand's thickness from two thirds of its length on.
pub(super) const FADE: f64 = 0.25;
/// How round a mitt becomes. Seen: at 2 finger joints without a role lie 1.1 % H beside their skin, where 1 % is allowed.
const ROUND: f64 = 1.0;

/// A hand ends at this quantile of its vertices' reach, and is as broad as those between the other two within this part of its
/// length.
const HAND_END: f64 = 0.99;
const HAND_SIDES: (f64, f64) = (0.02, 0.98);
const HAND_PALM: (f64, f64) = (0.15, 0.75);
/// The line through its middle is read at so many places beyond the wrist.
const LINE_STEPS: usize = 6;
/// And so many times, each time of what the last one left. Seen: once leaves a flat hand .6 of its bend, three times a tenth to a third,
/// eight times no less.
const LINE_ROUNDS: usize = 3;
/// How many sizes are read of a hand.
const HAND_SIZES: usize = 5;

/// Length, half breadth and half thickness of hands as they are, and of more and more of a mitt: how large closing and rounding
/// leave them, which are scaled after it.
pub type HandSizes = [[f64; 3]; HAND_SIZES];

/// How much of a mitt each of [`HandSizes`] is.
fn shares() -> [f64; HAND_SIZES] {
    std::array::from_fn(|at| at as f64 / (HAND_SIZES - 1) as f64)
}

/// That of [`HandSizes`] at so much of a mitt.
pub fn size_at(sizes: &HandSizes, share: f64) -> [f64; 3] {
    std::array::from_fn(|axis| monotone_cubic(&shares(), &sizes.map(|size| size[axis]), share))
}

/// What makes a finger a part of a mitt: it lies beside the others, short and thick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DigitMap {
    /// Where it leaves the hand, and the unit vector from there to its last joint.
    root: DVec3,
    axis: DVec3,
    /// It goes over to its own way within this length.
    fade: f64,
    /// What that makes of a way from the root, less that way.
    turn: DMat3,
}

impl DigitMap {
    /// That of finger number `digit`, thumb first, between two joints, so much of the way to a mitt: a thumb turns into the plane of
    /// the palm, the others go on as it leads and become thicker.
    ///
    /// - `palm`: the unit vectors along it and away from it.
    pub(super) fn closed(digit: usize, [root, end]: [DVec3; 2], palm: [DVec3; 2], share: f64) -> Self {
        let (axis, length) = (end - root).normalize_and_length();
        let (to, thicker) = match digit {
            0 => (axis - share * axis.project_onto_normalized(palm[1]), 1.0),
            _ => (axis.lerp(palm[0], share), 1.0 + THICKER * share),
        };
        let turned = DMat3::from_quat(DQuat::from_rotation_arc(axis, to.normalize_or(axis)));
        let thick = DMat3::IDENTITY * thicker - outer(axis, axis) * (thicker - 1.0);
        Self { root, axis, fade: 2.0 * FADE * length, turn: turned * thick - DMat3::IDENTITY }
    }

    /// How far `p` goes, and the derivative.
    pub(super) fn way(&self, p: DVec3) -> (DVec3, DMat3) {
        let from_root = p - self.root;
        let (share, slope) = smoothstep_slope(from_root.dot(self.axis) / self.fade);
        let way = self.turn * from_root;
        (share * way, self.turn * share + outer(way * (slope / self.fade), self.axis))
    }
}

/// What a hand whose fingers are closed is like in the planes of its arm, from the wrist (0) on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandBox {
    /// Those planes.
    pub planes: Planes,
    /// How far its middle is off that at the wrist, across and front, for each of how far along it is and the square of that.
    pub line: [DVec2; 2],
    /// The middle of what it fills where it is straight: along, across, front.
    pub middle: DVec3,
    /// Half extents along the same, above 0.
    pub half: DVec3,
}

impl HandBox {
    /// How far the middle at `along` is off that at the wrist, and the slope there.
    fn beside(line: [DVec2; 2], along: f64) -> [DVec3; 2] {
        let s = along.max(0.0);
        let across = |place: DVec2| DVec3::new(0.0, place.x, place.y);
        let slope = if along > 0.0 { line[0] + 2.0 * s * line[1] } else { DVec2::ZERO };
        [across(s * line[0] + s * s * line[1]), across(slope)]
    }
}

/// What becomes of a hand: scaled along the axes of its arm about the wrist; and a mitt is straight, and nearly an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HandMap {
    pub hand: HandBox,
    /// Along, across, front.
    pub scale: DVec3,
    /// How much of a mitt it becomes.
    pub share: f64,
    /// The wrist of the result.
    pub to: DVec3,
}

impl HandMap {
    /// How long the hand is as it is.
    pub fn length(&self) -> f64 {
        2.0 * self.hand.half.x
    }

    /// With n the place in half extents from the middle: n sqrt((1 + k) / (1 + k n^2)). What is far in or far out comes nearer to
    /// the ellipsoid that fills the box; along each ray places keep their order, so nothing folds.
    pub fn map<M: Moved>(&self, p: DVec3) -> M {
        let HandBox { planes, line, middle, half } = self.hand;
        let axes = DMat3::from_cols(planes.axis, planes.across, planes.front);
        let place = axes.transpose() * (p - planes.origin);
        let [beside, slope] = HandBox::beside(line, place.x);
        let off = place - self.share * beside - middle;
        let (n, round) = (off / half, self.share * ROUND);
        let fall = 1.0 + round * n.length_squared();
        let grown = ((1.0 + round) / fall).sqrt();
        M::of(self.to + axes * (self.scale * (middle + grown * off)), || {
            let straighter = DMat3::IDENTITY - outer(self.share * slope, DVec3::X);
            let rounder = DMat3::IDENTITY * grown - outer(off, n / half) * (grown * round / fall);
            axes * DMat3::from_diagonal(self.scale) * rounder * straighter * axes.transpose()
        })
    }
}

impl Body<'_> {
    /// What hands are like whose fingers are closed, and their [`HandSizes`], in head lengths.
    ///
    /// - `places`: one vertex at each place.
    pub(super) fn hands(&self, places: &[u32]) -> ([Option<HandBox>; 2], Option<HandSizes>) {
        let mut boxes = [None, None];
        let mut sides: Vec<HandSizes> = Vec::new();
        for (side, filled) in boxes.iter_mut().enumerate() {
            let Some(planes) = self.frame.arm_planes(side) else { continue };
            let arm = Planes { origin: self.frame.limbs[side].end, ..planes };
            *filled = self.hand_box(side, places, &arm);
            let Some(hand) = *filled else { continue };
            let size = |share: f64| {
                let mitt = HandMap { hand, scale: DVec3::ONE, share, to: arm.origin };
                let closed = self.vertices_of_hand(side, places).map(self.closing(side, share));
                let round: Vec<DVec3> = closed.map(|p| mitt.map(p)).collect();
                Some(self.hand(&round, &arm)?.0)
            };
            let sizes: Vec<[f64; 3]> = shares().into_iter().filter_map(size).collect();
            sides.extend(HandSizes::try_from(sizes));
        }
        let mean = |at: usize| {
            let sizes: Vec<[f64; 3]> = sides.iter().map(|sizes| sizes[at]).collect();
            mean_numbers(&sizes, self.length).unwrap_or_default()
        };
        (boxes, (!sides.is_empty()).then(|| std::array::from_fn(mean)))
    }

    /// Those of `places` that a hand moves.
    fn vertices_of_hand(&self, side: usize, places: &[u32]) -> impl Iterator<Item = usize> {
        let vertices = places.iter().map(|&vertex| vertex as usize);
        vertices.filter(move |&vertex| self.chains.hold(vertex, Chain::Hand(side)))
    }

    /// Where a vertex of a hand is whose fingers are closed so far.
    fn closing(&self, side: usize, share: f64) -> impl Fn(usize) -> DVec3 {
        let (maps, roles) = (self.frame.closed_digits(side, share), digits(side == 0));
        move |vertex| {
            let p = self.positions[vertex];
            let way = |(map, roles): (&Option<DigitMap>, &[Role; 3])| {
                Some(self.figure.weight_of(vertex, |role| roles.contains(&role)) * map.as_ref()?.way(p).0)
            };
            p + maps.iter().zip(&roles).filter_map(way).sum::<DVec3>()
        }
    }

    /// What the hand at the end of `arm` is like, but for its thumb.
    fn hand_box(&self, side: usize, places: &[u32], arm: &Planes) -> Option<HandBox> {
        let [thumb, ..] = digits(side == 0);
        let is_thumb = |vertex: usize| self.figure.weight_of(vertex, |role| thumb.contains(&role)) > 0.5;
        let close = self.closing(side, 1.0);
        let mut fingers: Vec<DVec3> =
            self.vertices_of_hand(side, places).filter(|&vertex| !is_thumb(vertex)).map(&close).collect();
        let ([length, front, across], _) = self.hand(&fingers, arm)?;
        // What lies flat bends up or down; to its sides what is cut off with the thumb would tell.
        let lies = lies_flat(front, across);
        let flat = DVec2::new(lies, -lies).max(DVec2::ZERO);
        let mut line = [DVec2::ZERO; 2];
        for _ in 0..LINE_ROUNDS {
            let more = middle_line(&fingers, arm, length).map(|of| flat * of);
            for p in &mut fingers {
                let [beside, _] = HandBox::beside(more, arm.height(*p));
                *p -= beside.y * arm.across + beside.z * arm.front;
            }
            line = [line[0] + more[0], line[1] + more[1]];
        }
        let ([length, front, across], middle) = self.hand(&fingers, arm)?;
        let half = DVec3::new(length / 2.0, across, front);
        let middle = DVec3::new(length / 2.0, middle.x, middle.y);
        (half.min_element() > 0.0).then_some(HandBox { planes: *arm, line, middle, half })
    }

    /// Length, half breadth and half thickness of what the places of a hand fill, and the middle of the last two.
    fn hand(&self, places: &[DVec3], planes: &Planes) -> Option<([f64; 3], DVec2)> {
        let points: Vec<(f64, DVec2)> =
            places.iter().map(|&p| planes.locate(p)).filter(|point| point.0 > BEYOND * self.length).collect();
        let length = quantile(points.iter().map(|point| point.0), HAND_END)?;
        let palm = || points.iter().filter(|point| (HAND_PALM.0..=HAND_PALM.1).contains(&(point.0 / length)));
        let end = |share: f64| {
            let along = |axis: fn(DVec2) -> f64| quantile(palm().map(|point| axis(point.1)), share);
            Some(DVec2::new(along(|p| p.x)?, along(|p| p.y)?))
        };
        let (low, high) = (end(HAND_SIDES.0)?, end(HAND_SIDES.1)?);
        let half = (high - low) / 2.0;
        Some(([length, half.y, half.x], (low + high) / 2.0))
    }
}

/// The line through the middles of what lies by so many places of a hand so long, as [`HandBox::line`], by least squares: halfway
/// between its outermost vertices, as there are few on one side or the other.
fn middle_line(places: &[DVec3], planes: &Planes, length: f64) -> [DVec2; 2] {
    let point = |&p: &DVec3| {
        let (height, place) = planes.locate(p);
        DVec3::new(height / length, place.x, place.y)
    };
    let points: Vec<DVec3> = places.iter().map(point).collect();
    let mut normal = DMat3::ZERO;
    let mut right = [DVec3::ZERO; 2];
    for at in 0..=LINE_STEPS {
        let is_near = |point: &&DVec3| (point.x * LINE_STEPS as f64 - at as f64).abs() <= 1.0 + BEYOND;
        let mut near = points.iter().filter(is_near);
        let Some(&first) = near.next() else { continue };
        let [low, high] = near.fold([first; 2], |[low, high], &p| [low.min(p), high.max(p)]);
        let middle = (low + high) / 2.0;
        let powers = DVec3::new(1.0, middle.x, middle.x * middle.x);
        normal += outer(powers, powers);
        right = [right[0] + middle.y * powers, right[1] + middle.z * powers];
    }
    let [across, front] =
        right.map(|right| normal.inverse() * right / DVec3::new(1.0, length, length * length));
    let line = [DVec2::new(across.y, front.y), DVec2::new(across.z, front.z)];
    if line.iter().all(|of| of.is_finite()) { line } else { [DVec2::ZERO; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Mapped;

    /// That of a hand along x whose middle sags by .1 at half of its length and by .4 at its end.
    fn mitt(share: f64) -> HandMap {
        let planes = Planes { origin: DVec3::ZERO, axis: DVec3::X, across: DVec3::Y, front: DVec3::Z };
        let line = [DVec2::ZERO, DVec2::new(-0.1, 0.0)];
        let hand =
            HandBox { planes, line, middle: DVec3::new(1.0, 0.0, 0.1), half: DVec3::new(1.0, 0.2, 0.5) };
        HandMap { hand, scale: DVec3::new(0.5, 2.0, 1.0), share, to: DVec3::new(3.0, 1.0, 0.0) }
    }

    #[test]
    fn a_mitt_is_straight_and_what_fills_its_box_stays_on_the_ellipsoid() {
        let map = mitt(1.0);
        // In half extents from the middle; 2 of them come to 2 sqrt(2 / 5), half of one to half of sqrt(2 / 1.25).
        for (n, wanted) in [(1.0, 1.0), (2.0, 2.0 * 0.4f64.sqrt()), (0.5, 0.5 * 1.6f64.sqrt())] {
            let direction = DVec3::new(0.6, -0.64, 0.48);
            let off = map.hand.half * direction;
            let straight = map.hand.middle + n * off;
            let bent = straight - 0.1 * straight.x * straight.x * DVec3::Y;
            let to: DVec3 = map.map(bent);
            let expected = map.to + map.scale * (map.hand.middle + wanted * off);
            assert!(to.distance(expected) < 1e-12, "{n}: {to} instead of {expected}");
        }
    }

    #[test]
    fn a_hand_that_is_no_mitt_is_scaled_about_its_wrist() {
        let map = mitt(0.0);
        let to: DVec3 = map.map(DVec3::new(1.5, -0.3, 0.7));
        assert!(to.distance(DVec3::new(3.75, 0.4, 0.7)) < 1e-12, "{to}");
    }

    #[test]
    fn jacobians_are_those_of_the_places_and_nothing_folds() {
        let finger = DigitMap::closed(1, [DVec3::X, DVec3::new(1.8, -0.2, 0.3)], [DVec3::X, DVec3::Y], 0.7);
        let map = mitt(0.7);
        for p in [DVec3::new(0.3, 0.1, 0.2), DVec3::new(1.4, -0.5, 0.9), DVec3::new(2.4, 0.3, -0.8)] {
            let whole = |p: DVec3| map.map::<DVec3>(p + finger.way(p).0);
            let at: Mapped = map.map(p + finger.way(p).0);
            let found = at.jacobian * (DMat3::IDENTITY + finger.way(p).1);
            let h = 1e-6;
            let wanted = DMat3::from_cols_array_2d(
                &[DVec3::X, DVec3::Y, DVec3::Z]
                    .map(|axis| ((whole(p + h * axis) - whole(p - h * axis)) / (2.0 * h)).to_array()),
            );
            assert!((found - wanted).to_cols_array().iter().all(|d| d.abs() < 1e-7), "{found} {wanted}");
            assert!(found.determinant() > 0.0, "{p}");
        }
    }
}
