//! Plants as one types them: `1/(s+1)^3`, `2 e^{-0.5s}/(3s+1)`, `(1-s)/(s^2+2s+1)`.
//!
//! ```text
//! sum     = term { ("+" | "-") term }
//! term    = factor { ["*" | "/"] factor }
//! factor  = { "+" | "-" } primary [ ("^" | "**") whole number ]
//! primary = number | "s" | "(" sum ")" | "exp(" sum ")" | "e^" ( "(" sum ")" | "{" sum "}" )
//! ```
//!
//! What stands next to each other is multiplied; directly after a division that would be unclear
//! (`1/s(s+1)`), so that it is refused with a word on what to write instead.

use super::zero_pole_gain::product;
use super::{MAX_ORDER, PlantError, TransferFunction};
use crate::message::{Message, says};
use crate::msg;

/// Longest text that is read, in characters.
pub const MAX_TEXT: usize = 500;

/// Deepest nesting of parentheses.
const MAX_DEPTH: usize = 30;

/// Highest order within a calculation.
const MAX_DEGREE: usize = 2 * MAX_ORDER;

/// Why a text is no plant.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParseError {
    /// Something in the text.
    Text {
        /// Where, in characters from 1.
        column: usize,
        /// What is wrong and what would be right.
        message: Message,
    },
    /// The text can be read, but is not a plant.
    Plant(#[from] PlantError),
}

impl ParseError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Text { column, message } => {
                msg!("column {}: {}", column, message)
            }
            Self::Plant(error) => error.message(),
        }
    }
}

says!(ParseError);

/// Reads a transfer function in `s`; a part before `=`, such as `P(s) =`, is passed over.
///
/// # Errors
/// The column and what would be right there, or why the result is not a plant.
pub fn parse(text: &str) -> Result<TransferFunction, ParseError> {
    let all: Vec<char> = text.chars().take(MAX_TEXT + 1).collect();
    if all.len() > MAX_TEXT {
        return fail(
            MAX_TEXT,
            msg!("the text is too long: at most {} characters", MAX_TEXT),
        );
    }
    let at = all.iter().position(|c| *c == '=').map_or(0, |i| i + 1);
    let mut parser = Parser {
        text: &all,
        at,
        depth: 0,
    };
    parser.skip();
    if parser.at == all.len() {
        return parser.error("the text is empty: write a transfer function such as 1/(s+1)^3");
    }
    let value = parser.sum()?;
    if let Some(c) = parser.peek() {
        return parser.error(match c {
            ')' | '}' => msg!(
                "'{}' closes nothing: remove it or add an opening one before it",
                Message::name(c)
            ),
            ',' => "',' is not understood: write decimals with a point, such as 0.5".into(),
            c => msg!(
                "'{}' is not understood: expected +, -, *, / or the end",
                Message::name(c)
            ),
        });
    }
    value.plant()
}

fn fail<T>(index: usize, message: impl Into<Message>) -> Result<T, ParseError> {
    Err(ParseError::Text {
        column: index + 1,
        message: message.into(),
    })
}

/// `numerator / denominator e^{-delay s}`, highest power first, without leading zeros.
#[derive(Clone, Debug)]
struct Value {
    numerator: Vec<f64>,
    denominator: Vec<f64>,
    delay: f64,
}

fn trim(mut p: Vec<f64>) -> Vec<f64> {
    let zeros = p.iter().take_while(|c| **c == 0.0).count();
    p.drain(..zeros);
    p
}

fn sum(a: &[f64], b: &[f64], sign: f64) -> Vec<f64> {
    let n = a.len().max(b.len());
    let mut p = vec![0.0; n];
    for (i, c) in a.iter().rev().enumerate() {
        p[n - 1 - i] += c;
    }
    for (i, c) in b.iter().rev().enumerate() {
        p[n - 1 - i] += sign * c;
    }
    trim(p)
}

