//! Roots of polynomials.

use num_complex::Complex;

/// Iterations of the simultaneous method; single roots need about ten, multiple ones more.
const MAX_ITERATIONS: usize = 120;

/// All complex roots of a polynomial, highest power first, first and last coefficient not 0 after
/// zeros at the origin have been taken out, by the simultaneous iteration of Ehrlich (1967) and
/// Aberth (1973). Conjugates are exact pairs; a root of multiplicity m is exact to about the m-th root
/// of round-off, as with every method.
pub(crate) fn roots(coefficients: &[f64]) -> Vec<Complex<f64>> {
    let lead = coefficients.iter().take_while(|c| **c == 0.0).count();
    let p = &coefficients[lead..];
    let trail = p.iter().rev().take_while(|c| **c == 0.0).count();
    let p = &p[..p.len() - trail.min(p.len())];
    let mut found = vec![Complex::new(0.0, 0.0); if p.is_empty() { 0 } else { trail }];
    match p {
        [] | [_] => {}
        [a, b] => found.push(Complex::new(-b / a, 0.0)),
        [a, b, c] => found.extend(quadratic(*a, *b, *c)),
        _ => found.extend(simultaneous(p)),
    }
    found
}

fn quadratic(a: f64, b: f64, c: f64) -> [Complex<f64>; 2] {
    let (half, product) = (-0.5 * b / a, c / a);
    let square = half * half - product;
    if square < 0.0 {
        let im = (-square).sqrt();
        [Complex::new(half, im), Complex::new(half, -im)]
    } else {
        // The root of larger size first: the other one follows without cancellation.
        let large = half + square.sqrt().copysign(half);
        let small = if large == 0.0 { 0.0 } else { product / large };
        [Complex::new(large, 0.0), Complex::new(small, 0.0)]
    }
}

/// Value and derivative, both Horner.
fn evaluate(p: &[f64], z: Complex<f64>) -> (Complex<f64>, Complex<f64>, f64) {
    let (mut value, mut slope) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
    let (mut bound, size) = (0.0, z.norm());
    for c in p {
        slope = slope * z + value;
        value = value * z + *c;
        bound = bound * size + c.abs();
    }
    (value, slope, bound)
}

fn simultaneous(p: &[f64]) -> Vec<Complex<f64>> {
    let n = p.len() - 1;
    // Circle of the geometric mean about the centre of the roots, not symmetric to the real axis.
    let centre = -p[1] / (p[0] * n as f64);
    let radius = evaluate(p, Complex::new(centre, 0.0)).0.norm() / p[0].abs();
    let radius = libm::pow(radius, 1.0 / n as f64)
        .max(1e-3 * libm::pow((p[n] / p[0]).abs(), 1.0 / n as f64));
    let mut z: Vec<Complex<f64>> = (0..n)
        .map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64 + 0.7;
            Complex::new(centre, 0.0) + Complex::from_polar(radius, angle)
        })
        .collect();
    let reversed: Vec<f64> = p.iter().rev().copied().collect();
    for _ in 0..MAX_ITERATIONS {
        let mut moved = false;
        for i in 0..n {
            let Some(newton) = newton_step(p, &reversed, z[i]) else {
                continue;
            };
            let others: Complex<f64> = (0..n)
                .filter(|j| *j != i && z[*j] != z[i])
                .map(|j| (z[i] - z[j]).inv())
                .sum();
            let step = newton / (Complex::new(1.0, 0.0) - newton * others);
            if step.re.is_finite() && step.im.is_finite() {
                z[i] -= step;
                moved |= step.norm() > 4.0 * f64::EPSILON * z[i].norm();
            }
        }
        if !moved {
            break;
        }
    }
    pair(z)
}

/// `p/p'`, or `None` where the value is round-off: the root is found. Large `z` are done from the
/// reversed polynomial, so that nothing overflows.
fn newton_step(p: &[f64], reversed: &[f64], z: Complex<f64>) -> Option<Complex<f64>> {
    if z.norm() <= 1.0 {
        let (value, slope, bound) = evaluate(p, z);
        return (value.norm() > 2.0 * f64::EPSILON * bound).then(|| value / slope);
    }
    let w = z.inv();
    let (value, slope, bound) = evaluate(reversed, w);
    let n = (p.len() - 1) as f64;
    (value.norm() > 2.0 * f64::EPSILON * bound)
        .then(|| z / (Complex::new(n, 0.0) - w * slope / value))
}

/// Makes conjugates exact: each root of the upper half plane with its nearest mirror image, the rest real.
fn pair(mut z: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    let mut out = Vec::with_capacity(z.len());
    z.sort_by(|a, b| b.im.abs().total_cmp(&a.im.abs()));
    while !z.is_empty() {
        let root = z.remove(0);
        let mirror = z
            .iter()
            .enumerate()
            .min_by(|a, b| {
                (a.1 - root.conj())
                    .norm()
                    .total_cmp(&(b.1 - root.conj()).norm())
            })
            .map(|(i, m)| (i, *m));
        match mirror {
            Some((i, m)) if (m - root.conj()).norm() < root.im.abs() => {
                z.remove(i);
                let mean = 0.5 * (root + m.conj());
                let up = Complex::new(mean.re, mean.im.abs());
                out.extend([up, up.conj()]);
            }
            _ => out.push(Complex::new(root.re, 0.0)),
        }
    }
    out.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(p: &[f64], exact: &[[f64; 2]], tolerance: f64) {
        let found = roots(p);
        assert_eq!(found.len(), exact.len());
        for [re, im] in exact {
            let nearest = found
                .iter()
                .map(|z| (z - Complex::new(*re, *im)).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < tolerance, "{re} {im}: {found:?}");
        }
    }

    #[test]
    fn roots_of_known_polynomials() {
        check(
            &[1.0, 6.0, 11.0, 6.0],
            &[[-1.0, 0.0], [-2.0, 0.0], [-3.0, 0.0]],
            1e-13,
        );
        check(
            &[1.0, 3.0, 2.0, 0.0],
            &[[0.0, 0.0], [-1.0, 0.0], [-2.0, 0.0]],
            1e-14,
        );
        check(
            &[1.0, 0.0, 0.0, 0.0, -1.0],
            &[[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]],
            1e-14,
        );
        check(&[1.0, 1e4 + 1.0, 1e4], &[[-1.0, 0.0], [-1e4, 0.0]], 1e-10);
        // Triple root: the third root of round-off.
        check(&[1.0, 3.0, 3.0, 1.0], &[[-1.0, 0.0]; 3], 1e-4);
        check(&[0.0, 0.0, 2.0], &[], 1.0);
    }
}
