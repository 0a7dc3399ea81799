//! What keeps its shape: hats, bags, buttons move and scale as one (product mode).

use super::anatomy::{Anatomy, Limb};
use super::part::{PART_COUNT, Part, PartWeights, add};
use super::strand;
use crate::character::{MeshKind, Role, Skeleton};
use crate::geometry::{Bounds, PointTree, Weld, bounds, clusters, foot, marked, neighbours, outer};
use crate::shape::figure::Figure;
use glam::{DMat3, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Loose pieces smaller than this share of H keep their shape: buttons, buckles, badges. D26. Seen: without, 33 more
/// triangles turn over, in a mannequin's plates.
const SMALL_PIECE: f64 = 0.04;
/// Boxes closer than this share of H touch. D26. Seen: ±30 % moves a machine arm by .005 H.
const TOUCHING: f64 = 0.005;
/// A vertex with this much weight to one joint counts as rigid. D26. Seen: without the rule a machine arm is squashed,
/// moved by up to .30 H.
const RIGID_WEIGHT: f64 = 0.99;

/// How a point takes part in the deformation, besides its weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Attachment {
    /// By its weights alone.
    #[default]
    Plain,
    /// A joint of an arm: it follows the bones, not the slices around them.
    OnBone,
    /// So much of a thumb, 0 to 1, which becomes as short as the hand.
    Thumb(f32),
    /// A hat or glasses: takes the face map of this point as a whole.
    OnFace(DVec3),
    /// Moves with piece number so-and-so, which keeps its shape.
    Piece(usize),
    /// Leads from the body, which moves it by its weights, to a piece.
    Strand {
        /// The piece.
        piece: usize,
        /// How far it goes with the piece, 0 to 1.
        share: f32,
    },
}

/// A piece that keeps its shape: it is moved and scaled as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The point that the body carries along.
    pub anchor: DVec3,
    /// The height of its lowest vertex.
    pub lowest: f64,
    /// The covariance of its vertices.
    pub spread: DMat3,
    /// The parts that move the anchor.
    pub weights: PartWeights,
}

impl Piece {
    /// What `members` make up, one vertex at each place, for how often seams repeat one must not matter; held at `anchor`.
    fn of(figure: &Figure, members: &[u32], anchor: DVec3, weights: PartWeights) -> Self {
        let places = || members.iter().map(|&vertex| figure.positions[vertex as usize]);
        let middle = places().sum::<DVec3>() / members.len() as f64;
        let spread = places().map(|p| outer(p - middle, p - middle)).fold(DMat3::ZERO, |sum, one| sum + one);
        let lowest = places().map(|p| p.y).fold(f64::INFINITY, f64::min);
        Self { anchor, lowest, spread: spread * (1.0 / members.len() as f64), weights }
    }
}

/// The pieces of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// One for each vertex.
    pub attachments: Vec<Attachment>,
    /// The pieces that [`Attachment::Piece`] speaks of.
    pub pieces: Vec<Piece>,
    /// For each joint the piece it belongs to.
    pub of_joints: Vec<Option<usize>>,
}

impl Pieces {
    /// Finds the pieces of `figure`.
    ///
    /// - `members`: the vertices of each connected component. `head_only`: whether the head alone moves a vertex.
    /// - `weights`: each vertex's weights to the parts.
    pub fn of(
        figure: &Figure,
        anatomy: &Anatomy,
        skeleton: &Skeleton,
        weld: &Weld,
        members: &[Vec<u32>],
        head_only: &[bool],
        weights: &[PartWeights],
    ) -> Self {
        let mut pieces = Self {
            attachments: vec![Attachment::Plain; figure.positions.len()],
            pieces: Vec::new(),
            of_joints: Vec::new(),
        };
        pieces.add_hats(figure, members, head_only);
        pieces.add_carried(figure, skeleton, weld, members, head_only);
        pieces.add_rigid(figure, anatomy, weld, members, head_only, weights);
        pieces.add_small(figure, weld, members, head_only, weights);
        pieces
    }

