//! Calls with a meaning of their own: sets, whole-run numbers, data.

use super::calls::argument_span;
use crate::expressions::graph::{Expr as Node, ExprId};
use crate::model::{Integral, Place, Simulated, Symbol};
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Parts, Reads, SetForm, SetUse, Traits, Value};
use crate::resolve::elaborator::{Elaborator, SurfaceEntry};
use crate::syntax::{scope, text};
use fdcc_grammar::ast::{Argument, Expr, ExprKind, Ident};
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::HashMap;

impl<'a> Elaborator<'a> {
    /// One of the special forms; the number of arguments is right.
    pub fn form(&mut self, name: &str, expr: &'a Expr, arguments: &'a [Argument]) -> Value {
        match (name, arguments) {
            ("Sgn", [Argument::Expr(psi)]) => self.sgn(psi, expr.span),
            ("Dir", [Argument::Expr(vector)]) => self.direction(vector, expr.span),
            ("selected", [Argument::Expr(set)]) => self.selected(set, expr.span),
            ("integral", [Argument::Expr(integrand)]) => self.integral(integrand, expr),
            ("sum", [Argument::Iteration(name, data), Argument::Expr(term)]) => {
                self.sum(name, data, term, expr)
            }
            ("interpolate", _) => self.interpolate(arguments, expr.span),
            ("blend", [Argument::Expr(function), Argument::Expr(width)]) => {
                self.blend(function, width, expr.span)
            }
            ("sliding", [Argument::Expr(surface)]) => self.sliding(surface, expr.span),
            ("sensitivity", [Argument::Expr(of), Argument::Expr(by)]) => {
                self.sensitivity(of, by, expr.span)
            }
            _ => self.no_arguments(name, &arguments[0]),
        }
    }

    /// Arguments of another kind than a form takes.
    pub fn no_arguments(&mut self, name: &str, first: &Argument) -> Value {
        let message = format!("these are no arguments for `{name}`");
        let (place, label) = (argument_span(first), "not an expression it takes");
        let found = Diagnostic::new(Code::NotAllowedHere, message, place, label);
        self.fail(found.help(form_help(name)))
    }

    /// `Sgn(surface)`, or of an expression that then is a surface named by its text.
    pub fn sgn(&mut self, psi: &'a Expr, span: Span) -> Value {
        let name = text::expr(psi);
        let known = match &psi.kind {
            ExprKind::Name(name) => self.surface_named(name),
            _ => None,
        };
        let entry = known.or_else(|| self.unnamed_surface(psi, &name));
        let set = SetUse {
            surface: entry.map_or(name, |at| self.surfaces[at].place.name.clone()).into(),
            span,
            form: SetForm::Sgn,
        };
        self.selector(entry, set)
    }

    pub fn surface_named(&mut self, name: &str) -> Option<usize> {
        let is_local = self.here.local(name).is_some();
        if is_local { None } else { self.surface_of.get(&self.scope.find(name)?).copied() }
    }

    fn unnamed_surface(&mut self, psi: &'a Expr, name: &str) -> Option<usize> {
        let is_local = self.here.local(name).is_some();
        if matches!(&psi.kind, ExprKind::Name(_)) && !is_local && self.scope.find(name).is_none() {
            let found = self.scope.unknown(name, psi.span, &[], &format!("surface {name} = x"));
            self.diagnostics.push(found);
            return None;
        }
        let value = self.evaluate_in(Context::SURFACE, psi);
        if !self.single_valued(&value.traits.sets, psi.span, "the argument of `Sgn`")
            || self.here.examining
        {
            return None;
        }
        let part = self.expect_number(&value, psi.span)?;
        let is_known = |&at: &usize| self.surfaces[at].psi == Some(part) && !self.is_in_ball(at);
        if let Some(known) = (0..self.surfaces.len()).find(is_known) {
            return Some(known);
        }
        let name = self.free_name(name);
        Some(self.add_surface(Place { name, span: psi.span }, Some(part)))
    }

    /// The name itself, or numbered if surfaces of that name are there.
    pub fn free_name(&self, name: &str) -> String {
        let alone = (0..self.surfaces.len()).filter(|&at| !self.is_in_ball(at));
        let known = alone.map(|at| &self.surfaces[at].place.name);
        let known = known.chain(self.balls.iter().map(|ball| &ball.place.name));
        match known.filter(|known| known.split(" #").next() == Some(name)).count() {
            0 => name.to_string(),
            taken => format!("{name} #{}", taken + 1),
        }
    }

    /// Makes a surface and its selector.
    pub fn add_surface(&mut self, place: Place, psi: Option<ExprId>) -> usize {
        let selector = self.symbol(Symbol::Selector(self.surfaces.len()));
        self.surfaces.push(SurfaceEntry { place, psi, selector });
        self.surfaces.len() - 1
    }

