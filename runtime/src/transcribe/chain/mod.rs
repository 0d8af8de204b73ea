//! The NLP of a chain of phases: the NLPs of its phases side by side, and the links between them.
//!
//! ```text
//! variables   stages of phase 0    stages of phase 1   ...   unknowns
//! constraints those of phase 0     those of phase 1    ...   links
//! ```
//!
//! The NLP of a phase has its stages and, of all unknowns, those that it depends on ([`part`]). A
//! single phase is the NLP itself.

mod guess;
mod links;
mod part;
mod quantities;
mod shape;

use super::TranscribedNlp;
use crate::linalg::{PhaseStages, Stages, Triplets};
use crate::nlp::{Derivatives, NO_OBJECTIVE, Nlp, Place, Quantities, Solution, objective_unit};
use crate::problem::{Bounds, Chain, Columns};
use crate::solution::switching_function_sizes;
use links::TranscribedLink;
use part::Part;
pub(crate) use shape::{Shape, own_multipliers};
use std::cell::OnceCell;
use std::ops::Range;
use std::sync::Arc;

/// The NLP of a chain, each phase on its own grid.
pub struct ChainNlp<'c> {
    chain: &'c Chain,
    parts: Vec<Part<'c>>,
    links: Vec<TranscribedLink<'c>>,
    shape: Shape,
    variable_bounds: Vec<Bounds>,
    constraint_bounds: Vec<Bounds>,
    jacobian: Triplets,
    hessian: Triplets,
    /// All parameters and unknowns, as the links see them.
    parameters: Vec<f64>,
    /// See [`Nlp::objective_unit`]; nothing as long as nobody asks.
    objective_unit: Option<f64>,
    /// The same of [`Nlp::quantities`].
    quantities: OnceCell<Arc<Quantities>>,
}

impl<'c> ChainNlp<'c> {
    /// Transcribes each phase with its own method.
    pub fn new(chain: &'c Chain) -> Self {
        let parts = Part::all(chain);
        let first = parts.iter().map(|part| part.shape.variables.len()).sum();
        let links = TranscribedLink::all(chain, &parts, first);
        let shape = Shape {
            phases: parts.iter().map(|part| part.shape.clone()).collect(),
            unknowns: [first, first + chain.unknowns.len()],
            links: links.iter().map(|link| link.rows.len()).sum(),
        };
        let mut nlp = ChainNlp {
            chain,
            shape,
            variable_bounds: Vec::new(),
            constraint_bounds: Vec::new(),
            jacobian: Triplets::default(),
            hessian: Triplets::default(),
            parameters: chain.phases[0].parameters.iter().map(|it| it.value).collect(),
            objective_unit: None,
            quantities: OnceCell::new(),
            parts,
            links,
        };
        nlp.gather();
        nlp
    }

    /// Bounds and structures of all phases and links.
    fn gather(&mut self) {
        for part in &self.parts {
            self.variable_bounds.extend_from_slice(part.stage_bounds());
            self.constraint_bounds.extend_from_slice(part.nlp.constraint_bounds());
            self.jacobian.families.extend(part.jacobian());
            self.hessian.families.extend(part.hessian());
        }
        self.variable_bounds.extend(self.chain.unknowns.iter().map(|unknown| unknown.bounds));
        for link in &self.links {
            self.constraint_bounds.extend_from_slice(&link.link.bounds);
            self.jacobian.families.extend_from_slice(&link.jacobian.families);
            self.hessian.families.extend_from_slice(&link.hessian.families);
        }
        let parameters = &self.parameters;
        for (variable, value) in self.links.iter_mut().flat_map(|link| link.given(parameters)) {
            // On its bound the state would have no interior.
            if self.variable_bounds[variable].violation(value) == 0.0 {
                self.variable_bounds[variable] = Bounds::FREE;
            }
        }
    }

