//! Combinations of levels that are cheaper than the case's own, first those predicted, from the
//! single parameters, to meet the wanted error.

use super::combination::Combination;
use super::compare::Row;
use super::frontier::frontier;
use super::output::ErrorTarget;
use super::plan::Trade;

/// Limit on the number of combinations.
const COMBINATIONS: usize = 8;

impl Trade {
    /// Returns settings that change several parameters to levels that are cheaper individually.
    pub(super) fn combinations(&self) -> Vec<Combination> {
        let found = self.compare();
        let own = Combination::own(&self.parameters);
        let Some(base) = found
            .rows
            .iter()
            .find(|r| r.setting == own && r.failed.is_none())
        else {
            return Vec::new();
        };
        // These are signed errors as fractions of the wanted error, with intervals.
        let scaled = |row: &Row| -> Option<Vec<(f64, f64)>> {
            let each = row.errors.iter().zip(&self.outputs).map(|(e, o)| {
                let (ErrorTarget::Relative(w) | ErrorTarget::Absolute(w)) = o.wanted;
                let e = e.as_ref()?;
                Some((e.error.mean / w, e.error.half_width? / w))
            });
            each.collect()
        };
        let Some(start) = scaled(base) else {
            return Vec::new();
        };
        type Move = (usize, f64, Vec<f64>);
        let mut moves: Vec<Vec<Move>> = Vec::new();
        for k in 0..self.parameters.len() {
            let mut here: Vec<Move> = vec![(own.0[k], 1.0, vec![0.0; start.len()])];
            for row in &found.rows {
                let alone = row.setting.changed(&self.parameters) == [k] && row.failed.is_none();
                let cheaper = row.seconds < 0.95 * base.seconds;
                if let (true, Some(errors)) = (alone && cheaper, scaled(row)) {
                    let moved = errors.iter().zip(&start).map(|(e, s)| e.0 - s.0);
                    here.push((
                        row.setting.0[k],
                        row.seconds / base.seconds,
                        moved.collect(),
                    ));
                }
            }
            // The cheapest levels of a parameter.
            here[1..].sort_by(|a, b| a.1.total_cmp(&b.1));
            here.truncate(4);
            moves.push(here);
        }
        let mut all: Vec<(Combination, f64, Vec<f64>)> =
            vec![(own.clone(), base.seconds, vec![0.0; start.len()])];
        for (k, levels) in moves.iter().enumerate() {
            all = all
                .iter()
                .flat_map(|(s, cost, moved)| {
                    levels.iter().map(move |(level, ratio, more)| {
                        let sum = moved.iter().zip(more).map(|(a, b)| a + b).collect();
                        (s.with(k, *level), cost * ratio, sum)
                    })
                })
                .collect();
            all.truncate(20_000);
        }
        let mut points: Vec<(Combination, f64, f64)> = all
            .into_iter()
            .filter(|(s, ..)| s.changed(&self.parameters).len() > 1)
            .map(|(s, cost, moved)| {
                let worst = moved
                    .iter()
                    .zip(&start)
                    .map(|(m, (e, h))| (e + m).abs() + h);
                (s, cost, worst.fold(0.0, f64::max))
            })
            .collect();
        let plane: Vec<(f64, f64)> = points.iter().map(|p| (p.1, p.2)).collect();
        let on = frontier(&plane);
        let mut kept = on.into_iter();
        points.retain(|_| kept.next().unwrap_or(false));
        // First come those predicted to meet the wanted error, cheapest first; then the nearest to
        // it.
        points.sort_by(|a, b| {
            let key = |p: &(Combination, f64, f64)| if p.2 <= 1.0 { (0, p.1) } else { (1, p.2) };
            let (x, y) = (key(a), key(b));
            x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
        });
        points.into_iter().map(|p| p.0).take(COMBINATIONS).collect()
    }
}
