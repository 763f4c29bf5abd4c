//! The plain-text scenes of `cases/benchmarks/`: balls, clusters and fixed walls.

use super::source::{InputError, Source};
use std::path::Path;

/// A wall: a point of its surface, and the normal towards the open side.
#[derive(Clone, Debug)]
pub struct Wall {
    /// Point (m).
    pub at: Vec<f64>,
    /// Outward unit normal.
    pub normal: Vec<f64>,
}

/// A ball: centre and radius (m).
pub type Place = (Vec<f64>, f64);

/// Contents of a scene file.
#[derive(Clone, Debug, Default)]
pub struct SceneFile {
    /// Free balls.
    pub balls: Vec<Place>,
    /// Rigid clusters: name and balls.
    pub clusters: Vec<(String, Vec<Place>)>,
    /// Fixed walls.
    pub walls: Vec<Wall>,
}

/// Reads a scene file of the given dimension.
///
/// # Errors
/// An error at the line that is wrong.
pub fn read(path: &Path, dimension: usize) -> Result<SceneFile, InputError> {
    let source = Source::read(path)?;
    let text = source.text();
    let name = path.display().to_string();
    let mut out = SceneFile::default();
    let mut boxes: Vec<Vec<f64>> = Vec::new();
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        let words: Vec<&str> = line
            .split('#')
            .next()
            .unwrap_or("")
            .split_whitespace()
            .collect();
        let fail = |message: String| {
            InputError::at(&name, text, offset..offset + line.trim_end().len(), message)
        };
        let numbers = |words: &[&str], n: usize| -> Result<Vec<f64>, InputError> {
            let parsed: Option<Vec<f64>> = words
                .iter()
                .map(|w| w.parse().ok().filter(|x: &f64| x.is_finite()))
                .collect();
            parsed
                .filter(|v| v.len() == n)
                .ok_or_else(|| fail(format!("expected {n} numbers after the keyword")))
        };
        let ball = |words: &[&str]| -> Result<(Vec<f64>, f64), InputError> {
            let v = numbers(words, dimension + 1)?;
            let radius = v[dimension];
            if radius <= 0.0 {
                return Err(fail(format!("a radius must be positive, got {radius}")));
            }
            Ok((v[..dimension].to_vec(), radius))
        };
        match words.as_slice() {
            [] | ["param", ..] => {}
            ["dim", d] => {
                if d.parse() != Ok(dimension) {
                    return Err(fail(format!(
                        "this scene has dimension {d}, the case has {dimension}"
                    )));
                }
            }
            ["wall", _, kind @ ("JONCx" | "PLANx"), ..]
                if (*kind == "JONCx") != (dimension == 2) =>
            {
                return Err(fail(format!(
                    "a {kind} wall does not exist in {dimension} dimensions"
                )));
            }
            ["wall", _, "JONCx", rest @ ..] => boxes.push(numbers(rest, 5)?),
            ["wall", _, "PLANx", rest @ ..] => {
                let v = numbers(rest, 9)?;
                let length = v[6].hypot(v[7]).hypot(v[8]);
                if !(length > 0.0 && length.is_finite()) {
                    return Err(fail("the normal of a wall must not be null".into()));
                }
                // A normal of unit length is used as written, bit for bit.
                let unit = (length - 1.0).abs() < 1e-9;
                let scale = if unit { 1.0 } else { 1.0 / length };
                let normal: Vec<f64> = v[6..].iter().map(|x| x * scale).collect();
                let at = (0..3).map(|k| v[k] + v[5] * normal[k]).collect();
                out.walls.push(Wall { at, normal });
            }
            ["body", _, "disk" | "sphere", rest @ ..] => out.balls.push(ball(rest)?),
            ["cluster", name, rest @ ..] => {
                numbers(rest, 3)?;
                if out.clusters.iter().any(|c| c.0 == *name) {
                    return Err(fail(format!("two clusters are named `{name}`")));
                }
                out.clusters.push(((*name).to_owned(), Vec::new()));
            }
            ["cd", rest @ ..] => match out.clusters.last_mut() {
                Some(cluster) => cluster.1.push(ball(rest)?),
                None => return Err(fail("a `cd` line must follow a `cluster` line".into())),
            },
            [word, ..] => return Err(fail(format!("unknown record `{word}`"))),
        }
        offset += line.len();
    }
    // A 2D wall is a rectangle: its open side faces the grains.
    let count = out.balls.len().max(1) as f64;
    let mean = |k: usize| out.balls.iter().map(|b| b.0[k]).sum::<f64>() / count;
    let centre = if dimension == 2 {
        [mean(0), mean(1)]
    } else {
        [0.0; 2]
    };
    for v in boxes {
        let mut n = [-v[4].sin(), v[4].cos()];
        if (centre[0] - v[0]) * n[0] + (centre[1] - v[1]) * n[1] < 0.0 {
            n = [-n[0], -n[1]];
        }
        let at = vec![v[0] + v[3] * n[0], v[1] + v[3] * n[1]];
        out.walls.push(Wall {
            at,
            normal: n.to_vec(),
        });
    }
    Ok(out)
}
