//! Prepare and commit: evaluation of the laws in a step.
//!
//! Prepare writes friction, cohesion and the linearised bond of every contact into its standard local form.
//! Commit updates openings and damage, breaks bonds, removes worn volume, and books the energies.

use super::bonds::Held;
use super::columns::{Columns, StepInfo, not_finite};
use super::gather::contact_area;
use super::guarded::{self, Guarded};
use super::history::LawHistory;
use super::interface::{Interface, Loaded};
use super::library::{Call, LawError};
use super::range::settle;
use crate::contact::{Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution, Elastic};
use crate::solve::{MomentForm, MomentSolution};

/// Result of one contact over the step.
#[derive(Clone, Copy, Debug)]
pub struct ContactStep<S: Space> {
    /// Relative velocity u^- (m/s).
    pub before: S::Vector,
    /// Theta-averaged relative velocity u_th (m/s).
    pub average: S::Vector,
    /// Whether the unilateral part can carry tension (h c_n > 0).
    pub adheres: bool,
    /// Work dissipated by the bond's damping and by the time scheme (J).
    pub lost: f64,
    /// Work of the position correction (J).
    pub corrected: f64,
    /// Whether friction is at its bound (slip).
    pub slides: bool,
    /// The solver's solution.
    pub solution: ContactSolution<S>,
}

/// Result of a contact that resists rotation over the step.
#[derive(Clone, Copy, Debug)]
pub struct MomentStep<S: Space> {
    /// The solver's solution.
    pub moment: MomentSolution<S>,
    /// Theta-averaged relative spin (rad/s).
    pub spin: S::Spin,
    /// Work dissipated by the time scheme (J).
    pub lost: f64,
}

/// Relative velocities at the start of a step, one per contact.
#[derive(Clone, Debug)]
pub struct Velocities<S: Space> {
    /// u^- (m/s).
    pub relative: Vec<S::Vector>,
    /// Relative spins (rad/s); empty unless a bond resists rotation.
    pub turning: Vec<S::Spin>,
}

impl<S: Space> Default for Velocities<S> {
    fn default() -> Self {
        Self {
            relative: Vec::new(),
            turning: Vec::new(),
        }
    }
}

/// Energies and events of one step, summed over contacts (J, m^3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by impacts.
    pub impact: f64,
    /// Dissipated against tensile strength (cohesion without opening).
    pub adhesion: f64,
    /// Dissipated by damping of bonds.
    pub viscous: f64,
    /// Work of the position correction, negative: it separates penetrating bodies.
    pub correction: f64,
    /// Fracture energy released by damage.
    pub fracture: f64,
    /// Number of bonds that broke.
    pub broken: u64,
    /// Volume worn off first bodies.
    pub worn_first: f64,
    /// Volume worn in contacts between grains.
    pub worn_third: f64,
}

/// Evaluates the laws; owns the working memory of prepare and commit, and nothing that outlasts a step.
#[derive(Debug, Default)]
pub struct LawEvaluator {
    pub(super) columns: Columns,
    pub(super) members: Vec<usize>,
    pub(super) held: Held,
    /// Interface, slot and damage of the bonds in the last trial of an implicit coupling.
    pub(super) trials: Vec<(usize, usize, f64)>,
    /// Contacts of the last solve that close within the step and were kept from closing although their law
    /// has restitution.
    pub(crate) held_back: Vec<usize>,
    /// Which checks are made on law calls.
    pub(super) care: Care,
}

/// Checks made on the outputs of law calls.
#[derive(Debug, Default)]
pub(super) enum Care {
    /// Errors for values that are not finite or out of range, and for writes just beyond a column.
    #[default]
    Run,
    /// As `Run`, but without the range check, which certification makes itself.
    Lenient,
    /// As `Run`; in addition every call is made twice in guarded memory.
    Guarded(Box<Guarded>),
    /// As `Lenient`; in addition every call is repeated.
    Repeated,
}

/// Friction and restitution of one contact.
#[derive(Clone, Copy, Default)]
struct Friction {
    mu: f64,
    e_n: f64,
    e_t: f64,
    tension: f64,
    cohesion: f64,
    rolling: f64,
    spinning: f64,
}

