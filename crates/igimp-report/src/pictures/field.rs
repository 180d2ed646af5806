//! A field on the particles at the end of a stage.

use std::path::Path;

use igimp_assembly::{Particles, SharedLaw};
use igimp_figures::{ColourMap, FieldPlot, Outline, OutlineStyle, Scale as AxisScale};
use igimp_model::{Case, Field};
use igimp_results::fields::{self, Scale};
use igimp_results::summary::FigureNote;
use igimp_text::short;

use super::{axes_of, file_name, sentence, titled, water, write};
use crate::error::ReportError;
use crate::patches::{Carriers, Pieces};

/// A range this many times that of all but [`FEW`] of the values is cut to theirs.
const OUTLYING: f64 = 1.2;
/// Share of values at either end that may lie beyond the colour bar.
const FEW: f64 = 0.005;

/// The state that a picture shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Part of the names of its files.
    pub name: String,
    /// Part of the title.
    pub title: String,
    /// When that was; reads on from "Displacement".
    pub when: String,
}

impl Shown {
    /// The end of stage number `stage` of a case.
    pub fn end_of_stage<const D: usize>(case: &Case<D>, stage: usize) -> Self {
        let name = case.stages.get(stage).map_or("", |stage| &stage.name);
        Self {
            name: format!("{}-{}", stage + 1, file_name(name)),
            title: name.to_owned(),
            when: format!("at the end of stage “{name}”"),
        }
    }

    /// The same with its time \[s\], of a stage that takes time.
    #[must_use]
    pub fn at_time(self, time: f64) -> Self {
        let time = short(time);
        Self {
            title: format!("{}, t = {time} s", self.title),
            when: format!("{}, at t = {time} s", self.when),
            ..self
        }
    }
}

/// The context that the pictures of a run share.
#[derive(Clone, Copy, Debug)]
pub struct Canvas<'a> {
    /// The results folder.
    pub folder: &'a Path,
    /// The case.
    pub case: &'a Case<2>,
    /// Its bodies in pieces.
    pub pieces: &'a Pieces,
}

/// Lines and labels over a field: structures where they stand.
#[derive(Clone, Debug, Default)]
pub struct Over {
    /// Lines.
    pub outlines: Vec<Outline>,
    /// Words beside points (x, y) \[m\].
    pub labels: Vec<([f64; 2], String)>,
}

/// A state as its fields are computed.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a, const D: usize> {
    /// The particles.
    pub particles: &'a Particles<D>,
    /// The laws that they refer to.
    pub laws: &'a [SharedLaw],
}

impl<const D: usize> Seen<'_, D> {
    /// The values of a field by particle.
    pub(super) fn values(&self, field: Field) -> Vec<f64> {
        fields::values(field, self.particles, self.laws)
    }
}

/// The picture of a field in a state: the bodies in pieces, coloured by their particles, their edges as
/// they moved and as they were, and structures `over` them where they stand.
///
/// Unit and colours are those of the state and of the states that it is `compared` with.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn field_picture(
    canvas: &Canvas<'_>,
    shown: &Shown,
    field: Field,
    state: Seen<'_, 2>,
    compared: &[Seen<'_, 2>],
    over: &Over,
) -> Result<FigureNote, ReportError> {
    let case = canvas.case;
    let particles = state.particles;
    let values = state.values(field);
    let mut all = values.clone();
    all.extend(compared.iter().flat_map(|other| other.values(field)));
    let scale = Scale::of(field.dimension(), all.iter().copied());
    let colours = Colours::of(field, &scale.apply(&all));
    let (domains, whose) = canvas.pieces.now(particles);
    let total = if case.has_pore_water() && field.is_total() {
        "total "
    } else {
        ""
    };
    let plot = FieldPlot {
        title: titled(&case.title, &shown.title),
        domains,
        values: whose.iter().map(|&k| values[k] / scale.divide_by).collect(),
        label: format!(
            "{total}{}{}",
            fields::label_in(axes_of(case), field, scale),
            colours.note()
        ),
        range: colours.range,
        map: colours.map,
        outlines: edges(case, canvas.pieces, particles)
            .into_iter()
            .chain(over.outlines.iter().cloned())
            .collect(),
        labels: over.labels.clone(),
        ..FieldPlot::default()
    };
    let same = if compared.is_empty() {
        ""
    } else {
        " Colours and unit are the same in both states of the search."
    };
    let members = if over.labels.is_empty() {
        ""
    } else {
        " Heavy lines: reinforcement, its tension beside it, the largest of each in numbers."
    };
    let caption = format!(
        "{} {}. Lines: the edges of the bodies; dashed: before they moved{}.{members}{same}",
        sentence(&format!(
            "{total}{}",
            fields::plain(field.title_in(axes_of(case)))
        )),
        shown.when,
        water::legend(&over.outlines),
    );
    let name = format!("field-{}-{}", shown.name, field.name());
    write(canvas.folder, &name, &plot.draw()?, caption)
}

