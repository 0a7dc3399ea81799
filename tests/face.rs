//! A young face: what is found of faces, and what the face step does to heads.

#[path = "common/models.rs"]
mod models;

use glam::{DMat3, DVec2, DVec3, Vec3};
use models::{Run, check_all, in_parallel, model, models as all_models, present};
use std::sync::Arc;
use superdeform::internals::face::brows::Brows;
use superdeform::internals::face::eyes::{Eye, EyeSource, Eyeball, Pair};
use superdeform::internals::face::face_landmarks::{Ears, FaceLandmarks, Nose};
use superdeform::internals::face::head::HeadFrame;
use superdeform::internals::face::kernel::{Follower, Kernel, STEPS, along};
use superdeform::internals::face::outline::{HEIGHTS, Outline, OutlineSources};
use superdeform::internals::face::rows::{FaceAim, Rows};
use superdeform::internals::face::seat::Seat;
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::figure::Figure;
use superdeform::options::Features;
use superdeform::{Deformer, EyeHint, FaceHints, MeshKind, Options, Progress, Role, Style};
use superdeform_host::shades::painted;

/// What was measured on these heads by another program, by rays, from the same definitions: eyes' height, half distance,
/// half width and height of an opening, ball; nose's height and protrusion; half width of face and skull. NaN: no figure.
#[rustfmt::skip]
const FACES: [(&str, EyeSource, [f64; 9]); 12] = [
    ("valid_black_m_2_busi.glb", EyeSource::Pieces, [0.507, 0.144, 0.050, 0.014, 0.060, 0.343, 0.068, 0.294, 0.347]),
    ("valid_hispanic_f_2_casual.glb", EyeSource::Pieces, [0.487, 0.133, 0.047, 0.020, 0.068, 0.322, 0.085, 0.294, 0.349]),
    ("valid_asian_f_1_busi.glb", EyeSource::Pieces, [0.477, 0.141, 0.051, 0.017, 0.071, 0.316, 0.091, 0.294, 0.354]),
    ("valid_aian_m_1_milit.glb", EyeSource::Pieces, [0.517, 0.140, 0.047, 0.017, 0.061, 0.349, 0.105, 0.294, 0.370]),
    ("quaternius_male_casual.glb", EyeSource::Pieces, [0.477, 0.163, 0.045, 0.044, 0.058, 0.316, 0.093, 0.301, 0.338]),
    ("quaternius_female_casual.glb", EyeSource::Pieces, [0.507, 0.180, 0.042, 0.047, 0.061, 0.336, 0.105, 0.322, 0.399]),
    ("quaternius_female_dress.glb", EyeSource::Pieces, [0.480, 0.172, 0.043, 0.040, 0.055, 0.322, 0.099, 0.308, 0.327]),
    ("makehuman_female_rigged.glb", EyeSource::Pieces, [0.490, 0.147, 0.052, 0.024, 0.073, 0.356, 0.130, 0.298, 0.351]),
    ("seedsan_vrm1.vrm", EyeSource::Pieces, [0.416, 0.170, 0.059, 0.057, 0.079, 0.316, 0.085, 0.322, 0.362]),
    ("godette.vrm", EyeSource::Blink, [0.451, 0.188, 0.083, 0.084, 0.083, 0.255, 0.092, 0.343, f64::NAN]),
    ("kaykit_rogue.glb", EyeSource::Twins, [0.400, 0.219, 0.066, 0.068, 0.068, 0.309, 0.099, 0.364, 0.514]),
    ("kaykit_knight.glb", EyeSource::Twins, [0.357, 0.187, 0.047, 0.059, 0.059, 0.262, 0.096, 0.336, 0.454]),
];

/// Heads on which no eyes can be told: none, or painted.
const WITHOUT_EYES: [&str; 7] = [
    "cesiumman.glb",
    "cool_loops.vrm",
    "cryptovoxels.vrm",
    "gdquest_mannequiny.glb",
    "kenney_mini_female_a.glb",
    "quaternius_knight.glb",
    "tubbykun.vrm",
];

fn measured(name: &str) -> Measured {
    Measured::of(&all_models()[name].character, &Options::default()).unwrap()
}

