//! The product's field: parts, one map each, that agree at the landmarks.
//!
//! A chain of bones (the paper's field) adds up every rig's conventions on its way from the hips to the head: heads
//! sink into chests, arms rise above eyes. Here every part is placed by heights read from the geometry, from the
//! ground up; soles, crotch, shoulder line and chin are where neighbouring maps meet, and limbs start where the
//! torso's map puts their joints. A vertex goes where the weighted mean of its parts' maps puts it.

use super::anatomy::{Anatomy, Limb};
use super::binding::PartBinding;
use super::part::{HAIR, HEAD, NECK, PART_COUNT, Part, PartWeights, TINY, TORSO};
use super::pieces::{Attachment, Piece};
use super::profile::Slices;
use super::profile::chains::arm_share;
use super::profile::map::chain_of;
use super::profile::radius_map::Spot;
use super::profile::relief::Relief;
use super::scales::{HeadScale, PartCoefficients, Scale};
use crate::geometry::{Mapped, Moved, outer, smoothstep};
use crate::shape::heights::Heights;
use glam::{DMat3, DVec3};

/// Above the shoulder line the torso's heights change at most this many times as much as the neck's. D28. Seen: less
/// sinks collars by up to .013 H.
const YOKE_PER_NECK: f64 = 1.5;
/// Of what the torso's length leaves of it, arms that become thicker leave at least this much below them. Seen: at .5 and .9, of 154
/// results 3 and 5 % more triangles turn over; at .5 backs at two heads have grooves.
const LEAST_TRUNK: f64 = 0.7;
/// A piece that is kept from reaching below the ground keeps at least this share of its size: for things as long as the
/// figure is tall, of which none was seen.
const SMALLEST_PIECE: f64 = 0.05;

/// p -> to + linear (p - from).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Affine {
    from: DVec3,
    to: DVec3,
    linear: DMat3,
}

impl Affine {
    const IDENTITY: Self = Self { from: DVec3::ZERO, to: DVec3::ZERO, linear: DMat3::IDENTITY };

    #[inline(always)]
    fn map(&self, p: DVec3) -> Mapped {
        Mapped { position: self.to + self.linear * (p - self.from), jacobian: self.linear }
    }

    /// `scale.length` along `direction`, `scale.thickness` across it.
    fn stretch(from: DVec3, to: DVec3, direction: DVec3, scale: Scale) -> Self {
        let d = direction.normalize_or_zero();
        let linear = DMat3::IDENTITY * scale.thickness + outer(d, d) * (scale.length - scale.thickness);
        Self { from, to, linear }
    }
}

/// Where arms leave the torso.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yoke {
    /// Half of how high an arm is there.
    pub half: f64,
    /// How much higher it becomes.
    pub scale: f64,
    /// How much of that is height: 1 of an arm held out, 0 of one that hangs.
    pub level: f64,
}

impl Yoke {
    /// Of a body whose arms are not measured.
    pub const NONE: Self = Self { half: 0.0, scale: 1.0, level: 0.0 };
}

/// Heights of the torso, before and after. From as far above the shoulder line as arms reach to as far below it they are
/// stretched as arms are, so that both are equally high where they meet; within as much again the slope goes over into that of
/// the rest. The top stays: arms that become thicker grow downwards, away from the chin.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TorsoHeights {
    /// Sole, crotch, shoulder line, before and after.
    sole: [f64; 2],
    crotch: [f64; 2],
    shoulder_line: [f64; 2],
    half: f64,
    /// Slopes above the yoke, in its two halves, and of the rest down to the crotch.
    above: f64,
    yoke: [f64; 2],
    rest: f64,
}

impl TorsoHeights {
    /// - `length`, `above`: the slopes without a yoke.
    fn new(before: &Heights, after: &Heights, length: f64, above: f64, yoke: Yoke) -> Self {
        let whole = before.shoulder_line - before.crotch;
        let half = yoke.half.min(whole / 3.0).max(TINY);
        // The slope within half below the yoke, in the mean halfway, counts as half of it.
        let (below, left) = (1.5 * half, (whole - 1.5 * half).max(TINY));
        let room = half * above + below * length + (1.0 - LEAST_TRUNK) * length * left / yoke.level.max(TINY);
        let scale = yoke.scale.min(room / (half + below));
        let slopes = [above, length].map(|own| own + yoke.level * (scale - own));
        let middle = after.shoulder_line + half * (above - slopes[0]);
        Self {
            sole: [before.sole, after.sole],
            crotch: [before.crotch, after.crotch],
            shoulder_line: [before.shoulder_line, middle],
            half,
            above,
            yoke: slopes,
            rest: (middle - after.crotch - below * slopes[1]) / left,
        }
    }

