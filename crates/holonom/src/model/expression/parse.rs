//! From the text of an expression to a program, by recursive descent; every mistake has a character and a cure.

use std::sync::Arc;

use super::functions::{CONSTANTS, FUNCTIONS, Function, OTHERS, SI, UNITS};
use super::lex::{Token, lex};
use super::names::{self, Names};
use super::{Mistake, Op, Program, Scope, Value};
use crate::model::fault::{nearest, suggest};
use crate::record::COLUMNS;

/// Deepest nesting of brackets, signs and powers.
const DEPTH: usize = 50;

/// Parses an expression of the given variables and of what `names` knows.
pub(super) fn parse(text: &str, variables: &[&str], names: &mut dyn Names, scope: &Scope<'_>) -> Result<Program, Mistake> {
    let tokens = lex(text)?;
    let mut parser = Parser { text, tokens: &tokens, at: 0, depth: 0, variables, names, scope, ops: Vec::new(), kept: Vec::new() };
    if tokens.len() == 1 {
        return Err(Mistake::new(0, "the expression is empty", "write a number or a formula"));
    }
    parser.sum()?;
    match parser.peek() {
        Token::End => Ok(Program::new(parser.ops, parser.kept)),
        Token::Close => Err(parser.mistake("this bracket was never opened", "remove it, or open one before")),
        Token::Comma => Err(parser.mistake("a comma only separates arguments of a function", "decimal numbers have a point: 0.5")),
        Token::Number(_) | Token::Name(_) | Token::Open => Err(parser.mistake("an operator is missing here", parser.as_product())),
        Token::Operator(_) => Err(parser.mistake("this cannot be here", "remove it")),
    }
}

/// An expression as far as it has been read.
pub(super) struct Parser<'a> {
    text: &'a str,
    pub(super) tokens: &'a [(usize, Token)],
    pub(super) at: usize,
    depth: usize,
    pub(super) variables: &'a [&'a str],
    pub(super) names: &'a mut dyn Names,
    pub(super) scope: &'a Scope<'a>,
    pub(super) ops: Vec<Op>,
    /// The measures whose numbers are kept, a cell each.
    pub(super) kept: Vec<Arc<str>>,
}

