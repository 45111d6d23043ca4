// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    Which cells occupancy holds, what the flow and its table are told of them,
    and apertures.

\*---------------------------------------------------------------------------*/

#include "atomicWrite.H"
#include "layerParts.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The bodies, and the lines of the table
    static void checkBlocking(const layer& at)
    {
        const polyBoundaryMesh& patches = at.mesh.boundaryMesh();
        const char* rests = "speed 1e-6; holdTime 0.05;";
        const char* box =
            " { min (0 9e-6 0); max (2e-5 11e-6 1e-5); normal (0 1 0); } ";
        const string how
        (
            "active yes; fates (stalled); apertures { post" + string(box)
          + "plates" + box + "}"
        );
        cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6), 3));
        const scalar axis[] = {0.48, 0.6, 0.64};
        ellipsoid_quaternion_from_axis(axis, 0.7, cell.body.q);
        cell.fate = cellState::stalled;
        cell.patch = patches.findPatchID("post");

        holding one(at, cell, dictionary(), rests, how.c_str());
        one.cells.append(at.cellAt(point(15e-6, 10e-6, 5e-6), 4));
        one.cells[1].fate = cellState::caught;
        one.held.update(one.cells, one.events);
        const List<heldBody> bodies(one.held.bodies(one.cells));
        holds
        (
            "a fate that is named holds, another does not",
            one.held.outdated() && bodies.size() == 1 && bodies[0].id == 3
        );
        holds
        (
            "a body has the pose of its cell",
            bodies[0].patch == cell.patch && bodies[0].centre == cell.centre()
         && mag(bodies[0].rotation - rotationOf(cell.body.q)) < 1e-12
        );
        one.held.setWrenches(List<heldWrench>(1, one.pullOf(0)), one.cells);
        one.held.update(one.cells, one.events);
        holds("what is held already asks for no flow", !one.held.outdated());

        one.held.write(0.25, at.undecomposed.phi(), 8e-13, one.cells);
        const std::string table(textOf(at.mesh.time().path()/"tables/fluxes.csv"));
        holds
        (
            "a line has the flux of an aperture, its share and its cells",
            table == "t,sieve,flux,share,cells\n0.25,post,4e-13,0.5,1\n"
                "0.25,plates,4e-13,0.5,0\n",
            table
        );
    }

    //- In a flow that is taken as it is, a cell beside one that pushes it
    static void checkUnchanged(const layer& still)
    {
        const layer at(still.mesh, vector(1e-5, 0, 0));
        const cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6), 3));
        const char* rests = "displacement 5e-8; holdTime 0.05;";
        holding one
        (
            at, cell, dictionary(), rests, "active yes; flow unchanged;"
        );
        one.cells.append(at.cellAt(point(5e-6, 10e-6, 5e-6), 4));
        Swap(one.cells[0], one.cells[1]);
        cellState& held = one.cells[1];
        const auto stays = [&](const scalar distance, const scalar slowTime)
        {
            one.cells[0].body.x[0] = held.body.x[0] - distance;
            held.slowTime = slowTime;
            one.held.update(one.cells, one.events);
            return one.held.held().found(3);
        };

        held.fate = cellState::caught;
        held.body.u[0] = 1;
        holds("a cell is held in it", stays(5e-6, 0) && held.body.u[0] == 0);
        holds("one that comes near it pushes it off", !stays(1e-6, 0));
        held.fate = cellState::caught;
        stays(5e-6, 0);
        holds("it is asked at the ends of hold times", stays(1e-6, 0.01));
        holds("whatever it has withstood", !stays(1e-6, 0));
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

// Sections at y = 10 um, where the flow goes along by 2 mm/s
void Foam::checkApertures(const layer& at)
{
    const auto flux = [&](const char* max, const char* normal)
    {
        const occupancy::setting of
        (
            entries
            (
                "apertures { post { min (0 9e-6 0); max (" + string(max)
              + " 11e-6 1e-5); normal (0 " + normal + " 0); } }"
            ),
            at.mesh.boundaryMesh()
        );
        return of.apertures[0].flux(at.undecomposed.phi());
    };
    const auto is = [](const scalar found, const scalar expected)
    {
        return mag(found - expected) < 1e-9*mag(expected);
    };
    holds("a section has the flux through it", is(flux("2e-5", "3"), 4e-13));
    holds("of the other sign the other way", is(flux("2e-5", "-3"), -4e-13));
    holds("and of a part of it that part", is(flux("1e-5", "3"), 2e-13));

    // It may be off by a tenth
    bool all = true;
    for (const scalar part : {0.8, 0.95, 1.05, 1.2})
    {
        const occupancy::setting of
        (
            entries
            (
                "apertures { post { min (0 9e-6 0); max (2e-5 11e-6 1e-5);"
                "normal (0 3 0); area " + Foam::name(part*2e-10) + "; } }"
            ),
            at.mesh.boundaryMesh()
        );
        const bool right = mag(part - 1) < 0.1;
        all = all && right != refuses([&]()
        {
            all = is(of.apertures[0].area(at.mesh), 2e-10) && all;
        });
    }
    holds("its area is that of the mesh, and what is told", all);
    all = true;
    for (const char* active : {"yes", "no"})
    {
        const string text
        (
            "active " + string(active) + "; apertures { none { min (0 0 0);"
            "max (1 1 1); normal (0 1 0); } }"
        );
        all = all && (active[0] == 'y') == refuses([&]()
        {
            occupancy::setting(entries(text), at.mesh.boundaryMesh());
        });
    }
    holds("of a patch, where there is to be one", all);
    checkBlocking(at);
    checkUnchanged(at);
}
