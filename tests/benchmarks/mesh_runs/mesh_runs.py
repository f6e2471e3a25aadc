"""Seconds of whole mesh runs with the field, beside the same runs by other means.

Run it with each Python whose Gmsh is to be measured, with meshgrow on the path:

    PYTHONPATH=build/python python3 tests/benchmarks/mesh_runs/mesh_runs.py --json build/benchmarks.json

or with `--gmsh both` to have it call both Pythons (Debian's, and that of build/venv) itself. `--quick`
takes small meshes (that say nothing of the bars); `--only mesh.overhead` some of the numbers.

The model is a sphere (radius 1, its surface meshed beforehand from 0.03 to 0.15, times a scale that
makes the wanted number of tetrahedra) in a box of side 6, the volume between them attached, growth
1.2, limit 2. Gmsh and the field work on one thread. The two sides of a ratio take turns; the ratio
is that of neighbouring runs: median, lowest and highest.

    auto.vs_tree.*     field seconds with evaluator "exact" / with "auto"
    mesh.overhead.*    seconds of a run with the field / of the same run with recorded sizes
    mesh.vs_python_callback    a run with a Python callback that calls field.exact_size point by
                               point / a run with the field
    mesh.vs_extend     a run with Gmsh's field Extend / a run with the field

How they are measured:

- Every run is a process of its own, forked from one that has made the model and meshed the sphere.
- A run with the field is the user's way: SizeField(), add_mesh(), generate(3), all on the clock:
  reading, tree, grid, the passes over box curves, box faces and volume, keeping and putting back the
  sphere's mesh.
- size_recorder.c stands between meshgrow and Gmsh, without changing either. In a run with the
  field, which is not timed, it keeps every question of Gmsh and the answer.
- A run with recorded sizes begins as a fork of that very run, before Gmsh meshes the volume. From
  there on the recorder gives Gmsh the n-th recorded answer to the n-th question, without asking the
  field. Only the seconds in Gmsh's own mesher count, in the passes before without those of the field's
  answers. A question that is another one than recorded is an error, so the runs are the same to
  the bit. (Begun elsewhere, HXT of Gmsh 4.8 makes another mesh each time, as it goes by the addresses
  of nodes; there, runs with the field have the recorded number of tetrahedra within 1 %.)
- Field seconds are those of a run with the field in which the recorder takes the place of Gmsh's
  mesher: as the mesher is called, it asks the callback the questions of the recorded run, in their
  order. So the field is made ready by the entry that a user's run goes through, with nothing built
  for the benchmark. Seconds in Gmsh's own mesher (box curves and faces; the volume is not meshed)
  are taken off.
- The runs with a Python callback and with Extend make the same passes (of `field.plan(3)`) by plain
  calls of gmsh. The pass over curves takes the sphere's mesh away; putting it back is not on their
  clock, which is to our disadvantage. Extend has neither box curves nor faces to act on: there it
  gets recorded sizes. It makes the same slope as the field, which is then changed a little until the
  tetrahedra are within 5 % of ours.

Exits with 1 if a run went wrong, never for a time.
"""

import argparse
import contextlib
import ctypes
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
sys.path.insert(0, os.path.join(ROOT, "tests", "python"))

DELAUNAY, HXT = 1, 10
GROWTH_RATE, SIZE_LIMIT = 1.2, 2.0
SLOPE = 1 - 1 / GROWTH_RATE
TOLERANCE = 0.05  # of the field, and of Extend's number of tetrahedra
SAME_POINT_ROUNDING = 1e-9
EXTEND_POWER = 0.9  # slope of sizes against number of tetrahedra, about
MOST_QUESTIONS = 1 << 25  # of one run
TIMEOUT = 600  # seconds, of one run
PR_SET_PDEATHSIG = 1  # of Linux: a process ends with the one that forked it

