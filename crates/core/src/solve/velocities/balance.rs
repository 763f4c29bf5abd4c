//! The balance of momentum of a step, F(v) = M (v - v_free) - sum_c H_c p_c, and its motions.

use super::Start;
use super::law::{self, Slope};
use super::matrix::{Pattern, Values};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::{ContactForm, Mobility};
use crate::solve::problem::Problem;
use crate::solve::row::MomentForm;
use crate::solve::standard::{ImpulsesAndMoments, Neighbours, degrees_of_freedom, mass};

/// Velocity and spin of a body, or impulse and moment on it.
pub(super) type Motion<S> = (<S as Space>::Vector, <S as Space>::Spin);

/// Returns the unit motion of a degree of freedom.
pub(super) fn unit<S: Space>(component: usize) -> Motion<S> {
    let (mut v, mut w) = (S::Vector::zero(), S::Spin::zero());
    if component < S::D {
        v[component] = 1.0;
    } else {
        w[component - S::D] = 1.0;
    }
    (v, w)
}

/// Returns the change of a bond's moment, but for its sign, with a relative spin.
pub(super) fn bending<S: Space>(n: &S::Vector, form: &MomentForm<S>, spin: &S::Spin) -> S::Spin {
    let (twist, bend) = S::split_spin(n, spin);
    S::spin_about(n, twist * form.b_twist) + bend * form.b_bend
}

/// A step as a balance of momentum.
pub(super) struct Balance<'a, S: Space> {
    pub forms: &'a [ContactForm<S>],
    pub moments: &'a [MomentForm<S>],
    masses: Vec<Mobility<S>>,
    free: Vec<Motion<S>>,
    pub pattern: Pattern,
}

/// Impulses and residual at some velocities.
#[derive(Clone)]
pub(super) struct Evaluated<S: Space> {
    /// Velocities and spins of the bodies.
    pub motions: Vec<Motion<S>>,
    /// Impulses of the contacts (N s) and their slopes.
    pub impulses: Vec<S::Vector>,
    pub slopes: Vec<Slope<S>>,
    /// F by degrees of freedom of the bodies that move (N s, N m s).
    pub residual: Vec<f64>,
    /// Its norm, sqrt(F^T M^-1 F).
    pub size: f64,
}

impl<'a, S: Space> Balance<'a, S> {
    pub fn new(
        problem: &mut Problem<S>,
        forms: &'a [ContactForm<S>],
        moments: &'a [MomentForm<S>],
    ) -> Self {
        let pairs = forms.iter().map(|f| f.bodies);
        let neighbours = Neighbours::new(&problem.masses, pairs);
        let pattern = std::mem::take(&mut problem.velocity_pattern);
        Self {
            forms,
            moments,
            masses: problem.masses.clone(),
            free: problem.free.clone(),
            pattern: pattern.for_neighbours::<S>(neighbours),
        }
    }

    /// Number of bodies.
    pub fn bodies(&self) -> u32 {
        self.masses.len() as u32
    }

    /// The mass matrix of a body, with ones for imposed degrees of freedom.
    pub fn mass(&self, body: u32) -> [[f64; 6]; 6] {
        mass(&self.masses[body as usize])
    }

    /// Whether impulses change the velocity of a body in a degree of freedom.
    pub fn is_free(&self, body: u32, component: usize) -> bool {
        self.pattern.moves(body) && self.masses[body as usize].along(component) > 0.0
    }

    /// Returns the velocities to start from, without any those by the impulses of the problem;
    /// those of imposed degrees of freedom are given.
    pub fn start(&self, problem: &Problem<S>, start: Option<&Start<S>>) -> Vec<Motion<S>> {
        let of = |b: usize| match start {
            Some(start) => (start.velocity[b], start.spin[b]),
            None => problem.velocity(b),
        };
        let mut motions = problem.free.clone();
        for (b, motion) in motions.iter_mut().enumerate() {
            let (velocity, spin) = of(b);
            for k in (0..degrees_of_freedom::<S>()).filter(|k| self.is_free(b as u32, *k)) {
                if k < S::D {
                    motion.0[k] = velocity[k];
                } else {
                    motion.1[k - S::D] = spin[k - S::D];
                }
            }
        }
        motions
    }

    /// Returns the velocity of a contact's candidate relative to its antagonist.
    pub fn relative(&self, form: &ContactForm<S>, motions: &[Motion<S>]) -> S::Vector {
        let of = |side: usize| {
            let (v, w) = &motions[form.bodies[side] as usize];
            *v + S::spin_velocity(w, &form.arms[side])
        };
        of(0) - of(1)
    }

    /// Returns the relative spin of a contact's bodies.
    fn relative_spin(&self, form: &ContactForm<S>, motions: &[Motion<S>]) -> S::Spin {
        let [a, b] = form.bodies.map(|b| motions[b as usize].1);
        a - b
    }

    /// Returns the moment of a bond at some velocities.
    fn moment(&self, form: &MomentForm<S>, motions: &[Motion<S>]) -> S::Spin {
        let contact = &self.forms[form.contact as usize];
        let spin = self.relative_spin(contact, motions);
        -(form.a + bending(&contact.normal, form, &spin))
    }

    /// Returns M (v - v_free) of the bodies that move.
    fn momentum(&self, motions: &[Motion<S>]) -> Vec<Motion<S>> {
        let bodies = self.masses.iter().zip(motions).zip(&self.free);
        let of = |((mobility, motion), free): ((&Mobility<S>, &Motion<S>), &Motion<S>)| {
            let (mut p, mut moment) = (motion.0 - free.0, S::Spin::zero());
            for k in 0..S::D {
                p[k] = if mobility.mass[k] > 0.0 {
                    p[k] / mobility.mass[k]
                } else {
                    0.0
                };
            }
            if mobility.turns()
                && let Some(inertia) = mobility.inertia.inverse()
            {
                moment = inertia.apply(&(motion.1 - free.1));
            }
            (p, moment)
        };
        bodies.map(of).collect()
    }

