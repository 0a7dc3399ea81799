//! The table of the head: one row for each thing that makes it younger, in the order in which they are done.
//!
//! | row | about | what it does | why |
//! | --- | --- | --- | --- |
//! | brows | above the lids | rise with the lids and move apart as the eyes do, as one piece; a painted frown bends back | lids that open press them to a thin line; large eyes make a stern look a cross one |
//! | eyes | the balls' middles, or the openings' | grow, outwards and downwards, lids a little more | a child's are large and far apart; the bridge of the nose keeps its width |
//! | face sinks | the eyes' height | down | a child's eyes are below the middle of its head |
//! | outline | stations from chin to crown | wider, the skull deeper, the jaw back | a child's skull is round, its profile convex: full forehead, low occiput, a small jaw |
//! | cheeks | beside the mouth | outwards and forward | a child's face is broadest low, at its cheeks, and they are no flatter where hair hangs beside them |
//! | occiput | where the back of the head ends | down and with it the hair line | an adult's neck shows from chin to occiput |
//! | nose | between its tip and the face | shrinks | |
//! | mouth | by ratio below the nose | shrinks, its corners rise | at its old width it reaches across a child's face; a wide one has corners that hang |
//! | ears | where they grow out of the head | shrink, come closer | |
//!
//! What is above takes part of space first: brows hold against eyes, eyes against the rest. Each row's centre drifts with
//! what the rows below it do there.

use super::brows::Brows;
use super::dual::{Dual, step};
use super::eyes::{Eye, Eyes, Pair};
use super::face_landmarks::{Ears, FaceLandmarks, Nose, height_and_distance};
use super::iris::IrisFlow;
use super::kernel::{Kernel, velocity};
use super::outline::{APART, DEEPEST, HEIGHTS, Outline, STATIONS};
use crate::options::Features;
use glam::{DMat3, DVec3};

/// What the eyes and the skull should become, in head lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceAim {
    /// e: the geometric mean of an opening's half width and half height.
    pub eye_size: f64,
    /// ye: their height above the chin.
    pub eye_height: f64,
    /// Half the skull's width.
    pub skull_half_width: f64,
}

/// Eyes of a figurine (KayKit's): what a style without eyes of its own aims at.
const AIM_SIZE: f64 = 0.067;
/// A reference's eyes are no smaller than this for others (a toddler's .039 are no child's of a drawing; .055 left two of four
/// adults grown up).
const LEAST_AIM_SIZE: f64 = 0.06;
/// Eye heights that artists draw at 2.5 heads, and for each head more.
const AIM_HEIGHT: f64 = 0.40;
/// See [`AIM_HEIGHT`].
const AIM_HEIGHT_PER_HEAD: f64 = 0.025;
/// A reference's head is no narrower than this for others (a toddler's .41 is no child's of a drawing), and no wider
/// (KayKit's, with its hair, has .54).
const AIM_SKULLS: (f64, f64) = (0.44, 0.52);
/// The half width of a drawn child's skull: what a style without a head of its own aims at.
pub const CHILD_SKULL: f64 = 0.46;
/// Half its depth: figurines and toddlers have .48 to .50.
pub const CHILD_SKULL_DEPTH: f64 = 0.49;

impl FaceAim {
    /// What a figure of so many heads aims at, after a reference's eyes (size and height) and half its head's width where
    /// these are known.
    pub fn new(heads: f64, eyes: Option<(f64, f64)>, head_half_width: Option<f64>) -> Self {
        let (eye_size, eye_height) = match eyes {
            Some((size, height)) => (size.max(LEAST_AIM_SIZE), height),
            None => (AIM_SIZE, AIM_HEIGHT + AIM_HEIGHT_PER_HEAD * (heads - 2.5)),
        };
        let skull_half_width =
            head_half_width.map_or(CHILD_SKULL, |half| half.clamp(AIM_SKULLS.0, AIM_SKULLS.1));
        Self { eye_size, eye_height, skull_half_width }
    }
}

