//! Tests of reading, setting, parsing and pointing.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use serde::Deserialize;

use super::numbers::{Fraction, NonNegative, Positive};
use super::*;

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    loading: Loading,
    bodies: Vec<Body>,
    #[serde(default)]
    interfaces: Vec<Interface>,
    #[serde(default)]
    drive: Option<Drive>,
    #[serde(default)]
    materials: BTreeMap<String, Material>,
    #[serde(default)]
    seed: u32,
    #[serde(default)]
    comment: Option<String>,
    #[serde(default)]
    pressure: Option<Pascal>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Loading {
    amplitude: Positive,
    frequency: f64,
    #[serde(default)]
    phase: Option<f64>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Body {
    name: String,
    mass: Positive,
    #[serde(default)]
    position: Option<(f64, f64)>,
    #[serde(default)]
    shape: Option<Shape2>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
enum Shape2 {
    Disk { radius: Positive },
    Point,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Interface {
    mu: NonNegative,
    #[serde(default)]
    cohesion: Option<String>,
    #[serde(default)]
    share: Option<Fraction>,
}

#[derive(Debug, Deserialize, PartialEq)]
enum Drive {
    Sine(Loading),
    Constant(f64),
    Rest,
}

#[derive(Debug, Deserialize, PartialEq)]
struct Material {
    young: Positive,
}

#[derive(Debug, Deserialize, PartialEq)]
struct Pascal(f64);

const TEXT: &str = r##"#![enable(implicit_some)]
// A comment with a brace { and a bracket ) in it.
Case(
    name: "wheel (on rail) }",
    /* nested /* comment ] */ still */
    loading: Loading(
        amplitude: 1.0e-3, // the stroke (m)
        frequency: 5.0,
    ),
    bodies: [
        (name: "wheel", mass: 2.0, position: (0.0, 1.0), shape: Disk(radius: 0.5)),
        (name: r#"rail "60""#, mass: Some(7.0e3)),
    ],
    interfaces: [(mu: 0.3, cohesion: "none")],
    drive: Some(Sine((amplitude: 2.0, frequency: 1.0))),
    materials: { "steel": (young: 2.1e11), "c.45": (young: 2.0e11) },
)
"##;

/// `TEXT` with the one `Some` that no type asks for taken out.
fn text() -> String {
    TEXT.replace("Some(7.0e3)", "7.0e3")
}

fn source() -> Source {
    Source::from_text("case.ron", text())
}

fn parsed(source: &Source) -> Case {
    source.parse().unwrap()
}

/// The first line of the error of a text with one change.
fn refusal(old: &str, new: &str) -> String {
    assert!(text().contains(old), "no `{old}` to change");
    let changed = Source::from_text("case.ron", text().replace(old, new));
    let error = changed.parse::<Case>().unwrap_err();
    assert!(error.to_string().starts_with(&error.compact()));
    error.compact()
}

#[track_caller]
fn found(source: &Source, path: &str) -> String {
    let parts = tree::split_path(path).unwrap();
    let node = source.tree().find(source.text(), &parts).unwrap();
    source.text()[node.span.clone()].to_owned()
}

#[test]
fn paths_lead_to_values() {
    let source = Source::from_text("case.ron", TEXT);
    assert_eq!(found(&source, "loading.amplitude"), "1.0e-3");
    assert_eq!(found(&source, "name"), "\"wheel (on rail) }\"");
    assert_eq!(found(&source, "bodies.0.mass"), "2.0");
    assert_eq!(found(&source, "bodies.wheel.mass"), "2.0");
    assert_eq!(found(&source, "bodies.wheel.position.1"), "1.0");
    assert_eq!(found(&source, "bodies.wheel.shape.radius"), "0.5");
    assert_eq!(found(&source, "bodies.1.mass"), "Some(7.0e3)");
    assert_eq!(found(&source, "drive.0.amplitude"), "2.0");
    assert_eq!(found(&source, "drive.amplitude"), "2.0");
    assert_eq!(
        found(&source, "drive.0"),
        "(amplitude: 2.0, frequency: 1.0)"
    );
    assert_eq!(found(&source, "materials.steel.young"), "2.1e11");
    assert_eq!(found(&source, "materials.\"c.45\".young"), "2.0e11");
    assert_eq!(source.position_of("loading.amplitude"), Some((7, 20)));
    assert_eq!(source.position_of("loading.nothing"), None);
    assert!(tree::split_path("a..b").is_none());
    assert!(tree::split_path("").is_none());
}

#[test]
fn both_spellings_of_newtype_variants_parse() {
    let drive = |text: &str| {
        let mut source = source();
        source.set(&format!("drive={text}")).unwrap();
        parsed(&source).drive.unwrap()
    };
    let sine = drive("Sine((amplitude: 2, frequency: 1))");
    assert_eq!(sine, drive("Sine(amplitude: 2, frequency: 1)"));
    assert_eq!(drive("Constant(3.0)"), Drive::Constant(3.0));
    assert_eq!(drive("Rest"), Drive::Rest);
}

#[test]
fn set_replaces_values() {
    let mut source = source();
    for set in [
        "loading.amplitude=4",
        "bodies.wheel.shape.radius = 0.25",
        "bodies.1.mass=8",
        "interfaces.0.cohesion=mac",
        "drive.amplitude=9",
        "materials.\"c.45\".young=1e9",
        "pressure=2.5",
        "seed=7",
        "comment=out/run 1",
        "loading.phase=0.5",
    ] {
        source.set(set).unwrap();
    }
    let case = parsed(&source);
    assert_eq!(case.loading.amplitude.get(), 4.0);
    assert_eq!(
        case.bodies[0].shape,
        Some(Shape2::Disk {
            radius: Positive::new(0.25).unwrap()
        })
    );
    assert_eq!(case.bodies[1].mass.get(), 8.0);
    assert_eq!(case.interfaces[0].cohesion.as_deref(), Some("mac"));
    assert!(matches!(&case.drive, Some(Drive::Sine(sine)) if sine.amplitude.get() == 9.0));
    assert_eq!(case.materials["c.45"].young.get(), 1e9);
    assert_eq!(case.pressure, Some(Pascal(2.5)));
    assert_eq!((case.seed, case.loading.phase), (7, Some(0.5)));
    assert_eq!(case.comment.as_deref(), Some("out/run 1"));
    assert_eq!(source.sets().len(), 10);
}

#[test]
fn set_takes_whole_subtrees_and_options() {
    let mut source = source();
    source.set("bodies=[\n(name: \"a\", mass: 1),\n]").unwrap();
    source.set("drive=None").unwrap();
    source.set("interfaces.0.cohesion=None").unwrap();
    source.set("materials.brass=(young: 1e11)").unwrap();
    source.set("bodies.a.mass=3").unwrap();
    source.set("bodies.a.mass=5").unwrap();
    let case = parsed(&source);
    assert_eq!(case.bodies.len(), 1);
    assert_eq!(case.bodies[0].mass.get(), 5.0);
    assert_eq!((case.drive, &case.interfaces[0].cohesion), (None, &None));
    assert_eq!(case.materials["brass"].young.get(), 1e11);
}

#[test]
fn a_new_text_field_needs_no_quotes() {
    let mut source = Source::from_text("case.ron", text().replace(", cohesion: \"none\"", ""));
    source.set("interfaces.0.cohesion=mac").unwrap();
    source.set("name=12").unwrap();
    source.set("comment=true").unwrap();
    let case = parsed(&source);
    assert_eq!(case.interfaces[0].cohesion.as_deref(), Some("mac"));
    assert_eq!(
        (case.name.as_str(), case.comment.as_deref()),
        ("12", Some("true"))
    );
}

#[test]
fn set_fills_empty_groups() {
    #[derive(Debug, Deserialize)]
    struct Empty {
        #[serde(default)]
        a: u8,
        #[serde(default)]
        map: BTreeMap<String, u8>,
    }
    let mut source = Source::from_text("e.ron", "( /* nothing */ )");
    source.set("map={}").unwrap();
    source.set("map.k=2").unwrap();
    source.set("map.l=3").unwrap();
    source.set("a=1").unwrap();
    let empty: Empty = source.parse().unwrap();
    assert_eq!((empty.a, empty.map["k"], empty.map["l"]), (1, 2, 3));
}

#[test]
fn malformed_sets_are_refused() {
    let refused = |set: &str| source().set(set).unwrap_err().compact();
    assert_eq!(
        refused("loading.amplitude"),
        "--set loading.amplitude: error: there is no `=` between a key and a value; expected key.path=value"
    );
    assert!(refused("=3").contains("no key before the `=`"));
    assert!(refused("seed=").contains("no value after the `=`"));
    assert!(refused("a..b=3").contains("a part of the key is empty"));
    assert!(refused("seed=1, name: \"x\"").contains("is not a value"));
    assert!(refused("seed=(1").contains("never closed"));
    assert!(refused("new=(1").contains("never closed"));
    assert!(refused("loading.frequency=1 // x").contains("is not a value"));
    assert!(refused(&format!("seed={}", "[".repeat(200))).contains("too deeply"));
    let parent = refused("loadin.amplitude=3");
    assert!(
        parent.contains("there is no `loadin` in the file"),
        "{parent}"
    );
    assert!(
        parent.ends_with("did you mean `loading.amplitude`?"),
        "{parent}"
    );
    let element = refused("bodies.weel.mass=3");
    assert!(
        element.ends_with("did you mean `bodies.wheel.mass`?"),
        "{element}"
    );
    assert!(refused("bodies.5=3").contains("`bodies` has 2 elements, and no `5`"));
    assert!(refused("seed.x.y=3").contains("there is no `seed`"));
    assert!(refused("loading.frequency.x=3").contains("`loading.frequency` is `5.0`"));
    let broken = Source::from_text("b.ron", "(a: [1, 2)")
        .set("a=1")
        .unwrap_err();
    assert_eq!(broken.position(), Some((1, 10)));
}

#[test]
fn errors_in_sets_name_the_set_and_the_line() {
    let mut source = source();
    source
        .set("bodies.0=(\n name: \"a\",\n mass: -1\n)")
        .unwrap();
    let error = source.parse::<Case>().unwrap_err();
    assert_eq!(error.position(), Some((11, 9)));
    assert!(
        error.compact().contains("(from `--set bodies.0=("),
        "{error}"
    );
    assert!(
        error
            .compact()
            .contains("`bodies.a.mass` must be positive, got -1.0"),
        "{error}"
    );

    // What stands after a value of several lines keeps its own line.
    let mut source = Source::from_text("case.ron", text().replace("mu: 0.3", "mu: -0.3"));
    source.set("bodies=[\n\n\n]").unwrap();
    source.set("loading.phase=1.0").unwrap();
    let error = source.parse::<Case>().unwrap_err();
    assert_eq!(error.position(), Some((14, 23)), "{error}");
    assert_eq!(error.set(), None);

    let mut source = self::source();
    source.set("loading.amplitud=3").unwrap();
    let error = source.parse::<Case>().unwrap_err();
    assert_eq!(error.position(), Some((8, 23)));
    let line = error.compact();
    assert!(
        line.contains("unknown field `amplitud` in Loading (from `--set loading.amplitud=3`)"),
        "{line}"
    );
    assert!(line.ends_with("did you mean `amplitude`?"), "{line}");
    assert!(error.to_string().contains("command line"));

    let mut source = self::source();
    source.set("seed=red").unwrap();
    assert_eq!(source.error_at("seed", "x").set(), Some("seed=red"));
    let line = source.parse::<Case>().unwrap_err().compact();
    assert!(line.contains("found the word `red` (from"), "{line}");
}

#[test]
fn ron_errors_stand_on_the_token() {
    assert_eq!(
        refusal("amplitude: 1.0e-3", "amplitud: 1.0e-3"),
        "case.ron:7:9: error: unknown field `amplitud` in Loading; \
         expected one of `amplitude`, `frequency`, `phase`; did you mean `amplitude`?"
    );
    assert_eq!(
        refusal("amplitude: 1.0e-3", "amplitude: -1e-6"),
        "case.ron:7:20: error: `loading.amplitude` must be positive, got -1e-6"
    );
    assert_eq!(
        refusal("amplitude: 1.0e-3", "amplitude: NaN"),
        "case.ron:7:20: error: `loading.amplitude` is not a number (NaN)"
    );
    assert_eq!(
        refusal("mu: 0.3", "mu: 1e400"),
        "case.ron:14:23: error: `interfaces.0.mu` must be finite, got inf"
    );
    assert_eq!(
        refusal("mu: 0.3", "mu: 0.3, share: 1.5"),
        "case.ron:14:35: error: `interfaces.0.share` must be between 0 and 1, got 1.5"
    );
    assert_eq!(
        refusal("        frequency: 5.0,\n", ""),
        "case.ron:6:14: error: the field `frequency` is missing in Loading"
    );
    assert_eq!(
        refusal("frequency: 5.0", "frequency: \"5.0\""),
        "case.ron:8:20: error: wrong type for `loading.frequency`: \
         found the text `\"5.0\"`; expected a number"
    );
    assert_eq!(
        refusal("name: \"wheel (on rail) }\"", "name: wheel"),
        "case.ron:4:11: error: wrong type for `name`: found the word `wheel`; \
         expected a text in quotes; help"
            .replace("help", "write `\"wheel\"`")
    );
    assert_eq!(
        refusal("Disk(radius", "Dsk(radius"),
        "case.ron:11:65: error: unknown variant `Dsk` in Shape2; \
         expected one of `Disk`, `Point`; did you mean `Disk`?"
    );
    assert_eq!(
        refusal("Disk(radius: 0.5)", "Disk(radus: 0.5)"),
        "case.ron:11:70: error: unknown field `radus` in Disk; \
         expected `radius`; did you mean `radius`?"
    );
    assert_eq!(
        refusal("    drive:", "    name: \"x\",\n    drive:"),
        "case.ron:15:5: error: the field `name` is given twice in Case"
    );
}

#[test]
fn more_ron_errors() {
    let seed = |value: &str| refusal("    drive:", &format!("    seed: {value},\n    drive:"));
    assert!(seed("3.5").starts_with("case.ron:15:11: error: wrong type for `seed`: found the number `3.5`; expected an integer"), "{}", seed("3.5"));
    assert!(
        seed("-3").starts_with("case.ron:15:11: error: the number `-3` is out of range"),
        "{}",
        seed("-3")
    );
    assert!(
        seed("99999999999")
            .starts_with("case.ron:15:11: error: the number `99999999999` is out of range"),
        "{}",
        seed("99999999999")
    );
    assert!(
        seed("[1]").starts_with(
            "case.ron:15:11: error: wrong type for `seed`: found a list; expected an integer"
        ),
        "{}",
        seed("[1]")
    );
    let length = refusal("(0.0, 1.0)", "(0.0)");
    assert!(
        length.starts_with("case.ron:11:46: error: wrong length"),
        "{length}"
    );
    let length = refusal("(0.0, 1.0)", "(0.0, 1.0, 2.0)");
    assert!(
        length.starts_with("case.ron:11:57: error: one value too many"),
        "{length}"
    );
    let sine = refusal("frequency: 1.0", "frequency: 1.0, fase: 2");
    assert!(
        sine.starts_with("case.ron:15:55: error: unknown field `fase` in "),
        "{sine}"
    );
    assert!(sine.ends_with("did you mean `phase`?"), "{sine}");
    let sine = refusal(", frequency: 1.0", "");
    assert!(
        sine.contains("the field `frequency` is missing in "),
        "{sine}"
    );
    let list = refusal(
        "interfaces: [(mu: 0.3, cohesion: \"none\")]",
        "interfaces: 3",
    );
    assert_eq!(
        list,
        "case.ron:14:17: error: wrong type for `interfaces`: found the number `3`; expected a list `[...]`"
    );
    let named = refusal("loading: Loading", "loading: Load");
    assert_eq!(
        named,
        "case.ron:6:14: error: wrong struct name `Load`; expected `Loading(...)` or `(...)`"
    );
    let number = refusal("5.0", "1.2.3");
    assert!(
        number.starts_with(
            "case.ron:8:20: error: wrong type for `loading.frequency`: found the number `1.2.3`"
        ),
        "{number}"
    );
}

#[test]
fn malformed_text_points_at_its_cause() {
    let error = |old, new| refusal(old, new);
    // What is read before the fault is noticed may be refused first: the fault is a note then.
    let open = text().replace("frequency: 5.0,\n    ),", "frequency: 5.0,\n    ");
    let open = Source::from_text("case.ron", open);
    let shown = open.parse::<Case>().unwrap_err().to_string();
    assert!(
        shown.starts_with("case.ron:10:5: error: unknown field `bodies` in Loading"),
        "{shown}"
    );
    assert!(
        shown.contains("3:5: this `(` is never closed by `)`"),
        "{shown}"
    );
    let open = text().replace("shape: Disk(radius: 0.5))", "shape: Disk(radius: 0.5)");
    let open = Source::from_text("case.ron", open);
    let shown = open.parse::<Case>().unwrap_err().to_string();
    assert!(
        shown.contains("13:5: `]` does not close the `(` before it"),
        "{shown}"
    );
    assert!(shown.contains("12 │"), "{shown}");
    assert!(
        error("1.0e-3,", "1.0e-3").contains("case.ron:8:9: error: a comma is missing before this")
    );
    assert!(error("frequency: 5.0", "frequency 5.0").starts_with("case.ron:8:"));
    assert!(error("frequency: 5.0", "frequency: ").contains("no value stands after `frequency:`"));
    assert!(
        error("*/ still */", "*/ still")
            .contains("case.ron:5:5: error: this comment is never closed")
    );
    assert!(error("\"steel\"", "\"steel").starts_with("case.ron:16:"));
    assert!(error("},\n)", "},\n) x").contains("unexpected text after the end"));
}

#[test]
fn columns_count_characters_and_crlf_is_one_line_end() {
    let text = "(\r\n  name: \"Räder µ\", loading: 3,\r\n)\r\n";
    let error = Source::from_text("ä.ron", text)
        .parse::<Case>()
        .unwrap_err();
    assert_eq!(error.position(), Some((2, 29)));
    assert_eq!(&text[error.span().unwrap()], "3");
    let shown = error.to_string();
    assert!(shown.starts_with("ä.ron:2:29: error:"), "{shown}");
    assert!(shown.contains("ä.ron:2:29 ]"), "{shown}");
    assert!(!shown.contains('\r') && !shown.contains('\x1b'));
    assert!(error.render(true).contains('\x1b'));

    let text = format!("\u{feff}{}", self::text().replace('\n', "\r\n"));
    assert_eq!(
        Source::from_text("bom.ron", text).parse::<Case>().unwrap(),
        parsed(&source())
    );
}

#[test]
fn error_at_points_at_the_value_or_its_parent() {
    let source = source();
    let error = source
        .error_at("bodies.wheel.mass", "is too heavy")
        .expected("at most 1")
        .help("use less");
    assert_eq!(
        error.compact(),
        "case.ron:11:31: error: is too heavy; expected at most 1; use less"
    );
    assert_eq!(source.error_at("loading", "x").position(), Some((6, 14)));
    let error = source.error_at("loading.phase.deep", "x");
    assert_eq!(error.position(), Some((6, 14)));
    assert!(error.to_string().contains("its default stands"));
    assert_eq!(source.error_at("nothing", "x").position(), Some((3, 1)));
    assert_eq!(source.error_at("", "x").position(), Some((3, 1)));
    let fault = Fault::new("mass", "x")
        .nearest(Some("y"))
        .under("bodies.wheel");
    assert_eq!(
        source.locate(fault).compact(),
        "case.ron:11:31: error: x; did you mean `y`?"
    );
}

#[test]
fn files_that_cannot_be_read() {
    let folder = std::env::temp_dir().join(format!("source-tests-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let put = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let refused = |path: PathBuf| Source::read(path).unwrap_err();
    let good = put("wheel.ron", text().as_bytes());
    assert!(Source::read(&good).unwrap().parse::<Case>().is_ok());
    let missing = refused(folder.join("weel.ron")).compact();
    assert!(
        missing.contains("there is no such file; did you mean `"),
        "{missing}"
    );
    assert!(missing.ends_with("wheel.ron`?"), "{missing}");
    assert!(refused(folder.clone()).message.contains("it is a folder"));
    assert!(
        refused(put("empty", b"\xef\xbb\xbf \n"))
            .message
            .contains("is empty")
    );
    let latin = refused(put("latin", b"(\n a: \"\xe9\")"));
    assert_eq!(
        (latin.position(), latin.message()),
        (Some((2, 6)), "is not UTF-8 text")
    );
    let large = std::fs::File::create(folder.join("large")).unwrap();
    large.set_len(MAX_BYTES + 1).unwrap();
    assert!(
        refused(folder.join("large"))
            .message
            .contains("larger than 64 MiB")
    );
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn deep_nesting_is_refused() {
    for (open, close) in [
        ("[", "]"),
        ("(", ")"),
        ("{1:", "}"),
        ("Some(", ")"),
        ("(a:", ")"),
    ] {
        let deep = format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
        let mut source = Source::from_text("deep.ron", deep);
        let error = source.parse::<Case>().unwrap_err();
        assert!(error.message.contains("more than 128 levels"), "{error}");
        assert!(error.line == 1 && error.column > 128);
        assert!(source.set("a=1").is_err());
    }
    let comment = format!("{}1", "/*".repeat(100_000));
    let error = Source::from_text("c.ron", comment)
        .parse::<u8>()
        .unwrap_err();
    assert!(error.message.contains("comment is never closed"));
    // Depth in a value that is skipped, and depth brought by sets, count as well.
    let fine = format!("{}1{}", "[".repeat(100), "]".repeat(100));
    let mut source = Source::from_text("d.ron", format!("(a: {fine})"));
    source.set(&format!("a{}={fine}", ".0".repeat(50))).unwrap();
    let error = source.parse::<Case>().unwrap_err();
    assert!(error.set().is_some() && error.message.contains("more than 128"));
}

/// A small generator, so that the same mutations come every time.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

#[test]
fn mutations_never_panic() {
    const SCRAPS: &[&str] = &[
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ",",
        ":",
        "\"",
        "'",
        "/*",
        "*/",
        "//",
        "r#\"",
        "\"#",
        "b\"",
        "#![",
        "\\",
        "é",
        "\u{2028}",
        "\r\n",
        "\t",
        "Some(",
        "None",
        "..",
        "-",
        "NaN",
        "1e999",
        "\u{feff}",
        "日本",
        "\0",
        "\x1b[31m",
        "b'",
        "r#",
        "\u{85}",
        "_",
        "name: \"wheel\",",
    ];
    const SETS: &[&str] = &[
        "loading.amplitude=-1",
        "bodies.wheel.mass=\"é\"",
        "drive.0=(1, 2)",
        "drive.0.frequency=q",
        "materials.x=(young: 0)",
        "interfaces.0.cohesion=mac",
        "seed=[\n1,\n2]",
        "loading.new=é",
    ];
    let rounds = if cfg!(debug_assertions) {
        4_000
    } else {
        20_000
    };
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    let begun = Instant::now();
    let mut refused = 0;
    for round in 0..rounds {
        let mut bytes = text().into_bytes();
        for _ in 0..1 + random.below(4) {
            let at = random.below(bytes.len());
            match random.below(4) {
                0 => bytes[at] = random.below(256) as u8,
                1 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
                2 => bytes.truncate(at.max(1)),
                _ => {
                    let scrap = SCRAPS[random.below(SCRAPS.len())];
                    bytes.splice(at..at, scrap.bytes());
                }
            }
            if bytes.is_empty() {
                bytes.push(b'(');
            }
        }
        let mut source = Source::from_text("f.ron", String::from_utf8_lossy(&bytes));
        for _ in 0..random.below(3) {
            if let Err(error) = source.set(SETS[random.below(SETS.len())]) {
                assert!(!error.compact().is_empty());
            }
        }
        if let Err(error) = source.parse::<Case>() {
            refused += 1;
            let lines = source.original.matches('\n').count() + 1;
            assert!((1..=lines).contains(&error.line), "round {round}");
            assert!(error.column >= 1);
            if round % 8 == 0 {
                assert!(!error.render(round % 16 == 0).is_empty());
            }
        }
    }
    assert!(refused > rounds / 4);
    let limit = Duration::from_secs(if cfg!(debug_assertions) { 60 } else { 2 });
    assert!(begun.elapsed() < limit, "{:?}", begun.elapsed());
}

#[test]
fn noise_never_panics() {
    let mut random = Random(88_172_645_463_325_252);
    for _ in 0..2_000 {
        let length = random.below(200);
        let bytes: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
        let mut source = Source::from_text("n.ron", String::from_utf8_lossy(&bytes));
        let argument = String::from_utf8_lossy(&bytes).replace('\0', "=");
        let _ = source.set(&argument);
        if let Err(error) = source.parse::<Case>() {
            assert!(!error.render(false).is_empty());
        }
    }
}
