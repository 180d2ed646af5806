//! igimp-cases.
