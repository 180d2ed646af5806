//! Output of computed seepage: tables of discharges, files for ParaView, the free surface, pictures.

use std::time::Instant;

use igimp_model::{Case, Every};
use igimp_report::pictures;
use igimp_results::paraview::seepage_grid;
use igimp_results::summary::SetupTable;
use igimp_results::tables::table::Table;
use igimp_seepage::{Discharge, Seepage};
use igimp_text::short;

use super::Output;
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::water::seepage::Followed;

impl<const D: usize> Output<D> {
    /// Flows that were computed: a file for ParaView, the free surface as a table, and pictures.
    pub(crate) fn seepage(&mut self, model: &Model<'_, D>) -> Result<(), CaseError> {
        let clock = Instant::now();
        let case = model.case;
        for (name, flow) in flows(model) {
            let name = pictures::file_name(&format!("seepage-{name}"));
            if self.every != Every::Never {
                let grid = seepage_grid(flow, case.water_unit_weight);
                grid.write(&self.folder.paraview().join(format!("{name}.vtu")))?;
            }
            free_surface(&name, flow).write_csv(&self.folder.sections())?;
            if self.draws {
                let root = self.folder.root();
                let pictures = pictures::seepage_pictures(root, case, &name, flow)?;
                self.figures.extend(pictures);
            }
        }
        for course in &model.courses {
            self.balance_of(case, course)?;
        }
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// The balance of a flow in time as a table, under the name of its last moment.
    fn balance_of(&mut self, case: &Case<D>, course: &Followed) -> Result<(), CaseError> {
        let unit = if case.is_whole() { "m3" } else { "m3/m" };
        let header = ["entered", "left", "stored"].map(|column| format!("{column} [{unit}]"));
        let [entered, left, stored] = &header;
        let columns = [
            "time [s]",
            entered,
            left,
            stored,
            "error over all that moved [-]",
        ];
        let name = format!("seepage-balance-{}", name_of_course(case, course));
        let mut table = Table::new(pictures::file_name(&name), &columns);
        for row in &course.balance {
            table.push(vec![row.time, row.entered, row.left, row.stored, row.error]);
        }
        Ok(table.write_csv(&self.folder.sections())?)
    }
}

/// The free surface above every node of the grid in plan.
fn free_surface<const D: usize>(name: &str, flow: &Seepage<D>) -> Table {
    let header = if D == 2 {
        &["x [m]", "free surface y [m]"][..]
    } else {
        &["x [m]", "y [m]", "free surface z [m]"]
    };
    let mut table = Table::new(name, header);
    let levels = flow.grid.axes[D - 1].node_count();
    // Nodes of the lowest level come first.
    for node in 0..flow.grid.node_count() / levels {
        let place = flow.grid.node_position(node);
        if let Some(level) = flow.free_surface(&place) {
            let plan = place[..D - 1].iter().copied();
            table.push(plan.chain([level]).collect());
        }
    }
    table
}

/// A flow in time is called by its last moment.
fn name_of_course<'c, const D: usize>(case: &'c Case<D>, course: &Followed) -> &'c str {
    (course.conditions.last()).map_or("", |&last| case.water[last].name.as_str())
}

/// The flows of a model, with the names of their conditions.
fn flows<'m, const D: usize>(
    model: &'m Model<'_, D>,
) -> impl Iterator<Item = (&'m str, &'m Seepage<D>)> {
    let conditions = model.case.water.iter().enumerate();
    conditions.filter_map(|(index, condition)| {
        let flow = model.ground_water(index)?.flow()?;
        Some((condition.name.as_str(), &**flow))
    })
}

/// By condition of the water: the outflow of its flow, then the inflow through each section; empty without a flow.
pub(crate) fn by_condition<const D: usize>(model: &Model<'_, D>) -> Vec<Vec<f64>> {
    let of = |condition: usize| {
        let flow = model.ground_water(condition)?.flow()?;
        let sections = flow.sections.iter().map(|section| section.inflow);
        Some(std::iter::once(flow.outflow).chain(sections).collect())
    };
    (0..model.case.water.len())
        .map(|condition| of(condition).unwrap_or_default())
        .collect()
}

