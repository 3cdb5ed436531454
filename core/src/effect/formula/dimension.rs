//! Units of a formula's parameters, by what they are added to and multiplied with.
//!
//! Exponents of force, position (output of a process) and time are linear in those of the parts: products
//! add them, powers multiply them, sums want them equal, arguments of functions want them 0. Numbers may
//! carry any unit. The equations are solved together.

use super::parse::{Expr, Function, Variable};
use crate::effect::Dimension;
use crate::measurement::Kind;

/// Exponents of force, position and time.
type Exponents = [f64; 3];

/// Exponents as a linear function of the unknown ones.
#[derive(Clone)]
struct Form {
    coefficients: Vec<f64>,
    constant: Exponents,
}

/// Smallest pivot that counts.
const SMALL: f64 = 1e-9;

/// Dimension of each of `count` parameters of a force; [`Dimension::Undetermined`] where the formula does not
/// tell it.
pub(super) fn dimensions(tree: &Expr, count: usize, kind: Kind) -> Vec<Dimension> {
    let unknowns = count + numbers(tree);
    let mut equations = Equations {
        unknowns,
        parameters: count,
        used: count,
        kind,
        zero: Vec::new(),
    };
    let mut force = equations.form(tree);
    force.constant[0] -= 1.0;
    equations.zero.push(force);
    equations.solve(count).map_or_else(
        || vec![Dimension::Undetermined; count],
        |solution| {
            solution
                .into_iter()
                .map(|e| e.map_or(Dimension::Undetermined, |e| dimension(e, kind)))
                .collect()
        },
    )
}

fn numbers(tree: &Expr) -> usize {
    match tree {
        Expr::Number(_) => 1,
        Expr::Variable(_) | Expr::Parameter(_) => 0,
        Expr::Negative(a) => numbers(a),
        Expr::Sum(a, b)
        | Expr::Difference(a, b)
        | Expr::Product(a, b)
        | Expr::Quotient(a, b)
        | Expr::Power(a, b) => numbers(a) + numbers(b),
        Expr::Call(_, arguments) => arguments.iter().map(numbers).sum(),
    }
}

struct Equations {
    unknowns: usize,
    parameters: usize,
    /// Unknowns given out so far: parameters first, then numbers.
    used: usize,
    kind: Kind,
    /// Forms that are 0.
    zero: Vec<Form>,
}

impl Equations {
    fn plain(&self, constant: Exponents) -> Form {
        Form {
            coefficients: vec![0.0; self.unknowns],
            constant,
        }
    }

    fn unknown(&self, index: usize) -> Form {
        let mut form = self.plain([0.0; 3]);
        if let Some(c) = form.coefficients.get_mut(index) {
            *c = 1.0;
        }
        form
    }

    fn form(&mut self, tree: &Expr) -> Form {
        match tree {
            Expr::Number(_) => {
                self.used += 1;
                self.unknown(self.used - 1)
            }
            Expr::Variable(variable) => self.plain(match (variable, self.kind) {
                (Variable::Position, _) | (Variable::Velocity, Kind::Process) => [0.0, 1.0, 0.0],
                (Variable::Velocity, Kind::Drive) => [0.0, 1.0, -1.0],
                (Variable::Input, _) => [1.0, 0.0, 0.0],
                (Variable::Time, _) => [0.0, 0.0, 1.0],
            }),
            Expr::Parameter(index) => self.unknown((*index).min(self.parameters)),
            Expr::Negative(a) => self.form(a),
            Expr::Sum(a, b) | Expr::Difference(a, b) => {
                let (a, b) = (self.form(a), self.form(b));
                self.zero.push(combine(&a, &b, -1.0));
                a
            }
            Expr::Product(a, b) => {
                let (a, b) = (self.form(a), self.form(b));
                combine(&a, &b, 1.0)
            }
            Expr::Quotient(a, b) => {
                let (a, b) = (self.form(a), self.form(b));
                combine(&a, &b, -1.0)
            }
            Expr::Power(a, b) => {
                let base = self.form(a);
                let exponent = self.form(b);
                if let Some(n) = b.constant() {
                    let nothing = self.plain([0.0; 3]);
                    return combine(&nothing, &base, n);
                }
                self.zero.push(base);
                self.zero.push(exponent);
                self.plain([0.0; 3])
            }
            Expr::Call(function, arguments) => {
                let forms: Vec<Form> = arguments.iter().map(|a| self.form(a)).collect();
                let Some(first) = forms.first().cloned() else {
                    return self.plain([0.0; 3]);
                };
                match function {
                    Function::Abs => first,
                    Function::Min | Function::Max => {
                        if let Some(second) = forms.get(1) {
                            self.zero.push(combine(&first, second, -1.0));
                        }
                        first
                    }
                    Function::Sqrt => {
                        let nothing = self.plain([0.0; 3]);
                        combine(&nothing, &first, 0.5)
                    }
                    Function::Sign => self.plain([0.0; 3]),
                    _ => {
                        self.zero.push(first);
                        self.plain([0.0; 3])
                    }
                }
            }
        }
    }