/// Eyes up to this size are an adult's; from the second on they are drawn, and the face stays.
const ADULT_EYES: (f64, f64) = (0.048, 0.060);
/// How adult a head without eyes is taken to be.
const ADULT_WITHOUT_EYES: f64 = 0.6;
/// Without eyes, what stands out by more than the first number and is narrower than the second is a nose.
const NOSE: (f64, f64) = (0.09, 0.1);

/// How adult a face is: 0, of eyes as large as they are drawn, to 1.
pub fn adultness(face: &FaceLandmarks) -> f64 {
    let Some(pair) = face.pair() else { return ADULT_WITHOUT_EYES };
    ((ADULT_EYES.1 - pair.size()) / (ADULT_EYES.1 - ADULT_EYES.0)).clamp(0.0, 1.0)
}

/// Half a child's head's width at each station of its outline up to [`DEEPEST`], where [`CHILD_SKULL`] is what it is at
/// most. Above, a skull widens as it does there and keeps its dome.
const CHILD_WIDTHS: [f64; 5] = [0.28, 0.40, 0.445, 0.455, 0.455];
/// How far a child's front and back are from the middle, where [`CHILD_SKULL_DEPTH`] is the most. Seen: a tenth more in the highest
/// makes crowns flat.
const CHILD_FRONTS: [f64; 8] = [0.385, 0.45, 0.475, 0.48, 0.485, 0.485, 0.455, 0.33];
/// See [`CHILD_FRONTS`].
const CHILD_BACKS: [f64; 8] = [0.14, 0.355, 0.42, 0.46, 0.48, 0.475, 0.425, 0.30];
/// A head widens by at most this factor, and no further with its hair than this.
const MOST_WIDENING: (f64, f64) = (1.25, 0.56);
/// The jaw goes back, and the front of the skull comes forward, by at most this.
const MOST_FORWARD: f64 = 0.08;
/// The back fills by at most this: above a tail that is taken for the back of a head, a crown gets a corner by more.
const MOST_BACK: f64 = 0.20;
/// What fills the back begins so far before the middle: a crown that ends close behind it gets a corner otherwise.
const BEFORE: f64 = 0.10;
/// Of the stations, so many are the jaw's, and so many with the cheeks', whose front stays.
const FACE_STATIONS: (usize, usize) = (2, 4);
/// The face sinks between these heights; below the first nothing moves.
const ENDS: (f64, f64) = (-0.06, 1.03);
/// The part of that which sinks as far as the eyes: more of it shortens what is below the nose.
const SINKS_AS_ONE: f64 = 0.1;
/// So many more stations above the last one do as it does: what is tied or worn on a skull is moved evenly.
const ABOVE: usize = 3;
/// The middle of a cheek: aside in half widths of the face, its height, and how far behind the front beside the mouth.
const CHEEK: [f64; 3] = [0.75, 0.18, 0.26];
/// Its reach: the middle of the mouth stays, and so does hair beside the face.
const CHEEK_REACH: [f64; 3] = [0.33, 0.22, 0.45];
/// How far a cheek fills outwards, and forward.
const CHEEK_FILLS: (f64, f64) = (0.038, 0.018);
/// The lowest occiput, how far it sinks at most: further, what is tied there becomes larger.
const OCCIPUT: (f64, f64) = (0.22, 0.14);
/// How far below its lower end the occiput is sunk about, and how far up that reaches: to the crown, or what is tied at the
/// back of a head becomes longer.
const OCCIPUT_REACH: (f64, f64) = (0.04, 0.80);

