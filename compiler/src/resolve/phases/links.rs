//! `link a -> b { x := e }`: `x` at the start of `b` is `e` at the end of `a`.

use crate::expressions::graph::ExprId;
use crate::expressions::polynomial::difference;
use crate::model::{Constraint, Link, Place, Range, Symbol};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::phases::Handed;
use crate::resolve::elaborator::value::Parts;
use crate::syntax::scope::kind_word;
use crate::units;
use fdcc_grammar::ast::{Assignment, Ident, Item, ItemKind, Unit};
use fdcc_grammar::{Code, Diagnostic, Span};
use fdcc_runtime::problem::End;
use std::collections::{HashMap, HashSet};

impl<'a> Elaborator<'a> {
    /// The right sides of a link that begins with this phase.
    pub fn hand_over(&mut self, assignments: &'a [Assignment]) {
        for assignment in assignments {
            let mut value = self.evaluate_in(Context::LINK, &assignment.value);
            let parts = self.last_controls(value.parts.as_slice().to_vec());
            let parts = self.move_to_end(parts, true);
            value.parts = Parts::from_list(&parts);
            self.handed.push(Handed { assignment, value });
        }
    }

    /// States that stand outside of all phases begin with the first one: in a phase behind a link
    /// they go on.
    pub fn begin_by_link(&mut self, outer: &[&'a Item]) {
        for item in outer {
            if let ItemKind::State { name, parts, .. } = &item.kind
                && let Some(first) = self.scope.find(&name.name).and_then(|at| self.index_of(at))
            {
                for state in self.model.states[first..].iter_mut().take(parts.len().max(1)) {
                    (state.start, state.start_range) = (None, None);
                }
            }
        }
    }

    /// Replaces controls by their values in the last interval.
    fn last_controls(&mut self, parts: Vec<ExprId>) -> Vec<ExprId> {
        let mut last = HashMap::new();
        for input in self.graph.inputs_of(&parts) {
            if let Symbol::Control(at) = self.symbols[input as usize] {
                let symbol = Symbol::ControlAtEnd(at);
                let known = self.symbols.iter().position(|it| *it == symbol);
                let end = match known {
                    Some(input) => self.graph.input(input as u32),
                    None => self.symbol(symbol),
                };
                last.insert(input, end);
            }
        }
        self.graph.substitute(&parts, &|input| last.get(&input).copied())
    }

    /// A link between two phases that have been resolved.
    pub fn link(
        &mut self,
        from: &'a Ident,
        to: &'a Ident,
        same: Option<Span>,
        assignments: &'a [Assignment],
    ) {
        let [source, target] = [from, to].map(|name| self.linked_phase(name));
        let (Some(source), Some(target)) = (source, target) else { return };
        let name = format!("{} -> {}", from.name, to.name);
        let place = Place { name, span: from.span.to(to.span) };
        if source < target {
            self.times_meet([source, target], &place);
        }
        let mut rows = Vec::new();
        let mut given = HashSet::new();
        for assignment in assignments {
            let Some(states) = self.link_target(target, assignment) else { continue };
            given.extend(states.clone());
            let values = self.handed_over(source, assignment, states.len());
            let pairs: Vec<(usize, ExprId)> = states.zip(values).collect();
            rows.extend(pairs.into_iter().map(|it| self.link_row(&place, target, it)));
        }
        for (after, before) in self.continued(source, target, same.is_some()) {
            if !given.contains(&after) {
                let end = self.phases[source].meaning.at_ends[1][before];
                let end = self.import(source, &[end])[0];
                rows.push(self.link_row(&place, target, (after, end)));
            }
        }
        let ends = vec![End::Last(source), End::First(target)];
        self.model.links.push(Link { ends, objective: None, rows });
    }

    /// The states that go on unless a link says otherwise, in the second phase and in the first:
    /// those outside of all phases, or `same`, all that both have.
    fn continued(&self, source: usize, target: usize, same: bool) -> Vec<(usize, usize)> {
        let shared = self.model.states.len();
        let mut pairs: Vec<(usize, usize)> = (0..shared).map(|state| (state, state)).collect();
        let [before, after] = [source, target].map(|at| &self.phases[at].meaning.model.states);
        for (state, known) in after.iter().enumerate().skip(shared).filter(|_| same) {
            let like = before.iter().skip(shared).position(|it| it.place.name == known.place.name);
            pairs.extend(like.map(|like| (state, shared + like)));
        }
        pairs
    }

    /// Tells a gap between the end of a phase and the start of the one that follows.
    fn times_meet(&mut self, [source, target]: [usize; 2], place: &Place) {
        let before = self.phases[source].meaning.interval[1];
        let after = self.phases[target].meaning.interval[0];
        let times = [self.import(source, &[before])[0], self.import(target, &[after])[0]];
        let gap = difference(&mut self.graph, times[1], times[0]);
        let size = self.numeric(gap);
        let largest = times.map(|time| self.numeric(time).abs()).into_iter().fold(0.0, f64::max);
        if self.graph.as_number(gap) == Some(0.0) || size.abs() <= ROUNDING * largest {
            return;
        }
        let [first, second] = [source, target].map(|it| &self.phases[it].name.name);
        let message = format!("the time of `{second}` does not begin where that of `{first}` ends");
        let label = match size.is_nan() {
            true => "the times need not meet".into(),
            false => format!("a gap of {}", units::in_words(size, self.unit_of_time(target))),
        };
        let found = Diagnostic::new(Code::TimeGap, message, place.span, label);
        self.diagnostics.push(found.help(
            "nothing happens in between; to go on without a gap let the time of the second phase \
             begin with the end of the first: `time t in [T1, T1 + T2]` after `[0, T1]`",
        ));
    }

    /// The unit in which the time of a phase is declared.
    fn unit_of_time(&self, phase: usize) -> Option<&'a Unit> {
        self.phases[phase].names.values().find_map(|it| match &it.item.kind {
            ItemKind::Time { unit, .. } => unit.as_ref(),
            _ => None,
        })
    }

