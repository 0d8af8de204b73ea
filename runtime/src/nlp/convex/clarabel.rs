//! The only file that names the crate `clarabel`: its conic solver, behind our own types.

use crate::linalg::Columns;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolution, DefaultSolver, IPSolver, SolverStatus, SupportedConeT,
};
use std::ffi::{c_int, c_void};

/// `minimize 1/2 x'Px + q'x` subject to `Ax + s = b`, the first `equalities` entries of `s` zero,
/// the others `>= 0`.
pub(crate) struct ConicProgram {
    /// Upper triangle.
    pub(crate) p: Columns,
    pub(crate) q: Vec<f64>,
    pub(crate) a: Columns,
    pub(crate) b: Vec<f64>,
    pub(crate) equalities: usize,
}

/// How the conic solver ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ConicStatus {
    Solved,
    /// To a few digits only.
    Roughly,
    Infeasible,
    Unbounded,
    IterationLimit,
    /// It was asked to.
    Stopped,
    Failed,
}

/// Its answer: `x`, the multipliers `z` of `Ax + s = b`, and the number of iterations.
pub(crate) struct ConicSolution {
    pub(crate) status: ConicStatus,
    pub(crate) x: Vec<f64>,
    pub(crate) z: Vec<f64>,
    pub(crate) iterations: usize,
}

/// Asked after each iteration whether to stop.
pub(crate) type Ask<'a> = dyn FnMut() -> bool + 'a;

/// Solves a convex quadratic program.
pub(crate) fn solve_conic(
    program: ConicProgram,
    tolerance: f64,
    max_iterations: usize,
    ask: &mut Ask,
) -> ConicSolution {
    let ConicProgram { p, q, a, b, equalities } = program;
    let cones = [
        SupportedConeT::ZeroConeT(equalities),
        SupportedConeT::NonnegativeConeT(b.len() - equalities),
    ];
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_iter(max_iterations.min(u32::MAX as usize) as u32)
        .tol_gap_abs(tolerance)
        .tol_gap_rel(tolerance)
        .tol_feas(tolerance)
        .build();
    let solver = settings.ok().and_then(|settings| {
        DefaultSolver::new(&to_csc(p), &q, &to_csc(a), &b, &cones, settings).ok()
    });
    let Some(mut solver) = solver else {
        let (x, z) = (vec![0.0; q.len()], vec![0.0; b.len()]);
        return ConicSolution { status: ConicStatus::Failed, x, z, iterations: 0 };
    };
    let mut ask = ask;
    solver.set_termination_callback_c(stops, (&raw mut ask).cast());
    solver.solve();
    let DefaultSolution { status, x, z, iterations, .. } = solver.solution;
    ConicSolution { status: in_our_words(status), x, z, iterations: iterations as usize }
}

fn to_csc(matrix: Columns) -> CscMatrix<f64> {
    let columns = matrix.column_starts.len() - 1;
    let Columns { rows, column_starts, row_indices, values } = matrix;
    CscMatrix::new(rows, columns, column_starts, row_indices, values)
}

/// The conic solver calls closures that live for ever only, and this.
#[expect(unsafe_code, reason = "the data of a callback of C has no type")]
extern "C" fn stops<I>(_: *const I, ask: *mut c_void) -> c_int {
    // SAFETY: `solve_conic` hands over a pointer to its own `&mut Ask`, which outlives the solve
    // and is used by nobody else meanwhile.
    let ask = unsafe { &mut *ask.cast::<&mut Ask>() };
    c_int::from(ask())
}

fn in_our_words(status: SolverStatus) -> ConicStatus {
    match status {
        SolverStatus::Solved => ConicStatus::Solved,
        SolverStatus::AlmostSolved => ConicStatus::Roughly,
        SolverStatus::PrimalInfeasible => ConicStatus::Infeasible,
        SolverStatus::DualInfeasible => ConicStatus::Unbounded,
        SolverStatus::MaxIterations => ConicStatus::IterationLimit,
        SolverStatus::CallbackTerminated => ConicStatus::Stopped,
        _ => ConicStatus::Failed,
    }
}
