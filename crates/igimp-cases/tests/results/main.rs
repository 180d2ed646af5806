//! GOAL: results are shown whole and true: the report, particles in space, the files for ParaView and numpy.

mod paraview;
mod report;
mod space;
