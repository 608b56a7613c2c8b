//! The matrix [M Gᵀ; G −δ] of a system whose rigid bodies have nodes of their own, in the twists of these (methods §17).
//!
//! Nodes of a rigid body move by B ξ + c: ξ are velocity of its first point and angular velocity, or their rates, and c is any motion that the rows
//! which keep the body rigid ask for. Bᵀ leaves nothing of what these rows exert, so that
//! ```text
//! [ BᵀM B  BᵀGᵀ ] [ξ]     [ Bᵀ(f − M c) ]
//! [ G B     −δ  ] [λ]  =  [   g − G c   ]
//! ```
//! has the rows between bodies alone: of a body in space 6 unknowns in place of 12 and 6 multipliers.

use nalgebra::Matrix3;
use smallvec::SmallVec;

use super::augmented::Augmented;
use super::failure::{Failure, Unknown};
use super::passes::{LinearSystem, Purpose, react};
use super::rank::REDUNDANT;
use super::standing::Sure;
use super::workspace::Workspace;
use crate::linalg::{Singular, Solver};
use crate::system::{MassBlock, RowSlot, System, add_along_rows, cross};

mod plan;

/// How a free node moves with the unknowns.
#[derive(Clone, Copy)]
struct Motion {
    /// First of the velocity that it has, which a direction of a body has not.
    moves: Option<u32>,
    /// First of the angular velocity that turns it about the first point of its body.
    turns: Option<u32>,
}

/// A rigid body.
struct Body {
    /// Its nodes, the first of them a point, and how many it has.
    nodes: [u32; 4],
    count: usize,
    /// First of the rows that keep it rigid: products of its edges, each with itself and those after it.
    inner: u32,
    /// The inverse of the products of its edges, where the matrix was last written.
    reciprocal: Matrix3<f64>,
}

/// The block of two nodes that are no body's.
struct Lone {
    mass: MassBlock,
    /// By rows (D × D).
    places: Vec<u32>,
}

/// What a row has in common with a velocity or an angular velocity: place of each component in the multiplier's column and in its row.
type Touch = SmallVec<[[u32; 2]; 3]>;

/// A row between bodies.
struct Outer {
    /// By the system's rows, and by the unknowns.
    row: u32,
    unknown: u32,
    diagonal: u32,
    /// G M⁻¹ Gᵀ of the row where its bodies are free, as the start has them, or what counts in place of that.
    alone: f64,
}

/// The matrix, planned once. What a body or a row has is in one list for all of them, as it is read one after the other: far more of it than fits
/// near the processor.
pub struct Twists {
    dim: usize,
    motions: Vec<Motion>,
    bodies: Vec<Body>,
    /// The blocks of the mass matrices of the bodies (nodes × nodes), and where their blocks of this matrix are, by rows.
    masses: Vec<MassBlock>,
    places: Vec<u32>,
    lone: Vec<Lone>,
    touches: Vec<Touch>,
    /// The nodes of the rows between bodies, and what each row has in common with the velocity and the angular velocity that move the node.
    slots: Vec<RowSlot>,
    touched: Vec<[Option<u32>; 2]>,
    outer: Vec<Outer>,
    augmented: Vec<Augmented>,
    /// Whether no body is light.
    is_even: bool,
    solver: Solver,
    /// From the first point of its body to each node, or along it (D × free nodes), m.
    arms: Vec<f64>,
    /// Gradients by the velocities and angular velocities of the touches.
    gradients: Vec<[f64; 3]>,
    /// The motion c of all nodes, and M c.
    inner: Vec<f64>,
    inertial: Vec<f64>,
    reduced: Vec<f64>,
    /// What a number of the right side is multiplied by to be an acceleration of what it acts on, of the ends of directions where it turns them.
    agility: Vec<f64>,
    unknowns: Vec<f64>,
}

impl Twists {
    /// Accelerations and multipliers at the end position and velocity of a workspace that has the evaluation there, as
    /// [`Newton::show_reactions`](super::Newton::show_reactions) finds them; multipliers of the rows that keep bodies rigid stay zero.
    pub fn show_reactions(&mut self, sure: Option<&Sure>, system: &System, t: f64, work: &mut Workspace) -> Result<bool, Failure> {
        react(self, Purpose::Show(sure), system, t, work)
    }

    /// What rows between bodies must add to be sure, by what they add at the evaluation of the end, which is that of the start.
    pub fn sure(&mut self, system: &System, work: &Workspace) -> Option<Sure> {
        Sure::of(self, system, work)
    }

