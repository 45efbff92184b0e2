"""A class for every element of a scene, made from the lists of the library: its keys, their meaning, its equation.

>>> import catena
>>> spring = catena.SpringDamper(i="ground", j="mass.top", k="2 kN/m", c=10)
>>> spring.k, spring.c
('2 kN/m', 10)
>>> catena.SpringDamper(i="ground", j="mass.top", stiffness=10)
Traceback (most recent call last):
    ...
TypeError: SpringDamper has no key "stiffness"; it has: name, i, j, k, c, length, force, curve, at

`help(catena.SpringDamper)` tells what every key means. Values are as in scenes: numbers (SI), quantities such as
"2 kN/m", expressions such as "=2*a", names of parameters.
"""

from __future__ import annotations

import difflib
import inspect
import json
from typing import Any

from . import _catena

_SCHEMA = json.loads(_catena.schema())
_DEFINITIONS = _SCHEMA["$defs"]


class Keyed:
    """Keys and values of one object of a scene. Keys are attributes; only those that the scene knows can be set."""

    _keys: dict[str, Any] = {}
    _required: frozenset[str] = frozenset()

    def __init__(self, **keys: Any) -> None:
        for key, value in keys.items():
            setattr(self, key, value)
        missing = [key for key in self._keys if key in self._required and key not in keys]
        if missing:
            raise TypeError(f"{type(self).__name__} needs {', '.join(missing)}")

    def __setattr__(self, key: str, value: Any) -> None:
        if key not in self._keys:
            raise TypeError(unknown_key(type(self).__name__, key, self._keys))
        self.__dict__[key] = value

    def to_dict(self) -> dict[str, Any]:
        """The object as scenes have it; keys that are None are left out."""
        return {key: self.__dict__[key] for key in self._keys if self.__dict__.get(key) is not None}

    def __repr__(self) -> str:
        keys = ", ".join(f"{key}={self.__dict__[key]!r}" for key in self._keys if key in self.__dict__)
        return f"{type(self).__name__}({keys})"


class Element(Keyed):
    """A constraint, driver or force."""

    #: Its type in scenes.
    type: str = ""
    #: The list of a scene that it belongs to: "constraints" or "forces".
    section: str = ""
    #: Whether it can be a driver, whose value is a function of time.
    can_be_driven: bool = False

    def to_dict(self) -> dict[str, Any]:
        """The element as scenes have it."""
        return {"type": self.type, **super().to_dict()}


def unknown_key(owner: str, key: str, known: Any) -> str:
    """What is wrong with a key, and which one may have been meant."""
    near = difflib.get_close_matches(key, list(known), 1)
    hint = f'; did you mean "{near[0]}"?' if near else f"; it has: {', '.join(known)}"
    return f'{owner} has no key "{key}"{hint}'


def class_name(element: str) -> str:
    """The class of an element type: "point_on_curve" is PointOnCurve."""
    return "".join(word.capitalize() for word in element.split("_"))


def _make_class(name: str, base: type, schema: dict[str, Any], doc: str | None, **members: Any) -> type:
    keys = {key: value for key, value in schema["properties"].items() if key != "type"}
    required = frozenset(schema.get("required", ())) - {"type"}
    made = type(
        name, (base,), {"__doc__": doc, "__module__": __name__, "_keys": keys, "_required": required, **members}
    )
    parameters = [
        inspect.Parameter(
            key, inspect.Parameter.KEYWORD_ONLY, default=inspect.Parameter.empty if key in required else None
        )
        for key in keys
    ]
    made.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return made


def _body_doc() -> str:
    keys = _DEFINITIONS["body"]["properties"]
    return "A body of a scene.\n\nKeys\n" + "\n".join(f"  {k}: {v.get('description', '')}" for k, v in keys.items())


def _make_classes() -> dict[str, type]:
    driven = {one["properties"]["type"]["const"] for one in _DEFINITIONS["driver"]["anyOf"]}
    classes = {"Body": _make_class("Body", Keyed, _DEFINITIONS["body"], _body_doc())}
    for kind in ("constraint", "force"):
        for schema in _DEFINITIONS[kind]["anyOf"]:
            element = schema["properties"]["type"]["const"]
            name = class_name(element)
            classes[name] = _make_class(
                name,
                Element,
                schema,
                _catena.explain(element),
                type=element,
                section=kind + "s",
                can_be_driven=element in driven,
            )
    return classes


_CLASSES = _make_classes()
globals().update(_CLASSES)
__all__ = ["Element", *_CLASSES]
