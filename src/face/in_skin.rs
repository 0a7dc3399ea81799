//! Eyes that are part of the skin: balls whose rims are sewn to it, or spots painted on it.
//!
//! Both are believed only as a pair: two of the same size, mirrored, where eyes are. One wrong eye bends a face where it
//! should not, and is worse than eyes that are not found: of two pairs neither is believed.

use super::eyes::{Eye, Eyes, TWIN_ASIDE, TWIN_HEIGHT, TWIN_MOST, TWIN_WIDTH, are_plausible, opening};
use super::head::{Head, quantile};
use super::raster::DepthMap;
use crate::geometry::{Groups, bounds, double_area, weld};
use glam::{DVec2, DVec3};

/// A ball's rim: where the skin turns inwards by more than this cosine, 30 degrees.
const RIM: f64 = 0.866;
/// What a ball is as high as, in its widths.
const ROUND: std::ops::Range<f64> = 0.75..1.35;
/// A ball stands out by at least this part of its width, and its foremost point is no further from its middle than the
/// second.
const STANDS_OUT: (f64, f64) = (0.2, 0.25);
/// What lies off the sphere through a ball's vertices by more than this part of its radius, root mean square, is none; of
/// fewer vertices anything is a sphere.
const SPHERE: (f64, usize) = (0.1, 9);
/// The radius of that sphere, in its widths.
const SPHERE_RADIUS: std::ops::Range<f64> = 0.4..0.8;

/// Two balls whose rims are sewn to the face: where they bulge they have a crease around them.
pub fn by_balls(head: &Head) -> Option<Eyes> {
    let regions = regions(head);
    let balls: Vec<Spot> = regions.iter().filter_map(|triangles| ball(head, triangles)).collect();
    pair(&balls)
}

/// Triangles of the bare head in groups that no inward crease parts, small enough for an eye.
fn regions(head: &Head) -> Vec<Vec<[u32; 3]>> {
    // Only what lies where eyes are: a head of a scan has a hundred thousand triangles.
    let is_near = |corners: &&[u32; 3]| {
        corners.iter().all(|&corner| {
            let p = head.points[corner as usize];
            p.x.abs() < TWIN_ASIDE.end + TWIN_WIDTH.end
                && p.y > TWIN_HEIGHT.start - TWIN_MOST
                && p.y < TWIN_HEIGHT.end + TWIN_MOST
        })
    };
    let triangles: Vec<[u32; 3]> = head.bare.iter().filter(is_near).copied().collect();
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let points: Vec<DVec3> = used.iter().map(|&vertex| head.points[vertex as usize]).collect();
    let weld = weld(&points, head.parts.seam / head.frame.length);
    let place = |vertex: u32| {
        let own = used.binary_search(&vertex).expect("all are listed");
        weld.representative[own]
    };
    // Mirrored files wind triangles the other way: what is seen from the front looks there.
    let seen = (0..head.front.rows())
        .flat_map(|row| (0..head.front.columns()).filter_map(move |column| head.front.triangle(column, row)));
    let facing: f64 =
        seen.map(|triangle| double_area(&head.points, head.bare[triangle]).z.signum()).sum::<f64>().signum();
    let normals: Vec<DVec3> = triangles
        .iter()
        .map(|&corners| facing * double_area(&head.points, corners).normalize_or_zero())
        .collect();
    // (edge, triangle, its corner off the edge)
    let mut edges: Vec<([u32; 2], u32, u32)> = Vec::with_capacity(3 * triangles.len());
    for (index, corners) in triangles.iter().enumerate() {
        for turn in 0..3 {
            let [a, b, off] = [0, 1, 2].map(|corner| corners[(turn + corner) % 3]);
            let (a, b) = (place(a), place(b));
            edges.push(([a.min(b), a.max(b)], index as u32, off));
        }
    }
    edges.sort_unstable();
    let firsts = weld.first_vertices();
    let mut groups = Groups::new(triangles.len());
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        if let &[(_, one, _), (edge, other, off)] = same {
            let [n, m] = [one, other].map(|triangle| normals[triangle as usize]);
            let on_edge = points[firsts[edge[0] as usize] as usize];
            let rises = (head.points[off as usize] - on_edge).dot(n) > 0.0;
            if rises && n.dot(m) < RIM {
                continue;
            }
            groups.join(one as usize, other as usize);
        }
    }
    let mut found: Vec<Vec<[u32; 3]>> = vec![Vec::new(); triangles.len()];
    for (index, &corners) in triangles.iter().enumerate() {
        found[groups.least(index)].push(corners);
    }
    found.retain(|triangles| !triangles.is_empty());
    found
}

