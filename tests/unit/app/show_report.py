# SPDX-License-Identifier: BSD-3-Clause
"""Opens the page of a report in a browser without a window and uses it; see test_report_command.cpp.

    show_report.py FOLDER [PICTURE]     exit status 77: there is no browser, or none with WebGL 2
"""
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import browser

PIXELS = """(() => {  // of the view: how many are drawn on, how many colours there are, and a sum that tells pictures apart
  const {gl, canvas} = page.view, data = new Uint8Array(4 * canvas.width * canvas.height), colours = new Set();
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, data);
  let drawn = 0, sum = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] === 0) continue;
    ++drawn, sum = (31 * sum + data[i] + 7 * data[i + 1] + 13 * data[i + 2] + i) % 1000000007;
    colours.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
  }
  return {drawn: drawn / (canvas.width * canvas.height), colours: colours.size, sum};
})()"""


def check(holds, words):
    if not holds:
        sys.exit("not so: " + words)


def use_film(page):
    page.run("show_frame(0)")
    first = page.run(PIXELS)
    check(first["drawn"] > 0.02 and first["colours"] > 20, f"the body is drawn: {first}")
    page.run("show_frame(1e9)")
    check(page.run(PIXELS)["sum"] != first["sum"], "two times look different")
    check(page.run("by_id('time').value === by_id('time').max"), "the slider follows")
    check(page.run("dot(page.view.turn()[1], unit(report.up))") > 0.9, "up on the screen is against gravity")
    for key, frame in (("Home", 0), ("ArrowRight", 1), ("ArrowLeft", 0), ("End", page.run("report.times.length") - 1)):
        page.press(key)
        check(page.run("page.frame") == frame, f"the key {key} goes to frame {frame}")
    page.press(" ")
    check(page.run("page.playing"), "the space bar plays")
    deadline = time.monotonic() + 20
    while page.run("page.frame") == frame and time.monotonic() < deadline:
        time.sleep(0.05)
    check(page.run("page.frame") != frame, "frames go on while it plays")
    page.press(" ")
    for quantity in page.run("[...by_id('colour').options].map((option) => option.value)"):
        page.run(f"choose_quantity('{quantity}')")
        check(page.run("by_id('legend').textContent !== ''") == (quantity != ""), f"a legend for '{quantity}'")
    page.run("document.querySelectorAll('#layers select').forEach((s) => { s.value = 'off', s.dispatchEvent(new Event('change')); })")
    check(page.run("page.mark ? 0 : " + PIXELS + ".drawn") == 0, "layers can be taken away")


# How far the obstacle "quarter" reaches along x, y and z at a frame. It is a bar along x that has made a quarter turn about z at the end.
REACH = """((frame) => {
  show_frame(frame);
  const {corners} = page.obstacles.find((one) => one.name === "quarter").surface;
  return [0, 1, 2].map((k) => { const own = corners.filter((_, i) => i % 3 === k); return Math.max(...own) - Math.min(...own); });
})"""


def use_turn(page):
    first, last = page.run(REACH + "(0)"), page.run(REACH + "(1e9)")
    check(all(abs(a - b) < 1e-3 * max(first) for a, b in zip(first, (last[1], last[0], last[2]))), f"it turns: {first} {last}")
    check(first[0] > 2 * first[1], f"it is a bar along x: {first}")


def main(folder, picture=None):
    if not browser.found():
        print("skipped: no Chromium here")
        sys.exit(77)
    page = browser.Browser()
    try:
        page.open(folder + "/report.html")
        time.sleep(0.2)
        if picture:
            page.picture(picture)
        if page.run("Boolean(page.view)"):
            if not page.run("Boolean(page.view.gl)"):
                print("skipped: no WebGL 2 here")
                sys.exit(77)
            use_film(page)
        if page.run("page.obstacles.some((one) => one.name === 'quarter')"):
            use_turn(page)
        check(page.run("document.querySelectorAll('.card').length") > 0, "there are charts")
        page.press("d")
        check(page.run("document.documentElement.classList.contains('dark')"), "the key d makes it dark")
        check(not page.errors, f"nothing is complained of: {page.errors}")
        check(not page.requests, f"nothing is asked for: {page.requests}")
    finally:
        page.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
