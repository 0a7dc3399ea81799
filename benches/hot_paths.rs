//! What `instructions.py` counts the instructions of: five hot paths on a person of tubes, on one thread, each in a function
//! of its own that nothing else calls.

use glam::DVec3;
use std::hint::black_box;
use std::sync::Arc;
use superdeform::internals::geometry::Surface;
use superdeform::internals::rig::heat::{HeatOptions, heat_weights};
use superdeform::{Character, Deformer, MeshOutputs, Options, Progress};
use superdeform_benches::models;

/// Columns of the person's tubes: some 6,000 vertices.
const COLUMNS: usize = 16;

#[inline(never)]
fn hot_positions(deformer: &Deformer, asked: &[MeshOutputs]) {
    drop(black_box(deformer.apply_to(asked, &mut Progress::none())));
}

#[inline(never)]
fn hot_directions(deformer: &Deformer, asked: &[MeshOutputs]) {
    drop(black_box(deformer.apply_to(asked, &mut Progress::none())));
}

#[inline(never)]
fn hot_slider(deformer: &mut Deformer, options: &Options) {
    deformer.set_options(options, &mut Progress::none()).expect("the options are in range");
}

/// Rays from the middle in all directions.
#[inline(never)]
fn hot_rays(surface: &Surface, middle: DVec3) {
    for ray in 0..500 {
        let (sin, cos) = (f64::from(ray) * 2.4).sin_cos();
        let direction = DVec3::new(cos, f64::from(ray) / 250.0 - 1.0, sin);
        black_box(surface.all_hits(middle, direction));
    }
}

#[inline(never)]
fn hot_heat(body: &models::Body) {
    let options = HeatOptions { heat: 1.0, thread_count: 1 };
    black_box(heat_weights(&body.positions, &body.triangles, &body.bones, &options));
}

/// All of the person's vertices, and triangles between them.
fn soup(character: &Character) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for mesh in &character.meshes {
        let first = positions.len() as u32;
        triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        positions.extend(mesh.positions.iter().map(|p| p.as_dvec3()));
    }
    (positions, triangles)
}

fn main() {
    let path = std::env::args().nth(1).unwrap_or_default();
    let character = models::capsules(COLUMNS);
    match path.as_str() {
        "rays" => {
            let (positions, triangles) = soup(&character);
            let middle = positions.iter().sum::<DVec3>() / positions.len() as f64;
            return hot_rays(&Surface::new(&positions, &triangles), middle);
        }
        "heat" => return hot_heat(&models::small_body()),
        "positions" | "directions" | "slider" => {}
        other => panic!("{other} is none of positions, directions, slider, rays, heat"),
    }
    let mesh_count = character.meshes.len();
    let asked = MeshOutputs { normals: true, tangents: true, ..MeshOutputs::default() };
    let options = Options { thread_count: 1, ..Options::default() };
    let mut deformer =
        Deformer::new(Arc::new(character), &models::style(), &options).expect("the person is whole");
    // What is made once is made before the count begins.
    deformer.apply_to(&vec![asked; mesh_count], &mut Progress::none()).expect("nothing stops it");
    match path.as_str() {
        "positions" => hot_positions(&deformer, &vec![MeshOutputs::default(); mesh_count]),
        "directions" => hot_directions(&deformer, &vec![asked; mesh_count]),
        _ => hot_slider(&mut deformer, &Options { head_scale: 1.2, ..options }),
    }
}
