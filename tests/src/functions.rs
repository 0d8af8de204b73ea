//! Checks that any compiled function must pass, whatever it was compiled from.

use fdcc_compiler::differentiate::Differentiated;
use fdcc_compiler::graph::{ExprId, Graph, evaluate};
use fdcc_runtime::problem::{Columns, Function, Layout};

/// All results of one function on one grid.
pub struct Results {
    /// Outputs.
    pub values: Columns,
    /// Entries of the Jacobian.
    pub jacobian: Columns,
    /// Entries of the Hessian.
    pub hessian: Columns,
}

/// Calls the function for everything it can compute.
pub fn derivatives(
    function: &dyn Function,
    points: &Columns,
    parameters: &[f64],
    multipliers: &Columns,
) -> Results {
    let count = points.count();
    let mut values = Columns::new(function.outputs(), count);
    let mut jacobian = Columns::new(function.jacobian_pattern().entries.len(), count);
    let mut hessian = Columns::new(function.hessian_pattern().entries.len(), count);
    function.derivatives(points, parameters, multipliers, &mut values, &mut jacobian, &mut hessian);
    Results { values, jacobian, hessian }
}

/// The input `z` of a function at one point.
pub fn input(layout: &Layout, points: &Columns, parameters: &[f64], point: usize) -> Vec<f64> {
    let at = |column: usize| points.column(column)[point];
    let start = layout.parameters().start;
    let before = (0..start).map(at);
    let after = (start..layout.point_inputs()).map(at);
    before.chain(parameters.iter().copied()).chain(after).collect()
}

/// Machine code computes what the interpreter computes, to `tolerance` relative to the largest
/// number on the way; before there is any, the same steps give the same bits.
pub fn check_machine_code(
    graph: &Graph,
    symbols: &Differentiated,
    function: &dyn Function,
    points: &Columns,
    parameters: &[f64],
    multipliers: &Columns,
    tolerance: f64,
) -> Result<(), String> {
    let by_steps = derivatives(function, points, parameters, multipliers);
    check_orders_agree(function, points, parameters, &by_steps)?;
    (0..3).for_each(|order| function.prepare(order));
    let results = derivatives(function, points, parameters, multipliers);
    check_same_bits(&by_steps, &results)?;
    check_orders_agree(function, points, parameters, &results)?;
    for point in 0..points.count() {
        let z = input(&symbols.function.layout, points, parameters, point);
        let weights: Vec<f64> =
            (0..multipliers.columns()).map(|i| multipliers.column(i)[point]).collect();
        for (what, roots, table) in [
            ("value", &symbols.function.outputs, &results.values),
            ("jacobian", &symbols.jacobian.1, &results.jacobian),
            ("hessian", &symbols.hessian.1, &results.hessian),
        ] {
            let expected = evaluate(graph, roots, &z, &weights);
            for (index, &expected) in expected.iter().enumerate() {
                let got = table.column(index)[point];
                let scale = magnitude(graph, roots[index], &z, &weights);
                if !close(got, expected, tolerance * scale) {
                    return Err(format!(
                        "{what} {index} at {z:?}: expected {expected:e}, got {got:e}"
                    ));
                }
            }
        }
    }
    Ok(())
}

fn check_same_bits(by_steps: &Results, by_code: &Results) -> Result<(), String> {
    for (what, steps, code) in [
        ("value", &by_steps.values, &by_code.values),
        ("jacobian", &by_steps.jacobian, &by_code.jacobian),
        ("hessian", &by_steps.hessian, &by_code.hessian),
    ] {
        for column in 0..steps.columns() {
            let same =
                |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
            let (steps, code) = (steps.column(column), code.column(column));
            if !steps.iter().zip(code).all(same) {
                return Err(format!(
                    "{what} {column}: {steps:?} step by step, {code:?} by machine code"
                ));
            }
        }
    }
    Ok(())
}

fn check_orders_agree(
    function: &dyn Function,
    points: &Columns,
    parameters: &[f64],
    all: &Results,
) -> Result<(), String> {
    let same = |a: &Columns, b: &Columns| {
        (0..a.columns()).all(|i| {
            a.column(i).iter().zip(b.column(i)).all(|(a, b)| close(*a, *b, 1e-14 * a.abs()))
        })
    };
    let mut values = Columns::new(function.outputs(), points.count());
    let mut jacobian = Columns::new(function.jacobian_pattern().entries.len(), points.count());
    function.value(points, parameters, &mut values);
    if !same(&values, &all.values) {
        return Err("`value` differs from `derivatives`".into());
    }
    function.jacobian(points, parameters, &mut values, &mut jacobian);
    if !same(&values, &all.values) || !same(&jacobian, &all.jacobian) {
        return Err("`jacobian` differs from `derivatives`".into());
    }
    Ok(())
}

