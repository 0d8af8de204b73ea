//! The matrix before it is factored: its entries, its chain of stages, and what a factorisation of
//! it must do.

pub(crate) mod columns;
pub(crate) mod factor;
pub(crate) mod phases;
pub(crate) mod stages;
pub(crate) mod triplets;
