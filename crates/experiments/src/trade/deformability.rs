//! The preset `deformability`: forms of one case that differ in which bodies deform, from rigid
//! contacts to grains of finite elements.
//!
//! A level is a list of `--set` arguments. Numbers that a form needs come from the scene: `mu` of
//! its contact laws, properties of its materials. A form whose numbers the scene does not have is
//! left out.

use super::variant::field;
use super::varied::{ParameterEffect, Varied};
use crate::Error;
use crate::factor::Level;
use fretwork_core::bodies::Dof;
use fretwork_core::solve::error::Norm;
use fretwork_scene::Built;
use fretwork_scene::case::{
    BodySpec, Case, DofSpec, HalfSpaceProfile, HalfSpaceSpec, InterfaceSpec,
};
use fretwork_scene::case::{ShapeSpec, Side};
use fretwork_scene::material::Material;
use fretwork_scene::source::Source;
use std::collections::BTreeMap;

/// Restitution of a compliant contact that replaces a rigid law without restitution: nearly
/// critical damping (docs/compliant.md).
const RESTITUTION: f64 = 0.1;

/// Position correction of rigid contacts that replace springs: springs do not sink, rigid contacts
/// do, by the tolerance of each step.
const CORRECTION: f64 = 0.05;

/// Properties of a scene from which its forms are made.
#[derive(Debug)]
pub struct Deformability {
    /// The contact laws, in the order of the interfaces.
    contacts: Vec<ContactLaw>,
    /// Materials of the grains that are rigid bodies.
    grains: Vec<Grains>,
    /// Norm of the error of a step.
    norm: Norm,
}

/// A contact law with its parameters in its own units.
#[derive(Debug)]
struct ContactLaw {
    law: String,
    compliant: bool,
    values: BTreeMap<String, f64>,
}

/// The grains of a material.
#[derive(Debug)]
struct Grains {
    material: String,
    /// Time in which a wave crosses a grain of the mean radius (s), or the missing properties.
    crossing: Result<f64, String>,
}

impl Deformability {
    /// Reads the properties from a built scene.
    pub fn of(case: &Case, built: &Built) -> Self {
        let s = &built.simulation;
        let contacts = s.laws().iter().map(|interface| {
            let law = interface.contact();
            let names = law.plugin.parameters.iter().map(|p| p.name.clone());
            ContactLaw {
                law: law.plugin.name.clone(),
                compliant: interface.compliant(),
                values: names.zip(law.parameters.iter().copied()).collect(),
            }
        });
        let mut is_grain = vec![false; s.bodies().len()];
        s.grains().into_iter().for_each(|b| is_grain[b] = true);
        let balls = s.balls().into_iter();
        let balls = balls.map(|b| (b.body, b.material, b.radius));
        let pieces = s.pieces().into_iter();
        let pieces = pieces.map(|p| (p.body, p.material, p.size));
        // These are the sum of the radii and their number, by material.
        let mut radii: BTreeMap<u16, (f64, f64)> = BTreeMap::new();
        for (_, material, radius) in balls.chain(pieces).filter(|x| is_grain[x.0 as usize]) {
            let sum = radii.entry(material).or_default();
            *sum = (sum.0 + radius, sum.1 + 1.0);
        }
        let grains = radii.into_iter().filter_map(|(material, (sum, count))| {
            let k = usize::from(material);
            let (name, file) = case.materials.iter().nth(k)?;
            let text = built.materials.iter().find(|m| m.0 == *file);
            let density = built.densities.get(k).copied()?;
            let crossing = young(text.map_or("", |t| &t.1), name)
                .map(|young| sum / count * (density / young).sqrt());
            Some(Grains {
                material: name.clone(),
                crossing,
            })
        });
        Self {
            contacts: contacts.collect(),
            grains: grains.collect(),
            norm: s.options().solver.norm,
        }
    }

    fn contact(&self, k: usize) -> Option<&ContactLaw> {
        self.contacts.get(k)
    }
}

