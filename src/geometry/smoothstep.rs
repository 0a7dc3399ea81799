//! A step without corners.

/// 0 below 0, 1 above 1, smooth between.
pub fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// [`smoothstep`] and its slope.
pub fn smoothstep_slope(t: f64) -> (f64, f64) {
    let inside = t.clamp(0.0, 1.0);
    (smoothstep(t), 6.0 * inside * (1.0 - inside))
}
