//! Small programs with known answers, which one attempt of the interior point method finds.

use super::interior_point::attempt;
use super::{
    Derivatives, Multipliers, Nlp, Options, Place, Quantities, Solution, Start, Status, Warm,
};
use crate::linalg::{Family, Stages, Triplets};
use crate::problem::{Bounds, Linear};
use std::ops::ControlFlow;
use std::sync::Arc;

type Values = fn(&[f64], &mut [f64]) -> f64;
type Slopes = fn(&[f64], &mut [f64], &mut [f64]);
type Curvature = fn(&[f64], f64, &[f64], &mut [f64]);

/// A dense program; the Jacobian is row by row, the Hessian is the lower triangle row by row.
struct Dense {
    variables: Vec<Bounds>,
    rows: Vec<Bounds>,
    jacobian: Triplets,
    hessian: Triplets,
    functions: (Values, Slopes, Curvature),
}

impl Dense {
    fn new(
        variables: Vec<Bounds>,
        rows: Vec<Bounds>,
        functions: (Values, Slopes, Curvature),
    ) -> Self {
        let n = variables.len();
        let jacobian =
            (0..rows.len()).flat_map(|i| (0..n).map(move |j| Family::single(i, j))).collect();
        let hessian = (0..n).flat_map(|i| (0..=i).map(move |j| Family::single(i, j))).collect();
        let (jacobian, hessian) = (Triplets { families: jacobian }, Triplets { families: hessian });
        Dense { variables, rows, jacobian, hessian, functions }
    }

    /// The answer of one attempt.
    fn solve(mut self, start: &[f64]) -> Solution {
        let options =
            Options { tol: 1e-9, max_iter: 300, linear: Linear::Automatic, is_final: true };
        let start = Start { v: start.to_vec(), warm: None };
        attempt(&mut self, &start, &options, &mut |_| ControlFlow::Continue(()))
    }
}

impl Nlp for Dense {
    fn variable_bounds(&self) -> &[Bounds] {
        &self.variables
    }
    fn constraint_bounds(&self) -> &[Bounds] {
        &self.rows
    }
    fn jacobian_structure(&self) -> &Triplets {
        &self.jacobian
    }
    fn hessian_structure(&self) -> &Triplets {
        &self.hessian
    }
    fn stages(&self) -> Option<Stages> {
        None
    }
    fn quantities(&self) -> Arc<Quantities> {
        let (variables, constraints) =
            ((0..self.variables.len()).collect(), (0..self.rows.len()).collect());
        let units = vec![1.0; self.variables.len()];
        Arc::new(Quantities { units, variables, constraints, stepped: 0 })
    }
    fn objective_size(&mut self, terms: f64) -> f64 {
        terms.max(super::NO_OBJECTIVE)
    }
    fn objective_unit(&mut self) -> f64 {
        1.0
    }
    fn values(&mut self, v: &[f64], rows: &mut [f64]) -> f64 {
        (self.functions.0)(v, rows)
    }
    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        (self.functions.1)(v, &mut out.gradient, &mut out.jacobian);
        (self.functions.2)(v, weight, multipliers, &mut out.hessian);
    }
    fn constraint_place(&self, _row: usize) -> Place {
        Place::default()
    }
    fn not_finite(&mut self, _v: &[f64]) -> Option<Place> {
        Some(Place::default())
    }
}

fn between(lower: f64, upper: f64) -> Bounds {
    Bounds { lower, upper }
}

fn at_least(lower: f64) -> Bounds {
    between(lower, f64::INFINITY)
}

/// Hock & Schittkowski, problem 71: f* = 17.0140173 at (1, 4.7429994, 3.8211503, 1.3794082).
fn hock_schittkowski_71() -> Dense {
    let values: Values = |x, rows| {
        rows[0] = x.iter().product();
        rows[1] = x.iter().map(|x| x * x).sum();
        x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]
    };
    let slopes: Slopes = |x, g, j| {
        let sum = x[0] + x[1] + x[2];
        g.copy_from_slice(&[x[3] * (sum + x[0]), x[0] * x[3], x[0] * x[3] + 1.0, x[0] * sum]);
        for i in 0..4 {
            j[i] = (0..4).filter(|l| *l != i).map(|l| x[l]).product();
            j[4 + i] = 2.0 * x[i];
        }
    };
    let curvature: Curvature = |x, w, l, h| {
        let pair = |a: usize, b: usize| {
            (0..4).filter(|i| *i != a && *i != b).map(|i| x[i]).product::<f64>()
        };
        let f = [2.0 * x[3], x[3], 0.0, x[3], 0.0, 0.0, 2.0 * x[0] + x[1] + x[2], x[0], x[0], 0.0];
        let mut place = 0;
        for i in 0..4 {
            for j in 0..=i {
                h[place] = w * f[place] + if i == j { 2.0 * l[1] } else { l[0] * pair(i, j) };
                place += 1;
            }
        }
    };
    Dense::new(
        vec![between(1.0, 5.0); 4],
        vec![at_least(25.0), Bounds::fixed(40.0)],
        (values, slopes, curvature),
    )
}

