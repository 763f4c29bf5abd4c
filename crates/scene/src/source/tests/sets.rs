//! Tests of `--set`.

use super::*;

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
        source.set::<Case>(set).unwrap();
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
    source
        .set::<Case>("bodies=[\n(name: \"a\", mass: 1),\n]")
        .unwrap();
    source.set::<Case>("drive=None").unwrap();
    source.set::<Case>("interfaces.0.cohesion=None").unwrap();
    source.set::<Case>("materials.brass=(young: 1e11)").unwrap();
    source.set::<Case>("bodies.a.mass=3").unwrap();
    source.set::<Case>("bodies.a.mass=5").unwrap();
    let case = parsed(&source);
    assert_eq!(case.bodies.len(), 1);
    assert_eq!(case.bodies[0].mass.get(), 5.0);
    assert_eq!((case.drive, &case.interfaces[0].cohesion), (None, &None));
    assert_eq!(case.materials["brass"].young.get(), 1e11);
}

#[test]
fn a_new_text_field_needs_no_quotes() {
    let mut source = Source::from_text("case.ron", text().replace(", cohesion: \"none\"", ""));
    source.set::<Case>("interfaces.0.cohesion=mac").unwrap();
    source.set::<Case>("name=12").unwrap();
    source.set::<Case>("comment=true").unwrap();
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
    source.set::<Empty>("map={}").unwrap();
    source.set::<Empty>("map.k=2").unwrap();
    source.set::<Empty>("map.l=3").unwrap();
    source.set::<Empty>("a=1").unwrap();
    let empty: Empty = source.parse().unwrap();
    assert_eq!((empty.a, empty.map["k"], empty.map["l"]), (1, 2, 3));
}

#[test]
fn malformed_sets_are_refused() {
    let refused = |set: &str| source().set::<Case>(set).unwrap_err().compact();
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
    let comma = refused("loading.frequency=1,5 Hz");
    assert!(
        comma.contains("`1,5 Hz` has a decimal comma; write `1.5 Hz`"),
        "{comma}"
    );
    assert!(!refused("loading.frequency=1,5,2").contains("decimal comma"));
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
    assert!(refused("seed.x.y=3").contains("`seed` is one value, which has no `x` to set"));
    assert!(refused("loading.frequency.x=3").contains("`loading.frequency` is `5.0`"));
    let kinds = Source::from_text("c.ron", "()")
        .set::<crate::case::Case>("coupling.max_iterations=3")
        .unwrap_err()
        .compact();
    assert!(
        kinds.contains("--set 'coupling=Implicit(tolerance: ..., max_iterations: 3)'"),
        "{kinds}"
    );
    let broken = Source::from_text("b.ron", "(a: [1, 2)")
        .set::<Case>("a=1")
        .unwrap_err();
    assert_eq!(broken.position(), Some((1, 10)));
}

#[test]
fn errors_in_sets_name_the_set_and_the_line() {
    let mut source = source();
    source
        .set::<Case>("bodies.0=(\n name: \"a\",\n mass: -1\n)")
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

    // The text after a replaced value of several lines keeps its own line number.
    let mut source = Source::from_text("case.ron", text().replace("mu: 0.3", "mu: -0.3"));
    source.set::<Case>("bodies=[\n\n\n]").unwrap();
    source.set::<Case>("loading.phase=1.0").unwrap();
    let error = source.parse::<Case>().unwrap_err();
    assert_eq!(error.position(), Some((14, 23)), "{error}");
    assert_eq!(error.set(), None);

    let mut source = self::source();
    source.set::<Case>("loading.amplitud=3").unwrap();
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
    source.set::<Case>("seed=red").unwrap();
    assert_eq!(source.error_at("seed", "x").set(), Some("seed=red"));
    let line = source.parse::<Case>().unwrap_err().compact();
    assert!(line.contains("found the word `red` (from"), "{line}");
}
