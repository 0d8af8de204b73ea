//! The quadratic programme at an iterate, in the form of the conic solver.
//!
//! ```text
//!     minimise  (g + rho A'r)'d + 1/2 d'(H + delta + rho A'A) d  [ + nu sum s ]
//!     subject to   sides of J d + c and d + v   [ each side of a row violated by s >= 0 ]
//! ```
//!
//! With slacks `s` it always has a solution, and for a large price `nu` that has no slack unless
//! there is no other.

use super::curvature::Convexity;
use super::point::{Point, violation};
use super::working::Working;
use crate::linalg::Columns;
use crate::nlp::convex::clarabel::{ConicProgram, ConicSolution, ConicStatus, solve_conic};
use crate::nlp::convex::one_sided::{Sides, Source, by_rows};
use crate::nlp::{Counts, Derivatives, Multipliers, Nlp};
use crate::problem::Bounds;

/// The conic solver needs no more iterations than this, or it is lost.
const MOST_ITERATIONS: usize = 100;

/// Where the programme is approximated, and by what.
pub(super) struct Subproblem<'a> {
    pub(super) nlp: &'a dyn Nlp,
    pub(super) at: &'a Point,
    pub(super) derivatives: &'a Derivatives,
    pub(super) working: &'a Working,
    pub(super) convexity: Convexity,
}

/// Its solution.
pub(super) struct Direction {
    pub(super) d: Vec<f64>,
    /// Multipliers of the programme.
    pub(super) multipliers: Multipliers,
    /// What the violation would be if the rows were linear.
    pub(super) violation: f64,
}

impl Subproblem<'_> {
    /// Solves it, with violations at the price `nu` or without; `None` if that fails.
    pub(super) fn solve(
        &self,
        sides: &Sides,
        nu: Option<f64>,
        tolerance: f64,
        counts: &mut Counts,
    ) -> Option<Direction> {
        let program = match nu {
            None => self.program(sides),
            Some(nu) => elastic(self.program(sides), sides, nu),
        };
        let found = solve_conic(program, tolerance, MOST_ITERATIONS);
        counts.factorizations += found.iterations;
        let has_solution = matches!(found.status, ConicStatus::Solved | ConicStatus::Roughly);
        (has_solution && found.x.iter().all(|x| x.is_finite()))
            .then(|| self.direction(sides, found))
    }

    fn program(&self, sides: &Sides) -> ConicProgram {
        ConicProgram {
            p: self.hessian(),
            q: self.gradient(),
            a: sides.columns(self.nlp, &self.derivatives.jacobian),
            b: sides.right_side(&self.at.rows, &self.at.v),
            equalities: sides.equalities,
        }
    }

    /// The upper triangle of `H + delta + rho A'A`. Fixed variables do not move, whatever stands
    /// there.
    fn hessian(&self) -> Columns {
        let (nlp, Convexity { delta, rho }) = (self.nlp, self.convexity);
        let structure = nlp.hessian_structure().entries().zip(&self.derivatives.hessian);
        let mut entries: Vec<_> =
            structure.map(|((i, j), value)| (i.min(j), i.max(j), *value)).collect();
        for (i, expected) in self.working.variables.iter().enumerate() {
            entries.push((i, i, delta + expected.map_or(0.0, |_| rho)));
        }
        let rows = by_rows(nlp, &self.derivatives.jacobian);
        for (row, _) in
            rows.iter().zip(&self.working.rows).filter(|(_, expected)| expected.is_some())
        {
            for (i, a) in row {
                let products = row.iter().filter(|(j, _)| i <= j);
                entries.extend(products.map(|(j, b)| (*i, *j, rho * a * b)));
            }
        }
        let is_fixed = |i: usize| nlp.variable_bounds()[i].is_equality();
        entries.retain(|(i, j, _)| !is_fixed(*i) && !is_fixed(*j));
        Columns::of_entries(&entries, self.at.v.len(), self.at.v.len())
    }

    /// `g + rho A'r`
    fn gradient(&self) -> Vec<f64> {
        let mut gradient = self.derivatives.gradient.clone();
        let pull = |expected: &Option<f64>| self.convexity.rho * expected.unwrap_or(0.0);
        let of_rows: Vec<f64> = self.working.rows.iter().map(pull).collect();
        let jacobian = &self.derivatives.jacobian;
        self.nlp.jacobian_structure().transposed_multiply_add(jacobian, &of_rows, &mut gradient);
        gradient
            .iter_mut()
            .zip(&self.working.variables)
            .for_each(|(value, expected)| *value += pull(expected));
        gradient
    }

    fn direction(&self, sides: &Sides, found: ConicSolution) -> Direction {
        let mut d = found.x;
        d.truncate(self.at.v.len());
        for ((d, v), bounds) in d.iter_mut().zip(&self.at.v).zip(self.nlp.variable_bounds()) {
            *d = d.max(bounds.lower - v).min(bounds.upper - v);
        }
        let mut multipliers = sides.multipliers(&found.z);
        let mut rows = vec![0.0; self.at.rows.len()];
        self.nlp.jacobian_structure().multiply_add(&self.derivatives.jacobian, &d, &mut rows);
        self.correct(&d, &rows, &mut multipliers);
        rows.iter_mut().zip(&self.at.rows).for_each(|(row, c)| *row += c);
        Direction { d, multipliers, violation: violation(self.nlp.row_bounds(), &rows) }
    }

    /// From multipliers of the subproblem with `B` to those of the one with `H`: what is left of `A
    /// d + r` pulls with the weight `rho`.
    fn correct(&self, d: &[f64], rows: &[f64], multipliers: &mut Multipliers) {
        let rho = self.convexity.rho;
        let of_rows = self.working.rows.iter().zip(rows).zip(self.nlp.row_bounds());
        for (lambda, ((expected, row), bounds)) in multipliers.rows.iter_mut().zip(of_rows) {
            if let Some(r) = expected {
                *lambda = allowed(bounds, *lambda + rho * (r + row));
            }
        }
        for (i, (expected, d)) in self.working.variables.iter().zip(d).enumerate() {
            if let Some(r) = expected {
                let pull = rho * (r + d);
                let of_side =
                    if pull > 0.0 { &mut multipliers.lower } else { &mut multipliers.upper };
                of_side[i] = (of_side[i] - pull.abs()).max(0.0);
            }
        }
    }
}

/// The nearest multiplier that a row with these bounds can have.
fn allowed(bounds: &Bounds, lambda: f64) -> f64 {
    match (bounds.lower.is_finite(), bounds.upper.is_finite()) {
        (true, false) => lambda.min(0.0),
        (false, true) => lambda.max(0.0),
        _ => lambda,
    }
}

/// Allows each side of a row to be violated at the price `nu`: an equality from above and from
/// below.
fn elastic(program: ConicProgram, sides: &Sides, nu: f64) -> ConicProgram {
    let ConicProgram { p, mut q, a, mut b, equalities } = program;
    let (mut p, mut entries) = (p, a.entries());
    for (i, side) in sides.list.iter().enumerate() {
        let Source::Row(_) = side.source else { continue };
        let signs: &[f64] = if side.is_equality() { &[-1.0, 1.0] } else { &[-1.0] };
        for sign in signs {
            entries.extend([(i, q.len(), *sign), (b.len(), q.len(), -1.0)]);
            q.push(nu);
            b.push(0.0);
        }
    }
    p.widen(q.len());
    ConicProgram { p, a: Columns::of_entries(&entries, b.len(), q.len()), q, b, equalities }
}
