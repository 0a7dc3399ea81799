//! Strands of hair before anything moves: what hangs on what, which way each runs, how far down, and what lies on the body.
//!
//! All is found by sums over places and their links, so that no last digit decides anything.

use super::face_input::head_frame;
use super::joint_bindings::{nearness, weight_rows};
use super::outside::volume;
use super::part::Part;
use super::parting::sides;
use super::pieces::Attachment;
use super::worn::Worn;
use crate::character::Character;
use crate::face::head::HeadFrame;
use crate::geometry::laplacian::Cholesky;
use crate::geometry::{
    Groups, NONE, PointTree, Surface, Weld, bounds, components, marked, range, slots, smoothstep,
};
use crate::parallel;
use crate::shape::Measured;
use crate::shape::field::Binding;
use crate::shape::figure::Figure;
use glam::DVec3;

/// Hair above the first of these heights, in head lengths above the chin, is held by the head more and more, above the second it
/// goes with the head.
const HELD: (f64, f64) = (0.75, 0.9);
/// How firmly the head holds hair at most, and all hair: so many times as much as it holds together.
const HELD_BY: (f64, f64) = (100.0, 1e-6);
/// The thickness of a lock, in head lengths: a strand's direction is the mean over this length, and pieces of hair
/// hang together that are so near.
const THICKNESS: f64 = 0.12;
/// So many neighbours of each place hang on it in other pieces.
const NEIGHBOURS: usize = 24;
/// How firmly: against an edge of the same length.
const NEAR_FIRMNESS: f64 = 0.16;
/// No link counts as shorter than this, in head lengths.
const SHORTEST: f64 = 0.01;
/// A way down counts with this power of its steepness, and leads on where it is steeper than the second.
const STEEPNESS: (i32, f64) = (4, 0.1);
/// Beads, bands and ribbons: pieces smaller than the first, in head lengths, keep their shape, those larger than the second do not.
const SMALL: (f64, f64) = (0.25, 0.35);
/// Hair nearer to the body than the first of these lies on it, further off than the second it does not; head lengths.
const LYING: (f64, f64) = (0.1, 0.3);
/// Hair that high above the chin lies on the head alone; head lengths.
const ON_BODY: (f64, f64) = (0.25, 0.4);
/// How far hair reaches is looked at in rows of this height; head lengths.
const ROW: f64 = 0.04;
/// How much the outermost places count for it: the exponent of a mean.
const OUTER: i32 = 32;
/// What is hair by more than this is, and goes as hair does by as much as it is so by more: skin under hair is so in part.
const HAIR: f32 = 0.5;
/// What the arms move more than this hair is not kept out of: they lift it. Seen: at .3 waves beside a shoulder, pushed up by its top and
/// down by its underside, have edges 2.3 times their length, at .2 1.35 times.
const ARMS: f32 = 0.2;

/// Two places of hair that hang together.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// The places.
    pub ends: [u32; 2],
    /// How firmly.
    pub weight: f64,
    /// How far it keeps its length and direction, 0 to 1.
    pub stiff: f64,
}

/// The hair of a character of which some hangs below the chin.
#[derive(Debug)]
pub struct Strands {
    /// Hair as it lies on the body; its places are the strands'.
    pub worn: Worn,
    /// Where the head is that lengths are told by.
    pub frame: HeadFrame,
    /// Each vertex of hair with its place and how much hair it is, 0 to 1.
    pub vertices: Vec<(u32, u32, f64)>,
    /// Where the places are, in head lengths.
    pub points: Vec<DVec3>,
    /// What hangs on what.
    pub links: Vec<Link>,
    /// Which way the strand of each place runs, on the whole; none where the head holds it.
    pub along: Vec<DVec3>,
    /// How high the strand of each place ends, in head lengths above the chin.
    pub tips: Vec<f64>,
    /// How far each place lies on the body, 0 to 1.
    pub lies: Vec<f64>,
    /// What brings each place to where hair reaches no further out than on the head, at its height; head lengths.
    pub drawn_in: Vec<DVec3>,
    /// The places that each joint goes with, by their shares, which sum to 1; of joints that do not go with hair none.
    pub joints: Vec<Vec<(u32, f64)>>,
    /// To which side the strand of each place parts before the eyes, 1 for the left; none where hair need not or cannot part.
    pub sides: Option<Vec<f64>>,
    /// Small pieces, by their places, and how far each keeps its shape.
    small: Vec<(Vec<u32>, f64)>,
    /// How firmly the head holds each place.
    held: Vec<f64>,
    /// The places that are not all held.
    free: Vec<u32>,
    /// The number of each place among these.
    numbers: Vec<u32>,
    factor: Cholesky,
}

