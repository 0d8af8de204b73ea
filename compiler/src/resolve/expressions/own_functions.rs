//! The model's own functions.

use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::Value;
use crate::syntax::DEEPEST;
use fdcc_grammar::ast::{Argument, Expr, Ident};
use fdcc_grammar::{Code, Diagnostic, Span};

/// No sensible model applies its functions so often to different arguments.
const MOST_APPLICATIONS: usize = 50_000;

impl<'a> Elaborator<'a> {
    pub(super) fn own_function(
        &mut self,
        at: usize,
        formal: &'a [Ident],
        body: &'a Expr,
        arguments: &'a [Argument],
        span: Span,
    ) -> Value {
        let name = self.scope.declarations[at].name;
        let fits = self.count_is(&name.name, formal.len(), arguments.len(), span, Some(name.span));
        let values = self.plain_arguments(arguments);
        let (true, Some(values), false) = (fits, values, self.circular[at]) else {
            return Value::default();
        };
        if self.applied.len() > MOST_APPLICATIONS {
            return self.too_much(span);
        }
        let mut value = self.apply(at, formal, body, values);
        value.traits = value.traits.used_at(span);
        self.admit(&name.name, value, span)
    }

    /// Functions that call each other twice, and so on, would take for ever.
    fn too_much(&mut self, span: Span) -> Value {
        if !self.diagnostics.iter().any(|it| it.code == Code::TooDeep) {
            let message = format!(
                "the functions of this model are applied more than {MOST_APPLICATIONS} times"
            );
            let found = Diagnostic::new(Code::TooDeep, message, span, "too much by here");
            let help = "functions that call each other several times multiply; write a loop-like \
                        chain as a formula";
            self.diagnostics.push(found.help(help));
        }
        Value::default()
    }

    /// A function of the model for given arguments; remembered, because definitions build on each
    /// other.
    pub fn apply(
        &mut self,
        at: usize,
        formal: &'a [Ident],
        body: &'a Expr,
        values: Vec<Value>,
    ) -> Value {
        let key = (at, self.here.examining, values);
        if let Some(known) = self.applied.get(&key) {
            return known.clone();
        }
        if self.here.depth > DEEPEST {
            return Value::default();
        }
        let value = self.with_arguments(at, formal, key.2.clone(), |this| {
            this.evaluate_in(Context::DEFINITION, body)
        });
        self.applied.insert(key, value.clone());
        value
    }

    fn with_arguments(
        &mut self,
        at: usize,
        formal: &'a [Ident],
        values: Vec<Value>,
        run: impl FnOnce(&mut Self) -> Value,
    ) -> Value {
        let outer = (self.here.frame, self.here.owner.replace(at));
        self.here.frame = self.here.locals.len();
        self.here.locals.extend(formal.iter().map(|name| name.name.as_str()).zip(values));
        let value = run(self);
        self.here.locals.truncate(self.here.frame);
        (self.here.frame, self.here.owner) = outer;
        value
    }
}
