//! The normal equations of a fit: derivatives, sums over windows, and their solution within bounds.

use nalgebra::{DMatrix, DVector, Vector4};

use super::{Fit, farthest};
use crate::criticism::cost::{informed_windows, window_weights};
use crate::criticism::data::Data;
use crate::criticism::motion::Motion;
use crate::criticism::window_sums::{
    BODY_STATES, STATES, WindowSums, changed, inverse, kept_within, reduced, state,
};
use crate::effect::{Effect, Scales};
use crate::model::Start;

/// Step for differences with respect to where a load is, in its standard deviations.
const LOAD_DIFFERENCE: f64 = 0.1;

/// Size of a parameter in its standard errors from which data tell it.
const MARKED: f64 = 3.0;

impl Fit {
    /// The most by which a step may lower the squared residuals, as far as they are linear: twice the
    /// gradient along it.
    pub(super) fn hoped_fall(
        &self,
        data: &Data,
        gradient: &DVector<f64>,
        windows: &[WindowSums],
        values: &[f64],
        starts: &[Start],
    ) -> f64 {
        let moved = values.iter().zip(&self.values).map(|(to, from)| to - from);
        let shared: f64 = gradient.iter().zip(moved).map(|(g, d)| g * d).sum();
        let own: f64 = windows
            .iter()
            .zip(informed_windows(data))
            .zip(starts.iter().zip(&self.starts))
            .filter(|((_, informed), _)| *informed)
            .map(|((sums, _), (to, from))| sums.gradient.dot(&(state(to) - state(from))))
            .sum();
        2.0 * (shared + own)
    }

    /// Derivatives of the motion: one column per value, then position and velocity of the starts, then those of a
    /// load that may be off.
    pub(super) fn columns(&self, data: &Data, steps: &[f64], scales: &Scales) -> Vec<Motion> {
        let spans = data.spans();
        let difference = |moved: Motion, step: f64| difference(moved, &self.motion, step, &spans);
        let fixed = self.structure.fixed();
        let by_value = |j: usize| {
            if j >= self.held || fixed[j] {
                return Motion::still(data.len());
            }
            let mut values = self.values.clone();
            values[j] += steps[j];
            difference(self.simulate(data, &values, &self.starts), steps[j])
        };
        let model = self.structure.model(&self.values);
        let dx = 1e-6 * scales.travel.max(f64::MIN_POSITIVE);
        let dv = 1e-6 * scales.speed.max(f64::MIN_POSITIVE);
        let by_state = |k: usize| {
            if k == 0 && !data.has_position && !data.excitation.doubts_store_of(&model) {
                return Motion::still(data.len());
            }
            if k == 0 && data.has_position && model.is_same_everywhere() {
                return super::shifted(data);
            }
            let step = [dx, dv, LOAD_DIFFERENCE, LOAD_DIFFERENCE][k];
            let change = Vector4::ith(k, step);
            let starts: Vec<Start> = self.starts.iter().map(|s| changed(s, &change)).collect();
            difference(self.simulate(data, &self.values, &starts), step)
        };
        let states = if data
            .excitation
            .doubts_load_of(&model, self.structure.load_begin)
        {
            STATES
        } else {
            BODY_STATES
        };
        let values = steps.len();
        data.crew.gather(values + states, |j| {
            j.checked_sub(values).map_or_else(|| by_value(j), by_state)
        })
    }

    pub(super) fn normal_equations(
        &self,
        data: &Data,
        columns: &[Motion],
        p: usize,
        scale: f64,
    ) -> (DMatrix<f64>, DVector<f64>, Vec<WindowSums>) {
        // The columns after those of the values are those of the starts.
        let has_load = columns.len() == p + STATES;
        let mut matrix = DMatrix::zeros(p, p);
        let mut gradient = DVector::zeros(p);
        let mut windows: Vec<WindowSums> =
            data.windows.iter().map(|_| WindowSums::new(p)).collect();
        let informed = informed_windows(data);
        let robust = window_weights(data, &self.motion, scale);
        let mut row = vec![0.0; p];
        for block in &data.blocks {
            // A held-back block in a window that is also fitted informs nothing.
            if block.held_back && informed[block.window] {
                continue;
            }
            let sums = &mut windows[block.window];
            for output in &data.outputs {
                let weight = robust[block.window].sqrt() / output.noise;
                let parts: Vec<&[f64]> = columns
                    .iter()
                    .map(|c| c.compared(output.is_velocity))
                    .collect();
                for i in (block.from..block.to).filter(|i| output.tells(*i)) {
                    let r = self.motion.left(output, i) * weight;
                    for (value, part) in row.iter_mut().zip(&parts) {
                        *value = part[i] * weight;
                    }
                    let state = |k: usize| parts[p + k][i] * weight;
                    if has_load {
                        sums.add([state(0), state(1), state(2), state(3)], &row, r);
                    } else {
                        sums.add([state(0), state(1)], &row, r);
                    }
                    if !block.held_back {
                        for a in 0..p {
                            gradient[a] += row[a] * r;
                            for b in 0..=a {
                                matrix[(a, b)] += row[a] * row[b];
                            }
                        }
                    }
                }
            }
        }
        for a in 0..p {
            for b in 0..a {
                matrix[(b, a)] = matrix[(a, b)];
            }
        }
        if has_load {
            for ((sums, start), weight) in windows.iter_mut().zip(&self.starts).zip(&robust) {
                for (k, deviation) in start.load.iter().enumerate() {
                    let k = BODY_STATES + k;
                    sums.state[(k, k)] += weight;
                    sums.gradient[k] -= weight * deviation;
                }
            }
        }
        (matrix, gradient, windows)
    }

