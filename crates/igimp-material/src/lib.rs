//! igimp-material.
