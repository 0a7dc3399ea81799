//! The auto-rig as a whole (§IV-B): from meshes to a deformation, against the rigs of artists.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;
#[path = "common/truth.rs"]
mod truth;

use glam::DVec3;
use models::{check_all, furthest, in_parallel, loaded, model, positions, rest_positions, style_of};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};
use superdeform::internals::shape::figure::Figure;
use superdeform::{
    Character, Deformer, Humanoid, MeshKind, Options, Rig, RigOptions, Role, Weights, find_roles,
};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, Loaded, load};
use superdeform_host::rig::{INFLUENCES, add_rig, rerigged};
use superdeform_host::samples;
use superdeform_host::verify::skinned;
use superdeform_host::write::rewrite;
use truth::{Case, cases};

/// Cases with their rigs, made once.
fn rigs() -> &'static [(Case, Rig)] {
    static RIGS: OnceLock<Vec<(Case, Rig)>> = OnceLock::new();
    RIGS.get_or_init(|| {
        let cases = cases();
        let rigs = in_parallel(&cases, |case| {
            Rig::of(&case.character, &RigOptions { thread_count: 1, ..RigOptions::default() })
                .unwrap_or_else(|error| panic!("{}: {error}", case.name))
        });
        cases.into_iter().zip(rigs).collect()
    })
}

/// A file read without looking for a rig in it.
fn unrigged(name: &str) -> Option<Loaded> {
    let file = GltfFile::read(&samples::path(name)?).unwrap();
    let options = LoadOptions { without_rig: true, ..LoadOptions::default() };
    Some(load(file, &options).unwrap())
}

fn height(character: &Character) -> f64 {
    let up = character.axes.up.as_dvec3().normalize();
    let (low, high) = rest_positions(character)
        .iter()
        .map(|p| p.dot(up))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    high - low
}

#[test]
fn every_vertex_of_every_character_is_given_weights() {
    check_all(rigs(), |(case, rig)| {
        let mut failures = Vec::new();
        for weights in [&rig.weights, &rig.skin_weights] {
            for (mesh, weights) in case.character.meshes.iter().zip(weights) {
                if weights.row_count() != mesh.positions.len() {
                    failures.push(format!("{}: {} has {} rows", case.name, mesh.name, weights.row_count()));
                }
                for (vertex, row) in weights.rows().enumerate() {
                    let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
                    let sane = row
                        .iter()
                        .all(|&(joint, weight)| weight > 0.0 && (joint as usize) < rig.skeleton.joints.len());
                    if (sum - 1.0).abs() > 1e-5 || !sane {
                        failures.push(format!("{}: {} vertex {vertex}: {row:?}", case.name, mesh.name));
                        break;
                    }
                }
            }
        }
        if rig.report().unreached_vertices != 0 {
            failures.push(format!("{}: vertices without weights", case.name));
        }
        failures
    });
}

#[test]
fn weights_for_animation_have_four_influences_largest_first() {
    check_all(rigs(), |(case, rig)| {
        let rows = rig.skin_weights.iter().map(|weights| weights.limited(INFLUENCES));
        let mut failures = Vec::new();
        for row in rows.collect::<Vec<_>>().iter().flat_map(Weights::rows) {
            let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
            if row.len() > INFLUENCES || !row.is_sorted_by(|a, b| a.1 >= b.1) || (sum - 1.0).abs() > 1e-6 {
                failures.push(format!("{}: {row:?}", case.name));
                break;
            }
        }
        failures
    });
}

/// A target deformed by its artist's rig and by one that was made for it, like kaykit_rogue.
struct Pair {
    name: &'static str,
    artist: Vec<DVec3>,
    auto: Vec<DVec3>,
    character: Character,
    figure: Figure,
    height: f64,
}

fn pairs() -> &'static [Pair] {
    static PAIRS: OnceLock<Vec<Pair>> = OnceLock::new();
    PAIRS.get_or_init(|| {
        let twins = [
            ("makehuman_female_target.glb", "makehuman_female_rigged.glb"),
            ("quaternius_female_dress_unrigged.glb", "quaternius_female_dress.glb"),
            ("seedsan_unrigged.glb", "seedsan_vrm1.vrm"),
        ];
        let options = Options::default();
        let style = style_of("kaykit_rogue.glb", &options);
        let mut pairs = Vec::new();
        for (name, twin) in twins {
            let (Some(target), Some(twin)) = (unrigged(name), model(twin)) else {
                continue;
            };
            let artist = Deformer::new(Arc::new(twin.character.clone()), &style, &options).unwrap();
            let rig = Rig::of(&target.character, &RigOptions::default()).unwrap();
            let auto = Deformer::with_rig(&target.character, &rig, &style, &options).unwrap();
            let to_artist = same_vertices(&target.character, &twin.character);
            let by_artist = positions(&artist.apply());
            pairs.push(Pair {
                name,
                artist: to_artist.into_iter().map(|vertex| by_artist[vertex]).collect(),
                auto: positions(&auto.apply()),
                height: height(&target.character),
                figure: Figure::clone(&auto.target().figure),
                character: target.character,
            });
        }
        pairs
    })
}

