//! Calls: the builtin functions of numbers here; those of vectors, the model's own functions and
//! the special forms in the files beside this one.

use crate::expressions::graph::ExprId;
use crate::expressions::graph::builtins::{self, Builtin};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::value::Value;
use crate::syntax::functions::{self, function_names, is_function};
use crate::syntax::scope;
use fdcc_grammar::ast::{Argument, Expr, ExprKind, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};

/// What functions are called in other languages.
const ELSEWHERE: &[(&str, &str)] = &[
    ("sign", "Sgn"),
    ("signum", "Sgn"),
    ("ln", "log"),
    ("fabs", "abs"),
    ("arctan", "atan"),
    ("arctan2", "atan2"),
];

impl<'a> Elaborator<'a> {
    /// `callee(arguments)`.
    pub fn call(&mut self, expr: &'a Expr, callee: &'a Expr, arguments: &'a [Argument]) -> Value {
        if let [Argument::End(_) | Argument::Start(_)] = arguments {
            if let Some(value) = self.column_at_an_end(callee, &arguments[0]) {
                return value;
            }
            return self.at_an_end(callee, &arguments[0], expr.span);
        }
        let ExprKind::Name(name) = &callee.kind else {
            if let (ExprKind::Part(..) | ExprKind::Index(..), true, [at]) =
                (&callee.kind, self.here.rows.is_some(), arguments)
            {
                return self.at_a_row(callee, at, expr.span);
            }
            return self.call_of_value(expr, callee, arguments);
        };
        let declared = self.scope.find(name).map(|at| (at, self.scope.declarations[at].item));
        match declared {
            Some((at, item)) => match &item.kind {
                ItemKind::Fn { arguments: formal, body, .. } => {
                    self.own_function(at, formal, body, arguments, expr.span)
                }
                _ if self.here.rows.is_some() && arguments.len() == 1 => {
                    self.at_a_row(callee, &arguments[0], expr.span)
                }
                _ if !is_function(name) => {
                    self.not_a_function(name, scope::kind_word(item), callee.span, arguments)
                }
                _ => self.builtin_call(name, expr, arguments),
            },
            None if is_function(name) => self.builtin_call(name, expr, arguments),
            None => self.unknown_function(name, callee.span, arguments),
        }
    }

    fn unknown_function(&mut self, name: &'a str, span: Span, arguments: &'a [Argument]) -> Value {
        let declaration = format!("fn {name}(x) = x");
        let found = match ELSEWHERE.iter().find(|(foreign, _)| *foreign == name) {
            Some((_, own)) => called_elsewhere(name, own, span),
            None => self.scope.unknown(name, span, &function_names(), &declaration),
        };
        self.diagnostics.push(found);
        self.plain_arguments(arguments);
        Value::default()
    }

    /// `blend(f, width)(x)`; nothing else gives a function.
    fn call_of_value(
        &mut self,
        expr: &'a Expr,
        callee: &'a Expr,
        arguments: &'a [Argument],
    ) -> Value {
        if let ExprKind::Call(inner, given) = &callee.kind
            && matches!(&inner.kind, ExprKind::Name(name) if name == "blend")
        {
            let [Argument::Expr(function), Argument::Expr(width)] = &given[..] else {
                if self.count_is("blend", 2, given.len(), callee.span, None) {
                    self.plain_arguments(given);
                }
                return Value::default();
            };
            let value = self.call(expr, function, arguments);
            return self.rounded(value, function.span, width, callee.span);
        }
        self.plain_arguments(arguments);
        let found = Diagnostic::new(
            Code::WrongKind,
            "only a function can be called",
            expr.span,
            "called here",
        );
        self.fail(found.help("for a product write `*`; fdc has no implicit multiplication"))
    }

    fn not_a_function(
        &mut self,
        name: &str,
        kind: &str,
        span: Span,
        arguments: &'a [Argument],
    ) -> Value {
        // The names inside are used, but what is said of them may follow from there being no
        // function.
        let told = self.diagnostics.len();
        self.plain_arguments(arguments);
        self.diagnostics.truncate(told);
        let message = format!("`{name}` is a {kind}, not a function");
        let found = Diagnostic::new(Code::WrongKind, message, span, format!("a {kind}"));
        let help = match kind {
            "state" => format!(
                "its values at the ends are `{name}(start)` and `{name}(end)`; for a product write \
                 `{name} * ...`"
            ),
            _ => format!("for a product write `{name} * ...`"),
        };
        self.fail(found.help(help))
    }

