//! Hints: "did you mean", lists of choices, and names that fit into a message.

/// Longer words are not compared: no name is that long by accident.
const LONGEST: usize = 40;

/// The candidate that `word` is probably a misspelling of: at most a third of the letters wrong (always one), or one a
/// prefix of the other.
pub(super) fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    if word.len() > LONGEST {
        return None;
    }
    let word = word.to_lowercase();
    let most = (word.chars().count() / 3).max(1);
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let lower = candidate.to_lowercase();
        let distance = strsim::osa_distance(&word, &lower);
        let is_prefix =
            lower.starts_with(&word) || (lower.len() >= 3 && word.starts_with(lower.as_str()));
        let rank = match (
            distance <= most && distance < lower.chars().count(),
            is_prefix,
        ) {
            (true, _) => distance,
            (false, true) => most + distance,
            (false, false) => continue,
        };
        if best.is_none_or(|(least, _)| rank < least) {
            best = Some((rank, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// "did you mean `x`?" for the nearest candidate, else the choices themselves if they are few.
pub(super) fn did_you_mean<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str> + Clone,
) -> Option<String> {
    if let Some(candidate) = nearest(word, candidates.clone()) {
        return Some(format!("did you mean `{candidate}`?"));
    }
    let all: Vec<&str> = candidates.into_iter().collect();
    (1..=16)
        .contains(&all.len())
        .then(|| format!("it knows {}", listed(&all, "and")))
}

/// "`a`, `b` and `c`".
pub(super) fn listed(words: &[&str], last: &str) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    joined(&quoted, last)
}

/// "a, b and c".
pub(super) fn joined(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., end] => format!("{} {last} {end}", first.join(", ")),
    }
}

/// The text, cut where it would fill more than a line of a message.
pub(super) fn clipped(text: &str) -> String {
    if text.chars().count() <= LONGEST {
        return text.into();
    }
    let start: String = text.chars().take(LONGEST - 3).collect();
    format!("{start}...")
}

/// "1 shape", "2 shapes".
pub(super) fn counted(n: usize, noun: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {noun}{plural}")
}