/// Eyes sink by at most this: like a reference whose eyes are at .30, nose and mouth would be pressed below them.
const MOST_SINKING: f64 = 0.07;
/// Eyes grow by at most this: the first behind lids, whose folds and shades grow with them; else the second.
const MOST_GROWTH: (f64, f64) = (1.40, 1.65);
/// The bridge of the nose keeps this part of its width.
const BRIDGE: f64 = 0.9;
/// A ball that shows more than this part of itself has no lids.
const BARE: f64 = 0.7;
/// Lids about an iris open to this part of the opening's width, and by at most this more.
const LIDS_OPEN: f64 = 0.50;
/// See [`LIDS_OPEN`].
const LIDS_MORE: f64 = 0.8;
/// What grows with an eye: so many half openings aside and up, and at least this part of the ball up.
const PLATEAU: [f64; 3] = [1.12, 1.5, 0.55];
/// The part of an eye's reach that moves as one.
const PLATEAU_OF_EYE: f64 = 0.5;
/// A socket's shade reaches so many times as far as what grows with the eye; the skin below it is so many of that further down;
/// below a painted brow it is whole from this on.
const SOCKET: [f64; 3] = [1.6, 1.2, 0.05];
/// The face curves back like a parabola of this radius.
const FACE_CURVE: f64 = 0.9;
/// The part of its growth in depth that a turning ball does behind its front.
const FRONT_STAYS: f64 = 0.85;
/// Balls are not taken to be wider than this, whatever was modelled of them.
const MOST_OVAL: f64 = 0.15;
/// An iris is a little higher than the opening, so that lids cut it.
const IRIS_FILLS: f64 = 1.12;
/// Larger, the rest of the ball's front would be pressed into too little of it.
const MOST_IRIS: f64 = 1.6;

/// How far above the upper lids the band is about which brows move as one, how far aside it reaches in half distances of the
/// eyes, and how far up: adults have theirs .03 to .11 above the lids. Both are one band, as brows that rise in their middles
/// alone frown; one that fades within less of the lids creases the skin between.
const BROWS: [f64; 3] = [0.075, 4.0, 0.20];
/// The part of its reach that moves as one.
const PLATEAU_OF_BROW: f64 = 0.4;
/// Painted brows frown by what their outer ends are higher than their inner ones, beyond the first number: that is bent back, at
/// most the second. Level ones look worried.
const FROWN: (f64, f64) = (0.012, 0.06);
/// Brows move apart by this part of what eyes do, by the logarithm, and grow as much: by all of it they are heavy.
const BROWS_APART: f64 = 0.5;

/// No row that shrinks leaves less than this part of a volume together with the rows before it: what is painted there would be
/// pressed.
const LEAST_VOLUME: f64 = 0.30;
/// The nose's reach: aside in half widths and half distances of the eyes, up of what lies there, behind in what it stands out by
/// and head lengths.
const NOSE_REACH: [f64; 5] = [1.9, 0.85, 0.92, 1.5, 0.08];
/// What the nose loses of its width, height and depth.
const NOSE_LESS: [f64; 3] = [0.28, 0.26, 0.50];
/// The mouth's middle, in heights of the nose's base.
const MOUTH: f64 = 0.55;
/// Its reach.
const MOUTH_REACH: [f64; 3] = [0.25, 0.12, 0.30];
/// What it loses of its width and height.
const MOUTH_LESS: [f64; 2] = [0.28, 0.10];
/// A mouth's corner is so far aside, reaches so far, and rises by so much, more for a smile.
const CORNER: [f64; 3] = [0.12, 0.13, 0.25];
/// See [`CORNER`].
const CORNER_RISES: (f64, f64) = (0.015, 0.022);
/// The part of a soft row's reach that has its full weight.
const SOFT: f64 = 0.375;
/// An ear reaches so far into the head, and so many half boxes up and forward.
const EAR_REACH: (f64, f64) = (0.05, 1.8);
/// What an ear loses of how far it stands out, its height and its depth.
const EAR_LESS: [f64; 3] = [0.44, 0.28, 0.26];
/// Half the size of the smallest ear: a box of a rim alone would have an edge too steep to follow.
const LEAST_EAR: f64 = 0.05;

/// What the table makes of a head.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// In the order in which they act.
    pub kernels: Vec<Kernel>,
    /// So many of them act on skin alone: hair hangs before brows and eyes.
    pub of_skin: usize,
    /// Brows that are painted.
    pub brows: Option<Brows>,
    /// The eyeballs' own.
    pub balls: Option<[Ball; 2]>,
}

