# SPDX-License-Identifier: MIT
"""Checks that are counted, those of any page, and runs of the program that are checked."""
import subprocess

count = failures = 0


def check(name, holds, more=""):
    global count, failures
    count += 1
    if not holds:
        failures += 1
        print(f"FAILED: {name} {more}", flush=True)


def check_ids(browser):
    check("ids are unique", browser.run(
        "(() => { const all = [...document.querySelectorAll('[id]')].map((part) => part.id);"
        " return new Set(all).size === all.length; })()"))


def check_contrast(browser):
    for dark in (False, True):
        browser.set_dark(dark)
        low = browser.low_contrast()
        check(f"contrast is at least 4.5 ({'dark' if dark else 'light'})", low == [], low[:5])
    browser.set_dark(False)


def program(path, *arguments, code=0):
    """What the program printed."""
    done = subprocess.run([path, *arguments], capture_output=True, text=True)
    check(" ".join(arguments[:2]) + f" ends with {code}", done.returncode == code,
          f"(got {done.returncode}: {done.stderr[-500:]})")
    return done.stdout + done.stderr


def finish(test):
    """Prints how many checks hold, and returns the exit code."""
    print(f"{test}: {count - failures} of {count} checks hold")
    return 1 if failures else 0
