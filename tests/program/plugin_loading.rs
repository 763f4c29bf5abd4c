//! Libraries that the loader accepts, and those that it rejects with their messages: small plugins
//! in C, made here.
use crate::temp::TempFolder;
use fretwork::laws::{Call, Kind, LawError, Plugin, SearchPath, search};
use fretwork::shipped::search_path;
use fretwork_abi::FwBatch;
use std::path::{Path, PathBuf};
use std::process::Command;

const INCLUDE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/plugins/abi/include");

/// A separate folder for each test, removed at its end.
struct Folder(TempFolder);

impl Folder {
    fn new(test: &str) -> Self {
        Self(TempFolder::new(test))
    }

    /// Compiles C text into the library `file`.
    fn compile(&self, file: &str, text: &str) -> PathBuf {
        let (source, library) = (self.0.join(format!("{file}.c")), self.0.join(file));
        std::fs::write(&source, text).unwrap();
        let compiled = Command::new("cc")
            .args(["-std=c99", "-Wall", "-Werror", "-shared", "-fPIC", "-I"])
            .arg(INCLUDE)
            .arg("-o")
            .args([&library, &source])
            .status()
            .expect("a C compiler named cc");
        assert!(compiled.success(), "{text}");
        library
    }

    /// Compiles a damage law with `fields` of the table replacing those of a valid one.
    fn law(&self, name: &str, fields: &str) -> PathBuf {
        self.compile(
            &search::file_name(Kind::DAMAGE, name),
            &source(name, fields, "return &table;"),
        )
    }
}

/// C text of a damage law: D is `rate` where the gap is not negative, an error elsewhere.
fn source(name: &str, fields: &str, entry: &str) -> String {
    format!(
        r#"
#include <math.h>
#include <string.h>
#include "fretwork.h"
static const fw_field parameters[] = {{
    {{"rate", "1/s", "how fast", 0.5, 0.0, 1.0, 0}},
    {{"limit", "", "where it ends", 1.0, 0.0, 1.0, 0}},
}};
static const fw_field twice[] = {{
    {{"rate", "1/s", "how fast", 0.5, 0.0, 1.0, 0}},
    {{"rate", "1/s", "again", 0.5, 0.0, 1.0, 0}},
}};
static const fw_field outside[] = {{{{"rate", "", "", 2.0, 0.0, 1.0, 0}}}};
static const fw_field endless[] = {{{{"rate", "", "", INFINITY, 0.0, INFINITY, 0}}}};
static const fw_field nameless[] = {{{{"Rate 1", "", "", 0.0, 0.0, 1.0, 0}}}};
static const fw_field textless[] = {{{{"rate", 0, "", 0.0, 0.0, 1.0, 0}}}};
static const fw_field (*const unused[])[1] = {{&outside, &endless, &nameless, &textless}};
static const void *const unused_too[] = {{twice, unused}};
static int32_t validate(const double *p, fw_message *m) {{
    (void)unused_too;
    if (p[0] <= p[1]) return FW_OK;
    strncpy(m->text, "rate must not exceed limit", m->capacity);
    return FW_BAD_PARAMETER;
}}
static int32_t commit(const fw_batch *b, fw_message *m) {{
    for (size_t k = 0; k < b->n; k++) {{
        if (b->gap[k] == -7.0) return 77;
        if (b->gap[k] < 0.0) {{
            m->contact = (int64_t)k;
            strncpy(m->text, "the gap is negative", m->capacity);
            return FW_ERROR;
        }}
        b->out_damage[k] = b->parameters[0];
    }}
    return FW_OK;
}}
struct longer {{ fw_plugin plugin; double tail[4]; }};
static const struct longer newer = {{{{
    .size = sizeof(struct longer), .abi_major = FW_ABI_MAJOR, .abi_minor = FW_ABI_MINOR + 1,
    .kind = FW_KIND_DAMAGE, .name = "{name}", .version = "2.1", .doc = "d", .reference = "r",
    .n_parameters = 2, .parameters = parameters, .validate = validate, .commit = commit,
}}, {{1.0, 2.0, 3.0, 4.0}}}};
static const char *const latin = "caf\xe9";
static fw_plugin table;
const fw_plugin *fretwork_plugin(void) {{
    (void)latin;
    table = newer.plugin;
    table.size = sizeof table;
    table.abi_minor = FW_ABI_MINOR;
    {fields}
    {entry}
}}
"#
    )
}

