//! The words of a readable text with what each is for, as `format` needs it: everything that was
//! written, nothing of what it means.
//!
//! The quick reading of `tokens` gives the words, the grammar their parts in the whole: which
//! begins an entry, which a column of it, and which minus is a sign.

use std::collections::BTreeMap;

use pest::iterators::Pair;

use super::grammar::{Rule, pairs};
use super::lexical::tokens::tokens;

/// What a word is for, as far as its blanks depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Nothing special.
    Plain,
    /// A minus without left side.
    Negation,
    /// `*` or `/` between values, which are written with or without blanks.
    Product,
    /// What belongs to the word before it: `(` of a call, `[` of an index.
    Suffix,
    /// A sign inside a unit.
    UnitSign,
}

/// What begins with a word. Neighbours of the same kind line up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Row {
    /// An item or entry that is never lined up.
    Alone,
    /// `param`, `const` and `let`.
    Number,
    /// An item that lines up with others of its kind only.
    Item(&'static str),
    /// `x' = v` and `x' in v`
    Equation,
    /// `x = v` and `x := v`
    Binding,
    /// `x <= 1 => v`
    Arm,
}

/// The columns in which rows line up; the first one needs no name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Column {
    /// The name of a number, behind `param`, `const` or `let`.
    Name,
    /// `[m/s]`
    Unit,
    /// `in [0, 1]`
    Bounds,
    /// The rest: what follows `=`, `=>`, `start` or `guess`, with that word.
    Rest,
}

/// A word and what it is for.
#[derive(Clone, Debug)]
pub(crate) struct Leaf<'t> {
    pub text: &'t str,
    pub start: usize,
    pub part: Part,
    pub row: Option<Row>,
    pub column: Option<Column>,
}

impl Leaf<'_> {
    /// One past its last byte.
    pub fn end(&self) -> usize {
        self.start + self.text.len()
    }
}

/// All words of a text that the grammar accepts.
pub(crate) fn outline(text: &str) -> Vec<Leaf<'_>> {
    let mut marks = Marks::default();
    for pair in pairs(Rule::file, text).into_iter().flat_map(|pairs| pairs.flatten()) {
        marks.read(&pair);
    }
    let mut leaves: Vec<Leaf<'_>> = Vec::new();
    let mut end_of_atom = 0;
    for token in tokens(text) {
        if token.start < end_of_atom {
            continue;
        }
        let at = token.start;
        end_of_atom = marks.atoms.get(&at).copied().unwrap_or(token.end());
        leaves.push(Leaf {
            text: &text[at..end_of_atom],
            start: at,
            part: marks.parts.get(&at).copied().unwrap_or(Part::Plain),
            row: marks.rows.get(&at).copied(),
            column: marks.columns.get(&at).copied(),
        });
    }
    leaves
}

/// What the grammar says, by the first byte of the word.
#[derive(Default)]
struct Marks {
    parts: BTreeMap<usize, Part>,
    rows: BTreeMap<usize, Row>,
    columns: BTreeMap<usize, Column>,
    /// One past the last byte of words that are read as several tokens, such as `°C`.
    atoms: BTreeMap<usize, usize>,
}

impl Marks {
    fn read(&mut self, pair: &Pair<'_, Rule>) {
        let start = pair.as_span().start();
        match pair.as_rule() {
            Rule::name | Rule::word | Rule::unit_name | Rule::number | Rule::exponent => {
                self.atom(pair)
            }
            Rule::negation => self.part(start, Part::Negation),
            Rule::operator | Rule::scaling | Rule::times if matches!(pair.as_str(), "*" | "/") => {
                self.part(start, Part::Product)
            }
            Rule::unit_operator => self.part(start, Part::UnitSign),
            Rule::call | Rule::index | Rule::part | Rule::prime => self.part(start, Part::Suffix),
            rule => self.read_row(pair, rule, start),
        }
    }

    fn part(&mut self, at: usize, part: Part) {
        self.parts.insert(at, part);
    }

    fn row(&mut self, at: usize, row: Row) {
        self.rows.insert(at, row);
    }

    fn column(&mut self, at: usize, column: Column) {
        self.columns.insert(at, column);
    }

