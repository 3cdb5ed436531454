//! Formulas as one types them: `-a*exp(-((x-b)/c)^2)`.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = factor { ("*" | "/") factor }
//! factor  = { "+" | "-" } primary [ "^" factor ]
//! primary = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//! ```
//!
//! A name that is no variable and no constant is a parameter.

use crate::measurement::Kind;
use crate::message::{Message, says};
use crate::msg;

/// Longest formula, characters.
pub const MAX_FORMULA: usize = 300;

/// Most parameters of a formula.
pub const MAX_PARAMETERS: usize = 8;

/// Longest name of a parameter, characters.
const MAX_NAME: usize = 12;

/// Deepest nesting.
const MAX_DEPTH: usize = 30;

/// Why a text is no formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct FormulaError {
    /// Where, in characters from 1.
    pub column: usize,
    /// What is wrong and what would be right.
    pub message: Message,
}

impl FormulaError {
    /// In words.
    pub fn message(&self) -> Message {
        msg!("column {}: {}", &self.column, &self.message)
    }
}

says!(FormulaError);

/// What a formula may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Position of a drive.
    Position,
    /// Velocity of a drive, output of a process.
    Velocity,
    /// Input that reaches the body.
    Input,
    /// Time since the first sample, s.
    Time,
}

impl Variable {
    /// Name of the axis that it is of such a system, as a missing part has it.
    pub fn axis(self, kind: Kind) -> &'static str {
        match (self, kind) {
            (Self::Position, _) => "position",
            (Self::Velocity, Kind::Drive) => "velocity",
            (Self::Velocity, Kind::Process) => "output",
            (Self::Input, _) => "input",
            (Self::Time, _) => "time",
        }
    }
}

/// A function of one number or two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Atan,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
    Min,
    Max,
}

/// Names of functions and how many arguments they take.
const FUNCTIONS: [(&str, Function, usize); 13] = [
    ("sin", Function::Sin, 1),
    ("cos", Function::Cos, 1),
    ("tan", Function::Tan, 1),
    ("atan", Function::Atan, 1),
    ("tanh", Function::Tanh, 1),
    ("exp", Function::Exp, 1),
    ("ln", Function::Ln, 1),
    ("log", Function::Ln, 1),
    ("sqrt", Function::Sqrt, 1),
    ("abs", Function::Abs, 1),
    ("sign", Function::Sign, 1),
    ("min", Function::Min, 2),
    ("max", Function::Max, 2),
];

/// A formula as a tree.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Expr {
    Number(f64),
    Variable(Variable),
    /// Index among the parameters.
    Parameter(usize),
    Negative(Box<Expr>),
    Sum(Box<Expr>, Box<Expr>),
    Difference(Box<Expr>, Box<Expr>),
    Product(Box<Expr>, Box<Expr>),
    Quotient(Box<Expr>, Box<Expr>),
    Power(Box<Expr>, Box<Expr>),
    Call(Function, Vec<Expr>),
}

/// Variables of this kind of system, as one types them.
pub fn variables(kind: Kind) -> &'static [(&'static str, Variable)] {
    match kind {
        Kind::Drive => &[
            ("x", Variable::Position),
            ("v", Variable::Velocity),
            ("u", Variable::Input),
            ("t", Variable::Time),
        ],
        Kind::Process => &[
            ("y", Variable::Velocity),
            ("u", Variable::Input),
            ("t", Variable::Time),
        ],
    }
}

