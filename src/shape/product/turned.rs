//! Triangles that are turned over, but nearly not, are put right.
//!
//! The field is one to one, triangles are not: of a sliver thinner than its map is straight the narrow side ends on the other
//! one, and one as thin as rounding turns by that alone. It takes a shift by a part of the sliver's width to put it right, far
//! less than is seen. Shifts are those of position based dynamics: for each triangle the least ones that leave it looking
//! where it looked, so neither the order of corners nor that of triangles matters.
//!
//! Müller, Heidelberger, Hennix, Ratcliff. Position based dynamics. J. Vis. Commun. Image R. 18, 2007.

use crate::geometry::{Weld, double_area};
use crate::parallel;
use glam::DVec3;

/// What is turned over by no more than this part of its longest edge is put right, and less and less of what is by up to
/// twice as much: so that nothing jumps while a slider moves. D33. Seen: see docs/constants.md.
const NEARLY: f64 = 0.03;
/// Triangles that look where they looked are at least this high over their longest edge, a share of H: ten times what floats
/// keep of a place. D33.
const LEAST_HEIGHT: f64 = 1e-6;
/// Times that all triangles around are asked again. D33.
const ROUNDS: usize = 20;
/// Edges are taken to be seen under at least this sine: along the line of sight no shift turns a triangle. D33.
const LEAST_SIGHT: f64 = 0.3;
/// Triangles that a thread looks at together, and how many such pieces are worth one.
const PIECE: usize = 4096;
/// See [`PIECE`].
const LEAST_PIECES: usize = 8;

/// A figure's triangles, before and after.
#[derive(Clone, Copy)]
pub struct Triangles<'a, F> {
    /// Where all vertices are at rest.
    pub rest: &'a [DVec3],
    /// Where a vertex is then.
    pub after: F,
    /// Their corners.
    pub corners: &'a [[u32; 3]],
    /// Vertices at one place stay at one.
    pub weld: &'a Weld,
    /// The figure's height then.
    pub height: f64,
}

/// A triangle as it was and where it is.
struct Seen {
    /// Where it looked, of length 1.
    normal: DVec3,
    /// Twice its area as seen from there less what it should be at least: below 0 it is turned over.
    short: f64,
    /// The square of its longest edge.
    longest: f64,
}

impl Seen {
    /// `None` for one that looked nowhere.
    fn of(rest: [DVec3; 3], [a, b, c]: [DVec3; 3], height: f64) -> Option<Self> {
        let normal = double_area(&rest, [0, 1, 2]).try_normalize()?;
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        let short = normal.dot((b - a).cross(c - a)) - LEAST_HEIGHT * height * longest.sqrt();
        Some(Self { normal, short, longest })
    }

    /// True for one that is not short, as nearly all are: what [`Seen::of`] says, told without a root.
    #[inline(always)]
    fn is_clear(&[p, q, r]: &[DVec3; 3], &[a, b, c]: &[DVec3; 3], height: f64) -> bool {
        /// Above what rounding makes of squares.
        const MORE: f64 = 1.0 + 1e-9;
        let normal = (q - p).cross(r - p);
        let (ab, ac, bc) = (b - a, c - a, c - b);
        let longest = ab.length_squared().max(bc.length_squared()).max(ac.length_squared());
        let along = normal.dot(ab.cross(ac));
        let least = LEAST_HEIGHT * height;
        along > 0.0 && along * along > MORE * least * least * longest * normal.length_squared()
    }

    /// How much of it is put right: all where it is nearly right, 0 where it is far from it.
    fn share(&self) -> f64 {
        (2.0 + self.short / (NEARLY * self.longest)).clamp(0.0, 1.0)
    }

    /// The least shifts of its corners, of which `moves` says which may, that give it `missing` of twice its area.
    fn shifts(&self, [a, b, c]: [DVec3; 3], moves: [bool; 3], missing: f64) -> [DVec3; 3] {
        let mut ways = [(b - c).cross(self.normal), (c - a).cross(self.normal), (a - b).cross(self.normal)];
        for (way, moves) in ways.iter_mut().zip(moves) {
            if !moves {
                *way = DVec3::ZERO;
            }
        }
        let squares: f64 = ways.iter().map(|way| way.length_squared()).sum();
        let squares = squares.max(LEAST_SIGHT * LEAST_SIGHT * self.longest);
        ways.map(|way| way * (missing / squares))
    }
}