impl Parser<'_> {
    pub(super) fn peek(&self) -> &Token {
        &self.tokens[self.at].1
    }

    pub(super) fn mistake(&self, message: impl Into<String>, cure: impl Into<String>) -> Mistake {
        Mistake::new(self.tokens[self.at].0, message, cure)
    }

    /// How a product is written, of the number before this and the name here where that is what it looks like.
    fn as_product(&self) -> String {
        let (Some((start, Token::Number(_))), Token::Name(name)) = (self.at.checked_sub(1).map(|k| &self.tokens[k]), self.peek()) else {
            return "write 2*x, not 2x".into();
        };
        let number: String = self.text.chars().take(self.tokens[self.at].0).skip(*start).collect();
        let number = number.trim_end();
        let is_unit = UNITS.iter().any(|unit| unit.0 == name);
        if is_unit || name.contains('.') || !matches!(self.value_of(name), Ok(None)) {
            return format!("write {number}*{name}");
        }
        let units: Vec<&str> = UNITS.iter().map(|unit| unit.0).collect();
        let units = units.join(", ");
        format!("numbers are in SI units and radians, with no unit behind them: write {number}; known factors are {units}")
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

    pub(super) fn sum(&mut self) -> Result<(), Mistake> {
        self.product()?;
        while let Some(c) = self.operator(&['+', '-']) {
            self.product()?;
            self.emit(if c == '+' { Op::Add } else { Op::Sub });
        }
        Ok(())
    }

    fn product(&mut self) -> Result<(), Mistake> {
        self.signed()?;
        while let Some(c) = self.operator(&['*', '/']) {
            self.signed()?;
            self.emit(if c == '*' { Op::Mul } else { Op::Div });
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
                self.emit(Op::Neg);
            }
            Some(_) => self.signed()?,
            None => {
                self.operand()?;
                if self.operator(&['^']).is_some() {
                    self.signed()?;
                    self.power();
                }
            }
        }
        self.depth -= 1;
        Ok(())
    }

    /// Powers with a constant exponent have their own operations: right for negative bases, and so are the derivatives.
    pub(super) fn power(&mut self) {
        match self.ops.last() {
            Some(&Op::Constant(p)) => {
                self.ops.pop();
                self.emit(if p.fract() == 0.0 && p.abs() <= f64::from(i32::MAX) { Op::IntegerPower(p as i32) } else { Op::RealPower(p) });
            }
            _ => self.emit(Op::OfTwo(Function::Pow)),
        }
    }

    fn operand(&mut self) -> Result<(), Mistake> {
        match self.peek().clone() {
            Token::Number(number) => {
                self.at += 1;
                self.emit(Op::Constant(number));
                Ok(())
            }
            Token::Open => {
                self.at += 1;
                self.sum()?;
                self.close()
            }
            Token::Name(name) if matches!(self.tokens[self.at + 1].1, Token::Open) => self.call(&name),
            Token::Name(name) => {
                let op = self.value_of(&name)?;
                match op {
                    Some(op) => self.emit(op),
                    None => self.name(&name)?,
                }
                self.at += 1;
                Ok(())
            }
            Token::End => Err(self.mistake("the expression ends too early", "a number or a name is missing at its end")),
            _ => Err(self.mistake("a number or a name is missing here", "put one before this, or remove an operator")),
        }
    }

    pub(super) fn close(&mut self) -> Result<(), Mistake> {
        match self.peek() {
            Token::Close => {
                self.at += 1;
                Ok(())
            }
            Token::End => Err(self.mistake("a closing bracket is missing at the end", "add a )")),
            Token::Comma => {
                let is_number = |at: usize| matches!(self.tokens.get(at), Some((_, Token::Number(_))));
                let cure = match is_number(self.at - 1) && is_number(self.at + 1) {
                    true => "decimal numbers have a point: 0.5",
                    false => "remove the comma and what follows it, or call another function",
                };
                Err(self.mistake("there is no further argument here", cure))
            }
            _ => Err(self.mistake("an operator or a closing bracket is missing here", self.as_product())),
        }
    }

    /// What a mechanism does, by its name: a variable, or a formula of some; or a unit.
    fn name(&mut self, name: &str) -> Result<(), Mistake> {
        let at = self.tokens[self.at].0;
        let place = |mistake: Mistake| Mistake { character: at, ..mistake };
        let full = super::indexed(name, self.scope).map_err(|mistake| Mistake { character: at + mistake.character, ..mistake })?;
        if let Some(program) = self.names.formula(&full).map_err(place)? {
            return self.take_over(&full, &program);
        }
        let op = match self.names.variable(&full).map_err(place)? {
            Some(variable) => Op::Variable(self.variables.len() + variable),
            // Whatever the model calls so comes first.
            None => match UNITS.iter().find(|unit| unit.0 == name) {
                Some(&(_, value)) => Op::Constant(value),
                None => return Err(self.unknown(name)),
            },
        };
        self.emit(op);
        Ok(())
    }

    /// What a name stands for that is no name of something in the mechanism: a variable, an index or parameter, or a constant.
    pub(super) fn value_of(&self, name: &str) -> Result<Option<Op>, Mistake> {
        let variable = self.variables.iter().position(|&variable| variable == name);
        let value = self.scope.value(name);
        match (variable, value) {
            (Some(_), value) if value.is_some() || self.names.has(name) => {
                let what = if value.is_some() { "parameter or index" } else { "input or measure" };
                let message = format!("`{name}` could be the variable of this expression or what the model calls `{name}`");
                Err(self.mistake(message, format!("give the {what} another name")))
            }
            (Some(k), _) => Ok(Some(Op::Variable(k))),
            (None, Some(_)) if self.names.has(name) => {
                let what = if self.scope.indices.iter().any(|(index, _)| index == name) { "index" } else { "parameter" };
                let message = format!("`{name}` could be the {what} of this name or the column of results of this name");
                Err(self.mistake(message, format!("give the {what} another name")))
            }
            (None, Some(Value::Known(value))) => Ok(Some(Op::Constant(value))),
            (None, Some(Value::Faulty)) => Err(Mistake::known()),
            (None, None) => Ok(CONSTANTS.iter().find(|constant| constant.0 == name).map(|&(_, value)| Op::Constant(value))),
        }
    }

    pub(super) fn unknown(&self, name: &str) -> Mistake {
        let constants = CONSTANTS.iter().chain(UNITS).map(|constant| constant.0);
        // Parameters have no order of their own, and messages must be the same every time.
        let mut named: Vec<&str> = self.scope.names().collect();
        named.sort_unstable();
        let variables = self.variables.iter().copied().filter(|name| !name.is_empty());
        let known: Vec<&str> = variables.chain(named).chain(constants).collect();
        if FUNCTIONS.iter().any(|function| function.0 == name) {
            return self.mistake(format!("the function `{name}` needs its arguments"), format!("write {name}(…)"));
        }
        if self.scope.tables.is_some_and(|tables| tables.contains_key(name)) {
            return self.mistake(format!("the table `{name}` is a function and needs its argument"), format!("write {name}(…)"));
        }
        if self.scope.functions.is_some_and(|functions| functions.contains_key(name)) {
            return self.mistake(format!("the function `{name}` needs its arguments"), format!("write {name}(…)"));
        }
        if let Some(mistake) = self.scope.of_bar(name) {
            return self.mistake(mistake.message, mistake.cure);
        }
        if let Some(what @ ("an input" | "a measure")) = self.scope.called(name) {
            let message = format!("`{name}` is {what}, which cannot be read here: what this formula says must be known before the run");
            return self.mistake(message, "let a force read it, such as an `effort` that pushes towards it, or make it a parameter");
        }
        // A number that stays as it is reads nothing, and means a parameter.
        if COLUMNS[1..].contains(&name) && !self.variables.is_empty() {
            let message = format!("`{name}` is a column of every run, which only measures read, and no parameter");
            let cure = format!("read it in a [measure.NAME], write this by positions and velocities, or add `{name}` to [parameters]");
            return self.mistake(message, cure);
        }
        let of_mechanism = self.names.known();
        let message = format!("the name `{name}` is not known here");
        if name.contains('.') && of_mechanism.is_empty() {
            return self.mistake(
                message,
                "names with dots are of what moves: use them in measures, events, and forces of type effort, force, torque, expression, spring and rope",
            );
        }
        let all = || known.iter().copied().chain(of_mechanism.iter().map(String::as_str));
        // A name with a hyphen was read as a difference.
        let cut = all().find(|known| known.strip_prefix(name).is_some_and(|rest| rest.starts_with('-')));
        let beside = names::beside(name, &of_mechanism);
        let near = cut
            .or_else(|| if beside.is_empty() { nearest(name, all()) } else { names::nearest_beside(name, &beside) })
            .filter(|near| !(SI.contains(&name) && UNITS.iter().any(|unit| unit.0 == *near)));
        let other = OTHERS.iter().find(|unit| unit.0 == name);
        let cure = match near {
            _ if name == "π" => "write pi".into(),
            _ if let Some((_, value)) = other => format!("add {name} = \"{value}\" to [parameters]: numbers are in SI units and radians"),
            None if SI.contains(&name) => {
                format!("add `{name}` to [parameters], or leave it out if it is a unit: numbers are in SI units and radians")
            }
            Some(near) if near.contains('-') => format!("did you mean '{near}'? A name with a hyphen stands in single quotes here"),
            Some(near) => format!("did you mean `{near}`?"),
            None if !beside.is_empty() => format!("known are: {}", beside.join(", ")),
            None if name == "t" => {
                "this number stays as it is over time: what changes is a formula, as that of a force of type effort, or of a drive".into()
            }
            None if name.contains('.') => suggest(name, of_mechanism.iter().map(String::as_str)),
            None => {
                let known = suggest(name, known).replace("known are", "use what is known here");
                format!("add `{name}` to [parameters], or {known}")
            }
        };
        self.mistake(message, cure)
    }

    /// Appends an operation, or its result when all it works on is constant.
    pub(super) fn emit(&mut self, op: Op) {
        let takes = op.takes();
        // What a program gives is called when it runs.
        let is_external = matches!(op, Op::OfMany(..));
        let first = self.ops.len() - takes.min(self.ops.len());
        let constant = takes > 0 && !is_external && self.ops[first..].iter().all(|op| matches!(op, Op::Constant(_)));
        self.ops.push(op);
        if constant {
            let folded = Program::new(self.ops.drain(first..).collect(), Vec::new()).evaluate::<f64>(&[]);
            self.ops.push(Op::Constant(folded));
        }
    }
}