    /// Makes one piece of `members`.
    fn add(&mut self, members: &[u32], piece: Piece) {
        for &vertex in members {
            self.attachments[vertex as usize] = Attachment::Piece(self.pieces.len());
        }
        self.pieces.push(piece);
    }

    fn is_plain(&self, vertex: u32) -> bool {
        self.attachments[vertex as usize] == Attachment::Plain
    }

    /// Hats and glasses take the face map as a whole.
    fn add_hats(&mut self, figure: &Figure, members: &[Vec<u32>], head_only: &[bool]) {
        for members in members {
            if !members.iter().all(|&vertex| head_only[vertex as usize]) {
                continue;
            }
            let (low, high) = bounds(members.iter().map(|&vertex| figure.positions[vertex as usize]));
            for &vertex in members {
                if figure.kind(vertex as usize) == MeshKind::Accessory {
                    self.attachments[vertex as usize] = Attachment::OnFace((low + high) / 2.0);
                }
            }
        }
    }

    /// Things carried on the body (a bag, a machine arm, a tail of plates): what hangs from one joint without a role and is
    /// made of rigid components for the greater part keeps its shape as one.
    fn add_carried(
        &mut self,
        figure: &Figure,
        skeleton: &Skeleton,
        weld: &Weld,
        members: &[Vec<u32>],
        head_only: &[bool],
    ) {
        let joint_count = figure.joints.len();
        let top = uppermost_without_role(figure, skeleton);
        let main = |vertex: u32| figure.main_joint[vertex as usize].map(|joint| joint as usize);
        let mut rigid_count = vec![0usize; joint_count];
        let mut whole_count = vec![0usize; joint_count];
        let mut carried: Vec<Vec<u32>> = vec![Vec::new(); joint_count];
        for members in members.iter().filter(|members| !members.is_empty()) {
            let first = main(members[0]);
            let rigid = members
                .iter()
                .all(|&vertex| main(vertex) == first && figure.main_weight[vertex as usize] > RIGID_WEIGHT);
            let top_of = |vertex: u32| main(vertex).and_then(|joint| top[joint]);
            let first_top = top_of(members[0]);
            for &vertex in members {
                if let Some(top) = top_of(vertex) {
                    whole_count[top] += 1;
                    rigid_count[top] += usize::from(rigid);
                }
            }
            // What goes over into the body may be a strand.
            if let Some(first_top) = first_top
                && members
                    .iter()
                    .all(|&vertex| top_of(vertex) == Some(first_top) && !head_only[vertex as usize])
            {
                carried[first_top].extend(members);
            }
        }
        let mut piece_of_top = vec![None; joint_count];
        for joint in 0..joint_count {
            if carried[joint].is_empty() || 2 * rigid_count[joint] < whole_count[joint] {
                continue;
            }
            // The body carries the piece at its own joint; the part it folds into moves that point.
            let role = figure.joint_roles[joint].unwrap_or(Role::Hips);
            piece_of_top[joint] = Some(self.pieces.len());
            let places = once(weld, &carried[joint]);
            let piece = Piece::of(figure, &places, figure.joints[joint], Part::of(role).alone());
            self.add(&carried[joint], piece);
        }
        self.of_joints = top.iter().map(|top| top.and_then(|top| piece_of_top[top])).collect();
        let piece_of = |vertex: u32| main(vertex).and_then(|joint| self.of_joints[joint]);
        let strands =
            strands(members, &piece_of, |vertex| head_only[vertex as usize] || !self.is_plain(vertex));
        if strands.is_empty() {
            return;
        }
        let neighbours = neighbours(&figure.triangles, weld);
        for (piece, members) in strands {
            let of_body = |vertex: u32| piece_of(vertex) != Some(piece);
            let shares = strand::shares(figure, weld, &neighbours, members, of_body);
            for (&vertex, share) in members.iter().zip(shares) {
                self.attachments[vertex as usize] = Attachment::Strand { piece, share };
            }
        }
    }

