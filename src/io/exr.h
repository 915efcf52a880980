// OpenEXR files through OpenEXRCore's C API.
#ifndef ORL_IO_EXR_H
#define ORL_IO_EXR_H

#include "oriel/image.h"
#include "oriel/camera.h"
#include "oriel/option_row.h"

enum { ORL_EXR_CHANNELS_MAX = 32 };

struct orl_exr_channel {
    char name[32];     // "R", "depth.Z", "normal.X", "coverage", ...
    bool half;         // stored as half; false: float
    const float *data; // first sample; not owned
    size_t stride;     // floats from one pixel to the next
};

// OpenEXR's standard attributes. What is false or NULL is left out.
struct orl_exr_view_attributes {
    // Gives worldToCamera (row vectors, left-handed, +z forward, y up, as OpenEXR defines it),
    // worldToNDC, screenWindowWidth and screenWindowCenter.
    const struct orl_view *view;
    bool srgb_primaries; // chromaticities of Rec. 709 / sRGB
    bool latlong; // envmap: OpenEXR's latitude-longitude map of all directions; only the
                  // pose of `view` is used
    const char *comments;
};

// Both are lossless. ZIP compresses renderings and layers well, PIZ grainy photographs.
#define ORL_EXR_COMPRESSIONS(NAME) NAME(ORL_EXR_ZIP, "zip") NAME(ORL_EXR_PIZ, "piz")
enum orl_exr_compression { ORL_EXR_COMPRESSIONS(ORL_ENUMERATOR) };

struct orl_exr_params {
    int width, height;
    struct orl_exr_channel channels[ORL_EXR_CHANNELS_MAX];
    int channel_count;
    enum orl_exr_compression compression;
    struct orl_exr_view_attributes attributes;
};

// Adds channel `index` of an interleaved F32 image, which must outlive params, under
// this name. False when there is no room or the name is too long.
bool orl_exr_add_channel(struct orl_exr_params *params, const char *name, bool half,
                         const struct orl_image *image, int index);
// Writes a file of scanlines, atomically.
enum orl_result orl_exr_write(const struct orl_log *log, const char *path,
                              const struct orl_exr_params *params) ORL_CHECK_RESULT;
// Writes a photograph as linear light, where the original has more than 8 bits (docs/reference/files.md, images_linear): half
// floats, channels R G B.
enum orl_result orl_linear_write(const struct orl_log *log, const char *path,
                                 const struct orl_image *image) ORL_CHECK_RESULT;
// Reads `count` named channels into an interleaved float image (at most 4).
// ORL_ERR_NOT_FOUND names the first channel that the file lacks.
enum orl_result orl_exr_read(const struct orl_log *log, const char *path,
                             const char *const *channels, int count,
                             struct orl_image *image) ORL_CHECK_RESULT;

#endif
