//! The recursion over several phases, one chain of stages each.
//!
//! Going backward, the value function of phase `j` over its first state and its border meets, at a
//! [node], the last state of phase `j - 1`:
//!
//! ```text
//!     V_j(x_0^j, theta_j)  +  links
//!         ─ without x_0^j and what no earlier phase has to do with ─▶  V(x_N^{j-1}, theta_{j-1})
//! ```
//!
//! The border `theta_j` holds only unknowns and multipliers of rows that reach from phase `j` or a
//! later one to phase `j` or an earlier one ([lifetimes]): so the cost does not grow with the
//! number of phases, as long as each is tied to the next.

mod direct;
mod lifetimes;
mod node;
mod phase;

use crate::linalg::sparse_ldl::SparseLdl;
use crate::linalg::structure::factor::{Factor, Inertia};
use crate::linalg::structure::phases::PhaseStages;
use crate::linalg::structure::triplets::Triplets;
use direct::direct_entries;
use lifetimes::{Item, Lifetimes};
use node::Node;
use phase::{Phase, is_of_stage};
use std::collections::BTreeMap;

/// The recursion over all phases.
pub(crate) struct PhasedRiccati {
    recipe: Recipe,
    variables: usize,
    /// Rows that are no stages: as many negative eigenvalues are left to the nodes.
    coupling: usize,
    lifetimes: Lifetimes,
    phases: Vec<Phase>,
    /// The node before each phase, and the one behind the last.
    nodes: Vec<Node>,
    /// Does the work where the border has grown too large.
    sparse: Option<SparseLdl>,
}

/// What it was prepared from.
#[derive(Clone)]
struct Recipe {
    phases: Vec<PhaseStages>,
    hessian: Triplets,
    jacobian: Triplets,
    fixed: Vec<bool>,
    equality_rows: Vec<bool>,
    /// Members of the border that cannot be eliminated where their phase begins, as the phase does
    /// not reach what they ask for; and the node for which they wait.
    waiting: BTreeMap<Item, usize>,
    /// The largest border that is worth the recursion, once something waits.
    most: usize,
}

/// So many times the border may grow before the sparse factorisation is cheaper.
const GROWTH: usize = 2;

