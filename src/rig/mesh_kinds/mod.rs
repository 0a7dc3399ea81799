//! What each mesh of an unrigged figure depicts: as the host says, else guessed from where it lies.
//!
//! The guess looks at layers. From points all over a mesh one ray goes inwards and one outwards: cloth meets another
//! mesh's outside right below it, a limb its own far side, an eye is met with from within by the head.

mod facts;
mod reach;

use super::{FoundJoint, UnitFigure};
use crate::character::{MeshKind, Role};
use crate::error::{Named, Result, Warning};
use crate::geometry::{SEAM, Surface, by_key, by_number, distinct, range, rim_edges, weld};
use crate::progress::Progress;
pub use facts::Surroundings;
use facts::{Facts, Scene};
use glam::DVec3;
use reach::{SLICES, Slices, middle_plane, reaches_over, shown_count, slices};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Most of a mesh is more than this share. What lies over others for the most part is a layer, what lies within others something
/// in their inside; whose border is for the most part another's too goes on where that one ends; and what has a far side of its
/// own for the most part is closed: a volume or a thing, and no cloth. A majority. Seen, of 74 meshes without names of which one
/// is misjudged: at -30 %, three more; at +30 %, two more.
const MOST: f64 = 0.5;
/// Some of a mesh is at least this share. Wide cloth, such as a cape, lies over the body on that much of itself, and a head that
/// is a mesh of its own on less. Seen: ±30 % changes no mesh.
const SOME: f64 = 0.25;

/// A mesh that makes a body whole adds at least as many slices. Seen: ±30 % changes no mesh.
const LEAST_GAIN: usize = 3;

/// What is no further from skin and clothes than this, in heights, is worn, closed as it may be: a belt, a coat with a lining. What
/// sticks out further is a thing. Seen: ±30 % changes no mesh.
const WORN: f64 = 0.03;

/// A mesh that carries a limb is at least this long, in heights: a bracelet between sleeve and hand is none. Seen: ±30 % changes no
/// mesh.
const LIMB: f64 = 0.08;

/// Parts of one body touch within this distance, in heights, and left and right mirror each other to within half of it.
/// Seen: ±30 % changes no mesh.
const PART_GAP: f64 = 0.04;

/// Hair has at least this share above the chin. Seen: at -30 %, one more mesh misjudged; at +30 %, one more mesh
/// misjudged before joints are known.
const HAIR_SHARE: f64 = 0.35;

/// Shares this near to a threshold are doubtful. Seen: at +30 %, two more warnings.
const DOUBT: f64 = 0.12;

/// A neck is looked for below so many slices from the top. Seen: at -30 %, one more mesh misjudged before joints are known.
const LEAST_HEAD_SLICES: usize = 6;

/// A neck is looked for above a slice that is wider than this times the widest one of the head. Seen: at -30 %, four
/// more meshes misjudged; at +30 %, one more mesh misjudged before joints are known.
const SHOULDERS_WIDEN: f64 = 1.35;

/// A head is at least this high: where its chin is read at its top, not everything there is hair. Seen: ±30 % changes no mesh.
const LEAST_HEAD: f64 = 0.05;

/// What lies within the head begins no further below its chin than this, in lengths of the head: teeth reach below the
/// chin's height where that is the head joint's. Seen: ±30 % changes no mesh.
const TEETH_BELOW: f64 = 0.25;

/// A part of the face is no larger than this, in lengths of the head. Seen: at -30 %, two more meshes misjudged.
const MOST_FACE_PART: f64 = 0.8;

/// A head that is a mesh of its own lies above the chin on at least this share of itself. Seen: at +30 %, one
/// more mesh misjudged.
const HEAD_ABOVE: f64 = 0.8;

/// Such a head, or hair, is or reaches this high, in lengths of the head. Seen: ±30 % changes no mesh.
const HALF_A_HEAD: f64 = 0.5;

/// The height of the chin where no neck is seen: 1 - 1 / 7 of a person of seven heads, and a little below.
const CHIN: f64 = 0.84;

