#!/usr/bin/python3
"""The film a user of pycairo would write in an afternoon: every frame drawn whole, piped to ffmpeg.

film_cairo.py MOTION.csv OUT.mp4 WIDTH HEIGHT FPS PRESET
The motion is a table of beamcam (t, theta, tip_deflection, contact_force, contact_x, cam_angle).
"""
import csv
import math
import subprocess
import sys

import cairo

motion, out, width, height, fps, preset = sys.argv[1:7]
width, height = int(width), int(height)
with open(motion) as f:
    rows = [{k: float(v) if v else math.nan for k, v in row.items()} for row in csv.DictReader(f)]
times = [r["t"] for r in rows]
angles = [r["theta"] for r in rows]
low, high = min(angles), max(angles)

encoder = subprocess.Popen(
    ["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "bgra", "-s", f"{width}x{height}", "-r", fps,
     "-i", "-", "-c:v", "libx264", "-crf", "18", "-preset", preset, "-pix_fmt", "yuv420p", out], stdin=subprocess.PIPE)
surface = cairo.ImageSurface(cairo.FORMAT_RGB24, width, height)
c = cairo.Context(surface)
scale = 0.5 * height
x0, y0 = 0.08 * width, 0.6 * height


def place(x, y):
    return x0 + scale * x, y0 - scale * y


def chart(top, tall, key, least, most, colour, k, label):
    left, wide = 0.66 * width, 0.31 * width
    c.set_source_rgb(0.85, 0.85, 0.85)
    c.rectangle(left, top, wide, tall)
    c.set_line_width(1)
    c.stroke()
    c.set_source_rgb(0.2, 0.2, 0.2)
    c.move_to(left, top - 8)
    c.set_font_size(height / 50)
    c.show_text(label)
    c.set_source_rgb(*colour)
    c.set_line_width(2)
    for j in range(k + 1):
        value = rows[j][key]
        value = 0 if math.isnan(value) else value
        c.line_to(left + wide * times[j] / times[-1], top + tall * (1 - (value - least) / (most - least or 1)))
    c.stroke()


most_force = max([r["contact_force"] for r in rows if not math.isnan(r["contact_force"])] + [1])
for k, row in enumerate(rows):
    c.set_source_rgb(1, 1, 1)
    c.paint()
    psi, theta = row["cam_angle"], row["theta"]
    bx, by = place(0.25 + 0.02 * math.cos(psi), 0.02 * math.sin(psi))
    c.set_source_rgb(0.75, 0.8, 0.88)
    c.arc(bx, by, 0.1 * scale, 0, 2 * math.pi)
    c.fill_preserve()
    c.set_source_rgb(0.3, 0.35, 0.45)
    c.set_line_width(2)
    c.stroke()
    c.set_source_rgb(0.1, 0.2, 0.5)
    c.set_line_width(0.02 * scale)
    for i in range(97):
        x = i / 96
        y = 200 * row["tip_deflection"] * x * x
        c.line_to(*place(x * math.cos(theta) - y * math.sin(theta), x * math.sin(theta) + y * math.cos(theta)))
    c.stroke()
    c.set_source_rgb(0.1, 0.1, 0.1)
    c.set_font_size(height / 36)
    c.move_to(40, 60)
    c.show_text(f"t = {row['t']:.3f} s")
    chart(0.12 * height, 0.34 * height, "theta", low, high, (0, 0.45, 0.7), k, "theta / rad")
    chart(0.58 * height, 0.34 * height, "contact_force", 0, most_force, (0.84, 0.37, 0), k, "force / N")
    surface.flush()
    encoder.stdin.write(surface.get_data())
encoder.stdin.close()
sys.exit(encoder.wait())