    /// Where height `y` goes, and the slope there.
    #[inline(always)]
    fn at(&self, y: f64) -> (f64, f64) {
        if y < self.crotch[0] {
            let slope = (self.crotch[1] - self.sole[1]) / (self.crotch[0] - self.sole[0]);
            return (self.sole[1] + slope * (y - self.sole[0]), slope);
        }
        let Self { half, above, yoke: [upper, lower], rest, .. } = *self;
        let up = y - self.shoulder_line[0];
        if up >= 0.0 {
            let (within, beyond) = (up.min(half), (up - half).max(0.0));
            let slope = if up < half { upper } else { above };
            return (self.shoulder_line[1] + upper * within + above * beyond, slope);
        }
        let x = (-up / half - 1.0).clamp(0.0, 1.0);
        let of_yoke = (-up).min(half) + half * (x - x * x * x + 0.5 * x * x * x * x);
        let to = self.shoulder_line[1] + rest * up - (lower - rest) * of_yoke;
        (to, lower + (rest - lower) * smoothstep(x))
    }
}

/// Product mode's field.
#[derive(Clone, Debug)]
pub struct PartField {
    anatomy: Anatomy,
    coefficients: PartCoefficients,
    after: Heights,
    /// Maps of the parts that are affine: head and limbs; torso and neck have their own.
    affine: [Affine; PART_COUNT],
    heights: TorsoHeights,
    yoke: Yoke,
    /// z about which the torso's centre line is flattened.
    hip_z: f64,
    /// The neck's axis at the shoulder line, before and after.
    neck_z: [f64; 2],
    pieces: Vec<Affine>,
    /// What comes before the parts; `None` where nothing does.
    slices: Option<Slices>,
}

impl PartField {
    /// The field that moves a figure of `anatomy` by `coefficients`.
    pub fn new(anatomy: &Anatomy, coefficients: PartCoefficients) -> Self {
        Self::with_yoke(anatomy, coefficients, Yoke::NONE)
    }

    fn with_yoke(anatomy: &Anatomy, coefficients: PartCoefficients, yoke: Yoke) -> Self {
        let before = anatomy.landmarks.heights;
        let after = heights_after(anatomy, &coefficients);
        let Scale { length, thickness } = coefficients.torso;
        let above = thickness.min(YOKE_PER_NECK * coefficients.neck.length).min(1.0);
        let base = anatomy.centre_z(before.shoulder_line).0;
        let mut field = Self {
            anatomy: anatomy.clone(),
            coefficients,
            after,
            affine: [Affine::IDENTITY; PART_COUNT],
            heights: TorsoHeights::new(&before, &after, length, above, yoke),
            yoke,
            hip_z: anatomy.centre_line.iter().map(|point| point.1).sum::<f64>()
                / anatomy.centre_line.len() as f64,
            neck_z: [base, base],
            pieces: Vec::new(),
            slices: None,
        };
        let neck_base = DVec3::new(anatomy.middle_x, before.shoulder_line, base);
        field.neck_z[1] = field.torso(neck_base).position.z;
        field.place_head();
        field.place_limbs();
        field
    }

    /// The same field with arms that leave the torso so.
    pub fn from_yoke(&self, yoke: Yoke) -> Self {
        Self::with_yoke(&self.anatomy, self.coefficients, yoke)
    }

    /// The same field about another centre line of the torso.
    pub fn about(&self, centre_line: Vec<(f64, f64)>) -> Self {
        Self::with_yoke(&Anatomy { centre_line, ..self.anatomy.clone() }, self.coefficients, self.yoke)
    }

    /// The same field after `slices`, which takes `pieces` along.
    pub fn with(mut self, slices: Option<Slices>, pieces: &[Piece]) -> Self {
        self.slices = slices;
        self.place_limbs();
        self.pieces = pieces.iter().map(|piece| self.piece_map(piece)).collect();
        self
    }

