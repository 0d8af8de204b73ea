//! What the compiler makes of a model, as text.

use super::Model;
use crate::error::Error;
use fdcc_compiler::NamedUnit;
pub use fdcc_compiler::Stage;

impl Model {
    /// What a stage of the compiler works on.
    ///
    /// ```
    /// use fdcc::{Model, Stage};
    ///
    /// let text = "time t in [0, 1]\nstate x start 0\ndynamics { x' = -x }";
    /// let shown = Model::from_text("decay", text)?.shown(Stage::Graph)?;
    /// assert!(shown.contains('x'));
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// What keeps the model from that stage.
    pub fn shown(&self, stage: Stage) -> Result<String, Error> {
        fdcc_compiler::dump(&self.meaning, stage).map_err(Error::Model)
    }

    /// Its functions with their derivatives, as C99.
    ///
    /// # Errors
    ///
    /// What cannot be compiled; parameters without a value.
    pub fn emit_c(&self) -> Result<String, Error> {
        fdcc_compiler::emit_c(&self.meaning).map_err(Error::Model)
    }

    /// The unit of each name, if the model uses units.
    pub fn units(&self) -> &[NamedUnit] {
        &self.meaning.units
    }

    /// The unit of each condition, by the words that name it in messages.
    pub fn condition_units(&self) -> &[NamedUnit] {
        &self.meaning.condition_units
    }
}
