//! Results of a run on its solver.

use crate::quantity::{Findings, Role, Topic};
use crate::solving::SolverSummary;
use crate::warning::Warning;

/// Overlap of rigid contacts, over the radius of the smaller grain, above which a warning is given.
const OVERLAP: f64 = 1e-2;
/// Residual velocities, relative to those of the contacts, below which they are not reported.
const LOOSE: f64 = 1e-3;
/// Mean share of the friction, and largest share of an attraction, by which steps may differ from
/// their laws.
const UNMET_FRICTION: f64 = 2e-3;
const UNMET_ATTRACTION: f64 = 2e-2;

impl SolverSummary {
    /// Adds the numbers of the solver, and the sentences of the terminal.
    pub(super) fn report(&self, found: &mut Findings) {
        found.begin(Topic::Run, Role::Diagnostic);
        found.part("solver", self, "the solver");
        for (name, label, text) in self.sentences() {
            found.edit(&format!("solver.{name}"), |q| {
                q.sentence(label, text);
            });
        }
    }

    fn sentences(&self) -> Vec<(&'static str, &'static str, String)> {
        let mut out = vec![(
            "iterations_mean",
            "solver",
            format!(
                "{:.1} iterations per step, {} at most; error at most {:.2e} (tolerance {:.0e})",
                self.iterations_mean, self.iterations_max, self.error_max, self.tolerance
            ),
        )];
        let e = &self.error_parts;
        if e.slip_energy > 0.0 {
            let text = format!(
                "force balance {:.1e} of the work, velocities {:.1e}, contact law {:.1e} of the heat of slip; means over slip",
                e.force_balance, e.velocity, e.contact_law
            );
            out.push(("error_parts.slip_energy", "parts of the error", text));
        }
        let used = self.steps_by_method.iter();
        let used: Vec<String> = used
            .map(|(name, n)| format!("{name} ended {n} steps"))
            .collect();
        let text = format!("{}: {}", self.method, used.join(", "));
        out.push(("method", "method", text));
        if self.method == "auto" {
            out.push(("why", "why", self.why.clone()));
        }
        if self.projected_steps > 0 {
            let text = format!(
                "{} steps removed overlaps: up to {:.2e} of a body's length before, {:.2e} after",
                self.projected_steps, self.overlap_before, self.overlap_after
            );
            out.push(("projected_steps", "projection", text));
        }
        if self.coupling_iterations_mean > 0.0 {
            let text = format!(
                "{:.1} solves per step for the damage coupling",
                self.coupling_iterations_mean
            );
            out.push(("coupling_iterations_mean", "coupling", text));
        }
        if self.laws.solves_mean > 1.0 {
            let text = format!(
                "{:.1} solves per step for friction that depends on velocity or attraction that depends on the gap",
                self.laws.solves_mean
            );
            out.push(("laws.solves_mean", "laws", text));
        }
        out
    }

    /// Returns the warnings on the solutions of a run with this number of steps; `possible` unless
    /// imposed motions were impossible.
    pub(super) fn warnings(&self, steps: u64, possible: bool) -> Vec<Warning> {
        let reasons = [
            // A smaller step does not help against an impossible motion.
            ("OVERLAP", self.overlap().filter(|_| possible)),
            ("LOOSE VELOCITIES", self.loose_velocities()),
            ("NOT COUPLED", self.uncoupled(steps)),
            ("LAWS NOT MET", self.unmet()),
        ];
        let reasons = reasons.into_iter();
        let reasons = reasons.filter_map(|(of, text)| Some(Warning::serious(of, text?)));
        let several = self.several_solutions();
        let several = several.map(|text| Warning::note("NOT UNIQUE", text));
        reasons.chain(several).collect()
    }

    /// Returns the warning about overlaps of rigid bodies.
    fn overlap(&self) -> Option<String> {
        (self.overlap_max > OVERLAP).then(|| {
            let left = if self.overlap_after > OVERLAP {
                format!(", {:.1e} after they were taken out", self.overlap_after)
            } else {
                String::new()
            };
            format!(
                "rigid bodies overlap by up to {:.1e} of the radius of the smaller one{left}; take a smaller time.step or solver.tolerance, or \
                 take overlaps out by `solver: (projection: 0.005)`",
                self.overlap_max
            )
        })
    }

    /// Returns a warning for steps that reached their tolerance, but whose residuals exceed the
    /// slip that they should resolve.
    fn loose_velocities(&self) -> Option<String> {
        let parts = &self.error_parts;
        let loose = parts.contact_law > 1.0 && parts.velocity > LOOSE;
        // Where steps missed the tolerance, NOT CONVERGED reports it.
        (self.unconverged_steps == 0 && loose).then(|| {
            format!(
                "the residuals of the steps make {:.1} times the heat of slip: slow sliding, and with it friction, may be wrong although \
                 the steps reached solver.tolerance; take a smaller one, or compliant contacts \
                 (docs/compliant.md, docs/dev/sensitivity.md)",
                parts.contact_law
            )
        })
    }

    fn uncoupled(&self, of: u64) -> Option<String> {
        let steps = self.uncoupled_steps;
        (steps > 0).then(|| {
            format!(
                "{steps} of {of} steps did not converge in the damage coupling; raise max_iterations of `coupling: Implicit(tolerance: ..., max_iterations: ...)` or take a smaller time.step"
            )
        })
    }

