//! The exact gradient of the true system, and whether it is one: both ways to compute it agree, and
//! both sides do.

use super::tuning::exact::{AGREEMENT, MOST_SIDES, RESOLVED, SIDES};
use fdcc_runtime::sensitivity::{Quantity, Sensitivity, finer, gradient, one_sided};
use fdcc_runtime::simulate::{Controls, Options, Simulation, System};

/// A gradient and what is to be thought of it.
///
/// ```
/// let model = fdcc::Model::from_text("slide", "time t in [0, 2]
/// param mu = 2
/// state v start 1
/// surface slip = v
/// dynamics { v' in -mu * Sgn(slip) }
/// minimize integral(v)")?;
/// let gradient = model.gradient(&["mu"])?;
/// let exact = gradient.found.as_ref().expect("the last time is reached");
/// // It comes to rest at 1/mu, so the integral is 1/(2 mu).
/// assert!(exact.agrees() && (exact.gradient[0] + 0.125).abs() < 1e-8);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Exact {
    /// Derivatives as they were computed, with their simulation.
    pub found: Sensitivity,
    /// Below and above each quantity, where there are reasons for doubt; else nothing.
    pub sides: Vec<[Option<f64>; 2]>,
    /// Whether there is a derivative.
    pub is_differentiable: bool,
    /// By each quantity.
    pub gradient: Vec<f64>,
    /// The same from the adjoint.
    pub adjoint: Vec<f64>,
}

impl Exact {
    /// Differentiates; nothing but the simulation where it does not reach the end.
    pub fn new(
        system: &System,
        controls: &Controls,
        options: &Options,
        quantities: &[Quantity],
    ) -> Result<Exact, Box<Simulation>> {
        let found = gradient(system, controls, options, quantities)?;
        // Of each side along steps that are as short. Where even shorter ones lead to something
        // else, nothing is trusted, and the ordinary ones do.
        let shorter = (found.resolution <= RESOLVED).then(|| finer(options, &found.simulation));
        let options = shorter.as_ref().unwrap_or(options);
        let is_doubtful = !found.nondifferentiabilities.is_empty();
        let sides = if is_doubtful && quantities.len() <= MOST_SIDES {
            one_sided(system, controls, options, quantities)
        } else {
            Vec::new()
        };
        let common: Vec<Option<f64>> = sides
            .iter()
            .enumerate()
            .map(|(at, sides)| common(*sides, best(&found)[at], terms(&found, at)))
            .collect();
        let is_differentiable =
            !is_doubtful || !common.is_empty() && common.iter().all(Option::is_some);
        let settled = |own: &[f64]| -> Vec<f64> {
            let common = common.iter().copied().chain(std::iter::repeat(None));
            own.iter().zip(common).map(|(own, common)| common.unwrap_or(*own)).collect()
        };
        let (gradient, adjoint) = (settled(best(&found)), settled(&found.adjoint));
        Ok(Exact { found, sides, is_differentiable, gradient, adjoint })
    }

    /// Whether there is a derivative, both ways to compute it agree, shorter steps lead to the
    /// same, and the trajectory stays on no kink.
    pub fn is_trusted(&self) -> bool {
        let is_one = self.is_differentiable && self.found.kink.is_none();
        is_one && self.agrees() && self.is_resolved()
    }

    /// Whether steps of half the length lead to the same.
    pub fn is_resolved(&self) -> bool {
        self.found.resolution <= RESOLVED
    }

    /// Whether the digits of all derivatives are known, also of those that are the rest of what was
    /// larger by far on the way.
    pub fn knows_rests(&self) -> bool {
        self.found.resolution_of_rests <= RESOLVED
    }

    /// Whether both ways to compute it agree.
    pub fn agrees(&self) -> bool {
        self.found.agreement <= AGREEMENT
    }
}

/// With very many quantities there is the adjoint alone.
fn best(found: &Sensitivity) -> &[f64] {
    if found.forward.is_empty() { &found.adjoint } else { &found.forward }
}

/// How large the terms at the end are that a derivative is the sum of: it may be small because they
/// cancel.
fn terms(found: &Sensitivity, quantity: usize) -> f64 {
    let last = found.costates.columns.iter().map(|column| column.last().copied().unwrap_or(0.0));
    last.zip(&found.end).map(|(costate, by)| (costate * by[quantity]).abs()).sum()
}

/// The derivative that both sides have: the one that was found, if it is theirs. Where several
/// events meet it may be neither's, though there is one. Nothing here is absolute: derivatives have
/// units.
fn common(sides: [Option<f64>; 2], own: f64, terms: f64) -> Option<f64> {
    let [below, above] = [sides[0]?, sides[1]?];
    if below.is_infinite() || above.is_infinite() {
        return None;
    }
    let size = [below, above, own].iter().fold(terms, |size, value| size.max(value.abs()));
    let is_near = |a: f64, b: f64| (a - b).abs() <= SIDES * size;
    match is_near(below, own) && is_near(above, own) {
        true => Some(own),
        false => is_near(below, above).then_some(0.5 * (below + above)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_derivative_is_the_same_from_both_sides() {
        let cases = [
            ([Some(1.0), Some(1.0)], 1.0, 0.0, Some(1.0)),
            ([Some(f64::INFINITY), Some(0.0)], 0.0, 0.0, None),
            ([Some(1000.0), Some(1000.001)], 1000.0, 0.0, Some(1000.0)),
            ([Some(0.0), Some(0.0)], 0.0, 0.0, Some(0.0)),
            ([Some(0.0), Some(1.0)], 1.0, 0.0, None),
            ([Some(1.0), Some(0.0)], 1.0, 0.0, None),
            ([Some(1e-9), Some(0.0)], 1e-9, 1e-9, None),
            ([Some(1e-9), Some(-1e-9)], 0.0, 1.0, Some(0.0)),
            ([Some(1.0), None], 1.0, 0.0, None),
            ([Some(f64::NAN), Some(1.0)], 1.0, 0.0, None),
            ([Some(4.0), Some(4.0)], 0.0, 0.0, Some(4.0)),
        ];
        for (sides, own, terms, expected) in cases {
            assert_eq!(common(sides, own, terms), expected, "{sides:?} {own} {terms}");
        }
    }
}
