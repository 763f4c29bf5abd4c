//! Every shipped law passes certification; laws with one defect fail where they should and nowhere
//! else.

use fretwork::certify::{Certificate, CheckOutcome, certify, certify_parameters};
use fretwork::geometry::space::Dim2;
use fretwork::laws::bench::{Bench, BenchMotion};
use fretwork::laws::{Interface, Kind, LoadedLaw, Plugin, SearchPath};
use fretwork::scene::load;
use fretwork::shipped::{built_in, search_path};
use fretwork::step::Simulation;
use fretwork_abi::FLAG_OPENING;
use std::path::Path;
use std::process::Command;

fn certificate(plugin: &Plugin) -> Certificate {
    let defaults: Vec<f64> = plugin.parameters.iter().map(|p| p.default).collect();
    certify(plugin, &defaults, None, &search_path()).unwrap_or_else(|e| panic!("{e}"))
}

fn broken(certificate: &Certificate) -> Vec<&str> {
    let failed = |l: &&fretwork::certify::CheckResult| l.outcome == CheckOutcome::Fail;
    certificate
        .lines
        .iter()
        .filter(failed)
        .map(|l| l.check.as_str())
        .collect()
}

#[test]
fn every_shipped_law_is_certified() {
    let (path, mut count) = (search_path(), 0);
    for (kind, name, place) in path.laws() {
        let found = certificate(&path.open_law(kind, &name, &place).unwrap());
        assert!(found.certified(), "{kind} {name}: {:#?}", found.lines);
        count += 1;
    }
    assert_eq!(count, 53);
}

/// Built-in laws have no separate memory that could be compared before and after calls, as a
/// library has: their sources declare no static memory.
#[test]
fn shipped_laws_have_no_static_memory() {
    let mut files = 0;
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("plugins/laws/src")];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().path())
        {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let declared = |l: &str| {
                l.trim_start()
                    .trim_start_matches("pub ")
                    .starts_with("static ")
            };
            let kept = text.lines().any(declared) || text.contains("thread_local");
            assert!(!kept, "{}", path.display());
            files += 1;
        }
    }
    assert!(files > 50, "{files}");
}

/// Laws are also certified with the parameters of shipped cases: no case reports its own laws.
#[test]
fn laws_of_shipped_cases_are_certified() {
    let path = search_path();
    let mut known: Vec<(String, Vec<f64>)> = Vec::new();
    for folder in ["cases", "cases/verification"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let files = std::fs::read_dir(folder).unwrap().flatten();
        let cases = files.map(|f| f.path());
        for case in cases.filter(|p| p.extension().is_some_and(|e| e == "ron")) {
            let built = load(&case, &[]).and_then(|loaded| loaded.build(&path));
            let built = built.unwrap_or_else(|e| panic!("{e}"));
            let laws = built.simulation.laws();
            for (interface, law) in laws.iter().flat_map(|i| i.loaded().map(move |l| (i, l))) {
                let damage = law.plugin.kind == Kind::DAMAGE;
                let partner = interface.cohesion().filter(|_| damage);
                let beside = partner.map_or(&[][..], |c| &c.parameters);
                let key = (
                    format!("{} {}", law.plugin.kind, law.plugin.name),
                    [&law.parameters, beside].concat(),
                );
                if known.contains(&key) {
                    continue;
                }
                let found = certify_parameters(&law.plugin, &law.parameters, partner, &path);
                let found = found.unwrap_or_else(|e| panic!("{}: {e}", case.display()));
                assert!(found.certified(), "{}: {:#?}", case.display(), found.lines);
                known.push(key);
            }
        }
    }
    assert!(known.len() > 20, "{}", known.len());
}

