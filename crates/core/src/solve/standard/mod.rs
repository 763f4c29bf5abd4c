//! The problem of a step for the solvers of [`super::local`]: blocks of unknowns, each with its
//! law, and W applied matrix-free from bodies.
//!
//! A contact gives one block. Its bond gives a second one: p_el = -(a + B u), written as u +
//! (p_el + a)/B = 0, is a frictionless law whose compliance 1/B is added to the diagonal of W.
//! Rolling friction and the moments of a bond are treated likewise. Tension c_n and terms that do
//! not depend on velocities are part of the free velocities.

mod bodies;
mod motion;
mod pattern;

use super::error::Norm;
use super::form::{ContactForm, Mobility, RowPlace};

use super::local::csr::Csr;
#[cfg(test)]
use super::local::form::Delassus;
use super::local::form::Form;
use super::local::law::Law;
use super::local::solver::Method;
use super::local::state::{Budget, Iteration};
use super::nodal::NodalSystem;
use super::problem::Problem;
use super::row::{HELD, MomentForm, SystemRow, Term, turning};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
pub(super) use motion::mass;
pub(super) use pattern::{Neighbours, degrees_of_freedom};

use bodies::{Axis, BodyOperator, Motions, Unknown};

/// Impulses of the contacts, and moments; `None` between immovable bodies.
pub(super) type ImpulsesAndMoments<S> = (
    Vec<Option<<S as Space>::Vector>>,
    Vec<Option<<S as Space>::Spin>>,
);

/// Block indices of a contact.
#[derive(Clone, Copy, Debug, Default)]
struct Places {
    contact: Option<u32>,
    bond: Option<u32>,
}

/// The problem of a step in blocks of D unknowns, where D is the dimension of S.
pub struct Standard<'a, S: Space, const D: usize> {
    w: BodyOperator<'a, S, D>,
    laws: Vec<Law>,
    q: Vec<[f64; D]>,
    places: Vec<Places>,
    /// Blocks of friction and bond for each moment.
    moments: Vec<Places>,
    /// Whether a contact carries nothing along its normal at any velocity, see [`open`].
    open: Vec<bool>,
    /// Constant parts of the impulses, in world axes, and of the moments.
    constant: Vec<S::Vector>,
    constant_moments: Vec<S::Spin>,
}

fn frame<S: Space, const D: usize>(n: &S::Vector) -> [S::Vector; D] {
    let [t1, t2] = S::tangents(n);
    std::array::from_fn(|k| match k {
        0 => *n,
        1 => t1,
        _ => t2,
    })
}

/// Returns the axes of rotation: twist and bending; in 2D only bending, as second component.
fn spins<S: Space, const D: usize>(n: &S::Vector) -> [S::Spin; D] {
    std::array::from_fn(|k| {
        let mut components = [0.0; 3];
        components[k] = 1.0;
        S::spin_from(n, components)
    })
}

impl<'a, S: Space, const D: usize> Standard<'a, S, D> {
    /// Builds the blocks from the forms that were pushed into a problem.
    pub fn new(
        problem: &'a Problem<S>,
        forms: &[ContactForm<S>],
        moments: &[MomentForm<S>],
    ) -> Self {
        let mut out = Self {
            w: BodyOperator::new(&problem.masses, &problem.systems),
            laws: Vec::new(),
            q: Vec::new(),
            places: Vec::with_capacity(forms.len()),
            moments: Vec::with_capacity(moments.len()),
            open: vec![false; forms.len()],
            constant: vec![S::Vector::zero(); forms.len()],
            constant_moments: vec![S::Spin::zero(); moments.len()],
        };
        for (k, form) in forms.iter().enumerate() {
            let places = out.push_contact(problem, form, k);
            out.places.push(places);
        }
        for (k, form) in moments.iter().enumerate() {
            let places = out.push_moment(problem, form, &forms[form.contact as usize], k);
            out.moments.push(places);
        }
        out.free(problem, forms, moments);
        out.w.diagonal = (0..out.laws.len()).map(|c| out.w.coupling(c, c)).collect();
        out
    }

    /// The row of a contact with a dynamical system.
    fn system_row(problem: &Problem<S>, k: usize) -> Option<&SystemRow<S>> {
        match problem.places[k] {
            RowPlace::System(r) => Some(&problem.of_systems[r as usize]),
            _ => None,
        }
    }

    fn moves(problem: &Problem<S>, bodies: [u32; 2], row: Option<&SystemRow<S>>) -> bool {
        match row {
            None => bodies.iter().any(|b| problem.masses[*b as usize].moves()),
            Some(row) => {
                let diagonal = (0..S::D).map(|k| row.block().entry(k, k));
                diagonal.fold(0.0, f64::max) > 0.0
            }
        }
    }

