//! Numbers as they are read on the screen, and as they are typed.

/// A text of numbers, units and symbols with decimal commas. Names such as `drive-0.5` and formulas, which are typed
/// with points, stay as they are.
pub fn with_comma(text: &str) -> String {
    if !text.contains('.') || text.contains('*') {
        return text.to_owned();
    }
    let chars: Vec<char> = text.chars().collect();
    let digit = |i: usize| chars.get(i).is_some_and(char::is_ascii_digit);
    // Past the digits that stand from here on.
    let past = |from: usize| {
        let digits = chars[from..].iter().take_while(|c| c.is_ascii_digit());
        from + digits.count()
    };
    let mut out: Vec<char> = chars.clone();
    let mut start = 0;
    while start < chars.len() {
        if !digit(start) {
            start += 1;
            continue;
        }
        let end = past(start);
        let point = chars.get(end) == Some(&'.') && digit(end + 1);
        let last = if point { past(end + 1) } else { end };
        let further = chars.get(last) == Some(&'.') && digit(last + 1);
        if point && !further && begins_a_number(&chars[..start]) {
            out[end] = ',';
        }
        start = last;
    }
    separated(out)
}

/// Whether a number can follow: no name and no version.
fn begins_a_number(before: &[char]) -> bool {
    match before {
        [.., name, '-'] => !name.is_alphabetic() && *name != '_',
        [.., last] => !last.is_alphanumeric() && !matches!(last, '_' | '.'),
        [] => true,
    }
}

/// Numbers with a comma are listed with semicolons.
fn separated(mut chars: Vec<char>) -> String {
    let decimal = |w: &[char]| w[0].is_ascii_digit() && w[1] == ',' && w[2].is_ascii_digit();
    if chars.windows(3).any(decimal) {
        for i in 1..chars.len().saturating_sub(2) {
            let listed = chars[i] == ',' && chars[i + 1] == ' ';
            let next = chars[i + 2];
            if listed && chars[i - 1].is_ascii_digit() && (next.is_ascii_digit() || next == '-') {
                chars[i] = ';';
            }
        }
    }
    chars.into_iter().collect()
}

/// A number as someone types it: with a point or a comma, and perhaps with spaces.
fn typed(text: &str) -> Option<f64> {
    let plain: String = text
        .chars()
        .filter(|c| !c.is_whitespace())
        .map(|c| match c {
            ',' => '.',
            '−' => '-',
            c => c,
        })
        .collect();
    plain.parse().ok()
}

/// A number as someone types it into a field of this unit: alone, or with a unit that measures the same, as `5 ms`
/// where seconds are meant.
pub fn typed_in(unit: &str) -> impl Fn(&str) -> Option<f64> {
    let shown = unit.trim().to_owned();
    move |text| {
        let (number, unit) = text.split_at(end_of_number(text));
        let number = typed(number)?;
        let unit = spelling(unit);
        if unit.is_empty() || unit == spelling(&shown) {
            return Some(number);
        }
        let (quantity, factor) = measure(&unit)?;
        let (wanted, shown) = measure(&spelling(&shown))?;
        (quantity == wanted).then_some(number * factor / shown)
    }
}

/// Where the number at the beginning of a text ends.
fn end_of_number(text: &str) -> usize {
    let letter = |c: char| c.is_alphabetic() || matches!(c, '°' | '%');
    let exponent = |at: usize| {
        let rest = text[at..].strip_prefix(['e', 'E']);
        let rest = rest.map(|r| r.strip_prefix(['+', '-', '−']).unwrap_or(r));
        rest.is_some_and(|r| r.starts_with(|c: char| c.is_ascii_digit()))
    };
    let mut letters = text.char_indices().filter(|(_, c)| letter(*c));
    letters
        .find(|(at, _)| !exponent(*at))
        .map_or(text.len(), |(at, _)| at)
}

/// A unit without what people write differently.
fn spelling(unit: &str) -> String {
    let kept = unit.chars().filter(|c| !" \u{a0}*·⋅^".contains(*c));
    let plain = kept.map(|c| match c {
        'µ' | 'μ' => 'u',
        '²' => '2',
        c => c,
    });
    plain.collect()
}