# case -> mesher, tetrahedra at least, scale of the sphere's sizes; quick: the same
CASES = {
    "delaunay": (DELAUNAY, 1000000, 0.232),
    "hxt": (HXT, 1000000, 0.206),
    "hxt large": (HXT, 3000000, 0.115),
    "hxt small": (HXT, 200000, 0.5),
    "delaunay half": (DELAUNAY, 500000, 0.34),
}
QUICK_CASES = {
    name: (mesher, 30000, 1.3) for name, (mesher, _, _) in CASES.items()
}

# name -> case, what is above and below in the ratio, bar (at least, at most)
NUMBERS = {
    "auto.vs_tree.delaunay": ("delaunay", "ask exact", "ask auto", (0.95, None)),
    "mesh.overhead.delaunay": ("delaunay", "field", "recorded", (None, 1.03)),
    "auto.vs_tree.hxt": ("hxt large", "ask exact", "ask auto", (1.5, None)),
    "mesh.overhead.hxt": ("hxt", "field", "recorded", (None, 1.15)),
    "mesh.vs_python_callback": ("hxt small", "python", "field", (3.0, None)),
    "mesh.vs_extend": ("delaunay half", "extend", "field", (1.0, None)),
}
REPETITIONS, QUICK_REPETITIONS = 5, 2
FEWER_REPETITIONS = {"auto.vs_tree.hxt": 3}  # a minute and more each, so little noise


class WrongResult(RuntimeError):
    """What makes the exit status 1."""


# ==== The process of a case, and its runs ====


def recorder_path():
    """Beside libmeshgrow.so, or named by SIZE_RECORDER_LIB."""
    from meshgrow._library import _find_library
    named = os.environ.get("SIZE_RECORDER_LIB")
    return named or os.path.join(os.path.dirname(_find_library()), "libsize_recorder.so")


class Recorder:
    """size_recorder.c, between meshgrow and Gmsh. To be made before the first field, since that is
    when meshgrow looks for Gmsh."""

    MODES = {"field": 0, "record": 1, "ask": 3}
    DOOR = ctypes.CFUNCTYPE(None)

    def __init__(self, gmsh):
        self.lib = ctypes.CDLL(recorder_path(), mode=ctypes.RTLD_GLOBAL)
        # All of Gmsh's functions are now looked for in what is loaded for all, the recorder first.
        ctypes.CDLL(gmsh.lib._name, mode=ctypes.RTLD_GLOBAL)
        for name in ("recorder_seconds", "recorder_seconds_asking"):
            getattr(self.lib, name).restype = ctypes.c_double
        for name in ("recorder_count", "recorder_mismatches", "recorder_replayed"):
            getattr(self.lib, name).restype = ctypes.c_size_t
        self.lib.recorder_sizes.restype = ctypes.POINTER(ctypes.c_double)
        failed = self.lib.recorder_create(
            int(version_of(gmsh).startswith("4.8.")),
            ctypes.cast(gmsh.lib.gmshModelMeshSetSizeCallback, ctypes.c_void_p),
            ctypes.cast(gmsh.lib.gmshModelMeshGenerate, ctypes.c_void_p),
            ctypes.c_size_t(MOST_QUESTIONS))
        if failed:
            raise MemoryError("no memory for %d questions" % MOST_QUESTIONS)

    def begin(self, what, model, door=None):
        """`door` is called before the last pass of the run that begins."""
        self.door = self.DOOR(door) if door else None
        if self.lib.recorder_begin(self.MODES[what], ctypes.c_size_t(len(model.passes)), self.door):
            raise RuntimeError("too many passes")

    def replay(self):
        """Gmsh gets the recorded answers from now on, without meshgrow."""
        error = ctypes.c_int(0)
        self.lib.recorder_replay(ctypes.byref(error))
        if error.value:
            raise RuntimeError("Gmsh took no callback")

    def seconds(self):
        seconds = self.lib.recorder_seconds()
        if seconds < 0:
            raise RuntimeError("Gmsh's mesher was not called as often as in the recorded run, or "
                               "asked more than %d questions" % MOST_QUESTIONS)
        return seconds

    def count(self):
        return self.lib.recorder_count()

    def mismatches(self, complete=True):
        """Questions that were others than recorded, missing ones included."""
        missing = self.count() - self.lib.recorder_replayed() if complete else 0
        return self.lib.recorder_mismatches() + missing

    def sizes(self):
        import numpy
        return numpy.ctypeslib.as_array(self.lib.recorder_sizes(), (self.count(),))


