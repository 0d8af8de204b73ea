//! The derivative of the optimum of a chain by its parameters: the sum of what phases and links
//! count in the Lagrangian.

use crate::nlp::Solution;
use crate::problem::{Chain, ChainByParameters};
use crate::solution::ChainOutcome;
use crate::solution::by_parameters::{add_given, at_bounds, by_parameters_of_part};
use crate::solution::lagrangian::add_slopes;
use crate::transcribe::chain::ChainNlp;

/// The derivative of the optimal objective of the model by each parameter, those included that are
/// computed from it.
pub fn by_parameters_of_chain(
    chain: &Chain,
    outcome: &ChainOutcome,
    by: &ChainByParameters,
) -> Vec<f64> {
    let mut nlp = ChainNlp::new(chain);
    let solution = &outcome.solution;
    let linked = nlp.slopes_of_links(solution);
    let mut all = of_links(&mut nlp, chain, solution, by);
    let parts = chain.phases.iter().zip(&outcome.phases).zip(&by.phases).enumerate();
    for (at, ((problem, outcome), by)) in parts {
        let shape = &nlp.shape().phases[at];
        let mut own = outcome.solution.clone();
        // The bounds of unknowns count once only.
        own.multipliers.lower[shape.variables.len()..].fill(0.0);
        own.multipliers.upper[shape.variables.len()..].fill(0.0);
        let p = &outcome.trajectory.parameters;
        let sums = by_parameters_of_part(problem, &own, p, by, &shape.own(&linked));
        all.iter_mut().zip(sums).for_each(|(sum, more)| *sum += more);
    }
    all
}

/// What links and the bounds of unknowns count.
fn of_links(
    nlp: &mut ChainNlp,
    chain: &Chain,
    solution: &Solution,
    by: &ChainByParameters,
) -> Vec<f64> {
    let count = by.phases.first().map_or(0, |it| it.parameters);
    let (mut sums, rows) = (vec![0.0; count], &solution.multipliers.constraints);
    let parameters = nlp.parameters_of_links(&solution.v);
    let unknowns = nlp.shape().unknowns[0]..nlp.shape().unknowns[1];
    let multipliers = &solution.multipliers;
    let mut weights = vec![0.0; count];
    weights.extend(unknowns.flat_map(|at| [multipliers.lower[at], -multipliers.upper[at]]));
    for ((link, function), (points, own)) in chain.links.iter().zip(&by.links).zip(nlp.links()) {
        let p = &parameters[..function.layout().p];
        add_slopes(&**function, points, p, &mut sums, |output| {
            vec![output.checked_sub(1).map_or(1.0, |row| rows[own.start + row])]
        });
        let bounds = own.zip(&link.bounds);
        weights.extend(bounds.flat_map(|(row, bounds)| at_bounds([rows[row]], bounds)));
    }
    add_given(&*by.given, &weights, &parameters, &mut sums);
    sums.iter().map(|sum| chain.phases[0].sense * sum).collect()
}
