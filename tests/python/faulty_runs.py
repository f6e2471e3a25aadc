"""A child of test_gmsh_faults.py: lets one call of Gmsh after the other fail within a run."""

import collections
import sys

import faulty

gmsh_calls = faulty.Faulty()  # before gmsh

import gmsh  # noqa: E402
import meshgrow  # noqa: E402

import models  # noqa: E402
from meshes import closure, has_elements, premesh, snapshots  # noqa: E402

OPTIONS = ("Mesh.MeshOnlyVisible", "Mesh.MeshOnlyEmpty", "Mesh.Renumber", "Mesh.ElementOrder",
           "Mesh.MeshSizeExtendFromBoundary", "Mesh.MeshSizeMin", "Mesh.MeshSizeMax",
           "Mesh.MeshSizeFactor", "General.AbortOnError", "General.Verbosity",
           "Print.GeoOnlyPhysicals")


gmsh.initialize(readConfigFiles=False)
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("General.NumThreads", 1)
DEFAULTS = {name: gmsh.option.getNumber(name) for name in OPTIONS}


def start_anew():
    gmsh.clear()
    for name, value in DEFAULTS.items():
        gmsh.option.setNumber(name, value)


def mapped_square():
    """A mapped square of which one side is meshed, and functions of all kinds."""
    model = models.square()
    premesh([model.bottom], 0.1)
    gmsh.model.mesh.setTransfiniteSurface(model.face[1])
    field = meshgrow.SizeField()
    field.add_mesh([model.bottom], [model.face], 1.2, 0.5)
    field.add_fixed([model.top], [model.face], 0.3, 1.2, 0.5)
    field.add_curvature([model.face], [model.face], size_limit=0.5)
    field.add_proximity([model.face], [model.face], size_limit=0.5)
    return field, 2, [model.bottom], [model.face]


class RegisteredField(meshgrow.SizeField):
    """Its `generate` is Gmsh's own, with the field registered."""

    def generate(self, dim=3, remesh=False):
        current = gmsh.model.getCurrent()
        try:
            self.register()
            gmsh.model.setCurrent("square")
            gmsh.model.mesh.generate(dim)
        finally:
            gmsh.model.setCurrent(current)
            for _ in range(2):
                self.unregister()


def registered_square():
    """A source that is meshed only in the run of Gmsh's own."""
    model = models.square()
    field = RegisteredField()
    field.add_mesh([model.bottom], [model.face], 1.2, 0.5)
    field.add_fixed([model.top], [model.face], 0.1, 1.2, 0.5)
    return field, 2, [], [model.face]


def volume_in_volume():
    """A ball in a box; the face between them is meshed, of second order."""
    model = models.sphere_in_box(side=3.0)
    premesh([model.sphere], 0.8)
    gmsh.model.mesh.setOrder(2)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    field = meshgrow.SizeField()
    field.add_mesh([model.sphere], [model.outer], 1.5, 1.5)
    field.add_curvature([model.sphere], [model.inner], angle=60, size_limit=1.5)
    return field, 3, [model.sphere], [model.inner, model.outer]


