//! How does the oscillation change with two parameters? Maps of exact cycles, from coarse to fine.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::explore::{ExploreError, ExploreInput};
use crate::limit_cycle::{
    Cycle, describing_function, dominant, exact_symmetric, likely_half_periods, typical_frequency,
};
use crate::message::{Message, says};
use crate::msg;

/// Most cells along one side.
pub const MAX_SIZE: usize = 1024;

/// Cells that are computed between two looks at the clock or the cancel button: some 20 ms.
const BATCH: usize = 256;

/// Cells along one side of the first, coarsest picture.
const COARSEST: usize = 8;

/// What a map varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Relay gain `k`, unit of the input.
    Gain,
    /// Hysteresis `eps`, unit of the output.
    Hysteresis,
    /// Delay of the relay, s.
    Delay,
    /// Factor on the plant's gain, 1.
    PlantGain,
    /// Factor on the plant's time constants, 1; its dead time stays.
    TimeScale,
    /// Dead time of the plant, s.
    DeadTime,
}

impl Parameter {
    /// All of them, in the order of menus.
    pub const ALL: [Self; 6] = [
        Self::Gain,
        Self::Hysteresis,
        Self::Delay,
        Self::PlantGain,
        Self::TimeScale,
        Self::DeadTime,
    ];

    /// Name with symbol, for menus and axes.
    pub fn label(self) -> &'static str {
        match self {
            Self::Gain => "relay gain k",
            Self::Hysteresis => "hysteresis ε",
            Self::Delay => "relay delay",
            Self::PlantGain => "plant gain, times",
            Self::TimeScale => "time constants, times",
            Self::DeadTime => "dead time",
        }
    }

    /// Unit; empty for factors and for quantities whose unit the plant gives.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Delay | Self::DeadTime => "s",
            Self::Gain | Self::Hysteresis | Self::PlantGain | Self::TimeScale => "",
        }
    }

    /// Value in a loop; factors are 1 there.
    pub fn read(self, input: &ExploreInput) -> f64 {
        match self {
            Self::Gain => input.relay.gain,
            Self::Hysteresis => input.relay.hysteresis,
            Self::Delay => input.relay.delay,
            Self::DeadTime => input.plant.dead_time,
            Self::PlantGain | Self::TimeScale => 1.0,
        }
    }

    /// Sets the value in a loop; factors multiply what is there.
    pub fn write(self, input: &mut ExploreInput, value: f64) {
        match self {
            Self::Gain => input.relay.gain = value,
            Self::Hysteresis => input.relay.hysteresis = value,
            Self::Delay => input.relay.delay = value,
            Self::DeadTime => input.plant.dead_time = value,
            Self::PlantGain => input.plant.numerator.iter_mut().for_each(|c| *c *= value),
            // P(T s): the coefficient of s^i grows by T^i.
            Self::TimeScale => {
                for polynomial in [&mut input.plant.numerator, &mut input.plant.denominator] {
                    let mut factor = 1.0;
                    for c in polynomial.iter_mut().rev() {
                        *c *= factor;
                        factor *= value;
                    }
                }
            }
        }
    }

    /// A range worth seeing around a loop.
    pub fn range(self, input: &ExploreInput) -> [f64; 2] {
        let seconds = 2.0 / typical_frequency(&input.plant);
        match self {
            Self::Gain => [0.2, 2.0],
            Self::Hysteresis => [0.0, 1.0],
            Self::Delay => [0.0, seconds],
            Self::DeadTime => [0.0, seconds.max(2.0 * input.plant.dead_time)],
            Self::PlantGain | Self::TimeScale => [0.2, 3.0],
        }
    }
}

/// One axis: what it varies, from where to where.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// What it varies.
    pub parameter: Parameter,
    /// Value at its lower edge, in the parameter's unit.
    pub from: f64,
    /// Value at its upper edge, above `from`.
    pub to: f64,
}

