//! The cycle that the first harmonic alone would have: `N(A) P(jw) + 1 = 0`.

use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::plant::OnOffPlant;
use super::relay::OnOffRelay;
use super::run::OnOffLoop;
use crate::limit_cycle::{self, Intersection};
use crate::plant::TransferFunction;
use crate::relay::Relay;
use crate::root::{SECTIONS, golden_section, illinois};

/// A solution of the harmonic balance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Period, s.
    pub period: f64,
    /// Amplitude of the output around its reference.
    pub amplitude: f64,
    /// Whether a slightly larger oscillation dies down to it (Loeb's criterion); `None` where it only touches.
    pub stable: Option<bool>,
}

/// Frequencies of the scan, and its decades around the plant's typical frequency.
const POINTS: i32 = 6000;
const DECADES: f64 = 3.0;

/// Largest amplitude that is looked at, in thresholds.
const LARGEST: f64 = 1e6;

/// Most balances that are reported.
const MOST: usize = 40;

/// Describing function of the controller for a sine of this amplitude around its reference, without delay:
///
/// ```text
/// N(A) = 2k/(pi A) [sqrt(1 - (on/A)^2) + sqrt(1 - (off/A)^2)] - j 2k (on - off)/(pi A^2),   on, off = d +- eps
/// ```
///
/// (Tsypkin 1984; Gelb and Vander Velde 1968.) 0 where the sine does not reach the thresholds.
fn gain(loop_: &OnOffLoop, amplitude: f64) -> Complex<f64> {
    let relay = &loop_.relay;
    let [on, off] = [1.0, -1.0].map(|sign| relay.dead_zone + sign * relay.relay.hysteresis);
    if amplitude <= on {
        return Complex::from(0.0);
    }
    let root = |level: f64| (1.0 - (level / amplitude).powi(2)).max(0.0).sqrt();
    let scale = 2.0 * relay.relay.gain / (PI * amplitude);
    Complex::new(
        scale * (root(on) + root(off)),
        -scale * (on - off) / amplitude,
    )
}

/// All balances, by rising frequency; `None` where the first harmonic is not known: three positions with outputs that
/// differ or a reference that is not 0, and these in discrete time. With two positions they are a bias, and the mean
/// balances as well. A sampled controller acts half its sampling time later in the mean; in discrete time the samples
/// of plant and controller are the same, and do not. A balance that breaks a shortest time is left out.
pub fn describing_function(loop_: &OnOffLoop) -> Option<Vec<Balance>> {
    loop_.validate().ok()?;
    let relay = &loop_.relay;
    let symmetric = relay.relay.is_symmetric() && relay.relay.bias == 0.0;
    let mut found = match &loop_.plant {
        _ if symmetric && relay.reference == 0.0 => Scan::new(loop_).balances(),
        OnOffPlant::Continuous(plant, _) if !relay.has_three_positions() => {
            two_positions(plant, relay)?
        }
        _ => return None,
    };
    found.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    found.truncate(MOST);
    Some(found)
}

/// The two curves whose meetings are the balances.
#[derive(Default)]
pub(super) struct Curves {
    /// `P(jw)` with all delays, by rising frequency.
    pub nyquist: Vec<Complex<f64>>,
    /// `-1/N(A)`, by rising amplitude.
    pub inverse: Vec<Complex<f64>>,
    /// Where they meet.
    pub meetings: Vec<Complex<f64>>,
}

/// Points of each curve.
const DRAWN: i32 = 600;

/// What is drawn of `-1/N(A)`: amplitudes from this share above the least, up to so many times the largest that
/// balances.
const JUST_ABOVE: f64 = 1e-3;
const FURTHER: f64 = 2.5;

/// How far the Nyquist curve goes on both sides of the balance, or of the plant's typical frequency, in decades.
const BELOW: f64 = 2.0;
const ABOVE: f64 = 1.5;

