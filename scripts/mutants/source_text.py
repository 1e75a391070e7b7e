# SPDX-License-Identifier: MIT
"""A source file as the mutants see it: its bytes as text, and the same without comments."""

import re

_TOKENS = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^()\\\s]*)\(.*?\)(?P=tag)"'
    r"|\"(?:\\.|[^\"\\\n])*\"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'",
    re.DOTALL)


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


class SourceText:
    """`text` has one character for each byte, as clang counts in bytes. `code` has the same length;
    comments are blank in it. In `plain` strings and characters are blank as well."""

    def __init__(self, path):
        self.path = path
        self.text = path.read_bytes().decode("latin-1")
        self.code = _TOKENS.sub(
            lambda m: _blank(m[0]) if m[0].startswith(("//", "/*")) else m[0], self.text)
        self.plain = _TOKENS.sub(lambda m: _blank(m[0]), self.text)

    def one_line(self, start, end):
        """The code between two offsets on one line."""
        return re.sub(r"\s*\n\s*", " ", self.code[start:end]).strip()

    def closing(self, opening):
        """Offset of the bracket that closes the one at `opening`; -1 if there is none."""
        pairs = {"(": ")", "[": "]", "{": "}"}
        depth = 0
        for i in range(opening, len(self.plain)):
            if self.plain[i] in pairs:
                depth += 1
            elif self.plain[i] in pairs.values():
                depth -= 1
                if depth == 0:
                    return i
        return -1

    def has_directive(self, start, end):
        """Whether a line between two offsets is for the preprocessor."""
        return re.search(r"^\s*#", self.text[start:end], re.MULTILINE) is not None
