//! `fdcc show`: a model as the compiler understands it, at any stage.

use super::options::{Changes, read_at_any_rate};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::watch::Deadline;
use clap::{Args, ValueEnum};

/// Show a problem as understood: names, values, bounds, sizes, surfaces
#[derive(Args)]
pub struct Show {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    /// Show what a stage of the compiler works on instead
    #[arg(long, value_enum)]
    stage: Option<Stage>,
    #[command(flatten)]
    changes: Changes,
}

#[derive(Clone, Copy, ValueEnum)]
enum Stage {
    /// Every expression of the model over its names
    Model,
    /// The functions that are compiled, over their inputs
    Graph,
    /// The functions with their Jacobians and Hessians
    Derivatives,
    /// Their machine code in Cranelift's text form
    Clif,
}

impl Show {
    /// Prints it.
    pub fn run(self) -> Exit {
        let model = match read_at_any_rate(&self.file, &self.changes, Deadline::NEVER) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        match model.shown(self.stage()) {
            Ok(text) => {
                output::print(&text);
                Exit::Fine
            }
            Err(error) => Failure::from(error).report(model.source()),
        }
    }

    fn stage(&self) -> fdcc::Stage {
        match self.stage {
            None => fdcc::Stage::Summary,
            Some(Stage::Model) => fdcc::Stage::Model,
            Some(Stage::Graph) => fdcc::Stage::Graph,
            Some(Stage::Derivatives) => fdcc::Stage::Derivatives,
            Some(Stage::Clif) => fdcc::Stage::Clif,
        }
    }
}
