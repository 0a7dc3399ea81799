//! Which of the fifteen parts move a vertex (product mode).
//!
//! The file's weights are made for animation: creases where they bend, borders where an artist put a joint, another
//! set for each garment. Parts that shrink by different amounts tear such borders open. So the weights are folded
//! into parts, head and neck are told apart by the geometry, and then all is smoothed along the mesh and across
//! layers of cloth; the file's own weights stay as they are.

use super::anatomy::{Anatomy, PART_COUNT, Part, PartWeights, fold_to_parts};
use crate::character::{MeshKind, Role, Skeleton};
use crate::geometry::point_tree::{Near, PointTree};
use crate::geometry::{Bounds, Groups, Neighbours, Weld, bounds, components, neighbours, touching};
use crate::parallel;
use crate::shape::figure::Figure;
use crate::shape::product::hair::HairOutline;
use glam::DVec3;
use std::collections::BTreeMap;

/// One step of smoothing along the mesh moves a vertex's weights this far to the mean of its neighbours'.
const UMBRELLA_STEP: f32 = 0.6;
/// The width of both kinds of smoothing, as a part of H.
const SMOOTHING_WIDTH: f64 = 0.012;
/// Bounds of the number of steps along the mesh.
const UMBRELLA_PASSES: (f64, f64) = (4.0, 60.0);
/// Steps across layers, and vertices that each takes into account.
const LAYER_PASSES: usize = 3;
const LAYER_NEIGHBOURS: usize = 24;
/// Left arm, right arm, the rest.
const CLASS_COUNT: usize = 3;
/// Fewer samples than this are not worth a thread.
const LEAST_SAMPLES: usize = 4000;
/// A vertex with more than this weight to an arm is the arm's. Not a half: where two pieces meet half and half is common,
/// and the last digits would decide.
const ARM_MAJORITY: f32 = 0.503;
/// Where hands (feet) without a joint begin, the weights go over from the lower arm (leg) within this part of the
/// distance on both sides.
const EXTREMITY_BAND: f64 = 0.1;
/// The head begins this far under the chin at the face, and this far above it behind the head joint, as parts of L.
const HEAD_PLANE: (f64, f64) = (-0.02, 0.22);
/// How far behind the head joint the plane has risen, as a part of L.
const HEAD_PLANE_BACK: f64 = 0.35;
/// The neck's weights go over into the head's within half the neck, but at least and at most these parts of L.
const HEAD_BAND: (f64, f64) = (0.06, 0.2);
/// Below the first of these heights, as parts of the ankle's, leg vertices are the foot's alone; above the second their
/// weights stay.
const SOLE_BAND: (f64, f64) = (0.15, 0.7);
/// Between these distances from the neck's axis, to the side or behind, what the head moves is hair, as parts of L.
const HAIR_REACH: (f64, f64) = (0.36, 0.5);
/// Loose pieces smaller than this part of H keep their shape: buttons, buckles, badges.
const SMALL_PIECE: f64 = 0.04;
/// Boxes closer than this part of H touch.
const TOUCHING: f64 = 0.005;
/// A vertex with this much weight to one joint counts as rigid.
const RIGID_WEIGHT: f64 = 0.99;

/// How a point takes part in the deformation, besides its weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Manner {
    /// By its weights alone.
    #[default]
    Plain,
    /// A hat or glasses: takes the face map of this point as a whole.
    OnFace(DVec3),
    /// Moves with piece number so-and-so, which keeps its shape.
    Piece(usize),
}

/// How one point is attached to the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartBinding {
    /// Weights of the fifteen parts; they sum to 1.
    pub weights: PartWeights,
    /// Besides the weights.
    pub manner: Manner,
}