    fn builtin_call(&mut self, name: &'a str, expr: &'a Expr, arguments: &'a [Argument]) -> Value {
        let wanted = functions::arity(name).expect("asked only for functions of the language");
        let is_form = functions::find(name).is_some_and(|it| it.kind == functions::Kind::Form);
        let has_shape = name == "interpolate" && arguments.len() == wanted + 1;
        if !has_shape && !self.count_is(name, wanted, arguments.len(), expr.span, None) {
            // What a form reads, it reads in its own way: nothing is to be said of it here.
            if !is_form {
                self.plain_arguments(arguments);
            }
            return Value::default();
        }
        if is_form {
            return self.form(name, expr, arguments);
        }
        let Some(values) = self.plain_arguments(arguments) else { return Value::default() };
        for (value, argument) in values.iter().zip(arguments) {
            let span = argument_span(argument);
            let bilinear = name == "dot" || name == "cross";
            if !bilinear
                && !self.single_valued(
                    &value.traits.sets,
                    span,
                    &format!("the argument of `{name}`"),
                )
            {
                return Value::default();
            }
        }
        match builtins::find(name) {
            Some(builtin) => self.apply_builtin(builtin, &values, arguments),
            None => self.apply_to_vectors(name, &values, arguments, expr.span),
        }
    }

    pub(super) fn count_is(
        &mut self,
        name: &str,
        wanted: usize,
        given: usize,
        span: Span,
        declared: Option<Span>,
    ) -> bool {
        if wanted == given {
            return true;
        }
        let plural = if wanted == 1 { "argument" } else { "arguments" };
        let message = format!("`{name}` takes {wanted} {plural}, not {given}");
        let found = Diagnostic::new(Code::WrongArguments, message, span, format!("{given} given"));
        let found = match declared {
            Some(place) => found.label(place, format!("declared with {wanted}")),
            None => found,
        };
        self.diagnostics.push(found.help(format!("give it {wanted} {plural}")));
        false
    }

    /// Arguments that are ordinary expressions; reports the others.
    pub(super) fn plain_arguments(&mut self, arguments: &'a [Argument]) -> Option<Vec<Value>> {
        let mut values = Vec::new();
        for argument in arguments {
            match argument {
                Argument::Expr(value) => values.push(self.evaluate(value)),
                Argument::End(span) | Argument::Start(span) => {
                    let found = Diagnostic::new(
                        Code::NotAllowedHere,
                        "an end of time as one of several arguments",
                        *span,
                        "stands alone",
                    );
                    self.diagnostics.push(found.help("only `x(start)` and `x(end)` take it"));
                }
                Argument::Iteration(_, data) => {
                    let found = Diagnostic::new(
                        Code::NotAllowedHere,
                        "only `sum` goes through data",
                        data.span,
                        "no data here",
                    );
                    self.diagnostics.push(found.help("write `sum(k in obs, ...)`"));
                }
            }
        }
        (values.len() == arguments.len()).then_some(values)
    }

    fn apply_builtin(
        &mut self,
        builtin: Builtin,
        values: &[Value],
        arguments: &'a [Argument],
    ) -> Value {
        let traits = Self::joined(values);
        if builtin == Builtin::Abs {
            let value = values[0].clone();
            return self.map(value, |graph, part| graph.abs(part));
        }
        let mut operands: Vec<ExprId> = Vec::new();
        for (value, argument) in values.iter().zip(arguments) {
            operands.extend(self.expect_number(value, argument_span(argument)));
        }
        let complete = operands.len() == values.len();
        match complete {
            true => Value::scalar(self.graph.call(builtin, &operands), traits),
            false => Value::unknown(traits),
        }
    }
}

/// Where an argument stands.
pub(crate) fn argument_span(argument: &Argument) -> Span {
    match argument {
        Argument::Expr(value) => value.span,
        Argument::End(span) | Argument::Start(span) => *span,
        Argument::Iteration(name, data) => name.span.to(data.span),
    }
}

fn called_elsewhere(name: &str, own: &str, span: Span) -> Diagnostic {
    let message = format!("nothing called `{name}` here");
    let change = format!("change `{name}` to `{own}`");
    Diagnostic::new(Code::UnknownName, message, span, "not declared")
        .help(&change)
        .fix(Fix::likely(change).replace(span, own))
}
