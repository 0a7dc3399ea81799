//! Clothes stay outside of the body: what was outside and is inside after the deformation is pushed out, smoothly.
//!
//! Cloth is a membrane on a bed: its displacement is as smooth along its edges as what pushes it allows, and dies away
//! beside it. What pushes are the body, and the sheet of cloth below. Solved by projected Gauss-Seidel sweeps.

use super::outside::Outside;
use super::worn::Worn;
use crate::error::Result;
use crate::geometry::{Weld, double_area, smoothstep};
use crate::parallel;
use crate::room::{self, Of};
use glam::DVec3;
use std::collections::VecDeque;

/// Cloth keeps this share of its old distance from the body, up to [`CLEARANCE`]. D32. As much as hair keeps.
const KEPT_DISTANCE: f64 = 0.5;
/// See [`KEPT_DISTANCE`]; a share of H. D32. 3 mm on an adult: a shirt's distance.
const CLEARANCE: f64 = 0.002;
/// How far along the cloth a push dies away to a third, a share of H. D32. Wider than a fold of cloth, narrower than a limb.
const SPREAD: f64 = 0.015;
/// Cloth further than this many times [`SPREAD`] from what is pushed stays: a fiftieth of the push is left there.
const SPREAD_END: f64 = 4.0;
/// Nothing is pushed further than this, a share of H: what is deeper in the body stays, as a sleeve within the trunk. D32.
const FURTHEST: f64 = 0.04;
/// Sweeps of each round, to and fro. Seen: see [`ROUNDS`].
const SWEEPS: usize = 12;
/// Rounds: each finds anew where the body is. Seen: twice as many of twice as many sweeps leave .03 % less
/// of one skirt's vertices in the body, and change nothing on 11 other results.
const ROUNDS: usize = 4;
/// A triangle that would turn further than this against where it was counts as flipped: the cosine, 84 degrees.
const LEAST_TURN: f64 = 0.1;
/// Times that a flipped triangle is eased before its push is halved, and as often again before it is taken back.
const EASINGS: usize = 8;

/// What keeps clothes outside of the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pushed {
    /// Vertices that move, ascending, and what is added to each all the way.
    pub offsets: Vec<(u32, DVec3)>,
}

impl Pushed {
    /// One offset for each of `count` vertices; empty where nothing moves.
    pub fn dense(&self, count: usize) -> Vec<DVec3> {
        if self.offsets.is_empty() {
            return Vec::new();
        }
        let mut dense = vec![DVec3::ZERO; count];
        for &(vertex, offset) in &self.offsets {
            dense[vertex as usize] = offset;
        }
        dense
    }
}

/// What pushes one place.
#[derive(Clone, Copy, Debug)]
struct Push {
    way: DVec3,
    /// How far it must move that way.
    least: f64,
}

/// The displacement in the making.
struct Membrane<'a> {
    worn: &'a Worn,
    layer: &'a Layer,
    /// Where the places are without it.
    points: Vec<DVec3>,
    push: Vec<Option<Push>>,
    displaced: Vec<DVec3>,
    /// How much of a place's displacement the bed takes back.
    bed: Vec<f64>,
}

/// What a layer keeps of its distance from what it lies on, and how far a push goes; in the units of the places.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// This share of the old distance is kept, up to `clearance`.
    pub kept: f64,
    /// See `kept`.
    pub clearance: f64,
    /// How far along the layer a push dies away to a third.
    pub spread: f64,
    /// Nothing is pushed further than this: what is deeper stays.
    pub furthest: f64,
    /// What the nearest point of the body faces by less than this cosine is not inside but beyond a hem; what it faces by less than
    /// wholly is so in part.
    pub facing: Option<f64>,
    /// Nothing that was above this height ends below it.
    pub floor: f64,
}

