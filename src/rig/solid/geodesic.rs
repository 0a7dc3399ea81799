//! Distances from bones through a volume.
//!
//! Dionne and de Lasa. Geodesic voxel binding for production character meshes. SCA 2013, §3.2. They add up steps from
//! voxel to voxel, which is up to a tenth too long and shows as blocks; here a voxel that sees its bone takes the straight
//! distance, and steps are added up only around corners.

use super::voxels::{Queue, Voxels, neighbourhood};
use crate::error::Result;
use crate::geometry::{Groups, NONE, ROUNDING, by_number, distinct, foot};
use crate::room::{self, Of};
use glam::DVec3;

/// Buckets a voxel: a voxel is always settled in a later bucket than the one on its way to the bone. Seen: ±30 % moves
/// no vertex.
const BUCKETS: f32 = 4.0;
/// A bone is sampled this often a voxel. Seen: at ±30 %, vertices move up to 0.001 H.
const SAMPLES: f64 = 4.0;
/// How much deeper than its first contact an island is tied to the volume beside it, in voxels. Seen: ±30 % moves no
/// vertex.
const CONTACT: f32 = 2.0;
/// No bone is further from the middle of the volume than this, in sizes of the volume. Seen: ±30 % moves no vertex.
const FARTHEST: f64 = 4.0;

/// A bone in voxels.
#[derive(Clone, Debug)]
pub struct Bone {
    /// Both ends of each of its segments; at least one.
    pub segments: Vec<[DVec3; 2]>,
    /// The voxels that it starts from: those it passes, or the nearest.
    pub starts: Vec<u32>,
}

impl Bone {
    /// The point of the bone that is closest to `p`.
    pub fn foot(&self, p: DVec3) -> DVec3 {
        let feet = self.segments.iter().map(|&[a, b]| foot(p, a, b).0);
        feet.min_by(|one, other| one.distance_squared(p).total_cmp(&other.distance_squared(p))).unwrap_or(p)
    }

    /// Whether an end of one bone is within a distance of an end of the other.
    pub fn touches(&self, other: &Self, within: f64) -> bool {
        let mut ends = self.segments.iter().flatten();
        ends.any(|p| other.segments.iter().flatten().any(|q| p.distance(*q) <= within))
    }

    /// The length of the longest segment.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(|[a, b]| a.distance(*b)).fold(0.0, f64::max)
    }

    /// How far the volume reaches around the longest segment, in voxels: the median over directions at right angles to
    /// it, at least; 0 where it is out of the volume or has no length.
    pub fn thickness(&self, volume: &Voxels) -> f64 {
        let longest = |one: &&[DVec3; 2], other: &&[DVec3; 2]| {
            one[0].distance(one[1]).total_cmp(&other[0].distance(other[1]))
        };
        let Some(&[a, b]) = self.segments.iter().max_by(longest) else {
            return 0.0;
        };
        if a.distance(b) <= ROUNDING {
            return 0.0;
        }
        let mut reaches = Vec::new();
        for offset in neighbourhood() {
            let direction = offset.as_dvec3().reject_from_normalized((b - a).normalize()).normalize_or_zero();
            if direction == DVec3::ZERO {
                continue;
            }
            for t in [0.25, 0.5, 0.75] {
                let from = a.lerp(b, t);
                let steps =
                    (0..).take_while(|&step| is_in(volume, from + direction * f64::from(step) / SAMPLES));
                // A voxel is in the volume where its corner is touched: a voxel less is enclosed for certain.
                reaches.push((steps.count() as f64 / SAMPLES - 1.0).max(0.0));
            }
        }
        reaches.sort_by(f64::total_cmp);
        reaches[reaches.len() / 2]
    }
}

