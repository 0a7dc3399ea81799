//! Fingers of unrigged figures.

#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;
#[path = "common/truth.rs"]
mod truth;

use glam::DVec3;
use models::{check_all, in_parallel};
use people::Person;
use std::collections::BTreeMap;
use superdeform::internals::geometry::Surface;
use superdeform::internals::rig::UnitFigure;
use superdeform::internals::rig::hand::{Hand, find_fingers};
use superdeform::{MeshKind, Role};

/// Fingers of each hand, the thumb among them, counted by eye on close pictures.
const FINGERS: &[(&str, usize)] = &[
    ("catbot.vrm", 1),
    ("cesiumman.glb", 1),
    ("cool_loops.vrm", 5),
    ("cryptovoxels.vrm", 1),
    ("gdquest_mannequiny.glb", 4),
    ("godette.vrm", 3),
    ("kaykit_barbarian.glb", 1),
    ("kaykit_knight.glb", 1),
    ("kaykit_knight_vrm1.vrm", 1),
    ("kaykit_rogue.glb", 1),
    ("kaykit_rogue_hooded.glb", 1),
    ("kaykit_rogue_vrm1.vrm", 1),
    ("makehuman_baby_reference.glb", 5),
    ("makehuman_baby_vrm1.vrm", 5),
    ("makehuman_child_reference.glb", 5),
    ("makehuman_female_rigged.glb", 5),
    ("makehuman_female_target.glb", 5),
    ("makehuman_female_vrm1.vrm", 5),
    ("quaternius_female_casual.glb", 2),
    ("quaternius_female_dress.glb", 2),
    ("quaternius_female_dress_unrigged.glb", 2),
    // A thumb that hangs from the wrist itself: not found.
    ("quaternius_knight.glb", 2),
    ("quaternius_male_casual.glb", 2),
    ("quaternius_man_2017.glb", 2),
    ("seedsan.glb", 5),
    ("seedsan_unrigged.glb", 5),
    ("seedsan_vrm1.vrm", 5),
    // Paws of three toes, shallow ones: one is found.
    ("tubbykun.vrm", 3),
    ("valid_aian_m_1_milit.glb", 5),
    ("valid_asian_f_1_busi.glb", 5),
    ("valid_black_m_2_busi.glb", 5),
    ("valid_hispanic_f_2_casual.glb", 5),
];

/// The length of the steps by which joints that were found may be off, in heights.
const OFF: f64 = 0.02;

/// A figure ready for its hands.
struct Laid {
    name: String,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    surface: Surface,
    /// The artist's, in the unit figure.
    joints: BTreeMap<Role, DVec3>,
}

impl Laid {
    fn new(name: &str, figure: &UnitFigure, joints: &BTreeMap<Role, DVec3>) -> Self {
        let triangles = figure.triangles_where(|mesh| figure.kinds[mesh] != Some(MeshKind::Hair));
        Self {
            name: name.to_string(),
            positions: figure.positions.clone(),
            surface: Surface::new(&figure.positions, &triangles),
            triangles,
            joints: joints.iter().map(|(&role, &at)| (role, figure.to_unit(at))).collect(),
        }
    }

    fn person(name: &str, person: &Person) -> Self {
        let forward = glam::DMat3::from_rotation_y(person.facing.to_radians()) * DVec3::Z;
        let figure = UnitFigure::of(&person.build(), forward).unwrap();
        Self::new(name, &figure, &person.joints())
    }

    /// The hand on one side, found with elbow and wrist moved.
    fn hand(&self, left: bool, elbow: DVec3, wrist: DVec3) -> Option<Hand> {
        let side = |role: Role| if left { role } else { role.mirrored() };
        let elbow = *self.joints.get(&side(Role::LeftLowerArm))? + elbow;
        let wrist = *self.joints.get(&side(Role::LeftHand))? + wrist;
        Some(find_fingers(&self.surface, &self.positions, &self.triangles, elbow, wrist, left))
    }

    /// The mirror image.
    fn mirrored(&self) -> Self {
        let mirror = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
        let positions: Vec<DVec3> = self.positions.iter().map(|&p| mirror(p)).collect();
        let triangles: Vec<[u32; 3]> = self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        Self {
            name: self.name.clone(),
            surface: Surface::new(&positions, &triangles),
            positions,
            triangles,
            joints: self.joints.iter().map(|(&role, &at)| (role.mirrored(), mirror(at))).collect(),
        }
    }
}

