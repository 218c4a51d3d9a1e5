#!/usr/bin/env python3
"""Runs the script of scenes/SWEEPS.md for Slurm on a Slurm cluster of one node, which this program starts and stops.

slurm.py PROGRAM

The daemons munged, slurmctld and slurmd run in a temporary folder, as this user, on free ports. The collected parts must have
the bytes of the whole sweep, also after one of the tasks was killed. Exit code 77 (skipped) without Slurm, or if it does not
start, as in a container without the necessary rights.
"""
import contextlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
PARTS = 5
SCENE = """{"beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5},
"cam": {"eccentricity": "2 mm"},
"sweep": {"over": [{"key": "cam.speed", "from": 40, "to": 60, "count": 41}], "transient": {"cam_turns": 20000}}}"""
CONFIGURATION = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
MailProg=/bin/true
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus}
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class Unavailable(Exception):
    pass


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(ready, seconds, what):
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            raise Unavailable(what)
        time.sleep(0.2)


@contextlib.contextmanager
def daemon(command, folder, name, **options):
    with open(folder / (name + ".out"), "wb") as log:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, **options)
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@contextlib.contextmanager
def cluster(folder):
    """Yields the environment of the commands of a Slurm that takes jobs."""
    key = folder / "munge.key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o600)
    for name in ("state", "spool"):
        (folder / name).mkdir()
    configuration = folder / "slurm.conf"
    configuration.write_text(CONFIGURATION.format(
        host=socket.gethostname().split(".")[0], folder=folder, cpus=os.cpu_count(), controller_port=free_port(),
        node_port=free_port(), user=subprocess.check_output(["id", "-un"], text=True).strip()))
    # Nothing here uses control groups, but slurmd asks for the plugin.
    (folder / "cgroup.conf").write_text(
        f"CgroupPlugin={'disabled' if slurm_version() >= (23, 2) else 'cgroup/v1'}\n")
    environment = dict(os.environ, SLURM_CONF=str(configuration))
    munge = ["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket",
             f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed"]
    with contextlib.ExitStack() as daemons:
        daemons.enter_context(daemon(munge, folder, "munged"))
        wait_until((folder / "munge.socket").exists, 10, "munged does not start")
        for name in ("slurmctld", "slurmd"):
            daemons.enter_context(daemon([name, "-D", "-f", str(configuration)], folder, name, env=environment))

        def idle():
            state = subprocess.run(["sinfo", "--noheader", "--format=%T"], env=environment, capture_output=True,
                                   text=True)
            return state.stdout.strip() == "idle"

        wait_until(idle, 40, "its node does not come up")
        yield environment


def slurm_version():
    words = subprocess.check_output(["slurmctld", "-V"], text=True).split()
    return tuple(int(part) for part in words[-1].split(".")[:2])


def logs(folder):
    return "\n".join(f"-- {file.name}\n{file.read_text(errors='replace')[-2000:]}"
                     for file in sorted([*folder.glob("*.log"), *folder.glob("*.out")]))


def require(condition, message):
    if not condition:
        raise AssertionError(message)


class Sweep:
    """A sweep in a folder of its own, its script and the bytes that it must have."""

    def __init__(self, program, folder, environment):
        self.folder = folder
        bin_folder = folder / "bin"
        bin_folder.mkdir(parents=True)
        (bin_folder / "beamcam").symlink_to(program)
        self.environment = dict(environment, PATH=f"{bin_folder}:{os.environ['PATH']}")
        (folder / "s.json").write_text(SCENE)
        self.run("beamcam sweep s.json --seed same -q -o whole.csv")
        (self.folder / "run.sh").write_text(recipe())

    def run(self, command):
        done = subprocess.run(command, shell=True, cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, timeout=600)
        require(done.returncode == 0, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def submit(self):
        """The number of the job, whose tasks may wait still."""
        return self.run("sbatch --parsable run.sh").strip()

    def wait_for(self, job):
        """Nothing keeps accounts: a job that the controller does not list any more, or as done, has ended."""
        wait_until(lambda: not self.run("squeue --noheader --array").strip(), 300, f"job {job} does not end")

    def require_whole(self):
        self.run(f"beamcam collect r.*of{PARTS}.points -o r.csv --force -q")
        require((self.folder / "r.csv").read_bytes() == (self.folder / "whole.csv").read_bytes(), "other bytes")

    def is_made(self):
        self.wait_for(self.submit())
        self.require_whole()

    def goes_on_after_a_kill(self):
        for part in self.folder.glob(f"r.*of{PARTS}.points"):
            part.unlink()
        job = self.submit()
        killed = self.kill_one()
        self.wait_for(job)
        require(killed and not (self.folder / killed).exists(), "no task was killed")
        require((self.folder / (killed + ".part")).exists(), f"{killed}: no points were kept")
        self.is_made()

    def kill_one(self):
        """Kills a task that has made points but not all; returns the name of its part."""
        end = time.monotonic() + 60
        while time.monotonic() < end:
            for store in self.folder.glob("r.*.part"):
                number = store.name.split(".")[1].split("of")[0]
                for process in pathlib.Path("/proc").glob("[0-9]*"):
                    with contextlib.suppress(OSError):
                        if store.stat().st_size > 10000 and f"SLURM_ARRAY_TASK_ID={number}\0".encode() in \
                                (process / "environ").read_bytes() and (process / "comm").read_text() == "beamcam\n":
                            os.kill(int(process.name), signal.SIGKILL)
                            return store.name.removesuffix(".part")
        return None


def recipe():
    """The script in SWEEPS.md, for the scene and the number of parts here."""
    text = (pathlib.Path(__file__).parents[2] / "scenes/SWEEPS.md").read_text(encoding="utf-8")
    lines = text[text.index("    #!/bin/sh\n    #SBATCH"):].split("\n\n")[0].split("\n")
    script = "\n".join(line[4:] for line in lines) + "\n"
    return script.replace("scenes/bifurcation.json", "s.json").replace("16", str(PARTS))


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    needed = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo")
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    missing = [name for name in needed if not shutil.which(name)]
    if missing:
        print("skipped: missing", ", ".join(missing))
        return SKIPPED
    folder = pathlib.Path(tempfile.mkdtemp(prefix="beamcam-slurm-"))
    folder.chmod(0o755)  # munged wants it so
    try:
        with cluster(folder) as environment:
            sweep = Sweep(program, folder / "work", environment)
            sweep.is_made()
            sweep.goes_on_after_a_kill()
        print("equal to the whole sweep: parts of an array job, and after one of its tasks was killed")
        return 0
    except Unavailable as reason:
        print(f"skipped: Slurm does not work here: {reason}\n{logs(folder)}")
        return SKIPPED
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
