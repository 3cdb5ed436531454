//! Numbers that are typed into a field: with a unit that measures the same, and within the field's range. What is
//! refused leaves the value as it was, and is said at the foot of the window.

use std::ops::RangeInclusive;

use egui::{Context, DragValue, Id, Slider};
use hysteron_core::message::Message;
use hysteron_core::msg;

use crate::language::typed_in;

/// Decimals that the fields of sliders show.
pub const DECIMALS: usize = 3;

/// A field that a number is typed into.
#[derive(Clone, Debug)]
pub struct Typed {
    unit: String,
    range: RangeInclusive<f64>,
    decimals: usize,
    /// What stands in the field.
    present: f64,
}

impl Typed {
    /// The field of the value `present` in a unit, with so many decimals.
    pub fn new(present: f64, unit: &str, range: RangeInclusive<f64>, decimals: usize) -> Self {
        Self {
            unit: unit.trim().to_owned(),
            range,
            decimals,
            present,
        }
    }

    /// A slider whose number is typed so. While it is typed it counts for nothing: "2" on the way to "2 ms" is
    /// no 2 s.
    pub fn slider<'a>(self, ctx: &Context, value: &'a mut f64) -> Slider<'a> {
        Slider::new(value, self.range.clone())
            .max_decimals(self.decimals)
            .update_while_editing(false)
            .custom_parser(self.parser(ctx))
    }

    /// A field without a slider.
    pub fn field<'a>(self, ctx: &Context, value: &'a mut f64) -> DragValue<'a> {
        DragValue::new(value)
            .range(self.range.clone())
            .max_decimals(self.decimals)
            .update_while_editing(false)
            .custom_parser(self.parser(ctx))
    }

    fn parser(self, ctx: &Context) -> impl Fn(&str) -> Option<f64> + use<> {
        let ctx = ctx.clone();
        move |text| {
            self.read(text).unwrap_or_else(|why| {
                ctx.data_mut(|data| data.insert_temp(place(), why));
                None
            })
        }
    }

    /// The number that a text stands for; nothing where it says what stands there already.
    fn read(&self, text: &str) -> Result<Option<f64>, Message> {
        let text = text.trim();
        if text.is_empty() {
            return Ok(None);
        }
        let Some(number) = typed_in(&self.unit)(text) else {
            let wanted = match self.unit.as_str() {
                "" | "1" => "enter a number without a unit".into(),
                unit => msg!("enter a number in {}", Message::name(unit)),
            };
            return Err(msg!("{} is not accepted: {}.", Message::name(text), wanted));
        };
        // A value from elsewhere may have more decimals than are shown, and lie beyond the range.
        if number == egui::emath::round_to_decimals(self.present, self.decimals) {
            return Ok(None);
        }
        if self.range.contains(&number) {
            return Ok(Some(number));
        }
        let [from, to] = [self.range.start(), self.range.end()]
            .map(|end| egui::emath::round_to_decimals(*end, 9));
        let limits = match self.unit.as_str() {
            "" => msg!("the range is {} to {}", from, to),
            unit => msg!("the range is {} to {}", from, format!("{to} {unit}")),
        };
        Err(msg!("{} is not accepted: {}.", Message::name(text), limits))
    }
}

/// Where it is noted what was refused.
fn place() -> Id {
    Id::unique("refused_number")
}

/// What was refused since it was last asked for, in one sentence.
pub fn refused(ctx: &Context) -> Option<Message> {
    ctx.data_mut(|data| data.remove_temp(place()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_beyond_the_range_is_refused_and_none_is_rounded_by_being_shown() {
        let field = Typed::new(0.250_04, "s", 0.0..=2.0, DECIMALS);
        assert_eq!(field.read("300 ms"), Ok(Some(0.3)));
        assert_eq!(field.read("0.25"), Ok(None));
        assert_eq!(field.read(" "), Ok(None));
        for text in ["3", "-0.1", "2000.1 ms", "1 kg", "much"] {
            assert!(field.read(text).is_err(), "{text}");
        }
    }
}