def version_of(gmsh):
    return gmsh.option.getString("General.Version")


class Model:
    """The model in the current Gmsh session, the sphere's surface meshed."""

    def __init__(self, gmsh, scale):
        import meshes
        import models
        self.gmsh = gmsh
        model = models.box_in_box_of(lambda occ: occ.addSphere(0, 0, 0, 1), 6.0)
        self.volume, (self.sphere,) = model.volume, model.faces
        self.premesh(scale, meshes.closure([self.sphere]))
        self.passes = [(p["dim"], p["entities"]) for p in self.field().plan(3)]

    def premesh(self, scale, entities):
        sizes = self.gmsh.model.mesh.field.add("MathEval")
        self.gmsh.model.mesh.field.setString(sizes, "F", "%r * (0.09 + 0.06 * z)" % scale)
        self.gmsh.model.mesh.field.setAsBackgroundMesh(sizes)
        passes = [(dim, [e for e in entities if e[0] == dim]) for dim in (1, 2)]
        with run_options(self.gmsh):
            for dim, of_dim in passes:
                self.show_only(of_dim)
                self.gmsh.model.mesh.generate(dim)
            self.show_only(self.gmsh.model.getEntities())
        self.gmsh.model.mesh.field.remove(sizes)

    def show_only(self, entities):
        self.gmsh.model.setVisibility(self.gmsh.model.getEntities(), 0)
        self.gmsh.model.setVisibility(entities, 1)

    def field(self, **options):
        import meshgrow
        field = meshgrow.SizeField(**options)
        field.add_mesh([self.sphere], [self.volume], GROWTH_RATE, SIZE_LIMIT)
        return field

    def mesh(self, before_pass=lambda dim: None):
        """The passes of a run with the field by plain calls of Gmsh; seconds."""
        mesh = self.gmsh.model.mesh
        nodes = mesh.getNodes(*self.sphere, includeBoundary=False, returnParametricCoord=True)
        elements = mesh.getElements(*self.sphere)
        seconds = 0.0
        with run_options(self.gmsh):
            for dim, entities in self.passes:
                begin = time.perf_counter()
                before_pass(dim)
                self.show_only(entities)
                mesh.generate(dim)
                seconds += time.perf_counter() - begin
                if len(mesh.getElementTypes(*self.sphere)) == 0:
                    mesh.addNodes(*self.sphere, *nodes)
                    # Without tags, the elements get new ones.
                    mesh.addElements(*self.sphere, elements[0], [[] for _ in elements[0]],
                                     elements[2])
        return seconds

    def tetrahedra(self):
        return sum(len(tags) for tags in self.gmsh.model.mesh.getElements(*self.volume)[1])


@contextlib.contextmanager
def run_options(gmsh):
    """What a run with the field sets in Gmsh."""
    import meshes
    options = dict(Mesh_MeshOnlyVisible=1, Mesh_MeshOnlyEmpty=0, Mesh_Renumber=0,
                   Mesh_ElementOrder=1, Mesh_MeshSizeExtendFromBoundary=0)
    if version_of(gmsh).startswith("4.8."):
        options["Mesh_MaxNumThreads3D"] = 1
    with meshes.options(**options):
        yield


def auto_field(model):
    """A field that chooses its evaluator, and its evaluator's name."""
    try:
        return model.field(evaluator="auto"), "auto"
    except ValueError:  # of a meshgrow that has none yet
        return model.field(evaluator="grid"), "grid (no auto yet)"


def run_field(model, recorder, request):
    recorder.begin("field", model)
    begin = time.perf_counter()
    field = model.field()
    field.generate(3)
    seconds = time.perf_counter() - begin
    return {"seconds": seconds, "seconds_in_gmsh": recorder.seconds()}


