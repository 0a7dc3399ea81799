//! Humanoid roles of a skeleton for which no file tells them: by joint names first, by the shape of the joint
//! tree where names do not tell.

use super::humanoid::REQUIRED_ROLES;
use super::naming::{is_helper, roles_from_names};
use super::tree_roles::roles_from_tree;
use super::{Humanoid, Mesh, Role, Skeleton};
use crate::error::{Named, Warning};
use Role::*;
use glam::{DVec3, Vec3};

/// Roles that the geometry may add to those found by names, beside the required ones. The column is completed from the tree
/// instead, and fingers are never guessed beside named joints.
const FILLED_TOO: [Role; 11] = [
    LeftLowerLeg,
    RightLowerLeg,
    LeftLowerArm,
    RightLowerArm,
    LeftFoot,
    RightFoot,
    LeftHand,
    RightHand,
    Neck,
    LeftToes,
    RightToes,
];

/// Of the hips' distance from the upper legs, over the length of a leg: farther joints are roots, not hips. Seen: at
/// -30 %, 24 fewer roles.
const HIPS_REACH: f64 = 0.4;

/// Finds the humanoid roles of a skeleton.
///
/// - `meshes`: with weights where there are any; they tell the geometry which joints move something.
/// - `up`: from the feet to the head, any length.
/// - Returns the roles found, and the warning `roles_from_geometry` where names did not tell all of them. Roles
///   may be missing: see [`Humanoid::missing`]. A skeleton that does not pass [`Skeleton::validate`] has none.
///
/// Names decide where they speak; the geometry fills the gaps where it agrees with them, and decides alone where
/// names leave a required role open all the same.
pub fn find_roles(skeleton: &Skeleton, meshes: &[Mesh], up: Vec3) -> (Humanoid, Vec<Warning>) {
    if skeleton.validate().is_err() {
        return (Humanoid::default(), Vec::new());
    }
    let mut humanoid = roles_from_names(skeleton);
    complete(&mut humanoid, skeleton);
    drop_misplaced(&mut humanoid, skeleton, up.as_dvec3());
    let filled_roles = REQUIRED_ROLES.into_iter().chain(FILLED_TOO);
    if filled_roles.clone().all(|role| humanoid.has(role)) {
        return (humanoid, Vec::new());
    }
    let mut found = roles_from_tree(skeleton, meshes, up);
    complete(&mut found, skeleton);
    drop_misplaced(&mut found, skeleton, up.as_dvec3());
    if sides_differ(&humanoid, &found) {
        found = mirrored(&found);
    }
    let mut by_geometry = Vec::new();
    let mut filled = humanoid;
    for role in filled_roles {
        if let Some(joint) = found.joint(role)
            && fits(&filled, skeleton, role, joint)
        {
            filled.set(role, joint);
            by_geometry.push(role);
        }
    }
    complete(&mut filled, skeleton);
    if filled.missing().len() > found.missing().len() {
        filled = found;
        by_geometry = filled.iter().map(|(role, _)| role).collect();
    }
    if by_geometry.is_empty() {
        return (filled, Vec::new());
    }
    let played = by_geometry.iter().filter_map(|&role| filled.joint(role).map(|joint| (role, joint)));
    let list: Vec<String> =
        played.map(|(role, joint)| format!("{role} ({})", Named(&skeleton.joints[joint].name))).collect();
    let message = format!(
        "joint names do not tell these roles, which were found from the shape of the skeleton: {}",
        list.join(", ")
    );
    (filled, vec![Warning::new("roles_from_geometry", message)])
}

/// Completes a map that is given in part.
///
/// - A joint that plays two roles keeps the more important one; joints that do not exist lose theirs.
/// - `hips`: where no joint plays it, or the one that does carries neither the legs nor the head, the lowest
///   common ancestor of upper legs and head, if that lies at the hips and not at the ground.
/// - `spine`, `chest`, `upperChest`, if none is given: the joints between hips and neck. Of more than three, the
///   first, the last and the one nearest to the middle.
/// - `neck`: the first joint between the arms and the head.
///
/// A skeleton that does not pass [`Skeleton::validate`] is left alone.
pub fn complete(humanoid: &mut Humanoid, skeleton: &Skeleton) {
    if skeleton.validate().is_err() {
        return;
    }
    drop_repeated(humanoid, skeleton.joints.len());
    complete_hips(humanoid, skeleton);
    // The new hips play no other role.
    drop_repeated(humanoid, skeleton.joints.len());
    complete_column(humanoid, skeleton);
    drop_repeated(humanoid, skeleton.joints.len());
}

