//! Skeletons and meshes, from the caller's arrays to the library's.

use super::character_types::{
    SDEF_TYPE_DEFAULT, SDEF_TYPE_F32, SDEF_TYPE_U8, SDEF_TYPE_U16, SDEF_TYPE_U32, SdefFaceHints, SdefImage,
    SdefMesh, SdefSkeleton,
};
use crate::character::mesh::place;
use crate::character::{
    Axes, Character, EyeHint, FaceHints, GreyImage, Humanoid, Joint, Mesh, MeshKind, Role, Shade, Skeleton,
    Weights,
};
use crate::error::Named;
use crate::ffi::arrays::{self, Input, reserved};
use crate::ffi::basics::{SDEF_ELEMENT_JOINT, SDEF_ELEMENT_VERTEX};
use crate::ffi::guard::{Failure, Outcome};
use crate::ffi::options::one_of;
use core::ffi::c_void;
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::sync::Arc;

/// Reads the axes.
///
/// # Safety
/// Each is NULL or points to 3 floats.
pub unsafe fn axes(up: *const f32, forward: *const f32) -> Outcome<Axes> {
    let mut axes = Axes::default();
    unsafe {
        if !up.is_null() {
            axes.up = up.cast::<Vec3>().read_unaligned();
            axes.up_is_known = true;
        }
        if !forward.is_null() {
            axes.forward = Some(forward.cast::<Vec3>().read_unaligned());
        }
    }
    Character { axes, ..Character::default() }.validate()?;
    Ok(axes)
}

/// Reads a skeleton with its roles.
///
/// # Safety
/// The struct and its arrays are as the header says.
pub unsafe fn skeleton(skeleton: *const SdefSkeleton) -> Outcome<(Skeleton, Humanoid)> {
    let given = unsafe { arrays::struct_in(skeleton) }?;
    let count = given.joint_count;
    if i32::try_from(count).is_err() {
        return Err(Failure::argument(format!("joint_count is {count}: give at most 2147483647")));
    }
    let parents = unsafe { Input::new("parents", given.parents, count, 0) }?;
    let rests = unsafe {
        Input::<[f64; 16]>::new("rest_matrices", given.rest_matrices.cast(), count, given.rest_stride)
    }?;
    let mut joints = reserved(count, "joints")?;
    for index in 0..count {
        let name = if given.names.is_null() {
            String::new()
        } else {
            unsafe { arrays::text(given.names.add(index).read_unaligned()) }
        };
        let parent = match parents.get(index) {
            -1 => None,
            parent => Some(usize::try_from(parent).map_err(|_| {
                let message = format!(
                    "joint {index} ({}): its parent is {parent}: give a joint, or -1 for none",
                    Named(&name)
                );
                Failure::input(message).at(SDEF_ELEMENT_JOINT, index)
            })?),
        };
        joints.push(Joint { name, parent, rest: DMat4::from_cols_array(&rests.get(index)) });
    }
    let skeleton = Skeleton { joints };
    skeleton.validate()?;
    let mut humanoid = Humanoid::default();
    if given.role_count as usize > Role::COUNT {
        return Err(Failure::argument(format!(
            "role_count is {}: give at most {}, as many as there are roles",
            given.role_count,
            Role::COUNT
        )));
    }
    let roles = unsafe { Input::new("role_joints", given.role_joints, given.role_count as usize, 0) }?;
    for (role, joint) in Role::all().zip(roles.iter()).filter(|&(_, joint)| joint != -1) {
        let Some(joint) = usize::try_from(joint).ok().filter(|&joint| joint < count) else {
            return Err(Failure::input(format!(
                "role_joints gives {role} the joint {joint}, but there are {count} joints: give one of them, or -1"
            )));
        };
        if let Some((other, _)) = humanoid.iter().find(|&(_, taken)| taken == joint) {
            return Err(Failure::input(format!(
                "role_joints gives {other} and {role} the joint {joint}: a joint plays one role, and -1 stands for none"
            ))
            .at(SDEF_ELEMENT_JOINT, joint));
        }
        humanoid.set(role, joint);
    }
    Ok((skeleton, humanoid))
}

