//! What is fuzzed, and what the targets share: bytes read as choices and numbers, small meshes made from them, and a
//! figure with joints.
#![allow(missing_docs)]

pub mod abi;
pub mod glb;
pub mod meshes;

use glam::{DMat4, DVec3, Vec3};
use std::io::Write as _;
use superdeform::{Character, Joint, Mesh, MeshKind, Role, Weights};

/// Bytes that are used up; then everything is 0.
pub struct Bytes<'a>(pub &'a [u8]);

impl Bytes<'_> {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes([(); 4].map(|()| self.byte()))
    }

    pub fn u64(&mut self) -> u64 {
        u64::from_le_bytes([(); 8].map(|()| self.byte()))
    }

    /// 0 to `count` - 1.
    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count.max(1)
    }

    /// In one of 256 cases for each of `in_256`.
    pub fn chance(&mut self, in_256: u8) -> bool {
        self.byte() < in_256
    }

    pub fn of<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len())]
    }

    /// A number such as hosts give: -8 to 8 in steps of 1/16.
    pub fn tame(&mut self) -> f64 {
        f64::from(self.byte() as i8) / 16.0
    }

    /// Any number, often one at the edge of something.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            0..128 => self.tame(),
            128..140 => 0.0,
            140..150 => f64::from_bits(self.u64()),
            150..160 => f64::from(f32::from_bits(self.u32())),
            _ => self.of(&[
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
                1e300,
                -1e300,
                1e-310,
                f64::MIN_POSITIVE,
                1e30,
                -1e30,
                1e38,
                1e-30,
                1e-40,
                f64::MAX,
                -0.0,
                f64::from(f32::MAX),
                0.5,
            ]),
        }
    }

    /// As [`Bytes::number`], but finite as single precision, up to 1e30.
    pub fn finite(&mut self) -> f32 {
        let number = self.number() as f32;
        if number.is_finite() { number.clamp(-1e30, 1e30) } else { 0.0 }
    }

    pub fn point(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.tame() as f32))
    }

    /// Bytes until a 0 or `most`, with names that mean something among them.
    pub fn text(&mut self, most: usize) -> Vec<u8> {
        const NAMES: &[&str] = &[
            "",
            "Body",
            "Hair_01",
            "hat",
            "skirt",
            "eyeball",
            "head",
            "torso",
            "upper_arm",
            "finger",
            "mine",
            "mixamorig:Hips",
            "J_Bip_C_Head",
            "LeftUpLeg",
            "RightArm",
            "thigh.L",
            "\u{fffd}髪",
            "neck",
            "hips",
        ];
        match self.byte() {
            0..200 => NAMES[self.below(NAMES.len())].as_bytes().to_vec(),
            _ => {
                let length = self.below(most);
                (0..length).map(|_| self.byte()).take_while(|&byte| byte != 0).collect()
            }
        }
    }
}

