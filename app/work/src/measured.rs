//! What a measured relay test tells, and what is drawn of it.

use std::f64::consts::TAU;

use hysteron_core::message::Message;
use hysteron_core::tuning::measured::{
    FittedModel, MeasuredTuning, OpenError, Record, alone, open, steps, tune_readings,
};

use crate::tasks::{MeasuredReport, MeasuredTask, MeasuredTest, News, ReadTest};
use crate::work::{Say, Work, bytes_of, unclear};

/// Most samples that are drawn.
const DRAWN: usize = 4000;

/// Points of a Nyquist curve, and how far it goes about the frequency of the cycle, as a factor either way.
const POINTS: usize = 400;
const FAR: f64 = 30.0;

/// Length of the step responses, in periods of the cycle; where there is none, in times of the model.
const PERIODS: f64 = 8.0;
const TIMES: f64 = 5.0;

impl Work for MeasuredTask {
    fn run(self, say: Say<'_, ReadTest>) {
        say(match self.report() {
            Ok(report) => News::Report(Box::new(report)),
            Err(error) => News::Failed(error),
        });
    }
}

impl MeasuredTask {
    fn report(self) -> Result<ReadTest, Message> {
        let wishes = self.wishes;
        let (tuning, record) = match self.test {
            MeasuredTest::File(task) => {
                let options = task.reading.options()?;
                let bytes = bytes_of(&task.content);
                let opened = match open(&task.file, &bytes, &options) {
                    Ok(opened) => opened,
                    Err(OpenError::Import(error)) => {
                        return unclear(&task.file, &bytes, &error)
                            .map(ReadTest::Unclear)
                            .ok_or_else(|| error.into());
                    }
                    Err(error) => return Err(error.into()),
                };
                let record = opened.record().map(drawn);
                (opened.tune(&wishes).map_err(Message::from)?, record)
            }
            MeasuredTest::Readings(readings) => {
                let settings = wishes.settings(Vec::new());
                let tuning = tune_readings(&readings, &settings).map_err(Message::from)?;
                (tuning, None)
            }
        };
        Ok(ReadTest::Told(Box::new(with_pictures(tuning, record))))
    }
}

fn with_pictures(tuning: MeasuredTuning, record: Option<Record>) -> MeasuredReport {
    let model = tuning.models.first();
    let horizon = model.map_or(0.0, |m| horizon(&tuning, m));
    let middle = tuning
        .point
        .map_or(TAU * PERIODS / horizon.max(f64::MIN_POSITIVE), |p| p.omega);
    let nyquist = model.map_or_else(Vec::new, |m| nyquist(m, middle));
    let loops = tuning.gains.iter();
    let loops = loops.map(|g| steps(model?, g, horizon).ok()).collect();
    let alone = model.and_then(|m| alone(m, horizon).ok());
    MeasuredReport {
        tuning,
        record,
        nyquist,
        loops,
        alone,
    }
}

/// How long the steps are shown, s.
fn horizon(tuning: &MeasuredTuning, model: &FittedModel) -> f64 {
    let lags: f64 = model.time_constants.iter().map(|t| t.value).sum();
    tuning
        .cycle
        .as_ref()
        .map_or(TIMES * (lags + model.dead_time.value), |c| {
            PERIODS * c.period
        })
}

fn nyquist(model: &FittedModel, middle: f64) -> Vec<[f64; 2]> {
    (0..=POINTS)
        .map(|i| middle * FAR.powf(2.0 * i as f64 / POINTS as f64 - 1.0))
        .map(|omega| model.response(omega))
        .collect()
}

/// Some of its samples.
fn drawn(record: &Record) -> Record {
    let stride = record.time.len().div_ceil(DRAWN).max(1);
    let some = |values: &[f64]| values.iter().copied().step_by(stride).collect();
    Record {
        time: some(&record.time),
        input: some(&record.input),
        output: some(&record.output),
        ..record.clone()
    }
}
