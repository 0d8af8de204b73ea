//! `Dir(e)`: the direction `e/|e|` of a vector, and the unit ball where it is 0. Each component of
//! `e` is a surface with a selector; together they are a [`Ball`]. Of a number it is `Sgn`.

use crate::expressions::graph::ExprId;
use crate::model::{Ball, Place};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Parts, Reads, SetForm, SetUse, Traits, Value};
use crate::syntax::text;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Expr, ExprKind};

impl<'a> Elaborator<'a> {
    /// `Dir(vector)`; named by the text of the vector.
    pub fn direction(&mut self, vector: &'a Expr, span: Span) -> Value {
        let is_surface =
            matches!(&vector.kind, ExprKind::Name(name) if self.surface_named(name).is_some());
        if is_surface {
            return self.sgn(vector, span);
        }
        let value = self.evaluate_in(Context::SURFACE, vector);
        let is_single =
            self.single_valued(&value.traits.sets, vector.span, "the argument of `Dir`");
        let name = text::expr(vector);
        let mut selectors = Parts::Unknown;
        let mut set = SetUse { surface: name.as_str().into(), span, form: SetForm::Dir };
        match &value.parts {
            Parts::Scalar(_) if is_single => return self.sgn(vector, span),
            Parts::Vector(parts) if is_single && !self.here.examining => {
                let ball = self.ball(name, vector.span, &value, parts);
                set.surface = self.balls[ball].place.name.as_str().into();
                let surfaces = self.balls[ball].surfaces.clone();
                selectors = Parts::Vector(surfaces.map(|at| self.surfaces[at].selector).collect());
            }
            _ => {}
        }
        let traits = Traits { reads: Reads::SELECTOR, sets: vec![set], knots: Vec::new() };
        Value { parts: selectors, traits, named: value.named }
    }

    /// The ball of a vector, made at its first use.
    fn ball(&mut self, name: String, span: Span, value: &Value, parts: &[ExprId]) -> usize {
        let psi =
            |ball: &Ball| ball.surfaces.clone().map(|at| self.surfaces[at].psi).collect::<Vec<_>>();
        let wanted: Vec<Option<ExprId>> = parts.iter().copied().map(Some).collect();
        if let Some(known) = self.balls.iter().position(|ball| psi(ball) == wanted) {
            return known;
        }
        let name = self.free_name(&name);
        let is_word =
            name.chars().all(|letter| letter.is_alphanumeric() || "_. #".contains(letter));
        let whole = if is_word { name.clone() } else { format!("({name})") };
        let first = self.surfaces.len();
        for (at, &part) in parts.iter().enumerate() {
            let name = self.component(&whole, value, at);
            self.add_surface(Place { name, span }, Some(part));
        }
        self.balls.push(Ball { place: Place { name, span }, surfaces: first..self.surfaces.len() });
        self.balls.len() - 1
    }

    /// Whether a surface is a component of a ball.
    pub fn is_in_ball(&self, surface: usize) -> bool {
        self.balls.iter().any(|ball| ball.surfaces.contains(&surface))
    }
}
