//! What unnamed meshes depict.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;
#[path = "common/truth.rs"]
mod truth;

use std::collections::BTreeMap;
use superdeform::rig::kinds::{body_is_whole, guess_kinds, refine_kinds};
use superdeform::rig::{FoundJoint, Layout};

#[test]
fn measure() {
    for case in truth::cases() {
        let mut character = case.character.clone();
        for mesh in &mut character.meshes {
            mesh.kind = None;
        }
        let named = Layout::of(&case.character, case.forward).unwrap();
        let layout = Layout::of(&character, case.forward).unwrap();
        let start = std::time::Instant::now();
        let (mut kinds, warnings) = guess_kinds(&layout);
        let seconds = start.elapsed().as_secs_f64();
        let guessed = kinds.clone();
        let joints: BTreeMap<_, _> = case
            .joints
            .iter()
            .map(|(&role, &at)| (role, FoundJoint { position: layout.to_layout(at), confidence: 1.0 }))
            .collect();
        refine_kinds(&layout, &mut kinds, &joints);
        println!(
            "{} {seconds:.3} s whole {} warnings {}",
            case.name,
            body_is_whole(&layout, &kinds),
            warnings.len()
        );
        println!("   named: whole {}", body_is_whole(&named, &guess_kinds(&named).0));
        for mesh in 0..kinds.len() {
            println!(
                "    {:40} named {:?} -> {:?} -> {:?} {}",
                layout.names[mesh],
                named.kinds[mesh],
                guessed[mesh],
                kinds[mesh],
                if named.kinds[mesh].is_some_and(|k| k != kinds[mesh]) { "   <<<<" } else { "" }
            );
        }
    }
}
