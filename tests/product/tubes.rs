//! A person made of tubes, measured and bound to its parts.

use crate::people::Person;
use glam::{DMat3, DVec3};
use std::sync::OnceLock;
use superdeform::internals::geometry::Mapped;
use superdeform::internals::geometry::weld::{SEAM, weld};
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::anatomy::Anatomy;
use superdeform::internals::shape::product::binding::{PartBindings, part_bindings};
use superdeform::internals::shape::product::part::{PART_COUNT, Part, PartWeights};
use superdeform::{Character, MeshKind, Progress};

pub struct Tubes {
    pub person: Person,
    pub character: Character,
    pub figure: Figure,
    pub anatomy: Anatomy,
    pub bindings: PartBindings,
}

impl Tubes {
    pub fn of(person: Person) -> Self {
        let character = person.build();
        Self::of_character(person, character)
    }

    /// `character` is what was made of `person`.
    pub fn of_character(person: Person, character: Character) -> Self {
        let figure = Figure::of(&character).unwrap();
        let anatomy = Anatomy::of(&figure);
        let weld = weld(&figure.positions, SEAM * figure.height());
        let bindings =
            part_bindings(&figure, &anatomy, None, &character.skeleton, &weld, 1, &mut Progress::none())
                .unwrap();
        Self { person, character, figure, anatomy, bindings }
    }

    /// The vertices of the mesh called `name`.
    pub fn mesh(&self, name: &str) -> std::ops::Range<usize> {
        let mesh = self.character.meshes.iter().position(|mesh| mesh.name == name).unwrap();
        self.figure.mesh_starts[mesh]..self.figure.mesh_starts[mesh + 1]
    }

    pub fn weights(&self, vertex: usize) -> &PartWeights {
        &self.bindings.vertices[vertex].weights
    }
}

/// An adult whose trunk and limbs are one tube each.
pub fn blended() -> &'static Tubes {
    static BLENDED: OnceLock<Tubes> = OnceLock::new();
    BLENDED.get_or_init(|| Tubes::of(Person { blended: true, ..Person::adult() }))
}

/// The same with tubes twice as fine.
pub fn fine() -> Person {
    Person { blended: true, columns: 96, ..Person::adult() }
}

/// The people that hold for all: in A-pose and T-pose, with and without eyes, fingers, a skirt, hands and feet.
pub fn crowd() -> &'static [Tubes] {
    use superdeform::Role::*;
    static CROWD: OnceLock<Vec<Tubes>> = OnceLock::new();
    CROWD.get_or_init(|| {
        let adult = Person::adult;
        [
            adult(),
            Person { blended: true, ..Person::chibi() },
            Person { arm_angle: 45.0, blended: true, fingers: true, ..adult() },
            Person { skirt: true, holes: true, eyes: false, ..adult() },
            Person { without: vec![LeftHand, RightHand, LeftFoot, RightFoot], blended: true, ..adult() },
            Person { unit: 100.0, facing: 90.0, blended: true, ..adult() },
        ]
        .into_iter()
        .map(Tubes::of)
        .collect()
    })
}

/// A mesh of `kind` called `name` at `positions`, all of it weighted to joint number `joint`.
pub fn add_mesh(
    character: &mut Character,
    name: &str,
    kind: MeshKind,
    shape: &crate::people::Shape,
    joint: usize,
) {
    let rows = shape.positions.iter().map(|_| [(joint as u32, 1.0f32)]);
    character.meshes.push(superdeform::Mesh {
        name: name.to_string(),
        kind: Some(kind),
        weights: superdeform::Weights::from_rows(rows),
        normals: shape.normals().into_iter().map(|n| n.as_vec3()).collect(),
        positions: shape.positions.iter().map(|p| p.as_vec3()).collect(),
        triangles: shape.triangles.clone(),
        ..superdeform::Mesh::default()
    });
}

/// An ellipsoid around `centre`.
pub fn ellipsoid(centre: DVec3, half: DVec3) -> crate::people::Shape {
    let mut shape = crate::people::Shape { columns: 24, ..crate::people::Shape::default() };
    shape.ellipsoid(centre, half, superdeform::Role::Hips);
    shape
}

/// The other side's part.
pub fn mirrored(part: usize) -> usize {
    let left_arm = Part::LeftUpperArm as usize;
    let left_leg = Part::LeftUpperLeg as usize;
    match part {
        part if (left_arm..left_arm + 3).contains(&part) || (left_leg..left_leg + 3).contains(&part) => {
            part + 3
        }
        part if (left_arm + 3..left_arm + 6).contains(&part)
            || (left_leg + 3..left_leg + 6).contains(&part) =>
        {
            part - 3
        }
        part => part,
    }
}

/// The same weights on the other side.
pub fn mirrored_weights(weights: &PartWeights) -> PartWeights {
    let mut other = [0.0; PART_COUNT];
    for (part, &weight) in weights.iter().enumerate() {
        other[mirrored(part)] = weight;
    }
    other
}

/// How far the Jacobian of `map` at `p` is from central differences of `step`.
pub fn jacobian_error(map: impl Fn(DVec3) -> Mapped, p: DVec3, step: f64) -> f64 {
    let columns = DVec3::AXES
        .map(|axis| (map(p + step * axis).position - map(p - step * axis).position) / (2.0 * step));
    let difference = map(p).jacobian - DMat3::from_cols(columns[0], columns[1], columns[2]);
    difference.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// Numbers in 0..1 that look random and are the same on every run.
pub fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        // Knuth, MMIX.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}