    fn selector(&mut self, surface: Option<usize>, set: SetUse) -> Value {
        let traits = Traits { reads: Reads::SELECTOR, sets: vec![set], knots: Vec::new() };
        match surface {
            Some(at) => Value::scalar(self.surfaces[at].selector, traits),
            None => Value::unknown(traits),
        }
    }

    /// The value that acts: a single one, so it may stand anywhere.
    fn selected(&mut self, set: &'a Expr, span: Span) -> Value {
        let mut value = self.evaluate(set);
        value.traits.sets.clear();
        self.admit("selected", value, span)
    }

    /// `match surface { below => a, above => b }` is `a (1 - s)/2 + b (1 + s)/2` with the selector
    /// `s`.
    pub fn matched(
        &mut self,
        expr: &'a Expr,
        surface: &'a Ident,
        below: &'a Expr,
        above: &'a Expr,
    ) -> Value {
        let (a, b) = (self.evaluate(below), self.evaluate(above));
        let at = self.match_surface(surface);
        let set =
            SetUse { surface: surface.name.as_str().into(), span: expr.span, form: SetForm::Match };
        let inner: Vec<SetUse> = a.traits.sets.iter().chain(&b.traits.sets).cloned().collect();
        if !self.product_of_sets(std::slice::from_ref(&set), &inner, expr.span) {
            return Value::default();
        }
        let selector = self.selector(at, set);
        let traits = selector.traits.clone().join(&a.traits).join(&b.traits);
        let (left, right) = (a.parts.as_slice(), b.parts.as_slice());
        let (Parts::Scalar(s), false, false) = (&selector.parts, left.is_empty(), right.is_empty())
        else {
            return Value::unknown(traits);
        };
        if left.len() != right.len() {
            return self.arms_differ(&a, below.span, &b, above.span);
        }
        let parts: Vec<_> = left.iter().zip(right).map(|(&a, &b)| self.mixture(*s, a, b)).collect();
        Value { parts: Parts::from_list(&parts), traits, named: a.named.or(b.named) }
    }

    fn mixture(&mut self, s: ExprId, below: ExprId, above: ExprId) -> ExprId {
        let graph = &mut self.graph;
        let (sum, jump) = (graph.add(below, above), graph.sub(above, below));
        let (mean, half) = (graph.scale(0.5, sum), graph.scale(0.5, jump));
        let change = graph.mul(s, half);
        graph.add(mean, change)
    }

    /// Two alternatives of different sizes.
    pub fn arms_differ(&mut self, a: &Value, first: Span, b: &Value, second: Span) -> Value {
        let found = Diagnostic::new(
            Code::ShapeMismatch,
            "the alternatives have different sizes",
            first,
            a.parts.describe(),
        )
        .label(second, b.parts.describe());
        self.fail_shape(found.help("all alternatives need the same size"))
    }

    fn match_surface(&mut self, surface: &'a Ident) -> Option<usize> {
        if let Some(at) = self.surface_named(&surface.name) {
            return Some(at);
        }
        let found = match self.scope.find(&surface.name) {
            None => self.scope.unknown(
                &surface.name,
                surface.span,
                &[],
                &format!("surface {} = x", surface.name),
            ),
            Some(at) => {
                let kind = scope::kind_word(self.scope.declarations[at].item);
                let message = format!("`{}` is a {kind}, not a surface", surface.name);
                Diagnostic::new(Code::WrongKind, message, surface.span, format!("a {kind}"))
                    .help(format!("declare one: `surface switch = {}`", surface.name))
            }
        };
        self.diagnostics.push(found);
        None
    }

    /// `integral(e)` over the whole time.
    fn integral(&mut self, integrand: &'a Expr, whole: &'a Expr) -> Value {
        let value = self.evaluate_in(Context::INTEGRAND, integrand);
        let part = self.expect_number(&value, integrand.span);
        let of_phases = value.traits.reads.within(Reads::PHASE.or(Reads::FOREIGN));
        let traits = Traits { reads: of_phases.or(Reads::WHOLE), ..value.traits };
        let place = Place { name: text::expr(whole), span: whole.span };
        let input =
            part.filter(|_| !self.here.examining).and_then(|part| match self.phases.len() {
                0 => Some(self.integrated(part, place)),
                _ => self.integral_of_phases(part, &place),
            });
        let value = input.map_or(Value::unknown(traits.clone()), |it| Value::scalar(it, traits));
        self.admit("integral", value, whole.span)
    }

    /// The symbol of an integral over the whole time.
    pub fn integrated(&mut self, integrand: ExprId, place: Place) -> ExprId {
        let known = self.integrals.iter().position(|it| it.integrand == integrand);
        let at = known.unwrap_or_else(|| {
            self.integrals.push(Integral { place, integrand, is_linked: false });
            self.integrals.len() - 1
        });
        self.known_symbol(Symbol::Integral(at))
    }

