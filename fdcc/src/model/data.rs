//! Data files: found by the names that models give them, inside of one folder only.

use fdcc_compiler::{Files, matches};
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
pub struct DataFiles {
    load: Arc<Load>,
    list: Option<Arc<List>>,
}

type Load = dyn Fn(&str) -> Result<String, String> + Send + Sync;
type List = dyn Fn(&str) -> Result<Vec<String>, String> + Send + Sync;

impl DataFiles {
    /// The files inside of a folder and the folders in it; no others are opened.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        let folder = folder.into();
        let here = folder.clone();
        DataFiles::from(move |name: &str| read(&folder, name))
            .with_names(move |pattern| list(&here, pattern))
    }

    /// The files beside a model.
    pub fn beside(model: &str) -> Self {
        let folder = Path::new(model).parent().filter(|folder| !folder.as_os_str().is_empty());
        DataFiles::in_folder(folder.unwrap_or(Path::new(".")))
    }

    /// Texts from anywhere, by the names that a model gives them; or why there is none. A pattern,
    /// as in `for each csv("runs*.csv")`, matches nothing unless [`DataFiles::with_names`] says
    /// which there are.
    pub fn from(load: impl Fn(&str) -> Result<String, String> + Send + Sync + 'static) -> Self {
        DataFiles { load: Arc::new(load), list: None }
    }

    /// The same with the names of the files that match a pattern, or why they are not known. They
    /// may be in any order, and names that do not match are passed over.
    ///
    /// ```
    /// let text = "free p in [0, 9]
    /// phase run for each csv(\"a*.csv\") columns t, x {
    ///   time t in [0, 2]\nstate x start 0\ndynamics { x' = p }\nfit run: x sd 0.1\n}";
    /// let files = fdcc::DataFiles::from(|_| Ok("t,x\n1,0.5\n2,1\n".into()))
    ///     .with_names(|_| Ok(vec!["a1.csv".into(), "a2.csv".into(), "b.csv".into()]));
    /// let model = fdcc::check_with("two lines", text.into(), Some(files)).into_model()?;
    /// let read: Vec<String> = model.data()?.into_iter().map(|file| file.0).collect();
    /// assert_eq!(read, ["a1.csv", "a2.csv"]);
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    pub fn with_names(
        self,
        list: impl Fn(&str) -> Result<Vec<String>, String> + Send + Sync + 'static,
    ) -> Self {
        DataFiles { list: Some(Arc::new(list)), ..self }
    }

    /// The text of a file.
    ///
    /// # Errors
    ///
    /// Why there is none, in words.
    pub fn text(&self, name: &str) -> Result<String, String> {
        (self.load)(name)
    }
}

impl Files for DataFiles {
    fn text(&self, name: &str) -> Result<String, String> {
        self.text(name)
    }

    fn names(&self, pattern: &str) -> Result<Vec<String>, String> {
        match &self.list {
            Some(list) => list(pattern),
            None => Err("nothing says which files there are".into()),
        }
    }
}

fn outside(folder: &Path) -> String {
    format!("it is not inside of `{}`", folder.display())
}

/// Whether a name goes down from a folder, as far as it can be told without looking.
fn goes_down(name: &str) -> bool {
    let is_inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    Path::new(name).components().all(is_inside)
}

fn read(folder: &Path, name: &str) -> Result<String, String> {
    let path = inside(folder, name)?;
    let no_file = |error: std::io::Error| format!("`{}`: {error}", folder.join(name).display());
    let mut text = String::new();
    let file = File::open(&path).map_err(no_file)?;
    file.take(MOST_BYTES + 1).read_to_string(&mut text).map_err(no_file)?;
    match text.len() as u64 > MOST_BYTES {
        true => Err(format!("it has more than {} MiB", MOST_BYTES >> 20)),
        false => Ok(text),
    }
}

/// Where a name leads, unless that is out of the folder.
fn inside(folder: &Path, name: &str) -> Result<PathBuf, String> {
    if !goes_down(name) {
        return Err(outside(folder));
    }
    let real =
        |path: &Path| path.canonicalize().map_err(|error| format!("`{}`: {error}", path.display()));
    let (path, folder_path) = (real(&folder.join(name))?, real(folder)?);
    // A link may lead out of the folder.
    if path.starts_with(&folder_path) { Ok(path) } else { Err(outside(folder)) }
}

/// The names inside of a folder that match a pattern: part by part, since a folder may be one, too.
fn list(folder: &Path, pattern: &str) -> Result<Vec<String>, String> {
    if !goes_down(pattern) {
        return Err(outside(folder));
    }
    let mut names = vec![String::new()];
    for part in pattern.split('/') {
        let mut deeper = Vec::new();
        for name in names {
            deeper.extend(one_level(folder, &name, part)?);
        }
        names = deeper;
    }
    Ok(names.into_iter().map(|name| name[1..].to_owned()).collect())
}

/// The names in a folder of the folder that match one part of a pattern, each behind a `/`.
fn one_level(folder: &Path, above: &str, part: &str) -> Result<Vec<String>, String> {
    let below = |name: &str| format!("{above}/{name}");
    if !part.contains(['*', '?']) {
        let is_there = folder.join(&below(part)[1..]).exists();
        return Ok(is_there.then(|| below(part)).into_iter().collect());
    }
    let place = if above.is_empty() { "." } else { &above[1..] };
    // What is no folder, or leads out of it, has no files for this model.
    let Ok(path) = inside(folder, place) else { return Ok(Vec::new()) };
    if !path.is_dir() {
        return Ok(Vec::new());
    }
    let entries = path.read_dir().map_err(|error| format!("`{}`: {error}", path.display()))?;
    let names = entries.flatten().map(|entry| entry.file_name());
    let names = names.filter_map(|name| name.into_string().ok());
    Ok(names.filter(|name| matches(part, name)).map(|name| below(&name)).collect())
}
