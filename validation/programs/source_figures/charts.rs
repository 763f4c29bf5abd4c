//! Pictures of the figures.

use crate::process::{Step, Trace};
use crate::{Run, Samples, Single};
use fretwork::solve::local::solver::Method;
use fretwork::view::{Axis, Chart, DrawError, Series, draw_panels};
use std::path::Path;

/// Number of steps over which counts, times and measured values are averaged.
pub const WINDOW: usize = 20;

const SIZE: (u32, u32) = (660, 450);

/// Name of a solver as in the source.
pub fn name(method: Method) -> String {
    match method {
        Method::Anderson => "Anderson (ours)".to_owned(),
        other => other.name().to_uppercase(),
    }
}

fn chart(title: impl Into<String>, x: Axis, y: Axis) -> Chart {
    let mut chart = Chart::new(title, x, y);
    chart.size_px = SIZE;
    chart
}

/// A fixed colour for each solver in all pictures.
fn colour(label: &str) -> Option<(u8, u8, u8)> {
    Some(match label {
        "NLGS" => (0, 114, 178),
        "CPG" => (213, 94, 0),
        "PCPG" => (0, 158, 115),
        "PG" => (204, 121, 167),
        "auto" => (60, 60, 60),
        _ => (150, 150, 150),
    })
}

fn series(label: &str, points: Vec<(f64, f64)>) -> Series {
    Series {
        colour: colour(label),
        ..Series::new(label, points)
    }
}

/// The last value in each of many short intervals of a logarithmic axis, at pixel resolution.
fn sparse(history: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let stretch = |x: f64| (x.ln() * 15.0).floor() as i64;
    history
        .chunk_by(|a, b| stretch(a.0) == stretch(b.0))
        .filter_map(|c| c.last().copied())
        .collect()
}

/// Error against iterations for each friction coefficient, and against time for the middle one.
pub fn one_step(singles: &[Single], path: &Path) -> Result<(), DrawError> {
    let panel = |single: &Single, timed: bool| {
        let (x, along) = if timed {
            ("time of the solve", ", against time")
        } else {
            ("iterations", "")
        };
        let x = Axis::new(x, if timed { "s" } else { "" }).log();
        let title = format!("μ = {}, {} contacts{along}", single.mu, single.contacts);
        let mut chart = chart(title, x, Axis::new("relative error", "").log());
        chart.y_range = Some((1e-10, 1.0));
        for fared in &single.fared {
            let unit = if timed { fared.each } else { 1.0 };
            let points: Vec<(f64, f64)> = fared
                .history
                .iter()
                .filter(|h| h.0 > 0)
                .map(|h| (f64::from(h.0) * unit, h.1))
                .collect();
            chart = chart.with(series(&name(fared.method), sparse(&points)));
        }
        chart
    };
    let mut panels: Vec<Chart> = singles.iter().map(|s| panel(s, false)).collect();
    panels.extend(singles.get(1).map(|s| panel(s, true)));
    draw_panels(&panels, 2, path)
}

/// Means over windows of steps.
fn smooth(steps: &[Step], x: impl Fn(&Step) -> f64, y: impl Fn(&Step) -> f64) -> Vec<(f64, f64)> {
    let mean = |c: &[Step], f: &dyn Fn(&Step) -> f64| c.iter().map(f).sum::<f64>() / c.len() as f64;
    steps
        .chunks(WINDOW)
        .map(|c| (mean(c, &x), mean(c, &y)))
        .collect()
}

/// Iterations and time per step against time.
fn along(runs: &[Run]) -> [Chart; 2] {
    let time = || Axis::new("time", "s");
    let mut panels = [
        chart(
            format!("Iterations a step, means over {WINDOW} steps"),
            time(),
            Axis::new("iterations a step", "").log(),
        ),
        chart(
            format!("Time of a solve, means over {WINDOW} steps"),
            time(),
            Axis::new("time of a solve (ms)", "").log(),
        ),
    ];
    // The first steps have no contacts.
    panels[0].y_range = Some((1.0, 1e4));
    panels[1].y_range = Some((1e-2, 1e2));
    for run in runs {
        let steps = &run.trace.steps;
        let lines = [
            smooth(steps, |s| s.time, |s| f64::from(s.iterations)),
            smooth(steps, |s| s.time, |s| 1e3 * s.seconds),
        ];
        for (panel, points) in panels.iter_mut().zip(lines) {
            panel.series.push(series(run.label, points));
        }
    }
    panels
}

