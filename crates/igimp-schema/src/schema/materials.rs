//! Materials.

use super::MANY;
use super::declare::{choices, schema, table, variants};

/// Names of fields in books, and their keys here: of these the one that the material has is meant.
pub static SYMBOLS: [(&str, &[&str]); 34] = [
    ("gamma", &["unit_weight"]),
    ("γ", &["unit_weight"]),
    ("weight", &["unit_weight"]),
    ("e", &["young", "void_ratio"]),
    ("e0", &["void_ratio"]),
    ("lambda*", &["lambda"]),
    ("kappa*", &["kappa"]),
    ("m", &["critical_ratio", "power"]),
    ("g", &["shear"]),
    ("modulus", &["young"]),
    ("youngs_modulus", &["young"]),
    ("nu", &["poisson"]),
    ("ν", &["poisson"]),
    ("c", &["cohesion", "cu"]),
    ("c'", &["cohesion"]),
    ("c_u", &["cu"]),
    ("su", &["cu"]),
    ("s_u", &["cu"]),
    ("phi", &["friction"]),
    ("phi'", &["friction"]),
    ("φ", &["friction"]),
    ("friction_angle", &["friction"]),
    ("psi", &["dilation"]),
    ("ψ", &["dilation"]),
    ("dilatancy", &["dilation"]),
    ("gamma_sat", &["saturated_unit_weight"]),
    ("nu_u", &["undrained_poisson"]),
    ("e50_ref", &["e50"]),
    ("eur_ref", &["eur"]),
    ("eoed_ref", &["eoed"]),
    ("nu_ur", &["poisson"]),
    ("p_ref", &["reference_pressure"]),
    ("r_f", &["failure_ratio"]),
    ("k0_nc", &["k0_normal"]),
];

variants! {
    MATERIAL: Material of Model, "A material.", "model", "constitutive law";
    "elastic" => Elastic(ELASTIC: Elastic),
    "von-mises" => VonMises(VON_MISES: VonMises),
    "tresca" => Tresca(TRESCA: Tresca),
    "mohr-coulomb" => MohrCoulomb(MOHR_COULOMB: MohrCoulomb),
    "drucker-prager" => DruckerPrager(DRUCKER_PRAGER: DruckerPrager),
    "modified-cam-clay" => CamClay(CAM_CLAY: CamClay),
    "hoek-brown" => HoekBrown(HOEK_BROWN: HoekBrown),
    "hardening-soil" => HardeningSoil(HARDENING_SOIL: HardeningSoil),
    after MATERIAL_COMMON: MaterialCommon;
}

impl Model {
    /// The keys of linear elasticity, if the model has them.
    pub fn stiffness(&self) -> Option<&Stiffness> {
        match self {
            Self::Elastic(keys) => keys.as_ref().ok().map(|keys| &keys.stiffness),
            Self::VonMises(keys) => keys.as_ref().ok().map(|keys| &keys.stiffness),
            Self::Tresca(keys) => keys.as_ref().ok().map(|keys| &keys.stiffness),
            Self::MohrCoulomb(keys) => keys.as_ref().ok().map(|keys| &keys.stiffness),
            Self::DruckerPrager(keys) => keys.as_ref().ok().map(|keys| &keys.stiffness),
            Self::HoekBrown(keys) => keys.as_ref().ok().map(|keys| &keys.stiffness),
            Self::CamClay(_) | Self::HardeningSoil(_) => None,
        }
    }

    /// The keys of an undrained strength, if the model has them.
    pub fn undrained(&self) -> Option<&Undrained> {
        match self {
            Self::VonMises(Ok(keys)) => Some(&keys.strength),
            Self::Tresca(Ok(keys)) => Some(&keys.strength),
            _ => None,
        }
    }

    /// The keys of cohesion and friction, if the model has them.
    pub fn frictional(&self) -> Option<&Frictional> {
        match self {
            Self::MohrCoulomb(Ok(keys)) => Some(&keys.strength),
            Self::DruckerPrager(Ok(keys)) => Some(&keys.strength),
            _ => None,
        }
    }
}

