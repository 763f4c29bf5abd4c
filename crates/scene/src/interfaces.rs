//! Interface laws of a case: finds the plugins, resolves and checks their parameters.

use super::case::{Case, InterfaceSpec};
use super::law_table::{self, Tables};
use super::law_values::{
    GivenNumber, InterfaceError, Sides, friction_of, given_numbers, parameter_value,
    properties_of_sides, wear_from_hardness,
};
use super::material::{InterfaceParameters, Material, MaterialLibrary, Sourced};
use super::source::{InputError, Source, ValidationError, nearest};
use super::wear_coefficient::WearCoefficient;
use fretwork_abi::{FLAG_2D_ONLY, FLAG_3D_ONLY};
use fretwork_core::contact::detect::LawTable;
use fretwork_core::laws::{
    AreaRule, BondRule, Interface, Kind, LawError, LoadedLaw, ParameterOrigin, Plugin, SearchPath,
};
use fretwork_core::view::RunView;
use std::collections::{BTreeMap, BTreeSet};

/// The interfaces of a case, and the materials they govern.
pub struct Laws {
    /// Interfaces, in the order of the case.
    pub interfaces: Vec<Interface>,
    /// Interface by pair of materials, in the order of the case's map.
    pub table: LawTable,
    /// Name and text of the parameter files that were read.
    pub files: Vec<(String, String)>,
    /// Wear coefficients that follow from the hardness of materials.
    pub wear_coefficients: Vec<WearCoefficient>,
}

/// Builds the interfaces.
///
/// # Errors
/// Fails for unknown names, values out of range and laws that do not fit their slot, each at its
/// place in the case.
pub fn build(
    case: &Case,
    source: &Source,
    library: &MaterialLibrary,
    properties: &[BTreeMap<String, Sourced>],
    path: &SearchPath,
) -> Result<Laws, InputError> {
    let materials: Vec<&String> = case.materials.keys().collect();
    let mut out = Laws {
        interfaces: Vec::new(),
        table: LawTable::new(materials.len()),
        files: Vec::new(),
        wear_coefficients: Vec::new(),
    };
    check_pins(case).map_err(|f| source.locate(f))?;
    let wanted = case.interfaces.iter().flat_map(laws_of);
    path.test_loading(wanted.map(|(kind, name)| {
        let pin = case.pins.get(&format!("{kind}/{name}"));
        (kind, name, pin.map(String::as_str))
    }));
    for (k, spec) in case.interfaces.iter().enumerate() {
        let here = format!("interfaces.{k}");
        let at = |f: ValidationError| source.locate(f.under(&here));
        if case.interfaces[..k].iter().any(|i| i.name == spec.name) {
            let message = format!(
                "two interfaces are named `{}`; give them different names, since phases and `--set` refer to them by name",
                spec.name
            );
            return Err(at(ValidationError::new("name", message)));
        }
        let pair = material_pair(spec, &materials).map_err(at)?;
        if out.table.get(pair[0], pair[1]).is_some() {
            return Err(at(ValidationError::new(
                "between",
                "this pair of materials has an interface already",
            )));
        }
        let alert = case.detection.alert;
        if let Some(within) = spec.bonds_within
            && !(within.is_finite() && within >= 0.0 && alert.is_none_or(|a| within <= a))
        {
            let message = format!("{within:e} m must be a gap between 0 and the alert distance");
            return Err(at(ValidationError::new("bonds_within", message).expected(
                "at most `detection.alert`, beyond which no contact is known, or a larger `alert`",
            )));
        }
        if spec.healing.is_some_and(|t| !(t.is_finite() && t >= 0.0)) {
            return Err(at(ValidationError::new(
                "healing",
                "must be a time, not negative",
            )));
        }
        if !(spec.area_factor.is_finite() && spec.area_factor > 0.0) {
            return Err(at(ValidationError::new("area_factor", "must be positive")));
        }
        let from = FromFile::read(spec, case, library, &mut out.files, (source, &here))?;
        let sides = pair.map(|m| &properties[usize::from(m)]);
        let derived = &mut out.wear_coefficients;
        let tables = law_table::of_interface(spec, source, &here)?;
        let given = (&from.parameters, &tables);
        let built = build_interface(case, spec, given, &sides, path, derived);
        let interface = built.map_err(|error| match error.in_file {
            true => match from.locate(error.fault.clone()) {
                Some(located) => located,
                None => at(error.fault),
            },
            false => at(error.fault),
        })?;
        out.table.set(pair[0], pair[1], k as u16);
        out.interfaces.push(interface);
    }
    Ok(out)
}

