"""Runs under way: step by step, with the engine in a thread of its own."""

from __future__ import annotations

import contextlib
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _igimp as engine
from ._body import Body
from ._errors import Interrupted
from ._progress import Progress, Quiet

if TYPE_CHECKING:
    from ._case import Case
    from ._results import Results

PATIENCE = 0.1
"""So long Python waits for the engine before it looks for Ctrl-C [s]."""


@dataclass(frozen=True)
class Step:
    """An accepted step.

    Attributes
    ----------
    stage : str
        Name of the stage.
    kind : str
        Kind of the stage, such as ``gravity``.
    stage_index : int
        Number of the stage, from 0.
    trial : int
        In a strength reduction the number of its trial, from 0.
    number, steps : int
        Number of the step in its stage, from 1, and how many there are when none is cut.
    load_factor : float
        Share of the stage, or of the trial, that is done [-].
    iterations : int
        Corrections by Newton's method.
    residuals : tuple of float
        Out-of-balance force over external force and reactions, before every correction and at the end [-].
    plastic_share : float
        Share of the particles that yield [-].
    unknowns : int
        Unknowns of the step.
    share : float
        Share of the whole run that is done, as a bar shows it [-].
    body : Body or None
        The particles after the step, if they were asked for.
    """

    stage: str
    kind: str
    stage_index: int
    trial: int
    number: int
    steps: int
    load_factor: float
    iterations: int
    residuals: tuple[float, ...]
    plastic_share: float
    unknowns: int
    share: float
    body: Body | None

    @property
    def residual(self) -> float:
        """The residual that the step ended with [-]."""
        return self.residuals[-1]

    @classmethod
    def of(cls, event: dict[str, Any], body: Body | None) -> Step:
        """The step of an event."""
        stage, step = event["stage"], event["details"]
        return cls(
            stage=stage["name"],
            kind=stage["kind"],
            stage_index=stage["index"],
            trial=stage["trial"],
            number=step["number"],
            steps=stage["steps"],
            load_factor=step["load_factor"],
            iterations=step["iterations"],
            residuals=tuple(step["residuals"]),
            plastic_share=step["plastic_share"],
            unknowns=step["unknowns"],
            share=event["share"],
            body=body,
        )


class March:
    """A run that goes on when its next step is asked for; made by :meth:`igimp.Case.march`."""

    def __init__(self, begun: engine.March, case: Case, folder: Path | None) -> None:
        self._engine, self._case, self._folder = begun, case, folder
        self._stopped = False
        self._results: Results | None = None

    def __iter__(self) -> March:
        return self

    def __next__(self) -> Step:
        try:
            while not self._stopped:
                item = self._engine.next(PATIENCE)
                if item is None:
                    break
                text, arrays = item
                event = json.loads(text) if text else {"event": ""}
                if event["event"] == "step":
                    return Step.of(event, self._body(arrays))
        except KeyboardInterrupt:
            raise self._interrupted() from None
        self.close()
        raise StopIteration

    def __enter__(self) -> March:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        # Who leaves the loop may run the case again at once: the folder is free when this returns.
        try:
            self._engine.stop()
            if self._results is None and not sys.is_finalizing() and not self._engine.is_own_thread():
                while self._engine.next(PATIENCE) is not None:
                    pass  # Ctrl-C is heard in between, and leaves the run to end by itself.
            self._engine.leave()
        except (Exception, KeyboardInterrupt):
            pass  # The interpreter may be going down.

    def stop(self) -> None:
        """Ends the run after the step that it is at, with everything saved."""
        self._stopped = True
        self._engine.stop()

    def close(self) -> None:
        """Ends the run and waits until it has; nothing when it has already."""
        if self._results is None:
            from ._results import Results

            self._engine.stop()
            while self._engine.next(PATIENCE) is not None:
                pass  # Ctrl-C is heard in between.
            self._results = Results._of(self._engine.found(), self._case, self._folder)

    @property
    def results(self) -> Results:
        """What the run found; it is ended if it has not."""
        self.close()
        assert self._results is not None
        return self._results

    def _body(self, arrays: Any) -> Body | None:
        return None if arrays is None else Body(arrays, self._case.materials)

    def _interrupted(self) -> Interrupted:
        self.stop()
        print("finishing the step; interrupt again to leave it to itself", file=sys.stderr)
        results = self.results
        if self._folder is None:
            text = "interrupted; what was computed is in .results. A run with out=FOLDER can go on"
        else:
            text = f"interrupted; to go on: case.run(out={str(self._folder)!r}, resume=True)"
        return Interrupted(text, results)


def finish(march: March, shown: Progress | None = None, callback: Callable[[Step], object] | None = None) -> Results:
    """Drives a run to its end."""
    shown = shown or Quiet()
    try:
        while (item := march._engine.next(PATIENCE)) is not None:
            text, arrays = item
            if not text:
                continue
            event = json.loads(text)
            shown.show(event)
            if callback is None or march._stopped or event["event"] != "step":
                continue
            if callback(Step.of(event, march._body(arrays))) is False:
                march.stop()
    except KeyboardInterrupt:
        shown.close()
        raise march._interrupted() from None
    except BaseException:
        shown.close()
        with contextlib.suppress(Exception):
            march.close()
        raise
    shown.close()
    results = march.results
    results._warn()
    return results
