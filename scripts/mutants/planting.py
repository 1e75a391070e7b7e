# SPDX-License-Identifier: MIT
"""Writes a file with all its mutants in it, each behind a switch that is read when it runs.

One build serves all mutants: `a < b` becomes `(mutant_on(7) ? (a <= b) : (a < b))`. What does not
compile is taken out again, by the place that the compiler names."""

import dataclasses
import hashlib
import json
import re

import syntax

SWITCH = """// SPDX-License-Identifier: MIT
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

// Which mutant is on, of RAYMOVAL_MUTANT; and a file with a byte for each mutant, of
// RAYMOVAL_MUTANTS_REACHED, where those that were asked for are noted, by child processes, too.
namespace raymoval_mutants {
inline int active() {
  const char* text = std::getenv("RAYMOVAL_MUTANT");
  return text == nullptr ? -1 : std::atoi(text);
}
inline unsigned char* reached_bytes() {
  const char* path = std::getenv("RAYMOVAL_MUTANTS_REACHED");
  if (path == nullptr) return nullptr;
  const int file = ::open(path, O_RDWR | O_CLOEXEC);
  const auto size = static_cast<std::size_t>(::lseek(file, 0, SEEK_END));
  void* bytes = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  return bytes == MAP_FAILED ? nullptr : static_cast<unsigned char*>(bytes);
}
inline const int chosen = active();
inline unsigned char* const reached = reached_bytes();
}  // namespace raymoval_mutants

inline bool mutant_on(int number) {
  if (__builtin_expect(raymoval_mutants::reached != nullptr, 0)) {
    raymoval_mutants::reached[number] = 1;
  }
  return __builtin_expect(number == raymoval_mutants::chosen, 0);
}
"""


@dataclasses.dataclass
class Mutant:
    number: int
    file: str
    line: int
    function: str
    change: str
    text: str
    dropped: bool = False

    def key(self):
        return (self.file, self.function, self.change)


@dataclasses.dataclass
class Node:
    """A place with the places inside of it."""
    kind: int
    start: int
    end: int
    mutants: list
    inner: list = dataclasses.field(default_factory=list)


def merged(places):
    """Places with equal extents become one; the outer before the inner."""
    by_extent = {}
    for place in places:
        found = by_extent.setdefault((place.start, place.end), {})
        found.setdefault(place.kind, place)
        known = {text for text, _ in found[place.kind].changes}
        found[place.kind].changes += [c for c in place.changes if c[0] not in known]
    result = []
    for kinds in by_extent.values():
        # Where an expression is changed itself, its negation as a condition adds nothing.
        if syntax.EXPRESSION in kinds:
            kinds.pop(syntax.CONDITION, None)
        result += kinds.values()
    return sorted(result, key=lambda p: (p.start, -p.end))


def make_nodes(source, name, places, first_number):
    """The tree of places and the mutants, which are numbered from `first_number` on."""
    root = Node(-1, 0, len(source.text), [])
    stack, mutants = [root], []
    for place in merged(places):
        while place.start >= stack[-1].end:
            stack.pop()
        if place.end > stack[-1].end:
            continue
        line = source.text.count("\n", 0, place.start) + 1
        node = Node(place.kind, place.start, place.end, [])
        for text, told in place.changes:
            mutant = Mutant(first_number + len(mutants), name, line, place.function, told, text)
            mutants.append(mutant)
            node.mutants.append(mutant)
        stack[-1].inner.append(node)
        stack.append(node)
    return root, mutants


