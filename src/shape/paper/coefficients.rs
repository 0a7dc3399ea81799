//! alpha and beta of every bone group from two measured bodies (§V-B3, Eqs. 9-11), and the paper's constants.

use crate::character::Role;
use crate::character::bones::{Bone, Group, bones};
use crate::error::{Error, ErrorKind, Result, Warning};
use crate::options::GroupSettings;
use crate::shape::{BodyShape, Coefficient};
use std::collections::{BTreeMap, BTreeSet};

/// alpha_head. Paper, V-B1.
pub const HEAD_SCALE: f64 = 1.5;
/// eta of shoulder and hip, which are no cylinders: shortening them looks wrong. Paper, V-B3.
pub const SUPPRESSED_LENGTH_TRANSFER: f64 = 0.2;
/// phi of shoulder and hip. Paper, V-B3.
pub const SUPPRESSED_THICKNESS_TRANSFER: f64 = 0.0;
/// eta and phi of all other groups. Paper, V-B3.
pub const FULL_TRANSFER: f64 = 1.0;
/// alpha of hand, finger and foot, whatever the reference. Paper, V-B3 ("fingers and toes").
pub const FINGER_LENGTH_SCALE: f64 = 0.5;
/// beta of hand, finger and foot. Paper, V-B3.
pub const FINGER_THICKNESS_SCALE: f64 = 1.0;

/// What the paper does with a group unless the user says otherwise.
enum Rule {
    /// Eqs. 10 and 11 with these eta and phi.
    Transfer(f64, f64),
    /// These alpha and beta.
    Fixed(f64, f64),
}

fn rule(kind: Group, head_scale: f64) -> Rule {
    match kind {
        // Eq. 4; and with beta = alpha, Eqs. 5 and 8 together scale the head about its joint, so faces keep their shape.
        Group::Head => Rule::Fixed(head_scale, head_scale),
        Group::Shoulder | Group::Hip => {
            Rule::Transfer(SUPPRESSED_LENGTH_TRANSFER, SUPPRESSED_THICKNESS_TRANSFER)
        }
        Group::Hand | Group::Finger | Group::Foot => Rule::Fixed(FINGER_LENGTH_SCALE, FINGER_THICKNESS_SCALE),
        _ => Rule::Transfer(FULL_TRANSFER, FULL_TRANSFER),
    }
}

/// What §V-B3 gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coefficients {
    /// g of Eq. 9.
    pub head_ratio: f64,
    /// alpha_b and beta_b by group name, for every group of the target.
    pub groups: BTreeMap<String, Coefficient>,
    /// `group_missing`, `radius_missing`, `coefficient_limited`.
    pub warnings: Vec<Warning>,
}

