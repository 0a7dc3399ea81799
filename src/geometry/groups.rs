//! Things that are joined: which of them belong together (a union-find), in the order of numbers, and what it costs to get from
//! one to the others.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// Things in groups that grow together, each known by its least member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Groups {
    /// Another member of the same group, none greater; itself for the least.
    above: Vec<u32>,
}

impl Groups {
    /// `count` things, each in a group of its own.
    pub fn new(count: usize) -> Self {
        Self { above: (0..count as u32).collect() }
    }

    /// The least member of the group of `one`.
    pub fn least(&mut self, mut one: usize) -> usize {
        while self.above[one] as usize != one {
            self.above[one] = self.above[self.above[one] as usize];
            one = self.above[one] as usize;
        }
        one
    }

    /// Makes one group of those of `one` and `other`.
    pub fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.least(one), self.least(other));
        self.above[one.max(other)] = one.min(other) as u32;
    }
}

/// The merge tree of things that come in an `order`, of `count` things: for each, the place in the order of its tip, which is the
/// first one of those that hang together with it once it is there.
///
/// - `beside`: what is beside one.
/// - `meet`: told of each two tips whose trees meet: the one that goes on, the other one, and where they do.
///
/// Carr, Snoeyink and Axen. Computing contour trees in all dimensions. Computational Geometry 24(2), 2003.
pub fn merge_tree<Beside: Iterator<Item = u32>>(
    count: usize,
    order: &[u32],
    beside: impl Fn(u32) -> Beside,
    mut meet: impl FnMut(u32, u32, u32),
) -> Vec<usize> {
    let mut places = vec![usize::MAX; count];
    let mut groups = Groups::new(order.len());
    let grow = |(place, &thing): (usize, &u32)| {
        places[thing as usize] = place;
        for other in beside(thing).map(|other| places[other as usize]).filter(|&other| other < place) {
            let (one, other) = (groups.least(place), groups.least(other));
            if one != other {
                meet(order[one.min(other)], order[one.max(other)], thing);
                groups.join(one, other);
            }
        }
        groups.least(place)
    };
    order.iter().enumerate().map(grow).collect()
}

/// Things in the order of the numbers that they have: a row of them for each number.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rows<Thing> {
    /// Where each row starts in `things`; one more than there are numbers.
    pub starts: Vec<u32>,
    /// The things, one row after the other.
    pub things: Vec<Thing>,
}

impl<Thing> Rows<Thing> {
    /// How many numbers there are.
    pub fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Where the row of a number is in `things`.
    pub fn range(&self, number: usize) -> Range<usize> {
        self.starts[number] as usize..self.starts[number + 1] as usize
    }

    /// The row of a number.
    pub fn of(&self, number: usize) -> &[Thing] {
        &self.things[self.range(number)]
    }

    /// The same, to be changed.
    pub fn of_mut(&mut self, number: usize) -> &mut [Thing] {
        &mut self.things[self.starts[number] as usize..self.starts[number + 1] as usize]
    }
}

/// Rows of things by the numbers below `count` that they have, those of one number in their own order.
pub fn by_number<Thing: Copy + Default>(
    count: usize,
    things: impl Iterator<Item = (u32, Thing)> + Clone,
) -> Rows<Thing> {
    let mut starts = vec![0u32; count + 1];
    things.clone().for_each(|(number, _)| starts[number as usize + 1] += 1);
    for number in 0..count {
        starts[number + 1] += starts[number];
    }
    let mut sorted = vec![Thing::default(); starts[count] as usize];
    let mut next = starts.clone();
    for (number, thing) in things {
        let at = &mut next[number as usize];
        sorted[*at as usize] = thing;
        *at += 1;
    }
    Rows { starts, things: sorted }
}

/// What it costs at least to reach each of `count` things; infinite where no way leads.
///
/// - `starts`: where ways begin, each with what it costs to be there.
/// - `beside`: what is beside one, with the cost of the way there, 0 or more.
///
/// Dijkstra. A note on two problems in connexion with graphs. Numerische Mathematik 1, 1959.
pub fn least_costs<Beside: Iterator<Item = (u32, f64)>>(
    count: usize,
    starts: impl Iterator<Item = (u32, f64)>,
    beside: impl Fn(u32) -> Beside,
) -> Vec<f64> {
    let mut costs = vec![f64::INFINITY; count];
    // Bits of numbers that are 0 or more are in the order of these.
    let mut queue = BinaryHeap::new();
    for (start, cost) in starts {
        costs[start as usize] = cost;
        queue.push(Reverse((cost.to_bits(), start)));
    }
    while let Some(Reverse((bits, at))) = queue.pop() {
        let cost = f64::from_bits(bits);
        if cost > costs[at as usize] {
            continue;
        }
        for (next, way) in beside(at) {
            let further = cost + way;
            if further < costs[next as usize] {
                costs[next as usize] = further;
                queue.push(Reverse((further.to_bits(), next)));
            }
        }
    }
    costs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_has_one_least_member() {
        let mut groups = Groups::new(6);
        for (one, other) in [(4, 2), (5, 4), (1, 3), (2, 5)] {
            groups.join(one, other);
        }
        let least: Vec<usize> = (0..6).map(|one| groups.least(one)).collect();
        assert_eq!(least, [0, 1, 2, 1, 2, 2]);
    }
}
