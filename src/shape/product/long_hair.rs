//! Long hair on a child's body: it hangs from the head and lies where it lay, on the body that is there now (§VII, D30).
//!
//! What grows with the head and narrows to the body's girth on its way down flares, swings and stands off like a brim.
//! Here hair is never wider further down, leans in by no more than `LEAN`, and then follows the body at its old
//! distance. All is read from two maps about the torso's axis: how far the body reaches at each angle and height, and
//! how far the hair does.

use crate::face::head::HeadFrame;
use crate::face::head::quantile;
use crate::geometry::{Weld, smoothstep};
use glam::DVec3;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Angles about the axis, and the height of a row in head lengths.
pub(super) const ANGLES: usize = 24;
/// See [`ANGLES`].
const ROW: f64 = 0.035;
/// The top row's height above the chin.
const TOP: f64 = 1.2;
/// Rows: to the soles of a figure of 6 heads.
const ROWS: usize = 210;
/// The share of points in a field of a map that it holds.
const OUTER: f64 = 0.95;
/// Hair is long where it reaches further below the chin than this.
const LONG: f64 = 0.12;
/// Hair lies on the body where its median distance from it is in this range, below the chin.
const LYING: (f64, f64) = (0.02, 0.25);
/// From the first height on the hair's own outline holds, which may not grow downwards.
const HANGS_FROM: f64 = 0.48;
/// Hair goes over from where the head takes it to where it lies between these heights.
const GOES_OVER: (f64, f64) = (0.44, 0.24);
/// How fast hair leans in towards the body: by 31 degrees.
const LEAN: f64 = 0.60;
/// Of its old distance from the body hair keeps all, or this much of the head's growth where that is less.
const KEPT: f64 = 0.55;
/// Hair lies at least so far from the body, and nowhere nearer than the second number.
const LEAST_GAP: (f64, f64) = (0.02, 0.012);
/// A strand keeps its place between the body (0) and the hair's outline (1), within these.
const SHARES: (f64, f64) = (0.06, 1.1);
/// Steps that even out what is added, half the way to the neighbours' mean each.
const SMOOTHED: usize = 3;

/// How far something reaches from an axis, by angle and height; head lengths.
#[derive(Clone, Debug)]
pub(super) struct PolarMap {
    rows: Vec<[f64; ANGLES]>,
}

/// A point about the axis: angle in fields of a map, height above the chin, distance from the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polar {
    pub angle: f64,
    pub height: f64,
    pub radius: f64,
}

/// The axis, and the head's frame that heights and lengths are in.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Where the head is.
    pub frame: HeadFrame,
    /// Where the torso's axis is, seen from above: x and z.
    pub middle: [f64; 2],
}

impl Axis {
    /// Above the chin.
    fn height(&self, p: DVec3) -> f64 {
        (p.y - self.frame.origin.y) / self.frame.length
    }

    pub(super) fn polar(&self, p: DVec3) -> Polar {
        let (x, z) = (p.x - self.middle[0], p.z - self.middle[1]);
        // 0 in front, growing towards the left.
        let turn = x.atan2(z).rem_euclid(TAU) / TAU;
        Polar {
            // The first field's middle is in front, so that the fields of a mirrored figure are the mirrored ones.
            angle: (turn * ANGLES as f64 + 0.5) % ANGLES as f64,
            height: self.height(p),
            radius: x.hypot(z) / self.frame.length,
        }
    }
}

fn row_of(height: f64) -> f64 {
    ((TOP - height) / ROW).clamp(0.0, (ROWS - 1) as f64)
}

/// The distances of points from the axis, by field of a map.
struct Fields(Vec<Vec<f64>>);

impl Fields {
    fn new() -> Self {
        Self(vec![Vec::new(); ROWS * ANGLES])
    }

    fn add(&mut self, height: f64, angle: usize, radius: f64) {
        if height <= TOP + 0.5 * ROW {
            self.0[row_of(height).round() as usize * ANGLES + angle].push(radius);
        }
    }
}

/// The tangents of the angles at which the fields of an eighth of a map end: of 7.5, 22.5 and 37.5 degrees.
const FIELD_ENDS: [f64; 3] = [0.131_652_497_587_395_85, 0.414_213_562_373_095_05, 0.767_326_987_978_960_3];
const _: () = assert!(ANGLES == 24);

