# SPDX-License-Identifier: MIT
"""Reports in a headless Chromium: no error, no network, what is clicked works, the canvas shows
what it should. Usage: report_test.py PATH/TO/raymoval. Exit code 77: no Chromium."""
import math
import os
import sys
import tempfile

import chromium
from checks import check, check_contrast, check_ids, finish, program


def colours(browser, left=0.0, right=1.0):
    """How often each colour stands in a part of the canvas, as {(r, g, b): count}."""
    counts = browser.run("""(() => {
      const {width, height, data} = raymovalView.stage.pixels(), counts = {};
      for (let y = 0; y < height; ++y) {
        for (let x = Math.floor(width * %f); x < Math.floor(width * %f); ++x) {
          const at = 4 * (y * width + x), key = data[at] + ',' + data[at + 1] + ',' + data[at + 2];
          counts[key] = (counts[key] || 0) + 1;
        }
      }
      return counts;
    })()""" % (left, right))
    return {tuple(map(int, key.split(","))): count for key, count in counts.items()}


def bluish_green(counts):
    return sum(n for (r, g, b), n in counts.items() if g > 90 and r < 40 and 50 < b < g)


def vermillion(counts):
    return sum(n for (r, g, b), n in counts.items() if r > 140 and 50 < g < r - 60 and b < 30)


def grey(counts):
    return sum(n for (r, g, b), n in counts.items() if max(r, g, b) - min(r, g, b) < 12 and r < 240)


def open_view(browser):
    browser.run("document.getElementById('points').scrollIntoView({behavior: 'instant'})")
    browser.wait("window.raymovalViewError || (window.raymovalView && raymovalView.ready)")
    check("the view opens", browser.run("window.raymovalViewError === undefined"),
          browser.run("String(window.raymovalViewError)"))


def check_tables(browser):
    """Sorting by F1, best first, then worst first, then as it was."""
    column = """(() => [...document.querySelectorAll('#methods tbody tr')].map(
                 (row) => row.cells[HERE].textContent))()"""
    head = "[...document.querySelectorAll('#methods thead th[scope=col]')]"
    f1 = browser.run(head + ".findIndex((cell) => cell.textContent === 'F1')")
    column = column.replace("HERE", str(f1))
    before = browser.run(column)
    for order in ("descending", "ascending"):
        browser.run(f"{head}[{f1}].querySelector('button').click()")
        check(f"aria-sort is {order}", browser.run(f"{head}[{f1}].ariaSort") == order)
        numbers = [float(text.split()[0]) for text in browser.run(column) if text != "n/a"]
        check(f"F1 is {order}", numbers == sorted(numbers, reverse=order == "descending"), numbers)
    browser.run(f"{head}[{f1}].querySelector('button').click()")
    check("the third click restores the order", browser.run(column) == before)
    check("every heading cell has a scope",
          browser.run("document.querySelectorAll('th:not([scope])').length") == 0)
    check("tables have captions", browser.run(
        "[...document.querySelectorAll('table')].every((table) => table.caption)"))


def check_theme(browser):
    ground = "getComputedStyle(document.body).backgroundColor"
    browser.set_dark(True)
    dark = browser.run(ground)
    browser.set_dark(False)
    light = browser.run(ground)
    check("dark and light differ", dark != light, f"{dark} {light}")
    browser.run("document.getElementById('theme').click()")
    check("the button makes it dark", browser.run(ground) == dark)
    browser.run("document.getElementById('theme').click()")
    check("and light again", browser.run(ground) == light)


def check_accessible(browser):
    check("one main, one h1, navigation", browser.run(
        "['main', 'h1', 'nav', 'header', 'footer'].every("
        "(name) => document.querySelectorAll('body > ' + name + ', header > h1').length > 0)"))
    check("links of the navigation lead somewhere", browser.run(
        "[...document.querySelectorAll('nav a')].every("
        "(link) => document.querySelector(link.getAttribute('href')))"))
    check_ids(browser)
    check("charts have a text alternative", browser.run(
        "[...document.querySelectorAll('svg.raymoval-chart')].every("
        "(chart) => chart.querySelector('title') && chart.querySelector('desc'))"))
    check("controls have names", browser.run(
        "[...document.querySelectorAll('input, select')].every((part) => part.labels.length > 0 ||"
        " part.getAttribute('aria-label'))"))


def check_sequences(browser):
    """Each sequence has its charts: bars of intervals, lines over range and time, rows of classes."""
    text = browser.run("document.getElementById('sequences').textContent")
    for word in ("with 95 % intervals", "range, m", "time, % of the scans", "building"):
        check(f"a sequence shows '{word}'", word in text, text[:300])
    check("methods have bars", browser.run("document.querySelectorAll('#sequences .bar').length") > 0)


