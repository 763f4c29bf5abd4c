//! Expressions in names, `p0 * L / 2`: of amounts with dimensions in cases, and of plain numbers
//! in studies and fits.

mod function;
mod parse;
#[cfg(test)]
mod tests;

pub(crate) use function::is_taken;
pub(crate) use parse::is_name;

use crate::units::{Amount, Measure};
use function::Function;
use std::fmt;
use std::ops::Range;

/// An expression in names.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    root: Term,
    /// Indices of the names that it uses, each once.
    needs: Vec<usize>,
}

/// Why an expression is invalid, or has no value.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionError {
    /// What is wrong, as a sentence.
    pub message: String,
    /// Bytes of the expression to which it applies.
    pub span: Range<usize>,
    /// The nearest valid name.
    pub nearest: Option<String>,
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        match &self.nearest {
            Some(name) => write!(f, "; did you mean `{name}`?"),
            None => Ok(()),
        }
    }
}

/// A part of an expression, and its bytes in the text.
#[derive(Clone, Debug)]
struct Term {
    span: Range<usize>,
    kind: TermKind,
}

#[derive(Clone, Debug)]
enum TermKind {
    Amount(Amount),
    /// A name, by its index.
    Name(usize),
    Negative(Box<Term>),
    Binary(Operation, Box<[Term; 2]>),
    Call(Function, Vec<Term>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl Expression {
    /// Parses an expression of amounts, whose numbers may have units, `2 mm * p0`, and whose names
    /// are among `names`: `+ - * / ^`, parentheses, `sqrt`, `cbrt`, `abs`, `min`, `max`, `exp`,
    /// `ln`, `log10`, `sin`, `cos`, `tan` and others, `pi`. A power binds more strongly than a
    /// sign: `-a^2` is `-(a^2)`.
    ///
    /// # Errors
    /// The text is no expression, or a name is unknown.
    pub fn parse(text: &str, names: &[impl AsRef<str>]) -> Result<Self, ExpressionError> {
        parse::parse(text, names, true)
    }

    /// Parses an expression of plain numbers, see [`Expression::parse`].
    ///
    /// # Errors
    /// The text is no expression, a name is unknown, or a number has a unit.
    pub fn of_numbers(text: &str, names: &[impl AsRef<str>]) -> Result<Self, ExpressionError> {
        parse::parse(text, names, false)
    }

    /// Returns its value for these values of the names; `None` if a name that it uses has none, if
    /// it is not finite, or if dimensions do not fit.
    pub fn value(&self, values: &[Option<f64>]) -> Option<f64> {
        let amount = |k: usize| values.get(k).copied().flatten().map(Amount::number);
        self.amount(&amount).ok().map(|amount| amount.value)
    }

    /// Returns the indices of the names that it uses.
    pub fn needs(&self) -> &[usize] {
        &self.needs
    }

    /// Returns its value, from the values of the names by their indices.
    ///
    /// # Errors
    /// Dimensions do not fit, or the result is not finite.
    pub(crate) fn amount(
        &self,
        values: &dyn Fn(usize) -> Option<Amount>,
    ) -> Result<Amount, ExpressionError> {
        let amount = self.evaluate(&self.root, values)?;
        if !amount.value.is_finite() {
            let message = format!(
                "`{}` is {}, which is no finite number",
                self.text, amount.value
            );
            return Err(error(self.root.span.clone(), message));
        }
        Ok(amount)
    }

    fn evaluate(
        &self,
        term: &Term,
        values: &dyn Fn(usize) -> Option<Amount>,
    ) -> Result<Amount, ExpressionError> {
        let written = |term: &Term| format!("`{}`", &self.text[term.span.clone()]);
        Ok(match &term.kind {
            TermKind::Amount(amount) => *amount,
            TermKind::Name(name) => values(*name).ok_or_else(|| {
                error(
                    term.span.clone(),
                    format!("{} has no number", written(term)),
                )
            })?,
            TermKind::Negative(inner) => {
                let amount = self.evaluate(inner, values)?;
                Amount {
                    value: -amount.value,
                    ..amount
                }
            }
            TermKind::Binary(operation, sides) => {
                let a = self.evaluate(&sides[0], values)?;
                let b = self.evaluate(&sides[1], values)?;
                operation.of(a, b).map_err(|wrong| {
                    let [one, other] = [&sides[0], &sides[1]].map(written);
                    let message = match wrong {
                        Unfit::Sides => format!(
                            "{one} is {}, and {other} is {}: they cannot be {}",
                            a.measure.in_words(),
                            b.measure.in_words(),
                            match operation {
                                Operation::Add => "added",
                                _ => "subtracted",
                            }
                        ),
                        Unfit::Exponent => format!(
                            "the exponent {other} is {}, not a pure number",
                            b.measure.in_words()
                        ),
                    };
                    error(term.span.clone(), message)
                })?
            }
            TermKind::Call(function, arguments) => {
                let amounts = arguments.iter().map(|a| self.evaluate(a, values));
                let amounts: Vec<Amount> = amounts.collect::<Result<_, _>>()?;
                function.of(&amounts).map_err(|(at, wanted)| {
                    let argument = &arguments[at];
                    let message = format!(
                        "{} is {}, and `{}` takes {wanted}",
                        written(argument),
                        amounts[at].measure.in_words(),
                        function.name()
                    );
                    error(argument.span.clone(), message)
                })?
            }
        })
    }
}

fn error(span: Range<usize>, message: String) -> ExpressionError {
    ExpressionError {
        message,
        span,
        nearest: None,
    }
}

/// Why an operation has no result.
enum Unfit {
    /// The two sides have different dimensions.
    Sides,
    /// An exponent is no pure number.
    Exponent,
}

impl Operation {
    fn of(self, a: Amount, b: Amount) -> Result<Amount, Unfit> {
        let (x, y) = (a.value, b.value);
        let (value, measure) = match self {
            Self::Add | Self::Subtract => {
                if !a.measure.equals(&b.measure) {
                    return Err(Unfit::Sides);
                }
                let value = if self == Self::Add { x + y } else { x - y };
                (value, a.measure)
            }
            Self::Multiply => (x * y, a.measure.combined(&b.measure, 1.0)),
            Self::Divide => (x / y, a.measure.combined(&b.measure, -1.0)),
            Self::Power => {
                if !b.measure.equals(&Measure::NUMBER) {
                    return Err(Unfit::Exponent);
                }
                (x.powf(y), a.measure.raised_to(y))
            }
        };
        Ok(Amount { value, measure })
    }
}

/// Formats a number as a case reads it.
pub fn number(value: f64) -> String {
    match value {
        v if v != 0.0 && !(1e-3..1e5).contains(&v.abs()) => format!("{v:e}"),
        v => format!("{v}"),
    }
}