/// A kind for every mesh of `figure`, and a warning (`kind_guessed`) that names those that were guessed without being
/// sure.
///
/// Kinds that it has stay. Of the rest the innermost volumes are body, what lies over them is clothes, or hair
/// above the chin; what sits in or on the front of the head is part of the face; what hangs aside is an accessory. In
/// doubt a mesh is body where it makes the body whole, else clothes. A single mesh is body.
///
/// Runs before joints are known; [`refine_kinds`] looks again once they are, at the same surroundings.
///
/// `threads`: at most this many, 0 for all cores.
///
/// # Errors
/// `Cancelled`.
pub fn guess_kinds(
    figure: &UnitFigure,
    threads: usize,
    progress: &mut Progress,
) -> Result<(Vec<MeshKind>, Vec<Warning>, Surroundings)> {
    let unknown = figure.kinds.iter().filter(|kind| kind.is_none()).count();
    if unknown == 0 || figure.mesh_count() == 1 {
        let kinds = figure.kinds.iter().map(|kind| kind.unwrap_or_default()).collect();
        return Ok((kinds, Vec::new(), Surroundings::default()));
    }
    let mut surroundings = Surroundings::of(figure, threads, &mut progress.part(0.0, 0.7))?;
    surroundings.seams = find_seams(figure);
    progress.at(0.85)?;
    let guesses = Scene { figure, known: &surroundings }.guess(None);
    progress.at(1.0)?;
    let doubtful: Vec<usize> = (0..guesses.len()).filter(|&mesh| !guesses[mesh].sure).collect();
    let kinds: Vec<MeshKind> = guesses.iter().map(|guess| guess.kind).collect();
    let warnings = warning(figure, &kinds, &doubtful);
    Ok((kinds, warnings, surroundings))
}

/// Kinds once more, for the meshes that nobody has named, now that it is known where the head is.
///
/// What is body stays body; the rest is told apart anew. `surroundings`: what [`guess_kinds`] found of this figure.
/// The warning names the meshes whose kind is another one now.
pub fn refine_kinds(
    figure: &UnitFigure,
    surroundings: &Surroundings,
    kinds: &mut [MeshKind],
    joints: &BTreeMap<Role, FoundJoint>,
) -> Vec<Warning> {
    let open = |mesh: usize, kinds: &[MeshKind]| {
        figure.kinds[mesh].is_none() && kinds.get(mesh).is_some_and(|&kind| kind != MeshKind::Body)
    };
    let head = joints.get(&Role::Head).map(|joint| joint.position).filter(|p| p.is_finite());
    let Some(head) = head.filter(|_| (0..figure.mesh_count()).any(|mesh| open(mesh, kinds))) else {
        return Vec::new();
    };
    let guesses = Scene { figure, known: surroundings }.guess(Some(head));
    let mut changed = Vec::new();
    for (mesh, guess) in guesses.iter().enumerate() {
        if open(mesh, kinds) && guess.kind != kinds[mesh] {
            kinds[mesh] = guess.kind;
            changed.push(mesh);
        }
    }
    warning(figure, kinds, &changed)
}

/// True where the body meshes alone reach over the figure: trunk, legs and arms show wherever body and clothes do.
///
/// False where there is no body, or where parts hidden below clothes were left out; clothes cannot follow such a body.
pub fn body_is_whole(figure: &UnitFigure, kinds: &[MeshKind]) -> bool {
    let is_body = |mesh: usize| kinds.get(mesh) == Some(&MeshKind::Body);
    let is_figure = |mesh: usize| is_body(mesh) || kinds.get(mesh) == Some(&MeshKind::Garment);
    reaches_over(figure, middle_plane(figure, &is_figure), &is_body, &is_figure)
}

fn warning(figure: &UnitFigure, kinds: &[MeshKind], meshes: &[usize]) -> Vec<Warning> {
    if meshes.is_empty() {
        return Vec::new();
    }
    let named = |&mesh: &usize| {
        let name = &figure.names[mesh];
        let name = if name.is_empty() { format!("mesh {mesh}") } else { Named(name).to_string() };
        format!("{name} ({})", kinds[mesh])
    };
    let named: Vec<String> = meshes.iter().map(named).collect();
    let message =
        format!("guessed from where they lie: {}; if that is wrong, say what they are", named.join(", "));
    vec![Warning::new("kind_guessed", message).about("kinds")]
}

