//! Comparison of reductions with dense formulas on random problems.

use super::*;
use crate::solve::local::global::Equalities;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn dense(a: &Csr) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(a.rows, a.columns);
    for (r, c, x) in triplets(a) {
        out[(r as usize, c as usize)] = x;
    }
    out
}

fn random(rows: usize, columns: usize, per_row: usize, rng: &mut Pcg64) -> Csr {
    let mut entries = Vec::new();
    for r in 0..rows {
        for _ in 0..per_row {
            let c = rng.random_range(0..columns);
            entries.push((r as u32, c as u32, rng.random_range(-1.0..1.0)));
        }
    }
    Csr::from_triplets(rows, columns, &entries)
}

/// Nonsymmetric diagonal blocks of `block` rows, with masses spread over `spread` powers of ten.
fn mass(n: usize, block: usize, spread: i32, rng: &mut Pcg64) -> Csr {
    let mut entries = Vec::new();
    for i in 0..n {
        let first = i / block * block;
        let scale = 10f64.powi(rng.random_range(-spread..=spread));
        for j in first..(first + block).min(n) {
            let x = rng.random_range(-0.4..0.4) / block as f64 + f64::from(u8::from(i == j));
            entries.push((i as u32, j as u32, scale * x));
        }
    }
    Csr::from_triplets(n, n, &entries)
}

fn numbers(count: usize, rng: &mut Pcg64) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-1.0..1.0)).collect()
}

fn close(a: &DMatrix<f64>, b: &DMatrix<f64>, what: &str) {
    let scale = b.amax().max(1e-300);
    let gap = (a - b).amax() / scale;
    assert!(gap < 1e-10, "{what}: {gap:e}");
}

fn column(x: &[f64]) -> DMatrix<f64> {
    DMatrix::from_column_slice(x.len(), 1, x)
}

#[test]
fn a_global_problem_has_the_dense_local_form() {
    let mut rng = Pcg64::seed_from_u64(3);
    // (rows, block of the mass matrix, powers of ten of spread, constraints)
    for (n, block, spread, p) in [
        (6, 1, 4, 0),
        (12, 3, 0, 0),
        (18, 6, 2, 0),
        (12, 3, 0, 2),
        (200, 100, 0, 0),
        (150, 150, 0, 7),
    ] {
        let m = 6;
        let problem = GlobalProblem {
            dimension: 3,
            m: mass(n, block, spread, &mut rng),
            h: random(n, m, 2, &mut rng),
            f: numbers(n, &mut rng),
            w: numbers(m, &mut rng),
            mu: vec![0.3; 2],
            equalities: (p > 0).then(|| Equalities {
                g: random(n, p, 2, &mut rng),
                b: numbers(p, &mut rng),
            }),
        };
        let mut k = DMatrix::zeros(n + p, n + p);
        k.view_mut((0, 0), (n, n)).copy_from(&dense(&problem.m));
        let mut tall = DMatrix::zeros(n + p, m);
        tall.view_mut((0, 0), (n, m)).copy_from(&dense(&problem.h));
        let mut load = DVector::zeros(n + p);
        load.rows_mut(0, n).copy_from_slice(&problem.f);
        if let Some(e) = &problem.equalities {
            let g = dense(&e.g);
            k.view_mut((0, n), (n, p)).copy_from(&-&g);
            k.view_mut((n, 0), (p, n)).copy_from(&g.transpose());
            for (i, b) in e.b.iter().enumerate() {
                load[n + i] = -b;
            }
        }
        let inverse = k.clone().try_inverse().unwrap();
        let reduction = Reduction::new(&problem).unwrap();
        let w = tall.transpose() * &inverse * &tall;
        close(&dense(&reduction.local.w), &w, "W");
        let q = tall.transpose() * &inverse * &load + DVector::from_column_slice(&problem.w);
        close(&column(&reduction.local.q), &column(q.as_slice()), "q");

        let r = numbers(m, &mut rng);
        let (v, l) = reduction.velocities(&problem, &r);
        let exact = &inverse * (&tall * DVector::from_column_slice(&r) + &load);
        let back: Vec<f64> = v.iter().chain(&l).copied().collect();
        close(&column(&back), &column(exact.as_slice()), "v, l");
        let u = problem.relative_velocities(&v);
        close(&column(&u), &column(&reduction.local.velocities(&r)), "u");
    }
}

