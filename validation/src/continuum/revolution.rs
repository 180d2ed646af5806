//! Bodies of revolution: a thick cylinder and a thick sphere that are opened, a cylinder in compression, the factor of safety of
//! one under pressure, and circular footings.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, Method, Particles, Section, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_geometry::seed::fill_polygon;
use igimp_input::CaseFile;
use igimp_material::{Elasticity, VonMises};
use igimp_model::check::Band;
use igimp_shape::Grid;
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use crate::continuum::laboratory::{grid_of, run};
use crate::exact::cylinder::ThickCylinder;
use crate::exact::sphere::ThickSphere;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::interpolate;
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "Bodies of revolution (theory, eqs. 130 to 130e). A thick cylinder and a thick sphere of nearly incompressible clay are opened to one and a half times their bores; without B-bar the sphere locks. A cylinder of soil with friction is pressed together under cell pressure. The factor of safety of a thick cylinder under pressure from within is searched for, of clay and of soil with friction and three angles of dilation. A circular footing on Tresca soil, rough and smooth, has its edge at five places within a cell; on the coarsest cells alone below `--full`, where circles stand on clay that grows stronger with depth too.";
const CYLINDER: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "expanding incompressible thick cylinder, Hencky elasticity",
    locator: "p = ∫ min(4G ln(r/R), 2 s_u) dr/r with r² − R² = a² − a₀²",
};
const SPHERE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "expanding incompressible thick sphere, Hencky elasticity",
    locator: "p = 2 ∫ min(6G ln(r/R), √3 s_u) dr/r with r³ − R³ = a³ − a₀³",
};
const TRIAXIAL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Mohr–Coulomb in triaxial compression",
    locator: "σ₁ = σ₃ (1 + sin φ)/(1 − sin φ) + 2 c cos φ/(1 − sin φ)",
};
const CIRCLE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Shield 1955 (smooth), Eason and Shield 1960 (rough)",
    locator: "slip lines around a circle: N = 5.690 and 6.048",
};

const GROWTH: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "kinematic limit analysis of a circle, six-node triangles",
    locator: "q/c₀ from above, less the 0.6 % by which it is above the exact values without growth",
};
const COLLAPSE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "thick cylinder at collapse, Tresca and Mohr–Coulomb",
    locator: "p = 2 c ln(b/a); p = c cot φ [(b/a)^(1 − 1/N) − 1], N = (1 + sin φ)/(1 − sin φ); both with c/F and tan φ/F",
};

/// Young's modulus over strength of the thick bodies is 300, and they are nearly incompressible.
const SHEAR: f64 = 100.0;
const POISSON: f64 = 0.4999;
/// Radii of bore and outside \[length\].
const RADII: [f64; 2] = [1.0, 2.0];
/// The bore at the end \[length\].
const OPENED: f64 = 1.5;
/// Nodes up to this far beyond the wall of the bore are moved with it \[cells\].
const WALL: f64 = 0.25;
/// Corners of the polygon along a quarter of a circle.
const ARC: usize = 200;
/// Growth of strength over a diameter, over that at the surface, with cells over the radius, as mechanisms get shallow, and q/c₀ of rough
/// and of smooth circles \[-\].
const GROWING: [(f64, f64, [f64; 2]); 2] =
    [(2.0, 9.5, [7.634, 6.724]), (6.0, 17.5, [9.777, 8.271])];
/// Cells over the radius of footings: the edge at 0, ¼, ½, ¾ and 0.9 of a cell.
const EDGES: [f64; 5] = [9.0, 9.25, 9.5, 9.75, 9.9];

/// A thick body that is opened from within.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Thick {
    Cylinder,
    Sphere,
}

