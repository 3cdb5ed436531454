//! Everything about tuning one plant, for drawing: the experiment step by step, and the loops.

use crate::uncertain::brief;
use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::adaptation::{Adaptation, AdaptationMethod, adapt};
use super::asymmetric_test::{AsymmetricTest, identify};
use super::closed_loop::{LoopReport, close};
use super::controller::Pid;
use super::error::{TuningError, check};
use super::experiment::{RelayTest, Run};
use super::margins::{margins, nyquist};
use super::moving_point::{NyquistPoint, Target};
use super::phase_margin::RelayDesign;
use super::rules::{Identified, RULES, Wish, rule};
use super::ultimate::{Crossing, UltimateReport, compare, crossings};
use crate::message::{Message, fixed};
use crate::msg;
use crate::plant::TransferFunction;
use crate::relay::Relay;

/// What is tuned, how it is identified, and what is wanted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TuningInput {
    /// The plant.
    pub plant: TransferFunction,
    /// The relay. Its asymmetry and bias are used in the asymmetric test only; its delay counts as dead
    /// time of the plant, in the loops as well.
    pub relay: Relay,
    /// What is wanted.
    #[serde(default)]
    pub wish: Wish,
    /// Amplitude of the gain adaptation, half of peak to peak; `None`: that of the first test.
    #[serde(default)]
    pub amplitude: Option<f64>,
    /// How the gain is adapted.
    #[serde(default)]
    pub adaptation: AdaptationMethod,
    /// The controller before tuning.
    pub present: Pid,
    /// Id of the rule whose controller is put in at the end of the experiment.
    pub rule: String,
    /// Time that the loops are simulated, s; `None`: long enough for most.
    #[serde(default)]
    pub horizon: Option<f64>,
}

impl Default for TuningInput {
    fn default() -> Self {
        Self {
            plant: TransferFunction::new(&[1.0], &[1.0, 3.0, 3.0, 1.0], 0.0),
            relay: Relay {
                hysteresis: 0.05,
                asymmetry: 0.3,
                ..Relay::default()
            },
            wish: Wish::default(),
            amplitude: None,
            adaptation: AdaptationMethod::default(),
            present: Pid::p(1.0),
            rule: "amigo_pid".to_owned(),
            horizon: None,
        }
    }
}

impl TuningInput {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field out of its range.
    pub fn validate(&self) -> Result<(), TuningError> {
        self.plant.validate()?;
        self.relay.validate()?;
        self.present.validate()?;
        rule(&self.rule)?;
        let wish = &self.wish;
        let angle = |name: &'static str, value: f64| {
            let range = "above 0 and below pi/2 rad";
            check(name, value, value > 0.0 && value < 0.5 * PI, range)
        };
        let margin = |value: f64| check("amplitude margin", value, value > 1.0, "above 1");
        angle("phase margin", wish.phase_margin)?;
        margin(wish.amplitude_margin)?;
        match wish.target {
            Target::PhaseMargin(value) => angle("target's phase margin", value)?,
            Target::AmplitudeMargin(value) => margin(value)?,
            Target::Point { size, angle } => {
                check("target's distance", size, size > 0.0, "above 0")?;
                check("target's angle", angle, angle.abs() <= PI, "-pi to pi rad")?;
            }
        }
        let (ratio, filter) = (wish.time_ratio, wish.filter);
        let fits = (1.0..=100.0).contains(&ratio);
        check("ratio of the times", ratio, fits, "1 to 100")?;
        let fits = (1.0..=1000.0).contains(&filter);
        check("filter of the derivative", filter, fits, "1 to 1000")?;
        if let Some(a) = self.amplitude {
            check("amplitude", a, a > 0.0, "above 0")?;
        }
        if let Some(t) = self.horizon {
            check("horizon", t, t > 0.0, "above 0 s")?;
        }
        Ok(())
    }

    /// The plant with the relay's delay in its dead time, and the relay without.
    fn parts(&self) -> (TransferFunction, Relay) {
        let mut plant = self.plant.clone();
        plant.dead_time += self.relay.delay;
        let relay = Relay {
            delay: 0.0,
            ..self.relay
        };
        (plant, relay)
    }
}

/// An identified point of the Nyquist curve beside the true one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointReport {
    /// By the describing function: `M`.
    pub point: NyquistPoint,
    /// By the ratio of the first Fourier coefficients.
    pub fourier: [f64; 2],
    /// `P(jw)` of the plant.
    pub truth: [f64; 2],
    /// Distance of the describing function's point from the truth, as a share of the truth's size.
    pub error: f64,
    /// The same of the Fourier coefficients' point.
    pub fourier_error: f64,
}

/// The relay for a phase margin, and what its gain really gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseMarginReport {
    /// The adaptation, equations (7) and (8).
    pub adaptation: Adaptation,
    /// The same by the plain secant law (8), one run a step; `None` where it does not get there.
    pub secant: Option<Adaptation>,
    /// True phase margin, rad, of the proportional controller found; the describing function's error is
    /// its difference from the required one.
    pub true_phase_margin: Option<f64>,
}