/// What may be an eye: where it is seen.
struct Spot {
    low: DVec2,
    high: DVec2,
    /// The depth of its foremost point.
    front: f64,
}

impl Spot {
    fn middle(&self) -> DVec2 {
        0.5 * (self.low + self.high)
    }

    fn extent(&self) -> DVec2 {
        self.high - self.low
    }

    /// True for one that is as large as an eye, and where one is.
    fn fits(&self, heights: &std::ops::Range<f64>) -> bool {
        let (extent, middle) = (self.extent(), self.middle());
        TWIN_WIDTH.contains(&extent.x)
            && heights.contains(&(extent.y / extent.x))
            && extent.y < TWIN_MOST
            && TWIN_ASIDE.contains(&middle.x.abs())
            && TWIN_HEIGHT.contains(&middle.y)
    }

    fn eye(&self) -> Eye {
        Eye { low: self.low.extend(self.front), high: self.high.extend(self.front), ball: None }
    }
}

/// The ball that `triangles` are, if they are one that is seen from the front.
fn ball(head: &Head, triangles: &[[u32; 3]]) -> Option<Spot> {
    let mut vertices: Vec<u32> = triangles.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let points: Vec<DVec3> = vertices.iter().map(|&vertex| head.points[vertex as usize]).collect();
    let (low, high) = bounds(points.iter().copied());
    let spot = Spot { low: low.truncate(), high: high.truncate(), front: high.z };
    if !spot.fits(&ROUND) {
        return None;
    }
    let firsts = weld(&points, head.parts.seam / head.frame.length).first_vertices();
    let points: Vec<DVec3> = firsts.iter().map(|&first| points[first as usize]).collect();
    let foremost = points.iter().copied().max_by(|a, b| a.z.total_cmp(&b.z))?;
    let width = spot.extent().x;
    let off = (foremost.truncate() - spot.middle()).abs().max_element();
    let stands_out = high.z - low.z > STANDS_OUT.0 * width && off < STANDS_OUT.1 * width;
    if points.len() < SPHERE.1 || !stands_out {
        return None;
    }
    let (centre, radius) = sphere(&points, spot.middle())?;
    let square_error: f64 = points.iter().map(|p| (p.distance(centre) - radius).powi(2)).sum();
    let error = (square_error / points.len() as f64).sqrt();
    if error > SPHERE.0 * radius || !SPHERE_RADIUS.contains(&(radius / width)) || centre.z > foremost.z {
        return None;
    }
    let (low, high) = opening(head, triangles, low, high)?;
    Some(Spot { low, high, ..spot }).filter(|spot| spot.fits(&ROUND))
}

/// The sphere nearest to `points` whose middle is seen at `middle`: |p - middle|^2 + z^2 = 2 z c + k, least squares.
fn sphere(points: &[DVec3], middle: DVec2) -> Option<(DVec3, f64)> {
    let count = points.len() as f64;
    let square = |p: &DVec3| (p.truncate() - middle).length_squared() + p.z * p.z;
    let mean = |of: &dyn Fn(&DVec3) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (z, s) = (mean(&|p| p.z), mean(&square));
    let spread = mean(&|p| (p.z - z) * (p.z - z));
    let centre = 0.5 * mean(&|p| (p.z - z) * (square(p) - s)) / spread;
    let radius = (s - 2.0 * centre * z + centre * centre).sqrt();
    (radius.is_finite() && radius > 0.0).then_some((middle.extend(centre), radius))
}

/// Mirrored to this part of their width: middles and ends.
const MIRRORED: f64 = 0.25;

/// The one pair of mirrored spots; `None` where there is none, or where a second one lies elsewhere.
fn pair(spots: &[Spot]) -> Option<Eyes> {
    let mut pairs: Vec<[&Spot; 2]> = Vec::new();
    for left in spots.iter().filter(|spot| spot.middle().x > 0.0) {
        for right in spots.iter().filter(|spot| spot.middle().x < 0.0) {
            let mirrored = DVec2::new(-right.middle().x, right.middle().y);
            let off = (left.middle() - mirrored).abs().max((left.extent() - right.extent()).abs());
            if off.max_element() < MIRRORED * left.extent().x.min(right.extent().x) {
                pairs.push([left, right]);
            }
        }
    }
    let area = |pair: &[&Spot; 2]| pair[0].extent().element_product();
    let largest = *pairs.iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
    let is_inside = |pair: &[&Spot; 2]| {
        let off = (pair[0].middle() - largest[0].middle()).abs();
        off.cmple(0.5 * largest[0].extent()).all()
    };
    pairs.iter().all(is_inside).then(|| largest.map(Spot::eye)).filter(are_plausible)
}