    /// Subtracts the impulses of contacts and the moments of bonds from momenta.
    fn subtract_impulses(
        &self,
        out: &mut [Motion<S>],
        impulses: &[S::Vector],
        motions: &[Motion<S>],
    ) {
        for (form, p) in self.forms.iter().zip(impulses) {
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let on = &mut out[form.bodies[side] as usize];
                on.0 -= *p * sign;
                on.1 -= S::moment(&form.arms[side], p) * sign;
            }
        }
        for form in self.moments {
            let bodies = self.forms[form.contact as usize].bodies;
            let moment = self.moment(form, motions);
            out[bodies[0] as usize].1 -= moment;
            out[bodies[1] as usize].1 += moment;
        }
    }

    /// Returns F by degrees of freedom, for given impulses.
    pub fn residual(&self, motions: &[Motion<S>], impulses: &[S::Vector]) -> Vec<f64> {
        let mut momenta = self.momentum(motions);
        self.subtract_impulses(&mut momenta, impulses, motions);
        let mut out = vec![0.0; self.pattern.len()];
        for (b, (p, moment)) in (0..).zip(&momenta) {
            for k in (0..degrees_of_freedom::<S>()).filter(|k| self.is_free(b, *k)) {
                let value = if k < S::D { p[k] } else { moment[k - S::D] };
                out[self.pattern.start(b) + k] = value;
            }
        }
        out
    }

    /// Evaluates the contacts and F at some velocities.
    pub fn evaluate(&self, motions: Vec<Motion<S>>) -> Evaluated<S> {
        let at = |form| law::impulse(form, &self.relative(form, &motions));
        let (impulses, slopes): (Vec<_>, Vec<_>) = self.forms.iter().map(at).unzip();
        let residual = self.residual(&motions, &impulses);
        let size = self.size(&residual);
        Evaluated {
            motions,
            impulses,
            slopes,
            residual,
            size,
        }
    }

    /// Returns the norm of F, sqrt(F^T M^-1 F).
    fn size(&self, residual: &[f64]) -> f64 {
        let mut sum = 0.0;
        for body in (0..self.bodies()).filter(|b| self.pattern.moves(*b)) {
            let first = self.pattern.start(body);
            let own = &residual[first..first + degrees_of_freedom::<S>()];
            let (p, moment) = (
                S::Vector::from_slice(own),
                S::Spin::from_slice(&own[S::D..]),
            );
            let (v, w) = self.masses[body as usize].apply(&p, &moment);
            sum += p.dot(&v) + moment.dot(&w);
        }
        sum.sqrt()
    }

    /// Returns motions after a change by degrees of freedom, times a factor.
    pub fn moved(&self, motions: &[Motion<S>], change: &[f64], factor: f64) -> Vec<Motion<S>> {
        let mut out = motions.to_vec();
        for (motion, change) in out.iter_mut().zip(self.as_motions(change)) {
            motion.0 += change.0 * factor;
            motion.1 += change.1 * factor;
        }
        out
    }

    /// Returns values by degrees of freedom as motions of all bodies.
    pub fn as_motions(&self, values: &[f64]) -> Vec<Motion<S>> {
        let of = |body: u32| {
            let (mut v, mut w) = (S::Vector::zero(), S::Spin::zero());
            for k in (0..degrees_of_freedom::<S>()).filter(|k| self.is_free(body, *k)) {
                let value = values[self.pattern.start(body) + k];
                if k < S::D {
                    v[k] = value;
                } else {
                    w[k - S::D] = value;
                }
            }
            (v, w)
        };
        (0..self.bodies()).map(of).collect()
    }

    /// Returns the weights by which impulses and moments become comparable: 1/sqrt(M), as in
    /// [`Self::size`]; 1 for an imposed degree of freedom.
    fn weights(&self) -> Vec<f64> {
        let mut out = vec![1.0; self.pattern.len()];
        for body in (0..self.bodies()).filter(|b| self.pattern.moves(*b)) {
            for k in (0..degrees_of_freedom::<S>()).filter(|k| self.is_free(body, *k)) {
                out[self.pattern.start(body) + k] = self.masses[body as usize].along(k).sqrt();
            }
        }
        out
    }

    /// Returns the change of velocities that removes a residual, with slopes of the contacts;
    /// `None` where it is not found.
    pub fn direction(&mut self, residual: &[f64], slopes: &[Slope<S>]) -> Option<Vec<f64>> {
        let values = Values::new(self, slopes);
        let factor = values.factor(&mut self.pattern)?;
        let right: Vec<f64> = residual.iter().map(|x| -x).collect();
        let change = values.solve(&self.pattern, &factor, &right, &self.weights())?;
        change.iter().all(|x| x.is_finite()).then_some(change)
    }

    /// Returns the impulses of the contacts and the moments of the bonds, `None` where no body
    /// moves.
    pub fn impulses(&self, at: &Evaluated<S>) -> ImpulsesAndMoments<S> {
        let moves = |bodies: &[u32; 2]| bodies.iter().any(|b| self.pattern.moves(*b));
        let impulses = self.forms.iter().zip(&at.impulses);
        let impulses = impulses.map(|(form, p)| moves(&form.bodies).then_some(*p));
        let turns = |body: &u32| self.masses[*body as usize].turns();
        let moments = self.moments.iter().map(|form| {
            let bodies = &self.forms[form.contact as usize].bodies;
            let any = bodies.iter().any(turns);
            any.then(|| self.moment(form, &at.motions))
        });
        (impulses.collect(), moments.collect())
    }
}