    fn linked_phase(&mut self, name: &Ident) -> Option<usize> {
        let found = self.phase_named(&name.name);
        if found.is_none() {
            let diagnostic = match self.scope.find(&name.name) {
                Some(at) => {
                    let kind = kind_word(self.scope.declarations[at].item);
                    let message = format!("`{}` is a {kind}, not a phase", name.name);
                    Diagnostic::new(Code::WrongKind, message, name.span, "a phase is needed here")
                        .help("name a `phase`")
                }
                None if self.scope.phases_of(&name.name).is_some() => {
                    let message = format!("`{}` is a phase for each file", name.name);
                    let label = "none of them follows another phase";
                    Diagnostic::new(Code::WrongKind, message, name.span, label).help(
                        "they stand beside each other, each with a time of its own; what they \
                         share is declared outside of them",
                    )
                }
                None => {
                    let example = format!("phase {} {{ ... }}", name.name);
                    self.scope.unknown(&name.name, name.span, &[], &example)
                }
            };
            self.diagnostics.push(diagnostic);
        }
        found
    }

    /// The states of the second phase that a line gives a value.
    fn link_target(
        &mut self,
        target: usize,
        assignment: &'a Assignment,
    ) -> Option<std::ops::Range<usize>> {
        let name = &assignment.name;
        let phase = &self.phases[target];
        let found = phase.names.get(name.name.as_str());
        let state = found.filter(|it| matches!(it.item.kind, ItemKind::State { .. }));
        let Some(state) = state else {
            let message = format!("the phase after the link has no state `{}`", name.name);
            let found = Diagnostic::new(Code::UnknownName, message, name.span, "not a state there");
            let help = format!("declare it in that phase: `state {}`", name.name);
            self.diagnostics.push(found.help(help));
            return None;
        };
        let first = phase.meaning.index_of_value(&state.value)?;
        let (item, size) = (state.item, state.value.parts.as_slice().len());
        self.assigned(assignment, item, first..first + size)
    }

    /// What a line of a link hands over, as many numbers as its state has.
    fn handed_over(&mut self, source: usize, line: &'a Assignment, size: usize) -> Vec<ExprId> {
        let handed = &self.phases[source].meaning.handed;
        let handed = handed.iter().find(|it| std::ptr::eq(it.assignment, line));
        let Some(value) = handed.map(|it| it.value.clone()) else { return Vec::new() };
        let parts = self.expect_parts(&value, size, line.value.span);
        self.import(source, &parts)
    }

    fn link_row(
        &mut self,
        link: &Place,
        target: usize,
        (state, value): (usize, ExprId),
    ) -> Constraint {
        let meaning = &self.phases[target].meaning;
        let name = format!("{}: {}", link.name, meaning.model.states[state].place.name);
        let start = meaning.at_ends[0][state];
        let start = self.import(target, &[start])[0];
        let value = self.graph.sub(start, value);
        let zero = self.graph.number(0.0);
        let range = Range { lower: zero, upper: zero };
        Constraint { place: Place { name, span: link.span }, value, range }
    }
}

/// Of times, relative to the larger one.
const ROUNDING: f64 = 1e-12;

/// The phases of a text in an order in which those that are linked stand next to each other, the
/// first one in front: as far as links are no circle.
pub(crate) fn in_order<'a>(items: &'a [Item]) -> Vec<&'a Item> {
    let mut phases: Vec<(&'a str, &'a Item)> = Vec::new();
    let mut links: HashMap<&str, Vec<&str>> = HashMap::new();
    for item in items {
        match &item.kind {
            ItemKind::Phase { name, .. } => phases.push((&name.name, item)),
            ItemKind::Link { from, to, .. } => links.entry(&from.name).or_default().push(&to.name),
            _ => {}
        }
    }
    let by_name: HashMap<&str, &'a Item> = phases.iter().rev().copied().collect();
    let later: HashSet<&str> = links.values().flatten().copied().collect();
    let (mut order, mut seen): (Vec<&'a Item>, HashSet<&str>) = Default::default();
    let first = phases.iter().filter(|it| !later.contains(it.0));
    for (name, item) in first.chain(&phases) {
        let (mut name, mut next) = (*name, Some(*item));
        while let Some(item) = next.filter(|_| seen.insert(name)) {
            order.push(item);
            let after = links.get(name).and_then(|all| all.iter().find(|it| !seen.contains(*it)));
            name = after.copied().unwrap_or(name);
            next = by_name.get(name).copied();
        }
    }
    order
}