impl Worn {
    /// What must be added to clothes so that none that was outside of the body is inside.
    ///
    /// - `after`: where all vertices are now; `height`: of the figure then.
    /// - Nothing where nothing is to do. No triangle turns over by it.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn pushed(&self, after: &[DVec3], weld: &Weld, height: f64, threads: usize) -> Result<Pushed> {
        if self.places.is_empty() || !(height > 0.0 && height.is_finite()) {
            return Ok(Pushed::default());
        }
        let points: Vec<DVec3> = self.vertices.iter().map(|&vertex| after[vertex as usize]).collect();
        let cloth = Layer {
            kept: KEPT_DISTANCE,
            clearance: CLEARANCE * height,
            spread: SPREAD * height,
            furthest: FURTHEST * height,
            facing: None,
            floor: f64::NEG_INFINITY,
        };
        let Some(displaced) = self.kept_outside(points, after, weld, &cloth, threads)? else {
            return Ok(Pushed::default());
        };
        let mut of_place = vec![DVec3::ZERO; weld.count];
        for (&place, displaced) in self.places.iter().zip(displaced) {
            of_place[place as usize] = displaced;
        }
        let offsets = (0u32..)
            .zip(&weld.representative)
            .map(|(vertex, &place)| (vertex, of_place[place as usize]))
            .filter(|(_, offset)| *offset != DVec3::ZERO)
            .collect();
        Ok(Pushed { offsets })
    }

    /// What must be added to each place of a layer at `points`, which lies on the body of the vertices `after`, so that what was
    /// outside is; `None` where nothing must.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn kept_outside(
        &self,
        points: Vec<DVec3>,
        after: &[DVec3],
        weld: &Weld,
        layer: &Layer,
        threads: usize,
    ) -> Result<Option<Vec<DVec3>>> {
        room::ask(Of::Outside, self.body.len())?;
        let outside = self.outside(after, weld);
        let mut membrane = Membrane::new(self, points, layer);
        let all: Vec<u32> = (0..self.places.len() as u32).collect();
        if !membrane.find_pushes(&outside, &all, threads) {
            return Ok(None);
        }
        let moving = membrane.moving();
        for round in 0..ROUNDS {
            if round > 0 && !membrane.find_pushes(&outside, &moving, threads) {
                break;
            }
            membrane.relax(&moving);
        }
        Ok(Some(membrane.turning_nothing_over()))
    }
}

impl<'a> Membrane<'a> {
    fn new(worn: &'a Worn, points: Vec<DVec3>, layer: &'a Layer) -> Self {
        // On a grid of edges of length h, the mean of the neighbours less the place is h^2/4 times the Laplacian.
        let bed = |place: usize| {
            let near = worn.around.of(place);
            let squares: f64 =
                near.iter().map(|&other| points[other as usize].distance_squared(points[place])).sum();
            squares / (4.0 * near.len().max(1) as f64 * layer.spread * layer.spread)
        };
        let count = points.len();
        Self {
            worn,
            layer,
            bed: (0..count).map(bed).collect(),
            points,
            push: vec![None; count],
            displaced: vec![DVec3::ZERO; count],
        }
    }

    /// Finds what the body pushes of `places` where they are now; false where it pushes nothing anew.
    fn find_pushes(&mut self, outside: &Outside, places: &[u32], threads: usize) -> bool {
        let &Layer { kept, clearance, furthest, facing, floor, .. } = self.layer;
        let found = parallel::collect(threads, places.len(), parallel::FEW_RAYS, |index| {
            let place = places[index] as usize;
            let old = self.worn.distances[place];
            if self.worn.is_sewn[place] {
                return None;
            }
            let displaced = self.displaced[place];
            let at = self.points[place] + displaced;
            if at.y < floor {
                return Some(Push { way: DVec3::Y, least: displaced.y + floor - at.y });
            }
            if old.is_nan() || old <= 0.0 {
                return None;
            }
            let (closest, distance, way) = outside.at(at, Some(self.worn.nearest[place]))?;
            let kept = (kept * old).min(clearance);
            if distance >= kept || distance < -furthest {
                return None;
            }
            let faced = distance.abs() / closest.distance.max(f64::MIN_POSITIVE);
            let share = facing.map_or(1.0, |least| smoothstep((faced - least) / (1.0 - least)));
            let least = displaced.dot(way) + share * (kept - distance);
            (least <= furthest).then_some(Push { way, least })
        });
        let is_new = found.iter().any(Option::is_some);
        for (&place, push) in places.iter().zip(found) {
            self.push[place as usize] = push.or(self.push[place as usize]);
        }
        is_new
    }

