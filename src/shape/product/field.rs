//! The product's field: fifteen parts, one map each, that agree at the landmarks.
//!
//! A chain of bones (the paper's field) adds up every rig's conventions on its way from the hips to the head: heads
//! sink into chests, arms rise above eyes. Here every part is placed by heights read from the geometry, from the
//! ground up; soles, crotch, shoulder line and chin are where neighbouring maps meet, and limbs start where the
//! trunk's map puts their joints. A vertex goes where the weighted mean of its parts' maps puts it.

use super::anatomy::Anatomy;
use super::binding::{PartBinding, PartBindings};
use super::coefficients::PartCoefficients;
use super::hair::HairMap;
use super::part::{PART_COUNT, Part, PartWeights};
use super::pieces::Attachment;
use crate::face::FaceShape;
use crate::shape::heights::Heights;
use glam::{DMat3, DVec3};

/// The head moves back by this part of its distance before the chest, at most so many new heads.
const HEAD_SEAT: f64 = 0.5;
const HEAD_SEAT_MOST: f64 = 0.08;
/// How far below the chin hair is as narrow as it gets, in new heads.
const HAIR_TAPERING: f64 = 0.5;
/// The height at which the chest's middle is taken, from crotch (0) to shoulder line (1).
const CHEST_HEIGHT: f64 = 0.85;

const TRUNK: usize = Part::Trunk as usize;
const NECK: usize = Part::Neck as usize;
const HEAD: usize = Part::Head as usize;
const HAIR: usize = Part::Hair as usize;

/// p -> to + linear (p - from).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Affine {
    from: DVec3,
    to: DVec3,
    linear: DMat3,
}

impl Affine {
    const IDENTITY: Self = Self { from: DVec3::ZERO, to: DVec3::ZERO, linear: DMat3::IDENTITY };

    fn map(&self, p: DVec3) -> DVec3 {
        self.to + self.linear * (p - self.from)
    }

    /// `length_scale` along `direction`, `thickness_scale` across it.
    fn stretch(from: DVec3, to: DVec3, direction: DVec3, length_scale: f64, thickness_scale: f64) -> Self {
        let d = direction.normalize_or_zero();
        let along = DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        let linear = DMat3::IDENTITY * thickness_scale + along * (length_scale - thickness_scale);
        Self { from, to, linear }
    }
}

/// The product's field.
#[derive(Clone, Debug)]
pub struct PartField {
    anatomy: Anatomy,
    coefficients: PartCoefficients,
    before: Heights,
    after: Heights,
    /// Maps of the parts that are affine: head and limbs; trunk and neck have their own.
    affine: [Affine; PART_COUNT],
    /// Slope of heights above the shoulder line on the trunk.
    yoke_slope: f64,
    /// z about which the trunk's centre line is flattened.
    hip_z: f64,
    /// The neck's axis at the shoulder line (before, after) and how far the head moves back.
    neck_z: [f64; 2],
    head_back: f64,
    hair: Option<HairMap>,
    face: FaceShape,
    pieces: Vec<Affine>,
    amount: f64,
    /// Added to all heights in the end, so that the soles stay.
    ground: f64,
}

