//! Vertices that share a position: seam copies become one, so that a mesh can be walked along its surface.

use super::NONE;
use super::cells::CellMap;
use super::groups::{Groups, Rows, by_number};
use super::lists::marked;
use super::whole::floor;
use glam::{DVec3, Vec3};

/// Vertices this near are one, as a part of the figure's height: exporters split vertices along seams, and rounding to
/// floats far from the origin moves the copies apart by less. Seen: ±30 % moves no vertex.
pub const SEAM: f64 = 1e-6;

/// The cosine of the angle, 2.6 degrees, above which two normals at one place are of two facets: those of seams differ by rounding, to
/// 8 bits by .5 degrees, and edges that are flatter are not seen.
const FACET: f32 = 0.999;

/// Which vertices share a position.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Weld {
    /// For each vertex the welded vertex that it belongs to; numbered in order of first appearance.
    pub representative: Vec<u32>,
    /// The number of welded vertices.
    pub count: usize,
}

impl Weld {
    /// Of `count` vertices of which no two are one.
    pub fn alone(count: usize) -> Self {
        Self { representative: (0..count as u32).collect(), count }
    }

    /// The same, but vertices at one place are apart where a facet's edge is between them: their `normals`, of unit length or 0, are
    /// further apart than 2.6 degrees. Each belongs with the first that is not; what has no normal, with the first of all.
    ///
    /// O(vertices), times how many facets meet at a place.
    pub fn parted(&self, normals: &[Vec3]) -> Self {
        let mut representative = Vec::with_capacity(normals.len());
        // A normal of each facet, and the facet before it at its place.
        let mut facets: Vec<(Vec3, u32)> = Vec::new();
        let mut last = vec![NONE; self.count];
        for (&welded, &normal) in self.representative.iter().zip(normals) {
            let last = &mut last[welded as usize];
            // The first that it may belong with: equal normals belong together, whatever comes between.
            let (mut facet, mut next) = (NONE, *last);
            while next != NONE {
                let (other, before) = facets[next as usize];
                if normal.dot(other) >= FACET * normal.length_squared() * other.length_squared() {
                    facet = next;
                }
                next = before;
            }
            if facet == NONE {
                facet = facets.len() as u32;
                facets.push((normal, std::mem::replace(last, facet)));
            }
            representative.push(facet);
        }
        Self { representative, count: facets.len() }
    }

    /// For each welded vertex the first vertex that belongs to it.
    pub fn first_vertices(&self) -> Vec<u32> {
        let mut first = Vec::with_capacity(self.count);
        for (vertex, &welded) in self.representative.iter().enumerate() {
            if welded as usize == first.len() {
                first.push(vertex as u32);
            }
        }
        first
    }

    /// For each welded vertex whether any that belongs to it is `chosen`.
    pub fn any(&self, chosen: &[bool]) -> Vec<bool> {
        let these = self.representative.iter().zip(chosen).filter(|(_, is_chosen)| **is_chosen);
        marked(self.count, these.map(|(&welded, _)| welded as usize))
    }

    /// The same triangle between welded vertices.
    pub fn triangle(&self, corners: [u32; 3]) -> [u32; 3] {
        corners.map(|vertex| self.representative[vertex as usize])
    }
}

/// Welds vertices that lie within `tolerance` (model units, 0 or more) of each other.
///
/// Vertices are taken in order: each joins the nearest earlier welded vertex within `tolerance` of that one's
/// *first* vertex, or begins a new one. So no chain of near vertices drifts together: a vertex is never further than
/// `tolerance` from the first vertex of its group. A tolerance of 0 welds equal positions.
///
/// O(vertices).
pub fn weld(positions: &[DVec3], tolerance: f64) -> Weld {
    // Cells of so many times the tolerance that what is in reach mostly lies in one.
    let cell_size = 8.0 * tolerance;
    let cell_of = |p: DVec3| -> [i64; 3] {
        if tolerance > 0.0 {
            (p / cell_size).to_array().map(|x| floor(x) as i64)
        } else {
            // + 0.0 makes -0 equal to 0.
            p.to_array().map(|x| (x + 0.0).to_bits() as i64)
        }
    };
    let mut cells: CellMap<[i64; 3], u32> =
        CellMap::with_capacity_and_hasher(positions.len(), Default::default());
    // Welded vertices of one cell are chained.
    let mut next_in_cell: Vec<Option<u32>> = Vec::new();
    let mut first: Vec<DVec3> = Vec::new();
    let mut representative = Vec::with_capacity(positions.len());
    for &p in positions {
        let low = cell_of(p - DVec3::splat(tolerance));
        let high = cell_of(p + DVec3::splat(tolerance));
        let mut best: Option<(f64, u32)> = None;
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut current = cells.get(&[x, y, z]).copied();
                    while let Some(welded) = current {
                        let distance = p.distance(first[welded as usize]);
                        let nearer = best.is_none_or(|(least, other)| (distance, welded) < (least, other));
                        if distance <= tolerance && nearer {
                            best = Some((distance, welded));
                        }
                        current = next_in_cell[welded as usize];
                    }
                }
            }
        }
        let welded = best.map_or(first.len() as u32, |(_, welded)| welded);
        if best.is_none() {
            first.push(p);
            next_in_cell.push(cells.insert(cell_of(p), welded));
        }
        representative.push(welded);
    }
    Weld { representative, count: first.len() }
}

