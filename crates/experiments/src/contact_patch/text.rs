//! The answer as lines of text.

use super::{Answer, Conditions, Range, Strength, Yield, YieldKind};
use fretwork_observe::quantity::unit::{FORCE, Unit, VOLUME};
use fretwork_observe::quantity::{number, quantity};
use std::fmt::Write as _;

/// Energy per length rolled; for a line contact also per length of the line.
const T_GAMMA: Unit = Unit::by_depth("J/m", "J/m^2");

/// Formats a number with its interval, in the unit of its value.
fn ranged(range: &Range, unit: &str) -> String {
    let middle = quantity(range.value, unit);
    match range.is_wide() {
        false => middle,
        true => format!(
            "{middle} ({} to {})",
            quantity(range.low, unit),
            quantity(range.high, unit)
        ),
    }
}

/// A share as per cent.
fn percent(range: &Range) -> String {
    let one = |x: f64| format!("{} %", number(100.0 * x, 3));
    match range.is_wide() {
        false => one(range.value),
        true => format!(
            "{} ({} to {})",
            one(range.value),
            one(range.low),
            one(range.high)
        ),
    }
}

/// The limits of the pressure, each with the yield stress that it is from.
fn strength_lines(s: &Strength, add: &mut impl FnMut(&str, String)) {
    let from = |of: &Yield| format!("from {} as {}", quantity(of.yield_stress, "Pa"), of.name());
    let source = |of: &Yield| match (&of.source, of.kind) {
        (Some(source), _) => Some(source.clone()),
        (None, YieldKind::Flow) => {
            Some("an upper bound: metals that harden yield below their flow stress".to_owned())
        }
        (None, _) => None,
    };
    let first = quantity(s.first_yield, "Pa");
    add("first yield", format!("at {first}, {}", from(&s.first)));
    let first = source(&s.first);
    if let Some(line) = &first {
        add("", line.clone());
    }
    let free = quantity(s.shakedown_rolling, "Pa");
    let limits = match s.traction {
        None => format!("{free} in free rolling"),
        Some(t) => {
            let at = match t.asked {
                true => format!("at Q/P {}", number(t.ratio, 3)),
                false => "in full slip".to_owned(),
            };
            format!(
                "{free} in free rolling, {} {at}",
                quantity(s.shakedown, "Pa")
            )
        }
    };
    add(
        "shakedown",
        format!("up to {limits}, {}", from(&s.in_service)),
    );
    if let Some(line) = source(&s.in_service).filter(|line| Some(line) != first.as_ref()) {
        add("", line);
    }
}

impl Answer {
    /// The answer as text.
    pub fn text(&self) -> String {
        let dimension = if self.shape == "line" { 2 } else { 3 };
        let (force, energy) = (FORCE.symbol(dimension), T_GAMMA.symbol(dimension));
        let title = format!(
            "contact patch of {} on {}: {}, {}",
            self.bodies[0],
            self.bodies[1],
            self.shape,
            quantity(self.load, force)
        );
        let mut out = title;
        let mut add = |label: &str, text: String| {
            let _ = write!(out, "\n  {label:<22} {text}");
        };
        let p = &self.patch;
        add(
            "Hertz pressure",
            format!(
                "{} (mean {})",
                quantity(p.pressure, "Pa"),
                quantity(p.mean_pressure, "Pa")
            ),
        );
        add(
            "size",
            match p.semi_axis_across {
                None => format!("half-width {}", quantity(p.semi_axis, "m")),
                Some(b) => format!(
                    "semi-axes {} along the motion, {} across; {} mm2",
                    quantity(p.semi_axis, "m"),
                    quantity(b, "m"),
                    number(1e6 * p.area.unwrap_or_default(), 4)
                ),
            },
        );
        add(
            "approach",
            match p.approach {
                Some(d) => quantity(d, "m"),
                None => "depends on the form of the bodies at a distance".to_owned(),
            },
        );
        add("E*", quantity(self.effective_modulus, "Pa"));
        if let Some(s) = &self.strength {
            strength_lines(s, &mut add);
        }
        if let Some(f) = &self.friction {
            let part = |x: Option<f64>| x.map_or("not known".to_owned(), |x| number(x, 2));
            let from = match f.runs {
                0 => String::new(),
                n => format!(
                    ", from {n} run{}: scatter {}, numerical error {}",
                    if n == 1 { "" } else { "s" },
                    part(f.scatter),
                    part(f.numerical)
                ),
            };
            add(
                "friction coefficient",
                format!("{}{from}", ranged(&f.coefficient, "")),
            );
            if let Some(conditions) = &f.conditions {
                add("conditions of the runs", self.conditions(conditions));
            }
        }
        self.slip_lines(force, energy, &mut add);
        self.wear_lines(dimension, &mut add);
        self.carried_lines(dimension, &mut add);
        self.window_lines(&mut add);
        for warning in &self.warnings {
            let (heading, text) = warning.split_once(": ").unwrap_or(("WARNING", warning));
            add(heading, text.to_owned());
        }
        out
    }

    /// Pressure, materials and motion of the runs, and what is done about their speed.
    fn conditions(&self, of: &Conditions) -> String {
        let mut parts = Vec::new();
        parts.extend(
            of.pressure
                .map(|p| format!("{} in the mean", quantity(p, "Pa"))),
        );
        if !of.materials.is_empty() {
            parts.push(of.materials.join(" and "));
        }
        if let (Some(slip), Some(to_and_fro)) = (of.slip, of.reciprocates) {
            let (by, ways) = match to_and_fro {
                true => ("+-", "to and fro"),
                false => ("", "one way"),
            };
            parts.push(format!("slip of {by}{} {ways}", quantity(slip, "m")));
        }
        let patch = self.rolling.as_ref().and_then(|r| r.slip_speed);
        let speed = of.speed.map(|v| match patch {
            None => format!("at {}", quantity(v, "m/s")),
            Some(patch) => format!(
                "at {}, taken as that at {}",
                quantity(v, "m/s"),
                quantity(patch.value, "m/s")
            ),
        });
        parts.extend(speed);
        parts.join(", ")
    }

