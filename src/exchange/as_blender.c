// nerfstudio's folder and a Python script that opens it in Blender, whose coordinates are floats: those of the
// scene, near 0.
#include <string.h>

#include "core/file.h"
#include "exchange/kinds.h"

ORL_EXPORT_WRITER(orl_export_blender)
{
    struct orl_scene near = *scene;
    memset(near.origin, 0, sizeof near.origin);
    ORL_TRY(orl_export_nerfstudio(log, progress, &near, params));
    return orl_file_write(log, ORL_PATH(params->out, "open_in_blender.py"), orl_blender_script,
                          strlen(orl_blender_script));
}
