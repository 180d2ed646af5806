//! The paths that a source text names: those of `use`, and those that begin with `crate`, `super` or `self`.

/// The paths in a text, without those in comments and in modules of tests within it.
pub(super) fn imports(text: &str) -> Vec<Vec<String>> {
    let code: String = without_tests(text)
        .lines()
        .map(|line| line.split("//").next().unwrap_or(line))
        .flat_map(|line| [line, "\n"])
        .collect();
    let tokens = tokens(&code);
    let mut paths = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at] == "use" {
            at = tree(&tokens, at + 1, &[], &mut paths);
        } else if matches!(tokens[at], "crate" | "super" | "self")
            && tokens.get(at + 1) == Some(&"::")
        {
            at = tree(&tokens, at, &[], &mut paths);
        } else {
            at += 1;
        }
    }
    paths
}

/// The text before the first module of tests.
fn without_tests(text: &str) -> &str {
    let end = text.match_indices("#[cfg(test)]\n").find(|&(at, mark)| {
        let rest = &text[at + mark.len()..];
        let rest = rest.trim_start_matches(|c| c != 'm' && c != 'u' && c != 'f');
        rest.starts_with("mod") && rest.lines().next().is_some_and(|line| line.ends_with('{'))
    });
    end.map_or(text, |(at, _)| &text[..at])
}

/// Names, `::` and single signs.
fn tokens(code: &str) -> Vec<&str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = if is_name(first) {
            rest.find(|c| !is_name(c)).unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        tokens.push(&rest[..length]);
        rest = rest[length..].trim_start();
    }
    tokens
}

/// Adds the paths of the tree of imports that begins at a token, after what stands before it; the token behind it.
fn tree(tokens: &[&str], mut at: usize, before: &[String], paths: &mut Vec<Vec<String>>) -> usize {
    let mut path = before.to_vec();
    while let Some(&token) = tokens.get(at) {
        match token {
            "::" => at += 1,
            "{" => {
                at += 1;
                while tokens.get(at).is_some_and(|&token| token != "}") {
                    at = tree(tokens, at, &path, paths);
                    if tokens.get(at) == Some(&",") {
                        at += 1;
                    }
                }
                return at + 1;
            }
            name if name.starts_with(|c: char| c.is_alphabetic() || c == '_') => {
                path.push(name.to_owned());
                at += 1;
                if tokens.get(at) != Some(&"::") {
                    if tokens.get(at) == Some(&"as") {
                        at += 2;
                    }
                    paths.push(path);
                    return at;
                }
            }
            _ => {
                // A star, generic arguments, or what is no import at all.
                paths.push(path);
                return at + 1;
            }
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::imports;

    fn found(text: &str) -> Vec<String> {
        let paths = imports(text).into_iter();
        paths.map(|path| path.join("::")).collect()
    }

    #[test]
    fn trees_are_spread_out() {
        assert_eq!(
            found("use super::{a, b::{C, d::E as F}};\npub use crate::g;"),
            ["super::a", "super::b::C", "super::b::d::E", "crate::g"]
        );
    }

    #[test]
    fn paths_in_code_count_and_comments_and_tests_do_not() {
        let text = "// crate::no\nfn f() { crate::a::b(self.x); super::c::<u8>(); }\n\
                    #[cfg(test)]\nmod tests {\n use crate::no; }";
        assert_eq!(found(text), ["crate::a::b", "super::c"]);
    }
}
