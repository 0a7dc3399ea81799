//! One slice of a body: its middle, half breadth and half depth, whatever is worn over it.

use super::radius_map::Ring;
use crate::geometry::slice::{Outline, RAYS};
use crate::geometry::{mean, median};
use glam::DVec2;

/// An outline that this share of the rays meet goes around: it is a layer of the body or of its clothes.
pub(super) const GOES_AROUND: f64 = 0.6;
/// A layer inside, whose reach is less than this share of the biggest one's, is hidden: the plug of a neck, the inner body of
/// a kit.
const HIDDEN: f64 = 0.5;
/// What is further out than this many times the innermost layer stands off the body.
const STANDS_OFF: f64 = 1.35;
/// An open outline that meets this share of the rays, and one of the rays to a side, counts where it lies on the body: half a
/// jacket does, a strap, a cape and an apron do not.
const LIES_ON: f64 = 0.3;
/// An extent is the median of the rays up to two beside it (20 degrees): a buckle or a bulge does not count. So many of
/// them have to meet something.
const BESIDE: usize = 2;
const FEWEST_HITS: usize = 3;
/// The rays to the sides.
const SIDES: [usize; 2] = [0, RAYS / 2];
/// Times that the middle is put between the extents.
const CENTRINGS: usize = 2;

/// A slice, in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// Its middle.
    pub middle: DVec2,
    /// Half the breadth and half the depth.
    pub half: DVec2,
}

/// The slice that `outlines` make around `start`; `None` where front, back, or both sides are open.
///
/// - `keeps_across`: the middle stays where it is across, as that of a torso between two sides.
pub fn slice_around<'a>(
    outlines: impl Iterator<Item = &'a Outline> + Clone,
    start: DVec2,
    keeps_across: bool,
) -> Option<Slice> {
    let extents = |middle: DVec2| extents(outlines.clone(), middle);
    let middle = centred(start, keeps_across, extents);
    let [out, front, inner, back] = extents(middle);
    let breadth = mean(hits([out, inner]))?;
    let depth = (front + back) / 2.0;
    (breadth > 0.0 && depth > 0.0).then_some(Slice { middle, half: DVec2::new(breadth, depth) })
}

/// `start`, put halfway between the `extents` from there, [`CENTRINGS`] times: those along the first coordinate, the second
/// one, and back. Where one is NaN, the side is open, and the middle stays where it is between the two.
///
/// - `keeps_across`: it stays where it is across.
pub(super) fn centred(start: DVec2, keeps_across: bool, extents: impl Fn(DVec2) -> [f64; 4]) -> DVec2 {
    let halfway = |one: f64, other: f64| {
        let shift = (one - other) / 2.0;
        if shift.is_nan() { 0.0 } else { shift }
    };
    (0..CENTRINGS).fold(start, |middle, _| {
        let [out, front, inner, back] = extents(middle);
        middle + DVec2::new(if keeps_across { 0.0 } else { halfway(out, inner) }, halfway(front, back))
    })
}

/// Those of `reaches` that meet something.
pub(super) fn hits(reaches: impl IntoIterator<Item = f64>) -> impl Iterator<Item = f64> {
    reaches.into_iter().filter(|reach| !reach.is_nan())
}

/// How far the body reaches from `middle` along the first coordinate, the second one, and back; NaN where it is open.
fn extents<'a>(outlines: impl Iterator<Item = &'a Outline>, middle: DVec2) -> [f64; 4] {
    let surface = surface(outlines, middle);
    [0, 1, 2, 3].map(|quarter| {
        let ray = quarter * RAYS / 4 + RAYS;
        let mut near: Vec<f64> = hits((ray - BESIDE..=ray + BESIDE).map(|ray| surface[ray % RAYS])).collect();
        if near.len() < FEWEST_HITS { f64::NAN } else { median(&mut near) }
    })
}

/// The surface of the body that `outlines` make, on each ray from `middle`; NaN where there is none.
pub fn surface<'a>(outlines: impl Iterator<Item = &'a Outline>, middle: DVec2) -> Ring {
    surface_within(outlines, middle, STANDS_OFF)
}

/// The same with layers that stand off the body: a skirt's relief is its own.
pub fn outer_surface<'a>(outlines: impl Iterator<Item = &'a Outline>, middle: DVec2) -> Ring {
    surface_within(outlines, middle, f64::INFINITY)
}

