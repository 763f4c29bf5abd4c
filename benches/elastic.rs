//! Cost of deformable first bodies: a step of a third body between two elastic bodies compared with
//! the step between rigid ones.
//!
//! `cargo bench --bench elastic` builds the same layer six times: 2,016 disks of oxide between two
//! bodies of steel that are pressed together and sheared, with the step, inertia and solver of
//! `cases/wheel_rail_fretting.ron` and its contact law, without bonds, which would add the same
//! time to all. The first bodies are rigid profiles of 513 points, 500 of them along the layer; or
//! elastic half-spaces with as many cells; or elastic bodies with the same points on their
//! surfaces, as deep as the layer is long: once of triangles that grow in both directions with the
//! depth (read from a file as of a mesh generator; `graded` has two rows of cells of each size,
//! `coarse` one), once as a `Block` that coarsens with the depth (`block`), and once as one whose
//! columns of cells reach from side to side (`columns`). Steps of all scenes alternate in one
//! process on one thread; medians of processor time are printed, and for the parts of a step
//! medians by the clock, which are longer where other processes run.
//!
//! Names (`half-space`, `coarse`, `graded`, `block`, `columns`) choose some of the scenes;
//! `PRESS_RIGID`, `PRESS_HALF_SPACE` and `PRESS_ELASTIC` are how far each is pressed (m).
//! `cargo bench --bench elastic -- coulomb` has rigid contacts with Coulomb friction in place of
//! springs. `STEPS` is the number of timed steps (200), `GROWTH` the ratio of the heights of
//! neighbouring rows of a `Block` (1.25).

mod support;

use cpu_time::ThreadTime;
use fretwork::bodies::{DynamicalSystem, SystemStep};
use fretwork::geometry::space::Dim2;
use fretwork::scene::load_text;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use nalgebra::Vector2;
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

type Scene = Simulation<Dim2>;

/// Length of the layer (m), its height before compression (m), and the extent of the bodies beyond
/// it (m).
const LENGTH: f64 = 4e-4;
const HEIGHT: f64 = 3.8e-5;
const BEYOND: f64 = 5e-6;
/// Cells along the surface, and their size (m).
const CELLS: usize = 512;
const SIZE: f64 = (LENGTH + 2.0 * BEYOND) / CELLS as f64;
/// Theta of all scenes: half-spaces have no inertia and need more than 1/2.
const THETA: f64 = 0.6;
/// Length of a step (s), and when timing starts (s).
const STEP: f64 = 2.5e-5;
const WARM: f64 = 0.0215;

/// The first bodies of a scene.
#[derive(Clone, Copy, PartialEq)]
enum First {
    Rigid,
    Graded,
    Coarse,
    Block,
    Columns,
    HalfSpace,
}

impl First {
    fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Graded => "graded",
            Self::Coarse => "coarse",
            Self::Block => "block",
            Self::Columns => "columns",
            Self::HalfSpace => "half-space",
        }
    }
}

