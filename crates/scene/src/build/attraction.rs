//! The alert distance of a case, against how far its laws attract.

use crate::case::Case;
use crate::source::{InputError, Source, ValidationError};
use fretwork_core::laws::Interface;

/// Returns the alert distance of a case (m): the given one, or the largest of `needed` and the
/// distances that laws with a `range` need.
///
/// # Errors
/// A law that attracts beyond the given one, where no contact is known: how far it acts would
/// depend on that.
pub(super) fn alert(
    source: &Source,
    case: &Case,
    laws: &[Interface],
    needed: f64,
) -> Result<f64, InputError> {
    let mut needed = needed;
    for (k, interface) in laws.iter().enumerate() {
        for law in interface.loaded() {
            let attracts = ["contact", "cohesion"].contains(&law.plugin.kind.word());
            let range = law.plugin.parameters.iter().position(|p| p.name == "range");
            let Some(at) = range.filter(|_| attracts) else {
                continue;
            };
            let range = law.parameters[at];
            // A range of the law's own goes as far as contacts are known; one that is given is
            // meant.
            let slot = law.plugin.kind.word();
            let given = range != law.plugin.parameters[at].default;
            match case.detection.alert {
                Some(alert) if given && range > alert => {
                    let message = format!(
                        "`{}` acts up to a gap of {range:e} m, and contacts are known up to {alert:e} m alone",
                        law.plugin.name
                    );
                    let fault = ValidationError::new(
                        format!("interfaces.{k}.parameters.{slot}.range"),
                        message,
                    );
                    return Err(source
                        .locate(fault.expected("at most `detection.alert`, or a larger `alert`")));
                }
                _ if given => needed = needed.max(range),
                _ => {}
            }
        }
    }
    Ok(case.detection.alert.unwrap_or(needed))
}
