//! A head that sits over the chest (D30): a head that grows about its joint hangs out before it, on the neck of an adult.

use super::dual::Dual;
use super::head::HeadFrame;
use super::kernel::{Kernel, velocity};
use super::outline::Outline;
use crate::geometry::Mapped;
use glam::{DMat3, DVec3};

/// A chin may hang so far before the chest, a skull so far behind the back; artists: .08 to .10, .06 to .20.
const CHIN_BEFORE: f64 = 0.10;
/// See [`CHIN_BEFORE`].
const SKULL_BEHIND: f64 = 0.42;
/// A head goes back by at most this part of the height that it leans back over: the steepest of that is twice as steep, so a
/// short neck leans by no more than 27 degrees.
const MOST_LEAN: f64 = 0.25;
/// All of the head above this goes back as far: higher, the chin stays behind and stands out before the lips.
const WHOLE: f64 = 0.05;

/// The last row of the head's table: a kernel with a weight of height, about as far as the head goes back.
#[derive(Clone, Debug, PartialEq)]
pub struct Seat {
    frame: HeadFrame,
    row: [Kernel; 1],
}

impl Seat {
    /// How the head of `outline` goes back over the trunk; `None` where it sits well.
    pub fn new(outline: &Outline) -> Option<Self> {
        let &Outline { frame, shoulder_line, .. } = outline;
        let most = MOST_LEAN * (WHOLE - shoulder_line).max(0.0);
        let back = (outline.overhang - CHIN_BEFORE).min(SKULL_BEHIND - outline.behind).clamp(0.0, most);
        let row = Kernel::level(WHOLE, WHOLE - shoulder_line, f64::INFINITY);
        (back > 0.0).then_some(Self { frame, row: [Kernel { shift: -back * DVec3::Z, ..row }] })
    }

    /// Where `p` goes with this share of the head's way back, and the Jacobian there.
    pub fn map(&self, p: DVec3, share: f64) -> Mapped {
        let (shift, slope) = Dual::split(velocity(&self.row, Dual::point(self.frame.to_unit(p))));
        Mapped { position: p + share * self.frame.length * shift, jacobian: DMat3::IDENTITY + slope * share }
    }

    /// As [`Self::map`], without the Jacobian.
    pub fn place(&self, p: DVec3, share: f64) -> DVec3 {
        let shift = velocity(&self.row, self.frame.to_unit(p).to_array());
        p + share * self.frame.length * DVec3::from(shift)
    }
}
