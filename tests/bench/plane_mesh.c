// plane_mesh SCENE PHOTO FILE.ply: a square across the view of a photograph, at the median depth of
// the points that the photograph shows: the plane proxy of Airieau 2012, figure 3.
#include <stdio.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"
#include "oriel/scene.h"
#include "../mesh_help.h"

static double median_depth(const struct orl_scene *scene, const struct orl_view *view)
{
    double *depths = calloc(scene->points.count + 1, sizeof *depths), median = 0;
    size_t count = 0;
    for (size_t i = 0; depths && i < scene->points.count; i++) {
        const float *p = scene->points.position[i];
        const double world[3] = {(double)p[0], (double)p[1], (double)p[2]};
        double pixel[2], depth;
        if (orl_view_project(view, world, pixel, &depth) && pixel[0] >= 0 && pixel[1] >= 0 &&
            pixel[0] < view->camera.width && pixel[1] < view->camera.height)
            depths[count++] = depth;
    }
    if (count) {
        qsort(depths, count, sizeof *depths, orl_order_doubles);
        median = depths[count / 2];
    }
    free(depths);
    return median;
}

static enum orl_result make(const struct orl_log *log, const struct orl_scene *scene,
                            const char *photo, struct orl_mesh *mesh)
{
    int index = orl_scene_find_photo(scene, photo);
    if (index < 0)
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s has no photograph %s", scene->dir, photo);
    const struct orl_view *view = &scene->photos[index].view;
    double depth = median_depth(scene, view);
    if (!(depth > 0))
        return orl_fail(log, ORL_ERR_DATA, "%s shows no point", photo);
    *mesh = mesh_of(4, 2);
    for (int i = 0; i < 4; i++) {
        // Five pictures wide and high, so that views beside it are filled too.
        double world[3], x = (i & 1 ? 3.0 : -2.0) * view->camera.width;
        double y = (i & 2 ? 3.0 : -2.0) * view->camera.height;
        orl_view_unproject(view, x, y, depth, world);
        for (int k = 0; k < 3; k++)
            mesh->position[i][k] = (float)world[k];
    }
    static const uint32_t triangles[2][3] = {{0, 2, 1}, {1, 2, 3}};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangle[i][k] = triangles[i][k];
    return ORL_OK;
}

int main(int argc, char **argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_scene *scene = NULL;
    struct orl_mesh mesh = {0};
    if (argc != 4) {
        fprintf(stderr, "usage: plane_mesh SCENE PHOTO FILE.ply\n");
        return 2;
    }
    enum orl_result result = orl_scene_open(&log, argv[1], &scene);
    if (result == ORL_OK)
        result = make(&log, scene, argv[2], &mesh);
    if (result == ORL_OK)
        result = orl_mesh_set_normals(&log, &mesh);
    if (result == ORL_OK)
        result = orl_mesh_write(&log, argv[3], &mesh);
    orl_mesh_finish(&mesh);
    orl_scene_destroy(&scene);
    return result == ORL_OK ? 0 : 1;
}