table! {
    ELASTIC: Elastic, "Hencky elasticity without a strength limit.";
    stiffness: part(STIFFNESS: Stiffness);
}

table! {
    STIFFNESS: Stiffness, "Linear elasticity.";
    young: apart(either(quantity(Stress, Positive), table(STRESS_PROFILE: Profile))), required "\"20 MPa\"",
        "Young's modulus";
    poisson: apart(either(number(NotNegative), table(NUMBER_PROFILE: Profile))), required "0.3", "Poisson's ratio, below 0.5";
}

table! {
    VON_MISES: VonMises, "Elastic and perfectly plastic, von Mises.";
    strength: part(UNDRAINED: Undrained);
    stiffness: part(STIFFNESS: Stiffness);
}

table! {
    TRESCA: Tresca, "Elastic and perfectly plastic, Tresca.";
    strength: part(UNDRAINED: Undrained);
    stiffness: part(STIFFNESS: Stiffness);
}

table! {
    UNDRAINED: Undrained, "Strength by total stress.";
    cu: apart(either(quantity(Stress, Positive), table(STRENGTH_PROFILE: StrengthProfile))), required "\"50 kPa\"",
        "undrained shear strength in plane strain; with `anisotropy` that of active loading";
    softening: apart(table(UNDRAINED_SOFTENING: UndrainedSoftening)), optional "strength stays as soil is sheared",
        "strength that goes with plastic strain";
    anisotropy: apart(table(ANISOTROPY: Anisotropy)), optional "one strength in all directions",
        "strength that goes with the direction of the major compression at the start of a step";
    rate: apart(table(RATE: Rate)), optional "one strength at all rates",
        "strength that grows with the rate of strain, in stages that take time";
}

table! {
    ANISOTROPY: Anisotropy,
    "Undrained strengths by the direction of the major compression, over `cu` of active loading, where it is upright; in between they lie on an ellipse.";
    simple_shear: number(Positive), required "0.75", "strength in simple shear, with the major compression at 45 deg, over `cu`";
    passive: number(Positive), required "0.5", "strength in passive loading, with the major compression level, over `cu`";
}

table! {
    RATE: Rate, "An undrained strength that grows with the logarithm of the rate of plastic shear strain.";
    per_log_cycle: number(Positive), required "0.1", "growth over `cu` for a rate ten times as great";
    reference: quantity(StrainRate, Positive), required "\"1 %/h\"", "rate at and below which the strength is `cu`; stages without time have it too";
}

table! {
    UNDRAINED_SOFTENING: UndrainedSoftening, "An undrained strength that softens or hardens with plastic strain.";
    cu: table(STRENGTH_CURVE: StrengthCurve), required "{ residual = 0.4, strain = 0.1 }", "undrained shear strength";
    band_width: quantity(Length, Positive), optional "strains are as stated on any cells",
        "width of the band of shear in which the strain was measured: strains of the law are times this over the size of a cell";
    length: quantity(Length, Positive), optional "strength goes with the plastic strain of the point",
        "length over which plastic strain is spread by an implicit gradient: bands of shear have a width of their own on cells of half of it and less";
    over_nonlocal: number(Positive), optional "2 with `length`",
        "share m of the plastic strain of the ground around, above 1; that of the point has 1 - m";
}

table! {
    FRICTIONAL_SOFTENING: FrictionalSoftening, "Strength by effective stress that softens or hardens with plastic strain: one of the three at least.";
    cohesion: table(STRENGTH_CURVE: StrengthCurve), optional "it stays", "cohesion, and with it the tension cut-off";
    friction: table(ANGLE_CURVE: AngleCurve), optional "it stays", "friction angle; its tangent follows the curve; where friction varies, the residual is that of the greatest, and goes with it by the tangent";
    dilation: table(ANGLE_CURVE: AngleCurve), optional "it stays",
        "dilation angle, nowhere above the friction angle that is left; a residual of zero ends dilation";
    band_width: quantity(Length, Positive), optional "strains are as stated on any cells",
        "width of the band of shear in which the strains were measured: strains of the law are times this over the size of a cell";
    length: quantity(Length, Positive), optional "strength goes with the plastic strain of the point",
        "length over which plastic strain is spread by an implicit gradient: bands of shear have a width of their own on cells of half of it and less";
    over_nonlocal: number(Positive), optional "2 with `length`",
        "share m of the plastic strain of the ground around, above 1; that of the point has 1 - m";
}

