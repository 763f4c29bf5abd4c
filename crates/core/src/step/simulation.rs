//! The simulation and its time step, in the order of the data flow.

use super::StepError;
use super::answers::Solved;
use super::coupling::{Coupling, CouplingReport, Progress};
use super::motion::{self, StepStart};
use super::process::Process;
use super::projection::Projected;
use crate::bodies::{Bodies, Systems};
use crate::contact::detect::{self, LawTable, detect};
use crate::contact::{Contact, Network};
use crate::energy::Energy;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};
use crate::laws::columns::StepInfo;
use crate::laws::pass::LawEvaluator;
use crate::laws::{ContactStep, Interface, LawError, Totals};
use crate::solve::local::solver::Method;
use crate::solve::{self, ContactForm, MomentForm, Problem};
use crate::wear::{Scar, WornThrough};
use std::time::{Duration, Instant};

/// The time scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Step (s).
    pub h: f64,
    /// Theta in \[1/2, 1\]: 1/2 conserves energy, 1 damps.
    pub theta: f64,
}

/// Wall-clock time of the parts of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timing {
    /// Detection, including the projection of penetrations.
    pub detect: Duration,
    /// Laws: prepare and commit.
    pub laws: Duration,
    /// The solver.
    pub solve: Duration,
}

/// Report of one step.
#[derive(Clone, Debug, Default)]
pub struct StepReport {
    /// The solver's report.
    pub solver: solve::Report,
    /// Report of the coupling of damage and opening.
    pub coupling: CouplingReport,
    /// Sums over contacts.
    pub totals: Totals,
    /// Number of contacts that carry an impulse.
    pub active: usize,
    /// Result of the projection of penetrations, if there was one.
    pub projected: Option<Projected>,
    /// Wall-clock time.
    pub timing: Timing,
}

/// A scene that is advanced in time.
#[derive(Debug)]
pub struct Simulation<S: Space> {
    /// Grains and first bodies.
    pub bodies: Bodies<S>,
    /// Bodies that are more than rigid; see [`Simulation::add_system`].
    pub systems: Systems<S>,
    /// What can touch.
    pub shapes: Shapes<S>,
    /// Interface laws.
    pub laws: Vec<Interface>,
    /// Interface law of each pair of materials.
    pub table: LawTable,
    /// The contacts.
    pub network: Network<S>,
    /// Acceleration of gravity (m/s^2).
    pub gravity: S::Vector,
    /// The time scheme.
    pub scheme: Scheme,
    /// The solver's options.
    pub solver: solve::Options,
    /// Time at the end of the last step (s).
    pub time: f64,
    /// Steps completed.
    pub steps: u64,
    /// Fraction of a penetration removed per step, 0 to 1: `solver.correction` of a case.
    pub correction: f64,
    /// Penetration, as a fraction of the smaller body's length, beyond which bodies are moved apart; 0 for
    /// never. See [`super::projection`].
    pub projection: f64,
    /// Work of projections on driven bodies against imposed forces (J).
    pub lifted: f64,
    /// Coupling of damage and opening within a step.
    pub coupling: Coupling,
    /// The energy ledger.
    pub energy: Energy,
    /// Contact impulses and moments on the driven bodies in the last step, in their order.
    pub received: Vec<(S::Vector, S::Spin)>,
    /// Velocities and spins of the driven bodies at the start of the last step, after the jumps of imposed motion.
    pub started: Vec<(S::Vector, S::Spin)>,
    /// Scars of the surfaces that wear.
    pub scars: Vec<Scar<S>>,
    /// The first surface that was worn through, if any.
    pub worn_through: Option<WornThrough>,
    /// What grains and contacts carry for output, by name.
    pub fields: super::fields::Fields<S>,
    /// What acts from outside and changes in time.
    pub control: super::control::Control<S>,
    /// What acts at the named moments of a step, in this order.
    pub(super) processes: Vec<Box<dyn Process<S>>>,
    /// Whether the processes have acted on the state since the last step.
    pub(super) settled: bool,
    /// What the sum of the steps in `time` has too much by rounding (s).
    pub(super) time_excess: f64,
    pub(super) habit: solve::AutoState,
    pub(super) passes: LawEvaluator,
    pub(super) workspace: Workspace<S>,
}

