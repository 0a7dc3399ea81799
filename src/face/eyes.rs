//! Where the eyes are: by the host, by pieces of the mesh, by what blinks, by joints, by mirrored pieces; else nowhere.
//!
//! Dents in the depth map were tried and dropped: they took a brow and an egg-shaped head for eyes on two of three
//! heads, and a wrong eye bends the face where it should not.

use super::head::{Head, quantile_box};
use super::iris::{Iris, iris};
use super::islands::{Piece, is_ball, pieces};
use glam::{DVec2, DVec3};

/// How the eyes were found, surest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EyeSource {
    /// The host said where they are.
    Hints,
    /// Meshes that are eyes, or vertices that eye joints move.
    Pieces,
    /// What a blink moves.
    Blink,
    /// The eye joints alone.
    Joints,
    /// Two mirrored pieces of the head, loose or sewn to the skin.
    Twins,
}

impl EyeSource {
    /// The name in a report, and how sure that is, 0 to 1.
    pub fn name_and_confidence(self) -> (&'static str, f64) {
        match self {
            EyeSource::Hints => ("hints", 1.0),
            EyeSource::Pieces => ("pieces", 0.95),
            EyeSource::Blink => ("blink", 0.9),
            EyeSource::Twins => ("twins", 0.7),
            EyeSource::Joints => ("joints", 0.6),
        }
    }
}

/// A piece of a mesh that is an eye: a ball, or a disc that stands for one.
#[derive(Clone, Debug, PartialEq)]
pub struct Eyeball {
    /// The box around it.
    pub low: DVec3,
    /// See `low`.
    pub high: DVec3,
    /// What it turns about: the eye's joint where that lies in it, else its middle.
    pub centre: DVec3,
    /// True where an eye joint moves it.
    pub turns: bool,
    /// Its vertices, in the figure's numbers.
    pub vertices: Vec<u32>,
    /// Its painted iris, where one is seen.
    pub iris: Option<Iris>,
}

impl Eyeball {
    /// R: half the larger of its width and height.
    pub fn radius(&self) -> f64 {
        0.5 * (self.high - self.low).truncate().max_element()
    }

    /// True for a ball, false for a disc.
    pub fn is_ball(&self) -> bool {
        let extent = self.high - self.low;
        extent.z > 0.5 * extent.x
    }
}

/// One eye.
#[derive(Clone, Debug, PartialEq)]
pub struct Eye {
    /// The opening between the lids, seen from the front: its lower end towards -x, at the depth of its foremost point.
    pub low: DVec3,
    /// Its upper end towards +x, at the same depth.
    pub high: DVec3,
    /// What is seen in it, where that is a piece of its own.
    pub ball: Option<Eyeball>,
}

impl Eye {
    /// The opening's middle.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// a: half the opening's width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high.x - self.low.x)
    }

    /// b: half its height.
    pub fn half_height(&self) -> f64 {
        0.5 * (self.high.y - self.low.y)
    }

    /// R of the ball; the larger half extent of the opening where there is none.
    pub fn radius(&self) -> f64 {
        let opening = self.half_width().max(self.half_height());
        self.ball.as_ref().map_or(opening, Eyeball::radius)
    }
}

/// Left and right eye.
pub type Eyes = [Eye; 2];

/// What both eyes have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// ye: the mean height of their openings.
    pub height: f64,
    /// d: half the distance of the openings' middles.
    pub half_distance: f64,
    /// a: half an opening's width.
    pub half_width: f64,
    /// b: half its height.
    pub half_height: f64,
}

impl Pair {
    /// The means of left and right.
    pub fn of(eyes: &Eyes) -> Self {
        let [left, right] = eyes.each_ref().map(Eye::middle);
        let mean = |of: fn(&Eye) -> f64| 0.5 * (of(&eyes[0]) + of(&eyes[1]));
        Self {
            height: 0.5 * (left.y + right.y),
            half_distance: 0.5 * (left.x - right.x),
            half_width: mean(Eye::half_width),
            half_height: mean(Eye::half_height),
        }
    }

    /// e: how large an eye is.
    pub fn size(&self) -> f64 {
        (self.half_width * self.half_height).sqrt()
    }
}

/// A source, and how it finds both eyes.
type Source = (EyeSource, fn(&Head) -> Option<Eyes>);

