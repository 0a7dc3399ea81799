//! Legs: where they divide, and where hip, knee, ankle and toes are in them.

use super::front_view::{FrontView, SLIT};
use super::silhouette::runs_of;
use super::solid::{Lobes, Solid};
use crate::geometry::lowest;
use glam::{DVec3, IVec3};

/// Filled rows between two legs of up to this height do not end the gap between them: shoes, knees, a ribbon. Seen:
/// ±30 % changes no joint.
const BRIDGE: f64 = 0.03;
/// The gap begins below this height, or nothing tells it from other holes. Seen: ±30 % changes no joint.
const GAP_STARTS_BELOW: f64 = 0.25;
/// The gap between the legs lies within this distance of the axis. Seen: ±30 % changes no joint.
const GAP_OFF_AXIS: f64 = 0.04;
/// Where legs touch, the figure is thinner than this share of a leg. Seen: ±30 % moves joints by under 0.0005 H.
const TOUCHING_THIN: f64 = 0.6;
/// Legs that touch do so within this distance of the axis. Seen: ±30 % changes no joint.
const TOUCH_OFF_AXIS: f64 = 0.01;
/// A crotch lower or higher than this is none. Seen: at -30 %, joints lie 0.004 H further off, ten more by over 0.06 H.
const CROTCH_RANGE: (f64, f64) = (0.10, 0.62);
/// A crotch that is not seen is put at this share of the figure's height. Seen: ±30 % changes no joint.
const CROTCH_BY_RATIO: f64 = 0.47;
/// A crotch that is not seen is put at this share of the shoulders' height, where those are seen. Seen: ±30 % changes no joint.
const CROTCH_OF_SHOULDERS: f64 = 0.56;
/// A run narrower than this is a sliver, no leg. Seen: ±30 % moves joints by under 0.0005 H.
const LEAST_LEG: f64 = 0.006;
/// Inside of a skirt, a run narrower than this is no leg. Seen: ±30 % moves joints by under 0.0005 H.
const LEAST_LEG_INSIDE: f64 = 0.02;
/// Right above a hem a slice fills more than this times what it does so many slices below: above a crotch the thighs go on,
/// and grow together.
const HEM_WIDENS: f64 = 2.0;
/// See [`HEM_WIDENS`].
const HEM_ROWS: usize = 2;
/// Rays and slices that differ by less than this, in heights, see the same crotch; rays are finer.
const SAME_CROTCH: f64 = 0.012;
/// A section whose middle lies further from the leg's than this share of its radius holds something else.
const ASTRAY: f64 = 0.6;
/// Legs stand within this distance of the axis. Seen: at -30 %, joints lie 0.026 H further off, 31 more by over 0.06 H.
const LEG_REACH: f64 = 0.25;
/// The hip joint lies above the crotch by this share of the crotch's height. Seen: at +30 %, four more joints off by
/// over 0.06 H.
const HIP_OVER_CROTCH: f64 = 0.057;
/// The knee lies this share of the way from ankle to hip joint. Seen: at -30 %, joints lie 0.005 H further off, 25 more
/// by over 0.06 H; at +30 %, joints lie 0.006 H further off, 24 more by over 0.06 H.
const KNEE_SHARE: f64 = 0.515;
/// The slimmest section above the foot is looked for between these shares of the crotch's height. Seen: ±30 % moves
/// joints by under 0.0005 H.
const SLIM_RANGE: (f64, f64) = (0.08, 0.35);
/// The ankle joint lies at this share of the slimmest section's height: the section lies above the ankle bones. Seen:
/// ±30 % moves joints by under 0.0005 H.
const ANKLE_OF_SLIM: f64 = 0.62;
/// An ankle that is not seen is put at this share of the crotch's height. Seen: ±30 % moves joints by under 0.0005 H.
const ANKLE_BY_RATIO: f64 = 0.10;
/// An ankle is believed between these shares of the crotch's height. Seen: ±30 % moves joints by under 0.0005 H.
const ANKLE_RANGE: (f64, f64) = (0.06, 0.22);

