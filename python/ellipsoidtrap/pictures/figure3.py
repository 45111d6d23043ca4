# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The model of the cell drawn: frames, Euler angles, beads, and one cell at discrete times
with its velocity and angular velocity; the paper's Figure 3. --cell is as in figure2."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

from . import account
from . import bodies
from . import poses
from . import style
from .case import MICRO
from .figure2 import RESTING, cell_or_best, find

# A view and a pose in which no two axes fall together
VIEW = bodies.camera(70, 30)
POSE = np.radians((50, 35, 65))   # phi, theta, psi of the drawings
POSES = 7        # in the sequence
SPAN = 24.0      # length of path that the sequence follows, in micrometres
WAY = np.linspace(0, 1, 12)[:, None]   # along what a name must keep clear of
AHEAD, BEHIND = style.ORANGE, style.YELLOW
BODY, MOTION, LAB = style.BLUE, "0.35", "black"

OPTIONS = {
    "cell": {
        "type": cell_or_best, "metavar": "ID", "help": "of panel D: its id in cells.csv, or best"
    },
}


def flat(*points):
    """Points of space in the plane of the drawings."""
    return (np.array(points) @ VIEW.T)[:, :2]


def arrow(ax, start, end, text, color, dashes="-", width=1.3, view=VIEW, size=9):
    """An arrow in space with its name at the tip."""
    (x0, y0), (x1, y1) = (np.array((start, end)) @ view.T)[:, :2]
    ax.annotate("", (x1, y1), (x0, y0), annotation_clip=False, arrowprops={
        "arrowstyle": "-|>", "color": color, "linewidth": width, "linestyle": dashes,
        "shrinkA": 0, "shrinkB": 0,
    })
    away = np.array((x1 - x0, y1 - y0)) / max(np.hypot(x1 - x0, y1 - y0), 1e-9)
    ax.annotate(text, (x1, y1), 8 * away, textcoords="offset points", ha="center", va="center",
                color=color, fontsize=size, annotation_clip=False)


def triad(ax, origin, axes, names, color, length, dashes="-"):
    """Three axes, the columns of a matrix."""
    for axis, name in zip(axes.T, names):
        arrow(ax, origin, origin + length * axis, name, color, dashes)


def arc(ax, start, end, radius, text, at=20):
    """Arc about the origin between two unit vectors of 40 points, named beside one of them."""
    angle = np.arccos(np.clip(start @ end, -1, 1))
    side = (end - start * (start @ end)) / np.sin(angle)
    a = np.linspace(0, angle, 40)[:, None]
    line = radius * (np.cos(a) * start + np.sin(a) * side)
    ax.plot(*flat(*line).T, color="black", linewidth=1.2)
    arrow(ax, line[-4], line[-1], "", "black", width=1.2)
    place = flat(line[at])[0]
    ax.annotate(text, place, 11 * place / np.linalg.norm(place), textcoords="offset points",
                ha="center", va="center", fontsize=11)


def bare(ax, xlim, ylim, title):
    """Axes without axes."""
    ax.set_aspect("equal")
    ax.set_xlim(xlim)
    ax.set_ylim(ylim)
    ax.set_axis_off()
    ax.set_title(title, loc="left")


def numbered(symbol):
    """Names of three axes."""
    return [f"${symbol}_{i}$" for i in (1, 2, 3)]


def draw_frames(ax, semi_axes, scale, along):
    """Lab, motion and body frame."""
    bare(ax, (-3.2, 8.4), (-2.4, 6.4), "A  frames: lab, motion and body")
    q, centre = poses.quaternion_from_euler(*POSE), np.array((-4.2, 2.6, 3.0))
    bodies.show(ax, [bodies.Body(centre, q, semi_axes, AHEAD, BEHIND)], VIEW, scale, zorder=0)
    triad(ax, np.zeros(3), np.eye(3), numbered("x"), LAB, 2.6)
    triad(ax, centre, np.eye(3), numbered(r"\tilde{x}"), MOTION, 2.7, (0, (4, 2)))
    triad(ax, centre, poses.rotation(q), numbered(r"\hat{x}"), BODY, 2.9)
    arrow(ax, np.zeros(3), centre, "", style.VERMILLION)
    ax.annotate("x", flat(0.5 * centre)[0] + (0.1, -0.6), color=style.VERMILLION)
    flow = "" if along is None else f"flow along $x_{along + 1}$; "
    ax.annotate(f"{flow}motion frame: parallel to the lab's,\n"
                "moves with the cell; O is the unit vector of $\\hat{x}_2$",
                (0, 0), xycoords="axes fraction", fontsize=7.5, va="top")


