//! Curves with fewer points than were measured or computed.

/// The least and the largest of some values.
pub fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let first = (f64::INFINITY, f64::NEG_INFINITY);
    values.fold(first, |(low, high), v| (low.min(v), high.max(v)))
}

/// A curve of at most `most` points: a longer one keeps the least and the largest value of each stretch.
pub fn envelope(time: &[f64], values: &[f64], most: usize) -> Vec<[f64; 2]> {
    if time.len() <= most {
        return time.iter().zip(values).map(|(t, v)| [*t, *v]).collect();
    }
    let stretch = time.len().div_ceil((most / 2).max(1));
    time.chunks(stretch)
        .zip(values.chunks(stretch))
        .flat_map(|(t, v)| {
            let (mut low, mut high) = (0, 0);
            for (i, value) in v.iter().enumerate() {
                if *value < v[low] {
                    low = i;
                }
                if *value > v[high] {
                    high = i;
                }
            }
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
