// Opening scenes: whole, plain, unfinished, damaged.
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "oriel/scene.h"
#include "scene/tuned_settings.h"
#include "test.h"

static void save(const char *dir, const char *name, const char *text)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    char *slash = strrchr(path, '/');
    *slash = '\0';
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    *slash = '/';
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
}

static void drop(const char *dir, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    assert_int_equal(unlink(path), 0);
}

static const char images[] = "1 1 0 0 0 0 0 0 1 a.jpg\n1 1 1 2 2 2\n"
                             "2 1 0 0 0 0 0 2 1 b.jpg\n1 1 1\n"
                             "3 1 0 0 0 0 0 4 1 c.jpg\n\n";
static const char cloud[] =
    "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n%s"
    "end_header\n";

// A plain workspace: three photographs at z = 0, -2, -4, sparse points at z = 3 and 8.
static char *plain(void)
{
    char *dir = test_dir_make(), text[2048];
    save(dir, "sparse/cameras.txt", "1 PINHOLE 64 48 50 51 32 24\n");
    save(dir, "sparse/images.txt", images);
    save(dir, "sparse/points3D.txt", "1 0 0 3 9 9 9 0.1\n2 0 0 8 9 9 9 0.1\n");
    // A grid of 5 x 5 points, a tenth apart, and one in mid-air.
    snprintf(text, sizeof text, cloud, 26, "");
    for (int i = 0; i < 25; i++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%g %g 3 1 2 3\n", 0.1 * (i % 5 - 2),
                 0.1 * (i / 5 - 2));
    }
    strcat(text, "0 0 1 1 2 3\n");
    save(dir, "fused.ply", text);
    for (const char *name = "abc"; *name; name++) {
        snprintf(text, sizeof text, "images/%c.jpg", *name);
        save(dir, text, "not looked at here");
    }
    return dir;
}

static const char manifest[] =
    "{\"version\": 1, \"photographs\": [\n"
    "{\"name\": \"a.jpg\", \"split\": \"train\", \"exposure_ev\": -1.5, \"series\": 0},\n"
    "{\"name\": \"c.jpg\", \"split\": \"train\", \"exposure_ev\": null, \"gain\": [1, 2, 0.5]},\n"
    "{\"name\": \"b.jpg\", \"split\": \"test\", \"exposure_ev\": 0.5, \"series\": 1}]}\n";

// As prepare leaves it.
static char *whole(void)
{
    char *dir = plain(), text[1024];
    snprintf(text, sizeof text, cloud, 4, "property float radius\n");
    strcat(text, "0 0 3 1 2 3 0.5\n1 0 3 1 2 3 0\n0 1 3 1 2 3 0.25\n1 1 3 1 2 3 -4\n");
    save(dir, "points.ply", text);
    save(dir, "scene.json", manifest);
    drop(dir, "fused.ply");
    return dir;
}

static void opens_a_plain_workspace(void **state)
{
    (void)state;
    char *dir = plain();
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_int_equal(scene->photo_count, 3);
    assert_string_equal(scene->photos[1].name, "b.jpg");
    assert_float_equal(scene->photos[1].view.camera.fy, 51, 0);
    assert_float_equal(scene->photos[1].view.cam_from_world.t[2], 2, 0);
    assert_false(scene->photos[1].test);
    assert_float_equal(scene->photos[1].gain[1], 1, 0);
    // Distances seen: a to 3 and 8, b to 5.
    assert_float_equal(scene->photo_distance, 5, 1e-9);
    assert_float_equal(scene->near_distance, 0.75, 1e-9); // a quarter of 3
    assert_int_equal(scene->points.count, 25); // without the one in mid-air
    assert_float_equal(scene->points.radius[12], sqrt(0.02), 1e-6); // the sixth neighbour
    assert_float_equal(scene->points.normal[0][2], -1, 1e-6);   // towards the photographs
    assert_int_equal(orl_scene_find_photo(scene, "c.jpg"), 2);
    assert_int_equal(orl_scene_find_photo(scene, "c"), 2);
    assert_int_equal(orl_scene_find_photo(scene, "d"), -1);
    assert_int_equal(orl_scene_find_photo(scene, ""), -1);
    char *path = strdup(orl_scene_file(scene, 0, ORL_FILE_PHOTO).text), expected[4096];
    snprintf(expected, sizeof expected, "%s/images/a.jpg", dir);
    assert_string_equal(path, expected);
    free(path);
    orl_scene_destroy(&scene);
    assert_null(scene);
    test_dir_remove(dir);
}

