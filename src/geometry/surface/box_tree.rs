//! The tree of boxes over triangles that stay while their corners move: made once, and its boxes again for each place.

use super::wide::{Child, LANES, refitted};
use super::{Closest, Surface, has_area, padded_box, unit_box};
use crate::geometry::slots;
use glam::DVec3;
use obvhs::aabb::Aabb;

/// The tree over a surface's triangles, without their boxes: what is left to do for the same triangles between other positions is
/// to put boxes around them.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// What each node's boxes hold.
    nodes: Vec<[Child; LANES]>,
    /// The triangles' indices as given, in the order of the leaves.
    triangles: Vec<u32>,
    /// Where each triangle as given is in that order; `u32::MAX` for what was left out.
    slots: Vec<u32>,
}

impl Tree {
    /// That of `surface`, which was made of so many triangles.
    pub fn of(surface: &Surface, triangle_count: usize) -> Self {
        let slots = slots(triangle_count, &surface.triangles);
        let nodes = surface.nodes.iter().map(|node| node.children).collect();
        Self { nodes, triangles: surface.triangles.clone(), slots }
    }
}

impl Surface {
    /// As [`Surface::new`], where a surface of the same triangles between other positions had this `tree`: takes a quarter of the
    /// time. What is found is the same.
    pub fn with_tree(positions: &[DVec3], triangles: &[[u32; 3]], tree: &Tree) -> Self {
        if tree.triangles.is_empty() {
            return Self::new(positions, triangles);
        }
        let Some((centre, scale)) = unit_box(positions, triangles) else { return Self::default() };
        let mut corners = vec![[DVec3::ZERO; 3]; tree.triangles.len()];
        for (triangle, &slot) in triangles.iter().zip(&tree.slots) {
            let at = triangle.map(|vertex| (positions[vertex as usize] - centre) * scale);
            match corners.get_mut(slot as usize) {
                Some(corners) if has_area(&at) => *corners = at,
                None if !has_area(&at) => {}
                // Other triangles have no area here than there.
                _ => return Self::new(positions, triangles),
            }
        }
        let nodes = refitted(&tree.nodes, |first, count| {
            let boxes = corners[first..first + count].iter().map(padded_box);
            boxes.reduce(|one, other| one.union(&other)).unwrap_or(Aabb::empty())
        });
        Self { nodes, corners, triangles: tree.triangles.clone(), centre, scale }
    }

    /// As [`Self::closest_point`], of a surface that was made with `tree`: sooner where it is near the triangle `guess`, which is
    /// what is found where others are as near but for last digits of single precision.
    pub fn closest_point_near(&self, p: DVec3, guess: Option<u32>, tree: &Tree) -> Option<Closest> {
        let slot = guess.and_then(|guess| tree.slots.get(guess as usize)).copied();
        // A surface that did not take the tree has another order: a bad guess finds the same.
        self.closest_from(p, slot.filter(|&slot| (slot as usize) < self.corners.len()))
    }
}
