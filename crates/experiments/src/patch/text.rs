//! The answer as lines of text.

use super::answer::{Answer, Motion, Point, Wear};
use super::profiles::Contact;
use super::rolling::comparison::Comparison;
use super::rolling::passages_shown;
use super::third_body::ThirdBody;
use crate::amounts::short;
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::Estimate;
use std::fmt::Write as _;

/// Adds a line with a label to a text.
pub(super) fn add_line(out: &mut String, label: &str, text: &str) {
    let _ = write!(out, "\n  {label:<18} {text}");
}

impl Answer {
    /// Returns the answer as text.
    pub fn text(&self) -> String {
        let mut out = format!("{}: {} on {}", self.name, self.bodies[0], self.bodies[1]);
        let mut add = |label: &str, text: String| {
            add_line(&mut out, label, &text);
        };
        let speed = self.speed.map(|v| format!(", {}", quantity(v, "m/s")));
        add(
            "load",
            quantity(self.load, "N") + &speed.unwrap_or_default(),
        );
        let laws: Vec<String> = self.laws.iter().map(|(k, n)| format!("{k} {n}")).collect();
        add("laws", laws.join(", "));
        let mut patch = format!(
            "{} largest pressure, {} mm2",
            quantity(self.pressure, "Pa"),
            number(1e6 * self.area, 4)
        );
        if self.approach.is_finite() {
            patch += &format!(", approach {}", quantity(self.approach, "m"));
        }
        add("patch", patch);
        let yields = self.strength.as_ref().and_then(|s| s.yields(self.pressure));
        if let Some(yields) = &yields {
            add("steel", yields.clone());
        }
        for note in &self.notes {
            add("note", note.clone());
        }
        if let Some(about) = &self.about_method {
            add("method", about.clone());
        }
        add(
            "grid",
            format!(
                "{} x {} cells of {} x {}",
                self.cells[0],
                self.cells[1],
                quantity(self.cell[0], "m"),
                quantity(self.cell[1], "m")
            ),
        );
        let contact = self.contact.as_ref().map(Contact::lines);
        for (label, text) in contact.unwrap_or_default() {
            add(label, text);
        }
        let windows = self.third_body.as_ref();
        for (label, text) in windows.map(ThirdBody::lines).unwrap_or_default() {
            add(label, text);
        }
        for (k, point) in self.points.iter().enumerate() {
            out.push('\n');
            let over = match windows {
                Some(_) => "seeds",
                None => "members",
            };
            out.push_str(&point.text(over, &self.errors));
            if let Some(settled) = windows.and_then(|w| w.points.get(k)) {
                add_line(&mut out, "windows", &settled.line());
            }
        }
        for other in &self.comparisons {
            out.push('\n');
            out.push_str(&other.text());
        }
        for measured in &self.loops {
            out.push('\n');
            out.push_str(&measured.text());
        }
        if let Some(worn) = &self.passages {
            let count = number(worn.end.passages, 4);
            let _ = write!(
                out,
                "\nafter {count} passages of point {}",
                worn.about.point
            );
            for (label, text) in passages_shown::lines(self, worn) {
                add_line(&mut out, &label, &text);
            }
        }
        for history in &self.cycles {
            out.push('\n');
            out.push_str(&history.text(self.load));
        }
        if let Some(map) = &self.map {
            out.push('\n');
            out.push_str(&map.text());
        }
        let notes = self.points.iter().map(|p| &p.notes);
        let notes = notes.chain(self.cycles.iter().map(|h| &h.notes));
        let notes = notes.chain(self.passages.iter().map(|w| &w.notes));
        let notes = notes.chain(self.map.iter().map(|m| &m.notes));
        let wholes = usize::from(self.passages.is_some()) + usize::from(self.map.is_some());
        let all = self.points.len() + self.cycles.len() + wholes;
        let noted = notes.filter(|n| !n.is_empty()).count();
        let mut verdict = match (noted, self.notes.len()) {
            (0, 0) => "all points converged, within the range of the theory".to_owned(),
            (0, _) => "the patch has notes, see above".to_owned(),
            (n, _) => format!("{n} of {all} results have notes, see above"),
        };
        if yields.is_some() {
            verdict += "; bodies are elastic here, and the steel yields, see `steel`";
        }
        let _ = write!(out, "\nverdict: {verdict}");
        out
    }
}

