//! Second derivatives through events: second-order saltation, one pair of directions at a time.
//!
//! Between events `X_ij' = f*_x X_ij + f*_ww[W_i, W_j]`, differentiated step by step as the first
//! order is. At an event, with `a = f-`, `b = f+`, `y` the state at the moved time and `z = r(t, y,
//! p)`
//!
//! ```text
//! y_i = S_i + a tau_i        y_ij = X_ij + a_i tau_j + a_j tau_i + a_t tau_i tau_j + a tau_ij
//! 0 = psi_x y_ij + psi_t tau_ij + psi_zz[Y_i, Y_j],  Y_i = (tau_i, y_i, p_i)
//! z_ij = r_x y_ij + r_t tau_ij + r_zz[Y_i, Y_j]
//! S+_i = z_i - b tau_i       X+_ij = z_ij - (b_i tau_j + b_j tau_i + b_t tau_i tau_j + b tau_ij)
//! ```
//!
//! which is the rule of section 5 of `method/beyond-the-paper.md` where nothing depends on time and
//! parameters. At an exit `a = b` and `tau` is that of the selector that reaches its end.

mod curvature;
mod event;

use super::first_order;
use super::first_order::quantity::{Directions, Quantity};
use super::first_order::{Objective, last_instant};
use super::linearised::event::{EventOnTape, Timing};
use super::linearised::linearisation::Lineariser;
use super::linearised::step::LinearStep;
use super::linearised::surface::Projection;
use super::nondifferentiability::kink::is_doubtful;
use crate::problem::Columns;
use crate::simulate::{Cause, Controls, Instant, Mode, Piece, Regime, Simulation, System, Tape};
use curvature::{Completed, Curvature, Hessians};
use event::{Pairs, SecondOrderEvent};
use nalgebra::{DMatrix, DVector};

/// The Hessian of the objective by some quantities; nothing where the state comes to rest after
/// infinitely many jumps, and nothing yet where a `Dir` moves. Nor is there one by a direction that
/// leaves a surface on which the state starts and slides, nor where a kink is met together with
/// something else.
pub fn hessian(
    system: &System,
    controls: &Controls,
    simulation: &Simulation,
    quantities: &[Quantity],
) -> Option<Vec<Vec<f64>>> {
    let lineariser = Lineariser::new(system, controls);
    let tape = simulation.tape.as_ref().filter(|tape| !has_no_second_order(tape))?;
    let objective = Objective::new(&lineariser, simulation)?;
    let directions = Directions::each(system, controls, quantities);
    let mut second = Second::new(&lineariser, tape, &directions);
    (0..tape.pieces.len()).for_each(|at| second.pass(at));
    if second.leaves_at_start || (0..tape.pieces.len()).any(|at| is_doubtful(&lineariser, tape, at))
    {
        return None;
    }
    let matrix = second.of_objective(&objective, simulation);
    Some(matrix.row_iter().map(|row| row.iter().copied().collect()).collect())
}

/// Whether the state comes to rest after infinitely many jumps, or something moves in a direction
/// that is not fixed.
fn has_no_second_order(tape: &Tape) -> bool {
    let lacks = |mode: &Mode| matches!(mode, Mode::Held | Mode::Moving);
    tape.regimes.iter().any(|regime| regime.modes.iter().any(lacks))
}

/// First and second derivatives on their way along a tape.
struct Second<'t> {
    lineariser: &'t Lineariser<'t>,
    tape: &'t Tape,
    directions: &'t Directions<'t>,
    s: DMatrix<f64>,
    x: Pairs,
    /// Whether a direction leaves a surface on which the state starts and slides.
    leaves_at_start: bool,
}

impl<'t> Second<'t> {
    fn new(lineariser: &'t Lineariser<'t>, tape: &'t Tape, directions: &'t Directions) -> Self {
        let s = first_order::start(lineariser, directions);
        let parameters = |i: usize| directions.parameters.column(i).into_owned();
        let x = Pairs::new(directions.count(), |i, j| {
            lineariser.start_curvature(&parameters(i), &parameters(j))
        });
        Second { lineariser, tape, directions, s, x, leaves_at_start: false }
    }

