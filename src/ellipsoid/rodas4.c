/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    rodas4.c - the coefficients of RODAS4.

    Hairer & Wanner, Solving Ordinary Differential Equations II (1996), section
    IV.7 and code RODAS: six stages, order 4(3), L-stable, stiffly accurate.
*/
#include "ellipsoidInternal.h"

/* Coefficients of RODAS, first set (METH = 1). */
const ellipsoid_rosenbrock_table ellipsoid_rodas4 = {
    .gamma = 0.25,
    .a = {{0},
          {1.544},
          {0.9466785280815826, 0.2557011698983284},
          {3.314825187068521, 2.896124015972201, 0.9986419139977817},
          {1.221224509226641, 6.019134481288629, 12.53708332932087,
           -0.6878860361058950},
          {1.221224509226641, 6.019134481288629, 12.53708332932087,
           -0.6878860361058950, 1}},
    .c = {{0},
          {-5.6688},
          {-2.430093356833875, -0.2063599157091915},
          {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
          {7.496443313967647, -10.24680431464352, -33.99990352819905,
           11.70890893206160},
          {8.083246795921522, -7.981132988064893, -31.52159432874371,
           16.31930543123136, -6.058818238834054}},
    .dense = {{10.12623508344586, -7.487995877610167, -34.80091861555747,
               -7.992771707568823, 1.025137723295662},
              {-0.6762803392801253, 6.087714651680015, 16.43084320892478,
               24.76722511418386, -6.594389125716872}},
};
