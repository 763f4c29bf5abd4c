//! The laws of an interface over the cells of a patch.
//!
//! Material enters each row of cells at its last one and passes to the first. A row is thus a
//! contact that goes through the patch: it forms where pressure begins, its age and its internal
//! variables go with it from cell to cell, and its temperature has the heat of the cells upstream.
//! The laws are asked as in a run, a step of dx/V in each cell: friction at the start of it, then
//! internal variables and wear. In fretting material stays in its cell, and its contact with it.

use fretwork_core::laws::bench::{Bench, BenchMotion, BenchOutputs, BenchState, ROOM_TEMPERATURE};
use fretwork_core::laws::{Interface, Kind, LawError};
use fretwork_elastic::half_space::CellGrid;
use fretwork_observe::quantity::number;
use fretwork_rolling::fields::length;
use fretwork_rolling::friction::Cells;
use fretwork_rolling::temperature::{Response, Thermal};
use fretwork_rolling::{Bound, Friction, Strips, Vector};
use std::sync::{Mutex, PoisonError};

/// Relative change of the slip for the slope of a bound.
const NEARBY: f64 = 1e-4;
/// Relative change of a bound that is more than rounding.
const ROUNDING: f64 = 1e-12;
/// Number of times that friction follows the temperature that its own heat causes in the cell.
const ROUNDS: usize = 3;

/// Friction and wear of a patch by the laws of an interface.
#[derive(Debug)]
pub struct PatchLaw {
    interface: Interface,
    thermal: Option<Thermal>,
    /// The cone of a law that is the same in all contacts.
    constant: Option<Cone>,
    /// Contacts of the cells, where material stays in them.
    held: Option<Mutex<Vec<Option<Held>>>>,
    /// Friction of strips, in place of that of the law.
    strips: Option<Strips>,
    /// The first error of a law.
    error: Mutex<Option<LawError>>,
}

/// The strength of a contact, mu (p + tension) + shear.
#[derive(Clone, Copy, Debug)]
struct Cone {
    mu: f64,
    tension: f64,
    shear: f64,
}

impl Cone {
    fn of(answer: &BenchOutputs) -> Self {
        Self {
            mu: answer.mu,
            tension: answer.strength[0],
            shear: answer.strength[1],
        }
    }

    fn at(&self, pressure: f64) -> f64 {
        self.mu * (pressure + self.tension) + self.shear
    }
}

/// Share of the time outside of a table from which it is told.
const SEEN: f64 = 0.01;

/// Name of the internal variable to which a patch gives the debris in a cell (m).
pub const DEBRIS: &str = "debris";

/// Returns the note on a table that is left for a share of the time.
pub fn outside(table: &str, share: f64) -> String {
    format!(
        "NOT IN RANGE: the `{table}` of the law is left for {} % of the time under load, where its value is that at its border",
        number(100.0 * share, 2)
    )
}

/// What the laws give in the cells of a patch; 0 in cells without contact.
#[derive(Clone, Debug, Default)]
pub struct Passage {
    /// Largest tractions (Pa).
    pub bounds: Vec<Bound>,
    /// Temperatures (K), where heat is computed.
    pub temperature: Vec<f64>,
    /// Depth that wears off the interface in the passage by each cell (m).
    pub worn: Vec<f64>,
    /// Internal variables at the end of each cell, one list for each variable.
    pub variables: Vec<Vec<f64>>,
}

/// A contact that goes through a row, or stays in a cell.
#[derive(Clone, Debug)]
struct Held {
    state: BenchState,
    cone: Option<Cone>,
}