/// Squares of a look at a face that may be painted, in head lengths.
const SQUARE: f64 = 0.008;
/// Spots are looked for as what is darker, and what is lighter, than each of so many brightnesses.
const LEVELS: usize = 9;
/// Painted eyes are as high as this, in their widths: brows and mouths lie.
const PAINTED: std::ops::Range<f64> = 0.6..2.2;
/// A spot fills at least this part of its box, rows from end to end; an ellipse fills .79.
const FILLS: f64 = 0.6;
/// What lies around a spot is a margin of this part of its extent. Its brightness differs from the spot's by at least the
/// second number; at least the third part of it is as bright as the most of it, to the fourth.
const AROUND: (f64, f64, f64, f64) = (0.25, 0.25, 0.6, 0.1);

/// Two spots painted on the face: darker or lighter than the skin around them.
pub fn by_paint(head: &Head) -> Option<Eyes> {
    let reach = TWIN_ASIDE.end + 0.5 * TWIN_WIDTH.end;
    let low = DVec2::new(-reach, TWIN_HEIGHT.start - 0.5 * TWIN_MOST);
    let high = DVec2::new(reach, TWIN_HEIGHT.end + 0.5 * TWIN_MOST);
    let view = head.front_view(low, high, SQUARE);
    let (columns, rows) = (view.columns(), view.rows());
    let shade = |square: usize| {
        let (column, row) = (square % columns, square / columns);
        head.shade(head.bare[view.triangle(column, row)?], view.middle(column, row))
    };
    let shades: Vec<Option<f64>> = (0..columns * rows).map(shade).collect();
    if shades.iter().all(Option::is_none) {
        return None;
    }
    let mut spots = Vec::new();
    for level in 1..=LEVELS {
        let level = level as f64 / (LEVELS + 1) as f64;
        spots.extend(spots_of(&view, &shades, |shade| shade < level));
        spots.extend(spots_of(&view, &shades, |shade| shade > level));
    }
    pair(&spots)
}

/// Connected groups of squares whose brightness `marks` says that may be eyes.
fn spots_of(view: &DepthMap, shades: &[Option<f64>], marks: impl Fn(f64) -> bool) -> Vec<Spot> {
    let columns = view.columns();
    let is_marked = |square: usize| shades[square].is_some_and(&marks);
    let mut groups = Groups::new(shades.len());
    let marked = || (0..shades.len()).filter(|&square| is_marked(square));
    for square in marked() {
        if (square + 1) % columns != 0 && is_marked(square + 1) {
            groups.join(square, square + 1);
        }
        if square + columns < shades.len() && is_marked(square + columns) {
            groups.join(square, square + columns);
        }
    }
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); shades.len()];
    for square in marked() {
        members[groups.least(square)].push(square);
    }
    members.iter().filter_map(|members| spot(view, shades, members)).collect()
}