class Rendering:
    """The text of a file with its mutants, and where each of them stands in it."""

    def __init__(self, source, root, constants):
        self.source = source
        # constexpr -> const, so that these values may be changed when it runs.
        self.loose = sorted((c.at, c.instead) for c in constants)
        self.parts, self.length, self.regions = [], 0, []
        self._node(root)
        text = "".join(self.parts)
        first_line = text.index("\n")
        include = '#include "mutant_switch.h"'
        self.text = include + text[first_line:]
        self.shift = len(include) - first_line

    def _put(self, text):
        self.parts.append(text)
        self.length += len(text)

    def _code(self, start, end):
        for at, instead in self.loose:
            if start <= at < end:
                self._put(self.source.text[start:at] + instead)
                start = at + len("constexpr")
        self._put(self.source.text[start:end])

    def _inner(self, node):
        at = node.start
        for child in node.inner:
            self._code(at, child.start)
            self._node(child)
            at = child.end
        self._code(at, node.end)

    def _node(self, node):
        began = self.length
        mutants = [m for m in node.mutants if not m.dropped]
        if not mutants:
            self._inner(node)
        elif node.kind == syntax.STATEMENT:
            self._put("{ ")
            for mutant in mutants:
                self._mutant(mutant, f"if (mutant_on({mutant.number})) {{ {mutant.text} }} else ")
            self._put("{ ")
            self._inner(node)
            self._put(" } }")
        else:
            self._put("(")
            for mutant in mutants:
                self._mutant(mutant, f"mutant_on({mutant.number}) ? ({mutant.text}) : ")
            self._put("static_cast<bool>(" if node.kind == syntax.CONDITION else "(")
            self._inner(node)
            self._put("))")
        if mutants:
            self.regions.append((began, self.length, mutants))

    def _mutant(self, mutant, text):
        began = self.length
        self._put(text)
        self.regions.append((began, self.length, [mutant]))

    def mutants_at(self, line, column):
        """The mutants to blame for an error at this line and column of the text (from 1)."""
        offset = -1
        for _ in range(line - 1):
            offset = self.text.index("\n", offset + 1)
        exact = offset + column - self.shift
        covering = [r for r in self.regions if r[0] <= exact < r[1]]
        if covering:
            return min(covering, key=lambda r: r[1] - r[0])[2]
        end = self.text.find("\n", offset + 1) - self.shift
        return [m for r in self.regions if r[0] < end and r[1] > offset + 1 - self.shift
                for m in r[2]]


class Planted:
    """A file with its mutants, which is written anew as long as something does not compile."""

    def __init__(self, source, name, places, constants, first_number, folder):
        self.source, self.name, self.path = source, name, folder / name
        self.known = folder.parent / "dropped" / (name.replace("/", "-") + ".json")
        self.root, self.mutants = make_nodes(source, name, places, first_number)
        self.constants = [c for c in constants if self._holds_mutant(c)]
        self.rendering = Rendering(self.source, self.root, self.constants)
        self.begin = hashlib.sha256(self.rendering.text.encode("latin-1")).hexdigest()
        self._take_out_known()
        self.write()

    def _take_out_known(self):
        """What did not compile the last time, if the file is the same."""
        if not self.known.exists():
            return
        begin, dropped, constants = json.loads(self.known.read_text())
        if begin != self.begin:
            return
        for mutant in self.mutants:
            mutant.dropped = mutant.number in dropped
        self.constants = [c for c in self.constants if c.name in constants]

    def _holds_mutant(self, constant, node=None):
        return any(constant.at < n.start < constant.end or self._holds_mutant(constant, n)
                   for n in (node or self.root).inner)

    def write(self):
        self.rendering = Rendering(self.source, self.root, self.constants)
        text = self.rendering.text.encode("latin-1")
        if not self.path.exists() or self.path.read_bytes() != text:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self.path.write_bytes(text)
        self.known.parent.mkdir(parents=True, exist_ok=True)
        self.known.write_text(json.dumps([self.begin, [m.number for m in self.mutants if m.dropped],
                                          [c.name for c in self.constants]]))

    def is_named_in(self, errors):
        """The compiler may name the file from another folder."""
        return f"/source/{self.name}:" in errors

    def repair(self, errors):
        """Takes out what the compiler's `errors` are about. Returns whether there was something."""
        names = set(re.findall(r"the value of '[^']*?(\w+)' is not usable", errors))
        names |= set(re.findall(r"'[^']*?(\w+)' was not declared 'constexpr'", errors))
        firm = [c for c in self.constants if c.name in names]
        self.constants = [c for c in self.constants if c not in firm]
        blamed = [] if firm else self._blamed(errors)
        for mutant in blamed:
            mutant.dropped = True
        if firm or blamed:
            self.write()
        return bool(firm or blamed)

    def _blamed(self, errors):
        pattern = re.escape(f"/source/{self.name}") + r":(\d+):(\d+): +(error|required)"
        places = re.findall(pattern, errors)
        kinds = {kind for _, _, kind in places}
        wanted = "error" if "error" in kinds else "required"
        mutants = []
        for line, column, kind in places:
            if kind == wanted:
                mutants += self.rendering.mutants_at(int(line), int(column))
        return [m for m in mutants if not m.dropped]