impl PatchLaw {
    /// Prepares the laws of an interface; `thermal` has the bodies' thermal properties where they
    /// are known.
    ///
    /// # Errors
    /// A sentence on a law that a patch cannot follow.
    pub fn new(interface: Interface, thermal: Option<Thermal>) -> Result<Self, String> {
        for law in interface.loaded() {
            let (kind, name) = (law.plugin.kind, &law.plugin.name);
            if ![Kind::CONTACT, Kind::WEAR].contains(&kind) {
                return Err(format!(
                    "the {kind} law `{name}` cannot act in a patch: bodies that roll renew their contact, so that no bond lasts, and pressures do not pull; leave it out"
                ));
            }
            if law.reads_temperatures() && thermal.is_none() {
                return Err(format!(
                    "the {kind} law `{name}` reads temperatures: give a `speed`, and `conductivity` and `heat_capacity` in the files of both materials"
                ));
            }
        }
        let name = interface.contact().plugin.name.clone();
        if interface.compliant() {
            return Err(format!(
                "the contact law `{name}` has springs of its own, and a patch has the elasticity of its bodies: take a rigid one, such as coulomb"
            ));
        }
        let mut law = Self {
            interface,
            thermal,
            constant: None,
            held: None,
            strips: None,
            error: Mutex::default(),
        };
        let trial = law.trial().map_err(|e| e.to_string())?;
        if trial.iter().any(|a| a.rolling.iter().any(|r| *r > 0.0)) {
            return Err(format!(
                "the contact law `{name}` resists the rolling of grains, of which a patch has none: set that part to 0, or take another law"
            ));
        }
        law.constant = (law.interface.constant_contact()).then(|| Cone::of(&trial[0]));
        Ok(law)
    }

    /// Keeps material in its cell: the speed of the cells is then that at which a step takes the
    /// time of a passage by a cell.
    #[must_use]
    pub fn staying(mut self) -> Self {
        self.held = Some(Mutex::default());
        self
    }

    /// Returns whether friction is that of the pressure alone.
    pub fn is_constant(&self) -> bool {
        self.constant.is_some()
    }

    /// Returns the tables that contacts which stay in their cells have left for more than a
    /// hundredth of the time since they formed, and for which share of it.
    pub fn left(&self) -> Vec<(String, f64)> {
        let carried = self.carried();
        let sum = |k: usize| carried.iter().filter_map(|c| c.get(k)).sum::<f64>();
        let tables = self.tables().map(|(k, table)| (table, sum(k + 1) / sum(0)));
        tables.filter(|(_, share)| *share > SEEN).collect()
    }

    /// Returns the places of the internal variables that count the time outside of a table, and
    /// what that table is named.
    fn tables(&self) -> impl Iterator<Item = (usize, String)> {
        let loaded = self.interface.loaded();
        let named = loaded.flat_map(|l| l.plugin.variables.iter()).enumerate();
        named.filter_map(|(k, field)| Some((k, field.name.strip_prefix("outside_")?.to_owned())))
    }

    /// Takes the friction of strips in place of that of the law, or that of the law again.
    pub fn follow(&mut self, strips: Option<Strips>) {
        self.strips = strips;
    }

    /// Returns the interface.
    pub fn interface(&self) -> &Interface {
        &self.interface
    }

    /// Returns a sentence for each table that the contacts leave for more than a hundredth of their
    /// time (s) in all, from the variables of a passage; a contact has `cells` cells.
    pub fn outside(&self, passage: &Passage, cells: usize, time: f64) -> Vec<String> {
        let left = self.tables().filter_map(|(k, table)| {
            let rows = passage.variables.get(k)?.chunks(cells);
            let most = |row: &[f64]| row.iter().copied().fold(0.0, f64::max);
            let share = rows.map(most).sum::<f64>() / time;
            (share > SEEN).then(|| outside(&table, share))
        });
        left.collect()
    }

    /// Returns the thermal properties of the bodies, where they are known.
    pub fn thermal(&self) -> Option<&Thermal> {
        self.thermal.as_ref()
    }

    /// Returns the first error of a law since the last call.
    pub fn take_error(&self) -> Option<LawError> {
        let mut error = self.error.lock().unwrap_or_else(PoisonError::into_inner);
        error.take()
    }

    fn keep(&self, error: LawError) {
        let mut first = self.error.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
    }

    /// Returns the place of the internal variable that is the debris in a cell, if a law has one.
    pub fn debris(&self) -> Option<usize> {
        let loaded = self.interface.loaded();
        let mut fields = loaded.flat_map(|l| l.plugin.variables.iter());
        fields.position(|f| f.name == DEBRIS)
    }

