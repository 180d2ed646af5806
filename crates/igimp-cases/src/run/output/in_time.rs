//! Factors of safety against the time of the water: a table and a picture.

use igimp_model::Case;
use igimp_report::pictures::{self, SafetyInTime};
use igimp_results::summary::{FigureNote, Summary};
use igimp_results::tables::table::Table;

use super::Output;
use crate::error::CaseError;

/// Name of the table and of the picture.
const NAME: &str = "safety-in-time";

impl<const D: usize> Output<D> {
    /// The table of all searches whose water is that of a time, and their picture; nothing without one.
    pub(super) fn safety_in_time(
        &self,
        case: &Case<D>,
        summary: &Summary,
    ) -> Result<Option<FigureNote>, CaseError> {
        let mut found = SafetyInTime::default();
        let columns = ["time [s]", "F at least [-]", "F below [-]"];
        let mut table = Table::new(NAME, &columns);
        for (number, stage) in summary.stages.iter().enumerate() {
            let safety = stage.safety.as_ref();
            let Some((stable, failed)) = safety.and_then(|own| own.stable.zip(own.failed)) else {
                continue;
            };
            let factor = 0.5 * (stable + failed);
            match case.time_of_water_after(number) {
                Some(time) => {
                    table.push(vec![time, stable, failed]);
                    found.points.push([time, factor]);
                }
                None => found.limits.push((stage.name.clone(), factor)),
            }
        }
        if found.points.is_empty() {
            return Ok(None);
        }
        table.write_csv(&self.folder.curves())?;
        if !self.draws {
            return Ok(None);
        }
        let (root, title) = (self.folder.root(), &case.title);
        let picture =
            pictures::safety_in_time_picture(root, title, "curve-safety-in-time", &found)?;
        Ok(Some(picture))
    }
}
