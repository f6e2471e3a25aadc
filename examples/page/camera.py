"""One camera for all meshes of a picture: direction, middle and width of what it sees."""

import math

import numpy as np

from errors import RenderError

# Blank border around the mesh, as a fraction of its extent on the screen.
FIT_MARGIN = 0.02


def rotation_from_angles(degrees):
    """Return the matrix of Gmsh's General.RotationX, RotationY, RotationZ."""
    x, y, z = np.radians(degrees)
    about_x = np.array([[1, 0, 0], [0, math.cos(x), -math.sin(x)],
                        [0, math.sin(x), math.cos(x)]])
    about_y = np.array([[math.cos(y), 0, math.sin(y)], [0, 1, 0],
                        [-math.sin(y), 0, math.cos(y)]])
    about_z = np.array([[math.cos(z), -math.sin(z), 0],
                        [math.sin(z), math.cos(z), 0], [0, 0, 1]])
    return about_x @ about_y @ about_z


def angles_from_rotation(matrix):
    """Return General.RotationX, RotationY, RotationZ in degrees."""
    y = math.asin(max(-1.0, min(1.0, matrix[0, 2])))
    if math.cos(y) > 1e-6:
        x = math.atan2(-matrix[1, 2], matrix[2, 2])
        z = math.atan2(-matrix[0, 1], matrix[0, 0])
    else:  # looking along x: only the sum of the two angles matters
        x = math.atan2(matrix[2, 1], matrix[1, 1])
        z = 0.0
    return [math.degrees(angle) for angle in (x, y, z)]


def look_from(direction, up):
    """Return the rotation for a camera in this direction from the mesh.

    The rows are the axes of the screen: to the right, up, to the viewer.
    """
    toward = direction / np.linalg.norm(direction)
    right = np.cross(up, toward)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(toward, right), toward])


def choose_rotation(view, plane):
    """Return the rotation matrix of the camera."""
    if view not in ("front", "iso"):
        return rotation_from_angles(view)
    normal = np.array(plane[3:] if plane else [0.0, -1.0, 0.0])
    z_axis = np.array([0.0, 0.0, 1.0])
    # z is up on the screen, unless the camera looks along z.
    horizontal = abs(normal[2]) > 0.99
    front = look_from(normal, np.array([0.0, 1.0, 0.0]) if horizontal
                      else z_axis)
    if view == "front":
        return front
    right, up = front[0], front[1]
    # From above seen across the cut; a horizontal cut is seen from its near
    # edge, so that z points up on the screen.
    lift = -0.8 * up if horizontal else 0.4 * up
    return look_from(normal + 0.5 * right + lift, z_axis)


def kept_points(mesh, plane):
    """Return the corners of the elements that the cut leaves, (n, 3).

    Gmsh takes an element away if all its corners are beyond the plane.
    """
    kept = []
    for xyz in mesh.corners:
        if plane:
            distance = (xyz - plane[:3]) @ np.array(plane[3:])
            xyz = xyz[distance.min(axis=1) <= 0]
        kept.append(xyz.reshape(-1, 3))
    return np.concatenate(kept)


def choose_camera(meshes, options):
    """Return one camera for all meshes.

    angles:     rotation in degrees
    center:     point in the middle of the picture, in mesh coordinates
    half_width: half the side of the picture, in the unit of the mesh
    reach:      distance of the farthest drawn point from the center, likewise
    """
    rotation = choose_rotation(options.view, options.plane)
    points = np.concatenate(
        [kept_points(mesh, options.plane) for mesh in meshes])
    if not len(points):
        raise RenderError("the cut leaves no elements; move the plane or "
                          "turn its normal around.")
    if options.focus:
        center = np.array(options.focus[:3])
        half_width = options.focus[3]
    else:
        on_screen = points @ rotation.T
        low, high = on_screen.min(axis=0), on_screen.max(axis=0)
        center = rotation.T @ ((low + high) / 2)
        half_width = (1 + FIT_MARGIN) * max(high[:2] - low[:2]) / 2
    reach = np.linalg.norm(points - center, axis=1).max()
    return {"angles": angles_from_rotation(rotation),
            "center": center.tolist(),
            "half_width": float(half_width / options.zoom),
            "reach": float(reach)}
