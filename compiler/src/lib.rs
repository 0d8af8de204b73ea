//! From the syntax tree to compiled functions.
