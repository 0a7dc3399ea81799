//! Rays beside Embree's (`rays.py`): writes a body's triangles and rays into a folder, and prints the least times of both kinds
//! of tree, in milliseconds: to build, first hits and how many, all hits and how many.

use glam::DVec3;
use std::path::PathBuf;
use std::time::Instant;
use superdeform::internals::geometry::Surface;
use superdeform_benches::{models, refined};

/// Vertices of the body.
const VERTICES: usize = 50_000;
/// Rays, from points within the body's box in all directions.
const RAYS: u32 = 100_000;

fn main() -> std::io::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).expect("a folder to write to"));
    let body = models::bodies().pop().expect("there is one without files");
    let (positions, triangles) = refined(&body.positions, &body.triangles, VERTICES);
    // Both get the same numbers, which are floats.
    let positions: Vec<DVec3> = positions.iter().map(|p| p.as_vec3().as_dvec3()).collect();
    let (low, high) = positions
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
    // Evenly: multiples of irrational numbers, less their whole parts.
    let part = |index: u32, step: f64| (f64::from(index) * step).fract();
    let rays: Vec<[DVec3; 2]> = (0..RAYS)
        .map(|index| {
            let at = DVec3::new(
                part(index, 0.819_172_513),
                part(index, 0.671_043_607),
                part(index, 0.549_700_478),
            );
            let (sin, cos) = (std::f64::consts::TAU * part(index, 0.618_033_989)).sin_cos();
            let y = 2.0 * part(index, 0.414_213_562) - 1.0;
            let flat = (1.0 - y * y).sqrt();
            [low + at * (high - low), DVec3::new(flat * cos, y, flat * sin)].map(|v| v.as_vec3().as_dvec3())
        })
        .collect();
    let floats = |points: &mut dyn Iterator<Item = DVec3>| -> Vec<u8> {
        points.flat_map(|p| p.as_vec3().to_array()).flat_map(f32::to_le_bytes).collect()
    };
    std::fs::write(folder.join("positions"), floats(&mut positions.iter().copied()))?;
    std::fs::write(folder.join("rays"), floats(&mut rays.iter().flatten().copied()))?;
    let corners: Vec<u8> = triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes()).collect();
    std::fs::write(folder.join("triangles"), corners)?;
    for make in [Surface::new, Surface::for_many] {
        let mut least = [f64::INFINITY; 3];
        let mut found = [0; 2];
        for _ in 0..5 {
            let clock = Instant::now();
            let surface = make(&positions, &triangles);
            let mut times = vec![clock.elapsed()];
            for every in [false, true] {
                let clock = Instant::now();
                let hits = rays.iter().map(|&[origin, direction]| match every {
                    true => surface.all_hits(origin, direction).len(),
                    false => usize::from(surface.first_hit(origin, direction, f64::INFINITY).is_some()),
                });
                found[usize::from(every)] = hits.sum();
                times.push(clock.elapsed());
            }
            for (least, time) in least.iter_mut().zip(times) {
                *least = least.min(time.as_secs_f64() * 1e3);
            }
        }
        println!("{} {} {} {} {}", least[0], least[1], found[0], least[2], found[1]);
    }
    Ok(())
}
