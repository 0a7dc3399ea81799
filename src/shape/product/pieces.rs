//! What keeps its shape: hats, bags, buttons move and scale as one (product mode).

use super::anatomy::{Anatomy, Limb};
use super::joint_bindings::limb_bone;
use super::part::{PART_COUNT, Part, PartWeights, add};
use super::strand;
use crate::character::{MeshKind, Role, Skeleton};
use crate::geometry::{Bounds, PointTree, Weld, bounds, clusters, foot, marked, neighbours, range};
use crate::shape::figure::Figure;
use glam::DVec3;
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attachment {
    /// By its weights alone.
    Plain,
    /// A joint of an arm: it follows the bones, not the slices around them.
    OnBone,
    /// So much of each finger, thumb first, 0 to 1, which a stubby hand makes parts of a mitt.
    Digits([f32; 5]),
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
    /// The parts that move the anchor.
    pub weights: PartWeights,
}

/// The pieces of a figure.
pub struct Pieces {
    /// One for each vertex.
    pub attachments: Vec<Attachment>,
    /// The pieces that [`Attachment::Piece`] speaks of.
    pub pieces: Vec<Piece>,
    /// For each joint the piece it belongs to.
    pub of_joints: Vec<Option<usize>>,
}

/// What the pieces of a figure are found by.
pub struct PieceSources<'a> {
    /// The figure.
    pub figure: &'a Figure,
    /// What was measured of it.
    pub anatomy: &'a Anatomy,
    /// How its joints hang from each other.
    pub skeleton: &'a Skeleton,
    /// Its vertices by position.
    pub weld: &'a Weld,
    /// The vertices of each connected component.
    pub members: &'a [Vec<u32>],
    /// Whether the head alone moves a vertex.
    pub head_only: &'a [bool],
    /// Each vertex's weights to the parts.
    pub weights: &'a [PartWeights],
}

impl PieceSources<'_> {
    /// The least box around `members`.
    fn bounds(&self, members: &[u32]) -> Bounds {
        bounds(members.iter().map(|&vertex| self.figure.positions[vertex as usize]))
    }

    /// True for what trunk or limbs move and their bones do not pass.
    fn lies_beside_bones(&self, members: &[u32]) -> bool {
        let Self { figure, anatomy, .. } = self;
        let joint = figure.main_joint[members[0] as usize];
        let Some(role) = joint.and_then(|joint| figure.joint_roles[joint as usize]) else { return false };
        let (low, high) = self.bounds(members);
        let middle = (low + high) / 2.0;
        let part = Part::of(role);
        let on_bone = |limb: &Limb| match limb.parts.iter().position(|&of_limb| of_limb == part as usize) {
            Some(0) => Some(foot(middle, limb.root, limb.middle).0),
            Some(1) => Some(foot(middle, limb.middle, limb.end).0),
            _ => None,
        };
        let near = match part {
            Part::Torso => Some(DVec3::new(anatomy.middle_x, middle.y, anatomy.centre_z(middle.y).0)),
            _ => anatomy.limbs.iter().find_map(on_bone),
        };
        near.is_some_and(|near| near.clamp(low, high) != near)
    }
}

impl Pieces {
    /// Finds the pieces of a figure by `sources`.
    pub fn of(sources: &PieceSources) -> Self {
        let attachments = vec![Attachment::Plain; sources.figure.positions.len()];
        let mut pieces = Self { attachments, pieces: Vec::new(), of_joints: Vec::new() };
        pieces.add_hats(sources);
        pieces.add_carried(sources);
        pieces.add_rigid(sources);
        pieces.add_small(sources);
        pieces
    }

    /// Makes one piece of `members`, held at `anchor`, which the parts move by `weights`.
    fn add(&mut self, figure: &Figure, members: &[u32], anchor: DVec3, weights: PartWeights) {
        let (lowest, _) = range(members.iter().map(|&vertex| figure.positions[vertex as usize].y));
        let piece = Piece { anchor, lowest, weights };
        for &vertex in members {
            self.attachments[vertex as usize] = Attachment::Piece(self.pieces.len());
        }
        self.pieces.push(piece);
    }

