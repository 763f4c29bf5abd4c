//! `fretwork lsp`: a language server of cases on the standard streams. Diagnostics are the errors
//! of reading and checking a case; completion and hover come from the schema and the laws.

mod complete;
mod diagnose;
mod document;
mod hover;

use super::output::send;
use super::{Failure, PluginArgs};
use crate::laws::SearchPath;
use crate::scene::schema::{self, Schema};
use clap::Args;
use document::Document;
use lsp_server::{ErrorCode, Message, Notification, Request, Response};
use lsp_types::notification::{
    DidChangeTextDocument, DidCloseTextDocument, DidOpenTextDocument, DidSaveTextDocument,
    Notification as _, PublishDiagnostics,
};
use lsp_types::request::{Completion, HoverRequest, Initialize, Request as _, Shutdown};
use lsp_types::{
    CompletionOptions, CompletionParams, DidChangeTextDocumentParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams, HoverParams, HoverProviderCapability,
    PublishDiagnosticsParams, SaveOptions, ServerCapabilities, TextDocumentSyncCapability,
    TextDocumentSyncKind, TextDocumentSyncOptions, Uri,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::HashMap;

/// Arguments of `lsp`.
#[derive(Args, Debug)]
pub struct LspArgs {
    #[command(flatten)]
    plugins: PluginArgs,
    /// Standard streams, which are always used: editors may give it
    #[arg(long)]
    stdio: bool,
}

/// What the server knows.
struct Server {
    search: SearchPath,
    schema: Schema,
    documents: HashMap<String, Document>,
}

/// Serves until the client ends it.
pub fn serve(args: &LspArgs) -> Result<(), Failure> {
    // The streams that are served are these, whether `--stdio` is given or not.
    let _ = args.stdio;
    let search = args.plugins.search()?;
    let laws = super::law::usable(&search);
    let mut server = Server {
        schema: Schema::new(schema::case(&laws)),
        search,
        documents: HashMap::new(),
    };
    let mut input = std::io::stdin().lock();
    let mut ended = false;
    loop {
        let read = Message::read(&mut input);
        let message = read.map_err(|e| Failure::Failed(format!("no message of a client: {e}")))?;
        match message {
            // A client that ends without asking is an error by the protocol.
            None => {
                return Err(Failure::Failed(
                    "the client ended without `exit`".to_owned(),
                ));
            }
            Some(Message::Notification(n)) if n.method == "exit" => {
                return match ended {
                    true => Ok(()),
                    false => Err(Failure::Failed("`exit` came before `shutdown`".to_owned())),
                };
            }
            Some(Message::Request(request)) => {
                ended |= request.method == Shutdown::METHOD;
                reply(server.answer(request))?;
            }
            Some(Message::Notification(notification)) => server.notice(notification)?,
            Some(Message::Response(_)) => {}
        }
    }
}

fn reply(message: impl Into<Message>) -> Result<(), Failure> {
    let mut bytes = Vec::new();
    let message: Message = message.into();
    let written = message.write(&mut bytes);
    written.map_err(|e| Failure::Failed(format!("cannot write a message: {e}")))?;
    send(&bytes)
}

/// Reads parameters; those of another form are refused by the caller.
fn params<T: DeserializeOwned>(params: serde_json::Value) -> Option<T> {
    serde_json::from_value(params).ok()
}

impl Server {
    fn answer(&self, request: Request) -> Response {
        let Request { id, method, params } = request;
        fn result<T: Serialize>(value: T) -> Option<serde_json::Value> {
            serde_json::to_value(value).ok()
        }
        let found = match method.as_str() {
            Initialize::METHOD => result(serde_json::json!({
                "capabilities": capabilities(),
                "serverInfo": {"name": "fretwork", "version": env!("CARGO_PKG_VERSION")},
            })),
            Shutdown::METHOD => result(()),
            Completion::METHOD => self::params::<CompletionParams>(params).and_then(|params| {
                let at = params.text_document_position;
                let document = self.document(&at.text_document.uri);
                result(document.map(|d| complete::items(self, d, at.position)))
            }),
            HoverRequest::METHOD => self::params::<HoverParams>(params).and_then(|params| {
                let at = params.text_document_position_params;
                let document = self.document(&at.text_document.uri);
                result(document.and_then(|d| hover::hover(self, d, at.position)))
            }),
            _ => {
                let message = format!("there is no method `{method}`");
                return Response::new_err(id, ErrorCode::MethodNotFound as i32, message);
            }
        };
        match found {
            Some(value) => Response::new_ok(id, value),
            None => {
                let message = format!("wrong parameters of `{method}`");
                Response::new_err(id, ErrorCode::InvalidParams as i32, message)
            }
        }
    }

    fn document(&self, uri: &Uri) -> Option<&Document> {
        self.documents.get(uri.as_str())
    }

    fn notice(&mut self, notification: Notification) -> Result<(), Failure> {
        let Notification { method, params } = notification;
        match method.as_str() {
            DidOpenTextDocument::METHOD => {
                let Some(found) = self::params::<DidOpenTextDocumentParams>(params) else {
                    return Ok(());
                };
                let document = Document::new(&found.text_document.uri, found.text_document.text);
                self.keep(found.text_document.uri, document, true)
            }
            DidChangeTextDocument::METHOD => {
                let Some(found) = self::params::<DidChangeTextDocumentParams>(params) else {
                    return Ok(());
                };
                // Each change has the whole text, as the capabilities say.
                let Some(change) = found.content_changes.into_iter().next_back() else {
                    return Ok(());
                };
                let document = Document::new(&found.text_document.uri, change.text);
                self.keep(found.text_document.uri, document, false)
            }
            DidSaveTextDocument::METHOD => {
                let Some(found) = self::params::<DidSaveTextDocumentParams>(params) else {
                    return Ok(());
                };
                match self.documents.remove(found.text_document.uri.as_str()) {
                    Some(document) => self.keep(found.text_document.uri, document, true),
                    None => Ok(()),
                }
            }
            DidCloseTextDocument::METHOD => {
                let Some(found) = self::params::<DidCloseTextDocumentParams>(params) else {
                    return Ok(());
                };
                self.documents.remove(found.text_document.uri.as_str());
                publish(found.text_document.uri, Vec::new())
            }
            _ => Ok(()),
        }
    }

    /// Keeps a document, and publishes its errors; `whole` also builds the scene.
    fn keep(&mut self, uri: Uri, document: Document, whole: bool) -> Result<(), Failure> {
        let found = diagnose::diagnostics(self, &document, whole);
        self.documents.insert(uri.as_str().to_owned(), document);
        publish(uri, found)
    }
}

fn publish(uri: Uri, diagnostics: Vec<lsp_types::Diagnostic>) -> Result<(), Failure> {
    let params = PublishDiagnosticsParams::new(uri, diagnostics, None);
    let method = PublishDiagnostics::METHOD.to_owned();
    reply(Notification::new(method, params))
}

fn capabilities() -> ServerCapabilities {
    let triggers = ["(", ",", ":", "\"", " "].map(str::to_owned).to_vec();
    ServerCapabilities {
        text_document_sync: Some(TextDocumentSyncCapability::Options(
            TextDocumentSyncOptions {
                open_close: Some(true),
                change: Some(TextDocumentSyncKind::FULL),
                save: Some(SaveOptions::default().into()),
                ..TextDocumentSyncOptions::default()
            },
        )),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(triggers),
            ..CompletionOptions::default()
        }),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        ..ServerCapabilities::default()
    }
}
