//! How a face is made younger: from what it is, what the reference is, and how much is asked for, to the flow.

use super::brows::Brows;
use super::eyes::Eye;
use super::eyes::Pair;
use super::flow::{Bell, BrowFlow, EarFlow, EyeFlow, Flow, Follower, Lids, Shrink};
use super::iris::{IrisFlow, MOST_GROWTH as MOST_IRIS};
use super::landmarks::{Ears, FaceLandmarks, Nose};
use crate::options::Features;
use glam::{DVec2, DVec3};

/// What the eyes should become, in head lengths.
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
/// A reference's eyes are no larger than this for others (godette's .084 leave a realistic face no cheeks), and no
/// smaller (a toddler's .039 are no child's of a drawing; .055 left two of four adults grown up).
const AIM_SIZES: (f64, f64) = (0.06, 0.08);
/// Eye heights that artists draw at 2.5 heads, for each head more, and bounds.
const AIM_HEIGHT: f64 = 0.40;
/// See [`AIM_HEIGHT`].
const AIM_HEIGHT_PER_HEAD: f64 = 0.025;
/// See [`AIM_HEIGHT`].
const AIM_HEIGHTS: (f64, f64) = (0.37, 0.46);

impl FaceAim {
    /// What a figure of so many heads aims at, after a reference's eyes (size and height) and half its head's width where
    /// these are known.
    pub fn new(heads: f64, eyes: Option<(f64, f64)>, head_half_width: Option<f64>) -> Self {
        let (eye_size, eye_height) = match eyes {
            Some((size, height)) => (size.clamp(AIM_SIZES.0, AIM_SIZES.1), height),
            None => {
                let height = AIM_HEIGHT + AIM_HEIGHT_PER_HEAD * (heads - 2.5);
                (AIM_SIZE, height.clamp(AIM_HEIGHTS.0, AIM_HEIGHTS.1))
            }
        };
        let skull_half_width =
            head_half_width.map_or(CHILD_SKULL, |half| half.clamp(AIM_SKULLS.0, AIM_SKULLS.1));
        Self { eye_size, eye_height, skull_half_width }
    }
}

/// An eye is as adult as can be where it is this much smaller than wanted, as a part of what is wanted.
const ADULT: f64 = 0.3;
/// How adult a face without eyes is taken to be where it has an adult's nose: it stands out by more than the first
/// number and is narrower than the second.
const ADULT_WITHOUT_EYES: f64 = 0.6;
/// See [`ADULT_WITHOUT_EYES`].
const ADULT_NOSE: (f64, f64) = (0.09, 0.1);
/// Eyes sink by at most this.
const MOST_SINKING: f64 = 0.07;
/// Eyes grow by at most this: on realistic faces 1.75 looked like a bulging eye.
const MOST_GROWTH: f64 = 1.65;
/// Of the face's half width, both eyes and the bridge between them fill at most this.
const ROOM: f64 = 0.84;
/// The bridge of the nose keeps this part of its width.
const BRIDGE: f64 = 0.9;
/// The half width of a drawn child's skull: what a style without a head of its own aims at.
pub const CHILD_SKULL: f64 = 0.46;
/// Half its depth: figurines and toddlers have .48 to .50.
pub const CHILD_SKULL_DEPTH: f64 = 0.49;
/// A reference's head is no narrower than this for others (a toddler's .41 is no child's of a drawing), and no wider
/// (KayKit's, with its hair, has .54).
const AIM_SKULLS: (f64, f64) = (0.44, 0.52);
/// A skull widens by at most this.
const MOST_WIDENING: f64 = 0.16;

/// How adult a face is, 0 (eyes as large as wanted) to 1.
pub fn adultness(face: &FaceLandmarks, aim: &FaceAim) -> f64 {
    match &face.eyes {
        Some((_, eyes)) => {
            let missing = (aim.eye_size - Pair::of(eyes).size()) / (ADULT * aim.eye_size);
            missing.clamp(0.0, 1.0)
        }
        None => face
            .nose
            .filter(|nose| nose.protrusion() > ADULT_NOSE.0 && nose.half_width < ADULT_NOSE.1)
            .map_or(0.0, |_| ADULT_WITHOUT_EYES),
    }
}

/// ln(1 - share).
fn less(share: f64) -> f64 {
    (1.0 - share).ln()
}

