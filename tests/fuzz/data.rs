//! Files that a case names: profiles, meshes, tables of grains, grading curves, scenes in plain
//! text. Each is read through a small case around it.

use crate::campaign::Campaign;
use crate::cases::{files, furnish, tried};
use crate::mutate;
use fretwork::shipped::search_path;
use rand::RngExt;
use rand_pcg::Pcg64;

/// Returns a case of a dimension with these bodies and grains.
fn case(dimension: u32, bodies: &str, grains: &str) -> String {
    format!(
        r#"(
    name: "around a file",
    dimension: {dimension},
    time: (step: 1e-4, end: 1e-2),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "grains", between: ("grain", "grain"), contact: "frictionless")],
    bodies: [{bodies}],
    grains: [{grains}],
)"#
    )
}

const GRAIN: &str = r#"List(material: "grain", grains: [(at: [0.0, 0.0, 0.5], radius: 0.01)])"#;

/// Damages seeds of a file and reads them through a case that names the file `last-NAME`.
fn run(campaign: &Campaign, name: &str, case: &str, seeds: Vec<Vec<u8>>) {
    let folder = campaign.folder();
    furnish(&folder);
    let path = folder.join("case.ron");
    std::fs::write(&path, case.replace("FILE", &format!("last-{name}"))).unwrap();
    let texts: Vec<String> = seeds
        .iter()
        .filter_map(|s| String::from_utf8(s.clone()).ok())
        .collect();
    let make = |rng: &mut Pcg64| {
        let seed = &seeds[rng.random_range(0..seeds.len())];
        let other = &seeds[rng.random_range(0..seeds.len())];
        let text = std::str::from_utf8(seed).ok();
        let new = match text.filter(|_| rng.random_range(0..4) > 0) {
            Some(text) => mutate::text(text, &texts, rng),
            None => mutate::bytes(seed, other, rng),
        };
        (name.to_owned(), new)
    };
    let laws = search_path();
    campaign.run(&folder, make, move |_| tried(&path, &laws));
}

fn campaign(kind: &'static str, count: u64) -> Campaign {
    Campaign {
        kind,
        count,
        scene: 0,
        taken: true,
    }
}

#[test]
fn damaged_profiles() {
    let mut seeds: Vec<Vec<u8>> = files("cases", &["csv"])
        .iter()
        .map(|p| std::fs::read(p).unwrap())
        .collect();
    seeds.push(b"x,z\n-1,0\n-0.5,0.1\n0,0\n0.5,0.1\n1,0\n".to_vec());
    seeds.push(b"# milled\nx [mm],z [mm]\n-100,0\n0,1\n0,-5\n100,0.5\n".to_vec());
    let body =
        r#"(name: "rail", material: "grain", shapes: [Profile(file: Some("FILE"), side: Below)])"#;
    let grains = r#"List(material: "grain", grains: [(at: [0.0, 0.5], radius: 0.01)])"#;
    run(
        &campaign("profiles", 300),
        "profile.csv",
        &case(2, body, grains),
        seeds,
    );
}

#[test]
fn damaged_obj_files() {
    let mut seeds: Vec<Vec<u8>> = files("cases/verification", &["obj"])
        .iter()
        .map(|p| std::fs::read(p).unwrap())
        .collect();
    seeds
        .push(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n".to_vec());
    seeds.push(b"o a\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3//1 4\nf -4 -3 -2\n".to_vec());
    meshes("obj files", "mesh.obj", seeds);
}

#[test]
fn damaged_stl_files() {
    let corners = [[0f32, 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let mut binary = vec![b' '; 80];
    binary.extend((faces.len() as u32).to_le_bytes());
    let mut text = "solid tetrahedron\n".to_owned();
    for face in faces {
        binary.extend([0u8; 12]);
        text += " facet normal 0 0 1\n  outer loop\n";
        for corner in face.map(|k| corners[k]) {
            binary.extend(corner.iter().flat_map(|x| x.to_le_bytes()));
            text += &format!("   vertex {} {} {}\n", corner[0], corner[1], corner[2]);
        }
        binary.extend([0u8; 2]);
        text += "  endloop\n endfacet\n";
    }
    text += "endsolid tetrahedron\n";
    meshes(
        "stl files",
        "mesh.stl",
        vec![binary.clone(), text.into_bytes(), binary],
    );
}

/// Half of each mesh is a surface, the other half the hull of a grain: one case has both.
fn meshes(kind: &'static str, name: &str, seeds: Vec<Vec<u8>>) {
    let body = r#"(name: "surface", material: "grain", shapes: [Mesh(file: "FILE", at: [0.0, 0.0, -5.0])])"#;
    let grains = format!(
        r#"{GRAIN}, Polyhedra(material: "grain", grains: [(at: [3.0, 3.0, 3.0], file: Some("FILE"))])"#
    );
    run(
        &campaign(kind, 300),
        name,
        &case(3, body, &grains),
        seeds.clone(),
    );
    // The surface alone, clear of the grain: overlaps at the start are refused.
    run(&campaign(kind, 300), name, &case(3, body, GRAIN), seeds);
}

#[test]
fn damaged_tables_of_grains() {
    let seeds = vec![
        b"x,y,radius\n0,0,0.1\n1,0,0.2\n0,1,0.15\n".to_vec(),
        b"# settled\nx,y,radius,velocity_x,velocity_y,spin\n0,0,0.1,1,0,2\n1,0,0.2,0,-1,0\n"
            .to_vec(),
    ];
    let grains = r#"Csv(file: "FILE", material: "grain")"#;
    run(
        &campaign("tables of grains", 300),
        "grains.csv",
        &case(2, "", grains),
        seeds,
    );
}

#[test]
fn damaged_grading_curves() {
    let seeds = vec![
        b"size,passing\n0.001,0\n0.002,0.3\n0.004,0.8\n0.008,1\n".to_vec(),
        b"# d, share\nsize,passing\n1e-4,0\n1e-3,1\n".to_vec(),
    ];
    let grains = r#"Deposit(material: "grain", count: 40, sizes: Sieve(file: "FILE"), low: [0.0, 0.0, 0.0], high: [0.1, 0.1, 0.1])"#;
    run(
        &campaign("grading curves", 300),
        "sieve.csv",
        &case(3, "", grains),
        seeds,
    );
}

#[test]
fn damaged_scene_files() {
    let long = files("cases/benchmarks", &["txt"]);
    let short = |p: &std::path::PathBuf| {
        let text = std::fs::read_to_string(p).unwrap();
        let head: Vec<&str> = text.lines().take(30).collect();
        head.join("\n").into_bytes()
    };
    let mut seeds: Vec<Vec<u8>> = long.iter().map(short).collect();
    seeds.push(b"dim 2\nwall w JONCx 0 -1 4 0.1 0\nbody b disk 0 0 0.1\ncluster c 0 0 0\ncd 0.1 0.2 0.1\ncd 0.3 0.2 0.1\n".to_vec());
    let body = r#"(name: "c", material: "grain", position: [5.0, 5.0], shapes: [HalfSpace(normal: [0.0, 1.0], at: [0.0, -20.0])])"#;
    let grains = r#"Scene(file: "FILE", material: "grain", walls: Some("grain"))"#;
    run(
        &campaign("scene files", 300),
        "scene.txt",
        &case(2, body, grains),
        seeds,
    );
}
