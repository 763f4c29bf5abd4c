//! Cost of a step and memory against the number of grains.
//!
//! `cargo run --release --example scale [-- MAX]` settles layers of disks (20 deep) and spheres (10
//! deep) of increasing width, from 1,000 to MAX grains (1,000,000), each in a separate process; it
//! prints the table of `docs/dev/performance.md` and draws `docs/figures/scale.png`. The depth is
//! constant, and with it the number of iterations that a load needs to propagate across the layer.

use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::scene::load_text;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use fretwork::view::{Axis, Chart, Series, draw_panels};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

#[global_allocator]
static ALLOCATOR: fretwork::huge_pages::HugePages = fretwork::huge_pages::HugePages;

/// Measurements of one run.
#[derive(Clone, Copy, Debug)]
struct Row {
    grains: f64,
    contacts: f64,
    /// Duration of the fastest step at rest (s).
    step: f64,
    /// Parts of the step in detection, laws and solver (s).
    parts: [f64; 3],
    /// Iterations per step.
    sweeps: f64,
    /// Duration of rebuilding the neighbour list, by which detection takes longer (s).
    list: f64,
    /// Number of steps at rest with a rebuild, of all.
    rebuilt: f64,
    /// Peak memory (bytes).
    memory: f64,
}

impl Row {
    const N: usize = 10;

    fn numbers(&self) -> [f64; Self::N] {
        let [detect, laws, solve] = self.parts;
        [
            self.grains,
            self.contacts,
            self.step,
            detect,
            laws,
            solve,
            self.sweeps,
            self.list,
            self.rebuilt,
            self.memory,
        ]
    }

    fn of(n: &[f64]) -> Option<Self> {
        let n: &[f64; Self::N] = n.try_into().ok()?;
        Some(Self {
            grains: n[0],
            contacts: n[1],
            step: n[2],
            parts: [n[3], n[4], n[5]],
            sweeps: n[6],
            list: n[7],
            rebuilt: n[8],
            memory: n[9],
        })
    }

    /// Time per step and contact (ns).
    fn each(&self) -> f64 {
        self.step / self.contacts * 1e9
    }
}

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match &args[..] {
        [one, dimension, count] if one == "one" => {
            let count = count.parse()?;
            let row = if dimension == "2" {
                measure::<Dim2>(count)?
            } else {
                measure::<Dim3>(count)?
            };
            let numbers = row.numbers().map(|x| format!("{x:e}"));
            println!("{}", numbers.join(" "));
            Ok(())
        }
        [] => table(1_000_000),
        [most] => table(most.parse()?),
        _ => Err("give the largest number of grains, or nothing".into()),
    }
}