/// The curves where the first harmonic of a symmetric loop tells; empty for any other.
pub(super) fn curves(loop_: &OnOffLoop, balances: &[Balance]) -> Curves {
    let relay = &loop_.relay;
    let symmetric = relay.relay.is_symmetric() && relay.relay.bias == 0.0;
    if loop_.validate().is_err() || !symmetric || relay.reference != 0.0 {
        return Curves::default();
    }
    let scan = Scan::new(loop_);
    let centre = balances
        .first()
        .map_or(1.0 / (loop_.plant.typical_time() + loop_.lag()), |b| {
            b.omega
        });
    let highest = scan.range[1];
    let share = |i: i32| f64::from(i) / f64::from(DRAWN);
    let nyquist = (0..=DRAWN)
        .map(|i| centre * libm::pow(10_f64, (ABOVE + BELOW) * share(i) - BELOW))
        .take_while(|omega| *omega <= highest)
        .filter_map(|omega| scan.response(omega))
        .collect();
    let reach = balances.iter().map(|b| b.amplitude).fold(0.0, f64::max);
    let least = scan.least * (1.0 + JUST_ABOVE);
    let least = if least > 0.0 {
        least
    } else {
        JUST_ABOVE * reach.max(relay.relay.gain)
    };
    let most = FURTHER * reach.max(2.0 * scan.peak).max(least);
    let inverse = (0..=DRAWN)
        .map(|i| least * libm::pow(most / least, share(i)))
        .map(|amplitude| -gain(loop_, amplitude).inv())
        .filter(|v| v.re.is_finite() && v.im.is_finite())
        .collect();
    let meetings = balances
        .iter()
        .filter_map(|b| scan.response(b.omega))
        .collect();
    Curves {
        nyquist,
        inverse,
        meetings,
    }
}

/// Two positions with a reference: that of a relay with a bias that puts the output there in the mean. `None` where no
/// bias does.
fn two_positions(plant: &TransferFunction, relay: &OnOffRelay) -> Option<Vec<Balance>> {
    let gain = plant.dc_gain();
    let needed = if relay.reference == 0.0 {
        0.0
    } else {
        relay.reference / gain
    };
    if !needed.is_finite() || (relay.reference != 0.0 && !gain.is_finite()) {
        return None;
    }
    let around = Relay {
        bias: relay.relay.bias - needed,
        delay: relay.relay.delay + 0.5 * relay.sampling.unwrap_or(0.0),
        ..relay.relay
    };
    let levels = [true, false].map(|high| around.output(high));
    let keeps_its_times = |i: &&Intersection| {
        // The share of the period in which it is up is what the mean of the output takes.
        let mean = if gain.is_finite() { i.mean / gain } else { 0.0 };
        let up = (mean - levels[0]) / (levels[1] - levels[0]);
        up * i.cycle.period >= relay.min_on && (1.0 - up) * i.cycle.period >= relay.min_off
    };
    let all = limit_cycle::describing_function(plant, &around);
    let balance = |i: &Intersection| Balance {
        omega: i.omega,
        period: i.cycle.period,
        amplitude: i.cycle.amplitude,
        stable: i.cycle.stable,
    };
    Some(all.iter().filter(keeps_its_times).map(balance).collect())
}

struct Scan<'a> {
    loop_: &'a OnOffLoop,
    /// Delay that is not in the plant, s.
    delay: f64,
    /// Range of frequencies, rad/s.
    range: [f64; 2],
    /// Amplitude at which the describing function is largest, and the smallest that passes.
    peak: f64,
    least: f64,
}

impl<'a> Scan<'a> {
    fn new(loop_: &'a OnOffLoop) -> Self {
        let relay = &loop_.relay;
        let centre = 1.0 / (loop_.plant.typical_time() + loop_.lag());
        let spread = libm::pow(10_f64, DECADES);
        let step = loop_.plant.sampling();
        let highest = step.map_or(f64::INFINITY, |step| PI / step);
        let half = 0.5 * relay.sampling.filter(|_| step.is_none()).unwrap_or(0.0);
        let delay = relay.relay.delay + half;
        let least = relay.dead_zone + relay.relay.hysteresis;
        let size = |log: f64| gain(loop_, least * libm::exp(log)).norm();
        // It rises from 0 with a dead zone, and else falls at once.
        let peak = if relay.has_three_positions() {
            let found = golden_section((0.0, libm::log(10.0)), SECTIONS, f64::INFINITY, size);
            least * libm::exp(found.at)
        } else {
            least
        };
        Self {
            loop_,
            delay,
            range: [centre / spread, (centre * spread).min(highest)],
            peak,
            least,
        }
    }