    fn bench(&self, grid: &CellGrid) -> Bench {
        let area = grid.area(3);
        let radius = (area / std::f64::consts::PI).sqrt();
        Bench::new(self.interface.clone(), 3, radius).of_area(area)
    }

    /// Returns answers of the laws in new contacts at rest and in motion.
    fn trial(&self) -> Result<Vec<BenchOutputs>, LawError> {
        let grid = CellGrid {
            from: [0.0; 2],
            size: [1e-4; 2],
            cells: [1; 2],
        };
        let mut bench = self.bench(&grid);
        let motions = [0.0, 1e-6].map(|slip| BenchMotion {
            opening: [0.0, slip, 0.0],
            pressure: 1e9,
            ..BenchMotion::default()
        });
        let mut states = vec![bench.fresh(); motions.len()];
        bench.step(&mut states, &motions, 1e-5)
    }

    /// Follows the material through the patch, with slips of the cells (m). Where material stays in
    /// its cell, this is the end of a step, from which the next one goes on.
    ///
    /// # Errors
    /// An error of a law.
    pub fn passage(&self, cells: Cells<'_>, slip: &[Vector]) -> Result<Passage, LawError> {
        let mut walk = Walk::new(self, cells, slip);
        walk.whole(true)?;
        if let Some(held) = &self.held {
            *held.lock().unwrap_or_else(PoisonError::into_inner) = walk.contacts;
        }
        Ok(walk.out)
    }

    fn walk(&self, cells: Cells<'_>, slip: &[Vector]) -> Result<Vec<Bound>, LawError> {
        let mut walk = Walk::new(self, cells, slip);
        walk.whole(false)?;
        Ok(walk.out.bounds)
    }
}

impl Friction for PatchLaw {
    fn bounds(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<Bound> {
        if let Some(strips) = &self.strips {
            return strips.bounds(cells, slip);
        }
        if let Some(cone) = self.constant {
            let bound = |p: &f64| Bound {
                traction: if *p > 0.0 { cone.at(*p) } else { 0.0 },
                slope: 0.0,
            };
            return cells.pressure.iter().map(bound).collect();
        }
        self.walk(cells, slip).unwrap_or_else(|error| {
            self.keep(error);
            // Without friction the iteration ends at once, and the caller finds the error.
            vec![Bound::default(); slip.len()]
        })
    }

    fn constant(&self) -> bool {
        self.is_constant()
    }

    fn renew(&self, cells: usize) {
        if let Some(held) = &self.held {
            *held.lock().unwrap_or_else(PoisonError::into_inner) = vec![None; cells];
        }
    }

    fn passed(&self, cells: Cells<'_>, slip: &[Vector]) -> Vec<f64> {
        let wears = self.interface.wear().is_some();
        if self.is_constant() && !wears {
            return Vec::new();
        }
        match self.passage(cells, slip) {
            Ok(passage) if wears => passage.worn,
            Ok(_) => Vec::new(),
            Err(error) => {
                self.keep(error);
                Vec::new()
            }
        }
    }

    /// For each cell under pressure the age of its contact (s) and its internal variables.
    fn carried(&self) -> Vec<Vec<f64>> {
        let Some(held) = &self.held else {
            return Vec::new();
        };
        let held = held.lock().unwrap_or_else(PoisonError::into_inner);
        let numbers = |held: &Held| {
            let state = &held.state;
            let age = std::iter::once(state.compression_time);
            age.chain(state.variables.iter().copied()).collect()
        };
        held.iter()
            .map(|h| h.as_ref().map_or_else(Vec::new, numbers))
            .collect()
    }

    fn carry(&self, state: &[Vec<f64>]) {
        let Some(held) = &self.held else { return };
        let mut held = held.lock().unwrap_or_else(PoisonError::into_inner);
        held.resize(state.len(), None);
        let fresh = Bench::new(self.interface.clone(), 3, 1.0).fresh();
        for (held, numbers) in held.iter_mut().zip(state) {
            let Some((age, variables)) = numbers.split_first() else {
                *held = None;
                continue;
            };
            let contact = held.get_or_insert_with(|| Held {
                state: fresh.clone(),
                cone: None,
            });
            contact.state.compression_time = *age;
            contact.state.variables.copy_from_slice(variables);
        }
    }

    fn cover(&self, debris: &[f64]) {
        let Some(place) = self.debris() else { return };
        let mut state = self.carried();
        for (numbers, debris) in state.iter_mut().zip(debris) {
            if let Some(number) = numbers.get_mut(place + 1) {
                *number = *debris;
            }
        }
        self.carry(&state);
    }
}

/// The way of the material through the patch, column by column.
struct Walk<'a> {
    law: &'a PatchLaw,
    cells: Cells<'a>,
    slip: &'a [Vector],
    bench: Bench,
    /// Duration of the passage by a cell (s).
    step: f64,
    /// A contact for each row, or for each cell where material stays in it.
    contacts: Vec<Option<Held>>,
    heat: Option<Response>,
    /// Heat of each cell so far (W/m²).
    flux: Vec<f64>,
    /// Coefficient of friction of each cell by strips, where they give it.
    strips: Option<Vec<f64>>,
    out: Passage,
}

