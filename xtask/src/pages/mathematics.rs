//! Mathematics of built pages: from the TeX in `` $`...`$ `` and in blocks of the language `math` to
//! MathML, which browsers set without a script and without a network.

use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::mathml::push_mathml;
use pulldown_latex::{Parser, Storage};

use super::html::unescaped;

/// A page with its mathematics set: the number of formulas, and those that cannot be read.
#[derive(Debug, Default)]
pub(super) struct Typeset {
    pub(super) html: String,
    pub(super) formulas: usize,
    pub(super) problems: Vec<String>,
}

/// Sets the mathematics of a page, as mdBook and rustdoc write it.
pub(super) fn typeset(page: &str) -> Typeset {
    let mut out = Typeset::default();
    let mut rest = page;
    while let Some(found) = Formula::first(rest) {
        out.html.push_str(&rest[..found.start]);
        match rendered(&unescaped(found.tex), found.display) {
            Ok(set) => out.html.push_str(&set),
            Err(reason) => {
                out.problems
                    .push(format!("`{}`: {reason}", found.tex.trim()));
                out.html.push_str(&rest[found.start..found.end]);
            }
        }
        out.formulas += 1;
        rest = &rest[found.end..];
    }
    out.html.push_str(rest);
    out.problems.extend(left_over(&out.html));
    out
}

/// A formula in a page: where it stands, with its marks, and its source.
struct Formula<'a> {
    start: usize,
    end: usize,
    tex: &'a str,
    display: bool,
}

impl<'a> Formula<'a> {
    /// The first formula of a text.
    fn first(text: &'a str) -> Option<Self> {
        [
            Self::between(
                text,
                "<pre><code class=\"language-math\">",
                "</code></pre>",
                true,
            ),
            Self::between(
                text,
                "<div class=\"example-wrap\"><pre class=\"language-math\"><code>",
                "</code></pre></div>",
                true,
            ),
            Self::inline(text),
        ]
        .into_iter()
        .flatten()
        .min_by_key(|formula| formula.start)
    }

    fn between(text: &'a str, open: &str, close: &str, display: bool) -> Option<Self> {
        let start = text.find(open)?;
        let inner = start + open.len();
        let length = text[inner..].find(close)?;
        Some(Self {
            start,
            end: inner + length + close.len(),
            tex: &text[inner..inner + length],
            display,
        })
    }

    /// Code between dollars; code that only begins with one is not a formula.
    fn inline(text: &'a str) -> Option<Self> {
        let mut from = 0;
        loop {
            let rest = &text[from..];
            let start = rest.find("$<code>")?;
            let close = start + rest[start..].find("</code>")?;
            if rest[close..].starts_with("</code>$") {
                let found = Self::between(&rest[start..], "$<code>", "</code>$", false)?;
                return Some(Self {
                    start: from + start,
                    end: from + start + found.end,
                    ..found
                });
            }
            from += close;
        }
    }
}

/// A formula as MathML; a numbered one with its number beside it and a place to link to.
fn rendered(tex: &str, display: bool) -> Result<String, String> {
    let (tex, number) = without_tag(tex);
    let tex = tex.trim();
    let mathml = mathml(tex, display)?;
    Ok(match (display, number) {
        (false, _) => mathml,
        (true, None) => format!("<div class=\"formula\">{mathml}</div>"),
        (true, Some(number)) => format!(
            "<div class=\"formula\" id=\"eq-{number}\">{mathml}\
             <a href=\"#eq-{number}\">({number})</a></div>"
        ),
    })
}

/// The source without its `\tag{...}`, and the text of the tag.
fn without_tag(tex: &str) -> (String, Option<&str>) {
    let Some((before, rest)) = tex.split_once("\\tag{") else {
        return (tex.to_owned(), None);
    };
    let (number, after) = rest.split_once('}').unwrap_or((rest, ""));
    (format!("{before}{after}"), Some(number))
}

fn mathml(tex: &str, display: bool) -> Result<String, String> {
    let storage = Storage::new();
    if let Some(error) = Parser::new(tex, &storage).find_map(Result::err) {
        return Err(error.to_string());
    }
    let storage = Storage::new();
    let config = RenderConfig {
        display_mode: if display {
            DisplayMode::Block
        } else {
            DisplayMode::Inline
        },
        annotation: Some(tex),
        ..RenderConfig::default()
    };
    let mut out = String::new();
    push_mathml(&mut out, Parser::new(tex, &storage), config).map_err(|error| error.to_string())?;
    Ok(out)
}

/// Marks of formulas that were not set.
fn left_over(page: &str) -> Vec<String> {
    ["$<code>", "</code>$", "class=\"language-math"]
        .iter()
        .flat_map(|mark| page.match_indices(mark))
        .map(|(place, _)| {
            let text: String = page[place..].chars().take(60).collect();
            format!("not set: {text}")
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_of_the_book_and_of_rustdoc_are_set() {
        let page = "<p>With $<code>a &lt; b</code>$ and <code>x</code>.</p>\
                    <pre><code class=\"language-math\">\\sum_i f_i = 0 .\n\\tag{12}\n</code></pre>\
                    <div class=\"example-wrap\"><pre class=\"language-math\"><code>y = 2</code></pre></div>";
        let set = typeset(page);
        assert_eq!(
            (set.formulas, set.problems.len()),
            (3, 0),
            "{:?}",
            set.problems
        );
        assert_eq!(set.html.matches("<math").count(), 3);
        assert!(set.html.contains("id=\"eq-12\"") && set.html.contains(">(12)</a>"));
        assert!(set.html.contains("<code>x</code>"));
        assert!(!set.html.contains("language-math") && !set.html.contains("$<"));
    }

    #[test]
    fn unreadable_formulas_are_reported() {
        for page in [
            "$<code>\\frac{1}</code>$",
            "$<code>\\nosuch</code>$",
            "$<code>a</code>$ $<code>b</code>",
        ] {
            assert!(!typeset(page).problems.is_empty(), "{page}");
        }
        let open = typeset("costs 5 $<code>x</code>");
        assert_eq!((open.formulas, open.problems.len()), (0, 1));
    }
}
