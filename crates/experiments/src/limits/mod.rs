//! Where the theories of a patch end: radii that were typed in another unit, bodies that are no
//! half-spaces beside their patch, and pressures under which they do not stay elastic.

mod strength;

pub use strength::{BodyStrength, Strength, Traction, Yield, YieldKind};

/// Ratio of the largest semi-axis to a radius above which the parabola of Hertz' theory has an
/// error of more than about one per cent.
const FLAT: f64 = 0.1;

/// Returns a sentence for each body of which a semi-axis of the patch (m) along the motion or
/// across it is no longer small beside its radius; bodies have a name and their curvatures (1/m).
pub fn not_hertz<'a>(
    bodies: impl IntoIterator<Item = (&'a str, [f64; 2])>,
    axes: [Option<f64>; 2],
) -> Vec<String> {
    let mut out = Vec::new();
    for (name, curvatures) in bodies {
        for (axis, curvature) in axes.into_iter().zip(curvatures) {
            let Some(a) = axis.filter(|a| a * curvature.abs() > FLAT) else {
                continue;
            };
            let warning = format!(
                "NOT HERTZ: the patch, {a:.3e} m, is {:.2} of a radius of {name}; the theory takes it as small, and the bodies as half-spaces",
                a * curvature.abs()
            );
            // For a sphere both directions are the same.
            if !out.contains(&warning) {
                out.push(warning);
            }
        }
    }
    out
}

/// Radius (m) from which a number without a unit is likely to be in millimetres.
const LARGE: f64 = 10.0;

/// Returns a sentence on a radius that was written without a unit and is large for metres.
pub fn radius_in_metres(value: f64, written: &str) -> Option<String> {
    (value.is_finite() && value.abs() >= LARGE).then(|| {
        format!(
            "RADIUS IN METRES: `{written}` without a unit is {written} m; if it is in millimetres write {written}mm"
        )
    })
}
