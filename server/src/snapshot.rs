//! All that is known about one state of a text.

use crate::text::Text;
use fdcc::DataFiles;
use fdcc::language::Reading;
use fdcc_grammar::ParseCache;
use std::ops::Deref;

/// One state of a text, what it means and what is wrong with it.
pub struct Snapshot {
    /// The text.
    pub text: Text,
    reading: Reading,
}

impl Snapshot {
    /// Reads and checks a text, with a cache of its former states and the data files beside it.
    pub fn new(text: Text, cache: &mut ParseCache, files: Option<&DataFiles>) -> Self {
        let reading = Reading::new(&text.text, cache, files);
        Snapshot { text, reading }
    }
}

impl Deref for Snapshot {
    type Target = Reading;

    fn deref(&self) -> &Reading {
        &self.reading
    }
}