/// An eyeball's way: an even scaling about its middle, so that it still turns in its socket.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball {
    /// Its middle before.
    pub from: DVec3,
    /// Its middle after.
    pub to: DVec3,
    /// ln of its scales.
    pub rates: DVec3,
    /// What its painted iris does.
    pub iris: Option<IrisFlow>,
}

impl Ball {
    /// Where a point of the ball is at `time`.
    pub fn map(&self, p: DVec3, time: f64) -> (DVec3, DMat3) {
        let scale = DVec3::from((time * self.rates).to_array().map(f64::exp));
        let p = self.iris.map_or(p, |iris| iris.map(p, time));
        let centre = self.from.lerp(self.to, time);
        (centre + scale * (p - self.from), DMat3::from_diagonal(scale))
    }
}

/// ln(1 - share).
fn less(share: f64) -> f64 {
    (1.0 - share).ln()
}

impl Rows {
    /// The rows that make `face` as young as `aim`; none for a face that is.
    ///
    /// - `face`, `outline`: in head lengths, as they are before.
    /// - `features`: what is asked of each feature.
    /// - `smile`: how far the mouth's corners rise.
    pub fn new(
        face: &FaceLandmarks,
        outline: Option<&Outline>,
        aim: &FaceAim,
        features: &Features,
        smile: f64,
    ) -> Self {
        let q = adultness(face);
        if q == 0.0 && smile == 0.0 {
            return Self::default();
        }
        let pair = face.pair();
        let mut rest: Vec<Kernel> = Vec::new();
        if let Some(pair) = pair {
            let sinks = q * features.lower * (pair.height - aim.eye_height).clamp(0.0, MOST_SINKING);
            let reach = Kernel::level(pair.height, pair.height - ENDS.0, ENDS.1 - pair.height);
            rest.push(Kernel { shift: -sinks * DVec3::Y, plateau: SINKS_AS_ONE, ..reach });
        }
        if let Some(outline) = outline {
            add_outline(&mut rest, outline, face, aim, features, q);
        }
        if let Some(nose) = &face.nose {
            // Of a head without eyes a nose may be the roundness of its front.
            let is_nose = pair.is_some() || nose.protrusion() > NOSE.0 && nose.half_width < NOSE.1;
            let k = q * f64::from(is_nose);
            add_nose(&mut rest, nose, pair, features.nose * k);
            add_mouth(&mut rest, nose, front(face), features.jaw * k, smile);
        }
        if let Some(ears) = &face.ears {
            add_ear(&mut rest, ears, features.ear * q);
        }
        let (mut kernels, mut balls) = (Vec::new(), None);
        if let (Some(pair), Some((_, eyes))) = (pair, &face.eyes) {
            let growth = Growth::of(eyes, pair, face, aim, q * features.eye, &rest);
            let made = [0, 1].map(|index| growth.eye(eyes, index, &rest));
            kernels = made.map(|(kernel, _)| kernel).to_vec();
            let brow = growth.brow(face.brows, front(face), &kernels, &rest);
            kernels.insert(0, brow);
            balls = Some(made.map(|(_, ball)| ball));
        }
        let of_skin = kernels.len();
        kernels.extend(rest);
        Self { kernels, of_skin, brows: face.brows, balls }
    }

    /// How much of what is painted at `p` is shade of a socket, and how much of `p` is the skin below that has none, 0 to 1
    /// each: as far as eyes grow.
    pub fn painted(&self, p: DVec3) -> [f64; 2] {
        let [_, eyes @ ..] = &self.kernels[..self.of_skin] else { return [0.0; 2] };
        let most = |below: f64| {
            let of = |eye: &Kernel| {
                let from = (p - eye.centre) / SOCKET[0] + DVec3::Y * (below / eye.per_low.y);
                eye.weight((eye.centre + from).to_array())
            };
            eyes.iter().map(of).fold(0.0, f64::max)
        };
        let below_brow = self.brows.map_or(1.0, |Brows { inner, outer }| {
            let brow = inner + (outer - inner) * ((p.x.abs() - inner.x) / (outer.x - inner.x));
            step((brow.y - p.y) / SOCKET[2])
        });
        [below_brow * most(0.0), most(SOCKET[1])]
    }