impl Strands {
    /// The hair of `character`, whose vertices are attached to parts by `bindings`; `None` where none hangs below the chin.
    pub fn of(
        character: &Character,
        measured: &Measured,
        bindings: &[Binding],
        threads: usize,
    ) -> Option<Self> {
        let Measured { figure, anatomy, weld, .. } = measured;
        let frame = head_frame(anatomy);
        let share = |vertex: usize| bindings[vertex].weight(Part::Hair);
        let is_hair = |vertex: usize| share(vertex) > HAIR;
        let hair = figure.triangles_where(is_hair);
        let is_below = |&vertex: &u32| figure.positions[vertex as usize].y < frame.origin.y;
        if !hair.iter().flatten().any(is_below) {
            return None;
        }
        let is_body = |vertex: usize| {
            let attachment = bindings[vertex].parts().map(|parts| parts.attachment);
            matches!(attachment, Some(Attachment::Plain | Attachment::Digits(_)))
                && bindings[vertex].arms_weight() < ARMS
                && !figure.is_carried(vertex)
        };
        let mut body = figure.triangles_where(is_body);
        body.retain(|corners| corners.iter().any(|&vertex| !is_hair(vertex as usize)));
        let outwards = if volume(&figure.positions, &body) < 0.0 { -1.0 } else { 1.0 };
        let mut worn = Worn::over(figure, body, outwards, hair, 0.0, weld, threads);
        let points: Vec<DVec3> =
            worn.vertices.iter().map(|&vertex| frame.to_unit(figure.positions[vertex as usize])).collect();
        let pieces = components(&worn.triangles, &Weld::alone(points.len()));
        let links = links(&worn, &points, &pieces);
        let highest = points.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let shift = (highest - 2.0 * (HELD.1 - HELD.0)).min(HELD.0) - HELD.0;
        let held: Vec<f64> =
            points.iter().map(|p| smoothstep((p.y - shift - HELD.0) / (HELD.1 - HELD.0))).collect();
        for (is_sewn, held) in worn.is_sewn.iter_mut().zip(&held) {
            *is_sewn |= *held >= 1.0;
        }
        let mut strands = Self {
            vertices: vertices(&worn, weld, share),
            joints: joints(character, measured, &worn, bindings),
            sides: sides(&points, &pieces, measured.face.as_ref().map_or(0.0, |face| face.covered)),
            lies: lying(figure, &worn, &points, frame.length, threads, &|vertex| {
                !is_hair(vertex) && bindings[vertex].weight(Part::Head) < 0.5
            }),
            drawn_in: Vec::new(),
            tips: Vec::new(),
            along: Vec::new(),
            small: Vec::new(),
            factor: Cholesky::new(&[], &[]).expect("nothing is definite"),
            free: Vec::new(),
            numbers: Vec::new(),
            worn,
            frame,
            points,
            links,
            held,
        };
        strands.find_small(&pieces);
        strands.factor()?;
        strands.look_down();
        strands.look_along()?;
        strands.drawn_in = strands.drawn_in(frame.to_unit(anatomy.head_centre));
        Some(strands)
    }

    /// From its one end to the other, in head lengths.
    pub fn step(&self, link: &Link) -> DVec3 {
        let [one, other] = link.ends.map(|place| self.points[place as usize]);
        one - other
    }

    /// Which way hair runs at a link; zero where the head holds it.
    pub fn along(&self, link: &Link) -> DVec3 {
        let [one, other] = link.ends.map(|place| self.along[place as usize]);
        (one + other).normalize_or_zero()
    }