/// Returns Young's modulus from the text of a material's file, which must have Poisson's ratio too;
/// or the missing properties.
fn young(text: &str, name: &str) -> Result<f64, String> {
    let material: Material = Source::from_text(name, text)
        .parse()
        .map_err(|e| e.in_a_sentence())?;
    let property = |property: &str, unit: &str| {
        let known = material.properties.get(property);
        let value = known.and_then(|p| p.in_unit(unit).ok());
        value.ok_or_else(|| format!("the file of the material `{name}` has no `{property}`"))
    };
    property("poisson", "")?;
    property("young", "Pa")
}

/// Returns the forms of a case from the one with the fewest assumptions to rigid contacts; the
/// first is the reference, since the others neglect some of its effects.
///
/// # Errors
/// There is one form only; the sentence gives the reason.
pub fn forms(case: &Case, scene: &Deformability) -> Result<Varied, String> {
    let bodies_deform = !case.half_spaces.is_empty() || !case.elastic.is_empty();
    let springs = scene.contacts.iter().any(|c| c.compliant);
    let first_bodies = if case.elastic.is_empty() {
        "half-spaces"
    } else {
        "elements"
    };
    let own = match (case.elastic_grains.is_empty(), bodies_deform, springs) {
        (false, ..) => "grains",
        (true, true, _) => first_bodies,
        (true, false, true) => "compliant",
        (true, false, false) => "rigid",
    };
    let mut forms = vec![("grains", deforming_grains(case, scene))];
    if bodies_deform {
        forms.push((first_bodies, Ok(rigid_grains(case))));
    } else if !case.bodies.is_empty() {
        let why = "the case has neither cells nor a depth for its first bodies; write it with `half_spaces` and compare the two with --variant";
        forms.push(("half-spaces", Err(why.to_owned())));
    }
    let rigid_bodies = rigid_first_bodies(case);
    let below = |contacts: Result<Vec<String>, String>| {
        Ok([rigid_bodies.clone()?, rigid_grains(case), contacts?].concat())
    };
    let every: Vec<usize> = (0..case.interfaces.len()).collect();
    forms.push(("compliant", below(compliant_contacts(case, scene))));
    forms.push(("rigid", below(rigid_contacts(case, scene, &every, true))));
    let mut parameter = Varied::new("deformability", ParameterEffect::Form, Vec::new(), Some(0));
    for (label, form) in forms {
        let sets = match form {
            _ if label == own => {
                parameter.own = parameter.levels.len();
                Vec::new()
            }
            Ok(sets) => sets,
            Err(why) => {
                parameter.left_out.push((label.to_owned(), why));
                continue;
            }
        };
        parameter.levels.push(Level::named(label, sets));
    }
    several(&parameter)?;
    Ok(parameter)
}

/// Checks that there is something to compare.
fn several(parameter: &Varied) -> Result<(), String> {
    if parameter.levels.len() > 1 {
        return Ok(());
    }
    let own = parameter.levels.first().map_or("none", |l| &l.label);
    let why = parameter.left_out.iter();
    let why: Vec<String> = why.map(|(l, why)| format!("{l}: {why}")).collect();
    Err(format!(
        "the case has no other form than its own, {own}; not offered are {}",
        why.join("; ")
    ))
}

/// Removes the levels whose case is refused, and records the reason.
///
/// # Errors
/// No level is left except the case's own.
pub fn keep_accepted(
    parameter: &mut Varied,
    accept: impl Fn(&[String]) -> Result<(), String>,
) -> Result<(), Error> {
    let own = parameter.levels.get(parameter.own).cloned();
    for level in std::mem::take(&mut parameter.levels) {
        match accept(&level.sets) {
            Err(why) if Some(&level) != own.as_ref() => {
                parameter.left_out.push((level.label, why));
            }
            _ => parameter.levels.push(level),
        }
    }
    let place = parameter
        .levels
        .iter()
        .position(|l| Some(l) == own.as_ref());
    parameter.own = place.unwrap_or(0);
    several(parameter).map_err(|why| Error::Usage(format!("--setting deformability: {why}")))
}

