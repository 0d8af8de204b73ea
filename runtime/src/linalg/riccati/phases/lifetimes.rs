//! Through which phases an unknown, or the multiplier of a coupling row, is carried in the border.
//!
//! Node `j` stands before phase `j`, the last one behind all phases. Going backward a member of the
//! border is *born* at a node, the first that has an entry of it, and *dies* where it is
//! eliminated: an unknown before the first phase that has to do with it; a row that holds for a
//! first state with this state, which makes up for its multiplier; any other row before the phase
//! at whose end it holds, or an earlier one where that phase has no controls.

use super::direct::Direct;
use crate::linalg::structure::phases::PhaseStages;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// A variable or row at the ends of phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Item {
    /// A component of the first state of a phase.
    First(usize, usize),
    /// A component of the last state of a phase.
    Last(usize, usize),
    /// An unknown, by its place among all variables.
    Unknown(usize),
    /// A coupling row.
    Row(usize),
    /// The stages of a phase, as far as they touch an unknown.
    Stages(usize),
}

impl Item {
    pub fn unknown(&self) -> Option<usize> {
        match self {
            Item::Unknown(place) => Some(*place),
            _ => None,
        }
    }
}

/// The node at which each member of the border is born, and that at which it dies.
pub(super) struct Lifetimes {
    spans: Spans,
    /// Rows for which a first state, or a slack of their own, makes up.
    links: BTreeSet<Item>,
}

type Spans = BTreeMap<Item, [usize; 2]>;

impl Lifetimes {
    /// Finds them, with those members of the border that are `waiting` for an earlier node; or says
    /// why an entry has no node at which both of its members are there. Each row says whether it is
    /// an equality.
    pub fn new(
        phases: &[PhaseStages],
        unknowns: Range<usize>,
        rows: &[(usize, bool)],
        direct: &[Direct],
        waiting: &BTreeMap<Item, usize>,
    ) -> Result<Self, &'static str> {
        let members = unknowns.map(Item::Unknown).chain(rows.iter().map(|it| Item::Row(it.0)));
        let mut spans: Spans = members.map(|item| (item, [0, phases.len()])).collect();
        let mut touched: BTreeMap<Item, Vec<Item>> = BTreeMap::new();
        for entry in direct {
            touched.entry(entry.first).or_default().push(entry.second);
            touched.entry(entry.second).or_default().push(entry.first);
        }
        let of = |item: &Item| touched.get(item).map_or(&[][..], Vec::as_slice);
        for (item, span) in spans.iter_mut() {
            *span = alone(phases.len(), item, of(item));
        }
        let rows_alone = spans.clone();
        for (item, span) in spans.iter_mut().filter(|(item, _)| item.unknown().is_some()) {
            *span = as_rows(item, of(item), &rows_alone).unwrap_or(*span);
        }
        // Rows over unknowns alone die with the first of them.
        let known = spans.clone();
        for (item, span) in spans.iter_mut().filter(|(item, _)| matches!(item, Item::Row(_))) {
            let is_unknown = |it: &&Item| it.unknown().is_some();
            if of(item).iter().all(|it| is_unknown(&it)) {
                let deaths = of(item).iter().map(|it| known[it][1]);
                span[1] = deaths.max().unwrap_or(phases.len());
                span[0] = span[1];
            }
        }
        // An inequality has a slack that makes up for it.
        let is_loose = |item: &Item| rows.iter().any(|it| Item::Row(it.0) == *item && !it.1);
        let loose: BTreeSet<Item> = spans.keys().filter(|it| is_loose(it)).copied().collect();
        let kind = |item: &Item| match loose.contains(item) {
            true => Kind::Loose,
            false => kind(item, of(item)),
        };
        // In a restoration every row has slacks.
        if rows.iter().any(|it| it.1) {
            (1..phases.len()).rev().for_each(|j| delay(&mut spans, j, &phases[j], &kind));
        }
        // What was found to have nothing that makes up for it waits.
        for (item, node) in waiting {
            spans.entry(*item).and_modify(|span| span[1] = span[1].min(*node));
        }
        let has_own = |item: &&Item| matches!(kind(item), Kind::Link | Kind::Loose);
        let links = spans.keys().filter(has_own).copied().collect();
        let mut lifetimes = Lifetimes { spans, links };
        direct.iter().for_each(|entry| lifetimes.meet(entry));
        let fits = |entry: &Direct| lifetimes.place(entry, phases.len()).is_some();
        if direct.iter().filter(|entry| entry.count > 0).all(fits) {
            Ok(lifetimes)
        } else {
            Err("distant phases are tied")
        }
    }

    /// Two members of the border that share an entry are both there where the first of them dies.
    fn meet(&mut self, entry: &Direct) {
        let spans = [entry.first, entry.second].map(|item| self.spans.get(&item).copied());
        let [Some(first), Some(second)] = spans else { return };
        let node = first[1].max(second[1]);
        for item in [entry.first, entry.second] {
            let span = self.spans.get_mut(&item).expect("it was found");
            span[0] = span[0].max(node);
        }
    }

    /// The node at which an entry is added.
    pub fn place(&self, entry: &Direct, last: usize) -> Option<usize> {
        let node = |item: Item| match item {
            Item::First(phase, _) => Some([phase, phase]),
            Item::Last(phase, _) => Some([phase + 1, phase + 1]),
            Item::Stages(_) => None,
            other => self.spans.get(&other).copied(),
        };
        let ([born, dies], [other_born, other_dies]) = (node(entry.first)?, node(entry.second)?);
        let at = dies.max(other_dies);
        (at <= last && at <= born.min(other_born)).then_some(at)
    }

    /// The border of a phase: unknowns, then rows.
    pub fn theta(&self, phase: usize) -> Vec<Item> {
        let is_there = |(_, [born, dies]): &(&Item, &[usize; 2])| *dies <= phase && phase < *born;
        self.spans.iter().filter(is_there).map(|(item, _)| *item).collect()
    }

    /// Whether a member of the border is an unknown, or a row that holds at the end of a phase,
    /// that dies at a node and can wait.
    pub fn may_wait(&self, item: &Item, node: usize) -> bool {
        let is_later = self.spans.get(item).is_some_and(|span| span[1] == node && node > 0);
        is_later && !self.links.contains(item)
    }

    /// What dies at a node.
    pub fn dying(&self, node: usize) -> impl Iterator<Item = Item> {
        let all = self.spans.iter();
        all.filter(move |(_, [_, dies])| *dies == node).map(|(item, _)| *item)
    }
}

