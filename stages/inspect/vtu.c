// SPDX-License-Identifier: GPL-3.0-or-later
// Text written into memory first and then to the file in one piece (write_whole), so
// that a frame is never half there. Numbers have nine digits, enough to draw; read
// artifacts for more. The .pvd names frames relative to itself: files can be moved
// together.
//
//     VTKFile / UnstructuredGrid / Piece
//         Points      one DataArray (n_point, 3)
//         Cells       connectivity, offsets (ends, without the 0), types
//         PointData   a DataArray each of grid.points
//         CellData    likewise of grid.cells
#include "vtu.h"

#include "basics/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VTK_VERTEX = 1, VTK_LINE = 3 };

// ParaView shows the name of a component beside that of the array.
static void put_doubles(FILE *stream, const struct vtu_array *array, int count)
{
    const int components = array->components;
    fprintf(stream,
            "<DataArray type=\"Float64\" Name=\"%s\" NumberOfComponents=\"%d\" ",
            array->name, components);
    if (array->meaning) fprintf(stream, "ComponentName0=\"%s\" ", array->meaning);
    fprintf(stream, "format=\"ascii\">\n");
    for (int k = 0; k < count * components; k++)
        fprintf(stream, "%.9g%c", array->value[k], (k + 1) % components ? ' ' : '\n');
    fprintf(stream, "</DataArray>\n");
}

// ParaView colours by the active scalars, those of points before those of cells.
static void put_arrays(FILE *stream, const char *kind, const struct vtu_array *arrays,
                       int count, const char *shown)
{
    const struct vtu_array *active = arrays;
    while (active && active->name && strcmp(active->name, shown))
        active++;
    fprintf(stream, "<%s", kind);
    if (active && active->name) fprintf(stream, " Scalars=\"%s\"", shown);
    fprintf(stream, ">\n");
    for (; arrays && arrays->name; arrays++)
        put_doubles(stream, arrays, count);
    fprintf(stream, "</%s>\n", kind);
}

static void put_cells(FILE *stream, const struct vtu_grid *grid, int n_cell, int size)
{
    fprintf(stream, "<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\">\n");
    for (int c = 0; c < n_cell; c++)
        if (grid->line)
            fprintf(stream, "%d %d\n", grid->line[c][0], grid->line[c][1]);
        else
            fprintf(stream, "%d\n", c);
    fprintf(stream, "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\">\n");
    for (int c = 0; c < n_cell; c++)
        fprintf(stream, "%d\n", size * (c + 1));
    fprintf(stream, "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\">\n");
    for (int c = 0; c < n_cell; c++)
        fprintf(stream, "%d\n", grid->line ? VTK_LINE : VTK_VERTEX);
    fprintf(stream, "</DataArray>\n</Cells>\n");
}

void write_vtu(const char *path, const struct vtu_grid *grid)
{
    const int n_cell = grid->line ? grid->n_line : grid->n_point;
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    fprintf(stream,
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n<UnstructuredGrid>\n"
            "<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n<Points>\n",
            grid->n_point, n_cell);
    put_doubles(stream, &(struct vtu_array){"position", &grid->point->x, 3, NULL},
                grid->n_point);
    fprintf(stream, "</Points>\n");
    put_cells(stream, grid, n_cell, grid->line ? 2 : 1);
    put_arrays(stream, "PointData", grid->points, grid->n_point, grid->shown);
    put_arrays(stream, "CellData", grid->cells, n_cell, grid->shown);
    fprintf(stream, "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    fclose(stream);
    write_whole(path, text, size);
    free(text);
}

void write_pvd(const char *path, const struct vtu_frame *frames, int n_frame)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    fprintf(stream, "<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n");
    for (int k = 0; k < n_frame; k++) {
        const char *slash = strrchr(frames[k].file, '/'); // beside the .pvd
        fprintf(stream, "<DataSet timestep=\"%.17g\" file=\"%s\"/>\n", frames[k].time,
                slash ? slash + 1 : frames[k].file);
    }
    fprintf(stream, "</Collection>\n</VTKFile>\n");
    fclose(stream);
    write_whole(path, text, size);
    free(text);
}
