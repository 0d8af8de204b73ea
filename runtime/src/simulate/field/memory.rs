//! Memory of the right side, and the linear system of the sliding selectors in it.
//!
//! ```text
//! B change = r,   r = d_A f + psi_t,   B = -d_A df/ds_A,   A: the sliding surfaces
//! ```

use crate::linalg::dense::lu::Lu;
use crate::problem::Columns;
use crate::simulate::mode::Mode;
use crate::simulate::system::System;

/// An entry of a Jacobian: where it stands, and in which column of the table.
#[derive(Clone, Copy, Debug)]
struct Entry {
    row: usize,
    input: usize,
    at: usize,
}

/// Tables for one point.
pub(crate) struct Memory {
    pub flow: Columns,
    pub by_inputs: Columns,
    pub psi: Columns,
    pub normals: Columns,
    /// The sliding surfaces.
    pub sliding: Vec<usize>,
    /// What is added to their selectors.
    pub change: Vec<f64>,
    /// The place of a surface among those that slide.
    place: Vec<Option<usize>>,
    /// `df/ds` by state and surface.
    by_selectors: Vec<Entry>,
    /// `dpsi/d(t, x)`.
    slopes: Vec<Entry>,
    /// `B`, row by row.
    matrix: Vec<f64>,
    lu: Lu,
}

impl Memory {
    pub fn new(system: &System) -> Self {
        let (flow, switching) =
            (system.flow.jacobian_pattern(), system.switching.jacobian_pattern());
        let entry = |(at, &(row, input)): (usize, &(u32, u32))| Entry {
            row: row as usize,
            input: input as usize,
            at,
        };
        let selectors = system.layout.selectors();
        let inputs = 0..system.layout.states().end;
        let by_selectors =
            flow.entries.iter().enumerate().map(entry).filter(|it| selectors.contains(&it.input));
        let by_selectors = by_selectors.map(|it| Entry { input: it.input - selectors.start, ..it });
        let slopes =
            switching.entries.iter().enumerate().map(entry).filter(|it| inputs.contains(&it.input));
        Memory {
            flow: Columns::new(system.flow.outputs(), 1),
            by_inputs: Columns::new(flow.entries.len(), 1),
            psi: Columns::new(system.switching.outputs(), 1),
            normals: Columns::new(switching.entries.len(), 1),
            sliding: Vec::new(),
            change: Vec::new(),
            place: vec![None; system.surfaces.len()],
            by_selectors: by_selectors.collect(),
            slopes: slopes.collect(),
            matrix: Vec::new(),
            lu: Lu::default(),
        }
    }

    /// From now on these surfaces slide.
    pub fn slide_on(&mut self, modes: &[Mode]) {
        self.sliding.clear();
        self.sliding.extend((0..modes.len()).filter(|&i| modes[i] == Mode::Sliding));
        self.place.fill(None);
        self.sliding.iter().enumerate().for_each(|(place, &i)| self.place[i] = Some(place));
        let size = self.sliding.len();
        if self.change.len() != size {
            self.change = vec![0.0; size];
            self.matrix = vec![0.0; size * size];
            self.lu = Lu::new(size);
        }
    }

    /// Solves for the change of the selectors; `false` if it has no solution.
    pub fn solve(&mut self, system: &System, rate: &[f64], held: &[usize]) -> bool {
        let size = self.change.len();
        self.change.fill(0.0);
        self.matrix.fill(0.0);
        let first = system.layout.states().start;
        for slope in &self.slopes {
            let Some(row) = self.place[slope.row] else { continue };
            let value = self.normals.column(slope.at)[0];
            let Some(state) = slope.input.checked_sub(first) else {
                self.change[row] += value;
                continue;
            };
            self.change[row] += value * rate[state];
            for entry in
                self.by_selectors.iter().filter(|it| it.row == state && !held.contains(&state))
            {
                if let Some(column) = self.place[entry.input] {
                    self.matrix[row * size + column] -= value * self.by_inputs.column(entry.at)[0];
                }
            }
        }
        let is_regular = self.lu.factor(size, &self.matrix);
        if is_regular {
            self.lu.solve(size, &mut self.change, 1);
        }
        is_regular && self.change.iter().all(|value| value.is_finite())
    }

    /// Adds to a rate what the change of the selectors makes of it.
    pub fn follow(&self, rate: &mut [f64], held: &[usize]) {
        for entry in self.by_selectors.iter().filter(|it| !held.contains(&it.row)) {
            if let Some(place) = self.place[entry.input] {
                rate[entry.row] += self.by_inputs.column(entry.at)[0] * self.change[place];
            }
        }
    }
}
