//! Whether results have their reference's body, measured on the files that were written, by another rule than the map's:
//!
//!     cargo run --release -p superdeform-benches --example bodies -- [--before EXECUTABLE] [--out FOLDER] [--only TEXT]
//!
//! EXECUTABLE is another build of the example, whose crossings are the measure for those of this one. Gives seven targets
//! three references, writes them to FOLDER, reads them again, and prints a line for each pair and the shares that count:
//!
//! - torso, arms, legs: the surrounding-mesh radius of §V-A of the result over the reference's, each in its own heads; 48
//!   rays around each sample, each the furthest hit within 1.35 times its nearest one, so that thin layers count and cloth
//!   that stands far off does not;
//! - flips: triangles of the result that look the other way than the target's, and those of the head among them;
//! - legs: edges of one leg through the other; arms: edges of forearms and hands through the trunk; cloth: edges of clothes
//!   through the body; each less what the target has, and cloth beside what the other build gives.
//!
//! The files are looked for as the other benchmarks do.

use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use superdeform::internals::character::bones::Group;
use superdeform::internals::geometry::Surface;
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::product::profile::{LegProfile, Profile, Row, STATIONS, flesh};
use superdeform::{Character, MeshKind, Role};
use superdeform::{Deformer, Options, Style};

#[allow(unused_imports)] // By the models.
use superdeform_benches::body_of_capsules;

#[allow(dead_code)]
mod models;

const TARGETS: [&str; 7] = [
    "makehuman_female_rigged.glb",
    "seedsan_vrm1.vrm",
    "quaternius_female_dress.glb",
    "quaternius_female_casual.glb",
    "quaternius_male_casual.glb",
    "valid_hispanic_f_2_casual.glb",
    "valid_black_m_2_busi.glb",
];
const REFERENCES: [&str; 3] = ["kaykit_rogue.glb", "godette.vrm", "makehuman_baby_reference.glb"];
const GROUPS: [Group; 5] = [Group::Torso, Group::UpperArm, Group::LowerArm, Group::UpperLeg, Group::LowerLeg];

/// Rays around each sample, where the samples of a bone are, and how much further than the nearest hit a layer may be.
const RAYS: usize = 48;
const SAMPLES: [f64; 3] = [0.25, 0.5, 0.75];
const LAYERS: f64 = 1.35;
/// What is this many times as far as usual around a sample is another part of the body.
const ELSEWHERE: f64 = 2.0;
/// A ray goes on this much behind a hit, as a part of the figure's height.
const BEHIND: f64 = 1e-6;
/// A sample that fewer of its rays meet is not surrounded.
const LEAST_HITS: usize = RAYS / 2;

/// A figure and its surface.
struct Figure {
    measured: Measured,
    dressed: Surface,
}

impl Figure {
    fn of(character: &Character) -> Self {
        let measured = Measured::of(character, &Options::default()).expect("the figure can be measured");
        let figure = &measured.figure;
        let dressed = figure.triangles_where(|vertex| !figure.is_carried(vertex));
        let dressed = Surface::new(&figure.positions, &dressed);
        Self { measured, dressed }
    }

    fn read(path: &Path) -> Self {
        Self::of(&models::load(path).character)
    }

    fn head_length(&self) -> f64 {
        self.measured.anatomy.landmarks.heights.head_length()
    }

    /// The radius of torso, arms and legs, in heads: of the limbs about their bones, legs from the crotch down; of the torso
    /// about the line from there to the shoulder line, as artists put the joints in between where they like.
    fn radii(&self) -> BTreeMap<Group, f64> {
        use Role::*;
        let anatomy = &self.measured.anatomy;
        let marks = &anatomy.landmarks.heights;
        let middle =
            |role: Role| 0.5 * (self.measured.joints[&role] + self.measured.joints[&role.mirrored()]);
        let torso =
            (middle(LeftUpperLeg).with_y(marks.crotch), middle(LeftUpperArm).with_y(marks.shoulder_line));
        let mut lines = vec![(Group::Torso, torso)];
        for (index, limb) in anatomy.limbs.iter().enumerate() {
            let [upper, lower] = if index < 2 {
                [Group::UpperArm, Group::LowerArm]
            } else {
                [Group::UpperLeg, Group::LowerLeg]
            };
            lines.extend([(upper, (limb.root, limb.middle)), (lower, (limb.middle, limb.end))]);
        }
        let mut radii: BTreeMap<Group, Vec<f64>> = BTreeMap::new();
        for (group, (from, to)) in lines {
            let samples = SAMPLES.iter().filter_map(|&t| self.radius(from.lerp(to, t), to - from));
            radii.entry(group).or_default().extend(samples);
        }
        let mean = |radii: Vec<f64>| radii.iter().sum::<f64>() / radii.len() as f64 / self.head_length();
        radii
            .into_iter()
            .filter(|(_, radii)| !radii.is_empty())
            .map(|(group, radii)| (group, mean(radii)))
            .collect()
    }

