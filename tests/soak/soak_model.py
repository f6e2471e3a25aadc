"""A random model that its seed determines."""

import random

import gmsh
import meshgrow

import random_meshes
from random_functions import FunctionMaker, draw_settings
from random_shapes import make_shapes
from meshes import has_elements, options


class GmshFailure(Exception):
    """Gmsh could not do something before the library came into play."""


class SoakModel:
    """Built in the current Gmsh session, with its meshes that are there beforehand."""

    def __init__(self, seed):
        # One after the other, so that a change in one does not draw all others anew.
        draws = {part: random.Random("%d %s" % (seed, part))
                 for part in ("shapes", "meshes", "functions", "settings")}
        self.words = [make_shapes(draws["shapes"])]
        self.field_options, self.gmsh_options = draw_settings(draws["settings"])
        self.premesh = random_meshes.plan_premesh(draws["meshes"])
        self.functions = FunctionMaker(draws["functions"], self.premesh).functions()
        if self.premesh:
            self.words.append("meshed before: %s %s" % self.premesh[:2])
        self.words += self.functions
        self.words.append("%s %s" % (self.gmsh_options, self.field_options))

    def set_options(self):
        for name, value in self.gmsh_options.items():
            gmsh.option.setNumber(name, value)

    def mesh_beforehand(self):
        if not self.premesh:
            return
        try:
            random_meshes.carry_out(self.premesh)
        except Exception as error:
            raise GmshFailure(str(error)) from error

    def make_field(self):
        field = meshgrow.SizeField(**self.field_options)
        for text in self.functions:
            field.add(text)
        return field

    def limit(self):
        return min(float(text.split(" limit ")[1]) for text in self.functions)

    def generate_by_callback(self, factor):
        """In Gmsh's own order, with the sizes of the field times a factor, and no others."""
        field = self.make_field()
        field.refresh()
        limit = self.limit()
        with options(Mesh_MeshSizeExtendFromBoundary=0):
            self._generate(lambda dim, tag, x, y, z: factor * field(dim, tag, x, y, z, limit))

    def generate_without(self, factor):
        """By plain Gmsh, with sizes alike."""
        size = factor * self.limit()
        self._generate(lambda *_: size)

    def _generate(self, size_at):
        """What was meshed beforehand has its sizes of then, as Gmsh throws meshes away."""
        known = {e for e in gmsh.model.getEntities() if has_elements(e)}
        known_size = self.premesh[2] if self.premesh else None

        def callback(dim, tag, x, y, z, *lc):
            size = known_size(x, y, z) if (dim, tag) in known else size_at(dim, tag, x, y, z)
            return min((size, *lc))  # not above Gmsh's own, as from curvature
        gmsh.model.mesh.setSizeCallback(callback)
        try:
            gmsh.model.mesh.generate(3)
        finally:
            gmsh.model.mesh.removeSizeCallback()