#[test]
fn bodies_that_share_no_contact_stay_apart() {
    // Two bodies of three rows with one contact each: two blocks of W.
    let m = Csr::from_triplets(6, 6, &(0..6).map(|i| (i, i, 2.0)).collect::<Vec<_>>());
    let h = m.clone();
    let problem = GlobalProblem {
        dimension: 3,
        m,
        h,
        f: vec![0.0; 6],
        w: vec![1.0; 6],
        mu: vec![0.1; 2],
        equalities: None,
    };
    let local = Reduction::new(&problem).unwrap().local;
    assert_eq!(local.w.values, [2.0; 6]);
    assert_eq!(local.w.indices, [0, 1, 2, 3, 4, 5]);
    assert_eq!(local.q, [1.0; 6]);
}

#[test]
fn multipliers_are_eliminated_densely() {
    let mut rng = Pcg64::seed_from_u64(4);
    for p in [1, 5] {
        let problem = LocalProblem {
            dimension: 2,
            w: mass(6, 6, 0, &mut rng),
            q: numbers(6, &mut rng),
            mu: vec![0.2; 3],
        };
        let multipliers = Multipliers {
            v: random(6, p, 2, &mut rng),
            r: mass(p, p, 1, &mut rng),
            s: numbers(p, &mut rng),
        };
        let (v, s) = (
            dense(&multipliers.v),
            DVector::from_column_slice(&multipliers.s),
        );
        let inverse = dense(&multipliers.r).try_inverse().unwrap();
        let reduced = Elimination::new(&problem, &multipliers).unwrap();
        let w = dense(&problem.w) - &v * &inverse * v.transpose();
        close(&dense(&reduced.local.w), &w, "W");
        let q = DVector::from_column_slice(&problem.q) - &v * &inverse * &s;
        close(&column(&reduced.local.q), &column(q.as_slice()), "q");
        let r = numbers(6, &mut rng);
        let l = reduced.multipliers(&multipliers, &r);
        let exact = -&inverse * (v.transpose() * DVector::from_column_slice(&r) + s);
        close(&column(&l), &column(exact.as_slice()), "l");
    }
}

#[test]
fn a_singular_matrix_is_refused_where_it_is() {
    for (n, dense) in [(4, true), (120, false)] {
        // A chain of springs without a support: its rows sum to zero.
        let mut entries = Vec::new();
        for i in 1..n as u32 - 1 {
            entries.extend([(i, i, 1.0), (i + 1, i + 1, 1.0)]);
            entries.extend([(i, i + 1, -1.0), (i + 1, i, -1.0)]);
        }
        entries.push((0, 0, 1.0));
        let m = Csr::from_triplets(n, n, &entries);
        let singular = Factors::new(&m).unwrap_err();
        assert_eq!(
            (singular.first, singular.rows),
            (1, n - 1),
            "dense: {dense}"
        );
    }
    let nothing = Csr::from_triplets(2, 2, &[(0, 0, 1.0)]);
    let singular = Factors::new(&nothing).unwrap_err();
    assert!(singular.to_string().contains("row 1"), "{singular}");
}

#[test]
fn a_badly_scaled_matrix_is_not_singular() {
    let m = Csr::from_triplets(2, 2, &[(0, 0, 1e-160), (0, 1, 1e-161), (1, 1, 1e150)]);
    let factors = Factors::new(&m).unwrap();
    let mut x = [3e-160, 2e150];
    factors.solve(&mut x);
    assert!((x[0] - 2.8).abs() < 1e-14 && x[1] == 2.0, "{x:?}");
}
