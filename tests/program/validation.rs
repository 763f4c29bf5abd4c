//! The studies of `validation/`, whose results are in `docs/validation.md`.

use std::path::Path;
use std::process::Command;

/// Each is right, has three seeds or more and the outputs that it asks for; nothing is run.
#[test]
fn studies_of_the_validation_are_right() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = std::env::temp_dir().join(format!("fretwork-validation-{}", std::process::id()));
    let mut count = 0;
    for entry in std::fs::read_dir(root.join("validation")).unwrap() {
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
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("\n    seeds: 3,"), "{}", path.display());
        count += 1;
    }
    assert!(count >= 8 && !out.exists());
}
