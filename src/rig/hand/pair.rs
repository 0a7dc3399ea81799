//! The fingers of both hands: where they mirror each other, what one shows is true of both.

use super::{Hand, find_fingers};
use crate::character::Role;
use crate::geometry::{PointTree, Surface, distinct};
use crate::rig::front_view::{FrontView, image};
use crate::rig::joints::FoundJoints;
use crate::rig::{FoundJoint, UnitFigure};
use glam::DVec3;

/// Vertices this close to each other's mirror image are. Seen: ±30 % changes no joint.
const SYMMETRIC_WITHIN: f64 = 2e-5;
/// Two hands are alike where every vertex nearer to a wrist than this has a mirror image. Seen: ±30 % changes no joint.
const HAND_REACH: f64 = 0.2;

/// A hand with at least this many fingers but no thumb is looked at again.
const FINGERS_BESIDE_THUMB: usize = 3;
/// A hand without a thumb is looked at again from these shares of the forearm before its wrist, which may lie beyond the
/// thumb's root: a wrist that is found is off by 0.01 H or so, and by more where a palm is as slim as a wrist.
const BEFORE_WRIST: [f64; 3] = [0.1, 0.2, 0.3];

/// Adds the fingers of both hands to the joints that were `found`, and the hands' tips.
pub fn add_fingers(figure: &UnitFigure, view: &FrontView, found: &mut FoundJoints) {
    let surface = Surface::new(view.positions, &view.triangles);
    let place = |role: Role, left: bool| found.joints[&role.on_side(left)].position;
    let mut hands = [true, false].map(|left| {
        let (elbow, wrist) = (place(Role::LeftLowerArm, left), place(Role::LeftHand, left));
        let look = |wrist| find_fingers(&surface, &figure.positions, &view.triangles, elbow, wrist, left);
        let has_thumb = |hand: &Hand| hand.joints.contains_key(&Role::LeftThumbProximal.on_side(left));
        let hand = look(wrist);
        if hand.finger_count < FINGERS_BESIDE_THUMB || has_thumb(&hand) {
            return hand;
        }
        let further = BEFORE_WRIST.into_iter().map(|share| look(wrist.lerp(elbow, share)));
        further.into_iter().find(has_thumb).unwrap_or(hand)
    });
    let wrists = [true, false].map(|left| place(Role::LeftHand, left));
    if let Some(middle) = mirror_of_hands(view, wrists) {
        // Two hands that are mirror images may still be cut into triangles differently: what one of them shows is true
        // of both.
        let seen = |hand: &Hand| hand.joints.values().map(|joint| joint.confidence).sum::<f64>();
        let better =
            usize::from((hands[1].finger_count, seen(&hands[1])) > (hands[0].finger_count, seen(&hands[0])));
        hands[1 - better] = hands[better].of_other_side(|p| image(p, middle));
    }
    for (left, hand) in [true, false].into_iter().zip(hands) {
        let wrist = Role::LeftHand.on_side(left);
        let doubt = found.joints[&wrist].confidence;
        for (role, joint) in hand.joints {
            let confidence = joint.confidence.min(doubt);
            found.joints.entry(role).or_insert(FoundJoint { confidence, ..joint });
        }
        if !hand.tips.is_empty() {
            found.tips.remove(&wrist);
        }
        found.tips.extend(hand.tips);
    }
}

/// The x of the plane in which the hands at both wrists mirror each other, vertex by vertex; `None` where they do not.
fn mirror_of_hands(view: &FrontView, wrists: [DVec3; 2]) -> Option<f64> {
    let middle = 0.5 * (wrists[0].x + wrists[1].x);
    if image(wrists[0], middle).distance(wrists[1]) > SYMMETRIC_WITHIN {
        return None;
    }
    let corners = distinct(view.triangles.iter().flatten().copied());
    let around = |wrist: DVec3| -> Vec<DVec3> {
        corners
            .iter()
            .map(|&vertex| view.positions[vertex as usize])
            .filter(|p| p.distance(wrist) < HAND_REACH)
            .collect()
    };
    let [left, right] = wrists.map(around);
    let mut near = Vec::new();
    let mut is_image_of = |one: &[DVec3], other: &[DVec3]| {
        let tree = PointTree::new(other);
        let has_image = |&p: &DVec3| {
            tree.nearest(image(p, middle), 1, SYMMETRIC_WITHIN, &mut near);
            // Points at the rim may have an image just beyond it.
            !near.is_empty()
                || p.distance(wrists[0]).min(p.distance(wrists[1])) > HAND_REACH - SYMMETRIC_WITHIN
        };
        !one.is_empty() && one.iter().all(has_image)
    };
    (is_image_of(&left, &right) && is_image_of(&right, &left)).then_some(middle)
}