/// As `mesh`, with the mesh in what is said of a mistake: it will be number `index`. `image`: what it names.
///
/// # Safety
/// The struct and its arrays are as the header says.
pub unsafe fn mesh_at(
    index: usize,
    given: &SdefMesh,
    image: Outcome<Option<Arc<GreyImage>>>,
) -> Outcome<Mesh> {
    unsafe { image.and_then(|image| mesh(given, image)) }.map_err(|failure| {
        let name = unsafe { arrays::text(given.name) };
        Failure { message: format!("{}: {}", place(index, &name), failure.message), ..failure }.in_mesh(index)
    })
}

/// The longest side of an image.
const LONGEST_IMAGE: u32 = 1 << 16;

/// Reads an image.
///
/// # Safety
/// The struct and its array are as the header says.
pub unsafe fn image(given: &SdefImage) -> Outcome<GreyImage> {
    for (what, side) in [("width", given.width), ("height", given.height)] {
        if !(1..=LONGEST_IMAGE).contains(&side) {
            return Err(Failure::argument(format!("{what} is {side}: give 1 to {LONGEST_IMAGE} pixels")));
        }
    }
    let (width, height) = (given.width as usize, given.height as usize);
    let stride = arrays::stride_of(&"pixels", given.pixels.is_null(), height, given.row_stride, width)?;
    // SAFETY: row and column lie within what was checked.
    let pixel = |row: usize, column: usize| unsafe { *given.pixels.add(row * stride + column) };
    Ok(GreyImage::new(width, height, pixel))
}

/// Reads what is known of a face.
///
/// # Safety
/// The struct and its arrays are as the header says.
pub unsafe fn face_hints(given: &SdefFaceHints) -> Outcome<FaceHints> {
    if given.eye.is_null() && !given.other_eye.is_null() {
        return Err(Failure::argument("eye is NULL, but other_eye is not: give one eye as eye"));
    }
    let SdefFaceHints { half_width, half_height, .. } = *given;
    let eye = |middle: *const f64| {
        // SAFETY: it is NULL or points to 3 doubles.
        let middle = (!middle.is_null()).then(|| unsafe { middle.cast::<[f64; 3]>().read_unaligned() })?;
        Some(EyeHint { middle: DVec3::from_array(middle), half_width, half_height })
    };
    let hints = FaceHints { eye: eye(given.eye), other_eye: eye(given.other_eye) };
    hints.validate()?;
    Ok(hints)
}

/// How bright a mesh is, as far as the host says.
///
/// # Safety
/// As [`mesh`].
unsafe fn shade(given: &SdefMesh, image: Option<Arc<GreyImage>>) -> Outcome<Shade> {
    let count = given.vertex_count;
    if !given.luminance.is_null() {
        let values =
            unsafe { Input::<u8>::new("luminance", given.luminance, count, given.luminance_stride) }?;
        return Ok(Shade::Vertices(values.to_vec("luminance")?));
    }
    let Some(image) = image else { return Ok(Shade::Unknown) };
    let uvs = unsafe { Input::<[f32; 2]>::new("uvs", given.uvs.cast(), count, given.uv_stride) }?;
    if let Some(vertex) = uvs.iter().position(|uv| !uv.iter().all(|along| along.is_finite())) {
        let [u, v] = uvs.get(vertex);
        let message = format!("the uv of vertex {vertex} is ({u}, {v}): uvs must be finite numbers");
        return Err(Failure::input(message).at(SDEF_ELEMENT_VERTEX, vertex));
    }
    let mut all = reserved(count, "uvs")?;
    all.extend(uvs.iter().map(Vec2::from_array));
    Ok(Shade::Image { uvs: all, image })
}