/// What became of one rule.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RuleReport {
    /// Id of the rule in the registry.
    pub rule: String,
    /// Its loop, or why there is none.
    pub outcome: Result<LoopReport, TuningError>,
}

/// One step of the experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// What is done, in a few words.
    pub title: Message,
    /// What came out, in a sentence with numbers.
    pub sentence: Message,
    /// Measured period, s.
    pub period: Option<f64>,
    /// Measured amplitude, half of peak to peak.
    pub amplitude: Option<f64>,
    /// What was seen meanwhile: a relay run or a loop's step response.
    pub run: Option<Run>,
    /// Controller that was computed or is at work.
    pub controller: Option<Pid>,
}

/// Everything about tuning one plant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TuningReport {
    /// The symmetric relay test.
    pub test: RelayTest,
    /// Ultimate gain and period, equation (9).
    pub ultimate: UltimateReport,
    /// All crossings of the negative real axis by the true Nyquist curve.
    pub crossings: Vec<Crossing>,
    /// The plant's true Nyquist curve near the origin, with the relay's delay.
    pub nyquist: Vec<[f64; 2]>,
    /// The point of the Nyquist curve seen in the symmetric test.
    pub point: PointReport,
    /// Relay for the phase margin and gain adaptation, equations (7) and (8).
    pub phase_margin: Result<PhaseMarginReport, TuningError>,
    /// Model from the asymmetric test.
    pub asymmetric: Result<AsymmetricTest, TuningError>,
    /// What the rules were given.
    pub identified: Identified,
    /// Every rule of the registry, in its order.
    pub rules: Vec<RuleReport>,
    /// The loop with the present controller.
    pub before: LoopReport,
    /// The loop with the chosen rule's controller.
    pub after: Result<LoopReport, TuningError>,
    /// The experiment from the first relay run to the tuned loop.
    pub steps: Vec<Step>,
    /// Time that all loops were simulated, s.
    pub horizon: f64,
}

/// Steps of the loop simulation in a period of the relay test, and in the time constant of a filter.
const STEPS_PER_PERIOD: f64 = 100.0;
const STEPS_PER_FILTER: f64 = 2.0;

/// Horizon of the loops, in periods of the relay test, and in integral times.
const HORIZON_PERIODS: f64 = 8.0;
const HORIZON_INTEGRAL_TIMES: f64 = 5.0;

/// Runs the experiments on the simulated plant, tunes by every rule, and simulates the loops; the same
/// input gives the same report.
///
/// # Errors
/// An input out of range, or a first relay test without a settled oscillation: without that there is
/// nothing to tune from. What only one part of the report needs is an error there.
pub fn tune(input: &TuningInput) -> Result<TuningReport, TuningError> {
    input.validate()?;
    let (plant, relay) = input.parts();
    let symmetric = Relay {
        asymmetry: 0.0,
        bias: 0.0,
        ..relay
    };
    let test = RelayTest::run(&plant, &symmetric)?;
    let ultimate = compare(&test, &plant);
    let point = point_report(&test, &plant);
    let phase_margin = phase_margin(input, &plant, &test);
    let asymmetric = asymmetric(&plant, &relay, &test);
    let identified = Identified {
        ultimate: ultimate.by_relay,
        point: point.point,
        model: asymmetric
            .as_ref()
            .map_err(Clone::clone)
            .and_then(|a| a.berner.clone()),
        wish: input.wish,
    };
    let controllers: Vec<_> = RULES
        .iter()
        .map(|r| (r.id, (r.tune)(&identified)))
        .collect();
    let slowest = controllers
        .iter()
        .filter_map(|(_, c)| c.as_ref().ok()?.integral_time)
        .fold(0.0, f64::max);
    let horizon = input
        .horizon
        .unwrap_or(HORIZON_PERIODS * test.period + HORIZON_INTEGRAL_TIMES * slowest);
    let close = |pid: &Pid| {
        let mut step = test.period / STEPS_PER_PERIOD;
        if pid.derivative_time > 0.0 {
            step = step.min(pid.filter_time / STEPS_PER_FILTER);
        }
        close(&plant, pid, horizon, step)
    };
    let rules: Vec<RuleReport> = controllers
        .into_iter()
        .map(|(id, controller)| RuleReport {
            rule: id.to_owned(),
            outcome: controller.and_then(|pid| close(&pid)),
        })
        .collect();
    let before = close(&input.present)?;
    let after = rules.iter().find(|r| r.rule == input.rule).map_or_else(
        || Err(TuningError::UnknownRule(input.rule.clone())),
        |r| r.outcome.clone(),
    );
    let mut report = TuningReport {
        crossings: crossings(&plant),
        nyquist: nyquist(&plant, None),
        test,
        ultimate,
        point,
        phase_margin,
        asymmetric,
        identified,
        rules,
        before,
        after,
        steps: Vec::new(),
        horizon,
    };
    report.steps = steps(input, &report);
    Ok(report)
}

