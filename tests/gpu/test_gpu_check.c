// ORIEL_GPU_CHECK: wrong indexes and values that are not finite are found and named.
#include "core/memory.h"
#include "gpu_check/gpu_check.h"
#include "gpu_test.h"

enum { SIDE = 4 };

static char *dir;
static char *messages;

// A device that takes fill/fill_pull.comp from here.
static struct orl_gpu *open_device(const char *shader)
{
    const struct orl_gpu_params params = {.shader_dir = dir};
    struct orl_gpu *gpu;
    char *path = test_path(dir, "fill/fill_pull.comp");
    assert_int_equal(orl_file_make_folder(NULL, path), ORL_OK);
    assert_int_equal(orl_file_write(NULL, path, shader, strlen(shader)), ORL_OK);
    assert_int_equal(orl_gpu_create(NULL, &params, &gpu), ORL_OK);
    free(path);
    return gpu;
}

// Runs the shader once with a buffer of 8 floats and a texture of SIDE x SIDE. What is found is in
// `messages`.
static enum orl_result run(const char *shader, uint32_t word)
{
    size_t size;
    free(messages);
    gpu_check = (struct gpu_check){.to = open_memstream(&messages, &size)};
    struct orl_gpu *gpu = open_device(shader);
    struct orl_buf *buf = NULL, *other = NULL;
    struct orl_tex *tex = NULL;
    struct orl_tex_params params = {.width = SIDE, .height = SIDE, .format = GL_RGBA16F,
                                    .tag = "picture"};
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_FRAME, "list", 8 * sizeof(float), NULL, 0, &buf),
                     ORL_OK);
    assert_int_equal(orl_buf_create(gpu, ORL_OWNER_FRAME, "rows", 8 * sizeof(float), NULL, GL_R32F, &other),
                     ORL_OK);
    assert_int_equal(orl_tex_create(gpu, &params, &tex), ORL_OK);
    orl_tex_clear(tex, 0); // some drivers leave what was in the memory
    struct { uint32_t word, rest[3]; } block = {word, {0}};
    struct orl_dispatch d = {.prog = orl_prog_get(gpu, "fill/fill_pull.comp", NULL, NULL),
                             ORL_PARAMS(block), .bufs = {buf}, .textures = {tex}, .images = {tex, &other->texels}};
    orl_gpu_dispatch(gpu, &d);
    enum orl_result result = orl_gpu_finish(gpu);
    orl_tex_destroy(gpu, &tex);
    orl_buf_destroy(gpu, &buf);
    orl_buf_destroy(gpu, &other);
    orl_gpu_destroy(&gpu);
    fclose(gpu_check.to);
    return result;
}

#define HEAD                                                                   \
    "layout(local_size_x = 4) in;\n"                                           \
    "layout(binding = 0) uniform sampler2D fetched;\n"                         \
    "layout(rgba16f, binding = 0) uniform image2D picture;\n"                  \
    "layout(r32f, binding = 1) readonly uniform imageBuffer rows;\n"           \
    "layout(std140, binding = 0) uniform block { uint word; };\n"              \
    "layout(std430, binding = 0) buffer list { float kept, values[]; };\n"     \
    "struct pair { float a[2], b[3]; };\n"                                     \
    "void main()\n{\n"                                                         \
    "    int i = int(gl_LocalInvocationID.x), n = int(word);\n"                \
    "    pair p[2] = pair[2](pair(float[](1.0, 2.0), float[](1.0, 2.0, 3.0)),\n" \
    "                        pair(float[2](1.0, 2.0), float[](1.0, 2.0, 3.0)));\n"

static void right_indexes_are_no_fault(void **state)
{
    (void)state;
    assert_int_equal(run(HEAD
                         "    values[i + 3] = 1.0;\n" // 7 elements behind `kept`
                         "    values[uint(i)] += imageLoad(rows, 2 * i).x;\n"
                         "    p[i & 1].b[n] += texelFetch(fetched, ivec2(i, 3), 0).x; // [9]\n"
                         "    imageStore(picture, ivec2(i, 0), vec4(p[i & 1].b[n]));\n"
                         "    imageStore(picture, ivec2(i, -1), vec4(1.0));\n" // defined
                         "}\n", 2), ORL_OK);
    assert_string_equal(messages, "");
    assert_int_equal(gpu_check.runs, 1);
    assert_int_equal(gpu_check.targets, 3);
    assert_int_equal(gpu_check.faults, 0);
}

// What `shader` is said of, and that it is a failure.
static void expect(const char *shader, uint32_t word, const char *message)
{
    assert_int_equal(run(shader, word), ORL_ERR_GPU);
    if (!strstr(messages, message))
        fail_msg("not \"%s\", but:\n%s", message, messages);
}

