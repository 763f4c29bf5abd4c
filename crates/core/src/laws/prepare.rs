//! Prepare: the laws write friction, cohesion and the linearised bond of every contact into its
//! standard local form.

use super::batch::{BATCH, LawBatch, locate};
use super::error::LawError;
use super::evaluator::LawEvaluator;
use super::function::Call;
use super::gather::{Source, contact_area};
use super::history::LawHistory;
use super::interface::{Interface, LoadedLaw};
use super::outputs::Outputs;
use super::spring::SpringForm;
use super::step_info::StepInfo;
use super::step_result::Velocities;
use crate::contact::{Contact, Network};
use crate::geometry::space::{Space, VectorLike};
use crate::solve::MomentForm;
use crate::solve::form::{ContactForm, Elastic};
use crate::threads::{chunk_size, map_chunks_mut, worth_dividing};

/// Number of contacts of a task.
const CHUNK: usize = 1024;
/// Approximate time to apply friction to a contact (ns).
const APPLY: f64 = 10.0;
/// Approximate time per contact of laws that vary between contacts (ns).
const PREPARE: f64 = 80.0;
/// Relative difference between a traction and stiffness times opening up to which the two are equal
/// except for rounding.
const LINEAR: f64 = 1e-9;

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

    /// Returns whether the friction acts against rotation.
    #[inline]
    fn rotates(&self) -> bool {
        self.rolling > 0.0 || self.spinning > 0.0
    }
}

/// Contacts of a batch, and the range of forms and springs from the first to the last of them,
/// which no other batch uses.
struct Task<'a, S: Space> {
    members: &'a [usize],
    first: usize,
    forms: &'a mut [ContactForm<S>],
    springs: &'a mut [Option<SpringForm<S>>],
}

/// Divides contacts in ascending order into batches, with their forms and springs.
fn tasks<'a, S: Space>(
    members: &'a [usize],
    mut forms: &'a mut [ContactForm<S>],
    mut springs: &'a mut [Option<SpringForm<S>>],
) -> Vec<Task<'a, S>> {
    let mut first = 0;
    let batches = members.chunks(chunk_size(BATCH));
    let task = batches.map(|members| {
        let count = members.last().map_or(0, |last| last + 1 - first);
        let (own, rest) = std::mem::take(&mut forms).split_at_mut(count);
        forms = rest;
        let springs_of = count.min(springs.len());
        let (own_springs, rest) = std::mem::take(&mut springs).split_at_mut(springs_of);
        springs = rest;
        let task = Task {
            members,
            first,
            forms: own,
            springs: own_springs,
        };
        first += count;
        task
    });
    task.collect()
}

/// Functions for which the laws of an interface are called.
struct Request<'a, S: Space> {
    law: &'a Interface,
    index: usize,
    info: &'a StepInfo,
    before: &'a Velocities<S>,
    contact: ContactRequest,
    cohesion: Option<&'a LoadedLaw>,
    /// Whether the damage at the middle of the step is predicted.
    predicts: bool,
}

/// Source of friction and restitution.
enum ContactRequest {
    /// The forms have them already.
    Done,
    /// All contacts have the same values.
    Constant(Friction),
    /// The contact law.
    Each,
}

/// Results of a batch, in addition to forms and springs.
struct Prepared<S: Space> {
    moments: Vec<MomentForm<S>>,
    held_back: Vec<usize>,
    /// Predicted damage by slot.
    predicted: Vec<(u32, f64)>,
}