/// What a step makes for itself and throws away; its memory is kept from step to step, nothing else.
#[derive(Debug)]
pub(super) struct Workspace<S: Space> {
    /// The contact problem.
    pub problem: Problem<S>,
    /// Its contacts in the standard form, in the network's order.
    pub forms: Vec<ContactForm<S>>,
    /// Those that resist rotation.
    pub moments: Vec<MomentForm<S>>,
    /// What contacts did in the step.
    pub solved: Solved<S>,
    /// Whether a process has given a body an impulse in the step, see [`Simulation::apply_impulse`].
    pub pushed: bool,
}

impl<S: Space> Default for Workspace<S> {
    fn default() -> Self {
        Self {
            problem: Problem::default(),
            forms: Vec::new(),
            moments: Vec::new(),
            solved: Solved::default(),
            pushed: false,
        }
    }
}

impl<S: Space> Simulation<S> {
    /// Bytes per contact in addition to the solver's rows and the bond: this step's and the last step's
    /// contact, its pair in the neighbour list, its form, and its results.
    pub const BYTES_A_CONTACT: usize = 2 * size_of::<Contact<S>>()
        + size_of::<(u32, u32)>()
        + size_of::<ContactForm<S>>()
        + size_of::<ContactStep<S>>()
        + size_of::<S::Vector>();

    /// Builds a scene at rest at time zero.
    pub fn new(
        bodies: Bodies<S>,
        shapes: Shapes<S>,
        laws: Vec<Interface>,
        table: LawTable,
        alert: f64,
        skin: f64,
    ) -> Self {
        let variables: Vec<usize> = laws.iter().map(Interface::variables).collect();
        let mut network = Network::new(alert, skin, &variables);
        for (memory, law) in network.memory.iter_mut().zip(&laws) {
            memory.rotates = law.rotates();
        }
        network.fast = detect::fast_motion(&shapes, alert);
        let kinetic = bodies.kinetic_energy();
        let received = vec![(S::Vector::zero(), S::Spin::zero()); bodies.driven.len()];
        let mut simulation = Self {
            bodies,
            systems: Systems::default(),
            shapes,
            laws,
            table,
            network,
            gravity: S::Vector::zero(),
            scheme: Scheme {
                h: 1e-3,
                theta: 0.5,
            },
            solver: solve::Options::default(),
            time: 0.0,
            steps: 0,
            correction: 0.0,
            projection: 0.0,
            lifted: 0.0,
            coupling: Coupling::Explicit,
            energy: Energy {
                kinetic,
                initial_kinetic: kinetic,
                ..Energy::default()
            },
            received,
            started: Vec::new(),
            scars: Vec::new(),
            worn_through: None,
            fields: Default::default(),
            control: Default::default(),
            processes: Vec::new(),
            settled: true,
            time_excess: 0.0,
            habit: solve::AutoState::default(),
            passes: LawEvaluator::default(),
            workspace: Workspace::default(),
        };
        simulation.started = simulation.motion_of_driven();
        simulation
    }

    /// See [`Simulation::step`].
    pub(super) fn one_step(&mut self) -> Result<StepReport, StepError> {
        self.between_steps()?;
        self.check_worn_through()?;
        let mut report = StepReport::default();
        let Scheme { h, theta } = self.scheme;
        let info = StepInfo {
            dimension: S::D as u32,
            time: self.time,
            h,
            theta,
        };
        self.network.bond_breaks.clear();
        self.network.bonds_formed.clear();
        let driven = self.motion_of_driven();
        self.begin_motion();
        self.watch_first_move(&driven);
        self.workspace.pushed = false;
        self.act(|process, simulation| process.before_detection(simulation))?;
        self.watch_push();
        let mut start = StepStart::new(&self.bodies);
        let clock = Instant::now();
        motion::advance(&mut self.bodies, (1.0 - theta) * h);
        self.begin_systems((1.0 - theta) * h);
        detect(
            &mut self.network,
            &self.shapes,
            &self.bodies,
            &self.table,
            self.time,
            h,
        );
        report.projected = self.project();
        start.coasted(&self.bodies);
        self.started = start.of_driven(&self.bodies);
        let mut free = motion::free_velocities(&self.bodies, &self.gravity, self.time, h, theta);
        self.free_systems(&mut free);
        self.foresee(&free);
        let remembered = self.passes.remember(&self.laws, &mut self.network, &info);
        remembered.map_err(|e| self.law_error(e))?;
        report.timing.detect = clock.elapsed();

        self.solve(&start, &free, &info, &mut report)?;

        let clock = Instant::now();
        let Solved { sites, turns, .. } = &self.workspace.solved;
        let committed = self
            .passes
            .commit(&self.laws, &mut self.network, sites, turns, &info);
        report.totals = committed.map_err(|e| self.law_error(e))?;
        self.act(|process, simulation| process.after_solve(simulation))?;
        self.network.locate_breaks(&self.bodies);
        report.timing.laws += clock.elapsed();

        self.book(&start, &report.totals);
        motion::advance(&mut self.bodies, theta * h);
        self.systems.carry(&mut self.bodies);
        let sites = self.workspace.solved.sites.iter();
        report.active = sites
            .filter(|s| s.solution.impulse != S::Vector::zero())
            .count();
        self.end_motion();
        self.steps += 1;
        self.finite()?;
        self.watch_rounding();
        self.end_phase();
        self.act(|process, simulation| process.after_move(simulation, &report))?;
        self.settled = false;
        Ok(report)
    }

