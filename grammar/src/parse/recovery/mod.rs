//! Error recovery: reads a text region by region.
//!
//! A region is an item or an entry of a block, which the grammar reads by itself, unless it is in
//! the cache. A region that cannot be read gives one diagnostic and is replaced by blanks, which
//! keeps every other place where it was; blocks and phases are first tried entry by entry, so that
//! one wrong equation does not cost the others.

mod adjacent;
mod brackets;
mod duplicate;
mod messages;
mod missing;
mod typos;
mod unknown;

use std::collections::HashSet;

use super::cache::ParseCache;
use super::grammar::Rule;
use super::lexical::items::{self, Region};
use super::lexical::limits::{self, Failure};
use super::lexical::tokens::{Kind, Token};
use crate::{Diagnostic, Parse, Span};

/// Nobody reads more errors than this, so nothing behind them is tried.
const MOST_DIAGNOSTICS: usize = 100;

/// Everything readable in a text with these tokens.
pub(super) fn read(text: &str, tokens: &[Token<'_>], cache: &mut ParseCache) -> Parse {
    let mut reading = Reading {
        tokens,
        cache,
        rest: text.to_owned(),
        diagnostics: Vec::new(),
        untold: None,
        unopened: 0,
        explained: 0,
        until: tokens.len(),
        lost: Vec::new(),
        long: HashSet::new(),
        phases: 0,
    };
    let mut parse = Parse::default();
    for region in items::items(tokens, 0..tokens.len()) {
        let is_model_line = region.start == 0 && tokens[0].text == "model";
        let rule = if is_model_line { Rule::only_model } else { Rule::only_item };
        if reading.mend(&region, rule, None) {
            let read = reading.cache.read(rule, &reading.rest[reading.bytes(&region)]);
            parse.append(read.expect("a mended region can be read"), tokens[region.start].start);
        }
    }
    let untold = reading.untold.filter(|_| reading.diagnostics.is_empty());
    parse.diagnostics.extend(reading.diagnostics.into_iter().chain(untold));
    parse.lost = reading.lost;
    parse
}

/// Phases do not nest. Of one inside of so many others nothing is read: each costs a look at all
/// that it holds.
const MOST_PHASES: usize = 4;

/// A block of fewer words and signs is read as soon as it is put together.
const FEW_TOKENS: usize = 20;

struct Reading<'t, 'm> {
    tokens: &'t [Token<'t>],
    cache: &'m mut ParseCache,
    /// The text, with blanks in place of what was wrong.
    rest: String,
    diagnostics: Vec<Diagnostic>,
    /// What another diagnostic should say already, in case that there is none.
    untold: Option<Diagnostic>,
    /// Items that were given up.
    lost: Vec<Span>,
    /// Where the file, phase or block ends that is being mended.
    until: usize,
    /// Blocks whose `{` was missed, so that their `}` needs no message of its own.
    unopened: usize,
    /// Tokens before this one belong to a mistake that has been told.
    explained: usize,
    /// Words and numbers that are too long; each is told once.
    long: HashSet<&'t str>,
    /// The phases around the region that is being mended.
    phases: usize,
}

