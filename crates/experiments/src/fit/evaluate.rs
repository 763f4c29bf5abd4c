//! Values of all tests at points of the parameters: runs of their cases, over seeds, several at a time.

use super::FitError;
use super::measured;
use super::model::Model;
use super::spec::{ReadFit, TestSpec};
use crate::Program;
use crate::load;
use crate::runs::RunsError;
use crate::runs::expression::{Derived, number};
use crate::runs::launcher::{Ended, Launcher};
use crate::runs::offer::{Offer, columns};
use crate::runs::perturbation::Perturbation;
use crate::runs::pool::each;
use crate::runs::quantity::Quantity;
use crate::runs::randomness::seed_matters;
use crate::runs::spec::RangeScale;
use crate::runs::stored::{Limits, Status, summary};
use fretwork_core::laws::SearchPath;
use fretwork_scene::Scene;
use fretwork_study::design::scale::Scale;
use fretwork_study::fit::bounds::{Bounds, Parameter};
use fretwork_study::fit::residuals::{Curve, Measurement, Target};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// A time that no run reaches.
const FOREVER: Duration = Duration::from_secs(100 * 365 * 86_400);

/// A test whose runs can be made.
#[derive(Debug)]
struct Test {
    launcher: Launcher,
    /// Its first seed.
    seed: u64,
    derived: Vec<Derived>,
    output: Output,
}

/// What is taken of a run.
#[derive(Debug)]
enum Output {
    Curve(Box<Model>),
    Value(Quantity),
}

/// A point of the parameters with one seed of all tests.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Simulated values at all measured places, or why there are none.
    pub values: Result<Vec<f64>, String>,
}

/// The tests of a fit.
#[derive(Debug)]
pub struct Tests {
    /// What is measured.
    pub target: Target,
    /// The region of the parameters.
    pub bounds: Bounds,
    /// Whether the seeds of any case change its scene.
    pub random: bool,
    keys: Vec<Vec<String>>,
    tests: Vec<Test>,
    /// Whether measured specimens scatter as runs do from seed to seed.
    pub specimen_scatters: bool,
    /// Limit of the time of a run.
    pub limit: Option<Duration>,
}

impl Tests {
    /// Reads measurements and cases, and checks that the cases take the parameters at both ends of their ranges.
    ///
    /// # Errors
    /// What is wrong with the fit, a case or a measurement.
    pub fn new(read: &ReadFit, folder: &Path, program: &Program) -> Result<Self, FitError> {
        let search = &program.search;
        let spec = &read.spec;
        let bounds = bounds(read)?;
        let names: Vec<&str> = spec.parameters.iter().map(|p| p.name.as_str()).collect();
        let keys: Vec<Vec<String>> = spec.parameters.iter().map(|p| p.key.0.clone()).collect();
        let (mut tests, mut measurements, mut random) = (Vec::new(), Vec::new(), false);
        for (k, test) in spec.tests.iter().enumerate() {
            let at = |key: &str, why: String| read.source.error_at(&format!("tests.{k}{key}"), why);
            let (name, case, set) = test.common();
            let case = read.beside(case);
            let (with, set): (Vec<String>, Vec<String>) =
                set.iter().cloned().partition(|s| Derived::is(s));
            let derived = with.iter().map(|text| Derived::parse(text, &names));
            let derived = derived
                .collect::<Result<Vec<_>, _>>()
                .map_err(|why| at(".set", why))?;
            let limits = Limits {
                unconverged: spec.unconverged,
                residual: spec.residual,
            };
            let mut launcher = Launcher::new(&case, &set, program.plugins.clone(), folder, limits)?;
            launcher.threads = spec.threads;
            let middle = bounds.values(&vec![0.5; names.len()]);
            let sets = changes(&keys, &derived, &middle)?;
            let loaded = load(&case, &[set, sets].concat())?;
            let scene = loaded.build(search)?;
            (program.check_names)(&loaded, &scene)?;
            let matters = seed_matters(&loaded, &scene, search)?;
            random |= matters;
            launcher.perturbation = (!matters).then_some(Perturbation {
                first: loaded.case.seed,
            });
            let (output, measurement) = match test {
                TestSpec::Curve {
                    measured: from,
                    model,
                    ..
                } => {
                    let columns = columns(&loaded.case, &scene);
                    let made = Model::new(model, &columns)
                        .map_err(|(key, why)| at(&format!(".model.{key}"), why))?;
                    let (curve, reach) =
                        measured::read(name, from, &read.beside(&from.file), model.along)?;
                    (Output::Curve(Box::new(made.reaching(reach))), curve)
                }
                TestSpec::Value {
                    output,
                    measured,
                    sigma,
                    ..
                } => {
                    let quantity = Quantity::parse(output).map_err(|why| at(".output", why))?;
                    let offer = match &scene {
                        Scene::Dim2(built) => Offer::of(&loaded.case, built),
                        Scene::Dim3(built) => Offer::of(&loaded.case, built),
                    };
                    offer.check(&quantity).map_err(|why| at(".output", why))?;
                    let single = Measurement {
                        name: name.to_owned(),
                        x: vec![0.0],
                        y: vec![*measured],
                        sigma: vec![*sigma],
                        weight: 1.0,
                    };
                    (Output::Value(quantity), single)
                }
            };
            measurements.push(measurement);
            tests.push(Test {
                launcher,
                seed: loaded.case.seed,
                derived,
                output,
            });
        }
        let target = Target::new(measurements).map_err(|e| FitError::Usage(e.to_string()))?;
        let target = if spec.balanced {
            target.balanced()
        } else {
            target
        };
        let tests = Self {
            target,
            bounds,
            random,
            specimen_scatters: spec.specimen_scatters,
            keys,
            tests,
            limit: None,
        };
        tests.check_ends(read, search)?;
        Ok(tests)
    }

