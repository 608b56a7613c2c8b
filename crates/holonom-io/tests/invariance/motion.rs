//! The motion of a model: run, sampled by names, taken back to the frame of another one, and compared.

use holonom::analysis::rank;
use holonom::model::{Model, NoFiles, Table, Value};
use holonom::record::RecordedBody;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};
use holonom::system::{Place, Term};

use super::change::{Change, Matrix, product, transposed};
use super::transform::Coordinates;

/// Moments of a run that are looked at, beside its start.
const MOMENTS: usize = 20;

/// Iterations a step, on average so far, from which on a run is given up: it would only take time.
const TOO_MANY: u64 = 60;

/// A run and how it ended.
#[derive(Clone, Debug, Default)]
pub struct Track {
    pub moments: Vec<Moment>,
    /// `"completed"`, or why it was not.
    pub status: String,
    /// A step.
    pub iterations: f64,
    /// Freedom, redundant rows and rank at the start.
    pub size: [usize; 3],
}

/// Numbers of a moment, sorted by names.
#[derive(Clone, Debug, Default)]
pub struct Moment {
    pub t: f64,
    /// Points and centres of bodies: places and velocities.
    pub places: Vec<(String, [[f64; 3]; 2])>,
    pub bodies: Vec<(String, Turned)>,
    /// Coordinates of joints and their rates.
    pub coordinates: Vec<(String, [f64; 2])>,
}

/// How a body is turned: Σ e_k ⊗ l_k over the axes that its nodes span, its rate, and Σ l_k ⊗ l_k. That is the rotation
/// matrix where there are three, and does not depend on which there are of a plate or a rod.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turned {
    pub matrix: Matrix,
    pub rate: Matrix,
    pub span: Matrix,
}

/// A description as a model.
pub fn model(description: &Table) -> Result<Model, String> {
    Model::from_value(&Value::Table(description.clone()), &NoFiles).map_err(|faults| format!("refused: {faults:?}"))
}

/// The method of a name.
pub fn method(name: &str) -> Method {
    Method::resolve(&Choice::default().named(name)).expect("the method is there")
}

/// Runs a description for some steps.
pub fn run(description: &Table, name: &str, step: f64, steps: usize) -> Track {
    let model = match model(description) {
        Ok(model) => model,
        Err(status) => return Track { status, ..Track::default() },
    };
    let mut simulation = match Simulation::new(model.system.clone(), method(name), step) {
        Ok(simulation) => simulation,
        Err(error) => return Track { status: error.to_string(), ..Track::default() },
    };
    let rank = rank(&model.system, &simulation.state().x, 0.0).size(&model.system);
    let stride = steps.div_ceil(MOMENTS);
    let (mut moments, mut count) = (Vec::new(), 0);
    let status = simulation.run(steps as f64 * step, &mut |simulation: &Simulation| {
        if count % stride == 0 || count == steps {
            moments.push(moment(&model, simulation));
        }
        count += 1;
        let iterations = simulation.audit().work_summary(simulation.steps()).iterations;
        if iterations > TOO_MANY * count as u64 { Verdict::Stop } else { Verdict::GoOn }
    });
    let status = match status {
        Status::Stopped { reason, .. } if reason == "interrupted" => format!("more than {TOO_MANY} iterations a step"),
        Status::Completed => "completed".to_string(),
        Status::Stopped { reason, .. } => reason,
    };
    let work = simulation.audit().work_summary(simulation.steps());
    Track { moments, status, iterations: work.iterations_per_step, size: [rank.dof, rank.redundant, rank.rank] }
}

