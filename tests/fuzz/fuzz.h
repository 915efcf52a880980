// Readers of files from elsewhere, each as a function of bytes: for libFuzzer (run.sh) and to
// replay inputs that are kept (replay.c).
#ifndef ORL_TESTS_FUZZ_H
#define ORL_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include "oriel/log.h"

struct fuzz_target {
    const char *name;                               // of its folder of inputs, too
    void (*run)(const uint8_t *data, size_t size);
};
extern const struct fuzz_target fuzz_targets[]; // ended by a NULL name

// The target of this name; NULL, said on stderr, when there is none.
const struct fuzz_target *fuzz_target_find(const char *name);

// Runs it within limits of memory like those of a small machine.
void fuzz_limit_memory(void);

// Logs to nowhere, but formats every message.
extern const struct orl_log fuzz_log;

// The path of a file in a folder of this process, removed at its end.
const char *fuzz_path(const char *name);
// Writes it there, or ends the program.
void fuzz_save(const char *name, const uint8_t *data, size_t size);
// Saves an input that is `count` files, each but the last ahead by its length in two bytes.
void fuzz_save_parts(const char *const *names, size_t count, const uint8_t *data, size_t size);
// Ends the program: a reader broke a promise.
void fuzz_require(bool promise, const char *what);

struct orl_scene;
// A scene of three photographs without files, in the folder of this process.
struct orl_scene *fuzz_scene(void);

void fuzz_colmap_binary(const uint8_t *data, size_t size);
void fuzz_colmap_text(const uint8_t *data, size_t size);
void fuzz_depth_map(const uint8_t *data, size_t size);
void fuzz_ply(const uint8_t *data, size_t size);
void fuzz_lod(const uint8_t *data, size_t size);
void fuzz_manifest(const uint8_t *data, size_t size);
void fuzz_stages(const uint8_t *data, size_t size);
void fuzz_path_json(const uint8_t *data, size_t size);
void fuzz_path_text(const uint8_t *data, size_t size);
void fuzz_exposures(const uint8_t *data, size_t size);
void fuzz_exif(const uint8_t *data, size_t size);
void fuzz_jpeg(const uint8_t *data, size_t size);
void fuzz_png(const uint8_t *data, size_t size);
void fuzz_stream(const uint8_t *data, size_t size);
void fuzz_tiff(const uint8_t *data, size_t size);
void fuzz_heif(const uint8_t *data, size_t size);
void fuzz_exr(const uint8_t *data, size_t size);
void fuzz_raw(const uint8_t *data, size_t size);
void fuzz_options(const uint8_t *data, size_t size);
void fuzz_shader(const uint8_t *data, size_t size);
void fuzz_cameras_json(const uint8_t *data, size_t size);
void fuzz_workspace(const uint8_t *data, size_t size);
void fuzz_mesh(const uint8_t *data, size_t size);
void fuzz_database(const uint8_t *data, size_t size);
void fuzz_walk_message(const uint8_t *data, size_t size);
void fuzz_walk_settings(const uint8_t *data, size_t size);

#endif
