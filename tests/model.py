#!/usr/bin/env python3
"""Another program (Debian's assimp-utils) reads a model of beamcam: it must find the meshes, joints and tracks that were written.

model.py PROGRAM

Exit code 77 (skipped) without assimp.
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
    output = subprocess.run(["assimp", "info", "s.glb"], cwd=folder, check=True, capture_output=True, text=True).stdout


def number(name):
    return int(re.search(rf"^{name}:\s*(\d+)", output, re.MULTILINE)[1])


wanted = {"Meshes": 6, "Animations": 1, "Materials": 3, "Bones": 25, "Animation Channels": 27}
found = {name: number(name) for name in wanted}
if found != wanted:
    sys.exit(f"assimp found {found}, not {wanted}:\n{output}")
print(found)
