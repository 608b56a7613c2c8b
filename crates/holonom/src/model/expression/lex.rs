//! From the text of an expression to tokens: numbers, names, operators, brackets.

use super::Mistake;

/// Longest expression, characters.
const LONGEST: usize = 10_000;

/// The names in an expression that are not called as functions, for finding what a parameter depends on.
pub(super) fn names(text: &str) -> Vec<String> {
    let tokens = lex(text).unwrap_or_default();
    let called = |k: usize| matches!(tokens.get(k + 1), Some((_, Token::Open)));
    let name = |(k, (_, token)): (usize, &(usize, Token))| match token {
        Token::Name(name) if !called(k) => Some(name.clone()),
        _ => None,
    };
    tokens.iter().enumerate().filter_map(name).collect()
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Name(String),
    Operator(char),
    Open,
    Close,
    Comma,
    End,
}

/// Tokens and the character at which each starts.
pub(super) fn lex(text: &str) -> Result<Vec<(usize, Token)>, Mistake> {
    let characters: Vec<char> = text.chars().take(LONGEST + 1).collect();
    if characters.len() > LONGEST {
        return Err(Mistake::new(0, format!("the expression is longer than {LONGEST} characters"), "split it over [parameters]"));
    }
    let (mut tokens, mut k) = (Vec::new(), 0);
    while k < characters.len() {
        let (start, c) = (k, characters[k]);
        k += 1;
        let token = match c {
            c if c.is_whitespace() => continue,
            '(' => Token::Open,
            ')' => Token::Close,
            ',' => Token::Comma,
            '*' if characters.get(k) == Some(&'*') => return Err(Mistake::new(start, "`**` is no operator", "powers are written with ^")),
            '+' | '-' | '*' | '/' | '^' => Token::Operator(c),
            '.' if start > 0 && characters[start - 1] == '\'' => {
                return Err(Mistake::new(start, "single quotes stand round a whole name", "write 'NAME.COLUMN', as 'left-strut.force'"));
            }
            '0'..='9' | '.' => {
                k = end_of_number(&characters, start);
                let text: String = characters[start..k].iter().collect();
                match text.parse() {
                    Ok(number) => Token::Number(number),
                    Err(_) => return Err(Mistake::new(start, format!("`{text}` is no number"), "write 0.5, 2 or 1e-3")),
                }
            }
            c if c.is_alphabetic() || c == '_' => {
                k = end_of_name(&characters, start)?;
                Token::Name(characters[start..k].iter().collect())
            }
            '\'' => {
                let Some(length) = characters[k..].iter().position(|&c| c == '\'') else {
                    return Err(Mistake::new(start, "this quote is never closed", "put names with other signs in single quotes: 'a-b.x'"));
                };
                k += length + 1;
                Token::Name(characters[start + 1..k - 1].iter().collect())
            }
            '=' | '<' | '>' => {
                let message = format!("`{c}` compares, and an expression is a number");
                return Err(Mistake::new(start, message, "write the difference of both sides, or step(a - b)"));
            }
            other => {
                return Err(Mistake::new(
                    start,
                    format!("`{other}` means nothing in an expression"),
                    "known are + - * / ^ ( ) and functions",
                ));
            }
        };
        tokens.push((start, token));
    }
    tokens.push((characters.len(), Token::End));
    Ok(tokens)
}

/// Where a name that starts at `start` ends: it goes on behind dots that a letter follows, and over indices in brackets.
fn end_of_name(characters: &[char], start: usize) -> Result<usize, Mistake> {
    let mut k = start;
    let begins = |k: usize| characters.get(k).is_some_and(|c| c.is_alphabetic() || *c == '_');
    loop {
        while characters.get(k).is_some_and(|c| c.is_alphanumeric() || *c == '_') {
            k += 1;
        }
        while characters.get(k) == Some(&'[') {
            match characters[k..].iter().position(|&c| c == ']') {
                Some(length) => k += length + 1,
                None => return Err(Mistake::new(k, "this bracket is never closed", "write \"NAME[i]\"")),
            }
        }
        if characters.get(k) != Some(&'.') || !begins(k + 1) {
            return Ok(k);
        }
        k += 1;
    }
}

/// Where a number that starts at `k` ends: digits, a point, and an exponent if there is a whole one.
fn end_of_number(characters: &[char], mut k: usize) -> usize {
    let digit = |k: usize| characters.get(k).is_some_and(char::is_ascii_digit);
    while digit(k) || characters.get(k) == Some(&'.') {
        k += 1;
    }
    if matches!(characters.get(k), Some('e' | 'E')) {
        let sign = usize::from(matches!(characters.get(k + 1), Some('+' | '-')));
        if digit(k + 1 + sign) {
            k += 1 + sign;
            while digit(k) {
                k += 1;
            }
        }
    }
    k
}
