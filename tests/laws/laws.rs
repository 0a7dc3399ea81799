//! Laws that hold for any input.

use proptest::prelude::*;
use superdeform::{Humanoid, Role};
use superdeform_laws::{skeletons, weight_rows, weights};

proptest! {
    #[test]
    fn rows_of_weights_come_back_without_their_zeros(rows in weight_rows()) {
        let weights = weights(&rows);
        prop_assert_eq!(weights.row_count(), rows.len());
        for (row, expected) in weights.rows().zip(&rows) {
            let expected: Vec<_> = expected.iter().copied().filter(|&(_, weight)| weight != 0.0).collect();
            prop_assert_eq!(row, &expected[..]);
        }
    }

    #[test]
    fn every_parent_stands_before_its_children(skeleton in skeletons(30)) {
        prop_assert!(skeleton.validate().is_ok());
        let order = skeleton.parents_first();
        let mut sorted = order.clone();
        sorted.sort_unstable();
        prop_assert_eq!(sorted, (0..skeleton.joints.len()).collect::<Vec<_>>());
        for (place, &joint) in order.iter().enumerate() {
            if let Some(parent) = skeleton.joints[joint].parent {
                prop_assert!(order[..place].contains(&parent));
            }
        }
    }

    #[test]
    fn a_circle_of_parents_is_refused(skeleton in skeletons(30), joint in any::<prop::sample::Index>()) {
        let mut skeleton = skeleton;
        let joint = joint.index(skeleton.joints.len());
        let root = skeleton.ancestors(joint).last().unwrap();
        skeleton.joints[root].parent = Some(joint);
        prop_assert!(skeleton.validate().is_err());
    }

    #[test]
    fn a_missing_role_is_skipped_over_in_its_chain(present in prop::collection::vec(any::<bool>(), Role::COUNT)) {
        let mut humanoid = Humanoid::default();
        for (role, _) in Role::all().zip(&present).filter(|(_, present)| **present) {
            humanoid.set(role, role as usize);
        }
        for (role, joint) in humanoid.iter() {
            prop_assert_eq!(Role::from_number(joint), Some(role));
            match humanoid.parent_of(role) {
                Some(parent) => prop_assert!(humanoid.has(parent) && role.chain().any(|above| above == parent)),
                None => prop_assert!(role.chain().skip(1).all(|above| !humanoid.has(above))),
            }
        }
    }

    #[test]
    fn mirroring_a_role_twice_gives_it_back(number in 0..Role::COUNT) {
        let role = Role::from_number(number).unwrap();
        prop_assert_eq!(role.mirrored().mirrored(), role);
        prop_assert_eq!(role.mirrored().parent(), role.parent().map(Role::mirrored));
    }
}