struct Guess {
    kind: MeshKind,
    sure: bool,
}

impl Scene<'_> {
    /// Kinds of all meshes, where the head's joint is known or not.
    fn guess(&self, head: Option<DVec3>) -> Vec<Guess> {
        let figure = self.figure;
        let count = figure.mesh_count();
        let mut guesses: Vec<Option<Guess>> =
            figure.kinds.iter().map(|kind| kind.map(|kind| Guess { kind, sure: true })).collect();
        for (guess, facts) in guesses.iter_mut().zip(&self.known.facts) {
            // Nothing to see: it counts as what is not asked for elsewhere.
            if facts.samples.is_empty() {
                guess.get_or_insert(Guess { kind: MeshKind::Body, sure: true });
            }
        }
        let open: Vec<usize> = (0..count).filter(|&mesh| guesses[mesh].is_none()).collect();

        // Volumes that lie over nothing and within nothing, the largest first.
        let stands_alone = |&mesh: &usize| self.layer_share(mesh) < MOST && self.enclosed_share(mesh) < MOST;
        let mut volumes: Vec<usize> = open.iter().copied().filter(stands_alone).collect();
        let area = |mesh: usize| self.known.facts[mesh].area;
        volumes.sort_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
        let is_known = |mesh: usize| figure.kinds[mesh] == Some(MeshKind::Body);
        let mut is_body: Vec<bool> =
            (0..count).map(|mesh| is_known(mesh) && !self.known.facts[mesh].samples.is_empty()).collect();
        let is_volume = |mesh: usize| volumes.contains(&mesh) || is_known(mesh);
        let middle = *self.known.middle.get_or_init(|| middle_plane(figure, &is_volume));
        if !is_body.contains(&true) {
            // Where everything lies over something, the one that reaches furthest carries the rest.
            let choice = if volumes.is_empty() { &open } else { &volumes };
            let reach = |mesh: usize| shown_count(&slices(figure, middle, &|other| other == mesh));
            let furthest = choice
                .iter()
                .map(|&mesh| (reach(mesh), mesh))
                .max_by(|a, b| a.0.cmp(&b.0).then(area(a.1).total_cmp(&area(b.1))).then(b.1.cmp(&a.1)));
            if let Some((_, furthest)) = furthest {
                is_body[furthest] = true;
            }
        }
        let first = is_body.clone();
        self.join_seams(&mut is_body);
        let chin = self.chin(&is_body, &volumes, middle);
        let chin = head.map_or(chin, |head| chin.min(head.y));
        let region = self.head_region(chin, head, &is_body, middle);
        self.grow_body(&mut is_body, &volumes, &region);
        let unnamed = |mesh: usize| {
            let body = is_body[mesh].then(|| Guess { kind: MeshKind::Body, sure: first[mesh] });
            body.unwrap_or_else(|| self.guess_other(mesh, &is_body, &region))
        };
        (0..).zip(guesses).map(|(mesh, guess)| guess.unwrap_or_else(|| unnamed(mesh))).collect()
    }

    /// Adds to the body what goes on where it ends: one skin of several materials.
    fn join_seams(&self, is_body: &mut [bool]) {
        let joins = |mesh: usize, is_body: &[bool]| {
            let is_open = !is_body[mesh] && self.figure.kinds[mesh].is_none();
            is_open && self.known.seams[mesh].iter().any(|&other| is_body[other])
        };
        while let Some(mesh) = (0..is_body.len()).find(|&mesh| joins(mesh, is_body)) {
            is_body[mesh] = true;
        }
    }

    /// Adds volumes to the body as long as it is not whole: what touches it, has its like on the other side, is no
    /// thing in front of or behind the trunk, and shows where the body does not; what adds most comes first.
    fn grow_body(&self, is_body: &mut [bool], volumes: &[usize], region: &HeadRegion) {
        let figure = self.figure;
        let of_figure = |mesh: usize| {
            volumes.contains(&mesh)
                || matches!(figure.kinds[mesh], Some(MeshKind::Body | MeshKind::Garment))
                || (figure.kinds[mesh].is_none() && self.layer_share(mesh) >= MOST)
        };
        let middle = region.plane;
        let may_be_limb = |mesh: &usize| {
            let facts = &self.known.facts[*mesh];
            facts.extent() >= LIMB && facts.is_closed() && !region.is_on_face(facts)
        };
        let with_slices = |mesh: usize| (mesh, slices(figure, middle, &|other| other == mesh));
        let mut candidates: Vec<(usize, Slices)> =
            volumes.iter().copied().filter(may_be_limb).map(with_slices).collect();
        while !reaches_over(figure, middle, &|mesh| is_body[mesh], &of_figure) {
            let body = Surface::new(&figure.positions, &figure.triangles_where(|mesh| is_body[mesh]));
            let shown = slices(figure, middle, &|mesh| is_body[mesh]);
            let gain = |of: &Slices| {
                of.iter().flatten().zip(shown.iter().flatten()).filter(|&(&new, &old)| new && !old).count()
            };
            candidates.retain(|(mesh, of)| !is_body[*mesh] && gain(of) >= LEAST_GAIN);
            candidates.sort_by_key(|(mesh, of)| (Reverse(gain(of)), *mesh));
            let touches = |mesh: usize| {
                let mut vertices = figure.triangles_of(mesh).iter().flatten();
                let closest = |vertex: u32| body.closest_point(figure.positions[vertex as usize]);
                vertices.any(|&vertex| closest(vertex).is_some_and(|near| near.distance <= PART_GAP))
            };
            let Some(&(mesh, _)) = candidates.iter().find(|(mesh, _)| touches(*mesh)) else {
                return;
            };
            is_body[mesh] = true;
            self.join_seams(is_body);
        }
    }

    /// The chin's height: the narrowest place between the head and the first slice from above that is much wider.
    fn chin(&self, is_body: &[bool], volumes: &[usize], middle: f64) -> f64 {
        let mut widths = [0.0f64; 2 * SLICES];
        let count = widths.len();
        let slice = |y: f64| ((y * count as f64).max(0.0) as usize).min(count - 1);
        let figure = self.figure;
        for corners in figure.triangles_where(|mesh| is_body[mesh] || volumes.contains(&mesh)) {
            let corners = corners.map(|vertex| figure.positions[vertex as usize]);
            let heights = corners.map(|p| slice(p.y));
            let low = heights.into_iter().fold(usize::MAX, usize::min);
            let high = heights.into_iter().fold(0, usize::max);
            let width = corners.into_iter().map(|p| (p.x - middle).abs()).fold(0.0, f64::max);
            widths[low..=high].iter_mut().for_each(|widest| *widest = widest.max(width));
        }
        let mut widest = (count - 1, 0.0);
        for (slice, &width) in widths.iter().enumerate().rev() {
            if slice + LEAST_HEAD_SLICES < count && width > SHOULDERS_WIDEN * widest.1 {
                // Between the head's widest slice and here.
                let neck = (slice + 1..=widest.0).filter(|&slice| widths[slice] > 0.0);
                let neck = neck.rev().min_by(|&a, &b| widths[a].total_cmp(&widths[b]));
                return neck.map_or(CHIN, |slice| (slice as f64 + 0.5) / count as f64);
            }
            if width > widest.1 {
                widest = (slice, width);
            }
        }
        CHIN
    }

    fn head_region(&self, chin: f64, head: Option<DVec3>, is_body: &[bool], plane: f64) -> HeadRegion {
        let skin = self.figure.triangles_where(|mesh| is_body[mesh]);
        let points = skin.iter().flatten().map(|&vertex| self.figure.positions[vertex as usize]);
        let (low, high) = range(points.filter(|p| p.y > chin).map(|p| p.z));
        let middle = if low <= high { (low + high) / 2.0 } else { 0.0 };
        let middle = head.map_or(middle, |head| head.z);
        HeadRegion { plane, chin, middle, length: (1.0 - chin).max(LEAST_HEAD) }
    }

    /// What a mesh is that is not body.
    fn guess_other(&self, mesh: usize, is_body: &[bool], region: &HeadRegion) -> Guess {
        let facts = &self.known.facts[mesh];
        let layer = self.layer_share(mesh);
        let above = facts.share(|sample| sample.point.y > region.chin);
        let doubtful = |share: f64, limit: f64| (share - limit).abs() < DOUBT;
        let enclosed = self.enclosed_share(mesh);
        let at_head = facts.middle().y > region.chin - TEETH_BELOW * region.length;
        let is_inside = enclosed >= MOST && at_head;
        if region.is_on_face(facts) || (is_inside && facts.extent() <= MOST_FACE_PART * region.length) {
            return Guess { kind: MeshKind::FacePart, sure: enclosed >= MOST - DOUBT };
        }
        // A head of its own: round the head's axis, with nothing below.
        let on_axis = facts.low.x < region.plane
            && facts.high.x > region.plane
            && facts.low.z < region.middle
            && facts.high.z > region.middle;
        if above >= HEAD_ABOVE
            && layer < SOME
            && facts.is_closed()
            && on_axis
            && facts.extent() >= HALF_A_HEAD * region.length
        {
            return Guess { kind: MeshKind::Body, sure: false };
        }
        if above >= HAIR_SHARE && facts.high.y > region.chin + HALF_A_HEAD * region.length {
            let sure = layer >= MOST && !doubtful(above, HAIR_SHARE);
            return Guess { kind: MeshKind::Hair, sure };
        }
        if layer >= MOST {
            return Guess { kind: MeshKind::Garment, sure: !doubtful(layer, MOST) };
        }
        // How far it sticks out from what is below, and where it begins.
        let around =
            |other: usize| other != mesh && (is_body[other] || self.known.facts[other].area > facts.area);
        let rest = Surface::new(&self.figure.positions, &self.figure.triangles_where(around));
        let samples = facts.samples.iter().map(|sample| sample.point);
        let distances: Vec<(f64, f64)> =
            samples.filter_map(|p| Some((rest.closest_point(p)?.distance, p.y))).collect();
        let furthest = distances.iter().map(|&(distance, _)| distance).fold(0.0, f64::max);
        let nearest = distances.iter().min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let from_head = nearest.is_some_and(|&(_, height)| height > region.chin);
        let over_body = facts.share(|sample| sample.over.is_some_and(|below| is_body[below]));
        let kind = if from_head && facts.extent() >= HALF_A_HEAD * region.length {
            MeshKind::Hair
        } else if furthest <= WORN || (over_body >= SOME && !facts.is_closed()) {
            MeshKind::Garment
        } else {
            MeshKind::Accessory
        };
        Guess { kind, sure: false }
    }
}