/// The field that is nearest to the direction of x and z: as the angle of [`Axis::polar`], without one.
fn field_towards(x: f64, z: f64) -> usize {
    let (across, along) = (x.abs(), z.abs());
    let (less, more) = (across.min(along), across.max(along));
    let eighth = FIELD_ENDS.iter().filter(|&&end| less >= end * more).count();
    let quarter = if across > along { 6 - eighth } else { eighth };
    let half = if z < 0.0 { 12 - quarter } else { quarter };
    if x < 0.0 { (ANGLES - half) % ANGLES } else { half }
}

impl PolarMap {
    /// The map of `points`.
    pub(super) fn of(points: impl Iterator<Item = Polar>) -> Self {
        let mut fields = Fields::new();
        points.for_each(|p| fields.add(p.height, p.angle as usize % ANGLES, p.radius));
        Self::filled(fields)
    }

    /// The map of points on `triangles`, no further apart than about a third of a row.
    fn of_surface(points: &[DVec3], triangles: &[[u32; 3]], axis: Axis) -> Self {
        let to_unit = |p: DVec3| {
            let from = DVec3::new(axis.middle[0], axis.frame.origin.y, axis.middle[1]);
            (p - from) / axis.frame.length
        };
        let mut fields = Fields::new();
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| to_unit(points[corner as usize]));
            let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt();
            let steps = ((3.0 * longest / ROW).ceil() as usize).clamp(1, MOST_STEPS);
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
                    let p = a + u * (b - a) + v * (c - a);
                    fields.add(p.y, field_towards(p.x, p.z), (p.x * p.x + p.z * p.z).sqrt());
                }
            }
        }
        Self::filled(fields)
    }

    /// Fields without a point are filled from those beside them, then from the rows above.
    fn filled(Fields(mut fields): Fields) -> Self {
        let rows = fields.chunks_mut(ANGLES).map(|row| {
            let mut values = [f64::NAN; ANGLES];
            for (value, field) in values.iter_mut().zip(row) {
                *value = quantile(field, OUTER).unwrap_or(f64::NAN);
            }
            filled_round(values)
        });
        let mut rows: Vec<[f64; ANGLES]> = rows.collect();
        for row in 1..ROWS {
            if rows[row][0].is_nan() {
                rows[row] = rows[row - 1];
            }
        }
        for row in (0..ROWS - 1).rev() {
            if rows[row][0].is_nan() {
                rows[row] = rows[row + 1];
            }
        }
        Self { rows }
    }

    /// The value at an angle and a height, between the middles of four fields.
    pub(super) fn at(&self, p: Polar) -> f64 {
        let (row, angle) = (row_of(p.height), (p.angle - 0.5).rem_euclid(ANGLES as f64));
        let (above, before) = (row as usize, angle as usize % ANGLES);
        let below = (above + 1).min(ROWS - 1);
        let after = (before + 1) % ANGLES;
        let (down, round) = (row - above as f64, angle - angle.floor());
        let mix = |row: &[f64; ANGLES]| row[before] + round * (row[after] - row[before]);
        mix(&self.rows[above]) + down * (mix(&self.rows[below]) - mix(&self.rows[above]))
    }
}

/// A row whose gaps are filled evenly from both sides; all gaps where there is nothing.
fn filled_round(values: [f64; ANGLES]) -> [f64; ANGLES] {
    std::array::from_fn(|index| {
        if !values[index].is_nan() {
            return values[index];
        }
        let find = |step: usize| {
            (1..ANGLES).find_map(|distance| {
                let value = values[(index + distance * step) % ANGLES];
                (!value.is_nan()).then_some((distance as f64, value))
            })
        };
        match (find(1), find(ANGLES - 1)) {
            (Some((after, a)), Some((before, b))) => (a * before + b * after) / (after + before),
            _ => f64::NAN,
        }
    })
}

/// A triangle is cut no finer than this along an edge.
const MOST_STEPS: usize = 12;

/// Long hair that lies on the body, and how it does, before anything moves.
#[derive(Clone, Debug)]
pub struct LongHair {
    /// The hair's vertices.
    pub vertices: Vec<u32>,
    /// For each strand, whether it lies on the body: then its vertices are among these.
    pub lies: Vec<bool>,
    /// The body's vertices, and triangles between these numbers.
    pub body_vertices: Vec<u32>,
    body: Vec<[u32; 3]>,
    axis: Axis,
    own: PolarMap,
    outline: PolarMap,
    /// For each of the hair's vertices its place, which it shares with those that it is welded to.
    places: Vec<u32>,
    /// For each place those that an edge joins it with.
    around: Vec<Vec<u32>>,
}

