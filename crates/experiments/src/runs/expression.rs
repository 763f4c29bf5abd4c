//! Expressions in names: changes of a case that follow from several values, `key.path=${2e-5 * strength}`, and columns that are
//! made of others.

use exmex::{Express, FlatEx, FloatOpsFactory, MatchLiteral, literal_matcher_from_pattern};

literal_matcher_from_pattern!(
    ScientificNumber,
    r"^(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][+-]?[0-9]+)?"
);

/// An expression of numbers as a case writes them, `2e-5` too.
type Parsed = FlatEx<f64, FloatOpsFactory<f64>, ScientificNumber>;

/// An expression in names.
#[derive(Clone, Debug)]
pub struct Expression {
    expression: Parsed,
    /// Place of each variable in the list of names.
    places: Vec<usize>,
}

impl Expression {
    /// Parses an expression whose variables are among `names`: `+ - * / ^`, `sqrt`, `abs`, `exp`, `ln`, `sin` and others, `PI`.
    ///
    /// # Errors
    /// What is wrong with it, as a sentence.
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

    /// Its value where the names have these values; `None` if one that it needs has none, or if it is not finite.
    pub fn value(&self, values: &[Option<f64>]) -> Option<f64> {
        let own: Option<Vec<f64>> = self.places.iter().map(|&p| values[p]).collect();
        let value = self.expression.eval(&own?).ok()?;
        value.is_finite().then_some(value)
    }

    /// Places of the names that it needs.
    pub fn needs(&self) -> &[usize] {
        &self.places
    }
}

/// A change of the case with expressions in `${...}`.
#[derive(Clone, Debug)]
pub struct Derived {
    /// As it is written.
    text: String,
    /// Texts between the expressions, one more than there are of them.
    texts: Vec<String>,
    expressions: Vec<Expression>,
}

impl Derived {
    /// Whether a change has expressions.
    pub fn is(text: &str) -> bool {
        text.contains("${")
    }

    /// Parses `key.path=value` with expressions in `${...}`.
    ///
    /// # Errors
    /// What is wrong with it, as a sentence.
    pub fn parse(text: &str, names: &[impl AsRef<str>]) -> Result<Self, String> {
        let mut texts = Vec::new();
        let mut expressions = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once("${") {
            let Some((inside, end)) = after.split_once('}') else {
                return Err(format!("`{text}` has no `}}` for its `${{`"));
            };
            texts.push(before.to_owned());
            expressions.push(Expression::parse(inside, names)?);
            rest = end;
        }
        texts.push(rest.to_owned());
        Ok(Self {
            text: text.to_owned(),
            texts,
            expressions,
        })
    }

    /// Places of the names that it needs.
    pub fn needs(&self) -> impl Iterator<Item = usize> + '_ {
        self.expressions
            .iter()
            .flat_map(|e| e.needs().iter().copied())
    }

    /// The change where the names have these values.
    ///
    /// # Errors
    /// A name without a number, or a result that is not finite.
    pub fn set(&self, values: &[Option<f64>]) -> Result<String, String> {
        let mut out = self.texts.first().cloned().unwrap_or_default();
        for (expression, text) in self.expressions.iter().zip(&self.texts[1..]) {
            let value = expression
                .value(values)
                .ok_or_else(|| format!("`{}` has no finite number here", self.text))?;
            out += &number(value);
            out += text;
        }
        Ok(out)
    }
}

/// A number as a case reads it.
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
        let names = ["strength", "pressure"];
        let values = [Some(3.0), Some(1e-9)];
        let set = |text: &str| Derived::parse(text, &names).and_then(|d| d.set(&values));
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
        let missing = Expression::parse("strength / 2", &names).unwrap();
        assert_eq!(missing.value(&[None, Some(1.0)]), None);
        assert_eq!(missing.value(&[Some(1.0), None]), Some(0.5));
    }
}