/// For each mesh those whose border a good share of its own border is.
fn find_seams(figure: &UnitFigure) -> Vec<Vec<usize>> {
    let welded = weld(&figure.positions, SEAM);
    let border = |mesh| distinct(rim_edges(figure.triangles_of(mesh), &welded).into_iter().flatten());
    let borders: Vec<Vec<u32>> = (0..figure.mesh_count()).map(border).collect();
    let ends = borders.iter().enumerate();
    let ends = ends.flat_map(|(mesh, border)| border.iter().map(move |&vertex| (vertex, mesh)));
    let meshes_at = by_number(welded.count, ends);
    let goes_on = |(mesh, border): (usize, &Vec<u32>)| {
        let others = border.iter().flat_map(|&vertex| meshes_at.of(vertex as usize));
        let shared = by_key(others.filter(|&&other| other != mesh).map(|&other| (other, ())));
        let most = MOST * border.len() as f64;
        shared.into_iter().filter(|(_, shared)| shared.len() as f64 >= most).map(|(other, _)| other).collect()
    };
    borders.iter().enumerate().map(goes_on).collect()
}

/// Where the head is.
struct HeadRegion {
    /// The x of the plane of symmetry.
    plane: f64,
    chin: f64,
    /// Its middle along z.
    middle: f64,
    length: f64,
}

impl HeadRegion {
    /// True for what is small, above the chin and not behind the middle.
    fn is_on_face(&self, facts: &Facts) -> bool {
        let middle = facts.middle();
        middle.y > self.chin && middle.z > self.middle && facts.extent() <= MOST_FACE_PART * self.length
    }
}
