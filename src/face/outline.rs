//! The outline of a head and how it stands over the trunk, measured on the deformed body before the face step.

use super::head::HeadFrame;
use crate::geometry::cut_at;
use crate::geometry::whole::{ceil, floor};
use glam::DVec3;

/// How many heights an outline is read at.
pub const STATIONS: usize = 8;
/// How far they are apart, in head lengths.
pub const APART: f64 = 0.12;
/// The heights above the chin.
pub const HEIGHTS: [f64; STATIONS] = [0.04, 0.16, 0.28, 0.40, 0.52, 0.64, 0.76, 0.88];
/// The station that tells how deep the head is as a whole, above the ears; from there on up hair is part of the outline.
pub const DEEPEST: usize = 4;
/// A head is cut at heights so far apart, in head lengths.
const LEVEL: f64 = 0.01;
/// They lie between these, off round numbers: at those rings and boxes have edges, which last digits move to this side or that.
const LEVELS: (f64, f64) = (-0.0618, 1.0);
/// The front is read so far aside: beside the nose.
const BESIDE_NOSE: (f64, f64) = (0.06, 0.11);
/// The back is read so far aside, to both sides.
const BACK: f64 = 0.09;
/// The chest and the trunk's back are read below the shoulder line, so far.
const TRUNK: (f64, f64) = (-0.305, -0.025);
/// Between these heights the chin is where it is foremost.
const CHIN: (f64, f64) = (0.02, 0.12);
/// The occiput ends where the head is less deep than this part of what it is at [`DEEPEST`].
const OCCIPUT: f64 = 0.9;
/// See [`rounded`].
const ROUNDING: f64 = (1u64 << 30) as f64;

/// What an outline is measured on: the middle of a figure, its vertices numbered anew.
#[derive(Clone, Debug, Default)]
pub struct OutlineSources {
    /// The figure's vertices that are looked at.
    pub vertices: Vec<u32>,
    /// Triangles of the head between these, without hair, hats and the like.
    pub bare: Vec<[u32; 3]>,
    /// Those of hair, hats and the like.
    pub hair: Vec<[u32; 3]>,
    /// Triangles of the trunk.
    pub trunk: Vec<[u32; 3]>,
}

/// A head from the front and from the side; all lengths in head lengths, depths from the head's middle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outline {
    /// Where the head is.
    pub frame: HeadFrame,
    /// The height of the trunk's shoulder line.
    pub shoulder_line: f64,
    /// The depth of the head's middle.
    pub middle: f64,
    /// At each station: half the head's width, how far its front and its back are from the middle; `NaN` where nothing is
    /// seen. The face is read without hair.
    pub half_widths: [f64; STATIONS],
    /// Half its width with hair.
    pub with_hair: [f64; STATIONS],
    /// See `half_widths`.
    pub fronts: [f64; STATIONS],
    /// See `half_widths`; with hair.
    pub backs: [f64; STATIONS],
    /// The height down to which the back of the head is nearly as deep as it gets.
    pub occiput: f64,
    /// How far the chin stands before the chest, where both are seen.
    pub overhang: f64,
    /// How far the skull stands behind the trunk.
    pub behind: f64,
}

impl Outline {
    /// The outline of the head at `frame`; `None` where too little is seen of it.
    ///
    /// - `points`: where the vertices of `sources` are.
    /// - `shoulder_line`: of that figure.
    pub fn of(
        sources: &OutlineSources,
        points: &[DVec3],
        frame: HeadFrame,
        shoulder_line: f64,
    ) -> Option<Self> {
        let points: Vec<DVec3> = points.iter().map(|&p| frame.to_unit(p)).collect();
        let bare = Levels::new(LEVELS).with(&points, &sources.bare);
        let hair = bare.clone().with(&points, &sources.hair);
        let front = |y: f64| if y < HEIGHTS[DEEPEST] { &bare } else { &hair };
        let near = |y: f64| (y - 0.5 * LEVEL, y + 0.5 * LEVEL);
        let front_at = |y: f64| front(y).most(near(y), Of::Front);
        let back_at = |y: f64| hair.most(near(y), Of::Behind);
        let y = HEIGHTS[DEEPEST];
        let (deepest_front, deepest_back) = (front_at(y)?, back_at(y)?);
        let middle = rounded(0.5 * (deepest_front - deepest_back));
        let deep = deepest_back + middle;
        let from = |depth: Option<f64>, origin: f64| depth.map_or(f64::NAN, |depth| rounded(depth - origin));
        let half_width = |levels: &Levels, y: f64| from(levels.most(near(y), Of::HalfWidth), 0.0);
        let steps = (1..50).map(|step| y - LEVEL * f64::from(step));
        let is_deep = |y: &f64| back_at(*y).is_some_and(|depth| depth + middle > OCCIPUT * deep);
        let occiput = steps.take_while(is_deep).last().unwrap_or(y);

        let shoulder_line = (shoulder_line - frame.origin.y) / frame.length;
        let heights = (shoulder_line + TRUNK.0, shoulder_line + TRUNK.1);
        let trunk = Levels::new(heights).with(&points, &sources.trunk);
        let chest = trunk.most(heights, Of::Before);
        let trunk_back = trunk.most(heights, Of::Behind);
        let chin = bare.most(CHIN, Of::Before);
        Some(Self {
            frame,
            shoulder_line,
            middle,
            half_widths: HEIGHTS.map(|y| half_width(front(y), y)),
            with_hair: HEIGHTS.map(|y| half_width(&hair, y)),
            fronts: HEIGHTS.map(|y| from(front_at(y), middle)),
            backs: HEIGHTS.map(|y| from(back_at(y), -middle)),
            occiput,
            overhang: chest.zip(chin).map_or(0.0, |(chest, chin)| rounded(chin - chest)),
            behind: trunk_back.map_or(f64::INFINITY, |trunk| rounded(deepest_back - trunk)),
        })
    }
}

