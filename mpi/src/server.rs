//! The part of the program that all ranks run: rank 0 hands commands on, and all of them follow.

use std::collections::HashMap;
use std::sync::mpsc::{Receiver, Sender};
use std::time::Instant;

use crate::foreign::{End, ForeignError, Matrix, Solver, World};
use crate::layout::RankPattern;
use crate::method::Method;
use crate::phases::{Phase, Phases, RankReport};

type Outcome<T> = Result<T, ForeignError>;

/// A command with its numbers, as all ranks get it.
type Words = [u64; 5];

const PATTERN: u64 = 1;
const VALUES: u64 = 2;
const SET_UP: u64 = 3;
const SOLVE: u64 = 4;
const DROP: u64 = 5;
const END: u64 = 6;

/// What a solver asks of the ranks; what belongs to each of them follows in parts, that of rank 0 last.
#[derive(Debug)]
pub(crate) enum Command {
    /// The rows of a system with so many unknowns, dimensions, and rows of a node.
    Pattern {
        system: u64,
        unknowns: usize,
        dims: usize,
        rows: usize,
    },
    /// Values of a system.
    Values { system: u64 },
    /// Factors, or grids; workspace beyond the estimate of MUMPS in percent.
    SetUp {
        system: u64,
        method: Method,
        workspace: u64,
    },
    /// A solution to a relative residual.
    Solve {
        system: u64,
        relative: f64,
        most_iterations: u64,
    },
    /// A system is needed no more.
    Drop { system: u64 },
}

/// What goes to one rank.
#[derive(Debug)]
pub(crate) enum Part {
    Pattern(RankPattern),
    Numbers(Vec<f64>),
}

/// What a solver sends.
#[derive(Debug)]
pub(crate) enum Request {
    Command(Command),
    Part(Part),
}

/// How a command ended.
#[derive(Debug, Default)]
pub(crate) struct Reply {
    pub(crate) end: End,
    /// `PCFailedReason` of a set-up, zero where it did not fail.
    pub(crate) failure: i32,
    /// `INFOG(1)` of MUMPS.
    pub(crate) mumps: i32,
    /// Memory of MUMPS on this rank \[MB\].
    pub(crate) memory: i32,
    /// The solution by rank.
    pub(crate) parts: Vec<Vec<f64>>,
}

/// A system as a rank has it.
#[derive(Debug)]
struct System {
    // Before the matrix, so that it is dropped first.
    solver: Option<(Method, u64, Solver)>,
    matrix: Matrix,
    dims: usize,
    /// Rows of a node.
    rows: usize,
    coordinates: Vec<f64>,
    has_motions: bool,
}

/// The systems of a rank.
#[derive(Debug)]
pub(crate) struct Server<'w> {
    world: &'w World,
    systems: HashMap<u64, System>,
    /// Most memory of MUMPS on this rank \[MB\].
    mumps: i32,
}

impl<'w> Server<'w> {
    pub(crate) fn new(world: &'w World) -> Self {
        Self {
            world,
            systems: HashMap::new(),
            mumps: 0,
        }
    }

    /// Follows rank 0 until it says that all is done.
    pub(crate) fn follow(mut self) -> Outcome<()> {
        loop {
            let mut words = Words::default();
            self.world.broadcast(&mut words)?;
            match words[0] {
                PATTERN => {
                    let own = RankPattern {
                        starts: self.world.receive_list(0)?,
                        columns: self.world.receive_list(0)?,
                        coordinates: self.world.receive_list(0)?,
                    };
                    self.make(words, own)?;
                }
                VALUES => {
                    let own = self.world.receive_list(0)?;
                    self.perform(words, &own)?;
                }
                SOLVE => {
                    let own = self.world.receive_list(0)?;
                    let reply = self.perform(words, &own)?;
                    for part in &reply.parts {
                        self.world.send_list(0, part)?;
                    }
                }
                END => {
                    self.systems.clear();
                    return RankReport::of_this(self.world, self.mumps)?.send(self.world);
                }
                _ => {
                    self.perform(words, &[])?;
                }
            }
        }
    }

    /// Serves the solvers of rank 0 until none is left; what it took, by phase and by rank.
    pub(crate) fn serve(
        mut self,
        requests: &Receiver<Request>,
        replies: &Sender<Reply>,
    ) -> Outcome<(Phases, Vec<RankReport>)> {
        let mut phases = Phases::default();
        while let Ok(request) = requests.recv() {
            let Request::Command(command) = request else {
                return Err(ForeignError::amid("a part without its command"));
            };
            let begin = Instant::now();
            let mut words = words(&command);
            self.world.broadcast(&mut words)?;
            let (reply, bytes) = self.lead(words, requests)?;
            phases.add(phase(words[0]), begin.elapsed(), bytes);
            // A solver that waits no more has gone with its run.
            let _ = replies.send(reply);
        }
        self.world.broadcast(&mut [END, 0, 0, 0, 0])?;
        self.systems.clear();
        let mut reports = vec![RankReport::of_this(self.world, self.mumps)?];
        for rank in 1..self.world.size {
            reports.push(RankReport::receive(self.world, rank)?);
        }
        Ok((phases, reports))
    }