impl Thick {
    fn name(self) -> &'static str {
        match self {
            Self::Cylinder => "cylinder",
            Self::Sphere => "sphere",
        }
    }

    fn oracle(self) -> Oracle {
        match self {
            Self::Cylinder => CYLINDER,
            Self::Sphere => SPHERE,
        }
    }

    /// The pressure within at a radius of the bore, over the undrained strength in plane strain \[-\]: in a sphere soil of von Mises is
    /// compressed as in a triaxial test, with √3/2 of it.
    fn exact(self, bore: f64) -> f64 {
        let ([inner, outer], shear) = (RADII, SHEAR);
        match self {
            Self::Cylinder => ThickCylinder {
                inner,
                outer,
                shear,
                strength: 1.0,
            }
            .pressure(bore),
            Self::Sphere => ThickSphere {
                inner,
                outer,
                shear,
                strength: 0.75_f64.sqrt(),
            }
            .pressure(bore),
        }
    }

    /// The exponent n with which volumes go with the radius.
    fn power(self) -> i32 {
        match self {
            Self::Cylinder => 2,
            Self::Sphere => 3,
        }
    }

    /// Distance of a place in the section from the axis or the middle.
    fn distance(self, x: [f64; 2]) -> f64 {
        match self {
            Self::Cylinder => x[0],
            Self::Sphere => x[0].hypot(x[1]),
        }
    }

    /// The section: a strip of a cell, or a quarter of a ring.
    fn polygon(self, cell: f64) -> Vec<[f64; 2]> {
        let [inner, outer] = RADII;
        if self == Self::Cylinder {
            return vec![[inner, 0.0], [outer, 0.0], [outer, cell], [inner, cell]];
        }
        let at = |radius: f64, k: usize| {
            let (sine, cosine) = (0.5 * PI * k as f64 / ARC as f64).sin_cos();
            [cosine, sine].map(|c| if c < 1e-12 { 0.0 } else { radius * c })
        };
        let outside = (0..=ARC).map(|k| at(outer, k));
        outside
            .chain((0..=ARC).rev().map(|k| at(inner, k)))
            .collect()
    }

    /// The exact motion of the nodes within the bore and next to its wall; between smooth ends.
    fn driven(
        self,
        grid: &Grid<2>,
        cell: f64,
        [from, to]: [f64; 2],
    ) -> Result<Constraints<2>, AssemblyError> {
        let mut constraints = Constraints::free(grid);
        constraints.fix_wall(grid, 0, false, 0)?;
        let n = self.power();
        let added = to.powi(n) - from.powi(n);
        for node in 0..grid.node_count() {
            let x = grid.node_position(node);
            if x[1] == 0.0 || self == Self::Cylinder {
                constraints.prescribe(node, 1, 0.0)?;
            }
            let r = self.distance(x);
            if r > 0.0 && r <= from + WALL * cell {
                let stretch = (r.powi(n) + added).powf(1.0 / f64::from(n)) / r - 1.0;
                constraints.prescribe(node, 0, stretch * x[0])?;
                if self == Self::Sphere {
                    constraints.prescribe(node, 1, stretch * x[1])?;
                }
            }
        }
        Ok(constraints)
    }

    /// The pressure within that does the work of the reactions on the motion v = x/rⁿ, which keeps the volume: over a cell's
    /// height `Σ R·v = 2π h p`, over half a sphere `2π p`.
    fn pressure(self, accepted: &Accepted<'_, 2>, cell: f64) -> f64 {
        let grid = &accepted.conditions.grid;
        let mut work = 0.0;
        for (node, reaction) in accepted.forces.reactions.iter().enumerate() {
            let (x, u) = (grid.node_position(node), accepted.forces.u[node]);
            let now = [x[0] + u[0], x[1] + u[1]];
            let r = self.distance(now);
            if r > 0.0 {
                let along = match self {
                    Self::Cylinder => reaction[0] * now[0],
                    Self::Sphere => reaction[0] * now[0] + reaction[1] * now[1],
                };
                work += along / r.powi(self.power());
            }
        }
        match self {
            Self::Cylinder => work / (TAU * cell),
            Self::Sphere => work / TAU,
        }
    }

    /// Opens it on `cells` cells along the bore; the curve has the bore and the pressure over the strength.
    fn opened(self, cells: usize, method: Method) -> Result<(RunRecord, Vec<[f64; 2]>), CaseError> {
        let variant = format!("{} {}, a₀/h = {cells}", method.label(), self.name());
        let method = Method {
            section: Section::Axisymmetric,
            ..method
        };
        let cell = RADII[0] / cells as f64;
        let reach = (3.0 / cell).ceil() as usize;
        let rows = if self == Self::Cylinder { 1 } else { reach };
        let grid = grid_of(cell, [reach, rows])?;
        let mut seeds = fill_polygon(&grid, &self.polygon(cell), 3, 1.0, 0)?;
        for seed in &mut seeds {
            let centroid = seed.x[0] + seed.centroid[0] * seed.half_length[0];
            seed.volume *= method.section.thickness(centroid);
        }
        let mut body = Body::new(Particles::new(&seeds)?);
        let elasticity = Elasticity::new(2.0 * (1.0 + POISSON) * SHEAR, POISSON)?;
        let law: SharedLaw = Arc::new(VonMises::from_undrained_strength(elasticity, 1.0)?);
        let bore = |factor: f64| RADII[0] + factor * (OPENED - RADII[0]);
        let load_path = |from: f64, to: f64| {
            StepConditions::new(
                grid.clone(),
                self.driven(&grid, cell, [bore(from), bore(to)])?,
                StepLoads::gravity([0.0; 2]),
                vec![Arc::clone(&law)],
            )
        };
        let mut curve = Vec::new();
        let mut observe = |accepted: &Accepted<'_, 2>| {
            curve.push([bore(accepted.report.to), self.pressure(accepted, cell)]);
            ControlFlow::Continue(())
        };
        let settings = MarchSettings::steps(100);
        let (run, _) = run(
            variant,
            &mut body,
            &method,
            &settings,
            &load_path,
            &mut observe,
        );
        Ok((run, curve))
    }
}

