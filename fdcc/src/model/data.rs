//! Data files: found by the names that models give them, inside of one folder only.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// More is not read.
const MOST_BYTES: u64 = 64 << 20;

/// Where the texts of data files come from.
///
/// ```
/// let text = "data obs = csv(\"a.csv\") columns t, x\nfree p in [0, 9]\ntime t in [0, 2]
/// state x start 0\ndynamics { x' = p }\nminimize sum(k in obs, (x(k.t) - k.x)^2)";
/// let files = fdcc::DataFiles::from(|_| Ok("t,x\n1,0.5\n2,1\n".into()));
/// let model = fdcc::check_with("line", text.into(), Some(files)).into_model()?;
/// let p = model.solve(&fdcc::Options::default())?.value("p").expect("it is declared");
/// assert!((p - 0.5).abs() < 1e-6);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone)]
pub struct DataFiles(Arc<Load>);

type Load = dyn Fn(&str) -> Result<String, String> + Send + Sync;

impl DataFiles {
    /// The files inside of a folder and the folders in it; no others are opened.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        let folder = folder.into();
        DataFiles::from(move |name: &str| read(&folder, name))
    }

    /// The files beside a model.
    pub fn beside(model: &str) -> Self {
        let folder = Path::new(model).parent().filter(|folder| !folder.as_os_str().is_empty());
        DataFiles::in_folder(folder.unwrap_or(Path::new(".")))
    }

    /// Texts from anywhere, by the names that a model gives them; or why there is none.
    pub fn from(load: impl Fn(&str) -> Result<String, String> + Send + Sync + 'static) -> Self {
        DataFiles(Arc::new(load))
    }

    /// The text of a file.
    ///
    /// # Errors
    ///
    /// Why there is none, in words.
    pub fn text(&self, name: &str) -> Result<String, String> {
        (self.0)(name)
    }
}

fn read(folder: &Path, name: &str) -> Result<String, String> {
    let is_inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let outside = || Err(format!("it is not inside of `{}`", folder.display()));
    if !Path::new(name).components().all(is_inside) {
        return outside();
    }
    let no_file = |error: std::io::Error| format!("`{}`: {error}", folder.join(name).display());
    let real = |path: &Path| path.canonicalize().map_err(no_file);
    let (path, folder_path) = (real(&folder.join(name))?, real(folder)?);
    // A link may lead out of the folder.
    if !path.starts_with(&folder_path) {
        return outside();
    }
    let mut text = String::new();
    let file = File::open(&path).map_err(no_file)?;
    file.take(MOST_BYTES + 1).read_to_string(&mut text).map_err(no_file)?;
    match text.len() as u64 > MOST_BYTES {
        true => Err(format!("it has more than {} MiB", MOST_BYTES >> 20)),
        false => Ok(text),
    }
}
