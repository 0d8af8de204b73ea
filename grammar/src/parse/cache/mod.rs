//! The trees of the items of a text as it was parsed last, so that a change costs no more than the
//! item that it is in.
//!
//! What the grammar makes of a region depends on its characters alone. So a region with the same
//! characters has the same tree, wherever it stands now.

mod reparse;

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::grammar::{Rule, pairs};
use super::tree;
use crate::Parse;

/// The pieces of a text as it was read last.
#[derive(Default)]
pub struct ParseCache {
    before: HashMap<(Rule, String), Parse>,
    now: HashMap<(Rule, String), Parse>,
}

impl ParseCache {
    /// What a region says, its places counted from its first byte; or where the grammar gave up and
    /// what it would have gone on with.
    pub(crate) fn read(&mut self, rule: Rule, text: &str) -> Result<&Parse, (usize, Vec<Rule>)> {
        Ok(match self.place(rule, text) {
            Entry::Occupied(read) => read.into_mut(),
            Entry::Vacant(place) => place.insert(tree::parse_of(pairs(rule, text)?)),
        })
    }

    /// Whether a region has been read.
    pub(crate) fn knows(&mut self, rule: Rule, text: &str) -> bool {
        matches!(self.place(rule, text), Entry::Occupied(_))
    }

    /// Keeps what a region says.
    pub(crate) fn learn(&mut self, rule: Rule, text: &str, says: Parse) {
        self.place(rule, text).insert_entry(says);
    }

    /// Where a region is kept, with what was known of it.
    fn place(&mut self, rule: Rule, text: &str) -> Entry<'_, (Rule, String), Parse> {
        let key = (rule, text.to_owned());
        if let Some(read) = self.before.remove(&key) {
            self.now.insert(key.clone(), read);
        }
        self.now.entry(key)
    }

    /// Ends a text: what was not in it is forgotten.
    pub(crate) fn forget(&mut self) {
        self.before = std::mem::take(&mut self.now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_longer_in_the_text_is_forgotten() {
        let mut cache = ParseCache::default();
        crate::parse_with(&mut cache, &"param a = 1\nparam b = 2\n".repeat(10));
        assert_eq!(cache.before.len(), 2, "equal regions are kept once");
        crate::parse_with(&mut cache, "param b = 2");
        assert_eq!(cache.before.len(), 1);
    }
}
