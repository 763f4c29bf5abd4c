//! Validation of a case's biaxial test: it needs four flat walls that face each other along two
//! axes.

use super::case::{BiaxialSpec, BodySpec, Case, ShapeSpec};
use super::source::{ValidationError, nearest};
use fretwork_core::bodies::Dof;

/// Checks that the test can be measured on the walls it names.
///
/// # Errors
/// Returns the first error, with its path in the case.
pub(super) fn check(case: &Case) -> Result<(), ValidationError> {
    let Some(test) = &case.biaxial else {
        return Ok(());
    };
    if case.dimension != 2 {
        let message = "a biaxial test needs two dimensions";
        return Err(ValidationError::new("biaxial", message));
    }
    if !(test.start.is_finite() && test.start < case.time.end) {
        let message = format!("the test starts at {} s, after the run ends", test.start);
        return Err(ValidationError::new("biaxial.start", message)
            .expected(format!("a time before {} s", case.time.end)));
    }
    let names = names(test);
    for (k, (path, name)) in names.iter().enumerate() {
        if names[..k].iter().any(|n| n.1 == *name) {
            let message = format!("the wall `{name}` is named twice");
            return Err(ValidationError::new(*path, message).expected("four different walls"));
        }
    }
    let mut axes = [0; 2];
    for pair in 0..2 {
        let (low, high) = (names[2 * pair], names[2 * pair + 1]);
        let (axis, side) = facing(case, low)?;
        if side < 0.0 {
            let message = format!(
                "the open side of the wall `{}` must face `{}`",
                low.1, high.1
            );
            return Err(ValidationError::new(low.0, message)
                .expected("the low wall first, then the high one"));
        }
        let (other, side) = facing(case, high)?;
        if other != axis || side > 0.0 {
            let message = format!(
                "the walls `{}` and `{}` do not face each other",
                low.1, high.1
            );
            return Err(ValidationError::new(high.0, message));
        }
        axes[pair] = axis;
    }
    if axes[0] == axes[1] {
        let message = "the lateral walls stand across the same axis as the axial ones";
        return Err(ValidationError::new("biaxial.lateral", message));
    }
    Ok(())
}

/// The walls with their paths: axial low and high, lateral low and high.
fn names(test: &BiaxialSpec) -> [(&'static str, &str); 4] {
    [
        ("biaxial.axial.0", &test.axial.0),
        ("biaxial.axial.1", &test.axial.1),
        ("biaxial.lateral.0", &test.lateral.0),
        ("biaxial.lateral.1", &test.lateral.1),
    ]
}

/// Returns the axis normal to a wall, and the sign of the wall's normal along it.
fn facing(case: &Case, (path, name): (&str, &str)) -> Result<(usize, f64), ValidationError> {
    let Some(body) = case.bodies.iter().find(|b| b.name == name) else {
        let all: Vec<&str> = case.bodies.iter().map(|b| b.name.as_str()).collect();
        return Err(
            ValidationError::new(path, format!("there is no body `{name}`"))
                .expected_name(all.iter().copied(), "bodies")
                .nearest(nearest(name, all.iter().copied())),
        );
    };
    flat(body).ok_or_else(|| {
        let message = format!("the wall `{name}` is not flat, upright or level, and unturning");
        ValidationError::new(path, message)
            .expected("a body of one HalfSpace with its normal along x or y and `rz` fixed")
    })
}

fn flat(body: &BodySpec) -> Option<(usize, f64)> {
    let [ShapeSpec::HalfSpace { normal, .. }] = body.shapes.as_slice() else {
        return None;
    };
    let [x, y] = normal.as_slice() else {
        return None;
    };
    if body.dofs.rz != Dof::Fixed {
        return None;
    }
    match (*x == 0.0, *y == 0.0) {
        (false, true) => Some((0, *x)),
        (true, false) => Some((1, *y)),
        _ => None,
    }
}
