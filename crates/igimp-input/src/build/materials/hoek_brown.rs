//! Hoek–Brown: its parameters from what a file states.

use igimp_material::HoekBrownParameters;
use igimp_model::Strength;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::HoekBrown;

/// The strength of a table.
pub(super) fn strength(own: &HoekBrown, problems: &mut Problems) -> Option<Strength> {
    if *own.gsi > 100.0 {
        problems
            .error(own.gsi.place, "`gsi` is at most 100")
            .help("intact rock has 100, blocky rock 50 to 70, sheared rock 10 to 30");
        return None;
    }
    if *own.disturbance > 1.0 {
        problems
            .error(own.disturbance.place, "`disturbance` is at most 1")
            .help("0 for rock left whole, 0.7 for careful blasting, 1 for blasted slopes");
        return None;
    }
    if own.dilation.to_degrees() > 89.0 {
        problems
            .error(
                own.dilation.place,
                "the dilation angle must be below 90 deg",
            )
            .help("rock masses have 0 deg to a fourth of their friction angle");
        return None;
    }
    Some(Strength::HoekBrown(HoekBrownParameters {
        intact_strength: *own.sci,
        gsi: *own.gsi,
        intact_ratio: *own.mi,
        disturbance: *own.disturbance,
        dilation_angle: *own.dilation,
    }))
}
