//! Clothes as they are worn: what lies over the body at rest, how far from it, and which sheet of cloth over which.

use super::outside::{Outside, rims, volume};
use crate::character::MeshKind;
use crate::geometry::{
    NONE, Neighbours, Surface, Tree, Weld, WindingGroups, components, distinct, marked, neighbours, slots,
};
use crate::parallel;
use crate::shape::figure::Figure;
use crate::shape::pose::{Pose, posed};
use glam::DVec3;

/// What is of no known kind is worn where the body lies under it nearer than this, a share of H: 5 cm on an adult, a coat. D32.
const WORN_REACH: f64 = 0.03;
/// Under more than this share of its places. A majority: an arm is near the chest at its shoulder alone. D32.
const WORN_SHARE: f64 = 0.5;
/// Sheets of cloth further apart than this, a share of H, do not meet when one is pushed: most pushes are shorter. D32.
const SHEET_REACH: f64 = 0.02;
/// A sheet's own vertices are no sheet under it: hits nearer than this share of the way to the body are its own.
const OWN_SHEET: f64 = 1e-4;

/// A place on a sheet of cloth that lies under a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Under {
    /// Corners of its triangle, as [`Worn::places`] counts.
    pub corners: [u32; 3],
    /// Where it is in there: at least 0, sum 1.
    pub barycentric: [f64; 3],
}

/// Clothes and the body under them, at rest.
#[derive(Clone, Debug, Default)]
pub struct Worn {
    /// Triangles of the body.
    pub body: Vec<[u32; 3]>,
    /// Where the body's surface ends.
    pub rims: Vec<u32>,
    /// 1, or -1 for a body that is wound to look inwards, as mirrored ones are.
    pub outwards: f64,
    /// The welded vertices of the clothes; what follows counts by their order.
    pub places: Vec<u32>,
    /// One vertex at each place.
    pub vertices: Vec<u32>,
    /// Triangles of the clothes.
    pub triangles: Vec<[u32; 3]>,
    /// Along the edges of the clothes.
    pub around: Neighbours,
    /// How far outside of the body each place is: not a number where there is no inside, below 0 inside.
    pub distances: Vec<f64>,
    /// The sheet under each place.
    pub under: Vec<Option<Under>>,
    /// True for places where cloth and body are one: they stay.
    pub is_sewn: Vec<bool>,
    /// The body's triangle that each place is nearest to at rest, and is near to when all has moved.
    pub nearest: Vec<u32>,
    /// The body's.
    tree: Tree,
}

impl Worn {
    /// What there is at rest.
    ///
    /// Garments are worn; what is of no known kind is too, where other meshes are known to be the body and it lies over
    /// them.
    ///
    /// - `is_known`: for each vertex whether its kind was given or read from its name.
    pub fn of(figure: &Figure, is_known: impl Fn(usize) -> bool, weld: &Weld, threads: usize) -> Self {
        let body_is_known = (0..figure.positions.len())
            .any(|vertex| figure.kind(vertex) == MeshKind::Body && is_known(vertex));
        let of_kind = |kind: MeshKind| {
            figure.triangles.iter().copied().filter(move |&[first, ..]| figure.kind(first as usize) == kind)
        };
        let mut cloth: Vec<[u32; 3]> = of_kind(MeshKind::Garment).collect();
        let (perhaps, mut body): (Vec<[u32; 3]>, Vec<[u32; 3]>) =
            of_kind(MeshKind::Body).partition(|&[first, ..]| body_is_known && !is_known(first as usize));
        if body.is_empty() || (cloth.is_empty() && perhaps.is_empty()) {
            return Self::default();
        }
        let outwards = if volume(&figure.positions, &body) < 0.0 { -1.0 } else { 1.0 };
        // Of what is perhaps cloth the rest is body too.
        if !perhaps.is_empty() {
            let rims = rims(&body, weld);
            let outside = Outside::new(&figure.positions, &body, &rims, weld, outwards, None);
            let (over, beside) = lying_over(figure, &outside, perhaps, weld, threads);
            cloth.extend(over);
            body.extend(beside);
        }
        if cloth.is_empty() {
            return Self::default();
        }
        Self::over(figure, body, outwards, cloth, SHEET_REACH, weld, threads)
    }

    /// The outside of the body where all vertices are at `points`.
    pub fn outside<'a>(&'a self, points: &[DVec3], weld: &'a Weld) -> Outside<'a> {
        Outside::new(points, &self.body, &self.rims, weld, self.outwards, Some(&self.tree))
    }

