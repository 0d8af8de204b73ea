//! One step of a Runge-Kutta method as a linear map, `S+ = Phi S + Gamma W`, and its transpose.
//!
//! The derivative of the stages that were computed, not of the solution (H. G. Bock's internal
//! differentiation), so forward and adjoint differ by rounding only. With `A_i = f*_x` and `G_i =
//! f*_(U,p)` at stage `i`
//!
//! ```text
//! Y_i = S + h sum_j a_ij K_j,    K_j = A_j Y_j + g_j,    g_j = G_j W,    S+ = S + h sum_j b_j K_j
//! mu_j = A_j^T kappa_j,    kappa_j = h (b_j lambda+ + sum_i a_ij mu_i) = dJ/dg_j,
//! lambda = lambda+ + sum_j mu_j
//! ```
//!
//! Where the method is implicit, the `Y_i` are the solution of one linear system with the blocks `I
//! - h a_ij A_j`, and the `mu_j` that of its transpose.

use super::linearisation::{Linearisation, Lineariser};
use crate::simulate::{Instant, Regime, Rule};
use crate::simulate::{departure, dormand_prince, radau};
use nalgebra::{DMatrix, DVector, Dyn, LU};
use std::sync::LazyLock;

/// Newton's steps for the stages of an implicit method.
const MOST_ITERATIONS: usize = 20;

/// Nodes and weights of the stages that enter the end of a step; none for a straight line, which is
/// shorter than rounding.
struct Tableau {
    c: Vec<f64>,
    a: Vec<Vec<f64>>,
    b: Vec<f64>,
}

static EXPLICIT: LazyLock<Tableau> =
    LazyLock::new(|| Tableau::new(&dormand_prince::C, dormand_prince::A));
static RADAU: LazyLock<Tableau> = LazyLock::new(|| Tableau::new(radau::C, radau::A));
static COLLOCATION: LazyLock<Tableau> = LazyLock::new(|| {
    let weights = departure::weights(departure::FINE);
    Tableau::new(
        departure::FINE,
        weights.row_iter().map(|row| row.iter().copied().collect::<Vec<_>>()),
    )
});
static STRAIGHT: LazyLock<Tableau> = LazyLock::new(|| Tableau::new(&[], [[0.0; 0]; 0]));

impl Tableau {
    fn of(rule: Rule) -> &'static Self {
        match rule {
            Rule::Explicit => &EXPLICIT,
            Rule::Radau => &RADAU,
            Rule::Collocation => &COLLOCATION,
            Rule::Straight => &STRAIGHT,
        }
    }

    /// In all methods the last row of weights is that of the end.
    fn new<R: AsRef<[f64]>>(c: &[f64], rows: impl IntoIterator<Item = R>) -> Self {
        let mut a: Vec<Vec<f64>> = rows.into_iter().map(|row| row.as_ref().to_vec()).collect();
        let b = a.last().cloned().unwrap_or_default();
        a.truncate(b.len());
        Tableau { c: c[..b.len()].to_vec(), a, b }
    }
}

/// A step, linearised.
pub(crate) struct LinearStep {
    tableau: &'static Tableau,
    h: f64,
    /// The right side at the stages.
    pub stages: Vec<Linearisation>,
    /// Where the stages are.
    pub points: Vec<(f64, DVector<f64>)>,
    /// `I - h a_ij A_i` of an implicit method.
    implicit: Option<LU<f64, Dyn, Dyn>>,
    /// How many of `(U, p)` there are.
    inputs: usize,
}

impl LinearStep {
    /// Takes the step again.
    pub fn new(
        lineariser: &Lineariser,
        regime: &Regime,
        start: &Instant,
        h: f64,
        stages: &[Vec<f64>],
        rule: Rule,
    ) -> Self {
        let mut step = LinearStep {
            tableau: Tableau::of(rule),
            h,
            stages: Vec::new(),
            points: Vec::new(),
            implicit: None,
            inputs: lineariser.inputs(regime),
        };
        match rule {
            Rule::Explicit | Rule::Straight => step.take_explicit(lineariser, regime, start),
            Rule::Radau | Rule::Collocation => {
                step.take_implicit(lineariser, regime, start, stages)
            }
        }
        step
    }

