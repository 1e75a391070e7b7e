# SPDX-License-Identifier: MIT
"""The small changes that are planted, one list of texts for each place in the syntax tree."""

import re

_COMPARISONS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"),
    "==": ("!=",), "!=": ("==",),
}
_ARITHMETIC = {
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",), "<<": (">>",), ">>": ("<<",),
    "&": ("|",), "|": ("&",), "^": ("&",),
}
_ASSIGNMENTS = {
    "+=": ("-=", "="), "-=": ("+=", "="), "*=": ("/=",), "/=": ("*=",), "|=": ("&=", "="),
    "&=": ("|=", "="), "^=": ("=",), "<<=": (">>=",), ">>=": ("<<=",), "%=": ("=",),
}
# Calls whose name has a near relative.
_RELATIVES = {
    "min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "round": "floor",
    "lround": "floor", "lower_bound": "upper_bound", "upper_bound": "lower_bound",
    "all_of": "any_of", "any_of": "all_of", "none_of": "any_of", "front": "back", "back": "front",
    "x": "y", "y": "z", "z": "x", "sin": "cos", "cos": "sin", "abs": "", "sqrt": "",
    "min_element": "max_element", "max_element": "min_element", "squaredNorm": "norm",
    "norm": "squaredNorm", "starts_with": "ends_with", "ends_with": "starts_with",
    "stable_sort": "", "begin": "", "empty": "",
}


def binary(left, operator, right):
    """Texts for `left operator right`."""
    if operator in _COMPARISONS:
        return [f"{left} {other} {right}" for other in _COMPARISONS[operator]]
    if operator in _ARITHMETIC:
        return [f"{left} {other} {right}" for other in _ARITHMETIC[operator]]
    if operator in ("&&", "||"):
        # Either side alone; that kills whatever exchanging the operator would.
        return [f"bool({left})", f"bool({right})"]
    return []


def assignment(left, operator, right):
    """Texts for `left operator right`, which changes `left`."""
    return [f"{left} {other} {right}" for other in _ASSIGNMENTS.get(operator, ())]


def integer(text):
    """One more and one less, in the same type."""
    texts = [f"{text} + 1"]
    try:
        digits = re.sub(r"[uUlLzZ]+$", "", text.replace("'", ""))
        value = int(digits, 0) if not re.fullmatch(r"0[0-7]+", digits) else int(digits, 8)
    except ValueError:
        return []
    if value > 0:
        texts.append(f"{text} - 1")
    return texts


def floating(text):
    """Twice and half of it; zero becomes one."""
    digits = text.replace("'", "").rstrip("fFlL")
    try:
        zero = float.fromhex(digits) == 0 if digits.startswith("0x") else float(digits) == 0
    except ValueError:
        return []
    return [f"{text} + 1"] if zero else [f"{text} * 2", f"{text} / 2"]


def call(name, text, name_at):
    """`text` with the called `name`, which stands at `name_at`, exchanged for its relative."""
    other = _RELATIVES.get(name, "")
    return [text[:name_at] + other + text[name_at + len(name):]] if other else []
