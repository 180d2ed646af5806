"""Medians of a comparison as Markdown and CSV."""

import csv
import datetime
import os
import platform
import statistics
import subprocess
from pathlib import Path

COLUMNS = [
    "kind", "unknowns", "library", "threads", "round", "analysis", "factor", "solve",
    "analysis_cpu", "factor_cpu", "memory_mib", "entries", "residual", "solver", "version", "stored", "size",
]  # fmt: skip
BEGIN, END = "<!-- compare:begin -->", "<!-- compare:end -->"
HEADER = (
    "| unknowns | library | threads | analysis | factor | solve | memory | entries | residual "
    "| analysis ratio | factor ratio | memory ratio |\n"
    "|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n"
)


def progress(row):
    """A measurement as a line of the log."""
    seconds = " ".join(f"{phase} {row[phase]:.3f}" for phase in ("analysis", "factor", "solve"))
    what = f"{row['kind']} {row['unknowns']} {row['library']}, {row['threads']} thread(s)"
    return f"{what}, round {row['round']}: {seconds} s"


def median(values):
    values = [value for value in values if value is not None]
    return statistics.median(values) if values else None


def number(value, digits=3):
    """A number with some significant digits, without an exponent."""
    if value is None:
        return "–"
    shown = f"{value:.{digits}g}"
    return f"{float(shown):.0f}" if "e" in shown else shown


def ratio(own, ours, what):
    """Median over the rounds of ours by this library's, in the same round."""
    rounds = {row["round"]: row[what] for row in ours}
    pairs = [(rounds.get(row["round"]), row[what]) for row in own]
    return median([a / b for a, b in pairs if a is not None and b])


def table(rows, ours_name):
    """The medians of one kind of matrix."""
    text = HEADER
    sizes = sorted({row["unknowns"] for row in rows})
    for unknowns in sizes:
        here = [row for row in rows if row["unknowns"] == unknowns]
        for library in dict.fromkeys(row["library"] for row in here):
            for threads in sorted({row["threads"] for row in here if row["library"] == library}):
                same = [row for row in here if row["threads"] == threads]
                own = [row for row in same if row["library"] == library]
                ours = [row for row in same if row["library"] == ours_name]
                text += line(own, ours, apart=library != "SuperLU", own_row=library == ours_name)
    return text


def line(own, ours, apart, own_row):
    """A library on one matrix; `apart` when its analysis is a phase of its own."""
    middle = {
        key: median([row[key] for row in own])
        for key in ("analysis", "factor", "solve", "memory_mib", "entries", "residual")
    }
    entries = middle["entries"] and middle["entries"] / 1e6
    cells = [
        f"{own[0]['unknowns']:,}".replace(",", " "),
        own[0]["library"],
        str(own[0]["threads"]),
        number(middle["analysis"]) if apart else "–",
        number(middle["factor"]),
        number(middle["solve"]),
        number(middle["memory_mib"]),
        number(entries),
        f"{middle['residual']:.0e}",
    ]
    # With one thread, processor time: other work on the machine hardly touches it.
    alone = own[0]["threads"] == 1 and all(row["factor_cpu"] is not None for row in ours + own)
    compute = ["analysis_cpu", "factor_cpu"] if alone else ["analysis", "factor"]
    for what in [*compute, "memory_mib"]:
        compared = not own_row and (apart or what != compute[0])
        cells.append(number(ratio(own, ours, what), 2) if compared else "–")
    return f"| {' | '.join(cells)} |\n"


def machine():
    """Processor, cores, memory and system in a line."""
    names = []
    try:
        info = Path("/proc/cpuinfo").read_text().splitlines()
        names = [row.split(":")[1].strip() for row in info if row.startswith("model name")]
        pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        memory = f", {pages / 2**30:.0f} GiB"
    except (OSError, ValueError):
        memory = ""
    name = names[0] if names else platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} processors{memory}, {platform.system()}"


def revision(root):
    """The commit of the working copy, where git knows it."""
    command = ["git", "describe", "--always", "--dirty"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else "without git"


def markdown(rows, absent, ours, root):
    """The comparison as it stands in the book."""
    versions = dict.fromkeys(row["version"] for row in rows if row.get("version"))
    load = f", load {os.getloadavg()[0]:.1f} at the end" if hasattr(os, "getloadavg") else ""
    text = f"Measured {datetime.date.today().isoformat()} on {machine()}{load}; igimp at commit "
    text += f"{revision(root)}; {'; '.join(versions)}. Times in s, memory in MiB, entries of the "
    text += "factors in millions; a ratio is igimp's value over the library's, of processor time with "
    text += "one thread and of wall-clock time with two.\n"
    for kind in dict.fromkeys(row["kind"] for row in rows):
        text += f"\n**{kind.capitalize()}**\n\n"
        text += table([row for row in rows if row["kind"] == kind], ours)
    for name, remedy in absent.items():
        text += f"\n{name} is not in the table: it was not installed (`{remedy}`).\n"
    return text


def write(folder, rows, text):
    """`compare.csv` and `compare.md`."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "compare.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    (folder / "compare.md").write_text(f"# Linear solvers side by side\n\n{text}")


def into_book(page, text, begin=BEGIN, end=END):
    """Replaces what stands between the marks of a page."""
    old = page.read_text()
    before, rest = old.split(begin)
    _, after = rest.split(end)
    page.write_text(f"{before}{begin}\n\n{text}\n{end}{after}")
