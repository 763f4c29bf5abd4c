//! Contacts in which friction and wear are given: a pin on a disc and a pad on a flat.

use super::interface::interface;
use super::{Made, NewCase, Question, comment, q};
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Steps of a turn of the disc, and most steps of a run.
const TURN: (f64, f64) = (200.0, 2e5);
/// Steps of a stroke back and forth.
const CYCLE: f64 = 200.0;
/// Mass over the load (kg/N) of a pin, whose weight is then a hundredth of it.
const MASS: f64 = 1e-3;
/// The law of wear.
const LAW: &str = "volume = K/H times load times slip, H the hardness of each body";

pub(super) fn pin(question: &Question) -> Result<NewCase, String> {
    let tip = question.number("radius", "m")?;
    let track = question.number("track-radius", "m")?;
    let load = question.number("load", "N")?;
    let speed = question.number("speed", "m/s")?;
    let distance = question.number("distance", "m")?;
    let turns = distance / (2.0 * PI * track);
    let end = distance / speed;
    // A step turns by a two hundredth, or by more where the path is long.
    let step = (end / TURN.1)
        .max(2.0 * PI * track / speed / TURN.0)
        .min(end / 200.0);
    let per_turn = 2.0 * PI * track / speed / step;
    if per_turn < 20.0 {
        return Err(format!(
            "distance: {} are {turns:.0} turns, more than a run follows step by step; friction and wear are those of a shorter one, and wear grows with the distance: take {} or less",
            q(distance, "m"),
            q(2.0 * PI * track * TURN.1 / 20.0, "m")
        ));
    }
    let omega = speed / track;
    let mass = MASS * load;
    let mut text = comment(
        0,
        "A pin with a round tip on a disc that turns. Friction and wear coefficients are inputs: this is the bookkeeping of a rig. With --debris the layer between them is computed from its grains.",
    );
    let _ = writeln!(text, "(\n    name: \"a pin on a disc\",\n    dimension: 3,");
    text += &comment(
        4,
        &format!(
            "{per_turn:.0} steps of a turn of {}; {turns:.1} turns are {}",
            q(2.0 * PI * track / speed, "s"),
            q(distance, "m")
        ),
    );
    text += &head(question, step, end, ["pin", "disc"])?;
    text += "    bodies: [\n";
    text += &comment(8, &format!("speed/radius of the track = {omega:.4} 1/s"));
    let _ = writeln!(
        text,
        "        (name: \"disc\", material: \"disc\", shapes: [HalfSpace(normal: [0, 0, 1])], dofs: (rz: Velocity(Constant({omega:.6e})))),"
    );
    text += "        (\n            name: \"pin\",\n            material: \"pin\",\n";
    let _ = writeln!(
        text,
        "            shapes: [Balls([([0, 0, 0], {})])],",
        q(tip, "m")
    );
    text += &comment(12, "on the disc: its middle is a radius above it");
    let _ = writeln!(
        text,
        "            position: [{}, 0, {}],",
        q(track, "m"),
        q(tip, "m")
    );
    text += &comment(12, "of no effect in steady sliding");
    let _ = writeln!(text, "            mass: {},", mass_text(mass));
    let _ = writeln!(
        text,
        "            dofs: (z: Force(Constant({}))),\n        ),\n    ],",
        q(-load, "N")
    );
    text += "    // tangential force along y, in which the disc moves under the pin\n";
    text += "    friction: (body: \"pin\", along: 1, normal: 2),\n    output: (frames: 0, every: 10),\n)\n";
    Ok(NewCase {
        made: Made::Case,
        text,
    })
}

pub(super) fn flat(question: &Question) -> Result<NewCase, String> {
    let area = question.number("area", "m^2")?;
    let load = question.number("load", "N")?;
    let amplitude = question.amplitude()?;
    let frequency = question.number("frequency", "Hz")?;
    let side = area.sqrt();
    let step = 1.0 / frequency / CYCLE;
    let start = 0.2 / frequency;
    let end = start + 3.0 / frequency;
    let omega = 2.0 * PI * frequency;
    let mass = 0.01 * load / (omega * omega * amplitude);
    let mut text = comment(
        0,
        &format!(
            "A flat pad of {} by {} that frets on a flat: a rigid block, under {} on average. Friction and wear coefficients are inputs; in truth its edges carry more, and elastic bodies stick up to some displacement. With --debris the layer between them is computed from its grains.",
            q(side, "m"),
            q(side, "m"),
            q(load / area, "Pa")
        ),
    );
    let _ = writeln!(text, "(\n    name: \"a pad on a flat\",\n    dimension: 3,");
    text += &comment(
        4,
        &format!("{CYCLE:.0} steps of a cycle; a fifth of a cycle to load, then three cycles"),
    );
    text += &head(question, step, end, ["pad", "flat"])?;
    text += "    bodies: [\n        (name: \"flat\", material: \"flat\", shapes: [HalfSpace(normal: [0, 0, 1])]),\n        (\n            name: \"pad\",\n            material: \"pad\",\n";
    let height = q(side / 2.0, "m");
    let _ = writeln!(
        text,
        "            shapes: [Box(size: ({0}, {0}, {height}), at: [0, 0, {1}])],",
        q(side, "m"),
        q(side / 4.0, "m")
    );
    text += &comment(
        12,
        "its inertia at the end of a stroke, m (2 pi f)^2 A, is a hundredth of the load",
    );
    let _ = writeln!(text, "            mass: {},", mass_text(mass));
    let _ = writeln!(
        text,
        "            dofs: (\n                x: Displacement(Sine(amplitude: {}, frequency: {}, start: {})),\n                y: Fixed, z: Force(Constant({})), rx: Fixed, ry: Fixed, rz: Fixed,\n            ),\n        ),\n    ],",
        q(amplitude, "m"),
        q(frequency, "Hz"),
        q(start, "s"),
        q(-load, "N")
    );
    let _ = writeln!(
        text,
        "    friction: (body: \"pad\", along: 0, normal: 2, start: {}),\n    output: (frames: 0),\n)",
        q(start, "s")
    );
    Ok(NewCase {
        made: Made::Case,
        text,
    })
}

/// A mass with its unit in kg, which a case also reads in g.
fn mass_text(mass: f64) -> String {
    format!("{mass:.3e}")
}

/// Time, materials and interface of two bodies.
fn head(question: &Question, step: f64, end: f64, names: [&str; 2]) -> Result<String, String> {
    let [first, second] = question.materials()?;
    let time = format!(
        "    time: (step: {}, end: {}),\n",
        q(step, "s"),
        q(end, "s")
    );
    let materials = format!(
        "    materials: {{\"{}\": \"{first}\", \"{}\": \"{second}\"}},\n",
        names[0], names[1]
    );
    Ok(time + &materials + &interface(question, names, LAW)?)
}