impl LawEvaluator {
    /// Allocates the internal variables of contacts and forms the bonds that are due: by the case's bond
    /// rule, and by compression time (healing).
    ///
    /// # Errors
    /// The law's error in `initialise`.
    pub fn remember<S: Space>(
        &mut self,
        laws: &[Interface],
        history: &mut LawHistory,
        network: &mut Network<S>,
        info: &StepInfo,
    ) -> Result<(), LawError> {
        history.bonded.resize(laws.len(), false);
        for (index, law) in laws.iter().enumerate() {
            // Times are sums of steps, so that comparing at half a step is safe from rounding.
            let reached = |now: f64, time: f64| now > time - 0.5 * info.h;
            let due =
                !history.bonded[index] && law.bonding_time().is_some_and(|t| reached(info.time, t));
            history.bonded[index] |= due;
            let remembers = law.variables_of_contacts() > 0;
            if !due && !remembers && law.healing.is_none() {
                continue;
            }
            let initial = law.initial();
            let memory = &mut network.memory[index];
            self.members.clear();
            for (k, contact) in network.contacts.iter_mut().enumerate() {
                if contact.law as usize != index {
                    continue;
                }
                let area = law.area.area(S::D, contact.radius);
                let held = |slot: usize| memory.bonds[slot].intact();
                let intact = contact.memory().is_some_and(held);
                let healed = law
                    .healing
                    .is_some_and(|time| contact.pressed > 0.0 && reached(contact.pressed, time));
                let bonds =
                    !intact && !contact.vertex_contact && !contact.beyond && (due || healed);
                // The rest position of a new bond: a tension-only bond starts without tension over its gap;
                // one that also pushes yields until the gap is closed. Penetration is included in both, so
                // that a bond is formed without stress.
                let filled = if law.tension_only() {
                    contact.gap
                } else {
                    contact.gap.min(0.0)
                };
                match contact.memory() {
                    Some(slot) if bonds => {
                        memory.bond(slot, filled, area);
                        // A new bond has no history; the variables of the contact itself are kept.
                        for v in law.variables_of_bonds() {
                            memory.variables[v][slot] = initial[v];
                        }
                    }
                    None if bonds || remembers => {
                        contact.slot = memory.allocate(bonds, filled, area, &initial);
                        self.members.push(k);
                    }
                    _ => {}
                }
                if bonds {
                    network.bonds_formed.push((contact.bodies, contact.law));
                }
                if bonds && contact.broken {
                    contact.broken = false;
                    network.broken_pairs.remove(&contact.key.pair());
                }
            }
            self.initialise(index, law, history, network, info)?;
        }
        Ok(())
    }

