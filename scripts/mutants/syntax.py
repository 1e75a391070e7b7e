# SPDX-License-Identifier: MIT
"""Walks clang's syntax tree of a file and collects the places where a mutant can be planted."""

import dataclasses
import hashlib
import pathlib
import pickle
import re
import shlex
import sys

import operators

try:
    import clang.cindex as cindex
except ImportError:
    sys.exit("mutate.sh: clang's Python module is missing. Install it: "
             "apt-get install python3-clang-14")

EXPRESSION, CONDITION, STATEMENT = range(3)


@dataclasses.dataclass
class Place:
    """A stretch of code [start, end) and the texts that may stand there instead."""
    kind: int
    start: int
    end: int
    function: str
    changes: list  # of (text, how it is told)


def short(text):
    """At most about 80 characters of a text: its begin and its end."""
    return text if len(text) <= 80 else f"{text[:50]} ... {text[-25:]}"


def clang_arguments(command):
    """What clang needs to know of a compile command of GCC."""
    words, chosen = shlex.split(command), []
    for i, word in enumerate(words):
        if word.startswith(("-I", "-D", "-std=")) and len(word) > 2:
            chosen.append(word)
        elif word in ("-isystem", "-I", "-D"):
            chosen += [word, words[i + 1]]
    return chosen


@dataclasses.dataclass
class Constant:
    """A variable that is constexpr: the offset of that word, the end, and what stands instead of it
    where the value may change."""
    name: str
    at: int
    end: int
    instead: str