    /// Prepares and solves the step: once with explicit coupling, otherwise until the damage used in the
    /// impulses is the one that the resulting openings give.
    pub(super) fn couple(
        &mut self,
        start: &StepStart<S>,
        free: &[(S::Vector, S::Spin)],
        info: &StepInfo,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        let mut coupling = Progress::new(&self.coupling);
        loop {
            let clock = Instant::now();
            let prepared = self.passes.prepare(
                &self.laws,
                &self.network,
                &self.workspace.solved.before,
                info,
                &mut self.workspace.forms,
                &mut self.workspace.moments,
            );
            prepared.map_err(|e| self.law_error(e))?;
            report.timing.laws += clock.elapsed();

            let clock = Instant::now();
            self.pose(free);
            self.served()?;
            let solved = solve::solve(
                &mut self.workspace.problem,
                &self.workspace.forms,
                &self.workspace.moments,
                &self.solver,
                &mut self.habit,
            );
            report.solver.add(&solved);
            self.adopt_velocities()?;
            self.adopt_system_velocities()?;
            report.timing.solve += clock.elapsed();

            self.sites();
            self.turns(start);
            let Coupling::Implicit { .. } = self.coupling else {
                return Ok(());
            };
            let clock = Instant::now();
            let Solved { sites, turns, .. } = &self.workspace.solved;
            let change = self
                .passes
                .trial(&self.laws, &mut self.network, sites, turns, info);
            let change = change.map_err(|e| self.law_error(e))?;
            report.timing.laws += clock.elapsed();
            if coupling.ends(change) {
                report.coupling = coupling.report();
                return Ok(());
            }
            self.passes.adopt(&mut self.network);
            for (form, site) in self
                .workspace
                .forms
                .iter_mut()
                .zip(&self.workspace.solved.sites)
            {
                form.impulse = site.solution.impulse;
            }
        }
    }

    /// Checks that the method supports the current forms; some requirements of laws appear only during a
    /// step.
    fn served(&self) -> Result<(), StepError> {
        let turns = |m: &MomentForm<S>| self.network.contacts[m.contact as usize].bodies;
        let moments = self.workspace.moments.iter();
        let carrier = moments
            .flat_map(turns)
            .find_map(|b| self.bodies.carrier(b as usize));
        if let Some(carrier) = carrier {
            let system = self.systems.get(carrier.system as usize);
            return Err(StepError::SystemRotation {
                step: self.steps + 1,
                system: system.map_or_else(String::new, |s| s.name().to_owned()),
            });
        }
        let (method, operator) = (self.solver.method, self.workspace.problem.operator());
        let by_law = matches!(method, Method::Newton | Method::Interior);
        if !by_law && method.operator() <= operator {
            return Ok(());
        }
        let rotation = self
            .workspace
            .moments
            .iter()
            .any(|m| m.rolling > 0.0 || m.spinning > 0.0);
        let features = solve::Features {
            rotation,
            cohesion: self.workspace.forms.iter().any(|f| f.cohesion > 0.0),
            operator,
        };
        match solve::refusal(method, &features) {
            None => Ok(()),
            Some(reason) => Err(StepError::Method {
                step: self.steps + 1,
                method: method.name(),
                reason,
            }),
        }
    }