    /// How much `p` takes part where lids open more than the ball between them grows, 0 to 1.
    pub fn opens_lids(&self, p: DVec3) -> f64 {
        let eyes = self.kernels[..self.of_skin].iter().rev().take(2);
        let opening = eyes.filter(|eye| eye.rates.y > eye.rates.x);
        opening.map(|eye| eye.weight(p.to_array())).fold(0.0, f64::max)
    }
}

/// The kernel, whose centre drifts with what `rows` do there, and which shrinks no more than they leave it to.
fn drifting(kernel: Kernel, rows: &[Kernel]) -> Kernel {
    let (drift, slope) = Dual::split(velocity(rows, Dual::point(kernel.centre)));
    let left = LEAST_VOLUME.ln() - (slope.x_axis.x + slope.y_axis.y + slope.z_axis.z);
    let sum = kernel.rates.element_sum();
    let share = if sum < left.min(0.0) { (left / sum).max(0.0) } else { 1.0 };
    Kernel { drift, rates: share * kernel.rates, ..kernel }
}

/// The head's outline becomes a child's.
fn add_outline(
    rows: &mut Vec<Kernel>,
    outline: &Outline,
    face: &FaceLandmarks,
    aim: &FaceAim,
    features: &Features,
    q: f64,
) {
    let sinks = features.skull * q * (outline.occiput - OCCIPUT.0).clamp(0.0, OCCIPUT.1);
    let y = outline.occiput - OCCIPUT_REACH.0;
    let occiput = Kernel { shift: -sinks * DVec3::Y, ..Kernel::level(y, y - ENDS.0, OCCIPUT_REACH.1) }
        .ramp(outline.middle, outline.middle - 0.35);
    // How deep the back is once the occiput has sunk.
    let back_after = |station: usize| {
        let y = HEIGHTS[station];
        let up = velocity(&[occiput], [0.0, y, outline.middle - 0.4])[1];
        interpolated(&outline.backs, y - up)
    };
    let deep = 0.5 * (outline.fronts[DEEPEST] + outline.backs[DEEPEST]);
    let depth = (deep / (0.5 * (CHILD_FRONTS[DEEPEST] + CHILD_BACKS[DEEPEST]))).clamp(0.9, 1.1);
    let width = aim.skull_half_width / CHILD_SKULL;
    for index in 0..STATIONS + ABOVE {
        let station = index.min(STATIONS - 1);
        let y = HEIGHTS[0] + APART * index as f64;
        // What is asked for there, and how far its front goes back and forward.
        let (feature, goes) = match station {
            jaw if jaw < FACE_STATIONS.0 => (features.jaw, (-MOST_FORWARD, 0.0)),
            cheek if cheek < FACE_STATIONS.1 => (features.cheek, (0.0, 0.0)),
            _ => (features.skull, (0.0, MOST_FORWARD)),
        };
        let row = Kernel::level(y, (y - ENDS.0).min(2.0 * APART), 2.0 * APART);
        // Bells half their reach apart add up to 1.5, the lowest and its one neighbour to 1.25.
        let k = q / 1.5;
        let lowest = if station == 0 { 1.5 / 1.25 } else { 1.0 };
        let beside_ear = face.ears.filter(|ears| ears.low.y < y && y < ears.high.y);
        let wide = station.min(DEEPEST);
        let half_width = outline.half_widths[wide].min(beside_ear.map_or(f64::INFINITY, |ears| ears.root));
        let most = (MOST_WIDENING.1 / outline.with_hair[station]).max(1.0).min(MOST_WIDENING.0);
        let wider = some((width * CHILD_WIDTHS[wide] / half_width).clamp(1.0, most).ln());
        // Against the forehead: a tail that is taken for the back of a head moves its middle.
        let before_forehead = |fronts: &[f64; STATIONS]| fronts[station] - fronts[DEEPEST];
        let forward = depth * before_forehead(&CHILD_FRONTS) - before_forehead(&outline.fronts);
        let forward = some(lowest * forward.clamp(goes.0, goes.1));
        let own = back_after(station);
        let back = some((depth * CHILD_BACKS[station] - own).clamp(0.0, MOST_BACK));
        let (front_z, back_z) = (outline.middle + outline.fronts[station], outline.middle - own.max(0.1));
        rows.push(Kernel { rates: DVec3::X * (k * feature * wider), ..row });
        // The chin's underside goes with it.
        let front =
            Kernel { shift: DVec3::Z * (k * feature * forward), ..row }.between(2.0 * APART, 2.0 * APART);
        rows.push(front.ramp(outline.middle, some(front_z).max(outline.middle + 0.2)));
        let back = Kernel { shift: -DVec3::Z * (k * features.skull * back), ..row };
        rows.push(back.ramp(outline.middle + BEFORE, back_z));
    }
    rows.push(occiput);
    // A head without eyes has no cheeks: these would be jowls.
    add_cheeks(rows, outline, face, features.cheek * q * f64::from(face.eyes.is_some()));
    rows.retain(|row| row.shift != DVec3::ZERO || row.rates != DVec3::ZERO);
}

