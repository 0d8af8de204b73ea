//! What a person sees while a solve runs, on stderr: Ipopt's iteration table with the width of the
//! layer and the grid, and on a terminal a progress line.

use crate::output::number::{scientific, significant};
use crate::output::tell;
use crate::output::tried::Ended;
use crate::output::units::Units;
use fdcc_runtime::nlp::Progress;
use fdcc_runtime::solve;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
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

const HEADER: &str = " iter    objective    inf_pr   inf_du lg(mu)  ||d||  lg(rg) alpha_du \
                      alpha_pr  ls  sigma       N";
/// The header is repeated after this many lines.
const PAGE: usize = 20;
const SHORT: usize = 10;

/// The table of one solve.
pub struct Log {
    level: Level,
    /// Stands before each line: which of several solves it is about.
    label: String,
    lines: usize,
    bar: ProgressBar,
    /// How many SI units one of the unit of a width is.
    scale: f64,
}

impl Log {
    /// The table of the only solve.
    pub fn new(level: Level) -> Self {
        let bar = progress(ProgressBar::no_length(), level, "{spinner} {elapsed} {msg}");
        Log { level, label: String::new(), lines: 0, bar, scale: 1.0 }
    }

    /// The table of one of several solves, which share a [`bar`]; only a full log has tables.
    pub fn of_several(level: Level, bar: &ProgressBar, label: &str) -> Self {
        let level = if level == Level::Full { level } else { Level::None };
        Log { level, label: label.to_owned(), lines: 0, bar: bar.clone(), scale: 1.0 }
    }

    /// From now on widths are in the unit of the surfaces, as in the verdict.
    pub fn show_widths_in(&mut self, units: &Units) {
        self.scale = units.width_scale();
    }

    /// One iteration.
    pub fn iteration(&mut self, progress: &Progress, level: solve::Level) {
        let (label, iteration) = (&self.label, progress.iteration);
        let violation = progress.primal_infeasibility;
        self.bar.set_message(format!("{label}iteration {iteration}  violation {violation:.1e}"));
        let wanted = match self.level {
            Level::None => false,
            Level::Short => progress.iteration.is_multiple_of(SHORT),
            Level::Full => true,
        };
        if !wanted {
            return;
        }
        let line = line(progress, level, self.scale);
        let with_header = self.lines.is_multiple_of(PAGE);
        self.lines += 1;
        self.bar.suspend(|| {
            if with_header {
                tell(&format!("{label}{HEADER}\n"));
            }
            tell(&format!("{label}{line}\n"));
        });
    }

    /// The table of one of several solves that look for one answer.
    pub fn of_part(&self, label: &str) -> Self {
        Log { scale: self.scale, ..Log::of_several(self.level, &self.bar, &format!("{label} ")) }
    }

    /// How one of several solves ended.
    pub fn ended(&self, label: &str, ended: &Ended) {
        if self.level != Level::None {
            let status = ended.status.replace('_', " ");
            let told = match ended.is_good() {
                true => format!("{status:<18} objective {}", significant(ended.objective, 9)),
                false => status,
            };
            self.bar.suspend(|| tell(&format!(" {label:<9}  {told}\n")));
        }
    }

    /// Removes the progress line.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The progress of several solves, on a terminal only.
pub fn bar(level: Level, solves: usize) -> ProgressBar {
    progress(
        ProgressBar::new(solves as u64),
        level,
        "{spinner} {elapsed} {pos}/{len} {bar:20} {msg}",
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

fn line(p: &Progress, level: solve::Level, scale: f64) -> String {
    let logarithm =
        |value: f64| if value > 0.0 { format!("{:.1}", value.log10()) } else { "-".to_string() };
    let (mu, regularization) = (logarithm(p.mu), logarithm(p.regularization));
    let sigma = level.sigma.iter().fold(0.0f64, |a, sigma| a.max(*sigma));
    let sigma = if sigma > 0.0 { scientific(sigma / scale, 1) } else { "-".into() };
    let stages = level.stages.map(|stages| format!("x{stages}")).unwrap_or_default();
    let grid = format!("{}{stages}", level.intervals);
    format!(
        "{:5}{} {:>13} {:>8} {:>8} {:>5} {:>8} {:>5} {:>8} {:>8} {:>3}  {:>7} {:>6}",
        p.iteration,
        if p.restoration { 'r' } else { ' ' },
        scientific(p.objective, 6),
        scientific(p.primal_infeasibility, 2),
        scientific(p.dual_infeasibility, 2),
        mu,
        scientific(p.step, 2),
        regularization,
        scientific(p.alpha_dual, 2),
        scientific(p.alpha_primal, 2),
        p.trials,
        sigma,
        grid
    )
}
