/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallMesh.c - walls for tests.
*/
#include "wallMesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *grown(void *memory, size_t size)
{
    void *result = realloc(memory, size > 0 ? size : 1);

    if (!result)
    {
        abort();
    }
    return result;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The unit vector from a to b */
static void direction(const double a[3], const double b[3], double r[3])
{
    double length;

    for (int i = 0; i < 3; i++)
    {
        r[i] = b[i] - a[i];
    }
    length = sqrt(dot(r, r));
    for (int i = 0; i < 3; i++)
    {
        r[i] /= length;
    }
}

void wall_mesh_init(wall_mesh *mesh) { memset(mesh, 0, sizeof *mesh); }

void wall_mesh_free(wall_mesh *mesh)
{
    free(mesh->facets);
    free(mesh->index);
    free(mesh->stars);
    free(mesh->listed);
    wall_mesh_init(mesh);
}

void wall_mesh_triangle(wall_mesh *mesh, const double a[3], const double b[3],
                        const double c[3], int surface)
{
    const double *corner[3] = {a, b, c};
    ellipsoid_facet facet = {.surface = surface};

    for (int k = 0; k < 3; k++)
    {
        for (int i = 0; i < 3; i++)
        {
            facet.vertex[k][i] = corner[k][i] + 0.0; /* no -0 */
        }
    }
    if (mesh->count == mesh->capacity)
    {
        mesh->capacity = 2 * mesh->capacity + 64;
        mesh->facets =
            grown(mesh->facets, mesh->capacity * sizeof *mesh->facets);
    }
    mesh->facets[mesh->count++] = facet;
}

void wall_mesh_quad(wall_mesh *mesh, const double a[3], const double b[3],
                    const double c[3], const double d[3], int diagonal,
                    int surface)
{
    if (diagonal == 0)
    {
        wall_mesh_triangle(mesh, a, b, c, surface);
        wall_mesh_triangle(mesh, a, c, d, surface);
    }
    else
    {
        wall_mesh_triangle(mesh, a, b, d, surface);
        wall_mesh_triangle(mesh, b, c, d, surface);
    }
}

void wall_mesh_grid(wall_mesh *mesh, int nu, int nv, wall_mesh_map map,
                    void *context, int diagonal, int surface)
{
    for (int i = 0; i < nu; i++)
    {
        for (int j = 0; j < nv; j++)
        {
            double p[4][3];

            for (int k = 0; k < 4; k++)
            {
                const int du = k == 1 || k == 2, dv = k >= 2;
                const double uv[2] = {(i + du) / (double)nu,
                                      (j + dv) / (double)nv};

                map(uv, p[k], context);
            }
            wall_mesh_quad(mesh, p[0], p[1], p[2], p[3],
                           diagonal == 2 ? (i + j) % 2 : diagonal, surface);
        }
    }
}

static void on_plane(const double *uv, double point[3], void *context)
{
    const double *(*frame)[3] = context;

    for (int i = 0; i < 3; i++)
    {
        point[i] =
            (*frame)[0][i] + uv[0] * (*frame)[1][i] + uv[1] * (*frame)[2][i];
    }
}

void wall_mesh_plane(wall_mesh *mesh, const double corner[3], const double u[3],
                     const double v[3], int nu, int nv, int diagonal,
                     int surface)
{
    const double *frame[3] = {corner, u, v};

    wall_mesh_grid(mesh, nu, nv, on_plane, &frame, diagonal, surface);
}

void wall_mesh_box(wall_mesh *mesh, const double low[3], const double high[3],
                   int inwards, int diagonal, int surface)
{
    for (int side = 0; side < 6; side++)
    {
        const int axis = side / 2, upper = side % 2;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        double p[4][3];

        for (int k = 0; k < 4; k++)
        {
            p[k][axis] = upper ? high[axis] : low[axis];
            p[k][u] = k == 1 || k == 2 ? high[u] : low[u];
            p[k][v] = k >= 2 ? high[v] : low[v];
        }
        /* 0123 has its normal along +axis */
        if (upper != inwards)
        {
            wall_mesh_quad(mesh, p[0], p[1], p[2], p[3], diagonal, surface);
        }
        else
        {
            wall_mesh_quad(mesh, p[3], p[2], p[1], p[0], diagonal, surface);
        }
    }
}

/* ------------------------------------------------------------- topology */

typedef struct corner
{
    double point[3];
    int facet, k;
} corner;

typedef struct half_edge
{
    int low, high; /* vertex numbers */
    int facet, k;
} half_edge;

static int compare_points(const double a[3], const double b[3])
{
    for (int i = 0; i < 3; i++)
    {
        if (a[i] != b[i])
        {
            return a[i] < b[i] ? -1 : 1;
        }
    }
    return 0;
}

static int compare_corners(const void *a, const void *b)
{
    return compare_points(((const corner *)a)->point,
                          ((const corner *)b)->point);
}

static int compare_edges(const void *a, const void *b)
{
    const half_edge *e = a, *f = b;

    return e->low != f->low   ? (e->low < f->low ? -1 : 1)
         : e->high != f->high ? (e->high < f->high ? -1 : 1)
                              : 0;
}

/* Numbers the vertices: vertex[3 facet + k]; returns how many. */
static int number_vertices(const wall_mesh *mesh, int *vertex)
{
    const int n = 3 * mesh->count;
    corner *corners = grown(NULL, n * sizeof *corners);
    int count = 0;

    for (int c = 0; c < n; c++)
    {
        corners[c].facet = c / 3;
        corners[c].k = c % 3;
        memcpy(corners[c].point, mesh->facets[c / 3].vertex[c % 3],
               sizeof corners[c].point);
    }
    qsort(corners, n, sizeof *corners, compare_corners);
    for (int c = 0; c < n; c++)
    {
        count += c == 0
              || compare_points(corners[c].point, corners[c - 1].point) != 0;
        vertex[3 * corners[c].facet + corners[c].k] = count - 1;
    }
    free(corners);
    return count;
}

static void set_stars(wall_mesh *mesh, const half_edge *edges, int edge_count,
                      const int *vertex, int vertex_count)
{
    int *start = grown(NULL, (vertex_count + 1) * sizeof *start);
    int *filled = grown(NULL, vertex_count * sizeof *filled);

    memset(start, 0, (vertex_count + 1) * sizeof *start);
    memset(filled, 0, vertex_count * sizeof *filled);
    for (int pass = 0; pass < 2; pass++)
    {
        for (int e = 0; e < edge_count; e++)
        {
            if (e > 0 && compare_edges(&edges[e], &edges[e - 1]) == 0)
            {
                continue;
            }

            const ellipsoid_facet *f = &mesh->facets[edges[e].facet];
            const int corner_of = 3 * edges[e].facet;

            for (int end = 0; end < 2; end++)
            {
                const int k = (edges[e].k + end) % 3;
                const int other = (edges[e].k + 1 - end) % 3;
                const int v = vertex[corner_of + k];

                if (pass == 0)
                {
                    start[v + 1]++;
                }
                else
                {
                    direction(f->vertex[k], f->vertex[other],
                              mesh->stars[start[v] + filled[v]++]);
                }
            }
        }
        for (int v = 0; v < vertex_count && pass == 0; v++)
        {
            start[v + 1] += start[v];
        }
        if (pass == 0)
        {
            mesh->stars =
                grown(NULL, start[vertex_count] * sizeof *mesh->stars);
        }
    }
    for (int c = 0; c < 3 * mesh->count; c++)
    {
        ellipsoid_facet *f = &mesh->facets[c / 3];

        f->star[c % 3] =
            (const char *)(mesh->stars + start[vertex[c]]) - (const char *)f;
        f->star_count[c % 3] = filled[vertex[c]];
    }
    free(start);
    free(filled);
}

void wall_mesh_finish(wall_mesh *mesh)
{
    const int n = 3 * mesh->count;
    int *vertex = grown(NULL, n * sizeof *vertex);
    half_edge *edges = grown(NULL, n * sizeof *edges);
    const int vertices = number_vertices(mesh, vertex);

    mesh->index = grown(NULL, mesh->count * sizeof *mesh->index);
    mesh->listed = grown(NULL, mesh->count * sizeof *mesh->listed);
    for (int f = 0; f < mesh->count; f++)
    {
        double points[3][3];

        memcpy(points, mesh->facets[f].vertex, sizeof points);
        ellipsoid_facet_set(&mesh->facets[f], (const double(*)[3])points);
        mesh->index[f] = f;
    }
    for (int c = 0; c < n; c++)
    {
        const int from = vertex[c], to = vertex[c - c % 3 + (c + 1) % 3];
        const half_edge edge = {from < to ? from : to, from < to ? to : from,
                                c / 3, c % 3};

        edges[c] = edge;
    }
    qsort(edges, n, sizeof *edges, compare_edges);
    for (int e = 0; e < n; e++)
    {
        for (int o = e - 1; o >= 0 && compare_edges(&edges[e], &edges[o]) == 0;
             o--)
        {
            ellipsoid_facet *a = &mesh->facets[edges[e].facet];
            ellipsoid_facet *b = &mesh->facets[edges[o].facet];

            ellipsoid_facet_join(a, edges[e].k, b);
            ellipsoid_facet_join(b, edges[o].k, a);
        }
    }
    set_stars(mesh, edges, n, vertex, vertices);
    free(vertex);
    free(edges);
}

int wall_mesh_list(void *context, double t, const double centre[3],
                   double reach, ellipsoid_facet_list *list)
{
    wall_mesh *mesh = context;

    (void)t;
    list->facets = mesh->facets;
    list->index = mesh->listed;
    list->count = 0;
    list->reach = reach;
    for (int f = 0; f < mesh->count; f++)
    {
        /* no nearer than its plane, nor than the box about it */
        const ellipsoid_facet *facet = &mesh->facets[f];
        double d[3], outside = 0;

        for (int i = 0; i < 3; i++)
        {
            const double a = facet->vertex[0][i], b = facet->vertex[1][i];
            const double c = facet->vertex[2][i];
            const double low = fmin(a, fmin(b, c)) - centre[i];
            const double high = centre[i] - fmax(a, fmax(b, c));
            const double gap = fmax(0, fmax(low, high));

            outside += gap * gap;
            d[i] = centre[i] - a;
        }
        if (outside < reach * reach && fabs(dot(d, facet->normal)) < reach)
        {
            mesh->listed[list->count++] = f;
        }
    }
    return 0;
}
