//! Structures with less in them.

use super::structure::Structure;
use super::tuning::structure::{OVERLAP, SHORT};
use fdcc_compiler::{Arc, Limit, Mode};

impl Structure {
    /// With free controls on holds; if they are free already, without the shortest phase as long as
    /// that is short.
    pub fn simpler(&self) -> Option<Self> {
        let mut other = self.clone();
        for phase in other.phases.iter_mut().filter(|it| it.modes.contains(&Mode::Held)) {
            phase.arcs.fill(Arc::Free);
        }
        if other.phases != self.phases {
            return Some(other.merged());
        }
        let durations = self.times.windows(2).map(|pair| pair[1] - pair[0]).enumerate();
        let durations = durations.filter(|it| self.may_leave_out(it.0));
        let shortest = durations.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let [first, last] = self.ends();
        let is_short = shortest.1 < SHORT * (last - first);
        is_short.then(|| self.without(shortest.0))
    }

    /// With free controls throughout: what a smoothed layer, or a coarse grid, says of them need
    /// not be so, and an arc that is too short to be seen may be what makes the others possible.
    pub fn released(&self) -> Option<Self> {
        let mut other = self.clone();
        other.phases.iter_mut().for_each(|it| it.arcs.fill(Arc::Free));
        (other.phases != self.phases).then(|| other.merged())
    }

    /// With a limit released, or touched only where control acts on its second derivative at first.
    pub fn without_contact(&self, j: usize, limit: usize) -> Self {
        let mut other = self.clone();
        let own = &mut other.phases[j];
        match own.contacts[limit] {
            Arc::Free => own.touches[limit] = Arc::Free,
            _ => own.contacts[limit] = Arc::Free,
        }
        other.merged()
    }

    /// Without short phases in which the limits of both neighbours are reached: an arc is seen by
    /// whole intervals, so that one that ends where another begins may overlap with it.
    pub fn without_overlaps(&self) -> Self {
        let length = |j: usize| self.times[j + 1] - self.times[j];
        let is_overlap = |j: &usize| {
            let is_short = length(*j) < OVERLAP * length(j - 1).min(length(j + 1));
            is_short && self.phases[*j].is_union(&self.phases[j - 1], &self.phases[j + 1])
        };
        let inside = 1..self.phases.len().saturating_sub(1);
        let all: Vec<usize> = inside.filter(is_overlap).collect();
        all.iter().rev().fold(self.clone(), |rest, j| rest.without_phase(*j)).merged()
    }

    /// Without touches of limits on which a control acts at once, or none: they ask for nothing.
    pub fn without_idle_touches(mut self, limits: &[Limit]) -> Self {
        for phase in &mut self.phases {
            let touches = phase.touches.iter_mut().zip(limits);
            let idle = touches.filter(|it| it.1.order == Some(0));
            idle.for_each(|it| *it.0 = Arc::Free);
        }
        self.merged()
    }

    /// Whether a phase can be left out: the jumps before and behind it are not one upon the other,
    /// and none is the first or the last thing to happen.
    pub fn may_leave_out(&self, j: usize) -> bool {
        let (own, next) = (self.phases[j].jump, self.phases.get(j + 1).map(|it| it.jump));
        match next {
            Some(next) => next.is_none() || j > 0 && own.is_none(),
            None => j > 0 && own.is_none(),
        }
    }

    /// Without a phase, whose time its neighbours share.
    pub fn without(&self, j: usize) -> Self {
        self.clone().without_phase(j).merged()
    }

    /// The same; neighbours that are alike stay two.
    pub fn without_phase(self, j: usize) -> Self {
        let mut other = self.clone();
        let gone = other.phases.remove(j);
        if let Some(next) = other.phases.get_mut(j).filter(|_| j > 0) {
            next.begin_like(&gone);
        }
        let middle = 0.5 * (other.times[j] + other.times[j + 1]);
        other.times.remove(j);
        if j > 0 && j < other.phases.len() {
            other.times[j] = middle;
        } else if j == 0 {
            other.times[0] = self.times[0];
        } else {
            let last = other.times.len() - 1;
            other.times[last] = self.times[self.times.len() - 1];
        }
        other
    }
}
