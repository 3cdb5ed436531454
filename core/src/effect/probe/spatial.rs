//! At which spatial frequencies the unexplained force repeats along the way.

use super::{Probe, spans_stride};
use crate::effect::spec::SEEN_TURN;

/// Samples at most that enter the regression.
const REPEATING: usize = 3_000;

/// Spatial frequencies that are scanned at most as close as the measured travel tells them apart, and
/// beyond them up to the highest.
const FINE_SPATIAL: usize = 700;
const COARSE_SPATIAL: usize = 150;

/// Spatial frequencies in a row, whose waves are found from each other.
const ROW: usize = 32;

/// Highest spatial frequency, in radians per sample at the typical speed.
const FASTEST_SPATIAL: f64 = 0.8;

impl Probe {
    /// The `count` spatial frequencies (radians per unit of position) at which the unexplained force
    /// repeats most clearly and leaves less than this `share` of it, with the coefficients of sine and cosine.
    pub fn spatial_frequencies(&self, count: usize, share: f64) -> Vec<(f64, f64, f64)> {
        let travel = self.scales.travel;
        let fastest = FASTEST_SPATIAL / (self.scales.speed * self.scales.step);
        let spacing = 1.2 / travel;
        let least = SEEN_TURN / travel;
        let within = |n: f64| n >= least && n <= fastest;
        let from = FINE_SPATIAL as f64 * spacing;
        let wider = spacing.max((fastest - from) / COARSE_SPATIAL as f64);
        let rows = rows(0.0, spacing, FINE_SPATIAL).chain(rows(from, wider, COARSE_SPATIAL));
        let rows: Vec<Row> = rows
            .filter(|r| r.last() >= least && r.first() <= fastest)
            .collect();
        let scanned = self.crew.gather(rows.len(), |i| self.scan_row(&rows[i]));
        let scanned = scanned.into_iter().flatten();
        let scan: Vec<(f64, f64, f64, f64)> = scanned.filter(|s| within(s.0)).collect();
        let mut peaks: Vec<(f64, f64, f64, f64)> = (0..scan.len())
            .filter(|i| {
                let left = |j: Option<usize>| j.and_then(|j| scan.get(j)).map_or(f64::MAX, |s| s.3);
                let here = scan[*i].3;
                here <= left(i.checked_sub(1)) && here <= left(Some(i + 1))
            })
            .map(|i| scan[i])
            .collect();
        peaks.sort_by(|a, b| a.3.total_cmp(&b.3));
        peaks.truncate(count);
        // The peak lies between the scanned frequencies.
        let finer = peaks.into_iter().map(|peak| {
            let near = (-4..=4).map(|k| peak.0 + 0.2 * f64::from(k) * spacing);
            near.filter_map(|n| self.spatial(n))
                .min_by(|a, b| a.3.total_cmp(&b.3))
                .unwrap_or(peak)
        });
        finer
            .filter(|peak| Self::may_be(peak.3) && peak.3 < share)
            .map(|peak| (peak.0, peak.1, peak.2))
            .collect()
    }

    /// Frequency, coefficients of sine and cosine, share left.
    fn spatial(&self, n: f64) -> Option<(f64, f64, f64, f64)> {
        let only = Row {
            before: n,
            spacing: 0.0,
            count: 1,
        };
        self.scan_row(&only).pop()
    }

    /// The same for a row of frequencies. Sine and cosine are turned on from each to the next.
    fn scan_row(&self, row: &Row) -> Vec<(f64, f64, f64, f64)> {
        let stride = spans_stride(&self.spans, REPEATING);
        let spans = self.spans.iter().step_by(stride);
        let places = spans.flat_map(|(from, to)| *from..to - 1);
        let mut waves = vec![(0.0, 0.0); self.position.len()];
        let turns: Vec<(usize, (f64, f64))> = places
            .map(|k| {
                let middle = 0.5 * (self.position[k] + self.position[k + 1]);
                waves[k] = libm::sincos(row.before * middle);
                (k, libm::sincos(row.spacing * middle))
            })
            .collect();
        let mut found = Vec::with_capacity(row.count);
        for k in 1..=row.count {
            for (k, (sine, cosine)) in &turns {
                let (s, c) = waves[*k];
                waves[*k] = (s * cosine + c * sine, c * cosine - s * sine);
            }
            let waves = &waves;
            let forces: [Box<dyn Fn(usize) -> f64>; 2] =
                [Box::new(|k| waves[k].0), Box::new(|k| waves[k].1)];
            let n = row.before + k as f64 * row.spacing;
            let fit = self.regress_forces(&forces, stride);
            found.extend(fit.map(|f| (n, f.coefficients[0], f.coefficients[1], f.left)));
        }
        found
    }
}

/// Equally spaced spatial frequencies, rad per unit of position: those after `before`.
struct Row {
    before: f64,
    spacing: f64,
    count: usize,
}

impl Row {
    fn first(&self) -> f64 {
        self.before + self.spacing
    }

    fn last(&self) -> f64 {
        self.before + self.count as f64 * self.spacing
    }
}

/// `count` frequencies after `before`, in rows of [`ROW`] at most.
fn rows(before: f64, spacing: f64, count: usize) -> impl Iterator<Item = Row> {
    (0..count).step_by(ROW).map(move |done| Row {
        before: before + done as f64 * spacing,
        spacing,
        count: ROW.min(count - done),
    })
}
