//! Functions of expressions.

use crate::units::{Amount, Measure};

/// A function, and the dimensions that it takes and gives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Function(&'static Named);

#[derive(Debug)]
struct Named {
    name: &'static str,
    rule: Rule,
}

#[derive(Debug)]
enum Rule {
    /// From a number to a number.
    Number(fn(f64) -> f64),
    /// From an angle, or a number in radians, to a number.
    Angle(fn(f64) -> f64),
    /// From any amount to one of the same dimension.
    Same(fn(f64) -> f64),
    /// From any amount to a number.
    Sign(fn(f64) -> f64),
    /// A root of this degree.
    Root(f64, fn(f64) -> f64),
    /// From two amounts of one dimension to one of the same.
    TwoAlike(fn(f64, f64) -> f64),
    /// From two amounts of one dimension to a number.
    Ratio(fn(f64, f64) -> f64),
}

const fn named(name: &'static str, rule: Rule) -> Named {
    Named { name, rule }
}

static FUNCTIONS: [Named; 29] = [
    named("sqrt", Rule::Root(2.0, f64::sqrt)),
    named("cbrt", Rule::Root(3.0, f64::cbrt)),
    named("abs", Rule::Same(f64::abs)),
    named("min", Rule::TwoAlike(f64::min)),
    named("max", Rule::TwoAlike(f64::max)),
    named("signum", Rule::Sign(f64::signum)),
    named("sin", Rule::Angle(f64::sin)),
    named("cos", Rule::Angle(f64::cos)),
    named("tan", Rule::Angle(f64::tan)),
    named("asin", Rule::Number(f64::asin)),
    named("acos", Rule::Number(f64::acos)),
    named("atan", Rule::Number(f64::atan)),
    named("atan2", Rule::Ratio(f64::atan2)),
    named("sinh", Rule::Number(f64::sinh)),
    named("cosh", Rule::Number(f64::cosh)),
    named("tanh", Rule::Number(f64::tanh)),
    named("asinh", Rule::Number(f64::asinh)),
    named("acosh", Rule::Number(f64::acosh)),
    named("atanh", Rule::Number(f64::atanh)),
    named("exp", Rule::Number(f64::exp)),
    named("ln", Rule::Number(f64::ln)),
    named("log", Rule::Number(f64::ln)),
    named("log2", Rule::Number(f64::log2)),
    named("log10", Rule::Number(f64::log10)),
    named("floor", Rule::Number(f64::floor)),
    named("ceil", Rule::Number(f64::ceil)),
    named("round", Rule::Number(f64::round)),
    named("trunc", Rule::Number(f64::trunc)),
    named("fract", Rule::Number(f64::fract)),
];

/// Constants by their names.
const CONSTANTS: [(&str, f64); 6] = [
    ("pi", std::f64::consts::PI),
    ("PI", std::f64::consts::PI),
    ("π", std::f64::consts::PI),
    ("TAU", std::f64::consts::TAU),
    ("τ", std::f64::consts::TAU),
    ("e", std::f64::consts::E),
];

/// Returns the constant of a name.
pub(super) fn constant(name: &str) -> Option<f64> {
    CONSTANTS.iter().find(|c| c.0 == name).map(|c| c.1)
}

/// Returns whether a name is that of a function or constant.
pub(crate) fn is_taken(name: &str) -> bool {
    constant(name).is_some() || Function::named(name).is_some()
}

impl Function {
    /// The function with a name.
    pub fn named(name: &str) -> Option<Self> {
        FUNCTIONS.iter().find(|f| f.name == name).map(Self)
    }

    /// Names of all functions.
    pub fn names() -> impl Iterator<Item = &'static str> {
        FUNCTIONS.iter().map(|f| f.name)
    }

    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Number of arguments.
    pub fn count(self) -> usize {
        match self.0.rule {
            Rule::TwoAlike(_) | Rule::Ratio(_) => 2,
            _ => 1,
        }
    }

    /// Returns the value, or the index of the argument of a wrong dimension and what is taken.
    pub fn of(self, arguments: &[Amount]) -> Result<Amount, (usize, &'static str)> {
        let a = arguments[0];
        let x = a.value;
        let number = |value| Ok(Amount::number(value));
        match &self.0.rule {
            Rule::Number(f) if a.measure.equals(&Measure::NUMBER) => number(f(x)),
            Rule::Number(_) => Err((0, "a pure number")),
            Rule::Angle(f) if a.measure.is_number() => number(f(x)),
            Rule::Angle(_) => Err((0, "an angle")),
            Rule::Sign(f) => number(f(x)),
            Rule::Same(f) => Ok(Amount { value: f(x), ..a }),
            Rule::Root(degree, f) => Ok(Amount {
                value: f(x),
                measure: a.measure.raised_to(1.0 / degree),
            }),
            Rule::TwoAlike(_) | Rule::Ratio(_) if !a.measure.equals(&arguments[1].measure) => {
                Err((1, "two values of the same dimension"))
            }
            Rule::TwoAlike(f) => Ok(Amount {
                value: f(x, arguments[1].value),
                ..a
            }),
            Rule::Ratio(f) => number(f(x, arguments[1].value)),
        }
    }
}
