"""Sizes by brute force, from the definition: the smallest of S0 + (1 - 1/g) * distance."""

import numpy as np

CHUNK = 200


def segment_distances(points, a, b):
    """Distances (points, segments)."""
    ab = b - a
    length2 = np.maximum((ab**2).sum(axis=1), 1e-300)
    t = ((points[:, None] - a[None]) * ab[None]).sum(axis=2) / length2
    nearest = a[None] + np.clip(t, 0, 1)[..., None] * ab[None]
    return np.linalg.norm(points[:, None] - nearest, axis=2)


def triangle_distances(points, a, b, c):
    """Distances (points, triangles): to the plane over the inside, elsewhere to a side."""
    sides = np.minimum(segment_distances(points, a, b), segment_distances(points, b, c))
    sides = np.minimum(sides, segment_distances(points, c, a))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    above = np.ones(sides.shape, dtype=bool)
    for p, q in ((a, b), (b, c), (c, a)):
        inward = np.cross(normal, q - p)
        above &= ((points[:, None] - p[None]) * inward[None]).sum(axis=2) >= 0
    plane = np.abs(((points[:, None] - a[None]) * normal[None]).sum(axis=2))
    return np.where(above, plane, sides)


def norm(v):
    return np.linalg.norm(v, axis=-1)


class Facets:
    """Facets with start sizes: `corners` (n, 2 or 3, 3) and `start` (n,)."""

    def __init__(self, corners, start):
        self.corners = np.asarray(corners, dtype=float)
        self.start = np.asarray(start, dtype=float)

    def sizes(self, points, growth_rate, limit):
        points = np.asarray(points, dtype=float)
        result = np.full(len(points), float(limit))
        slope = 1.0 - 1.0 / growth_rate
        vertices = [self.corners[:, i] for i in range(self.corners.shape[1])]
        distances = segment_distances if len(vertices) == 2 else triangle_distances
        for first in range(0, len(points), CHUNK):
            some = slice(first, first + CHUNK)
            grown = self.start + slope * distances(points[some], *vertices)
            result[some] = np.minimum(result[some], grown.min(axis=1))
        return result


def segments(corners):
    corners = np.asarray(corners, dtype=float)
    return Facets(corners, norm(corners[:, 1] - corners[:, 0]))


def triangles(corners):
    corners = np.asarray(corners, dtype=float)
    return Facets(corners, norm(corners - np.roll(corners, 1, axis=1)).mean(axis=1))


def quads_as_triangles(corners):
    """Each quadrilateral by its two triangles along the diagonal from corner 0 to corner 2."""
    corners = np.asarray(corners, dtype=float)
    return triangles(np.concatenate((corners[:, [0, 1, 2]], corners[:, [0, 2, 3]])))


def quads_by_sides(corners):
    """The same triangles, both with the mean of the quadrilateral's four sides."""
    corners = np.asarray(corners, dtype=float)
    start = norm(corners - np.roll(corners, 1, axis=1)).mean(axis=1)
    halves = np.concatenate((corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]))
    return Facets(halves, np.concatenate((start, start)))


def sizes(facets, points, growth_rate, limit):
    """Minimum over several Facets."""
    return np.min([f.sizes(points, growth_rate, limit) for f in facets], axis=0)


def curvature_size(curvature, angle):
    """Chord of `angle` degrees of a circle of this curvature."""
    return 2 * np.sin(np.radians(angle) / 2) / curvature


def gap_size(gap, cells, growth_rate):
    """Start size on both sides of a gap so that the integral of 1 / size across it is `cells`,
    found by bisection of the numerical integral."""
    slope = 1 - 1 / growth_rate
    middles = (np.arange(2000) + 0.5) / 2000 * gap
    low, high = 1e-9 * gap, gap / cells
    for _ in range(60):
        start = 0.5 * (low + high)
        count = (gap / 2000 / (start + slope * np.minimum(middles, gap - middles))).sum()
        low, high = (start, high) if count > cells else (low, start)
    return start