/// Every damage law with every cohesion law that has an opening: in loading, unloading and loading
/// again D grows, and no work is gained.
#[test]
fn any_damage_goes_with_any_cohesion_that_opens() {
    let path = search_path();
    let laws = path.laws();
    let loaded = |kind: Kind, name: &str| {
        let plugin = path.find(kind, name).unwrap_or_else(|e| panic!("{e}"));
        LoadedLaw::with_defaults(plugin)
    };
    let (mut pairs, mut refused) = (0, 0);
    for (_, cohesion, _) in laws.iter().filter(|l| l.0 == Kind::COHESION) {
        for (_, damage, _) in laws.iter().filter(|l| l.0 == Kind::DAMAGE) {
            let bond = loaded(Kind::COHESION, cohesion);
            let opens = bond.has(FLAG_OPENING);
            let contact = loaded(Kind::CONTACT, "frictionless");
            let laws = [contact, bond, loaded(Kind::DAMAGE, damage)];
            let law = match Interface::new("pair", laws) {
                Ok(law) => law,
                Err(e) => {
                    assert!(!opens && e.to_string().contains("no opening"), "{e}");
                    refused += 1;
                    continue;
                }
            };
            let mut bench = Bench::new(law, 3, 1e-5);
            let mut state = [bench.fresh()];
            let (mut work, mut last) = (0.0, (0.0, 0.0, 0.0));
            for k in 1..=4000 {
                let u = 2e-5 * (f64::from(k) / 4000.0 * 6.0).sin().abs() * f64::from(k) / 4000.0;
                let motion = BenchMotion {
                    opening: [0.6 * u, 0.8 * u, 0.0],
                    ..BenchMotion::default()
                };
                let a = bench
                    .step(&mut state, &[motion], 1e-4)
                    .unwrap_or_else(|e| panic!("{cohesion} {damage}: {e}"))[0];
                assert!(a.damage >= last.2 && a.damage <= 1.0, "{cohesion} {damage}");
                let t = 0.6 * a.traction[0] + 0.8 * a.traction[1];
                work += 0.5 * (t + last.1) * (u - last.0);
                last = (u, t, a.damage);
            }
            assert!(work >= 0.0, "{cohesion} {damage}: {work}");
            pairs += 1;
        }
    }
    assert_eq!((pairs, refused), (7 * 11, 6 * 11));
}

/// Compiles `law.c` with one defect against the header in `include`.
fn compile(wrong: &str, library: &Path, include: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let made = Command::new("cc")
        .args(["-std=c11", "-O2", "-Wall", "-Werror", "-shared", "-fPIC"])
        .arg(format!("-DWRONG_{wrong}"))
        .arg(format!("-I{}", root.join(include).display()))
        .arg("-o")
        .arg(library)
        .arg(root.join("tests/certify/law.c"))
        .arg("-lm")
        .status()
        .expect("a C compiler named cc");
    assert!(made.success(), "{wrong}");
}