static void opens_a_prepared_scene(void **state)
{
    (void)state;
    char *dir = whole();
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(&log, dir, &scene), ORL_OK);
    assert_true(scene->photos[1].test);
    assert_false(scene->photos[0].test);
    assert_true(scene->photos[0].has_exposure);
    assert_float_equal(scene->photos[0].exposure_ev, -1.5, 0);
    assert_false(scene->photos[2].has_exposure);
    assert_float_equal(scene->photos[2].gain[1], 2, 0);
    assert_float_equal(scene->photos[2].gain[2], 0.5, 0);
    assert_int_equal(scene->photos[1].series, 1);
    assert_int_equal(scene->points.count, 2); // those with a radius
    assert_float_equal(scene->points.radius[1], 0.25, 0);
    assert_non_null(strstr(said.text, "2 of 4 points have no radius"));
    orl_scene_destroy(&scene);
    test_dir_remove(dir);
}

static void refuses_an_unfinished_scene(void **state)
{
    (void)state;
    char *dir = whole();
    drop(dir, "scene.json");
    save(dir, "fused.ply", "old");
    save(dir, ".oriel/stages.json",
         "{\"plan\": [\"collect\", \"calibrate\", \"fuse\"], \"done\": {\"collect\": {}}}");
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(&log, dir, &scene), ORL_ERR_DATA);
    assert_null(scene);
    assert_non_null(strstr(said.text, "missing: calibrate"));
    assert_non_null(strstr(said.text, "--resume"));
    test_dir_remove(dir);
}

