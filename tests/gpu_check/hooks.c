// Stands between Oriel and the driver: gpu_check.h.
#include "gpu_check/gpu_check.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
    RECORD_BINDING = 7, // index.glsl
    MESSAGES_MAX = 32,  // faults beyond are counted only
    ATTACHMENTS_MAX = 8,
    NAME_MAX_BYTES = 128,
};

// The driver's own function: that of epoxy's name is ours now.
#define DRIVER(type, function) ((type)eglGetProcAddress(#function))

struct gpu_check gpu_check;

static const char *setting(const char *name)
{
    const char *value = getenv(name);
    return value && *value ? value : NULL;
}

static bool is_checking(void)
{
    const char *value = setting("ORIEL_GPU_CHECK");
    return value && strcmp(value, "1") == 0;
}

// Counts a fault, which is an error of OpenGL; true if there is still room for a message.
static bool count_fault(void)
{
    glEnable(GL_NONE);
    return ++gpu_check.faults <= MESSAGES_MAX;
}

static FILE *to(void)
{
    return gpu_check.to ? gpu_check.to : stderr;
}

static GLuint program_in_use(void)
{
    GLint program = 0;
    DRIVER(PFNGLGETINTEGERVPROC, glGetIntegerv)(GL_CURRENT_PROGRAM, &program);
    return (GLuint)program;
}

// The name that Oriel gave an object; of a program, the file of its first stage.
static const char *label_of(GLenum kind, GLuint id, char name[NAME_MAX_BYTES])
{
    glGetObjectLabel(kind, id, NAME_MAX_BYTES, NULL, name);
    return name;
}

// --- sources ---

static const char *stage_suffix(GLint type)
{
    return type == GL_VERTEX_SHADER ? "vert" : type == GL_FRAGMENT_SHADER ? "frag" : "comp";
}

// Named by a hash of the text (FNV-1a), so that each program is there once.
static void dump(const char *dir, const char *text, GLint type)
{
    uint64_t hash = 0xcbf29ce484222325u;
    char path[4096];
    for (const char *p = text; *p; p++)
        hash = (hash ^ (unsigned char)*p) * 0x100000001b3u;
    snprintf(path, sizeof path, "%s/%016llx.%s", dir, (unsigned long long)hash, stage_suffix(type));
    FILE *file = mkdir(dir, 0777) == 0 || errno == EEXIST ? fopen(path, "w") : NULL;
    if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        abort();
    }
}

static void APIENTRY shader_source(GLuint shader, GLsizei count, const GLchar *const *texts,
                                   const GLint *lengths)
{
    const char *dir = setting("ORIEL_SHADER_DUMP");
    GLint type;
    glGetShaderiv(shader, GL_SHADER_TYPE, &type);
    char *checked = is_checking() && type == GL_COMPUTE_SHADER ? gpu_check_text(texts[0]) : NULL;
    const GLchar *text = checked ? checked : texts[0];
    if (dir)
        dump(dir, text, type);
    DRIVER(PFNGLSHADERSOURCEPROC, glShaderSource)(shader, count, &text, lengths);
    free(checked);
}

static void APIENTRY get_integer(GLenum name, GLint *value)
{
    DRIVER(PFNGLGETINTEGERVPROC, glGetIntegerv)(name, value);
    if (name == GL_NUM_PROGRAM_BINARY_FORMATS && (is_checking() || setting("ORIEL_SHADER_DUMP")))
        *value = 0; // without formats Oriel has no cache
}

// --- indexes ---

struct record {
    uint32_t count, site;
    int32_t first, size;
};

// What the source of the program notes of an index.
static void tell_site(GLuint program, uint32_t site)
{
    GLuint shader = 0;
    GLint length = 0;
    char mark[32];
    glGetAttachedShaders(program, 1, NULL, &shader);
    glGetShaderiv(shader, GL_SHADER_SOURCE_LENGTH, &length);
    char *text = calloc((size_t)length + 1, 1);
    glGetShaderSource(shader, length, NULL, text);
    int size = snprintf(mark, sizeof mark, "\n// site %u: ", (unsigned)site);
    const char *note = strstr(text, mark);
    if (note)
        fprintf(to(), "%.*s", (int)strcspn(note + size, "\n"), note + size);
    free(text);
}

static void check_indexes(GLuint program, GLuint buffer)
{
    struct record record;
    char name[NAME_MAX_BYTES];
    glGetNamedBufferSubData(buffer, 0, sizeof record, &record);
    if (!record.count || !count_fault())
        return;
    tell_site(program, record.site);
    fprintf(to(), ": index %d, but the size is %d; %u wrong indexes in one dispatch of shaders/%s\n",
            (int)record.first, (int)record.size, (unsigned)record.count,
            label_of(GL_PROGRAM, program, name));
}

