//! A head that sits over the chest: how far it goes back, and how the nape fills towards the trunk (D30).
//!
//! A head that grows about its joint hangs out before the chest, on the neck of an adult: a funnel from the side. Both
//! are measured on the deformed body, from the front and from behind.

use super::dual::step;
use super::dual::{Dual, Number};
use super::head::HeadFrame;
use super::raster::{DepthMap, Window};
use crate::geometry::Mapped;
use glam::{DMat3, DVec2, DVec3};

/// Heights of the nape's rows, in head lengths: from the lowest that a nape begins at to the skull.
const ROWS: (f64, f64) = (-0.60, 0.36);
/// How far apart they are.
const ROW: f64 = 0.01;
const ROW_COUNT: usize = 96;
/// How far aside of the middle silhouettes are looked at: the chin, chest and back; the skull beside buns and tails.
const MIDDLE: f64 = 0.09;
/// See [`MIDDLE`].
const BESIDE: (f64, f64) = (0.14, 0.22);
/// How many columns of it are told apart.
const BESIDE_COLUMNS: usize = 4;
/// Where the chin's front, the skull's back and the chest are looked at; the chest against the shoulder line, half a row off
/// the rows of a neck of whole hundredths: those are common, and the last digit would choose the rows.
const CHIN: (f64, f64) = (0.02, 0.12);
/// See [`CHIN`].
const SKULL: (f64, f64) = (0.40, 0.62);
/// See [`CHIN`].
const CHEST: (f64, f64) = (-0.305, -0.025);
/// A chin may hang so far before the chest, a skull so far behind the back; artists: .08 to .10, .06 to .20.
const CHIN_BEFORE: f64 = 0.10;
/// See [`CHIN_BEFORE`].
const SKULL_BEHIND: f64 = 0.42;
/// A head goes back by at most this.
const MOST_BACK: f64 = 0.08;
/// And by at most this part of the height that it leans back over: the steepest of that is 1.875 times as steep, so a
/// short neck leans by no more than 27 degrees.
const MOST_LEAN: f64 = 0.27;
/// All of the head above this goes back as far.
const WHOLE: f64 = 0.10;
/// The nape's lower end: so far above the shoulder line, and no lower than the second number; its upper end.
const NAPE_LOW: (f64, f64) = (0.04, -0.04);
/// See [`NAPE_LOW`].
const NAPE_HIGH: f64 = 0.32;
/// Where the skull's back that the nape leads to is looked at.
const NAPE_SKULL: (f64, f64) = (0.32, 0.40);
/// The nape swings out a little later than a quarter of a sine.
const NAPE_CURVE: f64 = 1.15;
/// It fills by at most this, and grows by at most this factor.
const MOST_FILL: (f64, f64) = (0.11, 1.8);
/// The collar: the highest row whose outermost surface the head moves by less than this; from there the nape may reach
/// back as fast as it rises, from just behind it. Without this bound it hangs over the collar like a lip.
const COLLAR: f64 = 0.6;
/// See [`COLLAR`].
const COLLAR_GAP: f64 = 0.01;
/// How far aside of the middle the collar is looked at.
const COLLAR_WIDTH: f64 = 0.12;
/// Rows that are smoothed together, to each side.
const SMOOTHED: usize = 3;
/// The nape is filled within this of the middle, less from 0.6 of it on.
const NAPE_WIDTH: f64 = 0.35;
/// What stands so far behind the nape is a tail or a collar, and stays; in between less and less moves.
const TAIL: (f64, f64) = (0.02, 0.30);

/// What a seat is measured on: the middle of a figure, its vertices numbered anew.
#[derive(Clone, Debug, Default)]
pub struct SeatSources {
    /// The figure's vertices that are looked at.
    pub vertices: Vec<u32>,
    /// Triangles between these, without hair, hats and the like.
    pub bare: Vec<[u32; 3]>,
    /// Triangles with hair.
    pub with_hair: Vec<[u32; 3]>,
    /// For each of the vertices, how much of it head and neck move.
    pub shares: Vec<f32>,
}

/// How the head goes back and the nape fills; all lengths in head lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    frame: HeadFrame,
    /// How far the head goes back.
    pub back: f64,
    /// The height of the shoulder line, where nothing goes back any more.
    shoulder_line: f64,
    /// The depth that the nape fills away from.
    axis: f64,
    /// By row: how deep the nape is behind the axis, and by how much it fills.
    nape: Vec<[f64; 2]>,
}

/// How much of a seat is done, 0 to 1 each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeatAmount {
    /// How far the head goes back.
    pub back: f64,
    /// How much the nape fills.
    pub nape: f64,
}

/// The silhouettes of a figure's middle.
struct Silhouettes {
    front: DepthMap,
    /// Of what is bare and with hair; depths are the distance backwards.
    back: DepthMap,
    hair_back: DepthMap,
}

