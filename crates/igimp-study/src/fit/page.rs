//! The report of a fit: parameters, correlations, differences, and every test with its data.

use std::path::Path;

use igimp_report::report::page::{Column, Page, PageTable, Section};
use igimp_results::summary::FigureNote;
use igimp_text::short;

use super::text;
use super::{Fitted, Found, Known};
use crate::element::{Compared, Tested, pictures};

/// Stands for a value without a number.
const NONE: &str = "–";

/// The caption of the picture of residuals.
const RESIDUALS: &str =
    "Residuals over their standard deviation; of scatter alone 95 % lie within the lines at 2";

/// The page; `written` has the folder of every test, and its files.
pub(super) fn page(fitted: &Fitted, written: &[(String, Vec<String>)]) -> Page {
    let [iterations, evaluations] = fitted.effort;
    let mut sentences = vec![format!(
        "{}. The search converged after {iterations} iterations and {evaluations} evaluations.",
        text::from(fitted)
    )];
    let reservations = reservations(fitted);
    let is_doubtful = !reservations.is_empty();
    sentences.extend(reservations);
    let mut sections = vec![parameters(fitted)];
    sections.extend((fitted.parameters.len() > 1).then(|| correlations(fitted)));
    sections.push(differences(fitted));
    let tests = fitted.tests.iter().zip(written).zip(1..);
    sections.extend(tests.map(|((tested, files), at)| test(tested, at, files)));
    sections.push(Section {
        title: "For the case file".to_owned(),
        sentences: vec![
            "These lines take the place of those of the material; they stand in fit.toml too."
                .to_owned(),
        ],
        text: fitted.block.clone(),
        ..Section::default()
    });
    Page {
        title: format!("{}, parameters from data", fitted.title),
        is_doubtful,
        word: if is_doubtful {
            "Found, with reservations"
        } else {
            "Found"
        }
        .to_owned(),
        sentences,
        sections,
    }
}

/// Reservations about the values, for a reader.
fn reservations(fitted: &Fitted) -> Vec<String> {
    let sentence = |text: &str| {
        let mut letters = text.chars();
        let first = letters.next().map(|c| c.to_uppercase().to_string());
        format!("{}{}.", first.unwrap_or_default(), letters.as_str())
    };
    let unknown = (fitted.parameters.iter())
        .filter(|found| !matches!(found.known, Known::Well { .. }))
        .map(|found| format!("{}.", text::line(found, &fitted.parameters)));
    let kink = fitted.has_kink.then(|| sentence(text::KINK));
    let pairs = text::pairs(fitted)
        .into_iter()
        .map(|pair| format!("{pair}."));
    kink.into_iter().chain(unknown).chain(pairs).collect()
}

fn parameters(fitted: &Fitted) -> Section {
    let names = ["Start", "Value", "Standard error", "95 % from", "to"];
    let columns = ["Parameter", "Unit"].into_iter().map(Column::words);
    let columns = columns.chain(names.into_iter().map(Column::numbers));
    Section {
        title: "Parameters".to_owned(),
        sentences: vec![
            "Errors are those of linear theory about the least sum of squares. They count the scatter of the data, and not what the law cannot follow."
                .to_owned(),
        ],
        tables: vec![PageTable {
            name: "Parameters".to_owned(),
            columns: columns.chain([Column::words("Known by")]).collect(),
            rows: fitted.parameters.iter().map(row).collect(),
        }],
        files: vec!["fit.csv".to_owned()],
        ..Section::default()
    }
}

/// The row of a parameter.
fn row(found: &Found) -> Vec<String> {
    let none = || NONE.to_owned();
    let (numbers, by) = match &found.known {
        Known::Well {
            error,
            interval: [low, high],
        } => {
            let digits = |value: f64| text::digits(value, *error);
            let ends = [digits(*low), digits(*high)];
            let [low, high] = ends;
            (
                [digits(found.value), short(*error), low, high],
                "these data",
            )
        }
        Known::AtBound { .. } | Known::AtWall { .. } => {
            let by = match found.known {
                Known::AtBound { upper: true } => "its upper bound",
                Known::AtBound { .. } => "its lower bound",
                Known::AtWall { upper: true } => "the greatest value that is accepted",
                _ => "the least value that is accepted",
            };
            ([short(found.value), none(), none(), none()], by)
        }
        Known::NotDetermined { .. } => ([(); 4].map(|()| none()), "nothing: not determined"),
    };
    let head = [found.key.clone(), found.unit.clone(), short(found.start)];
    (head.into_iter().chain(numbers))
        .chain([by.to_owned()])
        .collect()
}

