//! The meshes to rig, laid out in one space: x towards the character's left, y up, z forward, the lowest vertex at y = 0,
//! the highest at y = 1, the middle of the bounding box at x = z = 0.

use crate::character::kinds::LOWEST_CHIN;
use crate::character::mesh_list::MeshList;
use crate::character::{Character, Frame, Mesh, MeshKind};
use crate::error::Result;
use crate::geometry::bounds;
use glam::DVec3;
use std::ops::Range;

/// All meshes of a character in one space, 1 high.
#[derive(Clone, Debug)]
pub struct UnitFigure {
    /// Vertices of all meshes, one mesh after the other.
    pub positions: Vec<DVec3>,
    /// Triangles of all meshes, as indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Where each mesh's vertices start; one more than there are meshes.
    pub mesh_starts: Vec<usize>,
    /// Where each mesh's triangles start; one more than there are meshes.
    pub triangle_starts: Vec<usize>,
    /// What each mesh depicts, as far as anybody knows.
    pub kinds: Vec<Option<MeshKind>>,
    /// The names of the meshes.
    pub names: Vec<String>,
    frame: Frame,
    /// Where its origin is in the canonical frame, model units.
    origin: DVec3,
    /// The figure's height in model units.
    height: f64,
}

impl UnitFigure {
    /// Lays `character` out, looking along `forward` (model space, at any angle to up but 0).
    ///
    /// # Errors
    /// `ErrorKind::NoGeometry` where nothing has an extent along up.
    pub fn of(character: &Character, forward: DVec3) -> Result<Self> {
        Self::in_axes(character, forward, false)
    }

    /// As [`UnitFigure::of`], of a character in left-handed axes where `left_handed`: mirrored, so that x is its left here too.
    ///
    /// # Errors
    /// As [`UnitFigure::of`].
    pub fn in_axes(character: &Character, forward: DVec3, left_handed: bool) -> Result<Self> {
        let frame = Frame::new(character.axes.up.as_dvec3(), forward);
        let frame = if left_handed { frame.mirrored() } else { frame };
        let MeshList { mut positions, mut triangles, mesh_starts, triangle_starts } =
            MeshList::of(character, |p| frame.to_canonical(p));
        if left_handed {
            // What looked outwards does so still.
            triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        // Loose points say nothing about how tall a figure is.
        let (low, high) = bounds(triangles.iter().flatten().map(|&vertex| positions[vertex as usize]));
        if triangles.is_empty() || high.y <= low.y {
            return Err(MeshList::no_extent());
        }
        let origin = ((low + high) / 2.0).with_y(low.y);
        let height = high.y - low.y;
        positions.iter_mut().for_each(|p| *p = (*p - origin) / height);
        let kind_of = |(mesh, range): (&Mesh, &[usize])| {
            // A mesh of eyes may hold shoes too. Which of its vertices are which, weights say that are still to be found.
            let is_low = || positions[range[0]..range[1]].iter().any(|p| p.y < LOWEST_CHIN);
            let is_mixed = mesh.kind == Some(MeshKind::Eye) && is_low();
            mesh.kind.filter(|_| !is_mixed).map(MeshKind::without_eyes)
        };
        let kinds = character.meshes.iter().zip(mesh_starts.windows(2)).map(kind_of).collect();
        let names = character.meshes.iter().map(|mesh| mesh.name.clone()).collect();
        Ok(Self { positions, triangles, mesh_starts, triangle_starts, kinds, names, frame, origin, height })
    }

    /// The unit figure to model space.
    pub fn to_model(&self, p: DVec3) -> DVec3 {
        self.frame.to_model(p * self.height + self.origin)
    }

    /// Model space to the unit figure.
    pub fn to_unit(&self, p: DVec3) -> DVec3 {
        (self.frame.to_canonical(p) - self.origin) / self.height
    }

    /// How many meshes there are.
    pub fn mesh_count(&self) -> usize {
        self.kinds.len()
    }

    /// The vertices of one mesh.
    pub fn vertices(&self, mesh: usize) -> Range<usize> {
        self.mesh_starts[mesh]..self.mesh_starts[mesh + 1]
    }

    /// The triangles of one mesh.
    pub fn triangles_of(&self, mesh: usize) -> &[[u32; 3]] {
        &self.triangles[self.triangle_starts[mesh]..self.triangle_starts[mesh + 1]]
    }

    /// The mesh of a triangle.
    pub fn mesh_of(&self, triangle: usize) -> usize {
        self.triangle_starts.partition_point(|&start| start <= triangle) - 1
    }

    /// The triangles of those meshes that `choose` accepts by index.
    pub fn triangles_where(&self, choose: impl Fn(usize) -> bool) -> Vec<[u32; 3]> {
        (0..self.mesh_count())
            .filter(|&mesh| choose(mesh))
            .flat_map(|mesh| self.triangles_of(mesh))
            .copied()
            .collect()
    }
}
