// EXIF blocks through libexif.
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <libexif/exif-data.h>

#include "core/memory.h"
#include "io/internal.h"

// --- reading ---

// Value n of a numeric entry; false when it is missing or not a number.
static bool get_number(ExifData *data, ExifIfd ifd, ExifTag tag, size_t n, double *value)
{
    ExifEntry *entry = exif_content_get_entry(data->ifd[ifd], tag);
    ExifByteOrder order = exif_data_get_byte_order(data);
    size_t size = entry ? exif_format_get_size(entry->format) : 0;
    if (!entry || !entry->data || entry->components <= n || entry->size < (n + 1) * size)
        return false;
    const unsigned char *bytes = entry->data + n * size;
    switch (entry->format) {
    case EXIF_FORMAT_SHORT:
        *value = exif_get_short(bytes, order);
        break;
    case EXIF_FORMAT_LONG:
        *value = exif_get_long(bytes, order);
        break;
    case EXIF_FORMAT_RATIONAL: {
        ExifRational r = exif_get_rational(bytes, order);
        *value = (double)r.numerator / (double)r.denominator;
        break;
    }
    case EXIF_FORMAT_SRATIONAL: {
        ExifSRational r = exif_get_srational(bytes, order);
        *value = (double)r.numerator / (double)r.denominator;
        break;
    }
    default:
        return false;
    }
    return isfinite(*value);
}

// 0 when missing, zero or negative: EXIF's quantities here are all positive.
static double get_positive(ExifData *data, ExifIfd ifd, ExifTag tag)
{
    double value;
    return get_number(data, ifd, tag, 0, &value) && value > 0 ? value : 0;
}

// 65535 in the 16-bit entry refers to the 32-bit ones, of which a camera writes the one that its setting stands for
// (EXIF 2.3, 4.6.5): Canon, for example, the recommended exposure index.
static double get_iso(ExifData *data)
{
    static const ExifTag wide[] = {EXIF_TAG_ISO_SPEED, EXIF_TAG_RECOMMENDED_EXPOSURE_INDEX,
                                   EXIF_TAG_STANDARD_OUTPUT_SENSITIVITY};
    double iso = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_ISO_SPEED_RATINGS), other = 0;
    for (size_t i = 0; i < ORL_COUNT(wide) && !(other > 0); i++)
        other = get_positive(data, EXIF_IFD_EXIF, wide[i]);
    return other > 0 && (!(iso > 0) || iso >= 65535) ? other : iso;
}

void orl_exif_text(const void *bytes, size_t count, char *text, size_t size)
{
    const uint8_t *from = bytes;
    size_t length = 0;
    while (length < count && length + 1 < size && from[length])
        length++;
    // Cameras pad texts with spaces, and control characters would break reports.
    while (length && from[length - 1] == ' ')
        length--;
    for (size_t i = 0; i < length; i++)
        text[i] = from[i] < 0x20 ? ' ' : (char)from[i];
    text[length] = '\0';
}

static void get_text(ExifData *data, ExifIfd ifd, ExifTag tag, char *text, size_t size)
{
    ExifEntry *entry = exif_content_get_entry(data->ifd[ifd], tag);
    bool ascii = entry && entry->data && entry->format == EXIF_FORMAT_ASCII;
    orl_exif_text(ascii ? entry->data : NULL, ascii ? entry->size : 0, text, size);
}

static double get_time(ExifData *data)
{
    char text[32];
    struct tm t = {0};
    get_text(data, EXIF_IFD_EXIF, EXIF_TAG_DATE_TIME_ORIGINAL, text, sizeof text);
    if (sscanf(text, "%d:%d:%d %d:%d:%d", &t.tm_year, &t.tm_mon, &t.tm_mday, &t.tm_hour, &t.tm_min,
               &t.tm_sec) != 6 || t.tm_year < 1971 || t.tm_year > 9999)
        return 0; // cameras whose clock was never set write zeroes or spaces
    t.tm_year -= 1900;
    t.tm_mon -= 1;
    return (double)timegm(&t);
}

// Degrees, minutes and seconds; `negative` is the letter of the other side. False: unknown.
static bool get_angle(ExifData *data, ExifTag tag, ExifTag side_tag, char negative, double limit,
                      double *angle)
{
    double parts[3] = {0};
    char side[4];
    if (!get_number(data, EXIF_IFD_GPS, tag, 0, &parts[0]))
        return false;
    // Some write the degrees alone.
    for (size_t i = 1; i < 3; i++)
        if (!get_number(data, EXIF_IFD_GPS, tag, i, &parts[i]))
            parts[i] = 0;
    get_text(data, EXIF_IFD_GPS, side_tag, side, sizeof side);
    *angle = parts[0] + parts[1] / 60 + parts[2] / 3600;
    if (side[0] == negative)
        *angle = -*angle;
    return side[0] && fabs(*angle) <= limit;
}

static void get_place(ExifData *data, struct orl_exif *exif)
{
    exif->placed = get_angle(data, (ExifTag)EXIF_TAG_GPS_LATITUDE,
                             (ExifTag)EXIF_TAG_GPS_LATITUDE_REF, 'S', 90, &exif->latitude) &&
                   get_angle(data, (ExifTag)EXIF_TAG_GPS_LONGITUDE,
                             (ExifTag)EXIF_TAG_GPS_LONGITUDE_REF, 'W', 180, &exif->longitude);
    if (!exif->placed)
        exif->latitude = exif->longitude = 0;
}

