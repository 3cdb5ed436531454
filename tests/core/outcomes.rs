//! What becomes of a loop: one word for it, and a sentence that holds.

use hysteron_core::limit_cycle::{LongRunResult, Outcome, Prediction, predict};
use hysteron_core::scenario::Scenario;

/// Outcome of a loop in a file.
fn outcome(text: &str) -> (Prediction, LongRunResult) {
    let scenario = Scenario::from_toml(text).unwrap();
    let prediction = predict(&scenario.plant, &scenario.relay).unwrap();
    let result = scenario.long_run(&prediction).unwrap();
    (prediction, result)
}

#[test]
fn scratch() {
    for file in [
        "a20_sliding_CB2",
        "fig-4-noise",
        "h03_condstable",
        "h05_zerogain",
        "h07_undamped",
        "h10_unst_L070",
        "h20_cook",
        "h21_dintegr",
        "h22_dintegr_h",
        "noise1",
    ] {
        let text = std::fs::read_to_string(format!("/work/shared/theory/{file}.toml")).unwrap();
        let t = std::time::Instant::now();
        let (p, r) = outcome(&text);
        eprintln!(
            "{file}: {:?} {:?} {:?}\n   {}\n {:?}",
            r.outcome,
            r.cycle,
            t.elapsed(),
            r.text,
            p.exact
                .iter()
                .map(|c| (c.cycle, c.multiplier))
                .take(3)
                .collect::<Vec<_>>()
        );
    }
}