fn reason(path: &Path) -> String {
    match Plugin::open(path) {
        Ok(_) => panic!("{} was accepted", path.display()),
        Err(e) => {
            let said = e.to_string();
            assert!(said.contains(&path.display().to_string()), "{said}");
            said
        }
    }
}

#[test]
fn a_good_plugin_loads_and_answers() {
    let folder = Folder::new("good");
    let plugin = Plugin::open(&folder.law("good", "")).unwrap();
    assert_eq!((plugin.kind, plugin.name.as_str()), (Kind::DAMAGE, "good"));
    assert_eq!(plugin.version, "2.1");
    assert_eq!(plugin.sha256.len(), 64);
    assert_eq!(plugin.parameters[0].unit, "1/s");
    assert_eq!(plugin.parameters[1].default, 1.0);

    assert!(plugin.validate(&[0.2, 0.3]).is_ok());
    for (values, part) in [
        (&[0.4, 0.3][..], "rate must not exceed limit"),
        (&[2.0, 1.0], "`rate` must lie in [0, 1]"),
        (&[f64::NAN, 1.0], "`rate`"),
        (&[0.1], "takes 2 values, got 1"),
    ] {
        let said = plugin.validate(values).unwrap_err().to_string();
        assert!(said.contains(part), "{said}");
    }

    let run = |gap: [f64; 2]| {
        let (parameters, mut damage) = ([0.25, 1.0], [0.0; 2]);
        // SAFETY: zeros are valid numbers and null pointers.
        let mut batch: FwBatch = unsafe { std::mem::zeroed() };
        (batch.size, batch.n) = (size_of::<FwBatch>(), 2);
        (batch.gap, batch.parameters) = (gap.as_ptr(), parameters.as_ptr());
        batch.out_damage = damage.as_mut_ptr();
        // SAFETY: the columns that the law reads and writes are arrays of two.
        unsafe { plugin.call(Call::Commit, &batch) }.map(|()| damage)
    };
    assert_eq!(run([0.0, 1.0]).unwrap(), [0.25, 0.25]);
    match run([0.0, -1.0]).unwrap_err() {
        LawError::Failed {
            contact, reason, ..
        } => assert_eq!((contact, reason.as_str()), (Some(1), "the gap is negative")),
        other => panic!("{other}"),
    }
    let strange = run([-7.0, 0.0]).unwrap_err().to_string();
    assert!(strange.contains("unknown status 77"), "{strange}");
}

#[test]
fn a_newer_minor_with_a_longer_table_loads() {
    let folder = Folder::new("newer");
    let text = source("newer", "", "return &newer.plugin;");
    let plugin = Plugin::open(&folder.compile("newer.so", &text)).unwrap();
    assert_eq!(plugin.name, "newer");
    assert!(plugin.validate(&[0.2, 0.3]).is_ok());
}

/// In a plugin built before the last field of the table existed, the host takes that field as
/// absent.
#[test]
fn an_older_minor_with_a_shorter_table_loads() {
    let folder = Folder::new("older");
    let fields = "table.size = offsetof(fw_plugin, fracture_energy);
        memset(&table.fracture_energy, 0xff, sizeof table.fracture_energy);";
    let plugin = Plugin::open(&folder.law("older", fields)).unwrap();
    assert_eq!(plugin.name, "older");
    assert!(plugin.fracture_energy(&[0.2, 0.3], 0.0).is_none());
}

/// Fields of a table whose only parameter is the first of a list.
fn one_parameter(list: &str) -> String {
    format!("table.parameters = {list}; table.n_parameters = 1;")
}

