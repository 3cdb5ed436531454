//! Runge and Kutta's integration in many small steps (1901), as a reference for exact flows.

/// State after `h` seconds in so many steps, from the `rates` of change in a state at a time.
pub fn integrate<const N: usize>(
    rates: impl Fn([f64; N], f64) -> [f64; N],
    from: [f64; N],
    h: f64,
    steps: u32,
) -> [f64; N] {
    let dt = h / f64::from(steps);
    let moved = |s: [f64; N], k: [f64; N], t: f64| std::array::from_fn(|i| s[i] + t * k[i]);
    (0..steps).fold(from, |s, step| {
        let t = dt * f64::from(step);
        let k1 = rates(s, t);
        let k2 = rates(moved(s, k1, dt / 2.0), t + dt / 2.0);
        let k3 = rates(moved(s, k2, dt / 2.0), t + dt / 2.0);
        let k4 = rates(moved(s, k3, dt), t + dt);
        std::array::from_fn(|i| s[i] + dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    })
}
