"""A sweep of 24 meshes of a part on Dask: growth rate, wall size and mesher of its volume.

    python3 examples/sweep_dask.py                          # on this machine, a process for each core
    python3 examples/sweep_dask.py --scheduler tcp://host:8786 --folder /shared/sweep

The part is a nut (t20_data.step of Gmsh's documentation), whose sizes grow from its walls. Variants
that differ only in the mesher have the same field: it is made once and kept in a file, which their
workers map into memory together. A variant whose Gmsh crashes takes its worker process along; Dask
starts another one, the variant is tried once more, and no other is lost.

Needs `distributed` from PyPI, here and on the workers, which share the folder with this program.
"""

import argparse
import contextlib
import os
import signal
import sys
import threading
import time

import dask
import distributed

import example_tools as tools

MODEL = "t20_data.step"
COARSE = float(os.environ.get("MESHGROW_EXAMPLES_COARSE", "1"))  # tests run it coarser
GROWTH_RATES = (1.1, 1.2, 1.3, 1.5)
WALL_SIZES = (0.6 * COARSE, 0.8 * COARSE, 1.2 * COARSE)  # mm; the nut is 43 mm wide
SIZE_LIMIT = 5.0 * COARSE
MESHERS = {"Delaunay": 1, "HXT": 10}
TRIES = 2


def all_variants():
    """Neighbours share a field."""
    return [{"growth": growth, "wall": wall, "mesher": mesher}
            for growth in GROWTH_RATES for wall in WALL_SIZES for mesher in MESHERS]


def field_of(variant):
    return variant["growth"], variant["wall"]


# ==== What workers do

@contextlib.contextmanager
def signals_left_alone():
    """Dask runs tasks beside the main thread, where Python lets nobody set signals; Gmsh would."""
    set_signal, signal.signal = signal.signal, lambda *_: None
    try:
        yield
    finally:
        signal.signal = set_signal


def in_gmsh(model, work):
    """Runs `work` with the model open in this worker's Gmsh, which does one thing at a time."""
    lock = distributed.get_worker().__dict__.setdefault("lock_of_gmsh", threading.Lock())
    with lock, signals_left_alone():
        import gmsh
        gmsh.initialize(readConfigFiles=False)
        try:
            gmsh.option.setNumber("General.Verbosity", 1)
            gmsh.open(model)
            return work(gmsh)
        finally:
            gmsh.finalize()


def make_field(model, growth, wall, path):
    """Sizes that grow from all walls into the volume, kept in a file; returns its path."""
    import meshgrow

    def work(gmsh):
        field = meshgrow.SizeField(threads=1)
        field.add_fixed(gmsh.model.getEntities(2), gmsh.model.getEntities(3), size=wall,
                        growth_rate=growth, size_limit=SIZE_LIMIT)
        beside = "%s.%d" % (path, os.getpid())
        field.save(beside)
        os.replace(beside, path)
        return path

    return in_gmsh(model, work)


def mesh_variant(model, path, variant, crash):
    """Meshes with the sizes of the file; returns what the table shows."""
    import meshgrow

    def work(gmsh):
        begin = time.perf_counter()
        if crash:
            os.abort()  # as a bug in a mesher would
        gmsh.option.setNumber("Mesh.Algorithm3D", MESHERS[variant["mesher"]])
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        field = meshgrow.SizeField.load(path)
        field.register()
        gmsh.model.mesh.generate(3)
        field.unregister()
        report = meshgrow.report(3)
        return dict(report, seconds=time.perf_counter() - begin)

    return in_gmsh(model, work)


# ==== What this program does

class Bar:
    """Progress on one line of the terminal, or in lines where there is no terminal."""

    def __init__(self, total):
        self.total = total
        self.done = 0
        self.begin = time.perf_counter()
        self.show("")

    def step(self, what):
        self.done += 1
        self.show(what)

    def say(self, sentence):
        print(("\r\033[K" if sys.stdout.isatty() else "") + "   " + sentence, flush=True)
        self.show("")

    def show(self, what):
        seconds = time.perf_counter() - self.begin
        if sys.stdout.isatty():
            full = 40 * self.done // self.total
            print("\r\033[K[%s%s] %d of %d, %.0f s  %s" % (
                "#" * full, "." * (40 - full), self.done, self.total, seconds, what),
                end="\n" if self.done == self.total else "", flush=True)
        elif what:
            print("   %d of %d, %.0f s: %s" % (self.done, self.total, seconds, what), flush=True)


def name_of(variant):
    return "growth %g, wall %g, %s" % (variant["growth"], variant["wall"], variant["mesher"])


