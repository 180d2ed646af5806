//! Names of things: what they may look like, and the search for one.

pub mod suggest;

use std::collections::HashMap;

use super::diagnostic::Problems;
use super::source::Place;
use super::text::{clip, row};
use super::tree::read::At;
use super::tree::{Node, Wrong};
use suggest::nearest;

/// Most characters of a name.
pub const LONGEST: usize = 60;

/// Whether a text can be a name; reports why not.
pub fn check_name(name: &str, place: Place, problems: &mut Problems) -> bool {
    let allowed = |c: char| c.is_alphanumeric() || " -_+()".contains(c);
    let shown = clip(name, 40);
    let reason = if name.is_empty() {
        "a name cannot be empty".to_owned()
    } else if let Some(bad) = name.chars().find(|&c| !allowed(c)) {
        format!("`{}` cannot be in a name", bad.escape_debug())
    } else if name.trim() != name {
        format!("the name `{shown}` begins or ends with a space")
    } else if name.chars().count() > LONGEST {
        format!("the name `{shown}` has more than {LONGEST} characters")
    } else {
        return true;
    };
    problems
        .error(place, reason)
        .help("names also name files: letters, digits, spaces and - _ + ( )");
    false
}

/// The names of one kind of thing, by index.
#[derive(Debug)]
pub struct Names {
    /// The kind named, such as `material`.
    of: &'static str,
    list: Vec<Option<String>>,
    index: HashMap<String, usize>,
    /// Whether all names are known; otherwise one that is missing may be among those found wrong.
    is_complete: bool,
}

impl Names {
    /// Collects names; reports those that are used twice.
    pub fn new<'a>(
        of: &'static str,
        names: impl Iterator<Item = (Option<&'a str>, Place)>,
        problems: &mut Problems,
    ) -> Self {
        let mut all = Vec::new();
        let mut index = HashMap::new();
        let mut folded: HashMap<String, String> = HashMap::new();
        for (number, (name, place)) in names.enumerate() {
            all.push(name.map(str::to_owned));
            let Some(name) = name else { continue };
            if let Some(other) = folded.insert(name.to_lowercase(), name.to_owned()) {
                let message = if other == name {
                    format!("there are two {} named `{name}`", plural_of(of))
                } else {
                    format!("the names `{other}` and `{name}` differ in capitals only")
                };
                problems
                    .error(place, message)
                    .help("names also name files: make them different");
            }
            index.entry(name.to_owned()).or_insert(number);
        }
        Self {
            of,
            is_complete: all.iter().all(Option::is_some),
            list: all,
            index,
        }
    }

    /// The names of the items of a list of tables.
    pub fn of_list(of: &'static str, list: Option<&Node>, problems: &mut Problems) -> Self {
        let items = list.map_or(&[][..], Node::items);
        let named = items.iter().map(|item| {
            let name = item.get("name");
            (
                name.and_then(Node::text),
                name.map_or(item.place, |name| name.place),
            )
        });
        let mut names = Self::new(of, named, problems);
        names.is_complete &= !list.is_some_and(Node::is_invalid);
        names
    }

    /// The index of a name, without a word when there is none.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    /// The names that are known.
    pub fn known(&self) -> impl Iterator<Item = &str> {
        self.list.iter().flatten().map(String::as_str)
    }

    /// The name at an index.
    pub fn name(&self, index: usize) -> &str {
        self.list
            .get(index)
            .and_then(Option::as_deref)
            .unwrap_or("")
    }

    /// The index that the value of a key names, when the table has the key; reports, in a sentence
    /// that `lead` begins, when there is none.
    ///
    /// # Errors
    /// [`Wrong`] when the table has the key and its value names nothing; the problem is reported.
    pub fn find_optional(
        &self,
        value: Option<&At<String>>,
        lead: &str,
        problems: &mut Problems,
    ) -> Result<Option<usize>, Wrong> {
        match value {
            None => Ok(None),
            Some(value) => self.find(value, lead, problems).map(Some).ok_or(Wrong),
        }
    }

    /// The index that a value names; reports, in a sentence that `lead` begins, when there is none.
    pub fn find(&self, value: &At<String>, lead: &str, problems: &mut Problems) -> Option<usize> {
        let (name, place) = (value.as_str(), value.place);
        if let Some(index) = self.position(name) {
            return Some(index);
        }
        if !self.is_complete {
            return None;
        }
        let (of, shown) = (self.of, clip(name, 40));
        let message = format!("{lead} the {of} `{shown}`, which is not defined");
        if problems.are_many() {
            problems.error(place, message);
            return None;
        }
        let problem = problems.error(place, message);
        problem.help(format!("defined {}: {}", plural_of(of), row(self.known())));
        if let Some(near) = nearest(name, self.known()) {
            problem.help(format!("did you mean `{near}`?"));
        }
        None
    }
}

/// `bodies`, `materials`.
fn plural_of(noun: &str) -> String {
    match noun {
        "rigid body" => "rigid bodies".to_owned(),
        "body" => "bodies".to_owned(),
        "box" => "boxes".to_owned(),
        "reinforcement" => "members of reinforcement".to_owned(),
        noun => format!("{noun}s"),
    }
}