#[test]
fn faces_are_found_where_another_program_finds_them() {
    let faces: Vec<_> = FACES.iter().filter(|(name, ..)| model(name).is_some()).collect();
    check_all(&faces, |&&(name, source, expected)| {
        let face = measured(name).face.unwrap();
        let (found, eyes) = face.eyes.as_ref().unwrap();
        let pair = Pair::of(eyes);
        let nose = face.nose.unwrap();
        let is = [
            pair.height,
            pair.half_distance,
            pair.half_width,
            pair.half_height,
            0.5 * (eyes[0].radius() + eyes[1].radius()),
            nose.tip.y,
            nose.protrusion(),
            face.half_width,
            face.skull_half_width,
        ];
        let mut wrong = Vec::new();
        if *found != source {
            wrong.push(format!("{name}: eyes by {found:?}"));
        }
        for (index, (is, expected)) in is.into_iter().zip(expected).enumerate() {
            // The other program's squares are .0067 wide; half heights of openings were looked at more closely.
            let tolerance = if index == 3 { 0.007 } else { 0.01 };
            if (is - expected).abs() > tolerance {
                wrong.push(format!("{name}: {is:.4} instead of {expected} ({index})"));
            }
        }
        wrong
    });
}

#[test]
fn no_head_gets_eyes_where_it_has_none() {
    let names = present(&WITHOUT_EYES);
    if names.is_empty() {
        println!("skipped: none of {WITHOUT_EYES:?} is there");
        return;
    }
    check_all(&names, |name| match measured(name).face.and_then(|face| face.eyes) {
        Some((source, _)) => vec![format!("{name}: eyes by {source:?}")],
        None => Vec::new(),
    });
}

/// A face made of numbers: a realistic adult's, times `eyes` in the eyes' size.
fn adult(eyes: f64) -> FaceLandmarks {
    let eye = |side: f64| {
        let middle = DVec3::new(0.142 * side, 0.5, 0.30);
        let half = DVec3::new(0.05 * eyes, 0.017 * eyes, 0.0);
        let ball = Eyeball {
            low: middle - DVec3::new(0.062, 0.062, 0.124),
            high: middle + DVec3::new(0.062, 0.062, 0.0),
            centre: middle - DVec3::Z * 0.062,
            turns: true,
            vertices: Vec::new(),
            iris: None,
        };
        Eye { low: middle - half, high: middle + half, ball: Some(ball) }
    };
    FaceLandmarks {
        eyes: Some((EyeSource::Pieces, [eye(1.0), eye(-1.0)])),
        covered: 0.0,
        brows: None,
        nose: Some(Nose { tip: DVec3::new(0.0, 0.34, 0.44), side_z: 0.35, half_width: 0.06, base: 0.29 }),
        half_width: 0.30,
        skull_half_width: 0.35,
        ears: Some(Ears {
            root: 0.33,
            low: DVec3::new(0.33, 0.33, -0.12),
            high: DVec3::new(0.40, 0.55, 0.06),
        }),
    }
}

/// Points in and around a head, in head lengths.
fn grid(spacing: f64) -> Vec<DVec3> {
    let (low, high) = (DVec3::new(-0.55, -0.2, -0.5), DVec3::new(0.55, 1.1, 0.55));
    let counts = ((high - low) / spacing).ceil();
    let mut points = Vec::new();
    for x in 0..=counts.x as usize {
        for y in 0..=counts.y as usize {
            for z in 0..=counts.z as usize {
                points.push(low + spacing * DVec3::new(x as f64, y as f64, z as f64));
            }
        }
    }
    points
}

const AIM: FaceAim = FaceAim { eye_size: 0.067, eye_height: 0.40, skull_half_width: 0.46 };

/// An adult's head from the side, as it is seen on realistic people: the forehead recedes, the neck shows from the chin
/// to the occiput.
fn adult_outline() -> Outline {
    Outline {
        frame: HeadFrame { origin: DVec3::ZERO, length: 1.0 },
        shoulder_line: -0.4,
        middle: -0.03,
        half_widths: [0.22, 0.30, 0.35, 0.38, 0.38, 0.37, 0.35, 0.29],
        with_hair: [0.22, 0.30, 0.38, 0.40, 0.38, 0.37, 0.35, 0.29],
        fronts: [0.46, 0.51, 0.50, 0.46, 0.47, 0.45, 0.40, 0.31],
        backs: [0.06, 0.19, 0.34, 0.42, 0.46, 0.46, 0.41, 0.32],
        occiput: 0.38,
        overhang: 0.2,
        behind: 0.2,
    }
}

fn rows(face: &FaceLandmarks) -> Rows {
    Rows::new(face, Some(&adult_outline()), &AIM, &Features::default(), 0.0)
}

fn follower(face: &FaceLandmarks) -> Follower {
    Follower::new(&rows(face).kernels)
}

/// Ways that are followed together are in single precision: some four roundings of numbers up to 2 in each piece, of which what
/// follows makes a few times as much.
const OF_SINGLE: f32 = 1e-5;

