//! Prepare: the laws write friction, cohesion and the linearised bond of every contact into its standard local form.

use super::columns::{Outputs, StepInfo};
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::gather::contact_area;
use super::history::LawHistory;
use super::interface::{Interface, Loaded};
use super::library::Call;
use super::spring::SpringForm;
use super::step_result::Velocities;
use crate::contact::{Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::solve::MomentForm;
use crate::solve::form::{ContactForm, Elastic};
use crate::threads::{map_chunks_mut, pays};

/// Contacts of a task.
const CHUNK: usize = 1024;
/// About what it takes to apply friction to a contact (ns).
const APPLY: f64 = 10.0;

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

impl Friction {
    /// Reads the outputs of a contact law at a place in its batch.
    #[inline]
    fn of(out: &Outputs, k: usize) -> Self {
        Self {
            mu: out.friction[k],
            e_n: out.restitution_n[k],
            e_t: out.restitution_t[k],
            tension: out.tension_strength[k],
            cohesion: out.shear_cohesion[k],
            rolling: out.rolling[k],
            spinning: out.spinning[k],
        }
    }
}

/// The contacts of a step before the solve, and their forms, which the laws complete.
struct Preparation<'a, S: Space> {
    network: &'a Network<S>,
    before: &'a Velocities<S>,
    info: &'a StepInfo,
    forms: &'a mut [ContactForm<S>],
    springs: &'a mut [Option<SpringForm<S>>],
    moments: &'a mut Vec<MomentForm<S>>,
}

