//! Both modes on people made of tubes, of whom everything is known in advance.

#[path = "common/people.rs"]
mod people;

use glam::{DMat3, DVec3};
use people::{ADULT, Person, Proportions, Shape};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use superdeform::internals::character::humanoid::REQUIRED_ROLES;
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::product::landmarks::{CrownSource, landmarks};
use superdeform::internals::shape::style::BUILT_IN;
use superdeform::{
    BodyShape, Character, Deformed, Deformer, Error, ErrorKind, FaceCurve, GroupSettings, Height, Mesh,
    MeshKind, Mode, Options, Report, Role, Style, Weights,
};

const MODES: [Mode; 2] = [Mode::Product, Mode::Paper];

/// Coarser than people are by default: the results are the same to the eye, and there in a quarter of the time.
const COLUMNS: usize = 24;

fn adult() -> Person {
    Person { columns: COLUMNS, ..Person::adult() }
}

fn chibi() -> Person {
    Person { columns: COLUMNS, ..Person::chibi() }
}

/// Everything that sets people apart.
fn all_people() -> Vec<(&'static str, Person)> {
    vec![
        ("T-pose", adult()),
        ("A-pose", Person { arm_angle: 45.0, ..adult() }),
        ("one tube", Person { blended: true, ..adult() }),
        ("skirt", Person { skirt: true, blended: true, ..adult() }),
        ("holes", Person { holes: true, ..adult() }),
        ("fingers", Person { fingers: true, ..adult() }),
        ("chibi", chibi()),
        (
            "everything",
            Person { arm_angle: 30.0, skirt: true, holes: true, fingers: true, blended: true, ..adult() },
        ),
    ]
}

fn options(mode: Mode) -> Options {
    Options { mode, ..Options::default() }
}

fn shape_of(person: &Person, options: &Options) -> BodyShape {
    Measured::of(&person.build(), options).unwrap().shape
}

fn style_of(person: &Person, options: &Options) -> Style {
    Style::Shape(Box::new(shape_of(person, options)))
}

/// A target and what became of it.
struct Run {
    character: Arc<Character>,
    deformer: Deformer,
    deformed: Deformed,
}

impl Run {
    fn try_new(character: Character, style: &Style, options: &Options) -> Result<Self, Error> {
        let character = Arc::new(character);
        let deformer = Deformer::new(character.clone(), style, options)?;
        let deformed = deformer.apply();
        Ok(Self { character, deformer, deformed })
    }

    fn new(person: &Person, style: &Style, options: &Options) -> Self {
        Self::try_new(person.build(), style, options).unwrap()
    }

    /// A person made like the chibi.
    fn like_chibi(person: &Person, options: &Options) -> Self {
        Self::new(person, &style_of(&chibi(), options), options)
    }

    /// H.
    fn height(&self) -> f64 {
        self.deformer.target().figure.height()
    }

    fn report(&self) -> Report {
        self.deformer.report(&self.deformed).unwrap()
    }

    fn joint(&self, role: Role) -> DVec3 {
        self.deformed.joints[self.character.humanoid.joint(role).unwrap()]
    }

    fn before(&self) -> Vec<DVec3> {
        self.character.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(|p| p.as_dvec3())).collect()
    }

    fn after(&self) -> Vec<DVec3> {
        self.deformed.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(|p| p.as_dvec3())).collect()
    }

    fn has_warning(&self, code: &str) -> bool {
        self.deformer.warnings().iter().any(|warning| warning.code == code)
    }
}

/// The greatest distance between two lists of points; what is no number counts as infinite.
fn furthest(one: &[DVec3], other: &[DVec3]) -> f64 {
    assert_eq!(one.len(), other.len());
    let distances = one.iter().zip(other).map(|(p, q)| p.distance(*q));
    distances.map(|d| if d.is_nan() { f64::INFINITY } else { d }).fold(0.0, f64::max)
}

fn lowest(points: &[DVec3]) -> f64 {
    points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min)
}

