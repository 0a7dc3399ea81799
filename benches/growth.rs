//! How time grows: weights by heat with vertices, a rig with clothes, a deformer with vertices, meshes and morph targets. Not a
//! benchmark: the least of a few runs, in seconds, on two threads; of what takes long, one run.

use glam::{DVec3, Vec3};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use superdeform::internals::rig::heat::{HeatOptions, heat_weights};
use superdeform::{Character, Deformer, Mesh, MeshKind, MorphTarget, Options, Rig, RigOptions, Weights};
use superdeform_benches::{models, refined};

const THREADS: usize = 2;
/// Vertices of bodies that weights by heat are found for.
const HEAT: [usize; 6] = [13_000, 20_000, 50_000, 100_000, 200_000, 400_000];
/// Vertices of a coat, and how far it is from the skin, model units.
const COAT: usize = 42_000;
const GAP: f64 = 0.01;
/// Vertices of bodies that a whole rig is made for, of twice as many triangles.
const RIGS: [usize; 2] = [50_000, 375_000];
/// Columns of the tubes of people of 13,000 to a million vertices.
const COLUMNS: [usize; 4] = [32, 60, 189, 272];
/// Meshes that one person is cut into, and morph targets of each vertex of its largest one.
const MESHES: usize = 300;
const MORPHS: [usize; 2] = [50, 200];

/// The least time of so many runs, in seconds.
fn least<T>(runs: usize, mut run: impl FnMut() -> T) -> f64 {
    let mut timed = || {
        let clock = Instant::now();
        black_box(run());
        clock.elapsed().as_secs_f64()
    };
    (0..runs).map(|_| timed()).fold(f64::INFINITY, f64::min)
}

/// How fast `times` grow with `sizes`: the slope of the line through their logarithms.
fn exponent(sizes: &[f64], times: &[f64]) -> f64 {
    let logs = |values: &[f64]| values.iter().map(|value| value.ln()).collect::<Vec<_>>();
    let (x, y) = (logs(sizes), logs(times));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_x, mean_y) = (mean(&x), mean(&y));
    let shared: f64 = x.iter().zip(&y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    shared / x.iter().map(|x| (x - mean_x).powi(2)).sum::<f64>()
}

fn heat() {
    for body in models::bodies() {
        let (mut sizes, mut times) = (Vec::new(), Vec::new());
        for count in HEAT {
            let (positions, triangles) = refined(&body.positions, &body.triangles, count);
            let options = HeatOptions { heat: 1.0, thread_count: THREADS };
            let runs = if count > 100_000 { 2 } else { 5 };
            let time = least(runs, || heat_weights(&positions, &triangles, &body.bones, &options));
            println!("heat, {}, {} vertices: {time:.3}", body.name, positions.len());
            sizes.push(positions.len() as f64);
            times.push(time);
        }
        println!("heat, {}: grows with the power {:.2}", body.name, exponent(&sizes, &times));
    }
}

fn mesh(name: &str, kind: MeshKind, positions: &[DVec3], triangles: Vec<[u32; 3]>) -> Mesh {
    let positions = positions.iter().map(|p| p.as_vec3()).collect();
    Mesh { name: name.to_string(), kind: Some(kind), positions, triangles, ..Mesh::default() }
}

/// The surface, so far outside of itself.
fn outside(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        corners.iter().for_each(|&corner| normals[corner as usize] += (b - a).cross(c - a));
    }
    positions.iter().zip(normals).map(|(&p, normal)| p + GAP * normal.normalize_or_zero()).collect()
}

