//! Every law with several sets of parameters, and trial states to try it on.

use std::sync::Arc;

use igimp_material::{
    Cone, ConstitutiveModel, DruckerPrager, Elasticity, HenckyElastic, History, MohrCoulomb,
    PointContext, Principal, Regime, Tresca, VonMises,
};

use crate::random::Random;

/// Parameters of the planes of Tresca and Mohr–Coulomb; angles in radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes {
    pub(crate) cohesion: f64,
    pub(crate) friction: f64,
    pub(crate) dilation: f64,
    pub(crate) cutoff: Option<f64>,
}

/// A law with its parameters.
pub(crate) struct Entry {
    pub(crate) label: String,
    pub(crate) law: Arc<dyn ConstitutiveModel>,
    /// A typical stress on the yield surface.
    pub(crate) strength: f64,
    pub(crate) planes: Option<Planes>,
    /// Every regime that the law has.
    pub(crate) regimes: Vec<Regime>,
}

/// Young's modulus and Poisson's ratio.
const ELASTIC: [(f64, f64); 4] = [(100.0, 0.3), (1e5, 0.49), (50.0, 0.0), (200.0, 0.4999)];

/// Yield strength, for each of the elastic sets.
const STRENGTHS: [f64; 4] = [1.0, 45.0, 3.0, 0.5];

/// Cohesion, friction and dilation in degrees, cut-off, elastic set.
const MOHR_COULOMB: [(f64, f64, f64, Option<f64>, usize); 12] = [
    (10.0, 20.0, 0.0, None, 1),
    (1.0, 30.0, 30.0, None, 0),
    (1.0, 25.0, 5.0, None, 0),
    (0.0, 35.0, 5.0, None, 0),
    (0.0, 30.0, 0.0, None, 3),
    (2.0, 0.0, 0.0, None, 0),
    (5.0, 45.0, 10.0, None, 2),
    (1.0, 20.0, 0.0, Some(0.5), 0),
    (1.0, 30.0, 30.0, Some(0.0), 0),
    (2.0, 0.0, 0.0, Some(1.0), 2),
    (1.0, 25.0, 25.0, Some(1.0), 3),
    (1.0, 25.0, 0.0, Some(2.1), 1),
];

/// Cohesion, friction and dilation in degrees, cone, elastic set.
const DRUCKER_PRAGER: [(f64, f64, f64, Cone, usize); 8] = [
    (10.0, 20.0, 0.0, Cone::PlaneStrain, 1),
    (1.0, 30.0, 30.0, Cone::PlaneStrain, 0),
    (1.0, 25.0, 5.0, Cone::Compression, 0),
    (0.0, 35.0, 5.0, Cone::Extension, 0),
    (2.0, 0.0, 0.0, Cone::PlaneStrain, 0),
    (5.0, 45.0, 10.0, Cone::Compression, 2),
    (1.0, 25.0, 25.0, Cone::Extension, 3),
    (1.0, 40.0, 40.0, Cone::Compression, 0),
];

fn elasticity(set: usize) -> Elasticity {
    Elasticity::new(ELASTIC[set].0, ELASTIC[set].1).unwrap()
}

fn entry(
    law: impl ConstitutiveModel + 'static,
    parameters: &str,
    strength: f64,
    planes: Option<Planes>,
    regimes: &[Regime],
) -> Entry {
    let label = format!("{} {parameters}", law.name());
    Entry {
        label,
        law: Arc::new(law),
        strength,
        planes,
        regimes: regimes.to_vec(),
    }
}

/// Every law, one list of parameter sets per law.
pub(crate) fn families() -> Vec<Vec<Entry>> {
    let sets = 0..ELASTIC.len();
    let elastic = |set: usize| {
        let law = HenckyElastic::new(elasticity(set));
        entry(
            law,
            &format!("#{set}"),
            STRENGTHS[set],
            None,
            &[Regime::Elastic],
        )
    };
    let von_mises = |set: usize| {
        let law = VonMises::from_undrained_strength(elasticity(set), STRENGTHS[set]).unwrap();
        let regimes = [Regime::Elastic, Regime::Smooth];
        entry(law, &format!("#{set}"), STRENGTHS[set], None, &regimes)
    };
    let tresca = |set: usize| {
        let law = Tresca::new(elasticity(set), STRENGTHS[set]).unwrap();
        let planes = Planes {
            cohesion: STRENGTHS[set],
            friction: 0.0,
            dilation: 0.0,
            cutoff: None,
        };
        let regimes = [
            Regime::Elastic,
            Regime::Smooth,
            Regime::RightEdge,
            Regime::LeftEdge,
        ];
        entry(
            law,
            &format!("#{set}"),
            STRENGTHS[set],
            Some(planes),
            &regimes,
        )
    };
    vec![
        sets.clone().map(elastic).collect(),
        sets.clone().map(von_mises).collect(),
        sets.map(tresca).collect(),
        (0..MOHR_COULOMB.len()).map(mohr_coulomb).collect(),
        (0..DRUCKER_PRAGER.len()).map(drucker_prager).collect(),
    ]
}

