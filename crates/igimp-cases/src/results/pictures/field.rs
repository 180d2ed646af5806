//! A field on the particles at the end of a stage.

use std::path::Path;

use igimp_assembly::{Particles, SharedLaw};

use super::{file_name, sentence, titled, write};
use crate::case::{Case, Field};
use crate::error::CaseError;
use crate::measure::domains;
use crate::results::fields::{self, Dimension, Scale};
use crate::summary::FigureNote;
use igimp_figures::{ColourMap, FieldPlot, Outline, OutlineStyle};

/// A range this many times that of all but [`FEW`] of the values is cut to theirs.
const OUTLYING: f64 = 2.5;
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
    pub fn end_of_stage(case: &Case, stage: usize) -> Self {
        let name = case.stages.get(stage).map_or("", |stage| &stage.name);
        Self {
            name: format!("{}-{}", stage + 1, file_name(name)),
            title: name.to_owned(),
            when: format!("at the end of stage “{name}”"),
        }
    }
}

/// The picture of a field in a state: filled particle domains, the outlines of the undeformed
/// bodies, and further `outlines`, such as a footing where it stands.
///
/// # Errors
/// [`CaseError::File`] and [`CaseError::Figure`].
pub fn field_picture(
    folder: &Path,
    case: &Case,
    shown: &Shown,
    field: Field,
    (particles, laws): (&Particles<2>, &[SharedLaw]),
    outlines: &[Outline],
) -> Result<FigureNote, CaseError> {
    let values = fields::values(field, particles, laws);
    let scale = Scale::of(fields::dimension(field), values.iter().copied());
    let values = scale.apply(&values);
    let (map, range) = colours(field, &values);
    let plot = FieldPlot {
        title: titled(&case.title, &shown.title),
        domains: domains(particles),
        values,
        label: fields::label(field, scale),
        range,
        map,
        outlines: body_outlines(case)
            .chain(outlines.iter().cloned())
            .collect(),
        ..FieldPlot::default()
    };
    let cut = if range.is_some() && matches!(fields::dimension(field), Dimension::Stress) {
        "; the bar leaves out the outermost half percent of the values at either end"
    } else {
        ""
    };
    let caption = format!(
        "{} {}{cut}. Lines: the bodies before they moved.",
        sentence(&fields::plain(fields::title(field))),
        shown.when,
    );
    let name = format!("field-{}-{}", shown.name, fields::name(field));
    write(folder, &name, &plot.draw()?, caption)
}

/// The edges of the undeformed bodies.
pub(super) fn body_outlines(case: &Case) -> impl Iterator<Item = Outline> {
    case.bodies.iter().map(|body| Outline {
        points: body
            .polygon
            .iter()
            .chain(body.polygon.first())
            .copied()
            .collect(),
        style: OutlineStyle::Edge,
    })
}

/// Colour map and range of a field: from zero where the field has no sign, about zero where both
/// signs matter, without a few values that would hide the others.
fn colours(field: Field, values: &[f64]) -> (ColourMap, Option<(f64, f64)>) {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else {
        return (ColourMap::Sequential, None);
    };
    let signed = matches!(
        field,
        Field::DisplacementX | Field::DisplacementY | Field::TauXy
    );
    if signed && -low.min(0.0) > 0.1 * high && high.max(0.0) > -0.1 * low {
        return (ColourMap::Diverging, None);
    }
    match field {
        Field::Utilisation => (ColourMap::Sequential, Some((0.0, 1.0))),
        Field::PlasticStrain | Field::Displacement => {
            let top = if high > 0.0 { high } else { 1.0 };
            (ColourMap::Sequential, Some((0.0, top)))
        }
        _ => {
            let at = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
            let inner = (at(FEW), at(1.0 - FEW));
            let cut = high - low > OUTLYING * (inner.1 - inner.0) && inner.0 < inner.1;
            (ColourMap::Sequential, cut.then_some(inner))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_follow_the_signs_of_a_field() {
        let both = [-3.0, 0.0, 2.0];
        let map = |field, values: &[f64]| colours(field, values).0;
        assert_eq!(map(Field::TauXy, &both), ColourMap::Diverging);
        assert_eq!(map(Field::TauXy, &[1.0, 2.0]), ColourMap::Sequential);
        assert_eq!(map(Field::SigmaYy, &both), ColourMap::Sequential);
        assert_eq!(colours(Field::Utilisation, &both).1, Some((0.0, 1.0)));
        assert_eq!(colours(Field::PlasticStrain, &[0.0]).1, Some((0.0, 1.0)));
        assert_eq!(
            colours(Field::P, &[f64::NAN]),
            (ColourMap::Sequential, None)
        );
    }

    #[test]
    fn a_few_wild_values_do_not_hide_the_others() {
        let mut values: Vec<f64> = (0..1000).map(f64::from).collect();
        assert_eq!(colours(Field::SigmaYy, &values).1, None);
        values[500] = 1e6;
        assert_eq!(colours(Field::SigmaYy, &values).1, Some((5.0, 995.0)));
    }
}