    fn regime(&self, at: &Instant) -> &'t Regime {
        &self.tape.regimes[at.regime]
    }

    /// The directions `(t, x, U, p)` at a fixed time, one for each quantity.
    fn directions_at(&self, regime: &Regime, s: &DMatrix<f64>) -> Vec<DVector<f64>> {
        let inputs = self.directions.inputs(regime);
        let one = |i: usize| {
            let parts = std::iter::once(0.0).chain(s.column(i).iter().copied().collect::<Vec<_>>());
            let all: Vec<f64> = parts.chain(inputs.column(i).iter().copied()).collect();
            DVector::from_vec(all)
        };
        (0..self.directions.count()).map(one).collect()
    }

    fn pass(&mut self, at: usize) {
        let piece = &self.tape.pieces[at];
        match piece {
            Piece::Step { start, h, stages, rule, .. } => {
                let regime = self.regime(start);
                self.step(
                    regime,
                    &LinearStep::new(self.lineariser, regime, start, *h, stages, *rule),
                );
            }
            Piece::Event { cause, before, after, changes } => {
                let event = EventOnTape { cause: *cause, before, after, changes };
                self.event(&event, &Timing::new(self.lineariser, self.tape, &event));
            }
        }
        let end = piece.end();
        if let Some(projection) = Projection::new(self.lineariser, self.regime(&end), &end) {
            self.project(&projection, self.regime(&end), &end);
        }
    }

    fn step(&mut self, regime: &Regime, step: &LinearStep) {
        let forcing = step.forcing(&self.directions.inputs(regime));
        let (at_stages, end) = step.forward(&self.s, &forcing);
        let stages = step.stages.iter().zip(&step.points).zip(&at_stages);
        let forcing = stages.map(|((point, (time, state)), s)| {
            let curvature = Curvature::new(self.lineariser, point, regime, *time, state);
            let whole: Vec<Completed> =
                self.directions_at(regime, s).iter().map(|it| curvature.complete(it)).collect();
            self.x.map(|i, j, _| curvature.along(&whole[i], &whole[j])).columns
        });
        let forcing: Vec<DMatrix<f64>> = forcing.collect();
        self.x = self.x.with(step.forward(&self.x.columns, &forcing).1);
        self.s = end;
    }

    fn event(&mut self, event: &EventOnTape, timing: &Timing) {
        let regime = self.regime(event.before);
        let tau = timing.of(&self.s, &self.directions.inputs(regime));
        let directions = self.directions_at(regime, &self.s);
        let second =
            SecondOrderEvent { lineariser: self.lineariser, tape: self.tape, event, tau: &tau };
        let moved = second.reset(second.meet(&self.s, &self.x, &directions), &directions);
        let onward = self.lineariser.at_instant(self.tape, event.after);
        self.s = &moved.s - &onward.rate * &tau;
        let directions = self.directions_at(self.regime(event.after), &self.s);
        self.x = second.leave(&onward, &moved, &directions);
    }

    /// Back to the surfaces: rounding and what a start on a surface brings with it.
    fn project(&mut self, projection: &Projection, regime: &Regime, at: &Instant) {
        let projected = projection.forward(&self.s, &self.directions.inputs(regime));
        let moved = (&projected - &self.s).amax();
        let is_start = at.time == self.lineariser.system.interval[0];
        self.leaves_at_start |= is_start && moved > 1e-9 * (1.0 + projected.amax());
        self.s = projected;
        let state = DVector::from_column_slice(&at.state);
        let table = self.lineariser.table(regime, &at.selectors, at.time, &state);
        let hessians =
            Hessians::of(&*self.lineariser.system.switching, &table, &self.lineariser.parameters);
        let whole = self.directions_at(regime, &self.s);
        let whole: Vec<_> =
            whole.iter().map(|it| self.lineariser.whole(it, regime, at.time)).collect();
        self.x = self.x.map(|i, j, x| {
            let curvature = hessians.along(&whole[i], &whole[j]);
            projection.correct(x, &curvature.select_rows(&projection.surfaces))
        });
    }

    /// `J_ij = J_z Z_ij + J_zz[Z_i, Z_j]` with `Z = (x(t0), x(T), p)`.
    fn of_objective(&self, objective: &Objective, simulation: &Simulation) -> DMatrix<f64> {
        let system = self.lineariser.system;
        let (start, end, curvature_end) = self.at_end();
        let mut point = Columns::new(2 * system.layout.x, 1);
        for (at, value) in system.start.iter().chain(&simulation.end).enumerate() {
            point.column_mut(at)[0] = *value;
        }
        let hessians = Hessians::of(&*system.objective, &point, &self.lineariser.parameters);
        let parameters = |i: usize| self.directions.parameters.column(i);
        let whole = |i: usize| {
            let ends =
                start.column(i).iter().chain(end.column(i).iter()).copied().collect::<Vec<_>>();
            let all: Vec<f64> = ends.into_iter().chain(parameters(i).iter().copied()).collect();
            DVector::from_vec(all)
        };
        DMatrix::from_fn(self.directions.count(), self.directions.count(), |i, j| {
            let curvature_start = self
                .lineariser
                .start_curvature(&parameters(i).into_owned(), &parameters(j).into_owned());
            (&objective.by_start * curvature_start)[0]
                + (&objective.by_end * curvature_end.at(i, j))[0]
                + hessians.along(&whole(i), &whole(j))[0]
        })
    }

    /// First derivatives of both ends, second ones of the last: the end of the interval moves, too.
    fn at_end(&self) -> (DMatrix<f64>, DMatrix<f64>, Pairs) {
        let start = first_order::start(self.lineariser, self.directions);
        let Some(last) = last_instant(self.tape) else {
            return (start.clone(), start, self.x.clone());
        };
        // The cause is of no matter: nothing but the clock moves the end.
        let event = EventOnTape { cause: Cause::Repels, before: &last, after: &last, changes: &[] };
        let regime = self.regime(&last);
        let timing = Timing::of_end(self.lineariser, regime);
        let tau = timing.of(&self.s, &self.directions.inputs(regime));
        let second = SecondOrderEvent {
            lineariser: self.lineariser,
            tape: self.tape,
            event: &event,
            tau: &tau,
        };
        let moved = second.meet(&self.s, &self.x, &self.directions_at(regime, &self.s));
        (start, moved.s, moved.x)
    }
}
