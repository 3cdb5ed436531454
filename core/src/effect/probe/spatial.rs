//! At which spatial frequencies the unexplained force repeats along the way.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::equations::{solved, spans_stride};
use super::regression::WAVES;
use super::{BASE, Probe};
use crate::effect::spec::SEEN_TURN;
use crate::fourier::transform;
use crate::order::median;
use crate::sums::dot;

/// Samples at most that enter the regressions of a scan, and the number of peaks of it that are looked at by a
/// regression on all windows: where the body is held in many of them, a few may say anything.
const REPEATING: usize = 3_000;
const PEAKS: usize = 12;

/// Spatial frequencies that are scanned at most, as close as the measured travel tells them apart, each by a
/// regression.
const FINE_SPATIAL: usize = 700;

/// The highest one, in times that distance, where the pull on the body is transformed, as of a motor that makes many
/// turns; cells at least for one wave of it; and, of those that stand out of a row of neighbours, how many are looked
/// at likewise.
const FAR_SPATIAL: usize = 65_536;
const CELLS: usize = 4;
const NEIGHBOURS: usize = 64;
const STANDING_OUT: usize = 12;

/// Spatial frequencies in a row, whose waves are found from each other.
const ROW: usize = 32;

/// Highest spatial frequency, in radians per sample at the typical speed.
pub(super) const FASTEST_SPATIAL: f64 = 0.8;

/// How far apart the scanned ones are, in radians over the travel.
pub(super) const APART: f64 = 1.2;

impl Probe {
    /// The few spatial frequencies (radians per unit of position) at which the unexplained force
    /// repeats most clearly and leaves less than this `share` of it, with the coefficients of sine and cosine.
    pub fn spatial_frequencies(&self, share: f64) -> Vec<(f64, f64, f64)> {
        let travel = self.scales.travel;
        let fastest = FASTEST_SPATIAL / (self.scales.speed * self.scales.step);
        let spacing = APART / travel;
        let least = SEEN_TURN / travel;
        let within = |n: f64| n >= least && n <= fastest;
        let rows: Vec<Row> = rows(0.0, spacing, FINE_SPATIAL)
            .filter(|r| r.last() >= least && r.first() <= fastest)
            .collect();
        let stride = spans_stride(&self.spans, REPEATING);
        let scanned = self
            .crew
            .gather(rows.len(), |i| self.scan_row(&rows[i], stride));
        let scanned = scanned.into_iter().flatten();
        let scan: Vec<Wave> = scanned.filter(|wave| within(wave.n)).collect();
        let mut valleys: Vec<&Wave> = (0..scan.len())
            .filter(|i| {
                let left =
                    |j: Option<usize>| j.and_then(|j| scan.get(j)).map_or(f64::MAX, |s| s.left);
                let here = scan[*i].left;
                here <= left(i.checked_sub(1)) && here <= left(Some(i + 1))
            })
            .map(|i| &scan[i])
            .collect();
        valleys.sort_by(|a, b| a.left.total_cmp(&b.left));
        let mut promising: Vec<f64> = valleys.iter().take(PEAKS).map(|wave| wave.n).collect();
        promising.extend(self.far_peaks(spacing, fastest));
        let looked = self
            .crew
            .gather(promising.len(), |i| self.spatial(promising[i]));
        let mut peaks: Vec<Wave> = looked.into_iter().flatten().collect();
        peaks.sort_by(|a, b| a.left.total_cmp(&b.left));
        peaks.truncate(WAVES);
        // The peak lies between the scanned frequencies.
        let finer = self.crew.gather(peaks.len(), |i| {
            let near = (-4..=4).map(|k| peaks[i].n + 0.2 * f64::from(k) * spacing);
            near.filter_map(|n| self.spatial(n))
                .min_by(|a, b| a.left.total_cmp(&b.left))
        });
        finer
            .into_iter()
            .flatten()
            .filter(|wave| Self::may_be(wave.left) && wave.left < share)
            .map(|wave| (wave.n, wave.sine, wave.cosine))
            .collect()
    }

    /// The same beyond the frequencies that are scanned one by one. The product of what is unexplained with its answer
    /// to a wave of force is, over all waves, a Fourier transform along the way of the pull on each interval: where
    /// that stands out of its neighbours is worth a regression.
    fn far_peaks(&self, spacing: f64, fastest: f64) -> Vec<f64> {
        let highest = ((fastest / spacing) as usize).min(FAR_SPATIAL);
        if highest <= FINE_SPATIAL {
            return Vec::new();
        }
        let lines = self.transformed(spacing, highest);
        let mut standing: Vec<(usize, f64)> = (FINE_SPATIAL..highest)
            .step_by(NEIGHBOURS)
            .filter_map(|from| {
                let row = &lines[from..(from + NEIGHBOURS).min(highest)];
                let most = (0..row.len()).max_by(|a, b| row[*a].total_cmp(&row[*b]))?;
                Some((from + most, row[most] / median(&mut row.to_vec())))
            })
            .collect();
        standing.sort_by(|a, b| b.1.total_cmp(&a.1));
        standing.truncate(STANDING_OUT);
        let places = standing.into_iter().map(|(place, _)| place);
        places.map(|place| place as f64 * spacing).collect()
    }

    /// The squared Fourier transform of the pull along the way, at 0 and the multiples of `spacing` below `count`.
    fn transformed(&self, spacing: f64, count: usize) -> Vec<f64> {
        let cells = (CELLS * count).next_power_of_two();
        let width = TAU / (spacing * cells as f64);
        let (low, _) = self.position_range();
        let mut way = vec![Complex64::default(); cells];
        for (place, pull) in self.pulls() {
            let along = (place - low) / width;
            let (cell, share) = (along as usize, along % 1.0);
            way[cell % cells] += pull * (1.0 - share);
            way[(cell + 1) % cells] += pull * share;
        }
        transform(&mut way);
        way.iter().take(count).map(Complex64::norm_sqr).collect()
    }