fn point_report(test: &RelayTest, plant: &TransferFunction) -> PointReport {
    let truth = plant.response(test.omega);
    let error = |p: [f64; 2]| libm::hypot(p[0] - truth.re, p[1] - truth.im) / truth.norm();
    PointReport {
        point: NyquistPoint {
            omega: test.omega,
            value: test.point,
        },
        fourier: test.fourier_point,
        truth: [truth.re, truth.im],
        error: error(test.point),
        fourier_error: error(test.fourier_point),
    }
}

fn phase_margin(
    input: &TuningInput,
    plant: &TransferFunction,
    test: &RelayTest,
) -> Result<PhaseMarginReport, TuningError> {
    let amplitude = input.amplitude.unwrap_or(test.amplitude);
    let design = RelayDesign::new(input.wish.phase_margin, amplitude)?;
    // The first run has the amplitude of the user's relay.
    let first = test.relay.gain / design.gain;
    let adaptation = adapt(plant, &design, input.adaptation, first)?;
    let secant = adapt(plant, &design, AdaptationMethod::Secant, first).ok();
    Ok(PhaseMarginReport {
        secant,
        true_phase_margin: margins(plant, &Pid::p(adaptation.gain)).phase_margin,
        adaptation,
    })
}

fn asymmetric(
    plant: &TransferFunction,
    relay: &Relay,
    symmetric: &RelayTest,
) -> Result<AsymmetricTest, TuningError> {
    // Without asymmetry the test would only repeat the first one.
    if relay.is_symmetric() {
        identify(symmetric.clone())
    } else {
        identify(RelayTest::run(plant, relay)?)
    }
}

/// The experiment as a story.
fn steps(input: &TuningInput, report: &TuningReport) -> Vec<Step> {
    let mut steps = vec![loop_step("The loop before", &report.before)];
    let test = &report.test;
    steps.push(relay_step(
        "Relay instead of the controller",
        msg!(
            "It oscillates with period {} s and amplitude {} (half of peak to peak): Ku = {}.",
            fixed(test.period, 4),
            fixed(test.amplitude, 4),
            fixed(report.ultimate.by_relay.gain, 4)
        ),
        test,
        None,
    ));
    if let Ok(found) = &report.phase_margin {
        for (n, step) in found.adaptation.steps.iter().enumerate() {
            steps.push(relay_step(
                msg!("Gain adaptation, K({})", n),
                msg!(
                    "With K = {} the amplitude is off by {} of the wanted one.",
                    fixed(step.gain, 6),
                    brief(step.error)
                ),
                &step.test,
                Some(Pid::p(step.gain)),
            ));
        }
    }
    if let Ok(found) = &report.asymmetric {
        steps.push(relay_step(
            "Asymmetric relay",
            msg!(
                "The half periods {} s and {} s have the ratio {}: normalised dead time {}.",
                fixed(found.test.on_time, 4),
                fixed(found.test.off_time, 4),
                fixed(found.half_period_ratio, 4),
                fixed(found.normalised_dead_time, 3)
            ),
            &found.test,
            None,
        ));
    }
    if let (Ok(after), Ok(rule)) = (&report.after, rule(&input.rule)) {
        steps.push(Step {
            title: rule.name.into(),
            sentence: rule.sentence.into(),
            period: None,
            amplitude: None,
            run: None,
            controller: Some(after.pid),
        });
        steps.push(loop_step("The loop after", after));
    }
    steps
}

fn relay_step(
    title: impl Into<Message>,
    sentence: Message,
    test: &RelayTest,
    controller: Option<Pid>,
) -> Step {
    Step {
        title: title.into(),
        sentence,
        period: Some(test.period),
        amplitude: Some(test.amplitude),
        run: Some(test.run.clone()),
        controller,
    }
}

fn loop_step(title: &'static str, report: &LoopReport) -> Step {
    let response = &report.set_point;
    let sentence = match report.margins {
        Some(m) => msg!(
            "Overshoot {} %, {}; maximum sensitivity {}.",
            fixed(100.0 * response.overshoot, 0),
            response.settling_time.map_or_else(
                || "not settled in the time shown".into(),
                |t| msg!("settled after {} s", fixed(t, 3))
            ),
            fixed(m.max_sensitivity, 2)
        ),
        None => msg!(
            "Unstable: {} poles in the right half plane.",
            report.unstable_poles
        ),
    };
    let input = response.time.iter().zip(&response.input);
    Step {
        title: title.into(),
        sentence,
        period: None,
        amplitude: None,
        run: Some(Run {
            time: response.time.clone(),
            output: response.output.clone(),
            input: input.map(|(t, u)| [*t, *u]).collect(),
        }),
        controller: Some(report.pid),
    }
}