    /// A displacement of all places that differs along links as much as `wanted`, on the whole, and is `at` where the head holds
    /// hair.
    pub fn solve(&self, wanted: impl Fn(&Link) -> DVec3, at: &[DVec3]) -> Vec<DVec3> {
        let size = self.free.len();
        let mut sums = vec![DVec3::ZERO; at.len()];
        for link in &self.links {
            let [one, other] = link.ends.map(|place| place as usize);
            let difference = link.weight * wanted(link);
            let fixed = |place: usize| {
                let is_fixed = self.numbers[place] == NONE;
                if is_fixed { link.weight * at[place] } else { DVec3::ZERO }
            };
            sums[one] += difference + fixed(other);
            sums[other] += fixed(one) - difference;
        }
        for (sum, (&held, &at)) in sums.iter_mut().zip(self.held.iter().zip(at)) {
            *sum += held * at;
        }
        let mut columns: Vec<f64> = self.columns(&sums).collect();
        self.factor.solve(&mut columns, 3);
        let mut all = at.to_vec();
        for (number, &place) in self.free.iter().enumerate() {
            all[place as usize] = [0, 1, 2].map(|axis| columns[axis * size + number]).into();
        }
        for (places, share) in &self.small {
            let mean = places.iter().map(|&place| all[place as usize]).sum::<DVec3>() / places.len() as f64;
            places.iter().for_each(|&place| {
                let own = &mut all[place as usize];
                *own = own.lerp(mean, *share);
            });
        }
        all
    }

    /// What `of` gives for the places that are not all held, axis by axis.
    fn columns<'a>(&'a self, of: &'a [DVec3]) -> impl Iterator<Item = f64> + 'a {
        (0..3).flat_map(move |axis| self.free.iter().map(move |&place| of[place as usize][axis]))
    }

    /// Adds to each vertex of hair as much of what `of` gives for its place as it is hair.
    pub fn add(&self, all: &mut [DVec3], of: impl Fn(usize) -> DVec3) {
        for &(vertex, place, share) in &self.vertices {
            all[vertex as usize] += share * of(place as usize);
        }
    }

    /// Numbers what is not all held, and factors what holds it together.
    fn factor(&mut self) -> Option<()> {
        let places = 0..self.points.len() as u32;
        self.free = places.filter(|&place| self.held[place as usize] < 1.0).collect();
        self.numbers = slots(self.points.len(), &self.free);
        let mut diagonal = vec![0.0; self.points.len()];
        for link in &self.links {
            link.ends.iter().for_each(|&place| diagonal[place as usize] += link.weight);
        }
        for (held, &diagonal) in self.held.iter_mut().zip(&diagonal) {
            *held = (HELD_BY.0 * *held * *held + HELD_BY.1) * diagonal.max(1.0);
        }
        let free = self.free.iter().map(|&place| place as usize);
        let diagonal: Vec<f64> = free.map(|place| diagonal[place] + self.held[place]).collect();
        self.factor = Cholesky::new(&diagonal, &self.lower(1.0))?;
        Some(())
    }

    /// The links between what is not all held, as a matrix has them.
    fn lower(&self, times: f64) -> Vec<(u32, u32, f64)> {
        let lower = self.links.iter().map(|link| {
            let [one, other] = link.ends.map(|place| self.numbers[place as usize]);
            (one.max(other), one.min(other), -times * link.weight)
        });
        lower.filter(|&(row, ..)| row != NONE).collect()
    }

    /// Finds where the ways down from each place end, the steeper the more they count. What hair that lies on the body hangs from lies
    /// there too: it leans out because of what is below.
    fn look_down(&mut self) {
        let mut ways: Vec<Vec<(u32, f64)>> = vec![Vec::new(); self.points.len()];
        for link in &self.links {
            let step = self.step(link);
            let [one, other] = link.ends;
            let (upper, lower) = if step.y > 0.0 { (one, other) } else { (other, one) };
            let length = step.length().max(SHORTEST);
            let steepness = (step.y.abs() / length).powi(STEEPNESS.0);
            ways[upper as usize].push((lower, link.weight * length * steepness));
        }
        let mut order: Vec<u32> = (0..self.points.len() as u32).collect();
        order.sort_by(|&a, &b| self.points[a as usize].y.total_cmp(&self.points[b as usize].y));
        self.tips = self.points.iter().map(|p| p.y).collect();
        for place in order.into_iter().map(|place| place as usize) {
            let own = STEEPNESS.1.powi(STEEPNESS.0);
            let (mut tip, mut lies, mut total) = (own * self.tips[place], own * self.lies[place], own);
            for &(lower, weight) in &ways[place] {
                tip += weight * self.tips[lower as usize];
                lies += weight * self.lies[lower as usize];
                total += weight;
            }
            self.tips[place] = tip / total;
            self.lies[place] = self.lies[place].max(lies / total);
        }
        for (lies, p) in self.lies.iter_mut().zip(&self.points) {
            *lies *= 1.0 - smoothstep((p.y - ON_BODY.0) / (ON_BODY.1 - ON_BODY.0));
        }
    }