/// The first source that gives both eyes, with the irises painted on them.
pub fn eyes(head: &Head) -> Option<(EyeSource, Eyes)> {
    let sources: [Source; 5] = [
        (EyeSource::Hints, by_hints),
        (EyeSource::Pieces, by_pieces_and_blink),
        (EyeSource::Blink, by_blink),
        (EyeSource::Joints, by_joints),
        (EyeSource::Twins, by_mirrored),
    ];
    let (source, mut eyes) = sources.into_iter().find_map(|(source, by)| Some((source, by(head)?)))?;
    for ball in eyes.iter_mut().filter_map(|eye| eye.ball.as_mut()) {
        ball.iris = iris(head, &ball.vertices, (ball.low, ball.high));
    }
    Some((source, eyes))
}

/// How far from the middle an eye's may be, in head lengths.
const ASIDE: std::ops::Range<f64> = 0.03..0.42;
/// Widths of an eye's piece, in head lengths.
const PIECE_WIDTH: std::ops::Range<f64> = 0.02..0.42;
/// What is flatter than this part of its width is a brow or a lash.
const PIECE_FLATTEST: f64 = 0.33;
/// Squares of a look at an opening, in head lengths: with the front view's own, b is a row off.
const FINE: f64 = 0.002;
/// The share of an opening at each end that is left out, against single squares.
const OPENING_ENDS: f64 = 0.002;
/// A joint further from a ball's middle than this part of its radius is not what it turns about.
const JOINT_IN_BALL: f64 = 0.6;

/// Meshes that are eyes, or what eye joints move.
fn by_pieces(head: &Head) -> Option<Eyes> {
    let triangles = head.eyes();
    let [left, right] = [0, 1].map(|side| {
        let pieces = pieces(head, &triangles, if side == 0 { 1.0 } else { -1.0 }, false);
        let fits = |piece: &&Piece| {
            let (extent, aside) = (piece.extent(), piece.middle().x.abs());
            let is_flat = extent.y < PIECE_FLATTEST * extent.x;
            ASIDE.contains(&aside) && PIECE_WIDTH.contains(&extent.x) && !is_flat
        };
        let area = |piece: &Piece| piece.extent().x * piece.extent().y;
        let largest = pieces.iter().filter(fits).max_by(|a, b| area(a).total_cmp(&area(b)))?;
        // Iris and pupil may be pieces of their own.
        let slack = 0.1 * largest.extent();
        let (low, high) = (largest.low - slack, largest.high + slack);
        let inside = |piece: &&Piece| piece.low.cmpge(low).all() && piece.high.cmple(high).all();
        let parts = pieces.iter().filter(inside);
        let whole = Piece::new(head, parts.flat_map(|piece| &piece.triangles).copied().collect());
        let mut eye = eye(head, &whole)?;
        let moved = whole.vertices.iter().filter(|&&vertex| head.parts.turns[vertex as usize]).count();
        if let Some(ball) = &mut eye.ball {
            let reach = JOINT_IN_BALL * ball.radius();
            let joint = head.eye_joint(side).filter(|joint| joint.distance(whole.middle()) < reach);
            ball.turns = 2 * moved > whole.vertices.len();
            ball.centre = joint.unwrap_or(ball.centre);
        }
        Some(eye)
    });
    Some([left?, right?]).filter(are_plausible)
}

/// The same, open as far as a blink closes them.
fn by_pieces_and_blink(head: &Head) -> Option<Eyes> {
    let mut eyes = by_pieces(head)?;
    for (eye, blink) in eyes.iter_mut().zip(by_blink(head).iter().flatten()) {
        let more = (blink.half_height() - eye.half_height()).max(0.0);
        eye.low.y -= more;
        eye.high.y += more;
    }
    Some(eyes)
}

/// The eye that a piece is: its opening is where the front shows it.
fn eye(head: &Head, piece: &Piece) -> Option<Eye> {
    let (low, high) = opening(head, piece)?;
    let ball = Eyeball {
        low: piece.low,
        high: piece.high,
        centre: piece.middle(),
        turns: false,
        vertices: piece.vertices.clone(),
        iris: None,
    };
    Some(Eye { low: low.extend(piece.high.z), high: high.extend(piece.high.z), ball: Some(ball) })
}

/// Where the front shows a piece.
fn opening(head: &Head, piece: &Piece) -> Option<(DVec2, DVec2)> {
    let margin = DVec2::splat(FINE);
    let mut own = piece.triangles.clone();
    own.sort_unstable();
    let view = head.front_view(piece.low.truncate() - margin, piece.high.truncate() + margin, FINE);
    let is_own = |&(column, row): &(usize, usize)| {
        let triangle = view.triangle(column, row);
        triangle.is_some_and(|triangle| own.binary_search(&head.bare[triangle]).is_ok())
    };
    let seen: Vec<DVec2> =
        view.squares().filter(is_own).map(|(column, row)| view.middle(column, row)).collect();
    quantile_box(&seen, OPENING_ENDS)
}

