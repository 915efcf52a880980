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
    bool bound = eglBindAPI(EGL_OPENGL_API);
    if (!bound || !eglChooseConfig(display, config_attribs, &config, 1, &config_count) || !config_count)
        config = EGL_NO_CONFIG_KHR;
    gpu->display = display;
    gpu->context = bound ? create_context(display, config, debug) : EGL_NO_CONTEXT;
    gpu->current = gpu->context != EGL_NO_CONTEXT &&
                   eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, gpu->context);
    if (gpu->current)
        return true;
    if (gpu->context != EGL_NO_CONTEXT)
        eglDestroyContext(display, gpu->context);
    eglTerminate(display);
    return false;
}

// By a device, else by Mesa's platform without surfaces.
static bool open_any_context(struct orl_gpu *gpu, bool debug)
{
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") &&
        !eglQueryDevicesEXT((EGLint)ORL_COUNT(devices), devices, &count))
        count = 0;
    for (EGLint i = 0; i < count; i++)
        if (open_context(gpu, eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL), debug))
            return true;
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") &&
           open_context(gpu, eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL),
                        debug);
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

static enum orl_result open_gpu(struct orl_gpu *gpu, const struct orl_gpu_params *params)
{
    const struct orl_log *log = gpu->log;
    if (params->shader_dir) {
        gpu->shader_dir = orl_strdup(log, params->shader_dir);
        ORL_TRY_MEMORY(gpu->shader_dir);
    }
    ORL_TRY(check_address_space(log));
    orl_mesa_cache_guard(log);
    if (!open_any_context(gpu, params->debug))
        return orl_fail(log, ORL_ERR_GPU, "no usable OpenGL device (EGL error 0x%04x). %s",
                        (unsigned)eglGetError(), mesa_advice);
    if (epoxy_gl_version() < 45)
        return orl_fail(log, ORL_ERR_GPU, "found OpenGL %s (%s). %s", (const char *)glGetString(GL_VERSION),
                        (const char *)glGetString(GL_RENDERER), mesa_advice);
    query_caps(&gpu->caps);
    glCreateVertexArrays(1, &gpu->vertex_array);
    glCreateFramebuffers(1, &gpu->framebuffer);
    if (params->debug) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(on_debug, gpu);
    } else {
        orl_program_cache_open(gpu, params->cache_dir);
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    orl_logf(log, ORL_LOG_DEBUG, "device: %s, OpenGL %s", gpu->caps.renderer, gpu->caps.version);
    return ORL_OK;
}

enum orl_result orl_gpu_create(const struct orl_log *log, const struct orl_gpu_params *params,
                               struct orl_gpu **out)
{
    static const struct orl_gpu_params usual = {0};
    struct orl_gpu *gpu = *out = orl_array(log, 1, sizeof *gpu);
    ORL_TRY_MEMORY(gpu);
    gpu->log = log;
    gpu->pass = -1;
    enum orl_result result = open_gpu(gpu, params ? params : &usual);
    if (result != ORL_OK)
        orl_gpu_destroy(out);
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
        glDeleteVertexArrays(1, &gpu->vertex_array);
        glDeleteFramebuffers(1, &gpu->framebuffer);
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
    GLenum status = glGetGraphicsResetStatus();
    if (status != GL_NO_ERROR)
        lose(gpu, status == GL_GUILTY_CONTEXT_RESET ? " for a fault of this frame, or since a pass took too long"
                  : status == GL_INNOCENT_CONTEXT_RESET ? " by another program" : "");
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
