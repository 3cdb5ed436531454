//! How far do the surroundings of a process wander?
//!
//! A room, a supply, a draught never stand still: beneath the noise, what the right model of a process leaves goes on a
//! random walk. The next sample is then best foretold by a level that each sample moves a share of the way to itself
//! (Muth 1960), and what is left beyond that, the news of each sample, is white again. So models are fitted and
//! compared by it where it is most of what is left (generalised least squares): what explains how the output answers
//! the input is in the news of few samples after each change, and what follows a slow wander is in none.

use crate::criticism::cut::Block;
use crate::criticism::data::Data;
use crate::criticism::motion::Motion;
use crate::criticism::output::Output;

/// What each sample of a series brings beyond a level that moves by this share towards each sample: the series itself
/// for a share of 0. A sample that tells nothing moves no level.
pub(in crate::criticism) fn news(
    data: &Data,
    output: &Output,
    series: &[f64],
    gain: f64,
) -> Vec<f64> {
    let mut news = series.to_vec();
    for (from, to) in data.spans() {
        let mut level = 0.0;
        for (i, value) in news.iter_mut().enumerate().take(to).skip(from) {
            *value -= level;
            if output.tells(i) {
                level += gain * *value;
            }
        }
    }
    news
}

/// Root mean square of the news of what a motion leaves in these blocks, in noise units.
pub(in crate::criticism) fn news_left(
    data: &Data,
    motion: &Motion,
    gain: f64,
    is_one: impl Fn(&Block) -> bool,
) -> f64 {
    let (mut square, mut count) = (0.0, 0_usize);
    for output in data.outputs.iter().filter(|o| o.is_velocity) {
        let pairs = output.values.iter().zip(&motion.velocity);
        let left: Vec<f64> = pairs.map(|(y, m)| y - m).collect();
        let news = news(data, output, &left, gain);
        for block in data.blocks.iter().filter(|b| is_one(b)) {
            for i in (block.from..block.to).filter(|i| output.tells(*i)) {
                square += (news[i] / output.noise).powi(2);
                count += 1;
            }
        }
    }
    (square / count.max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;
    use crate::measurement::import_csv;

    #[test]
    fn a_level_moves_towards_each_sample_that_tells() {
        let mut text = "t [s],u [1],y [1]\n".to_owned();
        for k in 0..400 {
            let noise = libm::sin(1e4 * libm::sin(1e3 * f64::from(k)));
            let _ = writeln!(text, "{k},{},{noise}", k / 50 % 2);
        }
        let record = import_csv("level", text.as_bytes(), None).unwrap();
        let data = Data::new(&record).unwrap();
        let mut output = data.outputs[0].clone();
        output.silent = vec![false; data.len()];
        output.silent[1] = true;
        let news = news(&data, &output, &vec![1.0; data.len()], 0.1);
        for (found, expected) in news.iter().zip([1.0, 0.9, 0.9, 0.81]) {
            assert!((found - expected).abs() < 1e-12, "{found}, {expected}");
        }
    }
}