/// Reads a mesh, but for what needs the character.
///
/// # Safety
/// The struct and its arrays are as the header says.
unsafe fn mesh(given: &SdefMesh, image: Option<Arc<GreyImage>>) -> Outcome<Mesh> {
    let name = unsafe { arrays::text(given.name) };
    let kinds = [
        None,
        Some(MeshKind::Body),
        Some(MeshKind::Garment),
        Some(MeshKind::Hair),
        Some(MeshKind::FacePart),
        Some(MeshKind::Accessory),
        Some(MeshKind::Eye),
    ];
    let kind = one_of("kind", "SDEF_MESH_", given.kind, &kinds)?;
    let count = given.vertex_count;
    if count >= u32::MAX as usize {
        return Err(Failure::argument(format!("vertex_count is {count}: give at most 4294967294")));
    }
    unsafe {
        let positions =
            Input::<Vec3>::new("positions", given.positions.cast(), count, given.position_stride)?;
        let triangles = Triangles::new(given)?;
        let weights = Rows::new(given)?;
        Ok(Mesh {
            kind,
            positions: positions.to_vec("positions")?,
            triangles: triangles.read()?,
            normals: arrays::optional("normals", given.normals, count, given.normal_stride)?,
            tangents: arrays::optional("tangents", given.tangents, count, given.tangent_stride)?,
            morph_targets: Vec::new(),
            shade: shade(given, image)?,
            weights: weights.read()?,
            name,
        })
    }
}

/// The caller's indices.
enum Triangles {
    U8(Input<u8>),
    U16(Input<u16>),
    U32(Input<[u32; 3]>),
}

impl Triangles {
    unsafe fn new(given: &SdefMesh) -> Outcome<Self> {
        let (start, count) = (given.indices, given.index_count);
        if !count.is_multiple_of(3) {
            return Err(Failure::argument(format!("index_count is {count}: give 3 for each triangle")));
        }
        unsafe {
            match given.index_type {
                SDEF_TYPE_DEFAULT | SDEF_TYPE_U32 => {
                    Ok(Self::U32(Input::new("indices", start.cast(), count / 3, 0)?))
                }
                SDEF_TYPE_U16 => Ok(Self::U16(Input::new("indices", start.cast(), count, 0)?)),
                SDEF_TYPE_U8 => Ok(Self::U8(Input::new("indices", start.cast(), count, 0)?)),
                other => Err(bad_type("index_type", other, "SDEF_TYPE_U8, _U16 or _U32")),
            }
        }
    }

    fn read(&self) -> Outcome<Vec<[u32; 3]>> {
        match self {
            Self::U32(indices) => indices.to_vec("triangles"),
            Self::U16(indices) => widened(indices),
            Self::U8(indices) => widened(indices),
        }
    }
}

fn widened<T: arrays::Plain + Into<u32>>(indices: &Input<T>) -> Outcome<Vec<[u32; 3]>> {
    let count = indices.len() / 3;
    let mut triangles = reserved(count, "triangles")?;
    triangles
        .extend((0..count).map(|triangle| [0, 1, 2].map(|corner| indices.get(3 * triangle + corner).into())));
    Ok(triangles)
}

fn bad_type(what: &str, number: u32, known: &str) -> Failure {
    Failure::argument(format!("{what} is {number}: give {known}"))
}

/// The caller's joints or weights: some numbers for each of some rows.
struct Columns {
    start: *const u8,
    stride: usize,
    kind: u32,
}

impl Columns {
    unsafe fn new(
        what: &str,
        start: *const c_void,
        (rows, columns): (usize, usize),
        stride: usize,
        kind: u32,
    ) -> Outcome<Self> {
        let size = match kind {
            SDEF_TYPE_U8 => 1,
            SDEF_TYPE_U16 => 2,
            _ => 4,
        };
        let row = columns.checked_mul(size).filter(|&row| isize::try_from(row).is_ok()).ok_or_else(|| {
            Failure::argument(format!("{what}: {columns} are more than memory can hold: give fewer"))
        })?;
        let stride = arrays::stride_of(&what, start.is_null(), if row == 0 { 0 } else { rows }, stride, row)?;
        Ok(Self { start: start.cast(), stride, kind })
    }

    /// # Safety
    /// Row and column lie within what was checked.
    #[inline]
    unsafe fn joint(&self, row: usize, column: usize) -> u32 {
        unsafe {
            let at = self.start.add(row * self.stride);
            match self.kind {
                SDEF_TYPE_U8 => u32::from(*at.add(column)),
                SDEF_TYPE_U16 => u32::from(at.cast::<u16>().add(column).read_unaligned()),
                _ => at.cast::<u32>().add(column).read_unaligned(),
            }
        }
    }

