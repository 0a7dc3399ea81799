//! Normals and tangents after a deformation: turned by the Jacobian, never recomputed from faces.
//!
//! The field's own Jacobian holds the weights fixed, but weights change along the surface and that turns it too. So
//! the Jacobian is fitted to what happened to the triangles around each welded vertex; authored normals (faces of
//! drawn characters have edited ones) keep what was edited. Vertices at one place turn alike where they have one normal; where a
//! facet's edge is between them, each turns with its own facet, so that what is shaded flat stays flat.
//!
//! Vertices are taken in pieces, as many as fit a processor's nearest memory with the triangles around them: four
//! triangles side by side, then each vertex sums up what happens around it, and nothing is kept from piece to piece. A
//! triangle at a border is looked at by each of its pieces, in the order of the mesh, so that the pieces do not show.

use super::turn::{
    Four, LANES, Turn, Turns, columns_of, cross, dot, each_of, four_at, four_of, root, transposed,
};
use crate::geometry::weld::Weld;
use crate::geometry::{CellMap, Rows, bounds, by_number};
use glam::{BVec4A, DVec3, Mat3A, Vec3, Vec3A, Vec4};
use std::ops::Range;

/// Triangles of less than this share of their longest edge's square have no direction: rounding to 32 bits alone would
/// turn them.
const LEAST_AREA: f64 = 1e-10;
/// Vertices of a piece.
pub const PIECE: usize = 1024;
/// Vertices whose results are written together.
pub const BLOCK: usize = 256;
/// Triangles that are looked at together, and so the corners that they have at most.
const BATCH: usize = 256;
const CORNERS: usize = 1024;
const _: () = assert!(CORNERS >= 3 * BATCH && CORNERS.is_power_of_two() && BATCH.is_power_of_two());
/// The slot of corners that are no vertex of the piece.
const NO_SLOT: u16 = PIECE as u16;

/// What meshes are at rest, to fit Jacobians to what happens to them.
#[derive(Clone, Debug, Default)]
pub struct RestTriangles {
    pieces: Vec<Piece>,
    /// The pieces of each mesh.
    mesh_pieces: Vec<Range<usize>>,
    /// For each vertex which of its piece's sums are its own: vertices at one place share them.
    slots: Vec<u16>,
    /// From model units to edges of about 1, so that no unit is out of a float's range. A power of two, by which nothing is
    /// rounded: a mirrored mesh, wound the other way, may have another one.
    scale: f32,
}

/// Vertices that follow each other in a mesh, and the triangles around them: batch after batch, each list for itself, so that it is
/// read from end to end.
#[derive(Clone, Debug, Default)]
struct Piece {
    vertices: Range<usize>,
    batches: Vec<Batch>,
    corners: Vec<Corner>,
    /// By group, of each of its triangles' three corners which of the batch's it is.
    places: Vec<[[u16; LANES]; 3]>,
    groups: Vec<Group>,
    runs: Vec<Run>,
    /// Run after run, which of the batch's triangles are around the vertex, ascending.
    around: Vec<u16>,
}

/// Triangles around a piece's vertices, no more than there is room for: how much of the piece's lists is theirs.
#[derive(Clone, Copy, Debug)]
struct Batch {
    corners: usize,
    groups: usize,
    runs: usize,
}

/// How many of a batch's triangles are around the vertex of a slot.
#[derive(Clone, Copy, Debug)]
struct Run {
    slot: u16,
    count: u16,
}

/// A vertex of the figure, and where it is at rest: from the middle of all, so that nothing is lost far from the origin, scaled.
#[derive(Clone, Copy, Debug)]
struct Corner {
    vertex: u32,
    at: Vec3,
}

/// Four triangles that have an area; the last ones of a batch may have none.
#[derive(Clone, Debug, Default)]
struct Group {
    /// Rows by which the two edges after, and a normal, make up the gradient, by area; x, y and z of each. The normal's is by the
    /// root of the area, as it is multiplied by that of the area after.
    rows: [[Vec4; 3]; 3],
    /// Twice the triangles', 0 for none.
    areas: Vec4,
}

