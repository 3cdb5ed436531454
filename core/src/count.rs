//! How many there are, as it is read: `1 switch`, `3 switches`.

use crate::message::Message;

/// A count with its noun, which is given for one.
pub fn counted(count: usize, noun: &str) -> Message {
    let hisses = ["s", "x", "ch", "sh"].iter().any(|end| noun.ends_with(end));
    let words = match count {
        1 => return Message::words(format!("1 {noun}")),
        _ if hisses => format!("{{}} {noun}es"),
        _ => format!("{{}} {noun}s"),
    };
    Message::Words(words.into(), vec![count.into()])
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_stands_alone() {
        let all = [0, 1, 2].map(|n| {
            [counted(n, "switch"), counted(n, "time")]
                .map(|c| c.to_string())
                .join(", ")
        });
        let wanted = [
            "0 switches, 0 times",
            "1 switch, 1 time",
            "2 switches, 2 times",
        ];
        assert_eq!(all, wanted);
    }
}
