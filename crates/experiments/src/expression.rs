//! Expressions in names: changes of a case that follow from several values, and columns computed
//! from others.

use exmex::{Express, FlatEx, FloatOpsFactory, MatchLiteral, literal_matcher_from_pattern};

literal_matcher_from_pattern!(
    ScientificNumber,
    r"^(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][+-]?[0-9]+)?"
);

/// An expression of numbers as a case writes them, including `2e-5`.
type Parsed = FlatEx<f64, FloatOpsFactory<f64>, ScientificNumber>;

/// An expression in names.
#[derive(Clone, Debug)]
pub struct Expression {
    expression: Parsed,
    /// Index of each variable in the list of names.
    places: Vec<usize>,
}

impl Expression {
    /// Parses an expression whose variables are among `names`: `+ - * / ^`, `sqrt`, `abs`, `exp`,
    /// `ln`, `sin` and others, `PI`.
    ///
    /// # Errors
    /// Returns what is wrong with it, as a sentence.
    pub fn parse(text: &str, names: &[impl AsRef<str>]) -> Result<Self, String> {
        let expression =
            Parsed::parse(text).map_err(|e| format!("`{text}` is no expression: {e}"))?;
        let place = |name: &String| {
            let place = names.iter().position(|n| n.as_ref() == name);
            place.ok_or_else(|| {
                let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
                format!(
                    "`{name}` in `{text}` is not known; there are {}",
                    names.join(", ")
                )
            })
        };
        let places = expression.var_names().iter().map(place);
        let places = places.collect::<Result<_, _>>()?;
        Ok(Self { expression, places })
    }

    /// Returns its value for these values of the names; `None` if a name that it uses has none, or
    /// if it is not finite.
    pub fn value(&self, values: &[Option<f64>]) -> Option<f64> {
        let own: Option<Vec<f64>> = self.places.iter().map(|&p| values[p]).collect();
        let value = self.expression.eval(&own?).ok()?;
        value.is_finite().then_some(value)
    }

    /// Returns the indices of the names that it uses.
    pub fn needs(&self) -> &[usize] {
        &self.places
    }
}

/// Formats a number as a case reads it.
pub fn number(value: f64) -> String {
    match value {
        v if v != 0.0 && !(1e-3..1e5).contains(&v.abs()) => format!("{v:e}"),
        v => format!("{v}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_take_the_values_of_their_names() {
        let halved = Expression::parse("strength / 2", &["strength", "pressure"]).unwrap();
        assert_eq!(halved.value(&[None, Some(1.0)]), None);
        assert_eq!(halved.value(&[Some(1.0), None]), Some(0.5));
    }
}
