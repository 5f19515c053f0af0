"""A Slurm cluster of this machine alone: munge, the controller and one node, on the loopback interface, as root."""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel", "sinfo")

CONFIGURATION = """ClusterName=zerocount
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmctldPort={controller_port}
SlurmdPort={node_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SlurmdParameters=config_overrides
MaxArraySize={max_array_size}
KillWait=2
MinJobAge=10
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
"""


def missing_programs():
    return [program for program in PROGRAMS if shutil.which(program) is None]


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class LocalCluster:
    """`with LocalCluster(folder) as cluster:`; cluster.env is the environment of Slurm's commands."""

    def __init__(self, folder, cpus=4, max_array_size=1001):
        self.folder = pathlib.Path(folder)
        self.env = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        host = socket.gethostname().split(".")[0]
        controller_port, node_port = free_ports(2)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=host, folder=self.folder, controller_port=controller_port, node_port=node_port, cpus=cpus,
            max_array_size=max_array_size))
        self.daemons = {}

    def __enter__(self):
        try:
            self.bring_up()
        except BaseException:
            self.stop_daemons()
            raise
        return self

    def bring_up(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self.folder.chmod(0o755)
        self.start("munged", ["--foreground", "--force", f"--socket={self.folder}/munge.socket", f"--key-file={key}",
                              f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                              f"--seed-file={self.folder}/munged.seed", "--num-threads=2"])
        self.wait_for("the socket of munge", (self.folder / "munge.socket").exists)
        self.start_controller()
        self.start("slurmd", ["-D", "-f", self.env["SLURM_CONF"], "-N", socket.gethostname().split(".")[0]])
        self.wait_for("an idle node", lambda: "idle" in self.output("sinfo", "--noheader", "--format=%t"))

    def __exit__(self, *_):
        subprocess.run(["scancel", "--me"], env=self.env, check=False, capture_output=True)
        try:
            self.wait_for("the end of all jobs", lambda: not self.output("squeue", "--noheader").strip(), 30)
        finally:
            self.stop_daemons()

    def stop_daemons(self):
        for process in self.stepd_processes():
            os.kill(process, signal.SIGKILL)
        for name in ("slurmd", "slurmctld", "munged"):
            self.stop(name)

    def start(self, name, arguments):
        with open(self.folder / f"{name}.out", "ab") as log:
            self.daemons[name] = subprocess.Popen([shutil.which(name), *arguments], env=self.env, stdout=log, stderr=log)

    def stop(self, name, number=signal.SIGTERM):
        process = self.daemons.pop(name, None)
        if process is None:
            return
        process.send_signal(number)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def start_controller(self):
        self.start("slurmctld", ["-D", "-f", self.env["SLURM_CONF"]])
        self.wait_for("the controller", lambda: self.run("scontrol", "ping").returncode == 0)

    def stepd_processes(self):
        """slurmstepd processes of this cluster's node."""
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if (process / "comm").read_text().strip() == "slurmstepd" and str(self.folder) in (process / "environ").read_text():
                    yield int(process.name)
            except OSError:
                pass

    def run(self, *words):
        return subprocess.run(words, env=self.env, capture_output=True, text=True, check=False)

    def output(self, *words):
        return self.run(*words).stdout

    def wait_for(self, what, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                logs = "\n".join(f"{log.name}:\n{log.read_text(errors='replace')[-2000:]}" for log in self.folder.glob("*.log"))
                raise TimeoutError(f"no {what} after {seconds} s\n{logs}")
            time.sleep(0.1)

    def wait_for_jobs(self, seconds=300):
        self.wait_for("end of the jobs", lambda: not self.output("squeue", "--noheader").strip(), seconds)
