//! The open texts, as the client has them on its screen.

use crate::pages;
use crate::snapshot::Snapshot;
use crate::text::{Encoding, Text};
use fdcc::DataFiles;
use fdcc_grammar::ParseCache;
use lsp_types::{TextDocumentContentChangeEvent, Uri};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// One open text.
pub struct TextDocument {
    /// Its address.
    pub uri: Uri,
    /// The client's number for this state of it.
    pub version: i32,
    /// The last state that could be read, for what a broken one does not tell.
    last_readable: Option<Rc<Snapshot>>,
    /// The last state without mistakes.
    last_model: Option<Rc<Snapshot>>,
    text: Text,
    snapshot: OnceCell<Rc<Snapshot>>,
    cache: RefCell<ParseCache>,
    is_published: bool,
}

impl TextDocument {
    /// What is known about it, found out when it is first asked for.
    pub fn snapshot(&self) -> &Rc<Snapshot> {
        self.snapshot.get_or_init(|| {
            let folder = pages::path(&self.uri).and_then(|path| Some(path.parent()?.to_owned()));
            let files = folder.map(DataFiles::in_folder);
            let cache = &mut self.cache.borrow_mut();
            Rc::new(Snapshot::new(self.text.clone(), cache, files.as_ref()))
        })
    }

    /// The last state that could be read: this one if possible.
    pub fn readable(&self) -> Option<&Rc<Snapshot>> {
        if self.snapshot().is_readable() {
            Some(self.snapshot())
        } else {
            self.last_readable.as_ref()
        }
    }

    /// The last state without mistakes: this one if possible.
    pub fn modelled(&self) -> Option<&Rc<Snapshot>> {
        if self.snapshot().has_meaning() { Some(self.snapshot()) } else { self.last_model.as_ref() }
    }

    fn become_text(&mut self, text: Text) {
        if let Some(snapshot) = self.snapshot.take() {
            if snapshot.is_readable() {
                self.last_readable = Some(snapshot.clone());
            }
            if snapshot.has_meaning() {
                self.last_model = Some(snapshot);
            }
        }
        self.text = text;
        self.is_published = false;
    }
}

/// All open texts.
#[derive(Default)]
pub struct Documents {
    open: BTreeMap<String, TextDocument>,
}

impl Documents {
    /// The text at an address, if it is open.
    pub fn get(&self, uri: &Uri) -> Option<&TextDocument> {
        self.open.get(&uri.0)
    }

    /// All texts, in the order of their addresses.
    pub fn all(&self) -> impl Iterator<Item = &TextDocument> {
        self.open.values()
    }

    /// A text is opened, or opened anew.
    pub fn open(&mut self, uri: Uri, version: i32, text: &str, encoding: Encoding) {
        let text = Text::new(text, encoding);
        let document = TextDocument {
            uri: uri.clone(),
            version,
            last_readable: None,
            last_model: None,
            text,
            snapshot: OnceCell::new(),
            cache: RefCell::default(),
            is_published: false,
        };
        self.open.insert(uri.0, document);
    }

    /// A text is changed, piece by piece.
    pub fn change(&mut self, uri: &Uri, version: i32, changes: &[TextDocumentContentChangeEvent]) {
        let Some(document) = self.open.get_mut(&uri.0) else { return };
        let mut text = document.text.clone();
        for change in changes {
            text = match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(it) => {
                    text.changed(it.range, &it.text)
                }
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(it) => {
                    Text::new(it.text.as_str(), text.encoding())
                }
            };
        }
        document.version = version;
        document.become_text(text);
    }

    /// A text is closed; says whether it was open.
    pub fn close(&mut self, uri: &Uri) -> bool {
        self.open.remove(&uri.0).is_some()
    }

    /// A text that has changed since something was said about it.
    pub fn next_unpublished(&self) -> Option<&TextDocument> {
        self.open.values().find(|document| !document.is_published)
    }

    /// Whether all has been said about a text.
    pub fn set_published(&mut self, uri: &Uri, is_published: bool) {
        if let Some(document) = self.open.get_mut(&uri.0) {
            document.is_published = is_published;
        }
    }
}