impl LawEvaluator {
    /// Completes the geometric forms of the contacts with the outputs of the laws. Contacts are as
    /// at the last [`Self::select`].
    ///
    /// If `predicts`, the impulses of every intact bond use the mean of its damage and of the
    /// damage that the law gives for the opening to which the motion at the start of the step
    /// leads.
    ///
    /// # Errors
    /// The law's error, with the contact.
    #[allow(clippy::too_many_arguments)]
    pub fn prepare<S: Space>(
        &mut self,
        laws: &[Interface],
        history: &mut LawHistory,
        network: &mut Network<S>,
        before: &Velocities<S>,
        info: &StepInfo,
        predicts: bool,
        forms: &mut [ContactForm<S>],
        springs: &mut Vec<Option<SpringForm<S>>>,
        moments: &mut Vec<MomentForm<S>>,
    ) -> Result<(), LawError> {
        moments.clear();
        // Where all contacts are springs, all forms are set below.
        if !laws.iter().all(Interface::compliant) || springs.len() != forms.len() {
            springs.clear();
        }
        if laws.iter().any(Interface::compliant) {
            springs.resize(forms.len(), None);
        }
        self.held_back.clear();
        for (index, law) in laws.iter().enumerate() {
            let members = &self.members[index];
            if members.all.is_empty() {
                continue;
            }
            // Cohesion with an opening acts on intact bonds. Without an opening it acts on every
            // contact, except those predicted because of their speed.
            let (cohesive, others) = match law.opens() {
                true => (&members.bonded[..], &members.loose[..]),
                false => (members.near(), &members.beyond[..]),
            };
            let mut request = Request {
                law,
                index,
                info,
                before,
                contact: ContactRequest::Each,
                cohesion: law.cohesion(),
                predicts: predicts && law.opens() && law.damages(),
            };
            if law.constant_contact() {
                // Friction is the same for all contacts, then cohesion adds to it.
                let friction = self.constant_friction(law, info, history)?;
                request.contact = if law.rotates() || friction.rotates() {
                    ContactRequest::Constant(friction)
                } else {
                    let held_back =
                        apply_constant(&request, network, &friction, forms, self.parallel);
                    self.held_back.extend(held_back);
                    ContactRequest::Done
                };
            }
            let largest = &mut history.largest;
            for members in [cohesive, others] {
                if request.idle() {
                    continue;
                }
                let divide = self.divides(members.len(), PREPARE);
                let tasks = tasks(members, forms, springs);
                let of = |network: &_, batch: &mut LawBatch, task: &mut Task<S>| {
                    batch.prepare(&request, network, task)
                };
                let held_back = &mut self.held_back;
                let take = |network: &mut Network<S>, _: &_, mut part: Prepared<S>| {
                    moments.append(&mut part.moments);
                    held_back.append(&mut part.held_back);
                    for (slot, damage) in part.predicted {
                        network.memory[index].bonds[slot as usize].step_damage = damage;
                    }
                };
                self.pool
                    .evaluate(divide, largest, network, tasks, of, take)?;
                (request.cohesion, request.predicts) = (None, false);
            }
        }
        Ok(())
    }

    /// Returns friction and restitution of a law that gives the same values for all contacts.
    fn constant_friction(
        &self,
        law: &Interface,
        info: &StepInfo,
        history: &mut LawHistory,
    ) -> Result<Friction, LawError> {
        let of = |_: &Friction, batch: &mut LawBatch, (): &mut ()| {
            batch.columns.clear();
            batch.columns.n = 1;
            let run = batch.run_afresh(law.contact(), info, 0.0, Call::Prepare);
            run.map_err(|e| LawError::At {
                interface: law.name.clone(),
                bodies: None,
                source: Box::new(e),
            })?;
            Ok(Friction::of(&batch.columns.out, 0))
        };
        let mut given = Friction::default();
        let largest = &mut history.largest;
        self.pool.evaluate(
            false,
            largest,
            &mut given,
            vec![()],
            of,
            |given, (), friction| {
                *given = friction;
            },
        )?;
        Ok(given)
    }
}

/// Applies friction and restitution that are the same for all contacts of an interface; returns
/// those held back.
fn apply_constant<S: Space>(
    request: &Request<'_, S>,
    network: &Network<S>,
    friction: &Friction,
    forms: &mut [ContactForm<S>],
    parallel: bool,
) -> Vec<usize> {
    let Request {
        law, index, info, ..
    } = *request;
    let divide = worth_dividing(parallel, network.contacts.len(), APPLY);
    let held_back = map_chunks_mut(divide, forms, CHUNK, |first, forms| {
        let mut held_back = Vec::new();
        for (form, at) in forms.iter_mut().zip(first..) {
            let contact = &network.contacts[at];
            if contact.law as usize != index {
                continue;
            }
            let area = contact_area(law, network, contact);
            let (gap, before) = (network.open_gap(contact), &request.before.relative[at]);
            if apply_friction(form, friction, contact, gap, before, area, info) {
                held_back.push(at);
            }
        }
        held_back
    });
    held_back.into_iter().flatten().collect()
}

