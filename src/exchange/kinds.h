// Private: the writers of the table of kinds.
#ifndef ORL_EXCHANGE_KINDS_H
#define ORL_EXCHANGE_KINDS_H

#include "exchange/export.h"

#define ORL_EXPORT_WRITER(name)                                                                  \
    enum orl_result name(const struct orl_log *log, const struct orl_progress *progress,         \
                         const struct orl_scene *scene, const struct orl_export_params *params)

ORL_EXPORT_WRITER(orl_export_glb) ORL_CHECK_RESULT;
ORL_EXPORT_WRITER(orl_export_hdri) ORL_CHECK_RESULT;
ORL_EXPORT_WRITER(orl_export_nerfstudio) ORL_CHECK_RESULT;
ORL_EXPORT_WRITER(orl_export_splats) ORL_CHECK_RESULT;

extern const char orl_blender_script[]; // open_in_blender.py

#endif
