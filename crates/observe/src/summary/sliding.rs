//! Friction test of a run, read back from its `summary.json`.

use crate::quantity::find;
use serde_json::Value;

/// A friction test in which something slid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingTest {
    /// Coefficient of sliding.
    pub coefficient: f64,
    /// Mean normal force over the complete cycles (N; 2D N/m).
    pub normal_force: Option<f64>,
    /// Whether the motion is to and fro.
    pub reciprocates: bool,
}

impl SlidingTest {
    /// Path of the coefficient of sliding in a summary.
    pub const COEFFICIENT: &str = "friction_coefficient";

    /// Reads the friction test of a summary.
    ///
    /// # Errors
    /// Returns why there is no coefficient of sliding, as the end of a sentence.
    pub fn of(summary: &Value) -> Result<Self, String> {
        let coefficient = summary[Self::COEFFICIENT].as_f64();
        let regime = find(summary, "fretting.regime").and_then(Value::as_str);
        let cycles = summary["cycles"].as_array();
        let last = || cycles?.last()?["regime"].as_str();
        // The cycles of a motion in one direction have no regime of fretting.
        let regime = regime.or_else(|| last().filter(|_| coefficient.is_none()));
        let coefficient = match (regime, coefficient) {
            (Some("partial"), _) => {
                return Err(
                    "the run is in partial slip: it has no coefficient of sliding; displace it further, or give friction".into(),
                );
            }
            (_, Some(coefficient)) => coefficient,
            (Some(regime), None) => {
                return Err(format!(
                    "the run is in the regime `{regime}`: it has no coefficient of sliding; displace it further, or give friction"
                ));
            }
            (None, None) => {
                return Err("it has no friction coefficient; its case needs `friction`".into());
            }
        };
        let complete = cycles.into_iter().flatten();
        let complete = complete.filter(|c| c["complete"] != false);
        if cycles.is_some_and(|c| !c.is_empty()) && complete.clone().next().is_none() {
            return Err(
                "the run ended within its first cycle; run it longer (time.end), or give friction"
                    .into(),
            );
        }
        let forces: Vec<f64> = complete
            .filter_map(|c| c["normal_force"].as_f64())
            .collect();
        let mean = forces.iter().sum::<f64>() / forces.len() as f64;
        Ok(Self {
            coefficient,
            normal_force: (!forces.is_empty()).then_some(mean),
            reciprocates: !summary["fretting"].is_null(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn only_what_slides_has_a_coefficient() {
        let of = |mu: Value, regime: Value, cycle: &str| {
            let fretting = match regime {
                Value::Null => Value::Null,
                regime => json!({"regime": regime}),
            };
            let cycles = json!([{"regime": cycle, "normal_force": 2.0}]);
            SlidingTest::of(&json!({
                SlidingTest::COEFFICIENT: mu, "fretting": fretting, "cycles": cycles,
            }))
        };
        let says = |found: Result<SlidingTest, String>, words: &str| {
            assert!(found.clone().is_err_and(|w| w.contains(words)), "{found:?}");
        };
        let partial = "in partial slip: it has no coefficient of sliding";
        says(of(Value::Null, json!("partial"), "partial"), partial);
        says(of(json!(0.008), json!("partial"), "partial"), partial);
        says(of(Value::Null, Value::Null, "partial"), partial);
        says(of(Value::Null, json!("mixed"), "gross"), "`mixed`");
        says(SlidingTest::of(&json!({})), "its case needs `friction`");
        let cut = json!({
            SlidingTest::COEFFICIENT: 0.4, "cycles": [{"complete": false, "normal_force": 2.0}],
        });
        says(SlidingTest::of(&cut), "within its first cycle");
        let one_way = of(json!(0.3), Value::Null, "partial").unwrap();
        assert_eq!((one_way.coefficient, one_way.reciprocates), (0.3, false));
        let mixed = of(json!(0.3), json!("mixed"), "gross").unwrap();
        assert_eq!((mixed.normal_force, mixed.reciprocates), (Some(2.0), true));
    }
}
