//! Friction that depends on the sliding velocity, evaluated at the velocity at the end of the step.
//!
//! A law is linearised at a velocity V: |p_t| = (mu + m (|u_t| - V)) P. Where it rises (m > 0) this
//! is Coulomb's law with the coefficient mu - m V in parallel with a damper m P, which is the
//! single-valued part b_t of the standard form, and Newton's iteration follows: a rising law cannot
//! make a step unstable, for any step length. Where friction falls with the velocity the
//! coefficient is that at the last velocity; the iteration then goes to the next state of
//! equilibrium, stick or slip, in the direction in which the step starts.
//!
//! The slope of laws in the logarithm of the velocity is unbounded towards rest; m P is then far
//! above all masses, and a network of such dampers is practically rigid. A solution cannot
//! distinguish velocities below the floor V_0, the tolerance of the solver times the root mean
//! square of the velocities of all contacts, from rest: laws are evaluated at max(|u_t|, V_0).

use super::law_step::law_step;
use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::laws::ContactStep;
use crate::laws::StepInfo;
use crate::laws::{FrictionAt, LawError};
use crate::solve::form::{ContactForm, Elastic};
use crate::step::Simulation;

/// Accepted relative difference of the friction of a contact with a rising law, and share of the
/// friction of all contacts that is added to that of the contact as its reference.
const TOLERANCE: f64 = 1e-4;
const NEXT_TO_NOTHING: f64 = 1e-2;
/// Accepted difference for falling laws as a share of the friction of all contacts; after a number
/// of solves also for rising laws, since among many contacts some always reverse.
const TOLERANCE_OF_ALL: f64 = 1e-3;
/// Number of solves after which falling laws may differ by more: a contact that jumps between stick
/// and slip has no state in between.
const MAX_FALLING_SOLVES: u32 = 8;
/// Share of the velocity of linearisation below which Newton's step uses the logarithm of the
/// velocity: the slope of rising laws decreases with velocity, so that their tangent leads to rest.
const FAR_BELOW: f64 = 0.1;
/// Largest step of the logarithm: among many contacts one that is held now may have to slide in the
/// next solve.
const LONGEST: f64 = 4.0;
/// Largest tolerance that is used for the floor of velocities.
const COARSEST: f64 = 1e-4;
/// Number of iterations after which steps of rising laws are halved in the logarithm.
const CAUTIOUS: u32 = 10;

/// A contact whose friction depends on the velocity.
#[derive(Clone, Debug)]
struct Sliding<S: Space> {
    /// Index of the contact in the network.
    at: usize,
    /// Velocity V of linearisation (m/s), and the friction at it.
    speed: f64,
    friction: FrictionAt,
    /// Damping m P in the form (kg).
    damping: f64,
    /// Bond part of the form without the damper.
    bond: Option<Elastic<S>>,
    /// Last change of the coefficient of a falling law.
    change: f64,
}

impl<S: Space> Sliding<S> {
    /// Writes the linearised law into the form, for a load P (N s).
    fn apply(&mut self, form: &mut ContactForm<S>, load: f64) {
        let FrictionAt { mu, slope } = self.friction;
        (form.friction, self.damping) = (mu, 0.0);
        // A law in the slip of a spring, or with restitution, is none in u.
        let plain = form.compliance[1] == 0.0 && form.shift_t == S::Tangent::zero();
        if plain && slope > 0.0 && load > 0.0 && self.speed > 0.0 {
            let slope = slope.min(mu / self.speed);
            form.friction = mu - slope * self.speed;
            self.damping = slope * load;
        }
        if self.damping > 0.0 || form.elastic.is_some() {
            let bond = form.elastic.get_or_insert_with(Elastic::none);
            bond.b_t = self.bond.map_or(0.0, |b| b.b_t) + self.damping;
        }
    }
}

/// The contacts of one interface whose friction depends on the velocity.
#[derive(Debug)]
struct SlidingGroup<S: Space> {
    interface: usize,
    contacts: Vec<Sliding<S>>,
}