def draw_angles(ax):
    """Euler's angles, z-x-z."""
    bare(ax, (-1.35, 1.75), (-1.2, 1.35), "B  Euler angles φ, θ, ψ (z-x-z)")
    phi, theta, psi = POSE
    lab, body = np.eye(3), poses.rotation(poses.quaternion_from_euler(*POSE))
    node = np.array((np.cos(phi), np.sin(phi), 0))
    circle = np.linspace(0, 2 * np.pi, 181)[:, None]
    for x, y, colour in ((lab[:, 0], lab[:, 1], MOTION), (body[:, 0], body[:, 1], BODY)):
        disc = flat(*(np.cos(circle) * x + np.sin(circle) * y))
        ax.fill(*disc.T, color=colour, alpha=0.12, linewidth=0)
        ax.plot(*disc.T, color=colour, linewidth=0.7)
    triad(ax, np.zeros(3), lab, numbered(r"\tilde{x}"), MOTION, 1.3, (0, (4, 2)))
    triad(ax, np.zeros(3), body, numbered(r"\hat{x}"), BODY, 1.3)
    ax.plot(*flat(-1.15 * node, 1.15 * node).T, color=style.VERMILLION, linewidth=1)
    arrow(ax, np.zeros(3), 1.2 * node, "N", style.VERMILLION)
    arc(ax, lab[:, 0], node, 0.55, "φ")
    arc(ax, lab[:, 2], body[:, 2], 0.7, "θ")
    arc(ax, node, body[:, 0], 0.8, "ψ", at=28)
    ax.annotate("N, the line of nodes: where the planes $\\tilde{x}_1\\tilde{x}_2$ and "
                "$\\hat{x}_1\\hat{x}_2$ meet;\nR = $R_3$(φ) $R_1$(θ) $R_3$(ψ)",
                (0, 0), xycoords="axes fraction", fontsize=7.5, va="top")


def contact_of(case):
    """Layout, number and radius [µm] of the beads; none where the ellipsoid itself touches."""
    contact = case.properties.get("contact", {})
    if contact.get("shape", "beads") == "ellipsoid":
        return None
    layout = contact.get("beadLayout", "staggered")
    count = int(case.number(32, "contact", "beads"))
    # As the solver has it for cells that are thinner than its default
    shortest = case.semi_axes.min() / MICRO
    default = 0.285e-6 if shortest > 0.285e-6 else 0.57 * shortest
    return layout, count, case.number(default, "contact", "beadRadius") * MICRO


