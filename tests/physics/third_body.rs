//! The third body compared with closed forms: affine and rigid fields, cut disks and balls, a
//! column under gravity, stress, and energies by place against the ledger.

use crate::scene;
use fretwork::energy::Energy;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::record::measure::measures;
use fretwork::record::run::write_outputs;
use fretwork::record::statistics::Table;
use fretwork::record::stress::love_weber;
use fretwork::record::summary::Uncertainty;
use fretwork::record::{RunEnd, Summary};
use fretwork::scene::{LoadedCase, load_text};
use fretwork::step::Simulation;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

fn own(name: &str) -> PathBuf {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let name = format!("fretwork-third-body-{}-{number}{name}", std::process::id());
    std::env::temp_dir().join(name)
}

fn case(dimension: usize, lines: &str) -> String {
    format!(
        r#"(
    name: "third body",
    dimension: {dimension},
    time: (step: 1e-4, end: 1.0),
    solver: (tolerance: 1e-12, max_iterations: 200000),
    materials: {{"glass": "glass_bead"}},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb", parameters: (contact: {{"mu": 0.5}}))],
    {lines}
)"#
    )
}

fn opened(text: &str) -> Result<LoadedCase, String> {
    load_text("test.ron", text, Path::new("."), &[]).map_err(|e| e.to_string())
}

/// A floor at the origin, a lid at a height, and disks or balls between; cells of one metre along x
/// (and y).
fn between<S: Space>(height: f64, grains: &[([f64; 3], f64)], bins: usize) -> String {
    let list: Vec<String> = grains
        .iter()
        .map(|(at, r)| format!("(at: {:?}, radius: {r})", &at[..S::D]))
        .collect();
    let (up, down, at, period) = if S::D == 2 {
        ("[0, 1]", "[0, -1]", format!("[0, {height}]"), "x: 1.0")
    } else {
        (
            "[0, 0, 1]",
            "[0, 0, -1]",
            format!("[0, 0, {height}]"),
            "x: 1.0, y: 1.0",
        )
    };
    let text = format!(
        r#"periodic: ({period}),
        bodies: [
            (name: "rail", material: "glass", shapes: [HalfSpace(normal: {up})]),
            (name: "wheel", material: "glass", shapes: [HalfSpace(normal: {down})], position: {at}),
        ],
        grains: [List(material: "glass", grains: [{}])],
        measures: [ThirdBody(name: "layer", between: ("rail", "wheel"), along: 0, across: {}, bins: {bins}, slices: 1)],"#,
        list.join(", "),
        S::D - 1
    );
    case(S::D, &text)
}

/// Results of a measure for one state.
struct Seen<S: Space> {
    row: BTreeMap<String, f64>,
    profile: BTreeMap<String, Vec<f64>>,
    regime: String,
    simulation: Simulation<S>,
}

/// Changes a scene, evaluates it once a second later, and reads the files.
fn seen<S: Space>(text: &str, change: impl FnOnce(&mut Simulation<S>)) -> Seen<S> {
    let loaded = opened(text).unwrap_or_else(|e| panic!("{e}"));
    let mut s = scene::simulation::<S>(&loaded);
    let case = &loaded.case;
    let mut observers = measures(&case.measures, case.inertia_scaling, &s);
    observers.begin(&mut s);
    change(&mut s);
    s.state.time += 1.0;
    let values = observers.sample(&s).unwrap();
    let columns = observers.columns();
    let out = own("");
    std::fs::create_dir_all(&out).unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<String> = columns.iter().map(|c| c.name.clone()).collect();
    let row = names.into_iter().zip(values).collect();
    let table = Table::create(&out.join("t.csv"), columns, S::D).unwrap_or_else(|e| panic!("{e}"));
    let end = RunEnd {
        simulation: &s,
        table: &table,
        title: "test",
        uncertainty: &Uncertainty::default(),
        wall: Duration::ZERO,
    };
    let drawn = write_outputs(&out, &observers.figures(&end), end.table);
    drawn.unwrap_or_else(|e| panic!("{e}"));
    // Slice 0 is the whole time.
    let mut profile = read(&out.join("layer.csv"));
    let first: Vec<bool> = profile["slice"].iter().map(|s| *s == 0.0).collect();
    for column in profile.values_mut() {
        let mut kept = first.iter();
        column.retain(|_| *kept.next().unwrap_or(&false));
    }
    let found = observers.report(&end);
    let regime = found.text("findings.layer_regime").unwrap().to_owned();
    let _ = std::fs::remove_dir_all(out);
    Seen {
        row,
        profile,
        regime,
        simulation: s,
    }
}

