# SPDX-License-Identifier: MIT
"""Prepares the files from which mkdocs makes the site, and checks the site.

    stage.py --program PATH/TO/raymoval --out FOLDER [--cpp FOLDER] [--report FILE]
    stage.py --check SITE

The first form writes FOLDER/pages/ and FOLDER/mkdocs.yml. The pages are those of the repository, in the same folders, with
the files that they link to, and the pages that are made from the program's output. --cpp is the output of Doxygen, --report
the page of an example run. Without them their pages say how they are made.

The second form checks a site that mkdocs made: each link and its anchor exist, and nothing is loaded from another site.
Pages of Doxygen (cpp/) and the example's report are not checked."""

import argparse
import html.parser
import json
import pathlib
import re
import shutil
import sys
import urllib.parse

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
HOUSE = HERE.parent.parent
sys.path.insert(0, str(HERE))

import reference  # noqa: E402
from reference import COMMANDS, CPP_API, EXAMPLE, PARAMETERS, PYTHON_API  # noqa: E402

SECTIONS = (
    ("Start", (
        ("Home", "README.md"),
        ("In two minutes", "docs/getting-started.md"),
        ("Other systems", "docs/platforms.md"),
        ("Container", "docs/container.md"),
    )),
    ("Clean a map", (
        ("Cleaning a map", "docs/clean.md"),
        ("Your data", "docs/your-data.md"),
        ("Layouts and options", "docs/layouts.md"),
        ("Poses", "docs/poses.md"),
        ("Recipes", (("All recipes", "docs/recipes/README.md"), ("", "docs/recipes/*.md"))),
    )),
    ("Compare methods", (
        ("Comparing methods", "docs/compare-methods.md"),
        ("Protocols, with examples", "docs/protocols.md"),
        ("Scores", "docs/scores.md"),
        ("The field", "docs/field.md"),
        ("Pictures and reports", "docs/pictures-and-reports.md"),
        ("A report to look at", EXAMPLE),
        ("Checks in CI", "docs/ci.md"),
        ("Long runs", "docs/long-runs.md"),
        ("Confidence", "docs/confidence.md"),
    )),
    ("Methods", (
        ("", "methods/raymoval/README.md"),
        ("", "methods/raymoval_plus/README.md"),
        ("The image of first hits of raymoval", "methods/raymoval/KERNELS.md"),
        ("", "methods/*/*.md"),
    )),
    ("Extend", (
        ("Your method", "docs/your-method.md"),
        ("Methods step by step", "methods/README.md"),
        ("The C++ library", "examples/cpp_method/README.md"),
        ("A data set", "docs/add-data-set.md"),
        ("A protocol or a rate", "docs/add-protocol.md"),
        ("Contributing", "CONTRIBUTING.md"),
    )),
    ("Reference", (
        ("The program", "docs/program.md"),
        ("Every command", COMMANDS),
        ("Parameters", (("", PARAMETERS + "*.md"),)),
        ("Files of a run", "docs/results.md"),
        ("Glossary", "docs/glossary.md"),
        ("Python", "docs/python.md"),
        ("Python, every name", PYTHON_API),
        ("C++, every header", CPP_API),
    )),
    ("The project", (
        ("Design", "docs/design.md"),
        ("The source", "docs/source-code.md"),
        ("How it is checked", "docs/how-it-is-checked.md"),
        ("Security", "SECURITY.md"),
        ("Simulated scenes", "datasets/simulation/README.md"),
        ("Releases", "docs/release.md"),
        ("What changed", "CHANGELOG.md"),
    )),
)
IF_THERE = ("docs/platforms.md", "docs/container.md", "docs/confidence.md", "docs/release.md")
# What cmake/install.cmake installs, and the page of the example.
PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/*.md", "docs/recipes/*.md",
         "methods/README.md", "methods/*/*.md", "datasets/*/README.md", "examples/cpp_method/README.md")


# mkdocs.yml without the sections and the folders.
SETTINGS = """\
site_name: raymoval
site_description: Which method removes the moving things from a LiDAR map best, by how much, and how fast?
use_directory_urls: false
theme:
  name: material
  font: false
  language: en
  icon:
    logo: material/radar
  features: [navigation.tabs, navigation.sections, navigation.top, search.highlight, toc.follow]
  palette:
    - media: "(prefers-color-scheme: light)"
      scheme: default
      primary: blue grey
      accent: deep orange
      toggle: { icon: material/weather-night, name: Dark }
    - media: "(prefers-color-scheme: dark)"
      scheme: slate
      primary: blue grey
      accent: deep orange
      toggle: { icon: material/weather-sunny, name: Light }
extra_css: [site.css]
plugins:
  - search:
      lang: en
markdown_extensions:
  - tables
  - attr_list
  - md_in_html
  - toc:
      permalink: true
      # Anchors as forges make them.
      slugify: !!python/object/apply:pymdownx.slugs.slugify { kwds: { case: lower } }
  - pymdownx.highlight
  - pymdownx.superfences
"""


class NavigationError(Exception):
    """A page is in no section, or a section names a page that does not exist."""


def pages_of(house):
    """The paths of all pages of the repository, sorted."""
    return sorted({path.relative_to(house).as_posix() for form in PAGES for path in house.glob(form)})


def navigation(pages):
    """The `nav` of mkdocs for `pages`, paths of pages that exist (those of the repository and those that were made).

    Raises NavigationError for a page in no section, and for one that a section names and that does not exist."""
    left = list(pages)

    def entries(items):
        made = []
        for title, what in items:
            if isinstance(what, tuple):
                made.append({title: entries(what)})
                continue
            found = [page for page in left if page == what or ("*" in what and pathlib.PurePath(page).match(what))]
            if not found and "*" not in what and what not in IF_THERE:
                raise NavigationError(f"scripts/site/stage.py names {what}, which does not exist. "
                                      "Take it out there, or put the page back.")
            for page in found:
                left.remove(page)
                made.append({title: page} if title else page)
        return made

    nav = [{title: entries(items)} for title, items in SECTIONS]
    if left:
        raise NavigationError(f"{', '.join(left)}: in no section of the site. Name the page in SECTIONS of "
                              "scripts/site/stage.py.")
    return nav


LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")
# The language of a code block, detected from its first word.
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


COMMANDS_OF_HOME = """\
    raymoval clean my_scans -o static.pcd   # your map without moving objects
    scripts/reproduce.sh --quick            # compares 7 methods: a table and a page"""
BEFORE_AFTER = "![A street from above: the trails of moving cars, then the same with the trails removed](results/pictures/before_after.png)"


def home(text):
    """The README as the first page of the site. Its first screen is its promise, two commands, a picture of before and after,
    and the first methods of its table."""
    promise, _, rest = text.partition("\n![")
    table = re.search(r"^\| method \|.*?(?=\n\n)", text, re.M | re.S)[0].split("\n")
    buttons = " ".join(f"[{title}]({page}){{ .md-button{' .md-button--primary' if first else ''} }}" for first, title, page in (
        (True, "Get started", "docs/getting-started.md"), (False, "Clean your map", "docs/clean.md"),
        (False, "Compare methods", "docs/compare-methods.md"), (False, "Add a method", "docs/your-method.md")))
    columns = (f"{promise}\n\n{COMMANDS_OF_HOME}\n\n{buttons}",
               f"{BEFORE_AFTER}\n\nLeft: a simulated street with the trails of moving cars. Right: after `raymoval_plus`.")
    start = "\n".join(f"<div markdown>\n{column}\n</div>" for column in columns)
    first = "\n".join(table[:7])
    return (f"---\ntitle: raymoval\nhide: [navigation, toc]\n---\n<div class=\"start\" markdown>\n{start}\n</div>\n\n{first}\n\n"
            "On KITTI raw drive 0005, where raymoval_plus was developed; the last two columns are held-out scenes. "
            f"[All methods, and what the columns mean](#compare-methods).\n\n![{rest}")


def put(target, text):
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text, encoding="utf-8")


def stage_pages(pages, folder):
    """Writes `pages` of the repository below `folder`, and copies the files that they link to."""
    for page in pages:
        text = (HOUSE / page).read_text(encoding="utf-8")
        if page == "README.md":
            text = home(text)
        for match in LINK.finditer(text):
            link = (match[1] or match[2]).split("#")[0]
            source = (HOUSE / page).parent / link
            if not link or "://" in link or link.endswith(".md") or not source.is_file():
                continue
            target = folder / source.resolve().relative_to(HOUSE)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
        text = for_mkdocs(text)
        parameters = f"{PARAMETERS}{pathlib.PurePath(page).parent.name}.md"
        if pathlib.PurePath(page).match("methods/*/README.md"):
            text += f"\n[All parameters and variants](../../{parameters}), as the program describes them.\n"
        put(folder / page, text)


