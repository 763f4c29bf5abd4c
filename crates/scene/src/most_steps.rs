//! Largest number of steps of a run.

use super::case::Case;
use super::phases::groups;
use fretwork_core::step::control::Until;

/// Returns the largest number of steps of a run: to the end of its phases where all of them have
/// one, at most to `time.end`.
pub fn most_steps(case: &Case) -> u64 {
    let whole = (case.time.end / case.time.step - 1e-6).ceil().max(1.0) as u64;
    steps_of_phases(case).map_or(whole, |steps| steps.min(whole))
}

/// Returns whether a run may end earlier, since a phase ends when the grains are at rest.
pub fn may_end_earlier(case: &Case) -> bool {
    let at_rest = |until: &Until| matches!(until, Until::AtRest { .. });
    case.phases
        .iter()
        .any(|p| p.until.as_ref().is_some_and(at_rest))
}

/// Returns the number of steps to the latest end of the last phase; `None` if a phase may last to
/// the end of the run. A phase has a whole number of steps, at least one.
fn steps_of_phases(case: &Case) -> Option<u64> {
    if case.phases.is_empty() {
        return None;
    }
    let whole = |time: f64| (time / case.time.step).round().max(0.0) as u64;
    let mut steps = 0u64;
    for (group, times) in groups(case) {
        for _ in 0..times {
            for phase in &case.phases[group.clone()] {
                let own = match phase.until.as_ref()? {
                    Until::Time(at) => whole(*at).saturating_sub(steps),
                    Until::After(duration) => whole(*duration),
                    Until::Steps(steps) => *steps,
                    Until::AtRest { at_most, .. } => whole((*at_most)?),
                };
                steps = steps.saturating_add(own.max(1));
            }
        }
    }
    Some(steps)
}

#[cfg(test)]
mod tests {
    use super::most_steps;
    use crate::source::Source;

    #[test]
    fn phases_bound_the_number_of_steps() {
        let steps = |phases: &str| {
            let text = format!(
                r#"(name: "a", dimension: 2, time: (step: 0.1, end: 10.0), materials: {{}}, interfaces: [], phases: [{phases}])"#
            );
            most_steps(&Source::from_text("case", &text).parse().unwrap())
        };
        assert_eq!(steps(""), 100);
        assert_eq!(
            steps(r#"(name: "a", until: After(1.0)), (name: "b", until: Steps(5))"#),
            15
        );
        assert_eq!(steps(r#"(name: "a", until: After(1.0)), (name: "b")"#), 100);
        let taps = r#"(name: "fill", until: Time(1.0)), (name: "a", until: After(0.5)),
            (name: "b", until: AtRest(share: 1e-3, held: 0.1, at_most: 0.5), repeat: (from: "a", times: 3))"#;
        assert_eq!(steps(taps), 40);
        assert_eq!(
            steps(r#"(name: "a", until: AtRest(share: 1e-3, held: 0.1))"#),
            100
        );
        assert_eq!(
            steps(r#"(name: "a", until: Time(2.0)), (name: "b", until: After(90.0))"#),
            100
        );
        // A phase has at least one step, even if its end time has passed.
        assert_eq!(
            steps(r#"(name: "a", until: After(0.03), repeat: (times: 20))"#),
            20
        );
        assert_eq!(
            steps(r#"(name: "a", until: Time(0.5), repeat: (times: 3))"#),
            7
        );
    }
}