impl<S: Space> Request<'_, S> {
    /// Returns whether no law has to be called.
    fn idle(&self) -> bool {
        matches!(self.contact, ContactRequest::Done) && self.cohesion.is_none()
    }
}

impl LawBatch {
    /// Applies the laws of an interface to the forms of a batch.
    fn prepare<S: Space>(
        &mut self,
        request: &Request<'_, S>,
        network: &Network<S>,
        task: &mut Task<'_, S>,
    ) -> Result<Prepared<S>, LawError> {
        let Request {
            law,
            index,
            info,
            before,
            cohesion,
            ..
        } = *request;
        let source = Source::new(law, index, network, info);
        let mut prepared = Prepared {
            moments: Vec::new(),
            held_back: Vec::new(),
            predicted: Vec::new(),
        };
        if request.predicts {
            prepared.predicted = self.predict_damage(&source, task.members, before)?;
            let memory = &network.memory[index];
            for (slot, damage) in &mut prepared.predicted {
                let bond = &memory.bonds[*slot as usize];
                *damage = 0.5 * (bond.damage + (bond.step_damage + *damage));
            }
        }
        let mut acting: Vec<&LoadedLaw> = Vec::with_capacity(2);
        if let ContactRequest::Each = request.contact {
            acting.push(law.contact());
        }
        acting.extend(cohesion);
        if !acting.is_empty() {
            self.gather_before(&source, task.members, before, &acting);
            let predicted = prepared.predicted.iter().map(|(_, damage)| *damage);
            let columns = self.columns.damage.iter_mut();
            columns.zip(predicted).for_each(|(x, damage)| *x = damage);
        }
        match &request.contact {
            ContactRequest::Done => {}
            ContactRequest::Constant(friction) => {
                self.apply_contact(request, network, Some(friction), task, &mut prepared);
            }
            ContactRequest::Each => {
                self.run_afresh(law.contact(), info, 0.0, Call::Prepare)
                    .map_err(|e| locate(law, network, task.members, e))?;
                self.apply_contact(request, network, None, task, &mut prepared);
            }
        }
        if let Some(cohesion) = cohesion {
            self.run_afresh(cohesion, info, 0.0, Call::Prepare)
                .map_err(|e| locate(law, network, task.members, e))?;
            self.apply_cohesions(request, network, task, &mut prepared);
        }
        if law.compliant() {
            // The spring carries the load and the attraction, P = p + h c_n A: its law is in u + s
            // + c P.
            for at in task.members {
                let form = &mut task.forms[at - task.first];
                form.shift_n += form.compliance[0] * form.tension;
            }
        }
        Ok(prepared)
    }

    /// Applies the outputs of the cohesion law to the forms of a batch.
    fn apply_cohesions<S: Space>(
        &self,
        request: &Request<'_, S>,
        network: &Network<S>,
        task: &mut Task<'_, S>,
        prepared: &mut Prepared<S>,
    ) {
        let Request {
            law, info, before, ..
        } = *request;
        for (k, at) in task.members.iter().enumerate() {
            let form = &mut task.forms[at - task.first];
            self.apply_cohesion(law, k, &before.relative[*at], info, form);
        }
        if law.rotates() {
            for (k, form) in prepared.moments.iter_mut().enumerate() {
                let at = form.contact as usize;
                let normal = &network.contacts[at].normal;
                self.apply_bending(k, normal, &before.turning[at], info, form);
            }
        }
    }

