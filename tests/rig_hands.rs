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
    let disturb = [
        glam::DVec3::ZERO,
        glam::DVec3::X,
        -glam::DVec3::X,
        glam::DVec3::Y,
        -glam::DVec3::Y,
        glam::DVec3::Z,
        -glam::DVec3::Z,
    ];
    let mut all: std::collections::BTreeMap<(String, String), Vec<f64>> = Default::default();
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
            let mut counts = String::new();
            for (i, d) in disturb.iter().enumerate() {
                for (j, e) in disturb.iter().enumerate() {
                    if i > 0 && j > 0 && i != j {
                        continue;
                    }
                    let hand = find_fingers(
                        &surface,
                        &layout.positions,
                        &triangles,
                        layout.to_layout(elbow) + 0.02 * *e,
                        layout.to_layout(wrist) + 0.02 * *d,
                        left,
                    );
                    counts += &hand.finger_count.to_string();
                    for (role, joint) in &hand.joints {
                        if let Some(&p) = case.joints.get(role) {
                            let error = layout.to_layout(p).distance(joint.position);
                            let kind = if i + j == 0 { "exact" } else { "disturbed" };
                            let name = role
                                .name()
                                .trim_start_matches("left")
                                .trim_start_matches("right")
                                .to_string();
                            let family = case.name.split('_').next().unwrap().to_string();
                            all.entry((format!("{family} {kind}"), name.clone())).or_default().push(error);
                            all.entry((format!("{family} {kind}"), "zall".into())).or_default().push(error);
                        }
                    }
                }
            }
            println!("END {} {side} {counts}", case.name);
        }
    }
    for ((family, name), mut errors) in all {
        errors.sort_by(f64::total_cmp);
        println!(
            "{family:30} {name:20} median {:.4} max {:.4} n {}",
            errors[errors.len() / 2],
            errors.last().unwrap(),
            errors.len()
        );
    }
}

#[test]
fn tubes() {
    for arm_angle in [0.0, 45.0, 70.0] {
        for blended in [false, true] {
            for holes in [false, true] {
                for proportions in [people::ADULT, people::CHIBI] {
                    let person = people::Person {
                        fingers: true,
                        arm_angle,
                        blended,
                        holes,
                        proportions,
                        ..people::Person::adult()
                    };
                    let character = person.build();
                    let layout = Layout::of(&character, glam::DVec3::Z).unwrap();
                    let surface = Surface::new(&layout.positions, &layout.triangles);
                    let joints = person.joints();
                    let hand = find_fingers(
                        &surface,
                        &layout.positions,
                        &layout.triangles,
                        layout.to_layout(joints[&Role::LeftLowerArm]),
                        layout.to_layout(joints[&Role::LeftHand]),
                        true,
                    );
                    println!("TUBE {arm_angle} blended {blended} holes {holes} {}", hand.finger_count);
                    for (role, joint) in &hand.joints {
                        if let Some(&p) = joints.get(role) {
                            println!("   {role} {:.4}", layout.to_layout(p).distance(joint.position));
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn draw() {
    use glam::DVec3;
    let wanted: Vec<_> = truth::cases()
        .into_iter()
        .filter(|case| {
            [
                "catbot",
                "cesium",
                "cool_loops",
                "crypto",
                "gdquest",
                "godette",
                "kaykit_barb",
                "kaykit_rogue.",
                "kaykit_knight.",
                "quaternius_female_cas",
                "quaternius_knight",
                "quaternius_man",
                "tubby",
                "seedsan.",
                "quaternius_male",
            ]
            .iter()
            .any(|n| case.name.starts_with(n))
        })
        .collect();
    let size = 240;
    let mut sheet = image::RgbImage::new(size * 8, size * wanted.len().div_ceil(2) as u32);
    for (row, case) in wanted.iter().enumerate() {
        println!("{row} {}", case.name);
        let layout = Layout::of(&case.character, case.forward).unwrap();
        let (ox, oy) = ((row % 2) as u32 * 4 * size, (row / 2) as u32 * size);
        let mut col = 0;
        for (side, low) in [(Role::LeftHand, Role::LeftLowerArm), (Role::RightHand, Role::RightLowerArm)] {
            let wrist = layout.to_layout(case.joints[&side]);
            let elbow = layout.to_layout(case.joints[&low]);
            let d = (wrist - elbow).normalize();
            let c = wrist + d * 0.06;
            for up in [DVec3::Y, DVec3::Z] {
                let view = up;
                let ex = d.reject_from_normalized(view).normalize();
                let ey = view.cross(ex);
                let mut zb = vec![f64::NEG_INFINITY; (size * size) as usize];
                for t in &layout.triangles {
                    let p = t.map(|v| layout.positions[v as usize] - c);
                    if p.iter().any(|p| p.length() > 0.25) {
                        continue;
                    }
                    let n = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
                    let q = p.map(|p| {
                        DVec3::new(
                            (p.dot(ex) / 0.1 + 1.0) * size as f64 / 2.0,
                            (1.0 - p.dot(ey) / 0.1) * size as f64 / 2.0,
                            p.dot(view),
                        )
                    });
                    let lo = q[0].min(q[1]).min(q[2]);
                    let hi = q[0].max(q[1]).max(q[2]);
                    let area = (q[1] - q[0]).truncate().perp_dot((q[2] - q[0]).truncate());
                    if area.abs() < 1e-9 {
                        continue;
                    }
                    for y in lo.y.max(0.0) as u32..(hi.y + 1.0).clamp(0.0, size as f64) as u32 {
                        for x in lo.x.max(0.0) as u32..(hi.x + 1.0).clamp(0.0, size as f64) as u32 {
                            let s = glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                            let w: Vec<f64> = (0..3)
                                .map(|i| {
                                    (q[(i + 1) % 3].truncate() - s).perp_dot(q[(i + 2) % 3].truncate() - s)
                                        / area
                                })
                                .collect();
                            if w.iter().all(|&w| w >= 0.0) {
                                let z = w[0] * q[0].z + w[1] * q[1].z + w[2] * q[2].z;
                                let slot = &mut zb[(y * size + x) as usize];
                                if z > *slot {
                                    *slot = z;
                                    let shade = (60.0 + 130.0 * n.dot(view).abs() + 60.0 * n.dot(ey))
                                        .clamp(0.0, 255.0)
                                        as u8;
                                    sheet.put_pixel(ox + col * size + x, oy + y, image::Rgb([shade; 3]));
                                }
                            }
                        }
                    }
                }
                let mut dot = |p: DVec3, color: [u8; 3]| {
                    let p = layout.to_layout(p) - c;
                    let (x, y) = (
                        (p.dot(ex) / 0.1 + 1.0) * size as f64 / 2.0,
                        (1.0 - p.dot(ey) / 0.1) * size as f64 / 2.0,
                    );
                    for dy in -2..=2 {
                        for dx in -2..=2 {
                            let (x, y) = (x as i32 + dx, y as i32 + dy);
                            if x >= 0 && y >= 0 && x < size as i32 && y < size as i32 {
                                sheet.put_pixel(ox + col * size + x as u32, oy + y as u32, image::Rgb(color));
                            }
                        }
                    }
                };
                for (_, &p) in &case.joints {
                    dot(p, [255, 0, 0]);
                }
                col += 1;
            }
        }
    }
    sheet.save("/tmp/hv/hands.png").unwrap();
}
