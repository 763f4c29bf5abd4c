//! Check for bodies that stand in each other deeper than the distance within which contacts are
//! looked for: their points would never meet the surface that they are behind, or, within a grain,
//! would be pushed out from there.

use super::build::Origin;
use super::called;
use super::source::ValidationError;
use fretwork_core::contact::detect;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;

/// How far behind a surface points are looked for in space, in their sizes: searches cost the
/// square of it there.
const SIZES: f64 = 20.0;

/// Checks the points of deformable bodies.
///
/// # Errors
/// The first point that lies behind a surface.
pub(super) fn points<S: Space>(
    s: &Simulation<S>,
    origins: &[Origin],
) -> Result<(), ValidationError> {
    let bodies = &s.state.bodies;
    let system = |body: u32| bodies.carrier(body as usize).map(|c| c.system);
    for point in s.shapes.balls.iter().filter(|b| b.radius == 0.0) {
        let centre = detect::centre(point, bodies);
        let own = system(point.body);
        let length = own.and_then(|k| s.state.systems.get(k as usize));
        let reach = match S::D {
            2 => length.map_or(0.0, |s| 2.0 * s.length()),
            _ => SIZES * bodies.length[point.body as usize],
        };
        for surface in &s.shapes.surfaces {
            let other = surface.body as usize;
            let apart = own != system(surface.body);
            if !apart || s.table.get(point.material, surface.material).is_none() {
                continue;
            }
            let arm = S::unrotate(&bodies.rotation[other], &(centre - bodies.position[other]));
            let mut near = Vec::new();
            surface
                .shape
                .closest_points(&(arm - surface.offset), reach, &mut near);
            let nearest = near
                .iter()
                .min_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()));
            let depth = nearest.map_or(0.0, |touch| -touch.distance);
            if depth > s.state.network.alert {
                let message = format!(
                    "points of {} lie {depth:.3e} m behind the surface of {} at the start, beyond the alert distance; move them apart",
                    called::body(s, point.body),
                    called::body(s, surface.body)
                );
                let place = origins.get(point.body as usize);
                let place = place.map_or_else(|| "elastic".to_owned(), |o| o.path());
                return Err(ValidationError::new(place, message));
            }
        }
    }
    Ok(())
}
