//! The body of paper mode: coefficients (Eqs. 9-11), skeleton (Eqs. 1-4), mesh (Eqs. 5-8).

use super::alpha_beta::coefficients;
use super::bone_field::{BoneBinding, BoneField, PaperField};
use super::shorten::shorten;
use crate::character::bones::Bone;
use crate::character::{Character, MeshKind, Role};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::{Weld, bounds, by_key, components};
use crate::options::Options;
use crate::shape::Measured;
use crate::shape::field::{Binding, BodyField, Field};
use crate::shape::figure::{Figure, share_of};
use crate::shape::measured::is_of_head;
use crate::shape::placement::{Bindings, Body, GroundContact, Placement, joint_bindings};
use crate::shape::style::Style;
use glam::DVec3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The paper's way to give `character` the style.
///
/// # Errors
/// `BadOption` for a style of N heads; as [`coefficients`].
pub fn body(character: &Character, measured: &Measured, style: &Style, options: &Options) -> Result<Body> {
    let Style::Shape(reference) = style else {
        let message = "the paper's mode needs a reference, and a style for N heads has none: give one, or choose product mode";
        return Err(Error::new(ErrorKind::BadOption, message).about("mode"));
    };
    let (groups, bone_groups) = (&options.groups, &options.bone_groups);
    let found = coefficients(&measured.shape, reference, options.head_scale, groups, bone_groups)?;
    let all: BTreeSet<Role> = measured.joints.keys().copied().collect();
    let bones: Vec<Bone> = measured.bones(&all, options);
    let (joints, head_top) = (&measured.joints, measured.head_top);
    let shortened = shorten(&bones, joints, head_top, &found.groups);
    let field = BoneField::new(&bones, joints, head_top, &shortened, &found.groups);
    let bindings = bindings(character, measured, &field);
    let field = Field::of(Arc::new(BodyField::Bones(PaperField { bones: field, stage: options.stage })));
    let figure = &measured.figure;
    let placement = Placement::new(figure, &bindings, &field, options.thread_count);
    let placed = placement.collect(figure.positions.len(), |vertex| placement.by_body(vertex));
    Ok(Body {
        bindings: Arc::new(bindings),
        field,
        placed: Arc::new(placed),
        head_ratio: found.head_ratio,
        heads: None,
        coefficients: found.groups,
        warnings: found.warnings,
        heads_left: None,
        attempts: Vec::new(),
    })
}

/// Everything by its weights, hats and glasses with the face as a whole; it stands on what is no hair.
fn bindings(character: &Character, measured: &Measured, field: &BoneField) -> Bindings {
    let figure = &measured.figure;
    let bind = |p: DVec3, weights: &[(Role, f64)]| BoneBinding {
        weights: field.bone_weights(p, weights),
        head: share_of(weights, Role::is_head),
        on_face: None,
    };
    let weights = figure.role_weights.iter();
    let mut vertices: Vec<BoneBinding> =
        figure.positions.iter().zip(weights).map(|(&p, weights)| bind(p, weights)).collect();
    for (members, centre) in head_accessories(figure, &measured.weld) {
        for vertex in members {
            vertices[vertex].on_face = Some(centre);
        }
    }
    let joints = joint_bindings(character, figure, |joint| {
        let role = figure.joint_roles[joint].unwrap_or(Role::Hips);
        Binding::Bones(bind(figure.joints[joint], &[(role, 1.0)]))
    });
    let ground = GroundContact::of(figure, |vertex| figure.kind(vertex) != MeshKind::Hair);
    Bindings::new(vertices.into_iter().map(Binding::Bones).collect(), joints, ground)
}

/// Hats and glasses: components of accessories that the head moves, with the middle of each.
fn head_accessories(figure: &Figure, weld: &Weld) -> Vec<(Vec<usize>, DVec3)> {
    let component = components(&figure.triangles, weld);
    let is_on_head =
        |&vertex: &usize| figure.kind(vertex) == MeshKind::Accessory && is_of_head(figure, vertex);
    let on_head = (0..figure.positions.len()).filter(is_on_head);
    let pieces = by_key(on_head.map(|vertex| (component[weld.representative[vertex] as usize], vertex)));
    let with_middle = |members: Vec<usize>| {
        let (low, high) = bounds(members.iter().map(|&vertex| figure.positions[vertex]));
        (members, (low + high) / 2.0)
    };
    pieces.into_values().map(with_middle).collect()
}