    fn take_explicit(&mut self, lineariser: &Lineariser, regime: &Regime, start: &Instant) {
        let x = DVector::from_column_slice(&start.state);
        for stage in 0..self.tableau.c.len() {
            let mut at = x.clone();
            for (weight, before) in self.tableau.a[stage].iter().zip(&self.stages) {
                at.axpy(self.h * weight, &before.rate, 1.0);
            }
            let near = self.stages.last().map_or(&start.selectors, |last| &last.selectors);
            let time = start.time + self.tableau.c[stage] * self.h;
            let point = lineariser.at(regime, near, time, &at);
            self.stages.push(point);
            self.points.push((time, at));
        }
    }

    /// Newton's method from the stages that are known, with the exact Jacobian of each.
    fn take_implicit(
        &mut self,
        lineariser: &Lineariser,
        regime: &Regime,
        start: &Instant,
        stages: &[Vec<f64>],
    ) {
        let x = DVector::from_column_slice(&start.state);
        let times = self.tableau.c.iter().map(|c| start.time + c * self.h);
        self.points =
            times.zip(stages.iter().map(|stage| DVector::from_column_slice(stage))).collect();
        for _ in 0..MOST_ITERATIONS {
            let evaluate = |(time, at): &(f64, DVector<f64>)| {
                lineariser.at(regime, &start.selectors, *time, at)
            };
            self.stages = self.points.iter().map(evaluate).collect();
            let system = self.system().lu();
            let change = system.solve(&self.defect(&x));
            self.implicit = Some(system);
            let Some(change) = change.filter(|it| it.amax() > 1e-14 * (1.0 + x.amax())) else {
                return;
            };
            for (stage, point) in self.points.iter_mut().enumerate() {
                point.1 -= change.rows(stage * x.len(), x.len());
            }
        }
    }

    /// `x_i - x - h sum_j a_ij f_j`.
    fn defect(&self, x: &DVector<f64>) -> DVector<f64> {
        let mut defect = DVector::zeros(self.points.len() * x.len());
        for (stage, (_, at)) in self.points.iter().enumerate() {
            let mut own = at - x;
            for (weight, point) in self.tableau.a[stage].iter().zip(&self.stages) {
                own.axpy(-self.h * weight, &point.rate, 1.0);
            }
            defect.rows_mut(stage * x.len(), x.len()).copy_from(&own);
        }
        defect
    }

    /// The blocks `I - h a_ij A_j`.
    fn system(&self) -> DMatrix<f64> {
        let (n, count) = (self.points[0].1.len(), self.stages.len());
        let mut system = DMatrix::identity(n * count, n * count);
        for (i, row) in self.tableau.a.iter().enumerate() {
            for (j, point) in self.stages.iter().enumerate() {
                let mut block = system.view_mut((i * n, j * n), (n, n));
                block -= point.by_state() * (self.h * row[j]);
            }
        }
        system
    }

    /// `G_j W`.
    pub fn forcing(&self, w: &DMatrix<f64>) -> Vec<DMatrix<f64>> {
        self.stages.iter().map(|point| point.by_inputs() * w).collect()
    }

    /// The derivatives of the stages, then that of the end, from those of the start and what acts
    /// at the stages.
    pub fn forward(
        &self,
        s: &DMatrix<f64>,
        forcing: &[DMatrix<f64>],
    ) -> (Vec<DMatrix<f64>>, DMatrix<f64>) {
        let at_stages = match &self.implicit {
            None => self.stages_in_order(s, forcing),
            Some(system) => self.stages_at_once(s, forcing, system),
        };
        let slopes: Vec<DMatrix<f64>> = self.slopes(&at_stages, forcing);
        let end = self.combined(s, &slopes, &self.tableau.b);
        (at_stages, end)
    }

