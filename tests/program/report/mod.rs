//! `fretwork report` and `fretwork compare`: content of a page; its size is limited, it loads
//! nothing, and no text of a case becomes markup. `tests/browser` tests pages in a browser.

mod measured;
mod pages;
mod refusals;

use crate::temp::TempFolder;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::read::GzDecoder;
use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A short run with bonds, a friction test and a title that looks like markup.
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

/// Returns the data that the scripts of a page read.
pub fn data(page: &str) -> serde_json::Value {
    let start = page.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let end = page[start..].find("</script>").unwrap();
    serde_json::from_str(&page[start..start + end]).unwrap()
}

/// The packed numbers of the charts of a page, by name, in single precision.
pub fn chart_numbers(page: &str) -> BTreeMap<String, Vec<f32>> {
    let start = page.find("id=\"numbers\">").unwrap() + "id=\"numbers\">".len();
    let text = page[start..].split('<').next().unwrap();
    let mut bytes = Vec::new();
    let packed = STANDARD.decode(text).unwrap();
    GzDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
    let length = u32::from_le_bytes(*bytes.first_chunk().unwrap()) as usize;
    let heads: Vec<serde_json::Value> = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    let array = |head: serde_json::Value| {
        let of = |key: &str| head[key].as_u64().unwrap() as usize;
        let values = bytes[4 + length + of("at")..].iter().copied();
        let values: Vec<f32> = match head["kind"].as_str().unwrap() {
            "f32" => {
                let all: Vec<u8> = values.take(4 * of("count")).collect();
                let all = all.as_chunks::<4>().0.iter();
                all.map(|x| f32::from_le_bytes(*x)).collect()
            }
            "f64" => {
                let all: Vec<u8> = values.take(8 * of("count")).collect();
                let all = all.as_chunks::<8>().0.iter();
                all.map(|x| f64::from_le_bytes(*x) as f32).collect()
            }
            kind => panic!("numbers of charts are not {kind}"),
        };
        (head["name"].as_str().unwrap().to_owned(), values)
    };
    heads.into_iter().map(array).collect()
}