impl Flow {
    /// The flow that makes `face` as young as `aim`; the identity for a face that is.
    ///
    /// - `face`: in head lengths, as it is before the flow.
    /// - `features`: what is asked of each feature.
    /// - `smile`: how far the mouth's corners rise.
    pub fn new(face: &FaceLandmarks, aim: &FaceAim, features: &Features, smile: f64) -> Self {
        let q = adultness(face, aim);
        let pair = face.eyes.as_ref().map(|(_, eyes)| Pair::of(eyes));
        let grows = pair.is_some_and(|pair| pair.size() < aim.eye_size);
        if q == 0.0 && !grows && smile == 0.0 {
            return Self::default();
        }
        let wider = (aim.skull_half_width / face.skull_half_width - 1.0).clamp(0.0, MOST_WIDENING);
        let mut flow = Self { widening: (q * features.skull * wider).ln_1p(), ..Self::default() };
        if let (Some(pair), Some((_, eyes))) = (pair, &face.eyes) {
            flow.eye_height = pair.height;
            flow.sinks = q * features.lower * (pair.height - aim.eye_height).clamp(0.0, MOST_SINKING);
            flow.add_eyes(eyes, face, pair, aim, features, q);
        }
        flow.front = front(face);
        flow.add_head(face, features, q);
        if let Some(nose) = &face.nose {
            // Of a face without eyes the nose is all that tells its age.
            let adult = if pair.is_some() { q } else { q / ADULT_WITHOUT_EYES };
            flow.add_nose(nose, pair, features.nose * adult);
            flow.add_mouth(nose, features.jaw * q, smile);
        }
        if let Some(ears) = &face.ears {
            flow.add_ears(ears, features.ear * q);
        }
        if let (Some(brows), Some(pair)) = (&face.brows, pair) {
            flow.add_brows(brows, pair, q * features.eye);
        }
        flow
    }

    /// Eyes grow outwards: the bridge keeps its width.
    fn add_eyes(
        &mut self,
        eyes: &[Eye; 2],
        face: &FaceLandmarks,
        pair: Pair,
        aim: &FaceAim,
        features: &Features,
        q: f64,
    ) {
        let (a, b, d) = (pair.half_width, pair.half_height, pair.half_distance);
        let wide = self.widening.exp();
        let most = ROOM * face.half_width * wide;
        let gap = BRIDGE * (d - a);
        let wanted = 1.0 + features.eye * ((aim.eye_size / pair.size()).clamp(1.0, MOST_GROWTH) - 1.0);
        let s = wanted.min((most - gap) / (2.0 * a)).max(1.0);
        let d2 = (d * wide).max((gap + s * a).min(most - s * a));
        let middle = 0.5 * (eyes[0].middle().x + eyes[1].middle().x);
        self.eyes = Some(std::array::from_fn(|index| {
            let eye = &eyes[index];
            let side = if index == 0 { 1.0 } else { -1.0 };
            let radius = eye.radius();
            let (is_ball, turns) =
                eye.ball.as_ref().map_or((false, false), |ball| (ball.is_ball(), ball.turns));
            let is_bare = is_ball && !turns && b > BARE * radius;
            let mut opens = (LIDS_OPEN.0 * a / b).clamp(1.0, 1.0 + LIDS_OPEN.1 * q * features.eye);
            if is_ball {
                opens = opens.min((LIDS_ON_BALL * radius / b).max(1.0));
            }
            if is_bare {
                opens = 1.0;
            }
            // A head that widens makes an ellipsoid of a ball, which takes room where it turns.
            let wider = eye.ball.as_ref().filter(|_| turns).map_or(0.0, |ball| {
                let extent = ball.high - ball.low;
                (extent.x / extent.y - 1.0).clamp(0.0, MOST_OVAL)
            });
            let depth = if turns { s } else { 1.0 + FLAT_DEPTH * (s - 1.0) };
            let opening = eye.middle();
            let from = match &eye.ball {
                Some(ball) if turns => ball.centre,
                Some(ball) => opening.with_z(ball.centre.z),
                None => opening,
            };
            let grown = s - 1.0;
            // The face curves back where the eyes go; the front of a ball that grows in depth stays where it is.
            let mut to = DVec3::new(
                middle + side * d2 + s * (from.x - opening.x),
                from.y - self.sinks,
                from.z - (d2 * d2 - d * d) / FACE_CURVE,
            );
            if turns {
                to.y += grown * (from.y - opening.y);
                to.z -= FRONT_STAYS * grown * (opening.z - from.z);
            }
            let rx = (PLATEAU_WIDE * a).max(radius.min(0.70 * d2 / s)).min(0.8 * d).min(0.78 * d2);
            let ry = (PLATEAU_HIGH * b).max(LIDS_ON_BALL * radius).min(1.25 * rx);
            // Lids that open alone make a stare: only with an iris that can fill the eye.
            let iris = eye.ball.as_ref().and_then(|ball| Some((ball, ball.iris?)));
            let b = b * opens;
            let mut more = 1.0;
            let mut iris_flow = None;
            if let Some((ball, iris)) = iris {
                if b < BARE * radius {
                    let wanted = (LIDS_FOR_IRIS.0 * a).min(LIDS_FOR_IRIS.1 * radius) / b;
                    more = wanted.clamp(1.0, 1.0 + LIDS_FOR_IRIS.2 * q * features.eye);
                }
                let half = 0.5 * (ball.high - ball.low);
                let middle = 0.5 * (ball.high + ball.low);
                let fills = IRIS_FILLS * b * more / (half.y * iris.angle.sin());
                let growth = 1.0 + q * features.eye * (fills.clamp(1.0, MOST_IRIS) - 1.0);
                // Painted irises look inwards by how far adults' do; a large one looks cross-eyed then.
                let off = side * (middle.x + half.x * iris.towards.x - opening.x);
                let turn = ((-GAZE * a - off) / half.x).clamp(-0.3, 0.3).asin();
                let yaw = side * q * features.eye * turn.clamp(0.0, MOST_YAW);
                iris_flow = Some(IrisFlow { middle, half, iris, growth, yaw });
            }
            let lids = (more > 1.0).then(|| Lids {
                middle: opening - from,
                half_width: a,
                half_height: b / opens,
                rate: more.ln(),
                radius,
            });
            EyeFlow {
                from,
                to,
                rates: DVec3::new(s.ln(), (s * opens).ln(), depth.ln()),
                ball_rates: DVec3::new(s, s, depth).map(f64::ln),
                ball_back: TURNING_ROOM * wider * s * radius,
                inner: DVec3::new(rx, ry, radius.max(PLATEAU_DEEP)),
                lids,
                iris: iris_flow,
            }
        }));
    }

