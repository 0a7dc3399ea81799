//! Hair, hats, skirts and capes that are one skin with the body move with what carries them.

#[path = "made/container.rs"]
mod container;
#[path = "common/figures.rs"]
mod figures;
#[path = "common/models.rs"]
mod models;
#[path = "common/solid.rs"]
mod solid;
#[path = "common/truth.rs"]
mod truth;

use container::container;
use figures::{Figure, Pose, Thing};
use glam::DVec3;
use std::path::Path;
use superdeform::internals::rig::UnitFigure;
use superdeform::internals::rig::parts::hangs_from_head;
use superdeform::internals::rig::placed::Placed;
use superdeform::internals::rig::weight_bones::{skeleton_of, weight_bones};
use superdeform::{Character, MeshKind, Progress, Rig, RigOptions, Role};

use Role::*;

/// A rigged skin, and which of its vertices are what is looked at.
struct Worn {
    character: Character,
    rig: Rig,
    is_thing: Vec<bool>,
}

impl Worn {
    /// A figure of one skin with one thing: a vertex is the thing's where it lies nearer to its surface than to the body's.
    fn of(seed: u64, pose: Pose, thing: Thing, cells: usize) -> Self {
        let bare = Figure::new(seed, pose, &[]);
        let figure = Figure::new(seed, pose, &[thing]);
        let character = figure.fused(cells);
        let outside = |pieces: &[figures::Piece], p: DVec3| {
            pieces.iter().map(|piece| piece.outside(p)).fold(f64::INFINITY, f64::min)
        };
        let (body, things) = figure.pieces.split_at(bare.pieces.len());
        let is_thing = character.meshes[0]
            .positions
            .iter()
            .map(|p| outside(things, p.as_dvec3()) < outside(body, p.as_dvec3()) - 0.003)
            .collect();
        Self::rigged(character, is_thing)
    }

    fn rigged(character: Character, is_thing: Vec<bool>) -> Self {
        let options = RigOptions { fingers: false, thread_count: 1, ..RigOptions::default() };
        let rig = Rig::of(&character, &options).unwrap();
        Self { character, rig, is_thing }
    }

    fn at(&self, role: Role) -> DVec3 {
        self.rig.skeleton.joints[self.rig.humanoid.joint(role).unwrap()].position()
    }

    /// The weight of `roles` at a vertex.
    fn share(&self, vertex: usize, roles: &[Role]) -> f64 {
        let is_of =
            |joint: u32| roles.iter().any(|&role| self.rig.humanoid.joint(role) == Some(joint as usize));
        self.rig.skin_weights[0].row(vertex).iter().filter(|e| is_of(e.0)).map(|e| f64::from(e.1)).sum()
    }

    /// The mean weight of `roles` over the thing's vertices that are `chosen`, and how many there are.
    fn mean(&self, roles: &[Role], chosen: impl Fn(DVec3) -> bool) -> (f64, usize) {
        let of_thing = (0..self.is_thing.len())
            .filter(|&v| self.is_thing[v] && chosen(self.character.meshes[0].positions[v].as_dvec3()));
        let (sum, count) = of_thing.fold((0.0, 0), |(s, n), v| (s + self.share(v, roles), n + 1));
        (sum / f64::from(count as u32).max(1.0), count)
    }

    /// The share of what is no thing, below `line`, that the head moves by over a tenth.
    fn body_taken(&self, line: f64) -> f64 {
        let body: Vec<usize> = (0..self.is_thing.len())
            .filter(|&v| !self.is_thing[v] && f64::from(self.character.meshes[0].positions[v].y) < line)
            .collect();
        let taken = body.iter().filter(|&&v| self.share(v, &[Head]) > 0.1).count();
        taken as f64 / body.len().max(1) as f64
    }
}

/// One skin around all of a model, its hair known from the meshes that it was made of.
fn hair_of(case: &truth::Case, cells: usize) -> (Character, Vec<bool>) {
    let figure = UnitFigure::of(&case.character, case.forward).unwrap();
    let solid = solid::Solid::of_triangles(&figure.positions, &figure.triangles, 1.0 / cells as f64);
    let (positions, triangles) = solid::surface(&solid);
    let tree = superdeform::internals::geometry::PointTree::new(&figure.positions);
    let mut found = Vec::new();
    let is_hair = positions.iter().map(|&p| {
        found.clear();
        tree.nearest(p, 1, f64::INFINITY, &mut found);
        let vertex = found[0].index() as usize;
        let mesh = figure.mesh_starts.partition_point(|&start| start <= vertex) - 1;
        case.character.meshes[mesh].kind == Some(MeshKind::Hair)
    });
    let is_hair = is_hair.collect();
    (figures::character(vec![(String::new(), positions, triangles)]), is_hair)
}

/// Hair behind the back, further down than the chin: nearest to the spine.
#[test]
fn long_hair_moves_with_the_head() {
    for seed in [420, 421, 423] {
        let worn = Worn::of(seed, Pose::Arms(40.0), Thing::LongHair, 96);
        let line = worn.at(LeftUpperArm).y;
        let (share, count) = worn.mean(&[Head], |p| p.y < line);
        assert!(count > 100, "seed {seed}: only {count} vertices hang below the shoulders");
        assert!(share > 0.9, "seed {seed}: of its hair below the shoulders the head has {share:.3}");
    }
}

