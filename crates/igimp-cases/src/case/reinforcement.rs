//! Reinforcement: anchors, nails and geotextiles.

/// A member that pulls: it neither bends nor pushes. All forces are per metre run.
#[derive(Clone, Debug, PartialEq)]
pub struct ReinforcementPart {
    /// Name.
    pub name: String,
    /// What it is.
    pub kind: ReinforcementKind,
    /// Its line from the head to the end, in the ground as it stands when it is placed \[m\].
    pub line: Vec<[f64; 2]>,
    /// Axial stiffness EA \[N/m\].
    pub stiffness: f64,
    /// Tension that it carries at most \[N/m\].
    pub capacity: f64,
    /// Bond per length \[N/m²\].
    pub bond: f64,
    /// Force that its plate, or what it is fastened to, carries at the head and at the end \[N/m\].
    pub fastened: [f64; 2],
    /// Length from the head on that has no bond and is one bar \[m\].
    pub free_length: f64,
    /// Ends of the plate on which the force at the head spreads \[m\].
    pub plate: Option<[[f64; 2]; 2]>,
    /// Tension at which it is locked off at the end of the stage that installs it \[N/m\].
    pub prestress: Option<f64>,
    /// Whether a strength reduction divides its bond too.
    pub reduces_bond: bool,
    /// Whether it is there from the start, for no stage installs it.
    pub from_start: bool,
}

impl ReinforcementPart {
    /// Its length \[m\].
    pub fn length(&self) -> f64 {
        let legs = self.line.windows(2);
        legs.map(|leg| (leg[1][0] - leg[0][0]).hypot(leg[1][1] - leg[0][1]))
            .sum()
    }

    /// Most tension at a distance from the head along it, with the whole bond \[N/m\] (theory, eq. 58).
    pub fn limit(&self, at: f64) -> f64 {
        let [head, end] = self.bonded(at);
        let head = self.fastened[0] + head;
        self.capacity.min(head).min(self.fastened[1] + end)
    }

    /// Force of the bond towards the head and towards the end of a place so far from the head \[N/m\].
    pub(crate) fn bonded(&self, at: f64) -> [f64; 2] {
        let from = self.free_length;
        let lengths = [at - from, self.length() - at.max(from)];
        lengths.map(|length| self.bond * length.max(0.0))
    }
}

/// Kinds of reinforcement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReinforcementKind {
    /// A ground anchor: head, free length, bonded length.
    Anchor,
    /// A soil nail, bonded over its whole length.
    Nail,
    /// A geotextile, bonded over its whole length.
    Geotextile,
}

impl ReinforcementKind {
    /// As case files call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Anchor => "anchor",
            Self::Nail => "nail",
            Self::Geotextile => "geotextile",
        }
    }
}

/// A number that a member has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReinforcementQuantity {
    /// Largest tension along it \[N/m\].
    Force,
    /// Tension at its head \[N/m\].
    HeadForce,
    /// Share of its length on which tension is at its limit \[-\].
    AtLimit,
}
