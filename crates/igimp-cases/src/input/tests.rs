//! Messages and results of whole files.
use super::*;

#[test]
fn models() {
    for name in ["slope", "footing"] {
        let text = std::fs::read_to_string(format!("cases/{name}.toml")).unwrap();
        match CaseFile::parse(&format!("{name}.toml"), &text, &[]) {
            Ok(file) => println!("{}\n{:#?}", file.warnings(), file.case()),
            Err(error) => panic!("{error}"),
        }
    }
}
