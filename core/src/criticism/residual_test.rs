//! Is what is left white, and does it still follow the input? The two classical tests of a residual.
//!
//! L. Ljung, System Identification: Theory for the User, 2nd edition, 1999, section 16.6: for a true model the
//! autocorrelation of `N` residuals has a standard deviation of `1 / sqrt(N)`, their correlation with the input
//! one of `sqrt(sum_k rho_e(k) rho_u(k) / N)`.

use super::axes::seconds;
use super::correlation::product;
use super::data::Data;
use super::fit::residuals;
use super::locate::signal_name;
use super::motion::Motion;
use crate::diagnosis::{ResidualTest, ResidualTestKind};
use crate::message::{Message, fixed};
use crate::msg;
use crate::sums::centred;

/// Lags up to which a residual is compared with itself, and with the input, in samples.
const LAGS: usize = 20;

/// Lags over which the correlations of residual and input with themselves widen the bound, in samples.
const MEMORY: usize = 200;

/// Normal quantile that none of [`LAGS`] independent values exceeds in 99 of 100 cases (Bonferroni).
const QUANTILE: f64 = 3.48;

/// Both tests of every output.
pub(super) fn residual_tests(data: &Data, motion: &Motion) -> Vec<ResidualTest> {
    let runs = data.runs();
    let step = data.excitation.mean_step();
    let outputs = data.outputs.iter().zip(residuals(data, motion)).enumerate();
    outputs
        .flat_map(|(output, (channel, residual))| {
            let (input, _) = channel.told(&data.input, &runs);
            let (residual, runs) = channel.told(&residual, &runs);
            let step = step * data.len() as f64 / residual.len() as f64;
            let input = Series::new(&input, &runs);
            let residual = Series::new(&residual, &runs);
            let test = |kind, (lag, correlation, bound): (usize, f64, f64)| {
                let lag = lag as f64 * step;
                let passed = correlation.abs() <= bound;
                ResidualTest {
                    kind,
                    output,
                    correlation,
                    lag,
                    bound,
                    passed,
                    text: sentence(
                        kind,
                        signal_name(data.kind, channel),
                        correlation,
                        lag,
                        bound,
                    ),
                }
            };
            let white = whiteness(&residual, &runs).map(|t| test(ResidualTestKind::Whiteness, t));
            let follows = input_correlation(&residual, &input, &runs)
                .map(|t| test(ResidualTestKind::InputCorrelation, t));
            [white, follows].into_iter().flatten()
        })
        .collect()
}

fn sentence(
    kind: ResidualTestKind,
    name: &'static str,
    correlation: f64,
    lag: f64,
    bound: f64,
) -> Message {
    let lag = seconds(lag);
    let passed = correlation.abs() <= bound;
    let share = share(correlation);
    match (kind, passed) {
        (ResidualTestKind::Whiteness, true) => msg!(
            "The residual of the {} is white: no correlation beyond the {} that chance allows.",
            name,
            fixed(bound, 3)
        ),
        (ResidualTestKind::Whiteness, false) => msg!(
            "The residual of the {} is not white: at a lag of {} its correlation is {} ({} of its square); chance \
             allows {}.",
            name,
            lag,
            fixed(correlation, 3),
            share,
            fixed(bound, 3)
        ),
        (ResidualTestKind::InputCorrelation, true) => msg!(
            "The residual of the {} does not follow the input: no correlation beyond the {} that chance allows.",
            name,
            fixed(bound, 3)
        ),
        (ResidualTestKind::InputCorrelation, false) => msg!(
            "The residual of the {} still follows the input: {} later their correlation is {} ({} of its square); \
             chance allows {}.",
            name,
            lag,
            fixed(correlation, 3),
            share,
            fixed(bound, 3)
        ),
    }
}

/// Share of the squared residual that a correlation explains: many samples show one that is far too small to matter.
fn share(correlation: f64) -> String {
    let percent = 100.0 * correlation * correlation;
    let decimals = usize::from(percent < 9.95);
    format!("{percent:.decimals$} %")
}

fn count(runs: &[(usize, usize)]) -> f64 {
    runs.iter().map(|(from, to)| to - from).sum::<usize>() as f64
}

/// A series with what it remembers of itself.
struct Series {
    values: Vec<f64>,
    /// Sum of squares.
    power: f64,
    /// Correlation with itself, 1 to [`MEMORY`] samples later.
    memory: Vec<f64>,
}

