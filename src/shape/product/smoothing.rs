//! Smooths the weights of the parts along the mesh, then across layers of cloth (product mode).

use super::part::{PART_COUNT, Part, PartWeights, TINY, add};
use super::profile::chains::arm_share;
use crate::error::Result;
use crate::geometry::point_tree::{Near, PointTree};
use crate::geometry::{Neighbours, ROUNDING, Weld, double_area, neighbours, slots, smoothstep, upper_median};
use crate::parallel;
use crate::progress::Progress;
use crate::shape::figure::Figure;
use glam::DVec3;

/// One step of smoothing along the mesh moves a vertex's weights this far to the mean of its neighbours'. D26; above 1
/// it would swing.
const UMBRELLA_STEP: f32 = 0.6;
/// The width of both kinds of smoothing, as a share of H. D26. Seen: wider turns fewer triangles over, and creases go.
const SMOOTHING_WIDTH: f64 = 0.012;
/// Steps along the mesh for the square of that width in edges: what they spread grows with their root. D26.
const PASSES_PER_SQUARE: f64 = 10.0;
/// A Gaussian beyond so many standard deviations is nothing.
const LAYER_REACH: f64 = 3.0;
/// Bounds of the number of steps along the mesh. D26; the upper one is for time. Seen: it costs fine uniforms some
/// turned triangles.
const UMBRELLA_PASSES: (f64, f64) = (4.0, 60.0);
/// Steps across layers. D26. Seen: without, skin shows through tights.
const LAYER_PASSES: usize = 3;
/// Vertices that each step across layers takes into account. D26. Seen: of 154 results 350 triangles turn, 405 where half as many
/// are taken, which under a hem of few triangles are all one shoe's.
pub(super) const LAYER_NEIGHBOURS: usize = 64;
/// What smoothing leaves a vertex of a part that is less than this is nothing. Seen: it moves vertices by .0005 H, one by .005; with dust
/// of the trunk in a fine face, a change of a limb's length took 51 ms, for the younger face anew, and takes 14.
const DUST: f32 = 1e-3;

/// Umbrella steps on the welded mesh; `frozen` vertices stay.
///
/// # Errors
/// `Cancelled`.
pub fn smooth_along(
    figure: &Figure,
    weld: &Weld,
    frozen: &[bool],
    parts: &mut [PartWeights],
    threads: usize,
    progress: &mut Progress,
) -> Result<()> {
    let around = neighbours(&figure.triangles, weld);
    let firsts = weld.first_vertices();
    let place = |welded: usize| figure.positions[firsts[welded] as usize];
    let edges =
        (0..weld.count).flat_map(|one| around.of(one).iter().map(move |&other| (one, other as usize)));
    let edges = edges.filter(|(one, other)| other > one);
    let lengths = edges.map(|(one, other)| place(one).distance(place(other)));
    let Some(median) = upper_median(lengths) else { return Ok(()) };
    let width = SMOOTHING_WIDTH * figure.height() / median.max(f64::MIN_POSITIVE);
    let passes =
        (PASSES_PER_SQUARE * width * width).clamp(UMBRELLA_PASSES.0, UMBRELLA_PASSES.1).round() as usize;

    // Vertices at one place share one row from here on: their mean, so that seams stay closed.
    let mut rows = vec![[0.0f32; PART_COUNT]; weld.count];
    let mut counts = vec![0.0f32; weld.count];
    let still = weld.any(frozen);
    for (vertex, row) in parts.iter().enumerate() {
        let welded = weld.representative[vertex] as usize;
        // Where hair is rooted in the scalp both must move as the frozen one does.
        if still[welded] == frozen[vertex] {
            add(&mut rows[welded], row, 1.0);
            counts[welded] += 1.0;
        }
    }
    for (row, count) in rows.iter_mut().zip(&counts) {
        row.iter_mut().for_each(|weight| *weight /= count.max(1.0));
    }
    // Parts do not mix, so each thread takes some of them; parts of one limb touch the same vertices.
    let threads = if weld.count < parallel::FEW { 1 } else { threads };
    let smooth = |(): &mut (), group: usize| {
        let columns: Vec<[f32; 4]> =
            rows.iter().map(|row| SMOOTHED_TOGETHER[group].map(|part| row[part as usize])).collect();
        umbrella_steps(columns, &around, &still, passes)
    };
    let smoothed = progress.collect_with(threads, SMOOTHED_TOGETHER.len(), 1, || (), smooth)?;
    for (vertex, row) in parts.iter_mut().enumerate() {
        let welded = weld.representative[vertex] as usize;
        for (group, columns) in SMOOTHED_TOGETHER.iter().zip(&smoothed) {
            for (&part, &weight) in group.iter().zip(&columns[welded]) {
                row[part as usize] = weight;
            }
        }
    }
    Ok(())
}