    /// # Safety
    /// As [`Columns::joint`].
    #[inline]
    unsafe fn weight(&self, row: usize, column: usize) -> f32 {
        unsafe {
            let at = self.start.add(row * self.stride);
            match self.kind {
                SDEF_TYPE_U8 => f32::from(*at.add(column)) / 255.0,
                SDEF_TYPE_U16 => f32::from(at.cast::<u16>().add(column).read_unaligned()) / 65535.0,
                _ => at.cast::<f32>().add(column).read_unaligned(),
            }
        }
    }
}

/// The caller's weights.
struct Rows {
    joints: Columns,
    weights: Columns,
    vertex_count: usize,
    influence_count: usize,
    starts: Option<Input<u32>>,
}

impl Rows {
    unsafe fn new(given: &SdefMesh) -> Outcome<Self> {
        let (vertices, influences) = (given.vertex_count, given.influence_count);
        if !matches!(given.joint_type, SDEF_TYPE_DEFAULT | SDEF_TYPE_U8 | SDEF_TYPE_U16 | SDEF_TYPE_U32) {
            return Err(bad_type("joint_type", given.joint_type, "SDEF_TYPE_U8, _U16 or _U32"));
        }
        if !matches!(given.weight_type, SDEF_TYPE_DEFAULT | SDEF_TYPE_U8 | SDEF_TYPE_U16 | SDEF_TYPE_F32) {
            return Err(bad_type("weight_type", given.weight_type, "SDEF_TYPE_F32, _U8 or _U16"));
        }
        unsafe {
            let starts = (!given.row_starts.is_null())
                .then(|| Input::new("row_starts", given.row_starts, vertices + 1, 0))
                .transpose()?;
            // Where rows have starts, one row holds everything.
            let shape = (if starts.is_some() { 1 } else { vertices }, influences);
            let rows = Self {
                joints: Columns::new("joints", given.joints, shape, given.joint_stride, given.joint_type)?,
                weights: Columns::new(
                    "weights",
                    given.weights,
                    shape,
                    given.weight_stride,
                    given.weight_type,
                )?,
                vertex_count: vertices,
                influence_count: influences,
                starts,
            };
            rows.check_starts()?;
            Ok(rows)
        }
    }

    fn check_starts(&self) -> Outcome {
        let Some(starts) = &self.starts else { return Ok(()) };
        let mut before = 0;
        for (vertex, start) in starts.iter().enumerate() {
            if start < before || (vertex == 0 && start != 0) {
                return Err(Failure::input(format!(
                    "row_starts {vertex} is {start}, after {before}: the numbers rise from 0"
                ))
                .at(SDEF_ELEMENT_VERTEX, vertex));
            }
            before = start;
        }
        if before as usize != self.influence_count {
            return Err(Failure::input(format!(
                "row_starts ends at {before}, but influence_count is {}: give the same",
                self.influence_count
            )));
        }
        Ok(())
    }

    /// Where the influences of a vertex are: row, and first and last column.
    #[inline]
    fn row(&self, vertex: usize) -> (usize, std::ops::Range<usize>) {
        match &self.starts {
            Some(starts) => (0, starts.get(vertex) as usize..starts.get(vertex + 1) as usize),
            None => (vertex, 0..self.influence_count),
        }
    }

    fn read(&self) -> Outcome<Weights> {
        if self.vertex_count == 0 || self.influence_count == 0 {
            return Ok(Weights::default());
        }
        let mut starts = reserved(self.vertex_count + 1, "rows of weights")?;
        // Counted first: many of a fixed number of influences are 0.
        let mut count = 0usize;
        for vertex in 0..self.vertex_count {
            starts.push(count as u32);
            let (row, columns) = self.row(vertex);
            // SAFETY: the row lies within what was checked.
            count += columns.filter(|&column| unsafe { self.weights.weight(row, column) } != 0.0).count();
            if count > u32::MAX as usize {
                return Err(Failure::input("there are more than 4294967295 weights in one mesh: give fewer"));
            }
        }
        starts.push(count as u32);
        let mut entries = reserved(count, "weights")?;
        for vertex in 0..self.vertex_count {
            let (row, columns) = self.row(vertex);
            for column in columns {
                // SAFETY: the row lies within what was checked.
                let (joint, weight) =
                    unsafe { (self.joints.joint(row, column), self.weights.weight(row, column)) };
                if weight != 0.0 && entries.len() < count {
                    entries.push((joint, weight));
                }
            }
        }
        Ok(Weights::from_parts(starts, entries))
    }
}