impl PartBinding {
    /// Moved by one part alone.
    pub fn to(part: Part) -> Self {
        let mut weights = [0.0; PART_COUNT];
        weights[part as usize] = 1.0;
        Self { weights, manner: Manner::Plain }
    }
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

/// The bindings of all vertices of a figure.
#[derive(Clone, Debug, Default)]
pub struct PartBindings {
    /// One for each vertex.
    pub vertices: Vec<PartBinding>,
    /// The pieces that `Manner::Piece` speaks of.
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
    let vertex_count = figure.positions.len();
    let component = components(&figure.triangles, weld);
    let component_of = |vertex: usize| component[weld.representative[vertex] as usize] as usize;
    let component_count = component.iter().max().map_or(0, |&last| last as usize + 1);
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); component_count];
    for vertex in 0..vertex_count {
        members[component_of(vertex)].push(vertex as u32);
    }

    let mut parts: Vec<PartWeights> = figure.role_weights.iter().map(|row| fold_to_parts(row)).collect();
    let mut manners = vec![Manner::Plain; vertex_count];
    let head_only = head_only(figure, &parts, &members, &component_of);
    for vertex in 0..vertex_count {
        if head_only[vertex] {
            let part = if figure.kind(vertex) == MeshKind::Hair { Part::Hair } else { Part::Head };
            parts[vertex] = PartBinding::to(part).weights;
        } else {
            split_head(&mut parts[vertex], figure.positions[vertex], anatomy);
            split_limbs(&mut parts[vertex], figure.positions[vertex], figure, anatomy);
        }
    }
    mark_head_pieces(figure, anatomy, &members, &head_only, &mut parts, &mut manners);
    smooth_along(figure, weld, &head_only, &mut parts, threads);
    // Skin at the root of hair has moved over to the hair's weights, and must stay there or the hair line opens.
    let mut holds_head_only = vec![false; weld.count];
    for vertex in (0..vertex_count).filter(|&vertex| head_only[vertex]) {
        holds_head_only[weld.representative[vertex] as usize] = true;
    }
    let frozen: Vec<bool> =
        weld.representative.iter().map(|&welded| holds_head_only[welded as usize]).collect();
    smooth_across(figure, weld, &frozen, &mut parts, threads);

    for (row, &p) in parts.iter_mut().zip(&figure.positions) {
        settle_soles(row, p, anatomy);
    }

    let mut pieces = Vec::new();
    let joint_pieces = rigid_groups(figure, skeleton, &members, &head_only, &mut manners, &mut pieces);
    accessories(figure, &members, &head_only, &parts, &mut manners, &mut pieces);
    small_pieces(figure, &members, &head_only, &parts, &mut manners, &mut pieces);

    let hair = HairOutline::of(
        (0..vertex_count)
            .filter(|&vertex| parts[vertex][Part::Hair as usize] > 0.5)
            .map(|vertex| figure.positions[vertex]),
        DVec3::new(anatomy.middle_x, anatomy.landmarks.chin, anatomy.head_joint.z),
    );
    let vertices =
        parts.into_iter().zip(manners).map(|(weights, manner)| PartBinding { weights, manner }).collect();
    PartBindings { vertices, pieces, joint_pieces, hair }
}

/// How a joint that plays no role of its own is attached: by the part it folds into, as hair where it hangs from the
/// head, with its piece where it has one.
pub fn joint_binding(figure: &Figure, bindings: &PartBindings, joint: usize) -> PartBinding {
    let role = figure.joint_roles[joint].unwrap_or(Role::Hips);
    let mut binding = PartBinding::to(Part::of(role));
    if let Some(piece) = bindings.joint_pieces[joint] {
        binding.manner = Manner::Piece(piece);
    } else if role == Role::Head && figure.humanoid.joint(role) != Some(joint) {
        binding = PartBinding::to(Part::Hair);
    }
    binding
}

/// Vertices that move with the head alone: components without trunk or limb weight whose mean head weight is above
/// 0.6, and what is known to be hair or part of the face.
fn head_only(
    figure: &Figure,
    parts: &[PartWeights],
    members: &[Vec<u32>],
    component_of: &dyn Fn(usize) -> usize,
) -> Vec<bool> {
    let of_head = |vertex: u32| parts[vertex as usize][Part::Head as usize];
    let of_body = |vertex: u32| 1.0 - of_head(vertex) - parts[vertex as usize][Part::Neck as usize];
    let by_component: Vec<bool> = members
        .iter()
        .map(|members| {
            let mean =
                members.iter().map(|&vertex| of_head(vertex)).sum::<f32>() / members.len().max(1) as f32;
            mean > 0.6 && members.iter().all(|&vertex| of_body(vertex) < 0.01)
        })
        .collect();
    (0..parts.len())
        .map(|vertex| {
            matches!(figure.kind(vertex), MeshKind::Hair | MeshKind::FacePart)
                || by_component[component_of(vertex)]
        })
        .collect()
}

