//! The question at the end of a lesson, and whether it is answered.

use serde_json::Value;

/// What is asked, and what counts as right.
#[derive(Default)]
pub struct Question {
    /// A number to be typed.
    pub answer: Option<Answer>,
    /// What the app must show.
    goals: Vec<Goal>,
    /// What helps whoever is stuck.
    pub hint: &'static str,
    /// What is said when it is solved.
    pub right: &'static str,
    faults: Vec<String>,
}

/// A number that is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The right one.
    pub value: f64,
    /// Share by which one may miss it.
    pub within: f64,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
}

/// Something that the app must show, by the path of its state for tests.
#[derive(Debug)]
struct Goal {
    path: &'static str,
    wanted: Wanted,
}

#[derive(Debug)]
enum Wanted {
    Text(&'static str),
    Range(f64, f64),
}

impl Question {
    /// Takes a line that is about the question; false for any other.
    pub fn read(&mut self, line: &'static str) -> bool {
        let Some((key, rest)) = line.split_once(": ") else {
            return false;
        };
        match key {
            "answer" => self.answer = Answer::read(rest),
            "reach" => match Goal::read(rest) {
                Some(goal) => self.goals.push(goal),
                None => self.faults.push(format!("no goal: {rest}")),
            },
            "hint" => self.hint = rest,
            "right" => self.right = rest,
            _ => return false,
        }
        true
    }

    /// Whether the typed number and the state of the app are what is asked for.
    pub fn solved(&self, typed: &str, state: &Value) -> bool {
        self.answer.is_none_or(|a| a.accepts(typed)) && self.goals.iter().all(|g| g.reached(state))
    }

    /// What counts as right, in a text.
    pub fn asked(&self) -> String {
        format!("{:?} {:?}", self.answer, self.goals)
    }

    pub fn faults(&self) -> Vec<String> {
        let mut faults = self.faults.clone();
        if self.answer.is_none() && self.goals.is_empty() {
            faults.push("its question has no answer".to_owned());
        }
        if self.hint.is_empty() || self.right.is_empty() {
            faults.push("its question has no hint, or no word for who has solved it".to_owned());
        }
        faults
    }
}

impl Answer {
    /// From `2.197 within 2 % [s]`.
    fn read(text: &'static str) -> Option<Self> {
        let (value, rest) = text.split_once(" within ")?;
        let (percent, unit) = rest.split_once(" %")?;
        let unit = unit.trim().trim_start_matches('[').trim_end_matches(']');
        Some(Self {
            value: value.parse().ok()?,
            within: 0.01 * percent.parse::<f64>().ok()?,
            unit,
        })
    }

    /// Whether a typed number is right; a comma is a decimal point too, and the unit may follow.
    fn accepts(&self, typed: &str) -> bool {
        let number = typed.trim().trim_end_matches(self.unit).trim();
        let number = number.replace(',', ".").parse::<f64>();
        number.is_ok_and(|n| (n - self.value).abs() <= self.within * self.value.abs())
    }
}

impl Goal {
    /// From `PATH is WORD` or `PATH between LOW and HIGH`.
    fn read(text: &'static str) -> Option<Self> {
        if let Some((path, range)) = text.split_once(" between ") {
            let (low, high) = range.split_once(" and ")?;
            let wanted = Wanted::Range(low.trim().parse().ok()?, high.trim().parse().ok()?);
            return Some(Self { path, wanted });
        }
        let (path, word) = text.split_once(" is ")?;
        Some(Self {
            path,
            wanted: Wanted::Text(word.trim()),
        })
    }

    fn reached(&self, state: &Value) -> bool {
        let found = self.path.split('.').fold(state, |at, key| &at[key]);
        match self.wanted {
            Wanted::Text(word) => found.as_str() == Some(word),
            Wanted::Range(low, high) => found.as_f64().is_some_and(|v| (low..=high).contains(&v)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_may_be_typed_in_several_ways() {
        let answer = Answer::read("2.197 within 2 % [s]").expect("an answer");
        assert_eq!(answer.unit, "s");
        for right in ["2.197", " 2.2 ", "2,2", "2.18 s", "2.2s"] {
            assert!(answer.accepts(right), "{right}");
        }
        for wrong in ["", "2.1", "two", "2.2 m", "NaN", "-2.2"] {
            assert!(!answer.accepts(wrong), "{wrong}");
        }
    }
}