impl Axis {
    /// An axis over the range that is worth seeing.
    pub fn around(parameter: Parameter, input: &ExploreInput) -> Self {
        let [from, to] = parameter.range(input);
        Self {
            parameter,
            from,
            to,
        }
    }

    /// Value in the middle of cell `index` of `size`.
    pub fn value(&self, index: usize, size: usize) -> f64 {
        self.from + (self.to - self.from) * (index as f64 + 0.5) / size as f64
    }

    /// The cell that holds a value, if the axis reaches so far.
    pub fn index(&self, value: f64, size: usize) -> Option<usize> {
        let share = (value - self.from) / (self.to - self.from);
        (0.0..1.0)
            .contains(&share)
            .then_some((share * size as f64) as usize)
    }
}

/// Everything that a map needs to know.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapInput {
    /// The loop around which the parameters vary.
    pub base: ExploreInput,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Cells along each side: a power of two, 8 to [`MAX_SIZE`].
    pub size: usize,
}

impl Default for MapInput {
    fn default() -> Self {
        let base = ExploreInput::default();
        Self {
            x: Axis::around(Parameter::Hysteresis, &base),
            y: Axis::around(Parameter::Gain, &base),
            base,
            size: 128,
        }
    }
}

/// Why a map cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MapError {
    /// The same parameter twice.
    SameParameter(&'static str),
    /// An axis without extent.
    Range {
        /// The parameter.
        name: &'static str,
        /// Lower edge.
        from: f64,
        /// Upper edge.
        to: f64,
    },
    /// Side length.
    Size(usize),
    /// The loop at one of the corners.
    Loop(#[from] ExploreError),
}

impl MapError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::SameParameter(given) => {
                msg!(
                    "both axes vary the {}: choose two different parameters",
                    given
                )
            }
            Self::Range { name, from, to } => msg!(
                "the {} runs from {} to {}: the second must be the larger number",
                name,
                from,
                to
            ),
            Self::Size(given) => msg!(
                "a map of {} cells a side: must be a power of two from {} to {}",
                given,
                COARSEST,
                MAX_SIZE
            ),
            Self::Loop(error) => error.message(),
        }
    }
}

says!(MapError);

impl MapInput {
    /// The loop of one cell, counted from the lower left.
    pub fn at(&self, place: [usize; 2]) -> ExploreInput {
        self.with([
            self.x.value(place[0], self.size),
            self.y.value(place[1], self.size),
        ])
    }

    /// The loop with these values of the two parameters.
    pub fn with(&self, values: [f64; 2]) -> ExploreInput {
        let mut input = self.base.clone();
        self.x.parameter.write(&mut input, values[0]);
        self.y.parameter.write(&mut input, values[1]);
        input
    }

    /// Checks size, axes and the loops at the corners, between which all others lie.
    pub fn validate(&self) -> Result<(), MapError> {
        if !self.size.is_power_of_two() || self.size < COARSEST || self.size > MAX_SIZE {
            return Err(MapError::Size(self.size));
        }
        if self.x.parameter == self.y.parameter {
            return Err(MapError::SameParameter(self.x.parameter.label()));
        }
        for axis in [&self.x, &self.y] {
            let grows = axis.from.is_finite() && axis.to.is_finite() && axis.from < axis.to;
            if !grows {
                return Err(MapError::Range {
                    name: axis.parameter.label(),
                    from: axis.from,
                    to: axis.to,
                });
            }
        }
        let last = self.size - 1;
        for place in [[0, 0], [0, last], [last, 0], [last, last]] {
            self.at(place).validate()?;
        }
        Ok(())
    }
}

/// What a loop of the map does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Relay gain, for the ultimate gain.
    pub gain: f64,
    /// The exact symmetric cycle, equation (3); `None` where there is none.
    pub exact: Option<Cycle>,
    /// What the describing function predicts, equations (5) and (6).
    pub describing: Option<Cycle>,
}