    /// Refuses a range whose ends a case does not take.
    fn check_ends(&self, read: &ReadFit, search: &SearchPath) -> Result<(), FitError> {
        for (p, parameter) in self.bounds.parameters().iter().enumerate() {
            for end in [0.0, 1.0] {
                let mut place = vec![0.5; self.bounds.len()];
                place[p] = end;
                let values = self.bounds.values(&place);
                for test in &self.tests {
                    let sets = changes(&self.keys, &test.derived, &values)?;
                    let sets = [test.launcher.sets.clone(), sets].concat();
                    load(&test.launcher.case, &sets)
                        .and_then(|loaded| loaded.build(search))
                        .map_err(|e| {
                            e.note(format!(
                                "with `{}` at an end of its range in {}",
                                parameter.name,
                                read.path.display()
                            ))
                        })?;
                }
            }
        }
        Ok(())
    }

    /// Runs points of parameter values, each with these seeds, and with the step of the cases over `finer`; a row of samples per
    /// point. None is left out, except those that `stop` prevents, which have no sample.
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
    ) -> Result<Vec<Vec<Option<Sample>>>, FitError> {
        let mut items = Vec::new();
        for point in points {
            for seed in seeds.clone() {
                for test in &self.tests {
                    items.push((point, seed, test));
                }
            }
        }
        let work = |(point, seed, test): &(&Vec<f64>, u64, &Test)| {
            let curve = test.run(&self.keys, point, *seed, finer, self.limit, stop)?;
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

    /// The values of all tests for one seed, from what each of them gave.
    fn sample(&self, runs: &[Option<Option<RunCurve>>]) -> Option<Sample> {
        let mut curves = Vec::new();
        for one in runs {
            match one.as_ref()?.as_ref()? {
                Ok(curve) => curves.push(curve),
                Err(why) => {
                    return Some(Sample {
                        values: Err(why.clone()),
                    });
                }
            }
        }
        let curves: Vec<Curve<'_>> = curves.iter().map(|c| Curve { x: &c.0, y: &c.1 }).collect();
        let values = self.target.simulated(&curves).map_err(|e| e.to_string());
        Some(Sample { values })
    }

    /// The curve of a test from a run that was made.
    pub fn curve(&self, test: usize, values: &[f64], seed: u64) -> Option<(Vec<f64>, Vec<f64>)> {
        let stop = AtomicBool::new(false);
        let curve = self.tests[test]
            .run(&self.keys, values, seed, 1, None, &stop)
            .ok()??;
        curve.ok()
    }

    /// The `--set` arguments of a test for values of the parameters.
    pub fn sets(&self, test: usize, values: &[f64]) -> Vec<String> {
        let test = &self.tests[test];
        let own = changes(&self.keys, &test.derived, values).unwrap_or_default();
        [test.launcher.sets.clone(), own].concat()
    }

    /// The case of a test.
    pub fn case(&self, test: usize) -> &Path {
        &self.tests[test].launcher.case
    }
}

/// A curve, or why a run gave none.
type RunCurve = Result<(Vec<f64>, Vec<f64>), String>;

impl Test {
    /// One run, with its step over `finer` and rows at the same times; `None` if it was interrupted.
    fn run(
        &self,
        keys: &[Vec<String>],
        values: &[f64],
        seed: u64,
        finer: u32,
        limit: Option<Duration>,
        stop: &AtomicBool,
    ) -> Result<Option<RunCurve>, RunsError> {
        let mut sets = match changes(keys, &self.derived, values) {
            Ok(sets) => sets,
            Err(why) => return Ok(Some(Err(why.to_string()))),
        };
        let whole = [self.launcher.sets.clone(), sets.clone()].concat();
        let case = match load(&self.launcher.case, &whole) {
            Ok(loaded) => loaded.case,
            Err(why) => return Ok(Some(Err(why.to_string()))),
        };
        let step = case.time.step / f64::from(finer);
        if finer > 1 {
            let every = case.output.every * u64::from(finer);
            sets.push(format!("time.step={step:e}"));
            sets.push(format!("output.every={every}"));
        }
        let limit = limit.map(|l| l * finer);
        let seed = self.seed.wrapping_add(seed);
        let deadline = Instant::now() + FOREVER;
        let ended = self.launcher.run(&sets, seed, deadline, limit, stop)?;
        let Ended::Finished(run) = ended else {
            return Ok(None);
        };
        if let Status::Slow(s) = run.status {
            return Ok(Some(Err(format!("it took more than {s:.0} s"))));
        }
        if let Some(why) = run.status.failure() {
            return Ok(Some(Err(why)));
        }
        let place = self.launcher.place(&sets, seed);
        Ok(Some(match &self.output {
            Output::Curve(model) => model.curve(&place.join("statistics.csv"), step),
            Output::Value(quantity) => match quantity.read(&summary(&place), &place) {
                Some(value) => Ok((vec![0.0], vec![value])),
                None => Err(format!("it has no value of {}", quantity.name)),
            },
        }))
    }
}

/// The changes of a case for values of the parameters.
fn changes(
    keys: &[Vec<String>],
    derived: &[Derived],
    values: &[f64],
) -> Result<Vec<String>, FitError> {
    let mut sets = Vec::new();
    for (keys, value) in keys.iter().zip(values) {
        let text = number(*value);
        // A field of floats takes a number with a point.
        let text = if text.contains(['.', 'e']) {
            text
        } else {
            format!("{text}.0")
        };
        sets.extend(keys.iter().map(|key| format!("{key}={text}")));
    }
    let known: Vec<Option<f64>> = values.iter().copied().map(Some).collect();
    for one in derived {
        sets.push(one.set(&known).map_err(FitError::Usage)?);
    }
    Ok(sets)
}

/// The region of the parameters.
fn bounds(read: &ReadFit) -> Result<Bounds, FitError> {
    let spec = &read.spec;
    let parameters = spec.parameters.iter().map(|p| Parameter {
        name: p.name.clone(),
        scale: match p.scale {
            RangeScale::Log => Scale::Logarithmic {
                from: p.low,
                to: p.high,
            },
            _ => Scale::Linear {
                from: p.low,
                to: p.high,
            },
        },
    });
    let place = |name: &String| {
        let place = spec.parameters.iter().position(|p| p.name == *name);
        place.ok_or_else(|| {
            read.source
                .error_at("order", format!("`{name}` is no parameter"))
        })
    };
    let orders: Result<Vec<(usize, usize)>, fretwork_scene::InputError> = spec
        .order
        .iter()
        .map(|(a, b)| Ok((place(a)?, place(b)?)))
        .collect();
    let bounds = Bounds::new(parameters.collect(), &orders?);
    bounds.map_err(|e| read.source.error_at("parameters", e.to_string()).into())
}
