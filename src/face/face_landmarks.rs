//! What a face is made of, read from the geometry: eyes, nose, mouth, ears, the widths of face and skull.

use super::brows::{Brows, brows};
use super::eyes::{Eye, EyeSource, Eyeball, Eyes, Pair, eyes};
use super::head::{Head, quantile};
use super::raster::{DepthMap, Window};
use crate::geometry::{self, bounds, marked};
use glam::{DVec2, DVec3};

/// A face, in head lengths: x to the character's left from the middle, y up from the chin, z to the front.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceLandmarks {
    /// Left and right eye, where they were found.
    pub eyes: Option<(EyeSource, Eyes)>,
    /// What share of the eyes' openings hair covers, of the one that it covers less.
    pub covered: f64,
    /// The brows' line, where one is painted.
    pub brows: Option<Brows>,
    /// The nose, where one stands out.
    pub nose: Option<Nose>,
    /// we: half the face's width at the eyes.
    pub half_width: f64,
    /// W: half the skull's width.
    pub skull_half_width: f64,
    /// The ears, where they stick out.
    pub ears: Option<Ears>,
}

/// A nose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nose {
    /// Its foremost point.
    pub tip: DVec3,
    /// How far back the face is beside it, at the tip's height.
    pub side_z: f64,
    /// Half its width.
    pub half_width: f64,
    /// The height of its base.
    pub base: f64,
}

impl Nose {
    /// How far it stands out of the face.
    pub fn protrusion(&self) -> f64 {
        self.tip.z - self.side_z
    }
}

/// Both ears, as the right one would be on the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ears {
    /// w: how far aside the head is, where they grow out of it.
    pub root: f64,
    /// Their lower end towards the back, and how far aside they begin.
    pub low: DVec3,
    /// Their upper end towards the front, and how far aside they reach.
    pub high: DVec3,
}

impl Ears {
    /// How far they stick out.
    pub fn reach(&self) -> f64 {
        self.high.x - self.root
    }
}

impl FaceLandmarks {
    /// Reads the face of `head`.
    pub fn of(head: &Head) -> Self {
        let eyes = eyes(head);
        let pair = eyes.as_ref().map(|(_, eyes)| Pair::of(eyes));
        let (ye, d) = height_and_distance(pair);
        Self {
            covered: eyes.as_ref().map_or(0.0, |(_, eyes)| covered(head, eyes)),
            brows: pair.and_then(|pair| brows(head, pair)),
            nose: nose(head, ye, d),
            half_width: half_width_at(head, ye, d),
            skull_half_width: skull_half_width(head),
            ears: ears(head, ye),
            eyes,
        }
    }

    /// What both eyes have in common, where they were found.
    pub fn pair(&self) -> Option<Pair> {
        self.eyes.as_ref().map(|(_, eyes)| Pair::of(eyes))
    }

    /// True where both eyes are turned by joints.
    pub fn eyes_turn(&self) -> bool {
        let turns = |eye: &Eye| eye.ball.as_ref().is_some_and(|ball| ball.turns);
        self.eyes.as_ref().is_some_and(|(_, eyes)| eyes.iter().all(turns))
    }

    /// The same face where `map` takes each point, both in head lengths: what the parts' maps and Eq. 13 leave to do.
    pub fn mapped(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        let aside = |half_width: f64, y: f64, z: f64| {
            0.5 * (map(DVec3::new(half_width, y, z)).x - map(DVec3::new(-half_width, y, z)).x)
        };
        let (ye, _) = height_and_distance(self.pair());
        let eye = |eye: &Eye| Eye {
            low: map(eye.low),
            high: map(eye.high),
            ball: eye.ball.as_ref().map(|ball| Eyeball {
                low: map(ball.low),
                high: map(ball.high),
                centre: map(ball.centre),
                ..ball.clone()
            }),
        };
        let nose = |Nose { tip, side_z, half_width, base }: Nose| Nose {
            tip: map(tip),
            side_z: map(tip.with_z(side_z)).z,
            half_width: aside(half_width, tip.y, side_z),
            base: map(tip.with_y(base)).y,
        };
        let ears = |Ears { root, low, high }: Ears| {
            let middle = 0.5 * (low + high);
            Ears { root: aside(root, middle.y, middle.z), low: map(low), high: map(high) }
        };
        let end = |end: DVec2| DVec2::new(aside(end.x, end.y, 0.0), map(end.extend(0.0)).y);
        Self {
            covered: self.covered,
            brows: self.brows.map(|brows| Brows { inner: end(brows.inner), outer: end(brows.outer) }),
            eyes: self.eyes.as_ref().map(|(source, eyes)| (*source, eyes.each_ref().map(eye))),
            nose: self.nose.map(nose),
            half_width: aside(self.half_width, ye, 0.0),
            skull_half_width: aside(self.skull_half_width, 0.5 * (SKULL_ROWS.0 + SKULL_ROWS.1), 0.0),
            ears: self.ears.map(ears),
        }
    }
}