#[test]
fn hock_schittkowski_71_has_its_published_minimum() {
    let solution = hock_schittkowski_71().solve(&[1.0, 5.0, 5.0, 1.0]);
    assert_eq!(solution.status, Status::Solved);
    assert!((solution.objective - 17.0140173).abs() < 1e-6, "{}", solution.objective);
    for (x, expected) in solution.v.iter().zip([1.0, 4.7429994, 3.8211503, 1.3794082]) {
        assert!((x - expected).abs() < 1e-6);
    }
}

/// x^2 + 1 <= 0 has no solution; the smallest violation is at 0.
#[test]
fn an_infeasible_program_is_recognised_at_its_smallest_violation() {
    let values: Values = |x, rows| {
        rows[0] = x[0] * x[0] + 1.0;
        x[0]
    };
    let slopes: Slopes = |x, g, j| {
        g[0] = 1.0;
        j[0] = 2.0 * x[0];
    };
    let curvature: Curvature = |_, _, l, h| h[0] = 2.0 * l[0];
    let row = between(f64::NEG_INFINITY, 0.0);
    let solution =
        Dense::new(vec![Bounds::FREE], vec![row], (values, slopes, curvature)).solve(&[3.0]);
    assert_eq!(solution.status, Status::Infeasible);
    assert!(
        (solution.constraint_violation - 1.0).abs() < 1e-3,
        "{}",
        solution.constraint_violation
    );
}

/// Waechter & Biegler 2000, where line searches without restoration jam: x1^2 - x2 = 1, x1 - x3 =
/// 1/2, x2, x3 >= 0. The only solution is (1, 0, 1/2). From the left, the violation |x1 - 1/2|
/// along x1^2 - x2 = 1 has a local minimum at x1 = -1, where IPOPT 3.14 ends; a
/// watchdog step leads past it.
#[test]
fn where_line_searches_jam_the_solution_is_found() {
    let values: Values = |x, rows| {
        rows[0] = x[0] * x[0] - x[1] - 1.0;
        rows[1] = x[0] - x[2] - 0.5;
        x[0]
    };
    let slopes: Slopes = |x, g, j| {
        g.copy_from_slice(&[1.0, 0.0, 0.0]);
        j.copy_from_slice(&[2.0 * x[0], -1.0, 0.0, 1.0, 0.0, -1.0]);
    };
    let curvature: Curvature = |_, _, l, h| {
        h.fill(0.0);
        h[0] = 2.0 * l[0];
    };
    let bounds = vec![Bounds::FREE, at_least(0.0), at_least(0.0)];
    let jammed = Dense::new(bounds, vec![Bounds::fixed(0.0); 2], (values, slopes, curvature));
    let found = jammed.solve(&[-4.0, 1.0, 1.0]);
    assert_eq!(found.status, Status::Solved);
    let near = found
        .v
        .iter()
        .zip([1.0, 0.0, 0.5])
        .all(|(found, expected)| (found - expected).abs() < 1e-6);
    assert!(near, "{:?}", found.v);
}

/// (x - 1)^2 with x >= 2, begun at its solution as the conic solver leaves it: without a barrier
/// parameter.
#[test]
fn a_start_without_a_barrier_parameter_is_one_all_the_same() {
    let values: Values = |x, _| (x[0] - 1.0).powi(2);
    let slopes: Slopes = |x, g, _| g[0] = 2.0 * (x[0] - 1.0);
    let curvature: Curvature = |_, factor, _, h| h[0] = 2.0 * factor;
    let mut dense = Dense::new(vec![at_least(2.0)], vec![], (values, slopes, curvature));
    let multipliers = Multipliers { lower: vec![2.0], ..Multipliers::zeros(&dense) };
    let start =
        Start { v: vec![2.0], warm: Some(Warm { multipliers, mu: Some(0.0), widths: Vec::new() }) };
    let options = Options { tol: 1e-9, max_iter: 300, linear: Linear::Automatic, is_final: true };
    let solution = attempt(&mut dense, &start, &options, &mut |_| ControlFlow::Continue(()));
    assert_eq!(solution.status, Status::Solved);
    assert!((solution.v[0] - 2.0).abs() < 1e-6, "{:?}", solution.v);
}