impl Outcome {
    /// Computes one loop; `guess` is a period in s of a similar loop, for where the describing
    /// function predicts nothing.
    pub fn of(input: &ExploreInput, guess: Option<f64>) -> Self {
        let found = describing_function(&input.plant, &input.relay);
        let describing = dominant(&found).map(|i| i.cycle);
        let (plant, relay) = (&input.plant, &input.relay);
        let (space, lag) = (plant.state_space(), plant.dead_time + relay.delay);
        let near = describing.map(|c| c.period).or(guess).map(|t| 0.5 * t);
        let near = near.and_then(|half| exact_symmetric(&space, relay, lag, half));
        let exact = near.or_else(|| {
            let mut likely = likely_half_periods(plant, relay).into_iter();
            likely.find_map(|half| exact_symmetric(&space, relay, lag, half))
        });
        Self {
            gain: input.relay.gain,
            exact,
            describing,
        }
    }
}

/// What a map shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Exact period, s.
    #[default]
    Period,
    /// Exact amplitude, half of peak to peak, unit of the output.
    Amplitude,
    /// Ultimate gain as the experiment gives it, equation (9): `4 k/(pi a)`.
    UltimateGain,
    /// By how much the describing function's period is off, per cent of the exact one.
    PeriodError,
    /// By how much the describing function's amplitude is off, per cent of the exact one.
    AmplitudeError,
    /// Whether the exact cycle is stable: 1, else 0.
    Stability,
}

impl Quantity {
    /// All of them, in the order of menus.
    pub const ALL: [Self; 6] = [
        Self::Period,
        Self::Amplitude,
        Self::UltimateGain,
        Self::PeriodError,
        Self::AmplitudeError,
        Self::Stability,
    ];

    /// Name with symbol.
    pub fn label(self) -> &'static str {
        match self {
            Self::Period => "period",
            Self::Amplitude => "amplitude a",
            Self::UltimateGain => "ultimate gain Ku",
            Self::PeriodError => "describing function's error in period",
            Self::AmplitudeError => "describing function's error in amplitude",
            Self::Stability => "stability",
        }
    }

    /// Unit; empty where the plant gives it.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Period => "s",
            Self::PeriodError | Self::AmplitudeError => "%",
            Self::Amplitude | Self::UltimateGain | Self::Stability => "",
        }
    }

    /// Its value for a loop; `None` where there is no cycle, or no prediction to compare it with.
    pub fn value(self, outcome: &Outcome) -> Option<f64> {
        let exact = outcome.exact?;
        let error = |predicted: f64, exact: f64| 100.0 * (predicted / exact - 1.0);
        let value = match self {
            Self::Period => exact.period,
            Self::Amplitude => exact.amplitude,
            Self::UltimateGain => 4.0 * outcome.gain / (PI * exact.amplitude),
            Self::PeriodError => error(outcome.describing?.period, exact.period),
            Self::AmplitudeError => error(outcome.describing?.amplitude, exact.amplitude),
            Self::Stability => f64::from(u8::from(exact.stable?)),
        };
        value.is_finite().then_some(value)
    }
}

/// Cells that have just been computed.
pub type Tile = Vec<([usize; 2], Outcome)>;

/// What is known of a map so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Map {
    size: usize,
    cells: Vec<Option<Outcome>>,
    known: usize,
}

impl Map {
    /// An empty map of `size` x `size` cells.
    pub fn new(size: usize) -> Self {
        Self {
            size,
            cells: vec![None; size * size],
            known: 0,
        }
    }

    /// Cells along each side.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Share of its cells that are known, 0 to 1.
    pub fn share(&self) -> f64 {
        self.known as f64 / (self.cells.len().max(1)) as f64
    }

    /// Takes in new cells; places outside the map are left out.
    pub fn insert(&mut self, tile: &[([usize; 2], Outcome)]) {
        for (place, outcome) in tile {
            if place[0] >= self.size || place[1] >= self.size {
                continue;
            }
            let cell = &mut self.cells[place[1] * self.size + place[0]];
            self.known += usize::from(cell.is_none());
            *cell = Some(*outcome);
        }
    }

