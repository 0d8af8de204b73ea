//! One step: an explicit part, and a mixed complementarity problem for the end and the selectors of
//! the implicit part.
//!
//! ```text
//! F(x+, s) = x+ - x - h [b0 f(t, x, s0) + b f(t + c h, z, s)] = 0,    s in Sgn(psi(t + c h, z))
//! ```
//!
//! Newton's method with the inclusion kept as it is: with `d = -F_x^-1 F` and `D = -F_x^-1 F_s` the
//! end moves by `d + D (s' - s)`, the switching functions by `psi_x w` times that, and the new
//! selectors `s'` solve a linear complementarity problem. Steps are shortened until `F` shrinks;
//! where it cannot, because only the selectors were wrong, they are not.

use super::field::{Field, Point};
use super::linearised::Linearised;
use super::rule::Grid;
use super::run::Failure;
use crate::simulate::selectors;
use crate::transcribe::tableau::Node;
use nalgebra::DVector;

const MOST_ITERATIONS: usize = 100;

/// A change of the end and an error of `F` below this part of the end are the last: what is left
/// after it is their square. Selectors are not asked, because they may be many for one end.
const LAST_CHANGE: f64 = 1e-10;

/// Selectors closer to 1 than this are 1.
const SIDE: f64 = 1e-12;

/// A step with all that it was computed from.
pub(super) struct FixedStep {
    pub index: usize,
    pub h: f64,
    /// What the explicit part was evaluated at.
    pub old: Point,
    /// Selectors of the explicit part that the step before determined.
    pub carried: Vec<bool>,
    /// What the implicit part was evaluated at.
    pub new: Point,
    /// Selectors of the implicit part that keep their switching functions at 0.
    pub free: Vec<usize>,
    pub end: DVector<f64>,
}

impl FixedStep {
    /// The step with an index from a state; `before` is the step that ended there.
    pub fn take(
        field: &Field,
        grid: &Grid,
        index: usize,
        x: DVector<f64>,
        before: Option<&FixedStep>,
    ) -> Result<Self, Failure> {
        let surfaces = field.system.surfaces.len();
        let is_carried = |i| before.is_some_and(|step| step.free.contains(&i));
        let carried: Vec<bool> = (0..surfaces).map(is_carried).collect();
        let s = before.map_or(DVector::zeros(surfaces), |step| step.new.s.clone());
        let u = field.control(grid.middle(index));
        let mut old = Point { t: field.time(grid.tau(index, 0.0)), x, u, s };
        let h = field.duration / grid.count() as f64;
        let mut fixed = old.x.clone();
        if let Some(weight) = grid.explicit {
            old.s = explicit_selectors(field, &old, &carried);
            fixed += h * weight * field.rate(&old);
            finite(field, &old, &fixed)?;
        }
        let (new, end) = match &grid.implicit {
            None => (old.clone(), fixed),
            Some(node) => {
                let t = field.time(grid.tau(index, node.time));
                Implicit { field, node, h, t, old: &old, fixed: &fixed, index }.solve()?
            }
        };
        let is_free = |i: &usize| grid.implicit.is_some() && new.s[*i].abs() < 1.0;
        let free = (0..surfaces).filter(is_free).collect();
        Ok(FixedStep { index, h, old, carried, new, free, end })
    }
}

/// On a surface the selector that the step before ended with (0 before the first), else the side.
fn explicit_selectors(field: &Field, old: &Point, carried: &[bool]) -> DVector<f64> {
    let psi = field.psi(old);
    DVector::from_fn(carried.len(), |i, _| {
        if carried[i] || psi[i] == 0.0 { old.s[i] } else { psi[i].signum() }
    })
}

/// Blames the first component that has no value.
fn finite(field: &Field, at: &Point, values: &DVector<f64>) -> Result<(), Failure> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(row) => Err(Failure::NotFinite { time: at.t, origin: field.system.flow.origin(row) }),
        None => Ok(()),
    }
}

/// The implicit part of a step.
struct Implicit<'s> {
    field: &'s Field<'s>,
    node: &'s Node,
    h: f64,
    t: f64,
    old: &'s Point,
    /// The old state after the explicit part.
    fixed: &'s DVector<f64>,
    index: usize,
}

/// How far a Newton step goes.
struct Change {
    x: DVector<f64>,
    s: DVector<f64>,
    /// The size of `F` before it.
    residual: f64,
}

impl Implicit<'_> {
    /// What the right side is evaluated at, and the end.
    fn solve(&self) -> Result<(Point, DVector<f64>), Failure> {
        let (mut x, mut s) = (self.old.x.clone(), self.old.s.clone());
        for _ in 0..MOST_ITERATIONS {
            let change = self.change(&x, &s)?;
            let is_last = relative(&change.x, &x).max(change.residual) <= LAST_CHANGE;
            let part = if is_last { 1.0 } else { self.damping(&x, &s, &change) };
            x += part * change.x;
            s += part * change.s;
            if is_last {
                s.apply(|s| *s = if s.abs() > 1.0 - SIDE { s.signum() } else { *s });
                return Ok((self.point(&x, &s), x));
            }
        }
        Err(Failure::NotConverged { step: self.index, time: self.t })
    }

    fn point(&self, end: &DVector<f64>, s: &DVector<f64>) -> Point {
        let (x, w) = (&self.old.x, &self.node.blend);
        let x = DVector::from_fn(x.len(), |i, _| (1.0 - w[i]) * x[i] + w[i] * end[i]);
        Point { t: self.t, x, u: self.old.u.clone(), s: s.clone() }
    }

    /// One linear complementarity problem.
    fn change(&self, x: &DVector<f64>, s: &DVector<f64>) -> Result<Change, Failure> {
        let point = self.point(x, s);
        let local = Linearised::new(self.field, self.node, self.h, &point);
        let residual = x - self.fixed - local.weight * &local.flow.values;
        finite(self.field, &point, &residual)?;
        let singular = || Failure::Singular { step: self.index, time: self.t };
        let inverse = local.by_end.lu();
        let plain = -inverse.solve(&residual).ok_or_else(singular)?;
        let along = -inverse.solve(&local.by_selectors).ok_or_else(singular)?;
        let a = local.switching.values + &local.normals * (&plain - &along * s);
        let turned = selectors(&a, &-(&local.normals * &along)).ok_or_else(singular)? - s;
        Ok(Change { x: plain + along * &turned, s: turned, residual: relative(&residual, x) })
    }

    /// The largest of 1, 1/2, 1/4 ... that makes `F` smaller; 1 if none does.
    fn damping(&self, x: &DVector<f64>, s: &DVector<f64>, change: &Change) -> f64 {
        let residual = |part: f64| {
            let (x, s) = (x + part * &change.x, s + part * &change.s);
            let rate = self.field.rate(&self.point(&x, &s));
            relative(&(&x - self.fixed - self.h * self.node.weight * rate), &x)
        };
        let parts = (0..24).map(|halvings| 0.5_f64.powi(halvings));
        parts.into_iter().find(|&part| residual(part) < change.residual).unwrap_or(1.0)
    }
}

/// The largest component in units of what it changes.
fn relative(change: &DVector<f64>, x: &DVector<f64>) -> f64 {
    let part = change.iter().zip(x.iter()).map(|(change, x)| change.abs() / (1.0 + x.abs()));
    part.fold(0.0, |largest, part| if part > largest || part.is_nan() { part } else { largest })
}