    fn balances(&self) -> Vec<Balance> {
        let mut found = Vec::new();
        for outer in [false, true] {
            let mut last: Option<(f64, f64)> = None;
            for i in 0..=POINTS {
                let omega = self.omega(i);
                let next = self.phase(omega, outer).map(|(phase, _)| (omega, phase));
                if let (Some(a), Some(b)) = (last, next) {
                    // The phase is known up to whole turns: a jump by one is no crossing.
                    let crosses = (a.1 < 0.0) != (b.1 < 0.0) && (a.1 - b.1).abs() < PI;
                    if crosses {
                        found.extend(self.solve(a, b, outer));
                    }
                }
                last = next;
            }
        }
        found
    }

    fn omega(&self, i: i32) -> f64 {
        let [low, high] = self.range;
        low * libm::pow(high / low, f64::from(i) / f64::from(POINTS))
    }

    fn response(&self, omega: f64) -> Option<Complex<f64>> {
        let p = self.loop_.plant.response(omega)?;
        Some(p * Complex::from_polar(1.0, -omega * self.delay))
    }

    /// Amplitude at which `|N P| = 1` on this side of the peak.
    fn amplitude(&self, response: Complex<f64>, outer: bool) -> Option<f64> {
        if self.least == 0.0 {
            // An ideal relay: N = 4k/(pi A).
            let gain = self.loop_.relay.relay.gain;
            return outer.then_some(4.0 * gain / PI * response.norm());
        }
        let off = |log: f64| {
            let n = gain(self.loop_, self.least * libm::exp(log));
            n.norm() * response.norm() - 1.0
        };
        let tiny = 1e-12;
        let peak = libm::log(self.peak / self.least).max(tiny);
        let [low, high] = if outer {
            [peak, libm::log(LARGEST)]
        } else {
            [tiny, peak]
        };
        let (at_low, at_high) = (off(low), off(high));
        if (at_low < 0.0) == (at_high < 0.0) {
            return None;
        }
        let log = illinois((low, at_low), (high, at_high), off);
        Some(self.least * libm::exp(log))
    }

    /// Phase of `-N P`, and the amplitude.
    fn phase(&self, omega: f64, outer: bool) -> Option<(f64, f64)> {
        let response = self.response(omega)?;
        let amplitude = self.amplitude(response, outer)?;
        let phase = (-(gain(self.loop_, amplitude) * response)).arg();
        phase.is_finite().then_some((phase, amplitude))
    }

    fn solve(&self, low: (f64, f64), high: (f64, f64), outer: bool) -> Option<Balance> {
        let phase = |w: f64| self.phase(w, outer).map_or(f64::NAN, |(phase, _)| phase);
        let omega = illinois(low, high, phase);
        let (_, amplitude) = self.phase(omega, outer)?;
        let balance = Balance {
            omega,
            period: 2.0 * PI / omega,
            amplitude,
            stable: self.stable(omega, amplitude),
        };
        self.keeps_its_times(&balance).then_some(balance)
    }

    /// Loeb's criterion, with `U + jV = N P`: `dU/dA dV/dw - dU/dw dV/dA > 0`.
    fn stable(&self, omega: f64, amplitude: f64) -> Option<bool> {
        let (step_a, step_w) = (1e-6 * amplitude, 1e-6 * omega);
        let n = |a: f64| gain(self.loop_, a);
        let by_a = (n(amplitude + step_a) - n(amplitude)) * self.response(omega)?;
        let by_w =
            n(amplitude) * (self.response(omega + step_w)? - self.response(omega - step_w)?);
        let cross = by_a.re * by_w.im - by_w.re * by_a.im;
        (cross != 0.0 && cross.is_finite()).then_some(cross > 0.0)
    }

    /// Whether each position lasts as long as it has to.
    fn keeps_its_times(&self, balance: &Balance) -> bool {
        let relay = &self.loop_.relay;
        let angle = |level: f64| libm::asin((level / balance.amplitude).clamp(-1.0, 1.0));
        let [on, off] = [1.0, -1.0].map(|s| angle(relay.dead_zone + s * relay.relay.hysteresis));
        let on_time = (PI - off - on) / balance.omega;
        let off_time = if relay.has_three_positions() {
            (on + off) / balance.omega
        } else {
            on_time
        };
        on_time >= relay.min_on && off_time >= relay.min_off
    }
}
