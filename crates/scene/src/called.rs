//! Names of bodies in messages about a scene.

use fretwork_core::view::RunView;

/// Describes a body by its name in the case, or a grain, which has no name, by its position;
/// applies to rigid and deformable bodies.
pub(super) fn body(s: &dyn RunView, body: u32) -> String {
    let bodies = s.bodies();
    let carrier = bodies.carrier(body as usize);
    let system = carrier.and_then(|c| s.system(c.system as usize));
    let driven = bodies.driven.iter().find(|d| d.body == body);
    match (driven, system.filter(|system| !system.is_grain())) {
        (Some(driven), _) => format!("the body `{}`", driven.name),
        (None, Some(system)) => format!("the body `{}`", system.name()),
        (None, None) => {
            let at = s.motion(body as usize).position;
            format!("the grain at {:?} m", &at[..s.dimension()])
        }
    }
}
