//! Items: the pairs of the grammar become the items of the tree.

pub(super) mod blocks;
mod expressions;

use pest::iterators::{Pair, Pairs};

use super::grammar::Rule;
use super::tree::blocks::{child, children, ident};
use crate::ast::*;
use crate::{Diagnostic, Parse, Span};

/// The items and the model line of a text that has been read. An equation by itself is a block of
/// one; other entries say nothing without their block.
pub(super) fn parse_of(pairs: Pairs<'_, Rule>) -> Parse {
    let mut parse = Parse::default();
    let top = pairs.into_iter().next().expect("the grammar has one top");
    let is_entry = |rule| {
        !matches!(rule, Rule::file | Rule::only_model | Rule::only_item | Rule::only_phase_item)
    };
    if is_entry(top.as_rule()) && top.as_rule() != Rule::only_equation {
        return parse;
    }
    for pair in top.into_inner() {
        let mut reader = Reader { diagnostics: &mut parse.diagnostics, broken: false };
        match pair.as_rule() {
            Rule::EOI => {}
            Rule::model_line => parse.tree.name = Some(ident(&reader, &pair)),
            _ => parse.tree.items.extend(reader.item(pair)),
        }
    }
    parse
}

/// Builds one item, and notes what the grammar could not see.
pub(super) struct Reader<'d> {
    diagnostics: &'d mut Vec<Diagnostic>,
    /// Whether the item being read has been reported.
    broken: bool,
}

