//! Changes of a case in an experiment: values that all runs share, and values computed from its
//! factors, `key.path=${2e-5 * strength}`, with a unit if the value has one.

use fretwork_scene::expression::{Expression, number};

/// A change of the case with expressions in `${...}`.
#[derive(Clone, Debug)]
struct Derived {
    /// The text of the change, with its expressions.
    text: String,
    /// Texts before, between and after the expressions.
    texts: Vec<String>,
    expressions: Vec<Expression>,
}

impl Derived {
    fn parse(text: &str, names: &[&str]) -> Result<Self, String> {
        let mut texts = Vec::new();
        let mut expressions = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once("${") {
            let Some((inside, end)) = after.split_once('}') else {
                return Err(format!("`{text}` has no `}}` for its `${{`"));
            };
            texts.push(before.to_owned());
            let expression = Expression::of_numbers(inside, names);
            expressions.push(expression.map_err(|e| e.to_string())?);
            rest = end;
        }
        texts.push(rest.to_owned());
        Ok(Self {
            text: text.to_owned(),
            texts,
            expressions,
        })
    }

    fn set(&self, values: &[Option<f64>]) -> Result<String, String> {
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

/// Changes of a case, as `set` of a file lists them.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    /// Changes of all runs.
    pub fixed: Vec<String>,
    derived: Vec<Derived>,
}

impl Changes {
    /// Whether a change follows from values of names.
    pub fn depends(set: &str) -> bool {
        set.contains("${")
    }

    /// Parses changes whose expressions use these names.
    ///
    /// # Errors
    /// Returns the number of the invalid change, and the reason as a sentence.
    pub fn parse(sets: &[String], names: &[&str]) -> Result<Self, (usize, String)> {
        let mut out = Self::default();
        for (k, set) in sets.iter().enumerate() {
            match Self::depends(set) {
                true => out
                    .derived
                    .push(Derived::parse(set, names).map_err(|why| (k, why))?),
                false => out.fixed.push(set.clone()),
            }
        }
        Ok(out)
    }

    /// Returns whether an expression uses the name with this number.
    pub fn needs(&self, name: usize) -> bool {
        let mut expressions = self.derived.iter().flat_map(|d| &d.expressions);
        expressions.any(|e| e.needs().contains(&name))
    }

    /// Returns the changes for values of the names.
    ///
    /// # Errors
    /// A name has no number, or a result is not finite.
    pub fn derived(&self, values: &[Option<f64>]) -> Result<Vec<String>, String> {
        self.derived.iter().map(|d| d.set(values)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_follow_from_the_values_of_the_names() {
        let values = [Some(3.0), Some(1e-9)];
        let set = |text: &str| {
            let changes = Changes::parse(&[text.to_owned()], &["strength", "pressure"]);
            let changes = changes.map_err(|(_, why)| why)?;
            Ok::<String, String>(changes.derived(&values)?.concat())
        };
        assert_eq!(set("a.b=${2e0 * strength + 1}").unwrap(), "a.b=7");
        assert_eq!(set("a.b=${strength} us").unwrap(), "a.b=3 us");
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