    fn add(
        &mut self,
        bodies: [u32; 2],
        (nodes, turns): (&'a [Term], bool),
        axes: [Axis<S>; D],
        law: Law,
    ) -> u32 {
        self.w.unknowns.push(Unknown {
            bodies,
            nodes,
            axes,
            turns,
        });
        self.laws.push(law);
        self.laws.len() as u32 - 1
    }

    fn push_contact(&mut self, problem: &'a Problem<S>, form: &ContactForm<S>, k: usize) -> Places {
        let mut places = Places::default();
        let row = Self::system_row(problem, k);
        if !Self::moves(problem, form.bodies, row) {
            return places;
        }
        let nodes = row.map_or(&[][..], SystemRow::terms);
        let axes: [Axis<S>; D] = frame::<S, D>(&form.normal).map(|linear| Axis {
            linear,
            angular: form.arms.map(|arm| S::moment(&arm, &linear)),
            compliance: 0.0,
        });
        let mu = form.friction;
        let law = if form.cohesion > 0.0 {
            Law::Cohesive {
                mu,
                cohesion: form.cohesion,
            }
        } else {
            Law::Coulomb(mu)
        };
        let mut own = axes;
        for (d, axis) in own.iter_mut().enumerate() {
            axis.compliance = form.compliance[usize::from(d > 0)];
        }
        self.open[k] = open(problem, form, row);
        if self.open[k] {
            // The contact carries no normal impulse at any velocity: w p = 0, without coupling to
            // the bodies.
            let mobility = |b: &u32| {
                form.normal
                    .dot(&form.normal.scaled_by(&problem.masses[*b as usize].mass))
            };
            let along = |row: &SystemRow<S>| form.normal.dot(&row.block().apply(&form.normal));
            let w_n = row.map_or_else(|| form.bodies.iter().map(mobility).sum(), along);
            own[0] = Axis {
                compliance: if w_n > 0.0 { w_n } else { 1.0 },
                ..axes[0].bonded(0.0)
            };
        }
        places.contact = Some(self.add(form.bodies, (nodes, false), own, law));
        self.constant[k] = form.normal * -form.tension;
        if let Some(e) = &form.elastic {
            let mut axes = axes;
            for (d, axis) in axes.iter_mut().enumerate() {
                *axis = axis.bonded(if d == 0 { e.b_n } else { e.b_t });
            }
            // A bond without stiffness has a constant impulse at any velocity.
            let law = if e.tension_only && e.b_n > 0.0 {
                Law::Pull
            } else {
                Law::Free
            };
            if e.b_n == 0.0 {
                let pull = if e.tension_only {
                    (-e.a_n).min(0.0)
                } else {
                    -e.a_n
                };
                self.constant[k] += form.normal * pull;
            }
            if e.b_t == 0.0 {
                self.constant[k] -= S::tangent_vector(&form.normal, &e.a_t);
            }
            places.bond = Some(self.add(form.bodies, (nodes, false), axes, law));
        }
        places
    }

    fn push_moment(
        &mut self,
        problem: &'a Problem<S>,
        form: &MomentForm<S>,
        contact: &ContactForm<S>,
        k: usize,
    ) -> Places {
        let mut places = Places::default();
        let Some(of) = self.places[form.contact as usize].contact else {
            return places;
        };
        let row = &problem.moments[k];
        if !row.turns() {
            return places;
        }
        let nodes = row.terms();
        let axes: [Axis<S>; D] = spins::<S, D>(&contact.normal).map(|spin| Axis {
            linear: S::Vector::zero(),
            angular: [spin; 2],
            compliance: if spin == S::Spin::zero() { 1.0 } else { 0.0 },
        });
        if form.rolling > 0.0 || form.spinning > 0.0 {
            let law = Law::Moment {
                of,
                twist: form.spinning,
                bend: form.rolling,
            };
            places.contact = Some(self.add(contact.bodies, (nodes, true), axes, law));
        }
        if form.b_twist > 0.0 || form.b_bend > 0.0 || form.a != S::Spin::zero() {
            let mut axes = axes;
            for (d, axis) in axes.iter_mut().enumerate() {
                if axis.pushes() {
                    *axis = axis.bonded(if d == 0 { form.b_twist } else { form.b_bend });
                }
            }
            let (twist, bend) = S::split_spin(&contact.normal, &form.a);
            if form.b_twist == 0.0 {
                self.constant_moments[k] -= S::spin_about(&contact.normal, twist);
            }
            if form.b_bend == 0.0 {
                self.constant_moments[k] -= bend;
            }
            places.bond = Some(self.add(contact.bodies, (nodes, true), axes, Law::Free));
        }
        places
    }

    /// Returns the free velocities of bodies and nodes; those of nodes include the effect of the
    /// constant impulses.
    fn free_motions(&self, problem: &Problem<S>, forms: &[ContactForm<S>]) -> Motions<S> {
        let mut bodies = problem.free.clone();
        let rest = |system: &NodalSystem<S>| vec![S::Vector::zero(); system.nodes.len()];
        let mut nodes: Vec<Vec<S::Vector>> = problem.systems.iter().map(rest).collect();
        for (k, (form, p)) in forms.iter().zip(&self.constant).enumerate() {
            let Some(row) = Self::system_row(problem, k) else {
                continue;
            };
            for (body, rigid) in form.bodies.into_iter().zip(row.is_rigid()) {
                if !rigid {
                    bodies[body as usize] = (S::Vector::zero(), S::Spin::zero());
                }
            }
            for term in row.terms() {
                nodes[term.system as usize][term.node as usize] += *p * term.weight;
            }
        }
        for (row, m) in problem.moments.iter().zip(&self.constant_moments) {
            for term in row.terms() {
                nodes[term.system as usize][term.node as usize] += turning::<S>(m) * term.weight;
            }
        }
        self.w.respond(&mut nodes);
        for (nodes, system) in nodes.iter_mut().zip(&problem.systems) {
            for (v, free) in nodes.iter_mut().zip(&system.free) {
                *v += *free;
            }
        }
        Motions { bodies, nodes }
    }

    /// Computes q: free velocities including constant impulses, shifts, and a/B of bonds.
    fn free(&mut self, problem: &Problem<S>, forms: &[ContactForm<S>], moments: &[MomentForm<S>]) {
        let mut motions = self.free_motions(problem, forms);
        for (form, p) in forms.iter().zip(&self.constant) {
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let p = *p * sign;
                let body = form.bodies[side];
                let (v, w) = self.w.mobility(body, (p, S::moment(&form.arms[side], &p)));
                motions.bodies[body as usize].0 += v;
                motions.bodies[body as usize].1 += w;
            }
        }
        for (form, m) in moments.iter().zip(&self.constant_moments) {
            let bodies = forms[form.contact as usize].bodies;
            for (body, sign) in [(bodies[0], 1.0), (bodies[1], -1.0)] {
                let (_, w) = self.w.mobility(body, (S::Vector::zero(), *m * sign));
                motions.bodies[body as usize].1 += w;
            }
        }
        self.q = (0..self.laws.len())
            .map(|c| self.w.relative(c, &motions))
            .collect();
        for ((form, places), open) in forms.iter().zip(&self.places).zip(&self.open) {
            let n = &form.normal;
            if let Some(c) = places.contact {
                let shift = S::components(n, &form.shift_t);
                let q = &mut self.q[c as usize];
                if !open {
                    q[0] += form.shift_n - form.compliance[0] * form.tension;
                }
                for k in 1..D {
                    q[k] += shift[k - 1];
                }
            }
            if let (Some(c), Some(e)) = (places.bond, &form.elastic) {
                let a_t = S::components(n, &e.a_t);
                let a: [f64; D] = std::array::from_fn(|k| if k == 0 { e.a_n } else { a_t[k - 1] });
                offset(&mut self.q[c as usize], &self.w.unknowns[c as usize], &a);
            }
        }
        for (form, places) in moments.iter().zip(&self.moments) {
            if let Some(c) = places.bond {
                let n = &forms[form.contact as usize].normal;
                let a = S::spin_components(n, &form.a);
                let a: [f64; D] = std::array::from_fn(|k| a[k]);
                offset(&mut self.q[c as usize], &self.w.unknowns[c as usize], &a);
            }
        }
    }

