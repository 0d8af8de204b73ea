//! The command that is most likely to help, where there is one.

use crate::output::document::Document;

/// Where a width was named, and the true system does something else than what was planned with it.
pub(super) fn line(document: &Document) -> Option<String> {
    let differs = document.verification.as_ref().is_some_and(|it| !it.confirmed);
    let is_smoothed = document.certificate.is_none() && !document.method.sigmas.is_empty();
    (differs && is_smoothed).then(|| {
        " next  `--method sigma=0` looks for the optimum of the true system, with its switches \
         located"
            .into()
    })
}
