//! Strength by the over-nonlocal measure of plastic strain: a point and the ground around it (theory, eqs. 110a to 110c).

use super::Softening;
use crate::error::{positive, required};
use crate::law::trial_stress;
use crate::spectral::principal::{descending, sorted};
use crate::{History, MaterialError, Nonlocal, NonlocalRates, PointContext, Principal, ReturnMap};

impl Nonlocal {
    fn check(&self) -> Result<(), MaterialError> {
        positive("length", self.length)?;
        let is_share = self.over_nonlocal >= 1.0 && self.over_nonlocal.is_finite();
        required(
            "over_nonlocal",
            self.over_nonlocal,
            is_share,
            "1 or more, and finite",
        )
    }

    /// The measure $`m \bar\kappa + (1 - m) \kappa`$ \[-\] of a plastic strain and that of the ground around.
    pub(super) fn measure(&self, kappa: f64, around: f64) -> f64 {
        self.over_nonlocal * around + self.local_share() * kappa
    }

    /// The share 1 − m of a point's own plastic strain \[-\].
    pub(super) fn local_share(&self) -> f64 {
        1.0 - self.over_nonlocal
    }
}

impl Softening {
    /// The law with a strength that goes with the over-nonlocal measure of plastic strain in place of that of the point; the
    /// nonlocal strain is an internal variable, and its rise in a step is given ([`nonlocal_rise`]).
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of a length that is not positive, a share below 1, strength that stays or goes with a
    /// rate, and strength that hardens so steeply that the stress of a point snaps back.
    ///
    /// [`nonlocal_rise`]: crate::PointContext::nonlocal_rise
    pub fn with_nonlocal(mut self, nonlocal: Nonlocal) -> Result<Self, MaterialError> {
        nonlocal.check()?;
        let goes = self.softens() && self.rate.is_none();
        let requirement = "absent: a strength that goes with plastic strain, and not with its rate, sees the ground around";
        required("length", nonlocal.length, goes, requirement)?;
        self.nonlocal = Some(nonlocal);
        self.without_snap_back()
    }

    /// Where the nonlocal strain stands among the internal variables, if the law has it.
    pub(super) fn place_of_nonlocal(&self) -> Option<usize> {
        (self.nonlocal).map(|_| 1 + usize::from(self.directions.is_some()))
    }

    /// The rest of elastic stiffness beside softening by a point's own plastic strain \[-\]; above 1 it hardens.
    pub(super) fn margin(&self, by_kappa: f64) -> f64 {
        1.0 - self.local_share() * by_kappa
    }

    /// The return at a point and in a step, with the rates of plastic and nonlocal strain. The tangent is that at
    /// held strength, and that of the change of strength, $`\partial\tau/\partial\kappa \otimes \mathrm{d}\kappa/\mathrm{d}\varepsilon`$
    /// (theory, eqs. 108 and 110c).
    pub(super) fn returned(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let stress = trial_stress(&self.elasticity, eps_e_trial)?;
        let moment = self.moment(history, context);
        let before = self.plastic_strain(history);
        let measure = self.measure(before, history);
        let held = self.kind.held(self.elasticity, measure, &moment)?;
        if self.is_perfect() {
            return held.return_map(&self.elasticity, eps_e_trial, history);
        }
        let stress = sorted(&stress, &descending(&stress));
        let ratio = context.strain_ratio;
        let first = (held.strained(&self.elasticity, (eps_e_trial, &stress))?).of_soil(ratio);
        if !first.is_plastic {
            return held.return_map(&self.elasticity, eps_e_trial, history);
        }
        let trial = (eps_e_trial, &stress);
        let (kappa, held) = self.settled(trial, (history, moment), (held, first))?;
        let answer = (held.answer(&self.elasticity, eps_e_trial, history)?).of_soil(ratio);
        let (margin, local) = (self.margin(answer.by_kappa), self.local_share());
        let mut map = answer.map;
        for (row, rate) in map.tangent.iter_mut().zip(answer.stress_rate) {
            for (entry, along) in row.iter_mut().zip(answer.by_trial) {
                *entry += local * rate * along / margin;
            }
        }
        if self.softens() {
            map.history.internal[0] = kappa;
        }
        let around = self.nonlocal.map_or(0.0, |nonlocal| nonlocal.over_nonlocal);
        map.nonlocal = NonlocalRates {
            plastic: answer.strain,
            plastic_by_strain: answer.by_trial.map(|along| along / margin),
            plastic_by_nonlocal: around * answer.by_kappa / margin,
            stress_by_nonlocal: answer.stress_rate.map(|rate| around * rate / margin),
        };
        Ok(map)
    }
}