/// A leg without a section stands this far from the axis, as a share of the height. Seen: ±30 % changes no joint.
const LEG_BY_RATIO: f64 = 0.06;
/// The top of the thigh lies between these shares of the crotch's height. Seen: ±30 % moves joints by under 0.0005 H.
const THIGH_RANGE: (f64, f64) = (0.90, 0.99);
/// The foot stands where its section at this height is. Seen: ±30 % moves toes by up to 0.001 H.
const SOLE_AT: f64 = 0.02;
/// The ball of the foot lies at this share of the ankle's height. Seen: ±30 % moves toes by up to 0.014 H.
const BALL_HEIGHT: f64 = 0.3;
/// The ball of the foot lies at this share of the way from the ankle to the foot's tip. Seen: ±30 % moves toes by up to 0.026 H.
const BALL_AHEAD: f64 = 0.65;
/// A foot is this much thicker than the slimmest section above it. Seen: ±30 % moves joints by under 0.0005 H.
const FOOT_WIDENS: f64 = 1.15;

/// A horizontal section of one leg.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Its height.
    pub y: f64,
    /// The middle's distance from the axis.
    pub x: f64,
    /// Half its width.
    pub half_width: f64,
    /// Depth of its front.
    pub front: f64,
    /// Depth of its back.
    pub back: f64,
}

impl Section {
    /// Half of what is between front and back.
    pub fn half_depth(&self) -> f64 {
        0.5 * (self.front - self.back)
    }

    /// Depth of its middle.
    pub fn z(&self) -> f64 {
        0.5 * (self.front + self.back)
    }
}

/// What shows between the legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LegGap {
    /// Air between the legs.
    Open,
    /// Two legs inside of something.
    Inside,
    /// Air between the legs up to the hem of something.
    Hem,
    /// Neither.
    Unseen,
}

/// Both legs.
pub struct Legs {
    /// Height of the crotch.
    pub crotch: f64,
    /// How it was found.
    pub seen: LegGap,
    /// Sections of the left and of the right leg, upwards.
    pub sections: [Vec<Section>; 2],
    /// Where rays see the legs in each row, from the lowest.
    pairs: Vec<Option<[Limb; 2]>>,
}

/// One leg's joints.
pub struct Leg {
    /// The hip joint.
    pub hip: DVec3,
    /// The knee.
    pub knee: DVec3,
    /// The ankle.
    pub ankle: DVec3,
    /// The ball of the foot.
    pub toes: DVec3,
    /// The foot's tip.
    pub tip: DVec3,
    /// True where the ankle was seen.
    pub ankle_seen: bool,
}

/// Steps from the axis between which something is leg.
type Limb = (usize, usize);

/// What horizontal slices of the solid show of the legs: two lobes with a neck between them that is air below the
/// crotch, thinner than they are where thighs touch, and as thick above.
pub struct LegLobes {
    /// The lobes of each row, from the lowest.
    rows: Vec<(f64, Option<Lobes>)>,
    /// The height at which the two become one, where they do within the range of crotches.
    pub crotch: Option<f64>,
    /// True where that is the hem of something.
    is_hem: bool,
    /// The same of two legs inside of something.
    inner_crotch: Option<f64>,
}

