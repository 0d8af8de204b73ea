//! The controls of a simulation: the model's guess, or values that are held from row to row.

/// Where the controls come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Controls {
    /// The guess of the model.
    Guess,
    /// Row `i` holds from `times[i]` to the next; the first holds before, too.
    Held {
        /// Ascending.
        times: Vec<f64>,
        /// One row of controls for each time.
        rows: Vec<Vec<f64>>,
        /// Whether the times are parts of the interval and move with its ends, as those of a
        /// solution; else they stand still.
        is_stretched: bool,
    },
}

impl Controls {
    /// Where controls may jump strictly between two times.
    pub(crate) fn breaks(&self, first: f64, last: f64) -> Vec<f64> {
        match self {
            Controls::Guess => Vec::new(),
            Controls::Held { times, .. } => {
                times.iter().copied().filter(|time| *time > first && *time < last).collect()
            }
        }
    }

    /// The place of the row that holds from a time on.
    pub(crate) fn index(&self, time: f64) -> Option<usize> {
        match self {
            Controls::Guess => None,
            Controls::Held { times, .. } => {
                Some(times.partition_point(|other| *other <= time).saturating_sub(1))
            }
        }
    }

    /// A row.
    pub(crate) fn row(&self, index: Option<usize>) -> &[f64] {
        match self {
            Controls::Guess => &[],
            Controls::Held { rows, .. } => {
                index.and_then(|index| rows.get(index)).map_or(&[], Vec::as_slice)
            }
        }
    }
}