def draw_surface(ax, case, scale):
    """What stands for the surface in contact: the beads, or the ellipsoid."""
    beads = contact_of(case)
    a1, a2, _ = case.semi_axes
    reach = 1.15 * max(a2, a1)
    name = f"C  the {'median ' * bool(case.sizes)}cell" + " and its beads" * bool(beads)
    bare(ax, (-1.25 * reach, 1.25 * reach), (min(-0.8 * reach, -3.3 * a1), max(0.8 * reach, 1.9 * a1)), name)
    lie = np.array((np.sin(np.pi / 4) * np.array((0, 0, -1))).tolist() + [np.cos(np.pi / 4)])
    if beads:
        layout, count, radius = beads
        centres = poses.beads(layout, count, radius, case.semi_axes)
        turn = poses.rotation(lie)
        shown = [bodies.Body(turn @ centre, lie, np.full(3, radius), style.SKY, style.SKY)
                 for centre in centres]
        told = (f"{len(centres)} beads of radius {radius:g} µm, layout {layout}; "
                "the line is the ellipsoid")
    else:
        shown = [bodies.Body(np.zeros(3), lie, case.semi_axes, style.SKY, style.SKY)]
        told = "in contact is the ellipsoid itself"
    bodies.show(ax, shown, bodies.FROM_ABOVE, scale)
    angle = np.linspace(0, 2 * np.pi, 181)
    ax.plot(a2 * np.cos(angle), a1 * np.sin(angle), color=style.VERMILLION, linewidth=1.3)
    for (x0, y0), (x1, y1), text, at in (
        ((0, -2.2 * a1), (a2, -2.2 * a1), f"b = {a2:g} µm", (a2 / 2, -2.9 * a1)),
        ((-1.05 * a2, 0), (-1.05 * a2, a1), f"a = {a1:g} µm", (-1.05 * a2, 1.5 * a1)),
    ):
        ax.annotate("", (x1, y1), (x0, y0), arrowprops={
            "arrowstyle": "<->", "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0})
        ax.annotate(text, at, ha="center", va="center", fontsize=8)
    ax.annotate(told, (0, 0), xycoords="axes fraction", fontsize=7.5, va="top")


def sequence(case, cell):
    """Poses at equal distances of the way past the sieve or, where the account does not
    fit, of its end; of a cell that stays where it is at equal angles of half a turn, side by
    side. Also whether they are so."""
    found = account.of_cell(case, cell)
    track = case.tracks[cell].finer(10)
    length = track.travelled
    total = min(SPAN, length[-1])
    longest = case.semi_axes_of(cell).max()
    if total < 2 * longest:
        angle = track.turned
        shown = track.at(np.interp(np.linspace(0, min(np.pi, angle[-1]), POSES), angle, track.t))
        shown.x[:, 0] += 2.3 * longest * (np.arange(POSES) - POSES // 2)
        return shown, True
    middle = length[np.searchsorted(track.t, found.flip)] if found else length[-1] - total / 2
    start = np.clip(middle - total / 2, 0, length[-1] - total)
    return track.at(np.interp(start + np.linspace(0, total, POSES), length, track.t)), False


def name_times(ax, places, times, taken, width):
    """The times [ms] beside places, each where nothing else is: no wall, body, arrow or name."""
    # A panel is about so wide, and a name so long and high
    points = 260 / width
    half = np.array((14, 6)) / points
    boxes = []
    for place, time in zip(places, times):
        def crowd(at):
            inside = (np.abs(taken - at) < half).all(axis=1).sum()
            others = sum(bool((np.abs(box - at) < 2 * half).all()) for box in boxes)
            far = np.linalg.norm(at - places, axis=1)
            own = np.linalg.norm(at - place)
            # A name is taken for that of the nearest place
            # Nor does it run into the title
            above = at[1] + half[1] > ax.get_ylim()[1]
            return inside + 10 * (others + above) + 4 * np.sum(far < 1.2 * own) + 0.05 * own

        angles = np.arange(16) * np.pi / 8
        around = [
            place + r * np.array((np.cos(a), np.sin(a))) / points for r in (24, 34, 46, 60)
            for a in angles
        ]
        at = min(around, key=crowd)
        boxes.append(at)
        ax.annotate(
            f"{time:.1f}", place, at, ha="center", va="center", fontsize=7.5,
            path_effects=style.framed("white", 2), annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": "0.6", "linewidth": 0.5, "shrinkA": 2,
                        "shrinkB": 4}, zorder=0.5,
        )


def scale_bar(ax, length=5.0):
    """A bar along x, which the view does not foreshorten, in the corner below to the right."""
    (x0, right), edge = ax.get_xlim(), ax.get_ylim()[0]
    left, low = right - length - 0.5, edge + 1
    # Walls may run below it
    ax.add_patch(Rectangle((x0, edge), right - x0, 2.6, facecolor="white", edgecolor="none", zorder=2))
    ax.plot((left, left + length), (low, low), color="black", linewidth=2.5, solid_capstyle="butt",
            path_effects=style.framed("white", 10), zorder=3)
    ax.annotate(f"{length:g} µm along $x_1$", (left + length / 2, low), (0, 7),
                textcoords="offset points", ha="center", fontsize=7.5,
                path_effects=style.framed("white", 4))


def draw_sequence(ax, case, cell, scale):
    """The cell at discrete times, seen from above at an angle."""
    view = bodies.camera(-90, 55)
    shown, apart = sequence(case, cell)
    semi_axes = case.semi_axes_of(cell)
    height = shown.x[:, 2].mean()
    seen = (shown.x @ view.T)[:, :2]
    pad = 2.2 * semi_axes.max()
    low, high = seen.min(axis=0) - pad * (1 + apart), seen.max(axis=0) + pad * (1 + apart)
    # Wide enough for the names of the times
    low[0], high[0] = min(low[0], seen[:, 0].mean() - 14), max(high[0], seen[:, 0].mean() + 14)
    # and for the bar
    low[1] -= 3
    taken = []
    bare(ax, (low[0], high[0]), (low[1], high[1]),
         f"D  cell {cell} at discrete times (ms since injection)")
    for name, lines in case.plane.outlines.items():
        if case.patches[name] == "wall" and not apart:
            ends = (np.dstack((lines, np.full(lines.shape[:2], height))) @ view.T)[:, :, :2]
            ax.add_collection(LineCollection(ends, colors="black", linewidths=1.4, capstyle="projecting", zorder=0))
            taken += list((ends[:, :1] + WAY * np.diff(ends, axis=1)).reshape(-1, 2))
    bodies.show(ax, [
        bodies.Body(x, q, semi_axes, AHEAD, BEHIND) for x, q in zip(shown.x, shown.q)
    ], view, scale, zorder=1)
    fastest = np.linalg.norm(shown.u, axis=1).max()
    quickest = np.linalg.norm(shown.omega, axis=1).max()
    reach = 2.6 * semi_axes.max()
    for x, u, q, omega in zip(shown.x, shown.u, shown.q, shown.omega):
        long = poses.rotation(q)[:, 1] * semi_axes.max()
        ends = [(x - long, x + long)]
        if fastest > RESTING:
            ends.append((x, x + reach * u / fastest))
            arrow(ax, *ends[-1], "", "black", width=1.5, view=view)
        ends.append((x, x + reach * poses.rotation(q) @ omega / max(quickest, 1e-12)))
        arrow(ax, *ends[-1], "", BODY, width=1.5, view=view)
        for start, end in ends:
            taken += list((view @ start)[:2] + WAY * (view @ (end - start))[:2])
    name_times(ax, seen, 1e3 * (shown.t - case.tracks[cell].t[0]), np.array(taken), high[0] - low[0])
    scale_bar(ax)
    told = "the cell stays in its place; poses drawn side by side" if apart else \
        f"black: velocity, longest {fastest:.2f} mm/s; walls at the cell's height"
    ax.annotate(f"{told};\nblue: angular velocity (right-hand rule), longest "
                f"{quickest:.0f} rad/s\nseen 35° off the vertical",
                (0, 0), xycoords="axes fraction", fontsize=7.5, va="top")


def drawn(case, cell):
    """The poses of panel D, in rows."""
    shown, _ = sequence(case, cell)
    names = ("t [ms]", "x1 [um]", "x2 [um]", "x3 [um]", "u1 [mm/s]", "u2 [mm/s]", "u3 [mm/s]")
    names += ("eps1", "eps2", "eps3", "eta", "omega1 [rad/s]", "omega2 [rad/s]", "omega3 [rad/s]")
    time = 1e3 * (shown.t - case.tracks[cell].t[0])
    return names, np.column_stack((time, shown.x, shown.u, shown.q, shown.omega)).tolist()


def draw(case, cell=None):
    """The figure."""
    cell, _ = find(case, cell, account.SIEVE)
    figure = plt.figure(figsize=(8.6, 7.4), layout="constrained")
    figure.set_constrained_layout_pads(h_pad=0.12, w_pad=0.05)
    panels = figure.subplot_mosaic("AB;CD", height_ratios=(1, 1.05))
    cell_axes = np.array((0.5, 2, 0.5)) * 0.9
    draw_frames(panels["A"], cell_axes, 60, case.plane.flow_axis)
    draw_angles(panels["B"])
    draw_surface(panels["C"], case, 200)
    draw_sequence(panels["D"], case, cell, 30)
    beads = contact_of(case)
    told = "cell with its {1} beads of {2:g} µm ({0})".format(*beads) if beads else "cell"
    style.describe(figure, f"""The model. A: the lab's frame x, the motion frame, which moves
        with the cell and stays parallel to the lab's, and the body's frame, the ellipsoid's
        axes. B: Euler angles, with N the line of nodes. C: the {told}. D: cell {cell} at discrete times with its velocity and
        angular velocity; walls are cut at the cell's mean height.""", drawn(case, cell))
    return figure