/// Four triangles after: edges from the first corner, their cross product, and what makes a normal of it that is as long as the
/// root of the area.
#[derive(Clone, Copy, Debug, Default)]
struct Edges {
    a: Four,
    b: Four,
    normal: Four,
    factor: Vec4,
}

/// Where vertices go: scale (p + stretch p + share d), up to a shift; a displacement d for each vertex.
#[derive(Clone, Copy, Debug)]
pub struct Moved<'a> {
    /// All displacements, model units.
    pub displacements: &'a [Vec3],
    /// How much of them.
    pub share: f32,
    /// How many times as large the whole becomes.
    pub size: f32,
}

/// Room to fit Jacobians in: one for each thread, whatever the number of pieces.
pub struct Room {
    /// By corner: where it is after.
    points: [Vec4; CORNERS],
    /// By group.
    edges: [Edges; BATCH / LANES],
    /// By triangle: the columns of its gradient times its area, and that area as the first one's w.
    gradients: [[Vec4; 3]; BATCH],
    /// By slot: the gradients around it, summed up.
    sums: [[Vec4; 3]; PIECE],
}

impl Default for Room {
    fn default() -> Self {
        Self {
            points: [Vec4::ZERO; CORNERS],
            edges: [Edges::default(); BATCH / LANES],
            gradients: [[Vec4::ZERO; 3]; BATCH],
            sums: [[Vec4::ZERO; 3]; PIECE],
        }
    }
}

/// The Jacobians of a piece's vertices: each fitted to the triangles around it, their mean by area.
struct Jacobians<'a> {
    sums: &'a [[Vec4; 3]; PIECE],
    slots: &'a [u16],
}

impl Jacobians<'_> {
    /// What the piece's vertex number `index` turns by; `None` where no triangle around it has an area, or their mean has
    /// lost its volume.
    fn of(&self, index: usize) -> Option<Turn> {
        let [x, y, z] = self.sums[usize::from(self.slots[index])];
        let by_area = x.w.recip();
        let column = |v: Vec4| Vec3A::from_vec4(v * by_area);
        let turn = Turn::of(Mat3A::from_cols(column(x), column(y), column(z)));
        (x.w > 0.0 && turn.has_volume()).then_some(turn)
    }

    /// The same of four vertices from `first` on, the last one again for those that are not there; and of which there is one.
    #[inline(always)]
    fn of_four(&self, first: usize) -> (Turns, BVec4A) {
        let sums = four_at(self.slots, first).map(|slot| &self.sums[usize::from(slot) & (PIECE - 1)]);
        let columns: [[Vec4; LANES]; 3] =
            std::array::from_fn(|column| transposed(sums.map(|sum| sum[column])));
        let area = columns[0][3];
        let by_area = Vec4::ONE / area;
        let turns = Turns::of(columns.map(|[x, y, z, _]| [x * by_area, y * by_area, z * by_area]));
        (turns, area.cmpgt(Vec4::ZERO) & turns.have_volume())
    }
}

