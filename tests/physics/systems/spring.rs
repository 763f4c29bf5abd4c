//! A body that is not rigid, as a user of the library writes one: two masses on a linear spring
//! with a damper, with a ball each or one ball half-way between them as contactors. The spring may
//! stiffen as it is stretched.

use fretwork::bodies::{Contactor, ContactorShape, DynamicalSystem, Nodes, SystemStep, SystemWork};
use fretwork::geometry::space::{Space, VectorLike};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Contactors of the system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touching {
    /// A ball about each mass.
    Ends,
    /// A ball about each mass; the balls may touch each other.
    EndsEachOther,
    /// A ball half-way between the masses.
    Middle,
}

/// Number of calls of the functions that a step should call once.
#[derive(Debug, Default)]
pub struct Calls {
    pub linearise: AtomicUsize,
    pub solve: AtomicUsize,
    pub contact_nodes: AtomicUsize,
}

impl Calls {
    fn count(counter: &AtomicUsize) {
        counter.fetch_add(1, Ordering::Relaxed);
    }

    /// Returns the numbers of tangents, solves and contact nodes since the last call.
    pub fn take(&self) -> [usize; 3] {
        [&self.linearise, &self.solve, &self.contact_nodes].map(|c| c.swap(0, Ordering::Relaxed))
    }
}

/// The spring acts along all axes alike, with s = d2 - d1 along an axis, d the displacements from
/// rest: the force on the first mass is k (s + stiffening s^3) + c ds/dt.
#[derive(Clone, Debug)]
pub struct Spring<S: Space> {
    pub mass: [f64; 2],
    pub stiffness: f64,
    /// Stiffening; zero for a linear spring (1/m^2).
    pub stiffening: f64,
    pub damping: f64,
    pub radius: f64,
    pub touching: Touching,
    pub driven: bool,
    pub calls: Arc<Calls>,
    /// Positions of the masses without load (m).
    pub home: [S::Vector; 2],
    /// Displacements and velocities of the first mass, then of the second.
    pub displacement: Vec<f64>,
    pub velocity: Vec<f64>,
    /// Displacements and velocities at the start of the step.
    start: [Vec<f64>; 2],
    /// Inverse of A for each axis.
    inverse: [[[f64; 2]; 2]; 3],
}

impl<S: Space> Spring<S> {
    /// Returns the system at rest, undamped, with a ball of a radius (m) about each mass.
    pub fn new(mass: [f64; 2], stiffness: f64, radius: f64, home: [S::Vector; 2]) -> Self {
        Self {
            mass,
            stiffness,
            stiffening: 0.0,
            damping: 0.0,
            radius,
            touching: Touching::Ends,
            driven: false,
            calls: Arc::default(),
            home,
            displacement: vec![0.0; 2 * S::D],
            velocity: vec![0.0; 2 * S::D],
            start: [vec![0.0; 2 * S::D], vec![0.0; 2 * S::D]],
            inverse: [[[0.0; 2]; 2]; 3],
        }
    }

    /// Sets the velocities of both masses along the first axis (m/s).
    pub fn moving(mut self, first: f64, second: f64) -> Self {
        (self.velocity[0], self.velocity[S::D]) = (first, second);
        self
    }

    fn of(values: &[f64], node: usize) -> S::Vector {
        S::Vector::from_slice(&values[node * S::D..(node + 1) * S::D])
    }

    fn stretch(values: &[f64]) -> S::Vector {
        Self::of(values, 1) - Self::of(values, 0)
    }

    fn pull(&self, stretch: f64) -> f64 {
        self.stiffness * (stretch + self.stiffening * stretch.powi(3))
    }

    fn tangent(&self, stretch: f64) -> f64 {
        self.stiffness * (1.0 + 3.0 * self.stiffening * stretch * stretch)
    }

    fn stored(&self, stretch: f64) -> f64 {
        let squared = stretch * stretch;
        self.stiffness * (0.5 * squared + 0.25 * self.stiffening * squared * squared)
    }

    /// Stretch that the step would reach at theta without forces.
    fn expected(&self, step: &SystemStep<S>) -> S::Vector {
        let [x, v] = &self.start;
        Self::stretch(x) + Self::stretch(v) * (step.h * step.theta)
    }

    fn form(&mut self, step: &SystemStep<S>, stretch: &S::Vector) {
        let SystemStep { h, theta, .. } = *step;
        let [m, n] = self.mass;
        for k in 0..S::D {
            let b = h * theta * self.damping + (h * theta).powi(2) * self.tangent(stretch[k]);
            let determinant = m * n + b * (m + n);
            self.inverse[k] = [[n + b, b], [b, m + b]].map(|row| row.map(|x| x / determinant));
        }
    }
}

impl<S: Space> DynamicalSystem<S> for Spring<S> {
    fn name(&self) -> &str {
        "two masses on a spring"
    }

    fn freedoms(&self) -> usize {
        2 * S::D
    }

    fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    fn set_velocity(&mut self, velocity: &[f64]) {
        self.velocity.copy_from_slice(velocity);
    }

    fn begin_step(&mut self, step: &SystemStep<S>) {
        self.start = [self.displacement.clone(), self.velocity.clone()];
        if self.stiffening == 0.0 {
            self.form(step, &S::Vector::zero());
        }
    }

    fn linearise(&mut self, step: &SystemStep<S>) {
        Calls::count(&self.calls.linearise);
        if self.stiffening != 0.0 {
            let stretch = self.expected(step);
            self.form(step, &stretch);
        }
    }

