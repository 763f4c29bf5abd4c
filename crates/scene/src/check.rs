//! Validation of a case before it is built.

use super::build::Origin;
use super::called;
use super::case::{AccurateResult, BodySpec, Case, Checkpoint};
use super::phases::PhaseSpec;
use super::processes;
use super::source::ValidationError;
use fretwork_core::bodies::Dof;
use fretwork_core::laws::Kind;
use fretwork_core::step::Coupling;
use fretwork_core::step::control::Until;
use fretwork_core::view::{ContactView, RunControl};

/// Largest number of materials, and of interfaces, of a case.
const MAX_LIST: usize = 10_000;

/// Checks the numbers of a case.
///
/// # Errors
/// Returns the first invalid number, with its path.
pub fn numbers(case: &Case) -> Result<(), ValidationError> {
    if case.dimension != 2 && case.dimension != 3 {
        return Err(ValidationError::new(
            "dimension",
            format!("dimension {} is not possible", case.dimension),
        )
        .expected("2 or 3"));
    }
    let dimension = case.dimension as usize;
    time(case)?;
    accuracy(case)?;
    repeats(case)?;
    output_intervals(case)?;
    positive("inertia_scaling", case.inertia_scaling)?;
    coupling(case)?;
    solver(case)?;
    scaled_weights(case)?;
    at_least_one("solver.max_iterations", case.solver.max_iterations)?;
    periods_and_distances(case, dimension)?;
    if case.materials.is_empty() {
        return Err(ValidationError::new(
            "materials",
            "a case needs at least one material",
        ));
    }
    for (list, count) in [
        ("materials", case.materials.len()),
        ("interfaces", case.interfaces.len()),
    ] {
        if count > MAX_LIST {
            let message = format!(
                "{count} {list} are too many, at most {MAX_LIST}: every pair of materials has a place in a table; merge those that are alike"
            );
            return Err(ValidationError::new(list, message));
        }
    }
    super::names::check(case)?;
    bodies(case, dimension)?;
    output_files(case)?;
    super::biaxial::check(case)?;
    super::phases::gravity_drive(case.gravity_drive.as_ref(), dimension)?;
    super::phases::check(case)?;
    super::measures::check(case)?;
    friction(case, dimension)?;
    super::jump::check(case)?;
    super::heat::check(case)?;
    super::circuit::check(case)
}

fn positive(path: &str, x: f64) -> Result<(), ValidationError> {
    if x.is_finite() && x > 0.0 {
        return Ok(());
    }
    let message = format!("must be positive, got {x}");
    Err(ValidationError::new(path, message))
}

fn at_least_one(path: &str, count: u32) -> Result<(), ValidationError> {
    match count {
        0 => Err(ValidationError::new(path, "must be at least 1")),
        _ => Ok(()),
    }
}

/// Checks step, end and theta.
fn time(case: &Case) -> Result<(), ValidationError> {
    let time = &case.time;
    positive("time.step", time.step)?;
    positive("time.end", time.end)?;
    if !(0.5..=1.0).contains(&time.theta) {
        return Err(
            ValidationError::new("time.theta", format!("got {}", time.theta))
                .expected("a number between 0.5 and 1"),
        );
    }
    let wrong_step = |message: String| Err(ValidationError::new("time.step", message));
    if !(time.step * time.step).is_normal() {
        return wrong_step(format!(
            "the square of a step of {:e} s is outside the range of the computation; check its unit",
            time.step
        ));
    }
    if time.end / time.step > 1e12 {
        return wrong_step(
            "the run would take more than 1e12 steps; use a larger step or an earlier end".into(),
        );
    }
    if time.step > time.end {
        return wrong_step(format!(
            "a step of {} s is longer than the run of {} s",
            time.step, time.end
        ));
    }
    Ok(())
}

/// Checks the intervals between rows of the statistics and between checkpoints.
fn output_intervals(case: &Case) -> Result<(), ValidationError> {
    if case.output.every == 0 {
        let message = "must be at least 1: steps between two rows of the statistics";
        return Err(ValidationError::new("output.every", message));
    }
    let message = match case.output.checkpoint {
        Checkpoint::Steps(0) => {
            "must be at least 1: steps between two checkpoints; use Never for none".into()
        }
        Checkpoint::Seconds(s) if !(s.is_finite() && s >= 0.0) => {
            format!("seconds between two checkpoints must not be negative, got {s}")
        }
        _ => return Ok(()),
    };
    Err(ValidationError::new("output.checkpoint", message))
}

