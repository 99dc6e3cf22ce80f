"""The package as a whole: what is imported when, types, examples in the documentation, the notebook."""

import doctest
import importlib
import pkgutil
import re
import subprocess
import sys
import warnings
from pathlib import Path

import kempf
import pytest
from conftest import ROOT

HERE = Path(__file__).parent


def test_only_what_is_needed_is_imported():
    heavy = ["numpy", "pandas", "polars", "matplotlib"]
    code = f"import sys, kempf; print([name for name in {heavy} if name in sys.modules])"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "[]"


def test_the_version_is_that_of_the_package():
    from importlib.metadata import version

    assert kempf.__version__ == version("kempf")


def test_all_names_are_there_and_documented():
    for name in kempf.__all__:
        assert getattr(kempf, name).__doc__, name


def test_examples_in_the_documentation_hold():
    tried = 0
    for module in pkgutil.iter_modules(kempf.__path__, "kempf."):
        if module.name != "kempf._kempf":
            done = doctest.testmod(importlib.import_module(module.name))
            assert done.failed == 0, module.name
            tried += done.attempted
    assert tried > 5


@pytest.mark.parametrize("page", ["crates/python/README.md", "docs/src/howto/notebook.md"])
def test_what_a_page_shows_works(page, monkeypatch):
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / page).read_text("utf-8"), re.MULTILINE | re.DOTALL)
    assert blocks
    # Pages are read from the root of the repository.
    monkeypatch.chdir(ROOT)
    with warnings.catch_warnings():
        warnings.simplefilter("default", kempf.KempfWarning)
        exec("".join(blocks), {})


def test_types_agree_with_what_is_there():
    pytest.importorskip("mypy")
    package = Path(kempf.__file__).parent
    for words in (
        ["mypy", "--strict", str(package)],
        ["mypy.stubtest", "kempf", "--concise", "--ignore-disjoint-bases"],
    ):
        done = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True, cwd=package.parent)
        assert done.returncode == 0, done.stdout + done.stderr


def test_the_notebook_runs(tmp_path, monkeypatch):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    path = HERE.parent / "examples" / "zigzag.ipynb"
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        assert not cell.get("outputs") and not cell.get("execution_count"), "stored without what it showed"
    monkeypatch.delenv("MPLBACKEND", raising=False)
    # The notebook is to work where it finds itself, and to leave nothing in the project.
    monkeypatch.chdir(tmp_path)
    client = nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3")
    client.execute(cwd=str(tmp_path))
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert sum("image/png" in output.get("data", {}) for output in shown) >= 5
    assert not any(output.output_type == "stream" and "Traceback" in output.text for output in shown)
