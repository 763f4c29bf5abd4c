//! The parameters of the laws: values, units, and where they come from.

use super::CheckLine;
use crate::RunView;
use crate::laws::ParameterOrigin;
use crate::scene::law_inputs;

/// Characters of an origin that are shown.
const WIDE: usize = 100;

/// Returns a line for each parameter of each law; the first of a law has its interface, kind and
/// name.
pub fn lines(s: &dyn RunView) -> Vec<CheckLine> {
    let mut out = Vec::new();
    let mut before = None;
    for input in law_inputs::of(s) {
        let plugin = &input.law.plugin;
        let law = (input.interface, plugin.kind, &plugin.name);
        if before != Some(law) {
            let text = format!("{} {}", plugin.kind, plugin.name);
            out.push((input.interface.to_owned(), text));
            before = Some(law);
        }
        let origin = match input.origin {
            Some(ParameterOrigin::Given(origin)) => origin,
            Some(ParameterOrigin::Default) => "default of the law",
            None => "not known",
        };
        let origin = match origin.char_indices().nth(WIDE) {
            Some((cut, _)) => format!("{}...", &origin[..cut]),
            None => origin.to_owned(),
        };
        let unit = match input.field.unit.as_str() {
            "" => "-",
            unit => unit,
        };
        let (name, value) = (&input.field.name, input.number());
        out.push((
            String::new(),
            format!("{name:<18} {value:>12} {unit:<10} {origin}"),
        ));
    }
    out
}
