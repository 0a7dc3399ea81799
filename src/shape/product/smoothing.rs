//! Smooths the weights of the parts, along the surface and across layers of cloth alike (product mode).

use super::part::{PART_COUNT, Part, PartWeights, TINY, add};
use super::profile::chains::arm_share;
use crate::error::Result;
use crate::geometry::point_tree::{Near, PointTree};
use crate::geometry::{ROUNDING, Weld, double_area, smoothstep, upper_median};
use crate::parallel;
use crate::progress::Progress;
use crate::shape::figure::Figure;
use glam::DVec3;

/// The width of one step, as a share of H. D26.
const STEP_WIDTH: f64 = 0.012;
/// Where the surface is coarse a step is as wide as the first of these parts of the root of twice the area around a place, most of an
/// edge, and at most the second number of steps: or what is further apart would not be smoothed at all. D26. Seen: ankles of a low-poly
/// figure stretch 3.0-fold in a run, at .30 3.4-fold, at .25 4.6-fold; without the second a crown of a dozen triangles is drawn to the
/// neck by .005 H.
const COARSE: (f64, f64) = (0.35, 2.0);
/// The width of all of them together, in widths of one: wider turns fewer triangles over, and creases go. D26.
const WIDTH: f64 = 2.6;
/// Bounds of the number of steps: the more vertices there are, the less far one of them reaches. The upper one is for time. D26.
const PASSES: (f64, f64) = (3.0, 30.0);
/// A Gaussian beyond so many standard deviations is nothing.
const LAYER_REACH: f64 = 3.0;
/// Vertices that each step across layers takes into account. D26. Seen: of 154 results 350 triangles turn, 405 where half as many
/// are taken, which under a hem of few triangles are all one shoe's.
pub(super) const LAYER_NEIGHBOURS: usize = 64;
/// What smoothing leaves a vertex of a part that is less than this is nothing. Seen: it moves vertices by .0005 H, one by .005; with dust
/// of the trunk in a fine face, a change of a limb's length took 51 ms, for the younger face anew, and takes 14.
const DUST: f32 = 1e-3;

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
/// apart. `frozen` vertices stay.
///
/// # Errors
/// `Cancelled`.
pub fn smooth(
    figure: &Figure,
    weld: &Weld,
    frozen: &[bool],
    fork: Fork,
    parts: &mut [PartWeights],
    threads: usize,
    progress: &mut Progress,
) -> Result<()> {
    let sigma = STEP_WIDTH * figure.height();
    let areas = areas(figure, weld, sigma);
    // Vertices at one place share one row, so that seams stay closed: the mean of theirs, or of the frozen ones where some are, as
    // hair and the scalp that it is rooted in must move alike.
    let still = weld.any(frozen);
    let mut rows = vec![[0.0f32; PART_COUNT]; weld.count];
    let mut counts = vec![0.0f32; weld.count];
    for (vertex, row) in parts.iter().enumerate() {
        let place = weld.representative[vertex] as usize;
        if still[place] == frozen[vertex] {
            add(&mut rows[place], row, 1.0);
            counts[place] += 1.0;
        }
    }
    for (row, count) in rows.iter_mut().zip(&counts) {
        row.iter_mut().for_each(|weight| *weight /= count.max(1.0));
    }
    let firsts = weld.first_vertices();
    let places: Vec<usize> = (0..weld.count).filter(|&place| !still[place]).collect();
    let sample = |&place: &usize| {
        let (p, row) = (figure.positions[firsts[place] as usize], rows[place]);
        let arms = [0, 1].map(|side| arm_share(&row, side));
        (Sample { p, area: areas[place], arms, side: fork.side(p, &row) }, row)
    };
    let (samples, before): (Vec<Sample>, Vec<PartWeights>) = places.iter().map(sample).unzip();
    for (place, row) in places.iter().zip(layer_steps(&samples, before, sigma, threads, progress)?) {
        rows[*place] = row;
    }
    for (vertex, row) in parts.iter_mut().enumerate() {
        *row = without_dust(rows[weld.representative[vertex] as usize]);
    }
    Ok(())
}

/// The row without what is less than [`DUST`]; the rest sums to 1.
fn without_dust(row: PartWeights) -> PartWeights {
    let row = row.map(|weight| weight * f32::from(weight > DUST));
    let total: f32 = row.iter().sum();
    row.map(|weight| weight / total)
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

/// Gaussian means of `rows` over the nearest samples within [`LAYER_REACH`] standard deviations, `sigma` each or, where the surface is
/// coarse, more.
fn layer_steps(
    samples: &[Sample],
    rows: Vec<PartWeights>,
    sigma: f64,
    threads: usize,
    progress: &mut Progress,
) -> Result<Vec<PartWeights>> {
    let points: Vec<DVec3> = samples.iter().map(|sample| sample.p).collect();
    let tree = PointTree::new(&points);
    progress.at(0.1)?;
    let layers = progress.part(0.1, 0.7).collect_with(
        threads,
        points.len(),
        parallel::FEW_RAYS,
        || (Vec::<Near>::new(), None::<DVec3>),
        |(found, last), slot| {
            let sample = |slot: usize| &samples[tree.indices()[slot] as usize];
            let (p, own) = (tree.point(slot), sample(slot));
            let sigma = sigma * (COARSE.0 * f64::from(own.area).sqrt()).clamp(1.0, COARSE.1);
            let reach = LAYER_REACH * sigma;
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
            let mut layer: Layer = [(slot as u32, 0.0); LAYER_NEIGHBOURS];
            let (mut squares, mut total) = (0.0, 0.0);
            for ((other, weight), near) in layer.iter_mut().zip(&*found) {
                *other = near.slot();
                let sample = sample(near.slot() as usize);
                *weight = (gaussian(near.distance()) - end).max(0.0) as f32 * own.mixes(sample) * sample.area;
                squares += f64::from(*weight) * near.distance().powi(2);
                total += f64::from(*weight);
            }
            // With the square of how far it spreads.
            (layer, squares / total)
        },
    )?;
    // Where nothing is near, nothing spreads.
    let spreads = layers.iter().map(|layer| layer.1).filter(|square| *square > 0.0);
    let passes = upper_median(spreads).map_or(0.0, |step| (WIDTH * sigma).powi(2) / step);
    let passes = passes.clamp(PASSES.0, PASSES.1).round() as usize;
    let mut ordered: Vec<PartWeights> = tree.indices().iter().map(|&index| rows[index as usize]).collect();
    for pass in 0..passes {
        progress.at(0.7 + 0.3 * pass as f32 / passes as f32)?;
        ordered = parallel::collect(threads, points.len(), parallel::FEW_RAYS, |slot| {
            let mut sum = [0.0; PART_COUNT];
            let mut total = 0.0;
            for &(other, weight) in layers[slot].0.iter().filter(|near| near.1 != 0.0) {
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
        let rows = layer_steps(&samples, rows, 0.012, 1, &mut Progress::none()).unwrap();
        rows.into_iter().map(without_dust).collect()
    }

    #[test]
    fn legs_side_by_side_keep_to_themselves_below_the_fork() {
        let rows = legs(&Fork { crotch: 0.4, apart: 0.1 });
        let mixed = |row: usize| rows[10 * row + 5][Part::RightUpperLeg as usize];
        // Nothing but dust from as far below the fork as the steps reach; at the crotch: all that layers share.
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
