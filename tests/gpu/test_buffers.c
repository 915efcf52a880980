// Buffers: what is written to them comes in its turn, and textures show it.
#include "gpu_test.h"

enum { ROUNDS = 32 };

static char *dir;

// Counts in a buffer (mode 0), or notes what a texture shows of it (mode 1). It stands for
// fill/fill_pull.comp.
static const char shader[] =
    "layout(local_size_x = 1) in;\n"
    "layout(r32ui, binding = 0) readonly uniform uimageBuffer shown;\n"
    "layout(std430, binding = 0) buffer words { uint count, rest[3]; };\n"
    "layout(std430, binding = 1) buffer notes { uint seen[]; };\n"
    "layout(std140, binding = 0) uniform block { int mode, place; };\n"
    "void main()\n"
    "{\n"
    "    if (mode == 0)\n"
    "        atomicAdd(count, 1u);\n"
    "    else\n"
    "        seen[place] = imageLoad(shown, 0).r;\n"
    "}\n";

static struct orl_gpu *open_device(void)
{
    static struct orl_log log;
    log = orl_log_stderr(ORL_LOG_WARNING);
    const struct orl_gpu_params params = {.shader_dir = dir, .cache_dir = ""};
    struct orl_gpu *gpu;
    char *folder = test_path(dir, "fill"), *path = test_path(dir, "fill/fill_pull.comp");
    assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
    assert_int_equal(orl_file_write(NULL, path, shader, strlen(shader)), ORL_OK);
    assert_int_equal(orl_gpu_create(&log, &params, &gpu), ORL_OK);
    free(folder);
    free(path);
    return gpu;
}

// Whole buffers are written in every frame while the device may still read what they held.
static void a_texture_shows_what_was_written_last(void **state)
{
    (void)state;
    struct orl_gpu *gpu = open_device();
    struct orl_buf *words = NULL, *notes = NULL;
    uint32_t seen[ROUNDS];
    struct { int32_t mode, place, unused[2]; } block = {0};
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_FRAME, "words", 16, NULL, GL_R32UI, &words), ORL_OK);
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_FRAME, "notes", sizeof seen, NULL, 0, &notes),
                     ORL_OK);
    struct orl_dispatch d = {.prog = orl_prog_get(gpu, "fill/fill_pull.comp", NULL, NULL),
                             ORL_PARAMS(block), .bufs = {words, notes}, .images = {&words->texels}};
    for (uint32_t i = 0; i < ROUNDS; i++) {
        const uint32_t data[4] = {1000 * i};
        orl_buf_write(words, 0, sizeof data, data);
        block.place = (int32_t)i;
        for (block.mode = 0; block.mode < 2; block.mode++) {
            assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
            orl_gpu_dispatch(gpu, &d);
        }
    }
    orl_buf_read(notes, sizeof seen, seen);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    for (uint32_t i = 0; i < ROUNDS; i++)
        assert_int_equal(seen[i], 1000 * i + 1);
    orl_buf_destroy(gpu, &words);
    orl_buf_destroy(gpu, &notes);
    orl_gpu_destroy(&gpu);
}

// Between a clear and what reads the buffer, however much the device has yet to do.
static void a_write_comes_after_a_clear(void **state)
{
    (void)state;
    struct orl_gpu *gpu = open_device();
    struct orl_buf *words = NULL;
    struct orl_tex *work = NULL;
    const struct orl_tex_params params = {.width = 1024, .height = 1024, .format = GL_RGBA32F, .tag = "work"};
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_FRAME, "words", 4096, NULL, 0, &words), ORL_OK);
    assert_int_equal(orl_tex_create(gpu, &params, &work), ORL_OK);
    for (uint32_t i = 0; i < ROUNDS; i++) {
        const uint32_t data[4] = {i, 1, 1, 0};
        uint32_t seen[5];
        for (int k = 0; k < 4; k++)
            orl_tex_clear(work, 0);
        orl_buf_fill(words, 7);
        orl_buf_write(words, 0, sizeof data, data);
        orl_buf_read(words, sizeof seen, seen);
        assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
        assert_memory_equal(seen, data, sizeof data);
        assert_int_equal(seen[4], 7);
    }
    orl_tex_destroy(gpu, &work);
    orl_buf_destroy(gpu, &words);
    orl_gpu_destroy(&gpu);
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

int main(void)
{
    struct orl_gpu *gpu = gpu_test_device(); // or exit 77
    orl_gpu_destroy(&gpu);
    unsetenv("ORIEL_SHADER_DUMP"); // the check of all shaders knows those of the program
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_texture_shows_what_was_written_last, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_write_comes_after_a_clear, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("buffers", tests, NULL, NULL);
}
