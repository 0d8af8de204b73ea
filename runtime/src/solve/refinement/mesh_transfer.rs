//! A solution on a grid as the start on another one, which divides its intervals or has another
//! number of stages on them.
//!
//! States and controls are read off the polynomials that they are on the old intervals. The
//! multiplier of a step is the costate, on every grid; that of a node is the costate times the
//! weight of the node. Multipliers of path constraints and bounds stand for pieces of time, and are
//! shared by what is there now; the nearest in time is taken.

use crate::nlp::{Multipliers, Start, Warm};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::{Interval, Signal, Slot};

/// The start on `to`, each interval of which is one of the `parts` of an interval of `from`.
pub(super) fn transferred(
    from: &TranscribedNlp,
    start: &Start,
    to: &TranscribedNlp,
    parts: &[usize],
) -> Start {
    let transfer = MeshTransfer { from, to, places: places(parts) };
    let warm = start.warm.as_ref().map(|Warm { multipliers, mu, widths }| {
        let multipliers = Multipliers {
            constraints: transfer.rows(&multipliers.constraints),
            lower: transfer.bounds(&multipliers.lower),
            upper: transfer.bounds(&multipliers.upper),
        };
        Warm { multipliers, mu: *mu, widths: widths.clone() }
    });
    Start { v: transfer.values(&start.v), warm }
}

/// The interval that each part is in, and which of its parts it is.
fn places(parts: &[usize]) -> Vec<IntervalPart> {
    let all = parts.iter().enumerate();
    all.flat_map(|(interval, &parts)| {
        (0..parts).map(move |part| IntervalPart { interval, part, parts })
    })
    .collect()
}

#[derive(Clone, Copy)]
struct IntervalPart {
    interval: usize,
    part: usize,
    parts: usize,
}

impl IntervalPart {
    /// The time of the old interval at a time of the new one.
    fn time(self, time: f64) -> f64 {
        (self.part as f64 + time) / self.parts as f64
    }
}

struct MeshTransfer<'a> {
    from: &'a TranscribedNlp<'a>,
    to: &'a TranscribedNlp<'a>,
    places: Vec<IntervalPart>,
}

