//! Parameters of the laws of a scene: their values, and where these come from.

use super::case::Case;
use fretwork_core::laws::{Kind, LawField, LoadedLaw, ParameterOrigin};
use fretwork_core::view::RunView;

/// A parameter of a law of an interface.
#[derive(Clone, Debug)]
pub struct LawInput<'a> {
    /// Name of the interface.
    pub interface: &'a str,
    /// The law.
    pub law: &'a LoadedLaw,
    /// The parameter, as the law declares it.
    pub field: &'a LawField,
    /// Value, in the unit of the law.
    pub value: f64,
    /// Where it comes from; `None` for a law that was not made from a case.
    pub origin: Option<&'a ParameterOrigin>,
}

impl LawInput<'_> {
    /// Returns the value as a reader writes it, with five digits where it has many.
    pub fn number(&self) -> String {
        const WIDE: usize = 10;
        let value = self.value;
        let text = match value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
            true => format!("{value}"),
            false => format!("{value:e}"),
        };
        match text.len() > WIDE {
            true => format!("{value:.4e}"),
            false => text,
        }
    }
}

/// Returns the parameters of all laws, in the order of the interfaces and of each law's schema.
pub fn of(s: &dyn RunView) -> Vec<LawInput<'_>> {
    let mut out = Vec::new();
    for interface in s.laws() {
        for law in interface.loaded() {
            let fields = law.plugin.parameters.iter().zip(&law.parameters);
            out.extend(fields.enumerate().map(|(k, (field, value))| LawInput {
                interface: &interface.name,
                law,
                field,
                value: *value,
                origin: law.origins.get(k),
            }));
        }
    }
    out
}

/// Returns a sentence for each interface whose wear law is left out, since the material that gives
/// its parameters has no coefficient for it.
pub fn unmeasured(case: &Case, s: &dyn RunView) -> Vec<String> {
    let pairs = case.interfaces.iter().zip(s.laws());
    let left_out = pairs.filter_map(|(spec, built)| {
        let law = spec.law(Kind::WEAR).filter(|_| built.wear().is_none())?;
        let from = spec.parameters_from.as_deref()?;
        let file = case.materials.get(from).map_or(from, String::as_str);
        Some(format!(
            "`{}`: the material `{file}` has no measured coefficient of the wear law `{law}`, so no wear is computed there; give `K` with its source in the `laws` of the material, or in `parameters` of the interface",
            spec.name
        ))
    });
    left_out.collect()
}

/// Whether the main results follow from a parameter, so that its default is a guess at the answer:
/// what laws declare as friction coefficients, and all parameters of wear laws.
fn decides(kind: Kind, field: &LawField) -> bool {
    kind == Kind::WEAR || field.friction
}

/// Returns a sentence for each law with parameters on which the main results depend, and which have
/// the defaults of the law. A friction coefficient that a phase sets is given.
pub fn undecided(case: &Case, s: &dyn RunView) -> Vec<String> {
    let mut out: Vec<(&str, &LoadedLaw, Vec<String>)> = Vec::new();
    for input in of(s) {
        let kind = input.law.plugin.kind;
        let set = case
            .phases
            .iter()
            .any(|phase| phase.friction.contains_key(input.interface));
        let given = input.origin != Some(&ParameterOrigin::Default);
        let tabulated = !input.law.table.is_empty();
        if given || tabulated || !decides(kind, input.field) || (set && input.field.name == "mu") {
            continue;
        }
        let unit = match input.field.unit.as_str() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let value = format!("{} = {}{unit}", input.field.name, input.number());
        match out.last_mut() {
            Some((interface, law, values))
                if *interface == input.interface && std::ptr::eq(*law, input.law) =>
            {
                values.push(value);
            }
            _ => out.push((input.interface, input.law, vec![value])),
        }
    }
    let sentence = |(interface, law, values): (&str, &LoadedLaw, Vec<String>)| {
        let (kind, name) = (law.plugin.kind, &law.plugin.name);
        format!(
            "{} of the {kind} law `{name}` ({interface}) {} defaults of the law, on which the results depend: give measured values in `parameters`",
            values.join(", "),
            if values.len() == 1 {
                "is one of the"
            } else {
                "are"
            }
        )
    };
    out.into_iter().map(sentence).collect()
}
