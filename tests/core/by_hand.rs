//! Values set by hand: the fit stays what it was, another value leaves more, and the states settle to it.

use crate::support::diagnosis::step;
use hysteron_core::by_hand::ByHand;
use hysteron_core::criticism::StepJob;
use hysteron_core::diagnosis::StepReport;
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::user_model::UserModel;

fn fitted(name: &str, effects: &[&str]) -> (Measurement, StepReport) {
    let path = format!("{}/../tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let bytes = std::fs::read(path).expect("a file of the tests");
    let measurement = import_csv(name, &bytes, None).expect("a measurement");
    let effects: Vec<EffectId> = effects
        .iter()
        .map(|id| {
            hysteron_core::effect::registry()
                .iter()
                .map(|e| e.id())
                .find(|e| e.as_str() == *id)
        })
        .map(|id| id.expect("an effect"))
        .collect();
    let model = UserModel::blank(measurement.kind);
    let report = step(StepJob::with_model(&measurement, &effects, &model).expect("a job"));
    (measurement, report)
}

fn values(report: &StepReport) -> Vec<f64> {
    report.step.parameters.iter().map(|p| p.value).collect()
}

#[test]
fn with_the_fitted_values_it_says_what_the_fit_says() {
    for (name, effects) in [
        ("drive-02", &["coulomb_friction"][..]),
        ("drive-01", &[]),
        ("drive-12", &["coulomb_friction", "input_delay"]),
        ("process-02", &["input_delay"]),
    ] {
        let (measurement, report) = fitted(name, effects);
        let hand = ByHand::new(&measurement, &report, (0, measurement.len())).expect(name);
        let replay = hand.replay(&values(&report));
        assert!(
            (replay.error / report.step.error - 1.0).abs() < 0.1,
            "{name}: {} for {}",
            replay.error,
            report.step.error
        );
        assert_eq!(replay.modelled[0].len(), measurement.len());
    }
}

#[test]
fn another_value_leaves_more_and_the_states_settle_to_it() {
    let (measurement, report) = fitted("drive-02", &["coulomb_friction"]);
    let hand = ByHand::new(&measurement, &report, (0, measurement.len())).expect("values to set");
    let place = report.step.parameters.iter().position(|p| p.name == "c");
    let place = place.expect("a friction level");
    let error = |share: f64, settled: bool| {
        let mut values = values(&report);
        values[place] *= share;
        if settled {
            hand.settled(&values).error
        } else {
            hand.replay(&values).error
        }
    };
    let mut before = error(1.0, false);
    for share in [0.9, 0.7, 0.4, 0.1] {
        let now = error(share, false);
        assert!(now > before, "{share}: {now} after {before}");
        let settled = error(share, true);
        assert!(
            settled < now && settled > report.step.error,
            "{share}: {settled} of {now}"
        );
        before = now;
    }
}

#[test]
fn a_part_of_the_record_is_replayed_as_in_the_whole() {
    let (measurement, report) = fitted("drive-02", &["coulomb_friction"]);
    let (from, to) = ByHand::windows_about(&report, (4000, 4300), 2000);
    assert!(
        from <= 4000 && to >= 4300 && to - from <= 2000,
        "{from} to {to}"
    );
    let values = values(&report);
    let whole = ByHand::new(&measurement, &report, (0, measurement.len())).expect("values to set");
    let part = ByHand::new(&measurement, &report, (from, to)).expect("values to set");
    let (whole, part) = (whole.replay(&values), part.replay(&values));
    for ((whole, part), channel) in whole
        .modelled
        .iter()
        .zip(&part.modelled)
        .zip(&report.replay.channels)
    {
        assert_eq!(part.len(), to - from);
        let same = whole[from..to].iter().zip(part);
        let squares = same.map(|(a, b)| (a - b).powi(2));
        let most = (squares.sum::<f64>() / part.len() as f64).sqrt();
        // In its first window the contact of the friction is known from the part alone: less than the noise shows.
        assert!(most < channel.noise, "{most} of {}", channel.noise);
    }
}
