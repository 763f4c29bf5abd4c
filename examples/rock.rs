use fretwork::solve::error::Norm;
use fretwork::solve::local::{
    block::BlockMatrix,
    form::{Form, coulomb},
    law,
    nlgs::*,
    state::*,
};
#[path = "probe.rs"]
#[allow(dead_code)]
mod probe;
fn main() {
    let (_, w, q, mu) = probe::load("/tmp/prob/fc3d_RockPile_tob1");
    let w = BlockMatrix::<3>::from_csr(&w);
    let q: Vec<[f64; 3]> = q.chunks(3).map(|x| x.try_into().unwrap()).collect();
    let laws = coulomb(&mu);
    let form = Form::new(&w, &q, &laws, Norm::Field);
    let mut st = State::new(&form, vec![[0.0; 3]; mu.len()]);
    for k in [1000u32, 10000, 100000, 200000, 400000] {
        let mut b = Budget::new(1e-12, k, 20.0);
        Nlgs {
            relaxation: 1.3,
            ..Default::default()
        }
        .solve(&form, &mut st, &mut b);
        let norm = |x: &[[f64; 3]]| x.as_flattened().iter().map(|a| a * a).sum::<f64>().sqrt();
        let mut r: Vec<(f64, usize)> = (0..mu.len())
            .map(|c| {
                let r = law::natural(&st.p[c], &st.u[c], mu[c], 1.0);
                (norm(&[r]), c)
            })
            .collect();
        r.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (mut open, mut stick, mut slide) = (0, 0, 0);
        for c in 0..mu.len() {
            let t = law::slip(&st.p[c]);
            if st.p[c][0] == 0.0 {
                open += 1
            } else if t < mu[c] * st.p[c][0] * (1.0 - 1e-9) {
                stick += 1
            } else {
                slide += 1
            }
        }
        println!(
            "{k} err {:.2e} |p| {:.6e} |u| {:.6e} |q| {:.3e} open {open} stick {stick} slide {slide}",
            st.error,
            norm(&st.p),
            norm(&st.u),
            norm(&q)
        );
        for (x, c) in r.iter().take(6) {
            println!("   {c} {x:.2e} p {:?} u {:?}", st.p[*c], st.u[*c]);
        }
    }
}
