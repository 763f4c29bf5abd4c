//! Symmetric matrices of graphs in sliced ELLPACK format, and vectors in the order of their rows.

use crate::diffusion::Edge;

/// Number of rows of a slice: C of SELL-C-sigma.
const LANES: usize = 4;

/// One value for each row of a slice.
pub(crate) type Lanes = [f64; LANES];

/// The sum over the lanes.
pub(crate) fn sum(lanes: Lanes) -> f64 {
    let [a, b, c, d] = lanes;
    (a + b) + (c + d)
}

/// One neighbour of each row of a slice; shorter rows are padded with themselves and zero
/// conductance.
#[derive(Clone, Copy, Debug)]
struct Neighbours {
    row: [u32; LANES],
    conductance: Lanes,
}

/// Matrix diag(own) + L, with the Laplacian L of the edges between unknowns.
///
/// Rows are sorted by ascending number of stored neighbours, and a slice of four is stored
/// neighbour by neighbour (SELL-C-sigma: M. Kreutzer et al., SIAM J. Sci. Comput. 36 (2014)
/// C401-C423), so that the four sums do not depend on each other. A row with very many neighbours
/// pads the three others of its slice to as many.
#[derive(Debug)]
pub(crate) struct Matrix {
    /// Row of each unknown.
    rows: Vec<u32>,
    /// The diagonal without the edges between unknowns; zero in padding rows.
    own: Vec<Lanes>,
    /// The whole diagonal.
    diagonal: Vec<Lanes>,
    /// End of the neighbours of each slice.
    ends: Vec<usize>,
    neighbours: Vec<Neighbours>,
}

impl Matrix {
    /// Creates a matrix from the diagonal without the edges, and from the edges between unknowns;
    /// self-loops are ignored.
    pub fn new(own: &[f64], edges: &[Edge]) -> Self {
        let mut counts = vec![0u32; own.len()];
        for_pairs(edges, |[a, b], _, again| {
            if !again {
                counts[a] += 1;
                counts[b] += 1;
            }
        });
        let mut order: Vec<u32> = (0..own.len() as u32).collect();
        order.sort_by_key(|k| counts[*k as usize]);
        let mut rows = vec![0; own.len()];
        for (row, k) in (0..).zip(&order) {
            rows[*k as usize] = row;
        }
        let mut neighbours = Vec::new();
        let mut ends = Vec::with_capacity(own.len().div_ceil(LANES));
        for (slice, order) in (0..).zip(order.chunks(LANES)) {
            let most = order.last().map_or(0, |k| counts[*k as usize]);
            let none = Neighbours {
                row: [0, 1, 2, 3].map(|lane| LANES as u32 * slice + lane),
                conductance: [0.0; LANES],
            };
            neighbours.resize(neighbours.len() + most as usize, none);
            ends.push(neighbours.len());
        }
        let own = arrange(&rows, own);
        let mut diagonal = own.clone();
        let mut ahead: Vec<usize> = std::iter::once(0)
            .chain(ends.iter().copied())
            .take(ends.len())
            .flat_map(|begin| [begin; LANES])
            .collect();
        let mut places = [0; 2];
        for_pairs(edges, |pair, conductance, again| {
            let [a, b] = [rows[pair[0]] as usize, rows[pair[1]] as usize];
            if !again {
                places = [ahead[a], ahead[b]];
                ahead[a] += 1;
                ahead[b] += 1;
            }
            for (place, row, other) in [(places[0], a, b), (places[1], b, a)] {
                let lane = row % LANES;
                let entry = &mut neighbours[place];
                entry.row[lane] = other as u32;
                entry.conductance[lane] += conductance;
                diagonal[row / LANES][lane] += conductance;
            }
        });
        Self {
            rows,
            own,
            diagonal,
            ends,
            neighbours,
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.rows.len()
    }

    /// The diagonal without the edges between unknowns, in the order of rows.
    pub fn own(&self) -> &[Lanes] {
        &self.own
    }

    /// The whole diagonal, in the order of rows.
    pub fn diagonal(&self) -> &[Lanes] {
        &self.diagonal
    }

    /// A vector in the order of rows, with zeros in padding rows.
    pub fn arrange(&self, values: &[f64]) -> Vec<Lanes> {
        arrange(&self.rows, values)
    }

    /// A vector in the order of unknowns.
    pub fn restore(&self, values: &[Lanes]) -> Vec<f64> {
        let values = values.as_flattened();
        self.rows.iter().map(|row| values[*row as usize]).collect()
    }

    /// Sets `out` to A x and returns x.A x. Differences are formed first, so that the flow out of
    /// one unknown equals the flow into the other to the last bit.
    pub fn product(&self, x: &[Lanes], out: &mut [Lanes]) -> f64 {
        let of = x.as_flattened();
        let mut begin = 0;
        let mut all = [0.0; LANES];
        let slices = out.iter_mut().zip(x).zip(&self.own).zip(&self.ends);
        for (((out, here), own), end) in slices {
            let mut sums = [0.0; LANES];
            for lane in 0..LANES {
                sums[lane] = own[lane] * here[lane];
            }
            for entry in &self.neighbours[begin..*end] {
                for lane in 0..LANES {
                    let difference = here[lane] - of[entry.row[lane] as usize];
                    sums[lane] += entry.conductance[lane] * difference;
                }
            }
            for lane in 0..LANES {
                all[lane] += here[lane] * sums[lane];
            }
            *out = sums;
            begin = *end;
        }
        sum(all)
    }

    /// Iterates over pairs of rows with conductances between them, the larger row first; a pair may
    /// occur several times, and its conductances are added.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let begins = std::iter::once(&0).chain(&self.ends);
        let slices = begins.zip(&self.ends).enumerate();
        slices.flat_map(move |(slice, (begin, end))| {
            let entries = self.neighbours[*begin..*end].iter();
            entries.flat_map(move |entry| {
                let lanes = (0..LANES).map(move |lane| {
                    let other = entry.row[lane] as usize;
                    (LANES * slice + lane, other, entry.conductance[lane])
                });
                lanes.filter(|(row, other, _)| other < row)
            })
        })
    }
}

