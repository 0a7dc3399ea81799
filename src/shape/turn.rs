//! What directions turn into, by a vertex's Jacobian: of one vertex ([`Turn`]), and of four side by side ([`Turns`]), to the
//! same bits.

use glam::{BVec4A, Mat3A, Mat4, Vec3, Vec3A, Vec4};

/// What is worked on side by side.
pub const LANES: usize = 4;
/// Below this determinant a Jacobian has no volume left, and turns nothing.
const LEAST_VOLUME: f32 = 1e-12;

/// What directions turn by.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    jacobian: Mat3A,
    /// Its inverse transpose, up to a factor.
    cofactors: Mat3A,
    /// Its determinant.
    volume: f32,
}

impl Turn {
    /// By a Jacobian.
    pub fn of(jacobian: Mat3A) -> Self {
        let (x, y, z) = (jacobian.x_axis, jacobian.y_axis, jacobian.z_axis);
        let cofactors = Mat3A::from_cols(y.cross(z), z.cross(x), x.cross(y));
        Self { jacobian, cofactors, volume: cofactors.x_axis.dot(x) }
    }

    /// Whether it turns anything.
    pub fn has_volume(&self) -> bool {
        self.volume.abs() > LEAST_VOLUME
    }

    /// What a normal becomes.
    pub fn normal(&self, normal: Vec3) -> Vec3 {
        let turned = self.cofactors * Vec3A::from(normal);
        let turned = if self.volume < 0.0 { -turned } else { turned };
        turned.normalize_or(normal.into()).into()
    }

    /// What a tangent becomes, at right angles to the new normal where there is one.
    pub fn tangent(&self, tangent: Vec3, new_normal: Option<Vec3>) -> Vec3 {
        let turned = self.jacobian * Vec3A::from(tangent);
        let flat = match new_normal {
            Some(normal) => turned.reject_from_normalized(normal.into()),
            None => turned,
        };
        flat.normalize_or(tangent.into()).into()
    }
}

/// x, y and z of four vectors.
pub type Four = [Vec4; 3];

/// Four of `values` from `first` on, which is there; the last one again for those that are not.
#[inline(always)]
pub fn four_at<T: Copy>(values: &[T], first: usize) -> [T; LANES] {
    match values[first..].first_chunk() {
        Some(&four) => four,
        None => std::array::from_fn(|lane| values[(first + lane).min(values.len() - 1)]),
    }
}

/// Four vectors side by side.
#[inline(always)]
pub fn four_of(vectors: [Vec3; LANES]) -> Four {
    let [x, y, z, _] = transposed(vectors.map(|v| v.extend(0.0)));
    [x, y, z]
}

/// The four vectors, each with its `w`.
#[inline(always)]
pub fn each_of([x, y, z]: Four, w: Vec4) -> [Vec4; LANES] {
    transposed([x, y, z, w])
}

/// As [`Turn`], of four vertices.
#[derive(Clone, Copy, Debug)]
pub struct Turns {
    jacobian: [Four; 3],
    cofactors: [Four; 3],
    volume: Vec4,
}

impl Turns {
    /// By four Jacobians, column by column.
    #[inline(always)]
    pub fn of(jacobian: [Four; 3]) -> Self {
        let [x, y, z] = jacobian;
        let cofactors = [cross(y, z), cross(z, x), cross(x, y)];
        Self { jacobian, cofactors, volume: dot(cofactors[0], x) }
    }

    /// Which of them turn anything.
    #[inline(always)]
    pub fn have_volume(&self) -> BVec4A {
        self.volume.abs().cmpgt(Vec4::splat(LEAST_VOLUME))
    }

    /// What normals become.
    #[inline(always)]
    pub fn normals(&self, normals: Four) -> Four {
        let turned = product(&self.cofactors, normals);
        let is_mirrored = self.volume.cmplt(Vec4::ZERO);
        let turned = turned.map(|v| Vec4::select(is_mirrored, -v, v));
        normalized_or(turned, normals)
    }

