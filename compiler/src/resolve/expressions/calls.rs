//! Calls: the builtin functions of numbers and vectors, the model's own functions, and the special
//! forms.

use crate::expressions::graph::ExprId;
use crate::expressions::graph::builtins::{self, Builtin};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Parts, Traits, Value};
use crate::syntax::DEEPEST;
use crate::syntax::functions::{self, function_names, is_function};
use crate::syntax::scope;
use fdcc_grammar::ast::{Argument, Expr, ExprKind, Ident, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};

/// No sensible model applies its functions so often to different arguments.
const MOST_APPLICATIONS: usize = 50_000;

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
            return self.at_an_end(callee, &arguments[0], expr.span);
        }
        let ExprKind::Name(name) = &callee.kind else {
            if let (ExprKind::Part(..) | ExprKind::Index(..), true, [at]) =
                (&callee.kind, self.rows.is_some(), arguments)
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
                _ if self.rows.is_some() && arguments.len() == 1 => {
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

    fn count_is(
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
    fn plain_arguments(&mut self, arguments: &'a [Argument]) -> Option<Vec<Value>> {
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

    fn apply_to_vectors(
        &mut self,
        name: &str,
        values: &[Value],
        arguments: &'a [Argument],
        span: Span,
    ) -> Value {
        let traits = Self::joined(values);
        if values.iter().any(|value| value.parts == Parts::Unknown) {
            return Value::unknown(traits);
        }
        let lengths: Vec<usize> = values.iter().map(|value| value.parts.as_slice().len()).collect();
        if lengths.iter().any(|&length| length != lengths[0]) {
            return self.different_sizes(name, values, arguments);
        }
        let (a, b) = (&values[0].parts, &values[values.len() - 1].parts);
        match name {
            "cross" => self.cross(&values[0], &values[1], traits, span),
            "norm" => {
                let square = self.dot(a, b);
                Value::scalar(self.graph.sqrt(square), traits)
            }
            _ => self.product(&values[0], &values[values.len() - 1], name == "dot", traits, span),
        }
    }

    /// `dot(a, b)`, and `normsq(a)` as `dot(a, a)`.
    fn product(&mut self, a: &Value, b: &Value, is_dot: bool, traits: Traits, span: Span) -> Value {
        if is_dot && !self.product_of_sets(&a.traits.sets, &b.traits.sets, span) {
            return Value::default();
        }
        Value::scalar(self.dot(&a.parts, &b.parts), traits)
    }

    fn different_sizes(&mut self, name: &str, values: &[Value], arguments: &[Argument]) -> Value {
        let described: Vec<String> = values.iter().map(|value| value.parts.describe()).collect();
        let message = format!("`{name}` of {}", described.join(" and "));
        let found = Diagnostic::new(
            Code::ShapeMismatch,
            message,
            argument_span(&arguments[0]),
            described[0].as_str(),
        )
        .label(argument_span(&arguments[1]), described[1].as_str());
        self.fail_shape(found.help("both need the same size"))
    }

    /// `a x b`: a number in the plane, a vector in space.
    fn cross(&mut self, a: &Value, b: &Value, traits: Traits, span: Span) -> Value {
        if !self.product_of_sets(&a.traits.sets, &b.traits.sets, span) {
            return Value::default();
        }
        let (a, b) = (a.parts.as_slice(), b.parts.as_slice());
        let mut minor = |i: usize, j: usize| {
            let (left, right) = (self.graph.mul(a[i], b[j]), self.graph.mul(a[j], b[i]));
            self.graph.sub(left, right)
        };
        match a.len() {
            2 => Value::scalar(minor(0, 1), traits),
            3 => Value {
                parts: Parts::from_list(&[minor(1, 2), minor(2, 0), minor(0, 1)]),
                traits,
                named: None,
            },
            _ => {
                let found = Diagnostic::new(
                    Code::ShapeMismatch,
                    "`cross` is for two or three dimensions",
                    span,
                    "other sizes",
                );
                self.fail_shape(found.help("give it vectors of 2 or 3"))
            }
        }
    }

    fn own_function(
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
        let key = (at, self.examining, values);
        if let Some(known) = self.applied.get(&key) {
            return known.clone();
        }
        if self.depth > DEEPEST {
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
        let outer = (self.frame, self.owner.replace(at));
        self.frame = self.locals.len();
        self.locals.extend(formal.iter().map(|name| name.name.as_str()).zip(values));
        let value = run(self);
        self.locals.truncate(self.frame);
        (self.frame, self.owner) = outer;
        value
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
