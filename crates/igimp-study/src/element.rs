//! A law on its own: the test, its table, its pictures and its text.

mod closed_form;
mod compared;
mod data;
mod measure;
mod page;
mod path_file;
mod path_words;
mod pictures;
mod stations;
mod table;
mod text;
mod values;

use std::path::Path;

use igimp_figures::CurvePlot;
use igimp_material::{ConstitutiveModel, MaterialError};
use igimp_model::{Drainage, Material};
use igimp_report::ReportError;
use igimp_report::setup::{given_in_words, law_name};
use igimp_results::tables::table::Table;
use igimp_solver::element::{ElementError, ElementPath, ElementRun, ElementTest};
use igimp_text::short;
use thiserror::Error;

pub use compared::{Compared, Off};
pub use data::{Data, DataError, Row, parse_data, read_data};
pub use igimp_solver::element::{Kinematics, StandardTest};
pub use measure::Measure;
pub(crate) use page::pictures;
pub use path_file::{PathFileError, read_path};
use stations::Stations;
pub use table::{name_of, of_name};
use values::KeyValues;

/// Largest natural strain of a test \[-\].
const MOST_STRAIN: f64 = 10.0;

/// The driven test.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// A test of the laboratory, up to a strain \[-\].
    Standard(StandardTest, f64),
    /// A path of one's own.
    Path(ElementPath),
}

/// A test of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The driven test.
    pub drive: Drive,
    /// The initial axial stress and that at the sides, effective \[Pa\], compression positive.
    pub stress: [f64; 2],
    /// Steps of a leg.
    pub steps: usize,
    /// How strain is measured.
    pub kinematics: Kinematics,
    /// How long a leg of the path takes \[s\], for strength that goes with the rate of strain; zero: it takes no time.
    pub duration: f64,
    /// Data of the laboratory, laid over it.
    pub data: Option<Data>,
}

/// A test that was made.
#[derive(Clone, Debug)]
pub struct Tested {
    /// Its states, and why it ended early if it did.
    pub run: ElementRun,
    /// Its table, named `element`.
    pub table: Table,
    /// Its lines, ready to print.
    pub text: String,
    /// The data beside it.
    pub compared: Option<Compared>,
    /// Warnings of the file of its material, ready to print; they stand on the page. Empty at first.
    pub warnings: String,
    request: Request,
    /// As it was driven.
    material: Material,
    /// Whether its strength is that under the stress that the test begins with.
    is_by_stress: bool,
    values: KeyValues,
    title: String,
}

