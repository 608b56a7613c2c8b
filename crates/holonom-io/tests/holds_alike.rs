//! Forces of constraints that are no joints beside what else tells them: multipliers, other units and places, shared nodes, and redundant ones.

mod common;

use common::{column, model, model_with_forces, near};
use holonom::model::{Model, constraints, drives, forces, joints};
use holonom::record::{Constraints, Peaks, Recorder, Recording};
use holonom::simulation::{Status, Verdict};

const G: f64 = 9.81;

fn run_of(model: &Model, method: &str, end: f64) -> Recording {
    common::run_every(model, method, 0.002, end, 1).1
}

fn run(text: &str, end: f64) -> Recording {
    run_of(&model(text), "conserving-ggl", end)
}

/// A frame of many constraints, whose forces on its points are found twice.
const FRAME: &str = "[point.a]\nmass = 2\nposition = [1, 0, 0]\nvelocity = [0, 1, 0]\n[point.b]\nmass = 1\nposition = [2, 0, 0]\nvelocity = [0, 2, 0]\n\
    [point.c]\nmass = 1.5\nposition = [0, 1, 2]\n[point.d]\nmass = 0.7\nposition = [1, 1, 2.5]\n\
    [constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n[constraint.line]\ntype = \"collinear\"\npoints = [\"ground\", \"a\", \"b\"]\n\
    [constraint.stick]\ntype = \"fixed\"\nbetween = [\"c\", \"d\"]\n[constraint.rail]\ntype = \"point-on-line\"\npoint = \"c\"\ndirection = [1, 2, 3]\n\
    [constraint.table]\ntype = \"point-on-plane\"\npoint = \"b\"\nnormal = [0, 1, 1]\n";

/// What acts on a point by its columns is what `reactions = true` has, and what accelerates it beside gravity.
#[test]
fn all_that_acts_on_a_point_adds_up() {
    let model = model(&format!("{FRAME}[output]\nreactions = true\n"));
    for method in ["conserving-ggl", "radau", "lagrange-1/rk4"] {
        let mut simulation = common::simulation(&model, method, 0.002);
        let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Rows);
        assert_eq!(simulation.run(0.2, &mut recorder), Status::Completed);
        let recording = recorder.finish();
        for k in 0..recording.rows() {
            let of = |name: String| column(&recording, &name)[k];
            let pull = |axis: char| of("rod.force".into()) * of(format!("a.{axis}"));
            for axis in ['x', 'y', 'z'] {
                let f = |name: &str| of(format!("{name}.f{axis}"));
                let sums = [
                    ("a", 2.0, f("line.a") - pull(axis)),
                    ("b", 1.0, f("line.b") + f("table")),
                    ("c", 1.5, f("rail") - f("stick")),
                    ("d", 0.7, f("stick")),
                ];
                for (name, mass, sum) in sums {
                    near(name, sum, of(format!("{name}.r{axis}")), 1e-10);
                    let weight = if axis == 'z' { G } else { 0.0 };
                    near(name, sum, mass * (of(format!("{name}.a{axis}")) + weight), 1e-9);
                }
            }
        }
    }
}

/// The same forces in t, mm and s, far from the origin, and with the constraints in another order.
#[test]
fn forces_of_constraints_know_no_units_and_no_place() {
    let names = ["line.a.fx", "line.b.fz", "stick.fz", "rail.f", "table.f"];
    let own = run(FRAME, 0.1);
    let mut entries: Vec<&str> = FRAME.split("[constraint.").collect();
    let points = entries.remove(0);
    let turned = entries.iter().rev().fold(points.to_string(), |text, entry| format!("{text}[constraint.{entry}"));
    let scaled = |text: &str| {
        let vector = |line: &str, factor: f64| {
            let (key, numbers) = line.split_once(" = ").unwrap();
            let numbers = numbers.trim_matches(['[', ']']).split(", ").map(|x| format!("{}", factor * x.parse::<f64>().unwrap()));
            format!("{key} = [{}]", numbers.collect::<Vec<_>>().join(", "))
        };
        let line = |line: &str| match line.split(" = ").next().unwrap() {
            "position" | "velocity" => vector(line, 1e3),
            "mass" => format!("mass = \"1e-3*{}\"", &line[7..]),
            _ => line.to_string(),
        };
        format!("gravity = [0, 0, -9810]\n{}", text.lines().map(line).collect::<Vec<_>>().join("\n"))
    };
    let far = FRAME
        .lines()
        .map(|line| match line.strip_prefix("position = [") {
            Some(rest) => format!("position = [\"1e4 + {}", rest.replacen(',', "\",", 1)),
            None => line.replace("\"ground\"", "[10000, 0, 0]"),
        })
        .collect::<Vec<_>>()
        .join("\n");
    for (what, text, share) in [("order", turned, 1e-9), ("units", scaled(FRAME), 1e-9), ("far", far, 1e-7)] {
        let other = run(&text, 0.1);
        for name in names {
            for k in 0..own.rows() {
                near(&format!("{what}, {name}"), column(&other, name)[k], column(&own, name)[k], share);
            }
        }
    }
}

