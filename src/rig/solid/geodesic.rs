//! Distances from bones through a volume.
//!
//! Dionne and de Lasa. Geodesic voxel binding for production character meshes. SCA 2013, §3.2. They add up steps from
//! voxel to voxel, which is up to a tenth too long and shows as blocks; here a voxel that sees its bone takes the straight
//! distance, and steps are added up only around corners.

use super::voxels::{Queue, Voxels, neighbourhood};
use crate::error::Result;
use crate::geometry::{Groups, NONE, ROUNDING, by_key, distinct, foot, marked};
use crate::room::{self, Of};
use glam::{DVec3, IVec3};
use std::collections::BTreeMap;

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
        let length = |[a, b]: &[DVec3; 2]| a.distance(*b);
        let longest = self.segments.iter().max_by(|one, other| length(one).total_cmp(&length(other)));
        let Some(&[a, b]) = longest.filter(|ends| length(ends) > ROUNDING) else {
            return 0.0;
        };
        let along = (b - a).normalize();
        let aside = |offset: IVec3| offset.as_dvec3().reject_from_normalized(along).normalize_or_zero();
        let reach = |from: DVec3, way: DVec3| {
            let is_in = |p: DVec3| volume.solid.is_filled(p.round().as_ivec3());
            let steps = (0..).take_while(|&step| is_in(from + way * f64::from(step) / SAMPLES));
            // A voxel is in the volume where its corner is touched: a voxel less is enclosed for certain.
            (steps.count() as f64 / SAMPLES - 1.0).max(0.0)
        };
        let ways = neighbourhood().map(aside).filter(|&way| way != DVec3::ZERO);
        let mut reaches: Vec<f64> =
            ways.flat_map(|way| [0.25, 0.5, 0.75].map(|t| reach(a.lerp(b, t), way))).collect();
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
    let mut all: Vec<Vec<[DVec3; 2]>> =
        bones.iter().map(|segments| segments.iter().map(|ends| ends.map(in_grid)).collect()).collect();
    let lines: Vec<[DVec3; 2]> = all.iter().flatten().copied().collect();
    let points = all.iter_mut().flatten().filter(|[joint, end]| joint.distance(*end) <= ROUNDING);
    for segment in points {
        let joint = segment[0];
        let arriving = lines
            .iter()
            .filter(|[from, to]| to.distance(joint) <= ROUNDING && from.distance(joint) > ROUNDING);
        let direction: DVec3 = arriving.map(|&[from, to]| (to - from).normalize_or_zero()).sum();
        let step = direction.normalize_or_zero() / SAMPLES;
        while step != DVec3::ZERO && solid.is_filled((segment[1] + step).round().as_ivec3()) {
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
    /// For each voxel, whether it lies on an island: a part of the volume that no bone starts in.
    pub is_apart: Vec<bool>,
    /// For each voxel, whether any of the links start from it: few do, and a look here takes less time.
    has_links: Vec<bool>,
    /// By the voxel that they start from, ascending by the other one.
    links: BTreeMap<u32, Vec<Link>>,
}

impl<'a> Paths<'a> {
    /// Parts of the volume that no bone starts in are tied to the nearest that one starts in, where they are nearest to
    /// it; ways lead into them, not through them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(volume: &'a Voxels, bones: &[Bone]) -> Result<Self> {
        let count = volume.cells.len();
        let mut groups = Groups::new(count);
        for slot in 0..count {
            let earlier = volume.beside(slot as u32).filter(|&(next, _)| (next as usize) < slot);
            earlier.for_each(|(next, _)| groups.join(slot, next as usize));
        }
        let starts = bones.iter().flat_map(|bone| &bone.starts);
        let has_bone = marked(count, starts.map(|&slot| groups.least(slot as usize)));
        let island = |slot: usize| match groups.least(slot) {
            first if has_bone[first] => NONE,
            first => first as u32,
        };
        // For each voxel the first one of the island that it lies on, or `NONE`.
        let islands: Vec<u32> = (0..count).map(island).collect();
        let mut links = tie(volume, &islands)?;
        links.sort_by_key(|&(_, (to, _))| to);
        let is_apart = islands.iter().map(|&island| island != NONE).collect();
        let has_links = marked(count, links.iter().map(|&(from, _)| from as usize));
        Ok(Self { volume, is_apart, has_links, links: by_key(links) })
    }
}

/// Links to `islands` by where they start: a wave through the air, from all voxels that are on none, which remembers where it
/// came from.
fn tie(volume: &Voxels, islands: &[u32]) -> Result<Vec<(u32, Link)>> {
    let mut untouched = (0u32..).zip(islands).filter(|&(slot, &island)| slot == island).count();
    let mut links: Vec<(u32, Link)> = Vec::new();
    if untouched == 0 {
        return Ok(links);
    }
    room::ask(Of::Cell, 2 * volume.solid.count())?;
    let mut origins = vec![NONE; volume.slots.len()];
    let mut is_settled = vec![false; volume.slots.len()];
    let mut queue = Queue::default();
    for slot in (0..islands.len()).filter(|&slot| islands[slot] == NONE) {
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
                // All origins that are as near: else a midline would choose a side.
                let is_near = |&from: &u32| from != NONE && length(cell, from) <= least + ROUNDING as f32;
                let nearest = distinct(beside(cell).map(|next| origins[next]).filter(is_near));
                links.extend(nearest.into_iter().map(|from| (from, (slot, least))));
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
        for slot in self.visited.drain(..) {
            self.states[slot as usize] = State::Unknown;
        }
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
        if paths.has_links[slot as usize] {
            paths.links[&slot].iter().for_each(|&(to, way)| self.offer(to, length + way, bone));
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
