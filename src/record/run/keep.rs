//! Checkpoints of a run: their contents, and how a stopped run is restored from them.

use super::account::Account;
use super::clear;
use super::flows::Flows;
use super::jumps::Jumps;
use super::{Recorder, RunError, unwritable};
use crate::geometry::space::Space;
use crate::record::checkpoint::{Kind, LAST, ResumeError, ResumePoint};
use crate::record::code::{CodeError, decode, encode};
use crate::record::friction::Cycles;
use crate::record::layer::Layer;
use crate::record::solving::SolverSummary;
use crate::record::strain::Strain;
use crate::report::Paint;
use crate::scene::build::Dimensional;
use crate::step::Saved;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::Path;
use std::time::{Duration, Instant};

/// State of the run loop, beyond what follows from the case. Rows are in the results file; the number of rows
/// that belong to this state is stored here.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct Carried<'a, S: Space> {
    simulation: Saved<'a, S>,
    /// Number of steps over which states and pictures are distributed.
    spread: u64,
    /// Rows and chunks of each growing dataset of the results, in the order of their declaration.
    rows: Vec<(u64, u32)>,
    paints: Cow<'a, [Paint]>,
    strain: Option<Cow<'a, Strain<S>>>,
    cycles: Option<Cow<'a, Cycles>>,
    /// Reference lengths for the strains of a biaxial test (m).
    reference: Option<[f64; 2]>,
    measures: Vec<Vec<u8>>,
    account: Cow<'a, Account<S>>,
    jumps: Option<Cow<'a, Jumps>>,
    layer: Cow<'a, Layer<S>>,
    slide: f64,
    worn: (f64, f64),
    load_path: f64,
    flows: Flows,
    iterations: u64,
    couplings: u64,
    solver: Cow<'a, SolverSummary>,
    wall: Duration,
    processor: Duration,
}

