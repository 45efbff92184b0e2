"""Planar multibody systems: kinematics, dynamics, statics, modes, sensitivities.

>>> import catena
>>> scene = catena.load("crank_rocker.json")            # doctest: +SKIP
>>> scene.parameters["speed"] = 12                      # doctest: +SKIP
>>> run = scene.run()                                   # doctest: +SKIP
>>> run["kinematics"]["rocker.angle"]                   # doctest: +SKIP
array([...])

Numbers are in SI units and radians. What is wrong with a scene raises SceneError, with file, line and column; an
analysis that was not solved says so by its status.
"""

import os

from ._catena import Analysis, SceneError
from . import _catena

__all__ = ["Analysis", "Run", "Scene", "SceneError", "load", "loads"]


class Run:
    """The results of a scene: a sequence of analyses, also by type, `run["kinematics"]`."""

    def __init__(self, outcome):
        self.analyses = outcome.analyses
        #: The values of all parameters in this run.
        self.parameters = dict(outcome.parameters)

    def __getitem__(self, key):
        """An analysis by its place, or the first one of a type."""
        if isinstance(key, str):
            for analysis in self.analyses:
                if analysis.type == key:
                    return analysis
            raise KeyError(f'no analysis of type "{key}" was run; there are: {[a.type for a in self.analyses]}')
        return self.analyses[key]

    def __len__(self):
        return len(self.analyses)

    def __iter__(self):
        return iter(self.analyses)

    @property
    def ok(self):
        """Whether all analyses were solved."""
        return all(analysis.ok for analysis in self.analyses)

    def __repr__(self):
        return f"<Run: {', '.join(map(repr, self.analyses))}>"


class Scene:
    """A scene file or text, and the parameters that its runs are to change."""

    def __init__(self, path, text=None):
        self._path = os.fspath(path)
        self._text = text
        #: Parameters with values of their own: numbers in SI, or texts as scenes have them ("30 deg", "=2*a").
        self.parameters = {}

    def run(self, parameters=None, *, outputs=(), only="", threads=1):
        """Runs the scene's analyses, or those of the type `only`, and returns a Run.

        parameters  values for this run alone, by name
        outputs     columns in place of those that the scene names
        threads     that a sweep may use

        Raises SceneError for errors in the text or in parameters; KeyboardInterrupt ends a run.
        """
        values = {**self.parameters, **(parameters or {})}
        texts = [(name, value if isinstance(value, str) else repr(float(value))) for name, value in values.items()]
        return Run(_catena.run(self._path, self._text, texts, list(outputs), only, threads))

    def function(self, measure, names, *, analysis=0):
        """A function of the parameters `names` for scipy.optimize: f(x) gives the value of a measure.

        analysis  place of the analysis that has the measure

        Not a number where a design cannot be analysed.
        """

        def value(x):
            run = self.run(dict(zip(names, x, strict=True)))
            found = run[analysis].measures[measure]["value"] if run.ok else None
            return float("nan") if found is None else found

        return value

    def value_and_grad(self, measure, names=None):
        """f(x) -> (value, gradient) of a measure, as scipy.optimize.minimize takes it with jac=True.

        The scene's sensitivity analysis has the measure; `names` are its parameters, unless some are named. Without
        names the scene is run once to find them.
        """
        import numpy

        def measured(parameters):
            run = self.run(parameters, only="sensitivity")
            return run["sensitivity"].measures[measure] if run.ok else None

        if names is None:
            found = measured({})
            if found is None:
                raise ValueError("the scene cannot be analysed as it stands: name the parameters")
            names = list(found["gradient"])

        def value(x):
            result = measured(dict(zip(names, x, strict=True)))
            if result is None or result["value"] is None:
                return float("nan"), numpy.full(len(names), numpy.nan)
            return result["value"], numpy.array([result["gradient"][name] for name in names])

        return value

    def __repr__(self):
        return f"<Scene {self._path}>"


def load(path):
    """The scene in a file. The file is read by every run."""
    return Scene(path)


def loads(text, name="scene"):
    """The scene that a text holds; `name` stands for the file in messages."""
    return Scene(name, text)


def _to_pandas(self):
    """The rows as a pandas.DataFrame."""
    import pandas

    return pandas.DataFrame(self.table(), columns=self.columns)


Analysis.to_pandas = _to_pandas