/// All parts, in groups that are smoothed together.
const SMOOTHED_TOGETHER: [[Part; 4]; 4] = [
    [Part::Torso, Part::Neck, Part::Head, Part::Hair],
    [Part::LeftUpperArm, Part::LeftLowerArm, Part::LeftHand, Part::LeftFoot],
    [Part::RightUpperArm, Part::RightLowerArm, Part::RightHand, Part::RightFoot],
    [Part::LeftUpperLeg, Part::LeftLowerLeg, Part::RightUpperLeg, Part::RightLowerLeg],
];

/// `passes` steps towards the mean of the neighbours, for the weights of four parts; `still` vertices stay.
fn umbrella_steps(
    mut rows: Vec<[f32; 4]>,
    around: &Neighbours,
    still: &[bool],
    passes: usize,
) -> Vec<[f32; 4]> {
    // Weights reach one edge further with each step: what lies beyond stays 0.
    let mut reached: Vec<bool> = rows.iter().map(|row| *row != [0.0; 4]).collect();
    let mut moving: Vec<u32> = (0..rows.len() as u32).filter(|&vertex| reached[vertex as usize]).collect();
    let mut first = 0;
    for _ in 0..passes {
        let last = moving.len();
        for index in first..last {
            for &other in around.of(moving[index] as usize) {
                if !reached[other as usize] && !still[other as usize] {
                    reached[other as usize] = true;
                    moving.push(other);
                }
            }
        }
        first = last;
    }
    moving.retain(|&vertex| !still[vertex as usize] && !around.of(vertex as usize).is_empty());
    moving.sort_unstable();
    let mut before = rows.clone();
    for _ in 0..passes {
        std::mem::swap(&mut rows, &mut before);
        for &vertex in &moving {
            let near = around.of(vertex as usize);
            let share = 1.0 / near.len() as f32;
            let mut mean = [0.0f32; 4];
            for &other in near {
                let row = before[other as usize];
                for part in 0..4 {
                    mean[part] += row[part] * share;
                }
            }
            let own = before[vertex as usize];
            rows[vertex as usize] =
                std::array::from_fn(|part| own[part] + UMBRELLA_STEP * (mean[part] - own[part]));
        }
    }
    rows
}

/// Where the legs part.
#[derive(Clone, Copy, Debug)]
pub struct Fork {
    /// Height of the crotch.
    pub crotch: f64,
    /// How far below it left and right do not mix any more.
    pub apart: f64,
}

impl Fork {
    /// How far a point with weights `row` is the left leg's (above 0) or the right one's: below the crotch up to 1.
    fn side(&self, p: DVec3, row: &PartWeights) -> f32 {
        let leg = |first: Part| row[first as usize..first as usize + 3].iter().sum::<f32>();
        let below = smoothstep((self.crotch - p.y) / self.apart.max(TINY)) as f32;
        below * (leg(Part::LeftUpperLeg) - leg(Part::RightUpperLeg))
    }
}

/// A place that layers are smoothed over.
#[derive(Clone, Copy, Debug)]
struct Sample {
    p: DVec3,
    /// Of the surface around it.
    area: f32,
    /// How much of it each arm moves.
    arms: [f32; 2],
    /// See [`Fork::side`].
    side: f32,
}

impl Sample {
    /// How much of `other` counts here: nothing where an arm moves all of one and nothing of the other, or each leg one.
    fn mixes(&self, other: &Self) -> f32 {
        let arms = [0, 1].map(|side| 1.0 - (self.arms[side] - other.arms[side]).abs());
        arms[0].max(0.0) * arms[1].max(0.0) * (1.0 + self.side * other.side).clamp(0.0, 1.0)
    }
}

/// A Gaussian over the surface of all near meshes, so that cloth and body move together: each vertex counts by the area around it,
/// or a hem of few triangles over a shoe of many would be a shoe. An arm and the rest do not mix, as far as one is moved by it and
/// the other is not: a hand on the hip must not carry the hip along. Left and right leg do not either, below the `fork`: trousers'
/// insides lie nearer to each other than to their fronts, and what both legs move would stay in the middle while the legs step
/// apart. `frozen` vertices stay, all or none at a place.
///
/// # Errors
/// `Cancelled`.
pub fn smooth_across(
    figure: &Figure,
    weld: &Weld,
    frozen: &[bool],
    fork: Fork,
    parts: &mut [PartWeights],
    threads: usize,
    progress: &mut Progress,
) -> Result<()> {
    let sigma = SMOOTHING_WIDTH * figure.height();
    let areas = areas(figure, weld, sigma);
    // Vertices at one place are one sample and get one result.
    let (places, (samples, rows)): (Vec<u32>, (Vec<Sample>, Vec<PartWeights>)) = (0..)
        .zip(weld.first_vertices())
        .filter(|&(_, first)| !frozen[first as usize])
        .map(|(place, first)| {
            let (p, row) = (figure.positions[first as usize], parts[first as usize]);
            let arms = [0, 1].map(|side| arm_share(&row, side));
            (place, (Sample { p, area: areas[place as usize], arms, side: fork.side(p, &row) }, row))
        })
        .unzip();
    let smoothed = layer_steps(&samples, rows, sigma, threads, progress)?;
    let sample_of = slots(weld.count, &places);
    for (vertex, row) in parts.iter_mut().enumerate() {
        if !frozen[vertex] {
            *row = smoothed[sample_of[weld.representative[vertex] as usize] as usize];
        }
        row.iter_mut().for_each(|weight| *weight *= f32::from(*weight > DUST));
        let total: f32 = row.iter().sum();
        row.iter_mut().for_each(|weight| *weight /= total);
    }
    Ok(())
}

