//! Holds whose selector is at its bound, where the motion may leave the surface at any time.
//!
//! There the selector is that of the side to which it would leave, so that the hold is an arc at
//! the bound `psi = 0` of that side (`signs.rs`, with `q = 1`). A multiplier `-dnu/dt` with the
//! sign of that bound presses the motion onto it: no short way off the surface and back is better.

use super::contacts::Contacts;
use super::polynomials::polynomials;
use super::signs::{At, falls, side};
use super::tuning::contacts::NONE;
use super::tuning::insertion::RELEASED;
use super::tuning::signs::POINTS;
use fdcc_compiler::{Arc, Mode};
use std::ops::Range;

/// The selector of a hold.
#[derive(Clone, Copy)]
pub(super) struct Selector {
    /// The phase.
    pub phase: usize,
    /// One of the switches of the model.
    pub switch: usize,
    /// Its number among the controls of the phase.
    pub control: usize,
}

impl Contacts<'_> {
    /// Whether the motion is pressed onto a surface that it could leave in this mode, all along the
    /// part of a hold with the selector at its bound that lasts until its end (1), or from its
    /// beginning on (0).
    pub(super) fn is_pressed_on(&self, own: Selector, mode: Mode, end: usize) -> bool {
        let arc = if mode == Mode::Above { Arc::Lower } else { Arc::Upper };
        let run = self.at_its_bound(own, end);
        if run.len() < POINTS {
            return false;
        }
        let j = own.phase;
        let nu = self.multipliers_of_row(j, self.row_of_switch(j, own.switch));
        let time = &self.located.outcome.phases[j].trajectory.time;
        let mu = falls(&time[run.start..=run.end], &nu[run]);
        let least = NONE * self.size(j) / self.range_of_switch(own.switch);
        let is_last = end == 1 && j + 1 == self.located.structure.phases.len();
        // In the end it need not come back.
        let leaves = || At::new(self.located, j, nu.clone(), 1).at_the_end(side(arc)) > 0.0;
        mu.iter().all(|it| side(arc) * it > least) && !(is_last && leaves())
    }

    /// The intervals at one end of a hold on which its selector is at its bound.
    fn at_its_bound(&self, own: Selector, end: usize) -> Range<usize> {
        let pieces = polynomials(&self.located.outcome.phases[own.phase].trajectory, own.control);
        let is_at = |k: &usize| {
            let [begin, end] = pieces[*k].ends;
            pieces[*k].at(0.5 * (begin + end)).abs() > RELEASED
        };
        let count = pieces.len();
        match end {
            0 => 0..(0..count).take_while(is_at).count(),
            _ => count - (0..count).rev().take_while(is_at).count()..count,
        }
    }
}
