//! Attraction that depends on the gap, for the gaps that a contact passes in the step.
//!
//! Over a step in which the gap at detection g changes by x until the next detection, the
//! attraction is G(x): its mean over the gaps passed from the start of the step to its end, g -
//! (1 - theta) h u^- to g + theta x, which does the work of its potential for any step; or its
//! value at g + x where that is larger. The latter is a state of equilibrium on the branch on which
//! attraction grows with the gap, as on a neck before pull-off; it dissipates a little energy
//! there, while the mean would oscillate about that state.
//!
//! A solve with the attraction R found x_s. A contact of the effective mass m would be at x under
//! R(x) = R + (x_s - x) m/h^2. The step ends at the first x at which G(x) holds the contact, or, if
//! there is none, at x_s or beyond. There the attraction is linearised by its value and, where it
//! grows with the gap, by its slope, which is the single-valued part b_n of the standard form.

use super::law_step::law_step;
use crate::geometry::space::{Space, VectorLike};
use crate::laws::LawError;
use crate::laws::StepInfo;
use crate::solve::form::{ContactForm, Elastic};
use crate::step::Simulation;

/// The gaps at which an attraction is evaluated: powers of two of the distance from the smallest
/// gap, and fractions of each.
const OCTAVES: usize = 18;
const PARTS: usize = 8;
/// Number of nodes at negative gaps, where bodies overlap.
const BELOW: usize = 4;
/// Difference of attractions, relative to the load of a contact, that is negligible.
const NO_DIFFERENCE: f64 = 1e-4;
/// Share of the load of all contacts below which an attraction keeps its value at detection.
const NEGLIGIBLE: f64 = 1e-6;

/// An attraction linearised at a change of the gap x (m): force (N), and slope (N/m), which is not
/// negative.
#[derive(Clone, Copy, Debug, Default)]
struct LinearAttraction {
    x: f64,
    force: f64,
    slope: f64,
}

impl LinearAttraction {
    fn at(&self, x: f64) -> f64 {
        self.force + self.slope * (x - self.x)
    }
}

/// A contact that passes gaps with different attraction.
#[derive(Clone, Copy, Debug)]
struct AttractedContact {
    at: usize,
    /// Parts of the form other than the attraction: tension (N s), and the shift without the
    /// contribution of a tension (m/s).
    tension: f64,
    shift: f64,
    /// Attraction at the gap of detection (N).
    start: f64,
    linear: LinearAttraction,
}

impl AttractedContact {
    /// Writes the linearised attraction into the form.
    fn apply<S: Space>(&self, form: &mut ContactForm<S>, h: f64) {
        let LinearAttraction { x, force, slope } = self.linear;
        let implicit = slope > 0.0;
        if implicit || form.elastic.is_some() {
            let bond = form.elastic.get_or_insert_with(Elastic::none);
            (bond.a_n, bond.b_n) = if implicit {
                (h * (force - slope * x), h * h * slope)
            } else {
                (0.0, 0.0)
            };
        }
        form.tension = self.tension + if implicit { 0.0 } else { h * force };
        form.shift_n = self.shift + form.compliance[0] * form.tension;
    }
}

/// Contacts of one interface: those on which attraction acts, and those whose attraction is
/// linearised.
#[derive(Debug)]
struct AttractionGroup {
    interface: usize,
    members: Vec<usize>,
    pulls: Vec<AttractedContact>,
}

/// Differences between the attractions used and those over the gaps of a solution.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AttractionMismatch {
    /// Largest difference, over the load of its contact plus a hundredth of all load.
    pub worst: f64,
    /// Sum of the differences, and of the loads of all contacts of the scene (N).
    all: f64,
    loads: f64,
}

impl AttractionMismatch {
    /// Returns the sum of the differences over that of the loads of all contacts.
    pub fn share(&self) -> f64 {
        if self.loads > 0.0 {
            self.all / self.loads
        } else {
            0.0
        }
    }
}

