//! What a host knows of a face: by it the eyes are found where the geometry does not tell.

use crate::error::{Error, ErrorKind, Result};
use glam::DVec3;

/// Where the eyes are; of one alone the other is taken to be its mirror image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceHints {
    /// One eye.
    pub eye: Option<EyeHint>,
    /// The other, on whichever side.
    pub other_eye: Option<EyeHint>,
}

/// One eye, model space and units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EyeHint {
    /// The middle of the opening between the lids.
    pub middle: DVec3,
    /// Half the opening's width; 0 where it is not known.
    pub half_width: f64,
    /// Half its height; 0 where it is not known.
    pub half_height: f64,
}

impl FaceHints {
    /// True where nothing is known.
    pub fn is_empty(&self) -> bool {
        self.all().next().is_none()
    }

    /// The eyes that are known.
    pub fn all(&self) -> impl Iterator<Item = EyeHint> {
        [self.eye, self.other_eye].into_iter().flatten()
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// `ErrorKind::BadInput` with the value and the remedy.
    pub fn validate(&self) -> Result<()> {
        for EyeHint { middle, half_width, half_height } in self.all() {
            if !middle.is_finite() {
                let message = format!("the face hints put an eye at {middle}: give finite numbers");
                return Err(Error::new(ErrorKind::BadInput, message));
            }
            for (what, half) in [("wide", half_width), ("high", half_height)] {
                if !(half >= 0.0 && half.is_finite()) {
                    let message = format!(
                        "the face hints make half an eye {half} {what}: give a finite number above 0, or 0 where it is not known"
                    );
                    return Err(Error::new(ErrorKind::BadInput, message));
                }
            }
        }
        Ok(())
    }
}
