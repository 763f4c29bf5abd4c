//! Files named by a case that are missing, empty, not regular, or do not have the announced
//! content.

use super::trial::{PLANE, SOLID, Trial, refusal, with};

const STONE_FLOOR: &str = r#"HeightField(points: (4, 4), spacing: (0.1, 0.1), rms: 1e-4)"#;
const LIST: &str = "List(material: \"grain\", grains: [\n            (at: [0.05, 0.011], radius: 0.01),\n            (at: [0.1, 0.011], radius: 0.01),\n            (at: [0.15, 0.011], radius: 0.01),\n        ])";

/// The case whose grains, floor or laws come from the file.
fn naming(what: &str, file: &str) -> String {
    match what {
        "grains" => with(
            PLANE,
            LIST,
            &format!("Csv(material: \"grain\", file: \"{file}\")"),
        ),
        "sieve" => with(
            PLANE,
            LIST,
            &format!(
                "Deposit(material: \"grain\", count: 2, low: [0.0, 0.0], high: [0.4, 0.1], sizes: Sieve(file: \"{file}\"))"
            ),
        ),
        "profile" => with(
            PLANE,
            "HalfSpace(normal: [0.0, 1.0])",
            &format!("Profile(side: Below, file: \"{file}\")"),
        ),
        "scene" => with(
            PLANE,
            LIST,
            &format!("Scene(material: \"grain\", file: \"{file}\")"),
        ),
        "state" => with(
            PLANE,
            LIST,
            &format!("State(material: \"grain\", results: \"{file}\")"),
        ),
        _ => with(SOLID, STONE_FLOOR, &format!("Mesh(file: \"{file}\")")),
    }
}

#[test]
fn a_file_that_is_missing_or_empty_is_told_at_the_line_that_names_it() {
    for (what, name) in [
        ("grains", "g.csv"),
        ("sieve", "g.csv"),
        ("profile", "g.csv"),
        ("scene", "g.txt"),
        ("state", "other"),
        ("mesh", "m.stl"),
        ("mesh", "m.obj"),
    ] {
        let trial = Trial::new();
        let text = naming(what, name);
        let line = text[..text.find(name).unwrap()].matches('\n').count() + 1;
        let case = trial.write("case.ron", text);
        let at = format!("{}:{line}:", case.display());
        for state in ["missing", "empty", "folder"] {
            match state {
                "empty" => drop(trial.write(name, "")),
                "folder" => {
                    std::fs::remove_file(trial.path(name)).unwrap();
                    std::fs::create_dir(trial.path(name)).unwrap();
                }
                _ => {}
            }
            let said = trial.refuses(&case, &[], &[name]);
            assert!(said.starts_with(&at), "{what} {state}: not at {at}\n{said}");
        }
    }
    // The files of materials are named too.
    let trial = Trial::new();
    let case = trial.write("case.ron", PLANE);
    let file = trial.write("materials/stone.ron", " \n");
    let said = trial.refuses(&case, &[], &["stone.ron is empty"]);
    assert!(
        said.starts_with(&format!("{}:7:26: ", case.display())),
        "{said}"
    );
    std::fs::remove_file(file).unwrap();
    let said = trial.refuses(
        &case,
        &[],
        &["there is no file `stone.ron` in", "expected one of"],
    );
    assert!(
        said.starts_with(&format!("{}:7:26: ", case.display())),
        "{said}"
    );
}

/// The program does not wait for pipes and for files below `/proc` that block.
#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_refused_at_once() {
    for what in ["grains", "profile", "scene", "mesh", "state"] {
        let name = if what == "mesh" { "in.stl" } else { "in" };
        let trial = Trial::new();
        let case = trial.write("case.ron", naming(what, name));
        let pipe = trial.path(name);
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|s| s.success()));
        let word = if what == "state" {
            "not a file"
        } else {
            "a pipe or a socket"
        };
        trial.refuses(&case, &[], &["case.ron:", word]);
        std::fs::remove_file(&pipe).unwrap();
        std::os::unix::fs::symlink("/dev/zero", &pipe).unwrap();
        trial.refuses(&case, &[], &["case.ron:", word]);
    }
    let trial = Trial::new();
    let pipe = trial.path("case.ron");
    std::process::Command::new("mkfifo")
        .arg(&pipe)
        .status()
        .unwrap();
    trial.refuses(
        &pipe,
        &[],
        &["it is a device, a pipe or a socket, not a regular file"],
    );
    for (arguments, word) in [
        (
            ["law", "drive", "mac", "--path", "case.ron"],
            "not a regular file",
        ),
        (
            ["solve", "case.ron", "case.ron", "--solver", "all"],
            "it is not a file",
        ),
        (
            ["check", "/dev/null", "--set", "a=1", "--trust-plugins"],
            "not a regular file",
        ),
    ] {
        refusal(&trial.call(&arguments), &[word]);
    }
    // Files of the kernel have no length; reading some of them never returns.
    if std::path::Path::new("/proc/kmsg").exists() {
        refusal(
            &trial.call(&["run", "/proc/kmsg"]),
            &["/proc/kmsg", "is empty"],
        );
    }
}