/// The iteration of a step.
#[derive(Debug)]
pub(super) struct Attractions {
    groups: Vec<AttractionGroup>,
}

/// Gaps of a contact in a step (m).
#[derive(Clone, Copy, Debug)]
struct GapPath {
    /// Gap at the start of the step, and at detection.
    start: f64,
    gap: f64,
    /// Change until the next detection, and the fraction of it by the end of the step.
    x: f64,
    theta: f64,
}

impl GapPath {
    /// Returns the gaps at the start of the step, at detection, at the next detection, and at the
    /// end of the step.
    fn gaps(&self) -> [f64; 4] {
        let Self {
            start,
            gap,
            x,
            theta,
        } = *self;
        [start, gap, gap + x, gap + theta * x]
    }

    fn bounds(&self) -> [f64; 2] {
        let all = self.gaps();
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        [least, all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Returns the gaps at which to evaluate the attraction, in ascending order: close to each
    /// other where they are small.
    fn nodes(&self) -> Vec<f64> {
        let [low, high] = self.bounds();
        let near = 0f64.clamp(low, high);
        let mut gaps = self.gaps().to_vec();
        gaps.extend([low, high, near]);
        let part = (near - low) / BELOW as f64;
        gaps.extend((1..BELOW).map(|k| low + part * k as f64));
        let least = (high - near) * 0.5f64.powi(OCTAVES as i32);
        for octave in 0..OCTAVES {
            let from = least * 2f64.powi(octave as i32);
            gaps.extend((0..PARTS).map(|k| near + from * (1.0 + k as f64 / PARTS as f64)));
        }
        gaps.retain(|g| (low..=high).contains(g));
        gaps.sort_unstable_by(f64::total_cmp);
        gaps.dedup();
        gaps
    }
}

/// The attraction over the gaps of a path, linear between nodes.
struct PathAttraction {
    path: GapPath,
    gaps: Vec<f64>,
    force: Vec<f64>,
    /// Integral of the force over the gap, up to each node (J).
    work: Vec<f64>,
}

impl PathAttraction {
    fn of(path: GapPath, gaps: &[f64], force: &[f64]) -> Self {
        let mut work = vec![0.0; gaps.len()];
        for k in 1..gaps.len() {
            work[k] = work[k - 1] + 0.5 * (force[k] + force[k - 1]) * (gaps[k] - gaps[k - 1]);
        }
        Self {
            path,
            gaps: gaps.to_vec(),
            force: force.to_vec(),
            work,
        }
    }

    /// Returns the force at a gap, and its integral up to that gap.
    fn at(&self, gap: f64) -> [f64; 2] {
        let last = self.gaps.len() - 1;
        if last == 0 {
            return [self.force[0], 0.0];
        }
        let k = self.gaps.partition_point(|g| *g <= gap).clamp(1, last);
        let (a, by) = (self.gaps[k - 1], gap - self.gaps[k - 1]);
        let slope = (self.force[k] - self.force[k - 1]) / (self.gaps[k] - a);
        let force = self.force[k - 1];
        [
            force + slope * by,
            self.work[k - 1] + by * (force + 0.5 * slope * by),
        ]
    }

    /// Returns G(x).
    fn given(&self, x: f64) -> f64 {
        let GapPath {
            start, gap, theta, ..
        } = self.path;
        let end = self.at(gap + x)[0];
        let passed = gap - start + theta * x;
        if passed == 0.0 {
            return end;
        }
        let mean = (self.at(gap + theta * x)[1] - self.at(start)[1]) / passed;
        if passed > 0.0 {
            end.max(mean)
        } else {
            end.min(mean)
        }
    }

    /// Returns the changes of the gap from zero to x_s at nodes, in the order passed.
    fn changes(&self) -> Vec<f64> {
        let GapPath { gap, x, .. } = self.path;
        let within = |c: &f64| *c != 0.0 && (0.0..1.0).contains(&(c / x));
        let mut all: Vec<f64> = self.gaps.iter().map(|g| g - gap).filter(within).collect();
        if x < 0.0 {
            all.reverse();
        }
        all.insert(0, 0.0);
        if x != 0.0 {
            all.push(x);
        }
        all
    }

    /// Returns where to linearise, see the module, for `needed` R(x), and whether that is before
    /// x_s, by more than a force `margin`.
    fn first_hold(&self, needed: impl Fn(f64) -> f64, margin: f64) -> (LinearAttraction, bool) {
        let nodes = self.changes();
        let given: Vec<f64> = nodes.iter().map(|x| self.given(*x)).collect();
        let last = nodes.len() - 1;
        if last == 0 {
            let force = given[0];
            return (
                LinearAttraction {
                    force,
                    ..LinearAttraction::default()
                },
                false,
            );
        }
        let excess = |k: usize| (given[k] - needed(nodes[k])) * nodes[last].signum();
        let before_end = (1..last).any(|k| excess(k) > margin);
        let k = (1..=last).find(|k| excess(*k) >= 0.0).unwrap_or(last);
        let slope = (given[k] - given[k - 1]) / (nodes[k] - nodes[k - 1]);
        let (before, here) = (excess(k - 1), excess(k));
        let share = if here > 0.0 && before < 0.0 {
            before / (before - here)
        } else {
            1.0
        };
        let linear = LinearAttraction {
            x: nodes[k - 1] + share * (nodes[k] - nodes[k - 1]),
            force: given[k - 1] + share * (given[k] - given[k - 1]),
            slope: slope.max(0.0),
        };
        (linear, before_end)
    }
}

/// A contact that may pass gaps with different attraction.
struct MovedContact {
    at: usize,
    path: GapPath,
    pull: Option<AttractedContact>,
}

/// Finds the contacts on which an attraction acts.
pub(super) fn begin_attractions<S: Space>(s: &Simulation<S>) -> Attractions {
    let attracted = s.workspace.evaluator.attracted(&s.laws);
    let group = |(interface, members)| AttractionGroup {
        interface,
        members,
        pulls: Vec::new(),
    };
    Attractions {
        groups: attracted.into_iter().map(group).collect(),
    }
}

/// Compares the attraction of a solve with that over the gaps of its solution. Where one differs by
/// more than the tolerance, attractions are linearised again.
pub(super) fn compare_attractions<S: Space>(
    s: &mut Simulation<S>,
    attractions: &mut Attractions,
    tolerance: f64,
    info: &StepInfo,
) -> Result<AttractionMismatch, LawError> {
    let mut differences = AttractionMismatch::default();
    if !attractions.groups.is_empty() {
        // These are the loads of this solve, since the forms change below.
        let contacts = 0..s.workspace.solved.contact_steps.len();
        let loads = contacts.map(|at| load(s, at) / info.h);
        differences.loads = loads.sum();
    }
    for group in &mut attractions.groups {
        compare_attraction(s, group, tolerance, &mut differences, info)?;
    }
    Ok(differences)
}

/// Returns the load of a contact in a step, or its attraction if that is larger (N s).
fn load<S: Space>(s: &Simulation<S>, at: usize) -> f64 {
    let carried = s.workspace.solved.contact_steps[at].solution.unilateral_n;
    s.workspace.forms[at].tension.max(carried.abs())
}

/// Returns the contacts of a group that pass gaps where attraction may change, and the load of all
/// (N s).
fn moved<S: Space>(
    s: &Simulation<S>,
    group: &AttractionGroup,
    info: &StepInfo,
) -> (Vec<MovedContact>, f64) {
    let (workspace, contacts) = (&s.workspace, &s.state.network.contacts);
    let mut moved = Vec::new();
    let mut whole = 0.0;
    let mut pulls = group.pulls.iter().peekable();
    for at in &group.members {
        let contact = &contacts[*at];
        let pull = pulls.next_if(|p| p.at == *at).copied();
        let solved = &workspace.solved;
        let (gap, n) = (contact.gap, &contact.normal);
        let path = GapPath {
            start: gap - (1.0 - info.theta) * info.h * n.dot(&solved.before.relative[*at]),
            gap,
            x: info.h * n.dot(&solved.after[*at]),
            theta: info.theta,
        };
        whole += load(s, *at);
        let [low, high] = path.bounds();
        if pull.is_some() || (high > low && high > 0.0) {
            moved.push(MovedContact {
                at: *at,
                path,
                pull,
            });
        }
    }
    (moved, whole)
}

fn compare_attraction<S: Space>(
    s: &mut Simulation<S>,
    group: &mut AttractionGroup,
    tolerance: f64,
    differences: &mut AttractionMismatch,
    info: &StepInfo,
) -> Result<(), LawError> {
    let h = info.h;
    let (mut moved, whole) = moved(s, group, info);
    // Contacts that are not linearised yet, and pass one attraction only, are not changed.
    let unknown = moved.iter().filter(|m| m.pull.is_none());
    let (mut places, mut gaps) = (Vec::new(), Vec::new());
    for m in unknown {
        let [start, gap, next, _] = m.path.gaps();
        places.extend([m.at; 3]);
        gaps.extend([gap, start, next]);
    }
    let force = attraction_at(s, group, &places, &gaps, info)?;
    let mut found = force.chunks_exact(3);
    moved.retain_mut(|m| {
        if m.pull.is_some() {
            return true;
        }
        let Some([here, start, next]) = found.next() else {
            return false;
        };
        let form = &s.workspace.forms[m.at];
        m.pull = Some(AttractedContact {
            at: m.at,
            tension: form.tension - h * here,
            shift: form.shift_n - form.compliance[0] * form.tension,
            start: *here,
            linear: LinearAttraction {
                force: *here,
                ..LinearAttraction::default()
            },
        });
        let most = here.max(*start).max(*next);
        let load = most + 0.01 * whole / h;
        let differs = |f: &f64| (*f - here).abs() > NO_DIFFERENCE * load;
        h * most > NEGLIGIBLE * whole && (differs(start) || differs(next))
    });
    let (mut places, mut gaps, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
    for m in &moved {
        let first = gaps.len();
        gaps.extend(m.path.nodes());
        places.resize(gaps.len(), m.at);
        ranges.push(first..gaps.len());
    }
    let force = attraction_at(s, group, &places, &gaps, info)?;
    let (mut differs, mut next) = (0.0f64, Vec::with_capacity(moved.len()));
    for (m, range) in moved.iter().zip(ranges) {
        let Some(mut pull) = m.pull else { continue };
        let passed = PathAttraction::of(m.path, &gaps[range.clone()], &force[range]);
        let x = m.path.x;
        let (used, given) = (pull.linear.at(x), passed.given(x));
        let own = used.abs().max(pull.start).max(given);
        let inertia = inertia_of(s, m.at) / (h * h);
        let needed = |here: f64| used + (x - here) * inertia;
        // A linearised attraction is not a tension of the form.
        differences.loads += (own - load(s, m.at) / h).max(0.0);
        let load = own + 0.01 * whole / h;
        let (linear, early) = passed.first_hold(needed, 2.0 * tolerance.min(1.0) * load);
        pull.linear = linear;
        next.push(pull);
        if load > 0.0 {
            let difference = (given - used).abs();
            differs = differs.max(difference / load);
            differences.all += difference;
            if early && tolerance < 1.0 {
                differs = differs.max(2.0 * tolerance);
            }
        }
    }
    differences.worst = differences.worst.max(differs);
    if differs <= tolerance {
        return Ok(());
    }
    for pull in next {
        pull.apply(&mut s.workspace.forms[pull.at], h);
        match group.pulls.binary_search_by_key(&pull.at, |p| p.at) {
            Ok(k) => group.pulls[k] = pull,
            Err(k) => group.pulls.insert(k, pull),
        }
    }
    Ok(())
}

fn attraction_at<S: Space>(
    s: &mut Simulation<S>,
    group: &AttractionGroup,
    places: &[usize],
    gaps: &[f64],
    info: &StepInfo,
) -> Result<Vec<f64>, LawError> {
    if places.is_empty() {
        return Ok(Vec::new());
    }
    let (evaluator, mut step) = law_step(s, info);
    evaluator.attraction_at(&mut step, group.interface, places, gaps)
}

/// Returns a lower bound of the effective mass of a contact along its normal (kg; kg/m in 2D): zero
/// where a body deforms, since only a solve gives its response.
fn inertia_of<S: Space>(s: &Simulation<S>, at: usize) -> f64 {
    let (bodies, contact) = (&s.state.bodies, &s.state.network.contacts[at]);
    let deforms = |b: &u32| bodies.carrier(*b as usize).is_some();
    if contact.bodies.iter().any(deforms) {
        return 0.0;
    }
    contact.effective_mass(bodies)
}

/// Writes attractions as tension alone, in forms and solutions.
pub(super) fn settle_attractions<S: Space>(
    s: &mut Simulation<S>,
    attractions: Attractions,
    h: f64,
) {
    for pull in attractions.groups.iter().flat_map(|group| &group.pulls) {
        let form = &mut s.workspace.forms[pull.at];
        let un = form.normal.dot(&s.workspace.solved.after[pull.at]);
        let step = &mut s.workspace.solved.contact_steps[pull.at];
        if pull.linear.slope > 0.0 {
            let force = h * pull.linear.at(h * un);
            step.solution.unilateral_n -= force;
            form.tension += force;
            form.shift_n += form.compliance[0] * force;
        }
        form.elastic = None;
        step.adheres = form.tension > 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passed(path: GapPath, force: impl Fn(f64) -> f64) -> PathAttraction {
        let gaps = path.nodes();
        let force: Vec<f64> = gaps.iter().map(|g| force(*g)).collect();
        PathAttraction::of(path, &gaps, &force)
    }

    /// The mean over the gaps passed has the work of the potential, for any ratio of the distance
    /// to the range.
    #[test]
    fn the_mean_does_the_work_of_the_potential() {
        for (start, gap, x) in [
            (0.0, 0.5, 1.0),
            (0.0, 500.0, 1e3),
            (0.5, 0.5, 2.0),
            (-0.2, 0.5, 1.4),
            (3.0, 2.0, -2.0),
        ] {
            let path = GapPath {
                start,
                gap,
                x,
                theta: 0.5,
            };
            let end = gap + 0.5 * x;
            let passed = passed(path, |g| 3.0 * (-g.max(0.0)).exp());
            let potential = |g: f64| 3.0 * g.min(0.0) - 3.0 * (-g.max(0.0)).exp();
            let work = potential(end) - potential(start);
            let given = passed.given(x) * (end - start);
            assert!((given / work - 1.0).abs() < 3e-3, "{start} {gap} {x}");
        }
    }

    /// F = 1 + x up to 2 and zero beyond holds loads up to 2, at x = P - 1, for any mass.
    #[test]
    fn the_first_state_that_holds_is_found() {
        let path = GapPath {
            start: 0.0,
            gap: 0.0,
            x: 100.0,
            theta: 0.5,
        };
        let passed = passed(path, |g| if g <= 1.0 { 1.0 + g } else { 0.0 });
        for load in [1.1, 1.5, 1.8] {
            let (hold, early) = passed.first_hold(|_| load, 1e-4);
            assert!(early && (hold.x - (load - 1.0)).abs() < 1e-9, "{hold:?}");
            assert!((hold.slope - 1.0).abs() < 1e-9);
        }
        let (gone, early) = passed.first_hold(|_| 2.1, 1e-4);
        assert!(!early && gone.x == 100.0 && gone.force < 0.04);
    }
}