    /// Calls the laws that initialise internal variables, for new contacts given as members.
    fn initialise<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        history: &mut LawHistory,
        network: &mut Network<S>,
        info: &StepInfo,
    ) -> Result<(), LawError> {
        if self.members.is_empty() || !law.loaded().any(|l| l.plugin.initialises()) {
            return Ok(());
        }
        let still = vec![S::Vector::zero(); network.contacts.len()];
        self.gather(law, network, &still, info);
        self.columns.size_outputs();
        for loaded in law.loaded() {
            self.run(loaded, history, info, 0.0, Call::Initialise)
                .map_err(|e| self.at(law, network, e))?;
        }
        self.keep_state(index, network);
        Ok(())
    }

    /// Completes the geometric forms of the contacts with the outputs of the laws.
    ///
    /// # Errors
    /// The law's error, with the contact.
    #[allow(clippy::too_many_arguments)]
    pub fn prepare<S: Space>(
        &mut self,
        laws: &[Interface],
        history: &mut LawHistory,
        network: &Network<S>,
        before: &Velocities<S>,
        info: &StepInfo,
        forms: &mut [ContactForm<S>],
        moments: &mut Vec<MomentForm<S>>,
    ) -> Result<(), LawError> {
        moments.clear();
        self.held_back.clear();
        for (index, law) in laws.iter().enumerate() {
            // Intact bonds come first, so that the cohesion law takes the head of the same columns.
            let bonded = |c: &Contact<S>| network.bond(c).is_some_and(|b| b.intact());
            let head = if law.opens() {
                self.select(network, |c| c.law as usize == index && bonded(c));
                let head = self.members.len();
                self.select_more(network, |c| c.law as usize == index && !bonded(c));
                head
            } else {
                self.select(network, |c| c.law as usize == index && !c.beyond);
                // Without an opening the cohesion acts on every contact, but not on those that are there for their speed.
                let head = law.cohesion().map_or(0, |_| self.members.len());
                self.select_more(network, |c| c.law as usize == index && c.beyond);
                head
            };
            if self.members.is_empty() {
                continue;
            }
            let constant = law.constant_contact();
            if constant {
                self.columns.clear();
                self.columns.n = 1;
            } else {
                self.gather(law, network, &before.relative, info);
            }
            self.columns.size_outputs();
            self.run(law.contact(), history, info, 0.0, Call::Prepare)
                .map_err(|e| self.at(law, network, e))?;
            let answer = |out: &super::columns::Outputs, k: usize| Friction {
                mu: out.friction[k],
                e_n: out.restitution_n[k],
                e_t: out.restitution_t[k],
                tension: out.tension_strength[k],
                cohesion: out.shear_cohesion[k],
                rolling: out.rolling[k],
                spinning: out.spinning[k],
            };
            let first = moments.len();
            for (k, at) in self.members.iter().enumerate() {
                let friction = answer(&self.columns.out, if constant { 0 } else { k });
                let area = contact_area(law, network, &network.contacts[*at]);
                let held_back = apply_friction(
                    &mut forms[*at],
                    &friction,
                    &network.contacts[*at],
                    network.open_gap(&network.contacts[*at]),
                    &before.relative[*at],
                    area,
                    info,
                );
                if held_back {
                    self.held_back.push(*at);
                }
                if law.rotates() || friction.rolling > 0.0 || friction.spinning > 0.0 {
                    moments.push(MomentForm {
                        contact: *at as u32,
                        rolling: friction.rolling,
                        spinning: friction.spinning,
                        a: S::Spin::zero(),
                        b_twist: 0.0,
                        b_bend: 0.0,
                        loss_twist: 0.0,
                        loss_bend: 0.0,
                        moment: network.contacts[*at].moment,
                    });
                }
            }
            let Some(cohesion) = law.cohesion() else {
                continue;
            };
            if head == 0 {
                continue;
            }
            self.members.truncate(head);
            if constant {
                self.gather(law, network, &before.relative, info);
            } else {
                self.columns.truncate(head);
            }
            self.columns.size_outputs();
            self.run(cohesion, history, info, 0.0, Call::Prepare)
                .map_err(|e| self.at(law, network, e))?;
            for (k, at) in self.members.iter().enumerate() {
                self.apply_cohesion(law, k, &before.relative[*at], info, &mut forms[*at]);
            }
            if law.rotates() {
                for (k, form) in moments[first..].iter_mut().enumerate().take(head) {
                    let at = form.contact as usize;
                    self.apply_bending(
                        k,
                        &network.contacts[at].normal,
                        &before.turning[at],
                        info,
                        form,
                    );
                }
            }
        }
        Ok(())
    }

    pub(super) fn select<S: Space>(
        &mut self,
        network: &Network<S>,
        keep: impl Fn(&Contact<S>) -> bool,
    ) {
        self.members.clear();
        self.select_more(network, keep);
    }

    fn select_more<S: Space>(&mut self, network: &Network<S>, keep: impl Fn(&Contact<S>) -> bool) {
        let contacts = network.contacts.iter().enumerate();
        self.members
            .extend(contacts.filter(|(_, c)| keep(c)).map(|(k, _)| k));
    }

    pub(super) fn run(
        &mut self,
        loaded: &Loaded,
        history: &mut LawHistory,
        info: &StepInfo,
        degradation: f64,
        call: Call,
    ) -> Result<(), LawError> {
        let plugin = &loaded.plugin;
        let (columns, care) = (&mut self.columns, &mut self.care);
        let mut wrong = None;
        let called = columns.with_batch(loaded, info, degradation, |batch| match care {
            Care::Guarded(guarded) => {
                let (parameters, variables) = (loaded.parameters.len(), loaded.variables());
                // SAFETY: as below, and copies of the columns are as long as they.
                let (called, what) =
                    unsafe { guarded.call(batch, parameters, variables, |b| plugin.call(call, b)) };
                wrong = what;
                called
            }
            Care::Repeated => {
                // SAFETY: as below.
                let (called, what) =
                    unsafe { guarded::repeat(batch, loaded.variables(), |b| plugin.call(call, b)) };
                wrong = what;
                called
            }
            // SAFETY: columns of the batch have `n` values or are null, and live in `self`.
            _ => unsafe { plugin.call(call, batch) },
        });
        if let Some(what) = wrong {
            return Err(LawError::Trespass {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                what,
            });
        }
        if self.columns.overrun {
            let name = plugin.name.clone();
            return Err(LawError::Overrun {
                kind: plugin.kind,
                name,
                call,
            });
        }
        called?;
        let state = match call {
            Call::Commit | Call::Initialise => self.columns.state_not_finite(),
            _ => None,
        };
        let mut outputs = (plugin.kind.spec().outputs)(&mut self.columns.out, call);
        if let Some(contact) = not_finite(&outputs).or(state) {
            return Err(LawError::NotFinite {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                contact: Some(contact),
            });
        }
        if matches!(self.care, Care::Lenient | Care::Repeated) {
            return Ok(());
        }
        match settle(&mut outputs, plugin.kind, &mut history.largest) {
            None => Ok(()),
            Some(outside) => Err(LawError::OutOfRange {
                kind: plugin.kind,
                name: plugin.name.clone(),
                call,
                contact: Some(outside.contact),
                column: outside.column,
                value: outside.value,
                range: outside.range,
            }),
        }
    }

    /// Adds the interface and the contact, one of the members, to an error of a law.
    pub(super) fn at<S: Space>(
        &self,
        law: &Interface,
        network: &Network<S>,
        source: LawError,
    ) -> LawError {
        // A single result for all contacts belongs to no particular contact.
        let single = self.columns.n == self.members.len();
        let member = source.contact().filter(|_| single);
        let contact = member.and_then(|k| network.contacts.get(*self.members.get(k)?));
        LawError::At {
            interface: law.name.clone(),
            bodies: contact.map(|c| c.bodies),
            source: Box::new(source),
        }
    }

    fn apply_cohesion<S: Space>(
        &self,
        law: &Interface,
        k: usize,
        before: &S::Vector,
        info: &StepInfo,
        form: &mut ContactForm<S>,
    ) {
        let (out, n) = (&self.columns.out, &form.normal);
        let StepInfo { h, theta, .. } = *info;
        let area = self.columns.area[k];
        let (un, ut) = (n.dot(before), S::tangential(n, before));
        let memory = h * theta * (1.0 - theta);
        let (kn, kt) = (out.stiffness_n[k].max(0.0), out.stiffness_t[k].max(0.0));
        let (dn, dt) = (out.damping_n[k].max(0.0), out.damping_t[k].max(0.0));
        let traction_t = S::from_components(n, out.traction[1][k], out.traction[2][k]);
        form.tension += h * area * out.tension_strength[k];
        form.cohesion += h * area * out.shear_cohesion[k];
        if !law.opens() {
            return;
        }
        form.elastic = Some(Elastic {
            a_n: h * area * (out.traction[0][k] + (kn * memory + dn * (1.0 - theta)) * un),
            a_t: (traction_t + ut * (kt * memory + dt * (1.0 - theta))) * (h * area),
            b_n: h * area * (h * theta * theta * kn + theta * dn),
            b_t: h * area * (h * theta * theta * kt + theta * dt),
            tension_only: law.tension_only(),
            // Damping, and the dissipation of the theta-scheme beyond the change of k x^2/2.
            loss_n: h * area * (dn + h * (theta - 0.5) * kn),
            loss_t: h * area * (dt + h * (theta - 0.5) * kt),
        });
    }

    /// Applies the linearised bending and twist of a bond.
    fn apply_bending<S: Space>(
        &self,
        k: usize,
        n: &S::Vector,
        before: &S::Spin,
        info: &StepInfo,
        form: &mut MomentForm<S>,
    ) {
        let (out, StepInfo { h, theta, .. }) = (&self.columns.out, *info);
        let impulse = h * self.columns.area[k];
        let (twist, bend) = (
            out.stiffness_twist[k].max(0.0),
            out.stiffness_bend[k].max(0.0),
        );
        let (w_twist, w_bend) = S::split_spin(n, before);
        let memory = h * theta * (1.0 - theta);
        let moment = S::spin_from(n, [out.moment[0][k], out.moment[1][k], out.moment[2][k]]);
        form.a =
            (moment + S::about(n, w_twist * (twist * memory)) + w_bend * (bend * memory)) * impulse;
        form.b_twist = impulse * h * theta * theta * twist;
        form.b_bend = impulse * h * theta * theta * bend;
        form.loss_twist = impulse * h * (theta - 0.5) * twist;
        form.loss_bend = impulse * h * (theta - 0.5) * bend;
    }
}

