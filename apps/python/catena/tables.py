"""What notebooks show of scenes and results: HTML without scripts."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .results import Analysis, Run

#: Rows of a table that are shown, half of them from its beginning.
SHOWN_ROWS = 10
SHOWN_COLUMNS = 12


def preformatted(text: str) -> str:
    """A text with its line ends and spaces: an error of a scene has a caret."""
    return f"<pre>{html.escape(text)}</pre>"


def shown(value: Any) -> str:
    """A value in six digits."""
    return html.escape(f"{value:.6g}" if isinstance(value, float) else str(value))


def table_html(heads: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table with a line of heads."""
    head = "".join(f"<th>{html.escape(text)}</th>" for text in heads)
    lines = "".join("<tr>" + "".join(f"<td>{shown(value)}</td>" for value in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table>"


def scene_html(sketch: dict[str, Any]) -> str:
    """A picture of a scene, and what it is made of."""
    parts = [f"<h4>{html.escape(sketch['name'])}</h4>"]
    if sketch["description"]:
        parts.append(f"<p>{html.escape(sketch['description'])}</p>")
    parts.append(f"<p>{sketch['bodies']} bodies, {sketch['elements']} elements</p>")
    parts.append(sketch["svg"][max(0, sketch["svg"].find("<svg")) :])
    if sketch["parameters"]:
        parts.append(table_html(["parameter", "value (SI)"], sketch["parameters"]))
    return "<div>" + "".join(parts) + "</div>"


def with_unit(name: str, unit: str) -> str:
    """The name of a column and its unit."""
    return f"{name} [{unit}]" if unit and unit != "1" else name


def analysis_html(analysis: Analysis) -> str:
    """How an analysis ended, its measures, and the first and last of its rows."""
    parts = [f"<p><b>{html.escape(analysis.type)}</b>: {html.escape(analysis.status)}, {len(analysis)} rows</p>"]
    for text in [analysis.message, *analysis.warnings]:
        if text:
            parts.append(f"<p>{html.escape(text)}</p>")
    if analysis.measures:
        rows = [(name, one["value"], one["unit"]) for name, one in analysis.measures.items()]
        parts.append(table_html(["measure", "value", "unit"], rows))
    columns, count = analysis.columns[:SHOWN_COLUMNS], len(analysis)
    if count:
        half = SHOWN_ROWS // 2
        numbers = range(count) if count <= SHOWN_ROWS else [*range(half), *range(count - half, count)]
        values = [analysis[column] for column in columns]
        lines: list[Sequence[Any]] = [
            [value[row] if value.dtype.kind == "U" else float(value[row]) for value in values] for row in numbers
        ]
        if count > SHOWN_ROWS:
            lines.insert(half, ["…"] * len(columns))
        parts.append(table_html([with_unit(name, analysis.units[name]) for name in columns], lines))
    if len(analysis.columns) > len(columns):
        parts.append(f"<p>and {len(analysis.columns) - len(columns)} more columns</p>")
    return "<div>" + "".join(parts) + "</div>"


def run_html(run: Run) -> str:
    """All analyses of a run."""
    return "<div>" + "".join(analysis_html(analysis) for analysis in run) + "</div>"
