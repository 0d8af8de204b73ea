//! The objective and the conditions of the whole, each part where it belongs: what reads one phase
//! becomes a part of that phase, what reads several a link.

use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{ById, Expr, ExprId, Graph};
use crate::expressions::polynomial::difference;
use crate::model::phases::{Symbols, moved};
use crate::model::{Constraint, Expectation, Link, Model, Symbol};
use fdcc_runtime::problem::End;
use std::collections::HashSet;

/// How many phases an expression reads.
#[derive(Clone, Copy, PartialEq)]
enum Reads {
    None,
    One(usize),
    Several,
}

impl Reads {
    fn and(self, other: Reads) -> Reads {
        match (self, other) {
            (Reads::None, it) | (it, Reads::None) => it,
            (a, b) if a == b => a,
            _ => Reads::Several,
        }
    }
}

/// Gives each phase its part of the objective and the conditions that read it alone.
pub(crate) fn distribute(model: &mut Model) {
    if model.phases.is_empty() {
        return;
    }
    let mut phases = std::mem::take(&mut model.phases);
    for phase in &mut phases {
        model.share_parameters(&mut phase.model);
    }
    model.phases = phases;
    let unknowns: Vec<HashSet<u32>> = (0..model.phases.len()).map(|at| model.read_by(at)).collect();
    model.distribute_objective(&unknowns);
    model.distribute_conditions(&unknowns);
    model.collect_expectations();
    model.keep_linked_integrals();
}

impl Model {
    /// The unknowns that a phase depends on, as inputs of the whole.
    fn read_by(&mut self, phase: usize) -> HashSet<u32> {
        let phase = &mut self.phases[phase].model;
        let [first, last] = phase.interval;
        let duration = difference(&mut phase.graph, last, first);
        let mut roots = vec![duration];
        roots.extend(phase.states.iter().map(|it| it.rate));
        roots.extend(phase.states.iter().filter_map(|it| it.start));
        roots.extend(phase.path.iter().chain(&phase.boundary).map(|it| it.value));
        roots.extend(phase.integrals.iter().map(|it| it.integrand));
        let inputs = phase.graph.inputs_of(&roots);
        let is_time = |at: &u32| phase.symbols[*at as usize] == Symbol::Time;
        let mut inputs: HashSet<u32> = inputs.into_iter().collect();
        if inputs.iter().any(is_time) {
            inputs.extend(phase.graph.inputs_of(&[first]));
        }
        let symbols = inputs.into_iter().map(|at| phase.symbols[at as usize]);
        let unknowns: Vec<Symbol> = symbols.filter(|it| matches!(it, Symbol::Free(_))).collect();
        unknowns.into_iter().filter_map(|unknown| self.input_of(unknown)).collect()
    }

    fn distribute_objective(&mut self, unknowns: &[HashSet<u32>]) {
        let Some((place, value)) = self.objective.clone() else {
            let own = self.phases.iter().find(|it| it.model.objective.is_some());
            self.sense = own.map_or(self.sense, |it| it.model.sense);
            return;
        };
        let mut shares: Vec<Vec<ExprId>> = vec![Vec::new(); self.phases.len()];
        for term in self.terms(value) {
            match self.owner(term, unknowns) {
                Some(phase) => shares[phase].push(term),
                None => {
                    let link = self.link_of(term);
                    let sum = self.links[link].objective.into_iter().chain([term]);
                    let sum = self.graph.sum(&sum.collect::<Vec<_>>());
                    self.links[link].objective = Some(sum);
                }
            }
        }
        for (phase, share) in shares.into_iter().enumerate().filter(|it| !it.1.is_empty()) {
            let sum = self.graph.sum(&share);
            let own = self.copy_into(phase, sum);
            self.phases[phase].model.objective = Some((place.clone(), own));
        }
        let sense = self.sense;
        self.phases.iter_mut().for_each(|phase| phase.model.sense = sense);
    }

    fn distribute_conditions(&mut self, unknowns: &[HashSet<u32>]) {
        for row in std::mem::take(&mut self.boundary) {
            match self.owner(row.value, unknowns) {
                Some(phase) => {
                    let value = self.copy_into(phase, row.value);
                    let range = moved(row.range, &mut |bound| self.copy_into(phase, bound));
                    let row = Constraint { value, range, ..row };
                    self.phases[phase].model.boundary.push(row);
                }
                None => {
                    let link = self.link_of(row.value);
                    self.links[link].rows.push(row);
                }
            }
        }
    }

    /// The link to which an expression belongs: one that reads the same ends, or the same unknowns
    /// where it reads no end.
    fn link_of(&mut self, value: ExprId) -> usize {
        let ends = self.ends_read(value);
        let unknowns = self.unknowns_in(&[value]);
        let reads_all = |link: &Link| {
            let rows: Vec<ExprId> = link.rows.iter().map(|row| row.value).collect();
            let own = self.unknowns_in(&rows);
            unknowns.iter().all(|unknown| own.contains(unknown))
        };
        let is_of = |link: &Link| link.ends == ends || ends.is_empty() && reads_all(link);
        self.links.iter().position(is_of).unwrap_or_else(|| {
            self.links.push(Link { ends, objective: None, rows: Vec::new() });
            self.links.len() - 1
        })
    }

    fn unknowns_in(&self, values: &[ExprId]) -> Vec<u32> {
        let is_free = |at: &u32| matches!(self.symbols[*at as usize], Symbol::Free(_));
        self.graph.inputs_of(values).into_iter().filter(is_free).collect()
    }

