//! Whole numbers beside a number, as `f64`'s own functions give them: those are calls into the C library where the compiler
//! may not count on SSE4.1, which in a loop take longer than all else in it. The sign of a zero is not kept.

/// From here on all numbers are whole, and few are so large.
const WHOLE_FROM: f64 = (1u64 << 52) as f64;

/// Without what comes after the point.
#[inline(always)]
fn truncated(x: f64) -> f64 {
    if x.abs() < WHOLE_FROM { x as i64 as f64 } else { x }
}

/// As [`f64::floor`].
#[inline(always)]
pub fn floor(x: f64) -> f64 {
    let whole = truncated(x);
    if whole > x { whole - 1.0 } else { whole }
}

/// As [`f64::ceil`].
#[inline(always)]
pub fn ceil(x: f64) -> f64 {
    let whole = truncated(x);
    if whole < x { whole + 1.0 } else { whole }
}

/// As [`f64::round`].
#[inline(always)]
pub fn round(x: f64) -> f64 {
    let whole = truncated(x);
    let rest = x - whole;
    if rest >= 0.5 {
        whole + 1.0
    } else if rest <= -0.5 {
        whole - 1.0
    } else {
        whole
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn they_are_those_of_the_standard_library() {
        let halves = (-60..60).map(|half| 0.5 * f64::from(half));
        let beside = halves.flat_map(|x: f64| [x.next_down(), x, x.next_up()]);
        let large = [52, 53, 62, 63, 64, 200].map(|power| 2f64.powi(power));
        let far = large.into_iter().flat_map(|x| [x.next_down(), x, x.next_up()]).flat_map(|x| [x, -x]);
        let special = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE, 1e-320];
        for x in beside.chain(far).chain(special) {
            let pairs =
                [(super::floor(x), x.floor()), (super::ceil(x), x.ceil()), (super::round(x), x.round())];
            for (ours, theirs) in pairs {
                assert!(ours == theirs || ours.is_nan() && theirs.is_nan(), "{x}: {ours} {theirs}");
            }
        }
    }
}