static void refuses_damage(void **state)
{
    (void)state;
    static const struct {
        const char *file, *text, *why; // text NULL: the file is removed
        enum orl_result result;
    } cases[] = {
        {"scene.json", "{\"version\": 1,\n \"photographs\": [}", "line 2 (byte 33): ",
         ORL_ERR_FORMAT},
        {"scene.json", "", "byte 0", ORL_ERR_FORMAT},
        {"scene.json", "[1]", "not a JSON object", ORL_ERR_FORMAT},
        {"scene.json", "{}", "no \"version\"", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 99}", "version 99 is newer", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[]}", "lists 0, but the sparse model has 3",
         ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[{\"name\": \"a.jpg\", \"split\": \"x\"}, 1, 2]}",
         "photograph a.jpg: \"split\"", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[{\"name\": \"z.jpg\"}, 1, 2]}",
         "z.jpg: not in the sparse model", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[{\"name\": \"a.jpg\", \"split\": \"train\","
         " \"gain\": [1, 0, 1]}, 1, 2]}", "\"gain\"", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[{\"name\": \"a.jpg\", \"split\": \"train\","
         " \"exposure_ev\": 1e9}, 1, 2]}", "\"exposure_ev\"", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[{\"name\": \"a.jpg\", \"split\": \"train\","
         " \"vignette\": [0, 1]}, 1, 2]}", "\"vignette\"", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[{\"name\": \"a.jpg\", \"split\": \"train\","
         " \"response\": 0}, 1, 2]}", "\"response\"", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"responses\": [{\"linear\": [[0, 1]]}]}",
         "256 numbers that rise to 1", ORL_ERR_FORMAT},
        {"scene.json", "{\"version\": 1, \"photographs\": "
         "[{\"name\": \"a.jpg\", \"split\": \"train\"},"
         " {\"name\": \"a.jpg\", \"split\": \"train\"}, 2]}", "listed twice", ORL_ERR_FORMAT},
        {"points.ply", NULL, "points.ply is missing", ORL_ERR_NOT_FOUND},
        {"points.ply", "ply\nformat", "points.ply: byte 4", ORL_ERR_FORMAT},
        {"images/b.jpg", NULL, "images/b.jpg: this photograph is missing", ORL_ERR_NOT_FOUND},
        {"sparse/cameras.txt", "1 SIMPLE_RADIAL 64 48 50 32 24 0.1\n", "not undistorted",
         ORL_ERR_DATA},
        {"sparse/cameras.txt", NULL, "no COLMAP model", ORL_ERR_NOT_FOUND},
        {"sparse/images.txt", "", "no photographs", ORL_ERR_DATA},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        char *dir = whole();
        if (cases[i].text)
            save(dir, cases[i].file, cases[i].text);
        else
            drop(dir, cases[i].file);
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_scene *scene;
        enum orl_result result = orl_scene_open(&log, dir, &scene);
        if (result != cases[i].result || !strstr(said.text, cases[i].why))
            fail_msg("case %zu: %s: \"%s\" does not say \"%s\"", i, orl_result_name(result),
                     said.text, cases[i].why);
        assert_null(scene);
        test_dir_remove(dir);
    }
}

static void refuses_what_is_no_scene(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(&log, "/nowhere/at/all", &scene), ORL_ERR_NOT_FOUND);
    assert_non_null(strstr(said.text, "/nowhere/at/all"));
    char *dir = test_dir_make();
    assert_int_equal(orl_scene_open(&log, dir, &scene), ORL_ERR_NOT_FOUND);
    assert_non_null(strstr(said.text, "not a scene"));
    test_dir_remove(dir);
}

// A curve of 256 numbers as JSON: v/255 to the power of `gamma`.
static void write_curve(char *text, size_t size, double gamma)
{
    for (int v = 0; v < 256; v++) {
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%.9g%s", v ? "," : "[", pow(v / 255.0, gamma),
                 v == 255 ? "]" : "");
    }
}

static void reads_optics(void **state)
{
    (void)state;
    static char text[20000];
    char *dir = whole();
    strcpy(text, "{\"version\": 1, \"responses\": [{\"camera\": \"X\", \"linear\": [");
    for (int c = 1; c <= 3; c++) {
        write_curve(text, sizeof text, c);
        strcat(text, c < 3 ? "," : "]}],");
    }
    strcat(text, "\"photographs\": [{\"name\": \"a.jpg\", \"split\": \"train\","
                 " \"response\": 0, \"vignette\": [-0.25, 0.5, 0]},"
                 "{\"name\": \"b.jpg\", \"split\": \"train\", \"response\": null},"
                 "{\"name\": \"c.jpg\", \"split\": \"train\"}]}");
    save(dir, "scene.json", text);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_int_equal(scene->response_count, 1);
    assert_float_equal(scene->responses[0].linear[1][128], pow(128 / 255.0, 2), 1e-6);
    assert_float_equal(scene->responses[0].linear[2][255], 1, 0);
    assert_int_equal(scene->photos[0].response, 0);
    assert_int_equal(scene->photos[1].response, -1);
    assert_int_equal(scene->photos[2].response, -1);
    assert_float_equal(scene->photos[0].vignette[0], -0.25, 0);
    assert_float_equal(scene->photos[0].vignette[1], 0.5, 0);
    assert_float_equal(scene->photos[1].vignette[0], 0, 0);
    orl_scene_destroy(&scene);
    test_dir_remove(dir);
}

static void warns_of_other_points(void **state)
{
    (void)state;
    char *dir = whole(), text[4096];
    snprintf(text, sizeof text, "{\"checksums\": {\"points.ply\": \"xxh3:0\"}, %s", manifest + 1);
    save(dir, "scene.json", text);
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(&log, dir, &scene), ORL_OK);
    assert_non_null(strstr(said.text, "changed since the scene was made"));
    orl_scene_destroy(&scene);
    test_dir_remove(dir);
}

static void reads_tuned_settings(void **state)
{
    (void)state;
    char *dir = whole(), text[2048];
    struct orl_scene *scene;
    snprintf(text, sizeof text, "%.*s, \"tuned\": {\"m\": {\"settings\": {\"a\": 2, \"b\": "
             "0.5}}, \"n\": {}, \"o\": {\"settings\": {\"a\": \"off\"}}}}",
             (int)(strrchr(manifest, '}') - manifest), manifest);
    save(dir, "scene.json", text);
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_int_equal(scene->tuned_count, 3);
    assert_string_equal(scene->tuned[1].method, "m");
    assert_string_equal(scene->tuned[1].key, "b");
    assert_float_equal(scene->tuned[1].value, 0.5, 0);
    assert_null(scene->tuned[1].name);
    assert_string_equal(scene->tuned[2].method, "o");
    assert_string_equal(scene->tuned[2].name, "off");
    orl_scene_destroy(&scene);
    static const char *const bad[] = {"true", "null", "[1]", "{}"};
    for (size_t i = 0; i < ORL_COUNT(bad); i++) {
        snprintf(text, sizeof text, "%.*s, \"tuned\": {\"m\": {\"settings\": {\"a\": %s}}}}",
                 (int)(strrchr(manifest, '}') - manifest), manifest, bad[i]);
        save(dir, "scene.json", text);
        assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_ERR_FORMAT);
    }
    test_dir_remove(dir);
}

static void reads_how_to_render(void **state)
{
    (void)state;
    char *dir = whole(), text[2048];
    struct orl_scene *scene;
    const struct orl_scene_defaults chosen = {(char[]){"points"}, (char[]){"bc1"}, 3, true};
    save(dir, "scene.json", manifest);
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_null(scene->defaults.method);
    assert_false(scene->defaults.depth_half);
    orl_scene_destroy(&scene);
    json_t *value = orl_defaults_json(&chosen);
    char *render = json_dumps(value, 0);
    json_decref(value);
    snprintf(text, sizeof text, "%.*s, \"render\": %s}", (int)(strrchr(manifest, '}') - manifest),
             manifest, render);
    free(render);
    save(dir, "scene.json", text);
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_string_equal(scene->defaults.method, "points");
    assert_string_equal(scene->defaults.textures, "bc1");
    assert_int_equal(scene->defaults.depth_divide, 3);
    assert_true(scene->defaults.depth_half);
    orl_scene_destroy(&scene);
    static const char *const bad[] = {"\"method\": 3", "\"textures\": []",
                                      "\"depth_divide\": 0", "\"depth_bits\": \"x\""};
    for (size_t i = 0; i < ORL_COUNT(bad); i++) {
        snprintf(text, sizeof text, "%.*s, \"render\": {%s}}",
                 (int)(strrchr(manifest, '}') - manifest), manifest, bad[i]);
        save(dir, "scene.json", text);
        assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_ERR_FORMAT);
    }
    test_dir_remove(dir);
}

static void reads_ground(void **state)
{
    (void)state;
    char *dir = whole(), text[2048];
    const char *format = "%.*s, \"ground\": %s}";
    int length = (int)(strrchr(manifest, '}') - manifest);
    struct orl_scene *scene;
    snprintf(text, sizeof text, format, length, manifest,
             "{\"plane\": [0, -0.6, 0.8, 2.5], \"height\": 1.5}");
    save(dir, "scene.json", text);
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_float_equal(scene->ground.height, 1.5, 0);
    assert_float_equal(scene->ground.plane[2], 0.8, 0);
    assert_float_equal(scene->ground.plane[3], 2.5, 0);
    orl_scene_destroy(&scene);
    snprintf(text, sizeof text, format, length, manifest, "null");
    save(dir, "scene.json", text);
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_float_equal(scene->ground.height, 0, 0);
    orl_scene_destroy(&scene);
    static const char *const bad[] = {
        "1", "{}", "{\"plane\": [0, 1, 0, 1]}", "{\"plane\": [0, 1, 0, 1], \"height\": 0}",
        "{\"plane\": [0, 1, 1], \"height\": 1}", "{\"plane\": [0, 1, 1, 1], \"height\": 1}",
        "{\"plane\": [0, 1, 0, \"x\"], \"height\": 1}"};
    for (size_t i = 0; i < ORL_COUNT(bad); i++) {
        snprintf(text, sizeof text, format, length, manifest, bad[i]);
        save(dir, "scene.json", text);
        assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_ERR_FORMAT);
    }
    test_dir_remove(dir);
}

static void reads_backdrop(void **state)
{
    (void)state;
    char *dir = whole(), text[2048];
    static const struct {
        const char *told;
        enum orl_result result;
        bool rests;
    } cases[] = {{"\"rests\"", ORL_OK, true}, {"\"moves\"", ORL_OK, false},
                 {"\"\"", ORL_ERR_FORMAT, false}, {"true", ORL_ERR_FORMAT, false}};
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(NULL, dir, &scene), ORL_OK);
    assert_false(scene->backdrop_rests);
    orl_scene_destroy(&scene);
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        snprintf(text, sizeof text, "%.*s, \"backdrop\": %s}",
                 (int)(strrchr(manifest, '}') - manifest), manifest, cases[i].told);
        save(dir, "scene.json", text);
        assert_int_equal(orl_scene_open(NULL, dir, &scene), cases[i].result);
        if (cases[i].result != ORL_OK)
            continue;
        assert_int_equal(scene->backdrop_rests, cases[i].rests);
        orl_scene_destroy(&scene);
    }
    test_dir_remove(dir);
}

static void links_out_of_the_scene_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"images/b.jpg", "images", "sparse", "sparse/images.txt",
                                        "points.ply", "scene.json", "images_linear/b.jpg.exr",
                                        "masks/b.jpg.png", "background/b.jpg.png", "occluders/b.jpg.png"};
    char *elsewhere = test_dir_make(), from[4096], to[4096];
    struct orl_scene *scene;
    for (size_t i = 0; i < ORL_COUNT(names); i++) {
        char *dir = whole();
        save(dir, "images_linear/b.jpg.exr", "not looked at here");
        save(dir, "masks/b.jpg.png", "nor this");
        save(dir, "background/b.jpg.png", "nor this");
        save(dir, "occluders/b.jpg.png", "nor this");
        snprintf(from, sizeof from, "%s/%s", dir, names[i]);
        snprintf(to, sizeof to, "%s/moved", elsewhere);
        assert_int_equal(rename(from, to), 0);
        assert_int_equal(symlink(to, from), 0);
        struct said said;
        struct orl_log log = log_to(&said);
        assert_int_equal(orl_scene_open(&log, dir, &scene), ORL_ERR_DATA);
        assert_non_null(strstr(said.text, "leads out of the scene"));
        assert_int_equal(orl_dir_remove(NULL, to), ORL_OK);
        test_dir_remove(dir);
    }
    char *dir = whole();
    snprintf(from, sizeof from, "%s/images/b.jpg", dir);
    assert_int_equal(unlink(from), 0);
    assert_int_equal(symlink("a.jpg", from), 0);
    snprintf(to, sizeof to, "%s/scene", elsewhere);
    assert_int_equal(symlink(dir, to), 0);
    assert_int_equal(orl_scene_open(NULL, to, &scene), ORL_OK);
    orl_scene_destroy(&scene);
    test_dir_remove(dir);
    test_dir_remove(elsewhere);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opens_a_plain_workspace),
        cmocka_unit_test(opens_a_prepared_scene),
        cmocka_unit_test(refuses_an_unfinished_scene),
        cmocka_unit_test(refuses_damage),
        cmocka_unit_test(refuses_what_is_no_scene),
        cmocka_unit_test(reads_optics),
        cmocka_unit_test(warns_of_other_points),
        cmocka_unit_test(reads_tuned_settings),
        cmocka_unit_test(reads_how_to_render),
        cmocka_unit_test(reads_ground),
        cmocka_unit_test(reads_backdrop),
        cmocka_unit_test(links_out_of_the_scene_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
