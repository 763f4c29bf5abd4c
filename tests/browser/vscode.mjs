// The extension of VS Code with the program: errors of an open case, completion and hover. The
// editor's interface is stood in for by what the extension calls of it. Called by run.sh:
// node vscode.mjs PROGRAM.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import Module, { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const program = path.resolve(process.argv[2]);
const shown = new Map();
const handlers = {};
const providers = {};
const failures = [];

const register = (name) => (handler) => { handlers[name] = handler; return { dispose() {} }; };
const provide = (name) => (_, provider) => { providers[name] = provider; return { dispose() {} }; };
const vscode = {
  Uri: { parse: (text) => text },
  Range: class { constructor(...ends) { this.ends = ends; } },
  Diagnostic: class { constructor(range, message, severity) { Object.assign(this, { range, message, severity }); } },
  DiagnosticSeverity: { Error: 0 },
  CompletionItem: class { constructor(label, kind) { Object.assign(this, { label, kind }); } },
  MarkdownString: class { constructor(value) { this.value = value; } },
  Hover: class { constructor(contents, range) { Object.assign(this, { contents, range }); } },
  window: { showErrorMessage: (text) => failures.push(text) },
  commands: { registerCommand: () => ({ dispose() {} }) },
  workspace: {
    textDocuments: [],
    getConfiguration: () => ({ get: (key) => ({ program, arguments: [] })[key] }),
    onDidOpenTextDocument: register("open"),
    onDidChangeTextDocument: register("change"),
    onDidSaveTextDocument: register("save"),
    onDidCloseTextDocument: register("close"),
  },
  languages: {
    match: (_, document) => (document.languageId === "ron" ? 10 : 0),
    createDiagnosticCollection: () => ({ set: (uri, found) => shown.set(uri, found), clear: () => shown.clear() }),
    registerCompletionItemProvider: provide("completion"),
    registerHoverProvider: provide("hover"),
  },
};
const load = Module._load;
Module._load = (name, ...others) => (name === "vscode" ? vscode : load(name, ...others));

async function until(condition) {
  for (let waited = 0; !condition(); waited += 20) {
    assert.ok(waited < 60_000, `waited for ${condition}; ${failures}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

const extension = createRequire(import.meta.url)(path.join(root, "editors/vscode/extension.js"));
extension.activate({ subscriptions: [] });

const file = path.join(root, "cases/block_wall.ron");
const uri = `file://${encodeURI(file)}`;
let text = readFileSync(file, "utf8");
const document = { uri, languageId: "ron", version: 1, getText: () => text };
const position = (needle) => {
  const before = text.slice(0, text.indexOf(needle));
  return { line: before.split("\n").length - 1, character: before.length - before.lastIndexOf("\n") - 1 };
};

handlers.open(document);
await until(() => shown.has(uri));
assert.deepEqual(shown.get(uri), [], "a shipped case has no errors");

const right = text;
text = right.replace("gravity:", "gravty:");
assert.notEqual(text, right);
handlers.change({ document });
await until(() => shown.get(uri).length === 1);
const [error] = shown.get(uri);
assert.match(error.message, /did you mean `gravity`/);
assert.deepEqual(error.range.ends.slice(0, 2), Object.values(position("gravty")));

text = right.replace("gravity:", "gr: ");
handlers.change({ document });
const at = position("gr: ");
const items = await providers.completion.provideCompletionItems(document, { ...at, character: at.character + 2 });
const gravity = items.find((item) => item.label === "gravity");
assert.equal(gravity.insertText, "gravity: ");
assert.equal(gravity.kind, 4, "a field"); // CompletionItemKind.Field of VS Code

text = right;
handlers.change({ document });
const hover = await providers.hover.provideHover(document, position("gravity:"));
assert.match(hover.contents.value, /m\/s\^2/);

await extension.deactivate();
assert.deepEqual(failures, []);
console.log("the extension of VS Code shows errors, completes and explains");
