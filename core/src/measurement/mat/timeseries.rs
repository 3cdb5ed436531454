//! Timeseries of MATLAB: values with the times that belong to them, which may stand apart or be told by begin and
//! distance.

use crate::measurement::series::Series;

/// Completes all timeseries among what was read.
pub fn complete(all: &mut Vec<Series>) {
    let lengths = all
        .iter()
        .filter_map(|s| s.name.strip_suffix(".TimeInfo.Length"));
    let timeseries: Vec<String> = lengths.map(str::to_owned).collect();
    for path in timeseries {
        complete_one(&path, all);
    }
}

/// Gives a timeseries its times where they stand apart from it, or are told by their begin and distance, and leaves out
/// what is only said about it.
fn complete_one(path: &str, all: &mut Vec<Series>) {
    let under = |name: &str, what: &str| {
        let rest = name.strip_prefix(path);
        rest.and_then(|r| r.strip_prefix('.'))
            .is_some_and(|r| r == what)
    };
    let values = |what: &str| {
        all.iter()
            .find(|s| under(&s.name, what))
            .map_or(&[][..], |s| &s.values)
    };
    let samples = values("Data").len();
    let times = match (values("Time"), values("TimeInfo.Time")) {
        ([_, _, ..], _) => None,
        (_, apart @ [_, _, ..]) => Some(apart.to_vec()),
        _ => {
            let first = |what: &str, other: f64| values(what).first().copied().unwrap_or(other);
            let (start, step) = (
                first("TimeInfo.Start", 0.0),
                first("TimeInfo.Increment", 0.0),
            );
            Some((0..samples).map(|i| start + i as f64 * step).collect()).filter(|_| step > 0.0)
        }
    };
    let said = |series: &Series| {
        let rest = series
            .name
            .strip_prefix(path)
            .and_then(|r| r.strip_prefix('.'));
        rest.is_some_and(|rest| {
            !rest.starts_with("Data") && rest != "Time" || rest.starts_with("DataInfo.")
        })
    };
    let place = all.iter().position(|s| under(&s.name, "Data"));
    let unit = Some("s".to_owned());
    if let (Some(place), Some(values)) = (place, times) {
        let name = format!("{path}.Time");
        all.insert(
            place,
            Series {
                name,
                unit,
                values,
                ..Series::default()
            },
        );
    } else if let Some(time) = all.iter_mut().find(|s| under(&s.name, "Time")) {
        time.unit = unit;
    }
    all.retain(|series| !said(series));
}
