//! The four ways in which a user's file may hold one figure.
#![allow(dead_code)]

use super::{figures, solid};
use glam::DVec3;
use superdeform::internals::rig::UnitFigure;
use superdeform::{Character, Mesh};

/// How a file holds a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// As it comes: names, and kinds where names tell them.
    Named,
    /// A mesh each, without names.
    Nameless,
    /// All meshes in one.
    Welded,
    /// One skin around everything, from a grid of so many cells a height, as text-to-3D tools give.
    Solid(usize),
}

pub const WAYS: [Way; 4] = [Way::Named, Way::Nameless, Way::Welded, Way::Solid(160)];

/// `character`, which looks along `forward`, in one of these ways.
pub fn held(character: &Character, forward: DVec3, way: Way) -> Character {
    let mut held = character.clone();
    for mesh in &mut held.meshes {
        if way != Way::Named {
            mesh.kind = None;
            mesh.name.clear();
        }
    }
    match way {
        Way::Named | Way::Nameless => held,
        Way::Welded => {
            let mut one = Mesh::default();
            for mesh in &held.meshes {
                let start = one.positions.len() as u32;
                one.positions.extend(&mesh.positions);
                one.triangles
                    .extend(mesh.triangles.iter().map(|corners| corners.map(|vertex| vertex + start)));
            }
            Character { meshes: vec![one], ..held }
        }
        Way::Solid(cells) => {
            let Ok(figure) = UnitFigure::of(character, forward) else { return held };
            let solid = solid::Solid::of_triangles(&figure.positions, &figure.triangles, 1.0 / cells as f64);
            let (positions, triangles) = solid::surface(&solid);
            let positions = positions.into_iter().map(|p| figure.to_model(p)).collect();
            let meshes = figures::character(vec![(String::new(), positions, triangles)]).meshes;
            Character { meshes, ..held }
        }
    }
}
