//! Fields along the sections of a case at the end of a stage.

use igimp_assembly::AssemblyError;

use super::model::Model;
use super::state::State;
use crate::case::Case;
use crate::measure::nearest;
use crate::results::fields;
use crate::results::pictures::file_name;
use crate::table::Table;

/// Number and name of a stage as part of a file name.
fn stage_name(case: &Case, stage: usize) -> String {
    format!("{}-{}", stage + 1, file_name(&case.stages[stage].name))
}

/// One table per section, named `SECTION__STAGE`: the particles nearest to equally spaced places
/// along the line, each once, with the foot of the particle on the line. Places without a particle
/// within a cell are left out. Values are as the particles hold them, neither averaged nor
/// interpolated; the share of mobilised strength is that of the strength that acts.
pub(crate) fn read(
    model: &Model<'_>,
    state: &State,
    stage: usize,
) -> Result<Vec<Table>, AssemblyError> {
    let case = model.case;
    let particles = &state.body.particles;
    let laws = model.laws_reduced_by(&state.controls.srf)?;
    let tables = case
        .sections
        .iter()
        .map(|section| {
            let mut header: Vec<String> = ["distance_[m]", "x_[m]", "y_[m]"]
                .map(str::to_owned)
                .to_vec();
            header.extend(section.record.iter().map(|&field| fields::header(field)));
            let mut table = Table {
                name: format!("{}__{}", section.name, stage_name(case, stage)),
                header,
                rows: Vec::new(),
            };
            let way = [0, 1].map(|axis| section.to[axis] - section.from[axis]);
            let length = way[0].hypot(way[1]);
            let mut last = None;
            for k in 0..section.points {
                let t = (k as f64 + 0.5) / section.points as f64;
                let place = [0, 1].map(|axis| section.from[axis] + t * way[axis]);
                let [width, height] = case.grid.cell_at(place);
                let reach = width.max(height);
                let Some(particle) = nearest(particles, &place, reach) else {
                    continue;
                };
                if last.replace(particle) == Some(particle) {
                    continue;
                }
                let x = particles.x[particle];
                let along = [0, 1].map(|axis| (x[axis] - section.from[axis]) * way[axis]);
                let mut row = vec![(along[0] + along[1]) / length, x[0], x[1]];
                row.extend(
                    section
                        .record
                        .iter()
                        .map(|&field| fields::value(field, particles, particle, &laws)),
                );
                table.push(row);
            }
            table
        })
        .collect();
    Ok(tables)
}