def run_ask(model, recorder, request):
    import meshgrow
    import numpy
    evaluator = request["run"].split()[1]
    recorder.begin("ask", model)
    if evaluator == "auto":
        field, evaluator = auto_field(model)
    else:
        field = model.field(evaluator=evaluator)
    try:
        field.generate(3)
    except meshgrow.Error as error:
        if "Meshing stopped in" not in str(error):
            raise
    seconds = recorder.seconds()
    numpy.save(request["sizes"], recorder.sizes())
    return {"seconds": seconds, "asking": recorder.lib.recorder_seconds_asking(),
            "evaluator": evaluator}


def run_python(model, recorder, request):
    begin = time.perf_counter()
    field = model.field(evaluator="exact")
    field.refresh()
    no_size = 1e22

    def size(dim, tag, x, y, z, *_):
        return min(field.exact_size(dim, tag, [(x, y, z)])[0], no_size)

    model.gmsh.model.mesh.setSizeCallback(size)
    seconds = time.perf_counter() - begin
    return {"seconds": seconds + model.mesh()}


def run_extend(model, recorder, request):
    recorder.replay()
    mesh = model.gmsh.model.mesh

    def before_pass(dim):
        if dim == 3:
            mesh.removeSizeCallback()
            extend = mesh.field.add("Extend")
            mesh.field.setNumbers(extend, "SurfacesList", [model.sphere[1]])
            mesh.field.setNumber(extend, "DistMax", request["distance"])
            mesh.field.setNumber(extend, "SizeMax", request["size_max"])
            mesh.field.setNumber(extend, "Power", 1)
            mesh.field.setAsBackgroundMesh(extend)

    seconds = model.mesh(before_pass)
    return {"seconds": seconds, "mismatches": recorder.mismatches(complete=False)}


RUNS = {"field": run_field, "ask": run_ask, "python": run_python, "extend": run_extend}


def fork():
    """0 in the new process, which ends with this one or after a time; else its number."""
    process = os.fork()
    if process == 0:
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        signal.alarm(TIMEOUT)
    return process


def answer_of_fork(run):
    """The line of JSON for what `run()` returns in a process of its own."""
    reading, writing = os.pipe()
    process = fork()
    if process == 0:
        os.close(reading)
        try:
            answer = run()
        except BaseException as error:
            answer = {"failed": "%s: %s" % (type(error).__name__, error)}
        with os.fdopen(writing, "w") as file:
            file.write(json.dumps(answer))
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as file:
        answer = file.read()
    _, status = os.waitpid(process, 0)
    if not answer:
        why = "no end within %d s" % TIMEOUT if status & 127 == signal.SIGALRM else "a crash"
        answer = json.dumps({"failed": "%s (status %d)" % (why, status)})
    return answer


def run_forked(model, recorder, request):
    def run():
        answer = RUNS[request["run"].split()[0]](model, recorder, request)
        answer["tetrahedra"] = model.tetrahedra()
        return answer
    return answer_of_fork(run)


