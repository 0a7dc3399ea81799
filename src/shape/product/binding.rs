//! How every vertex and joint is attached to the parts (product mode).

use super::anatomy::Anatomy;
use super::hair::HairOutline;
use super::part::{Part, PartWeights};
use super::pieces::{Attachment, Piece, Pieces};
use super::weights::part_weights;
use crate::character::{Role, Skeleton};
use crate::geometry::{Weld, components};
use crate::shape::figure::Figure;
use glam::DVec3;

/// How one point is attached to the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartBinding {
    /// Weights of the parts; they sum to 1.
    pub weights: PartWeights,
    /// Besides the weights.
    pub attachment: Attachment,
}

impl PartBinding {
    /// Moved by one part alone.
    pub fn to(part: Part) -> Self {
        Self { weights: part.alone(), attachment: Attachment::Plain }
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
    /// The outline of the hair below the chin, where there is some.
    pub hair: Option<HairOutline>,
}

/// Binds every vertex of `figure` to its parts.
///
/// - `weld`: the figure's vertices by position.
/// - `threads`: at most this many, 0 for all cores; the result does not depend on it.
///
/// O(vertices · log vertices).
pub fn part_bindings(
    figure: &Figure,
    anatomy: &Anatomy,
    skeleton: &Skeleton,
    weld: &Weld,
    threads: usize,
) -> PartBindings {
    let members = members_of_components(figure, weld);
    let (weights, head_only) = part_weights(figure, anatomy, weld, &members, threads);
    let Pieces { attachments, pieces, of_joints } =
        Pieces::of(figure, skeleton, &members, &head_only, &weights);
    let hair = HairOutline::of(
        (0..figure.positions.len())
            .filter(|&vertex| weights[vertex][Part::Hair as usize] > 0.5)
            .map(|vertex| figure.positions[vertex]),
        DVec3::new(anatomy.middle_x, anatomy.landmarks.heights.chin, anatomy.head_joint.z),
    );
    let bind = |(weights, attachment)| PartBinding { weights, attachment };
    let vertices = weights.into_iter().zip(attachments).map(bind).collect();
    PartBindings { vertices, pieces, joint_pieces: of_joints, hair }
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
    if let Some(piece) = bindings.joint_pieces[joint] {
        binding.attachment = Attachment::Piece(piece);
    } else if role == Role::Head && figure.humanoid.joint(role) != Some(joint) {
        binding = PartBinding::to(Part::Hair);
    }
    binding
}