def periodic_box():
    """A box with two opposite faces that are copies of each other, one curve of them meshed."""
    volume = models.box()
    faces = sorted(models.faces_of(volume[1]), key=lambda f: gmsh.model.occ.getCenterOfMass(*f)[0])
    gmsh.model.mesh.setPeriodic(2, [faces[-1][1]], [faces[0][1]],
                                [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    premesh([faces[0]], 0.5)
    field = meshgrow.SizeField()
    field.add_mesh([faces[0]], [volume], 1.5, 1.0)
    return field, 3, [faces[0]], [volume]


def state():
    """What a run that fails must leave as it was, but for the meshes that it made."""
    return ([gmsh.option.getNumber(name) for name in OPTIONS], gmsh.model.getCurrent(),
            gmsh.model.list())


def entities_and_visibility():
    entities = gmsh.model.getEntities()
    return entities, [gmsh.model.getVisibility(*e) for e in entities]


class Run:
    """A model made anew, and its field's generate with one failing call."""

    def __init__(self, scenario):
        start_anew()
        self.field, self.dim, premeshed, self.meshed = scenario()
        self.name = gmsh.model.getCurrent()
        gmsh.option.setNumber("Mesh.MeshOnlyEmpty", 1)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.9e22)
        gmsh.model.setVisibility(gmsh.model.getEntities()[::3], 0)
        self.premesh = snapshots(closure(premeshed))
        self.entities = entities_and_visibility()
        gmsh.model.add("bystander")
        self.state = state()

    def fail_at(self, call, action):
        gmsh_calls.arm(call, action)
        try:
            self.field.generate(self.dim)
            return ""
        except meshgrow.Error as error:
            return str(error)
        finally:
            gmsh_calls.arm(0)

    def fail_ever_after(self, call):
        """As if Gmsh were finalized within the run: nothing is restored, but nothing crashes."""
        sentence = self.fail_at(call, faulty.FAIL_EVER_AFTER)
        del self.field
        gmsh_calls.arm(0)
        start_anew()
        models.square()
        gmsh.model.mesh.generate(2)
        return sentence

    def problems(self):
        """What is not as it was, after a failure."""
        if state() != self.state:
            yield "state %s instead of %s" % (state(), self.state)
        gmsh.model.setCurrent(self.name)
        if entities_and_visibility() != self.entities:
            yield "entities or visibility"
        if snapshots(self.premesh) != self.premesh:
            yield "premesh"
        gmsh_calls.arm(0)
        gmsh.model.setCurrent("bystander")
        gmsh.model.setCurrent(self.name)
        gmsh.model.setVisibility(self.entities[0], 1)
        gmsh.model.setCurrent("bystander")
        try:
            self.field.generate(self.dim)
        except meshgrow.Error as error:
            yield "next run: %s" % error
            return
        gmsh.model.setCurrent(self.name)
        if snapshots(self.premesh) != self.premesh:
            yield "premesh after the next run"
        if not all(has_elements(e) for e in self.meshed):
            yield "no mesh after the next run"
        gmsh_calls.arm(0)
        gmsh.model.mesh.generate(1)
        if any(name.startswith("size") for name in gmsh_calls.calls()):
            yield "the callback is still there"


#: Functions that may have done a part of their work when they fail; others do all or nothing.
WORKERS = ("gmshModelMeshGenerate", "gmshModelMeshSetOrder", "gmshModelMeshAddNodes",
           "gmshModelMeshAddElementsByType", "gmshModelMeshClear", "gmshMerge", "gmshWrite",
           "gmshModelSetVisibility")


#: What is only asked of Gmsh, or done, when all is over, or to tell something.
QUIET = ("gmshLoggerWrite", "gmshLoggerGetLastError", "gmshOptionGetString", "gmshOptionSetNumber",
         "gmshModelSetVisibility", "gmshModelMeshRemoveSizeCallback", "gmshModelGetCurrent",
         "gmshModelSetCurrent")


def chosen(calls, most):
    """Numbers of calls from 1: of each function the first, the last and some between; none of the
    questions for sizes, nor of what Gmsh is asked by their answers."""
    by_name = {}
    for number, name in enumerate(calls, 1):
        before = calls[number - 2] if number > 1 else ""
        if not name.startswith("size") and not before.startswith("size"):
            by_name.setdefault(name, []).append(number)
    result = set()
    for numbers in by_name.values():
        step = max(1, (len(numbers) - 1) / max(1, most - 1))
        result |= {numbers[min(len(numbers) - 1, round(i * step))] for i in range(most)}
        result.add(numbers[-1])
    return sorted(result)


def main(scenario, most):
    run = Run(scenario)
    assert run.fail_at(0, faulty.FAIL_BEFORE) == ""
    run = Run(scenario)
    gmsh_calls.arm(0)
    run.field.generate(run.dim)
    calls = gmsh_calls.calls()
    failed = 0
    passed_over = collections.Counter()
    for number in chosen(calls, most):
        name = calls[number - 1]
        for action in (faulty.FAIL_BEFORE, faulty.FAIL_AFTER)[:1 + (name in WORKERS)]:
            run = Run(scenario)
            sentence = run.fail_at(number, action)
            failed += bool(sentence)
            passed_over[name] += not sentence
            for problem in run.problems():
                print("call %d of %d (%s), action %d, error %r: %s"
                      % (number, len(calls), name, action, sentence, problem))
        if name not in QUIET:
            run = Run(scenario)
            may_go_on = isinstance(run.field, RegisteredField)  # Gmsh does, with its own sizes
            if not run.fail_ever_after(number) and not may_go_on:
                print("from call %d of %d (%s) on, no error" % (number, len(calls), name))
    print("%d failed, passed over: %s" % (failed, dict(+passed_over)))


main(globals()[sys.argv[1]], int(sys.argv[2]))