    /// By part, 0 where it does what `other` does, a field of the same figure, else 1.
    pub fn changes(&self, other: &Self) -> PartWeights {
        let levels = |field: &Self| [field.after.sole, field.after.crotch, field.after.shoulder_line];
        let torso = |field: &Self| (field.coefficients.torso, field.heights, field.hip_z);
        let neck = |field: &Self| (field.coefficients.neck, field.neck_z);
        let is_same = |part: usize| match part {
            TORSO => self.anatomy.centre_line == other.anatomy.centre_line && torso(self) == torso(other),
            NECK => neck(self) == neck(other) && levels(self) == levels(other),
            HAIR => self.affine[HEAD] == other.affine[HEAD],
            _ => self.affine[part] == other.affine[part],
        };
        let are_sliced = match (&self.slices, &other.slices) {
            (Some(own), Some(other)) => own.common(other),
            (own, other) => [own.is_none() && other.is_none(); PART_COUNT],
        };
        // What head and hair alone move, no slice does.
        let are_sliced = |part: usize| are_sliced[part] || part == HEAD || part == HAIR;
        std::array::from_fn(|part| if is_same(part) && are_sliced(part) { 0.0 } else { 1.0 })
    }

    /// Its coefficients.
    pub fn coefficients(&self) -> &PartCoefficients {
        &self.coefficients
    }

    /// How much longer torso, legs and arms become.
    pub fn lengths(&self) -> [f64; 3] {
        let (before, after, limbs) = (self.before(), &self.after, &self.anatomy.limbs);
        let new = |limb: &Limb| limb.parts.map(|part| self.affine[part].to);
        let ankles = |height: &dyn Fn(&Limb) -> f64| limbs[2..].iter().map(height).sum::<f64>() / 2.0;
        let arms = |length: &dyn Fn(&Limb) -> f64| limbs[..2].iter().map(length).sum::<f64>();
        [
            (after.shoulder_line - after.crotch) / (before.shoulder_line - before.crotch),
            (after.crotch - ankles(&|leg| new(leg)[2].y)) / (before.crotch - ankles(&|leg| leg.end.y)),
            arms(&|arm| new(arm)[0].distance(new(arm)[2]))
                / arms(&|arm| arm.root.distance(arm.end)).max(TINY),
        ]
    }

    /// Where a part's own map puts `p`.
    pub fn place_part(&self, part: usize, p: DVec3) -> DVec3 {
        self.part(part, p).position
    }

    /// Where the torso's own map puts `p`.
    pub fn place_torso(&self, p: DVec3) -> DVec3 {
        self.torso(p).position
    }

    /// Where the head's own map puts `p`.
    pub fn place_head_alone(&self, p: DVec3) -> DVec3 {
        self.affine[HEAD].map(p).position
    }

    /// Heights before.
    pub fn before(&self) -> &Heights {
        &self.anatomy.landmarks.heights
    }

    /// Heights after, before the ground shift.
    pub fn after(&self) -> &Heights {
        &self.after
    }

    /// Where `p` goes.
    pub fn place(&self, p: DVec3, binding: &PartBinding) -> DVec3 {
        match binding.attachment {
            Attachment::Piece(piece) => self.pieces[piece].map(p).position,
            Attachment::Strand { piece, share } => self.strand(p, binding, piece, share.into()).position,
            _ => self.body(p, binding),
        }
    }

    /// As [`Self::place`], of a point whose spots are known.
    pub fn place_known(&self, p: DVec3, binding: &PartBinding, spots: &[(u8, Spot)]) -> DVec3 {
        if binding.is_plain() {
            self.body_by(p, binding, |relief, p| relief.map_known(p, spots))
        } else {
            self.place(p, binding)
        }
    }

    /// Where `p` goes, and the Jacobian there at fixed binding.
    pub fn map(&self, p: DVec3, binding: &PartBinding) -> Mapped {
        match binding.attachment {
            Attachment::Piece(piece) => self.pieces[piece].map(p),
            Attachment::Strand { piece, share } => self.strand(p, binding, piece, share.into()),
            _ => self.body(p, binding),
        }
    }

