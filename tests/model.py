#!/usr/bin/env python3
"""A model that beamcam writes is read by another program (Debian's assimp-utils): meshes, joints and tracks are those that were written.

model.py PROGRAM

Ends with 77 (skipped) where there is no assimp.
"""
import re
import shutil
import subprocess
import sys
import tempfile

if not shutil.which("assimp"):
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    with open(f"{folder}/s.json", "w") as scene:
        scene.write('{"time": {"end": 0.5}, "outputs": [{"type": "model", "fps": 30}]}')
    subprocess.run([sys.argv[1], "run", "s.json", "-q"], cwd=folder, check=True)
    told = subprocess.run(["assimp", "info", "s.glb"], cwd=folder, check=True, capture_output=True, text=True).stdout


def number(name):
    return int(re.search(rf"^{name}:\s*(\d+)", told, re.MULTILINE)[1])


wanted = {"Meshes": 6, "Animations": 1, "Materials": 3, "Bones": 25, "Animation Channels": 27}
found = {name: number(name) for name in wanted}
if found != wanted:
    sys.exit(f"assimp found {found}, not {wanted}:\n{told}")
print(found)
