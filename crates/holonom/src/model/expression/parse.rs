//! From the text of an expression to a program, by recursive descent; every mistake has a character and a cure.

use super::functions::{CONSTANTS, FUNCTIONS, Function, real_power};
use super::{Mistake, Op, Program, STACK, Scope, Value};
use crate::model::fault::{nearest, suggest};

/// Deepest nesting of brackets, signs and powers.
const DEPTH: usize = 50;

/// Longest expression, characters.
const LONGEST: usize = 10_000;

/// Parses an expression of the given variables.
pub(super) fn parse(text: &str, variables: &[&str], scope: &Scope<'_>) -> Result<Program, Mistake> {
    let tokens = lex(text)?;
    let mut parser = Parser { tokens: &tokens, at: 0, depth: 0, variables, scope, ops: Vec::new(), used: 0 };
    if tokens.len() == 1 {
        return Err(Mistake::new(0, "the expression is empty", "write a number or a formula"));
    }
    parser.sum()?;
    match parser.peek() {
        Token::End => Ok(Program { ops: parser.ops.into_boxed_slice() }),
        Token::Close => Err(parser.mistake("this bracket was never opened", "remove it, or open one before")),
        Token::Comma => Err(parser.mistake("a comma only separates arguments of a function", "decimal numbers have a point: 0.5")),
        Token::Number(_) | Token::Name(_) | Token::Open => Err(parser.mistake("an operator is missing here", "write 2*x, not 2x")),
        Token::Operator(_) => Err(parser.mistake("this cannot be here", "remove it")),
    }
}

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
enum Token {
    Number(f64),
    Name(String),
    Operator(char),
    Open,
    Close,
    Comma,
    End,
}

/// Tokens and the character at which each starts.
fn lex(text: &str) -> Result<Vec<(usize, Token)>, Mistake> {
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
            '0'..='9' | '.' => {
                k = end_of_number(&characters, start);
                let text: String = characters[start..k].iter().collect();
                match text.parse() {
                    Ok(number) => Token::Number(number),
                    Err(_) => return Err(Mistake::new(start, format!("`{text}` is no number"), "write 0.5, 2 or 1e-3")),
                }
            }
            c if c.is_alphabetic() || c == '_' => {
                while k < characters.len() && (characters[k].is_alphanumeric() || characters[k] == '_') {
                    k += 1;
                }
                Token::Name(characters[start..k].iter().collect())
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

struct Parser<'a> {
    tokens: &'a [(usize, Token)],
    at: usize,
    depth: usize,
    variables: &'a [&'a str],
    scope: &'a Scope<'a>,
    ops: Vec<Op>,
    /// Numbers on the stack after the operations so far.
    used: usize,
}

