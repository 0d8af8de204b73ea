//! Every name of a text with its role: what it is, where it is declared, where it is read and
//! written.
//!
//! Made from the tree alone, by the rules of `resolve` for what a name stands for, so that a text
//! with mistakes has an index too. Editors ask nothing else: definition, references, renaming,
//! colours, symbols and completion are queries.

mod declarations;
mod enclosing;
mod uses;

use crate::syntax::functions::is_function;
pub use enclosing::enclosing;
use fdcc_grammar::{Span, ast};

/// What a declared name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// `model racecar`
    Model,
    /// `param`
    Param,
    /// `const`
    Const,
    /// `let`
    Let,
    /// `signal`
    Signal,
    /// `fn`
    Function,
    /// An argument of a `fn`.
    Argument,
    /// `data`
    Data,
    /// A column of a `data`.
    Column,
    /// `k` of `sum(k in obs, ...)`
    Row,
    /// `free`
    Free,
    /// `time`
    Time,
    /// `state`
    State,
    /// `control`
    Control,
    /// A part of a state or a control.
    Part,
    /// `surface`
    Surface,
    /// `phase`
    Phase,
    /// `jump`
    Jump,
    /// The label of a `path`.
    Path,
    /// A line of a `report`.
    Report,
    /// `plot`
    Plot,
}

impl Kind {
    /// In the words of the language.
    pub fn word(self) -> &'static str {
        match self {
            Kind::Model => "model",
            Kind::Param => "parameter",
            Kind::Const => "constant",
            Kind::Let => "definition",
            Kind::Signal => "signal",
            Kind::Function => "function",
            Kind::Argument => "argument",
            Kind::Data => "data set",
            Kind::Column => "column",
            Kind::Row => "row of a data set",
            Kind::Free => "free unknown",
            Kind::Time => "time",
            Kind::State => "state",
            Kind::Control => "control",
            Kind::Part => "part",
            Kind::Surface => "surface",
            Kind::Phase => "phase",
            Kind::Jump => "jump",
            Kind::Path => "path constraint",
            Kind::Report => "report",
            Kind::Plot => "plot",
        }
    }
}

/// A declared name.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// The name.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// The name where it is declared.
    pub span: Span,
    /// The item or entry that declares it.
    pub item: Span,
    /// What it is part of: a phase, a vector, a function, a data set.
    pub within: Option<usize>,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// An entry of [`Names::definitions`].
    Declared(usize),
    /// A function of the language, or `pi`.
    BuiltIn,
    /// A unit.
    Unit,
    /// A key of the method.
    Setting,
    /// A word that a key of the method takes.
    Value,
    /// Nothing.
    Unknown,
}

/// What is done with a name where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Declared.
    Definition,
    /// Given a value: `x' = ...`, `x := ...`, a guess.
    Write,
    /// Read.
    Read,
}

/// A name where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// Where.
    pub span: Span,
    /// What it stands for.
    pub meaning: Meaning,
    /// What is done with it.
    pub role: Role,
}

/// The names of a text.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// All that is declared, in the order of the text.
    pub definitions: Vec<Definition>,
    /// All names, in the order of the text.
    pub occurrences: Vec<Occurrence>,
}

impl Names {
    /// Of a tree.
    pub fn new(tree: &ast::Model) -> Names {
        let mut names = Names::default();
        declarations::collect(tree, &mut names);
        uses::collect(tree, &mut names);
        names.occurrences.sort_by_key(|it| (it.span, it.role != Role::Definition));
        names.occurrences.dedup_by_key(|it| it.span);
        names
    }

    /// The name at a byte, or the one that ends there.
    pub fn at(&self, offset: u32) -> Option<&Occurrence> {
        let after = self.occurrences.partition_point(|it| it.span.start <= offset);
        self.occurrences[..after].last().filter(|it| offset <= it.span.end)
    }

    /// The definition of the name at a byte.
    pub fn definition_at(&self, offset: u32) -> Option<usize> {
        match self.at(offset)?.meaning {
            Meaning::Declared(at) => Some(at),
            _ => None,
        }
    }

    /// Every place where a definition is named, its own among them. A phase for each file and the
    /// rows of its file have one name.
    pub fn of(&self, definition: usize) -> impl Iterator<Item = &Occurrence> {
        let place = self.definitions[definition].span;
        self.occurrences.iter().filter(move |it| match it.meaning {
            Meaning::Declared(at) => self.definitions[at].span == place,
            _ => false,
        })
    }

    /// Whether a definition is that of the rows of a phase for each file, within that phase.
    pub fn is_rows(&self, definition: usize) -> bool {
        let it = &self.definitions[definition];
        it.within.is_some_and(|outer| self.definitions[outer].span == it.span)
    }

    /// What belongs to a definition.
    pub fn parts_of(&self, definition: usize) -> impl Iterator<Item = usize> {
        (0..self.definitions.len())
            .filter(move |&at| self.definitions[at].within == Some(definition))
    }

    /// A definition as results call it: `pos.x`, `coast.h`.
    pub fn full_name(&self, definition: usize) -> String {
        let it = &self.definitions[definition];
        match it.within {
            Some(outer) if it.kind == Kind::Part => {
                format!("{}.{}", self.full_name(outer), it.name)
            }
            _ => it.name.clone(),
        }
    }

    /// The phase that a definition belongs to.
    pub fn phase_of(&self, definition: usize) -> Option<&str> {
        let outer = &self.definitions[self.definitions[definition].within?];
        if outer.kind == Kind::Phase {
            Some(&outer.name)
        } else {
            self.phase_of(self.definitions[definition].within?)
        }
    }

    /// A name that no declaration explains.
    fn built_in(name: &str) -> Meaning {
        if matches!(name, "pi" | "inf") || is_function(name) {
            Meaning::BuiltIn
        } else {
            Meaning::Unknown
        }
    }
}
