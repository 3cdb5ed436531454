//! What residual an effect would leave if it were what is missing, beside the one that is left.

use super::atlas::Places;
use super::fit::residuals;
use super::session::{Scored, Session};
use crate::diagnosis::{Finding, Fingerprint};
use crate::effect::EffectId;

/// Effects whose fingerprints are taken, the best first.
const MOST: usize = 8;

/// Samples of the stretch that is shown.
const SHOWN: usize = 600;

/// Fingerprints of the effects that were tried on top of `model`, the best first; the stretch is that of the
/// strongest finding.
pub(super) fn fingerprints(
    session: &Session,
    model: &Scored,
    tried: &[(EffectId, &Scored)],
    findings: &[Finding],
) -> Vec<Fingerprint> {
    let data = &session.data;
    let motion = &model.fit.motion;
    let left = residuals(data, motion);
    let runs = data.runs();
    let begin = findings
        .iter()
        .find_map(|f| f.spans.first())
        .map_or(0.0, |span| span.0);
    let sample = data.time.partition_point(|t| *t < begin);
    // Of a long record only some windows are fitted: the stretch is in the nearest one from there on.
    let (from, to) = runs
        .iter()
        .copied()
        .find(|(_, end)| *end > sample)
        .unwrap_or((0, data.len()));
    let from = from.max(sample.min(to.saturating_sub(SHOWN.min(to - from))));
    let to = to.min(from + SHOWN);
    let places = Places::new(data, motion, session.output_unit());
    let mut best: Vec<&(EffectId, &Scored)> = tried.iter().collect();
    best.sort_by(|a, b| a.1.score.error.total_cmp(&b.1.score.error));
    best.into_iter()
        .take(MOST)
        .map(|(effect, scored)| {
            let changes: Vec<Vec<f64>> = data
                .outputs
                .iter()
                .map(|o| {
                    let with = scored.fit.motion.of(o.is_velocity);
                    let pairs = with.iter().zip(motion.of(o.is_velocity));
                    pairs.map(|(with, without)| with - without).collect()
                })
                .collect();
            let scaled: Vec<Vec<f64>> = changes
                .iter()
                .zip(&data.outputs)
                .map(|(change, o)| change.iter().map(|v| v / o.noise).collect())
                .collect();
            let sum = |a: &[Vec<f64>], b: &[Vec<f64>]| -> f64 {
                let channels = a.iter().zip(b);
                let over = |(a, b): (&Vec<f64>, &Vec<f64>)| -> f64 {
                    let used = runs.iter().flat_map(|(from, to)| *from..*to);
                    used.map(|i| a[i] * b[i]).sum()
                };
                channels.map(over).sum()
            };
            let size = (sum(&left, &left) * sum(&scaled, &scaled)).sqrt();
            Fingerprint {
                effect: *effect,
                likeness: if size > 0.0 {
                    sum(&left, &scaled) / size
                } else {
                    0.0
                },
                from,
                would_leave: changes.iter().map(|c| c[from..to].to_vec()).collect(),
                profiles: places.profiles(&scaled),
            }
        })
        .collect()
}
