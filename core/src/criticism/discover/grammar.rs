//! Terms of formulas, built from the bottom up.
//!
//! ```text
//! variable  x, v, u, t of a drive; y, u, t of a process
//! plain     z  z^2  z^3  |z|  z|z|  sign z  root of |z|      of one variable
//! bend      a function of one variable and a number or two, which make its argument a plain number
//! form      products of plains, of at most one bend, and of a coefficient
//! ```
//!
//! A number in a bend has the unit of its variable (or its inverse), and every form a coefficient, which has the unit
//! that makes it a force: so every formula is right in its units by the way it is built.

use crate::effect::{Variable, variables};
use crate::measurement::Kind;

/// As one types it.
fn name(variable: Variable, kind: Kind) -> &'static str {
    let mut all = variables(kind).iter();
    all.find(|(_, own)| *own == variable)
        .map_or("", |(name, _)| name)
}

/// A factor without a number in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Plain {
    Value,
    Square,
    Cube,
    Size,
    SignedSquare,
    Sign,
    Root,
    SignedRoot,
}

impl Plain {
    pub const ALL: [Self; 8] = [
        Self::Value,
        Self::Square,
        Self::Cube,
        Self::Size,
        Self::SignedSquare,
        Self::Sign,
        Self::Root,
        Self::SignedRoot,
    ];

    /// Factors that go with others.
    const BESIDE: [Self; 4] = [Self::Value, Self::Sign, Self::Size, Self::Square];
    const BESIDE_BENDS: [Self; 3] = [Self::Value, Self::Sign, Self::Size];

    /// At a value with this sign, which may be between -1 and 1 where noise hides it.
    pub fn at(self, z: f64, sign: f64) -> f64 {
        match self {
            Self::Value => z,
            Self::Square => z * z,
            Self::Cube => z * z * z,
            Self::Size => z.abs(),
            Self::SignedSquare => z * z.abs(),
            Self::Sign => sign,
            Self::Root => z.abs().sqrt(),
            Self::SignedRoot => sign * z.abs().sqrt(),
        }
    }

    fn text(self, z: &str) -> String {
        match self {
            Self::Value => z.to_owned(),
            Self::Square => format!("{z}^2"),
            Self::Cube => format!("{z}^3"),
            Self::Size => format!("abs({z})"),
            Self::SignedSquare => format!("{z}*abs({z})"),
            Self::Sign => format!("sign({z})"),
            Self::Root => format!("sqrt(abs({z}))"),
            Self::SignedRoot => format!("sign({z})*sqrt(abs({z}))"),
        }
    }
}

/// A function of one variable with numbers in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bend {
    /// `exp(-|z|/s)`.
    Decay,
    /// `1 - exp(-|z|/s)`.
    Rise,
    /// `exp(-(z/s)^2)`.
    Bell,
    /// `1/(s + |z|)`.
    Fading,
    /// `1/(s^2 + z^2)`.
    Resonant,
    /// `1/sqrt(s^2 + z^2)`.
    Leaning,
    /// `ln(1 + |z|/s)`.
    Log,
    /// `sqrt(s^2 + z^2)`.
    Length,
    /// `tanh(z/s)`.
    Tanh,
    /// `atan(z/s)`.
    Atan,
    /// `exp(z/s)`.
    Growth,
    /// `exp(-z/s)`.
    Fall,
    /// `max(z - c, 0)`.
    Above,
    /// `min(z - c, 0)`.
    Below,
    /// `exp(-((z - c)/w)^2)`.
    Bump,
    /// `sin(n z + p)`; the phase is linear, by a sine and a cosine.
    Wave,
}

/// What the numbers of a bend are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbers {
    Scale,
    Centre,
    CentreAndWidth,
    WaveNumber,
}

impl Bend {
    const ALL: [Self; 16] = [
        Self::Decay,
        Self::Rise,
        Self::Bell,
        Self::Fading,
        Self::Resonant,
        Self::Leaning,
        Self::Log,
        Self::Length,
        Self::Tanh,
        Self::Atan,
        Self::Growth,
        Self::Fall,
        Self::Above,
        Self::Below,
        Self::Bump,
        Self::Wave,
    ];

    pub fn numbers(self) -> Numbers {
        match self {
            Self::Above | Self::Below => Numbers::Centre,
            Self::Bump => Numbers::CentreAndWidth,
            Self::Wave => Numbers::WaveNumber,
            _ => Numbers::Scale,
        }
    }

    /// Whether it is the same for `z` and `-z`.
    fn is_even(self) -> bool {
        matches!(
            self,
            Self::Decay
                | Self::Rise
                | Self::Bell
                | Self::Fading
                | Self::Resonant
                | Self::Leaning
                | Self::Log
                | Self::Length
        )
    }

