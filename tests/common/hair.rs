//! Kinds of hair on people made of tubes: what hangs from a head below its chin.
#![allow(dead_code)]

use crate::people::{Person, Ring, Shape};
use glam::DVec3;
use std::f64::consts::PI;
use superdeform::{Character, Joint, Mesh, MeshKind, Role, Weights};

/// The kinds.
pub const KINDS: [Kind; 10] = [
    Kind::Straight,
    Kind::Draped,
    Kind::TwinTails,
    Kind::OneTail,
    Kind::Waves,
    Kind::SideLocks,
    Kind::Bob,
    Kind::Braid,
    Kind::OneSkin,
    Kind::Cards,
];

/// How hair is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A sheet over the back to the hips.
    Straight,
    /// A sheet that leaves the head above the ears and lies down on the shoulder blades, to the waist.
    Draped,
    /// Two tails with ties that end in tufts.
    TwinTails,
    /// One behind, to the waist.
    OneTail,
    /// As straight, in waves.
    Waves,
    /// A cap, and two locks before the shoulders to the waist.
    SideLocks,
    /// To the chin all around but the face, and a lock to the chest.
    Bob,
    /// A rope with bulges down the back, tied, with a tuft.
    Braid,
    /// As straight, of one mesh with the body.
    OneSkin,
    /// As straight, of loose strips, none of them sewn to another.
    Cards,
}

/// Head lengths, for one person.
struct Head<'a> {
    person: &'a Person,
    /// L.
    unit: f64,
}

impl Head<'_> {
    /// A point this far to the left, above the chin and to the front of the head's axis, in head lengths.
    fn at(&self, x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, 0.0, z) * self.unit + DVec3::Y * (self.person.chin() + y * self.unit)
    }

    /// Half the head's width, in head lengths.
    fn half(&self) -> f64 {
        self.person.proportions.head_half_width / self.unit
    }

    /// How far the body reaches at a height, in head lengths: that what lies on it lies on.
    fn body(&self, y: f64) -> f64 {
        let trunk = self.person.proportions.torso_radius / self.unit;
        let neck = self.person.proportions.neck_radius / self.unit;
        let shoulder = (self.person.shoulder_line() - self.person.chin()) / self.unit;
        let t = ((y - shoulder) / -shoulder).clamp(0.0, 1.0);
        trunk + (neck - trunk) * t * t * (3.0 - 2.0 * t)
    }

    /// How far hair reaches that lies on the head and then on the body.
    fn lying(&self, y: f64) -> f64 {
        let cap = |y: f64| (self.half() * 1.12) * (1.0 - ((y - 0.5) / 0.62).powi(2)).max(0.0).sqrt();
        if y > 0.5 { cap(y) } else { cap(0.5).max(self.body(y) + 0.06) }
    }

    /// A sheet around the head's axis: from a half angle away from the front to the other side, from the crown down to
    /// `bottom`, as far out as `reach` says at an angle and a height.
    fn sheet(&self, shape: &mut Shape, angles: (f64, f64), bottom: f64, reach: impl Fn(f64, f64) -> f64) {
        let (columns, rows) = (2 + (9.0 * (angles.1 - angles.0)) as u32, 40);
        let first = shape.positions.len() as u32;
        for row in 0..=rows {
            let y = 1.1 + (bottom - 1.1) * f64::from(row) / f64::from(rows);
            for column in 0..=columns {
                let angle = angles.0 + (angles.1 - angles.0) * f64::from(column) / f64::from(columns);
                let reach = reach(angle, y);
                shape.positions.push(self.at(reach * angle.sin(), y, reach * angle.cos()));
                shape.weights.push(vec![(Role::Head, 1.0)]);
            }
        }
        let at = |row: u32, column: u32| first + row * (columns + 1) + column;
        for row in 0..rows {
            for column in 0..columns {
                let [a, b] = [at(row, column), at(row, column + 1)];
                let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
                shape.triangles.extend(if column < columns / 2 {
                    [[a, c, b], [b, c, d]]
                } else {
                    [[a, c, d], [a, d, b]]
                });
            }
        }
    }

    /// A rope through `points`, as thick as `radius` says at its share.
    fn rope(&self, shape: &mut Shape, points: impl Fn(f64) -> DVec3, radius: impl Fn(f64) -> f64) {
        let rings: Vec<Ring> = (0..=48)
            .map(|ring| f64::from(ring) / 48.0)
            .map(|t| Ring {
                centre: points(t),
                radius: radius(t) * self.unit,
                weights: vec![(Role::Head, 1.0)],
            })
            .collect();
        let along = (points(1.0) - points(0.0)).normalize();
        shape.tube(along, &rings, true);
    }

    /// A cap over the skull, open before the face.
    fn cap(&self, shape: &mut Shape, bottom: f64) {
        self.sheet(shape, (0.35 * PI, 1.65 * PI), bottom, |_, y| self.lying(y));
    }
}