/// Head and neck by a plane through the chin that rises to the nape, not by the rig's weights.
fn split_head(parts: &mut PartWeights, p: DVec3, anatomy: &Anatomy) {
    let both = parts[Part::Head as usize] + parts[Part::Neck as usize];
    if both <= 0.0 {
        return;
    }
    let chin = anatomy.landmarks.chin;
    let length = anatomy.landmarks.head_length();
    let back = anatomy.head_joint.z - HEAD_PLANE_BACK * length;
    let front = anatomy.head_centre.z.max(anatomy.head_joint.z) + HEAD_PLANE_BACK * length;
    let rise = ((front - p.z) / (front - back)).clamp(0.0, 1.0);
    let plane = chin + length * (HEAD_PLANE.0 + rise * (HEAD_PLANE.1 - HEAD_PLANE.0));
    let band =
        ((chin - anatomy.landmarks.shoulder_line) / 2.0).clamp(HEAD_BAND.0 * length, HEAD_BAND.1 * length);
    let share = smoothstep((p.y - plane) / band + 1.0) as f32;
    // Hair that is one mesh with the body: what the file gives to the head and what hangs beside or behind the neck,
    // further out than a neck reaches.
    let neck_z = anatomy.centre_z(anatomy.landmarks.shoulder_line).0.min(anatomy.head_joint.z);
    let out = DVec3::new(p.x - anatomy.middle_x, 0.0, (p.z - neck_z).min(0.0)).length() / length;
    let of_head = (parts[Part::Head as usize] / both)
        * smoothstep((out - HAIR_REACH.0) / (HAIR_REACH.1 - HAIR_REACH.0)) as f32;
    let below = both * (1.0 - share);
    parts[Part::Head as usize] = both * share;
    parts[Part::Neck as usize] = below * (1.0 - of_head);
    parts[Part::Hair as usize] = below * of_head;
}

/// Lower arms, hands, shins and feet that the rig has no joint for take their weights from the geometry.
fn split_limbs(parts: &mut PartWeights, p: DVec3, figure: &Figure, anatomy: &Anatomy) {
    for limb in &anatomy.limbs {
        let left =
            limb.parts[0] == Part::LeftUpperArm as usize || limb.parts[0] == Part::LeftUpperLeg as usize;
        let is_arm = limb.parts[0] < Part::LeftUpperLeg as usize;
        let roles =
            if is_arm { [Role::LeftLowerArm, Role::LeftHand] } else { [Role::LeftLowerLeg, Role::LeftFoot] };
        let joints = [(limb.root, limb.middle), (limb.middle, limb.end)];
        for (index, (from, to)) in joints.into_iter().enumerate() {
            let role = if left { roles[index] } else { roles[index].mirrored() };
            let weight = parts[limb.parts[index]];
            if figure.humanoid.has(role) || weight <= 0.0 {
                continue;
            }
            let along = to - from;
            let past = (p - to).dot(along) / along.length_squared().max(1e-30);
            let share = smoothstep(past / (2.0 * EXTREMITY_BAND) + 0.5) as f32;
            parts[limb.parts[index]] = weight * (1.0 - share);
            parts[limb.parts[index + 1]] += weight * share;
        }
    }
}

/// Near the ground a leg is foot and nothing else: what smoothing left of the shin in the heels would bend the soles.
fn settle_soles(parts: &mut PartWeights, p: DVec3, anatomy: &Anatomy) {
    for leg in &anatomy.limbs[2..] {
        let ankle = leg.end.y - anatomy.landmarks.sole;
        let low = (p.y - anatomy.landmarks.sole) / ankle.max(1e-30);
        let share = smoothstep((SOLE_BAND.1 - low) / (SOLE_BAND.1 - SOLE_BAND.0)) as f32;
        if share > 0.0 {
            let [upper, lower, foot] = leg.parts;
            let moved = share * (parts[upper] + parts[lower]);
            parts[upper] *= 1.0 - share;
            parts[lower] *= 1.0 - share;
            parts[foot] += moved;
        }
    }
}