/// Columns of a file by name, without units; text is read as NaN.
fn read(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{e}"));
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default().split(',');
    let names: Vec<String> = header
        .map(|n| n.split(" [").next().unwrap_or_default().to_owned())
        .collect();
    let mut out: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for line in lines {
        for (name, value) in names.iter().zip(line.split(',')) {
            let value = value.parse().unwrap_or(f64::NAN);
            out.entry(name.clone()).or_default().push(value);
        }
    }
    out
}

fn close(obtained: f64, expected: f64, tolerance: f64) {
    assert!(
        (obtained - expected).abs() <= tolerance,
        "{obtained} in place of {expected} within {tolerance}"
    );
}

/// Ten by twenty disks on a square lattice, a metre wide and two high.
fn lattice() -> Vec<([f64; 3], f64)> {
    let at = |i: usize, j: usize| [0.05 + 0.1 * i as f64, 0.05 + 0.1 * j as f64, 0.0];
    let rows = (0..20).flat_map(|j| (0..10).map(move |i| (i, j)));
    rows.map(|(i, j)| (at(i, j), 0.05)).collect()
}

fn body<S: Space>(s: &Simulation<S>, name: &str) -> usize {
    let found = s.state.bodies.driven.iter().find(|d| d.name == name);
    found.map_or_else(|| panic!("no body {name}"), |d| d.body as usize)
}

/// Gives grains and wheel velocities along x that depend on the height.
fn sheared(s: &mut Simulation<Dim2>, v: impl Fn(f64) -> f64) {
    let wheel = body(s, "wheel");
    for b in s.state.bodies.grains().collect::<Vec<_>>() {
        s.state.bodies.velocity[b].x = v(s.state.bodies.position[b].y);
    }
    s.state.bodies.velocity[wheel].x = v(2.0);
}

/// An affine field: the profile is straight and passes through both walls, and the granular
/// temperature is zero, whether bins coincide with the rows or not; the lattice fills pi/4 of every
/// bin that contains whole rows.
#[test]
fn an_affine_field_is_couette_without_granular_temperature() {
    for bins in [10, 20, 7, 33] {
        let text = between::<Dim2>(2.0, &lattice(), bins);
        let seen = seen::<Dim2>(&text, |s| sheared(s, |y| 0.3 * y));
        let p = &seen.profile;
        for (w, y) in p["velocity_over_sliding"]
            .iter()
            .zip(&p["mass_depth_over_thickness"])
        {
            close(*w, *y, 1e-12);
        }
        // The values are relative to V^2 = 0.36.
        assert!(
            p["granular_temperature"].iter().all(|t| t.abs() < 1e-26),
            "{bins}"
        );
        close(seen.row["layer_granular_temperature"], 0.0, 1e-26);
        close(seen.row["layer_thickness"], 2.0, 1e-15);
        close(seen.row["layer_solid_fraction"], PI / 4.0, 1e-12);
        close(seen.row["layer_sliding"], 0.6, 1e-15);
        assert_eq!(seen.row["layer_regime"], 1.0);
        assert!(seen.regime.starts_with("Couette"), "{}", seen.regime);
        if 20 % bins == 0 {
            assert!(
                p["solid_fraction"]
                    .iter()
                    .all(|f| (f - PI / 4.0).abs() < 1e-12)
            );
        }
    }
}