#[test]
fn tables_that_break_the_rules_are_refused() {
    let folder = Folder::new("refused");
    for (name, fields, part) in [
        ("major", "table.abi_major = 2;", "version 2"),
        ("short", "table.size = 96;", "96 bytes"),
        ("kind", "table.kind = 9;", "kind 9 is unknown"),
        ("function", "table.commit = 0;", "`commit`, which is null"),
        (
            "prepare",
            "table.kind = FW_KIND_CONTACT;",
            "`prepare`, which is null",
        ),
        (
            "energy",
            "table.kind = FW_KIND_COHESION; table.prepare = commit;",
            "`energy`, which is null",
        ),
        ("noname", "table.name = \"\";", "name ``"),
        ("nullname", "table.name = 0;", "name is null"),
        ("badname", "table.name = \"../x\";", "name `../x`"),
        ("utf", "table.doc = latin;", "doc is not valid UTF-8"),
        ("noversion", "table.version = 0;", "version is null"),
        (
            "twice",
            "table.parameters = twice;",
            "`rate` is declared twice",
        ),
        (
            "twice2",
            "table.variables = twice; table.n_variables = 2;",
            "variable `rate` is declared twice",
        ),
        (
            "outside",
            &one_parameter("outside"),
            "default 2 of `rate` is out of its range",
        ),
        ("endless", &one_parameter("endless"), "not finite"),
        ("nameless", &one_parameter("nameless"), "`Rate 1`"),
        (
            "textless",
            &one_parameter("textless"),
            "parameter 0 is null",
        ),
        ("noschema", "table.parameters = 0;", "their table is null"),
        ("many", "table.n_parameters = (size_t)-1;", "at most 256"),
        (
            "constant",
            "table.flags = FW_FLAG_CONSTANT; table.variables = parameters; table.n_variables = 1;",
            "drop one of the two",
        ),
        (
            "exponent",
            "table.degradation = -1.0;",
            "degradation exponent -1",
        ),
    ] {
        let said = reason(&folder.law(name, fields));
        assert!(said.contains(part), "{name}: {said}");
    }
    let null = source("null", "", "return 0;");
    let said = reason(&folder.compile("null.so", &null));
    assert!(said.contains("returned null"), "{said}");
}

#[test]
fn what_is_no_plugin_is_refused() {
    let folder = Folder::new("foreign");
    let foreign = folder.compile("foreign.so", "int answer(void) { return 42; }\n");
    assert!(reason(&foreign).contains("does not export `fretwork_plugin`"));
    let text = folder.0.join("text.so");
    std::fs::write(&text, "not a library").unwrap();
    assert!(reason(&text).contains("not a loadable library"));
    assert!(reason(&folder.0.join("absent.so")).contains("cannot be read"));
}

#[test]
fn the_search_goes_by_kind_and_name() {
    let folder = Folder::new("search");
    let (first, second) = (folder.0.join("first"), folder.0.join("second"));
    for place in [&first, &second] {
        std::fs::create_dir_all(place).unwrap();
    }
    let library = folder.law("slow-rot", "table.version = \"first\";");
    let file = search::file_name(Kind::DAMAGE, "slow-rot");
    std::fs::copy(&library, first.join(&file)).unwrap();
    let other = folder.law("slow-rot", "table.version = \"second\";");
    std::fs::copy(&other, second.join(&file)).unwrap();
    // One library has two names of different kinds.
    std::fs::copy(
        &library,
        first.join(search::file_name(Kind::WEAR, "slow-rot")),
    )
    .unwrap();
    std::fs::write(first.join("libfretwork_strange_thing.so"), "x").unwrap();

    let path = SearchPath::new(&[first.clone(), second.clone(), folder.0.join("absent")]);
    let found = path.find(Kind::DAMAGE, "slow-rot").unwrap();
    assert_eq!(
        (found.version.as_str(), found.path),
        ("first", first.join(&file))
    );
    let back = SearchPath::new(&[second, first.clone()]);
    let found = back.find(Kind::DAMAGE, "slow-rot").unwrap();
    assert_eq!(found.version, "second");

    let wrong = path.find(Kind::WEAR, "slow-rot").unwrap_err().to_string();
    assert!(wrong.contains("promises the wear law"), "{wrong}");
    match path.find(Kind::DAMAGE, "slow-rut").unwrap_err() {
        LawError::Unknown {
            nearest, available, ..
        } => {
            assert_eq!(nearest.as_deref(), Some("slow-rot"));
            assert!(available.contains("slow-rot"), "{available}");
        }
        other => panic!("{other}"),
    }
    // Only plain names are looked up, even where the file exists.
    for bad in ["../first/slow-rot", "SLOW-ROT", "", ".", "slow-rot.so"] {
        let refused = path.find(Kind::DAMAGE, bad);
        assert!(matches!(refused, Err(LawError::Unknown { .. })), "{bad}");
    }
}

