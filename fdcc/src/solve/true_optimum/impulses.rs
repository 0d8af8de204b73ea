//! The multipliers of bounds that act at one time: where a bound is touched, and where an arc at it
//! begins or ends (`signs.rs` says what is left there).

use super::certificate::Impulse;
use super::contacts::Contacts;
use super::signs::At;
use super::tuning::signs::NO_IMPULSE;
use fdcc_compiler::Arc;

impl Contacts<'_> {
    /// Those that are more than rounding, in the order of time, of the objective of the model;
    /// `sense` is 1 where it is minimised.
    pub fn impulses(&self, sense: f64) -> Vec<Impulse> {
        let states = self.limits.iter().filter(|it| it.state.is_some()).count();
        let name = |limit: usize| match self.limits[limit].state {
            Some(state) => self.model.states[state].place.name.clone(),
            None => self.model.path[limit - states].place.name.clone(),
        };
        let mut all = Vec::new();
        for j in 0..self.located.structure.phases.len() {
            let of = |limit| self.impulses_of(j, limit).into_iter().map(move |it| (limit, it));
            let mut own: Vec<_> = (0..self.limits.len()).flat_map(of).collect();
            own.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
            all.extend(own.into_iter().map(|(limit, [time, kappa])| Impulse {
                condition: name(limit),
                time,
                multiplier: sense * kappa,
            }));
        }
        all
    }

    /// The times and sizes of those of a limit in a phase: where it begins, and where an arc ends
    /// with it.
    fn impulses_of(&self, j: usize, limit: usize) -> Vec<[f64; 2]> {
        let (located, phase) = (self.located, &self.located.structure.phases[j]);
        let [begin, end] = [located.structure.times[j], located.structure.times[j + 1]];
        let order = self.limits[limit].order.unwrap_or(0);
        let phases = &located.structure.phases;
        let goes_on = |other: Option<usize>| {
            let other = other.and_then(|it| phases.get(it));
            other.is_some_and(|it| it.contacts[limit] == phase.contacts[limit])
        };
        let comes_in = !goes_on(j.checked_sub(1));
        let is_given = j + 1 == phases.len() && self.is_given_in_the_end(limit);
        let goes_out = !goes_on(Some(j + 1)) && !is_given;
        let kappa = self.kappa_of_entry(j, limit);
        let (begins, ends) = match phase.contacts[limit] {
            Arc::Free if phase.touches[limit] != Arc::Free => (kappa.map(|it| [it, 0.0]), None),
            Arc::Free => (None, None),
            _ if order == 0 => (None, None),
            _ => {
                let density = At::new(located, j, self.multipliers(j, limit), order);
                let [before, unsure] = density.begin;
                let begins = kappa.filter(|_| comes_in).map(|it| [it - before, unsure]);
                (begins, goes_out.then_some(density.end))
            }
        };
        let all = [begins.map(|it| (begin, it)), ends.map(|it| (end, it))];
        let is_some = |(_, [kappa, unsure]): &(f64, [f64; 2])| {
            let part = self.part_at_once(j, limit, kappa.abs() - unsure);
            part > NO_IMPULSE
        };
        let known = all.into_iter().flatten().filter(is_some);
        known.map(|(time, [kappa, _])| [time, kappa]).collect()
    }
}