impl LegLobes {
    /// Slices `solid` up to the highest crotch.
    pub fn of(solid: &Solid, low: f64, top: f64) -> Self {
        let (first, last) = (solid.row(low + SOLE_AT), solid.row(CROTCH_RANGE.1.min(top)));
        let mut rows: Vec<(f64, Option<Lobes>)> = Vec::new();
        let (mut areas, mut outer) = (Vec::new(), Vec::new());
        for row in first..=last {
            let slice = solid.slice(row, LEG_REACH, 1);
            let lobes = slice.lobes();
            let y = solid.middle(IVec3::new(0, row, 0)).y;
            outer.push((y, lobes));
            let below = rows.last().and_then(|row| row.1);
            let inner = || {
                let inner = solid.slice(row, LEG_REACH, 2).lobes().filter(Lobes::are_two);
                inner.filter(|inner| below.is_none_or(|below| inner.go_on(&below)))
            };
            rows.push((y, lobes.filter(Lobes::are_two).or_else(inner).or(lobes)));
            areas.push(slice.area());
        }
        let bridge = (BRIDGE / solid.cell) as usize;
        let is_one = |&(_, lobes): &(f64, Option<Lobes>)| !lobes.is_some_and(|lobes| lobes.are_two());
        let end = |rows: &[(f64, Option<Lobes>)]| {
            rows.windows(bridge.max(1)).position(|rows| rows.iter().all(is_one))
        };
        let height = |at: usize| Some(rows[at].0 - 0.5 * solid.cell).filter(|&y| y >= CROTCH_RANGE.0);
        let area = |at: usize| areas.get(at).copied().unwrap_or(0.0);
        let at = end(&outer);
        let crotch = at.and_then(height);
        let is_hem = crotch.is_some()
            && at.is_some_and(|at| area(at + 1) > HEM_WIDENS * area(at.saturating_sub(HEM_ROWS)));
        let inner_crotch = end(&rows).and_then(height).filter(|&y| crotch.is_none_or(|crotch| y > crotch));
        Self { rows, crotch, is_hem, inner_crotch }
    }

    /// The section of one leg at a height.
    fn section(&self, left: bool, y: f64) -> Option<Section> {
        let nearest = self.rows.iter().min_by(|a, b| (a.0 - y).abs().total_cmp(&(b.0 - y).abs()))?;
        let lobe = nearest.1?.sides[usize::from(!left)];
        let (front, back) = (lobe.z + lobe.radius, lobe.z - lobe.radius);
        Some(Section { y, x: lobe.x, half_width: lobe.radius, front, back })
    }
}

/// Looks for the legs below `top`: as the lobes tell, and as rays see them higher up inside of something.
///
/// Legs go on up into clothes, and so do the shells of legs into that of a trunk: which of the two it is, shoulders tell.
pub fn find_legs(view: &FrontView, lobes: &LegLobes, top: f64) -> (Legs, Option<Legs>) {
    let mut legs = seen_legs(view, top);
    let mut inside = None;
    if let Some(crotch) = lobes.crotch
        && (legs.seen == LegGap::Unseen || lobes.is_hem || (legs.crotch - crotch).abs() > SAME_CROTCH)
    {
        let seen = if lobes.is_hem { LegGap::Hem } else { LegGap::Open };
        let told = Legs::new(view, crotch, seen, legs.pairs.clone());
        let goes_on = legs.seen == LegGap::Inside && legs.crotch > crotch + SAME_CROTCH;
        inside = if goes_on { Some(legs) } else { told.inside(view, lobes) };
        legs = told;
    } else if legs.seen == LegGap::Unseen
        && let Some(inner) = legs.inside(view, lobes)
    {
        legs = inner;
    }
    legs.heed(lobes, view.low);
    (legs, inside)
}

fn seen_legs(view: &FrontView, top: f64) -> Legs {
    let mut pairs: Vec<Option<[Limb; 2]>> = Vec::new();
    let mut crotch = None;
    let mut missed = 0;
    let mut inside_rows = 0;
    for row in view.grid.row(view.low)..=view.grid.row(CROTCH_RANGE.1.min(top)) {
        let apart = apart(view, row);
        let inner = if apart.is_none() { inside(view, row) } else { None };
        let pair = apart.or(inner).or_else(|| touching(view, row));
        pairs.push(pair);
        if pair.is_none() {
            missed += 1;
            let patience = if crotch.is_none() { GAP_STARTS_BELOW } else { BRIDGE };
            if missed as f64 > patience / view.cell() {
                break;
            }
        } else {
            missed = 0;
            crotch = Some(view.grid.y(row) + 0.5 * view.cell());
            inside_rows += usize::from(inner.is_some());
        }
    }
    let (crotch, seen) = match crotch.filter(|&y| y >= CROTCH_RANGE.0) {
        None => (CROTCH_BY_RATIO * (view.high - view.low), LegGap::Unseen),
        Some(y) if inside_rows * 5 > pairs.iter().flatten().count() => (y, LegGap::Inside),
        Some(y) => (y, LegGap::Open),
    };
    Legs::new(view, crotch, seen, pairs)
}