impl<'a> Walk<'a> {
    fn new(law: &'a PatchLaw, cells: Cells<'a>, slip: &'a [Vector]) -> Self {
        let bench = law.bench(cells.grid);
        let count = slip.len();
        let thermal = law.thermal.as_ref();
        let heat = thermal.map(|t| t.response(cells.grid, cells.speed));
        let columns = cells.grid.cells[0];
        let by_rows = |strips: &Strips| {
            let rows = cells.pressure.chunks(columns).enumerate();
            let row = |(k, p): (usize, &[f64])| strips.row(cells.grid.middle(k * columns)[1], p);
            rows.flat_map(row).collect()
        };
        let temperature = heat
            .as_ref()
            .map_or_else(Vec::new, |h| vec![h.mixed; count]);
        Self {
            step: cells.grid.size[0] / cells.speed,
            contacts: match &law.held {
                Some(held) => held.lock().unwrap_or_else(PoisonError::into_inner).clone(),
                None => vec![None; cells.grid.cells[1]],
            },
            out: Passage {
                bounds: vec![Bound::default(); count],
                temperature,
                worn: vec![0.0; count],
                variables: vec![vec![0.0; count]; law.interface.variables()],
            },
            flux: vec![0.0; count],
            strips: law.strips.as_ref().map(by_rows),
            law,
            cells,
            slip,
            bench,
            heat,
        }
    }

    /// Goes through all cells; `all` for wear and variables, else bounds with their slopes.
    fn whole(&mut self, all: bool) -> Result<(), LawError> {
        if self.law.held.is_some() {
            let cells: Vec<(usize, usize)> = (0..self.slip.len()).map(|c| (c, c)).collect();
            return self.advance(&cells, all);
        }
        let [columns, rows] = self.cells.grid.cells;
        for column in (0..columns).rev() {
            let cell = |row| (row, self.cells.grid.cell([column, row]));
            let cells: Vec<(usize, usize)> = (0..rows).map(cell).collect();
            self.advance(&cells, all)?;
        }
        Ok(())
    }

