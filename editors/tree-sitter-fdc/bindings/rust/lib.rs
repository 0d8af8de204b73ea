//! The tree-sitter grammar of `.fdc` models and what editors ask of its trees.

use tree_sitter_language::LanguageFn;

unsafe extern "C" {
    fn tree_sitter_fdc() -> *const ();
}

/// The grammar.
// SAFETY: the function is the one that tree-sitter generated; it returns a pointer to a table that
// lives for ever.
pub const LANGUAGE: LanguageFn = unsafe { LanguageFn::from_raw(tree_sitter_fdc) };

/// Each query with its name.
pub const QUERIES: [(&str, &str); 4] = [
    ("highlights", include_str!("../../queries/highlights.scm")),
    ("folds", include_str!("../../queries/folds.scm")),
    ("indents", include_str!("../../queries/indents.scm")),
    ("injections", include_str!("../../queries/injections.scm")),
];