/// 0 below 0, 1 above 1, smooth between.
pub fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Umbrella steps on the welded mesh.
fn smooth_along(figure: &Figure, weld: &Weld, frozen: &[bool], parts: &mut [PartWeights], threads: usize) {
    let around = neighbours(&figure.triangles, weld);
    let firsts = weld.first_vertices();
    let mut edges: Vec<f64> = Vec::new();
    for vertex in 0..weld.count {
        let p = figure.positions[firsts[vertex] as usize];
        edges.extend(
            around
                .of(vertex)
                .iter()
                .filter(|&&other| other as usize > vertex)
                .map(|&other| p.distance(figure.positions[firsts[other as usize] as usize])),
        );
    }
    if edges.is_empty() {
        return;
    }
    let middle = edges.len() / 2;
    let median = *edges.select_nth_unstable_by(middle, f64::total_cmp).1;
    let width = SMOOTHING_WIDTH * figure.height() / median.max(1e-12 * figure.height());
    let passes = (10.0 * width * width).clamp(UMBRELLA_PASSES.0, UMBRELLA_PASSES.1).round() as usize;

    // Vertices at one place share one row from here on: their mean, so that seams stay closed.
    let mut rows = vec![[0.0f32; PART_COUNT]; weld.count];
    let mut counts = vec![0.0f32; weld.count];
    let mut still = vec![false; weld.count];
    for (vertex, row) in parts.iter().enumerate() {
        let welded = weld.representative[vertex] as usize;
        // Where hair is rooted in the scalp both must move as the frozen one does.
        if frozen[vertex] && !still[welded] {
            still[welded] = true;
            rows[welded] = [0.0; PART_COUNT];
            counts[welded] = 0.0;
        }
        if still[welded] == frozen[vertex] {
            add(&mut rows[welded], row, 1.0);
            counts[welded] += 1.0;
        }
    }
    for (row, count) in rows.iter_mut().zip(&counts) {
        row.iter_mut().for_each(|weight| *weight /= count.max(1.0));
    }
    // Parts do not mix, so each thread takes some of them; parts of one limb touch the same vertices.
    let threads = if weld.count < LEAST_SAMPLES { 1 } else { threads };
    let smoothed = parallel::collect(threads, SMOOTHED_TOGETHER.len(), 1, |group| {
        let columns: Vec<[f32; 4]> =
            rows.iter().map(|row| SMOOTHED_TOGETHER[group].map(|part| row[part as usize])).collect();
        umbrella_steps(columns, &around, &still, passes)
    });
    for (vertex, row) in parts.iter_mut().enumerate() {
        let welded = weld.representative[vertex] as usize;
        for (group, columns) in SMOOTHED_TOGETHER.iter().zip(&smoothed) {
            for (&part, &weight) in group.iter().zip(&columns[welded]) {
                row[part as usize] = weight;
            }
        }
    }
}

/// All parts, in groups that are smoothed together.
const SMOOTHED_TOGETHER: [[Part; 4]; 4] = [
    [Part::Trunk, Part::Neck, Part::Head, Part::Hair],
    [Part::LeftUpperArm, Part::LeftLowerArm, Part::LeftHand, Part::LeftFoot],
    [Part::RightUpperArm, Part::RightLowerArm, Part::RightHand, Part::RightFoot],
    [Part::LeftUpperLeg, Part::LeftLowerLeg, Part::RightUpperLeg, Part::RightLowerLeg],
];

