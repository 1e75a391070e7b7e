# SPDX-License-Identifier: MIT
"""Lays out what mkdocs makes the site of: the pages of the repository where they stand in it, so that their links stay
as they are, the files that they link to, and the pages that are made of what the program says of itself.

    stage.py --program PATH/TO/raymoval --out FOLDER [--cpp FOLDER] [--report FILE]

FOLDER gets pages/ and mkdocs.yml. --cpp is what Doxygen made, --report the page of an example run. Without them their
pages say how they are made."""

import argparse
import json
import pathlib
import re
import shutil
import sys

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
HOUSE = HERE.parent.parent
sys.path.insert(0, str(HERE))

import navigation  # noqa: E402
import python_api  # noqa: E402
import reference  # noqa: E402

LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")
# A code block is told by its first word.
LANGUAGES = ((r"(import|class \w+.*:$|masks = |sequence = |world = |raymoval\.)", "python"),
             (r"(#include|class \w+ : )", "cpp"), (r"[{\[]", "json"),
             (r"([\w.]*raymoval |near_points |scripts/|cmake |export |source |sudo |apt|docker |podman |ctest |pip )", "bash"))


def fenced(block):
    """A block of code with the name of its language, which colours it."""
    language = next((name for form, name in LANGUAGES if re.match(form, block[0])), "text")
    return ["```" + language, *block, "```"]


def with_fences(lines):
    """Indented blocks of code between paragraphs become fenced ones. Those of lists stay."""
    made, block, before = [], [], ""
    for line in [*lines, "."]:
        if (line.startswith("    ") and not re.match(r"(\s|[-*] |\d+\. )", before)) or (block and not line.strip()):
            block.append(line[4:])
            continue
        if block:
            blank = len(block) - len("\n".join(block).rstrip().split("\n"))
            made += fenced(block[:len(block) - blank]) + [""] * blank
            block = []
        made.append(line)
        before = line if line.strip() else before
    return made[:-1]


def for_mkdocs(text):
    """A page as mkdocs reads it: a table begins after an empty line, and code has a language."""
    lines = []
    for line in text.split("\n"):
        if lines and lines[-1].endswith("-->") and line.startswith("|"):
            lines.append("")
        if lines and lines[-1].startswith("|") and line.startswith("<!--"):
            lines.append("")
        # Between backticks a bar needs no backslash here.
        lines.append(line.replace("\\|", "|") if line.startswith("|") and "`" in line else line)
    return "\n".join(with_fences(lines))


def home(text):
    """The README as the first page of the site: buttons below its promise, and the whole width."""
    buttons = " ".join(f"[{title}]({page}){{ .md-button{' .md-button--primary' if first else ''} }}" for first, title, page in (
        (True, "Start in two minutes", "docs/getting-started.md"), (False, "Clean your map", "docs/clean.md"),
        (False, "Compare methods", "docs/compare-methods.md"), (False, "Add a method", "docs/your-method.md")))
    before, picture, after = text.partition("\n![")
    return f"---\ntitle: raymoval\nhide: [navigation, toc]\n---\n{before}\n{buttons}\n{picture}{after}"


def put(target, text):
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text, encoding="utf-8")


def stage_pages(pages, folder):
    """Writes `pages` of the repository below `folder`, and copies the files that they link to."""
    for page in pages:
        text = (HOUSE / page).read_text(encoding="utf-8")
        for match in LINK.finditer(text):
            link = (match[1] or match[2]).split("#")[0]
            source = (HOUSE / page).parent / link
            if not link or "://" in link or link.endswith(".md") or not source.is_file():
                continue
            target = folder / source.resolve().relative_to(HOUSE)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
        text = for_mkdocs(text)
        parameters = f"{navigation.PARAMETERS}{pathlib.PurePath(page).parent.name}.md"
        if pathlib.PurePath(page).match("methods/*/README.md"):
            text += f"\n[All parameters and variants](../../{parameters}), as the program describes them.\n"
        put(folder / page, home(text) if page == "README.md" else text)


def settings(nav, out):
    """mkdocs.yml: that of this folder, the sections, and where things are. What JSON writes is YAML, too."""
    places = {"docs_dir": str(out / "pages"), "site_dir": str(out.parent / "site"),
              "nav": nav, "watch": [str(HOUSE / "docs")]}
    lines = [f"{key}: {json.dumps(value)}" for key, value in places.items()]
    text = (HERE / "mkdocs.yml").read_text(encoding="utf-8").replace("custom_dir: theme", f"custom_dir: {json.dumps(str(HERE / 'theme'))}")
    return text + "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--cpp", type=pathlib.Path)
    parser.add_argument("--report", type=pathlib.Path)
    given = parser.parse_args()
    out = given.out.resolve()
    pages = out / "pages"
    shutil.rmtree(pages, ignore_errors=True)
    own = navigation.pages_of(HOUSE)
    stage_pages(own, pages)
    for name in ("site.css", "favicon.svg"):
        shutil.copyfile(HERE / name, pages / name)
    made = reference.pages(given.program.resolve())
    made[navigation.PYTHON_API] = python_api.page(HOUSE / "python/raymoval")
    made[navigation.CPP_API] = reference.cpp_page(given.cpp, pages / "cpp")
    made[navigation.EXAMPLE] = reference.example_page(given.report, pages / "reference/report.html")
    for page, text in made.items():
        put(pages / page, text)
    try:
        nav = navigation.navigation([*own, *made])
    except navigation.NavigationError as error:
        sys.exit(f"stage.py: {error}")
    put(out / "mkdocs.yml", settings(nav, out))
    print(f"stage.py: {len(own)} pages of the repository and {len(made)} made ones in {pages}")


if __name__ == "__main__":
    main()