/// With the first body above the second, depths of the layer are measured downwards from it.
#[test]
fn a_layer_may_be_looked_at_from_above() {
    let text = between::<Dim2>(2.0, &lattice(), 10).replace(
        "between: (\"rail\", \"wheel\")",
        "between: (\"wheel\", \"rail\")",
    );
    let seen = seen::<Dim2>(&text, |s| sheared(s, |y| 0.3 * y));
    let p = &seen.profile;
    for (k, w) in p["velocity_over_sliding"].iter().enumerate() {
        close(*w, 0.05 + 0.1 * k as f64, 1e-12);
    }
    close(seen.row["layer_sliding"], -0.6, 1e-15);
}

/// A layer that moves rigidly at 0.3 of the wheel's velocity has no granular temperature, and slip
/// of 0.3 and 0.7.
#[test]
fn a_rigid_layer_is_a_plug() {
    let text = between::<Dim2>(2.0, &lattice(), 20);
    let seen = seen::<Dim2>(&text, |s| sheared(s, |y| if y < 2.0 { 0.3 } else { 1.0 }));
    close(seen.row["layer_slip_first"], 0.3, 1e-12);
    close(seen.row["layer_slip_second"], 0.7, 1e-12);
    close(seen.row["layer_granular_temperature"], 0.0, 1e-26);
    assert_eq!(seen.row["layer_regime"], 3.0);
    assert!(seen.regime.starts_with("plug"), "{}", seen.regime);
}

/// With velocities +u and -u alternating in each row, <v> is zero and T = u^2/2 in 2D.
#[test]
fn a_granular_temperature_is_the_mean_square_by_the_dimension() {
    let text = between::<Dim2>(2.0, &lattice(), 10);
    let seen = seen::<Dim2>(&text, |s| {
        for (k, b) in s
            .state
            .bodies
            .grains()
            .collect::<Vec<_>>()
            .into_iter()
            .enumerate()
        {
            s.state.bodies.velocity[b].y = if k % 2 == 0 { 0.2 } else { -0.2 };
        }
    });
    assert!(
        seen.profile["granular_temperature"]
            .iter()
            .all(|t| (t - 0.02).abs() < 1e-15)
    );
    assert_eq!(seen.row["layer_regime"], 0.0);
    let kelvin = ["temperature", "layer_temperature"];
    assert!(!seen.profile.contains_key(kelvin[0]) && !seen.row.contains_key(kelvin[1]));
}

/// Ten rows of a poor conductor at 300 K lie below ten rows of steel at 400 K: a bin that is cut in
/// half by the border has their mean by mass.
#[test]
fn temperatures_of_a_layer_are_means_by_mass() {
    let (below, above): (Vec<_>, Vec<_>) = lattice().into_iter().partition(|(at, _)| at[1] < 1.0);
    let above: Vec<String> = above
        .iter()
        .map(|(at, r)| format!("(at: {:?}, radius: {r})", &at[..2]))
        .collect();
    let upper = format!(
        "grains: [List(material: \"steel\", grains: [{}]), List",
        above.join(", ")
    );
    let text = between::<Dim2>(2.0, &below, 7)
        .replace("grains: [List", &upper)
        .replace(
            "{\"glass\": \"glass_bead\"}",
            "{\"glass\": \"verification_oxide\", \"steel\": \"verification_steel\"}, \
             heat: (initial: 300.0, grains: {\"steel\": 400.0})",
        );
    let seen = seen::<Dim2>(&text, |_| {});
    let mean = (5000.0 * 300.0 + 7850.0 * 400.0) / 12850.0;
    let expected = [300.0, 300.0, 300.0, mean, 400.0, 400.0, 400.0];
    let found = &seen.profile["temperature"];
    assert_eq!(found.len(), expected.len());
    for (t, expected) in found.iter().zip(expected) {
        close(*t, expected, 1e-9);
    }
    close(seen.row["layer_temperature"], mean, 1e-9);
    assert!(
        seen.profile["granular_temperature"]
            .iter()
            .all(|t| *t == 0.0)
    );
}