def settings(nav, out):
    """The text of mkdocs.yml. JSON is also YAML."""
    places = {"docs_dir": str(out / "pages"), "site_dir": str(out.parent / "site"),
              "nav": nav, "watch": [str(HOUSE / "docs")]}
    lines = [f"{key}: {json.dumps(value)}" for key, value in places.items()]
    return SETTINGS + "\n".join(lines) + "\n"


NOT_OURS = ("cpp/", "reference/report.html")
# What a browser loads without being asked.
LOADED = {("script", "src"), ("img", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("video", "src")}


class Page(html.parser.HTMLParser):
    """The anchors of a page, its links, and what it loads."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loaded = {""}, [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.anchors.update(given[name] for name in ("id", "name") if given.get(name))
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        for name in ("src", "href"):
            canonical = tag == "link" and given.get("rel") in ("canonical", "prev", "next")
            if (tag, name) in LOADED and given.get(name) and not canonical:
                self.loaded.append(given[name])


def is_elsewhere(link):
    return urllib.parse.urlsplit(link).scheme not in ("", "data") or link.startswith("//")


def faults_of(site):
    """What is wrong, a sentence each; and how many pages and links there are."""
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))
             if not path.relative_to(site).as_posix().startswith(NOT_OURS)}
    faults, count = [], 0
    for path, page in pages.items():
        name = path.relative_to(site).as_posix()
        if name == "404.html":  # Its links begin at the site's root, wherever that is.
            continue
        for link in page.loaded:
            if is_elsewhere(link):
                faults.append(f"{name} loads {link} from elsewhere.")
        for link in page.links + page.loaded:
            if is_elsewhere(link) or link.startswith("data:"):
                continue
            count += 1
            parts = urllib.parse.urlsplit(link)
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if target.is_dir():
                target /= "index.html"
            anchor = urllib.parse.unquote(parts.fragment)
            if not target.exists():
                faults.append(f"{name}: {link} leads nowhere.")
            elif target in pages and anchor not in pages[target].anchors:
                faults.append(f"{name}: {link}: there is no such heading.")
    return faults, len(pages), count


def check(site):
    if not (site / "index.html").is_file():
        sys.exit(f"stage.py: {site} has no index.html; expected the folder of a site.")
    faults, pages, links = faults_of(site.resolve())
    for fault in faults:
        print(fault)
    print(f"stage.py: {pages} pages, {links} links, {len(faults)} faults")
    sys.exit(1 if faults else 0)


def main():
    if sys.argv[1:2] == ["--check"] and len(sys.argv) == 3:
        check(pathlib.Path(sys.argv[2]))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--cpp", type=pathlib.Path)
    parser.add_argument("--report", type=pathlib.Path)
    given = parser.parse_args()
    out = given.out.resolve()
    pages = out / "pages"
    shutil.rmtree(pages, ignore_errors=True)
    own = pages_of(HOUSE)
    stage_pages(own, pages)
    shutil.copyfile(HERE / "site.css", pages / "site.css")
    made = reference.pages(given.program.resolve(), HOUSE)
    made[PYTHON_API] = reference.python_page(HOUSE / "python/raymoval")
    made[CPP_API] = reference.cpp_page(given.cpp, pages / "cpp")
    made[EXAMPLE] = reference.example_page(given.report, pages / "reference/report.html")
    for page, text in made.items():
        put(pages / page, text)
    try:
        nav = navigation([*own, *made])
    except NavigationError as error:
        sys.exit(f"stage.py: {error}")
    put(out / "mkdocs.yml", settings(nav, out))
    print(f"stage.py: {len(own)} pages of the repository and {len(made)} made ones in {pages}")


if __name__ == "__main__":
    main()
