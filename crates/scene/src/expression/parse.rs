//! Parser of expressions.

use super::function::{Function, constant};
use super::{Expression, ExpressionError, Operation, Term, TermKind, error};
use crate::quantity;
use crate::source::nearest;
use crate::units::{self, Amount};
use std::ops::Range;

/// Depth of parentheses, signs and powers that is accepted.
const DEEPEST: usize = 100;

/// Bytes of a text that are accepted, which bound the depth of the term.
const LONGEST: usize = 4096;

/// Parses a whole text; numbers may have units if `with_units`.
pub(super) fn parse(
    text: &str,
    names: &[impl AsRef<str>],
    with_units: bool,
) -> Result<Expression, ExpressionError> {
    if text.len() > LONGEST {
        let message = format!("an expression has at most {LONGEST} characters");
        return Err(error(0..0, message));
    }
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    let mut parser = Parser {
        text,
        at: 0,
        depth: 0,
        names: &names,
        with_units,
        needs: Vec::new(),
    };
    let root = parser.sum()?;
    parser.blank();
    if parser.at < text.len() {
        let rest = parser.rest();
        let found = rest.chars().next().unwrap_or_default();
        let message = match found {
            ')' => "this `)` closes nothing".to_owned(),
            ',' => "a decimal comma is written as a point".to_owned(),
            _ => "an operator such as `*` is missing before this".to_owned(),
        };
        return Err(error(parser.here(), message));
    }
    Ok(Expression {
        text: text.to_owned(),
        root,
        needs: parser.needs,
    })
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    names: &'a [&'a str],
    with_units: bool,
    needs: Vec<usize>,
}

/// What a value of a product is made of, for the words after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Factor {
    /// A number without a unit.
    Number,
    /// A number with a unit, or a unit after one.
    Unit,
    /// A number with a unit that divides what has names.
    Divisor,
    Other,
}

/// Why a word that is a name and a unit is neither.
fn two_meanings(word: &str) -> String {
    format!(
        "`{word}` is a name of this file and a unit: for the name write `*` or `/` with spaces, \
         for the unit take another one, or give the name another spelling"
    )
}

/// Why a unit after a divisor is not clear: `a / 2 N/m`.
fn of_divisor(word: &str) -> String {
    format!(
        "does `{word}` belong to the unit of the divisor? That stands in parentheses, as in \
         `a / (2 N/m)`"
    )
}

/// Whether a name may begin with a character.
fn begins_name(c: char) -> bool {
    c == '_' || c.is_alphabetic()
}

fn continues_name(c: char) -> bool {
    c == '_' || c.is_alphanumeric()
}

