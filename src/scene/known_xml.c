// Cameras of Agisoft Metashape in XML ("Metashape User Manual", appendix "Camera models").
#include <expat.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/known_internal.h"

// Expat 2.9 counts in 64 bits, under names of their own.
#if XML_MAJOR_VERSION == 2 && XML_MINOR_VERSION < 9
#define XML_GetCurrentLineNumber64 XML_GetCurrentLineNumber
#define XML_GetCurrentByteIndex64 XML_GetCurrentByteIndex
#endif

// Files have some sensors and components; more would make the search for them long.
enum { DEPTH_MAX = 32, TEXT_MAX = 1024, ID_MAX = 32, SENSORS_MAX = 1000 };

struct sensor {
    char id[ID_MAX], type[32];
    int width, height;
    bool calibrated;
    // f cx cy b1 b2 k1 k2 k3 k4 p1 p2 p3 p4
    double value[13];
};
enum { F, CX, CY, B1, B2, K1, K2, K3, K4, P1, P2, P3, P4 };
static const char *const terms[] = {"f", "cx", "cy", "b1", "b2", "k1", "k2", "k3", "k4", "p1", "p2", "p3",
                                    "p4"};

// A transform to the world: of the chunk, or of a component of it.
struct component {
    char id[ID_MAX];
    double r[9], t[3], scale;
};

struct camera {
    char id[ID_MAX], sensor[ID_MAX], component[ID_MAX], *label; // label: owned
    bool enabled, placed;
    double matrix[16];
};

struct reader {
    const struct orl_known_source *source;
    enum orl_result result;
    char path[DEPTH_MAX][24]; // the elements around the current one
    int depth, chunks;
    char text[TEXT_MAX];
    size_t length;
    bool adjusted; // the current calibration is the one that was found, not the one given
    struct sensor *sensors;
    struct component *components, chunk;
    struct camera *cameras;
    size_t sensor_count, sensor_capacity, component_count, component_capacity, camera_count,
        camera_capacity;
};

static bool inside(const struct reader *r, const char *name)
{
    for (int i = 0; i < r->depth; i++)
        if (strcmp(r->path[i], name) == 0)
            return true;
    return false;
}

static bool parent_is(const struct reader *r, const char *name)
{
    return r->depth >= 2 && strcmp(r->path[r->depth - 2], name) == 0;
}

static const char *attribute(const char **attributes, const char *name)
{
    for (; *attributes; attributes += 2)
        if (strcmp(attributes[0], name) == 0)
            return attributes[1];
    return "";
}

static void copy(char *to, size_t size, const char *from)
{
    snprintf(to, size, "%s", from);
}

static enum orl_result begin_sensor(struct reader *r, const char **attributes)
{
    ORL_TRY(ORL_GROW(r->source->log, r->sensors, r->sensor_capacity, r->sensor_count));
    struct sensor *sensor = &r->sensors[r->sensor_count++];
    memset(sensor, 0, sizeof *sensor);
    copy(sensor->id, sizeof sensor->id, attribute(attributes, "id"));
    copy(sensor->type, sizeof sensor->type, attribute(attributes, "type"));
    return ORL_OK;
}

static enum orl_result begin_component(struct reader *r, const char **attributes)
{
    ORL_TRY(ORL_GROW(r->source->log, r->components, r->component_capacity, r->component_count));
    struct component *component = &r->components[r->component_count++];
    *component = (struct component){.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .scale = 1};
    copy(component->id, sizeof component->id, attribute(attributes, "id"));
    return ORL_OK;
}

static enum orl_result begin_camera(struct reader *r, const char **attributes)
{
    const char *enabled = attribute(attributes, "enabled");
    ORL_TRY(ORL_GROW(r->source->log, r->cameras, r->camera_capacity, r->camera_count));
    struct camera *camera = &r->cameras[r->camera_count++];
    memset(camera, 0, sizeof *camera);
    copy(camera->id, sizeof camera->id, attribute(attributes, "id"));
    copy(camera->sensor, sizeof camera->sensor, attribute(attributes, "sensor_id"));
    copy(camera->component, sizeof camera->component, attribute(attributes, "component_id"));
    camera->enabled = strcmp(enabled, "false") != 0 && strcmp(enabled, "0") != 0;
    camera->label = orl_strdup(r->source->log, attribute(attributes, "label"));
    return camera->label ? ORL_OK : ORL_ERR_MEMORY;
}

