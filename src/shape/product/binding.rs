//! How every vertex and joint is attached to the parts (product mode).

use super::anatomy::Anatomy;
use super::part::{Part, PartWeights, digits};
use super::part_weights::part_weights;
use super::pieces::{Attachment, Piece, PieceSources, Pieces, touching};
use super::profile::chains::{arm_share, skirt_vertices};
use crate::character::{MeshKind, Role, Skeleton};
use crate::error::Result;
use crate::face::face_landmarks::FaceLandmarks;
use crate::face::stage::FaceBinding;
use crate::geometry::{Weld, components, smoothstep};
use crate::progress::Progress;
use crate::shape::figure::Figure;
use glam::DVec3;

/// How one point is attached to the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartBinding {
    /// Weights of the parts; they sum to 1.
    pub weights: PartWeights,
    /// Besides the weights.
    pub attachment: Attachment,
    /// How it takes part in the face step.
    pub face: FaceBinding,
    /// What the legs move of it follows the torso, as skirts do.
    pub is_skirt: bool,
}

impl PartBinding {
    /// Moved by one part alone.
    pub fn to(part: Part) -> Self {
        let face = match part {
            Part::Head => FaceBinding::Skin(1.0),
            Part::Hair => FaceBinding::Hair(1.0),
            _ => FaceBinding::None,
        };
        Self { weights: part.alone(), attachment: Attachment::Plain, face, is_skirt: false }
    }

    /// How much of the face map it takes, 0 to 1; what keeps its shape takes that of its middle, which is at rest there.
    pub fn of_face(&self) -> (f64, Option<DVec3>) {
        let share = f64::from(self.weights[Part::Head as usize] + self.weights[Part::Hair as usize]);
        match self.attachment {
            Attachment::Plain | Attachment::Digits(_) => (share, None),
            Attachment::OnFace(middle) => (share, Some(middle)),
            Attachment::Piece(_) | Attachment::Strand { .. } | Attachment::OnBone => (0.0, None),
        }
    }

    /// True for what the body carries from where it is at rest, and nothing else does.
    pub fn is_plain(&self) -> bool {
        matches!(self.attachment, Attachment::Plain | Attachment::OnFace(_))
    }

    /// True for what goes where it went before these changes of parts, as [`PartField::changes`] gives them; false where that is
    /// not known.
    ///
    /// [`PartField::changes`]: super::parts_field::PartField::changes
    pub fn stays(&self, changes: &PartWeights) -> bool {
        let changed = changes.iter().zip(&self.weights).map(|(change, weight)| change * weight != 0.0);
        // To look at all of them is sooner than to stop at one.
        !changed.fold(false, |any, changed| any | changed)
            && !matches!(self.attachment, Attachment::Piece(_) | Attachment::Strand { .. })
    }

    /// True for what follows the bones of an arm.
    pub fn is_on_bone(&self) -> bool {
        self.attachment == Attachment::OnBone
    }

    /// What goes as one and it is of, by kind and number: a piece on the body, a thing on the head, an eyeball, an arm's bones.
    pub fn goes_with(&self) -> Option<(u8, u32)> {
        match (self.attachment, self.face) {
            (Attachment::Piece(piece), _) => Some((0, piece as u32)),
            (Attachment::OnBone, _) => Some((3, u32::from(arm_share(&self.weights, 1) > 0.0))),
            (_, FaceBinding::Piece(thing)) => Some((1, thing)),
            (_, FaceBinding::Ball(side)) => Some((2, u32::from(side))),
            _ => None,
        }
    }

    /// How far it goes where head and neck go, 0 to 1; what is carried on the body does not.
    pub fn of_head_and_neck(&self) -> f64 {
        let with_piece = match self.attachment {
            Attachment::Piece(_) => return 0.0,
            Attachment::Strand { share, .. } => f64::from(share),
            Attachment::Plain | Attachment::OnFace(_) | Attachment::OnBone | Attachment::Digits(_) => 0.0,
        };
        let parts = [Part::Head, Part::Neck, Part::Hair];
        (1.0 - with_piece)
            * smoothstep(parts.iter().map(|&part| f64::from(self.weights[part as usize])).sum())
    }
}

