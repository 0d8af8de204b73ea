//! Diagnostics as people read them, with the lines of the model. The only file that names miette.
//!
//! Our own [`Diagnostic`] holds no text; [`Report`] is the pair with its file, in miette's terms.

use std::borrow::Cow;
use std::fmt;
use std::io::IsTerminal;

use crate::drawing::fit::{CUT, Page};
use fdcc_grammar::{Code, Diagnostic, Label, Severity, SourceFile};
use miette::{
    LabeledSpan, MietteError, MietteHandler, MietteHandlerOpts, MietteSpanContents, ReportHandler,
    SourceCode, SourceSpan, SpanContents,
};

/// Where neither a terminal nor `COLUMNS` says how wide it is.
const WIDTH: usize = 100;

/// Words have to fit into a line.
const NARROWEST: usize = 40;

/// A longer line is not shown: no person has written it, and nobody wants a megabyte on the screen.
const LONGEST_LINE: usize = 500;

/// More places than this make no picture.
const MOST_LABELS: usize = 10;

/// Draws diagnostics for one stream.
pub struct Renderer {
    handler: MietteHandler,
    width: usize,
}

impl Renderer {
    /// As wide as the terminal, and in colour unless `NO_COLOR` is set; plain where there is no
    /// terminal.
    pub fn for_stdout() -> Self {
        Renderer::new(std::io::stdout().is_terminal())
    }

    /// The same for the standard error.
    pub fn for_stderr() -> Self {
        Renderer::new(std::io::stderr().is_terminal())
    }

    /// Without colours, for texts that others show.
    pub fn plain() -> Self {
        Renderer::new(false)
    }

    fn new(is_terminal: bool) -> Self {
        let no_color = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let options =
            MietteHandlerOpts::new().unicode(true).context_lines(1).color(is_terminal && !no_color);
        let terminal =
            is_terminal.then(terminal_size::terminal_size).flatten().map(|it| it.0.0.into());
        let columns = || std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
        let width = terminal.or_else(columns).unwrap_or(WIDTH).max(NARROWEST);
        let options = if is_terminal { options } else { options.terminal_links(false) };
        Renderer { handler: options.width(width).build(), width }
    }

    /// The diagnostic with the lines that it is about, and an empty line behind it.
    pub fn render(&self, diagnostic: &Diagnostic, source: &SourceFile) -> String {
        let last = diagnostic.labels.iter().map(|label| label.span.end).max().unwrap_or(0);
        let digits = (source.line_column(last).line + 1).to_string().len();
        let page = Page { width: self.width, digits };
        let text = &source.text;
        let fitting = |label: &Label| Label {
            text: page.label(&label.text, text, label.span.range()),
            ..label.clone()
        };
        let whole = Diagnostic {
            message: unbroken(&diagnostic.message),
            help: diagnostic.help.as_deref().map(unbroken),
            labels: diagnostic.labels.iter().map(fitting).collect(),
            ..diagnostic.clone()
        };
        let mut report = Report { diagnostic: &whole, source, page, text: Cow::Borrowed(text) };
        if report.has_lines() {
            let places: Vec<_> = whole.labels.iter().map(|label| label.span.range()).collect();
            report.text = page.lines(text, &places);
        }
        let drawn = format!("{}\n", Drawing { handler: &self.handler, report: &report });
        drawn.replace(NO_BREAK, " ").replace(CUT, "")
    }
}

/// A blank at which no line breaks.
const NO_BREAK: char = '\u{A0}';

/// A text in which no line breaks inside of `code`.
fn unbroken(text: &str) -> String {
    let part = |(at, part): (usize, &str)| {
        if at % 2 == 1 && !part.contains('\n') {
            part.replace(' ', "\u{A0}")
        } else {
            part.to_owned()
        }
    };
    text.split('`').enumerate().map(part).collect::<Vec<_>>().join("`")
}

/// miette draws into a formatter only.
struct Drawing<'r> {
    handler: &'r MietteHandler,
    report: &'r Report<'r>,
}

impl fmt::Display for Drawing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.handler.debug(self.report, f)
    }
}

/// A diagnostic and its file.
#[derive(Debug)]
struct Report<'r> {
    diagnostic: &'r Diagnostic,
    source: &'r SourceFile,
    page: Page,
    /// Its text as it is shown.
    text: Cow<'r, str>,
}

impl Report<'_> {
    /// Whether its lines can be shown: they are text and not too long, and all places are within
    /// the width.
    fn has_lines(&self) -> bool {
        let fits = |label: &Label| {
            let place = label.span.start as usize;
            self.line(place).len() <= LONGEST_LINE && self.page.holds(&self.source.text, place)
        };
        self.diagnostic.code != Code::NotText && self.diagnostic.labels.iter().all(fits)
    }

    fn line(&self, offset: usize) -> &str {
        let text = &self.source.text;
        let start = text[..offset].rfind('\n').map_or(0, |end| end + 1);
        text[start..].lines().next().unwrap_or_default()
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)?;
        if self.has_lines() {
            return Ok(());
        }
        let place = self.source.line_column(self.diagnostic.span().start);
        write!(
            f,
            "\n{}:{}:{}: {}",
            self.source.name,
            place.line,
            place.column,
            self.diagnostic.labels[0].text.replace('\n', " ")
        )
    }
}

impl std::error::Error for Report<'_> {}

impl miette::Diagnostic for Report<'_> {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.diagnostic.code))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
            Severity::Advice => miette::Severity::Advice,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.diagnostic.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.has_lines().then_some(self as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let labels =
            self.diagnostic.labels.iter().take(MOST_LABELS).enumerate().map(|(at, label)| {
                let (start, length) = (label.span.start as usize, label.span.range().len());
                let text = Some(label.text.clone());
                if at == 0 {
                    LabeledSpan::new_primary_with_span(text, (start, length))
                } else {
                    LabeledSpan::new(text, start, length)
                }
            });
        Some(Box::new(labels))
    }
}

/// Only the lines asked for are looked at: a text may be large, and have many diagnostics.
impl SourceCode for Report<'_> {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let text = &*self.text;
        // Without lines before it, miette wants the span itself: it prints where the contents
        // begin.
        let first_line =
            || (0..=lines_before).fold(span.offset(), |at, lines| line_start(text, at, lines));
        let start = if lines_before == 0 { span.offset() } else { first_line() };
        let end = (0..=lines_after)
            .fold(span.offset() + span.len(), |at, lines| line_end(text, at, lines));
        let data = &text.as_bytes()[start..end];
        let (name, place) = (self.source.name.clone(), self.source.line_column(start as u32));
        let contents = SourceSpan::from((start, end - start));
        let (line, column, lines) =
            (place.line - 1, place.column - 1, text[start..end].lines().count());
        Ok(Box::new(MietteSpanContents::new_named(name, data, contents, line, column, lines)))
    }
}

/// The beginning of the line of `at`, or of the line above it.
fn line_start(text: &str, at: usize, lines: usize) -> usize {
    let before = if lines == 0 { &text[..at] } else { &text[..at.saturating_sub(1)] };
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    if lines > 0 && at - start > LONGEST_LINE { at } else { start }
}

/// The end of the line of `at` with its line break, or of the line below it.
fn line_end(text: &str, at: usize, lines: usize) -> usize {
    let end = text[at..].find('\n').map_or(text.len(), |end| at + end + 1);
    if lines > 0 && end - at > LONGEST_LINE { at } else { end }
}
