//! Files that are read: at most so much of one, so that `/dev/zero` does not fill the memory.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Solutions and control files beyond this size are refused.
pub const MOST_BYTES: u64 = 256 << 20;

/// The text of a file, which may be a pipe.
///
/// # Errors
///
/// A file that cannot be read, that is no text, or that has more than [`MOST_BYTES`].
pub fn text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_string(&mut text)?;
    match text.len() as u64 > MOST_BYTES {
        true => Err(io::Error::other(format!("it has more than {} MiB", MOST_BYTES >> 20))),
        false => Ok(text),
    }
}