static void XMLCALL begin(void *user, const char *name, const char **attributes)
{
    struct reader *r = user;
    if (r->result != ORL_OK)
        return;
    if (r->depth == DEPTH_MAX) {
        r->result = orl_fail(r->source->log, ORL_ERR_FORMAT, "%s: elements more than %d deep", r->source->path,
                             DEPTH_MAX);
        return;
    }
    copy(r->path[r->depth++], sizeof r->path[0], name);
    r->length = 0;
    r->chunks += strcmp(name, "chunk") == 0;
    if (r->sensor_count > SENSORS_MAX || r->component_count > SENSORS_MAX)
        r->result = orl_fail(r->source->log, ORL_ERR_FORMAT, "%s: more than %d sensors or components",
                             r->source->path, SENSORS_MAX);
    if (r->chunks != 1 || r->result != ORL_OK)
        return;
    struct sensor *sensor = r->sensor_count ? &r->sensors[r->sensor_count - 1] : NULL;
    if (strcmp(name, "sensor") == 0 && parent_is(r, "sensors"))
        r->result = begin_sensor(r, attributes);
    else if (strcmp(name, "component") == 0 && parent_is(r, "components"))
        r->result = begin_component(r, attributes);
    else if (strcmp(name, "camera") == 0 && inside(r, "cameras"))
        r->result = begin_camera(r, attributes);
    else if (strcmp(name, "resolution") == 0 && parent_is(r, "sensor") && sensor) {
        sensor->width = atoi(attribute(attributes, "width"));
        sensor->height = atoi(attribute(attributes, "height"));
    } else if (strcmp(name, "calibration") == 0 && parent_is(r, "sensor") && sensor) {
        r->adjusted = strcmp(attribute(attributes, "class"), "initial") != 0;
        if (r->adjusted) {
            sensor->calibrated = true;
            memset(sensor->value, 0, sizeof sensor->value);
            if (*attribute(attributes, "type"))
                copy(sensor->type, sizeof sensor->type, attribute(attributes, "type"));
        }
    }
}

static void XMLCALL take_text(void *user, const char *text, int length)
{
    struct reader *r = user;
    size_t room = TEXT_MAX - 1 - r->length, taken = (size_t)length < room ? (size_t)length : room;
    memcpy(r->text + r->length, text, taken);
    r->length += taken;
}

static bool numbers(const char *text, double *values, int count)
{
    char *end;
    for (int i = 0; i < count; i++, text = end) {
        values[i] = strtod(text, &end);
        if (end == text || !isfinite(values[i]))
            return false;
    }
    return true;
}

// Takes the text of an element that ends.
static bool take(struct reader *r, const char *name)
{
    struct sensor *sensor = r->sensor_count ? &r->sensors[r->sensor_count - 1] : NULL;
    struct camera *camera = r->camera_count ? &r->cameras[r->camera_count - 1] : NULL;
    struct component *component = r->component_count && inside(r, "components")
                                      ? &r->components[r->component_count - 1] : &r->chunk;
    if (parent_is(r, "calibration") && sensor && r->adjusted && inside(r, "sensors")) {
        for (size_t i = 0; i < ORL_COUNT(terms); i++)
            if (strcmp(terms[i], name) == 0)
                return numbers(r->text, &sensor->value[i], 1);
    } else if (strcmp(name, "transform") == 0 && parent_is(r, "camera") && camera) {
        return camera->placed = numbers(r->text, camera->matrix, 16);
    } else if (parent_is(r, "transform") && !inside(r, "cameras")) {
        if (strcmp(name, "rotation") == 0)
            return numbers(r->text, component->r, 9);
        if (strcmp(name, "translation") == 0)
            return numbers(r->text, component->t, 3);
        if (strcmp(name, "scale") == 0)
            return numbers(r->text, &component->scale, 1);
    }
    return true;
}

static void XMLCALL end(void *user, const char *name)
{
    struct reader *r = user;
    if (r->result != ORL_OK)
        return;
    r->text[r->length] = '\0';
    if (r->chunks == 1 && !take(r, name))
        r->result = orl_fail(r->source->log, ORL_ERR_FORMAT, "%s: \"%s\" in <%s> is not as many numbers as it "
                             "needs", r->source->path, r->text, name);
    r->length = 0;
    r->depth--;
}

static const char *set_lens(const struct sensor *s, struct orl_known_camera *camera)
{
    const double *v = s->value;
    bool fisheye = strcmp(s->type, "fisheye") == 0 || strcmp(s->type, "equidistant_fisheye") == 0;
    camera->width = s->width;
    camera->height = s->height;
    if (!s->calibrated)
        return "it has no calibration: export after aligning";
    if (!fisheye && strcmp(s->type, "frame") != 0)
        return "its type is neither frame nor fisheye: panoramas and others cannot be used";
    if (fabs(v[B2]) * s->height > v[F] || v[P3] < 0 || v[P3] > 0 || v[P4] < 0 || v[P4] > 0 ||
        (!fisheye && (v[K4] < 0 || v[K4] > 0)))
        return "its calibration has b2, k4, p3 or p4: leave them out, or export undistorted pictures";
    const double f_c[4] = {v[F] + v[B1], v[F], 0.5 * s->width + v[CX], 0.5 * s->height + v[CY]};
    // Metashape's p1 and p2 have the places of OpenCV's p2 and p1.
    const double brown[] = {v[K1], v[K2], v[P2], v[P1], v[K3]};
    orl_known_set_lens(camera, f_c, fisheye ? v + K1 : brown, fisheye ? 4 : ORL_COUNT(brown), fisheye);
    return NULL;
}

