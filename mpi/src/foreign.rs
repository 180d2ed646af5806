//! The one module that calls MPI and PETSc, and the one with `unsafe`: declarations by hand, and safe ways around them.
//!
//! Declared as in `mpi.h` of Open MPI 4.1, whose handles are pointers, and in the headers of PETSc 3.18 with real
//! numbers in double precision and indices of 32 bits. All calls come from the main thread: nothing here can be sent to another.

#![expect(
    unsafe_code,
    reason = "foreign functions; each block says why it is sound"
)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::marker::PhantomData;
use std::ptr;
use std::time::Duration;

/// A handle of MPI or an object of PETSc.
type Handle = *mut c_void;
/// `PetscErrorHandler`.
type Handler = unsafe extern "C" fn(
    Handle,
    c_int,
    *const c_char,
    *const c_char,
    c_int,
    c_int,
    *const c_char,
    Handle,
) -> c_int;

unsafe extern "C" {
    static mut ompi_mpi_comm_world: [u8; 0];
    static mut ompi_mpi_byte: [u8; 0];

    fn MPI_Init_thread(argc: Handle, argv: Handle, wanted: c_int, found: *mut c_int) -> c_int;
    fn MPI_Finalize() -> c_int;
    fn MPI_Abort(comm: Handle, code: c_int) -> c_int;
    fn MPI_Comm_rank(comm: Handle, rank: *mut c_int) -> c_int;
    fn MPI_Comm_size(comm: Handle, size: *mut c_int) -> c_int;
    fn MPI_Get_processor_name(name: *mut c_char, length: *mut c_int) -> c_int;
    fn MPI_Ibcast(
        data: Handle,
        count: c_int,
        kind: Handle,
        root: c_int,
        comm: Handle,
        request: *mut Handle,
    ) -> c_int;
    fn MPI_Test(request: *mut Handle, is_done: *mut c_int, status: Handle) -> c_int;
    fn MPI_Send(
        data: *const c_void,
        count: c_int,
        kind: Handle,
        to: c_int,
        tag: c_int,
        comm: Handle,
    ) -> c_int;
    fn MPI_Recv(
        data: Handle,
        count: c_int,
        kind: Handle,
        from: c_int,
        tag: c_int,
        comm: Handle,
        status: Handle,
    ) -> c_int;

    fn PetscInitializeNoArguments() -> c_int;
    fn PetscFinalize() -> c_int;
    fn PetscPushErrorHandler(handler: Handler, context: Handle) -> c_int;
    fn PetscReturnErrorHandler(
        comm: Handle,
        line: c_int,
        function: *const c_char,
        file: *const c_char,
        code: c_int,
        kind: c_int,
        message: *const c_char,
        context: Handle,
    ) -> c_int;
    fn PetscErrorMessage(code: c_int, text: *mut *const c_char, more: *mut *mut c_char) -> c_int;
    fn PetscOptionsSetValue(options: Handle, name: *const c_char, value: *const c_char) -> c_int;
    fn PetscOptionsHasName(
        options: Handle,
        prefix: *const c_char,
        name: *const c_char,
        is_set: *mut c_int,
    ) -> c_int;

    fn MatCreateMPIAIJWithArrays(
        comm: Handle,
        rows: c_int,
        columns: c_int,
        all_rows: c_int,
        all_columns: c_int,
        starts: *const c_int,
        indices: *const c_int,
        values: *const f64,
        matrix: *mut Handle,
    ) -> c_int;
    fn MatUpdateMPIAIJWithArray(matrix: Handle, values: *const f64) -> c_int;
    fn MatSetBlockSize(matrix: Handle, size: c_int) -> c_int;
    fn MatSetOption(matrix: Handle, option: c_int, is_set: c_int) -> c_int;
    fn MatCreateVecs(matrix: Handle, right: *mut Handle, left: *mut Handle) -> c_int;
    fn MatSetNearNullSpace(matrix: Handle, space: Handle) -> c_int;
    fn MatNullSpaceCreateRigidBody(coordinates: Handle, space: *mut Handle) -> c_int;
    fn MatNullSpaceDestroy(space: *mut Handle) -> c_int;
    fn MatDestroy(matrix: *mut Handle) -> c_int;
    fn MatMumpsSetIcntl(factor: Handle, number: c_int, value: c_int) -> c_int;
    fn MatMumpsGetInfo(factor: Handle, number: c_int, value: *mut c_int) -> c_int;
    fn MatMumpsGetInfog(factor: Handle, number: c_int, value: *mut c_int) -> c_int;

    fn VecSetBlockSize(vector: Handle, size: c_int) -> c_int;
    fn VecGetArray(vector: Handle, values: *mut *mut f64) -> c_int;
    fn VecRestoreArray(vector: Handle, values: *mut *mut f64) -> c_int;
    fn VecDestroy(vector: *mut Handle) -> c_int;

    fn KSPCreate(comm: Handle, solver: *mut Handle) -> c_int;
    fn KSPDestroy(solver: *mut Handle) -> c_int;
    fn KSPSetOptionsPrefix(solver: Handle, prefix: *const c_char) -> c_int;
    fn KSPSetOperators(solver: Handle, matrix: Handle, preconditioner: Handle) -> c_int;
    fn KSPSetType(solver: Handle, kind: *const c_char) -> c_int;
    fn KSPSetNormType(solver: Handle, norm: c_int) -> c_int;
    fn KSPSetPCSide(solver: Handle, side: c_int) -> c_int;
    fn KSPGMRESSetRestart(solver: Handle, restart: c_int) -> c_int;
    fn KSPSetTolerances(
        solver: Handle,
        relative: f64,
        absolute: f64,
        divergence: f64,
        iterations: c_int,
    ) -> c_int;
    fn KSPSetFromOptions(solver: Handle) -> c_int;
    fn KSPSetUp(solver: Handle) -> c_int;
    fn KSPSolve(solver: Handle, rhs: Handle, solution: Handle) -> c_int;
    fn KSPGetConvergedReason(solver: Handle, reason: *mut c_int) -> c_int;
    fn KSPGetIterationNumber(solver: Handle, iterations: *mut c_int) -> c_int;
    fn KSPGetPC(solver: Handle, preconditioner: *mut Handle) -> c_int;
    fn PCSetType(preconditioner: Handle, kind: *const c_char) -> c_int;
    fn PCFactorSetMatSolverType(preconditioner: Handle, package: *const c_char) -> c_int;
    fn PCFactorSetUpMatSolverType(preconditioner: Handle) -> c_int;
    fn PCFactorGetMatrix(preconditioner: Handle, factor: *mut Handle) -> c_int;
    fn PCGetFailedReason(preconditioner: Handle, reason: *mut c_int) -> c_int;
}

