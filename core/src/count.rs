//! How many there are, as it is read: `1 switch`, `3 switches`.

/// A count with its noun: the words for one, and those for many with the number in their `{}`.
#[macro_export]
macro_rules! counted {
    ($count:expr, $one:literal, $many:literal) => {
        match $count {
            1 => $crate::message::Message::from($one),
            many => $crate::msg!($many, many),
        }
    };
}

#[cfg(test)]
mod tests {
    #[test]
    fn one_stands_alone() {
        let all = [0_usize, 1, 2].map(|n| counted!(n, "1 switch", "{} switches").to_string());
        assert_eq!(all, ["0 switches", "1 switch", "2 switches"]);
    }
}