def check_looks(browser):
    """Contrast, and what a phone shows of the first table without scrolling sideways."""
    check_contrast(browser)
    browser.call("Emulation.setDeviceMetricsOverride", width=390, height=844, deviceScaleFactor=1, mobile=False)
    edges = browser.run("""[...document.querySelector('#methods tbody tr').cells].slice(0, 3).map(
        (cell) => cell.getBoundingClientRect().right)""")
    check("a phone shows name, F1 and time", max(edges) <= 390, edges)
    check("a phone does not scroll sideways", browser.run("document.documentElement.scrollWidth <= 390"))
    browser.call("Emulation.setDeviceMetricsOverride", width=1280, height=900, deviceScaleFactor=1, mobile=False)


def check_worst(browser):
    """The places with most errors are pictures that open in the view."""
    browser.run("""(() => { const list = document.getElementById('left');
        list.selectedIndex = [...list.options].findIndex((one) => one.textContent === 'noop:default');
        list.dispatchEvent(new Event('change')); })()""")
    browser.wait("document.getElementById('worst-title').textContent === 'Where noop:default errs most'")
    counts = browser.run("[...document.querySelectorAll('#worst button')].map("
                         "(button) => Number(button.textContent.split(': ')[1].split(' ')[0].replace(',', '')))")
    check("places with more errors come first", counts and counts == sorted(counts, reverse=True), counts)
    check("and hold no more errors than are shown", sum(counts) <= browser.run(
        "raymovalView.cells[0].kinds.filter((kind) => kind === 1 || kind === 3).length"))
    browser.run("raymovalView.lookAtAll()")
    before = browser.run("raymovalView.stage.range")
    browser.run("document.querySelector('#worst button').click()")
    check("a click goes there", browser.run("raymovalView.stage.range") < before)


def check_points(browser):
    """The street: a car that moves, walls that do not."""
    view = "raymovalView"
    # Beside each other: what `oracle` removes, `noop` keeps.
    choose = """(id, name) => { const list = document.getElementById(id);
        list.selectedIndex = [...list.options].findIndex((one) => one.textContent === name);
        list.dispatchEvent(new Event('change')); }"""
    browser.run(f"({choose})('left', 'oracle:default')")
    browser.wait(f"{view}.cells.length === 1 && {view}.cells[0].head.name === 'oracle:default'")
    whole = colours(browser)
    check("moving points that were removed are green", bluish_green(whole) > 100, bluish_green(whole))
    check("static points are grey", grey(whole) > 1000, grey(whole))
    check("the oracle misses nothing", vermillion(whole) == 0, vermillion(whole))
    for kind, seen in ((0, grey), (2, bluish_green)):
        browser.run(f"document.getElementById('kind-{kind}').click()")
        check(f"kind {kind} can be hidden", seen(colours(browser)) < 0.02 * seen(whole) + 60)
        browser.run(f"document.getElementById('kind-{kind}').click()")
    check("and shown again", colours(browser) == whole)
    for by in ("label", "height", "reason", "verdict"):
        browser.run(f"(() => {{ const list = document.getElementById('colour'); list.value = '{by}';"
                    " list.dispatchEvent(new Event('change')); })()")
        check(f"coloured by {by}", (colours(browser) == whole) == (by == "verdict"))
    browser.run(f"({choose})('right', 'noop:default')")
    browser.wait(f"{view}.cells.length === 2")
    browser.run(f"{view}.lookAtAll()")
    left, right = colours(browser, 0, 0.49), colours(browser, 0.51, 1)
    check("the left half is the oracle's", bluish_green(left) > 20 and vermillion(left) == 0,
          f"{bluish_green(left)} {vermillion(left)}")
    check("the right half is noop's", vermillion(right) > 20 and bluish_green(right) == 0,
          f"{vermillion(right)} {bluish_green(right)}")
    browser.run(f"({choose})('right', 'nothing')")
    browser.wait(f"{view}.cells.length === 1")
    browser.run(f"{view}.lookAtAll()")


def check_grey(browser):
    """A grey printer tells the kinds of points apart: their lightness (CIE L*) differs by 10 or more."""
    for dark in (False, True):
        browser.set_dark(dark)
        light = sorted(browser.run("""['--kept-low', '--kept-high', '--kind-1', '--kind-2', '--kind-3'].map((name) => {
            const part = (value) => value <= 10.3 ? value / 3294.6 : ((value / 255 + 0.055) / 1.055) ** 2.4;
            const [r, g, b] = colourOf(name).map(part);
            return 116 * Math.cbrt(0.2126 * r + 0.7152 * g + 0.0722 * b) - 16;
        })"""))
        gaps = [b - a for a, b in zip(light, light[1:])]
        check(f"kinds differ in grey ({'dark' if dark else 'light'})", min(gaps) >= 10, light)
    browser.set_dark(False)


