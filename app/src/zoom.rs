//! What of each plot is in view, where someone has chosen it: links, undo and the autosave keep it.
//!
//! ```text
//! time:2,7/phase:-1,1,-0.5,0.5/loop_nyquist:,,0,1
//! ```
//!
//! The plot, then the ends of x and of y; an axis that shows all by itself has none. On a logarithmic axis the ends
//! are logarithms to base 10.

use hysteron_core::message::Message;
use hysteron_core::msg;
use std::collections::BTreeMap;

use serde_json::Value;

use crate::link;

/// Plots of a page whose zoom is kept; no page has as many.
const MOST: usize = 24;

/// Length of the name of a plot.
const LONGEST_NAME: usize = 40;

/// Largest number on an axis, and the least part of it that a view may span: beyond, a plot has no digits left.
const FARTHEST: f64 = 1e12;
const FINEST: f64 = 1e-9;

/// Digits of what is in view that are kept: a pixel is a thousandth of it.
const DIGITS: i32 = 4;

/// What of a plot is in view; an axis without ends shows what the plot chooses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Zoom {
    /// Ends of x and of y.
    pub axes: [Option<[f64; 2]>; 2],
}

impl Zoom {
    /// As fine as it can be seen; an axis that no link could set is left to the plot.
    #[must_use]
    pub fn tidied(self) -> Self {
        let axes = self.axes.map(|ends| ends.map(tidy).filter(can_be));
        Self { axes }
    }

    fn text(&self) -> String {
        let ends = |axis: Option<[f64; 2]>| {
            axis.map_or_else(|| ",".to_owned(), |[from, to]| format!("{from},{to}"))
        };
        match self.axes {
            [x, None] => ends(x),
            [x, y] => format!("{},{}", ends(x), ends(y)),
        }
    }

    fn read(text: &str) -> Option<Self> {
        let fields: Vec<&str> = text.split(',').collect();
        if !matches!(fields.len(), 2 | 4) {
            return None;
        }
        let mut zoom = Self::default();
        for (axis, ends) in zoom.axes.iter_mut().zip(fields.chunks(2)) {
            if ends != ["", ""] {
                *axis = Some(read_ends(ends)?);
            }
        }
        (zoom != Self::default()).then_some(zoom)
    }
}

fn read_ends(fields: &[&str]) -> Option<[f64; 2]> {
    let [from, to] = fields else {
        return None;
    };
    Some([from.parse().ok()?, to.parse().ok()?]).filter(can_be)
}

pub(crate) fn can_be(ends: &[f64; 2]) -> bool {
    let [from, to] = *ends;
    let size = from.abs().max(to.abs());
    // What is no number is not smaller than any.
    size <= FARTHEST && to - from >= FINEST * size && to > from
}

fn tidy(ends: [f64; 2]) -> [f64; 2] {
    let decade = (ends[1] - ends[0]).log10().floor();
    if !decade.is_finite() {
        return ends;
    }
    let decimals = (DIGITS - decade as i32).clamp(0, 300) as usize;
    ends.map(|v| format!("{v:.decimals$}").parse().unwrap_or(v))
}

/// The zoomed plots of a page, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Zooms(BTreeMap<String, Zoom>);

impl Zooms {
    /// What of a plot is in view.
    pub fn of(&self, plot: &str) -> Zoom {
        self.0.get(plot).copied().unwrap_or_default()
    }

    /// Notes what of a plot is in view.
    pub fn note(&mut self, plot: &str, zoom: Zoom) {
        if zoom == Zoom::default() {
            self.0.remove(plot);
        } else if self.0.len() < MOST || self.0.contains_key(plot) {
            self.0.insert(plot.to_owned(), zoom);
        }
    }

    /// As a text for a link.
    pub fn text(&self) -> String {
        let entry = |(name, zoom): (&String, &Zoom)| format!("{name}:{}", zoom.text());
        self.0.iter().map(entry).collect::<Vec<_>>().join("/")
    }

    /// Reads what [`Self::text`] has written.
    ///
    /// # Errors
    /// One sentence.
    pub fn read(value: &Value) -> Result<Self, Message> {
        let text = value.as_str().ok_or_else(|| refused(&value.to_string()))?;
        let mut zooms = Self::default();
        for entry in text.split('/').filter(|_| !text.is_empty()) {
            let read = entry.split_once(':').filter(|(name, _)| is_name(name));
            let read = read.and_then(|(name, ends)| Some((name, Zoom::read(ends)?)));
            let (name, zoom) = read.ok_or_else(|| refused(entry))?;
            if zooms.0.len() >= MOST {
                return Err(msg!("This link zooms in on more than {} plots.", MOST));
            }
            if zooms.0.insert(name.to_owned(), zoom).is_some() {
                return Err(refused(entry));
            }
        }
        Ok(zooms)
    }
}

fn refused(entry: &str) -> Message {
    let entry = link::shortened(entry);
    msg!(
        "This link zooms in on an impossible range: {}.",
        Message::name(entry)
    )
}

/// The name of a plot as it stands in a link.
pub fn name(plot: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    plot.chars().map(plain).take(LONGEST_NAME).collect()
}

