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
pub type PlacedBall = (Vec<f64>, f64);

/// Contents of a scene file.
#[derive(Clone, Debug, Default)]
pub struct SceneFile {
    /// Free balls.
    pub balls: Vec<PlacedBall>,
    /// Rigid clusters: name and balls.
    pub clusters: Vec<(String, Vec<PlacedBall>)>,
    /// Fixed walls.
    pub walls: Vec<Wall>,
}

/// A wall of a plane scene: centre, half lengths and angle.
type Rectangle = Vec<f64>;

/// Reads a scene file of the given dimension.
///
/// # Errors
/// Returns an error at the invalid line.
pub fn read(path: &Path, dimension: usize) -> Result<SceneFile, InputError> {
    let source = Source::read(path)?;
    let text = source.text();
    let name = path.display().to_string();
    let mut out = SceneFile::default();
    let mut rectangles: Vec<Rectangle> = Vec::new();
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        let record = Record {
            words: line
                .split('#')
                .next()
                .unwrap_or("")
                .split_whitespace()
                .collect(),
            dimension,
        };
        record
            .add_to(&mut out, &mut rectangles)
            .map_err(|message| {
                InputError::at(&name, text, offset..offset + line.trim_end().len(), message)
            })?;
        offset += line.len();
    }
    add_rectangles(&mut out, rectangles, dimension);
    Ok(out)
}

/// One line of a scene file; errors are messages.
struct Record<'a> {
    words: Vec<&'a str>,
    dimension: usize,
}

impl Record<'_> {
    fn add_to(&self, out: &mut SceneFile, rectangles: &mut Vec<Rectangle>) -> Result<(), String> {
        let dimension = self.dimension;
        match self.words.as_slice() {
            [] | ["param", ..] => {}
            ["dim", d] => {
                if d.parse() != Ok(dimension) {
                    return Err(format!(
                        "this scene has dimension {d}, the case has {dimension}"
                    ));
                }
            }
            ["wall", _, kind @ ("JONCx" | "PLANx"), ..]
                if (*kind == "JONCx") != (dimension == 2) =>
            {
                return Err(format!(
                    "a {kind} wall does not exist in {dimension} dimensions"
                ));
            }
            ["wall", _, "JONCx", rest @ ..] => rectangles.push(numbers(rest, 5)?),
            ["wall", _, "PLANx", rest @ ..] => out.walls.push(plane(rest)?),
            ["body", _, "disk" | "sphere", rest @ ..] => out.balls.push(self.ball(rest)?),
            ["cluster", name, rest @ ..] => {
                numbers(rest, 3)?;
                if out.clusters.iter().any(|c| c.0 == *name) {
                    return Err(format!("two clusters are named `{name}`"));
                }
                out.clusters.push(((*name).to_owned(), Vec::new()));
            }
            ["cd", rest @ ..] => match out.clusters.last_mut() {
                Some(cluster) => cluster.1.push(self.ball(rest)?),
                None => return Err("a `cd` line must follow a `cluster` line".into()),
            },
            [word, ..] => return Err(format!("unknown record `{word}`")),
        }
        Ok(())
    }

    fn ball(&self, words: &[&str]) -> Result<PlacedBall, String> {
        let v = numbers(words, self.dimension + 1)?;
        let radius = v[self.dimension];
        if radius <= 0.0 {
            return Err(format!("a radius must be positive, got {radius}"));
        }
        Ok((v[..self.dimension].to_vec(), radius))
    }
}

fn numbers(words: &[&str], n: usize) -> Result<Vec<f64>, String> {
    let parsed: Option<Vec<f64>> = words
        .iter()
        .map(|w| w.parse().ok().filter(|x: &f64| x.is_finite()))
        .collect();
    parsed
        .filter(|v| v.len() == n)
        .ok_or_else(|| format!("expected {n} numbers after the keyword"))
}

/// A wall in space: centre, half lengths with the thickness last, normal.
fn plane(words: &[&str]) -> Result<Wall, String> {
    let v = numbers(words, 9)?;
    let length = v[6].hypot(v[7]).hypot(v[8]);
    if !(length > 0.0 && length.is_finite()) {
        return Err("the normal of a wall must not be null".into());
    }
    // A normal of unit length is used as written, bit for bit.
    let unit = (length - 1.0).abs() < 1e-9;
    let scale = if unit { 1.0 } else { 1.0 / length };
    let normal: Vec<f64> = v[6..].iter().map(|x| x * scale).collect();
    let at = (0..3).map(|k| v[k] + v[5] * normal[k]).collect();
    Ok(Wall { at, normal })
}

/// Adds the walls of a plane scene, which are rectangles: their open side faces the grains.
fn add_rectangles(out: &mut SceneFile, rectangles: Vec<Rectangle>, dimension: usize) {
    let count = out.balls.len().max(1) as f64;
    let mean = |k: usize| out.balls.iter().map(|b| b.0[k]).sum::<f64>() / count;
    let centre = if dimension == 2 {
        [mean(0), mean(1)]
    } else {
        [0.0; 2]
    };
    for v in rectangles {
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
}