/// The bones in voxels, each with at least one voxel to start from; `volume` has at least one.
///
/// A bone without length at the end of another one goes on in that one's direction to the volume's end: else the whole
/// of a head whose top nobody knows is as near to the neck as to the head.
pub fn place_bones(volume: &Voxels, bones: &[Vec<[DVec3; 2]>]) -> Vec<Bone> {
    // A joint given in another unit than the mesh is far away all the same.
    let solid = &volume.solid;
    let middle = (solid.size / 2).as_dvec3();
    let reach = DVec3::splat(FARTHEST * f64::from(solid.size.max_element()));
    let in_grid = |p: DVec3| {
        if p.is_finite() { solid.to_cells(p).clamp(middle - reach, middle + reach) } else { middle }
    };
    let mut all: Vec<Vec<[DVec3; 2]>> = bones
        .iter()
        .map(|segments| segments.iter().map(|&[a, b]| [in_grid(a), in_grid(b)]).collect())
        .collect();
    let lines: Vec<[DVec3; 2]> = all.iter().flatten().copied().collect();
    for segment in all.iter_mut().flatten() {
        let [joint, end] = *segment;
        if joint.distance(end) > ROUNDING {
            continue;
        }
        let arriving = lines
            .iter()
            .filter(|[from, to]| to.distance(joint) <= ROUNDING && from.distance(joint) > ROUNDING);
        let direction: DVec3 = arriving.map(|&[from, to]| (to - from).normalize_or_zero()).sum();
        let step = direction.normalize_or_zero() / SAMPLES;
        while step != DVec3::ZERO && is_in(volume, segment[1] + step) {
            segment[1] += step;
        }
    }
    let placed = all.into_iter().map(|segments| {
        let slots = samples(volume, &segments).map(|p| volume.slot(p.round().as_ivec3()));
        let mut bone = Bone { starts: distinct(slots.filter(|&slot| slot != NONE)), segments };
        if bone.starts.is_empty() {
            bone.starts = nearest_voxels(volume, &bone);
        }
        bone
    });
    placed.collect()
}

fn is_in(volume: &Voxels, p: DVec3) -> bool {
    volume.slot(p.round().as_ivec3()) != NONE
}

/// Points along the segments, the part of them that lies in the grid.
fn samples<'a>(volume: &Voxels, segments: &'a [[DVec3; 2]]) -> impl Iterator<Item = DVec3> + 'a {
    // A bone of another scale than the mesh must not take forever.
    let most = SAMPLES * 2.0 * f64::from(volume.solid.size.element_sum());
    segments.iter().flat_map(move |&[a, b]| {
        let count = (SAMPLES * a.distance(b)).ceil().clamp(1.0, most);
        (0..=count as usize).map(move |sample| a.lerp(b, sample as f64 / count))
    })
}

/// The voxels that are nearest to a bone outside the volume.
fn nearest_voxels(volume: &Voxels, bone: &Bone) -> Vec<u32> {
    let distance = |&slot: &u32| {
        let p = volume.place(slot).as_dvec3();
        bone.foot(p).distance(p)
    };
    let slots = 0..volume.cells.len() as u32;
    let least = slots.clone().map(|slot| distance(&slot)).fold(f64::INFINITY, f64::min);
    slots.filter(|slot| distance(slot) <= least * (1.0 + ROUNDING) + ROUNDING).collect()
}

/// A way into a part of the volume that touches no bone's, from the nearest voxel that does: where to, and how long it is.
type Link = (u32, f32);

/// How voxels hang together.
#[derive(Clone, Debug)]
pub struct Paths<'a> {
    /// The voxels.
    pub volume: &'a Voxels,
    /// For each voxel, whether it lies in a part of the volume that no bone starts in.
    pub is_apart: Vec<bool>,
    /// By the voxel that they start from, ascending by the other one.
    links: Vec<Link>,
    /// Where each voxel's links start; one more than there are voxels.
    link_starts: Vec<u32>,
}

