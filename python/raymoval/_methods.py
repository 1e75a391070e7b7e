# SPDX-License-Identifier: MIT
"""Methods: those of raymoval as objects, and those written in Python."""
from __future__ import annotations

import copy
import hashlib
import inspect
import pickle
import re
import uuid
from typing import Any, Optional, Union

from raymoval import _raymoval

Value = Union[bool, int, float, str]


class Remover:
    """A method in Python: derive from it and write `run`.

        class Far(raymoval.Remover):
            '''Removes what is far away.'''
            distance = 30.0                       # metres; a parameter

            def run(self, scans, sink):
                for scan in scans:
                    sink.accept(scan.index, numpy.linalg.norm(scan.points, axis=1) > self.distance)

    `raymoval.clean(scans, poses, Far())` cleans with it, `raymoval.run("street", [Far, "erasor"])`
    scores it beside others. Attributes that are bool, numbers or texts, and whose names do not begin
    with _, are its parameters.

    `run` has to call `sink.accept(index, mask)` exactly once for each scan, in any order. A method
    sees no labels. It works in a frame of the harness: the first scan is at the origin, z is up.
    """

    #: Name in tables; by default the name of the class in small letters.
    name: Optional[str] = None
    #: Change it whenever answers may change. By default it is derived from the code of the class
    #: and of its base classes, and from their attributes and the object's, so that a changed method
    #: is run again. It does not depend on functions, classes and numbers elsewhere that this code
    #: uses. It depends on the version of Python.
    version: Optional[str] = None
    #: Whether the answer for a scan comes from it and earlier ones only.
    online: bool = False

    def run(self, scans: _raymoval.Scans, sink: _raymoval.Sink) -> None:
        """Gives `sink` a mask for each of `scans`."""
        raise NotImplementedError(f"{type(self).__name__} has no run(self, scans, sink).")


#: The name of a method, an object, or the class of one.
MethodLike = Union[str, Remover, type[Remover]]
_OF_REMOVER = ("name", "version", "online")


def remover_name(method: Any) -> str:
    """What results call a method in Python: NearPoints is near_points."""
    given = getattr(method, "name", None)
    if isinstance(given, str) and given:
        return given
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", type(method).__name__).lower()


def _parameters(method: Remover) -> dict[str, Value]:
    names = [name for kind in reversed(type(method).__mro__) for name in vars(kind)]
    found: dict[str, Value] = {}
    for name in [*names, *vars(method)]:
        value = getattr(method, name, None)
        if not name.startswith("_") and name not in _OF_REMOVER and isinstance(
                value, (bool, int, float, str)):
            found[name] = value
    return found


def _version(method: Remover) -> str:
    """The method's own, or a hash of the source of its classes and of what the object holds beside
    its parameters. Without a source, or with something that cannot be stored, a new one each time:
    then no result is taken for that of this method."""
    if method.version is not None:
        return str(method.version)
    classes = [kind for kind in type(method).__mro__ if kind not in Remover.__mro__]
    parameters = _parameters(method)
    held = sorted(item for item in vars(method).items() if item[0] not in parameters)
    try:
        content = pickle.dumps([[inspect.getsource(kind) for kind in classes], held], protocol=4)
    except Exception:  # What objects raise that cannot be stored differs.
        content = uuid.uuid4().bytes
    return "python-" + hashlib.sha256(content).hexdigest()[:16]


def entry(method: Union[Remover, type[Remover]]) -> dict[str, Any]:
    """What the harness asks of a method."""
    made = method() if isinstance(method, type) else method
    if not callable(getattr(made, "run", None)):
        raise _raymoval.UsageError(f"{type(made).__name__} is no method: it has no run(scans, sink). "
                                   "Derive it from raymoval.Remover.")

    def with_values(values: dict[str, Value]) -> Remover:
        own = copy.copy(made)
        for name, value in values.items():
            if getattr(own, name) != value:
                setattr(own, name, value)
        return own

    sentence = (inspect.getdoc(type(made)) or "").split("\n\n")[0].replace("\n", " ")
    return {"name": remover_name(made), "sentence": sentence, "version": _version(made),
            "online": bool(made.online), "parameters": _parameters(made), "make": with_values}


def setting_text(name: str, value: Value) -> str:
    """A value as the command line has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float, str)):
        return str(value)
    if hasattr(value, "item"):  # Of NumPy.
        return setting_text(name, value.item())
    raise _raymoval.UsageError(f"parameter '{name}': expected a bool, a number or a text, got a "
                               f"{type(value).__name__}.")


def describe(name: str) -> str:
    """A method ("raymoval:online") or a protocol ("protocol:erasor") with its parameters, as
    `raymoval describe --all` prints it.

    Raises UsageError that suggests the nearest name.
    """
    return _raymoval.describe(name)


def methods() -> list[str]:
    """The names of all methods with their variants."""
    return _raymoval.method_names()


def protocols() -> list[str]:
    """The names of all protocols."""
    return _raymoval.protocol_names()
