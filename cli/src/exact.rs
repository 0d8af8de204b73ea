//! The exact gradient of the true system, and whether it is one: both ways to compute it agree, and both sides do.

use fdcc_runtime::sensitivity::{Quantity, Sensitivity, gradient, one_sided};
use fdcc_runtime::simulate::{Controls, Options, Simulation, System};

/// Forward sensitivities and adjoint that differ by more are not trusted.
const AGREEMENT: f64 = 1e-10;

/// Derivatives from two sides that differ by more are two.
const SIDES: f64 = 1e-5;

/// For more quantities nobody waits for the derivatives from both sides.
const MOST_SIDES: usize = 64;

/// A gradient and what is to be thought of it.
pub struct Exact {
    pub found: Sensitivity,
    /// Below and above each quantity, where there are reasons for doubt; else nothing.
    pub sides: Vec<[Option<f64>; 2]>,
    /// Whether there is a derivative.
    pub is_differentiable: bool,
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
        let is_doubtful = !found.troubles.is_empty();
        let sides = if is_doubtful && quantities.len() <= MOST_SIDES {
            one_sided(system, controls, options, quantities)
        } else {
            Vec::new()
        };
        let is_differentiable = !is_doubtful
            || !sides.is_empty() && sides.iter().zip(best(&found)).all(|(it, own)| is_one(*it, *own));
        Ok(Exact { found, sides, is_differentiable })
    }

    /// By each quantity.
    pub fn gradient(&self) -> &[f64] {
        best(&self.found)
    }

    /// Whether there is a derivative and both ways to compute it agree.
    pub fn is_trusted(&self) -> bool {
        self.is_differentiable && self.agrees()
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

/// Whether both sides have the derivative that was found.
fn is_one(sides: [Option<f64>; 2], own: f64) -> bool {
    sides.iter().all(|side| side.is_some_and(|side| (side - own).abs() <= SIDES * own.abs().max(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_derivative_is_the_same_from_both_sides() {
        let cases = [
            ([Some(1.0), Some(1.0)], 1.0, true),
            ([Some(1000.0), Some(1000.001)], 1000.0, true),
            ([Some(0.0), Some(1.0)], 1.0, false),
            ([Some(1.0), Some(0.0)], 1.0, false),
            ([Some(1.0), None], 1.0, false),
            ([Some(f64::NAN), Some(1.0)], 1.0, false),
        ];
        for (sides, own, expected) in cases {
            assert_eq!(is_one(sides, own), expected, "{sides:?} {own}");
        }
    }
}
