# SPDX-License-Identifier: BSD-3-Clause
"""The obstacles of a run as triangles, and where they are at a time."""
import numpy

BACK, FRONT = 0.45, 0.10  # opacity behind the body, and in front of it


def directions(up):
    """Forward, to the right and upwards on a picture, on which `up` is up: seen from the front, a little from the right and above."""
    up = numpy.array(up) / numpy.linalg.norm(up)
    east = numpy.array([1.0, 0, 0] if abs(up[0]) < 0.9 else [0, 1.0, 0])
    east = (east - east @ up * up) / numpy.linalg.norm(east - east @ up * up)
    forward = -0.28 * east + 0.88 * numpy.cross(up, east) - 0.38 * up
    forward /= numpy.linalg.norm(forward)
    right = numpy.cross(forward, up) / numpy.linalg.norm(numpy.cross(forward, up))
    return forward, right, numpy.cross(right, forward)


def patch(function, u, v):
    """A grid of points function(u, v) as points and triangles."""
    grid_u, grid_v = numpy.meshgrid(u, v, indexing="ij")
    points = numpy.stack(function(grid_u, grid_v), axis=-1).reshape(-1, 3)
    index = numpy.arange(len(u) * len(v)).reshape(len(u), len(v))
    a, b, c, d = index[:-1, :-1].ravel(), index[1:, :-1].ravel(), index[1:, 1:].ravel(), index[:-1, 1:].ravel()
    return points, numpy.concatenate([numpy.stack([a, b, c], 1), numpy.stack([a, c, d], 1)])


def on_sphere(centre, radius):
    return lambda polar, around: (
        centre[0] + radius * numpy.sin(polar) * numpy.cos(around),
        centre[1] + radius * numpy.sin(polar) * numpy.sin(around),
        centre[2] - radius * numpy.cos(polar),
    )


def bowl(shape, forward):
    """The half behind its centre, and the transparent half in front of it."""
    steepest = numpy.arccos(1 - shape["rim"] / shape["radius"])
    polar, facing = numpy.linspace(0, steepest, 40), numpy.arctan2(forward[1], forward[0])
    half = numpy.linspace(-numpy.pi / 2, numpy.pi / 2, 80)
    surface = on_sphere(shape["centre"], shape["radius"])
    return [(*patch(surface, polar, facing + half), BACK), (*patch(surface, polar, facing + half + numpy.pi), FRONT)]


def sphere(shape):
    surface = on_sphere(shape["centre"], shape["radius"])
    return [(*patch(surface, numpy.linspace(0, numpy.pi, 60), numpy.linspace(0, 2 * numpy.pi, 120)), BACK)]


def plane(shape, low, high):
    """A square part of the plane, wide enough for the body."""
    normal = numpy.array(shape["normal"]) / numpy.linalg.norm(shape["normal"])
    along = numpy.cross(normal, [1, 0, 0] if abs(normal[0]) < 0.9 else [0, 1, 0])
    along /= numpy.linalg.norm(along)
    across = numpy.cross(normal, along)
    middle = (low + high) / 2
    middle = middle - normal * (normal @ (middle - shape["point"]))
    half = 0.7 * numpy.linalg.norm(high - low)
    size = numpy.array([-half, half])
    points = lambda s, t: numpy.moveaxis(middle + s[..., None] * along + t[..., None] * across, -1, 0)
    return [(*patch(points, size, size), BACK)]


def round_solid(shape, profile):
    """Turns a profile of (along the axis, radius) about the axis from one end to the other."""
    start, end = numpy.array(shape["from"]), numpy.array(shape["to"])
    length = numpy.linalg.norm(end - start)
    axis = (end - start) / length
    side = numpy.cross(axis, [1, 0, 0] if abs(axis[0]) < 0.9 else [0, 1, 0])
    side /= numpy.linalg.norm(side)
    other = numpy.cross(axis, side)
    along, radius = profile(length, shape["radius"])

    def points(i, around):
        a, r = along[i.astype(int)][..., None], radius[i.astype(int)][..., None]
        ring = numpy.cos(around)[..., None] * side + numpy.sin(around)[..., None] * other
        return numpy.moveaxis(start + a * axis + r * ring, -1, 0)

    return [(*patch(points, numpy.arange(len(along)), numpy.linspace(0, 2 * numpy.pi, 60)), BACK)]