/// What cannot be eliminated at node `j`, because nothing there makes up for it, waits for an
/// earlier phase.
fn delay(spans: &mut Spans, j: usize, phase: &PhaseStages, kind: &dyn Fn(&Item) -> Kind) {
    let dying = |of: Kind| -> Vec<Item> {
        let those = spans.iter().filter(|(item, span)| span[1] == j && kind(item) == of);
        those.map(|(item, _)| *item).collect()
    };
    let [unknowns, links, starts, ends] =
        [Kind::Unknown, Kind::Link, Kind::Start, Kind::End].map(dying);
    let mut waiting = Vec::new();
    // The first state is what links make of it, unless these are fewer than its components.
    if links.len() + starts.len() > phase.stages.states {
        waiting.extend(starts);
    }
    // Without controls the end of a phase follows from its begin and its unknowns: one unknown may
    // make up for one row, such as the time at which a surface is reached.
    let is_paired = unknowns.len() <= 1 && unknowns.len() == ends.len();
    // Where no row leads to an earlier phase there is none that could make up for anything.
    let is_apart = links.is_empty() && ends.is_empty();
    if phase.stages.controls == 0 && !is_paired && !is_apart {
        waiting.extend(unknowns.into_iter().chain(ends));
    }
    for item in waiting {
        spans.entry(item).and_modify(|span| span[1] = j - 1);
    }
}

/// What a member of the border is.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Unknown,
    /// A row for a first state and a last one of another phase.
    Link,
    /// A row for a first state.
    Start,
    /// A row for a last state, or for unknowns.
    End,
    /// A row with a slack.
    Loose,
}

fn kind(item: &Item, touched: &[Item]) -> Kind {
    let first = touched.iter().find_map(|it| match it {
        Item::First(phase, _) => Some(phase),
        _ => None,
    });
    let is_link =
        |it: &Item| matches!(it, Item::Last(phase, _) if first.is_some_and(|j| j != phase));
    match (item, first) {
        (Item::Unknown(_), _) => Kind::Unknown,
        (_, None) => Kind::End,
        (_, Some(_)) if touched.iter().any(is_link) => Kind::Link,
        (_, Some(_)) => Kind::Start,
    }
}

/// An unknown that rows alone read, such as one for the start of a phase, is there as long as
/// these are.
fn as_rows(unknown: &Item, touched: &[Item], spans: &Spans) -> Option<[usize; 2]> {
    let rows: Vec<&Item> = touched.iter().filter(|it| *it != unknown).collect();
    if !rows.iter().all(|it| matches!(it, Item::Row(_))) {
        return None;
    }
    let lives = rows.iter().filter_map(|row| spans.get(*row));
    let dies = lives.clone().map(|it| it[1]).min()?;
    Some([lives.map(|it| it[0]).fold(dies, usize::max), dies])
}

/// Birth and death of a member of the border by the ends and stages that it touches.
fn alone(last: usize, item: &Item, touched: &[Item]) -> [usize; 2] {
    let is_row = matches!(item, Item::Row(_));
    let has_first = touched.iter().any(|it| matches!(it, Item::First(..)));
    let (mut born, mut dies) = (0, last);
    for it in touched {
        let [first, until] = match *it {
            Item::First(phase, _) => [phase, phase],
            // The state makes up for the multiplier at its own node.
            Item::Last(phase, _) if is_row && has_first => [phase + 1, phase + 1],
            Item::Last(phase, _) | Item::Stages(phase) => [phase + 1, phase],
            _ => continue,
        };
        (born, dies) = (born.max(first), dies.min(until));
    }
    [born.max(dies), dies]
}