    fn add_head(&mut self, face: &FaceLandmarks, features: &Features, q: f64) {
        let bell = |centre, width: f64| Bell { centre, per_width: 1.0 / width };
        self.widenings = vec![
            (q * features.cheek * 0.12, bell(0.22, 0.14)),
            (q * features.skull * cranium(face), bell(0.75, 0.22)),
            (q * features.jaw * 0.096, bell(0.0, 0.09)),
            (-q * features.jaw * 0.030, bell(0.26, 0.11)),
        ];
        self.forward = vec![
            (q * features.skull * 0.030, bell(0.66, 0.16)),
            (-q * features.jaw * 0.035, bell(0.02, 0.10)),
        ];
        let centre = DVec3::new(0.55 * face.half_width, 0.25, self.front - 0.12);
        self.apples = Some((0.022 * q * features.cheek, centre));
    }

    fn add_nose(&mut self, nose: &Nose, pair: Option<Pair>, k: f64) {
        let ye = pair.map_or(0.48, |pair| pair.height);
        let d = pair.map_or(0.15, |pair| pair.half_distance);
        let prot = nose.protrusion();
        let wide = (1.9 * nose.half_width).min(0.85 * d);
        let low = (nose.tip.y - nose.base + 0.05).max(0.085);
        let high = 0.92 * (ye - nose.tip.y).max(0.08);
        let deep = 1.5 * prot + 0.08;
        self.shrinks.push(Shrink {
            centre: DVec3::new(nose.tip.x, nose.tip.y + 0.012, nose.side_z + 0.25 * prot),
            sinks: -0.75 * self.sinks,
            per_low: DVec3::new(wide, low, deep).recip(),
            per_high: DVec3::new(wide, high, deep).recip(),
            rates: DVec3::new(less(0.26 * k), less(0.26 * k), less(0.46 * k)),
        });
        // What scaling leaves goes back as a whole: no volume is lost by that.
        let window = Shrink {
            centre: DVec3::new(nose.tip.x, nose.tip.y, nose.tip.z),
            sinks: -0.75 * self.sinks,
            per_low: DVec3::new(wide, low, 0.35).recip(),
            per_high: DVec3::new(wide, high, 0.35).recip(),
            rates: DVec3::ZERO,
        };
        self.nose_back = Some((0.16 * k * prot, window));
    }

    fn add_mouth(&mut self, nose: &Nose, k: f64, smile: f64) {
        let centre = DVec3::new(0.0, 0.55 * nose.base, self.front - 0.02);
        let half = DVec3::new(0.19, 0.095, 0.30);
        let rates = DVec3::new(less(0.36 * k), less(0.18 * k), 0.0);
        let per_half = half.recip();
        self.shrinks.push(Shrink { centre, sinks: 0.0, per_low: per_half, per_high: per_half, rates });
        if smile > 0.0 {
            let half = DVec3::new(0.34, 0.13, 0.40);
            let per_half = half.recip();
            let window =
                Shrink { centre, sinks: 0.0, per_low: per_half, per_high: per_half, rates: DVec3::ZERO };
            self.smile = Some((0.010 * smile, 0.018 * smile, window));
        }
    }