class Door:
    """A process with a run with the field that has come to the door of Gmsh's mesher for the last
    pass. From there it is run to its end again and again, in forks: "record" keeps Gmsh's questions
    and the field's answers, "recorded" answers so without the field."""

    def __init__(self, model, recorder):
        self.model, self.recorder = model, recorder
        ours, theirs = os.pipe(), os.pipe()
        if fork() == 0:
            signal.alarm(0)
            os.close(ours[1])
            os.close(theirs[0])
            try:
                self.come_to_the_door(os.fdopen(ours[0]), os.fdopen(theirs[1], "w"))
            finally:
                os._exit(1)
        os.close(ours[0])
        os.close(theirs[1])
        self.requests, self.answers = os.fdopen(ours[1], "w"), os.fdopen(theirs[0])

    def come_to_the_door(self, requests, answers):
        fork_ends = []  # in a fork only: where it writes its answer

        def at_the_door():
            for line in requests:
                reading, writing = os.pipe()
                process = fork()
                if process == 0:
                    fork_ends.append(os.fdopen(writing, "w"))
                    self.what = line.strip()
                    if self.what == "recorded":
                        self.recorder.lib.recorder_go_over_to_replay()
                    return
                os.close(writing)
                with os.fdopen(reading) as file:
                    answer = file.read().strip()
                os.waitpid(process, 0)
                print(answer or json.dumps({"failed": "a crash"}), file=answers, flush=True)
            os._exit(0)

        try:
            self.recorder.begin("record", self.model, at_the_door)
            field = self.model.field()
            field.generate(3)
            answer = {"seconds": self.recorder.seconds(), "calls": self.recorder.count(),
                      "mismatches": self.recorder.mismatches() if self.what == "recorded" else 0,
                      "tetrahedra": self.model.tetrahedra()}
        except BaseException as error:
            answer = {"failed": "%s: %s" % (type(error).__name__, error)}
        for file in fork_ends:
            print(json.dumps(answer), file=file, flush=True)

    def run(self, what):
        print(what, file=self.requests, flush=True)
        return self.answers.readline().strip() or json.dumps({"failed": "no way to the mesher"})


def serve(case):
    """The process of a case: a line of JSON for each line of JSON."""
    import gmsh
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # Gmsh's own words do not get between
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm3D", case["mesher"])
    recorder = Recorder(gmsh)
    model = Model(gmsh, case["scale"])
    source = sum(len(tags) for tags in gmsh.model.mesh.getElements(*model.sphere)[1])
    print(json.dumps({"source": source, "version": version_of(gmsh)}), file=answers, flush=True)
    door = Door(model, recorder)
    for line in sys.stdin:
        request = json.loads(line)
        at_the_door = request["run"] in ("record", "recorded")
        print(door.run(request["run"]) if at_the_door else run_forked(model, recorder, request),
              file=answers, flush=True)


# ==== The driver ====


def say(text):
    print("   " + text, file=sys.stderr, flush=True)


def gmsh_version():
    code = ("import gmsh; gmsh.initialize(readConfigFiles=False); "
            "print(gmsh.option.getString('General.Version'))")
    return subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True,
                          check=True).stdout.split()[-1]