impl<'t> Reading<'t, '_> {
    /// Makes a region readable if that can be done by leaving out broken entries, and reports what
    /// was wrong.
    fn mend(&mut self, region: &Region, rule: Rule, block: Option<&'t str>) -> bool {
        let before = self.diagnostics.len();
        if before < MOST_DIAGNOSTICS {
            let Err(failure) = self.read(region, rule) else { return true };
            self.mend_entries(region);
            let reported = self.diagnostics.len() > before;
            if reported && self.read(region, rule).is_ok() {
                return true;
            }
            if !reported && !self.is_consequence(region) {
                self.explain(region, block, &failure);
            }
        }
        if block.is_none() {
            self.lost.push(Span::new(self.bytes(region).start, self.bytes(region).end));
        }
        self.paint_over(region);
        false
    }

    fn explain(&mut self, region: &Region, block: Option<&'t str>, failure: &Failure) {
        if let Failure::LongWord(word) = failure
            && !self.long.insert(self.tokens[*word].text)
        {
            return;
        }
        let closer = self.closer_behind(region);
        match messages::explain(self.tokens, region, block, failure, closer) {
            (diagnostic, false) => self.diagnostics.push(diagnostic),
            (diagnostic, true) => drop(self.untold.get_or_insert(diagnostic)),
        }
        let tokens = &self.tokens[region.clone()];
        let braces = |text| tokens.iter().filter(|token| token.text == text).count();
        let head =
            tokens.split(|token| matches!(token.text, "=" | "'" | ":=")).next().unwrap_or(tokens);
        let has_brace = head.iter().any(|token| token.text == "{");
        let lacks_brace = match failure {
            Failure::Stopped(_, expected) => expected.contains(&Rule::left_brace),
            _ => false,
        };
        self.unopened +=
            usize::from(lacks_brace && !has_brace) + braces("{").saturating_sub(braces("}"));
        self.explained = region.end + usize::from(closer.is_some());
    }

    /// A bracket that closes nothing, on the line where the region ends.
    fn closer_behind(&self, region: &Region) -> Option<&'t Token<'t>> {
        self.tokens[..self.until].get(region.end).filter(|token| {
            token.kind == Kind::Close && !token.begins_line && self.is_unopened(region)
        })
    }

    /// Whether the brackets of a region are in order, so that one behind it closes nothing.
    fn is_unopened(&self, region: &Region) -> bool {
        let count =
            |kind| self.tokens[region.clone()].iter().filter(|token| token.kind == kind).count();
        count(Kind::Open) == count(Kind::Close)
    }

    /// Whether a region is what follows from a mistake that has been told: a bracket whose partner
    /// was missed.
    fn is_consequence(&mut self, region: &Region) -> bool {
        let first = &self.tokens[region.start];
        if first.kind != Kind::Close {
            return false;
        }
        let is_brace = first.text == "}" && self.unopened > 0;
        self.unopened -= usize::from(is_brace);
        is_brace || region.start < self.explained
    }

    /// Mends the items of a phase or the entries of a block, if the region is one.
    fn mend_entries(&mut self, region: &Region) {
        let word = self.tokens[region.start].text;
        let is_phase = word == "phase";
        let Some(inside) = self.inside(region) else { return };
        let Some(rule) = entry_rule(word) else { return };
        if self.phases >= MOST_PHASES {
            return;
        }
        let until = std::mem::replace(&mut self.until, inside.end);
        self.phases += usize::from(is_phase);
        for entry in self.entries(word, inside) {
            self.mend(&entry, rule, (!is_phase).then_some(word));
        }
        self.phases -= usize::from(is_phase);
        self.until = until;
    }

    /// What stands between the `{` behind the head of a block and its last `}`.
    fn inside(&self, region: &Region) -> Option<Region> {
        let tokens = &self.tokens[region.clone()];
        let first = tokens.iter().position(|token| token.text == "{")? + 1;
        if tokens[..first].iter().any(|token| matches!(token.text, "=" | "'" | "in" | ":=")) {
            return None;
        }
        let last = tokens.iter().rposition(|token| token.text == "}").unwrap_or(tokens.len());
        (first < last).then_some(region.start + first..region.start + last)
    }

    /// Reads a region, if it may be given to the grammar.
    fn read(&mut self, region: &Region, rule: Rule) -> Result<(), Failure> {
        if let Some(failure) = limits::exceeded(self.tokens, region) {
            return Err(failure);
        }
        if let Some(block) = self.composed(region, rule) {
            self.cache.learn(rule, &self.rest[self.bytes(region)], block);
            return Ok(());
        }
        let bytes = self.bytes(region);
        let read = self.cache.read(rule, &self.rest[bytes.clone()]);
        read.map(|_| ()).map_err(|(at, expected)| Failure::Stopped(bytes.start + at, expected))
    }

    /// A long block that is new, put together from its head and its entries, most of which are not;
    /// nothing where that cannot be done, and the grammar has to see the whole.
    fn composed(&mut self, region: &Region, rule: Rule) -> Option<Parse> {
        let word = self.tokens[region.start].text;
        let is_long = region.len() > FEW_TOKENS && matches!(word, "dynamics" | "phase");
        let is_closed = self.tokens[region.end - 1].text == "}";
        if !(is_long && is_closed) || self.cache.knows(rule, &self.rest[self.bytes(region)]) {
            return None;
        }
        let (inside, entry_rule) = (self.inside(region)?, entry_rule(word)?);
        let bytes = self.bytes(region);
        let head = &self.rest[bytes.start..self.tokens[inside.start - 1].end()];
        let mut block = self.cache.read(rule, &format!("{head}}}")).ok()?.clone();
        for entry in self.entries(word, inside) {
            self.read(&entry, entry_rule).ok()?;
            let place = self.bytes(&entry);
            let entry = self.cache.read(entry_rule, &self.rest[place.clone()]).ok()?;
            block.adopt(entry, place.start - bytes.start)?;
        }
        block.tree.items[0].span = Span::new(0, bytes.len());
        Some(block)
    }

    fn entries(&self, word: &str, inside: Region) -> Vec<Region> {
        if word == "phase" {
            items::items(self.tokens, inside)
        } else {
            items::entries(self.tokens, inside, word)
        }
    }

    fn bytes(&self, region: &Region) -> std::ops::Range<usize> {
        self.tokens[region.start].start..self.tokens[region.end - 1].end()
    }

    fn paint_over(&mut self, region: &Region) {
        let bytes = self.bytes(region);
        // Line breaks stay: whether a parenthesis is a call depends on its line.
        let keep = |byte| if matches!(byte, b'\n' | b'\r') { char::from(byte) } else { ' ' };
        let blanks: String =
            self.rest.as_bytes()[bytes.clone()].iter().copied().map(keep).collect();
        self.rest.replace_range(bytes, &blanks);
    }
}

/// The rule for one entry of a block or one item of a phase.
fn entry_rule(word: &str) -> Option<Rule> {
    Some(match word {
        "phase" => Rule::only_phase_item,
        "dynamics" => Rule::only_equation,
        "guess" | "report" => Rule::only_binding,
        "jump" | "link" => Rule::only_assignment,
        "method" => Rule::only_setting,
        "expect" => Rule::only_check,
        "sweep" => Rule::only_swept,
        _ => return None,
    })
}
