//! Maps of fretting over load and amplitude of displacement: running conditions with the boundaries
//! of their regimes, energy and wear of a cycle, and what becomes of the material.

use crate::Error;
use crate::patch::Follow;
use crate::patch::fretting::fail;
use crate::patch::fretting::spec::{CracksSpec, FrettingSpec, MapSpec};
use crate::patch::law::PatchLaw;
use crate::patch::rolling::bodies_that_wear;
use crate::patch::said::Said;
use crate::patch::setup::{Setup, grid};
use crate::patch::spec::{PatchFile, positive};
use fretwork_core::laws::Kind;
use fretwork_elastic::half_space::CellGrid;
use fretwork_observe::quantity::number;
use fretwork_rolling::Estimate;
use fretwork_rolling::cells::{ByCells, Contact};
use fretwork_rolling::fatigue::materials::{ALUMINIUM_6082_T6, Fatigue, STEEL_30NCD16};
use fretwork_rolling::fatigue::{Block, Criterion};
use fretwork_rolling::patch::coarser;
use fretwork_rolling::response::{Body, Response, Thresholds, Wears};
use fretwork_rolling::running::{
    Boundaries, Conditions, Limits, Loaded, Regime, RunningError, boundaries, strip_transition,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Materials whose strength under many cycles is known.
const STRENGTHS: [Fatigue; 2] = [STEEL_30NCD16, ALUMINIUM_6082_T6];
/// Depths at which stresses are averaged over a block.
const LAYERS: usize = 3;
/// Fewest and most cells along a side.
const CELLS: [usize; 2] = [12, 256];
/// Steps of a quarter of a cycle, where friction has a state.
const STEPS: usize = 8;

/// A map.
#[derive(Debug, Serialize)]
pub struct FrettingMap {
    /// Loads (N).
    pub loads: Vec<f64>,
    /// Amplitudes of displacement (m).
    pub amplitudes: Vec<f64>,
    /// Number of cells of its grids along their sides.
    pub cells: [usize; 2],
    /// What tells the regimes apart.
    pub limits: Limits,
    /// By load, and for each by amplitude.
    pub places: Vec<Vec<Place>>,
    /// Boundaries by load.
    pub edges: Vec<Edges>,
    /// Bodies that wear, and their parts in the wear of the law.
    pub bodies: Vec<(String, f64)>,
    /// What is known of the cracks.
    pub cracks: Option<Cracks>,
    /// What limits the trust in it.
    pub notes: Vec<String>,
    /// Time of the processor (s).
    pub seconds: f64,
}

/// A place of the map.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Place {
    /// Running conditions.
    pub conditions: Conditions,
    /// The regime.
    pub regime: Regime,
    /// Whether members of the laws have partial slip and gross slip here: friction that changes
    /// over the cycles makes the regime mixed.
    pub mixed: bool,
    /// Whether the contacts leave a table of the laws here, for more than a hundredth of the time.
    pub outside: bool,
    /// Index of the criterion for cracks.
    pub crack: Option<f64>,
    /// Depth worn after all cycles (m).
    pub worn: Option<f64>,
    /// How the material responds.
    pub response: Option<Response>,
}

/// Amplitudes of displacement (m) at the boundaries under a load.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Edges {
    /// Load (N).
    pub load: f64,
    /// End of stick.
    pub stick: Estimate,
    /// Onset of gross slip.
    pub gross_slip: Estimate,
    /// Onset of gross slip by the energy ratio.
    pub energy_ratio: Estimate,
    /// Onset of reciprocating sliding.
    pub reciprocating: Estimate,
    /// A and slip ratio at the onset of gross slip.
    pub at_onset: [f64; 2],
    /// Lowest and highest onset of gross slip of the members.
    pub mixed: Option<[f64; 2]>,
    /// Onset of cracks and of wear that counts; infinite where there is none.
    pub damage: Option<[f64; 2]>,
}

/// What tells cracks and wear.
#[derive(Clone, Debug, Serialize)]
pub struct Cracks {
    /// Material whose strength is taken.
    pub strength: String,
    /// Criterion.
    pub criterion: String,
    /// Number of cycles.
    pub cycles: f64,
    /// Depth of wear that counts (m).
    pub depth: f64,
    /// Material of the body.
    pub body: String,
    #[serde(skip)]
    thresholds: Option<Thresholds>,
}

impl Place {
    /// Returns the name of the regime.
    pub fn regime_name(&self) -> &'static str {
        match (self.mixed, self.regime) {
            (true, Regime::PartialSlip | Regime::GrossSlip | Regime::Stick) => "mixed",
            (_, regime) => regime.name(),
        }
    }

    /// Returns the name of the response.
    pub fn response_name(&self) -> Option<&'static str> {
        self.response.map(|r| match r {
            Response::None => "no damage",
            Response::Crack => "cracks",
            Response::Wear => "wear",
            Response::Both => "cracks and wear",
        })
    }
}

