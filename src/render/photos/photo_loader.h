// Private to src/render: reads photographs from disk, one by one or on a thread of its own.
#ifndef ORL_RENDER_PHOTO_LOADER_H
#define ORL_RENDER_PHOTO_LOADER_H

#include "oriel/image.h"
#include "oriel/scene.h"

// Reads a photograph as RGB; with `linear`, its linear version if there is one. The caller releases
// the image. ORL_ERR_FORMAT: it has not the size of its camera.
enum orl_result orl_photo_read(const struct orl_log *log, const struct orl_scene *scene,
                               size_t index, bool linear, struct orl_image *image) ORL_CHECK_RESULT;
// Reads a photograph's mask likewise: U8 x1.
enum orl_result orl_photo_mask_read(const struct orl_log *log, const struct orl_scene *scene,
                                    size_t photo, struct orl_image *mask);

struct photo_loader;
// Starts a thread that reads photographs. It logs errors, so `log` must allow a call from another
// thread, or be NULL. The scene must outlive *out.
enum orl_result orl_photo_loader_create(const struct orl_log *log, const struct orl_scene *scene,
                                        bool linear, struct photo_loader **out) ORL_CHECK_RESULT;
// Waits for the photograph that is being read.
void orl_photo_loader_destroy(struct photo_loader **loader);
// Asks for photographs, the most urgent first, and forgets what was asked for before.
void orl_photo_loader_want(struct photo_loader *loader, const size_t *photos, size_t count);

enum photo_arrival { PHOTO_AWAITED, PHOTO_READ, PHOTO_FAILED };
// PHOTO_READ: *image is the photograph, which the caller owns now. It is not read again until it is
// asked for again; one that has failed never is. now: waits while it is being read, and otherwise
// leaves it to the caller.
enum photo_arrival orl_photo_loader_take(struct photo_loader *loader, size_t photo, bool now,
                                         struct orl_image *image);
// Waits until what was asked for is read, or takes as much memory as it may.
void orl_photo_loader_wait(struct photo_loader *loader);

#endif
