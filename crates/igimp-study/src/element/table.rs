//! The table of a test: a row a step.

use igimp_material::InternalVariable;
use igimp_results::tables::table::Table;
use igimp_solver::element::{ElementState, StandardTest};

use super::Drive;
use super::measure::Measure;

/// Header of the place on a path.
const LEG: &str = "leg [-]";

/// The name of a standard test, as the program takes it.
pub fn name_of(test: StandardTest) -> &'static str {
    match test {
        StandardTest::TriaxialDrained => "triaxial-drained",
        StandardTest::TriaxialUndrained => "triaxial-undrained",
        StandardTest::Oedometer => "oedometer",
        StandardTest::SimpleShearDrained => "simple-shear-drained",
        StandardTest::SimpleShearUndrained => "simple-shear-undrained",
        StandardTest::PlaneStrainDrained => "plane-strain-drained",
        StandardTest::PlaneStrainUndrained => "plane-strain-undrained",
    }
}

/// The standard test of a name, if there is one.
pub fn of_name(name: &str) -> Option<StandardTest> {
    StandardTest::ALL
        .into_iter()
        .find(|test| name_of(*test) == name)
}

/// The strain that a test drives; none of a path, on which legs are counted.
pub(super) fn driven(drive: &Drive) -> Option<Measure> {
    match drive {
        Drive::Standard(test, _) if test.is_shear() => Some(Measure::StrainXy),
        Drive::Standard(..) => Some(Measure::StrainYy),
        Drive::Path(_) => None,
    }
}

/// The strain that curves are drawn over: that which is driven, of a path the deviatoric one.
pub(super) fn abscissa(drive: &Drive) -> Measure {
    driven(drive).unwrap_or(Measure::Deviatoric)
}

/// Its name.
pub(super) fn driven_name(drive: &Drive) -> &'static str {
    match drive {
        Drive::Standard(test, _) if test.is_shear() => "shear strain",
        Drive::Standard(..) => "axial strain",
        Drive::Path(_) => "deviatoric strain",
    }
}

/// A row a state; of a path with the number of legs that were followed.
pub(super) fn table(
    (states, ways): (&[ElementState], &[f64]),
    drive: &Drive,
    variables: &[InternalVariable],
) -> Table {
    let is_path = driven(drive).is_none();
    let mut header: Vec<String> = Vec::new();
    header.extend(is_path.then(|| LEG.to_owned()));
    header.extend(Measure::of_test(drive).map(|measure| measure.header().to_owned()));
    header.push("plastic strain [-]".to_owned());
    header.push("regime".to_owned());
    header.extend(
        variables
            .iter()
            .map(|variable| format!("{} [{}]", variable.name, variable.unit)),
    );
    let columns: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = Table::new("element", &columns);
    for (state, way) in states.iter().zip(ways) {
        let mut row = Vec::new();
        row.extend(is_path.then_some(*way));
        row.extend(Measure::of_test(drive).map(|m| m.printed(m.of(state, &states[0], drive))));
        row.push(state.history.eps_p_eq);
        row.push(f64::from(state.regime.code()));
        row.extend(state.history.internal.iter().take(variables.len()));
        table.push(row);
    }
    table
}