fn laid_cases() -> Vec<Laid> {
    let cases = truth::cases();
    in_parallel(&cases, |case| {
        Laid::new(&case.name, &UnitFigure::of(&case.character, case.forward).unwrap(), &case.joints)
    })
}

/// What every hand must be like.
fn shape_faults(name: &str, hand: &Hand) -> Vec<String> {
    let mut faults = Vec::new();
    let chains = hand.finger_count.min(5);
    if hand.joints.len() != 3 * chains || hand.tips.len() != chains {
        faults.push(format!(
            "{name}: {} joints and {} tips for {} fingers",
            hand.joints.len(),
            hand.tips.len(),
            hand.finger_count
        ));
    }
    for (role, joint) in &hand.joints {
        if !joint.position.is_finite() || !(0.0..=1.0).contains(&joint.confidence) {
            faults.push(format!("{name}: {role} is {joint:?}"));
        }
    }
    faults
}

#[test]
fn nine_of_ten_hands_have_their_number_of_fingers() {
    let (mut right, mut all) = (0, 0);
    for laid in laid_cases() {
        let Some(&(_, fingers)) = FINGERS.iter().find(|(name, _)| *name == laid.name) else { continue };
        for left in [true, false] {
            let Some(hand) = laid.hand(left, DVec3::ZERO, DVec3::ZERO) else { continue };
            assert_eq!(shape_faults(&laid.name, &hand), Vec::<String>::new());
            all += 1;
            right += usize::from(hand.finger_count == fingers);
            if hand.finger_count != fingers {
                println!("{}: {} of {fingers} fingers", laid.name, hand.finger_count);
            }
        }
    }
    println!("{right} of {all} hands have the right number of fingers");
    assert!(10 * right >= 9 * all);
}

/// Joints of detailed hands, with elbow and wrist where the artist put them and where they might have been found.
#[test]
fn fingers_bend_where_the_artist_bent_them() {
    let directions = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z].map(|way| OFF * way);
    let mut moves = vec![(DVec3::ZERO, DVec3::ZERO)];
    for way in directions {
        moves.extend([(way, DVec3::ZERO), (DVec3::ZERO, way), (way, way), (-way, way)]);
    }
    let mut errors: BTreeMap<(&str, bool), Vec<f64>> = BTreeMap::new();
    for laid in laid_cases() {
        let Some(family) = ["makehuman", "valid"].into_iter().find(|family| laid.name.starts_with(family))
        else {
            continue;
        };
        for left in [true, false] {
            for &(elbow, wrist) in &moves {
                let hand = laid.hand(left, elbow, wrist).unwrap();
                assert_eq!(hand.finger_count, 5, "{} moved by {elbow} and {wrist}", laid.name);
                let exact = elbow == DVec3::ZERO && wrist == DVec3::ZERO;
                for (role, joint) in &hand.joints {
                    if let Some(at) = laid.joints.get(role) {
                        errors.entry((family, exact)).or_default().push(at.distance(joint.position));
                    }
                }
            }
        }
    }
    for ((family, exact), mut errors) in errors {
        errors.sort_by(f64::total_cmp);
        let (median, most) = (errors[errors.len() / 2], errors[errors.len() - 1]);
        println!("{family}, exact {exact}: median {median:.4}, at most {most:.4} of {}", errors.len());
        assert!(median <= 0.015, "{family}: {median}");
        // No finger is taken for its neighbour: they are further apart.
        assert!(most <= 0.02, "{family}: {most}");
    }
}

fn people_with_fingers() -> Vec<(String, Person)> {
    let mut people = Vec::new();
    for arm_angle in [0.0, 45.0, 70.0] {
        for (blended, holes) in [(false, false), (true, false), (true, true)] {
            let name = format!("arms at {arm_angle}, blended {blended}, holes {holes}");
            let person = Person { fingers: true, arm_angle, blended, holes, columns: 24, ..Person::adult() };
            people.push((name, person));
        }
    }
    people
}

