//! Named values of a text, `let: {"p0": "1.12 GPa", "L": "2 mm"}`, and the expressions in them that
//! stand for numbers, `"${p0 * L}"`.

use std::cell::RefCell;
use std::ops::Range;

use super::tree::{Entry, Group, Node, Shape, ValueKind, unquoted};
use super::{InputError, Source, nearest};
use crate::expression::{self, Expression, ExpressionError};
use crate::quantity;
use crate::units::Amount;

/// Key of the named values at the top of a text.
pub(super) const LET: &str = "let";

/// The named values of a text.
#[derive(Debug, Default)]
pub(super) struct NamedValues {
    names: Vec<String>,
    values: Vec<Option<Amount>>,
    keys: Vec<Range<usize>>,
    used: RefCell<Vec<bool>>,
    /// Bytes of the text that hold them, with their comma.
    pub whole: Option<Range<usize>>,
}

/// An expression and its place: where its bytes are in the text, unless escapes move them.
struct Written {
    text: String,
    span: Range<usize>,
    offset: Option<usize>,
}

impl Written {
    /// The content of a text of the tree.
    fn of(source: &Source, node: &Node) -> Self {
        let raw = &source.text[node.span.clone()];
        let text = node.string(&source.text).unwrap_or_default();
        let plain = raw.len() == text.len() + 2 && raw[1..].starts_with(&text);
        Self {
            text,
            span: node.span.clone(),
            offset: plain.then_some(node.span.start + 1),
        }
    }

    /// The part in `${...}`; `None` if that is not the whole text.
    fn inside(&self) -> Option<Self> {
        let inner = self.text.trim().strip_prefix("${")?.strip_suffix('}')?;
        let before = self.text.find("${")? + 2;
        Some(Self {
            text: inner.to_owned(),
            span: self.span.clone(),
            offset: self.offset.map(|offset| offset + before),
        })
    }

    fn error(&self, source: &Source, wrong: ExpressionError) -> InputError {
        let span = match self.offset {
            Some(offset) => offset + wrong.span.start..offset + wrong.span.end,
            None => self.span.clone(),
        };
        let error = source.error_in(&span, wrong.message);
        error.did_you_mean(wrong.nearest.as_deref())
    }
}

/// Returns whether a text of the tree holds an expression.
pub(super) fn has_expression(text: &str, node: &Node) -> bool {
    matches!(node.kind, ValueKind::Text) && text[node.span.clone()].contains("${")
}

/// The entry of the named values.
fn entry<'a>(source: &Source, root: Option<&'a Node>) -> Option<(&'a Entry, usize)> {
    let group = root?.group()?;
    let named = |e: &Entry| {
        e.key
            .as_ref()
            .is_some_and(|key| &source.text[key.clone()] == LET)
    };
    let at = group.entries.iter().position(named)?;
    Some((&group.entries[at], at))
}

impl Source {
    /// Whether the text has named values.
    pub(super) fn has_named_values(&self) -> bool {
        entry(self, self.tree.root.as_ref()).is_some()
    }

    /// Returns the named values of the text.
    ///
    /// # Errors
    /// A name is no name, given twice or that of a unit or function; a value is no amount, or
    /// follows from itself.
    pub(super) fn named_values(&self) -> Result<NamedValues, InputError> {
        let root = self.tree.root.as_ref();
        let Some((entry, at)) = entry(self, root) else {
            return Ok(NamedValues::default());
        };
        // As a struct too: names need no quotes.
        let names = |g: &&Group| matches!(g.shape, Shape::Map | Shape::Struct);
        let group = entry.value.group().filter(names);
        let Some(group) = group else {
            let error = self.error_in(&entry.value.head(&self.text), "`let` is no map of names");
            return Err(error.expected("`let: {\"p0\": \"1.12 GPa\", \"L\": \"2 mm\"}`"));
        };
        if let Some(repeated) = self.repeated_key() {
            return Err(repeated);
        }
        let mut out = NamedValues {
            whole: Some(self.with_comma(root, at)),
            ..NamedValues::default()
        };
        for entry in &group.entries {
            let key = entry.key.clone().unwrap_or_default();
            let name = unquoted(&self.text[key.clone()]);
            self.check_name(&name, &key)?;
            out.names.push(name);
            out.keys.push(key);
        }
        let nodes: Vec<&Node> = group.entries.iter().map(|e| &e.value).collect();
        let count = nodes.len();
        out.values = vec![None; count];
        out.used = RefCell::new(vec![false; count]);
        let mut expressions = Vec::with_capacity(count);
        for (k, node) in nodes.iter().enumerate() {
            expressions.push(self.definition(node, &mut out, k)?);
        }
        // Values that use no other ones are known; the others follow from them.
        let mut left: Vec<usize> = (0..count).filter(|&k| out.values[k].is_none()).collect();
        while !left.is_empty() {
            let before = left.len();
            let mut later = Vec::new();
            for &k in &left {
                let Some((written, expression)) = &expressions[k] else {
                    continue;
                };
                match expression.needs().iter().all(|&n| out.values[n].is_some()) {
                    true => {
                        let amount = expression.amount(&|n| out.values[n]);
                        out.values[k] = Some(amount.map_err(|e| written.error(self, e))?);
                    }
                    false => later.push(k),
                }
            }
            if later.len() == before {
                return Err(self.circle(&out, &expressions, &later));
            }
            left = later;
        }
        Ok(out)
    }