    /// Exponents of the first `count` unknowns, each where it is determined; `None` where the equations
    /// contradict each other.
    fn solve(mut self, count: usize) -> Option<Vec<Option<Exponents>>> {
        let rows = &mut self.zero;
        let mut pivots = Vec::new();
        let mut next = 0;
        for column in 0..self.unknowns {
            let Some(best) = (next..rows.len()).max_by(|a, b| {
                let size = |r: &usize| rows[*r].coefficients[column].abs();
                size(a).total_cmp(&size(b))
            }) else {
                break;
            };
            let pivot = rows[best].coefficients[column];
            if pivot.abs() < SMALL {
                continue;
            }
            rows.swap(next, best);
            let nothing = Form {
                coefficients: vec![0.0; self.unknowns],
                constant: [0.0; 3],
            };
            rows[next] = combine(&nothing, &rows[next], 1.0 / pivot);
            let row = rows[next].clone();
            for (k, other) in rows.iter_mut().enumerate() {
                if k != next {
                    let share = other.coefficients[column];
                    *other = combine(other, &row, -share);
                }
            }
            pivots.push(column);
            next += 1;
        }
        let wrong = |f: &Form| f.constant.iter().any(|c| c.abs() > SMALL);
        if rows[next..].iter().any(wrong) {
            return None;
        }
        Some(
            (0..count)
                .map(|j| {
                    let row = &rows[pivots.iter().position(|p| *p == j)?];
                    let alone = row
                        .coefficients
                        .iter()
                        .enumerate()
                        .all(|(k, c)| k == j || c.abs() < SMALL);
                    alone.then(|| row.constant.map(|c| -c))
                })
                .collect(),
        )
    }
}

/// `a + factor * b`.
fn combine(a: &Form, b: &Form, factor: f64) -> Form {
    let mut form = a.clone();
    for (x, y) in form.coefficients.iter_mut().zip(&b.coefficients) {
        *x += factor * y;
    }
    for (x, y) in form.constant.iter_mut().zip(b.constant) {
        *x += factor * y;
    }
    form
}

fn dimension(exponents: Exponents, kind: Kind) -> Dimension {
    let whole = |e: f64| {
        let near = e.round();
        ((e - near).abs() < 1e-6 && near.abs() <= 9.0).then_some(near as i8)
    };
    let (Some(force), Some(position), Some(time)) = (
        whole(exponents[0]),
        whole(exponents[1]),
        whole(exponents[2]),
    ) else {
        return Dimension::Undetermined;
    };
    match (kind, force, position, time) {
        (_, 1, 0, 0) => Dimension::Force,
        (_, 0, 0, 1) => Dimension::Time,
        (_, 0, 0, 0) => Dimension::Ratio,
        (_, 1, 0, -1) => Dimension::Rise,
        (Kind::Process, ..) => Dimension::Compound {
            force,
            position: 0,
            output: position,
            time,
        },
        (_, 0, 1, 0) => Dimension::Position,
        (_, 0, 1, -1) => Dimension::Speed,
        (_, 0, -1, 0) => Dimension::PerPosition,
        (_, 1, -1, 0) => Dimension::Stiffness,
        (_, 1, -1, 1) => Dimension::ViscousFriction,
        (_, 1, -1, 2) => Dimension::Inertia,
        (_, 1, -2, 2) => Dimension::Drag,
        _ => Dimension::Compound {
            force,
            position,
            output: 0,
            time,
        },
    }
}
