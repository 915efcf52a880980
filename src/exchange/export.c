#include "exchange/kinds.h"

const struct orl_export_kind orl_export_kinds[] = {
    {"splats", "PLY of 2D Gaussian splatting", ORL_EXPORT_DEGREE | ORL_EXPORT_THIN,
     true, false, orl_export_splats},
    {"glb", "glTF with KHR_gaussian_splatting, points elsewhere", ORL_EXPORT_DEGREE,
     true, false, orl_export_glb},
    {"ply", "points with normals, colours and radii", 0, true, true, orl_export_ply},
    {"nerfstudio", "a folder: transforms.json, photographs, points", 0,
     true, true, orl_export_nerfstudio},
    {"blender", "that folder, and a script that opens it in Blender", 0,
     true, false, orl_export_blender},
    {"hdri", "all directions from a photograph's place, radiance, EXR", ORL_EXPORT_PLACE,
     false, true, orl_export_hdri},
    {"colmap", "nothing to write: a scene is a COLMAP workspace", 0, false, false, NULL},
    {0},
};
