//! The form in which tables are declared: once, and the schema, the type and its reading follow.
//!
//! A key is a line `key: kind, presence value, meaning;`. Its kind (`kind!`) says at once what may be written and which
//! type the value has (`rust_type!`); its presence is one of the functions of [`crate::spec`]. A key that one analysis
//! knows has `, in_plane` or `, in_space` behind it, and one that both know differently has kind, presence, value and
//! meaning of plane strain, `in_plane`, and those of space, `in_space`. `name as "key"` gives a field another name than its
//! key.
//!
//! A table is read as a whole, or not at all where a value was found wrong. `each` item of a list is read by itself, and so is
//! what stands `apart`; a `name_apart` that was found wrong is read as a question mark. `name: part(TABLE: Type)` takes in the
//! keys of another table; a `group` of them is read by itself, and `group_in_space` makes them keys of space.

use crate::spec::{Field, Kind, in_space, optional};

/// Declares the schema of a table whose type another table has.
macro_rules! schema {
    (
        $schema:ident, $doc:literal;
        $(
            $field:ident $(as $key:literal)?: $kind:ident $(($($args:tt)*))?
            $(, $presence:ident $value:literal, $meaning:literal $(, $scope:ident
                $(, $other:ident $(($($other_args:tt)*))?,
                    $other_presence:ident $other_value:literal, $other_meaning:literal, $other_scope:ident)?
            )?)?;
        )*
    ) => {
        pub(crate) static $schema: $crate::spec::Struct = {
            const PIECES: &[&[$crate::spec::Field]] = &[$(
                $crate::schema::declare::pieces!(
                    $crate::schema::declare::key!($field $($key)?), $kind [$($($args)*)?]
                    $($presence $value, $meaning $(, $scope $(,
                        $other [$($($other_args)*)?] $other_presence $other_value, $other_meaning, $other_scope
                    )?)?)?
                ),
            )*];
            const FIELDS: [$crate::spec::Field; $crate::schema::declare::count(PIECES)] =
                $crate::schema::declare::joined(PIECES);
            $crate::spec::Struct { doc: $doc, fields: &FIELDS }
        };
    };
}

/// Declares a table: its schema, its type, a function for every key, and the reading of the whole.
macro_rules! table {
    (
        $schema:ident: $name:ident $(<$d:ident>)?, $doc:literal;
        $(
            $field:ident $(as $key:literal)?: $kind:ident $(($($args:tt)*))?
            $(, $presence:ident $value:literal, $meaning:literal $(, $scope:ident
                $(, $other:ident $(($($other_args:tt)*))?,
                    $other_presence:ident $other_value:literal, $other_meaning:literal, $other_scope:ident)?
            )?)?;
        )*
    ) => {
        $crate::schema::declare::schema! {
            $schema, $doc;
            $(
                $field $(as $key)?: $kind $(($($args)*))?
                $(, $presence $value, $meaning $(, $scope
                    $(, $other $(($($other_args)*))?, $other_presence $other_value, $other_meaning, $other_scope)?
                )?)?;
            )*
        }

        #[doc = $doc]
        #[derive(Clone, Debug)]
        pub struct $name $(<const $d: usize>)? {
            $(
                #[doc = concat!("Key `", $crate::schema::declare::key!($field $($key)?), "`", $(": ", $meaning,)? ".")]
                pub $field: $crate::schema::declare::field_type!(
                    $kind [$($($args)*)?] $($presence $($scope $($other_scope)?)?)?
                ),
            )*
        }

        impl $(<const $d: usize>)? $name $(<$d>)? {
            $(
                #[doc = concat!("The value of `", $crate::schema::declare::key!($field $($key)?), "` in a table.")]
                ///
                /// # Errors
                /// When it was found wrong; the problem is reported already.
                pub fn $field(
                    node: &$crate::tree::Node,
                ) -> Result<
                    $crate::schema::declare::field_type!(
                        $kind [$($($args)*)?] $($presence $($scope $($other_scope)?)?)?
                    ),
                    $crate::tree::Wrong,
                > {
                    $crate::schema::declare::read!(
                        node, $kind, $crate::schema::declare::key!($field $($key)?)
                    )
                }
            )*
        }

        impl $(<const $d: usize>)? $crate::tree::read::Read for $name $(<$d>)? {
            fn read(node: &$crate::tree::Node) -> Result<Self, $crate::tree::Wrong> {
                $crate::tree::read::is_table(node)?;
                Ok(Self { $($field: Self::$field(node)?,)* })
            }
        }
    };
}

