//! What editors and reports show: names with their roles, one name in words, the words of the
//! language.

mod grid;
mod index;
mod information;
pub(crate) mod text;
pub mod vocabulary;

pub use grid::{Grid, grid};
pub use index::{Definition, Kind, Meaning, Names, Occurrence, Role, enclosing};
pub use information::{SymbolInformation, symbol_information};