    /// Reads the value of a name: an amount is known at once, an expression later.
    fn definition(
        &self,
        node: &Node,
        out: &mut NamedValues,
        k: usize,
    ) -> Result<Option<(Written, Expression)>, InputError> {
        let written = match node.kind {
            ValueKind::Number | ValueKind::Quantity(_) => Written {
                text: self.text[node.span.clone()].to_owned(),
                span: node.span.clone(),
                offset: Some(node.span.start),
            },
            ValueKind::Text => {
                let whole = Written::of(self, node);
                whole.inside().unwrap_or(whole)
            }
            _ => {
                let message = format!("the value of `{}` is no amount", out.names[k]);
                let error = self.error_in(&node.head(&self.text), message);
                return Err(error.expected("a number, `\"2 mm\"`, or an expression, `\"2 * L\"`"));
            }
        };
        if let Some(Ok(_)) = quantity::si_quantity(&written.text) {
            let (number, all) = quantity::parts(written.text.trim());
            let text = written.text.trim();
            let value = quantity::number(&text[..number]).unwrap_or(f64::NAN);
            out.values[k] = Amount::of(value, text[number..all].trim()).ok();
            return Ok(None);
        }
        let expression = Expression::parse(&written.text, &out.names);
        let expression = expression.map_err(|e| written.error(self, e))?;
        out.use_names(&expression);
        Ok(Some((written, expression)))
    }

    /// Refuses names that expressions could not use, or would take for something else.
    fn check_name(&self, name: &str, key: &Range<usize>) -> Result<(), InputError> {
        let wrong = |message: String| Err(self.error_in(key, message));
        if !expression::is_name(name) {
            let error = wrong(format!("`{name}` cannot be a name in expressions"));
            return error.map_err(|e| e.expected("letters, digits and `_`, with a letter first"));
        }
        if expression::is_taken(name) {
            return wrong(format!(
                "`{name}` is a function or constant: choose another name"
            ));
        }
        Ok(())
    }

    /// An error at values that follow from each other.
    fn circle(
        &self,
        out: &NamedValues,
        expressions: &[Option<(Written, Expression)>],
        left: &[usize],
    ) -> InputError {
        // Each value that is left needs another one of them: the way leads into a circle.
        let mut way = vec![left[0]];
        loop {
            let last = way[way.len() - 1];
            let needs = expressions[last].as_ref().map(|(_, e)| e.needs());
            let next = needs.and_then(|n| n.iter().copied().find(|n| left.contains(n)));
            let next = next.unwrap_or(last);
            if let Some(first) = way.iter().position(|&k| k == next) {
                way.drain(..first);
                way.push(next);
                break;
            }
            way.push(next);
        }
        let names: Vec<String> = way.iter().map(|&k| format!("`{}`", out.names[k])).collect();
        let message = match names.len() {
            2 => format!("the value of {} follows from itself", names[0]),
            _ => format!(
                "values follow from each other in a circle: {}",
                names.join(" from ")
            ),
        };
        self.error_in(&out.keys[way[0]], message)
    }

    /// The bytes of an entry of the root with the comma that separates it.
    fn with_comma(&self, root: Option<&Node>, at: usize) -> Range<usize> {
        let entries = root.and_then(Node::group).map_or(&[][..], |g| &g.entries);
        let begin = |e: &Entry| e.key.as_ref().map_or(e.value.span.start, |key| key.start);
        let entry = &entries[at];
        match (
            entries.get(at + 1),
            at.checked_sub(1).and_then(|k| entries.get(k)),
        ) {
            (Some(next), _) => begin(entry)..begin(next),
            (None, Some(last)) => last.value.span.end..entry.value.span.end,
            (None, None) => begin(entry)..entry.value.span.end,
        }
    }

    /// Returns the value of the expression that is the whole of a text, and how it is written.
    ///
    /// # Errors
    /// A name is unknown, or dimensions do not fit.
    pub(super) fn amount_of(
        &self,
        node: &Node,
        names: &NamedValues,
    ) -> Result<Option<(Amount, String)>, InputError> {
        let Some(written) = Written::of(self, node).inside() else {
            return Ok(None);
        };
        let expression = Expression::parse(&written.text, &names.names);
        let expression = expression.map_err(|e| written.error(self, e))?;
        names.use_names(&expression);
        let amount = expression.amount(&|n| names.values[n]);
        let amount = amount.map_err(|e| written.error(self, e))?;
        Ok(Some((amount, written.text.trim().to_owned())))
    }

    /// Refuses names that no expression uses, which are mostly misspelt. A `--set` may have taken
    /// the place of the expression that used a name of the file.
    pub(super) fn refuse_unused(&self, names: &NamedValues) -> Result<(), InputError> {
        let used = names.used.borrow();
        let set = |k: usize| self.source_map.place(&names.keys[k]).set.is_some();
        let unused = |k: &usize| !used[*k] && (self.sets.is_empty() || set(*k));
        let Some(k) = (0..used.len()).find(unused) else {
            return Ok(());
        };
        let name = &names.names[k];
        let others = names.names.iter().zip(used.iter());
        let others = others.filter(|(_, used)| **used).map(|(n, _)| n.as_str());
        let message = format!("`{name}` is not used by any expression");
        let error = self.error_in(&names.keys[k], message);
        let error = error.help(format!("use it, `\"${{{name}}}\"`, or remove it"));
        Err(error.did_you_mean(nearest(name, others)))
    }
}

impl NamedValues {
    fn use_names(&self, expression: &Expression) {
        let mut used = self.used.borrow_mut();
        for &name in expression.needs() {
            used[name] = true;
        }
    }

    /// Uses the names of a text that stays a text.
    pub fn use_in_text(&self, text: &str) {
        let mut used = self.used.borrow_mut();
        for (name, used) in self.names.iter().zip(used.iter_mut()) {
            *used |= text.contains(name.as_str());
        }
    }
}