/// Declares a table in one of several forms: its schema, its type, and that of its forms, each of which is a table. Keys of all
/// forms, beside a name, stand in a table of their own, `after`.
macro_rules! variants {
    (
        $schema:ident: $name:ident $(<$d:ident>)? of $form:ident, $doc:literal, $tag:literal, $tag_doc:literal;
        $(named $example:literal;)?
        $(named_apart $apart:literal;)?
        $($case:literal => $variant:ident($table:ident: $of:ty),)*
        $(after $after:ident: $common:ty;)?
    ) => {
        pub(crate) static $schema: $crate::spec::Variants = $crate::spec::Variants {
            doc: $doc,
            tag: $tag,
            tag_doc: $tag_doc,
            before: &[
                $($crate::spec::required("name", $crate::spec::Kind::Name, $example, "name"))?
                $($crate::spec::required("name", $crate::spec::Kind::Name, $apart, "name"))?
            ],
            cases: &[$($crate::spec::Variant { name: $case, doc: $table.doc, fields: $table.fields },)*],
            after: const {
                let after: &[$crate::spec::Field] = &[];
                $(let after = { let _ = after; $after.fields };)?
                after
            },
        };

        #[doc = $doc]
        #[derive(Clone, Debug)]
        pub struct $name $(<const $d: usize>)? {
            $(
                #[doc = concat!("Its name, as `", $example, "`.")]
                pub name: $crate::tree::read::At<String>,
            )?
            $(
                #[doc = concat!("Its name, as `", $apart, "`; a question mark where it was found wrong.")]
                pub name: $crate::tree::read::At<String>,
            )?
            #[doc = concat!("Key `", $tag, "`: ", $tag_doc, ".")]
            pub form: $crate::tree::read::At<$form $(<$d>)?>,
            $(
                /// Keys of all forms, if they were found right.
                pub common: Result<$common, $crate::tree::Wrong>,
            )?
        }

        #[doc = $tag_doc]
        ///
        /// The keys of each, if they were found right.
        #[derive(Clone, Debug)]
        #[allow(clippy::large_enum_variant, reason = "each is read once and kept by its owner")]
        pub enum $form $(<const $d: usize>)? {
            $(
                #[doc = concat!("`", $case, "`.")]
                $variant(Result<$of, $crate::tree::Wrong>),
            )*
        }

        impl $(<const $d: usize>)? $form $(<$d>)? {
            /// Its name in case files.
            pub fn name(&self) -> &'static str {
                match self { $(Self::$variant(_) => $case,)* }
            }
        }

        impl $(<const $d: usize>)? $crate::tree::read::Read for $name $(<$d>)? {
            fn read(node: &$crate::tree::Node) -> Result<Self, $crate::tree::Wrong> {
                use $crate::tree::read::{At, Read};
                let tag = node.get($tag).ok_or($crate::tree::Wrong)?;
                let form = match tag.text() {
                    $(Some($case) => $form::$variant(Read::read(node)),)*
                    _ => return Err($crate::tree::Wrong),
                };
                Ok(Self {
                    $(name: { let _ = $example; At::read(node.get("name").ok_or($crate::tree::Wrong)?)? },)?
                    $(name: { let _ = $apart; $crate::tree::read::name_in(node, "name") },)?
                    form: At { value: form, place: tag.place, key_place: tag.place, written: tag.written },
                    $(common: <$common>::read(node),)?
                })
            }
        }
    };
}

/// Declares texts of which a key takes one, and their type.
macro_rules! choices {
    ($(#[$about:meta])* $name:ident; $($variant:ident $text:literal, $meaning:literal;)*) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $(
                #[doc = concat!("`", $text, "`: ", $meaning, ".")]
                $variant,
            )*
        }

        impl $name {
            pub(crate) const CHOICES: &'static [$crate::spec::Choice] =
                &[$($crate::spec::choice($text, $meaning),)*];

            /// The text.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)* }
            }
        }

        impl $crate::tree::read::Read for $name {
            fn read(node: &$crate::tree::Node) -> Result<Self, $crate::tree::Wrong> {
                match node.text() {
                    $(Some($text) => Ok(Self::$variant),)*
                    _ => Err($crate::tree::Wrong),
                }
            }
        }
    };
}

/// The key of a field.
macro_rules! key {
    ($field:ident $key:literal) => {
        $key
    };
    ($field:ident) => {
        stringify!($field)
    };
}

