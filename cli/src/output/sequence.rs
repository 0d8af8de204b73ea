//! What follows what in a certified answer: the modes of its surfaces, the arcs of its controls and
//! conditions, its jumps. Where it changes from row to row of a sweep, so does the kind of optimum.

use super::document::Document;
use super::modes::{Span, order};
use super::named::Named;
use super::rows::Scalars;

/// For each surface, control, limit and `jumps` what it does, one after the other, without times.
pub type Sequence = Named<Vec<String>>;

/// That of a certified answer; nothing of others.
pub fn of(document: &Document) -> Sequence {
    let certificate = document.certificate.as_ref().filter(|it| it.certified);
    let Some(certificate) = certificate else { return Named(Vec::new()) };
    let own = document.surfaces.0.iter().map(|(name, spans)| (name.clone(), spans));
    let in_phases = document.phases.0.iter().flat_map(|(phase, it)| {
        it.0.surfaces.0.iter().map(move |(name, spans)| (format!("{phase}.{name}"), spans))
    });
    let arcs = certificate.arcs.0.iter().filter(|(_, all)| all.iter().any(|it| it.mode != "free"));
    let arcs = arcs.map(|(name, spans)| (name.clone(), spans));
    let words = |(name, spans): (String, &Vec<Span>)| (name, order(spans));
    let mut all: Vec<_> = own.chain(in_phases).chain(arcs).map(words).collect();
    let jumps: Vec<String> = document.all_jumps().into_iter().map(|it| it.0).collect();
    if !jumps.is_empty() {
        all.push(("jumps".into(), jumps));
    }
    Named(all)
}

/// `slip held, below; F max, min`
pub fn words(sequence: &Sequence) -> String {
    let own = |(name, all): &(String, Vec<String>)| format!("{name} {}", all.join(", "));
    sequence.0.iter().map(own).collect::<Vec<_>>().join("; ")
}

/// The different sequences of some rows, in the order in which they come; `A` is the first.
pub struct Sequences(Vec<Sequence>);

impl Sequences {
    pub fn new<'r>(rows: impl Iterator<Item = &'r Scalars>) -> Self {
        let mut all: Vec<Sequence> = Vec::new();
        for row in rows.filter(|it| !it.sequence.is_empty()) {
            if !all.contains(&row.sequence) {
                all.push(row.sequence.clone());
            }
        }
        Sequences(all)
    }

    /// Whether it changes from row to row.
    pub fn differ(&self) -> bool {
        self.0.len() > 1
    }

    /// That of a row; `-` where nothing is certified.
    pub fn letter(&self, row: &Scalars) -> String {
        self.0.iter().position(|it| *it == row.sequence).map_or("-".into(), letter)
    }

    /// Each with its letter and in words.
    pub fn all(&self) -> impl Iterator<Item = (String, String)> {
        self.0.iter().enumerate().map(|(at, it)| (letter(at), words(it)))
    }

    /// Below a table of rows: a line for each, or one if all are the same.
    pub fn lines(&self) -> String {
        match &self.0[..] {
            [] => String::new(),
            [one] => format!(" one sequence in all certified rows: {}\n", words(one)),
            _ => self.all().map(|(letter, words)| format!(" {letter}  {words}\n")).collect(),
        }
    }
}

/// `A` to `Z`, then `AA` and so on.
fn letter(at: usize) -> String {
    let last = char::from(b'A' + (at % 26) as u8);
    if at < 26 { last.into() } else { letter(at / 26 - 1) + &String::from(last) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_go_on_behind_the_last() {
        let all = [0, 25, 26, 27, 701, 702].map(letter);
        assert_eq!(all, ["A", "Z", "AA", "AB", "ZZ", "AAA"]);
    }
}