    /// Finds which way hair runs, as the mean over the thickness of a lock of how it would drain to where the head holds it; and
    /// evens out tips and what lies on the body.
    fn look_along(&mut self) -> Option<()> {
        let size = self.free.len();
        let mut drained = vec![1.0; size];
        self.factor.solve(&mut drained, 1);
        // What the head holds has no number, and nothing drains from there.
        let at = |place: u32| drained.get(self.numbers[place as usize] as usize).copied().unwrap_or(0.0);
        let mut flow = vec![DVec3::ZERO; self.points.len()];
        let mut mass = vec![0.0; self.points.len()];
        let mut firmness = vec![0.0; self.points.len()];
        let spread = THICKNESS * THICKNESS;
        for link in &self.links {
            let step = self.step(link);
            let flows = link.weight * (at(link.ends[0]) - at(link.ends[1])) * step;
            let is_free = link.ends.iter().all(|&place| self.numbers[place as usize] != NONE);
            for place in link.ends.map(|place| place as usize) {
                flow[place] += flows;
                mass[place] += 0.5 * link.weight * step.length_squared();
                firmness[place] += if is_free { spread * link.weight } else { 0.0 };
            }
        }
        let free: Vec<usize> = self.free.iter().map(|&place| place as usize).collect();
        let mass = |place: usize| mass[place].max(SHORTEST * SHORTEST);
        let diagonal: Vec<f64> = free.iter().map(|&place| mass(place) + firmness[place]).collect();
        let even = Cholesky::new(&diagonal, &self.lower(spread))?;
        let mut columns: Vec<f64> = self.columns(&flow).collect();
        columns.extend(free.iter().map(|&place| mass(place) * self.lies[place]));
        columns.extend(free.iter().map(|&place| mass(place) * self.tips[place]));
        even.solve(&mut columns, 5);
        self.along = vec![DVec3::ZERO; self.points.len()];
        for (number, &place) in free.iter().enumerate() {
            let of = |column: usize| columns[column * size + number];
            self.along[place] = DVec3::new(of(0), of(1), of(2)).normalize_or_zero();
            self.lies[place] = of(3).clamp(0.0, 1.0);
            self.tips[place] = of(4).min(self.points[place].y);
        }
        Some(())
    }

    /// See the field: about the vertical axis through `axis`, by how far places reach on the head and at each height.
    fn drawn_in(&self, axis: DVec3) -> Vec<DVec3> {
        let (low, high) = range(self.points.iter().map(|p| p.y));
        let rows = ((high - low) / ROW) as usize + 2;
        let height = |row: usize| high - ROW * row as f64;
        // A mean that is nearly the greatest, and does not jump from lock to lock.
        let power = |p: &DVec3| DVec3::from((*p - axis).to_array().map(|along| along.powi(OUTER)));
        let powers: Vec<DVec3> = self.points.iter().map(power).collect();
        let near = |y: f64, row: usize| (-0.5 * ((y - height(row)) / (2.0 * ROW)).powi(2)).exp();
        let reach = |row: usize| {
            let (mut sum, mut total) = (DVec3::ZERO, 0.0);
            for ((p, &lies), &power) in self.points.iter().zip(&self.lies).zip(&powers) {
                let weight = near(p.y, row) * lies.max(smoothstep(p.y / ON_BODY.0));
                sum += weight * power;
                total += weight;
            }
            (sum / total.max(f64::MIN_POSITIVE)).powf(f64::from(OUTER).recip())
        };
        let reaches: Vec<DVec3> = (0..rows).map(reach).collect();
        let of_head = (0..rows).filter(|&row| height(row) >= ON_BODY.1.min(high)).map(|row| reaches[row]);
        let on_head = of_head.fold(DVec3::splat(f64::MIN_POSITIVE), DVec3::max);
        let shares: Vec<DVec3> =
            reaches.iter().map(|&reach| (on_head / reach.max(on_head)).with_y(1.0)).collect();
        let even = |row: usize| {
            let weights = (0..rows).map(|other| near(height(row), other));
            let sum: DVec3 = weights.clone().zip(&shares).map(|(weight, &share)| weight * share).sum();
            sum / weights.sum::<f64>()
        };
        let shares: Vec<DVec3> = (0..rows).map(even).collect();
        let share = |p: &DVec3| {
            let at = ((high - p.y) / ROW).clamp(0.0, (rows - 1) as f64);
            let row = (at as usize).min(rows - 2);
            shares[row].lerp(shares[row + 1], at - row as f64)
        };
        self.points.iter().map(|p| (share(p) - DVec3::ONE) * (*p - axis)).collect()
    }

