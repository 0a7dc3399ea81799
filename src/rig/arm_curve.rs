//! The middles of an arm's sections, and the joints that they show.

use crate::geometry::{foot, lowest, median};
use glam::{DVec2, DVec3};
use std::iter::Sum;
use std::ops::Div;
use std::rc::Rc;

/// The wrist is looked for between these shares of the way from shoulder to tip. Seen: at -30 %, joints lie 0.001 H
/// further off, three more by over 0.06 H, 70 more good joints doubted; at +30 %, joints lie 0.0007 H further off, 74
/// more good joints doubted.
const WRIST_RANGE: (f64, f64) = (0.55, 0.88);
/// One further than this from where wrists are is in doubt.
const WRIST_USUAL: f64 = 0.13;
/// The wrist where none is seen. Seen: at -30 %, four more good joints doubted; at +30 %, joints lie 0.0006 H further
/// off, four more by over 0.06 H.
const WRIST_BY_RATIO: f64 = 0.74;
/// That far from there, as a share of the same, a section counts as wider than it is by the second share: what is slim by
/// chance lies anywhere.
const WRIST_PRIOR: (f64, f64) = (0.15, 0.3);
/// The elbow lies at this share of the way from shoulder to wrist. Seen: at -30 %, joints lie 0.002 H further off, five
/// fewer by over 0.06 H; at +30 %, joints lie 0.003 H further off, seven more by over 0.06 H.
const ELBOW_SHARE: f64 = 0.53;
/// The elbow of an arm that is bent by more than this share of its length lies where the bend is. Seen: ±30 % moves
/// joints by under 0.0005 H.
const BENT: f64 = 0.05;
/// The sections of the radius near the shoulder: from one in so many to one in so many. Seen: ±30 % moves joints by
/// under 0.0005 H.
const RADIUS_RANGE: (usize, usize) = (10, 3);
/// The sections of the arm's upper piece, likewise. Seen: at -30 %, three fewer joints off by over 0.06 H.
const UPPER_RANGE: (usize, usize) = (20, 4);
/// A wrist is slimmer than the hand by this factor. Seen: at -30 %, three fewer good joints doubted; at +30 %, twelve
/// more good joints doubted.
const HAND_WIDENS: f64 = 1.12;
/// Of places that are about as slim, which differ by less than the hand does, the last one is where the hand begins, if what
/// is slim before it is so by chance: the wrist lies this share of the way to it.
const TO_HAND: f64 = 0.5;
/// A bend is looked for between these shares of the way from shoulder to wrist: elbows are at .56 of it (Winter: .186 of
/// .332 H), of stylised figures and babies from .4 on. Seen: from .34 on, the elbows of two babies are off by 0.028 H more.
const BEND_RANGE: (f64, f64) = (0.3, 0.72);
/// It lies further beside the line than both ends of that range by this factor: the bend of an arm whose elbow is at .4 is
/// 1.3 times as far off as what is at .3 of the way, while the line from a shoulder that is a little off passes by all of
/// the arm.
const BEND_STANDS_OUT: f64 = 1.1;
/// A joint further than this from a curve, in heights, is another arm's, or lies in the air.
const PASSES_BY: f64 = 0.08;

/// One arm.
#[derive(Clone, Debug)]
pub struct Arm {
    /// The shoulder joint.
    pub shoulder: DVec3,
    /// The elbow.
    pub elbow: DVec3,
    /// The wrist.
    pub wrist: DVec3,
    /// The end of the hand.
    pub tip: DVec3,
    /// The armpit: where the arm's lower side meets the trunk.
    pub pit: DVec2,
    /// The arm's radius near the shoulder.
    pub radius: f64,
    /// True where a wrist was seen, about where wrists are.
    pub wrist_seen: bool,
    /// The sections that it was read from.
    pub curve: Rc<ArmCurve>,
}

impl Arm {
    /// The same arm with another shoulder joint, and the others as they show from there.
    pub fn with_shoulder(&self, shoulder: DVec3) -> Self {
        let outwards = (self.elbow - shoulder).normalize_or_zero();
        self.curve.joints(shoulder, outwards, self.pit)
    }

    /// The same arm from another shoulder joint to the same wrist.
    pub fn from_shoulder(&self, shoulder: DVec3) -> Self {
        let begins = self.curve.before(shoulder, (self.wrist - shoulder).normalize_or_zero());
        let wrist_arc = self.curve.nearest(self.wrist).0;
        let elbow = self.curve.elbow(shoulder, begins, self.wrist, wrist_arc);
        Self { shoulder, elbow, ..self.clone() }
    }

