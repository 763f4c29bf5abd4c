//! Choice among several solutions: contacts that held continue to hold, where a solution allows it.
//!
//! Where contacts are hyperstatic, Coulomb's law may have several solutions for one step. A block
//! pinched at both ends by its friction may hang, or turn about one end that carries all of the
//! load while the other slides. A sweep finds the one that follows from the order of the contacts:
//! the first contact takes the load before the others are solved. Where contacts begin to slide,
//! the contacts connected with them through movable bodies ([`super::connected`]) are solved a
//! second time, as a separate problem, from the impulses at the start of the step, by a gradient
//! method, which changes the impulses of all contacts at once. It minimises the energy
//!
//! E = p.W p/2 + p.(q + s),   the kinetic energy of the step, seen from the imposed motions,
//!
//! over impulses in the cones, without the dilation due to sliding. Of all impulses in the cones,
//! those of a solution in which all contacts stick, if there is one, have the least energy. Of the
//! two solutions the one with less energy is used; there may be others, which neither method finds.
//!
//! Sets of up to [`MAX_SMALL_SET`] contacts are solved again in each such step; sets of up to
//! [`MAX_SEARCHED_SET`] only in some steps, after steps without a result ([`super::search`]); sets
//! of [`LARGE_SETS`] contacts where controlled bodies squeeze a body that begins to slide, or that
//! slides and touched nothing before. Larger sets are not solved again, nor are sets with bonds,
//! compliances or dynamical systems. Where a loaded contact begins to slide in a set of rigid
//! contacts that is not solved again, it is reported ([`Problem::is_not_searched`]).

use super::connected::ConnectedSets;
use super::context::{AutoState, SolveContext};
use super::form::{ContactForm, ContactSolution};

use super::local::solver::Method;
use super::nlgs::{self, Report, SolverOptions};
use super::problem::Problem;
use super::row::MomentForm;
use super::search::SecondSearch;
use crate::geometry::space::{Space, VectorLike};
use crate::lanes::LaneVector;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

/// Number of contacts of a set up to which a second solution is searched in each step in which a
/// contact begins to slide. A second solve has a cost, and in a large flowing set some contacts
/// begin to slide in every step.
pub(super) const MAX_SMALL_SET: usize = 64;
/// Number of contacts of a set up to which a second solution is searched in some of these steps.
pub(super) const MAX_SEARCHED_SET: usize = 256;
/// Numbers of contacts of a set, 257 to 16,384, with which a second solution is searched only where
/// controlled bodies release a body that they might hold.
const LARGE_SETS: RangeInclusive<usize> = MAX_SEARCHED_SET + 1..=16_384;
/// Smallest number of iterations of the gradient method, and of sweeps from its result.
const ITERATIONS: u32 = 300;
/// Number of these iterations per contact of the set.
const OF_CONTACT: u32 = 10;
/// Ratio of the tolerance of a set to that of the step, so that all sets together are within the
/// tolerance.
const FINER: f64 = 0.5;
/// Relative velocity of a sliding contact over the largest in its set without contact impulses;
/// lower velocities are errors of a solution.
const SLIDES: f64 = 1e-3;
/// Share of the friction bound from which a contact counts as being at the bound.
const AT_BOUND: f64 = 1.0 - 1e-6;
/// Share of the friction bound up to which a contact counts as holding at the start of the step.
const HELD: f64 = 1.0 - 1e-3;
/// Ratio of the number of impulses of contacts to the number of degrees of freedom of their bodies,
/// from which the impulses count as undetermined: friction may be undetermined although some
/// degrees of freedom are not held by any contact.
const DETERMINED: f64 = 0.75;
/// Share of the largest normal impulse of a set from which a contact counts as loaded.
const LOADED: f64 = 1e-3;
/// Difference of the energies of two solutions, relative to the work of the step, from which the
/// lower one is used; errors of the solutions are smaller.
const LOWER: f64 = 1e-6;
/// Difference of these energies from which two solutions, of which one holds a contact that slides
/// in the other, are reported as several.
const DIFFERS: f64 = 1e-3;
/// Lower bound where a loaded contact slides in one solution and holds in the other: one slipping
/// grain of many has little energy.
const LOWER_HOLDS: f64 = 1e-9;
/// Marks a contact that is not in a list.
const NONE: u32 = u32::MAX;

/// Status of a contact in a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ContactStatus {
    /// The contact carries no load and does not slide, or separates.
    Nothing,
    /// The contact carries a load without sliding.
    Sticks,
    /// The contact slides, and slid at the start of the step.
    KeepsSliding,
    /// The contact slides, and was open at the start of the step.
    SlidesNew,
    /// The contact slides, and stuck at the start of the step.
    StartsSliding,
}

