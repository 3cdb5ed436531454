//! A proposed relay and a fitted model as a loop that can be looked at.

use crate::diagnosis::{FittedModel, NextExperiment, Program};
use crate::drive::{Adhesion, Body, Command, Contact, Drive, DriveInput, VelocityRelay};
use crate::effect::baseline::Baseline;
use crate::effect::{EffectId, find};
use crate::explore::ExploreInput;
use crate::model::{Load, Model};
use crate::plant::TransferFunction;
use crate::relay::Relay;

/// A loop, ready to run.
#[derive(Clone, Debug, PartialEq)]
pub enum Opening {
    /// A relay and the linear part of the model: asymmetry and load are in the relay, which is the same.
    Loop(Box<ExploreInput>),
    /// A drive with its gap.
    Drive(Box<DriveInput>),
}

impl FittedModel {
    fn value(&self, effect: Option<EffectId>, symbol: &str) -> Option<f64> {
        let of = |p: Option<EffectId>| effect.is_none() || p == effect;
        let mut all = self.parameters.iter();
        all.find(|p| p.name == symbol && of(p.effect))
            .map(|p| p.value)
    }

    /// What it adds to, with its values.
    fn baseline(&self) -> Option<(Baseline, Vec<f64>)> {
        Baseline::ALL.into_iter().find_map(|baseline| {
            let symbols = baseline.parameters().iter().map(|p| p.symbol);
            let values: Option<_> = symbols.map(|s| self.value(None, s)).collect();
            Some((baseline, values?))
        })
    }

    /// The model that is simulated, with what each of its effects puts into it; a formula of the user's own is left
    /// out.
    fn built(&self, baseline: Baseline, values: &[f64]) -> Model {
        let mut model = baseline.model(values);
        for effect in self.effects.iter().filter_map(|id| find(*id)) {
            let symbols = effect.parameters().iter().map(|p| p.symbol);
            let own: Option<Vec<f64>> = symbols.map(|s| self.value(Some(effect.id()), s)).collect();
            if let Some(own) = own {
                effect.apply(&own, &mut model);
            }
        }
        model
    }
}

impl NextExperiment {
    /// The loop of the proposed relay at one of its gains around one of the models; `None` where the program is no
    /// relay.
    pub fn opening(&self, fitted: &FittedModel, gain: f64) -> Option<Opening> {
        let Program::Relay {
            hysteresis,
            asymmetry,
            ..
        } = self.program
        else {
            return None;
        };
        let (baseline, values) = fitted.baseline()?;
        let model = fitted.built(baseline, &values);
        // What becomes of the two levels on their way to the body are the levels of one relay.
        let [high, low] = [1.0 + asymmetry, asymmetry - 1.0].map(|l| model.map_input(gain * l));
        let relay = Relay {
            gain: 0.5 * (high - low),
            hysteresis,
            asymmetry: (high + low) / (high - low),
            // An ambient acts like the input that would hold the output there.
            bias: model.constant_force,
            // A sampled relay acts half of its sampling time late in the mean.
            delay: 0.5 * self.step,
        };
        if let Some(load) = model.load.filter(|load| load.coupling.half_gap > 0.0) {
            let run = self.drive(&model, &load, relay);
            return Some(Opening::Drive(Box::new(run)));
        }
        let (gain, mut denominator) = baseline.fraction(&values);
        if let Some(stiffness) = model.spring {
            denominator.insert(0, model.inertia / stiffness);
        }
        for lag in [model.lag, model.sensor_lag].into_iter().flatten() {
            denominator = slower(&denominator, lag);
        }
        let denominator: Vec<f64> = denominator.into_iter().map(shown).collect();
        Some(Opening::Loop(Box::new(ExploreInput {
            plant: TransferFunction::new(&[shown(gain)], &denominator, shown(model.delay)),
            relay,
            noise: None,
        })))
    }

