"""Many designs of one scene from an array of parameters to an array of measures.

>>> import catena, numpy
>>> model = catena.Model(parameters={"length": 1, "turn": 0.5})
>>> arm = model.body("arm", points={"tip": ["length", 0]})
>>> model.add(catena.Revolute(i="ground", j=arm))
>>> model.drive(catena.AbsoluteAngle(i=arm, value={"polynomial": ["turn", 1]}))
>>> model.analyse("kinematics", until=1, measures={"x": {"final": "arm.tip.x"}, "top": {"max": "arm.tip.y"}})
>>> result = catena.batch(model.scene(), [[1, 0], [2, 0.5]], ["length", "turn"])
>>> result.values.round(4)
array([[0.5403, 0.8415],
       [0.1415, 1.995 ]])

Driven scenes, with their loads, are computed in SIMD lanes, sixteen designs side by side; others one by one. The interpreter is free
meanwhile.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from . import _catena
from .results import Analysis
from .scenes import Scene
from .sweeps import Failure

if TYPE_CHECKING:
    import numpy as np
    import pandas
    from numpy.typing import ArrayLike


@dataclass(frozen=True, eq=False)
class Batch:
    """What came of the designs of a batch, one row a design, in their order."""

    #: The parameters, by column of `designs`.
    names: list[str]
    #: The measures, by column of `values`.
    measures: list[str]
    _analysis: Analysis

    def __len__(self) -> int:
        return len(self._analysis)

    @property
    def designs(self) -> np.ndarray[Any, Any]:
        """The parameters, of shape (designs, parameters): a read-only view."""
        return self._analysis.table()[:, 1 : 1 + len(self.names)]

    @property
    def values(self) -> np.ndarray[Any, Any]:
        """The measures, of shape (designs, measures): a read-only view. Not numbers where a design has none."""
        return self._analysis.table()[:, 1 + len(self.names) : -1]

    @property
    def ok(self) -> np.ndarray[Any, Any]:
        """Of each design, whether it has results."""
        import numpy

        return numpy.asarray(self._analysis.table()[:, -1] == 0)

    @cached_property
    def status(self) -> np.ndarray[Any, Any]:
        """Of each design "ok", or why it has no results, in a word."""
        return self._analysis["status"]

    @cached_property
    def failures(self) -> list[Failure]:
        """The designs without results, with their numbers and reasons."""
        return [
            Failure(found["design"] - 1, {name: found[name] for name in self.names}, found["status"], found["message"])
            for found in self._analysis.fields["failures"]
        ]

    @property
    def in_lanes(self) -> int:
        """How many designs were computed in lanes."""
        return int(self._analysis.fields["in_lanes"])

    def __getitem__(self, name: str) -> np.ndarray[Any, Any]:
        """The values of a measure, or of a parameter, by design."""
        if name in self.measures:
            return self.values[:, self.measures.index(name)]
        if name in self.names:
            return self.designs[:, self.names.index(name)]
        raise KeyError(f'no measure or parameter "{name}"; there are: {[*self.measures, *self.names]}')

    def to_pandas(self) -> pandas.DataFrame:
        """A line for each design: parameters, measures, status."""
        return self._analysis.to_pandas().drop(columns="design")

    def __repr__(self) -> str:
        return f"<Batch: {len(self)} designs, {int((~self.ok).sum())} without results>"


def batch(scene: Scene, designs: ArrayLike, names: Sequence[str], *, only: str = "", threads: int = 1) -> Batch:
    """Analyses a scene for many designs: an array of parameters in, an array of measures out.

    designs  numbers of shape (designs, parameters), SI
    names    the parameters, by column
    only     type of the analyses to run
    threads  that share the designs

    The measures are those of all the scene's analyses, but for sensitivities, optimisations and sweeps. A design that
    cannot be analysed has its status, and its reason is in `.failures`; the others count. ValueError (SceneError) for a
    table of another shape, for numbers that are not finite and for names that are no parameters of the scene;
    KeyboardInterrupt ends it.
    """
    import numpy

    table = numpy.ascontiguousarray(designs, dtype=float)
    columns = list(names)
    if isinstance(names, str):
        raise ValueError(f'names are a list of parameters, ["{names}"], not a text')
    if table.ndim != 2:
        raise ValueError(f"designs are a table, a row for each: this array has the shape {table.shape}")
    if table.shape[1] != len(columns):
        raise ValueError(f"the table has {table.shape[1]} columns, and {len(columns)} names are given: {columns}")
    if threads < 1:
        raise ValueError(f"{threads} threads do nothing: at least one is needed")
    path, text, texts = scene.source()
    analysis = Analysis(_catena.run(path, text, texts, [], only, threads, columns, table).analyses[0])
    return Batch(columns, analysis.columns[1 + len(columns) : -1], analysis)
