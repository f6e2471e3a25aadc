"""Runs models in child processes: what crashes or hangs is the result of one, and stops nothing."""

import json
import os
import signal
import subprocess
import sys
import tempfile

WORKER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "worker.py")


class Child:
    """A worker with some seeds to do."""

    def __init__(self, mode, seeds, limit):
        self.errors = tempfile.TemporaryFile()
        read, write = os.pipe()
        self.process = subprocess.Popen(
            [sys.executable, WORKER, mode] + [str(n) for n in (write, limit, *seeds)],
            pass_fds=[write], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=self.errors)
        os.close(write)
        self.lines = os.fdopen(read)

    def messages(self):
        """What it tells, to its end; a line that it could not finish is none."""
        for line in self.lines:
            if line.endswith("\n"):
                yield json.loads(line)

    def end(self):
        """Exit code and the end of what it wrote to its standard error."""
        code = self.process.wait()
        self.lines.close()
        self.errors.seek(0)
        return code, self.errors.read()[-1500:].decode(errors="replace")


def run_batch(mode, seeds, limit):
    """Yields the results of the seeds, in their order."""
    seeds = list(seeds)
    while seeds:
        child = Child(mode, seeds, limit)
        asked = None
        for message in child.messages():
            asked = message.get("asked", asked)
            if "status" in message:
                seeds.remove(message["seed"])
                yield message
        code, errors = child.end()
        if seeds:  # the first one ended the process
            late = code in (-signal.SIGXCPU, -signal.SIGALRM)
            status = "gmsh" if asked != seeds[0] else "timeout" if late else "crash"
            yield {"seed": seeds.pop(0), "status": status,
                   "message": "no end after %d s" % limit if late
                   else "exit code %d: %s" % (code, errors)}


def run(seeds, limit=20, batch=25):
    """Results of meshing by the library, with a new process for each `batch` of models and `limit`
    seconds of the processor for a model."""
    for first in range(0, len(seeds), batch):
        yield from run_batch("field", seeds[first:first + batch], limit)


def failed_in_the_library(result):
    return result["status"] in ("error", "crash", "timeout")


def without_the_library(result, limit=20):
    """A failed result with those of Gmsh alone beside it."""
    return dict(result, **{mode: next(run_batch(mode, [result["seed"]], limit))
                           for mode in ("callback", "plain")})
