//! Lists as they are typed on the command line.

/// The parts between the commas that stand outside brackets and quotes, without the blanks around them.
pub fn items(text: &str) -> Vec<&str> {
    let (mut items, mut depth, mut quote, mut start) = (Vec::new(), 0, None, 0);
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => (),
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{' | '(') => depth += 1,
            (None, ']' | '}' | ')') => depth -= 1,
            (None, ',') if depth == 0 => {
                items.push(text[start..at].trim());
                start = at + 1;
            }
            _ => (),
        }
    }
    items.push(text[start..].trim());
    items
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_in_brackets_and_quotes_are_part_of_an_item() {
        assert_eq!(items("m.x, at(m.y, 0.5),[1, 2]"), ["m.x", "at(m.y, 0.5)", "[1, 2]"]);
        assert_eq!(items("\"a,b\",'c,d',sin(t,1)"), ["\"a,b\"", "'c,d'", "sin(t,1)"]);
        assert_eq!(items(" ,a"), ["", "a"]);
    }
}