/// Solves the map of a file.
///
/// # Errors
/// A number is out of range, a law fails, or a cycle has no solution.
pub fn solve(
    file: &PatchFile,
    setup: &Setup,
    spec: &FrettingSpec,
    map: &MapSpec,
    follow: &mut Follow<'_>,
) -> Result<FrettingMap, Error> {
    let source = &file.source;
    let loads = map.load.numbers(file, "motion.map.load", "N")?;
    let amplitudes = map.amplitude.numbers(file, "motion.map.amplitude", "m")?;
    let [fewest, most] = CELLS;
    if !(fewest..=most).contains(&map.cells) || !map.cells.is_multiple_of(2) {
        return Err(source
            .error_at(
                "motion.map.cells",
                format!("an even number of cells from {fewest} to {most} is expected"),
            )
            .into());
    }
    let with = "the mean speed of the strokes, such as `speed: 1 mm/s`";
    setup.check_time(file, setup.speed, with)?;
    let cracks = spec.cracks.as_ref();
    let cracks = cracks.map(|c| read_cracks(file, setup, c)).transpose()?;
    let bodies = match setup.laws[0].interface().law(Kind::WEAR) {
        Some(_) => bodies_that_wear(setup),
        None => Vec::new(),
    };
    let started = cpu_time::ProcessTime::now();
    let mut out = FrettingMap {
        cells: [map.cells, map.cells],
        limits: Limits::default(),
        places: Vec::new(),
        edges: Vec::new(),
        bodies,
        cracks,
        notes: Vec::new(),
        seconds: 0.0,
        loads,
        amplitudes,
    };
    let mut left = BTreeMap::new();
    for (k, load) in out.loads.clone().into_iter().enumerate() {
        let grid = grid(&setup.bodies, load, map.cells)?;
        out.cells = grid.cells;
        if let Some(length) = setup.bodies.length {
            let half = setup.bodies.line(load, length).half_width;
            out.limits.energy_ratio = strip_transition(&setup.bodies.elasticity, length, half);
        }
        let limits = out.limits;
        let (places, edges) = row(setup, &out, load, grid, &limits, &mut left)?;
        out.places.push(places);
        out.edges.push(edges);
        follow("map", (k + 1) as f64 / out.loads.len() as f64);
    }
    let all = out.loads.len() * out.amplitudes.len();
    let notes = left.into_iter().map(|(table, places): (String, usize)| {
        format!(
            "NOT IN RANGE: the `{table}` of the law is left at {} % of the places, where its value is that at its border (`outside_table` of map.csv)",
            number(100.0 * places as f64 / all as f64, 3)
        )
    });
    out.notes = notes.collect();
    out.seconds = started.elapsed().as_secs_f64();
    Ok(out)
}

