//! The numbers of a window, each with its formula, and its text.

use super::window::{Local, Motion};
use super::{Question, comment, q, window_laws};
use fretwork_scene::material::Material;
use std::fmt::Write as _;

/// Thickness of the layer once it is compacted, over its height before.
const COMPACTED: f64 = 0.83;
/// Root mean square of the roughness over the size of a grain: smooth walls slip along the layer.
const ROUGHNESS: f64 = 0.2;
/// Inertial number: adds 1.1 times itself to friction (F. da Cruz et al., Phys. Rev. E 72 (2005)
/// 021309).
const INERTIAL: f64 = 5e-3;
/// Slip of a step over the size of a grain, at most; and over it and Young's modulus over the
/// pressure, since grains that are pressed harder lie deeper in the corners of the surfaces.
const SLIP_OF_STEP: [f64; 2] = [4e-3, 1.6e-5];
/// Steps in which the layer is compacted.
const COMPACTION: f64 = 1000.0;
/// Most steps of a window.
const MOST_STEPS: f64 = 1e6;

/// Everything that is computed for the window.
pub(super) struct Numbers {
    /// Size of a grain (m).
    pub d: f64,
    /// Length of the window (m).
    length: f64,
    /// Height of the layer before it is compacted (m).
    height: f64,
    /// Load (N/m).
    load: f64,
    scaling: f64,
    /// Slip of a step (m).
    slip: f64,
    step: f64,
    /// Begin of the motion, end of the run (s).
    pub start: f64,
    end: f64,
    mass: f64,
}

impl Numbers {
    pub(super) fn of(
        local: &Local,
        material: &Material,
        d: f64,
        rows: f64,
        columns: f64,
    ) -> Result<Self, String> {
        let density = material.density().map_err(|e| e.message.clone())?;
        let (length, height) = (columns * d, rows * d);
        let velocity = local.motion.velocity();
        let compacted = COMPACTED * height;
        let scaling = (INERTIAL * compacted / (velocity * d)).powi(2) * local.pressure / density;
        let young = material.properties.get("young");
        let young = young.and_then(|e| e.in_unit("Pa").ok()).ok_or(
            "debris: its material has no `young`, which elastic contacts need: add it to the file, or take another",
        )?;
        let slip = d * SLIP_OF_STEP[0].min(SLIP_OF_STEP[1] * young / local.pressure);
        let step = slip / velocity;
        let start = COMPACTION * step;
        let duration = match local.motion {
            Motion::Stroke {
                frequency, cycles, ..
            } => cycles / frequency,
            Motion::OneWay { path, speed } => path / speed,
        };
        if duration / step > MOST_STEPS {
            return Err(format!(
                "debris-size: the motion is {:.0} steps in which grains of {} slip by {} each: take fewer cycles, a smaller amplitude or larger grains",
                duration / step,
                q(d, "m"),
                q(slip, "m")
            ));
        }
        Ok(Self {
            d,
            length,
            height,
            load: local.pressure * length,
            scaling,
            slip,
            step,
            start,
            end: start + duration,
            mass: 0.28 * density * scaling * length * compacted,
        })
    }