/// Both cheeks fill beside the mouth.
fn add_cheeks(rows: &mut Vec<Kernel>, outline: &Outline, face: &FaceLandmarks, k: f64) {
    let front = outline.middle + some(outline.fronts[1]).max(0.2);
    let centre = DVec3::new(CHEEK[0] * face.half_width, CHEEK[1], front - CHEEK[2]);
    let shift = k * DVec3::new(CHEEK_FILLS.0, 0.0, CHEEK_FILLS.1);
    let cheek = Kernel { shift, ..Kernel::about(centre, CHEEK_REACH.into()) };
    rows.extend([cheek, cheek.mirrored()]);
}

/// Nothing where nothing is seen.
fn some(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}

/// What `values` at the stations are at the height `y`.
fn interpolated(values: &[f64; STATIONS], y: f64) -> f64 {
    let above = HEIGHTS.iter().position(|&height| height > y).unwrap_or(STATIONS - 1).max(1);
    let t = ((y - HEIGHTS[above - 1]) / (HEIGHTS[above] - HEIGHTS[above - 1])).clamp(0.0, 1.0);
    values[above - 1] + t * (values[above] - values[above - 1])
}

fn add_nose(rows: &mut Vec<Kernel>, nose: &Nose, pair: Option<Pair>, k: f64) {
    let (ye, d) = height_and_distance(pair);
    let out = nose.protrusion();
    let wide = (NOSE_REACH[0] * nose.half_width).min(NOSE_REACH[1] * d);
    let down = nose.tip.y - nose.base + 0.05;
    let up = NOSE_REACH[2] * (ye - nose.tip.y).max(0.08);
    let centre = DVec3::new(nose.tip.x, nose.tip.y + 0.012, nose.side_z + 0.2 * out);
    let reach = DVec3::new(wide, 1.0, NOSE_REACH[3] * out + NOSE_REACH[4]);
    let rates = DVec3::from(NOSE_LESS.map(|share| less(k * share)));
    let row = Kernel { rates, plateau: SOFT, ..Kernel::about(centre, reach).between(down, up) };
    rows.push(drifting(row, rows));
}

fn add_mouth(rows: &mut Vec<Kernel>, nose: &Nose, front: f64, k: f64, smile: f64) {
    let centre = DVec3::new(0.0, MOUTH * nose.base, front);
    let rates = DVec3::new(less(k * MOUTH_LESS[0]), less(k * MOUTH_LESS[1]), 0.0);
    let mouth = Kernel { rates, plateau: SOFT, ..Kernel::about(centre, MOUTH_REACH.into()) };
    let shift = DVec3::Y * (k * CORNER_RISES.0 + smile * CORNER_RISES.1);
    let corner = Kernel { shift, ..Kernel::about(centre + DVec3::X * CORNER[0], CORNER.into()) };
    let made = [mouth, corner, corner.mirrored()].map(|row| drifting(row, rows));
    rows.extend(made.into_iter().filter(|row| row.shift != DVec3::ZERO || row.rates != DVec3::ZERO));
}

