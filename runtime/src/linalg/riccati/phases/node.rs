//! What stands between two phases: a small dense system.
//!
//! ```text
//!     [ E   C' ] [ e ]     [ g_e ]          e = -y - W k,    E y = g_e,    E W = C'
//!     [ C   K  ] [ k ]  +  [ g_k ]          V(k) = 1/2 k' (K - C W) k + (g_k - C y)' k
//! ```
//!
//! `e` is what is eliminated: the first state of the phase behind, and the members of the border
//! that die here; `k` is what is kept: the last state of the phase before, and its border.

use super::direct::Direct;
use super::lifetimes::{Item, Lifetimes};
use crate::linalg::dense::symmetric::SymmetricFactor;
use crate::linalg::structure::phases::PhaseStages;

/// An answer of this size, times that of the entries, leaves half of the digits.
const LARGEST: f64 = 1e8;

/// `matrix[target] += sum of values[from .. from + count]`
struct Added {
    is_hessian: bool,
    from: usize,
    count: usize,
    targets: [usize; 2],
}

/// A node, with its memory.
pub(super) struct Node {
    /// How much is eliminated.
    eliminated: usize,
    /// What is there, by its place among all variables, or else among all rows.
    places: Vec<NodeEntry>,
    /// Where the value function of the phase behind has its parts here.
    arrives: Vec<usize>,
    added: Vec<Added>,
    /// Eliminated variables that are fixed.
    fixed: Vec<usize>,
    matrix: Vec<f64>,
    corner: Vec<f64>,
    factor: SymmetricFactor,
    /// `W`, row by row.
    response: Vec<f64>,
    /// `(e, k)`: a gradient, then values.
    vector: Vec<f64>,
    /// `y`
    forced: Vec<f64>,
}

#[derive(Clone, Copy, PartialEq)]
enum NodeEntry {
    Variable(usize),
    Row(usize),
    /// Its diagonal and right side belong to the stages or to another node.
    Elsewhere(usize),
}

impl Node {
    pub fn new(
        j: usize,
        phases: &[PhaseStages],
        lifetimes: &Lifetimes,
        direct: &[Direct],
        fixed: &[bool],
    ) -> Self {
        let first = |phase: usize| -> Vec<Item> {
            (0..phases[phase].stages.states).map(|i| Item::First(phase, i)).collect()
        };
        let mut items = if j < phases.len() { first(j) } else { Vec::new() };
        items.extend(lifetimes.dying(j));
        let eliminated = items.len();
        if j > 0 {
            let states = 0..phases[j - 1].stages.states;
            items.extend(states.map(|i| Item::Last(j - 1, i)));
            items.extend(lifetimes.theta(j - 1));
        }
        let position = |item: Item| items.iter().position(|it| *it == item);
        let arrives = match phases.get(j) {
            Some(_) => first(j).into_iter().chain(lifetimes.theta(j)).collect(),
            None => Vec::new(),
        };
        let arrives = arrives.into_iter().map(|item| position(item).expect("it is carried on"));
        let size = items.len();
        let here = direct.iter().filter(|entry| entry.count > 0);
        let here = here.filter(|entry| lifetimes.place(entry, phases.len()) == Some(j));
        let added = here.filter_map(|entry| {
            let (i, k) = (position(entry.first)?, position(entry.second)?);
            let targets = [i * size + k, k * size + i];
            let Direct { is_hessian, from, count, .. } = *entry;
            Some(Added { is_hessian, from, count, targets })
        });
        let place = |(at, item): (usize, &Item)| match *item {
            Item::First(phase, i) => NodeEntry::Elsewhere(phases[phase].first().start + i),
            Item::Last(phase, i) => NodeEntry::Variable(phases[phase].last().start + i),
            Item::Unknown(variable) if at < eliminated => NodeEntry::Variable(variable),
            Item::Row(row) if at < eliminated => NodeEntry::Row(row),
            Item::Unknown(at) | Item::Row(at) | Item::Stages(at) => NodeEntry::Elsewhere(at),
        };
        let is_fixed = |item: &Item| match *item {
            Item::First(phase, i) => fixed[phases[phase].first().start + i],
            Item::Unknown(variable) => fixed[variable],
            _ => false,
        };
        Node {
            eliminated,
            arrives: arrives.collect(),
            added: added.collect(),
            fixed: (0..eliminated).filter(|at| is_fixed(&items[*at])).collect(),
            places: items.iter().enumerate().map(place).collect(),
            matrix: vec![0.0; size * size],
            corner: vec![0.0; eliminated * eliminated],
            factor: SymmetricFactor::new(eliminated),
            response: vec![0.0; eliminated * (size - eliminated)],
            vector: vec![0.0; size],
            forced: vec![0.0; eliminated],
        }
    }

    fn size(&self) -> usize {
        self.places.len()
    }

    fn kept(&self) -> usize {
        self.size() - self.eliminated
    }