/// `MPI_THREAD_FUNNELED`: other threads are there, and do not call MPI.
const FUNNELED: c_int = 1;
/// `MAT_SYMMETRIC` and `MAT_SPD`.
const SYMMETRIC: c_int = 1;
const POSITIVE_DEFINITE: c_int = 15;
/// `KSP_NORM_UNPRECONDITIONED` and `PC_RIGHT`.
const UNPRECONDITIONED: c_int = 2;
const RIGHT: c_int = 1;
/// `PETSC_DEFAULT`.
const DEFAULT: f64 = -2.0;
/// Most bytes of one message.
const MESSAGE: usize = 1 << 30;
/// The pause between two looks for the next command: short beside a solution, and the core is free meanwhile.
const PAUSE: Duration = Duration::from_micros(200);

/// A call that failed, and what the library says of it.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{call} of PETSc or MPI failed with code {code}: {text}")]
pub(crate) struct ForeignError {
    call: &'static str,
    code: i32,
    text: String,
}

type Outcome<T> = Result<T, ForeignError>;

impl ForeignError {
    /// What went wrong between the calls.
    pub(crate) fn amid(what: &str) -> Self {
        Self {
            call: "the order of calls",
            code: 0,
            text: what.to_owned(),
        }
    }
}

fn checked(call: &'static str, code: c_int) -> Outcome<()> {
    if code == 0 {
        return Ok(());
    }
    let (mut text, mut more) = (ptr::null(), ptr::null_mut());
    // SAFETY: both are places for a pointer; any code is allowed.
    let is_known = unsafe { PetscErrorMessage(code, &raw mut text, &raw mut more) } == 0;
    let read = |text: *const c_char| {
        // SAFETY: what is not null is a text of PETSc's that ends with a zero and lives as long as the program.
        (is_known && !text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_string_lossy())
    };
    let texts: Vec<_> = [read(text), read(more)].into_iter().flatten().collect();
    Err(ForeignError {
        call,
        code,
        text: texts.join("; "),
    })
}

