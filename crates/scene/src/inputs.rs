//! Table of all inputs of a case: values from the file, and defaults of the others.

use crate::case::{Case, key_units};
use crate::source::{Group, Node, Shape, Source, Tree, ValueKind, fields_at};

/// Origin of the value of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputSource {
    /// The case gives it.
    Given,
    /// The default of the schema.
    Default,
    /// The case does not give it; there is then nothing of the kind, or the program chooses the
    /// value.
    NotSet,
}

/// A key of a case with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Path, as `--set` takes it.
    pub path: String,
    /// Value as in a case; empty if it is not set.
    pub value: String,
    /// SI unit, empty for pure numbers and texts.
    pub unit: &'static str,
    /// Origin of the value.
    pub from: InputSource,
}

/// Number of elements above which a list is one input.
const LONG: usize = 60;
/// Number of characters of a value that are kept.
const WIDE: usize = 160;

/// Returns the inputs of a case in the order of the schema, from its text with `--set` applied.
///
/// # Errors
/// The text is no case; in a sentence.
///
/// # Examples
/// ```
/// use fretwork_scene::inputs::{InputSource, of};
/// let text = r#"(name: "a", dimension: 2, time: (step: 1e-3, end: 0.1), materials: {}, interfaces: [])"#;
/// let inputs = of(text)?;
/// let find = |path: &str| inputs.iter().find(|i| i.path == path).unwrap();
/// let step = find("time.step");
/// let read = (step.value.as_str(), step.unit, step.from);
/// assert_eq!(read, ("0.001", "s", InputSource::Given));
/// assert_eq!(find("time.theta").from, InputSource::Default);
/// assert_eq!(find("friction").from, InputSource::NotSet);
/// # Ok::<(), String>(())
/// ```
pub fn of(text: &str) -> Result<Vec<Input>, String> {
    let source = Source::from_text("case", text);
    let case = Case::read(&source).map_err(|e| e.to_string())?;
    let full = case.to_ron().map_err(|e| e.to_string())?;
    let tree = Tree::of(&full);
    let mut walk = Walk {
        given: (source.text(), source.tree()),
        text: &full,
        tree: &tree,
        dimension: case.dimension,
        out: Vec::new(),
    };
    if let Some(root) = &tree.root {
        walk.visit(root, &mut WalkPosition::default());
    }
    Ok(walk.out)
}

/// Current position of the walk: the components of the path, the same with the names of variants
/// between them, and the variants at its end.
#[derive(Default)]
struct WalkPosition {
    path: Vec<String>,
    named: Vec<String>,
    variants: Vec<String>,
}

impl WalkPosition {
    fn within(&mut self, part: &str, walk: impl FnOnce(&mut Self)) {
        self.path.push(part.to_owned());
        self.named.push(part.to_owned());
        let variants = std::mem::take(&mut self.variants);
        walk(self);
        self.variants = variants;
        self.path.pop();
        self.named.pop();
    }
}

struct Walk<'a> {
    /// The text of the case, and its tree.
    given: (&'a str, &'a Tree),
    /// The case with all defaults, and its tree.
    text: &'a str,
    tree: &'a Tree,
    dimension: u32,
    out: Vec<Input>,
}

impl Walk<'_> {
    fn visit(&mut self, node: &Node, at: &mut WalkPosition) {
        let node = node.unwrap_some(self.text);
        let Some(group) = node.group() else {
            return self.leaf(&self.text[node.span.clone()], at);
        };
        let variant = group.name.as_ref().map(|name| &self.text[name.clone()]);
        let before = at.named.len();
        if let Some(name) = variant {
            at.named.push(name.to_owned());
            at.variants.push(name.to_owned());
        }
        match group.shape {
            // The content of a variant has the path of the variant.
            Shape::Tuple if group.entries.len() == 1 && variant.is_some() => {
                let only = &group.entries[0].value;
                match only.group() {
                    Some(inner) if inner.name.is_some() || inner.shape == Shape::Struct => {
                        self.visit(only, at);
                    }
                    _ => self.leaf(&self.text[node.span.clone()], at),
                }
            }
            Shape::Struct | Shape::Map => self.fields(group, at),
            Shape::List | Shape::Tuple if opens(group) => {
                for (k, entry) in group.entries.iter().enumerate() {
                    let name = named(&entry.value, self.text).unwrap_or_else(|| k.to_string());
                    at.within(&name, |at| self.visit(&entry.value, at));
                }
            }
            Shape::List if group.entries.len() > LONG => {
                let count = group.entries.len();
                self.leaf(&format!("list of {count}"), at);
            }
            _ => self.leaf(&self.text[node.span.clone()], at),
        }
        at.named.truncate(before);
        if variant.is_some() {
            at.variants.pop();
        }
    }

    /// Visits the fields of a struct or the entries of a map, then the fields that are not set.
    fn fields(&mut self, group: &Group, at: &mut WalkPosition) {
        if !at.variants.is_empty() {
            let closing = ")".repeat(at.variants.len() - 1);
            let shown = at.variants.join("(") + &closing;
            self.leaf(&shown, at);
        }
        let mut present = Vec::new();
        for entry in &group.entries {
            let Some(key) = &entry.key else { continue };
            let name = self.text[key.clone()].trim_matches('"').to_owned();
            at.within(&name, |at| self.visit(&entry.value, at));
            present.push(name);
        }
        if group.shape != Shape::Struct {
            return;
        }
        for name in fields_at::<Case>(self.text, self.tree.root.as_ref(), &at.path) {
            if !present.iter().any(|p| p == name) {
                at.within(name, |at| self.push(String::new(), at, InputSource::NotSet));
            }
        }
    }

    fn leaf(&mut self, value: &str, at: &WalkPosition) {
        let (text, tree) = self.given;
        let given = tree.find(text, &at.path).is_ok();
        let from = if given {
            InputSource::Given
        } else {
            InputSource::Default
        };
        let mut value: String = value.split_whitespace().collect::<Vec<_>>().join(" ");
        if let Some((cut, _)) = value.char_indices().nth(WIDE) {
            value.truncate(cut);
            value += " ...";
        }
        self.push(value, at, from);
    }

    fn push(&mut self, value: String, at: &WalkPosition, from: InputSource) {
        let parts: Vec<String> = at.path.iter().map(|p| quoted(p)).collect();
        self.out.push(Input {
            path: parts.join("."),
            value,
            unit: key_units::of(&at.named, self.dimension as usize).unwrap_or_default(),
            from,
        });
    }
}

