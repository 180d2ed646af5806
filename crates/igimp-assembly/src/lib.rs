//! igimp-assembly.
