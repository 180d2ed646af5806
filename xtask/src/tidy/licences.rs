//! Licences of all dependencies: SPDX expressions against the list in `deny.toml`.

use crate::metadata::Metadata;

/// Problems with the licences.
pub(super) fn check(metadata: &Metadata, allowed: &[String]) -> Vec<String> {
    let mut problems = Vec::new();
    for package in metadata.packages() {
        let at = format!("{} {}", package.name, package.version);
        let Some(licence) = &package.licence else {
            problems.push(format!("{at} states no licence"));
            continue;
        };
        match is_allowed(licence, allowed) {
            Ok(true) => {}
            Ok(false) => problems.push(format!("{at} is under {licence}, not allowed")),
            Err(reason) => problems.push(format!("{at}: licence `{licence}`: {reason}")),
        }
    }
    problems
}

/// Whether the allowed licences satisfy an expression: one side of each `OR`, both of each `AND`.
/// A licence `WITH` an exception counts as a licence of its own, `/` is an old way to write `OR`.
fn is_allowed(expression: &str, allowed: &[String]) -> Result<bool, String> {
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ");
    let mut parser = Parser {
        words: spaced.split_whitespace().collect(),
        next: 0,
        allowed,
    };
    let satisfied = parser.either()?;
    match parser.words.get(parser.next) {
        None => Ok(satisfied),
        Some(word) => Err(format!("unexpected `{word}`")),
    }
}

/// Recursive descent; `AND` binds tighter than `OR`.
struct Parser<'a> {
    words: Vec<&'a str>,
    next: usize,
    allowed: &'a [String],
}

impl Parser<'_> {
    fn either(&mut self) -> Result<bool, String> {
        let mut satisfied = self.both()?;
        while self.take("OR") {
            satisfied |= self.both()?;
        }
        Ok(satisfied)
    }

    fn both(&mut self) -> Result<bool, String> {
        let mut satisfied = self.single()?;
        while self.take("AND") {
            satisfied &= self.single()?;
        }
        Ok(satisfied)
    }

    fn single(&mut self) -> Result<bool, String> {
        if self.take("(") {
            let satisfied = self.either()?;
            return if self.take(")") {
                Ok(satisfied)
            } else {
                Err("a parenthesis is not closed".to_owned())
            };
        }
        let mut licence = self.identifier()?;
        if self.take("WITH") {
            licence = format!("{licence} WITH {}", self.identifier()?);
        }
        Ok(self.allowed.contains(&licence))
    }

    fn identifier(&mut self) -> Result<String, String> {
        match self.words.get(self.next) {
            None => Err("a licence is missing at the end".to_owned()),
            Some(&word) if ["AND", "OR", "WITH", "(", ")"].contains(&word) => {
                Err(format!("a licence is missing before `{word}`"))
            }
            Some(&word) => {
                self.next += 1;
                Ok(word.to_owned())
            }
        }
    }

    fn take(&mut self, word: &str) -> bool {
        let found = self.words.get(self.next) == Some(&word);
        self.next += usize::from(found);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metadata::tests::metadata;

    fn allowed() -> Vec<String> {
        [
            "MIT",
            "Apache-2.0",
            "Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception",
        ]
        .map(str::to_owned)
        .to_vec()
    }

    #[test]
    fn expressions_are_evaluated() {
        for (expression, expected) in [
            ("MIT", true),
            ("LGPL-3.0-or-later", false),
            ("MIT OR LGPL-2.1-or-later", true),
            ("MIT AND LGPL-2.1-or-later", false),
            ("MIT/Apache-2.0", true),
            ("GPL-3.0/LGPL-3.0", false),
            ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
            ("(MIT OR Apache-2.0) AND OFL-1.1", false),
            ("OFL-1.1 OR MIT AND Unicode-3.0", true),
            ("OFL-1.1 AND MIT OR Unicode-3.0", true),
            ("OFL-1.1 AND (MIT OR Unicode-3.0)", false),
            ("Apache-2.0 WITH LLVM-exception", true),
            ("MIT WITH LLVM-exception", false),
            ("mit", false),
        ] {
            assert_eq!(
                is_allowed(expression, &allowed()),
                Ok(expected),
                "{expression}"
            );
        }
    }

    #[test]
    fn broken_expressions_are_refused() {
        for expression in [
            "",
            "MIT OR",
            "AND MIT",
            "(MIT",
            "MIT)",
            "MIT Apache-2.0",
            "MIT WITH",
        ] {
            assert!(is_allowed(expression, &allowed()).is_err(), "{expression}");
        }
    }

    #[test]
    fn the_package_is_named() {
        let metadata = metadata(&[
            ("fine", false, Some("MIT"), &[]),
            ("strict", false, Some("LGPL-3.0-only"), &[]),
            ("unknown", false, None, &[]),
        ]);
        let expected = [
            "strict 1.0.0 is under LGPL-3.0-only, not allowed",
            "unknown 1.0.0 states no licence",
        ];
        assert_eq!(check(&metadata, &allowed()), expected);
    }
}
