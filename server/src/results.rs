//! What the last solve of a text said, shown in it until it is another text.

use lsp_types::Uri;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The results of all texts; shared with the threads that wait for them.
#[derive(Clone, Default)]
pub struct Results(Arc<Mutex<HashMap<String, Said>>>);

/// What was said of a text.
#[derive(Clone)]
pub struct Said {
    text: Arc<str>,
    lines: Vec<String>,
}

impl Results {
    /// Keeps what `fdcc solve` printed about a text.
    pub fn keep(&self, uri: &Uri, text: &Arc<str>, output: &str) {
        let said = Said { text: text.clone(), lines: output.lines().map(str::to_owned).collect() };
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(uri.0.clone(), said);
    }

    /// What was said of this text, and of no other one at its address.
    pub fn of(&self, uri: &Uri, text: &str) -> Option<Said> {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.get(&uri.0).filter(|said| *said.text == *text).cloned()
    }
}

impl Said {
    /// `done: local optimum of the true system, 65.9568257 N^2 s`
    pub fn answer(&self) -> Option<String> {
        let (word, verdict) = ["done", "stop"]
            .into_iter()
            .find_map(|word| Some((word, self.lines.iter().find_map(|it| begun(it, word))?)))?;
        let end = verdict.find([',', ';', '(', ':']).unwrap_or(verdict.len());
        let mut said = format!("{word}: {}", verdict[..end].trim());
        let value = self.lines.iter().find_map(|it| begun(it, "objective"));
        if let (true, Some(value)) = (word == "done", value) {
            // Unknowns follow behind three blanks.
            said += &format!(", {}", value.split("   ").next().unwrap_or_default());
        }
        Some(said)
    }

    /// `held 0-1.568, above 1.568-2.996 s`: what a surface did.
    pub fn of_surface(&self, name: &str) -> Option<&str> {
        let is_modes =
            |it: &&str| ["held ", "above ", "below "].iter().any(|it_is| it.starts_with(it_is));
        let said = self.lines.iter().filter_map(|it| begun(it, name)).find(is_modes)?;
        said.split("   ").next()
    }
}

/// What stands behind the first word of a line, if that is this one.
fn begun<'l>(line: &'l str, word: &str) -> Option<&'l str> {
    let rest = line.trim_start().strip_prefix(word)?;
    rest.starts_with(' ').then(|| rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRINTED: &str = " block   2 states\n \
        done  local optimum of the true system, 2 switches located\n       \
        objective 65.9568257 N^2 s   T 3 s\n slip  held 0-1.568, above 1.568-4 s   (sigma 1)\n \
        true  replayed: objective 65 N^2 s\n";

    #[test]
    fn a_result_is_that_of_its_text_alone() {
        let (results, uri) = (Results::default(), Uri("file:///a.fdc".into()));
        results.keep(&uri, &"model a".into(), PRINTED);
        assert!(results.of(&uri, "model b").is_none());
        let said = results.of(&uri, "model a").expect("it was kept");
        let answer = "done: local optimum of the true system, 65.9568257 N^2 s";
        assert_eq!(said.answer().as_deref(), Some(answer));
        assert_eq!(said.of_surface("slip"), Some("held 0-1.568, above 1.568-4 s"));
        assert_eq!(said.of_surface("sli"), None);
    }

    #[test]
    fn what_is_not_solved_has_no_objective() {
        let printed = " stop  NOT SOLVED, found none from this guess: 12\n       objective 3 N\n";
        let said = Said { text: "".into(), lines: printed.lines().map(str::to_owned).collect() };
        assert_eq!(said.answer().as_deref(), Some("stop: NOT SOLVED"));
    }
}