#[test]
fn ways_of_points_at_once_are_those_of_each() {
    let pull = Kernel {
        shift: DVec3::new(0.1, -0.7, 0.4),
        ..Kernel::about(DVec3::new(0.2, 0.9, 0.1), DVec3::splat(0.5))
    };
    let table = rows(&adult(1.0)).kernels;
    let pulled: Vec<Kernel> = [pull].into_iter().chain(table.clone()).collect();
    let mut furthest = 0.0_f32;
    for kernels in [table, pulled] {
        let follower = Follower::new(&kernels);
        for step in 0..12 * 16 * 12 {
            let p = DVec3::new(f64::from(step % 12), f64::from(step / 12 % 16), f64::from(step / 192));
            let p = p * 0.13 - DVec3::new(0.75, 0.45, 0.75);
            // From near to far.
            let points: [Vec3; 8] =
                std::array::from_fn(|of| (p + 0.1 * of as f64 * DVec3::new(p.y, p.z, p.x)).as_vec3());
            for (p, way) in points.into_iter().zip(follower.ways(points)) {
                for piece in [1, STEPS / 2 - 1, STEPS - 1] {
                    let youth = (piece + 1) as f64 / STEPS as f64;
                    let alone = follower.place(p.as_dvec3(), youth) - p.as_dvec3();
                    let apart = way[piece].distance(alone.as_vec3());
                    assert!(apart < OF_SINGLE, "{p} after {youth}: {apart}");
                }
                furthest = furthest.max(way[STEPS - 1].length());
            }
        }
    }
    assert!(furthest > 0.4, "nothing goes further than {furthest}");
}

/// The largest stretch of a matrix.
fn norm(m: DMat3) -> f64 {
    let squared = m.transpose() * m;
    let mut direction = DVec3::new(1.0, 0.7, 0.4);
    for _ in 0..30 {
        direction = (squared * direction).normalize_or(DVec3::X);
    }
    (squared * direction).length().sqrt()
}

/// An ellipsoid of these half axes about `middle`, as triangles.
fn ellipsoid(half: DVec3, middle: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    const RINGS: u32 = 60;
    let angle = |step: u32, of: f64| of * f64::from(step) / f64::from(RINGS);
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for ring in 0..=RINGS {
        for step in 0..RINGS {
            let (down, around) = (angle(ring, std::f64::consts::PI), angle(step, std::f64::consts::TAU));
            let p = DVec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin());
            points.push(middle + half * p);
            let [a, b] = [ring * RINGS + step, ring * RINGS + (step + 1) % RINGS];
            if ring < RINGS {
                triangles.extend([[a, b, b + RINGS], [a, b + RINGS, a + RINGS]]);
            }
        }
    }
    (points, triangles)
}

#[test]
fn an_outline_is_that_of_the_head() {
    let (half, middle) = (DVec3::new(0.42, 0.5, 0.47), DVec3::new(0.0, 0.5, -0.05));
    let (mut points, triangles) = ellipsoid(half, middle);
    let vertices = (0..points.len() as u32).collect();
    // A trunk whose front is .2 behind the chin's foremost point between .02 and .12, and its back at the skull's.
    let chin = middle.z + half.z * (1.0 - ((0.12 - 0.5) / 0.5_f64).powi(2)).sqrt();
    let first = points.len() as u32;
    let (low, high) = (DVec3::new(-0.3, -1.0, middle.z - half.z), DVec3::new(0.3, -0.4, chin - 0.2));
    for corner in 0..8 {
        let of = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        points.push(DVec3::new(of(0), of(1), of(2)));
    }
    let trunk =
        [[0, 1, 3], [0, 3, 2], [4, 5, 7], [4, 7, 6]].map(|corners| corners.map(|corner| first + corner));
    let sources = OutlineSources { vertices, bare: triangles, hair: Vec::new(), trunk: trunk.to_vec() };
    let frame = HeadFrame { origin: DVec3::new(0.0, 10.0, 0.0), length: 2.0 };
    let points: Vec<DVec3> = points.iter().map(|&p| frame.from_unit(p)).collect();
    let outline = Outline::of(&sources, &points, frame, frame.from_unit(DVec3::Y * -0.45).y).unwrap();
    // Squares are .01 wide, rows .03 high of which the outermost counts; the front is read .085 aside, where the ellipsoid is
    // 2 % less deep.
    let near = |is: f64, wanted: f64| (is - wanted).abs() < 0.025;
    assert!(near(outline.middle, middle.z), "{outline:?}");
    for (station, y) in HEIGHTS.into_iter().enumerate() {
        let share = |y: f64| (1.0 - ((y - 0.5) / 0.5_f64).powi(2)).sqrt();
        let least = share(y) - 0.025;
        let most = share(if y < 0.5 { (y + 0.02_f64).min(0.5) } else { y - 0.02 }) + 0.025;
        for (is, half) in [
            (outline.half_widths[station], half.x),
            (outline.fronts[station], half.z),
            (outline.backs[station], half.z),
        ] {
            assert!((half * least..half * most).contains(&is), "{y}: {outline:?}");
        }
    }
    // .9 of the depth at .55, which is .995 of the most: (y - .5) / .5 = -sqrt(1 - .9^2 (1 - .01)).
    assert!(near(outline.occiput, 0.5 - 0.5 * (1.0 - 0.81 * 0.99_f64).sqrt()), "{outline:?}");
    assert!(near(outline.overhang, 0.2) && near(outline.behind, 0.0), "{outline:?}");
}

