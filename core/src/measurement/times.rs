//! Times that do not increase in every row: a clock that had not started, and runs that follow one another.

use super::Kind;
use super::error::Problem;
use crate::message::Message;
use crate::msg;

/// Fewest rows of a run.
const RUN: usize = 10;

/// Share of the time of the run before within which a run begins where that began.
const NEAR_BEGIN: f64 = 0.1;

/// Time between two runs, in times of the longest step of the first.
const BETWEEN: f64 = 10.0;

/// Rows of which no more than one may lack a time of its own.
const RARE: usize = 20;

/// What became of times.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Mended {
    /// Rows that are left out, in order.
    pub out: Vec<usize>,
    /// What is to be said of it.
    pub notes: Vec<Message>,
}

/// Makes times increase: rows at the begin of a run whose time the next one has again are left out, since the clock had
/// not started, and the runs of a drive follow one another with gaps between them.
///
/// # Errors
/// The row whose time cannot be right, and what is wrong with it.
pub(super) fn mend(times: &mut Vec<f64>, kind: Kind) -> Result<Mended, (usize, Problem)> {
    let mut mended = Mended::default();
    let raw = std::mem::take(times);
    let mut runs = 1;
    // Of the run: its first row and its rows so far, by how much it is put off, and its longest step.
    let (mut first, mut rows, mut later, mut longest) = (0.0, 0, 0.0, 0.0_f64);
    let mut before: Option<f64> = None;
    for (row, now) in raw.iter().copied().enumerate() {
        let Some(last) = before.replace(now) else {
            (first, rows) = (now, 1);
            times.push(now);
            continue;
        };
        if now > last {
            longest = longest.max(now - last);
            rows += 1;
            times.push(now + later);
        } else if now == last && rows == 1 {
            mended.out.push(row - 1);
        } else if now == last || rows < RUN || (now - first).abs() > NEAR_BEGIN * (last - first) {
            return Err((row, out_of_order(last, now)));
        } else if kind == Kind::Process {
            let (before, now) = (format!("{last}"), format!("{now}"));
            return Err((row, Problem::TimeBeginsAnew { before, now }));
        } else {
            runs += 1;
            later += last + BETWEEN * longest - now;
            (first, rows, longest) = (now, 1, 0.0);
            times.push(now + later);
        }
    }
    if mended.out.len() * RARE > raw.len()
        && let Some(row) = mended.out.first()
    {
        return Err((row + 1, out_of_order(raw[*row], raw[*row])));
    }
    mended.notes = said(mended.out.len(), runs);
    Ok(mended)
}

/// Leaves out the values of these rows, which are in order.
pub(super) fn leave_out<T>(values: &mut Vec<T>, rows: &[usize]) {
    if rows.is_empty() {
        return;
    }
    let mut row = 0;
    values.retain(|_| {
        row += 1;
        rows.binary_search(&(row - 1)).is_err()
    });
}

fn out_of_order(before: f64, now: f64) -> Problem {
    if before == now {
        return Problem::TimeTwice {
            time: format!("{now}"),
        };
    }
    let (before, now) = (format!("{before}"), format!("{now}"));
    Problem::TimeOrder { before, now }
}

fn said(out: usize, runs: usize) -> Vec<Message> {
    let mut notes = Vec::new();
    if out == 1 {
        notes.push(msg!(
            "{} row has the same time as the row below it and is left out: the clock had not started.",
            out
        ));
    } else if out > 1 {
        notes.push(msg!(
            "{} rows have the same time as the row below them and are left out: the clock had not started.", out));
    }
    if runs > 1 {
        notes.push(msg!(
            "The time starts over: read as {} runs one after another, with a gap between them.",
            runs
        ));
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mended(times: &[f64], kind: Kind) -> Result<(Vec<f64>, Mended), (usize, Problem)> {
        let mut times = times.to_vec();
        let mended = mend(&mut times, kind)?;
        Ok((times, mended))
    }

    fn run(rows: usize) -> Vec<f64> {
        (0..rows).map(|k| 0.5 * k as f64).collect()
    }

    #[test]
    fn times_in_order_are_left_as_they_are() {
        let times = run(30);
        assert_eq!(
            mended(&times, Kind::Drive),
            Ok((times.clone(), Mended::default()))
        );
    }

    #[test]
    fn a_clock_that_had_not_started_costs_its_first_rows() {
        let times = [vec![0.0, 0.0], run(60)].concat();
        let (mended, said) = mended(&times, Kind::Process).unwrap();
        assert_eq!((mended, said.out.as_slice()), (run(60), &[0, 1][..]));
        assert!(
            said.notes[0]
                .to_string()
                .starts_with("2 rows have the same time")
        );
        let mut values: Vec<f64> = (0..62).map(f64::from).collect();
        leave_out(&mut values, &said.out);
        assert_eq!((values.len(), values[0]), (60, 2.0));
    }

    #[test]
    fn runs_of_a_drive_follow_one_another_and_those_of_a_process_are_asked_for_one_by_one() {
        let times = [run(20), vec![0.0], run(30)].concat();
        let (all, said) = mended(&times, Kind::Drive).unwrap();
        assert_eq!((all.len(), said.out.as_slice()), (50, &[20][..]));
        assert!(all.windows(2).all(|pair| pair[1] > pair[0]));
        assert_eq!((all[19], all[20], all[21]), (9.5, 14.5, 15.0));
        assert!(
            said.notes[1].to_string().contains("2 runs"),
            "{:?}",
            said.notes
        );
        let (row, problem) = mended(&times, Kind::Process).unwrap_err();
        assert_eq!(row, 20);
        assert!(
            problem.to_string().contains("a file of its own"),
            "{problem}"
        );
    }

    #[test]
    fn a_row_that_is_out_of_order_is_none_of_these() {
        let mut times = run(30);
        times[20] = 9.0;
        assert!(matches!(
            mended(&times, Kind::Drive),
            Err((20, Problem::TimeOrder { .. }))
        ));
        times[20] = times[19];
        assert!(matches!(
            mended(&times, Kind::Drive),
            Err((20, Problem::TimeTwice { .. }))
        ));
        // A clock that stands for long is none.
        let times = [vec![0.0; 20], run(30)].concat();
        assert!(matches!(
            mended(&times, Kind::Drive),
            Err((1, Problem::TimeTwice { .. }))
        ));
    }
}
