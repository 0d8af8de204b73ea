//! Many solves of one model.

use super::multistart::is_stopped;
use super::{Options, Solution, Start};
use crate::error::Error;
use crate::model::{Model, Value};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

/// So many variants of a model with other settings of the method are kept, as they were compiled.
const MOST_VARIANTS: usize = 16;

/// A model that is solved for many cases: values of its parameters and of keys of its method. It is
/// compiled once for each combination of keys. A case with other parameters begins at the solution
/// for those of the model, never at that of another case: what comes out does not depend on which
/// cases there are, or on their order.
///
/// ```
/// use fdcc::{Cases, Model, Options};
///
/// let cases = Cases::new(&Model::from_file("../models/block.fdc")?);
/// for mu in [0.1, 0.2] {
///     let case = cases.case(&[("mu", mu.into()), ("sigma", 0.1.into()), ("N", 50.into())])?;
///     assert!(case.solve(&Options::default())?.is_solved());
/// }
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Cases {
    model: Model,
    variants: Mutex<Vec<(Keys, Arc<Variant>)>>,
}

/// Keys of the method with their values.
type Keys = Vec<(String, Value)>;

/// The model with some keys.
struct Variant {
    model: Model,
    is_compiled: AtomicBool,
    /// The solution for the parameters of the model, if there is one.
    base: OnceLock<Option<Solution>>,
}

/// The model with the values of one case.
///
/// ```
/// let cases = fdcc::Cases::new(&fdcc::Model::from_file("../models/block.fdc")?);
/// let case: fdcc::Case = cases.case(&[("mu", 0.2.into())])?;
/// assert!(!case.is_compiled() && case.model().name() == "block");
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone)]
pub struct Case {
    model: Model,
    variant: Arc<Variant>,
    has_params: bool,
}

impl Cases {
    /// Of a model.
    pub fn new(model: &Model) -> Self {
        Cases { model: model.clone(), variants: Mutex::default() }
    }

    /// The model with the values of a case; a name is a parameter or else a key of the method.
    ///
    /// # Errors
    ///
    /// Those of [`Model::with_all`].
    pub fn case(&self, values: &[(&str, Value)]) -> Result<Case, Error> {
        let (params, keys): (Vec<_>, Vec<_>) =
            values.iter().cloned().partition(|(name, _)| self.model.has_param(name));
        let variant = self.variant(&keys)?;
        let model = variant.model.with_all(&params)?;
        Ok(Case { model, variant, has_params: !params.is_empty() })
    }

    fn variant(&self, keys: &[(&str, Value)]) -> Result<Arc<Variant>, Error> {
        let is_same = |own: &Keys| {
            own.iter().map(|it| (it.0.as_str(), &it.1)).eq(keys.iter().map(|it| (it.0, &it.1)))
        };
        let mut variants = self.variants.lock().expect("nobody panics with the lock");
        if let Some((_, variant)) = variants.iter().find(|(own, _)| is_same(own)) {
            return Ok(variant.clone());
        }
        let model = self.model.with_all(keys)?;
        let (is_compiled, base) = (AtomicBool::new(false), OnceLock::new());
        let variant = Arc::new(Variant { model, is_compiled, base });
        if variants.len() == MOST_VARIANTS {
            variants.remove(0);
        }
        let own = keys.iter().map(|(name, value)| ((*name).to_owned(), value.clone()));
        variants.push((own.collect(), variant.clone()));
        Ok(variant)
    }
}

impl Variant {
    fn base(&self, options: &Options) -> Option<&Solution> {
        let solve = || {
            let found = self.model.solve(&Options { report: &|_| {}, ..*options });
            found.ok().filter(Solution::is_solved)
        };
        self.base.get_or_init(solve).as_ref()
    }
}

impl Case {
    /// The model with its values.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Whether it was compiled, by this case or another one with the same keys.
    pub fn is_compiled(&self) -> bool {
        self.variant.is_compiled.load(Ordering::Relaxed)
    }

    /// Compiles it for all cases with the same keys.
    ///
    /// # Errors
    ///
    /// Those of [`Model::compile`].
    pub fn compile(&self) -> Result<(), Error> {
        self.model.compile()?;
        self.variant.is_compiled.store(true, Ordering::Relaxed);
        Ok(())
    }

    /// Solves what cases with the same keys begin at, if none of them did: what its search may cost
    /// is not that of a case.
    pub fn prepare(&self, options: &Options) {
        if self.begins_at_base(options) {
            self.variant.base(options);
        }
    }

    fn begins_at_base(&self, options: &Options) -> bool {
        self.has_params && matches!(options.start, Start::Guess)
    }

    /// Solves, from the base unless the options name a start; from the guess where nothing is found
    /// from there, or where there is no other parameter.
    ///
    /// # Errors
    ///
    /// Those of [`Model::solve`].
    pub fn solve(&self, options: &Options) -> Result<Solution, Error> {
        let compiled = self.model.compile()?;
        let is_free = self.begins_at_base(options);
        let base = if is_free { self.variant.base(options) } else { None };
        let Some(base) = base else { return compiled.solve(options) };
        let found = compiled.solve(&Options { start: Start::Solution(base), ..*options })?;
        let is_over = found.is_solved() || is_stopped(&found.outcome.solution);
        if is_over { Ok(found) } else { compiled.solve(options) }
    }
}