    /// The mean distance of what surrounds `point` to its own middle.
    fn radius(&self, point: DVec3, along: DVec3) -> Option<f64> {
        let along = along.try_normalize()?;
        let side = along.any_orthonormal_vector();
        let other = along.cross(side);
        let hits: Vec<DVec3> = (0..RAYS)
            .filter_map(|ray| {
                let (sin, cos) = (TAU * ray as f64 / RAYS as f64).sin_cos();
                let direction = cos * side + sin * other;
                self.layer(point, direction).map(|reach| point + reach * direction)
            })
            .collect();
        if hits.len() < LEAST_HITS {
            return None;
        }
        let usual = median(&hits.iter().map(|hit| hit.distance(point)).collect::<Vec<_>>());
        let hits: Vec<DVec3> =
            hits.into_iter().filter(|hit| hit.distance(point) <= ELSEWHERE * usual).collect();
        let middle = hits.iter().sum::<DVec3>() / hits.len() as f64;
        Some(hits.iter().map(|hit| hit.distance(middle)).sum::<f64>() / hits.len() as f64)
    }

    /// The furthest hit within [`LAYERS`] times the nearest one.
    fn layer(&self, point: DVec3, direction: DVec3) -> Option<f64> {
        let step = BEHIND * self.measured.figure.height();
        let nearest = self.dressed.first_hit(point, direction, f64::INFINITY)?.t;
        let mut furthest = nearest;
        loop {
            let from = furthest + step;
            match self.dressed.first_hit(point + from * direction, direction, LAYERS * nearest - from) {
                Some(hit) if from < LAYERS * nearest => furthest = from + hit.t,
                _ => return Some(furthest),
            }
        }
    }

    /// Triangles most of whose corners' weights are of `chosen` roles.
    fn moved_by(&self, chosen: impl Fn(Role) -> bool + Copy) -> Vec<[u32; 3]> {
        let figure = &self.measured.figure;
        figure.triangles_where(|vertex| figure.weight_of(vertex, chosen) > 0.5 && !figure.is_carried(vertex))
    }

    /// How many edges of `edges` go through `through`.
    fn crossings(&self, edges: &[[u32; 3]], through: &[[u32; 3]]) -> usize {
        let positions = &self.measured.figure.positions;
        let surface = Surface::new(positions, through);
        let sorted = |a: u32, b: u32| (a.min(b), a.max(b));
        let edges: BTreeSet<(u32, u32)> =
            edges.iter().flat_map(|&[a, b, c]| [sorted(a, b), sorted(b, c), sorted(c, a)]).collect();
        let place = |vertex: u32| positions[vertex as usize];
        edges.iter().filter(|&&(a, b)| surface.is_hit(place(a), place(b) - place(a), 1.0)).count()
    }

    /// Edges of one leg through the other, of forearms and hands through the trunk, of clothes through the body.
    fn all_crossings(&self) -> [usize; 3] {
        use Role::*;
        let left_leg = |role: Role| matches!(role, LeftUpperLeg | LeftLowerLeg | LeftFoot | LeftToes);
        let right_leg = |role: Role| left_leg(role.mirrored());
        let forearm = |role: Role| {
            let arm = if role.is_left() { role } else { role.mirrored() };
            arm == LeftLowerArm || arm.chain().any(|above| above == LeftHand)
        };
        let trunk =
            |role: Role| matches!(role, Hips | Spine | Chest | UpperChest | LeftUpperLeg | RightUpperLeg);
        let figure = &self.measured.figure;
        let of_kind = |kind| figure.triangles_where(|vertex| figure.kind(vertex) == kind);
        [
            self.crossings(&self.moved_by(left_leg), &self.moved_by(right_leg)),
            self.crossings(&self.moved_by(forearm), &self.moved_by(trunk)),
            self.crossings(&of_kind(MeshKind::Garment), &of_kind(MeshKind::Body)),
        ]
    }
}