/// The edges of the bodies as they were, and as the particles carry them.
pub(crate) fn edges<'a>(
    case: &Case<2>,
    pieces: &Pieces,
    particles: impl Into<Carriers<'a>>,
) -> Vec<Outline> {
    let particles = particles.into();
    let there = pieces.there(particles);
    let former = std::iter::zip(body_outlines(case), there);
    let former = former
        .filter(|(_, there)| *there)
        .map(|(outline, _)| Outline {
            style: OutlineStyle::Former,
            ..outline
        });
    let moved = pieces.edges(particles).into_iter();
    let moved = moved.map(|points| Outline {
        points,
        style: OutlineStyle::Edge,
    });
    former.chain(moved).collect()
}

/// The edges of the undeformed bodies.
pub(super) fn body_outlines(case: &Case<2>) -> impl Iterator<Item = Outline> {
    case.bodies.iter().map(|body| Outline {
        points: body
            .polygon()
            .iter()
            .chain(body.polygon().first())
            .copied()
            .collect(),
        style: OutlineStyle::Edge,
    })
}

/// How values become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colours {
    pub(crate) map: ColourMap,
    pub(crate) range: Option<(f64, f64)>,
    /// Whether the range leaves out the outermost values at its low and at its high end.
    pub(crate) cut: (bool, bool),
}

impl Colours {
    /// From zero where a field has no sign, about zero where both signs matter, without the few values
    /// that would pale all others; without a range where its ends are equal but for rounding, so that the picture finds one.
    pub(crate) fn of(field: Field, values: &[f64]) -> Self {
        let colours = Self::between(field, values);
        match colours.range {
            Some(range) if !AxisScale::Linear.accepts(range) => Self {
                range: None,
                cut: (false, false),
                ..colours
            },
            _ => colours,
        }
    }

    /// The same, whether or not its range can be drawn.
    fn between(field: Field, values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let whole = Self {
            map: ColourMap::Sequential,
            range: None,
            cut: (false, false),
        };
        let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else {
            return whole;
        };
        let at = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
        let (inner_low, inner_high) = (at(FEW), at(1.0 - FEW));
        let signed = matches!(
            field,
            Field::DisplacementX
                | Field::DisplacementY
                | Field::DisplacementZ
                | Field::TauXy
                | Field::TauYz
                | Field::TauXz
                | Field::UExcess
                | Field::VelocityX
                | Field::VelocityY
                | Field::VelocityZ
                | Field::AccelerationX
                | Field::AccelerationY
                | Field::AccelerationZ
        );
        if signed && -low.min(0.0) > 0.1 * high && high.max(0.0) > -0.1 * low {
            let (reach, inner) = (
                low.abs().max(high.abs()),
                inner_low.abs().max(inner_high.abs()),
            );
            let cut = inner > 0.0 && reach > OUTLYING * inner;
            return Self {
                map: ColourMap::Diverging,
                range: cut.then_some((-inner, inner)),
                cut: (cut && low < -inner, cut && high > inner),
            };
        }
        match field {
            Field::Utilisation => Self {
                range: Some((0.0, 1.0)),
                ..whole
            },
            Field::PlasticStrain | Field::Displacement | Field::Speed | Field::Acceleration => {
                let cut = inner_high > 0.0 && high > OUTLYING * inner_high;
                let top = if cut { inner_high } else { high };
                Self {
                    range: Some((0.0, if top > 0.0 { top } else { 1.0 })),
                    cut: (false, cut),
                    ..whole
                }
            }
            _ => {
                let width = inner_high - inner_low;
                let cut = (
                    inner_low - low > (OUTLYING - 1.0) * width,
                    high - inner_high > (OUTLYING - 1.0) * width,
                );
                let range = (
                    if cut.0 { inner_low } else { low },
                    if cut.1 { inner_high } else { high },
                );
                let some = width > 0.0 && (cut.0 || cut.1);
                Self {
                    range: some.then_some(range),
                    cut: (some && cut.0, some && cut.1),
                    ..whole
                }
            }
        }
    }