    /// The relay on the velocity of a drive with a gap.
    fn drive(&self, model: &Model, load: &Load, relay: Relay) -> DriveInput {
        let body = |inertia: f64, viscous: f64, coulomb: f64| Body {
            inertia,
            viscous,
            coulomb,
        };
        let drive = Drive {
            motor: body(model.inertia, model.viscous, model.friction.level),
            load: body(load.inertia, load.viscous, load.dry_friction),
            half_gap: load.coupling.half_gap,
            contact: Contact::Rigid { restitution: 0.0 },
            adhesion: Adhesion::default(),
        };
        let relay = Relay {
            delay: model.delay,
            ..relay
        };
        let command = Command::Relay(VelocityRelay {
            relay,
            flip: None,
            sampling: Some(self.step),
        });
        DriveInput::new(drive, command, self.duration, Some(self.step))
    }
}

/// A coefficient with as many digits as one reads in an equation; a fitted one is known to fewer.
fn shown(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// A denominator multiplied by `lag s + 1`; the highest power is first.
fn slower(denominator: &[f64], lag: f64) -> Vec<f64> {
    let mut longer: Vec<f64> = denominator.iter().map(|c| lag * c).collect();
    longer.push(0.0);
    for (c, own) in longer.iter_mut().skip(1).zip(denominator) {
        *c += own;
    }
    longer
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::{Limits, Parameter, Status};

    #[test]
    fn a_coefficient_is_shown_with_six_digits() {
        assert_eq!(shown(0.000_879_996_655_141_020_1), 8.799_97e-4);
        assert_eq!(shown(31_925.472_031_970_59), 31_925.5);
        assert!(shown(f64::INFINITY).is_infinite() && shown(0.0) == 0.0);
    }

    #[test]
    fn a_process_with_two_lags_and_a_load_becomes_a_loop() {
        let parameter = |effect: Option<&'static str>, name: &str, value| Parameter {
            effect: effect.map(EffectId::new),
            name: name.to_owned(),
            label: String::new(),
            value,
            std_error: 0.0,
            unit: "1".to_owned(),
            status: Status::Free,
        };
        let model = FittedModel {
            effect: EffectId::new("constant_load"),
            effects: ["second_lag", "input_delay", "constant_load"]
                .map(EffectId::new)
                .to_vec(),
            parameters: vec![
                parameter(None, "K", 2.0),
                parameter(None, "T", 30.0),
                parameter(None, "ambient", 0.0),
                parameter(Some("second_lag"), "T2", 5.0),
                parameter(Some("input_delay"), "tau", 4.0),
                parameter(Some("constant_load"), "F0", 0.1),
            ],
        };
        let proposal = NextExperiment {
            class: vec![],
            program: Program::Relay {
                gains: vec![1.0, 0.3],
                hold: 50.0,
                hysteresis: 0.2,
                asymmetry: 0.0,
            },
            input_unit: "1".to_owned(),
            output_unit: "1".to_owned(),
            step: 0.2,
            needed: 100.0,
            duration: 300.0,
            separation: 3.0,
            today: 0.0,
            sufficient: true,
            speed: 1.0,
            travel: 0.0,
            limits: Limits {
                input: 1.0,
                side: 0,
                duration: 300.0,
                step: 0.2,
                speed: None,
                travel: None,
            },
            others: vec![],
            models: vec![],
            text: crate::message::Message::default(),
        };
        let Some(Opening::Loop(opened)) = proposal.opening(&model, 0.3) else {
            panic!("a loop");
        };
        // 2 e^{-4s} / ((30 s + 1)(5 s + 1))
        assert_eq!(
            opened.plant,
            TransferFunction::new(&[2.0], &[150.0, 35.0, 1.0], 4.0)
        );
        let relay = opened.relay;
        assert_eq!((relay.gain, relay.bias, relay.delay), (0.3, 0.1, 0.1));
        assert!(opened.plant.validate().is_ok() && relay.validate().is_ok());
    }
}
