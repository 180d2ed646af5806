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
        let mut rows: Vec<[f64; 3]> = Vec::new();
        for (number, stage) in summary.stages.iter().enumerate() {
            let safety = stage.safety.as_ref();
            let Some((stable, failed)) = safety.and_then(|fos| fos.stable.zip(fos.failed)) else {
                continue;
            };
            if let Some(time) = case.time_of_water_after(number) {
                rows.push([time, stable, failed]);
            } else {
                let factor = 0.5 * (stable + failed);
                found.limits.push((stage.name.clone(), factor));
            }
        }
        if rows.is_empty() {
            return Ok(None);
        }
        // Times may be stated in any order.
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        for [time, stable, failed] in rows {
            table.push(vec![time, stable, failed]);
            found.points.push([time, 0.5 * (stable + failed)]);
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