def check_scans(browser):
    choose = "document.getElementById('mode').value = '%d';" \
             "document.getElementById('mode').dispatchEvent(new Event('change'))"
    amount = lambda: grey(colours(browser)) + bluish_green(colours(browser))
    everything = amount()
    browser.run(choose % 1)
    first = amount()
    check("up to scan 0 there are fewer points", 0 < first < everything, f"{first} {everything}")
    browser.run("document.getElementById('canvas').focus()")
    browser.press(".")
    check("the full stop goes to the next scan",
          browser.run("document.getElementById('scan').value") == "1")
    check("more points up to scan 1", amount() >= first)
    browser.run(choose % 0)


def check_click(browser):
    """Clicks where a removed point is drawn."""
    place = browser.run("""(() => {
      const {width, height, data} = raymovalView.stage.pixels();
      for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) {
        const at = 4 * (y * width + x);
        if (data[at + 1] > 90 && data[at] < 40 && data[at + 2] > 50) {
          const box = document.getElementById('canvas').getBoundingClientRect();
          return [box.left + (x + 0.5) * box.width / width,
                  box.top + (height - y - 0.5) * box.height / height];
        }
      }
      return null;
    })()""")
    check("a removed point can be seen", place is not None)
    if place is None:
        return
    browser.click(*place)
    told = browser.run("document.getElementById('point').textContent")
    for word in ("scan", "range", "moving-", "voxel of 0.2 m", "removed, rightly"):
        check(f"a clicked point tells '{word}'", word in told, told)
    browser.run("document.getElementById('canvas').focus()")
    browser.press("Escape")
    check("Escape forgets it", browser.run("document.getElementById('point').textContent") == "")


def check_pointers(browser):
    """A drag turns about the target, a drag with the right button moves it, the wheel and two fingers
    zoom; what is under the pointer at the distance of the target stays there."""
    left, top, width, height = browser.run("""(() => {
      const {left, top, width, height} = document.getElementById('canvas').getBoundingClientRect();
      return [left, top, width, height];
    })()""")
    place = (left + round(0.3 * width), top + round(0.4 * height))

    def state():
        """Camera and target, and the distance between them."""
        camera, target = browser.run("[raymovalView.stage.eye(), raymovalView.stage.target]")
        return camera, target, math.dist(camera, target)

    def near(a, b):
        return math.dist(a, b) < 1e-3

    browser.run("raymovalView.lookAtAll()")
    camera, target, distance = state()
    browser.drag(place, (place[0] + 40, place[1] + 30))
    turned = state()
    check("a drag turns", near(turned[1], target) and not near(turned[0], camera)
          and abs(turned[2] - distance) < 1e-3, f"{camera} {target} {turned}")
    browser.drag(place, (place[0] + 40, place[1] + 30), "right")
    moved = state()
    step = [a - b for a, b in zip(moved[1], turned[1])]
    check("a drag with the right button moves", math.hypot(*step) > 1
          and near([a - b for a, b in zip(moved[0], turned[0])], step), f"{turned} {moved}")
    browser.run("raymovalView.lookAtAll()")
    under_pointer = "raymovalView.stage.under(%f, %f)" % (place[0] - left, place[1] - top)
    fixed, before = browser.run(under_pointer), state()
    browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=place[0], y=place[1], deltaX=0,
                 deltaY=-300)
    browser.wait(f"raymovalView.stage.eye()[0] !== {before[0][0]!r}")
    after = state()
    check("the wheel zooms", abs(after[2] / before[2] - 0.95 ** 3) < 1e-6, f"{before} {after}")
    # Browsers round a pointer's place to pixels.
    check("towards the pointer", math.dist(browser.run(under_pointer), fixed)
          < 2e-3 * before[2], f"{browser.run(under_pointer)} {fixed}")
    x, y = place
    browser.touch([(x - 50, y), (x + 50, y)], [(x - 100, y), (x + 100, y)])
    pinched = state()
    check("two fingers zoom", abs(pinched[2] / after[2] - 0.5) < 1e-6, f"{after} {pinched}")
    check("between them", math.dist(browser.run(under_pointer), fixed) < 4e-3 * before[2],
          f"{browser.run(under_pointer)} {fixed}")
    browser.run("raymovalView.tell(-1); raymovalView.lookAtAll()")


