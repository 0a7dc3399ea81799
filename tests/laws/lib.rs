//! Arbitrary characters: what the laws draw from.

use glam::{DMat4, DVec3};
use proptest::collection::vec;
use proptest::prelude::*;
use superdeform::{Joint, Skeleton, Weights};

/// Any forest of 1 to `most` joints; parents may stand before or after their children.
pub fn skeletons(most: usize) -> impl Strategy<Value = Skeleton> {
    let parents = vec((any::<prop::sample::Index>(), any::<bool>()), 1..=most);
    (parents, any::<prop::sample::Index>()).prop_map(|(parents, turn)| {
        let count = parents.len();
        // Joint i hangs from an earlier one, and then all are renumbered by a rotation.
        let turn = turn.index(count);
        let place = |joint: usize| (joint + turn) % count;
        let mut joints = vec![None; count];
        for (index, (parent, is_root)) in parents.iter().enumerate() {
            let parent = (index > 0 && !is_root).then(|| place(parent.index(index)));
            joints[place(index)] = Some(Joint {
                name: format!("joint {index}"),
                parent,
                rest: DMat4::from_translation(DVec3::new(0.0, index as f64, 0.0)),
            });
        }
        Skeleton { joints: joints.into_iter().flatten().collect() }
    })
}

/// Rows of weights with up to 6 joints each, some of weight 0.
pub fn weight_rows() -> impl Strategy<Value = Vec<Vec<(u32, f32)>>> {
    let weight = prop_oneof![Just(0.0f32), 0.001f32..1.0];
    vec(vec((0u32..20, weight), 0..6), 0..40)
}

/// The weights of `rows`.
pub fn weights(rows: &[Vec<(u32, f32)>]) -> Weights {
    Weights::from_rows(rows.iter().map(|row| row.iter().copied()))
}