/// Returns direction and size of the tangential part of a velocity; any direction for zero.
fn direction<S: Space>(normal: &S::Vector, velocity: &S::Vector) -> (S::Tangent, f64) {
    let ut = S::tangential(normal, velocity);
    let speed = ut.norm();
    if speed > 0.0 {
        (ut * (1.0 / speed), speed)
    } else {
        (S::from_components(normal, 1.0, 0.0), 0.0)
    }
}

/// Result of a contact in a solve.
#[derive(Clone, Copy, Debug)]
struct SlidingAnswer<S: Space> {
    /// Direction of sliding, and velocity (m/s).
    along: S::Tangent,
    speed: f64,
    /// Normal load P, and the friction used (N s).
    load: f64,
    used: f64,
    /// Whether friction is at its bound.
    slides: bool,
}

impl<S: Space> SlidingAnswer<S> {
    fn of(
        contact: &Contact<S>,
        sliding: &Sliding<S>,
        form: &ContactForm<S>,
        step: &ContactStep<S>,
        after: &S::Vector,
    ) -> Self {
        let (along, speed) = direction::<S>(&contact.normal, after);
        let solution = &step.solution;
        Self {
            along,
            speed,
            load: (solution.unilateral_n + form.tension).max(0.0),
            used: solution.unilateral_t.norm() + sliding.damping * speed,
            slides: step.slides && speed > 0.0,
        }
    }
}

/// Difference between the friction of a solve and that of the laws.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrictionMismatch {
    /// Sum of the differences over the sum of the friction.
    pub share: f64,
    /// Whether the two agree, or differ by no more than another solve would change.
    pub agrees: bool,
}

impl FrictionMismatch {
    /// Computes the difference from the entries: difference, friction (N s), and whether the law
    /// rises.
    fn of(differences: &[(f64, f64, bool)], iterations: u32) -> Self {
        let whole: f64 = differences.iter().map(|d| d.1).sum();
        let differs = |rises: bool| differences.iter().filter(move |d| d.2 == rises);
        let falling: f64 = differs(false).map(|d| d.0).sum();
        let rising: f64 = differs(true).map(|d| d.0).sum();
        let share = |x: f64| if x > 0.0 { x / whole } else { 0.0 };
        let many = iterations >= MAX_FALLING_SOLVES;
        // Each rising law is compared separately, unless its load is negligible.
        let each = differs(true).all(|d| d.0 <= TOLERANCE * (d.1 + NEXT_TO_NOTHING * whole));
        let rises = each || many && share(rising) <= TOLERANCE_OF_ALL;
        let falls = share(falling) <= TOLERANCE_OF_ALL || many;
        Self {
            share: share(falling + rising),
            agrees: rises && falls,
        }
    }
}

/// The iteration of a step.
#[derive(Debug)]
pub(super) struct SlidingLaws<S: Space> {
    groups: Vec<SlidingGroup<S>>,
    iterations: u32,
    /// Floor V_0 (m/s).
    floor: f64,
}

impl<S: Space> SlidingLaws<S> {
    /// Whether no friction depends on the velocity.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }
}

/// Returns V_0 from relative velocities (m/s).
fn floor<S: Space>(tolerance: f64, relative: &[S::Vector]) -> f64 {
    let squared: f64 = relative.iter().map(|u| u.dot(u)).sum();
    tolerance.min(COARSEST) * (squared / relative.len().max(1) as f64).sqrt()
}

