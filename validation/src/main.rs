//! validation.
fn main() {}
