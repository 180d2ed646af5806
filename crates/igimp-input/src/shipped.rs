//! The case files that come with the program: templates for `igimp new`, and the cases that
//! `igimp validate` holds against their references.

use crate::{CaseFile, InputError};

/// A case file that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shipped {
    /// Name, the file's without extension.
    pub name: &'static str,
    /// Its subject, in a line.
    pub summary: &'static str,
    /// The file.
    pub text: &'static str,
}

impl Shipped {
    /// The file, changed by overrides such as `grid.locking=none`.
    ///
    /// # Errors
    /// [`InputError::Invalid`] for overrides that make no sense.
    pub fn case_file<S: Into<String>>(
        &self,
        overrides: impl IntoIterator<Item = S>,
    ) -> Result<CaseFile, InputError> {
        let overrides: Vec<String> = overrides.into_iter().map(Into::into).collect();
        CaseFile::parse(&format!("{}.toml", self.name), self.text, &overrides)
    }
}

/// One entry a file of `cases/`.
macro_rules! shipped {
    ($($name:literal: $summary:literal,)*) => {
        /// All case files that come with the program.
        pub const SHIPPED: &[Shipped] = &[$(Shipped {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("../cases/", $name, ".toml")),
        }),*];
    };
}

shipped! {
    "column": "elastic column under its own weight, held against the exact solution",
    "von_mises_slope": "soft slope in undrained clay: smooth stress at large displacement",
    "mohr_coulomb_slope": "slope in c-phi soil: displacement against strength reduction, factor of safety",
    "footing": "rigid strip footing pushed one width deep into undrained clay that can leave it",
    "footing_bonded": "the same footing as prescribed nodes that soil never leaves, for comparison",
    "slope": "cut slope on rock: factor of safety, then run-out",
    "layered_slope": "clay slope on a soft layer: factors of safety of all layers and of one",
    "undrained_slope": "undrained slope under rising weight, held against limit analysis",
    "sensitive_slope": "slope in clay that softens as it is sheared: factor of safety between intact and remoulded",
    "rock_slope": "slope in a weak rock mass by Hoek and Brown: factor of safety",
    "vertical_cut": "vertical cut in undrained clay under rising weight, held against limit analysis",
    "nailed_cut": "vertical cut held by soil nails: tension in the nails, factor of safety",
    "bearing_capacity": "rough strip footing on undrained clay, held against Prandtl's solution",
    "circular_footing": "rough circular footing, a body of revolution, held against slip lines",
    "anisotropic_footing": "strip footing on clay whose strength goes with direction, held against its closed form",
    "dense_sand_footing": "strip footing on dense sand by Hardening Soil, pushed, relieved and pushed on",
    "two_layer_footing": "strip footing on stiff over soft clay, held against limit analysis",
    "strip_load": "uniform strip pressure on undrained clay, held against Prandtl's solution",
    "embankment": "embankment in three lifts on layered ground that was at rest",
    "k0_ground": "level ground at rest, held against the exact stresses",
    "soft_clay_fill": "wide fill on normally consolidated clay, held against one-dimensional compression",
    "cantilever": "elastic cantilever bent far, held against beam theory",
    "contact_footing": "strip footing that the soil can leave, pushed into undrained clay and pulled out",
    "eccentric_footing": "strip footing under an eccentric load, free to tilt and slide",
    "pipe": "pipe pushed half its diameter into undrained clay",
    "wall": "smooth wall moved away from sand and into it: active and passive pressure",
    "plate_anchor": "plate anchor pulled up through undrained clay, with a gap below it",
    "wedge": "smooth wedge pushed into undrained clay",
    "dam_drawdown": "dam of earth: factors of safety dry, with a full pool and after drawdown",
    "dam_seepage": "dam of earth with the steady seepage through it: free surface, discharge, factor of safety",
    "well": "pumped well in sand, a body of revolution: free surface, discharge, settlement",
    "rapid_drawdown": "dam of earth whose pool is drawn down: the factor of safety against time, beside its limits",
    "consolidation": "clay under a fill that settles as its water leaves, held against Terzaghi's series",
    "vertical_drain": "clay around a vertical drain, a body of revolution, held against Barron's series",
    "embankment_time": "embankment in two lifts on soft clay, in time: settlement, excess pressure, factors of safety",
    "penetration_rate": "strip footing on clay pushed in a minute, half a year and fifty years, beside undrained and drained",
    "excavation": "pit dug in two slices after the water was lowered",
    "embankment_lifts": "embankment filled in lifts on clay that grows stronger with depth, held against limit analysis",
    "footing_3d": "rough square footing on undrained clay in space, held against limit analysis",
    "slope_3d": "undrained slope between rough valley sides under rising weight, held against limit analysis",
    "landslide_3d": "slope of clay from an elevation grid: factor of safety in space, held against limit analysis",
    "earthquake_slope": "clay slope in an earthquake: displacement of a sliding block and of the soil in motion",
    "landslide_dynamic": "slope of clay that fails and slides until it rests, with inertia",
    "impact": "boulder that falls on clay, digs itself in and rests",
    "column_collapse": "column of dry sand that is let go: motion in time until it rests",
    "block": "block of clay that loses its strength and spreads until it rests",
}

/// The case file of a name; hyphens, underscores and the extension make no difference.
pub fn find(name: &str) -> Option<&'static Shipped> {
    let name = name.trim_end_matches(".toml").replace('-', "_");
    SHIPPED.iter().find(|case| case.name == name)
}

/// The name that comes nearest to one that does not exist.
pub fn nearest(name: &str) -> Option<&'static str> {
    closest(name, SHIPPED.iter().map(|case| case.name))
}

/// The candidate most like a name, if any is alike.
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|&(likeness, _)| likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_file_is_listed_once() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/cases");
        let files: BTreeSet<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        let listed: BTreeSet<String> = SHIPPED
            .iter()
            .map(|case| format!("{}.toml", case.name))
            .collect();
        assert_eq!(files, listed);
        assert_eq!(listed.len(), SHIPPED.len());
    }

    #[test]
    fn every_file_is_valid() {
        for case in SHIPPED {
            if let Err(error) = case.case_file(["igimp=1"]) {
                panic!("{}: {error}", case.name);
            }
        }
    }

    #[test]
    fn names_are_found_and_suggested() {
        assert_eq!(find("slope.toml").map(|case| case.name), Some("slope"));
        assert_eq!(nearest("slop"), Some("slope"));
        assert_eq!(nearest("xyz"), None);
    }
}
