//! Results of the runs of a case on several meshes: factors of safety, limit loads and checks, each with the orders
//! that it may have.
//!
//! [`run`](crate::run::run) computes a case whose [`mesh_study`](igimp_model::Case::mesh_study) asks for more than one mesh on all
//! of them; its [`Summary`](igimp_results::summary::Summary) has the results.

mod found;
#[cfg(test)]
mod found_tests;

pub use found::study;
pub(crate) use found::{check_rows, remarks};
