//! The picture of a run: target, reference and result side by side, each with its heads.

use crate::picture::{self, Bone, Heads, PictureMesh, View};
use glam::{DVec3, Vec3};
use std::sync::LazyLock;
use superdeform::report::FigureReport;
use superdeform::{Character, Rig};
use superdeform_host::appearance::Appearance;
use superdeform_host::conversion::{Conversion, Converted, Reference};
use superdeform_host::load::Loaded;
use superdeform_host::materials::Material;

/// A joint that is less sure than this is in doubt, as for the report's warnings.
const SURE: f64 = 0.5;

/// Draws the picture, as PNG, the bones of a rig that was found over the target. The reference, which may be in another unit,
/// is drawn as tall as the result.
///
/// # Errors
/// One sentence where it cannot be encoded.
pub fn png(
    conversion: &Conversion,
    reference: Option<&Reference>,
    converted: &Converted,
) -> Result<Vec<u8>, String> {
    let (target, report) = (conversion.target(), &converted.report);
    let reference = reference.map(|reference| &reference.loaded);
    let of_target = conversion.appearance();
    let of_reference = reference.map(|reference| Appearance::of(reference, 0));
    let of_rig = conversion.rig().map(bones).unwrap_or_default();
    let mut views = vec![View { bones: of_rig, ..view("target", &report.target, target, of_target, None) }];
    if let (Some(reference), Some(appearance), Some(figure)) = (reference, &of_reference, &report.reference) {
        // The result comes after it.
        let as_tall_as = Some(views.len() + 1);
        views.push(View { as_tall_as, ..view("reference", figure, reference, appearance, None) });
    }
    views.push(view("result", &report.result, target, of_target, Some(converted)));
    picture::draw(&views).to_png()
}

/// Pixels along each side of a thumbnail.
const THUMBNAIL: u32 = 512;

/// Draws the result's head, as PNG.
///
/// # Errors
/// One sentence where it cannot be encoded.
pub fn thumbnail(conversion: &Conversion, converted: &Converted) -> Result<Vec<u8>, String> {
    let (target, figure) = (conversion.target(), &converted.report.result);
    let view = view("", figure, target, conversion.appearance(), Some(converted));
    picture::portrait(&view, figure.landmarks.chin as f32, THUMBNAIL).to_png()
}

/// A figure for the picture; where `converted` is given, with its shape and its materials in place of the file's.
fn view<'a>(
    title: &str,
    figure: &FigureReport,
    loaded: &'a Loaded,
    appearance: &'a Appearance,
    converted: Option<&'a Converted>,
) -> View<'a> {
    static PLAIN: LazyLock<Material> = LazyLock::new(Material::default);
    let character = &loaded.character;
    let meshes = character.meshes.iter().zip(&appearance.surfaces).enumerate();
    let materials = converted.map_or(&appearance.materials, |converted| &converted.materials);
    let heights = &figure.landmarks;
    let marks = figure.face.iter().flat_map(|face| face.points.values());
    let marks = if converted.is_none() {
        marks.map(|&p| DVec3::from_array(p).as_vec3()).collect()
    } else {
        Vec::new()
    };
    View {
        title: title.to_string(),
        note: format!("{:.1} heads", figure.heads),
        meshes: meshes
            .map(|(index, (mesh, surface))| {
                let shape = converted.map(|converted| &converted.deformed.meshes[index]);
                PictureMesh {
                    positions: shape.map_or(&mesh.positions, |shape| &shape.positions),
                    normals: shape.map_or(&mesh.normals, |shape| &shape.normals),
                    triangles: &mesh.triangles,
                    uvs: &surface.uvs,
                    colours: &surface.colours,
                    material: surface.material.and_then(|material| materials.get(material)).unwrap_or(&PLAIN),
                }
            })
            .collect(),
        up: character.axes.up,
        forward: facing(character),
        heads: Some(Heads {
            crown: heights.crown as f32,
            chin: heights.chin as f32,
            sole: heights.sole as f32,
        }),
        as_tall_as: None,
        marks,
        bones: Vec::new(),
    }
}

/// The bones of a rig, each joint without a parent by itself.
fn bones(rig: &Rig) -> Vec<Bone> {
    let joints = &rig.skeleton.joints;
    let bone = |(index, joint): (usize, &superdeform::Joint)| {
        let above = joint.parent.unwrap_or(index);
        let ends = [above, index].map(|joint| joints[joint].position().as_vec3());
        Bone { ends, doubted: rig.confidence[above].min(rig.confidence[index]) < SURE }
    };
    joints.iter().enumerate().map(bone).collect()
}

/// The way a character looks: as its axes say, else at right angles to up and to the line from its right limbs to
/// its left ones.
fn facing(character: &Character) -> Vec3 {
    if let Some(forward) = character.axes.forward {
        return forward;
    }
    let place = |joint: usize| character.skeleton.joints[joint].position();
    let leftward: DVec3 = character
        .humanoid
        .iter()
        .filter(|(role, _)| role.is_left())
        .filter_map(|(role, joint)| Some(place(joint) - place(character.humanoid.joint(role.mirrored())?)))
        .sum();
    leftward.as_vec3().cross(character.axes.up).normalize_or(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;
    use superdeform::{Joint, Role};

    #[test]
    fn a_character_looks_where_its_limbs_say() {
        let mut character = Character::default();
        for (index, (role, x)) in
            [(Role::LeftUpperArm, -1.0), (Role::RightUpperArm, 1.0)].into_iter().enumerate()
        {
            character.humanoid.set(role, index);
            character.skeleton.joints.push(Joint {
                name: role.to_string(),
                parent: None,
                rest: DMat4::from_translation(DVec3::new(x, 1.0, 0.0)),
            });
        }
        assert_eq!(facing(&character), -Vec3::Z);
        character.axes.forward = Some(Vec3::X);
        assert_eq!(facing(&character), Vec3::X);
        assert_eq!(facing(&Character::default()), Vec3::Z);
    }
}
