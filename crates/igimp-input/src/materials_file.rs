//! Reads the materials of a case file, or of a file that holds materials alone.

use std::path::Path;

use igimp_model::Material;
use igimp_schema::complete::complete_materials;
use igimp_schema::diagnostic::Problems;
use igimp_schema::overrides::apply;
use igimp_schema::source::Source;
use igimp_schema::syntax::parse;

use crate::build::materials_alone;
use crate::read::{CaseFile, InputError, invalid, text_of};

/// Materials, and what was warned of.
#[derive(Clone, Debug)]
pub struct MaterialsFile {
    /// The materials in the order of the file.
    pub materials: Vec<Material>,
    /// Warnings, ready to print; empty when there are none.
    pub warnings: String,
}

/// Keys of a case: a file with one of them is read as a whole.
const OF_CASES: [&str; 4] = ["case", "grid", "bodies", "stages"];

impl MaterialsFile {
    /// Reads a file, changed by overrides such as `materials.clay.cu=40 kPa`.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, InputError> {
        Self::parse(&path.display().to_string(), &text_of(path)?, overrides)
    }

    /// Parses the text of a file of this name.
    ///
    /// # Errors
    /// [`InputError::Invalid`].
    pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Self, InputError> {
        let mut problems = Problems::default();
        let mut sources = vec![Source::new(name, text, false)];
        let mut tree = parse(&sources[0], &mut problems);
        if problems.errors() > 0 {
            return Err(invalid(&problems, &sources));
        }
        if OF_CASES.iter().any(|key| tree.get(key).is_some()) {
            let file = CaseFile::parse(name, text, overrides)?;
            return Ok(Self {
                materials: file.any_case().materials().to_vec(),
                warnings: file.warnings(),
            });
        }
        for text in overrides {
            sources.push(Source::new("command line", text, true));
        }
        for index in 1..sources.len() {
            apply(&mut tree, &sources, index, &mut problems);
        }
        let mut completed = complete_materials(&tree, &sources, &mut problems);
        match materials_alone(&mut completed, &mut problems) {
            Some(materials) if problems.errors() == 0 => Ok(Self {
                materials,
                warnings: problems.render(&sources),
            }),
            _ => Err(invalid(&problems, &sources)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLAY: &str = "igimp = 1\n[materials.clay]\nmodel = \"modified-cam-clay\"\nlambda = 0.2\nkappa = 0.04\n\
                        void_ratio = 1.0\nfriction = \"25 deg\"\npoisson = 0.25\nunit_weight = \"16 kN/m3\"\n";

    /// GOAL: materials alone are read as those of a case are, with messages that name place and remedy.
    #[test]
    fn materials_stand_alone() {
        let file = MaterialsFile::parse("clay.toml", CLAY, &[]).unwrap();
        let clay = &file.materials[0];
        assert_eq!(
            (clay.name.as_str(), clay.strength.name()),
            ("clay", "modified Cam-clay")
        );
        // λ/(1 + e) = 0.1, κ/(1 + e) = 0.02: K = p/κ* at the reference pressure of 100 kPa.
        let bulk = clay.young / (3.0 * (1.0 - 2.0 * clay.poisson));
        assert!((bulk / 5e6 - 1.0).abs() < 1e-12 && (clay.poisson - 0.25).abs() < 1e-12);
        let refused = |set: &str, words: &str| {
            let error = MaterialsFile::parse("clay.toml", CLAY, &[set.to_owned()]).unwrap_err();
            assert!(error.to_string().contains(words), "{error}");
        };
        refused(
            "materials.clay.kappa=0.3",
            "`kappa` has to be smaller than `lambda`",
        );
        refused("materials.clay.ocr=0.5", "`ocr` is 1 or more");
        refused(
            "materials.clay.critical_ratio=1.0",
            "both `friction` and `critical_ratio` are given",
        );
        refused(
            "materials.clay.shear=2 MPa",
            "both `poisson` and `shear` are given",
        );
        refused("materials.clay.young=2 MPa", "unknown field `young`");
        let error = MaterialsFile::parse("none.toml", "igimp = 1\n", &[]).unwrap_err();
        assert!(
            error.to_string().contains("missing table [materials.NAME]"),
            "{error}"
        );
    }
}
