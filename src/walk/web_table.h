// The files of web/, the interactive page, embedded at build time. A NULL name ends the table.
#ifndef ORL_WALK_WEB_TABLE_H
#define ORL_WALK_WEB_TABLE_H

struct orl_web_file {
    const char *name; // relative to web/
    const char *text;
};
extern const struct orl_web_file orl_web_table[];

#endif
