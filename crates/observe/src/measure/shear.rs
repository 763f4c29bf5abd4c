//! Plane shear of the grains between two heights, away from the walls.
//!
//! The shear rate is the slope of v_x over height. Stresses are Love-Weber stresses, sum f l / V, of the
//! contacts whose point lies between the heights, and the solid fraction counts the part of each grain
//! between them. The inertial number is rate sqrt(m/p) with the mean mass in 2D (da Cruz et al., Phys. Rev. E
//! 72 (2005) 021309), and rate d sqrt(density/p) in 3D. In the summary mu and I are computed from the mean
//! stresses and the mean rate.

use super::{Observer, RunEnd, grains, line, mean, since};
use crate::chart::{Axis, Chart, Series};
use crate::output::Output;
use crate::statistics::{Column, Table};
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use std::f64::consts::PI;

/// Observer for [`fretwork_scene::measures::MeasureSpec::Shear`].
#[derive(Clone, Debug)]
pub struct Shear {
    pub(super) name: String,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) start: f64,
}

const PARTS: [(&str, &str, &str); 5] = [
    ("rate", "1/s", "shear rate of the grains"),
    (
        "p",
        "Pa",
        "normal stress across the layers, from the contacts",
    ),
    (
        "mu",
        "",
        "shear stress over normal stress, from the contacts",
    ),
    ("phi", "", "solid fraction"),
    ("I", "", "inertial number"),
];

impl Shear {
    fn column(&self, part: &str) -> String {
        format!("{}_{part}", self.name)
    }
}

impl<S: Space> Observer<S> for Shear {
    fn name(&self) -> String {
        super::name_of("shear", &self.name)
    }

    fn columns(&self) -> Vec<Column> {
        let column = |(part, unit, doc)| Column::new(self.column(part), unit, doc);
        PARTS.into_iter().map(column).collect()
    }

    fn sample(&mut self, s: &Simulation<S>) -> Vec<f64> {
        let up = S::D - 1;
        let section: f64 = (0..up)
            .map(|k| s.shapes.periodic.period[k].unwrap_or(1.0))
            .product();
        let volume = section * (self.high - self.low);
        let inside = |z: f64| (self.low..self.high).contains(&z);
        let all = grains(s);
        let layer: Vec<(f64, f64, f64, f64)> = all
            .iter()
            .filter(|g| g.at[up] + g.radius > self.low && g.at[up] - g.radius < self.high)
            .map(|g| {
                let velocity = s.state.bodies.velocity[g.body][0];
                (g.at[up], velocity, g.radius, g.mass)
            })
            .collect();
        let within = layer.iter().filter(|g| inside(g.0));
        let rate = line(within.clone().map(|g| (g.0, g.1))).unwrap_or(0.0);
        let count = within.clone().count().max(1) as f64;
        let mass = within.clone().map(|g| g.3).sum::<f64>() / count;
        let radius = within.map(|g| g.2).sum::<f64>() / count;
        let solid: f64 = layer
            .iter()
            .map(|g| below(S::D, g.2, self.high - g.0) - below(S::D, g.2, self.low - g.0))
            .sum();
        let (mut normal, mut shear) = (0.0, 0.0);
        for contact in &s.state.network.contacts {
            let (a, b) = crate::placement::ends(s, contact);
            if !inside(0.5 * (a[up] + b[up])) {
                continue;
            }
            // The branch from the antagonist to the candidate, since the impulse acts on the candidate.
            let branch = a[up] - b[up];
            normal += contact.impulse[up] * branch;
            shear += contact.impulse[0] * branch;
        }
        let per = 1.0 / (s.options.scheme.h * volume);
        let (p, tau) = (normal * per, shear * per);
        let inertial = if p > 0.0 {
            let pace = if S::D == 2 {
                (mass / p).sqrt()
            } else {
                2.0 * radius * (mass / S::ball_volume(radius) / p).sqrt()
            };
            rate.abs() * pace
        } else {
            0.0
        };
        let mu = if p > 0.0 { tau.abs() / p } else { 0.0 };
        vec![rate, p, mu, solid / volume, inertial]
    }

    fn outcome(&self, table: &Table) -> Vec<(String, f64)> {
        // Stresses fluctuate strongly: a mean of ratios would be dominated by instants of low load.
        let [rate, p, mu, phi, inertial] =
            PARTS.map(|part| since(table, &self.column(part.0), self.start));
        let with_p = |values: &[(f64, f64)], power: f64| {
            let pairs = values.iter().zip(&p);
            let products = pairs.map(|(v, p)| (v.0, v.1 * p.1.max(0.0).powf(power)));
            mean(&products.collect::<Vec<_>>())
        };
        let load = mean(&p).filter(|p| *p > 0.0);
        let over = |sum: Option<f64>, power: f64| Some(sum? / load?.powf(power));
        let means = [
            ("rate", mean(&rate)),
            ("p", mean(&p)),
            ("mu", over(with_p(&mu, 1.0), 1.0)),
            ("phi", mean(&phi)),
            ("I", over(with_p(&inertial, 0.5), 0.5)),
        ];
        let named = means
            .into_iter()
            .filter_map(|(part, value)| Some((self.column(part), value?)));
        named.collect()
    }

    fn figures(&self, end: &RunEnd<'_, S>) -> Vec<Output> {
        let RunEnd { title, table, .. } = *end;
        let chart = |part: &str, heading: &str, name: &str, unit: &'static str| {
            let points = since(table, &self.column(part), 0.0);
            let mut chart = Chart::new(heading, Axis::new("time t", "s"), Axis::new(name, unit))
                .with_unless_zero(Series::new(String::new(), points));
            chart.subtitle = Some(title.to_owned());
            chart
        };
        let panels = [
            chart(
                "mu",
                "Effective friction",
                "friction coefficient µ = τ/p",
                "",
            ),
            chart("phi", "Solid fraction", "solid fraction φ", ""),
            chart("I", "Inertial number", "inertial number I", ""),
            chart("p", "Pressure", "normal stress p", "Pa"),
        ];
        vec![Output::charts(format!("{}.png", self.name), panels, 2)]
    }
}

/// Volume of a ball (m^3; m^2 in 2D) below a horizontal plane at height `d` above its centre (m).
pub(super) fn below(dimension: usize, r: f64, d: f64) -> f64 {
    let d = d.clamp(-r, r);
    if dimension == 2 {
        // Half the chord; this form has no cancellation near the poles.
        let half = ((r - d) * (r + d)).sqrt();
        r * r * half.atan2(-d) + d * half
    } else {
        PI * (2.0 / 3.0 * r * r * r + r * r * d - d * d * d / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_cut_in_two() {
        for dimension in [2, 3] {
            let whole = below(dimension, 0.3, 1.0);
            let half = below(dimension, 0.3, 0.0);
            assert!(
                (whole - 2.0 * half).abs() < 1e-15 && below(dimension, 0.3, -0.4).abs() < 1e-15
            );
            // The derivative is the area of the section.
            let (d, e) = (0.11, 1e-6);
            let section = (below(dimension, 0.3, d + e) - below(dimension, 0.3, d - e)) / (2.0 * e);
            let c = (0.09f64 - d * d).sqrt();
            let exact = if dimension == 2 { 2.0 * c } else { PI * c * c };
            assert!((section - exact).abs() < 1e-8);
        }
    }
}