enum orl_result orl_exif_decode(const struct orl_log *log, const char *path, const uint8_t *bytes,
                                size_t size, struct orl_exif *exif)
{
    struct orl_bytes block = {0};
    memset(exif, 0, sizeof *exif);
    enum orl_result result = orl_bytes_add(log, &block, "Exif\0", 6); // which libexif wants ahead of it
    ORL_THEN(result, orl_bytes_add(log, &block, bytes, size));
    ExifData *data = result == ORL_OK && block.size <= UINT_MAX ? exif_data_new() : NULL;
    if (!data) {
        free(block.data);
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory to read EXIF", path);
    }
    // Without this libexif adds defaults that the specification asks for and the file lacks.
    exif_data_unset_option(data, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
    exif_data_load_data(data, (const uint8_t *)block.data, (unsigned)block.size);
    free(block.data);
    get_text(data, EXIF_IFD_0, EXIF_TAG_MAKE, exif->make, sizeof exif->make);
    get_text(data, EXIF_IFD_0, EXIF_TAG_MODEL, exif->model, sizeof exif->model);
    double apex;
    exif->exposure_s = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_TIME);
    if (!(exif->exposure_s > 0) &&
        get_number(data, EXIF_IFD_EXIF, EXIF_TAG_SHUTTER_SPEED_VALUE, 0, &apex) && fabs(apex) < 32)
        exif->exposure_s = exp2(-apex);
    exif->aperture = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_FNUMBER);
    if (!(exif->aperture > 0) &&
        get_number(data, EXIF_IFD_EXIF, EXIF_TAG_APERTURE_VALUE, 0, &apex) && fabs(apex) < 32)
        exif->aperture = exp2(apex / 2);
    exif->iso = get_iso(data);
    if (!get_number(data, EXIF_IFD_EXIF, EXIF_TAG_EXPOSURE_BIAS_VALUE, 0, &exif->bias_ev))
        exif->bias_ev = 0;
    exif->focal_mm = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH);
    exif->focal_35mm = get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
    double turn = get_positive(data, EXIF_IFD_0, EXIF_TAG_ORIENTATION);
    exif->orientation = turn <= 8 ? (int)turn : 0;
    exif->panorama = (int)get_positive(data, EXIF_IFD_EXIF, EXIF_TAG_CUSTOM_RENDERED) == 6; // Apple's extension
    char interoperability[8];
    get_text(data, EXIF_IFD_INTEROPERABILITY, EXIF_TAG_INTEROPERABILITY_INDEX, interoperability,
             sizeof interoperability);
    exif->adobe_rgb = strcmp(interoperability, "R03") == 0;
    exif->taken_s = get_time(data);
    get_place(data, exif);
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

static bool add_text(ExifData *data, ExifIfd ifd, ExifTag tag, const char *text)
{
    if (!*text)
        return true;
    ExifEntry *entry = add_entry(data, ifd, tag, EXIF_FORMAT_ASCII, strlen(text) + 1);
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

static bool add_time(ExifData *data, const struct orl_exif *exif)
{
    char text[32] = "";
    struct tm t;
    time_t taken = (time_t)exif->taken_s;
    if (exif->taken_s > 0 && gmtime_r(&taken, &t))
        strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &t);
    return add_text(data, EXIF_IFD_EXIF, EXIF_TAG_DATE_TIME_ORIGINAL, text);
}

static bool add_angle(ExifData *data, ExifTag tag, ExifTag side_tag, const char *side, double angle)
{
    ExifEntry *entry = add_entry(data, EXIF_IFD_GPS, tag, EXIF_FORMAT_RATIONAL, 3);
    if (!entry)
        return false;
    // Degrees, minutes, and seconds to a thousandth, which is 3 cm.
    uint64_t ms = (uint64_t)llround(fabs(angle) * 3600000);
    const ExifRational parts[] = {{(ExifLong)(ms / 3600000), 1},
                                  {(ExifLong)(ms / 60000 % 60), 1},
                                  {(ExifLong)(ms % 60000), 1000}};
    for (size_t i = 0; i < ORL_COUNT(parts); i++)
        exif_set_rational(entry->data + i * sizeof parts[i], exif_data_get_byte_order(data),
                          parts[i]);
    return add_text(data, EXIF_IFD_GPS, side_tag, side);
}

static bool add_place(ExifData *data, const struct orl_exif *exif)
{
    return !exif->placed ||
           (add_angle(data, (ExifTag)EXIF_TAG_GPS_LATITUDE, (ExifTag)EXIF_TAG_GPS_LATITUDE_REF,
                      exif->latitude < 0 ? "S" : "N", exif->latitude) &&
            add_angle(data, (ExifTag)EXIF_TAG_GPS_LONGITUDE, (ExifTag)EXIF_TAG_GPS_LONGITUDE_REF,
                      exif->longitude < 0 ? "W" : "E", exif->longitude));
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
    if (!add_text(data, EXIF_IFD_0, EXIF_TAG_MAKE, exif->make) ||
        !add_text(data, EXIF_IFD_0, EXIF_TAG_MODEL, exif->model) || !add_time(data, exif) ||
        !add_place(data, exif))
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
