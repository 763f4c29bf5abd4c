//! The laws of the interfaces of a window.

use super::window_numbers::Numbers;
use super::{Question, comment, q};
use fretwork_scene::material::Material;
use std::fmt::Write as _;

/// Laws between grains, and between grains and surfaces: those of the material's file, else
/// friction alone.
pub(super) fn interfaces(
    numbers: &Numbers,
    question: &Question,
    material: &Material,
) -> Result<String, String> {
    let d = numbers.d;
    let laws = material.laws.as_ref();
    let has = |kind: &str, law: &str| {
        laws.is_some_and(|laws| {
            let mut kinds = laws.slots.iter();
            kinds.any(|(slot, of)| slot.word() == kind && of.contains_key(law))
        })
    };
    let own = has("contact", "hertz-mindlin") && question.given("friction").is_none();
    let bonds = own && has("cohesion", "mac") && has("damage", "mac");
    let wear = match question.wear()? {
        Some(given) => Some(given),
        None if own && has("wear", "archard") => Some("{}".to_owned()),
        None => None,
    };
    let contact = match own {
        true => "{}".to_owned(),
        false => format!("{{\"mu\": {}, \"restitution\": 0.1}}", question.friction()?),
    };
    let mut text = String::from("    interfaces: [\n");
    text += &comment(
        8,
        match (own, question.given("friction").is_some()) {
            (true, _) => {
                "parameters of the laws from the file of the debris, which names their sources"
            }
            (false, true) => {
                "grains without cohesion; friction between them, and with the surfaces, as given"
            }
            (false, false) => {
                "not given, and chosen: grains without cohesion, whose friction decides that of the layer: `fretwork study` over it says how much"
            }
        },
    );
    for (name, first) in [
        ("layer", "debris"),
        ("upper_wall", "upper"),
        ("lower_wall", "lower"),
    ] {
        let _ = write!(
            text,
            "        (\n            name: \"{name}\",\n            between: (\"{first}\", \"debris\"),\n"
        );
        if own {
            text += "            parameters_from: \"debris\",\n";
        }
        text += "            contact: \"hertz-mindlin\",\n";
        let mut parameters = format!("contact: {contact}");
        if bonds {
            text += "            cohesion: \"mac\",\n            damage: \"mac\",\n";
            parameters += ", cohesion: {}, damage: {}";
        }
        if let Some(wear) = wear.as_ref().filter(|_| name != "layer") {
            text += "            wear: \"archard\",\n";
            let _ = write!(parameters, ", wear: {wear}");
        }
        let _ = writeln!(text, "            parameters: ({parameters}),");
        if bonds {
            if name == "layer" {
                text += &comment(
                    12,
                    "bonds between neighbours within a twentieth of a grain, after the compaction",
                );
            }
            let _ = writeln!(
                text,
                "            bonds: At({}),\n            bonds_within: {},",
                q(0.96 * numbers.start, "s"),
                q(0.05 * d, "m")
            );
        }
        text += "        ),\n";
    }
    text += "    ],\n";
    Ok(text)
}
