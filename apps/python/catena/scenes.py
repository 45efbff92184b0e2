"""Scenes from files and texts, and their runs."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _catena, tables
from .results import Origin, Run

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.animation import FuncAnimation

#: A number (SI) or a text as scenes have it: "30 deg", "=2*a".
Value = float | str


def texts_of(values: Mapping[str, Value]) -> list[tuple[str, str]]:
    """Values in the syntax of scenes."""
    for name, value in values.items():
        if not isinstance(value, str) and not math.isfinite(float(value)):
            raise ValueError(f"parameter {name} is {value}, not a finite number")
    return [(name, value if isinstance(value, str) else repr(float(value))) for name, value in values.items()]


class Scene:
    """A scene file or text, and the parameters that its runs are to change."""

    def __init__(self, path: str | os.PathLike[str], text: str | None = None) -> None:
        self._path = os.fspath(path)
        self._text = text
        #: Parameters with values of their own: numbers in SI, or texts as scenes have them ("30 deg", "=2*a").
        self.parameters: dict[str, Value] = {}

    def run(
        self,
        parameters: Mapping[str, Value] | None = None,
        *,
        outputs: Sequence[str] = (),
        only: str = "",
        threads: int = 1,
    ) -> Run:
        """Runs the scene's analyses, or those of the type `only`, and returns a Run.

        parameters  values for this run alone, by name
        outputs     columns in place of those that the scene names
        threads     that a sweep may use

        Raises SceneError for errors in the text or in parameters; KeyboardInterrupt ends a run.
        """
        path, text, texts = self.source(parameters)
        return Run(_catena.run(path, text, texts, list(outputs), only, threads), Origin(path, text, texts, only))

    def function(self, measure: str, names: Sequence[str], *, analysis: int = 0) -> Callable[[Sequence[float]], float]:
        """A function of the parameters `names` for scipy.optimize: f(x) gives the value of a measure.

        analysis  place of the analysis that has the measure

        Not a number where a design cannot be analysed.
        """

        def value(x: Sequence[float]) -> float:
            run = self.run(dict(zip(names, x, strict=True)))
            found = run[analysis].measures[measure]["value"] if run.ok else None
            return float("nan") if found is None else float(found)

        return value

    def value_and_grad(
        self, measure: str, names: Sequence[str] | None = None
    ) -> Callable[[Sequence[float]], tuple[float, np.ndarray[Any, Any]]]:
        """f(x) -> (value, gradient) of a measure, as scipy.optimize.minimize takes it with jac=True.

        The scene's sensitivity analysis has the measure; `names` are its parameters, unless some are named. Without
        names the scene is run once to find them.
        """
        import numpy

        def measured(parameters: Mapping[str, Value]) -> dict[str, Any] | None:
            run = self.run(parameters, only="sensitivity")
            return run["sensitivity"].measures[measure] if run.ok else None

        if names is None:
            found = measured({})
            if found is None:
                raise ValueError("the scene cannot be analysed as it stands: name the parameters")
            names = list(found["gradient"])
        variables = list(names)

        def value(x: Sequence[float]) -> tuple[float, np.ndarray[Any, Any]]:
            result = measured(dict(zip(variables, x, strict=True)))
            if result is None or result["value"] is None:
                return float("nan"), numpy.full(len(variables), numpy.nan)
            return result["value"], numpy.array([result["gradient"][name] for name in variables])

        return value

    def animate(self, **options: Any) -> FuncAnimation:
        """Runs the scene and animates the last analysis whose mechanism moves: see Analysis.animate."""
        from . import figures

        return figures.animate(Origin(*self.source(), ""), 0, **options)

    def source(self, parameters: Mapping[str, Value] | None = None) -> tuple[str, str | None, list[tuple[str, str]]]:
        """Path, text (None: that of the file), and parameters in the syntax of scenes."""
        return self._path, self._text, texts_of({**self.parameters, **(parameters or {})})

    # A file's text goes along: it need not be where the scene is used. Its path stays, for the files that it names.
    def __getstate__(self) -> dict[str, Any]:
        text = self._text
        if text is None:
            try:
                with open(self._path, encoding="utf-8") as file:
                    text = file.read()
            except OSError as error:
                raise _catena.SceneError(f"{self._path}: {error.strerror}") from error
        return {"_path": os.path.abspath(self._path), "_text": text, "parameters": dict(self.parameters)}

    def __repr__(self) -> str:
        return f"<Scene {self._path}>"

    def _repr_html_(self) -> str:
        try:
            return tables.scene_html(_catena.sketch(*self.source(), 360))
        except _catena.SceneError as error:
            return tables.preformatted(str(error))





def load(path: str | os.PathLike[str]) -> Scene:
    """The scene in a file. The file is read by every run."""
    return Scene(path)


def loads(text: str, name: str = "scene") -> Scene:
    """The scene that a text holds; `name` stands for the file in messages."""
    return Scene(name, text)