    /// The node or row whose pivot is none, where its numbers are such.
    fn blame(&mut self, Singular { pivot }: Singular) -> Failure {
        if self.solver.values_mut().iter().any(|value| !value.is_finite()) {
            return Failure::NotFinite;
        }
        let is_moved = |motion: &Motion| {
            [motion.moves, motion.turns].into_iter().flatten().any(|first| (first as usize..first as usize + 3).contains(&pivot))
        };
        Failure::Singular(match self.outer.iter().find(|outer| outer.unknown as usize == pivot) {
            Some(outer) => Unknown::Row(outer.row as usize),
            None => Unknown::Node(self.motions.iter().position(is_moved).unwrap_or(0)),
        })
    }
}

impl LinearSystem for Twists {
    fn factor(&mut self, rho: f64, work: &Workspace) -> Result<f64, Failure> {
        match self.dim {
            2 => self.write_in::<2>(work)?,
            _ => self.write_in::<3>(work)?,
        }
        let values = self.solver.values_mut();
        let softness = &work.scales.softness;
        self.outer.iter().for_each(|outer| values[outer.diagonal as usize] -= softness[outer.row as usize] / rho);
        self.augmented.iter_mut().for_each(|row| row.add(values));
        self.solver.factor().map_err(|singular| self.blame(singular))?;
        let share = |outer: &Outer| self.solver.pivot(outer.unknown as usize) / softness[outer.row as usize] - 1.0 / rho;
        let weakest = self.outer.iter().map(share).fold(1.0, f64::min);
        Ok(if weakest > REDUNDANT { (1.0 / (rho * weakest)).min(1.0) } else { 1.0 })
    }

    fn solver(&self) -> &Solver {
        &self.solver
    }

    fn shares(&self, rho: f64, work: &Workspace) -> impl Iterator<Item = f64> {
        let delta = move |outer: &Outer| work.scales.softness[outer.row as usize] / rho;
        self.outer.iter().map(move |outer| (self.solver.pivot(outer.unknown as usize) - delta(outer)) / outer.alone)
    }

    fn is_even(&self, _: &Workspace) -> bool {
        self.is_even
    }

    fn unknowns(&mut self) -> &mut [f64] {
        &mut self.unknowns
    }

    fn solve(&mut self, system: &System, work: &Workspace) -> Result<(), Failure> {
        match self.dim {
            2 => self.solve_in::<2>(system, work),
            _ => self.solve_in::<3>(system, work),
        }
    }

    fn accelerates(&mut self, _: &System, work: &Workspace) -> f64 {
        self.inertial.fill(0.0);
        match self.dim {
            2 => self.sum_wrenches::<2>(),
            _ => self.sum_wrenches::<3>(),
        }
        let coordinates = self.reduced.iter().zip(&self.agility).fold(0.0, |m: f64, (number, agility)| m.max((number * agility).abs()));
        coordinates.max(work.scaled(&self.unknowns[self.motions.len() * self.dim..]))
    }
}

impl Twists {
    /// Writes the matrix without δ at the evaluation of the end.
    fn write_in<const D: usize>(&mut self, work: &Workspace) -> Result<(), Failure> {
        for body in &mut self.bodies {
            body.set_arms::<D>(&self.motions, &work.end.x, &mut self.arms);
            body.reciprocal = body.products::<D>(&self.arms).try_inverse().ok_or(Failure::Singular(Unknown::Node(body.node(1))))?;
        }
        self.gather::<D>(&work.end.at.gradient);
        let values = self.solver.values_mut();
        values.fill(0.0);
        let (mut masses, size) = (&self.masses[..], D + turns(D));
        for (body, places) in self.bodies.iter().zip(self.places.chunks_exact(size * size)) {
            let (mass, others) = masses.split_at(body.count.pow(2));
            let block = body.inertia::<D>(mass, &self.motions, &self.arms);
            masses = others;
            for (places, line) in places.chunks_exact(size).zip(&block) {
                places.iter().zip(line).for_each(|(&place, number)| values[place as usize] += number);
            }
        }
        for Lone { mass, places } in &self.lone {
            for c in 0..D {
                values[places[c * D + c] as usize] += mass.m;
            }
            if mass.s != 0.0 {
                values[places[1] as usize] -= mass.s;
                values[places[2] as usize] += mass.s;
            }
        }
        for (touch, gradient) in self.touches.iter().zip(&self.gradients) {
            for ([column, row], g) in touch.iter().zip(gradient) {
                values[*column as usize] += g;
                values[*row as usize] += g;
            }
        }
        Ok(())
    }

    /// Takes over the gradients of the rows between bodies.
    fn gather<const D: usize>(&mut self, gradients: &[f64]) {
        let (arms, gradients) = (self.arms.as_chunks::<D>().0, gradients.as_chunks::<D>().0);
        self.gradients.fill([0.0; 3]);
        for (&RowSlot { slot, node, .. }, touches) in self.slots.iter().zip(&self.touched) {
            let gradient = &gradients[slot as usize];
            if let Some(touch) = touches[0] {
                add(&mut self.gradients[touch as usize], gradient);
            }
            if let Some(touch) = touches[1] {
                add(&mut self.gradients[touch as usize], &turned(&arms[node as usize], gradient));
            }
        }
    }

