//! The face step as a stage of the deformation: where the stages before put a point, to where a younger face has it.

use super::FaceShape;
use super::head::HeadFrame;
use super::kernel::{Follower, STEPS, along, pieces};
use super::rows::Rows;
use crate::geometry::cells::CellMap;
use crate::geometry::{Mapped, Moved};
use crate::parallel;
use glam::{DMat3, DVec3, Vec3};

/// The head's first row, Eqs. 12 and 13.
impl FaceShape {
    /// Where a point goes that is at `to` already and takes `share` of the map; what keeps its shape goes as its `middle`.
    pub fn apply<M: Moved>(&self, to: M, share: f64, middle: Option<DVec3>) -> M {
        let from = middle.unwrap_or(to.position());
        if share <= 0.0 {
            return to;
        }
        let face: M = self.map(from);
        M::of(to.position() + share * (face.position() - from), || {
            let bent = (face.jacobian() - DMat3::IDENTITY) * share * to.jacobian();
            if middle.is_none() { to.jacobian() + bent } else { to.jacobian() }
        })
    }
}

/// How a point takes part in the face step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FaceBinding {
    /// Not at all.
    #[default]
    None,
    /// With the flow, by this share, 0 to 1.
    Skin(f32),
    /// With the flow of hair.
    Hair(f32),
    /// As a point of the left (0) or right (1) eyeball.
    Ball(u8),
    /// With so-and-so many of the pieces that keep their shape.
    Piece(u32),
}

/// The face step, for any youth.
#[derive(Clone, Debug)]
pub struct YoungFace {
    /// Where the head is, after the stages before.
    frame: HeadFrame,
    rows: Rows,
    skin: Follower,
    hair: Follower,
    /// What hats, glasses and earrings do after each piece of the way: one row for each thing.
    pieces: Vec<Piece>,
    ways: Ways,
}

/// A thing that keeps its shape.
#[derive(Clone, Debug)]
struct Piece {
    /// Where its points were.
    from: Vec<Vec3>,
    /// It is moved and scaled as one, in head lengths: p -> shift + scale p, scale first.
    after: [(f64, DVec3); STEPS],
}

/// The ways of vertices, from where the stages before put them, in head lengths.
#[derive(Clone, Debug, Default)]
struct Ways {
    /// For each vertex its row in `from` and `ways`; `NO_WAY` where it is not kept.
    rows: Vec<u32>,
    /// Where they begin, and whether as hair.
    from: Vec<(Vec3, bool)>,
    ways: Vec<[Vec3; STEPS]>,
}

const NO_WAY: u32 = u32::MAX;

/// Vertices of a head, and where the stages before the face step put them.
pub struct HeadPoints<'a> {
    /// Which they are.
    pub vertices: &'a [u32],
    /// Where each is, and how it takes part.
    pub points: &'a [(DVec3, FaceBinding)],
    /// How many vertices the figure has.
    pub count: usize,
}

/// Where a way that is kept begins: in single precision, 3e-8 head lengths. So a head that is only moved or made larger gives the
/// same to the bit, and its ways need not be followed again.
fn beginning(frame: &HeadFrame, p: DVec3) -> Vec3 {
    frame.to_unit(p).as_vec3()
}

impl YoungFace {
    /// The step that moves a head at `frame` by `rows`.
    ///
    /// - `things`: where the stages before put the vertices of each thing that keeps its shape.
    /// - `head`: where they put the head's vertices.
    /// - `known`: a step for the same things and vertices, of which that is taken that is the same.
    /// - `threads`: at most this many, 0 for all cores.
    pub fn new(
        frame: HeadFrame,
        rows: Rows,
        things: &[Vec<DVec3>],
        head: &HeadPoints,
        known: Option<&Self>,
        threads: usize,
    ) -> Self {
        let known = known.filter(|known| known.rows == rows);
        let (skin, hair) = (Follower::new(&rows.kernels), Follower::new(&rows.kernels[rows.of_skin..]));
        let mut face = Self { frame, rows, skin, hair, pieces: Vec::new(), ways: Ways::default() };
        let piece = |(index, points): (usize, &Vec<DVec3>)| {
            let from: Vec<Vec3> = points.iter().map(|&p| beginning(&frame, p)).collect();
            let known = known.and_then(|known| known.pieces.get(index)).filter(|known| known.from == from);
            known.cloned().unwrap_or_else(|| face.piece(from))
        };
        face.pieces = things.iter().enumerate().map(piece).collect();
        face.ways = face.ways_of(head, known.map(|known| &known.ways), threads);
        face
    }

    /// The similarities that take a thing nearest to where the flow takes its points: glasses grow with the eyes that they
    /// stand before, hats with the skull.
    fn piece(&self, beginnings: Vec<Vec3>) -> Piece {
        let from: Vec<DVec3> = beginnings.iter().map(|p| p.as_dvec3()).collect();
        let ways: Vec<_> = from.iter().map(|&p| self.skin.way(p)).collect();
        let mean =
            |of: &dyn Fn(usize) -> DVec3| (0..from.len()).map(of).sum::<DVec3>() / from.len().max(1) as f64;
        let middle = mean(&|point| from[point]);
        let spread: f64 = from.iter().map(|p| p.distance_squared(middle)).sum();
        let after = std::array::from_fn(|step| {
            let moved = mean(&|point| ways[point][step]);
            let along: f64 =
                (0..from.len()).map(|point| (from[point] - middle).dot(ways[point][step] - moved)).sum();
            let scale = if spread > 0.0 { along / spread } else { 1.0 };
            (scale, moved - scale * middle)
        });
        Piece { from: beginnings, after }
    }