/// Finds the contacts whose friction depends on the sliding velocity, and linearises it at the
/// velocities at the start of the step.
pub(super) fn begin_sliding<S: Space>(
    s: &mut Simulation<S>,
    info: &StepInfo,
) -> Result<SlidingLaws<S>, LawError> {
    let mut all = SlidingLaws {
        groups: Vec::new(),
        iterations: 0,
        floor: 0.0,
    };
    if s.laws.iter().all(|law| law.constant_contact()) {
        return Ok(all);
    }
    let tolerance = s.options.solver.tolerance;
    all.floor = floor::<S>(tolerance, &s.workspace.solved.before.relative);
    let (evaluator, mut step) = law_step(s, info);
    let dependent = evaluator.rate_dependent(&mut step);
    for (interface, members) in dependent {
        let contacts = &s.state.network.contacts;
        let before = &s.workspace.solved.before.relative;
        let of = |at: &usize| {
            let n = &contacts[*at].normal;
            let (along, speed) = direction::<S>(n, &before[*at]);
            along * speed.max(all.floor)
        };
        let velocities: Vec<S::Tangent> = members.iter().map(of).collect();
        let (evaluator, mut step) = law_step(s, info);
        let friction = evaluator.friction_at(&mut step, interface, &members, &velocities)?;
        let (contacts, forms) = (&s.state.network.contacts, &mut s.workspace.forms);
        let mut group = Vec::with_capacity(members.len());
        for ((at, velocity), friction) in members.iter().zip(&velocities).zip(friction) {
            let form = &mut forms[*at];
            let mut sliding = Sliding {
                at: *at,
                speed: velocity.norm(),
                friction,
                damping: 0.0,
                bond: form.elastic,
                change: 0.0,
            };
            let load = form.normal.dot(&contacts[*at].impulse) + form.tension;
            sliding.apply(form, load);
            group.push(sliding);
        }
        all.groups.push(SlidingGroup {
            interface,
            contacts: group,
        });
    }
    Ok(all)
}

/// Compares the friction of a solve with that of the laws at the resulting velocities. Unless they
/// agree, the laws are linearised again if `again`.
pub(super) fn compare_sliding<S: Space>(
    s: &mut Simulation<S>,
    laws: &mut SlidingLaws<S>,
    again: bool,
    info: &StepInfo,
) -> Result<FrictionMismatch, LawError> {
    laws.iterations += 1;
    if laws.groups.is_empty() {
        return Ok(FrictionMismatch {
            share: 0.0,
            agrees: true,
        });
    }
    let floor = floor::<S>(s.options.solver.tolerance, &s.workspace.solved.after);
    laws.floor = laws.floor.max(floor);
    let floor = laws.floor;
    let mut differences = Vec::new();
    let mut found = Vec::with_capacity(laws.groups.len());
    for group in &laws.groups {
        let workspace = &s.workspace;
        let of = |sliding: &Sliding<S>| {
            let at = sliding.at;
            SlidingAnswer::of(
                &s.state.network.contacts[at],
                sliding,
                &workspace.forms[at],
                &workspace.solved.contact_steps[at],
                &workspace.solved.after[at],
            )
        };
        let done: Vec<SlidingAnswer<S>> = group.contacts.iter().map(of).collect();
        let velocities = done
            .iter()
            .map(|d| d.along * d.speed.max(floor))
            .collect::<Vec<_>>();
        let friction = friction_of(s, group, &velocities, info)?;
        for ((sliding, done), friction) in group.contacts.iter().zip(&done).zip(&friction) {
            if done.load == 0.0 {
                continue;
            }
            let form = &s.workspace.forms[sliding.at];
            let allowed = friction.mu * done.load + form.cohesion;
            let excess = done.used - allowed;
            let differs = if done.slides {
                excess.abs()
            } else {
                excess.max(0.0)
            };
            let rises = friction.slope > 0.0 || sliding.friction.slope > 0.0;
            differences.push((differs, allowed, rises));
        }
        found.push((done, friction));
    }
    let mismatch = FrictionMismatch::of(&differences, laws.iterations);
    if mismatch.agrees || !again {
        return Ok(mismatch);
    }
    let (iterations, floor) = (laws.iterations, laws.floor);
    for (group, (done, friction)) in laws.groups.iter_mut().zip(found) {
        linearise_sliding(s, group, &done, &friction, (iterations, floor), info)?;
    }
    Ok(mismatch)
}

