//! Suggestion of the candidate that a misspelt name was most probably meant to be.

/// Length above which names are not compared, since the cost is the product of the lengths.
const LONGEST: usize = 64;

/// Returns the candidate nearest to `name`, if it is close enough to suggest.
///
/// Case, underscores, hyphens and spaces are ignored; beyond that one edit (insertion, deletion,
/// substitution, transposition) per three letters is allowed, rounded to the nearest integer.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = fold(name)?;
    candidates
        .into_iter()
        .filter_map(|candidate| {
            let folded = fold(candidate)?;
            let longest = wanted.chars().count().max(folded.chars().count());
            let distance = strsim::damerau_levenshtein(&wanted, &folded);
            let close =
                distance == 0 || (distance < longest && distance <= ((longest + 1) / 3).max(1));
            // The unfolded distance breaks ties such as `Mu` between `mu` and `MU`.
            close.then(|| (distance, strsim::levenshtein(name, candidate), candidate))
        })
        .min_by_key(|&(distance, exact, _)| (distance, exact))
        .map(|(_, _, candidate)| candidate)
}

/// Returns the significant letters in lower case; `None` for an empty or too long name.
fn fold(name: &str) -> Option<String> {
    if name.len() > 4 * LONGEST || name.chars().count() > LONGEST {
        return None;
    }
    let folded: String = name
        .chars()
        .filter(|c| !matches!(c, '_' | '-' | ' '))
        .flat_map(char::to_lowercase)
        .collect();
    (!folded.is_empty()).then_some(folded)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn offers_only_what_is_close() {
        let fields = ["amplitude", "frequency", "mu", "young_modulus"];
        let find = |name| nearest(name, fields.iter().copied());
        assert_eq!(find("amplitud"), Some("amplitude"));
        assert_eq!(find("freqeuncy"), Some("frequency"));
        assert_eq!(find("YoungModulus"), Some("young_modulus"));
        assert_eq!(find("young-modulus"), Some("young_modulus"));
        assert_eq!(find("nu"), Some("mu"));
        assert_eq!(find("q"), None);
        assert_eq!(find("temperature"), None);
        assert_eq!(find(""), None);
        assert_eq!(find("__"), None);
        assert_eq!(find(&"a".repeat(1 << 20)), None);
    }
}