/// True for the name of a morph target that closes an eye.
pub fn closes_an_eye(name: &str) -> bool {
    let name = name.to_lowercase();
    let any = |words: &[&str]| words.iter().any(|word| name.contains(word));
    // The last ones are Japanese: blink, wink, eyes closed.
    let closes = any(&[
        "blink",
        "wink",
        "eyeclose",
        "eye_close",
        "eyesclose",
        "eyes_close",
        "eye close",
        "まばたき",
        "瞬き",
        "ウィンク",
        "ウインク",
        "目閉じ",
    ]);
    closes && !any(&["smile", "squint", "happy", "joy"])
}

/// A blink moves what moves by more than this part of its greatest travel.
const BLINK_LEAST: f64 = 0.3;
/// The share of a blink's vertices at each end that is left out.
const BLINK_ENDS: f64 = 0.03;

/// What blinks move: their lids' vertices lie around the opening, and travel through it.
fn by_blink(head: &Head) -> Option<Eyes> {
    let parts = &head.parts;
    let mut travel = vec![0.0f64; head.points.len()];
    for (mesh, start) in parts.character.meshes.iter().zip(parts.mesh_starts) {
        for target in mesh.morph_targets.iter().filter(|target| closes_an_eye(&target.name)) {
            for (vertex, delta) in target.positions.iter().enumerate() {
                let moved = &mut travel[start + vertex];
                *moved = moved.max(f64::from(delta.length()) / head.frame.length);
            }
        }
    }
    let [left, right] = [1.0, -1.0].map(|side| {
        let of_side: Vec<usize> = (0..travel.len())
            .filter(|&vertex| travel[vertex] > 0.0 && side * head.points[vertex].x > 0.0)
            .filter(|&vertex| parts.of_head[vertex])
            .collect();
        let most = of_side.iter().map(|&vertex| travel[vertex]).fold(0.0, f64::max);
        let lids: Vec<DVec3> = of_side
            .iter()
            .filter(|&&vertex| travel[vertex] > BLINK_LEAST * most)
            .map(|&vertex| head.points[vertex])
            .collect();
        let places: Vec<DVec2> = lids.iter().map(|p| p.truncate()).collect();
        let (low, high) = quantile_box(&places, BLINK_ENDS)?;
        let middle = 0.5 * (low.y + high.y);
        let front = lids.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
        let at = |x: f64, up: f64| DVec3::new(x, middle + up, front);
        Some(Eye { low: at(low.x, -0.5 * most), high: at(high.x, 0.5 * most), ball: None })
    });
    Some([left?, right?]).filter(are_plausible)
}

/// Half width and height of an opening that only a joint tells of, in half distances of the eyes: an adult's.
const OPENING_BY_JOINT: [f64; 2] = [0.45, 0.25];

/// The eye joints; the skin before them is the opening's depth.
fn by_joints(head: &Head) -> Option<Eyes> {
    let joints = [head.eye_joint(0)?, head.eye_joint(1)?];
    let d = 0.5 * (joints[0].x - joints[1].x);
    let half = d * DVec2::from_array(OPENING_BY_JOINT);
    let [left, right] = joints.map(|joint| painted(head, joint.truncate(), half));
    Some([left?, right?]).filter(are_plausible)
}

/// An eye that is no piece of its own: an opening in the skin.
fn painted(head: &Head, middle: DVec2, half: DVec2) -> Option<Eye> {
    let front = head.front.depth_at(middle)?;
    Some(Eye { low: (middle - half).extend(front), high: (middle + half).extend(front), ball: None })
}

/// Half width and height of an opening of which only the middle is said, in half distances of the eyes: the mean of eight
/// adult heads.
const OPENING_BY_HINT: [f64; 2] = [0.32, 0.18];
/// A piece whose opening's middle is within this part of the eyes' half distance from where the host says an eye is, is
/// that eye.
const NEAR_HINT: f64 = 0.5;

