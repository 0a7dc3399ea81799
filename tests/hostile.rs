//! Figures that no artist made: whatever comes in, an error or finite numbers come out, and nothing panics.

#[path = "common/people.rs"]
mod people;

use glam::{DMat4, DVec3, Vec3};
use people::Person;
use std::sync::Arc;
use superdeform::internals::shape::Measured;
use superdeform::{Character, Deformer, Mode, MorphTarget, Options, Role, Style, Weights};

/// A generator of numbers that are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }
}

/// Runs the whole pipeline in both modes; tells what came out as an error, and fails on a number that is not finite.
fn survives(name: &str, character: Character) -> usize {
    let reference = Measured::of(&Person::chibi().build(), &Options::default()).unwrap().shape;
    let character = Arc::new(character);
    let mut results = 0;
    for (mode, style) in [
        (Mode::Product, Style::Shape(Box::new(reference.clone()))),
        (Mode::Product, Style::Heads(2.0)),
        (Mode::Paper, Style::Shape(Box::new(reference))),
    ] {
        let options = Options { mode, ..Options::default() };
        let Ok(deformer) = Deformer::new(Arc::clone(&character), &style, &options) else { continue };
        let deformed = deformer.apply();
        for (index, mesh) in deformed.meshes.iter().enumerate() {
            let deltas = mesh.morph_targets.iter().flat_map(|target| &target.positions);
            for p in mesh.positions.iter().chain(&mesh.normals).chain(deltas) {
                assert!(p.is_finite(), "{name}, {mode:?}: mesh {index} has {p}");
            }
        }
        for (joint, p) in deformed.joints.iter().enumerate() {
            assert!(p.is_finite(), "{name}, {mode:?}: joint {joint} is at {p}");
        }
        // The result may be beyond measuring, but that is an error and no panic.
        let _ = deformer.report(&deformed);
        results += 1;
    }
    results
}

fn adult() -> Character {
    Person { columns: 12, ..Person::adult() }.build()
}

fn moved(mut character: Character, change: impl Fn(DVec3) -> DVec3) -> Character {
    for mesh in &mut character.meshes {
        for p in &mut mesh.positions {
            *p = change(p.as_dvec3()).as_vec3();
        }
    }
    for joint in &mut character.skeleton.joints {
        joint.rest = DMat4::from_translation(change(joint.position()));
    }
    character
}

#[test]
fn a_figure_in_one_point_on_a_line_or_in_a_plane_is_survived() {
    survives("a point", moved(adult(), |_| DVec3::ONE));
    survives("a line along up", moved(adult(), |p| DVec3::new(0.0, p.y, 0.0)));
    survives("a line across", moved(adult(), |p| DVec3::new(p.x, 0.0, 0.0)));
    assert!(survives("a plane", moved(adult(), |p| p.with_z(0.0))) > 0);
    survives("a floor", moved(adult(), |p| p.with_y(0.0)));
    survives("upside down", moved(adult(), |p| DVec3::new(p.x, -p.y, p.z)));
    survives("lying", moved(adult(), |p| DVec3::new(p.x, p.z, -p.y)));
}

#[test]
fn tiny_huge_and_far_away_figures_are_survived() {
    for scale in [1e-12, 1e-6, 1e6, 1e12] {
        assert!(survives(&format!("times {scale}"), moved(adult(), |p| p * scale)) > 0);
    }
    assert!(survives("far away", moved(adult(), |p| p + DVec3::new(1e4, 0.0, -1e4))) > 0);
    survives("beyond single precision", moved(adult(), |p| p * 1e37));
    survives("below single precision", moved(adult(), |p| p * 1e-40));
}