/// What share of the openings hair covers, seen from the front; of the one that it covers less.
fn covered(head: &Head, eyes: &Eyes) -> f64 {
    let with_hair = head.with_hair();
    let of = |eye: &Eye| {
        let half = DVec2::new(eye.half_width(), eye.half_height());
        let (low, high) = (eye.middle().truncate() - half, eye.middle().truncate() + half);
        let window = Window { low, high, step: 0.2 * half.min_element() };
        let view = DepthMap::new(&head.points, &with_hair, window);
        let seen = view.squares().filter_map(|(column, row)| view.triangle(column, row));
        let is_hair = |triangle: usize| head.parts.is_hair[with_hair[triangle][0] as usize];
        geometry::mean(seen.map(|triangle| f64::from(is_hair(triangle)))).unwrap_or(0.0)
    };
    of(&eyes[0]).min(of(&eyes[1]))
}

/// Where eyes are looked beside, where none were found, in head lengths: an adult's.
const EYE_HEIGHT: f64 = 0.48;
/// See [`EYE_HEIGHT`].
const EYE_HALF_DISTANCE: f64 = 0.15;

/// The height of the eyes and half their distance, found or not.
pub fn height_and_distance(pair: Option<Pair>) -> (f64, f64) {
    pair.map_or((EYE_HEIGHT, EYE_HALF_DISTANCE), |pair| (pair.height, pair.half_distance))
}

/// The nose lies between these parts of the eyes' height.
const NOSE_RANGE: (f64, f64) = (0.45, 0.80);
/// The face beside the nose is taken this far aside, in half distances of the eyes.
const BESIDE_NOSE: f64 = 0.62;
/// What stands out less, in head lengths, is no nose.
const NOSE_LEAST: f64 = 0.02;
/// Columns about the middle in which the nose is looked for.
const NOSE_STRIP: f64 = 0.025;
/// A nose is as wide as what stands out by more than this share of the tip; at least so many head lengths to each side.
const NOSE_WIDTH: (f64, f64) = (0.3, 0.025);
/// Its base is where less than this share of the tip stands out, and at most this far below it.
const NOSE_BASE: (f64, f64) = (0.2, 0.09);

fn nose(head: &Head, ye: f64, d: f64) -> Option<Nose> {
    let aside = BESIDE_NOSE * d;
    const STEP: f64 = 0.004;
    let half = aside + 2.0 * STEP;
    let (low, high) = (DVec2::new(-half, 0.5 * NOSE_RANGE.0 * ye - NOSE_BASE.1), DVec2::new(half, ye));
    let view = &head.front_view(low, high, STEP);
    let columns = |from: f64, to: f64| {
        (0..view.columns()).filter(move |&column| (from..=to).contains(&view.middle(column, 0).x))
    };
    let foremost = |row: usize| {
        columns(-NOSE_STRIP, NOSE_STRIP).filter_map(|column| view.depth(column, row)).max_by(f64::total_cmp)
    };
    let beside = |row: usize| {
        let mean = |middle: f64| {
            geometry::mean(columns(middle - STEP, middle + STEP).filter_map(|column| view.depth(column, row)))
        };
        Some(0.5 * (mean(-aside)? + mean(aside)?))
    };
    let out = |row: usize| Some((foremost(row)?, beside(row)?));
    let in_range = |row: usize| {
        let y = view.middle(0, row).y;
        y > NOSE_RANGE.0 * ye && y < NOSE_RANGE.1 * ye
    };
    let score = |row: usize| out(row).map(|(z, side)| (z - side, row));
    let scores = (0..view.rows()).filter(|&row| in_range(row)).filter_map(score);
    let (_, mut row) = scores.reduce(|best, next| if next.0 > best.0 { next } else { best })?;
    // From there to the local tip.
    while let Some(next) = [row + 1, row.wrapping_sub(1)]
        .into_iter()
        .filter(|&next| next < view.rows() && in_range(next))
        .find(|&next| foremost(next) > foremost(row))
    {
        row = next;
    }
    let (z, side_z) = out(row)?;
    let protrusion = z - side_z;
    if protrusion < NOSE_LEAST {
        return None;
    }
    let y = view.middle(0, row).y;
    let half_width = view.reach(row, |z| z - side_z > NOSE_WIDTH.0 * protrusion).max(NOSE_WIDTH.1);
    let mut base = y;
    while base > y - NOSE_BASE.1
        && view.row(base) > 0
        && out(view.row(base)).is_some_and(|(z, side)| z - side > NOSE_BASE.0 * protrusion)
    {
        base -= STEP;
    }
    Some(Nose { tip: DVec3::new(0.0, y, z), side_z, half_width, base })
}

/// What is further back than this from the skin beside the eyes is no face any more, in head lengths.
const FACE_DEPTH: f64 = 0.16;