/// For each welded vertex the number of its connected component: what triangles join is one component.
///
/// Components are numbered in order of their first welded vertex; a vertex in no triangle is a component of its own.
pub fn components(triangles: &[[u32; 3]], weld: &Weld) -> Vec<u32> {
    let mut groups = Groups::new(weld.count);
    for &corners in triangles {
        let [a, b, c] = weld.triangle(corners).map(|vertex| vertex as usize);
        groups.join(a, b);
        groups.join(a, c);
    }
    // The least vertex of a component comes first.
    let mut component_count = 0;
    let mut components = vec![0; weld.count];
    for vertex in 0..weld.count {
        let least = groups.least(vertex);
        components[vertex] = if least == vertex { component_count } else { components[least] };
        component_count += u32::from(least == vertex);
    }
    components
}

/// Where a surface ends: the edges between welded vertices that one triangle has, ascending.
pub fn rim_edges(triangles: &[[u32; 3]], weld: &Weld) -> Vec<[u32; 2]> {
    let edges_of = |&corners: &[u32; 3]| {
        let [a, b, c] = weld.triangle(corners);
        [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
    };
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(edges_of).collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect()
}

/// The neighbours of every welded vertex along edges: ascending, without repeats and without the vertex itself.
pub type Neighbours = Rows<u32>;

/// Which welded vertices share an edge with which.
pub fn neighbours(triangles: &[[u32; 3]], weld: &Weld) -> Neighbours {
    // With repeats first: most edges have two triangles.
    let both_ways = triangles.iter().flat_map(|&corners| {
        let [a, b, c] = weld.triangle(corners);
        [(a, b), (b, c), (c, a), (b, a), (c, b), (a, c)]
    });
    let mut all = by_number(weld.count, both_ways.filter(|(one, other)| one != other));
    let mut around = Neighbours { starts: vec![0], things: Vec::with_capacity(all.things.len() / 2) };
    for vertex in 0..weld.count {
        let row = all.of_mut(vertex);
        row.sort_unstable();
        around.things.extend(row.chunk_by(|one, other| one == other).map(|same| same[0]));
        around.starts.push(around.things.len() as u32);
    }
    around
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seam_copies_become_one_vertex() {
        let a = DVec3::new(0.1, 0.2, 0.3);
        let b = DVec3::new(-0.0, 1.0, 0.0);
        let welded = weld(&[a, b, a, DVec3::new(0.0, 1.0, 0.0), b], 0.0);
        assert_eq!(welded.representative, [0, 1, 0, 1, 1]);
        assert_eq!(welded.count, 2);
        assert_eq!(welded.first_vertices(), [0, 1]);
    }

    #[test]
    fn facets_are_parted_and_seams_are_not() {
        let place = |x: f64| DVec3::new(x, 0.0, 0.0);
        let welded = weld(&[place(0.0), place(0.0), place(1.0), place(0.0), place(0.0), place(1.0)], 0.0);
        let near = Vec3::new(0.01, 1.0, 0.0).normalize();
        let parted = welded.parted(&[Vec3::Y, Vec3::X, Vec3::X, near, Vec3::X, Vec3::ZERO]);
        assert_eq!((&parted.representative[..], parted.count), (&[0, 1, 2, 0, 1, 2][..], 3));
        // Without normals nothing is.
        assert_eq!(welded.parted(&[Vec3::ZERO; 6]), welded);
    }

    #[test]
    fn a_square_ends_at_its_sides_and_not_where_its_halves_meet() {
        // The halves have copies of the corners between them.
        let [a, b, c, d] =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let welded = weld(&[a, b, c, d, c, a], 0.0);
        let rims = rim_edges(&[[0, 1, 2], [3, 5, 4]], &welded);
        assert_eq!(rims, [[0, 1], [0, 3], [1, 2], [2, 3]]);
    }

    #[test]
    fn near_vertices_weld_across_the_borders_of_cells() {
        let tolerance = 1e-3;
        for corner in [0.0, 0.002, 0.5, -0.25, 7.0] {
            let p = DVec3::splat(corner);
            for direction in [DVec3::X, DVec3::NEG_Y, DVec3::new(1.0, -1.0, 1.0).normalize()] {
                let near = weld(&[p, p + 0.99 * tolerance * direction], tolerance);
                assert_eq!(near.count, 1, "{p} {direction}");
                let far = weld(&[p, p + 1.01 * tolerance * direction], tolerance);
                assert_eq!(far.count, 2, "{p} {direction}");
            }
        }
    }

    #[test]
    fn a_chain_of_near_vertices_does_not_drift_together() {
        let chain: Vec<DVec3> = (0..100).map(|i| DVec3::X * 0.4 * f64::from(i)).collect();
        let welded = weld(&chain, 1.0);
        let first = welded.first_vertices();
        for (vertex, &group) in welded.representative.iter().enumerate() {
            assert!(chain[vertex].distance(chain[first[group as usize] as usize]) <= 1.0);
        }
        assert!(welded.count >= 20);
    }

    #[test]
    fn components_and_neighbours_follow_the_triangles() {
        // Two triangles that share an edge through seam copies, one triangle apart, one lone vertex.
        let positions: Vec<DVec3> = [
            [0., 0.],
            [1., 0.],
            [0., 1.],
            [1., 0.],
            [0., 1.],
            [1., 1.],
            [5., 0.],
            [6., 0.],
            [5., 1.],
            [9., 9.],
        ]
        .map(|[x, y]| DVec3::new(x, y, 0.0))
        .to_vec();
        let triangles = [[0, 1, 2], [3, 5, 4], [6, 7, 8]];
        let welded = weld(&positions, 1e-6);
        assert_eq!(welded.representative, [0, 1, 2, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(components(&triangles, &welded), [0, 0, 0, 0, 1, 1, 1, 2]);
        let around = neighbours(&triangles, &welded);
        assert_eq!(around.of(0), [1, 2]);
        assert_eq!(around.of(1), [0, 2, 3]);
        assert_eq!(around.of(7), [0; 0]);
    }
}
