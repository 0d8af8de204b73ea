//! Measured data: columns, sums over rows, values at the time of a row, curves through columns.

use super::calls::argument_span;
use crate::expressions::curve::{Shape, curve};
use crate::expressions::graph::ExprId;
use crate::model::{Place, Sum, Symbol, by_row};
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Reads, Traits, Value};
use crate::resolve::elaborator::{Curve, Elaborator, Rows};
use crate::syntax::{scope, text};
use crate::units;
use fdcc_grammar::ast::{Argument, Expr, ExprKind, Ident, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span};

/// What the trajectory has at a time.
pub(crate) const AT_A_TIME: Reads = Reads::TIME.or(Reads::STATE).or(Reads::CONTROL);

impl<'a> Elaborator<'a> {
    /// `obs.x`, or `k.x` for a row of it.
    pub fn data_column(&mut self, at: usize, column: usize, span: Span) -> Value {
        let Some(table) = self.table_of(at) else { return Value::default() };
        let part = self.known_symbol(Symbol::Column(table, column));
        let value = Value::scalar(part, Traits { reads: Reads::ROW, ..Traits::default() });
        let name = self.scope.declarations[at].name.name.as_str();
        self.admit(name, value, span)
    }

    /// `obs.t(end)`: a column in the last row, and with `start` in the first one; nothing of what
    /// is no column of a data set.
    pub fn column_at_an_end(&mut self, callee: &'a Expr, end: &Argument) -> Option<Value> {
        let ExprKind::Part(base, part) = &callee.kind else { return None };
        let ExprKind::Name(name) = &base.kind else { return None };
        if self.here.local(name).is_some() {
            return None;
        }
        let at = self.scope.find(name)?;
        let ItemKind::Data { columns, .. } = &self.scope.declarations[at].item.kind else {
            return None;
        };
        let column = columns.iter().position(|column| column.0.name == part.name)?;
        let Some(table) = self.table_of(at) else { return Some(Value::default()) };
        let values = &self.model.tables[table].columns[column];
        let value = if matches!(end, Argument::End(_)) { values.last() } else { values.first() };
        value.copied().map(|value| self.constant(value))
    }

    /// The table of a data set, among those of the model; none if it was not read.
    pub fn table_of(&mut self, at: usize) -> Option<usize> {
        let ItemKind::Data { file, file_span, .. } = &self.scope.declarations[at].item.kind else {
            return None;
        };
        let known = self.model.tables.iter().position(|table| table.is(*file_span, file));
        known.or_else(|| {
            self.model.tables.push(self.tables.get(*file_span, file)?.clone());
            Some(self.model.tables.len() - 1)
        })
    }

    /// `sum(k in data, term)`.
    pub fn sum(
        &mut self,
        name: &'a Ident,
        data: &'a Ident,
        term: &'a Expr,
        whole: &'a Expr,
    ) -> Value {
        let Some(at) = self.data_set(data) else { return Value::default() };
        if self.here.rows.is_some() {
            let found = Diagnostic::new(
                Code::NotAllowedHere,
                "a sum over data inside another one",
                whole.span,
                "each row would go through all rows",
            );
            return self.fail(found.help("give each data set a sum of its own"));
        }
        let row = Value { named: Some(at), ..Value::default() };
        self.here.locals.push((&name.name, row));
        self.here.rows = Some(Rows::default());
        let value = self.evaluate_in(self.here.context.of_rows(), term);
        let rows = self.here.rows.take().unwrap_or_default();
        self.here.locals.pop();
        let traits =
            Traits { reads: value.traits.reads.beyond(Reads::ROW), ..value.traits.clone() };
        let (Some(part), Some(table)) = (self.expect_number(&value, term.span), self.table_of(at))
        else {
            return Value::unknown(traits);
        };
        if !self.is_of_table(&[Some(part), rows.time], table, term.span) {
            return Value::default();
        }
        match rows.time {
            _ if self.here.examining => Value::unknown(traits),
            None => self.added_up(part, table, traits, whole),
            Some(time) => self.measured(Measured { part, table, time, term }, traits, whole),
        }
    }

    pub fn data_set(&mut self, data: &Ident) -> Option<usize> {
        let Some(at) = self.scope.find(&data.name) else {
            let declaration = format!("data {} = csv(\"FILE\") columns t, x", data.name);
            let found = self.scope.unknown(&data.name, data.span, &[], &declaration);
            self.diagnostics.push(found);
            return None;
        };
        let item = self.scope.declarations[at].item;
        if matches!(item.kind, ItemKind::Data { .. }) {
            return Some(at);
        }
        let kind = scope::kind_word(item);
        let message = format!("`{}` is a {kind}, not a data set", data.name);
        let found = Diagnostic::new(Code::WrongKind, message, data.span, format!("a {kind}"));
        self.diagnostics.push(found.help("declare it: `data obs = csv(\"FILE\") columns t, x`"));
        None
    }

