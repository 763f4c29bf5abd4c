//! The studies of `studies/` and of `validation/`, whose results are in `docs/`.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Output of `study check` for each study in a folder; nothing is run or written.
fn checks(folder: &str) -> Vec<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let name = format!("fretwork-shipped-{folder}-{}", std::process::id());
    let out = std::env::temp_dir().join(name);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(root.join(folder)).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "ron") {
            continue;
        }
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(["study", "check", "--no-timing", "--json"])
            .arg(&path)
            .arg("--out")
            .arg(&out)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", path.display());
        found.push(serde_json::from_slice(&output.stdout).unwrap());
    }
    assert!(!out.exists());
    found
}

/// Each study has its outputs and rejects no level.
#[test]
fn shipped_studies_are_right() {
    let found = checks("studies");
    assert!(found.len() >= 8);
    for check in found {
        assert_eq!(check["runs"]["all"], check["runs"]["to_be_made"]);
        assert!(check["runs"]["all"].as_u64() > Some(1) && check["forecast"].is_null());
    }
}

/// Each study has three seeds or more, for an interval.
#[test]
fn studies_of_the_validation_are_right() {
    let found = checks("validation");
    assert!(found.len() >= 8);
    for check in found {
        assert!(check["seeds"].as_array().unwrap().len() >= 3, "{check}");
    }
}