    /// For each interval the position in its middle, and how much an acceleration there would do for what the base
    /// forces leave of its window, in units of that: a window in which the body is held says no more than one in which
    /// it runs.
    fn pulls(&self) -> Vec<(f64, f64)> {
        let windows = self.spans.iter().zip(&self.target).enumerate();
        windows
            .flat_map(|(index, (span, target))| {
                let known = &self.known[index];
                let normal = DMatrix::from_fn(BASE, BASE, |a, b| known.normal[a][b]);
                let shares = solved(normal, DVector::from_column_slice(&known.right));
                let shares = shares.iter().flat_map(|(solution, _)| solution);
                let mut left = target.clone();
                for (share, answer) in shares.zip(&self.base[index]) {
                    for (left, answer) in left.iter_mut().zip(answer) {
                        *left -= share * answer;
                    }
                }
                let power = dot(&left, &left);
                let mut pulls = self.pulls_of(*span, &left);
                for (_, pull) in &mut pulls {
                    *pull /= power;
                }
                pulls
            })
            .filter(|(_, pull)| pull.is_finite())
            .collect()
    }

    /// The same of one window with these errors: the adjoint of [`Probe::answer`].
    fn pulls_of(&self, (from, to): (usize, usize), errors: &[f64]) -> Vec<(f64, f64)> {
        let length = to - from;
        let (mut on_position, mut on_velocity) = (0.0, 0.0);
        let mut pulls = Vec::with_capacity(length);
        for k in (1..length).rev() {
            for (j, (is_velocity, weight)) in self.outputs.iter().enumerate() {
                let pull = weight * errors[j * length + k];
                if *is_velocity {
                    on_velocity += pull;
                } else {
                    on_position += pull;
                }
            }
            let before = &self.position[from + k - 1..=from + k];
            let pull = self.body.phi2 * on_position + self.body.phi1 * on_velocity;
            pulls.push((0.5 * (before[0] + before[1]), pull));
            on_velocity = self.body.decay * on_velocity + self.body.phi1 * on_position;
        }
        pulls
    }

    /// What a wave of this spatial frequency comes to on all windows.
    fn spatial(&self, n: f64) -> Option<Wave> {
        let only = Row {
            before: n,
            spacing: 0.0,
            count: 1,
        };
        self.scan_row(&only, 1).pop()
    }

    /// The same for a row of frequencies on one window in `stride`.
    fn scan_row(&self, row: &Row, stride: usize) -> Vec<Wave> {
        let Some(without) = self.left_without(stride) else {
            return Vec::new();
        };
        let spans = self.spans.iter().step_by(stride);
        let intervals: Vec<usize> = spans.flat_map(|(from, to)| *from..to - 1).collect();
        let middle = |k: &usize| 0.5 * (self.position[*k] + self.position[k + 1]);
        let along: Vec<f64> = intervals.iter().map(middle).collect();
        let mut place = vec![0; self.position.len()];
        for (i, k) in intervals.iter().enumerate() {
            place[*k] = i;
        }
        row.waves(&along, |n, sine, cosine| {
            let forces: [Box<dyn Fn(usize) -> f64>; 2] =
                [Box::new(|k| sine[place[k]]), Box::new(|k| cosine[place[k]])];
            let fit = self.regress_beside(without, &forces, stride)?;
            Some(Wave {
                n,
                sine: fit.coefficients[0],
                cosine: fit.coefficients[1],
                left: fit.left,
            })
        })
    }
}

/// A force that repeats along the way.
struct Wave {
    /// Spatial frequency, rad per unit of position.
    n: f64,
    /// Coefficients of sine and cosine.
    sine: f64,
    cosine: f64,
    /// Share of the squared error that it leaves.
    left: f64,
}

/// Equally spaced spatial frequencies, rad per unit of position: those after `before`.
pub(super) struct Row {
    pub before: f64,
    pub spacing: f64,
    pub count: usize,
}

impl Row {
    /// What `found` makes of each frequency and of its sine and cosine at the places `along` the way; these are turned
    /// on from each frequency to the next.
    pub fn waves<T>(
        &self,
        along: &[f64],
        mut found: impl FnMut(f64, &[f64], &[f64]) -> Option<T>,
    ) -> Vec<T> {
        let at =
            |n: f64| -> (Vec<f64>, Vec<f64>) { along.iter().map(|x| libm::sincos(n * x)).unzip() };
        let (mut sines, mut cosines) = at(self.before);
        let (turn_sines, turn_cosines) = at(self.spacing);
        let mut all = Vec::with_capacity(self.count);
        for k in 1..=self.count {
            let turns = turn_sines.iter().zip(&turn_cosines);
            for ((s, c), (sine, cosine)) in sines.iter_mut().zip(&mut cosines).zip(turns) {
                (*s, *c) = (*s * cosine + *c * sine, *c * cosine - *s * sine);
            }
            let n = self.before + k as f64 * self.spacing;
            all.extend(found(n, &sines, &cosines));
        }
        all
    }

    fn first(&self) -> f64 {
        self.before + self.spacing
    }

    fn last(&self) -> f64 {
        self.before + self.count as f64 * self.spacing
    }
}

/// `count` frequencies after `before`, in rows of [`ROW`] at most.
pub(super) fn rows(before: f64, spacing: f64, count: usize) -> impl Iterator<Item = Row> {
    (0..count).step_by(ROW).map(move |done| Row {
        before: before + done as f64 * spacing,
        spacing,
        count: ROW.min(count - done),
    })
}
