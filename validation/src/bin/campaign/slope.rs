//! Random slopes as case files: geometry, soil, mesh and the way to collapse.

use std::fmt::Write as _;

use crate::bound::stability_number;
use crate::random::Random;

/// Most particles of a slope: the mesh is coarser where more would be needed.
const MOST_PARTICLES: f64 = 2500.0;
/// Fewest cells over the height.
const FEWEST_CELLS: usize = 5;
/// Most cells over the height.
const MOST_CELLS: usize = 20;

/// γH/c of flat slopes in deep undrained soil \[-\].
const DEEP: f64 = 5.52;
/// Largest γH/c that is asked of a slope \[-\].
const MOST_STABLE: f64 = 60.0;

/// How a slope is brought to collapse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drive {
    /// Gravity is raised until there is no equilibrium.
    Gravity,
    /// Strength is reduced under full gravity.
    Reduction,
    /// Gravity is raised anew on weaker and weaker soil.
    WeakerSoil,
}

impl Drive {
    /// In tables.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Gravity => "gravity",
            Self::Reduction => "reduction",
            Self::WeakerSoil => "reduction, gravity anew",
        }
    }
}

/// A law of the soil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Law {
    /// von Mises.
    VonMises,
    /// Tresca.
    Tresca,
    /// Mohr–Coulomb.
    MohrCoulomb,
    /// Mohr–Coulomb without tension beyond a tenth of the cohesion.
    Cutoff,
}

impl Law {
    /// In tables.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::VonMises => "von Mises",
            Self::Tresca => "Tresca",
            Self::MohrCoulomb => "Mohr-Coulomb",
            Self::Cutoff => "Mohr-Coulomb, cut-off",
        }
    }
}

/// A slope of one soil.
#[derive(Clone, Debug)]
pub(crate) struct Slope {
    /// Number within the campaign, from 1.
    pub(crate) number: u64,
    /// How it is brought to collapse.
    pub(crate) drive: Drive,
    /// Law of the soil.
    pub(crate) law: Law,
    /// Inclination β \[deg\].
    pub(crate) angle: f64,
    /// Height H \[m\].
    pub(crate) height: f64,
    /// Cells over the height, H/h.
    pub(crate) cells: usize,
    /// Particles per cell and direction.
    pub(crate) per_direction: usize,
    /// Cells of soil below the toe; without any the toe stands on the fixed base.
    pub(crate) foundation: usize,
    /// γH/c at full gravity \[-\].
    pub(crate) stability_number: f64,
    /// φ \[deg\].
    pub(crate) friction: f64,
    /// ψ \[deg\].
    pub(crate) dilation: f64,
    /// ν \[-\].
    pub(crate) poisson: f64,
    /// E/c \[-\].
    pub(crate) stiffness: f64,
}

/// Unit weight of all slopes \[kN/m³\].
const UNIT_WEIGHT: f64 = 20.0;

impl Slope {
    /// The slope of a number in the campaign of a seed.
    pub(crate) fn random(seed: u64, number: u64) -> Self {
        let mut random = Random::new(seed, number);
        let angle = random.uniform(15.0, 75.0);
        let height = random.uniform(3.0, 20.0);
        let undrained = random.chance(0.4);
        let friction = if undrained {
            0.0
        } else {
            random.uniform(5.0, 40.0)
        };
        let law = match (undrained, random.unit()) {
            (true, chance) if chance < 0.5 => Law::VonMises,
            (true, _) => Law::Tresca,
            (false, chance) if chance < 0.5 => Law::MohrCoulomb,
            (false, _) => Law::Cutoff,
        };
        let dilation = match random.integer(1, 3) {
            1 => 0.0,
            2 => friction,
            _ => random.uniform(0.0, friction),
        };
        // Half the slopes close to incompressible, up to 0.4999.
        let poisson = if random.chance(0.5) {
            random.uniform(0.15, 0.45)
        } else {
            0.5 - random.log_uniform(1e-4, 0.05)
        };
        let stiffness = random.log_uniform(10.0, 1e5);
        let per_direction = random.integer(2, 4);
        let cells = random.integer(FEWEST_CELLS, MOST_CELLS);
        let has_foundation = random.chance(0.5);
        let depth = random.uniform(0.3, 1.0);
        let drive = match random.unit() {
            // Weight alone brings down no slope that is hardly steeper than the friction angle.
            chance if chance < 0.6 && friction < angle - 5.0 => Drive::Gravity,
            chance if chance < 0.85 => Drive::Reduction,
            _ => Drive::WeakerSoil,
        };
        let mut slope = Self {
            number,
            drive,
            law,
            angle,
            height,
            cells,
            per_direction,
            foundation: 0,
            stability_number: 0.0,
            friction,
            dilation,
            poisson,
            stiffness,
        };
        slope.coarsen(has_foundation.then_some(depth));
        // Most slopes stand at full gravity, some do not.
        slope.stability_number = slope.target() * random.uniform(0.3, 1.1);
        slope
    }