    /// A note on the colour bar for values beyond its range.
    pub(crate) fn note(&self) -> &'static str {
        match self.cut {
            (false, false) => "",
            (true, false) => "; bar from 0.5 % of the particles",
            (false, true) => "; bar to 99.5 % of the particles",
            (true, true) => "; bar from 0.5 to 99.5 % of the particles",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_follow_the_signs_of_a_field() {
        let both = [-3.0, 0.0, 2.0];
        let map = |field, values: &[f64]| Colours::of(field, values).map;
        assert_eq!(map(Field::TauXy, &both), ColourMap::Diverging);
        assert_eq!(map(Field::TauXy, &[1.0, 2.0]), ColourMap::Sequential);
        assert_eq!(map(Field::SigmaYy, &both), ColourMap::Sequential);
        let range = |field, values: &[f64]| Colours::of(field, values).range;
        assert_eq!(range(Field::Utilisation, &both), Some((0.0, 1.0)));
        assert_eq!(range(Field::PlasticStrain, &[0.0]), Some((0.0, 1.0)));
        assert_eq!(range(Field::P, &[f64::NAN]), None);
    }

    /// GOAL: a field that is even but for rounding and a few values has a picture; the run ended with its colour bar.
    /// CASE: an excess pore pressure of 9.9975 kPa with differences of 1e-12, one value that is larger, and one of nothing; a speed of 1e-200.
    /// ORACLE: the ranges that figures take.
    #[test]
    fn an_even_field_has_a_range_that_can_be_drawn() {
        let mut values: Vec<f64> = (0..1000).map(|k| 9.9975 + 1e-15 * f64::from(k)).collect();
        let plain = Colours::of(Field::UExcess, &values);
        assert_eq!((plain.range, plain.note()), (None, ""));
        for wild in [12.0, 0.0] {
            values[500] = wild;
            for &field in Field::ALL {
                let colours = Colours::of(field, &values);
                let is_drawn = colours
                    .range
                    .is_none_or(|range| AxisScale::Linear.accepts(range));
                assert!(is_drawn, "{field:?}: {:?}", colours.range);
            }
            let colours = Colours::of(Field::UExcess, &values);
            assert_eq!((colours.range, colours.note()), (None, ""));
        }
        assert_eq!(Colours::of(Field::Speed, &[1e-200]).range, None);
    }

    /// GOAL: a single particle neither pales a field nor goes unsaid, whatever the field.
    #[test]
    fn a_few_wild_values_do_not_hide_the_others() {
        let mut values: Vec<f64> = (0..1000).map(f64::from).collect();
        for &field in Field::ALL {
            assert_eq!(Colours::of(field, &values).note(), "", "{field:?}");
        }
        values[500] = 1e6;
        let of = |field| Colours::of(field, &values);
        let stress = of(Field::SigmaYy);
        assert_eq!(
            (stress.range, stress.cut),
            (Some((0.0, 995.0)), (false, true))
        );
        assert!(stress.note().contains("99.5 %"));
        for field in [Field::Displacement, Field::PlasticStrain] {
            assert_eq!(
                (of(field).range, of(field).cut),
                (Some((0.0, 995.0)), (false, true))
            );
        }
        values[400] = -1e6;
        let shear = Colours::of(Field::TauXy, &values);
        assert_eq!((shear.map, shear.cut), (ColourMap::Diverging, (true, true)));
        assert_eq!(shear.range, Some((-995.0, 995.0)));
    }
}