impl MeshTransfer<'_> {
    /// Calls `action` with each variable of the new grid but the unknowns: itself, its slot, and
    /// where it is on the old grid.
    fn each(&self, mut action: impl FnMut(usize, usize, IntervalPart, f64)) {
        let chain = self.to.chain();
        for (slot, time) in self.to.interval().slots.iter().map(|slot| slot.time).enumerate() {
            for (k, place) in self.places.iter().enumerate() {
                action(chain.state(k).start + slot, slot, *place, place.time(time));
            }
        }
        let last = IntervalPart { interval: self.from.chain().intervals, part: 0, parts: 1 };
        (0..chain.states)
            .for_each(|slot| action(chain.state(chain.intervals).start + slot, slot, last, 0.0));
    }

    fn values(&self, v: &[f64]) -> Vec<f64> {
        let slots = &self.to.interval().slots;
        let mut values = vec![0.0; self.to.chain().variables()];
        self.each(|variable, slot, place, time| {
            let first = self.from.chain().state(place.interval).start;
            // Behind the last interval there are only the states and controls that it ends with.
            let combination = match place.interval < self.from.chain().intervals {
                true => self.from.interval().signal_at(slots[slot].signal, time),
                false => vec![(slot, 1.0)],
            };
            values[variable] = combination.iter().map(|(at, factor)| factor * v[first + at]).sum();
        });
        values[self.to.chain().globals()].copy_from_slice(&v[self.from.chain().globals()]);
        values
    }

    fn bounds(&self, multipliers: &[f64]) -> Vec<f64> {
        let (from, to) = (self.from.chain(), self.to.chain());
        let (old, new) = (self.from.interval(), self.to.interval());
        let mut carried = vec![0.0; to.variables()];
        self.each(|variable, slot, place, time| {
            let signal = new.slots[slot].signal;
            let (nearest, share) = match place.interval < from.intervals {
                true => (nearest(old, signal, time), count(old, signal) / count(new, signal)),
                false => (slot, 1.0),
            };
            let piece = multipliers[from.state(place.interval).start + nearest];
            carried[variable] = share * piece / place.parts as f64;
        });
        carried[to.globals()].copy_from_slice(&multipliers[from.globals()]);
        carried
    }

    fn rows(&self, multipliers: &[f64]) -> Vec<f64> {
        let (from, to) = (self.from.chain(), self.to.chain());
        let mut carried = vec![0.0; to.rows()];
        for (k, place) in self.places.iter().enumerate() {
            self.defects(
                *place,
                &multipliers[from.defects(place.interval)],
                &mut carried[to.defects(k)],
            );
            self.path(*place, &multipliers[from.local(place.interval)], &mut carried[to.local(k)]);
        }
        carried[to.coupling()].copy_from_slice(&multipliers[from.coupling()]);
        carried
    }

    fn defects(&self, place: IntervalPart, old: &[f64], new: &mut [f64]) {
        let known = blocks(self.from.interval());
        let states = self.from.interval().start.states.len();
        for block in blocks(self.to.interval()) {
            for (source, part) in between(&known, place.time(block.time)) {
                let factor = part * block.weight / source.weight;
                let target = new[block.row..][..states].iter_mut().zip(&old[source.row..]);
                target.for_each(|(new, old)| *new += factor * old);
            }
        }
        // Behind them: the controls that go on from interval to interval.
        let handed_on = self.from.interval().carried_controls();
        let (last, source) = (new.len() - handed_on, old.len() - handed_on);
        new[last..].copy_from_slice(&old[source..]);
    }

    fn path(&self, place: IntervalPart, old: &[f64], new: &mut [f64]) {
        let (from, to) = (&self.from.interval().path, &self.to.interval().path);
        let rows = new.len() / to.len();
        let share = from.len() as f64 / (to.len() * place.parts) as f64;
        for (at, point) in to.iter().enumerate() {
            let time = place.time(point.time);
            let source = least(from.iter().map(|point| (point.time - time).abs()));
            let target = new[at * rows..][..rows].iter_mut().zip(&old[source * rows..]);
            target.for_each(|(new, old)| *new = share * old);
        }
    }
}

/// Rows of an interval, one for each state: those of a node, or of the end of a step that is no
/// node.
struct Block {
    row: usize,
    time: f64,
    /// Of the costate in the multipliers.
    weight: f64,
}

fn blocks(interval: &Interval) -> Vec<Block> {
    let states = interval.start.states.len();
    let rows = (0..interval.inner() + states).step_by(states.max(1));
    let node = |row: usize| interval.nodes.iter().find(|node| node.row == row);
    let ends = rows.clone().filter(|row| node(*row).is_none()).count();
    let mut ended = 0;
    let block = |row| match node(row) {
        Some(node) => Block { row, time: node.point.time, weight: node.weight / node.factor },
        None => {
            ended += 1;
            Block { row, time: ended as f64 / ends as f64, weight: 1.0 }
        }
    };
    rows.map(block).collect()
}

/// The blocks on both sides of a time, with their parts in a linear interpolation.
fn between(blocks: &[Block], time: f64) -> Vec<(&Block, f64)> {
    let next =
        blocks.iter().position(|block| block.time >= time).unwrap_or(blocks.len() - 1).max(1);
    let [before, after] = [next - 1, next].map(|at| &blocks[at.min(blocks.len() - 1)]);
    let length = after.time - before.time;
    let part = if length > 0.0 { (time - before.time) / length } else { 1.0 };
    vec![(before, 1.0 - part), (after, part)]
}

/// How many variables of an interval are values of a signal.
fn count(interval: &Interval, signal: Signal) -> f64 {
    interval.slots.iter().filter(|slot| slot.signal == signal).count() as f64
}

/// The slot of a signal that is nearest to a time.
fn nearest(interval: &Interval, signal: Signal, time: f64) -> usize {
    let distance = |slot: &Slot| {
        if slot.signal == signal { (slot.time - time).abs() } else { f64::INFINITY }
    };
    least(interval.slots.iter().map(distance))
}

fn least(distances: impl Iterator<Item = f64>) -> usize {
    distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(at, _)| at)
}
