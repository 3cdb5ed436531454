//! What the controller acts on.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::discrete::DiscretePlant;
use crate::limit_cycle::typical_frequency;
use crate::plant::{MAX_ORDER, PlantError, StateSpace, TransferFunction};
use crate::simulate::{Flow, State};

/// A plant in continuous or in discrete time.
#[derive(Clone, Debug, PartialEq)]
pub enum OnOffPlant {
    /// A transfer function in `s`, and the same without its dead time in the states of who made it.
    Continuous(TransferFunction, StateSpace),
    /// One in `z`.
    Discrete(DiscretePlant),
}

impl OnOffPlant {
    /// Checks it.
    ///
    /// # Errors
    /// What is wrong.
    pub fn validate(&self) -> Result<(), PlantError> {
        match self {
            Self::Continuous(plant, space) => plant.validate().and_then(|()| space.validate()),
            Self::Discrete(plant) => {
                StateSpace {
                    a: plant.a.clone(),
                    b: plant.b.clone(),
                    c: plant.c.clone(),
                }
                .validate()?;
                if plant.sampling.is_finite() && plant.sampling > 0.0 {
                    Ok(())
                } else {
                    Err(PlantError::SamplingTime(plant.sampling))
                }
            }
        }
    }

    /// Dead time, s.
    pub fn dead_time(&self) -> f64 {
        match self {
            Self::Continuous(plant, _) => plant.dead_time,
            Self::Discrete(_) => 0.0,
        }
    }

    /// Number of states.
    pub fn order(&self) -> usize {
        match self {
            Self::Continuous(_, space) => space.b.len(),
            Self::Discrete(plant) => plant.b.len(),
        }
    }

    /// Sampling time of a plant in discrete time, s.
    pub fn sampling(&self) -> Option<f64> {
        match self {
            Self::Continuous(..) => None,
            Self::Discrete(plant) => Some(plant.sampling),
        }
    }

    /// Frequency response at `omega` rad/s, dead time included; `None` on a pole.
    pub fn response(&self, omega: f64) -> Option<Complex<f64>> {
        match self {
            Self::Continuous(plant, _) => {
                Some(plant.response(omega)).filter(|p| p.re.is_finite() && p.im.is_finite())
            }
            Self::Discrete(plant) => plant.response(omega),
        }
    }

    /// The state from which the output begins at a value and stands still at first, without an input; `None` where its
    /// states are more than its output shows.
    pub fn standing_at(&self, output: f64) -> Option<DVector<f64>> {
        let n = self.order();
        let (a, c, later) = match self {
            // Its derivatives are 0.
            Self::Continuous(_, space) => (&space.a, &space.c, 0.0),
            // Its next samples are the same.
            Self::Discrete(plant) => (&plant.a, &plant.c, output),
        };
        let mut rows = DMatrix::zeros(n, n);
        let mut row = c.transpose();
        for i in 0..n {
            rows.row_mut(i).copy_from(&row);
            row = &row * a;
        }
        let wanted = DVector::from_fn(n, |i, _| if i == 0 { output } else { later });
        let state = rows.lu().solve(&wanted)?;
        state.iter().all(|v| v.is_finite()).then_some(state)
    }

    /// A time in which it moves, s.
    pub(super) fn typical_time(&self) -> f64 {
        match self {
            Self::Continuous(plant, _) => 1.0 / typical_frequency(plant),
            Self::Discrete(plant) => plant.sampling * plant.b.len() as f64,
        }
    }

    /// Its motion, quick for durations up to some `longest` s.
    pub(super) fn motion(&self, longest: f64) -> Motion {
        match self {
            Self::Continuous(_, space) => Motion::Flow(Box::new(Flow::single(space, longest))),
            Self::Discrete(plant) => Motion::Steps(plant.clone()),
        }
    }
}

/// How a plant moves between two events.
#[derive(Clone, Debug)]
pub(super) enum Motion {
    Flow(Box<Flow>),
    Steps(DiscretePlant),
}

impl Motion {
    /// State after `t` s of a held input; whole samples of a plant in discrete time.
    pub fn after(&self, x: &State, u: f64, t: f64) -> State {
        match self {
            Self::Flow(flow) => flow.after(x, &[u], t),
            Self::Steps(plant) => {
                let steps = (t / plant.sampling).round() as u64;
                let mut now = vector(x, plant.b.len());
                for _ in 0..steps {
                    now = &plant.a * now + &plant.b * u;
                }
                inner(&now)
            }
        }
    }

    /// Output.
    pub fn output(&self, x: &State) -> f64 {
        match self {
            Self::Flow(flow) => flow.output(x, 0),
            Self::Steps(plant) => plant.c.iter().zip(x).map(|(c, x)| c * x).sum(),
        }
    }

    /// How the output changes, 1/s; 0 in discrete time, where nothing depends on it.
    pub fn slope(&self, x: &State, u: f64) -> f64 {
        match self {
            Self::Flow(flow) => flow.output(&flow.velocity(x, &[u]), 0),
            Self::Steps(_) => 0.0,
        }
    }

    /// Transition matrix over `t` s.
    pub fn transition(&self, n: usize, t: f64) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(n, n);
        for j in 0..n {
            let mut unit = [0.0; MAX_ORDER];
            unit[j] = 1.0;
            let column = self.after(&unit, 0.0, t);
            for i in 0..n {
                matrix[(i, j)] = column[i];
            }
        }
        matrix
    }

    /// What a jump of the input by 1 does to the velocity of the state.
    pub fn push(&self, n: usize) -> DVector<f64> {
        match self {
            Self::Flow(flow) => vector(&flow.force(&[1.0]), n),
            Self::Steps(_) => DVector::zeros(n),
        }
    }

    /// The row of the output.
    pub fn row(&self, n: usize) -> DVector<f64> {
        match self {
            Self::Flow(flow) => vector(&flow.row(0), n),
            Self::Steps(plant) => plant.c.clone(),
        }
    }

    /// A state in here from one in the caller's units, and back.
    pub fn inner(&self, x: &DVector<f64>) -> State {
        match self {
            Self::Flow(flow) => flow.inner(x),
            Self::Steps(_) => inner(x),
        }
    }
}

fn vector(x: &State, n: usize) -> DVector<f64> {
    DVector::from_fn(n, |i, _| x[i])
}

fn inner(x: &DVector<f64>) -> State {
    let mut state = [0.0; MAX_ORDER];
    for (s, x) in state.iter_mut().zip(x) {
        *s = *x;
    }
    state
}