    fn slip_lines(&self, force: &str, energy: &str, add: &mut impl FnMut(&str, String)) {
        if let Some(t) = &self.tangential {
            let at = match &t.slip_displacement {
                Some(d) => format!(", displaced by {}", ranged(d, "m")),
                None => "; the displacement depends on the form of the bodies at a distance".into(),
            };
            add(
                "gross slip from",
                format!("{}{at}", ranged(&t.slip_force, force)),
            );
            if let (Some(share), Some(stuck)) = (&t.share, &t.stuck) {
                let state = match (share.low >= 1.0, share.high < 1.0) {
                    (true, _) => "gross slip",
                    (_, true) => "partial slip",
                    _ => "partial or gross slip",
                };
                add(
                    "as asked",
                    format!(
                        "{state}, Q/(mu P) {}, semi-axes of the part that sticks {} of the patch",
                        ranged(share, ""),
                        ranged(stuck, "")
                    ),
                );
            }
            if let Some(slip) = &t.local_slip {
                let text = match slip.high > 0.0 {
                    true => format!("+-{}", ranged(slip, "m")),
                    false => "none: it sticks".to_owned(),
                };
                add("slip in the middle", text);
            }
        }
        if let Some(r) = &self.rolling {
            add(
                "full slip in rolling",
                format!("from a creepage of {}", percent(&r.saturation)),
            );
            if let (Some(xi), Some(adhesion), Some(q), Some(e)) =
                (r.creepage, &r.adhesion, &r.force, &r.energy)
            {
                add(
                    "adhesion",
                    format!(
                        "Q/P {} at a creepage of {} %, Q {}",
                        ranged(adhesion, ""),
                        number(100.0 * xi, 3),
                        ranged(q, force)
                    ),
                );
                add("T gamma", ranged(e, energy));
            }
            if let Some(v) = &r.slip_speed {
                add("speed of slip", ranged(v, "m/s"));
            }
        }
    }

    fn wear_lines(&self, dimension: usize, add: &mut impl FnMut(&str, String)) {
        let Some(wear) = &self.wear else {
            return;
        };
        if let Some(map) = &wear.energy_map {
            add(
                "wear, T gamma/A",
                format!(
                    "{} N/mm2, {}; {} a metre rolled",
                    ranged(&map.energy_per_area.map(|x| 1e-6 * x), ""),
                    map.regime,
                    ranged(&map.volume, "m3")
                ),
            );
            add("", format!("measured on {}", map.measured_on));
        }
        if let Some(regime) = &wear.regime {
            let [low, high] = regime.coefficient;
            add(
                "wear, Jendel's chart",
                format!(
                    "{} at a slip of {} and {} of the hardness: K {low:e} to {high:e}",
                    regime.words(),
                    ranged(&regime.slip_speed, "m/s"),
                    number(regime.pressure_over_hardness, 2)
                ),
            );
        }
        for body in &wear.archard {
            let unit = VOLUME.symbol(dimension);
            let mut text = format!(
                "k {} 1/Pa, {} a metre rolled",
                ranged(&body.coefficient, ""),
                ranged(&body.volume, unit)
            );
            if let Some(d) = &body.depth_per_metre {
                let _ = write!(text, "; {} in 1000 km", ranged(&d.map(|d| 1e6 * d), "m"));
            }
            if let Some(d) = &body.depth_per_passage {
                let _ = write!(
                    text,
                    "; {} in 1e6 passages",
                    ranged(&d.map(|d| 1e6 * d), "m")
                );
            }
            add("wear, Archard", format!("{}: {text}", body.body));
        }
    }

    fn carried_lines(&self, dimension: usize, add: &mut impl FnMut(&str, String)) {
        let unit = VOLUME.symbol(dimension);
        for body in self.wear.iter().flat_map(|w| &w.window) {
            add(
                "wear, window",
                format!(
                    "{}: {} mm3/(N m), {} a metre rolled; {} in 1e6 passages",
                    body.body,
                    ranged(&body.specific_rate.map(|k| 1e9 * k), ""),
                    ranged(&body.volume, unit),
                    ranged(&body.depth_per_passage.map(|d| 1e6 * d), "m")
                ),
            );
        }
    }

    fn window_lines(&self, add: &mut impl FnMut(&str, String)) {
        let w = &self.window;
        add(
            "window in the middle",
            format!(
                "{} under {}: {} in two dimensions; at its edges the pressure is {} % lower and the gap {} wider",
                quantity(w.width, "m"),
                quantity(w.pressure, "Pa"),
                quantity(w.load, FORCE.symbol(2)),
                number(100.0 * w.pressure_drop, 2),
                quantity(w.gap, "m")
            ),
        );
        if let Some(slip) = &w.slip {
            let text = match self.rolling.as_ref().and_then(|r| r.creepage) {
                _ if slip.high <= 0.0 => "none: the middle sticks".to_owned(),
                Some(_) => format!("a passage slips by {}", ranged(slip, "m")),
                None => format!("+-{}", ranged(slip, "m")),
            };
            add("slip in the window", text);
        }
    }
}