    /// The same arm with some of its joints given, and the elbow between them where it is not. As it is where its
    /// curve passes by any of them.
    pub fn with_given(mut self, [shoulder, elbow, wrist]: [Option<DVec3>; 3]) -> Self {
        let given = || [shoulder, elbow, wrist].into_iter().flatten();
        if given().count() == 0 || given().any(|p| self.curve.nearest(p).1 > PASSES_BY) {
            return self;
        }
        self.shoulder = shoulder.unwrap_or(self.shoulder);
        if let Some(wrist) = wrist {
            self.tip += wrist - self.wrist;
            (self.wrist, self.wrist_seen) = (wrist, true);
        }
        let begins = self.curve.before(self.shoulder, (self.elbow - self.shoulder).normalize_or_zero());
        let wrist_arc = self.curve.nearest(self.wrist).0;
        self.elbow = elbow.unwrap_or_else(|| {
            // Half of the way along, the arm lies half as far beside its curve as its wrist does.
            let beside = self.wrist - self.curve.at(wrist_arc);
            let found = self.curve.elbow(self.shoulder, begins, self.wrist - beside, wrist_arc);
            found + self.elbow_share() * beside
        });
        self
    }

    /// How far down the way from shoulder to wrist the elbow is.
    pub fn elbow_share(&self) -> f64 {
        let upper = self.shoulder.distance(self.elbow);
        upper / (upper + self.elbow.distance(self.wrist)).max(1e-9)
    }
}

/// The middles of an arm's sections: arms may bend towards the front.
#[derive(Debug)]
pub struct ArmCurve {
    /// Smoothed middles.
    middles: Vec<DVec3>,
    /// How thick each section is one way and the other way together: about twice its diameter.
    girths: Vec<f64>,
    /// How far along the curve each of them is.
    arc: Vec<f64>,
}

impl ArmCurve {
    /// `sections`: middles and girths of at least two, from the shoulder to the tip; each middle becomes a mean over
    /// `smoothed` ones to either side.
    pub fn new(sections: impl Iterator<Item = (DVec3, f64)>, smoothed: usize) -> Rc<Self> {
        let (middles, girths): (Vec<DVec3>, Vec<f64>) = sections.unzip();
        let middles = means_around(&middles, smoothed);
        let mut arc = vec![0.0];
        for pair in middles.windows(2) {
            arc.push(arc[arc.len() - 1] + pair[0].distance(pair[1]));
        }
        Rc::new(Self { middles, girths, arc })
    }

    fn len(&self) -> usize {
        self.middles.len()
    }

    /// The point `wanted` along the curve.
    fn at(&self, wanted: f64) -> DVec3 {
        let Self { middles, arc, .. } = self;
        if wanted <= 0.0 {
            // Inside of the pit the arm goes on as it begins.
            return middles[0] + (middles[0] - self.upper()).normalize_or_zero() * -wanted;
        }
        let index = arc.partition_point(|&a| a < wanted).clamp(1, arc.len() - 1);
        let share = (wanted - arc[index - 1]) / (arc[index] - arc[index - 1]).max(1e-12);
        middles[index - 1].lerp(middles[index], share.clamp(0.0, 1.0))
    }

    /// The arm's radius near the shoulder.
    pub fn radius(&self) -> f64 {
        let near = self.len() / RADIUS_RANGE.0..self.len() / RADIUS_RANGE.1;
        0.25 * median(&mut self.girths[near].to_vec())
    }

    /// The middle of its upper piece, whose line leads over the armpit.
    pub fn upper(&self) -> DVec3 {
        let upper = &self.middles[self.len() / UPPER_RANGE.0..(self.len() / UPPER_RANGE.1).max(1)];
        upper.iter().sum::<DVec3>() / upper.len().max(1) as f64
    }

    /// The point at a share of its length.
    pub fn at_share(&self, share: f64) -> DVec3 {
        self.at(share * self.whole())
    }

    /// How long it is.
    fn whole(&self) -> f64 {
        self.arc[self.len() - 1]
    }

    /// How far along the curve a `shoulder` is from which the arm begins along `outwards`.
    fn before(&self, shoulder: DVec3, outwards: DVec3) -> f64 {
        let begin = self.middles[0];
        -begin.distance(shoulder) * (shoulder - begin).dot(-outwards).signum()
    }

