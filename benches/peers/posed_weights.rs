//! What `posed_weights.py` compares: rigged models whose weights are taken away, and the weights that they get on their
//! artists' joints. `posed_weights FOLDER [--solid CELLS] [NAME...]` writes a file for each model into FOLDER.
//!
//! Everything is in the space in which a figure is 1 high, stands at 0 and looks along +z. With `--solid` a model is one
//! skin around all that it shows, of so many cells a height, without names; the artist's weights are those of the
//! nearest place of the model.

#[path = "../../tests/common/solid.rs"]
mod solid;

use glam::DVec3;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use superdeform::internals::character::Frame;
use superdeform::internals::geometry::Surface;
use superdeform::internals::rig::UnitFigure;
use superdeform::internals::rig::placed::Placed;
use superdeform::internals::rig::weight_bones::{skeleton_of, weight_bones};
use superdeform::{Character, Humanoid, Mesh, Progress, Rig, RigOptions, Role, Skeleton, Weights};
use superdeform_benches::models;
use superdeform_host::file::GltfFile;
use superdeform_host::load::LoadOptions;
use superdeform_host::samples;

/// Weights that a file of an engine holds of a vertex.
const INFLUENCES: usize = 4;

/// By role: the rows of a mesh, every joint without a role being one with the nearest above it that has one.
fn folded(weights: &Weights, skeleton: &Skeleton, humanoid: &Humanoid, roles: &[Role]) -> Vec<Value> {
    let role_of = |joint: usize| humanoid.iter().find(|&(_, at)| at == joint).map(|(role, _)| role);
    let place = |role: Role| roles.iter().position(|&other| other == role);
    let above = |joint: usize| {
        std::iter::once(joint).chain(skeleton.ancestors(joint)).filter_map(role_of).find_map(place)
    };
    let root = place(Role::Hips).expect("there are hips");
    let column: Vec<usize> = (0..skeleton.joints.len()).map(|joint| above(joint).unwrap_or(root)).collect();
    let row = |row: &[(u32, f32)]| {
        let mut sums = BTreeMap::<usize, f64>::new();
        row.iter().for_each(|&(joint, weight)| {
            *sums.entry(column[joint as usize]).or_default() += f64::from(weight)
        });
        json!(sums.into_iter().collect::<Vec<_>>())
    };
    weights.rows().map(row).collect()
}

/// The weights of the nearest place of a surface.
fn nearest(figure: &UnitFigure, all: &[&[(u32, f32)]], points: &[DVec3]) -> Weights {
    let surface = Surface::for_many(&figure.positions, &figure.triangles);
    Weights::from_rows(points.iter().map(|&p| {
        let near = surface.closest_point(p).expect("there is a surface");
        let mut row = BTreeMap::<u32, f32>::new();
        for (vertex, share) in figure.triangles[near.triangle].into_iter().zip(near.barycentric) {
            for &(joint, weight) in all[vertex as usize] {
                *row.entry(joint).or_default() += weight * share as f32;
            }
        }
        row
    }))
}