fn correlations(fitted: &Fitted) -> Section {
    let keys = || fitted.parameters.iter().map(|found| found.key.clone());
    let cell = |value: &f64| match text::correlation(*value, 3) {
        none if none.is_empty() => NONE.to_owned(),
        some => some,
    };
    let rows = keys().zip(&fitted.correlation).map(|(key, row)| {
        let cells = row.iter().map(cell);
        [key].into_iter().chain(cells).collect()
    });
    Section {
        title: "Correlations".to_owned(),
        sentences: vec![
            "Near 1 and −1 two parameters are known less well than both together; other data tell them apart."
                .to_owned(),
        ],
        tables: vec![PageTable {
            name: "Correlations".to_owned(),
            columns: [Column::words("")]
                .into_iter()
                .chain(keys().map(Column::numbers))
                .collect(),
            rows: rows.collect(),
        }],
        files: vec!["correlation.csv".to_owned()],
        ..Section::default()
    }
}

/// How far off the tests are, by quantity.
fn differences(fitted: &Fitted) -> Section {
    let words = ["Test", "Quantity", "Data"].map(Column::words);
    let numbers = [
        "Values",
        "Standard deviation",
        "Root mean square difference",
        "Largest difference",
        "Line",
    ];
    let tests = fitted.tests.iter().zip(&fitted.scales).zip(1..);
    let rows = tests.flat_map(|((tested, scales), at)| {
        let compared = tested.compared.iter();
        compared.flat_map(move |data| {
            let columns = scales.iter().enumerate();
            columns.map(move |(k, scale)| off((data, at), k, scale * fitted.deviation))
        })
    });
    Section {
        title: "Differences".to_owned(),
        sentences: vec![
            "Computed less measured. The standard deviation is that of scatter, as all residuals together have it."
                .to_owned(),
        ],
        tables: vec![PageTable {
            name: "Differences".to_owned(),
            columns: words
                .into_iter()
                .chain(numbers.map(Column::numbers))
                .collect(),
            rows: rows.collect(),
        }],
        ..Section::default()
    }
}

/// The row of a quantity of a test, with its standard deviation in SI.
fn off((compared, at): (&Compared, usize), column: usize, deviation: f64) -> Vec<String> {
    let measure = compared.data.columns[column];
    let [values, mean, largest, line] = compared.off_in_words(column);
    let deviation = match compared.off(column) {
        Some(_) => format!("{} {}", short(measure.printed(deviation)), measure.unit()),
        None => NONE.to_owned(),
    };
    let numbers = [values, deviation, mean, largest, line];
    let data = &compared.data.name;
    let words = [at.to_string(), measure.name().to_owned(), data.clone()];
    words.into_iter().chain(numbers).collect()
}

/// A test with its pictures.
fn test(tested: &Tested, at: usize, (folder, files): &(String, Vec<String>)) -> Section {
    let first = tested.text.lines().next().unwrap_or_default();
    let name = first.rsplit(", ").next().unwrap_or_default();
    let inside = |file: &str| format!("{folder}/{file}");
    let mut pictures = pictures(tested);
    pictures.extend(
        files
            .iter()
            .any(|file| file == "residuals.svg")
            .then(|| FigureNote {
                file: "residuals".to_owned(),
                caption: RESIDUALS.to_owned(),
            }),
    );
    for picture in &mut pictures {
        picture.file = inside(&picture.file);
    }
    let is_table = |file: &&String| Path::new(file).extension().is_some_and(|end| end == "csv");
    let tables = files.iter().filter(is_table);
    Section {
        title: format!("Test {at}: {name}"),
        text: tested.text.clone(),
        pictures,
        files: tables.map(|file| inside(file)).collect(),
        ..Section::default()
    }
}