fn drucker_prager(row: usize) -> Entry {
    let (cohesion, friction, dilation, cone, set) = DRUCKER_PRAGER[row];
    let angles = [friction, dilation].map(f64::to_radians);
    let law = DruckerPrager::new(elasticity(set), cohesion, angles[0], angles[1], cone).unwrap();
    let mut regimes = vec![Regime::Elastic, Regime::Smooth];
    if friction > 0.0 {
        regimes.push(Regime::Apex);
    }
    let parameters = format!("{:?}", DRUCKER_PRAGER[row]);
    entry(law, &parameters, cohesion.max(0.5), None, &regimes)
}

fn mohr_coulomb(row: usize) -> Entry {
    let (cohesion, friction, dilation, cutoff, set) = MOHR_COULOMB[row];
    let (friction, dilation) = (f64::to_radians(friction), f64::to_radians(dilation));
    let mut law = MohrCoulomb::new(elasticity(set), cohesion, friction, dilation).unwrap();
    if let Some(cutoff) = cutoff {
        law = law.with_tension_cutoff(cutoff).unwrap();
    }
    let mut regimes = vec![
        Regime::Elastic,
        Regime::Smooth,
        Regime::RightEdge,
        Regime::LeftEdge,
    ];
    if cutoff.is_some() {
        regimes.extend([
            Regime::Tension,
            Regime::TensionShear,
            Regime::TensionEdge,
            Regime::TensionCorner,
            Regime::TensionApex,
        ]);
    } else if friction > 0.0 {
        regimes.push(Regime::Apex);
    }
    let parameters = format!("{:?}", MOHR_COULOMB[row]);
    let planes = Planes {
        cohesion,
        friction,
        dilation,
        cutoff,
    };
    entry(law, &parameters, cohesion.max(0.5), Some(planes), &regimes)
}

/// Every law with every parameter set.
pub(crate) fn all() -> Vec<Entry> {
    families().into_iter().flatten().collect()
}

/// The sets whose yield strains are percents: those that finite strain can be tried on.
pub(crate) fn soft() -> Vec<Entry> {
    all()
        .into_iter()
        .filter(|entry| entry.yield_strain() > 2e-3)
        .collect()
}

/// Those of [`soft`] whose stress keeps enough digits for differences of 1e-7: not with a bulk
/// modulus thousands of times the shear modulus.
pub(crate) fn differentiable() -> Vec<Entry> {
    let ratio =
        |entry: &Entry| entry.law.stiffness_bound().bulk() / entry.law.stiffness_bound().shear();
    soft()
        .into_iter()
        .filter(|entry| ratio(entry) < 100.0)
        .collect()
}

impl Entry {
    /// A typical strain at yield.
    pub(crate) fn yield_strain(&self) -> f64 {
        self.strength / self.law.stiffness_bound().young()
    }

    /// Trial strains around and beyond the yield surface, of general position.
    pub(crate) fn general(&self, random: &mut Random) -> Principal {
        let size = self.yield_strain() * 10_f64.powf(random.between(-0.5, 1.5));
        let stretch = 10_f64.powf(random.between(-4.0, 0.5));
        let middle = size * random.symmetric() * stretch;
        let values: Principal = random.values(size);
        let mean = values.iter().sum::<f64>() / 3.0;
        values.map(|value| middle + value - mean)
    }

    /// Trial strains of all kinds, degenerate ones included.
    pub(crate) fn any(&self, random: &mut Random) -> Principal {
        let mut strain = self.general(random);
        let [i, j] = [random.below(3), random.below(3)];
        match random.below(12) {
            0 => strain[i] = strain[j],
            1 => strain = [strain[i]; 3],
            // On the surface, at a vertex or on an edge, and beside it.
            2 => strain = self.returned(&strain),
            3 => {
                let beside = 10_f64.powf(random.between(-16.0, -6.0)) * random.symmetric();
                strain = self.returned(&strain).map(|value| value * (1.0 + beside));
            }
            4 => {
                strain = self.returned(&strain);
                strain[i] += self.yield_strain() * random.symmetric();
            }
            5 => strain = random.values(1e3),
            6 => strain = random.values(1e-14),
            7 => {
                let middle = random.symmetric() * 10_f64.powf(random.between(-3.0, 3.0));
                strain = strain.map(|value| middle + value);
            }
            8 => strain[i] = 0.0,
            _ => {}
        }
        strain
    }

    /// The elastic strain that the law returns a trial strain to.
    fn returned(&self, strain: &Principal) -> Principal {
        let answer = self
            .law
            .return_map(strain, &History::default(), &PointContext::STATIC)
            .unwrap();
        self.law.stiffness_bound().strain(&answer.tau)
    }
}