/// Checks the requested accuracy and its bounds.
fn accuracy(case: &Case) -> Result<(), ValidationError> {
    let Some(accuracy) = &case.accuracy else {
        return Ok(());
    };
    let outside = |field: &str, value: f64, expected: &str| {
        let path = format!("accuracy.{field}");
        Err(ValidationError::new(path, format!("got {value}")).expected(expected))
    };
    if !(accuracy.share > 0.0 && accuracy.share < 1.0) {
        let expected = "a share of the result above 0 and below 1, such as 0.03";
        return outside("share", accuracy.share, expected);
    }
    if !(accuracy.effort > 0.0 && accuracy.effort <= 10.0) {
        return outside("effort", accuracy.effort, "a number above 0, at most 10");
    }
    let step = accuracy.finest_step.unwrap_or(case.time.step);
    if !(step > 0.0 && step <= case.time.step) {
        let expected = "a time above 0, at most time.step, which is the coarsest step";
        return outside("finest_step", step, expected);
    }
    let largest = accuracy.largest_step.unwrap_or(case.time.step);
    if !(largest >= case.time.step && largest.is_finite()) {
        let expected = "a time of at least time.step, from which steps grow where nothing moves";
        return outside("largest_step", largest, expected);
    }
    if accuracy.of == AccurateResult::Forces && accuracy.finest_step.is_some() {
        let message = "with `of: Forces` steps only grow, and time.step is the smallest: leave out finest_step, or take a smaller time.step";
        return Err(ValidationError::new("accuracy.finest_step", message));
    }
    if let Some(tolerance) = accuracy.finest_tolerance
        && !(tolerance > 0.0 && tolerance.is_finite())
    {
        return outside("finest_tolerance", tolerance, "a number above 0");
    }
    let by_steps = |p: &PhaseSpec| matches!(p.until, Some(Until::Steps(_)));
    if let Some(k) = case.phases.iter().position(by_steps) {
        let message = "a phase that ends after a number of steps depends on the step that the run chooses; give its time";
        return Err(ValidationError::new(format!("phases.{k}.until"), message));
    }
    if case.circuit.is_some() {
        let message = "the circuit counts steps, which the run would choose; leave out `accuracy` or `circuit`";
        return Err(ValidationError::new("accuracy", message));
    }
    let has = |kind| case.interfaces.iter().any(|i| i.law(kind).is_some());
    if accuracy.of == AccurateResult::Wear && !has(Kind::WEAR) {
        let message = "no interface has a wear law; name one, or another result";
        return Err(ValidationError::new("accuracy.of", message));
    }
    if accuracy.of == AccurateResult::Damage && !(has(Kind::DAMAGE) || has(Kind::COHESION)) {
        let message = "no interface has bonds; name a damage law, or another result";
        return Err(ValidationError::new("accuracy.of", message));
    }
    if case.jump.is_some() {
        let message =
            "a run that jumps over cycles cannot choose its step; leave out `accuracy` or `jump`";
        return Err(ValidationError::new("accuracy", message));
    }
    Ok(())
}

/// Checks the number of steps repeated at a time.
fn repeats(case: &Case) -> Result<(), ValidationError> {
    let steps = case.uncertainty.steps;
    steps.map_or(Ok(()), |steps| at_least_one("uncertainty.steps", steps))
}

fn coupling(case: &Case) -> Result<(), ValidationError> {
    let Coupling::Implicit {
        tolerance,
        max_iterations,
    } = case.coupling
    else {
        return Ok(());
    };
    positive("coupling.tolerance", tolerance)?;
    at_least_one("coupling.max_iterations", max_iterations)
}

