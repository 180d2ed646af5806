//! Results of a study of the mesh error over the size of the cells.

use std::path::Path;

use igimp_figures::{
    Band, Colour, CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Series, SeriesStyle,
};
use igimp_results::mesh_study::{ResultKind, StudyResult, StudySummary};
use igimp_results::summary::{CheckRow, FigureNote, Summary};

use super::{file_name, titled, write};
use crate::error::ReportError;

/// Room to either side of the meshes, as a share of the largest cells \[-\].
const ROOM: f64 = 0.06;

/// The pictures of the results of a study, one each: the values over the size of the cells, the
/// extrapolated value at no size with its uncertainty, and for a check the value expected. A check of
/// a result that another picture shows has none.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn mesh_pictures(folder: &Path, summary: &Summary) -> Result<Vec<FigureNote>, ReportError> {
    let Some(study) = &summary.mesh_study else {
        return Ok(Vec::new());
    };
    let mut notes = Vec::new();
    for (number, result) in study.results.iter().enumerate() {
        let shown =
            |other: &StudyResult| other.values == result.values && other.kind != ResultKind::Check;
        if result.kind == ResultKind::Check && study.results[..number].iter().any(shown) {
            continue;
        }
        let expected = summary.checks.iter().filter(|row| {
            let same = study
                .results
                .iter()
                .filter(|other| other.values == result.values);
            same.into_iter()
                .any(|other| other.name == row.check.quantity)
        });
        let plot = plot(
            &summary.title,
            study,
            result,
            expected.collect::<Vec<_>>().first(),
        );
        let name = format!("mesh-study-{}-{}", number + 1, file_name(&result.name));
        notes.push(write(folder, &name, &plot.draw()?, caption(study, result))?);
    }
    Ok(notes)
}

fn plot(
    case_title: &str,
    study: &StudySummary,
    result: &StudyResult,
    expected: Option<&&CheckRow>,
) -> CurvePlot {
    let in_si = result.unit.as_ref().map_or(1.0, |unit| unit.in_si);
    let result = &result.as_printed();
    // A run that ended early has no value of its mesh.
    let arrived = (study.meshes.iter().enumerate()).filter(|(mesh, _)| !result.ended_early(*mesh));
    let computed: Vec<([f64; 2], f64)> = arrived
        .filter_map(|(number, mesh)| {
            let value = (*result.values.get(number)?)?;
            Some(([1.0 / mesh.parts as f64, value], result.half_widths[number]))
        })
        .collect();
    let points = computed.iter().map(|(point, _)| *point).collect();
    let solid = SeriesStyle::LineAndMarkers(LineStyle::Solid);
    let mut series = vec![Series::new("computed", points, solid).in_colour(Colour::CURVE)];
    for ([x, y], width) in computed.iter().filter(|(_, width)| *width > 0.0) {
        let ends = vec![[*x, y - width], [*x, y + width]];
        series.push(Series::line("", ends).in_colour(Colour::CURVE));
    }
    let mut bands = Vec::new();
    if let (Some(found), Some((finest, _))) = (result.estimate, computed.last()) {
        let way = vec![[0.0, found.value], *finest];
        let dashed = SeriesStyle::Line(LineStyle::Dashed);
        series.push(Series::new("", way, dashed).in_colour(Colour::CURVE));
        let reach = found.rounded_uncertainty();
        let level = |y: f64| vec![[-0.5 * ROOM, y], [0.5 * ROOM, y]];
        bands.push(Band {
            label: found.sentence(),
            lower: level(found.value - reach),
            upper: level(found.value + reach),
        });
        let mark = Series::markers(found.lead(), vec![[0.0, found.value]]);
        series.push(mark.in_colour(Colour::BLACK));
    }
    let lines = expected.map(|row| ReferenceLine {
        label: format!("expected {}", row.check.printed(row.check.expected)),
        at: ReferenceValue::Y(row.check.expected / in_si),
    });
    CurvePlot {
        title: titled(case_title, "mesh error"),
        x_label: "size of the cells over that of the case [−]".into(),
        y_label: result.name.replace("[-]", "[−]"),
        x_range: Some((-ROOM, 1.0 + ROOM)),
        bands,
        lines: lines.into_iter().collect(),
        series,
        ..CurvePlot::default()
    }
}

fn caption(study: &StudySummary, result: &StudyResult) -> String {
    let result = result.as_printed();
    let arrived = |mesh: usize| result.values[mesh].is_some() && !result.ended_early(mesh);
    let labels: Vec<String> = (study.meshes.iter().enumerate())
        .filter(|(number, _)| arrived(*number))
        .map(|(_, mesh)| mesh.label())
        .collect();
    let early: Vec<String> = (study.meshes.iter().enumerate())
        .filter(|(number, _)| result.ended_early(*number))
        .map(|(_, mesh)| mesh.label())
        .collect();
    let found = match result.estimate {
        Some(found) => format!(
            "By all meshes, {}: {} (order {}).",
            found.lead(),
            found.sentence(),
            found.order.sentence()
        ),
        None if early.is_empty() => "Of fewer than two values nothing is extrapolated.".to_owned(),
        None => format!(
            "Nothing is extrapolated: on {} the run ended early.",
            early.join(", ")
        ),
    };
    format!(
        "{} on the meshes {}. {found}",
        result.name,
        labels.join(", ")
    )
}
