//! Where results go: arrays of the library's own or of a host, written in place and in pieces.

/// An array to write results to, which can be cut so that threads write pieces of it.
pub trait Place<T>: Send + Sized {
    /// What lies before `index`, and the rest.
    fn cut(self, index: usize) -> (Self, Self);

    /// Writes `values` from `first` on.
    fn write(&mut self, first: usize, values: &[T]);
}

impl<T: Copy + Send> Place<T> for &mut [T] {
    fn cut(self, index: usize) -> (Self, Self) {
        self.split_at_mut(index)
    }

    fn write(&mut self, first: usize, values: &[T]) {
        self[first..first + values.len()].copy_from_slice(values);
    }
}

/// A place that may not be there: what goes to it is not written.
impl<T, P: Place<T>> Place<T> for Option<P> {
    fn cut(self, index: usize) -> (Self, Self) {
        self.map(|place| place.cut(index)).unzip()
    }

    fn write(&mut self, first: usize, values: &[T]) {
        if let Some(place) = self {
            place.write(first, values);
        }
    }
}

/// Where the results of one mesh go; what is not asked for has no place.
pub struct MeshPlaces<V, W> {
    /// New rest positions, model space.
    pub positions: Option<V>,
    /// New unit normals.
    pub normals: Option<V>,
    /// New unit tangents.
    pub tangents: Option<W>,
}