/// Whether the elements of a list are inputs of their own.
fn opens(group: &Group) -> bool {
    let entries = &group.entries;
    let holds = |kind: &ValueKind| matches!(kind, ValueKind::Group(g) if g.shape == Shape::Struct || g.name.is_some());
    !entries.is_empty() && entries.len() <= LONG && entries.iter().any(|e| holds(&e.value.kind))
}

/// The `name` of an element of a list.
fn named(node: &Node, text: &str) -> Option<String> {
    let mut node = node.unwrap_some(text);
    loop {
        let group = node.group()?;
        match (group.shape, group.entries.as_slice()) {
            (Shape::Struct, entries) => {
                let is_name = |key: &std::ops::Range<usize>| &text[key.clone()] == "name";
                let entry = entries
                    .iter()
                    .find(|e| e.key.as_ref().is_some_and(is_name))?;
                return entry.value.string(text);
            }
            (Shape::Tuple, [only]) => node = &only.value,
            _ => return None,
        }
    }
}

fn quoted(part: &str) -> String {
    if part.contains('.') {
        format!("\"{part}\"")
    } else {
        part.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = r#"(
        name: "a", dimension: 2, time: (step: 1e-3, end: 0.1),
        materials: {"steel": "rail_steel_r260"},
        interfaces: [(name: "dry", between: ("steel", "steel"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
        bodies: [(
            name: "slider", material: "steel", shapes: [HalfSpace(normal: (0, 1))], mass: 2.0,
            dofs: (x: Displacement(Sine(amplitude: 1e-5, frequency: 20)), y: Force(-3.0)),
        )],
    )"#;

    fn find(inputs: &[Input], path: &str) -> Input {
        let found = inputs.iter().find(|i| i.path == path);
        found
            .unwrap_or_else(|| panic!("no {path} in {inputs:#?}"))
            .clone()
    }

    #[test]
    fn every_key_has_a_value_a_unit_and_an_origin() {
        let inputs = of(CASE).unwrap();
        for (path, value, unit, from) in [
            ("time.step", "0.001", "s", InputSource::Given),
            ("time.theta", "0.5", "", InputSource::Default),
            ("solver.max_iterations", "10000", "", InputSource::Default),
            ("solver.tolerance", "", "", InputSource::NotSet),
            ("bodies.slider.mass", "2.0", "kg/m", InputSource::Given),
            ("bodies.slider.inertia", "", "kg m", InputSource::NotSet),
            (
                "bodies.slider.dofs.x",
                "Displacement(Sine)",
                "",
                InputSource::Given,
            ),
            (
                "bodies.slider.dofs.x.amplitude",
                "1e-5",
                "m",
                InputSource::Given,
            ),
            (
                "bodies.slider.dofs.x.frequency",
                "20.0",
                "Hz",
                InputSource::Given,
            ),
            (
                "bodies.slider.dofs.x.offset",
                "0.0",
                "m",
                InputSource::Default,
            ),
            (
                "interfaces.dry.contact",
                "\"coulomb\"",
                "",
                InputSource::Given,
            ),
            (
                "interfaces.dry.parameters.contact.mu",
                "0.3",
                "",
                InputSource::Given,
            ),
            ("periodic", "", "", InputSource::NotSet),
            ("output.views", "20", "", InputSource::Default),
        ] {
            let input = find(&inputs, path);
            assert_eq!(
                (input.value.as_str(), input.unit, input.from),
                (value, unit, from),
                "{path}"
            );
        }
    }

    #[test]
    fn no_key_is_listed_twice_and_what_is_not_a_case_is_an_error() {
        let inputs = of(CASE).unwrap();
        let mut paths: Vec<&str> = inputs.iter().map(|i| i.path.as_str()).collect();
        let count = paths.len();
        paths.sort_unstable();
        paths.dedup();
        assert_eq!(paths.len(), count);
        assert!(of("(name: 3)").is_err() && of("").is_err());
    }
}
