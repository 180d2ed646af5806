//! "Did you mean": the nearest of the words that would be right.

/// The candidate nearest to a word, if it is near enough to be a slip of the pen.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    if word.is_empty() || word.len() > LONGEST {
        return None;
    }
    let folded = word.to_lowercase().replace([' ', '_'], "-");
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST)
        .map(|candidate| {
            let other = candidate.to_lowercase().replace([' ', '_'], "-");
            let likeness = strsim::normalized_damerau_levenshtein(&folded, &other);
            let common =
                folded.len() >= 4 && (other.starts_with(&folded) || folded.starts_with(&other));
            (if common { likeness.max(0.7) } else { likeness }, candidate)
        })
        .filter(|(likeness, _)| *likeness >= 0.6)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
