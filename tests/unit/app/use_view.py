# SPDX-License-Identifier: BSD-3-Clause
"""Starts a live view, opens its page in a browser without a window, and takes hold of the body; see test_view_command.cpp.

    use_view.py PLICA SCENE [PICTURE]     exit status 77: there is no browser, or none with WebGL 2
The scene: a soft body that is held at its underside, with gravity, and an obstacle beside it.
"""
import pathlib
import re
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import browser

# The vertex in the middle of the upper side
TOP = """(() => {
  const middle = [0, 1].map((k) => (scene.low[k] + scene.high[k]) / 2), far = (i) => Math.hypot(scene.rest[3 * i] - middle[0],
    scene.rest[3 * i + 1] - middle[1], scene.rest[3 * i + 2] - scene.high[2]);
  return [...Array(scene.rest.length / 3).keys()].reduce((best, i) => far(i) < far(best) ? i : best, 0);
})()"""


def check(holds, words):
    if not holds:
        sys.exit("not so: " + words)


def wait_for(page, script, words, seconds=60):
    deadline = time.monotonic() + seconds
    while not page.run(script):
        check(time.monotonic() < deadline, f"{words}; {page.run('live.frame && [live.frame.time, live.frame.wrong].join()')}")
        time.sleep(0.05)


def status_of(address, body, **headers):
    try:
        return urllib.request.urlopen(urllib.request.Request(address, body, headers), timeout=10).status
    except urllib.error.HTTPError as error:
        return error.code


def on_screen(page, point):
    """Where on the page a point of space is."""
    return page.run(f"""(() => {{ const {{view}} = live, at = minus({point}, view.focus), box = view.canvas.getBoundingClientRect(), [right, above] = view.turn();
      return [box.left + box.width / 2 + view.shift[0] + dot(right, at) * view.resolution(), box.top + box.height / 2 + view.shift[1] - dot(above, at) * view.resolution()]; }})()""")


def drag(page, start, by):
    page.mouse("pressed", *start)
    for part in (0.25, 0.5, 0.75, 1):
        page.mouse("moved", start[0] + part * by[0], start[1] + part * by[1])
        time.sleep(0.05)


def pull_the_body(page, picture):
    page.run(f"window.top_point = {TOP}, window.where = () => [0, 1, 2].map((k) => live.points[3 * top_point + k])")
    x, y = on_screen(page, "where()")
    page.run("window.before = where(), window.right = live.view.turn()[0]")
    drag(page, (x, y), (120, 0))
    check(page.run("live.held && !live.held.ball"), "the mouse holds the body")
    asked = page.run("dot(minus(live.held.target, live.held.place), right)")
    wait_for(page, f"dot(minus(where(), before), right) > {0.1 * asked}", "the body follows the mouse")
    check(page.run("live.frame.pull") > 0, "the page says how strong the pull is")
    check(page.run("live.view.azimuth") == -17.6, "the view is not turned")
    if picture:
        page.picture(picture)
    page.mouse("released", x + 120, y)
    wait_for(page, f"Math.abs(dot(minus(where(), before), right)) < {0.03 * asked}", "it goes back when it is let go")
    check(page.run("live.frame.pull") == 0, "nothing pulls any more")


def push_with_the_ball(page):
    page.press("b")
    wait_for(page, "live.frame.tool", "the ball is there")
    page.run("window.before = where()")
    start, end = on_screen(page, "live.ball.centre"), on_screen(page, "where()")
    drag(page, start, (end[0] - start[0], end[1] - start[1]))
    check(page.run("live.held && live.held.ball"), "the mouse holds the ball")
    wait_for(page, "live.frame.push > 0 && Math.hypot(...minus(where(), before)) > 0.02 * scene.size", "the ball pushes the body away")
    page.mouse("released", *end)
    page.press("b")
    wait_for(page, "!live.frame.tool && live.frame.push === 0", "the ball is gone")


def push_with_the_obstacle(page):
    page.run("window.all_before = live.points.slice()")
    start, end = on_screen(page, "[0.13, 0.05, 0.08]"), on_screen(page, "[0.1, 0.05, 0.08]")
    drag(page, start, (end[0] - start[0], end[1] - start[1]))
    check(page.run("live.held && live.held.obstacle && live.held.obstacle.name === 'probe'"), "the mouse holds the obstacle")
    wait_for(page, "live.frame.moved.some((one) => one.push > 0) && live.points.some((x, i) => Math.abs(x - all_before[i]) > 0.02 * scene.size)", "the obstacle pushes the body away")
    page.mouse("released", *end)
    check(page.run("!live.held && live.frame.moved.length === 1"), "it stays where it was let go")


def turn_gravity(page):
    page.run("window.before = where()[2]")
    page.run("(() => { const knob = by_id('gravity'); knob.value = knob.min; knob.dispatchEvent(new Event('input')); })()")
    wait_for(page, "where()[2] > before + 0.01 * scene.size", "gravity upside down lifts the body")


def rest_and_start(page):
    page.press(" ")
    wait_for(page, "by_id('status').textContent === 'at rest'", "it rests")
    time.sleep(0.3)
    at = page.run("live.frame.time")
    time.sleep(0.3)
    check(page.run("live.frame.time") == at, "time stands still")
    page.press("s")
    wait_for(page, "live.frame.time === 0 && live.frame.moved.length === 0", "it is back at the start")


def use(page, picture):
    if not page.run("Boolean(live.view.gl)"):
        print("skipped: no WebGL 2 here")
        sys.exit(77)
    wait_for(page, "live.frame && live.frame.time > 0.3", "time goes on")
    for colour in ("von_mises", "J", "speed", "displacement"):
        page.run(f"choose_colour('{colour}')")
        wait_for(page, "live.frame.colour === live.controls.colour && live.body.values.some((v) => v > 0) && by_id('legend').textContent !== ''",
                 f"the body is coloured by {colour}")
    pull_the_body(page, picture)
    push_with_the_ball(page)
    turn_gravity(page)
    push_with_the_obstacle(page)
    rest_and_start(page)
    check(not page.errors, f"nothing is complained of: {page.errors}")


def main(plica, scene, picture=None):
    if not browser.found():
        print("skipped: no Chromium here")
        sys.exit(77)
    program = subprocess.Popen([plica, "view", scene, "--port", "0", "--no-browser", "--threads", "1"], stderr=subprocess.PIPE, text=True)
    page = None
    try:
        words = program.stderr.readline()
        address = re.search(r"http://127.0.0.1:\d+", words)
        check(address, f"it says its address: {words}")
        check(status_of(address[0] + "/controls", b'{"speed": "fast"}') == 400, "what is no number is refused")
        check(status_of(address[0] + "/controls", b"{}", Origin="http://example.org") == 403, "pages of others are refused")
        check(status_of(address[0] + "/nowhere", None) == 404, "there is nothing else")
        page = browser.Browser(size=(1200, 800))
        page.open(address[0] + "/")
        use(page, picture)
        program.send_signal(signal.SIGINT)
        check(program.wait(timeout=20) == 0, "Ctrl-C ends it in order")
        wait_for(page, "by_id('status').textContent.startsWith('not connected')", "the page notices")
    finally:
        program.kill()
        if page:
            page.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