impl<'a> Paths<'a> {
    /// Parts of the volume that no bone starts in are tied to the nearest that one starts in, where they are nearest to
    /// it; ways lead into them, not through them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(volume: &'a Voxels, bones: &[Bone]) -> Result<Self> {
        let count = volume.cells.len();
        let is_apart = vec![true; count];
        let mut paths = Self { volume, is_apart, links: Vec::new(), link_starts: Vec::new() };
        let mut open: Vec<u32> = bones.iter().flat_map(|bone| bone.starts.iter().copied()).collect();
        open.iter().for_each(|&slot| paths.is_apart[slot as usize] = false);
        while let Some(slot) = open.pop() {
            for (next, _) in volume.beside(slot) {
                if std::mem::replace(&mut paths.is_apart[next as usize], false) {
                    open.push(next);
                }
            }
        }
        let mut links = paths.tie_islands()?;
        links.sort_by_key(|&(_, (to, _))| to);
        (paths.link_starts, paths.links) = by_number(count, links.into_iter());
        Ok(paths)
    }

    fn links_of(&self, slot: u32) -> &[Link] {
        let [start, end] = [slot as usize, slot as usize + 1].map(|at| self.link_starts[at] as usize);
        &self.links[start..end]
    }

    /// For each voxel the first one of its island, or `NONE` where it is not apart.
    fn islands(&self) -> Vec<u32> {
        let mut groups = Groups::new(self.is_apart.len());
        let apart = |slot: &u32| self.is_apart[*slot as usize];
        for slot in (0..self.is_apart.len() as u32).filter(apart) {
            self.volume.beside(slot).for_each(|(next, _)| groups.join(slot as usize, next as usize));
        }
        let mut first = |slot: u32| if apart(&slot) { groups.least(slot as usize) as u32 } else { NONE };
        (0..self.is_apart.len() as u32).map(&mut first).collect()
    }

    /// Links by where they start: a wave through the air, from all voxels that are not apart, which remembers where it came
    /// from.
    fn tie_islands(&self) -> Result<Vec<(u32, Link)>> {
        let islands = self.islands();
        let mut untouched = (0u32..).zip(&islands).filter(|&(slot, &island)| slot == island).count();
        let mut links: Vec<(u32, Link)> = Vec::new();
        if untouched == 0 {
            return Ok(links);
        }
        let volume = self.volume;
        room::ask(Of::Cell, 2 * volume.solid.count())?;
        let mut origins = vec![NONE; volume.slots.len()];
        let mut is_settled = vec![false; volume.slots.len()];
        let mut queue = Queue::default();
        for (slot, _) in self.is_apart.iter().enumerate().filter(|&(_, &is_apart)| !is_apart) {
            origins[volume.cells[slot] as usize] = slot as u32;
            queue.push(0, volume.cells[slot]);
        }
        let length = |cell: u32, origin: u32| {
            (volume.solid.place(cell as usize) - volume.place(origin)).as_vec3().length()
        };
        let beside = |cell: u32| {
            let at = volume.solid.place(cell as usize);
            let near = neighbourhood().map(move |offset| at + offset);
            near.filter(|&next| volume.solid.has(next)).map(|next| volume.solid.index(next))
        };
        let mut contacts = vec![f32::INFINITY; islands.len()];
        let mut last = f32::INFINITY;
        while let Some((bucket, cell)) = queue.pop() {
            if bucket as f32 / BUCKETS > last {
                break;
            }
            if std::mem::replace(&mut is_settled[cell as usize], true) {
                continue;
            }
            let least = length(cell, origins[cell as usize]);
            let slot = volume.slots[cell as usize];
            let island = if slot == NONE { NONE } else { islands[slot as usize] };
            if island != NONE {
                let contact = &mut contacts[island as usize];
                if *contact == f32::INFINITY {
                    *contact = least;
                    untouched -= 1;
                    if untouched == 0 {
                        last = least + CONTACT;
                    }
                }
                if least <= *contact + CONTACT {
                    let first = links.len();
                    // All origins that are as near: else a midline would choose a side.
                    for from in beside(cell).map(|next| origins[next]) {
                        if from != NONE
                            && length(cell, from) <= least + ROUNDING as f32
                            && links[first..].iter().all(|&(known, _)| known != from)
                        {
                            links.push((from, (slot, least)));
                        }
                    }
                }
            }
            for next in beside(cell) {
                let (origin, known) = (origins[cell as usize], origins[next]);
                let candidate = length(next as u32, origin);
                if !is_settled[next] && (known == NONE || candidate < length(next as u32, known)) {
                    origins[next] = origin;
                    queue.push((candidate * BUCKETS) as usize, next as u32);
                }
            }
        }
        Ok(links)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Unknown,
    Waiting,
    /// The way to the bone goes around a corner.
    Bent,
    /// The way to the bone is straight.
    Straight,
    /// The way to the bone is longer than asked for.
    Beyond,
}

