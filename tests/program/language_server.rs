//! `fretwork lsp`, by a client on its standard streams: errors at their places, completion, hover.

use super::temp::TempFolder;
use lsp_server::{Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::io::BufReader;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

const CASE: &str = r#"(
    name: "a lid", dimension: 2, time: (step: 10 us, end: 1e-3),
    materials: {"steel": "rail_steel_r260"},
    interfaces: [(name: "dry", between: ("steel", "steel"), contact: "coulomb",
        parameters: (contact: {"mu": 0.3}))],
    bodies: [(
        name: "lid", material: "steel", mass: 2.0, shapes: [HalfSpace(normal: (0, 1))],
        dofs: (x: Velocity(Sine(amplitude: 1 mm/s, frequency: 5000))),
    )],
)"#;

struct Client {
    server: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    asked: i32,
    uri: String,
}

impl Client {
    fn start(folder: &TempFolder) -> Self {
        let mut server = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(["lsp", "--stdio"])
            .current_dir(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut client = Self {
            to: server.stdin.take().unwrap(),
            from: BufReader::new(server.stdout.take().unwrap()),
            server,
            asked: 0,
            uri: format!("file://{}", folder.join("a%20case.ron").display()),
        };
        let answer = client.ask("initialize", json!({"capabilities": {}}));
        assert_eq!(answer["serverInfo"]["name"], "fretwork");
        assert_eq!(answer["capabilities"]["hoverProvider"], true);
        client.notify("initialized", json!({}));
        client
    }

    fn notify(&mut self, method: &str, params: Value) {
        let message = Notification::new(method.to_owned(), params);
        Message::from(message).write(&mut self.to).unwrap();
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        let id = RequestId::from(self.asked);
        let request = Request::new(id.clone(), method.to_owned(), params);
        Message::from(request).write(&mut self.to).unwrap();
        loop {
            match Message::read(&mut self.from).unwrap().unwrap() {
                Message::Response(response) if response.id == id => {
                    return response.response_result.unwrap();
                }
                _ => {}
            }
        }
    }

    /// The errors of the text after a notification.
    fn errors(&mut self, method: &str, params: Value) -> Vec<Value> {
        self.notify(method, params);
        loop {
            match Message::read(&mut self.from).unwrap().unwrap() {
                Message::Notification(n) if n.method == "textDocument/publishDiagnostics" => {
                    assert_eq!(n.params["uri"], self.uri);
                    return n.params["diagnostics"].as_array().unwrap().clone();
                }
                _ => {}
            }
        }
    }

    fn open(&mut self, text: &str) -> Vec<Value> {
        let document = json!({"uri": self.uri, "languageId": "ron", "version": 1, "text": text});
        self.errors("textDocument/didOpen", json!({"textDocument": document}))
    }

    fn change(&mut self, text: &str) -> Vec<Value> {
        let document = json!({"uri": self.uri, "version": 2});
        let params = json!({"textDocument": document, "contentChanges": [{"text": text}]});
        self.errors("textDocument/didChange", params)
    }

    /// Asks at the bar of a text, which the server has without it.
    fn at(&mut self, method: &str, text: &str) -> Value {
        let bar = text.find('|').unwrap();
        self.change(&text.replace('|', ""));
        let before = &text[..bar];
        let column = before.rsplit('\n').next().unwrap().encode_utf16().count();
        let place = json!({"line": before.matches('\n').count(), "character": column});
        let document = json!({"uri": self.uri});
        self.ask(method, json!({"textDocument": document, "position": place}))
    }

    fn names(&mut self, text: &str) -> Vec<String> {
        let items = self.at("textDocument/completion", text);
        let label = |item: &Value| item["label"].as_str().unwrap().to_owned();
        items.as_array().unwrap().iter().map(label).collect()
    }

    fn hover(&mut self, text: &str) -> String {
        let found = self.at("textDocument/hover", text);
        found["contents"]["value"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    }

    fn end(mut self) {
        self.ask("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        assert!(self.server.wait().unwrap().success());
    }
}

#[test]
fn errors_are_those_of_the_reader_and_the_checker() {
    let folder = TempFolder::new("lsp-errors");
    let mut client = Client::start(&folder);
    assert_eq!(client.open(CASE), Vec::<Value>::new());
    let wrong = client.change(&CASE.replace("mass:", "mas:"));
    let message = wrong[0]["message"].as_str().unwrap();
    assert!(message.contains("did you mean `mass`?"), "{message}");
    let line = CASE.lines().position(|l| l.contains("mass:")).unwrap();
    let column = CASE.lines().nth(line).unwrap().find("mass:").unwrap();
    let place = |at: usize| json!({"line": line, "character": at});
    assert_eq!(wrong[0]["range"]["start"], place(column));
    assert_eq!(wrong[0]["range"]["end"], place(column + 3));
    // A law that is not there is found when the scene is built.
    let wrong = client.open(&CASE.replace("coulomb", "coulom"));
    let message = wrong[0]["message"].as_str().unwrap();
    assert!(message.contains("coulomb"), "{message}");
    assert_eq!(client.change(CASE), Vec::<Value>::new());
    // A study, and what is no input at all.
    assert_eq!(
        client.change("(case: \"a.ron\", seeds: 3)"),
        Vec::<Value>::new()
    );
    assert_eq!(client.change("# text"), Vec::<Value>::new());
    client.end();
}

#[test]
fn completion_has_fields_variants_laws_parameters_materials_and_units() {
    let folder = TempFolder::new("lsp-completion");
    let mut client = Client::start(&folder);
    client.open(CASE);
    for (old, new, some, none) in [
        ("mass: 2.0,", "|", "inertia", "material"),
        ("time: (", "time: (|", "theta", "end"),
        ("dimension: 2,", "dimension: 2, gr|", "gravity", "name"),
        ("Velocity(Sine", "|(Sine", "Displacement", "Ramp"),
        ("Sine(", "Sine(|", "offset", "amplitude"),
        ("\"coulomb\"", "\"|\"", "coulomb", "archard"),
        (
            "contact: \"coulomb\"",
            "contact: \"coulomb\", wear: \"|\"",
            "archard",
            "coulomb",
        ),
        ("{\"mu\": 0.3}", "{\"|\"}", "mu", "k_n"),
        // Of another contact law.
        ("{\"mu\": 0.3}", "{\"|\"}", "mu", "e_n"),
        ("\"rail_steel_r260\"", "\"|\"", "titanium_ti6al4v", "steel"),
        (
            "material: \"steel\"",
            "material: \"|\"",
            "steel",
            "rail_steel_r260",
        ),
        ("step: 10 us", "step: 10 |", "ms", "mm"),
        ("amplitude: 1 mm/s", "amplitude: 1 |", "km/h", "mm"),
    ] {
        assert_eq!(CASE.matches(old).count(), 1, "{old}");
        let names = client.names(&CASE.replace(old, new));
        assert!(
            names.iter().any(|n| n == some),
            "{new}: {some} is not among {names:?}"
        );
        assert!(
            names.iter().all(|n| n != none),
            "{new}: {none} is among {names:?}"
        );
    }
    client.end();
}

#[test]
fn hover_has_documentation_unit_and_default() {
    let folder = TempFolder::new("lsp-hover");
    let mut client = Client::start(&folder);
    client.open(CASE);
    for (old, new, words) in [
        ("step: 10", "st|ep: 10", ["Time step h", "Unit: `s`"]),
        ("frequency:", "frequ|ency:", ["Frequency", "Unit: `Hz`"]),
        ("Sine(", "Si|ne(", ["amplitude", ""]),
        ("\"coulomb\"", "\"cou|lomb\"", ["friction", ""]),
        ("\"mu\"", "\"m|u\"", ["coulomb: ", "default"]),
        (
            "\"rail_steel_r260\"",
            "\"rail_|steel_r260\"",
            ["Density: 7850", ""],
        ),
        ("mass: 2.0", "mass: 2.|0", ["Mass", "Unit: `kg/m`"]),
    ] {
        let found = client.hover(&CASE.replace(old, new));
        for word in words {
            assert!(found.contains(word), "{new}: {found}");
        }
    }
    client.end();
}