/// The spot that the squares `members` are, in ascending order, if it may be an eye.
fn spot(view: &DepthMap, shades: &[Option<f64>], members: &[usize]) -> Option<Spot> {
    let (columns, rows) = (view.columns(), view.rows());
    let (bottom, top) = (members.first()? / columns, members.last()? / columns);
    let column = members.iter().map(|square| square % columns);
    let (left, right) = (column.clone().min()?, column.max()?);
    let half = 0.5 * DVec2::splat(SQUARE);
    let depths = members.iter().filter_map(|square| view.depth(square % columns, square / columns));
    let spot = Spot {
        low: view.middle(left, bottom) - half,
        high: view.middle(right, top) + half,
        front: depths.fold(f64::NEG_INFINITY, f64::max),
    };
    if !spot.fits(&PAINTED) {
        return None;
    }
    let filled: usize = members
        .chunk_by(|a, b| a / columns == b / columns)
        .filter_map(|row| Some(row.last()? - row.first()? + 1))
        .sum();
    if (filled as f64) < FILLS * ((right - left + 1) * (top - bottom + 1)) as f64 {
        return None;
    }
    let margin = |from: usize, to: usize| (AROUND.0 * (to - from + 1) as f64).ceil() as usize;
    let (aside, up) = (margin(left, right), margin(bottom, top));
    let (mut around, mut all) = (Vec::new(), 0);
    for row in bottom.saturating_sub(up)..(top + up + 1).min(rows) {
        for column in left.saturating_sub(aside)..(right + aside + 1).min(columns) {
            if !((left..=right).contains(&column) && (bottom..=top).contains(&row)) {
                all += 1;
                around.extend(shades[row * columns + column]);
            }
        }
    }
    let usual = quantile(&mut around, 0.5)?;
    let alike = around.iter().filter(|&&shade| (shade - usual).abs() < AROUND.3).count();
    let own = quantile(&mut members.iter().filter_map(|&square| shades[square]).collect::<Vec<_>>(), 0.5)?;
    let stands_out = (own - usual).abs() >= AROUND.1 && alike as f64 >= AROUND.2 * f64::from(all);
    stands_out.then_some(spot)
}

#[cfg(test)]
mod tests {
    use super::super::eyes::Pair;
    use super::super::head::{HeadFrame, HeadParts};
    use super::*;
    use crate::character::{Character, Mesh, Shade};

    /// Squares of a made-up face, along each side.
    const FINE: usize = 150;

    /// What the front of a face shows, as a sheet: its depth and its brightness by place.
    fn eyes_of(
        depth: impl Fn(DVec2) -> f64,
        bright: impl Fn(DVec2) -> f64,
        find: fn(&Head) -> Option<Eyes>,
    ) -> Option<Eyes> {
        let place = |index: usize| {
            let along = |index: usize| index as f64 / FINE as f64;
            DVec2::new(along(index % (FINE + 1)) - 0.5, along(index / (FINE + 1)))
        };
        let count = (FINE + 1) * (FINE + 1);
        let positions: Vec<DVec3> = (0..count).map(place).map(|p| p.extend(depth(p))).collect();
        let shades = (0..count).map(|index| (255.0 * bright(place(index))).round() as u8).collect();
        let mut triangles = Vec::new();
        for row in 0..FINE {
            for column in 0..FINE {
                let corner = (row * (FINE + 1) + column) as u32;
                let above = corner + FINE as u32 + 1;
                triangles.extend([[corner, corner + 1, above + 1], [corner, above + 1, above]]);
            }
        }
        let mesh = Mesh {
            positions: positions.iter().map(|p| p.as_vec3()).collect(),
            triangles: triangles.clone(),
            shade: Shade::Vertices(shades),
            ..Mesh::default()
        };
        let character = Character { meshes: vec![mesh], ..Character::default() };
        let parts = HeadParts {
            character: &character,
            mesh_starts: &[0, count],
            triangles: &triangles,
            of_head: vec![true; count],
            is_hair: vec![false; count],
            is_accessory: vec![false; count],
            is_eye: vec![false; count],
            turns: vec![false; count],
            eye_hints: Vec::new(),
            eye_joints: [None; 2],
            seam: 1e-6,
        };
        find(&Head::new(parts, &positions, HeadFrame { origin: DVec3::ZERO, length: 1.0 }))
    }

    /// The front of a head's ellipsoid.
    fn skin(p: DVec2) -> f64 {
        let off = (p - DVec2::new(0.0, 0.5)) / DVec2::new(0.8, 0.9);
        0.5 * (1.0 - off.length_squared()).sqrt()
    }

    /// A ball in the face: so far aside, so high, of so large a radius, flattened to this share.
    fn with_ball(at: DVec2, radius: f64, flat: f64) -> impl Fn(DVec2) -> f64 {
        move |p| {
            let square = radius * radius - (p - at).length_squared();
            if square > 0.0 { flat * square.sqrt() } else { 0.0 }
        }
    }

    fn pair_of(eyes: Option<Eyes>) -> Option<[f64; 4]> {
        let Pair { height, half_distance, half_width, half_height } = Pair::of(&eyes?);
        Some([height, half_distance, half_width, half_height])
    }

    fn is_near(is: Option<[f64; 4]>, wanted: [f64; 4], tolerance: f64) {
        let is = is.expect("there is a pair");
        assert!(
            is.iter().zip(wanted).all(|(is, wanted)| (is - wanted).abs() < tolerance),
            "{is:?} {wanted:?}"
        );
    }