table! {
    STRENGTH_CURVE: StrengthCurve, "How a strength goes with plastic strain.";
    residual: number(NotNegative), required "0.4", "what is left in the end over the initial value; above 1 it hardens";
    strain: number(Positive), required "0.1",
        "accumulated deviatoric plastic strain over which it goes, at every place, whatever its strength and stiffness; plane shear by gamma has gamma / 1.732";
    curve: choice(Decay), default "\"exponential\"", "shape of the curve";
}

table! {
    ANGLE_CURVE: AngleCurve, "How an angle goes with plastic strain.";
    residual: quantity(Angle, NotNegative), required "\"15 deg\"", "the angle in the end";
    strain: number(Positive), required "0.1",
        "accumulated deviatoric plastic strain over which it goes, at every place, whatever its strength and stiffness; plane shear by gamma has gamma / 1.732";
    curve: choice(Decay), default "\"exponential\"", "shape of the curve";
}

choices! {
    /// Shape of a curve over plastic strain.
    Decay;
    Linear "linear", "on a straight line, which ends at `strain`";
    Exponential "exponential", "63 % of the way is gone at `strain`";
}

table! {
    MOHR_COULOMB: MohrCoulomb, "Elastic and perfectly plastic, Mohr-Coulomb with non-associated flow.";
    strength: part(FRICTIONAL: Frictional);
    flow: apart(choice(Flow)), default "\"dilation\"", "how plastic flow follows from the angle of dilation";
    tension_cutoff: apart(either(quantity(Stress, NotNegative), table(STRESS_PROFILE: Profile))), optional "the apex of the cone limits tension",
        "largest tensile stress; zero or missing where cohesion varies";
    softening: apart(table(FRICTIONAL_SOFTENING: FrictionalSoftening)), optional "strength stays as soil is sheared",
        "strength that goes with plastic strain";
    stiffness: part(STIFFNESS: Stiffness);
}

table! {
    DRUCKER_PRAGER: DruckerPrager,
    "Elastic and perfectly plastic, Drucker-Prager with non-associated flow: a cone that agrees with Mohr-Coulomb along one path.";
    strength: part(FRICTIONAL: Frictional);
    cone: apart(choice(Cone)), required "\"plane-strain\"", "where it has the strength of Mohr-Coulomb";
    rate: apart(table(INERTIAL_RATE: InertialRate)), optional "one friction at all speeds",
        "friction of dry grains that grows with the speed of shear, mu(I), in stages that take time";
    stiffness: part(STIFFNESS: Stiffness);
}

table! {
    INERTIAL_RATE: InertialRate,
    "Friction of dry grains that grows with the inertial number I = shear rate * grain_diameter / (pressure / grain_density)^0.5 \
     (Jop, Forterre and Pouliquen 2006). `friction` of the material is that of slow shear.";
    friction: quantity(Angle, Positive), required "\"39 deg\"", "friction angle of shear without end fast, above that of slow shear";
    inertial_number: number(Positive), required "0.279", "I_0, at which half of the growth is reached";
    grain_diameter: quantity(Length, Positive), required "\"0.5 mm\"", "diameter of the grains";
    grain_density: quantity(MassDensity, Positive), required "\"2650 kg/m3\"", "density of the grains, without pores";
}

choices! {
    /// Where a cone has the strength of Mohr-Coulomb.
    Cone;
    Compression "compression", "in triaxial compression: the outer cone, too strong elsewhere";
    Extension "extension", "in triaxial extension: the inner cone";
    PlaneStrain "plane-strain", "in plane strain, for any dilation angle";
}