    /// Applies the outputs of the contact law, or constant values, to the forms of a batch.
    fn apply_contact<S: Space>(
        &self,
        request: &Request<'_, S>,
        network: &Network<S>,
        constant: Option<&Friction>,
        task: &mut Task<'_, S>,
        prepared: &mut Prepared<S>,
    ) {
        let Request { law, info, .. } = *request;
        let (rotates, compliant) = (law.rotates(), law.compliant());
        let gathered = constant.is_none() || request.cohesion.is_some();
        for (k, at) in task.members.iter().enumerate() {
            let (contact, form) = (&network.contacts[*at], &mut task.forms[at - task.first]);
            let mut friction = match constant {
                Some(friction) => *friction,
                None => Friction::of(&self.columns.out, k),
            };
            let (area, gap) = if gathered {
                (self.columns.area[k], self.open_gap[k])
            } else {
                let area = contact_area(law, network, contact);
                (area, network.open_gap(contact))
            };
            if compliant {
                let mut spring = self.spring(k, contact);
                spring.limit_to(contact.spring.energy[1] + contact.friction_work.max(0.0));
                spring.apply(info.h, form);
                // A spring rebounds by its damping.
                (friction.e_n, friction.e_t) = (0.0, 0.0);
                task.springs[at - task.first] = Some(spring);
            }
            let before = &request.before.relative[*at];
            if apply_friction(form, &friction, contact, gap, before, area, info) {
                prepared.held_back.push(*at);
            }
            if rotates || friction.rotates() {
                prepared.moments.push(MomentForm {
                    contact: *at as u32,
                    rolling: friction.rolling,
                    spinning: friction.spinning,
                    a: S::Spin::zero(),
                    b_twist: 0.0,
                    b_bend: 0.0,
                    loss_twist: 0.0,
                    loss_bend: 0.0,
                    moment: contact.moment,
                });
            }
        }
    }

    /// Returns the spring of a member from the outputs of its law.
    fn spring<S: Space>(&self, k: usize, contact: &Contact<S>) -> SpringForm<S> {
        let (columns, out) = (&self.columns, &self.columns.out);
        let [force_n, t1, t2] = &out.contact_force;
        let t2 = if S::D == 3 { t2[k] } else { 0.0 };
        SpringForm {
            gap: self.spring_gap[k],
            overlap: columns.overlap[k],
            force_n: force_n[k],
            stiffness_n: out.contact_stiffness_n[k],
            damping_n: out.contact_damping_n[k],
            force_t: S::from_components(&contact.normal, t1[k], t2),
            stiffness_t: out.contact_stiffness_t[k],
            unloading_t: out.contact_unloading_t[k],
            energy_t: out.contact_energy_t[k],
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
        let linear = (0..S::D).all(|axis| {
            let stiffness = if axis == 0 { kn } else { kt };
            let (x, t) = (self.columns.opening[axis][k], out.traction[axis][k]);
            (t - stiffness * x).abs() <= LINEAR * t.abs()
        });
        form.elastic = Some(Elastic {
            a_n: h * area * (out.traction[0][k] + (kn * memory + dn * (1.0 - theta)) * un),
            a_t: (traction_t + ut * (kt * memory + dt * (1.0 - theta))) * (h * area),
            b_n: h * area * (h * theta * theta * kn + theta * dn),
            b_t: h * area * (h * theta * theta * kt + theta * dt),
            tension_only: law.tension_only(),
            damped: dn > 0.0,
            curved: !linear,
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

/// Applies friction and restitution; returns whether the contact has restitution and is only kept
/// from closing in this step.
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
    // Newton's restitution acts on closed contacts and on those that would close and penetrate
    // within the step, with their approach velocity; other open contacts are free (a quasi-shock
    // would remove the approach velocity before the impact). A contact that closes only because of
    // another impact of this step is kept from closing, and rebounds in the next step.
    let un = contact.normal.dot(before);
    let first = contact.closing && !contact.later && un < 0.0;
    let impact = gap <= 0.0 || first;
    if friction.e_n > 0.0 {
        if !impact {
            if !contact.closing {
                form.shift_n = f64::INFINITY;
            }
        } else if un < 0.0 {
            // Restitution replaces the gap and its correction. Where the surface bends towards the
            // body, the body does not leave more slowly than along the surface.
            let of_gap = if gap > 0.0 {
                gap
            } else {
                info.correction * gap
            };
            let bends = form.shift_n - of_gap / info.h;
            form.shift_n = bends.min(friction.e_n * un);
        }
    }
    if impact && friction.e_t > 0.0 {
        form.shift_t = S::tangential(&contact.normal, before) * friction.e_t;
    }
    friction.e_n > 0.0 && contact.closing && !impact
}
