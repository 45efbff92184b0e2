"""Models that are built in Python: bodies, elements and analyses are put together to the text of a scene.

>>> import catena
>>> model = catena.Model(gravity=[0, -9.81])
>>> bob = model.body("bob", mass=1, position=[1, 0], particle=True)
>>> model.add(catena.AbsoluteDistance(name="rod", i=bob, ground=[0, 0], value=1))
>>> model.analyse("equilibrium", outputs=["bob.x", "bob.y"])
>>> model.run()["equilibrium"]["bob.y"].round(9)
array([-1.])
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from typing import Any

from .elements import _DEFINITIONS, _SCHEMA, Body, Element, Keyed, unknown_key
from .results import Run
from .scenes import Scene

_ANALYSES = {one["properties"]["type"]["const"]: one for one in _DEFINITIONS["analysis"]["anyOf"]}
_BUILT = ("$schema", "catena", "bodies", "constraints", "drivers", "forces", "replicate", "analyses")
_SETTINGS = [key for key in _SCHEMA["properties"] if key not in _BUILT]


def _plain(value: Any, where: str) -> Any:
    """The value as JSON has it. ValueError, with the place, for numbers that are none; TypeError for other things."""
    if isinstance(value, Keyed):
        value = value.to_dict()
    if isinstance(value, Mapping):
        return {str(key): _plain(one, f"{where}, {key}") for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one, where) for one in value]
    if isinstance(value, (str, bool)) or value is None:
        return value
    if isinstance(value, (int, float)):
        if not math.isfinite(value):
            raise ValueError(f"{where}: {value} is not a finite number")
        return value
    if hasattr(value, "tolist"):  # numbers and arrays of NumPy
        return _plain(value.tolist(), where)
    raise TypeError(f"{where}: a scene cannot hold {value!r}")


def _expect_element(element: object) -> None:
    if not isinstance(element, Element):
        raise TypeError(f"{element!r} is no constraint, driver or force")


class Block:
    """Bodies and elements, and blocks of them that are repeated."""

    def __init__(self) -> None:
        self._bodies: dict[str, dict[str, Any]] = {}
        self._lists: dict[str, list[dict[str, Any]]] = {"constraints": [], "drivers": [], "forces": []}
        self._blocks: list[tuple[dict[str, Any], Block]] = []

    def body(self, name: str, body: Body | None = None, **keys: Any) -> str:
        """Adds a body, given by a Body or by its keys, and returns its name; `name + ".tip"` is a point of it.

        The ground exists: `body("ground", points=...)` gives it points.
        """
        if name in self._bodies:
            raise ValueError(f'there is a body "{name}" already')
        values = {**(body.to_dict() if body else {}), **Body(**keys).to_dict()}
        self._bodies[name] = _plain(values, f'body "{name}"')
        return name

    def add(self, *elements: Element) -> None:
        """Adds constraints and forces."""
        for element in elements:
            _expect_element(element)
            self._lists[element.section].append(self._given(element))

    def drive(self, *elements: Element) -> None:
        """Adds drivers: scalar constraints whose value is a function of time."""
        for element in elements:
            _expect_element(element)
            if not element.can_be_driven:
                raise TypeError(f"{type(element).__name__} cannot be a driver: it has no single value to prescribe")
            if getattr(element, "value", None) is None:
                raise TypeError(f"a driver needs a value: {element!r}")
            self._lists["drivers"].append(self._given(element))

    def repeat(self, count: float | str, *, first: float | str | None = None, variable: str | None = None) -> Block:
        """A block that is repeated for k = first ... first + count - 1: names such as "link{k-1}" follow k."""
        keys = {"count": count, "first": first, "variable": variable}
        block = Block()
        self._blocks.append(({key: value for key, value in keys.items() if value is not None}, block))
        return block

    def to_dict(self) -> dict[str, Any]:
        """The block as scenes have it."""
        parts: dict[str, Any] = {"bodies": dict(self._bodies)}
        parts.update((key, list(elements)) for key, elements in self._lists.items() if elements)
        if self._blocks:
            parts["replicate"] = [{**_plain(keys, "repeat"), **block.to_dict()} for keys, block in self._blocks]
        return parts

    @staticmethod
    def _given(element: Element) -> dict[str, Any]:
        given = element.to_dict()
        plain: dict[str, Any] = _plain(given, f'{element.type} "{given.get("name", "")}"')
        return plain


class Model(Block):
    """A scene that is built in Python. Keys of the scene itself, such as gravity, are arguments."""

    def __init__(self, name: str = "model", **settings: Any) -> None:
        super().__init__()
        self._analyses: list[dict[str, Any]] = []
        for key in settings:
            if key not in _SETTINGS:
                raise TypeError(unknown_key("Model", key, _SETTINGS))
        self._settings = _plain({"name": name, **settings}, "model")

    @property
    def name(self) -> str:
        """The name of the scene."""
        return str(self._settings["name"])

    def analyse(self, type: str, **keys: Any) -> None:
        """Adds an analysis; `catena.explain(type)` tells its keys. A key that Python has no name for gets an
        underscore: `from_="initial"`."""
        if type not in _ANALYSES:
            raise TypeError(f'there is no analysis "{type}"; there are: {", ".join(_ANALYSES)}')
        known = [key for key in _ANALYSES[type]["properties"] if key != "type"]
        given = {key.removesuffix("_"): value for key, value in keys.items()}
        for key in given:
            if key not in known:
                raise TypeError(unknown_key(f"the analysis {type}", key, known))
        self._analyses.append(_plain({"type": type, **given}, f"analysis {type}"))

    def to_dict(self) -> dict[str, Any]:
        """The scene."""
        return {"catena": 1, **self._settings, **super().to_dict(), "analyses": list(self._analyses)}

    def text(self) -> str:
        """The text of the scene, which `catena run` reads as well."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False) + "\n"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text())

    def scene(self) -> Scene:
        """The scene as it is now."""
        return Scene(self.name, self.text())

    def run(self, parameters: Mapping[str, float | str] | None = None, **options: Any) -> Run:
        """Runs the scene: see Scene.run."""
        return self.scene().run(parameters, **options)

    def _repr_html_(self) -> str:
        return self.scene()._repr_html_()