impl<F: Fn(usize) -> DVec3 + Sync> Triangles<'_, F> {
    fn at_rest(&self, triangle: usize) -> [DVec3; 3] {
        self.corners[triangle].map(|corner| self.rest[corner as usize])
    }

    /// Those of the triangles `asked` that are turned over, but nearly not, in their order.
    pub fn nearly_right(&self, asked: &[u32], threads: usize) -> Vec<u32> {
        let pieces = asked.len().div_ceil(PIECE);
        let found = parallel::collect(threads, pieces, LEAST_PIECES, |piece| {
            let is_nearly = |&triangle: &u32| {
                let rest = self.at_rest(triangle as usize);
                let after = self.corners[triangle as usize].map(|corner| (self.after)(corner as usize));
                !Seen::is_clear(&rest, &after, self.height)
                    && Seen::of(rest, after, self.height)
                        .is_some_and(|seen| seen.short < 0.0 && seen.share() > 0.0)
            };
            let triangles = &asked[piece * PIECE..asked.len().min((piece + 1) * PIECE)];
            triangles.iter().copied().filter(is_nearly).collect::<Vec<u32>>()
        });
        found.concat()
    }

    /// What must be added to vertices, ascending, so that the triangles `wrong` look where they looked and none around them
    /// that does so ceases to.
    pub fn righted(&self, wrong: &[u32]) -> Vec<(u32, DVec3)> {
        if wrong.is_empty() {
            return Vec::new();
        }
        const STAYS: u32 = u32::MAX;
        let mut index_of = vec![STAYS; self.weld.count];
        let mut count = 0;
        for &triangle in wrong {
            for place in self.weld.triangle(self.corners[triangle as usize]) {
                let index = &mut index_of[place as usize];
                if *index == STAYS {
                    *index = count;
                    count += 1;
                }
            }
        }
        let mut shifts = vec![DVec3::ZERO; count as usize];
        let mut patch = Patch::default();
        for (triangle, &corners) in self.corners.iter().enumerate() {
            let places = self.weld.triangle(corners).map(|place| index_of[place as usize]);
            if places.iter().any(|&place| place != STAYS) {
                let after = corners.map(|corner| (self.after)(corner as usize));
                if let Some(seen) = Seen::of(self.at_rest(triangle), after, self.height) {
                    let goal = (1.0 - seen.share()) * seen.short.min(0.0);
                    patch.around.push(Around { places, rest: self.at_rest(triangle), after, goal });
                }
            }
        }
        patch.height = self.height;
        patch.relax(&mut shifts);
        patch.take_back(&mut shifts);
        (0u32..)
            .zip(&self.weld.representative)
            .filter_map(|(vertex, &place)| {
                let shift = *shifts.get(index_of[place as usize] as usize)?;
                (shift != DVec3::ZERO).then_some((vertex, shift))
            })
            .collect()
    }
}

/// A triangle with a corner that may move.
struct Around {
    /// The moving places of its corners; beyond their count what stays.
    places: [u32; 3],
    rest: [DVec3; 3],
    after: [DVec3; 3],
    /// What it may be short of then: 0 where all of it is put right, what it is short of now where it stays.
    goal: f64,
}

/// All triangles around what moves.
#[derive(Default)]
struct Patch {
    around: Vec<Around>,
    height: f64,
}

impl Patch {
    fn seen(&self, around: &Around, shifts: &[DVec3]) -> Option<([DVec3; 3], Seen)> {
        let at = std::array::from_fn(|corner| {
            let shift = shifts.get(around.places[corner] as usize).copied().unwrap_or_default();
            around.after[corner] + shift
        });
        Some((at, Seen::of(around.rest, at, self.height)?))
    }

    /// Moves each place by the mean of what the triangles around it ask for, time after time.
    fn relax(&self, shifts: &mut [DVec3]) {
        for _ in 0..ROUNDS {
            let mut asked = vec![(DVec3::ZERO, 0u32); shifts.len()];
            for around in &self.around {
                let Some((at, seen)) = self.seen(around, shifts) else { continue };
                let missing = around.goal - seen.short;
                if missing <= 0.0 {
                    continue;
                }
                let moves = around.places.map(|place| (place as usize) < shifts.len());
                for (place, shift) in around.places.into_iter().zip(seen.shifts(at, moves, missing)) {
                    if let Some((sum, count)) = asked.get_mut(place as usize) {
                        *sum += shift;
                        *count += 1;
                    }
                }
            }
            if asked.iter().all(|(_, count)| *count == 0) {
                return;
            }
            for (shift, (sum, count)) in shifts.iter_mut().zip(asked) {
                *shift += sum / f64::from(count.max(1));
            }
        }
    }