    /// Hands the parts of a command to the ranks, and takes its own; the reply, and bytes sent and received.
    fn lead(&mut self, words: Words, parts: &Receiver<Request>) -> Outcome<(Reply, usize)> {
        let (world, mut bytes) = (self.world, 0);
        if !matches!(words[0], PATTERN | VALUES | SOLVE) {
            return Ok((self.perform(words, &[])?, bytes));
        }
        let mut reply = Reply::default();
        for rank in (1..world.size).chain([0]) {
            let Ok(Request::Part(part)) = parts.recv() else {
                return Err(ForeignError::amid("the run ended amid a command"));
            };
            match part {
                Part::Pattern(own) if rank == 0 => self.make(words, own)?,
                Part::Numbers(own) if rank == 0 => reply = self.perform(words, &own)?,
                Part::Pattern(own) => {
                    bytes += world.send_list(rank, &own.starts)?;
                    bytes += world.send_list(rank, &own.columns)?;
                    bytes += world.send_list(rank, &own.coordinates)?;
                }
                Part::Numbers(own) => bytes += world.send_list(rank, &own)?,
            }
        }
        if words[0] == SOLVE {
            for rank in 1..world.size {
                let part: Vec<f64> = world.receive_list(rank)?;
                bytes += size_of_val(&part[..]);
                reply.parts.push(part);
            }
        }
        Ok((reply, bytes))
    }

    /// Makes a system of its rows on this rank.
    fn make(&mut self, words: Words, own: RankPattern) -> Outcome<()> {
        let [_, system, unknowns, dims, rows] = words;
        let (dims, rows) = (dims as usize, rows as usize);
        let (starts, columns) = own.by_unknowns(rows);
        let matrix = Matrix::new(self.world, unknowns as usize, &starts, &columns, rows)?;
        let made = System {
            solver: None,
            matrix,
            dims,
            rows,
            coordinates: own.coordinates,
            has_motions: false,
        };
        self.systems.insert(system, made);
        Ok(())
    }

    /// What every rank does of a command, with what it was sent.
    fn perform(&mut self, words: Words, own: &[f64]) -> Outcome<Reply> {
        let [command, number, first, second, _] = words;
        if command == DROP {
            self.systems.remove(&number);
            return Ok(Reply::default());
        }
        let system = self
            .systems
            .get_mut(&number)
            .ok_or_else(|| ForeignError::amid("a command for a system that is not there"))?;
        match command {
            VALUES => {
                system.matrix.set_values(own)?;
                Ok(Reply::default())
            }
            SET_UP => {
                let method = Method::of_number(first);
                let reply = system.set_up(self.world, method, second)?;
                self.mumps = self.mumps.max(reply.memory);
                Ok(reply)
            }
            _ => system.solve(own, f64::from_bits(first), second),
        }
    }
}

impl System {
    /// Factorises the values at hand, or makes grids for them.
    fn set_up(&mut self, world: &World, method: Method, workspace: u64) -> Outcome<Reply> {
        let is_same = |own: &(Method, u64, Solver)| own.0 == method && own.1 == workspace;
        self.solver = self.solver.take().filter(is_same);
        self.matrix
            .set_symmetry(method.is_symmetric(), method.is_definite())?;
        // Those of a rigid body say nothing of pressures.
        let are_wanted = method.wants_motions() && self.rows == self.dims;
        if are_wanted && !self.has_motions && self.dims > 1 {
            self.matrix
                .set_rigid_motions(&self.coordinates, self.dims)?;
            self.has_motions = true;
        }
        let (_, _, solver) = match &mut self.solver {
            Some(own) => own,
            none => none.insert((method, workspace, method.solver(world)?)),
        };
        solver.of(&self.matrix)?;
        method.prepare(solver, workspace)?;
        let failure = solver.set_up()?;
        // Memory in use on this rank in MB, and what went wrong on any.
        let [memory, mumps] = solver.of_mumps(22, 1)?;
        Ok(Reply {
            failure,
            mumps,
            memory,
            ..Reply::default()
        })
    }

    fn solve(&mut self, rhs: &[f64], relative: f64, most_iterations: u64) -> Outcome<Reply> {
        let Some((_, _, solver)) = &mut self.solver else {
            return Err(ForeignError::amid("a solution before its factors"));
        };
        self.matrix.write(rhs)?;
        let end = solver.solve(&mut self.matrix, relative, most_iterations as i32)?;
        let mut found = Vec::new();
        self.matrix.read(&mut found)?;
        Ok(Reply {
            end,
            parts: vec![found],
            ..Reply::default()
        })
    }
}

fn words(command: &Command) -> Words {
    match *command {
        Command::Pattern {
            system,
            unknowns,
            dims,
            rows,
        } => [PATTERN, system, unknowns as u64, dims as u64, rows as u64],
        Command::Values { system } => [VALUES, system, 0, 0, 0],
        Command::SetUp {
            system,
            method,
            workspace,
        } => [SET_UP, system, method.number(), workspace, 0],
        Command::Solve {
            system,
            relative,
            most_iterations,
        } => [SOLVE, system, relative.to_bits(), most_iterations, 0],
        Command::Drop { system } => [DROP, system, 0, 0, 0],
    }
}

fn phase(command: u64) -> Phase {
    match command {
        PATTERN | DROP => Phase::Pattern,
        VALUES => Phase::Values,
        SET_UP => Phase::SetUp,
        _ => Phase::Solution,
    }
}