/// A binary STL file of a tetrahedron, with as many triangles as it announces, or not.
fn stl(announced: u32, held: usize) -> Vec<u8> {
    let corners = [
        [0.0f32, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mut out = vec![b' '; 80];
    out.extend(announced.to_le_bytes());
    for face in faces.iter().take(held) {
        out.extend([0u8; 12]);
        for corner in face {
            out.extend(corners[*corner].iter().flat_map(|x| x.to_le_bytes()));
        }
        out.extend([0u8; 2]);
    }
    out
}

/// An STL file in text.
fn text(faces: usize, end: &str) -> String {
    let facet = |a: &str, b: &str, c: &str| {
        format!(
            "facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n"
        )
    };
    let (o, x, y, z) = ("0 0 0", "1 0 0", "0 1 0", "0 0 1");
    let all = [
        facet(o, y, x),
        facet(o, x, z),
        facet(o, z, y),
        facet(x, y, z),
    ];
    format!("solid\n{}{end}", all[..faces].concat())
}

#[test]
fn an_stl_file_holds_what_it_announces() {
    let trial = Trial::new();
    let case = trial.write("case.ron", naming("mesh", "m.stl").replace("0.02]", "2.0]"));
    let fits = |content: &[u8]| {
        trial.write("m.stl", content);
        let output = trial.call(&["check", "case.ron"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    };
    let refuses = |content: &[u8], words: &[&str]| {
        trial.write("m.stl", content);
        let said = trial.refuses(&case, &[], words);
        assert!(
            said.starts_with(&format!("{}:9:", case.display())),
            "{said}"
        );
    };
    fits(&stl(4, 4));
    let named = [b"solid".as_slice(), &stl(4, 4)[5..]].concat();
    fits(&named);
    refuses(&stl(5, 4), &["announces 5 triangles and holds 4"]);
    refuses(
        &stl(3, 4),
        &["announces 3 triangles, and 50 bytes follow them, room for 1 more"],
    );
    refuses(&stl(u32::MAX, 4), &["announces 4294967295 triangles"]);
    refuses(&stl(4, 4)[..60], &["shorter than the header"]);
    fits(text(4, "endsolid\n").as_bytes());
    fits(text(4, "endsolid\n").replace('\n', "\r\n").as_bytes());
    // All solids count: the second one closes the first.
    let whole = text(4, "endsolid\n");
    let parts = whole.split("facet normal").collect::<Vec<_>>();
    let second = format!("facet normal{}facet normal{}", parts[3], parts[4]);
    let first = format!(
        "solid\nfacet normal{}facet normal{}endsolid\n",
        parts[1], parts[2]
    );
    fits(format!("{first}solid two\n{second}").as_bytes());
    refuses(
        format!("{first}{second}").as_bytes(),
        &["text after its `endsolid`, in line 17"],
    );
    refuses(text(4, "").as_bytes(), &["ends before its last triangle"]);
    refuses(
        text(4, "endsolid\n").replace("0 0 1", "0 0 NaN").as_bytes(),
        &["is no STL file"],
    );
}

#[test]
fn an_obj_file_names_vertices_that_it_has() {
    let trial = Trial::new();
    let case = trial.write("case.ron", naming("mesh", "m.obj").replace("0.02]", "2.0]"));
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    trial.write(
        "m.obj",
        format!("mtllib /proc/kmsg\n{corners}usemtl red\n{faces}"),
    );
    let output = trial.call(&["check", "case.ron"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    for wrong in [
        "f 1 2 5\n",
        "f 1 2 0\n",
        "f 1 2 -9\n",
        "f 1 2 x\n",
        "f 1 2\n",
        "v 1e400 0 0\nf 1 2 5\n",
    ] {
        trial.write("m.obj", format!("{corners}{faces}{wrong}"));
        let output = trial.call(&["check", "case.ron"]);
        if wrong == "f 1 2\n" && output.status.code() == Some(0) {
            // A line, which is no part of a surface.
            continue;
        }
        let said = refusal(&output, &["m.obj"]);
        assert!(said.starts_with("case.ron:9:"), "{wrong}: {said}");
    }
    let _ = case;
}

#[test]
fn a_table_says_each_thing_once() {
    let trial = Trial::new();
    let case = trial.write("case.ron", naming("grains", "g.csv"));
    for (table, place, words) in [
        (
            "x,y,radius,x\n1,1,1,1\n",
            "1:1",
            &["the column `x` is there twice"][..],
        ),
        (
            "x,y,radius\n0.1,0.1,0.01\nx,y,radius\n",
            "3:1",
            &["the value `x` of `x` is not a number"],
        ),
        (
            "x,y,radius,colour\n1,1,1,1\n",
            "1:1",
            &["unknown column `colour`"],
        ),
        (
            "x,y,radius\n0.1,0.1\n",
            "2:1",
            &["2 values and the header 3 columns"],
        ),
        (
            "x,y,radius\n0.1,0.1,1e400\n",
            "2:1",
            &["`1e400` of `radius` is not a number"],
        ),
    ] {
        let file = trial.write("g.csv", table);
        let said = trial.refuses(&case, &[], words);
        assert!(
            said.starts_with(&format!("{}:{place}: ", file.display())),
            "{said}"
        );
        assert!(
            said.contains("the file is read for `grains.0.file`"),
            "{said}"
        );
    }
}

/// The pairs of these grains would take 10 GB.
#[test]
fn grains_in_one_place_are_refused_before_their_pairs_are_stored() {
    let trial = Trial::new();
    let case = trial.write("case.ron", naming("grains", "pile.csv"));
    let mut table = "x,y,radius\n0.3,0.05,1e-3\n".to_owned();
    table.push_str(&"0.1,0.05,1e-9\n".repeat(11_000));
    trial.write("pile.csv", table);
    let words = [
        "11000 of them are within",
        "of (1e-1, 5e-2) m",
        "positions that occur twice",
    ];
    let said = trial.refuses(&case, &[], &words);
    assert!(
        said.starts_with(&format!("{}:29:", case.display())),
        "{said}"
    );
}