/// Components of the force over its size that are rounding, and the arm of a moment (m).
const ROUNDING: f64 = 1e-6;
const ROUNDING_ARM: f64 = 1e-9;

impl Point {
    /// Returns its lines; its band is that over `members`, its error `by` the grid or a theory.
    fn text(&self, members: &str, by: &str) -> String {
        let mut out = match self.motion {
            Motion::Rolling(c) => {
                let percent = |x: f64| format!("{} %", short(100.0 * x));
                let error = self.creepage_error.map(|e| match e.is_finite() {
                    true => format!(" +- {} % {by}", number(100.0 * e, 2)),
                    false => ", not determined".to_owned(),
                });
                let along = percent(c.along) + &error.unwrap_or_default();
                let mut parts = vec![format!("creepage {along}")];
                if c.across != 0.0 {
                    parts.push(format!("across {}", percent(c.across)));
                }
                if c.spin != 0.0 {
                    parts.push(format!("spin {}", quantity(c.spin, "1/m")));
                }
                parts.join(", ")
            }
            Motion::Fretting(amplitude) => match &self.stroke {
                Some(c) if c.by_force => format!("force {}", quantity(c.force.value, "N")),
                _ => format!("amplitude {}", quantity(amplitude, "m")),
            },
        };
        let rolls = self.stroke.is_none();
        let mut add = |label: &str, text: String| {
            add_line(&mut out, label, &text);
        };
        let within = |e: Estimate, unit: &str| {
            let (value, error) = (quantity(e.value, unit), quantity(e.error, unit));
            format!("{value} +- {error} by the grid")
        };
        let mut adhesion = number(self.adhesion, 4);
        // A given force has no error.
        let spun = matches!(self.motion, Motion::Rolling(c) if c.spin != 0.0);
        let pulled = self.creepage_error.is_some() && !spun;
        if !(pulled || self.stroke.is_some_and(|c| c.by_force)) {
            let error = number(self.adhesion_error, 2);
            adhesion += &format!(" +- {error} {by}");
        }
        if let Some(band) = self.adhesion_band {
            let (low, high) = (number(band.low, 4), number(band.high, 4));
            adhesion += &format!(", {low} to {high} over the {members}");
        }
        add(if rolls { "adhesion" } else { "Q/P" }, adhesion);
        // What is left of a component that cancels is rounding.
        let size = self.force[0].hypot(self.force[1]);
        let seen = |x: f64, least: f64| if x.abs() > least * size { x } else { 0.0 };
        let forces = self.force.map(|f| quantity(seen(f, ROUNDING), "N"));
        if rolls {
            let moment = self.moment.map(|m| quantity(seen(m, ROUNDING_ARM), "N m"));
            let moment = moment.map_or(String::new(), |m| format!(", {m}"));
            add(
                "on the first body",
                format!("{} along, {} across{moment}", forces[0], forces[1]),
            );
            let supplied = quantity(self.t_gamma, "J/m");
            // Pressures of like bodies are alike on both sides.
            let resist = self.resistance.abs() > ROUNDING * self.t_gamma.abs();
            let resistance = resist.then(|| {
                let work = quantity(self.resistance, "J/m");
                format!(", and {work} by pressures of unlike bodies")
            });
            add("T gamma", supplied + &resistance.unwrap_or_default());
        }
        if let Some(cycle) = &self.stroke {
            match cycle.by_force {
                true => add("displacement", within(cycle.displacement, "m")),
                false => add("force", within(cycle.force, "N")),
            }
            add("energy of a cycle", within(cycle.energy, "J"));
            let [ratio, slip] = [cycle.energy_ratio, cycle.slip_ratio].map(|x| number(x, 3));
            add(
                "loop",
                format!("A = E/(4 Q delta) {ratio}, slip ratio {slip}"),
            );
        }
        if let Some(stuck) = self.stuck {
            let regime = match stuck {
                _ if rolls => "",
                0.0 => ": gross slip",
                x if x < 1.0 => ": partial slip",
                _ => ": stick",
            };
            let share = number(100.0 * stuck, 3);
            add("sticks", format!("{share} % of the area{regime}"));
        }
        if let Some(speed) = self.slip_speed {
            let mut text = format!("up to {}", quantity(speed, "m/s"));
            if let Some(error) = self.slip_speed_error {
                text += &format!(" +- {} {by}", quantity(error, "m/s"));
            }
            add("slip velocity", text);
        }
        if let Some(t) = self.temperature {
            let error = self.temperature_error.unwrap_or(f64::NAN);
            let [t, error] = [(t, 4), (error, 2)].map(|(x, digits)| number(x, digits));
            add("temperature", format!("up to {t} K +- {error} K {by}"));
        }
        for wear in &self.wear {
            add(&format!("wear of {}", wear.body), wear.text(rolls, by));
        }
        for note in &self.notes {
            add("", note.clone());
        }
        out
    }
}