impl Value {
    fn number(value: f64) -> Self {
        Self {
            numerator: trim(vec![value]),
            denominator: vec![1.0],
            delay: 0.0,
        }
    }

    fn times(&self, other: &Self) -> Self {
        Self {
            numerator: product(&self.numerator, &other.numerator),
            denominator: product(&self.denominator, &other.denominator),
            delay: self.delay + other.delay,
        }
    }

    fn inverse(&self) -> Self {
        Self {
            numerator: self.denominator.clone(),
            denominator: self.numerator.clone(),
            delay: -self.delay,
        }
    }

    fn plus(&self, other: &Self, sign: f64) -> Self {
        let (numerator, denominator) = if self.denominator == other.denominator {
            (
                sum(&self.numerator, &other.numerator, sign),
                self.denominator.clone(),
            )
        } else {
            (
                sum(
                    &product(&self.numerator, &other.denominator),
                    &product(&other.numerator, &self.denominator),
                    sign,
                ),
                product(&self.denominator, &other.denominator),
            )
        };
        Self {
            numerator,
            denominator,
            delay: if self.numerator.is_empty() {
                other.delay
            } else {
                self.delay
            },
        }
    }

    /// The highest order, for bounds on what is still computed.
    fn degree(&self) -> usize {
        self.numerator
            .len()
            .max(self.denominator.len())
            .saturating_sub(1)
    }

    fn plant(mut self) -> Result<TransferFunction, ParseError> {
        // A common power of s cancels exactly.
        while self.numerator.len() > 1
            && self.denominator.len() > 1
            && self.numerator.last() == Some(&0.0)
            && self.denominator.last() == Some(&0.0)
        {
            self.numerator.pop();
            self.denominator.pop();
        }
        let plant = TransferFunction {
            numerator: self.numerator,
            denominator: self.denominator,
            dead_time: self.delay,
        };
        plant.validate()?;
        Ok(plant)
    }
}

