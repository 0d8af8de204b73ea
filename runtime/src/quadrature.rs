//! Integrals along a trajectory, by the nodes and weights of its own scheme:
//!
//! ```text
//!     integral  =  h sum_k sum_j b_j L(tau_k + c_j h, (1 - w_j) x_k + w_j x_{k+1}, u_k)
//! ```
//!
//! So an `integral(...)` outside the objective has the value that it would have in the objective.

use crate::problem::{Columns, Function, Problem};
use crate::trajectory::Trajectory;
use crate::transcribe::tableau::{Node, nodes};

/// The integrals over normalised time of all outputs of a function of `[tau | x | u | p]`.
pub fn integrals(problem: &Problem, trajectory: &Trajectory, integrands: &dyn Function) -> Vec<f64> {
    let intervals = trajectory.time.len() - 1;
    let mut sums = vec![0.0; integrands.outputs()];
    for node in nodes(&problem.method, trajectory.states.len()) {
        let mut values = Columns::new(integrands.outputs(), intervals);
        integrands.value(&points(trajectory, &node, intervals), &trajectory.parameters, &mut values);
        for (output, sum) in sums.iter_mut().enumerate() {
            *sum += node.weight / intervals as f64 * values.column(output).iter().sum::<f64>();
        }
    }
    sums
}

/// What the node sees in each interval.
fn points(trajectory: &Trajectory, node: &Node, intervals: usize) -> Columns {
    let Trajectory { states, controls, .. } = trajectory;
    let mut points = Columns::new(1 + states.len() + controls.len(), intervals);
    for (k, tau) in points.column_mut(0).iter_mut().enumerate() {
        *tau = (k as f64 + node.time) / intervals as f64;
    }
    for (i, (state, blend)) in states.iter().zip(&node.blend).enumerate() {
        let ends = state.windows(2).map(|x| (1.0 - blend) * x[0] + blend * x[1]);
        points.column_mut(1 + i).iter_mut().zip(ends).for_each(|(value, x)| *value = x);
    }
    for (i, control) in controls.iter().enumerate() {
        points.column_mut(1 + states.len() + i).copy_from_slice(control);
    }
    points
}
