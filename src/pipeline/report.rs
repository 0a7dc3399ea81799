//! The numbers of a run.

use super::{Deformed, Deformer};
use crate::character::Humanoid;
use crate::error::Result;
use crate::report::{Counts, FigureReport, ProfileReport, Report, RigReport};
use crate::shape::Measured;
use crate::shape::style::Style;
use glam::DVec3;
use std::collections::BTreeMap;

impl Deformer {
    /// The numbers of the run; `result` is measured anew on `deformed`. The host adds its own times and warnings.
    ///
    /// # Errors
    /// As [`Measured::of`] on the result.
    pub fn report(&self, deformed: &Deformed) -> Result<Report> {
        let character = &self.target.character;
        let measured = Measured::of(&character.with(deformed), &self.options)?;
        let roles = self.roles();
        let mut target = FigureReport::of(&self.target.measured, &roles, &self.options);
        let mut result = FigureReport::of(&measured, &roles, &self.options);
        let mut joint_count = character.skeleton.joints.len();
        if let Some(rig) = &self.rig {
            let at_rest = |joint: usize| character.skeleton.joints[joint].position();
            target.file_joints = joints_by_role(&rig.own, at_rest);
            result.file_joints = joints_by_role(&rig.own, |joint| deformed.joints[joint]);
            if rig.own_count > 0 {
                joint_count = rig.own_count;
            }
        }
        Ok(Report {
            target,
            reference: match &self.style {
                Style::Shape(shape) => Some(FigureReport::of_style(shape, &roles, &self.options)),
                Style::Heads(_) => None,
            },
            result,
            mode: self.options.mode.name(),
            g: self.deformation.head_ratio,
            coefficients: self.deformation.coefficients.clone(),
            profile: ProfileReport::of(&self.target.measured, &self.style, &measured),
            rig: self.rig.as_ref().map_or_else(|| self.kept_rig(), |rig| rig.report.clone()),
            counts: Counts {
                vertices: character.vertex_count(),
                triangles: character.triangle_count(),
                meshes: character.meshes.len(),
                morph_targets: character.meshes.iter().map(|mesh| mesh.morph_targets.len()).sum(),
                joints: joint_count,
            },
            timing_ms: self.timing,
            warnings: self.warnings.clone(),
        })
    }

    /// The character's own rig, of which every joint is sure.
    fn kept_rig(&self) -> RigReport {
        let roles = self.target.measured.joints.keys();
        RigReport {
            source: "kept",
            confidence: roles.map(|role| (role.name().to_string(), 1.0)).collect(),
            ..RigReport::default()
        }
    }
}

/// Where the joints of `humanoid` are, by role.
fn joints_by_role(humanoid: &Humanoid, place: impl Fn(usize) -> DVec3) -> BTreeMap<String, [f64; 3]> {
    humanoid.iter().map(|(role, joint)| (role.name().to_string(), place(joint).to_array())).collect()
}
