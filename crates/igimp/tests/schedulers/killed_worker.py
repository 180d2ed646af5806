"""A job file of `igimp sweep --to hyperqueue` on a real server of HyperQueue with two workers, one of them killed.

    pip install hyperqueue
    python killed_worker.py JOB.toml TASK

The package carries the server and the worker, and not the program `hq`: the tasks of the file are submitted as they
stand there through the interface in Python, without the memory and the time that they ask for (these workers declare
neither). Workers are processes of their own. The one that runs TASK is killed with SIGKILL as soon as that task has
saved something; the server then gives its task to the other.
"""

import ctypes
import os
import select
import signal
import sys
import tempfile
import time
import tomllib
from pathlib import Path

from hyperqueue.client import Client
from hyperqueue.cluster import LocalCluster, WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest
from hyperqueue.job import Job
from hyperqueue.task.program import ExternalProgram


def worker(cluster):
    """A worker with one core, in a process that ends with this one."""
    while True:
        heard, told = os.pipe()
        number = os.fork()
        if number == 0:
            ctypes.CDLL(None).prctl(1, signal.SIGKILL)
            cluster.start_worker(WorkerConfig(cores=1))
            os.write(told, b"up")
            while True:
                time.sleep(3600)
        if select.select([heard], [], [], 20)[0]:
            return number
        # The server has threads, and one of them held a lock when the process was copied.
        os.kill(number, signal.SIGKILL)
        os.waitpid(number, 0)


def tasks_of(array):
    """The numbers in `1-3,5`."""
    for part in array["ids"].split(","):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


def saved(array, task):
    """Whether a task has saved a step of its second stage."""
    folder = Path(array["stdout"]).parent / f"task-{task:04}" / "checkpoint"
    return any(folder.glob("step-*"))


def ancestors(number):
    while number > 1:
        yield number
        text = Path(f"/proc/{number}/stat").read_text()
        number = int(text.rsplit(")", 1)[1].split()[1])


def running(task):
    """The processes that run a task."""
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
            if b"--task" in words and words[words.index(b"--task") + 1] == str(task).encode():
                yield int(folder.name)
        except (OSError, IndexError):
            continue


def main(path, victim):
    file = tomllib.loads(Path(path).read_text())
    (array,) = file["array"]
    with tempfile.TemporaryDirectory() as folder:
        cluster = LocalCluster(server_dir=folder)
        workers = [worker(cluster) for _ in range(2)]
        job = Job(name=file["name"], max_fails=None)
        for number in tasks_of(array):
            place = lambda name: array[name].replace("%{TASK_ID}", str(number))  # noqa: E731
            task = ExternalProgram(
                number,
                args=array["command"],
                cwd=array["cwd"],
                stdout=place("stdout"),
                stderr=place("stderr"),
                resources=ResourceRequest(cpus=1),
            )
            job._add_task(task)
        client = Client(cluster.cluster.server_dir)
        submitted = client.submit(job)
        while not saved(array, victim):
            time.sleep(0.05)
        lines = [set(ancestors(number)) for number in running(victim)]
        (killed,) = {own for own in workers for line in lines if own in line}
        os.kill(killed, signal.SIGKILL)
        os.waitpid(killed, 0)
        print(f"killed the worker of task {victim}", flush=True)
        client.wait_for_jobs([submitted], raise_on_error=False)
        failed = client.get_failed_tasks(submitted)
        print(f"failed: {sorted(failed)}", flush=True)
        (other,) = set(workers) - {killed}
        os.kill(other, signal.SIGKILL)
        os.waitpid(other, 0)
        cluster.stop()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2])))