    /// The ends of phases that an expression reads, in the order of the phases.
    pub(crate) fn ends_read(&self, value: ExprId) -> Vec<End> {
        let mut ends: Vec<(usize, bool)> = Vec::new();
        for input in self.graph.inputs_of(&[value]) {
            let Symbol::OfPhase { phase, input } = self.symbols[input as usize] else { continue };
            let symbol = self.phases[phase].model.symbols[input as usize];
            ends.push((phase, !matches!(symbol, Symbol::AtStart(_))));
        }
        ends.sort_unstable();
        ends.dedup();
        let end = |(phase, is_last)| if is_last { End::Last(phase) } else { End::First(phase) };
        ends.into_iter().map(end).collect()
    }

    /// The phase to which an expression belongs: the one that it reads, or the first one that
    /// depends on all its unknowns.
    fn owner(&self, value: ExprId, unknowns: &[HashSet<u32>]) -> Option<usize> {
        match self.reads(&[value])[&value] {
            Reads::One(phase) => Some(phase),
            Reads::Several => None,
            Reads::None => {
                let all = self.unknowns_in(&[value]);
                unknowns.iter().position(|own| all.iter().all(|it| own.contains(it)))
            }
        }
    }

    /// How many phases each expression below some roots reads.
    fn reads(&self, roots: &[ExprId]) -> ById<Reads> {
        let mut reads: ById<Reads> = ById::default();
        for id in self.graph.reachable(roots) {
            let read = match self.graph.expr(id) {
                Expr::Input(input) => match self.symbols[*input as usize] {
                    Symbol::OfPhase { phase, .. } => Reads::One(phase),
                    _ => Reads::None,
                },
                Expr::Call(_, operands) => {
                    operands.iter().fold(Reads::None, |all, it| all.and(reads[it]))
                }
                _ => Reads::None,
            };
            reads.insert(id, read);
        }
        reads
    }

    /// The terms of a sum, multiplied out as far as several phases stand in one product.
    fn terms(&mut self, value: ExprId) -> Vec<ExprId> {
        let reads = self.reads(&[value]);
        let graph = &mut self.graph;
        let mut open = vec![(graph.number(1.0), value)];
        let mut terms = Vec::new();
        while let Some((factor, id)) = open.pop() {
            match (is_sum(graph, id), product(graph, id)) {
                (Some([a, b]), _) => {
                    let second = match graph.as_call(id, Builtin::Sub) {
                        Some(_) => graph.neg(factor),
                        None => factor,
                    };
                    open.extend([(second, b), (factor, a)]);
                }
                (_, Some([a, b])) if reads[&id] == Reads::Several && reads[&a] == Reads::None => {
                    let factor = graph.mul(factor, a);
                    open.push((factor, b));
                }
                (_, Some([a, b])) if reads[&id] == Reads::Several && reads[&b] == Reads::None => {
                    let factor = graph.mul(factor, b);
                    open.push((factor, a));
                }
                _ => match graph.as_call(id, Builtin::Neg).map(|it| it[0]) {
                    Some(inner) => {
                        let factor = graph.neg(factor);
                        open.push((factor, inner));
                    }
                    None => terms.push(graph.mul(factor, id)),
                },
            }
        }
        terms
    }

    /// What phases expect of themselves, over the symbols of the whole; not what only a simulation
    /// of a phase can tell.
    fn collect_expectations(&mut self) {
        let Model { phases, graph, symbols, expectations, .. } = self;
        for (at, phase) in phases.iter_mut().enumerate() {
            let Model { graph: own, symbols: meanings, expectations: asked, .. } = &mut phase.model;
            let is_told = |it: &Expectation| {
                let simulated = |at: &u32| matches!(meanings[*at as usize], Symbol::Simulated(_));
                !own.inputs_of(&it.values).iter().any(simulated)
            };
            let told: Vec<Expectation>;
            (told, *asked) = std::mem::take(asked).into_iter().partition(is_told);
            let mut known = ById::default();
            for expectation in told {
                let mut whole = Symbols { graph, symbols };
                let values = whole.take_of(at, (own, meanings), &expectation.values, &mut known);
                let values = values.try_into().expect("three values are copied");
                expectations.push(Expectation { values, ..expectation });
            }
        }
        expectations.sort_by_key(|it| it.place.span);
    }

    fn copy_into(&mut self, phase: usize, value: ExprId) -> ExprId {
        let Model { phases, graph, symbols, .. } = self;
        phases[phase].model.symbols_mut().take(graph, symbols, &[value])[0]
    }

    /// Notes which integrals of phases are read by links.
    fn keep_linked_integrals(&mut self) {
        let rows = self.links.iter().flat_map(|link| link.rows.iter().map(|row| row.value));
        let parts = self.links.iter().filter_map(|link| link.objective);
        let read: Vec<ExprId> = rows.chain(parts).collect();
        for input in self.graph.inputs_of(&read) {
            let Symbol::OfPhase { phase, input } = self.symbols[input as usize] else { continue };
            let phase = &mut self.phases[phase].model;
            if let Symbol::Integral(at) = phase.symbols[input as usize] {
                phase.integrals[at].is_linked = true;
            }
        }
    }
}

fn is_sum(graph: &Graph, id: ExprId) -> Option<[ExprId; 2]> {
    let operands = graph.as_call(id, Builtin::Add).or_else(|| graph.as_call(id, Builtin::Sub))?;
    Some([operands[0], operands[1]])
}

fn product(graph: &Graph, id: ExprId) -> Option<[ExprId; 2]> {
    graph.as_call(id, Builtin::Mul).map(|operands| [operands[0], operands[1]])
}
