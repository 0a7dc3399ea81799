//! Cloth weights from the body below.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;

use glam::DVec3;
use models::{model, style_of};
use std::sync::Arc;
use superdeform::geometry::Surface;
use superdeform::pipeline::{Deformer, Options};
use superdeform::rig::transfer::{Source, rigid_weights, transfer_weights};
use superdeform::rig::{GarmentWeights, Layout, Weighted};
use superdeform::{Character, MeshKind, Weights};

/// A character laid out, with the body's surface and weights.
struct Dressed {
    layout: Layout,
    surface: Surface,
    triangles: Vec<[u32; 3]>,
    weights: Weights,
}

impl Dressed {
    /// `character` looks along z.
    fn new(character: &Character) -> Self {
        let layout = Layout::of(character, DVec3::Z).unwrap();
        let triangles = layout.triangles_where(|mesh| layout.kinds[mesh] == Some(MeshKind::Body));
        let surface = Surface::new(&layout.positions, &triangles);
        let weights = Weights::from_rows(
            character.meshes.iter().flat_map(|mesh| mesh.weights.rows().map(|row| row.iter().copied())),
        );
        Self { layout, surface, triangles, weights }
    }

    fn source(&self) -> Source<'_> {
        Source {
            surface: &self.surface,
            positions: &self.layout.positions,
            triangles: &self.triangles,
            weights: &self.weights,
        }
    }

    /// Positions and triangles of one mesh.
    fn mesh(&self, mesh: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let vertices = self.layout.vertices(mesh);
        let start = vertices.start as u32;
        let triangles = self.layout.triangles_of(mesh);
        (
            self.layout.positions[vertices].to_vec(),
            triangles.iter().map(|corners| corners.map(|v| v - start)).collect(),
        )
    }

    fn transfer(&self, mesh: usize, manner: GarmentWeights, threads: usize) -> Weighted {
        let (positions, triangles) = self.mesh(mesh);
        transfer_weights(&self.source(), &positions, &triangles, manner, threads)
    }

    fn garments(&self) -> Vec<usize> {
        (0..self.layout.mesh_count()).filter(|&m| self.layout.kinds[m] == Some(MeshKind::Garment)).collect()
    }
}

/// For each garment vertex whether it lies behind the closest body point by its normal, deeper than 1e-3 H and less
/// than 0.02 H.
fn inside(character: &Character, positions: &[Vec<DVec3>], height: f64) -> Vec<bool> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for (mesh, positions) in character.meshes.iter().zip(positions) {
        if mesh.kind == Some(MeshKind::Body) {
            let start = points.len() as u32;
            points.extend(positions.iter().copied());
            triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|v| v + start)));
        }
    }
    let surface = Surface::new(&points, &triangles);
    let mut result = Vec::new();
    for (mesh, positions) in character.meshes.iter().zip(positions) {
        if mesh.kind == Some(MeshKind::Garment) {
            result.extend(positions.iter().map(|&p| {
                let near = surface.closest_point(p).unwrap();
                let [a, b, c] = triangles[near.triangle].map(|v| points[v as usize]);
                let behind = (p - near.point).dot((b - a).cross(c - a)) < 0.0;
                behind && (1e-3..0.02).contains(&(near.distance / height))
            }));
        }
    }
    result
}

#[test]
fn measure() {
    let Some(loaded) = model("makehuman_female_rigged.glb") else { return };
    let options = Options::default();
    for name in ["makehuman_female_rigged.glb", "quaternius_female_dress.glb", "valid_asian_f_1_busi.glb"] {
        let Some(loaded) = model(name) else { continue };
        for mesh in &loaded.character.meshes {
            println!("{name} {} {:?} {} vertices", mesh.name, mesh.kind, mesh.positions.len());
        }
    }
    let dressed = Dressed::new(&loaded.character);
    let style = style_of("kaykit_rogue.glb", &options);
    for manner in [None, Some(GarmentWeights::Nearest), Some(GarmentWeights::Robust)] {
        let mut character = loaded.character.clone();
        for garment in dressed.garments() {
            if let Some(manner) = manner {
                let start = std::time::Instant::now();
                let made = dressed.transfer(garment, manner, 2);
                println!(
                    "{manner:?} {} {:?} {:.3} s {:?}",
                    character.meshes[garment].name,
                    character.meshes[garment].positions.len(),
                    start.elapsed().as_secs_f64(),
                    made.fallback
                );
                character.meshes[garment].weights = made.weights;
            }
        }
        let deformer = Deformer::new(Arc::new(character.clone()), &style, &options).unwrap();
        let deformed = deformer.apply();
        let height = deformer.target().figure.height();
        let before: Vec<Vec<DVec3>> =
            character.meshes.iter().map(|m| m.positions.iter().map(|p| p.as_dvec3()).collect()).collect();
        let after: Vec<Vec<DVec3>> =
            deformed.meshes.iter().map(|m| m.positions.iter().map(|p| p.as_dvec3()).collect()).collect();
        let (was, is) = (inside(&character, &before, height), inside(&character, &after, height));
        let newly = was.iter().zip(&is).filter(|(was, is)| !**was && **is).count();
        println!(
            "{manner:?}: {newly} of {} newly inside = {:.2} %; was {} is {}",
            was.len(),
            100.0 * newly as f64 / was.len() as f64,
            was.iter().filter(|x| **x).count(),
            is.iter().filter(|x| **x).count()
        );
        dump(&character, &format!("/tmp/tr_out/mh_{manner:?}.json"));
    }
    for name in ["quaternius_female_dress.glb"] {
        let mut character = model(name).unwrap().character.clone();
        let dressed = Dressed::new(&character);
        for manner in [None, Some(GarmentWeights::Nearest), Some(GarmentWeights::Robust)] {
            for garment in dressed.garments() {
                if let Some(manner) = manner {
                    let made = dressed.transfer(garment, manner, 2);
                    println!("{name} {manner:?} {} {:?}", character.meshes[garment].name, made.fallback);
                    character.meshes[garment].weights = made.weights;
                }
            }
            dump(&character, &format!("/tmp/tr_out/qd_{manner:?}.json"));
        }
    }
    // Subdivided twice.
    for garment in dressed.garments() {
        let (mut positions, mut triangles) = dressed.mesh(garment);
        for _ in 0..2 {
            let mut made = std::collections::BTreeMap::new();
            let mut finer = Vec::new();
            for &[a, b, c] in &triangles {
                let mut middle = |one: u32, two: u32| {
                    *made.entry((one.min(two), one.max(two))).or_insert_with(|| {
                        positions.push((positions[one as usize] + positions[two as usize]) / 2.0);
                        positions.len() as u32 - 1
                    })
                };
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            }
            triangles = finer;
        }
        for manner in [GarmentWeights::Nearest, GarmentWeights::Robust] {
            for threads in [1, 2] {
                let start = std::time::Instant::now();
                let made = transfer_weights(&dressed.source(), &positions, &triangles, manner, threads);
                println!(
                    "{manner:?} {} vertices {threads} threads {:.3} s {:?}",
                    positions.len(),
                    start.elapsed().as_secs_f64(),
                    made.fallback
                );
            }
        }
    }
    let _ = rigid_weights;
}

