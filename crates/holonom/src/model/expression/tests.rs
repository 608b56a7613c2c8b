use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use num_dual::{Dual2_64, Dual64, HyperDual64};

use super::functions::FUNCTIONS;
use super::{Beyond, Curve, Mistake, Names, Program, Scope, TimeProgram, Value};
use crate::system::{Bend, EvenZeros, Signal, zeros};

fn value(text: &str) -> f64 {
    let program = Program::parse(text, &[], &Scope::default()).unwrap_or_else(|mistake| panic!("{text}: {mistake:?}"));
    program.as_constant().expect("folded")
}

fn mistake(text: &str) -> (usize, String) {
    let mistake = Program::parse(text, &["t"], &Scope::default()).expect_err(text);
    (mistake.character, format!("{}; {}", mistake.message, mistake.cure))
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("1 + 2*3", 7.0),
        ("2^3^2", 512.0),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("(-2)^3", -8.0),
        ("2^-1", 0.5),
        ("8/4/2", 1.0),
        ("8-4-2", 2.0),
        ("--3", 3.0),
        ("+3", 3.0),
        ("2*-3", -6.0),
        ("1e-3 + .5 + 2.", 2.501),
        ("2e", f64::NAN),
        ("atan2(1, -1)/pi", 0.75),
        ("min(3, max(1, 2))", 2.0),
        ("step(0) + step(-1) + sign(0) + sign(-3)", 0.0),
        ("pow(-3, 3)", -27.0),
        ("tau/pi + ln(e) + log10(100)", 5.0),
        ("abs(-2) + sqrt(9)", 5.0),
        ("sin(30*deg) + 1500*mm + 50*cm + 2*km/1000", 4.5),
        ("60*rpm/tau + bar/1e5", 2.0),
    ] {
        if expected.is_nan() {
            assert!(Program::parse(text, &[], &Scope::default()).is_err(), "{text}");
        } else {
            assert!((value(text) - expected).abs() < 1e-14, "{text} is {}", value(text));
        }
    }
}

#[test]
fn mistakes_say_where_and_what_to_do() {
    for (text, character, words) in [
        ("", 0, "empty"),
        ("1 +", 3, "ends too early"),
        ("(1 + 2", 6, "closing bracket is missing"),
        ("1 + 2)", 5, "never opened"),
        ("2 t", 2, "write 2*t"),
        ("400 mm", 4, "write 400*mm"),
        ("30deg", 2, "write 30*deg"),
        ("sin(1.5e1 deg)", 10, "write 1.5e1*deg"),
        ("5 N", 2, "write 5; known factors are deg, mm, cm, km, rpm, bar"),
        ("5*kg", 2, "add `kg` to [parameters], or leave it out if it is a unit"),
        ("t mm", 2, "write 2*x"),
        ("sn(t)", 0, "did you mean `sin`"),
        ("sin", 0, "needs its arguments"),
        ("atan2(t)", 0, "takes 2 arguments"),
        ("sin(t, 1)", 5, "no further argument"),
        ("3 + tt", 4, "did you mean `t`"),
        ("2 ** 3", 2, "written with ^"),
        ("1.2.3", 0, "is no number"),
        ("t & 1", 2, "means nothing"),
        ("* 2", 0, "missing here"),
        ("t(1)", 0, "write t*(…)"),
    ] {
        let (at, message) = mistake(text);
        assert_eq!(at, character, "{text}: {message}");
        assert!(message.contains(words), "{text}: {message}");
    }
}

#[test]
fn hostile_lengths_and_depths_are_refused() {
    for text in ["(".repeat(9_000), "-".repeat(9_000), "2^".repeat(4_000), "1".repeat(20_000), format!("{}t", "sin(".repeat(2000))] {
        mistake(&text);
    }
    let nested = |depth: usize| "1+t*(2+".repeat(depth) + "t" + &")".repeat(depth);
    assert!(mistake(&nested(60)).1.contains("split"));
    // Eighty numbers wait for an operation: at t = 1 each bracket adds three.
    assert_eq!(Program::parse(&nested(40), &["t"], &Scope::default()).unwrap().evaluate(&[1.0]), 121.0);
    let long = vec!["t"; 1000].join("+");
    assert_eq!(Program::parse(&long, &["t"], &Scope::default()).unwrap().evaluate(&[2.0]), 2000.0);
}

