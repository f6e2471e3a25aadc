"""Random size functions of all four kinds on a model, and Gmsh's algorithms for it."""

import math

import gmsh

from meshes import closure
from random_meshes import curves_of, face_size
from random_shapes import choose, has_length, middle_of_model, model_size

ALGORITHMS_2D = [(6, 5), (5, 2), (1, 2), (2, 1)]
ALGORITHMS_3D = [(1, 3), (10, 1)]


def entity_text(entities):
    names = ("Point", "Curve", "Surface", "Volume")
    return " ".join("%s{%s}" % (names[dim], ",".join(str(t) for d, t in entities if d == dim))
                    for dim in range(4) if any(d == dim for d, _ in entities))


def some(draw, entities, most):
    return sorted(draw.sample(entities, min(len(entities), draw.randint(1, most))))


class FunctionMaker:
    """Draws size functions as lines of text."""

    def __init__(self, draw, premesh):
        self.draw = draw
        _, self.premeshed, size = premesh or ("", [], None)
        self.premeshed_size = size(*middle_of_model()) / 2 if size else None
        self.size = model_size()
        self.volumes = gmsh.model.getEntities(3)
        self.smallest = self.size * 0.04  # that curvature and proximity ask for
        self.faces = [e for e in closure(self.volumes) if e[0] == 2]
        self.grown_from_later = False

    def attachments(self, sources, only_volumes):
        free = [v for v in self.volumes if v not in self.premeshed] or self.volumes
        kind = self.draw.random() * (0.85 if only_volumes else 1)
        if kind < 0.65:
            return free
        if kind < 0.85:
            return some(self.draw, free, len(free))
        if kind < 0.95:
            return some(self.draw, [f for f in self.faces if f not in sources] or free, 3)
        return some(self.draw, [c for c in curves_of(self.volumes) if c not in sources] or free, 3)

    def growth(self, start):
        """Growth rate, not too slow for small elements from the smallest size on, and limit."""
        slope = max(1 - 1 / self.draw.uniform(1.05, 1.5), 0.16 - 2 * start / self.size)
        return "growth %.4g limit %.4g" % (1 / (1 - slope),
                                           self.size * math.exp(self.draw.uniform(-2.5, -1.3)))

    def mesh(self):
        sources = sorted(e for e in closure(self.premeshed) if e[0] == min(2, self.premeshed[0][0])
                         and (e[0] == 2 or has_length(e))) if self.premeshed else []
        if not sources:
            # Two functions that grow from what is meshed later could wait for each other.
            if self.grown_from_later:
                return self.fixed()
            self.grown_from_later = True
            return some(self.draw, self.faces, 2), self.smallest, "mesh source %s"
        return sources, self.premeshed_size, "mesh source %s"

    def fixed(self):
        dim = choose(self.draw, [(0, 2), (1, 3), (2, 4), (3, 1)])
        if dim == 3:
            sources = [self.draw.choice(self.volumes)]
            count = self.draw.randint(300, 2000)
            size = (10 * gmsh.model.occ.getMass(*sources[0]) / count) ** (1 / 3)
        elif dim == 2:
            sources = some(self.draw, self.faces, 2)
            size = face_size(sources, self.draw.randint(40, 300))
        else:
            of_dim = [e for e in closure(self.volumes) if e[0] == dim
                      and (dim == 0 or has_length(e))]
            sources = some(self.draw, of_dim, 3) if of_dim else some(self.draw, self.faces, 1)
            size = self.size * math.exp(self.draw.uniform(-4.0, -2.5))
        return sources, size, "fixed source %%s size %.4g" % size

    def wide_sources(self):
        return self.volumes if self.draw.random() < 0.5 else some(self.draw, self.faces, 3)

    def curvature(self):
        return self.wide_sources(), self.smallest, "curvature source %%s angle %.4g min %.4g" % (
            self.draw.uniform(12, 45), self.smallest)

    def proximity(self):
        return self.volumes, self.smallest, "proximity source %%s cells %.4g min %.4g" % (
            self.draw.uniform(1, 4), self.smallest)

    def function(self, first):
        kinds = [(self.mesh, 4), (self.fixed, 3), (self.curvature, 2), (self.proximity, 2)]
        make = self.mesh if first and self.premeshed else choose(self.draw, kinds)
        sources, smallest, text = make()
        attach = self.attachments(sources, make == self.proximity)
        return "%s attach %s %s" % (text % entity_text(sources), entity_text(attach),
                                    self.growth(smallest))

    def functions(self):
        return [self.function(i == 0) for i in range(choose(self.draw, [(1, 4), (2, 4), (3, 2)]))]


def draw_settings(draw):
    """Options of the field and of Gmsh."""
    field = {"evaluator": draw.choice(["auto", "auto", "grid", "exact"]),
             "calibrate": draw.random() < 0.2, "tolerance": draw.choice([0.05, 0.1]), "threads": 1}
    gmsh_options = {"Mesh.Algorithm": choose(draw, ALGORITHMS_2D),
                    "Mesh.Algorithm3D": choose(draw, ALGORITHMS_3D)}
    if draw.random() < 0.1:
        gmsh_options["Mesh.MeshSizeFromCurvature"] = 10
    if draw.random() < 0.1:
        gmsh_options["Mesh.MeshSizeFactor"] = draw.uniform(0.8, 1.2)
    return field, gmsh_options