fn dump(character: &Character, path: &str) {
    let meshes: Vec<serde_json::Value> = character
        .meshes
        .iter()
        .map(|m| {
            serde_json::json!({
                "name": m.name, "kind": format!("{:?}", m.kind),
                "positions": m.positions.iter().map(|p| p.to_array()).collect::<Vec<_>>(),
                "triangles": m.triangles,
                "rows": m.weights.rows().map(|r| r.to_vec()).collect::<Vec<_>>(),
            })
        })
        .collect();
    let mut names: Vec<String> = character.skeleton.joints.iter().map(|j| j.name.clone()).collect();
    for (role, joint) in character.humanoid.iter() {
        names[joint] = role.name().to_string();
    }
    let joints: Vec<serde_json::Value> = character
        .skeleton
        .joints
        .iter()
        .zip(names)
        .map(|(j, name)| serde_json::json!({"name": name, "parent": j.parent, "at": j.position().to_array()}))
        .collect();
    let map: std::collections::BTreeMap<String, String> = character
        .humanoid
        .iter()
        .map(|(role, _)| (role.name().to_string(), role.name().to_string()))
        .collect();
    std::fs::write(path, serde_json::json!({"meshes": meshes, "joints": joints, "map": map}).to_string())
        .unwrap();
}

#[test]
fn gown() {
    let options = Options::default();
    let style = style_of("kaykit_rogue.glb", &options);
    let person = people::Person { skirt: true, blended: true, ..people::Person::adult() };
    for (radius, low) in [(0.25, 0.1), (0.45, 0.1), (0.3, 0.5)] {
        let mut character = person.build();
        let skirt = character.meshes.iter().position(|m| m.name == "skirt").unwrap();
        let top = 1.1f32;
        // Stretch the skirt down to the ankles and wider.
        let ys: Vec<f32> = character.meshes[skirt].positions.iter().map(|p| p.y).collect();
        let (lo, hi) = ys.iter().fold((f32::MAX, f32::MIN), |(l, h), &y| (l.min(y), h.max(y)));
        for p in &mut character.meshes[skirt].positions {
            let t = (p.y - lo) / (hi - lo);
            let y = low + (top - low) * t;
            let r = radius + (0.145 - radius) * t;
            let flat = glam::Vec2::new(p.x, p.z).normalize() * r;
            *p = glam::Vec3::new(flat.x, y, flat.y);
        }
        let dressed = Dressed::new(&character);
        for manner in [GarmentWeights::Nearest, GarmentWeights::Robust] {
            let made = dressed.transfer(skirt, manner, 2);
            println!("{radius} {low} {manner:?} {:?} of {}", made.fallback, made.weights.row_count());
            let mut c = character.clone();
            c.meshes[skirt].weights = made.weights;
            dump(&c, &format!("/tmp/tr_out/gown_{radius}_{manner:?}.json"));
            let deformer = Deformer::new(Arc::new(c.clone()), &style, &options).unwrap();
            let deformed = deformer.apply();
            let low = |m: usize| deformed.meshes[m].positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
            println!("   after: body lowest {} skirt lowest {}", low(0), low(skirt));
            let mut after = c.clone();
            for (m, d) in after.meshes.iter_mut().zip(&deformed.meshes) {
                m.positions = d.positions.clone();
            }
            for (j, at) in after.skeleton.joints.iter_mut().zip(&deformed.joints) {
                j.rest = glam::DMat4::from_translation(*at);
            }
            dump(&after, &format!("/tmp/tr_out/gownsd_{radius}_{manner:?}.json"));
        }
    }
}
