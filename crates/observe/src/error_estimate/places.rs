//! Steps at which a run repeats a stretch: drawn from its seed, one in each of equal parts of the evaluated time.

use super::change::FEWEST;
use fretwork_scene::case::UncertaintySpec;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// What the repeats of a stretch cost, over the cost of the stretch: once as it is, four shorter steps for each, a tight tolerance, and
/// implicit coupling.
const COST: u64 = 12;
/// Share of the run that they may cost, as one over this.
const SHARE: u64 = 25;
/// Mixed into the seed of the case, so that places are not drawn with the numbers of its grains.
const STREAM: u64 = 0x7265_7065_6174_7321;

/// Number of places in a run of so many steps, and the reason where there is none.
pub fn count(spec: &UncertaintySpec, steps: u64) -> Result<usize, String> {
    if spec.repeats == Some(0) {
        return Err("switched off by `uncertainty: (repeats: 0)`".to_owned());
    }
    if let Some(count) = spec.repeats {
        return Ok(count as usize);
    }
    let each = SHARE * COST * u64::from(spec.steps);
    let count = steps / each.max(1);
    if count < FEWEST as u64 {
        return Err(format!(
            "too short: three repeats would cost more than {} % of a run of less than {} steps; set `uncertainty: (repeats: 3)` to \
             have them nevertheless",
            100 / SHARE,
            FEWEST as u64 * each
        ));
    }
    Ok(count as usize)
}

/// Numbers of completed steps after which stretches of `length` steps are repeated: `count` of them between two steps, in order.
pub fn draw(seed: u64, count: usize, from: u64, to: u64, length: u64) -> Vec<u64> {
    let mut rng = Pcg64::seed_from_u64(seed ^ STREAM);
    let span = to.saturating_sub(from);
    let edge = |k: usize| from + (u128::from(span) * k as u128 / count as u128) as u64;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_one_in_each_part_and_follow_the_seed() {
        for seed in 0..50 {
            let places = draw(seed, 7, 1000, 4000, 4);
            assert_eq!(places.len(), 7);
            for (k, at) in places.iter().enumerate() {
                let part = |k: usize| 1000 + 3000 * k as u64 / 7;
                assert!(
                    *at >= part(k) && at + 4 <= part(k + 1),
                    "{seed}: {places:?}"
                );
            }
            assert_eq!(places, draw(seed, 7, 1000, 4000, 4));
        }
        assert_ne!(draw(1, 7, 0, 4000, 4), draw(2, 7, 0, 4000, 4));
    }

    #[test]
    fn the_number_follows_from_the_steps_alone() {
        let spec = |repeats, steps| UncertaintySpec { repeats, steps };
        assert_eq!(count(&spec(None, 2), 6000), Ok(10));
        assert_eq!(count(&spec(Some(5), 2), 60), Ok(5));
        assert!(
            count(&spec(None, 2), 1000)
                .unwrap_err()
                .starts_with("too short")
        );
        assert!(count(&spec(Some(0), 2), 6000).is_err());
    }
}
