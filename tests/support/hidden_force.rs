//! Forces that no search knows beforehand, drawn from a grammar of their own, on a drive that uses nothing of the model
//! under test: Runge-Kutta steps, a sampled controller, sensors with white noise.

use hysteron_core::measurement::Measurement;
use hysteron_core::rig::Random;

use super::record::of_motor;

/// Where the body is.
#[derive(Clone, Copy, Debug)]
pub struct At {
    pub x: f64,
    pub v: f64,
    pub u: f64,
    pub t: f64,
}

/// A force with its kind.
pub struct Term {
    pub kind: &'static str,
    pub text: String,
    pub force: Box<dyn Fn(&At) -> f64 + Send + Sync>,
}

/// What drives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// A position loop that goes from place to place and dwells.
    Moves,
    /// A torque that wanders, with a weak loop that keeps the body near its place.
    Walk,
}

/// A drive with a hidden force.
pub struct Hidden {
    pub seed: u64,
    pub drive: Drive,
    pub inertia: f64,
    pub viscous: f64,
    pub terms: Vec<Term>,
}

const STEP: f64 = 2e-3;
const SUBSTEPS: usize = 8;
pub const SAMPLES: usize = 6000;
/// Noise of each sensor, in times of the root mean square of what it shows.
const NOISE: f64 = 0.01;

/// What acts along the record, without noise.
pub struct Truth {
    pub at: Vec<At>,
    pub force: Vec<f64>,
}

impl Hidden {
    /// One or two terms; the numbers of one of them enter nonlinearly at most.
    pub fn drawn(seed: u64) -> Self {
        let mut random = Random::new(seed.wrapping_mul(7919));
        let drive = if seed.is_multiple_of(2) {
            Drive::Moves
        } else {
            Drive::Walk
        };
        let inertia = random.between(0.008, 0.015);
        let viscous = random.between(0.01, 0.03);
        let two = random.between(0.0, 1.0) < 0.5;
        let first = bent(&mut random);
        let mut terms = vec![first];
        if two {
            loop {
                let other = straight(&mut random);
                if other.kind != terms[0].kind {
                    terms.push(other);
                    break;
                }
            }
        } else if random.between(0.0, 1.0) < 0.25 {
            terms = vec![straight(&mut random)];
        }
        Self {
            seed,
            drive,
            inertia,
            viscous,
            terms,
        }
    }

    pub fn kind(&self) -> String {
        let kinds: Vec<&str> = self.terms.iter().map(|t| t.kind).collect();
        kinds.join(" + ")
    }

    pub fn text(&self) -> String {
        let texts: Vec<&str> = self.terms.iter().map(|t| t.text.as_str()).collect();
        texts.join(" + ")
    }

    pub fn force(&self, at: &At) -> f64 {
        self.terms.iter().map(|t| (t.force)(at)).sum()
    }

    fn rates(&self, [x, v]: [f64; 2], u: f64, t: f64) -> [f64; 2] {
        let force = self.force(&At { x, v, u, t });
        [v, (u - self.viscous * v + force) / self.inertia]
    }

