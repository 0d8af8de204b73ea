//! Patterns of file names: which names match one, and in which order they are taken.

use std::cmp::Ordering;
use std::iter::Peekable;
use std::str::Chars;

/// Whether a name is a pattern, which stands for any number of files.
pub(crate) fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?'])
}

/// Whether a file name matches a pattern: `*` is any text, `?` any character, and neither goes
/// beyond `/` or begins with the dot of a hidden file.
///
/// ```
/// assert!(fdcc_compiler::matches("runs/run*.csv", "runs/run12.csv"));
/// assert!(!fdcc_compiler::matches("*.csv", "runs/run12.csv"));
/// ```
pub fn matches(pattern: &str, name: &str) -> bool {
    let (parts, names) = (pattern.split('/'), name.split('/'));
    parts.clone().count() == names.clone().count()
        && parts.zip(names).all(|(part, name)| matches_part(part, name))
}

fn matches_part(pattern: &str, name: &str) -> bool {
    let is_hidden = name.starts_with('.') && !pattern.starts_with('.');
    let [pattern, name] = [pattern, name].map(|text| text.chars().collect::<Vec<char>>());
    let (mut at, mut next) = (0, 0);
    // Where the last `*` stands, and how much of the name it has taken.
    let mut star: Option<(usize, usize)> = None;
    while next < name.len() {
        match pattern.get(at) {
            Some('*') => {
                star = Some((at, next));
                at += 1;
            }
            Some(letter) if *letter == '?' || *letter == name[next] => {
                (at, next) = (at + 1, next + 1)
            }
            _ => {
                let Some((place, taken)) = star else { return false };
                star = Some((place, taken + 1));
                (at, next) = (place + 1, taken + 1);
            }
        }
    }
    !is_hidden && pattern[at..].iter().all(|letter| *letter == '*')
}

/// The order of names as people count: `run2` stands before `run10`.
pub(crate) fn natural_order(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a.chars().peekable(), b.chars().peekable());
    loop {
        let order = match (left.peek().copied(), right.peek().copied()) {
            (Some(x), Some(y)) if x.is_ascii_digit() && y.is_ascii_digit() => {
                let [x, y] = [digits(&mut left), digits(&mut right)];
                (x.len(), x).cmp(&(y.len(), y))
            }
            (None, None) => return a.cmp(b),
            (x, y) => {
                left.next();
                right.next();
                x.cmp(&y)
            }
        };
        if order.is_ne() {
            return order;
        }
    }
}

/// The number that stands next, without zeros in front: it may have any length.
fn digits(text: &mut Peekable<Chars<'_>>) -> String {
    let number: String = std::iter::from_fn(|| text.next_if(char::is_ascii_digit)).collect();
    number.trim_start_matches('0').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_is_any_text_of_one_folder() {
        for (pattern, name) in [
            ("runs*.csv", "runs1.csv"),
            ("runs*.csv", "runs.csv"),
            ("*", "a"),
            ("*a*b*", "xaabyb"),
            ("run?.csv", "runé.csv"),
            ("runs/*/x.csv", "runs/one/x.csv"),
            ("./a*", "./ab"),
            (".a*", ".ab"),
            ("plain.csv", "plain.csv"),
        ] {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [
            ("runs*.csv", "run1.csv"),
            ("runs*.csv", "runs1.csv.bak"),
            ("run?.csv", "run.csv"),
            ("*.csv", "runs/a.csv"),
            ("*", ".hidden"),
            ("*a", ""),
            ("[ab].csv", "a.csv"),
        ] {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }

    #[test]
    fn numbers_in_names_are_counted() {
        let mut names = ["r10", "r2b", "r1", "r02", "r2", "q99", "r", "r18446744073709551617"];
        names.sort_by(|a, b| natural_order(a, b));
        let counted = ["q99", "r", "r1", "r02", "r2", "r2b", "r10", "r18446744073709551617"];
        assert_eq!(names, counted);
    }
}