/// Where planes one above the other cut a mesh.
#[derive(Clone)]
struct Levels {
    low: f64,
    levels: Vec<Level>,
}

/// How far what is cut there reaches: aside, and in depth within the [`BANDS`]; `NEG_INFINITY` where nothing is.
type Level = [f64; 1 + BANDS.len()];

/// What a level has, in its order: the half width, then the bands'.
#[derive(Clone, Copy)]
enum Of {
    HalfWidth,
    Front,
    Before,
    Behind,
}

/// How far aside depths are looked at, and whether for the greatest (1) or the least (-1).
const BANDS: [(f64, f64, f64); 3] =
    [(BESIDE_NOSE.0, BESIDE_NOSE.1, 1.0), (0.0, BACK, 1.0), (0.0, BACK, -1.0)];

impl Levels {
    fn new((low, high): (f64, f64)) -> Self {
        let count = ((high - low) / LEVEL).round() as usize;
        Self { low, levels: vec![[f64::NEG_INFINITY; 1 + BANDS.len()]; count] }
    }

    /// The level nearest to a height.
    fn level(&self, y: f64) -> usize {
        (((y - self.low) / LEVEL - 0.5).round().max(0.0) as usize).min(self.levels.len() - 1)
    }

    /// The most `of` this that levels between two heights have; `None` where nothing is.
    fn most(&self, (low, high): (f64, f64), of: Of) -> Option<f64> {
        let levels = &self.levels[self.level(low)..=self.level(high)];
        let most = levels.iter().map(|level| level[of as usize]).fold(f64::NEG_INFINITY, f64::max);
        (most > f64::NEG_INFINITY).then_some(most)
    }

    /// The same with more triangles.
    fn with(mut self, points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        for corners in triangles {
            let [a, b, c] = corners.map(|corner| points[corner as usize]);
            let (least, most) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
            let first = ceil((least - self.low) / LEVEL - 0.5).max(0.0) as usize;
            let end = floor((most - self.low) / LEVEL + 0.5).max(0.0) as usize;
            let end = end.min(self.levels.len());
            let most = if first < end { furthest([a, b, c]) } else { continue };
            for (index, level) in self.levels[..end].iter_mut().enumerate().skip(first) {
                // Most triangles lie where others reach further.
                if level.iter().zip(most).all(|(level, most)| most <= *level) {
                    continue;
                }
                let y = self.low + LEVEL * (index as f64 + 0.5);
                if let Some(ends) = cut_at([a, b, c], y) {
                    add(level, ends);
                }
            }
        }
        self
    }
}

/// What no cut of a triangle reaches beyond.
fn furthest(corners: [DVec3; 3]) -> Level {
    let [least, most] = [DVec3::min, DVec3::max].map(|of| corners.into_iter().reduce(of).unwrap_or_default());
    let beside = |(low, high, sign): (f64, f64, f64)| {
        let meets = |from: f64, to: f64| from <= high && to >= low;
        let meets = meets(least.x, most.x) || meets(-most.x, -least.x);
        if meets { (sign * least.z).max(sign * most.z) } else { f64::NEG_INFINITY }
    };
    let [front, before, behind] = BANDS.map(beside);
    [most.x.max(-least.x), front, before, behind]
}

/// Adds the line from `a` to `b`.
fn add(level: &mut Level, [a, b]: [DVec3; 2]) {
    let [half_width, depths @ ..] = level;
    *half_width = half_width.max(a.x.abs()).max(b.x.abs());
    for side in [1.0, -1.0] {
        let (from, to) = if side * a.x < side * b.x { (a, b) } else { (b, a) };
        let (x, end) = (side * from.x, side * to.x);
        let depth = |at: f64| from.z + (to.z - from.z) * (at - x) / (end - x);
        for (most, (low, high, sign)) in depths.iter_mut().zip(BANDS) {
            if x <= high && end >= low {
                let first = if x < low { depth(low) } else { from.z };
                let last = if end > high { depth(high) } else { to.z };
                *most = most.max(sign * first).max(sign * last);
            }
        }
    }
}

/// A number that is read of a head, to 2^-30 head lengths: a head that is only moved has the same, to the bit.
pub fn rounded(number: f64) -> f64 {
    (number * ROUNDING).round() / ROUNDING
}
