//! Curves with fewer points than were measured or computed, for pictures.

/// The least and the largest of some values.
pub fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let first = (f64::INFINITY, f64::NEG_INFINITY);
    values.fold(first, |(low, high), v| (low.min(v), high.max(v)))
}

/// A curve of at most `most` points: a longer one keeps the least and the largest value of each stretch, and where a
/// stretch has no number, the gap.
pub fn envelope(time: &[f64], values: &[f64], most: usize) -> Vec<[f64; 2]> {
    if time.len() <= most {
        return time.iter().zip(values).map(|(t, v)| [*t, *v]).collect();
    }
    let stretch = time.len().div_ceil((most / 2).max(1));
    time.chunks(stretch)
        .zip(values.chunks(stretch))
        .flat_map(|(t, v)| {
            let numbers = || (0..v.len()).filter(|i| v[*i].is_finite());
            let low = numbers().reduce(|a, b| if v[b] < v[a] { b } else { a });
            let high = numbers().reduce(|a, b| if v[b] > v[a] { b } else { a });
            let (low, high) = (low.unwrap_or(0), high.unwrap_or(0));
            let (first, second) = (low.min(high), low.max(high));
            [[t[first], v[first]], [t[second], v[second]]]
        })
        .collect()
}

/// A curve without the points that lie on the line between others: the dashes of one that is sampled finely would
/// fill its gaps.
pub fn sparse(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let (low, high) = extremes(points.iter().map(|p| p[1]));
    let near = 2e-3 * (high - low);
    let mut kept: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    let mut from = 0;
    for (i, end) in points.iter().enumerate().skip(2) {
        let start = points[from];
        let slope = (end[1] - start[1]) / (end[0] - start[0]);
        let off = |p: &[f64; 2]| (start[1] + slope * (p[0] - start[0]) - p[1]).abs();
        if points[from + 1..i].iter().any(|p| off(p) > near) {
            from = i - 1;
            kept.push(points[from]);
        }
    }
    kept.extend(points.last().copied().filter(|_| points.len() > 1));
    kept
}

/// Corners of a step curve that changes to `[t, value]`, up to its end at `end`.
pub fn corners(changes: &[[f64; 2]], end: f64) -> Vec<[f64; 2]> {
    let mut points = Vec::with_capacity(2 * changes.len() + 1);
    for (i, [t, u]) in changes.iter().enumerate() {
        if let Some([_, before]) = i.checked_sub(1).map(|j| changes[j]) {
            points.push([*t, before]);
        }
        points.push([*t, *u]);
    }
    if let Some([_, u]) = changes.last() {
        points.push([end, *u]);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_envelope_keeps_peaks_and_gaps() {
        let time: Vec<f64> = (0..1000).map(f64::from).collect();
        let mut values = vec![0.0; 1000];
        (values[333], values[334]) = (5.0, -3.0);
        values[600..].fill(f64::NAN);
        values[700] = 1.0;
        let drawn = envelope(&time, &values, 100);
        assert!(drawn.len() <= 100);
        for point in [[333.0, 5.0], [334.0, -3.0], [700.0, 1.0]] {
            assert!(drawn.contains(&point), "{point:?}");
        }
        assert!(drawn.iter().any(|p| p[1].is_nan()));
        assert_eq!(envelope(&time[..3], &[1.0, 2.0, 3.0], 3)[1], [1.0, 2.0]);
    }
}
