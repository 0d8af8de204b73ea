//! Where names are used, and what each stands for there.

use super::declarations::declare;
use super::{Kind, Meaning, Names, Occurrence, Role};
use crate::settings::is_key;
use crate::syntax::{scope, walk};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{
    self, Argument, Assignment, Expr, ExprKind, Fitted, Ident, Item, ItemKind, Setting,
    SettingValue, Unit,
};
use std::collections::HashMap;

/// Adds all uses.
pub(super) fn collect(tree: &ast::Model, names: &mut Names) {
    let known = known(names);
    let likes = likes(&tree.items, names);
    let mut walker = Walker { names, known, likes, phase: None };
    walker.items(&tree.items);
}

/// The first definition of each name, by what it belongs to.
type Known = HashMap<Option<usize>, HashMap<String, usize>>;

fn known(names: &Names) -> Known {
    let mut known = Known::new();
    let in_expressions = |kind: Kind| {
        !matches!(kind, Kind::Model | Kind::Jump | Kind::Path | Kind::Report | Kind::Plot)
    };
    for (at, it) in names.definitions.iter().enumerate().filter(|it| in_expressions(it.1.kind)) {
        known.entry(it.within).or_default().entry(it.name.clone()).or_insert(at);
    }
    known
}

fn likes(items: &[Item], names: &Names) -> HashMap<usize, usize> {
    let is_phase = |name: &str| {
        names.definitions.iter().position(|it| it.kind == Kind::Phase && it.name == name)
    };
    let like = |item: &Item| match &item.kind {
        ItemKind::Phase { name, like: Some(like), .. } => {
            Some((names.definition_named(name)?, is_phase(&like.name)?))
        }
        _ => None,
    };
    items.iter().filter_map(like).collect()
}

/// A name that only an expression knows, and the one around it.
type Local<'a> = (&'a str, usize, Option<usize>);

struct Walker<'n> {
    names: &'n mut Names,
    known: Known,
    /// The phase whose names each phase takes over.
    likes: HashMap<usize, usize>,
    phase: Option<usize>,
}