    /// The problem of the last step solved, in the form of the field's collection; none where a bond,
    /// cohesion, friction against rotation or a dynamical system was at work, which that form does not hold.
    pub fn local_problem(&self) -> Option<solve::local::LocalProblem> {
        solve::choose::coulomb(
            &self.workspace.problem,
            &self.workspace.forms,
            &self.workspace.moments,
        )
    }

    pub(super) fn law_error(&self, source: LawError) -> StepError {
        StepError::Law {
            step: self.steps + 1,
            time: self.time,
            source,
        }
    }

    /// Computes the geometric part of the forms.
    pub(super) fn geometry_of_forms(&mut self, h: f64) {
        let mut forms = std::mem::take(&mut self.workspace.forms);
        forms.clear();
        let contacts = self.network.contacts.iter();
        forms.extend(contacts.map(|contact| ContactForm {
            bodies: contact.bodies,
            normal: contact.normal,
            arms: contact.arms,
            central: contact.central,
            shift_n: self.shift_of_gap(contact, h),
            shift_t: S::Tangent::zero(),
            friction: 0.0,
            tension: 0.0,
            cohesion: 0.0,
            elastic: None,
            impulse: contact.impulse,
        }));
        self.workspace.forms = forms;
    }

    /// Returns the velocity at which a step may close a gap; for a penetration, the (negative) velocity at
    /// which the correction removes its share (m/s).
    pub(super) fn shift_of_gap(&self, contact: &Contact<S>, h: f64) -> f64 {
        let gap = self.network.open_gap(contact);
        if gap > 0.0 {
            gap / h
        } else {
            self.correction * gap / h
        }
    }

    /// Sets up the solver's problem from bodies and contacts.
    fn pose(&mut self, free: &[(S::Vector, S::Spin)]) {
        let (bodies, problem) = (&self.bodies, &mut self.workspace.problem);
        problem.clear();
        for (b, (v, w)) in free.iter().enumerate() {
            problem.push_body(
                *v,
                *w,
                bodies.inverse_mass[b],
                bodies.inverse_tensor(b),
                bodies.length[b],
            );
        }
        if self.systems.is_empty() {
            for form in &self.workspace.forms {
                problem.push(form);
            }
        } else {
            self.pose_with_systems();
        }
        for form in &self.workspace.moments {
            let contact = &self.workspace.forms[form.contact as usize];
            self.workspace.problem.push_moment(form, contact);
        }
    }

    fn adopt_velocities(&mut self) -> Result<(), StepError> {
        for b in 0..self.bodies.len() {
            let (v, w) = self.workspace.problem.velocity(b);
            if !(v.is_finite() && w.is_finite()) {
                return Err(StepError::NotFinite {
                    step: self.steps + 1,
                    time: self.time,
                    body: self.bodies.id[b],
                });
            }
            self.bodies.velocity[b] = v;
            self.bodies.spin[b] = w;
        }
        Ok(())
    }

    /// Ends the step of dynamical systems and books the step in the energy ledger.
    fn book(&mut self, start: &StepStart<S>, totals: &Totals) {
        let mut received = vec![(S::Vector::zero(), S::Spin::zero()); self.bodies.driven.len()];
        let mut place = vec![usize::MAX; self.bodies.len()];
        for (d, driven) in self.bodies.driven.iter().enumerate() {
            place[driven.body as usize] = d;
        }
        for contact in &self.network.contacts {
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let d = place[contact.bodies[side] as usize];
                if d != usize::MAX {
                    let impulse = contact.impulse * sign;
                    received[d].0 += impulse;
                    received[d].1 +=
                        S::moment(&contact.arms[side], &impulse) + contact.moment * sign;
                }
            }
        }
        let Scheme { h, theta } = self.scheme;
        let mut work = start.work(&self.bodies, &received, &self.gravity, self.time, h, theta);
        let (moving, stored) = self.end_systems(theta * h, &mut work);
        let (mut kinetic, mut elastic) =
            (self.bodies.kinetic_energy(), self.network.elastic_energy());
        if !self.systems.is_empty() {
            (kinetic, elastic) = (kinetic + moving, elastic + stored);
        }
        self.energy.book(totals, &work, kinetic, elastic);
        self.received = received;
    }
}
