//! Colliders as hosts give them.

use super::deformer_types::*;
use crate::ffi::arrays::Input;
use crate::ffi::basics::{SDEF_ELEMENT_COLLIDER, SDEF_ELEMENT_POINT};
use crate::ffi::guard::{Failure, Outcome};
use crate::pipeline::Deformer;
use crate::shape::collider::{Collider, Shape, SpringBall, map_collider};
use glam::DVec3;
use std::fmt::Display;

/// Checks that there is a joint that something moves with.
pub fn check_joint(deformer: &Deformer, what: &impl Display, joint: u32) -> Result<(), String> {
    let joint_count = deformer.character().skeleton.joints.len();
    if joint as usize >= joint_count {
        return Err(format!(
            "{what} moves with joint {joint}, but there are {joint_count} joints: name one of them"
        ));
    }
    Ok(())
}

/// Checks a joint, and numbers that must be finite.
fn check(deformer: &Deformer, what: &str, joint: u32, numbers: &[f64], radius: f64) -> Result<(), String> {
    check_joint(deformer, &what, joint)?;
    if numbers.iter().any(|number| !number.is_finite()) {
        return Err(format!("{what} has a number that is not finite: give points of finite numbers"));
    }
    if !(radius >= 0.0 && radius.is_finite()) {
        return Err(format!("{what} has the radius {radius}: give 0 or more"));
    }
    Ok(())
}

/// The springs of a call.
///
/// # Errors
/// BAD_INPUT with the spring as the element.
pub fn springs_of(deformer: &Deformer, given: Vec<SdefSpringBall>) -> Outcome<Vec<SpringBall>> {
    let read = |(index, ball): (usize, &SdefSpringBall)| {
        check(deformer, &format!("spring {index}"), ball.joint, &[ball.x, ball.y, ball.z], ball.radius)
            .map_err(|message| Failure::input(message).at(SDEF_ELEMENT_POINT, index))?;
        let centre = DVec3::new(ball.x, ball.y, ball.z);
        Ok(SpringBall { joint: ball.joint as usize, centre, radius: ball.radius })
    };
    given.iter().enumerate().map(read).collect()
}

/// What becomes of collider `index`.
///
/// # Errors
/// BAD_INPUT with the collider as the element.
///
/// # Safety
/// Its springs are NULL or as many as it says.
pub unsafe fn map(
    deformer: &Deformer,
    index: usize,
    given: &SdefCollider,
    springs: &[SpringBall],
) -> Outcome<SdefCollider> {
    let failed = |message: String| Failure::input(message).at(SDEF_ELEMENT_COLLIDER, index);
    let (shape, inside) = match given.kind {
        SDEF_COLLIDER_SPHERE => (Shape::Sphere, false),
        SDEF_COLLIDER_CAPSULE => (Shape::Capsule, false),
        SDEF_COLLIDER_PLANE => (Shape::Plane, false),
        SDEF_COLLIDER_INSIDE_SPHERE => (Shape::Sphere, true),
        SDEF_COLLIDER_INSIDE_CAPSULE => (Shape::Capsule, true),
        kind => {
            return Err(failed(format!("collider {index} is of kind {kind}: give one of SDEF_COLLIDER_*")));
        }
    };
    let numbers = [given.x, given.y, given.z, given.end_x, given.end_y, given.end_z];
    check(deformer, &format!("collider {index}"), given.joint, &numbers, given.radius).map_err(failed)?;
    let named = unsafe { Input::new("springs", given.springs, given.spring_count as usize, 0) }?;
    let mut guarded = Vec::new();
    for spring in named.iter() {
        let Some(ball) = springs.get(spring as usize) else {
            let count = springs.len();
            return Err(failed(format!(
                "collider {index} is for spring {spring}, but there are {count} springs: name one of them"
            )));
        };
        guarded.push(*ball);
    }
    let collider = Collider {
        shape,
        inside,
        joint: given.joint as usize,
        offset: DVec3::new(given.x, given.y, given.z),
        end: DVec3::new(given.end_x, given.end_y, given.end_z),
        radius: given.radius,
    };
    let mapped = map_collider(&collider, &guarded, |joint, point| deformer.map(joint, point));
    let Collider { offset, end, radius, .. } = mapped.collider;
    Ok(SdefCollider {
        x: offset.x,
        y: offset.y,
        z: offset.z,
        end_x: end.x,
        end_y: end.y,
        end_z: end.z,
        radius,
        yielded: mapped.yielded,
        newly_inside: mapped.newly_inside as u32,
        ..*given
    })
}