fn tell(failures: Vec<String>) {
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

fn is_one_sentence(message: &str) -> bool {
    !message.trim().is_empty() && !message.contains('\n') && !message.contains("panicked")
}

#[test]
fn landmarks_are_read_where_people_were_built() {
    let mut failures = Vec::new();
    for (name, person) in all_people() {
        let person = Person { columns: people::COLUMNS, ..person };
        let study = Measured::of(&person.build(), &Options::default()).unwrap();
        let marks = &study.anatomy.landmarks;
        let height = study.figure.height();
        let p = &person.proportions;
        let joints = person.joints();
        // Rows of rays lie a 160th of (crown - shoulder line) apart, and the skull's first ring a hundredth of a half
        // head over the chin: two rows are enough.
        let row = 0.75 / 120.0 * (person.crown() - person.shoulder_line());
        // Rows between knees and hips; a trunk with a hole ends at a ring a little higher than its pole.
        let leg_row = (p.upper_leg + 0.05 * height) / 200.0;
        let hole = if person.holes { 0.3 * 0.15 * 0.25 * p.torso } else { 0.0 };
        let hip_line = joints[&Role::LeftUpperLeg].y;
        let crotch = if person.skirt { hip_line - 0.03 * height } else { person.crotch() };
        for (what, found, expected, tolerance) in [
            ("sole", marks.heights.sole, 0.0, 1e-6),
            ("crown", marks.heights.crown, person.head_top(), 0.002 * height),
            ("chin", marks.heights.chin, person.chin(), 2.0 * row),
            ("shoulder line", marks.heights.shoulder_line, person.shoulder_line(), 1e-9),
            ("crotch", marks.heights.crotch, crotch, leg_row + hole + 1e-9),
        ] {
            if (found - expected).abs() > tolerance {
                let off = (found - expected) / height;
                failures.push(format!(
                    "{name}: {what} at {found:.5} instead of {expected:.5}, {off:.5} H (allowed {:.5} H)",
                    tolerance / height
                ));
            }
        }
        if !marks.chin_seen || marks.crown_source != CrownSource::Skull || marks.crotch_seen == person.skirt {
            failures.push(format!("{name}: {marks:?}"));
        }
    }
    tell(failures);
}

/// A mesh of its own, weighted to `role`, in a person who is built without a unit and a turn.
fn with_mesh(person: &Person, kind: MeshKind, role: Role, shape: &Shape) -> Character {
    let mut character = person.build();
    let joint = character.humanoid.joint(role).unwrap() as u32;
    character.meshes.push(Mesh {
        name: kind.to_string(),
        kind: Some(kind),
        weights: Weights::from_rows(shape.positions.iter().map(|_| [(joint, 1.0)])),
        normals: shape.normals().into_iter().map(|n| n.as_vec3()).collect(),
        positions: shape.positions.iter().map(|p| p.as_vec3()).collect(),
        triangles: shape.triangles.clone(),
        ..Mesh::default()
    });
    character
}

#[test]
fn the_papers_head_ends_at_the_top_of_the_hair() {
    let person = Person::adult();
    let p = &person.proportions;
    let joint = person.joints()[&Role::Head];
    // A tall wig, wider than the skull, whose top is known: seven rays of which six stand on a ring a quarter of the
    // head's half width wide, as if the wig were not there.
    let centre = DVec3::Y * (person.chin() + 0.6 * p.head);
    let half = DVec3::new(0.2, 0.25, 0.2);
    let ring = 0.25 * p.head_half_width / half.x;
    let top = centre.y + half.y * (1.0 - ring * ring).sqrt();
    for kind in [MeshKind::Hair, MeshKind::Accessory] {
        let mut wig = Shape::default();
        wig.ellipsoid(centre, half, Role::Head);
        let character = with_mesh(&person, kind, Role::Head, &wig);
        let measured = Measured::of(&character, &options(Mode::Paper)).unwrap();
        let head_length = measured.shape.head_length;
        assert!((head_length - (top - joint.y)).abs() < 2e-3, "{kind}: {head_length}");
        // The crown, of which heads are counted, is still the skull's.
        let heights = &measured.anatomy.landmarks.heights;
        assert!((heights.crown - person.head_top()).abs() < 2e-3, "{kind}: {}", heights.crown);
        assert_eq!(measured.anatomy.landmarks.crown_source, CrownSource::Skull);
    }
}

#[test]
fn parts_of_the_face_are_no_surrounding_mesh() {
    let person = Person::adult();
    let p = &person.proportions;
    let [neck, head] = [Role::Neck, Role::Head].map(|role| person.joints()[&role]);
    let tube = |radius: f64| Shape::capsule(neck - DVec3::Y * 0.02, head + DVec3::Y * 0.02, radius);
    // No skin around the neck, as under a polo neck: its girth is that of the clothes, whatever of the face is within.
    let mut character = with_mesh(&person, MeshKind::Garment, Role::Neck, &tube(1.5 * p.neck_radius));
    let neck_joint = character.humanoid.joint(Role::Neck).unwrap() as u32;
    let body = &mut character.meshes[0];
    let is_of_neck =
        |vertex: &u32| body.weights.row(*vertex as usize).iter().any(|&(joint, _)| joint == neck_joint);
    let kept = body.triangles.iter().filter(|corners| !corners.iter().any(is_of_neck)).copied().collect();
    body.triangles = kept;
    let throat = with_mesh(&person, MeshKind::FacePart, Role::Head, &tube(1.2 * p.neck_radius));
    character.meshes.extend(throat.meshes.last().cloned());
    let shape = Measured::of(&character, &options(Mode::Paper)).unwrap().shape;
    let found = shape.bones[Role::Head.name()].radius.unwrap();
    assert!((found / (1.5 * p.neck_radius) - 1.0).abs() < 2e-3, "{found}");
}

#[test]
fn a_head_joint_that_moves_nothing_is_told_of_by_its_own_code() {
    let person = Person { eyes: false, ..adult() };
    let mut character = person.build();
    let [head, neck, jaw] =
        [Role::Head, Role::Neck, Role::Jaw].map(|role| character.humanoid.joint(role).unwrap() as u32);
    for mesh in &mut character.meshes {
        let rows: Vec<_> = mesh.weights.rows().map(|row| row.to_vec()).collect();
        mesh.weights = Weights::from_rows(rows.into_iter().map(|row| {
            row.into_iter()
                .map(|(joint, weight)| (if [head, jaw].contains(&joint) { neck } else { joint }, weight))
        }));
    }
    for mode in MODES {
        let run =
            Run::try_new(character.clone(), &style_of(&chibi(), &options(mode)), &options(mode)).unwrap();
        let warnings = run.deformer.warnings();
        let warning = warnings.iter().find(|warning| warning.code == "crown_not_found").unwrap();
        assert!(is_one_sentence(&warning.message) && warning.message.contains("head joint"), "{warning:?}");
        assert_eq!(warning.option, Some("humanoid"));
        assert!(!run.has_warning("crown_with_hair"), "{mode:?}");
        // The highest point of all is the crown.
        let crown = run.deformer.target().anatomy.landmarks.heights.crown;
        assert!((crown - person.crown()).abs() < 1e-5, "{crown}");
    }
}

#[test]
fn every_person_has_a_result_in_both_modes() {
    let mut failures = Vec::new();
    for mode in MODES {
        let options = options(mode);
        for (name, person) in all_people() {
            let run = Run::like_chibi(&person, &options);
            let report = run.report();
            let numbers = run.after().into_iter().chain(run.deformed.joints.iter().copied());
            if !numbers.into_iter().all(DVec3::is_finite) {
                failures.push(format!("{name}, {mode:?}: not all numbers are finite"));
            }
            for mesh in &run.deformed.meshes {
                if mesh.normals.iter().any(|n| (n.length() - 1.0).abs() > 1e-5) {
                    failures.push(format!("{name}, {mode:?}: a normal is not of length 1"));
                }
            }
            if person.proportions == ADULT {
                let (wanted, heads) = (report.reference.as_ref().unwrap().heads, report.result.heads);
                if mode == Mode::Product
                    && (heads / wanted - 1.0).abs() > 0.03
                    && !run.has_warning("heads_limited")
                {
                    failures.push(format!("{name}: {heads:.3} heads instead of {wanted:.3}"));
                }
                if heads > 0.6 * report.target.heads {
                    failures.push(format!("{name}, {mode:?}: {heads:.2} heads are left"));
                }
            }
        }
    }
    tell(failures);
}

#[test]
fn feet_stay_on_the_ground() {
    let mut failures = Vec::new();
    for mode in MODES {
        for (name, person) in all_people() {
            let run = Run::like_chibi(&person, &options(mode));
            let off = (lowest(&run.after()) - lowest(&run.before())) / run.height();
            if off.abs() > 1e-4 {
                failures.push(format!("{name}, {mode:?}: lowest vertex {off:.2e} H off the ground"));
            }
        }
    }
    tell(failures);
}

/// The heights between which a result's vertices lie.
fn extent(deformed: &Deformed) -> (f64, f64) {
    let heights = deformed.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| f64::from(p.y));
    heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)))
}