impl PhasedRiccati {
    /// Prepares the recursion, or says why the structure does not allow it.
    pub fn new(
        phases: &[PhaseStages],
        (hessian, jacobian): (&Triplets, &Triplets),
        fixed: &[bool],
        equality_rows: &[bool],
    ) -> Result<Self, &'static str> {
        let mut prepared = PhasedRiccati::of(Recipe {
            phases: phases.to_vec(),
            hessian: hessian.clone(),
            jacobian: jacobian.clone(),
            fixed: fixed.to_vec(),
            equality_rows: equality_rows.to_vec(),
            waiting: BTreeMap::new(),
            most: 0,
        })?;
        prepared.recipe.most = GROWTH * (prepared.largest_border() + 1);
        Ok(prepared)
    }

    fn of(recipe: Recipe) -> Result<Self, &'static str> {
        let Recipe { phases, hessian, jacobian, fixed, equality_rows, waiting, .. } = &recipe;
        let direct = direct_entries(phases, hessian, jacobian).ok_or("distant stages are tied")?;
        let unknowns = phases.last().map_or(0, |last| last.variables.end)..fixed.len();
        let stage_rows = |row: &usize| phases.iter().any(|phase| is_of_stage(phase, *row));
        let rows = (0..equality_rows.len()).filter(|row| !stage_rows(row));
        let rows: Vec<(usize, bool)> = rows.map(|row| (row, equality_rows[row])).collect();
        let lifetimes = Lifetimes::new(phases, unknowns, &rows, &direct, waiting)?;
        let all = phases.iter().enumerate().map(|(j, phase)| {
            Phase::new(phase, lifetimes.theta(j), (hessian, jacobian), fixed, equality_rows)
        });
        let all: Vec<Phase> = all.collect::<Result<_, _>>()?;
        let node = |j| Node::new(j, phases, &lifetimes, &direct, fixed);
        let nodes = (0..=phases.len()).map(node).collect();
        let (variables, coupling) = (fixed.len(), rows.len());
        let sparse = None;
        Ok(PhasedRiccati { variables, coupling, phases: all, nodes, lifetimes, recipe, sparse })
    }

    fn largest_border(&self) -> usize {
        self.phases.iter().map(|phase| phase.theta.len()).max().unwrap_or(0)
    }

    /// Lets what dies at a node, and is no link, wait for the one before; whether there is any.
    fn wait(&mut self, node: usize) -> bool {
        let dying = self.lifetimes.dying(node);
        let waiting: Vec<Item> = dying.filter(|item| self.lifetimes.may_wait(item, node)).collect();
        let mut recipe = self.recipe.clone();
        recipe.waiting.extend(waiting.iter().map(|item| (*item, node - 1)));
        match PhasedRiccati::of(recipe) {
            Ok(mut prepared) if !waiting.is_empty() => {
                if prepared.largest_border() > prepared.recipe.most {
                    let Recipe { hessian, jacobian, fixed, equality_rows, .. } = &prepared.recipe;
                    let sparse = SparseLdl::new(hessian, jacobian, fixed, equality_rows.len());
                    prepared.sparse = Some(sparse);
                }
                *self = prepared;
                true
            }
            _ => false,
        }
    }

    /// Factors; or says at which node nothing makes up for what dies there.
    fn try_factor(
        &mut self,
        (hessian, jacobian): (&[f64], &[f64]),
        sigma: &[f64],
        d: &[f64],
    ) -> Result<Inertia, usize> {
        let mut negative = 0;
        for j in (0..=self.phases.len()).rev() {
            let (before, behind) = self.phases.split_at_mut(j);
            let node = &mut self.nodes[j];
            node.assemble(behind.first().map(|phase| &phase.value[..]), hessian, jacobian);
            node.add_diagonals(sigma, d);
            negative += node.eliminate().ok_or(j)?;
            if !node.is_sound() && self.lifetimes.dying(j).any(|it| self.lifetimes.may_wait(&it, j))
            {
                return Err(j);
            }
            let Some(phase) = before.last_mut() else { break };
            node.write(&mut phase.value);
            let matrices = (hessian, jacobian);
            match phase.factor(matrices, sigma, d, self.coupling.saturating_sub(negative)) {
                Some(count) => negative += count,
                None => return Ok(Inertia::Wrong),
            }
        }
        Ok(if negative == self.coupling { Inertia::Correct } else { Inertia::Wrong })
    }
}

#[cfg(test)]
impl PhasedRiccati {
    /// The size of the border of a phase.
    pub fn border(&self, phase: usize) -> usize {
        self.phases[phase].theta.len()
    }
}

impl Factor for PhasedRiccati {
    fn factor(&mut self, hessian: &[f64], jacobian: &[f64], sigma: &[f64], d: &[f64]) -> Inertia {
        loop {
            if let Some(sparse) = &mut self.sparse {
                return sparse.factor(hessian, jacobian, sigma, d);
            }
            match self.try_factor((hessian, jacobian), sigma, d) {
                Ok(inertia) => return inertia,
                Err(node) if self.wait(node) => {}
                Err(_) => return Inertia::Singular,
            }
        }
    }

    fn solve(&mut self, right_side: &mut [f64]) {
        if let Some(sparse) = &mut self.sparse {
            return sparse.solve(right_side);
        }
        let (a, b) = right_side.split_at_mut(self.variables);
        self.phases.iter_mut().for_each(|phase| phase.begin(a, b));
        // Backward: gradients of value functions.
        for j in (0..=self.phases.len()).rev() {
            let (before, behind) = self.phases.split_at_mut(j);
            let arrived = behind.first().map(|phase| &phase.travel.gradient[..]);
            let node = &mut self.nodes[j];
            node.reduce(arrived, a, b);
            if let Some(phase) = before.last_mut() {
                node.write_gradient(&mut phase.travel.gradient);
                phase.backward(b);
            }
        }
        // Forward: what was eliminated at each node, then the stages of the phase behind it.
        for j in 0..=self.phases.len() {
            let (before, behind) = self.phases.split_at_mut(j);
            let state = before.last().map_or(&[][..], |phase| &phase.travel.state[..]);
            let node = &mut self.nodes[j];
            node.expand(state, a, b);
            if let Some(phase) = behind.first_mut() {
                node.write_state(&mut phase.travel.state);
                phase.forward(b);
            }
        }
        self.phases.iter_mut().for_each(|phase| phase.finish(a, b));
    }
}
