// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The quadratic polynomials of the mesh cells (vertexFit.H).

\*---------------------------------------------------------------------------*/

#include "vertexFit.H"
#include "curvatureFit.H"
#include "wallsAtVertices.H"
#include "symmTensorField.H"
#include "symmTransform.H"
#include "Tuple2.H"

#include <algorithm>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- What has been taken for a mesh cell already: in the mesh by labels, of
    //  images by where they are, too
    class takenOnce
    {
        label celli_ = -1;
        scalar length_ = 0;
        labelList takenFor_;
        DynamicList<Tuple2<label, point>> beyond_;

    public:

        explicit takenOnce(const label n)
        :
            takenFor_(n, -1)
        {}

        void start(const label celli, const scalar length)
        {
            celli_ = celli;
            length_ = length;
            beyond_.clear();
        }

        //- Take one at x, or its image, unless it has been
        bool take(const label i, const point& x, const isometry* image)
        {
            if (!image)
            {
                const bool isNew = takenFor_[i] != celli_;
                takenFor_[i] = celli_;
                return isNew;
            }

            const point y((*image)(x));
            for (const Tuple2<label, point>& known : beyond_)
            {
                if
                (
                    known.first() == i
                 && mag(known.second() - y) < 1e-6*length_
                )
                {
                    return false;
                }
            }
            beyond_.append(Tuple2<label, point>(i, y));
            return true;
        }
    };

    //- Second moments of the mesh cells about their centres by volume [m2]
    static symmTensorField secondMoments(const polyMesh& mesh)
    {
        const pointField& points = mesh.points();
        const pointField& centres = mesh.cellCentres();
        symmTensorField moments(mesh.nCells(), Zero);
        scalarField volumes(mesh.nCells(), Zero);

        forAll(mesh.faces(), facei)
        {
            const face& f = mesh.faces()[facei];
            for (label side = 0; side < 1 + mesh.isInternalFace(facei); ++side)
            {
                const label celli =
                    side ? mesh.faceNeighbour()[facei]
                  : mesh.faceOwner()[facei];
                const point& c = centres[celli];

                for (label i = 1; i < f.size() - 1; ++i)
                {
                    const vector a(points[f[0]] - c);
                    const vector b(points[f[i]] - c);
                    const vector d(points[f[i + 1]] - c);
                    const scalar volume = (side ? -1 : 1)*(a & (b ^ d));

                    moments[celli] +=
                        volume*(sqr(a) + sqr(b) + sqr(d) + sqr(a + b + d))/20;
                    volumes[celli] += volume;
                }
            }
        }

        forAll(moments, celli)
        {
            symmTensor& M = moments[celli];
            const bool sound =
                volumes[celli] > 0 && min(M.xx(), min(M.yy(), M.zz())) > 0;

            // Of a mesh cell that is partly inside out those of a cube
            M =
                sound
              ? M/volumes[celli]
              : pow(mesh.cellVolumes()[celli], 2.0/3)/12*symmTensor(I);
        }
        return moments;
    }

    //- What polynomials are fitted to
    class cellFitter
    {
        const volVectorField& U_;
        const polyMesh& mesh_;
        const pointField& centres_;
        const baffleSides& baffles_;
        const pointImages& images_;
        const wallsAtVertices& walls_;
        const symmTensorField M_;

        //- For one mesh cell and its size [m]
        label celli_ = -1;
        scalar length_ = 0;
        curvatureFit equations_;
        takenOnce cells_;
        takenOnce faces_;

        //- Add a mean velocity u about x with second moments m, or its image
        void add
        (
            const point& x,
            const symmTensor& m,
            const vector& u,
            const isometry* image
        )
        {
            if (image)
            {
                const tensor T(image->turn());
                add((*image)(x), transform(T, m), T & u, nullptr);
                return;
            }
            equations_.append
            (
                (x - centres_[celli_])/length_,
                (m - M_[celli_])/sqr(length_),
                u - U_[celli_]
            );
        }

        //- The second moments of a face of a wall, as wide as its cell
        symmTensor momentsOf(const label facei) const
        {
            const vector& S = mesh_.faceAreas()[facei];
            const symmTensor along(I - sqr(S/mag(S)));
            return symm(along & M_[mesh_.faceOwner()[facei]] & along);
        }

        //- Add mesh cells and walls at a point, or their image if there is one
        void addAt(const label pointi, const isometry* image)
        {
            const label vertexi =
                image ? pointi : baffles_.vertex(pointi, celli_);

            for (const label other : mesh_.pointCells()[pointi])
            {
                const point& x = centres_[other];
                if
                (
                    baffles_.vertex(pointi, other) == vertexi
                 && cells_.take(other, x, image)
                )
                {
                    add(x, M_[other], U_[other], image);
                }
            }
            for (const label facei : walls_.faces(vertexi))
            {
                const point& x = mesh_.faceCentres()[facei];
                if (faces_.take(facei, x, image))
                {
                    add(x, momentsOf(facei), walls_.velocity(facei), image);
                }
            }
        }

    public:

        cellFitter
        (
            const volVectorField& U,
            const baffleSides& baffles,
            const pointImages& images,
            const wallsAtVertices& walls
        )
        :
            U_(U),
            mesh_(U.mesh()),
            centres_(mesh_.cellCentres()),
            baffles_(baffles),
            images_(images),
            walls_(walls),
            M_(secondMoments(mesh_)),
            cells_(mesh_.nCells()),
            faces_(mesh_.nFaces())
        {}

        //- The polynomial of a mesh cell
        quadratic fit(const label celli)
        {
            celli_ = celli;
            length_ = Foam::sqrt(tr(M_[celli]));
            equations_.clear();
            cells_.start(celli, length_);
            faces_.start(celli, length_);
            cells_.take(celli, centres_[celli], nullptr);

            for (const label pointi : mesh_.cellPoints()[celli])
            {
                addAt(pointi, nullptr);
                for (const pointImage& from : images_.at(pointi))
                {
                    addAt(from.point, &from.image);
                }
            }

            quadratic p;
            equations_.solve(p);
            p.gradient /= length_;
            p.value = U_[celli];
            for (direction i = 0; i < 3; ++i)
            {
                p.curvature[i] /= sqr(length_);
                p.value[i] -= 0.5*(p.curvature[i] && M_[celli]);
            }
            return p;
        }
    };
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::List<Foam::quadratic> Foam::cellFits
(
    const volVectorField& U,
    const baffleSides& baffles,
    const pointImages& images,
    const wallsAtVertices& walls
)
{
    cellFitter fitter(U, baffles, images, walls);
    List<quadratic> fits(U.mesh().nCells());

    forAll(fits, celli)
    {
        fits[celli] = fitter.fit(celli);
    }
    return fits;
}