    pub(super) fn text(
        &self,
        question: &Question,
        local: &Local,
        material: &Material,
        [upper, lower, debris]: [&str; 3],
    ) -> Result<String, String> {
        let d = self.d;
        let mut text = comment(
            0,
            &format!(
                "A window of the contact of {}: {} of debris of {} between rough surfaces, under {}. Periodic along the motion: what leaves on one side enters on the other.",
                question.geometry.about(),
                q(self.height, "m"),
                q(d, "m"),
                q(local.pressure, "Pa")
            ),
        );
        for why in &local.why {
            text += "//\n";
            text += &comment(0, why);
        }
        text += "//\n";
        text += &comment(
            0,
            "What to vary before a number is quoted: docs/build_your_case.md, section 9; `fretwork study run FILE --seeds 4` for the scatter of samples.",
        );
        let _ = writeln!(
            text,
            "(\n    name: \"a layer of {debris} in the contact of {}\",\n    dimension: 2,\n    seed: 1,",
            question.geometry.about()
        );
        text += &comment(
            4,
            &format!(
                "step: at {} the surfaces slip by {}, the smaller of 0.004 d and 1.6e-5 d E/p with E of the debris; the layer is compacted in {COMPACTION} steps",
                q(local.motion.velocity(), "m/s"),
                q(self.slip, "m")
            ),
        );
        let _ = writeln!(
            text,
            "    time: (step: {}, end: {}, theta: 0.5),",
            q(self.step, "s"),
            q(self.end, "s")
        );
        text += &comment(
            4,
            &format!(
                "densities times (I h/(v d))^2 P/rho: the inertial number I = v d/h sqrt(rho/P) is {INERTIAL:e}, which adds 1.1 I = {:.4} to friction (F. da Cruz et al., Phys. Rev. E 72 (2005) 021309); h is the compacted layer, {} of its height here",
                1.1 * INERTIAL,
                COMPACTED
            ),
        );
        let _ = writeln!(text, "    inertia_scaling: {:.3e},", self.scaling);
        let _ = writeln!(text, "    periodic: (x: {}),", q(self.length, "m"));
        text += &comment(4, "contacts are looked for within a twentieth of a grain");
        let _ = writeln!(
            text,
            "    detection: (alert: {}, skin: {}),",
            q(0.05 * d, "m"),
            q(0.125 * d, "m")
        );
        text += &comment(
            4,
            "elastic contacts: the heat of the residuals of a step is below a half of that of slip, which is right to 1 % of friction",
        );
        text += "    solver: (norm: Power, tolerance: 0.5, max_iterations: 20000),\n";
        let _ = writeln!(
            text,
            "    materials: {{\"debris\": \"{debris}\", \"upper\": \"{upper}\", \"lower\": \"{lower}\"}},"
        );
        text += &window_laws::interfaces(self, question, material)?;
        text += "    bodies: [\n";
        let rough = |side: &str| {
            format!(
                "RoughProfile(points: {:.0}, rms: {}, hurst: 0.8, longest: {}, shortest: {}, height: 0.0, side: {side})",
                (8.0 * self.length / d).round(),
                q(ROUGHNESS * d, "m"),
                q(self.length / 4.0, "m"),
                q(1.5 * d, "m")
            )
        };
        text += &comment(
            8,
            "roughness of a fifth of a grain, of waves from one and a half grains to a quarter of the window: smooth surfaces slip along the layer",
        );
        let _ = writeln!(
            text,
            "        (name: \"lower\", material: \"lower\", shapes: [{}]),",
            rough("Below")
        );
        let margin = 4.0 * ROUGHNESS * d;
        let _ = writeln!(
            text,
            "        (\n            name: \"upper\",\n            material: \"upper\",\n            shapes: [{}],",
            rough("Above")
        );
        let _ = writeln!(
            text,
            "            position: [0, {}],",
            q(self.height + 2.0 * margin, "m")
        );
        text += &comment(
            12,
            "about a quarter of the mass of the layer, so that it follows it",
        );
        let _ = writeln!(
            text,
            "            mass: {:.4e},\n            dofs: (",
            self.mass
        );
        match local.motion {
            Motion::Stroke {
                amplitude,
                frequency,
                ..
            } => {
                let _ = writeln!(
                    text,
                    "                x: Displacement(Sine(amplitude: {}, frequency: {}, start: {})),",
                    q(amplitude, "m"),
                    q(frequency, "Hz"),
                    q(self.start, "s")
                );
            }
            Motion::OneWay { path, .. } => {
                let _ = writeln!(
                    text,
                    "                x: Displacement(Ramp(from: 0.0, to: {}, start: {}, end: {})),",
                    q(path, "m"),
                    q(self.start, "s"),
                    q(self.end, "s")
                );
            }
        }
        text += &comment(
            16,
            &format!(
                "half of a per cent of the load while the grains come together, then {} times the window",
                q(local.pressure, "Pa")
            ),
        );
        let small = q(-0.005 * self.load, "N/m");
        let _ = writeln!(
            text,
            "                y: Force(Table([(0 s, {small}), ({}, {small}), ({}, {})])),\n                rz: Fixed,\n            ),\n        ),\n    ],",
            q(0.2 * self.start, "s"),
            q(0.88 * self.start, "s"),
            q(-self.load, "N/m")
        );
        text += "    grains: [\n";
        text += &comment(
            8,
            "angular, as debris is: disks roll on each other. They begin four times the roughness away from the mean heights of the surfaces",
        );
        let _ = writeln!(
            text,
            "        Voronoi(material: \"debris\", size: {}, low: [0, {}], high: [{}, {}], gap: {}),\n    ],",
            q(d, "m"),
            q(margin, "m"),
            q(self.length, "m"),
            q(margin + self.height, "m"),
            q(0.025 * d, "m")
        );
        let from = match local.motion {
            Motion::Stroke { .. } => self.start,
            Motion::OneWay { .. } => self.start + 0.2 * (self.end - self.start),
        };
        let _ = writeln!(
            text,
            "    friction: (body: \"upper\", along: 0, normal: 1, start: {}),",
            q(from, "s")
        );
        text += "    // profiles from one surface to the other, flow, dissipation: docs/third_body.md\n";
        let _ = writeln!(
            text,
            "    measures: [\n        ThirdBody(name: \"layer\", between: (\"lower\", \"upper\"), along: 0, across: 1, slices: 3, every: 40, start: {}),\n    ],",
            q(from, "s")
        );
        text += "    output: (frames: 4, views: 12, every: 8),\n)\n";
        Ok(text)
    }
}
