"""How long stock Gmsh waits for a size that `meshgrow serve` answers through pipes.

    python3 tests/benchmarks/serve_speed.py [--points 100000] [--mesh-size 0.01]

Asks one size after the other, as Gmsh does, and all at once; of a field that grows from a sphere
within a box. Prints the microseconds a size, and fails if an answer is missing or wrong.
"""

import argparse
import math
import os
import subprocess
import tempfile
import threading
import time

import gmsh
import numpy as np

PROGRAM = os.environ.get("MESHGROW_PROGRAM", "meshgrow")
FUNCTION = "mesh source Surface{1} attach Surface{1},Volume{2} growth 1.2 limit 1"


def make_mesh(path, size):
    """A sphere of triangles of this size, alone in a file; its volume is not meshed."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 0)
    gmsh.model.occ.addSphere(0, 0, 0, 1)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(2)
    triangles = len(gmsh.model.mesh.getElementsByType(2)[0])
    gmsh.write(path)
    gmsh.finalize()
    return triangles


class Server:
    def __init__(self, path, *options):
        function = FUNCTION.replace("Surface{1},Volume{2}", "Volume{1}")
        self.process = subprocess.Popen([PROGRAM, "serve", path, "--size-function", function,
                                         *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.into, self.out = self.process.stdin.fileno(), self.process.stdout.fileno()

    def ask(self, request):
        os.write(self.into, request)
        return os.read(self.out, 8)

    def end(self):
        os.write(self.into, np.full(3, math.nan).tobytes())
        assert self.process.wait(60) == 0


def one_by_one(server, points):
    requests = [p.tobytes() for p in points]
    begin = time.perf_counter()
    answers = [server.ask(request) for request in requests]
    seconds = time.perf_counter() - begin
    return np.frombuffer(b"".join(answers)), seconds


def all_at_once(server, points):
    begin = time.perf_counter()
    writer = threading.Thread(target=lambda: write_all(server.into, points.tobytes()))
    writer.start()
    answers = bytearray()
    while len(answers) < 8 * len(points):
        answers += os.read(server.out, 1 << 16)
    writer.join()
    return np.frombuffer(bytes(answers)), time.perf_counter() - begin


def write_all(descriptor, data):
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view):]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=100000)
    parser.add_argument("--mesh-size", type=float, default=0.02)
    arguments = parser.parse_args()
    points = np.random.default_rng(1).uniform(-2, 2, (arguments.points, 3))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "sphere.msh")
        triangles = make_mesh(path, arguments.mesh_size)
        print("%d sizes from %d triangles" % (len(points), triangles))
        print("%-10s %12s %16s %18s" % ("evaluator", "first, s", "one by one, us", "all at once, us"))
        for evaluator in ("exact", "grid"):
            begin = time.perf_counter()
            server = Server(path, "--evaluator", evaluator)
            server.ask(points[0].tobytes())
            started = time.perf_counter() - begin
            single, seconds = one_by_one(server, points)
            batch, batch_seconds = all_at_once(server, points)
            server.end()
            distance = np.abs(np.linalg.norm(points, axis=1) - 1.0)
            # Facets are chords, and their sizes differ a little.
            about = np.minimum(1.0, arguments.mesh_size + distance / 6.0)
            assert np.array_equal(single, batch)
            assert np.all(np.abs(single / about - 1.0) < 0.6)
            print("%-10s %12.2f %16.2f %18.2f" % (
                evaluator, started, 1e6 * seconds / len(points), 1e6 * batch_seconds / len(points)))


if __name__ == "__main__":
    main()
