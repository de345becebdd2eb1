// SPDX-License-Identifier: GPL-3.0-or-later
// The library of voro++ on points in the unit box, without text: what a program that links it
// would pay for the cells of its grains.
//
//     voro_library POINTS    lines of a number and three coordinates
//
// Cells with their vertices, faces and neighbours, as a pore network needs them. Prints the sum
// of their volumes (1) and the number of faces, so that nothing can be left out.
#include <voro++/voro++.hh>

#include <cstdio>
#include <vector>

struct sums {
    double volume = 0;
    long faces = 0;
};

static void add_cells(voro::container &box, sums &sums)
{
    voro::c_loop_all loop(box);
    voro::voronoicell_neighbor cell;
    std::vector<double> vertices;
    std::vector<int> faces, neighbours;
    if (!loop.start()) return;
    do {
        if (!box.compute_cell(cell, loop)) continue;
        double x, y, z;
        loop.pos(x, y, z);
        cell.vertices(x, y, z, vertices);
        cell.face_vertices(faces);
        cell.neighbors(neighbours);
        sums.volume += cell.volume();
        sums.faces += static_cast<long>(neighbours.size());
    } while (loop.inc());
}

int main(int argc, char **argv)
{
    if (argc != 2) return 64;
    FILE *file = std::fopen(argv[1], "r");
    if (!file) return 66;
    int id;
    double x, y, z;
    voro::pre_container points(0, 1, 0, 1, 0, 1, false, false, false);
    while (std::fscanf(file, "%d %lf %lf %lf", &id, &x, &y, &z) == 4)
        points.put(id, x, y, z);
    std::fclose(file);
    int nx, ny, nz;
    points.guess_optimal(nx, ny, nz);
    voro::container box(0, 1, 0, 1, 0, 1, nx, ny, nz, false, false, false, 8);
    points.setup(box);
    sums sums;
    add_cells(box, sums);
    std::printf("%.12g %ld\n", sums.volume, sums.faces);
    return 0;
}
