//! A solution of the transcribed problem in the words of the model: signals over real time, the
//! modes of surfaces, costates and multipliers, and what contradicts that it is an optimum.

pub(crate) mod by_parameters;
mod elsewhere;
mod hamiltonian;
pub(crate) mod lagrangian;
mod minimum;
pub mod modes;
mod outcome;
mod pause;
pub mod phases;
mod quadrature;
mod trajectory;

pub use by_parameters::by_parameters;
pub(crate) use elsewhere::Elsewhere;
pub use hamiltonian::Hamiltonian;
pub use minimum::{ControlSlopes, control_slopes};
pub use outcome::{Attempt, ChainOutcome, Limiting, Outcome};
pub(crate) use pause::gain as gain_of_pauses;
pub use quadrature::{integrals, sums_over_rows, terms_of_rows};
pub use trajectory::{ControlNodes, Trajectory, times};
pub(crate) use trajectory::{Sampled, switching_function_sizes};
