//! Minimum of a function of a few variables without derivatives.

/// Reflection, expansion, contraction and shrinking of Nelder and Mead 1965, The Computer Journal 7.
const REFLECT: f64 = 1.0;
const EXPAND: f64 = 2.0;
const CONTRACT: f64 = 0.5;
const SHRINK: f64 = 0.5;

/// Where `function` is least near `start`, and its value there: a simplex with sides `step`, at most
/// `evaluations`, or until all its corners are within `tolerance` of the best in value.
pub(crate) fn minimise<const N: usize>(
    function: impl Fn(&[f64; N]) -> f64,
    start: [f64; N],
    step: f64,
    evaluations: usize,
    tolerance: f64,
) -> ([f64; N], f64) {
    let mut corners = vec![(start, function(&start))];
    for i in 0..N {
        let mut corner = start;
        corner[i] += step;
        corners.push((corner, function(&corner)));
    }
    let mut used = N + 1;
    loop {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        if used >= evaluations || corners[N].1 - corners[0].1 <= tolerance {
            return corners[0];
        }
        let worst = corners[N];
        let centre: [f64; N] =
            std::array::from_fn(|i| corners[..N].iter().map(|c| c.0[i]).sum::<f64>() / N as f64);
        let along = |share: f64| {
            let point: [f64; N] =
                std::array::from_fn(|i| centre[i] + share * (centre[i] - worst.0[i]));
            (point, function(&point))
        };
        let reflected = along(REFLECT);
        used += 1;
        if reflected.1 < corners[0].1 {
            let expanded = along(EXPAND);
            used += 1;
            corners[N] = if expanded.1 < reflected.1 {
                expanded
            } else {
                reflected
            };
            continue;
        }
        if reflected.1 < corners[N - 1].1 {
            corners[N] = reflected;
            continue;
        }
        let contracted = along(if reflected.1 < worst.1 {
            CONTRACT
        } else {
            -CONTRACT
        });
        used += 1;
        if contracted.1 < reflected.1.min(worst.1) {
            corners[N] = contracted;
            continue;
        }
        let best = corners[0].0;
        for corner in &mut corners[1..] {
            corner.0 = std::array::from_fn(|i| best[i] + SHRINK * (corner.0[i] - best[i]));
            corner.1 = function(&corner.0);
        }
        used += N;
    }
}
