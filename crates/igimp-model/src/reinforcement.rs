//! Reinforcement: anchors, nails and geotextiles.

/// A member that pulls: it neither bends nor pushes. In the plane all forces are per metre run, in space they are its own.
#[derive(Clone, Debug, PartialEq)]
pub struct ReinforcementPart<const D: usize> {
    /// Name.
    pub name: String,
    /// Its kind.
    pub kind: ReinforcementKind,
    /// Its line from the head to the end, in the ground as it stands when it is placed \[m\].
    pub line: Vec<[f64; D]>,
    /// Axial stiffness EA \[N/m, in space N\].
    pub stiffness: f64,
    /// Tension that it carries at most \[N/m, in space N\].
    pub capacity: f64,
    /// Bond per length \[N/m², in space N/m\].
    pub bond: f64,
    /// Force that its plate, or its fastening, carries at the head and at the end \[N/m, in space N\].
    pub fastened: [f64; 2],
    /// Length from the head on that has no bond and is one bar \[m\].
    pub free_length: f64,
    /// The plate on which the force at the head spreads: its ends, in space three of its corners, the first one that
    /// between the others \[m\].
    pub plate: Option<Vec<[f64; D]>>,
    /// Tension at which it is locked off at the end of the stage that installs it \[N/m, in space N\].
    pub prestress: Option<f64>,
    /// Whether a strength reduction divides its bond too.
    pub reduces_bond: bool,
    /// Whether it is there from the start, for no stage installs it.
    pub from_start: bool,
}

impl<const D: usize> ReinforcementPart<D> {
    /// Its length \[m\].
    pub fn length(&self) -> f64 {
        let legs = self.line.windows(2);
        legs.map(|leg| distance(&leg[0], &leg[1])).sum()
    }

    /// Most tension at a distance from the head along it, with the whole bond \[N/m, in space N\] (theory, eq. 58).
    pub fn limit(&self, at: f64) -> f64 {
        let [head, end] = self.bonded(at);
        let head = self.fastened[0] + head;
        self.capacity.min(head).min(self.fastened[1] + end)
    }

    /// Force of the bond towards the head and towards the end of a place so far from the head \[N/m\].
    pub fn bonded(&self, at: f64) -> [f64; 2] {
        let from = self.free_length;
        let lengths = [at - from, self.length() - at.max(from)];
        lengths.map(|length| self.bond * length.max(0.0))
    }
}

/// The distance of two places \[m\].
pub fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let way: [f64; D] = std::array::from_fn(|axis| b[axis] - a[axis]);
    way[..D - 1]
        .iter()
        .rev()
        .fold(way[D - 1], |so_far, side| side.hypot(so_far))
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
