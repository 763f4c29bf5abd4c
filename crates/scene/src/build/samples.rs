//! Samples that are generated at random, and grains read from tables.

use super::grains::{MAX_GENERATED, MAX_READ, NewBall};
use super::{Builder, Origin, components};
use crate::sample::deposit::deposit_between;
use crate::sample::sizes::Sizes;
use crate::sample::spec::{Counted, CsvSpec, DepositSpec, SizeSpec};
use crate::sample::table::Table;
use crate::source::{InputError, ValidationError};

impl Builder<'_> {
    /// Makes a random deposit.
    pub(super) fn deposit(
        &mut self,
        k: usize,
        spec: &DepositSpec,
    ) -> Result<Vec<NewBall>, InputError> {
        let here = format!("grains.{k}");
        let of = self.material(&format!("{here}.material"), &spec.material)?;
        let sizes = self.sizes(&format!("{here}.sizes"), &spec.sizes)?;
        let low = self.corner(&format!("{here}.low"), &spec.low)?;
        let high = self.corner(&format!("{here}.high"), &spec.high)?;
        if (0..self.dimension()).any(|k| high[k] <= low[k]) {
            let message = "each number must be greater than that of `low`";
            return Err(self.fail(format!("{here}.high"), message));
        }
        let path = format!("{here}.count");
        self.few_enough(&path, spec.count, MAX_GENERATED)?;
        let periodic = self.assembly.periodic();
        let seed = self.case.seed.wrapping_add(k as u64);
        let corners = [low.into(), high.into()];
        let deposited = deposit_between(
            self.dimension(),
            spec.count,
            &sizes,
            corners,
            periodic,
            seed,
        );
        let placed = deposited.grains.len();
        if placed < spec.count {
            let message = format!(
                "only {placed} of {} grains fit: together they would take {:.0} % of the box, while grains \
                 placed at random fit up to about {} %",
                spec.count,
                100.0 * deposited.filling,
                if self.dimension() == 2 { 50 } else { 35 }
            );
            let fault = ValidationError::new(path, message);
            let advice = "a larger box, smaller grains or fewer; a `Lattice` is denser";
            return Err(self.source.locate(fault.expected(advice)));
        }
        self.samples.push(format!(
            "{here}: {placed} grains placed at random without overlaps, {:.1} % of their box",
            100.0 * deposited.filling
        ));
        let seeds = deposited.grains.into_iter();
        Ok(seeds
            .map(|(at, r)| NewBall::at_rest(at.into(), r, of, Origin::Grain(k, None)))
            .collect())
    }

    fn sizes(&self, here: &str, spec: &SizeSpec) -> Result<Sizes, InputError> {
        let (radius, exponent, by) = match spec {
            SizeSpec::Uniform { radius, by } => (*radius, 0.0, *by),
            SizeSpec::PowerLaw {
                exponent,
                radius,
                by,
            } => (*radius, *exponent, *by),
            SizeSpec::Sieve { file } => return self.sieve(&format!("{here}.file"), file),
        };
        for r in [radius.0, radius.1] {
            self.radius(&format!("{here}.radius"), r)?;
        }
        if radius.1 < radius.0 {
            let message = "the smallest radius comes first";
            return Err(self.fail(format!("{here}.radius"), message));
        }
        if exponent.is_nan() || exponent.abs() > 20.0 {
            let fault = ValidationError::new(format!("{here}.exponent"), format!("got {exponent}"));
            let expected = "a number between -20 and 20";
            return Err(self.source.locate(fault.expected(expected)));
        }
        let steeper = match by {
            Counted::Number => 0.0,
            Counted::Mass => self.dimension() as f64,
        };
        Ok(Sizes::power(radius, exponent + steeper))
    }

    fn sieve(&self, here: &str, file: &str) -> Result<Sizes, InputError> {
        let table = Table::read(&self.folder.join(file), &["size", "passing"], &[])
            .map_err(|e| self.source.named_at(here, e))?;
        let (size, passing) = (table.column("size"), table.column("passing"));
        let mut curve: Vec<(f64, f64)> = Vec::new();
        for row in 0..table.len() {
            let (d, p) = (table.value(row, size), table.value(row, passing));
            let fault = match curve.last() {
                _ if d <= 0.0 => Some(format!("a size must be positive, got {d}")),
                _ if !(0.0..=1.0).contains(&p) => Some(format!(
                    "`passing` is a fraction of the mass, 0 to 1, got {p}; divide percentages by 100"
                )),
                None if p != 0.0 => Some(format!(
                    "begin with the size that nothing passes: the first `passing` must be 0, got {p}"
                )),
                Some((r, _)) if d <= 2.0 * r => {
                    Some("sizes must rise from line to line".to_owned())
                }
                Some((_, before)) if p < *before => {
                    Some("`passing` must not fall from line to line".to_owned())
                }
                _ if row + 1 == table.len() && p != 1.0 => Some(format!(
                    "end with the size that everything passes: the last `passing` must be 1, got {p}"
                )),
                _ => None,
            };
            if let Some(fault) = fault {
                return Err(table.fail(row, fault));
            }
            curve.push((0.5 * d, p));
        }
        Ok(Sizes::sieve(&curve, self.dimension()))
    }

    /// Reads the grains of a table.
    pub(super) fn grains_of_csv(
        &mut self,
        k: usize,
        spec: &CsvSpec,
    ) -> Result<Vec<NewBall>, InputError> {
        let of = self.material(&format!("grains.{k}.material"), &spec.material)?;
        let place = &["x", "y", "z"][..self.dimension()];
        let moving = &["velocity_x", "velocity_y", "velocity_z"][..self.dimension()];
        let turning: &[&str] = if self.dimension() == 2 {
            &["spin"]
        } else {
            &["spin_x", "spin_y", "spin_z"]
        };
        let required = [place, &["radius"]].concat();
        let optional = [moving, turning].concat();
        let table = Table::read(&self.folder.join(&spec.file), &required, &optional)
            .map_err(|e| self.source.named_at(&format!("grains.{k}.file"), e))?;
        self.few_enough(&format!("grains.{k}.file"), table.len(), MAX_READ)?;
        let columns = |names: &[&str]| names.iter().map(|n| table.column(n)).collect::<Vec<_>>();
        let (place, moving, turning) = (columns(place), columns(moving), columns(turning));
        let radius = table.column("radius");
        let mut found = Vec::with_capacity(table.len());
        for row in 0..table.len() {
            let values = |columns: &[Option<usize>]| {
                let values = columns.iter().map(|c| table.value(row, *c));
                values.collect::<Vec<f64>>()
            };
            let r = table.value(row, radius);
            if r <= 0.0 {
                return Err(table.fail(row, format!("a radius must be positive, got {r}")));
            }
            let mut seed =
                NewBall::at_rest(components(&values(&place)), r, of, Origin::Grain(k, None));
            seed.start.velocity = components(&values(&moving)).into();
            seed.start.spin = self.about_axes(components(&values(&turning)).into());
            found.push(seed);
        }
        let file = &spec.file;
        self.samples
            .push(format!("grains.{k}: {} grains of {file}", found.len()));
        Ok(found)
    }
}
