//! Large and absurd files are judged quickly.

use std::fmt::Write as _;

use igimp_input::{CaseFile, InputError};

use crate::edits::edited;
use crate::{SLOPE, overridden};

#[test]
fn large_files_are_judged_quickly() {
    let mut bodies = String::new();
    for k in 0..1200 {
        let (x, y) = (k % 60, k / 60);
        let [right, top] = [x + 1, y + 1];
        let _ = write!(
            bodies,
            "[[bodies]]\nname = \"b{k}\"\nmaterial = \"rock\"\npolygon = [[\"{x} m\",\"{y} m\"], \
             [\"{right} m\",\"{y} m\"], [\"{right} m\",\"{top} m\"], [\"{x} m\",\"{top} m\"]]\n"
        );
    }
    let mut more = String::new();
    for k in 0..1000 {
        let _ = write!(
            more,
            "[[sections]]\nname = \"s{k}\"\nfrom = [\"1 m\",\"21 m\"]\nto = [\"2 m\",\"21 m\"]\n\
             [[monitors]]\nname = \"m{k}\"\npoint = [\"1 m\",\"21 m\"]\n\
             [[loads]]\nname = \"l{k}\"\ntype = \"pressure\"\nfrom = [\"1 m\",\"20 m\"]\nto = [\"9 m\",\"20 m\"]\npressure = \"1 kPa\"\n"
        );
    }
    let (head, tail) = SLOPE.1.split_once("[[bodies]]").unwrap();
    let (_, tail) = tail.split_once("[boundaries]").unwrap();
    let tail = tail.split_once("[[stages]]").unwrap().0;
    let stage = "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\n";
    let text = format!("{head}{bodies}[boundaries]{tail}{stage}{more}");
    let begin = std::time::Instant::now();
    let file = CaseFile::parse("large.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(file.case().bodies.len(), 1200);
    assert!(begin.elapsed().as_secs() < 20, "{:?}", begin.elapsed());
}

/// Every unknown key is counted, and none is compared with all others.
#[test]
fn files_of_unknown_keys_are_judged_quickly() {
    let mut text = SLOPE.1.to_owned();
    for key in 0..50_000 {
        let _ = writeln!(text, "key_{key} = 1");
    }
    let error = CaseFile::parse(SLOPE.0, &text, &[]).unwrap_err();
    assert!(matches!(error, InputError::Invalid { errors: 50_000, .. }));
}

#[test]
fn absurd_files_are_refused_quickly() {
    let corner = "[\"1 m\", \"2 m\"], ".repeat(20_000);
    let stages = "[[stages]]\nname = \"x\"\ntype = \"gravity\"\n".repeat(5_000);
    let deep = format!("{}1{}", "[".repeat(10_000), "]".repeat(10_000));
    let table = format!("[{}]\n", vec!["a"; 10_000].join("."));
    for text in [
        edited(SLOPE.1, &[("polygon = [", &format!("polygon = [{corner}"))]),
        format!("{}{stages}", SLOPE.1),
        format!("x = {deep}"),
        table,
        "a".repeat(9 << 20),
        String::new(),
        "\n".repeat(100_000),
    ] {
        let error = CaseFile::parse("absurd.toml", &text, &[])
            .unwrap_err()
            .to_string();
        assert!(error.contains("absurd.toml"), "{error}");
        assert!(error.len() < 200_000, "{} bytes", error.len());
    }
    let key = vec!["a"; 10_000].join(".");
    assert!(overridden(SLOPE, &[&format!("{key}=1")]).is_err());
}