/// The surface without what is further out than so many times the innermost layer. Open outlines that go around together, as a
/// trunk's front and back between its arms, are the surface where no layer is; at a hem that hangs lower in front there is no skirt
/// behind, only legs.
fn surface_within<'a>(outlines: impl Iterator<Item = &'a Outline>, middle: DVec2, stands_off: f64) -> Ring {
    let reaches: Vec<Ring> = outlines.map(|outline| outline.reaches(middle)).collect();
    let share = |reaches: &Ring| hits(*reaches).count() as f64 / RAYS as f64;
    let (layers, mut open): (Vec<&Ring>, Vec<_>) =
        reaches.iter().partition(|reaches| share(reaches) >= GOES_AROUND);
    let mut layers: Vec<(f64, &Ring)> =
        layers.into_iter().map(|layer| (median(&mut hits(*layer).collect::<Vec<_>>()), layer)).collect();
    let biggest = layers.iter().map(|layer| layer.0).fold(0.0, f64::max);
    layers.retain(|layer| layer.0 >= HIDDEN * biggest);
    // NaN is neither greater nor less than any hit.
    let outermost = |hits: &mut dyn Iterator<Item = f64>| {
        let (nearest, furthest) =
            hits.fold((f64::NAN, f64::NAN), |(low, high), hit| (low.min(hit), high.max(hit)));
        furthest.min(stands_off * nearest)
    };
    if layers.is_empty() {
        let open: Ring = std::array::from_fn(|ray| outermost(&mut open.iter().map(|outline| outline[ray])));
        let around = share(&open) >= GOES_AROUND && SIDES.iter().all(|&side| !open[side + RAYS / 4].is_nan());
        return if around { open } else { [f64::NAN; RAYS] };
    }
    open.retain(|outline| share(outline) >= LIES_ON && SIDES.iter().any(|&side| !outline[side].is_nan()));
    std::array::from_fn(|ray| {
        // NaN where no layer is: no open outline lies on that.
        let reach = outermost(&mut layers.iter().map(|layer| layer.1[ray]));
        open.iter().map(|outline| outline[ray]).filter(|&hit| hit <= STANDS_OFF * reach).fold(reach, f64::max)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// The part from `from` to `to`, in degrees, of an ellipse.
    fn ellipse(middle: DVec2, half: DVec2, from: f64, to: f64) -> Outline {
        let point = |index: usize| {
            // The last point of a closed one is the first one, to the bit.
            let index = if to - from == 360.0 { index % 360 } else { index };
            let angle = (from + (to - from) * index as f64 / 360.0).to_radians();
            middle + half * DVec2::from_angle(angle)
        };
        Outline { segments: (0..360).map(|index| [point(index), point(index + 1)]).collect() }
    }

    fn around(outlines: &[Outline]) -> Option<Slice> {
        slice_around(outlines.iter(), DVec2::new(0.02, -0.03), false)
    }

    const BODY: DVec2 = DVec2::new(0.4, 0.3);

    /// The median of five rays over an ellipse: those 10 degrees beside the axis.
    fn beside(half: DVec2) -> DVec2 {
        let reach = |degrees: f64| {
            let ray = DVec2::from_angle(degrees * TAU / 360.0);
            1.0 / (ray / half).length()
        };
        DVec2::new(reach(10.0), reach(80.0))
    }

    #[test]
    fn an_ellipse_has_its_middle_and_its_half_axes() {
        let middle = DVec2::new(0.1, 0.05);
        let slice = around(&[ellipse(middle, BODY, 0.0, 360.0)]).unwrap();
        // Twice halfway between what is seen from beside the middle leaves a thirtieth of what the start was off.
        assert!(slice.middle.distance(middle) < middle.distance(DVec2::new(0.02, -0.03)) / 30.0, "{slice:?}");
        assert!((slice.half - beside(BODY)).abs().max_element() < 2e-3, "{slice:?}");
    }

    #[test]
    fn a_cape_and_a_plug_do_not_show() {
        let body = || ellipse(DVec2::ZERO, BODY, 0.0, 360.0);
        let cape = ellipse(DVec2::ZERO, 1.6 * BODY, 200.0, 340.0);
        let plug = ellipse(DVec2::ZERO, 0.3 * BODY, 0.0, 360.0);
        let bare = around(&[body()]).unwrap();
        assert_eq!(around(&[body(), cape, plug]).unwrap(), bare);
    }

    #[test]
    fn a_jacket_open_in_front_counts_and_a_wide_coat_by_as_much_as_lies_on() {
        let body = || ellipse(DVec2::ZERO, BODY, 0.0, 360.0);
        let jacket = ellipse(DVec2::ZERO, 1.2 * BODY, 110.0, 430.0);
        let slice = around(&[body(), jacket]).unwrap();
        assert!((slice.half.x / beside(1.2 * BODY).x - 1.0).abs() < 0.01, "{slice:?}");
        let coat = ellipse(DVec2::ZERO, 1.8 * BODY, 0.0, 360.0);
        let slice = around(&[body(), coat]).unwrap();
        assert!((slice.half.x / (1.35 * beside(BODY).x) - 1.0).abs() < 0.01, "{slice:?}");
    }

    #[test]
    fn front_and_back_between_the_arms_go_around_together_and_a_front_alone_does_not() {
        let part = |half: DVec2, from: f64, to: f64| ellipse(DVec2::ZERO, half, from, to);
        let trunk = [part(BODY, 30.0, 150.0), part(BODY, 210.0, 330.0)];
        let reaches = outer_surface(trunk.iter(), DVec2::ZERO);
        assert!((reaches[RAYS / 4] - BODY.y).abs() < 1e-3 && (reaches[3 * RAYS / 4] - BODY.y).abs() < 1e-3);
        assert!(reaches[0].is_nan() && reaches[RAYS / 2].is_nan());
        // Half of each leg, between which the front and the back of a skirt are open.
        let legs = [part(BODY, 110.0, 250.0), part(BODY, -70.0, 70.0)];
        for open in [&trunk[..1], &legs] {
            assert!(outer_surface(open.iter(), DVec2::ZERO).iter().all(|reach| reach.is_nan()));
        }
        // What is worn over it is what is seen from outside, and as far as it lies on for the body.
        let [trunk, coat] =
            [1.0, 2.0].map(|by| [part(by * BODY, 30.0, 150.0), part(by * BODY, 210.0, 330.0)]);
        let both = || trunk.iter().chain(&coat);
        assert!((outer_surface(both(), DVec2::ZERO)[RAYS / 4] - 2.0 * BODY.y).abs() < 1e-3);
        assert!((surface(both(), DVec2::ZERO)[RAYS / 4] - STANDS_OFF * BODY.y).abs() < 1e-3);
    }

    #[test]
    fn half_a_body_is_none() {
        assert_eq!(around(&[ellipse(DVec2::ZERO, BODY, 0.0, 180.0)]), None);
        assert_eq!(around(&[]), None);
    }
}
