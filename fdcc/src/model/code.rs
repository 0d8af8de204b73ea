//! What is compiled once and shared by all variants of a model that differ in values only.

use fdcc_compiler::{ChainCode, Model};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::problem::Chain;
use std::sync::{Arc, OnceLock};

/// Compiled when it is first needed.
#[derive(Default)]
pub(super) struct Code {
    chain: OnceLock<ChainCode>,
    ready: OnceLock<()>,
    without_kinks: OnceLock<Arc<Code>>,
}

impl Code {
    /// Makes its functions ready, unless that was done for a variant with other values.
    pub fn make_ready(&self, make: impl FnOnce()) {
        self.ready.get_or_init(make);
    }

    /// That of the model in which unknowns stand for kinks.
    pub fn without_kinks(&self) -> Arc<Code> {
        Arc::clone(self.without_kinks.get_or_init(Arc::default))
    }

    /// The chain of its phases with the values of the model.
    pub fn chain(&self, model: &Model) -> Result<Chain, Vec<Diagnostic>> {
        if let Some(code) = self.chain.get() {
            return code.chain(model);
        }
        let code = ChainCode::new(model)?;
        self.chain.get_or_init(|| code).chain(model)
    }
}
