# SPDX-License-Identifier: MIT
"""Pages that are made of what the program says of itself: its commands, and the parameters of its methods and protocols."""

import ast
import html
import inspect
import re
import shutil
import subprocess

# Pages that are generated from the program's own descriptions.
COMMANDS = "reference/commands.md"
PARAMETERS = "reference/parameters/"
PYTHON_API = "reference/python.md"
CPP_API = "reference/cpp.md"
EXAMPLE = "reference/example-report.md"
GENERATED = (COMMANDS, PARAMETERS + "*.md", PYTHON_API, CPP_API, EXAMPLE)


def said(program, *arguments):
    """What the program prints, as text."""
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True, encoding="utf-8").stdout


def escaped(text):
    """Text that Markdown shows as it is. What stands between backticks already stays code."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(part if i % 2 else re.sub(r"([\\*_\[\]|~])", r"\\\1", html.escape(part, quote=False))
                   .replace("{", "&#123;") for i, part in enumerate(parts))


def option_table(heading, lines):
    """A table of options, from lines "  --name ARGUMENT   What it does"."""
    rows = []
    for line in lines:
        name, _, text = line.strip().partition("  ")
        if line.startswith("   ") and rows:  # What did not fit in one line.
            rows[-1][1] += " " + line.strip()
        else:
            rows.append([name, text.strip()])
    return [f"| {heading} | |", "|---|---|", *(f"| `{name}` | {escaped(text)} |" for name, text in rows), ""]


def command_section(name, text):
    """A command's help: its sentence, its usage, a table of its options, its examples and its notes."""
    lines = text.rstrip().split("\n")
    made = [f"## raymoval {name}", "", escaped(lines[0]), ""]
    i = 1
    while i < len(lines):
        line = lines[i]
        i += 1
        if line.startswith("Usage:"):
            made += ["```text", line.removeprefix("Usage:").strip(), "```", ""]
        elif line == "Positionals:" or line.lower().endswith("options:"):
            begin = i
            while i < len(lines) and lines[i].startswith("  "):
                i += 1
            made += option_table("argument" if line == "Positionals:" else line[:-1].lower(), lines[begin:i])
        elif line == "Examples:":
            begin = i
            while i < len(lines) and lines[i].startswith("  "):
                i += 1
            made += ["```bash", *(example[2:] for example in lines[begin:i]), "```", ""]
        elif line.startswith("  "):  # A list or a drawing among the notes.
            begin = i - 1
            while i < len(lines) and lines[i].startswith("  "):
                i += 1
            made += ["", "```text", *lines[begin:i], "```", ""]
        else:
            made.append(escaped(line))
    return "\n".join(made) + "\n"


def names_listed(program, what):
    """The names that `raymoval list WHAT` prints, one a line, without what stands for others."""
    return [line.split()[0] for line in said(program, "list", what).split("\n")
            if re.match(r"\s*[a-z]", line) and not line.endswith(":") and "MANIFEST" not in line]


def commands_page(program):
    text = said(program, "--help")
    names = re.findall(r"^  (\w+) ", text.split("Subcommands:")[1].split("\n\n")[0], re.MULTILINE)
    head = ("# Every command\n\nWhat `raymoval help COMMAND` prints. [The program](../docs/program.md) says what all commands "
            "have in common: exit codes, signals, errors.\n")
    return head + "\n" + "\n".join(command_section(name, said(program, "help", name)) for name in names)


def parameter_page(program, name, title):
    """A page of `raymoval describe --markdown`: its sentence, source and variants, and the table of parameters."""
    text = said(program, "describe", name, "--markdown")
    text = re.sub(r"^### .*\n", "", text.lstrip(), count=1)
    # A choice between values is written with bars.
    text = re.sub(r"(?<=[^\n ])\|(?=[^\n ])", r"\\|", text)
    text = re.sub(r"^\| (\w+) +\|", lambda match: match[0] if match[1] == "name" else f"| `{match[1]}` |", text,
                  flags=re.MULTILINE)
    return f"# {title}\n\n{text.strip()}\n"


def pages(program, house):
    """{path: text} of the pages that only the program is asked for. `house` is the folder of the repository."""
    made = {COMMANDS: commands_page(program)}
    for name in names_listed(program, "methods"):
        if name in ("noop", "remove-all", "oracle"):
            continue
        made[f"{PARAMETERS}{name}.md"] = parameter_page(program, name, name)
        if (house / f"methods/{name}/README.md").is_file():
            made[f"{PARAMETERS}{name}.md"] += f"\n[How {name} works](../../methods/{name}/README.md), and what it scores.\n"
    for name in names_listed(program, "protocols"):
        made[f"{PARAMETERS}protocol-{name}.md"] = parameter_page(
            program, "protocol:" + name, f"Protocol {name}") + (
            "\n[The protocols](../../docs/protocols.md), with pictures and examples.\n")
    return made


FIRST_CLASSES = (
    ("Remover", "a method"), ("ScanSource", "the scans that a method is given"),
    ("RemovalSink", "takes its answer, a mask for each scan"), ("RunContext", "threads, progress, stages, reasons"),
    ("MethodRegistry", "all methods, and how yours is added"),
    ("ParameterTable", "names, units, ranges and sources of parameters"), ("Scan", "points, pose and time"),
    ("SensorModel", "what is known of a sensor"), ("LocalFrameSource", "scans as the harness gives them to methods"),
    ("Protocol", "scores an answer"), ("ProtocolEntry", "what a protocol is"), ("RateSpec", "what a rate is"))


def cpp_page(made, target):
    """The page that leads to those of Doxygen, which are copied to `target`."""
    text = ["# C++, every header", "",
            "[The C++ library](../examples/cpp_method/README.md) says which library holds what, and has an example."]
    if made is None:
        return "\n".join([*text, "", "The pages of the headers are not here: `scripts/docs.sh` makes them where Doxygen is.", ""])
    shutil.copytree(made, target)
    text += ["", "[All classes](../cpp/annotated.html) · [all headers](../cpp/files.html)", "",
             "Those to start with:", "", "| class | |", "|---|---|"]
    for name, sentence in FIRST_CLASSES:
        page = next((f"{kind}raymoval_1_1{name}.html" for kind in ("class", "struct")
                     if (made / f"{kind}raymoval_1_1{name}.html").exists()), None)
        if page is None:
            raise SystemExit(f"reference.py: Doxygen has no class {name}; name another one in FIRST_CLASSES.")
        text.append(f"| [{name}](../cpp/{page}) | {sentence} |")
    return "\n".join(text) + "\n"


def example_page(report, target):
    """The page that shows the report of an example run, which is copied to `target`."""
    text = ["# A report to look at", "", "`raymoval report` writes a run as one page: tables that sort, charts, and the points in 3-D. "
            "[Pictures and reports](../docs/pictures-and-reports.md) says what it has.", ""]
    if report is None:
        return "\n".join([*text, "It is not here: `scripts/docs.sh` makes it, unless it is told `--without-report`.", ""])
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(report, target)
    return "\n".join([*text, "This one is of the small scene that is built in:", "", "```bash",
                      "raymoval run --sequence street --method raymoval_plus --method raymoval:online --keep-removals --out out/street",
                      "raymoval report out/street", "```", "",
                      "[Open it](report.html){ .md-button .md-button--primary }", ""])


# The page of all names of the Python package, from its source and its stub: nothing is imported, so that the package
# need not be built.


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


def python_page(folder):
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
        raise SystemExit(f"reference.py: {', '.join(sorted(missing))}: in __all__, and nowhere defined.")
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