/// Distances through a volume, in voxels; may be used again.
#[derive(Clone, Debug)]
pub struct Distances {
    /// For each voxel the distance from the nearest of the bones; meaningful where it was reached.
    pub lengths: Vec<f32>,
    /// For each voxel that bone's index.
    pub bones: Vec<u32>,
    states: Vec<State>,
    visited: Vec<u32>,
    queue: Queue,
}

impl Distances {
    /// Room for the distances of `voxel_count` voxels.
    pub fn new(voxel_count: usize) -> Self {
        Self {
            lengths: vec![0.0; voxel_count],
            bones: vec![0; voxel_count],
            states: vec![State::Unknown; voxel_count],
            visited: Vec::new(),
            queue: Queue::default(),
        }
    }

    /// Whether a way leads to the voxel.
    pub fn is_reached(&self, slot: u32) -> bool {
        matches!(self.states[slot as usize], State::Bent | State::Straight)
    }

    /// Whether that way is straight.
    pub fn is_straight(&self, slot: u32) -> bool {
        self.states[slot as usize] == State::Straight
    }

    /// Spreads from the bones whose indices are `sources`, no further than `limit` allows for each voxel.
    pub fn spread(
        &mut self,
        paths: &Paths,
        all: &[Bone],
        sources: impl Iterator<Item = usize>,
        limit: impl Fn(u32) -> f32,
    ) {
        for &slot in &self.visited {
            self.states[slot as usize] = State::Unknown;
        }
        self.visited.clear();
        self.queue.clear();
        let volume = paths.volume;
        let middle = |slot: u32| volume.place(slot).as_dvec3();
        for bone in sources {
            for &slot in &all[bone].starts {
                let p = middle(slot);
                self.offer(slot, p.distance(all[bone].foot(p)) as f32, bone as u32);
            }
        }
        // What a bone starts from sees it; settled here, so that all of it is there when others look for it.
        for &slot in &self.visited {
            self.states[slot as usize] = State::Straight;
        }
        for start in 0..self.visited.len() {
            self.offer_around(paths, self.visited[start]);
        }
        while let Some((_, slot)) = self.queue.pop() {
            if self.states[slot as usize] != State::Waiting {
                continue;
            }
            let bone = self.bones[slot as usize];
            let p = middle(slot);
            let foot = all[bone as usize].foot(p);
            let way = foot - p;
            let before = volume.slot((p + way / way.abs().max_element().max(1.0)).round().as_ivec3());
            // The voxel on the straight way is nearer to the bone, so it is settled already if it is in the volume.
            let sees = before == slot
                || before != NONE && self.is_straight(before) && self.bones[before as usize] == bone;
            self.states[slot as usize] = if sees { State::Straight } else { State::Bent };
            if sees {
                self.lengths[slot as usize] = way.length() as f32;
            }
            if self.lengths[slot as usize] > limit(slot) {
                self.states[slot as usize] = State::Beyond;
                continue;
            }
            self.offer_around(paths, slot);
        }
    }

    fn offer_around(&mut self, paths: &Paths, slot: u32) {
        let (length, bone) = (self.lengths[slot as usize], self.bones[slot as usize]);
        for (next, sides) in paths.volume.beside(slot) {
            self.offer(next, length + (sides as f32).sqrt(), bone);
        }
        for &(to, way) in paths.links_of(slot) {
            self.offer(to, length + way, bone);
        }
    }

    fn offer(&mut self, slot: u32, length: f32, bone: u32) {
        let at = slot as usize;
        match self.states[at] {
            State::Unknown => self.visited.push(slot),
            State::Waiting if length < self.lengths[at] => {}
            _ => return,
        }
        self.states[at] = State::Waiting;
        self.lengths[at] = length;
        self.bones[at] = bone;
        self.queue.push((length * BUCKETS) as usize, slot);
    }
}
