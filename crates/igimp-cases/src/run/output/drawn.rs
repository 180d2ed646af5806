//! Pictures of states: fields, the way in which a body fails, the set-up.

use std::sync::Arc;
use std::time::Instant;

use igimp_assembly::SharedLaw;
use igimp_model::{Case, Every, in_plane};
use igimp_report::outlines::Outlines;
use igimp_report::patches::Pieces;
use igimp_report::pictures::{self, Canvas, Failing, Seen, Shown, mechanism};
use igimp_results::paraview::frames::{Scene, StateOfSearch};
use igimp_results::paraview::read_back::FrameParticles;
use igimp_results::rigid;
use igimp_results::summary::StageSummary;
use rayon::prelude::*;

use super::Output;
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::output::outlines;
use crate::run::resume::End;
use crate::run::state::State;

/// The state at an end of a search, with its name.
type Named<const D: usize> = (&'static str, End<D>);

/// The states at the ends of a search with the equilibria before them. The one that failed has moved most and comes first; where
/// no step led to it, the stable one tells.
fn failing<const D: usize>(
    kept: &[Named<D>],
    stage: usize,
) -> impl Iterator<Item = (Failing<'_, D>, &State<D>)> {
    kept.iter().rev().filter_map(move |(label, end)| {
        let failing = Failing {
            stage,
            srf: end.srf,
            label,
            before: &end.before.as_ref()?.particles,
            last: &end.state.body.particles,
        };
        Some((failing, &end.state))
    })
}

impl<const D: usize> Output<D> {
    /// Frames and pictures of the states at the ends of a search, and of the way in which the body fails.
    pub(super) fn ends_of_search(
        &mut self,
        model: &Model<'_, D>,
        number: usize,
        summary: &StageSummary,
    ) -> Result<(), CaseError> {
        let kept = std::mem::take(&mut self.kept);
        let stage = format!("stage-{:02}", number + 1);
        for (label, End { srf, state, .. }) in &kept {
            let name = format!("{stage}-{label}");
            if self.every != Every::Never {
                let laws = model.laws_reduced_by(&state.controls.srf)?;
                let structures = outlines::structures(model.case, &state.controls, &state.body);
                for member in &structures.reinforcement {
                    let table = member.table(format!("{}__{name}", member.part.name));
                    table.write_csv(&self.folder.reinforcement())?;
                }
                let scene = Scene {
                    particles: &state.body.particles,
                    laws: &laws,
                    structures: &structures,
                };
                self.frames.beside(&name, &scene)?;
            }
            let shown = Shown {
                title: format!("{}, SRF {srf:.4}", summary.name),
                when: format!("in the {} state, SRF {srf:.4}", label.replace('-', " ")),
                name,
            };
            let others = kept.iter().filter(|(other, _)| other != label);
            let others: Vec<&State<D>> = others.map(|(_, end)| &end.state).collect();
            self.field_pictures(model, &shown, state, &others)?;
        }
        if self.every != Every::Never && !kept.is_empty() {
            let state = |(name, end): &(&'static str, End<D>)| StateOfSearch { name, srf: end.srf };
            let states: Vec<StateOfSearch> = kept.iter().map(state).collect();
            self.frames.collect(&stage, &summary.name, &states)?;
        }
        if let (Some(case), Some(kept)) =
            (in_plane(model.case), in_plane::<_, Vec<Named<2>>>(&kept))
        {
            return self.mechanism(case, model, number, kept);
        }
        let (Some(case), Some(kept)) = (in_plane(model.case), in_plane::<_, Vec<Named<3>>>(&kept))
        else {
            return Ok(());
        };
        let surface = failing(kept, number).find_map(|(way, _)| pictures::slip_surface(&way, case));
        match surface {
            Some(table) => Ok(table.write_csv(&self.folder.slip_lines())?),
            None => Ok(()),
        }
    }

    /// The way in which the body fails: the slip line as a table, and its picture.
    fn mechanism(
        &mut self,
        case: &Case<2>,
        model: &Model<'_, D>,
        number: usize,
        kept: &[Named<2>],
    ) -> Result<(), CaseError> {
        for (failing, state) in failing(kept, number) {
            let Some(found) = mechanism(&failing) else {
                continue;
            };
            if let Some(table) = found.table(case, number) {
                table.write_csv(&self.folder.slip_lines())?;
            }
            if !case.output.figures.is_empty() {
                let pieces = self.pieces(case)?;
                let canvas = Canvas {
                    folder: self.folder.root(),
                    case,
                    pieces: &pieces,
                };
                let over = outlines::of_state(case, model, state);
                let picture = pictures::mechanism_picture(&canvas, &failing, &found, &over)?;
                self.figures.push(picture);
            }
            break;
        }
        Ok(())
    }

    /// The bodies in pieces, cut once.
    pub(super) fn pieces(&mut self, case: &Case<2>) -> Result<Arc<Pieces>, CaseError> {
        let pieces = match &self.pieces {
            Some(pieces) => Arc::clone(pieces),
            None => Arc::new(Pieces::of(case)?),
        };
        self.pieces = Some(Arc::clone(&pieces));
        Ok(pieces)
    }

    /// The edges of the bodies in space, found once.
    fn edges(&mut self, case: &Case<3>) -> Result<Arc<Outlines>, CaseError> {
        let edges = match &self.edges {
            Some(edges) => Arc::clone(edges),
            None => Arc::new(Outlines::of(case)?),
        };
        self.edges = Some(Arc::clone(&edges));
        Ok(edges)
    }

    /// The pictures of the fields that the case wants to see, with the units and colours that suit the
    /// state and the states that it is compared with.
    pub(super) fn field_pictures(
        &mut self,
        model: &Model<'_, D>,
        shown: &Shown,
        state: &State<D>,
        compared: &[&State<D>],
    ) -> Result<(), CaseError> {
        let wanted = &model.case.output.figures;
        if wanted.is_empty() {
            return Ok(());
        }
        let laws = model.laws_reduced_by(&state.controls.srf)?;
        let reduced = compared
            .iter()
            .map(|state| model.laws_reduced_by(&state.controls.srf))
            .collect::<Result<Vec<_>, _>>()?;
        let reduced: Vec<&[SharedLaw]> = reduced.iter().map(|laws| &laws[..]).collect();
        if let Some(state) = in_plane::<_, State<3>>(state) {
            let compared = compared
                .iter()
                .filter_map(|state| in_plane::<_, State<3>>(*state));
            let compared: Vec<Seen<'_, 3>> = std::iter::zip(compared, &reduced)
                .map(|(state, laws)| Seen {
                    particles: &state.body.particles,
                    laws,
                })
                .collect();
            return self.pictures_in_space(model, shown, state, &laws, &compared);
        }
        let (Some(case), Some(state)) = (in_plane(model.case), in_plane::<_, State<2>>(state))
        else {
            return Ok(());
        };
        let pieces = self.pieces(case)?;
        let canvas = Canvas {
            folder: self.folder.root(),
            case,
            pieces: &pieces,
        };
        let seen = Seen {
            particles: &state.body.particles,
            laws: &laws,
        };
        let compared: Vec<Seen<'_, 2>> = std::iter::zip(compared, &reduced)
            .filter_map(|(state, laws)| {
                let particles = &in_plane::<_, State<2>>(*state)?.body.particles;
                Some(Seen { particles, laws })
            })
            .collect();
        let over = outlines::of_state(case, model, state);
        let drawn = wanted
            .par_iter()
            .map(|&field| pictures::field_picture(&canvas, shown, field, seen, &compared, &over))
            .collect::<Result<Vec<_>, _>>()?;
        self.figures.extend(drawn);
        Ok(())
    }

    /// The same in space: the surface, and cuts through the middle.
    fn pictures_in_space(
        &mut self,
        model: &Model<'_, D>,
        shown: &Shown,
        state: &State<3>,
        laws: &[SharedLaw],
        compared: &[Seen<'_, 3>],
    ) -> Result<(), CaseError> {
        let case = model.case;
        let Some(in_space) = in_plane::<_, Case<3>>(case) else {
            return Ok(());
        };
        let structures = outlines::structures(in_space, &state.controls, &state.body);
        let cells = rigid::cells(&structures.rigid);
        let corners = cells.connectivity.as_chunks::<3>().0.iter();
        let bodies = corners.map(|corners| corners.map(|point| cells.points[point]));
        let particles = &state.body.particles;
        let edges = self.edges(in_space)?.now(&FrameParticles {
            x: particles.x.clone(),
            def_grad: particles.def_grad.clone(),
            number: particles.number.clone(),
        });
        let seen = Seen { particles, laws };
        let (root, pore_water) = (self.folder.root(), case.has_pore_water());
        let drawn = pictures::InSpace::new(
            root,
            &case.title,
            pore_water,
            seen,
            bodies.collect(),
            &edges,
        );
        let condition = state.controls.water.and_then(|k| case.water.get(k));
        let drawn = drawn.with_water(
            condition
                .map(|water| water.source.clone())
                .into_iter()
                .collect(),
        );
        let planes = match &case.output.cuts[..] {
            [] => drawn.middle(),
            cuts => cuts.to_vec(),
        };
        let wanted = &case.output.figures;
        let notes = wanted
            .par_iter()
            .map(|&field| drawn.pictures(shown, field, compared, &planes))
            .collect::<Result<Vec<_>, _>>()?;
        self.figures.extend(notes.concat());
        Ok(())
    }

    /// The picture of the set-up.
    pub(crate) fn model_picture(&mut self, case: &Case<D>) -> Result<(), CaseError> {
        if !self.draws {
            return Ok(());
        }
        let clock = Instant::now();
        if let Some(case) = in_plane(case) {
            let picture = pictures::model_picture(self.folder.root(), case)?;
            self.figures.push(picture);
        }
        self.seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }
}
