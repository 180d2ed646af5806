//! Hoek–Brown: its parameters from what a file states.

use igimp_material::HoekBrownParameters;
use igimp_model::Strength;
use igimp_schema::schema::materials::HoekBrown;

use super::parameters::{ANGLE_OR_NONE, Limit, NUMBER, NUMBER_OR_NONE, Parameters, STRESS};

const GSI: Limit = (
    |value| value <= 100.0,
    "`gsi` must be at most 100",
    "intact rock has 100, blocky rock 50 to 70, sheared rock 10 to 30",
);
const DISTURBANCE: Limit = (
    |value| value <= 1.0,
    "`disturbance` must be at most 1",
    "0 for rock left whole, 0.7 for careful blasting, 1 for blasted slopes",
);
const DILATION: Limit = (
    |angle| angle.to_degrees() <= 89.0,
    "the dilation angle must be below 90 deg",
    "rock masses have 0 deg to a fourth of their friction angle",
);

/// The strength of a table.
pub(super) fn strength<const D: usize>(
    rock: &HoekBrown,
    read: &mut Parameters<'_, '_, D>,
) -> Option<Strength> {
    let intact_strength = read.read("sci", &rock.sci, STRESS, None);
    let gsi = read.read("gsi", &rock.gsi, NUMBER, Some(GSI));
    let intact_ratio = read.read("mi", &rock.mi, NUMBER, None);
    let disturbance = &rock.disturbance;
    let disturbance = read.read(
        "disturbance",
        disturbance,
        NUMBER_OR_NONE,
        Some(DISTURBANCE),
    );
    let dilation = read.read("dilation", &rock.dilation, ANGLE_OR_NONE, Some(DILATION));
    Some(Strength::HoekBrown(HoekBrownParameters {
        intact_strength: intact_strength?.most,
        gsi: gsi?.most,
        intact_ratio: intact_ratio?.most,
        disturbance: disturbance?.most,
        dilation_angle: dilation?.most,
    }))
}