impl LongHair {
    /// The hair of `strands`, connected pieces by the figure's vertices, that lies on `body`; `None` where none does.
    ///
    /// - `positions`: of the whole figure, `triangles`: all of its; `body`: those that hair may lie on.
    pub fn of(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        weld: &Weld,
        strands: &[Vec<u32>],
        body: &[[u32; 3]],
        axis: Axis,
    ) -> Option<Self> {
        let is_long: Vec<bool> = strands.iter().map(|strand| is_long(positions, strand, axis)).collect();
        if body.is_empty() || !is_long.contains(&true) {
            return None;
        }
        let own = PolarMap::of_surface(positions, body, axis);
        let lies: Vec<bool> = strands
            .iter()
            .zip(is_long)
            .map(|(strand, is_long)| is_long && lies(positions, strand, &own, axis))
            .collect();
        let lying = strands.iter().zip(&lies).filter(|&(_, &lies)| lies);
        let mut vertices: Vec<u32> = lying.flat_map(|(strand, _)| strand).copied().collect();
        vertices.sort_unstable();
        if vertices.is_empty() {
            return None;
        }
        let outline = PolarMap::of(vertices.iter().map(|&vertex| axis.polar(positions[vertex as usize])));
        let mut is_body = vec![false; positions.len()];
        body.iter().flatten().for_each(|&vertex| is_body[vertex as usize] = true);
        let body_vertices: Vec<u32> =
            (0..positions.len() as u32).filter(|&vertex| is_body[vertex as usize]).collect();
        let mut numbers = vec![u32::MAX; positions.len()];
        for (number, &vertex) in (0..).zip(&body_vertices) {
            numbers[vertex as usize] = number;
        }
        let body = body.iter().map(|corners| corners.map(|vertex| numbers[vertex as usize])).collect();
        let (places, around) = places(&vertices, triangles, weld);
        Some(Self { vertices, lies, body_vertices, body, axis, own, outline, places, around })
    }

    /// `offsets`, one for each of [`Self::vertices`], evened out along the hair.
    pub fn smoothed(&self, offsets: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![(DVec3::ZERO, 0.0); self.around.len()];
        for (&place, &offset) in self.places.iter().zip(offsets) {
            let sum = &mut sums[place as usize];
            *sum = (sum.0 + offset, sum.1 + 1.0);
        }
        let mut now: Vec<DVec3> = sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect();
        for _ in 0..SMOOTHED {
            let last = now.clone();
            for (place, near) in self.around.iter().enumerate().filter(|(_, near)| !near.is_empty()) {
                let mean = near.iter().map(|&other| last[other as usize]).sum::<DVec3>() / near.len() as f64;
                now[place] = 0.5 * (last[place] + mean);
            }
        }
        self.places.iter().map(|&place| now[place as usize]).collect()
    }

    /// Where the hair would hang on the body as it is now.
    ///
    /// - `hair`, `body`: where [`Self::vertices`] and [`Self::body_vertices`] are before.
    /// - `positions`: of the whole figure at rest; `axis`: as it is now.
    pub fn hanging(
        self: &Arc<Self>,
        positions: &[DVec3],
        hair: &[DVec3],
        body: &[DVec3],
        axis: Axis,
    ) -> Hanging {
        let now = PolarMap::of_surface(body, &self.body, axis);
        let outline = PolarMap::of(hair.iter().map(|&p| axis.polar(p)));
        // In the lengths of the head that it hangs from now.
        let growth = axis.frame.length / self.axis.frame.length;
        let kept = (KEPT * growth).min(1.0) / growth;
        let gaps = PolarMap::of(self.vertices.iter().zip(hair).map(|(&vertex, &p)| {
            let before = self.axis.polar(positions[vertex as usize]);
            let gap = kept * (before.radius - self.own.at(before));
            Polar { radius: gap, ..axis.polar(p) }
        }));
        let mut envelope = outline.clone();
        for row in 0..ROWS {
            let height = TOP - ROW * row as f64;
            for angle in 0..ANGLES {
                let body = now.rows[row][angle];
                let wanted = if height > HANGS_FROM {
                    outline.rows[row][angle]
                } else {
                    let above = envelope.rows[row - 1][angle];
                    let lying = body + gaps.rows[row][angle].max(LEAST_GAP.0);
                    let own = if height > 0.0 { outline.rows[row][angle] } else { lying };
                    above.min(own.max(above - LEAN * ROW))
                };
                envelope.rows[row][angle] = wanted.max(body + LEAST_GAP.1);
            }
        }
        let tongue = Tongue::of(hair.iter().map(|&p| axis.polar(p)));
        Hanging { before: Arc::clone(self), axis, body: now, envelope, tongue }
    }
}

