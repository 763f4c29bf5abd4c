//! Solvers that support a case, determined before it runs.

use fretwork_core::laws::requirements::{LawRequirements, Requirement};
use fretwork_core::solve::local::solver::Method;
use fretwork_core::solve::{Features, refusal};
use fretwork_core::view::RunView;

/// Whether a solver supports a case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SolverSupport {
    /// The solver supports the case.
    Serves,
    /// The solver may fail in a step: the interface and what it may require.
    May(String),
    /// The solver does not support the case: the interface that it does not support, and why.
    Refuses(String),
}

/// Requirements of the interfaces of a scene, with `None` for a law that failed in its trial call;
/// the run reports that failure.
pub struct SolverRequirements(Vec<(String, Option<LawRequirements>)>);

impl SolverRequirements {
    /// Determines the requirements by trial calls of the laws.
    pub fn of(simulation: &dyn RunView) -> Self {
        let pieces = simulation.pieces().into_iter().map(|p| p.size);
        let balls = simulation.balls().into_iter().map(|b| b.radius);
        let radii = balls.chain(pieces);
        let (low, high) = radii.fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
        // The trial radii are two grains of the smallest radius, and the largest grain on a flat
        // body.
        let radii = if high > 0.0 {
            [0.5 * low, high]
        } else {
            [1e-3, 1.0]
        };
        let ask = |law: &fretwork_core::laws::Interface| {
            let requirements = law
                .solver_requirements(simulation.dimension() as u32, &radii)
                .ok();
            (law.name.clone(), requirements)
        };
        Self(simulation.laws().iter().map(ask).collect())
    }

    /// Iterates over names and requirements of the interfaces.
    pub fn each(&self) -> impl Iterator<Item = (&str, Option<&LawRequirements>)> {
        self.0.iter().map(|(name, d)| (name.as_str(), d.as_ref()))
    }

    /// Whether a solver supports the interfaces.
    pub fn support(&self, method: Method) -> SolverSupport {
        let refusal = |rotation, cohesion| {
            let features = Features {
                rotation,
                cohesion,
                ..Features::default()
            };
            refusal(method, &features)
        };
        let mut may = None;
        for (name, requirements) in &self.0 {
            // These are the reason of a refusal, and its certainty.
            let (requirement, reason) = match requirements {
                Some(requirements) => {
                    let (rotation, cohesion) = (requirements.rotation, requirements.cohesion);
                    let turns = refusal(true, false).map_or(Requirement::Never, |_| rotation);
                    let pulls = refusal(false, true).map_or(Requirement::Never, |_| cohesion);
                    let most = turns.max(pulls);
                    (most, refusal(most == turns, most == pulls))
                }
                None => (Requirement::NotObserved, refusal(true, true)),
            };
            let Some(reason) = reason else { continue };
            match requirement {
                Requirement::Never => {}
                Requirement::Always => {
                    return SolverSupport::Refuses(format!("interface `{name}`: {reason}"));
                }
                Requirement::Sometimes => {
                    may = Some(format!(
                        "may be refused, interface `{name}` requires it in some contacts: {reason}"
                    ));
                }
                Requirement::NotObserved => {
                    may = may.or(Some(format!(
                        "may be refused, the laws of interface `{name}` decide at run time and did not require it in the sampled contacts: {reason}"
                    )));
                }
            }
        }
        may.map_or(SolverSupport::Serves, SolverSupport::May)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn support(rotation: Requirement, cohesion: Requirement, method: Method) -> SolverSupport {
        let requirements = LawRequirements {
            rotation,
            cohesion,
            ..LawRequirements::default()
        };
        SolverRequirements(vec![("a".into(), Some(requirements))]).support(method)
    }

    #[test]
    fn refuses_what_is_certain_and_warns_of_the_rest() {
        use Requirement::{Always, Never, NotObserved, Sometimes};
        for method in Method::ALL.iter().copied() {
            assert_eq!(support(Never, Never, method), SolverSupport::Serves);
            let other = !matches!(method, Method::Newton | Method::Interior);
            assert_eq!(
                support(Always, Always, method) == SolverSupport::Serves,
                other
            );
        }
        assert_eq!(
            support(Never, Always, Method::Newton),
            SolverSupport::Serves
        );
        let text = |s: SolverSupport| match s {
            SolverSupport::Serves => String::new(),
            SolverSupport::May(t) | SolverSupport::Refuses(t) => t,
        };
        assert!(text(support(Sometimes, Never, Method::Newton)).contains("some contacts"));
        assert!(text(support(NotObserved, Never, Method::Newton)).contains("sampled contacts"));
        let both = support(NotObserved, Always, Method::Interior);
        assert!(matches!(both, SolverSupport::Refuses(t) if t.contains("cohesion")));
        let failed = SolverRequirements(vec![("a".into(), None)]);
        assert!(matches!(
            failed.support(Method::Newton),
            SolverSupport::May(_)
        ));
        assert_eq!(failed.support(Method::Pg), SolverSupport::Serves);
    }
}
