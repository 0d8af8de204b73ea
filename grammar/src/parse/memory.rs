//! What was read of a text before, so that a change costs no more than the item that it is in.
//!
//! What the grammar makes of a piece depends on nothing but its characters, so a piece that is written the same as before
//! is the same as before, wherever it stands now.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::{Rule, items, pairs};
use crate::Parse;

/// The pieces of a text as it was read last.
#[derive(Default)]
pub struct Memory {
    before: HashMap<(Rule, String), Parse>,
    now: HashMap<(Rule, String), Parse>,
}

impl Memory {
    /// What a piece says, its places counted from its first byte; or where the grammar gave up and what it would have
    /// gone on with. An entry of a block says nothing by itself: it is read again with its block.
    pub(super) fn read(&mut self, rule: Rule, text: &str) -> Result<&Parse, (usize, Vec<Rule>)> {
        Ok(match self.now.entry((rule, text.to_owned())) {
            Entry::Occupied(read) => read.into_mut(),
            Entry::Vacant(place) => {
                let read = match self.before.remove(place.key()) {
                    Some(read) => read,
                    None => read(rule, text)?,
                };
                place.insert(read)
            }
        })
    }

    /// Ends a text: what was not in it is forgotten.
    pub(super) fn forget(&mut self) {
        self.before = std::mem::take(&mut self.now);
    }
}

fn read(rule: Rule, text: &str) -> Result<Parse, (usize, Vec<Rule>)> {
    let pairs = pairs(rule, text)?;
    let is_item = matches!(rule, Rule::only_model | Rule::only_item);
    Ok(if is_item { items::parse_of(pairs) } else { Parse::default() })
}

#[test]
fn what_is_no_longer_in_the_text_is_forgotten() {
    let mut memory = Memory::default();
    super::parse_with(&mut memory, &"param a = 1\nparam b = 2\n".repeat(10));
    assert_eq!(memory.before.len(), 2, "equal pieces are kept once");
    super::parse_with(&mut memory, "param b = 2");
    assert_eq!(memory.before.len(), 1);
}
