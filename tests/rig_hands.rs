//! Fingers of unrigged figures.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;
#[path = "common/truth.rs"]
mod truth;

use superdeform::geometry::Surface;
use superdeform::rig::Layout;
use superdeform::rig::hand::find_fingers;
use superdeform::{MeshKind, Role};

#[test]
fn probe() {
    for case in truth::cases() {
        let layout = Layout::of(&case.character, case.forward).unwrap();
        let triangles = layout.triangles_where(|mesh| layout.kinds[mesh] != Some(MeshKind::Hair));
        let surface = Surface::new(&layout.positions, &triangles);
        for (side, left) in [(Role::LeftHand, true), (Role::RightHand, false)] {
            let elbow = if left { Role::LeftLowerArm } else { Role::RightLowerArm };
            let (Some(&wrist), Some(&elbow)) = (case.joints.get(&side), case.joints.get(&elbow)) else {
                println!("{} no {side}", case.name);
                continue;
            };
            let start = std::time::Instant::now();
            let hand = find_fingers(&surface, &layout.positions, &triangles, layout.to_layout(elbow), layout.to_layout(wrist), left);
            println!("{} {side} {} {:?}", case.name, hand.finger_count, start.elapsed());
        }
    }
}
