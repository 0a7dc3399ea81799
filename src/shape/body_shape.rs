//! A body's shape: two numbers for every bone, L and R of §V-A. All that is needed of a reference.

use super::heights::Heights;
use crate::character::Role;
use crate::character::bones::HEAD_TOP;
use crate::face::face_landmarks::FaceLandmarks;
use crate::shape::product::anatomy::Proportions;
use crate::shape::product::profile::Profile;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// The version that this library writes.
pub const VERSION: u32 = 2;

/// l_i and r_i of a bone, model units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoneShape {
    /// l_i: the distance between the bone's joints.
    pub length: f64,
    /// r_i: the surrounding-mesh radius; `None` where too few rays met a surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
}

/// A body's shape, in the units of its model; saved as JSON it is a style.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyShape {
    /// The version of the format.
    #[serde(rename = "superdeform_style")]
    pub version: u32,
    /// Where it is from.
    #[serde(default)]
    pub name: String,
    /// l_head of Eq. 4.
    pub head_length: f64,
    /// By the role at the bone's end (`leftLowerArm`), or `headTop` for the head bone. The roles found are these
    /// and the hips.
    pub bones: BTreeMap<String, BoneShape>,
    /// Heights of landmarks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub landmarks: Option<Heights>,
    /// Lengths and widths of the parts, which product mode transfers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub proportions: Option<Proportions>,
    /// How broad and deep the body is, slice by slice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<Profile>,
    /// The eyes, where they were found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub face: Option<FaceStyle>,
}

/// What a face takes after a reference's, in head lengths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FaceStyle {
    /// ye: the eyes' height above the chin.
    pub eye_height: f64,
    /// e: the geometric mean of an opening's half width and half height.
    pub eye_size: f64,
}

impl FaceStyle {
    /// Of a face whose eyes were found.
    pub fn of(face: &FaceLandmarks) -> Option<Self> {
        face.pair().map(|pair| Self { eye_height: pair.height, eye_size: pair.size() })
    }

    /// This face (0) to `other` (1).
    pub fn blended(self, other: Self, amount: f64) -> Self {
        let mix = |a: f64, b: f64| a + amount * (b - a);
        Self {
            eye_height: mix(self.eye_height, other.eye_height),
            eye_size: mix(self.eye_size, other.eye_size),
        }
    }
}

/// What `mix` makes of both; where there is only one, that.
pub(crate) fn either<T: Clone>(one: &Option<T>, other: &Option<T>, mix: impl Fn(&T, &T) -> T) -> Option<T> {
    match (one, other) {
        (Some(one), Some(other)) => Some(mix(one, other)),
        (one, other) => one.clone().or(other.clone()),
    }
}

impl Default for BodyShape {
    fn default() -> Self {
        Self {
            version: VERSION,
            name: String::new(),
            head_length: 0.0,
            bones: BTreeMap::new(),
            landmarks: None,
            proportions: None,
            face: None,
            profile: None,
        }
    }
}

impl BodyShape {
    /// The roles that the body was measured with: the hips and the end of each bone. Keys that name no role are
    /// passed over.
    pub fn roles(&self) -> BTreeSet<Role> {
        let ends = Role::all().filter(|role| self.bones.contains_key(role.name()));
        std::iter::once(Role::Hips).chain(ends).collect()
    }

    /// The same body measured with fewer roles: where a role is skipped, the lengths of the bones that it joined are
    /// added, and their radii averaged by length.
    ///
    /// Roles that the body lacks are passed over; hips and head top stay. So a saved style and its model give the same
    /// result with any target.
    pub fn restricted_to(&self, roles: &BTreeSet<Role>) -> BodyShape {
        let found = self.roles();
        let stays = |role: &Role| *role == Role::Hips || (found.contains(role) && roles.contains(role));
        let mut bones: BTreeMap<String, BoneShape> = found
            .iter()
            .filter(|&role| *role != Role::Hips && stays(role))
            .map(|&end| {
                let above = end.chain().skip(1).find(stays).unwrap_or(Role::Hips);
                let joined: Vec<BoneShape> = end
                    .chain()
                    .take_while(|&role| role != above)
                    .filter_map(|role| self.bones.get(role.name()).copied())
                    .collect();
                (end.name().to_string(), join(&joined))
            })
            .collect();
        if let Some(&head) = self.bones.get(HEAD_TOP) {
            bones.insert(HEAD_TOP.to_string(), head);
        }
        BodyShape { bones, ..self.clone() }
    }
}

fn join(bones: &[BoneShape]) -> BoneShape {
    if let [bone] = bones {
        return *bone;
    }
    let measured = || bones.iter().filter_map(|bone| bone.radius.map(|radius| (bone.length, radius)));
    let length: f64 = measured().map(|(length, _)| length).sum();
    let sum: f64 = measured().map(|(length, radius)| length * radius).sum();
    BoneShape {
        length: bones.iter().map(|bone| bone.length).sum(),
        radius: (length > 0.0).then(|| sum / length),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leg() -> BodyShape {
        let bone = |length, radius| BoneShape { length, radius };
        BodyShape {
            name: "leg".to_string(),
            head_length: 0.5,
            bones: BTreeMap::from([
                ("leftUpperLeg".to_string(), bone(0.1, None)),
                ("leftLowerLeg".to_string(), bone(0.4, Some(0.1))),
                ("leftFoot".to_string(), bone(0.2, Some(0.04))),
                ("leftToes".to_string(), bone(0.1, None)),
                (HEAD_TOP.to_string(), bone(0.5, Some(0.3))),
            ]),
            ..BodyShape::default()
        }
    }

    #[test]
    fn skipping_a_role_adds_the_lengths_and_averages_the_radii() {
        let roles = BTreeSet::from([Role::LeftUpperLeg, Role::LeftFoot, Role::Neck]);
        let leg = leg().restricted_to(&roles);
        let names: Vec<&str> = leg.bones.keys().map(String::as_str).collect();
        assert_eq!(names, ["headTop", "leftFoot", "leftUpperLeg"]);
        assert!((leg.bones["leftFoot"].length - 0.6).abs() < 1e-15);
        assert!((leg.bones["leftFoot"].radius.unwrap() - 0.08).abs() < 1e-15);
        assert_eq!(leg.bones["leftUpperLeg"].radius, None);
    }

    #[test]
    fn a_restriction_to_its_own_roles_changes_nothing() {
        assert_eq!(leg().restricted_to(&leg().roles()), leg());
    }

    #[test]
    fn a_saved_style_reads_back_the_same() {
        let text = serde_json::to_string_pretty(&leg()).unwrap();
        assert!(text.contains("\"superdeform_style\": 2"), "{text}");
        assert_eq!(serde_json::from_str::<BodyShape>(&text).unwrap(), leg());
    }
}
