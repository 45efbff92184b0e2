"""Results: runs of scenes and their analyses, with columns as NumPy views."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

from . import _catena, tables

if TYPE_CHECKING:
    import numpy as np
    import pandas
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Origin:
    """What was run: enough to run it again when pictures of it are wanted."""

    path: str
    text: str | None
    texts: list[tuple[str, str]]
    only: str


class Analysis:
    """The results of one analysis. Numbers are in SI and radians."""

    def __init__(self, results: _catena.Analysis, origin: Origin | None = None, place: int = 0) -> None:
        self._results = results
        self._origin = origin
        self._place = place

    def __getitem__(self, column: str) -> np.ndarray[Any, Any]:
        """The values of a column, a read-only view without a copy. KeyError if there is none of this name."""
        return self._results[column]

    def table(self) -> np.ndarray[Any, Any]:
        """All rows, an array of shape (rows, columns), without a copy."""
        return self._results.table()

    def __len__(self) -> int:
        return len(self._results)

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return self._results.columns

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns, by name."""
        return self._results.units

    @property
    def type(self) -> str:
        """What analysis it is."""
        return self._results.type

    @property
    def status(self) -> str:
        """ "ok", or why it is not."""
        return self._results.status

    @property
    def ok(self) -> bool:
        """Whether it was solved."""
        return self._results.ok

    @property
    def message(self) -> str:
        """What is wrong, where, and what may be done; empty if nothing is."""
        return self._results.message

    @property
    def warnings(self) -> list[str]:
        """What is doubtful."""
        return self._results.warnings

    @property
    def digits(self) -> dict[str, float]:
        """How many digits of each column are right, by name; without those of which it is not known."""
        return self._results.digits

    @property
    def measures(self) -> dict[str, dict[str, Any]]:
        """By name: value (None where there is none), unit, t, gradient."""
        return self._results.measures

    @property
    def fields(self) -> dict[str, Any]:
        """All other named results."""
        return self._results.fields

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a data frame; units are in its `attrs["units"]`. A column with statuses holds their words."""
        import pandas

        frame = pandas.DataFrame(self.table(), columns=self.columns, copy=True)
        for name in self.columns:
            column = self[name]
            if column.dtype.kind not in "fi":
                frame[name] = column
        frame.attrs["units"] = self.units
        return frame

    def plot(
        self, y: str | Sequence[str] | None = None, x: str | None = None, *, figure: Figure | None = None
    ) -> Figure:
        """Columns over each other with matplotlib: a panel for every unit. Without `y` all columns, over the first."""
        from . import figures

        return figures.plot(self, y, x, figure)

    def animate(self, **options: Any) -> FuncAnimation:
        """The mechanism in motion, as `catena draw` draws it, with matplotlib.

        pictures  how many, evenly spread over the rows (100)
        traces    points whose paths are shown: "body.point"
        speed     of the animation, as part of the true one (1)
        figure    to draw in

        The scene is run once more for it, to see its bodies. The animation must be kept as long as it is shown;
        `.save("motion.gif")` writes a file, `.to_jshtml()` makes a player for notebooks.
        """
        from . import figures

        if self._origin is None:
            raise ValueError("these rows were stepped from Python: animate the analysis of a scene's run")
        return figures.animate(self._origin, self._place + 1, **options)

    def __repr__(self) -> str:
        return f"<{self.type}: {self.status}, {len(self)} rows>"

    def _repr_html_(self) -> str:
        return tables.analysis_html(self)


class Run(Sequence[Analysis]):
    """The results of a scene: a sequence of analyses, also by type, `run["kinematics"]`."""

    def __init__(self, outcome: _catena.Outcome, origin: Origin | None = None) -> None:
        self.analyses = [Analysis(analysis, origin, place) for place, analysis in enumerate(outcome.analyses)]
        #: The values of all parameters in this run.
        self.parameters = dict(outcome.parameters)

    @overload
    def __getitem__(self, key: int) -> Analysis: ...
    @overload
    def __getitem__(self, key: slice) -> list[Analysis]: ...
    @overload
    def __getitem__(self, key: str) -> Analysis: ...
    def __getitem__(self, key: int | slice | str) -> Analysis | list[Analysis]:
        """An analysis by its place, or the first one of a type."""
        if isinstance(key, str):
            for analysis in self.analyses:
                if analysis.type == key:
                    return analysis
            raise KeyError(f'no analysis of type "{key}" was run; there are: {[a.type for a in self.analyses]}')
        return self.analyses[key]

    def __len__(self) -> int:
        return len(self.analyses)

    def __iter__(self) -> Iterator[Analysis]:
        return iter(self.analyses)

    @property
    def ok(self) -> bool:
        """Whether all analyses were solved."""
        return all(analysis.ok for analysis in self.analyses)

    def __repr__(self) -> str:
        return f"<Run: {', '.join(map(repr, self.analyses))}>"

    def _repr_html_(self) -> str:
        return tables.run_html(self)
