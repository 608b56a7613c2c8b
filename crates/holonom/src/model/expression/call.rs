//! Calls in expressions: functions of numbers, tables, functions of places and of whole runs, and those that a program gives.

use super::curve::refusal;
use super::functions::{FUNCTIONS, Function};
use super::lex::Token;
use super::names::{self, LOCAL, OF_PLACES, RUNNING};
use super::parse::Parser;
use super::{External, Functions, Mistake, Op, Program};
use crate::model::GROUND;
use crate::model::fault::nearest;

/// Names of all functions.
fn functions() -> impl Iterator<Item = &'static str> + Clone {
    let of_numbers = FUNCTIONS.iter().map(|known| known.0);
    let of_runs = RUNNING.iter().map(|known| known.0).filter(|name| !FUNCTIONS.iter().any(|known| known.0 == *name));
    of_numbers.chain(of_runs).chain(OF_PLACES.iter().map(|known| known.0)).chain([LOCAL.0])
}

/// What to write in space where `local` is not known.
const IN_BODY_AXES: &str = "give a force or torque in body axes by axes = \"body\", a spring along = \"BODY.AXIS\"; for a component take two places of the \
                            body one metre apart along the axis: (BODY.Q.x - BODY.P.x)*BODY.vx + (BODY.Q.y - BODY.P.y)*BODY.vy + (BODY.Q.z - BODY.P.z)*BODY.vz";

/// How to pass smoothly from one value to another.
const SMOOTHLY: &str = "h0 + (h1 - h0)*u^2*(3 - 2*u) with u = max(0, min((x - x0)/(x1 - x0), 1)), which passes smoothly from h0 to h1; a drive does so by \
                        profile = { table = [[t0, h0], [t1, h1]], ends = \"rest\" }";

/// Functions that other programs have, and how their values are written here.
const ELSEWHERE: &[(&str, &str)] = &[
    ("log", "ln(x), or log10(x)"),
    ("ceil", "-floor(-x)"),
    ("round", "floor(x + 0.5)"),
    ("heaviside", "step(x)"),
    ("if", "step(x)*a + (1 - step(x))*b, which is a from x = 0 on and b below"),
    ("cot", "1/tan(x)"),
    ("clamp", "max(low, min(x, high))"),
    ("saturate", "max(0, min(x, 1))"),
    ("hypot", "sqrt(x^2 + y^2)"),
    ("smoothstep", SMOOTHLY),
    ("smooth", SMOOTHLY),
    ("step5", SMOOTHLY),
    ("havsin", SMOOTHLY),
    ("mean", "integral(x)/integral(1), where measures know it"),
];

/// The function that a name calls, and which of its values.
fn external(functions: &Functions, name: &str) -> Result<Option<(External, usize)>, Mistake> {
    let (base, index) = name.split_once('[').map_or((name, None), |(base, index)| (base, Some(index)));
    let Some(function) = functions.get(base) else { return Ok(None) };
    let values = function.values();
    let value = match index {
        None if values == 1 => Some(0),
        None => None,
        Some(index) => index.strip_suffix(']').and_then(|index| index.parse().ok()).filter(|&value| value < values),
    };
    match value {
        Some(value) => Ok(Some((function.clone(), value))),
        None => {
            let message = format!("`{base}` has {values} value{}", if values == 1 { "" } else { "s" });
            let last = values - 1;
            let cure = if values == 1 { format!("write {base}(…)") } else { format!("write {base}[0](…) to {base}[{last}](…)") };
            Err(Mistake::new(0, message, cure))
        }
    }
}