    fn atom(&mut self, pair: &Pair<'_, Rule>) {
        self.atoms.insert(pair.as_span().start(), pair.as_span().end());
    }

    fn read_row(&mut self, pair: &Pair<'_, Rule>, rule: Rule, start: usize) {
        let row = match rule {
            Rule::parameter | Rule::constant | Rule::definition => Row::Number,
            Rule::signal => Row::Alone,
            Rule::function => Row::Item("fn"),
            Rule::surface => Row::Item("surface"),
            Rule::state => Row::Item("state"),
            Rule::control => Row::Item("control"),
            Rule::free => Row::Item("free"),
            Rule::equation if starts_with(pair, Rule::derivative) => Row::Equation,
            Rule::binding | Rule::assignment | Rule::swept => Row::Binding,
            Rule::arm => Row::Arm,
            Rule::model_line
            | Rule::data
            | Rule::time
            | Rule::dynamics
            | Rule::metric
            | Rule::jump
            | Rule::start
            | Rule::end
            | Rule::at
            | Rule::path
            | Rule::objective
            | Rule::fit
            | Rule::guess
            | Rule::phase
            | Rule::link
            | Rule::method
            | Rule::sweep
            | Rule::report
            | Rule::plot
            | Rule::expect
            | Rule::equation
            | Rule::check => Row::Alone,
            Rule::piecewise | Rule::switch => return self.read_sides(pair),
            Rule::each => return self.read_columns(pair, Row::Alone),
            _ => return,
        };
        self.row(start, row);
        self.read_columns(pair, row);
        if rule == Rule::method {
            self.read_settings(pair);
        }
    }

    /// The settings of a method; a plain one lines up, and what follows `smooth` and `grid` belongs
    /// to them.
    fn read_settings(&mut self, method: &Pair<'_, Rule>) {
        let mut goes_on: &[Rule] = &[];
        for child in method.clone().into_inner() {
            let rule = child.as_rule();
            if let Some(at) = goes_on.iter().position(|next| *next == rule) {
                goes_on = &goes_on[at + 1..];
                continue;
            }
            let at = child.as_span().start();
            goes_on = match rule {
                Rule::kw_smooth => &[Rule::entry, Rule::kernel],
                Rule::kw_grid => &[Rule::entry, Rule::steps, Rule::scheme],
                _ => &[],
            };
            match rule {
                Rule::entry => {
                    self.row(at, Row::Binding);
                    self.read_columns(&child, Row::Binding);
                }
                Rule::kw_smooth
                | Rule::kw_grid
                | Rule::continuation
                | Rule::kernel
                | Rule::steps
                | Rule::scheme => self.row(at, Row::Alone),
                _ => {}
            }
        }
    }

    /// `otherwise`, `below` and `above` begin rows as guards do.
    fn read_sides(&mut self, pair: &Pair<'_, Rule>) {
        for child in pair.clone().into_inner() {
            let at = child.as_span().start();
            match child.as_rule() {
                Rule::kw_otherwise | Rule::kw_below | Rule::kw_above => self.row(at, Row::Arm),
                Rule::implies => self.column(at, Column::Rest),
                _ => {}
            }
        }
    }

    fn read_columns(&mut self, pair: &Pair<'_, Rule>, row: Row) {
        for child in pair.clone().into_inner() {
            let at = child.as_span().start();
            let column = match child.as_rule() {
                Rule::name if row == Row::Number => Column::Name,
                Rule::unit if matches!(row, Row::Item(_)) => Column::Unit,
                Rule::kw_in if matches!(row, Row::Item(_)) => Column::Bounds,
                Rule::equals
                | Rule::assigns
                | Rule::implies
                | Rule::becomes
                | Rule::start_value
                | Rule::start_free
                | Rule::guess_value
                    if row != Row::Alone =>
                {
                    Column::Rest
                }
                Rule::names | Rule::left_parenthesis => {
                    self.part(at, Part::Suffix);
                    continue;
                }
                _ => continue,
            };
            self.column(at, column);
        }
    }
}

fn starts_with(pair: &Pair<'_, Rule>, rule: Rule) -> bool {
    pair.clone().into_inner().next().is_some_and(|first| first.as_rule() == rule)
}