    /// Splits total impulses into those of the blocks; the bond's part follows from the resulting
    /// velocities.
    fn start(&self, problem: &Problem<S>, forms: &[ContactForm<S>]) -> Vec<[f64; D]> {
        let mut p = vec![[0.0; D]; self.laws.len()];
        for (k, (form, places)) in forms.iter().zip(&self.places).enumerate() {
            let Some(c) = places.contact else { continue };
            let total = problem.solution(k);
            let shifted = total.impulse - self.constant[k];
            let frame = frame::<S, D>(&form.normal);
            let mut all: [f64; D] = std::array::from_fn(|d| frame[d].dot(&shifted));
            if let Some(b) = places.bond {
                let unilateral = form.normal * (total.unilateral_n + form.tension)
                    + S::tangent_vector(&form.normal, &total.unilateral_t);
                let own: [f64; D] = std::array::from_fn(|d| frame[d].dot(&unilateral));
                for d in 0..D {
                    if self.w.unknowns[b as usize].axes[d].pushes() {
                        p[b as usize][d] = all[d] - own[d];
                        all[d] = own[d];
                    }
                }
            }
            if self.open[k] {
                all[0] = 0.0;
            }
            p[c as usize] = all;
        }
        for c in 0..p.len() {
            p[c] = self.laws[c].project(&p[c], &p);
        }
        p
    }

