//! Deformable bodies: their size, the memory of their solutions, and the cost of a solution per
//! step.

use crate::RunView;
use crate::bodies::SystemSize;
use cpu_time::ThreadTime;
use fretwork_core::view::SystemView;

/// Number of operations of a factorisation above which it is not timed, since it would take more
/// than a few tenths of a second.
const MAX_TIMED: f64 = 5e8;

/// The lines of all deformable bodies: label and text.
pub(super) fn lines(s: &dyn RunView, timed: bool) -> Vec<(&'static str, String)> {
    let systems = (0..s.system_count()).filter_map(|k| s.system(k));
    let (grains, systems): (Vec<_>, Vec<_>) = systems.partition(|system| system.is_grain());
    let mut out = Vec::new();
    if !grains.is_empty() {
        let coordinates: usize = grains.iter().map(|g| g.freedoms()).sum();
        let balls = s.balls().into_iter();
        let points = balls.filter(|b| b.area != [0.0; 3]);
        let sizes = grains.iter().filter_map(|g| g.size());
        let text = format!(
            "{}: {coordinates} coordinates, {} points of surfaces; memory: compliance of surfaces up to {}; modes were found once for all balls, and for each polygon or polyhedron of its own",
            grains.len(),
            points.count(),
            bytes(sizes.map(|size| size.surface).sum())
        );
        out.push(("deformable grains", text));
    }
    for system in systems {
        out.push(shape(&*system));
        let Some(size) = system.size() else { continue };
        out.push(("", memory(s.dimension(), &*system, &size)));
        let times = (timed && size.operations[0] < MAX_TIMED).then(|| clock(&*system));
        out.push(("", cost(&size, times)));
    }
    out
}

fn shape(system: &dyn SystemView) -> (&'static str, String) {
    let (name, contactors) = (system.name(), system.contactors().len());
    match system.mesh_size() {
        None => {
            let coordinates = system.freedoms();
            let text = format!("{name}: {coordinates} coordinates; {contactors} contactors");
            ("half-space", text)
        }
        Some([points, elements]) => {
            let coordinates = system.freedoms();
            let text = format!(
                "{name}: {points} points, {elements} elements, {coordinates} coordinates; {contactors} contactors"
            );
            ("deformable body", text)
        }
    }
}

fn bytes(count: usize) -> String {
    scaled(count as f64, [" B", " kB", " MB", " GB"])
}

/// Formats a number with at least two digits and the first of these units in which it is below a
/// thousand; each unit is a thousand times the previous one.
fn scaled(mut value: f64, units: [&str; 4]) -> String {
    let mut units = units.into_iter();
    let mut unit = units.next().unwrap_or_default();
    for next in units {
        if value < 999.5 {
            break;
        }
        (value, unit) = (value / 1e3, next);
    }
    let digits = usize::from(value < 9.95 && value.fract() != 0.0);
    format!("{value:.digits$}{unit}")
}

fn memory(dimension: usize, system: &dyn SystemView, size: &SystemSize) -> String {
    let unknowns = size.unknowns;
    if size.factor == 0 {
        let cells = match size.surface {
            0 => String::new(),
            all => format!(", compliance of its cells {} where all touch", bytes(all)),
        };
        return format!(
            "{unknowns} unknowns; memory: tables of influences {}{cells}",
            bytes(size.matrix)
        );
    }
    let points = system.surface_points();
    let surface = match (points, size.surface) {
        (0, _) => String::new(),
        (_, 0) => format!(
            "; the compliance of its {points} points on the surface is too large to be kept, and each touched point takes {dimension} solutions a step"
        ),
        (_, all) => format!(
            ", compliance of the surface {} a point that was touched, {} for all {points}",
            bytes(size.point),
            bytes(all)
        ),
    };
    format!(
        "{unknowns} unknowns; memory: matrix {}, factor {}{surface}",
        bytes(size.matrix),
        bytes(size.factor)
    )
}

/// Measures the processor times of a factorisation and of a solution (s).
fn clock(system: &dyn SystemView) -> [f64; 2] {
    let mut trial = system.trial();
    let begun = ThreadTime::now();
    trial.linearise();
    let factorised = begun.elapsed().as_secs_f64();
    trial.push();
    let begun = ThreadTime::now();
    trial.solve();
    [factorised, begun.elapsed().as_secs_f64()]
}

fn cost(size: &SystemSize, times: Option<[f64; 2]>) -> String {
    let took = |which: usize| match times {
        Some(times) => {
            let micro = [" us", " ms", " s", " ks"];
            format!(" ({})", scaled(1e6 * times[which], micro))
        }
        None => String::new(),
    };
    let names = ["", " thousand", " million", " billion"];
    let operations = |which: usize| scaled(size.operations[which], names);
    let solution = format!("{} operations{}", operations(1), took(1));
    if size.factor == 0 {
        return format!("a step: two sums over all cells of {solution} each");
    }
    let factorisation = format!("{} operations{}", operations(0), took(0));
    if size.refactorised {
        format!(
            "each iteration of a step: one factorisation of {factorisation}, two solutions of {solution} each, and one for each coordinate of what is touched"
        )
    } else {
        format!(
            "factorised once, {factorisation}; a step: two solutions of {solution} each, and one for each coordinate of a point that is touched for the first time"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_units_of_their_size() {
        for (count, text) in [
            (0, "0 B"),
            (999, "999 B"),
            (1500, "1.5 kB"),
            (9_660_000, "9.7 MB"),
            (999_600, "1.0 MB"),
            (34_400_000_000, "34 GB"),
        ] {
            assert_eq!(bytes(count), text);
        }
    }

    #[test]
    fn what_is_formed_once_and_in_each_iteration_is_told_apart() {
        let mut size = SystemSize {
            factor: 1,
            operations: [2e9, 4e6],
            ..SystemSize::default()
        };
        let text = cost(&size, Some([1.5, 2e-3]));
        assert!(
            text.starts_with("factorised once, 2 billion operations (1.5 s)"),
            "{text}"
        );
        size.refactorised = true;
        let text = cost(&size, None);
        assert!(
            text.starts_with("each iteration of a step: one factorisation of 2 billion operations, two solutions of 4 million"),
            "{text}"
        );
    }
}