    /// `x(end)` and `x(start)`.
    pub fn at_an_end(&mut self, callee: &'a Expr, end: &Argument, span: Span) -> Value {
        let mut value = self.evaluate_in(Context::AT_AN_END, callee);
        let at_end = matches!(end, Argument::End(_));
        let parts = self.move_to_end(value.parts.as_slice().to_vec(), at_end);
        let reads = value.traits.reads;
        // The time is known of a run beforehand, as far as unknowns are.
        let is_time = !reads.has(Reads::STATE.or(Reads::PHASE).or(Reads::FOREIGN));
        let known = if is_time { Reads::PARAM.or(Reads::FREE) } else { Reads::WHOLE };
        value.traits.reads = reads.beyond(Reads::TIME.or(Reads::STATE)).or(known);
        value.parts = Parts::from_list(&parts);
        self.admit(&text::expr(callee), value, span)
    }

    /// Replaces states and time by their values at an end.
    pub fn move_to_end(&mut self, parts: Vec<ExprId>, at_end: bool) -> Vec<ExprId> {
        let of_phases = match self.phases.is_empty() {
            true => HashMap::new(),
            false => self.ends_of_phases(&parts, at_end),
        };
        let (time, states) = (self.interval[at_end as usize], &self.at_ends[at_end as usize]);
        let symbols = &self.symbols;
        let moved = |input: u32| match symbols[input as usize] {
            Symbol::Time => Some(time),
            Symbol::State(index) => Some(states[index]),
            Symbol::OfPhase { .. } => of_phases.get(&input).copied(),
            _ => None,
        };
        // Most are bare states, which need no walk through the graph.
        let bare: Option<Vec<ExprId>> = parts
            .iter()
            .map(|&part| match self.graph.expr(part) {
                Node::Input(input) => moved(*input),
                _ => None,
            })
            .collect();
        bare.unwrap_or_else(|| self.graph.substitute(&parts, &moved))
    }

    fn sliding(&mut self, surface: &'a Expr, span: Span) -> Value {
        let known = match &surface.kind {
            ExprKind::Name(name) => self.surface_named(name),
            _ => None,
        };
        if let Some(at) = known {
            return self.simulated("sliding", Simulated::Sliding(at), span);
        }
        if self.evaluate(surface).parts != Parts::Unknown {
            let found = Diagnostic::new(
                Code::WrongKind,
                "`sliding` is asked of a surface",
                surface.span,
                "not a surface",
            );
            self.diagnostics.push(found.help("declare one: `surface name = expression`"));
        }
        Value::default()
    }

    fn sensitivity(&mut self, of: &'a Expr, by: &'a Expr, span: Span) -> Value {
        let number = self.evaluate_in(Context::SENSITIVITY, of);
        let direction = self.evaluate_in(Context::SENSITIVITY, by);
        let number = self.expect_number(&number, of.span);
        let direction = self.expect_number(&direction, by.span);
        let (Some(number), Some(direction)) = (number, direction) else { return Value::default() };
        let symbol = match self.graph.expr(direction) {
            Node::Input(input) => Some(self.symbols[*input as usize]),
            _ => None,
        };
        match symbol {
            Some(by @ (Symbol::Param(_) | Symbol::Free(_) | Symbol::AtStart(_))) => {
                self.simulated("sensitivity", Simulated::Sensitivity { of: number, by }, span)
            }
            _ => self.no_direction(by),
        }
    }

    fn no_direction(&mut self, by: &'a Expr) -> Value {
        let message = format!("a sensitivity cannot be taken by `{}`", text::expr(by));
        let label = "not a parameter, an unknown or a start";
        let found = Diagnostic::new(Code::NotAllowedHere, message, by.span, label);
        self.fail(
            found.help("name a `param` or a `free`, or the start of a state, such as `x(start)`"),
        )
    }

    /// Something that only a simulation can tell.
    fn simulated(&mut self, name: &str, what: Simulated, span: Span) -> Value {
        let known = self.model.simulated.iter().position(|other| *other == what);
        let at = known.unwrap_or_else(|| {
            self.model.simulated.push(what);
            self.model.simulated.len() - 1
        });
        let part = self.known_symbol(Symbol::Simulated(at));
        let traits = Traits { reads: Reads::SIMULATION, ..Traits::default() };
        self.admit(name, Value::scalar(part, traits), span)
    }
}

fn form_help(name: &str) -> &'static str {
    match name {
        "sum" => "write `sum(k in obs, (x(k.t) - k.x)^2)`",
        "interpolate" => "write `interpolate(obs.t, obs.y, t)`",
        _ => "give it ordinary expressions",
    }
}
