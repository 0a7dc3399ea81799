//! How one axis of a slice is scaled: what lies in the body is, what lies on it moves with its surface.

/// Up to this many half extents from the middle a slice is scaled as one: the surface itself is not quite at 1 everywhere.
const SURFACE: f64 = 1.1;

/// Where a scale takes a place, and its partial derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slab {
    /// The new place.
    pub to: f64,
    /// By the place; above 0.
    pub by_place: f64,
    /// By the scale.
    pub by_scale: f64,
    /// By the half extent.
    pub by_half: f64,
}

/// Where `place`, from the middle of a slice of half extent `half`, above 0, goes where that is scaled by `scale`, above 0.
///
/// Within the surface by `scale`; beyond it with a slope that goes over to 1 (to `scale`, where that is less) within one half
/// extent: cloth, straps and backpacks move with the surface and are not inflated. The slope is above 0 everywhere, so nothing
/// folds. With q = |place| / half and x = q - 1.1 > 0: half (1.1 S + k x + (S - k) h(x)), k = min(S, 1),
/// h = x - x^3 + x^4 / 2 up to x = 1 and 1 / 2 beyond.
#[inline]
pub fn slab(place: f64, scale: f64, half: f64) -> Slab {
    let q = place.abs() / half;
    if q <= SURFACE {
        return Slab { to: scale * place, by_place: scale, by_scale: place, by_half: 0.0 };
    }
    let x = q - SURFACE;
    let (h, h_slope) = if x < 1.0 {
        let x2 = x * x;
        (x - x2 * x + 0.5 * x2 * x2, 1.0 - 3.0 * x2 + 2.0 * x2 * x)
    } else {
        (0.5, 0.0)
    };
    let k = scale.min(1.0);
    let outside = SURFACE * scale + k * x + (scale - k) * h;
    let slope = k + (scale - k) * h_slope;
    let by_scale = if scale > 1.0 { SURFACE + h } else { q };
    let sign = place.signum();
    Slab {
        to: sign * half * outside,
        by_place: slope,
        by_scale: sign * half * by_scale,
        by_half: sign * (outside - q * slope),
    }
}

/// e^(A m tanh(ln(wanted / own) / m)): the scale from `own` to `wanted`, `strength` of the way, with a soft limit: none of a
/// ratio is cut off, but of a ratio of 4 some 2.8 are left where m is 1.3. An infinite m is no limit.
pub fn soft_scale(wanted: f64, own: f64, strength: f64, most: f64) -> f64 {
    let log = (wanted / own).ln();
    (strength * if most.is_finite() { most * (log / most).tanh() } else { log }).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_surface_is_scaled_and_what_lies_on_it_moves_along() {
        // Worked by hand from the formula, to its last digits.
        for (scale, places, wanted) in [
            (1.5, vec![0.5, 1.0, 1.2, 1.6, 2.1, 3.0], vec![0.75, 1.5, 1.79954, 2.35313, 2.9, 3.8]),
            (0.7, vec![0.5, 1.2, 2.0], vec![0.35, 0.84, 1.4]),
        ] {
            for (place, wanted) in places.into_iter().zip(wanted) {
                for sign in [-1.0, 1.0] {
                    let to = slab(sign * place, scale, 1.0).to;
                    assert!((to - sign * wanted).abs() < 1e-4, "{place} {scale}: {to}");
                    let doubled = slab(2.0 * sign * place, scale, 2.0).to;
                    assert!((doubled - 2.0 * to).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_place() {
        let h = 1e-6;
        for place in [-2.7, -1.3, -0.4, 0.2, 1.05, 1.15, 1.9, 2.4] {
            for scale in [0.6, 1.0, 1.7] {
                for half in [0.8, 1.3] {
                    let at = slab(place, scale, half);
                    let slope = |f: &dyn Fn(f64) -> f64| (f(h) - f(-h)) / (2.0 * h);
                    for (found, wanted) in [
                        (at.by_place, slope(&|d| slab(place + d, scale, half).to)),
                        // At a scale of 1 the limit of what lies outside has a kink; both sides' mean is taken.
                        (at.by_half, slope(&|d| slab(place, scale, half + d).to)),
                    ] {
                        assert!((found - wanted).abs() < 1e-5, "{place} {scale} {half}: {found} {wanted}");
                    }
                    assert!(at.by_place > 0.0);
                    if scale != 1.0 {
                        let wanted = slope(&|d| slab(place, scale + d, half).to);
                        assert!((at.by_scale - wanted).abs() < 1e-5, "{place} {scale}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_ratio_of_two_is_nearly_met_and_one_of_four_is_not() {
        assert!((soft_scale(2.0, 1.0, 1.0, 1.3) - 1.89).abs() < 5e-3);
        assert!((soft_scale(4.0, 1.0, 1.0, 1.3) - 2.79).abs() < 5e-3);
        assert_eq!(soft_scale(2.0, 1.0, 0.0, 1.3), 1.0);
        assert!((soft_scale(4.0, 1.0, 1.0, f64::INFINITY) - 4.0).abs() < 1e-12);
    }
}