/// A tail that stands off ends below the shoulders, nearest to the spine.
#[test]
fn the_end_of_a_tail_of_hair_moves_with_the_head() {
    let worn = Worn::of(420, Pose::Arms(40.0), Thing::Ponytail, 128);
    let line = worn.at(LeftUpperArm).y;
    let (share, count) = worn.mean(&[Head], |p| p.y < line);
    assert!(count > 50, "only {count} vertices hang below the shoulders");
    assert!(share > 0.95, "of the tail below the shoulders the head has {share:.3}");
}

/// Nothing hangs from heads without hair, however large they are.
#[test]
fn of_a_bare_body_nothing_is_held_by_the_head() {
    for seed in 420..432 {
        let character = Figure::new(seed, Pose::Arms(5.0 * (seed % 12) as f64), &[]).fused(96);
        let options = RigOptions { fingers: false, ..RigOptions::default() };
        let placed = Placed::of(&character, &options, &mut Progress::none()).unwrap();
        let at = placed.found.joints.iter().map(|(&role, joint)| (role, joint.position)).collect();
        let bones = weight_bones(&at, &placed.found.tips, Some(placed.found.chin));
        let (_, humanoid) = skeleton_of(&at);
        let (points, triangles) = (&placed.figure.positions, &placed.figure.triangles);
        let hanging = hangs_from_head(points, triangles, &bones, &humanoid);
        let count = hanging.iter().filter(|&&hangs| hangs).count();
        assert_eq!(count, 0, "seed {seed}");
    }
}

/// Measures everything on many figures. `FIGURES` of each thing from seed `FIRST`, `ONLY` chooses by name, `SAVE` names a
/// folder for weights and pictures' files, `AGAINST` one that was saved before.
#[test]
#[ignore = "minutes of measuring: run it with --ignored --nocapture"]
fn survey() {
    let number =
        |name: &str, usual: u64| std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual);
    let wanted = |name: &str| std::env::var("ONLY").map_or(true, |only| name.contains(&only));
    let (first, count) = (number("FIRST", 420), number("FIGURES", 8));
    let things = [
        Thing::LongHair,
        Thing::Pigtails,
        Thing::Ponytail,
        Thing::Buns,
        Thing::Hat,
        Thing::Brim,
        Thing::Skirt,
        Thing::Cape,
    ];
    let seeds: Vec<(Thing, u64)> =
        things.iter().flat_map(|&thing| (first..first + count).map(move |seed| (thing, seed))).collect();
    let seeds: Vec<_> =
        seeds.into_iter().filter(|(thing, seed)| wanted(&format!("{thing:?} {seed}"))).collect();
    let rows = models::in_parallel(&seeds, |&(thing, seed)| {
        let pose = Pose::Arms(10.0 + 7.0 * (seed % 8) as f64);
        let worn = Worn::of(seed, pose, thing, 128);
        let name = format!("{thing:?} {seed}");
        let line = worn.at(LeftUpperArm).y;
        let (share, vertices) = match thing {
            Thing::Skirt => {
                let crotch = worn.at(LeftUpperLeg).y;
                worn.mean(&[Hips, LeftUpperLeg, RightUpperLeg, Spine], |p| p.y < crotch)
            }
            Thing::Cape => worn.mean(&[Chest, Spine, UpperChest, Neck], |_| true),
            Thing::Hat | Thing::Brim | Thing::Buns => worn.mean(&[Head], |_| true),
            _ => worn.mean(&[Head], |p| p.y < line),
        };
        let taken = worn.body_taken(line);
        save(&name, &worn);
        (thing, share, vertices, taken, name)
    });
    for &thing in &things {
        let of: Vec<_> = rows.iter().filter(|row| row.0 == thing && row.2 > 0).collect();
        if of.is_empty() {
            continue;
        }
        let each: Vec<String> = of.iter().map(|row| format!("{:.2}/{:.3}", row.1, row.3)).collect();
        let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
        println!(
            "{thing:?}: right {:.3}, body taken {:.4}: {}",
            mean(of.iter().map(|row| row.1).collect()),
            mean(of.iter().map(|row| row.3).collect()),
            each.join(" ")
        );
    }
    let mut cases: Vec<truth::Case> = truth::cases().into_iter().filter(|case| wanted(&case.name)).collect();
    cases.retain(|case| {
        !case.name.contains("vrm1")
            && !case.name.contains("unrigged")
            && case.name != "makehuman_female_target.glb"
    });
    let rows = models::in_parallel(&cases, |case| {
        let (character, is_hair) = hair_of(case, 160);
        if !is_hair.iter().any(|&is| is) {
            return None;
        }
        let worn = Worn::rigged(character, is_hair);
        let line = worn.at(LeftUpperArm).y;
        let chin = worn.at(Head).y;
        save(&format!("solid {}", case.name), &worn);
        let (all, low) = (worn.mean(&[Head], |_| true), worn.mean(&[Head], |p| p.y < chin));
        Some(format!(
            "solid {:34} hair {:.3} of {}, below the chin {:.3} of {}, body taken {:.4}",
            case.name,
            all.0,
            all.1,
            low.0,
            low.1,
            worn.body_taken(line)
        ))
    });
    rows.iter().flatten().for_each(|row| println!("{row}"));
    // Nothing is worn here that is one with the body.
    let bare: Vec<u64> = (first..first + 2 * count).filter(|seed| wanted(&format!("bare {seed}"))).collect();
    models::in_parallel(&bare, |&seed| {
        let character = Figure::new(seed, Pose::Arms(5.0 + 6.0 * (seed % 10) as f64), &[]).fused(128);
        let none = vec![false; character.meshes[0].positions.len()];
        save(&format!("bare {seed}"), &Worn::rigged(character, none));
    });
    models::in_parallel(&cases, |case| {
        let mut character = case.character.clone();
        character.meshes.iter_mut().for_each(|mesh| {
            mesh.kind = None;
            mesh.name.clear();
        });
        let none = vec![false; character.meshes.iter().map(|mesh| mesh.positions.len()).sum()];
        save(&format!("stripped {}", case.name), &Worn::rigged(character, none));
    });
}