    #[test]
    fn balls_sewn_to_the_face_are_eyes_where_two_mirror_each_other() {
        let at = |side: f64| DVec2::new(0.16 * side, 0.45);
        let balls = |left: DVec2, right: DVec2, radius: f64, flat: f64| {
            let (one, other) = (with_ball(left, 0.05, 1.0), with_ball(right, radius, flat));
            pair_of(eyes_of(move |p| skin(p) + one(p) + other(p), |_| 0.5, by_balls))
        };
        // A square is .0067 wide.
        is_near(balls(at(1.0), at(-1.0), 0.05, 1.0), [0.45, 0.16, 0.05, 0.05], 0.007);
        for (what, found) in [
            ("one alone", balls(at(1.0), DVec2::splat(9.0), 0.05, 1.0)),
            ("one higher", balls(at(1.0), at(-1.0) + 0.05 * DVec2::Y, 0.05, 1.0)),
            ("one larger", balls(at(1.0), at(-1.0), 0.08, 1.0)),
            ("one flat", balls(at(1.0), at(-1.0), 0.05, 0.1)),
            ("at the chin", balls(DVec2::new(0.16, 0.1), DVec2::new(-0.16, 0.1), 0.05, 1.0)),
        ] {
            assert!(found.is_none(), "{what}: {found:?}");
        }
    }

    #[test]
    fn what_bulges_without_a_rim_is_no_eye() {
        let cheek = |p: DVec2| {
            let off = DVec2::new(p.x.abs() - 0.16, p.y - 0.45) / 0.05;
            skin(p) + 0.05 * (-off.length_squared()).exp()
        };
        assert!(eyes_of(cheek, |_| 0.5, by_balls).is_none());
        assert!(eyes_of(skin, |_| 0.5, by_balls).is_none());
    }

    /// Spots of this brightness on skin of that: middle and half extents, mirrored.
    fn painted(skin_is: f64, spots: &[(f64, DVec2, DVec2)]) -> Option<[f64; 4]> {
        let bright = |p: DVec2| {
            let p = DVec2::new(p.x.abs(), p.y);
            let inside = |&&(_, at, half): &&(f64, DVec2, DVec2)| ((p - at) / half).length_squared() < 1.0;
            spots.iter().rev().find(inside).map_or(skin_is, |&(bright, ..)| bright)
        };
        pair_of(eyes_of(skin, bright, by_paint))
    }

    #[test]
    fn spots_painted_on_the_face_are_eyes() {
        let (at, half) = (DVec2::new(0.17, 0.42), DVec2::new(0.05, 0.07));
        let wanted = [0.42, 0.17, 0.05, 0.07];
        is_near(painted(0.7, &[(0.1, at, half)]), wanted, 0.012);
        is_near(painted(0.2, &[(0.95, at, half)]), wanted, 0.012);
        // Its own iris is no second pair, and a brow is none.
        let iris = (0.05, at, 0.5 * half);
        let brow = (0.1, DVec2::new(0.17, 0.56), DVec2::new(0.07, 0.015));
        is_near(painted(0.5, &[(0.95, at, half), iris, brow]), wanted, 0.012);
    }

    #[test]
    fn spots_that_may_be_anything_are_no_eyes() {
        let at = DVec2::new(0.17, 0.42);
        let round = DVec2::splat(0.05);
        let on_one_side = |p: DVec2| if (p - at).length() < 0.05 { 0.1 } else { 0.7 };
        assert!(eyes_of(skin, on_one_side, by_paint).is_none());
        for (what, found) in [
            ("brows", painted(0.7, &[(0.1, at, DVec2::new(0.08, 0.02))])),
            ("two pairs", painted(0.7, &[(0.1, at, round), (0.1, DVec2::new(0.2, 0.25), round)])),
            ("a blush", painted(0.7, &[(0.55, at, round)])),
            ("a mouth's corners", painted(0.7, &[(0.1, DVec2::new(0.16, 0.1), round)])),
            ("a mask", painted(0.7, &[(0.1, DVec2::new(0.0, 0.42), DVec2::new(0.3, 0.1))])),
            ("nothing", painted(0.7, &[])),
        ] {
            assert!(found.is_none(), "{what}: {found:?}");
        }
    }
}