/// A tube of `rings` rings with `columns` vertices each, closed at both ends where `closed`.
pub fn tube(from: Vec3, to: Vec3, radius: f32, columns: usize, rings: usize, closed: bool) -> Mesh {
    let along = to - from;
    let side = along.any_orthogonal_vector().normalize_or(Vec3::X);
    let other = along.cross(side).normalize_or(Vec3::Y);
    let mut mesh = Mesh::default();
    for ring in 0..rings {
        let centre = from + along * (ring as f32 / (rings.max(2) - 1) as f32);
        for column in 0..columns {
            let angle = column as f32 / columns as f32 * std::f32::consts::TAU;
            mesh.positions.push(centre + (side * angle.cos() + other * angle.sin()) * radius);
        }
    }
    let at = |ring: usize, column: usize| (ring * columns + column % columns) as u32;
    for ring in 1..rings {
        for column in 0..columns {
            let [a, b] = [at(ring - 1, column), at(ring - 1, column + 1)];
            let [c, d] = [at(ring, column), at(ring, column + 1)];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    if closed && rings > 0 {
        for column in 1..columns.saturating_sub(1) {
            mesh.triangles.push([at(0, 0), at(0, column + 1), at(0, column)]);
            mesh.triangles.push([at(rings - 1, 0), at(rings - 1, column), at(rings - 1, column + 1)]);
        }
    }
    mesh
}

/// Role, parent, joint, tip, radius.
type Limb = (Role, Option<usize>, [f32; 3], [f32; 3], f32);

/// The limbs of a figure.
const LIMBS: [Limb; 11] = [
    (Role::Hips, None, [0.0, 1.0, 0.0], [0.0, 1.15, 0.0], 0.14),
    (Role::Chest, Some(0), [0.0, 1.15, 0.0], [0.0, 1.42, 0.0], 0.15),
    (Role::Neck, Some(1), [0.0, 1.42, 0.0], [0.0, 1.52, 0.0], 0.05),
    (Role::Head, Some(2), [0.0, 1.52, 0.0], [0.0, 1.78, 0.0], 0.11),
    (Role::LeftUpperArm, Some(1), [0.18, 1.4, 0.0], [0.45, 1.4, 0.0], 0.05),
    (Role::LeftLowerArm, Some(4), [0.45, 1.4, 0.0], [0.75, 1.4, 0.0], 0.04),
    (Role::RightUpperArm, Some(1), [-0.18, 1.4, 0.0], [-0.45, 1.4, 0.0], 0.05),
    (Role::RightLowerArm, Some(6), [-0.45, 1.4, 0.0], [-0.75, 1.4, 0.0], 0.04),
    (Role::LeftUpperLeg, Some(0), [0.1, 0.95, 0.0], [0.1, 0.5, 0.0], 0.08),
    (Role::LeftFoot, Some(8), [0.1, 0.08, 0.0], [0.1, 0.03, 0.15], 0.05),
    (Role::RightUpperLeg, Some(0), [-0.1, 0.95, 0.0], [-0.1, 0.0, 0.0], 0.08),
];

/// A figure of tubes, with joints and weights; each limb is a mesh of its own, or all are one.
pub fn figure(columns: usize, rings: usize, closed: bool, one_mesh: bool) -> Character {
    let mut character = Character::default();
    let mut whole = Mesh::default();
    let mut rows: Vec<[(u32, f32); 1]> = Vec::new();
    for (index, (role, parent, from, to, radius)) in LIMBS.into_iter().enumerate() {
        let [from, to] = [from, to].map(Vec3::from_array);
        let rest = DMat4::from_translation(from.as_dvec3());
        character.skeleton.joints.push(Joint { name: role.to_string(), parent, rest });
        character.humanoid.set(role, index);
        let mut limb = tube(from, to, radius, columns, rings, closed);
        if one_mesh {
            let first = whole.positions.len() as u32;
            whole.triangles.extend(limb.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
            rows.extend(limb.positions.iter().map(|_| [(index as u32, 1.0)]));
            whole.positions.append(&mut limb.positions);
        } else {
            limb.name = role.to_string();
            limb.kind = Some(MeshKind::Body);
            limb.weights = Weights::rigid(index as u32, limb.positions.len());
            character.meshes.push(limb);
        }
    }
    if one_mesh {
        whole.weights = Weights::from_rows(rows);
        character.meshes.push(whole);
    }
    character
}

/// A small mesh of any shape, without weights.
pub fn shape(bytes: &mut Bytes) -> Mesh {
    let mut mesh = match bytes.below(6) {
        0 => {
            let (from, to) = (bytes.point(), bytes.point());
            let radius = bytes.byte() as f32 / 64.0;
            let (columns, rings) = (bytes.below(9), bytes.below(7));
            tube(from, to, radius, columns, rings, bytes.chance(128))
        }
        1 => {
            let (corner, right, up) = (bytes.point(), bytes.point(), bytes.point());
            let (columns, rows) = (1 + bytes.below(7), 1 + bytes.below(7));
            let at = |row: usize, column: usize| (row * (columns + 1) + column) as u32;
            let mut mesh = Mesh::default();
            for row in 0..=rows {
                for column in 0..=columns {
                    let (u, v) = (column as f32 / columns as f32, row as f32 / rows as f32);
                    mesh.positions.push(corner + right * u + up * v);
                }
            }
            for row in 0..rows {
                for column in 0..columns {
                    let [a, b] = [at(row, column), at(row, column + 1)];
                    let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
                    mesh.triangles.extend([[a, b, d], [a, d, c]]);
                }
            }
            mesh
        }
        // Points alone, in one place or in any.
        2 => {
            let at = bytes.point();
            let count = bytes.below(40);
            let together = bytes.chance(100);
            let positions = (0..count).map(|_| if together { at } else { bytes.point() }).collect();
            Mesh { positions, ..Mesh::default() }
        }
        3 => {
            let count = bytes.below(24);
            let positions: Vec<Vec3> =
                (0..count).map(|_| Vec3::from_array([(); 3].map(|()| bytes.finite()))).collect();
            let mut mesh = Mesh { positions, ..Mesh::default() };
            if count > 0 {
                let triangles = bytes.below(40);
                mesh.triangles =
                    (0..triangles).map(|_| [(); 3].map(|()| bytes.below(count) as u32)).collect();
            }
            mesh
        }
        _ => {
            let (columns, rings) = (3 + bytes.below(6), 2 + bytes.below(4));
            let mut whole = figure(columns, rings, bytes.chance(128), true).meshes.remove(0);
            whole.weights = Weights::default();
            whole
        }
    };
    // Some vertices are torn out, some triangles lose their area.
    if !mesh.positions.is_empty() {
        for _ in 0..bytes.below(8).saturating_sub(3) {
            let vertex = bytes.below(mesh.positions.len());
            let axis = bytes.below(3);
            mesh.positions[vertex][axis] = bytes.finite();
        }
        if !mesh.triangles.is_empty() {
            for _ in 0..bytes.below(8).saturating_sub(4) {
                let triangle = bytes.below(mesh.triangles.len());
                mesh.triangles[triangle][bytes.below(3)] = bytes.below(mesh.positions.len()) as u32;
            }
        }
    }
    match bytes.byte() {
        0..190 => {}
        190..210 => scale(&mut mesh, bytes.finite()),
        210..220 => scale(&mut mesh, 1e30),
        220..230 => scale(&mut mesh, 1e-30),
        230..240 => scale(&mut mesh, 1e-42),
        240..246 => mesh.positions.iter_mut().for_each(|p| *p += Vec3::splat(1e6)),
        _ => {
            let axis = bytes.below(3);
            mesh.positions.iter_mut().for_each(|p| p[axis] = 0.0);
        }
    }
    mesh
}

fn scale(mesh: &mut Mesh, by: f32) {
    for p in &mut mesh.positions {
        *p = (*p * by).clamp(Vec3::splat(-1e30), Vec3::splat(1e30));
    }
}

/// Weights of any joints for `count` vertices.
pub fn weights(bytes: &mut Bytes, count: usize, joint_count: usize) -> Weights {
    if joint_count == 0 || bytes.chance(60) {
        return Weights::default();
    }
    if bytes.chance(80) {
        return Weights::rigid(bytes.below(joint_count) as u32, count);
    }
    let period = 1 + bytes.below(8);
    let rows: Vec<Vec<(u32, f32)>> = (0..period)
        .map(|_| {
            let influences = bytes.below(5);
            (0..influences).map(|_| (bytes.below(joint_count) as u32, bytes.finite().abs())).collect()
        })
        .collect();
    Weights::from_rows((0..count).map(|vertex| rows[vertex % period].iter().copied()))
}

/// A place for a joint, at rest: turned and scaled at times.
pub fn rest(bytes: &mut Bytes) -> DMat4 {
    let at = DVec3::from_array([(); 3].map(|()| bytes.tame() / 4.0));
    match bytes.byte() {
        0..200 => DMat4::from_translation(at),
        200..220 => DMat4::from_translation(at) * DMat4::from_rotation_x(bytes.tame()),
        220..240 => DMat4::from_scale(DVec3::splat(bytes.finite().into())) * DMat4::from_translation(at),
        _ => DMat4::from_cols_array(&[(); 16].map(|()| bytes.finite().into())),
    }
}

/// What one input may cost, in seconds of the processor: on a machine that does other things too, the clock tells less.
/// A rig of a random figure in a build that is hardly optimised takes seconds, most of it in volumes of cells; under
/// AddressSanitizer fresh memory costs several times as much.
const MOST_SECONDS: f64 = if cfg!(fuzzing) { 60.0 } else { 10.0 };

/// Runs `work` and ends the process where that took too long. What never ends is left to the fuzzer's own clock.
pub fn in_time(work: impl FnOnce()) {
    unsafe extern "C" {
        /// Of C: microseconds of the processor that the process has used, on any POSIX system.
        safe fn clock() -> std::ffi::c_long;
    }
    let start = clock();
    work();
    let seconds = (clock() - start) as f64 / 1e6;
    assert!(seconds < MOST_SECONDS, "took {seconds:.1} seconds");
}

/// Ends the process with the place of a panic, wherever it is caught.
pub fn panics_abort() {
    let tell = |info: &std::panic::PanicHookInfo| {
        let trace = std::backtrace::Backtrace::force_capture();
        // Not eprintln: what a test prints is held back, and lost with the process.
        let _ = writeln!(std::io::stderr(), "{info}\n{trace}");
        std::process::abort();
    };
    std::panic::set_hook(Box::new(tell));
}
