//! Full factorial designs: every combination of the levels of all factors.

use super::DesignError;

/// Largest number of points of a grid.
pub const MAX_POINTS: usize = 1_000_000;

/// Returns all combinations of the levels of factors, of which factor i has `levels[i]`: one row of
/// level numbers per combination. The first factor varies slowest, as in nested loops in the order
/// of the factors. Without factors there is one empty row; a factor without levels gives no rows.
///
/// # Errors
///
/// There are more than [`MAX_POINTS`] combinations.
pub fn full_factorial(levels: &[usize]) -> Result<Vec<Vec<usize>>, DesignError> {
    let points: f64 = levels.iter().map(|l| *l as f64).product();
    if points > MAX_POINTS as f64 {
        return Err(DesignError::Grid {
            points,
            most: MAX_POINTS,
        });
    }
    let mut rows = vec![Vec::with_capacity(levels.len())];
    for &count in levels {
        rows = rows
            .iter()
            .flat_map(|row: &Vec<usize>| {
                (0..count).map(move |level| {
                    let mut longer = row.clone();
                    longer.push(level);
                    longer
                })
            })
            .collect();
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_factor_varies_slowest() {
        let rows = full_factorial(&[2, 3]).unwrap();
        let expected = [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]];
        assert_eq!(rows, expected.map(|r| r.to_vec()));
    }

    #[test]
    fn limits() {
        assert_eq!(full_factorial(&[]).unwrap(), vec![Vec::<usize>::new()]);
        assert!(full_factorial(&[3, 0]).unwrap().is_empty());
        assert_eq!(full_factorial(&[4, 5, 6]).unwrap().len(), 120);
        let error = full_factorial(&[1000, 1000, 1000]).unwrap_err();
        assert!(error.to_string().contains("1e9 combinations"), "{error}");
    }
}