class Case:
    """A model and mesher in a process of its own, and what was recorded of its run."""

    def __init__(self, name, mesher, at_least, scale, folder):
        self.stem = os.path.join(folder, name.replace(" ", "_"))
        say("recording case \"%s\"" % name)
        environment = dict(os.environ, OMP_NUM_THREADS="1", PYTHONDONTWRITEBYTECODE="1")
        self.process = subprocess.Popen(
            [sys.executable, os.path.abspath(__file__), "--serve",
             json.dumps({"mesher": mesher, "scale": scale})],
            env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.mesher, self.scale = mesher, scale
        hello = self.read_answer("the start")
        self.source, self.version = hello["source"], hello["version"]
        answer = self.run("record")
        self.tetrahedra, self.calls = answer["tetrahedra"], answer["calls"]
        say("%s tetrahedra, %s source triangles, %s calls, %.1f s in Gmsh" % (
            digits(self.tetrahedra), digits(self.source), digits(self.calls), answer["seconds"]))
        if self.tetrahedra < at_least:
            say("warning: %s tetrahedra are wanted: make the scale smaller" % digits(at_least))

    def read_answer(self, what):
        line = self.process.stdout.readline()
        answer = json.loads(line) if line else {"failed": "its process is gone"}
        if "failed" in answer:
            raise WrongResult("run \"%s\": %s" % (what, answer["failed"]))
        return answer

    def run(self, what):
        """One run, checked; its answer."""
        request = {"run": what}
        if what.startswith("ask"):
            request["sizes"] = self.sizes_file(what)
        elif what == "extend":
            request.update(self.extend)
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        answer = self.read_answer(what)
        if answer.get("mismatches"):
            raise WrongResult("%s of %s questions in run \"%s\" are not those recorded" % (
                digits(answer["mismatches"]), digits(self.calls), what))
        if what in ("field", "recorded"):
            self.check_number(what, answer["tetrahedra"])
        return answer

    def check_number(self, what, tetrahedra):
        by_address = self.version.startswith("4.8.") and self.mesher == HXT
        may_differ = 0.01 * self.tetrahedra if by_address and what == "field" else 0
        if abs(tetrahedra - self.tetrahedra) > may_differ:
            raise WrongResult("%s tetrahedra in run \"%s\", %s in the recorded one" % (
                digits(tetrahedra), what, digits(self.tetrahedra)))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()

    def sizes_file(self, what):
        return "%s.%s.npy" % (self.stem, what.replace(" ", "_"))

    def tune_extend(self):
        """The SizeMax that makes as many tetrahedra with Extend as with the field."""
        distance = 6.0  # beyond the corners of the box
        slope = SLOPE
        for _ in range(6):
            self.extend = {"distance": distance, "size_max": 0.09 * self.scale + slope * distance}
            answer = self.run("extend")
            ratio = answer["tetrahedra"] / self.tetrahedra
            say("Extend, SizeMax %.3f: %s tetrahedra, %.2f of ours" % (
                self.extend["size_max"], digits(answer["tetrahedra"]), ratio))
            if abs(ratio - 1) <= TOLERANCE:
                return
            slope *= ratio ** EXTEND_POWER
        raise WrongResult("no SizeMax of Extend makes as many tetrahedra as the field")


def digits(number):
    return "{:,}".format(number)


def check_sizes(case, exact, auto):
    """Auto's sizes are at most 1.05 times the exact ones. Returns the largest ratio."""
    import numpy
    exact = numpy.load(case.sizes_file(exact))
    auto = numpy.load(case.sizes_file(auto))
    if not (numpy.all(exact > 0) and numpy.all(auto > 0)):
        raise WrongResult("a size is not positive")
    ratio = float((auto / exact).max())
    if ratio > 1 + TOLERANCE + SAME_POINT_ROUNDING:
        raise WrongResult("a size of auto is %.4f times the exact one" % ratio)
    return ratio


def measure(name, case, repetitions):
    """The entry of a number in the JSON file."""
    _, above, below, _ = NUMBERS[name]
    if above == "extend":
        case.tune_extend()
    answers = {above: [], below: []}
    for repetition in range(repetitions):
        for what in (above, below):
            answers[what].append(case.run(what))
        say("%s, %d of %d: %s %.3f s, %s %.3f s" % (
            name, repetition + 1, repetitions, above, answers[above][-1]["seconds"], below,
            answers[below][-1]["seconds"]))
    ratios = [a["seconds"] / b["seconds"] for a, b in zip(answers[above], answers[below])]
    entry = {"median": statistics.median(ratios), "low": min(ratios), "high": max(ratios),
             "tetrahedra": case.tetrahedra, "source_triangles": case.source,
             "calls_per_tetrahedron": case.calls / case.tetrahedra,
             "seconds": {what: statistics.median(a["seconds"] for a in answers[what])
                         for what in (above, below)}}
    if above == "ask exact":
        entry["asking_seconds"] = {what: statistics.median(a["asking"] for a in answers[what])
                                   for what in (above, below)}
        entry["evaluator"] = answers[below][-1]["evaluator"]
        entry["largest_size_ratio"] = check_sizes(case, above, below)
    if above == "extend":
        entry["tetrahedra_extend"] = answers[above][-1]["tetrahedra"]
        entry["extend"] = case.extend
    return entry


def meets(value, bar):
    at_least, at_most = bar
    return (at_least is None or value >= at_least) and (at_most is None or value <= at_most)


def merge(path, version, entries):
    """Puts the numbers into a JSON file beside what is there."""
    everything = {}
    if os.path.exists(path):
        with open(path) as file:
            everything = json.load(file)
    for name, entry in entries.items():
        everything.setdefault(name, {})[version] = entry
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    with open(path + ".new", "w") as file:
        json.dump(everything, file, indent=1, sort_keys=True)
        file.write("\n")
    os.replace(path + ".new", path)


def print_table(version, entries):
    print("%-24s %-7s %7s  %-13s %-8s %-6s %10s %6s  %s" % (
        "number", "Gmsh", "median", "low - high", "bar", "", "tetrahedra", "calls", "seconds"))
    for name, entry in entries.items():
        at_least, at_most = bar = NUMBERS[name][3]
        seconds = ", ".join("%s %.3f" % pair for pair in entry["seconds"].items())
        if "asking_seconds" in entry:
            seconds += " (answers alone: %s); auto is %s" % (
                ", ".join("%.3f" % s for s in entry["asking_seconds"].values()),
                entry["evaluator"])
        print("%-24s %-7s %7.3f  %-13s %-8s %-6s %10s %6.2f  %s" % (
            name, version, entry["median"], "%.3f - %.3f" % (entry["low"], entry["high"]),
            "<= %.2f" % at_most if at_least is None else ">= %.2f" % at_least,
            "quick" if entry.get("quick") else
            "met" if meets(entry["median"], bar) else "below",
            digits(entry["tetrahedra"]), entry["calls_per_tetrahedron"], seconds))


def repetitions_of(name, arguments):
    if arguments.repetitions:
        return arguments.repetitions
    return QUICK_REPETITIONS if arguments.quick else FEWER_REPETITIONS.get(name, REPETITIONS)


def measure_all(arguments):
    cases = QUICK_CASES if arguments.quick else CASES
    by_case = {}
    for name, (case, *_) in NUMBERS.items():
        if name.startswith(arguments.only):
            by_case.setdefault(case, []).append(name)
    version = gmsh_version()
    entries, status = {}, 0
    with tempfile.TemporaryDirectory(prefix="mesh_runs", dir=arguments.folder) as folder:
        for case_name, names in by_case.items():
            if names == ["mesh.vs_extend"] and version.startswith("4.8."):
                say("mesh.vs_extend is left out: Gmsh %s has no field Extend" % version)
                continue
            begin = time.perf_counter()
            try:
                with Case(case_name, *cases[case_name], folder) as case:
                    for name in names:
                        entries[name] = measure(name, case, repetitions_of(name, arguments))
                        entries[name]["quick"] = arguments.quick
            except WrongResult as error:
                print("error: %s: %s" % (", ".join(names), error), file=sys.stderr, flush=True)
                status = 1
            say("%s took %.0f s" % (", ".join(names), time.perf_counter() - begin))
    if arguments.json and entries:
        merge(arguments.json, version, entries)
    print_table(version, entries)
    return status


BUILD = os.environ.get("MESHGROW_BUILD", os.path.join(ROOT, "build"))
PYTHONS = {"debian": "/usr/bin/python3", "newest": os.path.join(BUILD, "venv/bin/python")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small meshes, few repetitions")
    parser.add_argument("--repetitions", type=int,
                        help="of each run (%d, quick %d)" % (REPETITIONS, QUICK_REPETITIONS))
    parser.add_argument("--only", default="", metavar="PREFIX", help="numbers whose names begin so")
    parser.add_argument("--json", metavar="FILE", help="file to put the numbers into")
    parser.add_argument("--gmsh", choices=["this", "debian", "newest", "both"], default="this",
                        help="the Gmsh of this Python, or of others")
    parser.add_argument("--folder", help="for files for the while (120 MB)")
    parser.add_argument("--serve", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.serve:
        serve(json.loads(arguments.serve))
        return 0
    if arguments.gmsh != "this":
        names = ["debian", "newest"] if arguments.gmsh == "both" else [arguments.gmsh]
        rest = sys.argv[1:]
        return max(subprocess.run([PYTHONS[name], os.path.abspath(__file__)] + rest +
                                  ["--gmsh", "this"]).returncode for name in names)
    return measure_all(arguments)


if __name__ == "__main__":
    sys.exit(main())
