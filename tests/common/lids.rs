//! Eyes as they are seen from the front: how much lids leave of them, and blinks for faces that have none.

use glam::{DVec2, DVec3, Vec3};
use superdeform::internals::face::eyes::{Eye, closes_an_eye};
use superdeform::internals::face::raster::{DepthMap, Window};
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::face_input::head_frame;
use superdeform::{Character, MeshKind, MorphTarget, Role};

/// Squares across an eye.
const SQUARES: f64 = 90.0;

/// What is seen of an eye.
pub struct Seen {
    columns: usize,
    rows: usize,
    is_eye: Vec<bool>,
}

impl Seen {
    /// How many squares show the eye.
    pub fn count(&self) -> usize {
        self.is_eye.iter().filter(|&&is| is).count()
    }

    /// How many squares show the eye of which no neighbour did in `rest`.
    pub fn outside(&self, rest: &Self) -> usize {
        let near = |column: usize, row: usize| {
            let rows = row.saturating_sub(1)..(row + 2).min(rest.rows);
            rows.flat_map(|row| {
                (column.saturating_sub(1)..(column + 2).min(rest.columns)).map(move |column| (column, row))
            })
            .any(|(column, row)| rest.is_eye[row * rest.columns + column])
        };
        let squares = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        squares
            .filter(|&(column, row)| self.is_eye[row * self.columns + column] && !near(column, row))
            .count()
    }
}

/// One eye's triangles and those that may hide it, of a figure whose vertices move.
pub struct View {
    triangles: Vec<[u32; 3]>,
    is_eye: Vec<bool>,
    window: Window,
}

impl View {
    /// The eye of these vertices, ascending.
    pub fn new(figure: &Figure, points: &[DVec3], eye: &[u32]) -> Self {
        let is_seen = |vertex: u32| {
            let vertex = vertex as usize;
            figure.weight_of(vertex, Role::is_head) > 0.5
                && !matches!(figure.kind(vertex), MeshKind::Hair | MeshKind::Accessory)
        };
        let triangles: Vec<[u32; 3]> =
            figure.triangles.iter().filter(|corners| corners.iter().all(|&c| is_seen(c))).copied().collect();
        let of_eye = |corners: &[u32; 3]| corners.iter().all(|corner| eye.binary_search(corner).is_ok());
        let ends = eye.iter().map(|&vertex| points[vertex as usize].truncate());
        let (low, high) =
            ends.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let margin = 0.3 * (high - low);
        Self {
            is_eye: triangles.iter().map(of_eye).collect(),
            triangles,
            window: Window { low: low - margin, high: high + margin, step: (high.x - low.x) / SQUARES },
        }
    }

    /// What is seen with the vertices at `points`.
    pub fn seen(&self, points: &[DVec3]) -> Seen {
        let map = DepthMap::new(points, &self.triangles, self.window);
        let (columns, rows) = (map.columns(), map.rows());
        let is_eye = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| map.triangle(column, row).is_some_and(|triangle| self.is_eye[triangle]))
            .collect();
        Seen { columns, rows, is_eye }
    }
}

/// The eyes of a face whose eyes are pieces.
pub fn eyes(measured: &Measured) -> Vec<&Eye> {
    let eyes = measured.face.as_ref().and_then(|face| face.eyes.as_ref());
    eyes.iter().flat_map(|(_, eyes)| eyes).filter(|eye| eye.ball.is_some()).collect()
}

/// The figure's vertices with all morph targets that close an eye at this weight; canonical frame.
pub fn closed(figure: &Figure, character: &Character, weight: f64) -> Vec<DVec3> {
    let mut points = figure.positions.clone();
    for (mesh, &start) in character.meshes.iter().zip(&figure.mesh_starts) {
        // One of the models calls its blink so.
        let closes = |name: &str| closes_an_eye(name) || name == "close";
        for target in mesh.morph_targets.iter().filter(|target| closes(&target.name)) {
            for (vertex, delta) in target.positions.iter().enumerate() {
                points[start + vertex] += weight * figure.frame.to_canonical(delta.as_dvec3());
            }
        }
    }
    points
}

/// `character` with a blink: skin above each eye's middle goes down to the lower lid, along the ball and a little before it.
pub fn with_blink(character: &Character, measured: &Measured) -> Character {
    let figure = &measured.figure;
    let frame = head_frame(&measured.anatomy);
    let mut deltas = vec![DVec3::ZERO; figure.positions.len()];
    for eye in eyes(measured) {
        let ball = eye.ball.as_ref().expect("these have one");
        let (middle, radius) = (eye.middle(), eye.radius());
        let (a, b) = (eye.half_width(), eye.half_height());
        for (vertex, &p) in figure.positions.iter().enumerate() {
            let is_skin = matches!(figure.kind(vertex), MeshKind::Body | MeshKind::FacePart);
            if !is_skin || figure.weight_of(vertex, Role::is_head) < 0.5 {
                continue;
            }
            let from = frame.to_unit(p);
            let aside = (from.x - middle.x) / (1.15 * a);
            let up = (from.y - middle.y) / b;
            if aside.abs() >= 1.0 || !(-0.2..4.0).contains(&up) || from.z < ball.centre.z {
                continue;
            }
            // Half the opening's height there, as of an ellipse; all of it closes up to a half height above the lid's edge.
            let half = b * (1.0 - aside * aside).sqrt();
            let fades = (1.0 - (up - 1.5).max(0.0) / 2.5).clamp(0.0, 1.0);
            let mut to = from - DVec3::Y * 2.2 * half * fades;
            // Half closed, a lid is half of the way, which must clear the ball too.
            let before = |p: glam::DVec2| {
                let arm = p - ball.centre.truncate();
                ball.centre.z + 1.04 * (radius * radius - arm.length_squared()).max(0.0).sqrt()
            };
            let half_way = 0.5 * (from + to);
            to.z = to.z.max(before(to.truncate()));
            to.z = to.z.max(2.0 * before(half_way.truncate()) - from.z);
            deltas[vertex] = frame.length * (to - from);
        }
    }
    let mut character = character.clone();
    for (mesh, &start) in character.meshes.iter_mut().zip(&figure.mesh_starts) {
        let of_mesh = &deltas[start..start + mesh.positions.len()];
        if of_mesh.iter().all(|&delta| delta == DVec3::ZERO) {
            continue;
        }
        let positions: Vec<Vec3> =
            of_mesh.iter().map(|&delta| figure.frame.to_model(delta).as_vec3()).collect();
        mesh.morph_targets.push(MorphTarget { name: "blink".into(), positions, ..MorphTarget::default() });
    }
    character
}

/// The figure's vertices with the balls of `eyes` turned about their joints: `yaw` to the character's left, `pitch` up.
pub fn turned(figure: &Figure, points: &[DVec3], eyes: &[&Eye], yaw: f64, pitch: f64) -> Vec<DVec3> {
    let mut points = points.to_vec();
    let turn = glam::DQuat::from_rotation_y(yaw) * glam::DQuat::from_rotation_x(-pitch);
    for (eye, role) in eyes.iter().zip([Role::LeftEye, Role::RightEye]) {
        let (Some(ball), Some(joint)) = (&eye.ball, figure.role_position(role)) else { continue };
        for &vertex in &ball.vertices {
            let p = &mut points[vertex as usize];
            *p = joint + turn * (*p - joint);
        }
    }
    points
}