    /// Last: where the rest takes the brows' line is where they rise.
    fn add_brows(&mut self, brows: &Brows, pair: Pair, k: f64) {
        let rises = k * (brows.outer.y - brows.inner.y - LEAST_FROWN).clamp(0.0, MOST_FROWN);
        if rises == 0.0 {
            return;
        }
        let line = |inner: DVec2, outer: DVec2| {
            let slope = (outer.y - inner.y) / (outer.x - inner.x);
            (inner.y - slope * inner.x, slope)
        };
        let follower = Follower::new(self.clone());
        let after = |p: DVec2| follower.place(p.extend(self.front), 1.0).truncate();
        let lines = [line(brows.inner, brows.outer), line(after(brows.inner), after(brows.outer))];
        let d = pair.half_distance;
        let d2 = self.eyes.map_or(d, |eyes| 0.5 * (eyes[0].to.x - eyes[1].to.x));
        let lid = DVec2::new(d, pair.height + pair.half_height);
        self.brows = Some(BrowFlow { rises, lines, half_distances: [d, d2], lids: [lid.y, after(lid).y] });
    }

    fn add_ears(&mut self, ears: &Ears, k: f64) {
        // A box of a rim alone would have an edge too steep to follow.
        let half = (0.5 * (ears.high - ears.low)).max(DVec3::splat(LEAST_EAR));
        self.ears = Some(EarFlow {
            root: ears.root,
            centre: 0.5 * (ears.high + ears.low),
            half,
            sinks: -0.9 * self.sinks,
            rates: DVec3::new(less(0.45 * k), less(0.30 * k), less(0.28 * k)),
        });
    }
}

/// A ball that shows more than this part of itself has no lids.
const BARE: f64 = 0.7;
/// Lids open to this part of the opening's width, and by at most this more.
const LIDS_OPEN: (f64, f64) = (0.75, 0.2);
/// And no further than this part of the ball.
const LIDS_ON_BALL: f64 = 0.55;
/// Around a painted iris lids open to this part of the opening's width and of the ball, by at most this more.
const LIDS_FOR_IRIS: (f64, f64, f64) = (0.72, 0.62, 0.4);
/// An iris is a little higher than the opening, so that lids cut it.
const IRIS_FILLS: f64 = 1.12;
/// An iris's middle lies this part of the opening's half width inwards.
const GAZE: f64 = 0.06;
/// Eyes turn outwards by at most 8 degrees.
const MOST_YAW: f64 = 0.14;
/// Brows that rise outwards by less than this do not frown; nothing is lifted by more than the second number. Level
/// ones look worried.
const LEAST_FROWN: f64 = 0.006;
/// See [`LEAST_FROWN`].
const MOST_FROWN: f64 = 0.06;
/// Half the size of the smallest ear.
const LEAST_EAR: f64 = 0.05;
/// The part of its widening that a ball of radius 1 goes back by, so that it stays behind its lids when it turns by 20
/// degrees: its radius at 30 degrees from the front grows by sin(50)^2 - sin(30)^2 = .34 of the widening then.
const TURNING_ROOM: f64 = 0.34;
/// Balls are not taken to be wider than this, whatever was modelled of them.
const MOST_OVAL: f64 = 0.15;
/// What does not turn grows in depth by this part of what it grows across: all of it bulges like goggles.
const FLAT_DEPTH: f64 = 0.25;
/// The face curves back like a parabola of this radius.
const FACE_CURVE: f64 = 0.9;
/// The part of its growth in depth that a turning ball does behind its front.
const FRONT_STAYS: f64 = 0.85;
/// What grows with an eye: so many half openings, and at least so deep.
const PLATEAU_WIDE: f64 = 1.12;
/// See [`PLATEAU_WIDE`].
const PLATEAU_HIGH: f64 = 1.5;
/// See [`PLATEAU_WIDE`].
const PLATEAU_DEEP: f64 = 0.06;

/// How much more the upper skull widens: where it is narrower than the face, for a child's is as wide. A flat widening
/// makes a mushroom of a head whose hair is wide already.
fn cranium(face: &FaceLandmarks) -> f64 {
    ((0.95 * face.cheek_half_width / face.crown_half_width).ln() + 0.05).clamp(0.0, 0.10)
}

/// zf: the depth of the face's front.
fn front(face: &FaceLandmarks) -> f64 {
    match (&face.eyes, &face.nose) {
        (Some((_, eyes)), _) => 0.5 * (eyes[0].high.z + eyes[1].high.z),
        (None, Some(nose)) => nose.side_z,
        (None, None) => 0.0,
    }
}
