"""Writes elements.pyi beside elements.py of a built package: types of the classes made from the library's lists.

    python3 make_stubs.py FOLDER        FOLDER: the one that holds the package catena
"""

import pathlib
import sys

#: The schema's definitions as types of Python.
TYPES = {
    "number": "_Number",
    "positive": "_Number",
    "notNegative": "_Number",
    "pair": "_Pair",
    "attachment": "_Attachment",
    "function": "_Function",
    "curve": "Mapping[str, Any]",
    "table": "Mapping[str, Any] | Sequence[Any]",
}

HEAD = '''"""A class for every element of a scene. Made when the package is built."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

#: SI, or as in scenes: "30 deg", "=2*a", the name of a parameter.
_Number = float | str
_Pair = Sequence[_Number]
#: "body", "body.point" or ("body", [x', y']).
_Attachment = str | Sequence[Any]
#: A number or a function of time.
_Function = _Number | Mapping[str, Any]

_SCHEMA: dict[str, Any]
_DEFINITIONS: dict[str, Any]

class Keyed:
    _keys: dict[str, Any]
    _required: frozenset[str]
    def __init__(self, **keys: Any) -> None: ...
    def __setattr__(self, key: str, value: Any) -> None: ...
    def to_dict(self) -> dict[str, Any]: ...

class Element(Keyed):
    type: str
    section: str
    can_be_driven: bool

def unknown_key(owner: str, key: str, known: Any) -> str: ...
def class_name(element: str) -> str: ...
'''


def type_of(schema):
    """The type of a key."""
    if "$ref" in schema:
        return TYPES[schema["$ref"].rsplit("/", 1)[1]]
    if "enum" in schema:
        return f"Literal[{', '.join(repr(one) for one in schema['enum'])}]"
    return {"string": "str", "boolean": "bool", "object": "Mapping[str, Any]", "array": "Sequence[Any]"}[schema["type"]]


def stub_of(cls):
    """The lines of a class."""
    base = cls.__mro__[1].__name__
    types = {key: type_of(schema) for key, schema in cls._keys.items()}
    lines = ["", f"class {cls.__name__}({base}):"]
    lines += [f"    {key}: {kind}" for key, kind in types.items()]
    required = [f"{key}: {kind}" for key, kind in types.items() if key in cls._required]
    others = [f"{key}: {kind} | None = ..." for key, kind in types.items() if key not in cls._required]
    return [*lines, f"    def __init__(self, *, {', '.join(required + others)}) -> None: ..."]


def main(folder):
    sys.path.insert(0, folder)
    from catena import elements

    names = elements.__all__
    lines = HEAD.splitlines()
    for name in names:
        if name != "Element":
            lines += stub_of(getattr(elements, name))
    lines += ["", f"__all__ = {names!r}", ""]
    (pathlib.Path(folder) / "catena" / "elements.pyi").write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