impl PartField {
    /// The field that moves a figure of `anatomy` by `coefficients`.
    ///
    /// - `hair_length`: 1 ends hair at the part of the body where it ended, 0 at the chin.
    /// - `amount`: 0 leaves everything where it is, 1 goes all the way.
    pub fn new(
        anatomy: &Anatomy,
        coefficients: PartCoefficients,
        bindings: &PartBindings,
        hair_length: f64,
        amount: f64,
    ) -> Self {
        let proportions = &anatomy.proportions;
        let before = anatomy.landmarks.heights;
        let leg = anatomy.limbs[2..]
            .iter()
            .map(|leg| {
                coefficients.limbs[2][0] * (leg.root.y - leg.middle.y)
                    + coefficients.limbs[3][0] * (leg.middle.y - leg.end.y)
                    + coefficients.foot * (leg.end.y - before.sole)
            })
            .sum::<f64>()
            / 2.0;
        let crotch = before.sole + leg;
        let shoulder_line = crotch + coefficients.trunk[0] * proportions.torso;
        let chin = shoulder_line + coefficients.neck[0] * proportions.neck;
        let crown = chin + coefficients.head[0] * proportions.head_length;
        let after = Heights { sole: before.sole, crotch, shoulder_line, chin, crown };

        let hip_z =
            anatomy.centre_line.iter().map(|point| point.1).sum::<f64>() / anatomy.centre_line.len() as f64;
        let base = anatomy.centre_z(before.shoulder_line).0;
        let mut field = Self {
            anatomy: anatomy.clone(),
            coefficients,
            before,
            after,
            affine: [Affine::IDENTITY; PART_COUNT],
            yoke_slope: coefficients.trunk[1].min(1.5 * coefficients.neck[0]).min(1.0),
            hip_z,
            neck_z: [base, base],
            head_back: 0.0,
            hair: None,
            face: FaceShape::None,
            pieces: Vec::new(),
            amount,
            ground: 0.0,
        };
        let middle = |y: f64, z: f64| DVec3::new(anatomy.middle_x, y, z);
        field.neck_z[1] = field.trunk(middle(before.shoulder_line, base)).0.z;
        field.place_head();
        field.place_limbs();
        field.hair = bindings.hair.as_ref().map(|outline| {
            let bottom = before.chin - outline.depth;
            let new_bottom = after.chin + hair_length * (field.body_height(bottom) - after.chin);
            let head = field.affine[HEAD];
            // Hair of no length at all would be a disc.
            let least = 0.05 * coefficients.head[0] * outline.depth;
            HairMap::new(
                outline,
                [head.from, head.to],
                new_bottom.min(after.chin - least),
                coefficients.head,
                coefficients.neck[1],
                HAIR_TAPERING * (after.crown - after.chin),
                coefficients.head_seat,
            )
        });
        field.pieces = bindings
            .pieces
            .iter()
            .map(|piece| {
                let (to, jacobian) = field.blend(piece.anchor, &piece.weights, Attachment::Plain);
                let mut scale = jacobian.determinant().abs().cbrt();
                if piece.lowest >= before.sole && piece.anchor.y > piece.lowest {
                    // What did not reach the ground does not reach below it.
                    scale =
                        scale.min((to.y - after.sole) / (piece.anchor.y - piece.lowest)).max(0.05 * scale);
                }
                Affine { from: piece.anchor, to, linear: DMat3::IDENTITY * scale }
            })
            .collect();
        field
    }

    /// Heights before.
    pub fn before(&self) -> &Heights {
        &self.before
    }

    /// Heights after, before the ground shift.
    pub fn after(&self) -> &Heights {
        &self.after
    }

    /// Moves everything up by `shift`, so that the soles stay where they were.
    pub fn set_ground(&mut self, shift: f64) {
        self.ground = shift;
    }

    /// 0 leaves everything where it is, 1 goes all the way.
    pub fn set_amount(&mut self, amount: f64) {
        self.amount = amount;
    }

    /// See [`PartField::set_amount`].
    pub fn amount(&self) -> f64 {
        self.amount
    }

    /// Changes the face alone; nothing else is done again.
    pub fn set_face(&mut self, face: FaceShape) {
        self.face = face;
    }

    /// Where `p` goes.
    pub fn place(&self, p: DVec3, binding: &PartBinding) -> DVec3 {
        // Everything below is inlined, so that the Jacobian is not made here.
        self.map(p, binding).0
    }

    /// Where `p` goes, and the Jacobian there at fixed binding.
    #[inline(always)]
    pub fn map(&self, p: DVec3, binding: &PartBinding) -> (DVec3, DMat3) {
        let (to, jacobian) = match binding.attachment {
            Attachment::Piece(piece) => (self.pieces[piece].map(p), self.pieces[piece].linear),
            attachment => self.blend(p, &binding.weights, attachment),
        };
        // Written so that amount 0 gives p itself, bit for bit.
        let moved = p + self.amount * (to - p) + DVec3::Y * self.ground;
        (moved, DMat3::IDENTITY + (jacobian - DMat3::IDENTITY) * self.amount)
    }