    /// Finds what keeps its shape.
    fn find_small(&mut self, pieces: &[u32]) {
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); self.points.len()];
        (0..).zip(pieces).for_each(|(place, &piece)| members[piece as usize].push(place));
        for places in members.into_iter().filter(|places| places.len() > 2) {
            let (low, high) = bounds(places.iter().map(|&place| self.points[place as usize]));
            let share = 1.0 - smoothstep(((high - low).max_element() - SMALL.0) / (SMALL.1 - SMALL.0));
            let is_loose = places.iter().all(|&place| self.held[place as usize] == 0.0);
            if share > 0.0 && is_loose {
                self.small.push((places, share));
            }
        }
        let mut stiff = vec![0.0; self.points.len()];
        for (places, share) in &self.small {
            places.iter().for_each(|&place| stiff[place as usize] = *share);
        }
        let is_within = |link: &&mut Link| pieces[link.ends[0] as usize] == pieces[link.ends[1] as usize];
        for link in self.links.iter_mut().filter(is_within) {
            link.stiff = stiff[link.ends[0] as usize];
        }
    }
}

/// What hangs on what: along edges, and beside each other where pieces are near.
fn links(worn: &Worn, points: &[DVec3], pieces: &[u32]) -> Vec<Link> {
    let link = |one: u32, other: u32, firmness: f64| {
        let length = points[one as usize].distance(points[other as usize]).max(SHORTEST);
        Link { ends: [one, other], weight: firmness / length, stiff: 0.0 }
    };
    let mut links: Vec<Link> = Vec::new();
    let mut groups = Groups::new(points.len());
    for place in 0..points.len() as u32 {
        for &other in worn.around.of(place as usize).iter().filter(|&&other| other > place) {
            links.push(link(place, other, 1.0));
            groups.join(place as usize, other as usize);
        }
    }
    let tree = PointTree::new(points);
    let mut near = Vec::new();
    for place in 0..points.len() {
        tree.nearest(points[place], NEIGHBOURS, THICKNESS, &mut near);
        // The furthest of them counts nothing, so that it does not matter which one that is.
        let reach = if near.len() < NEIGHBOURS {
            THICKNESS
        } else {
            near.last().map_or(THICKNESS, |last| last.distance())
        };
        for found in near.iter().filter(|found| pieces[found.index() as usize] != pieces[place]) {
            let share = 1.0 - found.distance() / reach.max(SHORTEST);
            if share > 0.0 {
                links.push(link(place as u32, found.index(), NEAR_FIRMNESS * share * share));
                groups.join(place, found.index() as usize);
            }
        }
    }
    join_loose(points, &mut groups, |one, other| links.push(link(one, other, NEAR_FIRMNESS)));
    links
}