impl<S: Dimensional> Recorder<'_, S> {
    /// Writes a checkpoint of the current state to the results.
    pub(super) fn keep(&mut self) -> Result<(), RunError> {
        let begun = Instant::now();
        let state = self.state()?;
        self.mark(Kind::State, state)?;
        // The other files can be regenerated from the results; this one is for the user to read.
        self.table
            .flush()
            .map_err(|e| unwritable(&self.out.join("statistics.csv"), &e))?;
        self.keeper.written(begun);
        Ok(())
    }

    /// Writes a checkpoint frame into the results.
    pub(super) fn mark(&mut self, kind: Kind, state: Vec<u8>) -> Result<(), RunError> {
        let (number, bytes) = self.keeper.frame(kind, state);
        Ok(self.results.checkpoint(number, &bytes)?)
    }

    /// Moves the results file to its final name, with a first checkpoint in it, and opens the table.
    pub(super) fn publish(&mut self, kind: Kind, state: Vec<u8>) -> Result<(), RunError> {
        self.mark(kind, state)?;
        // Remove the marker of a finished earlier run: from now on this folder holds an unfinished one.
        match std::fs::remove_file(self.out.join(LAST)) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                return Err(unwritable(&self.out.join(LAST), &e));
            }
            _ => {}
        }
        let results = self.out.join("results.h5");
        let replaces = kind == Kind::Begun && results.exists();
        self.results.publish(&results)?;
        if replaces {
            clear::clear(&self.out)?;
        }
        let path = self.out.join("statistics.csv");
        self.table.open(&path).map_err(|e| unwritable(&path, &e))
    }

    fn state(&mut self) -> Result<Vec<u8>, RunError> {
        let rows = self.results.rows()?;
        Ok(encode(&Carried {
            simulation: self.simulation.save(),
            spread: self.spread,
            rows,
            paints: Cow::Borrowed(self.camera.paints()),
            strain: self.strain.as_ref().map(Cow::Borrowed),
            cycles: self.cycles.as_ref().map(|(c, _)| Cow::Borrowed(c)),
            reference: self.biaxial.as_ref().map(|b| b.reference()),
            measures: self.measures.save()?,
            account: Cow::Borrowed(&self.account),
            jumps: self.jumps.as_ref().map(Cow::Borrowed),
            layer: Cow::Borrowed(&self.layer),
            slide: self.slide,
            worn: self.worn,
            load_path: self.load_path,
            flows: self.flows,
            iterations: self.iterations,
            couplings: self.couplings,
            solver: Cow::Borrowed(&self.summary.solver),
            wall: self.spent.0 + self.clock.elapsed(),
            processor: self.spent.1 + self.processor.elapsed(),
        })?)
    }

    /// Restores the state of a stopped run, and its rows up to there, in a new file that then replaces the
    /// old one.
    pub(super) fn take_up(&mut self, stop: ResumePoint) -> Result<(), RunError> {
        let path = stop.kept.path().to_owned();
        let refused = |source: CodeError| ResumeError::State {
            path: path.clone(),
            source,
        };
        let kept: Carried<'_, S> = decode(&stop.state).map_err(refused)?;
        let pairs = [
            (kept.strain.is_some(), self.strain.is_some()),
            (kept.cycles.is_some(), self.cycles.is_some()),
            (kept.reference.is_some(), self.biaxial.is_some()),
            (kept.jumps.is_some(), self.jumps.is_some()),
        ];
        let same = pairs.iter().all(|(a, b)| a == b);
        if !same || !self.simulation.restore(kept.simulation) {
            return Err(refused(CodeError::other("bodies, laws or tests")).into());
        }
        self.lengthen(kept.spread, &path)?;
        self.measures.restore(&kept.measures).map_err(refused)?;
        self.camera.paint(kept.paints.into_owned());
        self.strain = kept.strain.map(Cow::into_owned);
        if let (Some((cycles, _)), Some(kept)) = (&mut self.cycles, kept.cycles) {
            *cycles = kept.into_owned();
            cycles.lengthen(self.loaded.case.time.end);
        }
        if let (Some(test), Some(reference)) = (&mut self.biaxial, kept.reference) {
            test.refer_to(reference);
        }
        self.account = kept.account.into_owned();
        self.jumps = kept.jumps.map(Cow::into_owned);
        self.layer = kept.layer.into_owned();
        self.slide = kept.slide;
        self.worn = kept.worn;
        self.load_path = kept.load_path;
        self.resumed_at = self.simulation.steps;
        self.flows = kept.flows;
        self.iterations = kept.iterations;
        self.couplings = kept.couplings;
        self.summary.solver = kept.solver.into_owned();
        self.spent = (kept.wall, kept.processor);
        self.results.take_over(&stop.kept, &kept.rows)?;
        let names: Vec<String> = self.table.columns.iter().map(|c| c.name.clone()).collect();
        // The columns of the statistics are declared first.
        let rows = kept.rows.first().map_or(0, |r| r.0 as usize);
        let columns = stop.kept.statistics(&names, rows)?;
        self.publish(Kind::State, stop.state)?;
        let written = self.table.extend(&columns);
        written.map_err(|e| unwritable(&self.out.join("statistics.csv"), &e))?;
        Ok(())
    }

    /// Keeps the spacing of states and pictures with which the run was started, also beyond its end.
    fn lengthen(&mut self, spread: u64, path: &Path) -> Result<(), ResumeError> {
        let aperiodic = |(c, _): &(Cycles, usize)| !c.oscillates();
        let why = if self.total <= spread {
            None
        } else if self.jumps.is_some() {
            Some("the lengths of its jumps over cycles depend on the end of the run")
        } else if self.cycles.as_ref().is_some_and(aperiodic) {
            Some("a friction test without a period counts the second half of the whole run")
        } else {
            None
        };
        self.spread = spread;
        why.map_or(Ok(()), |why| {
            Err(ResumeError::Longer {
                path: path.to_owned(),
                why,
            })
        })
    }
}