class Walker:
    """Collects the places of one file, which may be a header of what is parsed."""

    def __init__(self, source):
        self.source = source
        self.places = []
        self.constants = []

    def walk_unit(self, unit):
        name = str(self.source.path)
        for cursor in unit.cursor.get_children():
            if cursor.location.file is not None and cursor.location.file.name == name:
                self._visit(cursor, None, "")

    def _add(self, kind, start, end, function, texts, told=None):
        source = self.source
        if start >= end or source.has_directive(start, end):
            return
        old = source.one_line(start, end)
        changes = []
        for text in texts:
            text = re.sub(r"\s*\n\s*", " ", text).strip()
            changes.append((text, told or f"{short(old)} -> {short(text)}"))
        if changes:
            self.places.append(Place(kind, start, end, function, changes))

    def _visit(self, cursor, parent, function):
        kinds, kind = cindex.CursorKind, cursor.kind
        if kind in (kinds.CXX_THROW_EXPR, kinds.STATIC_ASSERT, kinds.ENUM_CONSTANT_DECL):
            return  # What a throw holds is a message.
        if kind in (kinds.FUNCTION_DECL, kinds.CXX_METHOD, kinds.CONSTRUCTOR, kinds.DESTRUCTOR,
                    kinds.FUNCTION_TEMPLATE, kinds.CONVERSION_FUNCTION):
            function = cursor.spelling.split("<")[0] or function
        if kind == kinds.VAR_DECL and not function:
            function = cursor.spelling
        if kind == kinds.FIELD_DECL:
            function = cursor.spelling
        if kind == kinds.VAR_DECL:
            self._note_constant(cursor)
        self._changes_of(cursor, kind, function)
        children = list(cursor.get_children())
        for i, child in enumerate(children):
            if kind == kinds.CASE_STMT and i == 0 or self._is_part_of_type(cursor, child):
                continue
            if self._is_statement(cursor, children, i):
                self._statement(child, function)
            self._visit(child, cursor, function)

    def _is_part_of_type(self, cursor, child):
        """As the 3 in `std::array<int, 3> list`."""
        kinds = cindex.CursorKind
        return child.kind == kinds.INTEGER_LITERAL and \
            cursor.kind in (kinds.VAR_DECL, kinds.FIELD_DECL, kinds.PARM_DECL, kinds.CXX_METHOD,
                            kinds.FUNCTION_DECL, kinds.FUNCTION_TEMPLATE) and \
            child.extent.start.offset < cursor.location.offset

    def _note_constant(self, cursor):
        kinds = cindex.CursorKind
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        found = re.match(r"(?:(?:static|inline)\s+)*constexpr\b", self.source.plain[start:end])
        if not found or "*" in self.source.plain[start:end].split("=")[0]:
            return
        member = cursor.semantic_parent.kind in (kinds.STRUCT_DECL, kinds.CLASS_DECL,
                                                 kinds.CLASS_TEMPLATE)
        self.constants.append(Constant(cursor.spelling, start + found.end() - len("constexpr"), end,
                                       "inline const" if member else "const"))

    def _is_statement(self, parent, children, i):
        kinds, kind = cindex.CursorKind, parent.kind
        if kind == kinds.COMPOUND_STMT:
            return True
        if kind == kinds.IF_STMT:
            opening = self.source.plain.find("(", parent.extent.start.offset)
            return children[i].extent.start.offset > self.source.closing(opening)
        if kind in (kinds.FOR_STMT, kinds.WHILE_STMT, kinds.CXX_FOR_RANGE_STMT, kinds.CASE_STMT,
                    kinds.DEFAULT_STMT):
            return i == len(children) - 1
        return False

    def _statement(self, cursor, function):
        """A statement that can be left out."""
        kinds = cindex.CursorKind
        removable = (kinds.CALL_EXPR, kinds.BINARY_OPERATOR, kinds.COMPOUND_ASSIGNMENT_OPERATOR,
                     kinds.UNARY_OPERATOR, kinds.BREAK_STMT, kinds.CONTINUE_STMT,
                     kinds.CXX_THROW_EXPR, kinds.UNEXPOSED_EXPR)
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        is_return = cursor.kind == kinds.RETURN_STMT
        if not is_return and cursor.kind not in removable:
            return
        semicolon = re.match(r"\s*;", self.source.plain[end:])
        if not semicolon:
            return
        end += semicolon.end()
        old = self.source.one_line(start, end)
        if is_return and list(cursor.get_children()):
            value = self.source.one_line(start + len("return"), end)
            if value not in ("{};", "false;", "true;", "0;", "nullptr;", "std::nullopt;"):
                self._add(STATEMENT, start, end, function, ["return {};"])
            return
        self._add(STATEMENT, start, end, function, [""], f"{short(old)} -> removed")

    def _changes_of(self, cursor, kind, function):
        kinds = cindex.CursorKind
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        text = self.source.code[start:end]
        if kind == kinds.INTEGER_LITERAL:
            self._add(EXPRESSION, start, end, function, operators.integer(text))
        elif kind == kinds.FLOATING_LITERAL:
            self._add(EXPRESSION, start, end, function, operators.floating(text))
        elif kind == kinds.CHARACTER_LITERAL and text.startswith("'"):
            self._add(EXPRESSION, start, end, function, [f"char({text} + 1)"])
        elif kind == kinds.CXX_BOOL_LITERAL_EXPR and text in ("true", "false"):
            self._add(EXPRESSION, start, end, function, ["false" if text == "true" else "true"])
        elif kind in (kinds.BINARY_OPERATOR, kinds.COMPOUND_ASSIGNMENT_OPERATOR):
            self._binary(list(cursor.get_children()), start, end, function)
        elif kind == kinds.UNARY_OPERATOR:
            self._unary(start, end, text, function)
        elif kind == kinds.CALL_EXPR:
            self._call(cursor, start, end, function)
        elif kind == kinds.CONDITIONAL_OPERATOR:
            self._condition(list(cursor.get_children())[0], function)
        elif kind in (kinds.IF_STMT, kinds.WHILE_STMT):
            self._if_condition(cursor, start, function)

    def _binary(self, children, start, end, function):
        if len(children) != 2:
            return
        source, (left, right) = self.source, children
        middle = source.plain[left.extent.end.offset:right.extent.start.offset].strip()
        texts = [source.code[start:left.extent.end.offset], middle,
                 source.code[right.extent.start.offset:end]]
        made = operators.binary(*texts) or operators.assignment(*texts)
        self._add(EXPRESSION, start, end, function, made)

    def _unary(self, start, end, text, function):
        if text.startswith(("!", "-")) and not text.startswith(("!=", "--", "-=")):
            if not re.fullmatch(r"-\s*[0-9.]+[a-zA-Z]*", text) or text.startswith("!"):
                self._add(EXPRESSION, start, end, function,
                          [f"bool({text[1:]})" if text[0] == "!" else text[1:]])
            else:
                self._add(EXPRESSION, start, end, function, [text[1:]])

    def _call(self, cursor, start, end, function):
        source, name = self.source, cursor.spelling
        if name.startswith("operator"):
            if "basic_string" in cursor.type.get_canonical().spelling:
                return  # Text that is put together.
            children = sorted(cursor.get_children(), key=lambda c: c.extent.start.offset)
            if len(children) == 3:
                # Where the compiler exchanges both sides (`"a" == text` asks `text == "a"`), the
                # call itself begins behind its end.
                self._binary([children[0], children[2]], children[0].extent.start.offset,
                             children[2].extent.end.offset, function)
            return
        found = re.search(r"\b" + re.escape(name) + r"(?=(?:<[^()]*>)?\()",
                          source.plain[start:end]) if name else None
        arguments = list(cursor.get_arguments())
        if found:
            at = found.start()
            if arguments and name in ("x", "y", "z"):
                at = None
            if name in ("x", "y", "z", "front", "back", "norm", "squaredNorm"):
                # The last one, as in `a.x().front()`.
                at = source.plain[start:end].rfind(name + "(")
            if at is not None and at >= 0:
                self._add(EXPRESSION, start, end, function,
                          operators.call(name, source.code[start:end], at))
        self._swap_arguments(arguments, start, end, function)

    def _swap_arguments(self, arguments, start, end, function):
        """Neighbours of one type change places."""
        source = self.source
        for one, two in zip(arguments, arguments[1:]):
            spans = [(a.extent.start.offset, a.extent.end.offset) for a in (one, two)]
            (a, b), (c, d) = spans
            same = one.type.get_canonical().spelling.replace("const ", "") == \
                two.type.get_canonical().spelling.replace("const ", "")
            if not same or not start <= a < b < c < d <= end:
                continue
            first, second = source.code[a:b], source.code[c:d]
            if first.endswith("begin()") or second.endswith("end()"):
                continue  # It would only crash.
            literals = first.startswith('"') or second.startswith('"')
            if first != second and not literals and first and second:
                self._add(EXPRESSION, start, end, function,
                          [source.code[start:a] + second + source.code[b:c] + first +
                           source.code[d:end]],
                          f"{short(source.one_line(a, d))} -> exchanged")

    def _condition(self, cursor, function):
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        text = self.source.one_line(start, end)
        self._add(CONDITION, start, end, function, [f"!({text})"])

    def _if_condition(self, cursor, start, function):
        source = self.source
        opening = source.plain.find("(", start)
        closing = source.closing(opening)
        if re.match(r"if\s+constexpr", source.plain[start:]):
            return
        inside = [c for c in cursor.get_children()
                  if opening < c.extent.start.offset and c.extent.end.offset <= closing]
        declarations = (cindex.CursorKind.DECL_STMT, cindex.CursorKind.VAR_DECL)
        if inside and inside[-1].kind not in declarations:
            self._condition(inside[-1], function)


def places_of(source, unit_path, command, cache):
    """The places of `source` and its constants, seen from the source file `unit_path`. What was
    found before stands in the folder `cache`."""
    own = "".join(p.read_text() for p in sorted(pathlib.Path(__file__).parent.glob("*.py"))
                  if p.name in ("syntax.py", "operators.py", "source_text.py"))
    key = hashlib.sha256((source.text + command + own).encode("latin-1", "replace")).hexdigest()
    known = cache / key
    if known.exists():
        return *pickle.loads(known.read_bytes()), []
    places, constants, errors = _walk(source, unit_path, command)
    if not errors:
        cache.mkdir(parents=True, exist_ok=True)
        known.write_bytes(pickle.dumps((places, constants)))
    return places, constants, errors


def _walk(source, unit_path, command):
    unit = cindex.Index.create().parse(str(unit_path), args=clang_arguments(command))
    errors = [str(d) for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Error]
    walker = Walker(source)
    walker.walk_unit(unit)
    return walker.places, walker.constants, errors
