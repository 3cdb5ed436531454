//! How many there are, as it is read: `1 switch`, `3 switches`.

/// A count with its noun, which is given for one.
pub fn counted(count: usize, noun: &str) -> String {
    let hisses = ["s", "x", "ch", "sh"].iter().any(|end| noun.ends_with(end));
    match count {
        1 => format!("1 {noun}"),
        _ if hisses => format!("{count} {noun}es"),
        _ => format!("{count} {noun}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_stands_alone() {
        let all = [0, 1, 2].map(|n| [counted(n, "switch"), counted(n, "time")].join(", "));
        let wanted = [
            "0 switches, 0 times",
            "1 switch, 1 time",
            "2 switches, 2 times",
        ];
        assert_eq!(all, wanted);
    }
}
