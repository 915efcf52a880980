// Exposures of photographs as a list or EXIF tells them.
#ifndef ORL_PREPROCESS_EXPOSURE_LIST_H
#define ORL_PREPROCESS_EXPOSURE_LIST_H

#include "io/picture.h"

struct orl_listed_exposure {
    char *name;    // owned; of the photograph, extension optional
    double ev;     // log2 of exposure
    bool absolute; // from time, aperture and ISO, as EXIF's; else on a scale of its own
};
struct orl_exposure_list {
    struct orl_listed_exposure *items; // owned
    size_t count;
};
// CSV: NAME,TIME,APERTURE,ISO (TIME in seconds, "1/250" too) or NAME,EV, all lines alike;
// a first line of titles is skipped. ORL_ERR_FORMAT names the line.
enum orl_result orl_exposure_list_read(const struct orl_log *log, const char *path,
                                       struct orl_exposure_list *list) ORL_CHECK_RESULT;
// NULL when the photograph is not listed.
const struct orl_listed_exposure *orl_exposure_list_find(const struct orl_exposure_list *list,
                                                         const char *photo);
void orl_exposure_list_finish(struct orl_exposure_list *list);

enum orl_exposure_source {
    ORL_EXPOSURE_UNKNOWN,
    ORL_EXPOSURE_EXIF,
    ORL_EXPOSURE_LIST,
    ORL_EXPOSURE_SCENE, // estimated
};
// log2 of the exposure of the photograph called `name`, or `given` (NULL: the same), from the
// list or EXIF. A list of EV has a scale of its own, which EXIF does not share: then EXIF
// says nothing.
enum orl_exposure_source orl_exposure_told(const struct orl_exposure_list *list, const char *name,
                                           const char *given, const struct orl_exif *exif,
                                           double *ev);

#endif
