// The extension: a client of `fretwork lsp` for open cases. Plain JavaScript without packages, so
// that the folder works as it is.

const { spawn } = require("node:child_process");
const vscode = require("vscode");

/** Files that the server is told about. */
const FILES = [
  { language: "ron", scheme: "file" },
  { language: "json", scheme: "file", pattern: "**/cases/**/*.json" },
  { language: "yaml", scheme: "file", pattern: "**/cases/**/*.{yaml,yml}" },
];

/** The kinds of completion items of the protocol begin with 1, those of VS Code with 0. */
const FIRST_KIND = 1;

class Server {
  constructor(program, words, diagnostics, failed) {
    this.diagnostics = diagnostics;
    this.failed = failed;
    this.waiting = new Map();
    this.next = 0;
    this.bytes = Buffer.alloc(0);
    this.process = spawn(program, ["lsp", ...words]);
    this.process.stdout.on("data", (bytes) => this.read(bytes));
    this.process.on("error", (error) => this.end(`${program} cannot be started: ${error.message}`));
    this.process.on("exit", (code) => this.end(code === 0 ? "" : `${program} lsp ended with code ${code}`));
    this.ready = this.request("initialize", { processId: process.pid, rootUri: null, capabilities: {} })
      .then(() => this.notify("initialized", {}));
  }

  end(reason) {
    this.waiting.forEach((resolve) => resolve(null));
    this.waiting.clear();
    if (!this.ended && reason) this.failed(reason);
    this.ended = true;
  }

  send(message) {
    if (this.ended) return;
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    this.process.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }

  notify(method, params) {
    this.send({ method, params });
  }

  request(method, params) {
    if (this.ended) return Promise.resolve(null);
    const id = this.next++;
    this.send({ id, method, params });
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  /** Takes bytes of the server, and handles the messages that are complete. */
  read(bytes) {
    this.bytes = Buffer.concat([this.bytes, bytes]);
    for (;;) {
      const head = this.bytes.indexOf("\r\n\r\n");
      if (head < 0) return;
      const length = /Content-Length: *(\d+)/i.exec(this.bytes.toString("ascii", 0, head));
      const end = head + 4 + Number(length ? length[1] : 0);
      if (this.bytes.length < end) return;
      const text = this.bytes.toString("utf8", head + 4, end);
      this.bytes = this.bytes.subarray(end);
      this.handle(JSON.parse(text));
    }
  }

  handle(message) {
    if (message.method === "textDocument/publishDiagnostics") {
      const { uri, diagnostics } = message.params;
      this.diagnostics.set(vscode.Uri.parse(uri), diagnostics.map((found) => {
        const shown = new vscode.Diagnostic(range(found.range), found.message, vscode.DiagnosticSeverity.Error);
        shown.source = "fretwork";
        return shown;
      }));
    } else if (message.id !== undefined && this.waiting.has(message.id)) {
      this.waiting.get(message.id)(message.result ?? null);
      this.waiting.delete(message.id);
    }
  }

  async stop() {
    await this.request("shutdown", null);
    this.notify("exit", null);
    this.ended = true;
  }
}

function range({ start, end }) {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}

function at(document, position) {
  return {
    textDocument: { uri: document.uri.toString() },
    position: { line: position.line, character: position.character },
  };
}

function completionItem(found) {
  const item = new vscode.CompletionItem(found.label, (found.kind ?? FIRST_KIND) - FIRST_KIND);
  item.documentation = found.documentation && new vscode.MarkdownString(found.documentation);
  item.insertText = found.insertText;
  return item;
}

let server;

function start(diagnostics) {
  const settings = vscode.workspace.getConfiguration("fretwork");
  const failed = (reason) => vscode.window.showErrorMessage(`Fretwork: ${reason}`);
  diagnostics.clear();
  server = new Server(settings.get("program"), settings.get("arguments"), diagnostics, failed);
  vscode.workspace.textDocuments.forEach(opened);
}

function ours(document) {
  return vscode.languages.match(FILES, document) > 0;
}

async function tell(method, document, params) {
  if (!ours(document)) return;
  await server.ready;
  server.notify(method, params);
}

function opened(document) {
  tell("textDocument/didOpen", document, {
    textDocument: {
      uri: document.uri.toString(),
      languageId: document.languageId,
      version: document.version,
      text: document.getText(),
    },
  });
}

function activate(context) {
  const diagnostics = vscode.languages.createDiagnosticCollection("fretwork");
  const { workspace, languages } = vscode;
  context.subscriptions.push(
    diagnostics,
    vscode.commands.registerCommand("fretwork.restart", async () => {
      await server.stop();
      start(diagnostics);
    }),
    workspace.onDidOpenTextDocument(opened),
    workspace.onDidChangeTextDocument(({ document }) =>
      tell("textDocument/didChange", document, {
        textDocument: { uri: document.uri.toString(), version: document.version },
        contentChanges: [{ text: document.getText() }],
      })),
    workspace.onDidSaveTextDocument((document) =>
      tell("textDocument/didSave", document, { textDocument: { uri: document.uri.toString() } })),
    workspace.onDidCloseTextDocument((document) =>
      tell("textDocument/didClose", document, { textDocument: { uri: document.uri.toString() } })),
    languages.registerCompletionItemProvider(FILES, {
      async provideCompletionItems(document, position) {
        await server.ready;
        const found = await server.request("textDocument/completion", at(document, position));
        return (found ?? []).map(completionItem);
      },
    }, "(", ",", ":", "\"", " "),
    languages.registerHoverProvider(FILES, {
      async provideHover(document, position) {
        await server.ready;
        const found = await server.request("textDocument/hover", at(document, position));
        return found && new vscode.Hover(new vscode.MarkdownString(found.contents.value), range(found.range));
      },
    }),
  );
  start(diagnostics);
}

function deactivate() {
  return server && server.stop();
}

module.exports = { activate, deactivate };