fn friction_of<S: Space>(
    s: &mut Simulation<S>,
    group: &SlidingGroup<S>,
    velocities: &[S::Tangent],
    info: &StepInfo,
) -> Result<Vec<FrictionAt>, LawError> {
    let members: Vec<usize> = group.contacts.iter().map(|s| s.at).collect();
    let (evaluator, mut step) = law_step(s, info);
    evaluator.friction_at(&mut step, group.interface, &members, velocities)
}

/// Linearises the laws at the velocities found.
fn linearise_sliding<S: Space>(
    s: &mut Simulation<S>,
    group: &mut SlidingGroup<S>,
    done: &[SlidingAnswer<S>],
    found: &[FrictionAt],
    (iterations, floor): (u32, f64),
    info: &StepInfo,
) -> Result<(), LawError> {
    let mut speeds = Vec::with_capacity(done.len());
    for (sliding, done) in group.contacts.iter().zip(done) {
        let cohesion = s.workspace.forms[sliding.at].cohesion;
        speeds.push(next_speed(sliding, done, cohesion, iterations).max(floor));
    }
    let asked = |d: &SlidingAnswer<S>| d.speed.max(floor);
    let elsewhere = speeds.iter().zip(done).any(|(v, d)| *v != asked(d));
    let given;
    let friction = if elsewhere {
        let velocities = done.iter().zip(&speeds).map(|(d, v)| d.along * *v);
        given = friction_of(s, group, &velocities.collect::<Vec<_>>(), info)?;
        &given[..]
    } else {
        found
    };
    let all = group
        .contacts
        .iter_mut()
        .zip(done)
        .zip(&speeds)
        .zip(friction);
    for (((sliding, done), speed), friction) in all {
        let form = &mut s.workspace.forms[sliding.at];
        if done.load == 0.0 {
            continue;
        }
        let mut friction = *friction;
        let mut change = friction.mu - sliding.friction.mu;
        if friction.slope <= 0.0 && sliding.friction.slope <= 0.0 {
            if change * sliding.change < 0.0 {
                change *= 0.5;
            }
            friction.mu = sliding.friction.mu + change;
        }
        sliding.change = change;
        (sliding.speed, sliding.friction) = (*speed, friction);
        sliding.apply(form, done.load);
    }
    Ok(())
}

/// Writes the result of the laws as friction alone: forms get its coefficient and no damper,
/// solutions all of it.
pub(super) fn settle_sliding<S: Space>(s: &mut Simulation<S>, laws: SlidingLaws<S>) {
    let contacts = laws.groups.into_iter().flat_map(|group| group.contacts);
    for sliding in contacts {
        let at = sliding.at;
        let form = &mut s.workspace.forms[at];
        form.elastic = sliding.bond;
        if sliding.damping == 0.0 {
            continue;
        }
        let solution = &mut s.workspace.solved.contact_steps[at].solution;
        let ut = S::tangential(&form.normal, &s.workspace.solved.after[at]);
        solution.unilateral_t -= ut * sliding.damping;
        let load = solution.unilateral_n + form.tension;
        if load > 0.0 {
            form.friction += sliding.damping * ut.norm() / load;
        }
    }
}

/// Returns the next velocity of linearisation (m/s).
fn next_speed<S: Space>(
    sliding: &Sliding<S>,
    done: &SlidingAnswer<S>,
    cohesion: f64,
    iterations: u32,
) -> f64 {
    let FrictionAt { mu, slope } = sliding.friction;
    let (here, found) = (sliding.speed, done.speed);
    let mut next = found;
    if slope > 0.0 && here > 0.0 && found < FAR_BELOW * here && done.load > 0.0 {
        let held = (done.used - cohesion) / done.load;
        let by = (held - mu) / (slope * here);
        next = found.max(here * by.clamp(-LONGEST, 0.0).exp());
    }
    if slope > 0.0 && iterations > CAUTIOUS && here > 0.0 && next > 0.0 {
        next = here.sqrt() * next.sqrt();
    }
    next
}
