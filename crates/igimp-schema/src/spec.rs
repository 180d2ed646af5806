//! The vocabulary in which the schema of a case file is declared: see [`super::schema`].
//!
//! One declaration drives the checks, the defaults, `explain`, the JSON Schema and the reference.

use super::quantity::{Dimension, Quantity, unit_of};
use super::tree::read::Read;
use super::tree::{Node, Value, Wrong};

/// A table with known keys.
#[derive(Debug)]
pub struct Struct {
    /// Its subject, in a line.
    pub doc: &'static str,
    /// Its keys.
    pub fields: &'static [Field],
}

/// A key.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// The key.
    pub key: &'static str,
    /// The kind of its value.
    pub kind: Kind,
    /// Whether it has to be written.
    pub presence: Presence,
    /// Its meaning, in a line.
    pub doc: &'static str,
    /// The analyses that know it.
    pub scope: Scope,
}

/// The analyses that know a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All.
    Any,
    /// Those of a section: plane strain and bodies of revolution.
    Plane,
    /// Space.
    Space,
    /// Plane strain, whose forces are per metre run.
    PerMetre,
    /// Bodies of revolution and space, whose forces are those of whole bodies.
    Whole,
}

/// The bodies that an analysis has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bodies {
    /// Those of plane strain.
    Plane,
    /// Those of revolution.
    Revolution,
    /// Those in space.
    Space,
}

impl Field {
    /// Whether an analysis of such bodies knows the key.
    pub fn applies(&self, bodies: Bodies) -> bool {
        match self.scope {
            Scope::Any => true,
            Scope::Plane => bodies != Bodies::Space,
            Scope::Space => bodies == Bodies::Space,
            Scope::PerMetre => bodies == Bodies::Plane,
            Scope::Whole => bodies != Bodies::Plane,
        }
    }
}