    /// Puts the value function of the phase behind together with the entries of this node.
    pub fn assemble(&mut self, arrived: Option<&[f64]>, hessian: &[f64], jacobian: &[f64]) {
        let size = self.size();
        self.matrix.fill(0.0);
        if let Some(value) = arrived {
            for (row, i) in value.chunks_exact(self.arrives.len()).zip(&self.arrives) {
                for (value, k) in row.iter().zip(&self.arrives) {
                    self.matrix[i * size + k] += value;
                }
            }
        }
        for added in &self.added {
            let values = if added.is_hessian { hessian } else { jacobian };
            let sum: f64 = values[added.from..][..added.count].iter().sum();
            let [target, mirrored] = added.targets;
            self.matrix[target] += sum;
            if target != mirrored {
                self.matrix[mirrored] += sum;
            }
        }
    }

    pub fn add_diagonals(&mut self, sigma: &[f64], d: &[f64]) {
        let size = self.size();
        for (at, place) in self.places.iter().enumerate() {
            self.matrix[at * size + at] += match *place {
                NodeEntry::Variable(variable) => sigma[variable],
                NodeEntry::Row(row) => -d[row],
                NodeEntry::Elsewhere(_) => 0.0,
            };
        }
        for &at in &self.fixed {
            for other in 0..size {
                self.matrix[at * size + other] = 0.0;
                self.matrix[other * size + at] = 0.0;
            }
            self.matrix[at * size + at] = 1.0;
        }
    }

    /// Whether the elimination left enough digits.
    pub fn is_sound(&self) -> bool {
        let size = self.matrix.iter().fold(1.0, |size: f64, entry| size.max(entry.abs()));
        self.response.iter().all(|w| w.abs() <= LARGEST * size)
    }

    /// Eliminates; the number of negative eigenvalues, or nothing where that is impossible.
    pub fn eliminate(&mut self) -> Option<usize> {
        let (size, many, kept) = (self.size(), self.eliminated, self.kept());
        for i in 0..many {
            let row = &self.matrix[i * size..][..size];
            self.corner[i * many..][..many].copy_from_slice(&row[..many]);
            self.response[i * kept..][..kept].copy_from_slice(&row[many..]);
        }
        let negative = self.factor.factor(&self.corner)?;
        self.factor.solve(&mut self.response, kept);
        for i in 0..kept {
            for e in 0..many {
                let across = self.matrix[(many + i) * size + e];
                if across != 0.0 {
                    let row = &mut self.matrix[(many + i) * size + many..][..kept];
                    let response = &self.response[e * kept..][..kept];
                    row.iter_mut().zip(response).for_each(|(value, w)| *value -= across * w);
                }
            }
        }
        Some(negative)
    }

    /// The value function of what is kept.
    pub fn write(&self, value: &mut [f64]) {
        let (size, many, kept) = (self.size(), self.eliminated, self.kept());
        for (i, row) in value.chunks_exact_mut(kept).enumerate() {
            row.copy_from_slice(&self.matrix[(many + i) * size + many..][..kept]);
        }
    }

    /// The same for gradients.
    pub fn reduce(&mut self, arrived: Option<&[f64]>, a: &[f64], b: &[f64]) {
        let (many, kept) = (self.eliminated, self.kept());
        for (value, place) in self.vector.iter_mut().zip(&self.places) {
            *value = match *place {
                NodeEntry::Variable(variable) => -a[variable],
                NodeEntry::Row(row) => -b[row],
                NodeEntry::Elsewhere(_) => 0.0,
            };
        }
        for (value, at) in arrived.unwrap_or_default().iter().zip(&self.arrives) {
            self.vector[*at] += value;
        }
        self.fixed.iter().for_each(|at| self.vector[*at] = 0.0);
        let (eliminated, rest) = self.vector.split_at_mut(many);
        for (gradient, response) in eliminated.iter().zip(self.response.chunks_exact(kept.max(1))) {
            rest.iter_mut().zip(response).for_each(|(value, w)| *value -= gradient * w);
        }
        self.forced.copy_from_slice(eliminated);
        self.factor.solve(&mut self.forced, 1);
    }

    pub fn write_gradient(&self, gradient: &mut [f64]) {
        gradient.copy_from_slice(&self.vector[self.eliminated..]);
    }

    /// What was eliminated, from what was kept; unknowns and multipliers go to their places.
    pub fn expand(&mut self, state: &[f64], a: &mut [f64], b: &mut [f64]) {
        let (many, kept) = (self.eliminated, self.kept());
        for e in 0..many {
            let response = &self.response[e * kept..][..kept];
            let follows: f64 = response.iter().zip(state).map(|(w, value)| w * value).sum();
            self.vector[e] = -self.forced[e] - follows;
        }
        self.vector[many..].copy_from_slice(state);
        for (value, place) in self.vector[..many].iter().zip(&self.places) {
            match *place {
                NodeEntry::Variable(variable) => a[variable] = *value,
                NodeEntry::Row(row) => b[row] = *value,
                NodeEntry::Elsewhere(_) => {}
            }
        }
    }

    /// First state and border of the phase behind.
    pub fn write_state(&self, state: &mut [f64]) {
        for (value, at) in state.iter_mut().zip(&self.arrives) {
            *value = self.vector[*at];
        }
    }
}