table! {
    FRICTIONAL: Frictional, "Strength by effective stress.";
    cohesion: apart(either(quantity(Stress, NotNegative), table(STRESS_PROFILE: Profile))), required "\"10 kPa\"",
        "cohesion c";
    friction: apart(either(quantity(Angle, NotNegative), table(FRICTION_PROFILE: Rows))), required "\"20 deg\"",
        "friction angle, below 90 deg";
    dilation: apart(either(quantity(Angle, NotNegative), table(ANGLE_PROFILE: Profile))), default "\"0 deg\"", "dilation angle, nowhere above the friction angle";
}

table! {
    CAM_CLAY: CamClay,
    "Modified Cam-clay: clay whose yield surface grows and shrinks with plastic volume, and whose stiffness grows with pressure. \
     Begins with a stage of type k0.";
    lambda: either(number(Positive), table(NUMBER_PROFILE: Profile)), required "0.2", "slope of the compression line over ln p: of natural volumetric strain, or of void ratio \
        with `void_ratio`";
    kappa: either(number(Positive), table(NUMBER_PROFILE: Profile)), required "0.04", "slope of the swelling lines, below `lambda`";
    void_ratio: number(Positive), optional "`lambda` and `kappa` are of natural volumetric strain",
        "void ratio by which `lambda` and `kappa` of void ratio are divided, as 1 + e";
    friction: either(quantity(Angle, Positive), table(ANGLE_PROFILE: Profile)), optional "`critical_ratio` says it",
        "friction angle at the critical state, in triaxial compression";
    critical_ratio: either(number(Positive), table(NUMBER_PROFILE: Profile)), optional "`friction` says it", "M = q/p at the critical state";
    poisson: either(number(NotNegative), table(NUMBER_PROFILE: Profile)), optional "`shear` says it",
        "Poisson's ratio, below 0.5, of a shear modulus that grows with pressure";
    shear: either(quantity(Stress, Positive), table(STRESS_PROFILE: Profile)), optional "`poisson` says it", "shear modulus, if it is a constant";
    ocr: either(number(Positive), table(NUMBER_PROFILE: Profile)), default "1.0",
        "preconsolidation pressure over p + q^2/(M^2 p) of the initial stress, 1 or more";
    reference_pressure: quantity(Stress, Positive), default "\"100 kPa\"",
        "pressure whose stiffness contact, ties of small cuts and estimates go by";
}

table! {
    HOEK_BROWN: HoekBrown, "Elastic and perfectly plastic rock mass, Hoek-Brown of 2002.";
    sci: either(quantity(Stress, Positive), table(STRESS_PROFILE: Profile)), required "\"30 MPa\"", "uniaxial compressive strength of intact rock";
    gsi: either(number(Positive), table(NUMBER_PROFILE: Profile)), required "45.0", "geological strength index, at most 100";
    mi: either(number(Positive), table(NUMBER_PROFILE: Profile)), required "10.0", "m_i of intact rock";
    disturbance: either(number(NotNegative), table(NUMBER_PROFILE: Profile)), default "0.0", "factor of disturbance D, from 0 of rock left whole to 1 of blasted slopes";
    dilation: either(quantity(Angle, NotNegative), table(ANGLE_PROFILE: Profile)), default "\"0 deg\"", "dilation angle, nowhere above the friction angle that acts";
    stiffness: part(STIFFNESS: Stiffness);
}

