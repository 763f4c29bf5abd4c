//! Which of several solutions: contacts that hold go on to hold, where a solution lets them.
//!
//! Where contacts are hyperstatic, Coulomb's law may have several solutions for one step. A block pinched at both ends by its friction may
//! hang, or turn about one end that carries all of the load while the other slides. A sweep finds the one that the order of the contacts leads
//! to: the first contact takes the load before the others are asked. Where contacts begin to slide the step is solved a second time from the
//! impulses at its start, by a gradient method, whose impulses follow from all contacts at once. It minimises the energy
//!
//! E = p.W p/2 + p.(q + s),   the kinetic energy of the step, seen from the imposed motions,
//!
//! over impulses in the cones, less what sliding dilates; of all impulses in the cones those of a solution that sticks have the least energy, where
//! there is one. Of both solutions the one of less energy is taken.

use super::choose::{AutoState, SolveContext};
use super::form::{ContactForm, Problem};
use super::local::solver::Method;
use super::nlgs::Report;
use crate::geometry::space::{Space, VectorLike};

/// Contacts above which no second solution is sought: the order of a sweep has less to say in a large set, and a second solve costs more.
const MOST: usize = 64;
/// Largest number of steps that are passed over after those that had no other solution, while no loaded contact that held begins to slide.
const PASSED: u32 = 8;
/// Iterations of the gradient method, and sweeps from its end.
const ITERATIONS: u32 = 300;
/// Relative velocity of a contact that slides, over the largest without contacts; slower ones are the error of a solution.
const SLIDES: f64 = 1e-3;
/// Share of the friction bound from which a contact is at it.
const AT_BOUND: f64 = 1.0 - 1e-6;
/// Share of the friction bound up to which a contact held at the start of the step.
const HELD: f64 = 1.0 - 1e-3;
/// Difference of the energies of two solutions, over the work of the step, from which the lower one is taken, and which their errors do
/// not make.
const LOWER: f64 = 1e-6;
const DIFFERS: f64 = 1e-3;

/// When a second solution is sought.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Search {
    /// Steps that are still passed over, and that were after the last search without a result.
    passed_over: [u32; 2],
}

impl Search {
    fn is_due(&mut self) -> bool {
        let due = self.passed_over[0] == 0;
        self.passed_over[0] = self.passed_over[0].saturating_sub(1);
        due
    }

    fn learn(&mut self, found: bool) {
        let next = (2 * self.passed_over[1]).clamp(1, PASSED);
        self.passed_over = if found { [0; 2] } else { [next; 2] };
    }
}

/// What contacts do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Sliding {
    None,
    Goes,
    Begins,
}

