//! Things that belong together because each belongs to the next: a union-find.

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