/// Calls a function of the libraries and looks at its code.
macro_rules! call {
    ($function:ident ( $($argument:expr),* $(,)? )) => {
        // SAFETY: `World` is there, so the libraries are initialised, and this is the main thread. Objects were made by
        // the libraries and are destroyed by `Drop` alone; pointers are to live places and arrays of the stated length.
        checked(stringify!($function), unsafe { $function($($argument),*) })
    };
}

/// Numbers without padding, for which any bits are a value.
pub(crate) trait Plain: Copy {}
impl Plain for u8 {}
impl Plain for u32 {}
impl Plain for u64 {}
impl Plain for f64 {}

/// The ranks of a run, from the initialisation of MPI and PETSc to their end.
#[derive(Debug)]
pub(crate) struct World {
    pub(crate) rank: usize,
    pub(crate) size: usize,
    on_main_thread: PhantomData<*mut ()>,
}

fn comm() -> Handle {
    // The address is the handle.
    (&raw mut ompi_mpi_comm_world).cast()
}

fn byte() -> Handle {
    // The address is the handle.
    (&raw mut ompi_mpi_byte).cast()
}

fn text(word: &str) -> CString {
    CString::new(word).unwrap_or_default()
}

#[expect(
    clippy::unused_self,
    reason = "that there is a `World` says that MPI and PETSc are initialised"
)]
impl World {
    /// Initialises both libraries; to be called once, on the main thread.
    pub(crate) fn start() -> Outcome<Self> {
        let (mut found, mut rank, mut size) = (0, 0, 0);
        let null = ptr::null_mut();
        call!(MPI_Init_thread(null, null, FUNNELED, &raw mut found))?;
        call!(MPI_Comm_rank(comm(), &raw mut rank))?;
        call!(MPI_Comm_size(comm(), &raw mut size))?;
        set_option("-no_signal_handler", "true")?;
        call!(PetscInitializeNoArguments())?;
        call!(PetscPushErrorHandler(PetscReturnErrorHandler, null))?;
        Ok(Self {
            rank: rank as usize,
            size: size as usize,
            on_main_thread: PhantomData,
        })
    }

    /// Ends both libraries; all ranks have to come here.
    pub(crate) fn finish(self) -> Outcome<()> {
        call!(PetscFinalize())?;
        call!(MPI_Finalize())
    }

    /// The name of this computer.
    pub(crate) fn machine(&self) -> Outcome<String> {
        // MPI_MAX_PROCESSOR_NAME is 256.
        let (mut name, mut length) = ([0; 256], 0);
        call!(MPI_Get_processor_name(name.as_mut_ptr(), &raw mut length))?;
        let letters = name[..length as usize].iter().map(|&own| own as u8);
        Ok(String::from_utf8_lossy(&letters.collect::<Vec<_>>()).into_owned())
    }

