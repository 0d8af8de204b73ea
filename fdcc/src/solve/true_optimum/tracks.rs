//! What one surface, one control or one limit does over time.

use super::range::Range;
use super::tuning::tracks::{AT_BOUND, SWITCH};
use fdcc_compiler::{Arc, Mode};
use fdcc_runtime::solution::modes::{self, Span};

/// Pieces of time, one behind the other.
pub(crate) struct Track<T> {
    /// Each with the time at which it begins.
    pub pieces: Vec<(f64, T)>,
}

impl Track<Mode> {
    /// Of a surface.
    pub fn of_modes(spans: &[Span], shortest: f64) -> Self {
        let mode = |span: &Span| match span.mode {
            modes::Mode::Below => Mode::Below,
            modes::Mode::Held => Mode::Held,
            modes::Mode::Above => Mode::Above,
        };
        let pieces = spans.iter().map(|span| (span.from, mode(span))).collect();
        let last = spans.last().map_or(0.0, |span| span.to);
        Track { pieces }.without_short(last, shortest)
    }
}

impl Track<Arc> {
    /// Of a control by its values on the intervals.
    pub fn of_arcs(time: &[f64], values: &[f64], range: &Range, shortest: f64) -> Self {
        let Range { bounds, width, .. } = range;
        let arc = |value: &f64| match () {
            () if value - bounds.lower < AT_BOUND * width => Arc::Lower,
            () if bounds.upper - value < AT_BOUND * width => Arc::Upper,
            () => Arc::Free,
        };
        let mut pieces: Vec<(f64, Arc)> = Vec::new();
        for (time, value) in time.iter().zip(values) {
            let arc = arc(value);
            if pieces.last().is_none_or(|it| it.1 != arc) {
                pieces.push((*time, arc));
            }
        }
        let last = time[time.len() - 1];
        Track { pieces }.with_switches(shortest).without_short(last, shortest)
    }

    /// With short arcs where a control is at a bound at the first or the last time.
    pub fn with_ends(
        mut self,
        bounds: [Arc; 2],
        [first, last]: [f64; 2],
        lengths: [f64; 2],
    ) -> Self {
        let [begin, end] = bounds;
        if begin != Arc::Free && self.pieces[0].1 != begin {
            self.pieces[0].0 = first + lengths[0];
            self.pieces.insert(0, (first, begin));
        }
        if end != Arc::Free && self.pieces[self.pieces.len() - 1].1 != end {
            self.pieces.push((last - lengths[1], end));
        }
        self
    }

    /// With no arc but the longest.
    pub fn with_longest(mut self, last: f64) -> Self {
        let ends: Vec<f64> = self.pieces[1..].iter().map(|it| it.0).chain([last]).collect();
        let lengths = self.pieces.iter().zip(ends).map(|(it, end)| match it.1 {
            Arc::Free => 0.0,
            _ => end - it.0,
        });
        let longest = lengths.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map(|it| it.0);
        let others = self.pieces.iter_mut().enumerate().filter(|it| Some(it.0) != longest);
        others.for_each(|it| it.1.1 = Arc::Free);
        self.cleaned(last)
    }

    /// A short free piece between opposite bounds is one switch, in its middle.
    fn with_switches(mut self, shortest: f64) -> Self {
        let mut j = 1;
        while j + 1 < self.pieces.len() {
            let [before, own, after] = [self.pieces[j - 1], self.pieces[j], self.pieces[j + 1]];
            let is_short = after.0 - own.0 <= SWITCH * shortest;
            let are_opposite = before.1 != after.1 && before.1 != Arc::Free && after.1 != Arc::Free;
            if own.1 == Arc::Free && is_short && are_opposite {
                self.pieces[j + 1].0 = 0.5 * (own.0 + after.0);
                self.pieces.remove(j);
            } else {
                j += 1;
            }
        }
        self
    }
}

impl<T: Copy + PartialEq> Track<T> {
    /// When it changes.
    pub fn switches(&self) -> impl Iterator<Item = f64> {
        self.pieces.iter().skip(1).map(|it| it.0)
    }

    pub fn at(&self, time: f64) -> T {
        let at = self.pieces.partition_point(|it| it.0 <= time).saturating_sub(1);
        self.pieces[at].1
    }

    /// Short pieces go to the one before, the first to the one behind.
    pub fn without_short(mut self, last: f64, shortest: f64) -> Self {
        let mut j = 0;
        while j < self.pieces.len() && self.pieces.len() > 1 {
            let end = self.pieces.get(j + 1).map_or(last, |it| it.0);
            if end - self.pieces[j].0 < shortest {
                let begin = self.pieces.remove(j).0;
                if j < self.pieces.len() {
                    self.pieces[j].0 = begin;
                }
                j = j.saturating_sub(1);
            } else {
                j += 1;
            }
        }
        self.cleaned(last)
    }

    /// Pieces that are alike are one, and none begins at the end or where the next begins.
    pub fn cleaned(mut self, last: f64) -> Self {
        let first = self.pieces[..1].to_vec();
        self.pieces.retain(|it| it.0 < last);
        if self.pieces.is_empty() {
            self.pieces = first;
        }
        self.pieces.dedup_by(|b, a| {
            let is_nothing = a.0 == b.0;
            if is_nothing {
                a.1 = b.1;
            }
            is_nothing
        });
        self.pieces.dedup_by(|b, a| a.1 == b.1);
        self
    }
}