/// What a simulation shows at the moment.
pub fn moment(model: &Model, simulation: &Simulation) -> Moment {
    let world = model.system.in_world(&simulation.state().x);
    let (x, v, dim) = (&world[..], simulation.velocities(), model.dimension);
    let place = |terms: &[Term]| [sum(terms, x, dim, 1.0), sum(terms, v, dim, 0.0)];
    // As entries that are written out are called.
    let plain = |name: &str| name.replace('[', "_").replace(']', "");
    let points = model.channels.points.iter().map(|point| (plain(&point.name), place(&point.terms)));
    let centres = model.channels.bodies.iter().map(|body| (plain(&body.name), place(&body.centre)));
    let gauges = simulation.gauges();
    let named = model.system.gauges().iter().enumerate();
    let mut coordinates: Vec<(String, [f64; 2])> = named.map(|(k, name)| (plain(name), [gauges.value[k], gauges.rate[k]])).collect();
    let turned = |body: &RecordedBody| match dim {
        2 => {
            let name = format!("{}.angle", plain(&body.name));
            let at = coordinates.iter().position(|(known, _)| *known == name).expect("the angle of a body is measured");
            Turned::plane(coordinates.swap_remove(at).1)
        }
        _ => Turned::space(body, x, v),
    };
    let mut turned = turned;
    let mut bodies: Vec<(String, Turned)> = model.channels.bodies.iter().map(|body| (plain(&body.name), turned(body))).collect();
    let mut places: Vec<_> = points.chain(centres).collect();
    places.sort_by(|a, b| a.0.cmp(&b.0));
    bodies.sort_by(|a, b| a.0.cmp(&b.0));
    coordinates.sort_by(|a, b| a.0.cmp(&b.0));
    Moment { t: simulation.state().t, places, bodies, coordinates }
}

fn sum(terms: &[Term], x: &[f64], dim: usize, fixed: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for term in terms {
        let part: [f64; 3] = match term.place {
            Place::Node(node) => std::array::from_fn(|c| if c < dim { x[node.index() * dim + c] } else { 0.0 }),
            Place::Fixed(x) => x.map(|c| fixed * c),
        };
        (0..dim).for_each(|c| sum[c] += term.factor * part[c]);
        sum[0] -= term.turn * part[1];
        sum[1] += term.turn * part[0];
    }
    sum
}

impl Turned {
    fn plane([angle, rate]: [f64; 2]) -> Self {
        let (sin, cos) = angle.sin_cos();
        let matrix = [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0; 3]];
        let rate = [[-sin * rate, -cos * rate, 0.0], [cos * rate, -sin * rate, 0.0], [0.0; 3]];
        Self { matrix, rate, span: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]] }
    }

    fn space(body: &RecordedBody, x: &[f64], v: &[f64]) -> Self {
        let mut turned = Self::default();
        for (local, terms) in &body.directions {
            let (at, rate) = (sum(terms, x, 3, 1.0), sum(terms, v, 3, 0.0));
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                turned.matrix[i][j] += at[i] * local[j];
                turned.rate[i][j] += rate[i] * local[j];
                turned.span[i][j] += local[i] * local[j];
            }
        }
        turned
    }
}

impl Moment {
    /// As it is seen before the change.
    pub fn back(&self, change: &Change, known: &Coordinates) -> Self {
        let place = |[x, v]: [[f64; 3]; 2]| [change.position_back(x, self.t), change.velocity_back(v)];
        let turned = |turned: Turned| Turned {
            matrix: change.orientation_back(&turned.matrix),
            rate: change.orientation_back(&turned.rate).map(|row| row.map(|c| c * change.time)),
            span: product(&product(&change.over(), &turned.span), &transposed(&change.over())),
        };
        let coordinate = |(name, [value, rate]): &(String, [f64; 2])| {
            let known = known.get(name).unwrap_or_else(|| panic!("no coordinate {name}"));
            let factor = known.factor(change);
            // Axes that the engine chose have turned in a way of their own.
            let is_known = !(known.is_free && change.turns());
            is_known.then(|| (name.clone(), [value / factor, rate * change.time / factor]))
        };
        Self {
            t: self.t / change.time,
            places: self.places.iter().map(|(name, at)| (name.clone(), place(*at))).collect(),
            bodies: self.bodies.iter().map(|(name, at)| (name.clone(), turned(*at))).collect(),
            coordinates: self.coordinates.iter().filter_map(coordinate).collect(),
        }
    }
}

impl Moment {
    /// Without rates of coordinates: off the constraints they depend on the axes that they are measured along, which are
    /// the engine's choice.
    pub fn without_rates(mut self) -> Self {
        self.coordinates.iter_mut().for_each(|(_, [_, rate])| *rate = 0.0);
        self
    }