/// Triangles of `after` that look the other way than in `before`, and those that the head moves among them; slivers a
/// thousand times as long as they are wide face no way.
fn flips(before: &Figure, after: &Figure) -> [usize; 2] {
    let (old, new) = (&before.measured.figure, &after.measured.figure);
    let normal = |positions: &[DVec3], [a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|vertex| positions[vertex as usize]);
        (b - a).cross(c - a)
    };
    let flipped: Vec<[u32; 3]> = old
        .triangles
        .iter()
        .copied()
        .filter(|&corners| {
            let before = normal(&old.positions, corners);
            let [a, b, c] = corners.map(|vertex| old.positions[vertex as usize]);
            let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
            before.length() > 1e-3 * longest && before.dot(normal(&new.positions, corners)) < 0.0
        })
        .collect();
    let of_head = |vertex: u32| old.weight_of(vertex as usize, |role| role == Role::Head) > 0.5;
    let on_face = |corners: &&[u32; 3]| {
        corners.iter().all(|&vertex| of_head(vertex) && !old.is_carried(vertex as usize))
    };
    [flipped.len(), flipped.iter().filter(on_face).count()]
}

/// What [`profile_ratios`] gives.
const PARTS: [&str; 8] = ["torso", "chest", "hips", "hips' flesh", "legs", "arms", "hand", "foot"];

/// The result's profile over the reference's, each in its own heads: means over the slices of the root of breadth and depth;
/// the chest's breadth at the torso's last slice, the hips' at the legs' first one, as it is and without the shorts that only
/// the reference wears; hands by the cube root of their box, feet by
/// the square root of theirs. NaN for what is missing.
fn profile_ratios(wanted: &Profile, got: &Profile) -> [f64; 8] {
    let mean = |got: [&Row; 2], wanted: [&Row; 2]| {
        let ratio = |at: usize| ((got[0][at] * got[1][at]) / (wanted[0][at] * wanted[1][at])).sqrt();
        (0..STATIONS).map(ratio).sum::<f64>() / STATIONS as f64
    };
    let over = |ratio: Option<f64>| ratio.unwrap_or(f64::NAN);
    let torsos = got.torso.as_ref().zip(wanted.torso.as_ref());
    let legs = got.leg.as_ref().zip(wanted.leg.as_ref());
    let arms = got.arm.as_ref().zip(wanted.arm.as_ref());
    let bare = flesh(wanted, got).leg;
    let outer = |leg: &LegProfile| leg.outward[0] + leg.breadth[0];
    let size = |sizes: &[f64]| sizes.iter().product::<f64>().powf(1.0 / sizes.len() as f64);
    [
        over(torsos.map(|(a, b)| mean([&a.breadth, &a.depth], [&b.breadth, &b.depth]))),
        over(torsos.map(|(a, b)| a.breadth[STATIONS - 1] / b.breadth[STATIONS - 1])),
        over(legs.map(|(a, b)| outer(a) / outer(b))),
        over(got.leg.as_ref().zip(bare.as_ref()).map(|(a, b)| outer(a) / outer(b))),
        over(legs.map(|(a, b)| mean([&a.breadth, &a.depth], [&b.breadth, &b.depth]))),
        over(arms.map(|(a, b)| mean([&a.breadth, &a.depth], [&b.breadth, &b.depth]))),
        over(got.hand.zip(wanted.hand).map(|(a, b)| size(&a) / size(&b))),
        over(got.foot.zip(wanted.foot).map(|(a, b)| size(&[a[0] + a[1], a[2]]) / size(&[b[0] + b[1], b[2]]))),
    ]
}

/// Where the result of a pair goes.
fn result_path(target: &Path, reference: &Path, folder: &Path) -> PathBuf {
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let extension = target.extension().unwrap_or_default().to_string_lossy().into_owned();
    folder.join(format!("{}__{}.{extension}", stem(target), stem(reference)))
}

/// What this build gives for a pair, as a file.
fn written(target: &Path, style: &Style, result: &Path) {
    let loaded = models::load(target);
    let character = Arc::new(loaded.character.clone());
    let deformer = Deformer::new(character, style, &Options::default()).expect("the pair can be deformed");
    let bytes = models::write(&loaded, &deformer, &deformer.apply());
    std::fs::write(result, bytes).expect("the file can be written");
}

/// What another build of the example gives for a pair, as a file.
fn written_by(executable: &Path, target: &Path, reference: &Path, result: &Path) {
    let ran = Command::new(executable)
        .args([target, reference])
        .arg("-o")
        .arg(result)
        .args(["--quiet", "--threads", "1"])
        .output()
        .expect("the executable runs");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
}

fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    if values.is_empty() {
        f64::NAN
    } else {
        0.5 * (values[(values.len() - 1) / 2] + values[values.len() / 2])
    }
}

fn share_within(values: &[f64], low: f64, high: f64) -> f64 {
    100.0 * values.iter().filter(|value| (low..=high).contains(*value)).count() as f64 / values.len() as f64
}

struct Arguments {
    before: Option<PathBuf>,
    out: PathBuf,
    only: String,
}

impl Arguments {
    fn read() -> Self {
        let mut arguments = std::env::args().skip(1);
        let mut before = None;
        let mut out = std::env::temp_dir().join("superdeform_bodies");
        let mut only = String::new();
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().expect("the option has a value");
            match argument.as_str() {
                "--before" => before = Some(value().into()),
                "--out" => out = value().into(),
                "--only" => only = value(),
                _ => panic!("bodies [--before EXECUTABLE] [--out FOLDER] [--only TEXT]"),
            }
        }
        Self { before, out, only }
    }
}

fn main() {
    let arguments = Arguments::read();
    let folder = superdeform_host::samples::folder();
    let [now, earlier] = ["now", "before"].map(|name| arguments.out.join(name));
    for folder in [&now, &earlier] {
        std::fs::create_dir_all(folder).expect("the folder can be made");
    }
    let mut ratios: BTreeMap<Group, Vec<f64>> = BTreeMap::new();
    let mut profiles: [Vec<f64>; 8] = Default::default();
    println!(
        "pair: torso, upper arm, lower arm, upper leg, lower leg | profile: torso, chest, hips, their flesh, legs, arms, hand, foot | heads | flips (face) of triangles | legs, arms, cloth (before)"
    );
    for reference_name in REFERENCES {
        let reference_path = folder.join(reference_name);
        let reference = Figure::read(&reference_path);
        let style = Style::Shape(Box::new(reference.measured.shape.clone()));
        for target_name in TARGETS {
            let pair = format!("{target_name} {reference_name}");
            if !pair.contains(&arguments.only) {
                continue;
            }
            let target_path = folder.join(target_name);
            let target = Figure::read(&target_path);
            let path = result_path(&target_path, &reference_path, &now);
            written(&target_path, &style, &path);
            let result = Figure::read(&path);
            let (wanted, got) = (reference.radii(), result.radii());
            let mut line = format!("{pair}:");
            for group in GROUPS {
                match (wanted.get(&group), got.get(&group)) {
                    (Some(wanted), Some(got)) => {
                        line += &format!(" {:.2}", got / wanted);
                        ratios.entry(group).or_default().push(got / wanted);
                    }
                    _ => line += " -",
                }
            }
            line += " |";
            if let (Some(wanted), Some(got)) =
                (&reference.measured.shape.profile, &result.measured.shape.profile)
            {
                for (part, ratio) in profile_ratios(wanted, got).into_iter().enumerate() {
                    line += &format!(" {ratio:.2}");
                    if !ratio.is_nan() {
                        profiles[part].push(ratio);
                    }
                }
            }
            let heads = result.measured.anatomy.landmarks.heights.heads()
                / reference.measured.anatomy.landmarks.heights.heads();
            let [flipped, on_face] = flips(&target, &result);
            line += &format!(
                " | {heads:.2} | {flipped} ({on_face}) of {}",
                target.measured.figure.triangles.len()
            );
            let had = target.all_crossings();
            let has = result.all_crossings();
            let before = match &arguments.before {
                Some(before) => {
                    let path = result_path(&target_path, &reference_path, &earlier);
                    written_by(before, &target_path, &reference_path, &path);
                    Figure::read(&path).all_crossings()
                }
                None => had,
            };
            let new = |which: usize| has[which] as i64 - had[which] as i64;
            line += &format!(" | {:+} {:+} {} ({})", new(0), new(1), has[2], before[2]);
            println!("{line}");
        }
    }
    for (group, ratios) in ratios {
        println!(
            "{group}: median {:.3}, {:.0} % within .9 to 1.1",
            median(&ratios),
            share_within(&ratios, 0.9, 1.1)
        );
    }
    for (part, ratios) in PARTS.iter().zip(profiles) {
        println!(
            "profile of {part}: median {:.3}, {:.0} % within .9 to 1.1 of {}",
            median(&ratios),
            share_within(&ratios, 0.9, 1.1),
            ratios.len()
        );
    }
}