fn solver(case: &Case) -> Result<(), ValidationError> {
    let s = &case.solver;
    let tolerance = s.tolerance.unwrap_or(0.0);
    if !(tolerance.is_finite() && tolerance >= 0.0) {
        return Err(ValidationError::new(
            "solver.tolerance",
            format!("must not be negative, got {tolerance}"),
        ));
    }
    let outside = |field: &str, value: f64, expected: &str| {
        let path = format!("solver.{field}");
        Err(ValidationError::new(path, format!("got {value}")).expected(expected))
    };
    if !(0.0..=1.0).contains(&s.correction) {
        return outside("correction", s.correction, "a number between 0 and 1");
    }
    if !(0.0..1.0).contains(&s.projection) {
        let expected =
            "0 (never) or the fraction of a radius above which an overlap is removed, below 1";
        return outside("projection", s.projection, expected);
    }
    let deforms = [
        ("elastic_grains", !case.elastic_grains.is_empty()),
        ("elastic", !case.elastic.is_empty()),
        ("half_spaces", !case.half_spaces.is_empty()),
    ];
    if let Some((field, _)) = deforms
        .into_iter()
        .find(|(_, any)| *any && s.projection > 0.0)
    {
        let message = format!(
            "moves rigid grains and first bodies apart, not bodies that deform (`{field}`); set it to 0, and `solver.correction` above 0 to have overlaps removed"
        );
        return Err(ValidationError::new("solver.projection", message));
    }
    if !(1.0..2.0).contains(&s.relaxation) {
        let expected = "a number from 1 (none) to below 2";
        return outside("relaxation", s.relaxation, expected);
    }
    at_least_one("solver.test_every", s.test_every)
}

/// Rejects gravity with scaled masses.
fn scaled_weights(case: &Case) -> Result<(), ValidationError> {
    let gravity = case.gravity_drive.is_some() || case.gravity.iter().any(|g| *g != 0.0);
    if case.inertia_scaling != 1.0 && gravity {
        return Err(ValidationError::new(
            "inertia_scaling",
            "scales weights with the masses; switch gravity off, or leave the scaling out",
        ));
    }
    Ok(())
}

/// Checks the periods of the cell, and the distances of the detection.
fn periods_and_distances(case: &Case, dimension: usize) -> Result<(), ValidationError> {
    for (name, period) in [
        ("x", case.periodic.x),
        ("y", case.periodic.y),
        ("z", case.periodic.z),
    ] {
        if let Some(period) = period {
            positive(&format!("periodic.{name}"), period)?;
        }
    }
    if case.periodic.z.is_some() && dimension == 2 {
        return Err(ValidationError::new(
            "periodic.z",
            "there is no z in two dimensions",
        ));
    }
    for (name, distance) in [
        ("alert", case.detection.alert),
        ("skin", case.detection.skin),
    ] {
        if let Some(distance) = distance {
            positive(&format!("detection.{name}"), distance)?;
        }
    }
    Ok(())
}

/// Checks the numbers of the first bodies, and that their names differ.
fn bodies(case: &Case, dimension: usize) -> Result<(), ValidationError> {
    for (k, body) in case.bodies.iter().enumerate() {
        body_numbers(body, dimension).map_err(|f| f.under(&format!("bodies.{k}")))?;
        if case.bodies[..k].iter().any(|b| b.name == body.name) {
            return Err(ValidationError::new(
                format!("bodies.{k}.name"),
                format!("two bodies are named `{}`", body.name),
            ));
        }
    }
    Ok(())
}

/// Checks the settings of pictures and profiles.
fn output_files(case: &Case) -> Result<(), ValidationError> {
    if let Some(w) = case.output.window
        && !(w.iter().all(|x| x.is_finite()) && w[0] < w[1] && w[2] < w[3])
    {
        let message = "a window is (xmin, xmax, ymin, ymax) with xmin < xmax and ymin < ymax";
        return Err(ValidationError::new("output.window", message));
    }
    if let Some(layers) = case.output.layers {
        positive("output.layers", layers)?;
    }
    if let Some(shear) = case.output.shear {
        positive("output.shear", shear)?;
    }
    if case.output.frames > 0 && !(200..=16_384).contains(&case.output.width) {
        let message = format!("a frame cannot be {} pixels wide", case.output.width);
        return Err(ValidationError::new("output.width", message).expected("200 to 16384 pixels"));
    }
    Ok(())
}