    /// With angles counted from the turn nearest to that of another moment.
    pub fn on_turn_of(&mut self, other: &Self, known: &Coordinates) {
        for ((name, [angle, _]), (_, [near, _])) in self.coordinates.iter_mut().zip(&other.coordinates) {
            if known[name].is_angle {
                *angle += ((*near - *angle) / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            }
        }
    }

    /// With all velocities turned round.
    pub fn turn_round(&mut self) {
        self.places.iter_mut().for_each(|(_, [_, v])| *v = v.map(|c| -c));
        self.bodies.iter_mut().for_each(|(_, body)| body.rate = body.rate.map(|row| row.map(|c| -c)));
        self.coordinates.iter_mut().for_each(|(_, [_, rate])| *rate = -*rate);
    }
}

/// What counts as one: of places, of velocities, of angular velocities.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    pub length: f64,
    pub speed: f64,
    pub spin: f64,
    /// The smallest radius of gyration: what turns round-off of places into that of angles.
    pub lever: f64,
}

impl Scale {
    /// The box around the motion or the largest radius of gyration; the largest speeds, and at least once through that
    /// box over the run.
    pub fn new(model: &Model, moments: &[Moment]) -> Self {
        let all = || moments.iter().flat_map(|moment| moment.places.iter().map(|(_, at)| at));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        all().for_each(|[x, _]| (0..3).for_each(|c| (low[c], high[c]) = (low[c].min(x[c]), high[c].max(x[c]))));
        let diagonal = norm(&std::array::from_fn(|c| high[c] - low[c]));
        let gyrations = model.bodies.iter().map(|body| (body.inertia.trace() / body.mass).sqrt());
        let gyration = gyrations.clone().fold(diagonal, f64::max);
        // A single point that rests has no size: where it is from the origin is all that there is of it.
        let far = all().map(|[x, _]| norm(x)).fold(0.0, f64::max);
        let length = [gyration, far, 1.0].into_iter().find(|&length| length > 0.0).expect("one is above zero");
        let fastest = all().map(|[_, v]| norm(v)).fold(0.0, f64::max);
        let rates = moments.iter().flat_map(|moment| moment.bodies.iter().map(|(_, body)| size(&body.rate)));
        let duration = moments.last().map_or(1.0, |last| last.t);
        let spin = rates.fold((fastest / length).max(1.0 / duration), f64::max);
        Self { length, speed: fastest.max(spin * length), spin, lever: gyrations.fold(length, f64::min) }
    }
}

fn norm(x: &[f64; 3]) -> f64 {
    x.iter().map(|c| c * c).sum::<f64>().sqrt()
}

fn size(matrix: &Matrix) -> f64 {
    matrix.iter().map(|row| row.iter().map(|c| c * c).sum::<f64>()).sum::<f64>().sqrt()
}

fn difference(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    norm(&std::array::from_fn(|c| a[c] - b[c]))
}

/// The largest difference of two moments over the scale, and what differs.
pub fn differs(a: &Moment, b: &Moment, known: &Coordinates, scale: &Scale) -> (f64, String) {
    let mut worst = (0.0_f64, String::new());
    let mut found = |figure: f64, name: &str, what: &str| {
        if figure.is_nan() || figure > worst.0 {
            worst = (if figure.is_nan() { f64::INFINITY } else { figure }, format!("{what} of {name} at t = {:.4}", a.t));
        }
    };
    fn names<T>(of: &[(String, T)]) -> impl Iterator<Item = &String> {
        of.iter().map(|(name, _)| name)
    }
    assert!(names(&a.places).eq(names(&b.places)) && names(&a.bodies).eq(names(&b.bodies)), "the same points and bodies");
    for ((name, [x, v]), (_, [y, w])) in a.places.iter().zip(&b.places) {
        found(difference(x, y) / scale.length, name, "place");
        found(difference(v, w) / scale.speed, name, "velocity");
    }
    for ((name, a), (_, b)) in a.bodies.iter().zip(&b.bodies) {
        // What both know of it.
        let common = product(&a.span, &b.span);
        let apart = |a: &Matrix, b: &Matrix| {
            let [a, b] = [product(a, &common), product(b, &common)];
            size(&std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] - b[i][j])))
        };
        found(apart(&a.matrix, &b.matrix), name, "orientation");
        found(apart(&a.rate, &b.rate) / scale.spin, name, "angular velocity");
    }
    for (name, [q, rate]) in &a.coordinates {
        let Some((_, [p, other])) = b.coordinates.iter().find(|(known, _)| known == name) else { continue };
        let (one, fast) = if known[name].is_angle { (q.abs().max(1.0), scale.spin) } else { (scale.length, scale.speed) };
        found((q - p).abs() / one, name, "coordinate");
        found((rate - other).abs() / fast, name, "rate");
    }
    worst
}