#[test]
fn nobody_becomes_taller_and_no_number_of_heads_makes_a_jump() {
    let character = Arc::new(chibi().build());
    let of = |heads: f64| {
        let deformer = Deformer::new(character.clone(), &Style::Heads(heads), &Options::default()).unwrap();
        let own = deformer.target().anatomy.proportions.heads();
        let (low, high) = extent(&deformer.apply());
        (own, (high - low) / deformer.target().figure.height())
    };
    let own = of(2.5).0;
    const STEP: f64 = 0.04;
    let heights: Vec<(f64, f64)> =
        (-10..=10).map(|step| own + STEP * f64::from(step)).map(|heads| (heads, of(heads).1)).collect();
    for &(heads, height) in &heights {
        assert!(height < 1.01, "{heads:.2} heads of {own:.2}: {height:.3} H");
        if heads >= own {
            assert!(height > 0.99, "{heads:.2} heads of {own:.2}: {height:.3} H");
        }
    }
    for pair in heights.windows(2) {
        // The body is heads - 1 head lengths: a step more of them is this much of the height.
        let most = 2.0 * STEP / (own - 1.0);
        assert!((pair[1].1 - pair[0].1).abs() < most, "from {:?} to {:?}", pair[0], pair[1]);
    }
}

#[test]
fn half_the_amount_is_half_way_for_a_figure_that_keeps_its_size() {
    let character = Arc::new(chibi().build());
    let vertices = |amount: f64| -> Vec<DVec3> {
        let options = Options { amount, ..Options::default() };
        let deformer = Deformer::new(character.clone(), &Style::Heads(2.0), &options).unwrap();
        let all: Vec<DVec3> =
            deformer.apply().meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| p.as_dvec3()).collect();
        // Where the ground is may hang on another vertex half way.
        let low = lowest(&all);
        all.into_iter().map(|p| p - low * DVec3::Y).collect()
    };
    let (none, half, all) = (vertices(0.0), vertices(0.5), vertices(1.0));
    let middle: Vec<DVec3> = none.iter().zip(&all).map(|(one, other)| 0.5 * (*one + *other)).collect();
    assert!(furthest(&none, &all) > 0.02, "the style does something");
    assert!(furthest(&half, &middle) < 1e-4, "{}", furthest(&half, &middle));
}

#[test]
fn the_height_is_the_style_s_the_character_s_or_a_number() {
    let person = Person { skirt: true, ..adult() };
    let character = Arc::new(person.build());
    let before = character.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| f64::from(p.y));
    let before = before.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    for mode in MODES {
        let style = style_of(&chibi(), &options(mode));
        for amount in [1.0, 0.5, 0.0] {
            let plain = Options { amount, ..options(mode) };
            let of_style = Deformer::new(character.clone(), &style, &plain).unwrap();
            let (low, high) = extent(&of_style.apply());
            for (height, asked) in
                [(Height::Keep, before.1 - before.0), (Height::Units(2.5), 2.5), (Height::Units(0.1), 0.1)]
            {
                let what = format!("{mode}, {height:?}, amount {amount}");
                let options = Options { height, ..plain.clone() };
                let mut deformer = Deformer::new(character.clone(), &style, &options).unwrap();
                let result = deformer.apply();
                let (new_low, new_high) = extent(&result);
                assert!((new_high - new_low - asked).abs() < 1e-5 * asked, "{what}: {new_low} to {new_high}");
                // Feet stay, and everything grows alike: vertices, joints, and what a host maps.
                assert!((new_low - low).abs() < 1e-5, "{what}: {low} to {new_low}");
                let size = asked / (high - low);
                let style_s = of_style.apply();
                for (one, other) in result.joints.iter().zip(&style_s.joints) {
                    assert!((one.y - low - size * (other.y - low)).abs() < 1e-5, "{what}");
                }
                let head = character.humanoid.joint(Role::Head).unwrap();
                let mapped = deformer.map(head, character.skeleton.joints[head].position());
                assert!((mapped.position - result.joints[head]).length() < 1e-9, "{what}");
                let plain_map = of_style.map(head, character.skeleton.joints[head].position());
                assert!((mapped.local_scale() - size * plain_map.local_scale()).abs() < 1e-6, "{what}");
                // A change of the height alone gives what a new deformer gives.
                deformer.set_options(&plain, &mut superdeform::Progress::none()).unwrap();
                assert_eq!(deformer.apply().joints, style_s.joints, "{what}");
            }
        }
    }
}

#[test]
fn a_reference_with_shorter_legs_shortens_the_legs() {
    let usual = chibi();
    let p = usual.proportions;
    let short = Person {
        proportions: Proportions { upper_leg: 0.8 * p.upper_leg, lower_leg: 0.8 * p.lower_leg, ..p },
        ..usual.clone()
    };
    for mode in MODES {
        let options = options(mode);
        let [usual, shorter] =
            [&usual, &short].map(|like| Run::new(&adult(), &style_of(like, &options), &options));
        for (upper, lower) in [
            (Role::LeftUpperLeg, Role::LeftLowerLeg),
            (Role::RightUpperLeg, Role::RightLowerLeg),
            (Role::LeftLowerLeg, Role::LeftFoot),
        ] {
            let [was, is] = [&usual, &shorter].map(|run| run.joint(upper).distance(run.joint(lower)));
            match mode {
                // Eq. 10 is linear in the reference's length.
                Mode::Paper => assert!((is / was - 0.8).abs() < 1e-6, "{upper}: {is} after {was}"),
                Mode::Product => assert!(is < 0.9 * was, "{upper}: {is} after {was}"),
            }
        }
        let arm = |run: &Run| run.joint(Role::LeftUpperArm).distance(run.joint(Role::LeftHand));
        let off = (arm(&shorter) - arm(&usual)).abs() / usual.height();
        assert!(off < 5e-3, "{mode:?}: arms changed by {off} H");
    }
}

