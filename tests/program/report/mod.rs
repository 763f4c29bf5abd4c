//! `fretwork report` and `fretwork compare`: what is on a page, that it stays small, loads nothing,
//! and that no text of a case becomes markup. What a browser makes of it is in `tests/browser`.

mod pages;
mod refusals;

use crate::temp::TempFolder;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A short run with bonds, a friction test and a title that would be markup.
const CASE: &str = include_str!("bonded.ron");

struct Trial(TempFolder);

impl Trial {
    fn new(name: &str) -> Self {
        let dir = TempFolder::new(&format!("report-{name}"));
        std::fs::write(dir.join("case.ron"), CASE).unwrap();
        Self(dir)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn call(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .current_dir(&self.0)
            .args(args)
            .output()
            .unwrap()
    }

    /// Runs the case into a folder, with changes.
    fn run(&self, out: &str, sets: &[&str]) -> Output {
        let mut args = vec!["run", "case.ron", "--out", out];
        sets.iter().for_each(|s| args.extend(["--set", s]));
        let output = self.call(&args);
        assert!(output.status.success(), "{}", text(&output));
        output
    }

    fn page(&self, name: &str) -> String {
        read(&self.path(name))
    }
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned()
}

/// The data that the scripts of a page read.
fn data(page: &str) -> serde_json::Value {
    let start = page.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let end = page[start..].find("</script>").unwrap();
    serde_json::from_str(&page[start..start + end]).unwrap()
}
