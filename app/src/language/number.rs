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
pub fn typed(text: &str) -> Option<f64> {
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
}