/// Returns the path of an interface in the case, for `--set`.
fn place(k: usize, spec: &InterfaceSpec) -> String {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let plain = spec.name.chars().all(word) && spec.name.parse::<u64>().is_err();
    match plain && !spec.name.is_empty() {
        true => format!("interfaces.{}", spec.name),
        false => format!("interfaces.{k}"),
    }
}

/// Replaces the contact law and its parameters in an interface.
fn contact(k: usize, spec: &InterfaceSpec, law: &str, values: &[(&str, f64)]) -> Vec<String> {
    let at = place(k, spec);
    let values: Vec<String> = values
        .iter()
        .map(|(n, x)| format!("\"{n}\": {x}"))
        .collect();
    vec![
        format!("{at}.contact={law}"),
        format!("{at}.parameters.contact={{{}}}", values.join(", ")),
    ]
}

/// Replaces springs by rigid contacts in some interfaces.
fn rigid_contacts(
    case: &Case,
    scene: &Deformability,
    at: &[usize],
    correct: bool,
) -> Result<Vec<String>, String> {
    let mut sets = Vec::new();
    for &k in at {
        let (spec, known) = (&case.interfaces[k], scene.contact(k));
        let Some(spring) = known.filter(|c| c.compliant) else {
            continue;
        };
        let mu = spring.values.get("mu");
        let (Some(mu), "hertz-mindlin" | "linear-contact") = (mu, spring.law.as_str()) else {
            return Err(format!(
                "the compliant law `{}` of the interface `{}` has no rigid form",
                spring.law, spec.name
            ));
        };
        sets.extend(contact(k, spec, "coulomb", &[("mu", *mu)]));
    }
    if sets.is_empty() {
        return Ok(sets);
    }
    // Energy over the heat of slip is a measure for springs; rigid contacts are tested by their
    // balance.
    if scene.norm == Norm::Power {
        if case.solver.norm.is_some() {
            sets.push("solver.norm=Balance".to_owned());
        }
        if case.solver.tolerance.is_some() {
            let tolerance = Norm::Balance.default_tolerance();
            sets.push(format!("solver.tolerance={tolerance:e}"));
        }
    }
    if correct && case.solver.correction == 0.0 && case.solver.projection == 0.0 {
        sets.push(format!("solver.correction={CORRECTION}"));
    }
    Ok(sets)
}

/// Replaces rigid contacts by springs with the materials' moduli.
fn compliant_contacts(case: &Case, scene: &Deformability) -> Result<Vec<String>, String> {
    let mut sets = Vec::new();
    for (k, spec) in case.interfaces.iter().enumerate() {
        let Some(rigid) = scene.contact(k).filter(|c| !c.compliant) else {
            continue;
        };
        let value = |name: &str| rigid.values.get(name).copied();
        let (mu, restitution) = match rigid.law.as_str() {
            "coulomb" => (value("mu"), Some(RESTITUTION)),
            "newton-restitution" => (value("mu"), value("e_n")),
            "frictionless" => (Some(0.0), Some(RESTITUTION)),
            _ => (None, None),
        };
        let (Some(mu), Some(restitution)) = (mu, restitution) else {
            return Err(format!(
                "compliant contacts have Coulomb friction, which replaces `coulomb`, `newton-restitution` and `frictionless`, not `{}` of the interface `{}`",
                rigid.law, spec.name
            ));
        };
        let values = [("mu", mu), ("restitution", restitution)];
        sets.extend(contact(k, spec, "hertz-mindlin", &values));
    }
    Ok(sets)
}