/// A grain of unit radius in the middle of three bins of a metre: the outer bins contain a segment
/// of height 1/2.
#[test]
fn a_grain_is_cut_exactly() {
    let segment = PI / 3.0 - 3f64.sqrt() / 4.0;
    let wide = |text: String| text.replace("x: 1.0", "x: 8.0").replace("y: 1.0", "y: 8.0");
    let flat = between::<Dim2>(3.0, &[([2.0, 1.5, 0.0], 1.0)], 3);
    let flat = seen::<Dim2>(&wide(flat), |_| {}).profile;
    for (f, area) in flat["solid_fraction"]
        .iter()
        .zip([segment, PI - 2.0 * segment, segment])
    {
        close(*f, area / 8.0, 1e-15);
    }
    // A cap of height h = 1/2: pi h^2 (3 - h)/3.
    let cap = PI * 0.25 * 2.5 / 3.0;
    let solid = between::<Dim3>(3.0, &[([2.0, 2.0, 1.5], 1.0)], 3);
    let solid = seen::<Dim3>(&wide(solid), |_| {}).profile;
    let whole = 4.0 / 3.0 * PI;
    for (f, volume) in solid["solid_fraction"]
        .iter()
        .zip([cap, whole - 2.0 * cap, cap])
    {
        close(*f, volume / 64.0, 1e-15);
    }
}

/// In a column of eight disks the stress between a centre and the contact above it is the weight
/// above.
#[test]
fn a_column_carries_the_weight_above() {
    let disks: Vec<_> = (0..8)
        .map(|k| ([0.5, 0.05 + 0.1 * f64::from(k), 0.0], 0.05))
        .collect();
    let text = between::<Dim2>(0.8 + 1e-9, &disks, 16)
        .replace("periodic", "gravity: [0, -9.81], periodic");
    let seen = seen::<Dim2>(&text, |s| {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    });
    let s = &seen.simulation;
    let grain = s.state.bodies.grains().next().unwrap_or_default();
    let weight = 9.81 * s.state.bodies.mass[grain];
    for (k, p) in seen.profile["stress_across"].iter().enumerate() {
        // In the lower half of disk j the weight of the disk counts too.
        let above = (8 - k.div_ceil(2)) as f64;
        close(*p, above * weight, 1e-6 * weight);
    }
    assert!(
        seen.profile["stress_shear"]
            .iter()
            .all(|t| t.abs() < 1e-6 * weight)
    );
    // The load is above the mean in the lower half of the column, which is therefore an upright
    // chain.
    close(seen.row["layer_chain_angle"], 0.0, 1e-6);
    close(seen.row["layer_chains"], 0.5, 1e-12);
    close(seen.row["layer_chain_length"], 4.0, 1e-12);
    assert_eq!(seen.row["layer_coordination"], 15.0 / 8.0);
}

/// The stresses of the bins add up to that of the whole layer, in 2D and 3D.
#[test]
fn stresses_of_the_bins_add_up() {
    fn added<S: Space>(grains: &[([f64; 3], f64)]) {
        let side = S::D - 1;
        let text = between::<S>(0.55, grains, 9).replace(
            "periodic:",
            if S::D == 2 {
                "gravity: [3.0, -9.81], periodic:"
            } else {
                "gravity: [3.0, 1.0, -9.81], periodic:"
            },
        );
        let text = text.replace("tolerance: 1e-12", "tolerance: 1e-6");
        let seen = seen::<S>(&text, |s| {
            for _ in 0..400 {
                s.step().unwrap_or_else(|e| panic!("{e}"));
            }
        });
        let total = love_weber(&seen.simulation, 0.55);
        let scale = total[side][side];
        assert!(scale > 0.0);
        let expected = [
            ("across", total[side][side]),
            ("along", total[0][0]),
            ("shear", -total[0][side]),
        ];
        for (name, value) in expected {
            close(
                seen.row[&format!("layer_stress_{name}")],
                value,
                1e-12 * scale,
            );
            let mean = &seen.profile[&format!("stress_{name}")];
            let mean = mean.iter().sum::<f64>() / mean.len() as f64;
            // Without sliding the sign of the shear stress is +.
            close(mean, value, 1e-12 * scale);
        }
        if S::D == 3 {
            close(seen.row["layer_stress_lateral"], total[1][1], 1e-12 * scale);
        }
    }
    let shift = |k: usize| 0.013 * ((k * 7) % 5) as f64;
    let disks: Vec<_> = (0..40)
        .map(|k| {
            (
                [
                    0.12 * (k % 8) as f64 + 0.01 * (k / 8) as f64,
                    0.05 + 0.102 * (k / 8) as f64,
                    0.0,
                ],
                0.05,
            )
        })
        .collect();
    added::<Dim2>(&disks);
    let balls: Vec<_> = (0..27)
        .map(|k| {
            let at = [
                0.33 * (k % 3) as f64 + shift(k),
                0.33 * (k / 3 % 3) as f64,
                0.08 + 0.161 * (k / 9) as f64,
            ];
            (at, 0.08)
        })
        .collect();
    added::<Dim3>(&balls);
}

