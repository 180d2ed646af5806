//! The path of a test in words.

use igimp_report::report::page::{Column, PageTable};
use igimp_solver::element::{Control, ElementPath, Kinematics, StandardTest};
use igimp_text::short;

use super::measure::Measure;
use super::{Drive, Request};

/// Most legs that are listed one by one.
const MOST_LEGS: usize = 40;

/// The components of a path, by their strains and by their stresses.
const COMPONENTS: [[Measure; 2]; 4] = [
    [Measure::StrainXx, Measure::SigmaXx],
    [Measure::StrainYy, Measure::SigmaYy],
    [Measure::StrainZz, Measure::SigmaZz],
    [Measure::StrainXy, Measure::TauXy],
];

/// Driven and kept components, and where the test begins.
pub(super) fn sentences(request: &Request) -> Vec<String> {
    let [axial, side] = request.stress.map(|stress| short(stress / 1e3));
    let (driven, each) = match &request.drive {
        Drive::Standard(test, strain) => (standard(*test, *strain), "The test"),
        Drive::Path(path) => (legs_in_words(path.legs.len()), "Each leg"),
    };
    let measures = match request.kinematics {
        Kinematics::Finite => "Strain is natural strain, and stress Cauchy's",
        Kinematics::Small => "Strain is linear, and stress that per initial area",
    };
    let lasts = if request.duration > 0.0 {
        format!(", and lasts {} s", short(request.duration))
    } else {
        String::new()
    };
    vec![
        driven,
        format!(
            "It begins at σ_y = {axial} kPa and σ_x = σ_z = {side} kPa, effective. {each} has {} steps{lasts}. {measures}.",
            request.steps
        ),
    ]
}

/// A test of the laboratory in words.
fn standard(test: StandardTest, strain: f64) -> String {
    let (name, kept) = match test {
        StandardTest::TriaxialDrained => ("Axial", "while the stress at the sides stays"),
        StandardTest::TriaxialUndrained => ("Axial", "at constant volume, with both sides alike"),
        StandardTest::Oedometer => ("Axial", "without strain of the sides"),
        StandardTest::SimpleShearDrained => (
            "Shear",
            "while the axial stress stays, without strain of the sides",
        ),
        StandardTest::SimpleShearUndrained => ("Shear", "without any other strain"),
        StandardTest::PlaneStrainDrained => {
            ("Axial", "while the stress in x stays, without strain in z")
        }
        StandardTest::PlaneStrainUndrained => ("Axial", "at constant volume, without strain in z"),
    };
    let percent = short(100.0 * strain);
    format!("{name} strain is driven from 0 to {percent} %, {kept}.")
}

fn legs_in_words(legs: usize) -> String {
    let listed = if legs > MOST_LEGS {
        format!(", the first {MOST_LEGS} of which are listed")
    } else {
        String::new()
    };
    let s = if legs == 1 { "" } else { "s" };
    format!(
        "A path of {legs} leg{s} is followed{listed}; a row has what is prescribed at the end of a leg."
    )
}

/// The legs of a path; none of a test of the laboratory.
pub(super) fn legs(drive: &Drive) -> Option<PageTable> {
    let Drive::Path(ElementPath { controls, legs }) = drive else {
        return None;
    };
    let column = |control: &Control, [strain, stress]: [Measure; 2]| match control {
        Control::Stress => Column::numbers(stress.header()),
        Control::Strain | Control::AsXx => Column::numbers(strain.header()),
    };
    let columns = controls.iter().zip(COMPONENTS);
    let columns = columns.map(|(control, measures)| column(control, measures));
    let rows = legs.iter().take(MOST_LEGS).zip(1..).map(|(leg, number)| {
        let cells = leg.iter().zip(controls).enumerate();
        let cells = cells.map(|(place, (value, control))| cell(place, *value, *control));
        [format!("{number}")].into_iter().chain(cells).collect()
    });
    Some(PageTable {
        name: "Legs of the path".to_owned(),
        columns: [Column::numbers("Leg")]
            .into_iter()
            .chain(columns)
            .collect(),
        rows: rows.collect(),
    })
}

/// The prescribed value of a component at the end of a leg, compression positive.
fn cell(place: usize, value: f64, control: Control) -> String {
    let [strain, stress] = COMPONENTS[place];
    let sign = if place < 3 { -1.0 } else { 1.0 };
    match control {
        Control::AsXx => "as xx".to_owned(),
        Control::Stress if value.is_nan() => "as at the start".to_owned(),
        Control::Stress => short(stress.printed(0.0 + sign * value)),
        Control::Strain => short(strain.printed(0.0 + sign * value)),
    }
}