    fn unmet(&self) -> Option<String> {
        let (friction, attraction) = (self.laws.friction_mean, self.laws.attraction_max);
        let mut parts = Vec::new();
        if friction > UNMET_FRICTION {
            parts.push(format!(
                "friction differs from that of its law at the velocity of sliding by {:.2} % on average: contacts jump between stick and slip within \
                 a step; take a smaller time.step, or a law that falls over a wider range of velocities",
                1e2 * friction
            ));
        }
        if attraction > UNMET_ATTRACTION {
            parts.push(format!(
                "attractions differ from those of their laws over the gaps of a step by up to {:.1} % of the load; take a smaller time.step or solver.tolerance",
                1e2 * attraction
            ));
        }
        (!parts.is_empty()).then(|| parts.join("; "))
    }

    /// Returns a warning for steps in which another solution was found, with the number of those in
    /// which it was not searched. The latter alone gives no warning, since all dense flows have
    /// such steps, except where only first bodies may hold a grain.
    fn several_solutions(&self) -> Option<String> {
        let [several, not_searched, pinched] = [
            self.several_steps,
            self.not_searched_steps,
            self.pinched_steps,
        ];
        let found = (several > 0).then(|| {
            format!(
                "in {several} steps another solution was found, in which loaded contacts slide that hold in the other, since more contacts carry a load than \
                 its balance determines; the one of less energy was kept, others may exist"
            )
        });
        let left = (several > 0 && not_searched > 0 || pinched > 0).then(|| {
            let of_grains = if pinched > 0 {
                format!(", in {pinched} of them one of a grain between first bodies, which might hold it")
            } else {
                String::new()
            };
            format!(
                "in {not_searched} steps a loaded contact began to slide among more than 64 connected contacts, whose impulses may outnumber the freedoms of \
                 their bodies{of_grains}; no other solution was sought there"
            )
        });
        let told: Vec<String> = found.into_iter().chain(left).collect();
        (!told.is_empty()).then(|| {
            format!(
                "{}; compliant contacts (docs/compliant.md) have one (docs/solvers/several_solutions.md)",
                told.join("; ")
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_run(change: impl FnOnce(&mut SolverSummary)) -> Vec<Warning> {
        let mut solver = SolverSummary::default();
        change(&mut solver);
        solver.warnings(600, true)
    }

    #[test]
    fn a_sound_run_has_none() {
        assert_eq!(of_run(|_| ()), []);
    }

    #[test]
    fn overlaps_and_lost_coupling_are_reasons() {
        let list = of_run(|s| (s.uncoupled_steps, s.overlap_max) = (1, 0.5));
        let of: Vec<&str> = list.iter().map(|w| w.of).collect();
        assert_eq!(of, ["OVERLAP", "NOT COUPLED"]);
        assert!(list[1].text.starts_with("1 of 600 steps"));
        let solver = SolverSummary {
            overlap_max: 0.5,
            ..SolverSummary::default()
        };
        assert_eq!(solver.warnings(600, false), []);
    }

    #[test]
    fn laws_that_steps_did_not_meet_are_a_reason() {
        let of = |friction, attraction| {
            of_run(|s| {
                s.laws.friction_mean = friction;
                s.laws.attraction_max = attraction;
            })
        };
        assert_eq!(of(1e-3, 1e-2), []);
        for (friction, attraction, cure) in [
            (0.03, 0.0, "3.00 % on average"),
            (
                0.0,
                0.2,
                "up to 20.0 % of the load; take a smaller time.step",
            ),
        ] {
            let list = of(friction, attraction);
            assert!(list.len() == 1 && list[0].serious && list[0].of == "LAWS NOT MET");
            assert!(list[0].text.contains(cure), "{}", list[0].text);
        }
    }

    #[test]
    fn loose_velocities_are_a_reason_where_slip_is_outweighed() {
        let parts = |velocity, contact_law| {
            of_run(|s| {
                s.error_parts.velocity = velocity;
                s.error_parts.contact_law = contact_law;
            })
        };
        assert_eq!(parts(1e-2, 0.3), []);
        // At rest both parts are small, for any ratio.
        assert_eq!(parts(1e-7, 4.0), []);
        let list = parts(3e-2, 1.8);
        assert!(list.len() == 1 && list[0].serious && list[0].of == "LOOSE VELOCITIES");
    }

    /// Steps in which no other solution was searched give no warning alone, as in dense flows,
    /// except where first bodies release grains between them.
    #[test]
    fn several_solutions_are_a_note_and_grains_between_first_bodies_that_let_go() {
        let told = |several: u64, pinched: u64| {
            let list = of_run(|s| {
                s.not_searched_steps = 5;
                (s.several_steps, s.pinched_steps) = (several, pinched);
            });
            assert!(list.iter().all(|w| w.of == "NOT UNIQUE" && !w.serious));
            let text: Vec<String> = list.into_iter().map(|w| w.text).collect();
            text.join("; ")
        };
        assert_eq!(told(0, 0), "");
        let (found, alone, both) = (told(2, 0), told(0, 3), told(2, 3));
        assert!(
            found.contains("in 2 steps another solution") && found.contains("in 5 steps a loaded")
        );
        assert!(!found.contains("between first bodies"));
        assert!(alone.contains("in 3 of them one of a grain between first bodies"));
        assert!(!alone.contains("another solution was found"));
        assert!(both.contains("in 2 steps another solution") && both.contains("in 3 of them"));
    }
}