/// `passes` steps towards the mean of the neighbours, for the weights of four parts; `still` vertices stay.
fn umbrella_steps(
    mut rows: Vec<[f32; 4]>,
    around: &Neighbours,
    still: &[bool],
    passes: usize,
) -> Vec<[f32; 4]> {
    // Weights reach one edge further with each step: what lies beyond stays 0.
    let mut reached: Vec<bool> = rows.iter().map(|row| *row != [0.0; 4]).collect();
    let mut moving: Vec<u32> = (0..rows.len() as u32).filter(|&vertex| reached[vertex as usize]).collect();
    let mut first = 0;
    for _ in 0..passes {
        let last = moving.len();
        for index in first..last {
            for &other in around.of(moving[index] as usize) {
                if !reached[other as usize] && !still[other as usize] {
                    reached[other as usize] = true;
                    moving.push(other);
                }
            }
        }
        first = last;
    }
    moving.retain(|&vertex| !still[vertex as usize] && !around.of(vertex as usize).is_empty());
    moving.sort_unstable();
    let mut before = rows.clone();
    for _ in 0..passes {
        std::mem::swap(&mut rows, &mut before);
        for &vertex in &moving {
            let near = around.of(vertex as usize);
            let share = 1.0 / near.len() as f32;
            let mut mean = [0.0f32; 4];
            for &other in near {
                let row = before[other as usize];
                for part in 0..4 {
                    mean[part] += row[part] * share;
                }
            }
            let own = before[vertex as usize];
            rows[vertex as usize] =
                std::array::from_fn(|part| own[part] + UMBRELLA_STEP * (mean[part] - own[part]));
        }
    }
    rows
}

fn add(sum: &mut PartWeights, row: &PartWeights, factor: f32) {
    for (sum, weight) in sum.iter_mut().zip(row) {
        *sum += weight * factor;
    }
}

/// A Gaussian over near vertices of any mesh, so that cloth and body move together. Left arm,
/// right arm and the rest do not mix: a hand on the hip must not carry the hip along.
fn smooth_across(figure: &Figure, weld: &Weld, frozen: &[bool], parts: &mut [PartWeights], threads: usize) {
    let sigma = SMOOTHING_WIDTH * figure.height();
    let class_of = |row: &PartWeights| {
        let sum = |first: Part| row[first as usize..first as usize + 3].iter().sum::<f32>();
        if sum(Part::LeftUpperArm) > ARM_MAJORITY {
            0u8
        } else if sum(Part::RightUpperArm) > ARM_MAJORITY {
            1
        } else {
            2
        }
    };
    let class: Vec<u8> = parts.iter().map(class_of).collect();
    // Vertices at one place are one sample and get one result.
    let mut samples: [Vec<usize>; CLASS_COUNT] = Default::default();
    let mut sample_of = vec![u32::MAX; parts.len()];
    let mut known = vec![[u32::MAX; CLASS_COUNT]; weld.count];
    for vertex in (0..parts.len()).filter(|&vertex| !frozen[vertex]) {
        let of_class = &mut samples[class[vertex] as usize];
        let sample = &mut known[weld.representative[vertex] as usize][class[vertex] as usize];
        if *sample == u32::MAX {
            *sample = of_class.len() as u32;
            of_class.push(vertex);
        }
        sample_of[vertex] = *sample;
    }
    let smoothed = samples.each_ref().map(|samples| {
        let points: Vec<DVec3> = samples.iter().map(|&vertex| figure.positions[vertex]).collect();
        let rows: Vec<PartWeights> = samples.iter().map(|&vertex| parts[vertex]).collect();
        layer_steps(&points, rows, sigma, threads)
    });
    for (vertex, &sample) in sample_of.iter().enumerate() {
        if sample != u32::MAX {
            parts[vertex] = smoothed[class[vertex] as usize][sample as usize];
        }
    }
    for row in parts.iter_mut() {
        let total: f32 = row.iter().sum();
        row.iter_mut().for_each(|weight| *weight /= total);
    }
}

/// The points that one point is smoothed with, in the order of the tree.
struct Layer {
    count: usize,
    slots: [u32; LAYER_NEIGHBOURS],
    weights: [f32; LAYER_NEIGHBOURS],
}