fn table(most: usize) -> Result<(), Failure> {
    println!(
        "| grains | contacts | step | per contact | sweeps | detection | laws | solver | neighbour list rebuild | in steps | memory | per grain |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut charts = Vec::new();
    let mut all = Vec::new();
    for (dimension, name) in [("2", "disks"), ("3", "spheres")] {
        let mut rows = Vec::new();
        let mut count = 1_000;
        while count <= most {
            for n in [count, 3 * count].into_iter().filter(|n| *n <= most) {
                let row = apart(dimension, n)?;
                print(name, &row);
                rows.push(row);
            }
            count *= 10;
        }
        all.push((name, rows));
    }
    let mut figure = |title: &str, y: Axis, value: &dyn Fn(&Row) -> f64| {
        let mut chart = Chart::new(title, Axis::new("grains", "").log(), y);
        chart.size_px = (660, 450);
        for (name, rows) in &all {
            let points = rows.iter().map(|r| (r.grains, value(r))).collect();
            chart = chart.with(Series::new(*name, points));
        }
        charts.push(chart);
    };
    figure(
        "Time of a step at rest",
        Axis::new("time", "s").log(),
        &|r| r.step,
    );
    figure(
        "Memory, at its peak",
        Axis::new("memory", "bytes").log(),
        &|r| r.memory,
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures/scale.png");
    draw_panels(&charts, 2, &path)?;
    println!("drawn to docs/figures/scale.png");
    Ok(())
}

fn print(name: &str, r: &Row) {
    let share = |part: f64| 100.0 * part / r.step;
    println!(
        "| {:.0} {name} | {:.0} | {:.3} ms | {:.0} ns | {:.1} | {:.0} % | {:.0} % | {:.0} % | {:.2} ms | {:.0} % | {:.0} MB | {:.0} B |",
        r.grains,
        r.contacts,
        1e3 * r.step,
        r.each(),
        r.sweeps,
        share(r.parts[0]),
        share(r.parts[1]),
        share(r.parts[2]),
        1e3 * r.list,
        100.0 * r.rebuilt,
        r.memory / 1e6,
        r.memory / r.grains
    );
}

/// Measures in a separate process, so that the peak of memory belongs to this size.
fn apart(dimension: &str, count: usize) -> Result<Row, Failure> {
    let output = Command::new(std::env::current_exe()?)
        .args(["one", dimension, &count.to_string()])
        .output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<f64> = text
        .split_whitespace()
        .filter_map(|w| w.parse().ok())
        .collect();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    Row::of(&numbers).ok_or_else(|| format!("{count} grains: {said}").into())
}

const RADIUS: f64 = 1e-3;

/// Limit on the steps for a layer to come to rest; a layer that needs more is measured anyway, and
/// its iterations show it.
const SETTLING: u32 = 60;

/// A layer of `count` grains above a floor, periodic along the horizontal axes.
fn layer<S: Space>(count: usize) -> String {
    let wide = 2.0 * RADIUS * (1.0 + 2e-6);
    let (period, low, high, up) = if S::D == 2 {
        let width = (count as f64 / 20.0).ceil() * wide;
        let period = format!("(x: {width:e})");
        let high = format!("[{width:e}, {:e}]", 25.0 * wide);
        (period, "[0.0, 0.0]".to_owned(), high, "0.0, 1.0")
    } else {
        let side = (count as f64 / 10.0).sqrt().ceil() * wide;
        let period = format!("(x: {side:e}, y: {side:e})");
        let high = format!("[{side:e}, {side:e}, {:e}]", 12.0 * wide);
        (period, "[0.0, 0.0, 0.0]".to_owned(), high, "0.0, 0.0, 1.0")
    };
    let gravity = up.replace("1.0", "-9.81");
    format!(
        r#"(
    name: "a layer", dimension: {}, time: (step: 1e-4, end: 1.0), gravity: [{gravity}], periodic: {period},
    materials: {{"grain": "glass_bead"}},
    interfaces: [(name: "grains", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {{"mu": 0.3}}))],
    bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [{up}])])],
    grains: [Lattice(material: "grain", count: {count}, radius: ({RADIUS:e}, {RADIUS:e}), low: {low}, high: {high})],
)"#,
        S::D
    )
}

fn measure<S: Space>(count: usize) -> Result<Row, Failure> {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let loaded = load_text("layer.ron", &layer::<S>(count), &cases, &[])?;
    let mut s = loaded.build_in::<S>(&search_path())?;
    settle(&mut s)?;
    // Number of steps for about ten million contact updates.
    let steps = (3_000_000 / count).clamp(8, 200);
    let (mut parts, mut step) = ([0.0; 3], f64::INFINITY);
    let (mut sweeps, rebuilds) = (0.0, s.state.network.rebuilds);
    for _ in 0..steps {
        let clock = Instant::now();
        let report = s.step()?;
        let time = clock.elapsed().as_secs_f64();
        // The fastest step is least disturbed by other programs.
        if time < step {
            let t = &report.timing;
            (step, parts) = (time, [t.detect, t.laws, t.solve].map(|t| t.as_secs_f64()));
        }
        sweeps += f64::from(report.solver.iterations) / steps as f64;
    }
    let memory = peak();
    let rebuilt = (s.state.network.rebuilds - rebuilds) as f64 / steps as f64;
    // A step without a known place of every ball rebuilds the list.
    let mut with_list = f64::INFINITY;
    for _ in 0..5 {
        s.state.network.forget_neighbours();
        with_list = with_list.min(s.step()?.timing.detect.as_secs_f64());
    }
    let list = with_list - parts[0];
    Ok(Row {
        grains: s.shapes.balls.len() as f64,
        contacts: s.state.network.contacts.len() as f64,
        step,
        parts,
        sweeps,
        list,
        rebuilt,
        memory,
    })
}

/// Steps until the layer is at rest: ten steps in a row that converge at the first test.
fn settle<S: Space>(s: &mut Simulation<S>) -> Result<(), Failure> {
    let (first, mut calm) = (s.options.solver.test_every.div_ceil(2), 0);
    for _ in 0..SETTLING {
        let sweeps = s.step()?.solver.iterations;
        calm = if sweeps <= first { calm + 1 } else { 0 };
        if calm == 10 {
            break;
        }
    }
    Ok(())
}

/// Peak memory of this process (bytes); NaN if the system does not report it.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let number = line.and_then(|l| l.split_whitespace().next()?.parse().ok());
    number.map_or(f64::NAN, |k: f64| 1024.0 * k)
}
