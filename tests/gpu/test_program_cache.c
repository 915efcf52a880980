// Linked programs kept between devices: found again, and compiled anew when damaged.
#include <math.h>

#include "gpu_test.h"
#include "core/file.h"
#include "shared/render_blocks.h"

static char *dir;

static size_t loaded; // programs that were taken from the cache

static void count_loaded(void *priv, enum orl_log_level level, const char *message)
{
    (void)priv, (void)level;
    loaded += strncmp(message, "shaders/", strlen("shaders/")) == 0 && strstr(message, " loaded in ");
}

static struct orl_gpu *open_device(const char *cache_dir)
{
    static const struct orl_log log = {ORL_LOG_DEBUG, count_loaded, NULL};
    loaded = 0;
    struct orl_gpu *gpu = NULL;
    struct orl_gpu_params params = {.cache_dir = cache_dir};
    assert_int_equal(orl_gpu_create(&log, &params, &gpu), ORL_OK);
    return gpu;
}

// Whether a device finds mean.comp in the cache; what it has must work: it begins a sum of square roots.
static size_t create_and_run(const char *defines)
{
    enum { SIDE = 8 };
    struct orl_gpu *gpu = open_device(dir);
    struct orl_tex *picture = NULL, *sum = NULL;
    float values[SIDE * SIDE][4];
    for (int i = 0; i < 4 * SIDE * SIDE; i++)
        values[i / 4][i % 4] = (float)i;
    struct orl_tex_params params = {.width = SIDE, .height = SIDE, .format = GL_RGBA32F, .tag = "t"};
    assert_int_equal(orl_tex_create(gpu, &params, &picture), ORL_OK);
    assert_int_equal(orl_tex_create(gpu, &params, &sum), ORL_OK);
    orl_tex_write(picture, GL_RGBA, GL_FLOAT, values);
    struct image_block block = {.image_size = {SIDE, SIDE}, .pictures = {0, 2}};
    struct orl_dispatch d = {.prog = orl_prog_get(gpu, "fill/mean.comp", NULL, defines),
                             ORL_PARAMS(block), .images = {picture, sum}, .size = {SIDE, SIDE}};
    orl_gpu_dispatch(gpu, &d);
    orl_tex_read(sum, 0, GL_RGBA, GL_FLOAT, sizeof values, values);
    for (int i = 0; i < 4 * SIDE * SIDE; i++) {
        double expected = i % 4 < 3 ? sqrt(i) : i;
        assert_float_equal(values[i / 4][i % 4], expected, 1e-5 * i);
    }
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_tex_destroy(gpu, &picture);
    orl_tex_destroy(gpu, &sum);
    orl_gpu_destroy(&gpu);
    return loaded;
}

static void list_entries(struct orl_names *names)
{
    char *programs = orl_path_join(NULL, dir, "programs");
    *names = (struct orl_names){0};
    if (orl_path_is_dir(programs))
        assert_int_equal(orl_dir_list(NULL, programs, names), ORL_OK);
    free(programs);
}

static size_t count_entries(void)
{
    struct orl_names names;
    list_entries(&names);
    size_t count = names.count;
    orl_names_finish(&names);
    return count;
}

static int set_up(void **state)
{
    (void)state;
    dir = test_dir_make();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    test_dir_remove(dir);
    return 0;
}

static void the_second_device_finds_it(void **state)
{
    (void)state;
    assert_int_equal(create_and_run(NULL), 0);
    assert_int_equal(count_entries(), 1);
    assert_int_equal(create_and_run(NULL), 1);
    assert_int_equal(count_entries(), 1);
}

static void other_sources_are_other_entries(void **state)
{
    (void)state;
    assert_int_equal(create_and_run(NULL), 0);
    assert_int_equal(create_and_run("SOMETHING"), 0);
    assert_int_equal(count_entries(), 2);
}

// Keeps `keep` bytes of the one entry, one of them changed.
static void damage(size_t keep, size_t changed)
{
    struct orl_names names;
    list_entries(&names);
    assert_int_equal(names.count, 1);
    char *programs = orl_path_join(NULL, dir, "programs");
    char *path = orl_path_join(NULL, programs, names.items[0]);
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, path, 1 << 26, &data, &size), ORL_OK);
    if (changed < size)
        data[changed] ^= 0x10;
    assert_int_equal(orl_file_write(NULL, path, data, keep < size ? keep : size), ORL_OK);
    free(data);
    free(path);
    free(programs);
    orl_names_finish(&names);
}

static void damaged_entries_are_made_again(void **state)
{
    (void)state;
    // The magic, the hash, the size, the format, the binary; then cut short, then empty.
    static const struct {
        size_t keep, changed;
    } cases[] = {{SIZE_MAX, 0}, {SIZE_MAX, 9}, {SIZE_MAX, 17}, {SIZE_MAX, 21}, {SIZE_MAX, 100},
                 {200, SIZE_MAX}, {10, SIZE_MAX}, {0, SIZE_MAX}};
    assert_int_equal(create_and_run(NULL), 0);
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        damage(cases[i].keep, cases[i].changed);
        assert_int_equal(create_and_run(NULL), 0);
        assert_int_equal(create_and_run(NULL), 1);
    }
}

static void it_can_be_switched_off(void **state)
{
    (void)state;
    setenv("ORIEL_CACHE", "off", 1);
    assert_int_equal(create_and_run(NULL), 0);
    unsetenv("ORIEL_CACHE");
    assert_int_equal(count_entries(), 0);
}

static void a_folder_that_cannot_be_made_is_no_error(void **state)
{
    (void)state;
    char *plain = dir;
    dir = orl_path_join(NULL, plain, "file");
    assert_int_equal(orl_file_write(NULL, dir, "x", 1), ORL_OK);
    assert_int_equal(create_and_run(NULL), 0);
    free(dir);
    dir = plain;
}

// Mesa maps its cache, which ends a program when the disk is full: it is used where there is room.
static void mesa_keeps_nothing_on_a_full_disk(void **state)
{
    (void)state;
    struct orl_gpu *gpu;
    unsetenv("MESA_SHADER_CACHE_DISABLE");
    setenv("MESA_SHADER_CACHE_DIR", dir, 1);
    gpu = open_device("");
    orl_gpu_destroy(&gpu);
    assert_null(getenv("MESA_SHADER_CACHE_DISABLE"));
    setenv("MESA_SHADER_CACHE_DIR", "/proc/mesa", 1); // a file system without any room
    gpu = open_device("");
    orl_gpu_destroy(&gpu);
    assert_string_equal(getenv("MESA_SHADER_CACHE_DISABLE"), "true");
    unsetenv("MESA_SHADER_CACHE_DIR");
}

int main(void)
{
    unsetenv("ORIEL_SHADER_DUMP"); // with which there is no cache
    struct orl_gpu *gpu = gpu_test_device();
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    orl_gpu_destroy(&gpu);
    if (formats == 0) {
        fprintf(stderr, "skipped: this driver has no program binaries\n");
        return 77;
    }
    unsetenv("ORIEL_CACHE");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_second_device_finds_it, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_sources_are_other_entries, set_up, tear_down),
        cmocka_unit_test_setup_teardown(damaged_entries_are_made_again, set_up, tear_down),
        cmocka_unit_test_setup_teardown(it_can_be_switched_off, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_folder_that_cannot_be_made_is_no_error, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(mesa_keeps_nothing_on_a_full_disk, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("program cache", tests, NULL, NULL);
}