/// Writes a body below y = 0 (m) as a file of Gmsh. Each row of cells has as many columns as the
/// one above or half of them, and each cell is cut into triangles by its centre. The arguments give
/// the number of rows of the finest cells and of those of each other size; `up` turns the body
/// over.
fn graded(up: bool, [finest, others]: [usize; 2]) -> String {
    let (mut points, mut triangles): (Vec<[f64; 2]>, Vec<[usize; 3]>) = (Vec::new(), Vec::new());
    let row = |points: &mut Vec<[f64; 2]>, cells: usize, y: f64| -> Vec<usize> {
        let size = SIZE * (CELLS / cells) as f64;
        let first = points.len();
        points.extend((0..=cells).map(|k| [k as f64 * size - BEYOND, y]));
        (first..points.len()).collect()
    };
    let (mut cells, mut y) = (CELLS, 0.0);
    let top = row(&mut points, cells, y);
    let mut above = top.clone();
    let mut rows = 0;
    while y > -LENGTH {
        rows += 1;
        let halved = cells > 8 && rows > if cells == CELLS { finest } else { others };
        let height = SIZE * (CELLS / cells) as f64;
        if halved {
            (cells, rows) = (cells / 2, 0);
        }
        y -= if halved { 1.5 * height } else { height };
        let below = row(&mut points, cells, y);
        for k in 0..cells {
            let mut ring = vec![below[k], below[k + 1]];
            if halved {
                ring.extend([above[2 * k + 2], above[2 * k + 1], above[2 * k]]);
            } else {
                ring.extend([above[k + 1], above[k]]);
            }
            let corners = [below[k], below[k + 1], ring[2], ring[ring.len() - 1]];
            let mean = |axis: usize| corners.iter().map(|p| points[*p][axis]).sum::<f64>() / 4.0;
            let centre = points.len();
            points.push([mean(0), mean(1)]);
            for (j, p) in ring.iter().enumerate() {
                triangles.push([*p, ring[(j + 1) % ring.len()], centre]);
            }
        }
        above = below;
    }
    let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"touches\"\n1 2 \"held\"\n2 3 \"body\"\n$EndPhysicalNames\n".to_owned();
    let _ = writeln!(text, "$Nodes\n{}", points.len());
    for (k, [x, y]) in points.iter().enumerate() {
        let y = if up { -y } else { *y };
        let _ = writeln!(text, "{} {x:e} {y:e} 0", k + 1);
    }
    let lines = [(1, &top), (2, &above)];
    let count = triangles.len() + top.len() + above.len() - 2;
    let _ = writeln!(text, "$EndNodes\n$Elements\n{count}");
    let mut id = 0;
    for (part, line) in lines {
        for pair in line.windows(2) {
            id += 1;
            let _ = writeln!(
                text,
                "{id} 1 2 {part} {part} {} {}",
                pair[0] + 1,
                pair[1] + 1
            );
        }
    }
    for [a, b, c] in triangles {
        id += 1;
        let [b, c] = if up { [c, b] } else { [b, c] };
        let _ = writeln!(text, "{id} 2 2 3 3 {} {} {}", a + 1, b + 1, c + 1);
    }
    text + "$EndElements\n"
}

fn number(name: &str, default: f64) -> f64 {
    let given = std::env::var(name).ok().and_then(|s| s.parse().ok());
    given.unwrap_or(default)
}

/// Deformable first bodies: their meshes are in the folder.
fn elastic(first: First, push: &str, shear: &str, folder: &Path) -> String {
    let bodies = [("rail", false), ("wheel", true)].map(|(name, up)| {
        let rows = match first {
            First::Graded => Some([3, 2]),
            First::Coarse => Some([2, 1]),
            _ => None,
        };
        let (mesh, [touches, held]) = if let Some(rows) = rows {
            let file = format!("{name}.msh");
            std::fs::write(folder.join(&file), graded(up, rows)).unwrap_or_else(|e| panic!("{e}"));
            (format!("Gmsh(file: \"{file}\")"), ["touches", "held"])
        } else {
            let (from, to) = if up { (0.0, LENGTH) } else { (-LENGTH, 0.0) };
            let fine = if up {
                (0.0, 3.0 * SIZE)
            } else {
                (-3.0 * SIZE, 0.0)
            };
            let x = format!(
                "(from: {:e}, to: {:e}, size: {SIZE:e})",
                -BEYOND,
                LENGTH + BEYOND
            );
            let y = format!(
                "(from: {from:e}, to: {to:e}, size: {SIZE:e}, fine: ({:e}, {:e}), growth: {:?})",
                fine.0,
                fine.1,
                number("GROWTH", 1.25)
            );
            let sides = if up {
                ["bottom", "top"]
            } else {
                ["top", "bottom"]
            };
            let coarsen = match first {
                First::Block => format!(", coarsen: (from: \"{}\")", sides[0]),
                _ => String::new(),
            };
            (format!("Block(x: {x}, y: {y}{coarsen})"), sides)
        };
        let (at, x, y) = if up {
            (HEIGHT, shear, push)
        } else {
            (0.0, "Fixed", "Fixed")
        };
        format!(
            r#"(name: "{name}", material: "steel", mesh: {mesh}, position: [0.0, {at:e}],
     supports: [(part: "{held}", x: {x}, y: {y})], touches: Surface("{touches}")),"#
        )
    });
    format!("elastic: [{}{}],", bodies[0], bodies[1])
}