impl ContactStatus {
    fn slides(self) -> bool {
        matches!(
            self,
            Self::KeepsSliding | Self::SlidesNew | Self::StartsSliding
        )
    }
}

/// A set of contacts, by their indices as pushed, in which some slide.
struct SlidingSet {
    /// First body of the set, which identifies it.
    name: u32,
    contacts: Vec<u32>,
}

/// Result of a second solve.
struct SecondSolve<S: Space> {
    /// Whether the second solve converged.
    answered: bool,
    /// The other solution, if it has less energy.
    other: Option<OtherSolution<S>>,
}

/// Another solution of a set.
struct OtherSolution<S: Space> {
    report: Report,
    impulses: Vec<(u32, S::Vector)>,
    moments: Vec<(u32, S::Spin)>,
    several: bool,
}

fn bound<S: Space>(form: &ContactForm<S>, n: f64) -> f64 {
    form.friction * (n + form.tension) + form.cohesion
}

/// Returns whether a contact is rigid and has no bond.
fn simple<S: Space>(form: &ContactForm<S>) -> bool {
    form.elastic.is_none() && form.compliance == [0.0; 2]
}

/// Returns the relative velocity of a contact (m/s), by the motion of bodies.
fn relative<S: Space>(
    form: &ContactForm<S>,
    motion: impl Fn(usize) -> (S::Vector, S::Spin),
) -> S::Vector {
    let of_side = |side: usize| {
        let (v, w) = motion(form.bodies[side] as usize);
        v + S::spin_velocity(&w, &form.arms[side])
    };
    of_side(0) - of_side(1)
}

/// Returns the opening velocity and the slip velocity of a contact (m/s).
fn parts<S: Space>(problem: &Problem<S>, form: &ContactForm<S>) -> [f64; 2] {
    let u = relative(form, |b| problem.velocity(b));
    let slip = S::tangential(&form.normal, &u) + form.shift_t;
    [form.normal.dot(&u) + form.shift_n, slip.norm()]
}

/// Returns whether friction is at its bound. A contact without load counts too, since the other
/// contacts may have received all of it.
fn at_bound<S: Space>(problem: &Problem<S>, k: u32, form: &ContactForm<S>) -> bool {
    let p = problem.local_impulse(problem.places[k as usize]);
    form.friction > 0.0 && p.t.norm() >= AT_BOUND * bound(form, p.n)
}

/// Returns the state of a contact, where relative velocities below `least` are errors.
fn status<S: Space>(
    problem: &Problem<S>,
    k: u32,
    form: &ContactForm<S>,
    least: f64,
) -> ContactStatus {
    let [opens, slip] = parts(problem, form);
    let loaded = problem.normal(problem.places[k as usize]) > 0.0;
    if opens > least || form.friction == 0.0 {
        return ContactStatus::Nothing;
    }
    if slip <= least || !at_bound(problem, k, form) {
        return if loaded {
            ContactStatus::Sticks
        } else {
            ContactStatus::Nothing
        };
    }
    if form.normal.dot(&form.impulse) <= 0.0 {
        ContactStatus::SlidesNew
    } else if held_by(form, &form.impulse, HELD) {
        ContactStatus::StartsSliding
    } else {
        ContactStatus::KeepsSliding
    }
}

/// Returns the largest relative velocity of contacts without impulses (m/s), times the ratio from
/// which a contact slides.
fn least_slip<'a, S: Space>(
    problem: &Problem<S>,
    forms: impl Iterator<Item = &'a ContactForm<S>>,
) -> f64 {
    let free = forms.map(|form| {
        let u = relative(form, |b| problem.free[b]);
        u.dot(&u)
    });
    SLIDES * free.fold(0.0, f64::max).sqrt()
}

fn is_undetermined(unknowns: usize, freedoms: usize) -> bool {
    unknowns as f64 >= DETERMINED * freedoms as f64
}

/// Returns whether the impulses of contacts, D for each with friction and one for each without, may
/// outnumber the degrees of freedom of their bodies.
fn outnumber<'a, S: Space>(
    problem: &Problem<S>,
    forms: impl Iterator<Item = &'a ContactForm<S>>,
) -> bool {
    let mut touched = BTreeMap::new();
    let mut unknowns = 0;
    for form in forms {
        unknowns += if form.friction > 0.0 { S::D } else { 1 };
        for body in form.bodies {
            let mobility = &problem.masses[body as usize];
            (touched.entry(body)).or_insert_with(|| mobility.freedoms(true));
        }
    }
    is_undetermined(unknowns, touched.values().sum())
}

