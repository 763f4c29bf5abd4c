//! The parameters of the laws: values, units, and where they come from.

use super::CheckLine;
use crate::RunView;
use crate::laws::ParameterOrigin;
use crate::record::summary::wrapped;
use crate::scene::law_inputs;
use crate::scene::wear_coefficient::WearCoefficient;

/// Characters of a line of an origin.
const WIDE: usize = 100;

/// Returns a line for each parameter of each law; the first of a law has its interface, kind and
/// name. A parameter that follows from Archard's K has its derivation, with the hardness.
pub fn lines(s: &dyn RunView, wear: &[WearCoefficient]) -> Vec<CheckLine> {
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
        let derived = wear.iter().find(|w| {
            let own = (
                input.interface,
                plugin.name.as_str(),
                input.field.name.as_str(),
            );
            own == (w.interface.as_str(), w.law.as_str(), w.parameter.as_str())
        });
        let origin = match input.origin {
            _ if derived.is_some() => derived.map_or("", |w| w.derivation.as_str()),
            Some(ParameterOrigin::Given(origin)) => origin,
            Some(ParameterOrigin::Default) => "default of the law",
            None => "not known",
        };
        let mut origin = wrapped(origin, WIDE).into_iter();
        let first = origin.next().unwrap_or_default();
        let unit = match input.field.unit.as_str() {
            "" => "-",
            unit => unit,
        };
        let (name, value) = (&input.field.name, input.number());
        let line = |origin: &str| format!("{name:<18} {value:>12} {unit:<10} {origin}");
        out.push((String::new(), line(&first)));
        // A long origin goes on below itself.
        let margin = line("").chars().count();
        out.extend(origin.map(|rest| (String::new(), format!("{:margin$}{rest}", ""))));
    }
    out
}