    fn advance(&mut self, time: f64) {
        for (x, v) in self.displacement.iter_mut().zip(&self.velocity) {
            *x += v * time;
        }
    }

    fn free_velocity(&self, step: &SystemStep<S>) -> Vec<f64> {
        let [_, v] = &self.start;
        let rate = Self::stretch(v);
        let stretch = self.expected(step);
        let mut force = rate * self.damping;
        let mut impulse = vec![0.0; 2 * S::D];
        for k in 0..S::D {
            force[k] += self.pull(stretch[k]);
            impulse[k] = step.h * (self.mass[0] * step.gravity[k] + force[k]);
            impulse[S::D + k] = step.h * (self.mass[1] * step.gravity[k] - force[k]);
        }
        self.solve(&mut impulse);
        impulse.iter().zip(v).map(|(dv, v)| v + dv).collect()
    }

    fn solve(&self, impulse: &mut [f64]) {
        Calls::count(&self.calls.solve);
        for k in 0..S::D {
            let p = [impulse[k], impulse[S::D + k]];
            for (node, row) in self.inverse[k].iter().enumerate() {
                impulse[node * S::D + k] = row[0] * p[0] + row[1] * p[1];
            }
        }
    }

    fn work(&self, step: &SystemStep<S>) -> SystemWork {
        let SystemStep { h, theta, .. } = *step;
        let old = &self.start[1];
        let pairs = old.iter().zip(&self.velocity);
        let average: Vec<f64> = pairs.map(|(v, w)| (1.0 - theta) * v + theta * w).collect();
        let rate = Self::stretch(&average);
        let mut work = SystemWork {
            damping: h * self.damping * rate.dot(&rate),
            ..SystemWork::default()
        };
        if self.stiffening == 0.0 {
            work.scheme = (theta - 0.5) * h * h * self.stiffness * rate.dot(&rate);
        } else {
            let (from, to) = (
                Self::stretch(&self.start[0]),
                Self::stretch(&self.displacement),
            );
            let (expected, change) = (
                self.expected(step),
                Self::stretch(&self.velocity) - Self::stretch(old),
            );
            for k in 0..S::D {
                let tangent = self.tangent(expected[k]);
                let force = self.pull(expected[k]) + tangent * theta * theta * h * change[k];
                work.scheme += h * force * rate[k] - (self.stored(to[k]) - self.stored(from[k]));
            }
        }
        for (node, mass) in self.mass.iter().enumerate() {
            work.potential -= h * mass * step.gravity.dot(&Self::of(&average, node));
            let change = Self::of(&self.velocity, node) - Self::of(old, node);
            work.scheme += (theta - 0.5) * mass * change.dot(&change);
        }
        work
    }

    fn kinetic_energy(&self) -> f64 {
        let of = |node: usize| {
            let v = Self::of(&self.velocity, node);
            0.5 * self.mass[node] * v.dot(&v)
        };
        of(0) + of(1)
    }

    fn stored_energy(&self) -> f64 {
        let stretch = Self::stretch(&self.displacement);
        (0..S::D).map(|k| self.stored(stretch[k])).sum()
    }

    fn mass(&self) -> f64 {
        self.mass[0] + self.mass[1]
    }

    fn node_position(&self, node: u32) -> S::Vector {
        let node = node as usize;
        self.home[node] + Self::of(&self.displacement, node)
    }

    fn node_velocity(&self, node: u32, velocity: &[f64]) -> S::Vector {
        Self::of(velocity, node as usize)
    }

    fn add_impulse(&self, node: u32, impulse: &S::Vector, generalised: &mut [f64]) {
        for k in 0..S::D {
            generalised[node as usize * S::D + k] += impulse[k];
        }
    }

    fn contactors(&self) -> Vec<Contactor> {
        let ball = |nodes| Contactor {
            nodes,
            radius: self.radius,
            shape: ContactorShape::Ball,
            material: 0,
        };
        match self.touching {
            Touching::Middle => Nodes::sum(&[(0, 0.5), (1, 0.5)])
                .map(ball)
                .into_iter()
                .collect(),
            _ => vec![ball(Nodes::one(0)), ball(Nodes::one(1))],
        }
    }

    fn contact_nodes(&self, contactor: &Contactor, _: &S::Vector) -> Nodes {
        Calls::count(&self.calls.contact_nodes);
        contactor.nodes.clone()
    }

    fn is_driven(&self) -> bool {
        self.driven
    }

    fn touches_itself(&self) -> bool {
        self.touching == Touching::EndsEachOther
    }

    fn save(&self) -> Vec<u8> {
        let numbers = self.displacement.iter().chain(&self.velocity);
        numbers.flat_map(|x| x.to_le_bytes()).collect()
    }

    fn restore(&mut self, saved: &[u8]) -> bool {
        let numbers: Vec<f64> = saved
            .chunks(8)
            .filter_map(|b| b.try_into().ok().map(f64::from_le_bytes))
            .collect();
        let fits = saved.len() == 32 * S::D && numbers.iter().all(|x| x.is_finite());
        if fits {
            self.displacement.copy_from_slice(&numbers[..2 * S::D]);
            self.velocity.copy_from_slice(&numbers[2 * S::D..]);
        }
        fits
    }

    fn clone_box(&self) -> Box<dyn DynamicalSystem<S>> {
        Box::new(self.clone())
    }
}