    /// True for what the head does not move alone and is no other piece.
    fn is_loose(&self, sources: &PieceSources, vertex: u32) -> bool {
        !sources.head_only[vertex as usize] && self.attachments[vertex as usize] == Attachment::Plain
    }

    /// Hats and glasses take the face map as a whole.
    fn add_hats(&mut self, sources: &PieceSources) {
        let &PieceSources { figure, members, head_only, .. } = sources;
        let is_of_head = |members: &&Vec<u32>| members.iter().all(|&vertex| head_only[vertex as usize]);
        for members in members.iter().filter(is_of_head) {
            let (low, high) = sources.bounds(members);
            for &vertex in members {
                if figure.kind(vertex as usize) == MeshKind::Accessory {
                    self.attachments[vertex as usize] = Attachment::OnFace((low + high) / 2.0);
                }
            }
        }
    }

    /// Things carried on the body (a bag, a machine arm, a tail of plates): what hangs from one joint without a role and is
    /// made of rigid components for the greater part keeps its shape as one.
    fn add_carried(&mut self, sources: &PieceSources) {
        let &PieceSources { figure, skeleton, weld, members, head_only, .. } = sources;
        let joint_count = figure.joints.len();
        let top = uppermost_without_role(figure, skeleton);
        let main = |vertex: u32| figure.main_joint[vertex as usize].map(|joint| joint as usize);
        // How many more of the vertices that hang from each are of rigid components than are not.
        let mut rigid_majority = vec![0i64; joint_count];
        let mut carried: Vec<Vec<u32>> = vec![Vec::new(); joint_count];
        for members in members {
            let first = main(members[0]);
            let rigid = members
                .iter()
                .all(|&vertex| main(vertex) == first && figure.main_weight[vertex as usize] > RIGID_WEIGHT);
            let top_of = |vertex: u32| main(vertex).and_then(|joint| top[joint]);
            for top in members.iter().filter_map(|&vertex| top_of(vertex)) {
                rigid_majority[top] += if rigid { 1 } else { -1 };
            }
            // What goes over into the body may be a strand.
            let first_top = top_of(members[0]);
            let is_whole = |&vertex: &u32| top_of(vertex) == first_top && !head_only[vertex as usize];
            if let Some(first_top) = first_top.filter(|_| members.iter().all(is_whole)) {
                carried[first_top].extend(members);
            }
        }
        let mut piece_of_top = vec![None; joint_count];
        for joint in 0..joint_count {
            if carried[joint].is_empty() || rigid_majority[joint] < 0 {
                continue;
            }
            // The body carries the piece at its own joint; the part it folds into moves that point.
            let role = figure.joint_roles[joint].unwrap_or(Role::Hips);
            piece_of_top[joint] = Some(self.pieces.len());
            self.add(figure, &carried[joint], figure.joints[joint], Part::of(role).alone());
        }
        self.of_joints = top.iter().map(|top| top.and_then(|top| piece_of_top[top])).collect();
        let piece_of = |vertex: u32| main(vertex).and_then(|joint| self.of_joints[joint]);
        let strands = strands(members, &piece_of, |vertex| self.is_loose(sources, vertex));
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
    fn add_rigid(&mut self, sources: &PieceSources) {
        let figure = sources.figure;
        let things = self.rigid(sources);
        if things.is_empty() {
            return;
        }
        let count = figure.positions.len();
        let is_of_thing = marked(count, things.iter().flatten().map(|&vertex| vertex as usize));
        let is_of_body = |&vertex: &usize| !is_of_thing[vertex] && figure.kind(vertex) != MeshKind::Accessory;
        let body: Vec<DVec3> = (0..count).filter(is_of_body).map(|vertex| figure.positions[vertex]).collect();
        let tree = PointTree::new(&body);
        let mut near = Vec::new();
        let place = |vertex: u32| figure.positions[vertex as usize];
        for all in things {
            let places = once(sources.weld, &all);
            let mut distance = |vertex: u32| {
                tree.nearest(place(vertex), 1, f64::INFINITY, &mut near);
                near.first().map_or(0.0, |near| near.distance())
            };
            let away: Vec<(u32, f64)> = places.iter().map(|&vertex| (vertex, distance(vertex))).collect();
            let (least, _) = range(away.iter().map(|&(_, distance)| distance));
            let is_held = |&&(_, distance): &&(u32, f64)| distance <= least + TOUCHING * figure.height();
            let held: Vec<u32> = away.iter().filter(is_held).map(|&(vertex, _)| vertex).collect();
            let anchor = held.iter().map(|&vertex| place(vertex)).sum::<DVec3>() / held.len() as f64;
            self.add(figure, &all, anchor, mean_weights(sources.weights, &held));
        }
    }

    /// The vertices of each thing that is made of rigid components which touch and weigh the same: of accessories, and of what
    /// lies beside the bones of a body that bends.
    fn rigid(&self, sources: &PieceSources) -> Vec<Vec<u32>> {
        let &PieceSources { figure, members, .. } = sources;
        let row = |vertex: u32| &figure.role_weights[vertex as usize];
        let is_rigid = |members: &[u32]| members.iter().all(|&vertex| row(vertex) == row(members[0]));
        let all_of = |members: &[u32], kind: MeshKind| {
            members.iter().all(|&vertex| figure.kind(vertex as usize) == kind)
        };
        let bends = members.iter().max_by_key(|members| members.len()).is_some_and(|most| !is_rigid(most));
        let is_thing = |members: &&Vec<u32>| {
            members.len() >= 3
                && members.iter().all(|&vertex| self.is_loose(sources, vertex))
                && is_rigid(members)
                && (all_of(members, MeshKind::Accessory)
                    || bends && all_of(members, MeshKind::Body) && sources.lies_beside_bones(members))
        };
        let components: Vec<&Vec<u32>> = members.iter().filter(is_thing).collect();
        let is_alike = |one: usize, other: usize| row(components[one][0]) == row(components[other][0]);
        touching(figure, &components, TOUCHING, is_alike)
    }

    /// Buttons, buckles, badges: small loose components keep their shape.
    fn add_small(&mut self, sources: &PieceSources) {
        let &PieceSources { figure, weld, weights, .. } = sources;
        let limit = SMALL_PIECE * figure.height();
        for members in sources.members.iter().filter(|members| members.len() >= 3) {
            let (low, high) = sources.bounds(members);
            let is_loose = members.iter().all(|&vertex| self.is_loose(sources, vertex));
            if (high - low).max_element() > limit || !is_loose {
                continue;
            }
            let weights = mean_weights(weights, &once(weld, members));
            self.add(figure, members, (low + high) / 2.0, weights);
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

/// Components that lead from the body to a piece, with the piece: most of their vertices are moved by the piece's joints, and
/// not all. A strap that the body holds for the greater part stays with the body.
fn strands<'a>(
    members: &'a [Vec<u32>],
    piece_of: &impl Fn(u32) -> Option<usize>,
    is_loose: impl Fn(u32) -> bool,
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
            && members.iter().all(|&vertex| is_loose(vertex))
        {
            found.push((piece, members));
        }
    }
    found
}

/// For each joint the uppermost joint without a role that it hangs from, below a joint that has one.
fn uppermost_without_role(figure: &Figure, skeleton: &Skeleton) -> Vec<Option<usize>> {
    let joint_count = figure.joints.len();
    // A twist joint of a limb is the limb's: what it moves is worn there, and goes along as that becomes shorter.
    let of_limbs = (0..joint_count).filter(|&joint| limb_bone(figure, joint).is_some());
    let has_role = marked(joint_count, figure.humanoid.iter().map(|(_, joint)| joint).chain(of_limbs));
    let top = |joint: usize| skeleton.ancestors(joint).take_while(|&above| !has_role[above]).last();
    (0..joint_count).map(|joint| top(joint).filter(|_| figure.joint_roles[joint].is_some())).collect()
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
