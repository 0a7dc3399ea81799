//! Avatars with what the models lack: a skirt on chains of spring joints, a plug on a cord.
#![allow(dead_code)]

use crate::people::{Person, Shape};
use glam::{DMat4, DVec3};
use std::f64::consts::TAU;
use superdeform::{Character, Joint, Mesh, MeshKind, Role, Weights};

/// Chains of the skirt, and joints of each.
pub const CHAINS: usize = 8;
pub const LEVELS: usize = 4;

/// Adds a joint without a role.
pub fn add_joint(character: &mut Character, name: String, parent: usize, at: DVec3) -> usize {
    let joint = Joint { name, parent: Some(parent), rest: DMat4::from_translation(at) };
    character.skeleton.joints.push(joint);
    character.skeleton.joints.len() - 1
}

/// A person whose skirt is moved by eight chains around it, none of which plays a role; the joints of each, from the top.
pub fn skirted() -> (Character, Vec<Vec<usize>>) {
    let mut character = Person { columns: 24, skirt: true, ..Person::adult() }.build();
    let hips = character.humanoid.joint(Role::Hips).unwrap();
    let skirt = character.meshes.iter().position(|mesh| mesh.name == "skirt").unwrap();
    let positions: Vec<DVec3> = character.meshes[skirt].positions.iter().map(|p| p.as_dvec3()).collect();
    let range = |values: &dyn Fn(&DVec3) -> f64| {
        positions
            .iter()
            .map(values)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (bottom, top) = range(&|p| p.y);
    let radius = |y: f64| {
        let near = positions.iter().min_by(|p, q| (p.y - y).abs().total_cmp(&(q.y - y).abs())).unwrap();
        near.x.hypot(near.z)
    };
    let height = |level: usize| top + (bottom - top) * level as f64 / LEVELS as f64;
    let mut chains = Vec::new();
    for chain in 0..CHAINS {
        let (sin, cos) = (TAU * chain as f64 / CHAINS as f64).sin_cos();
        let mut parent = hips;
        let mut joints = Vec::new();
        for level in 0..LEVELS {
            let y = height(level);
            let at = DVec3::new(radius(y) * sin, y, radius(y) * cos);
            parent = add_joint(&mut character, format!("skirt {chain} {level}"), parent, at);
            joints.push(parent);
        }
        chains.push(joints);
    }
    let rows = positions.iter().map(|p| {
        let around = (p.x.atan2(p.z) / TAU * CHAINS as f64).rem_euclid(CHAINS as f64);
        let down = ((top - p.y) / (top - bottom) * LEVELS as f64).clamp(0.0, LEVELS as f64 - 1.0);
        let (column, level) = (around as usize % CHAINS, (down as usize).min(LEVELS - 2));
        let (aside, below) = (around.fract() as f32, (down - level as f64) as f32);
        let next = (column + 1) % CHAINS;
        vec![
            (chains[column][level] as u32, (1.0 - aside) * (1.0 - below)),
            (chains[next][level] as u32, aside * (1.0 - below)),
            (chains[column][level + 1] as u32, (1.0 - aside) * below),
            (chains[next][level + 1] as u32, aside * below),
        ]
    });
    character.meshes[skirt].weights = Weights::from_rows(rows.collect::<Vec<_>>());
    (character, chains)
}

/// A person with a box on the back, a cord that the chest holds at its upper end and that hangs from the box's joint, and a
/// plug at its lower end; the joints of the cord, from the top.
pub fn plugged() -> (Character, Vec<usize>) {
    let mut character = Person { columns: 24, ..Person::adult() }.build();
    let chest = character.humanoid.joint(Role::Chest).unwrap();
    let top = DVec3::new(0.0, 1.2, -0.18);
    let way = DVec3::new(0.0, -0.6, -0.25);
    let bag = add_joint(&mut character, "bag".to_string(), chest, top);
    let mut cord = Vec::new();
    for index in 0..4 {
        let parent = cord.last().copied().unwrap_or(bag);
        cord.push(add_joint(&mut character, format!("cord {index}"), parent, top + way * index as f64 / 4.0));
    }
    let end = add_joint(&mut character, "plug".to_string(), cord[3], top + way);
    let mut add = |name: &str, shape: &Shape, joint: &dyn Fn(DVec3) -> usize| {
        let rows = shape.positions.iter().map(|&p| [(joint(p) as u32, 1.0f32)]);
        character.meshes.push(Mesh {
            name: name.to_string(),
            kind: Some(MeshKind::Garment),
            weights: Weights::from_rows(rows),
            normals: shape.normals().into_iter().map(|n| n.as_vec3()).collect(),
            positions: shape.positions.iter().map(|p| p.as_vec3()).collect(),
            triangles: shape.triangles.clone(),
            ..Mesh::default()
        });
    };
    let ball = |centre: DVec3, half: DVec3| {
        let mut shape = Shape { columns: 48, ..Shape::default() };
        shape.ellipsoid(centre, half, Role::Hips);
        shape
    };
    add("bag", &ball(top - 0.1 * DVec3::Z, DVec3::new(0.1, 0.15, 0.08)), &|_| bag);
    add("plug", &ball(top + 1.05 * way, DVec3::splat(0.04)), &|_| end);
    let mut tube = Shape { columns: 6, ..Shape::default() };
    let rings: Vec<_> = (0..=20)
        .map(|ring| crate::people::Ring {
            centre: top + way * f64::from(ring) / 20.0,
            radius: 0.01,
            weights: vec![(Role::Hips, 1.0)],
        })
        .collect();
    tube.tube(way.normalize(), &rings, true);
    let along = |p: DVec3| (p - top).dot(way) / way.length_squared();
    add("cord", &tube, &|p| match along(p) {
        t if t < 0.04 => chest,
        t => cord[((t * 4.0).round() as usize).min(3)],
    });
    (character, cord)
}