table! {
    HARDENING_SOIL: HardeningSoil,
    "Hardening Soil of Schanz, Vermeer and Bonnier (1999): shear hardens along a hyperbola up to the strength of Mohr-Coulomb, a cap \
     hardens in compression, and stiffness grows with the least compression.";
    cohesion: either(quantity(Stress, NotNegative), table(STRESS_PROFILE: Profile)), required "\"0 kPa\"", "cohesion c";
    friction: either(quantity(Angle, Positive), table(ANGLE_PROFILE: Profile)), required "\"35 deg\"", "friction angle, 1 deg to 80 deg";
    dilation: either(quantity(Angle, NotNegative), table(ANGLE_PROFILE: Profile)), default "\"0 deg\"", "dilation angle at failure, nowhere above the friction angle or 30 deg";
    e50: either(quantity(Stress, Positive), table(STRESS_PROFILE: Profile)), required "\"30 MPa\"",
        "secant modulus at half the strength in drained triaxial compression, at a cell pressure of `reference_pressure`, where the cap does not yield; with `ocr` = 1 soil is softer";
    eur: either(quantity(Stress, Positive), table(STRESS_PROFILE: Profile)), optional "three times `e50`", "Young's modulus of unloading and reloading there";
    eoed: either(quantity(Stress, Positive), table(STRESS_PROFILE: Profile)), optional "as `e50`",
        "tangent modulus of first compression in the oedometer, at an axial stress of `reference_pressure`";
    poisson: either(number(NotNegative), table(NUMBER_PROFILE: Profile)), default "0.2", "Poisson's ratio of unloading, below 0.5";
    power: either(number(NotNegative), table(NUMBER_PROFILE: Profile)), default "0.5", "power m by which stiffness grows with stress, at most 1";
    reference_pressure: quantity(Stress, Positive), default "\"100 kPa\"", "pressure at which the moduli are as stated";
    failure_ratio: either(number(Positive), table(NUMBER_PROFILE: Profile)), default "0.9", "R_f, strength over the asymptote of the hyperbola, below 1";
    k0_normal: either(number(Positive), table(NUMBER_PROFILE: Profile)), optional "1 - sin(friction)", "ratio of stresses in first one-dimensional compression, below 1";
    ocr: either(number(Positive), table(NUMBER_PROFILE: Profile)), default "1.0",
        "preconsolidation pressure over (q^2/M^2 + p^2)^0.5 of the initial stress, 1 or more";
}

choices! {
    /// How plastic flow follows from the angle of dilation.
    Flow;
    Dilation "dilation", "by the angle of dilation: not associated below the friction angle";
    Davis "davis",
        "associated, on the strengths of Davis (1968): a symmetric tangent, and a smaller factor of safety";
}

table! {
    MATERIAL_COMMON: MaterialCommon, "Keys of every material.";
    unit_weight: apart(either(quantity(UnitWeight, NotNegative), table(UNIT_WEIGHT_PROFILE: Profile))),
        required "\"18 kN/m3\"", "unit weight";
    k0: apart(either(number(NotNegative), choice(Jaky))), optional "an elastic material takes poisson / (1 - poisson)",
        "coefficient of earth pressure at rest, for stages of type k0";
    saturated_unit_weight: apart(quantity(UnitWeight, Positive)), optional "as above the water table",
        "unit weight below a water table, water included";
    drainage: apart(choice(Drainage)), derived "\"total\" with `cu`, \"drained\" otherwise",
        "what it does with the water in its pores";
    undrained_poisson: apart(number(Share)), optional "0.495 where `drainage` is undrained or coupled and `pore_water` is not given",
        "Poisson's ratio of undrained soil with its water, above `poisson`; where stiffness goes with stress, at the stress as a step begins";
    pore_water: apart(quantity(Stress, Positive)), optional "`undrained_poisson` says it",
        "bulk modulus of the water over the porosity, K_w/n, of undrained and coupled soil";
    permeability: apart(either(quantity(Velocity, Positive), table(PERMEABILITY: Permeability))),
        optional "none is needed without computed seepage and coupled soil", "permeability, for computed seepage and coupled soil";
}