    /// Whether all columns in some expressions belong to one data set.
    pub fn is_of_table(&mut self, parts: &[Option<ExprId>], table: usize, span: Span) -> bool {
        let parts: Vec<ExprId> = parts.iter().flatten().copied().collect();
        let other = self.graph.inputs_of(&parts).into_iter().find_map(|input| {
            match self.symbols[input as usize] {
                Symbol::Column(other, _) if other != table => Some(other),
                _ => None,
            }
        });
        let Some(other) = other else { return true };
        let [own, other] = [table, other].map(|at| self.model.tables[at].name.clone());
        let message = format!("columns of `{own}` and `{other}` in one row");
        let found = Diagnostic::new(Code::NotAllowedHere, message, span, "rows of two data sets");
        self.diagnostics.push(found.help(format!(
            "their rows do not belong together; for a value of `{other}` between its rows write \
             `interpolate({other}.TIME, {other}.COLUMN, k.TIME)`"
        )));
        false
    }

    /// A sum that reads nothing at the times of its rows: its terms, written out.
    fn added_up(&mut self, part: ExprId, table: usize, traits: Traits, whole: &'a Expr) -> Value {
        let terms: Vec<ExprId> = (0..self.model.tables[table].rows())
            .map(|row| {
                let values = self.row_values(table, row);
                self.graph.substitute(&[part], &|input| values[input as usize])[0]
            })
            .collect();
        let sum = self.graph.sum(&terms);
        self.admit("sum", Value::scalar(sum, traits), whole.span)
    }

    /// The numbers of a row, for the symbols that are its columns.
    fn row_values(&mut self, table: usize, row: usize) -> Vec<Option<ExprId>> {
        let columns = &self.model.tables[table].columns;
        let graph = &mut self.graph;
        let value = |symbol: &Symbol| match symbol {
            Symbol::Column(own, column) if *own == table => {
                Some(graph.number(columns[*column][row]))
            }
            _ => None,
        };
        self.symbols.iter().map(value).collect()
    }

    fn measured(&mut self, sum: Measured<'a>, traits: Traits, whole: &'a Expr) -> Value {
        let beyond = traits.reads.beyond(Reads::PARAM.or(Reads::FREE).or(Reads::PHASE));
        if !self.single_valued(&traits.sets, sum.term.span, "the term of a sum") {
            return Value::default();
        }
        if !beyond.is_empty() {
            let message = "a sum that reads the trajectory at the times of rows and elsewhere, too";
            let found = Diagnostic::new(Code::NotAllowedHere, message, sum.term.span, "two times");
            return self.fail(found.help(
                "its term may read columns, parameters, unknowns, and states and controls at the \
                 time of a row: `x(k.t)`",
            ));
        }
        let Measured { part: term, table, time, .. } = sum;
        let place = Place { name: text::expr(whole), span: whole.span };
        let sum = Sum { place, table, time, term, is_fit: false, is_shared: [false; 2] };
        let Some(part) = self.sum_over_rows(sum) else { return Value::default() };
        let traits = Traits { reads: Reads::WHOLE, ..traits };
        self.admit("sum", Value::scalar(part, traits), whole.span)
    }

    /// `x(k.t)`: the trajectory at the time of a row.
    pub fn at_a_row(&mut self, callee: &'a Expr, argument: &'a Argument, span: Span) -> Value {
        let Argument::Expr(at) = argument else {
            let found = Diagnostic::new(
                Code::NotAllowedHere,
                "only the time of a row can stand here",
                argument_span(argument),
                "no time",
            );
            return self.fail(found.help("write `x(k.t)` with the column of times"));
        };
        let time = self.evaluate_in(Context::ROW_TIME, at);
        let value = self.evaluate_in(Context::AT_A_ROW, callee);
        let reads = value.traits.reads.beyond(AT_A_TIME).or(Reads::ROW);
        let traits = Traits { reads, ..value.traits };
        let Some(time) = self.expect_number(&time, at.span) else { return Value::unknown(traits) };
        let rows = self.here.rows.as_mut().expect("only a sum has rows");
        if *rows.time.get_or_insert(time) != time {
            let message = "one sum reads the trajectory at two times of each row";
            let found = Diagnostic::new(Code::NotAllowedHere, message, span, "another time");
            return self.fail(found.help("write a sum for each time"));
        }
        self.admit(&text::expr(callee), Value { traits, ..value }, span)
    }

