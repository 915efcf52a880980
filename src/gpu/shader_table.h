// The shaders that are embedded at build time, terminated by a NULL name.
#ifndef ORL_GPU_SHADER_TABLE_H
#define ORL_GPU_SHADER_TABLE_H

struct orl_shader_file {
    const char *name; // relative to shaders/
    const char *text;
};
extern const struct orl_shader_file orl_shader_table[];

#endif
