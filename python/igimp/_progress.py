"""How far a run is: a bar in a terminal or a notebook, lines like those of the program, or nothing."""

from __future__ import annotations

import html
import sys
from typing import Any, Protocol


class Progress(Protocol):
    """Shows events."""

    def show(self, event: dict[str, Any]) -> None:
        """Shows an event."""

    def close(self) -> None:
        """Ends."""


class Quiet:
    """Shows nothing."""

    def show(self, event: dict[str, Any]) -> None:
        """Shows nothing."""

    def close(self) -> None:
        """Ends."""


class Lines(Quiet):
    """The lines of the program."""

    def show(self, event: dict[str, Any]) -> None:
        """Prints the line of an event, if it has one."""
        if event["line"]:
            print(event["line"], flush=True)


def words(event: dict[str, Any]) -> str:
    """Stage and step in a few words."""
    stage = event["stage"]
    if not stage["of"]:
        return event["line"] or ""
    text = f"{stage['index'] + 1}/{stage['of']} {stage['name']}"
    if event["event"] == "step":
        step = event["details"]
        text += f", load factor {step['load_factor']:.3f}, {step['iterations']} it"
    return text


class Terminal(Quiet):
    """A bar on standard error."""

    WIDTH = 24

    def __init__(self) -> None:
        self.last = 0

    def show(self, event: dict[str, Any]) -> None:
        """Draws the bar anew."""
        filled = "=" * int(event["share"] * self.WIDTH)
        text = f"[{filled:{self.WIDTH}}] {event['share']:4.0%}  {words(event)}"[:100]
        print(f"\r{text:{self.last}}", end="", file=sys.stderr, flush=True)
        self.last = len(text)

    def close(self) -> None:
        """Takes the bar away."""
        print("\r" + " " * self.last, end="\r", file=sys.stderr, flush=True)


class Notebook(Quiet):
    """A bar below the cell of a notebook."""

    def __init__(self) -> None:
        from IPython.display import HTML, display

        self.html = HTML
        self.handle = display(HTML(""), display_id=True)

    def draw(self, text: str) -> None:
        """Puts something in the place of the bar."""
        if self.handle is not None:
            self.handle.update(self.html(text))

    def show(self, event: dict[str, Any]) -> None:
        """Draws the bar anew."""
        bar = f'<progress style="width:20em" max="1" value="{event["share"]:.4f}"></progress>'
        self.draw(f"{bar} {event['share']:.0%} &ensp; {html.escape(words(event))}")

    def close(self) -> None:
        """Takes the bar away."""
        self.draw("")


def in_notebook() -> bool:
    """Whether a notebook runs this."""
    shell = sys.modules.get("IPython")
    running = shell.get_ipython() if shell is not None else None
    return running is not None and type(running).__name__ == "ZMQInteractiveShell"


def of(wanted: bool | str | None) -> Progress:
    """The way to show that was asked for: None is a bar where somebody looks, and nothing elsewhere."""
    if wanted == "lines":
        return Lines()
    if wanted is False:
        return Quiet()
    if in_notebook():
        return Notebook()
    if wanted is True or sys.stderr.isatty():
        return Terminal()
    return Quiet()
