#include "oriel/gpu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "gpu/internal.h"

static const char mesa_advice[] =
    "Oriel needs OpenGL 4.5 core through EGL; without a graphics card install Mesa's software "
    "renderer (Debian: libegl1 libgl1-mesa-dri)";

// The ways to open a display, in the order in which they are tried.
static EGLDisplay open_device_display(int index)
{
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") ||
        !eglQueryDevicesEXT((EGLint)ORL_COUNT(devices), devices, &count) || index >= count)
        return EGL_NO_DISPLAY;
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[index], NULL);
}

static EGLDisplay open_surfaceless_display(void)
{
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        return EGL_NO_DISPLAY;
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
}

// With robust access a shader that reads or writes outside of a buffer harms nobody, and with reset
// notification a device that was reset says so. Drivers need not offer either.
static EGLContext create_context(EGLDisplay display, EGLConfig config, bool debug)
{
    const EGLint attribs[] = {EGL_CONTEXT_MAJOR_VERSION, 4,
                              EGL_CONTEXT_MINOR_VERSION, 5,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                              EGL_CONTEXT_OPENGL_DEBUG, debug ? EGL_TRUE : EGL_FALSE,
                              EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                              EGL_LOSE_CONTEXT_ON_RESET,
                              EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                              EGL_NONE};
    enum { LEAST = 4 }; // pairs that must be granted: those ahead of the reset notification
    EGLint asked[ORL_COUNT(attribs)];
    for (int pairs = (int)ORL_COUNT(attribs) / 2; pairs >= LEAST; pairs--) {
        memcpy(asked, attribs, sizeof asked);
        asked[2 * pairs] = EGL_NONE;
        EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, asked);
        if (context != EGL_NO_CONTEXT)
            return context;
    }
    return EGL_NO_CONTEXT;
}

// Makes a context on `display` current. On failure returns false and leaves nothing allocated.
static bool open_context(struct orl_gpu *gpu, EGLDisplay display, bool debug)
{
    EGLint major, minor, config_count = 0;
    EGLConfig config = EGL_NO_CONFIG_KHR;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor))
        return false;
    const EGLint config_attribs[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                     EGL_NONE};
    if (eglBindAPI(EGL_OPENGL_API)) {
        if (!eglChooseConfig(display, config_attribs, &config, 1, &config_count) || !config_count)
            config = EGL_NO_CONFIG_KHR;
        gpu->context = create_context(display, config, debug);
        if (gpu->context != EGL_NO_CONTEXT &&
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, gpu->context)) {
            gpu->display = display;
            gpu->current = true;
            return true;
        }
        if (gpu->context != EGL_NO_CONTEXT)
            eglDestroyContext(display, gpu->context);
        gpu->context = EGL_NO_CONTEXT;
    }
    eglTerminate(display);
    return false;
}

static bool open_any_context(struct orl_gpu *gpu, bool debug)
{
    for (int i = 0; i < 16; i++)
        if (open_context(gpu, open_device_display(i), debug))
            return true;
    return open_context(gpu, open_surfaceless_display(), debug);
}

static void GLAPIENTRY on_debug(GLenum source, GLenum type, GLuint id, GLenum severity,
                                GLsizei length, const GLchar *message, const void *priv)
{
    struct orl_gpu *gpu = (struct orl_gpu *)(uintptr_t)priv;
    (void)source, (void)id, (void)length;
    if (type == GL_DEBUG_TYPE_PUSH_GROUP || type == GL_DEBUG_TYPE_POP_GROUP)
        return; // Oriel's own pass names, which are for frame debuggers
    bool bad = type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH;
    if (bad)
        gpu->failed = true;
    orl_logf(gpu->log, bad ? ORL_LOG_ERROR : ORL_LOG_DEBUG, "OpenGL: %s", message);
}

static void query_caps(struct orl_gpu_caps *caps)
{
    snprintf(caps->vendor, sizeof caps->vendor, "%s", (const char *)glGetString(GL_VENDOR));
    snprintf(caps->renderer, sizeof caps->renderer, "%s", (const char *)glGetString(GL_RENDERER));
    snprintf(caps->version, sizeof caps->version, "%s", (const char *)glGetString(GL_VERSION));
    caps->software = strstr(caps->renderer, "llvmpipe") || strstr(caps->renderer, "softpipe") ||
                     strstr(caps->renderer, "SWR");
    GLint64 block = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
    caps->max_storage_block = (size_t)block;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &caps->max_texture_size);
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &caps->max_buffer_texels);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &caps->max_texture_layers);
}

// A software driver that gets no memory for a thread ends the program by a segmentation fault. Each
// thread takes a stack and, of the C library, an arena.
static enum orl_result check_address_space(const struct orl_log *log)
{
    const uint64_t mib = 1 << 20, driver = 512 * mib, thread = 72 * mib;
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    uint64_t need = driver + thread * (uint64_t)(cores < 1 ? 1 : cores < 16 ? cores : 16);
    uint64_t left = orl_address_space_left();
    if (left >= need)
        return ORL_OK;
    return orl_fail(log, ORL_ERR_MEMORY, "the address space that ulimit -v leaves, %llu MiB, does not "
                    "suffice for a device, which needs about %llu MiB: raise the limit",
                    (unsigned long long)(left / mib), (unsigned long long)(need / mib));
}

