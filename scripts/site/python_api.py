# SPDX-License-Identifier: MIT
"""The page of all names of the Python package, from its source and its stub: signatures and docstrings. Nothing is
imported, so that the package need not be built."""

import ast
import inspect
import re


def doc(node):
    """A docstring as Markdown. `name: what it is` becomes an item of a list, with the lines that go on with it; what is
    indented after an empty line is code."""
    text = inspect.cleandoc(ast.get_docstring(node, clean=False) or "")
    lines, state, empty = [], "text", True
    for line in text.split("\n"):
        indented = line.startswith("    ")
        if state == "code" and line.strip() and not indented:
            lines += ["```", ""]
            state = "text"
        if state != "code" and indented and empty:
            lines += ["```python"]
            state = "code"
        elif state != "code" and re.match(r"[a-z_]+(, [a-z_]+)*: ", line):
            if state != "list":
                lines.append("")
            name, _, what = line.partition(": ")
            line, state = f"- `{name.replace(', ', '`, `')}`: {what}", "list"
        elif state == "list" and not indented and line.strip():
            lines.append("")
            state = "text"
        elif state == "text" and re.match(r"(Returns|Raises) ", line) and not empty:
            lines.append("")
        lines.append(line[4:] if state == "code" else line)
        empty = not line.strip()
    return "\n".join([*lines, "```"] if state == "code" else lines)


def plain(text):
    """A type without the names of modules, which say nothing to a reader."""
    return re.sub(r"\b(_raymoval|_methods|_sequences|_results|npt|collections\.abc)\.", "", text)


def argument_list(arguments):
    """The arguments of a signature, a text each."""
    one = ast.arguments(posonlyargs=[], args=[], kwonlyargs=[], kw_defaults=[], defaults=[])
    texts = []
    early = len(arguments.args) - len(arguments.defaults)
    for i, argument in enumerate(arguments.args):
        one.args, one.defaults = [argument], arguments.defaults[i - early:i - early + 1] if i >= early else []
        texts.append(ast.unparse(one))
    if arguments.vararg or arguments.kwonlyargs:
        texts.append("*" + (ast.unparse(arguments.vararg) if arguments.vararg else ""))
    for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults):
        texts.append(ast.unparse(argument) + (f"={ast.unparse(default)}" if default else ""))
    return texts + (["**" + ast.unparse(arguments.kwarg)] if arguments.kwarg else [])


def signature(function, owner=""):
    """`name(arguments) -> type`, without self; an argument a line where that is long."""
    own = owner and not any(isinstance(d, ast.Name) and d.id == "staticmethod" for d in function.decorator_list)
    arguments = argument_list(function.args)[1 if own else 0:]
    name = owner if function.name == "__init__" else (f"{owner}.{function.name}" if owner else function.name)
    answer = ast.unparse(function.returns) if function.returns else ""
    end = f" -> {plain(answer)}" if answer and answer != "None" else ""
    text = plain(f"{name}({', '.join(arguments)}){end}")
    return text if len(text) <= 80 else plain(f"{name}(\n    " + ",\n    ".join(arguments) + f"){end}")


def shown(node):
    special = ("__init__", "__len__", "__getitem__", "__iter__")
    return not node.name.startswith("_") or node.name in special


def members(node):
    """Attributes and properties as a table; functions after it, each with its signature."""
    rows, functions, comments = [], [], []
    for item in node.body:
        if isinstance(item, ast.AnnAssign) and not item.target.id.startswith("_"):
            rows.append((item.target.id, plain(ast.unparse(item.annotation)), ""))
        elif isinstance(item, ast.FunctionDef) and any(
                isinstance(d, ast.Name) and d.id in ("property", "cached_property") for d in item.decorator_list):
            rows.append((item.name, plain(ast.unparse(item.returns)) if item.returns else "", doc(item).replace("\n", " ")))
        elif isinstance(item, ast.FunctionDef) and shown(item):
            functions.append(item)
    if rows:
        comments += ["| attribute | type | |", "|---|---|---|",
                     *(f"| `{name}` | `{kind}` | {text} |" for name, kind, text in rows), ""]
    for item in functions:
        if item.name in ("__len__", "__iter__", "__getitem__"):
            continue
        comments += ["```python", signature(item, node.name), "```", "", doc(item), ""]
    return comments


def section(node):
    made = [f"### {node.name}", ""]
    if isinstance(node, ast.FunctionDef):
        return [*made, "```python", signature(node), "```", "", doc(node), ""]
    bases = [ast.unparse(base) for base in node.bases]
    if bases:
        made += [f"A `{'`, `'.join(bases)}`.", ""]
    return [*made, doc(node), "", *members(node)]


def page(folder):
    """The page as Markdown. `folder` is that of the package's source."""
    package = ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))
    names = next(ast.literal_eval(node.value) for node in package.body
                 if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    found = {}
    for source in [folder / "_raymoval.pyi", *sorted(folder.glob("_[a-z]*.py"))]:
        for node in ast.parse(source.read_text(encoding="utf-8")).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name in names:
                found[node.name] = node
    missing = set(names) - set(found) - {"__version__"}
    if missing:
        raise SystemExit(f"python_api.py: {', '.join(sorted(missing))}: in __all__, and nowhere defined.")
    errors = {name for name, node in found.items() if isinstance(node, ast.ClassDef)
              and (name == "Error" or "Error" in [ast.unparse(base) for base in node.bases])}
    groups = (("Functions", [name for name in names if isinstance(found.get(name), ast.FunctionDef)]),
              ("Classes", [name for name in names if isinstance(found.get(name), ast.ClassDef) and name not in errors]),
              ("Errors", [name for name in names if name in errors]))
    lines = ["# Python, every name", "", "[Python](../docs/python.md) tells how the package is used.", "", doc(package), ""]
    for title, group in groups:
        lines += [f"## {title}", ""]
        for name in group:
            lines += section(found[name])
    return "\n".join(lines) + "\n"
