//! Which key of a case differs from that of the results which it is to go on with.

use std::path::Path;

use igimp_text::on_a_line;

use super::CheckpointError;

/// Tables that say nothing of the computation.
const BESIDE: [&str; 1] = ["output"];

/// Keys of `[case]` and `[solver]` that say nothing of it.
const BESIDE_KEYS: [&str; 6] = [
    "case.project",
    "case.client",
    "case.author",
    "case.revision",
    "solver.memory",
    "igimp",
];

/// Longest value that is shown.
const SHOWN: usize = 60;

/// The same error with the first key that differs between the completed case in a results folder and another one, if there is
/// a file and a key.
pub fn named(error: CheckpointError, kept: &Path, completed: &str) -> CheckpointError {
    match error {
        CheckpointError::OtherCase { path, .. } => {
            let kept = std::fs::read_to_string(kept).ok();
            let differs = kept.and_then(|kept| first(&kept, completed));
            CheckpointError::OtherCase { path, differs }
        }
        other => other,
    }
}

/// The first key of two completed cases with different values, in words.
fn first(before: &str, now: &str) -> Option<String> {
    let (before, now) = (keys(before), keys(now));
    let of = |all: &[(String, String)], key: &str| -> Option<String> {
        let mut all = all.iter();
        all.find(|pair| pair.0 == key).map(|pair| pair.1.clone())
    };
    let shown =
        |value: Option<String>| value.map_or_else(|| "not set".to_owned(), |value| clipped(&value));
    let mut all = before.iter().chain(&now).map(|pair| &pair.0);
    let key = all.find(|key| of(&before, key) != of(&now, key))?;
    Some(format!(
        "{} was {} and is {}",
        on_a_line(key),
        shown(of(&before, key)),
        shown(of(&now, key))
    ))
}

/// The keys of a completed case in its order, each with the text of its value; lists of tables count from 1. A value in
/// several lines is one text.
fn keys(text: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    let mut table = String::new();
    let mut lists: Vec<(String, usize)> = Vec::new();
    for line in text.lines() {
        let line = without_comment(line);
        let trimmed = line.trim();
        if trimmed.is_empty() {
            continue;
        }
        if let Some(name) = trimmed
            .strip_prefix("[[")
            .and_then(|rest| rest.strip_suffix("]]"))
        {
            let known = lists.iter().position(|list| list.0 == name);
            let place = known.unwrap_or_else(|| {
                lists.push((name.to_owned(), 0));
                lists.len() - 1
            });
            lists[place].1 += 1;
            table = format!("{name}.{}", lists[place].1);
        } else if let Some(name) = trimmed
            .strip_prefix('[')
            .and_then(|rest| rest.strip_suffix(']'))
            && !line.starts_with(' ')
        {
            name.clone_into(&mut table);
        } else if let Some((key, value)) = line.split_once(" = ")
            && !line.starts_with(' ')
        {
            let key = if table.is_empty() {
                key.to_owned()
            } else {
                format!("{table}.{key}")
            };
            found.push((key, value.trim().to_owned()));
        } else if let Some((_, value)) = found.last_mut() {
            value.push(' ');
            value.push_str(trimmed);
        }
    }
    let is_beside = |key: &str| {
        let table = key.split('.').next().unwrap_or_default();
        BESIDE.contains(&table) || BESIDE_KEYS.contains(&key)
    };
    found.retain(|pair| !is_beside(&pair.0));
    found
}

/// A line up to its comment; `#` within quotes begins none.
fn without_comment(line: &str) -> &str {
    let (mut is_quoted, mut is_escaped) = (false, false);
    for (at, c) in line.char_indices() {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' if is_quoted => is_escaped = true,
            '"' => is_quoted = !is_quoted,
            '#' if !is_quoted => return &line[..at],
            _ => {}
        }
    }
    line
}

fn clipped(value: &str) -> String {
    let value = on_a_line(value);
    if value.chars().count() <= SHOWN {
        value.into_owned()
    } else {
        let start: String = value.chars().take(SHOWN).collect();
        format!("{start} …")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "igimp = 1 # version\n[case]\ntitle = \"a # b\" # for reports\nauthor = \"A\"\n\
        [materials.soil]\ncohesion = \"10 kPa\"    # c\n# tension_cutoff is not set\n\
        [[bodies]]\nname = \"one\"\npolygon = [\n    [\"0 m\", \"0 m\"],\n    [\"1 m\", \"0 m\"],\n]\n\
        [[bodies]]\nname = \"two\"\n[output]\nfolder = \"a\"\n";

    // GOAL: the key that differs is named with both of its values, and what is beside the input is passed over.
    // ORACLE: by hand.
    #[test]
    fn the_first_key_that_differs_is_named() {
        let with = |from: &str, to: &str| first(CASE, &CASE.replace(from, to));
        let words = |text: &str| Some(text.to_owned());
        assert_eq!(first(CASE, CASE), None);
        assert_eq!(
            with("10 kPa", "12 kPa"),
            words("materials.soil.cohesion was \"10 kPa\" and is \"12 kPa\"")
        );
        assert_eq!(
            with("# tension_cutoff is not set", "tension_cutoff = \"0 kPa\""),
            words("materials.soil.tension_cutoff was not set and is \"0 kPa\"")
        );
        assert_eq!(
            with("two", "three"),
            words("bodies.2.name was \"two\" and is \"three\"")
        );
        assert_eq!(
            with("[\"1 m\", \"0 m\"],", "[\"2 m\", \"0 m\"],"),
            words(
                "bodies.1.polygon was [ [\"0 m\", \"0 m\"], [\"1 m\", \"0 m\"], ] and is [ [\"0 m\", \"0 m\"], [\"2 m\", \"0 m\"], ]"
            )
        );
        assert_eq!(
            with("a # b", "a # c"),
            words("case.title was \"a # b\" and is \"a # c\"")
        );
        assert_eq!(with("author = \"A\"", "author = \"B\""), None);
        assert_eq!(with("folder = \"a\"", "folder = \"b\""), None);
        assert_eq!(with("# version", "# format"), None);
    }
}