    /// A cell, if it is known itself.
    pub fn known(&self, place: [usize; 2]) -> Option<&Outcome> {
        if place[0] >= self.size || place[1] >= self.size {
            return None;
        }
        self.cells.get(place[1] * self.size + place[0])?.as_ref()
    }

    /// Values of a quantity at all cells that are known and have one, ascending.
    pub fn values(&self, quantity: Quantity) -> Vec<f64> {
        let mut values: Vec<f64> = self
            .cells
            .iter()
            .flatten()
            .filter_map(|o| quantity.value(o))
            .collect();
        values.sort_by(f64::total_cmp);
        values
    }

    /// Share of the known cells without an exact cycle, 0 to 1.
    pub fn silent_share(&self) -> f64 {
        let silent = self.cells.iter().flatten().filter(|o| o.exact.is_none());
        silent.count() as f64 / self.known.max(1) as f64
    }

    /// A cell, or the coarser one that stands for it until it is computed.
    pub fn at(&self, place: [usize; 2]) -> Option<&Outcome> {
        let mut step = 1;
        while step <= self.size {
            let coarse = place.map(|i| i - i % step);
            if let Some(outcome) = self.known(coarse) {
                return Some(outcome);
            }
            step *= 2;
        }
        None
    }
}

/// Computes a map in batches, each picture twice as fine as the one before.
///
/// Cells of one batch do not depend on each other, so a caller with threads may compute them at the
/// same time: [`batch`](Self::batch), [`outcome`](Self::outcome) for each place, [`accept`](Self::accept).
/// The result does not depend on how the work was split.
pub struct MapJob {
    input: MapInput,
    map: Map,
    /// Side of the blocks of the present picture, cells.
    step: usize,
    /// Places of the present picture, and how many are done.
    places: Vec<[usize; 2]>,
    done: usize,
}

impl MapJob {
    /// A job for a valid input.
    pub fn new(input: MapInput) -> Result<Self, MapError> {
        input.validate()?;
        let step = input.size / COARSEST;
        let mut job = Self {
            map: Map::new(input.size),
            places: Vec::new(),
            done: 0,
            step,
            input,
        };
        job.places = job.places_of(step);
        Ok(job)
    }

    /// Places on the grid of `step` that the coarser grids have not.
    fn places_of(&self, step: usize) -> Vec<[usize; 2]> {
        let line = || (0..self.input.size).step_by(step);
        line()
            .flat_map(|y| line().map(move |x| [x, y]))
            .filter(|place| self.map.known(*place).is_none())
            .collect()
    }

    /// Places to compute next; empty when the map is finished.
    pub fn batch(&self) -> &[[usize; 2]] {
        let end = (self.done + BATCH).min(self.places.len());
        &self.places[self.done..end]
    }

    /// What happens at a place of the present batch.
    pub fn outcome(&self, place: [usize; 2]) -> Outcome {
        let parent = place.map(|i| i - i % (2 * self.step));
        let guess = self
            .map
            .known(parent)
            .and_then(|o| o.exact)
            .map(|c| c.period);
        Outcome::of(&self.input.at(place), guess)
    }

    /// Takes the outcomes of the present batch, in its order.
    pub fn accept(&mut self, outcomes: Vec<Outcome>) -> Tile {
        let tile: Tile = self.batch().iter().copied().zip(outcomes).collect();
        self.done += tile.len();
        self.map.insert(&tile);
        if self.done == self.places.len() && self.step > 1 {
            self.step /= 2;
            self.places = self.places_of(self.step);
            self.done = 0;
        }
        tile
    }

    /// Computes the next batch; empty when the map is finished.
    pub fn advance(&mut self) -> Tile {
        let outcomes = self.batch().iter().map(|p| self.outcome(*p)).collect();
        self.accept(outcomes)
    }

    /// Share done, 0 to 1.
    pub fn share(&self) -> f64 {
        self.map.share()
    }

    /// What is known so far.
    pub fn map(&self) -> &Map {
        &self.map
    }
}
