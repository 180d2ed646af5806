//! The list of allowed licences in `deny.toml`, the file that cargo-deny reads too.

use std::fs;
use std::path::Path;

use crate::failure::Failure;

/// The licences that the file allows.
pub(super) fn allowed_licences(path: &Path) -> Result<Vec<String>, Failure> {
    let text = fs::read_to_string(path)
        .map_err(|error| Failure::input_output(format!("cannot read {}", path.display()), error))?;
    parse(&text).ok_or_else(|| {
        Failure::input_output(path.display(), "no list `allow` in the section [licenses]")
    })
}

/// The strings of `allow = [...]` in the section `[licenses]`: all of TOML that is needed here.
fn parse(text: &str) -> Option<Vec<String>> {
    let lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or(""));
    let section: Vec<&str> = lines
        .skip_while(|line| line.trim() != "[licenses]")
        .skip(1)
        .take_while(|line| !line.starts_with('['))
        .collect();
    let section = section.join("\n");
    let (_, value) = section
        .match_indices("allow")
        .map(|(at, key)| (&section[..at], section[at + key.len()..].trim_start()))
        .find(|(before, after)| {
            before.lines().next_back().unwrap_or("").trim().is_empty() && after.starts_with('=')
        })?;
    let (list, _) = value.split_once('[')?.1.split_once(']')?;
    let licences = list.split('"').skip(1).step_by(2);
    Some(licences.map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::root;

    #[test]
    fn the_list_is_found() {
        let text = r#"
            [bans]
            allow = ["never"]
        "#
        .replace("            ", "")
            + "[licenses]\nunused-allowed-license = \"allow\"\n# allow = [\"old\"]\n"
            + "allow = [\n  \"MIT\", # short\n  \"Apache-2.0 WITH LLVM-exception\",\n]\n"
            + "[sources]\n";
        let expected = ["MIT", "Apache-2.0 WITH LLVM-exception"];
        assert_eq!(parse(&text).unwrap(), expected);
        assert_eq!(parse("[bans]\nallow = [\"MIT\"]\n"), None);
    }

    #[test]
    fn the_project_allows_permissive_licences_only() {
        let allowed = allowed_licences(&root().join("deny.toml")).unwrap();
        assert!(allowed.contains(&"MIT".to_owned()));
        let share_alike = ["GPL", "MPL", "EPL", "CDDL", "OSL", "EUPL", "CC-BY-SA"];
        for licence in &allowed {
            assert!(
                !share_alike.iter().any(|family| licence.contains(family)),
                "{licence}"
            );
        }
    }
}