    /// Between where the body takes `p` and where the piece does.
    // Not inlined: few vertices are a strand's.
    #[inline(never)]
    fn strand(&self, p: DVec3, binding: &PartBinding, piece: usize, share: f64) -> Mapped {
        let body: Mapped = self.body(p, binding);
        let whole = self.pieces[piece].map(p);
        Mapped {
            position: body.position.lerp(whole.position, share),
            jacobian: body.jacobian * (1.0 - share) + whole.jacobian * share,
        }
    }

    /// Where relief, slices and parts take `p`: the parts alone, where a body of next to no length gives no number.
    #[inline(always)]
    fn body<M: Moved>(&self, p: DVec3, binding: &PartBinding) -> M {
        self.body_by(p, binding, |relief, p| relief.map(p, &binding.weights, binding.is_skirt))
    }

    /// The same, where relief takes what comes before it as `smooth` says.
    #[inline(always)]
    fn body_by<M: Moved>(
        &self,
        p: DVec3,
        binding: &PartBinding,
        smooth: impl FnOnce(&Relief, DVec3) -> M,
    ) -> M {
        let PartBinding { weights, is_skirt, .. } = binding;
        let unmoved = M::of(p, || DMat3::IDENTITY);
        let to: M = match &self.slices {
            Some(slices) if binding.is_on_bone() => {
                let on_bones: M = slices.map.on_bones(p, usize::from(arm_share(weights, 1) > 0.0));
                self.blend(weights, |_| on_bones)
            }
            Some(slices) if !is_of_head(weights) => {
                let first = match binding.attachment {
                    Attachment::Digits(shares) => slices.map.digits(p, weights, shares),
                    _ => unmoved,
                };
                let smooth = smooth(&slices.relief, first.position());
                let smooth = M::of(smooth.position(), || smooth.jacobian() * first.jacobian());
                let mut known = (PART_COUNT, smooth);
                self.blend(weights, |part| {
                    let chain = chain_of(part, *is_skirt);
                    if chain == HEAD || chain == HAIR {
                        return unmoved;
                    }
                    if chain != known.0 {
                        let to: M = slices.map.part(chain, smooth.position(), *is_skirt);
                        known = (chain, M::of(to.position(), || to.jacobian() * smooth.jacobian()));
                    }
                    known.1
                })
            }
            _ => self.blend(weights, |_| unmoved),
        };
        if to.position().is_finite() { to } else { self.blend(weights, |_| unmoved) }
    }

    /// The weighted mean of what the parts make of what comes `before` them.
    #[inline(always)]
    fn blend<M: Moved>(&self, weights: &PartWeights, mut before: impl FnMut(usize) -> M) -> M {
        let mut position = DVec3::ZERO;
        let mut jacobian = DMat3::ZERO;
        let mut total = 0.0;
        for (part, &weight) in weights.iter().enumerate().filter(|&(_, &weight)| weight > 0.0) {
            let weight = f64::from(weight);
            let from = before(part);
            let to = self.part(part, from.position());
            position += weight * to.position;
            jacobian += M::of(to.position, || to.jacobian * from.jacobian()).jacobian() * weight;
            total += weight;
        }
        M::of(position / total, || jacobian * (1.0 / total))
    }

    #[inline(always)]
    fn part(&self, part: usize, p: DVec3) -> Mapped {
        match part {
            TORSO => self.torso(p),
            NECK => self.neck(p),
            // Hair that hangs is made shorter where it is known what it hangs on.
            HAIR => self.affine[HEAD].map(p),
            _ => self.affine[part].map(p),
        }
    }

    /// Heights piecewise between the landmarks, x about the middle, z about the centre line, which itself is
    /// flattened: else the curve of the back is exaggerated.
    #[inline(always)]
    fn torso(&self, p: DVec3) -> Mapped {
        let Scale { length, thickness } = self.coefficients.torso;
        let (y, slope) = self.heights.at(p.y);
        let (centre, centre_slope) = self.anatomy.centre_z(p.y);
        let flattening = length.min(thickness);
        let x = self.anatomy.middle_x + thickness * (p.x - self.anatomy.middle_x);
        let z = self.hip_z + flattening * (centre - self.hip_z) + thickness * (p.z - centre);
        let jacobian = DMat3::from_cols(
            DVec3::new(thickness, 0.0, 0.0),
            DVec3::new(0.0, slope, (flattening - thickness) * centre_slope),
            DVec3::new(0.0, 0.0, thickness),
        );
        Mapped { position: DVec3::new(x, y, z), jacobian }
    }

