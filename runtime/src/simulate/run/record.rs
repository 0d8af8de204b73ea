//! The trajectory while it is made: all steps, or the times asked for.

use crate::simulate::result::{Event, Options, Order};

/// Times and states so far.
pub(crate) struct Record {
    pub time: Vec<f64>,
    pub states: Vec<Vec<f64>>,
    pub events: Vec<Event>,
    pub orders: Vec<Order>,
    /// The least and the greatest that each state has been.
    extremes: Vec<[f64; 2]>,
    wanted: Vec<f64>,
    /// How many of the wanted times are past.
    past: usize,
}

impl Record {
    pub fn new(options: &Options, states: usize) -> Self {
        Record {
            time: Vec::new(),
            states: vec![Vec::new(); states],
            events: Vec::new(),
            orders: Vec::new(),
            extremes: vec![[f64::INFINITY, f64::NEG_INFINITY]; states],
            wanted: options.times.clone(),
            past: 0,
        }
    }

    /// How many numbers there are so far.
    pub fn size(&self) -> usize {
        self.time.len() * (1 + self.states.len()) + self.events.len() * (2 + 2 * self.states.len())
    }

    fn push(&mut self, t: f64, x: &[f64]) {
        self.time.push(t);
        self.states.iter_mut().zip(x).for_each(|(column, value)| column.push(*value));
    }

    /// A point of the trajectory, noted unless other times are asked for.
    pub fn point(&mut self, t: f64, x: &[f64]) {
        let is_same = self.time.last() == Some(&t)
            && self.states.iter().zip(x).all(|(column, value)| column.last() == Some(value));
        if self.wanted.is_empty() && !is_same {
            self.push(t, x);
        }
    }

    /// Notes that these states have been.
    pub fn widen(&mut self, states: &[Vec<f64>]) {
        for state in states {
            for ([low, high], value) in self.extremes.iter_mut().zip(state) {
                (*low, *high) = (low.min(*value), high.max(*value));
            }
        }
    }

    /// How far each state has moved.
    pub fn extents(&self) -> impl Iterator<Item = f64> + '_ {
        self.extremes.iter().map(|[low, high]| high - low)
    }

    /// The wanted times before a time, with the states that are given for them.
    pub fn inside(&mut self, until: f64, state: &mut dyn FnMut(f64) -> Vec<f64>) {
        while let Some(&wanted) = self.wanted.get(self.past).filter(|wanted| **wanted < until) {
            self.push(wanted, &state(wanted));
            self.past += 1;
        }
    }

    /// The wanted times that are reached at the end.
    pub fn last(&mut self, t: f64, x: &[f64]) {
        while self.wanted.get(self.past).is_some_and(|wanted| *wanted <= t) {
            self.push(self.wanted[self.past], x);
            self.past += 1;
        }
    }
}