impl Reader<'_> {
    /// Where a pair stands in the text. A pair may have swallowed the blanks behind it, its last
    /// leaf has not.
    pub(super) fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let mut last = pair.clone();
        while let Some(inner) = last.clone().into_inner().next_back() {
            last = inner;
        }
        Span::new(pair.as_span().start(), last.as_span().end())
    }

    /// The name that a pair is.
    pub(super) fn name(&self, pair: &Pair<'_, Rule>) -> Ident {
        Ident { name: pair.as_str().to_owned(), span: self.span(pair) }
    }

    /// Notes that the item cannot be used. One report per item is enough.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        if !self.broken {
            self.diagnostics.push(diagnostic);
        }
        self.broken = true;
    }

    fn item(&mut self, pair: Pair<'_, Rule>) -> Option<Item> {
        self.broken = false;
        let kind = self.kind(&pair);
        // A phase has reported its own items, and lives without them.
        let usable = !self.broken || pair.as_rule() == Rule::phase;
        usable.then(|| Item { kind, span: self.span(&pair) })
    }

    fn kind(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        match pair.as_rule() {
            Rule::phase => {
                let like = child(pair, Rule::like).map(|like| ident(self, &like));
                let each = child(pair, Rule::each).map(|each| self.table(&each));
                let (name, items) = (ident(self, pair), self.phase_items(pair));
                ItemKind::Phase { name, like, each, items }
            }
            Rule::dynamics => ItemKind::Dynamics { equations: self.equations(pair) },
            Rule::equation => ItemKind::Dynamics { equations: vec![self.equation(pair)] },
            Rule::guess => ItemKind::Guess { bindings: self.bindings(pair) },
            Rule::report => ItemKind::Report { bindings: self.bindings(pair) },
            Rule::method => ItemKind::Method { settings: self.settings(pair) },
            Rule::sweep => ItemKind::Sweep { lists: self.swept(pair) },
            Rule::expect => ItemKind::Expect { checks: self.checks(pair) },
            Rule::metric => ItemKind::Metric { weights: self.weights(pair) },
            Rule::start => ItemKind::Start { condition: self.condition(pair) },
            Rule::end => ItemKind::End { condition: self.condition(pair) },
            Rule::at => ItemKind::At { time: self.one(pair), condition: self.condition(pair) },
            Rule::path => self.path(pair),
            Rule::objective => self.objective(pair),
            Rule::fit => self.fit(pair),
            Rule::plot => self.plot(pair),
            Rule::jump => self.jump(pair),
            Rule::link => self.link(pair),
            _ => self.declaration(pair),
        }
    }

    fn declaration(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        let name = ident(self, pair);
        let (unit, bounds) = (self.unit(pair), self.interval(pair));
        match pair.as_rule() {
            Rule::parameter => {
                ItemKind::Param { name, value: self.expression_in(pair), unit, bounds }
            }
            Rule::constant => ItemKind::Const { name, value: self.one(pair), unit },
            Rule::definition => ItemKind::Let { name, unit, value: self.one(pair) },
            Rule::signal => ItemKind::Signal { name, unit, value: self.one(pair) },
            Rule::function => {
                ItemKind::Fn { name, arguments: self.names(pair), body: self.one(pair) }
            }
            Rule::data => self.data(pair, name),
            Rule::free => ItemKind::Free { name, bounds, unit, guess: self.guess_value(pair) },
            Rule::time => {
                ItemKind::Time { name, interval: bounds.expect("a time has an interval"), unit }
            }
            Rule::state => ItemKind::State {
                name,
                parts: self.names(pair),
                unit,
                bounds,
                start: self.start(pair),
            },
            Rule::control => ItemKind::Control {
                name,
                parts: self.names(pair),
                bounds,
                unit,
                guess: self.guess_value(pair),
            },
            _ => ItemKind::Surface { name, value: self.one(pair) },
        }
    }

    fn data(&self, pair: &Pair<'_, Rule>, name: Ident) -> ItemKind {
        let Each { file, file_span, columns } = self.table(pair);
        ItemKind::Data { name, file, file_span, columns }
    }

    /// `csv("...") columns ...` of a data set, or of a phase for each file.
    fn table(&self, pair: &Pair<'_, Rule>) -> Each {
        let string = child(pair, Rule::string).expect("a table has a file");
        let columns =
            children(pair, Rule::column).map(|column| (ident(self, &column), self.unit(&column)));
        let file = string.as_str().trim_matches('"').to_owned();
        Each { file, file_span: self.span(&string), columns: columns.collect() }
    }

    fn guess_value(&mut self, pair: &Pair<'_, Rule>) -> Option<Expr> {
        child(pair, Rule::guess_value).map(|guess| self.one(&guess))
    }

    fn start(&mut self, pair: &Pair<'_, Rule>) -> Option<Start> {
        if let Some(value) = child(pair, Rule::start_value) {
            return Some(Start::Value(self.one(&value)));
        }
        let free = child(pair, Rule::start_free)?;
        let keyword = child(&free, Rule::kw_free).expect("`start free` has the word `free`");
        Some(Start::Free { span: self.span(&keyword), bounds: self.interval(&free) })
    }

    fn phase_items(&mut self, pair: &Pair<'_, Rule>) -> Vec<Item> {
        let keyword_or_punctuation = [
            Rule::kw_phase,
            Rule::name,
            Rule::like,
            Rule::each,
            Rule::left_brace,
            Rule::right_brace,
        ];
        let items = pair
            .clone()
            .into_inner()
            .filter(|inner| !keyword_or_punctuation.contains(&inner.as_rule()));
        items.filter_map(|inner| self.item(inner)).collect()
    }

    fn weights(&mut self, pair: &Pair<'_, Rule>) -> Vec<(Ident, Expr)> {
        children(pair, Rule::weight)
            .map(|weight| (ident(self, &weight), self.one(&weight)))
            .collect()
    }

    fn path(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        let name = child(pair, Rule::label).map(|label| ident(self, &label));
        ItemKind::Path { name, condition: self.condition(pair) }
    }

    fn objective(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        let keyword = child(pair, Rule::sense).expect("an objective has a sense");
        let sense = if keyword.as_str() == "minimize" { Sense::Minimize } else { Sense::Maximize };
        ItemKind::Objective { sense, keyword: self.span(&keyword), value: self.one(pair) }
    }

    fn fit(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        let keyword = child(pair, Rule::kw_fit).expect("a fit begins with its word");
        let mut signal = |fitted: Pair<'_, Rule>| {
            let sides = self.expressions_in(&fitted);
            let [signal, deviation] = sides.try_into().expect("a signal and its deviation");
            let reserved = child(&fitted, Rule::equal_to).map(|it| ident(self, &it));
            let column = child(&fitted, Rule::name).map(|column| self.name(&column)).or(reserved);
            Fitted { signal, column, deviation, span: self.span(&fitted) }
        };
        let signals = children(pair, Rule::fitted).map(&mut signal).collect();
        ItemKind::Fit { keyword: self.span(&keyword), data: ident(self, pair), signals }
    }

    fn plot(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        let mut curves = self.expressions_in(pair);
        let over = curves.pop().expect("a plot is over something");
        let border = child(pair, Rule::border);
        let borders = border.iter().flat_map(|it| children(it, Rule::name));
        let borders = borders.map(|it| self.name(&it)).collect();
        ItemKind::Plot { name: ident(self, pair), curves, over, borders }
    }

    fn jump(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        let direction = child(pair, Rule::direction).expect("a jump has a direction");
        let [name, surface] = self.two_names(pair);
        ItemKind::Jump {
            name,
            surface,
            direction: if direction.as_str() == "falling" {
                Direction::Falling
            } else {
                Direction::Rising
            },
            direction_span: self.span(&direction),
            at_most: child(pair, Rule::at_most).map(|limit| self.one(&limit)),
            then_hold: child(pair, Rule::then_hold).map(|hold| ident(self, &hold)),
            assignments: self.assignments(pair),
        }
    }

    fn link(&mut self, pair: &Pair<'_, Rule>) -> ItemKind {
        let [from, to] = self.two_names(pair);
        let same = child(pair, Rule::same).map(|same| self.span(&same));
        ItemKind::Link { from, to, same, assignments: self.assignments(pair) }
    }

    fn two_names(&self, pair: &Pair<'_, Rule>) -> [Ident; 2] {
        self.all_names(pair).try_into().expect("the grammar has two names here")
    }
}