/// The header of version 1.0 is kept in `tests/certify/1.0`: libraries built with it continue to
/// work.
#[test]
fn a_law_built_with_the_first_header_is_certified() {
    let folder = std::env::temp_dir().join(format!("fretwork-frozen-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let library = folder.join("frozen.so");
    compile("NOTHING", &library, "tests/certify/1.0");
    let found = certificate(&Plugin::open(&library).unwrap());
    assert!(found.certified(), "{:#?}", found.lines);
    std::fs::remove_dir_all(&folder).ok();
}

/// A law that reports more stored energy than it has is detected by the energy residual of a run.
#[test]
fn a_wrong_energy_shows_in_the_residual() {
    let folder = std::env::temp_dir().join(format!("fretwork-residual-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let library = folder.join(fretwork::laws::search::file_name(Kind::COHESION, "tested"));
    let residual = |wrong: &str| {
        // A library stays open for the life of a program, so each has its own folder.
        let place = folder.join(wrong);
        std::fs::create_dir_all(&place).unwrap();
        compile(
            wrong,
            &place.join(library.file_name().unwrap()),
            "plugins/abi/include",
        );
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/bond_mode_1.ron");
        let sets = [
            "interfaces.grain.cohesion=tested",
            "interfaces.grain.parameters.cohesion={}",
            "interfaces.grain.damage=linear-softening",
            "interfaces.grain.parameters.damage={}",
        ]
        .map(str::to_owned);
        let mut s: Simulation<Dim2> = fretwork::scene::load(&case, &sets)
            .unwrap_or_else(|e| panic!("{e}"))
            .build_in(&SearchPath::new(&[place]).with_built_in(built_in()))
            .unwrap_or_else(|e| panic!("{e}"));
        while s.state.time < 5e-6 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        s.state.energy.relative_residual()
    };
    assert!(residual("NOTHING") < 1e-9);
    let wrong = residual("DISSIPATION");
    // The scale contains the kinetic energy of the grip, 3 J/m; half of 0.01 J/m is missing.
    assert!(wrong > 1e-3, "{wrong}");
    std::fs::remove_dir_all(&folder).ok();
}

/// Of a defective cohesion law and a valid damage law with it only the first is reported as
/// uncertified.
#[test]
fn a_law_beside_a_bad_one_is_not_blamed() {
    let folder = std::env::temp_dir().join(format!("fretwork-blame-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let name = fretwork::laws::search::file_name(Kind::COHESION, "tested");
    for (wrong, good) in [("NOTHING", true), ("DISSIPATION", false), ("STATE", false)] {
        let place = folder.join(wrong);
        std::fs::create_dir_all(&place).unwrap();
        compile(wrong, &place.join(&name), "plugins/abi/include");
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .arg("run")
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/bond_mode_1.ron"))
            .arg("--plugin-path")
            .arg(&place)
            .arg("--out")
            .arg(place.join("out"))
            .args(["--set", "interfaces.grain.cohesion=tested"])
            .args(["--set", "interfaces.grain.parameters.cohesion={}"])
            .args(["--set", "interfaces.grain.damage=linear-softening"])
            .args(["--set", "interfaces.grain.parameters.damage={}"])
            .args(["--set", "time.end=4e-8", "--json"])
            // None is certified by an earlier run.
            .env("XDG_CACHE_HOME", place.join("cache"))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let text = std::fs::read_to_string(place.join("out/summary.json"));
        let text = text.unwrap_or_else(|e| panic!("{e}: {said}"));
        let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
        for plugin in summary["plugins"].as_array().unwrap() {
            let expected = plugin["name"] != "tested" || good;
            assert_eq!(plugin["certified"], expected, "{wrong}: {plugin}");
        }
    }
    std::fs::remove_dir_all(&folder).ok();
}

/// The convergence of a law does not depend on where in a step its bond breaks: tested for every
/// energy of the rate law, also if the bond breaks soon after its onset.
#[test]
fn convergence_is_not_a_matter_of_chance() {
    let path = search_path();
    let open = |kind| LoadedLaw::with_defaults(path.find(kind, "mac").unwrap());
    let (cohesion, damage) = (open(Kind::COHESION), open(Kind::DAMAGE));
    assert_eq!(damage.plugin.parameters[0].name, "w");
    for k in 0..12 {
        let mut values = damage.parameters.clone();
        values[0] = 0.05 * 1.25f64.powi(k);
        let found = certify_parameters(&damage.plugin, &values, Some(&cohesion), &path).unwrap();
        let line = found.lines.iter().find(|l| l.check == "convergence");
        let order = line.unwrap().number;
        assert!((0.9..2.5).contains(&order), "w = {}: {order}", values[0]);
    }
}

#[test]
fn wrong_laws_fail_their_line_and_no_other() {
    let folder = std::env::temp_dir().join(format!("fretwork-certify-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let cases: [(&str, &[&str]); 22] = [
        ("NOTHING", &[]),
        ("ENERGY", &["fracture energy"]),
        ("ENERGY_BY_HALF_A_PERCENT", &["fracture energy"]),
        ("STORED", &["stored energy"]),
        ("DISSIPATION", &["stored energy", "dissipation"]),
        ("HEALING", &["damage grows"]),
        ("FRAME", &["objectivity"]),
        ("STEP", &["convergence"]),
        ("TANGENT", &["tangent"]),
        // A bond with a curved traction, whose stored energy is consistent, unloads along its own
        // curve.
        ("CURVED", &[]),
        ("SECANT", &["dissipation", "secant"]),
        // If the stored energy is not consistent at small openings, unloading shows it.
        ("DEGRADATION", &["dissipation", "degradation"]),
        ("BATCH", &["batch"]),
        ("THREADS", &["threads"]),
        // A number kept between calls is detected when a call is repeated; nothing more is tested
        // then.
        ("HIDDEN", &["columns"]),
        ("NUMBERS", &["bad numbers"]),
        ("INPUT", &["columns"]),
        ("STATE", &["columns"]),
        ("PARAMETER", &["columns"]),
        ("BEFORE", &["columns"]),
        ("FAR", &["columns"]),
        ("NOTHING_SET_UP_ONCE", &[]),
    ];
    for (wrong, lines) in cases {
        let library = folder.join(format!("{wrong}.so"));
        compile(wrong, &library, "plugins/abi/include");
        let found = certificate(&Plugin::open(&library).unwrap());
        let failed: Vec<&str> = broken(&found);
        assert_eq!(failed, *lines, "{wrong}: {:#?}", found.lines);
    }
    std::fs::remove_dir_all(&folder).ok();
}

/// Static memory of a law's library is detected whether or not threads happen to collide there.
/// (The line `threads` may fail too, by chance.)
#[cfg(target_os = "linux")]
#[test]
fn laws_with_static_memory_are_found() {
    let folder = std::env::temp_dir().join(format!("fretwork-static-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (wrong, at_least) in [
        ("SCRATCH", 100.0),
        ("COUNTER", 1.0),
        ("CACHE", 1.0),
        ("GROWING", 1.0),
        ("LARGE", 8.0 * f64::from(1 << 26)),
    ] {
        let library = folder.join(format!("{wrong}.so"));
        compile(wrong, &library, "plugins/abi/include");
        let found = certificate(&Plugin::open(&library).unwrap());
        let failed = broken(&found);
        let others = failed.iter().filter(|l| **l != "threads");
        assert!(
            others.eq(["static memory"].iter()),
            "{wrong}: {:#?}",
            found.lines
        );
        let line = found
            .lines
            .iter()
            .find(|l| l.check == "static memory")
            .unwrap();
        assert!(line.number >= at_least, "{wrong}: {line:?}");
        assert!(line.text.contains("local to the call"), "{wrong}: {line:?}");
    }
    std::fs::remove_dir_all(&folder).ok();
}