def check_reasons(browser):
    """raymoval says why; its word stands beside a point that it removed."""
    told = browser.run("""(async () => {
      const view = raymovalView, list = document.getElementById('left');
      list.selectedIndex = [...list.options].findIndex((one) => one.textContent === 'raymoval:offline');
      await view.openCells();
      for (let i = 0; i < view.data.count; ++i) {
        if (view.cells[0].bytes[i] & 1) {
          view.tell(i);
          return document.getElementById('point').textContent;
        }
      }
      return '';
    })()""")
    check("raymoval says why it removed a point", "saw through" in told, told)


def check_counts(browser, results):
    """The numbers beside the kinds are those of the masks: what oracle removes is what moves."""
    counts = browser.run("raymovalView.data.head.cells.find((cell) => cell.name === 'oracle:default').counts")
    noop = browser.run("raymovalView.data.head.cells.find((cell) => cell.name === 'noop:default').counts")
    check("the oracle errs nowhere", counts[1] == 0 and counts[3] == 0, counts)
    check("noop keeps everything", noop[1] == 0 and noop[2] == 0 and noop[0] == counts[0]
          and noop[3] == counts[2], f"{noop} {counts}")
    check("points are drawn where they are", browser.run(
        "(() => { const v = raymovalView.data; for (let i = 0; i < v.count; i += 97) {"
        " const at = v.world(i), voxel = v.voxel(i);"
        " if (voxel.some((c, axis) => Math.floor(at[axis] / 0.2) !== c)) return false; }"
        " return true; })()"))


def main():
    browser_path = chromium.find()
    if browser_path is None:
        print("report_test.py: no Chromium; scripts/install_dependencies.sh --all brings it.")
        return 77
    raymoval = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="raymoval-report-") as folder:
        os.chdir(folder)
        short = ["--sequence", "street", "--frames", "0:11", "--quiet", "--keep-removals"]
        # A cell that fails, beside others.
        with open("broken.json", "w") as file:
            file.write('{"name": "broken", "sentence": "Fails.", "source": "test", "version": "1", "online": false, "command": ["sh", "-c", "echo the last words; exit 3"]}')
        program(raymoval, "run", *short, "--method", "raymoval:offline",
                "--method", f"external:{folder}/broken.json", "--out", "failed", code=1)
        # 30 cells, none kept but by the default.
        with open("many.json", "w") as file:
            file.write('{"sequences": [{"path": "street", "frames": "0:3"}], "methods": ['
                       '{"method": "raymoval:offline", "set": {"tau1": {"sweep": [%s]}}}]}'
                       % ", ".join(f"{0.01 * i:.2f}" for i in range(1, 28)))
        program(raymoval, "run", "many.json", "--quiet", "--keep-removals", "--out", "many")
        # Points out of every range: nothing to score, nothing to show.
        program(raymoval, "run", "--sequence", "street", "--frames", "0:1", "--range", "900:901",
                "--quiet", "--keep-removals", "--method", "raymoval:offline", "--out", "empty", code=1)
        for run in ("failed", "many", "empty"):
            program(raymoval, "report", run, "--quiet")
        program(raymoval, "report", "failed", "--no-points", "-o", "plain.html", "--quiet")
        with chromium.Browser(browser_path) as browser:
            browser.open("failed/report.html")
            check("the failed cell tells its reason",
                  "the last words" in browser.run("document.getElementById('failures').textContent"))
            check_tables(browser)
            check_theme(browser)
            check_accessible(browser)
            check_sequences(browser)
            open_view(browser)
            check_looks(browser)
            check_counts(browser, None)
            check_points(browser)
            check_grey(browser)
            check_scans(browser)
            check_click(browser)
            check_pointers(browser)
            check_reasons(browser)
            check_worst(browser)
            browser.open("many/report.html")
            check("30 cells are shown", browser.run(
                "document.querySelectorAll('#cells tbody tr').length") == 30)
            open_view(browser)
            check("30 cells can be looked at", browser.run(
                "document.getElementById('left').options.length") == 30)
            check("the canvas is not blank", grey(colours(browser)) > 500)
            browser.open("empty/report.html")
            check("the empty cell is in the table", browser.run(
                "document.querySelectorAll('#cells tbody tr').length") > 0)
            browser.open("plain.html")
            check("no view where none is wanted", browser.run("!document.getElementById('viewer')"))
            check("nothing was logged, thrown or asked of the network", not browser.problems,
                  browser.problems)
    return finish("report_test.py")


if __name__ == "__main__":
    sys.exit(main())
