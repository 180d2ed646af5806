"""How cases and results look in a notebook."""

from __future__ import annotations

import base64
import html
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._case import Case
    from ._results import Results


def preformatted(text: str) -> str:
    """Text of the program."""
    return f"<pre>{html.escape(text)}</pre>"


def rows(header: list[str], body: list[list[Any]]) -> str:
    """A table; numbers stand on the right."""

    def cell(value: Any) -> str:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        text = f"{value:.5g}" if isinstance(value, float) else str(value)
        return f'<td style="text-align:{"right" if is_number else "left"}">{html.escape(text)}</td>'

    head = "".join(f'<th style="text-align:left">{html.escape(title)}</th>' for title in header)
    lines = "".join("<tr>" + "".join(map(cell, row)) + "</tr>" for row in body)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table>"


def case(case: Case) -> str:
    """A case: title, stages, what was changed."""
    stages = [[i, name, kind, steps] for i, (name, kind, steps) in enumerate(case._file.stages, start=1)]
    text = f"<b>{html.escape(case.title)}</b>" + rows(["", "stage", "kind", "steps"], stages)
    if case.settings:
        text += rows(["changed", "to"], [[key, value] for key, value in case.settings.items()])
    return text


def picture(svg: str, caption: str) -> str:
    """A picture with its caption; it scales with the page and keeps its own styles to itself."""
    data = base64.b64encode(svg.encode()).decode()
    image = f'<img style="max-width:100%" alt="{html.escape(caption)}" src="data:image/svg+xml;base64,{data}">'
    return f'<figure style="margin:1em 0">{image}<figcaption>{html.escape(caption)}</figcaption></figure>'


def results(results: Results) -> str:
    """What a run found."""
    stages = [[stage.name, stage.kind, stage.steps, stage.outcome, stage.reason] for stage in results.stages]
    text = f"<b>{html.escape(results.title)}</b>: {html.escape(results.ending)}"
    text += rows(["stage", "kind", "steps", "outcome", "reason"], stages)
    if results.factor_of_safety is not None:
        stable, failed = results.factor_of_safety_interval
        text += f"<p>factor of safety <b>{results.factor_of_safety:.3f}</b> ({stable:.3f} ≤ F &lt; {failed:.3f})</p>"
    if results.mesh_study is not None:
        text += results.mesh_study._repr_html_()
    if results.checks:
        checks = [
            [
                "met" if check.met else check.verdict.upper(),
                check.name,
                check.printed,
                check._printed(check.reference),
                check.band,
                check.source,
            ]
            for check in results.checks
        ]
        text += rows(["check", "", "value", "reference", "band", "source"], checks)
    if results.failure:
        text += preformatted(results.failure)
    if results.folder is None:
        text += "<p>kept in memory: pictures, report and frames need <code>run(out=...)</code></p>"
    else:
        text += f"<p>results in {html.escape(str(results.folder))}</p>"
    return text