    /// Its values; the sine and the cosine of a wave.
    pub fn at(self, z: f64, [p, q]: [f64; 2]) -> [f64; 2] {
        let w = z / p;
        let one = match self {
            Self::Decay => libm::exp(-w.abs()),
            Self::Rise => -libm::expm1(-w.abs()),
            Self::Bell => libm::exp(-w * w),
            Self::Fading => 1.0 / (p + z.abs()),
            Self::Resonant => 1.0 / (p * p + z * z),
            Self::Leaning => 1.0 / libm::hypot(p, z),
            Self::Log => libm::log1p(w.abs()),
            Self::Length => libm::hypot(p, z),
            Self::Tanh => libm::tanh(w),
            Self::Atan => libm::atan(w),
            Self::Growth => libm::exp(w),
            Self::Fall => libm::exp(-w),
            Self::Above => (z - p).max(0.0),
            Self::Below => (z - p).min(0.0),
            Self::Bump => libm::exp(-((z - p) / q).powi(2)),
            Self::Wave => return [libm::sin(p * z), libm::cos(p * z)],
        };
        [one, 0.0]
    }

    /// Columns that it makes.
    pub fn columns(self) -> usize {
        1 + usize::from(self == Self::Wave)
    }

    /// As a factor, or as a divisor, with these names of its numbers (and of the phase).
    fn text(self, z: &str, [p, q]: [&str; 2]) -> (String, bool) {
        let factor = |text: String| (text, false);
        let divisor = |text: String| (text, true);
        match self {
            Self::Decay => factor(format!("exp(-abs({z})/{p})")),
            Self::Rise => factor(format!("(1-exp(-abs({z})/{p}))")),
            Self::Bell => factor(format!("exp(-({z}/{p})^2)")),
            Self::Fading => divisor(format!("({p}+abs({z}))")),
            Self::Resonant => divisor(format!("({p}^2+{z}^2)")),
            Self::Leaning => divisor(format!("sqrt({p}^2+{z}^2)")),
            Self::Log => factor(format!("ln(1+abs({z})/{p})")),
            Self::Length => factor(format!("sqrt({p}^2+{z}^2)")),
            Self::Tanh => factor(format!("tanh({z}/{p})")),
            Self::Atan => factor(format!("atan({z}/{p})")),
            Self::Growth => factor(format!("exp({z}/{p})")),
            Self::Fall => factor(format!("exp(-{z}/{p})")),
            Self::Above => factor(format!("max({z}-{p},0)")),
            Self::Below => factor(format!("min({z}-{p},0)")),
            Self::Bump => factor(format!("exp(-(({z}-{p})/{q})^2)")),
            Self::Wave => factor(format!("sin({p}*{z}+{q})")),
        }
    }
}

/// A product without its coefficient, and without the values of its numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Form {
    pub plain: Vec<(Variable, Plain)>,
    pub bend: Option<(Bend, Variable)>,
}

/// Names of coefficients, numbers and phases; none is a variable or a constant.
const COEFFICIENTS: [&str; 3] = ["a", "b", "h"];
const SCALES: [&str; 3] = ["s", "r", "k"];
const CENTRES: [&str; 3] = ["c", "d", "f"];
const WIDTHS: [&str; 3] = ["w", "g", "l"];
const WAVES: [&str; 3] = ["n", "m", "o"];
const PHASES: [&str; 3] = ["p", "q", "j"];

impl Form {
    /// Whether it follows a variable.
    pub fn has(&self, variable: Variable) -> bool {
        self.plain.iter().any(|(v, _)| *v == variable)
            || self.bend.is_some_and(|(_, v)| v == variable)
    }

    /// Names of the coefficient, of its numbers and, for a wave, of its phase, in the place of a sum.
    pub fn symbols(&self, place: usize) -> Vec<&'static str> {
        let at = |names: [&'static str; 3]| names[place.min(2)];
        let mut symbols = vec![at(COEFFICIENTS)];
        match self.bend.map(|(bend, _)| bend.numbers()) {
            None => {}
            Some(Numbers::Scale) => symbols.push(at(SCALES)),
            Some(Numbers::Centre) => symbols.push(at(CENTRES)),
            Some(Numbers::CentreAndWidth) => symbols.extend([at(CENTRES), at(WIDTHS)]),
            Some(Numbers::WaveNumber) => symbols.extend([at(WAVES), at(PHASES)]),
        }
        symbols
    }