/// For each vertex of `one` the vertex of `other` at the same place.
fn same_vertices(one: &Character, other: &Character) -> Vec<usize> {
    let tolerance = 1e-4 * height(one);
    let (one, other) = (rest_positions(one), rest_positions(other));
    let tree = superdeform::internals::geometry::PointTree::new(&other);
    let mut found = Vec::new();
    one.iter()
        .enumerate()
        .map(|(vertex, &p)| {
            if other.get(vertex).is_some_and(|q| q.distance(p) < tolerance) {
                return vertex;
            }
            tree.nearest(p, 1, f64::INFINITY, &mut found);
            assert!(found[0].distance() < tolerance, "the twins differ at vertex {vertex}: {p}");
            found[0].index() as usize
        })
        .collect()
}

#[test]
fn the_result_is_that_of_the_artists_rig() {
    check_all(pairs(), |pair| {
        let mean = |choose: &dyn Fn(usize) -> bool| {
            let distances: Vec<f64> = (0..pair.auto.len())
                .filter(|&vertex| choose(vertex))
                .map(|vertex| pair.artist[vertex].distance(pair.auto[vertex]) / pair.height)
                .collect();
            distances.iter().sum::<f64>() / distances.len() as f64
        };
        // A machine arm longer than its bearer hangs from wherever its artist hung it.
        let worn = |vertex: usize| pair.figure.kind(vertex) != MeshKind::Accessory;
        println!("{}: mean distance to the artist's {:.4} H", pair.name, mean(&|_| true));
        let mean = mean(&worn);
        println!("{}: without accessories {mean:.4} H", pair.name);
        (mean > 0.02).then(|| format!("{}: mean distance {mean:.4} H", pair.name)).into_iter().collect()
    });
}

#[test]
fn few_triangles_turn_over() {
    check_all(pairs(), |pair| {
        let figure = &pair.figure;
        let after: Vec<DVec3> = pair.auto.iter().map(|&p| figure.frame.to_canonical(p)).collect();
        let normal = |positions: &[DVec3], corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
            (b - a).cross(c - a)
        };
        let turned = figure
            .triangles
            .iter()
            .filter(|corners| normal(&figure.positions, corners).dot(normal(&after, corners)) < 0.0)
            .count();
        let share = turned as f64 / figure.triangles.len() as f64;
        println!("{}: {turned} triangles turned over ({:.2} %)", pair.name, 100.0 * share);
        (share > 0.005)
            .then(|| format!("{}: {turned} triangles turned over", pair.name))
            .into_iter()
            .collect()
    });
}