/// The tree and the names of the parameters in order of appearance.
pub(super) fn parse(text: &str, kind: Kind) -> Result<(Expr, Vec<String>), FormulaError> {
    let all: Vec<char> = text.chars().take(MAX_FORMULA + 1).collect();
    let mut parser = Parser {
        text: &all,
        at: 0,
        depth: 0,
        kind,
        parameters: Vec::new(),
    };
    if all.len() > MAX_FORMULA {
        return parser.fail_at(
            MAX_FORMULA,
            msg!(
                "the formula is too long: at most {} characters",
                MAX_FORMULA
            ),
        );
    }
    parser.skip();
    if parser.at == all.len() {
        return parser.fail(match kind {
            Kind::Drive => "the formula is empty: write a force such as -a*exp(-((x-b)/c)^2)",
            Kind::Process => "the formula is empty: write an input such as -a*exp(-((y-b)/c)^2)",
        });
    }
    let tree = parser.sum()?;
    if let Some(c) = parser.peek() {
        return parser.fail(match c {
            ')' => "')' closes nothing: remove it or add an opening one before it".into(),
            ',' => "',' is not understood: write decimals with a point, such as 0.5".into(),
            c if c.is_alphanumeric() || c == '(' => {
                "an operator is missing here: write * for a product".into()
            }
            c => msg!(
                "'{}' is not understood: expected +, -, *, /, ^ or the end",
                Message::name(c)
            ),
        });
    }
    if parser.parameters.is_empty() {
        return parser.fail_at(
            0,
            match kind {
                Kind::Drive => "there is no parameter to fit: give one a name, such as a in -a*v^3",
                Kind::Process => {
                    "there is no parameter to fit: give one a name, such as a in -a*y^3"
                }
            },
        );
    }
    Ok((tree, parser.parameters))
}

struct Parser<'t> {
    text: &'t [char],
    at: usize,
    depth: usize,
    kind: Kind,
    parameters: Vec<String>,
}