    /// Advances contacts by a step in their cells, given as pairs of both.
    fn advance(&mut self, cells: &[(usize, usize)], all: bool) -> Result<(), LawError> {
        let mut places = Vec::new();
        for (contact, cell) in cells.iter().copied() {
            if self.cells.pressure[cell] > 0.0 {
                places.push((contact, cell));
                let fresh = || Held {
                    state: self.bench.fresh(),
                    cone: None,
                };
                self.contacts[contact].get_or_insert_with(fresh);
            } else {
                self.contacts[contact] = None;
            }
        }
        if places.is_empty() {
            return Ok(());
        }
        let contact = |(contact, _): &(usize, usize)| self.contacts[*contact].as_ref();
        let before = places
            .iter()
            .filter_map(|p| Some(contact(p)?.state.clone()));
        let before: Vec<BenchState> = before.collect();
        let upstream: Vec<f64> = places.iter().map(|(_, c)| self.upstream(*c)).collect();
        let mut cones: Vec<Option<Cone>> = places.iter().map(|p| contact(p)?.cone).collect();
        let rounds = match self.law.interface.reads_temperatures() {
            true => ROUNDS,
            false => 1,
        };
        let mut after = Vec::new();
        let mut answers = Vec::new();
        for _ in 0..rounds {
            let motions = self.motions(&places, &before, &upstream, &cones, 1.0);
            after.clone_from(&before);
            answers = self.bench.step(&mut after, &motions, self.step)?;
            let both = answers.iter().zip(&places);
            cones = both.map(|(a, (_, c))| Some(self.cone(a, *c))).collect();
        }
        let nearby = match all {
            true => None,
            false => {
                let motions = self.motions(&places, &before, &upstream, &cones, 1.0 + NEARBY);
                Some(self.bench.step(&mut before.clone(), &motions, self.step)?)
            }
        };
        for (k, (contact, cell)) in places.iter().copied().enumerate() {
            let p = self.cells.pressure[cell];
            let cone = self.cone(&answers[k], cell);
            let traction = cone.at(p);
            let slipped = length(self.slip[cell]);
            let change = nearby
                .as_ref()
                .map_or(0.0, |n| Cone::of(&n[k]).at(p) - traction);
            let known = slipped > 0.0 && change.abs() > ROUNDING * traction;
            self.out.bounds[cell] = Bound {
                traction,
                slope: if known {
                    change / (NEARBY * slipped)
                } else {
                    0.0
                },
            };
            self.flux[cell] = traction * slipped / self.step;
            if let Some(heat) = &self.heat {
                self.out.temperature[cell] = upstream[k] + heat.weights[0] * self.flux[cell];
            }
            if all {
                self.out.worn[cell] = answers[k].worn / self.bench.area();
                let variables = self.out.variables.iter_mut().zip(&after[k].variables);
                variables.for_each(|(list, value)| list[cell] = *value);
            }
            self.contacts[contact] = Some(Held {
                state: after[k].clone(),
                cone: Some(cone),
            });
        }
        Ok(())
    }

    /// Strength of a cell by an answer of the law, or by strips in its place.
    fn cone(&self, answer: &BenchOutputs, cell: usize) -> Cone {
        match &self.strips {
            Some(strips) => Cone {
                mu: strips[cell],
                tension: 0.0,
                shear: 0.0,
            },
            None => Cone::of(answer),
        }
    }

    /// Temperature of a cell without its own heat (K).
    fn upstream(&self, cell: usize) -> f64 {
        let Some(heat) = &self.heat else {
            return ROOM_TEMPERATURE;
        };
        let end = (cell / self.cells.grid.cells[0] + 1) * self.cells.grid.cells[0];
        let before = self.flux[cell + 1..end].iter().zip(&heat.weights[1..]);
        heat.mixed + before.map(|(q, w)| q * w).sum::<f64>()
    }

    /// Returns the motions of contacts in a column, with slips by a factor.
    fn motions(
        &self,
        places: &[(usize, usize)],
        states: &[BenchState],
        upstream: &[f64],
        cones: &[Option<Cone>],
        factor: f64,
    ) -> Vec<BenchMotion> {
        let of = |(k, (_, cell)): (usize, &(usize, usize))| {
            let [x, y] = self.slip[*cell].map(|s| factor * s);
            let [n, t1, t2] = states[k].opening;
            let pressure = self.cells.pressure[*cell];
            let traction = cones[k].map_or(0.0, |c| c.at(pressure));
            let own = self.heat.as_ref().map_or(0.0, |h| h.weights[0]);
            let temperature = upstream[k] + own * traction * length([x, y]) / self.step;
            BenchMotion {
                opening: [n, t1 + x, t2 + y],
                pressure,
                temperatures: [temperature; 2],
                ..BenchMotion::default()
            }
        };
        places.iter().enumerate().map(of).collect()
    }
}