impl Parser<'_> {
    /// A function of what is in brackets behind its name.
    pub(super) fn call(&mut self, name: &str) -> Result<(), Mistake> {
        let start = self.tokens[self.at].0;
        if let Some(tables) = self.scope.tables
            && let Some(curve) = tables.get(name)
        {
            let Some(curve) = curve else { return Err(Mistake::known()) };
            let curve = curve.clone();
            self.at += 2;
            self.sum()?;
            self.close()?;
            if let Some(Op::Constant(argument)) = self.ops.last()
                && curve.refuses(*argument)
            {
                let [message, cure] = refusal(name, &curve, *argument);
                return Err(Mistake::new(start, message, cure));
            }
            self.emit(Op::OfTable(curve));
            return Ok(());
        }
        if let Some(functions) = self.scope.functions
            && let Some((function, value)) = external(functions, name).map_err(|inner| Mistake { character: start, ..inner })?
        {
            return self.call_external(name, function, value);
        }
        if OF_PLACES.iter().any(|known| known.0 == name) {
            return self.of_places(name);
        }
        if name == LOCAL.0 {
            return self.local();
        }
        let function = FUNCTIONS.iter().find(|known| known.0 == name);
        let running = RUNNING.iter().find(|known| known.0 == name);
        if function.is_none() && running.is_none() {
            let is_value = matches!(self.value_of(name), Ok(Some(_)));
            let tables = self.scope.tables.into_iter().flat_map(|tables| tables.keys().map(String::as_str));
            let given = self.scope.functions.into_iter().flat_map(|functions| functions.keys().map(String::as_str));
            let mut known: Vec<&str> = tables.chain(given).collect();
            known.sort_unstable();
            functions().for_each(|name| known.push(name));
            let elsewhere = ELSEWHERE.iter().find(|spelt| spelt.0.eq_ignore_ascii_case(name));
            let cure = match (elsewhere, nearest(name, known.iter().copied())) {
                _ if is_value => format!("write {name}*(…)"),
                (Some((_, here)), _) => format!("write {here}"),
                (None, Some(near)) => format!("did you mean `{near}`?"),
                (None, None) => format!("functions are {}", known.join(", ")),
            };
            return Err(self.mistake(format!("`{name}` is no function"), cure));
        }
        self.at += 2;
        let begin = self.ops.len();
        self.sum()?;
        if let (Some(&(_, running)), Token::Close) = (running, self.peek()) {
            self.at += 1;
            let inner = Program::new(self.ops.drain(begin..).collect(), Vec::new());
            let Some(variable) = self.names.running(running, inner) else {
                let message = match function {
                    Some(_) => format!("`{name}` takes 2 arguments; of one number it is the largest or smallest of a run so far"),
                    None => format!("`{name}` is of a whole run so far"),
                };
                return Err(Mistake::new(start, message, format!("use {name}(…) in a [measure.NAME] that no force and no event reads")));
            };
            self.emit(Op::Variable(self.variables.len() + variable));
            return Ok(());
        }
        let Some(&(_, arguments, function)) = function else {
            return Err(Mistake::new(start, format!("`{name}` takes one argument"), format!("write {name}(a)")));
        };
        for _ in 1..arguments {
            match self.peek() {
                Token::Comma => self.at += 1,
                _ => return Err(Mistake::new(start, format!("`{name}` takes {arguments} arguments"), format!("write {name}(a, b)"))),
            }
            self.sum()?;
        }
        if *self.peek() == Token::Comma && matches!(function, Function::Min | Function::Max) {
            return Err(self.mistake(format!("`{name}` takes {arguments} arguments"), format!("write {name}(a, {name}(b, c))")));
        }
        if *self.peek() == Token::Comma && function == Function::Step {
            return Err(
                self.mistake(format!("`{name}` takes 1 argument: it is 0 below x = 0 and 1 from there on"), format!("write {SMOOTHLY}"))
            );
        }
        self.close()?;
        match (function, arguments) {
            (Function::Pow, _) => self.power(),
            (_, 1) => self.emit(Op::OfOne(function)),
            _ => self.emit(Op::OfTwo(function)),
        }
        Ok(())
    }

    /// A value of a function that a program gives.
    fn call_external(&mut self, name: &str, function: External, value: usize) -> Result<(), Mistake> {
        let (start, count) = (self.tokens[self.at].0, function.arguments());
        self.at += 1;
        let mut given = 0;
        while given == 0 || *self.peek() == Token::Comma {
            self.at += 1;
            self.sum()?;
            given += 1;
        }
        if given != count {
            let plural = if count == 1 { "" } else { "s" };
            let message = format!("`{name}` takes {count} argument{plural}, and these are {given}");
            return Err(Mistake::new(start, message, "separate arguments by commas"));
        }
        self.close()?;
        self.emit(Op::OfMany(function, value));
        Ok(())
    }

    /// A function of places, such as `distance(A, B)`, written out as a formula of their coordinates.
    fn of_places(&mut self, name: &str) -> Result<(), Mistake> {
        let start = self.tokens[self.at].0;
        let &(_, count, example) = OF_PLACES.iter().find(|known| known.0 == name).expect("it is one of these");
        let axes = self.axes_of(name, "places")?;
        let places = self.named(count, &format!("`{name}` takes {count} names of places"), example)?;
        for (place, begin) in places.iter().filter(|(place, _)| place != GROUND) {
            self.is_place(place, &axes[..1]).map_err(|mistake| Mistake { character: *begin, ..mistake })?;
        }
        self.have_directions(name, &places)?;
        let places: Vec<String> = places.into_iter().map(|(place, _)| place).collect();
        self.written_out(start, &names::of_places(name, &places, axes))
    }

    /// Refuses an angle or a speed along a line from a place to itself, which has no direction.
    fn have_directions(&self, name: &str, places: &[(String, usize)]) -> Result<(), Mistake> {
        let wanted = match name {
            "angle" => "angle(A, B, C) is at B, between the lines from there to A and to C",
            "speed" => "speed(A, B) is along the line from A to B",
            _ => return Ok(()),
        };
        for pair in places.windows(2) {
            let [one, other] = [0, 1].map(|k| super::indexed(&pair[k].0, self.scope));
            if one? == other? {
                let message = format!("`{}` stands twice, and the line from it to itself has no direction", pair[1].0);
                return Err(Mistake::new(pair[1].1, message, format!("name different places: {wanted}")));
            }
        }
        Ok(())
    }

    /// The component of a vector along an axis of a body, such as `local(hub, pin.fx)`, written out as a formula of columns.
    fn local(&mut self) -> Result<(), Mistake> {
        let (name, example) = LOCAL;
        let start = self.tokens[self.at].0;
        let axes = self.axes_of(name, "what moves")?;
        let named = self.named(2, &format!("`{name}` takes a body and a component of a vector"), example)?;
        let [(body, of_body), (component, of_vector)] = &named[..] else { unreachable!("two were asked for") };
        self.is_place(body, &axes[..1]).map_err(|mistake| Mistake { character: *of_body, ..mistake })?;
        let orientation = super::indexed(&format!("{body}.{}", if axes.len() == 3 { "qw" } else { "angle" }), self.scope)?;
        match self.names.variable(&orientation) {
            Ok(None) => {
                let message = format!("`local` is along the axes of a body, and `{body}` is none");
                return Err(Mistake::new(*of_body, message, format!("write {example}")));
            }
            Err(mistake) if axes.len() == 3 && !mistake.known => {
                let message =
                    "`local` in space needs the orientation of a body, which forces and events do not know: only measures may ask so";
                return Err(Mistake::new(start, message, IN_BODY_AXES));
            }
            _ => (),
        }
        // A quaternion is no vector.
        let axis = component.chars().last().filter(|_| !component.contains(".q")).and_then(|letter| axes.find(letter));
        let Some((k, vector)) = axis.map(|k| (k, &component[..component.len() - 1])) else {
            let message = format!("`{component}` is no component along an axis of the model");
            return Err(Mistake::new(*of_vector, message, format!("write {example}")));
        };
        self.written_out(start, &names::local(body, vector, k, axes))
    }

    /// Letters of the axes, for a function of what moves.
    fn axes_of(&self, name: &str, what: &str) -> Result<&'static str, Mistake> {
        self.names.axes().ok_or_else(|| {
            self.mistake(
                format!("`{name}` is of {what}, and nothing moves here"),
                "use it in measures, events, and forces of type effort, force, torque, expression, spring and rope",
            )
        })
    }

    /// Names in brackets, and where they begin.
    fn named(&mut self, count: usize, wanted: &str, example: &str) -> Result<Vec<(String, usize)>, Mistake> {
        let start = self.tokens[self.at].0;
        let wrong = |at: usize| Mistake::new(at, wanted, format!("write {example}"));
        self.at += 2;
        let mut names = Vec::new();
        for k in 0..count {
            if k > 0 {
                match self.peek() {
                    Token::Comma => self.at += 1,
                    _ => return Err(wrong(start)),
                }
            }
            let begin = self.tokens[self.at].0;
            match self.peek() {
                Token::Name(name) => names.push((name.clone(), begin)),
                _ => return Err(wrong(begin)),
            }
            self.at += 1;
        }
        self.close()?;
        Ok(names)
    }

    /// Emits a formula that stands for what was written from `start` on.
    fn written_out(&mut self, start: usize, text: &str) -> Result<(), Mistake> {
        let written = Program::parse_with(text, self.variables, self.names, self.scope);
        let program = written.map_err(|inner| Mistake { character: start, ..inner })?;
        program.ops.into_iter().for_each(|op| self.emit(op));
        Ok(())
    }

    /// Refuses what has no coordinate of this name as no place, in words of what was written.
    fn is_place(&mut self, place: &str, axis: &str) -> Result<(), Mistake> {
        let coordinate = super::indexed(&format!("{place}.{axis}"), self.scope)?;
        if self.names.variable(&coordinate)?.is_some() {
            return Ok(());
        }
        if let Some(mistake) = self.scope.of_bar(place) {
            return Err(mistake);
        }
        let (known, suffix) = (self.names.known(), format!(".{axis}"));
        let places = known.iter().filter_map(|name| name.strip_suffix(&suffix));
        let cure = match nearest(place, places.chain([GROUND])) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "name a point, a body, BODY.POINT or ground; a fixed place is a [point.NAME] with `fixed = true`".into(),
        };
        Err(Mistake::new(0, format!("there is no place `{place}`"), cure))
    }
}