/// Tables of discharges, and of how flows were found; empty without computed seepage.
pub(crate) fn tables<const D: usize>(model: &Model<'_, D>) -> Vec<SetupTable> {
    let unit = if model.case.is_whole() {
        "m³/s"
    } else {
        "m³/s per m"
    };
    let (mut through, mut found) = (Vec::new(), Vec::new());
    for (name, flow) in flows(model) {
        through.extend(discharges(name, flow));
        found.push(vec![
            name.to_owned(),
            "as the case draws it".to_owned(),
            flow.unknowns.to_string(),
            flow.corrections.to_string(),
            format!("{:.1e}", flow.residual),
            if flow.confined {
                "all pores are full".to_owned()
            } else {
                format!("{} m, to {}", short(flow.width), short(flow.floor))
            },
        ]);
    }
    if found.is_empty() {
        return Vec::new();
    }
    let header = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    let in_time = SetupTable {
        title: "Seepage: balance in time".to_owned(),
        header: header(&[
            "Water",
            "Time [s]",
            "Steps",
            "Taken back",
            &format!("Entered since the start [{}]", unit.replace("/s", "")),
            "Left",
            "Stored",
            "Error over all that moved",
        ]),
        rows: model
            .courses
            .iter()
            .filter_map(|course| balance(model.case, course))
            .collect(),
    };
    let mut tables = vec![
        SetupTable {
            title: "Seepage: discharges".to_owned(),
            header: header(&[
                "Water",
                "Where",
                &format!("Enters the ground [{unit}]"),
                &format!("Leaves it [{unit}]"),
            ]),
            rows: through,
        },
        SetupTable {
            title: "Seepage: solution".to_owned(),
            header: header(&[
                "Water",
                "Ground",
                "Heads",
                "Corrections",
                "Largest imbalance over the flow",
                "Permeability falls over",
            ]),
            rows: found,
        },
    ];
    if !in_time.rows.is_empty() {
        tables.push(in_time);
    }
    tables
}

/// The balance of a flow in time at its end.
fn balance<const D: usize>(case: &Case<D>, course: &Followed) -> Option<Vec<String>> {
    let end = course.balance.last()?;
    let number = |value: f64| format!("{value:.4e}");
    Some(vec![
        name_of_course(case, course).to_owned(),
        short(end.time),
        (course.balance.len() - 1).to_string(),
        course.cuts.to_string(),
        number(end.entered),
        number(end.left),
        number(end.stored),
        format!("{:.1e}", end.error),
    ])
}

fn discharges<const D: usize>(name: &str, flow: &Seepage<D>) -> Vec<Vec<String>> {
    let number = |value: f64| format!("{value:.4e}");
    let row = |place: &str, ends: [String; 2]| {
        let [enters, leaves] = ends;
        vec![name.to_owned(), place.to_owned(), enters, leaves]
    };
    let flows = |flux: &&Discharge| flux.inflow > 0.0 || flux.outflow > 0.0;
    let mut rows: Vec<Vec<String>> = (flow.discharges.iter().filter(flows))
        .map(|flux| row(&flux.name, [flux.inflow, flux.outflow].map(number)))
        .collect();
    rows.push(row("all", [flow.inflow, flow.outflow].map(number)));
    if let Some(outflow) = flow.outflow_at_lower_floor {
        let place = format!("all, with a floor of {}", short(0.1 * flow.floor));
        rows.push(row(&place, [outflow, outflow].map(number)));
    }
    rows.extend(flow.sections.iter().map(|section| {
        let place = format!("section {}, towards the positive axis", section.name);
        row(&place, [number(section.inflow), String::new()])
    }));
    rows
}