/// What a unit measures, by its SI unit, and its factor to that.
fn measure(unit: &str) -> Option<(&'static str, f64)> {
    const DEGREE: f64 = std::f64::consts::PI / 180.0;
    const TURN: f64 = std::f64::consts::TAU;
    Some(match unit {
        "s" => ("s", 1.0),
        "ms" => ("s", 1e-3),
        "us" => ("s", 1e-6),
        "min" => ("s", 60.0),
        "h" => ("s", 3600.0),
        "rad" => ("rad", 1.0),
        "mrad" => ("rad", 1e-3),
        "urad" => ("rad", 1e-6),
        "deg" | "°" => ("rad", DEGREE),
        "rev" => ("rad", TURN),
        "rad/s" => ("rad/s", 1.0),
        "mrad/s" => ("rad/s", 1e-3),
        "deg/s" | "°/s" => ("rad/s", DEGREE),
        "rpm" | "1/min" => ("rad/s", TURN / 60.0),
        "m" => ("m", 1.0),
        "cm" => ("m", 1e-2),
        "mm" => ("m", 1e-3),
        "um" => ("m", 1e-6),
        "m/s" => ("m/s", 1.0),
        "mm/s" => ("m/s", 1e-3),
        "N" => ("N", 1.0),
        "mN" => ("N", 1e-3),
        "kN" => ("N", 1e3),
        "Nm" => ("Nm", 1.0),
        "mNm" => ("Nm", 1e-3),
        "uNm" => ("Nm", 1e-6),
        "kNm" => ("Nm", 1e3),
        "Nms/rad" => ("Nms/rad", 1.0),
        "mNms/rad" => ("Nms/rad", 1e-3),
        "uNms/rad" => ("Nms/rad", 1e-6),
        "Nm/rad" => ("Nm/rad", 1.0),
        "mNm/rad" => ("Nm/rad", 1e-3),
        "kNm/rad" => ("Nm/rad", 1e3),
        "kgm2" => ("kgm2", 1.0),
        "kgcm2" => ("kgm2", 1e-4),
        "gcm2" => ("kgm2", 1e-7),
        "kgmm2" => ("kgm2", 1e-6),
        "gmm2" => ("kgm2", 1e-9),
        "kg" => ("kg", 1.0),
        "g" => ("kg", 1e-3),
        "Hz" => ("Hz", 1.0),
        "kHz" => ("Hz", 1e3),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_get_a_comma_and_nothing_else_does() {
        for (plain, shown) in [
            ("0.5 N m", "0,5 N m"),
            ("-1.25e-3 rad/s", "-1,25e-3 rad/s"),
            ("(0.5 ± 0.02) s", "(0,5 ± 0,02) s"),
            ("0.5-0.7 s", "0,5-0,7 s"),
            ("0.5, -0.3, 2", "0,5; -0,3; 2"),
            ("1, 6, 11", "1, 6, 11"),
            ("e^{-0.5s}", "e^{-0,5s}"),
            ("0.002 N m s^2/rad^2", "0,002 N m s^2/rad^2"),
            ("-0.5*x", "-0.5*x"),
            ("drive-0.5 a1.5 1.2.3", "drive-0.5 a1.5 1.2.3"),
            ("end 3. 4", "end 3. 4"),
        ] {
            assert_eq!(with_comma(plain), shown);
        }
    }

    #[test]
    fn a_number_is_typed_with_a_comma_or_a_point() {
        for text in ["1250.5", "1250,5", " 1 250,5 "] {
            assert_eq!(typed(text), Some(1250.5));
        }
        assert_eq!(typed("−0,5"), Some(-0.5));
        assert_eq!(typed("1.250,5"), None);
    }

    #[test]
    fn a_number_is_typed_with_a_unit_of_what_is_meant() {
        for (unit, text, value) in [
            ("s", "5 ms", 5e-3),
            ("ms", "0,02 s", 20.0),
            ("s", "1.5e-3s", 1.5e-3),
            ("s", "2e-3", 2e-3),
            ("mrad", "1°", 17.453_292_519_943_297),
            ("rad/s", "60 rpm", std::f64::consts::TAU),
            ("kg mm²", "8.8e-4 kg m^2", 880.0),
            ("mN m s/rad", "0.002 N m s/rad", 2.0),
            ("N m", "−300 mNm", -0.3),
            ("x", "3 x", 3.0),
            ("", "7", 7.0),
        ] {
            let typed = typed_in(unit)(text).expect(text);
            assert!((typed / value - 1.0).abs() < 1e-12, "{text}: {typed}");
        }
        for (unit, text) in [("s", "5 mm"), ("", "5 ms"), ("s", "ms"), ("s", "5 sheep")] {
            assert_eq!(typed_in(unit)(text), None, "{text}");
        }
    }
}
