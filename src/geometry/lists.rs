//! Lists without repeats, marks of what is in a list and where, and lists by key.

use super::NONE;
use std::collections::BTreeMap;

/// Each of `things` once, ascending.
pub fn distinct<T: Ord>(things: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut things: Vec<T> = things.into_iter().collect();
    things.sort_unstable();
    things.dedup();
    things
}

/// For each of `count` things whether it is among those of `numbers`.
pub fn marked(count: usize, numbers: impl IntoIterator<Item = usize>) -> Vec<bool> {
    let mut marks = vec![false; count];
    numbers.into_iter().for_each(|number| marks[number] = true);
    marks
}

/// For each of `count` things its slot in the list of `numbers`; [`NONE`] for what is not in it.
pub fn slots<'a>(count: usize, numbers: impl IntoIterator<Item = &'a u32>) -> Vec<u32> {
    let mut slots = vec![NONE; count];
    (0..).zip(numbers).for_each(|(slot, &number)| slots[number as usize] = slot);
    slots
}

/// Things by their keys, those of one key in their own order.
pub fn by_key<Key: Ord, Thing>(things: impl IntoIterator<Item = (Key, Thing)>) -> BTreeMap<Key, Vec<Thing>> {
    let mut all: BTreeMap<Key, Vec<Thing>> = BTreeMap::new();
    things.into_iter().for_each(|(key, thing)| all.entry(key).or_default().push(thing));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_lose_what_repeats_and_marks_stand_at_its_numbers() {
        assert_eq!(distinct([3, 1, 3, 2, 1]), [1, 2, 3]);
        assert_eq!(marked(4, [2, 0, 2]), [true, false, true, false]);
        assert_eq!(slots(4, &[3, 1]), [NONE, 1, NONE, 0]);
        assert_eq!(
            by_key([(2, 'a'), (1, 'b'), (2, 'c')]),
            BTreeMap::from([(1, vec!['b']), (2, vec!['a', 'c'])])
        );
    }
}
