//! The one place that writes files.
//!
//! A file is as it was or as it should be, whatever stops the program: its new content is put
//! beside it under another name, is brought to the disk, and takes its name in one step.

use crate::failure::Failure;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes files `NAME.ENDING` to a folder, which is made if need be; returns their paths.
pub fn write_all(
    folder: &Path,
    name: &str,
    files: &[(&str, String)],
) -> Result<Vec<String>, Failure> {
    fs::create_dir_all(folder).map_err(|error| failure(folder, &error))?;
    let mut paths = Vec::new();
    for (ending, text) in files {
        let path = folder.join(format!("{name}.{ending}"));
        write_file(&path, text)?;
        paths.push(path.display().to_string());
    }
    Ok(paths)
}

/// Writes a file, or replaces the one that is there.
pub fn write_file(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    replace(path, content).map_err(|error| failure(path, &error))
}

fn failure(place: &Path, error: &io::Error) -> Failure {
    Failure::File(format!("cannot write to {}: {error}", place.display()))
}

/// Writes a file that must not be there yet.
pub fn create(path: &Path, text: &str) -> io::Result<()> {
    // The name is taken first, so that nothing can be overwritten.
    OpenOptions::new().write(true).create_new(true).open(path)?;
    replace(path, text).inspect_err(|_| drop(fs::remove_file(path)))
}

/// Gives a file this content, or leaves it as it is. A symbolic link stays one: the file that it
/// leads to is replaced.
pub fn replace(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    let content = content.as_ref();
    let path = followed(path)?;
    // What may not be written, such as a read-only file, is not replaced either.
    let old = match OpenOptions::new().write(true).open(&path) {
        Ok(mut old) if !old.metadata()?.is_file() => return old.write_all(content),
        Ok(old) => Some(old.metadata()?),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    let folder = path.parent().filter(|it| !it.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (beside, file) = new_file(folder)?;
    let written = fill(file, content, old.as_ref()).and_then(|()| fs::rename(&beside, &path));
    written.inspect_err(|_| drop(fs::remove_file(&beside)))?;
    sync_folder(folder);
    Ok(())
}

/// Where a path leads to, past all symbolic links.
fn followed(path: &Path) -> io::Result<PathBuf> {
    match (fs::canonicalize(path), fs::read_link(path)) {
        (Err(error), Ok(to)) if error.kind() == ErrorKind::NotFound => {
            followed(&path.parent().unwrap_or(Path::new("")).join(to))
        }
        (Err(error), _) if error.kind() == ErrorKind::NotFound => Ok(path.to_owned()),
        (found, _) => found,
    }
}

/// A new file under a name of its own.
fn new_file(folder: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    loop {
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = folder.join(format!(".fdcc-{}-{number}.tmp", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            // Left by a process that had the same number and was killed.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            opened => return Ok((path, opened?)),
        }
    }
}

/// Writes a content to the disk, with the owner and the permissions of the file that it replaces.
fn fill(mut file: File, content: &[u8], old: Option<&Metadata>) -> io::Result<()> {
    file.write_all(content)?;
    if let Some(old) = old {
        keep_owner(&file, old);
        file.set_permissions(old.permissions())?;
    }
    file.sync_all()
}

/// As far as the system allows: only the superuser can give files away.
#[cfg(unix)]
fn keep_owner(file: &File, old: &Metadata) {
    use std::os::unix::fs::{MetadataExt, fchown};
    let _ = fchown(file, Some(old.uid()), Some(old.gid()));
}

#[cfg(not(unix))]
fn keep_owner(_: &File, _: &Metadata) {}

/// Brings the new name to the disk, too. Some systems cannot; the file is whole all the same.
fn sync_folder(folder: &Path) {
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}