    #[inline(always)]
    fn blend(&self, p: DVec3, weights: &PartWeights, attachment: Attachment) -> (DVec3, DMat3) {
        let mut to = DVec3::ZERO;
        let mut jacobian = DMat3::ZERO;
        let mut total = 0.0;
        for (part, &weight) in weights.iter().enumerate().filter(|&(_, &weight)| weight > 0.0) {
            let weight = f64::from(weight);
            let (q, j) = self.part(part, p, attachment);
            to += weight * q;
            jacobian += j * weight;
            total += weight;
        }
        (to / total, jacobian * (1.0 / total))
    }

    #[inline(always)]
    fn part(&self, part: usize, p: DVec3, attachment: Attachment) -> (DVec3, DMat3) {
        match part {
            TRUNK => self.trunk(p),
            NECK => self.neck(p),
            HEAD => self.head(p, attachment, false),
            HAIR => self.head(p, attachment, true),
            _ => (self.affine[part].map(p), self.affine[part].linear),
        }
    }

    /// Heights piecewise between the landmarks, x about the middle, z about the centre line, which itself is
    /// flattened: else the curve of the back is exaggerated.
    #[inline(always)]
    fn trunk(&self, p: DVec3) -> (DVec3, DMat3) {
        let [length_scale, thickness_scale] = self.coefficients.trunk;
        let (before, after) = (&self.before, &self.after);
        let (y, slope) = if p.y < before.crotch {
            let slope = (after.crotch - after.sole) / (before.crotch - before.sole);
            (after.sole + slope * (p.y - before.sole), slope)
        } else if p.y < before.shoulder_line {
            (after.crotch + length_scale * (p.y - before.crotch), length_scale)
        } else {
            (after.shoulder_line + self.yoke_slope * (p.y - before.shoulder_line), self.yoke_slope)
        };
        let (centre, centre_slope) = self.anatomy.centre_z(p.y);
        let flattening = length_scale.min(thickness_scale);
        let x = self.anatomy.middle_x + thickness_scale * (p.x - self.anatomy.middle_x);
        let z = self.hip_z + flattening * (centre - self.hip_z) + thickness_scale * (p.z - centre);
        let jacobian = DMat3::from_cols(
            DVec3::new(thickness_scale, 0.0, 0.0),
            DVec3::new(0.0, slope, (flattening - thickness_scale) * centre_slope),
            DVec3::new(0.0, 0.0, thickness_scale),
        );
        (DVec3::new(x, y, z), jacobian)
    }

    #[inline(always)]
    fn neck(&self, p: DVec3) -> (DVec3, DMat3) {
        let [length_scale, thickness_scale] = self.coefficients.neck;
        let length = self.anatomy.proportions.neck;
        let rise = (p.y - self.before.shoulder_line) / length;
        let (back, back_slope) = match rise {
            rise if rise <= 0.0 => (0.0, 0.0),
            rise if rise >= 1.0 => (self.head_back, 0.0),
            rise => (self.head_back * rise, self.head_back / length),
        };
        let to = DVec3::new(
            self.anatomy.middle_x + thickness_scale * (p.x - self.anatomy.middle_x),
            self.after.shoulder_line + length_scale * (p.y - self.before.shoulder_line),
            self.neck_z[1] + thickness_scale * (p.z - self.neck_z[0]) - back,
        );
        let jacobian = DMat3::from_cols(
            DVec3::new(thickness_scale, 0.0, 0.0),
            DVec3::new(0.0, length_scale, -back_slope),
            DVec3::new(0.0, 0.0, thickness_scale),
        );
        (to, jacobian)
    }

