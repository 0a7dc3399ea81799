//! What the face step needs of a figure's head.

use super::anatomy::Anatomy;
use crate::character::{Character, MeshKind, Role};
use crate::face::head::{Head, HeadFrame, HeadParts};
use crate::face::outline::OutlineSources;
use crate::geometry::{SEAM, distinct, slots};
use crate::shape::field::Binding;
use crate::shape::figure::Figure;
use glam::{DVec2, DVec3};

/// The head of `character`, which is laid out as `figure`.
pub fn head<'a>(character: &'a Character, figure: &'a Figure, anatomy: &Anatomy) -> Head<'a> {
    let all = 0..figure.positions.len();
    let of_kind = |kind: MeshKind| figure.kinds.iter().map(|&own| own == kind).collect();
    let is_eye = |role: Role| matches!(role, Role::LeftEye | Role::RightEye);
    let turns: Vec<bool> = all.clone().map(|vertex| figure.weight_of(vertex, is_eye) > 0.5).collect();
    let parts = HeadParts {
        character,
        mesh_starts: &figure.mesh_starts,
        triangles: &figure.triangles,
        of_head: all.clone().map(|vertex| figure.weight_of(vertex, Role::is_head) > 0.5).collect(),
        is_hair: of_kind(MeshKind::Hair),
        is_accessory: of_kind(MeshKind::Accessory),
        is_eye: all.map(|vertex| turns[vertex] || figure.kind(vertex) == MeshKind::Eye).collect(),
        turns,
        eye_hints: character
            .face_hints
            .all()
            .map(|eye| (figure.frame.to_canonical(eye.middle), DVec2::new(eye.half_width, eye.half_height)))
            .collect(),
        eye_joints: figure.eye_roles().map(|role| figure.role_position(role)),
        seam: SEAM * figure.height(),
    };
    Head::new(parts, &figure.positions, head_frame(anatomy))
}

/// Where a figure's head is.
pub fn head_frame(anatomy: &Anatomy) -> HeadFrame {
    let heights = anatomy.landmarks.heights;
    HeadFrame {
        origin: DVec3::new(anatomy.middle_x, heights.chin, anatomy.head_joint.z),
        length: heights.head_length(),
    }
}

/// How far beside and below the head its outline is measured, in head lengths: more than the parts' maps make of a head's
/// width, and the chest of a child's body.
const OUTLINE_REACH: (f64, f64) = (0.66, 1.2);

/// What the outline of a figure's head is measured on: the head, and the middle of what is not an arm.
pub fn outline_sources(figure: &Figure, anatomy: &Anatomy, bindings: &[Binding]) -> OutlineSources {
    let frame = head_frame(anatomy);
    let share = |vertex: usize| bindings[vertex].of_head_and_neck();
    let is_near = |vertex: usize| {
        let p = frame.to_unit(figure.positions[vertex]);
        let arms = bindings[vertex].arms_weight();
        p.x.abs() < OUTLINE_REACH.0 && p.y > -OUTLINE_REACH.1 && arms < 0.5
    };
    let near: Vec<(bool, bool)> =
        (0..figure.positions.len()).map(|vertex| (is_near(vertex), share(vertex) > 0.5)).collect();
    let of = |of_head: bool, choose: &dyn Fn(MeshKind) -> bool| {
        figure.triangles_where(|vertex| near[vertex] == (true, of_head) && choose(figure.kind(vertex)))
    };
    let mut sources = OutlineSources {
        bare: of(true, &|kind| !kind.is_carried()),
        hair: of(true, &|kind| kind.is_carried() && kind != MeshKind::Accessory),
        trunk: of(false, &|kind| !kind.is_carried()),
        ..OutlineSources::default()
    };
    let OutlineSources { vertices, bare, hair, trunk } = &mut sources;
    *vertices = distinct(bare.iter().chain(&*hair).chain(&*trunk).flatten().copied());
    let slots = slots(figure.positions.len(), &*vertices);
    for corner in bare.iter_mut().chain(hair).chain(trunk).flatten() {
        *corner = slots[*corner as usize];
    }
    sources
}
