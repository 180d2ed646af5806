//! Random rigid bodies that are pressed into soil, pulled, pushed, turned and let go.

pub(crate) mod forces;
pub(crate) mod outline;
pub(crate) mod scene;
mod shape;
mod site;
pub(crate) mod table;
pub(crate) mod through;

pub(crate) use scene::Scene;