/// The places of `vertices`, welded, and which of them edges join.
fn places(vertices: &[u32], triangles: &[[u32; 3]], weld: &Weld) -> (Vec<u32>, Vec<Vec<u32>>) {
    let mut welded: Vec<u32> = vertices.iter().map(|&vertex| weld.representative[vertex as usize]).collect();
    let all = welded.clone();
    welded.sort_unstable();
    welded.dedup();
    let place = |representative: u32| welded.binary_search(&representative).ok().map(|place| place as u32);
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); welded.len()];
    for corners in triangles {
        if let [Some(a), Some(b), Some(c)] = weld.triangle(*corners).map(place) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                around[from as usize].push(to);
                around[to as usize].push(from);
            }
        }
    }
    for near in &mut around {
        near.sort_unstable();
        near.dedup();
    }
    (all.into_iter().filter_map(place).collect(), around)
}

/// True for a strand that reaches below the chin.
fn is_long(positions: &[DVec3], strand: &[u32], axis: Axis) -> bool {
    strand.iter().any(|&vertex| axis.height(positions[vertex as usize]) < -LONG)
}

/// True for a long strand that lies on the body.
fn lies(positions: &[DVec3], strand: &[u32], body: &PolarMap, axis: Axis) -> bool {
    let points = strand.iter().map(|&vertex| axis.polar(positions[vertex as usize]));
    let mut gaps: Vec<f64> = points.filter(|p| p.height < 0.0).map(|p| p.radius - body.at(p)).collect();
    quantile(&mut gaps, 0.5).is_some_and(|gap| gap >= LYING.0 && gap <= LYING.1)
}

/// Hair on the body as it is now.
#[derive(Clone, Debug)]
pub struct Hanging {
    before: Arc<LongHair>,
    axis: Axis,
    body: PolarMap,
    envelope: PolarMap,
    tongue: Option<Tongue>,
}

/// A tongue hangs behind the head, where its direction from the front has less than this cosine; against what hangs from
/// the sides on: below the second number.
const BEHIND: (f64, f64) = (-0.2, 0.5);
/// What hangs lower than the rest by less than the first is no tongue; by more than the second, and all of it by more than
/// the third, it is meant so.
const TONGUE: (f64, f64, f64) = (0.02, 0.2, 0.25);
/// A tongue is drawn up within this above the rest's lower edge.
const DRAWN_UP: f64 = 0.16;

/// Hair whose lower edge is a little lower behind than beside: a child's head widens the rest, and the end stands out of it
/// as a tongue. Lower edges are in head lengths above the chin.
#[derive(Clone, Debug)]
struct Tongue {
    /// The edge of what is no tongue.
    edge: f64,
    /// How far it is drawn up, 0 to 1.
    share: f64,
    /// The edge at each angle.
    lowest: [f64; ANGLES],
}

impl Tongue {
    /// The tongue of hair at `points`; `None` where there is none, or the hair is meant to hang so.
    fn of(points: impl Iterator<Item = Polar>) -> Option<Self> {
        let mut lowest = [f64::NAN; ANGLES];
        for Polar { angle, height, .. } in points {
            let field = &mut lowest[angle as usize % ANGLES];
            *field = field.min(height);
        }
        let lowest = filled_round(lowest);
        let cosine = |field: usize| (field as f64 / ANGLES as f64 * TAU).cos();
        let mut around: Vec<f64> =
            (0..ANGLES).filter(|&field| cosine(field) < BEHIND.1).map(|field| lowest[field]).collect();
        let edge = quantile(&mut around, 0.5).filter(|edge| !edge.is_nan())?;
        let is_behind = |field: usize| cosine(field) < BEHIND.0;
        let behind = (0..ANGLES).filter(|&field| is_behind(field)).map(|field| lowest[field]);
        let lowest_behind = behind.fold(f64::INFINITY, f64::min);
        let depth = edge - lowest_behind;
        let share = 1.0 - smoothstep((depth - TONGUE.1) / (TONGUE.2 - TONGUE.1));
        // Elsewhere nothing is shortened.
        let of_field = |field: usize| if is_behind(field) { lowest[field] } else { edge };
        (depth > TONGUE.0 && share > 0.0).then(|| Self { edge, share, lowest: std::array::from_fn(of_field) })
    }