impl Silhouettes {
    fn of(sources: &SeatSources, points: &[DVec3]) -> Self {
        let window = Window { low: DVec2::new(-0.24, ROWS.0 - 0.2), high: DVec2::new(0.24, 0.8), step: 0.01 };
        let behind: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, p.y, -p.z)).collect();
        Self {
            front: DepthMap::new(points, &sources.bare, window),
            back: DepthMap::new(&behind, &sources.bare, window),
            hair_back: DepthMap::new(&behind, &sources.with_hair, window),
        }
    }
}

/// The furthest that `map` shows in `rows`, where |x| is in `aside`.
fn furthest(map: &DepthMap, rows: (f64, f64), aside: (f64, f64)) -> Option<f64> {
    let columns = (0..map.columns()).filter(|&column| {
        let x = map.middle(column, 0).x.abs();
        x >= aside.0 && x <= aside.1
    });
    let rows = map.row(rows.0)..=map.row(rows.1);
    columns
        .flat_map(|column| rows.clone().filter_map(move |row| map.depth(column, row)))
        .max_by(f64::total_cmp)
}

/// How far back the skull is: of columns beside the middle the one that is least deep, for a tail hides some of it.
fn skull_back(map: &DepthMap) -> Option<f64> {
    let width = (BESIDE.1 - BESIDE.0) / BESIDE_COLUMNS as f64;
    (0..BESIDE_COLUMNS)
        .filter_map(|column| {
            let aside = BESIDE.0 + width * column as f64;
            furthest(map, SKULL, (aside, aside + width))
        })
        .min_by(f64::total_cmp)
}

impl Seat {
    /// Measures how the head at `frame` sits; `None` where it sits well or nothing can be seen.
    ///
    /// - `points`: where the vertices of `sources` are.
    /// - `shoulder_line`, `head_joint`: of that figure.
    /// - `fill`: how much the nape fills, 0 (a face as young as it gets keeps its nape) to 1.
    pub fn new(
        sources: &SeatSources,
        points: &[DVec3],
        frame: HeadFrame,
        shoulder_line: f64,
        head_joint: DVec3,
        fill: f64,
    ) -> Option<Self> {
        let points: Vec<DVec3> = points.iter().map(|&p| frame.to_unit(p)).collect();
        let seen = Silhouettes::of(sources, &points);
        let shoulder_line = (shoulder_line - frame.origin.y) / frame.length;
        let chest = (shoulder_line + CHEST.0, shoulder_line + CHEST.1);
        let middle = (0.0, MIDDLE);
        let chest_front = furthest(&seen.front, chest, middle)?;
        let trunk_back = furthest(&seen.back, chest, middle)?;
        let before = furthest(&seen.front, CHIN, middle)? - chest_front;
        let behind = skull_back(&seen.hair_back)? - trunk_back;
        let most = MOST_BACK.min(MOST_LEAN * (WHOLE - shoulder_line).max(0.0));
        let back = (before - CHIN_BEFORE).min(SKULL_BEHIND - behind).clamp(0.0, most);
        let axis = frame.to_unit(head_joint).z.min(0.5 * (chest_front - trunk_back));
        let mut seat = Self { frame, back, shoulder_line, axis, nape: Vec::new() };
        if fill > 0.0 {
            seat.nape = seat.measure_nape(sources, &seen, trunk_back, fill).unwrap_or_default();
        }
        (seat.back > 0.0 || !seat.nape.is_empty()).then_some(seat)
    }

    /// What part of the way back a height goes.
    fn fades<N: Number>(&self, y: N) -> N {
        step((y - self.shoulder_line) * (1.0 / (WHOLE - self.shoulder_line)))
    }

