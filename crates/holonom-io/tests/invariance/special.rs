//! Keys and entries whose change does not follow from shape and unit alone.

use holonom::model::{Keys, Section, Table, Value};

use super::change::{Change, Matrix, SAME, product, rotation};
use super::sections::{items, kind, list, number, numbers, table};
use super::transform::{Context, scaled};
use super::units::powers;

/// A tensor in body axes that may have been turned over.
pub fn inertia(value: &Value, change: &Change) -> Value {
    if change.parity() > 0.0 {
        return value.clone();
    }
    match value {
        Value::List(moments) if moments.len() == 6 => {
            let [xx, yy, zz, xy, xz, yz] = numbers(value)[..] else { unreachable!("six") };
            list(&[xx, yy, zz, -xy, -xz, yz])
        }
        Value::List(rows) if matches!(rows[0], Value::List(_)) => {
            let row = |(i, row): (usize, &Value)| {
                let signed = numbers(row).into_iter().enumerate().map(|(j, c)| if (i == 0) == (j == 0) { c } else { -c });
                list(&signed.collect::<Vec<_>>())
            };
            Value::List(rows.iter().enumerate().map(row).collect())
        }
        _ => value.clone(),
    }
}

/// A bushing: the first numbers along the axes of the model, the others about them.
pub fn halves(unit: &str, old: &[f64], context: &Context<'_>) -> Value {
    let (dim, change) = (context.dimension(), context.change);
    let units: Vec<&str> = unit.split(", ").collect();
    let factor = |k: usize| change.factor(powers(units[usize::from(k >= dim)]));
    let from = |k: usize| {
        let row = change.turn[k % dim];
        let axis = row[..dim].iter().position(|c| c.abs() == 1.0).expect("bushings are turned by right angles only");
        if k < dim { axis } else { dim + axis }
    };
    let new = |k: usize| if dim == 2 && k == 2 { old[2] * factor(2) } else { old[from(k)] * factor(k) };
    list(&(0..old.len()).map(new).collect::<Vec<_>>())
}

/// The profile of a drive.
pub fn profile(unit: &str, value: &Value, context: &Context<'_>) -> Value {
    let factor = context.coordinate.map_or(context.change.factor(powers(unit)), |coordinate| coordinate.factor(context.change));
    let Value::Table(table) = value else { return context.formula(value, factor) };
    let row = |row: &Value| list(&[numbers(row)[0] * context.change.time, numbers(row)[1] * factor]);
    let mut out = table.clone();
    out.set("table", Value::List(items(table.get("table").expect("a profile has a table")).iter().map(row).collect()));
    Value::Table(out)
}

/// A shape of a body, whose sizes are lengths.
pub fn shape(value: &Value, length: f64) -> Value {
    let Value::Table(shape) = value else { panic!("a shape is a table") };
    Value::Table(shape.iter().map(|(key, value)| (key, scaled(value, length))).collect())
}

/// The section of a beam, whose keys have units of their own.
pub fn section(value: &Value, change: &Change) -> Value {
    let Value::Table(section) = value else { panic!("a section is a table") };
    let unit = |name: &str| Section::KEYS.iter().find(|key| key.name == name).expect("the key is known").unit;
    Value::Table(section.iter().map(|(name, value)| (name, scaled(value, change.factor(powers(unit(name)))))).collect())
}

/// What concerns several keys of an entry.
pub fn finish(section: &str, old: &Table, new: &mut Table, context: &Context<'_>) {
    let change = context.change;
    match (section, kind(old)) {
        ("point", _) if change.drift != [0.0; 3] && old.get("velocity").is_none() => {
            new.push("velocity", list(&change.drift[..context.dimension()]));
        }
        ("body", _) => body(old, new, context),
        ("beam", _) => {
            if change.drift != [0.0; 3] && old.get("velocity").is_none() {
                new.push("velocity", list(&change.drift[..context.dimension()]));
            }
            // The default; no beam of these models goes along z.
            if context.dimension() == 3 && old.get("up").is_none() {
                new.push("up", list(&context.vector(&change.turn, &[0.0, 0.0, 1.0], 1.0)));
            }
        }
        ("joint", "screw") => times(new, "pitch", change.parity()),
        ("joint", "rack-and-pinion") => times(new, "radius", change.parity()),
        ("joint", "gear") => {
            let [first, second] = named(old.get("joints").expect("a gear has joints"), context);
            times(new, "ratio", first / second);
        }
        ("joint", "linear") => terms(new, context),
        ("force", "torsion") => times(new, "angle", sign(context)),
        ("force", "effort") => {
            if let Some(effort) = new.get_mut("effort").filter(|_| sign(context) < 0.0) {
                *effort = match &*effort {
                    Value::Text(text) => Value::Text(format!("-({text})")),
                    number => scaled(number, -1.0),
                };
            }
        }
        ("force", "stop") if sign(context) < 0.0 => {
            let limits = ["upper", "lower"].map(|key| new.get(key).map(|limit| scaled(limit, -1.0)));
            *new = new.iter().filter(|(key, _)| !["lower", "upper"].contains(key)).map(|(key, value)| (key, value.clone())).collect();
            for (key, limit) in ["lower", "upper"].into_iter().zip(limits) {
                limit.into_iter().for_each(|limit| new.push(key, limit));
            }
        }
        _ => (),
    }
}

