//! Comparison of two texts by content: comments, white space and the format of numbers are ignored.

use super::Source;
use super::tree::{Group, Node, Shape, ValueKind, join_path};

/// A place where two texts differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The dotted path.
    pub path: String,
    /// The value in the first text, if any.
    pub one: Option<String>,
    /// The value in the second text, if any.
    pub other: Option<String>,
}

/// Returns the first difference between two texts, except below the dotted paths in `but`.
pub fn first_difference(one: &Source, other: &Source, but: &[&str]) -> Option<Difference> {
    let mut path = Vec::new();
    let nodes = [&one.tree().root, &other.tree().root].map(Option::as_ref);
    compare([one.text(), other.text()], nodes, but, &mut path)
}

fn compare(
    texts: [&str; 2],
    nodes: [Option<&Node>; 2],
    but: &[&str],
    path: &mut Vec<String>,
) -> Option<Difference> {
    let here = join_path(path);
    if but.contains(&here.as_str()) {
        return None;
    }
    let differ = |path: &[String]| {
        let text_of = |k: usize| nodes[k].map(|n| short(&texts[k][n.span.clone()]));
        Some(Difference {
            path: join_path(path),
            one: text_of(0),
            other: text_of(1),
        })
    };
    let [Some(a), Some(b)] = nodes else {
        return match nodes {
            [None, None] => None,
            // A group that contains only ignored values equals an absent one.
            [a, b] => {
                let holds = |p: &&str| p.strip_prefix(&here).is_some_and(|r| r.starts_with('.'));
                let group = a.or(b).and_then(Node::group);
                match group.filter(|g| plain(g) && but.iter().any(holds)) {
                    None => differ(path),
                    Some(group) => group.entries.iter().find_map(|e| {
                        let side = usize::from(a.is_none());
                        let key = e.key.clone().map(|r| texts[side][r].to_owned());
                        let value = |k: usize| (k == side).then_some(&e.value);
                        path.push(key.unwrap_or_default());
                        let found = compare(texts, [value(0), value(1)], but, path);
                        path.pop();
                        found
                    }),
                }
            }
        };
    };
    let (Some(one), Some(other)) = (a.group(), b.group()) else {
        return if alike(texts, [a, b]) {
            None
        } else {
            differ(path)
        };
    };
    let name = |text: &str, g: &Group| g.name.clone().map(|r| text[r].to_owned());
    let other_shape = one.shape != other.shape && !(plain(one) && plain(other));
    if other_shape || name(texts[0], one) != name(texts[1], other) {
        return differ(path);
    }
    let keys = |text: &str, g: &Group| -> Vec<String> {
        let key = |(k, e): (usize, &super::Entry)| match &e.key {
            Some(range) if matches!(g.shape, Shape::Struct | Shape::Map) => {
                text[range.clone()].trim_matches('"').to_owned()
            }
            _ => k.to_string(),
        };
        g.entries.iter().enumerate().map(key).collect()
    };
    let (here, there) = (keys(texts[0], one), keys(texts[1], other));
    let new = there.iter().filter(|k| !here.contains(k));
    for key in here.iter().chain(new) {
        let value = |keys: &[String], g: &'_ Group| {
            keys.iter()
                .position(|k| k == key)
                .map(|at| g.entries[at].value.clone())
        };
        let (a, b) = (value(&here, one), value(&there, other));
        path.push(key.clone());
        let found = compare(texts, [a.as_ref(), b.as_ref()], but, path);
        path.pop();
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Whether a group has named fields, or is empty.
fn plain(group: &Group) -> bool {
    group.shape == Shape::Struct || (group.shape == Shape::Tuple && group.entries.is_empty())
}

/// Whether two leaf values are equal.
fn alike(texts: [&str; 2], nodes: [&Node; 2]) -> bool {
    let [a, b] = [0, 1].map(|k| &texts[k][nodes[k].span.clone()]);
    let number = |text: &str| text.replace('_', "").parse::<f64>().ok();
    match (&nodes[0].kind, &nodes[1].kind) {
        (ValueKind::Number, ValueKind::Number) => {
            let same = number(a).zip(number(b));
            a == b || same.is_some_and(|(x, y)| x.to_bits() == y.to_bits())
        }
        _ => a == b,
    }
}

/// A value, shortened for a message.
fn short(text: &str) -> String {
    const MAX_LENGTH: usize = 48;
    let line: String = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= MAX_LENGTH {
        return line;
    }
    line.chars().take(MAX_LENGTH).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(one: &str, other: &str) -> Option<(String, Option<String>, Option<String>)> {
        let [a, b] = [one, other].map(|t| Source::from_text("a.ron", t));
        first_difference(&a, &b, &["out.often"]).map(|d| (d.path, d.one, d.other))
    }

    #[test]
    fn what_does_not_count_may_be_there_or_not() {
        let often = "(seed: 3, out: (often: Steps(3), wide: 4))";
        assert_eq!(between(often, &often.replace("Steps(3)", "Never")), None);
        assert_eq!(between(often, "(seed: 3, out: (wide: 4))"), None);
        assert_eq!(between("(seed: 3)", "(seed: 3, out: (often: Never))"), None);
        assert_eq!(between("(seed: 3, out: ())", "(seed: 3)"), None);
        let wide = |a: Option<&str>, b: Option<&str>| {
            Some((
                "out.wide".to_owned(),
                a.map(str::to_owned),
                b.map(str::to_owned),
            ))
        };
        assert_eq!(between(often, "(seed: 3)"), wide(Some("4"), None));
        assert_eq!(between("(seed: 3)", often), wide(None, Some("4")));
        assert!(between("(seed: 3, often: 1)", "(seed: 3)").is_some());
    }

    #[test]
    fn blanks_comments_and_how_a_number_is_written_do_not_count() {
        let one = "(time: (end: 0.001, step: 1e-6), list: [1, 2], word: Auto)";
        let other =
            "(\n // the end\n time: (end: 1e-3, step: 0.000001),\n list: [1, 2,],\n word: Auto,\n)";
        assert_eq!(between(one, other), None);
    }

    #[test]
    fn the_first_difference_is_told_with_its_path() {
        let some = |path: &str, a: Option<&str>, b: Option<&str>| {
            Some((path.to_owned(), a.map(str::to_owned), b.map(str::to_owned)))
        };
        let one = "(time: (end: 1.0), bodies: [(name: \"a\"), (name: \"b\")])";
        assert_eq!(
            between(one, &one.replace("1.0", "2.0")),
            some("time.end", Some("1.0"), Some("2.0"))
        );
        assert_eq!(
            between(one, &one.replace("\"b\"", "\"c\"")),
            some("bodies.1.name", Some("\"b\""), Some("\"c\""))
        );
        assert_eq!(
            between(one, &one.replace("(time:", "(seed: 3, time:")),
            some("seed", None, Some("3"))
        );
        assert_eq!(
            between(one, &one.replace(", (name: \"b\")", "")),
            some("bodies.1", Some("(name: \"b\")"), None)
        );
    }
}
