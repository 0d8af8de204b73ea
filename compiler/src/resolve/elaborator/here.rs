//! Where in the text an evaluation is: which names it knows beside the declared ones, and what it
//! may read.

use super::Rows;
use super::context::Context;
use super::value::Value;

/// Where we are.
pub(crate) struct Here<'a> {
    /// Names of the current function's arguments or of earlier guesses, from `frame` on.
    pub locals: Vec<(&'a str, Value)>,
    /// Where the visible locals begin.
    pub frame: usize,
    /// What may be read.
    pub context: Context,
    /// How deep expressions are nested around us.
    pub depth: usize,
    /// The declaration whose definition is being evaluated.
    pub owner: Option<usize>,
    /// Whether a function's body is examined with arguments that are no real values.
    pub examining: bool,
    /// The rows of the sum over data that we are in.
    pub rows: Option<Rows>,
}

impl<'a> Here<'a> {
    /// In a definition, outside of everything.
    pub fn outside() -> Self {
        Here {
            locals: Vec::new(),
            frame: 0,
            context: Context::DEFINITION,
            depth: 0,
            owner: None,
            examining: false,
            rows: None,
        }
    }

    /// The locals that are visible, the innermost last.
    pub fn visible(&self) -> &[(&'a str, Value)] {
        &self.locals[self.frame..]
    }

    /// The local of a name.
    pub fn local(&self, name: &str) -> Option<&Value> {
        self.visible().iter().rev().find(|local| local.0 == name).map(|local| &local.1)
    }

    /// Enters another context; returns the one before.
    pub fn enter(&mut self, context: Context) -> Context {
        std::mem::replace(&mut self.context, context)
    }
}
