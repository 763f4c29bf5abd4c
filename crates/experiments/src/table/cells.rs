//! Texts in cells of CSV files, which spreadsheets open.

/// Characters with which a formula begins.
const FORMULA: [char; 7] = ['=', '+', '-', '@', '\t', '\r', '\n'];

/// Returns whether a text begins like a formula, also after apostrophes, which would be removed.
fn begins(text: &str) -> bool {
    text.trim_start_matches('\'').starts_with(FORMULA)
}

/// Returns a text as a cell that no spreadsheet interprets as a formula: a text that begins like a
/// formula, and is not a number, gets an apostrophe.
pub fn guarded(text: &str) -> String {
    let formula = begins(text) && text.parse::<f64>().is_err();
    if formula {
        format!("'{text}")
    } else {
        text.to_owned()
    }
}

/// The text of a [guarded] cell.
pub fn unguarded(cell: &str) -> &str {
    let text = cell.strip_prefix('\'');
    text.filter(|text| begins(text)).unwrap_or(cell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_no_formula_and_reads_back() {
        for text in [
            "=1+1", "+x", "-x", "@a", "\t=1", "\n=1", "\r\nx", "'=a", "''=a", "'-1",
        ] {
            let cell = guarded(text);
            assert!(cell.starts_with('\''), "{text}");
            assert_eq!(unguarded(&cell), text);
        }
        for text in ["-1.5e-3", "+2", "coulomb", "'quoted'", ""] {
            assert_eq!(guarded(text), text);
            assert_eq!(unguarded(text), text);
        }
    }
}
