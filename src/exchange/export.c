#include <string.h>

#include "core/file.h"
#include "exchange/kinds.h"

// Points as PLY, in the layout of points.ply, in the coordinates that were imported.
static ORL_EXPORT_WRITER(write_ply)
{
    (void)progress;
    return orl_points_write(log, params->out, &scene->points, false, scene->origin);
}

// nerfstudio's folder and a Python script that opens it in Blender, whose coordinates are floats: those of the scene, near 0.
static ORL_EXPORT_WRITER(write_blender)
{
    struct orl_scene near = *scene;
    memset(near.origin, 0, sizeof near.origin);
    ORL_TRY(orl_export_nerfstudio(log, progress, &near, params));
    return orl_file_write(log, ORL_PATH(params->out, "open_in_blender.py"), orl_blender_script,
                          strlen(orl_blender_script));
}

const struct orl_export_kind orl_export_kinds[] = {
    {"splats", "PLY of 2D Gaussian splatting", ORL_EXPORT_DEGREE | ORL_EXPORT_THIN,
     true, false, orl_export_splats},
    {"glb", "glTF with KHR_gaussian_splatting, points elsewhere", ORL_EXPORT_DEGREE,
     true, false, orl_export_glb},
    {"ply", "points with normals, colours and radii", 0, true, true, write_ply},
    {"nerfstudio", "a folder: transforms.json, photographs, points", 0,
     true, true, orl_export_nerfstudio},
    {"blender", "that folder, and a script that opens it in Blender", 0,
     true, false, write_blender},
    {"hdri", "all directions from a photograph's place, radiance, EXR", ORL_EXPORT_PLACE,
     false, true, orl_export_hdri},
    {"colmap", "nothing to write: a scene is a COLMAP workspace", 0, false, false, NULL},
    {0},
};
