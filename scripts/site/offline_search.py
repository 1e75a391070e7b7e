# SPDX-License-Identifier: MIT
"""Makes the search of a site work on pages that are opened from disk, where a browser lets a page neither read the
index nor start the program that searches it: both become a script, which scripts/site/theme/main.html loads there.

    offline_search.py FOLDER"""

import json
import pathlib
import sys


def in_script(text):
    """A JavaScript literal of what JSON says; no "</script>" ends it early."""
    return json.dumps(text).replace("</", "<\\/")


def main():
    site = pathlib.Path(sys.argv[1])
    index = json.loads((site / "search/search_index.json").read_text(encoding="utf-8"))
    workers = list(site.glob("assets/javascripts/workers/search.*.js"))
    if len(workers) != 1:
        sys.exit(f"offline_search.py: {site}/assets/javascripts/workers has {len(workers)} files search.*.js; "
                 "expected one. Is the theme another version than Debian 12's?")
    worker = workers[0].read_text(encoding="utf-8")
    (site / "search/offline.js").write_text(
        f"window.__search = {{\n  index: Promise.resolve({in_script(index)}),\n"
        f"  worker: URL.createObjectURL(new Blob([{in_script(worker)}], {{type: \"text/javascript\"}}))\n}};\n",
        encoding="utf-8")


if __name__ == "__main__":
    main()