static void wrong_indexes_are_named(void **state)
{
    (void)state;
    expect(HEAD "    values[i + n] = 1.0;\n}\n", 4,
           "shaders/fill/fill_pull.comp:13: values[i + n]: index 7, but the size is 7; 1 wrong "
           "indexes in one dispatch of shaders/fill/fill_pull.comp\n");
    expect(HEAD "\n    /* a\n comment [1] */ values[i - n] = 1.0;\n}\n", 1,
           "fill_pull.comp:15: values[i - n]: index -1, but the size is 7; 1 wrong");
    expect(HEAD "    values[word + 0xfffffff0u] = 1.0;\n}\n", 1, "index -1, but the size is 7; 4 ");
    expect(HEAD "    p[0].b[n] = 1.0;\n    values[0] = p[0].b[0] + p[1].a[n];\n}\n", 2,
           "fill_pull.comp:14: p[1].a[n]: index 2, but the size is 2; 4 ");
    expect(HEAD "    values[0] = vec3(1.0)[0] + imageLoad(rows, i + n).x;\n}\n", 5,
           "fill_pull.comp:13: imageLoad(rows, i + n): index 8, but the size is 8; 1 ");
    expect(HEAD "    values[0] = texelFetch(fetched, ivec2(i, n), 0).x;\n}\n", 4,
           "fill_pull.comp:13: texelFetch(fetched, ivec2(i, n), 0): index 4, but the size is 4; 4");
    expect(HEAD "#ifdef NONE\n#endif\n    values[values[0] < 1.0 ? n : i] = 1.0;\n}\n", 9,
           "fill_pull.comp:15: values[values[0] < 1.0 ? n : i]: index 9, but the size is 7");
}

static void values_that_are_not_finite_are_counted(void **state)
{
    (void)state;
    expect(HEAD "    float bad = uintBitsToFloat(i > 1 ? word : 0u);\n"
                "    imageStore(picture, ivec2(i, 1), vec4(bad));\n}\n", 0x7fc00000,
           "shaders/fill/fill_pull.comp: texture \"picture\", level 0: 8 NaN and 0 "
           "infinite values, the first at pixel (2, 1), channel 0\n");
    expect(HEAD "    float far = uintBitsToFloat(i > 0 ? word : 0u);\n"
                "    imageStore(picture, ivec2(i, 1), vec4(1.0, 0.0, far, 0.0));\n}\n", 0xff800000,
           "0 NaN and 3 infinite values, the first at pixel (1, 1), channel 2\n");
    expect(HEAD "    values[i] = uintBitsToFloat(i == 2 ? word : 0u);\n}\n", 0x7f800000,
           "values[0] of buffer \"list\": 0 NaN and 1 infinite values, the first is number 2\n");
}

// What cannot be read as an index is left as it is, whatever it is.
static void odd_text_keeps_its_lines(void **state)
{
    (void)state;
    static const char *const texts[] = {"", "a[", "]", "[i]", "a[b[c[d]", "a.[i]", "f(x)[i]", "/*",
                                        "// a[i]", "imageLoad(", "imageLoad(a", "texelFetch(a, b",
                                        "a[i\n+\n1]\n", "x.y[\n]\n", ", b[i]", "1[i]", "a[i](b)"};
    for (size_t i = 0; i < ORL_COUNT(texts); i++) {
        size_t lines[2] = {0};
        char *text = orl_format(NULL, "#version 450\n%s\n", texts[i]);
        char *checked = gpu_check_text(text), *from = strstr(checked, gpu_check_index);
        assert_non_null(from);
        from += strlen(gpu_check_index);
        for (const char *p = strchr(text, '\n'); *p; p++)
            lines[0] += *p == '\n';
        for (const char *p = from; *p && strncmp(p, "// site ", 8) != 0; p++)
            lines[1] += *p == '\n';
        assert_int_equal(lines[0], lines[1]);
        free(checked);
        free(text);
    }
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
    unsetenv("ORIEL_SHADER_DUMP"); // wrong shaders are not for other compilers
    setenv("ORIEL_GPU_CHECK", "1", 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(right_indexes_are_no_fault, set_up, tear_down),
        cmocka_unit_test_setup_teardown(wrong_indexes_are_named, set_up, tear_down),
        cmocka_unit_test_setup_teardown(values_that_are_not_finite_are_counted, set_up, tear_down),
        cmocka_unit_test(odd_text_keeps_its_lines),
    };
    return cmocka_run_group_tests_name("GPU check", tests, NULL, NULL);
}