impl RestTriangles {
    /// The triangles between `positions`, around the vertices that `weld` makes one.
    ///
    /// - `positions`: model space; those of a mesh follow each other.
    /// - `triangles`: no two of whose corners `weld` makes one.
    /// - `mesh_starts`: where each mesh's vertices start; one more than there are meshes.
    pub fn of(positions: &[Vec3], triangles: &[[u32; 3]], mesh_starts: &[usize], weld: &Weld) -> Self {
        let has_area = |&corners: &[u32; 3]| {
            let (a, b) = edges(positions, corners);
            let longest = a.length_squared().max(b.length_squared()).max((b - a).length_squared());
            a.cross(b).length() > LEAST_AREA * longest
        };
        let mut triangles: Vec<[u32; 3]> = triangles.iter().copied().filter(has_area).collect();
        let total: f64 = triangles.iter().map(|&corners| edges(positions, corners).0.length()).sum();
        let scale = 2f64.powi((triangles.len() as f64 / total).log2().round() as i32);
        // Of triangles at one place (copies, both faces of a sheet) the first stands for all: with each in every piece that has
        // one, copies would take memory by the square of their number.
        let mut places = CellMap::with_capacity_and_hasher(triangles.len(), Default::default());
        triangles.retain(move |&corners| {
            let mut place = weld.triangle(corners);
            place.sort_unstable();
            places.insert(place, ()).is_none()
        });
        let corners = (0u32..).zip(&triangles);
        let corners =
            corners.flat_map(|(index, &corners)| weld.triangle(corners).map(|corner| (corner, index)));
        let around = by_number(weld.count, corners);
        let slots = vec![NO_SLOT; positions.len()];
        let mut rest = Self { slots, scale: scale as f32, ..Self::default() };
        let (low, high) = bounds(positions.iter().map(|p| p.as_dvec3()));
        let mut builder = Builder {
            positions,
            middle: (low + high) / 2.0,
            triangles: &triangles,
            around,
            seen: vec![u32::MAX; triangles.len()],
            scale,
            weld,
            slots: vec![NO_SLOT; weld.count],
            corners: vec![u16::MAX; positions.len()],
        };
        for mesh in mesh_starts.windows(2) {
            let first_piece = rest.pieces.len();
            for first in (mesh[0]..mesh[1]).step_by(PIECE) {
                builder.add(first..(first + PIECE).min(mesh[1]), &mut rest);
            }
            rest.mesh_pieces.push(first_piece..rest.pieces.len());
        }
        rest
    }

    /// How many pieces a mesh has.
    pub fn piece_count(&self, mesh: usize) -> usize {
        self.mesh_pieces[mesh].len()
    }

    /// What the directions of all of a mesh's vertices turn by.
    ///
    /// `of_field`: for a vertex that has no Jacobian.
    pub fn turns(&self, mesh: usize, moved: &Moved, of_field: impl Fn(usize) -> Turn) -> Vec<Turn> {
        let pieces = &self.pieces[self.mesh_pieces[mesh].clone()];
        let mut room = Room::default();
        let mut turns = Vec::with_capacity(pieces.iter().map(|piece| piece.vertices.len()).sum());
        for piece in pieces {
            let jacobians = self.jacobians(piece, moved, &mut room);
            let of = |(index, vertex)| jacobians.of(index).unwrap_or_else(|| of_field(vertex));
            turns.extend(piece.vertices.clone().enumerate().map(of));
        }
        turns
    }

    /// Writes what normals and tangents of some of a mesh's pieces turn into, block by block: how many of their vertices come
    /// before it, and both, none of a kind that is not there.
    ///
    /// - `of_field`: for a vertex that has no Jacobian.
    /// - `normals`, `tangents`: of all of the mesh.
    pub fn turn(
        &self,
        (mesh, pieces): (usize, Range<usize>),
        moved: &Moved,
        of_field: impl Fn(usize) -> Turn,
        (normals, tangents): (&[Vec3], &[Vec4]),
        room: &mut Room,
        mut write: impl FnMut(usize, &[Vec3], &[Vec4]),
    ) {
        let of_mesh = &self.pieces[self.mesh_pieces[mesh].clone()];
        let first = pieces.start * PIECE;
        let mut block = Directions { normals: [Vec3::ZERO; BLOCK], tangents: [Vec4::ZERO; BLOCK] };
        for (at, piece) in (first..).step_by(PIECE).zip(&of_mesh[pieces]) {
            let jacobians = self.jacobians(piece, moved, room);
            for from in (0..piece.vertices.len()).step_by(BLOCK) {
                let in_mesh = at + from..at + piece.vertices.len().min(from + BLOCK);
                let normals = normals.get(in_mesh.clone()).unwrap_or_default();
                let tangents = tangents.get(in_mesh).unwrap_or_default();
                let of_field = |index| of_field(piece.vertices.start + from + index);
                let (normals, tangents) = block.turn(&jacobians, from, normals, tangents, of_field);
                write(at - first + from, normals, tangents);
            }
        }
    }