fn add_ear(rows: &mut Vec<Kernel>, ears: &Ears, k: f64) {
    let half = (0.5 * (ears.high - ears.low)).max(DVec3::splat(LEAST_EAR));
    let centre = (0.5 * (ears.high + ears.low)).with_x(ears.root);
    let mut ear = Kernel::about(centre, EAR_REACH.1 * half);
    ear.per_low.x = 1.0 / EAR_REACH.0;
    ear.per_high.x = 1.0 / (EAR_REACH.1 * (2.0 * half.x).max(ears.reach()));
    (ear.rates, ear.plateau) = (DVec3::from(EAR_LESS.map(|share| less(k * share))), SOFT);
    let made = [ear, ear.mirrored()].map(|row| drifting(row, rows));
    rows.extend(made);
}

/// How both eyes grow.
struct Growth {
    pair: Pair,
    /// How much adult features change, times what is asked of the eyes.
    k: f64,
    /// s: how much wider eyes become.
    wider: f64,
    /// d after.
    half_distance: f64,
    /// The middle between both eyes.
    middle: f64,
}

impl Growth {
    fn of(eyes: &Eyes, pair: Pair, face: &FaceLandmarks, aim: &FaceAim, k: f64, rest: &[Kernel]) -> Self {
        let (a, d) = (pair.half_width, pair.half_distance);
        let wide = (velocity(rest, [d, pair.height, front(face)])[0] / d).exp();
        let gap = BRIDGE * (d - a);
        let behind_lids = eyes.iter().all(|eye| eye.half_height() < BARE * eye.radius());
        let most_growth = if behind_lids { MOST_GROWTH.0 } else { MOST_GROWTH.1 };
        let wider = 1.0 + k * ((aim.eye_size / pair.size()).clamp(1.0, most_growth) - 1.0);
        let half_distance = (d * wide).max(gap + wider * a);
        let middle = 0.5 * (eyes[0].middle().x + eyes[1].middle().x);
        Self { pair, k, wider, half_distance, middle }
    }

    /// The row of one eye, and what its ball does.
    fn eye(&self, eyes: &Eyes, index: usize, rest: &[Kernel]) -> (Kernel, Ball) {
        let (eye, side) = (&eyes[index], if index == 0 { 1.0 } else { -1.0 });
        let Self { pair, k, wider: s, half_distance: d2, middle } = *self;
        let (a, b, d) = (pair.half_width, pair.half_height, pair.half_distance);
        let (radius, opening) = (eye.radius(), eye.middle());
        let ball = eye.ball.as_ref();
        let turning = ball.filter(|ball| ball.turns);
        let opens = self.opens(eye);
        let scale = match turning {
            // A ball that the head's own widening made an oval becomes round again.
            Some(ball) => {
                let extent = ball.high - ball.low;
                let most = DVec3::splat(1.0 + MOST_OVAL);
                s * (DVec3::splat(extent.x) / extent).clamp(most.recip(), most).lerp(DVec3::ONE, 1.0 - k)
            }
            // In depth too it would bulge like goggles.
            None => DVec3::new(s, s, 1.0),
        };
        let from = match ball {
            Some(ball) if ball.turns => ball.centre,
            Some(ball) => opening.with_z(ball.centre.z),
            None => opening,
        };
        let carried = DVec3::from(velocity(rest, opening.to_array()));
        let mut to = DVec3::new(
            middle + side * d2 + s * (from.x - opening.x),
            from.y + carried.y,
            // The face curves back where the eyes go.
            from.z + carried.z - (d2 * d2 - d * d) / FACE_CURVE,
        );
        if turning.is_some() {
            to.y += (scale.y - 1.0) * (from.y - opening.y);
            to.z -= FRONT_STAYS * (scale.z - 1.0) * (opening.z - from.z);
        }
        let rx = (PLATEAU[0] * a).max(radius.min(0.70 * d2 / s)).min(0.78 * d);
        let ry = (PLATEAU[1] * b).max(PLATEAU[2] * radius).min(1.25 * rx);
        let reach = DVec3::new(rx, ry, radius) / PLATEAU_OF_EYE;
        let row = Kernel {
            drift: to - from,
            rates: (scale * DVec3::new(1.0, opens, 1.0)).to_array().map(f64::ln).into(),
            shift: to - from,
            plateau: PLATEAU_OF_EYE,
            holds: true,
            ..Kernel::about(from, reach)
        };
        let iris = self.iris(eye, opens);
        (row, Ball { from, to, rates: scale.to_array().map(f64::ln).into(), iris })
    }