/// Half-spaces with as many cells, relative to a depth as long as the layer.
fn half_spaces(push: &str, shear: &str) -> String {
    let body = |name: &str, side: &str, at: f64, x: &str, y: &str| {
        format!(
            r#"(name: "{name}", material: "steel", side: {side}, position: [0.0, {at:e}], x: (from: {:e}, to: {:e}, size: {SIZE:e}),
     depth: {:e}, dofs: (x: {x}, y: {y}), touches: Surface),"#,
            -BEYOND,
            LENGTH + BEYOND,
            LENGTH + 2.0 * BEYOND
        )
    };
    format!(
        "half_spaces: [{}{}],",
        body("rail", "Below", 0.0, "Fixed", "Fixed"),
        body("wheel", "Above", HEIGHT, shear, push)
    )
}

/// Rigid first bodies with the same points.
fn rigid(push: &str, shear: &str) -> String {
    let at = |k: usize| format!("({:e}, 0.0)", SIZE * k as f64 - BEYOND);
    let points: Vec<String> = (0..=CELLS).map(at).collect();
    let points = points.join(", ");
    format!(
        r#"(name: "rail", material: "steel", shapes: [Profile(points: [{points}], side: Below)]),
    (name: "wheel", material: "steel", position: [0.0, {HEIGHT:e}], shapes: [Profile(points: [{points}], side: Above)],
     dofs: (x: {shear}, y: {push}, rz: Fixed)),"#
    )
}

/// The case, with its meshes in a folder.
fn case(first: First, coulomb: bool, folder: &Path) -> String {
    // All scenes are pressed by one displacement, which gives them about equal numbers of contacts.
    let press = match first {
        First::Rigid => number("PRESS_RIGID", 9.0e-6),
        First::HalfSpace => number("PRESS_HALF_SPACE", 9.0e-6),
        _ => number("PRESS_ELASTIC", 9.0e-6),
    };
    let push = format!(
        "Velocity(Table([(0.0, 0.0), (0.004, {0:e}), (0.014, {0:e}), (0.018, 0.0)]))",
        -press / 0.014
    );
    let shear = "Velocity(Ramp(from: 0.0, to: 3e-4, start: 0.018, end: 0.02))";
    let (of_list, alone) = match first {
        First::Rigid => (rigid(&push, shear), String::new()),
        First::HalfSpace => (String::new(), half_spaces(&push, shear)),
        _ => (String::new(), elastic(first, &push, shear, folder)),
    };
    let (law, solver) = if coulomb {
        (
            "coulomb",
            "(tolerance: 1e-3, max_iterations: 20000, test_every: 20, correction: 0.05)",
        )
    } else {
        (
            "hertz-mindlin",
            "(norm: Power, tolerance: 0.5, max_iterations: 20000)",
        )
    };
    let pairs = ["oxide", "steel", "wall"].map(|other| {
        format!(
            r#"(name: "{other}_oxide", between: ("{other}", "oxide"), parameters_from: "oxide_third_body", contact: "{law}", parameters: (contact: {{}}))"#
        )
    });
    format!(
        r#"(
    name: "layer",
    dimension: 2,
    seed: 7,
    time: (step: {STEP:e}, end: 1.0, theta: {THETA}),
    inertia_scaling: 5.8e8,
    detection: (alert: 2e-7, skin: 5e-7),
    solver: {solver},
    materials: {{"oxide": "magnetite", "steel": "rail_steel_r260", "wall": "magnetite"}},
    interfaces: [{}],
    bodies: [
    (name: "sides", material: "wall", shapes: [
        HalfSpace(normal: (1.0, 0.0)),
        HalfSpace(normal: (-1.0, 0.0), at: ({LENGTH:e}, 0.0)),
    ]),
    {of_list}
    ],
    {alone}
    grains: [Lattice(material: "oxide", count: {GRAINS}, radius: (1.05e-6, 1.385e-6), low: [0.0, 2e-7], high: [{LENGTH:e}, {HEIGHT:e}])],
)"#,
        pairs.join(", ")
    )
}