/// First and second derivatives of every function and operator against differences.
#[test]
fn derivatives_agree_with_differences() {
    let mut formulas: Vec<String> =
        ["x^3", "x^-2", "x^2.5", "2^x", "x^x", "-x", "x*x - 1/x", "pow(x, 2)", "(-x)^3", "(x - 3)^4"].map(String::from).to_vec();
    formulas.extend(
        FUNCTIONS.iter().map(|&(name, arguments, _)| if arguments == 1 { format!("{name}(x)") } else { format!("{name}(x, 0.2 + x^2)") }),
    );
    let (x, h) = (0.7, 1e-4);
    for text in &formulas {
        let program = Program::parse(text, &["x"], &Scope::default()).unwrap();
        let f = |x: f64| program.evaluate(&[x]);
        let dual = program.evaluate(&[Dual2_64::new(x, 1.0, 0.0)]);
        let (first, second) = ((f(x + h) - f(x - h)) / (2.0 * h), (f(x + h) - 2.0 * f(x) + f(x - h)) / (h * h));
        assert!((dual.re - f(x)).abs() < 1e-13 * (1.0 + f(x).abs()), "{text}: {} {}", dual.re, f(x));
        assert!((dual.v1 - first).abs() < 1e-6 * (1.0 + first.abs()), "{text}: {} {first}", dual.v1);
        assert!((dual.v2 - second).abs() < 1e-5 * (1.0 + second.abs()), "{text}: {} {second}", dual.v2);
        let mut hyper = HyperDual64::from(x);
        (hyper.eps1, hyper.eps2) = (1.0, 1.0);
        let hyper = program.evaluate(&[hyper]);
        assert!((hyper.eps1eps2 - dual.v2).abs() < 1e-12 * (1.0 + dual.v2.abs()), "{text}");
    }
}

/// Value and both derivatives where powers overflow, and of angles on the axes.
#[test]
fn derivatives_are_right_far_out_and_on_axes() {
    for (text, x, expected) in [
        ("tanh(x)", 400.0, [1.0, 0.0, 0.0]),
        ("tanh(x)", -1e6, [-1.0, 0.0, 0.0]),
        ("tanh(x)", 1e-9, [1e-9, 1.0, -2e-9]),
        ("tanh(x)", -0.5, [-0.46211715726000975, 0.7864477329659274, 0.7268619813835873]),
        ("1/(1 + exp(-x))", -1e3, [0.0; 3]),
        ("1/cosh(x)", 2e3, [0.0; 3]),
        ("cosh(x)^-2", -1e3, [0.0; 3]),
        ("(1 + exp(x))^-0.5", 2e3, [0.0; 3]),
        ("atan2(x, 0)", 2.0, [FRAC_PI_2, 0.0, 0.0]),
        ("atan2(1, x)", 0.0, [FRAC_PI_2, -1.0, 0.0]),
        ("atan2(x, -1)", 0.0, [PI, -1.0, 0.0]),
        ("atan2(-1, x)", 0.5, [-1.1071487177940904, 0.8, -0.64]),
    ] {
        let found = Program::parse(text, &["x"], &Scope::default()).unwrap().evaluate(&[Dual2_64::new(x, 1.0, 0.0)]);
        for (found, expected) in [found.re, found.v1, found.v2].into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15 * (1.0 + expected.abs()), "{text} at {x}: {found:e}, and {expected:e}");
        }
    }
}