    /// Hands the numbers of rank 0 to all; who waits leaves its core to others.
    pub(crate) fn broadcast(&self, numbers: &mut [u64]) -> Outcome<()> {
        let mut request = ptr::null_mut();
        let (data, bytes) = (numbers.as_mut_ptr().cast(), size_of_val(numbers) as c_int);
        call!(MPI_Ibcast(data, bytes, byte(), 0, comm(), &raw mut request))?;
        loop {
            let mut is_done = 0;
            // `numbers` is borrowed until the request is done.
            call!(MPI_Test(
                &raw mut request,
                &raw mut is_done,
                ptr::null_mut()
            ))?;
            if is_done != 0 {
                return Ok(());
            }
            std::thread::sleep(PAUSE);
        }
    }

    fn send<T: Plain>(&self, to: usize, numbers: &[T]) -> Outcome<()> {
        for part in numbers.chunks(MESSAGE / size_of::<T>()) {
            let (data, bytes) = (part.as_ptr().cast(), size_of_val(part) as c_int);
            call!(MPI_Send(data, bytes, byte(), to as c_int, 0, comm()))?;
        }
        Ok(())
    }

    fn receive<T: Plain>(&self, from: usize, numbers: &mut [T]) -> Outcome<()> {
        for part in numbers.chunks_mut(MESSAGE / size_of::<T>()) {
            let (data, bytes) = (part.as_mut_ptr().cast(), size_of_val(part) as c_int);
            let ignored = ptr::null_mut();
            call!(MPI_Recv(
                data,
                bytes,
                byte(),
                from as c_int,
                0,
                comm(),
                ignored
            ))?;
        }
        Ok(())
    }

    /// Sends a list with its length; its bytes.
    pub(crate) fn send_list<T: Plain>(&self, to: usize, numbers: &[T]) -> Outcome<usize> {
        self.send(to, &[numbers.len() as u64])?;
        self.send(to, numbers)?;
        Ok(size_of_val(numbers))
    }

    /// Receives a list that was sent with its length.
    pub(crate) fn receive_list<T: Plain + Default>(&self, from: usize) -> Outcome<Vec<T>> {
        let mut length = [0_u64];
        self.receive(from, &mut length)?;
        let mut numbers = vec![T::default(); length[0] as usize];
        self.receive(from, &mut numbers)?;
        Ok(numbers)
    }

    /// Whether the user gave an option of PETSc.
    pub(crate) fn has_option(&self, name: &str) -> Outcome<bool> {
        let (name, mut is_set) = (text(name), 0);
        let null = ptr::null_mut();
        call!(PetscOptionsHasName(
            null,
            ptr::null(),
            name.as_ptr(),
            &raw mut is_set
        ))?;
        Ok(is_set != 0)
    }

    /// Gives an option of PETSc unless the user did.
    pub(crate) fn default_option(&self, name: &str, value: &str) -> Outcome<()> {
        if self.has_option(name)? {
            return Ok(());
        }
        set_option(name, value)
    }
}

fn set_option(name: &str, value: &str) -> Outcome<()> {
    let (name, value) = (text(name), text(value));
    call!(PetscOptionsSetValue(
        ptr::null_mut(),
        name.as_ptr(),
        value.as_ptr()
    ))
}

/// Ends all ranks at once: the last resort, after an error of a [`World`] that was started.
pub(crate) fn abort(code: i32) {
    // SAFETY: MPI is initialised, and not ended: what failed came before its end, or was that.
    unsafe { MPI_Abort(comm(), code) };
}

/// A matrix by ranges of rows, with vectors that fit it.
#[derive(Debug)]
pub(crate) struct Matrix {
    own: Handle,
    rhs: Handle,
    solution: Handle,
    /// Rows of this rank, and entries.
    rows: usize,
    entries: usize,
}