    /// As one types it, with its coefficient.
    pub fn text(&self, kind: Kind, place: usize) -> String {
        let symbols = self.symbols(place);
        let symbol = |k: usize| symbols.get(k).copied().unwrap_or("");
        let mut text = symbol(0).to_owned();
        for (variable, plain) in &self.plain {
            text.push('*');
            text.push_str(&plain.text(name(*variable, kind)));
        }
        if let Some((bend, variable)) = self.bend {
            let (factor, divides) = bend.text(name(variable, kind), [symbol(1), symbol(2)]);
            text.push(if divides { '/' } else { '*' });
            text.push_str(&factor);
        }
        text
    }
}

/// Parts of a formula: names, numbers and signs, without brackets and commas.
pub(super) fn length(text: &str) -> usize {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    let mut count = 0;
    let mut before = false;
    for c in text.chars() {
        let part = is_part(c);
        count += usize::from(part && !before || "+-*/^".contains(c));
        before = part;
    }
    count
}

/// Bends that go with a factor of another variable.
const BESIDE_OTHERS: [Bend; 8] = [
    Bend::Decay,
    Bend::Bell,
    Bend::Fading,
    Bend::Resonant,
    Bend::Tanh,
    Bend::Above,
    Bend::Bump,
    Bend::Wave,
];

/// Every form, shorter ones first.
pub(super) fn forms(kind: Kind) -> Vec<Form> {
    let variables: Vec<Variable> = variables(kind).iter().map(|(_, z)| *z).collect();
    let mut forms = vec![Form {
        plain: Vec::new(),
        bend: None,
    }];
    let mut add = |plain: Vec<(Variable, Plain)>, bend: Option<(Bend, Variable)>| {
        forms.push(Form { plain, bend });
    };
    for (k, z) in variables.iter().enumerate() {
        for plain in Plain::ALL {
            add(vec![(*z, plain)], None);
        }
        for other in &variables[k + 1..] {
            for a in Plain::BESIDE {
                for b in Plain::BESIDE {
                    add(vec![(*z, a), (*other, b)], None);
                }
            }
        }
        for bend in Bend::ALL {
            // Machines repeat along the way and in time.
            let repeats = matches!(z, Variable::Position | Variable::Time);
            if bend == Bend::Wave && !repeats || bend == Bend::Bump && *z == Variable::Input {
                continue;
            }
            add(Vec::new(), Some((bend, *z)));
            if bend.is_even() {
                for own in [Plain::Value, Plain::Sign, Plain::Size, Plain::SignedSquare] {
                    add(vec![(*z, own)], Some((bend, *z)));
                }
                add(vec![(*z, Plain::Cube)], Some((bend, *z)));
            }
            if BESIDE_OTHERS.contains(&bend) {
                for other in variables.iter().filter(|other| *other != z) {
                    for beside in Plain::BESIDE_BENDS {
                        add(vec![(*other, beside)], Some((bend, *z)));
                    }
                }
            }
        }
    }
    forms.sort_by_key(|form| length(&form.text(kind, 0)));
    forms
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::{Dimension, Formula};

    #[test]
    fn every_form_is_a_formula_with_units() {
        for kind in [Kind::Drive, Kind::Process] {
            for form in forms(kind) {
                let formula = Formula {
                    name: "form".to_owned(),
                    text: form.text(kind, 0),
                };
                let effect = formula
                    .effect(kind)
                    .unwrap_or_else(|e| panic!("{formula:?}: {e}"));
                let mut known = form.symbols(0);
                let mut symbols: Vec<&str> = effect.parameters().iter().map(|p| p.symbol).collect();
                known.sort_unstable();
                symbols.sort_unstable();
                assert_eq!(known, symbols, "{formula:?}");
                for p in effect.parameters() {
                    // A root of a length has no unit that files know.
                    let odd = formula.text.contains("sqrt(abs");
                    assert!(
                        odd || p.dimension != Dimension::Undetermined,
                        "{formula:?}: {}",
                        p.symbol
                    );
                }
            }
        }
    }

    #[test]
    fn the_length_counts_names_numbers_and_signs() {
        assert_eq!(length("a*v"), 3);
        assert_eq!(length("a*tanh(v/s)"), 6);
        assert_eq!(length("-a*exp(-((x-b)/c)^2)"), 12);
        assert_eq!(length(""), 0);
    }

    #[test]
    fn a_form_is_worth_what_its_text_says() {
        let form = Form {
            plain: vec![(Variable::Velocity, Plain::Value)],
            bend: Some((Bend::Fading, Variable::Velocity)),
        };
        assert_eq!(form.text(Kind::Drive, 0), "a*v/(s+abs(v))");
        let at = Plain::Value.at(-3.0, -1.0) * Bend::Fading.at(-3.0, [1.5, 0.0])[0];
        assert_eq!(at, -3.0 / 4.5);
    }
}