fn rig() {
    let body = models::capsule_body();
    let skin = mesh("skin", MeshKind::Body, &body.positions, body.triangles.clone());
    let (positions, triangles) = refined(&body.positions, &body.triangles, COAT);
    let coat = mesh("coat", MeshKind::Garment, &outside(&positions, &triangles), triangles);
    let options = RigOptions { thread_count: THREADS, ..RigOptions::default() };
    let bare = Character { meshes: vec![skin.clone()], ..Character::default() };
    let alone = least(5, || Rig::of(&bare, &options).expect("it can be rigged"));
    println!("rig, {} vertices: {alone:.3}", skin.positions.len());
    for count in RIGS {
        let (positions, triangles) = refined(&body.positions, &body.triangles, count);
        let skin = mesh("skin", MeshKind::Body, &positions, triangles);
        let fine = Character { meshes: vec![skin.clone()], ..Character::default() };
        let runs = if count > 100_000 { 1 } else { 3 };
        let time = least(runs, || Rig::of(&fine, &options).expect("it can be rigged"));
        println!("rig, {} vertices, {} triangles: {time:.3}", skin.positions.len(), skin.triangles.len());
    }
    let dressed = Character { meshes: vec![skin, coat.clone()], ..Character::default() };
    let with = least(5, || Rig::of(&dressed, &options).expect("it can be rigged"));
    println!("the same with a coat of {} vertices: {:.3} more", coat.positions.len(), with - alone);
}

/// Prints what a deformer of `character` takes, and its parts.
fn deformer(name: &str, character: Character) {
    let runs = if character.vertex_count() > 200_000 { 1 } else { 3 };
    let options = Options { thread_count: THREADS, ..Options::default() };
    let vertices = character.vertex_count();
    let character = Arc::new(character);
    let new = || Deformer::new(character.clone(), &models::style(), &options).expect("the model is whole");
    let made = new();
    let create = least(runs, new);
    let first = least(1, || made.apply());
    let apply = least(runs, || made.apply());
    let deformed = made.apply();
    let report = least(runs, || made.report(&deformed).expect("the result is whole"));
    println!(
        "{name}, {vertices} vertices: create {create:.3}, first apply of all {first:.3}, another {apply:.3}, report {report:.3}"
    );
}

/// The same figure, its meshes cut until there are so many.
fn cut(mut character: Character, count: usize) -> Character {
    let share = character.meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>().div_ceil(count);
    let piece = |mesh: &Mesh, triangles: &[[u32; 3]]| {
        let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        let new = |corner: u32| used.binary_search(&corner).expect("it is used") as u32;
        let of = |values: &[Vec3]| -> Vec<Vec3> {
            used.iter().filter_map(|&vertex| values.get(vertex as usize)).copied().collect()
        };
        Mesh {
            positions: of(&mesh.positions),
            normals: of(&mesh.normals),
            triangles: triangles.iter().map(|corners| corners.map(new)).collect(),
            weights: Weights::from_rows(
                used.iter().map(|&vertex| mesh.weights.row(vertex as usize).to_vec()),
            ),
            ..Mesh { name: mesh.name.clone(), kind: mesh.kind, ..Mesh::default() }
        }
    };
    character.meshes = (character.meshes.iter())
        .flat_map(|mesh| mesh.triangles.chunks(share).map(|triangles| piece(mesh, triangles)))
        .collect();
    character
}

/// The same figure with so many morph targets that move all of its largest mesh.
fn with_morphs(mut character: Character, count: usize) -> Character {
    let largest =
        (character.meshes.iter_mut()).max_by_key(|mesh| mesh.positions.len()).expect("a person has meshes");
    let shift = |target: usize| vec![Vec3::splat(1e-4 * (target + 1) as f32); largest.positions.len()];
    largest.morph_targets =
        (0..count).map(|target| MorphTarget { positions: shift(target), ..MorphTarget::default() }).collect();
    character
}

fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    let is_asked = |part: &str| only.is_empty() || only == part;
    if is_asked("heat") {
        heat();
    }
    if is_asked("rig") {
        rig();
    }
    if is_asked("deformer") {
        COLUMNS.into_iter().for_each(|columns| deformer("a person", models::capsules(columns)));
        deformer(&format!("in {MESHES} meshes"), cut(models::capsules(COLUMNS[1]), MESHES));
        for count in MORPHS {
            deformer(&format!("{count} morph targets"), with_morphs(models::capsules(COLUMNS[1]), count));
        }
    }
}
