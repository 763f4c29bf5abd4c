//! What files of studies and of fits have in common: keys of a case, how numbers of a range are spread, and which runs are accepted.

use fretwork_scene::source::{InputError, Source};
use serde::Deserialize;

/// One key of a case or several.
#[derive(Debug, Default)]
pub struct CaseKeys(pub Vec<String>);

impl<'de> Deserialize<'de> for CaseKeys {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany;
        impl<'de> serde::de::Visitor<'de> for OneOrMany {
            type Value = CaseKeys;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a key of the case, or a list of keys")
            }

            fn visit_str<E: serde::de::Error>(self, key: &str) -> Result<CaseKeys, E> {
                Ok(CaseKeys(vec![key.to_owned()]))
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(
                self,
                mut list: A,
            ) -> Result<CaseKeys, A::Error> {
                let mut keys = Vec::new();
                while let Some(key) = list.next_element()? {
                    keys.push(key);
                }
                Ok(CaseKeys(keys))
            }
        }
        deserializer.deserialize_any(OneOrMany)
    }
}

/// How the numbers of a range are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum RangeScale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in their logarithms.
    Log,
    /// Whole numbers.
    Integer,
}

/// Checks the threads of a run and the limits of accepted runs.
///
/// # Errors
/// At the key that is wrong.
pub fn check_runs(
    source: &Source,
    threads: u16,
    unconverged: f64,
    residual: f64,
) -> Result<(), InputError> {
    if threads == 0 {
        return Err(source.error_at("threads", "a run has one thread or more"));
    }
    for (key, limit) in [("unconverged", unconverged), ("residual", residual)] {
        if !(0.0..=1.0).contains(&limit) {
            return Err(source.error_at(key, "a number from 0 to 1 is expected"));
        }
    }
    Ok(())
}

/// One thread, or one seed, by default.
pub fn one() -> u16 {
    1
}

/// The limit of accepted runs by default.
pub fn one_percent() -> f64 {
    0.01
}