#[test]
fn powers_of_zero_and_of_negative_numbers_are_right() {
    let at = |text: &str, x: f64| Program::parse(text, &["x"], &Scope::default()).unwrap().evaluate(&[Dual64::new(x, 1.0)]);
    assert_eq!(at("x^3", 0.0), Dual64::new(0.0, 0.0));
    assert_eq!(at("x^2", 0.0), Dual64::new(0.0, 0.0));
    assert_eq!(at("x^1", 0.0), Dual64::new(0.0, 1.0));
    assert_eq!(at("x^0", 0.0), Dual64::new(1.0, 0.0));
    assert_eq!(at("x^1.5", 0.0), Dual64::new(0.0, 0.0));
    assert_eq!(at("x^3", -2.0), Dual64::new(-8.0, 12.0));
    assert_eq!(at("pow(x, 3)", -2.0), Dual64::new(-8.0, 12.0));
    assert!(at("x^1.5", -1.0).re.is_nan());
    for clipped in ["max(x, 0)^0.1", "sqrt(max(x, 0))", "max(x, 0)^0.5", "max(x, 0)*max(x, 0)^0.1"] {
        assert_eq!(at(clipped, -1.0), Dual64::new(0.0, 0.0), "{clipped}");
    }
    assert!(!at("sqrt(x)", 0.0).eps.is_finite());
}

