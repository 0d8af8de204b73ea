//! Whether the signals of a `.sol.json` fit its times: half of a solution is none to start from, to
//! replay or to draw.

/// What is looked at of a solution, or of one of its phases.
pub struct Signals<'s> {
    /// What stands before the names of its fields: `phases.boost.`.
    pub prefix: String,
    pub time: &'s [f64],
    /// Which times may stand twice.
    pub twice: Twice,
    /// With a value at each time.
    pub states: Vec<(&'s str, &'s [f64])>,
    /// With a value for each interval.
    pub controls: Vec<(&'s str, &'s [f64])>,
}

/// Which times may stand twice.
pub enum Twice {
    /// Those at which the state jumps.
    At(Vec<f64>),
    /// All: what takes no time can be drawn, and a phase may take none.
    Any,
}

impl Signals<'_> {
    /// Says what is no number, what is too short or too long, and which time follows a later one.
    pub fn check(&self) -> Result<(), String> {
        let Signals { prefix, time, .. } = self;
        is_whole(&format!("{prefix}time"), time)?;
        let intervals = time.len().saturating_sub(1);
        let groups =
            [("states", &self.states, time.len()), ("controls", &self.controls, intervals)];
        for (group, signals, length) in groups {
            for (name, values) in signals {
                let field = format!("{prefix}{group}.{name}");
                is_whole(&field, values)?;
                has_length(&field, values.len(), length)?;
            }
        }
        self.is_ascending()
    }

    fn is_ascending(&self) -> Result<(), String> {
        let may_repeat = |time: f64| match &self.twice {
            Twice::At(times) => times.contains(&time),
            Twice::Any => true,
        };
        let is_wrong =
            |pair: &[f64]| pair[1] < pair[0] || pair[1] == pair[0] && !may_repeat(pair[0]);
        let Some(at) = self.time.windows(2).position(is_wrong) else { return Ok(()) };
        let [before, after] = [self.time[at], self.time[at + 1]];
        let (field, place) = (format!("{}time", self.prefix), at + 2);
        Err(format!("`{field}`: times must ascend, but {after} follows {before} at {place}"))
    }
}

fn is_whole(field: &str, values: &[f64]) -> Result<(), String> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(at) => Err(format!("value {} of `{field}` is no number", at + 1)),
        None => Ok(()),
    }
}

/// Whether a signal has as many values as its times ask for.
pub fn has_length(field: &str, found: usize, length: usize) -> Result<(), String> {
    match found == length {
        true => Ok(()),
        false => Err(format!("`{field}` has {found} values where there should be {length}")),
    }
}