/// What the host says: pieces where it says that eyes are, else openings in the skin. Of one eye the other is its mirror
/// image.
fn by_hints(head: &Head) -> Option<Eyes> {
    let mut hints: Vec<(DVec2, DVec2)> = head
        .parts
        .eye_hints
        .iter()
        .map(|&(p, half)| (head.frame.to_unit(p).truncate(), half / head.frame.length))
        .collect();
    if let &[(middle, half)] = &*hints {
        hints.push((middle * DVec2::new(-1.0, 1.0), half));
    }
    hints.sort_by(|a, b| b.0.x.total_cmp(&a.0.x));
    let &[left, right] = &*hints else { return None };
    let d = 0.5 * (left.0.x - right.0.x);
    let pieces = by_pieces(head);
    let eye = |index: usize, (middle, half): (DVec2, DVec2)| {
        let piece = pieces.as_ref().map(|eyes| &eyes[index]);
        let mut eye = match piece.filter(|eye| eye.middle().truncate().distance(middle) < NEAR_HINT * d) {
            Some(piece) => piece.clone(),
            None => painted(head, middle, d * DVec2::from_array(OPENING_BY_HINT))?,
        };
        for (axis, half) in half.to_array().into_iter().enumerate().filter(|&(_, half)| half > 0.0) {
            eye.low[axis] = middle[axis] - half;
            eye.high[axis] = middle[axis] + half;
        }
        Some(eye)
    };
    Some([eye(0, left)?, eye(1, right)?]).filter(are_plausible)
}

/// Mirrored pieces are alike to this, in head lengths.
const MIRRORED: f64 = 0.03;
/// Their widths; how flat and how high they may be; how far aside and how high up eyes are; in head lengths. Painted eyes
/// of figurines are dots or stand upright; brows, moustaches and tusks lie.
const TWIN_WIDTH: std::ops::Range<f64> = 0.03..0.3;
/// See [`TWIN_WIDTH`].
const TWIN_FLATTEST: f64 = 0.8;
/// See [`TWIN_WIDTH`].
const TWIN_MOST: f64 = 0.4;
/// See [`TWIN_WIDTH`].
const TWIN_ASIDE: std::ops::Range<f64> = 0.07..0.36;
/// See [`TWIN_WIDTH`].
const TWIN_HEIGHT: std::ops::Range<f64> = 0.2..0.62;
/// Of a mirrored piece's box at least this share is seen from the front.
const TWIN_SEEN: f64 = 0.5;

/// Two eyes stand side by side in the middle third of a head: what does not is no pair of eyes.
fn are_plausible(eyes: &Eyes) -> bool {
    let [left, right] = eyes.each_ref().map(Eye::middle);
    let d = 0.5 * (left.x - right.x);
    TWIN_ASIDE.contains(&d)
        && TWIN_HEIGHT.contains(&(0.5 * (left.y + right.y)))
        && (left.y - right.y).abs() < 0.5 * d
        && (left.x + right.x).abs() < d
        && eyes.iter().all(|eye| eye.half_width() < d && eye.half_width() > 0.0 && eye.half_height() > 0.0)
}

/// The largest two small pieces without names that mirror each other, as figurines' painted-black eyes are; else two balls
/// whose rims are sewn to the skin.
fn by_mirrored(head: &Head) -> Option<Eyes> {
    let fits = |piece: &Piece| {
        let (extent, middle) = (piece.extent(), piece.middle());
        TWIN_WIDTH.contains(&extent.x)
            && (TWIN_FLATTEST * extent.x..TWIN_MOST).contains(&extent.y)
            && TWIN_ASIDE.contains(&middle.x.abs())
            && TWIN_HEIGHT.contains(&middle.y)
    };
    let seen = |eye: &Eye, piece: &Piece| {
        let extent = piece.extent();
        4.0 * eye.half_width() * eye.half_height() > TWIN_SEEN * extent.x * extent.y
    };
    [false, true].into_iter().find_map(|sewn| {
        let [left, right] = [1.0, -1.0].map(|side| {
            let mut pieces = pieces(head, &head.bare, side, sewn);
            pieces.retain(|piece| fits(piece) && (!sewn || is_ball(head, piece)));
            pieces
        });
        let twins = left.iter().flat_map(|left| right.iter().map(move |right| [left, right]));
        let eyes = twins.filter_map(|[left, right]| {
            let off = left.middle() - right.middle() * DVec3::new(-1.0, 1.0, 1.0);
            let grown = left.extent() - right.extent();
            if off.length() > MIRRORED || grown.abs().max_element() > MIRRORED {
                return None;
            }
            let eye = |piece| eye(head, piece).filter(|eye| seen(eye, piece));
            Some([eye(left)?, eye(right)?]).filter(are_plausible)
        });
        let area = |[left, _]: &Eyes| left.half_width() * left.half_height();
        eyes.reduce(|best, next| if area(&next) > area(&best) { next } else { best })
    })
}
