// What the tests do to the programs of the device ahead of the driver, by the pointers through which
// epoxy calls it. Linked into the tests of the device, and as libgpu_check.so, preloaded, for any
// command. By the environment:
//   ORIEL_GPU_CHECK=1      every index into an array, buffer or texture is compared with its size
//                          while compute programs run, and every target that was written is searched
//                          for values that are not finite. What is found is told with shader, line
//                          and name, and is an error of OpenGL, which fails the frame.
//   ORIEL_SHADER_DUMP=DIR  the source of programs is written to DIR, for other compilers and people.
// With either, no cache gives a program that was not seen.
#ifndef ORL_TESTS_GPU_CHECK_H
#define ORL_TESTS_GPU_CHECK_H

#include <stddef.h>
#include <stdio.h>

// The text of a program with its indexes checked by the functions of index.glsl. Lines keep their
// numbers; comments become spaces. At the end a comment says where each index is: "// site 7:
// shaders/FILE:LINE: EXPRESSION". Owned by the caller.
char *gpu_check_text(const char *text);
extern const char gpu_check_index[]; // index.glsl

// A preloaded library has no owner to keep its state.
struct gpu_check {
    FILE *to;             // where findings are told; NULL: the standard error
    size_t runs, targets; // dispatches and draws; textures and arrays that were searched
    size_t faults;
};
extern struct gpu_check gpu_check;

#endif