#[test]
fn a_skirt_with_holes_follows_the_legs() {
    check_skirt(Mode::Product);
}

/// The hem lies as far up the legs as it did, within 5 % of them.
fn check_skirt(mode: Mode) {
    let mut failures = Vec::new();
    for blended in [false, true] {
        let person = Person { skirt: true, holes: true, blended, ..adult() };
        let run = Run::like_chibi(&person, &options(mode));
        let hem = |meshes: &[Vec<DVec3>]| lowest(&meshes[skirt_of(&run.character)]);
        let split = |all: Vec<DVec3>| -> Vec<Vec<DVec3>> {
            let mut all = all.into_iter();
            run.character
                .meshes
                .iter()
                .map(|mesh| all.by_ref().take(mesh.positions.len()).collect())
                .collect()
        };
        let hips = run.character.humanoid.joint(Role::LeftUpperLeg).unwrap();
        let was = hem(&split(run.before())) / run.character.skeleton.joints[hips].position().y;
        let is = hem(&split(run.after())) / run.deformed.joints[hips].y;
        if (is - was).abs() > 0.05 {
            failures.push(format!("{mode:?}, blended {blended}: hem at {is:.4} of the leg, was {was:.4}"));
        }
    }
    tell(failures);
}

fn skirt_of(character: &Character) -> usize {
    character.meshes.iter().position(|mesh| mesh.kind == Some(MeshKind::Garment)).unwrap()
}

/// For each vertex the one on the other side, moved by mirrored joints.
fn mirrored_vertices(character: &Character) -> Vec<usize> {
    const CELL: f64 = 1e-3;
    let roles: BTreeMap<usize, Role> = character.humanoid.iter().map(|(role, joint)| (joint, role)).collect();
    type Row = BTreeMap<Role, u32>;
    let mut vertices: Vec<(DVec3, Row, Row)> = Vec::new();
    for mesh in &character.meshes {
        for (p, row) in mesh.positions.iter().zip(mesh.weights.rows()) {
            let row: Vec<(Role, u32)> = row
                .iter()
                .map(|&(joint, weight)| (roles[&(joint as usize)], (weight * 1e5).round() as u32))
                .collect();
            let mirrored = row.iter().map(|&(role, weight)| (role.mirrored(), weight)).collect();
            vertices.push((p.as_dvec3(), row.into_iter().collect(), mirrored));
        }
    }
    let cell = |p: DVec3| (p / CELL).round().as_i64vec3().to_array();
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (vertex, (p, ..)) in vertices.iter().enumerate() {
        cells.entry(cell(*p)).or_default().push(vertex);
    }
    let around = || (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]);
    vertices
        .iter()
        .map(|(p, _, mirrored_row)| {
            let q = DVec3::new(-p.x, p.y, p.z);
            let home = cell(q);
            around()
                .filter_map(|step| cells.get(&[0, 1, 2].map(|axis| home[axis] + step[axis])))
                .flatten()
                .copied()
                .filter(|&other| vertices[other].1 == *mirrored_row)
                .min_by(|&a, &b| vertices[a].0.distance(q).total_cmp(&vertices[b].0.distance(q)))
                .filter(|&other| vertices[other].0.distance(q) < 1e-6)
                .expect("symmetric people have their vertices in pairs")
        })
        .collect()
}

#[test]
fn the_paper_keeps_symmetric_people_symmetric() {
    check_symmetry(Mode::Paper);
}

fn check_symmetry(mode: Mode) {
    let mut failures = Vec::new();
    for (name, person) in all_people() {
        let run = Run::like_chibi(&person, &options(mode));
        let mirror = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
        let after = run.after();
        let apart = |&(vertex, other): &(usize, usize)| after[vertex].distance(mirror(after[other]));
        let pairs = mirrored_vertices(&run.character).into_iter().enumerate();
        let worst = pairs.max_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
        let off = apart(&worst) / run.height();
        if off.is_nan() || off > 1e-6 {
            let figure = &run.deformer.target().figure;
            let (at, weights) = (figure.positions[worst.0], &figure.role_weights[worst.0]);
            failures.push(format!("{name}, {mode:?}: {off:.2e} H at {at:.4} {weights:?}"));
        }
        let humanoid = &run.character.humanoid;
        let sides = humanoid.iter().map(|(role, joint)| {
            let other = run.deformed.joints[humanoid.joint(role.mirrored()).unwrap()];
            run.deformed.joints[joint].distance(mirror(other))
        });
        let off = sides.fold(0.0, f64::max) / run.height();
        if off > 1e-6 {
            failures.push(format!("{name}, {mode:?}: joints {off:.2e} H"));
        }
    }
    tell(failures);
}

#[test]
fn the_way_a_person_looks_does_not_matter_to_the_paper() {
    check_facing(Mode::Paper);
}

fn check_facing(mode: Mode) {
    let mut failures = Vec::new();
    let options = options(mode);
    let style = style_of(&chibi(), &options);
    for (name, person) in all_people() {
        let plain = Run::new(&person, &style, &options);
        for facing in [90.0, -90.0, 180.0] {
            let turned = Run::new(&Person { facing, ..person.clone() }, &style, &options);
            let turn = DMat3::from_rotation_y(f64::to_radians(facing));
            let rotated = |points: &[DVec3]| points.iter().map(|&p| turn * p).collect::<Vec<_>>();
            let off = furthest(&rotated(&plain.after()), &turned.after())
                .max(furthest(&rotated(&plain.deformed.joints), &turned.deformed.joints))
                / plain.height();
            if off > 1e-5 {
                failures.push(format!("{name}, {mode:?}, facing {facing}: {off:.2e} H"));
            }
        }
    }
    tell(failures);
}