/// Measures of the variable t, by their names.
struct Measured(HashMap<&'static str, Program>);

impl Names for Measured {
    fn variable(&mut self, _name: &str) -> Result<Option<usize>, Mistake> {
        Ok(None)
    }

    fn formula(&mut self, name: &str) -> Result<Option<Program>, Mistake> {
        Ok(self.0.get(name).cloned())
    }
}

/// Derivatives by all variables at once, and what these change by, are those by one and by two after the other.
#[test]
fn slopes_are_the_derivatives_by_each_variable() {
    let curve = Curve::cubic(vec![0.0, 1.0, 2.5, 3.0], vec![1.0, -1.0, 0.5, 1.0], Beyond::Periodic);
    let tables = HashMap::from([("curve".to_string(), Some(Arc::new(curve)))]);
    let scope = Scope { tables: Some(&tables), ..Scope::default() };
    let m = Program::parse("3*t + sin(t)", &["t"], &Scope::default()).unwrap();
    let n = Program::parse_with("m*m - t", &["t"], &mut Measured([("m", m.clone())].into()), &Scope::default()).unwrap();
    for text in [
        "4",
        "y",
        "x*y - y*t/x + (-y)^3",
        "n*y + m/n - n^2 + x*m",
        "atan2(x, y)*min(x, y) + max(t, y)*mod(y, 0.3)",
        "sqrt(x^2 + y^2 + t^2)*tanh(y) - x^-2*y^1.7",
        "pow(x, y) + curve(2*x*y) - abs(t - y)",
        "max(-x, 0)^0.1 + sqrt(max(-y, 0))*x",
        "exp(-((x - y)/0.1)^2) + 1/cosh(2e3*y) + y*step(x)*floor(y)",
    ] {
        let mut measures = Measured([("m", m.clone()), ("n", n.clone())].into());
        let program = Program::parse_with(text, &["t", "x", "y"], &mut measures, &scope).unwrap();
        let (at, along) = ([0.3, 0.8, 1.7], [0.5, -1.0, 2.0]);
        let (mut slopes, mut turned) = ([0.0; 3], [Dual64::from(0.0); 3]);
        let value = program.slopes(&at, &mut slopes);
        program.slopes(&std::array::from_fn::<_, 3, _>(|k| Dual64::new(at[k], along[k])), &mut turned);
        assert_eq!(value, program.evaluate(&at), "{text}");
        for k in 0..3 {
            let varied: [_; 3] = std::array::from_fn(|i| HyperDual64::new(at[i], f64::from(i == k), along[i], 0.0));
            let HyperDual64 { eps1, eps1eps2, .. } = program.evaluate(&varied);
            for (found, expected) in [(slopes[k], eps1), (turned[k].re, eps1), (turned[k].eps, eps1eps2)] {
                assert!((found - expected).abs() < 1e-13 * (1.0 + expected.abs()), "{text} by {k}: {found}, and {expected}");
            }
        }
    }
}

#[test]
fn parameters_fold_and_never_hide_a_variable() {
    let parameters: HashMap<String, Value> =
        [("n".to_string(), Value::Known(2.0)), ("bad".to_string(), Value::Faulty), ("t".to_string(), Value::Known(1.0))].into();
    let scope = Scope { parameters: Some(&parameters), indices: &[("i".to_string(), 3.0)], ..Scope::default() };
    assert_eq!(Program::parse("i^n + 1", &[], &scope).unwrap().as_constant(), Some(10.0));
    assert!(Program::parse("bad + 1", &[], &scope).unwrap_err().known);
    assert!(Program::parse("t + 1", &["t"], &scope).unwrap_err().message.contains("could be"));
}

#[test]
fn names_of_a_model_come_before_units() {
    let parameters: HashMap<String, Value> = [("mm".to_string(), Value::Known(7.0))].into();
    let scope = Scope { parameters: Some(&parameters), indices: &[("deg".to_string(), 3.0)], ..Scope::default() };
    assert_eq!(Program::parse("mm + deg", &[], &scope).unwrap().as_constant(), Some(10.0));
    assert_eq!(Program::parse("bar", &["bar"], &Scope::default()).unwrap().evaluate(&[2.0]), 2.0);
}

#[test]
fn signals_have_two_derivatives() {
    let program = Program::parse("0.1*sin(10*t)", &["t"], &Scope::default()).unwrap();
    let [value, rate, second] = TimeProgram(program).at(0.3);
    assert!((value - 0.1 * 3f64.sin()).abs() < 1e-16 && (rate - 3f64.cos()).abs() < 1e-15 && (second + 10.0 * 3f64.sin()).abs() < 1e-14);
}

/// Where a function of time has a corner its derivatives are those right after it, whatever is written first.
#[test]
fn derivatives_at_a_corner_are_those_after_it() {
    for (text, expected) in [
        ("min(t, 0)", [0.0, 0.0]),
        ("min(0, t)", [0.0, 0.0]),
        ("max(t, 0)", [1.0, 0.0]),
        ("max(0, t)", [1.0, 0.0]),
        ("min(-t, 2*t)", [-1.0, 0.0]),
        ("min(2*t, -t)", [-1.0, 0.0]),
        ("max(t^2, 3*t^2)", [0.0, 6.0]),
        ("max(3*t^2, t^2)", [0.0, 6.0]),
        ("abs(t)", [1.0, 0.0]),
        ("abs(-t)", [1.0, 0.0]),
        ("abs(-t^2)", [0.0, 2.0]),
    ] {
        let [_, rate, second] = TimeProgram(Program::parse(text, &["t"], &Scope::default()).unwrap()).at(0.0);
        assert_eq!([rate, second], expected, "{text}");
    }
}

/// Every period of a periodic table has its kinks, at the times at which its formula has them.
#[test]
fn kinks_of_periodic_tables_come_again_in_every_period() {
    let curve = Curve::linear(vec![0.1, 0.4, 0.9], vec![0.0, 1.0, 0.0], Beyond::Periodic);
    let tables = HashMap::from([("wave".to_string(), Some(Arc::new(curve)))]);
    let scope = Scope { tables: Some(&tables), ..Scope::default() };
    let program = Program::parse("3*wave(2*t)", &["t"], &scope).unwrap();
    let mut times: Vec<f64> = program.switches(0).into_iter().flat_map(|switch| zeros(&TimeProgram(switch), 1.0)).collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|b, a| *b - *a < 1e-12);
    let expected = [0.05, 0.2, 0.45, 0.6, 0.85];
    assert!(times.len() == 5 && times.iter().zip(expected).all(|(t, known)| (t - known).abs() < 1e-12), "{times:?}");
}

/// A function of time that counts how often it is asked, and may keep to itself what is known of its zeros.
struct Asked(TimeProgram, AtomicUsize, bool);

impl Signal for Asked {
    fn at(&self, t: f64) -> [f64; 3] {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.at(t)
    }

    fn even_zeros(&self) -> Option<EvenZeros> {
        self.0.even_zeros().filter(|_| self.2)
    }
}