table! {
    PERMEABILITY: Permeability, "A permeability that differs by direction, or that soil above the free surface keeps in part.";
    horizontal: either(quantity(Velocity, Positive), table(PERMEABILITY_PROFILE: Rows)), required "\"1e-5 m/s\"",
        "along the bedding; in computed seepage it may vary with the level or with the depth";
    vertical: quantity(Velocity, Positive), optional "as `horizontal`",
        "across the bedding; where `horizontal` varies, that where it is greatest, and it varies alike";
    angle: quantity(Angle, Any), default "\"0 deg\"", "angle by which the bedding rises towards +x";
    gardner: quantity(Length, Positive), optional "it falls over one cell at the free surface",
        "height 1/alpha over which permeability falls to 37 % above the free surface, by Gardner's curve";
    van_genuchten: table(VAN_GENUCHTEN: VanGenuchten), optional "it falls over one cell at the free surface",
        "curve of van Genuchten and Mualem above the free surface";
    drainable: number(Share), optional "seepage in time needs it",
        "share of its volume that soil gives back as water where it drains";
    void_ratio: number(Positive), optional "permeability stays as soil consolidates",
        "void ratio at the start: in coupled soil permeability follows it, by Kozeny and Carman unless `c_k` is given";
    c_k: number(Positive), optional "Kozeny and Carman say how it follows",
        "change of the void ratio by which permeability becomes ten times another, in coupled soil";
}

table! {
    VAN_GENUCHTEN: VanGenuchten, "Relative permeability of van Genuchten and Mualem, m = 1 - 1/n.";
    height: quantity(Length, Positive), required "\"0.5 m\"", "1/alpha";
    n: number(Positive), required "2.0", "exponent, above 1";
}

choices! {
    /// The behaviour of water in a material's pores.
    Drainage;
    Drained "drained", "water comes and goes: strength and stiffness are those of effective stress";
    Undrained "undrained", "the same, and changes of volume make excess pore pressure";
    Coupled "coupled", "the same, and the water flows in stages with `consolidation`";
    Total "total", "strength and stiffness are those of total stress: pore pressure does not matter";
}

choices! {
    /// A coefficient of earth pressure at rest that follows from the friction angle.
    Jaky;
    Jaky "jaky", "1 - sin(friction)";
}

/// Declares the keys of values by points in the plane.
macro_rules! points {
    ($declare:ident $schema:ident $(: $name:ident)?, $doc:literal, $kind:ident $args:tt) => {
        $declare! {
            $schema $(: $name)?, $doc;
            raster: text, optional "it does not come from a file",
                "a CSV file with the columns x, y and value on a rectangular grid of points; its path from the case file";
            unit: text, optional "the header of the file says it, as in `cu [kPa]`",
                "unit of the values of the file";
            length_unit: text, optional "the header of the file says it, as in `x [m]`",
                "unit of x and y of the file";
            x: list(length, 1, MANY), optional "no points in the plane", "upright lines of points, ascending";
            y: list(length, 1, MANY), optional "no points in the plane", "level lines of points, ascending";
            rows: list(list($kind $args, 1, MANY), 1, MANY), optional "no points in the plane",
                "values there, a list along x for every y; bilinear between the points";
        }
    };
}

pub(crate) use points;

/// Declares the keys of values over levels or depths.
macro_rules! rows {
    ($declare:ident $schema:ident $(: $name:ident)?, $doc:literal, $kind:ident $args:tt) => {
        $declare! {
            $schema $(: $name)?, $doc;
            levels: list(length, 2, MANY), optional "another form is given",
                "levels y, all upwards or all downwards";
            depths: list(length, 2, MANY), optional "another form is given",
                "depths below the surface, straight down";
            values: list($kind $args, 2, MANY), optional "another form is given",
                "values at the levels or depths; linear between them, constant beyond";
        }
    };
}

/// Declares the keys of values that grow with depth.
macro_rules! growth {
    ($declare:ident $schema:ident $(: $name:ident)?, $value:ident $value_args:tt, $gradient:ident) => {
        $declare! {
            $schema $(: $name)?, "Growth with depth.";
            at_surface: $value $value_args, optional "another form is given",
                "value at the surface, the highest soil of the case on the same vertical line";
            at_top: $value $value_args, optional "another form is given",
                "value at the level `from` and above";
            gradient: quantity($gradient, Any), optional "another form is given",
                "growth with depth below the surface, or below `from`";
            from: length, optional "the highest soil of the material",
                "level y where the growth begins, with `at_top`";
        }
    };
}

