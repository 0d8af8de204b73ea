//! What is expected of a model: a file beside it, where every number has a tolerance and a source.
//!
//! ```text
//! # a comment
//! method sigma = 0.3
//! objective = 59.8359878  tol 1e-5  from "where this number is from"
//! objective <= 128.296842   tol 1e-5  from "one of several local minima"
//! x(end)    = 1           tol 1e-9  from "closed form: ..."
//! error FDC0603 "what the message begins with"
//! ```

/// A value of a solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// `objective`, `STATE(start)`, `STATE(end)`, or the name of an unknown.
    pub name: String,
    /// What it is.
    pub value: f64,
    /// How far the solution may be from it.
    pub tolerance: f64,
    /// Whether less is as good.
    pub is_limit: bool,
    /// Who says so.
    pub source: String,
}

/// The contents of such a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expected {
    /// Other settings.
    pub methods: Vec<(String, String)>,
    /// Values of the solution.
    pub values: Vec<Value>,
    /// Code and message of the diagnostic that compilation gives instead of a problem.
    pub error: Option<(String, String)>,
}

impl Expected {
    /// Reads the text of a file.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut expected = Expected::default();
        for line in
            text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
        {
            expected.line(line).ok_or_else(|| format!("not understood: {line}"))?;
        }
        Ok(expected)
    }

    fn line(&mut self, line: &str) -> Option<()> {
        if let Some(rest) = line.strip_prefix("error ") {
            let (code, message) = rest.split_once(' ')?;
            self.error = Some((code.into(), quoted(message)?));
            return Some(());
        }
        let (name, rest) = line.split_once('=').map(|(name, rest)| (name.trim(), rest.trim()))?;
        if let Some(name) = name.strip_suffix('<') {
            self.values.push(Value { is_limit: true, ..value(name.trim(), rest)? });
            return Some(());
        }
        if let Some(key) = name.strip_prefix("method ") {
            self.methods.push((key.into(), rest.into()));
        } else {
            self.values.push(value(name, rest)?);
        }
        Some(())
    }
}

fn value(name: &str, text: &str) -> Option<Value> {
    let (numbers, source) = text.split_once(" from ")?;
    let (number, tolerance) = numbers.split_once(" tol ")?;
    Some(Value {
        name: name.into(),
        value: number.trim().parse().ok()?,
        tolerance: tolerance.trim().parse().ok()?,
        source: quoted(source)?,
        is_limit: false,
    })
}

fn quoted(text: &str) -> Option<String> {
    let inside = text.trim().strip_prefix('"')?.strip_suffix('"')?;
    (!inside.is_empty()).then(|| inside.into())
}

#[cfg(test)]
mod tests {
    use super::Expected;

    #[test]
    fn a_number_without_a_source_is_refused() {
        assert!(Expected::read("objective = 1 tol 1e-6 from \"closed form\"").is_ok());
        for text in [
            "objective = 1",
            "objective = 1 tol 1e-6",
            "objective = 1 tol 1e-6 from \"\"",
            "objective 1",
        ] {
            Expected::read(text).expect_err(text);
        }
    }
}
