//! Joints as a tree, each with its full transform in rest pose (§IV-A).

use crate::error::{Element, Error, ErrorKind, Named, Result};
use crate::geometry::marked;
use glam::{DMat4, DVec3};

/// What a matrix's last row may be off 0 and 1, against its largest number: rounding. Seen: ±30 % changes no role.
const LEAST_NUMBER: f64 = 1e-4;

/// One joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The joint's name, for messages and for guessing roles.
    pub name: String,
    /// The joint it hangs from.
    pub parent: Option<usize>,
    /// Its transform in rest pose, joint space to model space.
    pub rest: DMat4,
}

impl Joint {
    /// Where the joint is in rest pose.
    pub fn position(&self) -> DVec3 {
        self.rest.w_axis.truncate()
    }
}

/// All joints of a character; parents may stand after their children.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    /// The joints.
    pub joints: Vec<Joint>,
}

impl Skeleton {
    /// Checks that parents exist, that no joint is its own ancestor, and that transforms are finite and affine.
    ///
    /// # Errors
    /// `ErrorKind::BadInput` names the joint.
    pub fn validate(&self) -> Result<()> {
        let count = self.joints.len();
        let bad = |joint: usize, message: &str| {
            let message = format!("joint {joint} ({}): {message}", Named(&self.joints[joint].name));
            Err(Error::new(ErrorKind::BadInput, message).at(Element::Joint(joint)))
        };
        for (index, joint) in self.joints.iter().enumerate() {
            if let Some(parent) = joint.parent
                && parent >= count
            {
                let message = format!(
                    "its parent is joint {parent}, but there are {count} joints: name one of them, or none"
                );
                return bad(index, &message);
            }
            if !joint.rest.is_finite() {
                return bad(index, "its rest matrix holds a number that is not finite: give finite numbers");
            }
            let last = joint.rest.row(3);
            let most =
                joint.rest.to_cols_array().iter().fold(0.0, |most: f64, number| most.max(number.abs()));
            if last.truncate().abs().max_element() > LEAST_NUMBER * most
                || (last.w - 1.0).abs() > LEAST_NUMBER
            {
                let message = format!(
                    "numbers 3, 7, 11 and 15 of its rest matrix are {}, {}, {} and {}, not 0, 0, 0 and 1: give it column by column, with the translation in 12, 13 and 14",
                    last.x, last.y, last.z, last.w
                );
                return bad(index, &message);
            }
        }
        // No way leads from a root to what is in a circle, or hangs from one.
        let reached = marked(count, self.parents_first());
        if let Some(joint) = reached.iter().position(|&is_reached| !is_reached) {
            return bad(joint, "its parents run in a circle: one of them must have none");
        }
        Ok(())
    }

    /// Joints in an order in which every parent stands before its children.
    pub fn parents_first(&self) -> Vec<usize> {
        let mut order = Vec::with_capacity(self.joints.len());
        let children = self.children();
        let mut stack: Vec<usize> =
            (0..self.joints.len()).rev().filter(|&joint| self.joints[joint].parent.is_none()).collect();
        while let Some(joint) = stack.pop() {
            order.push(joint);
            stack.extend(children[joint].iter().rev());
        }
        order
    }

    /// The children of every joint, in index order.
    pub fn children(&self) -> Vec<Vec<usize>> {
        let mut children = vec![Vec::new(); self.joints.len()];
        for (index, joint) in self.joints.iter().enumerate() {
            if let Some(parent) = joint.parent {
                children[parent].push(index);
            }
        }
        children
    }

    /// The joint itself, its parent, and so on up to the root.
    pub fn ancestors(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(joint), |&joint| self.joints[joint].parent)
    }

    /// True where `joint` lies somewhere below `above`.
    pub(crate) fn is_below(&self, joint: usize, above: usize) -> bool {
        let mut ancestors = self.ancestors(joint).skip(1).take(self.joints.len());
        ancestors.any(|ancestor| ancestor == above)
    }

    /// The lowest joint that both hang from; one of the two where it is above the other.
    pub(crate) fn lowest_common_ancestor(&self, a: usize, b: usize) -> Option<usize> {
        self.ancestors(a).find(|&ancestor| ancestor == b || self.is_below(b, ancestor))
    }
}