enum orl_result orl_gpu_create(const struct orl_log *log, const struct orl_gpu_params *params,
                               struct orl_gpu **out)
{
    *out = NULL;
    struct orl_gpu *gpu = orl_array(log, 1, sizeof *gpu);
    ORL_TRY_MEMORY(gpu);
    enum orl_result result = ORL_OK;
    gpu->log = log;
    gpu->pass = -1;
    gpu->display = EGL_NO_DISPLAY;
    gpu->context = EGL_NO_CONTEXT;
    if (params && params->shader_dir && !(gpu->shader_dir = orl_strdup(log, params->shader_dir))) {
        result = ORL_ERR_MEMORY;
        goto fail;
    }
    if ((result = check_address_space(log)) != ORL_OK)
        goto fail;
    orl_mesa_cache_guard(log);
    if (!open_any_context(gpu, params && params->debug)) {
        result = orl_fail(log, ORL_ERR_GPU, "no usable OpenGL device (EGL error 0x%04x). %s",
                          (unsigned)eglGetError(), mesa_advice);
        goto fail;
    }
    if (epoxy_gl_version() < 45) {
        result = orl_fail(log, ORL_ERR_GPU, "found OpenGL %s (%s). %s",
                          (const char *)glGetString(GL_VERSION),
                          (const char *)glGetString(GL_RENDERER), mesa_advice);
        goto fail;
    }
    query_caps(&gpu->caps);
    if (!params || !params->debug)
        orl_program_cache_open(gpu, params ? params->cache_dir : NULL);
    if (params && params->debug) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(on_debug, gpu);
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    orl_logf(log, ORL_LOG_DEBUG, "device: %s, OpenGL %s", gpu->caps.renderer, gpu->caps.version);
    *out = gpu;
    return ORL_OK;
fail:
    orl_gpu_destroy(&gpu);
    return result;
}

void orl_gpu_destroy(struct orl_gpu **handle)
{
    struct orl_gpu *gpu = *handle;
    if (!gpu)
        return;
    for (size_t i = 0; i < gpu->memory_count; i++)
        if (gpu->memory[i].objects)
            orl_logf(gpu->log, ORL_LOG_ERROR, "%s: %u objects still alive", gpu->memory[i].tag, gpu->memory[i].objects);
    if (gpu->current) {
        orl_gpu_free_programs(gpu);
        orl_gpu_free_raster(gpu);
        orl_gpu_free_queries(gpu);
        eglMakeCurrent(gpu->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(gpu->display, gpu->context);
        eglTerminate(gpu->display);
    }
    free(gpu->shader_dir);
    free(gpu);
    *handle = NULL;
}

const struct orl_gpu_caps *orl_gpu_caps(const struct orl_gpu *gpu)
{
    return &gpu->caps;
}

const struct orl_log *orl_gpu_log(const struct orl_gpu *gpu)
{
    return gpu->log;
}

size_t orl_gpu_bytes(const struct orl_gpu *gpu)
{
    return gpu->live_bytes;
}

// A lost context is never whole again: what it held is gone, and reads give anything.
static void lose(struct orl_gpu *gpu, const char *cause)
{
    if (!gpu->lost)
        orl_logf(gpu->log, ORL_LOG_ERROR, "the graphics device was reset%s: what was being made is "
                 "lost. Run the command again; prepare and densify take --resume", cause);
    gpu->lost = true;
}

static void check_lost(struct orl_gpu *gpu)
{
    switch (glGetGraphicsResetStatus()) {
    case GL_NO_ERROR:
        break;
    case GL_GUILTY_CONTEXT_RESET:
        lose(gpu, " for a fault of this frame, or since a pass took too long");
        break;
    case GL_INNOCENT_CONTEXT_RESET:
        lose(gpu, " by another program");
        break;
    default:
        lose(gpu, "");
    }
}

bool orl_gpu_check_errors(struct orl_gpu *gpu, const char *where)
{
    bool clean = true;
    for (GLenum error; (error = glGetError()) != GL_NO_ERROR; clean = false) {
        gpu->failed = true;
        if (error == GL_CONTEXT_LOST) {
            check_lost(gpu);
            lose(gpu, "");
            return false;
        }
        if (error == GL_OUT_OF_MEMORY)
            orl_logf(gpu->log, ORL_LOG_ERROR, "%s: the device is out of memory; Oriel holds %zu "
                     "MiB of it. Give less with --max-vram MIB, or a smaller --size", where,
                     gpu->live_bytes >> 20);
        else
            orl_logf(gpu->log, ORL_LOG_ERROR, "%s: OpenGL error 0x%04x", where, (unsigned)error);
    }
    return clean;
}

enum orl_result orl_gpu_finish(struct orl_gpu *gpu)
{
    glFinish();
    orl_gpu_check_errors(gpu, "finish");
    check_lost(gpu);
    bool failed = gpu->failed || gpu->lost;
    gpu->failed = false;
    return failed ? ORL_ERR_GPU : ORL_OK;
}
