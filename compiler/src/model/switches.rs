//! What is smoothed together.

use super::{Ball, Model, Place};

/// What is smoothed with one width: a surface by itself, or the components of a [`Ball`].
pub struct Switch<'m> {
    /// The surface or the ball.
    pub place: &'m Place,
    /// Indices into [`Model::surfaces`].
    pub surfaces: std::ops::Range<usize>,
    /// Whether it is a ball.
    pub is_ball: bool,
}

impl Model {
    /// The surfaces, with those of a ball taken together.
    pub fn switches<'m>(&'m self) -> Vec<Switch<'m>> {
        let is_alone = |at: &usize| self.balls.iter().all(|ball| !ball.surfaces.contains(at));
        let alone = |at: usize| Switch {
            place: &self.surfaces[at].place,
            surfaces: at..at + 1,
            is_ball: false,
        };
        let mut all: Vec<Switch<'m>> =
            (0..self.surfaces.len()).filter(is_alone).map(alone).collect();
        let of = |ball: &'m Ball| Switch {
            place: &ball.place,
            surfaces: ball.surfaces.clone(),
            is_ball: true,
        };
        all.extend(self.balls.iter().map(of));
        all.sort_by_key(|switch| switch.surfaces.start);
        all
    }
}
