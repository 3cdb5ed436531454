//! The position of a body without the noise of its sensors, from all of them.
//!
//! A Kalman filter and a smoother back over it (Rauch, Tung and Striebel 1965), with an acceleration that is white
//! noise. How strong that is, the record tells: the strength under which the innovations are most likely. A stiff
//! contact that follows the measured position itself would be pressed by its noise.

/// An output and the standard deviation of its noise.
pub type Seen<'a> = (&'a [f64], f64);

/// Strengths that are tried, in times of that at which one sample of acceleration stands out of the noise, as powers of
/// 4.
const POWERS: std::ops::RangeInclusive<i32> = -9..=9;

/// Samples on which they are tried.
const TRIED: usize = 4_000;

/// Position at every sample; at least one of `position` and `velocity` is seen. The integral of the velocity from 0
/// where only that is seen.
pub fn smoothed(time: &[f64], position: Option<Seen>, velocity: Option<Seen>) -> Vec<f64> {
    let sensors = Sensors { position, velocity };
    let n = time.len();
    let step = (time[n - 1] - time[0]) / (n - 1).max(1) as f64;
    let of_position = position.map_or(f64::INFINITY, |(_, noise)| noise * noise / step.powi(3));
    let of_velocity = velocity.map_or(f64::INFINITY, |(_, noise)| noise * noise / step);
    let unit = of_position.min(of_velocity);
    let tried = &time[..n.min(TRIED)];
    let likely = POWERS
        .map(|power| unit * libm::pow(4.0, f64::from(power)))
        .map(|strength| (strength, filter(tried, &sensors, strength, |_, _, _| ())))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let strength = likely.map_or(unit, |(strength, _)| strength);
    let mut forward: Vec<(Estimate, Estimate)> = Vec::with_capacity(n);
    filter(time, &sensors, strength, |_, said, known| {
        forward.push((said, known));
    });
    let mut smooth = vec![0.0; n];
    let mut later: Option<Estimate> = None;
    for (k, (_, known)) in forward.iter().enumerate().rev() {
        let now = match (later, forward.get(k + 1)) {
            (Some(later), Some((said, _))) => known.seeing(time[k + 1] - time[k], said, &later),
            _ => *known,
        };
        smooth[k] = now.x;
        later = Some(now);
    }
    smooth
}

struct Sensors<'a> {
    position: Option<Seen<'a>>,
    velocity: Option<Seen<'a>>,
}

/// Position and velocity with their covariance.
#[derive(Clone, Copy, Debug)]
struct Estimate {
    x: f64,
    v: f64,
    xx: f64,
    xv: f64,
    vv: f64,
}

impl Estimate {
    /// After `h` seconds of white acceleration.
    fn after(&self, h: f64, strength: f64) -> Self {
        Self {
            x: self.x + h * self.v,
            v: self.v,
            xx: self.xx + h * (2.0 * self.xv + h * self.vv) + strength * h.powi(3) / 3.0,
            xv: self.xv + h * self.vv + strength * h * h / 2.0,
            vv: self.vv + strength * h,
        }
    }

    /// With a `value` measured of the position or of the velocity; and minus twice the logarithm of its likelihood.
    fn measured(&self, is_velocity: bool, value: f64, noise: f64) -> (Self, f64) {
        let (own, cross, said) = if is_velocity {
            (self.vv, self.xv, self.v)
        } else {
            (self.xx, self.xv, self.x)
        };
        let variance = own + noise * noise;
        let off = value - said;
        let (on_own, on_other) = (own / variance, cross / variance);
        let mut next = *self;
        if is_velocity {
            next.v += on_own * off;
            next.x += on_other * off;
            next.xx -= on_other * self.xv;
            next.xv -= on_other * self.vv;
            next.vv -= on_own * self.vv;
        } else {
            next.x += on_own * off;
            next.v += on_other * off;
            next.vv -= on_other * self.xv;
            next.xv -= on_other * self.xx;
            next.xx -= on_own * self.xx;
        }
        (next, off * off / variance + libm::log(variance))
    }

