//! Just enough of HTML to find tags and their attributes in pages that a program wrote.

/// A start tag: its name and the text of its attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tag<'a> {
    pub(super) name: &'a str,
    attributes: &'a str,
}

impl<'a> Tag<'a> {
    /// The value of an attribute as it is written, if the tag has it.
    pub(super) fn attribute(&self, name: &str) -> Option<&'a str> {
        let mut rest = self.attributes;
        loop {
            rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == '/');
            let end = rest.find(|c: char| c.is_whitespace() || c == '=' || c == '/');
            let (found, after) = rest.split_at(end.unwrap_or(rest.len()));
            if found.is_empty() {
                return None;
            }
            let Some(value) = after.trim_start().strip_prefix('=') else {
                rest = after;
                continue;
            };
            let value = value.trim_start();
            let (value, after) = match value.chars().next() {
                Some(quote @ ('"' | '\'')) => value[1..].split_once(quote)?,
                _ => value.split_at(value.find(char::is_whitespace).unwrap_or(value.len())),
            };
            if found.eq_ignore_ascii_case(name) {
                return Some(value);
            }
            rest = after;
        }
    }
}

/// The start tags of a page, without what stands in comments and scripts.
pub(super) fn tags(html: &str) -> Vec<Tag<'_>> {
    let mut tags = Vec::new();
    let mut rest = html;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        if let Some(comment) = rest.strip_prefix("!--") {
            rest = comment.split_once("-->").map_or("", |(_, after)| after);
            continue;
        }
        if !rest.starts_with(|c: char| c.is_ascii_alphabetic()) {
            continue;
        }
        let end = end_of_tag(rest);
        let (inside, after) = rest.split_at(end);
        let name_end = inside.find(|c: char| c.is_whitespace() || c == '/');
        let (name, attributes) = inside.split_at(name_end.unwrap_or(inside.len()));
        tags.push(Tag { name, attributes });
        rest = after;
        for raw in ["script", "style"] {
            if name == raw {
                let close = rest.find(&format!("</{raw}")).unwrap_or(rest.len());
                rest = &rest[close..];
            }
        }
    }
    tags
}

/// Where a tag ends: the first `>` outside quotes.
fn end_of_tag(text: &str) -> usize {
    let mut quote = None;
    for (place, c) in text.char_indices() {
        match (quote, c) {
            (None, '>') => return place,
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), c) if c == open => quote = None,
            _ => {}
        }
    }
    text.len()
}

/// Text as it was before it was written into a page.
pub(super) fn unescaped(text: &str) -> String {
    [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&#39;", "'"),
        ("&#x27;", "'"),
        ("&amp;", "&"),
    ]
    .iter()
    .fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_and_their_attributes_are_found() {
        let page = "<!-- <a href=\"no\"> --><a class='x' href=\"b.html#c\" download>1 < 2</a>\
                    <script>if (a<b) {}</script><img alt=\"a > b\" src=c.png>";
        let found = tags(page);
        let names: Vec<&str> = found.iter().map(|tag| tag.name).collect();
        assert_eq!(names, ["a", "script", "img"]);
        assert_eq!(found[0].attribute("href"), Some("b.html#c"));
        assert_eq!(found[0].attribute("id"), None);
        assert_eq!(found[2].attribute("alt"), Some("a > b"));
        assert_eq!(found[2].attribute("src"), Some("c.png"));
    }

    #[test]
    fn escapes_are_undone_once() {
        assert_eq!(unescaped("a &lt; b &amp;lt; c"), "a < b &lt; c");
    }
}