fn fretting(sets: &[&str], look: impl FnOnce(&Path)) -> Summary {
    scene::ran("wheel_rail_rigid", sets, look)
}

/// Energies by place and by bin add up to those of the ledger, mechanism by mechanism; the friction
/// coefficient from the work of sliding is that from dissipated and stored energy.
#[test]
fn energies_by_place_are_those_of_the_ledger() {
    let sets = [
        "time.end=0.06",
        "output.frames=0",
        "output.views=0",
        "output.every=7",
        "measures=[ThirdBody(name: \"layer\", between: (\"rail\", \"wheel\"), along: 0, across: 1, every: 3)]",
    ];
    let mut table = BTreeMap::new();
    let summary = fretting(&sets, |out| table = read(&out.join("layer_energy.csv")));
    let found = &summary.found;
    let e = found.get::<Energy>().unwrap();
    let m = |name: &str| found.number(&format!("measures.layer_{name}")).unwrap();
    assert!(found.number("broken").unwrap() > 0.0 && e.friction > 0.0);
    let booked = [
        ("friction", e.friction),
        ("impact", e.impact + e.adhesion),
        ("fracture", e.fracture),
        ("viscous", e.viscous),
        ("correction", e.correction),
    ];
    for (name, value) in booked {
        close(m(&format!("dissipated_{name}")), value, 1e-12 * e.scale);
        // There are five places, followed by the bins.
        let column = &table[name];
        close(column[..5].iter().sum(), value, 1e-12 * e.scale);
        close(column[5..].iter().sum(), value, 1e-12 * e.scale);
    }
    let places = ["grain_grain", "rail_grain", "wheel_grain"];
    close(
        places.iter().map(|p| m(&format!("share_{p}"))).sum(),
        1.0,
        1e-12,
    );
    let forces = m("mu_from_forces");
    close(m("mu_from_dissipation"), forces, 1e-9 * forces.abs());
    let mus: f64 = places.iter().map(|p| m(&format!("mu_{p}"))).sum();
    close(mus + m("mu_kept"), forces, 1e-9 * forces.abs());
    assert!(found.text("findings.layer_regime").is_some());
}

#[test]
fn wrong_layers_are_refused() {
    let good = between::<Dim2>(2.0, &[([0.5, 0.5, 0.0], 0.1)], 20);
    assert!(opened(&good).is_ok());
    for (old, new, said) in [
        (
            "between: (\"rail\", \"wheel\")",
            "between: (\"rial\", \"wheel\")",
            "there is no body `rial`",
        ),
        (
            "between: (\"rail\", \"wheel\")",
            "between: (\"rail\", \"rail\")",
            "not between `rail` and `rail`",
        ),
        ("across: 1", "across: 0", "take two different axes"),
        ("across: 1", "across: 2", "axis 2 does not exist"),
        ("bins: 20", "bins: 0", "needs 1 to 10000 bins, got 0"),
        ("slices: 1", "slices: 0", "needs 1 to 20 slices"),
        ("slices: 1", "every: 0", "every second"),
        ("x: 1.0", "x: 1.0, y: 2.0", "across a period"),
    ] {
        assert_eq!(good.matches(old).count(), 1, "{old}");
        match opened(&good.replace(old, new)) {
            Err(e) => assert!(e.contains(said), "{e}"),
            Ok(_) => panic!("accepted: {new}"),
        }
    }
}
