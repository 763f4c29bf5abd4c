//! The option `--vary key.path=a,b,c`: any value of the case with listed levels.

use super::ordered::{steps, tolerances};
use super::varied::{ParameterEffect, Varied};
use crate::factor::Level;
use crate::{Error, load};
use fretwork_scene::{LoadedCase, invisible_characters};

/// Parses `key.path=a,b,c`: commas within brackets or quotes belong to a value.
pub(super) fn listed(loaded: &LoadedCase, tolerance: f64, argument: &str) -> Result<Varied, Error> {
    let form = || {
        Error::Usage(format!(
            "--vary {argument}: expected key.path=a,b,c with two values or more, the finest first"
        ))
    };
    let (key, values) = argument.split_once('=').ok_or_else(form)?;
    const RECORDED: [&str; 5] = ["frames", "views", "figures", "every", "checkpoint"];
    let recorded = |k: &str| {
        k.strip_prefix("output.")
            .is_some_and(|f| RECORDED.contains(&f))
    };
    if key.trim() == "seed" || recorded(key.trim()) {
        return Err(Error::Usage(format!(
            "--vary {}: the command sets this itself, or it changes the output files and not the computation; for more seeds give --seeds",
            key.trim()
        )));
    }
    let values = split(values);
    if key.trim().is_empty() || values.len() < 2 || values.iter().any(String::is_empty) {
        return Err(form());
    }
    let keys = [key.trim().to_owned()];
    let level = |value: &String| Level {
        label: value.clone(),
        ..Level::of(&keys, value)
    };
    let levels: Vec<Level> = values.iter().map(level).collect();
    let before = loaded.source.sets();
    // The texts of the case before and after are compared: a value without effect is the case's
    // own.
    let (mut own, mut texts) = (None, Vec::new());
    for (k, level) in levels.iter().enumerate() {
        let sets: Vec<String> = before.iter().chain(&level.sets).cloned().collect();
        let text = format!("{:?}", load(&loaded.path, &sets)?.case);
        if let Some(same) = texts.iter().position(|t| *t == text) {
            return Err(Error::Usage(format!(
                "--vary {argument}: {} and {} are the same case; give values that differ",
                levels[same].label, level.label
            )));
        }
        if text == format!("{:?}", loaded.case) {
            own = Some(k);
        }
        texts.push(text);
    }
    // The two parameters whose numeric values have an order.
    let numbers: Vec<f64> = levels.iter().filter_map(|l| l.number).collect();
    let positive = numbers.len() == levels.len() && numbers.iter().all(|x| *x > 0.0);
    if let Some(reason) = invisible_characters(key.trim()) {
        return Err(Error::Usage(format!("--vary {key:?}: {reason}")));
    }
    match key.trim() {
        "time.step" if positive => return Ok(steps(&loaded.case, numbers)),
        "solver.tolerance" if positive => {
            return Ok(tolerances(&loaded.case, tolerance, numbers));
        }
        _ => {}
    }
    Ok(Varied::new(
        key.trim(),
        ParameterEffect::Listed,
        levels,
        own,
    ))
}

fn split(text: &str) -> Vec<String> {
    let (mut parts, mut depth, mut quoted) = (vec![String::new()], 0i32, false);
    for c in text.chars() {
        quoted ^= c == '"';
        match c {
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            ',' if !quoted && depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(last) = parts.last_mut() {
            last.push(c);
        }
    }
    parts.iter().map(|p| p.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_in_brackets_belong_to_a_value() {
        assert_eq!(
            split("Explicit, Implicit(tolerance: 1e-6, max_iterations: 9)"),
            ["Explicit", "Implicit(tolerance: 1e-6, max_iterations: 9)"]
        );
        assert_eq!(split("\"a,b\",[1,2],3"), ["\"a,b\"", "[1,2]", "3"]);
        assert_eq!(split(""), [""]);
    }
}