/// Whether a contact at its friction bound begins to slide: it carries a load, carried one before
/// by its impulse, and held.
pub fn begins_to_slide<S: Space>(
    form: &ContactForm<S>,
    before: &S::Vector,
    solution: &ContactSolution<S>,
) -> bool {
    let held = || held_by(form, before, AT_BOUND);
    form.friction > 0.0 && simple(form) && solution.unilateral_n > 0.0 && held()
}

/// Returns whether a contact carried a load by this impulse, with less than the holding share of
/// the friction bound.
fn held_by<S: Space>(form: &ContactForm<S>, impulse: &S::Vector, share: f64) -> bool {
    let n = form.normal.dot(impulse);
    n > 0.0 && S::tangential(&form.normal, impulse).norm() < share * bound(form, n)
}

impl<S: Space> Problem<S> {
    /// Returns whether one of these contacts, at their friction bound since this step, slides in a
    /// set that was not searched in this step because it is too large, and in which impulses
    /// outnumber degrees of freedom; and whether one of them belongs to a body squeezed by
    /// controlled bodies. Sets with springs or bonds do not count, since these determine the
    /// impulses.
    pub fn is_not_searched(
        &mut self,
        forms: &[ContactForm<S>],
        begin: &[usize],
        search: &SecondSearch,
    ) -> [bool; 2] {
        let sets = self.take_connected();
        let freedoms = self.freedoms(&sets);
        let mut large: Vec<bool> = (0..sets.len())
            .map(|set| {
                let count = sets.contacts(set);
                !sets.with_systems(set)
                    && count > MAX_SMALL_SET
                    && is_undetermined(S::D * count, freedoms[set])
                    && !search.was_searched(sets.first(set))
            })
            .collect();
        for form in forms.iter().filter(|form| !simple(form)) {
            if let Some(set) = sets.of(form.bodies) {
                large[set] = false;
            }
        }
        let is_of_large = |k: &usize| sets.of(forms[*k].bodies).is_some_and(|set| large[set]);
        let of_large: Vec<usize> = begin.iter().copied().filter(is_of_large).collect();
        let several = &sets.of_several_controlled;
        let pinched = self.of_pinched(forms, several, of_large.iter().copied());
        self.connected = sets;
        // Each contact is compared with its own free velocity, since others may move fast.
        [of_large, pinched].map(|contacts| {
            let least = least_slip(self, contacts.iter().map(|k| &forms[*k]));
            let slides = |k: &usize| parts(self, &forms[*k])[1] > least;
            contacts.iter().any(slides)
        })
    }
}