    /// Bags, swords, plates that hang rigidly from the body: components whose boxes touch and whose weights are the same keep
    /// their shape as one, held where they are nearest to the body.
    fn add_rigid(
        &mut self,
        figure: &Figure,
        anatomy: &Anatomy,
        weld: &Weld,
        members: &[Vec<u32>],
        head_only: &[bool],
        weights: &[PartWeights],
    ) {
        let things = self.rigid(figure, anatomy, members, head_only);
        if things.is_empty() {
            return;
        }
        let mut is_of_body: Vec<bool> =
            (0..figure.positions.len()).map(|vertex| figure.kind(vertex) != MeshKind::Accessory).collect();
        things.iter().flatten().for_each(|&vertex| is_of_body[vertex as usize] = false);
        let body: Vec<DVec3> = figure
            .positions
            .iter()
            .zip(is_of_body)
            .filter(|(_, is_of_body)| *is_of_body)
            .map(|(&p, _)| p)
            .collect();
        let tree = PointTree::new(&body);
        let mut near = Vec::new();
        let place = |vertex: u32| figure.positions[vertex as usize];
        for all in things {
            let whole = once(weld, &all);
            let distances: Vec<f64> = whole
                .iter()
                .map(|&vertex| {
                    tree.nearest(place(vertex), 1, f64::INFINITY, &mut near);
                    near.first().map_or(0.0, |near| near.distance())
                })
                .collect();
            let least = distances.iter().copied().fold(f64::INFINITY, f64::min) + TOUCHING * figure.height();
            let held: Vec<u32> = whole
                .iter()
                .zip(&distances)
                .filter(|&(_, &distance)| distance <= least)
                .map(|(&vertex, _)| vertex)
                .collect();
            let anchor = held.iter().map(|&vertex| place(vertex)).sum::<DVec3>() / held.len() as f64;
            let piece = Piece::of(figure, &whole, anchor, mean_weights(weights, &held));
            self.add(&all, piece);
        }
    }

    /// The vertices of each thing that is made of rigid components which touch and weigh the same: of accessories, and of what
    /// lies beside the bones of a body that bends.
    fn rigid(
        &self,
        figure: &Figure,
        anatomy: &Anatomy,
        members: &[Vec<u32>],
        head_only: &[bool],
    ) -> Vec<Vec<u32>> {
        let is_loose = |vertex: u32| !head_only[vertex as usize] && self.is_plain(vertex);
        let row = |vertex: u32| &figure.role_weights[vertex as usize];
        let is_rigid = |members: &[u32]| members.iter().all(|&vertex| row(vertex) == row(members[0]));
        let all_of = |members: &[u32], kind: MeshKind| {
            members.iter().all(|&vertex| figure.kind(vertex as usize) == kind)
        };
        let bends = members.iter().max_by_key(|members| members.len()).is_some_and(|most| !is_rigid(most));
        let is_thing = |members: &&Vec<u32>| {
            members.len() >= 3
                && members.iter().all(|&vertex| is_loose(vertex))
                && is_rigid(members)
                && (all_of(members, MeshKind::Accessory)
                    || bends
                        && all_of(members, MeshKind::Body)
                        && lies_beside_bones(figure, anatomy, members))
        };
        let components: Vec<&Vec<u32>> = members.iter().filter(is_thing).collect();
        let is_alike = |one: usize, other: usize| row(components[one][0]) == row(components[other][0]);
        touching(figure, &components, TOUCHING, is_alike)
    }

    /// Buttons, buckles, badges: small loose components keep their shape.
    fn add_small(
        &mut self,
        figure: &Figure,
        weld: &Weld,
        members: &[Vec<u32>],
        head_only: &[bool],
        weights: &[PartWeights],
    ) {
        let limit = SMALL_PIECE * figure.height();
        for members in members.iter().filter(|members| members.len() >= 3) {
            if members.iter().any(|&vertex| head_only[vertex as usize] || !self.is_plain(vertex)) {
                continue;
            }
            let (low, high) = bounds(members.iter().map(|&vertex| figure.positions[vertex as usize]));
            if (high - low).max_element() > limit {
                continue;
            }
            let places = once(weld, members);
            let piece = Piece::of(figure, &places, (low + high) / 2.0, mean_weights(weights, &places));
            self.add(members, piece);
        }
    }
}