impl Wear {
    /// Returns volume and depth, of a passage or a cycle; where grid or seeds do not determine them
    /// it begins with that.
    fn text(&self, rolls: bool, by: &str) -> String {
        let undetermined = match self.is_known() {
            true => "",
            false => "not determined: ",
        };
        let [volume, error] =
            [(self.volume, 4), (self.volume_error, 2)].map(|(v, digits)| number(1e9 * v, digits));
        let [depth, depth_error] = [self.depth, self.depth_error].map(|d| quantity(d, "m"));
        let [unit, of] = match rolls {
            true => ["mm3 per metre", "passage"],
            false => ["mm3 a cycle", "cycle"],
        };
        let seeds = self.half_width.map(|half| {
            let half = number(100.0 * half, 2);
            format!(" +- {half} % over the seeds")
        });
        format!(
            "{undetermined}{volume} {unit} +- {error} {by}{}, up to {depth} +- {depth_error} a {of} ({})",
            seeds.unwrap_or_default(),
            self.law
        )
    }
}

impl Comparison {
    fn text(&self) -> String {
        let mut out = format!("beside {}", self.name);
        let mut add = |label: &str, text: String| {
            add_line(&mut out, label, &text);
        };
        match &self.off {
            Some(off) => {
                let signed =
                    |x: f64| format!("{}{}", if x < 0.0 { "-" } else { "+" }, number(x.abs(), 3));
                let percent = |x: f64| format!("{} %", number(100.0 * x, 3));
                add(
                    "the curve is off",
                    format!(
                        "by {} on average, {} (root of the mean square), at most {} at a creepage of {}, over {} points",
                        signed(off.mean),
                        number(off.rms, 3),
                        signed(off.largest),
                        percent(off.at),
                        off.points
                    ),
                );
                if !self.curve {
                    add(
                        "its band reaches",
                        format!("{} of them", percent(off.reached)),
                    );
                }
            }
            None => add(
                "",
                "no point lies between the creepages of the curve".to_owned(),
            ),
        }
        if self.beyond > 0 && self.off.is_some() {
            let others = format!(
                "{} points lie beyond the creepages of the curve",
                self.beyond
            );
            add("", others);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wear_that_is_not_determined_is_not_shown_as_a_result() {
        let of = |volume_error: f64, half_width| {
            let wear = Wear {
                body: "rail".into(),
                law: "third body".into(),
                volume: 1e-11,
                volume_error,
                depth: 1e-9,
                depth_error: 1e-11,
                profile: Vec::new(),
                half_width,
            };
            wear.text(true, "by the grid")
        };
        let known = "0.01000 mm3 per metre +- 0.00020 by the grid";
        let rest = ", up to 1.000 nm +- 10.00 pm a passage (third body)";
        assert_eq!(of(2e-13, None), format!("{known}{rest}"));
        let seeds = " +- 20 % over the seeds";
        assert_eq!(of(2e-13, Some(0.2)), format!("{known}{seeds}{rest}"));
        let lost = of(2e-13, Some(0.31));
        assert!(lost.starts_with("not determined: 0.01000 mm3"), "{lost}");
        let coarse = of(3e-12, None);
        assert!(
            coarse.starts_with("not determined: 0.01000 mm3"),
            "{coarse}"
        );
    }
}