impl Parser<'_> {
    fn fail<T>(&self, message: impl Into<Message>) -> Result<T, FormulaError> {
        self.fail_at(self.at, message)
    }

    #[expect(clippy::unused_self, reason = "reads like fail")]
    fn fail_at<T>(&self, index: usize, message: impl Into<Message>) -> Result<T, FormulaError> {
        Err(FormulaError {
            column: index + 1,
            message: message.into(),
        })
    }

    fn skip(&mut self) {
        while self.text.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
    }

    /// The next character that is no space.
    fn peek(&mut self) -> Option<char> {
        self.skip();
        self.text.get(self.at).copied()
    }

    fn take(&mut self, wanted: char) -> bool {
        let there = self.peek() == Some(wanted);
        self.at += usize::from(there);
        there
    }

    fn sum(&mut self) -> Result<Expr, FormulaError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return self.fail(msg!("nested too deeply: at most {} levels", MAX_DEPTH));
        }
        let mut left = self.product()?;
        loop {
            if self.take('+') {
                left = Expr::Sum(Box::new(left), Box::new(self.product()?));
            } else if self.take('-') {
                left = Expr::Difference(Box::new(left), Box::new(self.product()?));
            } else {
                self.depth -= 1;
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<Expr, FormulaError> {
        let mut left = self.factor()?;
        loop {
            if self.take('*') {
                if self.text.get(self.at) == Some(&'*') {
                    return self.fail("write ^ for a power");
                }
                left = Expr::Product(Box::new(left), Box::new(self.factor()?));
            } else if self.take('/') {
                left = Expr::Quotient(Box::new(left), Box::new(self.factor()?));
            } else {
                return Ok(left);
            }
        }
    }

    fn factor(&mut self) -> Result<Expr, FormulaError> {
        let mut negative = false;
        loop {
            if self.take('-') {
                negative = !negative;
            } else if !self.take('+') {
                break;
            }
        }
        let mut value = self.primary()?;
        if self.take('^') {
            self.depth += 1;
            if self.depth > MAX_DEPTH {
                return self.fail(msg!("nested too deeply: at most {} levels", MAX_DEPTH));
            }
            value = Expr::Power(Box::new(value), Box::new(self.factor()?));
            self.depth -= 1;
        }
        Ok(if negative {
            Expr::Negative(Box::new(value))
        } else {
            value
        })
    }

    fn primary(&mut self) -> Result<Expr, FormulaError> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let inner = self.sum()?;
                if self.take(')') {
                    Ok(inner)
                } else {
                    self.fail("')' is missing")
                }
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            Some(c) => self.fail(msg!(
                "'{}' is not understood: expected a number, a name or '('",
                Message::name(c)
            )),
            None => self.fail("the formula ends too early: expected a number, a name or '('"),
        }
    }

    fn number(&mut self) -> Result<Expr, FormulaError> {
        let start = self.at;
        let mut text = String::new();
        while let Some(c) = self.text.get(self.at).copied() {
            let exponent = matches!(text.chars().last(), Some('e' | 'E'));
            let digit_follows = |at: usize| self.text.get(at).is_some_and(char::is_ascii_digit);
            let begins_exponent = matches!(c, 'e' | 'E')
                && !text.contains(['e', 'E'])
                && (digit_follows(self.at + 1)
                    || (matches!(self.text.get(self.at + 1), Some('+' | '-'))
                        && digit_follows(self.at + 2)));
            if c.is_ascii_digit() || c == '.' || begins_exponent || (exponent && "+-".contains(c)) {
                text.push(c);
                self.at += 1;
            } else {
                break;
            }
        }
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Expr::Number(value)),
            _ => self.fail_at(start, msg!("'{}' is not a number", Message::name(text))),
        }
    }

    fn name(&mut self) -> Result<Expr, FormulaError> {
        let start = self.at;
        let mut name = String::new();
        while let Some(c) = self.text.get(self.at).copied() {
            if !(c.is_ascii_alphanumeric() || c == '_') {
                break;
            }
            name.push(c);
            self.at += 1;
        }
        if self.peek() == Some('(') {
            return self.call(&name, start);
        }
        if name == "pi" {
            return Ok(Expr::Number(std::f64::consts::PI));
        }
        if let Some((_, variable)) = variables(self.kind).iter().find(|(n, _)| *n == name) {
            return Ok(Expr::Variable(*variable));
        }
        let wrong = match (name.as_str(), self.kind) {
            ("", _) => Some("names consist of letters a to z, digits and _".into()),
            ("e", _) => Some("write exp(...) for powers of e".into()),
            ("x" | "v", Kind::Process) => Some(msg!(
                "a process has no {}; it has y, u and t",
                Message::name(&name)
            )),
            ("y", Kind::Drive) => Some("a drive has no y; it has x, v, u and t".into()),
            (n, _) if FUNCTIONS.iter().any(|f| f.0 == n) => Some(msg!(
                "{} is a function: write {}(...)",
                Message::name(n),
                Message::name(n)
            )),
            (n, _) if n.len() > MAX_NAME => Some(msg!(
                "the name is too long: at most {} characters",
                MAX_NAME
            )),
            _ => None,
        };
        if let Some(message) = wrong {
            return self.fail_at(start, message);
        }
        let known = self.parameters.iter().position(|p| *p == name);
        let index = known.unwrap_or(self.parameters.len());
        if index == MAX_PARAMETERS {
            return self.fail_at(
                start,
                msg!("too many parameters: at most {}", MAX_PARAMETERS),
            );
        }
        if known.is_none() {
            self.parameters.push(name);
        }
        Ok(Expr::Parameter(index))
    }

    fn call(&mut self, name: &str, start: usize) -> Result<Expr, FormulaError> {
        let Some((_, function, count)) = FUNCTIONS.iter().find(|f| f.0 == name) else {
            let names: Vec<&str> = FUNCTIONS.iter().map(|f| f.0).collect();
            return self.fail_at(
                start,
                msg!(
                    "'{}' is not a function; the functions are {}; a product needs *",
                    Message::name(name),
                    Message::name(names.join(", "))
                ),
            );
        };
        self.take('(');
        let mut arguments = vec![self.sum()?];
        while self.take(',') {
            arguments.push(self.sum()?);
        }
        if !self.take(')') {
            return self.fail("')' is missing");
        }
        if arguments.len() != *count {
            return self.fail_at(
                start,
                msg!(
                    "{} takes {} argument(s), not {}",
                    Message::name(name),
                    count,
                    arguments.len()
                ),
            );
        }
        Ok(Expr::Call(*function, arguments))
    }
}
