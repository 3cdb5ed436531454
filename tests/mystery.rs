//! A measured mystery: made by an independent bench, shared without its truth, diagnosed, revealed.

mod support;

use hysteron_core::criticism::{DiagnosisJob, StepReport};
use hysteron_core::measurement::import_csv;
use hysteron_core::mystery::{
    Answer, Choice, Experiment, Mystery, Pick, Request, Reveal, Strength, hideable, make, seal_of,
};
use support::diagnosis::finish;

fn request(experiment: Experiment, choice: Choice) -> Request {
    Request {
        experiment,
        choice,
        word: "blue whale".to_owned(),
        salt: [7; 16],
    }
}

#[test]
#[ignore = "a survey"]
fn survey() {
    for experiment in Experiment::ALL {
        for h in hideable()
            .iter()
            .filter(|h| h.shown_by.contains(&experiment))
        {
            for strength in Strength::ALL {
                let pick = Pick {
                    effect: h.id,
                    value: h.value(strength),
                };
                let begin = std::time::Instant::now();
                let m = make(&request(experiment, Choice::Chosen(vec![pick]))).expect("a mystery");
                let made = begin.elapsed().as_secs_f64();
                let csv = m.csv();
                let measurement = import_csv("m", csv.as_bytes(), None).expect("a measurement");
                let begin = std::time::Instant::now();
                let d = finish(DiagnosisJob::new(&measurement).expect("job"));
                let e: Vec<f64> = d
                    .steps
                    .iter()
                    .map(|s| (s.error * 100.0).round() / 100.0)
                    .collect();
                println!(
                    "{experiment:?} {} {strength:?} made {made:.2} s link {} csv {} | {:?} complete {} unknown {} {e:?} {:.1} s",
                    h.id,
                    m.link().len(),
                    csv.len(),
                    d.verdict
                        .missing
                        .iter()
                        .map(|c| c.iter().map(|e| e.as_str()).collect::<Vec<_>>().join("|"))
                        .collect::<Vec<_>>(),
                    d.verdict.complete,
                    d.verdict.unknown,
                    begin.elapsed().as_secs_f64()
                );
            }
        }
    }
}
