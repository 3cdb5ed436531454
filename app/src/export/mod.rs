//! What a page gives away: its picture and its numbers.

mod png;
mod svg;

pub use png::encode as png;
pub use svg::picture as svg;

/// Numbers of a page, for a spreadsheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What they are, also the name of the file.
    pub name: &'static str,
    /// Title with unit, and values, of each column; shorter ones end with empty fields.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// One without columns yet.
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            columns: Vec::new(),
        }
    }

    /// A curve in a plane.
    pub fn curve(name: &'static str, titles: [&str; 2], points: &[[f64; 2]]) -> Self {
        Self::new(name)
            .with(titles[0], points.iter().map(|p| p[0]))
            .with(titles[1], points.iter().map(|p| p[1]))
    }

    /// With one more column.
    #[must_use]
    pub fn with(mut self, title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        self.columns
            .push((title.into(), values.into_iter().collect()));
        self
    }

    /// As a CSV file whose first line names the columns; every number is written to the last bit.
    pub fn csv(&self) -> String {
        let titles: Vec<String> = self.columns.iter().map(|(t, _)| quoted(t)).collect();
        let mut text = titles.join(",");
        text.push('\n');
        let rows = self.columns.iter().map(|(_, v)| v.len()).max().unwrap_or(0);
        for row in 0..rows {
            for (i, (_, values)) in self.columns.iter().enumerate() {
                if i > 0 {
                    text.push(',');
                }
                // What is not a number, such as the period of a loop that does not swing, is left out.
                if let Some(value) = values.get(row).filter(|v| v.is_finite()) {
                    text.push_str(&written(*value));
                }
            }
            text.push('\n');
        }
        text
    }
}

/// Tables that can be given now: their names at once, their numbers when they are asked for.
#[derive(Default)]
pub struct Tables<'a> {
    /// Their names.
    pub names: Vec<&'static str>,
    numbers: Option<Box<dyn Fn() -> Vec<Table> + 'a>>,
}

impl<'a> Tables<'a> {
    /// Tables of these names, in the order in which `numbers` gives them.
    pub fn new(names: impl Into<Vec<&'static str>>, numbers: impl Fn() -> Vec<Table> + 'a) -> Self {
        Self {
            names: names.into(),
            numbers: Some(Box::new(numbers)),
        }
    }

    /// All of them with their numbers.
    pub fn all(&self) -> Vec<Table> {
        self.numbers
            .as_ref()
            .map_or_else(Vec::new, |numbers| numbers())
    }
}

/// A number to the last bit, with an exponent where it would be a row of zeros.
fn written(value: f64) -> String {
    if value == 0.0 || (1e-5..1e15).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

fn quoted(title: &str) -> String {
    if title.contains([',', '"']) {
        format!("\"{}\"", title.replace('"', "\"\""))
    } else {
        title.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_written_to_the_last_bit() {
        let table = Table::new("cycle")
            .with("time [s]", [0.0, 0.1 + 0.2])
            .with("output y, noisy", [1e-300, f64::NAN]);
        let csv = table.csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines[0], "time [s],\"output y, noisy\"");
        let (time, rest) = lines[2].split_once(',').expect("two columns");
        assert_eq!(time.parse(), Ok(0.1 + 0.2));
        assert_eq!(rest, "", "no number, no text");
        assert_eq!(lines[1], "0,1e-300");
        for value in [1.35e-17, -2.5e-9, 0.001, 123_456.789, 1e20] {
            assert_eq!(written(value).parse(), Ok(value));
            assert!(written(value).len() < 12, "{}", written(value));
        }
    }
}
