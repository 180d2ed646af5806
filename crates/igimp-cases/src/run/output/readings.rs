//! Tables, sections and checks of earlier stages that stay where a run begins with a later stage: all that is read
//! from the same as then.

use igimp_model::{Case, Quantity};
use igimp_report::pictures;
use igimp_results::checkpoint::sha256;
use igimp_results::folder::{Folder, clear_tables, remove_picture};
use igimp_results::summary::CheckRow;
use igimp_results::tables::rows;
use igimp_results::tables::table::Table;

use super::checks;
use super::records::Records;
use super::sections::stage_name;
use crate::error::CaseError;
use crate::run::resume::Notes;
use crate::run::resume::readings::{Readings, TableReading};

/// The folders of tables that grow by a row a moment, with a word for the tables in them.
const GROWING: [(&str, &str); 3] = [
    ("curves", "curve"),
    ("monitors", "monitor"),
    ("rigid", "rigid body"),
];

/// The source of a quantity: a monitor by the particles around its place.
pub(super) fn of_quantity(records: &Records, quantity: Quantity) -> String {
    match quantity {
        Quantity::Monitor(monitor, field) => format!("{field:?} of {:?}", records.watched[monitor]),
        other => format!("{other:?}"),
    }
}

/// The sources of everything in a case, before its first stage.
pub(super) fn of_case<const D: usize>(case: &Case<D>, records: &Records) -> Readings {
    let mut readings = Readings::default();
    let curves = case.curves.iter().map(|curve| {
        let axes = [&curve.x, &curve.y];
        let read = axes.map(|axis| (of_quantity(records, axis.of), axis.divide_by));
        format!("{read:?} {:?}", curve.stage)
    });
    let monitors = std::iter::zip(&case.monitors, &records.watched);
    let monitors = monitors.map(|(monitor, place)| format!("{:?} {place:?}", monitor.record));
    let rigid = case.rigid.iter().map(|_| String::new());
    let by_folder: [Vec<String>; 3] = [curves.collect(), monitors.collect(), rigid.collect()];
    let tables = [&records.curves, &records.monitors, &records.rigid];
    for ((folder, _), (tables, texts)) in std::iter::zip(GROWING, std::iter::zip(tables, by_folder))
    {
        for (table, text) in std::iter::zip(tables, texts) {
            let definition = sha256(format!("{text} {:?}", table.header).as_bytes());
            let reading = TableReading {
                definition,
                ..TableReading::default()
            };
            readings.tables.insert(key(folder, &table.name), reading);
        }
    }
    for line in &case.sections {
        let read = (line.from, line.to, line.points, &line.record, line.average);
        let definition = sha256(format!("{read:?}").as_bytes());
        readings.sections.insert(line.name.clone(), definition);
    }
    readings
}

/// The name of a table among the readings.
fn key(folder: &str, table: &str) -> String {
    format!("{folder}/{table}")
}

/// By curve, the first stage whose rows it has.
pub(super) fn curves_since<const D: usize>(case: &Case<D>, readings: &Readings) -> Vec<usize> {
    let since = |name: &str| readings.tables.get(&key("curves", name));
    let curves = case.curves.iter();
    curves
        .map(|curve| since(&curve.name).map_or(0, |table| table.since))
        .collect()
}

/// The sources of rows of checks at the end of a stage: those of quantities, then those of sections.
pub(super) fn of_rows<const D: usize>(
    case: &Case<D>,
    records: &Records,
    stage: usize,
    of_sections: &[(usize, CheckRow)],
) -> Vec<String> {
    let asked = checks::asked(case, stage);
    let quantities = asked.map(|(_, check)| {
        let read = (of_quantity(records, check.of), check.divide_by, check.at);
        sha256(format!("{stage} {read:?}").as_bytes())
    });
    let sections = of_sections.iter().map(|(section, row)| {
        let quantity = &row.check.quantity;
        let line = &case.sections[*section];
        let read = (line.from, line.to, line.points, line.average);
        sha256(format!("{stage} {quantity} {read:?}").as_bytes())
    });
    quantities.chain(sections).collect()
}