    /// How much more than the eye grows its lids open.
    fn opens(&self, eye: &Eye) -> f64 {
        let Pair { half_width: a, half_height: b, .. } = self.pair;
        // Wide lids about no iris, or a small one, stare.
        match eye.ball.as_ref().filter(|ball| ball.iris.is_some()) {
            Some(ball) if !ball.is_ball() || b <= BARE * eye.radius() => {
                (LIDS_OPEN * a / b).clamp(1.0, 1.0 + self.k * LIDS_MORE)
            }
            _ => 1.0,
        }
    }

    fn iris(&self, eye: &Eye, opens: f64) -> Option<IrisFlow> {
        let ball = eye.ball.as_ref()?;
        let (iris, half, middle) = (ball.iris?, 0.5 * (ball.high - ball.low), 0.5 * (ball.high + ball.low));
        let fills = IRIS_FILLS * self.pair.half_height * opens / (half.y * iris.angle.sin());
        let growth = 1.0 + self.k * (fills.clamp(1.0, MOST_IRIS) - 1.0);
        Some(IrisFlow { middle, half, iris, growth })
    }

    /// Both brows as one piece: they rise with the upper lids and move apart as the eyes do; painted ones that frown bend.
    fn brow(&self, brows: Option<Brows>, front: f64, eyes: &[Kernel], rest: &[Kernel]) -> Kernel {
        let Pair { half_distance: d, height, half_height, .. } = self.pair;
        let lid = DVec3::new(d, height + half_height, front);
        let centre = DVec3::new(0.0, lid.y + BROWS[0], lid.z);
        let carried = DVec3::from(velocity(rest, centre.to_array()));
        let bend = self.k
            * brows.map_or(0.0, |Brows { inner, outer }| {
                let frown = (outer.y - inner.y - FROWN.0).clamp(0.0, FROWN.1);
                -frown / (outer.x * outer.x - inner.x * inner.x)
            });
        // Of both lids, as a head is never quite symmetric; what is above the eyes' middles keeps its height over them.
        let lids = [1.0, -1.0].map(|side| velocity(eyes, [side * lid.x, lid.y, lid.z])[1]);
        let shift = carried.with_y(carried.y.max(0.5 * (lids[0] + lids[1])) - bend * d * d);
        let apart = BROWS_APART * (self.half_distance / d).ln();
        let reach = DVec3::new(BROWS[1] * d, 1.0, 0.3);
        let row = Kernel::about(centre, reach).between(BROWS[0], BROWS[2]);
        let rates = DVec3::new(apart, apart, 0.0);
        Kernel { rates, shift, bend, drift: shift, plateau: PLATEAU_OF_BROW, holds: true, ..row }
    }
}

/// zf: the depth of the face's front.
fn front(face: &FaceLandmarks) -> f64 {
    match (&face.eyes, &face.nose) {
        (Some((_, eyes)), _) => 0.5 * (eyes[0].high.z + eyes[1].high.z),
        (None, Some(nose)) => nose.side_z,
        (None, None) => 0.0,
    }
}