/// The area of the triangles around each welded vertex, twice that in squares of side `unit`.
fn areas(figure: &Figure, weld: &Weld, unit: f64) -> Vec<f32> {
    let mut areas = vec![0.0; weld.count];
    for &corners in &figure.triangles {
        let area = (double_area(&figure.positions, corners).length() / (unit * unit)) as f32;
        corners.iter().for_each(|&vertex| areas[weld.representative[vertex as usize] as usize] += area);
    }
    areas
}

/// The points that one point is smoothed with, in the order of the tree, and their weights; where there are fewer, itself with none.
type Layer = [(u32, f32); LAYER_NEIGHBOURS];

/// `LAYER_PASSES` Gaussian means of `rows` over the nearest samples within [`LAYER_REACH`] standard deviations, `sigma` each.
fn layer_steps(
    samples: &[Sample],
    rows: Vec<PartWeights>,
    sigma: f64,
    threads: usize,
    progress: &mut Progress,
) -> Result<Vec<PartWeights>> {
    let points: Vec<DVec3> = samples.iter().map(|sample| sample.p).collect();
    let tree = PointTree::new(&points);
    let reach = LAYER_REACH * sigma;
    progress.at(0.1)?;
    let layers = progress.part(0.1, 0.7).collect_with(
        threads,
        points.len(),
        parallel::FEW_RAYS,
        || (Vec::<Near>::new(), None::<DVec3>),
        |(found, last), slot| {
            let p = tree.point(slot);
            // Slots that follow each other are near each other: the neighbours of the last one bound the search.
            let bound = match (*last, found.get(LAYER_NEIGHBOURS - 1)) {
                (Some(last), Some(furthest)) => {
                    reach.min((furthest.distance() + p.distance(last)) * (1.0 + ROUNDING))
                }
                _ => reach,
            };
            tree.nearest(p, LAYER_NEIGHBOURS, bound, found);
            *last = Some(p);
            let gaussian = |distance: f64| (-(distance * distance) / (2.0 * sigma * sigma)).exp();
            // The kernel ends at the last point that was found: which of several at that distance it is must not
            // matter, or the last digits of a model would show.
            let end = gaussian(found.get(LAYER_NEIGHBOURS - 1).map_or(reach, |last| last.distance()));
            let sample = |slot: u32| &samples[tree.indices()[slot as usize] as usize];
            let own = sample(slot as u32);
            let mut layer: Layer = [(slot as u32, 0.0); LAYER_NEIGHBOURS];
            for ((other, weight), near) in layer.iter_mut().zip(&*found) {
                *other = near.slot();
                let sample = sample(near.slot());
                *weight = (gaussian(near.distance()) - end).max(0.0) as f32 * own.mixes(sample) * sample.area;
            }
            layer
        },
    )?;
    let mut ordered: Vec<PartWeights> = tree.indices().iter().map(|&index| rows[index as usize]).collect();
    for pass in 0..LAYER_PASSES {
        progress.at(0.7 + 0.1 * pass as f32)?;
        ordered = parallel::collect(threads, points.len(), parallel::FEW_RAYS, |slot| {
            let mut sum = [0.0; PART_COUNT];
            let mut total = 0.0;
            for &(other, weight) in layers[slot].iter().filter(|near| near.1 != 0.0) {
                add(&mut sum, &ordered[other as usize], weight);
                total += weight;
            }
            // So many points at one place, and points without a triangle, have no kernel.
            if total > 0.0 { sum.map(|weight| weight / total) } else { ordered[slot] }
        });
    }
    let mut smoothed = rows;
    for (&index, row) in tree.indices().iter().zip(ordered) {
        smoothed[index as usize] = row;
    }
    Ok(smoothed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of the left leg's points beside one of the right leg's, nearer to each other than the smoothing is wide.
    fn legs(fork: &Fork) -> Vec<PartWeights> {
        let mut points = Vec::new();
        let mut rows = Vec::new();
        for (x, part) in [(0.002, Part::LeftUpperLeg), (-0.002, Part::RightUpperLeg)] {
            for row in 0..40 {
                for column in 0..10 {
                    points.push(DVec3::new(x, 0.01 * f64::from(row), 0.01 * f64::from(column)));
                    rows.push(part.alone());
                }
            }
        }
        let sample = |(&p, row): (&DVec3, &PartWeights)| Sample {
            p,
            area: 1.0,
            arms: [0.0; 2],
            side: fork.side(p, row),
        };
        let samples: Vec<Sample> = points.iter().zip(&rows).map(sample).collect();
        layer_steps(&samples, rows, 0.012, 1, &mut Progress::none()).unwrap()
    }

    #[test]
    fn legs_side_by_side_keep_to_themselves_below_the_fork() {
        let rows = legs(&Fork { crotch: 0.4, apart: 0.1 });
        let mixed = |row: usize| rows[10 * row + 5][Part::RightUpperLeg as usize];
        // Nothing from as far below the fork as three steps over five dozen points reach; at the crotch: all that layers share.
        assert!((0..22).all(|row| mixed(row) == 0.0));
        assert!(mixed(39) > 0.2, "{}", mixed(39));
        // And no step in between: a tenth of the head's length is some ten rows.
        assert!((0..39).all(|row| (mixed(row + 1) - mixed(row)).abs() < 0.2));
        // Above the crotch they mix as any layers do.
        let above = legs(&Fork { crotch: -1.0, apart: 0.1 });
        assert!((above[5 * 40][Part::RightUpperLeg as usize] - 0.5).abs() < 0.05);
    }

    #[test]
    fn a_layer_counts_by_its_area_and_not_by_its_vertices() {
        // Two sheets, one above the other and much nearer to it than the smoothing is wide: 1 vertex for each square of that width,
        // and as many or 4.
        let sigma = 1.0;
        let sheet = |count: usize, y: f64, part: Part| {
            let step = 4.0 / count as f64;
            let place = move |index: usize| step * (index as f64 + 0.5);
            (0..count * count).map(move |index| {
                (
                    DVec3::new(place(index % count), y, place(index / count)),
                    part.alone(),
                    (step * step) as f32,
                )
            })
        };
        let mixed = |fine: usize, coarse: usize| {
            let all: Vec<_> =
                sheet(fine, 0.0, Part::LeftFoot).chain(sheet(coarse, 0.01, Part::LeftLowerLeg)).collect();
            let sample =
                |&(p, _, area): &(DVec3, PartWeights, f32)| Sample { p, area, arms: [0.0; 2], side: 0.0 };
            let samples: Vec<Sample> = all.iter().map(sample).collect();
            let rows = all.iter().map(|one| one.1).collect();
            let rows = layer_steps(&samples, rows, sigma, 1, &mut Progress::none()).unwrap();
            let middle = fine * fine + coarse * coarse / 2 + coarse / 2;
            rows[middle][Part::LeftFoot as usize]
        };
        // Halves of both, as sheets of equal area have it; by vertices the foot's would be .8.
        assert!((mixed(4, 4) - 0.5).abs() < 0.02, "{}", mixed(4, 4));
        assert!((mixed(8, 4) - 0.5).abs() < 0.1, "{}", mixed(8, 4));
    }

    #[test]
    fn what_an_arm_moves_mixes_with_the_rest_as_far_as_both_are_its() {
        // A sheet that an arm moves over one of the trunk, each wholly, and as skin and cloth of an armpit: by a little more than
        // half, and a little less.
        let mixed = |shares: [f32; 2]| {
            let mut samples = Vec::new();
            let mut rows = Vec::new();
            for (y, share) in [0.0, 0.01].into_iter().zip(shares) {
                for index in 0..25 {
                    let p = DVec3::new(f64::from(index % 5), y, f64::from(index / 5));
                    samples.push(Sample { p, area: 1.0, arms: [share, 0.0], side: 0.0 });
                    let mut row = [0.0; PART_COUNT];
                    (row[Part::LeftUpperArm as usize], row[Part::Torso as usize]) = (share, 1.0 - share);
                    rows.push(row);
                }
            }
            let rows = layer_steps(&samples, rows, 1.0, 1, &mut Progress::none()).unwrap();
            [12, 37].map(|middle| rows[middle][Part::LeftUpperArm as usize])
        };
        assert_eq!(mixed([1.0, 0.0]), [1.0, 0.0]);
        // Three means, of which each has .9 of the other for one of its own, leave next to nothing of a tenth.
        let [skin, cloth] = mixed([0.55, 0.45]);
        assert!((skin - cloth).abs() < 1e-3, "{skin} {cloth}");
    }
}