/// The results of earlier stages that are kept, and warnings of the rest.
pub(super) struct Kept {
    /// The notes of the checkpoint, as far as they hold for the case as it is.
    pub(super) notes: Notes,
    /// Losses, for the user.
    pub(super) warnings: Vec<String>,
    /// By kept stage, the sections whose tables stay.
    sections: Vec<Vec<String>>,
}

/// A case that begins with a stage other than its first, in the folder of an earlier run.
pub(super) struct Beginning<'b, const D: usize> {
    pub(super) folder: &'b Folder,
    pub(super) case: &'b Case<D>,
    pub(super) records: &'b Records,
    /// Number of the stage, from 0.
    pub(super) stage: usize,
}

impl<const D: usize> Beginning<'_, D> {
    /// Holds the sources of the case against the notes at the end of the stage before; nothing is changed.
    pub(super) fn kept(&self, before: &Notes) -> Result<Kept, CaseError> {
        let mut kept = Kept {
            notes: before.clone(),
            warnings: Vec::new(),
            sections: vec![Vec::new(); self.stage],
        };
        let mut now = of_case(self.case, self.records);
        kept.notes.curve_rows = self.rows(&mut now, before, 0, &mut kept.warnings)?;
        kept.notes.monitor_rows = self.rows(&mut now, before, 1, &mut kept.warnings)?;
        kept.notes.rigid_rows = self.rows(&mut now, before, 2, &mut kept.warnings)?;
        kept.notes.readings = now;
        self.sections(before, &mut kept);
        self.checks(before, &mut kept)?;
        kept.notes.peaks = Vec::new();
        Ok(kept)
    }

    /// By table of a folder, how many rows are kept.
    fn rows(
        &self,
        now: &mut Readings,
        before: &Notes,
        folder: usize,
        warnings: &mut Vec<String>,
    ) -> Result<Vec<usize>, CaseError> {
        let tables = [
            &self.records.curves,
            &self.records.monitors,
            &self.records.rigid,
        ][folder];
        let (name, kind) = GROWING[folder];
        let mut kept = Vec::new();
        for (k, table) in tables.iter().enumerate() {
            let key = key(name, &table.name);
            let reading = now.tables.entry(key.clone()).or_default();
            let old = before.readings.tables.get(&key);
            let path = self.folder.root().join(format!("{key}.csv"));
            if let Some(old) = old.filter(|old| old.definition == reading.definition)
                && (old.rows == 0 || rows::digest(&path, old.rows)?.as_ref() == Some(&old.digest))
            {
                kept.push(old.rows);
                reading.since = old.since;
                continue;
            }
            kept.push(0);
            reading.since = self.stage;
            let is_of_earlier = match folder {
                0 => self.case.curves[k].stage.is_none_or(|of| of < self.stage),
                1 => true,
                _ => old.is_some_and(|old| old.rows > 0),
            };
            if is_of_earlier {
                let begins = &self.case.stages[self.stage].name;
                warnings.push(format!(
                    "{kind} \"{}\" is not what the stages before \"{begins}\" recorded, and {key}.csv has no rows of them; \
                     {REMEDY}",
                    table.name
                ));
            }
        }
        Ok(kept)
    }

    /// Finds the tables of sections that stay, and drops the pictures of those that go.
    fn sections(&self, before: &Notes, kept: &mut Kept) {
        let old = &before.readings.sections;
        for (stage, stays) in kept.sections.iter_mut().enumerate() {
            let same = self
                .case
                .sections
                .iter()
                .map(|section| &section.name)
                .filter(|name| {
                    let path = self.table_of_section(name, stage);
                    old.get(*name) == kept.notes.readings.sections.get(*name) && path.is_file()
                });
            stays.extend(same.cloned());
            let name = &self.case.stages[stage].name;
            kept.notes.figures.retain(|figure| {
                let gone = old.keys().filter(|section| !stays.contains(section));
                !gone
                    .clone()
                    .any(|section| pictures::is_of_section(figure, section, name))
            });
            let is_read = before.stages[stage].safety.is_none();
            for section in self.case.sections.iter().filter(|_| is_read) {
                if !stays.contains(&section.name) {
                    kept.warnings.push(format!(
                        "section \"{}\" is not what stage \"{name}\" recorded, and has no table of that stage; {REMEDY}",
                        section.name
                    ));
                }
            }
        }
    }

    /// The file of a section at the end of a stage.
    fn table_of_section(&self, section: &str, stage: usize) -> std::path::PathBuf {
        let name = format!("{section}__{}.csv", stage_name(self.case, stage));
        self.folder.sections().join(name)
    }

    /// The checks of the kept stages as the case has them now, with the values that were read from the same.
    fn checks(&self, before: &Notes, kept: &mut Kept) -> Result<(), CaseError> {
        let found: Vec<(&String, &CheckRow)> =
            std::iter::zip(&before.readings.checks, &before.checks).collect();
        let (mut held, mut read_from) = (Vec::new(), Vec::new());
        for (number, summary) in before.stages.iter().enumerate().take(self.stage) {
            let stays = &kept.sections[number];
            let of_sections = self.checks_of_sections(number, stays)?;
            let names = of_rows(self.case, self.records, number, &of_sections);
            let quantities = checks::not_held(self.case, number).into_iter();
            let sections = of_sections.into_iter().map(|(section, row)| {
                let stays = stays.contains(&self.case.sections[section].name);
                (stays, row)
            });
            let rows = quantities.map(|row| (true, row)).chain(sections);
            for (reading, (stays, row)) in std::iter::zip(&names, rows) {
                let old = found.iter().find(|(name, _)| stays && *name == reading);
                if old.is_none() {
                    kept.warnings.push(format!(
                        "check \"{}\" is not reached: what it reads was not recorded in stage \"{}\", which is kept; {REMEDY}",
                        row.check.quantity, summary.name
                    ));
                }
                held.push(checks::held_again(row, old.map(|(_, old)| *old)));
            }
            read_from.extend(names);
        }
        (kept.notes.checks, kept.notes.readings.checks) = (held, read_from);
        Ok(())
    }

    /// The checks of sections at the end of a kept stage, by their tables in the folder.
    fn checks_of_sections(
        &self,
        stage: usize,
        stays: &[String],
    ) -> Result<Vec<(usize, CheckRow)>, CaseError> {
        let read = |name: &String| {
            if stays.contains(name) {
                rows::read(&self.table_of_section(name, stage))
            } else {
                Ok(Table::new("", &[]))
            }
        };
        let sections = self.case.sections.iter();
        let tables: Result<Vec<Table>, _> = sections.map(|section| read(&section.name)).collect();
        Ok(checks::of_sections(self.case, stage, &tables?, false))
    }

    /// Removes the tables that are no longer of this case, and those that its stages write anew.
    pub(super) fn clear(&self, before: &Notes, kept: &Kept) -> Result<(), CaseError> {
        let tables = &kept.notes.readings.tables;
        for (folder, _) in &GROWING[..2] {
            let is_gone = |name: &str| !tables.contains_key(&key(folder, name));
            clear_tables(&self.folder.root().join(folder), &is_gone)?;
        }
        let stages: Vec<String> = (0..self.stage)
            .map(|number| format!("__{}", stage_name(self.case, number)))
            .collect();
        let old = &before.readings.sections;
        clear_tables(&self.folder.sections(), &|name: &str| {
            let mut of_kept = std::iter::zip(&stages, &kept.sections);
            !of_kept.any(|(stage, stays)| {
                let section = name.strip_suffix(stage.as_str());
                section.is_some_and(|section| {
                    !old.contains_key(section) || stays.iter().any(|stays| stays == section)
                })
            })
        })?;
        for figure in &before.figures {
            if !kept.notes.figures.contains(figure) {
                remove_picture(self.folder.root(), &figure.file)?;
            }
        }
        Ok(())
    }
}

/// The remedy for rows that are not there.
const REMEDY: &str = "run the case from its beginning for them";