fn is_name(text: &str) -> bool {
    !text.is_empty() && name(text) == text
}

/// The zooms of every page, and what each page is about: the zoom of one record says nothing of the next.
#[derive(Clone, Debug, Default)]
pub struct AllZooms(BTreeMap<String, (Zooms, [Value; 2])>);

impl AllZooms {
    /// Those of a page.
    pub fn of(&self, page: &str) -> Zooms {
        self.0.get(page).map(|p| p.0.clone()).unwrap_or_default()
    }

    /// Sets those of a page that has these settings.
    pub fn set(&mut self, page: &str, zooms: Zooms, settings: &Value) {
        self.0.insert(page.to_owned(), (zooms, about(settings)));
    }

    /// Notes what its plots show now.
    pub fn note(&mut self, page: &str, zooms: Zooms) {
        self.0.entry(page.to_owned()).or_default().0 = zooms;
    }

    /// Forgets the zoom of a page that is about another record now.
    pub fn follow(&mut self, page: &str, settings: &Value) {
        let about = about(settings);
        let present = self.0.entry(page.to_owned()).or_default();
        if present.1 != about {
            *present = (Zooms::default(), about);
        }
    }
}

/// The record that a page is about.
fn about(settings: &Value) -> [Value; 2] {
    ["file", "mystery"].map(|key| settings[key].clone())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde_json::json;

    use super::*;

    #[test]
    fn a_zoom_is_written_as_briefly_as_it_is_seen() {
        let mut zooms = Zooms::default();
        let zoom = |x, y| Zoom { axes: [x, y] }.tidied();
        zooms.note("time", zoom(Some([2.000_000_1, 1.0 / 0.3 * 2.1]), None));
        zooms.note("map", zoom(None, Some([-1e-7, 3.3e-6])));
        assert_eq!(zooms.text(), "map:,,-0.0000001,0.0000033/time:2,7");
        zooms.note("map", Zoom::default());
        assert_eq!(zooms.text(), "time:2,7");
    }

    #[test]
    fn what_is_no_part_of_a_plot_is_refused() {
        for text in [
            "time",
            "time:",
            "time:1",
            "time:1,2,3",
            "time:,",
            "time:,,,",
            ":1,2",
            "time:2,1",
            "time:1,1",
            "time:nan,1",
            "time:NaN,NaN",
            "time:-inf,inf",
            "time:0,1e999",
            "time:0,1e300",
            "time:1,1.00000000001",
            "time:1,2,",
            "time:1,2,3,4,5",
            "time:1,2/",
            "/",
            "time:1,2/time:3,4",
            "a b:1,2",
            "time:,,1",
            "time:1,,2,3",
        ] {
            let read = Zooms::read(&json!(text));
            let sentence = read.expect_err(text);
            assert!(
                sentence.to_string().contains("impossible"),
                "{text}: {sentence}"
            );
        }
        for value in [
            json!(null),
            json!(7),
            json!([0, 1]),
            json!({"time": [0, 1]}),
        ] {
            assert!(Zooms::read(&value).is_err(), "{value}");
        }
        let many: Vec<String> = (0..=MOST).map(|i| format!("p{i}:0,1")).collect();
        let many = Zooms::read(&json!(many.join("/")));
        assert!(many.is_err_and(|e| e.to_string().contains("more than")));
    }

    #[test]
    fn another_record_shows_all_of_itself() {
        let mut all = AllZooms::default();
        let zooms = Zooms::read(&json!("time:0,1")).expect("a zoom");
        all.follow("compare", &json!({"file": "a", "mystery": null}));
        all.note("compare", zooms.clone());
        all.follow(
            "compare",
            &json!({"file": "a", "mystery": null, "look": "places"}),
        );
        assert_eq!(all.of("compare"), zooms);
        all.follow("compare", &json!({"file": "b", "mystery": null}));
        assert_eq!(all.of("compare"), Zooms::default());
    }

    proptest! {
        #[test]
        fn any_zoom_comes_back(
            from in -1e6_f64..1e6,
            span in 1e-2_f64..1e6,
            low in -1.0_f64..1.0,
            height in 1e-6_f64..1e3,
        ) {
            let zoom = Zoom { axes: [Some([from, from + span]), Some([low, low + height])] };
            let tidied = zoom.tidied();
            let mut zooms = Zooms::default();
            zooms.note("signal_y", tidied);
            prop_assert!(zooms.text().len() < 70, "{}", zooms.text());
            prop_assert_eq!(&Zooms::read(&json!(zooms.text())), &Ok(zooms.clone()));
            for (seen, kept) in zoom.axes.into_iter().flatten().zip(tidied.axes.into_iter().flatten()) {
                for k in [0, 1] {
                    prop_assert!((seen[k] - kept[k]).abs() <= 1e-4 * (seen[1] - seen[0]));
                }
            }
        }

        #[test]
        fn no_text_makes_it_panic(text in "[a-z0-9:/,.eE+-]{0,60}") {
            let _ = Zooms::read(&json!(text));
        }
    }
}
