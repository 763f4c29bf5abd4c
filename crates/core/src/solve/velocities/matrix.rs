//! The sparse matrix M + sum_c H_c K_c H_c^T over the motions of bodies, and its factor.

use super::balance::{self, Balance};
use super::krylov;
use super::law::Slope;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::row::MomentForm;
use crate::solve::standard::{Neighbours, degrees_of_freedom};
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Side};

/// Largest residual of a direction, and accuracy and largest number of products of the iteration
/// for it.
const ACCEPTED: f64 = 1e-2;
const KRYLOV: krylov::Limits = krylov::Limits {
    tolerance: 1e-7,
    products: 80,
};

/// Places of the entries, by columns, and the order of elimination. Both are kept from step to step
/// while the neighbours are the same; they follow from these alone, so that a run that is resumed
/// has the same bits.
#[derive(Clone, Debug, Default)]
pub(in crate::solve) struct Pattern {
    neighbours: Neighbours,
    /// Start of each column, and the end of the last.
    columns: Vec<usize>,
    rows: Vec<usize>,
    order: Option<SymbolicLlt<usize>>,
}

impl Pattern {
    /// Returns this pattern if it is of these neighbours, otherwise theirs.
    pub fn for_neighbours<S: Space>(self, neighbours: Neighbours) -> Self {
        if self.neighbours == neighbours {
            return self;
        }
        let size = degrees_of_freedom::<S>();
        let (mut columns, mut rows) = (vec![0], Vec::new());
        for near in &neighbours.near {
            if near.is_empty() {
                continue;
            }
            for _ in 0..size {
                for other in near {
                    let first = neighbours.starts[*other as usize];
                    rows.extend(first..first + size);
                }
                columns.push(rows.len());
            }
        }
        Self {
            neighbours,
            columns,
            rows,
            order: None,
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.columns.len().saturating_sub(1)
    }

    /// Whether a body moves.
    pub fn moves(&self, body: u32) -> bool {
        self.neighbours.moves(body)
    }

    /// First row of a body that moves.
    pub fn start(&self, body: u32) -> usize {
        self.neighbours.starts[body as usize]
    }

    /// Place of the first entry of the block of a body in a column of another one.
    fn place<S: Space>(&self, row: u32, column: u32, component: usize) -> Option<usize> {
        let near = &self.neighbours.near[column as usize];
        let place = near.binary_search(&row).ok()?;
        Some(self.columns[self.start(column) + component] + place * degrees_of_freedom::<S>())
    }

    fn structure(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.len();
        SymbolicSparseColMatRef::new_checked(n, n, &self.columns, None, &self.rows)
    }
}

/// The values of the matrix.
pub(super) struct Values {
    /// Without the change of friction by normal velocities.
    symmetric: Vec<f64>,
    /// With it.
    full: Vec<f64>,
    /// Whether the two differ.
    coupled: bool,
}

/// Adds the response of one contact, or of one moment, to unit motions of its bodies.
struct Block<'a> {
    pattern: &'a Pattern,
    values: &'a mut Values,
}

impl Block<'_> {
    /// Adds to a column of a body the impulses and moments on another one.
    fn add<S: Space>(
        &mut self,
        [row, column]: [u32; 2],
        component: usize,
        ([symmetric, coupled], [turning, turning_coupled]): ([S::Vector; 2], [S::Spin; 2]),
        free: impl Fn(u32, usize) -> bool,
    ) {
        let Some(first) = self.pattern.place::<S>(row, column, component) else {
            return;
        };
        for k in 0..degrees_of_freedom::<S>() {
            if !free(row, k) {
                continue;
            }
            let (s, c) = if k < S::D {
                (symmetric[k], coupled[k])
            } else {
                (turning[k - S::D], turning_coupled[k - S::D])
            };
            self.values.symmetric[first + k] += s;
            self.values.full[first + k] += s + c;
        }
    }
}

