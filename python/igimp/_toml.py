"""Values of Python as TOML, and TOML as values of Python."""

from __future__ import annotations

import json
import math
import os
import re
import sys
from collections.abc import Mapping
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

BARE = re.compile(r"[A-Za-z0-9_-]+\Z")

loads = tomllib.loads


def key(name: object) -> str:
    """A key, quoted where it has to be."""
    text = str(name)
    return text if BARE.match(text) else json.dumps(text, ensure_ascii=False)


def value(given: Any) -> str:
    """A value on one line."""
    if isinstance(given, bool):
        return "true" if given else "false"
    if isinstance(given, (str, os.PathLike)):
        return json.dumps(os.fspath(given), ensure_ascii=False)
    if isinstance(given, int):
        return str(int(given))
    if isinstance(given, float):
        return repr(float(given)) if math.isfinite(given) else str(float(given))
    if isinstance(given, Mapping):
        return "{ " + ", ".join(f"{key(k)} = {value(v)}" for k, v in given.items()) + " }"
    if isinstance(given, (list, tuple)):
        return "[" + ", ".join(value(item) for item in given) + "]"
    if hasattr(given, "tolist"):  # numpy
        return value(given.tolist())
    raise TypeError(f"a case file knows no {type(given).__name__}: {given!r}")


def document(case: Mapping[str, Any]) -> str:
    """A whole file."""
    lines: list[str] = []
    table(case, (), lines)
    return "\n".join(lines) + "\n"


def table(entries: Mapping[str, Any], path: tuple[str, ...], lines: list[str]) -> None:
    """A table: its own values first, then those tables within it that stand under their own heads."""

    def has_head(entry: Any) -> bool:
        if isinstance(entry, Mapping):
            return len(path) < 2
        return not path and isinstance(entry, (list, tuple)) and bool(entry) and all(isinstance(o, Mapping) for o in entry)

    inner = {k: entry for k, entry in entries.items() if has_head(entry)}
    lines.extend(f"{key(k)} = {value(entry)}" for k, entry in entries.items() if k not in inner)
    for name, entry in inner.items():
        head = ".".join((*path, key(name)))
        if isinstance(entry, Mapping):
            lines.extend(["", f"[{head}]"])
            table(entry, (*path, key(name)), lines)
        else:
            for item in entry:
                lines.extend(["", f"[[{head}]]"])
                lines.extend(f"{key(k)} = {value(v)}" for k, v in item.items())
