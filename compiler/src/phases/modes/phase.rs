//! One phase of given modes, as a model without surfaces.

use super::junctions::on_arc;
use super::{Arc, Mode, Modes, PhaseOfModes};
use crate::expressions::graph::ExprId;
use crate::model::guess::straight_guesses;
use crate::model::{
    Constraint, Control, Integral, Model, Place, Range, Report, State, Sum, Symbol,
};
use crate::phases::hold::approach;
use crate::phases::shares::Shares;
use fdcc_runtime::problem::Method;

impl Modes<'_> {
    pub(super) fn phase(&mut self, j: usize, shares: &Shares) -> Model {
        let model = self.between.division.model;
        let of = &self.phases[j];
        let meanings = self.selectors(of);
        let states = self.states(j, &meanings);
        let path = self.path(j, &states, &meanings);
        let integrals = self.integrals(shares, &meanings);
        let controls = self.controls(of);
        let last = self.between.division.last();
        let value = shares.of_phase(&mut self.between.division.graph, j, last);
        let place = model.objective.as_ref().map(|it| it.0.clone());
        let report = self.report(&meanings);
        let sums = self.sums(j, &meanings);
        let boundary = if j == 0 { self.starts() } else { Vec::new() };
        let method = Method { controls: of.shape, ..model.method.clone() };
        Model {
            method,
            interval: [self.between.division.times[j], self.between.division.times[j + 1]],
            graph: self.between.division.graph.clone(),
            boundary,
            objective: place.zip(value),
            surfaces: Vec::new(),
            balls: Vec::new(),
            states,
            controls,
            path,
            integrals,
            sums,
            report,
            ..model.clone()
        }
    }

    /// What the selector of each surface is.
    pub(super) fn selectors(&mut self, of: &PhaseOfModes) -> Vec<ExprId> {
        let model = self.between.division.model;
        let mut meanings = vec![self.between.division.graph.number(0.0); model.surfaces.len()];
        let mut next = model.controls.len();
        for (switch, mode) in model.switches().iter().zip(&of.modes) {
            let psis: Vec<ExprId> =
                model.surfaces[switch.surfaces.clone()].iter().map(|it| it.psi).collect();
            for (at, surface) in switch.surfaces.clone().enumerate() {
                meanings[surface] = match (mode, switch.is_ball) {
                    (Mode::Held, _) => {
                        let input = model.input_of(Symbol::Control(next + at));
                        self.between
                            .division
                            .graph
                            .input(input.expect("a chosen selector has a place"))
                    }
                    (_, true) => self.direction(&psis, at),
                    (Mode::Above, false) => self.between.division.graph.number(1.0),
                    (Mode::Below, false) => self.between.division.graph.number(-1.0),
                };
            }
            next += if *mode == Mode::Held { psis.len() } else { 0 };
        }
        meanings
    }

    /// A component of `psi/|psi|`.
    fn direction(&mut self, psis: &[ExprId], at: usize) -> ExprId {
        let graph = &mut self.between.division.graph;
        let squares: Vec<ExprId> = psis.iter().map(|psi| graph.square(*psi)).collect();
        let sum = graph.sum(&squares);
        let length = graph.sqrt(sum);
        graph.div(psis[at], length)
    }

    pub(super) fn with_selectors(&mut self, value: ExprId, meanings: &[ExprId]) -> ExprId {
        let symbols = &self.between.division.model.symbols;
        let meaning = |at: u32| match symbols.get(at as usize) {
            Some(Symbol::Selector(surface)) => meanings.get(*surface).copied(),
            _ => None,
        };
        self.between.division.graph.substitute(&[value], &meaning)[0]
    }

    fn states(&mut self, j: usize, meanings: &[ExprId]) -> Vec<State> {
        let model = self.between.division.model;
        let guesses = straight_guesses(model, &mut self.between.division.graph);
        let unbounded = self.unbounded();
        let of = |(at, (state, guess)): (usize, (&State, ExprId))| State {
            range: unbounded,
            start: state.start.filter(|_| j == 0),
            start_range: state.start_range.filter(|_| j == 0),
            rate: match self.between.is_still(j, at) {
                true => self.between.division.graph.number(0.0),
                false => self.with_selectors(state.rate, meanings),
            },
            guess: Some(guess),
            ..state.clone()
        };
        model.states.iter().zip(guesses).enumerate().map(of).collect()
    }

    fn integrals(&mut self, shares: &Shares, meanings: &[ExprId]) -> Vec<Integral> {
        let mut integrals = self.between.division.model.integrals.clone();
        for integral in &mut integrals {
            integral.integrand = self.with_selectors(integral.integrand, meanings);
        }
        shares.integrals.iter().for_each(|at| integrals[*at].is_linked = true);
        integrals
    }

    fn sums(&mut self, j: usize, meanings: &[ExprId]) -> Vec<Sum> {
        let mut sums = self.between.division.sums(j);
        sums.iter_mut().for_each(|it| it.term = self.with_selectors(it.term, meanings));
        sums
    }

    fn report(&mut self, meanings: &[ExprId]) -> Vec<Report> {
        let mut report = self.between.division.model.report.clone();
        report.iter_mut().for_each(|it| it.value = self.with_selectors(it.value, meanings));
        report
    }

    /// Those of the model, then the selectors that are chosen.
    pub(super) fn controls(&mut self, of: &PhaseOfModes) -> Vec<Control> {
        let model = self.between.division.model;
        let of_arc = |(control, arc): (&Control, &Arc)| Control {
            range: on_arc(control, *arc),
            ..control.clone()
        };
        let mut controls: Vec<Control> = model.controls.iter().zip(&of.arcs).map(of_arc).collect();
        let [lower, upper] = [-1.0, 1.0].map(|it| self.between.division.graph.number(it));
        for (switch, mode) in model.switches().iter().zip(&of.modes) {
            if *mode == Mode::Held {
                let chosen = model.surfaces[switch.surfaces.clone()].iter().map(|it| Control {
                    place: Place { name: format!("s({})", it.place.name), ..it.place.clone() },
                    range: Range { lower, upper },
                    guess: Some(self.between.division.graph.number(0.0)),
                });
                controls.extend(chosen);
            }
        }
        controls
    }

    /// What is written, then what the modes add, then what the jumps add, then bounds of states.
    pub(super) fn path(
        &mut self,
        j: usize,
        states: &[State],
        meanings: &[ExprId],
    ) -> Vec<Constraint> {
        let model = self.between.division.model;
        let written = model.path.iter().map(|row| Constraint {
            value: self.with_selectors(row.value, meanings),
            ..row.clone()
        });
        let mut rows: Vec<Constraint> = written.collect();
        let moving = Model { states: states.to_vec(), ..model.clone() };
        let of = &self.phases[j];
        for (switch, mode) in model.switches().iter().zip(&of.modes) {
            let surfaces = &model.surfaces[switch.surfaces.clone()];
            let range = match mode {
                Mode::Held => self.between.division.exactly_zero(),
                Mode::Above => self.between.division.not_below(),
                Mode::Below => self.between.division.not_above(),
            };
            for surface in surfaces.iter().filter(|_| *mode == Mode::Held || !switch.is_ball) {
                let value = match mode {
                    Mode::Held => approach(&moving, &mut self.between.division.graph, surface.psi),
                    _ => surface.psi,
                };
                rows.push(Constraint { place: surface.place.clone(), value, range });
            }
            if *mode == Mode::Held && switch.is_ball {
                rows.push(self.within_ball(switch.place, &meanings[switch.surfaces.clone()]));
            }
        }
        rows.extend(self.between.sides(j));
        self.limit(of, &moving, &mut rows);
        for row in &mut rows {
            self.between.give_way(j, row);
        }
        rows
    }

    /// `|s| <= 1`
    pub(super) fn within_ball(&mut self, place: &Place, selectors: &[ExprId]) -> Constraint {
        let graph = &mut self.between.division.graph;
        let squares: Vec<ExprId> = selectors.iter().map(|it| graph.square(*it)).collect();
        let [lower, upper] = [f64::NEG_INFINITY, 1.0].map(|it| graph.number(it));
        Constraint {
            place: place.clone(),
            value: graph.sum(&squares),
            range: Range { lower, upper },
        }
    }
}