impl<S: Space> SolveContext<'_, S> {
    /// Replaces the solution of the sweeps in each connected set for which a solution with less
    /// energy is found.
    pub(super) fn prefer_sticking(
        &self,
        problem: &mut Problem<S>,
        report: &mut Report,
        auto_state: &mut AutoState,
    ) {
        if !report.converged || self.forms.len() < 2 {
            return;
        }
        let mut found = Vec::new();
        for set in self.sets_to_search(problem) {
            let due = auto_state.search.is_due(set.name);
            let form = |k: &u32| &self.forms[*k as usize];
            let all = || set.contacts.iter().map(form);
            let many = || outnumber(problem, all().filter(|f| f.shift_n.is_finite()));
            let may_slide = |k: &u32| self.may_slide(problem, *k);
            if all().all(simple)
                && set.contacts.iter().any(may_slide)
                && self.is_sought(problem, &set.contacts, due)
                && many()
            {
                let SecondSolve { answered, other } = self.lower(problem, &set.contacts);
                if answered {
                    auto_state.search.answered(set.name);
                }
                auto_state.search.learn(set.name, other.is_some());
                found.extend(other);
            }
        }
        if !found.is_empty() {
            self.take(problem, report, &found);
        }
    }

    /// Returns whether a contact may slide: decided by its impulse first, which costs little, then
    /// by its velocities.
    fn may_slide(&self, problem: &Problem<S>, k: u32) -> bool {
        let form = &self.forms[k as usize];
        if !form.shift_n.is_finite() || !at_bound(problem, k, form) {
            return false;
        }
        let [opens, slip] = parts(problem, form);
        // No bound on the velocities of the set is needed to see that this contact opens, or does
        // not move.
        slip > 0.0 && opens <= slip
    }

    /// Returns the sets that are small enough to search, and in which impulses may outnumber
    /// degrees of freedom.
    fn sets_to_search(&self, problem: &mut Problem<S>) -> Vec<SlidingSet> {
        let sets = problem.take_connected();
        let freedoms = problem.freedoms(&sets);
        let large = self.letting_go(problem, &sets);
        let is_small = |set: &usize| {
            let count = sets.contacts(*set);
            !sets.with_systems(*set)
                && ((2..=MAX_SEARCHED_SET).contains(&count) || large.contains(set))
                && is_undetermined(S::D * count, freedoms[*set])
        };
        let mut place = vec![NONE; sets.len()];
        let mut small = Vec::new();
        for set in (0..sets.len()).filter(is_small) {
            place[set] = small.len() as u32;
            small.push(SlidingSet {
                name: sets.first(set),
                contacts: Vec::with_capacity(sets.contacts(set)),
            });
        }
        if !small.is_empty() {
            for (form, k) in self.forms.iter().zip(0..) {
                let set = sets.of(form.bodies).map(|set| place[set]);
                if let Some(set) = set.filter(|set| *set != NONE) {
                    small[set as usize].contacts.push(k);
                }
            }
        }
        problem.connected = sets;
        small
    }

    /// Returns the sets of [`LARGE_SETS`] contacts in which a body squeezed by controlled bodies
    /// begins to slide, or slides and was not squeezed before.
    fn letting_go(&self, problem: &Problem<S>, sets: &ConnectedSets) -> BTreeSet<usize> {
        let is_large = |set: usize| LARGE_SETS.contains(&sets.contacts(set));
        let several = &sets.of_several_controlled;
        let begins = |k: &usize| {
            let form = &self.forms[*k];
            let new = || form.normal.dot(&form.impulse) <= 0.0;
            sets.of(form.bodies).is_some_and(is_large)
                && self.may_slide(problem, *k as u32)
                && (new() || held_by(form, &form.impulse, AT_BOUND))
        };
        let begin = several.iter().copied().filter(begins);
        let pinched = problem.of_pinched(self.forms, several, begin).into_iter();
        pinched
            .filter_map(|k| sets.of(self.forms[k].bodies))
            .collect()
    }

    /// Returns whether to search another solution of a set: where a contact begins to slide, and in
    /// steps that are `due` where some contacts slide while others hold or are new. Where all
    /// loaded contacts continue to slide, no other solution is to be expected.
    fn is_sought(&self, problem: &Problem<S>, of: &[u32], due: bool) -> bool {
        let form = |k: &u32| &self.forms[*k as usize];
        let least = least_slip(problem, of.iter().map(form));
        let all: Vec<_> = of
            .iter()
            .map(|k| status(problem, *k, form(k), least))
            .collect();
        let some = |what: ContactStatus| all.contains(&what);
        let begins = some(ContactStatus::StartsSliding) && (due || of.len() <= MAX_SMALL_SET);
        begins
            || due
                && (some(ContactStatus::SlidesNew)
                    || some(ContactStatus::KeepsSliding) && some(ContactStatus::Sticks))
    }

    /// Searches another solution of a set, with less energy than the present one.
    fn lower(&self, problem: &Problem<S>, of: &[u32]) -> SecondSolve<S> {
        let mut alone = Problem::default();
        let mut bodies = BTreeMap::new();
        let mut body = |b: u32| {
            *bodies.entry(b).or_insert_with(|| {
                let (b, next) = (b as usize, alone.free.len() as u32);
                let ((v, w), m) = (problem.free[b], problem.masses[b]);
                alone.push_body(v, w, m.mass, m.inertia, problem.lengths[b]);
                next
            })
        };
        let forms = of.iter().map(|k| {
            let mut form = self.forms[*k as usize].clone();
            form.bodies = form.bodies.map(&mut body);
            form
        });
        let forms: Vec<_> = forms.collect();
        alone.push_all(&forms, false);
        let of_set = |m: &MomentForm<S>| of.binary_search(&m.contact).ok();
        let (mut moments, mut turned) = (Vec::new(), Vec::new());
        for (form, k) in self.moments.iter().zip(0u32..) {
            if let Some(contact) = of_set(form) {
                let contact = contact as u32;
                moments.push(MomentForm { contact, ..*form });
                turned.push(k);
            }
        }
        for form in &moments {
            alone.push_moment(form, &forms[form.contact as usize]);
        }
        let options = SolverOptions {
            tolerance: FINER * self.options.tolerance,
            parallel: false,
            ..*self.options
        };
        let context = SolveContext {
            forms: &forms,
            moments: &moments,
            options: &options,
            start: None,
        };
        let now = of
            .iter()
            .map(|k| Some(problem.solution(*k as usize).impulse));
        let now: Vec<_> = now.collect();
        let now_turned = turned
            .iter()
            .map(|k| Some(problem.moments[*k as usize].moment()));
        let now_turned: Vec<_> = now_turned.collect();
        alone.adopt(&now, &now_turned);
        let (answered, lower) = context.find_lower(&mut alone);
        let Some((report, differs)) = lower else {
            return SecondSolve {
                answered,
                other: None,
            };
        };
        let impulses = of.iter().enumerate();
        let impulses = impulses.map(|(k, of)| (*of, alone.solution(k).impulse));
        let moments = turned.iter().zip(&alone.moments);
        SecondSolve {
            answered,
            other: Some(OtherSolution {
                report,
                impulses: impulses.collect(),
                moments: moments.map(|(k, row)| (*k, row.moment())).collect(),
                several: differs,
            }),
        }
    }

    /// Solves a set again from the start of the step. Returns whether it converged; and, if the
    /// solution has less energy, whether a contact slides in one of the two solutions and holds a
    /// load in the other.
    fn find_lower(&self, alone: &mut Problem<S>) -> (bool, Option<(Report, bool)>) {
        let before = self.energy(alone)[0];
        let least = least_slip(alone, self.forms.iter());
        let did = self.statuses(alone, least);
        self.start_anew(alone);
        let tolerance = 0.3 * self.options.tolerance;
        let of_contacts = OF_CONTACT * self.forms.len().min(MAX_SEARCHED_SET) as u32;
        let most = ITERATIONS.max(of_contacts);
        let mut other = self.improve(alone, Method::Pcpg, tolerance, most);
        let is_lower = |problem: &Problem<S>, by: f64| {
            let [energy, work] = self.energy(problem);
            before - energy > by * work.abs()
        };
        if !other.converged && is_lower(alone, LOWER) {
            other.add(&self.sweep_accelerated(alone, most));
        }
        let does = self.statuses(alone, least);
        let differs = |(a, b): (&ContactStatus, &ContactStatus)| {
            a.slides() && *b == ContactStatus::Sticks || b.slides() && *a == ContactStatus::Sticks
        };
        let one_differs = did.iter().zip(&does).any(differs);
        let by = if one_differs { LOWER_HOLDS } else { LOWER };
        if !(other.converged && is_lower(alone, by)) {
            return (other.converged, None);
        }
        (true, Some((other, one_differs && is_lower(alone, DIFFERS))))
    }

    /// Returns the states of the contacts of a problem; contacts without a load do not hold.
    fn statuses(&self, problem: &Problem<S>, least: f64) -> Vec<ContactStatus> {
        let normal = |k: u32| problem.normal(problem.places[k as usize]);
        let count = self.forms.len() as u32;
        let largest = (0..count).map(normal).fold(0.0, f64::max);
        let of = |k: u32| {
            let form = &self.forms[k as usize];
            let what = status(problem, k, form, least);
            // Sliding contacts may have lost their load to the others.
            if what == ContactStatus::Sticks && normal(k) <= LOADED * largest {
                ContactStatus::Nothing
            } else {
                what
            }
        };
        (0..count).map(of).collect()
    }

    /// Uses the solutions of sets, unless all contacts together do not converge with them.
    fn take(&self, problem: &mut Problem<S>, report: &mut Report, found: &[OtherSolution<S>]) {
        let mut saved = Vec::new();
        problem.store(&mut saved);
        let list = |of: &OtherSolution<S>| of.impulses.clone();
        let impulses: Vec<_> = found.iter().flat_map(list).collect();
        let moments: Vec<_> = found.iter().flat_map(|of| of.moments.clone()).collect();
        problem.adopt_some(&impulses, &moments);
        let mut whole = nlgs::check_convergence(problem, self.options);
        if !whole.converged {
            whole.add(&self.sweep_accelerated(problem, ITERATIONS));
        }
        if !whole.converged {
            problem.restore(&saved);
            return;
        }
        whole.iterations += found.iter().map(|of| of.report.iterations).sum::<u32>();
        whole.several = found.iter().any(|of| of.several);
        let used = report.used;
        report.add(&whole);
        report.used = used;
    }

    /// Returns the energy E of the module, and the work p.W p/2 in it (J).
    fn energy(&self, problem: &Problem<S>) -> [f64; 2] {
        let (mut energy, mut work) = (0.0, 0.0);
        for (k, form) in self.forms.iter().enumerate() {
            let solution = problem.solution(k);
            let p = solution.impulse;
            if p == S::Vector::zero() {
                continue;
            }
            let u = relative(form, |b| problem.velocity(b));
            let free = relative(form, |b| problem.free[b]);
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
}
