//! Which way an unrigged figure looks, found from its geometry.
//!
//! Two steps. People are alike on their left and right, and their arms reach to the sides: so the line from right to
//! left is at right angles to the plane through up in which the figure mirrors best, the wider the better. Which of the
//! two ways along that plane is forward, feet and face tell.

use super::front_votes::front_vote;
use crate::character::kinds::{MeshNames, kinds_from_names};
use crate::character::{Character, Mesh, MeshKind};
use crate::error::Warning;
use crate::geometry::{bounds, range};
use glam::{DMat3, DVec2, DVec3, Vec3, Vec3Swizzles, Vec4};

/// Cells along the longest side of the box in which the figure is compared with its mirror image. Seen: at -30 %, five
/// fewer of 115 poses warned of.
const CELL_COUNT: usize = 64;

/// About so many cells are compared with their mirror image. Seen: ±30 % changes no direction.
const COMPARED: usize = 600;

/// Degrees between the planes of the first sweep. Seen: ±30 % turns directions by under half a degree.
const SWEEP_STEP: usize = 3;

/// Planes of one angle in the first sweep: how many cells they lie from the middle, which what is on one side alone
/// pulls off the plane. Seen: ±30 % changes no direction.
const SWEEP_OFFSETS: [f64; 9] = [0.0, -2.0, 2.0, -4.0, 4.0, -6.0, 6.0, -8.0, 8.0];

/// The best plane is turned by ever smaller angles, down to this many degrees. Seen: ±30 % turns directions by under
/// half a degree.
const LEAST_TURN: f64 = 0.05;

/// How much the share of a figure's width counts beside its likeness (0..1) to its mirror image. Seen: ±30 % turns
/// directions by under half a degree.
const WIDTH_WEIGHT: f64 = 0.5;

/// Files stand along the axes: within this many degrees of one it is taken. Seen: ±30 % changes no direction.
const SNAP_ANGLE: f64 = 3.0;

/// A figure less like its mirror image than this has no left and right to be sure of. Seen: ±30 % changes no direction.
const LEAST_LIKENESS: f64 = 0.45;

/// A plane at more than this many degrees from the best one is another one. Seen: ±30 % changes no direction.
const APART_ANGLE: f64 = 30.0;

/// Another plane that scores this near to the best one could as well be the right one. Seen: ±30 % changes no direction.
const LEAST_MARGIN: f64 = 0.03;

/// One that scores this near is looked at as well: in a figure that is turned a quarter no limbs show.
const TRIED_MARGIN: f64 = 0.12;

/// Votes that add up to less than this leave a doubt which way is front. Seen: at -30 %, five fewer of 115 poses warned of.
const SURE_VOTE: f64 = 0.25;

/// Votes that add up to less than this do not say which way is front. Seen: at -30 %, three fewer of 115 poses
/// wrong by over 5 degrees.
const LEAST_VOTE: f64 = 0.1;

/// Points of the surface, about, at most: triangles are not taken apart further where there are many large ones. Seen:
/// ±30 % turns directions by under half a degree.
const SAMPLE_COUNT: f64 = 2e6;

/// Cells of nothing around the figure. Seen: ±30 % turns directions by under half a degree.
const MARGIN: f64 = 4.0;