const CURVES: [(FaceCurve, f64); 2] = [(FaceCurve::F4, 1.9), (FaceCurve::F2, 0.95)];

#[test]
fn the_ends_of_the_face_stay_for_any_squash() {
    for mode in MODES {
        for (curve, limit) in CURVES {
            let with = |squash: f64| {
                // Eq. 12 or 13 alone.
                let options = Options {
                    face_squash: Some(squash),
                    face_curve: curve,
                    youth: 0.0,
                    seat: 0.0,
                    ..options(mode)
                };
                Run::like_chibi(&adult(), &options)
            };
            let plain = with(0.0);
            let head = plain.character.humanoid.joint(Role::Head).unwrap();
            let at = plain.character.skeleton.joints[head].position();
            let marks = landmarks(&plain.deformer.target().figure);
            let (chin, crown) = match mode {
                Mode::Product => (marks.heights.chin, marks.heights.crown),
                // The paper's box is that of the head's vertices.
                Mode::Paper => (adult().chin(), adult().crown()),
            };
            for squash in [-limit, -0.5, 0.3, limit] {
                let run = with(squash);
                assert!(!run.has_warning("face_squash_clamped"));
                for end in [chin, crown] {
                    let [was, is] = [&plain, &run].map(|run| run.deformer.map(head, at.with_y(end)).position);
                    let off = was.distance(is) / plain.height();
                    assert!(off < 1e-6, "{mode:?}, {curve:?}, {squash}: the end at {end} moved by {off} H");
                }
                // Vertices keep their order along the face, and the eyes move the way the squash says.
                let off = run.joint(Role::LeftEye).y - plain.joint(Role::LeftEye).y;
                assert!(off * squash < 0.0, "{mode:?}, {curve:?}, {squash}: eyes moved by {off}");
                let [was, is] = [&plain, &run].map(|run| run.after());
                let heads = run.deformer.target().figure.role_weights.iter().enumerate();
                let (mut low, mut high) = (0.0f64, 0.0f64);
                for (vertex, weights) in heads {
                    let moved = was[vertex].distance(is[vertex]) / plain.height();
                    match weights[..] {
                        [(Role::Head | Role::LeftEye | Role::RightEye | Role::Jaw, _)] => {
                            high = high.max(moved)
                        }
                        _ => low = low.max(moved),
                    }
                }
                assert!(high > 1e-3, "{mode:?}, {curve:?}, {squash}: the face stays");
                if mode == Mode::Paper {
                    assert!(low == 0.0, "{mode:?}, {curve:?}, {squash}: the body moved by {low} H");
                }
            }
        }
    }
}

#[test]
fn a_squash_that_would_fold_the_face_is_bounded_and_told() {
    for mode in MODES {
        for (curve, limit) in CURVES {
            let with = |squash: f64| {
                let options = Options { face_squash: Some(squash), face_curve: curve, ..options(mode) };
                Run::like_chibi(&adult(), &options)
            };
            for sign in [1.0, -1.0] {
                let bounded = with(sign * limit);
                assert!(!bounded.has_warning("face_squash_clamped"));
                for squash in [1.1 * limit, 10.0] {
                    let run = with(sign * squash);
                    assert!(run.has_warning("face_squash_clamped"), "{mode:?}, {curve:?}, {squash}");
                    assert_eq!(run.after(), bounded.after(), "{mode:?}, {curve:?}, {squash}");
                }
            }
        }
    }
}

#[test]
fn a_person_without_hands_feet_or_lower_limbs_has_a_result() {
    use Role::*;
    let both = |roles: &[Role]| roles.iter().flat_map(|&role| [role, role.mirrored()]).collect::<Vec<_>>();
    let middle = [Spine, Chest, UpperChest, Neck, Jaw];
    let cases = [
        ("hands", both(&[LeftHand])),
        ("feet", both(&[LeftFoot, LeftToes])),
        ("lower limbs", both(&[LeftHand, LeftFoot, LeftToes, LeftLowerArm, LeftLowerLeg])),
        (
            "all that is not needed",
            both(&[LeftHand, LeftFoot, LeftToes, LeftLowerArm, LeftLowerLeg, LeftShoulder, LeftEye])
                .into_iter()
                .chain(middle)
                .collect(),
        ),
        ("a left hand", vec![LeftHand]),
    ];
    let mut failures = Vec::new();
    for mode in MODES {
        let options = options(mode);
        for (what, without) in &cases {
            for (target, reference) in [
                (Person { without: without.clone(), ..adult() }, chibi()),
                (adult(), Person { without: without.clone(), ..chibi() }),
            ] {
                let run = match Run::try_new(target.build(), &style_of(&reference, &options), &options) {
                    Ok(run) => run,
                    Err(error) => {
                        failures.push(format!("{mode:?}, without {what}: {error}"));
                        continue;
                    }
                };
                let off = (lowest(&run.after()) - lowest(&run.before())) / run.height();
                let report = run.report();
                let heads = report.result.heads;
                if !run.after().iter().all(|p| p.is_finite()) || off.abs() > 1e-4 {
                    failures.push(format!("{mode:?}, without {what}: {off:.2e} H off the ground"));
                }
                // The paper has no bone beyond the last joint, so what hangs there keeps its length.
                let most = if mode == Mode::Product { 4.0 } else { 0.9 * report.target.heads };
                if heads.is_nan() || heads > most {
                    failures.push(format!("{mode:?}, without {what}: {heads:.2} heads are left"));
                }
            }
        }
    }
    tell(failures);
}

#[test]
fn a_saved_style_gives_the_same_result_to_the_last_bit() {
    for mode in MODES {
        let options = options(mode);
        let reference = Person { unit: 0.37, fingers: true, arm_angle: 31.0, ..chibi() };
        let shape = shape_of(&reference, &options);
        let read = BodyShape::from_json(&shape.to_json()).unwrap();
        assert_eq!(read, shape);
        assert_eq!(read.to_json(), shape.to_json());
        let [one, other] =
            [shape, read].map(|shape| Run::new(&adult(), &Style::Shape(Box::new(shape)), &options));
        assert_eq!(one.after(), other.after());
        assert_eq!(one.deformed.joints, other.deformed.joints);
    }
}

