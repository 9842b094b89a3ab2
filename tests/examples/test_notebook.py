"""The notebook of the examples runs from beginning to end, and shows what it says that it shows."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

TOUR = Path(__file__).resolve().parents[2] / "examples" / "notebook" / "tour.ipynb"
PATIENCE = 120
"""Seconds that a cell may take on a busy machine."""
pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(
        None in map(find_spec, ("nbclient", "ipykernel")),
        reason="nbclient, which runs notebooks, or a kernel is missing",
    ),
]


def read() -> Any:
    """The notebook as it is in the tree."""
    import nbformat  # here, as each process that runs tests would have to import it

    return nbformat.read(TOUR, as_version=4)


@pytest.fixture(scope="module")
def shown() -> dict[str, dict[str, str]]:
    """What each cell shows by media type, by the source of the cell; running it ends at the first error."""
    import nbclient

    notebook = read()
    where = {"metadata": {"path": str(TOUR.parent)}}
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(TOUR.parents[2]))
        nbclient.NotebookClient(notebook, timeout=PATIENCE, kernel_name="python3", resources=where).execute()
    return {cell.source: _outputs(cell) for cell in notebook.cells if cell.cell_type == "code"}


def _outputs(cell: Any) -> dict[str, str]:
    """What a cell shows by media type; what it prints, by and by, is one stream."""
    shown: dict[str, str] = {}
    for output in cell.outputs:
        if "data" in output:
            shown.update(output.data)
        else:
            shown["stream"] = shown.get("stream", "") + output.text
    return shown


def of(shown: dict[str, dict[str, str]], beginning: str) -> dict[str, str]:
    """What the cell shows whose last line begins with some text, by media type."""
    (found,) = (outputs for source, outputs in shown.items() if _last(source).startswith(beginning))
    return found


def _last(source: str) -> str:
    return f"{source.splitlines()[-1]}\n"


def test_the_notebook_is_valid_and_is_kept_without_outputs() -> None:
    import nbformat

    notebook = read()
    nbformat.validate(notebook)
    for cell in notebook.cells:
        assert not cell.get("outputs")
        assert cell.get("execution_count") is None


def test_every_cell_that_ends_with_a_value_shows_it(shown: dict[str, dict[str, str]]) -> None:
    assert all(outputs for outputs in shown.values()), shown


@pytest.mark.parametrize(
    ("beginning", "words"),
    [
        ("home\n", ["thinking-cap", "MotorDrive"]),
        ("task\n", [":Astrid", "(AT BEDROOM)"]),
        ("sc.partition(task, home)\n", [":person-tracker", ":absolute-odometry"]),
        ('sc.partition(task, home)["position"]', ["is no PositionSensor"]),
        ("home.query(", ["person-tracker", "living-room"]),
        ("living.components\n", ["clock", "display"]),
        ("living.query(", ["display", "kitchen"]),
    ],
)
def test_a_table_is_shown_as_html(beginning: str, words: list[str], shown: dict[str, dict[str, str]]) -> None:
    html = of(shown, beginning)["text/html"]
    assert html.startswith("<table>")
    assert [word for word in words if word not in html] == []


def test_the_configuration_is_shown_as_a_diagram(shown: dict[str, dict[str, str]]) -> None:
    html = of(shown, "answer\n")["text/html"]
    assert html.count("<rect ") == 5
    assert html.count("<path d='M") - html.count("<path d='M0 ") == 4
    assert "<script" not in html
    assert of(shown, "print(answer.to_mermaid())")["stream"].startswith("flowchart LR")


def test_the_refusal_is_shown_with_its_near_miss_and_its_places(shown: dict[str, dict[str, str]]) -> None:
    html = of(shown, "refusal\n")["text/html"]
    assert "display would fit, but its place is kitchen, not cellar" in html
    assert "display.ttl:5" in html
    assert "(../clock/display.ttl:5)" in of(shown, "    print(")["stream"]


def test_a_task_runs_in_a_living_ecology_that_ends_with_the_notebook(shown: dict[str, dict[str, str]]) -> None:
    assert "endpoint='tcp/127.0.0.1:" in of(shown, "sc.sites(ecology)")["text/plain"]
    run = of(shown, "deployed\n")
    acts = [line.split()[0] for line in run["stream"].splitlines()]
    assert [act for act in acts if act in {"discovered", "running", "stopped"}] == ["discovered", "running", "stopped"]
    assert run["text/html"].count("<rect ") == 2
    assert of(shown, "site.wait(), sc.sites(ecology)")["text/plain"] == "(0, ())"
