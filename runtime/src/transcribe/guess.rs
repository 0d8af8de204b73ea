//! The model's guess on the grid.

use super::TranscribedNlp;
use super::interval::Signal;
use crate::linalg::dense::lu::Lu;
use crate::nlp::Nlp;
use crate::problem::Columns;

impl TranscribedNlp<'_> {
    /// The model's guess on the grid; running integrals are those of the guess.
    pub fn guess(&mut self) -> Vec<f64> {
        let mut v = self.guessed();
        let hidden: Vec<usize> =
            (0..self.problem.layout.x).filter(|&i| self.problem.states[i].hidden).collect();
        if !hidden.is_empty() {
            let mut rows = vec![0.0; self.constraint_bounds.len()];
            self.values(&v, &mut rows);
            hidden.into_iter().for_each(|state| self.integrate(state, &rows, &mut v));
        }
        v
    }

    fn guessed(&self) -> Vec<f64> {
        let stages = self.stages;
        let slots = &self.interval.slots;
        let mut v = vec![0.0; stages.variables()];
        let mut table = (f64::NAN, Columns::default());
        for (place, slot) in slots.iter().enumerate() {
            if table.0 != slot.time {
                table = (slot.time, self.guess_at(slot.time));
            }
            let column = table.1.column(match slot.signal {
                Signal::State(i) => i,
                Signal::Control(i) => self.problem.layout.x + i,
            });
            // Only what is carried has a value at the last grid point.
            let count = stages.intervals + usize::from(place < stages.states);
            let variables = v[place..].iter_mut().step_by(slots.len());
            for (variable, value) in variables.zip(&column[..count]) {
                *variable = if value.is_finite() { *value } else { 0.0 };
            }
        }
        for (variable, unknown) in stages.globals().zip(&self.problem.unknowns) {
            v[variable] = self.parameters[unknown.parameter];
        }
        v
    }

    /// States and controls of the guess at this time of each interval, and beyond the last.
    fn guess_at(&self, time: f64) -> Columns {
        let (guess, intervals) = (&self.problem.guess, self.stages.intervals);
        let mut points = Columns::new(guess.layout().point_inputs(), intervals + 1);
        for (k, tau) in points.column_mut(0).iter_mut().enumerate() {
            *tau = self.mesh.at(k, time);
        }
        let mut values = Columns::new(guess.outputs(), intervals + 1);
        guess.value(&points, &self.parameters, &mut values);
        values
    }

    /// Gives a state on which no right side depends the values that make its defects 0. These are
    /// linear in it,
    ///
    /// ```text
    ///     rows + B (change of x_k) + A (change of y_k, x_{k+1}) = 0
    /// ```
    fn integrate(&self, state: usize, rows: &[f64], v: &mut [f64]) {
        let (stages, states) = (self.stages, self.problem.layout.x);
        let step = stages.variable_step();
        let first_inner = stages.states + stages.controls;
        let places: Vec<usize> =
            (first_inner..step).chain([step]).step_by(states).map(|it| it + state).collect();
        let size = places.len();
        let (mut a, mut b) = (vec![0.0; size * size], vec![0.0; size]);
        let own = |row: usize| row % states == state && row < size * states;
        for link in self.interval.links.iter().filter(|link| own(link.row)) {
            match places.iter().position(|place| *place == link.place) {
                Some(column) => a[link.row / states * size + column] += link.value,
                None => b[link.row / states] += link.value,
            }
        }
        let mut factors = Lu::new(size);
        assert!(factors.factor(size, &a), "the defects of a scheme determine its states");
        let mut change = 0.0;
        for k in 0..stages.intervals {
            let residual = |block: usize| rows[stages.defects(k).start + block * states + state];
            let known =
                |block: usize| if residual(block).is_finite() { residual(block) } else { 0.0 };
            let mut changes: Vec<f64> =
                (0..size).map(|block| -known(block) - b[block] * change).collect();
            factors.solve(size, &mut changes, 1);
            for (place, change) in places.iter().zip(&changes) {
                v[stages.state(k).start + place] += change;
            }
            change = changes[size - 1];
        }
    }
}