/// Joins what hangs on nothing to what is nearest, until all hangs on what reaches highest.
fn join_loose(points: &[DVec3], groups: &mut Groups, mut join: impl FnMut(u32, u32)) {
    let Some(top) = (0..points.len()).max_by(|&a, &b| points[a].y.total_cmp(&points[b].y)) else { return };
    loop {
        let top = groups.least(top);
        let (rest, loose): (Vec<usize>, Vec<usize>) =
            (0..points.len()).partition(|&place| groups.least(place) == top);
        if loose.is_empty() {
            return;
        }
        let on: Vec<DVec3> = rest.iter().map(|&place| points[place]).collect();
        let tree = PointTree::new(&on);
        let mut near = Vec::new();
        let mut found: Vec<(f64, usize, usize)> = Vec::new();
        for place in loose {
            tree.nearest(points[place], 1, f64::INFINITY, &mut near);
            found.extend(near.first().map(|near| (near.distance(), place, rest[near.index() as usize])));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(&(nearest, ..)) = found.first() else { return };
        for (distance, place, other) in found {
            if distance <= 2.0 * nearest && groups.least(place) != groups.least(other) {
                join(place as u32, other as u32);
                groups.join(place, other);
            }
        }
    }
}

/// How far each place lies on the body, which `is_body` tells from hair and head.
fn lying(
    figure: &Figure,
    worn: &Worn,
    points: &[DVec3],
    length: f64,
    threads: usize,
    is_body: &(dyn Fn(usize) -> bool + Sync),
) -> Vec<f64> {
    let body = figure.triangles_where(|vertex| is_body(vertex) && !figure.is_carried(vertex));
    let surface = Surface::new(&figure.positions, &body);
    parallel::collect(threads, points.len(), parallel::FEW_RAYS, |place| {
        let p = figure.positions[worn.vertices[place] as usize];
        let gap = surface.closest_point(p).map_or(f64::INFINITY, |closest| closest.distance / length);
        1.0 - smoothstep((gap - LYING.0) / (LYING.1 - LYING.0))
    })
}

/// Each vertex that is hair, with its place and its share.
fn vertices(worn: &Worn, weld: &Weld, share: impl Fn(usize) -> f32) -> Vec<(u32, u32, f64)> {
    let place = |vertex: usize| worn.places.binary_search(&weld.representative[vertex]).ok();
    let amount = |vertex: usize| smoothstep(f64::from((share(vertex) - HAIR) / (1.0 - HAIR)));
    (0..weld.representative.len())
        .filter(|&vertex| share(vertex) > HAIR)
        .filter_map(|vertex| Some((vertex as u32, place(vertex)? as u32, amount(vertex))))
        .collect()
}

/// The places that each joint goes with which plays no role and moves hair, or hangs from one that does.
fn joints(
    character: &Character,
    measured: &Measured,
    worn: &Worn,
    bindings: &[Binding],
) -> Vec<Vec<(u32, f64)>> {
    let Measured { figure, anatomy, weld, .. } = measured;
    let skeleton = &character.skeleton;
    let has_role = marked(skeleton.joints.len(), figure.humanoid.iter().map(|(_, joint)| joint));
    let near = SHORTEST * anatomy.landmarks.heights.head_length();
    // A joint of a chain stands between the hair that it moves and that of the joint before it.
    let mut beside: Vec<Vec<usize>> = (0..skeleton.joints.len()).map(|joint| vec![joint]).collect();
    for (joint, below) in skeleton.joints.iter().enumerate() {
        below.parent.into_iter().for_each(|parent| beside[parent].push(joint));
    }
    let mut of: Vec<Vec<(u32, f64)>> = vec![Vec::new(); skeleton.joints.len()];
    for (vertex, row) in weight_rows(character, figure) {
        let share = f64::from(bindings[vertex].weight(Part::Hair));
        let Ok(place) = worn.places.binary_search(&weld.representative[vertex]) else { continue };
        for &(moving, weight) in row.iter().filter(|entry| share > 0.0 && entry.1 > 0.0) {
            let beside = &beside[moving as usize];
            for &joint in beside.iter().filter(|&&joint| !has_role[moving as usize] && !has_role[joint]) {
                let nearness = nearness(figure, vertex, joint, near);
                of[joint].push((place as u32, share * f64::from(weight) * nearness));
            }
        }
    }
    for joint in skeleton.parents_first() {
        let sum: f64 = of[joint].iter().map(|(_, share)| share).sum();
        of[joint].iter_mut().for_each(|(_, share)| *share /= sum);
        if of[joint].is_empty()
            && !has_role[joint]
            && let Some(parent) = skeleton.joints[joint].parent
        {
            of[joint] = of[parent].clone();
        }
    }
    of
}