    /// The NLP of each phase.
    pub(crate) fn each(&self) -> impl ExactSizeIterator<Item = &TranscribedNlp<'c>> {
        self.parts.iter().map(|part| &part.nlp)
    }

    /// Where the variables and constraints of the phases are.
    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The NLP of a phase with the unknowns of `v`, those included that no derivative depends on.
    pub(crate) fn phase_at(&mut self, phase: usize, v: &[f64]) -> &mut TranscribedNlp<'c> {
        let nlp = &mut self.parts[phase].nlp;
        for (unknown, value) in self.chain.unknowns.iter().zip(&v[self.shape.unknowns[0]..]) {
            nlp.set_parameter(unknown.parameter, *value);
        }
        nlp
    }

    /// The largest absolute value of each switching function along `v`, phase by phase.
    pub(crate) fn switching_function_sizes(&mut self, v: &[f64]) -> Vec<f64> {
        let mut sizes = Vec::new();
        for phase in 0..self.parts.len() {
            let own = self.shape.phases[phase].own(v);
            sizes.extend(switching_function_sizes(self.phase_at(phase, v), &own));
        }
        sizes
    }

    /// What the links add to the gradient of the Lagrangian.
    pub(crate) fn slopes_of_links(&mut self, solution: &Solution) -> Vec<f64> {
        let rows = &solution.multipliers.constraints;
        let mut gradient = vec![0.0; self.shape.unknowns[1]];
        self.load_links(&solution.v);
        for link in &mut self.links {
            link.differentiate(&self.parameters, 1.0, rows);
            link.add_slopes(1.0, rows, &mut gradient);
        }
        gradient
    }

    /// All parameters and unknowns at `v`, where the links are evaluated from now on.
    pub(crate) fn parameters_of_links(&mut self, v: &[f64]) -> Vec<f64> {
        self.load_links(v);
        self.parameters.clone()
    }

    /// The inputs of each link, where they were evaluated last, and its rows.
    pub(crate) fn links(&self) -> impl Iterator<Item = (&Columns, Range<usize>)> {
        self.links.iter().map(|link| (link.points(), link.rows.clone()))
    }

    /// Intervals of all phases together.
    pub(crate) fn intervals(&self) -> usize {
        self.each().map(|phase| phase.chain().intervals).sum()
    }

    /// Changes the smoothing width of each surface, phase by phase, without transcribing again.
    pub(crate) fn set_widths(&mut self, widths: &[f64]) {
        let mut widths = widths.iter();
        for part in &mut self.parts {
            for (surface, width) in part.nlp.problem().surfaces.iter().zip(&mut widths) {
                part.nlp.set_parameter(surface.sigma, *width);
            }
        }
    }

    /// Whether a row is a step of a differential equation.
    pub(crate) fn is_defect(&self, row: usize) -> bool {
        let part = self.parts.iter().find(|part| part.shape.rows.contains(&row));
        part.is_some_and(|part| part.nlp.is_defect(row - part.shape.rows.start))
    }

    fn load_links(&mut self, v: &[f64]) {
        for (unknown, value) in self.chain.unknowns.iter().zip(&v[self.shape.unknowns[0]..]) {
            self.parameters[unknown.parameter] = *value;
        }
        self.links.iter_mut().for_each(|link| link.load(v));
    }

    /// The only phase, if nothing is tied to it: its NLP is the whole.
    fn single(&mut self) -> Option<&mut TranscribedNlp<'c>> {
        match (&mut self.parts[..], self.links.is_empty()) {
            ([part], true) => Some(&mut part.nlp),
            _ => None,
        }
    }
}