    /// Returns the total impulses of the contacts in world axes, and the total moments.
    fn totals(
        &self,
        p: &[[f64; D]],
        forms: &[ContactForm<S>],
        moments: &[MomentForm<S>],
    ) -> ImpulsesAndMoments<S> {
        let sum = |places: &Places| -> [f64; D] {
            let mut sum = [0.0; D];
            for c in [places.contact, places.bond].into_iter().flatten() {
                let unknown = &self.w.unknowns[c as usize];
                for k in 0..D {
                    if unknown.axes[k].pushes() {
                        sum[k] += p[c as usize][k];
                    }
                }
            }
            sum
        };
        let impulses = forms.iter().zip(&self.places).enumerate();
        let impulses = impulses
            .map(|(k, (form, places))| {
                places.contact?;
                let p = sum(places);
                let frame = frame::<S, D>(&form.normal);
                let mut total = self.constant[k];
                for d in 0..D {
                    total += frame[d] * p[d];
                }
                Some(total)
            })
            .collect();
        let turned = moments.iter().zip(&self.moments).enumerate();
        let turned = turned
            .map(|(k, (form, places))| {
                places.contact.or(places.bond)?;
                let p = sum(places);
                let mut components = [0.0; 3];
                components[..D].copy_from_slice(&p);
                let n = &forms[form.contact as usize].normal;
                Some(self.constant_moments[k] + S::spin_from(n, components))
            })
            .collect();
        (impulses, turned)
    }

    /// Returns W and the free velocities.
    #[cfg(test)]
    pub(super) fn operator(&self) -> (&dyn Delassus<D>, &[[f64; D]]) {
        (&self.w, &self.q)
    }

    /// Returns W, q and mu if every block is a Coulomb contact.
    pub fn coulomb(&self) -> Option<(Csr, Vec<f64>, Vec<f64>)> {
        let mu: Option<Vec<f64>> = self
            .laws
            .iter()
            .map(|law| match law {
                Law::Coulomb(mu) => Some(*mu),
                _ => None,
            })
            .collect();
        Some((
            self.w.assembled().to_csr(),
            self.q.as_flattened().to_vec(),
            mu?,
        ))
    }
}

/// Returns whether a contact carries nothing along its normal: it has a gap and may close freely,
/// with its impact in a later step; or it is rigid, and both bodies are held along the normal.
fn open<S: Space>(problem: &Problem<S>, form: &ContactForm<S>, row: Option<&SystemRow<S>>) -> bool {
    let n = &form.normal;
    let free = |body: &u32| {
        let mass = &problem.masses[*body as usize].mass;
        (0..S::D).all(|k| mass[k] > 0.0)
    };
    let held = || {
        if row.is_none() && form.bodies.iter().any(free) {
            return false;
        }
        let sides = form.bodies.iter().zip(&form.arms);
        let of_bodies = || {
            sides.fold(S::Matrix::uniform(0.0), |sum, (body, arm)| {
                let Mobility { mass, inertia } = &problem.masses[*body as usize];
                sum + S::Matrix::diagonal(mass) + S::rotation_block(arm, inertia)
            })
        };
        let w = row.map_or_else(of_bodies, |row| *row.block());
        let largest = (0..S::D).map(|k| w.entry(k, k)).fold(0.0, f64::max);
        n.dot(&w.apply(n)) <= HELD * largest
    };
    form.shift_n == f64::INFINITY || form.compliance[0] == 0.0 && held()
}

fn offset<S: Space, const D: usize>(q: &mut [f64; D], unknown: &Unknown<'_, S, D>, a: &[f64; D]) {
    for k in 0..D {
        let axis = &unknown.axes[k];
        if axis.pushes() {
            q[k] += a[k] * axis.compliance;
        } else {
            q[k] = 0.0;
        }
    }
}

/// Improves the impulses of a problem by a method, from the impulses stored in the problem. Returns
/// the iterations.
pub fn improve<S: Space, const D: usize>(
    problem: &mut Problem<S>,
    forms: &[ContactForm<S>],
    moments: &[MomentForm<S>],
    method: Method,
    (norm, tolerance, iterations): (Norm, f64, u32),
) -> u32 {
    let (impulses, turned, done) = {
        let standard = Standard::<S, D>::new(problem, forms, moments);
        let form = Form::new(&standard.w, &standard.q, &standard.laws, norm);
        let mut state = Iteration::new(&form, standard.start(problem, forms));
        let mut budget = Budget::new(tolerance, iterations, f64::INFINITY);
        method.solver().solve(&form, &mut state, &mut budget);
        let (impulses, turned) = standard.totals(&state.p, forms, moments);
        (impulses, turned, state.iterations)
    };
    problem.adopt(&impulses, &turned);
    done
}
