//! Records of MATLAB's System Identification Toolbox: input, output, and the sampling period or times of each
//! experiment.

use crate::measurement::series::{OF_A_RECORD, Series};

/// Series of a file up to which records are looked for among them: a hostile one may have millions.
const MOST_SERIES: usize = 1000;

/// Gives each experiment its times, and leaves out what is only said about it.
pub fn complete(all: &mut Vec<Series>) {
    if all.len() > MOST_SERIES {
        return;
    }
    let [times, _, output] = OF_A_RECORD;
    let mut experiments: Vec<(String, String, usize)> = Vec::new();
    for series in all.iter() {
        let Some((path, rest)) = series.name.split_once(output) else {
            continue;
        };
        let (path, which) = (path.to_owned(), experiment(rest).to_owned());
        let known = |(p, w, _): &(String, String, usize)| *p == path && *w == which;
        if !experiments.iter().any(known) {
            experiments.push((path, which, series.values.len()));
        }
    }
    for (path, which, samples) in &experiments {
        let under = |what: &str| {
            let name = format!("{path}.{what}{which}");
            let found = all.iter().find(|s| s.name == name);
            found.map_or_else(Vec::new, |s| s.values.clone())
        };
        let instants = under("SamplingInstants");
        let (start, period) = (under("Tstart"), under("Ts"));
        let values = match period.first() {
            _ if instants.len() == *samples => instants,
            Some(period) if *period > 0.0 => {
                let start = start.first().copied().unwrap_or(0.0);
                (0..*samples).map(|i| start + i as f64 * period).collect()
            }
            _ => continue,
        };
        let begins = |s: &Series| {
            let rest = s.name.strip_prefix(path.as_str());
            rest.is_some_and(|r| r.starts_with(output))
        };
        let place = all.iter().position(begins).unwrap_or(0);
        all.insert(
            place,
            Series {
                name: format!("{path}{times}{which}"),
                unit: Some("s".to_owned()),
                values,
                ..Series::default()
            },
        );
    }
    all.retain(|series| {
        let own = experiments.iter().find_map(|(path, ..)| {
            let rest = series.name.strip_prefix(path.as_str())?;
            rest.starts_with('.').then_some(rest)
        });
        own.is_none_or(|rest| OF_A_RECORD.iter().any(|kept| is_of(rest, kept)))
    });
}

/// Which of several experiments it is, as `(2)`; nothing where there is one.
fn experiment(rest: &str) -> &str {
    let end = rest.find(')').map_or(0, |end| end + 1);
    let inside = rest[..end]
        .strip_prefix('(')
        .and_then(|r| r.strip_suffix(')'));
    let number = inside.is_some_and(|n| n.bytes().all(|b| b.is_ascii_digit()));
    if number { &rest[..end] } else { "" }
}

/// Whether a name is that of the values, or of a column or an experiment of them.
fn is_of(rest: &str, what: &str) -> bool {
    let rest = rest.strip_prefix(what);
    rest.is_some_and(|r| r.is_empty() || r.starts_with('('))
}