class Sweep:
    """No more tasks at Dask than its workers work on: one that dies takes no other along."""

    def __init__(self, client, model, folder, variants, crashes=(None, 0)):
        self.client, self.model, self.folder = client, model, folder
        self.variants = variants
        self.crash_variant, self.crash_tries = crashes  # for tests
        self.results = [{} for _ in variants]
        self.tries = {}
        self.field_paths = {}
        self.tasks = {}  # future -> what it does: ("field", key) or ("mesh", index of variant)
        self.waiting = [("field", key) for key in dict.fromkeys(map(field_of, variants))]
        self.bar = Bar(len(variants))

    def submit(self, what):
        self.tries[what] = self.tries.get(what, 0) + 1
        kind, which = what
        if kind == "field":
            path = os.path.join(self.folder, "growth_%g_wall_%g.mgf" % which)
            future = self.client.submit(make_field, self.model, *which, path, pure=False)
        else:
            variant = self.variants[which]
            crash = which == self.crash_variant and self.tries[what] <= self.crash_tries
            future = self.client.submit(mesh_variant, self.model,
                                        self.field_paths[field_of(variant)], variant, crash,
                                        pure=False)
        self.tasks[future] = what
        return future

    def run(self):
        slots = max(1, sum(self.client.nthreads().values()))
        completed = distributed.as_completed()
        while self.waiting or self.tasks:
            while self.waiting and len(self.tasks) < slots:
                completed.add(self.submit(self.waiting.pop(0)))
            future = next(completed)
            self.take(future, self.tasks.pop(future))
        return self.results

    def take(self, future, what):
        kind, which = what
        try:
            result = future.result()
        except distributed.KilledWorker:
            if self.tries[what] < TRIES:
                self.bar.say("%s crashed its worker and is tried once more" % self.text(what))
                self.waiting.insert(0, what)
            else:
                self.give_up(what, "crashed %d times" % TRIES)
        except Exception as error:  # the others are worth their time
            self.give_up(what, "failed: %s" % error)
        else:
            if kind == "field":
                self.field_paths[which] = result
                self.waiting += [("mesh", i) for i, variant in enumerate(self.variants)
                                 if field_of(variant) == which]
            else:
                crashes = self.tries[what] - 1
                self.results[which] = dict(
                    result, note="" if crashes == 0 else "crashed once before")
                self.bar.step(self.text(what))

    def give_up(self, what, reason):
        kind, which = what
        lost = [which] if kind == "mesh" else [
            i for i, variant in enumerate(self.variants) if field_of(variant) == which]
        for i in lost:
            self.results[i] = {"note": reason}
            self.bar.step("%s %s" % (name_of(self.variants[i]), reason))

    def text(self, what):
        kind, which = what
        return name_of(self.variants[which]) if kind == "mesh" else \
            "the field of growth %g, wall %g" % which


def show(variants, results):
    print("\n%-32s %10s %11s %10s %8s" % ("variant", "tetrahedra", "ratio 99 %", "gamma min",
                                          "seconds"))
    for variant, result in zip(variants, results):
        if "elements" in result:
            print("%-32s %10s %11.2f %10.3f %8.1f  %s" % (
                name_of(variant), "{:,}".format(result["elements"]), result["ratio_99"],
                result["gamma_min"], result["seconds"], result["note"]))
        else:
            print("%-32s %s" % (name_of(variant), result["note"]))


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scheduler", metavar="ADDRESS",
                        help="of a Dask cluster that runs; without, one is started here")
    parser.add_argument("--workers", type=int, default=os.cpu_count(),
                        help="processes to start here (default: one for each core)")
    parser.add_argument("--variants", type=int, default=len(all_variants()),
                        help="only so many of the %(default)s")
    parser.add_argument("--folder", default=os.path.join(tools.OUT, "sweep"),
                        help="for the files of sizes; workers must reach it, too")
    parser.add_argument("--crash-variant", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--crash-tries", type=int, default=TRIES, help=argparse.SUPPRESS)
    return parser.parse_args(arguments)


def main(arguments=None):
    """Returns one dictionary for each variant: a report with `seconds` and a `note`."""
    options = parse(arguments)
    variants = all_variants()[:options.variants]
    os.makedirs(options.folder, exist_ok=True)
    model = os.path.abspath(tools.find_model(MODEL))
    # A worker's death is ours to judge, see Sweep.
    with dask.config.set({"distributed.scheduler.allowed-failures": 0}):
        if options.scheduler:
            cluster = options.scheduler
        else:
            cluster = distributed.LocalCluster(
                n_workers=options.workers, threads_per_worker=1, processes=True,
                dashboard_address=None, silence_logs="CRITICAL")
        with distributed.Client(cluster) as client:
            print("== %d variants of %s on %d workers" % (
                len(variants), MODEL, len(client.nthreads())), flush=True)
            results = Sweep(client, model, os.path.abspath(options.folder), variants,
                            (options.crash_variant, options.crash_tries)).run()
        if not options.scheduler:
            cluster.close()
    show(variants, results)
    return results


if __name__ == "__main__":
    sys.exit(0 if all("elements" in result for result in main()) else 1)
