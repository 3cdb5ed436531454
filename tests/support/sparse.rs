//! A record of which a part is kept.

use hysteron_core::measurement::Measurement;

/// The record if only one sample in so many had been written down.
pub fn thinned(mut record: Measurement, every: usize) -> Measurement {
    let kept = |values: &mut Vec<f64>| *values = values.iter().copied().step_by(every).collect();
    kept(&mut record.time);
    kept(&mut record.input.values);
    record.outputs.iter_mut().for_each(|c| kept(&mut c.values));
    record
        .reference
        .iter_mut()
        .for_each(|c| kept(&mut c.values));
    record
}