/// alpha and beta of every bone group of the target.
///
/// Paper: §V-B3, Eqs. 9-11.
///
/// - `target`, `reference`: measured in any units, with any roles; a role that one of them lacks is skipped in both.
/// - `head_scale`: alpha_head, above 0; 1.5 in the paper.
/// - `settings`: by group name; alpha and beta as given, or another eta and phi. For the head, `thickness_transfer`
///   asks for Eq. 11 instead of beta = alpha.
/// - `bone_groups`: the user's own groups, as for [`bones`]; such a group has the constants of its first bone.
///
/// A group that the reference lacks takes the coefficients of the group whose bone stands for it there (neck: torso),
/// else it keeps its shape; one without radii keeps its girth. Both are warned of, and so is an alpha above 1, where the
/// paper expects shortening; nothing is limited here.
///
/// # Errors
/// `BadOption` for an unknown group, or a number that is not finite or out of range; `NoGeometry` for a head without length.
pub fn coefficients(
    target: &BodyShape,
    reference: &BodyShape,
    head_scale: f64,
    settings: &BTreeMap<String, GroupSettings>,
    bone_groups: &BTreeMap<Role, String>,
) -> Result<Coefficients> {
    let roles = target.roles();
    let target_bones = bones(&roles, bone_groups);
    check(head_scale, settings, &target_bones)?;
    for (what, shape) in [("target", target), ("reference", reference)] {
        if !(shape.head_length.is_finite() && shape.head_length > 0.0) {
            let message = format!(
                "the {what}'s head has length {}: its head top must lie above its head joint",
                shape.head_length
            );
            return Err(Error::new(ErrorKind::NoGeometry, message));
        }
    }

    let common: BTreeSet<Role> = roles.intersection(&reference.roles()).copied().collect();
    let (tar, refer) = (target.restricted_to(&common), reference.restricted_to(&common));
    let common_bones = bones(&common, bone_groups);

    // Eq. 9 prints l'_head / l_head; its text says target over reference. Only the text leaves the result unchanged
    // when one of the two files is in centimetres, so we follow the text.
    let head_ratio = head_scale * target.head_length / reference.head_length;

    let mut result = Coefficients { head_ratio, ..Coefficients::default() };
    for bone in &target_bones {
        if result.groups.contains_key(&bone.group) {
            continue;
        }
        let group = &bone.group;
        let given = settings.get(group).copied().unwrap_or_default();
        let own = rule(bone.kind, head_scale);
        let counted: Vec<&Bone> = common_bones.iter().filter(|other| other.group == *group).collect();

        let (own_alpha, own_beta, own_eta, own_phi) = match own {
            Rule::Fixed(alpha, beta) => (Some(alpha), Some(beta), 1.0, 1.0),
            Rule::Transfer(eta, phi) => (None, None, eta, phi),
        };
        let alpha = given.length_scale.or(own_alpha.filter(|_| given.length_transfer.is_none()));
        let beta = given.thickness_scale.or(own_beta.filter(|_| given.thickness_transfer.is_none()));

        let needs_reference = alpha.is_none() || beta.is_none();
        let stand_in =
            || stand_in(group, &target_bones, &common_bones).and_then(|name| result.groups.get(name));
        let (length_scale, thickness_scale) = if counted.is_empty() && needs_reference {
            let other = stand_in().copied();
            let (message, other) = match other {
                Some(other) => ("takes its coefficients from the bone that stands for it there", other),
                None => ("keeps its shape", Coefficient { length_scale: 1.0, thickness_scale: 1.0 }),
            };
            let message = format!("the reference has no bone of the group {group}, which {message}");
            result.warnings.push(Warning::new("group_missing", message));
            (alpha.unwrap_or(other.length_scale), beta.unwrap_or(other.thickness_scale))
        } else {
            let length_scale = alpha.unwrap_or_else(|| {
                let eta = given.length_transfer.unwrap_or(own_eta);
                match (total_length(&refer, &counted), total_length(&tar, &counted)) {
                    // Eq. 10 is per bone but alpha is per group: we use the group's total lengths.
                    (ref_length, tar_length) if tar_length > 0.0 => {
                        transfer(eta, head_ratio, ref_length / tar_length)
                    }
                    _ => 1.0,
                }
            });
            let thickness_scale = beta.unwrap_or_else(|| {
                let phi = given.thickness_transfer.unwrap_or(own_phi);
                match (mean_radius(&refer, &counted), mean_radius(&tar, &counted)) {
                    // Eq. 11, likewise.
                    (Some(ref_radius), Some(tar_radius)) => {
                        transfer(phi, head_ratio, ref_radius / tar_radius)
                    }
                    _ if phi == 0.0 => 1.0,
                    _ => {
                        let message =
                            format!("no ray measured the girth of the group {group}, which keeps its own");
                        result.warnings.push(Warning::new("radius_missing", message));
                        1.0
                    }
                }
            });
            (length_scale, thickness_scale)
        };
        if length_scale > 1.0 && bone.kind != Group::Head && given.length_scale.is_none() {
            let message = format!("the group {group} becomes longer: its length scale is {length_scale:.3}");
            result.warnings.push(Warning::new("coefficient_limited", message));
        }
        let coefficient = Coefficient { length_scale, thickness_scale };
        result.groups.insert(group.clone(), coefficient);
    }
    // Hands without fingers and feet without toes are no bones, but they have a girth.
    for role in roles {
        let group = Group::beginning_at(role);
        if let (Group::Hand | Group::Foot, Rule::Fixed(alpha, beta)) = (group, rule(group, head_scale))
            && !target_bones.iter().any(|bone| bone.kind == group)
        {
            let given = settings.get(group.name()).copied().unwrap_or_default();
            let coefficient = Coefficient {
                length_scale: given.length_scale.unwrap_or(alpha),
                thickness_scale: given.thickness_scale.unwrap_or(beta),
            };
            result.groups.insert(group.name().to_string(), coefficient);
        }
    }
    Ok(result)
}