/// The largest finite number that the interpreter meets, at least its own result.
fn magnitude(graph: &Graph, root: ExprId, z: &[f64], weights: &[f64]) -> f64 {
    let all = graph.reachable(&[root]);
    let values = evaluate(graph, &all, z, weights);
    values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold(0.0, |largest, value| value.abs().max(largest))
}

fn close(got: f64, expected: f64, tolerance: f64) -> bool {
    (got - expected).abs() <= tolerance || got == expected || (got.is_nan() && expected.is_nan())
}

/// Jacobian and Hessian agree with differences of the values and of the Jacobian, in and outside
/// the patterns.
///
/// `by` are the inputs that the function was differentiated by.
pub fn check_differences(
    function: &dyn Function,
    by: &[u32],
    points: &Columns,
    parameters: &[f64],
    multipliers: &Columns,
    tolerance: f64,
) -> Result<(), String> {
    let exact = derivatives(function, points, parameters, multipliers);
    for &input in by {
        let values = Difference::new(function, points, parameters, input, |grid, parameters| {
            derivatives(function, grid, parameters, multipliers).values
        });
        for row in 0..function.outputs() {
            let entry = position(&function.jacobian_pattern().entries, (row as u32, input));
            let got = entry.map(|entry| exact.jacobian.column(entry));
            values
                .check(row, got, tolerance)
                .map_err(|error| format!("d output {row} / d z{input}: {error}"))?;
        }
        let gradients = Difference::new(function, points, parameters, input, |grid, parameters| {
            gradient(function, grid, parameters, multipliers)
        });
        for &row in by.iter().filter(|&&row| row >= input) {
            let entry = position(&function.hessian_pattern().entries, (row, input));
            let got = entry.map(|entry| exact.hessian.column(entry));
            gradients
                .check(row as usize, got, tolerance)
                .map_err(|error| format!("d2 lagrangian / d z{row} d z{input}: {error}"))?;
        }
    }
    Ok(())
}

fn position(entries: &[(u32, u32)], entry: (u32, u32)) -> Option<usize> {
    entries.iter().position(|&other| other == entry)
}

/// Multipliers times Jacobian: one column for each input.
fn gradient(
    function: &dyn Function,
    points: &Columns,
    parameters: &[f64],
    multipliers: &Columns,
) -> Columns {
    let jacobian = derivatives(function, points, parameters, multipliers).jacobian;
    let mut gradient = Columns::new(function.layout().inputs(), points.count());
    for (entry, &(row, column)) in function.jacobian_pattern().entries.iter().enumerate() {
        for point in 0..points.count() {
            gradient.column_mut(column as usize)[point] +=
                multipliers.column(row as usize)[point] * jacobian.column(entry)[point];
        }
    }
    gradient
}

/// Central differences with two steps and their extrapolation: the error is of fourth order in the
/// step.
struct Difference {
    tables: [Columns; 4],
}

const STEP: f64 = 1.0 / 1024.0;

impl Difference {
    fn new(
        function: &dyn Function,
        points: &Columns,
        parameters: &[f64],
        input: u32,
        compute: impl Fn(&Columns, &[f64]) -> Columns,
    ) -> Self {
        let tables = [-STEP, STEP, -STEP / 2.0, STEP / 2.0].map(|step| {
            let (mut points, mut parameters) = (points.clone(), parameters.to_vec());
            shift(function.layout(), &mut points, &mut parameters, input as usize, step);
            compute(&points, &parameters)
        });
        Difference { tables }
    }

    /// `exact` is none for what is not in the pattern: then the difference must vanish.
    fn check(&self, column: usize, exact: Option<&[f64]>, tolerance: f64) -> Result<(), String> {
        for point in 0..self.tables[0].count() {
            let [a, b, c, d] = [0, 1, 2, 3].map(|table| self.tables[table].column(column)[point]);
            let (coarse, fine) = ((b - a) / (2.0 * STEP), (d - c) / STEP);
            let difference = (4.0 * fine - coarse) / 3.0;
            let got = exact.map_or(0.0, |exact| exact[point]);
            let scale = 1.0 + difference.abs() + a.abs();
            if (got - difference).abs() > tolerance * scale || got.is_nan() {
                return Err(format!("point {point}: difference {difference:e}, got {got:e}"));
            }
        }
        Ok(())
    }
}

fn shift(layout: &Layout, points: &mut Columns, parameters: &mut [f64], input: usize, step: f64) {
    let range = layout.parameters();
    if range.contains(&input) {
        parameters[input - range.start] += step;
    } else {
        let column = if input < range.start { input } else { input - range.len() };
        points.column_mut(column).iter_mut().for_each(|value| *value += step);
    }
}