#[test]
fn what_grows_beyond_single_precision_ends_at_its_end() {
    // The back of the head is the end of the range, and the head grows.
    let adult = adult();
    let head = adult.humanoid.joint(Role::Head).unwrap();
    let body = adult.meshes.iter().flat_map(|mesh| mesh.positions.iter().zip(mesh.weights.rows()));
    let of_head = body.filter(|(_, row)| row.iter().any(|&(joint, _)| joint as usize == head));
    let back = f64::from(of_head.map(|(p, _)| p.z).fold(f32::INFINITY, f32::min));
    let end = f64::from(f32::MIN);
    let at_the_end = moved(adult, |p| (p * 1e37).with_z(((p.z - back) * 1e37 + end).max(end)));
    assert!(survives("the end of the range", at_the_end.clone()) > 0);
    let deformer = Deformer::new(Arc::new(at_the_end), &Style::Heads(2.0), &Options::default()).unwrap();
    let deformed = deformer.apply();
    assert!(deformed.meshes.iter().flat_map(|mesh| &mesh.positions).any(|p| p.z == f32::MIN));
}

#[test]
fn joints_at_random_places_are_survived() {
    let mut numbers = Numbers(1);
    for case in 0..15 {
        let mut character = adult();
        for joint in &mut character.skeleton.joints {
            joint.rest = DMat4::from_translation(numbers.point());
        }
        survives(&format!("random joints {case}"), character);
    }
}

#[test]
fn roles_at_random_joints_are_survived() {
    let mut numbers = Numbers(2);
    for case in 0..15 {
        let mut character = adult();
        let count = character.skeleton.joints.len();
        for role in Role::all() {
            let joint = (numbers.next() * count as f64) as usize;
            character.humanoid.set(role, (numbers.next() < 0.8).then_some(joint));
        }
        survives(&format!("random roles {case}"), character);
    }
}

#[test]
fn weights_and_triangles_at_random_are_survived() {
    let mut numbers = Numbers(3);
    for case in 0..4 {
        let mut character = adult();
        let joint_count = character.skeleton.joints.len();
        for mesh in &mut character.meshes {
            let count = mesh.positions.len();
            // Triangles that all lie across each other are slow to search: a few show as much as many.
            mesh.triangles.truncate(100);
            mesh.weights = Weights::from_rows((0..count).map(|_| {
                let mut entry = || ((numbers.next() * joint_count as f64) as u32, numbers.next() as f32);
                [entry(), entry(), entry()]
            }));
            for corners in &mut mesh.triangles {
                *corners = [0; 3].map(|_| (numbers.next() * count as f64) as u32);
            }
            mesh.normals = (0..count).map(|_| numbers.point().as_vec3()).collect();
            mesh.morph_targets = vec![MorphTarget {
                name: "any".to_string(),
                positions: (0..count).map(|_| numbers.point().as_vec3()).collect(),
                ..MorphTarget::default()
            }];
        }
        assert!(survives(&format!("random weights {case}"), character) > 0);
    }
}

#[test]
fn figures_that_lack_almost_everything_are_survived() {
    let adult = adult();
    let mut one_triangle = adult.clone();
    one_triangle.meshes.truncate(1);
    one_triangle.meshes[0].triangles.truncate(1);
    survives("one triangle", one_triangle);

    for kept in [Role::Head, Role::Hips, Role::LeftFoot, Role::RightUpperArm] {
        let mut figure = adult.clone();
        let joint = figure.humanoid.joint(kept).unwrap() as u32;
        for mesh in &mut figure.meshes {
            mesh.weights = Weights::rigid(joint, mesh.positions.len());
        }
        assert!(survives(&format!("everything moves with {kept}"), figure) > 0);
    }

    let mut unweighted = adult.clone();
    unweighted.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
    assert!(survives("no weights", unweighted) > 0);

    let mut bare = adult.clone();
    bare.meshes.iter_mut().for_each(|mesh| {
        mesh.normals.clear();
        mesh.tangents.clear();
    });
    assert!(survives("no normals", bare) > 0);

    let mut empty_mesh = adult;
    empty_mesh.meshes.push(superdeform::Mesh::default());
    assert!(survives("an empty mesh", empty_mesh) > 0);
    assert_eq!(survives("nothing at all", Character::default()), 0);
}

#[test]
fn axes_that_fit_nothing_are_survived() {
    let mut character = adult();
    character.axes.up = Vec3::new(0.3, 0.1, -0.9);
    survives("up is askew", character.clone());
    character.axes.forward = Some(Vec3::X);
    survives("forward is askew", character);
}