/// Zeros of what is linear in time and of its sine are known, and are those that a search of the whole run finds, as they are rounded.
#[test]
fn known_zeros_are_those_that_a_search_finds() {
    let curve = Curve::linear(vec![0.1, 0.4, 0.9], vec![0.0, 1.0, 0.0], Beyond::Periodic);
    let tables = HashMap::from([("wave".to_string(), Some(Arc::new(curve)))]);
    let scope = Scope { tables: Some(&tables), ..Scope::default() };
    for (text, count) in [
        ("step(t - 0.3)", 1),
        ("step(0.5 - 3*t/2)", 1),
        ("abs((t + 1000) - 1000.3)", 1),
        ("step(t - 7)", 0),
        ("step(t + 0.1)", 0),
        ("sign(sin(40*t + 0.2))", 26),
        ("wave(t)", 3 * 3),
        ("wave(3.3 - 2*(t + 0.01))", 3 * 5),
    ] {
        let program = Program::parse(text, &["t"], &scope).unwrap();
        let found = [true, false].map(|is_told| {
            let switches = program.switches(0).into_iter();
            let switches: Vec<Asked> = switches.map(|switch| Asked(TimeProgram(switch), AtomicUsize::new(0), is_told)).collect();
            let mut times: Vec<f64> = switches.iter().flat_map(|switch| zeros(switch, 2.05)).collect();
            times.sort_by(f64::total_cmp);
            (times, switches.iter().map(|switch| switch.1.load(Ordering::Relaxed)).sum::<usize>())
        });
        let [(known, few), (searched, _)] = &found;
        assert_eq!([known.len(), searched.len()], [count; 2], "{text}: {known:?} {searched:?}");
        assert!(known.iter().zip(searched).all(|(one, other)| (one - other).abs() < 1e-12), "{text}: {known:?} {searched:?}");
        assert!(*few <= 100 * (count + 3), "{text}: asked {few} times");
    }
}

/// Steps end at all knots of a table, and only its ends may be corners where it is smooth between.
#[test]
fn smooth_tables_have_corners_at_their_ends_alone() {
    let knots: Vec<f64> = (0..50).map(f64::from).collect();
    let values: Vec<f64> = knots.iter().map(|s| (0.2 * s).sin()).collect();
    for (curve, corners) in [
        (Curve::linear(knots.clone(), values.clone(), Beyond::Hold), 50),
        (Curve::cubic(knots.clone(), values.clone(), Beyond::Hold), 2),
        (Curve::monotone(knots.clone(), values.clone(), Beyond::Hold), 2),
    ] {
        let tables = HashMap::from([("curve".to_string(), Some(Arc::new(curve)))]);
        let program = Program::parse("curve(t)", &["t"], &Scope { tables: Some(&tables), ..Scope::default() }).unwrap();
        assert_eq!([program.switches(0).len(), program.corners(0).len()], [50, corners]);
        // Each is at the knot, without a search.
        let last = program.switches(0).into_iter().flat_map(|switch| zeros(&TimeProgram(switch), 60.0)).last().unwrap();
        assert!(last < 49.0 && last > 49.0 - 1e-13, "{last}");
    }
}

/// Where `floor` and `mod` jump steps end, in time and with what moves.
#[test]
fn floor_and_mod_jump_where_they_are_seen_to() {
    let scope = Scope::default();
    for (text, at, value, rate) in [("floor(t)", -0.3, -1.0, 0.0), ("mod(t, 2)", 5.5, 1.5, 1.0), ("mod(-t, 2)", 0.5, 1.5, -1.0)] {
        let [found, slope, _] = TimeProgram(Program::parse(text, &["t"], &scope).unwrap()).at(at);
        assert!((found - value).abs() < 1e-12 && (slope - rate).abs() < 1e-12, "{text}: {found}, {slope}");
    }
    let times = |text: &str| -> Vec<f64> {
        let program = Program::parse(text, &["t"], &scope).unwrap();
        program.switches(0).into_iter().flat_map(|switch| zeros(&TimeProgram(switch), 1.0)).collect()
    };
    for (text, expected) in [("2*floor(3*t)", [1.0 / 3.0, 2.0 / 3.0]), ("sin(mod(t + 0.1, 0.4))", [0.3, 0.7])] {
        let found = times(text);
        assert!(found.len() >= 2 && found.iter().zip(expected).all(|(t, known)| (t - known).abs() < 1e-12), "{text}: {found:?}");
    }
    let mut corners = Vec::new();
    let program = Program::parse("floor(q) + mod(q, 0.5)", &["q"], &scope).unwrap();
    for q in [0.99, 1.01] {
        program.bends(&[q], &mut |bend| {
            if let Bend::Corner(corner) = bend {
                corners.push(corner)
            }
        });
    }
    assert!(corners[0] * corners[2] < 0.0 && corners[1] * corners[3] < 0.0, "{corners:?}");
}

