//! The head that a face is read from, in head lengths: what belongs to it, and how it looks from the front and the sides.

use super::raster::{DepthMap, Window};
use crate::character::Character;
use crate::geometry::triangles_where;
use glam::{DVec2, DVec3};

/// How much of the head the front view shows, in head lengths about the middle and above the chin: the widest head with
/// ears, and what a low chin or a high crown needs. Its squares are as fine as a mouth's corners.
const FRONT: Window =
    Window { low: DVec2::new(-0.62, -0.12), high: DVec2::new(0.62, 1.08), step: 1.0 / 150.0 };

/// Where a head is, and its unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeadFrame {
    /// The middle of the chin's underside, at the depth of the head joint.
    pub origin: DVec3,
    /// L: chin to crown.
    pub length: f64,
}

impl HeadFrame {
    /// From the figure's frame to head lengths.
    pub fn to_unit(&self, p: DVec3) -> DVec3 {
        (p - self.origin) / self.length
    }

    /// From head lengths to the figure's frame.
    pub fn from_unit(&self, p: DVec3) -> DVec3 {
        self.origin + self.length * p
    }
}

/// What the head of a character is made of: flags by vertex, its meshes' vertices one after the other.
pub struct HeadParts<'a> {
    /// Whose it is.
    pub character: &'a Character,
    /// Where each mesh's vertices start; one more than there are meshes.
    pub mesh_starts: &'a [usize],
    /// All of the character's triangles.
    pub triangles: &'a [[u32; 3]],
    /// What the head moves.
    pub of_head: Vec<bool>,
    /// What of that is hair.
    pub is_hair: Vec<bool>,
    /// What of that is a hat, glasses or the like.
    pub is_accessory: Vec<bool>,
    /// What of that is an eye: a mesh of eyes, or moved by an eye's joint.
    pub is_eye: Vec<bool>,
    /// What eye joints move.
    pub turns: Vec<bool>,
    /// What the host says of the eyes: middle, half width and height, in the figure's frame; 0 where a size is not known.
    pub eye_hints: Vec<(DVec3, DVec2)>,
    /// Where the joints of the left and the right eye are, in the character's units.
    pub eye_joints: [Option<DVec3>; 2],
    /// Vertices nearer than this are one, in the character's units.
    pub seam: f64,
}

/// A head, in its frame.
pub struct Head<'a> {
    /// What it is made of.
    pub parts: HeadParts<'a>,
    /// Where it is.
    pub frame: HeadFrame,
    /// All vertices, in head lengths.
    pub points: Vec<DVec3>,
    /// Its triangles without hair, hats and glasses.
    pub bare: Vec<[u32; 3]>,
    /// How these look from the front.
    pub front: DepthMap,
}

impl<'a> Head<'a> {
    /// The head at `frame` among `positions`, the character's vertices: x to its left, y up, z to the front.
    pub fn new(parts: HeadParts<'a>, positions: &[DVec3], frame: HeadFrame) -> Self {
        let points: Vec<DVec3> = positions.iter().map(|&p| frame.to_unit(p)).collect();
        let is_bare =
            |vertex: usize| parts.of_head[vertex] && !parts.is_hair[vertex] && !parts.is_accessory[vertex];
        let bare = triangles_where(parts.triangles, is_bare);
        let front = DepthMap::new(&points, &bare, FRONT);
        Self { parts, frame, points, bare, front }
    }

    /// Triangles of the head with hair.
    pub fn with_hair(&self) -> Vec<[u32; 3]> {
        let parts = &self.parts;
        triangles_where(parts.triangles, |vertex| parts.of_head[vertex] && !parts.is_accessory[vertex])
    }

    /// Triangles of the eyes.
    pub fn eyes(&self) -> Vec<[u32; 3]> {
        triangles_where(self.parts.triangles, |vertex| {
            self.parts.is_eye[vertex] && self.parts.of_head[vertex]
        })
    }

    /// A finer look from the front.
    pub fn front_view(&self, low: DVec2, high: DVec2, step: f64) -> DepthMap {
        DepthMap::new(&self.points, &self.bare, Window { low, high, step })
    }

    /// The head from its left (`side` 1) or its right (-1): z to the right, depth is the distance from the middle.
    pub fn side_view(&self, side: f64, low: DVec2, high: DVec2, step: f64) -> DepthMap {
        let turned: Vec<DVec3> = self.points.iter().map(|p| DVec3::new(p.z, p.y, side * p.x)).collect();
        DepthMap::new(&turned, &self.bare, Window { low, high, step })
    }

    /// How bright the triangle between `corners` is before or behind `p`, seen from the front; 0 to 1.
    pub fn shade(&self, corners: [u32; 3], p: DVec2) -> Option<f64> {
        let starts = self.parts.mesh_starts;
        let mesh = starts.partition_point(|&start| start <= corners[0] as usize) - 1;
        let [a, b, c] = corners.map(|corner| self.points[corner as usize].truncate());
        let double_area = (b - a).perp_dot(c - a);
        let (to_b, to_c) = ((p - a).perp_dot(c - a) / double_area, (b - a).perp_dot(p - a) / double_area);
        let corners = corners.map(|corner| corner as usize - starts[mesh]);
        self.parts.character.meshes[mesh].shade.at(corners, [1.0 - to_b - to_c, to_b, to_c])
    }

    /// Where the joint of the left (0) or right (1) eye is, in head lengths.
    pub fn eye_joint(&self, side: usize) -> Option<DVec3> {
        self.parts.eye_joints[side].map(|p| self.frame.to_unit(p))
    }
}

/// The box of `points` that leaves out, along each axis, the share `q` at each end; `None` where there are none. Mirrored points
/// have mirrored boxes.
pub fn quantile_box(points: &[DVec2], q: f64) -> Option<(DVec2, DVec2)> {
    let most = points.len().checked_sub(1)?;
    let index = ((q * points.len() as f64) as usize).min(most);
    let ends = [0, 1].map(|axis| {
        let mut values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        [index, most - index].map(|index| *values.select_nth_unstable_by(index, f64::total_cmp).1)
    });
    let [[left, right], [bottom, top]] = ends;
    Some((DVec2::new(left, bottom), DVec2::new(right, top)))
}

/// The value below which the share `q` of `values` lies; `None` where there are none.
pub fn quantile(values: &mut [f64], q: f64) -> Option<f64> {
    let index = ((q * values.len() as f64) as usize).min(values.len().checked_sub(1)?);
    Some(*values.select_nth_unstable_by(index, f64::total_cmp).1)
}
