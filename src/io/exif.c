// EXIF blocks through libexif.
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <libexif/exif-data.h>

#include "core/memory.h"
#include "io/internal.h"

// --- reading ---

// The first value of a numeric entry; false when it is missing or not a number.
static bool get_number(ExifData *data, ExifIfd ifd, ExifTag tag, double *value)
{
    ExifEntry *entry = exif_content_get_entry(data->ifd[ifd], tag);
    ExifByteOrder order = exif_data_get_byte_order(data);
    if (!entry || !entry->data || entry->components < 1 ||
        entry->size < exif_format_get_size(entry->format))
        return false;
    switch (entry->format) {
    case EXIF_FORMAT_SHORT:
        *value = exif_get_short(entry->data, order);
        break;
    case EXIF_FORMAT_LONG:
        *value = exif_get_long(entry->data, order);
        break;
    case EXIF_FORMAT_RATIONAL: {
        ExifRational r = exif_get_rational(entry->data, order);
        *value = (double)r.numerator / (double)r.denominator;
        break;
    }
    case EXIF_FORMAT_SRATIONAL: {
        ExifSRational r = exif_get_srational(entry->data, order);
        *value = (double)r.numerator / (double)r.denominator;
        break;
    }
    default:
        return false;
    }
    return isfinite(*value);
}

// 0 when the value is missing, zero or negative; all EXIF quantities read here are positive.
static double get_positive(ExifData *data, ExifIfd ifd, ExifTag tag)
{
    double value;
    return get_number(data, ifd, tag, &value) && value > 0 ? value : 0;
}

static void get_text(ExifData *data, ExifTag tag, char *text, size_t size)
{
    ExifEntry *entry = exif_content_get_entry(data->ifd[EXIF_IFD_0], tag);
    size_t length = 0;
    if (entry && entry->data && entry->format == EXIF_FORMAT_ASCII)
        while (length < entry->size && length + 1 < size && entry->data[length])
            length++;
    // Cameras pad texts with spaces, and control characters would break reports.
    while (length && entry->data[length - 1] == ' ')
        length--;
    for (size_t i = 0; i < length; i++)
        text[i] = entry->data[i] < 0x20 ? ' ' : (char)entry->data[i];
    text[length] = '\0';
}

enum orl_result orl_exif_decode(const struct orl_log *log, const char *path, const uint8_t *bytes,
                                size_t size, struct orl_exif *exif)
{
    memset(exif, 0, sizeof *exif);
    ExifData *data = size <= UINT_MAX ? exif_data_new() : NULL;
    if (!data)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory to read EXIF", path);
    // Without this libexif adds defaults that the specification asks for and the file lacks.
    exif_data_unset_option(data, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
    exif_data_load_data(data, bytes, (unsigned)size);
    get_text(data, EXIF_TAG_MAKE, exif->make, sizeof exif->make);
    get_text(data, EXIF_TAG_MODEL, exif->model, sizeof exif->model);
    double apex;
    exif->exposure_s = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_TIME);
    if (!(exif->exposure_s > 0) &&
        get_number(data, EXIF_IFD_EXIF, EXIF_TAG_SHUTTER_SPEED_VALUE, &apex) && fabs(apex) < 32)
        exif->exposure_s = exp2(-apex);
    exif->aperture = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_FNUMBER);
    if (!(exif->aperture > 0) &&
        get_number(data, EXIF_IFD_EXIF, EXIF_TAG_APERTURE_VALUE, &apex) && fabs(apex) < 32)
        exif->aperture = exp2(apex / 2);
    exif->iso = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS);
    // 65535 in the 16-bit entry refers to the 32-bit entry (EXIF 2.3, 4.6.5).
    double wide = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED);
    if (wide > 0 && (!(exif->iso > 0) || exif->iso >= 65535))
        exif->iso = wide;
    if (!get_number(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_BIAS_VALUE, &exif->bias_ev))
        exif->bias_ev = 0;
    exif->focal_mm = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH);
    exif->focal_35mm = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
    double turn = get_positive(data, EXIF_IFD_0, EXIF_TAG_ORIENTATION);
    exif->orientation = turn <= 8 ? (int)turn : 0;
    exif_data_unref(data);
    return ORL_OK;
}

// --- writing ---

// The simplest fraction within a billionth of value, by continued fractions, so that
// 0.004 is written as 1/250.
static ExifSRational to_rational(double value)
{
    double sign = value < 0 ? -1 : 1, x = fmin(fabs(value), INT32_MAX);
    double p0 = 0, q0 = 1, p1 = 1, q1 = 0;
    for (int i = 0; i < 32; i++) {
        double whole = floor(x);
        double p = whole * p1 + p0, q = whole * q1 + q0;
        if (p > INT32_MAX || q > INT32_MAX)
            break;
        p0 = p1, q0 = q1, p1 = p, q1 = q;
        if (fabs(p1 / q1 - fabs(value)) <= 1e-9 * fabs(value) || x - whole < 1e-12)
            break;
        x = 1 / (x - whole);
    }
    return (ExifSRational){.numerator = (ExifSLong)(sign * p1), .denominator = (ExifSLong)q1};
}