/// Replaces rigid grains by deformable ones with rigid contacts: the elasticity of a grain is then
/// that of its elements, and a spring at its contacts would count it twice.
fn deforming_grains(case: &Case, scene: &Deformability) -> Result<Vec<String>, String> {
    let soft = scene
        .grains
        .iter()
        .filter_map(|g| Some((g, g.crossing.as_ref().ok()?)));
    let soft: Vec<(&Grains, &f64)> = soft.collect();
    if soft.is_empty() {
        let lacks = scene.grains.iter().find_map(|g| g.crossing.as_ref().err());
        return Err(match lacks {
            Some(why) => format!("{why}, which grains that deform need"),
            None => "the case has no grains".to_owned(),
        });
    }
    let specs: Vec<String> = soft
        .iter()
        .map(|(g, crossing)| {
            format!(
                "(material: {:?}, damping: (mass: 0.0, stiffness: {crossing:.2e}))",
                g.material
            )
        })
        .collect();
    let of_soft = |k: &usize| {
        let (a, b) = &case.interfaces[*k].between;
        soft.iter()
            .any(|(g, _)| g.material == *a || g.material == *b)
    };
    let at: Vec<usize> = (0..case.interfaces.len()).filter(of_soft).collect();
    let mut sets = rigid_contacts(case, scene, &at, false)?;
    sets.push(format!("elastic_grains=[{}]", specs.join(", ")));
    Ok(sets)
}

/// Replaces deformable grains by rigid ones.
fn rigid_grains(case: &Case) -> Vec<String> {
    match case.elastic_grains.is_empty() {
        true => Vec::new(),
        false => vec!["elastic_grains=[]".to_owned()],
    }
}

/// Replaces half-spaces by rigid first bodies, which is exact for planes.
fn rigid_first_bodies(case: &Case) -> Result<Vec<String>, String> {
    if let Some(body) = case.elastic.first() {
        return Err(format!(
            "the body `{}` is one of finite elements, whose edges a rigid plane does not have; write the case with a rigid body and compare the two with --variant",
            body.name
        ));
    }
    if case.half_spaces.is_empty() {
        return Ok(Vec::new());
    }
    if case.grains.is_empty() {
        return Err("rigid planes have no points of contact with each other, and the case has no grains between its half-spaces".to_owned());
    }
    let mut rigid = case.clone();
    for half_space in &case.half_spaces {
        rigid.bodies.push(plane(half_space, case.dimension)?);
    }
    let text = rigid.to_ron().map_err(|e| e.in_a_sentence())?;
    let bodies = field(&text, "bodies").unwrap_or_default();
    Ok(vec!["half_spaces=[]".into(), format!("bodies={bodies}")])
}

/// The rigid body of a half-space whose surface is a plane.
fn plane(half_space: &HalfSpaceSpec, dimension: u32) -> Result<BodySpec, String> {
    let why = match half_space {
        h if h.profile != HalfSpaceProfile::Flat => "is not flat",
        h if h.rolling.is_some() => "rolls",
        h if h.wears.is_some() => "recedes as it wears",
        _ => "",
    };
    if !why.is_empty() {
        return Err(format!(
            "the half-space `{}` {why}, and only a flat one at rest has the form of a rigid plane; write the case with a rigid body and compare the two with --variant",
            half_space.name
        ));
    }
    let up = match half_space.side {
        Side::Below => 1.0,
        Side::Above => -1.0,
    };
    let mut normal = vec![0.0; dimension as usize];
    if let Some(last) = normal.last_mut() {
        *last = up;
    }
    let dof = |dof: &Option<Dof>| dof.clone().unwrap_or(Dof::Fixed);
    Ok(BodySpec {
        name: half_space.name.clone(),
        material: half_space.material.clone(),
        shapes: vec![ShapeSpec::HalfSpace {
            normal,
            at: Vec::new(),
        }],
        position: half_space.position.clone(),
        mass: (half_space.mass > 0.0).then_some(half_space.mass),
        inertia: None,
        vanishes: None,
        wears: None,
        dofs: DofSpec {
            x: dof(&half_space.dofs.x),
            y: dof(&half_space.dofs.y),
            z: dof(&half_space.dofs.z),
            ..DofSpec::default()
        },
    })
}
