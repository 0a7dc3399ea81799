//! The tree of boxes, four to a node and side by side, so that one test looks at four of them.
//!
//! Ernst and Greiner. Multi bounding volume hierarchies. IEEE Symposium on Interactive Ray Tracing, 2008: made from a tree of
//! two children to a node, whose largest children give way to their own.

use glam::{BVec4A, DVec3, Vec3A, Vec4};
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;

/// Boxes of a node.
pub const LANES: usize = 4;

/// What a box holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Child {
    /// The node with what it is divided into, or the first of its triangles.
    pub first: u32,
    /// How many triangles it has; none for what is divided.
    pub count: u32,
}

impl Child {
    /// No box at all.
    pub const NONE: Self = Self { first: u32::MAX, count: 0 };
}

/// Four boxes, and what they hold; children come after their parents.
#[derive(Clone, Debug)]
pub struct Node {
    /// The low sides' x, y and z, then the high ones'. Of what is no box the high ones are below the low ones.
    sides: [[Vec4; 3]; 2],
    /// What each holds; those that there are come first.
    pub children: [Child; LANES],
}

/// A line as the boxes see it.
#[derive(Clone, Copy, Debug)]
pub struct Slopes {
    /// Of the origin, by axis.
    origin: [Vec4; 3],
    /// The direction's inverse.
    inverse: [Vec4; 3],
    /// Which side it meets first: 1 for the high one.
    near: [usize; 3],
}

impl Slopes {
    /// By a line's origin and the inverse of its direction, neither infinite nor 0.
    pub fn new(origin: Vec3A, inverse: Vec3A) -> Self {
        let each = |v: Vec3A| v.to_array().map(Vec4::splat);
        let near = inverse.to_array().map(|inverse| usize::from(inverse < 0.0));
        Self { origin: each(origin), inverse: each(inverse), near }
    }
}

impl Node {
    fn new(boxes: [Aabb; LANES], children: [Child; LANES]) -> Self {
        let side = |of: fn(&Aabb) -> Vec3A| {
            std::array::from_fn(|axis| Vec4::from_array(std::array::from_fn(|lane| of(&boxes[lane])[axis])))
        };
        Self { sides: [side(|b| b.min), side(|b| b.max)], children }
    }

    /// The box around its boxes.
    pub fn around(&self) -> Aabb {
        let [low, high] = &self.sides;
        let (low, high) = (low.map(|lanes| lanes.min_element()), high.map(|lanes| lanes.max_element()));
        Aabb::new(Vec3A::from_array(low), Vec3A::from_array(high))
    }

    /// Which boxes there are.
    #[inline(always)]
    pub fn is_there(&self) -> BVec4A {
        let [low, high] = &self.sides;
        low[0].cmple(high[0])
    }

    /// Where the line enters each box, at least 0, and which it enters before `way`.
    #[inline(always)]
    pub fn enters(&self, line: &Slopes, way: f32) -> (Vec4, BVec4A) {
        let at =
            |axis: usize, side: usize| (self.sides[side & 1][axis] - line.origin[axis]) * line.inverse[axis];
        let nears: [Vec4; 3] = std::array::from_fn(|axis| at(axis, line.near[axis]));
        let fars: [Vec4; 3] = std::array::from_fn(|axis| at(axis, 1 - line.near[axis]));
        let enter = nears[0].max(nears[1]).max(nears[2]).max(Vec4::ZERO);
        let leave = fars[0].min(fars[1]).min(fars[2]);
        (enter, enter.cmple(leave) & enter.cmple(Vec4::splat(way)))
    }

    /// The squares of the distances from `p` to each box, or a little less.
    ///
    /// Near the unit box what rounding moves `p` by is a fraction of the boxes' padding; far from it, of the distance.
    #[inline(always)]
    pub fn squares(&self, p: DVec3) -> Vec4 {
        /// Above what single precision rounds off the sum of three squares.
        const LESS: f32 = 1.0 - 2e-6;
        let p = p.as_vec3().to_array().map(Vec4::splat);
        let [low, high] = &self.sides;
        let away = |axis: usize| (low[axis] - p[axis]).max(p[axis] - high[axis]).max(Vec4::ZERO);
        let (x, y, z) = (away(0), away(1), away(2));
        // A number too large for a float is at least the largest one.
        (LESS * (x * x + y * y + z * z)).min(Vec4::splat(f32::MAX))
    }
}

/// The nodes of a tree with two children to a node.
pub fn widened(nodes: &[Bvh2Node]) -> Vec<Node> {
    let mut wide: Vec<Node> = Vec::with_capacity(nodes.len() / 4 + 1);
    // What is still to be divided, and whose child it is.
    let mut stack = vec![(0_u32, None)];
    while let Some((index, parent)) = stack.pop() {
        let number = wide.len() as u32;
        if let Some((parent, lane)) = parent {
            let parent: &mut Node = &mut wide[parent as usize];
            parent.children[lane as usize].first = number;
        }
        let (lanes, count) = divided(nodes, index);
        let mut boxes = [Aabb::empty(); LANES];
        let mut children = [Child::NONE; LANES];
        for (lane, &of) in lanes[..count].iter().enumerate() {
            let node = &nodes[of as usize];
            boxes[lane] = *node.aabb();
            children[lane] = Child { first: node.first_index, count: node.prim_count };
            if !node.is_leaf() {
                stack.push((of, Some((number, lane as u32))));
            }
        }
        wide.push(Node::new(boxes, children));
    }
    wide
}

/// The up to four nodes that node `index` is divided into, and how many: the largest ones give way to their children.
fn divided(nodes: &[Bvh2Node], index: u32) -> ([u32; LANES], usize) {
    let mut lanes = [index; LANES];
    let mut count = 1;
    while count < LANES {
        let is_divided = |&lane: &usize| !nodes[lanes[lane] as usize].is_leaf();
        let area = |lane: &usize| nodes[lanes[*lane] as usize].aabb().half_area();
        let Some(largest) = (0..count).filter(is_divided).max_by(|a, b| area(a).total_cmp(&area(b))) else {
            break;
        };
        let first = nodes[lanes[largest] as usize].first_index;
        lanes[largest] = first;
        lanes[count] = first + 1;
        count += 1;
    }
    (lanes, count)
}

/// The nodes with these `children`, and around each box's triangles what `around` gives for their first and their number.
pub fn refitted(children: &[[Child; LANES]], around: impl Fn(usize, usize) -> Aabb) -> Vec<Node> {
    let mut nodes: Vec<Node> = Vec::with_capacity(children.len());
    // From the last on, children before their parents; turned round at the end.
    for of in children.iter().rev() {
        let boxes = of.map(|child| match child {
            Child::NONE => Aabb::empty(),
            Child { first, count: 0 } => nodes[children.len() - 1 - first as usize].around(),
            Child { first, count } => around(first as usize, count as usize),
        });
        nodes.push(Node::new(boxes, *of));
    }
    nodes.reverse();
    nodes
}
