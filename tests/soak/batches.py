"""Runs models in child processes: what crashes or hangs is one model's result and stops no other."""

import json
import os
import select
import subprocess
import sys
import tempfile

WORKER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "worker.py")


class Child:
    """A worker with some seeds to do."""

    def __init__(self, mode, seeds):
        self.errors = tempfile.TemporaryFile()
        read, write = os.pipe()
        self.process = subprocess.Popen(
            [sys.executable, WORKER, mode, str(write)] + [str(s) for s in seeds],
            pass_fds=[write], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=self.errors)
        os.close(write)
        self.lines = os.fdopen(read)

    def next_line(self, seconds):
        """The next message; None at the end, "timeout" if there is none for so long."""
        ready, _, _ = select.select([self.lines], [], [], seconds)
        if not ready:
            return "timeout"
        line = self.lines.readline()
        return json.loads(line) if line.endswith("\n") else None

    def end(self):
        """Exit code and the end of what it wrote to its standard error."""
        if self.process.poll() is None:
            try:
                self.process.wait(timeout=5)
            except subprocess.TimeoutExpired:
                self.process.kill()
        code = self.process.wait()
        self.errors.seek(0)
        return code, self.errors.read()[-1500:].decode(errors="replace")


def run_batch(mode, seeds, timeout):
    """Yields the results of the seeds, in their order."""
    seeds = list(seeds)
    while seeds:
        child = Child(mode, seeds)
        while True:
            message = child.next_line(timeout)
            if message is None or message == "timeout":
                break
            if "start" not in message:
                seeds.remove(message["seed"])
                yield message
        if message == "timeout":
            child.process.kill()
        code, errors = child.end()
        if seeds:  # the first one ended the process
            status = "timeout" if message == "timeout" else "crash"
            yield {"seed": seeds.pop(0), "status": status,
                   "message": "no end after %g s" % timeout if status == "timeout"
                   else "exit code %d: %s" % (code, errors)}


def run(seeds, timeout=300, batch=25):
    """Results of meshing by the library, with a new process for each `batch` of models. Those that
    fail have those without it beside them, as "callback" and "plain"."""
    for first in range(0, len(seeds), batch):
        for result in run_batch("field", seeds[first:first + batch], timeout):
            if result["status"] in ("error", "crash", "timeout"):
                for mode in ("callback", "plain"):
                    result[mode], = run_batch(mode, [result["seed"]], timeout)
            yield result