fn drop_repeated(humanoid: &mut Humanoid, joint_count: usize) {
    let mut taken = vec![false; joint_count];
    let others = Role::all().filter(|role| !REQUIRED_ROLES.contains(role));
    for role in REQUIRED_ROLES.into_iter().chain(others) {
        if let Some(joint) = humanoid.joint(role) {
            if joint >= joint_count || taken[joint] {
                humanoid.set(role, None);
            } else {
                taken[joint] = true;
            }
        }
    }
}

fn complete_hips(humanoid: &mut Humanoid, skeleton: &Skeleton) {
    let position = |joint: usize| skeleton.joints[joint].position();
    let top = humanoid.joint(Head).or(humanoid.joint(Neck));
    let legs = [humanoid.joint(LeftUpperLeg), humanoid.joint(RightUpperLeg)];
    let (Some(top), [Some(left), Some(right)]) = (top, legs) else {
        return;
    };
    let named = humanoid.joint(Hips);
    let carries = |hips: usize| [left, right, top].iter().all(|&joint| skeleton.is_below(joint, hips));
    if named.is_some_and(carries) {
        return;
    }
    let ancestor = skeleton
        .lowest_common_ancestor(left, right)
        .and_then(|legs| skeleton.lowest_common_ancestor(legs, top))
        .filter(|&joint| ![left, right, top].contains(&joint));
    let between = (position(left) + position(right)) / 2.0;
    let up = (position(top) - between).normalize_or_zero();
    let end = |roles: [Role; 3]| {
        let [upper, lower, foot] = roles.map(|role| humanoid.joint(role).map(position));
        let upper = upper?;
        foot.map(|foot| foot.distance(upper)).or(lower.map(|lower| 2.0 * lower.distance(upper)))
    };
    let leg = end([LeftUpperLeg, LeftLowerLeg, LeftFoot]).or(end([RightUpperLeg, RightLowerLeg, RightFoot]));
    let leg = leg.unwrap_or((position(top) - between).length());
    let far = |joint: usize| (position(joint) - between).dot(up).abs();
    let at_the_legs = |joint: usize| far(joint) <= HIPS_REACH * leg;
    if let Some(ancestor) = ancestor
        && at_the_legs(ancestor)
    {
        humanoid.set(Hips, ancestor);
    } else if named.is_none() {
        // The legs hang from a root at the ground: the joint of the column that is nearest to them, if it leaves
        // a spine, else the root for want of a better one.
        let column: Vec<usize> =
            skeleton.ancestors(top).skip(1).take_while(|&joint| Some(joint) != ancestor).collect();
        let leaves_a_spine = column.len() > 1;
        let lowest = column
            .into_iter()
            .filter(|&joint| leaves_a_spine && at_the_legs(joint) && ![left, right].contains(&joint))
            .min_by(|&a, &b| far(a).total_cmp(&far(b)));
        humanoid.set(Hips, lowest.or(ancestor));
    }
}

