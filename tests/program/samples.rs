//! Grains that are generated at random or read from tables, grading curves and other runs.

use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use std::path::Path;

use super::grains::{Folder, Sampled, case};

impl Folder {
    /// Builds a case with these grains.
    fn sample<S: Space>(&self, grains: &str) -> Result<Sampled<S>, String> {
        self.build(&case(S::D, "stone", grains, ""))
    }
}

fn refusal<T>(result: Result<T, String>) -> String {
    match result {
        Ok(_) => panic!("it was taken"),
        Err(e) => e,
    }
}

const DEPOSIT: &str = r#"Deposit(material: "grain", count: 300, low: [0.0, 0.0], high: [0.2, 0.2],
    sizes: PowerLaw(exponent: 2.5, radius: (2e-3, 8e-3), by: Mass))"#;

#[test]
fn a_deposit_is_what_the_case_asks_for() {
    let folder = Folder::new("deposit");
    let built = folder
        .sample::<Dim2>(DEPOSIT)
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(built.simulation.shapes.balls.len(), 300);
    assert!(built.samples[0].contains("300 grains placed at random"));
    let none = folder.sample::<Dim2>(&DEPOSIT.replace("count: 300", "count: 30000"));
    let said = refusal(none);
    assert!(said.contains("of 30000 grains fit"), "{said}");
    for (old, new, says) in [
        (
            "(2e-3, 8e-3)",
            "(8e-3, 1e-3)",
            "the smallest radius comes first",
        ),
        ("(2e-3, 8e-3)", "(0.0, 1e-3)", "a radius must be positive"),
        ("exponent: 2.5", "exponent: 1e9", "between -20 and 20"),
        ("[0.2, 0.2]", "[0.2, 0.0]", "greater than that of `low`"),
        ("[0.2, 0.2]", "[0.2]", "2 numbers"),
    ] {
        let said = refusal(folder.sample::<Dim2>(&DEPOSIT.replace(old, new)));
        assert!(said.contains(says), "{said}");
    }
}

#[test]
fn a_grading_curve_gives_the_sizes() {
    let folder = Folder::new("sieve");
    let grains = r#"Deposit(material: "grain", count: 2000, low: [0.0, 0.0, 0.0], high: [0.2, 0.2, 0.2],
        sizes: Sieve(file: "curve.csv"))"#;
    folder.write("curve.csv", "size,passing\n4e-3,0\n8e-3,0.5\n16e-3,1\n");
    let built = folder
        .sample::<Dim3>(grains)
        .unwrap_or_else(|e| panic!("{e}"));
    let cubes = built
        .simulation
        .shapes
        .balls
        .iter()
        .map(|b| (b.radius, b.radius.powi(3)));
    let (below, total) = cubes.fold((0.0, 0.0), |(b, t), (r, c)| {
        (if r <= 4e-3 { b + c } else { b }, t + c)
    });
    // The difference is at most the heaviest grain, twice relative to the total.
    assert!((below / total - 0.5_f64).abs() < 2.0 * 8e-3f64.powi(3) / total);
    for (curve, line, says) in [
        ("size,passing\n4e-3,0.1\n8e-3,1\n", ":2:", "must be 0"),
        ("size,passing\n4e-3,0\n8e-3,0.9\n", ":3:", "must be 1"),
        ("size,passing\n4e-3,0\n4e-3,1\n", ":3:", "sizes must rise"),
        (
            "size,passing\n4e-3,0\n5e-3,50\n9e-3,100\n",
            ":3:",
            "divide percentages by 100",
        ),
        (
            "size,passing\n1e-3,0\n4e-3,0.5\n5e-3,0.2\n9e-3,1\n",
            ":4:",
            "must not fall",
        ),
        ("size,pasing\n4e-3,0\n", ":1:", "unknown column `pasing`"),
    ] {
        folder.write("curve.csv", curve);
        let said = refusal(folder.sample::<Dim3>(grains));
        assert!(said.contains(says) && said.contains(line), "{said}");
    }
}

#[test]
fn a_table_gives_grains() {
    let folder = Folder::new("csv");
    let grains = r#"Csv(file: "grains.csv", material: "grain")"#;
    folder.write(
        "grains.csv",
        "radius,x,y,spin,velocity_y\n1e-2,0.05,0.01,3,-1\n2e-2,0.1,0.02,0,0\n",
    );
    let built = folder
        .sample::<Dim2>(grains)
        .unwrap_or_else(|e| panic!("{e}"));
    let (bodies, balls) = (
        &built.simulation.state.bodies,
        &built.simulation.shapes.balls,
    );
    assert_eq!((balls[0].radius, balls[1].radius), (1e-2, 2e-2));
    assert_eq!(bodies.position[0].padded(), [0.05, 0.01, 0.0]);
    assert_eq!((bodies.velocity[0].y, bodies.spin[0].x), (-1.0, 3.0));
    for (table, line, says) in [
        (
            "x,y,radius\n0.1,0.1,-1e-3\n",
            ":2:",
            "a radius must be positive",
        ),
        (
            "x,y,radius\n0.1,0.1,1e-3\n0.1,1e-3\n",
            ":3:",
            "2 values and the header 3 columns",
        ),
        ("x,y,radius\n0.1,abc,1e-3\n", ":2:", "`abc` of `y`"),
        (
            "x,y,z,radius\n0.1,0.1,0.1,1e-3\n",
            ":1:",
            "unknown column `z`",
        ),
    ] {
        folder.write("grains.csv", table);
        let said = refusal(folder.sample::<Dim2>(grains));
        assert!(said.contains(says) && said.contains(line), "{said}");
    }
    folder.write("grains.csv", "x,y,radius\n0.1,0.1,1e-2\n0.105,0.1,1e-2\n");
    assert!(refusal(folder.sample::<Dim2>(grains)).contains("overlap by"));
    assert!(
        refusal(folder.sample::<Dim2>(&grains.replace("grains.", "grain.")))
            .contains("no such file")
    );
}

