//! GOAL: soil remembers its loads when a stage makes its body of another material, as far as the law can; losses are named.
//! CASE: a column under a stiff cap, loaded to 400 kPa, unloaded to 100, swapped or not, and loaded again.
//! ORACLE: a material that is the same, or says another `ocr` alone, changes nothing.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

const HARDENING: &str = "model = \"hardening-soil\"\ncohesion = \"5 kPa\"\nfriction = \"34 deg\"\ndilation = \"4 deg\"\n\
    e50 = \"20 MPa\"\neur = \"60 MPa\"\neoed = \"20 MPa\"\npower = 0.6\nocr = 1.5\n";
const CLAY: &str = "model = \"modified-cam-clay\"\nlambda = 0.1\nkappa = 0.02\ncritical_ratio = 1.0\npoisson = 0.2\nocr = 1.5\n";
const SOFTENING: &str = "model = \"tresca\"\nyoung = \"10 MPa\"\npoisson = 0.3\ncu = \"60 kPa\"\n\
    softening = { cu = { residual = 0.5, strain = 0.02 } }\n";
const SPREAD: &str = "model = \"tresca\"\nyoung = \"10 MPa\"\npoisson = 0.3\ncu = \"60 kPa\"\n\
    softening = { cu = { residual = 0.5, strain = 0.02 }, length = \"1 m\" }\n";
const ELASTIC: &str = "model = \"elastic\"\nyoung = \"10 MPa\"\npoisson = 0.3\n";

fn text(soil: &str, other: &str, stages: &str) -> String {
    let common = "unit_weight = \"0.001 kN/m3\"\nk0 = 0.6\n";
    format!(
        "igimp = 1\n[case]\ntitle = \"column\"\n[grid]\ncell = \"0.5 m\"\ndomain = {{ x = [\"0 m\", \"1 m\"], y = [\"0 m\", \"4 m\"] }}\n\
        kinematics = \"small\"\n[materials.m]\n{common}{soil}[materials.m2]\n{common}{other}\
        [materials.cap]\nmodel = \"elastic\"\nunit_weight = \"100 kN/m3\"\nyoung = \"100 MPa\"\npoisson = 0.0\nk0 = 0.5\n\
        [[bodies]]\nname = \"b\"\nmaterial = \"m\"\npolygon = [[\"0 m\",\"0 m\"],[\"1 m\",\"0 m\"],[\"1 m\",\"2 m\"],[\"0 m\",\"2 m\"]]\n\
        [[bodies]]\nname = \"cap\"\nmaterial = \"cap\"\npolygon = [[\"0 m\",\"2 m\"],[\"1 m\",\"2 m\"],[\"1 m\",\"3 m\"],[\"0 m\",\"3 m\"]]\n\
        [boundaries]\nleft = \"roller\"\nright = \"roller\"\nbottom = \"fixed\"\n\
        [[loads]]\nname = \"p\"\ntype = \"pressure\"\nfrom = [\"0 m\",\"3 m\"]\nto = [\"1 m\",\"3 m\"]\npressure = \"100 kPa\"\n\
        [[stages]]\nname = \"rest\"\ntype = \"k0\"\nsteps = 1\n{stages}"
    )
}

fn load(name: &str, factor: u32) -> String {
    format!(
        "[[stages]]\nname = \"{name}\"\ntype = \"load\"\nload = \"p\"\nfactor = {factor}\nsteps = 10\ngeometry = \"given\"\n"
    )
}

fn swap() -> String {
    "[[stages]]\nname = \"swap\"\ntype = \"construction\"\nmaterials = [{ body = \"b\", material = \"m2\" }]\nsteps = 1\ngeometry = \"given\"\n"
        .to_owned()
}

fn stages(between: &str) -> String {
    [
        load("up", 3).as_str(),
        &load("down", 0),
        between,
        &load("again", 5),
    ]
    .concat()
}

