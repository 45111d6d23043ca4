// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "sharedMemory.H"
#include "Pstream.H"
#include "error.H"

#include <algorithm>
#include <mpi.h>

// * * * * * * * * * * * * * * Private Data Types  * * * * * * * * * * * * * //

struct Foam::sharedMemory::window
{
    MPI_Win handle;

    //- The first ranks of all nodes; null on others
    MPI_Comm firstRanks;
};


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::sharedMemory::sharedMemory(const std::size_t size)
:
    size_(size)
{
    if (!Pstream::parRun())
    {
        own_.reset(new char[size]);
        bytes_ = own_.get();
        return;
    }

    window_.reset(new window);

    MPI_Comm node;
    int rank;
    MPI_Comm_split_type
    (
        MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node
    );
    MPI_Comm_rank(node, &rank);
    MPI_Comm_split
    (
        MPI_COMM_WORLD, rank ? MPI_UNDEFINED : 0, 0, &window_->firstRanks
    );

    MPI_Comm_set_errhandler(node, MPI_ERRORS_RETURN);
    const int status = MPI_Win_allocate_shared
    (
        rank ? 0 : size, 1, MPI_INFO_NULL, node, &bytes_, &window_->handle
    );
    if (status != MPI_SUCCESS)
    {
        FatalErrorInFunction
            << "no shared memory for " << size << " bytes of the flow"
            << nl << "    The node needs this much of memory, and its folder of"
            << " shared memory, /dev/shm unless MPI is told otherwise, as much"
            << " room" << abort(FatalError);
    }

    MPI_Aint there;
    int unit;
    MPI_Win_shared_query(window_->handle, 0, &there, &unit, &bytes_);
    MPI_Comm_free(&node);
    close();
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::sharedMemory::~sharedMemory()
{
    if (window_.valid())
    {
        close();
        if (window_->firstRanks != MPI_COMM_NULL)
        {
            MPI_Comm_free(&window_->firstRanks);
        }
        MPI_Win_free(&window_->handle);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::sharedMemory::close() const
{
    if (window_.valid())
    {
        MPI_Win_fence(0, window_->handle);
    }
}


void Foam::sharedMemory::share() const
{
    // MPI counts with int
    const std::size_t piece = 1 << 28;

    if (window_.valid() && window_->firstRanks != MPI_COMM_NULL)
    {
        for (std::size_t i = 0; i < size_; i += piece)
        {
            MPI_Bcast
            (
                bytes_ + i,
                int(std::min(piece, size_ - i)),
                MPI_BYTE,
                0,
                window_->firstRanks
            );
        }
    }

    close();
}
