//! What product mode finds of a target once, whatever style and options are: how it hangs on the parts, what it wears.

use super::binding::{PartBinding, PartBindings, joint_binding, part_bindings};
use super::joint_bindings::{arm_binding, mean_bindings, weight_rows};
use super::part::Part;
use super::profile::Chart;
use super::worn::Worn;
use crate::character::{Character, Role};
use crate::error::Result;
use crate::geometry::Weld;
use crate::progress::Progress;
use crate::shape::Measured;
use crate::shape::field::Binding;
use crate::shape::figure::Figure;
use crate::shape::placement::{Bindings, GroundContact, joint_bindings};
use glam::DVec3;
use std::sync::Arc;

/// How a measured target hangs on the parts: no style and no option changes it.
#[derive(Debug)]
pub struct ProductTarget {
    /// All that hangs on them.
    pub bindings: Arc<Bindings>,
    /// What the bindings were made with, less the vertices' own.
    pub parts: PartBindings,
    /// Its body as it stands.
    pub chart: Chart,
}

impl ProductTarget {
    /// Binds vertices and joints of `character` to parts.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn of(
        character: &Character,
        measured: &Measured,
        threads: usize,
        progress: &mut Progress,
    ) -> Result<Self> {
        let figure = &measured.figure;
        let mut parts = part_bindings(
            figure,
            &measured.anatomy,
            measured.face.as_ref(),
            &character.skeleton,
            &measured.weld,
            threads,
            &mut progress.part(0.0, 0.8),
        )?;
        let vertices = std::mem::take(&mut parts.vertices);
        let of_legs =
            |vertex: usize| vertices[vertex].weights[Part::LeftUpperLeg as usize..].iter().sum::<f32>();
        let ground = GroundContact::of(figure, |vertex| of_legs(vertex) > 0.5);
        let means = mean_bindings(character, figure, &vertices);
        let joints = joint_bindings(character, figure, |joint| {
            let of_neck = is_head_joint_in_neck(measured, joint).then(|| PartBinding::to(Part::Neck));
            let found = of_neck.or_else(|| arm_binding(figure, joint)).or(means[joint]);
            Binding::Parts(found.unwrap_or_else(|| joint_binding(figure, &parts, joint)))
        });
        let chart = Chart::of(measured, threads);
        let spots = chart.spots(figure, &vertices);
        let vertices = vertices.into_iter().map(Binding::Parts).collect();
        let bindings =
            Bindings { eyes: eyes(character, figure), spots, ..Bindings::new(vertices, joints, ground) };
        Ok(Self { bindings: Arc::new(bindings), parts, chart })
    }
}

/// What is worn of a character that is laid out as `figure`.
pub fn worn(character: &Character, figure: &Figure, weld: &Weld, threads: usize) -> Worn {
    let mesh = |vertex: usize| figure.mesh_starts.partition_point(|&start| start <= vertex) - 1;
    Worn::of(figure, |vertex| character.meshes[mesh(vertex)].kind.is_some(), weld, threads)
}

/// Fewer vertices than this have no middle to speak of.
const LEAST_EYE: usize = 8;

/// Joints that play eyes, and the vertices of what they turn.
fn eyes(character: &Character, figure: &Figure) -> Vec<(usize, Vec<u32>)> {
    let of = |joint: usize| -> Vec<u32> {
        let turns = |row: &[(u32, f32)]| row.iter().any(|&(by, weight)| by as usize == joint && weight > 0.5);
        let rows = weight_rows(character, figure).filter(|(_, row)| turns(row));
        rows.map(|(vertex, _)| vertex as u32).collect()
    };
    let joints =
        [Role::LeftEye, Role::RightEye].into_iter().filter_map(|role| character.humanoid.joint(role));
    joints.map(|joint| (joint, of(joint))).filter(|(_, vertices)| vertices.len() >= LEAST_EYE).collect()
}

/// Heads often turn about a point in the neck: a head joint below the chin moves as the neck does.
fn is_head_joint_in_neck(measured: &Measured, joint: usize) -> bool {
    let figure = &measured.figure;
    figure.humanoid.joint(Role::Head) == Some(joint)
        && figure.joints[joint].y < measured.anatomy.landmarks.heights.chin
}

/// What hangs from a head joint in the neck is on the head all the same, above the chin: the binding of such a point `p`,
/// canonical frame.
pub fn on_head(measured: &Measured, joint: usize, p: DVec3) -> Option<Binding> {
    let is_above_chin = p.y >= measured.anatomy.landmarks.heights.chin;
    (is_above_chin && is_head_joint_in_neck(measured, joint)).then(|| Binding::to(Part::Head))
}