    /// What happens around each vertex of a piece.
    ///
    /// The deformation gradients of the triangles' edges, with the normal as third axis scaled by the root of the change of
    /// area, so that a uniform scaling is fitted exactly.
    fn jacobians<'a>(&'a self, piece: &Piece, moved: &Moved, room: &'a mut Room) -> Jacobians<'a> {
        let Piece { vertices, batches, corners, places, groups, runs, around } = piece;
        let (mut corners, mut places, mut groups, mut runs, mut around) =
            (&corners[..], &places[..], &groups[..], &runs[..], &around[..]);
        room.sums.fill([Vec4::ZERO; 3]);
        let (size, share) = (moved.size, self.scale * moved.share);
        for batch in batches {
            for (point, corner) in room.points.iter_mut().zip(first(&mut corners, batch.corners)) {
                let displacement = moved.displacements[corner.vertex as usize];
                *point = size * corner.at.extend(0.0) + share * displacement.extend(0.0);
            }
            let room_of_edges = &mut room.edges[..batch.groups];
            for (corners, to) in first(&mut places, batch.groups).iter().zip(&mut *room_of_edges) {
                *to = edges_after(corners, &room.points);
            }
            // Roots take long, but many may be on their way.
            for edges in &mut *room_of_edges {
                let area = root(edges.factor);
                edges.factor = root(area) / area;
            }
            let (fours, _) = room.gradients.as_chunks_mut();
            let groups = first(&mut groups, batch.groups);
            for ((group, edges), gradients) in groups.iter().zip(room_of_edges).zip(fours) {
                *gradients = group.gradients(edges);
            }
            for run in first(&mut runs, batch.runs) {
                let sum = &mut room.sums[usize::from(run.slot) & (PIECE - 1)];
                let [mut x, mut y, mut z] = *sum;
                for &triangle in first(&mut around, run.count.into()) {
                    let gradient = &room.gradients[usize::from(triangle) & (BATCH - 1)];
                    x += gradient[0];
                    y += gradient[1];
                    z += gradient[2];
                }
                *sum = [x, y, z];
            }
        }
        Jacobians { sums: &room.sums, slots: &self.slots[vertices.clone()] }
    }
}

/// Directions that are written together.
struct Directions {
    normals: [Vec3; BLOCK],
    tangents: [Vec4; BLOCK],
}

impl Directions {
    /// Turns those of the vertices of a piece that follow `from`, none of a kind that is not there.
    ///
    /// `of_field`: for a vertex that has no Jacobian.
    fn turn(
        &mut self,
        jacobians: &Jacobians,
        from: usize,
        normals: &[Vec3],
        tangents: &[Vec4],
        of_field: impl Fn(usize) -> Turn,
    ) -> (&[Vec3], &[Vec4]) {
        let count = normals.len().max(tangents.len());
        for four in (0..count).step_by(LANES) {
            let (turns, are_sound) = jacobians.of_four(from + four);
            let new = (!normals.is_empty()).then(|| turns.normals(four_of(four_at(normals, four))));
            if let Some(new) = new {
                let to = each_of(new, Vec4::ZERO).map(Vec4::truncate);
                self.normals[four..four + LANES].copy_from_slice(&to);
            }
            if !tangents.is_empty() {
                let [x, y, z, sides] = transposed(four_at(tangents, four));
                let to = each_of(turns.tangents([x, y, z], new), sides);
                self.tangents[four..four + LANES].copy_from_slice(&to);
            }
            if !are_sound.all() {
                for index in (four..count.min(four + LANES)).filter(|index| !are_sound.test(index - four)) {
                    self.turn_one(index, &of_field(index), normals, tangents);
                }
            }
        }
        (&self.normals[..normals.len()], &self.tangents[..tangents.len()])
    }

