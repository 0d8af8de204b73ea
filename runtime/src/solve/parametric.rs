//! How the solution of a chain moves with a parameter, in the words of the model.

use crate::nlp::parametric::moved;
use crate::problem::Chain;
use crate::solution::{ChainOutcome, Sampled};
use crate::transcribe::chain::ChainNlp;

/// The derivative of one phase of a solution by a parameter.
#[derive(Clone, Debug)]
pub struct Movement {
    /// Of the `N + 1` times of the grid.
    pub time: Vec<f64>,
    /// One column per state, `N + 1` entries each: of its value at a time that stays the same.
    pub states: Vec<Vec<f64>>,
    /// One column per control, `N` entries each: of its mean over the interval, the same.
    pub controls: Vec<Vec<f64>>,
    /// All of `p`, unknowns included.
    pub parameters: Vec<f64>,
}

/// That of all phases of a chain; `changed` is the chain with the parameter by half of `change`
/// below and above. Nothing where the solution is no strict minimum.
pub fn movement_of_chain(
    chain: &Chain,
    outcome: &ChainOutcome,
    changed: [&Chain; 2],
    change: f64,
) -> Option<Vec<Movement>> {
    let widths = &outcome.sigma;
    let with_widths = |chain| {
        let mut nlp = ChainNlp::new(chain);
        nlp.set_widths(widths);
        nlp
    };
    let (mut nlp, [mut below, mut above]) = (with_widths(chain), changed.map(with_widths));
    let solution = &outcome.solution;
    let by = moved(&mut nlp, solution, [&mut below, &mut above], change)?;
    let at = |part: f64| -> Vec<f64> {
        solution.v.iter().zip(&by).map(|(v, by)| v + part * change * by).collect()
    };
    let own = sampled(&mut nlp, &at(0.0));
    let (low, high) = (sampled(&mut below, &at(-0.5)), sampled(&mut above, &at(0.5)));
    let each = own.iter().zip(low.iter().zip(&high));
    Some(each.map(|(own, both)| Movement::new(own, both, change)).collect())
}

fn sampled(nlp: &mut ChainNlp, v: &[f64]) -> Vec<Sampled> {
    let phases = nlp.shape().phases.clone();
    let all = phases.iter().enumerate();
    all.map(|(at, phase)| Sampled::new(nlp.phase_at(at, v), &phase.own(v))).collect()
}

impl Movement {
    /// A point of the grid takes its value along: what is left at a fixed time is less by the rate
    /// times the movement of the point.
    fn new(own: &Sampled, (low, high): (&Sampled, &Sampled), change: f64) -> Self {
        let column = |low: &[f64], high: &[f64]| -> Vec<f64> {
            low.iter().zip(high).map(|(low, high)| (high - low) / change).collect()
        };
        let time = column(&low.time, &high.time);
        let middle: Vec<f64> = time.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        let at_fixed_time = |low: &[f64], high: &[f64], rates: &[f64], moved: &[f64]| {
            let along = column(low, high).into_iter().zip(rates.iter().zip(moved));
            along.map(|(by, (rate, moved))| by - rate * moved).collect()
        };
        let states = low.states.iter().zip(&high.states).zip(&own.rates);
        let controls = low.controls.iter().zip(&high.controls).zip(&own.slopes);
        Movement {
            states: states.map(|((l, h), rate)| at_fixed_time(l, h, rate, &time)).collect(),
            controls: controls.map(|((l, h), rate)| at_fixed_time(l, h, rate, &middle)).collect(),
            parameters: column(&low.parameters, &high.parameters),
            time,
        }
    }
}