    #[inline(always)]
    fn head(&self, p: DVec3, attachment: Attachment, is_hair: bool) -> (DVec3, DMat3) {
        let affine = &self.affine[HEAD];
        let (to, jacobian) = match &self.hair {
            Some(hair) if is_hair && p.y < self.before.chin => hair.map(p),
            _ => (affine.map(p), affine.linear),
        };
        if let Attachment::OnFace(centre) = &attachment {
            return (to + self.shift_on_face(centre), jacobian);
        }
        let (made_younger, face_jacobian) = self.face.map(to);
        (made_younger, face_jacobian * jacobian)
    }

    /// How far the face map moves what stands at `centre` at rest.
    // Not inlined: see `FaceShape::map`.
    #[inline(never)]
    fn shift_on_face(&self, centre: &DVec3) -> DVec3 {
        let centre = self.affine[HEAD].map(*centre);
        self.face.map(centre).0 - centre
    }

    /// The head is scaled about the chin's level on the neck's axis, and moved back over the chest.
    fn place_head(&mut self) {
        let anatomy = &self.anatomy;
        let [height, width, depth] = self.coefficients.head;
        let axis_z = anatomy.head_joint.z;
        let from = DVec3::new(anatomy.middle_x, self.before.chin, axis_z);
        let z = self.neck_z[1] + self.coefficients.neck[1] * (axis_z - self.neck_z[0]);
        let head_centre = z + depth * (anatomy.head_centre.z - axis_z);
        let chest_y = self.before.crotch + CHEST_HEIGHT * (self.before.shoulder_line - self.before.crotch);
        let chest = self.trunk(DVec3::new(anatomy.middle_x, chest_y, anatomy.centre_z(chest_y).0)).0.z;
        let most = HEAD_SEAT_MOST * height * anatomy.proportions.head_length;
        let back = self.coefficients.head_seat * (HEAD_SEAT * (head_centre - chest)).clamp(0.0, most);
        self.head_back = back;
        let to = DVec3::new(anatomy.middle_x, self.after.chin, z - back);
        let linear = DMat3::from_diagonal(DVec3::new(width, height, depth));
        self.affine[HEAD] = Affine { from, to, linear };
    }

    /// Limbs start where the trunk puts their joints; hands and feet keep their shape.
    fn place_limbs(&mut self) {
        for (index, limb) in self.anatomy.limbs.into_iter().enumerate() {
            let is_arm = index < 2;
            let first = if is_arm { 0 } else { 2 };
            let spread =
                if is_arm { self.coefficients.shoulder_spread } else { self.coefficients.hip_spread };
            let mut root = self.trunk(limb.root).0;
            root.x = self.anatomy.middle_x + spread * (limb.root.x - self.anatomy.middle_x);
            let [upper, lower] = [self.coefficients.limbs[first], self.coefficients.limbs[first + 1]];
            let middle = root + upper[0] * (limb.middle - limb.root);
            let mut end = middle + lower[0] * (limb.end - limb.middle);
            let size = if is_arm { self.coefficients.hand } else { self.coefficients.foot };
            if !is_arm {
                // Legs of unequal length still both stand on the ground.
                end.y = self.after.sole + size * (limb.end.y - self.before.sole);
            }
            self.affine[limb.parts[0]] =
                Affine::stretch(limb.root, root, limb.middle - limb.root, upper[0], upper[1]);
            self.affine[limb.parts[1]] =
                Affine::stretch(limb.middle, middle, limb.end - limb.middle, lower[0], lower[1]);
            self.affine[limb.parts[2]] = Affine { from: limb.end, to: end, linear: DMat3::IDENTITY * size };
        }
    }

    /// Where the body's heights go, piecewise between the landmarks: what hair follows.
    fn body_height(&self, y: f64) -> f64 {
        let (b, a) = (&self.before, &self.after);
        let knots =
            [(b.sole, a.sole), (b.crotch, a.crotch), (b.shoulder_line, a.shoulder_line), (b.chin, a.chin)];
        for pair in knots.windows(2) {
            let ((y0, to0), (y1, to1)) = (pair[0], pair[1]);
            if y < y1 || y1 == b.chin {
                return to0 + (to1 - to0) * (y - y0) / (y1 - y0).max(1e-30);
            }
        }
        a.chin
    }
}
