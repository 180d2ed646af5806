//! Every law on random states in every regime, counted: `cargo test --release -p igimp-material --test contract every_regime -- --nocapture`
//! tries a million states a law.

use std::sync::Arc;

use igimp_material::{ConstitutiveModel, History, PointContext, Principal, Regime, Tensor};

use crate::random::Random;
use crate::returns::{dot, size};
use crate::{catalogue, hardening_soil, hoek_brown, memory, softening, undrained};

/// States of a law, all its sets of parameters together.
pub(crate) const STATES: usize = if cfg!(debug_assertions) {
    20_000
} else {
    1_000_000
};

/// A trial strain, the history before it, and the duration of the step.
type State = (Principal, History, f64);

/// A law with one set of parameters, and random states of it.
struct Tried {
    law: Arc<dyn ConstitutiveModel>,
    draw: Box<dyn Fn(&mut Random) -> State>,
}

/// Every law of the crate, with all its sets.
fn all() -> Vec<(&'static str, Vec<Tried>)> {
    let mut tried: Vec<(&'static str, Vec<Tried>)> = Vec::new();
    let mut add = |law: Arc<dyn ConstitutiveModel>, draw: Box<dyn Fn(&mut Random) -> State>| {
        let name = law.name();
        let case = Tried { law, draw };
        match tried.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sets)) => sets.push(case),
            None => tried.push((name, vec![case])),
        }
    };
    for entry in catalogue::all() {
        let law = Arc::clone(&entry.law);
        let history = History::of_plastic_strain(0.1);
        add(
            law,
            Box::new(move |random| (entry.any(random), history, 0.0)),
        );
    }
    for law in softening::families().into_iter().flatten() {
        let draw = |random: &mut Random| {
            let kappa = [0.0, random.between(0.0, 0.3)][random.below(2)];
            (softening::trial(random), softening::sheared(kappa), 0.0)
        };
        add(law, Box::new(draw));
    }
    for (row, _, law) in hoek_brown::laws() {
        let draw =
            move |random: &mut Random| (hoek_brown::trial(row, random), History::default(), 0.0);
        add(law, Box::new(draw));
    }
    for law in memory::laws() {
        let copy = law;
        let draw = move |random: &mut Random| {
            let (history, elastic) = memory::start(&copy, random);
            (memory::trial(&elastic, 0.3, random), history, 0.0)
        };
        add(Arc::new(law), Box::new(draw));
    }
    for law in hardening_soil::laws() {
        let copy = law;
        let draw = move |random: &mut Random| {
            let (history, elastic) = hardening_soil::start(&copy, random);
            (hardening_soil::trial(&elastic, random), history, 0.0)
        };
        add(Arc::new(law), Box::new(draw));
    }
    for (law, _) in undrained::laws() {
        let copy = law.clone();
        let draw = move |random: &mut Random| undrained::state(&copy, random);
        add(Arc::new(law), Box::new(draw));
    }
    tried
}

/// The demands on an answer. A strength that goes with the rate is checked by `undrained`, where it is known.
fn check(law: &dyn ConstitutiveModel, (strain, history, duration): &State) -> Regime {
    let about = || format!("{law:?} {strain:?} {history:?} {duration:e}");
    let answer = law
        .return_map(strain, history, &PointContext::over(*duration))
        .unwrap_or_else(|error| panic!("{} {error}", about()));
    let tangent: &Tensor = &answer.tangent;
    let mut numbers = tangent.as_flattened().iter().chain(&answer.tau);
    assert!(numbers.all(|v| v.is_finite()), "{}", about());
    assert!(answer.history.internal.iter().all(|v| v.is_finite()));
    assert!(answer.history.eps_p_eq >= history.eps_p_eq, "{}", about());
    if *duration == 0.0 {
        let excess = law.yield_function(&answer.tau, &answer.history);
        let round_off = 1e-12 * law.stress_scale(&answer.tau);
        assert!(excess <= round_off, "{} {excess:e}", about());
    }
    let work = dot(&answer.tau, &answer.delta_eps_p);
    let flow = size(&answer.delta_eps_p);
    assert!(work >= -1e-12 * size(&answer.tau) * flow, "{}", about());
    answer.regime
}

/// GOAL: of random states of every law none has a number that is not finite, a stress beyond the surface by more than 1e-12 of the stresses
/// it is a difference of, a tangent that is not finite, or negative plastic work; every law flows, and regimes are counted.
#[test]
fn no_state_of_any_law_goes_wrong() {
    for (name, sets) in all() {
        let mut met = [0_usize; 12];
        let each = STATES / sets.len() + 1;
        for (set, tried) in sets.iter().enumerate() {
            let mut random = Random(90 + set as u64);
            for _ in 0..each {
                let state = (tried.draw)(&mut random);
                met[usize::from(check(&*tried.law, &state).code())] += 1;
            }
        }
        let named: Vec<String> = (met.iter().zip(0..))
            .filter(|(count, _)| **count > 0)
            .map(|(count, code)| format!("{:?} {count}", Regime::from_code(code).unwrap()))
            .collect();
        println!("{name}: {}", named.join(", "));
        let flows = met[1..].iter().sum::<usize>();
        let yields = sets.iter().any(|tried| tried.law.yields());
        assert_eq!(flows > 0, yields, "{name}");
        // Two edges of planes, and of a cut-off all regimes beside the apex of soil without one.
        let least = match name {
            "Hencky elastic" => 1,
            "Tresca" => 4,
            "Mohr-Coulomb" => 10,
            "Hardening Soil" => 7,
            _ => 2,
        };
        assert!(named.len() >= least, "{name}: {named:?}");
    }
}
