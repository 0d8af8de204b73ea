//! Columns of measured data; FDC0704 where one without a unit meets a name in another unit than
//! that of SI: `columns t, x` beside `state x [mm]` would be read in metres.

use super::declared::{Declared, Form};
use super::requirement::{Reason, Requirement, Side};
use super::solve::Solution;
use super::value::{Part, Value};
use super::{Inference, named};
use crate::syntax::scope::Scope;
use crate::units::dimension::notation::written;
use crate::units::dimension::ratio::Ratio;
use crate::units::dimension::{Atom, Dimension};
use fdcc_grammar::ast::{ExprKind, Fitted, Ident, Item, ItemKind, Unit};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};

/// A column that is declared without a unit.
#[derive(Clone, Copy)]
pub(crate) struct Column<'a> {
    name: &'a Ident,
    /// All columns of its data set.
    all: &'a [(Ident, Option<Unit>)],
    /// What it measures.
    unknown: u32,
}

impl<'a> Inference<'a> {
    pub fn declare_columns(&mut self, all: &'a [(Ident, Option<Unit>)]) {
        for (name, unit) in all {
            if unit.is_none() {
                self.columns.push(Column { name, all, unknown: self.unknowns as u32 });
            }
            let value = self.variable(&[], unit.as_ref());
            self.values.insert(name.span, value);
        }
    }

    /// A row of a data set: its columns are its parts.
    pub fn row_of(&self, data: &Item) -> Value {
        let ItemKind::Data { columns, .. } = &data.kind else { return Value::new() };
        let part = |(name, _): &(Ident, Option<Unit>)| {
            let value = self.values.get(&name.span)?.first()?.clone();
            Some(Part { called: Some(name.name.as_str().into()), ..value })
        };
        columns.iter().filter_map(part).collect()
    }

    /// The columns of a data set by name.
    fn columns_of(&self, data: &Ident) -> &'a [(Ident, Option<Unit>)] {
        match self.declared(data).map(|it| &it.item.kind) {
            Some(ItemKind::Data { columns, .. }) => columns,
            _ => &[],
        }
    }

    /// The column that is called as the time is, or else `time`, measures time, in all phases.
    pub fn times_of_rows(&mut self, data: &Ident) {
        let columns = self.columns_of(data);
        let scopes = std::iter::once(&self.scope).chain(self.phases.values());
        let mut times: Vec<&'a Ident> = scopes.flat_map(times).collect();
        times.sort_by_key(|time| time.span);
        times.dedup_by_key(|time| time.span);
        let column = |name: &str| columns.iter().find(|it| it.0.name == name);
        let has_own = times.iter().any(|time| column(&time.name).is_some());
        for time in times {
            let name = if has_own { time.name.as_str() } else { "time" };
            let Some((column, _)) = column(name) else { continue };
            let operand = |it: &Ident| {
                (self.values.get(&it.span).cloned().unwrap_or_default(), named(it.span))
            };
            let (measured, time) = (operand(column), operand(time));
            self.compare(Reason::Given("the time of the model", column), &measured, &time);
        }
    }

    /// A signal, its column and the standard deviation measure the same.
    pub fn fitted(&mut self, data: &'a Ident, fitted: &'a Fitted) {
        let signal = self.operand(&fitted.signal);
        let name = match (&fitted.column, &fitted.signal.kind) {
            (Some(column), _) => column.name.as_str(),
            (None, ExprKind::Name(name)) => name,
            (None, ExprKind::Part(_, part)) => &part.name,
            _ => return,
        };
        let column = self.columns_of(data).iter().find(|it| it.0.name == name);
        let Some((column, _)) = column else { return };
        let measured = self.values.get(&column.span).cloned().unwrap_or_default();
        let measured = (measured, named(column.span));
        self.compare(Reason::Given("the signal", column), &measured, &signal);
        self.value_for("the standard deviation", column, &measured, &fitted.deviation);
    }
}

/// The time of a scope.
fn times<'a>(scope: &Scope<'a>) -> Vec<&'a Ident> {
    let is_time = |item: &Item| matches!(item.kind, ItemKind::Time { .. });
    scope.declarations.iter().filter(|it| is_time(it.item)).map(|it| it.name).collect()
}