/// A model as JSON; `None` where it has no rig.
fn case(path: &Path, cells: Option<usize>, options: &RigOptions) -> Option<Value> {
    let rigged = models::load(path);
    if !rigged.rigged {
        return None;
    }
    let rigged = rigged.character;
    let bare = LoadOptions { without_rig: true, ..LoadOptions::default() };
    let mut character = superdeform_host::load::load(GltfFile::read(path).ok()?, &bare).ok()?.character;
    // As it stands with its rig: some files are posed.
    for (mesh, rigged) in character.meshes.iter_mut().zip(&rigged.meshes) {
        mesh.positions.clone_from(&rigged.positions);
    }
    character.axes = rigged.axes;
    let figure = UnitFigure::of(&rigged, Frame::of(&rigged).ok()?.to_model(DVec3::Z)).ok()?;
    let mut artist: Vec<Weights> = rigged.meshes.iter().map(|mesh| mesh.weights.clone()).collect();
    if let Some(cells) = cells {
        let solid = solid::Solid::of_triangles(&figure.positions, &figure.triangles, 1.0 / cells as f64);
        let (positions, triangles) = solid::surface(&solid);
        let all: Vec<&[(u32, f32)]> = artist.iter().flat_map(|weights| weights.rows()).collect();
        artist = vec![nearest(&figure, &all, &positions)];
        let positions = positions.iter().map(|p| p.as_vec3()).collect();
        let mesh = Mesh { positions, triangles, ..Mesh::default() };
        character = Character { meshes: vec![mesh], ..Character::default() };
    }
    let joint = |at: usize| rigged.skeleton.joints[at].position();
    let unit: BTreeMap<Role, DVec3> =
        rigged.humanoid.iter().map(|(role, at)| (role, figure.to_unit(joint(at)))).collect();
    let own = if cells.is_some() {
        unit.clone()
    } else {
        rigged.humanoid.iter().map(|(role, at)| (role, joint(at))).collect()
    };
    let options = RigOptions { given: own, ..options.clone() };
    let none = &mut Progress::none();
    let rig = Rig::of(&character, &options)
        .map_err(|error| eprintln!("{}: {}", path.display(), error.message))
        .ok()?;
    let placed = Placed::of(&character, &options, none).ok()?;
    let to_unit = |p: DVec3| if cells.is_some() { p } else { figure.to_unit(p) };
    let of_placed = |p: DVec3| to_unit(placed.figure.to_model(p)).to_array();
    let roles: Vec<Role> = unit.keys().copied().collect();
    let (_, humanoid) = skeleton_of(&unit);
    let parents: Vec<Option<usize>> = roles
        .iter()
        .map(|&role| {
            humanoid.parent_of(role).and_then(|above| roles.iter().position(|&other| other == above))
        })
        .collect();
    let at: BTreeMap<Role, DVec3> =
        placed.found.joints.iter().map(|(&role, joint)| (role, joint.position)).collect();
    let names: Vec<Role> = at.keys().copied().collect();
    let bones =
        weight_bones(&at, &placed.found.tips, Some(placed.found.chin)).into_iter().filter_map(|bone| {
            let role = roles.iter().position(|&role| role == names[bone.joint as usize])?;
            let segments: Vec<_> = bone.segments.iter().map(|ends| ends.map(of_placed)).collect();
            Some(json!([role, segments]))
        });
    let meshes = character.meshes.iter().enumerate().map(|(index, mesh)| {
        let positions: Vec<[f64; 3]> = mesh.positions.iter().map(|p| to_unit(p.as_dvec3()).to_array()).collect();
        json!({
            "name": mesh.name,
            "kind": format!("{:?}", rig.kinds[index]),
            "positions": positions,
            "triangles": mesh.triangles,
            "artist": folded(&artist[index], &rigged.skeleton, &rigged.humanoid, &roles),
            "ours": folded(&rig.skin_weights[index].limited(INFLUENCES), &rig.skeleton, &rig.humanoid, &roles),
        })
    });
    Some(json!({
        "name": path.file_name()?.to_string_lossy(),
        "method": format!("{:?}", rig.method),
        "warnings": rig.warnings.iter().map(|warning| warning.message.clone()).collect::<Vec<_>>(),
        "timing": rig.timing_ms,
        "roles": roles.iter().map(|role| role.name()).collect::<Vec<_>>(),
        "parents": parents,
        "joints": unit.values().map(|p| p.to_array()).collect::<Vec<_>>(),
        "bones": bones.collect::<Vec<_>>(),
        "meshes": meshes.collect::<Vec<_>>(),
    }))
}

fn main() {
    let mut words = std::env::args().skip(1);
    let folder = words.next().expect("a folder to write into");
    let mut cells = None;
    let mut names = Vec::new();
    let mut options = RigOptions::default();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--solid" => cells = words.next().and_then(|word| word.parse().ok()),
            "--volume" => options.method = superdeform::WeightMethod::Volume,
            "--heat" => options.method = superdeform::WeightMethod::Heat,
            _ => names.push(word),
        }
    }
    let mut paths: Vec<_> = std::fs::read_dir(samples::folder())
        .expect("there is a folder of models")
        .map(|entry| entry.expect("the folder can be read").path())
        .filter(|path| path.extension().is_some_and(|end| end == "glb" || end == "vrm"))
        .filter(|path| names.is_empty() || names.iter().any(|name| path.to_string_lossy().contains(name)))
        .collect();
    paths.sort();
    for path in paths {
        let Some(case) = case(&path, cells, &options) else { continue };
        let out = Path::new(&folder).join(path.file_name().expect("a file")).with_extension("json");
        std::fs::write(&out, case.to_string()).expect("the folder can be written to");
    }
}
