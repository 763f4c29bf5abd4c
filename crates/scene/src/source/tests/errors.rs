//! Tests of the location of errors.

use super::*;

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
         found the text `\"5.0\"`; expected a number; write `5.0` without quotes"
    );
    assert_eq!(
        refusal("name: \"wheel (on rail) }\"", "name: wheel"),
        "case.ron:4:11: error: wrong type for `name`: found the word `wheel`; \
         expected a text in quotes; help"
            .replace("help", "write `\"wheel\"`")
    );
    assert_eq!(
        refusal("Disk(radius", "Dsk(radius"),
        "case.ron:11:65: error: unknown variant `Dsk` for `bodies.wheel.shape`; \
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
    // The parser may reject an earlier value before it reaches the malformed position, which then
    // becomes a note.
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
    assert!(
        error("frequency: 5.0", "frequency: ").contains("a value is missing after `frequency:`")
    );
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
    assert!(error.to_string().contains("its default applies"));
    assert_eq!(source.error_at("nothing", "x").position(), Some((3, 1)));
    assert_eq!(source.error_at("", "x").position(), Some((3, 1)));
    let fault = ValidationError::new("mass", "x")
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
