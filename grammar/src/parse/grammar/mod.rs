//! The grammar: the parser that pest generates from `fdc.pest`, and what it says of a text.

use pest::Parser as _;
use pest::error::{ErrorVariant, InputLocation};
use pest::iterators::Pairs;

/// The generated parser.
#[derive(pest_derive::Parser)]
#[grammar = "fdc.pest"]
struct Grammar;

/// What the grammar makes of a text, or the byte where it gave up and what it would have gone on
/// with.
pub(crate) fn pairs(rule: Rule, text: &str) -> Result<Pairs<'_, Rule>, (usize, Vec<Rule>)> {
    Grammar::parse(rule, text).map_err(|error| {
        let (InputLocation::Pos(at) | InputLocation::Span((at, _))) = error.location;
        let ErrorVariant::ParsingError { positives, .. } = error.variant else {
            return (at, Vec::new());
        };
        (at, positives)
    })
}