    /// What tangents become, at right angles to the new normals where there are any.
    #[inline(always)]
    pub fn tangents(&self, tangents: Four, new_normals: Option<Four>) -> Four {
        let turned = product(&self.jacobian, tangents);
        let flat = match new_normals {
            Some(normals) => {
                let along = dot(turned, normals);
                std::array::from_fn(|axis| turned[axis] - normals[axis] * along)
            }
            None => turned,
        };
        normalized_or(flat, tangents)
    }
}

/// Scalar products.
#[inline(always)]
pub fn dot(a: Four, b: Four) -> Vec4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector products.
#[inline(always)]
pub fn cross(a: Four, b: Four) -> Four {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn product(columns: &[Four; 3], v: Four) -> Four {
    std::array::from_fn(|axis| columns[0][axis] * v[0] + columns[1][axis] * v[1] + columns[2][axis] * v[2])
}

/// Of unit length; `other` where there is no direction.
#[inline(always)]
fn normalized_or(v: Four, other: Four) -> Four {
    let by_length = Vec4::ONE / root(dot(v, v));
    let is_known = by_length.cmplt(Vec4::INFINITY) & by_length.cmpgt(Vec4::ZERO);
    std::array::from_fn(|axis| Vec4::select(is_known, v[axis] * by_length, other[axis]))
}

/// Four matrices of three columns, one after the other; the fourth number of each first column is its `w`, of the others 0.
#[inline(always)]
pub fn columns_of(columns: [Four; 3], w: Vec4) -> [[Vec4; 3]; LANES] {
    let [first, second, third] = columns;
    let (first, second, third) = (each_of(first, w), each_of(second, Vec4::ZERO), each_of(third, Vec4::ZERO));
    std::array::from_fn(|lane| [first[lane], second[lane], third[lane]])
}

/// Rows of four numbers from columns, or the other way round.
#[inline(always)]
pub fn transposed([x, y, z, w]: [Vec4; 4]) -> [Vec4; 4] {
    let Mat4 { x_axis, y_axis, z_axis, w_axis } = Mat4::from_cols(x, y, z, w).transpose();
    [x_axis, y_axis, z_axis, w_axis]
}

/// The square roots.
#[inline(always)]
pub fn root(v: Vec4) -> Vec4 {
    Vec4::from_array(v.to_array().map(f32::sqrt))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_side_by_side_turn_to_the_same_bits_as_each_alone() {
        let number = |index: usize| ((index * 7919 + 13) % 1009) as f32 / 504.5 - 1.0;
        for round in 0..100 {
            let vector = |index: usize| {
                let first = 3 * (17 * round + index);
                Vec3::new(number(first), number(first + 1), number(first + 2))
            };
            let jacobians: [[Vec3; 3]; LANES] = std::array::from_fn(|lane| match (round, lane) {
                // Flat, of no length, and without a number.
                (0, 1) => [vector(0), vector(1), Vec3::ZERO],
                (0, 2) => [Vec3::ZERO; 3],
                (0, 3) => [Vec3::NAN, Vec3::X, Vec3::Y],
                _ => std::array::from_fn(|column| vector(3 * lane + column)),
            });
            let normals: [Vec3; LANES] = std::array::from_fn(|lane| vector(12 + lane));
            let tangents: [Vec3; LANES] = std::array::from_fn(|lane| vector(16 + lane));
            let turns =
                Turns::of(std::array::from_fn(|column| four_of(jacobians.map(|columns| columns[column]))));
            let new_normals = turns.normals(four_of(normals));
            let new_tangents = turns.tangents(four_of(tangents), Some(new_normals));
            let loose = turns.tangents(four_of(tangents), None);
            for lane in 0..LANES {
                let turn = Turn::of(Mat3A::from_cols_array_2d(&jacobians[lane].map(|v| v.to_array())));
                let bits = |v: Vec3| v.to_array().map(f32::to_bits);
                let of = |four: Four| bits(each_of(four, Vec4::ZERO)[lane].truncate());
                let normal = turn.normal(normals[lane]);
                assert_eq!(turns.have_volume().test(lane), turn.has_volume());
                assert_eq!(of(new_normals), bits(normal));
                assert_eq!(of(new_tangents), bits(turn.tangent(tangents[lane], Some(normal))));
                assert_eq!(of(loose), bits(turn.tangent(tangents[lane], None)));
            }
        }
    }
}