/// Applies friction and restitution; returns whether the contact has restitution and is only kept from
/// closing in this step.
fn apply_friction<S: Space>(
    form: &mut ContactForm<S>,
    friction: &Friction,
    contact: &Contact<S>,
    // The gap minus the rest gap of an unbroken bond.
    gap: f64,
    before: &S::Vector,
    area: f64,
    info: &StepInfo,
) -> bool {
    form.friction = friction.mu;
    form.tension = info.h * area * friction.tension;
    form.cohesion = info.h * area * friction.cohesion;
    if contact.beyond {
        (form.tension, form.cohesion) = (0.0, 0.0);
    }
    // Newton's restitution acts on closed contacts and on those that would close and penetrate within the
    // step, with their approach velocity; other open contacts are free (a quasi-shock would remove the
    // approach velocity before the impact). A contact that closes only because of another impact of this
    // step is kept from closing, and rebounds in the next step.
    let un = contact.normal.dot(before);
    let first = contact.closing && !contact.later && un < 0.0;
    let impact = gap <= 0.0 || first;
    if friction.e_n > 0.0 {
        if !impact {
            if !contact.closing {
                form.shift_n = f64::INFINITY;
            }
        } else if un < 0.0 {
            form.shift_n = friction.e_n * un;
        }
    }
    if impact && friction.e_t > 0.0 {
        form.shift_t = S::tangential(&contact.normal, before) * friction.e_t;
    }
    friction.e_n > 0.0 && contact.closing && !impact
}
