//! A proposed relay and a fitted model as a loop that can be looked at.

use super::experiment::{FittedModel, NextExperiment};
use super::program::Program;
use crate::drive::{Body, Command, Drive, DriveInput, VelocityRelay};
use crate::effect::EffectId;
use crate::explore::ExploreInput;
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
    fn value(&self, effect: Option<&str>, symbol: &str) -> Option<f64> {
        let of = |p: Option<EffectId>| effect.is_none() || p.map(EffectId::as_str) == effect;
        let mut all = self.parameters.iter();
        all.find(|p| p.name == symbol && of(p.effect))
            .map(|p| p.value)
    }

    /// The value of an effect that is in the model, else 0.
    fn or_none(&self, effect: &str, symbol: &str) -> f64 {
        self.value(Some(effect), symbol).unwrap_or(0.0)
    }
}

impl NextExperiment {
    /// The loop of the proposed relay at one of its gains around one of the models; `None` where the program is no
    /// relay.
    pub fn opening(&self, model: &FittedModel, gain: f64) -> Option<Opening> {
        let Program::Relay {
            hysteresis,
            asymmetry,
            ..
        } = self.program
        else {
            return None;
        };
        // (1 + a) k (1 + A) and (1 - a) k (1 - A) are the levels of one relay.
        let actuator = model.or_none("gain_asymmetry", "a");
        let together = 1.0 + actuator * asymmetry;
        // An ambient acts like the input that would hold the output there.
        let ambient = model.value(None, "ambient").zip(model.value(None, "K"));
        let ambient = ambient.map_or(0.0, |(ambient, gain)| ambient / gain);
        let relay = Relay {
            gain: gain * together,
            hysteresis,
            asymmetry: (actuator + asymmetry) / together,
            bias: model.or_none("constant_load", "F0") + ambient,
            // A sampled relay acts half of its sampling time late in the mean.
            delay: 0.5 * self.step,
        };
        let delay = model.or_none("input_delay", "tau");
        if let Some(half_gap) = model.value(Some("backlash"), "beta") {
            let body = |inertia: f64, viscous: f64, coulomb: f64| Body {
                inertia,
                viscous,
                coulomb,
            };
            let of_load = |symbol: &str| model.or_none("backlash", symbol);
            let drive = Drive {
                motor: body(
                    model.value(None, "J1")?,
                    model.value(None, "d1")?,
                    model.or_none("coulomb_friction", "c"),
                ),
                load: body(of_load("J2"), of_load("d2"), of_load("c2")),
                half_gap,
                contact: crate::drive::Contact::Rigid { restitution: 0.0 },
                adhesion: crate::drive::Adhesion::default(),
            };
            let relay = VelocityRelay {
                relay: Relay { delay, ..relay },
                flip: None,
                sampling: Some(self.step),
            };
            let command = Command::Relay(relay);
            let run = DriveInput::new(drive, command, self.duration, Some(self.step));
            return Some(Opening::Drive(Box::new(run)));
        }
        let (gain, mut denominator) = match model.value(None, "J1") {
            Some(inertia) => (1.0, vec![inertia, model.value(None, "d1")?]),
            None => match model.value(None, "K/T") {
                Some(rate) => (rate, vec![1.0, 0.0]),
                None => (model.value(None, "K")?, vec![model.value(None, "T")?, 1.0]),
            },
        };
        for (effect, symbol) in [
            ("second_lag", "T2"),
            ("actuator_lag", "T_a"),
            ("sensor_lag", "T_s"),
        ] {
            if let Some(lag) = model.value(Some(effect), symbol) {
                // Multiplied by (lag s + 1).
                let mut longer: Vec<f64> = denominator.iter().map(|c| lag * c).collect();
                longer.push(0.0);
                for (c, own) in longer.iter_mut().skip(1).zip(&denominator) {
                    *c += own;
                }
                denominator = longer;
            }
        }
        Some(Opening::Loop(Box::new(ExploreInput {
            plant: TransferFunction::new(&[gain], &denominator, delay),
            relay,
            noise: None,
        })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::{Limits, Parameter, Status};

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
            effects: vec![],
            parameters: vec![
                parameter(None, "K", 2.0),
                parameter(None, "T", 30.0),
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
            text: String::new(),
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