/// Calls a function with the contact of a law on a grid.
fn with_contact<R>(
    setup: &Setup,
    law: &PatchLaw,
    (load, grid): (f64, CellGrid),
    call: impl FnOnce(Contact<'_>) -> Result<R, RunningError>,
) -> Result<R, Error> {
    let contacts = ByCells {
        bodies: setup.bodies.elasticity,
        layer: setup.layer,
        distance: &|place| setup.bodies.distance.at(place),
        grid: &|_| grid,
        law,
        along: [1.0, 0.0],
        speed: setup.rolling_speed(),
        quarter: STEPS,
    };
    let found = contacts.contact(load).and_then(call);
    match law.take_error() {
        Some(error) => Err(fail(&error)),
        None => found.map_err(|e| Error::Failed(e.said())),
    }
}

/// Solves the places and boundaries of a load; `left` counts the places that leave each table.
fn row(
    setup: &Setup,
    map: &FrettingMap,
    load: f64,
    grid: CellGrid,
    limits: &Limits,
    left: &mut BTreeMap<String, usize>,
) -> Result<(Vec<Place>, Edges), Error> {
    let law = &setup.laws[0];
    let edges_on = |law: &PatchLaw, grid| {
        with_contact(setup, law, (load, grid), |c| boundaries(&c, load, limits))
    };
    let fine = edges_on(law, grid)?;
    let [one, other] = coarser(&grid);
    let coarse = [edges_on(law, one)?, edges_on(law, other)?];
    let of =
        |number: fn(&Boundaries) -> f64| Estimate::of(number(&fine), coarse.each_ref().map(number));
    let mut onsets = vec![fine.gross_slip];
    for member in &setup.laws[1..] {
        onsets.push(edges_on(member, grid)?.gross_slip);
    }
    let lowest = onsets.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = onsets.iter().copied().fold(0.0, f64::max);
    let mut edges = Edges {
        load,
        stick: of(|b| b.stick),
        gross_slip: of(|b| b.gross_slip),
        energy_ratio: of(|b| b.energy_ratio),
        reciprocating: of(|b| b.reciprocating),
        at_onset: [0.0; 2],
        mixed: (onsets.len() > 1).then_some([lowest, highest]),
        damage: None,
    };
    let places = with_contact(setup, law, (load, grid), |contact| {
        let onset = conditions(&contact, fine.gross_slip)?;
        edges.at_onset = [onset.energy_ratio(), onset.slip_ratio];
        let list = map.amplitudes.iter().map(|amplitude| {
            let found = conditions(&contact, *amplitude)?;
            let tables = law.left();
            let outside = !tables.is_empty();
            for (table, _) in tables {
                *left.entry(table).or_default() += 1;
            }
            Ok(Place {
                outside,
                regime: found.regime(&fine, limits),
                conditions: found,
                mixed: lowest < *amplitude && *amplitude <= highest,
                crack: None,
                worn: None,
                response: None,
            })
        });
        list.collect::<Result<Vec<_>, _>>()
    })?;
    let thresholds = map.cracks.as_ref().and_then(|c| c.thresholds);
    let Some(thresholds) = thresholds else {
        return Ok((places, edges));
    };
    let places = with_contact(setup, law, (load, grid), |contact| {
        let body = Body::new(contact, &thresholds);
        let list = places.iter().map(|place| {
            let damage = body.damage(place.conditions.amplitude[0])?;
            Ok(Place {
                crack: Some(damage.crack),
                worn: Some(damage.worn),
                response: Some(damage.response(&thresholds)),
                ..*place
            })
        });
        let list = list.collect::<Result<Vec<_>, _>>()?;
        let onsets = body.onsets()?;
        edges.damage = Some([onsets.crack, onsets.wear]);
        Ok(list)
    })?;
    Ok((places, edges))
}

fn conditions(contact: &Contact<'_>, amplitude: f64) -> Result<Conditions, RunningError> {
    let mut found = contact.conditions(amplitude)?;
    found.slip_ratio = contact.slip_ratio(&found)?;
    Ok(found)
}

fn read_cracks(file: &PatchFile, setup: &Setup, spec: &CracksSpec) -> Result<Cracks, Error> {
    let source = &file.source;
    let known = STRENGTHS.iter().find(|m| m.name == spec.strength);
    let Some(material) = known else {
        let names = STRENGTHS.map(|m| m.name).join(", ");
        return Err(source
            .error_at(
                "motion.cracks.strength",
                format!("no strength of `{}` is known", spec.strength),
            )
            .expected(format!("one of {names}"))
            .into());
    };
    let names = &setup.bodies.names;
    let name = spec.body.clone().unwrap_or_else(|| names[0].clone());
    let Some(body) = names.iter().position(|n| *n == name) else {
        let text = format!("`{name}` is none of the bodies' materials");
        let error = source.error_at("motion.cracks.body", text);
        return Err(error
            .expected(format!("one of {}", names.join(", ")))
            .into());
    };
    let [first, last] = material.range;
    let cycles = spec.cycles.unwrap_or(last);
    let criterion = match spec.criterion.as_str() {
        "crossland" if cycles != last => {
            let text = format!(
                "the strengths of {} in bending and torsion are those at {} cycles: leave `cycles` out, or take the criterion `swt`",
                material.name,
                number(last, 3)
            );
            return Err(source.error_at("motion.cracks.cycles", text).into());
        }
        "crossland" => Criterion::Crossland(material.crossland),
        "swt" if !(first..=last).contains(&cycles) => {
            let text = format!(
                "the tests of {} are from {} to {} cycles: take a number between them",
                material.name,
                number(first, 3),
                number(last, 3)
            );
            return Err(source.error_at("motion.cracks.cycles", text).into());
        }
        "swt" => Criterion::Swt {
            body: setup.bodies.elasticity[body],
            life: material.strain_life,
            cycles,
        },
        other => {
            let text = format!("there is no criterion `{other}`");
            let error = source.error_at("motion.cracks.criterion", text);
            return Err(error.expected("crossland or swt").into());
        }
    };
    let Some(part) = wear_of(setup, &name) else {
        let text = "cracks are compared with wear: give the interface a wear law".to_owned();
        return Err(source.error_at("motion.cracks", text).into());
    };
    let bulk = match &spec.bulk {
        None => 0.0,
        Some(number) => crate::patch::spec::value(source, "motion.cracks.bulk", number, "Pa")?,
    };
    let depth = positive(source, "motion.cracks.depth", &spec.depth, "m")?;
    let block = Block {
        side: positive(source, "motion.cracks.block", &spec.block, "m")?,
        layers: LAYERS,
    };
    Ok(Cracks {
        strength: material.name.to_owned(),
        criterion: spec.criterion.clone(),
        cycles,
        depth,
        body: name,
        thresholds: Some(Thresholds {
            criterion,
            poisson: setup.bodies.elasticity[body].poisson,
            body,
            bulk: [bulk, 0.0, 0.0, 0.0, 0.0, 0.0],
            block,
            wear: Wears::Law(part),
            cycles,
            depth,
        }),
    })
}

/// Returns the part of a body in the wear of the law; all of it where bodies are not told apart.
fn wear_of(setup: &Setup, name: &str) -> Option<f64> {
    setup.laws[0].interface().law(Kind::WEAR)?;
    let bodies = bodies_that_wear(setup);
    let own = bodies.iter().find(|(body, _)| body == name);
    own.or(bodies.first()).map(|(_, part)| *part)
}