// Adds an entry with room for `count` values, owned by `data`. NULL when memory runs out.
static ExifEntry *add_entry(ExifData *data, ExifIfd ifd, ExifTag tag, ExifFormat format,
                            size_t count)
{
    size_t size = count * exif_format_get_size(format);
    ExifEntry *entry = exif_entry_new();
    unsigned char *bytes = calloc(1, size);
    if (!entry || !bytes) {
        exif_entry_unref(entry);
        free(bytes);
        return NULL;
    }
    entry->tag = tag;
    entry->format = format;
    entry->components = count;
    entry->data = bytes;
    entry->size = (unsigned)size;
    exif_content_add_entry(data->ifd[ifd], entry);
    exif_entry_unref(entry);
    return entry;
}

static bool add_text(ExifData *data, ExifTag tag, const char *text)
{
    if (!*text)
        return true;
    ExifEntry *entry = add_entry(data, EXIF_IFD_0, tag, EXIF_FORMAT_ASCII, strlen(text) + 1);
    if (entry)
        memcpy(entry->data, text, strlen(text));
    return entry != NULL;
}

static bool add_number(ExifData *data, ExifIfd ifd, ExifTag tag, ExifFormat format, double value)
{
    if (!isfinite(value) || value == 0)
        return true;
    ExifEntry *entry = add_entry(data, ifd, tag, format, 1);
    ExifByteOrder order = exif_data_get_byte_order(data);
    if (!entry)
        return false;
    ExifSRational r = to_rational(value);
    switch (format) {
    case EXIF_FORMAT_SHORT:
        exif_set_short(entry->data, order, (ExifShort)fmin(fmax(round(value), 0), 65535));
        break;
    case EXIF_FORMAT_LONG:
        exif_set_long(entry->data, order, (ExifLong)fmin(fmax(round(value), 0), UINT32_MAX));
        break;
    case EXIF_FORMAT_RATIONAL:
        exif_set_rational(entry->data, order,
                          (ExifRational){(ExifLong)r.numerator, (ExifLong)r.denominator});
        break;
    default:
        exif_set_srational(entry->data, order, r);
    }
    return true;
}

static bool add_all(ExifData *data, const struct orl_exif *exif)
{
    const struct {
        ExifIfd ifd;
        ExifTag tag;
        ExifFormat format;
        double value;
    } rows[] = {
        {EXIF_IFD_0, EXIF_TAG_ORIENTATION, EXIF_FORMAT_SHORT, exif->orientation},
        {EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_TIME, EXIF_FORMAT_RATIONAL, exif->exposure_s},
        {EXIF_IFD_EXIF, EXIF_TAG_FNUMBER, EXIF_FORMAT_RATIONAL, exif->aperture},
        {EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS, EXIF_FORMAT_SHORT, exif->iso},
        {EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED, EXIF_FORMAT_LONG,
         exif->iso >= 65535 ? exif->iso : 0},
        {EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_BIAS_VALUE, EXIF_FORMAT_SRATIONAL, exif->bias_ev},
        {EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH, EXIF_FORMAT_RATIONAL, exif->focal_mm},
        {EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, EXIF_FORMAT_SHORT, exif->focal_35mm},
    };
    if (!add_text(data, EXIF_TAG_MAKE, exif->make) || !add_text(data, EXIF_TAG_MODEL, exif->model))
        return false;
    for (size_t i = 0; i < ORL_COUNT(rows); i++)
        if (!add_number(data, rows[i].ifd, rows[i].tag, rows[i].format, rows[i].value))
            return false;
    return true;
}

enum orl_result orl_exif_encode(const struct orl_log *log, const struct orl_exif *exif,
                                uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    *size = 0;
    ExifData *data = exif_data_new();
    if (!data)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory to write EXIF");
    exif_data_unset_option(data, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
    exif_data_set_byte_order(data, EXIF_BYTE_ORDER_INTEL);
    unsigned saved = 0;
    bool ok = add_all(data, exif);
    if (ok)
        exif_data_save_data(data, bytes, &saved);
    exif_data_unref(data);
    *size = saved;
    if (!ok || !*bytes) {
        free(*bytes);
        *bytes = NULL;
        return orl_fail(log, ORL_ERR_MEMORY, "no memory to write EXIF");
    }
    return ORL_OK;
}