    fn solve_in<const D: usize>(&mut self, system: &System, work: &Workspace) -> Result<(), Failure> {
        self.reduce::<D>(system, work);
        self.augmented.iter().for_each(|row| row.pull(&mut self.reduced));
        self.solver.solve(&mut self.reduced);
        if !self.reduced.iter().all(|u| u.is_finite()) {
            return Err(Failure::NotFinite);
        }
        self.expand::<D>();
        Ok(())
    }

    /// Brings the right side in the unknowns to that of the matrix.
    fn reduce<const D: usize>(&mut self, system: &System, work: &Workspace) {
        let coordinates = self.motions.len() * D;
        let rows = &mut self.unknowns[coordinates..];
        self.bodies.iter().for_each(|body| body.keep_rigid::<D>(&self.arms, rows, &mut self.inner));
        system.mass.times(D, &self.inner, &mut self.inertial);
        self.sum_wrenches::<D>();
        let rows = &mut self.unknowns[coordinates..];
        add_along_rows(D, &self.slots, -1.0, &work.end.at.gradient, &self.inner, rows);
        self.outer.iter().for_each(|outer| self.reduced[outer.unknown as usize] = rows[outer.row as usize]);
    }

    /// Brings the forces in the unknowns, without what c takes of them, to those on bodies and lone nodes.
    fn sum_wrenches<const D: usize>(&mut self) {
        let Self { motions, arms, inertial, reduced, unknowns, .. } = self;
        let [arms, inertial, unknowns] = [&arms[..], &inertial[..], &unknowns[..]].map(|numbers| numbers.as_chunks::<D>().0);
        reduced.fill(0.0);
        for (((motion, arm), force), inertial) in motions.iter().zip(arms).zip(unknowns).zip(inertial) {
            let force: [f64; D] = std::array::from_fn(|c| force[c] - inertial[c]);
            if let Some(first) = motion.moves {
                add(&mut reduced[first as usize..][..D], &force);
            }
            if let Some(first) = motion.turns {
                add(&mut reduced[first as usize..][..turns(D)], &turned(arm, &force));
            }
        }
    }

    /// Brings the solution of the matrix back to the unknowns.
    fn expand<const D: usize>(&mut self) {
        let Self { motions, outer, arms, inner, reduced, unknowns, .. } = self;
        let (forces, rows) = unknowns.split_at_mut(motions.len() * D);
        let [arms, inner] = [&arms[..], &inner[..]].map(|numbers| numbers.as_chunks::<D>().0);
        for (((motion, arm), inner), force) in motions.iter().zip(arms).zip(inner).zip(forces.as_chunks_mut::<D>().0) {
            *force = *inner;
            if let Some(first) = motion.moves {
                add(force, &reduced[first as usize..][..D]);
            }
            if let Some(first) = motion.turns {
                add(force, &carried(&reduced[first as usize..][..turns(D)], arm));
            }
        }
        rows.fill(0.0);
        outer.iter().for_each(|outer| rows[outer.row as usize] = reduced[outer.unknown as usize]);
    }
}

impl Body {
    fn node(&self, k: usize) -> usize {
        self.nodes[k] as usize
    }

    /// Sets the arms of its nodes at the positions `x` of all nodes.
    fn set_arms<const D: usize>(&self, motions: &[Motion], x: &[f64], arms: &mut [f64]) {
        let (x, arms) = (x.as_chunks::<D>().0, arms.as_chunks_mut::<D>().0);
        for k in 1..self.count {
            let node = self.node(k);
            let from = if motions[node].moves.is_some() { x[self.node(0)] } else { [0.0; D] };
            arms[node] = std::array::from_fn(|c| x[node][c] - from[c]);
        }
    }

    /// The inertia at the positions `x` of all nodes, of which it sets its arms.
    fn inertia_at<const D: usize>(&self, mass: &[MassBlock], motions: &[Motion], x: &[f64], arms: &mut [f64]) -> [[f64; 6]; 6] {
        self.set_arms::<D>(motions, x, arms);
        self.inertia::<D>(mass, motions, arms)
    }

