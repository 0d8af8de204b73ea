//! Where the variables and constraints of each phase are among those of a chain, and the way from
//! one to the other: starts and multipliers.

use crate::linalg::PhaseStages;
use crate::nlp::{Multipliers, Start, Warm};

/// The sizes of a chain.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    pub(crate) phases: Vec<PhaseStages>,
    /// The first unknown; the number of all variables.
    pub(crate) unknowns: [usize; 2],
    /// Rows of the links, behind those of the phases.
    pub(crate) links: usize,
}

/// The multipliers of a phase by itself.
pub(crate) fn own_multipliers(phase: &PhaseStages, of: &Multipliers) -> Multipliers {
    Multipliers {
        constraints: of.constraints[phase.rows.clone()].to_vec(),
        lower: phase.own(&of.lower),
        upper: phase.own(&of.upper),
    }
}

impl Shape {
    /// A start for each phase by itself.
    pub(crate) fn split(&self, start: &Start) -> Vec<Start> {
        let own = |phase: &PhaseStages| Start {
            v: phase.own(&start.v),
            warm: start.warm.as_ref().map(|warm| Warm {
                multipliers: own_multipliers(phase, &warm.multipliers),
                mu: warm.mu,
                widths: Vec::new(),
            }),
        };
        self.phases.iter().map(own).collect()
    }

    /// The start of the chain from those of its phases; unknowns and links are those of `whole`, a
    /// start on other grids.
    pub(crate) fn joined(&self, own: &[Start], whole: &Start) -> Start {
        let multipliers: Vec<&Multipliers> =
            own.iter().filter_map(|it| it.warm.as_ref().map(|warm| &warm.multipliers)).collect();
        let each = |of: &dyn Fn(&Multipliers) -> Vec<f64>| -> Vec<Vec<f64>> {
            multipliers.iter().map(|it| of(it)).collect()
        };
        let warm = whole.warm.as_ref().map(|warm| {
            let known = &warm.multipliers;
            let rows = each(&|of| of.constraints.clone()).concat();
            let linked = &known.constraints[known.constraints.len() - self.links..];
            let mus = own.iter().filter_map(|start| start.warm.as_ref()?.mu);
            Warm {
                multipliers: Multipliers {
                    constraints: [&rows, linked].concat(),
                    lower: self.variables(&each(&|of| of.lower.clone()), &known.lower),
                    upper: self.variables(&each(&|of| of.upper.clone()), &known.upper),
                },
                mu: mus.reduce(f64::max),
                widths: warm.widths.clone(),
            }
        });
        let values: Vec<Vec<f64>> = own.iter().map(|start| start.v.clone()).collect();
        Start { v: self.variables(&values, &whole.v), warm }
    }

    /// One number per variable: of stages from the phases, of unknowns from the whole.
    fn variables(&self, own: &[Vec<f64>], whole: &[f64]) -> Vec<f64> {
        let count = self.unknowns[1] - self.unknowns[0];
        let stages = self.phases.iter().zip(own).flat_map(|(it, own)| &own[..it.variables.len()]);
        stages.chain(&whole[whole.len() - count..]).copied().collect()
    }
}
