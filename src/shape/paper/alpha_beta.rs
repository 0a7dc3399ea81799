//! alpha and beta of every bone group from two measured bodies (§V-B3, Eqs. 9-11), and the paper's constants.

use crate::character::Role;
use crate::character::bones::{Bone, Group, bones};
use crate::error::{Error, ErrorKind, Result, Warning};
use crate::geometry::mean;
use crate::options::GroupSettings;
use crate::options::table::option;
use crate::shape::{BodyShape, Coefficient};
use std::collections::{BTreeMap, BTreeSet};

/// eta of shoulder and hip, which are no cylinders: shortening them looks wrong. Paper, V-B3.
pub const SUPPRESSED_LENGTH_TRANSFER: f64 = 0.2;
/// phi of shoulder and hip. Paper, V-B3.
pub const SUPPRESSED_THICKNESS_TRANSFER: f64 = 0.0;
/// eta and phi of all other groups. Paper, V-B3.
pub const FULL_TRANSFER: f64 = 1.0;
/// alpha of hand, finger and foot, whatever the reference. Paper, V-B3 ("fingers and toes"); D16.
pub const FINGER_LENGTH_SCALE: f64 = 0.5;
/// beta of hand, finger and foot. Paper, V-B3; D16.
pub const FINGER_THICKNESS_SCALE: f64 = 1.0;