impl Matrix {
    /// A matrix of zeros; rows of this rank in compressed form, columns ascending, and nodes of so many unknowns each.
    pub(crate) fn new(
        _: &World,
        unknowns: usize,
        starts: &[i32],
        columns: &[i32],
        node: usize,
    ) -> Outcome<Self> {
        let (rows, all, node) = (starts.len() - 1, unknowns as c_int, node as c_int);
        let own = rows as c_int;
        let zeros = vec![0.0; columns.len()];
        let mut made = Self {
            own: ptr::null_mut(),
            rhs: ptr::null_mut(),
            solution: ptr::null_mut(),
            rows,
            entries: columns.len(),
        };
        let (starts, columns) = (starts.as_ptr(), columns.as_ptr());
        let (values, place) = (zeros.as_ptr(), &raw mut made.own);
        call!(MatCreateMPIAIJWithArrays(
            comm(),
            own,
            own,
            all,
            all,
            starts,
            columns,
            values,
            place
        ))?;
        call!(MatSetBlockSize(made.own, node))?;
        let (right, left) = (&raw mut made.solution, &raw mut made.rhs);
        call!(MatCreateVecs(made.own, right, left))?;
        Ok(made)
    }

    /// Tells the motions of a rigid body, by the coordinates of the nodes of this rank.
    pub(crate) fn set_rigid_motions(&mut self, coordinates: &[f64], node: usize) -> Outcome<()> {
        call!(VecSetBlockSize(self.rhs, node as c_int))?;
        self.write(coordinates)?;
        let mut space = ptr::null_mut();
        call!(MatNullSpaceCreateRigidBody(self.rhs, &raw mut space))?;
        call!(MatSetNearNullSpace(self.own, space))?;
        call!(MatNullSpaceDestroy(&raw mut space))
    }

    /// Replaces the values of this rank, in the order of its rows.
    pub(crate) fn set_values(&mut self, values: &[f64]) -> Outcome<()> {
        assert_eq!(values.len(), self.entries, "one value for each entry");
        call!(MatUpdateMPIAIJWithArray(self.own, values.as_ptr()))
    }

    pub(crate) fn set_symmetry(&mut self, is_symmetric: bool, is_definite: bool) -> Outcome<()> {
        call!(MatSetOption(self.own, SYMMETRIC, c_int::from(is_symmetric)))?;
        call!(MatSetOption(
            self.own,
            POSITIVE_DEFINITE,
            c_int::from(is_definite)
        ))
    }

    /// Replaces the right-hand side of this rank.
    pub(crate) fn write(&mut self, values: &[f64]) -> Outcome<()> {
        assert_eq!(values.len(), self.rows, "one value for each row");
        let mut place = ptr::null_mut();
        call!(VecGetArray(self.rhs, &raw mut place))?;
        // SAFETY: PETSc lends an array with an entry for each row of this rank until it is restored.
        unsafe { ptr::copy_nonoverlapping(values.as_ptr(), place, values.len()) };
        call!(VecRestoreArray(self.rhs, &raw mut place))
    }

    /// Reads the solution of this rank.
    pub(crate) fn read(&mut self, values: &mut Vec<f64>) -> Outcome<()> {
        values.resize(self.rows, 0.0);
        let mut place = ptr::null_mut();
        call!(VecGetArray(self.solution, &raw mut place))?;
        // SAFETY: PETSc lends an array with an entry for each row of this rank until it is restored.
        unsafe { ptr::copy_nonoverlapping(place, values.as_mut_ptr(), values.len()) };
        call!(VecRestoreArray(self.solution, &raw mut place))
    }
}

impl Drop for Matrix {
    fn drop(&mut self) {
        // There is nobody left to tell of a failure, and objects that are null are left alone.
        let _ = call!(VecDestroy(&raw mut self.rhs));
        let _ = call!(VecDestroy(&raw mut self.solution));
        let _ = call!(MatDestroy(&raw mut self.own));
    }
}

/// How a solution, or what precedes it, ended.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct End {
    /// `KSPConvergedReason`: positive where it converged.
    pub(crate) reason: i32,
    pub(crate) iterations: usize,
}

/// A solver of PETSc with its preconditioner.
#[derive(Debug)]
pub(crate) struct Solver {
    own: Handle,
    preconditioner: Handle,
    factor: Option<Handle>,
}

