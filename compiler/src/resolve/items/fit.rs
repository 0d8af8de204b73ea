//! `fit obs: x sd 0.1`: squares of what was measured, in standard deviations, summed over rows.

use crate::expressions::graph::ExprId;
use crate::model::{Place, Sum};
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Reads, Traits, Value};
use crate::resolve::elaborator::{Elaborator, Role, Rows};
use crate::resolve::expressions::data::AT_A_TIME;
use crate::syntax::text;
use fdcc_grammar::ast::{Expr, ExprKind, Fitted, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span};

impl<'a> Elaborator<'a> {
    /// A sum for each signal.
    pub fn fit(&mut self, keyword: Span, data: &'a Ident, signals: &'a [Fitted]) {
        let Some(at) = self.data_set(data) else { return };
        let Some(time) = self.times_of(at, data) else { return };
        self.fits.get_or_insert((keyword, Vec::new()));
        self.fitted_twice(signals);
        for fitted in signals {
            let sum = self.fitted(at, time, fitted);
            self.fits.iter_mut().for_each(|fits| fits.1.extend(sum));
        }
    }

    /// A signal that is compared with the same column twice would count twice.
    fn fitted_twice(&mut self, signals: &'a [Fitted]) {
        let column = |it: &'a Fitted| it.column.as_ref().map(|column| column.name.as_str());
        let is_same = |a: &'a Fitted, b: &'a Fitted| {
            text::expr(&a.signal) == text::expr(&b.signal) && column(a) == column(b)
        };
        for (at, own) in signals.iter().enumerate() {
            if let Some(first) = signals[..at].iter().find(|it| is_same(it, own)) {
                let message = format!("`{}` is fitted twice", text::expr(&own.signal));
                let found = Diagnostic::new(Code::DuplicateName, message, own.span, "again");
                let found = found.label(first.span, "first here");
                self.diagnostics.push(found.help(
                    "its rows would count twice; leave one out, or name another column: \
                     `x = second sd 0.1`",
                ));
            }
        }
    }

    /// The sums of all `fit`, added to what is minimised.
    pub fn add_fits(&mut self) {
        let Some((keyword, mut terms)) = self.fits.take() else { return };
        match &self.model.objective {
            Some((place, _)) if self.model.sense < 0.0 => {
                let message = "a fit makes squares small, and the objective is maximised";
                let found = Diagnostic::new(Code::NotAllowedHere, message, keyword, "minimised");
                let found = found.label(place.span, "maximised");
                self.diagnostics.push(found.help("write `minimize` with the other sign"));
            }
            Some((place, value)) => {
                terms.push(*value);
                let sum = self.graph.sum(&terms);
                self.model.objective = Some((place.clone(), sum));
            }
            None => {
                let place = Place { name: "fit".into(), span: keyword };
                let sum = self.graph.sum(&terms);
                self.model.objective = Some((place, sum));
            }
        }
    }

    /// The column that has the time of each row: it is called as the time is, or else `time`.
    fn times_of(&mut self, at: usize, data: &'a Ident) -> Option<ExprId> {
        let is_time = |item: &Item| matches!(item.kind, ItemKind::Time { .. });
        let own = self.scope.declarations.iter().filter(|it| is_time(it.item));
        let inner = self.phases.iter().flat_map(|phase| &phase.names);
        let inner = inner.filter(|it| is_time(it.1.item)).map(|it| *it.0);
        let names: Vec<&str> = own.map(|it| it.name.name.as_str()).chain(inner).collect();
        let mut all = names.iter().chain(&["time"]);
        if let Some(column) = all.find_map(|name| self.place_of_column(at, name)) {
            let outer = self.here.enter(Context::FIT);
            let times = self.data_column(at, column, data.span);
            self.here.context = outer;
            return times.parts.as_slice().first().copied();
        }
        let name = names.first().unwrap_or(&"t");
        let message = format!("`{}` has no column `{name}` with the times of its rows", data.name);
        let found = Diagnostic::new(Code::UnknownPart, message, data.span, "at which times?");
        self.diagnostics.push(found.help(format!(
            "name the column of times as the time of the model: `columns {name}, ...`"
        )));
        None
    }