impl Series {
    fn new(values: &[f64], runs: &[(usize, usize)]) -> Self {
        let values = centred(values, runs);
        let power = product(&values, &values, runs, 0);
        let memory = (1..=MEMORY).map(|lag| product(&values, &values, runs, lag) / power);
        Self {
            power,
            memory: memory.collect(),
            values,
        }
    }
}

/// Lag, correlation and bound where a residual correlates most with itself.
fn whiteness(residual: &Series, runs: &[(usize, usize)]) -> Option<(usize, f64, f64)> {
    let bound = QUANTILE / count(runs).sqrt();
    strongest(
        (1..=LAGS)
            .zip(&residual.memory)
            .map(|(lag, c)| (lag, *c, bound)),
    )
}

/// Lag, correlation and bound where a residual follows the input most.
fn input_correlation(
    residual: &Series,
    input: &Series,
    runs: &[(usize, usize)],
) -> Option<(usize, f64, f64)> {
    // Both may remember what they were: fewer of the products are then independent.
    let both = residual.memory.iter().zip(&input.memory);
    let widened: f64 = both.map(|(r, u)| r * u).sum();
    let bound = QUANTILE * ((1.0 + 2.0 * widened.max(0.0)) / count(runs)).sqrt();
    let norm = (residual.power * input.power).sqrt();
    let correlation = |lag| product(&input.values, &residual.values, runs, lag) / norm;
    strongest((0..=LAGS).map(|lag| (lag, correlation(lag), bound)))
}

/// The largest correlation; none where they are no numbers, as of a signal that stands still.
fn strongest(all: impl Iterator<Item = (usize, f64, f64)>) -> Option<(usize, f64, f64)> {
    all.filter(|(_, c, b)| c.is_finite() && b.is_finite())
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Random;

    /// Even noise without pattern.
    fn noise(n: usize, seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed);
        (0..n).map(|_| random.between(-0.5, 0.5)).collect()
    }

    #[test]
    fn noise_passes_as_often_as_the_bound_says() {
        let runs = [(0, 4000)];
        let input: Vec<f64> = (0..4000)
            .map(|i| if i / 40 % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let input = Series::new(&input, &runs);
        let (mut white, mut follows) = (0, 0);
        for seed in 0..300 {
            let residual = Series::new(&noise(4000, seed), &runs);
            let failed = |t: Option<(usize, f64, f64)>| t.is_some_and(|(_, c, b)| c.abs() > b);
            white += usize::from(failed(whiteness(&residual, &runs)));
            follows += usize::from(failed(input_correlation(&residual, &input, &runs)));
        }
        // One in a hundred; eleven of 300 would come by chance once in ten thousand times.
        assert!(white <= 10 && follows <= 10, "{white} {follows}");
    }

    #[test]
    fn a_correlation_that_fails_says_how_much_of_the_residual_it_is() {
        let text = |c| sentence(ResidualTestKind::Whiteness, "velocity", c, 4e-4, 0.035);
        assert!(
            text(0.06)
                .to_string()
                .contains("is 0.060 (0.4 % of its square);")
        );
        assert!(
            text(-0.709)
                .to_string()
                .contains("is -0.709 (50 % of its square);")
        );
        assert!(text(0.03).to_string().contains(" is white"));
    }

    #[test]
    fn a_residual_that_remembers_or_follows_is_told() {
        let runs = [(0, 2000), (2200, 4000)];
        let fresh = noise(4000, 3);
        let mut residual = fresh.clone();
        for i in 1..4000 {
            residual[i] = 0.3 * residual[i - 1] + fresh[i];
        }
        let (lag, correlation, bound) = whiteness(&Series::new(&residual, &runs), &runs).unwrap();
        assert!(
            lag == 1 && (correlation - 0.3).abs() < bound,
            "{lag} {correlation}"
        );
        let input = noise(4000, 4);
        let residual: Vec<f64> = (0..4000)
            .map(|i| fresh[i] + 0.5 * input[usize::saturating_sub(i, 7)])
            .collect();
        let (residual, input) = (Series::new(&residual, &runs), Series::new(&input, &runs));
        let (lag, correlation, bound) = input_correlation(&residual, &input, &runs).unwrap();
        // 0.5 of the input beside as much noise: 0.5 / sqrt(1.25).
        assert!(
            lag == 7 && (correlation - 0.447).abs() < bound,
            "{lag} {correlation}"
        );
    }
}
