// Exposures of photographs from a list or from EXIF.
#ifndef ORL_PREPROCESS_EXPOSURE_LIST_H
#define ORL_PREPROCESS_EXPOSURE_LIST_H

#include "io/picture.h"

struct orl_listed_exposure {
    char *name;    // owned; the photograph's name, with or without extension
    double ev;     // log2 of exposure
    bool absolute; // from time, aperture and ISO, as in EXIF; false: on the list's own scale
};
struct orl_exposure_list {
    struct orl_listed_exposure *items; // owned
    size_t count;
};
// Reads CSV lines NAME,TIME,APERTURE,ISO (TIME in seconds or as "1/250") or NAME,EV. All lines must
// be of one kind; a first line of titles is skipped. ORL_ERR_FORMAT names the line.
enum orl_result orl_exposure_list_read(const struct orl_log *log, const char *path,
                                       struct orl_exposure_list *list) ORL_CHECK_RESULT;
// Returns NULL when the photograph is not listed.
const struct orl_listed_exposure *orl_exposure_list_find(const struct orl_exposure_list *list,
                                                         const char *photo);
void orl_exposure_list_finish(struct orl_exposure_list *list);

enum orl_exposure_source {
    ORL_EXPOSURE_UNKNOWN,
    ORL_EXPOSURE_EXIF,
    ORL_EXPOSURE_LIST,
    ORL_EXPOSURE_SCENE, // estimated from the scene
};
#endif