impl Nlp for ChainNlp<'_> {
    fn variable_bounds(&self) -> &[Bounds] {
        &self.variable_bounds
    }
    fn constraint_bounds(&self) -> &[Bounds] {
        &self.constraint_bounds
    }
    fn jacobian_structure(&self) -> &Triplets {
        &self.jacobian
    }
    fn hessian_structure(&self) -> &Triplets {
        &self.hessian
    }
    fn stages(&self) -> Option<Stages> {
        match (&self.parts[..], self.links.is_empty()) {
            ([part], true) => part.nlp.stages(),
            _ => None,
        }
    }
    fn phases(&self) -> Vec<PhaseStages> {
        if self.stages().is_some() { Vec::new() } else { self.shape.phases.clone() }
    }
    fn quantities(&self) -> Arc<Quantities> {
        Arc::clone(self.quantities.get_or_init(|| Arc::new(self.all_quantities())))
    }
    /// The unit is at most 1, and takes time to find out.
    fn objective_size(&mut self, terms: f64) -> f64 {
        if terms >= NO_OBJECTIVE { terms } else { terms.max(NO_OBJECTIVE * self.objective_unit()) }
    }
    fn objective_unit(&mut self) -> f64 {
        if let Some(only) = self.single() {
            return only.objective_unit();
        }
        if self.objective_unit.is_none() {
            let guess = self.guess();
            self.objective_unit = Some(objective_unit(self, &guess));
        }
        self.objective_unit.unwrap_or(1.0)
    }

    fn values(&mut self, v: &[f64], rows: &mut [f64]) -> f64 {
        if let Some(only) = self.single() {
            return only.values(v, rows);
        }
        let mut objective = 0.0;
        for part in &mut self.parts {
            let own = &mut rows[part.shape.rows.clone()];
            part.load(v);
            objective += part.nlp.values(&part.v, own);
        }
        self.load_links(v);
        let parameters = &self.parameters;
        self.links.iter_mut().for_each(|link| objective += link.values(parameters, rows));
        objective
    }

    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        if let Some(only) = self.single() {
            return only.derivatives(v, weight, multipliers, out);
        }
        out.gradient.fill(0.0);
        let (mut jacobian, mut hessian) = (&mut out.jacobian[..], &mut out.hessian[..]);
        for part in &mut self.parts {
            part.load(v);
            part.differentiate(weight, &multipliers[part.shape.rows.clone()]);
            part.add_gradient(&mut out.gradient);
            jacobian = moved(jacobian, &part.derivatives.jacobian);
            hessian = moved(hessian, &part.derivatives.hessian);
        }
        self.load_links(v);
        for link in &mut self.links {
            link.differentiate(&self.parameters, weight, multipliers);
            (jacobian, hessian) = link.scatter(&mut out.gradient, jacobian, hessian);
        }
    }

    fn has_kinks(&self) -> bool {
        !self.links.is_empty() || self.parts.iter().any(|part| part.nlp.has_kinks())
    }

    fn is_linear(&self, row: usize) -> bool {
        let phase = self.parts.iter().find(|part| part.shape.rows.contains(&row));
        match phase {
            Some(part) => part.nlp.is_linear(row - part.shape.rows.start),
            None => self.links.iter().any(|it| it.rows.contains(&row) && it.is_linear(row)),
        }
    }

    fn constraint_place(&self, row: usize) -> Place {
        let phase = self.parts.iter().position(|part| part.shape.rows.contains(&row));
        match phase {
            Some(phase) => {
                let part = &self.parts[phase];
                Place { phase, ..part.nlp.constraint_place(row - part.shape.rows.start) }
            }
            None => {
                let link = self.links.iter().find(|link| link.rows.contains(&row));
                link.map_or_else(Place::default, |link| link.place(row))
            }
        }
    }

    fn not_finite(&mut self, v: &[f64]) -> Option<Place> {
        for (phase, part) in self.parts.iter_mut().enumerate() {
            part.load(v);
            if let Some(place) = part.nlp.not_finite(&part.v) {
                return Some(Place { phase, ..place });
            }
        }
        self.load_links(v);
        let (parameters, rows) = (&self.parameters, self.constraint_bounds.len());
        self.links.iter_mut().find_map(|link| link.not_finite(parameters, rows))
    }
}

/// Puts values at the front of a slice; the rest of it.
fn moved<'a>(target: &'a mut [f64], values: &[f64]) -> &'a mut [f64] {
    let (front, rest) = target.split_at_mut(values.len());
    front.copy_from_slice(values);
    rest
}