/// Checks thick bodies on so many cells along the bore; without B-bar as the control.
fn thick(study: &mut Study, body: Thick, cells: usize, method: Method) -> Result<(), CaseError> {
    let locks = method.label() == Method::igimp().label();
    let (run, curve) = body.opened(cells, method)?;
    if locks {
        let run = study.run(run);
        let beyond = curve.iter().filter(|[bore, _]| *bore >= 1.02);
        let highest = beyond
            .map(|[bore, p]| p / body.exact(*bore))
            .fold(f64::NAN, f64::max);
        let quantity = "largest p/p_exact beyond a = 1.02 a₀, must lock [-]";
        study.control(
            run,
            quantity,
            body.oracle().says(1.0),
            Band::AtLeast(1.5),
            highest,
        );
        return Ok(());
    }
    let run = study.run_to_end(run);
    let share = if cells < 16 { 0.02 } else { 0.01 };
    for bore in [1.1, 1.25, 1.5] {
        let exact = body.exact(bore);
        let quantity = format!("p/s_u at a = {bore} a₀ [-]");
        let found = interpolate(&curve, bore);
        study.check(
            run,
            quantity,
            body.oracle().says(exact),
            Band::Relative(share),
            found,
        );
    }
    Ok(())
}

/// A case file of a body of revolution.
fn file(grid: &str, clay: &str, rest: &str) -> String {
    format!(
        "igimp = 1
[case]
title = \"Body of revolution\"
analysis = \"axisymmetric\"
gravity = \"0 m/s2\"
[grid]
{grid}
[materials.soil]
{clay}
{rest}"
    )
}

