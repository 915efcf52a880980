// One self-contained HTML page of a report: figures as JSON, pictures as data URLs.
#ifndef ORL_EVAL_REPORT_PAGE_H
#define ORL_EVAL_REPORT_PAGE_H

#include <jansson.h>

#include "oriel/names.h"

struct orl_page {
    const char *dir, *file; // the report's folder; the page's name in it
    const char *html;       // with the marks @STYLE@, @DATA@, @PICTURES@ and @SCRIPT@, in this order
    const json_t *data;
    const struct orl_names *pictures; // JPEG files, relative to `dir`
};
// @PICTURES@ becomes the members of a JSON object: name to data URL.
enum orl_result orl_page_write(const struct orl_log *log,
                               const struct orl_page *page) ORL_CHECK_RESULT;

// What the pages of all reports share: report.css and report.js.
extern const char orl_page_style[], orl_page_script[];

#endif
