//! A figure as cells that are filled: the one solid that joints, weights and kinds are read from.
//!
//! What a surface encloses is filled however open, patched, doubled or flipped it is.

pub mod branches;
mod fill;
pub mod geodesic;
pub mod sides;
mod solid_slice;
mod voxels;

use crate::error::Result;
use crate::room::{self, Of};
use glam::{DVec3, IVec3};
pub use solid_slice::{Lobes, Slice};
pub use voxels::Voxels;

/// Cells over the height of a figure: one is 0.006 H, a fifth of the least limb.
pub const CELLS: f64 = 160.0;
/// The same where it is only asked whether limbs show at all.
pub const FEW_CELLS: f64 = 80.0;
/// A figure as broad and deep as high takes larger cells, so that there are no more than this, of 160 a height: time and memory. A person in
/// T-pose takes 2 million, one with arms forward 3.
const MOST_CELLS: f64 = 5e6;
/// What lies further from the axis than this, in heights, is no limb: a bound for memory.
const REACH: f64 = 1.0;
/// Empty cells around the figure, so that all of them hang together, and no filled one is at the end.
const MARGIN: i32 = 2;
/// Points on a way are no further apart than this share of a cell: air that is two cells wide has two of them at least.
const AIR_STEP: f64 = 0.7;

/// Cells of a grid, some of them filled. A plane through the middle of the grid goes through the middles of cells, not
/// between them: mirror images fall on cells that are mirror images.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Cells along x, y and z, odd.
    pub size: IVec3,
    /// The middle of the first cell.
    pub low: DVec3,
    /// The side of a cell.
    pub cell: f64,
    /// How many layers are around each cell, x running fastest; 0 for those outside.
    layers: Vec<u8>,
}

