// What the page of a walk sends, and what a scene's walk.json says.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "fuzz.h"
#include "io/picture.h"
#include "walk/choices.h"
#include "walk/content_internal.h"
#include "walk/internal.h"
#include "walk/rendering.h"

static void use_request(const struct walk_request *request)
{
    const struct orl_camera *camera = &request->view.camera;
    fuzz_require(!orl_view_problem(&request->view), "a requested view is usable");
    fuzz_require(request->quality >= 1 && request->quality <= 100 && request->layer < WALK_LAYERS &&
                     isfinite(request->tone.exposure_ev) && request->pick_count <= WALK_PICKS_MAX,
                 "a request is within its limits");
    for (size_t i = 0; i < request->pick_count; i++)
        fuzz_require(request->picks[i][0] >= 0 && request->picks[i][0] < camera->width &&
                         request->picks[i][1] >= 0 && request->picks[i][1] < camera->height,
                     "picks lie in the frame");
}

static void report(void *priv, size_t done, size_t total, const char *file)
{
    (void)priv;
    (void)file;
    fuzz_require(done <= total, "no more frames than there are");
}

static bool is_cancelled(void *priv)
{
    (void)priv;
    return true;
}

// Up to the first frame, which needs a device.
static void use_rendering(const struct orl_scene *scene, const json_t *message)
{
    const struct orl_progress progress = {.cancelled = is_cancelled};
    const struct walk_rendering rendering = {.log = &fuzz_log, .scene = scene,
                                             .progress = &progress, .report = report};
    fuzz_require(orl_walk_rendering_run(&rendering, message) != ORL_OK, "nothing is drawn");
    if (orl_dir_remove(&fuzz_log, fuzz_path("renders")) != ORL_OK)
        abort();
}

static void use_choice(const struct orl_scene *scene, const json_t *message,
                       struct orl_choice *choice)
{
    char problem[WALK_PROBLEM_BYTES];
    if (orl_walk_choice_read(scene, message, choice, problem) != ORL_OK)
        fuzz_require(*problem, "a refused choice says why");
    (void)orl_walk_moving_params(&choice->params);
    json_decref(orl_walk_choice_json(choice));
}

// The first photograph, larger than a thumbnail.
static void save_photo(void)
{
    struct orl_image image;
    fuzz_require(orl_dir_make(NULL, fuzz_path("images")) == ORL_OK &&
                     orl_image_init(NULL, &image, 200, 40, 3, ORL_PIXEL_U8) == ORL_OK,
                 "there is room");
    memset(image.data, 99, orl_image_bytes(&image));
    fuzz_require(orl_jpeg_write(NULL, fuzz_path("images/a.jpg"), &image, 50, NULL) == ORL_OK,
                 "a photograph can be written");
    orl_image_finish(&image);
}

static void use_path(const struct content *content, const char *text, size_t size)
{
    struct content_file file;
    char *path = strndup(text, size);
    save_photo();
    if (orl_content_find(content, path, &file) == ORL_OK) {
        fuzz_require(file.type && (file.data || !file.size), "a file has a type and its bytes");
        fuzz_require(strcmp(path, "/map.bin") != 0 || file.size == 32, "the map has both points");
        free(file.data);
    }
    fuzz_require(orl_dir_remove(NULL, fuzz_path("images")) == ORL_OK, "files can be removed");
    free(path);
}

// What the server does with a message (server.c), but for drawing. One that starts with a slash
// stands for the path of a request for a file.
static void use_message(struct content *content, struct orl_choice *choice, const char *text,
                        size_t size)
{
    struct walk_request request;
    if (size && *text == '/')
        use_path(content, text, size);
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, NULL);
    json_t *settings = json_object_get(root, "save");
    if (orl_walk_request_read(root, &request))
        use_request(&request);
    else if (orl_walk_rendering_asked(root))
        use_rendering(content->scene, root);
    else if (orl_walk_choice_asked(root))
        use_choice(content->scene, root, choice);
    else if (settings)
        (void)!orl_content_change(content, settings);
    json_decref(root);
}

// Gives the content a published site of one file.
static void add_site(struct content *content)
{
    fuzz_require(orl_names_add(NULL, &content->site_paths, "points/coarse.bin") == ORL_OK, "memory");
    content->site = calloc(1, sizeof *content->site);
    content->site[0] = (struct site_file){calloc(4, 1), 4};
}

// Serves a scene with the walk.json that is there. message: of a client; NULL: none.
static void walk(const struct orl_bytes *message)
{
    struct orl_scene *scene = fuzz_scene();
    fuzz_require(orl_points_init(NULL, &scene->points, 2) == ORL_OK, "memory");
    struct orl_names none = {0};
    struct content content;
    struct orl_choice choice;
    fuzz_require(orl_choice_make(&fuzz_log, scene, ORL_SAMPLE_SRGB, NULL, &none, &choice) == ORL_OK,
                 "a scene has a method");
    if (orl_content_init(&fuzz_log, scene, NULL, true, &choice, &content) == ORL_OK) {
        struct orl_view view;
        add_site(&content);
        if (orl_walk_settings_start(content.settings, &scene->photos[0].view.camera, &view))
            fuzz_require(!orl_view_problem(&view), "the start view is usable");
        if (message)
            use_message(&content, &choice, message->data, message->size);
        orl_content_finish(&content);
    }
    orl_scene_destroy(&scene);
}

void fuzz_walk_message(const uint8_t *data, size_t size)
{
    // It arrives in two parts, of which either may be empty.
    struct orl_bytes message = {0};
    const char *text = (const char *)data;
    unlink(fuzz_path("walk.json"));
    fuzz_require(orl_bytes_add(&fuzz_log, &message, text, size / 2) == ORL_OK &&
                     orl_bytes_add(&fuzz_log, &message, text + size / 2, size - size / 2) ==
                         ORL_OK && message.size == size, "a message is put together");
    walk(&message);
    free(message.data);
}

void fuzz_walk_settings(const uint8_t *data, size_t size)
{
    fuzz_save("walk.json", data, size);
    walk(NULL);
}