    /// Values and starts after a damped step; `None` where the equations cannot be solved.
    pub(super) fn step(
        &self,
        data: &Data,
        matrix: &DMatrix<f64>,
        gradient: &DVector<f64>,
        windows: &[WindowSums],
        scales: &Scales,
    ) -> Option<(Vec<f64>, Vec<Start>)> {
        let p = self.values.len();
        let (mut schur, reduced_gradient) = reduced(matrix, gradient, windows, data, p);
        for j in 0..p {
            let d = schur[(j, j)];
            schur[(j, j)] = d + self.damping * d.max(1e-12 * matrix[(j, j)]) + f64::MIN_POSITIVE;
        }
        let moved = self.bounded_step(&schur, &reduced_gradient, scales)?;
        let values: Vec<f64> = self.values.iter().zip(&moved).map(|(v, d)| v + d).collect();
        let farthest = farthest(self.sees_load(data));
        let starts = self
            .starts
            .iter()
            .zip(windows)
            .map(|(start, sums)| {
                let mut g = sums.gradient;
                for (mixed, d) in sums.mixed.iter().zip(&moved) {
                    g -= mixed * *d;
                }
                kept_within(changed(start, &(inverse(&sums.state) * g)), farthest)
            })
            .collect();
        Some((values, starts))
    }

    /// Solves for the step; values that would leave their range stop at its end and the others are
    /// solved again, so that a value at its end does not hold back the rest.
    pub(super) fn bounded_step(
        &self,
        matrix: &DMatrix<f64>,
        gradient: &DVector<f64>,
        scales: &Scales,
    ) -> Option<Vec<f64>> {
        let p = self.values.len();
        let known = self.structure.fixed();
        let mut fixed: Vec<Option<f64>> = known.iter().map(|f| f.then_some(0.0)).collect();
        loop {
            let free: Vec<usize> = (0..p).filter(|j| fixed[*j].is_none()).collect();
            let part = DMatrix::from_fn(free.len(), free.len(), |a, b| matrix[(free[a], free[b])]);
            let right = DVector::from_fn(free.len(), |a, _| {
                let known: f64 = (0..p)
                    .map(|j| fixed[j].map_or(0.0, |d| matrix[(free[a], j)] * d))
                    .sum();
                gradient[free[a]] - known
            });
            let solution = part.cholesky()?.solve(&right);
            let mut step: Vec<f64> = fixed.iter().map(|d| d.unwrap_or(0.0)).collect();
            for (a, j) in free.iter().enumerate() {
                step[*j] = solution[a];
            }
            let mut values: Vec<f64> = self.values.iter().zip(&step).map(|(v, d)| v + d).collect();
            if values.iter().any(|v| !v.is_finite()) {
                return None;
            }
            let wanted = values.clone();
            self.structure.limit_step(&mut values, &self.values);
            self.structure.clamp(&mut values, scales);
            let out: Vec<usize> = free
                .into_iter()
                .filter(|j| values[*j] != wanted[*j])
                .collect();
            if out.is_empty() {
                return Some(step);
            }
            for j in out {
                fixed[j] = Some(values[j] - self.values[j]);
            }
        }
    }

    /// Whether what makes an effect in the model what it is could be seen beside the noise, and within the way of the
    /// record. `inflation` is that of the variance of the values.
    pub fn shows_marks_of(&self, effect: &dyn Effect, scales: &Scales, inflation: f64) -> bool {
        let marks = effect.marks();
        let mut effects = self.structure.effects.iter();
        let Some(place) = effects.position(|e| e.id() == effect.id()) else {
            return true;
        };
        let errors = self.standard_errors(inflation);
        let mut values = self.structure.range(place).zip(effect.parameters());
        values.all(|(j, p)| {
            let stands_out = self.values[j] > MARKED * errors[j];
            (stands_out || !marks.contains(&p.symbol)) && !p.is_too_long(self.values[j], scales)
        })
    }

