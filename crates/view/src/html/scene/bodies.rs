//! First bodies of a state: outlines in 2D, faces in 3D. A body that moved without rotating is
//! stored as its first state and a displacement.

use super::states;
use crate::html::arrays::{Arrays, NumberType};
use crate::html::folder::RunFolder;

const VIEW: &str = "bodies";
/// Change of shape, relative to the size, below which an outline is taken as moved only.
const SAME: f64 = 1e-6;

/// An outline or a face.
struct Chain {
    body: u64,
    points: Vec<[f64; 3]>,
}

/// First bodies of a run, as they were when first read.
#[derive(Default)]
pub(super) struct Bodies {
    first: Vec<Chain>,
}

impl Bodies {
    /// Adds the arrays of a state. `skip` tells by identity and first point which bodies other
    /// parts of the page show.
    pub fn read(
        &mut self,
        run: &RunFolder,
        state: usize,
        dimension: usize,
        grains: &[[f64; 3]],
        skip: &dyn Fn(u64, [f64; 3]) -> bool,
        arrays: &mut Arrays,
    ) -> Result<(), String> {
        let kind = if dimension == 2 {
            ("Lines", 1)
        } else {
            ("Polygons", 2)
        };
        let chains = read(run, state, kind, skip)?;
        if self.first.len() != chains.len() {
            self.first = chains;
            return self.push(None, dimension, grains, arrays);
        }
        self.push(Some(&chains), dimension, grains, arrays)
    }

    fn push(
        &self,
        now: Option<&[Chain]>,
        dimension: usize,
        grains: &[[f64; 3]],
        arrays: &mut Arrays,
    ) -> Result<(), String> {
        let moved = |now: &[Chain]| {
            self.first
                .iter()
                .zip(now)
                .map(|(a, b)| shift(a, b))
                .collect::<Option<Vec<_>>>()
        };
        let rigid = now.map_or(Some(vec![[0.0; 3]; self.first.len()]), moved);
        let (shown, shifts) = match (now, rigid) {
            (_, Some(shifts)) => (self.first.as_slice(), shifts),
            (Some(now), None) => (now, vec![[0.0; 3]; now.len()]),
            (None, None) => (self.first.as_slice(), Vec::new()),
        };
        let (mut points, mut starts) = (Vec::new(), vec![0.0]);
        for chain in shown {
            points.extend(chain.points.iter().flatten().copied());
            starts.push((points.len() / 3) as f64);
        }
        arrays.push("body.start", NumberType::U32, &starts);
        let of: Vec<f64> = shown.iter().map(|c| c.body as f64).collect();
        arrays.push("body.id", NumberType::U32, &of);
        // The outlines of rough surfaces are fine against their size.
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate().take(dimension) {
            let values: Vec<f64> = points.iter().skip(axis).step_by(3).copied().collect();
            arrays.push(format!("body.{letter}"), NumberType::F32, &values);
            let values: Vec<f64> = shifts.iter().map(|s| s[axis]).collect();
            arrays.push(format!("body.shift.{letter}"), NumberType::F64, &values);
        }
        if dimension == 2 {
            let side: Vec<f64> = shown.iter().map(|c| side(c, grains)).collect();
            arrays.push("body.side", NumberType::U32, &side);
        }
        Ok(())
    }
}

/// Position of the solid relative to an outline in 2D: 0 on its right (open outline), 1 inside, 2
/// outside.
fn side(chain: &Chain, grains: &[[f64; 3]]) -> f64 {
    let (Some(first), Some(last)) = (chain.points.first(), chain.points.last()) else {
        return 0.0;
    };
    if first != last || chain.points.len() < 4 {
        return 0.0;
    }
    let holds = |at: &[f64; 3]| {
        let crosses = |pair: &[[f64; 3]]| {
            let ([ax, ay, _], [bx, by, _]) = (pair[0], pair[1]);
            (ay > at[1]) != (by > at[1]) && at[0] < ax + (at[1] - ay) / (by - ay) * (bx - ax)
        };
        chain.points.windows(2).filter(|pair| crosses(pair)).count() % 2 == 1
    };
    let around = grains
        .iter()
        .step_by((grains.len() / 64).max(1))
        .filter(|at| holds(at))
        .count();
    if around > 2 { 2.0 } else { 1.0 }
}

/// Returns the displacement of an outline that kept its shape.
fn shift(from: &Chain, to: &Chain) -> Option<[f64; 3]> {
    let first = from.points.first()?;
    if from.points.len() != to.points.len() || from.body != to.body {
        return None;
    }
    let way: [f64; 3] = std::array::from_fn(|k| to.points[0][k] - first[k]);
    let size = from
        .points
        .iter()
        .flat_map(|p| (0..3).map(|k| (p[k] - first[k]).abs()))
        .fold(0.0, f64::max);
    let same = |(a, b): (&[f64; 3], &[f64; 3])| {
        (0..3).all(|k| (b[k] - a[k] - way[k]).abs() <= SAME * size)
    };
    from.points.iter().zip(&to.points).all(same).then_some(way)
}

fn read(
    run: &RunFolder,
    state: usize,
    (kind, number): (&str, usize),
    skip: &dyn Fn(u64, [f64; 3]) -> bool,
) -> Result<Vec<Chain>, String> {
    let (first, count) = states::cells(run, VIEW, (kind, number), state)?;
    if count == 0 {
        return Ok(Vec::new());
    }
    let reader = &run.reader;
    let points = reader.values(
        &format!("views/{VIEW}/Points"),
        states::points(run, VIEW, state)?,
        3,
    )?;
    // Each state has one more offset than cells.
    let offsets = reader.whole(
        &format!("views/{VIEW}/{kind}/Offsets"),
        (first + state, count + 1),
    )?;
    let bodies = reader.values(&format!("views/{VIEW}/CellData/body"), (first, count), 1)?;
    let mut out = Vec::new();
    for (bounds, body) in offsets.windows(2).zip(bodies) {
        let range = usize::try_from(3 * bounds[0])
            .ok()
            .zip(usize::try_from(3 * bounds[1]).ok());
        // Corners are stored one cell after another, in the order in which they are written.
        let chain = range.and_then(|(a, b)| points.get(a..b));
        let chain = chain.ok_or_else(|| format!("`views/{VIEW}` holds outlines without points"))?;
        let points: Vec<[f64; 3]> = chain.as_chunks::<3>().0.to_vec();
        let body = body as u64;
        if points.first().is_some_and(|at| !skip(body, *at)) {
            out.push(Chain { body, points });
        }
    }
    Ok(out)
}