/// Positions, velocities and spins at the end of a run are those with which another case begins,
/// bit by bit.
fn round_trip<S: Space>(name: &str, grains: &str) {
    let folder = Folder::new(name);
    let first = case(S::D, "stone", grains, "");
    folder.record(&first);
    // The first run is repeated in this process.
    let built = folder.build::<S>(&first);
    let mut first = built.unwrap_or_else(|e| panic!("{e}")).simulation;
    let steps = |s: &mut fretwork::step::Simulation<S>, n: u32| {
        for _ in 0..n {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
    };
    steps(&mut first, 400);
    let state = r#"State(results: "out", material: "grain")"#;
    let second = folder.sample::<S>(state).unwrap_or_else(|e| panic!("{e}"));
    assert!(
        second.samples[0].contains("state 4"),
        "{}",
        second.samples[0]
    );
    let all = |s: &fretwork::step::Simulation<S>| {
        let mut all: Vec<Vec<u64>> = s
            .shapes
            .balls
            .iter()
            .map(|ball| {
                let b = ball.body as usize;
                let at = s
                    .shapes
                    .periodic
                    .wrapped(s.state.bodies.position[b])
                    .padded();
                let (v, w) = (
                    s.state.bodies.velocity[b].padded(),
                    s.state.bodies.spin[b].padded(),
                );
                let numbers = [at, v, w, [ball.radius, 0.0, 0.0]].concat();
                // Negative zero counts as 0.
                numbers.iter().map(|x| (x + 0.0).to_bits()).collect()
            })
            .collect();
        all.sort_unstable();
        all
    };
    assert_eq!(all(&first), all(&second.simulation));
    assert!(
        first
            .state
            .bodies
            .spin
            .iter()
            .any(|w| *w != S::Spin::zero())
    );
    // An earlier state, and one that does not exist, are read.
    let number = |n: u32| state.replace(")", &format!(", frame: Number({n}))"));
    let start = folder
        .sample::<S>(&number(0))
        .unwrap_or_else(|e| panic!("{e}"));
    assert_ne!(all(&first), all(&start.simulation));
    let said = refusal(folder.sample::<S>(&number(5)));
    assert!(
        said.contains("has the states 0 to 4, not number 5"),
        "{said}"
    );
}

#[test]
fn a_state_of_another_run_goes_on_bit_by_bit() {
    round_trip::<Dim2>("plane", DEPOSIT);
    let solid = r#"Deposit(material: "grain", count: 150, low: [0.0, 0.0, 0.0], high: [0.2, 0.1, 0.05],
        sizes: Uniform(radius: (5e-3, 8e-3)))"#;
    round_trip::<Dim3>("solid", solid);
}

#[test]
fn states_that_cannot_be_read_are_refused_with_a_sentence() {
    let folder = Folder::new("damaged");
    let state = |results: &Path| {
        format!(
            r#"State(results: "{}", material: "grain")"#,
            results.display()
        )
    };
    let missing = refusal(folder.sample::<Dim2>(&state(&folder.0.join("nowhere"))));
    assert!(missing.contains("cannot read"), "{missing}");
    let text = folder.write("text.h5", "no HDF5 at all");
    let said = refusal(folder.sample::<Dim2>(&state(&text)));
    assert!(said.contains("not a file of results"), "{said}");
    let other = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fclib/gfc3d_OneContact.hdf5");
    let said = refusal(folder.sample::<Dim2>(&state(&other)));
    assert!(said.contains("no `/views/grains`"), "{said}");
    // A file cut off at any place: a state or a sentence, never a panic.
    let out = folder.record(&case(2, "stone", DEPOSIT, ""));
    let whole = std::fs::read(out.join("results.h5")).unwrap();
    let cut = folder.0.join("cut.h5");
    for part in 1..40 {
        std::fs::write(&cut, &whole[..whole.len() * part / 40]).unwrap();
        drop(folder.sample::<Dim2>(&state(&cut)));
    }
    let said = refusal(folder.sample::<Dim3>(&state(&out.join("results.h5"))));
    assert!(said.contains("dimension 2"), "{said}");
}