/// The way `character` looks, model space, at right angles to up, of length 1, and what a person should know; where its
/// left and right may be another, the second likeliest way after it.
///
/// Given by the character's axes, else found: a figure may look any way, and lie down as long as `axes.up` says so.
/// Meshes of hair and accessories are left out where there are others. The warning `facing_guessed` says that the
/// geometry does not tell, of a sphere, of no triangles; the answer is then the likelier way, or +Z (-Y where up is Z).
///
/// O(triangles).
pub fn find_forward(character: &Character) -> Vec<(DVec3, Vec<Warning>)> {
    let up = character.axes.up.as_dvec3().normalize_or(DVec3::Y);
    let across = |v: DVec3| v.reject_from_normalized(up).try_normalize();
    if let Some(forward) = character.axes.forward.and_then(|forward| across(forward.as_dvec3())) {
        return vec![(forward, Vec::new())];
    }
    // What exporters do by default: glTF looks along +Z, programs in which Z is up along -Y.
    let usual = [DVec3::Z, DVec3::NEG_Y].into_iter().find(|v| v.reject_from_normalized(up).length() > 0.5);
    let usual = usual.and_then(across).unwrap_or_else(|| up.any_orthonormal_vector());
    let guessed = |what: &str| {
        let message = format!("{what}: look whether the result is turned, and if so give the way it looks");
        Warning::new("facing_guessed", message).about("forward")
    };
    // Ground coordinates: x towards the left of a figure that looks the usual way, y the usual way.
    let side = up.cross(usual);
    let kinds = known_kinds(character);
    let Some(cells) = Cells::new(character, &kinds, DMat3::from_cols(side, up, usual).transpose()) else {
        let message = "nothing tells which way the character looks: it has no extent along up";
        return vec![(usual, vec![guessed(message)])];
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .filter(|axis| axis.reject_from_normalized(up).length() > 0.5)
        .map(|axis| DVec2::new(axis.dot(side), axis.dot(usual)).normalize());
    let mirrors = cells.mirrors(&axes.collect::<Vec<_>>());
    let ways = mirrors.into_iter().map(|(mirror, sure_of_sides)| {
        let forward = mirror.normal.perp();
        let vote = cells.front_vote(character, &kinds, mirror);
        // Without a vote the usual way, or what is nearer to it.
        let turned = if vote.abs() >= LEAST_VOTE { vote < 0.0 } else { forward.y < -1e-9 };
        let forward = if turned { -forward } else { forward };
        let found = (forward.x * side + forward.y * usual).normalize();
        let mut warnings = Vec::new();
        if !sure_of_sides {
            warnings.push(guessed("the character's left and right are not clearly told by its shape"));
        } else if vote.abs() < SURE_VOTE {
            warnings.push(guessed("neither feet nor face tell the character's front from its back for sure"));
        }
        (found, warnings)
    });
    ways.collect()
}

/// A plane through up: ground points p with `normal . p = offset`.
#[derive(Clone, Copy, Debug)]
struct Mirror {
    /// The angle of its normal, but for what it was snapped by.
    degrees: f64,
    normal: DVec2,
    offset: f64,
    /// How well the figure mirrors in it, and how wide it is.
    score: f64,
}

/// The way at an angle on the ground.
fn normal_at(degrees: f64) -> DVec2 {
    DVec2::from_angle(degrees.to_radians())
}

/// The surface of a figure as occupied cells of a grid, 1 wide each: x and z on the ground, y up.
struct Cells {
    size: [usize; 3],
    /// Occupancy, blurred, so that halves which do not quite lie on each other still count.
    blurred: Vec<f32>,
    /// Where the surface passes through each occupied cell.
    points: Vec<DVec3>,
    /// Many points of the surface, as they are.
    samples: Vec<Vec3>,
    /// The middle of the points on the ground.
    middle: DVec2,
    /// How they spread on the ground: xx, xz, zz.
    spread: DVec3,
    /// Model space to left, up and front of the grid, cells in a model unit, and where the grid begins.
    frame: DMat3,
    scale: f64,
    low: DVec3,
}

/// What each mesh depicts, as the host or its name says.
fn known_kinds(character: &Character) -> Vec<Option<MeshKind>> {
    let names: Vec<MeshNames> = character.meshes.iter().map(|mesh| MeshNames::of_path(&mesh.name)).collect();
    let named = kinds_from_names(character, &names);
    let known = |(mesh, named): (&Mesh, Option<MeshKind>)| mesh.kind.or(named).map(MeshKind::without_eyes);
    character.meshes.iter().zip(named).map(known).collect()
}

/// The meshes that tell anything: hair and accessories do only where there is nothing else.
fn counted<'a>(character: &'a Character, kinds: &[Option<MeshKind>]) -> Vec<&'a Mesh> {
    let tells = |(mesh, kind): &(&Mesh, &Option<MeshKind>)| {
        !mesh.triangles.is_empty() && !kind.is_some_and(MeshKind::is_carried)
    };
    let counted: Vec<&Mesh> =
        character.meshes.iter().zip(kinds).filter(tells).map(|(mesh, _)| mesh).collect();
    if counted.is_empty() { character.meshes.iter().collect() } else { counted }
}

