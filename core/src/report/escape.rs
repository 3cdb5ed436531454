//! Text from anywhere as text of a page.

/// Text from anywhere as text of a page: no tag, no attribute, no invisible character comes through.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(' '),
            // Marks that turn the direction of the text round can make it read as something else.
            '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {}
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::escape;

    #[test]
    fn nothing_from_a_file_becomes_markup() {
        assert_eq!(
            escape("<script src='//x'>\u{7}&\"\u{202e}x\n</script>"),
            "&lt;script src=&#39;//x&#39;&gt;&amp;&quot;x &lt;/script&gt;"
        );
    }
}
