//! The alert distance of a case, compared with the range of attraction of its laws.

use crate::case::Case;
use crate::source::{InputError, Source, ValidationError};
use fretwork_core::laws::Interface;

/// Returns the alert distance of a case (m): the given one, or the largest of `needed` and the
/// distances that laws with a `range` need.
///
/// # Errors
/// Fails if a law attracts beyond the given distance, where no contact is known: its range would
/// then depend on that distance.
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
            // Without a range in the case, a law acts as far as contacts are known; a given range
            // is intended.
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