    /// Turns those of one vertex.
    fn turn_one(&mut self, index: usize, turn: &Turn, normals: &[Vec3], tangents: &[Vec4]) {
        let normal = normals.get(index).map(|&normal| turn.normal(normal));
        self.normals[index] = normal.unwrap_or_default();
        if let Some(tangent) = tangents.get(index) {
            self.tangents[index] = turn.tangent(tangent.truncate(), normal).extend(tangent.w);
        }
    }
}

/// The first `count` of what is left of a list.
fn first<'a, T>(left: &mut &'a [T], count: usize) -> &'a [T] {
    let (first, rest) = left.split_at(count);
    *left = rest;
    first
}

/// The edges after of triangles with these corners, `factor` the square of their cross product.
#[inline(always)]
fn edges_after(corners: &[[u16; LANES]; 3], points: &[Vec4; CORNERS]) -> Edges {
    let point = |corner: usize, lane: usize| points[usize::from(corners[corner][lane]) & (CORNERS - 1)];
    let first: [Vec4; LANES] = std::array::from_fn(|lane| point(0, lane));
    let edge = |corner: usize| {
        let [x, y, z, _] = transposed(std::array::from_fn(|lane| point(corner, lane) - first[lane]));
        [x, y, z]
    };
    let (a, b) = (edge(1), edge(2));
    let normal = cross(a, b);
    Edges { a, b, normal, factor: dot(normal, normal) }
}

impl Group {
    /// The triangles' gradients, as [`Room::gradients`] has them.
    #[inline(always)]
    fn gradients(&self, Edges { a, b, normal, factor }: &Edges) -> [[Vec4; 3]; LANES] {
        let [rows_a, rows_b, rows_n] = &self.rows;
        let normal = normal.map(|v| v * *factor);
        let columns: [Four; 3] = std::array::from_fn(|column| {
            std::array::from_fn(|axis| {
                a[axis] * rows_a[column] + b[axis] * rows_b[column] + normal[axis] * rows_n[column]
            })
        });
        let mut gradients = columns_of(columns, self.areas);
        // A triangle that has lost its area says nothing.
        let counts = factor.cmpgt(Vec4::ZERO) & factor.cmplt(Vec4::INFINITY);
        if !counts.all() {
            for lane in (0..LANES).filter(|&lane| !counts.test(lane)) {
                gradients[lane] = [Vec4::ZERO; 3];
            }
        }
        gradients
    }
}

/// From a triangle's first corner to the others.
fn edges(points: &[Vec3], [a, b, c]: [u32; 3]) -> (DVec3, DVec3) {
    let [a, b, c] = [a, b, c].map(|corner| points[corner as usize].as_dvec3());
    (b - a, c - a)
}

/// What pieces are made of.
struct Builder<'a> {
    positions: &'a [Vec3],
    middle: DVec3,
    triangles: &'a [[u32; 3]],
    /// The triangles around each welded vertex, ascending.
    around: Rows<u32>,
    /// By triangle, the last piece that has it.
    seen: Vec<u32>,
    scale: f64,
    weld: &'a Weld,
    /// By welded vertex its slot in the piece, by vertex its corner in the batch, while these are made.
    slots: Vec<u16>,
    corners: Vec<u16>,
}

