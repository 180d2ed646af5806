//! GOAL: a study that a scheduler runs ends with the same bytes as one that is run here, though its tasks are
//! killed, stopped by their time, begun twice and at the same time.
//! CASE: a block of elastic soil, pushed in many steps; four tasks.
//! ORACLE: `igimp sweep --jobs 2` left alone.
//!
//! HyperQueue and Slurm are the real ones. Where they are not, a line says so:
//!
//! | test | needs |
//! |---|---|
//! | `hyperqueue.rs` | a Python that can import `hyperqueue`: `python3`, or the one that `IGIMP_HYPERQUEUE` names |
//! | `slurm.rs` | `IGIMP_SLURM=1`; `slurmctld`, `slurmd`, `sbatch` and `munged` (four minutes); for tasks of several ranks `IGIMP_MPI`, the folder of igimp-mpi |

#![cfg(unix)]

mod hyperqueue;
#[path = "../run_support/mod.rs"]
mod run_support;
mod scripts;
mod slurm;
mod study;
mod turns;
