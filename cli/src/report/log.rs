//! What a person sees while a solve runs, on stderr: Ipopt's iteration table with the width of the
//! layer and the grid, and on a terminal a progress line.

use crate::output::convergence::Convergence;
use crate::output::number::{scientific, significant};
use crate::output::units::Units;
use crate::output::{complain, tell};
use fdcc::{Ended, Part, Report};
use fdcc_runtime::nlp::Progress;
use fdcc_runtime::solve;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::HashMap;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// How much to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Level {
    /// Nothing but what is wrong
    None,
    /// Every tenth iteration; of a sweep, each row when it is done
    Short,
    /// Every iteration
    Full,
}

const HEADER: &str =
    " iter    objective    inf_pr   inf_du lg(mu)  ||d||   alpha_pr  sigma       N";
/// What a full log has besides, at its end: the short one fits a terminal of 80 columns.
const MORE: &str = " lg(rg) alpha_du  ls";
/// The header is repeated after this many lines.
const PAGE: usize = 20;
const SHORT: usize = 10;
const UNPOISONED: &str = "no thread panics with the lock";

/// A sequence of jumps and a starting point.
type Table = (Option<String>, Option<usize>);

/// The tables of a solve, and of the several solves that look for its answer.
pub struct Log {
    level: Level,
    /// Stands before each line: which row of a sweep it is about.
    label: String,
    /// How many lines each table has.
    lines: Mutex<HashMap<Table, usize>>,
    bar: ProgressBar,
    /// Of the only solve.
    convergence: Mutex<Convergence>,
    /// How many SI units one of the unit of a width is.
    scale: f64,
}

impl Log {
    /// The table of the only solve.
    pub fn new(level: Level) -> Self {
        let bar = progress(ProgressBar::no_length(), level, "{spinner} {elapsed} {msg}");
        let (lines, convergence) = (Mutex::default(), Mutex::default());
        Log { level, label: String::new(), lines, bar, convergence, scale: 1.0 }
    }

    /// The table of one of several solves, which share a [`bar`]; only a full log has tables.
    pub fn of_several(level: Level, bar: &ProgressBar, label: &str) -> Self {
        let level = if level == Level::Full { level } else { Level::None };
        Log { level, label: label.to_owned(), bar: bar.clone(), ..Log::new(Level::None) }
    }

    /// From now on widths are in the unit of the surfaces, as in the verdict.
    pub fn show_widths_in(&mut self, units: &Units) {
        self.scale = units.width_scale();
    }

    /// How the only solve went so far.
    pub fn convergence(&self) -> Convergence {
        self.convergence.lock().expect(UNPOISONED).clone()
    }

    /// What the library says.
    pub fn report(&self, report: &Report) {
        match report {
            Report::Iteration(part, progress, level) => self.iteration(part, progress, *level),
            Report::Ended(part, ended) => self.ended(part, ended),
            Report::Stopped { ended, stopped, starts } => complain(&format!(
                "{ended} of {starts} starts came to their end, {stopped} stopped on the way, {} \
                 never ran",
                starts - ended - stopped
            )),
        }
    }

    /// One iteration. Of several solves that look for one answer only a full log has tables.
    fn iteration(&self, part: &Part, progress: &Progress, level: solve::Level) {
        let label = name(part).map_or(self.label.clone(), |name| format!("{name} "));
        let is_part = name(part).is_some();
        let (iteration, violation) = (progress.iteration, progress.primal_infeasibility);
        if !is_part && !progress.is_conic {
            self.convergence.lock().expect(UNPOISONED).push(progress, level);
        }
        self.bar.set_message(format!("{label}iteration {iteration}  violation {violation:.1e}"));
        let wanted = match self.level {
            _ if progress.is_conic => false,
            Level::None => false,
            Level::Short => !is_part && progress.iteration.is_multiple_of(SHORT),
            Level::Full => true,
        };
        if !wanted {
            return;
        }
        let is_full = self.level == Level::Full;
        let line = line(progress, level, self.scale, is_full);
        let more = if is_full { MORE } else { "" };
        let with_header = self.next_line(part).is_multiple_of(PAGE);
        self.bar.suspend(|| {
            if with_header {
                tell(&format!("{label}{HEADER}{more}\n"));
            }
            tell(&format!("{label}{line}\n"));
        });
    }

    /// How many lines the table of a part has had so far.
    fn next_line(&self, part: &Part) -> usize {
        let table = (part.sequence.map(str::to_owned), part.start);
        let mut lines = self.lines.lock().expect(UNPOISONED);
        let count = lines.entry(table).or_default();
        *count += 1;
        *count - 1
    }

    /// How one of several solves ended; those within a sequence of jumps are for a full log.
    fn ended(&self, part: &Part, ended: &Ended) {
        let is_within = part.sequence.is_some() && part.start.is_some();
        if self.level == Level::Full || self.level == Level::Short && !is_within {
            let status = ended.status.replace('_', " ");
            let told = match ended.is_solved {
                true => format!("{status:<18} objective {}", significant(ended.objective, 9)),
                false => status,
            };
            let label = name(part).unwrap_or_default();
            self.bar.suspend(|| tell(&format!(" {label:<9}  {told}\n")));
        }
    }

    /// Removes the progress line.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// What stands before the lines of one of several solves.
fn name(part: &Part) -> Option<String> {
    let start = part.start.map(|index| format!("start {index:3}"));
    start.or(part.sequence.map(str::to_owned))
}

/// The progress of several solves, on a terminal only.
pub fn bar(level: Level, solves: usize) -> ProgressBar {
    progress(
        ProgressBar::new(solves as u64),
        level,
        "{spinner} {elapsed} {pos}/{len} {bar:20} {eta} left {msg}",
    )
}

fn progress(bar: ProgressBar, level: Level, template: &str) -> ProgressBar {
    if level == Level::None || !std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
        return bar;
    }
    bar.set_style(
        ProgressStyle::with_template(template).expect("the templates are fixed and right"),
    );
    bar.enable_steady_tick(Duration::from_millis(120));
    bar
}

fn line(p: &Progress, level: solve::Level, scale: f64, is_full: bool) -> String {
    let sigma = level.sigma.iter().fold(0.0f64, |a, sigma| a.max(*sigma));
    let sigma = if sigma > 0.0 { scientific(sigma / scale, 1) } else { "-".into() };
    let stages = level.stages.map(|stages| format!("x{stages}")).unwrap_or_default();
    let grid = format!("{}{stages}", level.intervals);
    let more = if is_full { more(p) } else { String::new() };
    format!(
        "{:5}{} {:>13} {:>8} {:>8} {:>5} {:>8} {:>9}  {:>7} {:>6}{more}",
        p.iteration,
        if p.restoration { 'r' } else { ' ' },
        scientific(p.objective, 6),
        scientific(p.primal_infeasibility, 2),
        scientific(p.dual_infeasibility, 2),
        logarithm(p.mu),
        scientific(p.step, 2),
        scientific(p.alpha_primal, 2),
        sigma,
        grid
    )
}

fn more(p: &Progress) -> String {
    let alpha = scientific(p.alpha_dual, 2);
    format!(" {:>6} {alpha:>8} {:>3}", logarithm(p.regularization), p.trials)
}

fn logarithm(value: f64) -> String {
    if value > 0.0 { format!("{:.1}", value.log10()) } else { "-".into() }
}