/// The bindings of all vertices of a figure.
#[derive(Clone, Debug, Default)]
pub struct PartBindings {
    /// One for each vertex.
    pub vertices: Vec<PartBinding>,
    /// The pieces that [`Attachment::Piece`] speaks of.
    pub pieces: Vec<Piece>,
    /// For each joint the piece it belongs to.
    pub joint_pieces: Vec<Option<usize>>,
    /// The vertices of each thing that [`FaceBinding::Piece`] speaks of.
    pub things: Vec<Vec<u32>>,
    /// True where eye joints turn the eyes: then they are the eyeballs' own.
    pub eye_turns: bool,
    /// From the chin down to the lowest hair; 0 where none hangs.
    pub hair_depth: f64,
}

/// Binds every vertex of `figure` to its parts.
///
/// - `face`: what of it was found; eyeballs move as such.
/// - `weld`: the figure's vertices by position.
/// - `threads`: at most this many, 0 for all cores; the result does not depend on it.
///
/// # Errors
/// `Cancelled`.
///
/// O(vertices · log vertices).
pub fn part_bindings(
    figure: &Figure,
    anatomy: &Anatomy,
    face: Option<&FaceLandmarks>,
    skeleton: &Skeleton,
    weld: &Weld,
    threads: usize,
    progress: &mut Progress,
) -> Result<PartBindings> {
    let members = members_of_components(figure, weld);
    let part = &mut progress.part(0.05, 0.8);
    let (weights, head_only) = part_weights(figure, anatomy, weld, &members, threads, part)?;
    let sources = PieceSources {
        figure,
        anatomy,
        skeleton,
        weld,
        members: &members,
        head_only: &head_only,
        weights: &weights,
    };
    let Pieces { mut attachments, pieces, of_joints } = Pieces::of(&sources);
    let digits: Vec<Option<usize>> = Role::all().map(digit_of).collect();
    for ((attachment, row), weights) in attachments.iter_mut().zip(&figure.role_weights).zip(&weights) {
        let mut shares = [0.0; 5];
        for &(role, weight) in row {
            if let Some(digit) = digits[role as usize] {
                shares[digit] += weight as f32;
            }
        }
        let of_arms = arm_share(weights, 0) + arm_share(weights, 1);
        if *attachment == Attachment::Plain && shares != [0.0; 5] && of_arms > 0.0 {
            *attachment = Attachment::Digits(shares);
        }
    }
    let hair_depth = (0..figure.positions.len())
        .filter(|&vertex| weights[vertex][Part::Hair as usize] > 0.5)
        .map(|vertex| anatomy.landmarks.heights.chin - figure.positions[vertex].y)
        .fold(0.0, f64::max);
    let eye_turns = face.is_some_and(FaceLandmarks::eyes_turn);
    let (face, things) = face_bindings(figure, face, &weights, &attachments, &members);
    let is_skirt = skirt_vertices(figure, anatomy, weld);
    let bind =
        |(((weights, attachment), face), is_skirt)| PartBinding { weights, attachment, face, is_skirt };
    let vertices = weights.into_iter().zip(attachments).zip(face).zip(is_skirt).map(bind).collect();
    progress.at(1.0)?;
    Ok(PartBindings { vertices, pieces, joint_pieces: of_joints, things, eye_turns, hair_depth })
}

