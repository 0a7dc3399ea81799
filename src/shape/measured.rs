//! All that is read from one character before anything is deformed (§V-A): layout, anatomy, bones, body shape.

use super::body_shape::{BodyShape, FaceStyle};
use super::figure::Figure;
use super::measure::measure;
use super::product::anatomy::Anatomy;
use super::product::face_input::head;
use super::product::landmarks::HAIRBREADTH;
use super::product::profile::chains::Chains;
use super::product::profile::{BodyFrame, BodyLines, measure_profile};
use crate::character::bones::{Bone, bones};
use crate::character::mesh_list::MeshList;
use crate::character::{Character, MeshKind, Role};
use crate::error::Result;
use crate::face::face_landmarks::FaceLandmarks;
use crate::geometry::{SEAM, Surface, Weld, weld};
use crate::options::Options;
use crate::parallel;
use crate::progress::Progress;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// One character, measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The character in one space.
    pub figure: Arc<Figure>,
    /// Landmarks and proportions.
    pub anatomy: Anatomy,
    /// The face in head lengths, where there is a chin to measure from.
    pub face: Option<FaceLandmarks>,
    /// Where the joints of the roles are, canonical frame.
    pub joints: BTreeMap<Role, DVec3>,
    /// The end of the head bone: straight above the head joint, hair and hats included.
    pub head_top: DVec3,
    /// The figure's vertices by position.
    pub weld: Arc<Weld>,
    /// Which of its body's chains each of them belongs to.
    pub chains: Arc<Chains>,
    /// The lines that its slices lie on.
    pub lines: BodyLines,
    /// Lengths and radii, and the proportions: all that a style keeps.
    pub shape: BodyShape,
}

impl Measured {
    /// Measures `character`.
    ///
    /// # Errors
    /// As [`Figure::of`] and [`measure`].
    pub fn of(character: &Character, options: &Options) -> Result<Self> {
        Self::of_figure(Arc::new(Figure::of(character)?), character, options, &mut Progress::none())
    }

    /// Measures a character that is laid out already, as `figure`.
    ///
    /// # Errors
    /// As [`measure`]; `Cancelled`.
    pub fn of_figure(
        figure: Arc<Figure>,
        character: &Character,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Self> {
        let threads = if figure.triangles.len() < parallel::FEW { 1 } else { options.thread_count };
        let (surfaces, mut anatomy) = if parallel::thread_count(threads) == 1 {
            let surfaces = surfaces(&figure);
            progress.at(0.2)?;
            (surfaces, Anatomy::of(&figure))
        } else {
            parallel::both(threads, || surfaces(&figure), || Anatomy::of(&figure))
        };
        progress.at(0.4)?;
        if surfaces.iter().all(Surface::is_empty) {
            return Err(MeshList::no_area(character));
        }
        let joints: BTreeMap<Role, DVec3> =
            figure.humanoid.iter().map(|(role, joint)| (role, figure.joints[joint])).collect();
        let least = anatomy.head_joint.y + HAIRBREADTH * figure.height();
        let head_top = anatomy.head_joint.with_y(anatomy.landmarks.head_top.max(least));
        let roles: BTreeSet<Role> = joints.keys().copied().collect();
        let bones = bones(&roles, &options.bone_groups);
        let surfaces: Vec<&Surface> = surfaces.iter().collect();
        let chin_seen = anatomy.landmarks.chin_seen;
        let face = || chin_seen.then(|| FaceLandmarks::of(&head(character, &figure, &anatomy)));
        let radii_and_face = || (measure(&bones, &joints, head_top, &surfaces, options.ray_count()), face());
        let weld_and_profile = |progress: &mut Progress| {
            progress.at(0.7)?;
            let weld = weld(&figure.positions, SEAM * figure.height());
            progress.at(0.8)?;
            let chains = Chains::of(&figure);
            let frame = BodyFrame::of(&figure, &anatomy);
            let profile = measure_profile(&figure, &figure.positions, &chains, &weld, &frame, threads);
            Ok((Arc::new(weld), Arc::new(chains), frame, profile))
        };
        let ((shape, face), made) = parallel::both(threads, radii_and_face, || weld_and_profile(progress));
        let (weld, chains, frame, (profile, lines)) = made?;
        anatomy.centre_line = frame.centre_line(profile.torso.as_ref());
        let mut shape = shape?;
        shape.landmarks = Some(anatomy.landmarks.heights);
        shape.proportions = Some(frame.with_widths(&profile, &anatomy.proportions));
        (shape.face, shape.profile) = (face.as_ref().and_then(FaceStyle::of), Some(profile));
        progress.at(1.0)?;
        Ok(Self { figure, anatomy, face, joints, head_top, weld, chains, lines, shape })
    }

    /// The bones between those roles of the figure that are in `roles` too.
    pub fn bones(&self, roles: &BTreeSet<Role>, options: &Options) -> Vec<Bone> {
        let common = self.joints.keys().copied().filter(|role| roles.contains(role)).collect();
        bones(&common, &options.bone_groups)
    }
}

/// What the rays meet, from narrow to wide: the body, and the body with its garments where it has some; everything
/// where there is neither.
fn surfaces(figure: &Figure) -> Vec<Surface> {
    let body = mesh_set(figure, |kind| kind == MeshKind::Body);
    let dressed = mesh_set(figure, |kind| matches!(kind, MeshKind::Body | MeshKind::Garment));
    let mut surfaces = vec![Surface::new(&figure.positions, &body)];
    // Both keep the figure's order, so as many triangles are the same triangles.
    if dressed.len() > body.len() {
        surfaces.push(Surface::new(&figure.positions, &dressed));
    }
    surfaces.retain(|set| !set.is_empty());
    if surfaces.is_empty() {
        surfaces.push(Surface::new(&figure.positions, &figure.triangles));
    }
    surfaces
}

/// Triangles of the meshes whose kind `choose` accepts.
fn mesh_set(figure: &Figure, choose: impl Fn(MeshKind) -> bool) -> Vec<[u32; 3]> {
    figure.triangles.iter().filter(|corners| choose(figure.kind(corners[0] as usize))).copied().collect()
}

/// True where most of a vertex's weight is the head's.
pub fn is_of_head(figure: &Figure, vertex: usize) -> bool {
    figure.weight_of(vertex, Role::is_head) > 0.5
}
