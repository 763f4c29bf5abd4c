//! Values of all tests at points of the parameters, from runs of their cases over seeds, several at
//! a time.

use super::measured::{self, unit};
use super::model::Model;
use super::spec::{FitFile, TestSpec};
use crate::changes::Changes;
use crate::factor::Factor;
use crate::runs::available::AvailableQuantities;
use crate::runs::launcher::{Launcher, Run, WaitLimits};
use crate::runs::output::OutputName;
use crate::runs::pool::each;
use crate::runs::stored::{Status, summary};
use crate::{Error, RunSetup, build, load};
use fretwork_core::laws::SearchPath;
use fretwork_math::fit::bounds::{Bounds, Parameter};
use fretwork_math::fit::residuals::{Curve, Measurement, Target};
use fretwork_scene::InputError;
use fretwork_scene::material::NumberSpec;
use fretwork_scene::units::{convert, in_si};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// A test whose runs can be made.
#[derive(Debug)]
struct Test {
    launcher: Launcher,
    /// First seed.
    seed: u64,
    changes: Changes,
    simulated: Simulated,
}

/// Values that are read from a run.
#[derive(Debug)]
enum Simulated {
    Curve(Box<Model>),
    Value(OutputName),
}

/// Units of the values of a test, `1` for pure numbers; empty where they are unknown.
#[derive(Debug)]
pub struct TestUnits {
    /// Unit of the abscissae, in the heading of the measured ones; empty for a single value.
    pub x: String,
    /// Unit of the values: that in the heading of the measured ones, or that of the output.
    pub value: String,
}

/// A point of the parameters with one seed of all tests: simulated values at all measured
/// positions, or the reason why there are none.
pub type Sample = Result<Vec<f64>, String>;

/// A curve, or why a run gave none.
type RunCurve = Result<(Vec<f64>, Vec<f64>), String>;

/// The tests of a fit.
#[derive(Debug)]
pub struct Tests {
    /// Measured values.
    pub target: Target,
    /// Units of each test.
    pub units: Vec<TestUnits>,
    /// The region of the parameters.
    pub bounds: Bounds,
    /// Whether the seed of any case changes its scene.
    pub random: bool,
    factors: Vec<Factor>,
    tests: Vec<Test>,
    /// Whether measured specimens scatter as runs do from seed to seed.
    pub specimen_scatters: bool,
    /// Time limit of a run.
    pub limit: Option<Duration>,
}