/// Returns the indices of the two materials of an interface.
fn material_pair(spec: &InterfaceSpec, materials: &[&String]) -> Result<[u16; 2], ValidationError> {
    let mut pair = [0u16; 2];
    for (side, name) in [&spec.between.0, &spec.between.1].into_iter().enumerate() {
        let found = materials.iter().position(|m| *m == name).ok_or_else(|| {
            let names = || materials.iter().map(|m| m.as_str());
            ValidationError::new(
                format!("between.{side}"),
                format!("the case has no material `{name}`"),
            )
            .expected(format!("one of {}", names().collect::<Vec<_>>().join(", ")))
            .nearest(nearest(name, names()))
        })?;
        pair[side] = found as u16;
    }
    Ok(pair)
}

/// Iterates over kind and name of the laws of an interface.
fn laws_of(spec: &InterfaceSpec) -> impl Iterator<Item = (Kind, &str)> {
    spec.laws.iter().map(|(kind, name)| (kind, name.as_str()))
}

/// Number of pairs of materials without an interface up to which they are listed one by one.
const LISTED: usize = 50;

/// Returns the pairs of materials in the scene without an interface: their bodies pass through each
/// other.
pub fn without_interface(case: &Case, s: &dyn RunView) -> Vec<String> {
    let materials: Vec<&String> = case.materials.keys().collect();
    let mut bodies = vec![BTreeSet::new(); materials.len()];
    let balls = s.balls().into_iter().map(|b| (b.material, b.body));
    let pieces = s.pieces().into_iter().map(|p| (p.material, p.body));
    let surfaces = s.surfaces().into_iter().map(|f| (f.material, f.body));
    for (material, body) in balls.chain(pieces).chain(surfaces) {
        let of = &mut bodies[usize::from(material)];
        // A contact within a material needs two bodies of it.
        if of.len() < 2 {
            of.insert(body);
        }
    }
    let used: Vec<usize> = (0..materials.len())
        .filter(|k| !bodies[*k].is_empty())
        .collect();
    let (mut out, mut more) = (Vec::new(), 0usize);
    for (k, a) in used.iter().enumerate() {
        for b in &used[k..] {
            let can_touch = a != b || bodies[*a].len() > 1;
            if !can_touch || s.table().get(*a as u16, *b as u16).is_some() {
                continue;
            }
            if out.len() == LISTED {
                more += 1;
                continue;
            }
            out.push(format!(
                "{} and {}: they pass through each other",
                materials[*a], materials[*b]
            ));
        }
    }
    if more > 0 {
        out.push(format!(
            "{more} more pairs of materials: they pass through each other"
        ));
    }
    out
}

/// Rejects pins that are malformed, or for laws that the case does not use.
fn check_pins(case: &Case) -> Result<(), ValidationError> {
    let wanted = case.interfaces.iter().flat_map(laws_of);
    let used: Vec<String> = wanted
        .map(|(kind, name)| format!("{kind}/{name}"))
        .collect();
    for (law, pin) in &case.pins {
        let path = format!("pins.{law}");
        if !used.contains(law) {
            let message = format!("no interface uses the law `{law}` that is pinned");
            return Err(ValidationError::new(path, message)
                .expected(format!("one of {}", used.join(", ")))
                .nearest(nearest(law, used.iter().map(String::as_str))));
        }
        if pin.len() != 64 || !pin.chars().all(|c| c.is_ascii_hexdigit()) {
            let message = format!("a pin is a SHA-256 of 64 hexadecimal digits, got `{pin}`");
            return Err(ValidationError::new(path, message)
                .expected("the sha256 that `fretwork law show` prints"));
        }
    }
    Ok(())
}