fn file(text: &str) -> CaseFile {
    CaseFile::parse("column.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn run(text: &str) -> Run<2> {
    let run = in_memory(file(text).case()).unwrap();
    assert!(run.failure.is_none());
    run
}

/// Largest difference of displacements over the largest displacement.
fn apart(a: &Run<2>, b: &Run<2>) -> f64 {
    let both = std::iter::zip(
        &a.body.particles.displacement,
        &b.body.particles.displacement,
    );
    let most = (a.body.particles.displacement.iter()).fold(0.0_f64, |most, u| most.max(u[1].abs()));
    both.fold(0.0_f64, |worst, (a, b)| worst.max((a[1] - b[1]).abs())) / most
}

/// BAND: the tolerance of equilibrium, 1e-8 of displacements; settlements differed by a third. Without a word.
#[test]
fn soil_that_comes_to_a_material_like_its_own_goes_on_as_it_was() {
    for (soil, other) in [
        (HARDENING, HARDENING.to_owned()),
        (HARDENING, HARDENING.replace("ocr = 1.5", "ocr = 3")),
        (CLAY, CLAY.to_owned()),
        (CLAY, CLAY.replace("ocr = 1.5", "ocr = 3")),
        (SOFTENING, SOFTENING.to_owned()),
        // Poisson's ratio by its last digits: the same soil, and not the same material.
        (SOFTENING, SOFTENING.replace("0.3\n", "0.300000001\n")),
        (SPREAD, SPREAD.to_owned()),
        (SPREAD, SPREAD.replace("0.3\n", "0.300000001\n")),
    ] {
        let kept = run(&text(soil, &other, &stages("")));
        let swapped = run(&text(soil, &other, &stages(&swap())));
        let off = apart(&kept, &swapped);
        println!("{}: {off:.1e}", soil.lines().next().unwrap());
        assert!(off < 1e-8, "{off:e} {other}");
    }
}

/// The warnings of a swap. ORACLE: the variables of the laws.
#[test]
fn a_swap_names_its_losses() {
    let warnings = |soil: &str, other: &str| -> String {
        file(&text(soil, other, &stages(&swap()))).warnings()
    };
    let lost = "stage `swap` makes `b` of `m2`: ";
    for (soil, other, words) in [
        (
            HARDENING,
            ELASTIC,
            "the plastic shear strain and the preconsolidation pressure that it has by `m` are lost",
        ),
        (
            HARDENING,
            CLAY,
            "the plastic shear strain that it has by `m` is lost",
        ),
        (
            CLAY,
            ELASTIC,
            "the preconsolidation pressure that it has by `m` is lost",
        ),
        (
            SOFTENING,
            ELASTIC,
            "the softening strain that it has by `m` is lost",
        ),
        (
            SPREAD,
            SOFTENING,
            "the nonlocal strain that it has by `m` is lost",
        ),
    ] {
        let found = warnings(soil, other);
        assert!(found.contains(&format!("{lost}{words}")), "{found}");
    }
    for (soil, other) in [(ELASTIC, CLAY), (CLAY, HARDENING), (SOFTENING, SPREAD)] {
        let found = warnings(soil, other);
        assert!(!found.contains("lost"), "{found}");
    }
    let found = warnings(CLAY, &CLAY.replace("ocr = 1.5", "ocr = 3"));
    assert!(
        found.contains(
            "`ocr` of `m2` has no effect on `b`, which keeps its preconsolidation pressure"
        ),
        "{found}"
    );
}

/// Clay that a swap brings has the stresses of the soil that was there: it runs. ORACLE: what elastic ground carries stays.
#[test]
fn clay_that_a_swap_brings_begins_with_the_stress_that_is_there() {
    let swapped = [load("up", 1), swap()].concat();
    let before = run(&text(ELASTIC, CLAY, &load("up", 1)));
    let after = run(&text(ELASTIC, CLAY, &swapped));
    let both = std::iter::zip(&before.body.particles.sigma, &after.body.particles.sigma);
    for (before, after) in both {
        assert!((before[1][1] - after[1][1]).abs() < 1.0, "{after:?}");
    }
}
