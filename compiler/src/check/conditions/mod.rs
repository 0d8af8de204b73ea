//! Checks of what is demanded: bounds, conditions at the ends and on the way, values, links.

pub(super) mod around;
pub(super) mod at_times;
pub(super) mod bounds;
pub(super) mod contradictions;
pub(super) mod ends;
pub(super) mod links;
pub(super) mod values;