/// Parameters of laws from a file.
#[derive(Default)]
struct FromFile {
    parameters: InterfaceParameters,
    /// File, and path of the parameters in it.
    place: Option<(Source, &'static str)>,
}

impl FromFile {
    /// Reads `parameters_from` of an interface: a material of the case whose file has laws, or a
    /// file of parameters.
    fn read(
        spec: &InterfaceSpec,
        case: &Case,
        library: &MaterialLibrary,
        files: &mut Vec<(String, String)>,
        (source, here): (&Source, &str),
    ) -> Result<Self, InputError> {
        let Some(name) = &spec.parameters_from else {
            return Ok(Self::default());
        };
        let path = format!("{here}.parameters_from");
        let at = |f: ValidationError| source.locate(f.under(here));
        let from = case.materials.get(name).unwrap_or(name);
        let file = library.read(from).map_err(|e| match e {
            Err(error) => source.named_at(&path, error),
            Ok(missing) => at(ValidationError::new(
                "parameters_from",
                format!("there is no file `{from}.ron` in {}", missing.searched),
            )
            .expected(format!("one of {}", missing.available))
            .nearest(missing.nearest.as_deref())),
        })?;
        if case.materials.contains_key(name) {
            let place = "laws";
            let Some(parameters) = file.parse::<Material>()?.laws else {
                return Err(at(ValidationError::new(
                    "parameters_from",
                    format!("the file `{from}.ron` of the material `{name}` has no `laws`"),
                )
                .expected("`laws: (...)` there, or the name of a file of parameters")));
            };
            parameters
                .units()
                .map_err(|fault| file.locate(fault.under(place)))?;
            return Ok(Self {
                parameters,
                place: Some((file, place)),
            });
        }
        if file.parse::<Material>().is_ok() {
            let names: Vec<&str> = case.materials.keys().map(String::as_str).collect();
            return Err(at(ValidationError::new(
                "parameters_from",
                format!("`{from}.ron` is the file of a material, not of parameters"),
            )
            .expected(format!(
                "a material by its name in the case ({}), or a file of parameters",
                names.join(", ")
            ))));
        }
        let parameters: InterfaceParameters = file.parse()?;
        parameters.units().map_err(|fault| file.locate(fault))?;
        if !files.iter().any(|f| f.0 == *name) {
            files.push((name.clone(), file.text().to_owned()));
        }
        Ok(Self {
            parameters,
            place: Some((file, "")),
        })
    }