    /// Standard errors of the values: noise as found, with `inflation` of the variance; 0 for fixed ones.
    pub fn standard_errors(&self, inflation: f64) -> Vec<f64> {
        let p = self.values.len();
        let mut information = self.information.clone();
        // The tolerance of a prior is as the user says: it does not grow with the residuals.
        for (j, _, tolerance) in self.structure.priors() {
            information[(j, j)] += (inflation - 1.0) / (tolerance * tolerance);
        }
        let fixed = self.structure.fixed();
        let free: Vec<usize> = (0..p).filter(|j| !fixed[*j]).collect();
        let d: Vec<f64> = free
            .iter()
            .map(|j| information[(*j, *j)].max(f64::MIN_POSITIVE).sqrt())
            .collect();
        let mut scaled = DMatrix::from_fn(free.len(), free.len(), |a, b| {
            information[(free[a], free[b])] / (d[a] * d[b])
        });
        for j in 0..free.len() {
            scaled[(j, j)] += 1e-12;
        }
        let mut errors = vec![0.0; p];
        let inverse = scaled.cholesky().map(|c| c.inverse());
        for (a, j) in free.into_iter().enumerate() {
            errors[j] = inverse
                .as_ref()
                .map_or(f64::INFINITY, |i| (i[(a, a)] * inflation).sqrt() / d[a]);
        }
        errors
    }
}

/// Difference quotient in place of `moved`, where there are data.
fn difference(mut moved: Motion, base: &Motion, step: f64, spans: &[(usize, usize)]) -> Motion {
    let pairs = [
        (&mut moved.position, &base.position),
        (&mut moved.velocity, &base.velocity),
        (&mut moved.news, &base.news),
    ];
    for (moved, base) in pairs.into_iter().filter(|(moved, _)| !moved.is_empty()) {
        for (from, to) in spans {
            for (value, base) in moved[*from..*to].iter_mut().zip(&base[*from..*to]) {
                *value = (*value - base) / step;
            }
        }
    }
    moved
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::*;
    use crate::criticism::session::Session;
    use crate::criticism::structure::Structure;
    use crate::measurement::import_csv;
    use crate::user_model::UserModel;

    /// Body of the drive, kg m^2 and N m s/rad, its torque, N m, and the time between samples, s.
    const BODY: [f64; 2] = [9e-4, 2e-2];
    const TORQUE: f64 = 0.3;
    const STEP: f64 = 1e-3;

    /// Sample from which the torque is the other way round.
    const TURN: i32 = 200;

    /// `dv/dJ` and `dv/dd` of `v = u/d (1 - exp(-d t/J))`, in the time `t` from rest under a constant torque.
    fn exact([inertia, damping]: [f64; 2], t: f64) -> [f64; 2] {
        let fading = libm::exp(-damping * t / inertia);
        let by_inertia = -TORQUE * t / (inertia * inertia) * fading;
        let by_damping = TORQUE / damping * (t / inertia * fading - (1.0 - fading) / damping);
        [by_inertia, by_damping]
    }

    #[test]
    fn sensitivities_are_those_of_the_closed_form_to_five_digits() {
        let mut csv = "t [s],u [N m],v1 [rad/s]\n".to_owned();
        let [inertia, damping] = BODY;
        let mut v = 0.0;
        for i in 0..400 {
            let torque = if i < TURN { TORQUE } else { -TORQUE };
            // A little noise, or there would be no scale.
            let noise = 1e-4 * f64::from(i * 7919 % 13 - 6);
            writeln!(csv, "{},{torque},{}", STEP * f64::from(i), v + noise).unwrap();
            let rest = torque / damping;
            v = rest + (v - rest) * libm::exp(-damping * STEP / inertia);
        }
        let measurement = import_csv("step", csv.as_bytes(), None).unwrap();
        let (session, _) =
            Session::screened(&measurement, &UserModel::blank(measurement.kind)).unwrap();
        let (data, scales) = (&session.data, &session.scales);
        let structure = Structure::new(data.baseline, Vec::new(), session.knowledge.clone());
        let starts = data.guessed_starts();
        let fit = Fit::new(data, structure, BODY.to_vec(), starts, scales);
        let steps = fit.structure.difference_steps(&fit.values, scales);
        let columns = fit.columns(data, &steps, scales);
        let spans = data.spans();
        let driven = spans.iter().filter(|span| span.1 <= TURN as usize);
        assert!(driven.clone().count() >= 5, "{spans:?}");
        for ((from, to), start) in driven.zip(&fit.starts) {
            for i in from + 1..*to {
                let t = STEP * (i - from) as f64;
                // What it had at first fades as it would by itself.
                let left = start.velocity * libm::exp(-damping * t / inertia) * t / inertia;
                let own = [left * damping / inertia, -left];
                for (k, (driven, own)) in exact(BODY, t).into_iter().zip(own).enumerate() {
                    let (exact, found) = (driven + own, columns[k].velocity[i]);
                    let size = driven.abs().max(own.abs());
                    assert!(
                        (found - exact).abs() < 1e-5 * size,
                        "{k}, {i}: {found}, {exact}"
                    );
                }
            }
        }
    }
}