    /// `interpolate(times, values, at)`, perhaps with `cubic` behind it.
    pub fn interpolate(&mut self, arguments: &'a [Argument], span: Span) -> Value {
        let [Argument::Expr(times), Argument::Expr(values), Argument::Expr(at), shape @ ..] =
            arguments
        else {
            return self.no_arguments("interpolate", &arguments[0]);
        };
        let shape = self.shape(shape);
        let columns = [times, values].map(|column| {
            let value = self.evaluate_in(Context::TABLE, column);
            self.expect_number(&value, column.span)
        });
        let value = self.evaluate(at);
        let traits = value.traits.clone();
        if !self.single_valued(&traits.sets, at.span, "where a curve is read") {
            return Value::default();
        }
        let ([Some(x), Some(y)], Some(place), Some(shape)) =
            (columns, self.expect_number(&value, at.span), shape)
        else {
            return Value::unknown(traits);
        };
        let Some(table) = self.tabulated(&[x, y], span) else { return Value::unknown(traits) };
        let [x, y] = [x, y].map(|part| self.in_rows(table, part));
        if !self.ascends(table, &x, times.span) {
            return Value::unknown(traits);
        }
        let part = curve(&mut self.graph, shape, &x, &y, place);
        self.curves.push(Curve { table, ends: [x[0], x[x.len() - 1]], place, span });
        Value::scalar(part, traits)
    }

    fn shape(&mut self, word: &'a [Argument]) -> Option<Shape> {
        match word {
            [] => Some(Shape::Linear),
            [Argument::Expr(Expr { kind: ExprKind::Name(name), .. })] if name == "linear" => {
                Some(Shape::Linear)
            }
            [Argument::Expr(Expr { kind: ExprKind::Name(name), .. })] if name == "cubic" => {
                Some(Shape::Cubic)
            }
            [other, ..] => {
                let found = Diagnostic::new(
                    Code::NotAllowedHere,
                    "no way to go from point to point",
                    argument_span(other),
                    "neither `linear` nor `cubic`",
                );
                self.diagnostics.push(found.help("write `cubic` for a smooth curve, or nothing"));
                None
            }
        }
    }

    /// The data set of which some expressions over columns are made.
    fn tabulated(&mut self, parts: &[ExprId], span: Span) -> Option<usize> {
        let inputs = self.graph.inputs_of(parts);
        let table = inputs.iter().find_map(|input| match self.symbols[*input as usize] {
            Symbol::Column(table, _) => Some(table),
            _ => None,
        });
        let Some(table) = table else {
            let message = "a curve needs columns of measured data";
            let found = Diagnostic::new(Code::NotAllowedHere, message, span, "no column");
            self.diagnostics.push(found.help("write `interpolate(obs.t, obs.y, t)`"));
            return None;
        };
        let parts: Vec<Option<ExprId>> = parts.iter().copied().map(Some).collect();
        self.is_of_table(&parts, table, span).then_some(table)
    }

    fn in_rows(&self, table: usize, part: ExprId) -> Vec<f64> {
        let inputs = vec![f64::NAN; self.symbols.len()];
        let table = (table, &self.model.tables[table]);
        by_row(&self.graph, &self.symbols, table, part, inputs)
    }

    fn ascends(&mut self, table: usize, times: &[f64], span: Span) -> bool {
        let Some(row) = times.windows(2).position(|pair| pair[0] >= pair[1]) else { return true };
        let table = &self.model.tables[table];
        let message = format!("{} is not behind the row before it", table.row_in_words(row + 1));
        let [before, here] = [row, row + 1].map(|at| text::number(times[at]));
        let label = format!("{here} after {before}");
        let found = Diagnostic::new(Code::RowOrder, message, span, label);
        let found = found.label(table.place, "in this file");
        self.diagnostics.push(found.help(
            "a curve needs rows whose first column of the two ascends; sort them, and keep one of \
             those at the same place",
        ));
        false
    }

    /// Curves that are read over time, where time goes beyond their data.
    pub fn check_curves(&mut self) {
        let Some(time) = self.time.map(|time| self.graph.input(time)) else { return };
        let [first, last] = self.interval.map(|end| self.numeric(end));
        let unit = self.scope.declarations.iter().find_map(|it| match &it.item.kind {
            ItemKind::Time { unit, .. } => unit.as_ref(),
            _ => None,
        });
        for at in 0..self.curves.len() {
            let Curve { table, ends, place, span } = self.curves[at];
            let room = 1e-9 * (last - first).abs();
            if place != time || !(ends[0] > first + room || ends[1] < last - room) {
                continue;
            }
            let ends = [ends[0], ends[1], first, last];
            let [from, to, first, last] = ends.map(|it| units::in_words(it, unit));
            let message =
                format!("the data goes from {from} to {to}, and time from {first} to {last}");
            let label = "outside it has the value at the end";
            let found = Diagnostic::new(Code::BeyondTable, message, span, label);
            let found = found.label(self.model.tables[table].place, "this data");
            self.diagnostics.push(found.help("measure longer, or let time cover less"));
        }
    }
}

/// A sum that reads the trajectory at the times of rows.
struct Measured<'a> {
    part: ExprId,
    table: usize,
    time: ExprId,
    term: &'a Expr,
}