def capsule(shape):
    def profile(length, radius):
        turn = numpy.linspace(0, numpy.pi / 2, 16)
        return (numpy.concatenate([-radius * numpy.cos(turn), length + radius * numpy.sin(turn)]),
                numpy.concatenate([radius * numpy.sin(turn), radius * numpy.cos(turn)]))
    return round_solid(shape, profile)


def cylinder(shape):
    return round_solid(shape, lambda length, radius: (numpy.array([0, 0, length, length]),
                                                      numpy.array([0, radius, radius, 0])))


def cone(shape):
    return round_solid(shape, lambda length, radius: (numpy.array([0, 0, length, length]),
                                                      numpy.array([0, radius, shape["to_radius"], 0])))


def turned(points, rotation):
    """About the origin by a vector that is an axis times an angle (Rodrigues)."""
    angle = numpy.linalg.norm(rotation)
    if angle == 0:
        return points
    k = rotation / angle
    return (points * numpy.cos(angle) + numpy.cross(k, points) * numpy.sin(angle)
            + numpy.outer(points @ k, k) * (1 - numpy.cos(angle)))


def box(shape):
    corners = numpy.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * shape["size"]
    corners = turned(corners, numpy.array(shape["rotation"]))
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return [(corners + shape["centre"], numpy.array(triangles), BACK)]


def surface(shape):
    """A triangulated surface is drawn as its bounding box, which is all that a run keeps of it."""
    low, high = numpy.array(shape["min"]), numpy.array(shape["max"])
    return box({"centre": (low + high) / 2, "size": high - low, "rotation": [0, 0, 0]})


SHAPES = {"sphere": sphere, "capsule": capsule, "cylinder": cylinder, "cone": cone, "box": box, "surface": surface}


def course(entry, steady, value):
    """What a motion or a turn has got to, as a function of time [s]: its keys at one rate, and along a path."""
    if "path" in entry:
        times = [knot["time"] for knot in entry["path"]]
        places = numpy.array([knot[value] for knot in entry["path"]]).reshape(len(times), -1)
        return lambda t: numpy.array([numpy.interp(t, times, column) for column in places.T])
    if "sine" in entry:
        sine = entry["sine"]
        swing = lambda t: numpy.sin(2 * numpy.pi * sine["frequency"] * t + sine["phase"]) - numpy.sin(sine["phase"])
        return lambda t: numpy.array(sine["amplitude"]) * swing(t)
    return lambda t: numpy.array(entry.get(steady, 0)) * t


def motion(entry):
    """Where points at rest are as a function of them and of time [s]."""
    way = course(entry, "velocity", "displacement")
    if "turn" not in entry:
        return lambda points, t: points + way(t)
    turn = entry["turn"]
    axis, about = numpy.array(turn["axis"]), numpy.array(turn["about"])
    angle, before = course(turn, "angular_velocity", "angle"), numpy.array(turn["rotation"])
    return lambda points, t: about + way(t) + turned(turned(points - about, before), angle(t) * axis)


def obstacles(run):
    """Those of the run, as (points at rest, triangles, opacity, places of points at a time)."""
    low, high = run.points.min(axis=(0, 1)), run.points.max(axis=(0, 1))
    known = {**SHAPES, "bowl": lambda shape: bowl(shape, directions(run.up)[0]), "plane": lambda shape: plane(shape, low, high)}
    shapes = []
    for entry in run.summary.get("obstacles", []):
        for name, draw in known.items():
            if name in entry:
                shapes += [(*part, motion(entry)) for part in draw(entry[name])]
    return shapes