impl Walker<'_> {
    fn items(&mut self, items: &[Item]) {
        for item in items {
            self.item(item);
        }
    }

    fn item(&mut self, item: &Item) {
        if let Some(unit) = scope::unit(item) {
            self.unit(unit);
        }
        match &item.kind {
            ItemKind::Phase { name, like, each, items } => {
                like.iter().for_each(|it| self.name(it, Role::Read));
                let columns = each.iter().flat_map(|it| &it.columns);
                columns.filter_map(|it| it.1.as_ref()).for_each(|it| self.unit(it));
                let outer = self.phase;
                self.phase = self.names.definition_named(name);
                self.items(items);
                self.phase = outer;
            }
            ItemKind::Link { from, to, assignments, .. } => self.link(from, to, assignments),
            ItemKind::Fn { name, body, .. } => {
                let function = self.names.definition_named(name);
                self.expression(body, function);
            }
            ItemKind::Method { settings } => settings.iter().for_each(|it| self.setting(it)),
            _ => {
                self.heads(item);
                walk::expressions(item).into_iter().for_each(|it| self.expression(it, None));
            }
        }
    }

    /// Names of an item that stand outside its expressions.
    fn heads(&mut self, item: &Item) {
        match &item.kind {
            ItemKind::Data { columns, .. } => {
                columns.iter().filter_map(|it| it.1.as_ref()).for_each(|it| self.unit(it))
            }
            ItemKind::Dynamics { equations } => {
                equations.iter().for_each(|it| self.name(&it.state, Role::Write))
            }
            ItemKind::Fit { data, signals, .. } => self.fitted(data, signals),
            ItemKind::Plot { borders, .. } => borders.iter().for_each(|it| self.border(it)),
            ItemKind::Metric { weights } => {
                weights.iter().for_each(|it| self.name(&it.0, Role::Read))
            }
            ItemKind::Guess { bindings } => {
                bindings.iter().for_each(|it| self.name(&it.name, Role::Write))
            }
            ItemKind::Jump { surface, then_hold, assignments, .. } => {
                std::iter::once(surface).chain(then_hold).for_each(|it| self.name(it, Role::Read));
                assignments.iter().for_each(|it| self.assigned(it));
            }
            ItemKind::Sweep { lists } => lists.iter().for_each(|it| match is_key(&it.name.name) {
                true => self.add(it.name.span, Meaning::Setting, Role::Write),
                false => self.name(&it.name, Role::Write),
            }),
            _ => {}
        }
    }

    /// A border is a path condition of the phase, or of all.
    fn border(&mut self, name: &Ident) {
        let all = self.names.definitions.iter().enumerate().rev();
        let is_meant = |it: &super::Definition| {
            let is_seen = it.within.is_none() || it.within == self.phase;
            it.kind == Kind::Path && it.name == name.name && is_seen
        };
        if let Some(at) = all.filter(|it| is_meant(it.1)).map(|it| it.0).next() {
            self.add(name.span, Meaning::Declared(at), Role::Read);
        }
    }

    /// A column that is not named has the name of its signal: it stands behind that, without a
    /// letter.
    fn fitted(&mut self, data: &Ident, signals: &[Fitted]) {
        self.name(data, Role::Read);
        let data = self.find(&data.name, self.phase);
        for it in signals {
            let end = it.signal.span.end;
            let (name, span) = match (&it.column, &it.signal.kind) {
                (Some(column), _) => (&column.name, column.span),
                (None, ExprKind::Name(name)) => (name, Span { start: end, end }),
                (None, ExprKind::Part(_, part)) => (&part.name, Span { start: end, end }),
                _ => continue,
            };
            let found = data.and_then(|data| self.part_of(Some(data), name));
            self.add(span, found.map_or(Meaning::Unknown, Meaning::Declared), Role::Read);
        }
    }

    /// The left sides are states of the phase that begins, the right sides belong to the one that
    /// ends.
    fn link(&mut self, from: &Ident, to: &Ident, assignments: &[Assignment]) {
        self.name(from, Role::Read);
        self.name(to, Role::Read);
        let outer = self.phase;
        for it in assignments {
            self.phase = self.find(&to.name, outer);
            self.assigned(it);
            self.phase = self.find(&from.name, outer);
            self.expression(&it.value, None);
        }
        self.phase = outer;
    }

    fn setting(&mut self, setting: &Setting) {
        self.add(setting.key.span, Meaning::Setting, Role::Write);
        setting.unit.iter().for_each(|it| self.unit(it));
        match &setting.value {
            SettingValue::Expr(Expr { kind: ExprKind::Name(name), span }) => {
                let found = self.find(name, self.phase);
                self.add(*span, found.map_or(Meaning::Value, Meaning::Declared), Role::Read);
            }
            SettingValue::Expr(value) => self.expression(value, None),
            SettingValue::List(values) => values.iter().for_each(|it| self.expression(it, None)),
            SettingValue::Scheme { name, lagged } => {
                self.add(name.span, Meaning::Value, Role::Read);
                lagged.iter().for_each(|it| self.name(it, Role::Read));
            }
        }
    }

    fn unit(&mut self, unit: &Unit) {
        unit.factors.iter().for_each(|(name, _)| self.add(name.span, Meaning::Unit, Role::Read));
    }

    fn add(&mut self, span: Span, meaning: Meaning, role: Role) {
        self.names.occurrences.push(Occurrence { span, meaning, role });
    }

    fn name(&mut self, name: &Ident, role: Role) {
        let found = self.find(&name.name, self.phase);
        self.add(name.span, found.map_or(Meaning::Unknown, Meaning::Declared), role);
    }

    /// What a name stands for in a phase, or outside of all: what is outside comes first, as in
    /// `resolve`.
    fn find(&self, name: &str, phase: Option<usize>) -> Option<usize> {
        let own = || self.part_of(Some(phase?), name);
        let rows = own().filter(|at| self.names.is_rows(*at));
        rows.or_else(|| self.part_of(None, name)).or_else(own)
    }

    /// What belongs to a phase, a vector, a function or a data set, or to none; a phase has what
    /// it takes over from another.
    fn part_of(&self, mut owner: Option<usize>, name: &str) -> Option<usize> {
        for _ in 0..=self.likes.len() {
            let found = self.known.get(&owner).and_then(|own| own.get(name)).copied();
            match (found, owner.and_then(|at| self.likes.get(&at))) {
                (None, Some(other)) => owner = Some(*other),
                _ => return found,
            }
        }
        None
    }

    /// The left side of an assignment.
    fn assigned(&mut self, assignment: &Assignment) {
        self.name(&assignment.name, Role::Write);
        if let Some(part) = &assignment.part {
            let whole = self.find(&assignment.name.name, self.phase);
            let found = whole.and_then(|at| self.part_of(Some(at), &part.name));
            self.add(part.span, found.map_or(Meaning::Unknown, Meaning::Declared), Role::Write);
        }
    }

    /// All names in an expression, perhaps the body of a function. In a loop: sums are trees as
    /// deep as they are long.
    fn expression<'a>(&mut self, value: &'a Expr, function: Option<usize>) {
        let mut locals: Vec<Local<'a>> = Vec::new();
        let mut stack: Vec<(&'a Expr, Option<usize>)> = vec![(value, None)];
        while let Some((next, local)) = stack.pop() {
            let mut inner = local;
            match &next.kind {
                ExprKind::Quantity(_, unit) => self.unit(unit),
                ExprKind::Name(name) => {
                    let meaning = self.meaning(name, local, &locals, function);
                    self.add(next.span, meaning, Role::Read);
                }
                ExprKind::Part(..) => {
                    if let Some(base) = self.parts(next, local, &locals, function) {
                        stack.push((base, local));
                    }
                    continue;
                }
                ExprKind::Match { surface, .. } => self.name(surface, Role::Read),
                ExprKind::Call(_, arguments) => {
                    for argument in arguments {
                        if let Argument::Iteration(row, data) = argument {
                            inner = Some(self.row(row, data, inner, next.span, &mut locals));
                        }
                    }
                }
                _ => {}
            }
            let mut children = Vec::new();
            walk::push_children(next, &mut children);
            stack.extend(children.into_iter().map(|child| (child, inner)));
        }
    }

    /// `k in obs`: declares `k` for what is inside of the call.
    fn row<'a>(
        &mut self,
        row: &'a Ident,
        data: &'a Ident,
        outer: Option<usize>,
        call: Span,
        locals: &mut Vec<Local<'a>>,
    ) -> usize {
        let source = self.find(&data.name, self.phase);
        self.name(data, Role::Read);
        let at = declare(self.names, row, Kind::Row, call, source);
        locals.push((&row.name, at, outer));
        locals.len() - 1
    }

    fn meaning(
        &self,
        name: &str,
        local: Option<usize>,
        locals: &[Local<'_>],
        function: Option<usize>,
    ) -> Meaning {
        let mut next = local;
        while let Some(at) = next {
            if locals[at].0 == name {
                return Meaning::Declared(locals[at].1);
            }
            next = locals[at].2;
        }
        let argument = function.and_then(|it| self.part_of(Some(it), name));
        let found = argument.or_else(|| self.find(name, self.phase));
        found.map_or_else(|| Names::built_in(name), Meaning::Declared)
    }

    /// `pos.x`, `obs.t`, `k.t`, `coast.pos.x`; gives back what the parts are taken of if that is no
    /// name.
    fn parts<'a>(
        &mut self,
        whole: &'a Expr,
        local: Option<usize>,
        locals: &[Local<'a>],
        function: Option<usize>,
    ) -> Option<&'a Expr> {
        let (mut base, mut parts) = (whole, Vec::new());
        while let ExprKind::Part(inner, part) = &base.kind {
            parts.push(part);
            base = inner;
        }
        // `run[2].x`: a phase of several that were written as one.
        if let ExprKind::Index(inner, _) = &base.kind
            && let ExprKind::Name(name) = &inner.kind
            && let Meaning::Declared(at) = self.meaning(name, local, locals, function)
            && self.names.definitions[at].kind == Kind::Phase
        {
            base = inner;
        }
        let ExprKind::Name(name) = &base.kind else {
            parts.iter().for_each(|it| self.add(it.span, Meaning::Unknown, Role::Read));
            return Some(base);
        };
        let mut meaning = self.meaning(name, local, locals, function);
        self.add(base.span, meaning, Role::Read);
        for part in parts.into_iter().rev() {
            let owner = match meaning {
                Meaning::Declared(at) if self.names.definitions[at].kind == Kind::Row => {
                    self.names.definitions[at].within
                }
                Meaning::Declared(at) => Some(at),
                _ => None,
            };
            meaning = owner
                .and_then(|it| self.part_of(Some(it), &part.name))
                .map_or(Meaning::Unknown, Meaning::Declared);
            self.add(part.span, meaning, Role::Read);
        }
        None
    }
}

impl Names {
    /// The definition that an item makes.
    fn definition_named(&self, name: &Ident) -> Option<usize> {
        self.definitions.iter().position(|it| it.span == name.span)
    }
}