/// `LAYER_PASSES` Gaussian means over the nearest points within three standard deviations, `sigma` each.
fn layer_steps(points: &[DVec3], rows: Vec<PartWeights>, sigma: f64, threads: usize) -> Vec<PartWeights> {
    let tree = PointTree::new(points);
    let reach = 3.0 * sigma;
    let layers = parallel::collect_with(
        threads,
        points.len(),
        LEAST_SAMPLES,
        || (Vec::<Near>::new(), None::<DVec3>),
        |(found, last), slot| {
            let p = tree.point(slot);
            // Slots that follow each other are near each other: the neighbours of the last one bound the search.
            let bound = match (*last, found.get(LAYER_NEIGHBOURS - 1)) {
                (Some(last), Some(furthest)) => {
                    reach.min((furthest.distance() + p.distance(last)) * (1.0 + 1e-9))
                }
                _ => reach,
            };
            tree.nearest(p, LAYER_NEIGHBOURS, bound, found);
            *last = Some(p);
            let mut layer =
                Layer { count: found.len(), slots: [0; LAYER_NEIGHBOURS], weights: [0.0; LAYER_NEIGHBOURS] };
            let gaussian = |distance: f64| (-(distance * distance) / (2.0 * sigma * sigma)).exp();
            // The kernel ends at the last point that was found: which of several at that distance it is must not
            // matter, or the last digits of a model would show.
            let end = if found.len() == LAYER_NEIGHBOURS {
                gaussian(found[LAYER_NEIGHBOURS - 1].distance())
            } else {
                gaussian(reach)
            };
            for (place, near) in found.iter().enumerate() {
                layer.slots[place] = near.slot();
                layer.weights[place] = (gaussian(near.distance()) - end).max(0.0) as f32;
            }
            layer
        },
    );
    let mut ordered: Vec<PartWeights> = tree.indices().iter().map(|&index| rows[index as usize]).collect();
    for _ in 0..LAYER_PASSES {
        ordered = parallel::collect(threads, points.len(), LEAST_SAMPLES, |slot| {
            let layer = &layers[slot];
            let mut sum = [0.0; PART_COUNT];
            let mut total = 0.0;
            for (&other, &weight) in layer.slots.iter().zip(&layer.weights).take(layer.count) {
                add(&mut sum, &ordered[other as usize], weight);
                total += weight;
            }
            // Two dozen points at one place have no kernel.
            if total > 0.0 { sum.map(|weight| weight / total) } else { ordered[slot] }
        });
    }
    let mut smoothed = rows;
    for (&index, row) in tree.indices().iter().zip(ordered) {
        smoothed[index as usize] = row;
    }
    smoothed
}

/// Hats and glasses take the face map as a whole; a piece of the head that hangs down to the shoulders is hair.
fn mark_head_pieces(
    figure: &Figure,
    anatomy: &Anatomy,
    members: &[Vec<u32>],
    head_only: &[bool],
    parts: &mut [PartWeights],
    manners: &mut [Manner],
) {
    for members in members.iter().filter(|members| !members.is_empty()) {
        if !members.iter().all(|&vertex| head_only[vertex as usize]) {
            continue;
        }
        let (low, high) = bounds(members.iter().map(|&vertex| figure.positions[vertex as usize]));
        let hangs = low.y < anatomy.landmarks.shoulder_line;
        for &vertex in members {
            let vertex = vertex as usize;
            match figure.kind(vertex) {
                MeshKind::Accessory => manners[vertex] = Manner::OnFace((low + high) / 2.0),
                MeshKind::Body | MeshKind::Garment if hangs => {
                    parts[vertex] = PartBinding::to(Part::Hair).weights;
                }
                _ => {}
            }
        }
    }
}

/// Things carried on the body (a bag, a machine arm, a tail of plates): what hangs from one joint without a role and is
/// made of rigid components for the greater part keeps its shape as one.
fn rigid_groups(
    figure: &Figure,
    skeleton: &Skeleton,
    members: &[Vec<u32>],
    head_only: &[bool],
    manners: &mut [Manner],
    pieces: &mut Vec<Piece>,
) -> Vec<Option<usize>> {
    let joint_count = figure.joints.len();
    let mut has_role = vec![false; joint_count];
    for (_, joint) in figure.humanoid.iter() {
        has_role[joint] = true;
    }
    // The uppermost joint without a role below a joint that has one.
    let top: Vec<Option<usize>> = (0..joint_count)
        .map(|joint| {
            if has_role[joint] || figure.joint_roles[joint].is_none() {
                return None;
            }
            skeleton.ancestors(joint).take_while(|&above| !has_role[above]).last()
        })
        .collect();
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
        // A strap that goes over into the body stays with the body.
        if let Some(first_top) = first_top
            && members.iter().all(|&vertex| top_of(vertex) == Some(first_top) && !head_only[vertex as usize])
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
        piece_of_top[joint] = Some(pieces.len());
        for &vertex in &carried[joint] {
            manners[vertex as usize] = Manner::Piece(pieces.len());
        }
        let lowest =
            carried[joint].iter().map(|&v| figure.positions[v as usize].y).fold(f64::INFINITY, f64::min);
        let weights = PartBinding::to(Part::of(role)).weights;
        pieces.push(Piece { anchor: figure.joints[joint], lowest, weights });
    }
    top.iter().map(|top| top.and_then(|top| piece_of_top[top])).collect()
}