    /// Returns the location of an error in these parameters.
    fn locate(&self, fault: ValidationError) -> Option<InputError> {
        let (file, place) = self.place.as_ref()?;
        Some(match *place {
            "" => file.locate(fault),
            place => file.locate(fault.under(place)),
        })
    }
}

fn build_interface(
    case: &Case,
    spec: &InterfaceSpec,
    (file, tables): (&InterfaceParameters, &Tables),
    sides: &Sides<'_>,
    path: &SearchPath,
    derived: &mut Vec<WearCoefficient>,
) -> Result<Interface, InterfaceError> {
    if let BondRule::At(time) = spec.bonds
        && !(time.is_finite() && time >= 0.0)
    {
        return Err(ValidationError::new(
            "bonds",
            "the time at which bonds are made must not be negative",
        )
        .into());
    }
    for (slot, given) in spec.parameters.iter() {
        if let (None, Some(name)) = (spec.law(slot), given.keys().next()) {
            let fault = ValidationError::new(
                format!("parameters.{slot}.{name}"),
                format!("`{name}` is a parameter of the {slot} law, and there is no {slot} law"),
            );
            return Err(fault
                .expected(format!(
                    "`{slot}: \"NAME\"` in the interface, or no `{name}`"
                ))
                .into());
        }
    }
    let none = BTreeMap::new();
    let mut laws: Vec<LoadedLaw> = Vec::new();
    for (kind, name) in laws_of(spec) {
        let of_file = file.slots.get(kind).and_then(|laws| laws.get(name));
        let own = spec.parameters.get(kind).unwrap_or(&none);
        let plugin = find_law(case, kind, name, path)?;
        let friction = friction_of(&laws);
        let from = spec.parameters_from.as_deref();
        let mut numbers = given_numbers(kind.word(), name, (of_file, from), own);
        if kind == Kind::WEAR && unmeasured(case, spec, &plugin, &numbers) {
            continue;
        }
        let coefficient = (kind == Kind::WEAR)
            .then(|| wear_from_hardness(&plugin, &mut numbers, (sides, spec), friction))
            .transpose()?
            .flatten();
        let table = tables.get(kind);
        law_table::check(&plugin, table.is_some())?;
        let given = (&numbers, coefficient.as_ref());
        let law = load_law(case, plugin, given, (sides, spec))?;
        laws.push(match table {
            Some(table) => law.with_table(table.clone()),
            None => law,
        });
        derived.extend(coefficient);
    }
    // The error is reported at the damage law, or at `healing`.
    let unfit = |e: LawError| InterfaceError::from(ValidationError::new("damage", e.to_string()));
    let mut interface = Interface::new(spec.name.clone(), laws).map_err(unfit)?;
    interface.area = AreaRule {
        factor: spec.area_factor,
    };
    (interface.bonds_within, interface.bond_opening) = (spec.bonds_within, spec.bond_opening);
    interface
        .with_bonds(spec.bonds, spec.healing)
        .map_err(unfit)
}

/// Returns whether a wear law has no coefficient although a material gives its parameters: how much
/// that material wears others was not measured, and the law's default is that of another one. The
/// interface then has no wear law, see [`super::law_inputs::unmeasured`].
fn unmeasured(
    case: &Case,
    spec: &InterfaceSpec,
    plugin: &Plugin,
    numbers: &BTreeMap<&str, GivenNumber<'_>>,
) -> bool {
    let from = spec.parameters_from.as_ref();
    let of_material = from.is_some_and(|name| case.materials.contains_key(name));
    let fields = plugin.parameters.iter();
    let fields = fields.map(|f| (f.name.as_str(), f.unit.as_str()));
    let coefficient = super::wear_coefficient::parameter(fields).map(|(name, _)| name);
    let given = |name: &str| numbers.contains_key(name) || numbers.contains_key("K");
    of_material && coefficient.is_some_and(|name| !given(name))
}

/// Resolves the parameters of a law, and checks them by the law.
fn load_law(
    case: &Case,
    plugin: Plugin,
    (numbers, coefficient): (&BTreeMap<&str, GivenNumber<'_>>, Option<&WearCoefficient>),
    (sides, spec): (&Sides<'_>, &InterfaceSpec),
) -> Result<LoadedLaw, InterfaceError> {
    let (kind, name) = (plugin.kind, plugin.name.as_str());
    let slot = kind.word();
    for (flag, only, dimension) in [(FLAG_2D_ONLY, "two", 2), (FLAG_3D_ONLY, "three", 3)] {
        if plugin.flags & flag != 0 && case.dimension != dimension {
            let message = format!(
                "the {kind} law `{name}` is for {only} dimensions only, the case has {}",
                case.dimension
            );
            return Err(ValidationError::new(slot, message).into());
        }
    }
    let mut values: BTreeMap<&str, (f64, String)> = BTreeMap::new();
    for (parameter, number) in numbers {
        let value =
            parameter_value(&plugin, kind, parameter, number).map_err(|fault| InterfaceError {
                fault,
                in_file: !number.in_case,
            })?;
        values.insert(parameter, (value, number.origin.clone()));
    }
    if let Some(found) = coefficient {
        let origin = format!("K and the hardness of `{}`", found.softer);
        values.insert(&found.parameter, (found.value, origin));
    }
    let of_materials = properties_of_sides(&plugin, &values, sides, spec)?;
    values.extend(of_materials);
    let resolved = plugin
        .parameters
        .iter()
        .map(|f| match values.remove(f.name.as_str()) {
            Some((value, origin)) => (value, ParameterOrigin::Given(origin)),
            None => (f.default, ParameterOrigin::Default),
        });
    let (parameters, origins): (Vec<f64>, Vec<ParameterOrigin>) = resolved.unzip();
    plugin
        .validate(&parameters)
        .map_err(|e| ValidationError::new(slot, e.to_string()))?;
    Ok(LoadedLaw::new(plugin, parameters).with_origins(origins))
}

fn find_law(
    case: &Case,
    kind: Kind,
    name: &str,
    path: &SearchPath,
) -> Result<Plugin, ValidationError> {
    let slot = kind.word();
    let key = format!("{kind}/{name}");
    let pin = case.pins.get(&key).map(String::as_str);
    path.find_pinned(kind, name, pin).map_err(|e| match &e {
        LawError::Unknown {
            available,
            nearest,
            searched,
            ..
        } => ValidationError::new(
            slot,
            format!("there is no {kind} law named `{name}` in {searched}"),
        )
        .expected(format!("one of {available}"))
        .nearest(nearest.as_deref()),
        LawError::HashMismatch { .. } => ValidationError::new(format!("pins.{key}"), e.to_string()),
        other => ValidationError::new(slot, other.to_string()),
    })
}
