//! `fretwork trade`: accuracy against cost.

use super::experiment::{interrupted, results};
use super::number::{not_negative, share};
use super::output::{answer_json, inform, report};
use super::{CaseArgs, Failure};
use crate::experiments::duration::{parse as duration, seconds};
use crate::experiments::runs::stored::{Limits, Status};
use crate::experiments::trade::{Event, Request, table, write};
use crate::interrupt;
use crate::scene::source::clean;
use clap::Args;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

#[derive(Args, Debug)]
pub struct TradeArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// An output and its wanted error: a name of summary.json (wear.Qs) or statistics.COLUMN (mean
    /// of the last half; :max, :min, :last), =1% or =0.003 in its unit; by default friction, damage
    /// ratio and wear at 1 %
    #[arg(long = "output", value_name = "NAME=ERROR")]
    outputs: Vec<String>,
    /// Exact value of an output, for example from a closed form; errors are then measured against
    /// it
    #[arg(long = "exact", value_name = "NAME=VALUE")]
    exact: Vec<String>,
    /// Setting to vary: step, tolerance, solver, test_every, coupling, correction; and, only where
    /// named, accuracy, grains, deformability (what deforms)
    #[arg(long = "setting", value_name = "NAME")]
    parameters: Vec<String>,
    /// Former name of --setting
    #[arg(long = "knob", value_name = "NAME", hide = true)]
    renamed: Vec<String>,
    /// Vary any value of the case; the first value is that of the reference
    #[arg(long = "vary", value_name = "KEY.PATH=A,B,C")]
    vary: Vec<String>,
    /// Compare another file as a form of the case, the finest first; the case itself may be one of
    /// them
    #[arg(long = "variant", value_name = "NAME=FILE")]
    variants: Vec<String>,
    /// Seeds per setting, from the case's own upwards; one run if nothing is random and contacts
    /// are not chaotic
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    seeds: u16,
    /// Time budget of the trade: 90s, 10m, 2h
    #[arg(long, value_name = "TIME", default_value = "10m", value_parser = duration)]
    budget: Duration,
    /// Parallel runs; they disturb each other's timing, so 1 times best
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
    /// Folder of the results, in which an interrupted trade also continues; by default
    /// results/trade/<case>
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Largest fraction of steps that may miss the tolerance in an accepted run
    #[arg(long, value_name = "SHARE", default_value_t = 1e-2, value_parser = share)]
    unconverged: f64,
    /// Largest energy residual, relative to the largest energy, of an accepted run
    #[arg(long, value_name = "SHARE", default_value_t = 1e-2, value_parser = not_negative)]
    residual: f64,
    /// Show no progress; print the trade as JSON
    #[arg(long)]
    json: bool,
}

impl TradeArgs {
    /// Returns the names of the presets; former names are replaced and reported.
    fn presets(&self) -> Vec<String> {
        if !self.renamed.is_empty() {
            report("warning: --knob was renamed: write --setting");
        }
        let named = self.parameters.iter().chain(&self.renamed);
        let current = named.map(|name| match name.as_str() {
            "rung" => {
                report("warning: --setting rung was renamed: write --setting deformability");
                "deformability".to_owned()
            }
            _ => name.clone(),
        });
        current.collect()
    }

    fn request(&self) -> Request {
        Request {
            case: self.case.case.clone(),
            sets: self.case.sets.clone(),
            outputs: self.outputs.clone(),
            exact: self.exact.clone(),
            presets: self.presets(),
            vary: self.vary.clone(),
            variants: self.variants.clone(),
            seeds: self.seeds,
            budget: self.budget,
            jobs: self.jobs,
            out: results(self.out.as_deref(), "trade", &self.case.case),
            limits: Limits {
                unconverged: self.unconverged,
                residual: self.residual,
            },
        }
    }
}

pub fn trade(args: &TradeArgs) -> Result<(), Failure> {
    let setup = args.case.plugins.run_setup()?;
    let request = args.request();
    let stop = interrupt::watch();
    let (mut trade, _lock) = request.begin(&setup, stop)?;
    if !args.json {
        let title = clean(&trade.title);
        inform(&format!("{}: {title}", request.case.display()));
        inform(&table::forecast(&trade));
    }
    let expected = trade.work(&[trade.first(), trade.one_at_a_time()].concat());
    let quiet = args.json
        || !(std::io::stderr().is_terminal() || std::env::var_os("FRETWORK_QUIET").is_none());
    let started = trade.started;
    trade.execute(stop, &|event| {
        if !quiet {
            report_event(event, started);
        }
    })?;
    let cut_short = stop.load(Ordering::Relaxed);
    let answer = trade.answer(cut_short);
    let (json, drawn) = write(&trade, &answer, &request.out)?;
    let ended = match cut_short {
        true => Err(interrupted()),
        false => Ok(()),
    };
    if args.json {
        return answer_json(&json).and(ended);
    }
    inform("");
    inform(table::text(&trade, &answer).trim_end());
    inform(&format!(
        "{} runs in {}, {} reused from earlier studies; the forecast for the reference and one parameter at a time was {}",
        trade.fresh,
        seconds(trade.started.elapsed().as_secs_f64()),
        trade.reused,
        seconds(expected)
    ));
    if !answer.complete {
        inform(&table::incomplete(&trade, cut_short));
    }
    let out = request.out.display();
    let last = match drawn {
        true => format!("{out}/trade.png"),
        false => "no picture: no setting has a known error".to_owned(),
    };
    inform(&format!("{out}/trade.csv, {out}/trade.json, {last}"));
    ended
}

/// Reports that a run begins or has ended.
fn report_event(event: &Event<'_>, started: Instant) {
    let elapsed = seconds(started.elapsed().as_secs_f64());
    match event {
        Event::Begins(name, seed, expected) => report(&format!(
            "[{elapsed}] {name}, seed {seed}: {} expected",
            seconds(*expected)
        )),
        Event::Ended(name, seed, run) => {
            let how = match &run.status {
                Status::Done => "done",
                Status::Refused(_) | Status::Failed(_) | Status::Rejected(_) => "FAILED",
                Status::Slow(_) => "slower than the reference",
            };
            report(&format!(
                "[{elapsed}] {name}, seed {seed}: {how} in {}",
                seconds(run.seconds)
            ));
        }
    }
}