    /// The finest mesh of at most as many cells as drawn that keeps to the number of particles.
    fn coarsen(&mut self, depth: Option<f64>) {
        loop {
            self.foundation = depth.map_or(0, |depth| {
                ((depth * self.cells as f64).round() as usize).max(1)
            });
            if self.cells == FEWEST_CELLS || self.expected_particles() <= MOST_PARTICLES {
                return;
            }
            self.cells -= 1;
        }
    }

    /// Particles by the area of the body.
    fn expected_particles(&self) -> f64 {
        let n = self.cells as f64;
        let upper = (self.crest() + 0.5 * self.run()) / self.cell() * n;
        let lower = self.width() / self.cell() * self.foundation as f64;
        (upper + lower) * (self.per_direction as f64).powi(2)
    }

    /// γH/c at collapse by limit analysis of stiff soil with associated flow \[-\].
    pub(crate) fn bound(&self) -> f64 {
        self.bound_reduced_by(1.0)
    }

    /// The factor of safety under full gravity by the same limit analysis \[-\].
    pub(crate) fn factor_of_safety(&self) -> f64 {
        let (mut stable, mut failed) = (1e-2, 1e2);
        while failed - stable > 1e-3 * stable {
            let middle = f64::sqrt(stable * failed);
            if self.bound_reduced_by(middle) / middle > self.stability_number {
                stable = middle;
            } else {
                failed = middle;
            }
        }
        stable
    }

    /// The bound on γH/c for a friction angle whose tangent is divided by a factor. Undrained soil
    /// below the toe fails at 5.52 at most, however flat the slope (Taylor 1937).
    fn bound_reduced_by(&self, factor: f64) -> f64 {
        let phi = (self.friction.to_radians().tan() / factor).atan();
        let bound = stability_number(self.angle.to_radians(), phi, self.foundation == 0);
        if self.friction == 0.0 && self.foundation > 0 {
            bound.min(DEEP)
        } else {
            bound
        }
    }

    /// The bound, or a number of its size where friction alone holds the slope \[-\].
    fn target(&self) -> f64 {
        self.bound().min(MOST_STABLE)
    }

    /// h \[m\].
    pub(crate) fn cell(&self) -> f64 {
        self.height / self.cells as f64
    }

    /// c \[kPa\].
    pub(crate) fn cohesion(&self) -> f64 {
        UNIT_WEIGHT * self.height / self.stability_number
    }

    /// E \[kPa\].
    fn young(&self) -> f64 {
        self.stiffness * self.cohesion()
    }

    /// Multiple of gravity at which a slope driven by gravity has certainly collapsed \[-\].
    pub(crate) fn last_gravity(&self) -> f64 {
        2.0 * self.target() / self.stability_number
    }

    /// Horizontal length of the face \[m\].
    fn run(&self) -> f64 {
        self.height / self.angle.to_radians().tan()
    }

    /// Length of the ground behind the crest \[m\], whole cells.
    fn crest(&self) -> f64 {
        (0.8 * self.cells as f64).ceil() * self.cell()
    }

    /// Length of the body from the back to the end of the foundation \[m\], whole cells.
    fn width(&self) -> f64 {
        let toe = if self.foundation > 0 {
            0.8 * self.height
        } else {
            0.0
        };
        ((self.crest() + self.run() + toe) / self.cell() - 1e-9).ceil() * self.cell()
    }

