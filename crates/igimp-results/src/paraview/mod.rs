//! Files for ParaView: frames of particles, grid, rigid bodies and reinforcement.

pub mod film;
pub mod frames;
pub mod particles;
pub mod pvd;
pub mod read_back;
mod seepage;

pub use seepage::seepage_grid;