/// How each vertex takes part in the face step: with the skin or the hair as far as the head moves it, as an eyeball, or
/// with a thing that keeps its shape; and the vertices of each such thing: what is worn on the head.
fn face_bindings(
    figure: &Figure,
    face: Option<&FaceLandmarks>,
    weights: &[PartWeights],
    attachments: &[Attachment],
    members: &[Vec<u32>],
) -> (Vec<FaceBinding>, Vec<Vec<u32>>) {
    let bind = |vertex: usize| {
        let of_head = weights[vertex][Part::Head as usize] + weights[vertex][Part::Hair as usize];
        let share = smoothstep(f64::from(of_head)) as f32;
        match (attachments[vertex], figure.kind(vertex)) {
            _ if share == 0.0 => FaceBinding::None,
            (Attachment::Plain | Attachment::Digits(_), MeshKind::Hair) => FaceBinding::Hair(share),
            (Attachment::Plain | Attachment::Digits(_), _) => FaceBinding::Skin(share),
            _ => FaceBinding::None,
        }
    };
    let mut bindings: Vec<FaceBinding> = (0..weights.len()).map(bind).collect();
    let things = things_on_head(figure, members, attachments);
    for (thing, vertices) in (0..).zip(&things) {
        vertices.iter().for_each(|&vertex| bindings[vertex as usize] = FaceBinding::Piece(thing));
    }
    let eyes = face.and_then(|face| face.eyes.as_ref());
    for (side, eye) in eyes.iter().flat_map(|(_, eyes)| eyes.iter().enumerate()) {
        for &vertex in eye.ball.iter().flat_map(|ball| &ball.vertices) {
            bindings[vertex as usize] = FaceBinding::Ball(side as u8);
        }
    }
    (bindings, things)
}

/// Boxes nearer to each other than this share of H are of one thing: lenses in their frame.
const ONE_THING: f64 = 0.003;

/// Hats, glasses, earrings: components that take the face map as a whole, together where they touch.
fn things_on_head(figure: &Figure, members: &[Vec<u32>], attachments: &[Attachment]) -> Vec<Vec<u32>> {
    let is_thing = |members: &&Vec<u32>| matches!(attachments[members[0] as usize], Attachment::OnFace(_));
    let components: Vec<&Vec<u32>> = members.iter().filter(is_thing).collect();
    touching(figure, &components, ONE_THING, |_, _| true)
}

/// Which finger the bone of `role` is one of, thumb first.
fn digit_of(role: Role) -> Option<usize> {
    // To list a hand's roles takes longer than to see that one is of no hand.
    let is_of_hand = matches!(Part::of(role), Part::LeftHand | Part::RightHand);
    let digits = is_of_hand.then(|| digits(role.is_left()))?;
    digits.iter().position(|digit| digit.contains(&role))
}

/// The vertices of each connected component.
fn members_of_components(figure: &Figure, weld: &Weld) -> Vec<Vec<u32>> {
    let component = components(&figure.triangles, weld);
    let count = component.iter().max().map_or(0, |&last| last as usize + 1);
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (vertex, &welded) in weld.representative.iter().enumerate() {
        members[component[welded as usize] as usize].push(vertex as u32);
    }
    members
}

/// How a joint that plays no role of its own is attached: by the part it folds into, as hair where it hangs from the
/// head, with its piece where it has one.
pub fn joint_binding(figure: &Figure, bindings: &PartBindings, joint: usize) -> PartBinding {
    let role = figure.joint_roles[joint].unwrap_or(Role::Hips);
    let mut binding = PartBinding::to(Part::of(role));
    let own = |side: Role| figure.humanoid.joint(side) == Some(joint);
    if let Some(side) = figure.eye_roles().into_iter().position(own)
        && bindings.eye_turns
    {
        binding.face = FaceBinding::Ball(side as u8);
    }
    if let Some(piece) = bindings.joint_pieces[joint] {
        binding.attachment = Attachment::Piece(piece);
    } else if let Some(digit) = digit_of(role) {
        binding.attachment = Attachment::Digits([0, 1, 2, 3, 4].map(|of| f32::from(of == digit)));
    } else if role == Role::Head && figure.humanoid.joint(role) != Some(joint) {
        binding = PartBinding::to(Part::Hair);
    }
    binding
}