impl Builder<'_> {
    fn add(&mut self, vertices: Range<usize>, rest: &mut RestTriangles) {
        let mut count = 0;
        let piece = rest.pieces.len() as u32;
        let mut triangles = Vec::new();
        for vertex in vertices.clone() {
            let welded = self.weld.representative[vertex] as usize;
            let slot = &mut self.slots[welded];
            if *slot == NO_SLOT {
                *slot = count;
                count += 1;
                for &triangle in self.around.of(welded) {
                    if std::mem::replace(&mut self.seen[triangle as usize], piece) != piece {
                        triangles.push(triangle);
                    }
                }
            }
            rest.slots[vertex] = *slot;
        }
        triangles.sort_unstable();
        let count = triangles.chunks(BATCH).map(|batch| batch.len().div_ceil(LANES)).sum();
        let mut of_piece = Piece { vertices: vertices.clone(), ..Piece::default() };
        of_piece.groups.reserve_exact(count);
        of_piece.places.reserve_exact(count);
        triangles.chunks(BATCH).for_each(|triangles| self.batch(triangles, &mut of_piece));
        for vertex in vertices {
            self.slots[self.weld.representative[vertex] as usize] = NO_SLOT;
        }
        of_piece.corners.shrink_to_fit();
        of_piece.runs.shrink_to_fit();
        of_piece.around.shrink_to_fit();
        rest.pieces.push(of_piece);
    }

    fn batch(&mut self, triangles: &[u32], piece: &mut Piece) {
        let count = triangles.len().div_ceil(LANES);
        let before =
            Batch { corners: piece.corners.len(), groups: piece.groups.len(), runs: piece.runs.len() };
        piece.groups.resize(before.groups + count, Group::default());
        piece.places.resize(before.groups + count, Default::default());
        // Slots and the triangles around them, as one number each, which is sorted faster than two.
        let mut around: Vec<u32> = Vec::with_capacity(3 * triangles.len());
        for (number, &triangle) in triangles.iter().enumerate() {
            let (group, lane) = (before.groups + number / LANES, number % LANES);
            let of_triangle = self.triangles[triangle as usize];
            for (corner, &vertex) in of_triangle.iter().enumerate() {
                let of_batch = &mut self.corners[vertex as usize];
                if *of_batch == u16::MAX {
                    *of_batch = (piece.corners.len() - before.corners) as u16;
                    let at = self.positions[vertex as usize].as_dvec3() - self.middle;
                    piece.corners.push(Corner { vertex, at: (self.scale * at).as_vec3() });
                }
                piece.places[group][corner][lane] = *of_batch;
                let slot = self.slots[self.weld.representative[vertex as usize] as usize];
                if slot != NO_SLOT {
                    around.push((u32::from(slot) << 16) | number as u32);
                }
            }
            let (rows, area) = self.rows(of_triangle);
            let group = &mut piece.groups[group];
            group.areas[lane] = area;
            for (row, of_group) in rows.iter().zip(&mut group.rows) {
                for (axis, lanes) in of_group.iter_mut().enumerate() {
                    lanes[lane] = row[axis];
                }
            }
        }
        for corner in &piece.corners[before.corners..] {
            self.corners[corner.vertex as usize] = u16::MAX;
        }
        around.sort_unstable();
        let run = |of_slot: &[u32]| Run { slot: (of_slot[0] >> 16) as u16, count: of_slot.len() as u16 };
        piece.runs.extend(around.chunk_by(|a, b| a >> 16 == b >> 16).map(run));
        piece.around.extend(around.iter().map(|&at| at as u16));
        piece.batches.push(Batch {
            corners: piece.corners.len() - before.corners,
            groups: count,
            runs: piece.runs.len() - before.runs,
        });
    }

    /// See [`Group::rows`]; and twice the area.
    fn rows(&self, corners: [u32; 3]) -> ([Vec3; 3], f32) {
        let (a, b) = edges(self.positions, corners);
        let (a, b) = (a * self.scale, b * self.scale);
        let cross = a.cross(b);
        let area = cross.length();
        let normal = cross / area;
        let rows = [b.cross(normal), normal.cross(a), area.sqrt() * normal].map(|row| row.as_vec3());
        (rows, area as f32)
    }
}
