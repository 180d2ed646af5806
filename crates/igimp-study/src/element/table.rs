//! The table of a test: a row a step.

use igimp_material::InternalVariable;
use igimp_results::tables::table::Table;
use igimp_solver::element::{ElementState, StandardTest};

use super::Drive;

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

/// The strain that a test drives, compression positive \[-\]; of a path the deviatoric one of natural strains.
pub(super) fn driven_strain(state: &ElementState, drive: &Drive) -> f64 {
    match drive {
        Drive::Standard(test, _) if test.is_shear() => state.strain[3],
        Drive::Standard(..) => -state.strain[1],
        Drive::Path(_) => deviatoric_strain(state),
    }
}

/// Its name.
pub(super) fn driven_name(drive: &Drive) -> &'static str {
    match drive {
        Drive::Standard(test, _) if test.is_shear() => "shear strain",
        Drive::Standard(..) => "axial strain",
        Drive::Path(_) => "deviatoric strain",
    }
}

/// √(2/3 e:e) of the strain, with half of ∂u_x/∂Y as its shear \[-\].
pub(super) fn deviatoric_strain(state: &ElementState) -> f64 {
    let [x, y, z, shear] = state.strain;
    let mean = (x + y + z) / 3.0;
    let normal: f64 = [x, y, z].map(|strain| (strain - mean).powi(2)).iter().sum();
    (2.0 / 3.0 * (normal + 0.5 * shear * shear)).sqrt()
}

/// Pore pressure that an undrained test makes, with total stress kept at the sides, or on top of a test in shear \[Pa\].
pub(super) fn pore_pressure(state: &ElementState, first: &ElementState, test: StandardTest) -> f64 {
    let kept = usize::from(test.is_shear());
    state.sigma[kept][kept] - first.sigma[kept][kept]
}

pub(super) fn table(
    states: &[ElementState],
    drive: &Drive,
    variables: &[InternalVariable],
) -> Table {
    let undrained = match drive {
        Drive::Standard(test, _) if test.is_undrained() => Some(*test),
        _ => None,
    };
    let mut header: Vec<String> = [
        "strain_xx, compression positive [%]",
        "strain_yy, compression positive [%]",
        "strain_zz, compression positive [%]",
        "shear strain_xy [%]",
        "volumetric strain, compression positive [%]",
        "deviatoric strain [%]",
        "sigma_xx effective, compression positive [kPa]",
        "sigma_yy effective, compression positive [kPa]",
        "sigma_zz effective, compression positive [kPa]",
        "tau_xy [kPa]",
        "p effective, compression positive [kPa]",
        "q [kPa]",
    ]
    .map(str::to_owned)
    .to_vec();
    header.extend(undrained.map(|_| "pore pressure [kPa]".to_owned()));
    header.push("plastic strain [-]".to_owned());
    header.push("regime".to_owned());
    header.extend(
        variables
            .iter()
            .map(|own| format!("{} [{}]", own.name, own.unit)),
    );
    let columns: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = Table::new("element", &columns);
    for state in states {
        let [x, y, z, shear] = state.strain.map(|strain| 100.0 * strain);
        let s = state.sigma.map(|row| row.map(|stress| stress / 1e3));
        let mut row = vec![
            0.0 - x,
            0.0 - y,
            0.0 - z,
            shear,
            100.0 * state.volumetric_strain(),
            100.0 * deviatoric_strain(state),
            0.0 - s[0][0],
            0.0 - s[1][1],
            0.0 - s[2][2],
            s[0][1],
            state.p() / 1e3,
            state.q() / 1e3,
        ];
        row.extend(undrained.map(|test| pore_pressure(state, &states[0], test) / 1e3));
        row.push(state.history.eps_p_eq);
        row.push(f64::from(state.regime.code()));
        row.extend(state.history.internal.iter().take(variables.len()));
        table.push(row);
    }
    table
}