growth! { table STRESS_GROWTH: Growth, quantity(Stress, NotNegative), StressGradient }
rows! { table STRESS_ROWS: Rows, "Stresses over levels or depths.", quantity(Stress, NotNegative) }
points! { table STRESS_POINTS: Points, "Stresses by points in the plane.", quantity(Stress, NotNegative) }
growth! { schema WEIGHT_GROWTH, quantity(UnitWeight, NotNegative), UnitWeightGradient }
rows! { schema WEIGHT_ROWS, "Unit weights over levels or depths.", quantity(UnitWeight, NotNegative) }
points! { schema WEIGHT_POINTS, "Unit weights by points in the plane.", quantity(UnitWeight, NotNegative) }
growth! { schema ANGLE_GROWTH, quantity(Angle, NotNegative), AngleGradient }
rows! { schema ANGLE_ROWS, "Angles over levels or depths.", quantity(Angle, NotNegative) }
points! { schema ANGLE_POINTS, "Angles by points in the plane.", quantity(Angle, NotNegative) }
growth! { schema NUMBER_GROWTH, number(NotNegative), NumberGradient }
rows! { schema NUMBER_ROWS, "Numbers over levels or depths.", number(NotNegative) }
points! { schema NUMBER_POINTS, "Numbers by points in the plane.", number(NotNegative) }

table! {
    STRESS_PROFILE: Profile,
    "A stress that varies with the level y or with the depth below the surface: `at_top` and `gradient`, \
     `at_surface` and `gradient`, or `values` at `levels` or `depths`; or in the plane: `raster`, or `x`, `y` and `rows`. Soil carries what it has where it starts. A \
     strength may be zero somewhere, and counts as a millionth of the greatest there.";
    growth: part(STRESS_GROWTH: Growth);
    table: part(STRESS_ROWS: Rows);
    points: part(STRESS_POINTS: Points);
}

table! {
    STRENGTH_PROFILE: StrengthProfile,
    "An undrained strength that varies: stated like any stress that varies, or as a share of the vertical \
     effective stress of level ground, `ratio` * stress * `ocr`^`exponent`, from the weight of the soil straight above.";
    stress: part(STRESS_PROFILE: Profile);
    ratio: number(Positive), optional "another form is given",
        "strength of normally consolidated soil over the vertical effective stress";
    ocr: either(number(Positive), table(OCR_PROFILE: Rows)), optional "1",
        "ratio of overconsolidation, with `ratio`";
    exponent: number(NotNegative), optional "0.8", "exponent of `ocr`, with `ratio`";
    at_least: quantity(Stress, NotNegative), optional "\"0 kPa\"", "no less strength than this, with `ratio`";
    water_level: length, optional "the first condition of the water, or none",
        "level y of water at rest when the ground consolidated, with `ratio`; of the `water_unit_weight` of the case";
}

rows! {
    schema OCR_PROFILE,
    "A ratio of overconsolidation that varies with the level or with the depth.", number(Positive)
}

rows! {
    schema FRICTION_PROFILE,
    "An angle of friction that varies with the level or with the depth; its tangent is linear in between.",
    quantity(Angle, NotNegative)
}

rows! {
    schema PERMEABILITY_PROFILE,
    "A permeability that varies with the level or with the depth.", quantity(Velocity, NotNegative)
}

schema! {
    UNIT_WEIGHT_PROFILE,
    "A unit weight that varies with the level or with the depth, stated alike.";
    growth: part(WEIGHT_GROWTH: Growth);
    table: part(WEIGHT_ROWS: Rows);
    points: part(WEIGHT_POINTS: Points);
}

schema! {
    ANGLE_PROFILE,
    "An angle that varies with the level or with the depth, stated alike.";
    growth: part(ANGLE_GROWTH: Growth);
    table: part(ANGLE_ROWS: Rows);
    points: part(ANGLE_POINTS: Points);
}

schema! {
    NUMBER_PROFILE,
    "A number that varies with the level or with the depth, stated alike.";
    growth: part(NUMBER_GROWTH: Growth);
    table: part(NUMBER_ROWS: Rows);
    points: part(NUMBER_POINTS: Points);
}