/// Of two bodies that share the nodes of their hinge the second rests on a plane: the forces are those of statics, as where no nodes are shared.
#[test]
fn forces_of_constraints_are_known_where_bodies_share_nodes() {
    let text = "[body.arm]\nmass = 2\nshape = { box = [2, 0.1, 0.1] }\nposition = [1, 0, 0]\n\
                [body.leg]\nmass = 3\nshape = { box = [2, 0.1, 0.1] }\nposition = [3, 0, 0]\npoints = { foot = [1, 0, 0] }\n\
                [joint.knee]\ntype = \"revolute\"\nbetween = [\"arm\", \"leg\"]\nat = [2, 0, 0]\naxis = [0, 1, 0]\n";
    let wall = "[joint.wall]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n";
    // Level, from rest: the foot stays and the knee falls, or all hangs on the foot alone.
    let floors = [
        ("type = \"point-on-plane\"\npoint = \"leg.foot\"\nnormal = [0, 0, 1]", "floor", wall),
        ("type = \"fixed\"\npoint = \"leg.foot\"", "floor", ""),
        ("type = \"expression\"\nvalue = \"leg.foot.z\"", "floor.leg.foot", wall),
    ];
    for (floor, owner, wall) in floors {
        let text = format!("{text}{wall}[constraint.floor]\n{floor}\n");
        let shared = model_with_forces(&text);
        assert!(shared.shares_nodes());
        let apart = model(&format!("{text}[output]\nreactions = true\n"));
        let [one, other] = [&shared, &apart].map(|model| run_of(model, "conserving-ggl", 0.05));
        let name = format!("{owner}.fz");
        for k in 0..one.rows() {
            let of = |name: &str| column(&one, name)[k];
            // What carries both against their weight and what accelerates them.
            let carried = 2.0 * (of("arm.az") + G) + 3.0 * (of("leg.az") + G);
            let others = if wall.is_empty() { 0.0 } else { of("wall.fz") };
            near("sum", others + of(&name), carried, 1e-9);
            near("sum of the leg", of("knee.fz") + of(&name), 3.0 * (of("leg.az") + G), 1e-9);
            near("apart", of(&name), column(&other, &name)[k], 1e-8);
        }
        assert!(column(&one, &name)[0] > 1.0);
    }
}

/// Two that hold the same share what there is; the sum is the weight.
#[test]
fn redundant_constraints_share_what_there_is() {
    let text = "plane = \"xz\"\n[point.p]\nmass = 2\nposition = [1, 1]\n[constraint.pin]\nrepeat = \"i = 1 to 3\"\ntype = \"fixed\"\npoint = \"p\"\n\
                [constraint.rail]\ntype = \"point-on-line\"\npoint = \"p\"\ndirection = [1, 0]\n[constraint.level]\ntype = \"expression\"\nvalue = \"p.z - 1\"\n";
    let recording = run(text, 0.01);
    let sum: f64 = ["pin[1].fz", "pin[2].fz", "pin[3].fz", "rail.fz", "level.p.fz"].iter().map(|name| column(&recording, name)[0]).sum();
    near("weight", sum, 2.0 * G, 1e-10);
}

/// The largest forces are listed with those of joints.
#[test]
fn largest_forces_of_constraints_are_listed() {
    let model = model(&format!("plane = \"xz\"\n[point.p]\nmass = 2\nposition = [1, 1]\n{}", {
        "[constraint.rail]\ntype = \"point-on-line\"\npoint = \"p\"\ndirection = [3, 4]\n[point.q]\nmass = 1\nposition = [5, 0]\n\
         [constraint.level]\ntype = \"expression\"\nvalue = \"q.z\"\n"
    }));
    let recording = run_of(&model, "conserving-ggl", 0.1);
    let peaks = Peaks::of(&model.channels, &recording, &model.system).joints;
    let listed: Vec<_> = peaks.iter().map(|peak| (peak.name.as_str(), peak.what, &*peak.unit)).collect();
    assert_eq!(listed, [("rail", "force", "N"), ("level.q", "force", "N")]);
    near("rail", peaks[0].value, 2.0 * G * 0.6, 1e-10);
    near("level", peaks[1].value, G, 1e-10);
}

/// Whatever a kind of entry exerts is recorded in every run, under its name.
#[test]
fn everything_that_acts_has_columns() {
    let kinds = constraints::KINDS.iter().chain(drives::KINDS).chain(forces::KINDS).chain(joints::kinds());
    for kind in kinds {
        let text = kind.example;
        let section = text.match_indices('[').map(|(at, _)| &text[at + 1..]).filter(|rest| !rest.starts_with(['0', ' ', '[', '"']));
        let names = section.filter_map(|rest| rest.split_once(']')).filter_map(|(head, rest)| {
            let (table, name) = head.split_once('.')?;
            let is_kind = rest.trim_start().starts_with(&format!("type = \"{}\"", kind.name));
            (["constraint", "drive", "force", "joint"].contains(&table) && is_kind).then_some(name)
        });
        let names: Vec<&str> = names.collect();
        assert!(!names.is_empty(), "{}: {text}", kind.name);
        let model = model_with_forces(text);
        let headings = model.channels.headings(&model.system, Constraints::Joints);
        for name in names {
            let begins = format!("{name}.");
            let acts = headings.iter().any(|heading| heading.name.starts_with(&begins) && ["N", "N·m"].contains(&&*heading.unit));
            assert!(acts, "{}: nothing of `{name}` is recorded that acts: {text}", kind.name);
        }
    }
}

/// Steps are the same whether or not anybody looks.
#[test]
fn nothing_else_changes() {
    let model = model(FRAME);
    let mut simulation = common::simulation(&model, "conserving-ggl", 0.002);
    assert_eq!(simulation.run(0.1, &mut |_: &holonom::simulation::Simulation| Verdict::GoOn), Status::Completed);
    let recording = run_of(&model, "conserving-ggl", 0.1);
    let x = simulation.system().in_world(&simulation.state().x);
    assert_eq!([x[0], x[1], x[2]], ["a.x", "a.y", "a.z"].map(|name| common::last(&recording, name)));
}