#[test]
fn a_head_gets_a_childs_outline() {
    let outline = adult_outline();
    let face = FaceLandmarks { eyes: None, nose: None, ears: None, ..adult(1.0) };
    // Without eyes six tenths of the way are done.
    let made = Rows::new(&face, Some(&outline), &AIM, &Features::default(), 0.0);
    let follower = Follower::new(&made.kernels);
    let after = |p: DVec3| follower.place(p, 1.0);
    // The wedge from chin to occiput fills, the forehead comes forward, the muzzle goes back, the cheeks fill.
    let at = |values: &[f64; 8], side: f64, station: usize| {
        after(DVec3::new(0.0, HEIGHTS[station], outline.middle + side * values[station])).z - outline.middle
    };
    // Of .165 that an adult's back lacks at .16, six tenths, two thirds of it by the row of that height.
    assert!(-at(&outline.backs, -1.0, 1) > outline.backs[1] + 0.6 * 0.165 * 2.0 / 3.0 * 0.8);
    assert!(at(&outline.fronts, 1.0, 6) > outline.fronts[6] + 0.015);
    // The mouth lacks .076 to a child's, six tenths of it, two thirds of that by the row of its height.
    assert!(at(&outline.fronts, 1.0, 1) < outline.fronts[1] - 0.6 * 0.076 * 2.0 / 3.0 * 0.8);
    // A child's chin is .065 behind its mouth, this one .05: it goes at least half of six tenths of what is missing further back, and
    // its underside with it.
    let front = |y: f64| {
        let p = DVec3::new(0.0, y, outline.middle + outline.fronts[0]);
        p.z - after(p).z
    };
    let mouth = outline.fronts[1] - at(&outline.fronts, 1.0, 1);
    assert!(front(HEIGHTS[0]) - mouth > 0.6 * 0.015 * 0.5 && front(0.0) > 0.7 * front(HEIGHTS[0]));
    assert!(after(DVec3::new(outline.half_widths[1], HEIGHTS[1], 0.0)).x > 1.1 * outline.half_widths[1]);
    // The neck's lower end stays.
    let neck = DVec3::new(0.1, -0.07, -0.1);
    assert!(after(neck) == neck);
    // What is tied on top of the head goes as one: the same way at any height.
    let moves = |y: f64| {
        let p = DVec3::new(0.1, y, 0.1);
        after(p) - p
    };
    assert!(
        moves(1.0).distance(moves(1.12)) < 1e-12 && moves(1.0).x > 0.005,
        "{} {}",
        moves(1.0),
        moves(1.12)
    );
}

#[test]
fn brows_keep_their_shape() {
    let face = adult(1.0);
    let follower = follower(&face);
    let pair = Pair::of(&face.eyes.as_ref().unwrap().1);
    // Adults' brows are .03 to .11 above the lids, beside the nose and up to the temples.
    let (mut slope, mut height, mut width, mut count) = (0.0, 0.0, 0.0, 0.0);
    for aside in 0..=10 {
        for above in 0..=4 {
            let x = pair.half_distance * (0.5 + 0.1 * f64::from(aside));
            let y = pair.height + pair.half_height + 0.03 + 0.02 * f64::from(above);
            let (_, jacobian) = follower.map(DVec3::new(x, y, 0.30), 1.0);
            slope += jacobian.x_axis.y;
            height += jacobian.y_axis.y;
            width += jacobian.x_axis.x;
            count += 1.0;
        }
    }
    // Ends that rise or sink by a twentieth of a brow's length are seen, and a tenth of its thickness.
    assert!((slope / width).abs() < 0.05, "they tilt by {}", slope / width);
    assert!((height / width - 1.0).abs() < 0.1, "they are {} as thick for their length", height / width);
    assert!(width / count > 1.0, "{width} {count}");
}