#[test]
fn the_shipped_laws_are_found_and_agree_with_their_names() {
    let path = search_path();
    for (kind, name) in [
        (Kind::CONTACT, "coulomb"),
        (Kind::CONTACT, "coulomb-damage"),
        (Kind::CONTACT, "frictionless"),
        (Kind::COHESION, "elastic-bond"),
        (Kind::COHESION, "mac"),
        (Kind::DAMAGE, "mac"),
        (Kind::DAMAGE, "mohr-coulomb-brittle"),
        (Kind::WEAR, "archard"),
        (Kind::WEAR, "dissipated-energy"),
    ] {
        let plugin = path.find(kind, name).unwrap();
        let defaults: Vec<f64> = plugin.parameters.iter().map(|p| p.default).collect();
        plugin.validate(&defaults).unwrap();
        assert!(!plugin.reference.is_empty() && !plugin.doc.is_empty());
        for parameter in &plugin.parameters {
            assert!(!parameter.doc.is_empty(), "{name}: {}", parameter.name);
        }
        assert!(
            path.laws().iter().any(|a| a.0 == kind && a.1 == name),
            "{name}"
        );
    }
}

/// The program alone, copied elsewhere, without environment: shipped laws and materials are found,
/// a case gives results that are bit-identical to those in the checkout, and a library on the path
/// does not replace a shipped law.
#[test]
fn the_program_alone_runs_a_case() {
    let folder = Folder::new("alone");
    let program = folder.0.join("fretwork");
    let built = env!("CARGO_BIN_EXE_fretwork");
    std::fs::copy(built, &program).unwrap();
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/bond_mode_1.ron");
    std::fs::copy(case, folder.0.join("case.ron")).unwrap();
    let call = |program: &Path, words: &[&str]| {
        let output = Command::new(program)
            .args(words)
            .current_dir(&folder.0)
            .env_clear()
            .output()
            .unwrap();
        let out = String::from_utf8_lossy(&output.stdout).into_owned();
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), out, err)
    };
    let rows = |program: &Path, out: &str| {
        let set = ["--set", "time.end=2e-7", "--set", "output.every=1"];
        let words = [&["run", "case.ron", "--json", "--out", out][..], &set].concat();
        let (code, said, err) = call(program, &words);
        assert_eq!(code, Some(0), "{err}");
        let summary: serde_json::Value = serde_json::from_str(&said).unwrap();
        let rows = std::fs::read_to_string(folder.0.join(out).join("statistics.csv")).unwrap();
        assert!(rows.lines().count() > 5, "{rows}");
        (summary["plugins"].clone(), rows)
    };
    let (alone, here) = (rows(&program, "alone"), rows(Path::new(built), "here"));
    assert_eq!(alone.1, here.1);
    let sum = alone.0[0]["sha256"].clone();
    for plugin in alone.0.as_array().unwrap() {
        let path = plugin["path"].as_str().unwrap();
        assert_eq!(Path::new(path), program.canonicalize().unwrap(), "{plugin}");
        // All built-in laws have the SHA-256 of the program.
        assert_eq!(
            (&plugin["sha256"], &plugin["certified"]),
            (&sum, &true.into())
        );
    }

    let (code, listed, _) = call(&program, &["law", "list"]);
    assert_eq!(code, Some(0));
    let marked = listed.lines().filter(|l| l.ends_with("(built in)")).count();
    assert_eq!((listed.lines().count(), marked), (53, 53), "{listed}");
    let (_, shown, _) = call(&program, &["law", "show", "archard"]);
    assert!(shown.contains("built into") && shown.contains("the SHA-256 is the program's"));

    // A library of that name on the path would be another law.
    let elsewhere = folder.0.join("elsewhere");
    std::fs::create_dir_all(&elsewhere).unwrap();
    let file = elsewhere.join(search::file_name(Kind::DAMAGE, "mac"));
    std::fs::write(file, "not a library").unwrap();
    let words = ["law", "show", "damage/mac", "--plugin-path", "elsewhere"];
    let (_, shown, _) = call(&program, &words);
    assert!(shown.contains("built into"), "{shown}");

    // If a law is missing, the message tells where it was searched.
    for set in ["interfaces.grain.damage=mak", "materials.grain=glas_bead"] {
        let (code, _, err) = call(&program, &["run", "case.ron", "--set", set]);
        assert_eq!(code, Some(2), "{err}");
        assert!(
            err.contains("the program itself") && err.contains("did you mean"),
            "{err}"
        );
    }
}
