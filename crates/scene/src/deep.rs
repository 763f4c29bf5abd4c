//! Check for bodies that overlap by more than the search distance of contacts: contacts at such
//! points would not be found, or, within a grain, would push the points out.

use super::build::Origin;
use super::called;
use super::source::ValidationError;
use fretwork_core::view::RunSetup;

/// Distance behind a surface up to which points are searched in space, relative to their sizes: the
/// cost of a search is quadratic in it.
const SIZES: f64 = 20.0;

/// Checks the points of deformable bodies.
///
/// # Errors
/// Returns the first point that lies behind a surface.
pub(super) fn points(s: &dyn RunSetup, origins: &[Origin]) -> Result<(), ValidationError> {
    let Some(behind) = s.point_behind(SIZES) else {
        return Ok(());
    };
    let message = format!(
        "points of {} lie {:.3e} m behind the surface of {} at the start, beyond the alert distance; move them apart",
        called::body(s, behind.point),
        behind.depth,
        called::body(s, behind.surface)
    );
    let place = origins.get(behind.point as usize);
    let place = place.map_or_else(|| "elastic".to_owned(), |o| o.path());
    Err(ValidationError::new(place, message))
}