/// How deep each garment vertex lies behind the closest point of the body, and that many are garment vertices.
fn depths(character: &Character, kinds: &[MeshKind], positions: &[DVec3]) -> Vec<f64> {
    let mut body = Vec::new();
    let mut garment = Vec::new();
    let mut start = 0u32;
    for (mesh, kind) in character.meshes.iter().zip(kinds) {
        match kind {
            MeshKind::Body => body.extend(mesh.triangles.iter().map(|corners| corners.map(|v| v + start))),
            MeshKind::Garment => garment.extend(start..start + mesh.positions.len() as u32),
            _ => {}
        }
        start += mesh.positions.len() as u32;
    }
    let surface = superdeform::internals::geometry::Surface::new(positions, &body);
    garment
        .into_iter()
        .map(|vertex| {
            let p = positions[vertex as usize];
            let closest = surface.closest_point(p).unwrap();
            let [a, b, c] = body[closest.triangle].map(|vertex| positions[vertex as usize]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            (closest.point - p).dot(normal)
        })
        .collect()
}

#[test]
fn clothes_stay_outside() {
    check_all(pairs(), |pair| {
        let kinds: Vec<MeshKind> = pair.figure.mesh_starts[..pair.character.meshes.len()]
            .iter()
            .map(|&start| pair.figure.kinds[start.min(pair.figure.kinds.len() - 1)])
            .collect();
        if !kinds.contains(&MeshKind::Garment) || !kinds.contains(&MeshKind::Body) {
            return Vec::new();
        }
        let before = depths(&pair.character, &kinds, &rest_positions(&pair.character));
        let after = depths(&pair.character, &kinds, &pair.auto);
        let inside = |depth: f64| depth > 1e-3 * pair.height && depth < 0.02 * pair.height;
        let newly = before.iter().zip(&after).filter(|&(&was, &is)| inside(is) && !inside(was)).count();
        let share = newly as f64 / before.len() as f64;
        println!("{}: {newly} of {} garment vertices newly inside", pair.name, before.len());
        let paper_case = pair.name == "makehuman_female_target.glb";
        (paper_case && share > 0.03)
            .then(|| format!("{}: {newly} of {} newly inside", pair.name, before.len()))
            .into_iter()
            .collect()
    });
}

/// The furthest that a point of either list is from the nearest of the other: skinned meshes move to the end of the
/// scene, so that lists need not be in one order.
fn apart(one: &[DVec3], other: &[DVec3]) -> f64 {
    assert_eq!(one.len(), other.len());
    let furthest = |from: &[DVec3], to: &[DVec3]| {
        let tree = superdeform::internals::geometry::PointTree::new(to);
        let mut found = Vec::new();
        let distances = from.iter().map(|&p| {
            tree.nearest(p, 1, f64::INFINITY, &mut found);
            found[0].distance()
        });
        distances.fold(0.0, f64::max)
    };
    furthest(one, other).max(furthest(other, one))
}

#[test]
fn a_new_rig_in_a_file_puts_its_vertices_where_they_were() {
    check_all(rigs(), |(case, rig)| {
        let Some(mut target) = unrigged(&case.name) else {
            return vec![format!("{} is not there", case.name)];
        };
        let limited: Vec<Weights> =
            rig.skin_weights.iter().map(|weights| weights.limited(INFLUENCES)).collect();
        let saved = match rerigged(&target, &rig.skeleton, &limited) {
            Ok(saved) => saved,
            Err(error) => return vec![format!("{}: {error}", case.name)],
        };
        let bytes = saved.to_bytes().unwrap();
        let read = loaded(GltfFile::parse(&case.name, &bytes).unwrap());
        let mut failures = Vec::new();
        let height = height(&case.character);
        let off = apart(&rest_positions(&case.character), &rest_positions(&read.character)) / height;
        if off > 1e-6 {
            failures.push(format!("{}: vertices {off:.2e} H off", case.name));
        }
        for (role, joint) in rig.humanoid.iter() {
            let at = rig.skeleton.joints[joint].position();
            let there =
                read.character.humanoid.joint(role).map(|j| read.character.skeleton.joints[j].position());
            if there.is_none_or(|there| there.distance(at) > 1e-5 * height) {
                failures.push(format!("{}: {role} is at {there:?} instead of {at}", case.name));
            }
        }
        target.warnings.clear();
        failures
    });
}

#[test]
fn an_unrigged_target_comes_out_with_joints_that_hold_it() {
    let Some(target) = unrigged("quaternius_female_dress_unrigged.glb") else {
        panic!("the sample stands in tests/data");
    };
    let options = Options::default();
    let rig = Rig::of(&target.character, &RigOptions::default()).unwrap();
    let style = style_of("kaykit_rogue.glb", &options);
    let deformer = Deformer::with_rig(&target.character, &rig, &style, &options).unwrap();
    let deformed = deformer.apply();
    let mut file = rewrite(&target, &deformed, &|joint, point| deformer.map(joint, point)).unwrap();
    let mut skeleton = rig.skeleton.clone();
    for (joint, &at) in skeleton.joints.iter_mut().zip(&deformed.joints) {
        joint.rest.w_axis = at.extend(1.0);
    }
    let limited: Vec<Weights> = rig.skin_weights.iter().map(|weights| weights.limited(INFLUENCES)).collect();
    add_rig(&mut file, &target, &skeleton, &limited).unwrap();
    let written = GltfFile::parse("result.glb", &file.to_bytes().unwrap()).unwrap();
    let read = loaded(written.clone());
    assert!(read.rigged && read.character.humanoid.missing().is_empty());
    let height = height(&target.character);
    let off = furthest(&rest_positions(&read.character), &skinned(&written).unwrap()) / height;
    assert!(off < 1e-6, "{off:.2e}");
    assert!(apart(&positions(&deformed), &rest_positions(&read.character)) / height < 1e-6);
    let report = deformer.report(&deformed).unwrap();
    assert_eq!(report.rig.source, "auto");
    assert_eq!(report.rig.unreached_vertices, 0);
    assert!(report.target.file_joints.is_empty());
}

/// `loaded` as it would be if nobody could tell its joints' roles.
fn nameless(loaded: &Loaded) -> Character {
    let mut character = loaded.character.clone();
    for (index, joint) in character.skeleton.joints.iter_mut().enumerate() {
        joint.name = format!("node{index}");
    }
    character.humanoid = Humanoid::default();
    character
}

#[test]
fn joints_that_nobody_knows_ride_along() {
    for name in ["quaternius_female_dress.glb", "makehuman_female_rigged.glb", "seedsan_vrm1.vrm"] {
        let Some(twin) = model(name) else {
            println!("{name} is not there");
            continue;
        };
        let character = nameless(twin);
        let options = Options::default();
        let style = style_of("kaykit_rogue.glb", &options);
        let rig = Rig::of(&character, &RigOptions::default()).unwrap();
        let deformer = Deformer::with_rig(&character, &rig, &style, &options).unwrap();
        let deformed = deformer.apply();
        // Written with its own joints: they hold the vertices as before.
        let map = |joint: usize, point: DVec3| deformer.map(joint, point);
        let written = rewrite(twin, &deformed, &map).unwrap();
        let closure = superdeform_host::verify::closure(&written, twin, &deformed).unwrap();
        assert!(closure.rest < 1e-5, "{name}: {closure:?}");
        // The artist's limbs go where the new rig's limbs go.
        let height = height(&character);
        for role in [Role::LeftLowerArm, Role::RightHand, Role::LeftLowerLeg, Role::Head] {
            let own = twin.character.humanoid.joint(role).unwrap();
            let made = character.skeleton.joints.len() + rig.humanoid.joint(role).unwrap();
            let before = rig.skeleton.joints[made - character.skeleton.joints.len()]
                .position()
                .distance(character.skeleton.joints[own].position());
            let after = deformed.joints[own].distance(deformed.joints[made]);
            assert!(
                after < 1.5 * before + 0.03 * height,
                "{name}: {role} was {:.3} H from the one that was found and is {:.3} H",
                before / height,
                after / height
            );
        }
    }
}

#[test]
fn given_joints_stay_where_they_are() {
    for (case, rig) in rigs().iter().take(4) {
        let height = height(&case.character);
        let shift = DVec3::new(0.01, -0.015, 0.005) * height;
        let given: BTreeMap<Role, DVec3> = [Role::LeftLowerArm, Role::RightLowerLeg, Role::Neck]
            .into_iter()
            .map(|role| (role, rig.skeleton.joints[rig.humanoid.joint(role).unwrap()].position() + shift))
            .collect();
        let again =
            Rig::of(&case.character, &RigOptions { given: given.clone(), ..RigOptions::default() }).unwrap();
        for (role, at) in given {
            let joint = again.humanoid.joint(role).unwrap();
            let there = again.skeleton.joints[joint].position();
            assert!(there.distance(at) < 1e-9 * height, "{}: {role}", case.name);
            assert_eq!(again.confidence[joint], 1.0);
        }
    }
}

#[test]
fn roles_of_a_made_rig_are_read_by_their_names() {
    for (case, rig) in rigs() {
        let (found, _) = find_roles(&rig.skeleton, &case.character.meshes, case.character.axes.up);
        for (role, joint) in rig.humanoid.iter() {
            assert_eq!(found.joint(role), Some(joint), "{}: {role}", case.name);
        }
    }
}

#[test]
fn a_rig_does_not_depend_on_the_number_of_threads() {
    for (case, rig) in rigs().iter().filter(|(case, _)| case.name.starts_with("quaternius_female_dress")) {
        for thread_count in [2, 8] {
            let other =
                Rig::of(&case.character, &RigOptions { thread_count, ..RigOptions::default() }).unwrap();
            assert_eq!(rig.skeleton, other.skeleton, "{}", case.name);
            assert_eq!(rig.weights, other.weights, "{}", case.name);
            assert_eq!(rig.skin_weights, other.skin_weights, "{}", case.name);
        }
    }
}

#[test]
fn a_rig_does_not_depend_on_the_unit() {
    let Some(target) = unrigged("quaternius_female_dress_unrigged.glb") else {
        panic!("the sample stands in tests/data");
    };
    let rig = Rig::of(&target.character, &RigOptions::default()).unwrap();
    for factor in [1e-3, 1e3] {
        let scaled = models::scaled(&target.character, factor);
        let other = Rig::of(&scaled, &RigOptions::default()).unwrap();
        for (a, b) in rig.skeleton.joints.iter().zip(&other.skeleton.joints) {
            let off = (a.position() * factor).distance(b.position()) / factor / height(&target.character);
            assert!(off < 1e-4, "x{factor}: {} is {off:.2e} H off", a.name);
        }
        for (one, other) in rig.weights.iter().zip(&other.weights) {
            for (a, b) in one.rows().zip(other.rows()) {
                let at = |row: &[(u32, f32)], joint: u32| {
                    row.iter().filter(|entry| entry.0 == joint).map(|entry| entry.1).sum::<f32>()
                };
                for &(joint, _) in a.iter().chain(b) {
                    assert!((at(a, joint) - at(b, joint)).abs() < 1e-4, "x{factor}: {a:?} {b:?}");
                }
            }
        }
    }
}