    /// Where `p`, which the stages before have put there, is after the share `youth` of its way; of a `vertex` that is kept.
    pub fn place(&self, p: DVec3, binding: FaceBinding, youth: f64, vertex: Option<usize>) -> DVec3 {
        let (follower, share) = match binding {
            FaceBinding::Skin(share) => (&self.skin, share),
            FaceBinding::Hair(share) => (&self.hair, share),
            _ => return self.map(p, binding, youth).position,
        };
        let row = vertex.and_then(|vertex| self.ways.rows.get(vertex)).filter(|row| **row != NO_WAY);
        let moved = match row {
            Some(&row) => along_f32(&self.ways.ways[row as usize], youth).as_dvec3(),
            None => follower.place(self.frame.to_unit(p), youth) - self.frame.to_unit(p),
        };
        p + f64::from(share) * self.frame.length * moved
    }

    /// As [`Self::place`], with the Jacobian.
    pub fn map(&self, p: DVec3, binding: FaceBinding, youth: f64) -> Mapped {
        let (follower, share) = match binding {
            FaceBinding::None => return Mapped::unmoved(p),
            FaceBinding::Skin(share) => (&self.skin, f64::from(share)),
            FaceBinding::Hair(share) => (&self.hair, f64::from(share)),
            FaceBinding::Ball(eye) => {
                let Some(balls) = &self.rows.balls else { return Mapped::unmoved(p) };
                let (to, jacobian) = balls[usize::from(eye)].map(self.frame.to_unit(p), youth);
                return Mapped { position: self.frame.from_unit(to), jacobian };
            }
            FaceBinding::Piece(piece) => {
                let from = self.frame.to_unit(p);
                let after = self.pieces[piece as usize].after;
                let way = after.map(|(scale, shift)| shift + scale * from);
                let scales = after.map(|(scale, _)| DVec3::splat(scale));
                let scale = along(DVec3::ONE, &scales, youth).x;
                let position = self.frame.from_unit(along(from, &way, youth));
                return Mapped { position, jacobian: DMat3::IDENTITY * scale };
            }
        };
        let from = self.frame.to_unit(p);
        let (to, jacobian) = follower.map(from, youth);
        Mapped {
            position: p + share * self.frame.length * (to - from),
            jacobian: DMat3::IDENTITY + (jacobian - DMat3::IDENTITY) * share,
        }
    }

    /// See [`Rows::opens_lids`]; `p` is where the stages before have put a point.
    pub fn opens_lids(&self, p: DVec3) -> f64 {
        self.rows.opens_lids(self.frame.to_unit(p))
    }

    /// See [`Rows::painted`]; only skin is painted.
    pub fn painted(&self, p: DVec3, binding: FaceBinding) -> [f64; 2] {
        let FaceBinding::Skin(share) = binding else { return [0.0; 2] };
        self.rows.painted(self.frame.to_unit(p)).map(|weight| f64::from(share) * weight)
    }

    /// The ways of the head's vertices, of which those are taken from `known` that are the same.
    fn ways_of(&self, head: &HeadPoints, known: Option<&Ways>, threads: usize) -> Ways {
        let follower = |is_hair: bool| if is_hair { &self.hair } else { &self.skin };
        // What begins at one place and goes one way is one: seams repeat it.
        let mut rows = vec![NO_WAY; head.count];
        let mut row_of: CellMap<([u32; 3], bool), u32> = CellMap::default();
        let mut from: Vec<(Vec3, bool)> = Vec::new();
        for (&vertex, &(p, binding)) in head.vertices.iter().zip(head.points) {
            let is_hair = match binding {
                FaceBinding::Skin(share) if share > 0.0 => false,
                FaceBinding::Hair(share) if share > 0.0 => true,
                _ => continue,
            };
            let p = beginning(&self.frame, p);
            let place = (p.to_array().map(f32::to_bits), is_hair);
            rows[vertex as usize] = *row_of.entry(place).or_insert_with(|| {
                from.push((p, is_hair));
                from.len() as u32 - 1
            });
        }
        let known = known.filter(|known| known.rows == rows);
        // Eight at once, the last one again where they are fewer.
        let ways = parallel::collect(threads, from.len().div_ceil(8), parallel::FEW_RAYS, |eight| {
            let of: [usize; 8] = std::array::from_fn(|next| (8 * eight + next).min(from.len() - 1));
            if let Some(known) = known.filter(|known| of.iter().all(|&row| known.from[row] == from[row])) {
                return of.map(|row| known.ways[row]);
            }
            let points = of.map(|row| from[row].0);
            let is_hair = of.map(|row| from[row].1);
            let [skin, hair] = [false, true].map(|wanted| {
                let some = is_hair.contains(&wanted);
                if some { follower(wanted).ways(points) } else { Default::default() }
            });
            std::array::from_fn(|next| if is_hair[next] { hair[next] } else { skin[next] })
        });
        let mut ways = ways.into_flattened();
        ways.truncate(from.len());
        Ways { rows, from, ways }
    }
}

/// As [`along`], from 0.
fn along_f32(way: &[Vec3; STEPS], youth: f64) -> Vec3 {
    let (whole, rest) = pieces(youth);
    let rest = rest as f32;
    let last = if whole == 0 { Vec3::ZERO } else { way[whole - 1] };
    if rest > 0.0 { last + rest * (way[whole] - last) } else { last }
}