    fn measure_nape(
        &self,
        sources: &SeatSources,
        seen: &Silhouettes,
        trunk_back: f64,
        fill: f64,
    ) -> Option<Vec<[f64; 2]>> {
        let low = (self.shoulder_line + NAPE_LOW.0).max(NAPE_LOW.1);
        let skull_back = furthest(&seen.hair_back, NAPE_SKULL, (0.0, MIDDLE))?;
        let collar = collar(sources, seen);
        let height = |row: usize| ROWS.0 + ROW * row as f64;
        let now: Vec<Option<f64>> = (0..ROW_COUNT)
            .map(|row| furthest(&seen.hair_back, (height(row), height(row)), (0.0, MIDDLE)))
            .collect();
        let fills = |row: usize| -> Option<f64> {
            let y = height(row);
            let (now, (collar_y, collar_back)) = (now[row]?, collar?);
            if y <= low.max(collar_y) || y >= NAPE_HIGH {
                return None;
            }
            let t = ((y - low) / (NAPE_HIGH - low)).powf(NAPE_CURVE);
            let curve = trunk_back + (skull_back - trunk_back) * (std::f64::consts::FRAC_PI_2 * t).sin();
            // The head goes back as well, and with it the nape.
            let allowed = collar_back + (y - collar_y) + COLLAR_GAP - self.back * self.fades(y);
            let depth = now + self.axis;
            let wanted = (curve.min(allowed) - now).min(MOST_FILL.0).min((MOST_FILL.1 - 1.0) * depth);
            Some(fill * wanted.max(0.0))
        };
        let fills: Vec<f64> = (0..ROW_COUNT).map(|row| fills(row).unwrap_or(0.0)).collect();
        if fills.iter().all(|&fill| fill == 0.0) {
            return None;
        }
        let mean = |values: &dyn Fn(usize) -> f64, row: usize| {
            let near = row.saturating_sub(SMOOTHED)..(row + SMOOTHED + 1).min(ROW_COUNT);
            let count = near.len() as f64;
            near.map(values).sum::<f64>() / count
        };
        // A row without a surface is as deep as the one above; above the last one nothing fills.
        let mut depths: Vec<f64> =
            now.iter().map(|now| now.map_or(f64::NAN, |now| now + self.axis)).collect();
        for row in (0..ROW_COUNT).rev() {
            if depths[row].is_nan() {
                depths[row] = *depths.get(row + 1).unwrap_or(&0.3);
            }
            depths[row] = depths[row].max(LEAST_DEPTH);
        }
        Some(
            (0..ROW_COUNT).map(|row| [mean(&|row| depths[row], row), mean(&|row| fills[row], row)]).collect(),
        )
    }

    /// Where `p` goes, of which head and neck move the part `share`, and the Jacobian there.
    pub fn map(&self, p: DVec3, share: f64, amount: SeatAmount) -> Mapped {
        let [x, y, z] = Dual::point(self.frame.to_unit(p));
        let back = self.goes_back([x, y, z], amount) * share;
        let position = p - DVec3::Z * (self.frame.length * back.value);
        let mut jacobian = DMat3::IDENTITY;
        jacobian.x_axis.z = -back.gradient.x;
        jacobian.y_axis.z = -back.gradient.y;
        jacobian.z_axis.z = 1.0 - back.gradient.z;
        Mapped { position, jacobian }
    }

    /// As [`Self::map`], without the Jacobian.
    pub fn place(&self, p: DVec3, share: f64, amount: SeatAmount) -> DVec3 {
        let back = self.goes_back(self.frame.to_unit(p).to_array(), amount) * share;
        p - DVec3::Z * (self.frame.length * back)
    }

    fn goes_back<N: Number>(&self, [x, y, z]: [N; 3], amount: SeatAmount) -> N {
        let back = self.fades(y) * (self.back * amount.back);
        let row = (y - ROWS.0) * (1.0 / ROW);
        if self.nape.is_empty() || row.value() <= 0.0 || row.value() >= (ROW_COUNT - 1) as f64 {
            return back;
        }
        let depth = -z + self.axis;
        let wide = step(x.distance() * (-1.0 / NAPE_WIDTH) + 1.6);
        if depth.value() <= 0.0 || wide.value() <= 0.0 {
            return back;
        }
        let below = row.value() as usize;
        let t = row - below as f64;
        let [from, to] = [self.nape[below], self.nape[below + 1]];
        let between = |value: usize| t * (to[value] - from[value]) + from[value];
        let (nape, fill) = (between(0), between(1));
        if fill.value() <= 0.0 {
            return back;
        }
        let rises = step(depth * nape.recip());
        let falls = step((depth - nape - TAIL.0) * (1.0 / TAIL.1));
        back + fill * rises * (-falls + 1.0) * wide * amount.nape
    }
}

/// No nape is taken to be shallower, so that filling it does not fold what is before it.
const LEAST_DEPTH: f64 = 0.08;

/// The collar's height, and how far behind it is.
fn collar(sources: &SeatSources, seen: &Silhouettes) -> Option<(f64, f64)> {
    let map = &seen.back;
    let columns: Vec<usize> =
        (0..map.columns()).filter(|&column| map.middle(column, 0).x.abs() <= COLLAR_WIDTH).collect();
    (0..map.rows()).rev().filter(|&row| map.middle(0, row).y < NAPE_HIGH).find_map(|row| {
        let outermost = columns
            .iter()
            .filter_map(|&column| Some((map.depth(column, row)?, map.triangle(column, row)?)))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        let corners = sources.bare[outermost.1];
        let share: f32 = corners.iter().map(|&corner| sources.shares[corner as usize]).sum::<f32>() / 3.0;
        (f64::from(share) < COLLAR).then_some((map.middle(0, row).y, outermost.0))
    })
}
