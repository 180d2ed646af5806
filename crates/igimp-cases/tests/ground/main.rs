//! GOAL: the ground of a case is the ground that its file draws: outlines, solids, grids, particles, properties from place to place.

#[path = "../common/edits.rs"]
mod edits;
#[path = "../common/resuming.rs"]
mod resuming;

mod drawings;
mod folder;
mod free_faces;
mod grid_lines;
mod meshes;
mod parameters;
mod pieces;
mod profiles;
mod rasters;
mod seeding;
mod shared_cells;
mod softening_friction;
mod softening_profiles;
mod solid_bodies;
mod solids;

use igimp_input::CaseFile;
use igimp_model::Case;

/// A block of soil, 4 m by 2 m.
fn block() -> Case<2> {
    let text = include_str!("../../../igimp-estimate/tests/data/block.toml");
    let file = CaseFile::parse("block.toml", text, &[]);
    file.unwrap().case().clone()
}
