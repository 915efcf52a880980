// nerfstudio's folder and a Python script that opens it in Blender, whose coordinates are floats: those of the
// scene, near 0.
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "exchange/kinds.h"

static enum orl_result add_script(const struct orl_log *log, const char *dir)
{
    char *path = orl_path_join(log, dir, "open_in_blender.py");
    enum orl_result result =
        path ? orl_file_write(log, path, orl_blender_script, strlen(orl_blender_script))
             : ORL_ERR_MEMORY;
    free(path);
    return result;
}

ORL_EXPORT_WRITER(orl_export_blender)
{
    struct orl_scene near = *scene;
    memset(near.origin, 0, sizeof near.origin);
    ORL_TRY(orl_export_nerfstudio(log, progress, &near, params));
    return add_script(log, params->out);
}