/// Keeps a figure's weights, and says how many vertices' differ from those that were kept before.
fn save(name: &str, worn: &Worn) {
    let rows = || worn.rig.skin_weights.iter().flat_map(|weights| weights.rows());
    let joints = worn.rig.skeleton.joints.len();
    let mut bytes = Vec::new();
    for row in rows() {
        let mut dense = vec![0.0f32; joints];
        row.iter().for_each(|&(joint, weight)| dense[joint as usize] += weight);
        dense.iter().for_each(|weight| bytes.extend(weight.to_le_bytes()));
    }
    let file = format!("{}.weights", name.replace(' ', "_"));
    if let Some(folder) = std::env::var_os("AGAINST")
        && let Ok(before) = std::fs::read(Path::new(&folder).join(&file))
    {
        let differ = |(a, b): (&[u8], &[u8])| {
            let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
            let moved: f32 =
                a.chunks(4).zip(b.chunks(4)).map(|(a, b)| (number(a) - number(b)).abs()).sum::<f32>();
            0.5 * moved > 0.1
        };
        let (all, row) = (rows().count(), 4 * joints);
        let moved: Vec<bool> = bytes.chunks(row).zip(before.chunks(row)).map(differ).collect();
        let (mut body, mut of_body) = (0, 0);
        for (moved, thing) in moved.iter().zip(&worn.is_thing) {
            body += usize::from(!thing);
            of_body += usize::from(!thing && *moved);
        }
        let share = of_body as f64 / body.max(1) as f64;
        println!("   {name}: of the body {share:.4} moved ({of_body} of {body}, {all} in all)");
    }
    if let Some(folder) = std::env::var_os("SAVE") {
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(Path::new(&folder).join(&file), bytes).unwrap();
        if worn.character.meshes.len() == 1 {
            let path = Path::new(&folder).join(file.replace(".weights", ".glb"));
            std::fs::write(path, coloured(worn)).unwrap();
        }
    }
}

/// A file of one mesh: red where the head moves it, green the legs, blue the arms.
fn coloured(worn: &Worn) -> Vec<u8> {
    let mesh = &worn.character.meshes[0];
    let count = mesh.positions.len();
    let mut data = Vec::new();
    mesh.positions.iter().flat_map(|p| p.to_array()).for_each(|x| data.extend(x.to_le_bytes()));
    for vertex in 0..count {
        let head = worn.share(vertex, &[Head]);
        let legs = worn.share(vertex, &[LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftToes])
            + 0.5 * worn.share(vertex, &[RightUpperLeg, RightLowerLeg, RightFoot, RightToes]);
        let arms = worn.share(
            vertex,
            &[
                LeftUpperArm,
                LeftLowerArm,
                LeftHand,
                RightUpperArm,
                RightLowerArm,
                RightHand,
                LeftShoulder,
                RightShoulder,
            ],
        );
        let of = [head, legs, arms].map(|share| 0.15 + 0.85 * share as f32);
        of.iter().for_each(|x| data.extend(x.to_le_bytes()));
    }
    mesh.triangles.iter().flatten().for_each(|i| data.extend(i.to_le_bytes()));
    let (low, high) = mesh
        .positions
        .iter()
        .fold((glam::Vec3::INFINITY, glam::Vec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    let json = serde_json::json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0}]}],
        "buffers": [{"byteLength": data.len()}],
        "bufferViews": [{"buffer": 0, "byteLength": 12 * count}, {"buffer": 0, "byteOffset": 12 * count, "byteLength": 12 * count},
            {"buffer": 0, "byteOffset": 24 * count, "byteLength": data.len() - 24 * count}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": low.to_array(), "max": high.to_array()},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5125, "count": 3 * mesh.triangles.len(), "type": "SCALAR"}],
    });
    container(json.to_string().as_bytes(), &data)
}