    /// For each of `poses` the share of all places that went through the body's surface: inside of it in the figure `after`, and not in
    /// the figure `before`, of which all this was found.
    pub fn newly_inside<const N: usize>(
        &self,
        before: &Figure,
        after: &Figure,
        poses: [Pose; N],
        threads: usize,
    ) -> [f64; N] {
        let groups = WindingGroups::new(&before.positions, &self.body);
        let around = |figure: &Figure, pose: Pose, places: &[u32]| {
            if places.is_empty() {
                return Vec::new();
            }
            let points = posed(figure, pose);
            let winding = groups.between(&points);
            parallel::collect(threads, places.len(), parallel::FEW_RAYS, |index| {
                self.outwards * winding.at(points[self.vertices[places[index] as usize] as usize])
            })
        };
        let loose = (0..).zip(&self.is_sewn).filter(|(_, is_sewn)| !**is_sewn).map(|(place, _)| place);
        let loose: Vec<u32> = loose.collect();
        poses.map(|pose| {
            let now = loose.iter().copied().zip(around(after, pose, &loose));
            let (places, now): (Vec<u32>, Vec<f64>) = now.filter(|(_, winding)| *winding > 0.5).unzip();
            // What goes through a surface changes by 1, however many holes that has; what is beside a hole, bit by bit.
            let went = now.iter().zip(around(before, pose, &places)).filter(|(now, was)| *now - was > 0.5);
            went.count() as f64 / self.places.len() as f64
        })
    }

    /// `body`, which looks outwards or, at -1, inwards, and `cloth` over it, whose own sheets meet where they are no further
    /// apart than `reach`, a share of H.
    pub fn over(
        figure: &Figure,
        body: Vec<[u32; 3]>,
        outwards: f64,
        cloth: Vec<[u32; 3]>,
        reach: f64,
        weld: &Weld,
        threads: usize,
    ) -> Self {
        let rims = rims(&body, weld);
        let outside = Outside::new(&figure.positions, &body, &rims, weld, outwards, None);
        // By number, so that the order of a triangle's corners, which a mirrored mesh may have turned, changes nothing.
        let mut first = vec![NONE; weld.count];
        for &vertex in cloth.iter().flatten() {
            let first = &mut first[weld.representative[vertex as usize] as usize];
            *first = vertex.min(*first);
        }
        let firsts = (0..).zip(first).filter(|&(_, vertex)| vertex != NONE);
        let (places, vertices): (Vec<u32>, Vec<u32>) = firsts.unzip();
        let index_of = slots(weld.count, &places);
        let triangles: Vec<[u32; 3]> = cloth
            .iter()
            .map(|&corners| weld.triangle(corners).map(|place| index_of[place as usize]))
            .collect();
        let around = neighbours(&triangles, &Weld::alone(places.len()));
        let of_body = body.iter().flatten().map(|&v| index_of[weld.representative[v as usize] as usize]);
        let is_sewn =
            marked(places.len(), of_body.filter(|&index| index != NONE).map(|index| index as usize));
        let points: Vec<DVec3> = vertices.iter().map(|&vertex| figure.positions[vertex as usize]).collect();
        let sheets = Surface::new(&points, &triangles);
        let reach = reach * figure.height();
        let find = |index: usize| {
            let p = points[index];
            let Some((closest, distance, _)) = outside.at(p, None) else {
                return (f64::NAN, None, NONE);
            };
            let nearest = closest.triangle as u32;
            if distance <= 0.0 {
                return (distance, None, nearest);
            }
            let way = closest.point - p;
            let hits = if reach > 0.0 { sheets.all_hits(p, way) } else { Vec::new() };
            let hit = hits.into_iter().find(|hit| {
                hit.t > OWN_SHEET && hit.t <= 1.0 && !triangles[hit.triangle].contains(&(index as u32))
            });
            let under = hit.filter(|hit| hit.t * closest.distance < reach).map(|hit| Under {
                corners: triangles[hit.triangle],
                barycentric: [1.0 - hit.u - hit.v, hit.u, hit.v],
            });
            (distance, under, nearest)
        };
        let found = parallel::collect(threads, points.len(), parallel::FEW_RAYS, find);
        let (distances, under, nearest) = found.into_iter().collect();
        let tree = outside.tree();
        Self {
            body,
            rims,
            outwards,
            places,
            vertices,
            triangles,
            around,
            distances,
            under,
            is_sewn,
            nearest,
            tree,
        }
    }
}

/// `triangles` by component: those of components that lie over the body, with body under over half of their places, and the
/// others.
fn lying_over(
    figure: &Figure,
    outside: &Outside,
    mut triangles: Vec<[u32; 3]>,
    weld: &Weld,
    threads: usize,
) -> (Vec<[u32; 3]>, Vec<[u32; 3]>) {
    let component = components(&triangles, weld);
    let of = |corners: &[u32; 3]| component[weld.representative[corners[0] as usize] as usize] as usize;
    let places = distinct(triangles.iter().flat_map(|&corners| weld.triangle(corners)));
    let first = weld.first_vertices();
    let reach = WORN_REACH * figure.height();
    let lies = parallel::collect(threads, places.len(), parallel::FEW_RAYS, |index| {
        let p = figure.positions[first[places[index] as usize] as usize];
        outside.at(p, None).is_some_and(|(closest, distance, _)| distance > 0.0 && closest.distance < reach)
    });
    let mut counts = vec![(0u32, 0u32); weld.count];
    for (&place, &lies) in places.iter().zip(&lies) {
        let (all, over) = &mut counts[component[place as usize] as usize];
        *all += 1;
        *over += u32::from(lies);
    }
    triangles.sort_by_key(of);
    triangles.into_iter().partition(|corners| {
        let (all, over) = counts[of(corners)];
        f64::from(over) > WORN_SHARE * f64::from(all)
    })
}