impl Values {
    /// Assembles the matrix with the slopes of the contacts.
    pub fn new<S: Space>(balance: &Balance<S>, slopes: &[Slope<S>]) -> Self {
        let pattern = &balance.pattern;
        let size = degrees_of_freedom::<S>();
        let mut values = Self {
            symmetric: vec![0.0; pattern.rows.len()],
            full: Vec::new(),
            coupled: slopes.iter().any(|s| s.coupled != 0.0),
        };
        for body in 0..balance.bodies() {
            if !pattern.moves(body) {
                continue;
            }
            let mass = balance.mass(body);
            // The matrix is symmetric: its rows are its columns.
            for (q, column) in mass.iter().enumerate().take(size) {
                if let Some(first) = pattern.place::<S>(body, body, q) {
                    values.symmetric[first..first + size].copy_from_slice(&column[..size]);
                }
            }
        }
        values.full.clone_from(&values.symmetric);
        let mut block = Block {
            pattern,
            values: &mut values,
        };
        for (form, slope) in balance.forms.iter().zip(slopes) {
            if slope.acts() {
                block.add_contact(balance, form.bodies, form.arms, &form.normal, slope);
            }
        }
        for form in balance.moments {
            let contact = &balance.forms[form.contact as usize];
            block.add_moment(balance, contact.bodies, &contact.normal, form);
        }
        values
    }

    /// Returns the factor of the symmetric part; `None` where it is not positive definite.
    pub fn factor(&self, pattern: &mut Pattern) -> Option<Llt<usize, f64>> {
        let order = match pattern.order.take() {
            Some(order) => order,
            None => SymbolicLlt::try_new(pattern.structure(), Side::Lower).ok()?,
        };
        let matrix = SparseColMatRef::new(pattern.structure(), &self.symmetric);
        let factor = Llt::try_new_with_symbolic(order.clone(), matrix, Side::Lower).ok();
        pattern.order = Some(order);
        factor
    }

    /// Solves with the whole matrix, by the factor of its symmetric part, with a weight of each
    /// row's residual; `None` where the iteration does not converge.
    pub fn solve(
        &self,
        pattern: &Pattern,
        factor: &Llt<usize, f64>,
        b: &[f64],
        weights: &[f64],
    ) -> Option<Vec<f64>> {
        let precondition = |x: &mut [f64]| {
            let rows = x.len();
            let x = MatMut::from_column_major_slice_mut(x, rows, 1);
            factor.solve_in_place_with_conj(Conj::No, x);
        };
        if !self.coupled {
            let mut x = b.to_vec();
            precondition(&mut x);
            return Some(x);
        }
        let product = |x: &[f64]| {
            let mut out = vec![0.0; x.len()];
            for (column, x) in x.iter().enumerate() {
                for k in pattern.columns[column]..pattern.columns[column + 1] {
                    out[pattern.rows[k]] += self.full[k] * x;
                }
            }
            out
        };
        let (x, residual) = krylov::solve(product, precondition, b, weights, &KRYLOV);
        (residual <= ACCEPTED).then_some(x)
    }
}

impl Block<'_> {
    fn add_contact<S: Space>(
        &mut self,
        balance: &Balance<S>,
        bodies: [u32; 2],
        arms: [S::Vector; 2],
        normal: &S::Vector,
        slope: &Slope<S>,
    ) {
        for (column, sign) in [(0, 1.0), (1, -1.0)] {
            let body = bodies[column];
            for q in 0..degrees_of_freedom::<S>() {
                if !balance.is_free(body, q) {
                    continue;
                }
                let motion = balance::unit::<S>(q);
                let u = (motion.0 + S::spin_velocity(&motion.1, &arms[column])) * sign;
                let (symmetric, coupled) = slope.apply(normal, &u);
                for (row, sign) in [(0, 1.0), (1, -1.0)] {
                    if !self.pattern.moves(bodies[row]) {
                        continue;
                    }
                    let both = [symmetric * sign, coupled * sign];
                    let turning = both.map(|p| S::moment(&arms[row], &p));
                    let free = |body, k| balance.is_free(body, k);
                    self.add::<S>([bodies[row], body], q, (both, turning), free);
                }
            }
        }
    }

    fn add_moment<S: Space>(
        &mut self,
        balance: &Balance<S>,
        bodies: [u32; 2],
        normal: &S::Vector,
        form: &MomentForm<S>,
    ) {
        for (column, sign) in [(0, 1.0), (1, -1.0)] {
            let body = bodies[column];
            for q in (S::D..degrees_of_freedom::<S>()).filter(|q| balance.is_free(body, *q)) {
                let spin = balance::unit::<S>(q).1 * sign;
                let moment = balance::bending(normal, form, &spin);
                for (row, sign) in [(0, 1.0), (1, -1.0)] {
                    if !self.pattern.moves(bodies[row]) {
                        continue;
                    }
                    let turning = [moment * sign, S::Spin::zero()];
                    let free = |body, k| balance.is_free(body, k);
                    let none = [S::Vector::zero(); 2];
                    self.add::<S>([bodies[row], body], q, (none, turning), free);
                }
            }
        }
    }
}
