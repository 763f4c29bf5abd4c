//! Places at which a run repeats a stretch of steps: drawn from its seed, one in each of equal
//! parts of the evaluated time.

use super::change::FEWEST;
use fretwork_scene::case::UncertaintySpec;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Number of steps of a run per step of a stretch: a stretch with all its repetitions costs about
/// ten times its own cost, and they may take at most 5 % of the run.
const STEPS_EACH: u64 = 220;
/// Number of places over which the repetitions are distributed before stretches are made longer,
/// for the interval.
const PLACES: u64 = 4;
/// Longest stretch: by then effects of the change of settings at its start have decayed.
const LONGEST: u64 = 8;
/// Added to the seed of the case, so that places are independent of the random numbers of its
/// grains.
const STREAM: u64 = 0x7265_7065_6174_7321;

/// Number of repeated stretches, and their length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Number of places.
    pub count: usize,
    /// Number of steps of each stretch.
    pub length: u32,
}

/// Plans the repetitions for a run with this number of steps.
///
/// # Errors
/// Returns why there are none.
pub fn plan(spec: &UncertaintySpec, steps: u64) -> Result<Plan, String> {
    if spec.repeats == Some(0) {
        return Err("switched off by `uncertainty: (repeats: 0)`".to_owned());
    }
    let budget = steps / STEPS_EACH;
    let longest = (budget / PLACES).clamp(1, LONGEST) as u32;
    let length = spec.steps.unwrap_or(longest).max(1);
    let affordable = budget / u64::from(length);
    let count = spec.repeats.map_or(affordable, u64::from) as usize;
    if spec.repeats.is_none() && count < FEWEST {
        return Err(format!(
            "too short: in a run of less than {} steps three repeats cost more than 5 %; `uncertainty: (repeats: 3)` has them made \
             nevertheless",
            FEWEST as u64 * u64::from(length) * STEPS_EACH
        ));
    }
    Ok(Plan { count, length })
}

impl Plan {
    /// Returns the numbers of completed steps after which stretches are repeated, in order.
    pub fn draw(&self, seed: u64, from: u64, to: u64) -> Vec<u64> {
        let mut rng = Pcg64::seed_from_u64(seed ^ STREAM);
        let steps = usize::try_from(to.saturating_sub(from)).unwrap_or(usize::MAX);
        let (count, length) = (self.count.min(steps), u64::from(self.length));
        let span = u128::from(to.saturating_sub(from));
        let edge = |k: usize| from + (span * k as u128 / count.max(1) as u128) as u64;
        let mut places: Vec<u64> = (0..count)
            .map(|k| {
                let (low, high) = (edge(k), edge(k + 1).saturating_sub(length));
                low + (rng.random::<f64>() * (high.saturating_sub(low) + 1) as f64) as u64
            })
            .filter(|at| at + length <= to)
            .collect();
        places.dedup();
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_one_in_each_part_and_follow_the_seed() {
        let plan = Plan {
            count: 7,
            length: 4,
        };
        for seed in 0..50 {
            let places = plan.draw(seed, 1000, 4000);
            assert_eq!(places.len(), 7);
            for (k, at) in places.iter().enumerate() {
                let part = |k: usize| 1000 + 3000 * k as u64 / 7;
                assert!(
                    *at >= part(k) && at + 4 <= part(k + 1),
                    "{seed}: {places:?}"
                );
            }
            assert_eq!(places, plan.draw(seed, 1000, 4000));
        }
        assert_ne!(plan.draw(1, 0, 4000), plan.draw(2, 0, 4000));
    }

    #[test]
    fn no_more_is_planned_than_the_run_affords() {
        let none = UncertaintySpec::default();
        for steps in 1..20_000 {
            match plan(&none, steps) {
                Ok(Plan { count, length }) => {
                    assert!((1..=8).contains(&length) && count >= 3, "{steps}");
                    assert!(count as u64 * u64::from(length) * 220 <= steps, "{steps}");
                }
                Err(reason) => assert!(steps < 660 && reason.starts_with("too short")),
            }
        }
    }

    #[test]
    fn what_the_case_says_holds() {
        let spec = |repeats, steps| UncertaintySpec { repeats, steps };
        let five = plan(&spec(Some(5), Some(2)), 60);
        assert_eq!(
            five,
            Ok(Plan {
                count: 5,
                length: 2
            })
        );
        assert!(plan(&spec(Some(0), None), 60_000).is_err());
        let long = plan(&spec(None, Some(3)), 10_000).unwrap();
        assert_eq!((long.count, long.length), (15, 3));
    }
}
