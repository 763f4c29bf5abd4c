//! Paths of values in a summary.

use serde_json::Value;

/// Present and earlier names of groups of a summary.
const RENAMED: [[&str; 2]; 1] = [["step_size", "haste"]];

/// Returns the present path for a path that earlier versions of the program wrote.
pub fn renamed(path: &str) -> Option<String> {
    let (group, rest) = path.split_once('.').unwrap_or((path, ""));
    let [now, _] = RENAMED.iter().find(|[_, before]| *before == group)?;
    let dot = if rest.is_empty() { "" } else { "." };
    Some(format!("{now}{dot}{rest}"))
}

/// Returns a value of a summary by its path, also in summaries of versions with another name of its
/// group.
pub fn find<'a>(summary: &'a Value, path: &str) -> Option<&'a Value> {
    let before = RENAMED.iter().find_map(|[now, before]| {
        let rest = path.strip_prefix(now)?;
        (rest.is_empty() || rest.starts_with('.')).then(|| format!("{before}{rest}"))
    });
    at_path(summary, path).or_else(|| at_path(summary, &before?))
}

fn at_path<'a>(summary: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').try_fold(summary, |at, part| match at {
        Value::Array(list) => list.get(part.parse::<usize>().ok()?),
        _ => at.get(part),
    })
}

/// Whether a path is of a pattern, in which `*` stands for every place of a list.
pub(super) fn matches(pattern: &str, path: &str) -> bool {
    let (mut a, mut b) = (pattern.split('.'), path.split('.'));
    loop {
        match (a.next(), b.next()) {
            (None, None) => return true,
            (Some(x), Some(y)) if x == y || (x == "*" && y.parse::<usize>().is_ok()) => {}
            _ => return false,
        }
    }
}
