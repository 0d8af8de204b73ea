//! Where the pieces of a `piecewise` meet, and how smoothly.
//!
//! A guard `a <= b` that is affine in some input `z` changes at `z* = z - g(z)/g'(z)`, `g = a - b`.
//! There the pieces on both sides are compared, with their first and second derivatives by `z`, at
//! a few values of the other inputs. Guards that are affine in nothing are passed over: better
//! silent than wrong.

use crate::expressions::graph::ExprId;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::evaluate;
use crate::model::Symbol;
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::knots::{Knot, Site};
use crate::resolve::elaborator::value::Traits;
use fdcc_grammar::ast::{Arm, Expr};
use std::collections::BTreeSet;

/// The guard of an arm: it holds where `smaller <= larger`.
pub(crate) struct Guard<'a> {
    pub arm: &'a Arm,
    pub smaller: ExprId,
    pub larger: ExprId,
    pub traits: Traits,
}

/// Samples of the inputs that the knot does not depend on.
const SAMPLES: usize = 3;

impl<'a> Elaborator<'a> {
    /// Examines a definition at its first evaluation, and keeps its guards at each.
    pub fn find_knots(&mut self, expr: &'a Expr, guards: &[Guard<'a>], arms: &[&[ExprId]]) {
        if !self.sites.contains_key(&expr.span) {
            let knots = (0..guards.len()).filter_map(|at| self.knot(at, guards, arms)).collect();
            let site = Site { expr, owner: self.here.owner, knots, guards: BTreeSet::new() };
            self.sites.insert(expr.span, site);
        }
        let sides =
            guards.iter().enumerate().map(|(at, guard)| (at, [guard.smaller, guard.larger]));
        self.sites.get_mut(&expr.span).expect("it is there by now").guards.extend(sides);
    }

    fn knot(&mut self, at: usize, guards: &[Guard<'a>], arms: &[&[ExprId]]) -> Option<Knot<'a>> {
        let gaps: Vec<ExprId> =
            guards.iter().map(|it| self.graph.sub(it.smaller, it.larger)).collect();
        let variable = self.affine_variable(gaps[at])?;
        let slope = derivative(&mut self.graph, gaps[at], variable);
        let candidates = (0..SAMPLES).filter_map(|sample| {
            let mut point = self.sample(sample);
            let values = evaluate(&self.graph, &[gaps[at], slope], &point, &[]);
            point[variable as usize] -= values[0] / values[1];
            self.compare(Meeting { at, variable, point }, &gaps, arms, guards[at].arm)
        });
        candidates.min_by_key(|knot| knot.order)
    }

    /// An input in which the guard is affine.
    fn affine_variable(&mut self, gap: ExprId) -> Option<u32> {
        let inputs = self.graph.inputs_of(&[gap]);
        let varying = inputs
            .into_iter()
            .filter(|&input| !matches!(self.symbols[input as usize], Symbol::Param(_)));
        varying.collect::<Vec<_>>().into_iter().find(|&input| {
            let slope = derivative(&mut self.graph, gap, input);
            !self.graph.inputs_of(&[slope]).contains(&input)
                && self.graph.as_number(slope) != Some(0.0)
        })
    }

    /// Parameters at their values, everything else somewhere without significance.
    fn sample(&self, sample: usize) -> Vec<f64> {
        let value = |(at, symbol): (usize, &Symbol)| match symbol {
            Symbol::Param(index) => self.param_values[*index],
            _ => 0.37 + 0.61 * sample as f64 - 0.23 * (at % 7) as f64,
        };
        self.symbols.iter().enumerate().map(value).collect()
    }

    fn compare(
        &mut self,
        meeting: Meeting,
        gaps: &[ExprId],
        arms: &[&[ExprId]],
        arm: &'a Arm,
    ) -> Option<Knot<'a>> {
        let place = meeting.point[meeting.variable as usize];
        let nudge = 1e-6 * (1.0 + place.abs());
        let active = [-nudge, nudge].map(|nudge| {
            let mut point = meeting.point.clone();
            point[meeting.variable as usize] += nudge;
            let values = evaluate(&self.graph, gaps, &point, &[]);
            values.iter().position(|&gap| gap <= 0.0).unwrap_or(gaps.len())
        });
        // An earlier arm that holds here hides this guard.
        if active[0] == active[1] || active.iter().any(|&arm| arm < meeting.at) {
            return None;
        }
        let found = (0..arms[0].len()).filter_map(|part| {
            let sides = active.map(|arm| arms[arm][part]);
            self.first_jump(sides, &meeting).map(|(order, limits)| Knot {
                arm,
                at: meeting.at,
                order,
                limits,
            })
        });
        found.min_by_key(|knot| knot.order)
    }

    /// The lowest derivative in which two pieces differ, up to the second.
    fn first_jump(
        &mut self,
        mut sides: [ExprId; 2],
        meeting: &Meeting,
    ) -> Option<(usize, [f64; 2])> {
        for order in 0..=2 {
            let limits = evaluate(&self.graph, &sides, &meeting.point, &[]);
            let size = 1.0 + limits[0].abs().max(limits[1].abs());
            if (limits[0] - limits[1]).abs() > 1e-9 * size {
                return Some((order, [tidy(limits[0]), tidy(limits[1])]));
            }
            sides = sides.map(|side| derivative(&mut self.graph, side, meeting.variable));
        }
        None
    }
}

/// A point on the border of an arm.
struct Meeting {
    at: usize,
    variable: u32,
    point: Vec<f64>,
}

/// A limit without the dust of rounding, to be read by people.
fn tidy(value: f64) -> f64 {
    let rounded = (value * 1e6).round() / 1e6;
    if (rounded - value).abs() <= 1e-9 * (1.0 + value.abs()) { rounded } else { value }
}
