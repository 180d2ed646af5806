//! Resources requested from a scheduler: memory and time of the largest tasks, with a margin.

use igimp_cases::CaseError;
use igimp_estimate::speed::Speed;
use igimp_estimate::{estimate, time};
use igimp_model::{Case, meshes};
use rayon::prelude::*;

use super::{Sweep, SweepError, Task};

/// Memory asked for over the estimate \[-\].
const MEMORY: f64 = 1.5;
/// Memory is asked for in pieces of this size \[bytes\].
const PIECE: f64 = 100.0 * 1_048_576.0;
/// Memory of a rank beside factors and particles: programs, libraries and messages of PETSc and MPI \[bytes\].
const RANK: f64 = 100.0 * 1_048_576.0;
/// Time asked for over the estimate \[-\].
const TIME: f64 = 3.0;
/// And on top of it, for the start and for what is saved at the end \[s\].
const MORE_TIME: f64 = 300.0;

/// Resources of a task: enough for the largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resources {
    /// Threads.
    pub threads: usize,
    /// Ranks, each with as many threads.
    pub ranks: usize,
    /// The task that needs most memory \[bytes\].
    pub memory: Largest,
    /// The task that takes longest \[s\].
    pub time: Largest,
}

/// A task that needs most of something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest {
    /// Its number.
    pub task: usize,
    /// Its estimate.
    pub estimate: f64,
}

impl Resources {
    /// Memory to ask for: 1.5 times the estimate, and for several ranks 100 MiB each, in pieces of 100 MiB \[MiB\].
    pub fn mebibytes(&self) -> u64 {
        let of_ranks = if self.ranks > 1 {
            RANK * self.ranks as f64
        } else {
            0.0
        };
        (100.0 * ((MEMORY * self.memory.estimate + of_ranks) / PIECE).ceil()) as u64
    }

    /// Time to ask for: three times the estimate and five minutes \[min\].
    pub fn minutes(&self) -> u64 {
        ((TIME * self.time.estimate + MORE_TIME) / 60.0).ceil() as u64
    }
}

impl Sweep {
    /// Resources for each of these tasks with those numbers of threads and ranks, on a computer of that speed; `None` without
    /// tasks.
    ///
    /// # Errors
    /// [`SweepError`] for a task that makes no case, or cannot be set up.
    pub fn demand(
        &self,
        tasks: &[&Task],
        (threads, ranks): (usize, usize),
        speed: Speed,
    ) -> Result<Option<Resources>, SweepError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let needs = |task: &&Task| -> Result<(usize, [f64; 2]), SweepError> {
            let file = self.case_of(task)?;
            let needs = igimp_model::in_any_dimension!(file.any_case(), case => of_case(case, threads, speed))?;
            Ok((task.number, needs))
        };
        let all: Vec<_> = match pool {
            Ok(pool) => pool.install(|| tasks.par_iter().map(needs).collect::<Result<_, _>>())?,
            Err(_) => tasks.iter().map(needs).collect::<Result<_, _>>()?,
        };
        let largest = |index: usize| {
            let most = all.iter().max_by(|a, b| a.1[index].total_cmp(&b.1[index]));
            most.map(|&(task, needs)| Largest {
                task,
                estimate: needs[index],
            })
        };
        let both = largest(0).zip(largest(1));
        Ok(both.map(|(memory, time)| Resources {
            threads,
            ranks,
            memory,
            time,
        }))
    }
}

/// Memory \[bytes\] and time \[s\] of a case; of a study of the mesh error, of all its meshes.
fn of_case<const D: usize>(
    case: &Case<D>,
    threads: usize,
    speed: Speed,
) -> Result<[f64; 2], CaseError> {
    let (mut memory, mut seconds) = (0.0_f64, 0.0);
    for mesh in meshes::meshes(case) {
        let size = estimate(&mesh)?;
        // Several threads run meshes side by side.
        memory = if threads > 1 {
            memory + size.most_bytes
        } else {
            memory.max(size.most_bytes)
        };
        seconds += time::time(&mesh, &size, speed).seconds;
    }
    Ok([memory, seconds])
}
