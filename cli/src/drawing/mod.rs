//! Texts of models as a person sees them: under a diagnostic, and where they change.

pub mod difference;
mod fit;
pub mod render;