/// Bags, swords, machine arms that are meshes of kind accessory and hang rigidly from the body: components whose boxes
/// touch and whose weights are the same keep their shape as one, held where they are nearest to the body.
fn accessories(
    figure: &Figure,
    members: &[Vec<u32>],
    head_only: &[bool],
    parts: &[PartWeights],
    manners: &mut [Manner],
    pieces: &mut Vec<Piece>,
) {
    let is_loose = |vertex: usize| {
        figure.kind(vertex) == MeshKind::Accessory && !head_only[vertex] && manners[vertex] == Manner::Plain
    };
    let rigid = |members: &&Vec<u32>| {
        let row = |vertex: u32| &figure.role_weights[vertex as usize];
        members.len() >= 3
            && members.iter().all(|&vertex| is_loose(vertex as usize) && row(vertex) == row(members[0]))
    };
    let components: Vec<&Vec<u32>> = members.iter().filter(rigid).collect();
    if components.is_empty() {
        return;
    }
    let place = |vertex: u32| figure.positions[vertex as usize];
    let margin = DVec3::splat(TOUCHING * figure.height());
    let boxes: Vec<Bounds> = components
        .iter()
        .map(|members| bounds(members.iter().map(|&vertex| place(vertex))))
        .map(|(low, high)| (low - margin, high + margin))
        .collect();
    let mut groups = Groups::new(components.len());
    let row = |component: usize| &figure.role_weights[components[component][0] as usize];
    for (one, other) in touching(&boxes) {
        if row(one) == row(other) {
            groups.join(one, other);
        }
    }
    let mut things: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for (component, members) in components.iter().enumerate() {
        things.entry(groups.least(component)).or_default().extend(*members);
    }
    let body: Vec<DVec3> = (0..figure.positions.len())
        .filter(|&vertex| figure.kind(vertex) != MeshKind::Accessory)
        .map(|vertex| figure.positions[vertex])
        .collect();
    let tree = PointTree::new(&body);
    let mut near = Vec::new();
    for whole in things.into_values() {
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
        let mut weights = [0.0; PART_COUNT];
        for &vertex in &held {
            add(&mut weights, &parts[vertex as usize], 1.0 / held.len() as f32);
        }
        for &vertex in &whole {
            manners[vertex as usize] = Manner::Piece(pieces.len());
        }
        pieces.push(Piece {
            anchor: held.iter().map(|&vertex| place(vertex)).sum::<DVec3>() / held.len() as f64,
            lowest: whole.iter().map(|&vertex| place(vertex).y).fold(f64::INFINITY, f64::min),
            weights,
        });
    }
}

/// Buttons, buckles, badges: small loose components keep their shape.
fn small_pieces(
    figure: &Figure,
    members: &[Vec<u32>],
    head_only: &[bool],
    parts: &[PartWeights],
    manners: &mut [Manner],
    pieces: &mut Vec<Piece>,
) {
    let limit = SMALL_PIECE * figure.height();
    for members in members.iter().filter(|members| members.len() >= 3) {
        if members.iter().any(|&v| head_only[v as usize] || manners[v as usize] != Manner::Plain) {
            continue;
        }
        let (low, high) = bounds(members.iter().map(|&vertex| figure.positions[vertex as usize]));
        if (high - low).max_element() > limit {
            continue;
        }
        let mut weights = [0.0; PART_COUNT];
        for &vertex in members {
            add(&mut weights, &parts[vertex as usize], 1.0 / members.len() as f32);
        }
        for &vertex in members {
            manners[vertex as usize] = Manner::Piece(pieces.len());
        }
        pieces.push(Piece { anchor: (low + high) / 2.0, lowest: low.y, weights });
    }
}