/// Minimise x subject to nothing.
#[test]
fn an_unbounded_program_is_recognised() {
    let values: Values = |x, _| x[0] + 0.5 * x[1] * x[1];
    let slopes: Slopes = |x, g, _| g.copy_from_slice(&[1.0, x[1]]);
    let curvature: Curvature = |_, w, _, h| h.copy_from_slice(&[0.0, 0.0, w]);
    let solution = Dense::new(vec![Bounds::FREE; 2], Vec::new(), (values, slopes, curvature))
        .solve(&[0.0, 1.0]);
    assert_eq!(solution.status, Status::Unbounded);
}

/// Minimise sqrt(x - 1) from x = 0.
#[test]
fn a_start_where_a_function_is_not_finite_is_reported() {
    let values: Values = |x, _| (x[0] - 1.0).sqrt();
    let slopes: Slopes = |x, g, _| g[0] = 0.5 / (x[0] - 1.0).sqrt();
    let curvature: Curvature = |x, w, _, h| h[0] = -0.25 * w * (x[0] - 1.0).powf(-1.5);
    let solution =
        Dense::new(vec![Bounds::FREE], Vec::new(), (values, slopes, curvature)).solve(&[0.0]);
    assert!(matches!(solution.status, Status::NotFinite(_)));
}

/// Nocedal & Wright, example 15.4 (Powell): minimise 2 (x^2 + y^2 - 1) - x on the unit circle. From
/// a point of the circle the whole Newton step raises both the objective and the violation (the
/// Maratos effect), however near the solution (1, 0) is.
#[test]
fn whole_steps_are_taken_along_a_curved_row() {
    let values: Values = |x, rows| {
        rows[0] = x[0] * x[0] + x[1] * x[1];
        2.0 * (rows[0] - 1.0) - x[0]
    };
    let slopes: Slopes = |x, g, j| {
        g.copy_from_slice(&[4.0 * x[0] - 1.0, 4.0 * x[1]]);
        j.copy_from_slice(&[2.0 * x[0], 2.0 * x[1]]);
    };
    let curvature: Curvature =
        |_, w, l, h| h.copy_from_slice(&[4.0 * w + 2.0 * l[0], 0.0, 4.0 * w + 2.0 * l[0]]);
    let circle =
        || Dense::new(vec![Bounds::FREE; 2], vec![Bounds::fixed(1.0)], (values, slopes, curvature));
    for angle in [1.0f64, 0.1, 0.01] {
        let solution = circle().solve(&[angle.cos(), angle.sin()]);
        assert_eq!(solution.status, Status::Solved);
        assert!(
            (solution.v[0] - 1.0).abs() < 1e-6 && solution.counts.iterations <= 12,
            "{solution:?}"
        );
    }
}

/// Far from convex where nothing holds, but not where x + y = 1: minimise x y (-1/2 (x - y)^2 + 1/2
/// on the line is concave along it, so the bounds decide). With x, y in [0, 1] the minimum 0 is at
/// either end.
#[test]
fn a_concave_objective_ends_at_a_bound() {
    let values: Values = |x, rows| {
        rows[0] = x[0] + x[1];
        x[0] * x[1]
    };
    let slopes: Slopes = |x, g, j| {
        g.copy_from_slice(&[x[1], x[0]]);
        j.copy_from_slice(&[1.0, 1.0]);
    };
    let curvature: Curvature = |_, w, _, h| h.copy_from_slice(&[0.0, w, 0.0]);
    let line = Dense::new(
        vec![between(0.0, 1.0); 2],
        vec![Bounds::fixed(1.0)],
        (values, slopes, curvature),
    );
    // The objective is 0 where x or y is, and so are its terms: what is left of them is not small
    // beside that.
    let solution = line.solve(&[0.7, 0.3]);
    assert!(solution.status.is_solved(), "{solution:?}");
    assert!(solution.objective.abs() < 1e-7, "{solution:?}");
}
