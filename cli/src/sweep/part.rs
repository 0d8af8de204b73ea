//! A part of a sweep, for one of several processes.

use std::str::FromStr;

/// Every nth row, from the ith on.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    i: usize,
    n: usize,
}

impl Part {
    /// Of everything.
    pub const WHOLE: Part = Part { i: 1, n: 1 };

    /// Whether a row, counted from 0, is in it.
    pub fn has(&self, row: usize) -> bool {
        row % self.n == self.i - 1
    }

    /// What its file is called after: `2-of-8`.
    pub fn words(&self) -> String {
        format!("{}-of-{}", self.i, self.n)
    }
}

impl FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|it: &usize| *it > 0);
        let numbers = text.split_once('/').map(|(i, n)| (number(i), number(n)));
        match numbers {
            Some((Some(i), Some(n))) if i <= n => Ok(Part { i, n }),
            _ => Err("it needs I/N, as in 1/4 to 4/4".into()),
        }
    }
}
