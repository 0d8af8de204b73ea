//! The command `fdcc`.
fn main() {}
