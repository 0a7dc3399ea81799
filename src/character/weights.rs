//! Skin weights w_ki (§IV-B): for each vertex the joints that move it, w >= 0, sum 1; any number a vertex.

use super::mesh::Fault;
use crate::error::Element;

/// Sparse rows of (joint, weight), one row a vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights {
    /// Where each row starts in `entries`; one more than there are rows, or empty where there are none.
    starts: Vec<u32>,
    entries: Vec<(u32, f32)>,
}

impl Weights {
    /// Rows built one after the other; entries of weight 0 are dropped, repeated joints stay as they are.
    pub fn from_rows<Row: IntoIterator<Item = (u32, f32)>>(rows: impl IntoIterator<Item = Row>) -> Self {
        let mut starts = vec![0];
        let mut entries = Vec::new();
        for row in rows {
            entries.extend(row.into_iter().filter(|&(_, weight)| weight != 0.0));
            starts.push(entries.len() as u32);
        }
        Self { starts, entries }
    }

    /// Rows that are laid out already: row v is `starts[v]..starts[v + 1]` of `entries`.
    pub(crate) fn from_parts(starts: Vec<u32>, entries: Vec<(u32, f32)>) -> Self {
        debug_assert_eq!(starts.last().copied().unwrap_or(0) as usize, entries.len());
        Self { starts, entries }
    }

    /// `row_count` rows that each hold weight 1 to `joint`: a mesh that hangs rigidly from it.
    pub fn rigid(joint: u32, row_count: usize) -> Self {
        Self::from_rows((0..row_count).map(|_| [(joint, 1.0)]))
    }

    /// Each row's `most` largest weights (1 or more), largest first, scaled to sum 1; equal ones in the order of their
    /// joints. A row without weights stays empty.
    pub fn limited(&self, most: usize) -> Self {
        Self::from_rows(self.rows().map(|row| {
            let mut row = row.to_vec();
            row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            row.truncate(most.max(1));
            row.retain(|&(_, weight)| weight > 0.0);
            let sum: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
            row.into_iter().map(move |(joint, weight)| (joint, (f64::from(weight) / sum) as f32))
        }))
    }

    /// Each row lowered by the `share` of its largest weight (0 to less than 1), without what is below it, and scaled to sum
    /// 1: what is dropped leaves no step behind. A row without weights stays empty.
    pub fn trimmed(&self, share: f32) -> Self {
        Self::from_rows(self.rows().map(|row| {
            let least = share * row.iter().fold(0.0, |most: f32, &(_, weight)| most.max(weight));
            let rest = move |weight: f32| f64::from((weight - least).max(0.0));
            let sum: f64 = row.iter().map(|&(_, weight)| rest(weight)).sum();
            row.iter().map(move |&(joint, weight)| {
                (joint, if sum > 0.0 { (rest(weight) / sum) as f32 } else { 0.0 })
            })
        }))
    }

    /// The same weights to joints whose numbers are `by` higher.
    pub fn shifted(&self, by: u32) -> Self {
        let entries = self.entries.iter().map(|&(joint, weight)| (joint + by, weight)).collect();
        Self { starts: self.starts.clone(), entries }
    }

    /// The number of rows.
    pub fn row_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// True where the mesh has no rig.
    pub fn is_empty(&self) -> bool {
        self.row_count() == 0
    }

    /// The joints and weights of one vertex.
    pub fn row(&self, vertex: usize) -> &[(u32, f32)] {
        &self.entries[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// All rows in order.
    pub fn rows(&self) -> impl Iterator<Item = &[(u32, f32)]> {
        (0..self.row_count()).map(|vertex| self.row(vertex))
    }

    /// Checks rows against the numbers of vertices and joints.
    pub(crate) fn check(&self, vertex_count: usize, joint_count: usize) -> Result<(), Fault> {
        let row_count = self.row_count();
        if !self.is_empty() && row_count != vertex_count {
            let message =
                format!("{row_count} rows of weights for {vertex_count} vertices: give one a vertex");
            return Err((None, message));
        }
        for (vertex, row) in self.rows().enumerate() {
            for &(joint, weight) in row {
                let message = if joint as usize >= joint_count {
                    format!(
                        "vertex {vertex} is weighted to joint {joint}, but there are {joint_count} joints: name one of them"
                    )
                } else if !weight.is_finite() || weight < 0.0 {
                    format!(
                        "vertex {vertex} has weight {weight} for joint {joint}: weights must be 0 or more"
                    )
                } else {
                    continue;
                };
                return Err((Some(Element::Vertex(vertex)), message));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_trimmed_leaves_no_step() {
        let weights = Weights::from_rows([vec![(0, 0.8), (1, 0.16), (2, 0.04)], vec![(3, 1.0)], vec![]]);
        // A tenth of 0.8 goes off each: 0.72, 0.08 and nothing.
        let trimmed = weights.trimmed(0.1);
        assert_eq!(trimmed.row(0).iter().map(|entry| entry.0).collect::<Vec<_>>(), [0, 1]);
        assert!((trimmed.row(0)[0].1 - 0.9).abs() < 1e-6 && (trimmed.row(0)[1].1 - 0.1).abs() < 1e-6);
        assert_eq!(trimmed.row(1), [(3, 1.0)]);
        assert!(trimmed.row(2).is_empty());
        assert_eq!(weights.trimmed(0.0).row(0).len(), 3);
    }
}