/// How thick a tail is at a share of it, tied above and tapering to a tuft.
fn tail(t: f64) -> f64 {
    if t == 0.0 || t == 1.0 {
        0.0
    } else {
        0.14 * (0.5 + 0.5 * (8.0 * t).min(1.0)) * (1.0 - 0.85 * t.powi(4))
    }
}

/// `person` with such hair: a mesh of kind hair called `hair`, or a part of the body; tails with a chain of joints.
pub fn with_hair(person: &Person, kind: Kind) -> Character {
    let head = Head { person, unit: person.proportions.head };
    let hips = (person.crotch() + 0.1 * person.proportions.torso - person.chin()) / head.unit;
    let waist = 0.6 * hips;
    let (mut shape, mut chains) = (Shape { columns: 12, ..Shape::default() }, Vec::new());
    let around = (0.38 * PI, 1.62 * PI);
    match kind {
        Kind::Straight | Kind::OneSkin => head.sheet(&mut shape, around, hips, |_, y| head.lying(y)),
        Kind::Draped => {
            let (leaves, lies) = (0.5, (person.shoulder_line() - person.chin()) / head.unit - 0.3);
            head.sheet(&mut shape, around, waist, |_, y| {
                let t = ((leaves - y) / (leaves - lies)).min(1.0);
                let drapes = head.lying(leaves) + (head.lying(lies) - head.lying(leaves)) * t;
                if t > 0.0 { drapes.max(head.lying(y)) } else { head.lying(y) }
            });
        }
        Kind::Waves => head.sheet(&mut shape, around, hips, |angle, y| {
            let wave = (10.0 * y).sin() * (6.0 * angle).cos().abs();
            head.lying(y) + 0.05 * wave * (0.5 - y).clamp(0.0, 1.0)
        }),
        Kind::Cards => {
            for card in 0..24 {
                let middle = around.0 + (around.1 - around.0) * (f64::from(card) + 0.5) / 24.0;
                let bottom = hips + 0.25 * f64::from(card % 3);
                let out = 0.015 * f64::from(card % 4);
                let mut strip = Shape::default();
                head.sheet(&mut strip, (middle - 0.11, middle + 0.11), bottom, |_, y| head.lying(y) + out);
                append(&mut shape, &strip);
            }
        }
        Kind::Bob => {
            head.cap(&mut shape, -0.1);
            let end = head.at(0.7 * head.half() + 0.25, 0.6 * hips.max(-1.2), 0.9 * head.half() + 0.2);
            let start = head.at(0.9 * head.half(), 0.5, 0.6 * head.half());
            head.rope(&mut shape, |t| start.lerp(end, t), |t| 0.6 * tail(t));
        }
        Kind::SideLocks => {
            head.cap(&mut shape, 0.1);
            for side in [1.0, -1.0] {
                let x = side * head.half();
                let front = |y: f64| head.body(y).max(head.half()) + 0.12;
                let point = move |t: f64| 0.5 + (waist - 0.5) * t;
                head.rope(
                    &mut shape,
                    |t| {
                        let y = point(t);
                        head.at(
                            0.9 * x,
                            y,
                            (front(y).powi(2) - (0.9 * x).powi(2)).max(0.0).sqrt().max(0.4 * head.half()),
                        )
                    },
                    |t| 0.7 * tail(t),
                );
            }
        }
        Kind::TwinTails | Kind::OneTail | Kind::Braid => {
            head.cap(&mut shape, 0.1);
            let bottom = if kind == Kind::TwinTails { hips } else { waist };
            let sides: &[f64] = if kind == Kind::TwinTails { &[1.0, -1.0] } else { &[0.0] };
            for &side in sides {
                let start = if side == 0.0 {
                    head.at(0.0, 0.6, -1.1 * head.half())
                } else {
                    head.at(1.1 * side * head.half(), 0.75, 0.0)
                };
                let end = if side == 0.0 {
                    head.at(0.0, bottom, -head.body(bottom) - 0.2)
                } else {
                    head.at(side * (head.body(bottom) + 0.5), bottom, -0.1)
                };
                let out = if side == 0.0 { DVec3::NEG_Z } else { DVec3::X * side };
                let path = move |t: f64| start.lerp(end, t) + out * head.unit * 0.5 * (PI * t).sin() * 0.5;
                let bulge = |t: f64| {
                    if kind == Kind::Braid && t < 0.85 { 1.0 + 0.25 * (30.0 * t).sin() } else { 1.0 }
                };
                head.rope(&mut shape, path, |t| tail(t) * bulge(t));
                for tie in [0.06, 0.85] {
                    let (from, to) = (path(tie - 0.015), path(tie + 0.015));
                    let ring = |t: f64| if t == 0.0 || t == 1.0 { 0.0 } else { 1.25 * tail(tie) };
                    head.rope(&mut shape, |t| from.lerp(to, t), ring);
                }
                chains.push((0..5).map(|joint| path(0.24 * f64::from(joint) + 0.02)).collect::<Vec<DVec3>>());
            }
        }
    }
    attach(person, kind, shape, &chains)
}