impl Legs {
    /// Legs up to a crotch, with sections where rays see `pairs`, and elsewhere of what stands on either side of the axis.
    fn new(view: &FrontView, crotch: f64, seen: LegGap, pairs: Vec<Option<[Limb; 2]>>) -> Self {
        let first = view.grid.row(view.low);
        let sections = [true, false].map(|left| {
            let side = usize::from(!left);
            (first..=view.grid.row(crotch))
                .filter_map(|row| {
                    let limb = pairs.get(row - first).copied().flatten().map(|pair| pair[side]);
                    let limb = limb.or_else(|| {
                        // One run on the axis: half of it is this leg.
                        let run = *view.side_runs(left, row).first()?;
                        let reach = (LEG_REACH / view.cell()) as usize;
                        (run.0 < reach).then_some((run.0, run.1.min(reach)))
                    })?;
                    section(view, left, row, limb)
                })
                .collect()
        });
        Self { crotch, seen, sections, pairs }
    }

    /// The same legs with a crotch as bodies have it, under shoulders at height `shoulder_line`.
    pub fn below_shoulders(&self, view: &FrontView, shoulder_line: f64) -> Self {
        let crotch = view.low + CROTCH_OF_SHOULDERS * (shoulder_line - view.low).max(0.0);
        if self.seen == LegGap::Hem {
            let (seen, crotch) = if crotch > self.crotch {
                (LegGap::Hem, crotch)
            } else {
                // What widens there is a jacket's or a trunk's: the legs divide no higher.
                (LegGap::Open, self.crotch)
            };
            return Self { crotch, seen, sections: self.sections.clone(), pairs: Vec::new() };
        }
        Self::new(view, crotch, LegGap::Unseen, Vec::new())
    }

    /// The same legs, inside of something; `None` where lobes do not show any.
    fn inside(&self, view: &FrontView, lobes: &LegLobes) -> Option<Self> {
        Some(Self::new(view, lobes.inner_crotch?, LegGap::Inside, self.pairs.clone()))
    }

    /// Takes the lobes' word where a section holds something beside the leg: a tail, a cape, hair.
    fn heed(&mut self, lobes: &LegLobes, low: f64) {
        let foot = low + ANKLE_RANGE.1 * (self.crotch - low);
        for (left, sections) in [true, false].into_iter().zip(&mut self.sections) {
            for section in sections {
                let Some(lobe) = lobes.section(left, section.y) else { continue };
                // A foot reaches forward from its leg, but not aside.
                let ahead = if section.y > foot { (section.z() - lobe.z()).abs() } else { 0.0 };
                let off = (section.x - lobe.x).abs().max(ahead);
                if off > ASTRAY * lobe.half_width {
                    *section = lobe;
                }
            }
        }
    }
}

/// Two legs with air between them.
fn apart(view: &FrontView, row: usize) -> Option<[Limb; 2]> {
    let reach = (LEG_REACH / view.cell()) as usize;
    let half = view.half_columns();
    // The gap's middle may lie beside the axis.
    let off = (GAP_OFF_AXIS / view.cell()) as usize;
    let runs = &view.runs[row];
    let (before, after) = runs
        .windows(2)
        .map(|pair| (pair[0], pair[1]))
        .filter(|(before, after)| {
            let middle = before.1 + after.0;
            middle.abs_diff(2 * half) <= 2 * off && before.1 + reach > half && after.0 < half + reach
        })
        .min_by_key(|(before, after)| (before.1 + after.0).abs_diff(2 * half))?;
    let (left, right) = (view.steps(true, after)?, view.steps(false, before)?);
    // A sliver is no leg.
    let least = (LEAST_LEG / view.cell()) as usize;
    if left.1 - left.0 < least || right.1 - right.0 < least {
        return None;
    }
    Some([left, right].map(|steps| (steps.0, steps.1.min(reach.max(steps.0 + 1)))))
}