#[test]
fn brows_that_frown_become_nearly_level_and_others_stay() {
    let d = 0.142;
    // Outer ends that are higher by .012 are no frown: brows that are quite level look worried.
    for (frown, least, most) in
        [(-0.02, -0.025, -0.018), (0.006, 0.004, 0.008), (0.012, 0.010, 0.016), (0.03, 0.006, 0.016)]
    {
        let [inner, outer] = [(0.5 * d, 0.58), (1.3 * d, 0.58 + frown)].map(|(x, y)| DVec2::new(x, y));
        let face = FaceLandmarks { brows: Some(Brows { inner, outer }), ..adult(1.0) };
        let follower = follower(&face);
        let after = [inner, outer].map(|p| follower.place(p.extend(0.30), 1.0));
        let rises = after[1].y - after[0].y;
        assert!((least..most).contains(&rises), "{frown}: {rises}");
    }
}

#[test]
fn nothing_is_pressed_to_a_quarter_of_its_volume() {
    // The face sinks where the nose shrinks: together they leave what the nose alone may.
    let follower = follower(&adult(1.0));
    check_all(&grid(0.02), |&p| {
        let determinant = follower.map(p, 1.0).1.determinant();
        if determinant > 0.25 { Vec::new() } else { vec![format!("{p}: {determinant}")] }
    });
}

#[test]
fn a_head_that_hangs_before_the_chest_goes_back_and_never_forward() {
    let frame = HeadFrame { origin: DVec3::new(0.0, 10.0, 0.5), length: 2.0 };
    let seat = |overhang: f64, behind: f64, shoulder_line: f64| {
        Seat::new(&Outline { frame, shoulder_line, overhang, behind, ..adult_outline() })
    };
    // The chin may hang .10 head lengths before the chest, the skull .42 behind the back.
    for (overhang, behind, shoulder_line, back) in [
        (0.14, 0.2, -0.4, 0.04),
        (0.3, 0.39, -0.4, 0.03),
        (0.05, 0.2, -0.4, 0.0),
        (0.3, 0.5, -0.4, 0.0),
        (0.5, f64::INFINITY, -0.4, 0.0),
    ] {
        let seat = seat(overhang, behind, shoulder_line);
        assert_eq!(seat.is_some(), back > 0.0, "{overhang}, {behind}");
        let Some(seat) = seat else { continue };
        let off = |y: f64, share: f64| {
            let p = frame.from_unit(DVec3::new(0.1, y, 0.3));
            (seat.place(p, share) - p) / frame.length
        };
        let near = |is: DVec3, wanted: f64| is.distance(-wanted * DVec3::Z) < 1e-12;
        assert!(near(off(0.1, 1.0), back) && near(off(0.9, 1.0), back) && near(off(0.9, 0.3), 0.3 * back));
        assert!(near(off(shoulder_line, 1.0), 0.0) && near(off(-2.0, 1.0), 0.0));
        // Of the neck each height leans as the one below: none further than the head.
        let lean: Vec<f64> =
            (0..50).map(|step| -off(shoulder_line + 0.01 * f64::from(step), 1.0).z).collect();
        assert!(lean.is_sorted() && lean[25] > 0.0, "{lean:?}");
    }
    // However far it hangs out, a short neck leans by less than 45 degrees.
    let short = seat(1.0, -1.0, -0.05).unwrap();
    for step in 0..30 {
        let p = frame.from_unit(DVec3::new(0.0, -0.07 + 0.01 * f64::from(step), 0.0));
        assert!(short.map(p, 1.0).jacobian.y_axis.z.abs() < 1.0);
    }
}

#[test]
fn no_step_of_the_flow_can_fold() {
    let follower = follower(&adult(1.0));
    let points = grid(0.04);
    check_all(&points, |&p| {
        let steepest = (0..STEPS).map(|piece| norm(follower.slope(p, piece))).fold(0.0, f64::max);
        // Two points that a step of slope below 1 moves stay apart, and so do those that an earlier velocity takes to its middle.
        let bound = steepest / STEPS as f64;
        let least = (1..=STEPS).map(|piece| follower.map(p, piece as f64 / STEPS as f64).1.determinant());
        let least = least.fold(f64::INFINITY, f64::min);
        if bound < 1.0 && least > 0.25 {
            Vec::new()
        } else {
            vec![format!("{p}: a step's slope is {bound}, the least determinant on the way {least}")]
        }
    });
}