impl Parser<'_> {
    fn peek(&self) -> &Token {
        &self.tokens[self.at].1
    }

    fn mistake(&self, message: impl Into<String>, cure: impl Into<String>) -> Mistake {
        Mistake::new(self.tokens[self.at].0, message, cure)
    }

    /// Moves on if the next token is an operator among `wanted`, and says which.
    fn operator(&mut self, wanted: &[char]) -> Option<char> {
        match self.peek() {
            Token::Operator(c) if wanted.contains(c) => {
                let c = *c;
                self.at += 1;
                Some(c)
            }
            _ => None,
        }
    }

    fn sum(&mut self) -> Result<(), Mistake> {
        self.product()?;
        while let Some(c) = self.operator(&['+', '-']) {
            self.product()?;
            self.emit(if c == '+' { Op::Add } else { Op::Sub })?;
        }
        Ok(())
    }

    fn product(&mut self) -> Result<(), Mistake> {
        self.signed()?;
        while let Some(c) = self.operator(&['*', '/']) {
            self.signed()?;
            self.emit(if c == '*' { Op::Mul } else { Op::Div })?;
        }
        Ok(())
    }

    /// A sign binds weaker than a power: -2^2 is -4.
    fn signed(&mut self) -> Result<(), Mistake> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.mistake("brackets, signs and powers are nested too deep here", "split the expression over [parameters]"));
        }
        match self.operator(&['+', '-']) {
            Some('-') => {
                self.signed()?;
                self.emit(Op::Neg)?;
            }
            Some(_) => self.signed()?,
            None => {
                self.operand()?;
                if self.operator(&['^']).is_some() {
                    self.signed()?;
                    self.power()?;
                }
            }
        }
        self.depth -= 1;
        Ok(())
    }

    /// Powers with a constant exponent have their own operations: right for negative bases, and so are the derivatives.
    fn power(&mut self) -> Result<(), Mistake> {
        match self.ops.last() {
            Some(&Op::Constant(p)) => {
                self.ops.pop();
                self.used -= 1;
                self.emit(if p.fract() == 0.0 && p.abs() <= f64::from(i32::MAX) { Op::IntegerPower(p as i32) } else { Op::RealPower(p) })
            }
            _ => self.emit(Op::OfTwo(Function::Pow)),
        }
    }

    fn operand(&mut self) -> Result<(), Mistake> {
        match self.peek().clone() {
            Token::Number(number) => {
                self.at += 1;
                self.emit(Op::Constant(number))
            }
            Token::Open => {
                self.at += 1;
                self.sum()?;
                self.close()
            }
            Token::Name(name) if matches!(self.tokens[self.at + 1].1, Token::Open) => self.call(&name),
            Token::Name(name) => {
                let op = self.value_of(&name)?;
                self.at += 1;
                self.emit(op)
            }
            Token::End => Err(self.mistake("the expression ends too early", "a number or a name is missing at its end")),
            _ => Err(self.mistake("a number or a name is missing here", "put one before this, or remove an operator")),
        }
    }

    fn close(&mut self) -> Result<(), Mistake> {
        match self.peek() {
            Token::Close => {
                self.at += 1;
                Ok(())
            }
            Token::End => Err(self.mistake("a closing bracket is missing at the end", "add a )")),
            Token::Comma => Err(self.mistake("there is no further argument here", "decimal numbers have a point: 0.5")),
            _ => Err(self.mistake("an operator or a closing bracket is missing here", "write 2*x, not 2x")),
        }
    }

    fn call(&mut self, name: &str) -> Result<(), Mistake> {
        let Some(&(_, arguments, function)) = FUNCTIONS.iter().find(|known| known.0 == name) else {
            let is_value = self.value_of(name).is_ok();
            let cure = if is_value { format!("write {name}*(…)") } else { suggest(name, FUNCTIONS.iter().map(|known| known.0)) };
            return Err(self.mistake(format!("`{name}` is no function"), cure));
        };
        let start = self.tokens[self.at].0;
        self.at += 2;
        for k in 0..arguments {
            if k > 0 {
                match self.peek() {
                    Token::Comma => self.at += 1,
                    _ => return Err(Mistake::new(start, format!("`{name}` takes {arguments} arguments"), format!("write {name}(a, b)"))),
                }
            }
            self.sum()?;
        }
        self.close()?;
        match (function, arguments) {
            (Function::Pow, _) => self.power(),
            (_, 1) => self.emit(Op::OfOne(function)),
            _ => self.emit(Op::OfTwo(function)),
        }
    }

    /// What a name stands for: a variable, an index or parameter, or a constant.
    fn value_of(&self, name: &str) -> Result<Op, Mistake> {
        let variable = self.variables.iter().position(|&variable| variable == name);
        let value = self.scope.value(name);
        match (variable, value) {
            (Some(_), Some(_)) => {
                let message = format!("`{name}` could be the variable of this expression or what the model calls `{name}`");
                Err(self.mistake(message, "give the parameter or index another name"))
            }
            (Some(k), None) => Ok(Op::Variable(k as u8)),
            (None, Some(Value::Known(value))) => Ok(Op::Constant(value)),
            (None, Some(Value::Faulty)) => Err(Mistake { known: true, ..self.mistake("", "") }),
            (None, None) => match CONSTANTS.iter().find(|constant| constant.0 == name) {
                Some(&(_, value)) => Ok(Op::Constant(value)),
                None => Err(self.unknown(name)),
            },
        }
    }

    fn unknown(&self, name: &str) -> Mistake {
        let constants = CONSTANTS.iter().map(|constant| constant.0);
        // Parameters have no order of their own, and messages must be the same every time.
        let mut named: Vec<&str> = self.scope.names().collect();
        named.sort_unstable();
        let known: Vec<&str> = self.variables.iter().copied().chain(named).chain(constants).collect();
        if FUNCTIONS.iter().any(|function| function.0 == name) {
            return self.mistake(format!("the function `{name}` needs its arguments"), format!("write {name}(…)"));
        }
        let cure = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("add `{name}` to [parameters], or use what is {}", suggest(name, known).replace("known are", "known here")),
        };
        self.mistake(format!("the name `{name}` is not known here"), cure)
    }

    /// Appends an operation, or its result when all it works on is constant.
    fn emit(&mut self, op: Op) -> Result<(), Mistake> {
        let takes = match op {
            Op::Constant(_) | Op::Variable(_) => 0,
            Op::Neg | Op::IntegerPower(_) | Op::RealPower(_) | Op::OfOne(_) => 1,
            Op::Add | Op::Sub | Op::Mul | Op::Div | Op::OfTwo(_) => 2,
        };
        self.used = self.used + 1 - takes;
        if self.used > STACK {
            return Err(self.mistake("this expression holds too many numbers at once", "split it over [parameters]"));
        }
        let first = self.ops.len() - takes.min(self.ops.len());
        let constant = takes > 0 && self.ops[first..].iter().all(|op| matches!(op, Op::Constant(_)));
        self.ops.push(op);
        if constant {
            let folded = Program { ops: self.ops[first..].into() }.evaluate::<f64>(&[]);
            self.ops.truncate(first);
            self.ops.push(Op::Constant(folded));
        }
        Ok(())
    }
}

impl Op {
    /// x^p of the two kinds with a constant exponent.
    #[inline]
    pub(super) fn power<N: crate::system::Number>(self, x: N) -> N {
        match self {
            Self::IntegerPower(n) => x.powi(n),
            Self::RealPower(p) => real_power(x, p),
            _ => unreachable!("no power"),
        }
    }
}
