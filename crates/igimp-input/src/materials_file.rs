//! Reads the materials of a case file, or of a file that holds materials alone.

use std::path::Path;

use igimp_model::Material;
use igimp_schema::complete::complete_materials;
use igimp_schema::diagnostic::Problems;
use igimp_schema::overrides::apply;
use igimp_schema::source::Source;
use igimp_schema::syntax::parse;
use igimp_schema::tree::Node;

use crate::build::materials_alone;
use crate::read::{CaseFile, InputError, invalid, text_of};

/// Materials, and what was warned of.
#[derive(Clone, Debug)]
pub struct MaterialsFile {
    /// The materials in the order of the file.
    pub materials: Vec<Material>,
    /// Warnings, ready to print; empty when there are none.
    pub warnings: String,
    /// The tree of the file, with the overrides.
    tree: Node,
    /// Name and text of the file, and the overrides.
    origin: (String, String, Vec<String>),
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
        let origin = (name.to_owned(), text.to_owned(), overrides.to_vec());
        let is_case = OF_CASES.iter().any(|key| tree.get(key).is_some());
        for text in overrides {
            sources.push(Source::new("command line", text, true));
        }
        for index in 1..sources.len() {
            apply(&mut tree, &sources, index, &mut problems);
        }
        if is_case {
            let file = CaseFile::parse(name, text, overrides)?;
            return Ok(Self {
                materials: file.any_case().materials().to_vec(),
                warnings: file.warnings(),
                tree,
                origin,
            });
        }
        let mut completed = complete_materials(&tree, &sources, &mut problems);
        match materials_alone(&mut completed, &mut problems) {
            Some(materials) if problems.errors() == 0 => Ok(Self {
                materials,
                warnings: problems.render(&sources),
                tree,
                origin,
            }),
            _ => Err(invalid(&problems, &sources)),
        }
    }

    /// The same file with more overrides.
    ///
    /// # Errors
    /// [`InputError::Invalid`].
    pub fn with(&self, more: Vec<String>) -> Result<Self, InputError> {
        let (name, text, overrides) = &self.origin;
        let overrides: Vec<String> = overrides.iter().cloned().chain(more).collect();
        Self::parse(name, text, &overrides)
    }

    /// The written value of a key of a material, such as `softening.cu.residual`: a quantity as text, or a number. Nothing of tables and
    /// lists, and of keys that are left out.
    pub fn written(&self, material: &str, key: &str) -> Option<String> {
        let root = self.tree.get("materials")?.get(material)?;
        let node = key.split('.').try_fold(root, |table, key| table.get(key))?;
        let number = || node.number().map(|number| number.to_string());
        node.text().map(str::to_owned).or_else(number)
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
        refused(
            "materials.clay.ocr=0.5",
            "`ocr` must be 1 or more, but is 0.5",
        );
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

    const SAND: &str = "igimp = 1\n[materials.sand]\nmodel = \"mohr-coulomb\"\nyoung = \"20 MPa\"\npoisson = 0.3\n\
                        cohesion = \"5 kPa\"\nfriction = \"35 deg\"\ndilation = \"8 deg\"\nunit_weight = \"18 kN/m3\"\n\
                        softening = { friction = { residual = \"30 deg\", strain = 0.1 }, \
                        dilation = { residual = \"0 deg\", strain = 0.1, curve = \"linear\" } }\n";

    /// GOAL: curves over plastic strain are read with their keys, and what makes no curve is refused with a remedy.
    #[test]
    fn strengths_soften_along_their_curves() {
        let file = MaterialsFile::parse("sand.toml", SAND, &[]).unwrap();
        let curves = file.materials[0].softening.unwrap();
        let dilation = curves.dilation.unwrap();
        assert!(curves.cohesive.is_none() && curves.band_width.is_none());
        assert!(dilation.residual.abs() < 1e-15 && (dilation.strain - 0.1).abs() < 1e-15);
        assert!((curves.friction.unwrap().residual - 30_f64.to_radians()).abs() < 1e-12);
        assert_eq!(
            file.materials[0].law().unwrap().name(),
            "softening Mohr-Coulomb"
        );
        let refused = |set: &str, words: &str| {
            let error = MaterialsFile::parse("sand.toml", SAND, &[set.to_owned()]).unwrap_err();
            assert!(error.to_string().contains(words), "{error}");
        };
        refused("materials.sand.flow=davis", "does not go with `softening`");
        refused(
            "materials.sand.softening={ band_width = \"1 m\" }",
            "nothing of `sand` softens",
        );
        refused("materials.sand.softening.friction.strain=0.0", "strain");
        refused(
            "materials.sand.softening.friction.residual=89.5 deg",
            "a residual friction angle",
        );
        refused("materials.sand.softening.length=-1 m", "length");
        refused(
            "materials.sand.softening={ friction = { residual = \"30 deg\", strain = 0.1 }, length = \"1 m\", band_width = \"1 m\" }",
            "`length` and `band_width` do not go together",
        );
        refused(
            "materials.sand.softening.over_nonlocal=2",
            "`over_nonlocal` is stated without a `length`",
        );
        refused(
            "materials.sand.softening={ friction = { residual = \"30 deg\", strain = 0.1 }, length = \"1 m\", over_nonlocal = 1 }",
            "slip gathers in one row of cells",
        );
        refused(
            "materials.sand.softening={ friction = { residual = \"36 deg\", strain = 0.1 }, length = \"1 m\" }",
            "strength that hardens needs no `length`",
        );
        let seeing = ["materials.sand.softening.length=0.3 m".to_owned()];
        let file = MaterialsFile::parse("sand.toml", SAND, &seeing).unwrap();
        let nonlocal = file.materials[0].softening.unwrap().nonlocal.unwrap();
        assert!(
            (nonlocal.length - 0.3).abs() < 1e-15 && (nonlocal.over_nonlocal - 2.0).abs() < 1e-15
        );
        let clay = "igimp = 1\n[materials.clay]\nmodel = \"tresca\"\nyoung = \"20 MPa\"\npoisson = 0.3\ncu = \"50 kPa\"\n\
                    unit_weight = \"18 kN/m3\"\nsoftening = { cu = { residual = RESIDUAL, strain = STRAIN } }\n";
        let refused = |residual: &str, strain: &str, words: &str| {
            let text = clay.replace("RESIDUAL", residual).replace("STRAIN", strain);
            let error = MaterialsFile::parse("clay.toml", &text, &[]).unwrap_err();
            assert!(error.to_string().contains(words), "{error}");
        };
        let steep = "igimp = 1\n[materials.clay]\nmodel = \"modified-cam-clay\"\nunit_weight = \"16 kN/m3\"\nlambda = 0.1\n\
                     kappa = 0.02\npoisson = 0.2\ncritical_ratio = RATIO\n";
        let clay_of =
            |ratio: &str| MaterialsFile::parse("clay.toml", &steep.replace("RATIO", ratio), &[]);
        clay_of("2.9").unwrap();
        for ratio in ["3.0", "4.0"] {
            let error = clay_of(ratio).unwrap_err().to_string();
            assert!(
                error.contains("`critical_ratio` must be below 3, but is "),
                "{error}"
            );
        }
        refused("0.0", "0.1", "soil by total stress has no strength left");
        // c_u falls by 50 kPa × 0.9 over 0.003: 15 MPa, and 3/2 G is 11.5 MPa.
        refused("0.1", "0.003", "snaps back within the point");
    }
}
