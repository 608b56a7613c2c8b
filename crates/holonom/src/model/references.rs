//! What a model refers to by name: points, bodies, places and directions of them, joints.

use super::assembly::{Assembly, GROUND};
use super::bodies::nodes::Member;
use super::ends::{End, fixed};
use super::entry::{Entry, Spot, all};
use super::expression::{BAR, BEAM, indexed};
use super::fault::{Read, Refused, nearest, suggest};
use super::fields::{self as field, Field, Number};
use super::geometry::Vec3;
use super::joints::JointInfo;
use super::value::Value;

/// What a name of a place stands for.
enum Named {
    /// A point, by its number.
    Point(usize),
    /// A place of a body, by its number, with its position at the start.
    Place(usize, Vec3),
}

impl Assembly<'_> {
    /// The end that a place is.
    pub fn end<'s>(&self, entry: &Entry<'_>, at: impl Into<Spot<'s>>, place: &field::Place) -> Read<End> {
        let spot = at.into();
        match place {
            field::Place::Named(name) if name == GROUND => Ok(fixed([0.0; 3], GROUND.into())),
            field::Place::Named(name) => self.named_end(entry, spot, name),
            field::Place::Fixed(numbers) if self.are_names(entry, numbers) => Err(entry.refuse(
                spot,
                "these are names, and the numbers of one place are wanted here",
                "write one name without brackets, \"BODY\" or \"BODY.POINT\", or coordinates, as [x, y, z]; `at` of a joint also takes one \"BODY.POINT\" for each body",
            )),
            field::Place::Fixed(numbers) if numbers.len() == self.dimension() => {
                Ok(fixed(vector(entry, spot, numbers)?, place.write().quoted()))
            }
            field::Place::Fixed(numbers) => {
                let message = format!("a fixed place has {} numbers here, and this has {}", self.dimension(), numbers.len());
                Err(entry.refuse(spot, message, "give one for each axis of the model"))
            }
        }
    }

    /// Whether these are names of points, bodies or places of bodies, and no formulas.
    fn are_names(&self, entry: &Entry<'_>, items: &[Number]) -> bool {
        let is_name = |item: &Number| match item {
            Number::Formula(text) if text == GROUND || self.is_place_of_body(entry, text) => true,
            // A parameter may have the name of a body.
            Number::Formula(text) if entry.scope.value(text).is_some() => false,
            Number::Formula(text) => {
                indexed(text, &entry.scope).is_ok_and(|full| self.by_name.contains_key(&full) || self.body_by_name(&full).is_some())
            }
            Number::Given(_) => false,
        };
        !items.is_empty() && items.iter().all(is_name)
    }

    /// At least `least` and at most `most` ends, no two neighbours alike.
    pub fn ends(&self, entry: &Entry<'_>, key: &str, places: &[field::Place], least: usize, most: usize) -> Read<Vec<End>> {
        if !(least..=most).contains(&places.len()) {
            let wanted = if least == most { format!("{least}") } else { format!("at least {least}") };
            let names = ["\"A\"", "\"B\"", "\"C\""];
            let cure = format!("write {key} = [{}], with names of points, \"ground\" or fixed places", names[..least.min(3)].join(", "));
            return Err(entry.refuse(key, format!("`{key}` wants {wanted} points, and this has {}", places.len()), cure));
        }
        let ends = all(places.iter().enumerate().map(|(k, place)| self.end(entry, Spot { key, item: Some(k) }, place)))?;
        match (1..ends.len()).find(|&k| ends[k].terms == ends[k - 1].terms) {
            Some(k) => Err(entry.refuse(Spot { key, item: Some(k) }, "the same point comes twice", "name two different points")),
            None => Ok(ends),
        }
    }

    /// Two different ends.
    pub fn pair(&self, entry: &Entry<'_>, key: &str, places: &[field::Place]) -> Read<[End; 2]> {
        let ends = self.ends(entry, key, places, 2, 2)?;
        Ok(ends.try_into().expect("two ends"))
    }

    /// Two ends of which at least one can move.
    pub fn moving_pair(&self, entry: &Entry<'_>, key: &str, places: &[field::Place]) -> Read<[End; 2]> {
        let ends = self.pair(entry, key, places)?;
        self.require_free(entry, key, &ends)?;
        Ok(ends)
    }

    /// The point of a name.
    pub fn point(&self, entry: &Entry<'_>, key: &str, name: &str) -> Read<End> {
        match name {
            GROUND => Err(entry.refuse(key, format!("`{GROUND}` is a place, and a point is wanted here"), "name a [point.NAME]")),
            name => self.named_end(entry, key.into(), name),
        }
    }

    /// Refuses something that ties only places whose motion is known.
    pub fn require_free(&self, entry: &Entry<'_>, key: &str, ends: &[End]) -> Read<()> {
        if ends.iter().any(|end| end.free) {
            return Ok(());
        }
        Err(entry.refuse(key, "none of these can move freely", "at least one must be a point that is neither fixed nor driven"))
    }

    /// A side of a joint: a body, a point, a bar in the plane or the ground.
    pub(in crate::model) fn member(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<Member> {
        if name == GROUND {
            return Ok(Member::Ground);
        }
        let full = indexed(name, &entry.scope).map_err(|mistake| entry.mistaken(spot, mistake))?;
        if let Some(k) = self.body_by_name(&full) {
            return Ok(Member::Body(k));
        }
        if let Some(&k) = self.by_name.get(&full) {
            return Ok(Member::Point(k));
        }
        if let Some(&k) = self.bar_names.get(&full).filter(|_| self.dimension() == 2) {
            return Ok(Member::Bar(k));
        }
        let base = full.split('[').next().unwrap_or(&full);
        if self.faulty.contains(base) {
            return Err(Refused);
        }
        if let Some(refused) = self.refuse_beam(entry, spot, &full).or_else(|| refuse_other(entry, spot, &full, "a body or a point")) {
            return Err(refused);
        }
        let bars = self.bar_names.keys().map(String::as_str).filter(|_| self.dimension() == 2);
        let names =
            self.bodies.iter().map(|body| body.name.as_str()).chain(self.points.iter().map(|point| point.name.as_str())).chain(bars);
        let cure = match nearest(&full, names.chain([GROUND])) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("add [body.{base}], or name one that is there"),
        };
        Err(entry.refuse(spot, format!("there is no body `{full}`"), cure))
    }

    /// Refuses the name of a beam where one of its bodies is wanted, and an index that none of them has.
    fn refuse_beam(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Option<Refused> {
        let begins = format!("{}[", name.split('[').next().filter(|_| entry.scope.called(name) == Some(BEAM))?);
        let mut bodies = self.bodies.iter().map(|body| &body.name).filter(|body| body.starts_with(&begins));
        let (first, last) = (bodies.next()?, bodies.next_back()?);
        Some(entry.refuse(spot, format!("`{name}` is none of the bodies of a beam"), format!("name one of `{first}` to `{last}`")))
    }

    /// Whether a text names a place or a direction of a body, which may have a fault: `BODY.NAME`.
    pub fn is_place_of_body(&self, entry: &Entry<'_>, text: &str) -> bool {
        let body = split_place(text).and_then(|(body, _)| indexed(body, &entry.scope).ok());
        let is_faulty = |body: &str| self.faulty.contains(body.split('[').next().unwrap_or(body));
        body.is_some_and(|body| self.body_by_name(&body).is_some() || is_faulty(&body))
    }

    /// A joint by name.
    pub fn joint(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<&JointInfo> {
        let full = indexed(name, &entry.scope).map_err(|mistake| entry.mistaken(spot, mistake))?;
        if let Some(&k) = self.joint_names.get(&full) {
            return Ok(&self.joints[k]);
        }
        if self.body_by_name(&full).is_some() {
            return Err(entry.refuse(spot, format!("`{full}` is a body, and a joint is wanted here"), "name a [joint.NAME]"));
        }
        if self.faulty_joints.contains(full.split('[').next().unwrap_or(&full)) {
            return Err(Refused);
        }
        if let Some(refused) = refuse_other(entry, spot, &full, "a joint") {
            return Err(refused);
        }
        let cure = suggest(&full, self.joints.iter().map(|joint| joint.name.as_str()));
        Err(entry.refuse(spot, format!("there is no joint `{full}`"), cure))
    }

    /// Where a place is at the start: `"BODY.POINT"`, the name of a point or a body, or coordinates.
    pub fn place_at_start<'s>(&self, entry: &Entry<'_>, at: impl Into<Spot<'s>>, place: &field::Place) -> Read<Vec3> {
        match place {
            // The frames of bodies may not be there yet.
            field::Place::Named(name) if name != GROUND => Ok(match self.named(entry, at.into(), name)? {
                Named::Point(k) => self.points[k].end.start,
                Named::Place(_, at) => at,
            }),
            _ => self.end(entry, at, place).map(|end| end.start),
        }
    }

    /// A direction at the start: `"BODY.AXIS"`, or components.
    pub fn direction_at_start(&self, entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Vec3> {
        let cure = "write a direction as a list of numbers, or \"BODY.AXIS\"";
        match value {
            Value::List(items) if items.len() == self.dimension() => {
                let numbers = all(items.iter().map(|item| Number::read(entry, spot, item)))?;
                vector(entry, spot, &numbers)
            }
            Value::Text(text) => {
                let (body, axis) = split_place(text).ok_or_else(|| entry.refuse(spot, format!("\"{text}\" is no direction"), cure))?;
                let Member::Body(k) = self.member(entry, spot, body)? else {
                    return Err(entry.refuse(spot, format!("`{body}` is no body and has no axes"), cure));
                };
                let axes = &self.bodies[k].axes;
                axes.iter().find(|(name, _)| name == axis).map(|&(_, direction)| direction).ok_or_else(|| {
                    let known = suggest(axis, axes.iter().map(|(name, _)| name.as_str()));
                    entry.refuse(spot, format!("the body `{body}` has no axis `{axis}`"), known)
                })
            }
            Value::List(items) => {
                let message = format!("a direction has {} numbers here, and this has {}", self.dimension(), items.len());
                Err(entry.refuse(spot, message, "give one for each axis of the model"))
            }
            other => Err(entry.refuse(spot, format!("a direction is wanted here, and this is {}", other.type_name()), cure)),
        }
    }

    /// A place of a body by its name, `BODY.POINT`, with its position at the start.
    fn named_place(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<(usize, Vec3)> {
        let (body, place) = split_place(name).expect("there is a dot");
        let Member::Body(k) = self.member(entry, spot, body)? else {
            return Err(entry.refuse(spot, format!("`{body}` is no body and has no named points"), "name a point of a [body.NAME]"));
        };
        let points = &self.bodies[k].points;
        points.iter().find(|(known, _)| known == place).map(|&(_, at)| (k, at)).ok_or_else(|| {
            let cure = match points.is_empty() {
                true => format!("add [body.{body}.points] with {place} = […] in body axes"),
                false => suggest(place, points.iter().map(|(name, _)| name.as_str())),
            };
            entry.refuse(spot, format!("the body `{body}` has no point `{place}`"), cure)
        })
    }

    /// A place of a body as an end.
    pub fn body_end(&self, body: usize, at: Vec3, name: &str) -> End {
        End { terms: self.frames[body].point(at), start: at, free: true, point: None, body: Some(body), name: name.to_string() }
    }

    /// The name of an end in columns, with the indices of what is repeated; none of a place of the world.
    pub fn full_name(&self, end: &End) -> Option<String> {
        let of_body = |body: usize| {
            let body = &self.bodies[body].name;
            split_place(&end.name).map_or_else(|| body.clone(), |(_, place)| format!("{body}.{place}"))
        };
        end.point.map(|point| self.points[point].name.clone()).or(end.body.map(of_body))
    }

    fn named_end(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<End> {
        Ok(match self.named(entry, spot, name)? {
            Named::Point(k) => self.points[k].end.clone(),
            Named::Place(body, at) => self.body_end(body, at, name),
        })
    }

    fn named(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<Named> {
        if let Some(&k) = self.by_name.get(name) {
            return Ok(Named::Point(k));
        }
        if !self.bodies.is_empty() {
            if split_place(name).is_some() {
                return self.named_place(entry, spot, name).map(|(body, at)| Named::Place(body, at));
            }
            if let Ok(Some(k)) = indexed(name, &entry.scope).map(|full| self.body_by_name(&full)) {
                return Ok(Named::Place(k, self.bodies[k].position));
            }
        }
        let full = match indexed(name, &entry.scope) {
            Ok(full) => full,
            Err(mistake) => return Err(entry.mistaken(spot, mistake)),
        };
        if let Some(&k) = self.by_name.get(&full) {
            return Ok(Named::Point(k));
        }
        let base = full.split('[').next().unwrap_or(&full);
        if self.faulty.contains(base) || split_place(base).is_some_and(|(body, _)| self.faulty.contains(body)) {
            return Err(Refused);
        }
        if self.sink.is_full() {
            return Err(entry.refuse(spot, "", ""));
        }
        if let Some(refused) = self.refuse_beam(entry, spot, &full).or_else(|| refuse_other(entry, spot, &full, "a point or a body")) {
            return Err(refused);
        }
        let begins = format!("{base}[");
        let mut many = self.points.iter().filter(|point| point.name.starts_with(&begins));
        if let (Some(first), last) = (many.next(), many.next_back()) {
            let cure = format!("`{base}` is repeated, from `{}` to `{}`", first.name, last.unwrap_or(first).name);
            return Err(entry.refuse(spot, format!("there is no point `{full}`"), cure));
        }
        let owner = self.bodies.iter().find(|body| body.points.iter().any(|(place, _)| *place == full));
        let cure = match nearest(&full, self.points.iter().map(|point| point.name.as_str()).chain([GROUND])) {
            _ if let Some(owner) = owner => format!("a place of a body is named with the body: write `{}.{full}`", owner.name),
            Some(near) => format!("did you mean `{near}`?"),
            None => match split_place(base) {
                Some((body, place)) => format!("name {place} in [body.{body}.points]; such places have no index"),
                None => format!("add [point.{base}], or name one that is there"),
            },
        };
        Err(entry.refuse(spot, format!("there is no point `{full}`"), cure))
    }
}

/// Refuses the name of something else than is wanted.
fn refuse_other(entry: &Entry<'_>, spot: Spot<'_>, name: &str, wanted: &str) -> Option<Refused> {
    let what = entry.scope.called(name).filter(|what| *what != wanted)?;
    let cure = match (what, wanted) {
        (BAR, "a joint") => {
            "in a plane, name a revolute joint between the bar and what it turns against; in space make a body of it, with shape = { rod = LENGTH }, held by revolute joints"
                .to_string()
        }
        (BAR, "a body or a point") => {
            "joints take bars in a planar model: name a point at its ends, or make a body of it, with shape = { rod = LENGTH }".to_string()
        }
        (BAR, _) => "name a point at its ends, or make a body of it, which has a mass and an inertia".to_string(),
        _ => format!("name {wanted}"),
    };
    Some(entry.refuse(spot, format!("`{name}` is {what}, and {wanted} is wanted here"), cure))
}

/// Numbers of a list that may itself be an item of a list, zeros behind them.
fn vector(entry: &Entry<'_>, spot: Spot<'_>, numbers: &[Number]) -> Read<Vec3> {
    let read = all(numbers.iter().map(|number| number.number(entry, spot)))?;
    Ok(std::array::from_fn(|k| read.get(k).copied().unwrap_or(0.0)))
}

/// `BODY.POINT` in its two parts; a dot in an index is none between them.
pub fn split_place(text: &str) -> Option<(&str, &str)> {
    let behind = text.rfind(']').map_or(0, |at| at + 1);
    text[behind..].find('.').map(|at| (&text[..behind + at], &text[behind + at + 1..]))
}