/// Why there is no test.
#[derive(Debug, Error)]
pub enum TestError {
    /// The law cannot be made.
    #[error("the material cannot be made")]
    Material(#[from] MaterialError),
    /// The test cannot begin.
    #[error(transparent)]
    Element(#[from] ElementError),
    /// A value that no test can have.
    #[error("{quantity} is {value}: {bounds}")]
    Value {
        /// The quantity.
        quantity: &'static str,
        /// The value in SI units.
        value: f64,
        /// Its bounds.
        bounds: &'static str,
    },
    /// The data are none of the test.
    #[error(transparent)]
    Data(#[from] DataError),
}

/// Materials among which none, or more than one, is meant.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{problem}")]
pub struct NotChosen {
    /// The problem.
    pub problem: String,
    /// The names that there are.
    pub names: String,
}

/// The material of a name, or the only one.
///
/// # Errors
/// [`NotChosen`] of several without a name, and of a name that there is not.
pub fn chosen<'a>(
    materials: &'a [Material],
    name: Option<&str>,
) -> Result<&'a Material, NotChosen> {
    let found = match (materials, name) {
        ([only], None) => Ok(only),
        (_, None) => Err("the file has several materials".to_owned()),
        (_, Some(name)) => (materials.iter().find(|material| material.name == name))
            .ok_or_else(|| format!("the file has no material \"{name}\"")),
    };
    found.map_err(|problem| {
        let names: Vec<&str> = materials
            .iter()
            .map(|material| material.name.as_str())
            .collect();
        let names = format!("its materials are {}", names.join(", "));
        NotChosen { problem, names }
    })
}

/// Drives a material. An undrained strength that is a share of the vertical effective stress goes by the axial stress that the
/// test begins with; where strength varies else, the greatest counts.
///
/// # Errors
/// [`TestError`]. A test that ends early is a result, and the text says where.
pub fn test(material: &Material, request: &Request) -> Result<Tested, TestError> {
    let by_stress = material.under(request.stress[0]);
    let is_by_stress = by_stress.is_some();
    let material = by_stress.as_ref().unwrap_or(material);
    let law = material.law()?;
    let driven = driven(&*law, request)?;
    let Driven {
        run,
        ways,
        compared,
    } = driven;
    let kind = match &request.drive {
        Drive::Standard(standard, _) => name_of(*standard).replace('-', " "),
        Drive::Path(_) => "path".to_owned(),
    };
    let mut tested = Tested {
        table: table::table(
            (&run.states, &ways),
            &request.drive,
            law.internal_variables(),
        ),
        text: String::new(),
        values: KeyValues::new(material, &*law, request, &run.states),
        run,
        compared,
        warnings: String::new(),
        request: request.clone(),
        title: format!("{}: {}, {kind}", material.name, law_name(material)),
        material: material.clone(),
        is_by_stress,
    };
    tested.text = text::of(&tested);
    Ok(tested)
}

/// A law that was driven, with the ways of its states.
pub(crate) struct Driven {
    pub(crate) run: ElementRun,
    ways: Vec<f64>,
    pub(crate) compared: Option<Compared>,
}

/// Drives a law, with a stop at each measurement.
pub(crate) fn driven(law: &dyn ConstitutiveModel, request: &Request) -> Result<Driven, TestError> {
    request.check()?;
    let [axial, side] = request.stress;
    let sigma = [-side, -axial, -side];
    let path = match &request.drive {
        Drive::Standard(standard, strain) => standard.path(*strain),
        Drive::Path(path) => path.clone(),
    };
    let stops = match &request.data {
        Some(data) => data.ways(&request.drive)?,
        None => Vec::new(),
    };
    let stations = Stations::new(path, &sigma, request.steps, &stops);
    let test = ElementTest {
        sigma,
        path: stations.path.clone(),
        steps: stations.steps,
        kinematics: request.kinematics,
        durations: stations.durations(request.duration),
    };
    let mut run = test.run(law)?;
    run.failure = run.failure.map(|lost| stations.on_path(lost));
    let compared = request.data.as_ref().map(|data| {
        let states: Vec<_> = (stops.iter())
            .map(|way| run.states.get(stations.state_at(*way)))
            .collect();
        Compared::new(data.clone(), &states, &run.states[0], &request.drive)
    });
    Ok(Driven {
        run,
        ways: stations.ways,
        compared,
    })
}

impl Request {
    /// Refuses values that no test can have, as the command line does.
    ///
    /// # Errors
    /// [`TestError::Value`].
    pub fn check(&self) -> Result<(), TestError> {
        let stress = "a stress has a finite value";
        let strain = match self.drive {
            Drive::Standard(_, strain) => strain,
            Drive::Path(_) => 0.0,
        };
        let far = "a strain goes from -10 to 10, which is 1000 %";
        let long = "a test takes a finite time, and no negative one";
        let [axial, side] = self.stress;
        let values = [
            ("the axial stress", axial, axial.is_finite(), stress),
            ("the stress at the sides", side, side.is_finite(), stress),
            ("the strain", strain, strain.abs() <= MOST_STRAIN, far),
            (
                "the duration",
                self.duration,
                (0.0..f64::INFINITY).contains(&self.duration),
                long,
            ),
        ];
        match values.into_iter().find(|(.., holds, _)| !holds) {
            Some((quantity, value, _, bounds)) => Err(TestError::Value {
                quantity,
                value,
                bounds,
            }),
            None => Ok(()),
        }
    }
}

impl Drive {
    /// The same as far as data go, where that is stated by the strain; none where they do not leave the start.
    pub fn up_to(self, data: &Data) -> Option<Self> {
        match self {
            Self::Standard(test, _) => {
                let strain = data.furthest();
                (strain != 0.0).then_some(Self::Standard(test, strain))
            }
            path @ Self::Path(_) => Some(path),
        }
    }
}

impl Tested {
    /// Measured and computed values, and their difference: a table named `data`, if there are data.
    pub fn data_table(&self) -> Option<Table> {
        Some(self.compared.as_ref()?.table(&self.request.drive))
    }

    /// The picture of computed less measured over scales of the columns, in SI; none without data.
    pub fn residuals(&self, scales: &[f64]) -> Option<CurvePlot> {
        let compared = self.compared.as_ref()?;
        Some(pictures::residuals(
            compared,
            &self.request.drive,
            &self.title,
            scales,
        ))
    }

