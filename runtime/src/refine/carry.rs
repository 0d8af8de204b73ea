//! A solution on a grid as the start on a finer one that divides its intervals.
//!
//! States are interpolated linearly, controls are what they are. The multiplier of a step is the costate, on every grid; that of a path constraint
//! or bound stands for a piece of time, and is shared by the parts.

use crate::nlp::{Multipliers, Solution, Start, Warm};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::{Combination, Signal};

/// The start on `to`, each interval of which is one of the `parts` of an interval of `from`.
pub(super) fn carried(
    from: &TranscribedNlp,
    solution: &Solution,
    to: &TranscribedNlp,
    parts: &[usize],
) -> Start {
    let carry = Carry { from, to, places: places(parts) };
    let near = Start::near(solution);
    let warm = near.warm.map(|Warm { multipliers, mu }| {
        let multipliers = Multipliers {
            rows: carry.rows(&multipliers.rows),
            lower: carry.bounds(&multipliers.lower),
            upper: carry.bounds(&multipliers.upper),
        };
        Warm { multipliers, mu }
    });
    Start { v: carry.values(&solution.v), warm }
}

/// The interval that each part is in, and which of its parts it is.
fn places(parts: &[usize]) -> Vec<Place> {
    let all = parts.iter().enumerate();
    all.flat_map(|(interval, &parts)| (0..parts).map(move |part| Place { interval, part, parts })).collect()
}

#[derive(Clone, Copy)]
struct Place {
    interval: usize,
    part: usize,
    parts: usize,
}

struct Carry<'a> {
    from: &'a TranscribedNlp<'a>,
    to: &'a TranscribedNlp<'a>,
    places: Vec<Place>,
}

impl Carry<'_> {
    /// What the old solution was at a time of a new interval; beyond the last one, at its end.
    fn signal(&self, signal: Signal, k: usize, time: f64, v: &[f64]) -> f64 {
        let (place, time) = match self.places.get(k) {
            Some(place) => (*place, time),
            None => (self.places[k - 1], 1.0),
        };
        let fraction = (place.part as f64 + time) / place.parts as f64;
        let first = self.from.chain().state(place.interval).start;
        let value = |combination: &Combination| -> f64 {
            combination.iter().map(|(at, factor)| factor * v[first + at]).sum()
        };
        let interval = self.from.interval();
        match signal {
            Signal::Control(i) => value(&interval.controls_at(fraction)[i]),
            Signal::State(i) => {
                (1.0 - fraction) * value(&interval.start.states[i])
                    + fraction * value(&interval.end.states[i])
            }
        }
    }

    /// Calls `action` with each variable of the new grid but the unknowns: itself, the place of its interval and its slot.
    fn each(&self, mut action: impl FnMut(usize, usize, usize)) {
        let chain = self.to.chain();
        for slot in 0..chain.variable_step() {
            let count = chain.intervals + usize::from(slot < chain.states);
            (0..count).for_each(|k| action(chain.state(k).start + slot, k, slot));
        }
    }

    fn values(&self, v: &[f64]) -> Vec<f64> {
        let slots = &self.to.interval().slots;
        let mut values = vec![0.0; self.to.chain().variables()];
        self.each(|variable, k, slot| {
            values[variable] = self.signal(slots[slot].signal, k, slots[slot].time, v)
        });
        values[self.to.chain().globals()].copy_from_slice(&v[self.from.chain().globals()]);
        values
    }

    fn bounds(&self, multipliers: &[f64]) -> Vec<f64> {
        let (from, to) = (self.from.chain(), self.to.chain());
        let mut carried = vec![0.0; to.variables()];
        self.each(|variable, k, slot| {
            carried[variable] = match self.places.get(k) {
                Some(place) => multipliers[from.state(place.interval).start + slot] / place.parts as f64,
                None => multipliers[from.state(from.intervals).start + slot],
            };
        });
        carried[to.globals()].copy_from_slice(&multipliers[from.globals()]);
        carried
    }

    fn rows(&self, multipliers: &[f64]) -> Vec<f64> {
        let (from, to) = (self.from.chain(), self.to.chain());
        let mut carried = vec![0.0; to.rows()];
        for (k, place) in self.places.iter().enumerate() {
            carried[to.defects(k)].copy_from_slice(&multipliers[from.defects(place.interval)]);
            let old = &multipliers[from.local(place.interval)];
            let new = carried[to.local(k)].iter_mut().zip(old);
            new.for_each(|(new, old)| *new = old / place.parts as f64);
        }
        carried[to.coupling()].copy_from_slice(&multipliers[from.coupling()]);
        carried
    }
}
