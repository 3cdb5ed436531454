//! The least, the largest and the middle of some values, those that are not marked, and on which side of 0 one lies.

/// 1 above 0, -1 below, and 0 for 0 itself.
pub fn sign(value: f64) -> f64 {
    f64::from(i8::from(value > 0.0) - i8::from(value < 0.0))
}

/// Least and largest value; without values infinity and minus infinity.
pub fn range(values: &[f64]) -> (f64, f64) {
    let wider = |(low, high): (f64, f64), v: &f64| (low.min(*v), high.max(*v));
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), wider)
}

/// Values in order, each once.
pub fn distinct(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_unstable_by(f64::total_cmp);
    values.dedup();
    values
}

/// Takes out the values that are marked.
pub fn drop_marked<T>(values: &mut Vec<T>, marked: &[bool]) {
    let mut marks = marked.iter();
    values.retain(|_| !marks.next().copied().unwrap_or(false));
}

/// Median of the absolute value of a standard normal variable.
pub const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;

/// Median; the order of the values is lost. 0 without values.
pub fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which this share of the values lies; their order is lost. 0 without values.
pub fn quantile(values: &mut [f64], share: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else {
        return 0.0;
    };
    let place = ((values.len() as f64 * share) as usize).min(last);
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}