impl Tests {
    /// Reads measurements and cases, and checks that the cases take the parameters at both ends of
    /// their ranges.
    ///
    /// # Errors
    /// Returns what is wrong with the fit, a case or a measurement.
    pub fn new(read: &FitFile, folder: &Path, setup: &RunSetup) -> Result<Self, Error> {
        let spec = &read.spec;
        let factors: Vec<Factor> = spec.parameters.iter().map(|p| p.factor()).collect();
        let bounds = bounds(read)?;
        let middle = bounds.values(&vec![0.5; bounds.len()]);
        let (mut tests, mut measurements, mut random) = (Vec::new(), Vec::new(), false);
        let mut units = Vec::new();
        for (k, test) in spec.tests.iter().enumerate() {
            let at = |key: &str, why: String| read.source.error_at(&format!("tests.{k}{key}"), why);
            let (name, case, set) = test.common();
            let case = read.beside(case);
            let changes = Changes::parse(set, &spec.names()).map_err(|(_, why)| at(".set", why))?;
            let fixed = &changes.fixed;
            let mut launcher = Launcher::new(&case, fixed, setup, folder, spec.limits())?;
            launcher.threads = spec.threads;
            let sets = sets_of(&factors, &changes, &middle).map_err(Error::Usage)?;
            let loaded = load(&case, &[fixed.clone(), sets].concat())?;
            let (scene, matters) = build(&loaded, setup)?;
            random |= matters;
            launcher.perturb_unless(matters, loaded.case.seed);
            let (simulated, measurement) = match test {
                TestSpec::Curve {
                    measured: from,
                    model,
                    ..
                } => {
                    let observers = (setup.observers)(&loaded, scene.simulation.view());
                    let columns = observers.columns();
                    let names: Vec<String> = columns.into_iter().map(|c| c.name).collect();
                    let made = Model::new(model, &names)
                        .map_err(|(key, why)| at(&format!(".model.{key}"), why))?;
                    let file = read.beside(&from.file);
                    let (curve, reach) = measured::curve(name, from, &file, model.along)?;
                    units.push(TestUnits {
                        x: unit(&file, &from.x),
                        value: unit(&file, &from.y),
                    });
                    (Simulated::Curve(Box::new(made.reaching(reach))), curve)
                }
                TestSpec::Value {
                    output,
                    measured,
                    sigma,
                    ..
                } => {
                    let quantity = OutputName::parse(output).map_err(|why| at(".output", why))?;
                    let available = AvailableQuantities::of(&loaded, &scene, setup);
                    available
                        .check(&quantity)
                        .map_err(|why| at(".output", why))?;
                    let unit = available.unit(&quantity);
                    let given = |key: &str, number: &NumberSpec| {
                        let own = number.unit.as_deref().unwrap_or_default();
                        let value = match unit.as_str() {
                            "" => in_si(number.value, own).map(|(value, _)| value),
                            unit => convert(number.value, own, unit),
                        };
                        value.map_err(|e| at(key, e.message))
                    };
                    let single = Measurement {
                        name: name.to_owned(),
                        x: vec![0.0],
                        y: vec![given(".measured", measured)?],
                        sigma: vec![given(".sigma", sigma)?],
                        weight: 1.0,
                    };
                    units.push(TestUnits {
                        x: String::new(),
                        value: unit,
                    });
                    (Simulated::Value(quantity), single)
                }
            };
            measurements.push(measurement);
            tests.push(Test {
                launcher,
                seed: loaded.case.seed,
                changes,
                simulated,
            });
        }
        let target = Target::new(measurements).map_err(|e| Error::Usage(e.to_string()))?;
        let tests = Self {
            target: match spec.balanced {
                true => target.balanced(),
                false => target,
            },
            units,
            bounds,
            random,
            specimen_scatters: spec.specimen_scatters,
            factors,
            tests,
            limit: None,
        };
        tests.check_ends(read, &setup.search)?;
        Ok(tests)
    }

    /// Refuses a range if a case rejects one of its ends.
    fn check_ends(&self, read: &FitFile, search: &SearchPath) -> Result<(), Error> {
        for (p, factor) in self.factors.iter().enumerate() {
            for end in [0.0, 1.0] {
                let mut place = vec![0.5; self.factors.len()];
                place[p] = end;
                let values = self.bounds.values(&place);
                for test in &self.tests {
                    let sets = sets_of(&self.factors, &test.changes, &values);
                    let sets = [test.launcher.sets.clone(), sets.map_err(Error::Usage)?].concat();
                    let built = load(&test.launcher.case, &sets);
                    built.and_then(|loaded| loaded.build(search)).map_err(|e| {
                        e.note(format!(
                            "with `{}` at an end of its range in {}",
                            factor.name,
                            read.path.display()
                        ))
                    })?;
                }
            }
        }
        Ok(())
    }

    /// Runs points of parameter values, each with these seeds, and with the step of the cases
    /// divided by `finer`; returns a row of samples per point. Only runs that `stop` prevents have
    /// no sample.
    ///
    /// # Errors
    /// A run cannot be started, or nothing can be written.
    pub fn run(
        &self,
        points: &[Vec<f64>],
        seeds: std::ops::Range<u64>,
        finer: u32,
        jobs: usize,
        stop: &AtomicBool,
        watch: &(dyn Fn() + Sync),
    ) -> Result<Vec<Vec<Option<Sample>>>, Error> {
        let mut items = Vec::new();
        for point in points {
            for seed in seeds.clone() {
                for test in &self.tests {
                    items.push((point, seed, test));
                }
            }
        }
        let work = |(point, seed, test): &(&Vec<f64>, u64, &Test)| {
            let curve = self.run_test(test, point, *seed, finer, stop)?;
            watch();
            Ok(curve)
        };
        let results = each(&items, jobs, stop, &work)?;
        let count = self.tests.len();
        let mut samples = results.chunks(count).map(|one| self.sample(one));
        let width = (seeds.end - seeds.start) as usize;
        Ok(points
            .iter()
            .map(|_| samples.by_ref().take(width).collect())
            .collect())
    }