impl Solid {
    /// The solid of `triangles`, of which a figure 1 high consists, soles at 0, whose axis is at x = `axis`; `cells` of them
    /// over the height.
    ///
    /// All triangles are walls; filled is what those enclose, or touch, that `count` accepts by index, and what is hidden
    /// behind walls on all six sides and the others do not enclose by themselves: see `fill`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    ///
    /// O(area + cells · components).
    pub fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        count: impl Fn(usize) -> bool,
        axis: f64,
        cells: f64,
    ) -> Result<Self> {
        let middle = DVec3::new(axis, 0.5, 0.0);
        let off = |&vertex: &u32| (positions[vertex as usize] - middle).abs();
        let reach = triangles.iter().flatten().map(off).fold(DVec3::ZERO, |most, off| {
            // min and max pass over what is no number.
            most.max(off.min(DVec3::splat(REACH)))
        });
        let most = MOST_CELLS * (cells / CELLS).powi(3);
        let cell = (4.0 * reach.x * reach.z / most).cbrt().max(1.0 / cells);
        Self::empty(middle, reach.with_y(0.5), cell).with(positions, triangles, count)
    }

    /// The solid of anything, with `resolution` cells along the longest side of the box of its triangles. Each vertex has a
    /// filled cell, one of no triangle as well.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn of_body(positions: &[DVec3], triangles: &[[u32; 3]], resolution: usize) -> Result<Self> {
        let mut solid =
            Self::around(positions, triangles, resolution).with(positions, triangles, |_| true)?;
        for &p in positions {
            let index = solid.index(solid.nearest(solid.to_cells(p)));
            solid.layers[index] = solid.layers[index].max(1);
        }
        Ok(solid)
    }

    /// The grid of [`Solid::of_body`] without anything in it.
    pub fn around(positions: &[DVec3], triangles: &[[u32; 3]], resolution: usize) -> Self {
        let (low, high) = fill::extent(positions, triangles);
        let cell = (high - low).max_element() / resolution as f64;
        let cell = if cell.is_normal() { cell } else { 1.0 };
        Self::empty(low + (high - low) / 2.0, (high - low) / 2.0, cell)
    }

    /// A grid that reaches so far from its middle.
    fn empty(middle: DVec3, reach: DVec3, cell: f64) -> Self {
        let half = (reach / cell - 0.5).ceil().max(DVec3::ZERO).as_ivec3() + MARGIN;
        Self { size: 2 * half + 1, low: middle - half.as_dvec3() * cell, cell, layers: Vec::new() }
    }

    /// How many cells it has.
    pub fn count(&self) -> usize {
        self.size.as_i64vec3().element_product() as usize
    }

    fn with(
        mut self,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        count: impl Fn(usize) -> bool,
    ) -> Result<Self> {
        room::ask(Of::Cell, self.count())?;
        let points: Vec<DVec3> = positions.iter().map(|&p| self.to_cells(p)).collect();
        self.layers = self.fill(&points, triangles, count);
        Ok(self)
    }

    /// `p` in cells: their middles have whole numbers.
    pub fn to_cells(&self, p: DVec3) -> DVec3 {
        (p - self.low) / self.cell
    }

    /// A point given in cells, moved into what the margin is around; the middle for what is no number.
    pub fn within(&self, p: DVec3) -> DVec3 {
        let p = if p.is_finite() { p } else { (self.size / 2).as_dvec3() };
        p.clamp(DVec3::splat(MARGIN.into()), (self.size - 1 - MARGIN).as_dvec3())
    }

    /// The cell that is nearest to a point given in cells, of those within the margin.
    pub fn nearest(&self, p: DVec3) -> IVec3 {
        self.within(p).round().as_ivec3()
    }

    /// True for cells of the grid.
    pub fn has(&self, at: IVec3) -> bool {
        at.cmpge(IVec3::ZERO).all() && at.cmplt(self.size).all()
    }

    /// The index of a cell of the grid.
    pub fn index(&self, at: IVec3) -> usize {
        (at.x + self.size.x * (at.y + self.size.y * at.z)) as usize
    }

    /// How far the cell at an offset is in memory.
    pub fn stride(&self, offset: IVec3) -> isize {
        (offset.x + self.size.x * (offset.y + self.size.y * offset.z)) as isize
    }

    /// The cell of an index.
    pub fn place(&self, index: usize) -> IVec3 {
        let (index, size) = (index as i32, self.size);
        IVec3::new(index % size.x, index / size.x % size.y, index / (size.x * size.y))
    }

    /// The middle of a cell.
    pub fn middle(&self, at: IVec3) -> DVec3 {
        self.low + at.as_dvec3() * self.cell
    }

    /// How many layers are around a cell: 0 outside and beyond the grid, 2 for a leg in a skirt.
    pub fn layers(&self, at: IVec3) -> u8 {
        // A grid without anything in it has none.
        if self.has(at) { self.layers.get(self.index(at)).copied().unwrap_or(0) } else { 0 }
    }

    /// True where a cell is filled; those beyond the grid are not.
    pub fn is_filled(&self, at: IVec3) -> bool {
        self.layers(at) > 0
    }

    /// True where a point lies in a filled cell.
    pub fn is_in(&self, p: DVec3) -> bool {
        self.is_filled(self.to_cells(p).round().as_ivec3())
    }

    /// How much of the way from one point to another lies outside, in its units.
    pub fn air(&self, from: DVec3, to: DVec3) -> f64 {
        let length = from.distance(to);
        let steps = (length / (AIR_STEP * self.cell)).ceil().clamp(1.0, f64::from(self.size.element_sum()));
        let is_air = |step: f64| !self.is_in(from.lerp(to, (step + 0.5) / steps));
        let count = (0..steps as usize).filter(|&step| is_air(step as f64)).count();
        length * count as f64 / steps
    }

    /// The row of cells at a height, clamped to the grid.
    pub fn row(&self, y: f64) -> i32 {
        ((y - self.low.y) / self.cell).round().clamp(0.0, f64::from(self.size.y) - 1.0) as i32
    }
}