impl<S: Space> SolveContext<'_, S> {
    /// Takes another solution than that of the sweeps, where one of less energy is found.
    pub(super) fn prefer_sticking(
        &self,
        problem: &mut Problem<S>,
        report: &mut Report,
        auto_state: &mut AutoState,
    ) {
        if !report.converged || !self.may_have_several(problem) {
            return;
        }
        let search = &mut auto_state.search;
        let due = search.is_due();
        let searched = match self.sliding(problem) {
            Sliding::None => false,
            Sliding::Goes => due,
            Sliding::Begins => true,
        };
        if searched {
            let found = self.adopt_lower(problem, report);
            search.learn(found);
        }
    }

    /// Whether there are more impulses than motions, of rigid contacts without bonds.
    fn may_have_several(&self, problem: &Problem<S>) -> bool {
        let count = self.forms.len();
        if !(2..=MOST).contains(&count) || !problem.systems.is_empty() {
            return false;
        }
        let simple = |f: &ContactForm<S>| f.elastic.is_none() && f.compliance == [0.0; 2];
        if !self.forms.iter().all(simple) {
            return false;
        }
        let mut touched = vec![false; problem.masses.len()];
        let mut unknowns = 0;
        for form in self.forms.iter().filter(|f| f.shift_n.is_finite()) {
            unknowns += if form.friction > 0.0 { S::D } else { 1 };
            for body in form.bodies {
                touched[body as usize] = true;
            }
        }
        let touched = touched.iter().zip(&problem.masses).filter(|(t, _)| **t);
        let freedoms = touched.map(|(_, m)| {
            let turns = if m.turns() { S::Spin::N } else { 0 };
            (0..S::D).filter(|k| m.mass[*k] > 0.0).count() + turns
        });
        unknowns > freedoms.sum::<usize>()
    }

    /// Relative velocity of a contact (m/s), by the motion of bodies.
    fn relative(
        form: &ContactForm<S>,
        motion: impl Fn(usize) -> (S::Vector, S::Spin),
    ) -> S::Vector {
        let of_side = |side: usize| {
            let (v, w) = motion(form.bodies[side] as usize);
            v + S::spin_velocity(&w, &form.arms[side])
        };
        of_side(0) - of_side(1)
    }

    /// Whether contacts slide, and begin to.
    fn sliding(&self, problem: &Problem<S>) -> Sliding {
        let bound =
            |form: &ContactForm<S>, n: f64| form.friction * (n + form.tension) + form.cohesion;
        let at_bound = |(k, form): &(usize, &ContactForm<S>)| {
            let p = problem.solution(*k);
            let limit = bound(form, p.unilateral_n);
            form.friction > 0.0 && p.unilateral_t.norm() >= AT_BOUND * limit
        };
        let all = self.forms.iter().enumerate();
        let at_bound: Vec<_> = all.filter(at_bound).map(|(_, form)| form).collect();
        if at_bound.is_empty() {
            return Sliding::None;
        }
        let free = |form: &ContactForm<S>| {
            let u = Self::relative(form, |b| problem.free[b]);
            u.dot(&u)
        };
        let fastest = self.forms.iter().map(free).fold(0.0, f64::max);
        let of = |form: &ContactForm<S>| {
            let n = &form.normal;
            let u = Self::relative(form, |b| problem.velocity(b));
            let slip = S::tangential(n, &u) + form.shift_t;
            // One that touches without a load slides, too: the others may have been given all of it.
            let (opens, least) = (n.dot(&u) + form.shift_n, SLIDES * fastest.sqrt());
            if slip.dot(&slip) <= least * least || opens > least {
                return Sliding::None;
            }
            let (before, across) = (n.dot(&form.impulse), S::tangential(n, &form.impulse));
            if before > 0.0 && across.norm() < HELD * bound(form, before) {
                Sliding::Begins
            } else {
                Sliding::Goes
            }
        };
        at_bound.into_iter().map(of).max().unwrap_or(Sliding::None)
    }

    /// The energy E of the module, and the work p.W p/2 in it (J).
    fn energy(&self, problem: &Problem<S>) -> [f64; 2] {
        let (mut energy, mut work) = (0.0, 0.0);
        for (k, form) in self.forms.iter().enumerate() {
            let solution = problem.solution(k);
            let p = solution.impulse;
            if p == S::Vector::zero() {
                continue;
            }
            let u = Self::relative(form, |b| problem.velocity(b));
            let free = Self::relative(form, |b| problem.free[b]);
            let by_shift =
                solution.unilateral_n * form.shift_n + solution.unilateral_t.dot(&form.shift_t);
            energy += 0.5 * p.dot(&(u + free)) + by_shift;
            work += 0.5 * p.dot(&(u - free));
        }
        for moment in problem.moments() {
            let bodies = self.forms[moment.contact as usize].bodies;
            let [i, j] = bodies.map(|b| b as usize);
            let w = problem.velocity(i).1 - problem.velocity(j).1;
            let free = problem.free[i].1 - problem.free[j].1;
            energy += 0.5 * moment.moment.dot(&(w + free));
            work += 0.5 * moment.moment.dot(&(w - free));
        }
        [energy, work]
    }

    /// Solves the step again from its start, and takes that solution if its energy is less.
    fn adopt_lower(&self, problem: &mut Problem<S>, report: &mut Report) -> bool {
        let mut saved = Vec::new();
        problem.store(&mut saved);
        let before = self.energy(problem)[0];
        self.start_anew(problem);
        let tolerance = 0.3 * self.options.tolerance;
        let mut other = self.improve(problem, Method::Pcpg, tolerance, ITERATIONS);
        let is_lower = |problem: &Problem<S>, by: f64| {
            let [energy, work] = self.energy(problem);
            before - energy > by * work.abs()
        };
        if !other.converged && is_lower(problem, LOWER) {
            other.add(&self.sweep(problem, true, ITERATIONS));
        }
        if !(other.converged && is_lower(problem, LOWER)) {
            problem.restore(&saved);
            return false;
        }
        let used = report.used;
        report.add(&other);
        report.used = used;
        report.several = is_lower(problem, DIFFERS);
        true
    }
}
