//! The explicit pair of orders 5 and 4 of Dormand and Prince (1980), "A family of embedded Runge-Kutta formulae", J.
//! Comp. Appl. Math. 6.

/// Coefficients of the stages, and of the difference of both orders.
const A: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
    ],
    &[
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
    ],
    &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
const E: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// One step of `h` from `y`: the solution of order 5, and how far that of order 4 is from it.
pub(super) fn step<const N: usize>(
    rate: &impl Fn(&[f64; N]) -> [f64; N],
    y: &[f64; N],
    h: f64,
) -> ([f64; N], [f64; N]) {
    let mut k = [[0.0; N]; 7];
    k[0] = rate(y);
    let mut at = *y;
    for (stage, weights) in A.iter().enumerate() {
        at = *y;
        for (weight, k) in weights.iter().zip(&k) {
            for (a, k) in at.iter_mut().zip(k) {
                *a += h * weight * k;
            }
        }
        k[stage + 1] = rate(&at);
    }
    let mut error = [0.0; N];
    for (weight, k) in E.iter().zip(&k) {
        for (e, k) in error.iter_mut().zip(k) {
            *e += h * weight * k;
        }
    }
    (at, error)
}
