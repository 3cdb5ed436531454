//! Atoms: what an effect adds to the equation of motion, so that a regression can find it without a simulation.
//!
//! ```text
//! drive     J x'' + d x'  = u + sum theta_i g_i
//! process   J y' + d y    = u + F + sum theta_i g_i        J = T/K, d = 1/K, F = ambient/K
//! ```
//!
//! An atom gives the columns `g_i` as functions of what was measured. The coefficients `theta_i` are fitted; what
//! enters nonlinearly, its [`Shape`], is tried on a grid (variable projection: Golub and Pereyra 1973).

/// Inertia and viscous friction of a body, and values of an effect that go with them.
pub type BodyStart = ([f64; 2], Vec<f64>);

/// Values of what enters an atom nonlinearly, such as a dead time or a Stribeck speed; what it does not need is 0.
pub type Shape = [f64; 5];

/// The shape of an atom that has none.
pub const NO_SHAPE: Shape = [0.0; 5];

/// The shape with these numbers.
pub fn shape<const N: usize>(numbers: [f64; N]) -> Shape {
    let mut shape = NO_SHAPE;
    for (own, number) in shape.iter_mut().zip(numbers) {
        *own = number;
    }
    shape
}

/// One sample of a record, its noise smoothed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Position of a drive, rad or m; 0 for a process.
    pub position: f64,
    /// Velocity of a drive, rad/s or m/s; the output of a process.
    pub velocity: f64,
    /// Sign of the velocity, between -1 and 1 where noise hides it; 0 for a process.
    pub direction: f64,
    /// Input.
    pub input: f64,
    /// Time since the first sample, s.
    pub time: f64,
}

/// A record at equal time steps, as atoms that are more than a function of the moment need it.
#[derive(Clone, Copy, Debug)]
pub struct Track<'a> {
    /// Sampling time, s.
    pub step: f64,
    /// Input, held from a sample to the next.
    pub input: &'a [f64],
    /// Position of a drive, smoothed, rad or m; empty for a process.
    pub position: &'a [f64],
    /// Velocity of a drive, smoothed; the output of a process.
    pub velocity: &'a [f64],
}

/// Sizes of a record, from which grids are laid out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Sampling time, s.
    pub step: f64,
    /// The longest window that is integrated over, s: what is slower is hardly seen.
    pub window: f64,
    /// Largest input without its sign.
    pub input: f64,
    /// Root mean square of the velocity about 0; of a process output about its mean.
    pub speed: f64,
    /// Range of the position; 0 for a process.
    pub travel: f64,
    /// Root mean square of the acceleration; of the rate of a process output.
    pub acceleration: f64,
    /// Whether it is a drive that turns.
    pub rotates: bool,
    /// Least and largest output of a process; least and largest velocity of a drive.
    pub range: [f64; 2],
}

/// A series of a [`Part::Motion`]: its derivative of this order is the column.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// 0 to 3.
    pub derivative: usize,
    /// One value for each sample.
    pub values: Vec<f64>,
}

/// What an atom is made of.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    /// One column: a force that is a function of the moment.
    Force(fn(&Moment, &Shape) -> f64),
    /// What becomes of the input on its way. It takes the place of the input and has no coefficient.
    Input(fn(&Track, &Shape) -> Vec<f64>),
    /// Columns that depend on the course of the motion.
    Motion(fn(&Track, &Shape) -> Vec<Series>),
    /// The force that a second body needs: the coefficient of the first column is its inertia.
    Body(fn(&Track, &Shape) -> Vec<Series>),
    /// One column: a force of a user's own formula.
    Own(Own),
}

/// A force as a function of the moment, made while the program runs.
#[derive(Clone, Copy)]
pub struct Own(pub &'static (dyn Fn(&Moment) -> f64 + Sync));

impl std::fmt::Debug for Own {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("own")
    }
}

/// What a regression found of an atom.
#[derive(Clone, Copy, Debug)]
pub struct Solved<'a> {
    /// `J` and `d`.
    pub body: [f64; 2],
    /// Its shape on the grid.
    pub shape: Shape,
    /// Sizes of the record.
    pub extent: &'a Extent,
    /// Coefficients of its columns, in their order; none for [`Part::Input`].
    pub coefficients: &'a [f64],
}

/// What an effect adds to the equation of motion.
#[derive(Clone, Copy, Debug)]
pub struct Atom {
    /// Its columns.
    pub parts: &'static [Part],
    /// Shapes to try; one for an atom without.
    pub grid: fn(&Extent) -> Vec<Shape>,
    /// Numbers in the shape that are fitted by the grid; each counts as a parameter.
    pub shapes: usize,
    /// What its coefficients and its shape say.
    pub values: Values,
}

/// What the coefficients and the shape of an atom say of body and effect.
#[derive(Clone, Copy, Debug)]
pub enum Values {
    /// The coefficients are the values of the effect, whatever their signs.
    Coefficients,
    /// The first number of the shape is its one value.
    Shape,
    /// The body and the values, in the order of the parameters; none where the coefficients are none that it can have.
    From(fn(&Solved) -> Option<BodyStart>),
}

impl Atom {
    /// An atom that is linear in all that it has.
    pub const fn linear(parts: &'static [Part], values: Values) -> Self {
        Self {
            parts,
            grid: |_| vec![NO_SHAPE],
            shapes: 0,
            values,
        }
    }

    /// The body and the values of the effect, in the order of its parameters, or none where the coefficients are none
    /// that it can have.
    pub fn read(&self, solved: &Solved) -> Option<BodyStart> {
        match self.values {
            Values::Coefficients => Some((solved.body, solved.coefficients.to_vec())),
            Values::Shape => Some((solved.body, vec![solved.shape[0]])),
            Values::From(read) => read(solved),
        }
    }
}

/// The body and the coefficients as values of an effect that has none below 0.
pub fn not_negative(solved: &Solved) -> Option<BodyStart> {
    let possible = solved.coefficients.iter().all(|c| *c >= 0.0);
    possible.then(|| (solved.body, solved.coefficients.to_vec()))
}

/// `count` numbers from the first to the last at equal ratios, as shapes of one number; none where there is no such
/// range.
pub fn geometric(first: f64, last: f64, count: usize) -> Vec<Shape> {
    if !(first > 0.0 && last > first && last.is_finite()) || count < 2 {
        return Vec::new();
    }
    let ratio = libm::log(last / first) / (count - 1) as f64;
    let at = |k: usize| first * libm::exp(ratio * k as f64);
    (0..count).map(|k| shape([at(k)])).collect()
}

/// The same at equal distances.
pub fn even(first: f64, last: f64, count: usize) -> Vec<Shape> {
    if !(last > first && (last - first).is_finite()) || count < 2 {
        return Vec::new();
    }
    let distance = (last - first) / (count - 1) as f64;
    (0..count)
        .map(|k| shape([first + distance * k as f64]))
        .collect()
}

/// A static map of the input.
pub fn mapped(track: &Track, map: impl Fn(f64) -> f64) -> Vec<f64> {
    track.input.iter().map(|u| map(*u)).collect()
}
