//! The name that was meant.

/// The known name that is nearest to a misspelt one, if any is near.
pub fn closest<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let (length, lower) = (name.chars().count(), name.to_lowercase());
    let distance = |candidate: &'n str| {
        let resized = length.abs_diff(candidate.chars().count());
        // What differs in length alone by more is not worth a comparison: large models have
        // thousands of names.
        if candidate == name || resized > length / 3 {
            return None;
        }
        // `mun` for `muN` is nearer than `mu`.
        let folded = strsim::osa_distance(&lower, &candidate.to_lowercase());
        let exact = || strsim::osa_distance(name, candidate);
        (folded <= length / 3).then(|| ((folded, exact(), resized), candidate))
    };
    known.filter_map(distance).min_by_key(|it| it.0).map(|(_, candidate)| candidate)
}
