// A device that is reset, or out of memory.
#include <epoxy/egl.h>
#include <string.h>

#include "wall_scene.h"

static struct orl_gpu *gpu;
static char messages[8192];

static void collect(void *priv, enum orl_log_level level, const char *message)
{
    (void)priv, (void)level;
    size_t used = strlen(messages);
    snprintf(messages + used, sizeof messages - used, "%s\n", message);
}

static struct orl_gpu *device(void)
{
    static const struct orl_log log = {ORL_LOG_ERROR, collect, NULL};
    struct orl_gpu *made;
    assert_int_equal(orl_gpu_create(&log, NULL, &made), ORL_OK);
    return made;
}

static GLenum status;

static GLenum GLAPIENTRY reset_status(void)
{
    return status;
}

// A frame of a device that was reset is no frame, then and for good.
static void a_reset_gives_no_frame(void **state)
{
    (void)state;
    static const struct {
        GLenum status;
        const char *says;
    } cases[] = {{GL_GUILTY_CONTEXT_RESET, "took too long"},
                 {GL_INNOCENT_CONTEXT_RESET, "by another program"},
                 {GL_UNKNOWN_CONTEXT_RESET, "was reset:"}};
    PFNGLGETGRAPHICSRESETSTATUSPROC real = epoxy_glGetGraphicsResetStatus;
    epoxy_glGetGraphicsResetStatus = reset_status;
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct fixture f;
        struct orl_renderer *renderer;
        struct orl_frame frame;
        struct orl_view view = look_from(0, 0, 0, 32, 30);
        const struct orl_render_params *params = &orl_method_find(NULL, "oriel")->params;
        gpu = device();
        setup(&f, false);
        add_photo(&f, view, red);
        assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
        status = GL_NO_ERROR;
        assert_int_equal(orl_renderer_draw(renderer, &view, params, NULL, &frame), ORL_OK);
        orl_frame_finish(&frame);
        messages[0] = '\0';
        status = cases[i].status;
        assert_int_equal(orl_renderer_draw(renderer, &view, params, NULL, &frame), ORL_ERR_GPU);
        assert_null(frame.color.data);
        assert_non_null(strstr(messages, cases[i].says));
        // GL tells of a reset once. Nothing of before it is there any more.
        status = GL_NO_ERROR;
        messages[0] = '\0';
        assert_int_equal(orl_renderer_draw(renderer, &view, params, NULL, &frame), ORL_ERR_GPU);
        assert_null(frame.color.data);
        assert_string_equal(messages, ""); // said once
        orl_renderer_destroy(&renderer);
        teardown(&f);
        orl_gpu_destroy(&gpu);
    }
    epoxy_glGetGraphicsResetStatus = real;
}

static void expect_refusal(enum orl_result made)
{
    assert_int_equal(made, ORL_ERR_GPU);
    assert_non_null(strstr(messages, "--max-vram"));
    assert_int_equal(orl_gpu_finish(gpu), ORL_ERR_GPU);
    messages[0] = '\0';
}

// More memory than any device has: an error that says what to do, and the device goes on.
static void too_little_memory_is_an_error_with_advice(void **state)
{
    (void)state;
    gpu = device();
    const struct orl_gpu_caps *caps = orl_gpu_caps(gpu);
    struct orl_tex_params params = {.width = caps->max_texture_size,
                                    .height = caps->max_texture_size,
                                    .layers = caps->max_texture_layers,
                                    .format = GL_RGBA32F, .tag = "everything"};
    struct orl_tex *tex;
    struct orl_buf *buf;
    messages[0] = '\0';
    enum orl_result made = orl_tex_create(gpu, &params, &tex);
    if (made == ORL_OK) { // NVIDIA's 580 looks for the memory when a texture is first used, and takes long
        orl_tex_destroy(gpu, &tex);
        orl_gpu_destroy(&gpu);
        skip();
    }
    expect_refusal(made);
    expect_refusal(orl_buf_create(gpu, ORL_OWNER_FRAME, "everything", (size_t)1 << 46, NULL, 0, &buf));
    assert_int_equal(orl_gpu_bytes(gpu), 0);
    params = (struct orl_tex_params){.width = 4, .height = 4, .format = GL_R32F, .tag = "small"};
    assert_int_equal(orl_tex_create(gpu, &params, &tex), ORL_OK);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_tex_destroy(gpu, &tex);
    orl_gpu_destroy(&gpu);
}

static PFNEGLCREATECONTEXTPROC real_create;
static int asked;        // pairs of the two below in the first context that is asked for
static bool grants_none; // a driver that knows neither

static EGLContext EGLAPIENTRY count_and_create(EGLDisplay display, EGLConfig config,
                                               EGLContext share, const EGLint *attribs)
{
    int found = 0;
    for (const EGLint *pair = attribs; *pair != EGL_NONE; pair += 2)
        found += (pair[0] == EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY &&
                  pair[1] == EGL_LOSE_CONTEXT_ON_RESET) ||
                 (pair[0] == EGL_CONTEXT_OPENGL_ROBUST_ACCESS && pair[1] == EGL_TRUE);
    if (asked < 0)
        asked = found;
    return grants_none && found ? EGL_NO_CONTEXT : real_create(display, config, share, attribs);
}

// A reset is told only to a context that asked for it, and some drivers do not tell.
static void resets_are_asked_for(void **state)
{
    (void)state;
    real_create = epoxy_eglCreateContext;
    epoxy_eglCreateContext = count_and_create;
    for (int i = 0; i < 2; i++) {
        asked = -1;
        grants_none = i == 1;
        gpu = device();
        assert_int_equal(asked, 2);
        assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
        orl_gpu_destroy(&gpu);
    }
    epoxy_eglCreateContext = real_create;
}

int main(void)
{
    gpu = gpu_test_device(); // or exit 77
    orl_gpu_destroy(&gpu);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_reset_gives_no_frame),
        cmocka_unit_test(resets_are_asked_for),
        cmocka_unit_test(too_little_memory_is_an_error_with_advice),
    };
    return cmocka_run_group_tests_name("reset", tests, NULL, NULL);
}