/// Tubes for fingers beside a tube for a palm: no webs, so knuckles can but be guessed; the other joints are known.
#[test]
fn people_of_tubes_have_five_fingers() {
    check_all(&people_with_fingers(), |(name, person)| {
        let laid = Laid::person(name, person);
        let mut faults = Vec::new();
        for left in [true, false] {
            let hand = laid.hand(left, DVec3::ZERO, DVec3::ZERO).unwrap();
            faults.extend(shape_faults(name, &hand));
            if hand.finger_count != 5 {
                faults.push(format!("{name}: {} fingers", hand.finger_count));
            }
            for (&role, joint) in &hand.joints {
                let far = joint.position.distance(laid.joints[&role]);
                let is_thumb = role.name().contains("Thumb");
                let bound = match role.name() {
                    other if is_thumb && !other.ends_with("Distal") => 0.03,
                    other if other.ends_with("Proximal") => 0.02,
                    _ => 0.0125,
                };
                if far > bound {
                    faults.push(format!("{name}: {role} is {far:.4} off"));
                }
            }
        }
        faults
    });
}

#[test]
fn a_hand_without_fingers_is_one() {
    for (name, person) in [("adult", Person::adult()), ("chibi", Person::chibi())] {
        let laid = Laid::person(name, &Person { blended: true, ..person });
        let hand = laid.hand(true, DVec3::ZERO, DVec3::ZERO).unwrap();
        assert_eq!(hand.finger_count, 1, "{name}");
        let roles: Vec<Role> = hand.joints.keys().copied().collect();
        assert_eq!(roles, [Role::LeftMiddleProximal, Role::LeftMiddleIntermediate, Role::LeftMiddleDistal]);
        let mut before = laid.joints[&Role::LeftHand].x;
        for joint in hand.joints.values() {
            assert!(joint.position.x > before, "{name}");
            before = joint.position.x;
        }
        assert!(hand.tips[&Role::LeftMiddleDistal].x > before, "{name}");
    }
}

#[test]
fn the_other_hand_is_the_mirror_image() {
    let mut all = laid_cases();
    all.extend(people_with_fingers().iter().map(|(name, person)| Laid::person(name, person)));
    check_all(&all, |laid| {
        let other = laid.mirrored();
        let mut faults = Vec::new();
        for left in [true, false] {
            let (Some(one), Some(two)) =
                (laid.hand(left, DVec3::ZERO, DVec3::ZERO), other.hand(!left, DVec3::ZERO, DVec3::ZERO))
            else {
                continue;
            };
            if one.finger_count != two.finger_count || one.joints.len() != two.joints.len() {
                faults.push(format!("{}: {} and {} fingers", laid.name, one.finger_count, two.finger_count));
                continue;
            }
            for (role, joint) in &one.joints {
                let Some(mirror) = two.joints.get(&role.mirrored()) else {
                    faults.push(format!("{}: {role} on one side only", laid.name));
                    continue;
                };
                let p = mirror.position;
                let apart = DVec3::new(-p.x, p.y, p.z).distance(joint.position);
                if apart > 1e-4 || (mirror.confidence - joint.confidence).abs() > 1e-4 {
                    faults.push(format!("{}: {role} is {apart} off its mirror image", laid.name));
                }
            }
        }
        faults
    });
}

#[test]
fn nothing_panics() {
    let person = Laid::person("fingers", &Person { fingers: true, columns: 12, ..Person::adult() });
    let empty: (Vec<DVec3>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    let point = (vec![DVec3::splat(0.5); 3], vec![[0, 1, 2], [0, 0, 0]]);
    let triangle = (vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
    let loose = (person.positions.clone(), Vec::new());
    let whole = (person.positions.clone(), person.triangles.clone());
    let flat = (person.positions.iter().map(|p| p.with_y(0.5)).collect::<Vec<_>>(), person.triangles.clone());
    let joints = [
        DVec3::ZERO,
        DVec3::splat(0.5),
        DVec3::new(0.5, 0.8, 0.0),
        DVec3::new(0.3, 0.79, -0.01),
        DVec3::new(0.0, 1e30, 0.0),
        DVec3::splat(1e-300),
        person.joints[&Role::LeftLowerArm],
        person.joints[&Role::LeftHand],
        person.joints[&Role::LeftMiddleDistal],
        person.joints[&Role::Head],
    ];
    for (positions, triangles) in [empty, point, triangle, loose, whole, flat] {
        let surface = Surface::new(&positions, &triangles);
        for elbow in joints {
            for wrist in joints {
                let hand = find_fingers(&surface, &positions, &triangles, elbow, wrist, true);
                assert_eq!(shape_faults("hostile", &hand), Vec::<String>::new(), "{elbow} {wrist}");
                if elbow == wrist {
                    assert_eq!(hand.finger_count, 0);
                }
            }
        }
    }
}