#[test]
fn nothing_and_all_of_a_blend_are_its_two_ends() {
    let [one, other] = [0.9, 1.0].map(|arm| {
        let mut person = Person { unit: 2.0 - arm, ..chibi() };
        person.proportions.upper_arm *= arm;
        person.proportions.lower_leg *= 1.9 - arm;
        person
    });
    for mode in MODES {
        let options = options(mode);
        let (one, other) = (shape_of(&one, &options), shape_of(&other, &options));
        let start = one.blended(&other, 0.0);
        assert_eq!((&start.bones, &start.proportions), (&one.bones, &one.proportions));
        let end = one.blended(&other, 1.0);
        assert!((end.heads().unwrap() / other.heads().unwrap() - 1.0).abs() < 1e-12);
        let between = one.blended(&other, 0.5).heads().unwrap();
        let mean = (one.heads().unwrap() + other.heads().unwrap()) / 2.0;
        assert!((between - mean).abs() < 1e-12, "{between} instead of {mean}");
        for (blend, whole) in [(start, one), (end, other)] {
            let [blend, whole] =
                [blend, whole].map(|shape| Run::new(&adult(), &Style::Shape(Box::new(shape)), &options));
            let off = furthest(&blend.after(), &whole.after()) / whole.height();
            assert!(off < 1e-6, "{mode:?}: {off} H");
        }
    }
}

#[test]
fn built_in_styles_have_the_heads_of_their_names() {
    for (name, heads) in BUILT_IN.into_iter().zip([2.0, 2.5, 3.0, 4.0]) {
        assert_eq!(name, format!("sd{heads}"));
        let shape = BodyShape::built_in(name).unwrap();
        assert_eq!(shape.name, name);
        assert!((shape.heads().unwrap() - heads).abs() < 1e-6, "{name}: {:?}", shape.heads());
        assert_eq!(BodyShape::from_json(&shape.to_json()).unwrap(), shape);
        for mode in MODES {
            let run = Run::new(&adult(), &Style::Shape(Box::new(shape.clone())), &options(mode));
            assert!(run.after().iter().all(|p| p.is_finite()));
        }
    }
    assert_eq!(BodyShape::built_in("sd5"), None);
}

#[test]
fn a_style_that_cannot_be_read_is_refused_in_one_sentence() {
    let good = shape_of(&chibi(), &Options::default()).to_json();
    let with = |pointer: &str, number: &str| {
        let mut style: serde_json::Value = serde_json::from_str(&good).unwrap();
        *style.pointer_mut(pointer).unwrap() = serde_json::Value::String("HERE".to_string());
        style.to_string().replace("\"HERE\"", number)
    };
    assert!(BodyShape::from_json(&with("/head_length", "0.5")).is_ok());
    let mut cases: Vec<(String, String)> =
        ["", "no style", "[]", "{}", "null", "{\"superdeform_style\": 1}", "\u{0}", &good[..good.len() / 2]]
            .map(|text| (text.to_string(), text.to_string()))
            .into();
    for (pointer, number) in [
        ("/superdeform_style", "3"),
        ("/superdeform_style", "0"),
        ("/superdeform_style", "-1"),
        ("/head_length", "-0.5"),
        ("/head_length", "0"),
        ("/bones/leftLowerLeg/length", "-0.1"),
        ("/bones/leftLowerLeg/radius", "-0.1"),
        ("/bones/leftLowerLeg/radius", "0"),
        ("/proportions/leg", "-1"),
        ("/proportions/neck", "-0.01"),
        ("/proportions/head_half_width", "0"),
        ("/proportions/upper_leg_radius", "-1"),
    ] {
        cases.push((format!("{pointer} {number}"), with(pointer, number)));
    }
    for pointer in ["/head_length", "/bones/leftLowerLeg/length", "/proportions/torso", "/landmarks/chin"] {
        for number in ["NaN", "1e999", "Infinity", "null", "\"1\""] {
            cases.push((format!("{pointer} {number}"), with(pointer, number)));
        }
    }
    let mut failures = Vec::new();
    for (what, text) in cases {
        match BodyShape::from_json(&text) {
            Ok(_) => failures.push(format!("{what}: was read")),
            Err(error) if error.kind != ErrorKind::BadStyle || !is_one_sentence(&error.message) => {
                failures.push(format!("{what}: {error:?}"));
            }
            Err(_) => {}
        }
    }
    let newer = BodyShape::from_json(&with("/superdeform_style", "3")).unwrap_err().message;
    assert!(newer.contains("version 3") && newer.contains("update"), "{newer}");
    tell(failures);
}

#[test]
fn what_a_user_sets_is_the_coefficient() {
    let given =
        GroupSettings { length_scale: Some(0.37), thickness_scale: Some(1.21), ..GroupSettings::default() };
    let kept = GroupSettings {
        length_transfer: Some(0.0),
        thickness_transfer: Some(0.0),
        ..GroupSettings::default()
    };
    for mode in MODES {
        let with = |group: &str, settings| {
            let groups = BTreeMap::from([(group.to_string(), settings)]);
            Run::like_chibi(&adult(), &Options { groups, ..options(mode) })
        };
        // Along the leg: profiles move hips and knees sideways.
        let thigh = |run: &Run| run.joint(Role::LeftUpperLeg).y - run.joint(Role::LeftLowerLeg).y;
        let run = with("upper_leg", given);
        let found = run.report().coefficients["upper_leg"];
        assert_eq!((found.length_scale, found.thickness_scale), (0.37, 1.21), "{mode:?}");
        assert!((thigh(&run) / ADULT.upper_leg - 0.37).abs() < 1e-6, "{mode:?}: {}", thigh(&run));
        for group in ["upper_leg", "lower_leg", "upper_arm", "lower_arm", "torso", "neck"] {
            let found = with(group, kept).report().coefficients[group];
            assert_eq!((found.length_scale, found.thickness_scale), (1.0, 1.0), "{mode:?}, {group}");
        }
        let run = with("upper_leg", kept);
        assert!((thigh(&run) / ADULT.upper_leg - 1.0).abs() < 1e-6, "{mode:?}: {}", thigh(&run));
    }
}