    /// The places that may move, in order: those near what is pushed, along the cloth.
    fn moving(&self) -> Vec<u32> {
        let spread = self.layer.spread;
        let mut away = vec![f64::INFINITY; self.points.len()];
        let mut queue = VecDeque::new();
        for (place, push) in self.push.iter().enumerate() {
            if push.is_some() {
                away[place] = 0.0;
                queue.push_back(place);
            }
        }
        while let Some(place) = queue.pop_front() {
            for &other in self.worn.around.of(place) {
                let other = other as usize;
                let distance = away[place] + self.points[place].distance(self.points[other]);
                if distance < away[other] && distance < SPREAD_END * spread && !self.worn.is_sewn[other] {
                    away[other] = distance;
                    queue.push_back(other);
                }
            }
        }
        // What lies over something that moves may have to move too.
        let moves: Vec<bool> = away.iter().map(|distance| distance.is_finite()).collect();
        let is_over = |place: usize| {
            self.worn.under[place].is_some_and(|under| under.corners.iter().any(|&c| moves[c as usize]))
        };
        let may_move = |&place: &usize| (moves[place] || is_over(place)) && !self.worn.is_sewn[place];
        (0..self.points.len()).filter(may_move).map(|place| place as u32).collect()
    }

    /// Makes the displacement as smooth as the pushes allow.
    fn relax(&mut self, moving: &[u32]) {
        for _ in 0..SWEEPS {
            moving.iter().for_each(|&place| self.settle(place as usize));
            moving.iter().rev().for_each(|&place| self.settle(place as usize));
        }
    }

    fn settle(&mut self, place: usize) {
        let near = self.worn.around.of(place);
        let sum: DVec3 = near.iter().map(|&other| self.displaced[other as usize]).sum();
        let mut to = sum / near.len().max(1) as f64 / (1.0 + self.bed[place]);
        if let Some(Push { way, least }) = self.push[place] {
            to += way * (least - to.dot(way)).max(0.0);
        }
        if let Some(under) = &self.worn.under[place] {
            let mix = |of: &[DVec3]| -> DVec3 {
                under.corners.iter().zip(under.barycentric).map(|(&c, share)| share * of[c as usize]).sum()
            };
            let gap = self.points[place] - mix(&self.points);
            let length = gap.length();
            if length > 0.0 {
                // Half of what is between two sheets may go.
                let way = gap / length;
                let least = mix(&self.displaced).dot(way) - 0.5 * length;
                to += way * (least - to.dot(way)).max(0.0);
            }
        }
        self.displaced[place] = to;
    }

    /// The displacement without what would turn a triangle over.
    fn turning_nothing_over(self) -> Vec<DVec3> {
        let Self { worn, points, mut displaced, .. } = self;
        let is_flipped = |displaced: &[DVec3], corners: [u32; 3]| {
            if corners.iter().all(|&corner| displaced[corner as usize] == DVec3::ZERO) {
                return false;
            }
            let before = double_area(&points, corners);
            let [a, b, c] = corners.map(|corner| points[corner as usize] + displaced[corner as usize]);
            let after = (b - a).cross(c - a);
            before != DVec3::ZERO && after.dot(before) <= LEAST_TURN * after.length() * before.length()
        };
        for easing in 0.. {
            let flipped = worn.triangles.iter().copied().filter(|&corners| is_flipped(&displaced, corners));
            let flipped: Vec<[u32; 3]> = flipped.collect();
            if flipped.is_empty() {
                break;
            }
            for corners in flipped {
                let mean = corners.iter().map(|&corner| displaced[corner as usize]).sum::<DVec3>() / 3.0;
                for corner in corners {
                    let own = &mut displaced[corner as usize];
                    // First together; what does not help is taken back.
                    *own = match easing {
                        _ if worn.is_sewn[corner as usize] => DVec3::ZERO,
                        easing if easing < EASINGS => own.lerp(mean, 0.5),
                        easing if easing < 2 * EASINGS => 0.5 * *own,
                        _ => DVec3::ZERO,
                    };
                }
            }
        }
        displaced
    }
}
