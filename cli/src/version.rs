//! Which program this is.

use std::sync::LazyLock;

/// As in documents.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The commit and its date.
pub const BUILD: &str = env!("FDCC_BUILD");

/// `0.1.0 (1a2b3c4d 2026-11-23, x86_64 with avx2 fma)`: all that results depend on.
pub static LONG: LazyLock<String> = LazyLock::new(|| {
    let features = features();
    let with = if features.is_empty() { "" } else { " with " };
    format!("{VERSION} ({BUILD}, {}{with}{features})", std::env::consts::ARCH)
});

/// What the processor has of what is used where it is there.
fn features() -> String {
    #[cfg(target_arch = "x86_64")]
    let known = [
        ("avx2", std::is_x86_feature_detected!("avx2")),
        ("fma", std::is_x86_feature_detected!("fma")),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let known: [(&str, bool); 0] = [];
    known.iter().filter(|it| it.1).map(|it| it.0).collect::<Vec<_>>().join(" ")
}