/// we: half the width of what looks to the front at the height of the eyes.
fn half_width_at(head: &Head, ye: f64, d: f64) -> f64 {
    let skin = [-d, d].into_iter().filter_map(|x| head.front.depth_at(DVec2::new(x, ye)));
    let front = skin.fold(f64::NEG_INFINITY, f64::max);
    head.front.reach(head.front.row(ye), |z| z > front - FACE_DEPTH)
}

/// Heights at which a skull is measured: above the ears, below the crown.
const SKULL_ROWS: (f64, f64) = (0.52, 0.72);

/// W: how far aside 98 of 100 vertices between these heights are: between the two next to it, as low-poly heads have few.
fn skull_half_width(head: &Head) -> f64 {
    let is_used = marked(head.points.len(), head.bare.iter().flatten().map(|&vertex| vertex as usize));
    let is_near = |p: &DVec3| p.y > SKULL_ROWS.0 && p.y < SKULL_ROWS.1;
    let used = head.points.iter().zip(is_used).filter(|&(p, is_used)| is_used && is_near(p));
    let mut aside: Vec<f64> = used.map(|(p, _)| p.x.abs()).collect();
    aside.sort_unstable_by(f64::total_cmp);
    let Some(last) = aside.len().checked_sub(1) else { return 0.0 };
    let place = 0.98 * last as f64;
    let (below, above) = (aside[place.floor() as usize], aside[place.ceil() as usize]);
    below + (above - below) * place.fract()
}

/// Rows that ears are looked for in: their height, and the lowest and the highest against the eyes'.
const EAR_ROW: f64 = 0.08;
/// See [`EAR_ROW`].
const EAR_ROWS: (f64, f64) = (-0.26, 0.12);
/// How far back and forth of the head's middle their backs are.
const EAR_BACK: (f64, f64) = (-0.36, 0.12);
/// Going forward, an ear's back jumps out by at least this.
const EAR_JUMP: f64 = 0.03;
/// Believed roots and reaches.
const EAR_ROOT: std::ops::Range<f64> = 0.28..0.52;
/// See [`EAR_ROOT`].
const EAR_REACH: std::ops::Range<f64> = 0.02..0.2;

fn ears(head: &Head, ye: f64) -> Option<Ears> {
    const STEP: f64 = 0.01;
    let (bottom, top) = (ye + EAR_ROWS.0, ye + EAR_ROWS.1);
    let (low, high) = bounds(head.bare.iter().flatten().map(|&vertex| head.points[vertex as usize]));
    let middle = 0.5 * (low.z + high.z);
    let (low, high) =
        (DVec2::new(middle + EAR_BACK.0 - 0.1, bottom), DVec2::new(middle + EAR_BACK.1 + 0.25, top));
    let views = [1.0, -1.0].map(|side| head.side_view(side, low, high, STEP));
    let view = &views[0];
    let rows_of_band = (EAR_ROW / STEP).round() as usize;
    let is_back =
        |&column: &usize| (middle + EAR_BACK.0..middle + EAR_BACK.1).contains(&view.middle(column, 0).x);
    // Of a band of rows: the root, the rows, and the column from which on the ear jumps out.
    let jump = |band: usize| {
        let rows = band * rows_of_band..(band + 1) * rows_of_band;
        let reach = |column: usize| {
            let mut all: Vec<f64> = views
                .iter()
                .flat_map(|view| rows.clone().filter_map(move |row| view.depth(column, row)))
                .collect();
            quantile(&mut all, 0.97)
        };
        (2..view.columns()).filter(is_back).find_map(|column| {
            let (before, here) = (reach(column - 2)?, reach(column)?);
            // The skin rises towards the ear before it jumps.
            let root = || reach(column.saturating_sub(8)).map_or(before, |behind| behind.min(before));
            (here - before >= EAR_JUMP).then(|| (root(), rows.clone(), column))
        })
    };
    let jumps: Vec<_> = (0..view.rows() / rows_of_band).filter_map(jump).collect();
    let mut roots: Vec<f64> = jumps.iter().map(|&(root, ..)| root).collect();
    let root = quantile(&mut roots, 0.8)?;
    let is_ear = |&(column, row): &(usize, usize)| {
        jumps.iter().any(|(_, rows, first)| rows.contains(&row) && column >= first - 1)
    };
    let (low, high) = bounds(views.iter().flat_map(|view| {
        view.squares().filter(is_ear).filter_map(|(column, row)| {
            let aside = view.depth(column, row).filter(|&aside| aside > root + 0.25 * EAR_JUMP)?;
            let z_y = view.middle(column, row);
            Some(DVec3::new(aside, z_y.y, z_y.x))
        })
    }));
    let ears = Ears { root, low, high };
    (EAR_ROOT.contains(&root) && EAR_REACH.contains(&ears.reach())).then_some(ears)
}