    fn slopes(&self, at_stages: &[DMatrix<f64>], forcing: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
        let slope = |j: usize| self.stages[j].by_state() * &at_stages[j] + &forcing[j];
        (0..at_stages.len()).map(slope).collect()
    }

    fn stages_in_order(&self, s: &DMatrix<f64>, forcing: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
        let mut slopes: Vec<DMatrix<f64>> = Vec::with_capacity(forcing.len());
        let mut at_stages: Vec<DMatrix<f64>> = Vec::with_capacity(forcing.len());
        for (stage, point) in self.stages.iter().enumerate() {
            let at = self.combined(s, &slopes, &self.tableau.a[stage]);
            slopes.push(point.by_state() * &at + &forcing[stage]);
            at_stages.push(at);
        }
        at_stages
    }

    fn stages_at_once(
        &self,
        s: &DMatrix<f64>,
        forcing: &[DMatrix<f64>],
        system: &LU<f64, Dyn, Dyn>,
    ) -> Vec<DMatrix<f64>> {
        let (n, count) = (s.nrows(), self.stages.len());
        let mut right = DMatrix::zeros(n * count, s.ncols());
        for stage in 0..count {
            let own = self.combined(s, forcing, &self.tableau.a[stage]);
            right.rows_mut(stage * n, n).copy_from(&own);
        }
        system.solve_mut(&mut right);
        (0..count).map(|stage| right.rows(stage * n, n).into_owned()).collect()
    }

    /// `S + h sum_j a_j K_j`.
    fn combined(&self, s: &DMatrix<f64>, slopes: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
        let mut sum = s.clone();
        for (weight, slope) in weights.iter().zip(slopes).filter(|(weight, _)| **weight != 0.0) {
            sum.zip_apply(slope, |sum, slope| *sum += self.h * weight * slope);
        }
        sum
    }

    /// The adjoint before the step and the derivative by `(U, p)`.
    pub fn adjoint(&self, after: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let mut pulled = match &self.implicit {
            None => vec![DVector::zeros(0); self.stages.len()],
            Some(system) => self.pulled_at_once(after, system),
        };
        let (mut before, mut inputs) = (after.clone(), DVector::zeros(self.inputs));
        for (stage, point) in self.stages.iter().enumerate().rev() {
            let kappa = self.kappa(after, &pulled, stage);
            if self.implicit.is_none() {
                pulled[stage] = point.by_state().tr_mul(&kappa);
            }
            before += &pulled[stage];
            inputs.gemv_tr(1.0, &point.by_inputs(), &kappa, 1.0);
        }
        (before, inputs)
    }

    /// `kappa_j`, from the `mu_i` that are known.
    fn kappa(&self, after: &DVector<f64>, pulled: &[DVector<f64>], stage: usize) -> DVector<f64> {
        let mut kappa = after * (self.h * self.tableau.b[stage]);
        for (row, mu) in self.tableau.a.iter().zip(pulled).filter(|(row, _)| row[stage] != 0.0) {
            kappa.axpy(self.h * row[stage], mu, 1.0);
        }
        kappa
    }

    fn pulled_at_once(
        &self,
        after: &DVector<f64>,
        system: &LU<f64, Dyn, Dyn>,
    ) -> Vec<DVector<f64>> {
        let n = after.len();
        let mut right = DVector::zeros(n * self.stages.len());
        for (stage, point) in self.stages.iter().enumerate() {
            let own = point.by_state().tr_mul(after) * (self.h * self.tableau.b[stage]);
            right.rows_mut(stage * n, n).copy_from(&own);
        }
        solve_transposed(system, &mut right);
        (0..self.stages.len()).map(|stage| right.rows(stage * n, n).into_owned()).collect()
    }
}

/// With `P M = L U` the transposed system is `U^T L^T P mu = right`.
fn solve_transposed(system: &LU<f64, Dyn, Dyn>, right: &mut DVector<f64>) {
    system.u().tr_solve_upper_triangular_mut(right);
    system.l().tr_solve_lower_triangular_mut(right);
    system.p().inv_permute_rows(right);
}