    /// Writes `element.csv`, `data.csv` where there are data, the pictures, and all of it as `report.html` into a folder that exists;
    /// their names.
    ///
    /// # Errors
    /// [`ReportError`] of a file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<Vec<String>, ReportError> {
        let files = self.write_parts(folder)?;
        page::page(self).write(folder)?;
        Ok(["report.html".to_owned()]
            .into_iter()
            .chain(files)
            .collect())
    }

    /// Writes all but the page.
    pub(crate) fn write_parts(&self, folder: &Path) -> Result<Vec<String>, ReportError> {
        self.table.write_csv(folder)?;
        let mut names = vec!["element.csv".to_owned()];
        if let Some(table) = self.data_table() {
            table.write_csv(folder)?;
            names.push("data.csv".to_owned());
        }
        for (name, plot) in self.plots() {
            plot.write(&folder.join(&name))?;
            names.extend(["svg", "png"].map(|kind| format!("{name}.{kind}")));
        }
        Ok(names)
    }

    /// The pictures by the names of their files.
    fn plots(&self) -> Vec<(String, CurvePlot)> {
        let compared = self.compared.as_ref();
        let drive = &self.request.drive;
        pictures::plots(&self.run.states, drive, &self.title, compared)
    }

    /// Notes on the material that hold in its case and not in the test.
    fn notes(&self) -> Vec<String> {
        let cu = short(self.material.cohesive() / 1e3);
        let by_stress = format!("{} {cu} kPa", text::BY_STRESS);
        let by_stress = self.is_by_stress.then_some(by_stress);
        let varies = (self.material.varies()).then(|| text::VARIES.to_owned());
        let is_undrained = matches!(self.material.drainage, Drainage::Undrained { .. });
        let undrained = is_undrained.then(|| text::UNDRAINED.to_owned());
        let given = given_in_words(&self.material);
        let given = given.map(|words| format!("{} {words}", text::GIVEN));
        let is_timed = self.request.duration > 0.0 && self.material.given.is_none();
        let is_timeless = is_timed && !self.material.goes_with_rate();
        let timeless = is_timeless.then(|| text::TIMELESS.to_owned());
        let notes = given.into_iter().chain(by_stress).chain(varies);
        notes.chain(undrained).chain(timeless).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_input::MaterialsFile;
    use igimp_solver::element::Control::{AsXx, Strain, Stress};

    /// GOAL: clay whose strength is a share of the vertical stress fails by the stress that its test begins with, in a file of materials
    /// alone. ORACLE: q = 2 S σ_v OCR^m in plane strain and compression with Tresca, and no less than 2 s_u,min.
    #[test]
    fn a_share_of_the_stress_goes_by_that_of_the_test() {
        let file = "igimp = 1\n[materials.clay]\nmodel = \"tresca\"\nunit_weight = \"18 kN/m3\"\nyoung = \"30 MPa\"\n\
            poisson = 0.49\ncu = { ratio = 0.22, ocr = 2.0, exponent = 0.8, at_least = \"5 kPa\" }\n";
        let file = MaterialsFile::parse("clay.toml", file, &[]).unwrap();
        for stress in [10e3, 50e3, 400e3] {
            let request = Request {
                drive: Drive::Standard(StandardTest::TriaxialUndrained, 0.05),
                stress: [stress; 2],
                steps: 50,
                kinematics: Kinematics::Small,
                duration: 0.0,
                data: None,
            };
            let tested = test(&file.materials[0], &request).unwrap();
            let sigma = &tested.run.states.last().unwrap().sigma;
            let q = (sigma[1][1] - sigma[0][0]).abs();
            let exact = 2.0 * (0.22 * stress * 2.0_f64.powf(0.8)).max(5e3);
            assert!((q / exact - 1.0).abs() < 1e-6, "{q} of {exact}");
            assert!(tested.text.contains("cu by the vertical stress"));
        }
    }

    const SOILS: &str = "igimp = 1\n[materials.clay]\nmodel = \"modified-cam-clay\"\nunit_weight = \"16 kN/m3\"\n\
        lambda = 0.1\nkappa = 0.02\ncritical_ratio = 1.0\npoisson = 0.2\nocr = 2.0\n[materials.sand]\nmodel = \"mohr-coulomb\"\n\
        unit_weight = \"18 kN/m3\"\nyoung = \"30 MPa\"\npoisson = 0.3\ncohesion = \"5 kPa\"\nfriction = \"30 deg\"\n\
        [materials.stiff]\nmodel = \"tresca\"\nunit_weight = \"18 kN/m3\"\nyoung = \"30 MPa\"\npoisson = 0.3\ncu = \"50 kPa\"\n\
        [materials.cone]\nmodel = \"drucker-prager\"\nunit_weight = \"18 kN/m3\"\nyoung = \"30 MPa\"\npoisson = 0.3\n\
        cohesion = \"5 kPa\"\nfriction = \"30 deg\"\ncone = \"compression\"\n\
        [materials.round]\nmodel = \"von-mises\"\nunit_weight = \"18 kN/m3\"\nyoung = \"30 MPa\"\npoisson = 0.3\ncu = \"50 kPa\"\n\
        [materials.rock]\nmodel = \"hoek-brown\"\nunit_weight = \"25 kN/m3\"\nyoung = \"1 GPa\"\npoisson = 0.3\n\
        sci = \"30 MPa\"\ngsi = 20.0\nmi = 8.0\n";

    /// GOAL: where a formula is printed, the test ends on it: 0.1 %, with natural and with linear strain. ORACLE: eq. 92 and the closed
    /// forms of perfectly plastic soil.
    #[test]
    fn tests_end_on_the_formulas_that_are_printed() {
        let materials = MaterialsFile::parse("soils.toml", SOILS, &[])
            .unwrap()
            .materials;
        let mut count = 0;
        for material in &materials {
            for standard in StandardTest::ALL {
                for kinematics in [Kinematics::Finite, Kinematics::Small] {
                    let strain = if material.name == "clay" { 1.5 } else { 0.1 };
                    let request = Request {
                        drive: Drive::Standard(standard, strain),
                        stress: [100e3, 80e3],
                        steps: 300,
                        kinematics,
                        duration: 0.0,
                        data: None,
                    };
                    let tested = test(material, &request).unwrap();
                    assert!(tested.run.failure.is_none(), "{}", tested.text);
                    let end = tested.run.states.last().unwrap();
                    let form = closed_form::strength(material, standard, &request, end);
                    let Some(form) = form else { continue };
                    let measured = if standard.is_shear() {
                        end.sigma[0][1]
                    } else {
                        end.q()
                    };
                    assert!(
                        (measured / form.value - 1.0).abs() < 1e-3,
                        "{}",
                        tested.text
                    );
                    assert!(
                        tested.text.contains("closed form at failure"),
                        "{}",
                        tested.text
                    );
                    count += 1;
                }
            }
        }
        assert_eq!(count, 30);
    }

    fn sheared(drive: f64) -> Request {
        Request {
            drive: Drive::Standard(StandardTest::TriaxialDrained, drive),
            stress: [100e3; 2],
            steps: 20,
            kinematics: Kinematics::Small,
            duration: 0.0,
            data: None,
        }
    }

    fn soils() -> Vec<Material> {
        MaterialsFile::parse("soils.toml", SOILS, &[])
            .unwrap()
            .materials
    }

    /// GOAL: values that no test can have are refused, whoever asks. CASE: strains, stresses and durations that are not finite, too large
    /// or negative. ORACLE: the bounds of the command line.
    #[test]
    fn values_that_no_test_can_have_are_refused() {
        let sand = &soils()[1];
        let refused = |request: Request| test(sand, &request).unwrap_err().to_string();
        for strain in [f64::NAN, f64::INFINITY, 20.0, -20.0] {
            let text = refused(sheared(strain));
            assert_eq!(
                text,
                format!("the strain is {strain}: a strain goes from -10 to 10, which is 1000 %")
            );
        }
        let stress = |stress| Request {
            stress,
            ..sheared(0.1)
        };
        for (stresses, whose) in [([f64::NAN, 1e5], "axial"), ([1e5, f64::INFINITY], "sides")] {
            let text = refused(stress(stresses));
            assert!(text.contains(whose), "{text}");
        }
        for duration in [f64::NAN, f64::INFINITY, -1.0] {
            let text = refused(Request {
                duration,
                ..sheared(0.1)
            });
            assert!(text.starts_with("the duration is "), "{text}");
        }
        assert!(test(sand, &sheared(0.1)).is_ok());
    }

    /// GOAL: a duration without effect is named, and one with effect is not; so is strength that snaps back where a test ends early.
    /// ORACLE: the laws; soil with these curves is followed where all strains but one are driven.
    #[test]
    fn a_duration_without_effect_and_brittle_soil_are_printed() {
        let clay = "igimp = 1\n[materials.clay]\nmodel = \"tresca\"\nunit_weight = \"18 kN/m3\"\nyoung = \"30 MPa\"\n\
            poisson = 0.49\ncu = \"50 kPa\"\n";
        let rate = format!("{clay}rate = {{ per_log_cycle = 0.1, reference = \"1 %/h\" }}\n");
        let printed = |text: &str| -> String {
            let file = MaterialsFile::parse("clay.toml", text, &[]).unwrap();
            let request = Request {
                duration: 10.0,
                ..sheared(0.05)
            };
            test(&file.materials[0], &request).unwrap().text
        };
        assert!(printed(clay).contains("the duration has no effect"));
        assert!(!printed(&rate).contains("no effect"), "{}", printed(&rate));
        let brittle = "igimp = 1\n[materials.sand]\nmodel = \"mohr-coulomb\"\nunit_weight = \"18 kN/m3\"\nyoung = \"20 MPa\"\n\
            poisson = 0.3\ncohesion = \"20 kPa\"\nfriction = \"30 deg\"\nsoftening = { cohesion = { residual = 0.1, strain = 0.002 } }\n";
        let sand = &MaterialsFile::parse("sand.toml", brittle, &[])
            .unwrap()
            .materials[0];
        for (standard, is_brittle) in [
            (StandardTest::TriaxialDrained, true),
            (StandardTest::SimpleShearDrained, false),
        ] {
            let request = Request {
                drive: Drive::Standard(standard, 0.05),
                steps: 200,
                ..sheared(0.05)
            };
            let tested = test(sand, &request).unwrap();
            assert_eq!(tested.run.failure.is_some(), is_brittle, "{}", tested.text);
            assert_eq!(
                tested.text.contains("can snap back"),
                is_brittle,
                "{}",
                tested.text
            );
        }
    }

    /// GOAL: of a law that takes the place of that of the file its name and its words are printed, and no formula of the other.
    /// CASE: sand that is given the law of the clay with c_u = 50 kPa. ORACLE: q = 2 c_u of Tresca.
    #[test]
    fn a_given_law_is_named() {
        let all = soils();
        let law = all[2].law().unwrap();
        let sand = Material {
            given: Some(igimp_model::GivenLaw(std::sync::Arc::clone(&law))),
            ..all[1].clone()
        };
        let tested = test(&sand, &sheared(0.1)).unwrap();
        let q = tested.run.states.last().unwrap().q();
        assert!((q / 100e3 - 1.0).abs() < 1e-3, "{q}");
        let text = &tested.text;
        let title = format!("sand: {}, triaxial drained\n", law.name());
        assert!(text.starts_with(&title), "{text}");
        assert!(text.contains(text::GIVEN), "{text}");
        assert!(!text.contains("closed form"), "{text}");
        assert!(
            test(&all[1], &sheared(0.1))
                .unwrap()
                .text
                .contains("closed form")
        );
    }

    /// GOAL: a path from a file has compression positive; what is no path is refused with a remedy.
    #[test]
    fn paths_come_from_files() {
        let path = std::env::temp_dir().join(format!("igimp-path-{}.csv", std::process::id()));
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read_path(&path)
        };
        let parsed = read("stress_xx [kPa],strain_yy [%],strain_xy [-]\n50,2,0.1\n").unwrap();
        assert_eq!(parsed.controls, [Stress, Strain, AsXx, Strain]);
        assert_eq!(parsed.legs, [[-50e3, -0.02, 0.0, 0.1]]);
        let refused = |text: &str| read(text).unwrap_err().to_string();
        assert_eq!(
            refused("strain_xx [%]\n1\n"),
            "`yy` has to be prescribed once, as a strain or as a stress"
        );
        assert_eq!(
            refused("stress_xx [m]\n1\n"),
            "`stress_xx [m]` is no column of a path"
        );
        assert_eq!(
            refused("strain_xx [%],strain_yy [%]\n"),
            "the path has no row"
        );
        let twice = refused("strain_xx [%],stress_xx [Pa],strain_yy [%]\n1,1,1\n");
        assert!(twice.starts_with("`xx`"), "{twice}");
        std::fs::remove_file(&path).unwrap();
    }
}
