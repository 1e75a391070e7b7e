# SPDX-License-Identifier: MIT
"""The version of a method in Python that has none of its own: a hash of what it is made of."""
from __future__ import annotations

import functools
import hashlib
import pickle
import types
from typing import Any, Iterable, Optional

from raymoval import _raymoval

_SIMPLE = (type(None), bool, int, float, complex, str, bytes, type(Ellipsis))
#: The behaviour of a code object, without its place in the file.
_OF_CODE = ("co_code", "co_consts", "co_names", "co_varnames", "co_freevars", "co_cellvars",
            "co_argcount", "co_posonlyargcount", "co_kwonlyargcount", "co_flags",
            "co_exceptiontable")
#: Parts of a module, or of a class that is not written in Python: identified by name.
_BY_NAME = (types.ModuleType, types.WrapperDescriptorType, types.MethodDescriptorType,
            types.ClassMethodDescriptorType, types.GetSetDescriptorType,
            types.MemberDescriptorType)
_WRAPPERS = (staticmethod, classmethod, type(functools.cache(len)))


class _Hash:
    """A hash of values, with code where they have some: it tells functions by what they do, which
    `pickle` tells by their names. Of two values that differ it makes two hashes."""

    def __init__(self, known: dict[int, str]) -> None:
        """known: what is told by a name, by its id."""
        self._known = known
        self._hash = hashlib.sha256()
        self._open: list[int] = []  # What holds the value that is added now: it may hold itself.

    def add(self, value: Any) -> None:
        """Raises what `pickle` raises for a value that nobody can store."""
        kind = type(value)
        self._put(f"{kind.__module__}.{kind.__qualname__}".encode())
        if kind in _SIMPLE:
            self._put(repr(value).encode("utf-8", "surrogatepass"))
        elif id(value) in self._known:
            self._put(self._known[id(value)].encode())
        elif id(value) in self._open:
            self._put(str(self._open.index(id(value))).encode())
        else:
            self._open.append(id(value))
            self._add_parts(value)
            self._open.pop()

    def hexdigest(self) -> str:
        return self._hash.hexdigest()

    def _put(self, content: bytes) -> None:
        self._hash.update(len(content).to_bytes(8, "little") + content)

    def _add_parts(self, value: Any) -> None:
        parts: Optional[list[Any]]
        if type(value) in (set, frozenset):  # Their order is another one in each process.
            parts = sorted(self._digest(part) for part in value)
        else:
            parts = _parts(value)
        if parts is None:
            self._put(pickle.dumps(value, protocol=4))
            return
        self._put(str(len(parts)).encode())
        for part in parts:
            self.add(part)

    def _digest(self, value: Any) -> str:
        own = _Hash(self._known)
        own._open = list(self._open)
        own.add(value)
        return own.hexdigest()


def _parts(value: Any) -> Optional[list[Any]]:
    """What a value is made of; None if that is for `pickle` to say."""
    kind = type(value)
    if kind in (list, tuple):
        return list(value)
    if kind is dict:
        return [part for item in value.items() for part in item]
    if kind is types.CodeType:
        return [getattr(value, name, None) for name in _OF_CODE]
    if kind is types.FunctionType:
        return [value.__code__, value.__defaults__, value.__kwdefaults__, value.__dict__,
                *(value.__closure__ or ())]
    if kind is types.CellType:
        return [value.cell_contents] if _is_full(value) else []
    if kind is types.MethodType:
        return [value.__func__, value.__self__]
    if kind is property:
        return [value.fget, value.fset, value.fdel]
    if kind is functools.partial:
        return [value.func, value.args, value.keywords]
    if kind is functools.cached_property:
        return [value.func]
    if isinstance(value, _BY_NAME):
        return [value.__name__]
    if kind in _WRAPPERS:
        return [value.__wrapped__]
    return None


def _is_full(cell: types.CellType) -> bool:
    try:
        cell.cell_contents
    except ValueError:
        return False
    return True


def _is_told(name: str, value: Any) -> bool:
    """Whether an attribute of a class tells what the method does, and is none that Python makes."""
    if name.startswith("__") and name.endswith("__"):
        return callable(value) or hasattr(value, "__get__")
    return name != "_abc_impl"


def _held(method: Any, classes: list[type]) -> Iterable[tuple[str, Any]]:
    """The attributes of an object, those in slots too."""
    slots = [name for kind in classes for name, value in vars(kind).items()
             if isinstance(value, types.MemberDescriptorType)]
    yield from sorted(vars(method).items())
    yield from ((name, getattr(method, name)) for name in sorted(slots) if hasattr(method, name))


def content_version(method: Any, name: str, base: type, parameters: Iterable[str]) -> str:
    """A hash of the code of a method's classes up to `base`, and of what they and the object hold
    beside the `parameters`, which a result tells by themselves.

    name: what results call the method.
    Raises UsageError if something that it holds has no content that could be compared.
    """
    classes = [kind for kind in type(method).__mro__ if kind not in base.__mro__]
    known = {id(kind): f"class {i}" for i, kind in enumerate(classes)}
    known.update({id(base): "base", id(method): "method"})
    content = _Hash(known)
    told = [(kind.__qualname__, attribute, value) for kind in classes
            for attribute, value in sorted(vars(kind).items()) if _is_told(attribute, value)]
    told += [("self", attribute, value) for attribute, value in _held(method, classes)]
    for owner, attribute, value in told:
        if attribute in parameters and isinstance(value, (bool, int, float, str)):
            continue
        content.add((owner, attribute))
        try:
            content.add(value)
        except Exception as error:
            raise _raymoval.UsageError(
                f"method '{name}': {owner}.{attribute} holds something that cannot be stored "
                f"({error}), so nobody could tell whether results are of this method or of an "
                "earlier one. Give the class a `version`, such as \"1\", and raise it whenever "
                "answers may change.") from None
    return "python-" + content.hexdigest()[:16]
