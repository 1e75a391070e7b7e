# SPDX-License-Identifier: MIT
"""The sections of the site, and the pages in each.

A page is a path in the repository; "methods/*/README.md" stands for all pages of that form. A page of `IF_THERE` may be
missing. A Markdown file that is installed and stands in no section is an error, so that no page is forgotten."""

import pathlib

# Pages that scripts/site/reference.py writes, from what the program says of itself.
COMMANDS = "reference/commands.md"
PARAMETERS = "reference/parameters/"
PYTHON_API = "reference/python.md"
CPP_API = "reference/cpp.md"
EXAMPLE = "reference/example-report.md"
GENERATED = (COMMANDS, PARAMETERS + "*.md", PYTHON_API, CPP_API, EXAMPLE)

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
        ("Leaderboard", "docs/leaderboard.md"),
        ("Submissions", "docs/submissions.md"),
        ("History", "docs/history.md"),
    )),
    ("Methods", (
        ("", "methods/raymoval/README.md"),
        ("", "methods/raymoval_plus/README.md"),
        ("Experiments with raymoval_plus", "methods/raymoval_plus/EXPERIMENTS.md"),
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
        ("Python", "docs/python.md"),
        ("Python, every name", PYTHON_API),
        ("C++, every header", CPP_API),
    )),
    ("The house", (
        ("Design", "docs/design.md"),
        ("The source", "docs/source-code.md"),
        ("How it is checked", "docs/how-it-is-checked.md"),
        ("Security", "SECURITY.md"),
        ("Simulated scenes", "datasets/simulation/README.md"),
        ("Releases", "docs/release.md"),
        ("What changed", "CHANGELOG.md"),
    )),
)
IF_THERE = ("docs/platforms.md", "docs/container.md", "docs/confidence.md", "docs/leaderboard.md", "docs/submissions.md",
            "docs/history.md", "docs/release.md")
# What cmake/install.cmake installs, and the page of the example.
PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/*.md", "docs/recipes/*.md",
         "methods/README.md", "methods/*/*.md", "datasets/*/README.md", "examples/cpp_method/README.md")


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
                raise NavigationError(f"scripts/site/navigation.py names {what}, which does not exist. "
                                      "Take it out there, or put the page back.")
            for page in found:
                left.remove(page)
                made.append({title: page} if title else page)
        return made

    nav = [{title: entries(items)} for title, items in SECTIONS]
    if left:
        raise NavigationError(f"{', '.join(left)}: in no section of the site. Name the page in SECTIONS of "
                              "scripts/site/navigation.py.")
    return nav