/// Two legs that touch: between them, the figure is thinner than on either side.
fn touching(view: &FrontView, row: usize) -> Option<[Limb; 2]> {
    let runs = [true, false].map(|left| view.side_runs(left, row).first().copied());
    let [Some(left), Some(right)] = runs else { return None };
    let reach = (LEG_REACH / view.cell()) as usize;
    if left.0 > SLIT || right.0 > SLIT || left.1 > reach || right.1 > reach {
        return None;
    }
    let thickness = |left: bool, steps: usize| {
        view.grid.thickest(view.column(left, steps), row).map_or(0.0, |(back, front)| front - back)
    };
    let most = |left: bool, run: (usize, usize)| {
        (run.0..run.1).map(|steps| thickness(left, steps)).fold(0.0, f64::max)
    };
    let leg = most(true, left).min(most(false, right));
    let off = (TOUCH_OFF_AXIS / view.cell()) as usize;
    let least = |left: bool| (0..=off).map(|steps| thickness(left, steps)).fold(f64::INFINITY, f64::min);
    let between = least(true).min(least(false));
    (between < TOUCHING_THIN * leg).then_some([left, right].map(|run| (0, run.1.min(reach))))
}

/// Two legs inside of a skirt: on either side of the axis there are columns whose rays meet more than those between.
fn inside(view: &FrontView, row: usize) -> Option<[Limb; 2]> {
    let half = view.half_columns();
    let off = (0.5 * GAP_OFF_AXIS / view.cell()) as usize;
    let count = |column: usize| view.grid.hits(column, row).len();
    let window = half.saturating_sub(off)..(half + off).min(2 * half);
    let between = window.clone().map(count).min()?;
    if between < 2 {
        return None;
    }
    let limbs = [true, false].map(|left| {
        let steps = 0..half.min((LEG_REACH / view.cell()) as usize);
        let meet_more = steps.filter(|&steps| count(view.column(left, steps)) >= between + 2);
        runs_of(meet_more, 2).first().copied()
    });
    let [Some(left), Some(right)] = limbs else { return None };
    let least = (LEAST_LEG_INSIDE / view.cell()) as usize;
    let near = left.0.abs_diff(right.0) <= 2 * off;
    (left.0 + right.0 >= 2 && near && left.1 - left.0 >= least && right.1 - right.0 >= least)
        .then_some([left, right])
}

fn section(view: &FrontView, left: bool, row: usize, limb: Limb) -> Option<Section> {
    let (back, front) = view.grid.limb((limb.0..limb.1).map(|steps| (view.column(left, steps), row)))?;
    let (near, far) = (limb.0 as f64 * view.cell(), limb.1 as f64 * view.cell());
    Some(Section { y: view.grid.y(row), x: 0.5 * (near + far), half_width: 0.5 * (far - near), front, back })
}

/// The mean of the sections between two heights, the nearest one where there are none there.
fn mean_section(sections: &[Section], low: f64, high: f64) -> Option<Section> {
    let within: Vec<&Section> = sections.iter().filter(|s| s.y >= low && s.y <= high).collect();
    if within.is_empty() {
        let y = 0.5 * (low + high);
        return sections.iter().min_by(|a, b| (a.y - y).abs().total_cmp(&(b.y - y).abs())).copied();
    }
    let mean = |value: fn(&Section) -> f64| {
        within.iter().map(|section| value(section)).sum::<f64>() / within.len() as f64
    };
    Some(Section {
        y: mean(|s| s.y),
        x: mean(|s| s.x),
        half_width: mean(|s| s.half_width),
        front: mean(|s| s.front),
        back: mean(|s| s.back),
    })
}