    /// The case file.
    pub(crate) fn case_file(&self) -> String {
        let base = self.foundation as f64 * self.cell();
        let (crest, toe) = (self.crest(), self.crest() + self.run());
        let top = base + self.height;
        let width = self.width();
        let room = self.cells as f64 * self.cell();
        let mut polygon = vec![[0.0, 0.0]];
        if self.foundation > 0 {
            polygon.extend([[width, 0.0], [width, base]]);
        }
        polygon.extend([[toe, base], [crest, top], [0.0, top]]);
        let corners: Vec<String> = polygon
            .iter()
            .map(|[x, y]| format!("[\"{x} m\", \"{y} m\"]"))
            .collect();
        let right = if self.foundation > 0 {
            width
        } else {
            width + room
        };
        let mut text = format!(
            "igimp = 1\n\n\
             [case]\ntitle = \"Random slope {}\"\nanalysis = \"plane-strain\"\n\
             gravity = \"9.81 m/s2\"\n\n\
             [grid]\nlocking = \"b-bar\"\ncell = \"{h} m\"\n\
             domain = {{ x = [\"0 m\", \"{right} m\"], y = [\"0 m\", \"{} m\"] }}\n\n\
             [materials.soil]\n{}\n\
             [[bodies]]\nname = \"slope\"\nmaterial = \"soil\"\npoints_per_cell = {}\n\
             polygon = [{}]\n\n\
             [boundaries]\nleft = \"roller\"\nright = \"{}\"\nbottom = \"fixed\"\n\n",
            self.number,
            top + self.cell(),
            self.soil(),
            self.per_direction.pow(2),
            corners.join(", "),
            if self.foundation > 0 {
                "roller"
            } else {
                "free"
            },
            h = self.cell(),
        );
        text.push_str(&self.stages());
        text
    }

    fn soil(&self) -> String {
        let (c, young) = (self.cohesion(), self.young());
        let mut text = format!(
            "unit_weight = \"{UNIT_WEIGHT} kN/m3\"\nyoung = \"{young} kPa\"\npoisson = {}\n",
            self.poisson
        );
        let _ = match self.law {
            Law::VonMises => writeln!(text, "model = \"von-mises\"\ncu = \"{c} kPa\""),
            Law::Tresca => writeln!(text, "model = \"tresca\"\ncu = \"{c} kPa\""),
            Law::MohrCoulomb | Law::Cutoff => writeln!(
                text,
                "model = \"mohr-coulomb\"\ncohesion = \"{c} kPa\"\nfriction = \"{} deg\"\n\
                 dilation = \"{} deg\"",
                self.friction, self.dilation
            ),
        };
        if self.law == Law::Cutoff {
            let _ = writeln!(text, "tension_cutoff = \"{} kPa\"", 0.1 * c);
        }
        text
    }

    /// A displacement of a quarter of the height counts as collapse too: soft soil gives way long
    /// before it finds no equilibrium.
    fn stages(&self) -> String {
        let far = 0.25 * self.height;
        match self.drive {
            Drive::Gravity => format!(
                "[[stages]]\nname = \"to collapse\"\ntype = \"gravity\"\nfactor = {}\nsteps = 30\n\
                 stop_when = {{ no_equilibrium = true, displacement = \"{far} m\" }}\n",
                self.last_gravity()
            ),
            Drive::Reduction => format!(
                "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 8\n\
                 reset_displacements = true\n\n\
                 [[stages]]\nname = \"reduction\"\ntype = \"strength-reduction\"\ngeometry = \"moving\"\n\
                 materials = [\"soil\"]\nbracket = [1.0, 2.0]\ntolerance = 0.05\nsteps = 8\n\
                 failure = {{ when = \"no-equilibrium\", also = {{ displacement = \"{far} m\" }} }}\n"
            ),
            Drive::WeakerSoil => format!(
                "[[stages]]\nname = \"reduction\"\ntype = \"strength-reduction\"\ngeometry = \"moving\"\n\
                 path = \"gravity\"\nmaterials = [\"soil\"]\nbracket = [1.0, 2.0]\n\
                 tolerance = 0.05\nsteps = 6\n\
                 failure = {{ when = \"no-equilibrium\", also = {{ displacement = \"{} m\" }} }}\n",
                2.0 * far
            ),
        }
    }
}
