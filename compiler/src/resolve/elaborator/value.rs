//! What an expression turned out to be: entries of the graph, and what the checks must know about
//! them.

use crate::expressions::graph::ExprId;
use fdcc_grammar::Span;
use std::rc::Rc;

/// The value of an expression.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Value {
    /// Its components.
    pub parts: Parts,
    /// What it is made of.
    pub traits: Traits,
    /// The declaration that names its components.
    pub named: Option<usize>,
}

/// A number or a vector; unknown after an error, so that one mistake is told once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Parts {
    #[default]
    Unknown,
    Scalar(ExprId),
    Vector(Rc<[ExprId]>),
}

impl Parts {
    /// The components as a list; none if unknown.
    pub fn as_slice(&self) -> &[ExprId] {
        match self {
            Parts::Unknown => &[],
            Parts::Scalar(part) => std::slice::from_ref(part),
            Parts::Vector(parts) => parts,
        }
    }

    /// One component is a number, several a vector.
    pub fn from_list(parts: &[ExprId]) -> Self {
        match parts {
            [] => Parts::Unknown,
            [part] => Parts::Scalar(*part),
            _ => Parts::Vector(parts.into()),
        }
    }

    /// `a number`, `a vector of 2`.
    pub fn describe(&self) -> String {
        match self {
            Parts::Vector(parts) => format!("a vector of {}", parts.len()),
            _ => "a number".into(),
        }
    }
}

/// Which kinds of symbols a value reads, as a set of bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Reads(pub u16);

impl Reads {
    pub const TIME: Reads = Reads(1);
    pub const STATE: Reads = Reads(2);
    pub const CONTROL: Reads = Reads(4);
    pub const PARAM: Reads = Reads(8);
    pub const FREE: Reads = Reads(16);
    pub const SELECTOR: Reads = Reads(32);
    /// `x(start)`, `x(end)`, `integral(e)`.
    pub const WHOLE: Reads = Reads(64);
    /// `sliding` and `sensitivity`.
    pub const SIMULATION: Reads = Reads(128);
    /// Of a phase, outside of all phases.
    pub const PHASE: Reads = Reads(256);
    /// Of a phase, within one.
    pub const FOREIGN: Reads = Reads(512);
    pub const ALL: Reads = Reads(1023);
    /// A column of measured data, which has a value in each row.
    pub const ROW: Reads = Reads(1024);

    pub const fn or(self, other: Reads) -> Reads {
        Reads(self.0 | other.0)
    }
    /// What is in `self` but not in `allowed`.
    pub fn beyond(self, allowed: Reads) -> Reads {
        Reads(self.0 & !allowed.0)
    }
    /// What is in both.
    pub fn within(self, other: Reads) -> Reads {
        Reads(self.0 & other.0)
    }
    pub fn has(self, other: Reads) -> bool {
        self.0 & other.0 != 0
    }
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

/// How a set is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SetForm {
    Sgn,
    Dir,
    Match,
}

impl SetForm {
    /// The word of the language.
    pub fn name(self) -> &'static str {
        match self {
            SetForm::Sgn => "Sgn",
            SetForm::Dir => "Dir",
            SetForm::Match => "match",
        }
    }
}

/// A `Sgn`, `Dir` or `match` inside a value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SetUse {
    /// The name of its surface, or the text of the vector of a `Dir`.
    pub surface: Rc<str>,
    /// The call or the whole `match`, or the use of the definition that holds it.
    pub span: Span,
    /// What it is.
    pub form: SetForm,
}

/// A `piecewise` inside a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct KnotUse {
    /// The `piecewise` itself.
    pub site: Span,
    /// Where the value that holds it is used: a call of a function, the name of a `let`, or the
    /// site.
    pub used: Span,
}

/// What a value is made of, for the checks.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Traits {
    /// Kinds of symbols.
    pub reads: Reads,
    /// Set-valued factors and terms.
    pub sets: Vec<SetUse>,
    /// Piecewise definitions.
    pub knots: Vec<KnotUse>,
}

impl Traits {
    /// Everything of both.
    pub fn join(mut self, other: &Traits) -> Traits {
        self.reads = self.reads.or(other.reads);
        other.sets.iter().for_each(|it| push_new(&mut self.sets, it.clone()));
        for knot in &other.knots {
            // A definition that is used twice is told at its first use.
            if self.knots.iter().all(|known| known.site != knot.site) {
                self.knots.push(*knot);
            }
        }
        self
    }

    /// As seen from where a name or a call stands.
    pub fn used_at(mut self, span: Span) -> Traits {
        self.knots.iter_mut().for_each(|knot| knot.used = span);
        self.sets.iter_mut().for_each(|set| set.span = span);
        self
    }
}

fn push_new<T: PartialEq>(list: &mut Vec<T>, item: T) {
    if !list.contains(&item) {
        list.push(item);
    }
}

impl Value {
    /// A number with its traits.
    pub fn scalar(part: ExprId, traits: Traits) -> Value {
        Value { parts: Parts::Scalar(part), traits, named: None }
    }

    /// Nothing known, but what it is made of.
    pub fn unknown(traits: Traits) -> Value {
        Value { parts: Parts::Unknown, traits, named: None }
    }

    /// A symbol or several, read by name.
    pub fn symbols(parts: Parts, reads: Reads, named: usize) -> Value {
        Value { parts, traits: Traits { reads, ..Traits::default() }, named: Some(named) }
    }
}