fn build(first: First, coulomb: bool) -> Scene {
    let folder = std::env::temp_dir();
    let text = case(first, coulomb, &folder);
    let loaded = load_text("layer", &text, &folder, &[]);
    let loaded = loaded.unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<Dim2>(&search_path());
    let mut scene = built.unwrap_or_else(|e| panic!("{e}"));
    scene.options.solver.parallel = number("THREADS", 1.0) > 1.0;
    scene
}

/// Number of grains, which come first among the bodies; then sides, rail and wheel.
const GRAINS: u32 = 2016;

/// Whether a body is none of the grains.
fn is_first(body: u32) -> bool {
    body >= GRAINS
}

/// Mean pressure of the layer on the wheel (Pa).
fn pressure(scene: &Scene) -> f64 {
    let contacts = scene.state.network.contacts.iter();
    let forces = contacts.map(|c| {
        let k = c.bodies.iter().position(|b| is_first(*b));
        let at = k.map(|k| scene.state.bodies.position[c.bodies[1 - k] as usize].y);
        match at {
            Some(y) if y > 0.4 * HEIGHT && c.normal.y.abs() > 0.9 => c.impulse.y.abs(),
            _ => 0.0,
        }
    });
    forces.sum::<f64>() / STEP / LENGTH
}

#[derive(Default)]
struct Times {
    total: Vec<f64>,
    detect: Vec<f64>,
    laws: Vec<f64>,
    solve: Vec<f64>,
    sweeps: Vec<f64>,
    contacts: Vec<f64>,
    touching: Vec<f64>,
    pressure: Vec<f64>,
    unconverged: usize,
    rebuilds: u64,
}

impl Times {
    fn step(&mut self, scene: &mut Scene) {
        let ms = |d: Duration| d.as_secs_f64() * 1e3;
        let clock = ThreadTime::now();
        let rebuilds = scene.state.network.rebuilds;
        let report = scene.step().unwrap_or_else(|e| panic!("{e}"));
        self.rebuilds += scene.state.network.rebuilds - rebuilds;
        self.total.push(ms(clock.elapsed()));
        self.detect.push(ms(report.timing.detect));
        self.laws.push(ms(report.timing.laws));
        self.solve.push(ms(report.timing.solve));
        self.sweeps.push(f64::from(report.solver.iterations));
        let contacts = &scene.state.network.contacts;
        self.contacts.push(contacts.len() as f64);
        let first = |c: &&fretwork::contact::Contact<Dim2>| c.bodies.iter().any(|b| is_first(*b));
        self.touching
            .push(contacts.iter().filter(first).count() as f64);
        self.pressure.push(1e-9 * pressure(scene));
        self.unconverged += usize::from(!report.solver.converged);
    }

