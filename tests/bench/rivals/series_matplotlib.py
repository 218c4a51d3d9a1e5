"""The figure of `beamcam figure SCENE --channels theta,tip_deflection,contact_force --impacts --height 115mm` by matplotlib, from
`simulate --rate 20000 --channels theta,tip_deflection,contact_force > t.csv` and `simulate --impacts i.json`."""
import csv, json, sys
import matplotlib
matplotlib.use("pdf")
import matplotlib.pyplot as plt

matplotlib.rcParams.update({"font.family": "Liberation Sans", "font.size": 8, "pdf.fonttype": 42, "axes.linewidth": 0.6,
                            "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
                            "mathtext.fontset": "custom", "mathtext.it": "Liberation Serif:italic"})
rows = {name: [] for name in ("t", "theta", "tip_deflection", "contact_force")}
with open("t.csv") as file:
    for row in csv.DictReader(file):
        for name in rows:
            rows[name].append(float(row[name] or "nan"))
impacts = [i["t_start"] for i in json.load(open("i.json"))["impacts"]]
panels = (("theta", 1, r"$\theta$ / rad"), ("tip_deflection", 1e3, "$w$ / mm"), ("contact_force", 1, "$F$ / N"))
figure, axes = plt.subplots(3, 1, sharex=True, figsize=(90 / 25.4, 115 / 25.4), constrained_layout=True)
for axis, letter, (name, factor, label) in zip(axes, "abc", panels):
    axis.plot(rows["t"], [factor * v for v in rows[name]], color="#0072B2", linewidth=0.9)
    for at in impacts:
        axis.axvline(at, color="#888888", linewidth=0.45, dashes=(3.3, 3.3))
    axis.set_ylabel(label)
    axis.set_title(f"({letter})", loc="left", fontsize=8, fontweight="bold")
    axis.minorticks_on()
    axis.tick_params(which="both", direction="in", top=True, right=True)
axes[-1].set_xlim(0, 1.5)
axes[-1].set_xlabel("$t$ / s")
figure.savefig("mpl.pdf")