struct Parser<'a> {
    text: &'a [char],
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn error<T>(&self, message: impl Into<Message>) -> Result<T, ParseError> {
        fail(self.at, message)
    }

    fn skip(&mut self) {
        while self.text.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
    }

    fn peek(&mut self) -> Option<char> {
        self.skip();
        self.text.get(self.at).copied()
    }

    fn eat(&mut self, wanted: &[char]) -> bool {
        let found = self.peek().is_some_and(|c| wanted.contains(&c));
        if found {
            self.at += 1;
        }
        found
    }

    fn word(&self) -> String {
        self.text[self.at.min(self.text.len())..]
            .iter()
            .take_while(|c| c.is_alphabetic())
            .take(20)
            .collect()
    }

    fn sum(&mut self) -> Result<Value, ParseError> {
        let mut value = self.term()?;
        loop {
            self.skip();
            let at = self.at;
            let sign = if self.eat(&['+']) {
                1.0
            } else if self.eat(&['-', '−', '–']) {
                -1.0
            } else {
                return Ok(value);
            };
            let next = self.term()?;
            let one_is_zero = value.numerator.is_empty() || next.numerator.is_empty();
            if value.delay != next.delay && !one_is_zero {
                return fail(
                    at,
                    "both sides must have the same dead time: write it once as a factor of the whole, such as e^{-s} \
                     (s+2)/(s+1)^2",
                );
            }
            value = Self::bounded(at, value.plus(&next, sign))?;
        }
    }

    fn bounded(at: usize, value: Value) -> Result<Value, ParseError> {
        if value.degree() > MAX_DEGREE {
            return fail(
                at,
                msg!("the order becomes too high: at most {}", MAX_ORDER),
            );
        }
        if value
            .numerator
            .iter()
            .chain(&value.denominator)
            .any(|c| !c.is_finite())
        {
            return fail(at, "a coefficient becomes too large: choose other units");
        }
        Ok(value)
    }

    /// Whether a factor begins here without an operator before it.
    fn factor_begins(&mut self) -> bool {
        self.peek()
            .is_some_and(|c| c == '(' || c == '.' || c.is_ascii_digit() || c.is_alphabetic())
    }

    fn exponential_begins(&self) -> bool {
        let word = self.word();
        word == "exp" || word == "e"
    }

    fn term(&mut self) -> Result<Value, ParseError> {
        let mut value = self.factor()?;
        let mut divided = false;
        loop {
            self.skip();
            let at = self.at;
            let slash = self.eat(&['/', '÷']);
            if !slash && !self.eat(&['*', '·', '×', '⋅']) {
                if !self.factor_begins() {
                    return Ok(value);
                }
                if divided && !self.exponential_begins() {
                    return self.error(
                        "is this below the fraction line or not? Put all that is below in parentheses, such as \
                         1/(s(s+1))",
                    );
                }
            }
            let factor = self.factor()?;
            if slash && factor.numerator.is_empty() {
                return fail(at, "division by zero");
            }
            divided = slash;
            let factor = if slash { factor.inverse() } else { factor };
            value = Self::bounded(at, value.times(&factor))?;
        }
    }

    fn factor(&mut self) -> Result<Value, ParseError> {
        let mut sign = 1.0;
        loop {
            if self.eat(&['-', '−', '–']) {
                sign = -sign;
            } else if !self.eat(&['+']) {
                break;
            }
        }
        let mut value = self.primary()?;
        self.skip();
        let at = self.at;
        let double = self.text[at..].starts_with(&['*', '*']);
        if double {
            self.at += 2;
        }
        if double || self.eat(&['^']) {
            value = self.power(at, &value)?;
        }
        value.numerator.iter_mut().for_each(|c| *c *= sign);
        Ok(value)
    }

    fn power(&mut self, at: usize, base: &Value) -> Result<Value, ParseError> {
        let brace = self.eat(&['{', '(']);
        let negative = self.eat(&['-', '−', '–']);
        self.skip();
        let digits: String = self.text[self.at..]
            .iter()
            .take_while(|c| c.is_ascii_digit())
            .take(3)
            .collect();
        let exponent = digits.parse::<usize>().ok().filter(|e| *e <= MAX_DEGREE);
        let Some(exponent) = exponent else {
            return self.error(msg!(
                "the exponent must be a whole number up to {}",
                MAX_DEGREE
            ));
        };
        self.at += digits.len();
        if self.text.get(self.at).is_some_and(|c| c == &'.') {
            return self.error("the exponent must be a whole number");
        }
        if brace && !self.eat(&['}', ')']) {
            return self.error("expected a closing bracket after the exponent");
        }
        if negative && base.numerator.is_empty() {
            return fail(at, "division by zero");
        }
        let base = if negative {
            base.inverse()
        } else {
            base.clone()
        };
        let mut value = Value::number(1.0);
        for _ in 0..exponent {
            value = Self::bounded(at, value.times(&base))?;
        }
        Ok(value)
    }

    fn primary(&mut self) -> Result<Value, ParseError> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                self.inside(')')
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            Some(c) => self.error(msg!(
                "'{}' is not understood: expected a number, s or (",
                Message::name(c)
            )),
            None => self.error("the text ends too early: expected a number, s or ("),
        }
    }

    /// A sum and the bracket that closes it; the opening one is read.
    fn inside(&mut self, close: char) -> Result<Value, ParseError> {
        let open = self.at.saturating_sub(1);
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return fail(
                open,
                msg!("too many brackets inside each other: at most {}", MAX_DEPTH),
            );
        }
        let value = self.sum()?;
        self.depth -= 1;
        if !self.eat(&[close]) {
            return match self.peek() {
                Some(',') => {
                    self.error("',' is not understood: write decimals with a point, such as 0.5")
                }
                Some(c) => self.error(msg!(
                    "'{}' is not understood: expected an operator or '{}'",
                    Message::name(c),
                    Message::name(close)
                )),
                None => fail(
                    open,
                    msg!(
                        "this bracket is never closed: add '{}'",
                        Message::name(close)
                    ),
                ),
            };
        }
        Ok(value)
    }

    fn number(&mut self) -> Result<Value, ParseError> {
        let start = self.at;
        let digit = |i: usize| self.text.get(i).is_some_and(char::is_ascii_digit);
        let mut end = start;
        while digit(end) {
            end += 1;
        }
        if self.text.get(end) == Some(&'.') {
            end += 1;
            while digit(end) {
                end += 1;
            }
        }
        // 2e-3 is a number, 2e^{-s} is not.
        if matches!(self.text.get(end), Some('e' | 'E')) {
            let signed = matches!(self.text.get(end + 1), Some('-' | '+'));
            let first = end + 1 + usize::from(signed);
            if digit(first) {
                end = first;
                while digit(end) {
                    end += 1;
                }
            }
        }
        let text: String = self.text[start..end].iter().collect();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.at = end;
                Ok(Value::number(value))
            }
            _ => self.error(msg!("'{}' is not a usable number", Message::name(text))),
        }
    }

    fn name(&mut self) -> Result<Value, ParseError> {
        let start = self.at;
        let word = self.word();
        // `ss` or `se^{-s}` is a product without a sign.
        if word.starts_with(['s', 'S'])
            && (word.len() == 1 || word.starts_with("ss") || word.starts_with("se"))
        {
            self.at += 1;
            return Ok(Value {
                numerator: vec![1.0, 0.0],
                denominator: vec![1.0],
                delay: 0.0,
            });
        }
        let close = match word.as_str() {
            "exp" => {
                self.at += 3;
                if !self.eat(&['(']) {
                    return self.error("expected ( after exp, such as exp(-0.5 s)");
                }
                Some(')')
            }
            "e" => {
                self.at += 1;
                if !self.eat(&['^']) {
                    return self.error("expected ^ after e, such as e^{-0.5s}");
                }
                if self.eat(&['{']) {
                    Some('}')
                } else if self.eat(&['(']) {
                    Some(')')
                } else {
                    None
                }
            }
            _ => {
                return self.error(msg!(
                    "'{}' is not known: write numbers, s and e^{-Ls} with a number for L",
                    Message::name(word)
                ));
            }
        };
        let exponent = match close {
            Some(close) => self.inside(close)?,
            None => self.bare_exponent()?,
        };
        delay_of(start, &exponent)
    }

    /// The exponent of `e^-0.5s`, written without brackets.
    fn bare_exponent(&mut self) -> Result<Value, ParseError> {
        if !self.eat(&['-', '−', '–']) {
            return self.error("expected {-Ls} after e^, such as e^{-0.5s}");
        }
        let mut value = if self.peek().is_some_and(|c| c.is_ascii_digit() || c == '.') {
            self.number()?
        } else {
            Value::number(1.0)
        };
        if !self.eat(&['s', 'S']) {
            return self.error("expected s in the exponent, such as e^{-0.5s}");
        }
        value.numerator.push(0.0);
        value.numerator.iter_mut().for_each(|c| *c = -*c);
        Ok(value)
    }
}

/// The factor `e^{-Ls}` with the exponent given.
fn delay_of(at: usize, exponent: &Value) -> Result<Value, ParseError> {
    let proportional = exponent.denominator.len() == 1 && exponent.delay == 0.0;
    match exponent.numerator.as_slice() {
        [] => Ok(Value::number(1.0)),
        [slope, constant] if proportional && *constant == 0.0 => {
            let delay = -slope / exponent.denominator[0];
            if delay < 0.0 {
                return fail(
                    at,
                    "the exponent of a dead time must be negative, such as e^{-0.5s}: no plant looks ahead",
                );
            }
            Ok(Value {
                delay,
                ..Value::number(1.0)
            })
        }
        _ => fail(
            at,
            "the exponent must be a number times -s, such as e^{-0.5s}",
        ),
    }
}
