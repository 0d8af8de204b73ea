//! The page of each diagnostic as a file that an editor can open: the one that `fdcc explain` prints.
//!
//! Pages are part of the program, so they are written where programs keep what they can make again.

use fdcc_grammar::Code;
use lsp_types::Uri;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The address of the page of a code, if there is a place for it.
pub fn link(code: Code) -> Option<Uri> {
    let folder = cache()?.join("fdcc").join(env!("CARGO_PKG_VERSION"));
    let path = folder.join(format!("{code}.md"));
    if fs::read_to_string(&path).ok().as_deref() != Some(code.page()) {
        fs::create_dir_all(&folder).ok()?;
        fs::write(&path, code.page()).ok()?;
    }
    address(&path)
}

/// Where a program keeps what it can make again.
fn cache() -> Option<PathBuf> {
    let named = |name: &str| env::var_os(name).filter(|it| !it.is_empty()).map(PathBuf::from);
    named("XDG_CACHE_HOME")
        .or_else(|| named("LOCALAPPDATA"))
        .or_else(|| Some(named("HOME")?.join(".cache")))
        .filter(|it| it.is_absolute())
}

/// `file:///home/me/.cache/fdcc/0.1.0/FDC0101.md`
fn address(path: &Path) -> Option<Uri> {
    let text = path.to_str()?.replace('\\', "/");
    let mut address = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for byte in text.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                address.push(byte as char)
            }
            _ => address += &format!("%{byte:02X}"),
        }
    }
    Some(Uri(address))
}
