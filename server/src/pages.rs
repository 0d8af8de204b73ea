//! The page of each diagnostic as a file that an editor can open: the one that `fdcc explain`
//! prints.
//!
//! Pages are part of the program, so they are written where programs keep what they can make again.

use fdcc_grammar::Code;
use lsp_types::Uri;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// The address of the page of each code, in the order of [`Code::ALL`]; written when the first one
/// is asked for.
static LINKS: LazyLock<Vec<Option<Uri>>> =
    LazyLock::new(|| Code::ALL.iter().map(|code| written(*code)).collect());

/// The address of the page of a code, if there is a place for it.
pub fn link(code: Code) -> Option<Uri> {
    LINKS[code as usize].clone()
}

fn written(code: Code) -> Option<Uri> {
    let folder = folder()?.join("diagnostics");
    let path = folder.join(format!("{code}.md"));
    if fs::read_to_string(&path).ok().as_deref() != Some(code.page()) {
        fs::create_dir_all(&folder).ok()?;
        fs::write(&path, code.page()).ok()?;
    }
    address(&path)
}

/// Where `fdcc` keeps what it can make again.
pub fn folder() -> Option<PathBuf> {
    Some(cache()?.join("fdcc").join(env!("CARGO_PKG_VERSION")))
}

/// Where all programs do.
fn cache() -> Option<PathBuf> {
    let named = |name: &str| env::var_os(name).filter(|it| !it.is_empty()).map(PathBuf::from);
    named("XDG_CACHE_HOME")
        .or_else(|| named("LOCALAPPDATA"))
        .or_else(|| Some(named("HOME")?.join(".cache")))
        .filter(|it| it.is_absolute())
}

/// `file:///home/me/.cache/fdcc/0.1.0/FDC0101.md`
pub fn address(path: &Path) -> Option<Uri> {
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

/// The file at an address, if it is one.
pub fn path(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.0.strip_prefix("file://")?;
    let mut bytes = Vec::new();
    let mut left = rest.bytes();
    while let Some(byte) = left.next() {
        bytes.push(match byte {
            b'%' => {
                let digits = [left.next()?, left.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            byte => byte,
        });
    }
    let path = String::from_utf8(bytes).ok()?;
    // `/c:/models` on Windows
    let has_drive = path.as_bytes().get(2) == Some(&b':');
    Some(PathBuf::from(if has_drive { &path[1..] } else { &path }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_numbered_as_they_are_listed() {
        assert!(Code::ALL.iter().enumerate().all(|(at, code)| *code as usize == at));
    }

    #[test]
    fn an_address_leads_back_to_its_file() {
        let file = Path::new("/home/me/my models/θ.fdc");
        let uri = address(file).expect("it has an address");
        assert_eq!(uri.0, "file:///home/me/my%20models/%CE%B8.fdc");
        assert_eq!(path(&uri).as_deref(), Some(file));
        assert_eq!(path(&Uri("untitled:one".into())), None);
        assert_eq!(path(&Uri("file:///c%3A/x.fdc".into())), Some(PathBuf::from("c:/x.fdc")));
    }
}