// --- values ---

struct finding {
    size_t nan, infinite, first; // first: index of the first of them
};

static bool find(const float *values, size_t count, struct finding *found)
{
    *found = (struct finding){0};
    gpu_check.targets++;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i]))
            continue;
        if (!found->nan && !found->infinite)
            found->first = i;
        *(isnan(values[i]) ? &found->nan : &found->infinite) += 1;
    }
    return (found->nan || found->infinite) && count_fault();
}

static unsigned float_channels(GLint format)
{
    switch (format) {
    case GL_R16F:
    case GL_R32F:
        return 1;
    case GL_RG16F:
    case GL_RG32F:
        return 2;
    case GL_RGBA16F:
    case GL_RGBA32F:
        return 4;
    default: // integers; formats that hold finite values alone
        return 0;
    }
}

// Searches one level of a texture; layer < 0: all layers.
static void check_texture(GLuint program, GLuint texture, int level, int layer)
{
    static const GLenum formats[] = {0, GL_RED, GL_RG, 0, GL_RGBA};
    GLint width, height, layers, format;
    char names[2][NAME_MAX_BYTES];
    struct finding found;
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_WIDTH, &width);
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_HEIGHT, &height);
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_DEPTH, &layers);
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_INTERNAL_FORMAT, &format);
    unsigned channels = float_channels(format);
    if (!channels)
        return;
    layers = layer < 0 ? layers : 1;
    size_t count = (size_t)width * (size_t)height * (size_t)layers * channels;
    float *values = calloc(count, sizeof *values);
    glGetTextureSubImage(texture, level, 0, 0, layer < 0 ? 0 : layer, width, height, layers,
                         formats[channels], GL_FLOAT, (GLsizei)(count * sizeof *values), values);
    if (find(values, count, &found)) {
        size_t pixel = found.first / channels;
        fprintf(to(), "shaders/%s: texture \"%s\", level %d: %zu NaN and %zu infinite values, the "
                "first at pixel (%zu, %zu), channel %zu\n", label_of(GL_PROGRAM, program, names[0]),
                label_of(GL_TEXTURE, texture, names[1]), level, found.nan, found.infinite,
                pixel % (size_t)width, pixel / (size_t)width, found.first % channels);
    }
    free(values);
}

// The pictures that a program may write: of what GL tells, all that it reads or writes.
static void check_images(GLuint program)
{
    GLint count = 0, size, unit, texture, level, layered, layer;
    GLenum type;
    char name[NAME_MAX_BYTES];
    glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
    for (GLuint i = 0; i < (GLuint)count; i++) {
        glGetActiveUniform(program, i, sizeof name, NULL, &size, &type, name);
        if (type != GL_IMAGE_2D && type != GL_IMAGE_2D_ARRAY)
            continue;
        glGetUniformiv(program, glGetUniformLocation(program, name), &unit);
        glGetIntegeri_v(GL_IMAGE_BINDING_NAME, (GLuint)unit, &texture);
        glGetIntegeri_v(GL_IMAGE_BINDING_LEVEL, (GLuint)unit, &level);
        glGetIntegeri_v(GL_IMAGE_BINDING_LAYERED, (GLuint)unit, &layered);
        glGetIntegeri_v(GL_IMAGE_BINDING_LAYER, (GLuint)unit, &layer);
        if (texture)
            check_texture(program, (GLuint)texture, level, layered ? -1 : layer);
    }
}

// Searches an array of float or of vectors, which a program writes or reads at `binding`.
static void check_array(GLuint program, GLuint binding, const char *name, size_t offset)
{
    GLint id, whole = 0;
    GLint64 start, size;
    char names[2][NAME_MAX_BYTES];
    struct finding found;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, binding, &id);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, binding, &start);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, binding, &size);
    if (!id)
        return;
    glGetNamedBufferParameteriv((GLuint)id, GL_BUFFER_SIZE, &whole);
    size_t bytes = (size_t)(size ? size : whole - start);
    size_t count = bytes > offset ? (bytes - offset) / sizeof(float) : 0;
    float *values = count ? calloc(count, sizeof *values) : NULL;
    if (!values)
        return;
    glGetNamedBufferSubData((GLuint)id, (GLintptr)start + (GLintptr)offset,
                            (GLsizeiptr)(count * sizeof *values), values);
    if (find(values, count, &found))
        fprintf(to(), "shaders/%s: %s of buffer \"%s\": %zu NaN and %zu infinite values, the first "
                "is number %zu\n", label_of(GL_PROGRAM, program, names[0]), name,
                label_of(GL_BUFFER, (GLuint)id, names[1]), found.nan, found.infinite, found.first);
    free(values);
}