    #[inline(always)]
    fn neck(&self, p: DVec3) -> Mapped {
        let Scale { length, thickness } = self.coefficients.neck;
        let position = DVec3::new(
            self.anatomy.middle_x + thickness * (p.x - self.anatomy.middle_x),
            self.after.shoulder_line + length * (p.y - self.before().shoulder_line),
            self.neck_z[1] + thickness * (p.z - self.neck_z[0]),
        );
        Mapped { position, jacobian: DMat3::from_diagonal(DVec3::new(thickness, length, thickness)) }
    }

    /// The head is scaled about the chin's level on the neck's axis.
    fn place_head(&mut self) {
        let anatomy = &self.anatomy;
        let HeadScale { height, width, depth } = self.coefficients.head;
        let axis_z = anatomy.head_joint.z;
        let from = DVec3::new(anatomy.middle_x, self.before().chin, axis_z);
        let z = self.neck_z[1] + self.coefficients.neck.thickness * (axis_z - self.neck_z[0]);
        let to = DVec3::new(anatomy.middle_x, self.after.chin, z);
        let linear = DMat3::from_diagonal(DVec3::new(width, height, depth));
        self.affine[HEAD] = Affine { from, to, linear };
    }

    /// Limbs start where the torso puts their joints; hands and feet keep their shape.
    fn place_limbs(&mut self) {
        let scales = self.coefficients;
        for (index, limb) in self.anatomy.limbs.into_iter().enumerate() {
            let is_arm = index < 2;
            let (spread, upper, lower, size) = if is_arm {
                (scales.shoulder_spread, scales.upper_arm, scales.lower_arm, scales.hand)
            } else {
                (scales.hip_spread, scales.upper_leg, scales.lower_leg, scales.foot)
            };
            // Where the slices leave the joints; directions stay those at rest.
            let [first, second, last] = limb.parts;
            let joints = [limb.root, limb.middle, limb.end];
            let sliced: [DVec3; 3] = match &self.slices {
                Some(slices) if is_arm => joints.map(|joint| slices.map.on_bones(joint, index)),
                Some(slices) => std::array::from_fn(|at| slices.map.part(limb.parts[at], joints[at], false)),
                None => joints,
            };
            let from = if sliced.iter().all(|joint| joint.is_finite()) { sliced } else { joints };
            let mut root = self.torso(from[0]).position;
            root.x = self.anatomy.middle_x + spread * (from[0].x - self.anatomy.middle_x);
            self.affine[first] = Affine::stretch(from[0], root, limb.middle - limb.root, upper);
            let middle = self.affine[first].map(from[1]).position;
            self.affine[second] = Affine::stretch(from[1], middle, limb.end - limb.middle, lower);
            let mut end = self.affine[second].map(from[2]).position;
            if !is_arm {
                // Legs of unequal length still both stand on the ground.
                end.y = self.after.sole + size * (limb.end.y - self.before().sole);
            }
            self.affine[last] = Affine { from: from[2], to: end, linear: DMat3::IDENTITY * size };
        }
    }

    /// A piece goes where the body carries its anchor, and grows in all directions as that does in the mean.
    fn piece_map(&self, piece: &Piece) -> Affine {
        let to =
            self.map(piece.anchor, &PartBinding { weights: piece.weights, ..PartBinding::to(Part::Torso) });
        let mut scale = to.local_scale();
        if piece.lowest >= self.before().sole && piece.anchor.y > piece.lowest {
            // What did not reach the ground does not reach below it.
            scale = scale
                .min((to.position.y - self.after.sole) / (piece.anchor.y - piece.lowest))
                .max(SMALLEST_PIECE * scale);
        }
        Affine { from: piece.anchor, to: to.position, linear: DMat3::IDENTITY * scale }
    }

    /// Where the body's heights go, piecewise between the landmarks: what hair follows.
    pub fn body_height(&self, y: f64) -> f64 {
        let [shoulder_line, to] = self.heights.shoulder_line;
        if y < shoulder_line {
            return self.heights.at(y).0;
        }
        to + (self.after.chin - to) * (y - shoulder_line) / (self.before().chin - shoulder_line).max(TINY)
    }
}

