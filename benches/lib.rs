//! Characters to measure on: made here, so that a number means the same on every machine.

use glam::{DMat4, DVec3, Vec3};
use superdeform::{Axes, Character, Humanoid, Joint, Mesh, Role, Skeleton, Weights};

/// A tube of `ring_count` rings of `side_count` vertices that stands on a chain of hips, spine and head, its
/// weights blended from joint to joint.
pub fn tube(ring_count: usize, side_count: usize) -> Character {
    let heights = [0.0, 0.6, 1.2];
    let roles = [Role::Hips, Role::Spine, Role::Head];
    let mut humanoid = Humanoid::default();
    let mut skeleton = Skeleton::default();
    for (index, (&height, role)) in heights.iter().zip(roles).enumerate() {
        humanoid.set(role, index);
        skeleton.joints.push(Joint {
            name: role.name().to_string(),
            parent: index.checked_sub(1),
            rest: DMat4::from_translation(DVec3::new(0.0, height, 0.0)),
        });
    }
    let mut mesh = Mesh { name: "tube".to_string(), ..Mesh::default() };
    let mut rows = Vec::new();
    for ring in 0..ring_count {
        let height = 1.6 * ring as f32 / (ring_count - 1) as f32;
        for side in 0..side_count {
            let (sin, cos) = (std::f32::consts::TAU * side as f32 / side_count as f32).sin_cos();
            mesh.positions.push(Vec3::new(0.2 * cos, height, 0.2 * sin));
            mesh.normals.push(Vec3::new(cos, 0.0, sin));
            let along = (height / 0.6).min(1.999);
            let (lower, share) = (along as u32, along.fract());
            rows.push([(lower, 1.0 - share), (lower + 1, share)]);
        }
    }
    for ring in 1..ring_count as u32 {
        for side in 0..side_count as u32 {
            let next = (side + 1) % side_count as u32;
            let [below, above] = [(ring - 1) * side_count as u32, ring * side_count as u32];
            mesh.triangles.push([below + side, above + side, above + next]);
            mesh.triangles.push([below + side, above + next, below + next]);
        }
    }
    mesh.weights = Weights::from_rows(rows);
    Character { meshes: vec![mesh], skeleton, humanoid, axes: Axes::default() }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_tube_is_a_valid_character() {
        let character = super::tube(100, 30);
        character.validate().unwrap();
        assert_eq!(character.vertex_count(), 3000);
        assert_eq!(character.triangle_count(), 2 * 99 * 30);
    }
}