/// Returns whether a text is a name of a value.
pub(crate) fn is_name(text: &str) -> bool {
    text.starts_with(begins_name) && text.chars().all(continues_name)
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn blank(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Returns the next character that is no blank.
    fn peek(&mut self) -> Option<char> {
        self.blank();
        self.rest().chars().next()
    }

    /// Returns the bytes of the next character.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.rest().chars().next().map_or(0, char::len_utf8)
    }

    /// Takes a character if it is the next one.
    fn take(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    fn deeper<T>(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<T, ExpressionError>,
    ) -> Result<T, ExpressionError> {
        if self.depth == DEEPEST {
            let message = format!("it is nested more than {DEEPEST} levels deep");
            return Err(error(self.here(), message));
        }
        self.depth += 1;
        let found = inner(self);
        self.depth -= 1;
        found
    }

    fn sum(&mut self) -> Result<Term, ExpressionError> {
        let mut left = self.product()?;
        loop {
            let operation = match self.peek() {
                Some('+') => Operation::Add,
                Some('-') => Operation::Subtract,
                _ => return Ok(left),
            };
            self.at += 1;
            left = binary(operation, left, self.product()?);
        }
    }

    fn product(&mut self) -> Result<Term, ExpressionError> {
        let (mut left, mut last) = self.signed(Factor::Other)?;
        loop {
            let operation = match self.peek() {
                Some('*') => Operation::Multiply,
                Some('/') => Operation::Divide,
                _ => return Ok(left),
            };
            self.at += 1;
            let (right, factor) = self.signed(last)?;
            last = match (operation, last, factor) {
                (Operation::Divide, Factor::Other, Factor::Unit) => Factor::Divisor,
                (Operation::Divide, Factor::Other, Factor::Number) => Factor::Other,
                (_, Factor::Divisor, Factor::Unit) => Factor::Divisor,
                (_, _, factor) => factor,
            };
            left = binary(operation, left, right);
        }
    }

    /// Parses a value with its sign, after another one of its product.
    fn signed(&mut self, before: Factor) -> Result<(Term, Factor), ExpressionError> {
        let start = match self.peek() {
            Some('-' | '+') => self.at,
            _ => return self.power(before),
        };
        let negative = self.rest().starts_with('-');
        self.at += 1;
        let (inner, literal) = self.deeper(|p| p.signed(before))?;
        let span = start..inner.span.end;
        let kind = match negative {
            true => TermKind::Negative(Box::new(inner)),
            false => inner.kind,
        };
        Ok((Term { span, kind }, literal))
    }

    fn power(&mut self, before: Factor) -> Result<(Term, Factor), ExpressionError> {
        let (base, literal) = self.atom(before)?;
        if !self.take('^') {
            return Ok((base, literal));
        }
        let (exponent, _) = self.deeper(|p| p.signed(Factor::Other))?;
        Ok((binary(Operation::Power, base, exponent), literal))
    }

    fn atom(&mut self, before: Factor) -> Result<(Term, Factor), ExpressionError> {
        let next = self.peek();
        let start = self.at;
        let Some(c) = next else {
            let end = self.text.trim_end().len();
            let message = match end {
                0 => "an expression is missing",
                _ => "a value is missing at the end",
            };
            return Err(error(end.saturating_sub(1)..end, message.to_owned()));
        };
        match c {
            '0'..='9' | '.' => self.number(),
            '(' => {
                self.at += 1;
                let (inner, factor) = self.deeper(|p| match before {
                    // The unit below a fraction, `2 mm^3/(N m)`.
                    Factor::Unit | Factor::Divisor => p.units_or_sum(before),
                    Factor::Number | Factor::Other => Ok((p.sum()?, Factor::Other)),
                })?;
                if !self.take(')') {
                    let message = "this `(` is not closed by `)`".to_owned();
                    return Err(error(start..start + 1, message));
                }
                let span = start..self.at;
                let kind = inner.kind;
                Ok((Term { span, kind }, factor))
            }
            '{' => {
                self.at += 1;
                let inside = self.rest().split_once('}').map(|(name, _)| name);
                let Some(name) = inside else {
                    let message = "this `{` is not closed by `}`".to_owned();
                    return Err(error(start..start + 1, message));
                };
                self.at += name.len() + 1;
                Ok((self.name(name.trim(), start..self.at)?, Factor::Other))
            }
            c if begins_name(c) => self.word(before),
            _ => Err(error(
                self.here(),
                format!("a value is missing before this `{c}`"),
            )),
        }
    }

    /// Parses a number, with its unit if it has one.
    fn number(&mut self) -> Result<(Term, Factor), ExpressionError> {
        let start = self.at;
        let (length, _) = quantity::parts(self.rest());
        let Some(value) = quantity::number(&self.rest()[..length]) else {
            return Err(error(self.here(), "a number is missing here".to_owned()));
        };
        self.at += length;
        let end = self.at;
        let (unit, span) = self.unit();
        if unit.is_empty() {
            self.blank();
            let rest = self.rest();
            let word = &rest[..rest.find(|c| !continues_name(c)).unwrap_or(rest.len())];
            let both = self.names.contains(&word) && units::known(word).is_ok();
            if self.with_units && !word.is_empty() && both {
                return Err(error(self.at..self.at + word.len(), two_meanings(word)));
            }
            self.at = end;
            let kind = TermKind::Amount(Amount::number(value));
            let span = start..end;
            return Ok((Term { span, kind }, Factor::Number));
        }
        if !self.with_units {
            let message = format!("`{unit}` after a number: names and numbers here have no units");
            return Err(error(span, message));
        }
        let amount = Amount::of(value, &unit).map_err(|wrong| ExpressionError {
            message: wrong.message,
            span,
            nearest: wrong.nearest,
        })?;
        let span = start..self.at;
        let kind = TermKind::Amount(amount);
        Ok((Term { span, kind }, Factor::Unit))
    }

    /// Takes the words of a unit, with their powers: `N m`, `mm^2`, `%`. The first may be any word,
    /// the others are known units, and no names.
    fn unit(&mut self) -> (String, Range<usize>) {
        self.blank();
        let (start, mut end) = (self.at, self.at);
        let mut unit = String::new();
        loop {
            self.blank();
            let rest = self.rest();
            let symbol = |c: char| c == '%' || c == '\u{b0}' || c.is_alphabetic();
            let (word, after) = rest.split_at(rest.find(|c| !symbol(c)).unwrap_or(rest.len()));
            let name = &rest[..rest.find(|c| !continues_name(c)).unwrap_or(rest.len())];
            let other = self.names.contains(&name) || after.trim_start().starts_with('(');
            let first = unit.is_empty();
            if word.is_empty() || other || !first && units::known(word).is_err() {
                break;
            }
            let length = word.len() + power_length(after);
            if !first {
                unit.push(' ');
            }
            unit += &rest[..length];
            self.at += length;
            end = self.at;
        }
        self.at = end;
        (unit, start..end)
    }

    /// Parses units in parentheses after a `/`, or any expression.
    fn units_or_sum(&mut self, before: Factor) -> Result<(Term, Factor), ExpressionError> {
        let start = self.at;
        let (unit, span) = self.unit();
        let closed = self.peek() == Some(')');
        if closed
            && !unit.is_empty()
            && let Ok(amount) = Amount::of(1.0, &unit)
        {
            if before == Factor::Divisor {
                return Err(error(span, of_divisor(&unit)));
            }
            let kind = TermKind::Amount(amount);
            return Ok((Term { span, kind }, Factor::Unit));
        }
        self.at = start;
        Ok((self.sum()?, Factor::Other))
    }

    /// Parses a function call, a name, a constant, or a unit where one may stand: after a number,
    /// as in `2 N/m`.
    fn word(&mut self, before: Factor) -> Result<(Term, Factor), ExpressionError> {
        let start = self.at;
        let length = self.rest().find(|c| !continues_name(c));
        let word = &self.rest()[..length.unwrap_or(self.rest().len())];
        self.at += word.len();
        let span = start..self.at;
        if self.peek() == Some('(') {
            return Ok((self.call(word, span)?, Factor::Other));
        }
        self.at = span.end;
        // `2 N/m` looks like a unit, `2 N / m` like a quotient.
        let mut left = self.text[..start].chars().rev();
        let close = left.next().is_some_and(|c| "*/".contains(c))
            && left.next().is_some_and(|c| !c.is_whitespace());
        let after_unit = matches!(before, Factor::Unit | Factor::Divisor);
        let unit = after_unit && close && self.with_units && units::known(word).is_ok();
        if unit && self.names.contains(&word) {
            return Err(error(span, two_meanings(word)));
        }
        if unit && before == Factor::Divisor {
            return Err(error(span, of_divisor(word)));
        }
        if unit {
            self.at = start;
            let (unit, span) = self.unit();
            if let Ok(amount) = Amount::of(1.0, &unit) {
                let kind = TermKind::Amount(amount);
                return Ok((Term { span, kind }, Factor::Unit));
            }
        }
        Ok((self.name(word, span)?, Factor::Other))
    }

    fn call(&mut self, word: &str, span: Range<usize>) -> Result<Term, ExpressionError> {
        let Some(function) = Function::named(word) else {
            return Err(ExpressionError {
                message: format!("there is no function `{word}`"),
                span,
                nearest: nearest(word, Function::names()).map(str::to_owned),
            });
        };
        let open = self.at;
        self.at += 1;
        let mut arguments = Vec::new();
        self.deeper(|p| {
            loop {
                arguments.push(p.sum()?);
                if !p.take(',') {
                    return Ok(());
                }
            }
        })?;
        if !self.take(')') {
            let message = "this `(` is not closed by `)`".to_owned();
            return Err(error(open..open + 1, message));
        }
        if arguments.len() != function.count() {
            let message = format!(
                "`{word}` takes {} values, and there are {}",
                function.count(),
                arguments.len()
            );
            return Err(error(span.start..self.at, message));
        }
        Ok(Term {
            span: span.start..self.at,
            kind: TermKind::Call(function, arguments),
        })
    }

    /// Makes the term of a name or a constant.
    fn name(&mut self, word: &str, span: Range<usize>) -> Result<Term, ExpressionError> {
        if let Some(name) = self.names.iter().position(|n| *n == word) {
            if !self.needs.contains(&name) {
                self.needs.push(name);
            }
            let kind = TermKind::Name(name);
            return Ok(Term { span, kind });
        }
        if let Some(value) = constant(word) {
            let kind = TermKind::Amount(Amount::number(value));
            return Ok(Term { span, kind });
        }
        let near = nearest(word, self.names.iter().copied());
        let message = if Function::named(word).is_some() {
            format!("`{word}` is a function: its values stand in parentheses, `{word}(...)`")
        } else if self.with_units && near.is_none() && units::known(word).is_ok() {
            format!("`{word}` is not known as a name; a unit stands after a number, `1 {word}`")
        } else if self.names.is_empty() {
            format!(
                "`{word}` in `{}` is not known; there are no names",
                self.text
            )
        } else {
            format!(
                "`{word}` in `{}` is not known; there are {}",
                self.text,
                self.names.join(", ")
            )
        };
        Err(ExpressionError {
            message,
            span,
            nearest: near.map(str::to_owned),
        })
    }
}

/// Length of the power of a unit at the start of a text: `^-2`, `2`, `²`.
fn power_length(text: &str) -> usize {
    let marked = text.strip_prefix('^');
    let digits = marked.unwrap_or(text);
    let unsigned = match marked {
        Some(_) => digits.strip_prefix('-').unwrap_or(digits),
        None => digits,
    };
    let plain = unsigned.bytes().take_while(u8::is_ascii_digit).count();
    if plain > 0 {
        return text.len() - unsigned.len() + plain;
    }
    let raised = |c: char| matches!(c, '\u{b2}' | '\u{b3}' | '\u{b9}' | '\u{207b}');
    text.find(|c| !raised(c)).unwrap_or(text.len())
}

fn binary(operation: Operation, left: Term, right: Term) -> Term {
    Term {
        span: left.span.start..right.span.end,
        kind: TermKind::Binary(operation, Box::new([left, right])),
    }
}
