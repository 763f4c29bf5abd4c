//! Random damage to a valid case, equal in every run: for any text the library returns a scene or
//! an error.

use super::trial::{PLANE, SOLID, Trial, with};
use fretwork::laws::SearchPath;
use fretwork::scene::load;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

const ROUNDS: usize = 300;

/// Pieces that are most likely to cause errors.
const PIECES: [&str; 20] = [
    "-", "0", "9", "1e", "e300", "e-300", ".", "NaN", "inf", "(", ")", "[", "]", "{", "}", ",",
    "\"", ":", "\u{0}", "\u{e9}",
];

/// Changes some bytes of a text; with `numbers` only digits, so that most texts remain well formed.
fn damaged(text: &str, numbers: bool, rng: &mut Pcg64) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..rng.random_range(1..=3) {
        let at = rng.random_range(0..bytes.len());
        let end = (at + rng.random_range(1..=12)).min(bytes.len());
        match rng.random_range(0..4) {
            _ if numbers => {
                let digit = |k: &usize| bytes[*k].is_ascii_digit();
                let Some(at) = (at..bytes.len()).find(digit) else {
                    continue;
                };
                let new = match rng.random_range(0..4) {
                    0 => PIECES[rng.random_range(0..9)].to_owned(),
                    _ => rng.random_range(0..=12).to_string(),
                };
                bytes.splice(at..=at, new.bytes());
            }
            0 => bytes[at] = rng.random_range(0..=255),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let copy = bytes[at..end].to_vec();
                let to = rng.random_range(0..bytes.len());
                bytes.splice(to..to, copy);
            }
            _ => {
                let piece = PIECES[rng.random_range(0..PIECES.len())];
                bytes.splice(at..at, piece.bytes());
            }
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

/// Whether a case was accepted; it is then stepped twice.
fn tried(case: &Path, laws: &SearchPath) -> bool {
    let built = load(case, &[]).and_then(|loaded| loaded.build(laws));
    match built {
        Ok(mut built) => (0..2).for_each(|_| drop(built.simulation.step())),
        Err(error) => {
            assert!(!error.to_string().is_empty() && !error.message.is_empty());
            return false;
        }
    }
    true
}

#[test]
fn a_damaged_case_never_panics() {
    let trial = Trial::new();
    // The library is small, since most of the time goes into hashing loaded libraries.
    trial.compile_law("tiny", "0");
    let laws = SearchPath::new(&[trial.path("")]);
    let [plane, solid] = [PLANE, SOLID].map(|case| with(case, "\"coulomb\"", "\"tiny\""));
    let rough = "RoughProfile(points: 40, rms: 1e-4, shortest: 0.04, side: Below)";
    let lattice = r#"Lattice(material: "grain", count: 9, radius: (0.005, 0.01), low: [0.0, 0.03], high: [0.4, 0.09]), List("#;
    let plane = with(&plane, "HalfSpace(normal: [0.0, 1.0])", rough);
    let plane = with(&plane, "List(", lattice);
    let bonds = r#""tiny", cohesion: "mac", damage: "mac", bonds: At(1e-3),"#;
    let bonded = with(&plane, "\"tiny\",", bonds);
    let mut rng = Pcg64::seed_from_u64(2024);
    let mut accepted = 0;
    for round in 0..ROUNDS {
        let text = match round % 20 {
            0 => &bonded,
            k if k < 10 => &solid,
            _ => &plane,
        };
        let bytes = damaged(text, round % 2 == 0, &mut rng);
        let case = trial.write("case.ron", &bytes);
        match catch_unwind(AssertUnwindSafe(|| tried(&case, &laws))) {
            Ok(good) => accepted += usize::from(good),
            Err(_) => panic!("round {round}:\n{}", String::from_utf8_lossy(&bytes)),
        }
    }
    // Enough cases must reach the scene for the test to be meaningful.
    assert!(accepted >= ROUNDS / 10, "{accepted} accepted");
}