#[test]
fn a_group_that_does_not_exist_is_refused_with_the_names_of_those_that_do() {
    for mode in MODES {
        let groups = BTreeMap::from([("thigh".to_string(), GroupSettings::default())]);
        let options = Options { groups, ..options(mode) };
        let style = style_of(&chibi(), &options);
        let error = Run::try_new(adult().build(), &style, &options).err().unwrap();
        assert_eq!(error.kind, ErrorKind::BadOption);
        for word in
            ["thigh", "head", "neck", "torso", "shoulder", "upper_arm", "hand", "hip", "upper_leg", "foot"]
        {
            assert!(error.message.contains(word), "{mode:?}: {error} does not name {word}");
        }
    }
}

#[test]
fn options_out_of_their_range_are_refused() {
    let group = |settings| {
        let groups = BTreeMap::from([("foot".to_string(), settings)]);
        Options { groups, ..Options::default() }
    };
    let plain = Options::default;
    let none = GroupSettings::default;
    let mut cases =
        vec![("rays", Options { rays: Some(2), ..plain() }), ("rays", Options { rays: Some(0), ..plain() })];
    for value in [f64::NAN, f64::INFINITY, -1.0, 11.0] {
        cases.extend([
            ("head_scale", Options { head_scale: value, ..plain() }),
            ("amount", Options { amount: value, ..plain() }),
            ("hair_length", Options { hair_length: value, ..plain() }),
        ]);
    }
    for value in [f64::NAN, f64::NEG_INFINITY, -11.0, 11.0] {
        cases.push(("face_squash", Options { face_squash: Some(value), ..plain() }));
    }
    for value in [f64::NAN, f64::NEG_INFINITY, -0.1, 1.1] {
        cases.extend([
            ("length_transfer", group(GroupSettings { length_transfer: Some(value), ..none() })),
            ("thickness_transfer", group(GroupSettings { thickness_transfer: Some(value), ..none() })),
        ]);
    }
    for value in [f64::NAN, 0.0, -1.0, 10.1] {
        cases.extend([
            ("length_scale", group(GroupSettings { length_scale: Some(value), ..none() })),
            ("thickness_scale", group(GroupSettings { thickness_scale: Some(value), ..none() })),
        ]);
    }
    let style = style_of(&chibi(), &plain());
    let character = adult().build();
    let mut failures = Vec::new();
    for (name, options) in cases {
        for mode in MODES {
            let options = Options { mode, ..options.clone() };
            match Run::try_new(character.clone(), &style, &options) {
                Ok(_) => failures.push(format!("{name}: {options:?} was taken")),
                Err(error) if (error.kind, error.option) != (ErrorKind::BadOption, Some(name)) => {
                    failures.push(format!("{name}: {error:?}"));
                }
                Err(error) => assert!(is_one_sentence(&error.message), "{error}"),
            }
        }
    }
    tell(failures);
}

#[test]
fn the_users_own_groups_take_the_reference_as_one() {
    use Role::*;
    let names = [LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot].map(|role| (role, "leg".to_string()));
    let options = Options { bone_groups: names.into(), ..options(Mode::Paper) };
    let run = Run::like_chibi(&adult(), &options);
    let report = run.report();
    assert!(!report.coefficients.contains_key("upper_leg") && !report.coefficients.contains_key("lower_leg"));
    let leg = report.coefficients["leg"].length_scale;
    let [short, long] = [people::CHIBI, ADULT].map(|p| p.upper_leg + p.lower_leg);
    assert!((leg - report.g * short / long).abs() < 1e-6, "{leg}");
    for (upper, lower, was) in
        [(LeftUpperLeg, LeftLowerLeg, ADULT.upper_leg), (RightLowerLeg, RightFoot, ADULT.lower_leg)]
    {
        let length = run.joint(upper).distance(run.joint(lower));
        assert!((length / was - leg).abs() < 1e-6, "{upper}: {length}");
    }
    let groups = BTreeMap::from([(
        "leg".to_string(),
        GroupSettings { length_scale: Some(0.5), ..GroupSettings::default() },
    )]);
    let run = Run::like_chibi(&adult(), &Options { groups, ..options });
    assert_eq!(run.report().coefficients["leg"].length_scale, 0.5);
}

#[test]
fn product_mode_gives_the_users_own_groups_to_the_parts_of_their_bones() {
    use Role::*;
    let shorter = GroupSettings { length_scale: Some(0.4), ..GroupSettings::default() };
    let set = |names: &[&str]| names.iter().map(|name| (name.to_string(), shorter)).collect();
    let names = [LeftLowerLeg, RightLowerLeg, LeftFoot, RightFoot].map(|role| (role, "legs".to_string()));
    let own = Options { bone_groups: names.into(), groups: set(&["legs"]), ..options(Mode::Product) };
    let run = Run::like_chibi(&adult(), &own);
    let report = run.report();
    assert_eq!(report.coefficients["legs"].length_scale, 0.4);
    assert!(!report.coefficients.contains_key("upper_leg") && !report.coefficients.contains_key("lower_leg"));
    assert!(!run.has_warning("group_split"));
    for (upper, lower, was) in
        [(LeftUpperLeg, LeftLowerLeg, ADULT.upper_leg), (RightLowerLeg, RightFoot, ADULT.lower_leg)]
    {
        // Along the leg: profiles move hips and knees sideways.
        let length = run.joint(upper).y - run.joint(lower).y;
        assert!((length - 0.4 * was).abs() < 1e-6, "{upper}: {length}");
    }
    // The same as both built-in groups set so.
    let built_in = Options { groups: set(&["upper_leg", "lower_leg"]), ..options(Mode::Product) };
    assert_eq!(run.after(), Run::like_chibi(&adult(), &built_in).after());
}

