"""What the examples share: where results go, models, words on the terminal."""

import gzip
import os
import sys
import time

import gmsh
import meshgrow

from page.cases import OUT

COARSE = float(os.environ.get("MESHGROW_EXAMPLES_COARSE", "1"))  # tests run examples coarser
# Where the models of Gmsh's documentation are: in Debian's gmsh-doc (packed) or PyPI's wheel.
MODEL_FOLDERS = [os.path.join("/usr/share/doc/gmsh-doc/doc/gmsh", name)
                 for name in ("demos/api", "tutorial")]
MODEL_FOLDERS += [os.path.join(sys.prefix, "share/doc/gmsh", name)
                  for name in ("examples/api", "tutorials")]


def start(name):
    """Starts Gmsh with a new model; only its warnings are shown."""
    os.makedirs(OUT, exist_ok=True)
    gmsh.option.setNumber("General.Verbosity", 2)  # warnings and errors
    version = gmsh.option.getString("General.Version")
    print("\n== %s (Gmsh %s)" % (name, version), flush=True)
    gmsh.model.add(name)


def progress(line):
    """What a size field tells while it works."""
    print("   " + line, flush=True)


def find_model(name):
    """Path of a model of Gmsh's documentation, unpacked."""
    for folder in MODEL_FOLDERS:
        plain = os.path.join(folder, name)
        if os.path.exists(plain):
            return plain
        if os.path.exists(plain + ".gz"):
            unpacked = os.path.join(OUT, name)
            with gzip.open(plain + ".gz") as source, open(unpacked, "wb") as target:
                target.write(source.read())
            return unpacked
    sys.exit("error: %s was not found: install the Debian package gmsh-doc." % name)


def boundary(entities):
    """Boundary of entities, seams included and each once."""
    found = []
    for entity in entities:
        found += gmsh.model.getBoundary([entity], combined=False, oriented=False)
    return sorted(set(found))


def surfaces_of(volumes):
    """Surfaces that bound any of the volumes."""
    return [entity for entity in boundary(volumes) if entity[0] == 2]


def rounded_box(side, radius):
    """A cube about the origin with rounded edges, in OpenCASCADE's kernel."""
    box = gmsh.model.occ.addBox(-side / 2, -side / 2, -side / 2, side, side, side)
    gmsh.model.occ.synchronize()
    edges = [tag for _, tag in boundary(boundary([(3, box)]))]
    return gmsh.model.occ.fillet([box], edges, [radius])[0]


def enclose(shape, corner, opposite):
    """Puts a volume into a box between two corners; returns (inner, outer, common faces)."""
    occ = gmsh.model.occ
    box = occ.addBox(*corner, *(b - a for a, b in zip(corner, opposite)))
    _, (pieces, (inner,)) = occ.fragment([(3, box)], [shape])
    occ.synchronize()
    outer, = set(pieces) - {inner}
    return inner, outer, surfaces_of([inner])


def generate(field, what, dim=3):
    """Meshes with the field and says what and how long."""
    print("-- meshing %s" % what, flush=True)
    begin = time.perf_counter()
    field.generate(dim)
    print("   %.1f s" % (time.perf_counter() - begin), flush=True)


def generate_by_gmsh(dim=3):
    """Gmsh meshes by itself; returns the seconds as a case of the page wants them."""
    begin = time.perf_counter()
    gmsh.model.mesh.generate(dim)
    return {"gmsh": time.perf_counter() - begin, "meshgrow": 0}


def generate_registered(field, dim=3):
    """Gmsh meshes discrete patches anew, with the sizes of the field only; returns the same.

    The sources are read before, from the triangles that Gmsh throws away as it begins.
    """
    begin = time.perf_counter()
    field.refresh()
    field.register()
    reading = time.perf_counter() - begin
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    seconds = generate_by_gmsh(dim)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
    field.unregister()
    return {**seconds, "meshgrow": reading}


def mesh_of(entity):
    """Mesh of an entity and its boundary, to be compared: {node: coordinates} and nodes of elements."""
    nodes, coordinates, _ = gmsh.model.mesh.getNodes(*entity, includeBoundary=True)
    places = dict(zip(nodes.tolist(), zip(*[iter(coordinates.tolist())] * 3)))
    return places, [part.tolist() for part in gmsh.model.mesh.getElements(*entity)[2]]


def write(name):
    """Writes the current mesh, complete or not at all, and returns its path."""
    path = os.path.join(OUT, name)
    beside = os.path.join(OUT, "unfinished-" + name)
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.write(beside)
    os.replace(beside, path)
    return path


def show(rows, files):
    """Prints the report table and where the results are."""
    print("\n" + meshgrow.report_table(rows))
    print("ratio: size of the larger of two neighbours over the smaller; length/size: edge length over "
          "the size asked for\n(median; good: within 1/1.41 … 1.41). gamma and SICN: element quality, "
          "1 is best.")
    show_files(files)


def show_files(files):
    """Prints where the results are."""
    for path in files:
        if path:
            print("   %s" % os.path.relpath(path))
    sys.stdout.flush()