#[test]
fn the_jacobian_is_that_of_the_flow() {
    let follower = follower(&adult(1.0));
    check_all(&grid(0.13), |&p| {
        const H: f64 = 1e-5;
        let (_, jacobian) = follower.map(p, 0.8);
        let differences = [DVec3::X, DVec3::Y, DVec3::Z]
            .map(|axis| (follower.place(p + H * axis, 0.8) - follower.place(p - H * axis, 0.8)) / (2.0 * H));
        let difference = DMat3::from_cols_array_2d(&differences.map(|column| column.to_array()));
        let off = (jacobian - difference).to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
        // Kinks lie on the middle plane and on windows' rims; slopes there are still the same from both sides.
        if off < 1e-3 { Vec::new() } else { vec![format!("{p}: off by {off}")] }
    });
}

#[test]
fn a_kept_way_is_the_flow_for_any_youth() {
    let follower = follower(&adult(1.0));
    check_all(&grid(0.2), |&p| {
        let way = follower.way(p);
        let differs = |&youth: &f64| along(p, &way, youth).distance(follower.place(p, youth)) > 1e-12;
        let youths = [0.0, 0.03, 1.0 / 12.0, 0.5, 0.77, 1.0];
        youths.iter().filter(|&youth| differs(youth)).map(|youth| format!("{p} at {youth}")).collect()
    });
}

#[test]
fn a_face_with_a_childs_eyes_stays() {
    // e = sqrt(.05 * .017) * 2.5 = .073 > .067.
    assert!(rows(&adult(2.5)).kernels.is_empty());
    assert!(!rows(&adult(1.0)).kernels.is_empty());
}

#[test]
fn the_flow_is_as_symmetric_as_the_face() {
    let follower = follower(&adult(1.0));
    check_all(&grid(0.11), |&p| {
        let mirror = DVec3::new(-1.0, 1.0, 1.0);
        let off = follower.place(p, 1.0).distance(mirror * follower.place(p * mirror, 1.0));
        if off < 1e-12 { Vec::new() } else { vec![format!("{p}: {off}")] }
    });
}

#[test]
fn eyes_reach_the_height_and_the_size_that_are_asked_for() {
    let face = adult(1.0);
    let follower = follower(&face);
    let (_, eyes) = face.eyes.as_ref().unwrap();
    let after = face.mapped(|p| follower.place(p, 1.0));
    let pair = Pair::of(&after.eyes.unwrap().1);
    assert!((pair.height - AIM.eye_height.max(0.5 - 0.07)).abs() < 2e-3, "{pair:?}");
    // The opening grows as the plateau's scale says, 1.40 at most behind lids; the bridge keeps 9 tenths.
    let before = Pair::of(eyes);
    assert!(pair.half_width / before.half_width > 1.3, "{pair:?}");
    let bridge = |pair: Pair| pair.half_distance - pair.half_width;
    assert!(bridge(pair) > 0.85 * bridge(before), "{pair:?}");
}

const YOUNG: [&str; 9] = [
    "makehuman_female_rigged.glb",
    "quaternius_female_casual.glb",
    "quaternius_female_dress.glb",
    "quaternius_male_casual.glb",
    "quaternius_man_2017.glb",
    "valid_aian_m_1_milit.glb",
    "valid_asian_f_1_busi.glb",
    "valid_black_m_2_busi.glb",
    "valid_hispanic_f_2_casual.glb",
];

fn adult_options() -> Options {
    Options { youth: 0.0, seat: 0.0, hair_lay: 0.0, ..Options::default() }
}

