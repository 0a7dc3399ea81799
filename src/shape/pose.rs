//! Simple poses of a figure, to see what they do to its clothes.

use super::figure::Figure;
use crate::character::Role;
use crate::geometry::Mapped;
use glam::{DMat3, DVec3};

/// A pose: degrees by which roles turn forward and up about the side axis, with all that hangs from them.
pub type Pose = &'static [(Role, f64)];

/// The widest stride of a walk. Perry and Burnfield. Gait Analysis. 2nd edition, 2010.
pub const WALK: Pose = &[
    (Role::LeftUpperLeg, 20.0),
    (Role::LeftLowerLeg, -5.0),
    (Role::RightUpperLeg, -20.0),
    (Role::RightLowerLeg, -5.0),
];
/// On a chair.
pub const SIT: Pose = &[
    (Role::LeftUpperLeg, 90.0),
    (Role::LeftLowerLeg, -90.0),
    (Role::RightUpperLeg, 90.0),
    (Role::RightLowerLeg, -90.0),
];

/// Where all vertices of `figure` are in `pose`, canonical frame: linear blend skinning by roles, so that what has no role
/// of its own goes with the role that it hangs from.
pub fn posed(figure: &Figure, pose: Pose) -> Vec<DVec3> {
    let of_role = |role: Role| -> Mapped {
        // From the hips down to the role: what is above turns last.
        role.chain().fold(Mapped::unmoved(DVec3::ZERO), |below, role| {
            let degrees = pose.iter().find(|(posed, _)| *posed == role).map(|(_, degrees)| *degrees);
            let (Some(degrees), Some(at)) = (degrees, figure.role_position(role)) else { return below };
            // x is the figure's left: a right-handed turn takes what hangs down backward.
            let turn = DMat3::from_rotation_x(-degrees.to_radians());
            Mapped { position: turn * (below.position - at) + at, jacobian: turn * below.jacobian }
        })
    };
    let moves: Vec<Mapped> = Role::all().map(of_role).collect();
    let place = |vertex: usize| {
        let rows = &figure.role_weights[vertex];
        let p = figure.positions[vertex];
        let moved = |by: &Mapped| by.jacobian * p + by.position;
        rows.iter().map(|&(role, weight)| weight * moved(&moves[role as usize])).sum()
    };
    (0..figure.positions.len()).map(place).collect()
}
