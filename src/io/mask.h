// Masks as files: which pixels of a photograph count. Black pixels do not; see docs/guide/photographs.md.
#ifndef ORL_IO_MASK_H
#define ORL_IO_MASK_H

#include "core/file.h"
#include "oriel/image.h"

// Reads a mask as U8 x1: 255 for pixels that count, 0 for others.
// - Alpha that is not the same everywhere is the mask, whatever the colours are.
// - Else a pixel counts if its brightest channel is at least half of the brightest in the file: soft
//   edges and the noise of JPEG count as the nearer side. Where that brightest is below 32 the values
//   are labels (0 and 1, numbers of classes), and all but 0 count.
// - A clearly coloured pixel counts, however dark, since colours tell classes apart.
// With alpha_only the colours are those of a photograph: mask->data stays NULL where the alpha is missing
// or the same everywhere.
enum orl_result orl_mask_read(const struct orl_log *log, const char *path, bool alpha_only,
                              struct orl_image *mask) ORL_CHECK_RESULT;
// Number of the mask's pixels that count.
size_t orl_mask_count(const struct orl_image *mask);

// Finds the mask of the photograph `name`, such as "cam1/0001.jpg", in `dir`: cam1/0001.jpg.png,
// cam1/0001.png, or with another extension of a picture, or with "_mask" or ".mask" before the
// extension. False: there is none.
bool orl_mask_find(const char *dir, const char *name, char path[ORL_PATH_SIZE]);

#endif