    /// Known up to now, with what is known `later`, `h` seconds on, where it `said` that it would be.
    fn seeing(&self, h: f64, said: &Self, later: &Self) -> Self {
        let determinant = said.xx * said.vv - said.xv * said.xv;
        // Covariance of now with then, times the inverse of that of then.
        let (a, b) = (self.xx + h * self.xv, self.xv);
        let (c, d) = (self.xv + h * self.vv, self.vv);
        let gain = [
            (a * said.vv - b * said.xv) / determinant,
            (b * said.xx - a * said.xv) / determinant,
            (c * said.vv - d * said.xv) / determinant,
            (d * said.xx - c * said.xv) / determinant,
        ];
        let (dx, dv) = (later.x - said.x, later.v - said.v);
        if !gain.iter().all(|g| g.is_finite()) {
            return *self;
        }
        // Of the smoothed state only the mean is needed.
        Self {
            x: self.x + gain[0] * dx + gain[1] * dv,
            v: self.v + gain[2] * dx + gain[3] * dv,
            ..*self
        }
    }
}

/// Filters forward and shows, for each sample, what was said of it before and what is known with it; minus twice the
/// logarithm of the likelihood of all but the first samples.
fn filter(
    time: &[f64],
    sensors: &Sensors,
    strength: f64,
    mut show: impl FnMut(usize, Estimate, Estimate),
) -> f64 {
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1).max(1) as f64;
    let at = |seen: Option<Seen>, k: usize| seen.map(|(values, noise)| (values[k], noise));
    let slope = |values: &[f64]| {
        values
            .get(1)
            .map_or(0.0, |second| (second - values[0]) / step)
    };
    let first = Estimate {
        x: at(sensors.position, 0).map_or(0.0, |s| s.0),
        v: match (at(sensors.velocity, 0), sensors.position) {
            (Some((v, _)), _) => v,
            (None, Some((values, _))) => slope(values),
            (None, None) => 0.0,
        },
        xx: at(sensors.position, 0).map_or(0.0, |s| s.1 * s.1),
        xv: 0.0,
        vv: match (at(sensors.velocity, 0), at(sensors.position, 0)) {
            (Some((_, noise)), _) => noise * noise,
            (None, Some((_, noise))) => 2.0 * (noise / step).powi(2) + strength * step,
            (None, None) => 0.0,
        },
    };
    let (mut now, mut sum) = (first, 0.0);
    for k in 0..time.len() {
        let said = if k == 0 {
            first
        } else {
            now.after(time[k] - time[k - 1], strength)
        };
        now = said;
        for (seen, is_velocity) in [(sensors.position, false), (sensors.velocity, true)] {
            if let Some((value, noise)) = at(seen, k).filter(|_| k > 0) {
                let (next, surprise) = now.measured(is_velocity, value, noise);
                now = next;
                sum += surprise;
            }
        }
        show(k, said, now);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Random;

    #[test]
    fn sensors_together_tell_a_position_better_than_each() {
        let mut random = Random::new(5);
        let mut normal =
            |size: f64| -> f64 { size * (0..12).map(|_| random.between(-0.5, 0.5)).sum::<f64>() };
        let (n, h, of_x, of_v) = (4000, 1e-3, 1e-3, 3e-2);
        let time: Vec<f64> = (0..n).map(|k| h * f64::from(k)).collect();
        let truth: Vec<f64> = time.iter().map(|t| libm::sin(9.0 * t)).collect();
        let x: Vec<f64> = truth.iter().map(|x| x + normal(of_x)).collect();
        let v: Vec<f64> = time
            .iter()
            .map(|t| 9.0 * libm::cos(9.0 * t) + normal(of_v))
            .collect();
        let error = |smooth: &[f64]| {
            let squares = smooth.iter().zip(&truth).map(|(s, t)| (s - t).powi(2));
            (squares.sum::<f64>() / f64::from(n)).sqrt()
        };
        let alone = error(&smoothed(&time, Some((&x, of_x)), None));
        let both = error(&smoothed(&time, Some((&x, of_x)), Some((&v, of_v))));
        assert!(alone < 0.5 * of_x, "{alone}");
        assert!(both < 0.7 * alone, "{both}");
    }

    #[test]
    fn a_velocity_alone_is_summed_up() {
        let time: Vec<f64> = (0..2000).map(|k| 1e-3 * f64::from(k)).collect();
        let v: Vec<f64> = time.iter().map(|t| 1.0 - t).collect();
        let x = smoothed(&time, None, Some((&v, 1e-6)));
        for (x, t) in x.iter().zip(&time) {
            assert!((x - (t - t * t / 2.0)).abs() < 1e-5);
        }
    }
}
