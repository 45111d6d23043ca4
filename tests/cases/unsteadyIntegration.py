# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""A heavy sphere and an E. coli in the unsteady channel flow of unsteadyFlow.test, integrated by Runge and Kutta.

usage: unsteadyIntegration.py EVERY VELOCITY     every how many time steps the flow is known, cellPoint or divergenceFree
"""

import math
import sys

import numpy as np

from checks import expect, finish, row as check_row, table

every, velocity = int(sys.argv[1]), sys.argv[2]
H, NODE = 4e-6, 500e-6/6
times, profile = [0.0], [np.zeros(50)]
for line in open("postProcessing/profile/0/U", encoding="ascii"):
    if not line.startswith("#"):
        numbers = line.replace("(", " ").replace(")", " ").split()
        times.append(float(numbers[0]))
        profile.append(np.array([float(n) for n in numbers[1::3]]))
times, profile = np.array(times[::every]), np.array(profile[::every])
expect(len(times) > 20, f"{len(times)} time steps, fastest {np.abs(profile).max():g} m/s")


def along(value, j, part):
    """Along the line through the middle of a mesh cell cellPoint is linear from its middle to that of its face,
    whose corners have means of four mesh cells."""
    return (1 - part)*value[j] + part*(value[j - 1] + 2*value[j] + value[j + 1])/4


def shear(u):
    """Gauss' gradient by y, walls included."""
    faces = np.concatenate(([0], (u[:-1] + u[1:])/2, [0]))
    return (faces[1:] - faces[:-1])/H


def bend(u, j):
    """Second difference."""
    return u[j - 1] - 2*u[j] + u[j + 1]


def flow(step, j, part):
    """Velocity and its derivative by y."""
    u = profile[step]
    if velocity == "cellPoint":
        return along(u, j, part), along(shears[step], j, part)
    # divergenceFree: in each mesh cell the quadratic that has its mean and those of its neighbours; the
    # derivative is linear between the middle and the corners, which have the mean of two of them
    slope = [(u[k + 1] - u[k - 1])/(2*H) for k in (j - 1, j, j + 1)]
    corners = (slope[0] + 2*slope[1] + slope[2] - (bend(u, j + 1) - bend(u, j - 1))/(2*H))/4
    return u[j] - bend(u, j)/24, (1 - part)*slope[1] + part*corners


shears = np.array([shear(u) for u in profile])


def rates(j, sphere, step, w, y):
    """Of x, speed and angle."""
    x, u, angle = y
    part = abs(x - 250e-6)/NODE
    (u0, g0), (u1, g1) = flow(step, j, part), flow(step + 1, j, part)
    dt = times[step + 1] - times[step]
    U, G = u0 + w*(u1 - u0), g0 + w*(g1 - g0)
    if sphere:
        tau = 2*(10e-6)**2*4/9/1e-6
        return np.array([u, (u1 - u0)/dt/4 + (U - u)/tau, 0])
    # Jeffery: the long axis at angle to y, turned by omega_z = -G/2; r = 4
    shape = (16 - 1)/(16 + 1)
    return np.array([U, 0, -G/2*(1 + shape*np.cos(2*angle))])


tracks = table("tracks.csv")
for cell, j in ((0, 12), (1, 39)):
    y = np.array([250e-6, 0, np.radians(15)])
    mine = {0.0: y}
    n = 40
    for step in range(len(times) - 1):
        dt = times[step + 1] - times[step]
        for i in range(n):
            w, h = i/n, dt/n
            k1 = rates(j, cell == 0, step, w, y)
            k2 = rates(j, cell == 0, step, w + 0.5/n, y + h/2*k1)
            k3 = rates(j, cell == 0, step, w + 0.5/n, y + h/2*k2)
            k4 = rates(j, cell == 0, step, w + 1/n, y + h*k3)
            y = y + h/6*(k1 + 2*k2 + 2*k3 + k4)
        mine[round(times[step + 1], 9)] = y
    rows = [row for row in tracks if row["id"] == cell and round(row["t"], 9) in mine]
    expect(len(rows) > 0.9*len(times), f"cell {cell}: {len(rows)} rows at time steps")
    there = np.array([[row["x1"], math.atan2(-row["O1"], row["O2"])] for row in rows])
    here = np.array([mine[round(row["t"], 9)][[0, 2]] for row in rows])
    way = np.ptp(here[:, 0])
    apart = np.abs(there - here).max(axis=0)
    expect(way > 5e-6, f"cell {cell} moves over {way:g} m and turns over {np.ptp(here[:, 1]):g} rad")
    where = f"oscillating channel, {'heavy sphere' if cell == 0 else 'E. coli'}, {velocity}"
    if every > 1:
        where += f", every {every}th step"
    source = "classical Runge-Kutta steps in Python"
    check_row(("tracking on meshes", "error of the place over the way", where, source, "S", "tolerance and written digits"), apart[0]/way, 0, 1e-5)
    if cell == 1:
        check_row(("tracking on meshes", "error of the axis [rad]", where, source, "S", "inertia of turning, which it leaves out"), apart[1], 0, 1e-5)
finish()