/// What the paper does with a group unless the user says otherwise: the alpha and beta of some, and eta and phi of Eqs. 10
/// and 11.
fn rule(kind: Group, head_scale: f64) -> (Option<Coefficient>, f64, f64) {
    let fixed = |length_scale: f64, thickness_scale: f64| {
        (Some(Coefficient { length_scale, thickness_scale }), FULL_TRANSFER, FULL_TRANSFER)
    };
    match kind {
        // Eq. 4; and with beta = alpha, Eqs. 5 and 8 together scale the head about its joint, so faces keep their shape.
        Group::Head => fixed(head_scale, head_scale),
        Group::Shoulder | Group::Hip => (None, SUPPRESSED_LENGTH_TRANSFER, SUPPRESSED_THICKNESS_TRANSFER),
        Group::Hand | Group::Finger | Group::Foot => fixed(FINGER_LENGTH_SCALE, FINGER_THICKNESS_SCALE),
        _ => (None, FULL_TRANSFER, FULL_TRANSFER),
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
/// else it keeps its shape; one without radii keeps its girth. A warning tells of both, and of an alpha above 1, where the
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
    let bodies = Bodies {
        target: target.restricted_to(&common),
        reference: reference.restricted_to(&common),
        bones: bones(&common, bone_groups),
        // Eq. 9 prints l'_head / l_head; its text says target over reference. Only the text leaves the result unchanged
        // when one of the two files is in centimetres, so we follow the text.
        head_ratio: head_scale * target.head_length / reference.head_length,
    };
    let mut result = Coefficients { head_ratio: bodies.head_ratio, ..Coefficients::default() };
    for bone in &target_bones {
        if result.groups.contains_key(&bone.group) {
            continue;
        }
        let given = settings.get(&bone.group).copied().unwrap_or_default();
        let stand_in = stand_in(&bone.group, &target_bones, &bodies.bones)
            .and_then(|name| result.groups.get(name))
            .copied();
        let coefficient = bodies.of_group(bone, head_scale, &given, stand_in, &mut result.warnings);
        if coefficient.length_scale > 1.0 && bone.kind != Group::Head && given.length_scale.is_none() {
            let message = format!(
                "the group {} becomes longer: its length scale is {:.3}",
                bone.group, coefficient.length_scale
            );
            result.warnings.push(Warning::new("coefficient_limited", message));
        }
        result.groups.insert(bone.group.clone(), coefficient);
    }
    // Hands without fingers and feet without toes are no bones, but they have a thickness.
    for role in roles {
        let group = Group::beginning_at(role);
        if let (Group::Hand | Group::Foot, (Some(own), ..)) = (group, rule(group, head_scale))
            && !target_bones.iter().any(|bone| bone.kind == group)
        {
            let given = settings.get(group.name()).copied().unwrap_or_default();
            let coefficient = Coefficient {
                length_scale: given.length_scale.unwrap_or(own.length_scale),
                thickness_scale: given.thickness_scale.unwrap_or(own.thickness_scale),
            };
            result.groups.insert(group.name().to_string(), coefficient);
        }
    }
    Ok(result)
}

/// Both bodies, measured over the roles that they share.
struct Bodies {
    target: BodyShape,
    reference: BodyShape,
    bones: Vec<Bone>,
    /// g of Eq. 9.
    head_ratio: f64,
}

impl Bodies {
    /// alpha and beta of the group of `bone`: as `given`, else by the [`rule`] for it; those of `stand_in` where the reference
    /// has no bone of the group.
    fn of_group(
        &self,
        Bone { group, kind, .. }: &Bone,
        head_scale: f64,
        given: &GroupSettings,
        stand_in: Option<Coefficient>,
        warnings: &mut Vec<Warning>,
    ) -> Coefficient {
        let (own, own_eta, own_phi) = rule(*kind, head_scale);
        let own_alpha = own.filter(|_| given.length_transfer.is_none()).map(|own| own.length_scale);
        let own_beta = own.filter(|_| given.thickness_transfer.is_none()).map(|own| own.thickness_scale);
        let (alpha, beta) = (given.length_scale.or(own_alpha), given.thickness_scale.or(own_beta));
        let counted: Vec<&Bone> = self.bones.iter().filter(|other| other.group == *group).collect();
        if counted.is_empty() && (alpha.is_none() || beta.is_none()) {
            let (message, other) = match stand_in {
                Some(other) => ("takes its coefficients from the bone that stands for it there", other),
                None => ("keeps its shape", Coefficient { length_scale: 1.0, thickness_scale: 1.0 }),
            };
            let message = format!("the reference has no bone of the group {group}, which {message}");
            warnings.push(Warning::new("group_missing", message));
            return Coefficient {
                length_scale: alpha.unwrap_or(other.length_scale),
                thickness_scale: beta.unwrap_or(other.thickness_scale),
            };
        }
        let eta = given.length_transfer.unwrap_or(own_eta);
        let phi = given.thickness_transfer.unwrap_or(own_phi);
        let length_scale = alpha.unwrap_or_else(|| self.length_scale(&counted, eta));
        let thickness_scale = beta.unwrap_or_else(|| {
            self.thickness_scale(&counted, phi).unwrap_or_else(|| {
                if phi != 0.0 {
                    let message =
                        format!("no ray measured the thickness of the group {group}, which keeps its own");
                    warnings.push(Warning::new("radius_missing", message));
                }
                1.0
            })
        });
        Coefficient { length_scale, thickness_scale }
    }

    /// Eq. 10 is per bone but alpha is per group: we use the group's total lengths.
    fn length_scale(&self, bones: &[&Bone], eta: f64) -> f64 {
        let (target, reference) = (total_length(&self.target, bones), total_length(&self.reference, bones));
        if target > 0.0 { transfer(eta, self.head_ratio, reference / target) } else { 1.0 }
    }

    /// Eq. 11, likewise; `None` where one of the bodies has no radius.
    fn thickness_scale(&self, bones: &[&Bone], phi: f64) -> Option<f64> {
        let (target, reference) = (mean_radius(&self.target, bones)?, mean_radius(&self.reference, bones)?);
        Some(transfer(phi, self.head_ratio, reference / target))
    }
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
    mean(shapes.filter_map(|bone| bone.radius).filter(|&radius| radius > 0.0))
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
    option("head_scale").check(head_scale)?;
    let names: BTreeSet<&str> =
        bones.iter().map(|bone| bone.group.as_str()).chain(Group::ALL.map(Group::name)).collect();
    for (group, given) in settings {
        if !names.contains(group.as_str()) {
            let known = names.into_iter().collect::<Vec<_>>().join(", ");
            let message = format!("there is no bone group {group}: give one of {known}");
            return Err(Error::new(ErrorKind::BadOption, message).about("groups"));
        }
        given.check(group)?;
    }
    Ok(())
}