/// A cylinder of soil under cell pressure, pressed by a smooth platen until it fails, on the given geometry.
fn triaxial(study: &mut Study) -> Result<(), CaseError> {
    let (cell_pressure, cohesion, friction) = (100.0_f64, 5.0, 30.0_f64.to_radians());
    let strength = cell_pressure * (1.0 + friction.sin()) / (1.0 - friction.sin())
        + 2.0 * cohesion * friction.cos() / (1.0 - friction.sin());
    let text = file(
        "cell = \"0.25 m\"\ndomain = { x = [\"0 m\", \"1.5 m\"], y = [\"0 m\", \"2.5 m\"] }",
        "model = \"mohr-coulomb\"\nunit_weight = \"0 kN/m3\"\nyoung = \"50 MPa\"\npoisson = 0.3\ncohesion = \"5 kPa\"\nfriction = \"30 deg\"\ndilation = \"30 deg\"",
        "[[bodies]]
name = \"cylinder\"
material = \"soil\"
polygon = [[\"0 m\", \"0 m\"], [\"1 m\", \"0 m\"], [\"1 m\", \"2 m\"], [\"0 m\", \"2 m\"]]
[boundaries]
bottom = \"roller\"
[[loads]]
name = \"cell\"
type = \"pressure\"
from = [\"1 m\", \"0 m\"]
to = [\"1 m\", \"2 m\"]
pressure = \"100 kPa\"
[[rigid]]
name = \"platen\"
type = \"rectangle\"
from = [\"-1.25 m\", \"2 m\"]
to = [\"1.25 m\", \"2.5 m\"]
interface = \"smooth\"
from_start = true
[[stages]]
name = \"consolidate\"
type = \"load\"
loads = [\"cell\"]
factor = 1
steps = 2
geometry = \"given\"
[[stages]]
name = \"shear\"
type = \"rigid\"
bodies = [{ body = \"platen\", y = \"-0.02 m\" }]
steps = 20
geometry = \"given\"
[[curves]]
name = \"strength\"
x = { of = \"step\" }
y = { of = \"rigid.platen.resistance\", divide_by = [3.141592653589793, \"100 kPa\"] }
",
    );
    let computed = Computed::new(CaseFile::parse("triaxial", &text, &[])?.into_case())?;
    let found = computed
        .curve("strength")
        .points(0, 1)
        .iter()
        .map(|[_, q]| *q)
        .fold(0.0, f64::max);
    let run = study.run_to_end(RunRecord::new(
        "cylinder of soil with friction",
        &computed.report,
        computed.elapsed,
    ));
    study.check(
        run,
        "σ₁/σ₃ at failure [-]",
        TRIAXIAL.says(strength / cell_pressure),
        Band::Relative(1e-9),
        found,
    );
    Ok(())
}

/// The pressure within a thick cylinder that soil with cohesion and friction \[rad\] carries, over the cohesion \[-\].
fn carried(friction: f64) -> f64 {
    let ratio = RADII[1] / RADII[0];
    if friction == 0.0 {
        return 2.0 * ratio.ln();
    }
    let passive = (1.0 + friction.sin()) / (1.0 - friction.sin());
    (ratio.powf(1.0 - 1.0 / passive) - 1.0) / friction.tan()
}

/// The factor of safety of that soil under half of its cohesion as pressure, by bisection.
fn exact_factor(friction: f64) -> f64 {
    let (mut lower, mut upper) = (1.0, 10.0);
    for _ in 0..60 {
        let factor: f64 = 0.5 * (lower + upper);
        if carried((friction.tan() / factor).atan()) / factor > 0.5 {
            lower = factor;
        } else {
            upper = factor;
        }
    }
    lower
}

/// Searches for the factor of safety of a thick cylinder under pressure from within.
fn safety(study: &mut Study) -> Result<(), CaseError> {
    let clay = "model = \"tresca\"\npoisson = 0.49\ncu = \"50 kPa\"";
    let sand =
        "model = \"mohr-coulomb\"\npoisson = 0.3\ncohesion = \"50 kPa\"\nfriction = \"30 deg\"";
    let soils = [
        ("clay", clay.to_owned(), 0.0),
        ("ψ = φ", format!("{sand}\ndilation = \"30 deg\""), 30.0_f64),
        ("ψ = φ/2", format!("{sand}\ndilation = \"15 deg\""), 30.0),
        ("ψ = 0", format!("{sand}\ndilation = \"0 deg\""), 30.0),
    ];
    for (name, law, friction) in soils {
        let text = file(
            "cell = \"1/8 m\"\ndomain = { x = [\"0 m\", \"18/8 m\"], y = [\"0 m\", \"1/8 m\"] }",
            &format!("{law}\nunit_weight = \"0 kN/m3\"\nyoung = \"50 MPa\""),
            "[[bodies]]
name = \"cylinder\"
material = \"soil\"
points_per_cell = 9
polygon = [[\"1 m\", \"0 m\"], [\"2 m\", \"0 m\"], [\"2 m\", \"1/8 m\"], [\"1 m\", \"1/8 m\"]]
[boundaries]
bottom = \"roller\"
top = \"roller\"
[[loads]]
name = \"bore\"
type = \"pressure\"
from = [\"1 m\", \"0 m\"]
to = [\"1 m\", \"1/8 m\"]
pressure = \"25 kPa\"
[[stages]]
name = \"pressure\"
type = \"load\"
loads = [\"bore\"]
factor = 1
steps = 4
geometry = \"given\"
[[stages]]
name = \"safety\"
type = \"strength-reduction\"
",
        );
        let computed = Computed::<2>::new(CaseFile::parse("safety", &text, &[])?.into_case())?;
        let bracket = computed
            .safety()
            .and_then(|safety| Some([safety.stable?, safety.failed?]));
        let found = bracket.map_or(f64::NAN, |[stable, failed]| 0.5 * (stable + failed));
        let variant = format!("factor of safety of a thick cylinder, {name}");
        let run = study.run_to_end(RunRecord::new(variant, &computed.report, computed.elapsed));
        let exact = COLLAPSE.says(exact_factor(friction.to_radians()));
        study.check(run, "F [-]", exact, Band::Relative(0.01), found);
    }
    Ok(())
}

/// A circular footing of radius 1 m on clay with E/c_u = 1000 at the surface.
struct Footing {
    /// Cells over its radius.
    cells: f64,
    interface: &'static str,
    /// Growth of strength over a diameter, over that at the surface \[-\].
    growth: f64,
    /// Its resistance over area and strength at the surface \[-\].
    exact: f64,
}

impl Footing {
    /// Its case file.
    fn file(&self) -> String {
        let Self {
            cells,
            interface,
            growth,
            ..
        } = *self;
        let [wide, deep] = [3.5, 2.75].map(|size: f64| (size * cells).ceil());
        let top = deep + (0.5 * cells).ceil();
        let at = |count: f64| format!("\"{count}/{cells} m\"");
        let (x, y, zero) = (at(wide), at(deep), "\"0 m\"");
        let strength = if growth == 0.0 {
            "\"50 kPa\"".to_owned()
        } else {
            let gradient = 25.0 * growth;
            format!("{{ at_surface = \"50 kPa\", gradient = \"{gradient} kPa/m\" }}")
        };
        file(
            &format!(
                "cell = \"1/{cells} m\"\ndomain = {{ x = [{zero}, {x}], y = [{zero}, {}] }}",
                at(top)
            ),
            &format!(
                "model = \"tresca\"\nunit_weight = \"0 kN/m3\"\nyoung = \"50 MPa\"\npoisson = 0.49\ncu = {strength}"
            ),
            &format!(
                "[[bodies]]
name = \"soil\"
material = \"soil\"
points_per_cell = 9
polygon = [[{zero}, {zero}], [{x}, {zero}], [{x}, {y}], [{zero}, {y}]]
[boundaries]
right = \"roller\"
bottom = \"fixed\"
[[rigid]]
name = \"footing\"
type = \"rectangle\"
from = [\"-1 m\", {y}]
to = [\"1 m\", {}]
interface = \"{interface}\"
rounding = 0
[[stages]]
name = \"push\"
type = \"rigid\"
geometry = \"given\"
bodies = [{{ body = \"footing\", y = \"-0.1 m\" }}]
steps = 30
[[curves]]
name = \"resistance\"
x = {{ of = \"rigid.footing.settlement\", divide_by = [\"2 m\"] }}
y = {{ of = \"rigid.footing.resistance\", divide_by = [{PI}, \"50 kPa\"] }}
",
                at(top)
            ),
        )
    }
}

/// The footings of a level.
fn footings_of(level: Level) -> Vec<Footing> {
    let both = |cells: f64, growth: f64, exact: [f64; 2]| {
        let of = move |(interface, exact)| Footing {
            cells,
            interface,
            growth,
            exact,
        };
        std::iter::zip(["rough", "smooth"], exact).map(of)
    };
    let edges = if level == Level::Full {
        &EDGES[..]
    } else {
        &EDGES[2..3]
    };
    let even = edges
        .iter()
        .flat_map(|&cells| both(cells, 0.0, [6.048, 5.690]));
    let growing = GROWING.iter().filter(|_| level == Level::Full);
    let growing = growing.flat_map(|&(growth, cells, exact)| both(cells, growth, exact));
    even.chain(growing).collect()
}

/// Checks circular footings.
fn footings(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let footings = footings_of(level);
    let computed = (footings.par_iter())
        .map(|case| Computed::new(CaseFile::parse("footing", &case.file(), &[])?.into_case()))
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (footing, computed) in std::iter::zip(&footings, &computed) {
        let Footing {
            cells,
            interface,
            growth,
            exact,
        } = *footing;
        let (ground, oracle) = if growth == 0.0 {
            (String::new(), CIRCLE)
        } else {
            (format!(", kD/c₀ = {growth}"), GROWTH)
        };
        let variant = format!("{interface} circle, R/h = {cells}{ground}");
        let run = RunRecord::new(variant, &computed.report, computed.elapsed);
        let run = study.run_to_end(run);
        let curve = computed.curve("resistance").points(0, 1);
        let found = curve.last().map_or(f64::NAN, |[_, n]| *n);
        let band = Band::Relative(0.04);
        study.check(run, "N [-]", oracle.says(exact), band, found);
    }
    Ok(())
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("revolution", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[8],
        Level::Default => &[8, 16],
        Level::Full => &[8, 16, 32],
    };
    for &cells in meshes {
        thick(&mut study, Thick::Cylinder, cells, Method::igimp_bbar())?;
        thick(&mut study, Thick::Sphere, cells, Method::igimp_bbar())?;
    }
    thick(&mut study, Thick::Sphere, 8, Method::igimp())?;
    triaxial(&mut study)?;
    safety(&mut study)?;
    footings(&mut study, level)?;
    Ok(study)
}
