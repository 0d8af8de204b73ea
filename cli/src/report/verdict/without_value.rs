//! What is said of a sequence of jumps that could not be searched, because something, such as what
//! a jump assigns, has no value: the guess has to arrive where it has one.

use fdcc::{Sequence, Solution};
use fdcc_grammar::{Diagnostic, Label, Span};

/// What has no value, for a sequence whose solve ended so.
#[derive(Clone)]
pub struct WithoutValue {
    /// The sequence.
    sequence: String,
    /// What has no value, as it is written.
    text: String,
    span: Span,
    /// Whether that is so where the search begins.
    is_of_guess: bool,
}

impl WithoutValue {
    /// That of a sequence, if its solve ended so.
    pub fn of(solution: &Solution, sequence: &Sequence) -> Option<Self> {
        let of = sequence.ended.without_value.as_ref()?;
        let span = Span { start: of.span.0, end: of.span.1 };
        let written = solution.model().source().slice(span);
        let is_short = !written.is_empty() && !written.contains('\n');
        Some(WithoutValue {
            sequence: sequence.words.clone(),
            text: if is_short { written.into() } else { of.label.to_string() },
            span,
            is_of_guess: sequence.ended.iterations == 0,
        })
    }

    /// What it is, and what to do.
    pub fn words(&self) -> String {
        format!(
            "{}: give a `guess` that arrives there with a state for which it has one",
            self.finding()
        )
    }

    fn finding(&self) -> String {
        let place = match self.is_of_guess {
            true => "on the guess",
            false => "where the search from the guess led",
        };
        format!("`{}` has no value {place}", self.text)
    }

    /// What is said of a failed solve, with this as the first place.
    pub fn before(&self, found: Diagnostic) -> Diagnostic {
        let WithoutValue { sequence, span, .. } = self;
        let own = Label { span: *span, text: format!("with `{sequence}` this has no value") };
        let help = format!(
            "nothing could be found out about `{sequence}`: give a `guess` that arrives there with \
             a state for which it has a value. Of the others: {}",
            found.help.unwrap_or_default()
        );
        Diagnostic {
            message: format!("no feasible trajectory found: {}", self.finding()),
            labels: std::iter::once(own).chain(found.labels).collect(),
            help: Some(help),
            ..found
        }
    }
}
