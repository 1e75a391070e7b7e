# SPDX-License-Identifier: MIT
"""Pages of a site in a headless Chromium, opened from disk, on a phone and on a screen, light and dark: nothing is wider
than the window, every picture is shown, nothing comes from a network, letters differ from their ground, and the search
finds a parameter. 77: there is no Chromium.

    pages.py FOLDER"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
import chromium  # noqa: E402

# One of each kind: wide tables, pictures, options, code, long words.
PAGES = ("index.html", "docs/scores.html", "docs/protocols.html", "docs/clean.html", "methods/raymoval_plus/index.html",
         "reference/commands.html", "reference/python.html", "reference/parameters/protocol-dynamicmap-strict.html")
# The ratio of luminances of the letters of paragraphs, links, code and buttons to the page's ground, the least of them.
CONTRAST = """(() => {
  document.getAnimations().forEach((fade) => fade.finish());  // From light to dark.
  const luminance = (colour) => {
    const [r, g, b] = colour.match(/[\\d.]+/g).slice(0, 3).map((v) => v / 255)
      .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ground = luminance(getComputedStyle(document.body).backgroundColor);
  const ratios = [...document.querySelectorAll(".md-content p, .md-content td, .md-content p > a:not(.md-button--primary)")]
    .map((e) => luminance(getComputedStyle(e).color))
    .map((l) => (Math.max(l, ground) + 0.05) / (Math.min(l, ground) + 0.05));
  return Math.min(...ratios);
})()"""
# Typed once the search says that it is there: the theme tells its worker the words in a message that a query typed in the
# moment before takes the place of, and then never answers.
SEARCH = """(() => {
  const said = document.querySelector(".md-search-result__meta");
  const field = document.querySelector(".md-search__input");
  if (field.value === "" && said.innerText.trim() !== "Initializing search") {
    field.focus();
    field.value = "minimum_horizontal_range";
    field.dispatchEvent(new Event("keyup", {bubbles: true}));
  }
  return /\\d/.test(said.innerText);
})()"""


def look(site, width, dark):
    """What is wrong with the pages, a sentence each."""
    faults = []
    # The search reads its index as it does from a server.
    flags = ["--allow-file-access-from-files"]
    with chromium.Browser(chromium.find(), width=width, height=844, dark=dark, limit_s=150, flags=flags) as browser:
        for page in PAGES:
            browser.open(str(site / page))
            name = f"{page}, {width} pixels, {'dark' if dark else 'light'}"
            wide = browser.run("document.documentElement.scrollWidth")
            if wide > width:
                faults.append(f"{name}: it is {wide} pixels wide.")
            if browser.run("[...document.images].some((image) => !image.naturalWidth)"):
                faults.append(f"{name}: a picture is not shown.")
            contrast = browser.run(CONTRAST)
            if contrast < 4.5:  # Required by WCAG, level AA.
                faults.append(f"{name}: some letters have a contrast of {contrast:.1f} only.")
        if not dark:
            try:
                browser.wait(SEARCH)
            except TimeoutError:
                return [*faults, *browser.problems, f"{width} pixels: the search does not answer."]
            found = browser.run("[...document.querySelectorAll('.md-search-result__link')].map((a) => a.href).join(' ')")
            if "protocol-erasor" not in found:
                faults.append(f"{width} pixels: the search for an option of erasor finds {found or 'nothing'}.")
        faults += browser.problems
    return faults


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if chromium.find() is None:
        print("pages.py: there is no Chromium; no page was looked at.")
        sys.exit(77)
    site = pathlib.Path(sys.argv[1]).resolve()
    faults = [fault for width, dark in ((390, False), (1280, True)) for fault in look(site, width, dark)]
    for fault in faults:
        print(fault)
    print(f"pages.py: {len(PAGES)} pages, twice, {len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