fn sign(context: &Context<'_>) -> f64 {
    context.coordinate.map_or(1.0, |coordinate| if coordinate.is_odd { context.change.parity() } else { 1.0 })
}

fn times(table: &mut Table, key: &str, factor: f64) {
    table.get_mut(key).into_iter().for_each(|value| *value = scaled(value, factor));
}

/// New over old values of two coordinates.
fn named(joints: &Value, context: &Context<'_>) -> [f64; 2] {
    let factor = |k: usize| match &items(joints)[k] {
        Value::Text(name) => context.coordinates[name].factor(context.change),
        other => panic!("{} is no joint", other.quoted()),
    };
    [factor(0), factor(1)]
}

/// The summands of a coupler, in the unit of the first one.
fn terms(new: &mut Table, context: &Context<'_>) {
    let Some(Value::List(terms)) = new.get_mut("terms") else { panic!("a linear coupler has terms") };
    let mut first = None;
    for term in terms {
        let Value::Table(term) = term else { panic!("a term is a table") };
        let Some(Value::Text(joint)) = term.get("joint") else { panic!("a term has a joint") };
        let own = context.coordinates[joint].factor(context.change);
        times(term, "factor", *first.get_or_insert(own) / own);
    }
}

fn body(old: &Table, new: &mut Table, context: &Context<'_>) {
    let change = context.change;
    if change.drift != [0.0; 3] && old.get("velocity").is_none() {
        new.push("velocity", list(&change.drift[..context.dimension()]));
    }
    if old.get("density").is_some() && table(old, "shape").get("rod").is_some() {
        times(new, "density", change.factor([2, 0, 0]));
    }
    if change.turns() {
        let turned = product(&product(&change.turn, &orientation(&table(old, "orientation"))), &change.over());
        let orientation = match context.dimension() {
            2 => ("angle", Value::Number(turned[1][0].atan2(turned[0][0]))),
            _ => ("matrix", Value::List(turned.iter().map(|row| list(row)).collect())),
        };
        new.set("orientation", Value::Table([orientation].into_iter().collect()));
    }
}

/// The rotation matrix of an orientation.
fn orientation(spelling: &Table) -> Matrix {
    let degrees = |key: &str| if key.ends_with("_deg") { std::f64::consts::PI / 180.0 } else { 1.0 };
    let angle = ["angle", "angle_deg"].iter().find_map(|key| spelling.get(key).map(|angle| number(angle) * degrees(key)));
    let axis = spelling.get("axis").map(numbers);
    if let Some(angle) = angle {
        return rotation(axis.map_or([0.0, 0.0, 1.0], |axis| [axis[0], axis[1], axis[2]]), angle);
    }
    let Some((key, value)) = spelling.iter().next() else { return SAME };
    match key {
        "matrix" => {
            let rows: Vec<Vec<f64>> = items(value).iter().map(numbers).collect();
            std::array::from_fn(|i| std::array::from_fn(|j| rows[i][j]))
        }
        "rpy" | "rpy_deg" => {
            let angles: Vec<f64> = numbers(value).into_iter().map(|angle| angle * degrees(key)).collect();
            let about = |k: usize| rotation(SAME[k], angles[k]);
            product(&about(2), &product(&about(1), &about(0)))
        }
        _ => {
            let n = numbers(value);
            let [w, x, y, z] = if key == "quat_wxyz" { [n[0], n[1], n[2], n[3]] } else { [n[3], n[0], n[1], n[2]] };
            let sine = (x * x + y * y + z * z).sqrt();
            if sine == 0.0 { SAME } else { rotation([x, y, z], 2.0 * sine.atan2(w)) }
        }
    }
}
