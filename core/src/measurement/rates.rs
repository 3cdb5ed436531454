//! Does the measured velocity belong to the measured position?

use super::{Channel, Quantity};
use crate::message::{Message, fixed};
use crate::msg;

/// Samples of the stretches over which the two are compared, and stretches at least.
const STRETCHES: [usize; 5] = [2, 8, 32, 128, 512];
const LEAST: usize = 20;

/// Share of what the position does that the velocity must tell, up to a factor, for that to be known.
const TOLD: f64 = 0.95;

/// By how much the factor may be off 1: tachometers are.
const TOLERANCE: f64 = 0.03;

/// Factors between units that are mistaken for each other, what then is measured, and how near they must be.
const MISTAKEN: [(f64, &str); 4] = [
    (180.0 / std::f64::consts::PI, "degrees"),
    (30.0 / std::f64::consts::PI, "revolutions per minute"),
    (0.5 / std::f64::consts::PI, "revolutions"),
    (1000.0, "thousandths"),
];
const NEAR: f64 = 0.02;

/// A sentence where the velocity is another multiple of the rate of the position than 1.
pub(super) fn contradiction(time: &[f64], outputs: &[Channel]) -> Option<Message> {
    let of = |quantity| outputs.iter().find(|c| c.quantity == quantity);
    let (x, v) = (of(Quantity::Position)?, of(Quantity::Velocity)?);
    let compared = STRETCHES.iter().filter(|m| time.len() / **m >= LEAST);
    let compared = compared.filter_map(|m| Likeness::of(time, &x.values, &v.values, *m));
    let best = compared.max_by(|a, b| a.told().total_cmp(&b.told()))?;
    let ratio = best.ratio().filter(|_| best.told() > TOLD)?;
    let [x, v] = [x, v].map(|of| Message::name(&of.name));
    if ratio < 0.0 && (ratio + 1.0).abs() < TOLERANCE {
        return Some(msg!(
            "{} runs against {}: flip the sign of one of them.",
            v,
            x
        ));
    }
    let mistaken = |size: f64| {
        let near = |(factor, _): &&(f64, &str)| (size / factor - 1.0).abs() < NEAR;
        MISTAKEN.iter().find(near).map(|(_, unit)| unit)
    };
    let hint = match (mistaken(ratio.abs()), mistaken(1.0 / ratio.abs())) {
        (Some(unit), _) => Some((&v, unit)),
        (_, Some(unit)) => Some((&x, unit)),
        _ => None,
    };
    let digits = (2.0 - libm::floor(libm::log10(ratio.abs()))).clamp(0.0, 6.0) as usize;
    let ratio = fixed(ratio, digits);
    Some(match hint {
        Some((of, unit)) => msg!(
            "{} is {} times the rate at which {} moves: check their units and that of the time; {} looks like {}.",
            &v,
            ratio,
            &x,
            of,
            unit
        ),
        None => msg!(
            "{} is {} times the rate at which {} moves: check their units and that of the time.",
            v,
            ratio,
            x
        ),
    })
}

/// Sums of squares and products over stretches: of the way of the position, and of the velocity.
struct Likeness {
    way: f64,
    mixed: f64,
    told: f64,
}

impl Likeness {
    fn of(time: &[f64], x: &[f64], v: &[f64], samples: usize) -> Option<Self> {
        let mut sums = Self {
            way: 0.0,
            mixed: 0.0,
            told: 0.0,
        };
        for from in (0..time.len() - samples).step_by(samples) {
            let to = from + samples;
            let over = (from..to).map(|k| 0.5 * (v[k] + v[k + 1]) * (time[k + 1] - time[k]));
            let (way, told) = (x[to] - x[from], over.sum::<f64>());
            sums.way += way * way;
            sums.mixed += way * told;
            sums.told += told * told;
        }
        (sums.way > 0.0 && sums.told > 0.0).then_some(sums)
    }

    /// Share of the one that the other tells, up to a factor.
    fn told(&self) -> f64 {
        self.mixed * self.mixed / (self.way * self.told)
    }

    /// How many times too fast the velocity is; `None` where noise of either may have made the difference.
    fn ratio(&self) -> Option<f64> {
        // Noise of one makes the first too small, noise of the other the second too large.
        let [one, other] = [self.mixed / self.way, self.told / self.mixed];
        let off = |ratio: f64| ratio - 1.0;
        let apart = off(one) > TOLERANCE || off(other) < -TOLERANCE;
        apart.then(|| (one * other).sqrt() * one.signum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-3;

    /// Position in steps of an encoder and velocity with noise, `factor` times too fast.
    fn said(factor: f64, noise: f64) -> Option<Message> {
        let time: Vec<f64> = (0..4000).map(|k| STEP * f64::from(k)).collect();
        let channel = |quantity, name: &str, values: Vec<f64>| Channel {
            quantity,
            name: name.to_owned(),
            unit: String::new(),
            values,
        };
        let counted = |t: &f64| (libm::sin(9.0 * t) * 1e3).round() / 1e3;
        let rough = |t: &f64| 9.0 * libm::cos(9.0 * t) + noise * libm::sin(1e7 * t * t);
        contradiction(
            &time,
            &[
                channel(Quantity::Position, "x1", time.iter().map(counted).collect()),
                channel(
                    Quantity::Velocity,
                    "v1",
                    time.iter().map(|t| factor * rough(t)).collect(),
                ),
            ],
        )
    }

    #[test]
    fn a_velocity_in_other_units_is_said_and_they_are_guessed() {
        for (factor, part) in [
            (
                180.0 / std::f64::consts::PI,
                "57.3 times the rate at which x1 moves: check their units and that of the time; v1 looks like degrees.",
            ),
            (std::f64::consts::TAU, "x1 looks like revolutions."),
            (
                1.2,
                "1.20 times the rate at which x1 moves: check their units and that of the time.",
            ),
            (-1.0, "v1 runs against x1"),
        ] {
            let said = said(factor, 0.1).expect("a sentence");
            assert!(said.to_string().contains(part), "{said}");
        }
    }

    #[test]
    fn noise_is_no_other_unit() {
        for noise in [0.0, 0.3, 3.0, 30.0, 300.0] {
            assert_eq!(said(1.0, noise), None, "{noise}");
            assert_eq!(said(1.02, noise), None, "{noise}");
        }
    }
}
