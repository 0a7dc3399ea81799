//! Solids on a grid, and the one skin around them that a text-to-3D tool gives: welded, without names.
#![allow(dead_code)]

use glam::DVec3;

/// Values at the middles of cells: below 0 within.
pub struct Solid {
    pub size: [usize; 3],
    pub low: DVec3,
    pub cell: f64,
    pub values: Vec<f32>,
}

/// Empty cells around everything.
const MARGIN: usize = 3;

impl Solid {
    fn empty(low: DVec3, high: DVec3, cell: f64) -> Self {
        let size = ((high - low) / cell).to_array().map(|side| side.ceil().max(1.0) as usize + 2 * MARGIN);
        let low = low - MARGIN as f64 * cell;
        Self { size, low, cell, values: vec![1.0; size[0] * size[1] * size[2]] }
    }

    fn at(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    fn middle(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        self.low + (DVec3::new(x as f64, y as f64, z as f64) + 0.5) * self.cell
    }

    /// The solid where `field` is below 0.
    pub fn of_field(low: DVec3, high: DVec3, cell: f64, field: impl Fn(DVec3) -> f64) -> Self {
        let mut solid = Self::empty(low, high, cell);
        for z in 0..solid.size[2] {
            for y in 0..solid.size[1] {
                for x in 0..solid.size[0] {
                    let index = solid.at([x, y, z]);
                    solid.values[index] = field(solid.middle([x, y, z])) as f32;
                }
            }
        }
        solid
    }

    /// What cannot be reached from outside past triangles, in cells of `cell`, softened by the mean of neighbours.
    pub fn of_triangles(positions: &[DVec3], triangles: &[[u32; 3]], cell: f64) -> Self {
        let corners = triangles.iter().flatten().map(|&vertex| positions[vertex as usize]);
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = corners.fold(none, |(low, high), p| (low.min(p), high.max(p)));
        let mut solid = Self::empty(low, high, cell);
        let mut wall = vec![0u8; solid.values.len()];
        for corners in triangles {
            let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let steps = (longest / (0.4 * cell)).ceil().max(1.0) as usize;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
                    let p = (a + u * (b - a) + v * (c - a) - solid.low) / cell;
                    let index = solid.at(p.to_array().map(|x| x as usize));
                    wall[index] = 1;
                }
            }
        }
        let [sx, sy, sz] = solid.size;
        let mut stack = vec![[0usize; 3]];
        wall[0] = 2;
        while let Some([x, y, z]) = stack.pop() {
            let mut visit = |next: [usize; 3]| {
                let index = (next[2] * sy + next[1]) * sx + next[0];
                if wall[index] == 0 {
                    wall[index] = 2;
                    stack.push(next);
                }
            };
            if x > 0 {
                visit([x - 1, y, z]);
            }
            if y > 0 {
                visit([x, y - 1, z]);
            }
            if z > 0 {
                visit([x, y, z - 1]);
            }
            if x + 1 < sx {
                visit([x + 1, y, z]);
            }
            if y + 1 < sy {
                visit([x, y + 1, z]);
            }
            if z + 1 < sz {
                visit([x, y, z + 1]);
            }
        }
        for (value, &wall) in solid.values.iter_mut().zip(&wall) {
            *value = if wall == 2 { 0.5 } else { -0.5 };
        }
        for stride in [1, sx, sx * sy] {
            let before = solid.values.clone();
            for index in stride..before.len() - stride {
                solid.values[index] =
                    0.25 * before[index - stride] + 0.5 * before[index] + 0.25 * before[index + stride];
            }
        }
        solid
    }
}

/// The surface of a solid: one vertex in every cell between eight values that it passes through, a quad for every edge
/// (Gibson, Constrained elastic surface nets, 1998).
pub fn surface(solid: &Solid) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let [sx, sy, sz] = solid.size;
    let mut vertex_of = vec![u32::MAX; solid.values.len()];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let value = |x: usize, y: usize, z: usize| f64::from(solid.values[(z * sy + y) * sx + x]);
    for z in 0..sz - 1 {
        for y in 0..sy - 1 {
            for x in 0..sx - 1 {
                let corner = |index: usize| [x + (index & 1), y + (index >> 1 & 1), z + (index >> 2 & 1)];
                let values: [f64; 8] = std::array::from_fn(|index| {
                    let [x, y, z] = corner(index);
                    value(x, y, z)
                });
                let within = values.iter().filter(|&&value| value < 0.0).count();
                if within == 0 || within == 8 {
                    continue;
                }
                let (mut sum, mut count) = (DVec3::ZERO, 0.0);
                for a in 0..8usize {
                    for bit in [1usize, 2, 4] {
                        let b = a | bit;
                        if b != a && (values[a] < 0.0) != (values[b] < 0.0) {
                            let t = values[a] / (values[a] - values[b]);
                            sum += solid.middle(corner(a)).lerp(solid.middle(corner(b)), t);
                            count += 1.0;
                        }
                    }
                }
                vertex_of[solid.at([x, y, z])] = positions.len() as u32;
                positions.push(sum / count);
            }
        }
    }
    for z in 1..sz - 1 {
        for y in 1..sy - 1 {
            for x in 1..sx - 1 {
                let here = value(x, y, z) < 0.0;
                let cell = |x: usize, y: usize, z: usize| vertex_of[(z * sy + y) * sx + x];
                let mut quad = |there: bool, corners: [u32; 4]| {
                    if here != there {
                        let [a, b, c, d] = corners;
                        let faces = if here { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                        triangles.extend(faces);
                    }
                };
                quad(
                    value(x + 1, y, z) < 0.0,
                    [cell(x, y - 1, z - 1), cell(x, y, z - 1), cell(x, y, z), cell(x, y - 1, z)],
                );
                quad(
                    value(x, y + 1, z) < 0.0,
                    [cell(x - 1, y, z - 1), cell(x - 1, y, z), cell(x, y, z), cell(x, y, z - 1)],
                );
                quad(
                    value(x, y, z + 1) < 0.0,
                    [cell(x - 1, y - 1, z), cell(x, y - 1, z), cell(x, y, z), cell(x - 1, y, z)],
                );
            }
        }
    }
    (positions, triangles)
}