    /// How far along the curve its nearest point to `p` is, and how far that is from it.
    pub fn nearest(&self, p: DVec3) -> (f64, f64) {
        let feet = self.middles.windows(2).zip(self.arc.windows(2)).map(|(middles, arc)| {
            let (at, share) = foot(p, middles[0], middles[1]);
            (arc[0] + share * (arc[1] - arc[0]), at.distance(p))
        });
        feet.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, f64::INFINITY))
    }

    /// Means of girths over neighbours, each with its share of the way to the tip from where the arm `begins`.
    fn girths(&self, begins: f64) -> Vec<(f64, f64)> {
        let whole = (self.whole() - begins).max(1e-9);
        let shares = self.arc.iter().map(|arc| (arc - begins) / whole);
        shares.zip(means_around(&self.girths, 1)).collect()
    }

    /// Where an arm whose shoulder and wrist are that far along bends: the middle that is furthest from the line between
    /// these, of those about where elbows are. `None` of a straight arm, and where the first or the last of them is about
    /// as far: an arm bends at its elbow.
    fn bend(&self, shoulder: DVec3, begins: f64, wrist: DVec3, wrist_arc: f64) -> Option<DVec3> {
        let near_elbow = |&index: &usize| {
            let share = (self.arc[index] - begins) / (wrist_arc - begins);
            (BEND_RANGE.0..=BEND_RANGE.1).contains(&share)
        };
        let line = wrist - shoulder;
        let off = |index: usize| (self.middles[index] - shoulder).reject_from(line).length();
        let range: Vec<(usize, f64)> =
            (0..self.len()).filter(near_elbow).map(|index| (index, off(index))).collect();
        let ends = range.first()?.1.max(range.last()?.1);
        let &(index, most) = range.iter().rev().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let bends = most > BEND_STANDS_OUT * ends && line.length() > 0.0 && most > BENT * line.length();
        bends.then(|| self.middles[index])
    }

    /// The elbow of an arm whose shoulder and wrist are that far along.
    fn elbow(&self, shoulder: DVec3, begins: f64, wrist: DVec3, wrist_arc: f64) -> DVec3 {
        self.bend(shoulder, begins, wrist, wrist_arc)
            .unwrap_or_else(|| self.at(begins + ELBOW_SHARE * (wrist_arc - begins)))
    }

    /// The joints beyond a `shoulder`, of an arm that begins along `outwards`.
    pub fn joints(self: &Rc<Self>, shoulder: DVec3, outwards: DVec3, pit: DVec2) -> Arm {
        let begins = self.before(shoulder, outwards);
        let seen = slimmest(&self.girths(begins));
        let wrist_arc = begins + seen.unwrap_or(WRIST_BY_RATIO) * (self.whole() - begins);
        let wrist = self.at(wrist_arc);
        let elbow = self.elbow(shoulder, begins, wrist, wrist_arc);
        let (tip, radius) = (self.middles[self.len() - 1], self.radius());
        let wrist_seen = seen.is_some_and(|share| (share - WRIST_BY_RATIO).abs() <= WRIST_USUAL);
        let curve = Rc::clone(self);
        Arm { shoulder, elbow, wrist, tip, pit, radius, wrist_seen, curve }
    }
}

/// Means of values, each over itself and so many neighbours to either side.
fn means_around<T: Copy + Sum + Div<f64, Output = T>>(values: &[T], reach: usize) -> Vec<T> {
    let mean = |index: usize| {
        let near = &values[index.saturating_sub(reach)..(index + reach + 1).min(values.len())];
        near.iter().copied().sum::<T>() / near.len() as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Where the wrist shows: the slimmest of some girths before the hand, each with its share of the way from shoulder to
/// tip. `None` where none is slimmer than what is beyond it.
fn slimmest(girths: &[(f64, f64)]) -> Option<f64> {
    let in_range = |&&(share, _): &&(f64, f64)| (WRIST_RANGE.0..=WRIST_RANGE.1).contains(&share);
    let usual = |share: f64| 1.0 + WRIST_PRIOR.1 * ((share - WRIST_BY_RATIO) / WRIST_PRIOR.0).powi(2);
    let weighed: Vec<(f64, f64)> =
        girths.iter().filter(in_range).map(|&(share, girth)| (share, girth * usual(share))).collect();
    let at = lowest(&weighed)?;
    let slim = girths.partition_point(|&(share, _)| share < at).min(girths.len() - 1);
    let is_slim = girths[slim..].iter().any(|&(_, girth)| girth > HAND_WIDENS * girths[slim].1);
    is_slim.then(|| {
        let least = weighed.iter().map(|&(_, girth)| girth).fold(f64::INFINITY, f64::min);
        let as_slim = weighed.iter().rev().find(|&&(_, girth)| girth <= HAND_WIDENS * least);
        at + TO_HAND * as_slim.map_or(0.0, |&(share, _)| (share - at).max(0.0))
    })
}