/// The declarations of a field.
macro_rules! pieces {
    ($key:expr, part [$table:ident: $($of:tt)*]) => { $table.fields };
    ($key:expr, group [$table:ident: $($of:tt)*]) => { $table.fields };
    ($key:expr, group_in_space [$table:ident: $($of:tt)*]) => {
        &const { $crate::schema::declare::all_in_space::<{ $table.fields.len() }>($table.fields) }
    };
    ($key:expr, $kind:ident [$($args:tt)*] $presence:ident $value:literal, $meaning:literal) => {
        &[$crate::spec::$presence($key, $crate::schema::declare::kind!($kind [$($args)*]), $value, $meaning)]
    };
    ($key:expr, $kind:ident [$($args:tt)*] $presence:ident $value:literal, $meaning:literal, $scope:ident) => {
        &[$crate::spec::$scope($crate::spec::$presence(
            $key, $crate::schema::declare::kind!($kind [$($args)*]), $value, $meaning
        ))]
    };
    (
        $key:expr, $kind:ident [$($args:tt)*] $presence:ident $value:literal, $meaning:literal, $scope:ident,
        $other:ident [$($other_args:tt)*] $other_presence:ident $other_value:literal, $other_meaning:literal,
        $other_scope:ident
    ) => {
        &[
            $crate::spec::$scope($crate::spec::$presence(
                $key, $crate::schema::declare::kind!($kind [$($args)*]), $value, $meaning
            )),
            $crate::spec::$other_scope($crate::spec::$other_presence(
                $key, $crate::schema::declare::kind!($other [$($other_args)*]), $other_value, $other_meaning
            )),
        ]
    };
}

/// The kind that a declaration writes.
macro_rules! kind {
    (text []) => { $crate::spec::Kind::Text };
    (name []) => { $crate::spec::Kind::Name };
    (name_apart []) => { $crate::spec::Kind::Name };
    (reference [$of:literal]) => { $crate::spec::Kind::Reference($of) };
    (flag []) => { $crate::spec::Kind::Flag };
    (whole [$least:expr, $most:expr]) => { $crate::spec::Kind::Integer($least, $most) };
    (whole_of [$($one:literal),*]) => { $crate::spec::Kind::IntegerOf(&[$($one),*]) };
    (number [$range:ident]) => { $crate::spec::Kind::Number($crate::spec::Range::$range) };
    (quantity [$dimension:ident, $range:ident]) => {
        $crate::spec::Kind::Quantity($crate::quantity::Dimension::$dimension, $crate::spec::Range::$range)
    };
    (any_quantity []) => { $crate::spec::Kind::AnyQuantity };
    (choice [$of:ident]) => { $crate::spec::Kind::Choice($of::CHOICES) };
    (length []) => { $crate::schema::declare::kind!(quantity [Length, Any]) };
    (point []) => { $crate::spec::Kind::Vector(const { &$crate::schema::declare::kind!(length []) }) };
    (point_in_space []) => { $crate::schema::declare::kind!(point []) };
    (vector [$kind:ident $(($($args:tt)*))?]) => {
        $crate::spec::Kind::Vector(const { &$crate::schema::declare::kind!($kind [$($($args)*)?]) })
    };
    (pair [$kind:ident $(($($args:tt)*))?]) => {
        $crate::spec::Kind::List(const { &$crate::schema::declare::kind!($kind [$($($args)*)?]) }, 2, 2)
    };
    (pair_each [$($kind:tt)*]) => { $crate::schema::declare::kind!(pair [$($kind)*]) };
    (triple [$kind:ident $(($($args:tt)*))?]) => {
        $crate::spec::Kind::List(const { &$crate::schema::declare::kind!($kind [$($($args)*)?]) }, 3, 3)
    };
    (list [$kind:ident $(($($args:tt)*))?, $least:expr, $most:expr]) => {
        $crate::spec::Kind::List(const { &$crate::schema::declare::kind!($kind [$($($args)*)?]) }, $least, $most)
    };
    (each [$kind:ident $(($($args:tt)*))?, $least:expr, $most:expr]) => {
        $crate::spec::Kind::List(const { &$crate::schema::declare::kind!($kind [$($($args)*)?]) }, $least, $most)
    };
    (apart [$kind:ident $(($($args:tt)*))?]) => { $crate::schema::declare::kind!($kind [$($($args)*)?]) };
    (either [$a:ident $(($($a_args:tt)*))?, $b:ident $(($($b_args:tt)*))?]) => {
        $crate::spec::Kind::Either(const { &[
            $crate::schema::declare::kind!($a [$($($a_args)*)?]),
            $crate::schema::declare::kind!($b [$($($b_args)*)?]),
        ] })
    };
    (table [$table:ident: $($of:tt)*]) => { $crate::spec::Kind::Table(&$table) };
    (variants [$variants:ident: $($of:tt)*]) => { $crate::spec::Kind::Variants(&$variants) };
    (map [$of:literal, $variants:ident: $($type:tt)*]) => { $crate::spec::Kind::Map($of, &$variants) };
}

