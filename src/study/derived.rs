//! Values that follow from several factors: `key.path=${2e-5 * strength}`.

use super::design::Setting;
use super::factor::Factor;
use exmex::{Express, FlatEx, FloatOpsFactory, MatchLiteral, literal_matcher_from_pattern};

literal_matcher_from_pattern!(
    ScientificNumber,
    r"^(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][+-]?[0-9]+)?"
);

/// An expression of numbers as a case writes them, `2e-5` too.
type Parsed = FlatEx<f64, FloatOpsFactory<f64>, ScientificNumber>;

/// A change of the case with expressions in factors.
#[derive(Clone, Debug)]
pub struct Derived {
    /// As it is written.
    text: String,
    /// Texts between the expressions, one more than there are of them.
    texts: Vec<String>,
    expressions: Vec<Expression>,
}

#[derive(Clone, Debug)]
struct Expression {
    expression: Parsed,
    /// Number of the factor of each variable, in the order of the expression.
    factors: Vec<usize>,
}

impl Derived {
    /// Whether a change has expressions.
    pub fn is(text: &str) -> bool {
        text.contains("${")
    }

    /// Parses `key.path=value` with expressions in `${...}`; their names are those of factors.
    ///
    /// # Errors
    /// What is wrong with it, as a sentence.
    pub fn parse(text: &str, factors: &[Factor]) -> Result<Self, String> {
        let mut texts = Vec::new();
        let mut expressions = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once("${") {
            let Some((inside, end)) = after.split_once('}') else {
                return Err(format!("`{text}` has no `}}` for its `${{`"));
            };
            texts.push(before.to_owned());
            expressions.push(Expression::parse(inside, factors)?);
            rest = end;
        }
        texts.push(rest.to_owned());
        Ok(Self {
            text: text.to_owned(),
            texts,
            expressions,
        })
    }

    /// The change for a setting.
    ///
    /// # Errors
    /// A factor without numbers, or a result that is not finite.
    pub fn set(&self, setting: &Setting) -> Result<String, String> {
        let mut out = self.texts.first().cloned().unwrap_or_default();
        for (expression, text) in self.expressions.iter().zip(&self.texts[1..]) {
            let value = expression
                .value(setting)
                .ok_or_else(|| format!("`{}` has no finite number here", self.text))?;
            // A field of floats takes a number with a point, and a count must be written as one: `count=${...}` rounds itself.
            out += &match value {
                v if v != 0.0 && !(1e-3..1e5).contains(&v.abs()) => format!("{v:e}"),
                v => format!("{v}"),
            };
            out += text;
        }
        Ok(out)
    }
}

impl Expression {
    fn parse(text: &str, factors: &[Factor]) -> Result<Self, String> {
        let expression =
            Parsed::parse(text).map_err(|e| format!("`{text}` is no expression: {e}"))?;
        let number = |name: &String| {
            let place = factors.iter().position(|f| f.name == *name);
            place.ok_or_else(|| {
                let names: Vec<&str> = factors.iter().map(|f| f.name.as_str()).collect();
                format!(
                    "`{name}` in `{text}` is no factor; there are {}",
                    names.join(", ")
                )
            })
        };
        let factors = expression.var_names().iter().map(number);
        let factors = factors.collect::<Result<_, _>>()?;
        Ok(Self {
            expression,
            factors,
        })
    }

    fn value(&self, setting: &Setting) -> Option<f64> {
        let values: Option<Vec<f64>> = self.factors.iter().map(|&f| setting[f].number).collect();
        let value = self.expression.eval(&values?).ok()?;
        value.is_finite().then_some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_take_the_values_of_the_setting() {
        let factor = |key: &str| Factor::of_column(key, vec!["3.0".into(), "1e-9".into()]);
        let factors = [factor("strength"), factor("pressure")];
        let setting = vec![factors[0].at(0.0), factors[1].at(1.0)];
        let set = |text: &str| Derived::parse(text, &factors).and_then(|d| d.set(&setting));
        assert_eq!(set("a.b=${2e0 * strength + 1}").unwrap(), "a.b=7");
        assert_eq!(
            set("y=Pressure(value: Constant(${-pressure}))").unwrap(),
            "y=Pressure(value: Constant(-1e-9))"
        );
        assert_eq!(
            set("a=[${strength}, ${sqrt(strength^2)}]").unwrap(),
            "a=[3, 3]"
        );
        for wrong in [
            "a=${strngth}",
            "a=${strength",
            "a=${strength *}",
            "a=${1/0 * strength}",
        ] {
            assert!(set(wrong).is_err(), "{wrong}");
        }
    }
}