/// Eqs. 10 and 11: `amount` is eta or phi, `ratio` the reference's measure over the target's.
pub fn transfer(amount: f64, head_ratio: f64, ratio: f64) -> f64 {
    1.0 + amount * (head_ratio * ratio - 1.0)
}

fn total_length(shape: &BodyShape, bones: &[&Bone]) -> f64 {
    let shapes = bones.iter().filter_map(|bone| shape.bones.get(bone.key()));
    shapes.map(|bone| bone.length).sum()
}

fn mean_radius(shape: &BodyShape, bones: &[&Bone]) -> Option<f64> {
    let shapes = bones.iter().filter_map(|bone| shape.bones.get(bone.key()));
    let radii: Vec<f64> = shapes.filter_map(|bone| bone.radius).filter(|&radius| radius > 0.0).collect();
    (!radii.is_empty()).then(|| radii.iter().sum::<f64>() / radii.len() as f64)
}

/// The group of the bone between common roles that stands for the target's bones of `group`.
fn stand_in<'a>(group: &str, target_bones: &[Bone], common_bones: &'a [Bone]) -> Option<&'a str> {
    let mut ends = target_bones.iter().filter(|bone| bone.group == group).filter_map(|bone| bone.child);
    ends.find_map(|end| {
        common_bones.iter().find(|bone| {
            bone.child.is_some_and(|child| {
                child.chain().take_while(|&role| role != bone.parent).any(|role| role == end)
            })
        })
    })
    .map(|bone| bone.group.as_str())
}

fn check(head_scale: f64, settings: &BTreeMap<String, GroupSettings>, bones: &[Bone]) -> Result<()> {
    let bad = |message: String| Err(Error::new(ErrorKind::BadOption, message));
    if !(head_scale.is_finite() && head_scale > 0.0) {
        return bad(format!("head_scale is {head_scale}: it must be above 0; 1.5 is usual"));
    }
    let names: BTreeSet<&str> =
        bones.iter().map(|bone| bone.group.as_str()).chain(Group::ALL.map(Group::name)).collect();
    for (group, given) in settings {
        if !names.contains(group.as_str()) {
            let known = names.into_iter().collect::<Vec<_>>().join(", ");
            return bad(format!("there is no bone group {group}: give one of {known}"));
        }
        for (what, scale) in
            [("length_scale", given.length_scale), ("thickness_scale", given.thickness_scale)]
        {
            if let Some(scale) = scale.filter(|scale| !(scale.is_finite() && *scale > 0.0)) {
                return bad(format!(
                    "{what} of the group {group} is {scale}: it must be above 0; 1 keeps the shape"
                ));
            }
        }
        for (what, amount) in
            [("length_transfer", given.length_transfer), ("thickness_transfer", given.thickness_transfer)]
        {
            if let Some(amount) = amount.filter(|amount| !(0.0..=1.0).contains(amount)) {
                return bad(format!("{what} of the group {group} is {amount}: it must be from 0 to 1"));
            }
        }
    }
    Ok(())
}
