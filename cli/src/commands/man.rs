//! `fdcc man`: the help of all commands as pages of the manual.

use crate::CommandLine;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::files;
use clap::{Args, Command, CommandFactory};
use fdcc_grammar::SourceFile;
use std::io;
use std::path::PathBuf;

/// Write the pages of the manual, `fdcc.1`, `fdcc-solve.1` and so on
#[derive(Args)]
pub struct Man {
    /// A folder, such as share/man/man1
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

impl Man {
    /// Writes them.
    pub fn run(self) -> Exit {
        match self.write() {
            Ok(()) => Exit::Fine,
            Err(failure) => failure.report(&SourceFile::new("man", "")),
        }
    }

    fn write(&self) -> Result<(), Failure> {
        let mut whole = CommandLine::command();
        whole.build();
        let own = whole.get_subcommands().filter(|it| it.get_name() != "help");
        for command in own.chain([&whole]) {
            let name = command.get_display_name().unwrap_or("fdcc");
            let page = page(command.clone());
            let page = page.map_err(|error| Failure::File(format!("{name}.1: {error}")))?;
            files::write_all(&self.folder, name, &[("1", page)])?;
        }
        Ok(())
    }
}

fn page(command: Command) -> io::Result<String> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page)?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