fn complete_column(humanoid: &mut Humanoid, skeleton: &Skeleton) {
    let position = |joint: usize| skeleton.joints[joint].position();
    let (Some(hips), Some(head)) = (humanoid.joint(Hips), humanoid.joint(Head).or(humanoid.joint(Neck)))
    else {
        return;
    };
    let arms = humanoid.joint(LeftUpperArm).zip(humanoid.joint(RightUpperArm));
    let arms_at = arms.and_then(|(left, right)| skeleton.lowest_common_ancestor(left, right));
    let foot_of_column = skeleton.lowest_common_ancestor(hips, head);
    let mut path: Vec<usize> = skeleton
        .ancestors(head)
        .skip(1)
        .take_while(|&joint| Some(joint) != foot_of_column)
        .filter(|&joint| !is_helper(&skeleton.joints[joint].name))
        .collect();
    path.reverse();
    // What lies between the arms and the head is neck.
    let above_arms = arms_at.and_then(|at| path.iter().position(|&joint| joint == at)).map(|at| at + 1);
    if let Some(above) = above_arms
        && !humanoid.has(Neck)
        && (1..=2).contains(&(path.len() - above))
    {
        humanoid.set(Neck, path[above]);
        path.truncate(above);
    }
    if let Some(neck) = humanoid.joint(Neck).and_then(|neck| path.iter().position(|&joint| joint == neck)) {
        path.truncate(neck);
    }
    if [Spine, Chest, UpperChest].iter().any(|&role| humanoid.has(role)) {
        return;
    }
    let playing: Vec<usize> = humanoid.iter().map(|(_, joint)| joint).collect();
    path.retain(|joint| !playing.contains(joint));
    // Of more than three the first, the last and the one nearest to the middle.
    if let [spine, middle @ .., upper] = &path[..] {
        let halfway = (position(*spine) + position(*upper)) / 2.0;
        let far = |joint: &usize| position(*joint).distance_squared(halfway);
        let chest = middle.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        path = [spine].into_iter().chain(chest).chain([upper]).copied().collect();
    }
    for (role, joint) in [Spine, Chest, UpperChest].into_iter().zip(path) {
        humanoid.set(role, joint);
    }
}

/// Takes roles from joints that cannot play them where they are: shins above thighs, a head below the hips.
fn drop_misplaced(humanoid: &mut Humanoid, skeleton: &Skeleton, up: DVec3) {
    let at = |role: Role| humanoid.joint(role).map(|joint| skeleton.joints[joint].position().dot(up));
    let order = [
        (Head, Hips),
        (LeftUpperLeg, LeftLowerLeg),
        (RightUpperLeg, RightLowerLeg),
        (LeftUpperLeg, LeftFoot),
        (RightUpperLeg, RightFoot),
    ];
    let is_turned = |&(high, low): &(Role, Role)| at(high).zip(at(low)).is_some_and(|(high, low)| high < low);
    let misplaced: Vec<(Role, Role)> = order.into_iter().filter(is_turned).collect();
    // A character that lies down or stands on its head is a matter of axes, not of names.
    if misplaced.len() > 2 {
        return;
    }
    for (high, low) in misplaced {
        humanoid.set(if high == Head { high } else { low }, None);
    }
}

/// True where the geometry calls left what the names call right.
fn sides_differ(named: &Humanoid, found: &Humanoid) -> bool {
    let mut votes = 0;
    for (role, joint) in found.iter().filter(|(role, _)| role.mirrored() != *role) {
        votes += i32::from(named.joint(role.mirrored()) == Some(joint));
        votes -= i32::from(named.joint(role) == Some(joint));
    }
    votes > 0
}

fn mirrored(humanoid: &Humanoid) -> Humanoid {
    let mut other = Humanoid::default();
    humanoid.iter().for_each(|(role, joint)| other.set(role.mirrored(), joint));
    other
}

/// True where `joint` can take the open `role` beside the roles that are known.
fn fits(humanoid: &Humanoid, skeleton: &Skeleton, role: Role, joint: usize) -> bool {
    if humanoid.has(role)
        || is_helper(&skeleton.joints[joint].name)
        || humanoid.iter().any(|(_, taken)| taken == joint)
    {
        return false;
    }
    let hangs_free = |role: Role| matches!(role, LeftFoot | RightFoot | LeftHand | RightHand);
    let above = humanoid.parent_of(role).and_then(|above| humanoid.joint(above));
    let below_its_parent = above.is_none_or(|above| hangs_free(role) || skeleton.is_below(joint, above));
    let above_its_children = humanoid
        .iter()
        .filter(|&(below, _)| {
            below.chain().skip(1).any(|above| above == role) && !below.chain().any(hangs_free)
        })
        .all(|(_, below)| skeleton.is_below(below, joint));
    below_its_parent && above_its_children
}