/// A vector in the order of rows, with zeros in padding rows.
fn arrange(rows: &[u32], values: &[f64]) -> Vec<Lanes> {
    let mut all = vec![[0.0; LANES]; rows.len().div_ceil(LANES)];
    for (row, value) in rows.iter().zip(values) {
        all.as_flattened_mut()[*row as usize] = *value;
    }
    all
}

/// Calls `on` for each edge between two unknowns, with its conductance, and whether it joins the
/// same ordered pair as the edge before, as contacts of one pair of bodies do.
fn for_pairs(edges: &[Edge], mut on: impl FnMut([usize; 2], f64, bool)) {
    let mut last = [u32::MAX; 2];
    for e in edges {
        if e.nodes[0] != e.nodes[1] && e.conductance != 0.0 {
            on(
                [e.nodes[0] as usize, e.nodes[1] as usize],
                e.conductance,
                e.nodes == last,
            );
            last = e.nodes;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_dense_matrix() {
        // A hub, a chain, a pair that is joined three times, a self-loop and an edge without
        // conductance.
        let ends = [
            [0, 1],
            [0, 2],
            [0, 3],
            [0, 4],
            [5, 0],
            [4, 5],
            [4, 5],
            [2, 3],
            [5, 4],
            [6, 6],
            [1, 6],
        ];
        let edges: Vec<Edge> = (0..)
            .zip(ends)
            .map(|(k, nodes)| Edge {
                nodes,
                conductance: if nodes == [1, 6] {
                    0.0
                } else {
                    1.0 + f64::from(k)
                },
            })
            .collect();
        let own = [0.5, 1.0, 0.0, 2.0, 0.25, 3.0, 4.0];
        let mut dense = [[0.0; 7]; 7];
        for k in 0..7 {
            dense[k][k] += own[k];
        }
        for e in &edges {
            let [a, b] = e.nodes.map(|n| n as usize);
            for (a, b) in [(a, b), (b, a)] {
                dense[a][a] += e.conductance;
                dense[a][b] -= e.conductance;
            }
        }
        let matrix = Matrix::new(&own, &edges);
        let x: Vec<f64> = (0..7).map(|k| 0.3 + f64::from(k * k)).collect();
        let mut out = vec![[0.0; LANES]; 2];
        let energy = matrix.product(&matrix.arrange(&x), &mut out);
        let found = matrix.restore(&out);
        for k in 0..7 {
            let expected: f64 = (0..7).map(|j| dense[k][j] * x[j]).sum();
            assert!((found[k] - expected).abs() < 1e-12 * expected.abs().max(1.0));
        }
        let expected: f64 = x.iter().zip(&found).map(|(x, y)| x * y).sum();
        assert!((energy / expected - 1.0).abs() < 1e-14);
        let diagonal = matrix.restore(matrix.diagonal());
        (0..7).for_each(|k| assert!((diagonal[k] - dense[k][k]).abs() < 1e-14));
        let joined: f64 = matrix.pairs().map(|(_, _, g)| g).sum();
        let expected: f64 = edges.iter().map(|e| e.conductance).sum::<f64>() - 10.0;
        assert!((joined - expected).abs() < 1e-14);
    }
}