/// What `components` make up together where their boxes, each made larger by `margin`, a share of H, touch and `joins` accepts
/// the two: the vertices of each.
pub(super) fn touching(
    figure: &Figure,
    components: &[&Vec<u32>],
    margin: f64,
    joins: impl Fn(usize, usize) -> bool,
) -> Vec<Vec<u32>> {
    let margin = DVec3::splat(margin * figure.height());
    let boxes: Vec<Bounds> = components
        .iter()
        .map(|members| bounds(members.iter().map(|&vertex| figure.positions[vertex as usize])))
        .map(|(low, high)| (low - margin, high + margin))
        .collect();
    let mut things: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for (members, least) in components.iter().zip(clusters(&boxes, joins)) {
        things.entry(least).or_default().extend(*members);
    }
    things.into_values().collect()
}

/// True for what trunk or limbs move and their bones do not pass.
fn lies_beside_bones(figure: &Figure, anatomy: &Anatomy, members: &[u32]) -> bool {
    let joint = figure.main_joint[members[0] as usize];
    let Some(role) = joint.and_then(|joint| figure.joint_roles[joint as usize]) else { return false };
    let (low, high) = bounds(members.iter().map(|&vertex| figure.positions[vertex as usize]));
    let middle = (low + high) / 2.0;
    let part = Part::of(role) as usize;
    let on_bone = |limb: &Limb| match limb.parts.iter().position(|&of_limb| of_limb == part) {
        Some(0) => Some(foot(middle, limb.root, limb.middle).0),
        Some(1) => Some(foot(middle, limb.middle, limb.end).0),
        _ => None,
    };
    let near = match Part::of(role) {
        Part::Torso => Some(DVec3::new(anatomy.middle_x, middle.y, anatomy.centre_z(middle.y).0)),
        _ => anatomy.limbs.iter().find_map(on_bone),
    };
    near.is_some_and(|near| near.clamp(low, high) != near)
}

/// Components that lead from the body to a piece, with the piece: most of their vertices are moved by the piece's joints, and
/// not all. A strap that the body holds for the greater part stays with the body.
fn strands<'a>(
    members: &'a [Vec<u32>],
    piece_of: &impl Fn(u32) -> Option<usize>,
    is_taken: impl Fn(u32) -> bool,
) -> Vec<(usize, &'a Vec<u32>)> {
    let mut found = Vec::new();
    for members in members {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for piece in members.iter().filter_map(|&vertex| piece_of(vertex)) {
            *counts.entry(piece).or_default() += 1;
        }
        let most = counts.into_iter().max_by_key(|&(piece, count)| (count, std::cmp::Reverse(piece)));
        if let Some((piece, count)) = most
            && 2 * count > members.len()
            && count < members.len()
            && !members.iter().any(|&vertex| is_taken(vertex))
        {
            found.push((piece, members));
        }
    }
    found
}

/// For each joint the uppermost joint without a role that it hangs from, below a joint that has one.
fn uppermost_without_role(figure: &Figure, skeleton: &Skeleton) -> Vec<Option<usize>> {
    let joint_count = figure.joints.len();
    let has_role = marked(joint_count, figure.humanoid.iter().map(|(_, joint)| joint));
    (0..joint_count)
        .map(|joint| {
            if has_role[joint] || figure.joint_roles[joint].is_none() {
                return None;
            }
            skeleton.ancestors(joint).take_while(|&above| !has_role[above]).last()
        })
        .collect()
}

/// The first of `vertices` at each of their places, in their order.
pub(super) fn once(weld: &Weld, vertices: &[u32]) -> Vec<u32> {
    let mut seen = BTreeSet::new();
    vertices.iter().copied().filter(|&vertex| seen.insert(weld.representative[vertex as usize])).collect()
}

fn mean_weights(weights: &[PartWeights], members: &[u32]) -> PartWeights {
    let mut mean = [0.0; PART_COUNT];
    for &vertex in members {
        add(&mut mean, &weights[vertex as usize], 1.0 / members.len() as f32);
    }
    mean
}
