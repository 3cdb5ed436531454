//! What a report shows of a fit: its effects, parameters and curves, where it fails, and the noise beside.

use super::atlas::atlas;
use super::fit::Fit;
use super::locate::locate;
use super::output::Output;
use super::session::{Scored, Session};
use crate::diagnosis::{ChannelNoise, Finding, Parameter, Profile, Replay, ReplayChannel};
use crate::effect::{EffectId, baseline};
use crate::measurement::Quantity;
use crate::user_model::Status;

/// Standard error, in times of what a value may be, at which the record tells nothing of it: no larger one is given.
const UNTOLD: f64 = 1e3;

impl Session {
    /// Effects of a fit, those of the baseline first.
    pub fn effects(&self, fit: &Fit) -> Vec<EffectId> {
        baseline::effects(self.kind())
            .iter()
            .copied()
            .chain(fit.structure.effects.iter().map(|e| e.id()))
            .collect()
    }

    /// Every parameter with its standard error, which is no less than these `spreads` of the values.
    pub fn parameters(&self, scored: &Scored, spreads: &[f64]) -> Vec<Parameter> {
        let fit = &scored.fit;
        let mut errors = scored.standard_errors();
        for (error, spread) in errors.iter_mut().zip(spreads) {
            *error = error.max(*spread);
        }
        let known = fit.structure.known();
        let status = |j: usize| known[j].map_or(Status::Free, |k| k.status);
        // One that the record itself holds is known as well as where the output rests at first.
        let held = fit.structure.held().map(|(place, _)| place);
        let rest = self.data.outputs.first().map_or(0.0, |o| o.noise);
        let mut parameters: Vec<Parameter> = fit
            .structure
            .baseline
            .parameters()
            .iter()
            .enumerate()
            .map(|(j, p)| Parameter {
                effect: p.effect,
                name: p.symbol.to_owned(),
                label: p.label.to_owned(),
                value: fit.values[j],
                std_error: if held == Some(j) {
                    rest
                } else {
                    errors[j].min(p.dimension.map_or(f64::INFINITY, |dimension| {
                        UNTOLD * fit.values[j].abs().max(self.scales.of(dimension))
                    }))
                },
                status: status(j),
                unit: self.unit_of(p.dimension),
            })
            .collect();
        for (index, effect) in fit.structure.effects.iter().enumerate() {
            let range = fit.structure.range(index);
            let least = self.gap.map_or_else(Vec::new, |gap| {
                effect.least_errors(&fit.values[range.clone()], &gap)
            });
            let mut least = least.into_iter();
            for (j, spec) in range.zip(effect.parameters()) {
                let least = least.next().filter(|_| status(j) == Status::Free);
                let size = fit.values[j].abs().max(self.scales.of(spec.dimension));
                parameters.push(Parameter {
                    effect: Some(effect.id()),
                    name: spec.symbol.to_owned(),
                    label: spec.label.to_owned(),
                    value: fit.values[j],
                    std_error: errors[j].max(least.unwrap_or(0.0)).min(UNTOLD * size),
                    status: status(j),
                    unit: self.unit_of(Some(spec.dimension)),
                });
            }
        }
        parameters
    }

    /// Where a fit of the whole record fails.
    pub fn findings(&self, scored: &Scored) -> Vec<Finding> {
        locate(self.whole(), &scored.fit.motion, self.output_unit())
    }

    /// The residual over every axis.
    pub fn atlas(&self, fit: &Fit) -> Vec<Profile> {
        atlas(self.whole(), &fit.motion, self.output_unit())
    }

    /// The noise of each measured channel.
    pub fn channel_noise(&self) -> Vec<ChannelNoise> {
        let outputs = self.outputs.iter().zip(&self.whole().outputs);
        let noise = |((quantity, name, unit), output): (&(Quantity, String, String), &Output)| {
            ChannelNoise {
                channel: name.clone(),
                quantity: *quantity,
                value: output.noise,
                unit: unit.clone(),
                step: Some(output.step).filter(|step| *step > 0.0),
            }
        };
        outputs.map(noise).collect()
    }

    /// Curves for the plots.
    pub fn replay(&self, fit: &Fit) -> Replay {
        Replay {
            channels: self
                .outputs
                .iter()
                .zip(&self.whole().outputs)
                .map(|((quantity, name, unit), output)| ReplayChannel {
                    quantity: *quantity,
                    name: name.clone(),
                    unit: unit.clone(),
                    noise: output.noise,
                    modelled: fit.motion.of(output.is_velocity).to_vec(),
                })
                .collect(),
            window_starts: self.whole().windows.clone(),
        }
    }
}