/// Whether a key has to be written.
#[derive(Clone, Copy, Debug)]
pub enum Presence {
    /// It has, as in this example value (TOML).
    Required(&'static str),
    /// It has this value (TOML) when it is not written.
    Default(&'static str),
    /// Its value follows from the rest of the file, in these words.
    Derived(&'static str),
    /// It may be missing, and then means this.
    Optional(&'static str),
}

/// A table with a key that says which further keys there are.
#[derive(Debug)]
pub struct Variants {
    /// Its subject, in a line.
    pub doc: &'static str,
    /// The key that tells the variants apart.
    pub tag: &'static str,
    /// The meaning of that key.
    pub tag_doc: &'static str,
    /// Keys of all variants that stand before the tag.
    pub before: &'static [Field],
    /// Keys of all variants that stand after those of the variant.
    pub after: &'static [Field],
    /// The variants.
    pub cases: &'static [Variant],
}

/// One of several forms of a table.
#[derive(Debug)]
pub struct Variant {
    /// Value of the tag.
    pub name: &'static str,
    /// A description, in a line.
    pub doc: &'static str,
    /// Its own keys.
    pub fields: &'static [Field],
}

/// A text out of a few.
#[derive(Debug)]
pub struct Choice {
    /// The text.
    pub name: &'static str,
    /// Its meaning.
    pub doc: &'static str,
}

/// A range of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Any finite number.
    Any,
    /// Above zero.
    Positive,
    /// Not below zero.
    NotNegative,
    /// Above zero and below one.
    Share,
    /// Above zero, and a hundredth at most.
    SmallShare,
    /// From zero to one.
    Fraction,
}

impl Range {
    /// Whether a number lies in the range.
    pub fn holds(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Any => true,
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Share => 0.0 < value && value < 1.0,
                Self::SmallShare => 0.0 < value && value <= 0.01,
                Self::Fraction => (0.0..=1.0).contains(&value),
            }
    }

    /// The requirement of the range; reads on from "must be".
    pub fn requirement(self) -> &'static str {
        match self {
            Self::Any => "finite",
            Self::Positive => "positive",
            Self::NotNegative => "zero or positive",
            Self::Share => "between 0 and 1, the ends excluded",
            Self::SmallShare => "above 0 and at most 0.01",
            Self::Fraction => "between 0 and 1",
        }
    }
}

/// The kind of a value.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Any text.
    Text,
    /// A text that is the name of something, and may become a file name.
    Name,
    /// The name of something defined elsewhere, such as a material.
    Reference(&'static str),
    /// true or false.
    Flag,
    /// A whole number from, to.
    Integer(i64, i64),
    /// One of these whole numbers.
    IntegerOf(&'static [i64]),
    /// A plain number.
    Number(Range),
    /// A quantity of this dimension.
    Quantity(Dimension, Range),
    /// A quantity of any dimension, or a plain number.
    AnyQuantity,
    /// A text out of a few.
    Choice(&'static [Choice]),
    /// Either of these, by their types.
    Either(&'static [Kind]),
    /// A vector: as many values as the analysis has dimensions.
    Vector(&'static Kind),
    /// A list: of what, at least and at most so many.
    List(&'static Kind, usize, usize),
    /// A table.
    Table(&'static Struct),
    /// Tables by the name of a thing such as a material.
    Map(&'static str, &'static Variants),
    /// A table in one of several forms.
    Variants(&'static Variants),
}

impl Kind {
    /// The expected value, with an article and an example.
    pub fn expectation(&self) -> String {
        match self {
            Self::Text => "a text in quotes".to_owned(),
            Self::Name => "a name in quotes".to_owned(),
            Self::Reference(of) => format!("the name of a {of} in quotes"),
            Self::Flag => "true or false".to_owned(),
            Self::Integer(..) | Self::IntegerOf(_) => "a whole number".to_owned(),
            Self::Number(_) => "a number without a unit".to_owned(),
            Self::Quantity(dimension, _) => {
                format!("{} such as \"{}\"", dimension.name(), dimension.example())
            }
            Self::AnyQuantity => "a number, or a quantity such as \"25 kPa\"".to_owned(),
            Self::Choice(choices) => one_of(choices.iter().map(|choice| choice.name)),
            Self::Either(kinds) => {
                let parts: Vec<_> = kinds.iter().map(Self::expectation).collect();
                parts.join(", or ")
            }
            Self::Vector(_) => "a list of values, one for each axis".to_owned(),
            Self::List(of, least, most) => match of {
                Self::Table(_) | Self::Variants(_) => "a list of tables".to_owned(),
                _ if least == most => format!("a list of {least} values"),
                _ => "a list of values".to_owned(),
            },
            Self::Table(_) | Self::Variants(_) => "a table".to_owned(),
            Self::Map(..) => "a table of named tables".to_owned(),
        }
    }
}

/// `"a"`, `"b"` or `"c"`.
pub(crate) fn one_of<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let quoted: Vec<_> = names.map(|name| format!("\"{name}\"")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
        None => String::new(),
    }
}

impl Variants {
    /// The variant of this name.
    pub fn find(&self, name: &str) -> Option<&'static Variant> {
        self.cases.iter().find(|case| case.name == name)
    }

    /// The keys of a variant in the order in which they are printed, without the tag.
    pub fn fields(&self, variant: &'static Variant) -> impl Iterator<Item = &'static Field> {
        let (before, after) = (self.before, self.after);
        before.iter().chain(variant.fields).chain(after)
    }
}

/// A key that has to be written.
pub(crate) const fn required(
    key: &'static str,
    kind: Kind,
    example: &'static str,
    doc: &'static str,
) -> Field {
    Field {
        key,
        kind,
        presence: Presence::Required(example),
        doc,
        scope: Scope::Any,
    }
}

/// A key with a default.
pub(crate) const fn default(
    key: &'static str,
    kind: Kind,
    value: &'static str,
    doc: &'static str,
) -> Field {
    Field {
        key,
        kind,
        presence: Presence::Default(value),
        doc,
        scope: Scope::Any,
    }
}

/// A key whose value follows from the rest of the file.
pub(crate) const fn derived(
    key: &'static str,
    kind: Kind,
    from: &'static str,
    doc: &'static str,
) -> Field {
    Field {
        key,
        kind,
        presence: Presence::Derived(from),
        doc,
        scope: Scope::Any,
    }
}

/// A key that may be missing.
pub(crate) const fn optional(
    key: &'static str,
    kind: Kind,
    meaning: &'static str,
    doc: &'static str,
) -> Field {
    Field {
        key,
        kind,
        presence: Presence::Optional(meaning),
        doc,
        scope: Scope::Any,
    }
}

/// A key that space does not know.
pub(crate) const fn in_plane(field: Field) -> Field {
    Field {
        scope: Scope::Plane,
        ..field
    }
}

/// A key of plane strain, where forces are per metre run.
pub(crate) const fn per_metre(field: Field) -> Field {
    Field {
        scope: Scope::PerMetre,
        ..field
    }
}

/// A key where forces are those of whole bodies.
pub(crate) const fn whole(field: Field) -> Field {
    Field {
        scope: Scope::Whole,
        ..field
    }
}

/// A key that only space knows.
pub(crate) const fn in_space(field: Field) -> Field {
    Field {
        scope: Scope::Space,
        ..field
    }
}

/// A choice.
pub(crate) const fn choice(name: &'static str, doc: &'static str) -> Choice {
    Choice { name, doc }
}

/// A number, or a quantity of any dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Its value, in SI units.
    pub value: f64,
    /// Its dimension; none: a plain number.
    pub dimension: Option<Dimension>,
    /// The unit that it is written in, and its value in SI units; none: a plain number.
    pub unit: Option<(&'static str, f64)>,
}

impl Read for Measured {
    fn read(node: &Node) -> Result<Self, Wrong> {
        let value = node.number().ok_or(Wrong)?;
        let (dimension, unit) = match &node.value {
            Value::Quantity(_, text) => (
                Quantity::parse(text).ok().and_then(|read| read.dimension),
                unit_of(text),
            ),
            _ => (None, None),
        };
        Ok(Self {
            value,
            dimension,
            unit,
        })
    }
}