/// A step of the run ends right before a jump and the next begins right behind it, as the formula itself is rounded there.
#[test]
fn jumps_are_found_as_formulas_are_rounded() {
    for text in [
        "floor(t + 0.75)",
        "floor(3*t + 0.1)",
        "-floor(0.3 - 7*t)",
        "mod(t + 0.4, 0.7)",
        "step(t + 0.75 - 1)",
        "sign(t + 0.75 - 1)",
        "sign(0.7 - 3*t + 0.1)",
    ] {
        let program = Program::parse(text, &["t"], &Scope::default()).unwrap();
        let times: Vec<f64> = program.switches(0).into_iter().flat_map(|switch| zeros(&TimeProgram(switch), 1.0)).collect();
        let jump = |t: f64| program.evaluate(&[t]);
        for t in times.iter().copied() {
            let [far_before, far_behind] = [t - 1e-9, t + 1e-9].map(jump);
            assert!((jump(t) - far_before).abs() < 1e-6 && (far_behind - far_before).abs() > 0.5, "{text} at {t}");
        }
        assert!(!times.is_empty(), "{text}");
    }
}

#[test]
fn parts_of_time_are_the_largest_that_read_nothing_else() {
    for (text, expected) in [
        ("2*sin(t) + x", vec!["2*sin(t)"]),
        ("x*sin(t) - max(cos(t), x)", vec!["sin(t)", "cos(t)"]),
        ("(x + t^2) + exp(-t)", vec!["t^2", "exp(-t)"]),
        ("sin(t)/(1 + t)", vec!["sin(t)/(1 + t)"]),
        ("3 + x*2", vec![]),
        ("4", vec![]),
    ] {
        let parse = |text: &str, variables: &[&str]| Program::parse(text, variables, &Scope::default()).unwrap();
        let known: Vec<Program> = expected.iter().map(|part| parse(part, &["t"])).collect();
        assert_eq!(parse(text, &["x", "t"]).parts_of_time(1), known, "{text}");
    }
}

/// The bound is no less than what is found anywhere, and not many times as much; where a formula has corners or poles there is none.
#[test]
fn bends_of_formulas_of_time_are_bounded() {
    let parse = |text: &str| Program::parse(text, &["t"], &Scope::default()).unwrap();
    for (text, loose) in [
        ("3", 1.0),
        ("7*t - 2", 1.0),
        ("-4*t^2 + 5*t", 1.0),
        ("2*sin(30*t)", 1.01),
        ("t*cos(3*t)", 1.6),
        ("sin(2*t)^3/5", 3.1),
        ("sqrt(1 - (0.1*sin(10*t))^2)", 2.1),
    ] {
        let program = parse(text);
        let bends = (0..=1000).map(|k| program.evaluate(&[Dual2_64::new(2e-3 * f64::from(k), 1.0, 0.0)]).v2.abs());
        let (most, bound) = (bends.fold(0.0, f64::max), program.largest_bend(2.0).unwrap());
        assert!(most <= bound * (1.0 + 1e-12) && bound <= loose * most, "{text}: {bound} for {most}");
    }
    for text in ["abs(t - 1)", "step(t - 1)", "exp(-t)", "1/(t - 1)", "sqrt(t)", "sin(1e200*t)"] {
        assert_eq!(parse(text).largest_bend(2.0), None, "{text}");
    }
}
