#!/usr/bin/env python3
"""A browser (Chromium) shows the page that plays the motion: the beam has the direction that the still of the same instant shows, and the
clock and the angle are those of the motion. An arc marks the angle of the hub, an arrow the sense in which the cam turns; a bent beam has
the colours of its moment.

page.py PROGRAM

Exit code 77 (skipped) without chromium or ffmpeg.
"""
import collections
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile

INSTANTS = [0.1, 0.25, 0.49]
WIDTH, HEIGHT = 960, 540
MUTED = bytes.fromhex("666c78")
POSES = 0.001  # largest error of a page's angles [rad]
if not shutil.which("chromium") or not shutil.which("ffmpeg"):
    sys.exit(77)


def browser(folder, instant, *more):
    command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
               "--disable-component-update", "--disable-sync", f"--user-data-dir={folder}/profile", f"--window-size={WIDTH},{HEIGHT}",
               "--virtual-time-budget=1000", *more, f"file://{folder}/s.html#t={instant}"]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=120).stdout


def pixels_of(picture):
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", picture, "-f", "rawvideo", "-pix_fmt", "rgb24", "-vf", f"crop={WIDTH}:{HEIGHT - 220}:0:70", "-"], check=True, capture_output=True).stdout
    return [raw[i:i + 3] for i in range(0, len(raw), 3)]


def marked(picture):
    """Places of the pixels in the colour of arcs and letters."""
    return {(i % WIDTH, i // WIDTH) for i, pixel in enumerate(pixels_of(picture)) if all(abs(a - b) < 12 for a, b in zip(pixel, MUTED))}


def direction(picture):
    """Direction of the axis of the beam, counter-clockwise [rad]: the most frequent colour, beside the paper's, that is in many rows."""
    pixels = pixels_of(picture)
    for color, count in collections.Counter(pixels).most_common(8)[1:]:
        places = [(i % WIDTH, -(i // WIDTH)) for i, pixel in enumerate(pixels) if pixel == color]
        if count >= 300 and len({y for _, y in places}) > 50:
            break
    else:
        sys.exit(f"{picture} shows no beam")
    x, y = (sum(p[k] for p in places) / len(places) for k in range(2))
    xx, xy, yy = (sum((p[a] - m) * (p[b] - n) for p in places) for a, b, m, n in ((0, 0, x, x), (0, 1, x, y), (1, 1, y, y)))
    return math.atan2(2 * xy, xx - yy) / 2


with tempfile.TemporaryDirectory() as folder:
    stills = [{"type": "still", "file": f"{i}.png", "at": t, "size": [WIDTH, HEIGHT], "layout": "mechanism", "view": {"style": "flat"}}
              for i, t in enumerate(INSTANTS)]
    scene = {"title": "Fall", "cam": None, "beam": {"model": "rigid"}, "time": {"end": 0.5}, "outputs": [{"type": "page"}, *stills]}
    with open(f"{folder}/s.json", "w") as file:
        json.dump(scene, file)
    subprocess.run([sys.argv[1], "run", "s.json", "-q"], cwd=folder, check=True)
    table = subprocess.run([sys.argv[1], "simulate", "s.json", "--times", ",".join(map(str, INSTANTS)), "--channels", "theta", "--trajectory", "-"],
                           cwd=folder, check=True, capture_output=True, text=True).stdout.split()[1:]
    for i, (instant, row) in enumerate(zip(INSTANTS, table)):
        theta = float(row.split(",")[-1])
        browser(folder, instant, f"--screenshot={folder}/page.png")
        seen = {"page": direction(f"{folder}/page.png"), "still": direction(f"{folder}/{i}.png")}
        document = browser(folder, instant, "--dump-dom")
        print(instant, theta, seen)
        for name, angle in seen.items():
            if abs(angle - theta) > 0.004:
                sys.exit(f"the beam of the {name} at {instant} s has the direction {angle}, not {theta}")
        stated = re.search(r"θ = ([-−]?[\d.]+) rad", document)
        if f"t = {instant:.3f} s" not in document or not stated or abs(float(stated[1].replace("−", "-")) - theta) > POSES + 0.0005:
            sys.exit(f"the page does not state t = {instant:.3f} s and θ = {theta:.3f} rad")
    if len(marked(f"{folder}/page.png")) < 30:
        sys.exit("the page does not mark the angle")
    marks = {}
    for speed in (-3, 0, 3):
        subprocess.run([sys.argv[1], "render", "s.json", "-q", "--force", "-o", "s.html", "--set", f"cam={{\"speed\": {speed}}}"], cwd=folder, check=True)
        browser(folder, 0, f"--screenshot={folder}/page.png")
        marks[speed] = marked(f"{folder}/page.png")
    subprocess.run([sys.argv[1], "render", "s.json", "-q", "--force", "-o", "s.html", "--set", "hub.radius=0.3"], cwd=folder, check=True)
    browser(folder, 0, f"--screenshot={folder}/page.png")
    with open(f"{folder}/s.html") as file:
        named = dict(re.findall(r'"(hub|bracket)":"#(\w{6})"', file.read()))
    pixels = pixels_of(f"{folder}/page.png")
    hub, bracket = ([divmod(i, WIDTH) for i, pixel in enumerate(pixels) if pixel == bytes.fromhex(named[name])] for name in ("hub", "bracket"))
    (top, _), (bottom, _), left, right = min(hub), max(hub), min(x for _, x in hub), max(x for _, x in hub)
    reach = (max(y for y, x in bracket if left <= x <= right) - (top + bottom) / 2) / ((bottom - top) / 2)
    print(reach)
    if not 1.02 < reach < 1.25:
        sys.exit(f"the support of a large hub reaches {reach} times the hub's radius below its axis")
    subprocess.run([sys.argv[1], "render", "s.json", "-q", "--force", "-o", "s.html", "--set", "cam={}", "--set", "beam={}"], cwd=folder, check=True)
    browser(folder, 0.282, f"--screenshot={folder}/page.png")
    bent = sum(pixel[2] > pixel[0] + 90 for pixel in pixels_of(f"{folder}/page.png"))
    if bent < 1000:
        sys.exit(f"{bent} pixels of a bent beam have the colour of its moment")
    arrow = {speed: marks[speed] - marks[0] for speed in (-3, 3)}
    left = min(x for x, _ in arrow[3] | arrow[-3]) + 14
    heads = {speed: sum(x < left for x, _ in places) for speed, places in arrow.items()}
    print(heads)
    if heads[3] <= heads[-3]:
        sys.exit("the arrow of the cam's speed has no head, or not at its clockwise end")
