//! Incremental parsing: the tree of a region is shifted to where the region stands in the text.

use crate::ast::*;
use crate::{Code, Diagnostic, Edit, Fix, Label, Parse, Severity, Span};

impl Parse {
    /// Adds what was read of a region that begins at byte `start`.
    pub(crate) fn append(&mut self, region: &Parse, start: usize) {
        let Parse { tree, diagnostics, .. } = region;
        let (from, found) = (self.tree.items.len(), self.diagnostics.len());
        self.tree.items.extend_from_slice(&tree.items);
        self.diagnostics.extend_from_slice(diagnostics);
        self.tree.items[from..].iter_mut().for_each(|item| item.move_by(start as u32));
        self.diagnostics[found..].iter_mut().for_each(|one| one.move_by(start as u32));
        if let Some(name) = &tree.name {
            self.tree.name = Some(name.clone());
            self.tree.name.move_by(start as u32);
        }
    }
}

impl Parse {
    /// Adds an entry that begins at byte `start` of this block to it; nothing if the entry cannot
    /// be used.
    pub(crate) fn adopt(&mut self, entry: &Parse, start: usize) -> Option<()> {
        let mut moved = Parse::default();
        moved.append(entry, start);
        let (Some(block), true) = (self.tree.items.first_mut(), moved.diagnostics.is_empty())
        else {
            return None;
        };
        match (&mut block.kind, moved.tree.items.pop()?) {
            (
                ItemKind::Dynamics { equations },
                Item { kind: ItemKind::Dynamics { equations: new }, .. },
            ) => equations.extend(new),
            (ItemKind::Phase { items, .. }, item) => items.push(item),
            _ => return None,
        }
        Some(())
    }
}

/// What has places in the text.
trait Placed {
    /// Moves all of them.
    fn move_by(&mut self, bytes: u32);
}

impl Placed for Span {
    fn move_by(&mut self, bytes: u32) {
        self.start += bytes;
        self.end += bytes;
    }
}

impl<T: Placed> Placed for Option<T> {
    fn move_by(&mut self, bytes: u32) {
        self.iter_mut().for_each(|it| it.move_by(bytes));
    }
}

impl<T: Placed> Placed for Vec<T> {
    fn move_by(&mut self, bytes: u32) {
        self.iter_mut().for_each(|it| it.move_by(bytes));
    }
}

impl<T: Placed> Placed for Box<T> {
    fn move_by(&mut self, bytes: u32) {
        (**self).move_by(bytes);
    }
}

impl<A: Placed, B: Placed> Placed for (A, B) {
    fn move_by(&mut self, bytes: u32) {
        self.0.move_by(bytes);
        self.1.move_by(bytes);
    }
}

/// What has no place of its own.
macro_rules! nowhere {
    ($($type:ty),*) => { $(impl Placed for $type { fn move_by(&mut self, _: u32) {} })* };
}

nowhere!(
    String,
    bool,
    f64,
    i32,
    usize,
    BinaryOperator,
    Code,
    Direction,
    EquationRelation,
    Relation,
    Sense,
    Severity
);

/// All fields of a type; a field that is missing here is found by the compiler.
macro_rules! fields {
    ($($type:ident { $($field:ident),* })*) => { $(
        impl Placed for $type {
            fn move_by(&mut self, bytes: u32) {
                let $type { $($field),* } = self;
                $($field.move_by(bytes);)*
            }
        }
    )* };
}

fields! {
    Arm { left, relation, relation_span, right, guard_span, value }
    Assignment { name, part, value }
    Binding { name, value }
    Check { left, relation, right, within, span }
    Condition { first, rest, span }
    Diagnostic { code, severity, message, labels, help, fixes }
    Each { file, file_span, columns }
    Edit { span, replacement }
    Equation { factor, state, relation, relation_span, right, span }
    Expr { kind, span }
    Fitted { signal, column, deviation, span }
    Fix { title, edits, certain }
    Ident { name, span }
    Interval { lower, upper, span }
    Item { kind, span }
    Label { span, text }
    Setting { key, value, unit }
    Swept { name, values }
    Unit { factors, span }
}

/// All that the variants of a type hold.
macro_rules! variants {
    ($($type:ident {
        $($variant:ident $({ $($field:ident),* })? $(( $($part:ident),* ))?,)*
    })*) => { $(
        impl Placed for $type {
            fn move_by(&mut self, bytes: u32) {
                match self {
                    $($type::$variant $({ $($field),* })? $(( $($part),* ))? => {
                        $($($field.move_by(bytes);)*)?
                        $($($part.move_by(bytes);)*)?
                    })*
                }
            }
        }
    )* };
}

variants! {
    Argument {
        Expr(value),
        End(place),
        Start(place),
        Iteration(name, data),
    }
    ExprKind {
        Number(value),
        Quantity(value, unit),
        Name(name),
        Negate(inner),
        Binary(operator, left, right),
        Call(callee, arguments),
        Part(base, part),
        Index(base, index),
        Prime(base),
        Tuple(parts),
        Piecewise { arms, otherwise },
        Match { surface, sides, below, above },
    }
    ItemKind {
        Param { name, value, unit, bounds },
        Const { name, value, unit },
        Let { name, unit, value },
        Signal { name, unit, value },
        Fn { name, arguments, body },
        Data { name, file, file_span, columns },
        Free { name, bounds, unit, guess },
        Time { name, interval, unit },
        State { name, parts, unit, bounds, start },
        Control { name, parts, bounds, unit, guess },
        Surface { name, value },
        Dynamics { equations },
        Metric { weights },
        Jump { name, surface, direction, direction_span, at_most, then_hold, assignments },
        Start { condition },
        End { condition },
        At { time, condition },
        Path { name, condition },
        Objective { sense, keyword, value },
        Fit { keyword, data, signals },
        Guess { bindings },
        Phase { name, like, each, items },
        Link { from, to, same, assignments },
        Method { settings },
        Sweep { lists },
        Report { bindings },
        Plot { name, curves, over, borders },
        Expect { checks },
    }
    SettingValue {
        Expr(value),
        List(values),
        Scheme { name, lagged },
    }
    Start {
        Value(value),
        Free { span, bounds },
    }
}