// The floating point arrays that end the buffers of a program, as the driver tells of them.
static void check_arrays(GLuint program)
{
    enum { TYPE, OFFSET, BLOCK, ASKED };
    static const GLenum asked[ASKED] = {GL_TYPE, GL_OFFSET, GL_BLOCK_INDEX};
    static const GLenum binding_asked = GL_BUFFER_BINDING;
    GLint count = 0, got[ASKED], binding = 0;
    glGetProgramInterfaceiv(program, GL_BUFFER_VARIABLE, GL_ACTIVE_RESOURCES, &count);
    for (GLuint i = 0; i < (GLuint)count; i++) {
        char name[NAME_MAX_BYTES] = "";
        glGetProgramResourceiv(program, GL_BUFFER_VARIABLE, i, ASKED, asked, ASKED, NULL, got);
        if (got[TYPE] != GL_FLOAT && got[TYPE] != GL_FLOAT_VEC2 && got[TYPE] != GL_FLOAT_VEC4)
            continue;
        glGetProgramResourceiv(program, GL_SHADER_STORAGE_BLOCK, (GLuint)got[BLOCK], 1,
                               &binding_asked, 1, NULL, &binding);
        glGetProgramResourceName(program, GL_BUFFER_VARIABLE, i, sizeof name, NULL, name);
        check_array(program, (GLuint)binding, name, (size_t)got[OFFSET]);
    }
}

// --- dispatches and draws ---

// An empty record of wrong indexes where the program looks for it; 0: nothing is checked.
static GLuint begin(void)
{
    static const struct record none;
    GLuint record = 0;
    if (!is_checking())
        return 0;
    glCreateBuffers(1, &record);
    glNamedBufferStorage(record, sizeof none, &none, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RECORD_BINDING, record);
    return record;
}

static void end(GLuint record)
{
    GLuint program = program_in_use();
    if (!record)
        return;
    gpu_check.runs++;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    check_indexes(program, record);
    glDeleteBuffers(1, &record);
    check_images(program);
    check_arrays(program);
}

static void APIENTRY dispatch(GLuint x, GLuint y, GLuint z)
{
    GLuint record = begin();
    DRIVER(PFNGLDISPATCHCOMPUTEPROC, glDispatchCompute)(x, y, z);
    end(record);
}

static void APIENTRY dispatch_indirect(GLintptr offset)
{
    GLuint record = begin();
    DRIVER(PFNGLDISPATCHCOMPUTEINDIRECTPROC, glDispatchComputeIndirect)(offset);
    end(record);
}

static void check_targets(void)
{
    GLint framebuffer = 0, texture;
    if (!is_checking())
        return;
    gpu_check.runs++;
    DRIVER(PFNGLGETINTEGERVPROC, glGetIntegerv)(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    for (GLuint i = 0; i < ATTACHMENTS_MAX; i++) {
        texture = 0;
        glGetNamedFramebufferAttachmentParameteriv((GLuint)framebuffer, GL_COLOR_ATTACHMENT0 + i,
                                                   GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &texture);
        if (texture)
            check_texture(program_in_use(), (GLuint)texture, 0, -1);
    }
}

static void APIENTRY draw_elements(GLenum mode, GLsizei count, GLenum type, const void *indices,
                                   GLsizei instances)
{
    DRIVER(PFNGLDRAWELEMENTSINSTANCEDPROC, glDrawElementsInstanced)(mode, count, type, indices, instances);
    check_targets();
}

static void APIENTRY draw_arrays(GLenum mode, GLint first, GLsizei count, GLsizei instances)
{
    DRIVER(PFNGLDRAWARRAYSINSTANCEDPROC, glDrawArraysInstanced)(mode, first, count, instances);
    check_targets();
}

static void __attribute__((constructor)) stand_between(void)
{
    epoxy_glShaderSource = shader_source;
    epoxy_glGetIntegerv = get_integer;
    epoxy_glDispatchCompute = dispatch;
    epoxy_glDispatchComputeIndirect = dispatch_indirect;
    epoxy_glDrawElementsInstanced = draw_elements;
    epoxy_glDrawArraysInstanced = draw_arrays;
}

static void __attribute__((destructor)) sum_up(void)
{
    if (gpu_check.runs)
        fprintf(stderr, "checked on the device: %zu dispatches and draws, %zu targets; %zu faults\n",
                gpu_check.runs, gpu_check.targets, gpu_check.faults);
}
