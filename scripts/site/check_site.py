# SPDX-License-Identifier: MIT
"""Looks at the pages of a site: each link leads somewhere, with its anchor, and nothing is fetched from elsewhere.

    check_site.py FOLDER

Pages of Doxygen (cpp/) and the example's report are linked to and not looked into: others check them."""

import html.parser
import pathlib
import sys
import urllib.parse

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


def main():
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1], "index.html").is_file():
        print(__doc__)
        sys.exit("check_site.py: expected the folder of a site, with index.html.")
    faults, pages, links = faults_of(pathlib.Path(sys.argv[1]).resolve())
    for fault in faults:
        print(fault)
    print(f"check_site.py: {pages} pages, {links} links, {len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