impl Cells {
    /// `None` where there is no triangle, or none of an extent along up.
    fn new(character: &Character, kinds: &[Option<MeshKind>], frame: DMat3) -> Option<Self> {
        let meshes = counted(character, kinds);
        let triangles = || {
            meshes.iter().flat_map(|mesh| {
                let place = move |v: u32| frame * mesh.positions[v as usize].as_dvec3();
                mesh.triangles.iter().map(move |corners| corners.map(place))
            })
        };
        let (low, high) = bounds(triangles().flatten());
        let extent = (high - low).max_element();
        if !extent.is_finite() || high.y - low.y <= 1e-9 * extent {
            return None;
        }
        let scale = CELL_COUNT as f64 / extent;
        let size = (high - low).to_array().map(|side| (side * scale + 2.0 * MARGIN) as usize + 2);
        let count = size[0] * size[1] * size[2];
        let mut sums = vec![Vec4::ZERO; count];
        let mut samples = Vec::new();
        let most_steps = (2.0 * SAMPLE_COUNT / triangles().count() as f64).sqrt().max(1.0);
        let mut add = |p: DVec3| {
            samples.push(p.as_vec3());
            let [x, y, z] = p.to_array().map(|c| c as usize);
            sums[(y * size[2] + z) * size[0] + x] += p.as_vec3().extend(1.0);
        };
        for corners in triangles() {
            let [a, b, c] = corners.map(|corner| (corner - low) * scale + MARGIN);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            // Points of the surface are no further apart than a cell.
            let steps = longest.ceil().clamp(1.0, most_steps) as usize;
            if steps == 1 {
                add((a + b + c) / 3.0);
                continue;
            }
            for i in 0..steps {
                for j in 0..steps - i {
                    let (u, v) =
                        ((i as f64 + 1.0 / 3.0) / steps as f64, (j as f64 + 1.0 / 3.0) / steps as f64);
                    add(a + u * (b - a) + v * (c - a));
                }
            }
        }
        let mut points = Vec::new();
        let mut blurred = vec![0.0_f32; count];
        for (sum, cell) in sums.iter().zip(&mut blurred) {
            if sum.w > 0.0 {
                points.push((sum.truncate() / sum.w).as_dvec3());
                *cell = 1.0;
            }
        }
        for stride in [1, size[0], size[0] * size[2]] {
            blur(&mut blurred, stride);
        }
        let middle = points.iter().map(|p| p.xz()).sum::<DVec2>() / points.len() as f64;
        let off = points.iter().map(|p| p.xz() - middle);
        let spread = off.map(|d| DVec3::new(d.x * d.x, d.x * d.y, d.y * d.y)).sum();
        Some(Self { size, blurred, points, samples, middle, spread, frame, scale, low })
    }

    /// Model space to cells.
    fn to_cells(&self, p: Vec3) -> DVec3 {
        (self.frame * p.as_dvec3() - self.low) * self.scale + MARGIN
    }

    /// Occupancy around `p`, 0 outside.
    fn sample(&self, p: DVec3) -> f64 {
        let base = p - 0.5;
        let low = base.floor();
        let [x, y, z] = low.to_array().map(|c| c as usize);
        let [columns, rows, depths] = self.size;
        if low.min_element() < 0.0 || x + 1 >= columns || y + 1 >= rows || z + 1 >= depths {
            return 0.0;
        }
        // Mirroring keeps the height: the row is taken as it is.
        let (fx, fz) = ((base.x - low.x) as f32, (base.z - low.z) as f32);
        let at = |dx: usize, dz: usize| self.blurred[(p.y as usize * depths + z + dz) * columns + x + dx];
        let near = at(0, 0) * (1.0 - fx) + at(1, 0) * fx;
        let far = at(0, 1) * (1.0 - fx) + at(1, 1) * fx;
        f64::from(near * (1.0 - fz) + far * fz)
    }

    /// How like its mirror image the figure is, 0..1, by every `step`-th point.
    fn likeness(&self, normal: DVec2, offset: f64, step: usize) -> f64 {
        let (mut own, mut other) = (0.0, 0.0);
        for p in self.points.iter().step_by(step) {
            let ahead = 2.0 * (normal.dot(p.xz()) - offset);
            own += self.sample(*p);
            other += self.sample(DVec3::new(p.x - ahead * normal.x, p.y, p.z - ahead * normal.y));
        }
        if own > 0.0 { other / own } else { 0.0 }
    }

    /// The share of the figure's spread on the ground that lies along `normal`, 0..1.
    fn width_share(&self, normal: DVec2) -> f64 {
        let [xx, xz, zz] = self.spread.to_array();
        let along = xx * normal.x * normal.x + 2.0 * xz * normal.x * normal.y + zz * normal.y * normal.y;
        if xx + zz > 0.0 { along / (xx + zz) } else { 0.5 }
    }

    /// A plane with its score, by every `step`-th point.
    fn scored(&self, degrees: f64, offset: f64, step: usize) -> Mirror {
        let normal = normal_at(degrees);
        let score = self.likeness(normal, offset, step) + WIDTH_WEIGHT * self.width_share(normal);
        Mirror { degrees, normal, offset, score }
    }

