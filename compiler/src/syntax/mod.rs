//! What can be said of a syntax tree before anything in it has a meaning: which names it declares,
//! in which order their definitions are evaluated, and how it is written.

pub(crate) mod each;
pub(crate) mod functions;
pub(crate) mod like;
pub(crate) mod order;
pub(crate) mod outer;
pub(crate) mod scope;
mod spelling;
pub(crate) mod text;
pub(crate) mod walk;

pub use spelling::closest;

/// How deep definitions and expressions may be nested in each other.
pub(crate) const DEEPEST: usize = 256;
