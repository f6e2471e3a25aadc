"""Random geometry with OpenCASCADE: one to four shapes, put together."""

import math

import gmsh

from meshes import closure

SMALLEST_VOLUME = 0.003  # of all volumes
SHORTEST_CURVE = 0.01  # of the model's size


def choose(draw, weighted):
    """One of (choice, weight)."""
    return draw.choices([c for c, _ in weighted], [w for _, w in weighted])[0]


class ShapeMaker:
    """Draws shapes of about the size `unit` into OpenCASCADE's current model."""

    def __init__(self, draw, unit):
        self.draw = draw
        self.unit = unit
        self.occ = gmsh.model.occ

    def length(self, low, high):
        return self.draw.uniform(low, high) * self.unit

    def box(self):
        sides = [self.length(0.5, 1.4) for _ in range(3)]
        return self.occ.addBox(*(-s / 2 for s in sides), *sides)

    def sphere(self):
        return self.occ.addSphere(0, 0, 0, self.length(0.35, 0.7))

    def cylinder(self):
        height = self.length(0.5, 1.6)
        return self.occ.addCylinder(0, 0, -height / 2, 0, 0, height, self.length(0.25, 0.7))

    def cone(self):
        height = self.length(0.6, 1.5)
        top = self.draw.choice([0.0, self.length(0.15, 0.3)])
        return self.occ.addCone(0, 0, -height / 2, 0, 0, height, self.length(0.4, 0.7), top)

    def torus(self):
        return self.occ.addTorus(0, 0, 0, self.length(0.45, 0.7), self.length(0.15, 0.3))

    def shape(self):
        make = choose(self.draw, [(self.box, 5), (self.sphere, 3), (self.cylinder, 3),
                                  (self.cone, 2), (self.torus, 1)])
        tag = make()
        if self.draw.random() < 0.4:
            axis = [self.draw.gauss(0, 1) for _ in range(3)]
            self.occ.rotate([(3, tag)], 0, 0, 0, *axis, self.draw.uniform(0, math.pi))
        return (3, tag)

    def surround(self, inner):
        """A box or ball around it all, with what is inside as volumes of their own or as holes."""
        half = self.length(1.4, 2.0)
        if self.draw.random() < 0.8:
            outer = self.occ.addBox(-half, -half, -half, 2 * half, 2 * half, 2 * half)
        else:
            outer = self.occ.addSphere(0, 0, 0, half * 1.2)
        hole = self.draw.random() < 0.5
        (self.occ.cut if hole else self.occ.fragment)([(3, outer)], inner)
        return "in a hole" if hole else "surrounded"

    def put_together(self):
        """One to four shapes fragmented, cut or fused; returns in words how."""
        volumes = [self.shape()]
        words = []
        for _ in range(choose(self.draw, [(0, 3), (1, 5), (2, 3), (3, 1)])):
            shape = self.shape()
            self.occ.translate([shape], *(self.length(-0.6, 0.6) for _ in range(3)))
            how = choose(self.draw, [("fragment", 5), ("cut", 2), ("fuse", 3)])
            volumes = [e for e in getattr(self.occ, how)(volumes, [shape])[0] if e[0] == 3]
            words.append(how)
            if not volumes:
                return words
        if self.draw.random() < 0.25:
            words.append(self.surround(volumes))
        return words

    def embed(self):
        """Curves and points through the volumes, embedded where they are inside."""
        tools = []
        for _ in range(self.draw.randint(1, 2)):
            ends = [[self.length(-0.4, 0.4) for _ in range(3)] for _ in range(2)]
            points = [self.occ.addPoint(*end) for end in ends]
            curve = self.draw.random() < 0.5
            tools += [(1, self.occ.addLine(*points))] if curve else [(0, p) for p in points]
        self.occ.fragment(self.occ.getEntities(3), tools)


def model_size():
    ends = gmsh.model.getBoundingBox(-1, -1)
    return math.dist(ends[:3], ends[3:])


def middle_of_model():
    ends = gmsh.model.getBoundingBox(-1, -1)
    return [(a + b) / 2 for a, b in zip(ends, ends[3:])]


def has_length(curve):
    return gmsh.model.occ.getMass(*curve) > 1e-9 * model_size()


def is_smooth():
    """No tiny part and not too many of them."""
    occ = gmsh.model.occ
    masses = [occ.getMass(*v) for v in gmsh.model.getEntities(3)]
    lengths = [occ.getMass(*c) for c in gmsh.model.getEntities(1) if has_length(c)]
    return (min(masses) > SMALLEST_VOLUME * sum(masses) and len(gmsh.model.getEntities(2)) <= 30
            and min(lengths, default=math.inf) > SHORTEST_CURVE * model_size())


def make_shapes(draw):
    """The geometry of a model, in the current Gmsh session; returns it in words.

    Combinations that OpenCASCADE cannot make are drawn again, and most of those with tiny parts.
    """
    while True:
        gmsh.model.add("soak")
        maker = ShapeMaker(draw, 10 ** draw.uniform(-2, 2))
        try:
            words = maker.put_together()
            if draw.random() < 0.15 and gmsh.model.occ.getEntities(3):
                maker.embed()
                words.append("embedded")
            gmsh.model.occ.synchronize()
        except Exception:  # Gmsh's, with OpenCASCADE's reason
            words = []
        rough = draw.random() < 0.05
        volumes = gmsh.model.getEntities(3)
        if volumes and (rough or is_smooth()):
            faces = [e for e in closure(volumes) if e[0] == 2]
            return "%d volumes, %d faces: %s" % (len(volumes), len(faces),
                                                 ", ".join(words) or "alone")
        gmsh.model.remove()