fn body_numbers(body: &BodySpec, dimension: usize) -> Result<(), ValidationError> {
    for (name, value) in [
        ("mass", body.mass),
        ("inertia", body.inertia),
        ("vanishes", body.vanishes),
    ] {
        if let Some(value) = value
            && !(value.is_finite() && value > 0.0)
        {
            return Err(ValidationError::new(
                name,
                format!("must be positive, got {value}"),
            ));
        }
    }
    if dimension == 2 {
        let d = &body.dofs;
        for (name, dof) in [("z", &d.z), ("rx", &d.rx), ("ry", &d.ry)] {
            if *dof != Dof::Fixed {
                return Err(ValidationError::new(
                    format!("dofs.{name}"),
                    format!("there is no {name} in two dimensions"),
                )
                .expected("x, y or rz"));
            }
        }
    }
    let dofs = body.ordered(dimension);
    for (name, dof) in BodySpec::names(dimension).iter().zip(&dofs) {
        if let Some((below, fault)) = dof.error() {
            let path = format!("dofs.{name}.{below}");
            return Err(ValidationError::new(path.trim_end_matches('.'), fault));
        }
    }
    Ok(())
}

fn friction(case: &Case, dimension: usize) -> Result<(), ValidationError> {
    let Some(test) = &case.friction else {
        return Ok(());
    };
    let rigid = case.bodies.iter().map(|b| b.name.as_str());
    let elastic = case.elastic.iter().map(|b| b.name.as_str());
    let half_spaces = case.half_spaces.iter().map(|b| b.name.as_str());
    let deformable: Vec<&str> = elastic.chain(half_spaces).collect();
    let names: Vec<&str> = rigid.chain(deformable.iter().copied()).collect();
    if !names.contains(&test.body.as_str()) {
        return Err(ValidationError::new(
            "friction.body",
            format!("there is no body `{}`", test.body),
        )
        .expected_name(names.iter().copied(), "bodies")
        .nearest(super::source::nearest(&test.body, names.iter().copied())));
    }
    for (name, axis) in [("along", test.along), ("normal", test.normal)] {
        if axis >= dimension {
            return Err(ValidationError::new(
                format!("friction.{name}"),
                format!("axis {axis} does not exist"),
            )
            .expected(format!("a number below {dimension}")));
        }
    }
    let deforms = deformable.contains(&test.body.as_str());
    if deforms && processes::held(case, &test.body, test.along).is_none() {
        return Err(ValidationError::new(
            "friction.body",
            format!(
                "no part of `{}` is held along axis {}, so that there is no displacement and no force of a holder; add a support",
                test.body, test.along
            ),
        ));
    }
    if !test.start.is_finite() {
        return Err(ValidationError::new(
            "friction.start",
            format!("must be finite, got {}", test.start),
        ));
    }
    if test.along == test.normal {
        return Err(ValidationError::new(
            "friction.normal",
            "must differ from `along`",
        ));
    }
    if test.period.is_some_and(|p| !(p.is_finite() && p > 0.0)) {
        return Err(ValidationError::new("friction.period", "must be positive"));
    }
    Ok(())
}

/// Checks for grains that overlap at the start. More than 1 % of the smallest radius is an error;
/// less counts as rounding of a sample that was prepared elsewhere.
///
/// # Errors
/// The pair with the largest overlap.
pub(super) fn overlaps(
    simulation: &mut dyn RunControl,
    smallest: f64,
    origins: &[Origin],
) -> Result<(), ValidationError> {
    simulation.detect();
    let s = simulation;
    let mut worst: Option<ContactView> = None;
    s.visit_contacts(&mut |contact| {
        if worst.is_none_or(|w| contact.gap.total_cmp(&w.gap).is_lt()) {
            worst = Some(*contact);
        }
    });
    let Some(worst) = worst.filter(|c| c.gap < -0.01 * smallest) else {
        return Ok(());
    };
    let message = format!(
        "{} and {} overlap by {:.3e} m at the start; move them apart or make them smaller",
        called::body(s, worst.bodies[0]),
        called::body(s, worst.bodies[1]),
        -worst.gap
    );
    // The error is reported at the last grain of the pair in the case, or at the body if neither is
    // a grain.
    let at = worst.bodies.iter().max_by_key(|b| {
        let driven = s.bodies().driven.iter().any(|d| d.body == **b);
        let place = match origins.get(**b as usize) {
            Some(Origin::Grain(k, g)) => (*k, g.unwrap_or(0)),
            Some(Origin::Body(k) | Origin::Elastic(k) | Origin::HalfSpace(k)) => (*k, 0),
            None => (0, 0),
        };
        (!driven, place)
    });
    let origin = at.and_then(|b| origins.get(*b as usize));
    let path = origin.map_or_else(|| "grains".to_owned(), |o| o.path());
    Err(ValidationError::new(path, message))
}