/// Figure of the quasi-static process.
pub fn quasi_static(runs: &[Run], path: &Path) -> Result<(), DrawError> {
    draw_panels(&along(runs), 2, path)
}

/// Figure of the dynamic process, with kinetic energy and final surface.
pub fn dynamic(runs: &[Run], path: &Path) -> Result<(), DrawError> {
    let mut energy = chart(
        "Kinetic energy of the grains",
        Axis::new("time", "s"),
        Axis::new("kinetic energy", "J/m"),
    );
    let mut heap = chart(
        "Surface of the heap at the end",
        Axis::new("distance from the wall", "m"),
        Axis::new("height", "m"),
    );
    for run in runs {
        let steps = &run.trace.steps;
        let points = steps.iter().map(|s| (s.time, s.kinetic)).collect();
        energy = energy.with(series(run.label, points));
        heap = heap.with(series(run.label, surface(&run.trace)));
    }
    let [iterations, time] = along(runs);
    draw_panels(&[iterations, time, energy, heap], 2, path)
}

/// The highest point of the heap in strips of 20 mm.
fn surface(trace: &Trace) -> Vec<(f64, f64)> {
    const STRIP: f64 = 0.02;
    let mut top: Vec<f64> = Vec::new();
    for ([x, y], radius) in &trace.grains {
        let k = (x / STRIP).max(0.0) as usize;
        if k >= top.len() {
            top.resize(k + 1, 0.0);
        }
        top[k] = top[k].max(y + radius);
    }
    let middle = |k: usize| (k as f64 + 0.5) * STRIP;
    top.iter()
        .enumerate()
        .map(|(k, y)| (middle(k), *y))
        .collect()
}

/// A macroscopic quantity of the biaxial test: name, unit, value.
pub type Quantity = (&'static str, &'static str, fn(&Step) -> f64);

/// Quantities compared in the source, and the deviator.
pub const QUANTITIES: [Quantity; 4] = [
    ("pressure", "Pa", |s| s.test.pressure_walls),
    ("coordination", "", |s| s.test.coordination.carried),
    ("compacity", "", |s| s.test.compacity),
    ("deviator over pressure", "", |s| s.test.deviator_ratio),
];

/// Figure of the biaxial test: means over samples by NLGS and by CPG, over the individual samples.
pub fn biaxial(samples: &Samples, path: &Path) -> Result<(), DrawError> {
    let panels = QUANTITIES.map(|(name, unit, value)| {
        // All panels share one legend.
        let label = |text: &str| if name == QUANTITIES[0].0 { text } else { "" }.to_owned();
        let mut panel = chart("", Axis::new("axial strain", ""), Axis::new(name, unit));
        for (k, trace) in samples.nlgs.iter().enumerate() {
            let text = if k == 0 { "NLGS, samples" } else { "" };
            panel = panel.with(Series {
                label: label(text),
                ..series("", curve(trace, value))
            });
        }
        for (text, of, traces) in [
            ("NLGS, mean", "NLGS", &samples.nlgs),
            ("CPG, mean", "CPG", &samples.cpg),
        ] {
            panel = panel.with(Series {
                label: label(text),
                ..series(of, mean(traces, value))
            });
        }
        panel
    });
    draw_panels(&panels, 2, path)
}

/// Mean curve of samples with the same loading.
fn mean(traces: &[&Trace], value: fn(&Step) -> f64) -> Vec<(f64, f64)> {
    let curves: Vec<_> = traces.iter().map(|t| curve(t, value)).collect();
    let length = curves.iter().map(Vec::len).min().unwrap_or(0);
    let over = |k: usize, f: fn(&(f64, f64)) -> f64| {
        curves.iter().map(|c| f(&c[k])).sum::<f64>() / curves.len() as f64
    };
    (0..length)
        .map(|k| (over(k, |p| p.0), over(k, |p| p.1)))
        .collect()
}

/// Means over windows of steps, against their axial strain.
pub fn curve(trace: &Trace, value: fn(&Step) -> f64) -> Vec<(f64, f64)> {
    let begun = trace.steps.iter().position(|s| s.test.axial_strain > 0.0);
    smooth(
        &trace.steps[begun.unwrap_or(0)..],
        |s| s.test.axial_strain,
        value,
    )
}