fn append(shape: &mut Shape, more: &Shape) {
    let first = shape.positions.len() as u32;
    shape.positions.extend(&more.positions);
    shape.weights.extend(more.weights.iter().cloned());
    shape.triangles.extend(more.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
}

/// The person with this hair, which chains of joints move where it is near them.
fn attach(person: &Person, kind: Kind, shape: Shape, chains: &[Vec<DVec3>]) -> Character {
    let mut character = person.build();
    let place = |p: DVec3| glam::DMat3::from_rotation_y(person.facing.to_radians()) * p * person.unit;
    let head = character.humanoid.joint(Role::Head).unwrap();
    let mut joints: Vec<(usize, DVec3)> = Vec::new();
    for chain in chains {
        let mut parent = head;
        for (number, &at) in chain.iter().enumerate() {
            joints.push((character.skeleton.joints.len(), at));
            character.skeleton.joints.push(Joint {
                name: format!("hair_{}_{number}", joints.len()),
                parent: Some(parent),
                rest: glam::DMat4::from_translation(place(at)),
            });
            parent = character.skeleton.joints.len() - 1;
        }
    }
    let reach = 0.35 * person.proportions.head;
    let rows = shape.positions.iter().map(|p| {
        let nearest =
            joints.iter().map(|&(joint, at)| (p.distance(at), joint)).min_by(|a, b| a.0.total_cmp(&b.0));
        match nearest {
            Some((away, joint)) if away < reach => vec![(joint as u32, 1.0f32)],
            _ => vec![(head as u32, 1.0f32)],
        }
    });
    let positions: Vec<_> = shape.positions.iter().map(|&p| place(p).as_vec3()).collect();
    let normals: Vec<_> = shape.normals().into_iter().map(|n| (place(n) / person.unit).as_vec3()).collect();
    if kind == Kind::OneSkin {
        let body = &mut character.meshes[0];
        let first = body.positions.len() as u32;
        let all: Vec<Vec<(u32, f32)>> = body.weights.rows().map(<[_]>::to_vec).chain(rows).collect();
        body.weights = Weights::from_rows(all);
        body.positions.extend(positions);
        body.normals.extend(normals);
        body.triangles.extend(shape.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        return character;
    }
    character.meshes.push(Mesh {
        name: "hair".to_string(),
        kind: Some(MeshKind::Hair),
        weights: Weights::from_rows(rows),
        normals,
        positions,
        triangles: shape.triangles,
        ..Mesh::default()
    });
    character
}

/// The vertices of hair, over all meshes: those of the mesh, or the last of the body's.
pub fn vertices(character: &Character, person: &Person, kind: Kind) -> std::ops::Range<usize> {
    let count =
        |character: &Character| character.meshes.iter().map(|mesh| mesh.positions.len()).sum::<usize>();
    let without = person.build();
    if kind == Kind::OneSkin {
        without.meshes[0].positions.len()..character.meshes[0].positions.len()
    } else {
        count(&without)..count(character)
    }
}
