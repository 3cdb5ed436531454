//! What an effect would leave is told before it is added.

use crate::support::diagnosis::step;
use crate::support::rig::Rig;
use hysteron_core::criticism::StepJob;
use hysteron_core::diagnosis::StepReport;
use hysteron_core::measurement::Measurement;

fn baseline(measurement: &Measurement) -> StepReport {
    step(StepJob::new(measurement, &[]).unwrap())
}

#[test]
fn the_true_effect_looks_like_what_is_left_and_others_less() {
    let record = Rig {
        seed: 41,
        delay: 0.7e-3,
        samples: 4000,
        ..Rig::default()
    }
    .measure();
    let report = baseline(&record);
    let of = |id: &str| {
        let mut prints = report.fingerprints.iter();
        prints.find(|p| p.effect.as_str() == id)
    };
    let delay = of("input_delay").expect("the true effect was tried");
    assert!(delay.likeness > 0.97, "{}", delay.likeness);
    let best = report.fingerprints.first().unwrap();
    assert_eq!(best.effect, delay.effect, "it comes first");
    for other in report
        .fingerprints
        .iter()
        .filter(|p| p.effect != delay.effect)
    {
        assert!(other.likeness < delay.likeness, "{}", other.effect);
    }
    // Over the stretch that is shown, it is what is left but for the noise.
    for (index, would) in delay.would_leave.iter().enumerate() {
        let (output, replay) = (&record.outputs[index], &report.replay.channels[index]);
        let from = delay.from;
        let left = |i: usize| output.values[from + i] - replay.modelled[from + i];
        let rms = |f: &dyn Fn(usize) -> f64| {
            let sum: f64 = (0..would.len()).map(|i| f(i).powi(2)).sum();
            (sum / would.len() as f64).sqrt()
        };
        let rest = rms(&|i| left(i) - would[i]);
        assert!(rest < 1.3 * replay.noise, "{rest} for {}", replay.noise);
        assert!(rms(&left) > 3.0 * rest, "there is something to explain");
    }
    let over_samples = report.atlas.iter().filter(|p| p.axis != "frequency");
    assert_eq!(delay.profiles.len(), over_samples.count());
}