/// The type of the values of a kind.
macro_rules! rust_type {
    (flag []) => { bool };
    (whole [$($range:tt)*]) => { usize };
    (whole_of [$($range:tt)*]) => { usize };
    (number [$($range:tt)*]) => { f64 };
    (quantity [$($range:tt)*]) => { f64 };
    (any_quantity []) => { $crate::spec::Measured };
    (length []) => { f64 };
    (choice [$of:ident]) => { $of };
    (point []) => { [f64; D] };
    (point_in_space []) => { [f64; 3] };
    (vector [$kind:ident $(($($args:tt)*))?]) => {
        [$crate::schema::declare::rust_type!($kind [$($($args)*)?]); D]
    };
    (pair [$kind:ident $(($($args:tt)*))?]) => { [$crate::schema::declare::rust_type!($kind [$($($args)*)?]); 2] };
    (pair_each [$kind:ident $(($($args:tt)*))?]) => {
        [Result<
            $crate::tree::read::At<$crate::schema::declare::rust_type!($kind [$($($args)*)?])>,
            $crate::tree::Wrong,
        >; 2]
    };
    (triple [$kind:ident $(($($args:tt)*))?]) => { [$crate::schema::declare::rust_type!($kind [$($($args)*)?]); 3] };
    (list [$kind:ident $(($($args:tt)*))?, $least:expr, $most:expr]) => {
        Vec<$crate::tree::read::At<$crate::schema::declare::rust_type!($kind [$($($args)*)?])>>
    };
    (each [$kind:ident $(($($args:tt)*))?, $least:expr, $most:expr]) => {
        Vec<Result<
            $crate::tree::read::At<$crate::schema::declare::rust_type!($kind [$($($args)*)?])>,
            $crate::tree::Wrong,
        >>
    };
    (either [$a:ident $(($($a_args:tt)*))?, $b:ident $(($($b_args:tt)*))?]) => {
        $crate::tree::read::Either<
            $crate::schema::declare::rust_type!($a [$($($a_args)*)?]),
            $crate::schema::declare::rust_type!($b [$($($b_args)*)?]),
        >
    };
    (table [$table:ident: $of:ty]) => { $of };
    (variants [$variants:ident: $of:ty]) => { $of };
    (map [$named:literal, $variants:ident: $of:ty]) => { $crate::tree::read::NamedTables<$of> };
    ($text:ident [$($of:literal)?]) => { String };
}

/// The type of a field: that of its kind and where it stands, and nothing of a key that may be missing.
macro_rules! field_type {
    (part [$table:ident: $of:ty]) => { $of };
    (group_in_space [$table:ident: $of:ty]) => { Result<$of, $crate::tree::Wrong> };
    (apart [$kind:ident $(($($args:tt)*))?] $($presence:tt)*) => {
        Result<$crate::schema::declare::field_type!($kind [$($($args)*)?] $($presence)*), $crate::tree::Wrong>
    };
    (group [$table:ident: $of:ty]) => { Result<$of, $crate::tree::Wrong> };
    ($kind:ident $args:tt required $($scope:ident $other:ident)?) => {
        $crate::tree::read::At<$crate::schema::declare::rust_type!($kind $args)>
    };
    ($kind:ident $args:tt default $($scope:ident $other:ident)?) => {
        $crate::tree::read::At<$crate::schema::declare::rust_type!($kind $args)>
    };
    ($kind:ident $args:tt $presence:ident $($scope:ident $($other:ident)?)?) => {
        Option<$crate::tree::read::At<$crate::schema::declare::rust_type!($kind $args)>>
    };
}

/// The value of a field in a table.
macro_rules! read {
    ($node:ident, part, $key:expr) => {
        $crate::tree::read::Read::read($node)
    };
    ($node:ident, group, $key:expr) => {
        $crate::tree::read::Read::read($node)
    };
    ($node:ident, group_in_space, $key:expr) => {
        $crate::tree::read::Read::read($node)
    };
    ($node:ident, $kind:ident, $key:expr) => {
        $crate::tree::read::ReadKey::read_key($node.entry($key))
    };
}

pub(crate) use {choices, field_type, key, kind, pieces, read, rust_type, schema, table, variants};

/// The filler of arrays of fields.
const BLANK: Field = optional("", Kind::Flag, "", "");

/// Number of fields of all pieces.
pub(crate) const fn count(pieces: &[&[Field]]) -> usize {
    let (mut count, mut k) = (0, 0);
    while k < pieces.len() {
        count += pieces[k].len();
        k += 1;
    }
    count
}

/// The fields of all pieces in their order.
pub(crate) const fn joined<const N: usize>(pieces: &[&[Field]]) -> [Field; N] {
    let mut fields = [BLANK; N];
    let (mut at, mut k) = (0, 0);
    while k < pieces.len() {
        let mut j = 0;
        while j < pieces[k].len() {
            fields[at] = pieces[k][j];
            at += 1;
            j += 1;
        }
        k += 1;
    }
    fields
}

/// The same fields as keys of space.
pub(crate) const fn all_in_space<const N: usize>(of: &[Field]) -> [Field; N] {
    let mut fields = [BLANK; N];
    let mut k = 0;
    while k < N {
        fields[k] = in_space(of[k]);
        k += 1;
    }
    fields
}
