//! Pictures of the answer: what is drawn over what, and the path conditions that are borders.
//!
//! What is drawn and has no name of its own is reported, under its text.

use crate::expressions::graph::{Expr as Node, ExprId};
use crate::model::{Border, Place, Plot, Report, Symbol};
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::Value;
use crate::resolve::elaborator::{Elaborator, Role};
use crate::syntax::{closest, text};
use fdcc_grammar::ast::{Expr, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix};

impl<'a> Elaborator<'a> {
    /// All plots; conditions and reports are known.
    pub fn plots(&mut self, items: &[&'a Item]) {
        for item in items {
            if let ItemKind::Plot { name, curves, over, borders } = &item.kind {
                self.plot(items, name, [curves, std::slice::from_ref(over)], borders);
            }
        }
    }

    fn plot(
        &mut self,
        items: &[&'a Item],
        name: &'a Ident,
        [curves, over]: [&'a [Expr]; 2],
        borders: &'a [Ident],
    ) {
        let over_value = self.drawn(name, &over[0]);
        let Some(over_part) = self.expect_number(&over_value, over[0].span) else { return };
        let over = self.column(&over[0], &over_value, 0);
        let mut parts = Vec::new();
        let mut columns = Vec::new();
        for curve in curves {
            let value = self.drawn(name, curve);
            parts.extend(value.parts.as_slice());
            let size = value.parts.as_slice().len();
            columns.extend((0..size).map(|part| self.column(curve, &value, part)));
        }
        let axes = [Some(over_part), parts.first().copied()];
        let rows = |it| self.border(items, it, axes);
        let borders = borders.iter().flat_map(rows).collect();
        let place = Place { name: name.name.clone(), span: name.span };
        self.model.plots.push(Plot { place, over, curves: columns, borders });
    }

    fn drawn(&mut self, name: &'a Ident, expr: &'a Expr) -> Value {
        self.evaluate_for(Role::Report(name), Context::PLOT, expr)
    }

    /// The name of a component among states, controls and reports.
    fn column(&mut self, expr: &'a Expr, value: &Value, part: usize) -> String {
        let id = value.parts.as_slice()[part];
        let declared = match self.input(id).map(|it| self.symbols[it as usize]) {
            Some(Symbol::State(at)) => Some(self.model.states[at].place.name.clone()),
            Some(Symbol::Control(at)) => Some(self.model.controls[at].place.name.clone()),
            Some(Symbol::Time) => Some("t".into()),
            _ => None,
        };
        let reported = || self.model.report.iter().find(|it| it.value == id);
        let known = declared.or_else(|| reported().map(|it| it.place.name.clone()));
        known.unwrap_or_else(|| {
            let name = self.component(&text::expr(expr), value, part);
            let place = Place { name: name.clone(), span: expr.span };
            self.model.report.push(Report { place, value: id });
            name
        })
    }

    fn input(&self, id: ExprId) -> Option<u32> {
        match self.graph.expr(id) {
            Node::Input(input) => Some(*input),
            _ => None,
        }
    }

    /// The rows of a path condition, which may read nothing but what is on the axes.
    fn border(
        &mut self,
        items: &[&'a Item],
        name: &'a Ident,
        axes: [Option<ExprId>; 2],
    ) -> Vec<Border> {
        let labelled = |item: &&'a Item| match &item.kind {
            ItemKind::Path { name: Some(label), condition } => Some((label, condition.span)),
            _ => None,
        };
        let paths: Vec<(&Ident, _)> = items.iter().filter_map(labelled).collect();
        let Some((label, span)) = paths.iter().find(|it| it.0.name == name.name) else {
            let known: Vec<&str> = paths.iter().map(|it| it.0.name.as_str()).collect();
            self.diagnostics.push(no_border(name, &known));
            return Vec::new();
        };
        let rows = self.model.path.iter().filter(|it| it.place.span == *span);
        let rows: Vec<_> = rows.map(|it| (it.place.clone(), it.value, it.range)).collect();
        let drawn: Option<Vec<u32>> = axes.into_iter().map(|it| self.input(it?)).collect();
        let axes: Option<[u32; 2]> = drawn.and_then(|it| it.try_into().ok());
        let values: Vec<ExprId> =
            rows.iter().flat_map(|(_, value, range)| [*value, range.lower, range.upper]).collect();
        if let Some(found) = self.beside_the_axes(name, label, &values, axes) {
            self.diagnostics.push(found);
            return Vec::new();
        }
        let axes = axes.unwrap_or_default();
        let border = |(place, value, range)| Border { place, value, range, axes };
        rows.into_iter().map(border).collect()
    }

    /// That a condition reads what is on no axis.
    fn beside_the_axes(
        &self,
        name: &Ident,
        label: &Ident,
        values: &[ExprId],
        axes: Option<[u32; 2]>,
    ) -> Option<Diagnostic> {
        let axes = axes.unwrap_or([u32::MAX; 2]);
        let is_number = |at: &u32| {
            matches!(self.symbols[*at as usize], Symbol::Param(_) | Symbol::Free(_))
                || axes.contains(at)
        };
        let read = self.graph.inputs_of(values);
        let beside = read.iter().find(|at| !is_number(at))?;
        let what = match self.symbols[*beside as usize] {
            Symbol::State(at) => format!("`{}`", self.model.states[at].place.name),
            Symbol::Control(at) => format!("`{}`", self.model.controls[at].place.name),
            Symbol::Time => "time".into(),
            _ => "the side of a surface".into(),
        };
        let message = format!("`{}` is no border of this plot: it reads {what}", name.name);
        let found = Diagnostic::new(Code::NotAllowedHere, message, name.span, "is on neither axis")
            .label(label.span, "this condition");
        Some(found.help(
            "a border is a path condition on the state or control before `over` and the one \
             behind it",
        ))
    }
}

fn no_border(name: &Ident, known: &[&str]) -> Diagnostic {
    let message = format!("no path condition is called `{}`", name.name);
    let found = Diagnostic::new(Code::UnknownName, message, name.span, "not declared");
    match closest(&name.name, known.iter().copied()) {
        Some(near) => {
            let change = format!("change `{}` to `{near}`", name.name);
            found.help(&change).fix(Fix::likely(change).replace(name.span, near))
        }
        None => found.help(format!("name one: `path {}: x <= 1`", name.name)),
    }
}