    fn advance(&self, s: [f64; 2], u: f64, t: f64, h: f64) -> [f64; 2] {
        let ahead = |k: [f64; 2], h: f64| [s[0] + h * k[0], s[1] + h * k[1]];
        let k1 = self.rates(s, u, t);
        let k2 = self.rates(ahead(k1, h / 2.0), u, t + h / 2.0);
        let k3 = self.rates(ahead(k2, h / 2.0), u, t + h / 2.0);
        let k4 = self.rates(ahead(k3, h), u, t + h);
        [0, 1].map(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }

    /// Runs the experiment: the record, and what acted.
    pub fn measure(&self) -> (Measurement, Truth) {
        let mut random = Random::new(self.seed.wrapping_mul(104_729) + 1);
        let h = STEP / SUBSTEPS as f64;
        let mut s = [0.0, 0.0];
        let (mut time, mut input, mut x, mut v) = (vec![], vec![], vec![], vec![]);
        let mut truth = Truth {
            at: Vec::new(),
            force: Vec::new(),
        };
        let (mut goal, mut wander, mut level) = (0.0, 0.0, 0.0);
        let mut place = 0.0;
        for i in 0..SAMPLES {
            let t = i as f64 * STEP;
            let u = match self.drive {
                Drive::Moves => {
                    if i % 350 == 0 {
                        goal = random.between(-2.0, 2.0);
                    }
                    // A ramp to the goal, as a motion planner gives it.
                    let speed = 6.0 * STEP;
                    place += (goal - place).clamp(-speed, speed);
                    (3.0 * (place - s[0]) - 0.25 * s[1]).clamp(-1.5, 1.5)
                }
                Drive::Walk => {
                    if i % 12 == 0 {
                        level = 0.5 * random.normal();
                    }
                    wander += 0.15 * (level - wander);
                    wander - 0.12 * s[0]
                }
            };
            let at = At {
                x: s[0],
                v: s[1],
                u,
                t,
            };
            truth.force.push(self.force(&at));
            truth.at.push(at);
            time.push(t);
            input.push(u);
            x.push(s[0]);
            v.push(s[1]);
            for j in 0..SUBSTEPS {
                s = self.advance(s, u, t + j as f64 * h, h);
            }
        }
        for series in [&mut x, &mut v] {
            let mean = series.iter().sum::<f64>() / SAMPLES as f64;
            let size =
                (series.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / SAMPLES as f64).sqrt();
            for value in series.iter_mut() {
                *value += NOISE * size * random.normal();
            }
        }
        let record = of_motor(format!("hidden force {}", self.seed), time, [input, x, v]);
        (record, truth)
    }
}

fn term(
    kind: &'static str,
    text: String,
    force: impl Fn(&At) -> f64 + Send + Sync + 'static,
) -> Term {
    Term {
        kind,
        text,
        force: Box::new(force),
    }
}

/// A term with a number that enters nonlinearly; of several the search has no form of its own.
fn bent(r: &mut Random) -> Term {
    let a = r.between(0.15, 0.4);
    let which = r.between(0.0, 28.0) as usize;
    match which {
        0 => {
            let (n, p) = (r.between(1.5, 9.0), r.between(-3.0, 3.0));
            term(
                "wave of place",
                format!("{a:.3} sin({n:.3} x + {p:.3})"),
                move |m| a * (n * m.x + p).sin(),
            )
        }
        1 => {
            let s = r.between(0.3, 0.8);
            term(
                "spring that gives way",
                format!("-{a:.3} x exp(-(x/{s:.3})^2)/{s:.3}"),
                move |m| -2.0 * a * m.x / s * (-(m.x / s).powi(2)).exp(),
            )
        }
        2 => {
            let s = r.between(0.2, 0.8);
            term(
                "spring that saturates",
                format!("-{a:.3} tanh(x/{s:.3})"),
                move |m| -a * (m.x / s).tanh(),
            )
        }
        3 => {
            let s = r.between(0.3, 1.0);
            term(
                "rational spring",
                format!("-{a:.3} x/sqrt(x^2+{s:.3}^2)"),
                move |m| -a * m.x / (m.x * m.x + s * s).sqrt(),
            )
        }
        4 => {
            let b = r.between(-0.4, 0.6);
            term(
                "one-sided spring",
                format!("-{a:.3} max(x-{b:.3}, 0)"),
                move |m| -a * (m.x - b).max(0.0),
            )
        }
        5 => {
            let s = r.between(0.3, 1.5);
            term(
                "friction that saturates",
                format!("-{a:.3} tanh(v/{s:.3})"),
                move |m| -a * (m.v / s).tanh(),
            )
        }
        6 => {
            let s = r.between(0.4, 2.0);
            term(
                "flattening friction",
                format!("-{a:.3} v/(|v|+{s:.3})"),
                move |m| -a * m.v / (m.v.abs() + s),
            )
        }
        7 => {
            let s = r.between(0.5, 2.0);
            term(
                "friction with a hump",
                format!("-{a:.3} v exp(-|v|/{s:.3})/{s:.3}"),
                move |m| -3.0 * a * m.v / s * (-m.v.abs() / s).exp(),
            )
        }
        8 => {
            let s = r.between(0.5, 2.0);
            term(
                "rational friction",
                format!("-{a:.3} v {s:.3}/(v^2+{s:.3}^2)"),
                move |m| -2.0 * a * m.v * s / (m.v * m.v + s * s),
            )
        }
        9 => {
            let s = r.between(0.4, 2.0);
            term(
                "logarithmic friction",
                format!("-{a:.3} ln(1+|v|/{s:.3}) sgn v"),
                move |m| -0.6 * a * (1.0 + m.v.abs() / s).ln() * m.v.signum(),
            )
        }
        10 => {
            let s = r.between(0.5, 2.0);
            term(
                "friction that builds up",
                format!("-{a:.3} (1-exp(-|v|/{s:.3})) sgn v"),
                move |m| -a * (1.0 - (-m.v.abs() / s).exp()) * m.v.signum(),
            )
        }
        11 => {
            let (n, p) = (r.between(1.5, 6.0), r.between(-3.0, 3.0));
            let a = 1.2 * a;
            term(
                "ripple of the input",
                format!("{a:.3} u sin({n:.3} x + {p:.3})"),
                move |m| a * m.u * (n * m.x + p).sin(),
            )
        }
        12 => {
            let (f, p) = (r.between(0.3, 3.0), r.between(-3.0, 3.0));
            let w = std::f64::consts::TAU * f;
            term(
                "shaking",
                format!("{a:.3} sin({w:.3} t + {p:.3})"),
                move |m| a * (w * m.t + p).sin(),
            )
        }
        13 => {
            let s = r.between(2.0, 6.0);
            term(
                "load that dies away",
                format!("{a:.3} exp(-t/{s:.3})"),
                move |m| 1.5 * a * (-m.t / s).exp(),
            )
        }
        14 => {
            let s = r.between(0.4, 1.0);
            term(
                "damping near a place",
                format!("-{a:.3} v exp(-(x/{s:.3})^2)"),
                move |m| -0.3 * a * m.v * (-(m.x / s).powi(2)).exp(),
            )
        }
        15 => {
            let s = r.between(1.0, 4.0);
            term(
                "gain that falls with speed",
                format!("-{a:.3} u (1-1/(1+(v/{s:.3})^2))"),
                move |m| -1.5 * a * m.u * (1.0 - 1.0 / (1.0 + (m.v / s).powi(2))),
            )
        }
        16 => {
            let s = r.between(0.2, 0.6);
            term(
                "amplifier that saturates",
                format!("-{a:.3} (u - {s:.3} tanh(u/{s:.3}))"),
                move |m| -1.5 * a * (m.u - s * (m.u / s).tanh()),
            )
        }
        17 => {
            let s = r.between(0.4, 1.0);
            term(
                "spring by a hyperbolic sine",
                format!("-{a:.3} sinh(x/{s:.3})"),
                move |m| -0.2 * a * (m.x / s).sinh(),
            )
        }
        18 => {
            let s = r.between(0.4, 2.0);
            term(
                "friction by an area sine",
                format!("-{a:.3} asinh(v/{s:.3})"),
                move |m| -0.6 * a * (m.v / s).asinh(),
            )
        }
        19 => {
            let s = r.between(0.1, 0.5);
            term(
                "push on one side",
                format!("{a:.3}/(1+exp(-x/{s:.3}))"),
                move |m| a / (1.0 + (-m.x / s).exp()),
            )
        }
        20 => {
            let s = r.between(0.8, 2.5);
            term(
                "friction with a sharp hump",
                format!("-{a:.3} v/(1+(v/{s:.3})^4)"),
                move |m| -2.0 * a * m.v / s / (1.0 + (m.v / s).powi(4)),
            )
        }
        21 => {
            let n = r.between(1.0, 4.0);
            term(
                "squared sine of place",
                format!("{a:.3} sin({n:.3} x)^2"),
                move |m| a * (n * m.x).sin().powi(2),
            )
        }
        22 => {
            let b = r.between(0.2, 0.7);
            term(
                "spring with play",
                format!("-{a:.3} (x-clamp(x, {b:.3}))"),
                move |m| -1.5 * a * (m.x - m.x.clamp(-b, b)),
            )
        }
        23 => {
            let s = r.between(0.4, 1.5);
            term(
                "friction that saturates late",
                format!("-{a:.3} v/(|v|^3+{s:.3}^3)^(1/3)"),
                move |m| -a * m.v / (m.v.abs().powi(3) + s.powi(3)).cbrt(),
            )
        }
        24 => {
            let n = r.between(1.0, 3.0);
            term(
                "arm that grows",
                format!("-{a:.3} x cos({n:.3} x)"),
                move |m| -a * m.x * (n * m.x).cos(),
            )
        }
        25 => {
            let s = r.between(0.3, 0.8);
            term(
                "friction away from a place",
                format!("-{a:.3} tanh(v) x^2/(x^2+{s:.3}^2)"),
                move |m| -a * m.v.tanh() * m.x * m.x / (m.x * m.x + s * s),
            )
        }
        26 => {
            let s = r.between(2.0, 6.0);
            term(
                "spring that fades",
                format!("-{a:.3} x exp(-t/{s:.3})"),
                move |m| -1.5 * a * m.x * (-m.t / s).exp(),
            )
        }
        _ => {
            let n = r.between(2.0, 7.0);
            term(
                "damping that ripples",
                format!("-{a:.3} v cos({n:.3} x)"),
                move |m| -0.25 * a * m.v * (n * m.x).cos(),
            )
        }
    }
}

/// A term of plain powers.
fn straight(r: &mut Random) -> Term {
    let a = r.between(0.08, 0.3);
    match r.between(0.0, 12.0) as usize {
        0 => term("cubic spring", format!("-{:.3} x^3", 0.3 * a), move |m| {
            -0.3 * a * m.x.powi(3)
        }),
        1 => term("spring", format!("-{a:.3} x"), move |m| -a * m.x),
        2 => term("drag", format!("-{:.4} v|v|", 0.1 * a), move |m| {
            -0.1 * a * m.v * m.v.abs()
        }),
        3 => term(
            "cubic friction",
            format!("-{:.4} v^3", 0.02 * a),
            move |m| -0.02 * a * m.v.powi(3),
        ),
        4 => term(
            "damping away from a place",
            format!("-{:.3} x^2 v", 0.15 * a),
            move |m| -0.15 * a * m.x * m.x * m.v,
        ),
        5 => term("load", format!("{a:.3}"), move |_| a),
        6 => term("ramp", format!("{:.4} t", 0.1 * a), move |m| 0.1 * a * m.t),
        7 => term("warming", format!("-{:.4} t v", 0.02 * a), move |m| {
            -0.02 * a * m.t * m.v
        }),
        8 => term("quadratic gain", format!("{a:.3} u|u|"), move |m| {
            a * m.u * m.u.abs()
        }),
        9 => term(
            "friction by a power",
            format!("-{:.4} v|v|^0.5", 0.2 * a),
            move |m| -0.2 * a * m.v * m.v.abs().sqrt(),
        ),
        10 => term(
            "power of the motor",
            format!("-{:.4} u^2 v", 0.3 * a),
            move |m| -0.3 * a * m.u * m.u * m.v,
        ),
        _ => term("gain by place", format!("{a:.3} u x"), move |m| {
            a * m.u * m.x
        }),
    }
}