    /// The plane between left and right, whether it is clearly that one, and after it the second best one where that may be
    /// it as well; `axes` are ground directions along which files stand.
    fn mirrors(&self, axes: &[DVec2]) -> Vec<(Mirror, bool)> {
        let step = self.step();
        let sweep: Vec<Mirror> = (0..180)
            .step_by(SWEEP_STEP)
            .map(|degrees| {
                let degrees = degrees as f64;
                let middle = normal_at(degrees).dot(self.middle);
                better_of(SWEEP_OFFSETS.map(|by| self.scored(degrees, middle + by, step)))
            })
            .collect();
        let first = better_of(sweep.iter().copied());
        let is_apart = |mirror: &Mirror| {
            let between = (mirror.degrees - first.degrees).abs();
            between.min(180.0 - between) > APART_ANGLE
        };
        let second = better_of(sweep.iter().copied().filter(is_apart));
        let best = self.refined(first, axes);
        let margin = first.score - second.score;
        let likeness = self.likeness(best.normal, best.offset, step);
        let sure = likeness >= LEAST_LIKENESS && margin >= LEAST_MARGIN;
        if sure && margin >= TRIED_MARGIN {
            return vec![(best, true)];
        }
        vec![(best, sure), (self.refined(second, axes), false)]
    }

    /// Every so many cells are compared.
    fn step(&self) -> usize {
        self.points.len().div_ceil(COMPARED).max(1)
    }

    /// The best plane near one.
    fn refined(&self, near: Mirror, axes: &[DVec2]) -> Mirror {
        let step = self.step();
        let mut best = self.scored(near.degrees, near.offset, step);
        // Planes turn about the middle.
        let ahead = |mirror: Mirror| mirror.offset - mirror.normal.dot(self.middle);
        let (mut turn, mut shift) = (SWEEP_STEP as f64 / 2.0, 1.0);
        while turn > LEAST_TURN {
            let turned = |degrees: f64| (degrees, normal_at(degrees).dot(self.middle) + ahead(best));
            let tries = [
                (best.degrees, best.offset - shift),
                (best.degrees, best.offset + shift),
                turned(best.degrees - turn),
                turned(best.degrees + turn),
            ];
            let better = better_of(tries.map(|(degrees, offset)| self.scored(degrees, offset, step)));
            if better.score > best.score + 1e-9 {
                best = better;
            } else {
                (turn, shift) = (turn / 2.0, shift / 2.0);
            }
        }
        let towards = |axis: DVec2| if axis.dot(best.normal) < 0.0 { -axis } else { axis };
        let is_near = |axis: &DVec2| axis.dot(best.normal) >= SNAP_ANGLE.to_radians().cos();
        let mut axes = axes.iter().flat_map(|axis| [*axis, axis.perp()]).map(towards);
        let snapped =
            |axis: DVec2| Mirror { normal: axis, offset: axis.dot(self.middle) + ahead(best), ..best };
        axes.find(is_near).map_or(best, snapped)
    }

    /// Above 0 where the figure looks along the plane with its normal to the left, below 0 against that.
    fn front_vote(&self, character: &Character, kinds: &[Option<MeshKind>], mirror: Mirror) -> f64 {
        let (low, high) = range(self.samples.iter().map(|p| p.y.into()));
        let height = (high - low).max(1e-9);
        // Sideways, up and ahead in heights of the figure.
        let place = |p: DVec3| {
            let sideways = mirror.normal.dot(p.xz()) - mirror.offset;
            DVec3::new(sideways, p.y - low, mirror.normal.perp().dot(p.xz() - self.middle)) / height
        };
        let points: Vec<DVec3> = self.samples.iter().map(|p| place(p.as_dvec3())).collect();
        let of_face =
            character.meshes.iter().zip(kinds).filter(|&(_, &kind)| kind == Some(MeshKind::FacePart));
        let face_parts: Vec<DVec3> =
            of_face.flat_map(|(mesh, _)| &mesh.positions).map(|&p| place(self.to_cells(p))).collect();
        front_vote(&points, &face_parts)
    }
}

/// The first of those with the highest score.
fn better_of(scored: impl IntoIterator<Item = Mirror>) -> Mirror {
    let none = Mirror { degrees: 0.0, normal: DVec2::X, offset: 0.0, score: f64::NEG_INFINITY };
    scored.into_iter().fold(none, |one, other| if other.score > one.score { other } else { one })
}

/// Every cell becomes the mean of itself and its two neighbours `stride` away, twice.
fn blur(cells: &mut [f32], stride: usize) {
    for _ in 0..2 {
        let before = cells.to_vec();
        for index in stride..cells.len().saturating_sub(stride) {
            cells[index] = (before[index - stride] + before[index] + before[index + stride]) / 3.0;
        }
    }
}
