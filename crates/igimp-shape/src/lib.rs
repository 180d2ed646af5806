//! igimp-shape.
