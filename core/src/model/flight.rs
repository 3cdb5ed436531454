//! How the load moves on its own.

/// Friction of the free load, divided by its inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slowing {
    /// Viscous, 1/s.
    pub viscous: f64,
    /// Dry, rad/s^2 or m/s^2.
    pub dry: f64,
}

/// Way and end of a free flight, and how they follow the velocity at its begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Way, rad or m.
    pub way: f64,
    /// Velocity at its end.
    pub velocity: f64,
    /// Derivative of the way by the velocity at the begin, s.
    pub way_by_velocity: f64,
    /// The same of the velocity at its end.
    pub velocity_by_velocity: f64,
}

impl Slowing {
    /// `dv/dt = -viscous v - dry sgn v` for `time` seconds from `velocity`, exactly; it stops for good.
    pub fn flight(&self, velocity: f64, time: f64) -> Flight {
        let (sign, speed) = (velocity.signum(), velocity.abs());
        let g = self.viscous.max(1e-9);
        let stops = if self.dry > 0.0 {
            libm::log1p(g * speed / self.dry) / g
        } else {
            f64::INFINITY
        };
        let t = time.min(stops);
        // (1 - e^{-gt})/g, without loss of digits.
        let moved = -libm::expm1(-g * t) / g;
        let way = speed * moved - self.dry * (t - moved) / g;
        let flying = time < stops;
        Flight {
            way: sign * way,
            velocity: if flying {
                sign * (speed * libm::exp(-g * t) - self.dry * moved)
            } else {
                0.0
            },
            way_by_velocity: moved,
            velocity_by_velocity: if flying { libm::exp(-g * t) } else { 0.0 },
        }
    }
}
