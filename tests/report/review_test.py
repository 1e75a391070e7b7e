# SPDX-License-Identifier: MIT
"""The review of a cleaned map in a headless Chromium: objects and points are kept and removed, the edits
are exported, `raymoval clean --edits` applies them, and the masks are those that the definition of the file gives.
Usage: review_test.py PATH/TO/raymoval. Exit code 77: no Chromium."""
import json
import math
import os
import struct
import sys
import tempfile
import time

import chromium
from checks import check, check_contrast, check_ids, finish, program


def removed_by(folder, names):
    """The mask of each scan, from label files."""
    def mask(name):
        with open(f"{folder}/{name}.label", "rb") as file:
            return [word & 0xFFFF == 251 for word, in struct.iter_unpack("<I", file.read())]
    return [mask(name) for name in names]


def product(a, b):
    """Of two rigid motions, as rows of 3 x 4 matrices."""
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0) for j in range(4)] for i in range(3)]


def inverse(a):
    return [[*(a[j][i] for j in range(3)), -sum(a[j][i] * a[j][3] for j in range(3))] for i in range(3)]


def rows_of(line):
    numbers = [float(word) for word in line.split()[-12:]]
    return [numbers[0:4], numbers[4:8], numbers[8:12]]


def expected(edits):
    """The corrected masks, from the definition of the file: runs of removed points, then cells."""
    with open("data/poses.txt") as file:
        poses = [rows_of(line) for line in file]
    with open("data/calib.txt") as file:
        calibration = rows_of(next(line for line in file if line.startswith("Tr")))
    keep, remove = {tuple(cell) for cell in edits["keep"]}, {tuple(cell) for cell in edits["remove"]}
    turn = edits["turn"]
    upright = [[*turn[0:3], 0.0], [*turn[3:6], 0.0], [*turn[6:9], 0.0]]
    masks = []
    for i, scan in enumerate(edits["scans"]):
        with open(f"data/velodyne/{scan['name']}.bin", "rb") as file:
            points = list(struct.iter_unpack("<4f", file.read()))
        mask = [False] * len(points)
        for first, count in zip(scan["removed"][::2], scan["removed"][1::2]):
            mask[first:first + count] = [True] * count
        pose = product(upright, product(inverse(calibration), product(poses[i], calibration)))
        for k, (x, y, z, _) in enumerate(points):
            steps = [math.floor((row[0] * x + row[1] * y + row[2] * z + row[3]) / edits["step_m"]) for row in pose]
            if mask[k]:
                mask[k] = (i, *(step // edits["removed_cell"] for step in steps)) not in keep
            else:
                mask[k] = tuple(step // edits["kept_cell"] for step in steps) in remove
        masks.append(mask)
    return masks


def drag(browser, places):
    """A drag along places of the canvas, given as shares of its width and height."""
    left, top, width, height = browser.run("""(() => {
      const {left, top, width, height} = document.getElementById('canvas').getBoundingClientRect();
      return [left, top, width, height];
    })()""")
    kinds = ["mousePressed"] + ["mouseMoved"] * (len(places) - 1) + ["mouseReleased"]
    for kind, (x, y) in zip(kinds, [*places, places[-1]]):
        browser.call("Input.dispatchMouseEvent", type=kind, x=left + x * width, y=top + y * height, button="left",
                     buttons=0 if kind == "mouseReleased" else 1, clickCount=1)


def click(browser, script):
    """A real click on an element."""
    x, y = browser.run(f"""(() => {{
      const part = {script};
      part.scrollIntoView({{block: 'center', behavior: 'instant'}});
      const box = part.getBoundingClientRect();
      return [box.left + box.width / 2, box.top + box.height / 2];
    }})()""")
    browser.click(x, y)


def check_objects(browser):
    facts = browser.run("""raymovalReview.objects.map(({number, points, scans, sizes, confidence, isScattered}) =>
        ({number, points: points.length, first: scans[0], last: scans[scans.length - 1], sizes, confidence, isScattered}))""")
    check("there are objects", len(facts) > 1, facts)
    check("each removed point belongs to one object", browser.run(
        "raymovalReview.objects.reduce((sum, {points}) => sum + points.length, 0)"
        " === raymovalReview.base.reduce((sum, removed) => sum + removed, 0)"))
    order = browser.run("raymovalReview.ordered().filter((object) => !object.isScattered)"
                        ".map(({confidence, points}) => points.length * (1 - confidence))")
    check("objects with the most doubtful points come first", order == sorted(order, reverse=True), order)
    check("none is reviewed", browser.run("document.getElementById('left').textContent")
          == f"{len(facts)} of {len(facts)} left to review")
    return len(facts)


def check_decisions(browser, count):
    """A click in the list, the keyboard, undo, a box, a lasso, and a click on a point."""
    left = "document.getElementById('left').textContent"
    first = browser.run("raymovalReview.ordered()[0].number")
    click(browser, "document.querySelector('#objects li button:nth-child(2)')")
    check("a click keeps an object", browser.run(f"raymovalReview.objects[{first - 1}].points.every((i) => !raymovalReview.now[i])"))
    check("one less is left", browser.run(left).startswith(f"{count - 1} of {count} "), browser.run(left))
    before = browser.run("JSON.stringify(Array.from(raymovalReview.now))")
    browser.press("k")
    check("K keeps the next one", browser.run(left).startswith(f"{count - 2} of {count} "), browser.run(left))
    browser.press("u")
    check("U undoes it", browser.run(left).startswith(f"{count - 1} of {count} ")
          and browser.run("JSON.stringify(Array.from(raymovalReview.now))") == before)
    browser.press("r")
    check("R confirms a removal", browser.run(left).startswith(f"{count - 2} of {count} ")
          and browser.run("JSON.stringify(Array.from(raymovalReview.now))") == before)
    browser.run("document.getElementById('whole').click(); document.getElementById('above').click()")
    for mode, path in (("box", [(0.3, 0.3), (0.45, 0.4)]), ("lasso", [(0.5, 0.5), (0.62, 0.5), (0.62, 0.66), (0.5, 0.6)])):
        click(browser, f"document.querySelector('input[name=drag][value={mode}]')")
        drag(browser, path)
        selected = browser.run("raymovalReview.selected.points.length")
        check(f"a {mode} selects points", selected > 0)
        check("all of them within it", browser.run("""(([low, high]) => {
          const inside = new Set();
          raymovalReview.stage.eachSeen(0, (i, x, y) => {
            const a = x / raymovalReview.stage.width, b = y / raymovalReview.stage.height;
            if (a > low[0] - 0.01 && a < high[0] + 0.01 && b > low[1] - 0.01 && b < high[1] + 0.01) inside.add(i);
          });
          return raymovalReview.selected.points.every((i) => inside.has(i));
        })(%s)""" % json.dumps([[min(p[i] for p in path) for i in (0, 1)], [max(p[i] for p in path) for i in (0, 1)]])))
        browser.press("r" if mode == "box" else "k")
    check("kept points can be removed", browser.run(
        "raymovalReview.now.some((removed, i) => removed && !raymovalReview.base[i])"))
    click(browser, "document.querySelector('input[name=drag][value=turn]')")
    number = browser.run("raymovalReview.ordered().find(({state}) => state === '').number")
    browser.press("n")
    place = browser.run(f"""(() => {{
      const {{stage, objects}} = raymovalReview, box = stage.canvas.getBoundingClientRect();
      let found = null;
      const wanted = new Set(objects[{number - 1}].points);
      stage.eachSeen(0, (i, x, y) => {{ if (stage.pick(x, y) === i && wanted.has(i) && !found) found = [box.left + x, box.top + y]; }});
      return found;
    }})()""")
    browser.press("Escape")
    check("Escape forgets the selection", browser.run("raymovalReview.selected.points.length") == 0)
    browser.click(*place)
    check("a click selects an object", browser.run("raymovalReview.selected.object?.number") == number)
    browser.press("Escape")


def check_keyboard(browser):
    """A box and a lasso without a pointer select what the same corners select with one."""
    browser.run("document.getElementById('whole').click(); document.getElementById('above').click()")
    for mode, corners in (("box", [(0, 0), (80, 40)]), ("lasso", [(0, 0), (80, 0), (80, 80)])):
        browser.press(mode[0])
        check(f"{mode[0].upper()} chooses the {mode}", browser.run("document.querySelector('input[name=drag]:checked').value") == mode)
        at = (0, 0)
        for corner in corners:
            for axis, keys in ((0, "ArrowRight"), (1, "ArrowDown")):
                for _ in range((corner[axis] - at[axis]) // 8):
                    browser.press(keys)
            at = corner
            browser.press(" ") if corner != corners[-1] else browser.press("Enter")
        found = browser.run("raymovalReview.selected.points.join()")
        check(f"the keyboard's {mode} selects points", found != "")
        outline = [(0, 0), (80, 0), (80, 40), (0, 40)] if mode == "box" else corners
        browser.run("(({width, height}) => raymovalReview.selectWithin(%s.map(([x, y]) => [width / 2 + x, height / 2 + y])))"
                    "(raymovalReview.stage)" % json.dumps(outline))
        check(f"those within the {mode}", browser.run("raymovalReview.selected.points.join()") == found)
    browser.press(" ")
    check("a screen reader hears of a corner", "1 corners set" in browser.run("document.getElementById('selection').textContent"))
    browser.press("Escape")
    browser.press("t")
    check("T ends it", browser.run("document.getElementById('cross').getAttribute('visibility')") == "hidden")


def check_caution(browser, raymoval):
    """The page and the program agree on what a caution removes."""
    for caution in (0.0, 0.9, 1.0):
        browser.run(f"""(() => {{ const slider = document.getElementById('caution'); slider.value = {caution};
            slider.dispatchEvent(new Event('input')); }})()""")
        note = browser.run("document.getElementById('caution-note').textContent")
        out = program(raymoval, "clean", "data", "-o", "cautious.pcd", "--overwrite", "--quiet", "--caution", str(caution))
        told = note.split("would remove ")[1].split(" points")[0]
        check(f"caution {caution} removes what the page says", f"removed {told} of" in out, f"{note} {out[:200]}")
    browser.run("document.getElementById('caution-end').click()")


def check_looks(browser):
    """Names, contrast and the width of a phone."""
    check("controls have names", browser.run(
        "[...document.querySelectorAll('input, select, button')].every((part) => part.labels?.length > 0 ||"
        " part.getAttribute('aria-label') || part.textContent.trim())"))
    check_ids(browser)
    check_contrast(browser)
    browser.call("Emulation.setDeviceMetricsOverride", width=390, height=844, deviceScaleFactor=1, mobile=False)
    check("a phone does not scroll sideways", browser.run("document.documentElement.scrollWidth <= 390"),
          browser.run("document.documentElement.scrollWidth"))
    browser.call("Emulation.setDeviceMetricsOverride", width=1280, height=900, deviceScaleFactor=1, mobile=False)


def check_edits(raymoval, names):
    edits = json.load(open("edits.json"))
    check("both kinds of corrections are exported", edits["keep"] and edits["remove"])
    out = program(raymoval, "clean", "data", "--edits", "edits.json", "--labels", "after", "-o", "static.pcd", "--quiet",
                  "--html", "corrected.html")
    before, after, wanted = removed_by("before", names), removed_by("after", names), expected(edits)
    check("the masks are those of the edits", after == wanted,
          [sum(a != b for a, b in zip(*scans)) for scans in zip(after, wanted)])
    pairs = [pair for scans in zip(before, after) for pair in zip(*scans)]
    kept, removed = pairs.count((True, False)), pairs.count((False, True))
    check("points were kept and removed", kept > 0 and removed > 0)
    check("the program counts them", f"{kept:,} removed points kept and {removed:,} kept points removed by hand" in out, out)
    by_file = program(raymoval, "score", "data", "--predictions", "edits.json", "--quiet")
    check("the file scores as its label files", by_file.replace("edits.json", "after")
          == program(raymoval, "score", "data", "--predictions", "after", "--quiet"))
    truth = program(raymoval, "score", "data", "--truth", "edits.json", "--predictions", "after", "--protocol", "mos", "--quiet")
    check("as the truth it agrees with itself", "IoU 100.000" in truth, truth)
    program(raymoval, "clean", "data", "--edits", "edits.json", "--method", "raymoval", "-o", "o.pcd", code=2)
    out = program(raymoval, "clean", "data", "--edits", "edits.json", "--frames", "0:5", "-o", "o.pcd", "--quiet", code=2)
    check("other scans are refused", f"for {len(names)} scans" in out, out)
    path = f"data/velodyne/{names[3]}.bin"
    with open(path, "r+b") as file:
        x, = struct.unpack("<f", file.read(4))
        file.seek(0)
        file.write(struct.pack("<f", x + 0.01))
    out = program(raymoval, "clean", "data", "--edits", "edits.json", "-o", "o.pcd", "--quiet", code=2)
    check("changed data is reported", f"1 of {len(names)} scans have another pose or other points (first: {names[3]})" in out, out)
    check("and nothing is written", not os.path.exists("o.pcd"))
    program(raymoval, "clean", "data", "--edits", "edits.json", "-o", "o.pcd", "--quiet", "--force")


def main():
    browser_path = chromium.find()
    if browser_path is None:
        print("review_test.py: no Chromium; scripts/install_dependencies.sh --all brings it.")
        return 77
    raymoval = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="raymoval-review-") as folder:
        os.chdir(folder)
        program(raymoval, "simulate", "town", "-o", "data", "--scans", "24", "--sensor", "vlp16", "--seed", "3", "--quiet")
        program(raymoval, "clean", "data", "--html", "map.html", "--labels", "before", "--quiet")
        names = sorted(name[:-4] for name in os.listdir("data/velodyne"))
        with chromium.Browser(browser_path) as browser:
            browser.open("map.html")
            browser.wait("window.raymovalViewError || window.raymovalReview?.ready")
            check("the page opens", browser.run("window.raymovalViewError === undefined"),
                  browser.run("String(window.raymovalViewError)"))
            check_decisions(browser, check_objects(browser))
            check_keyboard(browser)
            check_caution(browser, raymoval)
            check_looks(browser)
            browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=folder)
            click(browser, "document.getElementById('export')")
            for _ in range(500):
                if os.path.exists("edits.json"):
                    break
                time.sleep(0.02)
            check_edits(raymoval, names)
            browser.open("corrected.html")
            browser.wait("window.raymovalReview?.ready")
            check("nothing was logged, thrown or asked of the network", not browser.problems, browser.problems)
        with chromium.Browser(browser_path, flags=("--disable-3d-apis",)) as browser:
            browser.open("map.html")
            browser.wait("window.raymovalViewError || window.raymovalReview?.ready")
            check("without WebGL there is a picture", browser.run(
                "(() => { const {data} = raymovalReview.stage.pixels(); let drawn = 0;"
                " for (let i = 0; i < data.length; i += 4) drawn += data[i] < 250; return drawn > 1000; })()"))
    return finish("review_test.py")


if __name__ == "__main__":
    sys.exit(main())