    fn place_of_column(&self, at: usize, name: &str) -> Option<usize> {
        let ItemKind::Data { columns, .. } = &self.scope.declarations[at].item.kind else {
            return None;
        };
        columns.iter().position(|column| column.0.name == name)
    }

    fn fitted(&mut self, at: usize, time: ExprId, fitted: &'a Fitted) -> Option<ExprId> {
        let column = self.column_of(at, fitted)?;
        let outer = self.here.enter(Context::FIT);
        self.here.rows = Some(Rows { time: Some(time) });
        let measured = self.data_column(at, column, fitted.span);
        let deviation = self.evaluate_in(Context::DEVIATION, &fitted.deviation);
        self.here.rows = None;
        self.here.context = outer;
        let signal = self.signal(&fitted.signal);
        if !self.single_valued(&signal.traits.sets, fitted.signal.span, "what was measured") {
            return None;
        }
        let traits = Traits { reads: Reads::WHOLE, ..signal.traits.clone() };
        let value = self.expect_number(&signal, fitted.signal.span);
        let deviation = self.expect_number(&deviation, fitted.deviation.span);
        let (value, deviation, column) = (value?, deviation?, *measured.parts.as_slice().first()?);
        self.is_above_zero(deviation, fitted.deviation.span).then_some(())?;
        let table = self.table_of(at)?;
        let all = [Some(value), Some(deviation)];
        self.is_of_table(&all, table, fitted.span).then_some(())?;
        let error = self.graph.sub(value, column);
        let error = self.graph.div(error, deviation);
        let term = self.graph.square(error);
        let place = Place { name: text::expr(&fitted.signal), span: fitted.span };
        let sum = self.sum_over_rows(Sum {
            place,
            table,
            time,
            term,
            is_fit: true,
            is_shared: [false; 2],
        })?;
        let sum = Value::scalar(sum, traits);
        self.note(Role::Objective, &sum);
        self.expect_number(&sum, fitted.span)
    }

    /// What a signal is at the time of a row.
    fn signal(&mut self, signal: &'a Expr) -> Value {
        let value = self.evaluate_in(Context::AT_A_ROW, signal);
        let reads = value.traits.reads.beyond(AT_A_TIME);
        let traits = Traits { reads, ..value.traits };
        let outer = self.here.enter(Context::OBJECTIVE);
        let value = self.admit(&text::expr(signal), Value { traits, ..value }, signal.span);
        self.here.context = outer;
        value
    }

    /// The column of a signal: the one that is named, or the one that has its name.
    fn column_of(&mut self, at: usize, fitted: &'a Fitted) -> Option<usize> {
        let (name, span) = match (&fitted.column, &fitted.signal.kind) {
            (Some(column), _) => (column.name.as_str(), column.span),
            (None, ExprKind::Name(name)) => (name.as_str(), fitted.signal.span),
            (None, ExprKind::Part(_, part)) => (part.name.as_str(), fitted.signal.span),
            (None, _) => ("", fitted.signal.span),
        };
        let found = self.place_of_column(at, name);
        if found.is_none() {
            let data = &self.scope.declarations[at].name.name;
            let signal = text::expr(&fitted.signal);
            let message = match name {
                "" => format!("in which column of `{data}` is `{signal}`?"),
                name => format!("`{data}` has no column `{name}`"),
            };
            let found = Diagnostic::new(Code::UnknownPart, message, span, "no column");
            self.diagnostics.push(found.help(format!(
                "name the column behind the signal: `{signal} = COLUMN sd ...`, one of those that \
                 `columns` of `{data}` lists"
            )));
        }
        found
    }

    fn is_above_zero(&mut self, deviation: ExprId, span: Span) -> bool {
        let value = self.graph.as_number(deviation);
        let Some(value) = value.filter(|it| *it <= 0.0) else { return true };
        let message = "a standard deviation is above 0";
        let label = text::number(value);
        let found = Diagnostic::new(Code::NotAllowedHere, message, span, label);
        self.diagnostics
            .push(found.help("write how far measurements lie from what they measure, as a rule"));
        false
    }
}