    /// BᵀM B of the blocks of its mass matrix, by the velocity of the first point, then the angular velocity.
    fn inertia<const D: usize>(&self, mass: &[MassBlock], motions: &[Motion], arms: &[f64]) -> [[f64; 6]; 6] {
        let arms = self.arms::<D>(arms);
        let moves: [bool; 4] = std::array::from_fn(|k| k < self.count && motions[self.node(k)].moves.is_some());
        // Mass, first moments and second ones.
        let (mut all, mut first, mut second) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        for (a, row) in mass.chunks_exact(self.count).enumerate() {
            let mut carried = [0.0; D];
            for ((block, arm), moves_too) in row.iter().zip(&arms).zip(&moves) {
                for c in 0..D {
                    carried[c] += block.m * arm[c];
                }
                if D == 2 {
                    carried[0] -= block.s * arm[1];
                    carried[1] += block.s * arm[0];
                }
                all += if moves[a] && *moves_too { block.m } else { 0.0 };
            }
            if moves[a] {
                add(&mut first, &carried);
            }
            for (line, arm) in second.iter_mut().zip(&arms[a]) {
                for d in 0..D {
                    line[d] += arm * carried[d];
                }
            }
        }
        let trace = second[0][0] + second[1][1] + second[2][2];
        let mut matrix = [[0.0; 6]; 6];
        (0..D).for_each(|c| matrix[c][c] = all);
        if D == 2 {
            [matrix[0][2], matrix[1][2]] = [-first[1], first[0]];
            matrix[2] = [-first[1], first[0], trace, 0.0, 0.0, 0.0];
            return matrix;
        }
        for c in 0..3 {
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            // ω × first moment.
            (matrix[i][3 + j], matrix[3 + j][i]) = (first[c], first[c]);
            (matrix[j][3 + i], matrix[3 + i][j]) = (-first[c], -first[c]);
            for d in 0..3 {
                // A rod does not turn about itself as far as its nodes show it.
                matrix[3 + c][3 + d] = if c == d { trace } else { 0.0 } - if self.count > 2 { second[c][d] } else { 0.0 };
            }
        }
        matrix
    }

    /// The arms of its nodes, of which all but the first are its edges; zeros where it has fewer.
    fn arms<const D: usize>(&self, arms: &[f64]) -> [[f64; D]; 4] {
        let arms = arms.as_chunks::<D>().0;
        std::array::from_fn(|k| if k < self.count { arms[self.node(k)] } else { [0.0; D] })
    }

    /// Products of its edges, and 1 where there are fewer than three.
    fn products<const D: usize>(&self, arms: &[f64]) -> Matrix3<f64> {
        let ([_, edges @ ..], mut products) = (self.arms::<D>(arms), Matrix3::identity());
        for i in 0..self.count - 1 {
            for j in 0..self.count - 1 {
                products[(i, j)] = edges[i].iter().zip(&edges[j]).map(|(a, b)| a * b).sum();
            }
        }
        products
    }

    /// The motion of its edges that changes their products by what stands at the rows which keep it rigid: half of that along the edges that are
    /// reciprocal to them.
    fn keep_rigid<const D: usize>(&self, arms: &[f64], rows: &[f64], motion: &mut [f64]) {
        let ([_, edges @ ..], motion) = (self.arms::<D>(arms), motion.as_chunks_mut::<D>().0);
        let (mut row, mut change) = (self.inner as usize, Matrix3::zeros());
        for i in 0..self.count - 1 {
            for j in i..self.count - 1 {
                let asked = if i == j { rows[row] } else { 0.5 * rows[row] };
                (change[(i, j)], change[(j, i)]) = (asked, asked);
                row += 1;
            }
        }
        let shares = change * self.reciprocal;
        for i in 0..self.count - 1 {
            let mut sum = [0.0; D];
            for (j, edge) in edges.iter().enumerate() {
                for c in 0..D {
                    sum[c] += shares[(i, j)] * edge[c];
                }
            }
            motion[self.node(i + 1)] = sum;
        }
    }
}

/// Adds numbers to the first of others.
#[inline]
fn add(sum: &mut [f64], numbers: &[f64]) {
    sum.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
}

/// Numbers of an angular velocity.
#[inline]
fn turns(dim: usize) -> usize {
    if dim == 2 { 1 } else { 3 }
}

/// The moment of a force with an arm; in the plane its first component.
#[inline]
fn turned(arm: &[f64], force: &[f64]) -> [f64; 3] {
    match (arm, force) {
        (&[x, y], &[fx, fy]) => [x * fy - y * fx, 0.0, 0.0],
        (&[x, y, z], &[fx, fy, fz]) => cross(&[x, y, z], &[fx, fy, fz]),
        _ => unreachable!("vectors of the plane or of space"),
    }
}

/// The velocity of an arm that turns.
#[inline]
fn carried(rate: &[f64], arm: &[f64]) -> [f64; 3] {
    match (rate, arm) {
        (&[w], &[x, y]) => [-w * y, w * x, 0.0],
        (&[wx, wy, wz], &[x, y, z]) => cross(&[wx, wy, wz], &[x, y, z]),
        _ => unreachable!("vectors of the plane or of space"),
    }
}