/// Each head before and after the stages of the head alone, 2.5 heads tall.
fn head_runs(names: &[&'static str]) -> Vec<[Run; 2]> {
    in_parallel(&present(names), |&name| {
        let character = painted(&all_models()[name]);
        [adult_options(), Options { hair_lay: 0.0, ..Options::default() }]
            .map(|options| Run::of(character.clone(), name, "2.5 heads", &Style::Heads(2.5), &options))
    })
}

#[test]
fn no_head_folds_and_hardly_a_triangle_turns_over() {
    let names: Vec<&'static str> = all_models().keys().map(String::as_str).collect();
    let runs = head_runs(&names);
    let (mut turned, mut count) = (0, 0);
    for [plain, young] in &runs {
        let figure = plain.before();
        let Some(head) = figure.humanoid.joint(Role::Head) else { continue };
        let measured = plain.deformer.target();
        let heights = measured.anatomy.landmarks.heights;
        let origin = DVec3::new(measured.anatomy.middle_x, heights.chin, measured.anatomy.head_joint.z);
        let length = heights.head_length();
        let is_head = |vertex: usize| figure.weight_of(vertex, Role::is_head) > 0.5;
        let vertices = (0..figure.positions.len()).filter(|&vertex| is_head(vertex));
        let points = vertices
            .map(|vertex| figure.positions[vertex])
            .chain(grid(0.1).into_iter().map(|p| origin + length * p));
        for p in points {
            let p = figure.frame.to_model(p);
            let [was, is] = [plain, young].map(|run| run.deformer.map(head, p).jacobian.determinant());
            assert!(is / was > 0.25, "{}: the determinant at {p} is {}", young.name, is / was);
        }
        let [was, is] = [plain, young].map(Run::after);
        let before_this = turned;
        for corners in figure.triangles.iter().filter(|corners| corners.iter().all(|&c| is_head(c as usize)))
        {
            let normal = |figure: &Figure| {
                let [a, b, c] = corners.map(|corner| figure.positions[corner as usize]);
                let longest =
                    (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
                (b - a).cross(c - a) / longest.max(f64::MIN_POSITIVE)
            };
            let (source, before, after) = (normal(figure), normal(&was), normal(&is));
            // A sliver a thousand times as long as it is wide faces no way. Hair that lies on the shoulders of a head that stands
            // elsewhere may lie another way, and not the wrong way round for that.
            let is_hair = corners.iter().all(|&corner| figure.kind(corner as usize) == MeshKind::Hair);
            if before.length() > 1e-3 {
                count += 1;
                if before.dot(after) < 0.0 && !(is_hair && source.dot(after) > 0.0) {
                    turned += 1;
                    let mesh = was.mesh_starts.partition_point(|&start| start <= corners[0] as usize) - 1;
                    let at = (measured.figure.positions[corners[0] as usize] - origin) / length;
                    let name = &young.loaded.character.meshes[mesh].name;
                    println!("{}: a triangle of {name} at {at:.3} turned over", young.name);
                }
            }
        }
        if turned > before_this {
            println!("{}: {} triangles turned over", young.name, turned - before_this);
        }
    }
    println!("{turned} of {count} triangles turned over");
    // Slivers are left as they turn: one triangle of 60,000.
    assert!(turned * 60_000 <= count.max(60_000), "{turned} of {count} triangles turned over");
}

#[test]
fn adults_eyes_sink_to_where_artists_draw_them() {
    check_all(&head_runs(&YOUNG), |[_, young]| {
        let after = Measured::of(&young.loaded.character.with(&young.deformed), &Options::default()).unwrap();
        let Some((_, eyes)) = after.face.and_then(|face| face.eyes) else {
            // A face whose eyes nobody finds keeps their height.
            return Vec::new();
        };
        let height = Pair::of(&eyes).height;
        if (height - 0.40).abs() <= 0.02 { Vec::new() } else { vec![format!("{}: {height}", young.name)] }
    });
}

#[test]
fn a_stylised_face_stays() {
    let Some(godette) = model("godette.vrm") else {
        println!("skipped: godette.vrm is not there");
        return;
    };
    let own = models::style(&godette.character, &Options::default());
    let mut styles = vec![("2.5 heads", Style::Heads(2.5)), ("godette", own)];
    if model("kaykit_rogue.glb").is_some() {
        styles.push(("KayKit", models::style_of("kaykit_rogue.glb", &Options::default())));
    }
    for (name, style) in &styles {
        let [plain, young] = [0.0, 1.0].map(|youth| {
            Run::new(
                "godette.vrm",
                name,
                style,
                &Options { youth, seat: 0.0, hair_lay: 0.0, ..Options::default() },
            )
        });
        let head = plain.deformer.target().anatomy.landmarks.heights.head_length();
        let [was, is] = [&plain, &young].map(|run| models::positions(&run.deformed));
        let furthest = was.iter().zip(&is).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(furthest <= 1e-3 * head, "{name}: {}", furthest / head);
    }
}

/// Eyes of this source, whose height, half distance and half width are within .03 of the head of what a person sees.
fn check_eyes(face: &FaceLandmarks, from: EyeSource, seen: [f64; 3]) {
    let (source, eyes) = face.eyes.as_ref().expect("it has eyes");
    let pair = Pair::of(eyes);
    assert_eq!(*source, from);
    for (is, seen) in [pair.height, pair.half_distance, pair.half_width].into_iter().zip(seen) {
        assert!((is - seen).abs() < 0.03, "{pair:?}");
    }
}

#[test]
fn eyes_sewn_to_the_skin_are_found() {
    const MAN: &str = "quaternius_man_2017.glb";
    if model(MAN).is_none() {
        println!("skipped: {MAN} is not there");
        return;
    }
    // As its picture shows them: balls of .045 of the head, a quarter of it apart, a little above its middle.
    check_eyes(&measured(MAN).face.unwrap(), EyeSource::Twins, [0.53, 0.13, 0.022]);
}

#[test]
fn eyes_are_where_a_host_says_they_are() {
    let Some(man) = model("quaternius_knight.glb") else {
        println!("skipped: quaternius_knight.glb is not there");
        return;
    };
    let plain = measured("quaternius_knight.glb");
    assert!(plain.face.as_ref().unwrap().eyes.is_none());
    let heights = plain.anatomy.landmarks.heights;
    let length = heights.head_length();
    let place = |side: f64, y: f64| {
        let p = DVec3::new(plain.anatomy.middle_x + 0.15 * side * length, heights.chin + y * length, 0.0);
        plain.figure.frame.to_model(p)
    };
    let eye =
        |side: f64, y: f64, half_width: f64| EyeHint { middle: place(side, y), half_width, half_height: 0.0 };
    let of = |eye: Option<EyeHint>, other_eye: Option<EyeHint>| {
        let mut character = man.character.clone();
        character.face_hints = FaceHints { eye, other_eye };
        let deformer = Deformer::new(Arc::new(character), &Style::Heads(2.5), &Options::default()).unwrap();
        let warned = deformer.warnings().iter().any(|warning| warning.code == "face_eyes_not_found");
        (deformer.target().face.clone().unwrap().eyes, warned)
    };
    let (none, warned) = of(None, None);
    assert!(none.is_none() && warned);
    // One eye stands for both; the sizes are those that are said, or an adult's.
    let (both, warned) = of(Some(eye(1.0, 0.45, 0.05 * length)), None);
    let (source, eyes) = both.unwrap();
    assert!(source == EyeSource::Hints && !warned);
    let pair = Pair::of(&eyes);
    assert!((pair.height - 0.45).abs() < 1e-6 && (pair.half_distance - 0.15).abs() < 1e-6, "{pair:?}");
    assert!((pair.half_width - 0.05).abs() < 1e-6 && pair.half_height > 0.02, "{pair:?}");
    let (both, _) = of(Some(eye(-1.0, 0.45, 0.0)), Some(eye(1.0, 0.45, 0.0)));
    assert!((Pair::of(&both.unwrap().1).half_distance - 0.15).abs() < 1e-6);
    // No eye is above the crown.
    let (none, warned) = of(Some(eye(1.0, 1.4, 0.0)), None);
    assert!(none.is_none() && warned);
}

#[test]
fn sliders_of_the_head_give_what_a_new_deformer_gives() {
    let names =
        present(&["makehuman_female_rigged.glb", "quaternius_male_casual.glb", "valid_aian_m_1_milit.glb"]);
    if names.is_empty() {
        println!("skipped: none of these models is there");
        return;
    }
    let of = |youth, seat, hair_lay, smile| Options { youth, seat, hair_lay, smile, ..Options::default() };
    let steps = [
        of(0.4, 1.0, 1.0, 0.0),
        of(0.7, 1.0, 1.0, 0.0),
        of(0.7, 0.5, 1.0, 0.0),
        of(0.7, 0.5, 0.3, 0.0),
        of(0.0, 0.5, 0.3, 0.0),
        of(0.0, 0.0, 0.0, 0.0),
        of(0.6, 0.0, 0.0, 1.0),
        Options { face_squash: Some(0.2), ..of(0.6, 1.0, 1.0, 0.0) },
        of(1.0, 1.0, 1.0, 0.0),
    ];
    check_all(&names, |&name| {
        let character = Arc::new(all_models()[name].character.clone());
        let style = Style::Heads(2.5);
        let new = |options: &Options| Deformer::new(Arc::clone(&character), &style, options).unwrap();
        let mut deformer = new(&Options::default());
        let head = deformer.target().figure.humanoid.joint(Role::Head).unwrap();
        let at = deformer.target().figure.frame.to_model(deformer.target().anatomy.head_centre);
        let mut wrong = Vec::new();
        for (step, options) in steps.iter().enumerate() {
            deformer.set_options(options, &mut Progress::none()).unwrap();
            let fresh = new(options);
            let (slid, made) = (deformer.apply(), fresh.apply());
            let is_same = models::positions(&slid) == models::positions(&made) && slid.joints == made.joints;
            if !is_same || deformer.map(head, at) != fresh.map(head, at) {
                wrong.push(format!("{name}: step {step} differs"));
            }
        }
        wrong
    });
}