    /// Returns the values of all tests for one seed, from their runs.
    fn sample(&self, runs: &[Option<Option<RunCurve>>]) -> Option<Sample> {
        let mut curves = Vec::new();
        for one in runs {
            match one.as_ref()?.as_ref()? {
                Ok(curve) => curves.push(curve),
                Err(why) => return Some(Err(why.clone())),
            }
        }
        let curves: Vec<Curve<'_>> = curves.iter().map(|c| Curve { x: &c.0, y: &c.1 }).collect();
        Some(self.target.simulated(&curves).map_err(|e| e.to_string()))
    }

    /// The `--set` arguments of a test for values of the parameters.
    pub fn sets(&self, test: usize, values: &[f64]) -> Vec<String> {
        let test = &self.tests[test];
        let own = sets_of(&self.factors, &test.changes, values).unwrap_or_default();
        [test.launcher.sets.clone(), own].concat()
    }

    /// The unit that the fit's file gives to a parameter; empty where it gives none.
    pub fn unit_of_parameter(&self, parameter: usize) -> &str {
        &self.factors[parameter].unit
    }

    /// The case of a test.
    pub fn case(&self, test: usize) -> &Path {
        &self.tests[test].launcher.case
    }

    /// Makes one run, with its step divided by `finer` and rows at the same times; `None` if it was
    /// interrupted.
    fn run_test(
        &self,
        test: &Test,
        values: &[f64],
        seed: u64,
        finer: u32,
        stop: &AtomicBool,
    ) -> Result<Option<RunCurve>, Error> {
        let launcher = &test.launcher;
        let mut sets = match sets_of(&self.factors, &test.changes, values) {
            Ok(sets) => sets,
            Err(why) => return Ok(Some(Err(why))),
        };
        let whole = [launcher.sets.clone(), sets.clone()].concat();
        let case = match load(&launcher.case, &whole) {
            Ok(loaded) => loaded.case,
            Err(why) => return Ok(Some(Err(why.to_string()))),
        };
        let step = case.time.step / f64::from(finer);
        if finer > 1 {
            let every = case.output.every * u64::from(finer);
            sets.push(format!("time.step={step:e}"));
            sets.push(format!("output.every={every}"));
        }
        let run = Run {
            sets,
            seed: test.seed.wrapping_add(seed),
        };
        let wait = WaitLimits {
            deadline: None,
            limit: self.limit.map(|l| l * finer),
            stop,
        };
        let Some(ended) = launcher.run(&run, wait)? else {
            return Ok(None);
        };
        if let Status::Slow(s) = ended.status {
            return Ok(Some(Err(format!("it took more than {s:.0} s"))));
        }
        if let Some(why) = ended.status.failure() {
            return Ok(Some(Err(why)));
        }
        let place = launcher.place(&run);
        Ok(Some(match &test.simulated {
            Simulated::Curve(model) => model.curve(&place.join("statistics.csv"), step),
            Simulated::Value(quantity) => match quantity.read(&summary(&place), &place) {
                Some(value) => Ok((vec![0.0], vec![value])),
                None => Err(format!("it has no value of {}", quantity.name)),
            },
        }))
    }
}

/// The changes of a case for values of the parameters.
fn sets_of(factors: &[Factor], changes: &Changes, values: &[f64]) -> Result<Vec<String>, String> {
    let own = factors
        .iter()
        .zip(values)
        .flat_map(|(f, x)| f.exactly(*x).sets);
    let numbers: Vec<Option<f64>> = values.iter().copied().map(Some).collect();
    Ok(own.chain(changes.derived(&numbers)?).collect())
}

/// The region of the parameters.
fn bounds(read: &FitFile) -> Result<Bounds, InputError> {
    let spec = &read.spec;
    let parameters = spec.parameters.iter().map(|p| Parameter {
        name: p.name.clone(),
        scale: {
            let [low, high] = p.limits();
            p.scale.between(low, high)
        },
    });
    let place = |name: &String| {
        let place = spec.parameters.iter().position(|p| p.name == *name);
        place.ok_or_else(|| {
            let why = format!("`{name}` is no parameter");
            read.source.error_at("order", why)
        })
    };
    let orders = spec.order.iter().map(|(a, b)| Ok((place(a)?, place(b)?)));
    let orders = orders.collect::<Result<Vec<_>, InputError>>()?;
    Bounds::new(parameters.collect(), &orders)
        .map_err(|e| read.source.error_at("parameters", e.to_string()))
}