/// True for what head and hair alone move: no slice of the body does.
pub fn is_of_head(weights: &PartWeights) -> bool {
    weights.iter().enumerate().all(|(part, &weight)| weight == 0.0 || part == HEAD || part == HAIR)
}

/// From the ground up: legs, torso, neck, head.
fn heights_after(anatomy: &Anatomy, coefficients: &PartCoefficients) -> Heights {
    let proportions = &anatomy.proportions;
    let sole = anatomy.landmarks.heights.sole;
    let leg = anatomy.limbs[2..]
        .iter()
        .map(|leg| {
            coefficients.upper_leg.length * (leg.root.y - leg.middle.y)
                + coefficients.lower_leg.length * (leg.middle.y - leg.end.y)
                + coefficients.foot * (leg.end.y - sole)
        })
        .sum::<f64>()
        / 2.0;
    let crotch = sole + leg;
    let shoulder_line = crotch + coefficients.torso.length * proportions.torso;
    let chin = shoulder_line + coefficients.neck.length * proportions.neck;
    let crown = chin + coefficients.head.height * proportions.head_length;
    Heights { crown, chin, shoulder_line, crotch, sole }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEFORE: Heights = Heights { crown: 1.9, chin: 1.6, shoulder_line: 1.5, crotch: 0.9, sole: 0.0 };
    const AFTER: Heights = Heights { crown: 1.1, chin: 0.7, shoulder_line: 0.6, crotch: 0.3, sole: 0.0 };

    /// Half as long below the shoulder line, and .7 times above it.
    fn with(half: f64, scale: f64, level: f64) -> TorsoHeights {
        TorsoHeights::new(&BEFORE, &AFTER, 0.5, 0.7, Yoke { half, scale, level })
    }

    #[test]
    fn a_torso_is_as_high_as_arms_are_where_they_leave_it() {
        let torso = with(0.05, 1.2, 1.0);
        let height = |y: f64| torso.at(y).0;
        // The arm's top stays, and all above it.
        for y in [1.55, 1.7] {
            assert!((height(y) - (0.6 + 0.7 * (y - 1.5))).abs() < 1e-12);
        }
        assert!((height(1.55) - height(1.45) - 1.2 * 0.1).abs() < 1e-12);
        assert!((height(0.9) - 0.3).abs() < 1e-12 && height(0.0) == 0.0);
        // Below the yoke what is left is even again.
        assert!((torso.at(1.39).1 - torso.at(0.95).1).abs() < 1e-12);
    }

    #[test]
    fn without_arms_that_are_held_out_a_torso_has_one_slope() {
        for torso in [with(0.05, 1.2, 0.0), TorsoHeights::new(&BEFORE, &AFTER, 0.5, 0.7, Yoke::NONE)] {
            for y in [0.95, 1.2, 1.44, 1.5, 1.52, 1.8] {
                let slope = if y < 1.5 { 0.5 } else { 0.7 };
                let (to, found) = torso.at(y);
                assert!((to - (0.6 + slope * (y - 1.5))).abs() < 1e-9, "{y}: {to}");
                assert!(y == 1.5 || (found - slope).abs() < 1e-9, "{y}: {found}");
            }
        }
    }

    #[test]
    fn heights_keep_their_order_and_have_the_slope_that_is_said() {
        for (half, scale, level) in [(0.05, 1.2, 1.0), (0.05, 40.0, 0.7), (3.0, 2.0, 1.0), (0.1, 0.01, 1.0)] {
            let torso = with(half, scale, level);
            for y in (1..190).map(|row| 0.01 * f64::from(row) + 0.003) {
                let slope = (torso.at(y + 1e-7).0 - torso.at(y - 1e-7).0) / 2e-7;
                assert!(
                    (torso.at(y).1 - slope).abs() < 1e-5 * slope.max(1.0),
                    "{half} {scale} at {y}: {slope}"
                );
                assert!(slope > 0.0, "{half} {scale} {level} at {y}: {slope}");
            }
            let least = torso.at(0.91).1;
            assert!(least > 0.5 * LEAST_TRUNK - 1e-9, "{least}");
        }
    }
}
