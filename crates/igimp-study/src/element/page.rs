//! The page of a test: its path, its results, its curves, and the data beside them.

use igimp_report::report::page::{Column, Page, PageTable, Section};
use igimp_report::setup;
use igimp_results::summary::FigureNote;
use igimp_text::short;

use super::measure::{Measure, undrained};
use super::{Compared, Drive, Tested, path_words, table, text};

/// The page of a folder that has the tables and pictures of the test.
pub(super) fn page(tested: &Tested) -> Page {
    let is_early = tested.run.failure.is_some();
    let has_warnings = !warnings(tested).is_empty() || !tested.warnings.is_empty();
    let word = match (is_early, has_warnings) {
        (true, _) => "Ended early",
        (false, true) => "Completed, with warnings",
        (false, false) => "Completed",
    };
    let mut sections = vec![values(tested)];
    sections.extend(has_warnings.then(|| Section {
        title: "Warnings".to_owned(),
        warnings: warnings(tested),
        text: tested.warnings.clone(),
        ..Section::default()
    }));
    sections.push(curves(tested));
    sections.extend(measured(tested));
    sections.extend([material(tested), path(tested)]);
    Page {
        title: tested.title.clone(),
        is_doubtful: is_early || has_warnings,
        word: word.to_owned(),
        sentences: sentences(tested),
        sections,
    }
}

/// The lines that are printed, as sentences.
fn sentences(tested: &Tested) -> Vec<String> {
    let (request, states) = (&tested.request, &tested.run.states);
    let values = &tested.values;
    let peak = &states[values.peak];
    let along = table::abscissa(&request.drive);
    let mut sentences = vec![format!(
        "The largest {} is {} kPa, at {} % of {}.",
        values.symbol(),
        short(values.stress.of(peak, &states[0], &request.drive) / 1e3),
        short(100.0 * along.of(peak, &states[0], &request.drive)),
        table::driven_name(&request.drive),
    )];
    sentences.extend(text::closed(values, request, states).map(|text| sentence(&text)));
    sentences.extend(text::ending(tested).iter().map(|line| sentence(line)));
    sentences
}

/// A line as a sentence.
fn sentence(line: &str) -> String {
    let mut letters = line.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

/// Warnings for a reader before a number is used.
fn warnings(tested: &Tested) -> Vec<String> {
    let varies = tested.material.varies().then(|| sentence(text::VARIES));
    let compared = tested.compared.iter();
    let beyond = compared.flat_map(Compared::beyond).map(|measure| {
        format!(
            "{} was measured beyond the early end of the test.",
            measure.name()
        )
    });
    varies.into_iter().chain(beyond).collect()
}

/// The states at the start, at the largest stress and at the end.
fn values(tested: &Tested) -> Section {
    let (drive, states) = (&tested.request.drive, &tested.run.states);
    let values = &tested.values;
    let shown = [0, values.peak, states.len() - 1].map(|place| &states[place]);
    let along = table::abscissa(drive);
    let quantity = |m: Measure| {
        let cells = shown.map(|state| short(m.printed(m.of(state, &states[0], drive))));
        [m.header().to_owned()].into_iter().chain(cells).collect()
    };
    let mut rows: Vec<Vec<String>> = measures(drive, along).map(quantity).collect();
    let row = |name: &str, cells: [f64; 3]| {
        [name.to_owned()]
            .into_iter()
            .chain(cells.map(short))
            .collect()
    };
    rows.push(row("q/p [-]", shown.map(|state| state.q() / state.p())));
    rows.push(row("mobilised strength [-]", values.mobilised));
    let heads = [
        "Start".to_owned(),
        format!("Largest {}", values.symbol()),
        "End".to_owned(),
    ];
    let numbers = heads.map(Column::numbers);
    Section {
        title: "Values".to_owned(),
        tables: vec![PageTable {
            name: "Values at the start, at the largest stress and at the end".to_owned(),
            columns: [Column::words("Quantity")]
                .into_iter()
                .chain(numbers)
                .collect(),
            rows,
        }],
        files: vec!["element.csv".to_owned()],
        ..Section::default()
    }
}

/// Measures of a test on the page: the strain that curves are drawn over, volume or pore pressure, and stresses.
fn measures(drive: &Drive, along: Measure) -> impl Iterator<Item = Measure> {
    let has_shear = !matches!(drive, Drive::Standard(test, _) if !test.is_shear());
    let pressure = undrained(drive).map(|_| Measure::PorePressure);
    let shear = has_shear.then_some(Measure::TauXy);
    [along, Measure::Volume]
        .into_iter()
        .chain(pressure)
        .chain([Measure::SigmaYy, Measure::SigmaXx, Measure::SigmaZz])
        .chain(shear)
        .chain([Measure::P, Measure::Q])
}

/// The pictures, with the data over the computed curves.
fn curves(tested: &Tested) -> Section {
    Section {
        title: "Curves".to_owned(),
        pictures: pictures(tested),
        ..Section::default()
    }
}

/// The pictures of a test by their files, with their captions.
pub(crate) fn pictures(tested: &Tested) -> Vec<FigureNote> {
    let plots = tested.plots().into_iter();
    plots
        .map(|(file, plot)| {
            let shown = match &*file {
                "stress-strain" => "Stress over strain".to_owned(),
                "stress-path" => "The path of stress".to_owned(),
                "volume" => "Volumetric strain over strain".to_owned(),
                "pore-pressure" => "Pore pressure over strain".to_owned(),
                other => other.replace('-', " "),
            };
            let has_points = plot.series.len() > 1;
            let points = if has_points {
                ": computed, and measured"
            } else {
                ""
            };
            FigureNote {
                file,
                caption: format!("{shown}{points}"),
            }
        })
        .collect()
}

/// How far off a test is from its data, by quantity.
fn measured(tested: &Tested) -> Option<Section> {
    let compared = tested.compared.as_ref()?;
    let data = &compared.data;
    let rows = data.columns.iter().enumerate().map(|(place, m)| {
        let cells = compared.off_in_words(place);
        [m.name().to_owned()].into_iter().chain(cells).collect()
    });
    let numbers = [
        "Values",
        "Root mean square difference",
        "Largest difference",
        "Line",
    ];
    Some(Section {
        title: "Data of the laboratory".to_owned(),
        sentences: vec![format!(
            "Computed less measured, of {}; the test stops at each measurement.",
            data.name
        )],
        tables: vec![PageTable {
            name: "Differences".to_owned(),
            columns: [Column::words("Quantity")]
                .into_iter()
                .chain(numbers.map(Column::numbers))
                .collect(),
            rows: rows.collect(),
        }],
        files: vec!["data.csv".to_owned()],
        ..Section::default()
    })
}

/// The law and its parameters.
fn material(tested: &Tested) -> Section {
    let table = setup::of_material(&tested.material);
    Section {
        title: format!("Material {}", tested.material.name),
        tables: vec![PageTable {
            name: table.title,
            columns: table.header.into_iter().map(Column::words).collect(),
            rows: table.rows,
        }],
        ..Section::default()
    }
}

/// The driven path.
fn path(tested: &Tested) -> Section {
    let mut sentences = path_words::sentences(&tested.request);
    let notes = tested.notes().into_iter();
    sentences.extend((notes.filter(|note| *note != text::VARIES)).map(|note| sentence(&note)));
    Section {
        title: "Path".to_owned(),
        sentences,
        tables: path_words::legs(&tested.request.drive)
            .into_iter()
            .collect(),
        ..Section::default()
    }
}