    fn print(&self, name: &str) {
        let [
            total,
            detect,
            laws,
            solve,
            sweeps,
            contacts,
            touching,
            pressure,
        ] = [
            &self.total,
            &self.detect,
            &self.laws,
            &self.solve,
            &self.sweeps,
            &self.contacts,
            &self.touching,
            &self.pressure,
        ]
        .map(|v| median(v));
        let rest = total - detect - laws - solve;
        println!("{name}: {} new neighbour lists", self.rebuilds);
        println!(
            "{name:<8} {contacts:>9.0} {touching:>9.0} {pressure:>6.2} {sweeps:>7.0} {total:>9.2} {detect:>9.2} {laws:>9.2} {solve:>9.2} {rest:>9.2}{}",
            match self.unconverged {
                0 => String::new(),
                n => format!("  ({n} steps unconverged)"),
            }
        );
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

/// Median time of a call (ms).
fn time(mut call: impl FnMut()) -> f64 {
    let one = |_| {
        let clock = ThreadTime::now();
        call();
        clock.elapsed().as_secs_f64() * 1e3
    };
    median(&(0..21).map(one).collect::<Vec<_>>())
}

fn main() {
    support::refuse_unoptimised();
    let coulomb = std::env::args().skip(1).any(|a| a == "coulomb");
    let steps = number("STEPS", 200.0) as usize;
    let warm = number("WARM", WARM);
    let all = [
        First::Rigid,
        First::HalfSpace,
        First::Coarse,
        First::Graded,
        First::Block,
        First::Columns,
    ];
    let named = |first: &First| std::env::args().any(|a| a == first.name());
    let any = all.iter().any(named);
    let scenes = all
        .iter()
        .filter(|f| !any || named(f) || **f == First::Rigid);
    let mut scenes: Vec<_> = scenes
        .map(|first| (*first, build(*first, coulomb), Times::default()))
        .collect();
    for (_, scene, _) in &mut scenes {
        while scene.state.time < warm {
            scene.step().unwrap_or_else(|e| panic!("{e}"));
        }
    }
    for _ in 0..steps {
        for (_, scene, times) in &mut scenes {
            times.step(scene);
        }
    }
    println!("{GRAINS} grains, medians of {steps} steps (ms), pressure in GPa");
    println!(
        "{:<8} {:>9} {:>9} {:>6} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "first", "contacts", "of first", "GPa", "sweeps", "step", "detect", "laws", "solve", "rest"
    );
    for (first, _, times) in &scenes {
        times.print(first.name());
    }
    let base = &scenes[0].2.total;
    for (first, scene, times) in &scenes[1..] {
        let pairs = times.total.iter().zip(base);
        let ratios: Vec<f64> = pairs.map(|(e, r)| e / r).collect();
        println!(
            "{}: {:.2} times the step with rigid first bodies (median of the ratios of pairs of steps {:.2})",
            first.name(),
            median(&times.total) / median(base),
            median(&ratios)
        );
        for k in 0..scene.state.systems.len() {
            if let Some(system) = scene.state.systems.get(k) {
                parts(system, scene.state.time);
            }
        }
    }
}

/// Times the functions of a body that a step calls.
fn parts(system: &dyn DynamicalSystem<Dim2>, time_now: f64) {
    let step = SystemStep::<Dim2> {
        time: time_now,
        h: STEP,
        theta: THETA,
        gravity: Vector2::zeros(),
    };
    let contactors = system.contactors();
    let vertices = contactors
        .first()
        .map_or(0, |c| system.surface_vertices(c).len());
    let mut other = system.clone_box();
    // The step is changed to another length and back, so that both are factorised again.
    let clock = Instant::now();
    other.begin_step(&SystemStep {
        h: 0.5 * STEP,
        ..step
    });
    let form = clock.elapsed().as_secs_f64() * 1e3;
    other.begin_step(&step);
    let mut impulses = vec![0.0; system.freedoms()];
    for node in (0..vertices as u32).step_by(3) {
        system.add_impulse(node, &Vector2::new(0.0, 1.0), &mut impulses);
    }
    let size = system.size().unwrap_or_default();
    println!(
        "    {}: {} unknowns, {vertices} points of its surface; matrix {:.1} MB, factor {:.1} MB; formed once in {form:.0} ms. Calls (ms): begin {:.2}, free velocity {:.2}, \
         response to impulses {:.2}, work {:.2}, energies {:.2}, vertices {:.3}",
        system.name(),
        system.freedoms(),
        size.matrix as f64 / 1e6,
        size.factor as f64 / 1e6,
        time(|| other.begin_step(&step)),
        time(|| {
            black_box(system.free_velocity(&step));
        }),
        time(|| {
            let mut impulse = impulses.clone();
            system.solve(&mut impulse);
            black_box(impulse);
        }),
        time(|| {
            black_box(system.work(&step));
        }),
        time(|| {
            black_box(system.kinetic_energy() + system.stored_energy());
        }),
        time(|| {
            black_box(system.surface_vertices(&contactors[0]));
        }),
    );
}
