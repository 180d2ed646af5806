//! igimp-solver.
