#!/usr/bin/python3
"""The film a user of matplotlib would write: FuncAnimation and its ffmpeg writer.

film_matplotlib.py MOTION.csv OUT.mp4 WIDTH HEIGHT FPS PRESET
"""
import csv
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation

motion, out, width, height, fps, preset = sys.argv[1:7]
with open(motion) as f:
    rows = [{k: float(v) if v else math.nan for k, v in row.items()} for row in csv.DictReader(f)]
t = np.array([r["t"] for r in rows])
theta = np.array([r["theta"] for r in rows])
force = np.nan_to_num(np.array([r["contact_force"] for r in rows]))

figure = plt.figure(figsize=(int(width) / 100, int(height) / 100), dpi=100)
grid = figure.add_gridspec(2, 2, width_ratios=[2, 1])
mechanism = figure.add_subplot(grid[:, 0], aspect="equal", xlim=(-0.1, 1.1), ylim=(-0.4, 0.8))
above, below = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
above.set(xlim=(0, t[-1]), ylim=(theta.min(), theta.max()), ylabel="θ / rad")
below.set(xlim=(0, t[-1]), ylim=(0, max(force.max(), 1)), xlabel="t / s", ylabel="force / N")
cam = plt.Circle((0.25, 0), 0.1, fc="lightsteelblue", ec="slategray")
mechanism.add_patch(cam)
(beam,) = mechanism.plot([], [], lw=6, color="navy")
clock = mechanism.text(0.02, 0.95, "", transform=mechanism.transAxes)
(line_theta,) = above.plot([], [])
(line_force,) = below.plot([], [], color="C1")
x = np.linspace(0, 1, 97)


def draw(k):
    psi, angle = rows[k]["cam_angle"], theta[k]
    y = 200 * rows[k]["tip_deflection"] * x**2
    cam.center = (0.25 + 0.02 * math.cos(psi), 0.02 * math.sin(psi))
    beam.set_data(x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle))
    clock.set_text(f"t = {t[k]:.3f} s")
    line_theta.set_data(t[: k + 1], theta[: k + 1])
    line_force.set_data(t[: k + 1], force[: k + 1])
    return cam, beam, clock, line_theta, line_force


film = FuncAnimation(figure, draw, frames=len(rows), blit=False)
film.save(out, writer=FFMpegWriter(fps=float(fps), codec="libx264", extra_args=["-crf", "18", "-preset", preset]))