/// One leg's joints; what is `given` of hip joint, knee and ankle stays.
pub fn leg(view: &FrontView, legs: &Legs, left: bool, given: [Option<DVec3>; 3]) -> Leg {
    let [given_hip, given_knee, given_ankle] = given;
    let sections = &legs.sections[usize::from(!left)];
    let length = (legs.crotch - view.low).max(1e-3);
    let at = |share: f64| view.low + share * length;
    // Where there are no sections a leg stands as bodies have it.
    let between = |low: f64, high: f64| {
        let x = LEG_BY_RATIO * (view.high - view.low);
        let none = Section { y: 0.5 * (low + high), x, half_width: 0.5 * x, front: 0.0, back: 0.0 };
        mean_section(sections, low, high).unwrap_or(none)
    };
    let height_of = |y: f64| between(y, y);
    let (ankle_y, slim, ankle_seen) = ankle_height(sections, view.low, length);
    // Feet reach forward from the shin, but not aside: a leg that leans has its ankle aside of what is above it.
    let (x, z) = (height_of(ankle_y).x, height_of(slim).z());
    let ankle = given_ankle.unwrap_or_else(|| view.point(left, x, ankle_y, z));
    let hip = given_hip.unwrap_or_else(|| {
        let y = legs.crotch + HIP_OVER_CROTCH * length;
        let top = between(at(THIGH_RANGE.0), at(THIGH_RANGE.1));
        view.point(left, top.x, y, top.z())
    });
    let knee = given_knee.unwrap_or_else(|| {
        let y = ankle.y + KNEE_SHARE * (hip.y - ankle.y);
        let section = height_of(y);
        view.point(left, section.x, y, section.z())
    });
    let foot = sections.iter().filter(|s| s.y < at(ANKLE_RANGE.1));
    let front = foot.map(|s| s.front).fold(ankle.z, f64::max);
    let low = height_of(view.low + SOLE_AT);
    let side = |p: DVec3| (p.x - view.axis).abs();
    let toe_y = view.low + BALL_HEIGHT * (ankle.y - view.low);
    let toe_z = ankle.z + BALL_AHEAD * (front - ankle.z);
    let toe_x = 0.5 * (side(ankle) + low.x);
    let [toes, tip] = [toe_z, front].map(|z| view.point(left, toe_x, toe_y, z));
    Leg { hip, knee, ankle, toes, tip, ankle_seen }
}

/// The ankle's height, that of the slimmest section above it, and whether the ankle was seen.
fn ankle_height(sections: &[Section], low: f64, length: f64) -> (f64, f64, bool) {
    let girth = |s: &Section| s.half_width + s.half_depth();
    let by_ratio = low + ANKLE_BY_RATIO * length;
    let believed = |y: f64| y.clamp(low + ANKLE_RANGE.0 * length, low + ANKLE_RANGE.1 * length);
    let calf: Vec<(f64, f64)> = sections
        .iter()
        .filter(|s| s.y >= low + SLIM_RANGE.0 * length && s.y <= low + SLIM_RANGE.1 * length)
        .map(|s| (s.y, girth(s)))
        .collect();
    if let Some(slim) = lowest(&calf) {
        let least = calf.iter().map(|&(_, girth)| girth).fold(f64::INFINITY, f64::min);
        let below = sections.iter().filter(|s| s.y < slim).map(girth).fold(0.0, f64::max);
        if below > FOOT_WIDENS * least {
            // Two witnesses: the slim place over the ankle bones, and how bodies are made.
            let y = 0.5 * (low + ANKLE_OF_SLIM * (slim - low) + by_ratio);
            return (believed(y), slim, true);
        }
    }
    (by_ratio, low + SLIM_RANGE.1 * length, false)
}
