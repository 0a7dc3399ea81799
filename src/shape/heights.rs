//! The five heights that a body is divided at.

use serde::{Deserialize, Serialize};

/// Heights of the landmarks along up, in the units of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heights {
    /// The top of the head, without hair where the head has a skull.
    pub crown: f64,
    /// The underside of the face.
    pub chin: f64,
    /// Mean height of the two upper-arm joints.
    pub shoulder_line: f64,
    /// Where the legs meet.
    pub crotch: f64,
    /// The lowest point of the feet.
    pub sole: f64,
}

impl Heights {
    /// L: chin to crown.
    pub fn head_length(&self) -> f64 {
        self.crown - self.chin
    }

    /// How many heads tall: (crown - sole) / (crown - chin).
    pub fn heads(&self) -> f64 {
        (self.crown - self.sole) / self.head_length()
    }
}
