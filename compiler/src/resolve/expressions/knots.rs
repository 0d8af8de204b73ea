//! Where the pieces of a `piecewise` meet, and how smoothly.
//!
//! A guard `a <= b` that is affine in some input `z` changes at `z* = z - g(z)/g'(z)`, `g = a - b`.
//! There the pieces on both sides are compared, with their first and second derivatives by `z`, at
//! a few values of the other inputs. Guards that are affine in nothing are passed over: better
//! silent than wrong.

use super::first_arm::{Along, Gaps};
use crate::expressions::graph::ExprId;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::evaluate;
use crate::model::Symbol;
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::knots::{Knot, Site};
use crate::resolve::elaborator::value::Traits;
use fdcc_grammar::ast::{Arm, Expr};
use std::collections::{BTreeMap, BTreeSet};

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
            let knots = self.knots(guards, arms);
            let site = Site { expr, owner: self.here.owner, knots, guards: BTreeSet::new() };
            self.sites.insert(expr.span, site);
        }
        let sides =
            guards.iter().enumerate().map(|(at, guard)| (at, [guard.smaller, guard.larger]));
        self.sites.get_mut(&expr.span).expect("it is there by now").guards.extend(sides);
    }

    /// The worst knot of each guard.
    fn knots(&mut self, guards: &[Guard<'a>], arms: &[&[ExprId]]) -> Vec<Knot<'a>> {
        let gaps: Vec<ExprId> =
            guards.iter().map(|it| self.graph.sub(it.smaller, it.larger)).collect();
        let variables: Vec<Option<u32>> =
            gaps.iter().map(|gap| self.affine_variable(*gap)).collect();
        let readers = self.readers(&gaps, &variables);
        let mut worst: Vec<Option<Knot<'a>>> = guards.iter().map(|_| None).collect();
        for sample in 0..SAMPLES {
            let mut point = self.sample(sample);
            let gaps = Gaps::at(&self.graph, &gaps, &point);
            for (&variable, reading) in &readers {
                let along = Along::new(&mut self.graph, &gaps, reading, variable, &point);
                let place = point[variable as usize];
                let mut meeting = Meeting { variable, point: std::mem::take(&mut point), along };
                for &at in reading.iter().filter(|at| variables[**at] == Some(variable)) {
                    let found = self.knot(at, gaps.all[at], &mut meeting, guards[at].arm, arms);
                    let order = worst[at].as_ref().map_or(usize::MAX, |it| it.order);
                    worst[at] = found.filter(|it| it.order < order).or(worst[at].take());
                    meeting.point[variable as usize] = place;
                }
                point = meeting.point;
            }
        }
        worst.into_iter().flatten().collect()
    }

    /// The guards that read each input in which some guard is affine.
    fn readers(&self, gaps: &[ExprId], variables: &[Option<u32>]) -> BTreeMap<u32, Vec<usize>> {
        let mut readers: BTreeMap<u32, Vec<usize>> =
            variables.iter().flatten().map(|variable| (*variable, Vec::new())).collect();
        for (at, gap) in gaps.iter().enumerate() {
            for input in self.graph.inputs_of(&[*gap]) {
                if let Some(reading) = readers.get_mut(&input) {
                    reading.push(at);
                }
            }
        }
        readers
    }

    /// The knot of a guard, which has a value at the point of a meeting: there the meeting goes.
    fn knot(
        &mut self,
        at: usize,
        (gap, value): (ExprId, f64),
        meeting: &mut Meeting,
        arm: &'a Arm,
        arms: &[&[ExprId]],
    ) -> Option<Knot<'a>> {
        let slope = derivative(&mut self.graph, gap, meeting.variable);
        let slope = evaluate(&self.graph, &[slope], &meeting.point, &[])[0];
        meeting.point[meeting.variable as usize] -= value / slope;
        let active = self.around(meeting, arms.len() - 1);
        // An earlier arm that holds here hides this guard.
        if active[0] == active[1] || active.iter().any(|&arm| arm < at) {
            return None;
        }
        let found = (0..arms[0].len()).filter_map(|part| {
            let sides = active.map(|arm| arms[arm][part]);
            let jump = self.first_jump(sides, meeting);
            jump.map(|(order, limits)| Knot { arm, at, order, limits })
        });
        found.min_by_key(|knot| knot.order)
    }

    /// The arms that hold on both sides of a meeting; `otherwise` comes after all of them.
    fn around(&self, meeting: &mut Meeting, otherwise: usize) -> [usize; 2] {
        let variable = meeting.variable as usize;
        let place = meeting.point[variable];
        let nudge = 1e-6 * (1.0 + place.abs());
        let arms = [-nudge, nudge].map(|nudge| {
            meeting.point[variable] = place + nudge;
            meeting.along.first(&self.graph, &meeting.point).unwrap_or(otherwise)
        });
        meeting.point[variable] = place;
        arms
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
    variable: u32,
    point: Vec<f64>,
    /// Which arm holds where the variable moves.
    along: Along,
}

/// A limit without the dust of rounding, to be read by people.
fn tidy(value: f64) -> f64 {
    let rounded = (value * 1e6).round() / 1e6;
    if (rounded - value).abs() <= 1e-9 * (1.0 + value.abs()) { rounded } else { value }
}
