//! One factorisation and one solve of the optimality conditions, in the sizes of the race car: 5
//! states, 2 controls, a free final time, one path constraint.

use divan::Bencher;
use fdcc_runtime::linalg::riccati::Riccati;
use fdcc_runtime::linalg::sparse_ldl::SparseLdl;
use fdcc_runtime::linalg::{Factor, Family, Inertia, Stages, Triplets};

/// Shows that neither allocates.
#[global_allocator]
static ALLOCATIONS: divan::AllocProfiler = divan::AllocProfiler::system();

fn main() {
    divan::main();
}

struct Case {
    stages: Stages,
    hessian: Triplets,
    jacobian: Triplets,
    hessian_values: Vec<f64>,
    jacobian_values: Vec<f64>,
    sigma: Vec<f64>,
    d: Vec<f64>,
}

fn case(intervals: usize) -> Case {
    let stages = Stages {
        intervals,
        states: 5,
        controls: 2,
        inner: 0,
        globals: 1,
        local_constraints: 1,
        coupling_constraints: 0,
    };
    let (step, rows, t) = (7, 6, stages.globals().start);
    let family = |row, column, row_step, column_step| Family {
        row,
        column,
        row_step,
        column_step,
        count: intervals,
    };
    let mut jacobian = Vec::new();
    for row in 0..5 {
        jacobian.push(family(row, row, rows, step));
        jacobian.push(family(row, step + row, rows, step));
        jacobian.push(family(row, t, rows, 0));
        jacobian.push(family(row, step + 2, rows, step));
        jacobian.push(family(row, 5 + row % 2, rows, step));
    }
    jacobian.push(family(5, step, rows, step));
    jacobian.push(family(5, step + 1, rows, step));
    let mut hessian: Vec<Family> = (0..7).map(|i| family(i, i, step, step)).collect();
    hessian.extend([(4, 5), (4, 6)].map(|(a, b)| family(b, a, step, step)));
    hessian.extend([
        family(step + 3, step + 2, step, step),
        family(t, step + 2, 0, step),
        family(step + 2, 4, step, step),
    ]);
    let (jacobian, hessian) = (Triplets { families: jacobian }, Triplets { families: hessian });
    let wave = |i: usize| ((i * 7919) % 1000) as f64 / 1000.0 - 0.5;
    let jacobian_values = jacobian.entries().enumerate().map(|(i, (r, c))| {
        let (k, i0) = (r / rows, r % rows);
        if c == (k + 1) * step + i0 {
            1.0
        } else if c == k * step + i0 {
            -1.0
        } else {
            0.01 * wave(i)
        }
    });
    let jacobian_values = jacobian_values.collect();
    let hessian_values = (0..hessian.len()).map(|i| 1e-3 * wave(i)).collect();
    let d = (0..stages.rows()).map(|row| if row % rows == 5 { 10.0 } else { 0.0 }).collect();
    Case {
        sigma: vec![1.0; stages.variables()],
        stages,
        hessian,
        jacobian,
        hessian_values,
        jacobian_values,
        d,
    }
}

fn run(bencher: Bencher, case: &Case, factor: &mut dyn Factor) {
    let right = vec![1.0; case.stages.variables() + case.stages.rows()];
    let mut x = right.clone();
    bencher.bench_local(|| {
        let inertia =
            factor.factor(&case.hessian_values, &case.jacobian_values, &case.sigma, &case.d);
        assert_eq!(inertia, Inertia::Correct);
        x.copy_from_slice(&right);
        factor.solve(&mut x);
        x[0]
    });
}

#[divan::bench(args = [1000, 4000])]
fn riccati(bencher: Bencher, intervals: usize) {
    let case = case(intervals);
    let (fixed, equality) =
        (vec![false; case.sigma.len()], case.d.iter().map(|d| *d == 0.0).collect::<Vec<_>>());
    let mut factor = Riccati::new(case.stages, &case.hessian, &case.jacobian, &fixed, &equality)
        .expect("a chain");
    run(bencher, &case, &mut factor);
}

#[divan::bench(args = [1000, 4000])]
fn sparse_ldl(bencher: Bencher, intervals: usize) {
    let case = case(intervals);
    let fixed = vec![false; case.sigma.len()];
    run(
        bencher,
        &case,
        &mut SparseLdl::new(&case.hessian, &case.jacobian, &fixed, case.stages.rows()),
    );
}