    /// Takes back what turns a triangle over that was not.
    fn take_back(&self, shifts: &mut [DVec3]) {
        let is_over = |normal: DVec3, [a, b, c]: [DVec3; 3]| normal.dot((b - a).cross(c - a)) < 0.0;
        loop {
            let mut is_done = true;
            for around in &self.around {
                let Some((at, seen)) = self.seen(around, shifts) else { continue };
                if is_over(seen.normal, at) && !is_over(seen.normal, around.after) {
                    for place in around.places {
                        if let Some(shift) = shifts.get_mut(place as usize) {
                            is_done &= *shift == DVec3::ZERO;
                            *shift = DVec3::ZERO;
                        }
                    }
                }
            }
            if is_done {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::weld;

    /// A sliver of length 1 with its narrow side at `height`, between two large triangles.
    const TRIANGLES: [[u32; 3]; 3] = [[0, 1, 2], [0, 2, 3], [2, 1, 3]];

    fn sliver(height: f64) -> [DVec3; 4] {
        [DVec3::ZERO, DVec3::X, DVec3::new(0.5, height, 0.0), DVec3::new(0.5, 1.0, 0.0)]
    }

    fn shifts(rest: &[DVec3], after: &[DVec3], corners: &[[u32; 3]]) -> Vec<(u32, DVec3)> {
        let weld = weld(rest, 0.0);
        let triangles =
            Triangles { rest, after: |vertex: usize| after[vertex], corners, weld: &weld, height: 1.0 };
        let all: Vec<u32> = (0..corners.len() as u32).collect();
        triangles.righted(&triangles.nearly_right(&all, 1))
    }

    fn looks_up(points: &[DVec3], corners: [u32; 3]) -> bool {
        double_area(points, corners).z > 0.0
    }

    #[test]
    fn a_sliver_that_is_nearly_right_is_put_right_by_its_width() {
        let (rest, mut after) = (sliver(0.02), sliver(-0.01));
        assert!(!looks_up(&after, TRIANGLES[0]));
        let shifts = shifts(&rest, &after, &TRIANGLES);
        for &(vertex, shift) in &shifts {
            assert!(shift.length() < 0.011, "{vertex} moves by {shift}");
            after[vertex as usize] += shift;
        }
        for corners in TRIANGLES {
            assert!(looks_up(&after, corners), "{corners:?} at {after:?}");
        }
    }

    #[test]
    fn what_is_right_and_what_is_far_from_it_stays() {
        let rest = sliver(0.02);
        assert_eq!(shifts(&rest, &sliver(0.01), &TRIANGLES), []);
        // Twice the area over the square of the longest edge is .07 here, more than twice NEARLY.
        assert_eq!(shifts(&rest, &sliver(-0.07), &TRIANGLES[..1]), []);
    }

    #[test]
    fn nothing_jumps_where_it_begins_and_ends() {
        let rest = sliver(0.02);
        let longest = |height: f64| {
            let shifts = shifts(&rest, &sliver(height), &TRIANGLES[..1]);
            shifts.iter().map(|(_, shift)| shift.length()).fold(0.0, f64::max)
        };
        let mut last = longest(0.001);
        for step in 1..=1000 {
            let now = longest(0.001 - 1e-4 * f64::from(step));
            // A step changes what is missing by 1e-4, and the share of it that is asked for by 1e-4 over NEARLY.
            assert!((now - last).abs() < 1e-3, "from {last} to {now} at step {step}");
            last = now;
        }
        assert_eq!(last, 0.0);
    }

    #[test]
    fn mirrored_and_reordered_triangles_are_put_right_alike() {
        let (rest, after) = (sliver(0.02), sliver(-0.01));
        let plain = shifts(&rest, &after, &TRIANGLES);
        let mirror = DVec3::new(-1.0, 1.0, 1.0);
        let reordered = [[3, 2, 1], [2, 1, 0], [2, 0, 3]];
        let mirrored = shifts(&rest.map(|p| mirror * p), &after.map(|p| mirror * p), &reordered);
        assert_eq!(plain.len(), mirrored.len());
        for ((vertex, one), (also, other)) in plain.into_iter().zip(mirrored) {
            assert!(vertex == also && one.distance(mirror * other) < 1e-15, "{one} and {other}");
        }
    }
}