impl LawEvaluator {
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
        springs: &mut Vec<Option<SpringForm<S>>>,
        moments: &mut Vec<MomentForm<S>>,
    ) -> Result<(), LawError> {
        moments.clear();
        springs.clear();
        if laws.iter().any(Interface::compliant) {
            springs.resize(forms.len(), None);
        }
        self.held_back.clear();
        let mut step = Preparation {
            network,
            before,
            info,
            forms,
            springs,
            moments,
        };
        for (index, law) in laws.iter().enumerate() {
            let cohesive = self.select_cohesive_first(index, law, network);
            if self.members.is_empty() {
                continue;
            }
            let cohesion = law.cohesion().filter(|_| cohesive > 0);
            if law.constant_contact() {
                // One answer for all contacts, and then cohesion adds to it.
                let mut first_moment = step.moments.len();
                self.prepare_contact(law, history, &mut step)?;
                let Some(cohesion) = cohesion else { continue };
                self.members.truncate(cohesive);
                self.in_batches(|batch| {
                    batch.prepare_cohesion(law, cohesion, history, &mut step, first_moment)?;
                    first_moment += batch.members.len();
                    Ok(())
                })?;
                continue;
            }
            let rest = self.members.split_off(cohesive);
            self.in_batches(|batch| {
                let first_moment = step.moments.len();
                batch.prepare_contact(law, history, &mut step)?;
                let Some(cohesion) = cohesion else {
                    return Ok(());
                };
                batch.prepare_cohesion(law, cohesion, history, &mut step, first_moment)
            })?;
            self.members = rest;
            self.in_batches(|batch| batch.prepare_contact(law, history, &mut step))?;
        }
        // The spring carries the load and the attraction, P = p + h c_n A: its law is in u + s + c P.
        for (form, _) in step
            .forms
            .iter_mut()
            .zip(step.springs.iter())
            .filter(|(_, s)| s.is_some())
        {
            form.shift_n += form.compliance[0] * form.tension;
        }
        Ok(())
    }

    /// Selects the contacts of an interface, first those on which its cohesion acts; returns their number.
    fn select_cohesive_first<S: Space>(
        &mut self,
        index: usize,
        law: &Interface,
        network: &Network<S>,
    ) -> usize {
        let of_law = |c: &Contact<S>| c.law as usize == index;
        if law.opens() {
            // Cohesion with an opening acts on intact bonds.
            let bonded = |c: &Contact<S>| network.bond(c).is_some_and(|b| b.intact());
            self.select(network, |c| of_law(c) && bonded(c));
            let cohesive = self.members.len();
            self.select_more(network, |c| of_law(c) && !bonded(c));
            return cohesive;
        }
        self.select(network, |c| of_law(c) && !c.beyond);
        // Without an opening the cohesion acts on every contact, but not on those that are there for their speed.
        let cohesive = law.cohesion().map_or(0, |_| self.members.len());
        self.select_more(network, |c| of_law(c) && c.beyond);
        cohesive
    }

    /// Applies the contact law of an interface to the members.
    fn prepare_contact<S: Space>(
        &mut self,
        law: &Interface,
        history: &mut LawHistory,
        step: &mut Preparation<S>,
    ) -> Result<(), LawError> {
        let (network, info) = (step.network, step.info);
        let constant = law.constant_contact();
        if constant {
            self.columns.clear();
            self.columns.n = 1;
        } else {
            self.gather(law, network, step.before, info);
        }
        self.columns.size_outputs();
        self.run(law.contact(), history, info, 0.0, Call::Prepare)
            .map_err(|e| self.locate(law, network, e))?;
        let (network, before) = (step.network, step.before);
        if constant && !law.compliant() && !law.rotates() {
            let friction = Friction::of(&self.columns.out, 0);
            if friction.rolling == 0.0 && friction.spinning == 0.0 {
                self.apply_constant(law, &friction, step);
                return Ok(());
            }
        }
        for (k, at) in self.members.iter().enumerate() {
            let mut friction = Friction::of(&self.columns.out, if constant { 0 } else { k });
            let area = contact_area(law, network, &network.contacts[*at]);
            if law.compliant() {
                let spring = self.spring(k, &network.contacts[*at], network);
                spring.apply(info.h, &mut step.forms[*at]);
                // A spring rebounds by its damping.
                (friction.e_n, friction.e_t) = (0.0, 0.0);
                step.springs[*at] = Some(spring);
            }
            let held_back = apply_friction(
                &mut step.forms[*at],
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
                step.moments.push(MomentForm {
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
        Ok(())
    }

    /// Applies friction and restitution that are the same for all contacts of an interface, which are the members.
    fn apply_constant<S: Space>(
        &mut self,
        law: &Interface,
        friction: &Friction,
        step: &mut Preparation<S>,
    ) {
        let (network, before, info) = (step.network, step.before, step.info);
        let index = network.contacts[self.members[0]].law;
        let divide = pays(self.parallel, network.contacts.len(), APPLY);
        let held_back = map_chunks_mut(divide, step.forms, CHUNK, |first, forms| {
            let mut held_back = Vec::new();
            for (form, at) in forms.iter_mut().zip(first..) {
                let contact = &network.contacts[at];
                if contact.law != index {
                    continue;
                }
                let area = contact_area(law, network, contact);
                let (gap, before) = (network.open_gap(contact), &before.relative[at]);
                if apply_friction(form, friction, contact, gap, before, area, info) {
                    held_back.push(at);
                }
            }
            held_back
        });
        self.held_back.extend(held_back.into_iter().flatten());
    }

    /// Applies the cohesion law of an interface to the members, and to the moments from `first_moment` on.
    fn prepare_cohesion<S: Space>(
        &mut self,
        law: &Interface,
        cohesion: &Loaded,
        history: &mut LawHistory,
        step: &mut Preparation<S>,
        first_moment: usize,
    ) -> Result<(), LawError> {
        let (network, info) = (step.network, step.info);
        let count = self.members.len();
        if law.constant_contact() {
            self.gather(law, network, step.before, info);
        } else {
            // The members are the first in the columns of the contact law.
            self.columns.truncate(count);
        }
        self.columns.size_outputs();
        self.run(cohesion, history, info, 0.0, Call::Prepare)
            .map_err(|e| self.locate(law, network, e))?;
        for (k, at) in self.members.iter().enumerate() {
            let before = &step.before.relative[*at];
            self.apply_cohesion(law, k, before, info, &mut step.forms[*at]);
        }
        if law.rotates() {
            let moments = step.moments.iter_mut().skip(first_moment);
            for (k, form) in moments.enumerate().take(count) {
                let at = form.contact as usize;
                let normal = &network.contacts[at].normal;
                self.apply_bending(k, normal, &step.before.turning[at], info, form);
            }
        }
        Ok(())
    }

    /// The spring of a member, as its law gave it.
    fn spring<S: Space>(
        &self,
        k: usize,
        contact: &Contact<S>,
        network: &Network<S>,
    ) -> SpringForm<S> {
        let (columns, out) = (&self.columns, &self.columns.out);
        let [force_n, t1, t2] = &out.contact_force;
        let t2 = if S::D == 3 { t2[k] } else { 0.0 };
        SpringForm {
            gap: network.spring_gap(contact),
            overlap: columns.overlap[k],
            force_n: force_n[k],
            stiffness_n: out.contact_stiffness_n[k],
            damping_n: out.contact_damping_n[k],
            force_t: S::from_components(&contact.normal, t1[k], t2),
            stiffness_t: out.contact_stiffness_t[k],
            unloading_t: out.contact_unloading_t[k],
            damping_t: out.contact_damping_t[k],
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
        form.a = (moment + S::spin_about(n, w_twist * (twist * memory)) + w_bend * (bend * memory))
            * impulse;
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
    let aside = contact.vertex_contact && contact.key.ball().is_some();
    if contact.beyond || aside {
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