impl Solver {
    /// A solver of a kind, with a prefix for its options.
    pub(crate) fn new(_: &World, prefix: &str, kind: &str, preconditioner: &str) -> Outcome<Self> {
        let mut made = Self {
            own: ptr::null_mut(),
            preconditioner: ptr::null_mut(),
            factor: None,
        };
        let (prefix, kind, by) = (text(prefix), text(kind), text(preconditioner));
        call!(KSPCreate(comm(), &raw mut made.own))?;
        call!(KSPSetOptionsPrefix(made.own, prefix.as_ptr()))?;
        call!(KSPSetType(made.own, kind.as_ptr()))?;
        call!(KSPGetPC(made.own, &raw mut made.preconditioner))?;
        if !preconditioner.is_empty() {
            call!(PCSetType(made.preconditioner, by.as_ptr()))?;
        }
        Ok(made)
    }

    pub(crate) fn of(&mut self, matrix: &Matrix) -> Outcome<()> {
        call!(KSPSetOperators(self.own, matrix.own, matrix.own))
    }

    /// Measures convergence by the residual itself, and gives GMRES so many vectors.
    pub(crate) fn by_residual(&mut self, vectors: i32) -> Outcome<()> {
        call!(KSPSetNormType(self.own, UNPRECONDITIONED))?;
        call!(KSPGMRESSetRestart(self.own, vectors))
    }

    pub(crate) fn precondition_right(&mut self) -> Outcome<()> {
        call!(KSPSetPCSide(self.own, RIGHT))
    }

    pub(crate) fn take_options(&mut self) -> Outcome<()> {
        call!(KSPSetFromOptions(self.own))
    }

    /// Factorises with MUMPS, with integer parameters of it (`ICNTL`). The solver has its matrix by then.
    pub(crate) fn use_mumps(&mut self, parameters: &[(i32, i32)]) -> Outcome<()> {
        let package = text("mumps");
        call!(PCFactorSetMatSolverType(
            self.preconditioner,
            package.as_ptr()
        ))?;
        call!(PCFactorSetUpMatSolverType(self.preconditioner))?;
        let mut factor = ptr::null_mut();
        call!(PCFactorGetMatrix(self.preconditioner, &raw mut factor))?;
        for &(number, value) in parameters {
            call!(MatMumpsSetIcntl(factor, number, value))?;
        }
        self.factor = Some(factor);
        Ok(())
    }

    /// Factorises, or makes the grids; `PCFailedReason`, zero where it did not fail.
    pub(crate) fn set_up(&mut self) -> Outcome<i32> {
        let mut reason = 0;
        call!(KSPSetUp(self.own))?;
        call!(PCGetFailedReason(self.preconditioner, &raw mut reason))?;
        Ok(reason)
    }

    /// Numbers that MUMPS tells of this rank (`INFO`) and of all (`INFOG`); zeros without it.
    pub(crate) fn of_mumps(&self, own: i32, of_all: i32) -> Outcome<[i32; 2]> {
        let mut found = [0; 2];
        if let Some(factor) = self.factor {
            let [own_place, place] = &mut found;
            call!(MatMumpsGetInfo(factor, own, own_place))?;
            call!(MatMumpsGetInfog(factor, of_all, place))?;
        }
        Ok(found)
    }

    pub(crate) fn solve(
        &mut self,
        matrix: &mut Matrix,
        relative: f64,
        most_iterations: i32,
    ) -> Outcome<End> {
        let (mut reason, mut iterations) = (0, 0);
        call!(KSPSetTolerances(
            self.own,
            relative,
            0.0,
            DEFAULT,
            most_iterations
        ))?;
        call!(KSPSolve(self.own, matrix.rhs, matrix.solution))?;
        call!(KSPGetConvergedReason(self.own, &raw mut reason))?;
        call!(KSPGetIterationNumber(self.own, &raw mut iterations))?;
        Ok(End {
            reason,
            iterations: iterations as usize,
        })
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        // There is nobody left to tell of a failure, and an object that is null is left alone.
        let _ = call!(KSPDestroy(&raw mut self.own));
    }
}