    /// By how much a point rises.
    fn rise(&self, p: Polar) -> f64 {
        let angle = (p.angle - 0.5).rem_euclid(ANGLES as f64);
        let (before, round) = (angle as usize % ANGLES, angle - angle.floor());
        let (from, to) = (self.lowest[before], self.lowest[(before + 1) % ANGLES]);
        let lowest = from + round * (to - from);
        let (top, wanted) = (self.edge + DRAWN_UP, self.edge - TONGUE.0);
        if p.height >= top || lowest >= wanted {
            return 0.0;
        }
        self.share * (top - p.height) * (wanted - lowest) / (top - lowest)
    }
}

impl Hanging {
    /// What must be added to a point of the hair that was at `rest` and is at `now`.
    pub fn offset(&self, rest: DVec3, now: DVec3) -> DVec3 {
        let mut p = self.axis.polar(now);
        let rise = self.tongue.as_ref().map_or(0.0, |tongue| tongue.rise(p));
        p.height += rise;
        let up = DVec3::Y * (rise * self.axis.frame.length);
        let over = smoothstep((GOES_OVER.0 - p.height) / (GOES_OVER.0 - GOES_OVER.1));
        if over == 0.0 || p.radius <= 0.0 {
            return up;
        }
        let before = self.before.axis.polar(rest);
        let own = self.before.own.at(before);
        let depth = (self.before.outline.at(before) - own).max(LEAST_GAP.1);
        let share = ((before.radius - own) / depth).clamp(SHARES.0, SHARES.1);
        let body = self.body.at(p);
        let radius = body + share * (self.envelope.at(p) - body);
        let outwards = DVec3::new(now.x - self.axis.middle[0], 0.0, now.z - self.axis.middle[1]);
        up + outwards * (over * (radius / p.radius - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_of_a_direction_is_the_one_of_its_angle() {
        for step in 0..720 {
            let turn = (f64::from(step) + 0.5) / 720.0;
            let (x, z) = (TAU * turn).sin_cos();
            let of_angle = (turn * ANGLES as f64 + 0.5) as usize % ANGLES;
            assert_eq!(field_towards(3.0 * x, 3.0 * z), of_angle, "{turn} turns");
        }
    }

    /// Hair around a head whose lower edge at so many turns from the front is what `edge` says.
    fn hair(edge: impl Fn(f64) -> f64) -> impl Iterator<Item = Polar> {
        (0..360).flat_map(move |degree| {
            let angle = (f64::from(degree) / 360.0 * ANGLES as f64 + 0.5) % ANGLES as f64;
            let turn = f64::from(degree.min(360 - degree)) / 360.0;
            let lowest = edge(turn);
            (0..20).map(move |row| Polar { angle, height: lowest + 0.05 * f64::from(row), radius: 0.5 })
        })
    }

    fn behind(depth: f64) -> impl Iterator<Item = Polar> {
        hair(move |turn| if turn > 0.4 { -0.1 - depth } else { -0.1 })
    }

    #[test]
    fn a_tongue_ends_where_the_rest_of_the_hair_does() {
        let tongue = Tongue::of(behind(0.15)).expect("there is one");
        let back = |height: f64| Polar { angle: 0.5 + 0.5 * ANGLES as f64, height, radius: 0.5 };
        // Its end comes to a fiftieth below the others', what lies above is drawn up less, nothing else moves.
        assert!((tongue.rise(back(-0.25)) - 0.13).abs() < 1e-9);
        let rises: Vec<f64> = (0..60).map(|row| tongue.rise(back(-0.25 + 0.01 * f64::from(row)))).collect();
        assert!(rises.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] < 0.01), "{rises:?}");
        assert_eq!(tongue.rise(back(0.1)), 0.0);
        for angle in [0.5, 6.5, 18.5] {
            assert_eq!(tongue.rise(Polar { angle, height: -0.1, radius: 0.5 }), 0.0);
        }
    }

    #[test]
    fn hair_that_is_meant_to_hang_lower_behind_keeps_its_length() {
        assert!(Tongue::of(behind(0.3)).is_none());
        assert!(Tongue::of(behind(0.01)).is_none());
        assert!(Tongue::of(hair(|_| -0.4)).is_none());
        assert!(Tongue::of(std::iter::empty()).is_none());
        // In between it is drawn up less and less.
        let back = Polar { angle: 0.5 + 0.5 * ANGLES as f64, height: -0.33, radius: 0.5 };
        let rise = Tongue::of(behind(0.23)).expect("there is one").rise(back);
        assert!(rise > 0.0 && rise < 0.15, "{rise}");
    }
}
