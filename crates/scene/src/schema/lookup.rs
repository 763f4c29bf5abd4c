//! What a schema says about a place of a case.

use serde_json::Value;

/// The schema of cases, for questions about a place.
#[derive(Clone, Debug)]
pub struct Schema(Value);

/// A name that may stand at a place, and what it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Described {
    /// The name of a field, variant or law.
    pub name: String,
    /// Documentation, with the default.
    pub doc: String,
    /// Whether it is a field, which a value follows.
    pub field: bool,
}

impl Schema {
    /// Wraps a schema of [`super::case`].
    pub fn new(schema: Value) -> Self {
        Self(schema)
    }

    /// Returns the documentation of the value at a path of fields, keys, elements and variants;
    /// `None` if the schema has no such path.
    pub fn doc(&self, path: &[String]) -> Option<String> {
        let (last, above) = path.split_last()?;
        let holders = self.at(above);
        let mut found = holders
            .iter()
            .filter_map(|holder| Some((*holder, self.step(holder, last)?)));
        let (holder, field) = found.next()?;
        match variant_of(holder) {
            // The documentation of a variant stands beside it.
            Some(_) => doc_of(holder, holder),
            None => doc_of(self.resolved(field), field),
        }
    }

    /// Returns the fields of the struct or map at a path.
    pub fn fields(&self, path: &[String]) -> Vec<Described> {
        let mut out: Vec<Described> = Vec::new();
        for place in self.at(path) {
            if variant_of(place).is_some() {
                continue;
            }
            let fields = place.get("properties").and_then(Value::as_object);
            for (name, field) in fields.into_iter().flatten() {
                if !out.iter().any(|d| d.name == *name) {
                    out.push(Described {
                        name: name.clone(),
                        doc: doc_of(self.resolved(field), field).unwrap_or_default(),
                        field: true,
                    });
                }
            }
        }
        out
    }

    /// Returns the variants, and the names of laws, that the value at a path may be.
    pub fn values(&self, path: &[String]) -> Vec<Described> {
        let mut out: Vec<Described> = Vec::new();
        let mut add = |name: &str, place: &Value| {
            if !out.iter().any(|d| d.name == name) {
                out.push(Described {
                    name: name.to_owned(),
                    doc: doc_of(place, place).unwrap_or_default(),
                    field: false,
                });
            }
        };
        for place in self.at(path) {
            if let Some(name) = place.get("const").and_then(Value::as_str) {
                add(name, place);
            }
            for name in place
                .get("enum")
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
            {
                if let Some(name) = name.as_str() {
                    add(name, place);
                }
            }
            if let Some(name) = variant_of(place) {
                add(name, place);
            }
        }
        out
    }

    /// All alternatives of the value at a path.
    fn at(&self, path: &[String]) -> Vec<&Value> {
        let mut places = vec![&self.0];
        for name in path {
            let all = places.iter().flat_map(|place| self.alternatives(place));
            let next: Vec<&Value> = all.filter_map(|place| self.step(place, name)).collect();
            places = next;
        }
        places
            .iter()
            .flat_map(|place| self.alternatives(place))
            .collect()
    }

    /// The schema that a reference means.
    fn resolved<'a>(&'a self, place: &'a Value) -> &'a Value {
        let name = place.get("$ref").and_then(Value::as_str);
        let name = name.and_then(|name| name.strip_prefix("#/$defs/"));
        let found = name.and_then(|name| self.0.get("$defs")?.get(name));
        found.unwrap_or(place)
    }

    /// The schemas one of which a value has, references resolved.
    fn alternatives<'a>(&'a self, place: &'a Value) -> Vec<&'a Value> {
        let mut out = Vec::new();
        let mut open = vec![place];
        // The schema is finite, and its references lead to objects or choices of them.
        while let Some(place) = open.pop() {
            let place = self.resolved(place);
            out.push(place);
            for key in ["anyOf", "oneOf", "allOf"] {
                let choices = place.get(key).and_then(Value::as_array);
                open.extend(choices.into_iter().flatten().rev());
            }
            if out.len() > 1000 {
                break;
            }
        }
        out
    }

    /// The schema of a field, key or element.
    fn step<'a>(&'a self, place: &'a Value, name: &str) -> Option<&'a Value> {
        let field = place.get("properties").and_then(|fields| fields.get(name));
        let rest = place
            .get("additionalProperties")
            .filter(|rest| rest.is_object());
        let index = name.parse::<usize>().ok();
        let listed = index.and_then(|k| place.get("prefixItems")?.get(k));
        field
            .or(rest)
            .or(listed)
            .or_else(|| place.get("items").filter(|items| items.is_object()))
    }
}

/// The name of the variant that an object with one key is.
fn variant_of(place: &Value) -> Option<&str> {
    let fields = place.get("properties")?.as_object()?;
    let name = fields.keys().next().filter(|_| fields.len() == 1)?;
    name.starts_with(char::is_uppercase)
        .then_some(name.as_str())
}

/// The documentation of a field: its own, or that of its type; and the default.
fn doc_of(kind: &Value, field: &Value) -> Option<String> {
    let own = |place: &Value| Some(place.get("description")?.as_str()?.to_owned());
    let doc = own(field).or_else(|| own(kind));
    let default = match field.get("default") {
        None | Some(Value::Null) => None,
        Some(default) => Some(format!("Default: `{default}`.")),
    };
    match (doc, default) {
        (Some(doc), Some(default)) => Some(format!("{doc}\n\n{default}")),
        (doc, default) => doc.or(default),
    }
}