static bool set_pose(const struct reader *r, const struct camera *from, struct orl_known_camera *camera)
{
    const struct component *c = &r->chunk;
    double axes[3][3], centre[3];
    for (size_t i = 0; i < r->component_count; i++)
        if (strcmp(r->components[i].id, from->component) == 0)
            c = &r->components[i];
    for (int i = 0; i < 3; i++) {
        centre[i] = c->t[i];
        for (int j = 0; j < 3; j++) {
            axes[i][j] = 0;
            for (int k = 0; k < 3; k++)
                axes[i][j] += c->r[3 * i + k] * from->matrix[4 * k + j];
            centre[i] += c->scale * c->r[3 * i + j] * from->matrix[4 * j + 3];
        }
    }
    return orl_pose_from_axes(axes, centre, &camera->pose);
}

static enum orl_result add_cameras(const struct reader *r, struct orl_known_cameras *known)
{
    const struct orl_log *log = r->source->log;
    size_t unplaced = 0, off = 0;
    for (size_t i = 0; i < r->camera_count; i++) {
        const struct camera *from = &r->cameras[i];
        const struct sensor *sensor = NULL;
        struct orl_known_camera camera = {.path = from->label, .place = from->label};
        unplaced += !from->placed;
        off += from->placed && !from->enabled;
        if (!from->placed || !from->enabled)
            continue;
        for (size_t k = 0; k < r->sensor_count && !sensor; k++)
            if (strcmp(r->sensors[k].id, from->sensor) == 0)
                sensor = &r->sensors[k];
        const char *problem = sensor ? set_lens(sensor, &camera) : "its sensor is not there";
        if (!problem && !set_pose(r, from, &camera))
            problem = "its transform is not a pose";
        ORL_TRY(problem ? orl_fail(log, ORL_ERR_FORMAT, "%s: camera %.120s: %s", r->source->path, from->label,
                                   problem)
                        : orl_known_add(r->source, &camera, known));
    }
    if (unplaced)
        orl_logf(log, ORL_LOG_WARNING, "%s: %zu of %zu cameras are not aligned: left out", r->source->path,
                 unplaced, r->camera_count);
    if (off)
        orl_logf(log, ORL_LOG_WARNING, "%s: %zu of %zu cameras are disabled: left out", r->source->path, off,
                 r->camera_count);
    if (r->chunks > 1)
        orl_logf(log, ORL_LOG_WARNING, "%s: %d chunks; taking the first", r->source->path, r->chunks);
    return ORL_OK;
}

static enum orl_result parse(struct reader *r)
{
    const struct orl_known_source *source = r->source;
    const struct orl_log *log = source->log;
    XML_Parser parser = XML_ParserCreate(NULL);
    if (!parser)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for its XML", source->path);
    XML_SetUserData(parser, r);
    XML_SetElementHandler(parser, begin, end);
    XML_SetCharacterDataHandler(parser, take_text);
    if (XML_Parse(parser, (const char *)source->data, (int)source->size, 1) != XML_STATUS_OK &&
        r->result == ORL_OK)
        r->result = orl_fail(log, ORL_ERR_FORMAT, "%s: line %llu (byte %lld): %s", source->path,
                             (unsigned long long)XML_GetCurrentLineNumber64(parser),
                             (long long)XML_GetCurrentByteIndex64(parser),
                             XML_ErrorString(XML_GetErrorCode(parser)));
    XML_ParserFree(parser);
    return r->result;
}

enum orl_result orl_known_read_metashape(const struct orl_known_source *source,
                                         struct orl_known_cameras *known)
{
    struct reader r = {.source = source, .chunk = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .scale = 1}};
    enum orl_result result = parse(&r);
    if (result == ORL_OK && !r.chunks)
        result = orl_fail(source->log, ORL_ERR_FORMAT, "%s: not Metashape's cameras: no <chunk>", source->path);
    ORL_THEN(result, add_cameras(&r, known));
    for (size_t i = 0; i < r.camera_count; i++)
        free(r.cameras[i].label);
    free(r.cameras);
    free(r.sensors);
    free(r.components);
    return result;
}
