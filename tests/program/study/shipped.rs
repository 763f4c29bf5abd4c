//! The studies of `studies/`.

use std::path::Path;
use std::process::Command;

/// Each is right, has the outputs that it asks for and refuses no level; nothing is run.
#[test]
fn shipped_studies_are_right() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = std::env::temp_dir().join(format!("fretwork-shipped-{}", std::process::id()));
    let mut count = 0;
    for entry in std::fs::read_dir(root.join("studies")).unwrap() {
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
        let check: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(check["runs"]["all"], check["runs"]["to_be_made"]);
        assert!(check["runs"]["all"].as_u64() > Some(1) && check["forecast"].is_null());
        count += 1;
    }
    assert!(count >= 4 && !out.exists());
}
