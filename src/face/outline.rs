//! The outline of a head and how it stands over the trunk, measured on the deformed body before the face step.

use super::head::HeadFrame;
use super::raster::{DepthMap, Window};
use glam::{DVec2, DVec3};

/// How many heights an outline is read at.
pub const STATIONS: usize = 8;
/// How far they are apart, in head lengths.
pub const APART: f64 = 0.12;
/// The heights above the chin.
pub const HEIGHTS: [f64; STATIONS] = [0.04, 0.16, 0.28, 0.40, 0.52, 0.64, 0.76, 0.88];
/// The station that tells how deep the head is as a whole, above the ears; from there on up hair is part of the outline.
pub const DEEPEST: usize = 4;
/// Squares of the looks at a head, in head lengths.
const SQUARE: f64 = 0.01;
/// The front is read so far aside: beside the nose.
const BESIDE_NOSE: (f64, f64) = (0.06, 0.11);
/// The back is read within the first, and no further behind what is so far aside than the third number: there a tail
/// or a bun begins.
const BACK: (f64, f64, f64) = (0.09, 0.20, 0.15);
/// The chest and the trunk's back are read below the shoulder line, so far.
const TRUNK: (f64, f64) = (-0.305, -0.025);
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
        let behind: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, p.y, -p.z)).collect();
        let window = Window { low: DVec2::new(-0.66, -0.06), high: DVec2::new(0.66, 1.08), step: SQUARE };
        let bare = DepthMap::new(&points, &sources.bare, window);
        let hair = bare.clone().with(&points, &sources.hair);
        let back = DepthMap::new(&behind, &sources.bare, window).with(&behind, &sources.hair);
        let front = |y: f64| if y < HEIGHTS[DEEPEST] { &bare } else { &hair };
        let near = |y: f64| (y - 1.5 * SQUARE, y + 1.5 * SQUARE);
        let front_at = |y: f64| front(y).furthest(near(y), BESIDE_NOSE);
        let back_at = |y: f64| {
            let middle = back.furthest(near(y), (0.0, BACK.0))?;
            let beside = back.furthest(near(y), (BACK.0, BACK.1)).unwrap_or(middle);
            Some(middle.min(beside + BACK.2))
        };
        let y = HEIGHTS[DEEPEST];
        let (deepest_front, deepest_back) = (front_at(y)?, back_at(y)?);
        let middle = rounded(0.5 * (deepest_front - deepest_back));
        let deep = deepest_back + middle;
        let from = |depth: Option<f64>, origin: f64| depth.map_or(f64::NAN, |depth| rounded(depth - origin));
        let half_width = |map: &DepthMap, y: f64| map.reach(map.row(y), f64::NAN, |_| true);
        let steps = (1..50).map(|step| y - SQUARE * f64::from(step));
        let is_deep = |y: &f64| back_at(*y).is_some_and(|depth| depth + middle > OCCIPUT * deep);
        let occiput = steps.take_while(is_deep).last().unwrap_or(y);

        let shoulder_line = (shoulder_line - frame.origin.y) / frame.length;
        let rows = (shoulder_line + TRUNK.0, shoulder_line + TRUNK.1);
        let window =
            Window { low: DVec2::new(-BACK.0, rows.0), high: DVec2::new(BACK.0, rows.1), step: SQUARE };
        let chest = DepthMap::new(&points, &sources.trunk, window).furthest(rows, (0.0, BACK.0));
        let trunk_back = DepthMap::new(&behind, &sources.trunk, window).furthest(rows, (0.0, BACK.0));
        let chin = bare.furthest((0.02, 0.12), (0.0, BACK.0));
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

/// A number that is read of a head, to 2^-30 head lengths: a head that is only moved has the same, to the bit.
pub fn rounded(number: f64) -> f64 {
    (number * ROUNDING).round() / ROUNDING
}