/// What a column meets.
struct Met<'i, 'a> {
    column: Column<'a>,
    requirement: &'i Requirement<'a>,
    /// Its unit, if that can be said.
    unit: Option<String>,
}

/// Every column without a unit that would be read in that of SI beside names in other units.
pub(crate) fn found<'a>(inference: &Inference<'a>, solution: &Solution) -> Vec<Diagnostic> {
    let met = |column: &Column<'a>| {
        let needs = |it| Some((it, needed(it, *column, solution)?));
        let (requirement, unit) = inference.requirements.iter().find_map(needs)?;
        Some(Met { column: *column, requirement, unit })
    };
    let all: Vec<Met<'_, '_>> = inference.columns.iter().filter_map(met).collect();
    all.iter().map(|it| it.diagnostic(&all)).collect()
}

/// The unit that a column needs so that two sides fit each other, where that is not the one of SI;
/// none within it if it has no name.
fn needed(it: &Requirement<'_>, column: Column<'_>, solution: &Solution) -> Option<Option<String>> {
    let atom = Atom::Unknown(column.unknown);
    let (_, difference) = it.equation();
    let power = difference.factors().iter().find(|factor| factor.0 == atom)?.1;
    let [left, right] = [&it.left, &it.right].map(|side| of_names(&side.declared));
    let own = right.over(&left).power(Ratio::ONE.over(power)?);
    if matches!(it.reason, Reason::Uses(_)) || own.is_si() {
        return None;
    }
    let dimension = solution.settled(&Dimension::atom(atom))?;
    // A pure number is one, whatever it is multiplied with.
    let is_number = dimension.is_none() && !own.is_share();
    let is_alone = [&it.left, &it.right].iter().any(|it| it.dimension == Dimension::atom(atom));
    let unit = own.text(&dimension);
    // In a product that has its unit from a quantity, it counts in SI.
    (!is_number && (unit.is_some() || is_alone)).then_some(unit)
}

/// The unit of the names in a side; what has its unit beside it is clear.
fn of_names(declared: &Declared) -> Declared {
    if declared.form == Form::Quantity { Declared::SI } else { declared.clone() }
}

impl Met<'_, '_> {
    fn diagnostic(&self, all: &[Met<'_, '_>]) -> Diagnostic {
        let name = self.column.name;
        let message = format!(
            "the column `{}` has no unit, and what it stands beside is not in that of SI",
            name.name
        );
        let label = match &self.unit {
            Some(unit) => format!("in {unit}"),
            None => "made of names in other units than those of SI".into(),
        };
        let found = Diagnostic::new(Code::BareNumber, message, name.span, "in which unit?");
        let found = found.label(self.beside(), label);
        let Some(unit) = &self.unit else {
            return found
                .help("write the unit of its numbers behind it: `columns t [min], x [mm]`");
        };
        let fix = Fix::likely(format!("write `{} [{unit}]`", name.name));
        found
            .help(format!("say in which unit its numbers are: `{}`", self.columns(all)))
            .fix(fix.insert(name.span.end, format!(" [{unit}]")))
    }

    /// The side that is not the column.
    fn beside(&self) -> Span {
        let atom = Atom::Unknown(self.column.unknown);
        let has_it = |side: &Side<'_>| side.dimension.factors().iter().any(|it| it.0 == atom);
        let it = self.requirement;
        match (has_it(&it.left), has_it(&it.right)) {
            (true, false) => it.right.span,
            (false, true) => it.left.span,
            _ => it.site,
        }
    }

    /// All columns of the data set, each with its unit.
    fn columns(&self, all: &[Met<'_, '_>]) -> String {
        let unit = |name: &Ident| {
            let own = all.iter().find(|it| it.column.name.span == name.span)?;
            own.unit.clone()
        };
        let column = |(name, own): &(Ident, Option<Unit>)| match own
            .as_ref()
            .map(written)
            .or_else(|| unit(name))
        {
            Some(unit) => format!("{} [{unit}]", name.name),
            None => name.name.clone(),
        };
        let columns: Vec<String> = self.column.all.iter().map(column).collect();
        format!("columns {}", columns.join(", "))
    }
}
