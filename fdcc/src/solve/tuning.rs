//! Every tuned number of solves by the library, by the file that uses it.

pub(super) mod families {
    /// Of more families of answers the worse ones are not looked at.
    pub(crate) const MOST_FAMILIES: usize = 8;
    /// Objectives within this, relative to their size, are of one family.
    pub(crate) const SAME: f64 = 1e-6;
}

pub(super) mod magnitudes {
    /// What is smaller than this part of its unit counts as nothing, and an objective below the
    /// second as 0 (decision 30).
    pub(crate) const NOTHING: f64 = 1e-6;
    pub(crate) const NO_OBJECTIVE: f64 = 1e-8;
    /// Magnitudes are at least this part of the unit: powers of smaller ones are no numbers.
    pub(crate) const LEAST: f64 = 1e-30;
    /// An objective that changes by a larger factor, or by its inverse, was rounding.
    pub(crate) const ROUNDING: f64 = 1e3;
    /// So often what is found is smaller again.
    pub(crate) const MOST: usize = 4;
}

pub(super) mod solution {
    /// What other multipliers change by more than this part of itself is not determined.
    pub(crate) const NOT_UNIQUE: f64 = 1e-6;
    /// So is what changes the objective by more than this part, for all of the parameter.
    pub(crate) const NOTHING: f64 = 1e-9;
}

pub(super) mod parametric {
    /// By how much of its value, or of its unit, a parameter differs between two programs.
    pub(crate) const CHANGE: f64 = 1e-5;
    /// What holds at the ends add to a slope is nothing below this part of it.
    pub(crate) const MOVED: f64 = 1e-9;
}

pub(super) mod kinks {
    /// A kink is met where its two conditions are off by no more than this part of their size.
    pub(crate) const TIGHT: f64 = 1e-5;
    /// The same where means over intervals are known, which mix both sides where a kink is crossed.
    pub(crate) const LOOSE: f64 = 0.02;
    /// A smaller part of a unit is none.
    pub(crate) const ROUNDING: f64 = 1e-7;
    /// For a first price conditions are at least this part of a unit: beside a price without a
    /// limit nothing else counts.
    pub(crate) const LEAST: f64 = 1e-2;
    /// What gaps cost at first, for what the objective is.
    pub(crate) const PRICE: f64 = 10.0;
    /// A smaller objective says nothing of what prices are high: one of its units does then.
    pub(crate) const NOTHING: f64 = 1e-6;
    /// How much higher the next price is, and how many are tried.
    pub(crate) const HIGHER: f64 = 30.0;
    pub(crate) const MOST_PRICES: usize = 4;
    /// Where the objective of the replay differs by more, surfaces are tried in place of unknowns.
    pub(crate) const EXACT: f64 = 1e-8;
    /// What is worse by more than this part of the objective is no better description of the same
    /// optimum.
    pub(crate) const WORSE: f64 = 0.25;
}

pub(super) mod search {
    /// Where nothing is certified near the layers of the kernel of our choice: one whose layers
    /// have no edges.
    pub(crate) const OTHER_KERNEL: &str = "sqrt";
    /// What is certified there is no answer where it is worse by this part.
    pub(crate) const FAR_WORSE: f64 = 0.5;
    /// Where nothing is found with the scheme of our choice: one of high order that damps what is
    /// stiff.
    pub(crate) const OTHER_SCHEME: &str = "radau3";
    /// Where nothing is found from the guess so many starts are tried, with that.
    pub(crate) const STARTS: usize = 5;
    /// A solve that ended at its limit of iterations and violates a condition by more found nothing
    /// feasible.
    pub(crate) const INFEASIBLE: f64 = 1e-6;
}

pub(super) mod optimality {
    /// The Hamiltonian may be off by so much of the size of its terms.
    pub(crate) const OFF: f64 = 0.4;
    /// On how much of the time a control may violate the rule of signs.
    pub(crate) const VIOLATED: f64 = 0.01;
}

pub(super) mod reach {
    /// What is less than this part of the numbers that differ is no distance.
    pub(crate) const NOTHING: f64 = 1e-6;
    /// Nor is what is less than this part of the bound anything but 0.
    pub(crate) const ROUNDING: f64 = 1e-10;
    /// A search that takes more iterations is given up: this is news of a failure, not an answer.
    pub(crate) const MOST_ITERATIONS: usize = 200;
}

pub(super) mod sequences {
    /// More sequences than so many are solved on coarse grids first.
    pub(crate) const FEW_SEQUENCES: usize = 3;
    /// So many iterations are enough there.
    pub(crate) const BRIEF: usize = 150;
    /// A phase has so many intervals there at least.
    pub(crate) const FEWEST_INTERVALS: usize = 20;
    /// Sequences that are worse than the best by more than this part of its objective are not
    /// solved once more.
    pub(crate) const WORSE: f64 = 0.05;
    /// Where the best one is not certified, so many others are looked at.
    pub(crate) const NEXT: usize = 2;
    /// The best sequence is lengthened or shortened at its end so often.
    pub(crate) const MOST_CLIMBS: usize = 6;
    /// With jumps in phases, what is better by less of its objective than grids change it leads
    /// nowhere: two jumps at one time are another grid, and nothing else.
    pub(crate) const CLIMB: f64 = 0.01;
    /// A jump that is moved over a link happens so near to it, for the length of the piece next to
    /// it.
    pub(crate) const NEAR_LINK: f64 = 0.02;
    /// A guess is not worth more steps of a simulation.
    pub(crate) const STEPS: usize = 20_000;
    /// More are not looked for where the guess leads to that many.
    pub(crate) const LONGEST: usize = 100;
    /// More than so many events pile up where two of them are nearer than this part of the largest
    /// distance.
    pub(crate) const FEW: usize = 8;
    pub(crate) const SHORTEST: f64 = 1e-3;
}

pub(super) mod timing {
    /// Controls come so much earlier or later, for the whole time.
    pub(crate) const MOMENT: f64 = 1e-9;
}
