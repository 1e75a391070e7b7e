# SPDX-License-Identifier: MIT
"""Pages that are made of what the program says of itself: its commands, and the parameters of its methods and protocols."""

import html
import re
import shutil
import subprocess

import navigation


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
    blocks = {"Positionals:": "argument", "Options:": "option"}
    i = 1
    while i < len(lines):
        line = lines[i]
        i += 1
        if line.startswith("Usage:"):
            made += ["```text", line.removeprefix("Usage:").strip(), "```", ""]
        elif line in blocks:
            begin = i
            while i < len(lines) and lines[i].startswith("  "):
                i += 1
            made += option_table(blocks[line], lines[begin:i])
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
            "have in common: exit codes, signals, errors, completion.\n")
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


def pages(program):
    """{path: text} of the pages that only the program is asked for."""
    made = {navigation.COMMANDS: commands_page(program)}
    for name in names_listed(program, "methods"):
        if name in ("noop", "remove-all", "oracle"):
            continue
        made[f"{navigation.PARAMETERS}{name}.md"] = parameter_page(program, name, name) + (
            f"\n[How {name} works](../../methods/{name}/README.md), and what it scores.\n")
    for name in names_listed(program, "protocols"):
        made[f"{navigation.PARAMETERS}protocol-{name}.md"] = parameter_page(
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
