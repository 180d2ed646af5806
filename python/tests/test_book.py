"""GOAL: what the book says of the package is true: its quick start, the blocks of its page and its notebooks run."""

import re
import runpy
from pathlib import Path

import pytest

GUIDE = Path(__file__).parents[2] / "docs" / "src" / "guide"
NOTEBOOKS = sorted((GUIDE / "notebooks").glob("*.py"))


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Every page runs in a folder of its own, and draws without a screen."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")


def test_the_quick_start_runs(capsys):
    path = GUIDE / "python_quick_start.py"
    lines = [line for line in path.read_text().splitlines() if line.strip()]
    assert len(lines) <= 10
    runpy.run_path(str(path))
    assert "F = 1." in capsys.readouterr().out


def test_blocks_of_the_page_run():
    text = (GUIDE / "python.md").read_text()
    blocks = re.findall(r"<!-- tried by: test_blocks_of_the_page_run -->\n```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 5
    known = {}
    exec("import igimp", known)
    for block in blocks:
        exec(compile(block, "python.md", "exec"), known)


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(notebook, tmp_path):
    """In Jupyter where it is installed, else as a program."""
    cells = re.split(r"^# %%.*\n", notebook.read_text(), flags=re.MULTILINE)
    assert len(cells) > 2
    nbclient = pytest.importorskip("nbclient") if jupyter() else None
    if nbclient is None:
        runpy.run_path(str(notebook), run_name="__main__")
        return
    import nbformat

    book = nbformat.v4.new_notebook()
    for head, cell in zip(re.findall(r"^# %%.*$", notebook.read_text(), re.MULTILINE), cells[1:]):
        if "[markdown]" in head:
            text = "\n".join(line.removeprefix("#").removeprefix(" ") for line in cell.splitlines())
            book.cells.append(nbformat.v4.new_markdown_cell(text))
        else:
            book.cells.append(nbformat.v4.new_code_cell(cell.strip()))
    nbclient.NotebookClient(
        book, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}}
    ).execute()


def jupyter():
    """Whether a kernel is there to run notebooks."""
    try:
        import ipykernel  # noqa: F401
        import nbclient  # noqa: F401
    except ImportError:
        return False
    return True


def test_every_notebook_is_in_the_book():
    text = (GUIDE / "python.md").read_text()
    assert NOTEBOOKS and all(f"(notebooks/{path.name})" in text for path in NOTEBOOKS)