#[test]
fn a_part_whose_bones_are_in_several_groups_is_warned_of() {
    let bone_groups = BTreeMap::from([(Role::LeftLowerLeg, "left".to_string())]);
    let run = Run::like_chibi(&adult(), &Options { bone_groups, ..options(Mode::Product) });
    let split: Vec<_> =
        run.report().warnings.into_iter().filter(|warning| warning.code == "group_split").collect();
    let [split] = &split[..] else { panic!("{split:?}") };
    assert_eq!(split.option, Some("bone_groups"));
    assert!(
        is_one_sentence(&split.message) && split.message.contains("left and upper_leg"),
        "{}",
        split.message
    );
}

#[test]
fn a_number_of_heads_out_of_range_is_refused() {
    for heads in [1.8, 2.0, 6.0] {
        assert_eq!(Style::heads(heads).unwrap(), Style::Heads(heads));
    }
    for heads in [1.79, 6.01, 0.0, -3.0, f64::NAN, f64::INFINITY] {
        let error = Style::heads(heads).unwrap_err();
        assert_eq!(error.kind, ErrorKind::BadOption);
        assert!(error.message.contains("1.8") && error.message.contains('6'), "{error}");
    }
}

#[test]
fn the_paper_needs_a_reference() {
    let error = Run::try_new(adult().build(), &Style::Heads(3.0), &options(Mode::Paper)).err().unwrap();
    assert_eq!((error.kind, error.option), (ErrorKind::BadOption, Some("mode")));
    assert!(error.message.contains("a reference"), "{error}");
}

#[test]
fn a_style_without_proportions_serves_the_paper_alone() {
    let shape = BodyShape { proportions: None, ..shape_of(&chibi(), &Options::default()) };
    let style = Style::Shape(Box::new(shape));
    let adult = || adult().build();
    assert!(Run::try_new(adult(), &style, &options(Mode::Paper)).is_ok());
    let error = Run::try_new(adult(), &style, &options(Mode::Product)).err().unwrap();
    assert_eq!((error.kind, error.option), (ErrorKind::BadStyle, Some("mode")));
    assert!(error.message.contains("from its model"), "{error}");
}

#[test]
fn a_person_without_a_needed_role_is_refused_with_the_way_to_name_it() {
    let style = style_of(&chibi(), &Options::default());
    for role in REQUIRED_ROLES {
        for mode in MODES {
            let mut character = adult().build();
            character.humanoid.set(role, None);
            let error = Run::try_new(character, &style, &options(mode)).err().unwrap();
            assert_eq!((error.kind, error.option), (ErrorKind::NoHumanoid, Some("humanoid")));
            assert!(error.message.contains(role.name()), "{error}");
        }
    }
}

#[test]
fn symmetric_people_stay_symmetric() {
    check_symmetry(Mode::Product);
}

#[test]
fn the_way_a_person_looks_does_not_matter() {
    check_facing(Mode::Product);
}

#[test]
fn what_hangs_from_the_head_goes_with_it_even_where_its_joint_lies_in_the_neck() {
    let person = adult();
    let mut character = person.build();
    let head = character.humanoid.joint(Role::Head).unwrap();
    character.skeleton.joints[head].rest.w_axis.y = person.chin() - 0.1 * person.proportions.head;
    let run = Run::try_new(character, &Style::Heads(2.5), &options(Mode::Product)).unwrap();
    let (before, after) = (run.before(), run.after());
    let crown = (0..before.len()).max_by(|&one, &other| before[one].y.total_cmp(&before[other].y)).unwrap();
    let hat = run.deformer.map(head, before[crown]);
    let off = hat.position.distance(after[crown]) / run.height();
    assert!(off < 1e-6, "a hat on the crown is {off} H away from it");
    assert!(hat.local_scale() > 1.0, "on a head that grows a hat shrinks to {}", hat.local_scale());
    let joint = run.character.skeleton.joints[head].position();
    let off = run.deformer.map(head, joint).position.distance(run.joint(Role::Head)) / run.height();
    assert!(off < 1e-9, "the joint is {off} H away from a point that hangs from it there");
}

/// Files often hand one set of vertices to all meshes, of which each draws its own.
#[test]
fn meshes_that_share_their_vertices_come_out_as_those_that_do_not() {
    let mut separate = adult().build();
    let spine = separate.humanoid.joint(Role::Spine).unwrap() as u32;
    let middle = separate.skeleton.joints[spine as usize].position();
    let corner = |index: usize| {
        let side = |bit: usize| if index >> bit & 1 == 1 { 0.5 } else { -0.5 };
        middle + DVec3::new(0.3 * side(0), 0.3 * side(1), 0.12 * side(2) - 0.25)
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let bag = Mesh {
        name: "bag".to_string(),
        kind: Some(MeshKind::Accessory),
        positions: (0..8).map(|index| corner(index).as_vec3()).collect(),
        triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        weights: Weights::from_rows(vec![vec![(spine, 1.0)]; 8]),
        ..Mesh::default()
    };
    separate.meshes.push(bag);
    let mut shared = separate.clone();
    for (mesh, own) in shared.meshes.iter_mut().zip(&separate.meshes) {
        let before: usize = separate
            .meshes
            .iter()
            .take_while(|other| other.name != own.name)
            .map(|m| m.positions.len())
            .sum();
        mesh.positions = separate.meshes.iter().flat_map(|mesh| mesh.positions.clone()).collect();
        let rows = separate.meshes.iter().flat_map(|mesh| mesh.weights.rows().map(<[_]>::to_vec));
        mesh.weights = Weights::from_rows(rows.collect::<Vec<_>>());
        mesh.triangles = own.triangles.iter().map(|corners| corners.map(|v| v + before as u32)).collect();
        (mesh.normals, mesh.tangents, mesh.morph_targets) = Default::default();
    }
    let made = |character: &Character| {
        let style = Style::heads(2.5).unwrap();
        Deformer::new(Arc::new(character.clone()), &style, &Options::default()).unwrap().apply()
    };
    let (one, other) = (made(&separate), made(&shared));
    let mut start = 0;
    for (index, mesh) in one.meshes.iter().enumerate() {
        for (vertex, &p) in mesh.positions.iter().enumerate() {
            let q = other.meshes[index].positions[start + vertex];
            assert!(p.distance(q) < 1e-6, "{}: {p} is at {q}", separate.meshes[index].name);
        }
        start += mesh.positions.len();
    }
}
