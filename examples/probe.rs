use fretwork::solve::error::Norm;
use fretwork::solve::local::anderson::*;
use fretwork::solve::local::{
    block::BlockMatrix,
    csr::Csr,
    form::{Form, coulomb},
    nlgs::*,
    state::*,
};
use std::time::Instant;
pub fn load(path: &str) -> (usize, Csr, Vec<f64>, Vec<f64>) {
    let b = std::fs::read(path).unwrap();
    let i = |k: usize| i64::from_le_bytes(b[k * 8..k * 8 + 8].try_into().unwrap()) as usize;
    let (dim, nc, nnz) = (i(0), i(1), i(2));
    let u =
        |o: usize, k: usize| u32::from_le_bytes(b[o + k * 4..o + k * 4 + 4].try_into().unwrap());
    let f =
        |o: usize, k: usize| f64::from_le_bytes(b[o + k * 8..o + k * 8 + 8].try_into().unwrap());
    let (o1, o2, o3) = (24, 24 + 4 * nnz, 24 + 8 * nnz);
    let t: Vec<(u32, u32, f64)> = (0..nnz).map(|k| (u(o1, k), u(o2, k), f(o3, k))).collect();
    let o4 = o3 + 8 * nnz;
    let m = dim * nc;
    let q = (0..m).map(|k| f(o4, k)).collect();
    let mu = (0..nc).map(|k| f(o4 + 8 * m, k)).collect();
    (dim, Csr::from_triplets(m, m, &t), q, mu)
}
fn run<const D: usize>(
    name: &str,
    w: &Csr,
    q: &[f64],
    mu: &[f64],
    tol: f64,
    limit: f64,
    which: &[String],
) {
    let w = BlockMatrix::<D>::from_csr(w);
    let q: Vec<[f64; D]> = q.chunks(D).map(|x| x.try_into().unwrap()).collect();
    let laws = coulomb(mu);
    for (label, solver) in solvers::<D>() {
        if !which.is_empty() && !which.iter().any(|s| s == label) {
            continue;
        }
        let mut best = f64::INFINITY;
        let mut out = (0.0, 0);
        for rep in 0..20 {
            let clock = Instant::now();
            let form = Form::new(&w, &q, &laws, Norm::Field);
            let mut st = State::new(&form, vec![[0.0; D]; mu.len()]);
            let mut b = Budget::new(tol, 10_000_000, limit);
            solver.solve(&form, &mut st, &mut b);
            let t = clock.elapsed().as_secs_f64();
            best = best.min(t);
            out = (st.error, st.iterations);
            if t > 0.05 || (rep > 3 && t > 0.005) {
                break;
            }
        }
        println!(
            "{name:<45} {label:<12} {tol:.0e} {} {best:.3e} s  it {:>7} err {:.2e}",
            if out.0 <= tol { "ok " } else { "NO " },
            out.1,
            out.0
        );
    }
}
fn solvers<const D: usize>() -> Vec<(&'static str, Box<dyn Solver<D>>)> {
    vec![
        ("nlgs", Box::new(Nlgs::default())),
        (
            "nlgs1.3",
            Box::new(Nlgs {
                relaxation: 1.3,
                ..Default::default()
            }),
        ),
        ("aa8", Box::new(Anderson::default())),
        (
            "aa5",
            Box::new(Anderson {
                memory: 5,
                ..Default::default()
            }),
        ),
        (
            "aa15",
            Box::new(Anderson {
                memory: 15,
                ..Default::default()
            }),
        ),
        ("newton", Box::new(Newton::default())),
        ("aa-newton", Box::new(Two(40, 1e-3))),
        ("aa-newton6", Box::new(Two(40, 1e-6))),
        ("aa-newton1", Box::new(Two(100, 1e-1))),
        ("ipm", Box::new(fretwork::solve::local::interior::Interior)),
        ("nn200", Box::new(Three(200000, 1e-5))),
        ("nn400", Box::new(Three(400000, 1e-5))),
        ("nlgs-newton4", Box::new(Three(90000, 1e-4))),
        ("nlgs-newton6", Box::new(Three(90000, 1e-6))),
        ("nlgs-aa", Box::new(Three(90000, 0.0))),
        (
            "nlgs1.5",
            Box::new(Nlgs {
                relaxation: 1.5,
                ..Default::default()
            }),
        ),
        (
            "nlgs1.7",
            Box::new(Nlgs {
                relaxation: 1.7,
                ..Default::default()
            }),
        ),
        (
            "nlgs0.8",
            Box::new(Nlgs {
                relaxation: 0.8,
                ..Default::default()
            }),
        ),
        (
            "sym1.3",
            Box::new(Nlgs {
                relaxation: 1.3,
                last: false,
                order: Order::Symmetric,
            }),
        ),
        (
            "auto",
            Box::new(fretwork::solve::local::auto::Auto::default()),
        ),
        (
            "pg",
            Box::new(fretwork::solve::local::gradient::Gradient {
                kind: fretwork::solve::local::gradient::Kind::Plain,
            }),
        ),
        (
            "cpg",
            Box::new(fretwork::solve::local::gradient::Gradient {
                kind: fretwork::solve::local::gradient::Kind::Conjugate,
            }),
        ),
        (
            "pcpg",
            Box::new(fretwork::solve::local::gradient::Gradient {
                kind: fretwork::solve::local::gradient::Kind::Preconditioned,
            }),
        ),
        (
            "apgd",
            Box::new(fretwork::solve::local::accelerated::Accelerated),
        ),
        (
            "nlgs-sym",
            Box::new(Nlgs {
                order: Order::Symmetric,
                ..Default::default()
            }),
        ),
    ]
}
use fretwork::solve::local::newton::*;
struct Two(u32, f64);
impl<const D: usize> Solver<D> for Two {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let mut b = budget.at_most(self.0);
        Anderson::default().solve(form, state, &mut b);
        Newton { alpha: self.1 }.solve(form, state, budget);
    }
}
struct Three(u32, f64);
impl<const D: usize> Solver<D> for Three {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let mut b = budget.at_most(self.0);
        Nlgs {
            relaxation: 1.5,
            ..Default::default()
        }
        .solve(form, state, &mut b);
        eprintln!("after nlgs {:.2e}", state.error);
        if self.1 == 0.0 {
            Anderson::default().solve(form, state, budget);
        } else {
            Newton { alpha: self.1 }.solve(form, state, budget);
        }
    }
}
fn main() {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let tol: f64 = a[0].parse().unwrap();
    let limit: f64 = a[1].parse().unwrap();
    let mut files: Vec<_> = std::fs::read_dir("/tmp/prob")
        .unwrap()
        .map(|e| e.unwrap().path().display().to_string())
        .filter(|f| f.contains(&a[2]))
        .collect();
    files.sort();
    for f in files {
        let (dim, w, q, mu) = load(&f);
        let name = f.rsplit('/').next().unwrap();
        if dim == 2 {
            run::<2>(name, &w, &q, &mu, tol, limit, &a[3..])
        } else {
            run::<3>(name, &w, &q, &mu, tol, limit, &a[3..])
        }
    }
}
